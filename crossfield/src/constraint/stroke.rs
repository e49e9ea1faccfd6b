//! A sketched line that the field should follow.

use geo_types::{Coord, LineString};

use super::{check_finite, check_weight, Constraint, Pulls};
use crate::plane::{coord, vector, V2};
use crate::FieldError;

/// A polyline with the field along it: a street that someone drew, a river,
/// the axis of a view (the supplement's future work: "sketched suggestions of
/// where roads should be placed").
///
/// Adds `weight * integral |D - D~|^2 ds / unit` to the energy, D~ along the
/// line: neither the number of its points nor the mesh counts. What lies
/// outside the domain has no effect. For [`Symmetry::Vector`] the direction is
/// that of drawing.
///
/// [`Symmetry::Vector`]: crate::Symmetry::Vector
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stroke {
    /// The line, in the coordinates of the domain.
    pub line: LineString<f64>,
    /// Its strength, to be compared with [`BoundaryField::omega`]; positive.
    ///
    /// [`BoundaryField::omega`]: crate::BoundaryField::omega
    pub weight: f64,
}

/// Samples for each edge length of the mesh: enough that a triangle which the
/// stroke crosses in earnest is met.
const DENSITY: f64 = 4.0;

impl Stroke {
    /// A stroke along `line`.
    #[must_use]
    pub fn new(line: LineString<f64>, weight: f64) -> Self {
        Self { line, weight }
    }

    pub(crate) fn check(&self) -> Result<(), FieldError> {
        check_weight(self.weight)?;
        for &at in &self.line.0 {
            check_finite("line", at)?;
        }
        if self.line.lines().all(|l| l.start == l.end) {
            return Err(FieldError::option(
                "line",
                "of a stroke has no length; give two different points or more",
            ));
        }
        Ok(())
    }

    /// Calls `visit` with points along the line, its direction there, and the
    /// length that each stands for, `step` at most.
    pub(crate) fn sample(
        &self,
        (centre, reach): (V2, f64),
        step: f64,
        mut visit: impl FnMut(Coord<f64>, Coord<f64>, f64),
    ) {
        for segment in self.line.lines() {
            let (a, b) = (vector(segment.start), vector(segment.end));
            // A line that runs on for ever must not take for ever.
            let Some((from, to)) = clip(a - centre, b - centre, reach) else {
                continue;
            };
            let direction = (b - a) / (b - a).amax();
            let along = to - from;
            let count = (along.norm() / step).ceil().max(1.0);
            let share = along.norm() / count;
            for k in 0..count as usize {
                let at = from + along * ((k as f64 + 0.5) / count);
                visit(coord(at + centre), coord(direction), share);
            }
        }
    }
}

impl Constraint for Stroke {
    fn pull(&self, pulls: &mut Pulls<'_>) -> Result<(), FieldError> {
        self.check()?;
        let frame = pulls.domain().inner.frame;
        let step = pulls.domain().edge_length() / DENSITY;
        let per_length = self.weight / pulls.unit();
        self.sample((frame.origin, frame.size), step, |at, direction, length| {
            pulls.at_point(at, direction, per_length * length);
        });
        Ok(())
    }
}

/// The part of the segment `a b` in the square of half-width `reach` around
/// the origin (Liang and Barsky 1984).
fn clip(a: V2, b: V2, reach: f64) -> Option<(V2, V2)> {
    let d = b - a;
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (start, slope) in [(a.x, d.x), (-a.x, -d.x), (a.y, d.y), (-a.y, -d.y)] {
        // Inside where start + t slope <= reach.
        let room = reach - start;
        if slope > 0.0 {
            to = to.min(room / slope);
        } else if slope < 0.0 {
            from = from.max(room / slope);
        } else if room < 0.0 {
            return None;
        }
    }
    (from < to).then(|| (a + d * from, a + d * to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::line_string;

    #[test]
    fn samples_add_up_to_the_length_inside() {
        let stroke = Stroke::new(
            line_string![(x: -1e12, y: 1.0), (x: 1e12, y: 1.0), (x: 1e12, y: 50.0)],
            1.0,
        );
        let mut total = 0.0;
        let mut calls = 0;
        stroke.sample((V2::zeros(), 10.0), 0.3, |at, direction, length| {
            assert!((at.y - 1.0).abs() < 1e-3 && direction == Coord { x: 1.0, y: 0.0 });
            assert!(length <= 0.3);
            total += length;
            calls += 1;
        });
        // Rounding of 1e12: 1e-4.
        assert!((total - 20.0).abs() < 1e-3, "{total}");
        assert_eq!(calls, 67);
    }

    #[test]
    fn strokes_without_length_or_weight_are_refused() {
        let line = line_string![(x: 0.0, y: 0.0), (x: 1.0, y: 0.0)];
        assert!(Stroke::new(line.clone(), 1.0).check().is_ok());
        for weight in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Stroke::new(line.clone(), weight).check().is_err());
        }
        for bad in [
            line_string![],
            line_string![(x: 0.0, y: 0.0)],
            line_string![(x: 2.0, y: 2.0), (x: 2.0, y: 2.0)],
            line_string![(x: 2.0, y: 2.0), (x: f64::NAN, y: 2.0)],
        ] {
            assert!(Stroke::new(bad, 1.0).check().is_err());
        }
    }
}
