//! One half of a streamline: from the seed one way until something stops it.

use super::adaptive::{attempt, Attempt, Step};
use super::track::{Head, Track};
use super::{Stop, TraceOptions};
use crate::field::{Cursor, DirectionField, Exit};
use crate::vector::{dot, left, norm, turn, Point};
use std::f64::consts::TAU;

/// Greatest turn between two points of the line, in radians (10 degrees).
const CHORD_TURN: f64 = 0.175;

/// What all halves of a line share.
pub(crate) struct March<'a, F: ?Sized> {
    pub(crate) field: &'a F,
    pub(crate) options: &'a TraceOptions,
    pub(crate) seed: Point,
}

/// The points after the seed, and why there are no more.
#[derive(Debug)]
pub(crate) struct Half {
    pub(crate) points: Vec<Point>,
    pub(crate) stop: Stop,
}

/// What is told of each stretch of the line as it is laid.
pub(crate) trait Keep {
    /// A step, as far as this fraction of it.
    fn step(&mut self, step: &Step, upto: f64);
    /// A straight stretch: the last one before the boundary, or the step
    /// aside that closes a line.
    fn straight(&mut self, from: Point, to: Point);
}

/// For those who want points only.
impl Keep for () {
    fn step(&mut self, _: &Step, _: f64) {}
    fn straight(&mut self, _: Point, _: Point) {}
}

/// Where the march stands.
struct State {
    at: Point,
    along: Point,
    /// Step to try next.
    length: f64,
    /// Curvature seen in the last step; unknown before the first.
    bend: f64,
    gone: f64,
    /// For the stages, which run ahead of the line.
    stage_cursor: Cursor,
    /// For the chords, which follow it.
    chord_cursor: Cursor,
}

