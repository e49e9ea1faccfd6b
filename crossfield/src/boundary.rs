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

use crate::domain::Domain;
use crate::field::{Field, FieldDesign};
use crate::operators::Laplacian;
use crate::plane::V2;
use crate::symmetry::Symmetry;
use crate::system::{random_units, to_unit, System};
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

/// Where the search for unit vectors starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Start {
    /// At the exact minimum without the constraint of unit length, scaled to
    /// unit length (the supplement's result).
    #[default]
    Solution,
    /// At crosses of random angles (algorithm 2 of Ortner et al. 2023), from
    /// which [`BoundaryField::unit_rounds`] lead to a local minimum: another
    /// seed may give another field. Few rounds leave it restless, and with
    /// many singularities; the rounds needed grow with the number of vertices.
    ///
    /// The seed is that of the portable generator PCG XSL RR 128/64.
    Random {
        /// The same seed gives the same field on every machine.
        seed: u64,
    },
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
///
#[doc = include_str!("../images/b-field.svg")]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default))]
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
    /// Default value: 0 (the supplement's: renormalised only). UrbanFab's
    /// iteration count.
    pub unit_rounds: usize,
    /// Where those rounds start.
    ///
    /// Default value: [`Start::Solution`].
    pub start: Start,
    /// How many arms the directions have.
    ///
    /// Default value: [`Symmetry::Cross`].
    pub symmetry: Symmetry,
}

impl Default for BoundaryField {
    fn default() -> Self {
        Self {
            omega: 100.0,
            laplacian: Laplacian::Cotangent,
            corner_rule: CornerRule::Representatives,
            unit_rounds: 0,
            start: Start::Solution,
            symmetry: Symmetry::Cross,
        }
    }
}

impl FieldDesign for BoundaryField {
    /// The B-field of `domain`.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if omega is not positive and finite, or the
    /// start is random and no round follows;
    /// [`FieldError::SingularSystem`] if no boundary vertex is constrained or
    /// the solution does not satisfy the system.
    ///
    /// # Complexity
    ///
    /// One sparse Cholesky factorisation, about O(n^1.5) in the vertices; none
    /// from a random start.
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        if self.omega <= 0.0 {
            return Err(bad_omega(self.omega));
        }
        self.minimise(domain, &self.system(domain)?)
    }
}

impl BoundaryField {
    /// The energy with the pulls of the boundary; none for an omega of 0.
    pub(crate) fn system(&self, domain: &Domain) -> Result<System, FieldError> {
        if !(0.0..1e12).contains(&self.omega) {
            return Err(bad_omega(self.omega));
        }
        let mut system = System::new(domain, self.laplacian);
        let (targets, lengths) = self.targets(domain);
        for (v, (target, length)) in targets.into_iter().zip(lengths).enumerate() {
            if target.norm() > FREE {
                let mass = self.omega * length;
                system.masses[v] = mass;
                system.pulls[v] = target * mass;
            }
        }
        Ok(system)
    }

    /// For each vertex what the boundary there aligns with, zero inside, and
    /// its share m_i of the boundary.
    pub(crate) fn targets(&self, domain: &Domain) -> (Vec<V2>, Vec<f64>) {
        let inner = &*domain.inner;
        let count = domain.vertex_count();
        let mut targets = vec![V2::zeros(); count];
        let mut lengths = vec![0.0; count];
        let unit = inner.area.sqrt();
        for border in &inner.mesh.borders {
            let ends = [border.from as usize, border.to as usize];
            let [a, b] = ends.map(|v| inner.mesh.points[v]);
            // Half of each edge belongs to either end. The paper's masses are
            // 1 a vertex, so each of its two edges contributes a half.
            let share = match self.laplacian {
                Laplacian::Cotangent => (b - a).norm() / (2.0 * unit),
                Laplacian::Uniform => 0.5,
            };
            let direction = inner.rings[border.ring as usize].direction(border.edge as usize);
            let pull = match self.corner_rule {
                CornerRule::Representatives => self.symmetry.power(direction) * share,
                CornerRule::EdgeVectors => b - a,
            };
            for v in ends {
                targets[v] += pull;
                lengths[v] += share;
            }
        }
        for (target, &length) in targets.iter_mut().zip(&lengths) {
            if length > 0.0 {
                *target = match self.corner_rule {
                    CornerRule::Representatives => *target / length,
                    CornerRule::EdgeVectors => self.symmetry.power(*target),
                };
            }
        }
        (targets, lengths)
    }

    /// The minimum of `system` as the options say it is looked for.
    pub(crate) fn minimise(&self, domain: &Domain, system: &System) -> Result<Field, FieldError> {
        let mut crosses = match self.start {
            Start::Solution => {
                let mut crosses = system.solve(domain)?;
                to_unit(&mut crosses);
                crosses
            }
            Start::Random { .. } if self.unit_rounds == 0 => {
                return Err(FieldError::option(
                    "unit_rounds",
                    "is 0 with a random start, which would stay random; give 1 or more",
                ));
            }
            Start::Random { seed } => random_units(domain.vertex_count(), seed),
        };
        for _ in 0..self.unit_rounds {
            system.relax(domain, &mut crosses);
        }
        Ok(Field::from_vectors(domain, crosses)?.of_symmetry(self.symmetry))
    }
}

/// Targets shorter than this leave their vertex free: rounding alone would
/// choose their direction.
pub(crate) const FREE: f64 = 1e-6;

fn bad_omega(omega: f64) -> FieldError {
    FieldError::option(
        "omega",
        format!("is {omega}; give more than 0 and less than 1e12"),
    )
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
            let system = design.system(&domain).expect("in range");
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
            design.targets(&domain).0[0]
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
        let system = design.system(&domain).expect("in range");
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
