//! Fields with singularities where the user wants them.
//!
//! The supplement of Yang et al. 2013 leaves "manual placement of
//! singularities (intersections, roundabouts)" to future work. A ring of
//! wanted vectors around the place cannot do it, since the phase of such a
//! ring is not known. A connection can (Ray et al. 2008; Crane, Desbrun and
//! Schroeder 2010): with
//!
//! ```text
//! F(p) = prod((p - p_i) / |p - p_i|)^k_i,    D = F D',
//! ```
//!
//! k_i the index of singularity i in N-th turns, D has the wanted indices
//! wherever D' does not vanish. Along an edge from p to q, F turns by the sum
//! of k_i times the angle under which p_i sees the edge: the transport theta
//! of that edge. The holes of the domain are places of F too, of the index
//! that their boundary asks for, so that D' winds around none of them.

use std::f64::consts::TAU;

use crate::boundary::{BoundaryField, FREE};
use crate::connection::{chains, frame, inside, transport, well_inside, whole, winding, Pole};
use crate::domain::Domain;
use crate::factor;
use crate::field::{Field, FieldDesign};
use crate::operators::{edge_weights, laplacian_plus, Laplacian};
use crate::plane::V2;
use crate::singularity::Singularity;
use crate::symmetry::{product, quotient, Symmetry};
use crate::system::{to_unit, System};
use crate::FieldError;

/// What is made as smooth as possible.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Connection {
    /// The phase of D': `sum w_ij (theta_ij + psi_j - psi_i)^2 + omega sum m_i
    /// (psi_i - beta_i)^2`, one real linear system. That is the energy of the
    /// field of unit vectors itself, of which it gives the smallest among all
    /// fields with just these singularities: no further one appears.
    #[default]
    Phase,
    /// The vector D': `sum w_ij |D_j - exp(i theta_ij) D_i|^2 + omega sum m_i
    /// |D_i - D~_i|^2`, a Hermitian positive definite system. Since the
    /// connection is flat outside the singularities, multiplication by F
    /// makes it the real system of a B-field, which is what is solved. D' may
    /// vanish, at pairs of singularities that nobody asked for, where places
    /// and boundary do not go together; in return it bends less there.
    Vector,
}

/// The smoothest field that follows the boundary and has just the
/// singularities that are asked for.
///
/// Each one appears in the triangle of its place; those with an index beyond
/// one N-th turn, which no triangle can hold, as several of the same sign
/// within some two edge lengths. It counts as aligned with the
/// boundary only as far as the place leaves the field room to turn.
///
/// The indices must add up to N times the Euler characteristic of the domain
/// less the sum of its corners (law of Poincare and Hopf): to 4 for crosses
/// on a disc, to 0 on a rectangle.
///
/// ```
/// use crossfield::{geo_types::{coord, polygon}, Domain, DomainOptions, FieldDesign,
///     PrescribedField, Singularity};
///
/// // A rectangle with a junction of three streets and one of five.
/// let site = polygon![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 60.), (x: 0., y: 60.)];
/// let domain = Domain::new(&site, &DomainOptions::default())?;
/// let wanted = [(30.0, 25.0, 1), (60.0, 35.0, -1)]
///     .map(|(x, y, quarter_index)| Singularity { at: coord! { x: x, y: y }, quarter_index });
/// let field = PrescribedField::new(wanted.to_vec()).design(&domain)?;
/// assert_eq!(field.singularities().len(), 2);
/// # Ok::<(), crossfield::FieldError>(())
/// ```
///
#[doc = include_str!("../images/p-field.svg")]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PrescribedField {
    /// Where, and of which index, in N-th turns (quarter turns for crosses).
    pub singularities: Vec<Singularity>,
    /// Alignment with the boundary against smoothness, as
    /// [`BoundaryField::omega`]; positive.
    ///
    /// Default value: 100.
    pub omega: f64,
    /// What is made smooth.
    ///
    /// Default value: [`Connection::Phase`].
    pub connection: Connection,
    /// How many arms the directions have.
    ///
    /// Default value: [`Symmetry::Cross`].
    pub symmetry: Symmetry,
}

impl PrescribedField {
    /// With these singularities, and all options at their default values.
    #[must_use]
    pub fn new(singularities: Vec<Singularity>) -> Self {
        Self {
            singularities,
            omega: 100.0,
            connection: Connection::Phase,
            symmetry: Symmetry::Cross,
        }
    }

