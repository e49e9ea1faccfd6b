//! How finely a streamline is traced, and how far.

use crate::error::TraceError;

/// How a streamline is traced. Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TraceOptions {
    /// Greatest distance between consecutive points of the line.
    ///
    /// Default value: 5 m.
    pub step: f64,
    /// Greatest step of the integrator, which may be longer than
    /// [`step`](Self::step): the points between come from its continuous
    /// extension and cost no evaluation of the field.
    ///
    /// Default value: 20 m.
    pub max_step: f64,
    /// Greatest error of one step, estimated from two embedded formulas. The
    /// error of the whole line adds those of its steps, magnified by
    /// exp(integral of |div|) where neighbouring lines spread.
    ///
    /// Default value: 0.01 m.
    pub tolerance: f64,
    /// Greatest length traced each way from the seed.
    ///
    /// Default value: 100 km. Must be finite: it bounds the work.
    pub max_length: f64,
    /// Greatest turn within one step, in degrees, at most 45. A cross has an
    /// arm within 45 degrees of any heading, so a larger turn could not be told
    /// from a change of arm.
    ///
    /// Default value: 30 degrees.
    pub max_turn_deg: f64,
    /// A line that comes this near to an earlier part of itself, at less than
    /// 45 degrees to it, stops there; 0 switches the test off.
    ///
    /// Default value: 4.5 m, half the separation of
    /// [`CandidateOptions`](crate::CandidateOptions).
    pub self_approach: f64,
    /// A line that passes its seed this near, in its first direction, is
    /// closed. Must exceed the error gathered along one round.
    ///
    /// Default value: 0.1 m, ten times the tolerance.
    pub loop_tolerance: f64,
}

impl Default for TraceOptions {
    fn default() -> Self {
        Self {
            step: 5.0,
            max_step: 20.0,
            tolerance: 0.01,
            max_length: 1e5,
            max_turn_deg: 30.0,
            self_approach: 4.5,
            loop_tolerance: 0.1,
        }
    }
}

impl TraceOptions {
    /// The defaults with every length multiplied by `factor`, for a domain
    /// whose unit is not the metre or whose streets are not ours.
    #[must_use]
    pub fn scaled(factor: f64) -> Self {
        let base = Self::default();
        Self {
            step: base.step * factor,
            max_step: base.max_step * factor,
            tolerance: base.tolerance * factor,
            max_length: base.max_length * factor,
            max_turn_deg: base.max_turn_deg,
            self_approach: base.self_approach * factor,
            loop_tolerance: base.loop_tolerance * factor,
        }
    }

    /// Below this step the field is taken to be singular.
    pub(crate) fn min_step(&self) -> f64 {
        1e-3 * self.step.min(self.max_step)
    }

    pub(crate) fn validate(&self) -> Result<(), TraceError> {
        TraceError::unless_positive("step", self.step)?;
        TraceError::unless_positive("max_step", self.max_step)?;
        TraceError::unless_positive("tolerance", self.tolerance)?;
        TraceError::unless_positive("max_length", self.max_length)?;
        if !(self.max_turn_deg > 0.0 && self.max_turn_deg <= 45.0) {
            let (name, value) = ("max_turn_deg", self.max_turn_deg);
            return Err(TraceError::BadOption {
                name,
                value,
                expected: "above 0 and at most 45",
            });
        }
        TraceError::unless_not_negative("self_approach", self.self_approach)?;
        TraceError::unless_not_negative("loop_tolerance", self.loop_tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bad_option_is_named() {
        let good = TraceOptions::default();
        assert_eq!(good.validate(), Ok(()));
        let bad = [
            ("step", TraceOptions { step: 0.0, ..good }),
            (
                "max_step",
                TraceOptions {
                    max_step: f64::INFINITY,
                    ..good
                },
            ),
            (
                "tolerance",
                TraceOptions {
                    tolerance: -1.0,
                    ..good
                },
            ),
            (
                "max_length",
                TraceOptions {
                    max_length: f64::NAN,
                    ..good
                },
            ),
            (
                "max_turn_deg",
                TraceOptions {
                    max_turn_deg: 46.0,
                    ..good
                },
            ),
            (
                "self_approach",
                TraceOptions {
                    self_approach: -1.0,
                    ..good
                },
            ),
            (
                "loop_tolerance",
                TraceOptions {
                    loop_tolerance: f64::NAN,
                    ..good
                },
            ),
        ];
        for (expected, options) in bad {
            match options.validate() {
                Err(TraceError::BadOption { name, .. }) => assert_eq!(name, expected),
                other => panic!("{expected}: {other:?}"),
            }
        }
    }
}
