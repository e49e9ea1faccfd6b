//! Laws of constraints: strokes, points and terrain.

mod shapes;

use std::f64::consts::FRAC_PI_4;

use crossfield::geo_types::{coord, line_string, Coord, LineString, Polygon};
use crossfield::{
    BoundaryField, ConstrainedField, Cross, Cursor, Domain, DomainOptions, Field, FieldDesign,
    FieldError, PointDirection, Pulls, Raster, Rosy, SlopeArm, Stroke, Symmetry, Terrain,
};
use proptest::prelude::*;
use shapes::{config, domain, polygon, shape, turned};

fn rectangle() -> Polygon<f64> {
    shape(&[(0., 0.), (120., 0.), (120., 80.), (0., 80.)])
}

/// A bent stroke in the rectangle.
fn bend() -> LineString<f64> {
    line_string![(x: 30., y: 20.), (x: 55., y: 30.), (x: 90., y: 60.)]
}

fn with_stroke(line: LineString<f64>, weight: f64) -> ConstrainedField<'static> {
    ConstrainedField::new(BoundaryField::default()).with(Stroke::new(line, weight))
}

fn cross_at(field: &Field, x: f64, y: f64) -> Cross {
    let cross = field.cross(coord! {x: x, y: y}, &mut Cursor::default());
    cross.expect("a cross")
}

/// Largest difference of two fields on a grid over the rectangle, and the
/// largest away from the stroke's ends, where the limit has a kink.
fn difference(a: &Field, b: &Field) -> f64 {
    let mut worst: f64 = 0.0;
    for i in 0..23 {
        for j in 0..15 {
            let (x, y) = (2.5 + 5.0 * f64::from(i), 2.5 + 5.0 * f64::from(j));
            worst = worst.max(cross_at(a, x, y).deviation(&cross_at(b, x, y)));
        }
    }
    worst
}

#[test]
fn a_strong_stroke_is_followed_and_a_weak_one_bends_little() {
    let domain = domain(&rectangle(), 2.0);
    let line = line_string![(x: 40., y: 25.), (x: 80., y: 50.)];
    let wanted = Cross::from_direction(coord! {x: 40.0, y: 25.0}).expect("a direction");
    let deviation = |weight: f64| {
        let field = with_stroke(line.clone(), weight)
            .design(&domain)
            .expect("a field");
        cross_at(&field, 60.0, 37.5).deviation(&wanted)
    };
    let none = wanted.angle().abs();
    let weak = deviation(0.1);
    let middle = deviation(10.0);
    let strong = deviation(1e4);
    assert!(weak < none && middle < weak && strong < middle);
    assert!(strong < 0.01, "{strong}");
    // A tenth of the boundary's weight, and half its length: hardly any.
    assert!(weak > 0.5 * none, "{weak}");
}

/// More points on the same line change nothing but the places of samples; a
/// finer mesh changes the field by what it resolves better.
#[test]
fn strokes_depend_neither_on_their_points_nor_on_the_mesh() {
    let meshes: Vec<Domain> = [8.0, 4.0, 2.0, 1.0].map(|h| domain(&rectangle(), h)).into();
    let fields: Vec<Field> = meshes
        .iter()
        .map(|mesh| with_stroke(bend(), 30.0).design(mesh).expect("a field"))
        .collect();
    let mut dense = Vec::new();
    for l in bend().lines() {
        for k in 0..37 {
            let t = f64::from(k) / 37.0;
            dense.push(coord! {x: l.start.x + t * (l.end.x - l.start.x),
            y: l.start.y + t * (l.end.y - l.start.y)});
        }
    }
    dense.push(*bend().0.last().expect("points"));
    let other = with_stroke(LineString(dense), 30.0)
        .design(&meshes[2])
        .expect("a field");
    // Samples a quarter of an edge length apart, somewhere else: the sum over
    // a triangle differs by one sample's share of a few, at random.
    let moved = difference(&fields[2], &other);
    assert!(moved < 0.01, "{moved}");
    let steps: Vec<f64> = fields
        .windows(2)
        .map(|pair| difference(&pair[0], &pair[1]))
        .collect();
    println!("differences as the mesh is halved: {steps:?}");
    // The limit has kinks across the stroke: of first order in h there.
    assert!(
        steps[1] < 0.8 * steps[0] && steps[2] < 0.8 * steps[1],
        "{steps:?}"
    );
    assert!(steps[2] < 0.03);
}

#[test]
fn points_turn_what_is_around_them_on_any_mesh() {
    let point = PointDirection {
        at: coord! {x: 60.0, y: 40.0},
        direction: coord! {x: 1.0, y: 1.0},
        radius: 6.0,
        weight: 300.0,
    };
    let angle = |h: f64| {
        let design = ConstrainedField::new(BoundaryField::default()).with(point);
        let field = design.design(&domain(&rectangle(), h)).expect("a field");
        cross_at(&field, 60.0, 40.0).deviation(&Cross::from_angle(FRAC_PI_4))
    };
    let (coarse, fine) = (angle(4.0), angle(1.0));
    assert!(coarse < 0.05 && fine < 0.05, "{coarse} {fine}");
}

