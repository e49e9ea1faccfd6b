//! A field given by a formula inside a polygon.

use super::{edges::Edges, Cursor, DirectionField, Exit};
use crate::vector::unit;
use geo_types::{Coord, Polygon};
use std::fmt;

/// A [`DirectionField`] made by [`from_fn`].
#[derive(Clone)]
pub struct FromFn<F> {
    domain: Polygon<f64>,
    edges: Edges,
    formula: F,
}

/// The field that a formula gives inside a polygon, holes excepted.
///
/// `f` receives a point of the domain and a heading, and answers with the
/// direction to follow, of any length, or `None` where it has none. For a cross
/// field [`arm_nearest`](crate::arm_nearest) picks the arm; a formula that
/// ignores the heading is a vector field, and is followed backwards against its
/// arrows (the sign of the answer is matched to the heading).
///
/// Boundary exits are exact crossings with the polygon's edges, found through
/// an index. A domain with a coordinate that is not finite, or without edges,
/// is empty: the field has no direction anywhere.
///
/// # Complexity
///
/// Building is O(n log n) in the boundary's vertices, and lays a raster of 128
/// cells a side. Calls away from the boundary, by a cell or the length of the
/// step, are answered by it at once; others cost about as many edge tests as a
/// horizontal ray meets edges.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, polygon};
/// use streamline::{from_fn, trace, Stop, TraceOptions};
///
/// let domain = polygon![(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 60.), (x: 0., y: 60.)];
/// let east = from_fn(domain, |_, _| Some(coord! { x: 1.0, y: 0.0 }));
/// let line = trace(&east, coord! { x: 30., y: 20. }, coord! { x: 1., y: 0. }, &TraceOptions::default())?;
/// assert_eq!(line.end, Stop::Boundary { ring: 0, edge: 1 });
/// assert!((line.length() - 100.0).abs() < 1e-9);
/// # Ok::<(), streamline::TraceError>(())
/// ```
pub fn from_fn<F>(domain: Polygon<f64>, f: F) -> FromFn<F>
where
    F: Fn(Coord<f64>, Coord<f64>) -> Option<Coord<f64>> + Sync,
{
    FromFn {
        edges: Edges::new(&domain),
        domain,
        formula: f,
    }
}

impl<F> FromFn<F> {
    /// The polygon that the field was made for.
    pub fn domain(&self) -> &Polygon<f64> {
        &self.domain
    }
}

impl<F> fmt::Debug for FromFn<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FromFn")
            .field("domain", &self.domain)
            .finish_non_exhaustive()
    }
}

impl<F> DirectionField for FromFn<F>
where
    F: Fn(Coord<f64>, Coord<f64>) -> Option<Coord<f64>> + Sync,
{
    fn direction(&self, at: Coord<f64>, heading: Coord<f64>, _: &mut Cursor) -> Option<Coord<f64>> {
        if !self.edges.contains(at) {
            return None;
        }
        let direction = unit((self.formula)(at, heading)?)?;
        let along = direction.x * heading.x + direction.y * heading.y;
        Some(if along < 0.0 {
            direction * -1.0
        } else {
            direction
        })
    }

    fn exit(&self, from: Coord<f64>, to: Coord<f64>, _: &mut Cursor) -> Option<Exit> {
        self.edges.exit(from, to)
    }

    /// 1e-5 of the diagonal of the domain's bounding box.
    fn difference_step(&self) -> f64 {
        1e-5 * self.edges.size
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{coord, polygon};

    #[test]
    fn answers_are_unit_and_follow_the_heading() {
        let domain = polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.)];
        let field = from_fn(domain, |at, _| {
            (at.x < 8.0).then_some(coord! { x: 3.0, y: 4.0 })
        });
        let mut cursor = Cursor::default();
        let mut ask = |x, y, heading| field.direction(coord! { x: x, y: y }, heading, &mut cursor);
        let north = coord! { x: 0., y: 1. };
        assert_eq!(ask(5.0, 2.0, north), Some(coord! { x: 0.6, y: 0.8 }));
        assert_eq!(
            ask(5.0, 2.0, north * -1.0),
            Some(coord! { x: -0.6, y: -0.8 })
        );
        assert_eq!(ask(8.5, 2.0, north), None);
        assert_eq!(ask(2.0, 5.0, north), None);
    }

    #[test]
    fn a_formula_that_answers_nonsense_has_no_direction() {
        let domain = || polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.)];
        let at = coord! { x: 5., y: 2. };
        let (zero, nan) = (coord! { x: 0., y: 0. }, coord! { x: f64::NAN, y: 0. });
        assert_eq!(
            from_fn(domain(), |_, _| Some(zero)).direction(at, at, &mut Cursor(3)),
            None
        );
        assert_eq!(
            from_fn(domain(), |_, _| Some(nan)).direction(at, at, &mut Cursor(3)),
            None
        );
    }
}
