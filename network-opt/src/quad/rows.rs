//! Points inside, in rows along the arms of a cross field: each point offers
//! its four neighbours a step away, the boundary first, and those that find
//! room are taken. On a rectangle that is a grid.

use std::collections::VecDeque;

use geo_types::Coord;

use super::outline::Outline;
use super::Directions;
use crate::mesh::predicates::dist;

type P = Coord<f64>;

/// Least distance between points, in steps: less than a side, more than half a
/// diagonal.
const APART: f64 = 0.74;
/// Least distance from the boundary, in steps.
const CLEAR: f64 = 0.55;

/// Points in cells as wide as points are apart at least.
struct Cells {
    cell: f64,
    low: P,
    columns: usize,
    cells: Vec<Vec<P>>,
}

impl Cells {
    fn new(points: &[P], cell: f64) -> Self {
        let fold = |pick: fn(f64, f64) -> f64, start: f64| {
            points.iter().fold(P { x: start, y: start }, |sum, p| P {
                x: pick(sum.x, p.x),
                y: pick(sum.y, p.y),
            })
        };
        let (low, high) = (
            fold(f64::min, f64::INFINITY),
            fold(f64::max, f64::NEG_INFINITY),
        );
        let columns = ((high.x - low.x) / cell) as usize + 1;
        let rows = ((high.y - low.y) / cell) as usize + 1;
        let mut cells = Self {
            cell,
            low,
            columns,
            cells: vec![Vec::new(); columns * rows],
        };
        points.iter().for_each(|&p| cells.add(p));
        cells
    }

    fn place(&self, p: P) -> (usize, usize) {
        let of = |v: f64| (v / self.cell).max(0.0) as usize;
        let (x, y) = (of(p.x - self.low.x), of(p.y - self.low.y));
        let rows = self.cells.len() / self.columns;
        (x.min(self.columns - 1), y.min(rows - 1))
    }

    fn add(&mut self, p: P) {
        let (x, y) = self.place(p);
        self.cells[y * self.columns + x].push(p);
    }

    fn any_within(&self, p: P, reach: f64) -> bool {
        let (x, y) = self.place(p);
        let rows = self.cells.len() / self.columns;
        let span = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
        span(y, rows).any(|row| {
            span(x, self.columns).any(|column| {
                self.cells[row * self.columns + column]
                    .iter()
                    .any(|&q| dist(p, q) < reach)
            })
        })
    }
}

/// Rows start from the boundary where the field follows it to within this
/// angle, radians.
const ALIGNED: f64 = 0.3;

/// The points, in the order of their making; all coordinates, those given to
/// `directions` too, are relative to the outline's centre.
///
/// Rows that start from a boundary which the field does not follow would not
/// meet each other's: those boundary vertices come last, and if there are no
/// others the rows start from the deepest point inside.
pub(super) fn fill(outline: &Outline, step: f64, directions: &Directions<'_>) -> Vec<P> {
    let mut cells = Cells::new(&outline.points, APART * step);
    let mut inside = Vec::new();
    let follows = |k: usize| {
        let [a, b] = [outline.points[k], outline.points[outline.next(k)]];
        let edge = (b.y - a.y).atan2(b.x - a.x);
        directions((a + b) / 2.0)
            .is_some_and(|angle| (nearest_arm(angle, edge) - edge).abs() < ALIGNED)
    };
    let count = outline.points.len();
    let aligned: Vec<bool> = (0..count).map(follows).collect();
    let of = |wanted: bool| {
        let chosen = (0..count).filter(|&k| aligned[k] == wanted);
        chosen.map(|k| outline.points[k]).collect::<Vec<_>>()
    };
    let mut first = of(true);
    if first.is_empty() {
        if let Some(deepest) = outline.deepest(step) {
            cells.add(deepest);
            inside.push(deepest);
            first.push(deepest);
        }
    }
    for start in [first, of(false)] {
        grow(
            outline,
            step,
            directions,
            start.into(),
            &mut cells,
            &mut inside,
        );
    }
    inside
}

/// Rows from the points of a queue on.
fn grow(
    outline: &Outline,
    step: f64,
    directions: &Directions<'_>,
    mut queue: VecDeque<P>,
    cells: &mut Cells,
    inside: &mut Vec<P>,
) {
    while let Some(from) = queue.pop_front() {
        let Some(angle) = directions(from) else {
            continue;
        };
        for quarter in 0..4 {
            let heading = angle + f64::from(quarter) * std::f64::consts::FRAC_PI_2;
            let ahead = |length: f64, heading: f64| P {
                x: from.x + length * heading.cos(),
                y: from.y + length * heading.sin(),
            };
            // Half-way the field is asked again: an arc is followed, not its
            // tangent.
            let middle = ahead(0.5 * step, heading);
            let turned = directions(middle).map_or(heading, |angle| nearest_arm(angle, heading));
            let to = ahead(step, turned);
            if cells.any_within(to, APART * step)
                || outline.nearest(to).1 < CLEAR * step
                || !outline.contains(to)
            {
                continue;
            }
            cells.add(to);
            inside.push(to);
            queue.push_back(to);
        }
    }
}

/// The arm of a cross nearest to a heading.
fn nearest_arm(angle: f64, heading: f64) -> f64 {
    let quarter = std::f64::consts::FRAC_PI_2;
    angle + ((heading - angle) / quarter).round() * quarter
}
