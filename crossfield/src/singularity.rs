//! Singularities of a field and their index laws.
//!
//! A singularity is a zero of the representation vectors; its index is counted
//! in quarter turns of the cross, which is the winding of D around it. They
//! are found triangle by triangle (Palacios and Zhang 2007).

use geo_types::Coord;

use crate::cross::QUARTER;
use crate::domain::Border;
use crate::field::Field;
use crate::plane::{coord, wedge, wrapped, V2};

/// A point without a cross.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Singularity {
    /// Where it is.
    pub at: Coord<f64>,
    /// Quarter turns of the cross on a way around it, counter-clockwise
    /// positive: +1 where three streets meet, -1 where five do.
    ///
    /// In a field of N arms, turns of `1 / N`: what D winds.
    pub quarter_index: i32,
}

/// The numbers that the index laws are about, see [`Field::index_check`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct IndexCheck {
    /// Sum of the quarter indices of all triangles.
    pub interior: i32,
    /// Winding of D along all rings, the domain on their left.
    pub boundary_winding: i32,
    /// Sum over the boundary's vertices of their turn, each rounded to quarter
    /// turns (N-th turns for N arms): convex ones positive, concave ones negative. A turn of less
    /// than 45 degrees counts 0, so the smooth turning of a curve does not.
    pub corners: i32,
    /// Euler characteristic of the mesh.
    pub euler: i32,
    /// The number N of arms: 4 for crosses.
    pub folds: i32,
    /// Whether the field follows the boundary everywhere, see
    /// [`Field::is_boundary_aligned`].
    pub aligned: bool,
}

impl IndexCheck {
    /// Whether the sum over the triangles is the winding along the boundary:
    /// true for every field.
    #[must_use]
    pub fn winding_law(&self) -> bool {
        self.interior == self.boundary_winding
    }

    /// Whether the indices of triangles and corners add up to N times (for
    /// crosses four times) the
    /// Euler characteristic (Poincare and Hopf): true for every field that
    /// follows the boundary on a mesh which resolves it.
    #[must_use]
    pub fn boundary_law(&self) -> bool {
        self.interior + self.corners == self.folds * self.euler
    }

    /// Whether both laws hold, the second where it applies: the public check
    /// of a field.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.winding_law() && (!self.aligned || self.boundary_law())
    }
}

impl std::fmt::Display for IndexCheck {
    /// The balance, as in `-1 + 5 = 4 x 1`, with what is wrong with it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sign = if self.boundary_law() { "=" } else { "!=" };
        let Self {
            interior,
            corners,
            euler,
            folds,
            ..
        } = self;
        write!(f, "{interior} + {corners} {sign} {folds} x {euler}")?;
        if !self.aligned {
            write!(f, " (not aligned)")?;
        }
        if !self.winding_law() {
            write!(f, " (boundary winds by {})", self.boundary_winding)?;
        }
        Ok(())
    }
}

impl Field {
    /// Quarter index of one triangle: -1, 0 or 1 where representation vectors
    /// are interpolated, that times their power where roots are.
    pub(crate) fn triangle_index(&self, triangle: usize) -> i32 {
        let (vectors, power) = self.roots();
        let phases = self.domain().triangles()[triangle].map(|v| phase(vectors[v as usize]));
        let turn: f64 = (0..3)
            .map(|k| wrapped(phases[k], phases[(k + 1) % 3]))
            .sum();
        (turn / (4.0 * QUARTER)).round() as i32 * i32::from(power)
    }

    /// The singularities, in the order of their first triangle.
    ///
    /// Singular triangles that touch are one singularity, at the mean of
    /// their zeros and with the sum of their indices; where that is 0, there
    /// is none.
    #[must_use]
    pub fn singularities(&self) -> Vec<Singularity> {
        let singular: Vec<(usize, i32)> = (0..self.domain().triangles().len())
            .map(|t| (t, self.triangle_index(t)))
            .filter(|&(_, index)| index != 0)
            .collect();
        let clusters = self.touching(&singular);
        let count = clusters.iter().max().map_or(0, |last| last + 1);
        let mut sums = vec![(0, V2::zeros(), 0.0); count];
        for (&(triangle, index), &cluster) in singular.iter().zip(&clusters) {
            let sum = &mut sums[cluster];
            sum.0 += index;
            sum.1 += self.zero(triangle);
            sum.2 += 1.0;
        }
        let origin = self.domain().inner.frame.origin;
        sums.into_iter()
            .filter(|&(index, ..)| index != 0)
            .map(|(quarter_index, places, count)| Singularity {
                at: coord(places / count + origin),
                quarter_index,
            })
            .collect()
    }

