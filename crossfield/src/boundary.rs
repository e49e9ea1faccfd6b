//! B-fields: the smoothest field that follows the boundary.
//!
//! Supplement of Yang et al. 2013, section 4.3, after Maharik et al. 2011.
//! Representation vectors D minimise
//! `sum w_ij |D_i - D_j|^2 + omega sum m_i |D_i - D~_i|^2`, the first sum over
//! the edges of the mesh, the second over the boundary vertices, where D~ is
//! aligned with the boundary. One sparse positive definite system with two
//! right-hand sides; the result is scaled to unit length.
//!
//! Differs from the paper, by default: cotangent weights with m_i the
//! boundary length of vertex i over the square root of the area, so that the
//! result depends neither on the mesh nor on the size of the domain; and
//! corners average the representation vectors of their edges, since averaged
//! edge vectors turn the cross at a right-angled corner by 45 degrees. Both of
//! the paper's own rules are options.

use crate::cross::SINGULAR;
use crate::domain::Domain;
use crate::factor;
use crate::field::{Field, FieldDesign};
use crate::operators::{edge_weights, laplacian_plus, Laplacian};
use crate::plane::{fourth_power, V2};
use crate::FieldError;

/// What a boundary vertex between two edges should align with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum CornerRule {
    /// With both edges: their representation vectors are averaged. A vertex
    /// where they cancel (a turn by an odd multiple of 45 degrees) is free.
    #[default]
    Representatives,
    /// With the average of the two oriented edge vectors, as the paper is
    /// worded. At a right-angled corner that is the diagonal.
    EdgeVectors,
}

/// The boundary field (B-field) of a domain.
///
/// ```
/// use crossfield::{geo_types::{coord, polygon}, BoundaryField, Cursor, Domain, DomainOptions,
///     FieldDesign};
///
/// // A B-field on an L has no singularity and is constant.
/// let site = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 60., y: 20.), (x: 30., y: 20.),
///     (x: 30., y: 50.), (x: 0., y: 50.)];
/// let domain = Domain::new(&site, &DomainOptions::default())?;
/// let field = BoundaryField::default().design(&domain)?;
/// assert!(field.singularities().is_empty());
/// let cross = field.cross(coord! { x: 20.0, y: 21.0 }, &mut Cursor::default());
/// assert!(cross.expect("inside").angle().abs() < 1e-9);
/// # Ok::<(), crossfield::FieldError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BoundaryField {
    /// The paper's omega, alignment against smoothness; positive.
    ///
    /// The paper's pictures have 0.1 and 0.9, with uniform weights. With
    /// cotangent weights so small a number hardly aligns the field at all.
    ///
    /// Default value: 100.
    pub omega: f64,
    /// How differences along the edges are weighed.
    ///
    /// Default value: [`Laplacian::Cotangent`].
    pub laplacian: Laplacian,
    /// What corners align with.
    ///
    /// Default value: [`CornerRule::Representatives`].
    pub corner_rule: CornerRule,
    /// Gauss-Seidel rounds that lower the energy further under the constraint
    /// of unit length, after the linear solution is renormalised.
    ///
    /// Each step minimises over one vertex exactly, so the energy never
    /// rises.
    ///
    /// Default value: 0 (the paper's: renormalised only).
    pub unit_rounds: usize,
}

impl Default for BoundaryField {
    fn default() -> Self {
        Self {
            omega: 100.0,
            laplacian: Laplacian::Cotangent,
            corner_rule: CornerRule::Representatives,
            unit_rounds: 0,
        }
    }
}

