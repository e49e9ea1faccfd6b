//! Laws of boundary fields and of the variants to compare with: random
//! starts, alignment, globally optimal fields, convergence.

mod shapes;

use std::f64::consts::TAU;

use crossfield::geo_types::{coord, Coord, LineString, Polygon};
use crossfield::{
    BoundaryField, ConstrainedField, Corner, Cross, Cursor, Field, FieldDesign, FieldError,
    Laplacian, OptimalField, PointDirection, PrescribedField, Singularity, Start, Stroke, Symmetry,
    Terrain,
};
use proptest::prelude::*;
use shapes::{annulus, config, domain, polygon, rectilinear, regular, shape, turned};

fn cross(field: &Field, v: usize) -> Option<Cross> {
    Cross::from_representative(field.representative(v))
}

/// Shapes on which published boundary-aligned fields put singularities, and
/// where a planar one has none.
fn letters() -> Vec<(&'static str, Polygon<f64>)> {
    let square = [(0., 0.), (60., 0.), (60., 60.), (0., 60.)];
    let l = [
        (0., 0.),
        (60., 0.),
        (60., 20.),
        (25., 20.),
        (25., 60.),
        (0., 60.),
    ];
    let t = [
        (20., 0.),
        (40., 0.),
        (40., 40.),
        (60., 40.),
        (60., 60.),
        (0., 60.),
        (0., 40.),
        (20., 40.),
    ];
    let plus = [
        (20., 0.),
        (40., 0.),
        (40., 20.),
        (60., 20.),
        (60., 40.),
        (40., 40.),
        (40., 60.),
        (20., 60.),
        (20., 40.),
        (0., 40.),
        (0., 20.),
        (20., 20.),
    ];
    let h = [
        (0., 0.),
        (20., 0.),
        (20., 22.),
        (40., 22.),
        (40., 0.),
        (60., 0.),
        (60., 60.),
        (40., 60.),
        (40., 38.),
        (20., 38.),
        (20., 60.),
        (0., 60.),
    ];
    vec![
        ("square", shape(&square)),
        ("L", shape(&l)),
        ("T", shape(&t)),
        ("plus", shape(&plus)),
        ("H", shape(&h)),
    ]
}

