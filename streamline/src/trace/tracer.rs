//! The two tracers behind one trait.

use super::{trace, EdgeMaps, EdgeOptions, TraceOptions};
use crate::error::TraceError;
use crate::field::DirectionField;
use crate::streamline::Streamline;
use geo_types::Coord;

/// Follows a field both ways from a point: accurately ([`RungeKutta`]), or so
/// that lines keep apart by construction ([`EdgeTracer`]).
///
/// [`candidates_by`](crate::candidates_by) and [`survey_by`](crate::survey_by)
/// take either, or one of yours. It must give the same line for the same
/// arguments.
pub trait Tracer: Sync {
    /// The streamline through `seed`, along the arm nearest to `heading` and
    /// against it, from the far end of the backward half to that of the
    /// forward half.
    ///
    /// # Errors
    ///
    /// [`TraceError::NoDirection`] where there is no line; anything else ends
    /// what it was asked for.
    fn trace(&self, seed: Coord<f64>, heading: Coord<f64>) -> Result<Streamline, TraceError>;
}

/// The tracer of [`trace`](crate::trace()): adaptive Runge-Kutta on any field.
#[derive(Clone, Copy, Debug)]
pub struct RungeKutta<'a, F: ?Sized> {
    /// What is followed.
    pub field: &'a F,
    /// How.
    pub options: TraceOptions,
}

impl<F: DirectionField + ?Sized> Tracer for RungeKutta<'_, F> {
    fn trace(&self, seed: Coord<f64>, heading: Coord<f64>) -> Result<Streamline, TraceError> {
        trace(self.field, seed, heading, &self.options)
    }
}

/// The tracer of [`EdgeMaps`]: no two of its lines merge or cross under 45
/// degrees.
///
/// ```
/// use streamline::geo_types::coord;
/// use streamline::{
///     candidates_by, CandidateOptions, EdgeMaps, EdgeOptions, EdgeTracer, Seed, TriangleField,
/// };
///
/// // Axis-parallel crosses on a square, and seeds across it.
/// let corners = [(0., 0.), (90., 0.), (90., 90.), (0., 90.)].map(|(x, y)| coord! { x: x, y: y });
/// let east = coord! { x: 1., y: 0. };
/// let field = TriangleField::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]], vec![east; 4])?;
/// let maps = EdgeMaps::new(&field);
/// let tracer = EdgeTracer { maps: &maps, options: EdgeOptions::default() };
/// let seeds: Vec<Seed> = (1..9)
///     .map(|k| coord! { x: 10. * f64::from(k), y: 10. * f64::from(k) })
///     .map(|at| Seed { at, directions: [east, coord! { x: 0., y: 1. }] })
///     .collect();
/// let lines = candidates_by(&tracer, &seeds, &CandidateOptions::default())?;
/// assert_eq!(lines.len(), 16);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct EdgeTracer<'a> {
    /// The prepared field.
    pub maps: &'a EdgeMaps<'a>,
    /// How far, and what counts as closed.
    pub options: EdgeOptions,
}

impl Tracer for EdgeTracer<'_> {
    fn trace(&self, seed: Coord<f64>, heading: Coord<f64>) -> Result<Streamline, TraceError> {
        Ok(self.maps.trace(seed, heading, &self.options)?.line)
    }
}
