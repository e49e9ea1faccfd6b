//! The line so far: does a new piece of it run alongside an older one?
//!
//! A curve whose tangents span less than 135 degrees advances by at least
//! cos 67.5 degrees = 0.38 of its length along the middle of that span, so it
//! cannot come back near itself. Most streamlines never turn more, and cost
//! nothing here; only when one does are its pieces put into a grid.

use crate::vector::{cross, dot, norm, segments_cross, turn, Point};
use std::collections::HashMap;

/// Span of the tangents, in radians, below which nothing is tested.
const SPAN: f64 = 135.0 / 180.0 * std::f64::consts::PI;
/// Pieces nearer along the line than this many reaches are neighbours, not
/// approaches. Must exceed 1 / 0.38, see above.
const NEIGHBOURS: f64 = 3.0;

#[derive(Clone, Copy, Debug)]
struct Piece {
    from: Point,
    to: Point,
    /// Arc lengths of the two ends from the seed, negative behind it.
    arc: (f64, f64),
}

/// [`turn`], to 2e-13: a chord of a smooth line turns by little, and the angles
/// are only compared with eighths of a turn.
fn small_turn(a: Point, b: Point) -> f64 {
    let (ahead, aside) = (dot(a, b), cross(a, b));
    if aside.abs() > 0.02 * ahead {
        return turn(a, b);
    }
    let t = aside / ahead;
    let square = t * t;
    t * (1.0 - square * (1.0 / 3.0 - square * 0.2))
}

/// All pieces of one line, traced first forwards, then backwards.
#[derive(Debug)]
pub(crate) struct Track {
    reach: f64,
    cell: f64,
    origin: Point,
    pieces: Vec<Piece>,
    /// Cell to the pieces whose box, widened by the reach, meets it. Looked up
    /// by key only, never iterated.
    grid: HashMap<(i64, i64), Vec<u32>>,
    in_grid: usize,
    /// Extreme tangent angles relative to the seed's.
    span: (f64, f64),
}

/// The moving end of one half of the line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Head {
    last: Point,
    direction: Point,
    start: Point,
    /// Tangent angle relative to the seed's, unwrapped.
    pub(crate) angle: f64,
    arc: f64,
    sign: f64,
}

impl Head {
    /// `sign` is 1 forwards, -1 backwards; `direction` is that of travel.
    pub(crate) fn new(seed: Point, direction: Point, sign: f64) -> Self {
        Self {
            last: seed,
            direction,
            start: direction,
            angle: 0.0,
            arc: 0.0,
            sign,
        }
    }

    /// The direction of travel at the seed.
    pub(crate) fn start(&self) -> Point {
        self.start
    }

    /// Moves the head over several chords at once, of which the last one runs
    /// from `from` to `to`: they turn by less than half a turn together.
    pub(crate) fn leap(&mut self, from: Point, to: Point) {
        self.last = from;
        self.look(to);
        self.last = to;
    }

    /// Turns the head to the chord towards `to`, without moving it.
    pub(crate) fn look(&mut self, to: Point) {
        let chord = to - self.last;
        if chord != Point::zero() {
            self.angle += small_turn(self.direction, chord);
            self.direction = chord;
        }
    }
}

impl Track {
    pub(crate) fn new(seed: Point, reach: f64, step: f64) -> Self {
        Self {
            reach,
            cell: step + reach,
            origin: seed,
            pieces: Vec::new(),
            grid: HashMap::new(),
            in_grid: 0,
            span: (0.0, 0.0),
        }
    }

    /// Whether pieces are not compared at all.
    pub(crate) fn is_off(&self) -> bool {
        self.reach == 0.0
    }

    fn cell_of(&self, p: Point) -> (i64, i64) {
        let q = (p - self.origin) / self.cell;
        (q.x.floor() as i64, q.y.floor() as i64)
    }

    fn index(&mut self) {
        for i in self.in_grid..self.pieces.len() {
            let Piece { from, to, .. } = self.pieces[i];
            let reach = Point {
                x: self.reach,
                y: self.reach,
            };
            let low = self.cell_of(
                Point {
                    x: from.x.min(to.x),
                    y: from.y.min(to.y),
                } - reach,
            );
            let high = self.cell_of(
                Point {
                    x: from.x.max(to.x),
                    y: from.y.max(to.y),
                } + reach,
            );
            for x in low.0..=high.0 {
                for y in low.1..=high.1 {
                    self.grid.entry((x, y)).or_default().push(i as u32);
                }
            }
        }
        self.in_grid = self.pieces.len();
    }

