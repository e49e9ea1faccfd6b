//! Laws of the triangulated domain.

mod shapes;

use crossfield::geo_types::{coord, Coord, Polygon};
use crossfield::{Cursor, Domain, DomainOptions};
use proptest::prelude::*;
use shapes::{config, domain, map, polygon};

fn signed_area(line: &[Coord<f64>]) -> f64 {
    let o = line[0];
    line.windows(2)
        .map(|w| (w[0].x - o.x) * (w[1].y - o.y) - (w[1].x - o.x) * (w[0].y - o.y))
        .sum::<f64>()
        / 2.0
}

fn area(polygon: &Polygon<f64>) -> f64 {
    signed_area(&polygon.exterior().0).abs()
        - polygon
            .interiors()
            .iter()
            .map(|r| signed_area(&r.0).abs())
            .sum::<f64>()
}

fn triangle(domain: &Domain, t: usize) -> [Coord<f64>; 3] {
    domain.triangles()[t].map(|v| domain.vertex(v as usize))
}

fn orient(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// Edges of all input rings with their names.
fn edges(polygon: &Polygon<f64>) -> Vec<(usize, usize, Coord<f64>, Coord<f64>)> {
    std::iter::once(polygon.exterior())
        .chain(polygon.interiors())
        .enumerate()
        .flat_map(|(r, line)| {
            let pairs = line.0.windows(2).enumerate();
            pairs.map(move |(e, w)| (r, e, w[0], w[1]))
        })
        .collect()
}

fn distance(p: Coord<f64>, a: Coord<f64>, b: Coord<f64>) -> f64 {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let t = ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy);
    let t = t.clamp(0.0, 1.0);
    (p.x - a.x - t * dx).hypot(p.y - a.y - t * dy)
}

