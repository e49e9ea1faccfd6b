//! The polygon to be split, with the meaning of its edges.

use crate::error::WarpError;
use crate::geometry::{exceeds, self_contact, signed_area, P};

/// What lies on the other side of a region's boundary edge (paper, Fig. 4:
/// "edges can be constrained to have certain neighbors").
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeUse {
    /// A street that gives access.
    Street,
    /// Anything else: another parcel, a lake, a motorway, the end of the site.
    NoStreet,
}

/// A simple polygon with a use for each boundary edge and a region label.
///
/// # Shape
///
/// `ring` is counter-clockwise and open; edge i runs from vertex i to vertex
/// i + 1 (cyclically). Metres.
///
/// ```
/// use template_warp::{geo_types::coord, EdgeUse, Region};
///
/// let ring = vec![
///     coord! { x: 0.0, y: 0.0 }, coord! { x: 90.0, y: 0.0 },
///     coord! { x: 90.0, y: 60.0 }, coord! { x: 0.0, y: 60.0 },
/// ];
/// let region = Region::new(ring, vec![EdgeUse::Street; 4], "block")?;
/// assert_eq!(region.area(), 5400.0);
/// # Ok::<(), template_warp::WarpError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    ring: Vec<P>,
    uses: Vec<EdgeUse>,
    label: String,
}

impl Region {
    /// Checks and keeps a region. A clockwise ring is reversed together with
    /// its uses.
    ///
    /// # Errors
    ///
    /// [`WarpError::TooFewVertices`], [`WarpError::UseCount`],
    /// [`WarpError::NonFinite`], [`WarpError::RepeatedVertex`],
    /// [`WarpError::ZeroArea`] and [`WarpError::SelfIntersection`], each with
    /// the place of the fault.
    pub fn new(mut ring: Vec<P>, mut uses: Vec<EdgeUse>, label: &str) -> Result<Self, WarpError> {
        let n = ring.len();
        if n < 3 {
            return Err(WarpError::TooFewVertices { count: n });
        }
        if uses.len() != n {
            return Err(WarpError::UseCount {
                edges: n,
                uses: uses.len(),
            });
        }
        if let Some(index) = ring
            .iter()
            .position(|q| !(q.x.is_finite() && q.y.is_finite()))
        {
            return Err(WarpError::NonFinite { index });
        }
        if let Some(index) = (0..n).find(|&i| ring[i] == ring[(i + 1) % n]) {
            return Err(WarpError::RepeatedVertex {
                index,
                x: ring[index].x,
                y: ring[index].y,
            });
        }
        let area = signed_area(&ring);
        let size = ring
            .iter()
            .map(|q| (q.x - ring[0].x).hypot(q.y - ring[0].y))
            .fold(0.0, f64::max);
        if !exceeds(area.abs(), 1e-12 * size * size) {
            return Err(WarpError::ZeroArea { count: n });
        }
        if let Some((first, second)) = self_contact(&ring) {
            return Err(WarpError::SelfIntersection { first, second });
        }
        if area < 0.0 {
            // Edge i of the reversed ring joins old vertices n-1-i and n-2-i,
            // which is old edge n-2-i.
            ring.reverse();
            uses.reverse();
            uses.rotate_left(1);
        }
        Ok(Self {
            ring,
            uses,
            label: label.to_owned(),
        })
    }

    /// The boundary, counter-clockwise, the first vertex not repeated.
    #[must_use]
    pub fn ring(&self) -> &[P] {
        &self.ring
    }

    /// Use of each edge, in the order of [`Region::ring`].
    #[must_use]
    pub fn uses(&self) -> &[EdgeUse] {
        &self.uses
    }

    /// The region label that a template must carry to match.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.label
    }

    /// Area in square metres.
    #[must_use]
    pub fn area(&self) -> f64 {
        signed_area(&self.ring)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::p;

    #[test]
    fn a_clockwise_ring_is_reversed_with_its_uses() {
        use EdgeUse::{NoStreet, Street};
        let ring = vec![p(0., 0.), p(0., 1.), p(2., 1.), p(2., 0.)];
        let region = Region::new(ring, vec![NoStreet, Street, Street, Street], "block").unwrap();
        assert!(region.area() > 0.0);
        // The use without street belongs to the edge x = 0 either way.
        let i = region.uses().iter().position(|&u| u == NoStreet).unwrap();
        assert_eq!(region.ring()[i].x, 0.0);
        assert_eq!(region.ring()[(i + 1) % 4].x, 0.0);
    }

    #[test]
    fn every_fault_has_its_own_error() {
        let uses = |n| vec![EdgeUse::Street; n];
        let make = |ring: Vec<P>, n| Region::new(ring, uses(n), "block").unwrap_err();
        let square = vec![p(0., 0.), p(1., 0.), p(1., 1.), p(0., 1.)];
        assert!(matches!(
            make(square[..2].to_vec(), 2),
            WarpError::TooFewVertices { count: 2 }
        ));
        assert!(matches!(
            make(square.clone(), 3),
            WarpError::UseCount { edges: 4, uses: 3 }
        ));
        let mut bad = square.clone();
        bad[2].y = f64::NAN;
        assert!(matches!(make(bad, 4), WarpError::NonFinite { index: 2 }));
        let mut bad = square.clone();
        bad[0] = bad[3];
        assert!(matches!(
            make(bad, 4),
            WarpError::RepeatedVertex { index: 3, .. }
        ));
        assert!(matches!(
            make(vec![p(0., 0.), p(1., 1.), p(2., 2.)], 3),
            WarpError::ZeroArea { .. }
        ));
        assert!(matches!(
            make(vec![p(0., 0.), p(2., 2.), p(3., 0.), p(0., 3.)], 4),
            WarpError::SelfIntersection {
                first: 0,
                second: 2
            }
        ));
    }
}
