//! Laws of fields with any number of arms.

mod shapes;

use std::f64::consts::TAU;

use crossfield::geo_types::{coord, Polygon};
use crossfield::{BoundaryField, Cursor, Field, FieldDesign, Rosy, Symmetry};
use proptest::prelude::*;
use shapes::{annulus, config, domain, polygon, regular};

fn symmetry() -> impl Strategy<Value = Symmetry> {
    proptest::sample::select(&Symmetry::ALL[..])
}

fn design(symmetry: Symmetry) -> BoundaryField {
    BoundaryField {
        symmetry,
        ..BoundaryField::default()
    }
}

proptest! {
    #![proptest_config(config(12))]

    #[test]
    fn turning_the_mesh_turns_every_arm(
        shape in polygon(), symmetry in symmetry(), angle in -4.0..4.0_f64,
    ) {
        let here = domain(&shape, 25.0);
        let there = here.moved(angle, coord! {x: 5e5, y: -3e6});
        let (a, b) = (design(symmetry).design(&here)?, design(symmetry).design(&there)?);
        prop_assert_eq!(a.symmetry(), symmetry);
        for v in 0..here.vertex_count() {
            let at = |f: &Field| Rosy::from_representative(symmetry, f.representative(v));
            if let (Some(a), Some(b)) = (at(&a), at(&b)) {
                prop_assert!(a.turned(angle).deviation(&b) < 1e-6);
            }
        }
    }

    /// Law 7 (i) for any vectors, (ii) for aligned fields, with N in the
    /// place of 4.
    #[test]
    fn indices_add_up(shape in polygon(), symmetry in symmetry()) {
        let field = design(symmetry).design(&domain(&shape, 12.0))?;
        let check = field.index_check();
        prop_assert_eq!(check.folds, symmetry.folds() as i32);
        prop_assert!(check.winding_law());
        prop_assert!(!check.aligned || check.boundary_law(), "{:?} {:?}", symmetry, check);
    }

    /// The arm chosen has the least turn, and divergence changes its sign
    /// with the heading where the opposite arm exists.
    #[test]
    fn arms_follow_the_heading(
        shape in polygon(), symmetry in symmetry(), x in -150.0..150.0_f64, y in -150.0..150.0_f64,
        angle in -4.0..4.0_f64,
    ) {
        let field = design(symmetry).design(&domain(&shape, 25.0))?;
        let at = coord! {x: x, y: y};
        let heading = coord! {x: angle.cos(), y: angle.sin()};
        let mut cursor = Cursor::default();
        if let Some(arm) = field.direction(at, heading, &mut cursor) {
            prop_assert!((arm.x.hypot(arm.y) - 1.0).abs() < 1e-12);
            let turn = (arm.x * heading.x + arm.y * heading.y).clamp(-1.0, 1.0).acos();
            prop_assert!(turn < symmetry.period() / 2.0 + 1e-6);
            let crosses = field.cross(at, &mut cursor).is_some();
            prop_assert_eq!(crosses, symmetry == Symmetry::Cross);
            if symmetry != Symmetry::Vector {
                let back = coord! {x: -heading.x, y: -heading.y};
                let there = field.divergence(at, heading, &mut cursor);
                let here = field.divergence(at, back, &mut cursor);
                let sum = there.zip(here).map_or(0.0, |(a, b)| (a + b).abs());
                // Both arms are computed by sine and cosine: off by 1e-15.
                prop_assert!(sum < 1e-9);
            }
        }
    }
}

/// A disc has N singularities of index 1 / N, an annulus none, and a regular
/// polygon of N sides a constant field.
#[test]
fn discs_annuli_and_regular_polygons() {
    for symmetry in Symmetry::ALL {
        let folds = symmetry.folds() as i32;
        let disc = domain(&Polygon::new(regular(120, 100.0, (0.0, 0.0)), vec![]), 5.0);
        let field = design(symmetry).design(&disc).expect("a field");
        assert_eq!(field.index_sum(), folds, "{symmetry:?}");
        assert!(field.index_check().boundary_law());
        // The domain on the left of the inner circle means clockwise there: a
        // vector field vanishes on a whole circle in between.
        if symmetry == Symmetry::Vector {
            continue;
        }
        let ring = domain(&annulus(96, 100.0, 50.0), 6.0);
        let field = design(symmetry).design(&ring).expect("a field");
        assert!(field.singularities().is_empty(), "{symmetry:?}");
        for v in 0..ring.vertex_count() {
            let at = ring.vertex(v);
            let around = coord! {x: -at.y, y: at.x};
            let wanted = Rosy::from_direction(symmetry, around).expect("off the centre");
            let found = Rosy::from_representative(symmetry, field.representative(v));
            // Half the angle that a boundary edge spans.
            let off = wanted.deviation(&found.expect("no singularity"));
            assert!(off < 0.55 * TAU / 96.0, "{symmetry:?} {off}");
        }
    }
    // With an even number of sides, opposite sides are parallel.
    for (symmetry, sides) in [(Symmetry::Cross, 4), (Symmetry::Hexagon, 6)] {
        let shape = Polygon::new(regular(sides, 100.0, (0.0, 0.0)), vec![]);
        let field = design(symmetry)
            .design(&domain(&shape, 5.0))
            .expect("a field");
        assert!(field.energy() < 1e-9);
        assert!(field.mean_abs_divergence() < 1e-9);
        assert!(field.index_check().aligned);
    }
}
