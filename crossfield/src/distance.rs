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

use crate::domain::{Domain, Ring};
use crate::field::{smooth, Field, FieldDesign};
use crate::footpoint::{Bound, Tree};
use crate::plane::{fourth_power, left, V2};
use crate::FieldError;
use nalgebra::Rotation2;

/// The distance field (D-field) of a domain.
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
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DistanceField {
    /// Influence of each boundary edge: for each ring of the input polygon,
    /// one positive number for each of its edges. An edge of weight 2 reaches
    /// twice as far as one of weight 1.
    ///
    /// An empty list, of rings or for one ring, stands for 1 everywhere.
    /// Weights should be constant along each smooth piece of the boundary, as
    /// in the paper: a change in between makes the field jump there.
    ///
    /// Default value: empty.
    pub weights: Vec<Vec<f64>>,
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
}

impl Default for DistanceField {
    fn default() -> Self {
        Self {
            weights: Vec::new(),
            smoothing_rounds: 1,
            concave_tangents: true,
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
        let sites = Sites::new(&domain.inner.rings, &weights, self.concave_tangents);
        let mut crosses = boundary_crosses(domain, &weights);
        let mut last = None;
        for v in domain.inner_vertices() {
            let p = domain.inner.mesh.points[v];
            let (site, cross) = sites.nearest(p, last);
            last = site.or(last);
            crosses[v] = cross;
        }
        smooth(domain, &mut crosses, self.smoothing_rounds);
        Field::from_vectors(domain, crosses)
    }
}

impl DistanceField {
    /// Weights by cleaned ring and edge.
    fn edge_weights(&self, domain: &Domain) -> Result<Vec<Vec<f64>>, FieldError> {
        let rings = &domain.inner.rings;
        if !self.weights.is_empty() && self.weights.len() != rings.len() {
            return Err(FieldError::option(
                "weights",
                format!(
                    "has {} rings, the domain has {}; give one list a ring, or none",
                    self.weights.len(),
                    rings.len()
                ),
            ));
        }
        let mut all = Vec::with_capacity(rings.len());
        for (index, ring) in rings.iter().enumerate() {
            let given = self.weights.get(index).map_or(&[][..], Vec::as_slice);
            if given.is_empty() {
                all.push(vec![1.0; ring.len()]);
                continue;
            }
            if given.len() != ring.input_edges {
                return Err(FieldError::option(
                    "weights",
                    format!(
                        "has {} numbers for ring {index}, which has {} edges; give one an edge",
                        given.len(),
                        ring.input_edges
                    ),
                ));
            }
            if let Some(bad) = given.iter().position(|w| !(1e-6..=1e6).contains(w)) {
                return Err(FieldError::option(
                    "weights",
                    format!(
                        "is {} for edge {bad} of ring {index}; give 1e-6 to 1e6",
                        given[bad]
                    ),
                ));
            }
            all.push(ring.input_edge.iter().map(|&k| given[k as usize]).collect());
        }
        Ok(all)
    }
}

/// Crosses of the boundary vertices, aligned with their edges; zero inside.
///
/// Where two edges meet, the average of their representation vectors; where
/// that vanishes (they meet at an odd multiple of 45 degrees), the heavier
/// edge, or else the first.
fn boundary_crosses(domain: &Domain, weights: &[Vec<f64>]) -> Vec<V2> {
    let inner = &*domain.inner;
    let mut sums = vec![V2::zeros(); inner.mesh.points.len()];
    let mut heaviest = vec![(0.0, V2::zeros()); sums.len()];
    for border in &inner.mesh.borders {
        let ring = border.ring as usize;
        let edge = border.edge as usize;
        let cross = fourth_power(inner.rings[ring].direction(edge));
        let weight = weights[ring][edge];
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

/// What a footpoint can lie on.
#[derive(Clone, Copy, Debug)]
enum Site {
    /// The inside of an edge.
    Edge {
        start: V2,
        direction: V2,
        length: f64,
        per_weight: f64,
        cross: V2,
    },
    /// A concave vertex that is turned around.
    Turn {
        at: V2,
        before: V2,
        after: V2,
        per_weight: f64,
    },
    /// A concave corner that counts by its tangents.
    Tangents {
        at: V2,
        before: V2,
        after: V2,
        per_weight: [f64; 2],
        crosses: [V2; 2],
    },
}

impl Site {
    /// Weighted distance from `p` to the footpoint here, if there is one, and
    /// the representation vector of the cross it gives.
    fn foot(&self, p: V2, slack: f64) -> Option<(f64, V2)> {
        match *self {
            Self::Edge {
                start,
                direction,
                length,
                per_weight,
                cross,
            } => {
                let d = p - start;
                let along = direction.dot(&d);
                let height = left(direction).dot(&d);
                (height >= -slack && along >= -slack && along <= length + slack)
                    .then(|| (height.max(0.0) * per_weight, cross))
            }
            Self::Turn {
                at,
                before,
                after,
                per_weight,
            } => {
                let d = p - at;
                let length = d.norm();
                (before.dot(&d) >= 0.0 && after.dot(&d) <= 0.0 && length > slack)
                    .then(|| (length * per_weight, fourth_power(d)))
            }
            Self::Tangents {
                at,
                before,
                after,
                per_weight,
                crosses,
            } => {
                let d = p - at;
                if before.dot(&d) < 0.0 || after.dot(&d) > 0.0 {
                    return None;
                }
                let first = left(before).dot(&d) * per_weight[0];
                let second = left(after).dot(&d) * per_weight[1];
                Some(if first >= second {
                    (first, crosses[0])
                } else {
                    (second, crosses[1])
                })
            }
        }
    }
}

/// All places for footpoints, in a tree.
struct Sites {
    sites: Vec<Site>,
    tree: Tree,
    slack: f64,
}

impl Sites {
    fn new(rings: &[Ring], weights: &[Vec<f64>], tangents: bool) -> Self {
        let mut sites = Vec::new();
        let mut bounds = Vec::new();
        let mut size = 0.0_f64;
        for (ring, weights) in rings.iter().zip(weights) {
            for (k, &weight) in weights.iter().enumerate() {
                let (a, b) = ring.edge(k);
                size = size.max(a.amax());
                let direction = ring.direction(k);
                sites.push(Site::Edge {
                    start: a,
                    direction,
                    length: (b - a).norm(),
                    per_weight: weight.recip(),
                    cross: fourth_power(direction),
                });
                bounds.push(Bound::of_segment(a, b, weight));
            }
            for k in (0..ring.len()).filter(|&k| ring.turn[k] < 0.0) {
                let at = ring.points[k];
                let sides = [ring.previous(k), k];
                let [before, after] = sides.map(|e| ring.direction(e));
                let pair = sides.map(|e| weights[e]);
                let heavier = pair[0].max(pair[1]);
                if !(ring.corner[k] && tangents) {
                    sites.push(Site::Turn {
                        at,
                        before,
                        after,
                        per_weight: heavier.recip(),
                    });
                    bounds.push(Bound::of_segment(at, at, heavier));
                    continue;
                }
                let turn = ring.turn[k];
                // A sharper corner is capped: half its turn at either end.
                let cap = Rotation2::new(turn / 2.0) * before;
                let mean = (pair[0] + pair[1]) / 2.0;
                let capped = [
                    ([before, cap], [pair[0], mean], turn / 2.0),
                    ([cap, after], [mean, pair[1]], turn / 2.0),
                ];
                let plain = [([before, after], pair, turn)];
                let corners = if turn < -CAPPED {
                    &capped[..]
                } else {
                    &plain[..]
                };
                for &([before, after], pair, turn) in corners {
                    sites.push(Site::Tangents {
                        at,
                        before,
                        after,
                        per_weight: pair.map(f64::recip),
                        crosses: [before, after].map(fourth_power),
                    });
                    // In the cone between the two normals one of the tangents
                    // is at least this part of the distance to `at` away.
                    let part = (turn / 2.0).cos();
                    bounds.push(Bound::of_segment(at, at, heavier / part));
                }
            }
        }
        Self {
            sites,
            tree: Tree::new(&bounds),
            slack: 1e-12 * size,
        }
    }

    /// The best site for `p` and its cross, zero if there is none.
    ///
    /// Sites at equal distances are averaged. Ties do happen: refinement
    /// places vertices at circumcentres, equally far from three vertices of
    /// the boundary, where rounding would choose otherwise in each direction
    /// of the compass.
    ///
    /// `hint`, the site of a point nearby, gives a first bound.
    fn nearest(&self, p: V2, hint: Option<usize>) -> (Option<usize>, V2) {
        let distance = |k: usize| self.sites[k].foot(p, self.slack).map(|(d, _)| d);
        // Widened a little: the hint itself must be found again, and ties
        // must not depend on what the hint was.
        let limit = hint
            .and_then(distance)
            .map_or(f64::INFINITY, |d| d * (1.0 + TIE) + self.slack);
        let Some((best, least)) = self.tree.nearest(p, limit, distance) else {
            return (None, V2::zeros());
        };
        let tie = least * (1.0 + TIE) + self.slack;
        let mut sum = V2::zeros();
        self.tree.within(p, tie, |k| {
            if let Some((_, cross)) = self.sites[k].foot(p, self.slack).filter(|&(d, _)| d <= tie) {
                sum += cross;
            }
        });
        let alone = || self.sites[best].foot(p, self.slack);
        let cross = sum
            .try_normalize(1e-6)
            .or_else(|| alone().map(|(_, cross)| cross));
        (Some(best), cross.unwrap_or_else(V2::zeros))
    }
}

/// Weighted distances this near to each other, in parts, are equal.
const TIE: f64 = 1e-9;

/// Concave turns beyond this, 135 degrees, are capped.
const CAPPED: f64 = 0.75 * std::f64::consts::PI;

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
    fn the_tree_agrees_with_trying_all_sites() {
        let domain = bent();
        let weights = vec![vec![1.0, 2.0, 0.5, 1.5, 1.0, 3.0]];
        for tangents in [false, true] {
            let sites = Sites::new(&domain.inner.rings, &weights, tangents);
            for &p in &domain.inner.mesh.points {
                let slow = (0..sites.sites.len())
                    .filter_map(|k| sites.sites[k].foot(p, sites.slack).map(|(d, _)| d))
                    .min_by(f64::total_cmp);
                let (site, _) = sites.nearest(p, Some(3));
                let fast = site.and_then(|k| sites.sites[k].foot(p, sites.slack));
                assert_eq!(fast.map(|(d, _)| d), slow);
            }
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