    /// For each singular triangle its cluster, numbered by first member.
    fn touching(&self, singular: &[(usize, i32)]) -> Vec<usize> {
        let mut parent: Vec<usize> = (0..singular.len()).collect();
        fn root(parent: &mut [usize], mut k: usize) -> usize {
            while parent[k] != k {
                parent[k] = parent[parent[k]];
                k = parent[k];
            }
            k
        }
        let mut corners: Vec<(u32, usize)> = Vec::with_capacity(3 * singular.len());
        for (k, &(triangle, _)) in singular.iter().enumerate() {
            corners.extend(self.domain().triangles()[triangle].map(|v| (v, k)));
        }
        corners.sort_unstable();
        for pair in corners.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            let (a, b) = (root(&mut parent, pair[0].1), root(&mut parent, pair[1].1));
            // The lower number leads, so clusters come in order.
            parent[a.max(b)] = a.min(b);
        }
        let mut number = vec![usize::MAX; singular.len()];
        let mut count = 0;
        (0..singular.len())
            .map(|k| {
                let lead = root(&mut parent, k);
                if number[lead] == usize::MAX {
                    number[lead] = count;
                    count += 1;
                }
                number[lead]
            })
            .collect()
    }

    /// Where the interpolated D vanishes in a singular triangle.
    pub(crate) fn zero(&self, triangle: usize) -> V2 {
        let vertices = self.domain().triangles()[triangle].map(|v| v as usize);
        let points = vertices.map(|v| self.domain().inner.mesh.points[v]);
        let [a, b, c] = vertices.map(|v| self.roots().0[v]);
        // They vanish at barycentric coordinates proportional to these.
        let shares = [wedge(b, c), wedge(c, a), wedge(a, b)];
        let total: f64 = shares.iter().sum();
        let middle = (points[0] + points[1] + points[2]) / 3.0;
        // Nearly opposite vectors leave the place open; roots have any size.
        let size = [a, b, c]
            .map(|v| v.norm_squared())
            .into_iter()
            .fold(0.0, f64::max);
        if total.abs() <= 1e-12 * size || shares.iter().any(|s| s / total < -1e-9) {
            return middle;
        }
        (0..3).fold(V2::zeros(), |sum, k| sum + points[k] * (shares[k] / total))
    }

    /// Sum of the quarter indices of all triangles.
    #[must_use]
    pub fn index_sum(&self) -> i32 {
        (0..self.domain().triangles().len())
            .map(|t| self.triangle_index(t))
            .sum()
    }

    /// Winding of D along all rings, each walked with the domain on its left,
    /// in turns of D (quarter turns of the cross).
    ///
    /// Always equal to [`Field::index_sum`]: in the sum over all triangles
    /// inner edges cancel, exactly, since the difference of two phases is
    /// antisymmetric bit for bit.
    #[must_use]
    pub fn boundary_winding(&self) -> i32 {
        let (vectors, power) = self.roots();
        let borders = &self.domain().inner.mesh.borders;
        let turn: f64 = borders
            .iter()
            .map(|b| {
                wrapped(
                    phase(vectors[b.from as usize]),
                    phase(vectors[b.to as usize]),
                )
            })
            .sum();
        (turn / (4.0 * QUARTER)).round() as i32 * i32::from(power)
    }

    /// All numbers of the two index laws at once.
    ///
    /// The sums inside are: 4 for a disc, 0 for a rectangle and an L, -1 for
    /// a regular pentagon, 4 for a disc with a square hole.
    ///
    /// ```
    /// use crossfield::{geo_types::polygon, BoundaryField, Domain, DomainOptions, FieldDesign};
    ///
    /// let site = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 60., y: 40.), (x: 0., y: 40.)];
    /// let domain = Domain::new(&site, &DomainOptions::default())?;
    /// let check = BoundaryField::default().design(&domain)?.index_check();
    /// assert_eq!((check.interior, check.corners, check.euler), (0, 4, 1));
    /// assert!(check.aligned && check.winding_law() && check.boundary_law());
    /// # Ok::<(), crossfield::FieldError>(())
    /// ```
    #[must_use]
    pub fn index_check(&self) -> IndexCheck {
        let rings = &self.domain().inner.rings;
        let turns = rings.iter().flat_map(|ring| &ring.turn);
        let period = self.symmetry().period();
        IndexCheck {
            interior: self.index_sum(),
            boundary_winding: self.boundary_winding(),
            corners: turns.map(|turn| (turn / period).round() as i32).sum(),
            euler: self.domain().euler_characteristic(),
            folds: self.symmetry().folds() as i32,
            aligned: self.is_boundary_aligned(),
        }
    }

    /// Whether the field follows the boundary closely enough for
    /// [`IndexCheck::boundary_law`]: relative to the boundary, D turns by less
    /// than half a turn along each boundary edge of the mesh, and at each
    /// boundary vertex the cross takes the shorter way from the one edge to
    /// the other.
    ///
    /// True wherever D has a positive scalar product with the representation
    /// vectors of the boundary edges; false for most fields that were not
    /// designed to follow it.
    #[must_use]
    pub fn is_boundary_aligned(&self) -> bool {
        let inner = &*self.domain().inner;
        let borders = &inner.mesh.borders;
        // Phase of D at `v` relative to the edge that a border lies on.
        let deviation = |border: usize, v: u32| {
            let border = borders[border];
            let ring = &inner.rings[border.ring as usize];
            let along = self.symmetry().power(ring.direction(border.edge as usize));
            let d = self.vectors()[v as usize];
            wedge(along, d).atan2(along.dot(&d))
        };
        let mut by_start: Vec<(u32, usize)> =
            (0..borders.len()).map(|k| (borders[k].from, k)).collect();
        by_start.sort_unstable();
        let least = HALF_TURN - 1e-9;
        (0..borders.len()).all(|k| {
            let Border {
                from,
                to,
                ring,
                edge,
            } = borders[k];
            let arriving = deviation(k, to);
            let first = by_start.partition_point(|&(start, _)| start < to);
            let after = inner.rings[ring as usize].next(edge as usize);
            (arriving - deviation(k, from)).abs() < least
                && by_start[first..]
                    .iter()
                    .take_while(|&&(start, _)| start == to)
                    .map(|&(_, next)| next)
                    // Where rings touch, more than one border starts.
                    .filter(|&next| {
                        let (r, e) = (borders[next].ring, borders[next].edge as usize);
                        r == ring && (e == edge as usize || e == after)
                    })
                    .all(|next| (arriving - deviation(next, to)).abs() < least)
        })
    }
}