    /// What the indices on `domain` must add up to, in N-th turns: N times
    /// (1 - number of holes) less the sum over the boundary's corners of
    /// their turn in whole N-th turns.
    ///
    /// ```
    /// use crossfield::{geo_types::polygon, Domain, DomainOptions, PrescribedField, Symmetry};
    ///
    /// let site = polygon![(x: 0., y: 0.), (x: 90., y: 0.), (x: 45., y: 80.)];
    /// let domain = Domain::new(&site, &DomainOptions::default())?;
    /// // Three corners of 120 degrees, each rounded to a quarter turn.
    /// assert_eq!(PrescribedField::needed_sum(&domain, Symmetry::Cross), 1);
    /// # Ok::<(), crossfield::FieldError>(())
    /// ```
    #[must_use]
    pub fn needed_sum(domain: &Domain, symmetry: Symmetry) -> i32 {
        let rings = &domain.inner.rings;
        rings.iter().map(|ring| winding(ring, symmetry)).sum()
    }
}

impl FieldDesign for PrescribedField {
    /// The field of `domain` with these singularities.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if omega is out of range; if a singularity
    /// lies outside the domain, has the index 0 or one beyond a whole turn; if
    /// two are so near that the mesh cannot tell them apart; if the indices
    /// do not add up to [`PrescribedField::needed_sum`]; and, with
    /// [`Connection::Phase`], if the field would turn by more than half an
    /// N-th turn between neighbouring vertices, in a neck of the domain that
    /// is no wider than an edge of the mesh, and so show a singularity that
    /// was not asked for.
    /// [`FieldError::SingularSystem`] if the solution does not satisfy the
    /// system.
    ///
    /// # Complexity
    ///
    /// As for a [`BoundaryField`], one factorisation; one solution for each
    /// hole; and O(vertices x (singularities + holes)).
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        let base = BoundaryField {
            omega: self.omega,
            symmetry: self.symmetry,
            ..BoundaryField::default()
        };
        if self.omega <= 0.0 {
            return Err(FieldError::option(
                "omega",
                format!("is {}; give more than 0 and less than 1e12", self.omega),
            ));
        }
        // Checks omega, too.
        let system = base.system(domain)?;
        let poles = self.poles(domain)?;
        let frames: Vec<V2> = (domain.inner.mesh.points.iter())
            .map(|&p| frame(&poles, p))
            .collect();
        let crosses = match self.connection {
            Connection::Phase => self.phases(domain, &poles, &frames)?,
            Connection::Vector => vectors(domain, system, &frames)?,
        };
        let field = Field::from_vectors(domain, crosses)?.of_symmetry(self.symmetry);
        if self.connection == Connection::Phase {
            self.just_these(&field, &poles)?;
        }
        Ok(field)
    }
}

