//! Outlines, and their crosses in closed form.

use crossfield::geo_types::{Coord, LineString, Polygon};
use crossfield::laws::shapes;
use crossfield::Cross;

pub(crate) fn circle(radius: f64, edge_length: f64) -> LineString<f64> {
    let count = (std::f64::consts::TAU * radius / edge_length).round() as usize;
    shapes::circle(count, radius).into()
}

fn polygon(points: &[(f64, f64)]) -> Polygon<f64> {
    Polygon::new(points.to_vec().into(), vec![])
}

/// A rectangle, turned by 0.3 rad.
pub(crate) fn rectangle(_: f64) -> Polygon<f64> {
    let (s, c) = 0.3_f64.sin_cos();
    polygon(
        &[(0.0, 0.0), (120.0, 0.0), (120.0, 80.0), (0.0, 80.0)]
            .map(|(x, y)| (c * x - s * y, s * x + c * y)),
    )
}

pub(crate) fn along_rectangle(_: Coord<f64>) -> Option<Cross> {
    Some(Cross::from_angle(0.3))
}

pub(crate) fn annulus(edge_length: f64) -> Polygon<f64> {
    Polygon::new(circle(100.0, edge_length), vec![circle(40.0, edge_length)])
}

pub(crate) fn disc(edge_length: f64) -> Polygon<f64> {
    Polygon::new(circle(100.0, edge_length), vec![])
}

/// Radial, but for the centre, where the field is singular.
pub(crate) fn radial(at: Coord<f64>) -> Option<Cross> {
    Cross::from_direction(at).filter(|_| at.x.hypot(at.y) > 20.0)
}

/// A triangle with 30 degrees at the origin, seen up to 70 m from there: its
/// third side is farther than both others.
pub(crate) fn wedge(_: f64) -> Polygon<f64> {
    let (s, c) = 30.0_f64.to_radians().sin_cos();
    polygon(&[(0.0, 0.0), (150.0, 0.0), (150.0 * c, 150.0 * s)])
}

/// Along the nearer of the two sides.
pub(crate) fn nearer_side(at: Coord<f64>) -> Option<Cross> {
    let side = if at.y.atan2(at.x) < 15.0_f64.to_radians() {
        0.0
    } else {
        30.0_f64.to_radians()
    };
    // On the axis itself both are right.
    let off_axis = at.x.hypot(at.y) * (at.y.atan2(at.x) - 15.0_f64.to_radians()).abs();
    (at.x.hypot(at.y) < 70.0 && off_axis > 1e-6).then(|| Cross::from_angle(side))
}

pub(crate) fn l_shape(_: f64) -> Polygon<f64> {
    polygon(&[
        (-60.0, -60.0),
        (60.0, -60.0),
        (60.0, 0.0),
        (0.0, 0.0),
        (0.0, 60.0),
        (-60.0, 60.0),
    ])
}

pub(crate) fn along_axes(_: Coord<f64>) -> Option<Cross> {
    Some(Cross::from_angle(0.0))
}

/// Around the corner of the L in the quarter opposite to it, where the corner
/// is nearer than the sides beyond.
pub(crate) fn around_the_corner(at: Coord<f64>) -> Option<Cross> {
    let distance = at.x.hypot(at.y);
    let opposite = 60.0 + at.x.min(at.y);
    // Within the coarsest edge of the next region smoothing mixes the two.
    (at.x < -8.0 && at.y < -8.0 && distance < opposite - 16.0)
        .then(|| Cross::from_direction(at))
        .flatten()
}

/// A sector of 60 degrees, its arc sampled every `edge_length`.
pub(crate) fn sector(edge_length: f64) -> Polygon<f64> {
    let mut ring = vec![(0.0, 0.0)];
    ring.extend(arc(100.0, SECTOR, edge_length));
    polygon(&ring)
}

const SECTOR: f64 = std::f64::consts::FRAC_PI_3;

fn arc(radius: f64, span: f64, edge_length: f64) -> Vec<(f64, f64)> {
    let count = (span * radius / edge_length).ceil() as usize;
    (0..=count)
        .map(|k| {
            let (s, c) = (span * k as f64 / count as f64).sin_cos();
            (radius * c, radius * s)
        })
        .collect()
}

/// The harmonic function with D = 1 on one side of the sector, that of the
/// other on the other, and exp(4 i t) on the arc: linear in the angle t plus
/// `b_n (r / R)^(3 n) sin(3 n t)`, b_n the sine coefficients of what is left on
/// the arc.
pub(crate) fn between_sides(at: Coord<f64>) -> Option<Cross> {
    let (r, t) = (at.x.hypot(at.y) / 100.0, at.y.atan2(at.x));
    // The chords of the arc leave ripples near it, and at the tip D has no
    // limit.
    if !(0.1..0.8).contains(&r) {
        return None;
    }
    let end = 4.0 * SECTOR;
    let along = t / SECTOR;
    let (mut x, mut y) = (1.0 - along + along * end.cos(), along * end.sin());
    for n in 1..=120_u32 {
        let k = f64::from(n) * std::f64::consts::PI / SECTOR;
        // The integral of (exp(4 i t) - linear) sin(k t), by parts twice: both
        // agree at the ends, so it is 16 / k^2 times that of exp(4 i t) sin(k t).
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        // Integral of exp(4 i t) sin(k t) over the span.
        let whole = (
            k * (1.0 - sign * end.cos()) / (k * k - 16.0),
            -k * sign * end.sin() / (k * k - 16.0),
        );
        let factor = 2.0 / SECTOR * 16.0 / (k * k);
        let radial = r.powf(k) * (k * t).sin();
        x += factor * whole.0 * radial;
        y += factor * whole.1 * radial;
    }
    Some(Cross::from_angle(y.atan2(x) / 4.0))
}

/// Part of an annulus between two angles.
pub(crate) fn arched(edge_length: f64) -> Polygon<f64> {
    let mut ring = arc(100.0, 1.9, edge_length);
    ring.extend(arc(40.0, 1.9, edge_length).into_iter().rev());
    polygon(&ring)
}
