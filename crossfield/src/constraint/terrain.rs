//! Fields that follow the slope of the ground.

use std::fmt;

use geo_types::Coord;

use super::{check_weight, Constraint, Pulls, Raster};
use crate::operators::gradient;
use crate::plane::{coord, left, wedge};
use crate::FieldError;

/// Where the ground is how high: a closure `|x, y| z`, or a [`Raster`].
pub trait HeightMap {
    /// Height at `at`, metres; `None` or not finite where it is not known.
    fn height(&self, at: Coord<f64>) -> Option<f64>;
}

impl<F: Fn(f64, f64) -> f64> HeightMap for F {
    fn height(&self, at: Coord<f64>) -> Option<f64> {
        Some(self(at.x, at.y))
    }
}

impl HeightMap for Raster {
    fn height(&self, at: Coord<f64>) -> Option<f64> {
        Self::height(self, at)
    }
}

impl HeightMap for &Raster {
    fn height(&self, at: Coord<f64>) -> Option<f64> {
        (**self).height(at)
    }
}

/// Which arm follows the slope. For crosses it makes no difference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SlopeArm {
    /// An arm points uphill.
    #[default]
    Uphill,
    /// An arm runs along the contour line, uphill on its left.
    Contour,
}

/// Crosses along the gradient and the contour lines of the ground (the
/// supplement's future work: "roads that follow geographic features, minimize
/// elevation changes").
///
/// Adds `weight * integral s |D - D~|^2 dA / unit^2` to the energy, D~ along
/// the gradient and `s = g^2 / (g^2 + half_slope^2)` for a gradient of length
/// g: flat ground, whose gradient has no meaning, does not count.
pub struct Terrain<H> {
    /// Where the ground is how high.
    pub heights: H,
    /// Its strength, to be compared with that of a stroke; positive.
    pub weight: f64,
    /// The slope (rise over run) that counts by half; positive.
    ///
    /// Default value: 0.03.
    pub half_slope: f64,
    /// Which arm follows the slope.
    ///
    /// Default value: [`SlopeArm::Uphill`].
    pub arm: SlopeArm,
}

impl<H: HeightMap> Terrain<H> {
    /// The ground of these heights.
    ///
    /// Heights are taken at the vertices of the mesh, and the gradient is
    /// constant in each triangle; triangles with an unknown height do not
    /// count.
    #[must_use]
    pub fn new(heights: H, weight: f64) -> Self {
        Self {
            heights,
            weight,
            half_slope: 0.03,
            arm: SlopeArm::Uphill,
        }
    }
}

impl<H> fmt::Debug for Terrain<H> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Terrain")
            .field("weight", &self.weight)
            .field("half_slope", &self.half_slope)
            .field("arm", &self.arm)
            .finish_non_exhaustive()
    }
}

impl<H: HeightMap> Constraint for Terrain<H> {
    fn pull(&self, pulls: &mut Pulls<'_>) -> Result<(), FieldError> {
        check_weight(self.weight)?;
        if !(self.half_slope > 0.0 && self.half_slope.is_finite()) {
            return Err(FieldError::option(
                "half_slope",
                format!("is {}; give a positive rise over run", self.half_slope),
            ));
        }
        let domain = pulls.domain().clone();
        let heights: Vec<f64> = (0..domain.vertex_count())
            .map(|v| self.heights.height(domain.vertex(v)).unwrap_or(f64::NAN))
            .collect();
        let per_area = self.weight / (pulls.unit() * pulls.unit());
        for triangle in domain.triangles() {
            let vertices = triangle.map(|v| v as usize);
            let corners = vertices.map(|v| domain.inner.mesh.points[v]);
            let Some(slope) = gradient(corners, vertices.map(|v| heights[v])) else {
                continue;
            };
            let steepness = slope.norm_squared();
            if !(steepness > 0.0 && steepness.is_finite()) {
                continue;
            }
            let direction = match self.arm {
                SlopeArm::Uphill => slope,
                SlopeArm::Contour => -left(slope),
            };
            let area = wedge(corners[1] - corners[0], corners[2] - corners[0]) / 2.0;
            let strength = steepness / (steepness + self.half_slope * self.half_slope);
            for v in vertices {
                pulls.at_vertex(v, coord(direction), per_area * strength * area / 3.0);
            }
        }
        Ok(())
    }
}
