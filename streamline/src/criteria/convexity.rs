//! Convexity: how far a tile is from its convex hull.

use crate::tiles::Tiling;
use crate::vector::{cross, distance, Point};

/// What rounding makes of a convex tile: far below any shape.
const ROUNDING: f64 = 1e-12;

/// Perimeter of a tile, all its rings, in metres.
pub(super) fn perimeter(tiling: &Tiling, tile: usize) -> f64 {
    let sides = tiling.tiles[tile].rings.iter().flatten();
    sides
        .map(|h| {
            let [a, b] = tiling.edges[h.edge].vertices;
            distance(tiling.vertices[a], tiling.vertices[b])
        })
        .sum()
}

/// 1 - hull perimeter / perimeter, from 0 for a convex tile to below 1.
pub(super) fn convexity(tiling: &Tiling, tile: usize, perimeter: f64) -> f64 {
    let Some(exterior) = tiling.tiles[tile].rings.first() else {
        return 0.0;
    };
    let points = exterior.iter().map(|&h| tiling.vertices[tiling.tail(h)]);
    let hull = hull_perimeter(points.collect());
    let short = 1.0 - hull / perimeter;
    // An empty tile has no perimeter: it is as convex as can be.
    if short > ROUNDING {
        short
    } else {
        0.0
    }
}

/// Perimeter of the convex hull (A. M. Andrew's monotone chain, 1979).
fn hull_perimeter(mut points: Vec<Point>) -> f64 {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let mut sum = 0.0;
    let mut chain: Vec<Point> = Vec::with_capacity(points.len());
    // Below from left to right, then above and back.
    for _ in 0..2 {
        chain.clear();
        for &p in &points {
            while let [.., a, b] = chain[..] {
                if cross(b - a, p - b) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        sum += chain.windows(2).map(|c| distance(c[0], c[1])).sum::<f64>();
        points.reverse();
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tiles::{tiles, TileOptions};
    use crate::vector::point;
    use geo_types::{line_string, polygon, Polygon};

    fn of(shape: &Polygon<f64>) -> f64 {
        let tiling = tiles(shape, &[], &TileOptions::default()).unwrap();
        convexity(&tiling, 0, perimeter(&tiling, 0))
    }

    #[test]
    fn an_l_lacks_its_notch() {
        // 30 x 20 without a notch of 12 x 5: the hull cuts the corner by 13.
        let shape = polygon![(x: 0., y: 0.), (x: 30., y: 0.), (x: 30., y: 15.), (x: 18., y: 15.), (x: 18., y: 20.), (x: 0., y: 20.)];
        assert!((of(&shape) - (12.0 + 5.0 - 13.0) / 100.0).abs() < 1e-15);
    }

    #[test]
    fn convex_tiles_are_zero_with_vertices_on_their_sides_too() {
        assert_eq!(
            of(&polygon![(x: 0.1, y: 0.7), (x: 31., y: -2.3), (x: 17.9, y: 44.)]),
            0.0
        );
        let land = polygon![(x: 0.3, y: 0.1), (x: 97.1, y: 31.7), (x: 70.2, y: 111.3), (x: -26.6, y: 79.7)];
        // Lines end on each other all along.
        let lines: Vec<_> = (1..7)
            .map(|i| {
                let t = f64::from(i) / 7.0;
                let a = land.exterior().0[0] * (1.0 - t) + land.exterior().0[1] * t;
                let b = land.exterior().0[3] * (1.0 - t) + land.exterior().0[2] * t;
                line_string![a, b]
            })
            .collect();
        let tiling = tiles(&land, &lines, &TileOptions::default()).unwrap();
        assert!(tiling.tiles.len() == 7);
        for tile in 0..7 {
            assert_eq!(convexity(&tiling, tile, perimeter(&tiling, tile)), 0.0);
        }
    }

    #[test]
    fn a_hole_counts_as_a_dent() {
        let yard = polygon!(
            exterior: [(x: 0., y: 0.), (x: 30., y: 0.), (x: 30., y: 30.), (x: 0., y: 30.)],
            interiors: [[(x: 10., y: 10.), (x: 20., y: 10.), (x: 20., y: 20.), (x: 10., y: 20.)]],
        );
        assert!((of(&yard) - 0.25).abs() < 1e-15, "40 of 160 m");
    }

    #[test]
    fn hulls_of_degenerate_points() {
        assert_eq!(hull_perimeter(vec![]), 0.0);
        assert_eq!(hull_perimeter(vec![point(3., 4.); 4]), 0.0);
        assert_eq!(
            hull_perimeter(vec![point(0., 0.), point(6., 8.), point(3., 4.)]),
            20.0
        );
    }
}