proptest! {
    #![proptest_config(config(24))]

    #[test]
    fn triangles_tile_the_polygon(shape in polygon(), step in 8.0..40.0_f64) {
        let domain = domain(&shape, step);
        let mut total = 0.0;
        for t in 0..domain.triangles().len() {
            let [a, b, c] = triangle(&domain, t);
            prop_assert!(orient(a, b, c) > 0.0);
            total += orient(a, b, c) / 2.0;
        }
        prop_assert!((total / area(&shape) - 1.0).abs() < 1e-9);
        prop_assert!((domain.area() / area(&shape) - 1.0).abs() < 1e-12);
        prop_assert_eq!(domain.euler_characteristic(), 1 - shape.interiors().len() as i32);
        // Every vertex on the boundary says so, and no other.
        for v in 0..domain.vertex_count() {
            let p = domain.vertex(v);
            let gap = edges(&shape).iter().map(|e| distance(p, e.2, e.3)).fold(f64::MAX, f64::min);
            prop_assert_eq!(domain.is_boundary(v), gap < 1e-9, "vertex {} is {} off", v, gap);
        }
    }

    #[test]
    fn edges_are_about_as_long_as_asked(shape in polygon(), step in 8.0..40.0_f64) {
        let domain = domain(&shape, step);
        for v in 0..domain.vertex_count() {
            let p = domain.vertex(v);
            for &w in domain.neighbours(v) {
                let q = domain.vertex(w as usize);
                // The area limit of refinement allows some longer ones.
                prop_assert!((p.x - q.x).hypot(p.y - q.y) < 2.2 * step);
            }
        }
    }

    #[test]
    fn angles_are_wide_where_the_boundary_allows(count in 4..24_usize, step in 8.0..40.0_f64) {
        let shape = Polygon::new(shapes::regular(count, 150.0, (1e5, -3e5)), vec![]);
        prop_assert!(domain(&shape, step).min_angle().to_degrees() > 24.9);
    }

    #[test]
    fn location_agrees_with_trying_all_triangles(
        shape in polygon(),
        points in proptest::collection::vec((-220.0..220.0_f64, -220.0..220.0_f64), 40),
    ) {
        let domain = domain(&shape, 25.0);
        let mut cursor = Cursor::default();
        for (x, y) in points {
            let at = coord! {x: x, y: y};
            let inside = (0..domain.triangles().len()).find(|&t| {
                let [a, b, c] = triangle(&domain, t);
                orient(a, b, at) >= 0.0 && orient(b, c, at) >= 0.0 && orient(c, a, at) >= 0.0
            });
            let found = domain.locate(at, &mut cursor);
            prop_assert_eq!(found.is_some(), inside.is_some());
            prop_assert_eq!(found, domain.locate(at, &mut Cursor::default()));
            if let Some(t) = found {
                let [a, b, c] = triangle(&domain, t);
                for side in [orient(a, b, at), orient(b, c, at), orient(c, a, at)] {
                    prop_assert!(side > -1e-6);
                }
            }
        }
    }

    #[test]
    fn exits_agree_with_trying_all_edges(
        shape in polygon(),
        ends in proptest::collection::vec((-220.0..220.0_f64, -220.0..220.0_f64), 40),
    ) {
        let domain = domain(&shape, 25.0);
        let mut cursor = Cursor::default();
        for pair in ends.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|(x, y)| coord! {x: x, y: y});
            if domain.locate(from, &mut Cursor::default()).is_none() {
                continue;
            }
            let mut first: Option<(f64, usize, usize)> = None;
            for (ring, edge, a, b) in edges(&shape) {
                let (s, t) = (orient(from, to, a), orient(from, to, b));
                let (u, v) = (orient(a, b, from), orient(a, b, to));
                if s * t < 0.0 && u * v < 0.0 {
                    let along = u / (u - v);
                    if first.is_none_or(|(best, ..)| along < best) {
                        first = Some((along, ring, edge));
                    }
                }
            }
            let exit = domain.exit(from, to, &mut cursor);
            prop_assert_eq!(exit.map(|e| (e.ring, e.edge)), first.map(|f| (f.1, f.2)));
            if let (Some(exit), Some((along, ..))) = (exit, first) {
                let x = from.x + along * (to.x - from.x);
                let y = from.y + along * (to.y - from.y);
                prop_assert!((exit.point.x - x).hypot(exit.point.y - y) < 1e-7);
                // What was left can be located again, from the boundary.
                prop_assert!(domain.locate(exit.point, &mut cursor).is_some());
            }
        }
    }

    #[test]
    fn the_nearest_boundary_point_is_the_nearest(
        shape in polygon(), x in -300.0..300.0_f64, y in -300.0..300.0_f64,
    ) {
        let domain = domain(&shape, 40.0);
        let at = coord! {x: x, y: y};
        let near = domain.nearest_boundary(at);
        let found = (near.point.x - x).hypot(near.point.y - y);
        let least = edges(&shape).iter().map(|e| distance(at, e.2, e.3)).fold(f64::MAX, f64::min);
        prop_assert!((found - least).abs() < 1e-9);
    }

    /// Far from the origin, and in units of another power of two, the mesh is
    /// the same to the bit: coordinates on a grid of 1/64 leave subtraction
    /// of the centre exact.
    #[test]
    fn place_and_scale_change_nothing(shape in polygon()) {
        let grid = |v: f64| (v * 64.0).round() / 64.0;
        let shape = map(&shape, |p| coord! {x: grid(p.x), y: grid(p.y)});
        let here = domain(&shape, 25.0);
        let there = domain(&map(&shape, |p| coord! {x: p.x + 499_968.0, y: p.y + 5_250_048.0}), 25.0);
        let small = domain(&map(&shape, |p| coord! {x: p.x / 1024.0, y: p.y / 1024.0}), 25.0 / 1024.0);
        prop_assert_eq!(here.triangles(), there.triangles());
        prop_assert_eq!(here.triangles(), small.triangles());
    }

    /// Rings may run either way and start anywhere: the domain is the same
    /// area, and exits name the input's own edges.
    #[test]
    fn orientation_of_the_input_is_free(shape in polygon()) {
        let reversed = Polygon::new(
            shape.exterior().0.iter().rev().copied().collect(),
            shape.interiors().iter().map(|r| r.0.iter().rev().copied().collect()).collect(),
        );
        let (one, other) = (domain(&shape, 30.0), domain(&reversed, 30.0));
        prop_assert!((one.area() / other.area() - 1.0).abs() < 1e-12);
        let count = shape.exterior().0.len() - 1;
        for k in 0..count {
            let (a, b) = (shape.exterior().0[k], shape.exterior().0[k + 1]);
            let middle = coord! {x: (a.x + b.x) / 2.0, y: (a.y + b.y) / 2.0};
            prop_assert_eq!(one.nearest_boundary(middle).edge, k);
            prop_assert_eq!(other.nearest_boundary(middle).edge, count - 1 - k);
        }
    }

    /// Needles, near-touching holes and budgets never panic nor lose area.
    #[test]
    fn needle_thin_parts_are_survived(
        width in -5.5..0.0_f64, length in 10.0..1000.0_f64, step in 1.0..30.0_f64,
    ) {
        let w = 10.0_f64.powf(width);
        // A square with a needle-thin arm, and a hole just off its side.
        let gap = w.max(1e-4);
        let shape = Polygon::new(
            shapes::ring(&[(0.0, 0.0), (40.0, 0.0), (40.0, 20.0), (40.0 + length, 20.0),
                (40.0 + length, 20.0 + w), (40.0, 20.0 + w), (40.0, 40.0), (0.0, 40.0)]),
            vec![shapes::ring(&[(gap, 10.0), (gap, 30.0), (10.0, 20.0)])],
        );
        let options = DomainOptions { edge_length: step, ..DomainOptions::default() };
        let domain = Domain::new(&shape, &options).expect("valid");
        prop_assert!((domain.area() / area(&shape) - 1.0).abs() < 1e-9);
        prop_assert!(domain.vertex_count() < 20_000);
    }
}

#[test]
fn equal_input_gives_the_same_mesh_and_other_options_another() {
    let shape = shapes::shape(&[
        (0.0, 0.0),
        (60.0, 5.0),
        (50.0, 40.0),
        (8.0, 33.0),
        (0.0, 0.0),
    ]);
    let of = |edge_length: f64| {
        let options = DomainOptions {
            edge_length,
            ..DomainOptions::default()
        };
        Domain::new(&shape, &options).expect("valid")
    };
    let domain = of(5.0);
    assert!(domain.is_same(&domain.clone()));
    assert!(domain.is_same(&of(5.0)));
    assert!(!domain.is_same(&of(6.0)));
    let moved = Domain::new(
        &map(&shape, |c| coord! { x: c.x + 1.0, y: c.y }),
        &DomainOptions {
            edge_length: 5.0,
            ..DomainOptions::default()
        },
    )
    .expect("valid");
    assert!(!domain.is_same(&moved));
}
