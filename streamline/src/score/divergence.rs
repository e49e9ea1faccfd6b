//! Do the neighbouring streamlines keep their distance?

use super::Score;
use crate::field::{Cursor, DirectionField};
use crate::streamline::{Sample, Streamline};

/// DIV(s) of the paper (equation 2): the divergence of the field integrated
/// along the line, times length^-p. In m^-p.
///
/// With p = 0.9 the absolute form is length^0.1 times the mean divergence, so
/// it favours long lines but little; above p = 1 it favours them outright.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Divergence {
    /// Exponent of the length.
    ///
    /// Default value: 0.9, the paper's p.
    pub p: f64,
    /// Integrates the signed divergence, as the paper's formula has it, so
    /// that spreading here and narrowing there cancel. The sign of the whole
    /// depends on the direction of travel, which means nothing, so that its
    /// absolute value is the cost.
    ///
    /// Default value: false, which integrates the absolute divergence.
    pub signed: bool,
    /// Greatest distance between samples, in metres.
    ///
    /// Default value: 5 m.
    pub step: f64,
}

impl Default for Divergence {
    fn default() -> Self {
        Self {
            p: 0.9,
            signed: false,
            step: 5.0,
        }
    }
}

impl Divergence {
    /// The integral of the divergence along the line, without the factor:
    /// dimensionless, signed or absolute as the options say. Samples without a
    /// divergence take the mean of the others.
    pub fn integral(&self, line: &Streamline, field: &dyn DirectionField) -> f64 {
        let (mut sum, mut known, mut total) = (0.0, 0.0, 0.0);
        for (sample, divergence) in divergence_along(line, field, self.step) {
            total += sample.length;
            if let Some(divergence) = divergence {
                sum += sample.length
                    * if self.signed {
                        divergence
                    } else {
                        divergence.abs()
                    };
                known += sample.length;
            }
        }
        if known > 0.0 {
            sum * total / known
        } else {
            0.0
        }
    }
}

/// The equal pieces of a line, each with the signed divergence at its middle.
pub(crate) fn divergence_along<'a>(
    line: &Streamline,
    field: &'a dyn DirectionField,
    step: f64,
) -> impl Iterator<Item = (Sample, Option<f64>)> + use<'a> {
    let mut cursor = Cursor::default();
    line.samples(step).into_iter().map(move |sample| {
        let divergence = field.divergence(sample.at, sample.tangent, &mut cursor);
        (sample, divergence)
    })
}

impl Score for Divergence {
    fn name(&self) -> &str {
        "divergence"
    }

    /// NaN for a line without length.
    fn cost(&self, line: &Streamline, field: &dyn DirectionField) -> f64 {
        let length = line.length();
        if length > 0.0 {
            self.integral(line, field).abs() * length.powf(-self.p)
        } else {
            f64::NAN
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{arm_nearest, from_fn};
    use crate::trace::{trace, TraceOptions};
    use crate::vector::point;
    use geo_types::polygon;

    #[test]
    fn radial_lines_have_the_integral_of_one_over_r() {
        let domain =
            polygon![(x: 10., y: -50.), (x: 80., y: -50.), (x: 80., y: 50.), (x: 10., y: 50.)];
        let polar = from_fn(domain, |at, heading| {
            Some(arm_nearest(at.y.atan2(at.x), heading))
        });
        let line = trace(
            &polar,
            point(30.0, 0.0),
            point(1.0, 0.0),
            &TraceOptions::default(),
        )
        .unwrap();
        let score = Divergence {
            step: 0.5,
            ..Divergence::default()
        };
        let expected = 8.0_f64.ln();
        assert!((score.integral(&line, &polar) - expected).abs() < 1e-3);
        assert!((score.cost(&line, &polar) - expected * 70.0_f64.powf(-0.9)).abs() < 1e-4);
        let signed = Divergence {
            signed: true,
            ..score
        };
        assert!((signed.cost(&line, &polar) - score.cost(&line, &polar)).abs() < 1e-12);
        let arc = trace(
            &polar,
            point(30.0, 0.0),
            point(0.0, 1.0),
            &TraceOptions::default(),
        )
        .unwrap();
        assert!(
            score.cost(&arc, &polar) < 1e-6,
            "circles neither spread nor narrow"
        );
    }

    #[test]
    fn signs_cancel_only_where_asked() {
        // Lines spread until x = 0 and narrow again behind it.
        let domain =
            polygon![(x: -50., y: -20.), (x: 50., y: -20.), (x: 50., y: 20.), (x: -50., y: 20.)];
        let lens = from_fn(domain, |at, _| Some(point(1.0, -1e-3 * at.x * at.y)));
        let line = trace(
            &lens,
            point(0.0, 0.0),
            point(1.0, 0.0),
            &TraceOptions::default(),
        )
        .unwrap();
        let absolute = Divergence::default();
        let signed = Divergence {
            signed: true,
            ..absolute
        };
        assert!(absolute.cost(&line, &lens) > 0.03);
        assert!(signed.cost(&line, &lens) < 1e-6);
    }
}
