//! Laws of the fields (design notes: rotation, rectangles, annuli, index
//! sums, convergence).

mod shapes;

use std::f64::consts::{FRAC_PI_4, TAU};

use crossfield::geo_types::{coord, Coord, Polygon};
use crossfield::{
    BoundaryField, CornerRule, Cross, Cursor, DistanceField, Domain, Field, FieldDesign, Laplacian,
};
use proptest::prelude::*;
use shapes::{annulus, config, domain, map, polygon, rectilinear, regular, shape, turned};

/// Every design of the crate, with its options varied.
fn designs() -> Vec<(&'static str, Box<dyn FieldDesign>)> {
    let boundary = BoundaryField::default();
    vec![
        ("distance", Box::new(DistanceField::default())),
        (
            "rounded corners",
            Box::new(DistanceField {
                concave_tangents: false,
                smoothing_rounds: 3,
                ..DistanceField::default()
            }),
        ),
        ("boundary", Box::new(boundary.clone())),
        (
            "uniform",
            Box::new(BoundaryField {
                laplacian: Laplacian::Uniform,
                omega: 0.9,
                unit_rounds: 5,
                ..boundary.clone()
            }),
        ),
        (
            "edge vectors",
            Box::new(BoundaryField {
                corner_rule: CornerRule::EdgeVectors,
                ..boundary
            }),
        ),
    ]
}

fn at_vertex(field: &Field, v: usize) -> Option<Cross> {
    Cross::from_representative(field.representative(v))
}

/// Vertices whose cross in `turned` is not that of `field` turned.
fn off(field: &Field, turned: &Field, angle: f64, tolerance: f64) -> usize {
    (0..field.domain().vertex_count())
        .filter(|&v| match (at_vertex(field, v), at_vertex(turned, v)) {
            (Some(a), Some(b)) => a.turned(angle).deviation(&b) > tolerance,
            (a, b) => a != b,
        })
        .count()
}

