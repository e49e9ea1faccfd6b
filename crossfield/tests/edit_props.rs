//! Laws of blends, local smoothing and edits: what is not meant stays.

mod shapes;

use crossfield::geo_types::{coord, line_string, Coord, LineString, Polygon};
use crossfield::{
    BoundaryField, Cross, Cursor, DistanceField, Domain, Field, FieldDesign, FieldError, Start,
    Stroke, Symmetry,
};
use proptest::prelude::*;
use shapes::{config, domain, polygon, regular, shape};

fn cross(field: &Field, v: usize) -> Option<Cross> {
    Cross::from_representative(field.representative(v))
}

fn refused(result: Result<Field, FieldError>) {
    let error = result.expect_err("must be refused");
    assert!(matches!(error, FieldError::BadOption { .. }), "{error}");
}

/// Distance from a point to a polyline.
fn distance(line: &LineString<f64>, p: Coord<f64>) -> f64 {
    let to = |l: crossfield::geo_types::Line<f64>| {
        let (d, e) = (l.delta(), coord! {x: p.x - l.start.x, y: p.y - l.start.y});
        let t = ((d.x * e.x + d.y * e.y) / (d.x * d.x + d.y * d.y)).clamp(0.0, 1.0);
        (e.x - t * d.x).hypot(e.y - t * d.y)
    };
    line.lines().map(to).fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(config(12))]

    /// A blend with itself, or with weight 0, is the field; the order and the
    /// scale of the weights do not count; and D of the blend lies between.
    #[test]
    fn blends_are_convex(shape in polygon(), a in 0.01..10.0_f64, b in 0.01..10.0_f64) {
        let domain = domain(&shape, 20.0);
        let one = DistanceField::default().design(&domain)?;
        let two = BoundaryField::default().design(&domain)?;
        let same = Field::blend(&[(&one, a), (&one, b)])?;
        let only = Field::blend(&[(&one, a), (&two, 0.0)])?;
        let mixed = Field::blend(&[(&one, a), (&two, b)])?;
        let turned = Field::blend(&[(&two, 3.0 * b), (&one, 3.0 * a)])?;
        let half = one.blend_by(&two, |_| b / (a + b))?;
        for v in 0..domain.vertex_count() {
            let (Some(p), Some(q)) = (cross(&one, v), cross(&two, v)) else { continue };
            let at = |f: &Field| cross(f, v).unwrap_or(p);
            prop_assert!(at(&same).deviation(&p) < 1e-9 && at(&only).deviation(&p) < 1e-9);
            if p.deviation(&q) > 0.78 {
                continue; // opposite: the blend is open
            }
            let whole = p.deviation(&q);
            let parts = at(&mixed).deviation(&p) + at(&mixed).deviation(&q);
            prop_assert!((parts - whole).abs() < 1e-9);
            prop_assert!(at(&mixed).deviation(&at(&turned)) < 1e-9);
            prop_assert!(at(&mixed).deviation(&at(&half)) < 1e-9);
        }
        let (none, all) = (one.blend_by(&two, |_| 0.0)?, one.blend_by(&two, |_| 1.0)?);
        for v in 0..domain.vertex_count() {
            prop_assert_eq!(none.representative(v), one.representative(v));
            prop_assert_eq!(all.representative(v), two.representative(v));
        }
        prop_assert!(mixed.index_check().winding_law());
    }

    /// Outside the region nothing changes, to the bit, and the winding around
    /// it neither; inside, nothing is left of noise.
    #[test]
    fn smoothing_inside_a_region_keeps_the_rest(
        shape in polygon(), x in -80.0..80.0_f64, y in -80.0..80.0_f64, radius in 30.0..120.0_f64,
        seed in 0..1000_u64,
    ) {
        let domain = domain(&shape, 12.0);
        let restless = BoundaryField {
            start: Start::Random { seed },
            unit_rounds: 2,
            ..BoundaryField::default()
        };
        let field = restless.design(&domain)?;
        let region = Polygon::new(regular(40, radius, (x, y)), vec![]);
        let smooth = field.smoothed_inside(&region)?;
        // Between the circle and its polygon it could be either.
        let edge = radius * (std::f64::consts::PI / 40.0).cos();
        for v in 0..domain.vertex_count() {
            let at = domain.vertex(v);
            let from = (at.x - x).hypot(at.y - y);
            if from > radius || domain.is_boundary(v) {
                prop_assert_eq!(field.representative(v), smooth.representative(v));
            } else if from < edge - 1e-9 {
                // The discrete mean value: within what the neighbours span.
                let d = smooth.representative(v);
                prop_assert!((d.x.hypot(d.y) - 1.0).abs() < 1e-9 || (d.x == 0.0 && d.y == 0.0));
            }
        }
        prop_assert_eq!(field.boundary_winding(), smooth.boundary_winding());
        prop_assert_eq!(field.index_sum(), smooth.index_sum());
        // Smoothing what is smooth is nothing.
        let again = smooth.smoothed_inside(&region)?;
        prop_assert_eq!(again.domain().vertex_count(), domain.vertex_count());
    }

    /// Beyond the reach nothing changes, to the bit; strokes along the field
    /// change nothing at all; no stroke is no edit.
    #[test]
    fn edits_keep_the_rest(
        shape in polygon(), ends in proptest::array::uniform4(-120.0..120.0_f64), reach in 5.0..80.0_f64,
        weight in 1.0..1000.0_f64,
    ) {
        let domain = domain(&shape, 12.0);
        let field = BoundaryField::default().design(&domain)?;
        let [x0, y0, x1, y1] = ends;
        prop_assume!((x1 - x0).hypot(y1 - y0) > 1.0);
        let line = line_string![(x: x0, y: y0), (x: x1, y: y1)];
        let edited = field.edited(&[Stroke::new(line.clone(), weight)], reach)?;
        for v in 0..domain.vertex_count() {
            if domain.is_boundary(v) || distance(&line, domain.vertex(v)) > reach * (1.0 + 1e-9) {
                prop_assert_eq!(field.representative(v), edited.representative(v));
            }
        }
        prop_assert_eq!(field.boundary_winding(), edited.boundary_winding());
        let none = field.edited(&[], reach)?;
        for v in 0..domain.vertex_count() {
            prop_assert_eq!(field.representative(v), none.representative(v));
        }
    }
}