/// On an inclined plane everything follows the one gradient; on flat ground
/// nothing changes; a raster of the plane is the plane.
#[test]
fn terrain_turns_the_field_along_its_gradient() {
    let domain = domain(&rectangle(), 4.0);
    let plane = |x: f64, y: f64| 0.2 * x + 0.1 * y + 7.0;
    let base = || {
        ConstrainedField::new(BoundaryField {
            omega: 0.0,
            ..BoundaryField::default()
        })
    };
    let field = base()
        .with(Terrain::new(plane, 1.0))
        .design(&domain)
        .expect("a field");
    let wanted = Cross::from_angle(0.5_f64.atan());
    for v in 0..domain.vertex_count() {
        let cross = Cross::from_representative(field.representative(v)).expect("regular");
        assert!(cross.deviation(&wanted) < 1e-9);
    }
    let heights =
        (0..10).flat_map(|j| (0..14).map(move |i| plane(10.0 * f64::from(i), 10.0 * f64::from(j))));
    let raster = Raster::new(coord! {x: 0.0, y: 0.0}, 10.0, 14, heights.collect()).expect("full");
    let again = base()
        .with(Terrain::new(&raster, 1.0))
        .design(&domain)
        .expect("a field");
    assert!(difference(&field, &again) < 1e-9);
    // Flat ground has no gradient to follow: nothing at all is asked for.
    let flat = base().with(Terrain::new(|_, _| 3.0, 1.0)).design(&domain);
    assert!(matches!(flat, Err(FieldError::SingularSystem { .. })));
    // A raster that covers nothing, too.
    let elsewhere = Raster::new(coord! {x: 1e5, y: 0.0}, 10.0, 2, vec![0.0, 1.0, 2.0, 3.0]);
    let design = base().with(Terrain::new(elsewhere.expect("full"), 1.0));
    assert!(matches!(
        design.design(&domain),
        Err(FieldError::SingularSystem { .. })
    ));
    // Lines and vectors know uphill from along the contour.
    for symmetry in [Symmetry::Vector, Symmetry::Line] {
        for (arm, turn) in [
            (SlopeArm::Uphill, 0.0),
            (SlopeArm::Contour, -2.0 * FRAC_PI_4),
        ] {
            let base = BoundaryField {
                omega: 0.0,
                symmetry,
                ..BoundaryField::default()
            };
            let terrain = Terrain {
                arm,
                ..Terrain::new(plane, 1.0)
            };
            let field = ConstrainedField::new(base)
                .with(terrain)
                .design(&domain)
                .expect("a field");
            let found = Rosy::from_representative(symmetry, field.representative(9)).expect("unit");
            let wanted = Rosy::from_angle(symmetry, 0.5_f64.atan() + turn);
            assert!(found.deviation(&wanted) < 1e-9, "{symmetry:?} {arm:?}");
        }
    }
}

#[test]
fn what_cannot_be_followed_is_refused() {
    let domain = domain(&rectangle(), 8.0);
    let refused = |design: ConstrainedField<'_>| {
        let error = design.design(&domain).expect_err("must be refused");
        assert!(matches!(error, FieldError::BadOption { .. }), "{error}");
    };
    let base = || ConstrainedField::new(BoundaryField::default());
    for weight in [0.0, -3.0, f64::NAN, f64::INFINITY] {
        refused(base().with(Stroke::new(bend(), weight)));
        refused(base().with(Terrain::new(|x, _| x, weight)));
    }
    refused(base().with(Stroke::new(line_string![(x: 1., y: 1.)], 1.0)));
    refused(base().with(Terrain {
        half_slope: 0.0,
        ..Terrain::new(|x, _| x, 1.0)
    }));
    let point = PointDirection {
        at: coord! {x: 1.0, y: 1.0},
        direction: coord! {x: 1.0, y: 0.0},
        radius: 1.0,
        weight: 1.0,
    };
    refused(base().with(PointDirection {
        radius: -1.0,
        ..point
    }));
    refused(base().with(PointDirection {
        radius: f64::NAN,
        ..point
    }));
    refused(base().with(PointDirection {
        direction: coord! {x: 0.0, y: 0.0},
        ..point
    }));
    refused(base().with(PointDirection {
        at: coord! {x: f64::NAN, y: 0.0},
        ..point
    }));
    refused(ConstrainedField::new(BoundaryField {
        omega: -1.0,
        ..BoundaryField::default()
    }));
    // Heights that are no numbers are gaps, not an error.
    let holes = Terrain::new(|x: f64, _| if x < 60.0 { f64::NAN } else { x }, 1.0);
    assert!(base().with(holes).design(&domain).is_ok());
    // A disc far larger than the domain, and a stroke outside it.
    let huge = PointDirection {
        radius: 1e9,
        ..point
    };
    assert!(base().with(huge).design(&domain).is_ok());
    let far = Stroke::new(line_string![(x: 1e9, y: 1.), (x: 2e9, y: 1.)], 1.0);
    assert!(base().with(far).design(&domain).is_ok());
}