proptest! {
    #![proptest_config(config(16))]

    #[test]
    fn turning_the_mesh_turns_every_cross(
        shape in polygon(), angle in -4.0..4.0_f64, x in -1e6..1e6_f64, y in -1e6..1e6_f64,
    ) {
        let here = domain(&shape, 25.0);
        let there = here.moved(angle, coord! {x: x, y: y});
        for (name, design) in designs() {
            let (a, b) = (design.design(&here)?, design.design(&there)?);
            prop_assert_eq!(off(&a, &b, angle, 1e-6), 0, "{}", name);
        }
    }

    #[test]
    fn a_mirror_image_has_the_mirrored_boundary_crosses(shape in polygon()) {
        let mirrored = map(&shape, |p| coord! {x: -p.x, y: p.y});
        let design = DistanceField::default();
        let here = design.design(&domain(&shape, 30.0))?;
        let there = design.design(&domain(&mirrored, 30.0))?;
        for v in (0..here.domain().vertex_count()).filter(|&v| here.domain().is_boundary(v)) {
            let at = here.domain().vertex(v);
            let image = coord! {x: -at.x, y: at.y};
            let found = there.cross(image, &mut Cursor::default());
            // Only given vertices are sure to be vertices of both meshes.
            let corner = here.domain().corners().iter().any(|c| c.at == at);
            if let (true, Some(a), Some(b)) = (corner, at_vertex(&here, v), found) {
                let wanted = Cross::from_angle(-a.angle());
                // At a turn of 45 degrees the average is open.
                let turn = here.domain().corners().iter().find(|c| c.at == at).map_or(0.0, |c| c.turn);
                let odd = ((turn / FRAC_PI_4).rem_euclid(2.0) - 1.0).abs();
                prop_assert!(odd < 0.01 || wanted.deviation(&b) < 1e-6);
            }
        }
    }

    #[test]
    fn rectangles_have_constant_fields(
        width in 20.0..400.0_f64, height in 20.0..400.0_f64, angle in -4.0..4.0_f64,
        x in -1e6..1e6_f64, y in -1e7..1e7_f64,
    ) {
        let upright = shape(&[(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]);
        let domain = domain(&turned(&upright, angle, (x, y)), 0.0);
        let wanted = Cross::from_angle(angle);
        for (name, design) in designs() {
            if name == "edge vectors" {
                continue;
            }
            let field = design.design(&domain)?;
            for v in 0..domain.vertex_count() {
                let cross = at_vertex(&field, v).expect("no singularity");
                // Input coordinates are rounded to 1e-9 m at this distance.
                prop_assert!(cross.deviation(&wanted) < 1e-8, "{}", name);
            }
            prop_assert!(field.energy() < 1e-9);
            prop_assert!(field.mean_abs_divergence() < 1e-9);
        }
    }

    #[test]
    fn rectilinear_shapes_have_constant_boundary_fields(
        upright in rectilinear(), angle in -4.0..4.0_f64,
    ) {
        let domain = domain(&turned(&upright, angle, (0.0, 0.0)), 0.0);
        let field = BoundaryField::default().design(&domain)?;
        prop_assert!(field.singularities().is_empty());
        let wanted = Cross::from_angle(angle);
        for v in 0..domain.vertex_count() {
            let cross = at_vertex(&field, v).expect("no singularity");
            prop_assert!(cross.deviation(&wanted) < 1e-8);
        }
    }

    #[test]
    fn annuli_have_radial_crosses_and_no_singularity(
        count in 48..120_usize, ratio in 0.2..0.8_f64,
    ) {
        let step = 100.0 * (1.0 - ratio) / 8.0;
        let domain = domain(&annulus(count, 100.0, 100.0 * ratio), step);
        for (name, design) in designs() {
            let field = design.design(&domain)?;
            // Uniform weights depend on the mesh, without a bound: around a
            // small hole they once made pairs of singularities.
            if name == "uniform" {
                let check = field.index_check();
                prop_assert!(!check.aligned || check.interior == 0);
                continue;
            }
            prop_assert!(field.singularities().is_empty(), "{}", name);
            prop_assert_eq!(field.index_sum(), 0);
            for v in 0..domain.vertex_count() {
                let radial = Cross::from_direction(domain.vertex(v)).expect("off the centre");
                let cross = at_vertex(&field, v).expect("no singularity");
                // An edge's cross is off by half the angle it spans, and the
                // smoothing of a D-field by a part of the angle that its
                // neighbours span, which lie unevenly.
                let at = domain.vertex(v);
                let blur = if name.starts_with("bo") { 0.0 } else { 0.3 * step / at.x.hypot(at.y) };
                let off = cross.deviation(&radial);
                prop_assert!(off < 0.55 * TAU / count as f64 + blur, "{} {}", name, off);
            }
        }
    }

    /// Law 7 (i), for any vectors at the vertices, zero ones and exact ties
    /// among them.
    #[test]
    fn indices_add_up_to_the_boundary_winding(
        shape in polygon(),
        choices in proptest::collection::vec(0..12_usize, 64),
        angles in proptest::collection::vec(-10.0..10.0_f64, 64),
    ) {
        let domain = domain(&shape, 30.0);
        let vectors = (0..domain.vertex_count())
            .map(|v| {
                let k = v * 7 % 64;
                match choices[(k + v / 64) % 64] {
                    0 => coord! {x: 0.0, y: 0.0},
                    1..=4 => coord! {x: if k % 2 == 0 { 1.0 } else { -1.0 }, y: 0.0},
                    _ => coord! {x: angles[k].cos(), y: angles[k].sin()},
                }
            })
            .collect();
        let field = Field::from_representatives(&domain, vectors)?;
        prop_assert!(field.index_check().winding_law());
        let listed: i32 = field.singularities().iter().map(|s| s.quarter_index).sum();
        prop_assert_eq!(listed, field.index_sum());
    }

    /// Law 7 (ii), wherever the field follows the boundary.
    #[test]
    fn indices_and_corners_add_up_to_the_euler_characteristic(shape in polygon()) {
        let domain = domain(&shape, 12.0);
        for (name, design) in designs() {
            let check = design.design(&domain)?.index_check();
            prop_assert!(check.winding_law(), "{}", name);
            prop_assert!(!check.aligned || check.boundary_law(), "{} {:?}", name, check);
            // D-fields are aligned by construction, except for ties at turns
            // of 45 degrees.
            if name == "distance" && !check.aligned {
                let tie = |turn: f64| ((turn / FRAC_PI_4).rem_euclid(2.0) - 1.0).abs() < 1e-6;
                prop_assert!(domain.corners().iter().any(|c| tie(c.turn)));
            }
        }
    }

    #[test]
    fn weights_count_by_their_ratios(shape in polygon(), factor in 0.01..100.0_f64, odd in 0.2..5.0_f64) {
        let domain = domain(&shape, 25.0);
        let rings = std::iter::once(shape.exterior()).chain(shape.interiors());
        let weights: Vec<Vec<f64>> = rings
            .map(|r| (0..r.0.len() - 1).map(|k| if k % 3 == 0 { odd } else { 1.0 }).collect())
            .collect();
        let scaled = weights.iter().map(|r| r.iter().map(|w| w * factor).collect()).collect();
        let design = |weights| DistanceField { weights, ..DistanceField::default() };
        let (a, b) = (design(weights).design(&domain)?, design(scaled).design(&domain)?);
        prop_assert_eq!(off(&a, &b, 0.0, 1e-9), 0);
        // All alike is the default, to the bit.
        let ones = std::iter::once(shape.exterior()).chain(shape.interiors())
            .map(|r| vec![1.0; r.0.len() - 1]).collect();
        let (a, b) = (design(ones).design(&domain)?, design(vec![]).design(&domain)?);
        for v in 0..domain.vertex_count() {
            prop_assert_eq!(a.representative(v), b.representative(v));
        }
    }

    /// Reversing the heading reverses the arm; divergence changes its sign
    /// with it.
    #[test]
    fn the_opposite_heading_gives_the_opposite_arm(
        shape in polygon(), x in -150.0..150.0_f64, y in -150.0..150.0_f64, angle in -4.0..4.0_f64,
    ) {
        let field = BoundaryField::default().design(&domain(&shape, 25.0))?;
        let at = coord! {x: x, y: y};
        let heading = coord! {x: angle.cos(), y: angle.sin()};
        let back = coord! {x: -heading.x, y: -heading.y};
        let mut cursor = Cursor::default();
        let arm = field.direction(at, heading, &mut cursor);
        let reverse = field.direction(at, back, &mut cursor);
        prop_assert_eq!(arm.map(|a| coord! {x: -a.x, y: -a.y}), reverse);
        prop_assert_eq!(arm.is_some(), field.domain().locate(at, &mut cursor).is_some());
        if let Some(arm) = arm {
            prop_assert!((arm.x.hypot(arm.y) - 1.0).abs() < 1e-12);
            prop_assert!(arm.x * heading.x + arm.y * heading.y > FRAC_PI_4.cos() - 1e-9);
        }
        let there = field.divergence(at, heading, &mut cursor);
        let here = field.divergence(at, back, &mut cursor);
        prop_assert_eq!(there.map(|d| -d), here);
    }
}

/// The sums of the design notes: disc 4, rectangle 0, pentagon -1, L 0, disc
/// with a square hole 4.
#[test]
fn known_index_sums() {
    let disc = Polygon::new(regular(90, 100.0, (3.0, 4.0)), vec![]);
    let holed = Polygon::new(
        regular(90, 100.0, (0.0, 0.0)),
        vec![regular(4, 30.0, (10.0, 5.0))],
    );
    let cases = [
        ("disc", disc, 4),
        (
            "rectangle",
            shape(&[(0., 0.), (90., 0.), (90., 50.), (0., 50.)]),
            0,
        ),
        (
            "pentagon",
            Polygon::new(regular(5, 100.0, (0.0, 0.0)), vec![]),
            -1,
        ),
        (
            "L",
            shape(&[
                (0., 0.),
                (90., 0.),
                (90., 40.),
                (35., 40.),
                (35., 80.),
                (0., 80.),
            ]),
            0,
        ),
        ("disc with a square hole", holed, 4),
    ];
    for (name, polygon, sum) in cases {
        let domain = domain(&polygon, 0.0);
        for (design, field) in [
            ("D", DistanceField::default().design(&domain)),
            ("B", BoundaryField::default().design(&domain)),
        ] {
            let field = field.expect("a field");
            let check = field.index_check();
            assert!(check.aligned, "{design} {name}");
            assert!(
                check.winding_law() && check.boundary_law(),
                "{design} {name} {check:?}"
            );
            assert_eq!(check.interior, sum, "{design} {name}");
        }
    }
}

/// A weak B-field leaves the boundary, and the check notices.
#[test]
fn a_weak_boundary_field_is_not_aligned() {
    let disc = Polygon::new(
        regular(90, 100.0, (0.0, 0.0)),
        vec![regular(90, 60.0, (0.0, 0.0))],
    );
    let pulled = map(&disc, |p| coord! {x: 1.6 * p.x + 0.4 * p.y, y: p.y});
    let weak = BoundaryField {
        omega: 0.1,
        ..BoundaryField::default()
    };
    let check = weak
        .design(&domain(&pulled, 5.0))
        .expect("a field")
        .index_check();
    assert!(check.winding_law());
    assert!(!check.aligned);
}

/// Largest deviation from the radial cross on an annulus whose circles have
/// edges of the mesh's own length.
fn annulus_error(design: &dyn FieldDesign, count: usize) -> f64 {
    let step = TAU * 100.0 / count as f64;
    let domain: Domain = domain(&annulus(count, 100.0, 50.0), step);
    let field = design.design(&domain).expect("a field");
    (0..domain.vertex_count())
        .filter_map(|v| {
            let at: Coord<f64> = domain.vertex(v);
            Some(at_vertex(&field, v)?.deviation(&Cross::from_direction(at)?))
        })
        .fold(0.0, f64::max)
}

/// A D-field's crosses are constant along the strip of each edge, so that its
/// error on a circle is at most half the angle that an edge spans: of first
/// order in the edge length. A B-field's is nearly of second order.
#[test]
fn refinement_converges() {
    let unsmoothed = DistanceField {
        smoothing_rounds: 0,
        ..DistanceField::default()
    };
    for count in [24, 48, 96, 192] {
        let error = annulus_error(&unsmoothed, count);
        assert!(error < 1.001 * TAU / (2 * count) as f64, "{count}: {error}");
    }
    let boundary = BoundaryField::default();
    let (coarse, fine) = (annulus_error(&boundary, 48), annulus_error(&boundary, 192));
    let order = (coarse / fine).log2() / 2.0;
    println!("observed order of a B-field: {order:.2}");
    assert!(order > 1.5, "{coarse} {fine}");
}
