//! Places that are spread over an area, and the nodes that are nearest to them.

use geo_types::{Coord, Polygon};
use rstar::primitives::GeomWithData;
use rstar::RTree;

use super::graph::StreetGraph;
use crate::mesh::predicates::in_ring;

/// Points spread evenly over areas: a triangular lattice with about `count`
/// points in all, at least one, moved so that it does not depend on where the
/// areas are. Points in holes are left out; none if there is no area.
///
/// # Examples
///
/// ```
/// use network_opt::geo_types::polygon;
/// use network_opt::traffic::spread_points;
///
/// let site = polygon![(x: 0., y: 0.), (x: 900., y: 0.), (x: 900., y: 400.), (x: 0., y: 400.)];
/// let places = spread_points(&[site], 200);
/// assert!((190..=210).contains(&places.len()));
/// ```
#[must_use]
pub fn spread_points(areas: &[Polygon<f64>], count: usize) -> Vec<Coord<f64>> {
    let rings = || {
        areas
            .iter()
            .flat_map(|area| std::iter::once(area.exterior()).chain(area.interiors()))
    };
    let total: f64 = areas.iter().map(area).sum();
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
    for p in rings().flat_map(|ring| &ring.0) {
        (low, high) = (low.min(p.y), high.max(p.y));
        (left, right) = (left.min(p.x), right.max(p.x));
    }
    let sides = || rings().flat_map(|ring| ring.0.windows(2).map(|w| (w[0], w[1])));
    if !(total > 0.0 && total.is_finite()) || count == 0 {
        return Vec::new();
    }
    // A point of a triangular lattice has an area of root 3 / 2 of the square
    // of their distance.
    let mut apart = (total / count as f64 / 0.75_f64.sqrt()).sqrt();
    for _ in 0..40 {
        let rise = apart * 0.75_f64.sqrt();
        let mut points = Vec::new();
        let rows = ((high - low) / rise).ceil() as usize;
        let columns = ((right - left) / apart).ceil() as usize + 1;
        for row in 0..rows {
            let y = low + (row as f64 + 0.5) * rise;
            let shift = if row % 2 == 0 { 0.25 } else { 0.75 };
            for column in 0..columns {
                let p = Coord {
                    x: left + (column as f64 + shift) * apart,
                    y,
                };
                if in_ring(p, sides()) {
                    points.push(p);
                }
            }
        }
        if !points.is_empty() {
            return points;
        }
        // A thin area that the lattice misses.
        apart *= 0.7;
    }
    Vec::new()
}

/// The square metres of a polygon, its holes left out.
fn area(polygon: &Polygon<f64>) -> f64 {
    let of = |ring: &geo_types::LineString<f64>| {
        let Some(&o) = ring.0.first() else { return 0.0 };
        let twice: f64 = ring
            .0
            .windows(2)
            .map(|w| (w[0].x - o.x) * (w[1].y - o.y) - (w[1].x - o.x) * (w[0].y - o.y))
            .sum();
        twice.abs() / 2.0
    };
    of(polygon.exterior()) - polygon.interiors().iter().map(of).sum::<f64>()
}

/// For each place the nearest of the nodes that may be used; of equally near
/// ones that with the smallest number. Empty if there is none.
#[must_use]
pub fn nearest_nodes(
    graph: &StreetGraph,
    places: &[Coord<f64>],
    usable: &dyn Fn(usize) -> bool,
) -> Vec<usize> {
    let nodes: Vec<_> = (0..graph.nodes.len())
        .filter(|&n| usable(n))
        .map(|n| GeomWithData::new([graph.nodes[n].x, graph.nodes[n].y], n))
        .collect();
    let tree = RTree::bulk_load(nodes);
    let nearest = places.iter().map(|p| {
        let all = tree.nearest_neighbors(&[p.x, p.y]);
        all.into_iter().map(|found| found.data).min()
    });
    nearest.flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{coord, polygon};

    #[test]
    fn holes_stay_empty_and_slivers_do_not() {
        let ring = polygon!(
            exterior: [(x: 0., y: 0.), (x: 10., y: 0.), (x: 10., y: 10.), (x: 0., y: 10.)],
            interiors: [[(x: 1., y: 1.), (x: 1., y: 9.), (x: 9., y: 9.), (x: 9., y: 1.)]],
        );
        let points = spread_points(&[ring], 360);
        assert!((300..=420).contains(&points.len()), "{}", points.len());
        assert!(points.iter().all(|p| {
            let inside = |x: f64| (1.0..=9.0).contains(&x);
            !(inside(p.x) && inside(p.y))
        }));
        let sliver = polygon![(x: 0., y: 0.), (x: 1000., y: 0.), (x: 1000., y: 0.001)];
        assert!(!spread_points(&[sliver], 1).is_empty());
    }

    #[test]
    fn nothing_has_no_points() {
        let flat = polygon![(x: 0., y: 0.), (x: 1., y: 0.), (x: 2., y: 0.)];
        assert!(spread_points(&[flat], 10).is_empty());
        assert!(spread_points(&[], 10).is_empty());
    }

    #[test]
    fn the_first_of_equals_is_nearest() {
        let mut graph = StreetGraph::default();
        for x in [2.0, 0.0, 5.0] {
            graph.add_node(coord! { x: x, y: 0. });
        }
        let places = [coord! { x: 1., y: 0. }, coord! { x: 9., y: 9. }];
        assert_eq!(nearest_nodes(&graph, &places, &|_| true), [0, 2]);
        assert_eq!(nearest_nodes(&graph, &places, &|n| n != 0), [1, 2]);
        assert!(nearest_nodes(&graph, &places, &|_| false).is_empty());
    }
}
