//! Laws of the analysis: singularities where equation 4 of UrbanFab says,
//! integrals along curves, figures that do not depend on place.

mod shapes;

use crossfield::geo_types::{coord, Coord, LineString};
use crossfield::{BoundaryField, Cursor, DistanceField, Field, FieldDesign};
use proptest::prelude::*;
use shapes::{config, domain, polygon};

fn length(line: &LineString<f64>) -> f64 {
    let parts = line.0.windows(2);
    parts
        .map(|w| (w[0].x - w[1].x).hypot(w[0].y - w[1].y))
        .sum()
}

fn curve() -> impl Strategy<Value = LineString<f64>> {
    proptest::collection::vec((-230.0..230.0_f64, -230.0..230.0_f64), 2..8)
        .prop_map(LineString::from)
}

proptest! {
    #![proptest_config(config(24))]

    /// Around a simple zero one triangle is singular, and the interpolated
    /// vector vanishes at the place that is given (equation 4).
    #[test]
    fn a_simple_zero_is_found_where_the_field_vanishes(
        shape in polygon(), x in -60.0..60.0_f64, y in -60.0..60.0_f64, up in any::<bool>(), phase in -4.0..4.0_f64,
    ) {
        let domain = domain(&shape, 20.0);
        let centre = coord! {x: x, y: y};
        prop_assume!(domain.locate(centre, &mut Cursor::default()).is_some());
        let sign = if up { 1.0 } else { -1.0 };
        let vectors = domain.vertices().into_iter().map(|p| {
            let angle = sign * (p.y - y).atan2(p.x - x) + phase;
            coord! {x: angle.cos(), y: angle.sin()}
        }).collect();
        let field = Field::from_representatives(&domain, vectors)?;
        let found = field.singularities();
        prop_assert_eq!(found.len(), 1);
        prop_assert_eq!(found[0].quarter_index, if up { 1 } else { -1 });
        let at = found[0].at;
        prop_assert_eq!(
            domain.locate(at, &mut Cursor::default()).map(|t| domain.triangles()[t]),
            domain.locate(centre, &mut Cursor::default()).map(|t| domain.triangles()[t])
        );
        prop_assert!(field.cross(at, &mut Cursor::default()).is_none());
    }

    /// A curve in two parts has the integrals of both; walked back, what is
    /// signed changes its sign; what is inside and what is not add up.
    #[test]
    fn integrals_along_a_curve_add_up(shape in polygon(), curve in curve(), part in 0.1..0.9_f64) {
        let field = BoundaryField::default().design(&domain(&shape, 25.0))?;
        let whole = field.along(&curve);
        let total = length(&curve);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6 * (1.0 + total);
        prop_assert!(near(whole.length + whole.left_out, total));
        prop_assert!(whole.divergence.abs() <= whole.abs_divergence + 1e-9);
        prop_assert!(whole.curvature.abs() <= whole.abs_curvature + 1e-9);
        prop_assert!((0.0..=std::f64::consts::FRAC_PI_4 + 1e-9).contains(&whole.mean_deviation));
        let back = field.along(&curve.0.iter().rev().copied().collect());
        prop_assert!(near(back.length, whole.length));
        prop_assert!(near(back.divergence, -whole.divergence));
        prop_assert!(near(back.curvature, -whole.curvature));
        prop_assert!(near(back.abs_divergence, whole.abs_divergence));
        // Cut within its first segment. The arm is taken in the middle of each
        // triangle crossed, so integrals agree to the second order of the way
        // through one triangle; lengths agree exactly.
        let (a, b) = (curve.0[0], curve.0[1]);
        let cut: Coord<f64> = coord! {x: a.x + part * (b.x - a.x), y: a.y + part * (b.y - a.y)};
        let first = field.along(&LineString(vec![a, cut]));
        let rest = field.along(&std::iter::once(cut).chain(curve.0[1..].iter().copied()).collect());
        prop_assert!(near(first.length + rest.length, whole.length));
        let off = first.abs_divergence + rest.abs_divergence - whole.abs_divergence;
        prop_assert!(off.abs() < 0.5, "{}", off);
    }

    /// Reports of a field and of the same field elsewhere agree.
    #[test]
    fn figures_do_not_depend_on_the_place(shape in polygon(), angle in -4.0..4.0_f64, x in -1e6..1e6_f64) {
        let here = domain(&shape, 25.0);
        let there = here.moved(angle, coord! {x: x, y: -x});
        for design in [&DistanceField::default() as &dyn FieldDesign, &BoundaryField::default()] {
            let (a, b) = (design.design(&here)?.report(), design.design(&there)?.report());
            prop_assert!(a.check.winding_law() && a.check.holds());
            // Phases at half a turn may wrap either way after rounding, which
            // moves pairs of opposite singularities, not their sum.
            prop_assert_eq!(a.check.interior, b.check.interior);
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-5 * (a.abs() + b.abs() + 1e-9);
            prop_assert!(near(a.mean_boundary_deviation, b.mean_boundary_deviation));
            prop_assert!(a.singularities != b.singularities || near(a.energy, b.energy));
        }
    }
}
