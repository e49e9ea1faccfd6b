//! D-fields: crosses along the gradient of the distance to the boundary.
//!
//! Supplement of Yang et al. 2013, section 4.1. For each vertex of the mesh,
//! of all normal footpoints on the boundary the one with the smallest
//! distance over weight is taken, and the cross is parallel and normal to the
//! line to it. Concave corners are treated as in a straight skeleton: not the
//! distance to the corner counts, but the larger of the distances to its two
//! tangents. A few rounds of smoothing then remove what jumps on the medial
//! axis.
//!
//! Differs from the paper in three points: an edge counts only for points on
//! its inner side (with weights, the other side of a thin hole could win
//! otherwise), and a concave turn beyond 135 degrees counts as two corners of
//! half the turn, with a cap tangent across its end. And where footpoints are
//! equally near, their crosses are averaged instead of one being chosen.

mod footpoints;
mod sites;
mod weights;

use crate::domain::Domain;
use crate::field::{smooth, smooth_over, Field, FieldDesign};
use crate::plane::{fourth_power, V2};
use crate::FieldError;
pub use footpoints::{Footpoint, Footpoints};
use sites::{Search, Sites};
use weights::EdgeWeight;

/// The distance field (D-field) of a domain.
///
#[doc = include_str!("../../images/d-field.svg")]
///
/// ```
/// use crossfield::{geo_types::{coord, polygon}, Cursor, DistanceField, Domain, DomainOptions,
///     FieldDesign};
///
/// // On a rectangle a D-field is constant.
/// let site = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 60., y: 40.), (x: 0., y: 40.)];
/// let domain = Domain::new(&site, &DomainOptions::default())?;
/// let field = DistanceField::default().design(&domain)?;
/// let cross = field.cross(coord! { x: 20.0, y: 21.0 }, &mut Cursor::default());
/// assert!(cross.expect("inside").angle().abs() < 1e-12);
/// # Ok::<(), crossfield::FieldError>(())
/// ```
///
#[doc = include_str!("../../images/d-field.svg")]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DistanceField {
    /// Influence of the boundary: for each ring of the input polygon one
    /// positive number for each of its edges, vertices or smooth pieces, as
    /// `weighting` says. What has weight 2 reaches twice as far as what has 1.
    ///
    /// An empty list, of rings or for one ring, stands for 1 everywhere.
    /// Weights of edges should be constant along each smooth piece of the
    /// boundary, as in the paper: a change in between makes the field jump
    /// there.
    ///
    /// Default value: empty.
    pub weights: Vec<Vec<f64>>,
    /// What the numbers in `weights` belong to.
    ///
    /// Default value: the edges.
    pub weighting: Weighting,
    /// Rounds of smoothing over the inner vertices, each vertex averaged with
    /// its neighbours.
    ///
    /// Default value: 1 (the paper's).
    pub smoothing_rounds: usize,
    /// Whether concave corners count by their tangents (as in a straight
    /// skeleton) instead of turning the crosses around them.
    ///
    /// Default value: true (the paper's).
    pub concave_tangents: bool,
    /// Which footpoints count.
    ///
    /// Default value: all, hidden ones too (the paper's).
    pub sight: Sight,
    /// Whether vertices on the [medial axis](Self::medial_axis) take part in
    /// smoothing.
    ///
    /// Default value: they do (the 2013 paper's).
    pub medial_axis: MedialAxis,
}

/// What the numbers in [`DistanceField::weights`] belong to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Weighting {
    /// The edges of each input ring: number `i` to the edge from vertex `i` to
    /// `i + 1`.
    #[default]
    Edges,
    /// The vertices of each input ring; in between, the weight is linear along
    /// each edge, so that it is continuous.
    Vertices,
    /// The smooth pieces of each ring, in the order of [`Domain::pieces`]: the
    /// paper's choice.
    Pieces,
}

/// Which footpoints of a [`DistanceField`] count.
///
/// It makes a difference with unequal weights and at concave corners that
/// count by their tangents: the nearest boundary point of all is always seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Sight {
    /// All of them.
    #[default]
    Through,
    /// Only those that the straight way leads to without leaving the domain:
    /// none behind a hole or a reflex corner.
    Clear,
}

