//! Numbers and positions as GeoJSON text.

use std::fmt::Write as _;

use geo_types::{Coord, LineString};

use super::frame::Frame;

/// Decimals of a coordinate in degrees: 1e-10 degrees are 0.01 mm.
const DEGREE_DECIMALS: usize = 10;
/// Decimals of a coordinate in metres.
const METRE_DECIMALS: usize = 6;

/// A number with at most so many decimals, none of them trailing zeros; `null`
/// if it is no number.
pub(super) fn number(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "null".to_owned();
    }
    let text = format!("{value:.decimals$}");
    let short = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    if short == "-0" {
        "0".to_owned()
    } else {
        short.to_owned()
    }
}

/// The beginning of a FeatureCollection in the coordinates of the frame's source,
/// up to its members.
pub(super) fn collection(frame: &Frame) -> String {
    let mut text = String::from("{\"type\":\"FeatureCollection\",");
    if !frame.is_degrees() {
        text.push_str("\"coordinate_units\":\"metres\",");
    }
    text
}

/// Appends a point, in the coordinates of the frame's source.
pub(super) fn push_position(text: &mut String, frame: &Frame, c: Coord<f64>) {
    push_finer(text, frame, c, 0);
}

/// Appends a point with so many more decimals than a plan needs.
pub(super) fn push_finer(text: &mut String, frame: &Frame, c: Coord<f64>, more: usize) {
    let source = frame.to_source(c);
    let decimals = more
        + if frame.is_degrees() {
            DEGREE_DECIMALS
        } else {
            METRE_DECIMALS
        };
    let _ = write!(
        text,
        "[{},{}]",
        number(source.x, decimals),
        number(source.y, decimals)
    );
}

/// Appends the points of a line.
pub(super) fn push_line(text: &mut String, frame: &Frame, line: &LineString<f64>) {
    text.push('[');
    for (i, c) in line.0.iter().enumerate() {
        if i > 0 {
            text.push(',');
        }
        push_position(text, frame, *c);
    }
    text.push(']');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(number(100.0, 2), "100");
        assert_eq!(number(-0.000_000_000_01, 10), "0");
        assert_eq!(number(26.925, 10), "26.925");
        assert_eq!(number(1500.0, 0), "1500");
        assert_eq!(number(f64::INFINITY, 2), "null");
    }
}