impl PrescribedField {
    /// The singularities, checked and placed well inside their triangles; and
    /// the holes.
    fn poles(&self, domain: &Domain) -> Result<Vec<Pole>, FieldError> {
        let refuse = |why: String| Err(FieldError::option("singularities", why));
        let inner = &*domain.inner;
        let folds = self.symmetry.folds() as i32;
        let mut poles = Vec::new();
        let mut corners: Vec<(u32, usize)> = Vec::new();
        for (k, singularity) in self.singularities.iter().enumerate() {
            let index = singularity.quarter_index;
            if index == 0 || index.abs() > folds {
                return refuse(format!(
                    "has the index {index} for number {k}; give 1 to {folds} or -1 to -{folds} \
                     (in turns of 1/{folds})"
                ));
            }
            let at = singularity.at;
            let Some(triangle) = domain.locate(at, &mut Default::default()) else {
                return refuse(format!(
                    "has number {k} at ({}, {}), outside the domain; move it inside",
                    at.x, at.y
                ));
            };
            let vertices = inner.mesh.triangles[triangle];
            corners.extend(vertices.map(|v| (v, k)));
            let points = vertices.map(|v| inner.mesh.points[v as usize]);
            poles.push(Pole {
                at: well_inside(points, domain.local(at)),
                index,
            });
        }
        corners.sort_unstable();
        if let Some(pair) = corners.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return refuse(format!(
                "has numbers {} and {} in triangles that touch; move them apart, make them one, \
                 or give the domain a smaller `edge_length`",
                pair[0].1, pair[1].1
            ));
        }
        let sum: i32 = poles.iter().map(|pole| pole.index).sum();
        let needed = Self::needed_sum(domain, self.symmetry);
        if sum != needed {
            return refuse(format!(
                "has indices that add up to {sum} (in turns of 1/{folds}); a field that follows \
                 the boundary of this domain has the sum {needed}, so add {} to them",
                needed - sum
            ));
        }
        for ring in inner.rings.iter().skip(1) {
            // Walked clockwise around the hole.
            let index = -winding(ring, self.symmetry);
            if index != 0 {
                let at = inside(ring);
                poles.push(Pole { at, index });
            }
        }
        Ok(poles)
    }

    /// Refuses a field that shows singularities elsewhere.
    fn just_these(&self, field: &Field, poles: &[Pole]) -> Result<(), FieldError> {
        let inner = &*field.domain().inner;
        let reach = 2.0 * field.domain().edge_length();
        let wanted = &poles[..self.singularities.len()];
        for (t, triangle) in inner.mesh.triangles.iter().enumerate() {
            if field.triangle_index(t) == 0 {
                continue;
            }
            let [a, b, c] = triangle.map(|v| inner.mesh.points[v as usize]);
            let middle = (a + b + c) / 3.0;
            if wanted.iter().all(|pole| (pole.at - middle).norm() > reach) {
                let at = middle + inner.frame.origin;
                return Err(FieldError::option(
                    "singularities",
                    format!(
                        "would bring about another one near ({:.2}, {:.2}), where the domain is \
                         too narrow for its mesh; give it a smaller `edge_length`, or have the \
                         indices on either side of the neck fit together",
                        at.x, at.y
                    ),
                ));
            }
        }
        Ok(())
    }

    /// The phase of smallest energy, as unit vectors.
    fn phases(
        &self,
        domain: &Domain,
        poles: &[Pole],
        frames: &[V2],
    ) -> Result<Vec<V2>, FieldError> {
        let inner = &*domain.inner;
        let count = domain.vertex_count();
        let data = self.boundary_phases(domain, poles, frames);
        let weights = edge_weights(domain, Laplacian::Cotangent);
        let matrix = laplacian_plus(domain, &weights, &data.masses);
        let rhs = (0..count).map(|v| {
            let p = inner.mesh.points[v];
            let edges = inner.adjacency.of(v).iter();
            let turn = edges
                .zip(&weights[inner.adjacency.row(v)])
                .map(|(&w, weight)| weight * transport(poles, p, inner.mesh.points[w as usize]));
            data.masses[v] * data.phases[v] + turn.sum::<f64>()
        });
        let holes = inner.rings.len() - 1;
        let mut columns: Vec<Vec<f64>> = vec![rhs.collect()];
        for hole in 1..=holes {
            let column = (0..count).map(|v| {
                if data.ring[v] as usize == hole {
                    data.masses[v]
                } else {
                    0.0
                }
            });
            columns.push(column.collect());
        }
        factor::solve(&matrix, &mut columns)?;
        let turns = whole_turns(&data, &columns);
        let psi = |v: usize| {
            let more = turns.iter().zip(&columns[1..]);
            columns[0][v] + more.map(|(&m, column)| TAU * m * column[v]).sum::<f64>()
        };
        Ok((0..count)
            .map(|v| {
                let (y, x) = psi(v).sin_cos();
                product(frames[v], V2::new(x, y))
            })
            .collect())
    }

    /// The wanted phases of D' on the boundary, continuous along each ring.
    fn boundary_phases(&self, domain: &Domain, poles: &[Pole], frames: &[V2]) -> Boundary {
        let inner = &*domain.inner;
        let count = domain.vertex_count();
        let unit = inner.area.sqrt();
        let mut lengths = vec![0.0; count];
        let mut phases = vec![0.0; count];
        let mut sums = vec![V2::zeros(); count];
        let mut ring_of = vec![0; count];
        let mut ends_at = vec![0_u8; count];
        for (number, chain) in chains(domain).into_iter().enumerate() {
            let ring = &inner.rings[number];
            let Some(first) = chain.first() else { continue };
            // Phase of D~ along the present edge, that of F at its start.
            let along = self.symmetry.power(ring.direction(first.edge as usize));
            let mut wanted = along.y.atan2(along.x);
            let start = frames[first.from as usize];
            let mut turned = start.y.atan2(start.x);
            let mut edge = first.edge as usize;
            for border in &chain {
                // On to the edge of this border; pieces of an edge follow
                // each other without a turn.
                while edge != border.edge as usize {
                    edge = ring.next(edge);
                    let turn = ring.turn[edge];
                    wanted +=
                        self.symmetry.number() * turn - TAU * f64::from(whole(turn, self.symmetry));
                }
                let ends = [border.from as usize, border.to as usize];
                let [a, b] = ends.map(|v| inner.mesh.points[v]);
                let share = (b - a).norm() / (2.0 * unit);
                let after = turned + transport(poles, a, b);
                for (v, turned) in ends.into_iter().zip([turned, after]) {
                    lengths[v] += share;
                    phases[v] += share * (wanted - turned);
                    let (y, x) = (wanted - turned).sin_cos();
                    sums[v] += V2::new(x, y) * share;
                    ring_of[v] = number as u32;
                    ends_at[v] = ends_at[v].saturating_add(1);
                }
                turned = after;
            }
            // At the end the start was met with its own phase again, since D'
            // winds around no ring.
        }
        let mut masses = vec![0.0; count];
        for v in 0..count {
            // What cancels between two edges has no phase; nor has a vertex
            // where rings touch, whose phases may be whole turns apart.
            let strength = sums[v].norm();
            if ends_at[v] == 2 && strength > FREE * lengths[v] {
                masses[v] = self.omega * strength;
                phases[v] /= lengths[v];
            } else {
                phases[v] = 0.0;
            }
        }
        Boundary {
            masses,
            phases,
            ring: ring_of,
        }
    }
}

