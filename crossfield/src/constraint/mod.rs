//! What a field should follow besides the boundary.
//!
//! Constraints are further sums `w_k |D - D~_k|^2` in the energy of a
//! B-field (equation 2 of Ortner et al. 2023), integrals along a line or over
//! an area, not sums over vertices: so that neither the fineness of the mesh
//! nor how densely a stroke was sampled counts. They add to the diagonal of
//! the same matrix, which costs nothing.

mod point;
mod raster;
mod stroke;
mod terrain;

use std::fmt::Debug;

use geo_types::Coord;

pub use point::PointDirection;
pub use raster::Raster;
pub use stroke::Stroke;
pub use terrain::{HeightMap, SlopeArm, Terrain};

use crate::boundary::BoundaryField;
use crate::domain::{Cursor, Domain};
use crate::field::{Field, FieldDesign};
use crate::operators::Laplacian;
use crate::plane::{orient, vector, V2};
use crate::symmetry::Symmetry;
use crate::system::System;
use crate::FieldError;

/// Something that a field should follow.
///
/// Implement it for constraints of your own: say with the methods of
/// [`Pulls`] which directions are wanted where, and how strongly.
pub trait Constraint: Debug {
    /// Adds what this constraint wants to `pulls`.
    ///
    /// # Errors
    ///
    /// Values out of range are [`FieldError::BadOption`].
    fn pull(&self, pulls: &mut Pulls<'_>) -> Result<(), FieldError>;
}

impl<T: Constraint + ?Sized> Constraint for &T {
    fn pull(&self, pulls: &mut Pulls<'_>) -> Result<(), FieldError> {
        (**self).pull(pulls)
    }
}

impl<T: Constraint + ?Sized> Constraint for Box<T> {
    fn pull(&self, pulls: &mut Pulls<'_>) -> Result<(), FieldError> {
        (**self).pull(pulls)
    }
}

/// The directions that constraints want, collected on the vertices of a
/// domain.
///
/// Masses have no unit: a weight times a length over [`Pulls::unit`], or
/// times an area over its square. A weight then compares with
/// [`BoundaryField::omega`], which is that of the boundary.
#[derive(Debug)]
pub struct Pulls<'a> {
    domain: &'a Domain,
    symmetry: Symmetry,
    unit: f64,
    masses: &'a mut [f64],
    pulls: &'a mut [V2],
    cursor: Cursor,
}

impl<'a> Pulls<'a> {
    pub(crate) fn new(
        domain: &'a Domain,
        symmetry: Symmetry,
        laplacian: Laplacian,
        masses: &'a mut [f64],
        pulls: &'a mut [V2],
    ) -> Self {
        let unit = match laplacian {
            Laplacian::Cotangent => domain.area().sqrt(),
            Laplacian::Uniform => domain.edge_length(),
        };
        Self {
            domain,
            symmetry,
            unit,
            masses,
            pulls,
            cursor: Cursor::default(),
        }
    }

    /// The domain of the field.
    #[must_use]
    pub fn domain(&self) -> &Domain {
        self.domain
    }

    /// How many arms its directions have.
    #[must_use]
    pub fn symmetry(&self) -> Symmetry {
        self.symmetry
    }

    /// What lengths are measured by, metres: the square root of the domain's
    /// area; with [`Laplacian::Uniform`] the edge length of the mesh, as there
    /// each boundary vertex counts 1.
    #[must_use]
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// Pulls at the point `at` towards an arm along `direction`: at the
    /// corners of its triangle, by their shares. Returns whether `at` lies in
    /// the domain; if not, or if `direction` has no or no finite length, nothing
    /// happens.
    ///
    /// A single point of any mass has no effect in the limit of fine meshes;
    /// sum up points along a line or over an area.
    pub fn at_point(&mut self, at: Coord<f64>, direction: Coord<f64>, mass: f64) -> bool {
        let Some(triangle) = self.domain.locate(at, &mut self.cursor) else {
            return false;
        };
        let target = self.symmetry.power(vector(direction));
        let p = self.domain.local(at);
        let mesh = &self.domain.inner.mesh;
        let vertices = mesh.triangles[triangle].map(|v| v as usize);
        let [a, b, c] = vertices.map(|v| mesh.points[v]);
        let shares = [orient(b, c, p), orient(c, a, p), orient(a, b, p)].map(|s| s.max(0.0));
        let total: f64 = shares.iter().sum();
        if total > 0.0 {
            for (v, share) in vertices.into_iter().zip(shares) {
                self.add(v, target, mass * share / total);
            }
        }
        true
    }

