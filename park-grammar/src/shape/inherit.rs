//! What the edges of a piece have from the region that it was cut from.

use geo_types::Coord;

use super::{Edge, Local, Mark, Origin, Region, Role};
use crate::plane::{cross, dist, dot, lerp, nearest_on, unit, Area};

/// Points this near, as a share of the region's size, are on an edge.
const NEAR: f64 = 1e-6;

/// Hands down to pieces of a region what its edges know.
///
/// Booleans give rings without a memory. An edge of a piece that lies on one of
/// the region's has that one's origin; any other was made by the rule.
pub(crate) struct Heritage<'r> {
    region: &'r Region,
    /// The rule, for the marks of what is new.
    rule: &'static str,
    near: f64,
    /// The region's edges with their directions, ring by ring.
    edges: Vec<Source<'r>>,
}

/// An edge of the region.
struct Source<'r> {
    ends: [Coord<f64>; 2],
    along: Coord<f64>,
    edge: &'r Edge,
}

impl<'r> Heritage<'r> {
    pub(crate) fn new(region: &'r Region, rule: &'static str) -> Self {
        let (low, high) = region.area.extent();
        let edges = (0..region.rings()).flat_map(|ring| region.edges(ring));
        let source = |(p, q, edge): (Coord<f64>, Coord<f64>, &'r Edge)| Source {
            ends: [p, q],
            along: unit(q - p),
            edge,
        };
        Self {
            region,
            rule,
            near: NEAR * (high.x - low.x).max(high.y - low.y),
            edges: edges.map(source).collect(),
        }
    }

    /// The region's edge on which the segment lies.
    pub(crate) fn source(&self, a: Coord<f64>, b: Coord<f64>) -> Option<&'r Edge> {
        let middle = lerp(a, b, 0.5);
        let on = |source: &&Source<'_>| {
            let [p, q] = source.ends;
            // Most edges lie far from the line of the other.
            if cross(source.along, middle - p).abs() > self.near {
                return false;
            }
            let near = |x| dist(nearest_on(p, q, x), x) <= self.near;
            // A short segment across the end of an edge is near it too.
            let along = || cross(unit(b - a), source.along).abs() < 0.5 || dist(a, b) < self.near;
            near(middle) && near(a) && near(b) && along()
        };
        self.edges.iter().find(on).map(|source| source.edge)
    }

    /// A mark of this rule.
    pub(crate) fn mark(&self, role: Role) -> Mark {
        Mark {
            rule: self.rule.into(),
            depth: self.region.depth,
            role,
        }
    }

    /// The piece as a region. `role` says what a new edge is to the rule; `None`
    /// leaves it without a mark. Sides are those of the region where the piece
    /// has them: a new edge belongs to the side of the region that it faces.
    pub(crate) fn piece(
        &self,
        area: Area,
        local: Local,
        role: impl Fn(Coord<f64>, Coord<f64>) -> Option<Role>,
    ) -> Region {
        self.made(area, local, |a, b, source| match source {
            Some(edge) => edge.clone(),
            None => Edge {
                side: None,
                origin: Origin {
                    boundary: None,
                    descent: self.facing(a, b),
                    marks: role(a, b).map(|role| self.mark(role)).into_iter().collect(),
                },
            },
        })
    }

    /// The piece as a region with edges that the rule makes itself: from the ends
    /// of each, and the edge of the region on which it lies.
    pub(crate) fn made(
        &self,
        area: Area,
        local: Local,
        edge: impl Fn(Coord<f64>, Coord<f64>, Option<&Edge>) -> Edge,
    ) -> Region {
        let mut region = Region::bare(area);
        for ring in 0..region.rings() {
            region.edges[ring] = crate::plane::sides(region.ring(ring))
                .map(|(a, b)| edge(a, b, self.source(a, b)))
                .collect();
        }
        region.local = local;
        region.depth = self.region.depth + 1;
        region
    }

    /// The descent of the nearest edge of the region that a new one runs
    /// parallel to, on the same side of the land.
    fn facing(&self, a: Coord<f64>, b: Coord<f64>) -> Option<usize> {
        let (middle, along) = (lerp(a, b, 0.5), unit(b - a));
        let outer = &self.edges[..self.region.edges[0].len()];
        let parallel = outer.iter().filter(|s| dot(s.along, along) > 0.7);
        let away = |source: &Source<'_>| {
            let off = nearest_on(source.ends[0], source.ends[1], middle) - middle;
            dot(off, off)
        };
        parallel
            .map(|source| (away(source), source.edge))
            .min_by(|x, y| x.0.total_cmp(&y.0))
            .and_then(|(_, edge)| edge.origin.descent)
    }
}
