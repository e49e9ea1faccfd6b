#![doc = include_str!("../README.md")]

mod boundary;
mod connection;
mod constraint;
mod cross;
mod distance;
mod domain;
mod edit;
mod error;
mod factor;
mod field;
mod footpoint;
mod harmonic;
mod measure;
mod operators;
mod optimal;
mod plane;
mod prescribed;
mod random;
mod singularity;
mod symmetry;
mod system;

pub use boundary::{BoundaryField, CornerRule, Start};
pub use constraint::{
    ConstrainedField, Constraint, HeightMap, PointDirection, Pulls, Raster, SlopeArm, Stroke,
    Terrain,
};
pub use cross::Cross;
pub use distance::DistanceField;
pub use domain::{Corner, Cursor, Domain, DomainOptions, Exit};
pub use error::FieldError;
pub use field::{Field, FieldDesign};
pub use geo_types;
pub use harmonic::HarmonicField;
pub use operators::Laplacian;
pub use optimal::OptimalField;
pub use prescribed::{Connection, PrescribedField};
pub use singularity::{IndexCheck, Singularity};
pub use symmetry::{Rosy, Symmetry};
