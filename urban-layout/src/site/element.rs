//! Key elements made to fit: clipped to the site, off the roads, disjoint.

use geo_types::{Coord, LineString, Polygon};

use super::boolean::{area, difference, intersection, open, oriented, total_area};
use super::boundary::Boundary;
use super::measure::{bounds, rings, without_slivers};
use super::warning::{Warning, WarningKind};
use super::{Element, GivenRoad};

/// Half a circle in steps of 7.5 degrees (arcs turn at most 10 degrees a vertex).
const HALF_TURN_STEPS: u32 = 24;

/// Clips elements to the site, takes the width of the given roads out of them, and
/// the common part of two out of the later kind; each piece that is left is an
/// element of its own. In the order of the file.
pub(crate) fn fit(
    elements: Vec<Element>,
    parts: &[Polygon<f64>],
    boundary: &Boundary,
    roads: &[&GivenRoad],
    warnings: &mut Vec<Warning>,
) -> Vec<Element> {
    // Twice the rounding of a line as long as the site, in area.
    let least = 2.0 * boundary.tolerance * (boundary.tolerance / super::ring::ROUNDING);
    let mut ranked: Vec<(usize, Element)> = elements.into_iter().enumerate().collect();
    ranked.sort_by_key(|(order, element)| (element.kind, *order));
    let mut fitted: Vec<(usize, Element)> = Vec::new();
    for (order, element) in ranked {
        let mut pieces = clipped(&element, parts, boundary, least, warnings);
        pieces = off_roads(&element, pieces, roads, least, warnings);
        pieces = off_others(&element, pieces, &fitted, least, warnings);
        for polygon in pieces {
            let piece = Element {
                polygon,
                ..element.clone()
            };
            fitted.push((order, piece));
        }
    }
    // Stable: pieces of one element stay in their order.
    fitted.sort_by_key(|(order, _)| *order);
    fitted.into_iter().map(|(_, element)| element).collect()
}

fn warn(element: &Element, kind: WarningKind, what: &str, warnings: &mut Vec<Warning>) {
    let message = format!("feature {} ({}): {what}", element.feature, element.kind);
    warnings.push(Warning::new(kind, Some(element.feature), message));
}

fn clipped(
    element: &Element,
    parts: &[Polygon<f64>],
    boundary: &Boundary,
    least: f64,
    warnings: &mut Vec<Warning>,
) -> Vec<Polygon<f64>> {
    let outline = &element.polygon;
    let meets = rings(std::slice::from_ref(outline))
        .flat_map(|ring| ring.0.windows(2))
        .any(|w| boundary.meets(w[0], w[1]));
    // Rings that do not meet are one inside the other or apart; the element
    // that holds the whole site, or a hole of it, must be clipped.
    let start = open(outline.exterior())[0];
    let surrounds = parts.iter().any(|part| {
        rings(std::slice::from_ref(part))
            .any(|ring| super::contact::inside(open(outline.exterior()), ring.0[0]))
    });
    if !meets && !surrounds && boundary.contains(start) {
        return vec![outline.clone()];
    }
    let pieces = if meets || surrounds {
        let found = intersection(std::slice::from_ref(outline), parts);
        without_slivers(found, least)
    } else {
        Vec::new()
    };
    let lost = area(outline) - total_area(&pieces);
    if pieces.is_empty() {
        warn(
            element,
            WarningKind::Outside,
            "lies outside the site and was left out",
            warnings,
        );
    } else if lost > least {
        let what = format!("clipped to the site; {lost:.0} m2 lay outside");
        warn(element, WarningKind::Clipped, &what, warnings);
    }
    pieces
}

fn off_roads(
    element: &Element,
    pieces: Vec<Polygon<f64>>,
    roads: &[&GivenRoad],
    least: f64,
    warnings: &mut Vec<Warning>,
) -> Vec<Polygon<f64>> {
    let mut corridor = Vec::new();
    let mut through: Vec<usize> = Vec::new();
    for road in roads {
        let before = corridor.len();
        for w in road.line.0.windows(2) {
            let near = pieces
                .iter()
                .any(|p| boxes_meet(p, &[w[0], w[1]], road.width / 2.0));
            if near {
                corridor.push(stadium(w[0], w[1], road.width / 2.0));
            }
        }
        if corridor.len() > before && !through.contains(&road.feature) {
            through.push(road.feature);
        }
    }
    if corridor.is_empty() {
        return pieces;
    }
    let whole = total_area(&pieces);
    let left = without_slivers(difference(&pieces, &corridor), least);
    let lost = whole - total_area(&left);
    if lost <= least {
        return pieces;
    }
    let what = format!(
        "a given road (one of features {through:?}) runs through it and takes {lost:.0} m2; \
         end the road at its edge, or draw it around the road, if that is not meant"
    );
    warn(element, WarningKind::RoadThroughElement, &what, warnings);
    left
}

fn off_others(
    element: &Element,
    mut pieces: Vec<Polygon<f64>>,
    others: &[(usize, Element)],
    least: f64,
    warnings: &mut Vec<Warning>,
) -> Vec<Polygon<f64>> {
    for (_, other) in others {
        let ring = open(other.polygon.exterior());
        if !pieces.iter().any(|p| boxes_meet(p, ring, 0.0)) {
            continue;
        }
        let whole = total_area(&pieces);
        let left = without_slivers(
            difference(&pieces, std::slice::from_ref(&other.polygon)),
            least,
        );
        let lost = whole - total_area(&left);
        if lost > least {
            let what = format!(
                "overlaps feature {} ({}), which keeps the common {lost:.0} m2",
                other.feature, other.kind
            );
            warn(element, WarningKind::OverlappingElements, &what, warnings);
            pieces = left;
        }
    }
    pieces
}

