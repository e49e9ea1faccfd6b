//! Areas drawn in from some of their edges, each by a width of its own.
//!
//! What goes is what lies within a width of its edge, whatever lies between, so that
//! places narrower than that fall away and corners that turn inwards become round:
//! the room beside paths. A [`Band`](super::Band) is what edges of one depth sweep
//! over on their way, mitred, and no farther than the boundary that stops them: no
//! band gives the round corners and the many widths that cells need.

use geo_types::Coord;

use super::inset::REACH;
use super::{cross, difference, dist, dot, strip, unit, Area, Corner};

/// Widths that differ by less, as a share, are one.
const SAME: f64 = 1e-9;

/// What is left of an area if from each of its edges the land within a width is
/// taken: `widths` has one for each edge, ring by ring, 0 to leave it.
///
/// Corners that turn inwards become round; a strip beside an edge that is left
/// goes on straight until it meets that edge.
pub(crate) fn erode(area: &Area, widths: &[Vec<f64>]) -> Vec<Area> {
    let mut strips = Vec::new();
    for (ring, widths) in area.rings().zip(widths) {
        strips.extend(along(ring, widths));
    }
    if strips.is_empty() {
        return vec![area.clone()];
    }
    difference(std::slice::from_ref(area), &strips)
}

fn along(ring: &[Coord<f64>], widths: &[f64]) -> Vec<Area> {
    let n = ring.len();
    let at = |k: usize| ring[k % n];
    let width = |k: usize| widths[k % n];
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.max(b);
    let mut found = Vec::new();
    // Where a run of edges of one width begins.
    let Some(first) = (0..n).find(|&k| !same(width(k), width(k + n - 1))) else {
        let whole: Vec<Coord<f64>> = (0..=n).map(at).collect();
        return strip(&whole, width(0), Corner::Round);
    };
    let mut k = first;
    while k < first + n {
        let wide = width(k);
        let mut line = vec![at(k)];
        let start = k;
        while k < first + n && same(width(k), wide) {
            line.push(at(k + 1));
            k += 1;
        }
        if wide <= 0.0 {
            continue;
        }
        let m = line.len();
        if width(start + n - 1) <= 0.0 {
            let beyond = overshoot(at(start + n - 1), line[0], line[1], wide);
            line[0] = line[0] - unit(line[1] - line[0]) * beyond;
        } else {
            found.extend(joint(at(start + n - 1), line[0], line[1], wide));
        }
        if width(k) <= 0.0 {
            let beyond = overshoot(at(k + 1), line[m - 1], line[m - 2], wide);
            line[m - 1] = line[m - 1] + unit(line[m - 1] - line[m - 2]) * beyond;
        } else {
            found.extend(joint(line[m - 2], line[m - 1], at(k + 1), wide));
        }
        found.extend(strip(&line, wide, Corner::Round));
    }
    found
}

/// How far a strip must go on beyond its end to be cut off along the edge from
/// there to `beside`, which keeps its place: as far as a mitre at most.
fn overshoot(beside: Coord<f64>, end: Coord<f64>, from: Coord<f64>, width: f64) -> f64 {
    let (edge, back) = (unit(beside - end), unit(from - end));
    let (sin, cos) = (cross(edge, back).abs(), dot(edge, back));
    // Up to a right angle the strip's own end reaches the edge.
    if cos >= 0.0 {
        0.0
    } else if -cos >= REACH * sin {
        REACH * width
    } else {
        -cos / sin * width
    }
}

/// The land beside a corner that turns inwards between edges of two widths.
fn joint(before: Coord<f64>, at: Coord<f64>, after: Coord<f64>, width: f64) -> Vec<Area> {
    let (u, v) = (unit(at - before), unit(after - at));
    if cross(u, v) <= 0.0 {
        return Vec::new();
    }
    let short = [dist(before, at), dist(at, after), width]
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    let line = [at - u * (0.5 * short), at, at + v * (0.5 * short)];
    strip(&line, width, Corner::Round)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn area(points: &[(f64, f64)]) -> Area {
        let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
        Area::new(ring, Vec::new())
    }

    fn total(areas: &[Area]) -> f64 {
        areas.iter().map(Area::size).sum()
    }

    #[test]
    fn edges_are_drawn_in_each_by_its_own() {
        let square = area(&[(0., 0.), (0., 10.), (10., 10.), (10., 0.)]);
        let left = erode(&square, &[vec![1.0, 2.0, 0.0, 3.0]]);
        assert_eq!(left.len(), 1);
        assert!((total(&left) - 9.0 * 5.0).abs() < 1e-9);
        assert_eq!(total(&erode(&square, &[vec![0.0; 4]])), 100.0);
        let all = erode(&square, &[vec![2.0; 4]]);
        assert!((total(&all) - 36.0).abs() < 1e-9);
    }

    /// The strip along the slanting edge ends along its neighbours, not square:
    /// a parallelogram of 10 in height and 2 across.
    #[test]
    fn strips_end_along_their_neighbours() {
        let slanting = area(&[(0., 0.), (5., 10.), (20., 10.), (20., 0.)]);
        let left = erode(&slanting, &[vec![2.0, 0.0, 0.0, 0.0]]);
        let across = 2.0 / (10.0 / 125.0_f64.sqrt());
        assert!((total(&left) - (175.0 - 10.0 * across)).abs() < 1e-9);
    }

    /// In a corner that turns inwards the widths on both sides are kept.
    #[test]
    fn inner_corners_are_round() {
        let l = area(&[
            (0., 0.),
            (0., 10.),
            (5., 10.),
            (5., 5.),
            (10., 5.),
            (10., 0.),
        ]);
        let left = erode(&l, &[vec![0.0, 0.0, 1.0, 1.0, 0.0, 0.0]]);
        // A quarter of a polygon of 36 corners and radius 1.
        let quarter = 9.0 * 0.5 * (std::f64::consts::PI / 18.0).sin();
        assert!((total(&left) - (75.0 - 10.0 - quarter)).abs() < 1e-9);
    }

    /// What is too narrow goes, and what is left may fall apart.
    #[test]
    fn narrow_places_go() {
        let bone = area(&[
            (0., 0.),
            (0., 10.),
            (10., 10.),
            (10., 6.),
            (20., 6.),
            (20., 10.),
            (30., 10.),
            (30., 0.),
            (20., 0.),
            (20., 4.),
            (10., 4.),
            (10., 0.),
        ]);
        let left = erode(&bone, &[vec![1.5; 12]]);
        assert_eq!(left.len(), 2);
        // Two squares of 7, each with a bit of the doorway between two corners 2
        // apart, whose arcs of 1.5 meet 1.12 before it.
        let doorways = total(&left) - 2.0 * 49.0;
        assert!(doorways > 0.0 && doorways < 2.0 * 2.0 * (1.5 - 1.25_f64.sqrt()));
    }
}
