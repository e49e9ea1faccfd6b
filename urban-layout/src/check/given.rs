//! What came with the site is still there.

use super::Findings;
use crate::layout::plane::{
    area_outside, distance, length, polygon_area, stretch_within, union_length, Segments,
};
use crate::layout::Layout;
use crate::site::Site;

/// A given road is a street where a centreline runs this near, metres.
const SAME_LINE: f64 = 1.0;

/// Judges `given_elements` (each keeps all but 1 % + 1 m2 of its land) and
/// `given_roads` (each is a street but for 1 m).
pub(crate) fn judge(site: &Site, layout: &Layout, findings: &mut Findings) {
    let mut faults = Vec::new();
    for element in &site.elements {
        let word = element.kind.as_str();
        let same = layout
            .tiles
            .iter()
            .filter(|tile| tile.kind.as_str() == word)
            .map(|tile| &tile.polygon);
        let lost = area_outside([&element.polygon], same);
        if lost > 0.01 * polygon_area(&element.polygon) + 1.0 {
            faults.push(format!(
                "the given {word} of feature {} lost {lost:.1} m2",
                element.feature
            ));
        }
    }
    findings.none_of("given_elements", faults);
    let drawn = Segments::of_lines(layout.streets.iter().map(|s| s.line.0.as_slice()));
    let mut faults = Vec::new();
    for road in site.roads.iter().chain(&site.boundary_roads) {
        let mut kept = 0.0;
        let mut stretches = Vec::new();
        for w in road.line.0.windows(2) {
            stretches.clear();
            let near = drawn.near(w[0], w[1], SAME_LINE);
            stretches.extend(near.filter_map(|s| stretch_within(w[0], w[1], s.a, s.b, SAME_LINE)));
            kept += union_length(&mut stretches) * distance(w[0], w[1]);
        }
        let lost = length(&road.line.0) - kept;
        if lost > 1.0 {
            faults.push(format!(
                "the given road of feature {} is no street over {lost:.1} m",
                road.feature
            ));
        }
    }
    findings.none_of("given_roads", faults);
}
