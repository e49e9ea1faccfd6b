//! The edges of a polygon under an index: inside or not, and where out.

use super::clearance::Clearance;
use super::Exit;
use crate::vector::{cross, dot, is_finite, norm, point, Point};
use geo_types::Polygon;
use rstar::{PointDistance, RTree, RTreeObject, AABB};

/// One edge, relative to the centre of the domain.
#[derive(Clone, Copy, Debug)]
struct Edge {
    a: Point,
    b: Point,
    ring: usize,
    edge: usize,
}

impl RTreeObject for Edge {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners([self.a.x, self.a.y], [self.b.x, self.b.y])
    }
}

impl PointDistance for Edge {
    fn distance_2(&self, p: &[f64; 2]) -> f64 {
        let p = point(p[0], p[1]);
        let offset = crate::vector::nearest_on_segment(p, self.a, self.b) - p;
        dot(offset, offset)
    }
}

/// A closed polygonal domain: points on the boundary belong to it.
#[derive(Clone, Debug)]
pub(super) struct Edges {
    tree: RTree<Edge>,
    centre: Point,
    /// Diagonal of the bounding box.
    pub(super) size: f64,
    /// Half width of the boundary: what rounding cannot tell apart.
    skin: f64,
    east: f64,
    clearance: Clearance,
}

impl Edges {
    /// Even-odd rule over all rings. A domain with a coordinate that is not
    /// finite is empty.
    pub(super) fn new(domain: &Polygon<f64>) -> Self {
        let rings: Vec<_> = std::iter::once(domain.exterior())
            .chain(domain.interiors())
            .collect();
        let vertices = || rings.iter().flat_map(|ring| ring.0.iter().copied());
        let mut low = point(f64::INFINITY, f64::INFINITY);
        let mut high = point(f64::NEG_INFINITY, f64::NEG_INFINITY);
        for v in vertices() {
            low = point(low.x.min(v.x), low.y.min(v.y));
            high = point(high.x.max(v.x), high.y.max(v.y));
        }
        let centre = (low + high) / 2.0;
        let size = norm(high - low);
        if !size.is_finite() || !vertices().all(is_finite) {
            return Self {
                tree: RTree::new(),
                centre: point(0.0, 0.0),
                size: 0.0,
                skin: 0.0,
                east: 0.0,
                clearance: Clearance::default(),
            };
        }
        let mut edges = Vec::new();
        for (ring, line) in rings.iter().enumerate() {
            for (edge, pair) in line.0.windows(2).enumerate() {
                if pair[0] != pair[1] {
                    edges.push(Edge {
                        a: pair[0] - centre,
                        b: pair[1] - centre,
                        ring,
                        edge,
                    });
                }
            }
        }
        // Coordinates are rounded relative to their magnitude, not to the size
        // of the domain: at map coordinates the former is what counts.
        let magnitude = size + norm(centre);
        let mut all = Self {
            tree: RTree::bulk_load(edges),
            centre,
            size,
            skin: 1e-12 * size + 4e-16 * magnitude,
            east: high.x - centre.x,
            clearance: Clearance::default(),
        };
        all.clearance = Clearance::new(
            all.tree.iter().map(|edge| (edge.a, edge.b)),
            (low - centre, high - centre),
            all.skin,
            |p| all.holds(p),
        );
        all
    }

    pub(super) fn contains(&self, at: Point) -> bool {
        let p = at - self.centre;
        self.clearance
            .holds(p)
            .unwrap_or_else(|| is_finite(p) && self.holds(p))
    }

    fn holds(&self, p: Point) -> bool {
        let ray = AABB::from_corners([p.x, p.y], [self.east.max(p.x) + 1.0, p.y]);
        let crossings = self
            .tree
            .locate_in_envelope_intersecting(&ray)
            .filter(|e| {
                // Half-open in y, so that a vertex counts once.
                let (low, high) = if e.a.y < e.b.y {
                    (e.a, e.b)
                } else {
                    (e.b, e.a)
                };
                low.y <= p.y && p.y < high.y && cross(high - low, p - low) > 0.0
            })
            .count();
        crossings % 2 == 1
            || self
                .tree
                .locate_within_distance([p.x, p.y], self.skin * self.skin)
                .next()
                .is_some()
    }