/// Whether the medial axis takes part in the smoothing of a
/// [`DistanceField`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MedialAxis {
    /// Its vertices are averaged as all others.
    #[default]
    Averaged,
    /// Its vertices are averages of their neighbours, but give nothing to
    /// them: what jumps at the axis is not carried into the field, and the
    /// axis itself is filled from both sides (after UrbanFab, which leaves it
    /// out of its seeds).
    LeftOut,
}

impl Default for DistanceField {
    fn default() -> Self {
        Self {
            weights: Vec::new(),
            smoothing_rounds: 1,
            concave_tangents: true,
            weighting: Weighting::Edges,
            sight: Sight::Through,
            medial_axis: MedialAxis::Averaged,
        }
    }
}

impl FieldDesign for DistanceField {
    /// The D-field of `domain`.
    ///
    /// Boundary vertices are aligned with the boundary, and stay so.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if the weights do not fit the rings of the
    /// domain, or one is not positive and finite.
    ///
    /// # Complexity
    ///
    /// Expected O(log e) a vertex, e the number of boundary edges, and
    /// O(vertices) a round of smoothing.
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        let weights = self.edge_weights(domain)?;
        let (mut crosses, feet) = self.crosses(domain, &weights);
        match self.medial_axis {
            MedialAxis::Averaged => smooth(domain, &mut crosses, self.smoothing_rounds),
            MedialAxis::LeftOut => {
                let medial = medial_vertices(domain, &feet);
                smooth_over(domain, &mut crosses, self.smoothing_rounds, |v| !medial[v]);
            }
        }
        Field::from_vectors(domain, crosses)
    }
}

impl DistanceField {
    fn sites<'a>(&self, domain: &'a Domain, weights: &[Vec<EdgeWeight>]) -> Sites<'a> {
        Sites::new(
            domain,
            weights,
            self.concave_tangents,
            self.sight == Sight::Clear,
        )
    }

    /// For each vertex of `domain` whether it lies on the medial axis, as far
    /// as the mesh shows it: inside, and with a neighbour whose footpoint is
    /// farther from its own than three times the length of the edge between
    /// them. Where the boundary is seen by one footpoint, that moves little
    /// faster than the point itself.
    ///
    /// UrbanFab leaves these vertices out when it seeds streamlines, since
    /// fields jump there ("Distance field": "seedpoints on the medial axis can
    /// be excluded").
    ///
    /// # Errors
    ///
    /// As [`design`](FieldDesign::design).
    pub fn medial_axis(&self, domain: &Domain) -> Result<Vec<bool>, FieldError> {
        let weights = self.edge_weights(domain)?;
        let (_, feet) = self.crosses(domain, &weights);
        Ok(medial_vertices(domain, &feet))
    }

    /// Crosses of all vertices, before smoothing, and their footpoints.
    fn crosses(&self, domain: &Domain, weights: &[Vec<EdgeWeight>]) -> (Vec<V2>, Vec<V2>) {
        let sites = self.sites(domain, weights);
        let mut crosses = boundary_crosses(domain, weights);
        let mut feet = domain.inner.mesh.points.clone();
        let mut search = Search::default();
        for v in domain.inner_vertices() {
            if let Some((_, foot)) = sites.nearest(domain.inner.mesh.points[v], &mut search) {
                crosses[v] = foot.cross;
                feet[v] = foot.point;
            }
        }
        (crosses, feet)
    }
}

/// See [`DistanceField::medial_axis`].
fn medial_vertices(domain: &Domain, feet: &[V2]) -> Vec<bool> {
    let points = &domain.inner.mesh.points;
    let jumps = |v: usize, w: usize| {
        (feet[v] - feet[w]).norm_squared() > 9.0 * (points[v] - points[w]).norm_squared()
    };
    (0..points.len())
        .map(|v| {
            !domain.is_boundary(v) && domain.neighbours(v).iter().any(|&w| jumps(v, w as usize))
        })
        .collect()
}

