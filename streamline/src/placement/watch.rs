//! What keeps a line that is being traced apart from the others and itself.

use super::chords::Chords;
use super::near::{Chord, Own, Vicinity};
use super::spacing::Spacing;
use crate::streamline::Streamline;
use crate::trace::Stop;
use crate::vector::{cross, dot, norm, Point};

/// Length of a chord in separations, at most.
const CHORD: f64 = 0.4;
/// How far beyond d_test a look reaches, in separations: nothing can come
/// nearer until the line has gone as far.
const LOOK: f64 = 0.25;
/// Chords are gathered for looks from this far around, in separations; or from
/// d_test, if that is less: along so straight a stretch of the line its own new
/// chords are nearer than [`OWN_GAP`], and need not be among them.
const STRETCH: f64 = 0.5;
/// They serve while the separation changes by less than this factor on the way.
const SPARE: f64 = 1.05;
/// Cosine of 10 degrees: a line that has turned by more looks again.
const TURNED: f64 = 0.985;
/// Own chords nearer along the line than this many times d_test are
/// neighbours: more than half a circle of that radius.
const OWN_GAP: f64 = 3.0;
/// Height of a curved stretch over its chord, in separations, at most.
const SAGITTA: f64 = 0.002;

pub(super) struct Watch<'a> {
    chords: &'a mut Chords,
    spacing: &'a Spacing<'a>,
    test: f64,
    line: u32,
    family: u8,
    /// Of the half under way: 1 forwards, -1 backwards.
    sign: f64,
    arc: f64,
    /// Where the chord under way began, at which arc length and which way.
    from: Point,
    from_arc: f64,
    from_way: Point,
    /// The same for the forward half, once it is done.
    forward: Option<(Point, f64)>,
    /// What the last look saw: no line nearer than this.
    free: f64,
    moved: f64,
    looked: Point,
    /// The chords near the last looks, for looks that reach as far as `reach`.
    vicinity: Vicinity,
    reach: f64,
}

impl<'a> Watch<'a> {
    pub(super) fn new(
        chords: &'a mut Chords,
        spacing: &'a Spacing<'a>,
        test: f64,
        (line, family): (u32, u8),
        seed: Point,
    ) -> Self {
        Self {
            chords,
            spacing,
            test,
            line,
            family,
            sign: 1.0,
            arc: 0.0,
            from: seed,
            from_arc: 0.0,
            from_way: Point::zero(),
            forward: None,
            free: 0.0,
            moved: 0.0,
            looked: Point::zero(),
            vicinity: Vicinity::default(),
            reach: 0.0,
        }
    }

    /// The line goes on from `a` to `b`: may it?
    pub(super) fn step(&mut self, sign: f64, a: Point, b: Point) -> Option<Stop> {
        self.turn_to(sign, a);
        let length = norm(b - a);
        if length == 0.0 {
            return None;
        }
        let way = (b - a) / length;
        let separation = self.spacing.at(b, self.family);
        let test = self.test * separation;
        self.moved += length;
        if self.moved >= self.free - test || dot(way, self.looked) < TURNED {
            if let Some(stop) = self.look(b, way, self.arc + length, test, separation) {
                return Some(stop);
            }
        }
        self.lay(a, length, way, separation);
        self.arc += length;
        None
    }

    /// Where the backward half begins, at the seed.
    fn turn_to(&mut self, sign: f64, seed: Point) {
        if sign != self.sign {
            self.forward = Some((self.from, self.from_arc));
            self.sign = sign;
            (self.arc, self.from, self.from_arc) = (0.0, seed, 0.0);
            (self.free, self.moved, self.reach) = (0.0, 0.0, 0.0);
            self.from_way = Point::zero();
        }
    }

    fn look(&mut self, b: Point, way: Point, arc: f64, test: f64, wide: f64) -> Option<Stop> {
        let own = Own {
            line: self.line,
            arc: self.sign * arc,
            gap: OWN_GAP * test,
        };
        let reach = test + LOOK * wide;
        (self.free, self.moved, self.looked) = (reach, 0.0, way);
        let same = reach <= self.reach && reach * (SPARE * SPARE) >= self.reach;
        if !same || !self.vicinity.serves(b, way) {
            self.reach = SPARE * reach;
            let radius = test.min(STRETCH * wide);
            let least = Own {
                gap: own.gap / SPARE,
                ..own
            };
            self.chords
                .gather(b, way, least, (self.reach, radius), &mut self.vicinity);
        }
        let near = self.vicinity.nearest(b, way, reach, own, true)?;
        self.free = near.distance;
        if near.distance >= test {
            return None;
        }
        // It may be one that turns too much to count, and hide one that does.
        let near = self.vicinity.nearest(b, way, test, own, false)?;
        Some(if near.own {
            Stop::SelfApproach
        } else {
            Stop::Neighbour
        })
    }

    /// Ends the chord under way at `a` if the next piece would make it too long
    /// or too curved.
    fn lay(&mut self, a: Point, length: f64, way: Point, separation: f64) {
        let stretch = self.arc - self.from_arc;
        let bend = cross(self.from_way, way).abs();
        let long = stretch + length;
        if stretch > 0.0 && (long > CHORD * separation || bend * long > 8.0 * SAGITTA * separation)
        {
            self.push(self.from, a, self.from_arc, self.arc, self.sign);
            (self.from, self.from_arc, self.from_way) = (a, self.arc, way);
        } else if stretch == 0.0 {
            self.from_way = way;
        }
    }

    fn push(&mut self, a: Point, b: Point, from: f64, to: f64, sign: f64) {
        let arc = sign * 0.5 * (from + to);
        if let Some(chord) = Chord::new(a, b, self.line, self.family, arc) {
            self.chords.push(chord);
        }
    }

    /// Lays the chords of a whole line, of which no step was watched.
    pub(super) fn relay(mut self, line: &Streamline) {
        let seed = line.points.iter().position(|&p| p == line.seed);
        let (behind, ahead) = line.points.split_at(seed.unwrap_or(0));
        for (sign, half) in [(1.0, ahead), (-1.0, behind)] {
            let mut last = line.seed;
            let mut lay = |to: Point| {
                self.turn_to(sign, last);
                let length = norm(to - last);
                if length > 0.0 {
                    let separation = self.spacing.at(to, self.family);
                    self.lay(last, length, (to - last) / length, separation);
                    self.arc += length;
                }
                last = to;
            };
            if sign > 0.0 {
                half.iter().for_each(|&p| lay(p));
            } else {
                half.iter().rev().for_each(|&p| lay(p));
            }
        }
        self.finish(line);
    }

    /// Lays the last chords, out to the ends of the finished line.
    pub(super) fn finish(mut self, line: &Streamline) {
        let (Some(&first), Some(&last)) = (line.points.first(), line.points.last()) else {
            return;
        };
        let under_way = (self.from, self.from_arc);
        let (forward, backward) = match self.forward {
            Some(forward) => (forward, under_way),
            // Not one point was laid backwards, but a last one may have been.
            None => (under_way, (line.seed, 0.0)),
        };
        let (from, arc) = forward;
        self.push(from, last, arc, arc + norm(last - from), 1.0);
        if !line.is_closed() {
            let (from, arc) = backward;
            self.push(from, first, arc, arc + norm(first - from), -1.0);
        }
    }
}
