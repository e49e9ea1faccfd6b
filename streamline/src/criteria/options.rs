//! What the criteria are measured with.

use crate::error::TraceError;

/// How the turns of a line are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum TurnRule {
    /// As many as there are stretches, none overlapping another, of at most
    /// [`region`](CriteriaOptions::region) metres within which the direction
    /// changes by more than [`angle_deg`](CriteriaOptions::angle_deg).
    ///
    /// Exact on a polyline, and the same from either end. Another kink where
    /// the line is straight for a region to both sides never lowers it.
    #[default]
    Stretches,
    /// UrbanFab's words: the line is divided into equal segments of at most
    /// the region, and there is a turn wherever the next point lies outside
    /// the sector of that angle to either side of the segment before.
    ///
    /// A kink within a segment is shared by the two turns at its ends, so that
    /// one of 30 degrees may escape a limit of 20.
    Segments,
}

/// Options of [`criteria`](crate::criteria). Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CriteriaOptions {
    /// Greatest length of the equal segments that each line is divided into.
    ///
    /// Default value: 4 m.
    pub step: f64,
    /// Whether the divergence of a line is that of the paper's formula, whose
    /// signs cancel where lines spread here and narrow there; a line's figure
    /// is then the absolute value of the mean. Segments always have absolute
    /// ones.
    ///
    /// Default value: false, the mean of the absolute divergence.
    pub signed: bool,
    /// The detect region of continuity: within what length a change of
    /// direction is a turn. What is a turn depends on the scale that one looks
    /// at: a street that bends through a right angle along 50 m has none
    /// within 4 m.
    ///
    /// Default value: 4 m, d_dist of the 2013 paper.
    pub region: f64,
    /// By how much the direction must change, from 0 to below 180 degrees.
    ///
    /// Default value: 20 degrees, d_dir of the 2013 paper.
    pub angle_deg: f64,
    /// How turns are counted.
    ///
    /// Default value: [`TurnRule::Stretches`].
    pub turns: TurnRule,
    /// How far from the boundary a segment may lie to be compared with it, for
    /// parallelism and perpendicularity: both are "less significant further
    /// from the boundary". `None` for no limit.
    ///
    /// Default value: `None`, as the paper has it.
    pub reach: Option<f64>,
    /// A line whose end lies this near to the boundary touches it; and how far
    /// the tiles' edges may lie from their lines. At least the
    /// [`snap`](crate::TileOptions::snap) that the tiles were made with.
    ///
    /// Default value: 0.001 m.
    pub snap: f64,
    /// Smaller tiles, in square metres, are left out of the statistics.
    ///
    /// Default value: 0.
    pub min_tile_area: f64,
}

impl Default for CriteriaOptions {
    fn default() -> Self {
        Self {
            step: 4.0,
            signed: false,
            region: 4.0,
            angle_deg: 20.0,
            turns: TurnRule::Stretches,
            reach: None,
            snap: 1e-3,
            min_tile_area: 0.0,
        }
    }
}

impl CriteriaOptions {
    pub(super) fn validate(&self) -> Result<(), TraceError> {
        let positive = "positive and finite";
        let zero = "zero or positive, and finite";
        let checks = [
            ("step", self.step, positive, self.step > 0.0),
            ("region", self.region, positive, self.region > 0.0),
            (
                "angle_deg",
                self.angle_deg,
                "from 0 to below 180",
                (0.0..180.0).contains(&self.angle_deg),
            ),
            (
                "reach",
                self.reach.unwrap_or(0.0),
                zero,
                self.reach.is_none_or(|reach| reach >= 0.0),
            ),
            ("snap", self.snap, zero, self.snap >= 0.0),
            (
                "min_tile_area",
                self.min_tile_area,
                zero,
                self.min_tile_area >= 0.0,
            ),
        ];
        for (name, value, expected, fits) in checks {
            if !(fits && value.is_finite()) {
                return Err(TraceError::BadOption {
                    name,
                    value,
                    expected,
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bad_option_is_named() {
        let good = CriteriaOptions::default();
        assert_eq!(good.validate(), Ok(()));
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            let all = [
                ("step", CriteriaOptions { step: bad, ..good }),
                (
                    "region",
                    CriteriaOptions {
                        region: bad,
                        ..good
                    },
                ),
                (
                    "angle_deg",
                    CriteriaOptions {
                        angle_deg: bad,
                        ..good
                    },
                ),
                (
                    "reach",
                    CriteriaOptions {
                        reach: Some(bad),
                        ..good
                    },
                ),
                ("snap", CriteriaOptions { snap: bad, ..good }),
                (
                    "min_tile_area",
                    CriteriaOptions {
                        min_tile_area: bad,
                        ..good
                    },
                ),
            ];
            for (expected, options) in all {
                match options.validate() {
                    Err(TraceError::BadOption { name, .. }) => assert_eq!(name, expected),
                    other => panic!("{expected}: {other:?}"),
                }
            }
        }
        for angle_deg in [180.0, 400.0] {
            assert!(CriteriaOptions { angle_deg, ..good }.validate().is_err());
        }
    }
}
