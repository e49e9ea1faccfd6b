//! Every kind of bad input has its own error, and none panics.

mod shapes;

use crossfield::geo_types::{LineString, Polygon};
use crossfield::{Domain, DomainOptions, FieldDesign, FieldError, HarmonicField};
use shapes::{ring, shape};

fn refused(polygon: &Polygon<f64>) -> FieldError {
    Domain::new(polygon, &DomainOptions::default()).expect_err("must be refused")
}

const SQUARE: [(f64, f64); 4] = [(0., 0.), (10., 0.), (10., 10.), (0., 10.)];

#[test]
fn numbers_that_are_none() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e200] {
        let error = refused(&shape(&[(0., 0.), (1., 0.), (1., bad), (0., 1.)]));
        assert_eq!(error, FieldError::NonFinite { ring: 0, vertex: 2 });
        let hole = ring(&[(bad, 4.), (5., 4.), (5., 5.)]);
        let error = refused(&Polygon::new(ring(&SQUARE), vec![hole]));
        assert_eq!(error, FieldError::NonFinite { ring: 1, vertex: 0 });
    }
}

#[test]
fn rings_without_area() {
    let flat = [(0., 0.), (1., 1.), (2., 2.), (5., 5.)];
    for points in [&[][..], &SQUARE[..1], &SQUARE[..2], &[(1., 1.); 5], &flat] {
        assert_eq!(refused(&shape(points)), FieldError::ZeroArea { ring: 0 });
    }
    let hole = ring(&[(2., 2.), (3., 3.), (4., 4.)]);
    let error = refused(&Polygon::new(ring(&SQUARE), vec![hole]));
    assert_eq!(error, FieldError::ZeroArea { ring: 1 });
    let empty = Polygon::new(ring(&SQUARE), vec![LineString(vec![])]);
    assert_eq!(refused(&empty), FieldError::ZeroArea { ring: 1 });
}

#[test]
fn crossing_and_overlapping_edges() {
    // A bow-tie of unequal wings.
    let error = refused(&shape(&[(0., 0.), (10., 10.), (10., 0.), (0., 6.)]));
    let FieldError::SelfIntersecting {
        ring,
        edge,
        other_ring,
        other_edge,
        ..
    } = error
    else {
        panic!("{error}");
    };
    assert_eq!((ring, other_ring), (0, 0));
    assert_eq!((edge.min(other_edge), edge.max(other_edge)), (0, 2));
    let cases = [
        // A hole across the exterior, holes across each other.
        (vec![shapes::ring(&[(5., 5.), (15., 5.), (5., 8.)])]),
        (vec![
            shapes::ring(&[(2., 2.), (6., 2.), (4., 6.)]),
            shapes::ring(&[(2., 5.), (4., 1.), (6., 5.)]),
        ]),
        // The same hole twice.
        (vec![
            shapes::ring(&[(2., 2.), (6., 2.), (4., 6.)]),
            shapes::ring(&[(2., 2.), (6., 2.), (4., 6.)]),
        ]),
    ];
    for holes in cases {
        let error = refused(&Polygon::new(shapes::ring(&SQUARE), holes));
        assert!(
            matches!(error, FieldError::SelfIntersecting { .. }),
            "{error}"
        );
    }
    // A spike without width.
    let error = refused(&shape(&[
        (0., 0.),
        (10., 0.),
        (10., 10.),
        (5., 10.),
        (5., 15.),
        (5., 10.),
        (0., 10.),
    ]));
    assert!(
        matches!(error, FieldError::SelfIntersecting { .. }),
        "{error}"
    );
}

#[test]
fn holes_in_the_wrong_place() {
    for hole in [
        ring(&[(20., 20.), (21., 20.), (21., 21.)]),
        ring(&[(-90., -90.), (90., -90.), (0., 90.)]),
    ] {
        let error = refused(&Polygon::new(ring(&SQUARE), vec![hole]));
        assert_eq!(error, FieldError::HoleOutside { ring: 1 });
    }
    let nested = vec![
        ring(&[(1., 1.), (9., 1.), (9., 9.), (1., 9.)]),
        ring(&[(4., 4.), (5., 4.), (5., 5.)]),
    ];
    let error = refused(&Polygon::new(ring(&SQUARE), nested));
    assert_eq!(error, FieldError::HoleOutside { ring: 2 });
}

#[test]
fn too_many_vertices() {
    let big = shape(&[(0., 0.), (1e6, 0.), (1e6, 1e6), (0., 1e6)]);
    let options = DomainOptions {
        edge_length: 0.5,
        ..DomainOptions::default()
    };
    let error = Domain::new(&big, &options).expect_err("a million times too fine");
    assert!(matches!(
        error,
        FieldError::TooManyVertices {
            allowed: 200_000,
            ..
        }
    ));
    let options = DomainOptions {
        max_vertices: 3,
        ..DomainOptions::default()
    };
    let error = Domain::new(&shape(&SQUARE), &options).expect_err("four vertices");
    assert_eq!(
        error,
        FieldError::TooManyVertices {
            needed: 5,
            allowed: 3
        }
    );
}

