#![doc = include_str!("../README.md")]

pub mod syntax;

pub use geo_types;
use geo_types::Polygon;

/// Why a park could not be derived.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ParkError {
    /// The park's outline has fewer than three different vertices.
    #[error("the park's exterior has {vertices} different vertices; a region needs at least 3")]
    Degenerate {
        /// Different vertices of the exterior ring.
        vertices: usize,
    },
    /// Rules are not interpreted by this release.
    #[error("this release does not interpret park rules; lay the park out as open space, or use a release with a rule interpreter")]
    RulesNotInterpreted,
}

/// A grammar for parks: rules that turn a region into paths, lawns and objects.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grammar {
    source: String,
}

impl Grammar {
    /// A grammar from its text.
    #[must_use]
    pub fn new(source: impl Into<String>) -> Self {
        Self {
            source: source.into(),
        }
    }

    /// The text of the rules.
    #[must_use]
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Checks the region, then derives the park from the rules.
    ///
    /// # Errors
    ///
    /// [`ParkError::Degenerate`] for a region without area to speak of, and in
    /// this release always [`ParkError::RulesNotInterpreted`] for the rest: it
    /// never answers with a park that the rules did not make.
    ///
    /// # Examples
    ///
    /// ```
    /// use park_grammar::{Grammar, ParkError};
    /// use park_grammar::geo_types::polygon;
    ///
    /// let lawn = polygon![(x: 0., y: 0.), (x: 80., y: 0.), (x: 80., y: 50.), (x: 0., y: 50.)];
    /// let rules = Grammar::new("park -> lawn");
    /// assert_eq!(rules.derive(&lawn), Err(ParkError::RulesNotInterpreted));
    /// ```
    pub fn derive(&self, region: &Polygon<f64>) -> Result<(), ParkError> {
        let mut vertices: Vec<(u64, u64)> = region
            .exterior()
            .0
            .iter()
            .map(|c| (c.x.to_bits(), c.y.to_bits()))
            .collect();
        vertices.sort_unstable();
        vertices.dedup();
        if vertices.len() < 3 {
            return Err(ParkError::Degenerate {
                vertices: vertices.len(),
            });
        }
        Err(ParkError::RulesNotInterpreted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{polygon, LineString};

    #[test]
    fn regions_are_checked_first() {
        let line = Polygon::new(
            LineString::from(vec![(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)]),
            vec![],
        );
        assert_eq!(
            Grammar::new("").derive(&line),
            Err(ParkError::Degenerate { vertices: 2 })
        );
        let square = polygon![(x: 0., y: 0.), (x: 1., y: 0.), (x: 1., y: 1.), (x: 0., y: 1.)];
        assert_eq!(
            Grammar::new("").derive(&square),
            Err(ParkError::RulesNotInterpreted)
        );
    }
}