fn boxes_meet(polygon: &Polygon<f64>, points: &[Coord<f64>], margin: f64) -> bool {
    let (low, high) = bounds(open(polygon.exterior()));
    let (from, to) = bounds(points);
    from.x - margin <= high.x
        && low.x <= to.x + margin
        && from.y - margin <= high.y
        && low.y <= to.y + margin
}

/// All points within `r` of a segment; its straight sides are exact.
fn stadium(a: Coord<f64>, b: Coord<f64>, r: f64) -> Polygon<f64> {
    let d = b - a;
    let heading = d.y.atan2(d.x);
    let mut ring = Vec::with_capacity(2 * HALF_TURN_STEPS as usize + 2);
    for (centre, start) in [(b, -0.5), (a, 0.5)] {
        for k in 0..=HALF_TURN_STEPS {
            let turn = start + f64::from(k) / f64::from(HALF_TURN_STEPS);
            let angle = heading + turn * std::f64::consts::PI;
            ring.push(Coord {
                x: centre.x + r * angle.cos(),
                y: centre.y + r * angle.sin(),
            });
        }
    }
    oriented(ring, Vec::new())
}

/// The lines of roads, for their own sake.
pub(crate) fn lines<'a>(
    roads: impl Iterator<Item = &'a GivenRoad>,
) -> impl Iterator<Item = (&'a LineString<f64>, f64)> {
    roads.map(|road| (&road.line, road.width))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::site::{ElementKind, RoadClass};

    fn square(x: f64, y: f64, s: f64) -> Polygon<f64> {
        let ring = [(x, y), (x + s, y), (x + s, y + s), (x, y + s)];
        oriented(ring.map(|(x, y)| Coord { x, y }).to_vec(), Vec::new())
    }

    fn element(kind: ElementKind, polygon: Polygon<f64>, feature: usize) -> Element {
        Element {
            kind,
            polygon,
            label: None,
            feature,
        }
    }

    fn fitted(elements: Vec<Element>, roads: &[GivenRoad]) -> (Vec<Element>, Vec<WarningKind>) {
        let parts = [square(0.0, 0.0, 100.0)];
        let mut warnings = Vec::new();
        let roads: Vec<&GivenRoad> = roads.iter().collect();
        let boundary = Boundary::new(&parts);
        let out = fit(elements, &parts, &boundary, &roads, &mut warnings);
        (out, warnings.into_iter().map(|w| w.kind).collect())
    }

    fn sum(elements: &[Element]) -> f64 {
        elements.iter().map(|e| area(&e.polygon)).sum()
    }

    #[test]
    fn one_inside_is_kept_to_the_bit() {
        let lake = element(ElementKind::Lake, square(10.1, 10.1, 20.3), 4);
        let (out, warnings) = fitted(vec![lake.clone()], &[]);
        assert_eq!((out, warnings), (vec![lake], vec![]));
    }

    #[test]
    fn what_lies_outside_is_cut_off_or_left_out() {
        let park = element(ElementKind::Park, square(90.0, 90.0, 20.0), 1);
        let far = element(ElementKind::Park, square(900.0, 90.0, 20.0), 2);
        let (out, warnings) = fitted(vec![park, far], &[]);
        assert!((sum(&out) - 100.0).abs() < 1e-6);
        assert_eq!(warnings, [WarningKind::Clipped, WarningKind::Outside]);
        let huge = element(ElementKind::Park, square(-50.0, -50.0, 300.0), 1);
        let (out, _) = fitted(vec![huge], &[]);
        assert!((sum(&out) - 10_000.0).abs() < 1e-6);
    }

    #[test]
    fn the_first_kind_keeps_the_common_part() {
        let park = element(ElementKind::Park, square(10.0, 10.0, 40.0), 1);
        let lake = element(ElementKind::Lake, square(30.0, 30.0, 40.0), 2);
        let (out, warnings) = fitted(vec![park, lake], &[]);
        assert_eq!(warnings, [WarningKind::OverlappingElements]);
        assert_eq!((out[0].feature, out[1].feature), (1, 2));
        assert!((area(&out[0].polygon) - 1200.0).abs() < 1e-6);
        assert!((area(&out[1].polygon) - 1600.0).abs() < 1e-6);
    }

    #[test]
    fn a_road_through_a_lake_takes_its_width() {
        let road = GivenRoad {
            line: LineString::from(vec![(0.0, 50.0), (100.0, 50.0)]),
            class: RoadClass::Local,
            width: 12.0,
            name: None,
            feature: 1,
        };
        let lake = element(ElementKind::Lake, square(20.0, 20.0, 60.0), 2);
        let (out, warnings) = fitted(vec![lake], std::slice::from_ref(&road));
        assert_eq!(warnings, [WarningKind::RoadThroughElement]);
        assert_eq!(out.len(), 2);
        assert!((sum(&out) - 60.0 * 48.0).abs() < 1e-6);
    }

    #[test]
    fn a_stadium_has_straight_sides_at_its_reach() {
        let (a, b) = (Coord { x: 1.0, y: 2.0 }, Coord { x: 4.0, y: 6.0 });
        let polygon = stadium(a, b, 2.0);
        let exact = 5.0 * 4.0 + std::f64::consts::PI * 4.0;
        assert!((area(&polygon) - exact).abs() < 0.01 * exact);
        for &p in open(polygon.exterior()) {
            assert!((super::super::contact::distance(p, a, b) - 2.0).abs() < 1e-12);
        }
    }
}
