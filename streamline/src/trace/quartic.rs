//! Pieces of a curve as Bezier curves of degree four: what one Runge-Kutta step
//! leaves behind.

use crate::vector::{dot, Point};

/// A polynomial curve over the parameters 0 to 1, by its control points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Quartic {
    control: [Point; 5],
}

/// Halvings of a piece until a crossing is known to rounding.
const HALVINGS: u32 = 50;

impl Quartic {
    pub(crate) fn new(control: [Point; 5]) -> Self {
        Self { control }
    }

    /// The segment between two points, at constant speed.
    pub(crate) fn straight(from: Point, to: Point) -> Self {
        let way = to - from;
        Self::new([
            from,
            from + way * 0.25,
            from + way * 0.5,
            from + way * 0.75,
            to,
        ])
    }

    /// The parts before and after `t` (de Casteljau).
    pub(crate) fn split(&self, t: f64) -> (Self, Self) {
        let mut row = self.control;
        let (mut before, mut after) = (row, row);
        for level in 1..5 {
            for i in 0..5 - level {
                row[i] = row[i] * (1.0 - t) + row[i + 1] * t;
            }
            before[level] = row[0];
            after[4 - level] = row[4 - level];
        }
        (Self::new(before), Self::new(after))
    }

    /// The same curve from its end to its start.
    pub(crate) fn reversed(mut self) -> Self {
        self.control.reverse();
        self
    }

    pub(crate) fn at(&self, t: f64) -> Point {
        bernstein(&self.control, t)
    }

    /// First derivative by the parameter.
    pub(crate) fn velocity(&self, t: f64) -> Point {
        let c = &self.control;
        let rise: [Point; 4] = std::array::from_fn(|i| (c[i + 1] - c[i]) * 4.0);
        bernstein(&rise, t)
    }

    /// Second derivative by the parameter.
    pub(crate) fn acceleration(&self, t: f64) -> Point {
        let c = &self.control;
        let bend: [Point; 3] = std::array::from_fn(|i| (c[i + 2] - c[i + 1] * 2.0 + c[i]) * 12.0);
        bernstein(&bend, t)
    }

    /// Parameters, ascending, at which the curve passes from one side of the
    /// line `dot(normal, p) = offset` to the other; where it stays on the line
    /// there are none.
    ///
    /// Control values of one sign mean that there is no crossing
    /// (the curve lies in their convex hull), so halving finds all.
    pub(crate) fn crossings(&self, normal: Point, offset: f64) -> Vec<f64> {
        let values = self.control.map(|p| dot(normal, p) - offset);
        let mut found = Vec::new();
        isolate(values, (0.0, 1.0), HALVINGS, &mut found);
        found
    }
}

/// Roots of a polynomial in Bernstein form at which its sign changes.
fn isolate(values: [f64; 5], (from, to): (f64, f64), depth: u32, found: &mut Vec<f64>) {
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| {
            (l.min(v), h.max(v))
        });
    // A zero counts as positive, so that a root shared by two halves is found
    // in one of them.
    if low >= 0.0 || high < 0.0 {
        return;
    }
    let middle = 0.5 * (from + to);
    if depth == 0 {
        if (values[0] < 0.0) != (values[4] < 0.0) {
            found.push(middle);
        }
        return;
    }
    let mut row = values;
    let (mut before, mut after) = (row, row);
    for level in 1..5 {
        for i in 0..5 - level {
            row[i] = 0.5 * (row[i] + row[i + 1]);
        }
        before[level] = row[0];
        after[4 - level] = row[4 - level];
    }
    isolate(before, (from, middle), depth - 1, found);
    isolate(after, (middle, to), depth - 1, found);
}

/// Value of the Bezier curve of these control points.
fn bernstein<const N: usize>(control: &[Point; N], t: f64) -> Point {
    let mut row = *control;
    for level in 1..N {
        for i in 0..N - level {
            row[i] = row[i] * (1.0 - t) + row[i + 1] * t;
        }
    }
    row[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{distance, point};

    fn wave() -> Quartic {
        Quartic::new([
            point(0., 0.),
            point(1., 6.),
            point(2., -9.),
            point(3., 6.),
            point(4., 0.),
        ])
    }

    #[test]
    fn parts_and_reverses_are_the_same_curve() {
        let (a, b) = wave().split(0.3);
        for k in 0..=10 {
            let t = f64::from(k) / 10.0;
            assert!(distance(a.at(t), wave().at(0.3 * t)) < 1e-14);
            assert!(distance(b.at(t), wave().at(0.3 + 0.7 * t)) < 1e-14);
            assert!(distance(wave().reversed().at(t), wave().at(1.0 - t)) < 1e-14);
        }
        assert_eq!(a.control[4], b.control[0]);
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let h = 1e-5;
        for k in 1..10 {
            let t = f64::from(k) / 10.0;
            let slope = (wave().at(t + h) - wave().at(t - h)) * (0.5 / h);
            assert!(distance(slope, wave().velocity(t)) < 1e-7);
            let slope = (wave().velocity(t + h) - wave().velocity(t - h)) * (0.5 / h);
            assert!(distance(slope, wave().acceleration(t)) < 1e-6);
        }
    }

    /// With s = 1 - t the height of the wave is 24 t s^3 - 54 t^2 s^2 + 24 t^3 s:
    /// inside it crosses the axis where s / t = (9 +- sqrt 17) / 8.
    #[test]
    fn all_crossings_are_found() {
        let found = wave().crossings(point(0., 1.), 0.0);
        let ratio = (9.0 + 17.0_f64.sqrt()) / 8.0;
        let first = 1.0 / (1.0 + ratio);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[0] - first).abs() < 1e-12 && (found[1] - 1.0 + first).abs() < 1e-12);
        assert!(wave().crossings(point(0., 1.), 99.0).is_empty());
        // Along the line itself there is no crossing.
        let flat = Quartic::straight(point(0., 0.), point(1., 0.));
        assert!(flat.crossings(point(0., 1.), 0.0).is_empty());
        assert_eq!(flat.crossings(point(1., 0.), 0.25).len(), 1);
    }
}