impl FieldDesign for BoundaryField {
    /// The B-field of `domain`.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if omega is not positive and finite,
    /// [`FieldError::SingularSystem`] if no boundary vertex is constrained or
    /// the solution does not satisfy the system.
    ///
    /// # Complexity
    ///
    /// One sparse Cholesky factorisation, about O(n^1.5) in the vertices.
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        if !(self.omega > 0.0 && self.omega < 1e12) {
            return Err(FieldError::option(
                "omega",
                format!("is {}; give more than 0 and less than 1e12", self.omega),
            ));
        }
        let system = System::new(self, domain);
        if system.masses.iter().all(|&mass| mass == 0.0) {
            return Err(FieldError::SingularSystem {
                why: "no boundary vertex has a direction to align with".into(),
            });
        }
        let mut crosses = system.solve(domain)?;
        for cross in &mut crosses {
            // What cancelled completely stays short, and singular.
            *cross = cross.try_normalize(SINGULAR).unwrap_or_else(V2::zeros);
        }
        for _ in 0..self.unit_rounds {
            system.relax(domain, &mut crosses);
        }
        Field::from_vectors(domain, crosses)
    }
}

/// Targets, masses (omega times m_i) and edge weights.
struct System {
    targets: Vec<V2>,
    masses: Vec<f64>,
    weights: Vec<f64>,
}

impl System {
    fn new(design: &BoundaryField, domain: &Domain) -> Self {
        let inner = &*domain.inner;
        let count = domain.vertex_count();
        let mut sums = vec![V2::zeros(); count];
        let mut lengths = vec![0.0; count];
        let unit = inner.area.sqrt();
        for border in &inner.mesh.borders {
            let ends = [border.from as usize, border.to as usize];
            let [a, b] = ends.map(|v| inner.mesh.points[v]);
            // Half of each edge belongs to either end. The paper's masses are
            // 1 a vertex, so each of its two edges contributes a half.
            let share = match design.laplacian {
                Laplacian::Cotangent => (b - a).norm() / (2.0 * unit),
                Laplacian::Uniform => 0.5,
            };
            let direction = inner.rings[border.ring as usize].direction(border.edge as usize);
            let pull = match design.corner_rule {
                CornerRule::Representatives => fourth_power(direction) * share,
                CornerRule::EdgeVectors => b - a,
            };
            for v in ends {
                sums[v] += pull;
                lengths[v] += share;
            }
        }
        let mut masses = vec![0.0; count];
        let mut targets = sums;
        for ((target, mass), length) in targets.iter_mut().zip(&mut masses).zip(lengths) {
            if length == 0.0 {
                continue;
            }
            *target = match design.corner_rule {
                CornerRule::Representatives => *target / length,
                CornerRule::EdgeVectors => fourth_power(*target),
            };
            if target.norm() > 1e-6 {
                *mass = design.omega * length;
            }
        }
        Self {
            targets,
            masses,
            weights: edge_weights(domain, design.laplacian),
        }
    }

    /// The minimiser without the constraint of unit length.
    fn solve(&self, domain: &Domain) -> Result<Vec<V2>, FieldError> {
        let matrix = laplacian_plus(domain, &self.weights, &self.masses);
        let pulled = self.masses.iter().zip(&self.targets);
        let (x, y) = pulled.map(|(m, t)| (m * t.x, m * t.y)).unzip();
        let mut columns: [Vec<f64>; 2] = [x, y];
        factor::solve(&matrix, &mut columns)?;
        let [x, y] = columns;
        Ok(x.into_iter().zip(y).map(|(x, y)| V2::new(x, y)).collect())
    }

    /// One Gauss-Seidel round over unit vectors.
    ///
    /// With all vectors of unit length the energy depends on one of them only
    /// through its scalar product with the sum of its pulls: aligning it with
    /// that sum is the exact minimum.
    fn relax(&self, domain: &Domain, crosses: &mut [V2]) {
        let adjacency = &domain.inner.adjacency;
        for v in 0..crosses.len() {
            let mut pull = self.targets[v] * self.masses[v];
            for (&w, &weight) in adjacency.of(v).iter().zip(&self.weights[adjacency.row(v)]) {
                pull += crosses[w as usize] * weight;
            }
            if let Some(unit) = pull.try_normalize(f64::MIN_POSITIVE) {
                crosses[v] = unit;
            }
        }
    }

