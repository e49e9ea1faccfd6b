//! How far the edge-map tracer goes, and when it calls a line closed.

use crate::error::TraceError;

/// How a line is traced by [`EdgeMaps`](crate::EdgeMaps). Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EdgeOptions {
    /// Greatest length traced each way from the seed.
    ///
    /// Default value: 100 km. Must be finite: it bounds the work.
    pub max_length: f64,
    /// A line that meets an edge of the mesh this near to where it met it
    /// before, with the same pair of arms, stops there; 0 switches the test
    /// off, and a line may then wind onto a closed one until its length ends it.
    /// Only the edge itself is looked at: over triangles smaller than this a
    /// line may come as near to itself as they are large.
    ///
    /// Default value: 4.5 m, as in [`TraceOptions`](crate::TraceOptions).
    pub self_approach: f64,
    /// A line that passes its seed this near, in its first direction, is
    /// closed there by a step aside of that length at most. With 0, only lines
    /// that close to rounding do, and no step can cross another line.
    ///
    /// Default value: 0.1 m, as in [`TraceOptions`](crate::TraceOptions).
    pub loop_tolerance: f64,
    /// A line that comes this near to a singular point has ended there.
    ///
    /// Default value: 5 mm.
    pub singular_radius: f64,
}

impl Default for EdgeOptions {
    fn default() -> Self {
        Self {
            max_length: 1e5,
            self_approach: 4.5,
            loop_tolerance: 0.1,
            singular_radius: 0.005,
        }
    }
}

impl EdgeOptions {
    pub(crate) fn validate(&self) -> Result<(), TraceError> {
        TraceError::unless_positive("max_length", self.max_length)?;
        for (name, value) in [
            ("self_approach", self.self_approach),
            ("loop_tolerance", self.loop_tolerance),
            ("singular_radius", self.singular_radius),
        ] {
            TraceError::unless_not_negative(name, value)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bad_option_is_named() {
        let good = EdgeOptions::default();
        assert_eq!(good.validate(), Ok(()));
        let name = |options: EdgeOptions| match options.validate() {
            Err(TraceError::BadOption { name, .. }) => name,
            other => panic!("{other:?}"),
        };
        assert_eq!(
            name(EdgeOptions {
                max_length: f64::INFINITY,
                ..good
            }),
            "max_length"
        );
        assert_eq!(
            name(EdgeOptions {
                self_approach: -1.0,
                ..good
            }),
            "self_approach"
        );
        assert_eq!(
            name(EdgeOptions {
                loop_tolerance: f64::NAN,
                ..good
            }),
            "loop_tolerance"
        );
        assert_eq!(
            name(EdgeOptions {
                singular_radius: -0.1,
                ..good
            }),
            "singular_radius"
        );
    }
}