#[test]
fn options_out_of_range() {
    type Set = fn(&mut DomainOptions, f64);
    let sets: [(&str, Set, &[f64]); 3] = [
        (
            "edge_length",
            |o, v| o.edge_length = v,
            &[-1.0, f64::NAN, f64::INFINITY],
        ),
        (
            "min_angle_deg",
            |o, v| o.min_angle_deg = v,
            &[-1.0, 40.0, f64::NAN],
        ),
        (
            "corner_deg",
            |o, v| o.corner_deg = v,
            &[0.0, 180.0, f64::NAN],
        ),
    ];
    for (name, set, values) in sets {
        for &value in values {
            let mut options = DomainOptions::default();
            set(&mut options, value);
            let error = Domain::new(&shape(&SQUARE), &options).expect_err("out of range");
            assert!(matches!(error, FieldError::BadOption { option, .. } if option == name));
        }
    }
}

#[test]
fn a_triangle_has_no_harmonic_field_and_says_what_to_use() {
    let domain = shapes::domain(&shape(&[(0., 0.), (9., 1.), (3., 7.)]), 1.0);
    let error = HarmonicField::default().design(&domain).expect_err("none");
    assert_eq!(error, FieldError::NoHarmonicField { pieces: 3 });
    assert!(error.to_string().contains("use a distance field"));
}

#[test]
fn options_of_harmonic_fields_out_of_range_are_refused() {
    type Set = fn(&mut HarmonicField, f64);
    let sets: [(&str, Set, &[f64]); 8] = [
        ("starts", |h, v| h.starts = v as usize, &[0.0, 1e9]),
        ("entries", |h, v| h.entries = v as usize, &[0.0]),
        ("entry", |h, v| h.entry = v as usize, &[1.0, 8.0]),
        ("diversity", |h, v| h.diversity = v, &[-0.1, 1.1, f64::NAN]),
        (
            "max_turn_deg",
            |h, v| h.max_turn_deg = v,
            &[0.0, 91.0, f64::NAN],
        ),
        ("max_pieces", |h, v| h.max_pieces = v as usize, &[0.0, 3.0]),
        (
            "disc_radius",
            |h, v| h.disc_radius = v,
            &[-1.0, f64::INFINITY],
        ),
        ("alignment", |h, v| h.alignment = v, &[-1.0, f64::NAN]),
    ];
    let domain = shapes::domain(&shape(&SQUARE), 1.0);
    for (name, set, values) in sets {
        for &value in values {
            let mut design = HarmonicField::default();
            set(&mut design, value);
            let error = design.design(&domain).expect_err("out of range");
            assert!(
                matches!(error, FieldError::BadOption { option, .. } if option == name),
                "{name} {value}: {error}"
            );
        }
    }
    let basis = HarmonicField::default().basis(&domain).expect("a square");
    assert!(basis.field(&[1.0; 3]).is_err());
    assert!(basis.field(&[1.0, f64::NAN, 0.0, 0.0]).is_err());
    let elsewhere = shapes::domain(&shape(&SQUARE), 2.0);
    let field = HarmonicField::default()
        .design(&elsewhere)
        .expect("a square");
    assert!(basis.energy(&field).is_err() && basis.alignment(&field).is_err());
}

/// Not bad at all, though it looks so.
#[test]
fn odd_but_valid_polygons_are_taken() {
    let odd = [
        // Duplicates, collinear vertices, an explicitly closed ring.
        shape(&[
            (0., 0.),
            (0., 0.),
            (5., 0.),
            (10., 0.),
            (10., 10.),
            (10., 10.),
            (0., 10.),
            (0., 0.),
        ]),
        // A hole that touches the exterior at a vertex, one at an edge, and
        // two holes that touch each other.
        Polygon::new(ring(&SQUARE), vec![ring(&[(0., 0.), (4., 1.), (1., 4.)])]),
        Polygon::new(ring(&SQUARE), vec![ring(&[(0., 5.), (4., 4.), (4., 6.)])]),
        Polygon::new(
            ring(&SQUARE),
            vec![
                ring(&[(2., 2.), (5., 5.), (2., 5.)]),
                ring(&[(5., 5.), (8., 5.), (8., 8.)]),
            ],
        ),
        // Tiny and huge.
        shape(&[(0., 0.), (1e-9, 0.), (0., 1e-9)]),
        shape(&[(0., 0.), (1e90, 0.), (0., 1e90)]),
        // A tiny hole in a large square, and a needle.
        Polygon::new(
            ring(&[(0., 0.), (1e4, 0.), (1e4, 1e4), (0., 1e4)]),
            vec![ring(&[(5e3, 5e3), (5e3 + 1e-3, 5e3), (5e3, 5e3 + 1e-3)])],
        ),
        shape(&[(0., 0.), (1e3, 0.), (1e3, 1e-3)]),
    ];
    for (k, polygon) in odd.iter().enumerate() {
        let domain = Domain::new(polygon, &DomainOptions::default());
        let domain = domain.unwrap_or_else(|error| panic!("{k}: {error}"));
        for design in [
            &crossfield::DistanceField::default() as &dyn FieldDesign,
            &crossfield::BoundaryField::default(),
        ] {
            let field = design
                .design(&domain)
                .unwrap_or_else(|error| panic!("{k}: {error}"));
            assert!(field.index_check().winding_law(), "{k}");
        }
    }
}

/// 100 000 vertices on a wobbly circle.
#[test]
fn a_long_ring_is_no_problem() {
    let count = 100_000;
    let points: Vec<(f64, f64)> = (0..count)
        .map(|k| {
            let angle = std::f64::consts::TAU * k as f64 / count as f64;
            let radius = 1000.0 + 3.0 * (angle * 900.0).sin();
            (radius * angle.cos(), radius * angle.sin())
        })
        .collect();
    let domain = Domain::new(&shape(&points), &DomainOptions::default()).expect("valid");
    assert!(domain.vertex_count() >= count);
}
