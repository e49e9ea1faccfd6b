//! How different are the streets of two plans?

use geo_types::{Coord, LineString};
use urban_layout::Layout;

/// How far apart the places are at which streets are compared, metres.
const STEP: f64 = 5.0;

/// The centrelines of the streets that the planner made, not those given with
/// the site.
#[must_use]
pub fn new_streets(layout: &Layout) -> Vec<LineString<f64>> {
    let made = layout.streets.iter().filter(|street| !street.given);
    made.map(|street| street.line.clone()).collect()
}

/// The share of the length of `streets` that lies farther than `reach` metres
/// from every one of `others`, 0 to 1; 0 without streets.
///
/// # Complexity
///
/// O(length / step x segments of `others`): for plans of some square
/// kilometres.
#[must_use]
pub fn share_elsewhere(streets: &[LineString<f64>], others: &[LineString<f64>], reach: f64) -> f64 {
    let (mut all, mut elsewhere) = (0_usize, 0_usize);
    for place in streets.iter().flat_map(places) {
        let near = others
            .iter()
            .flat_map(LineString::lines)
            .any(|segment| distance(place, segment.start, segment.end) <= reach);
        all += 1;
        elsewhere += usize::from(!near);
    }
    elsewhere as f64 / all.max(1) as f64
}

/// Places along a line, evenly spaced within each segment.
fn places(line: &LineString<f64>) -> Vec<Coord<f64>> {
    let mut out = Vec::new();
    for segment in line.lines() {
        let along = segment.end - segment.start;
        let parts = (along.x.hypot(along.y) / STEP).ceil().max(1.0);
        let middles = (0..parts as usize).map(|i| (i as f64 + 0.5) / parts);
        out.extend(middles.map(|t| segment.start + along * t));
    }
    out
}

/// The distance of a point from a segment.
fn distance(at: Coord<f64>, a: Coord<f64>, b: Coord<f64>) -> f64 {
    let (along, to) = (b - a, at - a);
    let square = along.x * along.x + along.y * along.y;
    let t = if square > 0.0 {
        ((to.x * along.x + to.y * along.y) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let off = to - along * t;
    off.x.hypot(off.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::line_string;

    #[test]
    fn half_of_a_street_lies_elsewhere() {
        let streets = [line_string![(x: 0., y: 0.), (x: 200., y: 0.)]];
        let others = [line_string![(x: 0., y: 4.), (x: 100., y: 4.)]];
        let share = share_elsewhere(&streets, &others, 10.0);
        // 9 m of the far half are within 10 m of the end of the other street.
        assert!((share - 0.455).abs() < 0.03, "{share}");
        assert_eq!(share_elsewhere(&others, &streets, 10.0), 0.0);
        assert_eq!(share_elsewhere(&streets, &[], 10.0), 1.0);
        assert_eq!(share_elsewhere(&[], &streets, 10.0), 0.0);
    }
}
