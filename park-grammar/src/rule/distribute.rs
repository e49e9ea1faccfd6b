//! `Distribute(OUTER_EDGE: 0.375, 2) { TallTree }`: things in a row along a
//! selection.
//!
//! The first argument is a selection, what `Parametrise` gives, or places that a
//! line goes through; after its colon, or as `offset`, stands how far inside the
//! row runs, as far as the footprint needs unless said. The second, or `spacing`,
//! is the distance from one thing to the next, twice the spread unless said. It
//! is adjusted so that a whole number of steps fits, with things at both ends;
//! with `Middles` they stand in the middles of the steps, with `Exact` the
//! spacing is kept and what is left over divided among both ends. Where the row
//! turns by more than 30 degrees it has a corner, with a thing on it; with
//! `Through` the row goes on as if there were none. `count` divides all of the
//! row by so many things. Of several branches one follows the other, each as many
//! times as the number before its colon says. Things face into the land;
//! `facing` as in `Place`.
//!
//! At its ends a row keeps as far from the other sides as from its own, or the
//! spread of what it has if that is less; nowhere do footprints leave the region. A thing that meets what
//! stands there already is left out, and counted.

use geo_types::Coord;

use super::points::Facing;
use super::target::{is_closed, lines_at, Target};
use super::Arguments;
use crate::derive::{Node, Places, Run, Spot};
use crate::error::Failure;
use crate::plane::{cross, dist, dot, keep_apart, length, lerp, sides, unit, Segment};
use crate::syntax::ast::{Branch, Head, Operation};

/// A row turns at a corner by more than this, radians: 30 degrees, and a little
/// lest the vertices of a polygon of twelve be corners by their rounding.
const BEND: f64 = std::f64::consts::PI / 6.0 + 1e-6;

/// Places this near are one, as a share of the spacing.
const SAME: f64 = 1e-3;

/// Most things of one operation.
const MOST: f64 = 1e5;

/// How steps are laid out on a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layout {
    Ends,
    Middles,
    Exact,
}

/// A place on a row.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stand {
    at: Coord<f64>,
    along: Coord<f64>,
}

pub(crate) fn distribute(
    run: &mut Run<'_>,
    node: &mut Node,
    operation: &Operation,
    places: &Places,
) -> Result<(), Failure> {
    let pattern = pattern(run, node, operation, places)?;
    let (mut radius, mut spread) = (0.0_f64, 0.0_f64);
    for branch in &pattern {
        let size = run.size(node, &branch.body, places)?;
        radius = radius.max(size.radius);
        spread = spread.max(size.spread);
    }
    let mut scope = run.scope(node, places);
    let mut arguments = Arguments::new(operation);
    let (target, offset) = Target::read(&mut arguments, &mut scope)?;
    let mut layout = Layout::Ends;
    for (word, named) in [("Middles", Layout::Middles), ("Exact", Layout::Exact)] {
        if arguments.flag(&mut scope, word)? {
            layout = named;
        }
    }
    let through = arguments.flag(&mut scope, "Through")?;
    let spacing = match arguments.next() {
        Some(argument) => Some(scope.metres(&argument.value)?),
        None => arguments.metres(&mut scope, "spacing")?,
    };
    let spacing = spacing.unwrap_or((2.0 * spread).max(0.5));
    if spacing <= 0.0 {
        return Err(Failure::fault(
            operation.span,
            "the spacing must be positive",
        ));
    }
    let count = match arguments.named("count") {
        Some(expr) => Some(scope.count(expr)?),
        None => None,
    };
    let facing = Facing::read(&mut arguments, &mut scope)?;
    arguments.done()?;

    let region = &node.region;
    let all: Vec<Segment> = region.area.rings().flat_map(|r| sides(r)).collect();
    let rows: Vec<Vec<Coord<f64>>> = match target {
        Target::Boundary { selection, inset } => {
            // A little more than the footprint needs, for the chords of arcs.
            let default = if inset > 0.0 { 0.0 } else { 1.01 * radius };
            let offset = inset + offset.unwrap_or(default);
            let lines = lines_at(region, &selection, offset);
            // At its ends a row keeps as far from other sides as from its own.
            let others = selection.not(region).lines(region);
            let others = others.iter().flat_map(|line| line.windows(2));
            let others: Vec<Segment> = others.map(|pair| (pair[0], pair[1])).collect();
            let ends = offset.min(spread);
            let inner = lines
                .iter()
                .flat_map(|line| keep_apart(line, &others, ends));
            inner
                .flat_map(|line| keep_apart(&line, &all, radius))
                .collect()
        }
        Target::Line(line) => keep_apart(&line, &all, radius),
        Target::Area => {
            let failure = Failure::fault(operation.span, "a row runs along a line");
            return Err(failure.hint("Scatter fills an area"));
        }
    };
    let before = run.tally();
    let whole: f64 = rows.iter().map(|row| length(row)).sum();
    if whole / spacing > MOST {
        let failure = Failure::fault(operation.span, "this makes more than 100,000 things");
        return Err(failure.hint("a larger spacing makes fewer"));
    }
    let mut stands: Vec<Stand> = match count {
        Some(count) => counted(&rows, count, layout),
        None if through => rows
            .iter()
            .flat_map(|row| on(row, spacing, layout))
            .collect(),
        None => {
            let straight = rows.iter().flat_map(|row| straights(row));
            straight.flat_map(|row| on(&row, spacing, layout)).collect()
        }
    };
    distinct(&mut stands, SAME * spacing);
    if stands.is_empty() {
        // There is no row that is far enough from the boundary.
        run.scene.skipped += 1;
    }
    let turn = if node.region.local.mirrored() {
        1.0
    } else {
        -1.0
    };
    for (stand, branch) in stands.into_iter().zip(pattern.iter().cycle()) {
        // A quarter turn from the row into the land.
        let inward = Coord {
            x: -stand.along.y * turn,
            y: stand.along.x * turn,
        };
        let spot = Spot {
            at: stand.at,
            radius: 0.0,
            facing: inward.y.atan2(inward.x),
        };
        let spot = facing.turn(node, spot);
        run.try_spot(node, &branch.body.operations, places, spot)?;
    }
    run.suited(operation, before)
}

