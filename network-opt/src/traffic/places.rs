//! Places that are spread over an area, and the nodes that are nearest to them.

use geo_types::{Coord, Polygon};
use rstar::primitives::GeomWithData;
use rstar::RTree;

use super::graph::StreetGraph;

/// `count` points spread evenly over areas, their holes left out: on rows as far
/// apart as the points on them. Where there is no area there is no point.
///
/// # Complexity
///
/// O(rows * sides + count): rows are about as many as the root of `count`, and more
/// for what is high and thin.
///
/// # Examples
///
/// ```
/// use network_opt::geo_types::polygon;
/// use network_opt::traffic::spread_points;
///
/// let site = polygon![(x: 0., y: 0.), (x: 900., y: 0.), (x: 900., y: 400.), (x: 0., y: 400.)];
/// let places = spread_points(&[site], 200);
/// assert_eq!(places.len(), 200);
/// ```
#[must_use]
pub fn spread_points(areas: &[Polygon<f64>], count: usize) -> Vec<Coord<f64>> {
    let total: f64 = areas.iter().map(area).sum();
    if !(total > 0.0 && total.is_finite()) || count == 0 {
        return Vec::new();
    }
    let rings = areas
        .iter()
        .flat_map(|area| std::iter::once(area.exterior()).chain(area.interiors()));
    let sides: Vec<[Coord<f64>; 2]> = rings
        .flat_map(|ring| ring.0.windows(2).map(|w| [w[0], w[1]]))
        .collect();
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for p in sides.iter().flatten() {
        (low, high) = (low.min(p.y), high.max(p.y));
    }
    let apart = (total / count as f64).sqrt();
    let mut rows = ((high - low) / apart).round().clamp(1.0, MOST_ROWS);
    // Rows may miss all of several thin areas; finer ones do not.
    for _ in 0..20 {
        let chords: Vec<[Coord<f64>; 2]> = (0..rows as usize)
            .flat_map(|row| chords(&sides, low + (row as f64 + 0.5) * (high - low) / rows))
            .collect();
        let length: f64 = chords.iter().map(|[a, b]| b.x - a.x).sum();
        if length > 0.0 {
            return along(&chords, length, count);
        }
        rows = (2.0 * rows).min(MOST_ROWS);
    }
    Vec::new()
}

/// Enough for a million points on what is ten thousand times as high as wide.
const MOST_ROWS: f64 = 1e8;

/// Where a row lies within the areas, from west to east.
fn chords(sides: &[[Coord<f64>; 2]], y: f64) -> Vec<[Coord<f64>; 2]> {
    let crossing = sides.iter().filter(|[a, b]| (a.y <= y) != (b.y <= y));
    let mut at: Vec<f64> = crossing
        .map(|[a, b]| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
        .collect();
    at.sort_by(f64::total_cmp);
    at.chunks_exact(2)
        .map(|x| [Coord { x: x[0], y }, Coord { x: x[1], y }])
        .collect()
}

/// So many points at even steps along chords laid end to end.
fn along(chords: &[[Coord<f64>; 2]], length: f64, count: usize) -> Vec<Coord<f64>> {
    let mut points = Vec::with_capacity(count);
    let mut gone = 0.0;
    for (k, [a, b]) in chords.iter().enumerate() {
        let end = gone + (b.x - a.x);
        while points.len() < count {
            let next = length * (points.len() as f64 + 0.5) / count as f64;
            // The last chord takes what rounding leaves.
            if next >= end && k + 1 < chords.len() {
                break;
            }
            points.push(Coord {
                x: (a.x + next - gone).min(b.x),
                y: a.y,
            });
        }
        gone = end;
    }
    points
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
        assert_eq!(points.len(), 360);
        let inside = |x: f64| (1.0 + 1e-9..=9.0 - 1e-9).contains(&x);
        assert!(!points.iter().any(|p| inside(p.x) && inside(p.y)));
        // 32 rows: three of 10 m below the hole and above it, 26 of 2 m between,
        // 112 m in all; below it 360 * 30 / 112 points, or one more or less.
        let low = points.iter().filter(|p| p.y < 1.0).count();
        assert!((95..=98).contains(&low), "{low}");
        let flat = polygon![(x: 0., y: 0.), (x: 1000., y: 0.), (x: 1000., y: 0.001)];
        assert_eq!(spread_points(&[flat], 7).len(), 7);
        let high = polygon![(x: 0., y: 0.), (x: 0.001, y: 0.), (x: 0.001, y: 1e5)];
        assert_eq!(spread_points(&[high], 1000).len(), 1000);
        let apart = [0.0, 9.0].map(|y: f64| polygon![(x: 0., y: y), (x: 1., y: y), (x: 1., y: y + 0.1), (x: 0., y: y + 0.1)]);
        assert_eq!(spread_points(&apart, 3).len(), 3);
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
