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
    rule: &'r str,
    near: f64,
}

impl<'r> Heritage<'r> {
    pub(crate) fn new(region: &'r Region, rule: &'r str) -> Self {
        let (low, high) = region.area.extent();
        Self {
            region,
            rule,
            near: NEAR * (high.x - low.x).max(high.y - low.y),
        }
    }

    /// The region's edge on which the segment lies.
    pub(crate) fn source(&self, a: Coord<f64>, b: Coord<f64>) -> Option<&'r Edge> {
        let middle = lerp(a, b, 0.5);
        let on = |(p, q, _): &(Coord<f64>, Coord<f64>, &Edge)| {
            let near = |x| dist(nearest_on(*p, *q, x), x) <= self.near;
            // A short segment across the end of an edge is near it too.
            let along = cross(unit(b - a), unit(*q - *p)).abs() < 0.5 || dist(a, b) < self.near;
            near(middle) && near(a) && near(b) && along
        };
        let rings = 0..self.region.rings();
        let edges = rings.flat_map(|ring| self.region.edges(ring));
        edges.into_iter().find(on).map(|(_, _, edge)| edge)
    }

    /// A mark of this rule.
    pub(crate) fn mark(&self, role: Role) -> Mark {
        Mark {
            rule: self.rule.to_owned(),
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
        let mut region = Region::bare(area);
        for ring in 0..region.rings() {
            let points: Vec<(Coord<f64>, Coord<f64>)> =
                crate::plane::sides(region.ring(ring)).collect();
            region.edges[ring] = points
                .into_iter()
                .map(|(a, b)| match self.source(a, b) {
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
        let edges = self.region.edges(0);
        let parallel = edges.filter(|(p, q, _)| dot(unit(*q - *p), along) > 0.7);
        parallel
            .min_by(|x, y| {
                let away = |e: &(Coord<f64>, Coord<f64>, &Edge)| {
                    dist(nearest_on(e.0, e.1, middle), middle)
                };
                away(x).total_cmp(&away(y))
            })
            .and_then(|(_, _, edge)| edge.origin.descent)
    }
}
