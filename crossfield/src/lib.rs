#![doc = include_str!("../README.md")]

mod boundary;
mod cross;
mod distance;
mod domain;
mod error;
mod factor;
mod field;
mod footpoint;
mod harmonic;
mod measure;
mod operators;
mod plane;
mod singularity;

pub use boundary::{BoundaryField, CornerRule};
pub use cross::Cross;
pub use distance::DistanceField;
pub use domain::{Corner, Cursor, Domain, DomainOptions, Exit};
pub use error::FieldError;
pub use field::{Field, FieldDesign};
pub use geo_types;
pub use harmonic::{
    Alignment, BoundaryPiece, Elements, GalleryEntry, GradientField, HarmonicBasis, HarmonicField,
};
pub use operators::Laplacian;
pub use singularity::{IndexCheck, Singularity};
