//! Dense output: the curve itself, not its points.

use super::adaptive::Step;
use super::march::Keep;
use super::quartic::Quartic;
use crate::streamline::{Streamline, MOST};
use crate::vector::{cross, dot, left, norm, unit, Point};
use geo_types::Coord;

/// A streamline with its dense output, made by [`trace_dense`](crate::trace_dense):
/// the continuous extension of the Runge-Kutta method, a polynomial of degree
/// four for each step.
///
/// It is parametrised by the length s that the integration has gone, from the
/// start of the line; its speed is 1 to within the tolerance. Positions are
/// continuous, and so are tangents from step to step (the extension has them
/// from the field); before a boundary the last centimetres may be straight, as
/// those of the line are.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Curve {
    /// The line as [`trace`](crate::trace) gives it: its points lie on the
    /// curve.
    pub line: Streamline,
    pieces: Vec<Piece>,
    /// Where the seed lies, metres from the start.
    seed_at: f64,
}

/// A piece of the curve from `from` on, metres from the start.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Piece {
    from: f64,
    length: f64,
    shape: Quartic,
}

/// The pieces of one half, in the order of tracing, with their lengths.
#[derive(Debug, Default)]
pub(super) struct Pieces(Vec<(f64, Quartic)>);

impl Keep for Pieces {
    fn step(&mut self, step: &Step, upto: f64) {
        if upto > 0.0 {
            let shape = if upto < 1.0 {
                step.shape().split(upto).0
            } else {
                step.shape()
            };
            self.0.push((upto * step.length, shape));
        }
    }

    fn straight(&mut self, from: Point, to: Point) {
        let length = norm(to - from);
        if length > 0.0 {
            self.0.push((length, Quartic::straight(from, to)));
        }
    }
}

impl Curve {
    pub(super) fn new(line: Streamline, forward: Pieces, backward: Pieces) -> Self {
        let back = backward.0.into_iter().rev();
        let mut pieces = Vec::new();
        let mut from = 0.0;
        for (length, shape) in back.map(|(length, shape)| (length, shape.reversed())) {
            pieces.push(Piece {
                from,
                length,
                shape,
            });
            from += length;
        }
        let seed_at = from;
        for (length, shape) in forward.0 {
            pieces.push(Piece {
                from,
                length,
                shape,
            });
            from += length;
        }
        Self {
            line,
            pieces,
            seed_at,
        }
    }

    /// Length, metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.pieces.last().map_or(0.0, |p| p.from + p.length)
    }

    /// Where the seed lies, metres from the start; 0 on a closed line.
    #[must_use]
    pub fn seed_at(&self) -> f64 {
        self.seed_at
    }

    /// The piece that holds `s`, and the parameter in it.
    fn locate(&self, s: f64) -> Option<(&Piece, f64)> {
        let s = s.max(0.0);
        let after = self.pieces.partition_point(|p| p.from <= s);
        let piece = self.pieces.get(after.saturating_sub(1))?;
        Some((piece, ((s - piece.from) / piece.length).clamp(0.0, 1.0)))
    }

    /// The point `s` metres from the start, clamped to the ends; the seed if
    /// the line has no length.
    ///
    /// # Complexity
    ///
    /// O(log n) in the number of steps.
    #[must_use]
    pub fn point_at(&self, s: f64) -> Coord<f64> {
        self.locate(s)
            .map_or(self.line.seed, |(piece, t)| piece.shape.at(t))
    }

    /// The unit tangent `s` metres from the start, towards the end. Zero on a
    /// line without length.
    #[must_use]
    pub fn tangent_at(&self, s: f64) -> Coord<f64> {
        self.locate(s)
            .and_then(|(piece, t)| unit(piece.shape.velocity(t)))
            .unwrap_or(Coord::zero())
    }

    /// The curvature `s` metres from the start, 1 / metre, positive to the
    /// left. Of order three in the step, and not continuous from step to step.
    #[must_use]
    pub fn curvature_at(&self, s: f64) -> f64 {
        let Some((piece, t)) = self.locate(s) else {
            return 0.0;
        };
        let velocity = piece.shape.velocity(t);
        let speed = norm(velocity);
        if speed > 0.0 {
            cross(velocity, piece.shape.acceleration(t)) / speed.powi(3)
        } else {
            0.0
        }
    }

    /// Where the curve crosses the segment from `from` to `to`, metres from
    /// its start, ascending, each to rounding. A touch counts twice or not at
    /// all, and so does a stretch along the segment.
    ///
    /// # Complexity
    ///
    /// O(n) in the number of steps, and some hundred halvings a crossing.
    ///
    /// # Examples
    ///
    /// ```
    /// use streamline::geo_types::{coord, polygon};
    /// use streamline::{arm_nearest, from_fn, trace_dense, TraceOptions};
    ///
    /// let land = polygon![(x: 0., y: 0.), (x: 99., y: 0.), (x: 99., y: 99.), (x: 0., y: 99.)];
    /// let polar = from_fn(land, |at, heading| Some(arm_nearest(at.y.atan2(at.x), heading)));
    /// let (seed, north) = (coord! { x: 50., y: 0.1 }, coord! { x: 0., y: 1. });
    /// let arc = trace_dense(&polar, seed, north, &TraceOptions::default())?;
    /// // The arc of radius 50 meets the diagonal after an eighth of its circle.
    /// let at = arc.crossings(coord! { x: 0., y: 0. }, coord! { x: 99., y: 99. });
    /// assert_eq!(at.len(), 1);
    /// assert!((at[0] - 50.0 * std::f64::consts::FRAC_PI_4).abs() < 0.01);
    /// assert!((arc.curvature_at(at[0]) - 1.0 / 50.0).abs() < 1e-4);
    /// # Ok::<(), streamline::TraceError>(())
    /// ```
    #[must_use]
    pub fn crossings(&self, from: Coord<f64>, to: Coord<f64>) -> Vec<f64> {
        let way = to - from;
        let normal = left(way);
        let mut found = Vec::new();
        for piece in &self.pieces {
            for t in piece.shape.crossings(normal, dot(normal, from)) {
                let along = dot(piece.shape.at(t) - from, way);
                if (0.0..=dot(way, way)).contains(&along) {
                    found.push(piece.from + t * piece.length);
                }
            }
        }
        found
    }

    /// The line with equally spaced points on the curve, at most `step` metres
    /// apart along it: more than [`Streamline::resample`] can do, whose points
    /// lie on the chords. Ten million points at most; [`line`](Self::line)
    /// itself if `step` is not positive.
    #[must_use]
    pub fn resample(&self, step: f64) -> Streamline {
        let length = self.length();
        if !(step > 0.0 && length > 0.0 && length.is_finite()) {
            return self.line.clone();
        }
        let count = (length / step).ceil().clamp(1.0, MOST) as usize;
        let mut points = Vec::with_capacity(count + 1);
        points.extend(self.line.points.first());
        points.extend((1..count).map(|k| self.point_at(length * k as f64 / count as f64)));
        points.extend(self.line.points.last());
        Streamline {
            points,
            ..self.line.clone()
        }
    }
}
