//! One step of the Dormand-Prince pair 5(4) with its continuous extension.
//!
//! J. R. Dormand, P. J. Prince, *A family of embedded Runge-Kutta formulae*,
//! J. Comput. Appl. Math. 6 (1980) 19-26; the continuous extension of order 4
//! is that of E. Hairer, S. P. Norsett, G. Wanner, *Solving Ordinary
//! Differential Equations I*, section II.6. The last stage is the first of the
//! next step, so that an accepted step costs six evaluations.
//!
//! The integrand is the arm of the cross nearest to the direction at the
//! step's start, at every stage: within one step the arm is never mixed up as
//! long as the field turns by less than 45 degrees, which
//! [`TraceOptions::max_turn_deg`](super::TraceOptions) enforces.

use super::quartic::Quartic;
use crate::field::{Cursor, DirectionField};
use crate::vector::{dot, norm, Point};

/// Row `i` holds the weights of the earlier stages in stage `i + 1`; the last
/// row is also the solution of order 5.
const STAGES: [[f64; 6]; 6] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
        0.0,
        0.0,
    ],
    [
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
        0.0,
    ],
    [
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];

/// Order 5 minus order 4.
const ERROR: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Weights of the highest term of the continuous extension.
const DENSE: [f64; 7] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

/// What became of a step.
#[derive(Debug)]
pub(crate) enum Attempt {
    Done(Step),
    /// A stage turned by more than the limit.
    Turned,
    /// There is no direction at this point of a stage.
    Blocked(Point),
}

/// A completed step; whether its error is acceptable is for the caller.
#[derive(Debug)]
pub(crate) struct Step {
    pub(crate) from: Point,
    pub(crate) to: Point,
    pub(crate) length: f64,
    pub(crate) error: f64,
    stage: [Point; 7],
}

/// The sum of the first `N` stages, weighted. Its length is known when the code
/// is made, so that no loop is left.
#[inline(always)]
fn combine<const N: usize>(weights: &[f64], stage: &[Point; 7]) -> Point {
    let mut sum = Point::zero();
    for i in 0..N {
        sum = sum + stage[i] * weights[i];
    }
    sum
}

/// One step of the given length from `from`, where the unit direction is
/// `along`.
pub(crate) fn attempt<F: DirectionField + ?Sized>(
    field: &F,
    from: Point,
    along: Point,
    length: f64,
    min_cosine: f64,
    cursor: &mut Cursor,
) -> Attempt {
    let mut stage = [along; 7];
    let mut to;
    macro_rules! stage {
        ($n:literal) => {
            to = from + combine::<$n>(&STAGES[$n - 1], &stage) * length;
            let Some(direction) = field.direction(to, along, cursor) else {
                return Attempt::Blocked(to);
            };
            let cosine = dot(direction, along);
            if cosine.is_nan() || cosine < min_cosine {
                return Attempt::Turned;
            }
            stage[$n] = direction;
        };
    }
    stage!(1);
    stage!(2);
    stage!(3);
    stage!(4);
    stage!(5);
    stage!(6);
    let error = length * norm(combine::<7>(&ERROR, &stage));
    Attempt::Done(Step {
        from,
        to,
        length,
        error,
        stage,
    })
}

impl Step {
    /// The direction at the end.
    pub(crate) fn direction(&self) -> Point {
        self.stage[6]
    }

    /// The point at fraction `t` of the step: order 4, continuous with its
    /// derivative from step to step.
    pub(crate) fn at(&self, t: f64) -> Point {
        let [chord, first, last, top] = self.extension();
        let s = 1.0 - t;
        self.from + (chord + (first + (last + top * s) * t) * s) * t
    }

    /// What [`at`](Self::at) is made of.
    fn extension(&self) -> [Point; 4] {
        let chord = self.to - self.from;
        let first = self.stage[0] * self.length - chord;
        let last = chord - self.stage[6] * self.length - first;
        let top = combine::<7>(&DENSE, &self.stage) * self.length;
        [chord, first, last, top]
    }

    /// The continuous extension as a Bezier curve.
    ///
    /// With t the fraction and s = 1 - t, [`at`](Self::at) is from + t chord +
    /// t s first + t^2 s last + t^2 s^2 top: in Bernstein polynomials of degree
    /// four t has the coefficients 0, 1/4, 1/2, 3/4, 1, t s has 0, 1/4, 1/3,
    /// 1/4, 0, t^2 s has 0, 0, 1/6, 1/4, 0 and t^2 s^2 has 0, 0, 1/6, 0, 0.
    pub(crate) fn shape(&self) -> Quartic {
        let [chord, first, last, top] = self.extension();
        Quartic::new([
            self.from,
            self.from + (chord + first) * 0.25,
            self.from + chord * 0.5 + first * (1.0 / 3.0) + (last + top) * (1.0 / 6.0),
            self.from + chord * 0.75 + (first + last) * 0.25,
            self.to,
        ])
    }

    /// The length to try next, for errors of `tolerance`: the error of a step
    /// falls with its fifth power.
    pub(crate) fn next_length(&self, tolerance: f64) -> f64 {
        let ratio = tolerance / self.error.max(1e-10 * tolerance);
        self.length * (0.9 * ratio.powf(0.2)).clamp(0.2, 4.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Exit;
    use crate::vector::{distance, left, point, unit};

    /// Circles about the origin.
    struct Turning;
    impl DirectionField for Turning {
        fn direction(&self, at: Point, _: Point, _: &mut Cursor) -> Option<Point> {
            unit(left(at))
        }
        fn exit(&self, _: Point, _: Point, _: &mut Cursor) -> Option<Exit> {
            None
        }
    }

    fn step(length: f64) -> Step {
        match attempt(
            &Turning,
            point(1.0, 0.0),
            point(0.0, 1.0),
            length,
            0.5,
            &mut Cursor::default(),
        ) {
            Attempt::Done(step) => step,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn tableau_is_consistent() {
        // Rows sum to the nodes of the method, error weights to nothing.
        let nodes = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
        for (row, node) in STAGES.iter().zip(nodes) {
            assert!((row.iter().sum::<f64>() - node).abs() < 1e-13);
        }
        assert!(ERROR.iter().sum::<f64>().abs() < 1e-15);
        assert!(DENSE.iter().sum::<f64>().abs() < 1e-12);
    }

    #[test]
    fn local_error_has_order_six_at_least_and_its_estimate_five() {
        let exact = |h: f64| point(h.cos(), h.sin());
        let error = |h: f64| distance(step(h).to, exact(h));
        let order = (error(0.4) / error(0.2)).log2();
        assert!((5.6..7.5).contains(&order), "{order}");
        let order = (step(0.4).error / step(0.2).error).log2();
        assert!((4.6..6.5).contains(&order), "{order}");
        assert!(
            step(0.4).error > error(0.4),
            "the estimate is on the safe side"
        );
    }

    #[test]
    fn continuous_extension_meets_the_ends_and_the_curve() {
        let s = step(0.4);
        assert_eq!(s.at(0.0), s.from);
        assert!(distance(s.at(1.0), s.to) < 1e-15);
        for i in 1..8 {
            let t = i as f64 / 8.0;
            assert!(distance(s.at(t), point((0.4 * t).cos(), (0.4 * t).sin())) < 2e-6);
            assert!(distance(s.at(t), s.shape().at(t)) < 1e-15);
        }
    }
}
