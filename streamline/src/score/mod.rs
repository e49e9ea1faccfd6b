//! What makes a streamline a good place for a street: four costs and a ranking.

mod boundary;
mod continuity;
mod distinct;
mod divergence;
mod rank;
mod rays;
mod singularity;
mod width;

pub use boundary::{BoundaryDistance, BoundaryMeasure, BoundaryOptions};
pub use continuity::Continuity;
pub use distinct::distinct;
pub(crate) use divergence::divergence_along;
pub use divergence::Divergence;
pub use rank::{choose, rank, Ranked};
pub use singularity::SingularityDistance;
pub use width::WidthTable;

use crate::field::DirectionField;
use crate::streamline::Streamline;

/// What one quality of a candidate costs: lower is better.
///
/// Costs of different scores need share no unit, for [`rank`] normalises each
/// over the candidates.
///
/// # Examples
///
/// A score of one's own: streets should run north.
///
/// ```
/// use streamline::{DirectionField, Score, Streamline};
///
/// struct North;
/// impl Score for North {
///     fn name(&self) -> &str {
///         "north"
///     }
///     fn cost(&self, line: &Streamline, _: &dyn DirectionField) -> f64 {
///         let samples = line.samples(5.0);
///         samples.iter().map(|s| s.tangent.x.abs() * s.length).sum::<f64>() / line.length()
///     }
/// }
/// ```
pub trait Score: Sync {
    /// A short name for reports, such as `divergence`.
    fn name(&self) -> &str;

    /// The cost of one candidate of a field. A cost that is not finite counts
    /// as the worst.
    fn cost(&self, line: &Streamline, field: &dyn DirectionField) -> f64;
}

impl<T: Score + ?Sized> Score for &T {
    fn name(&self) -> &str {
        (**self).name()
    }

    fn cost(&self, line: &Streamline, field: &dyn DirectionField) -> f64 {
        (**self).cost(line, field)
    }
}

/// For tests: the field that points east on a square of 100 m, and its line that
/// crosses the square 40 m from the southern side.
#[cfg(test)]
fn eastwards() -> (impl DirectionField, Streamline) {
    use crate::trace::{trace, TraceOptions};
    use crate::vector::point;
    use geo_types::polygon;

    let domain = polygon![
        (x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 100.), (x: 0., y: 100.)
    ];
    let east = crate::field::from_fn(domain, |_, _| Some(point(1.0, 0.0)));
    let options = TraceOptions::default();
    let line = trace(&east, point(50.0, 40.0), point(1.0, 0.0), &options);
    let line = line.expect("the field has a direction there");
    (east, line)
}