/// None in any of them, however they lie, however weak the pull, whatever the
/// weights, the mesh, the start: nor in the globally optimal field.
#[test]
fn square_l_t_plus_and_h_have_no_singularity() {
    for (name, upright) in letters() {
        for angle in [0.0, 0.4] {
            let polygon = turned(&upright, angle, (4e5, 5e6));
            for edge_length in [1.5, 6.0] {
                let domain = domain(&polygon, edge_length);
                let wanted = Cross::from_angle(angle);
                let mut designs: Vec<Box<dyn FieldDesign>> = vec![
                    Box::new(OptimalField::default()),
                    Box::new(OptimalField {
                        lambda: None,
                        ..OptimalField::default()
                    }),
                ];
                for laplacian in [Laplacian::Cotangent, Laplacian::Uniform] {
                    for omega in [0.1, 0.9, 100.0] {
                        designs.push(Box::new(BoundaryField {
                            laplacian,
                            omega,
                            ..BoundaryField::default()
                        }));
                    }
                }
                for design in designs {
                    let field = design.design(&domain).expect("a field");
                    assert!(field.singularities().is_empty(), "{name}");
                    for v in 0..domain.vertex_count() {
                        let cross = cross(&field, v).expect("regular");
                        assert!(cross.deviation(&wanted) < 1e-7, "{name}");
                    }
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(config(12))]

    /// Law 7 (iii): where D points with the boundary all along, indices and
    /// corners balance, however soft the pull; and where the check says the
    /// field is not aligned, nothing is claimed.
    #[test]
    fn soft_fields_balance_where_they_are_aligned(
        shape in polygon(), omega in prop_oneof![Just(0.1), Just(1.0), Just(10.0), Just(100.0)],
    ) {
        let domain = domain(&shape, 10.0);
        let field = BoundaryField { omega, ..BoundaryField::default() }.design(&domain)?;
        let check = field.index_check();
        prop_assert!(check.winding_law());
        prop_assert!(!check.aligned || check.boundary_law(), "{:?}", check);
    }

    /// One seed is one field, and another seed another one.
    #[test]
    fn random_starts_are_reproducible(shape in polygon(), seed in 0..u64::MAX) {
        let domain = domain(&shape, 25.0);
        let design = |unit_rounds, start| BoundaryField { unit_rounds, start, ..BoundaryField::default() };
        let random = Start::Random { seed };
        let (a, b) = (design(5, random).design(&domain)?, design(5, random).design(&domain)?);
        for v in 0..domain.vertex_count() {
            prop_assert_eq!(a.representative(v), b.representative(v));
        }
        let other = design(5, Start::Random { seed: seed ^ 1 }).design(&domain)?;
        prop_assert!((0..domain.vertex_count()).any(|v| a.representative(v) != other.representative(v)));
        prop_assert!(a.index_check().winding_law());
        let none = design(0, random).design(&domain);
        prop_assert!(matches!(none, Err(FieldError::BadOption { option: "unit_rounds", .. })), "{:?}", none.is_ok());
    }

    #[test]
    fn optimal_fields_turn_with_the_mesh(
        shape in polygon(), angle in -4.0..4.0_f64, lambda in prop_oneof![Just(None), Just(Some(-1.0)), Just(Some(-300.0))],
    ) {
        let here = domain(&shape, 25.0);
        let there = here.moved(angle, coord! {x: 5e5, y: -3e6});
        let design = OptimalField { lambda, ..OptimalField::default() };
        let (a, b) = (design.design(&here)?, design.design(&there)?);
        for v in 0..here.vertex_count() {
            let (Some(a), Some(b)) = (cross(&a, v), cross(&b, v)) else { continue };
            prop_assert!(a.turned(angle).deviation(&b) < 1e-5);
        }
        prop_assert!(a.index_check().winding_law());
        if lambda.is_none() {
            // The smallest eigenvector is constant.
            prop_assert!(a.energy() < 1e-9, "{}", a.energy());
        }
    }

    /// The optimal field of a rectilinear shape is its grid.
    #[test]
    fn optimal_fields_of_rectilinear_shapes_are_constant(upright in rectilinear(), angle in -4.0..4.0_f64) {
        let domain = domain(&turned(&upright, angle, (0.0, 0.0)), 0.0);
        for lambda in [None, Some(-10.0), Some(-1000.0)] {
            let field = OptimalField { lambda, ..OptimalField::default() }.design(&domain)?;
            prop_assert!(field.singularities().is_empty());
            for v in 0..domain.vertex_count() {
                let cross = cross(&field, v).expect("regular");
                prop_assert!(cross.deviation(&Cross::from_angle(angle)) < 1e-7);
            }
        }
    }
}

/// Sizes far from any map's, and needles: every design works, or says why.
#[test]
fn extreme_sizes_are_no_problem() {
    for size in [1e-9, 1e-3, 1e90] {
        let scaled = |points: &[(f64, f64)]| -> Polygon<f64> {
            shape(
                &points
                    .iter()
                    .map(|(x, y)| (size * x, size * y))
                    .collect::<Vec<_>>(),
            )
        };
        let place = |x: f64, y: f64| coord! {x: size * x, y: size * y};
        let site = scaled(&[(0., 0.), (12., 0.), (12., 8.), (0., 8.)]);
        let domain = domain(&site, 0.0);
        let stroke = Stroke::new(LineString(vec![place(3., 3.), place(9., 5.)]), 100.0);
        let point = PointDirection {
            at: place(2., 6.),
            direction: place(1., 1.),
            radius: size,
            weight: 10.0,
        };
        let wanted = [(4., 4., 1), (8., 4., -1)].map(|(x, y, quarter_index)| Singularity {
            at: place(x, y),
            quarter_index,
        });
        let hill = |x: f64, y: f64| 0.2 * x + 0.1 * y;
        let designs: [Box<dyn FieldDesign>; 4] = [
            Box::new(OptimalField::default()),
            Box::new(OptimalField {
                lambda: None,
                ..OptimalField::default()
            }),
            Box::new(PrescribedField::new(wanted.to_vec())),
            Box::new(
                ConstrainedField::new(BoundaryField::default())
                    .with(&stroke)
                    .with(point)
                    .with(Terrain::new(hill, 1.0)),
            ),
        ];
        let counts = designs.iter().map(|design| {
            let field = design
                .design(&domain)
                .unwrap_or_else(|error| panic!("{size}: {error}"));
            assert!(field.index_check().winding_law());
            field.singularities().len()
        });
        assert_eq!(counts.collect::<Vec<_>>()[..3], [0, 0, 2], "{size}");
        let field = BoundaryField::default().design(&domain).expect("a field");
        let edited = field
            .edited(std::slice::from_ref(&stroke), 2.0 * size)
            .expect("possible");
        let at = edited
            .cross(place(6., 4.), &mut Cursor::default())
            .expect("regular");
        assert!(at.deviation(&Cross::from_direction(place(3., 1.)).expect("a direction")) < 0.1);
        let all = scaled(&[(-1., -1.), (20., -1.), (20., 20.), (-1., 20.)]);
        let smooth = edited.smoothed_inside(&all).expect("possible");
        assert!(smooth.energy() < 1e-9);
    }
}

#[test]
fn a_useless_lambda_is_refused() {
    let (_, square) = letters().swap_remove(0);
    let domain = domain(&square, 10.0);
    for lambda in [0.0, 1.0, f64::NAN, f64::NEG_INFINITY] {
        let design = OptimalField {
            lambda: Some(lambda),
            ..OptimalField::default()
        };
        let error = design.design(&domain).expect_err("must be refused");
        assert!(
            matches!(
                error,
                FieldError::BadOption {
                    option: "lambda",
                    ..
                }
            ),
            "{error}"
        );
    }
}

/// The weaker the shift, the less a disc's optimal field follows its boundary
/// in length, yet by symmetry it has the disc's four quarters.
#[test]
fn optimal_fields_of_a_disc_have_its_index() {
    let disc = domain(&Polygon::new(regular(120, 100.0, (0.0, 0.0)), vec![]), 5.0);
    for symmetry in Symmetry::ALL {
        for lambda in [-1.0, -10.0, -1000.0] {
            let field = OptimalField {
                lambda: Some(lambda),
                symmetry,
            }
            .design(&disc)
            .expect("a field");
            let check = field.index_check();
            assert_eq!(
                check.interior,
                symmetry.folds() as i32,
                "{symmetry:?} {lambda}"
            );
            assert!(
                check.aligned && check.boundary_law(),
                "{symmetry:?} {lambda}"
            );
        }
    }
}

/// Largest error against a closed form at the vertices for which it is known.
fn error(field: &Field, exact: impl Fn(Coord<f64>) -> Option<Cross>) -> f64 {
    (0..field.domain().vertex_count())
        .filter_map(|v| Some(cross(field, v)?.deviation(&exact(field.domain().vertex(v))?)))
        .fold(0.0, f64::max)
}

/// A sector of an annulus, of 60 degrees, its arcs of `count` edges.
fn sector(count: usize) -> Polygon<f64> {
    let arc = |radius: f64, k: usize| {
        let (y, x) = (TAU / 6.0 * k as f64 / count as f64).sin_cos();
        (radius * x, radius * y)
    };
    let outer = (0..=count).map(|k| arc(100.0, k));
    let ring: Vec<(f64, f64)> = outer
        .chain((0..=count).rev().map(|k| arc(50.0, k)))
        .collect();
    shape(&ring)
}

/// Orders of convergence, the edge length halved four times, against radial
/// crosses: on an annulus; on a disc, where D = r^4 (cos 4t, sin 4t), but for
/// its middle; and on a sector of an annulus but for its corners (where the
/// first edge of an arc is not its tangent), where only the field of smallest
/// phase is radial, not that of smallest D. Each circle
/// has edges as long as those of the mesh.
///
/// Of second order where linear elements are, and where the polygon inside
/// the circle is: its edges leave it by h^2 / 8r, and the corners between
/// them align with the mean of both, which is the tangent. Where refinement
/// splits an edge of the boundary its new vertices align with the edge, and
/// the error there is of first order: few, but a maximum sees them.
#[test]
fn convergence_against_closed_forms() {
    let radial = |p: Coord<f64>| {
        (p.x.hypot(p.y) > 30.0)
            .then(|| Cross::from_direction(p))
            .flatten()
    };
    println!("| edges of a circle | annulus | disc | optimal, disc | phase, sector |");
    println!("|---|---|---|---|---|");
    let mut rows: Vec<[f64; 4]> = Vec::new();
    for count in [48, 96, 192, 384, 768_usize] {
        let step = TAU * 100.0 / count as f64;
        let ring = domain(&annulus(count, 100.0, 50.0), step);
        let disc = domain(
            &Polygon::new(regular(count, 100.0, (0.0, 0.0)), vec![]),
            step,
        );
        let sector = domain(&sector(count / 6), step);
        let b = BoundaryField::default();
        let corners = sector.corners();
        let off_corners = |p: Coord<f64>| {
            let far = |c: &Corner| (c.at.x - p.x).hypot(c.at.y - p.y) > 10.0;
            if corners.iter().all(far) {
                radial(p)
            } else {
                None
            }
        };
        // The field turns across the straight sides: a soft pull would yield.
        let hard = PrescribedField {
            omega: 1e6,
            ..PrescribedField::new(vec![])
        };
        let row = [
            error(&b.design(&ring).expect("a field"), radial),
            error(&b.design(&disc).expect("a field"), radial),
            error(
                &OptimalField::default().design(&disc).expect("a field"),
                radial,
            ),
            error(&hard.design(&sector).expect("a field"), off_corners),
        ];
        let [a, b, c, d] = row;
        println!("| {count} | {a:.1e} | {b:.1e} | {c:.1e} | {d:.1e} |");
        rows.push(row);
    }
    for (k, name) in ["annulus", "disc", "optimal, disc", "phase, sector"]
        .into_iter()
        .enumerate()
    {
        let order = (rows[0][k] / rows[4][k]).log2() / 4.0;
        println!("{name}: order {order:.2}");
        assert!(order > 1.5, "{name} {order}");
    }
}