    /// See [`DirectionField::exit`](super::DirectionField::exit).
    pub(super) fn exit(&self, from: Point, to: Point) -> Option<Exit> {
        let (p, q) = (from - self.centre, to - self.centre);
        let run = q - p;
        // Nothing to meet on the way.
        let free = self.clearance.around(p) - 2.0 * self.skin;
        if free > 0.0 && dot(run, run) < free * free {
            return None;
        }
        let length = norm(run);
        if !(is_finite(p) && is_finite(q) && length > 0.0) {
            return None;
        }
        let skin = point(self.skin, self.skin);
        let (low, high) = (
            point(p.x.min(q.x), p.y.min(q.y)) - skin,
            point(p.x.max(q.x), p.y.max(q.y)) + skin,
        );
        let slack = self.skin / length;
        let mut hits: Vec<(f64, usize, usize)> = Vec::new();
        for e in self
            .tree
            .locate_in_envelope_intersecting(&AABB::from_corners([low.x, low.y], [high.x, high.y]))
        {
            let side = e.b - e.a;
            let area = cross(run, side);
            // Parallel edges are met through their neighbours' ends.
            if area == 0.0 {
                continue;
            }
            let t = cross(e.a - p, side) / area;
            let u = cross(e.a - p, run) / area;
            let margin = self.skin / norm(side);
            if t >= -slack && t <= 1.0 + slack && u >= -margin && u <= 1.0 + margin {
                hits.push((t.clamp(0.0, 1.0), e.ring, e.edge));
            }
        }
        hits.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        // Between two hits the segment is wholly inside or wholly outside: the
        // first stretch that is outside begins at the exit.
        for (i, &(t, ring, edge)) in hits.iter().enumerate() {
            let next = hits.get(i + 1).map_or(1.0, |hit| hit.0);
            let stretch = next - t;
            // The end itself on the boundary has not left the domain.
            if stretch * length > 2.0 * self.skin && !self.holds(p + run * (t + 0.5 * stretch)) {
                // Of the edges met in one point the first by label.
                let first = hits
                    .iter()
                    .find(|hit| (hit.0 - t).abs() <= slack)
                    .map_or((ring, edge), |hit| (hit.1, hit.2));
                return Some(Exit {
                    point: from + (to - from) * t,
                    ring: first.0,
                    edge: first.1,
                });
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{polygon, LineString};

    fn square_with_hole() -> Polygon<f64> {
        polygon!(
            exterior: [(x: 0.0, y: 0.0), (x: 10.0, y: 0.0), (x: 10.0, y: 10.0), (x: 0.0, y: 10.0)],
            interiors: [[(x: 4.0, y: 4.0), (x: 4.0, y: 6.0), (x: 6.0, y: 6.0), (x: 6.0, y: 4.0)]],
        )
    }

    #[test]
    fn inside_outside_and_boundary() {
        let edges = Edges::new(&square_with_hole());
        assert!(edges.contains(point(1.0, 1.0)));
        assert!(edges.contains(point(1.0, 4.0)));
        assert!(!edges.contains(point(5.0, 5.0)));
        assert!(!edges.contains(point(11.0, 5.0)));
        assert!(
            edges.contains(point(10.0, 3.0))
                && edges.contains(point(0.0, 0.0))
                && edges.contains(point(4.0, 5.0))
        );
    }

    #[test]
    fn exits_name_ring_and_edge() {
        let edges = Edges::new(&square_with_hole());
        let out = edges.exit(point(8.0, 5.0), point(14.0, 5.0)).unwrap();
        assert_eq!((out.ring, out.edge), (0, 1));
        assert!((out.point.x - 10.0).abs() < 1e-12);
        let hole = edges.exit(point(2.0, 5.0), point(9.0, 5.0)).unwrap();
        assert_eq!((hole.ring, hole.edge), (1, 0));
        assert!((hole.point.x - 4.0).abs() < 1e-12);
        assert_eq!(edges.exit(point(1.0, 1.0), point(9.0, 1.0)), None);
    }

    #[test]
    fn touching_is_not_leaving() {
        let edges = Edges::new(&square_with_hole());
        // From the boundary inwards, to the boundary, along it, past a corner.
        assert_eq!(edges.exit(point(0.0, 3.0), point(3.0, 3.0)), None);
        assert_eq!(edges.exit(point(3.0, 3.0), point(0.0, 3.0)), None);
        assert_eq!(edges.exit(point(0.0, 3.0), point(0.0, 8.0)), None);
        assert_eq!(
            edges.exit(point(2.0, 6.0), point(6.0, 2.0)).map(|e| e.ring),
            None
        );
        // From the boundary outwards: at once.
        let out = edges.exit(point(0.0, 3.0), point(-3.0, 3.0)).unwrap();
        assert_eq!((out.point, out.ring, out.edge), (point(0.0, 3.0), 0, 3));
        // Through a corner.
        let out = edges.exit(point(8.0, 8.0), point(12.0, 12.0)).unwrap();
        assert!(norm(out.point - point(10.0, 10.0)) < 1e-12);
    }

    #[test]
    fn map_coordinates_are_no_worse() {
        let shift = point(477_118.926, 5_550_910.149);
        let moved = |p: Point| p + shift;
        let ring = |line: &LineString<f64>| LineString(line.0.iter().map(|&p| moved(p)).collect());
        let at_home = square_with_hole();
        let domain = Polygon::new(
            ring(at_home.exterior()),
            at_home.interiors().iter().map(ring).collect(),
        );
        let edges = Edges::new(&domain);
        assert!(
            edges.contains(moved(point(10.0, 3.0))) && !edges.contains(moved(point(10.001, 3.0)))
        );
        let out = edges
            .exit(moved(point(8.0, 5.3)), moved(point(14.0, 5.3)))
            .unwrap();
        assert!(norm(out.point - moved(point(10.0, 5.3))) < 2e-9);
    }

    #[test]
    fn broken_domains_are_empty() {
        let nan = polygon![(x: 0.0, y: 0.0), (x: f64::NAN, y: 0.0), (x: 1.0, y: 1.0)];
        let none = Polygon::new(LineString(vec![]), vec![]);
        for domain in [nan, none] {
            let edges = Edges::new(&domain);
            assert!(!edges.contains(point(0.0, 0.0)));
            assert_eq!(edges.exit(point(0.0, 0.0), point(1.0, 0.0)), None);
        }
    }
}
