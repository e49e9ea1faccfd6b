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
