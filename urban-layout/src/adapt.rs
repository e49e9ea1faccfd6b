//! The umbrella's adapters: types of one leaf crate as what another asks for.

use crossfield::Field;
use geo_types::Coord;
use streamline::{Cursor, DirectionField, Exit};

/// Follows the arms of a [`crossfield::Field`] as a
/// [`streamline::DirectionField`].
#[derive(Clone, Copy, Debug)]
pub struct Arms<'a>(pub &'a Field);

impl DirectionField for Arms<'_> {
    fn direction(
        &self,
        at: Coord<f64>,
        heading: Coord<f64>,
        cursor: &mut Cursor,
    ) -> Option<Coord<f64>> {
        with_cursor(cursor, |c| self.0.direction(at, heading, c))
    }

    fn exit(&self, from: Coord<f64>, to: Coord<f64>, cursor: &mut Cursor) -> Option<Exit> {
        let exit = with_cursor(cursor, |c| self.0.domain().exit(from, to, c))?;
        Some(Exit {
            point: exit.point,
            ring: exit.ring,
            edge: exit.edge,
        })
    }

    fn divergence(&self, at: Coord<f64>, heading: Coord<f64>, cursor: &mut Cursor) -> Option<f64> {
        with_cursor(cursor, |c| self.0.divergence(at, heading, c))
    }
}

/// Carries the tracer's opaque cursor into crossfield's and back.
fn with_cursor<T>(cursor: &mut Cursor, f: impl FnOnce(&mut crossfield::Cursor) -> T) -> T {
    let mut inner = crossfield::Cursor::from_bits(cursor.0);
    let out = f(&mut inner);
    cursor.0 = inner.to_bits();
    out
}