    /// The energy that is minimised.
    #[cfg(test)]
    fn energy(&self, domain: &Domain, crosses: &[V2]) -> f64 {
        let adjacency = &domain.inner.adjacency;
        let mut energy = 0.0;
        for v in 0..crosses.len() {
            for (&w, &weight) in adjacency.of(v).iter().zip(&self.weights[adjacency.row(v)]) {
                // Each edge is met twice.
                energy += weight * (crosses[v] - crosses[w as usize]).norm_squared() / 2.0;
            }
            energy += self.masses[v] * (crosses[v] - self.targets[v]).norm_squared();
        }
        energy
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DomainOptions;
    use geo_types::polygon;

    fn pentagon() -> Domain {
        let shape = polygon![(x: 0., y: 0.), (x: 8., y: -1.), (x: 11., y: 6.), (x: 5., y: 11.),
            (x: -2., y: 7.)];
        Domain::new(&shape, &DomainOptions::default()).expect("valid")
    }

    #[test]
    fn the_solution_is_a_minimum_and_rounds_never_raise_the_energy() {
        let domain = pentagon();
        for laplacian in [Laplacian::Cotangent, Laplacian::Uniform] {
            let design = BoundaryField {
                laplacian,
                ..BoundaryField::default()
            };
            let system = System::new(&design, &domain);
            let solution = system.solve(&domain).expect("definite");
            let least = system.energy(&domain, &solution);
            for k in [0, 7, 100] {
                let mut other = solution.clone();
                other[k] += V2::new(0.01, -0.02);
                assert!(system.energy(&domain, &other) > least);
            }
            let mut crosses: Vec<V2> = solution.iter().map(|d| d.normalize()).collect();
            let mut before = system.energy(&domain, &crosses);
            for _ in 0..10 {
                system.relax(&domain, &mut crosses);
                let after = system.energy(&domain, &crosses);
                assert!(after <= before * (1.0 + 1e-12));
                before = after;
            }
        }
    }

    #[test]
    fn the_papers_corner_rule_turns_a_right_angle_by_45_degrees() {
        let square = polygon![(x: 0., y: 0.), (x: 8., y: 0.), (x: 8., y: 8.), (x: 0., y: 8.)];
        let domain = Domain::new(&square, &DomainOptions::default()).expect("valid");
        let at_corner = |corner_rule| {
            let design = BoundaryField {
                corner_rule,
                ..BoundaryField::default()
            };
            System::new(&design, &domain).targets[0]
        };
        assert!((at_corner(CornerRule::EdgeVectors) - V2::new(-1.0, 0.0)).norm() < 1e-9);
        assert!((at_corner(CornerRule::Representatives) - V2::new(1.0, 0.0)).norm() < 1e-9);
    }

    #[test]
    fn corners_of_45_degrees_are_free() {
        // A regular octagon, coarse: every input vertex is free, the middles
        // of its edges are not.
        let eighth = std::f64::consts::FRAC_PI_4;
        let ring: Vec<(f64, f64)> = (0..8)
            .map(|k| ((k as f64 * eighth).cos(), (k as f64 * eighth).sin()))
            .collect();
        let shape = geo_types::Polygon::new(ring.into(), vec![]);
        let options = DomainOptions {
            edge_length: 2.0,
            min_angle_deg: 0.0,
            ..DomainOptions::default()
        };
        let domain = Domain::new(&shape, &options).expect("valid");
        let design = BoundaryField::default();
        let system = System::new(&design, &domain);
        let free = system.masses.iter().filter(|&&m| m == 0.0).count();
        assert_eq!(free, 8 + domain.inner_vertices().count());
        assert!(design.design(&domain).is_ok());
    }

    #[test]
    fn a_useless_omega_is_refused() {
        for omega in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let design = BoundaryField {
                omega,
                ..BoundaryField::default()
            };
            assert!(matches!(
                design.design(&pentagon()),
                Err(FieldError::BadOption {
                    option: "omega",
                    ..
                })
            ));
        }
    }
}
