//! Errors of D- and B-fields against closed forms as the mesh is refined, the
//! edge length halved four times.
//!
//! `cargo run --release -p crossfield --features laws --example convergence [FILE]`
//! prints the tables of `convergence.md`, or writes them there.

use std::fmt::Write as _;

use crossfield::geo_types::{Coord, LineString, Polygon};
use crossfield::laws::{converge, shapes};
use crossfield::{
    BoundaryField, Cross, DistanceField, Domain, DomainOptions, FieldDesign, FieldError,
};

/// The outline for an edge length: curves are resolved as finely as the inside.
type Outline = fn(f64) -> Polygon<f64>;
type Exact = fn(Coord<f64>) -> Option<Cross>;

fn circle(radius: f64, edge_length: f64) -> LineString<f64> {
    let count = (std::f64::consts::TAU * radius / edge_length).round() as usize;
    shapes::circle(count, radius).into()
}

fn polygon(points: &[(f64, f64)]) -> Polygon<f64> {
    Polygon::new(points.to_vec().into(), vec![])
}

/// A rectangle, turned by 0.3 rad.
fn rectangle(_: f64) -> Polygon<f64> {
    let (s, c) = 0.3_f64.sin_cos();
    polygon(
        &[(0.0, 0.0), (120.0, 0.0), (120.0, 80.0), (0.0, 80.0)]
            .map(|(x, y)| (c * x - s * y, s * x + c * y)),
    )
}

fn along_rectangle(_: Coord<f64>) -> Option<Cross> {
    Some(Cross::from_angle(0.3))
}

fn annulus(edge_length: f64) -> Polygon<f64> {
    Polygon::new(circle(100.0, edge_length), vec![circle(40.0, edge_length)])
}

fn disc(edge_length: f64) -> Polygon<f64> {
    Polygon::new(circle(100.0, edge_length), vec![])
}

/// Radial, but for the centre, where the field is singular.
fn radial(at: Coord<f64>) -> Option<Cross> {
    Cross::from_direction(at).filter(|_| at.x.hypot(at.y) > 20.0)
}

/// A triangle with 30 degrees at the origin, seen up to 70 m from there: its
/// third side is farther than both others.
fn wedge(_: f64) -> Polygon<f64> {
    let (s, c) = 30.0_f64.to_radians().sin_cos();
    polygon(&[(0.0, 0.0), (150.0, 0.0), (150.0 * c, 150.0 * s)])
}

/// Along the nearer of the two sides.
fn nearer_side(at: Coord<f64>) -> Option<Cross> {
    let side = if at.y.atan2(at.x) < 15.0_f64.to_radians() {
        0.0
    } else {
        30.0_f64.to_radians()
    };
    // On the axis itself both are right.
    let off_axis = at.x.hypot(at.y) * (at.y.atan2(at.x) - 15.0_f64.to_radians()).abs();
    (at.x.hypot(at.y) < 70.0 && off_axis > 1e-6).then(|| Cross::from_angle(side))
}

fn l_shape(_: f64) -> Polygon<f64> {
    polygon(&[
        (-60.0, -60.0),
        (60.0, -60.0),
        (60.0, 0.0),
        (0.0, 0.0),
        (0.0, 60.0),
        (-60.0, 60.0),
    ])
}

fn along_axes(_: Coord<f64>) -> Option<Cross> {
    Some(Cross::from_angle(0.0))
}

/// Around the corner of the L in the quarter opposite to it, where the corner
/// is nearer than the sides beyond.
fn around_the_corner(at: Coord<f64>) -> Option<Cross> {
    let distance = at.x.hypot(at.y);
    let opposite = 60.0 + at.x.min(at.y);
    // Within the coarsest edge of the next region smoothing mixes the two.
    (at.x < -8.0 && at.y < -8.0 && distance < opposite - 16.0)
        .then(|| Cross::from_direction(at))
        .flatten()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let d = DistanceField::default();
    let raw = DistanceField {
        smoothing_rounds: 0,
        ..d.clone()
    };
    let round = DistanceField {
        concave_tangents: false,
        ..d.clone()
    };
    let b = BoundaryField::default();
    let cases: [(&str, &dyn FieldDesign, Outline, Exact); 11] = [
        ("D-field, rectangle", &d, rectangle, along_rectangle),
        ("D-field, disc", &d, disc, radial),
        ("D-field, annulus, no smoothing", &raw, annulus, radial),
        (
            "D-field, annulus, one round of smoothing",
            &d,
            annulus,
            radial,
        ),
        (
            "D-field, wedge of 30 degrees, no smoothing",
            &raw,
            wedge,
            nearer_side,
        ),
        (
            "D-field, wedge of 30 degrees, one round of smoothing",
            &d,
            wedge,
            nearer_side,
        ),
        (
            "D-field, L, concave corner by its tangents",
            &d,
            l_shape,
            along_axes,
        ),
        (
            "D-field, L, around the concave corner",
            &round,
            l_shape,
            around_the_corner,
        ),
        ("B-field, rectangle", &b, rectangle, along_rectangle),
        ("B-field, annulus", &b, annulus, radial),
        ("B-field, L", &b, l_shape, along_axes),
    ];
    let mut text = String::from(
        "# Convergence\n\n\
         Deviation from the exact cross, mean by area and largest, as the edge length h is halved; shapes are some\n\
         100 m across, and circles are sampled every h. A D-field takes the cross of the nearest edge, which on a sampled\n\
         circle is off by up to half the angle that an edge spans: first order. Where the exact field jumps, on the axis\n\
         of the wedge, smoothing blurs a strip of fixed width in edges: first order in the mean, and the largest error\n\
         stays. Exact means to rounding. Written by `examples/convergence.rs`.\n",
    );
    for (name, design, outline, exact) in cases {
        let domains = [8.0, 4.0, 2.0, 1.0, 0.5]
            .map(|edge_length| {
                let options = DomainOptions {
                    edge_length,
                    ..DomainOptions::default()
                };
                Domain::new(&outline(edge_length), &options)
            })
            .into_iter()
            .collect::<Result<Vec<_>, FieldError>>()?;
        write!(
            text,
            "\n## {name}\n\n{}",
            converge(design, &domains, exact)?
        )?;
    }
    match std::env::args_os().nth(1) {
        Some(file) => std::fs::write(file, text)?,
        None => print!("{text}"),
    }
    Ok(())
}
