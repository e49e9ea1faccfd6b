//! What a tracer needs of a field.

mod cells;
mod clearance;
mod edges;
mod formula;
pub(crate) mod mesh;
mod triangles;

pub use formula::{from_fn, FromFn};
pub use mesh::MeshError;
pub use triangles::TriangleField;

use crate::vector::{left, turn};
use geo_types::Coord;

/// Where a field last looked: a hint that makes location amortised O(1).
///
/// The number belongs to whoever implements [`DirectionField`] (the index of
/// the last triangle, say); this crate only carries it from call to call,
/// starting from the default. It is a hint alone: **answers must not depend on
/// it**, or results would depend on the order of the calls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cursor(pub u64);

/// Where a step leaves the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Exit {
    /// The point of the boundary, in metres.
    pub point: Coord<f64>,
    /// The ring that was met, by the implementor's own labels
    /// ([`FromFn`]: 0 is the exterior, then the interiors in their order).
    pub ring: usize,
    /// The edge of the ring, by the implementor's own labels ([`FromFn`]:
    /// edge `i` runs from vertex `i` to vertex `i + 1` of the ring).
    pub edge: usize,
}

/// A direction at every point of a planar domain.
///
/// A cross field has four directions at a point, a line field two and a vector
/// field one; the tracer says where it is heading and takes what continues it
/// best. Two methods suffice; [`divergence`](Self::divergence) may be replaced
/// by something cheaper or sharper than differences.
///
/// Duties of an implementor: the same arguments give the same answer, whatever
/// the cursor; directions are unit vectors; the domain is closed, so a point on
/// its boundary has a direction.
pub trait DirectionField: Sync {
    /// The unit direction to follow from `at` for one who travels along
    /// `heading` (any length): the arm nearest to it.
    ///
    /// `None` outside the domain, and where the field has no direction: at a
    /// singularity.
    fn direction(
        &self,
        at: Coord<f64>,
        heading: Coord<f64>,
        cursor: &mut Cursor,
    ) -> Option<Coord<f64>>;

    /// The first point at which the segment from `from`, in the domain, to `to`
    /// leaves the domain; `None` if it stays inside.
    ///
    /// Touching the boundary is not leaving it: a segment that starts on the
    /// boundary and runs inwards stays inside.
    fn exit(&self, from: Coord<f64>, to: Coord<f64>, cursor: &mut Cursor) -> Option<Exit>;

    /// The divergence at `at` of the arm nearest to `heading`, in 1/m.
    ///
    /// For a unit field d = (cos u, sin u) it equals the derivative of the
    /// angle u along the left normal: positive where neighbouring streamlines
    /// spread. It changes sign with the direction of travel.
    ///
    /// The default is a central difference of [`direction`](Self::direction)
    /// over [`difference_step`](Self::difference_step) to either side, one-sided
    /// next to the boundary.
    fn divergence(&self, at: Coord<f64>, heading: Coord<f64>, cursor: &mut Cursor) -> Option<f64> {
        let here = self.direction(at, heading, cursor)?;
        let normal = left(here) * self.difference_step();
        let to_left = self.direction(at + normal, here, cursor);
        let to_right = self.direction(at - normal, here, cursor);
        let (change, sides) = match (to_right, to_left) {
            (Some(right), Some(left)) => (turn(right, here) + turn(here, left), 2.0),
            (None, Some(left)) => (turn(here, left), 1.0),
            (Some(right), None) => (turn(right, here), 1.0),
            (None, None) => return None,
        };
        Some(change / (sides * self.difference_step()))
    }

    /// How far [`divergence`](Self::divergence) looks to either side, in
    /// metres.
    ///
    /// Default value: 0.1 m. Replace it where the domain has another scale.
    fn difference_step(&self) -> f64 {
        0.1
    }
}

impl<T: DirectionField + ?Sized> DirectionField for &T {
    fn direction(
        &self,
        at: Coord<f64>,
        heading: Coord<f64>,
        cursor: &mut Cursor,
    ) -> Option<Coord<f64>> {
        (**self).direction(at, heading, cursor)
    }

    fn exit(&self, from: Coord<f64>, to: Coord<f64>, cursor: &mut Cursor) -> Option<Exit> {
        (**self).exit(from, to, cursor)
    }

    fn divergence(&self, at: Coord<f64>, heading: Coord<f64>, cursor: &mut Cursor) -> Option<f64> {
        (**self).divergence(at, heading, cursor)
    }

    fn difference_step(&self) -> f64 {
        (**self).difference_step()
    }
}

/// The arm nearest to `heading` of the cross one of whose arms points along
/// `angle` (radians, from east towards north).
///
/// Turns a formula for the angle of a cross into a [`from_fn`] field.
///
/// # Examples
///
/// ```
/// use streamline::{arm_nearest, geo_types::coord};
///
/// let arm = arm_nearest(0.1, coord! { x: 0.0, y: -3.0 });
/// assert!((arm.x - 0.1_f64.sin()).abs() < 1e-15 && (arm.y + 0.1_f64.cos()).abs() < 1e-15);
/// ```
#[must_use]
pub fn arm_nearest(angle: f64, heading: Coord<f64>) -> Coord<f64> {
    let (sin, cos) = angle.sin_cos();
    let along = cos * heading.x + sin * heading.y;
    let across = cos * heading.y - sin * heading.x;
    let (x, y) = if along.abs() >= across.abs() {
        (cos, sin)
    } else {
        (-sin, cos)
    };
    let sign = if x * heading.x + y * heading.y < 0.0 {
        -1.0
    } else {
        1.0
    };
    Coord {
        x: sign * x,
        y: sign * y,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{dot, point};

    #[test]
    fn arm_nearest_is_within_45_degrees() {
        for i in 0..64 {
            for j in 0..64 {
                let heading = point((i as f64 * 0.1).cos(), (i as f64 * 0.1).sin());
                let arm = arm_nearest(j as f64 * 0.37, heading);
                assert!(dot(arm, heading) > std::f64::consts::FRAC_1_SQRT_2 - 1e-12);
            }
        }
    }

    /// Directions only: what the default divergence makes of them.
    struct Radial;
    impl DirectionField for Radial {
        fn direction(
            &self,
            at: Coord<f64>,
            heading: Coord<f64>,
            _: &mut Cursor,
        ) -> Option<Coord<f64>> {
            (at.y >= 0.0).then(|| arm_nearest(at.y.atan2(at.x), heading))
        }
        fn exit(&self, _: Coord<f64>, _: Coord<f64>, _: &mut Cursor) -> Option<Exit> {
            None
        }
    }

    #[test]
    fn default_divergence_of_a_radial_field() {
        // div of the unit radial field is 1/r, of the tangential one 0.
        let mut cursor = Cursor::default();
        let at = point(30.0, 40.0);
        let radial = Radial.divergence(at, at, &mut cursor).unwrap();
        assert!((radial - 0.02).abs() < 1e-7, "{radial}");
        let reversed = (&Radial as &dyn DirectionField)
            .divergence(at, at * -1.0, &mut cursor)
            .unwrap();
        assert!((reversed + 0.02).abs() < 1e-7, "{reversed}");
        let tangential = Radial.divergence(at, left(at), &mut cursor).unwrap();
        assert!(tangential.abs() < 1e-7, "{tangential}");
        // On the edge of the half plane only one side has a direction.
        let edge = Radial
            .divergence(point(50.0, 0.0), point(1.0, 0.0), &mut cursor)
            .unwrap();
        assert!((edge - 0.02).abs() < 1e-6, "{edge}");
    }
}
