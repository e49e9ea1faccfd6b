//! Regions without holes: `SplitHoles { Piece }`, the flag `SplitHoles` of rules
//! that make rings, and `param NoHoles = 1` for all rules of a grammar.
//!
//! The notes want no holes in regions, and see that this "is unnecessarily complex"
//! to keep up; regions may have them, and whoever wants none says so. A ring is cut
//! where one would look for a joint: from each corner of the hole to the nearest
//! corner that can be seen from it, so that a strip all round a quad falls into one
//! piece for each side, mitred. A hole without corners, such as a circle, is cut
//! through its middle along one of the region's own axes, the one along which there
//! is less to cut.

use std::collections::BTreeMap;

use geo_types::Coord;

use super::peel::within;
use super::{Arguments, Ask, Output, Partition};
use crate::derive::{Number, Scope, Value, Watch};
use crate::error::Failure;
use crate::plane::{
    cross, dist, dot, lerp, sides, slice, split, trim, unit, Area, Line, Ring, Segment,
};
use crate::shape::{Heritage, Region, Role};

/// Vertices that turn by more than this are corners, radians.
const CORNER: f64 = 30.0 * std::f64::consts::PI / 180.0;

/// The flag.
const SPLIT: &str = "SplitHoles";

/// The parameter.
const NONE: &str = "NoHoles";

/// Whether a grammar wants no holes at all.
pub(crate) fn everywhere(params: &BTreeMap<String, Value>) -> bool {
    match params.get(NONE) {
        Some(Value::Number(Number { value, .. })) => *value != 0.0,
        Some(Value::Bool(wanted)) => *wanted,
        _ => false,
    }
}

/// The flag of an operation.
pub(crate) fn wanted(
    arguments: &mut Arguments<'_>,
    scope: &mut Scope<'_>,
) -> Result<bool, Failure> {
    arguments.flag(scope, SPLIT)
}

/// `SplitHoles { Piece }`: the region without holes.
pub(crate) fn split_holes(ask: &mut Ask<'_, '_>) -> Result<Partition, Failure> {
    Arguments::new(ask.operation).done()?;
    let mut outputs = vec![Output::lawns(vec![ask.scope.region.clone()])];
    split_all(&mut outputs, &ask.scope.watch())?;
    Ok(Partition { outputs })
}

/// Splits what has holes in all outputs; an error when the time is up.
pub(crate) fn split_all(outputs: &mut [Output], watch: &Watch<'_>) -> Result<(), Failure> {
    for output in outputs {
        for region in std::mem::take(&mut output.regions) {
            watch.tick()?;
            output.regions.extend(split_region(region));
        }
    }
    Ok(())
}

fn split_region(region: Region) -> Vec<Region> {
    if region.area.holes.is_empty() {
        return vec![region];
    }
    let heritage = Heritage::new(&region, SPLIT);
    let pieces = without_holes(&region.area, region.local.axes());
    let (low, high) = region.area.extent();
    let pieces = trim(pieces, dist(low, high));
    let pieces = pieces.into_iter().map(|area| {
        let local = within(&region, &area);
        let mut piece = heritage.piece(area, local, |_, _| Some(Role::Seam));
        // It is no deeper than what it is a piece of.
        piece.depth = region.depth;
        piece.cell = region.cell;
        crate::index::by_local(&mut piece);
        piece
    });
    pieces.collect()
}

/// Pieces of an area that have no holes; axes for cuts through holes that have no
/// corners.
fn without_holes(area: &Area, axes: [Coord<f64>; 2]) -> Vec<Area> {
    let mut done = Vec::new();
    let mut left = match seams(area).as_slice() {
        [] => vec![area.clone()],
        seams => slice(area, seams),
    };
    // Each cut opens a hole at least.
    while let Some(piece) = left.pop() {
        let Some(hole) = piece.holes.first() else {
            done.push(piece);
            continue;
        };
        let at = crate::plane::middle(&Area::new(hole.clone(), Vec::new()));
        let best = axes.into_iter().min_by(|a, b| {
            let lengths = [a, b].map(|along| inside(&piece, &Line::new(at, *along)));
            // Those that differ by rounding only are as long.
            let shorter = lengths[0] - lengths[1];
            if shorter.abs() < 1e-9 * lengths[0] {
                std::cmp::Ordering::Equal
            } else {
                shorter.total_cmp(&0.0)
            }
        });
        let line = Line::new(at, best.unwrap_or(Coord { x: 1.0, y: 0.0 }));
        let [before, after] = split(std::slice::from_ref(&piece), &line, 0.0);
        let fewer = |part: &Area| part.holes.len() < piece.holes.len();
        if before.iter().chain(&after).all(fewer) {
            left.extend(before.into_iter().chain(after));
        } else {
            // A hole too small for a line to meet.
            done.push(piece);
        }
    }
    done.reverse();
    done
}

/// How much of a line lies in an area.
fn inside(area: &Area, line: &Line) -> f64 {
    let mut meets: Vec<f64> = Vec::new();
    for (a, b) in area.rings().flat_map(|ring| sides(ring)) {
        let (from, to) = (line.aside(a), line.aside(b));
        if (from > 0.0) != (to > 0.0) {
            meets.push(dot(lerp(a, b, from / (from - to)) - line.at, line.along));
        }
    }
    meets.sort_by(f64::total_cmp);
    meets.chunks_exact(2).map(|pair| pair[1] - pair[0]).sum()
}

