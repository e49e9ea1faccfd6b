//! Smoothing a streamline by no more than it may move.

use crate::streamline::Streamline;
use crate::vector::{norm, Point};

impl Streamline {
    /// The same line with its corners eased: in each of the rounds every point
    /// but the ends goes half of the way to the chord of its neighbours, each
    /// of them weighted by the length of the other's piece, yet never farther
    /// than `max_shift` metres from where it was at first.
    ///
    /// The Hausdorff distance between the two lines is at most `max_shift`.
    /// Straight lines stay as they are, however uneven their points; where the
    /// limit does not bind, no piece grows longer. Circles shrink: the limit is
    /// what holds them. A closed line is eased at its seed too. `seed` stays
    /// where it was, which may be off the line by as much.
    ///
    /// That lines of [`EdgeMaps`](crate::EdgeMaps) keep their order is not
    /// promised where they lie nearer than twice `max_shift`. Unchanged if
    /// `max_shift` is not positive.
    ///
    /// # Complexity
    ///
    /// O(rounds) a point.
    ///
    /// # Examples
    ///
    /// ```
    /// use streamline::geo_types::{coord, polygon};
    /// use streamline::{from_fn, trace, TraceOptions};
    ///
    /// // A field with a kink at x = 50.
    /// let land = polygon![(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 100.), (x: 0., y: 100.)];
    /// let bent = from_fn(land, |at, _| Some(coord! { x: 1., y: if at.x < 50. { 0. } else { 0.5 } }));
    /// let line = trace(&bent, coord! { x: 10., y: 20. }, coord! { x: 1., y: 0. }, &TraceOptions::default())?;
    /// let eased = line.smooth(20, 0.5);
    /// assert_eq!(eased.points.first(), line.points.first());
    /// assert!(eased.points.iter().all(|&p| line.distance_to(p) <= 0.5 + 1e-12));
    /// # Ok::<(), streamline::TraceError>(())
    /// ```
    #[must_use]
    pub fn smooth(&self, rounds: usize, max_shift: f64) -> Self {
        let last = self.points.len().saturating_sub(1);
        if max_shift.is_nan() || max_shift <= 0.0 || last < 2 {
            return self.clone();
        }
        let closed = self.is_closed() && last > 2;
        let mut points = self.points.clone();
        let mut next = points.clone();
        for _ in 0..rounds {
            for i in 1..last {
                let eased = eased(points[i - 1], points[i], points[i + 1]);
                next[i] = held(eased, self.points[i], max_shift);
            }
            if closed {
                let eased = eased(points[last - 1], points[0], points[1]);
                next[0] = held(eased, self.points[0], max_shift);
                next[last] = next[0];
            }
            std::mem::swap(&mut points, &mut next);
        }
        Self {
            points,
            ..self.clone()
        }
    }
}

/// Half of the way from `at` to the chord. Moves by half of a = l m / (l + m)
/// times the difference of the unit vectors along the two pieces, l and m long.
/// As a is at most l and m, a piece becomes a sum of its own direction and its
/// neighbours' whose weights add up to its length: it cannot grow.
fn eased(before: Point, at: Point, after: Point) -> Point {
    let (to, from) = (norm(at - before), norm(after - at));
    if to + from > 0.0 {
        at + (before + (after - before) * (to / (to + from)) - at) * 0.5
    } else {
        at
    }
}

/// `p`, or the point at distance `reach` from `home` towards it.
fn held(p: Point, home: Point, reach: f64) -> Point {
    let away = norm(p - home);
    if away > reach {
        home + (p - home) * (reach / away)
    } else {
        p
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Stop;
    use crate::vector::{distance, point, turn};

    fn line(points: Vec<Point>, stop: Stop) -> Streamline {
        Streamline {
            seed: points[0],
            points,
            start: stop,
            end: stop,
            family: 0,
            seed_index: 0,
        }
    }

    fn zigzag() -> Streamline {
        let at = |i: usize| point(3.0 * i as f64 + (i % 3) as f64, ((i * i) % 5) as f64);
        line((0..40).map(at).collect(), Stop::LengthLimit)
    }

    fn total_turn(l: &Streamline) -> f64 {
        let corners = l.points.windows(3);
        corners.map(|p| turn(p[1] - p[0], p[2] - p[1]).abs()).sum()
    }

    #[test]
    fn straight_lines_stay() {
        let at = |x: f64| point(100.0 + 0.6 * x, 50.0 + 0.8 * x);
        let l = line([0.0, 1.0, 9.0, 9.5, 30.0].map(at).to_vec(), Stop::FieldEnd);
        let s = l.smooth(50, 10.0);
        for (&p, &q) in l.points.iter().zip(&s.points) {
            assert!(distance(p, q) < 1e-12);
        }
    }

    #[test]
    fn no_piece_grows_and_corners_ease() {
        let l = zigzag();
        let mut before = l.clone();
        for rounds in 1..30 {
            let after = l.smooth(rounds, 1e9);
            for (p, q) in before.points.windows(2).zip(after.points.windows(2)) {
                assert!(distance(q[0], q[1]) <= distance(p[0], p[1]) + 1e-12);
            }
            before = after;
        }
        assert!(total_turn(&before) < 0.2 * total_turn(&l));
        assert_eq!(
            (before.points[0], before.points[39]),
            (l.points[0], l.points[39])
        );
    }

    #[test]
    fn nothing_moves_farther_than_allowed() {
        let l = zigzag();
        let s = l.smooth(100, 0.3);
        assert_ne!(s, l);
        for (&p, &q) in l.points.iter().zip(&s.points) {
            assert!(distance(p, q) <= 0.3 + 1e-12);
        }
        assert_eq!(l.smooth(5, 0.0), l);
        assert_eq!(l.smooth(5, f64::NAN), l);
        assert_eq!(l.smooth(0, 1.0), l);
    }

    #[test]
    fn closed_lines_are_eased_at_the_seed() {
        let square = [
            (0., 0.),
            (5., 0.),
            (10., 0.),
            (10., 10.),
            (0., 10.),
            (0., 0.),
        ];
        let l = line(square.map(|p| point(p.0, p.1)).to_vec(), Stop::ClosedLoop);
        let s = l.smooth(1, 2.0);
        assert_eq!(s.points[0], s.points[5]);
        assert!(s.points[0].x > 0.0 && s.points[0].y > 0.0);
    }
}
