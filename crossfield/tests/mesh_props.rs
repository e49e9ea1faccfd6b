//! Laws of the mesh: large ones (whose core is not asked of the general
//! triangulation), graded ones, and constraint lines.

mod shapes;

use std::collections::BTreeMap;

use crossfield::geo_types::{coord, Coord, LineString, Polygon};
use crossfield::{Cursor, Domain, DomainOptions, FieldError};
use proptest::prelude::*;
use shapes::{config, polygon, shape};

fn corners(domain: &Domain, t: usize) -> [Coord<f64>; 3] {
    domain.triangles()[t].map(|v| domain.vertex(v as usize))
}

fn orient(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

fn length(a: Coord<f64>, b: Coord<f64>) -> f64 {
    (a.x - b.x).hypot(a.y - b.y)
}

/// Angle at `a` in the triangle `a b c`.
fn angle(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> f64 {
    let dot = (b.x - a.x) * (c.x - a.x) + (b.y - a.y) * (c.y - a.y);
    orient(a, b, c).atan2(dot)
}

/// Positive triangles that add up to the area, each inner edge in two of
/// them and each border in one; gives for each inner edge the sum of the
/// angles opposite to it.
fn sound(domain: &Domain) -> Result<BTreeMap<(u32, u32), f64>, TestCaseError> {
    let mut area = 0.0;
    let mut sides: BTreeMap<(u32, u32), f64> = BTreeMap::new();
    for (t, triangle) in domain.triangles().iter().enumerate() {
        let points = corners(domain, t);
        let twice = orient(points[0], points[1], points[2]);
        prop_assert!(twice > 0.0);
        area += twice / 2.0;
        for k in 0..3 {
            let edge = (triangle[k], triangle[(k + 1) % 3]);
            let opposite = angle(points[(k + 2) % 3], points[k], points[(k + 1) % 3]);
            prop_assert!(sides.insert(edge, opposite).is_none(), "two on one side");
        }
    }
    prop_assert!((area / domain.area() - 1.0).abs() < 1e-9);
    let mut inner = BTreeMap::new();
    for (&(a, b), angle) in &sides {
        match sides.get(&(b, a)) {
            Some(other) => drop(inner.insert((a.min(b), a.max(b)), angle + other)),
            None => {
                let ends = [a, b].map(|v| domain.is_boundary(v as usize));
                prop_assert!(ends == [true, true], "a border inside");
            }
        }
    }
    Ok(inner)
}

/// The pieces of a segment inside the polygon, by all its crossings.
fn length_inside(shape: &Polygon<f64>, a: Coord<f64>, b: Coord<f64>) -> f64 {
    let lines: Vec<&LineString<f64>> = std::iter::once(shape.exterior())
        .chain(shape.interiors())
        .collect();
    let mut cuts = vec![0.0, 1.0];
    for w in lines.iter().flat_map(|line| line.0.windows(2)) {
        let (u, v) = (orient(w[0], w[1], a), orient(w[0], w[1], b));
        if orient(a, b, w[0]) * orient(a, b, w[1]) < 0.0 && u * v < 0.0 {
            cuts.push(u / (u - v));
        }
    }
    cuts.sort_by(f64::total_cmp);
    let at = |t: f64| coord! {x: a.x + (b.x - a.x) * t, y: a.y + (b.y - a.y) * t};
    let inside = |p: Coord<f64>| {
        let crossed = lines.iter().flat_map(|line| line.0.windows(2)).filter(|w| {
            (w[0].y > p.y) != (w[1].y > p.y)
                && p.x < w[0].x + (p.y - w[0].y) / (w[1].y - w[0].y) * (w[1].x - w[0].x)
        });
        crossed.count() % 2 == 1
    };
    cuts.windows(2)
        .filter(|c| inside(at((c[0] + c[1]) / 2.0)))
        .map(|c| (c[1] - c[0]) * length(a, b))
        .sum()
}

fn options(edge_length: f64) -> DomainOptions {
    DomainOptions {
        edge_length,
        ..DomainOptions::default()
    }
}

proptest! {
    #![proptest_config(config(4))]

    /// A mesh of 10 000 to 50 000 vertices is a Delaunay triangulation all
    /// over, the seam between its core and the band around it included: the
    /// angles opposite to an edge add up to at most half a turn.
    #[test]
    fn large_meshes_are_delaunay(shape in polygon(), step in 1.5..2.5_f64, turn in -4.0..4.0_f64) {
        let shape = shapes::turned(&shape, turn, (3e5, -5e6));
        let domain = Domain::new(&shape, &options(step))?;
        prop_assert_eq!(domain.euler_characteristic(), 1 - shape.interiors().len() as i32);
        for (edge, angles) in sound(&domain)? {
            // Map coordinates are rounded to 1e-9 m: angles to 1e-9.
            prop_assert!(angles < std::f64::consts::PI + 1e-7, "{:?}", edge);
        }
        let mut cursor = Cursor::default();
        for t in (0..domain.triangles().len()).step_by(97) {
            let [a, b, c] = corners(&domain, t);
            let at = coord! {x: (a.x + b.x + c.x) / 3.0, y: (a.y + b.y + c.y) / 3.0};
            prop_assert_eq!(domain.locate(at, &mut Cursor::default()), Some(t));
            prop_assert_eq!(domain.locate(at, &mut cursor), Some(t));
        }
    }
}

proptest! {
    #![proptest_config(config(16))]

    /// Every straight part of a line that lies inside is made of mesh edges,
    /// and nothing else is; triangles still tile the polygon.
    #[test]
    fn constraint_lines_are_edges_of_the_mesh(
        shape in polygon(),
        ends in proptest::collection::vec((-250.0..250.0_f64, -250.0..250.0_f64), 2..9),
        step in 8.0..30.0_f64, whole in any::<bool>(),
    ) {
        // One long line with bends, which may cross itself, or many short.
        let points: Vec<Coord<f64>> = ends.iter().map(|&(x, y)| coord! {x: x, y: y}).collect();
        let lines: Vec<LineString<f64>> = if whole {
            vec![LineString(points)]
        } else {
            points.windows(2).map(|w| LineString(w.to_vec())).collect()
        };
        let domain = Domain::with_lines(&shape, &lines, &options(step))?;
        sound(&domain)?;
        let mut drawn = vec![0.0; lines.len()];
        for edge in domain.line_edges() {
            let (a, b) = (domain.vertex(edge.from), domain.vertex(edge.to));
            prop_assert!(domain.neighbours(edge.from).contains(&(edge.to as u32)));
            prop_assert!(length(a, b) < step * (1.0 + 1e-9));
            drawn[edge.line] += length(a, b);
            let middle = coord! {x: (a.x + b.x) / 2.0, y: (a.y + b.y) / 2.0};
            let gap = lines[edge.line].0.windows(2).map(|w| {
                let long = length(w[0], w[1]);
                let t = ((middle.x - w[0].x) * (w[1].x - w[0].x) + (middle.y - w[0].y) * (w[1].y - w[0].y)) / (long * long);
                let t = t.clamp(0.0, 1.0);
                length(middle, coord! {x: w[0].x + (w[1].x - w[0].x) * t, y: w[0].y + (w[1].y - w[0].y) * t})
            });
            prop_assert!(gap.fold(f64::MAX, f64::min) < 1e-6);
        }
        for (line, drawn) in lines.iter().zip(drawn) {
            let wanted: f64 = line.0.windows(2).map(|w| length_inside(&shape, w[0], w[1])).sum();
            // Ends are moved by 1e-9 of the size at most, 6e-7 m each.
            prop_assert!((drawn - wanted).abs() < 1e-5, "{} {}", drawn, wanted);
        }
    }

    /// Graded meshes are as fine as asked on the boundary, as coarse as asked
    /// inside, and keep their angles.
    #[test]
    fn graded_meshes_grow_inwards(
        shape in polygon(), step in 20.0..40.0_f64, ratio in 0.05..0.5_f64, grading in 0.2..1.0_f64,
    ) {
        let fine = step * ratio;
        let graded = DomainOptions { grading, boundary_length: fine, ..options(step) };
        let domain = Domain::new(&shape, &graded)?;
        sound(&domain)?;
        let mut longest = 0.0_f64;
        for v in 0..domain.vertex_count() {
            let p = domain.vertex(v);
            let off = length(p, domain.nearest_boundary(p).point);
            for &w in domain.neighbours(v) {
                let q = domain.vertex(w as usize);
                longest = longest.max(length(p, q));
                if domain.is_boundary(v) && domain.is_boundary(w as usize) {
                    continue;
                }
                // The lattice has steps of powers of two, within a ratio of
                // sqrt 2 of what is wanted at its nearer end; a triangle in
                // between has edges of the coarser one, and refinement allows
                // 2.2 as on an even mesh.
                let wanted = (fine + grading * off).min(step);
                prop_assert!(length(p, q) < 2.2 * 1.5 * wanted + grading * length(p, q), "{} {}", length(p, q), wanted);
            }
        }
        prop_assert!(longest < 2.2 * step);
        let even = Domain::new(&shape, &options(fine.max(2.0)))?;
        prop_assert!(ratio > 0.2 || domain.vertex_count() < even.vertex_count());
    }
}

/// A square with a short edge, meshed finely there and coarsely elsewhere,
/// with angles as wide as on an even mesh.
#[test]
fn short_features_are_graded_to() {
    let square = shape(&[
        (0., 0.),
        (100., 0.),
        (100., 50.),
        (100.2, 50.),
        (100.2, 100.),
        (0., 100.),
    ]);
    let graded = DomainOptions {
        grading: 0.5,
        ..options(10.0)
    };
    let domain = Domain::new(&square, &graded).expect("valid");
    assert!(domain.min_angle().to_degrees() > 24.0);
    assert!(domain.vertex_count() < 800, "{}", domain.vertex_count());
    for v in 0..domain.vertex_count() {
        let at = domain.vertex(v);
        let off = length(at, coord! {x: 100.1, y: 50.0});
        let longest = domain
            .neighbours(v)
            .iter()
            .map(|&w| length(at, domain.vertex(w as usize)))
            .fold(0.0, f64::max);
        assert!(longest < 3.0 * (0.2 + 0.5 * off), "{at:?} {longest}");
    }
}

#[test]
fn lines_that_meet_the_boundary_and_each_other() {
    let square = shape(&[(0., 0.), (10., 0.), (10., 10.), (0., 10.)]);
    let line = |points: &[(f64, f64)]| shapes::ring(points);
    let lines = [
        // From corner to corner, along a side, outside, a closed loop, a
        // point, a line twice, and three lines through one point.
        line(&[(0., 0.), (10., 10.)]),
        line(&[(0., 0.), (10., 0.)]),
        line(&[(20., 0.), (30., 5.)]),
        line(&[(2., 6.), (4., 6.), (4., 8.), (2., 8.), (2., 6.)]),
        line(&[(3., 3.)]),
        line(&[(0., 0.), (10., 10.)]),
        line(&[(0., 10.), (10., 0.)]),
        line(&[(5., 0.), (5., 10.)]),
        LineString(vec![]),
    ];
    let domain = Domain::with_lines(&square, &lines, &options(1.0)).expect("valid");
    let mut drawn = [0.0; 9];
    for edge in domain.line_edges() {
        drawn[edge.line] += length(domain.vertex(edge.from), domain.vertex(edge.to));
    }
    let diagonal = 200.0_f64.sqrt();
    let wanted = [diagonal, 0.0, 0.0, 8.0, 0.0, 0.0, diagonal, 10.0, 0.0];
    for (k, (drawn, wanted)) in drawn.iter().zip(wanted).enumerate() {
        assert!((drawn - wanted).abs() < 1e-9, "{k}: {drawn} {wanted}");
    }
    assert_eq!(domain.euler_characteristic(), 1);
    let bad = line(&[(1., 1.), (f64::NAN, 2.)]);
    let error = Domain::with_lines(&square, &[bad], &options(1.0)).expect_err("refused");
    assert!(matches!(error, FieldError::BadLine { line: 0, .. }));
}