/// From each corner of a hole to the nearest corner in sight, if there are two at
/// least for the hole; none of them meets another.
fn seams(area: &Area) -> Vec<Vec<Coord<f64>>> {
    let rings: Vec<&Ring> = area.rings().collect();
    let corners: Vec<Vec<Coord<f64>>> = rings.iter().map(|ring| corners(ring)).collect();
    let edges: Vec<Segment> = rings.iter().flat_map(|ring| sides(ring)).collect();
    let mut found: Vec<Segment> = Vec::new();
    for (hole, from) in corners.iter().enumerate().skip(1) {
        let mut wanted: Vec<Segment> = Vec::new();
        for &p in from {
            let others = corners.iter().enumerate().filter(|(ring, _)| *ring != hole);
            let mut targets: Vec<Coord<f64>> = others.flat_map(|(_, c)| c).copied().collect();
            targets.sort_by(|a, b| dist(*a, p).total_cmp(&dist(*b, p)));
            let seen = targets.into_iter().find(|&q| {
                let clear = |s: &Segment| !crosses((p, q), *s);
                edges.iter().all(clear) && area.contains(lerp(p, q, 0.5))
            });
            wanted.extend(seen.map(|q| (p, q)));
        }
        wanted.retain(|&seam| found.iter().all(|&other| !crosses(seam, other)));
        if wanted.len() > 1 {
            found.extend(wanted);
        }
    }
    found.into_iter().map(|(p, q)| vec![p, q]).collect()
}

/// The vertices of a ring that turn by much.
fn corners(ring: &Ring) -> Vec<Coord<f64>> {
    let n = ring.len();
    let turns = |k: &usize| {
        let (a, b, c) = (ring[(k + n - 1) % n], ring[*k], ring[(k + 1) % n]);
        let (u, v) = (unit(b - a), unit(c - b));
        cross(u, v).atan2(dot(u, v)).abs() > CORNER
    };
    (0..n).filter(turns).map(|k| ring[k]).collect()
}

/// Whether two segments meet elsewhere than at common ends.
fn crosses((a, b): Segment, (p, q): Segment) -> bool {
    let side = |a: Coord<f64>, b: Coord<f64>, x: Coord<f64>| {
        let off = cross(unit(b - a), x - a);
        if off.abs() <= 1e-9 * dist(a, b) {
            0.0
        } else {
            off.signum()
        }
    };
    let common = |x: Coord<f64>| x == p || x == q;
    match (common(a), common(b)) {
        (true, true) => return true,
        (true, false) | (false, true) => {
            let (at, far) = if common(a) { (a, b) } else { (b, a) };
            let other = if at == p { q } else { p };
            // Along each other.
            return side(at, far, other) == 0.0 && dot(far - at, other - at) > 0.0;
        }
        (false, false) => {}
    }
    side(a, b, p) * side(a, b, q) <= 0.0
        && side(p, q, a) * side(p, q, b) <= 0.0
        && (side(a, b, p) != 0.0 || side(a, b, q) != 0.0 || {
            // All on one line: do they overlap?
            let along = unit(b - a);
            let [low, high] = [dot(p - a, along), dot(q - a, along)];
            low.min(high) < dist(a, b) && low.max(high) > 0.0
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::circle;
    use geo_types::coord;

    const AXES: [Coord<f64>; 2] = [Coord { x: 1.0, y: 0.0 }, Coord { x: 0.0, y: 1.0 }];

    fn square(at: f64, side: f64) -> Ring {
        [(0., 0.), (0., side), (side, side), (side, 0.)]
            .map(|(x, y)| coord! { x: x + at, y: y + at })
            .to_vec()
    }

    fn pieces(area: &Area) -> Vec<f64> {
        let pieces = without_holes(area, AXES);
        assert!(pieces.iter().all(|piece| piece.holes.is_empty()));
        let whole: f64 = pieces.iter().map(Area::size).sum();
        assert!((whole - area.size()).abs() < 1e-9);
        pieces.iter().map(Area::size).collect()
    }

    /// Four trapezoids of 10 and 6 wide, 2 high.
    #[test]
    fn a_frame_falls_apart_at_its_corners() {
        let frame = Area::new(square(0.0, 10.0), vec![square(2.0, 6.0)]);
        let found = pieces(&frame);
        assert_eq!(found.len(), 4);
        assert!(
            found.iter().all(|size| (size - 16.0).abs() < 1e-9),
            "{found:?}"
        );
    }

    #[test]
    fn a_round_hole_is_cut_through_its_middle() {
        let area = Area::new(
            square(0.0, 10.0),
            vec![circle(coord! { x: 5., y: 5. }, 3.0)],
        );
        let found = pieces(&area);
        assert_eq!(found.len(), 2);
        assert!((found[0] - found[1]).abs() < 1e-9);
    }

    #[test]
    fn several_holes() {
        let holes = vec![
            square(1.0, 2.0),
            square(5.0, 1.5),
            circle(coord! { x: 8., y: 2.5 }, 1.0),
        ];
        pieces(&Area::new(square(0.0, 10.0), holes));
    }
}
