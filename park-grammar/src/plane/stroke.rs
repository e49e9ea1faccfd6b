//! Lines with a width, and circles.

use geo_types::Coord;

use super::{right, unit, Area, Ring};

/// Arcs turn by this much at each vertex at most, radians.
const ARC: f64 = std::f64::consts::PI / 18.0;

/// A circle, as a polygon with vertices on it.
pub(crate) fn circle(centre: Coord<f64>, radius: f64) -> Ring {
    let pieces = (std::f64::consts::TAU / ARC).round() as usize;
    (0..pieces)
        .map(|k| {
            // Clockwise from the north.
            let angle = std::f64::consts::FRAC_PI_2 - k as f64 * ARC;
            centre
                + Coord {
                    x: radius * angle.cos(),
                    y: radius * angle.sin(),
                }
        })
        .collect()
}

/// The land within half of `width` of a line, round at its inner vertices and,
/// if `round`, at its ends; several areas that overlap.
pub(crate) fn stroke(line: &[Coord<f64>], width: f64, round: bool) -> Vec<Area> {
    let half = 0.5 * width;
    let mut areas = Vec::new();
    for pair in line.windows(2) {
        let aside = right(unit(pair[1] - pair[0])) * half;
        if aside != Coord::default() {
            let quad = vec![
                pair[0] + aside,
                pair[0] - aside,
                pair[1] - aside,
                pair[1] + aside,
            ];
            areas.push(Area::new(quad, Vec::new()));
        }
    }
    let joints = if round {
        line
    } else {
        line.get(1..line.len().saturating_sub(1)).unwrap_or(&[])
    };
    let discs = joints
        .iter()
        .map(|&at| Area::new(circle(at, half), Vec::new()));
    areas.extend(discs);
    areas
}
