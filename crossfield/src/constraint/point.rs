//! A direction wanted around a point.

use geo_types::Coord;

use super::{check_finite, check_weight, Constraint, Pulls};
use crate::FieldError;

/// A direction at a point: a square laid out parallel to a monument, a gate.
///
/// The pull is spread evenly over a disc, since a field that is free to bend
/// ignores a pull at a single point, the more the finer the mesh is: adds
/// `weight * mean over the disc of |D - D~|^2` to the energy. Parts of the
/// disc outside the domain have no effect.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PointDirection {
    /// The point.
    pub at: Coord<f64>,
    /// The direction of an arm there, of any length.
    pub direction: Coord<f64>,
    /// Radius of the disc, metres; 0 for the point alone, whose effect then
    /// depends on the mesh.
    pub radius: f64,
    /// Its strength; positive. That of a stroke of this weight and of the
    /// length of [`Pulls::unit`].
    pub weight: f64,
}

/// Samples across an edge length of the mesh.
const DENSITY: f64 = 3.0;

/// Most samples along the radius: beyond them a disc is round enough.
const MOST_ROUNDS: f64 = 300.0;

impl Constraint for PointDirection {
    fn pull(&self, pulls: &mut Pulls<'_>) -> Result<(), FieldError> {
        check_weight(self.weight)?;
        check_finite("at", self.at)?;
        check_finite("direction", self.direction)?;
        if self.direction.x == 0.0 && self.direction.y == 0.0 {
            return Err(FieldError::option(
                "direction",
                "of a point is zero; give a direction",
            ));
        }
        if !(self.radius >= 0.0 && self.radius.is_finite()) {
            return Err(FieldError::option(
                "radius",
                format!("of a point is {}; give metres, or 0", self.radius),
            ));
        }
        if self.radius == 0.0 {
            pulls.at_point(self.at, self.direction, self.weight);
            return Ok(());
        }
        // Rings of even width, on each as many samples as make its cells
        // about square.
        let rounds = (self.radius / pulls.domain().edge_length() * DENSITY)
            .ceil()
            .clamp(3.0, MOST_ROUNDS);
        let width = self.radius / rounds;
        for ring in 0..rounds as usize {
            let inner = ring as f64;
            let share = (2.0 * inner + 1.0) / (rounds * rounds);
            let count = (std::f64::consts::TAU * (inner + 0.5)).ceil();
            for k in 0..count as usize {
                let angle = std::f64::consts::TAU * (k as f64 + 0.5) / count;
                let (y, x) = angle.sin_cos();
                let r = (inner + 0.5) * width;
                let at = Coord {
                    x: self.at.x + r * x,
                    y: self.at.y + r * y,
                };
                pulls.at_point(at, self.direction, self.weight * share / count);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::V2;
    use crate::{Domain, DomainOptions, Laplacian, Symmetry};
    use geo_types::{coord, polygon};

    #[test]
    fn the_disc_has_the_whole_weight_and_its_part_inside() {
        let shape = polygon![(x: 0., y: 0.), (x: 40., y: 0.), (x: 40., y: 40.), (x: 0., y: 40.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        for (at, radius, part) in [
            (coord! {x: 20.0, y: 20.0}, 0.0, 1.0),
            (coord! {x: 20.0, y: 20.0}, 7.0, 1.0),
            (coord! {x: 0.0, y: 20.0}, 7.0, 0.5),
            (coord! {x: 90.0, y: 20.0}, 7.0, 0.0),
        ] {
            let count = domain.vertex_count();
            let (mut masses, mut sums) = (vec![0.0; count], vec![V2::zeros(); count]);
            let mut pulls = Pulls::new(
                &domain,
                Symmetry::Cross,
                Laplacian::Cotangent,
                &mut masses,
                &mut sums,
            );
            let point = PointDirection {
                at,
                direction: coord! {x: 1.0, y: 1.0},
                radius,
                weight: 5.0,
            };
            point.pull(&mut pulls).expect("valid");
            let total: f64 = masses.iter().sum();
            // Rings are cut in samples: a half disc to one part in hundred.
            assert!((total - 5.0 * part).abs() < 0.05, "{total} {part}");
            // A cross at 45 degrees is represented by (-1, 0).
            let sum: V2 = sums.iter().sum();
            assert!((sum - V2::new(-total, 0.0)).norm() < 1e-9);
        }
    }
}
