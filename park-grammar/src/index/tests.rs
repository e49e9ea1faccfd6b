use super::*;
use crate::plane::Area;
use geo_types::coord;

fn region(points: &[(f64, f64)]) -> Region {
    let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
    let mut region = Region::bare(Area::new(ring, Vec::new()));
    park(&mut region);
    region
}

/// The side of the edge whose middle is nearest to a point.
fn side_at(region: &Region, x: f64, y: f64) -> Option<usize> {
    let at = coord! { x: x, y: y };
    let edges = region.edges(0);
    let nearest = edges.min_by(|a, b| {
        let away = |e: &(Coord<f64>, Coord<f64>, _)| {
            crate::plane::dist(crate::plane::nearest_on(e.0, e.1, at), at)
        };
        away(&(a.0, a.1, ())).total_cmp(&away(&(b.0, b.1, ())))
    });
    nearest.and_then(|(_, _, edge)| edge.side)
}

/// West 0, north 1, east 2, south 3, wherever the ring begins and however it runs.
#[test]
fn a_rectangle_along_the_axes() {
    let points = [(0., 0.), (8., 0.), (8., 5.), (0., 5.)];
    for start in 0..4 {
        let mut turned = points;
        turned.rotate_left(start);
        let mut back = turned;
        back.reverse();
        for points in [turned, back] {
            let region = region(&points);
            let found = [(0., 2.), (4., 5.), (8., 2.), (4., 0.)];
            let found = found.map(|(x, y)| side_at(&region, x, y));
            assert_eq!(found, [Some(0), Some(1), Some(2), Some(3)]);
            assert_eq!(region.local.corners[0], coord! { x: 0., y: 0. });
            assert_eq!(region.local.corners[2], coord! { x: 8., y: 5. });
        }
    }
}

/// A standing rectangle along the axes keeps the map's names; one that is turned
/// is laid on its longest edge.
#[test]
fn a_turned_rectangle_lies_on_its_longest_edge() {
    let standing = region(&[(0., 0.), (5., 0.), (5., 8.), (0., 8.)]);
    assert_eq!(side_at(&standing, 0., 4.), Some(0));
    // 5 x 10, the long edge up 4 in 3 to the north-east.
    let turned = region(&[(0., 0.), (6., 8.), (2., 11.), (-4., 3.)]);
    assert_eq!(side_at(&turned, -2., 1.5), Some(0));
    assert_eq!(side_at(&turned, -1., 7.), Some(1));
    assert_eq!(side_at(&turned, 4., 9.5), Some(2));
    assert_eq!(side_at(&turned, 3., 4.), Some(3));
}

/// Chamfers of 45 degrees belong to west and east, all four of them.
#[test]
fn a_rectangle_without_corners_is_a_quad() {
    let points = [
        (1., 0.),
        (9., 0.),
        (10., 1.),
        (10., 7.),
        (9., 8.),
        (1., 8.),
        (0., 7.),
        (0., 1.),
    ];
    let region = region(&points);
    assert_eq!(region.sides, 4);
    assert_eq!(side_at(&region, 0.5, 0.5), Some(0));
    assert_eq!(side_at(&region, 0.5, 7.5), Some(0));
    assert_eq!(side_at(&region, 9.5, 7.5), Some(2));
    assert_eq!(side_at(&region, 9.5, 0.5), Some(2));
}

/// Corners that are cut off by little are no corners: with edges of 0.3 m in a
/// perimeter of 34 m, less than 2 %.
#[test]
fn short_edges_make_no_corners() {
    let region = region(&[(0.2, 0.), (10., 0.), (10., 7.), (0., 7.), (0., 0.2)]);
    assert_eq!((region.sides, side_at(&region, 0., 3.)), (4, Some(0)));
}

/// An L has six sides, from the western one clockwise, and a triangle three.
#[test]
fn other_shapes_have_other_numbers_of_sides() {
    let l = region(&[(0., 0.), (9., 0.), (9., 3.), (3., 3.), (3., 9.), (0., 9.)]);
    assert_eq!(l.sides, 6);
    let found = [(0., 5.), (1.5, 9.), (3., 6.), (6., 3.), (9., 1.5), (4., 0.)];
    for (k, (x, y)) in found.into_iter().enumerate() {
        assert_eq!(side_at(&l, x, y), Some(k));
    }
    let triangle = region(&[(0., 0.), (10., 0.), (0., 10.)]);
    assert_eq!((triangle.sides, side_at(&triangle, 0., 5.)), (3, Some(0)));
}

/// A wavy edge is one side.
#[test]
fn a_curve_between_corners_is_one_side() {
    let mut points = vec![(0., 0.), (20., 0.)];
    points.extend((0..=20).rev().map(|k| {
        let x = f64::from(k);
        (x, 10.0 + 0.8 * (0.6 * x).sin())
    }));
    let region = region(&points);
    assert_eq!(region.sides, 4);
    let north = region.logical().into_iter().filter(|s| s.index == 1);
    assert_eq!(north.map(|s| s.edges.len()).collect::<Vec<_>>(), [20]);
}

/// Groups of cardinal directions of a mirrored shape are the mirrored groups, west
/// and east changing places; of any shape, with edges at 45 degrees among them.
#[test]
fn groups_are_mirrored() {
    let mut chance = crate::derive::Stream::new(5);
    for round in 0..300 {
        // On a grid of whole numbers many edges run at 45 degrees exactly.
        let points: Vec<Coord<f64>> = (0..16)
            .map(|k| {
                let angle = -(f64::from(k) + 0.9 * chance.unit()) / 16.0 * std::f64::consts::TAU;
                let radius = chance.between([8.0, 20.0]);
                let (x, y) = (radius * angle.cos(), radius * angle.sin());
                if round % 2 == 0 {
                    coord! { x: x.round(), y: y.round() }
                } else {
                    coord! { x: x, y: y }
                }
            })
            .collect();
        let lengths = |mirror: bool| {
            let flip = |p: &Coord<f64>| coord! { x: if mirror { -p.x } else { p.x }, y: p.y };
            let mut ring: Ring = points.iter().map(flip).collect();
            ring.dedup();
            let mut region = Region::bare(Area::new(ring, Vec::new()));
            by_local(&mut region);
            let mut lengths = [0.0; 4];
            for (a, b, edge) in region.edges(0) {
                lengths[edge.side.expect("has a side")] += crate::plane::dist(a, b);
            }
            lengths
        };
        let ([a, b, c, d], found) = (lengths(false), lengths(true));
        for (x, y) in [c, b, a, d].into_iter().zip(found) {
            assert!((x - y).abs() < 1e-9, "{points:?}");
        }
    }
}