/// The branches in their turn.
fn pattern<'o>(
    run: &mut Run<'_>,
    node: &mut Node,
    operation: &'o Operation,
    places: &Places,
) -> Result<Vec<&'o Branch>, Failure> {
    let mut pattern = Vec::new();
    for branch in operation.blocks.iter().flat_map(|b| &b.branches) {
        let times = match &branch.head {
            None => 1,
            Some(Head::Value(expr)) => run.scope(node, places).count(expr)?,
            Some(Head::Else(span)) => {
                return Err(Failure::fault(
                    *span,
                    "Distribute counts; else belongs to Case",
                ));
            }
        };
        pattern.extend(std::iter::repeat_n(branch, times.min(1000)));
    }
    if pattern.is_empty() {
        let failure = Failure::fault(operation.span, "there is nothing to distribute");
        return Err(failure.hint("write what in braces: Distribute(OUTER) { Tree }"));
    }
    Ok(pattern)
}

/// A line cut at its corners; one without is left as it is.
fn straights(line: &[Coord<f64>]) -> Vec<Vec<Coord<f64>>> {
    let n = line.len();
    let bends = |a: Coord<f64>, b: Coord<f64>, c: Coord<f64>| {
        let (u, v) = (unit(b - a), unit(c - b));
        cross(u, v).atan2(dot(u, v)).abs() > BEND
    };
    let mut line = line.to_vec();
    if is_closed(&line) {
        // It begins at a corner, if it has one.
        let open = &line[..n - 1];
        let m = open.len();
        let corner = (0..m).find(|&k| bends(open[(k + m - 1) % m], open[k], open[(k + 1) % m]));
        let Some(k) = corner else {
            return vec![line];
        };
        line.pop();
        line.rotate_left(k);
        line.extend(line.first().copied());
    }
    let mut parts = Vec::new();
    let mut part = vec![line[0]];
    for k in 1..line.len() {
        part.push(line[k]);
        let last = k + 1 == line.len();
        if last || bends(line[k - 1], line[k], line[k + 1]) {
            parts.push(std::mem::replace(&mut part, vec![line[k]]));
        }
    }
    parts
}