/// A constraint of one's own.
#[derive(Debug)]
struct Everywhere(f64);

impl crossfield::Constraint for Everywhere {
    fn pull(&self, pulls: &mut Pulls<'_>) -> Result<(), FieldError> {
        let direction = coord! {x: self.0.cos(), y: self.0.sin()};
        for v in 0..pulls.domain().vertex_count() {
            pulls.at_vertex(v, direction, 1e6);
        }
        Ok(())
    }
}

proptest! {
    #![proptest_config(config(12))]

    #[test]
    fn own_constraints_and_none(shape in polygon(), angle in -4.0..4.0_f64) {
        let domain = domain(&shape, 25.0);
        let design = ConstrainedField::new(BoundaryField::default()).with(Everywhere(angle));
        let field = design.design(&domain)?;
        let plain = BoundaryField::default().design(&domain)?;
        let none = ConstrainedField::new(BoundaryField::default()).design(&domain)?;
        for v in 0..domain.vertex_count() {
            let cross = Cross::from_representative(field.representative(v)).expect("regular");
            // The boundary weighs 100 in all, times the share of its length.
            prop_assert!(cross.deviation(&Cross::from_angle(angle)) < 1e-3);
            prop_assert_eq!(plain.representative(v), none.representative(v));
        }
    }

    /// Turning domain, stroke and point together turns every cross.
    #[test]
    fn constraints_turn_with_the_mesh(
        shape in polygon(), angle in -4.0..4.0_f64, ends in proptest::array::uniform4(-150.0..150.0_f64),
    ) {
        let here = domain(&shape, 20.0);
        let shift = coord! {x: 700.0, y: -300.0};
        let there = here.moved(angle, shift);
        // `moved` turns about the middle of the bounding box, which the
        // positions of the vertices show.
        let (s, c) = angle.sin_cos();
        let (p, q) = (here.vertex(0), there.vertex(0));
        let around = coord! {x: q.x - (c * p.x - s * p.y), y: q.y - (s * p.x + c * p.y)};
        let carry = |p: Coord<f64>| coord! {
            x: c * p.x - s * p.y + around.x, y: s * p.x + c * p.y + around.y,
        };
        let [x0, y0, x1, y1] = ends;
        let line = [coord! {x: x0, y: y0}, coord! {x: x1, y: y1}];
        prop_assume!((x1 - x0).hypot(y1 - y0) > 1.0);
        let design = |line: [Coord<f64>; 2]| {
            let point = PointDirection {
                at: line[0],
                direction: coord! {x: line[1].x - line[0].x, y: line[1].y - line[0].y},
                radius: 0.0,
                weight: 5.0,
            };
            ConstrainedField::new(BoundaryField::default())
                .with(Stroke::new(LineString(line.to_vec()), 50.0))
                .with(point)
        };
        let a = design(line).design(&here)?;
        let b = design(line.map(carry)).design(&there)?;
        for v in 0..here.vertex_count() {
            let (da, db) = (a.representative(v), b.representative(v));
            let (Some(a), Some(b)) = (Cross::from_representative(da), Cross::from_representative(db))
            else { continue };
            // Samples on the boundary may fall to either side of it: shares of
            // one in hundreds.
            prop_assert!(a.turned(angle).deviation(&b) < 2e-2);
        }
    }

    /// What a stroke wants where the field goes anyway changes nothing.
    #[test]
    fn a_stroke_along_the_field_changes_nothing(
        width in 30.0..200.0_f64, height in 30.0..200.0_f64, angle in -4.0..4.0_f64, at in 0.1..0.9_f64,
    ) {
        let upright = shape(&[(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]);
        let polygon = turned(&upright, angle, (3e5, 6e6));
        let street = shape(&[(at * width, 0.0), (at * width, height), (at * width, 0.0)]);
        let street = turned(&street, angle, (3e5, 6e6)).exterior().clone();
        let options = DomainOptions::default();
        let domain = Domain::new(&polygon, &options)?;
        let field = with_stroke(street, 100.0).design(&domain)?;
        for v in 0..domain.vertex_count() {
            let cross = Cross::from_representative(field.representative(v)).expect("regular");
            // Coordinates of this size are rounded to 1e-9 m.
            prop_assert!(cross.deviation(&Cross::from_angle(angle)) < 1e-8);
        }
    }
}
