//! Footpoints for a caller: which part of the boundary rules a point.

use geo_types::Coord;

use super::sites::{Foot, Search, Sites};
use super::DistanceField;
use crate::cross::Cross;
use crate::domain::Domain;
use crate::plane::coord;
use crate::FieldError;

/// A normal footpoint of a point on the boundary, see [`Footpoints`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Footpoint {
    /// Where it is. For a concave corner that counts by its tangents, the
    /// footpoint on the tangent, which lies off the boundary.
    pub point: Coord<f64>,
    /// Its ring, 0 for the exterior.
    pub ring: usize,
    /// Its edge in the input ring; for a vertex, the edge after it as one
    /// walks with the domain on the left.
    pub edge: usize,
    /// Distance over weight, metres: the nearest footpoint has the smallest.
    pub weighted_distance: f64,
    /// The cross that it gives, parallel and normal to the line to it. Where
    /// several footpoints are equally near, [`Footpoints::nearest`] gives
    /// their average.
    pub cross: Cross,
}

/// The weighted normal footpoints of a D-field, for any point of its domain.
///
/// Made by [`DistanceField::footpoints`].
///
/// ```
/// use crossfield::{geo_types::{coord, polygon}, DistanceField, Domain, DomainOptions};
///
/// let site = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 60., y: 40.), (x: 0., y: 40.)];
/// let domain = Domain::new(&site, &DomainOptions::default())?;
/// let design = DistanceField::default();
/// let footpoints = design.footpoints(&domain)?;
/// let at = coord! { x: 20.0, y: 10.0 };
/// let foot = footpoints.nearest(at).expect("inside");
/// assert_eq!((foot.edge, foot.point), (0, coord! { x: 20.0, y: 0.0 }));
/// let all: Vec<f64> = footpoints.all(at).iter().map(|f| f.weighted_distance).collect();
/// assert_eq!(all, [10.0, 20.0, 30.0, 40.0]);
/// # Ok::<(), crossfield::FieldError>(())
/// ```
#[derive(Debug)]
pub struct Footpoints<'a> {
    domain: &'a Domain,
    sites: Sites<'a>,
}

impl DistanceField {
    /// The footpoints that this design chooses from on `domain`.
    ///
    /// # Errors
    ///
    /// As [`design`](crate::FieldDesign::design).
    ///
    /// # Complexity
    ///
    /// O(e log e) in the number of boundary edges.
    pub fn footpoints<'a>(&self, domain: &'a Domain) -> Result<Footpoints<'a>, FieldError> {
        let weights = self.edge_weights(domain)?;
        Ok(Footpoints {
            domain,
            sites: self.sites(domain, &weights),
        })
    }
}

impl Footpoints<'_> {
    /// The footpoint of the smallest weighted distance; `None` for a point
    /// outside that has none.
    ///
    /// # Complexity
    ///
    /// Expected O(log e).
    #[must_use]
    pub fn nearest(&self, at: Coord<f64>) -> Option<Footpoint> {
        let p = self.domain.local(at);
        let found = self.sites.nearest(p, &mut Search::default())?;
        self.named(found)
    }

    /// All normal footpoints, by weighted distance: O(e), since each edge and
    /// each concave vertex is tried.
    #[must_use]
    pub fn all(&self, at: Coord<f64>) -> Vec<Footpoint> {
        let feet = self.sites.all(self.domain.local(at));
        feet.into_iter().filter_map(|f| self.named(f)).collect()
    }

    fn named(&self, (site, foot): (usize, Foot)) -> Option<Footpoint> {
        let inner = &*self.domain.inner;
        let (ring, edge) = self.sites.name(site);
        let edge = inner.rings[ring as usize].input_edge[edge as usize];
        Some(Footpoint {
            point: coord(foot.point + inner.frame.origin),
            ring: ring as usize,
            edge: edge as usize,
            weighted_distance: foot.weighted,
            cross: Cross::from_vector(foot.cross)?,
        })
    }
}