#[test]
fn a_heavy_stroke_is_followed_and_a_fitting_one_changes_nothing() {
    let site = shape(&[(0., 0.), (120., 0.), (120., 80.), (0., 80.)]);
    let domain = domain(&site, 2.0);
    let field = BoundaryField::default().design(&domain).expect("a field");
    let line = line_string![(x: 40., y: 30.), (x: 80., y: 50.)];
    let edited = field
        .edited(&[Stroke::new(line, 1e4)], 20.0)
        .expect("possible");
    let wanted = Cross::from_angle(0.5_f64.atan());
    let there = edited.cross(coord! {x: 60.0, y: 40.0}, &mut Cursor::default());
    assert!(there.expect("regular").deviation(&wanted) < 0.01);
    // It fades away: a fit half-way to the reach is turned less.
    let side = edited.cross(coord! {x: 55.0, y: 50.0}, &mut Cursor::default());
    let side = side.expect("regular").deviation(&Cross::from_angle(0.0));
    assert!(side > 0.02 && side < 0.4, "{side}");
    let fitting = Stroke::new(line_string![(x: 10., y: 30.), (x: 90., y: 30.)], 1e3);
    let same = field.edited(&[fitting], 20.0).expect("possible");
    for v in 0..domain.vertex_count() {
        let (a, b) = (cross(&field, v), cross(&same, v));
        assert!(a.expect("regular").deviation(&b.expect("regular")) < 1e-9);
    }
}

/// The harmonic disc: smoothing a whole disc inside keeps the turns of its
/// boundary and spreads them evenly.
#[test]
fn smoothing_restores_what_noise_hid() {
    let site = shape(&[(0., 0.), (120., 0.), (120., 80.), (0., 80.)]);
    let domain = domain(&site, 3.0);
    let vectors = (0..domain.vertex_count()).map(|v| {
        let noise = if domain.is_boundary(v) {
            0.0
        } else {
            0.3 * ((v * 7919) as f64).sin()
        };
        Cross::from_angle(noise).representative()
    });
    let noisy = Field::from_representatives(&domain, vectors.collect()).expect("fits");
    let region = Polygon::new(regular(30, 500.0, (60.0, 40.0)), vec![]);
    let smooth = noisy.smoothed_inside(&region).expect("possible");
    for v in 0..domain.vertex_count() {
        assert!(cross(&smooth, v).expect("regular").angle().abs() < 1e-9);
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let site = shape(&[(0., 0.), (120., 0.), (120., 80.), (0., 80.)]);
    let (one, two): (Domain, Domain) = (domain(&site, 10.0), domain(&site, 11.0));
    let a = BoundaryField::default().design(&one).expect("a field");
    let b = BoundaryField::default().design(&two).expect("a field");
    let lines = BoundaryField {
        symmetry: Symmetry::Line,
        ..BoundaryField::default()
    };
    let lines = lines.design(&one).expect("a field");
    refused(Field::blend(&[]));
    refused(Field::blend(&[(&a, 1.0), (&b, 1.0)]));
    refused(Field::blend(&[(&a, 1.0), (&lines, 1.0)]));
    for weights in [
        (0.0, 0.0),
        (-1.0, 2.0),
        (f64::NAN, 1.0),
        (f64::INFINITY, 1.0),
    ] {
        refused(Field::blend(&[(&a, weights.0), (&a, weights.1)]));
    }
    refused(a.blend_by(&b, |_| 0.5));
    refused(a.blend_by(&a, |p| p.x));
    refused(a.blend_by(&a, |_| f64::NAN));
    let stroke = || Stroke::new(line_string![(x: 40., y: 30.), (x: 80., y: 50.)], 1.0);
    for reach in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        refused(a.edited(&[stroke()], reach));
    }
    refused(a.edited(
        &[Stroke {
            weight: 0.0,
            ..stroke()
        }],
        10.0,
    ));
    let bad = shape(&[(0., 0.), (f64::NAN, 0.), (1., 1.)]);
    refused(a.smoothed_inside(&bad));
    // A region without area or outside frees nothing.
    let empty = Polygon::new(LineString(vec![]), vec![]);
    let same = a.smoothed_inside(&empty).expect("possible");
    assert_eq!(same.representative(40), a.representative(40));
}
