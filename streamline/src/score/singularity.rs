//! Is there a singularity nearby that splitting here would push out?

use super::Score;
use crate::field::DirectionField;
use crate::streamline::Streamline;
use geo_types::Coord;

/// DS(s) of the paper: the least distance from the line to a singularity of
/// the field, in metres. Nearer is better: splitting beside a singularity
/// often leaves two regions with fewer of them. Without singularities all
/// lines cost 0.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SingularityDistance {
    /// Where the field is singular, in metres.
    pub singularities: Vec<Coord<f64>>,
}

impl Score for SingularityDistance {
    fn name(&self) -> &str {
        "singularities"
    }

    fn cost(&self, line: &Streamline, _: &dyn DirectionField) -> f64 {
        if self.singularities.is_empty() {
            return 0.0;
        }
        // A field has few singularities, and each skips along the line.
        self.singularities
            .iter()
            .map(|&p| line.distance_to(p))
            .fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::eastwards;
    use crate::vector::point;

    #[test]
    fn the_nearest_counts_and_none_costs_nothing() {
        let (east, line) = eastwards();
        assert_eq!(SingularityDistance::default().cost(&line, &east), 0.0);
        let score = SingularityDistance {
            singularities: vec![point(20.0, 90.0), point(70.3, 33.0)],
        };
        assert!((score.cost(&line, &east) - 7.0).abs() < 1e-9);
    }
}