    /// Pulls at vertex `v` towards an arm along `direction`; nothing happens
    /// for a direction of no or no finite length.
    ///
    /// # Panics
    ///
    /// If `v` is not a vertex of the domain.
    pub fn at_vertex(&mut self, v: usize, direction: Coord<f64>, mass: f64) {
        let target = self.symmetry.power(vector(direction));
        self.add(v, target, mass);
    }

    fn add(&mut self, v: usize, target: V2, mass: f64) {
        let wanted = target != V2::zeros() && target.x.is_finite() && target.y.is_finite();
        if wanted && mass > 0.0 && mass.is_finite() {
            self.masses[v] += mass;
            self.pulls[v] += target * mass;
        }
    }
}

/// A boundary field that follows further constraints.
///
/// ```
/// use crossfield::{geo_types::{coord, line_string, polygon}, BoundaryField, ConstrainedField,
///     Cross, Cursor, Domain, DomainOptions, FieldDesign, Stroke};
///
/// // A rectangle, and a street wanted at 45 degrees through its middle.
/// let site = polygon![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 60.), (x: 0., y: 60.)];
/// let domain = Domain::new(&site, &DomainOptions::default())?;
/// let street = Stroke::new(line_string![(x: 35., y: 20.), (x: 55., y: 40.)], 100.0);
/// let design = ConstrainedField::new(BoundaryField::default()).with(street);
/// let field = design.design(&domain)?;
/// let cross = field.cross(coord! { x: 45.0, y: 30.0 }, &mut Cursor::default());
/// let wanted = Cross::from_angle(std::f64::consts::FRAC_PI_4);
/// assert!(cross.expect("inside").deviation(&wanted) < 0.1);
/// # Ok::<(), crossfield::FieldError>(())
/// ```
///
#[doc = include_str!("../../images/c-field.svg")]
#[derive(Debug)]
pub struct ConstrainedField<'a> {
    base: BoundaryField,
    constraints: Vec<Box<dyn Constraint + 'a>>,
}

impl<'a> ConstrainedField<'a> {
    /// `base` without further constraints. An [`omega`](BoundaryField::omega)
    /// of 0 is allowed here, and leaves the boundary out.
    #[must_use]
    pub fn new(base: BoundaryField) -> Self {
        Self {
            base,
            constraints: Vec::new(),
        }
    }

    /// With one more constraint.
    #[must_use]
    pub fn with(mut self, constraint: impl Constraint + 'a) -> Self {
        self.constraints.push(Box::new(constraint));
        self
    }

    /// The energy with all pulls.
    pub(crate) fn system(&self, domain: &Domain) -> Result<System, FieldError> {
        let mut system = self.base.system(domain)?;
        let System { masses, pulls, .. } = &mut system;
        let mut pulls = Pulls::new(
            domain,
            self.base.symmetry,
            self.base.laplacian,
            masses,
            pulls,
        );
        for constraint in &self.constraints {
            constraint.pull(&mut pulls)?;
        }
        Ok(system)
    }
}

impl FieldDesign for ConstrainedField<'_> {
    /// The field of `domain` that follows its boundary and all constraints.
    ///
    /// # Errors
    ///
    /// Those of [`BoundaryField`] and of the constraints;
    /// [`FieldError::SingularSystem`] if nothing at all is to be followed.
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        self.base.minimise(domain, &self.system(domain)?)
    }
}

/// [`FieldError::BadOption`] unless a weight is positive and below 1e12.
fn check_weight(weight: f64) -> Result<(), FieldError> {
    if weight > 0.0 && weight < 1e12 {
        return Ok(());
    }
    Err(FieldError::option(
        "weight",
        format!("of a constraint is {weight}; give more than 0 and less than 1e12"),
    ))
}

/// [`FieldError::BadOption`] unless both components are finite.
fn check_finite(option: &'static str, c: Coord<f64>) -> Result<(), FieldError> {
    if c.x.is_finite() && c.y.is_finite() {
        return Ok(());
    }
    Err(FieldError::option(
        option,
        format!("of a constraint is ({}, {}); give finite numbers", c.x, c.y),
    ))
}