/// The pulls on the phase.
struct Boundary {
    masses: Vec<f64>,
    phases: Vec<f64>,
    /// The ring of each boundary vertex.
    ring: Vec<u32>,
}

/// How many whole turns the phases on each hole are to be raised.
///
/// The energy is a quadratic function of these numbers, with the matrix and
/// the slope below. Each number in turn takes its best value until none
/// changes: the minimum for one hole, a local one for more.
fn whole_turns(data: &Boundary, columns: &[Vec<f64>]) -> Vec<f64> {
    let holes = columns.len() - 1;
    let on = |hole: usize, value: &dyn Fn(usize) -> f64| -> f64 {
        (0..data.masses.len())
            .filter(|&v| data.ring[v] as usize == hole)
            .map(|v| data.masses[v] * value(v))
            .sum()
    };
    let slope: Vec<f64> = (1..=holes)
        .map(|h| on(h, &|v| data.phases[v] - columns[0][v]))
        .collect();
    let matrix: Vec<Vec<f64>> = (1..=holes)
        .map(|h| {
            let entry = |k: usize| {
                let own = if h == k { on(h, &|_| 1.0) } else { 0.0 };
                own - on(h, &|v| columns[k][v])
            };
            (1..=holes).map(entry).collect()
        })
        .collect();
    let mut turns = vec![0.0_f64; holes];
    for _ in 0..100 {
        let mut changed = false;
        for h in 0..holes {
            // Half the derivative of the energy over 2 pi, but for turn h.
            let rest: f64 = (0..holes)
                .filter(|&k| k != h)
                .map(|k| matrix[h][k] * turns[k])
                .sum();
            if matrix[h][h] <= 0.0 {
                continue;
            }
            let best = (-(slope[h] / TAU + rest) / matrix[h][h]).round();
            // Of equals the one that is there.
            let cost = |m: f64| m * (2.0 * (slope[h] / TAU + rest) + matrix[h][h] * m);
            if best != turns[h] && cost(best) < cost(turns[h]) - 1e-9 * matrix[h][h] {
                turns[h] = best;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    turns
}

/// The minimiser over vectors D', times F.
fn vectors(domain: &Domain, mut system: System, frames: &[V2]) -> Result<Vec<V2>, FieldError> {
    for (pull, &frame) in system.pulls.iter_mut().zip(frames) {
        *pull = quotient(*pull, frame);
    }
    let mut crosses = system.solve(domain)?;
    to_unit(&mut crosses);
    Ok(crosses
        .into_iter()
        .zip(frames)
        .map(|(cross, &frame)| product(cross, frame))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DomainOptions;
    use geo_types::{coord, polygon};

    #[test]
    fn what_cannot_be_is_refused_with_the_reason() {
        let shape = polygon![(x: 0., y: 0.), (x: 40., y: 0.), (x: 40., y: 40.), (x: 0., y: 40.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let at = |x, y, quarter_index| Singularity {
            at: coord! {x: x, y: y},
            quarter_index,
        };
        let cases = [
            (vec![at(10., 10., 1)], "add -1 to them"),
            (
                vec![at(10., 10., 1), at(50., 10., -1)],
                "outside the domain",
            ),
            (vec![at(10., 10., 0)], "index 0"),
            (vec![at(10., 10., 5), at(30., 10., -5)], "index 5"),
            (
                vec![at(10., 10., 1), at(10.1, 10., -1)],
                "triangles that touch",
            ),
            (vec![at(f64::NAN, 10., 1)], "outside the domain"),
        ];
        for (singularities, wanted) in cases {
            let error = PrescribedField::new(singularities)
                .design(&domain)
                .expect_err("refused");
            assert!(error.to_string().contains(wanted), "{error}");
        }
        let design = PrescribedField {
            omega: f64::NAN,
            ..PrescribedField::new(vec![])
        };
        assert!(design.design(&domain).is_err());
    }
}
