//! The one error type of the crate.

use geo_types::Coord;

/// Why tracing could not begin.
///
/// How a line *ends* is never an error: see [`Stop`](crate::Stop).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TraceError {
    /// An option has a value that no trace can work with.
    #[error("option `{name}` is {value}, but it must be {expected}: correct the options")]
    BadOption {
        /// The field of the options struct.
        name: &'static str,
        /// The value that was given.
        value: f64,
        /// What the value has to be.
        expected: &'static str,
    },
    /// A seed has a coordinate that is NaN or infinite.
    #[error("seed {index} lies at ({x}, {y}), which is not finite: drop or repair it")]
    SeedNotFinite {
        /// Position in the list of seeds; 0 for a single trace.
        index: usize,
        /// East coordinate as given.
        x: f64,
        /// North coordinate as given.
        y: f64,
    },
    /// A heading, or a direction of a seed, has no length or is not finite.
    #[error(
        "the heading ({x}, {y}) of seed {index} has no direction: give any non-zero finite vector"
    )]
    NoHeading {
        /// Position in the list of seeds; 0 for a single trace.
        index: usize,
        /// East component as given.
        x: f64,
        /// North component as given.
        y: f64,
    },
    /// The field has no direction at the seed: it lies outside the domain or
    /// at a singularity.
    ///
    /// [`candidates`](crate::candidates) discards such seeds instead.
    #[error("the field has no direction at the seed ({x}, {y}): move it inside the domain and off the singularity")]
    NoDirection {
        /// East coordinate of the seed.
        x: f64,
        /// North coordinate of the seed.
        y: f64,
    },
    /// The field does not leave a singularity along as many arms as its index
    /// calls for.
    #[error("singularity {index} at ({x}, {y}) should have {expected} arms, but {found} were found: correct its index or its place")]
    NoArms {
        /// Position in the list of singularities.
        index: usize,
        /// East coordinate as given.
        x: f64,
        /// North coordinate as given.
        y: f64,
        /// 4 less the quarters of its index.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// A line given to [`tiles`](crate::tiles) has a coordinate that is NaN,
    /// infinite or beyond 1e100.
    #[error("line {index} has a point ({x}, {y}), which is not finite or beyond 1e100: drop or repair the line")]
    LineNotFinite {
        /// Position in the list of lines.
        index: usize,
        /// East coordinate as given.
        x: f64,
        /// North coordinate as given.
        y: f64,
    },
    /// The domain has a coordinate that is NaN, infinite or beyond 1e100.
    #[error("ring {ring} of the domain has a vertex ({x}, {y}), which is not finite or beyond 1e100: repair the domain")]
    DomainNotFinite {
        /// The ring: 0 is the exterior, then the interiors in their order.
        ring: usize,
        /// East coordinate as given.
        x: f64,
        /// North coordinate as given.
        y: f64,
    },
    /// The domain has no vertices, or no extent in one direction.
    #[error(
        "the domain has no area: give a polygon with at least three vertices that are not in line"
    )]
    DomainWithoutArea,
    /// A tiling given to [`criteria`](crate::criteria) was not made of the
    /// lines given with it, or was changed since.
    #[error("{what} {index} of the tiling refers to what is not there: give the tiling that `tiles` makes of exactly these lines")]
    BadTiling {
        /// `vertex`, `edge` or `tile`.
        what: &'static str,
        /// Its position in the tiling.
        index: usize,
    },
    /// The scale of the separation is no positive number at a seed.
    #[error("the scale of the separation is {value} at seed {index}, ({x}, {y}): it must be positive and finite")]
    BadScale {
        /// Position in the list of seeds.
        index: usize,
        /// East coordinate of the seed.
        x: f64,
        /// North coordinate of the seed.
        y: f64,
        /// What the function answered.
        value: f64,
    },
}

impl TraceError {
    /// That an option is above 0.
    pub(crate) fn unless_positive(name: &'static str, value: f64) -> Result<(), Self> {
        if value > 0.0 && value.is_finite() {
            return Ok(());
        }
        Err(Self::BadOption {
            name,
            value,
            expected: "positive and finite",
        })
    }

    /// That an option is 0 or more.
    pub(crate) fn unless_not_negative(name: &'static str, value: f64) -> Result<(), Self> {
        if value >= 0.0 && value.is_finite() {
            return Ok(());
        }
        Err(Self::BadOption {
            name,
            value,
            expected: "zero or positive, and finite",
        })
    }

    pub(crate) fn no_direction(at: Coord<f64>) -> Self {
        Self::NoDirection { x: at.x, y: at.y }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_say_what_where_and_what_to_do() {
        let text = TraceError::SeedNotFinite {
            index: 7,
            x: f64::NAN,
            y: 1.0,
        }
        .to_string();
        assert!(
            text.contains("seed 7") && text.contains("NaN") && text.contains("drop"),
            "{text}"
        );
        let text = TraceError::BadOption {
            name: "step",
            value: -1.0,
            expected: "positive",
        }
        .to_string();
        assert!(text.contains("`step` is -1"), "{text}");
    }
}