/// The places on one row.
fn on(line: &[Coord<f64>], spacing: f64, layout: Layout) -> Vec<Stand> {
    let whole = length(line);
    let steps = (whole / spacing).round();
    if steps < 1.0 {
        // Too short for two.
        return vec![stand(line, 0.5 * whole)];
    }
    let step = whole / steps;
    let n = steps as usize;
    let at = |along: f64| stand(line, along);
    match layout {
        Layout::Ends if is_closed(line) => (0..n).map(|k| at(k as f64 * step)).collect(),
        Layout::Ends => (0..=n).map(|k| at(k as f64 * step)).collect(),
        Layout::Middles => (0..n).map(|k| at((k as f64 + 0.5) * step)).collect(),
        Layout::Exact => {
            let fitting = (whole / spacing + 1e-9).floor();
            let rest = (0.5 * (whole - fitting * spacing)).max(0.0);
            let closed = is_closed(line) && rest * 2.0 < 0.5 * spacing;
            let n = fitting as usize + usize::from(!closed);
            (0..n).map(|k| at(rest + k as f64 * spacing)).collect()
        }
    }
}

/// So many places over the length of all rows.
fn counted(rows: &[Vec<Coord<f64>>], count: usize, layout: Layout) -> Vec<Stand> {
    let whole: f64 = rows.iter().map(|row| length(row)).sum();
    let closed = matches!(rows, [only] if is_closed(only));
    let share = |k: usize| {
        let (k, n) = (k as f64, count as f64);
        match layout {
            Layout::Middles => (k + 0.5) / n,
            _ if closed => k / n,
            _ if count == 1 => 0.5,
            _ => k / (n - 1.0),
        }
    };
    let place = |k: usize| {
        let mut rest = whole * share(k);
        let last = rows.last()?;
        for row in rows {
            let here = length(row);
            if rest <= here {
                return Some(stand(row, rest));
            }
            rest -= here;
        }
        Some(stand(last, length(last)))
    };
    (0..count).filter_map(place).collect()
}

fn stand(line: &[Coord<f64>], along: f64) -> Stand {
    let mut rest = along;
    let mut found = Stand {
        at: line.first().copied().unwrap_or_default(),
        along: Coord::default(),
    };
    for pair in line.windows(2) {
        let step = dist(pair[0], pair[1]);
        if step > 0.0 {
            found = Stand {
                at: lerp(pair[0], pair[1], (rest / step).min(1.0)),
                along: unit(pair[1] - pair[0]),
            };
            if rest <= step {
                break;
            }
        }
        rest -= step;
    }
    found
}

/// Corners belong to two rows: the second is left out, and faces half way
/// between.
fn distinct(stands: &mut Vec<Stand>, near: f64) {
    let mut kept: Vec<Stand> = Vec::with_capacity(stands.len());
    for stand in stands.drain(..) {
        // The end of the row before, or the beginning of a closed one.
        let [last, first] = [kept.len().checked_sub(1), Some(0)];
        let same = [last, first].into_iter().flatten();
        let same = same.filter(|&k| kept.get(k).is_some_and(|s| dist(s.at, stand.at) <= near));
        match same.into_iter().next() {
            Some(k) => kept[k].along = unit(kept[k].along + stand.along),
            None => kept.push(stand),
        }
    }
    *stands = kept;
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn line(points: &[(f64, f64)]) -> Vec<Coord<f64>> {
        points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect()
    }

    fn xs(stands: &[Stand]) -> Vec<f64> {
        stands
            .iter()
            .map(|s| (s.at.x * 1e6).round() / 1e6)
            .collect()
    }

    #[test]
    fn steps_fit() {
        let row = line(&[(0., 0.), (10., 0.)]);
        // 10 / 3 is nearest to 3 steps.
        assert_eq!(
            xs(&on(&row, 3.0, Layout::Ends)),
            [0.0, 3.333333, 6.666667, 10.0]
        );
        assert_eq!(xs(&on(&row, 5.0, Layout::Middles)), [2.5, 7.5]);
        assert_eq!(xs(&on(&row, 3.0, Layout::Exact)), [0.5, 3.5, 6.5, 9.5]);
        assert_eq!(xs(&on(&row, 30.0, Layout::Ends)), [5.0]);
    }

    #[test]
    fn rows_have_corners() {
        let square = line(&[(0., 1.), (0., 4.), (4., 4.), (4., 0.), (0., 0.), (0., 1.)]);
        let parts = straights(&square);
        assert_eq!(parts.len(), 4);
        let mut all: Vec<Stand> = parts
            .iter()
            .flat_map(|p| on(p, 2.0, Layout::Ends))
            .collect();
        distinct(&mut all, 1e-6);
        assert_eq!(all.len(), 8);
        let third = counted(
            &[line(&[(0., 0.), (2., 0.)]), line(&[(5., 0.), (7., 0.)])],
            3,
            Layout::Ends,
        );
        assert_eq!(xs(&third), [0.0, 2.0, 7.0]);
    }
}
