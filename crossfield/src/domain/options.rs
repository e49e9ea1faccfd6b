//! How a domain is to be triangulated.

use crate::FieldError;

/// How a domain is triangulated.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DomainOptions {
    /// Wanted length of triangle edges, metres; 0 for `sqrt(area) / 40` (on
    /// needle-thin domains more, an eight-thousandth of the perimeter).
    ///
    /// Boundary edges are subdivided to at most this length.
    ///
    /// Default value: 0.
    pub edge_length: f64,
    /// How fast edges may grow inwards from the boundary, metres a metre; 0
    /// for an even mesh.
    ///
    /// With 0.3, say, edges are as long as `boundary_length` says on the
    /// boundary, or as an edge of the input that is shorter, and grow by 0.3 m
    /// for each metre inwards until they are `edge_length` long. On an even
    /// mesh only refinement towards `min_angle_deg` leads down to short edges.
    ///
    /// Default value: 0.
    pub grading: f64,
    /// Wanted length of triangle edges on the boundary where the mesh is
    /// graded, metres; 0 for `edge_length`, which is also the most it can be.
    ///
    /// Default value: 0.
    pub boundary_length: f64,
    /// Wanted smallest angle of the triangles, degrees, between 0 and 32.
    ///
    /// Reached except near small angles of the boundary itself, and except
    /// where refinement runs out of its budget of vertices (three times the
    /// vertices of an even mesh, and never more than `max_vertices`).
    ///
    /// Default value: 25.
    pub min_angle_deg: f64,
    /// Most vertices that the mesh may have.
    ///
    /// Default value: 200 000.
    pub max_vertices: usize,
    /// A boundary vertex that turns by more than this is a corner, degrees;
    /// smaller turns belong to a curve.
    ///
    /// Default value: 30.
    pub corner_deg: f64,
}

impl Default for DomainOptions {
    fn default() -> Self {
        Self {
            edge_length: 0.0,
            grading: 0.0,
            boundary_length: 0.0,
            min_angle_deg: 25.0,
            max_vertices: 200_000,
            corner_deg: 30.0,
        }
    }
}

impl DomainOptions {
    pub(super) fn check(&self) -> Result<(), FieldError> {
        if !(self.edge_length >= 0.0 && self.edge_length.is_finite()) {
            return Err(FieldError::option(
                "edge_length",
                format!("is {}; give metres, or 0 for automatic", self.edge_length),
            ));
        }
        if !(self.boundary_length >= 0.0 && self.boundary_length.is_finite()) {
            return Err(FieldError::option(
                "boundary_length",
                format!(
                    "is {}; give metres, or 0 for automatic",
                    self.boundary_length
                ),
            ));
        }
        if !(self.grading == 0.0 || (0.01..=10.0).contains(&self.grading)) {
            return Err(FieldError::option(
                "grading",
                format!(
                    "is {}; give 0.01 to 10, or 0 for an even mesh",
                    self.grading
                ),
            ));
        }
        if self.boundary_length > 0.0 && self.grading == 0.0 {
            return Err(FieldError::option(
                "boundary_length",
                "needs `grading` to be more than 0".to_owned(),
            ));
        }
        if !(0.0..=32.0).contains(&self.min_angle_deg) {
            return Err(FieldError::option(
                "min_angle_deg",
                format!("is {}; give 0 to 32 degrees", self.min_angle_deg),
            ));
        }
        if !(self.corner_deg > 0.0 && self.corner_deg < 180.0) {
            return Err(FieldError::option(
                "corner_deg",
                format!("is {}; give more than 0 and less than 180", self.corner_deg),
            ));
        }
        Ok(())
    }
}