impl<F: DirectionField + ?Sized> March<'_, F> {
    /// Marches from the seed along the unit vector `along`; `sign` is 1
    /// forwards, -1 backwards. A watchman is shown each new point after the one
    /// before it; where it names a reason, the half ends at the latter.
    ///
    /// Ends: an iteration either advances by its step or shrinks the next one,
    /// down to the least step, below which the march stops; and the length is
    /// bounded.
    pub(crate) fn run<W, K>(
        &self,
        along: Point,
        sign: f64,
        track: &mut Track,
        watch: &mut W,
        keep: &mut K,
    ) -> Half
    where
        W: FnMut(Point, Point) -> Option<Stop>,
        K: Keep,
    {
        let options = self.options;
        let (min_step, min_cosine) = (options.min_step(), options.max_turn_deg.to_radians().cos());
        let mut head = Head::new(self.seed, along, sign);
        let mut points = Vec::new();
        let mut chord = Vec::new();
        let mut state = State {
            at: self.seed,
            along,
            length: options.step.min(options.max_step),
            bend: f64::INFINITY,
            gone: 0.0,
            stage_cursor: Cursor::default(),
            chord_cursor: Cursor::default(),
        };
        let stop = loop {
            let left_over = options.max_length - state.gone;
            if left_over <= 1e-9 * options.max_length {
                break Stop::LengthLimit;
            }
            let length = state.length.min(options.max_step).min(left_over);
            let step = match attempt(
                self.field,
                state.at,
                state.along,
                length,
                min_cosine,
                &mut state.stage_cursor,
            ) {
                Attempt::Done(step) if step.error <= options.tolerance => step,
                Attempt::Done(step) => {
                    state.length = step.next_length(options.tolerance).min(0.9 * length);
                    if state.length < min_step {
                        break Stop::Singularity;
                    }
                    continue;
                }
                Attempt::Turned => {
                    state.length = 0.5 * length;
                    if state.length < min_step {
                        break Stop::Singularity;
                    }
                    continue;
                }
                Attempt::Blocked(there) => {
                    match self.field.exit(state.at, there, &mut state.chord_cursor) {
                        Some(exit) => {
                            let ahead = norm(exit.point - state.at);
                            if let Some(stop) =
                                self.approach(&mut state, length, ahead, exit, &mut points, keep)
                            {
                                break stop;
                            }
                        }
                        None => {
                            state.length = 0.4 * length;
                            if state.length < min_step {
                                break self.missing(&mut state, min_step);
                            }
                        }
                    }
                    continue;
                }
            };
            let bend = turn(state.along, step.direction()).abs();
            if let Some((ahead, exit)) = self.lay(&step, bend, &mut state.chord_cursor, &mut chord)
            {
                if let Some(stop) =
                    self.approach(&mut state, length, ahead, exit, &mut points, keep)
                {
                    break stop;
                }
                continue;
            }
            let count = chord.len() as f64;
            // Far from the seed, and with no eye on itself, the line need not
            // look about at every point.
            let clear = 1.1 * length + 2.0 * options.step;
            let aloof = track.is_off() && norm(step.from - self.seed) > clear;
            let mut stopped = None;
            for (i, &to) in chord.iter().enumerate() {
                let part = (i as f64 / count, (i + 1) as f64 / count);
                if !aloof {
                    head.look(to);
                    if let Some(t) = self.passes_seed(&step, &head, to, part) {
                        points.push(self.seed);
                        keep.step(&step, t);
                        keep.straight(step.at(t), self.seed);
                        stopped = Some(Stop::ClosedLoop);
                        break;
                    }
                }
                stopped = watch(points.last().copied().unwrap_or(self.seed), to);
                if stopped.is_some() {
                    keep.step(&step, part.0);
                    break;
                }
                points.push(to);
                if !aloof && track.advance(&mut head, to) {
                    keep.step(&step, part.1);
                    stopped = Some(Stop::SelfApproach);
                    break;
                }
            }
            if let Some(stop) = stopped {
                break stop;
            }
            keep.step(&step, 1.0);
            if aloof {
                head.leap(
                    chord.iter().rev().nth(1).copied().unwrap_or(step.from),
                    step.to,
                );
            }
            state.at = step.to;
            state.along = step.direction();
            state.gone += length;
            state.bend = bend / length;
            state.length = step.next_length(options.tolerance);
        };
        Half { points, stop }
    }

    /// Points of the step into `chord`; or the first exit of their polyline
    /// with its distance along it.
    fn lay(
        &self,
        step: &Step,
        bend: f64,
        cursor: &mut Cursor,
        chord: &mut Vec<Point>,
    ) -> Option<(f64, Exit)> {
        chord.clear();
        let count = (step.length / self.options.step - 1e-9)
            .ceil()
            .max((bend / CHORD_TURN).ceil())
            .max(1.0);
        let mut last = step.from;
        for i in 1..=count as usize {
            let to = if i as f64 == count {
                step.to
            } else {
                step.at(i as f64 / count)
            };
            if let Some(exit) = self.field.exit(last, to, cursor) {
                return Some((
                    step.length * (i - 1) as f64 / count + norm(exit.point - last),
                    exit,
                ));
            }
            chord.push(to);
            last = to;
        }
        None
    }

    /// The boundary is about `ahead` away. Shortens the next step to end just
    /// before it; or, when the rest is so short that the curve cannot leave its
    /// tangent by half the tolerance, runs straight on to it and stops.
    fn approach<K: Keep>(
        &self,
        state: &mut State,
        tried: f64,
        ahead: f64,
        exit: Exit,
        points: &mut Vec<Point>,
        keep: &mut K,
    ) -> Option<Stop> {
        let options = self.options;
        let min_step = options.min_step();
        let shorter = (0.98 * ahead).min(0.7 * tried);
        let straight =
            0.5 * state.bend * ahead * ahead <= 0.5 * options.tolerance && ahead <= options.step;
        if !straight && shorter >= min_step {
            state.length = shorter;
            return None;
        }
        let target = state.at + state.along * (2.0 * ahead + 10.0 * min_step);
        let exit = self
            .field
            .exit(state.at, target, &mut state.chord_cursor)
            .unwrap_or(exit);
        keep.straight(state.at, exit.point);
        self.finish(exit.point, points);
        Some(Stop::Boundary {
            ring: exit.ring,
            edge: exit.edge,
        })
    }

    /// Ends the line at a boundary point. The short steps taken on the way
    /// there are dropped again as far as the spacing of points allows.
    fn finish(&self, end: Point, points: &mut Vec<Point>) {
        let span = |a: Point| norm(end - a);
        while let Some(&last) = points.last() {
            let before = if points.len() > 1 {
                points[points.len() - 2]
            } else {
                self.seed
            };
            let negligible = span(last) <= 1e-9 * self.options.step;
            let bent = turn(last - before, end - last).abs() > CHORD_TURN;
            if !negligible && (bent || span(before) > self.options.step) {
                break;
            }
            points.pop();
        }
        if points.last().is_some() || span(self.seed) > 1e-9 * self.options.step {
            points.push(end);
        }
    }

    /// No direction ahead, yet inside the domain: an isolated hole in the
    /// field, or its end?
    fn missing(&self, state: &mut State, min_step: f64) -> Stop {
        let beyond = [4.0, 16.0, 64.0].iter().any(|reach| {
            let there = state.at + state.along * (reach * min_step);
            self.field
                .direction(there, state.along, &mut state.stage_cursor)
                .is_some()
        });
        if beyond {
            Stop::Singularity
        } else {
            Stop::FieldEnd
        }
    }

    /// The fraction of the step at which the line passes the seed, in its first
    /// direction, if it does between the two given ones, on the piece that ends
    /// at `to`, where the head looks.
    fn passes_seed(&self, step: &Step, head: &Head, to: Point, part: (f64, f64)) -> Option<f64> {
        let first = head.start();
        // A smooth loop without crossing turns by a full turn.
        if (head.angle.abs() - TAU).abs() > TAU / 8.0
            || norm(to - self.seed) > 2.0 * self.options.step
        {
            return None;
        }
        let along = |t: f64| dot(step.at(t) - self.seed, first);
        let (mut low, mut high) = part;
        if !(along(low) < 0.0 && along(high) >= 0.0) {
            return None;
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if along(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let aside = dot(step.at(high) - self.seed, left(first)).abs();
        (aside <= self.options.loop_tolerance).then_some(high)
    }
}
