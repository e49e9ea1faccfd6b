//! The quadratic energy that boundary fields, constraints and edits share.
//!
//! `sum w_ij |D_i - D_j|^2 + sum m_i |D_i - D~_i|^2`, the first sum over the
//! edges of the mesh, the second over vertices that something pulls at
//! (supplement of Yang et al. 2013, section 4.3; equation 2 of Ortner et al.
//! 2023 for pulls of several kinds). Pulls add up: of two at one vertex the
//! masses are added and the targets averaged.

use crate::cross::SINGULAR;
use crate::domain::Domain;
use crate::factor;
use crate::operators::{edge_weights, laplacian_plus, Laplacian};
use crate::plane::V2;
use crate::random::Stream;
use crate::FieldError;

/// What is minimised.
#[derive(Debug)]
pub(crate) struct System {
    /// m_i, 0 where nothing pulls.
    pub(crate) masses: Vec<f64>,
    /// m_i times D~_i.
    pub(crate) pulls: Vec<V2>,
    /// w_ij, parallel to the rows of the domain's adjacency.
    weights: Vec<f64>,
}

impl System {
    /// Nothing pulls yet.
    pub(crate) fn new(domain: &Domain, laplacian: Laplacian) -> Self {
        Self {
            masses: vec![0.0; domain.vertex_count()],
            pulls: vec![V2::zeros(); domain.vertex_count()],
            weights: edge_weights(domain, laplacian),
        }
    }

    /// The minimiser over vectors of any length.
    pub(crate) fn solve(&self, domain: &Domain) -> Result<Vec<V2>, FieldError> {
        if self.masses.iter().all(|&mass| mass == 0.0) {
            return Err(FieldError::SingularSystem {
                why: "no vertex has a direction to align with".into(),
            });
        }
        let matrix = laplacian_plus(domain, &self.weights, &self.masses);
        let (x, y) = self.pulls.iter().map(|pull| (pull.x, pull.y)).unzip();
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
    pub(crate) fn relax(&self, domain: &Domain, crosses: &mut [V2]) {
        let adjacency = &domain.inner.adjacency;
        for v in 0..crosses.len() {
            let mut pull = self.pulls[v];
            for (&w, &weight) in adjacency.of(v).iter().zip(&self.weights[adjacency.row(v)]) {
                pull += crosses[w as usize] * weight;
            }
            if let Some(unit) = pull.try_normalize(f64::MIN_POSITIVE) {
                crosses[v] = unit;
            }
        }
    }

    /// The energy but for the constant `sum m_i |D~_i|^2`.
    #[cfg(test)]
    pub(crate) fn energy(&self, domain: &Domain, crosses: &[V2]) -> f64 {
        let adjacency = &domain.inner.adjacency;
        let mut energy = 0.0;
        for v in 0..crosses.len() {
            for (&w, &weight) in adjacency.of(v).iter().zip(&self.weights[adjacency.row(v)]) {
                // Each edge is met twice.
                energy += weight * (crosses[v] - crosses[w as usize]).norm_squared() / 2.0;
            }
            energy += self.masses[v] * crosses[v].norm_squared();
            energy -= 2.0 * self.pulls[v].dot(&crosses[v]);
        }
        energy
    }
}

/// Scales to unit length; what cancelled completely stays short, and singular.
pub(crate) fn to_unit(crosses: &mut [V2]) {
    for cross in crosses {
        *cross = cross.try_normalize(SINGULAR).unwrap_or_else(V2::zeros);
    }
}

/// Unit vectors of even random phases.
pub(crate) fn random_units(count: usize, seed: u64) -> Vec<V2> {
    let mut stream = Stream::new(seed);
    (0..count)
        .map(|_| {
            let (y, x) = (std::f64::consts::TAU * stream.unit()).sin_cos();
            V2::new(x, y)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BoundaryField, ConstrainedField, DomainOptions, Stroke, Symmetry};
    use geo_types::{line_string, Polygon};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

        /// Each Gauss-Seidel step is the exact minimum over one vertex: the
        /// energy never rises, from any start, with any weights and pulls;
        /// and no unit field has less than the solution of the linear system.
        #[test]
        fn rounds_never_raise_the_energy(
            radii in proptest::collection::vec(40.0..100.0_f64, 5..14), seed in any::<u64>(),
            omega in 0.01..1000.0_f64, uniform in any::<bool>(), fold in 0..4_usize,
            ends in proptest::array::uniform4(-60.0..60.0_f64),
        ) {
            let step = std::f64::consts::TAU / radii.len() as f64;
            let ring: Vec<(f64, f64)> = radii.iter().enumerate()
                .map(|(k, r)| (r * (k as f64 * step).cos(), r * (k as f64 * step).sin()))
                .collect();
            let options = DomainOptions { edge_length: 12.0, ..DomainOptions::default() };
            let domain = Domain::new(&Polygon::new(ring.into(), vec![]), &options)?;
            let base = BoundaryField {
                omega,
                laplacian: if uniform { Laplacian::Uniform } else { Laplacian::Cotangent },
                symmetry: Symmetry::ALL[fold],
                ..BoundaryField::default()
            };
            let line = line_string![(x: ends[0], y: ends[1]), (x: ends[2], y: ends[3])];
            let design = ConstrainedField::new(base).with(Stroke::new(line, 50.0));
            let system = design.system(&domain)?;
            let mut crosses = random_units(domain.vertex_count(), seed);
            let mut before = system.energy(&domain, &crosses);
            // The energy is a sum of some thousand terms of this size.
            let scale: f64 = system.masses.iter().sum::<f64>() + 10.0 * crosses.len() as f64;
            for _ in 0..12 {
                system.relax(&domain, &mut crosses);
                let after = system.energy(&domain, &crosses);
                prop_assert!(after <= before + 1e-12 * scale, "{} {}", before, after);
                before = after;
            }
            let least = system.energy(&domain, &system.solve(&domain)?);
            prop_assert!(least <= before + 1e-9 * scale);
        }
    }
}