/// Half a turn of D.
const HALF_TURN: f64 = 2.0 * QUARTER;

/// The angle of D; 0 for a zero vector.
fn phase(d: V2) -> f64 {
    d.y.atan2(d.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, DomainOptions};
    use geo_types::polygon;

    /// Roots have any size: the zero of tiny ones was once put in the middle
    /// of its triangle.
    #[test]
    fn the_place_of_a_zero_does_not_depend_on_the_size_of_the_roots() {
        let shape = polygon![(x: -4., y: -4.), (x: 4., y: -4.), (x: 4., y: 4.), (x: -4., y: 4.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let centre = V2::new(0.37, -1.21);
        for size in [1e-30, 1e-8, 1.0, 1e30] {
            let points = &domain.inner.mesh.points;
            let roots = points.iter().map(|p| (p - centre) * size).collect();
            let field = Field::from_roots(&domain, roots, 2).expect("fits");
            let found = field.singularities();
            assert_eq!(found.len(), 1);
            assert_eq!(found[0].quarter_index, 2);
            let at = crate::plane::vector(found[0].at);
            // Roots that are linear in the place are interpolated exactly.
            assert!((at - centre).norm() < 1e-12);
        }
    }

    #[test]
    fn an_analytic_singularity_is_found_where_it_is() {
        let shape = polygon![(x: -4., y: -4.), (x: 4., y: -4.), (x: 4., y: 4.), (x: -4., y: 4.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let centre = V2::new(0.37, -1.21);
        for power in [1, -1, 2, -3] {
            let vectors = domain
                .vertices()
                .into_iter()
                .map(|p| {
                    let angle = (p.y - centre.y).atan2(p.x - centre.x) * f64::from(power);
                    Coord {
                        x: angle.cos(),
                        y: angle.sin(),
                    }
                })
                .collect();
            let field = Field::from_representatives(&domain, vectors).expect("fits");
            assert_eq!(field.index_sum(), power);
            assert_eq!(field.boundary_winding(), power);
            let found = field.singularities();
            assert_eq!(found.iter().map(|s| s.quarter_index).sum::<i32>(), power);
            for singularity in &found {
                let at = crate::plane::vector(singularity.at);
                assert!((at - centre).norm() < 3.0 * domain.edge_length());
            }
        }
    }
}