/// Crosses of the boundary vertices, aligned with their edges; zero inside.
///
/// Where two edges meet, the average of their representation vectors; where
/// that vanishes (they meet at an odd multiple of 45 degrees), the heavier
/// edge, or else the first.
fn boundary_crosses(domain: &Domain, weights: &[Vec<EdgeWeight>]) -> Vec<V2> {
    let inner = &*domain.inner;
    let mut sums = vec![V2::zeros(); inner.mesh.points.len()];
    let mut heaviest = vec![(0.0, V2::zeros()); sums.len()];
    for border in &inner.mesh.borders {
        let ring = border.ring as usize;
        let edge = border.edge as usize;
        let cross = fourth_power(inner.rings[ring].direction(edge));
        let weight = weights[ring][edge].mean();
        for v in [border.from as usize, border.to as usize] {
            sums[v] += cross;
            if weight > heaviest[v].0 {
                heaviest[v] = (weight, cross);
            }
        }
    }
    for (sum, (_, cross)) in sums.iter_mut().zip(heaviest) {
        let length = sum.norm();
        if length > 1e-6 {
            *sum /= length;
        } else {
            *sum = cross;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cross, Cursor, DomainOptions};
    use geo_types::{coord, polygon, Coord};

    fn angle_at(field: &Field, at: Coord<f64>) -> f64 {
        let cross = field.cross(at, &mut Cursor::default());
        cross.expect("a cross inside").angle().to_degrees()
    }

    /// An L whose concave corner at (5, 5) is seen from the south-west.
    fn bent() -> Domain {
        let shape = polygon![(x: 0., y: 0.), (x: 10., y: 0.), (x: 10., y: 4.), (x: 5., y: 5.),
            (x: 4., y: 10.), (x: 0., y: 10.)];
        Domain::new(&shape, &DomainOptions::default()).expect("valid")
    }

    #[test]
    fn tangents_keep_crosses_from_turning_around_a_concave_corner() {
        let domain = bent();
        let plain = DistanceField {
            concave_tangents: false,
            smoothing_rounds: 0,
            ..DistanceField::default()
        };
        let straight = DistanceField {
            smoothing_rounds: 0,
            ..DistanceField::default()
        };
        // Towards the corner along the normal of (-1, -0.6).
        let at = coord! {x: 5.0 - 1.5, y: 5.0 - 0.9};
        let turned = angle_at(&plain.design(&domain).expect("design"), at);
        let towards = (0.6_f64 / 1.0).atan().to_degrees();
        assert!((turned - towards).abs() < 2.0, "{turned} {towards}");
        // The steeper tangent is the one from (5, 5) to (4, 10), whose
        // direction is 11.3 degrees off the axis.
        let kept = angle_at(&straight.design(&domain).expect("design"), at);
        assert!((kept.abs() - 11.31).abs() < 0.01, "{kept}");
    }

    #[test]
    fn a_heavy_edge_reaches_farther() {
        let shape = polygon![(x: 0., y: 0.), (x: 10., y: 0.), (x: 10., y: 6.), (x: 0., y: 10.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let at = coord! {x: 5.0, y: 2.0};
        let even = DistanceField::default().design(&domain).expect("design");
        assert!(angle_at(&even, at).abs() < 1e-9);
        let heavy = DistanceField {
            weights: vec![vec![1.0, 1.0, 5.0, 1.0]],
            ..DistanceField::default()
        };
        let heavy = heavy.design(&domain).expect("design");
        let slope = (-0.4_f64).atan().to_degrees();
        assert!((angle_at(&heavy, at) - slope).abs() < 1e-9);
    }

    #[test]
    fn bad_weights_are_refused() {
        let domain = bent();
        for weights in [
            vec![vec![1.0; 5]],
            vec![vec![1.0; 6], vec![]],
            vec![vec![1.0, 1.0, 0.0, 1.0, 1.0, 1.0]],
            vec![vec![1.0, 1.0, f64::NAN, 1.0, 1.0, 1.0]],
        ] {
            let design = DistanceField {
                weights,
                ..DistanceField::default()
            };
            assert!(matches!(
                design.design(&domain),
                Err(FieldError::BadOption {
                    option: "weights",
                    ..
                })
            ));
        }
    }

    #[test]
    fn the_end_of_a_slit_is_capped() {
        // A given road, 0.2 wide, ends in the middle of a square: its end has
        // two corners, and a sharp tip one that is capped.
        let tip = polygon![(x: 0., y: 0.), (x: 10., y: 0.), (x: 10., y: 10.), (x: 5.1, y: 10.),
            (x: 5., y: 5.), (x: 4.9, y: 10.), (x: 0., y: 10.)];
        let domain = Domain::new(&tip, &DomainOptions::default()).expect("valid");
        let field = DistanceField::default().design(&domain).expect("design");
        let below = field.cross(coord! {x: 5.3, y: 4.4}, &mut Cursor::default());
        let off = below.expect("inside").deviation(&Cross::from_angle(0.0));
        assert!(off.to_degrees() < 1.5);
    }
}
