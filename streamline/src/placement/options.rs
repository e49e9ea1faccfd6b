//! How lines are placed.

use crate::error::TraceError;
use crate::trace::TraceOptions;

/// In which order lines are placed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Strategy {
    /// Each line starts one separation beside an earlier one (B. Jobard,
    /// W. Lefer, *Creating Evenly-Spaced Streamlines of Arbitrary Density*,
    /// 1997): the evenest spacing.
    #[default]
    Neighbour,
    /// Each line starts at the seed that is farthest from all others, in
    /// sixteenths of a separation (A. Mebarki, P. Alliez, O. Devillers, *Farthest Point
    /// Seeding for Efficient Placement of Streamlines*, 2005): longer lines,
    /// and a set that is evenly spread at any moment.
    Farthest,
}

/// What becomes of a line's end that came too near to another line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Ends {
    /// It stays where it is, in the open ([`Stop::Neighbour`](crate::Stop)).
    #[default]
    Open,
    /// It is cut back to the last line that it crosses, and ends there in a
    /// T ([`Stop::Junction`](crate::Stop)). Lines that cross too few others go.
    Junction,
}

/// How lines are placed by [`place`](crate::place). Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlacementOptions {
    /// Distance between neighbouring lines of the first and of the second
    /// family: d_sep. If lines of the first family bound the depth of blocks,
    /// then those of the second bound their length.
    ///
    /// Default value: 75 m (two parcels of 30 m and a street of 15 m) and
    /// 150 m.
    pub separation: [f64; 2],
    /// A line ends before it comes nearer than this share of the separation to
    /// another that runs alongside, or to itself: d_test / d_sep, from 0.1 to
    /// 1. The smaller, the longer the lines and the more uneven their spacing.
    ///
    /// Default value: 0.87.
    pub test: f64,
    /// Where a line has no neighbour alongside within this many separations, on
    /// neither side, it is cut, and two lines take its place; beside the
    /// boundary, one that is nearer to its neighbour. At least 1.5 times
    /// [`test`](Self::test), or two would not fit.
    ///
    /// Spacing gets more even, at the price of more and shorter lines and of two
    /// fifths more time. With 1.29 and a `test` of 0.86 fewer than one point in a
    /// hundred is farther than 1.3 separations from the nearest other line;
    /// without it one in eight is, where a field spreads. Closed lines stay
    /// whole.
    ///
    /// Default value: none, which leaves all lines whole.
    pub widest: Option<f64>,
    /// Shorter lines are dropped, as a share of the separation.
    ///
    /// Default value: 0.5.
    pub min_length: f64,
    /// Which families are placed.
    ///
    /// Default value: both.
    pub families: [bool; 2],
    /// The order of placement.
    ///
    /// Default value: [`Strategy::Neighbour`].
    pub strategy: Strategy,
    /// What becomes of ends near other lines.
    ///
    /// Default value: [`Ends::Open`].
    pub ends: Ends,
    /// How each line is traced. Its `self_approach` is not used: a line keeps
    /// the same distance from itself as from others.
    ///
    /// Default value: that of [`TraceOptions`], with a tenth of its tolerance
    /// (0.001 m), so that tangents are accurate too.
    pub trace: TraceOptions,
}

impl Default for PlacementOptions {
    fn default() -> Self {
        Self {
            separation: [75.0, 150.0],
            test: 0.87,
            widest: None,
            min_length: 0.5,
            families: [true, true],
            strategy: Strategy::Neighbour,
            ends: Ends::Open,
            trace: TraceOptions {
                tolerance: 1e-3,
                ..TraceOptions::default()
            },
        }
    }
}

impl PlacementOptions {
    pub(super) fn validate(&self) -> Result<(), TraceError> {
        self.trace.validate()?;
        for value in self.separation {
            TraceError::unless_positive("separation", value)?;
        }
        if !(0.1..=1.0).contains(&self.test) {
            return Err(TraceError::BadOption {
                name: "test",
                value: self.test,
                expected: "from 0.1 to 1",
            });
        }
        if let Some(value) = self.widest {
            if !(value >= 1.5 * self.test && value.is_finite()) {
                return Err(TraceError::BadOption {
                    name: "widest",
                    value,
                    expected: "finite and at least 1.5 times `test`",
                });
            }
        }
        TraceError::unless_not_negative("min_length", self.min_length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bad_option_is_named() {
        let good = PlacementOptions::default();
        assert_eq!(good.validate(), Ok(()));
        let trace = TraceOptions {
            step: 0.0,
            ..good.trace
        };
        let bad = [
            (
                "separation",
                PlacementOptions {
                    separation: [75.0, f64::NAN],
                    ..good
                },
            ),
            ("test", PlacementOptions { test: 1.01, ..good }),
            (
                "min_length",
                PlacementOptions {
                    min_length: -1.0,
                    ..good
                },
            ),
            ("step", PlacementOptions { trace, ..good }),
            (
                "widest",
                PlacementOptions {
                    widest: Some(1.3),
                    ..good
                },
            ),
            (
                "widest",
                PlacementOptions {
                    widest: Some(f64::NAN),
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