    /// Adds the piece from the head to `to`, towards which it looks already,
    /// and moves the head there; true if the new piece runs alongside an older
    /// one.
    pub(crate) fn advance(&mut self, head: &mut Head, to: Point) -> bool {
        let from = std::mem::replace(&mut head.last, to);
        if self.reach == 0.0 {
            return false;
        }
        let arc = (head.arc, head.arc + head.sign * norm(to - from));
        let piece = Piece { from, to, arc };
        head.arc = arc.1;
        self.span = (self.span.0.min(head.angle), self.span.1.max(head.angle));
        let near = if self.span.1 - self.span.0 > SPAN {
            self.index();
            // The widened boxes hold every piece within reach of a point, and
            // a crossing of two chords lies in the cell of one of its points.
            let middle = (piece.from + piece.to) / 2.0;
            [piece.to, middle].iter().any(|&p| {
                self.grid.get(&self.cell_of(p)).is_some_and(|old| {
                    old.iter()
                        .any(|&i| self.alongside(&piece, &self.pieces[i as usize]))
                })
            })
        } else {
            false
        };
        self.pieces.push(piece);
        near
    }

    fn alongside(&self, new: &Piece, old: &Piece) -> bool {
        let gap = (new.arc.0 - old.arc.0)
            .abs()
            .min((new.arc.0 - old.arc.1).abs());
        if gap < NEIGHBOURS * self.reach {
            return false;
        }
        let (e, f) = (new.to - new.from, old.to - old.from);
        let length = norm(f);
        // Under 45 degrees, forwards or backwards.
        if !(length > 0.0 && dot(e, f).abs() > cross(e, f).abs()) {
            return false;
        }
        // Abreast of the old piece: the foot of the perpendicular lies on it,
        // so that a closing loop may come up to its seed from behind.
        let along = dot(new.to - old.from, f) / length;
        let aside = cross(f, new.to - old.from).abs() / length;
        (aside < self.reach && (0.0..=length).contains(&along))
            || segments_cross(new.from, new.to, old.from, old.to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::point;
    use std::f64::consts::TAU;

    /// Follows r = 100 - shrink * angle / tau; the angle at which it stops.
    fn spiral(shrink: f64, reach: f64) -> Option<f64> {
        let at = |a: f64| point(a.cos(), a.sin()) * (100.0 - shrink * a / TAU);
        let mut track = Track::new(at(0.0), reach, 5.0);
        let mut head = Head::new(at(0.0), at(0.001) - at(0.0), 1.0);
        (1..400).map(|i| i as f64 * 0.04).find(|&a| {
            head.look(at(a));
            track.advance(&mut head, at(a))
        })
    }

    #[test]
    fn a_spiral_stops_after_one_turn_if_it_is_tight() {
        let stop = spiral(3.0, 4.5).unwrap();
        assert!((TAU..TAU + 0.1).contains(&stop), "{stop}");
        assert_eq!(spiral(6.0, 4.5), None);
        assert_eq!(spiral(3.0, 0.0), None);
    }

    #[test]
    fn small_turns_are_turns() {
        for i in -400..400 {
            let angle = i as f64 * 1e-3;
            let b = point(angle.cos(), angle.sin()) * 7.0;
            assert!((small_turn(point(3.0, 0.0), b) - angle).abs() < 2e-13);
        }
        assert_eq!(small_turn(point(1.0, 0.0), point(-2.0, 0.0)), TAU / 2.0);
    }

    #[test]
    fn a_square_crossing_is_legitimate_and_a_flat_one_is_not() {
        // Out, round, and back across the first leg at `angle` to it.
        let run = |angle: f64| {
            let way = point(angle.cos(), angle.sin());
            let mut track = Track::new(point(0.0, 0.0), 0.5, 5.0);
            let mut head = Head::new(point(0.0, 0.0), point(1.0, 0.0), 1.0);
            let mut stopped = false;
            let mut go = |from: Point, to: Point| {
                for i in 1..=40 {
                    let to = from + (to - from) * (i as f64 / 40.0);
                    head.look(to);
                    stopped |= track.advance(&mut head, to);
                }
            };
            let (a, b) = (point(150.0, 0.0), point(150.0, -100.0));
            go(point(0.0, 0.0), a);
            go(a, b);
            let c = point(75.0, 0.0) - way * 90.0;
            go(b, c);
            go(c, c + way * 180.0);
            stopped
        };
        assert!(!run(1.2));
        assert!(run(0.6));
    }
}
