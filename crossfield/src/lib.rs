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
#[cfg(any(test, feature = "laws"))]
pub mod laws;
mod measure;
mod operators;
mod plane;
mod report;
mod singularity;
mod turning;

pub use boundary::{BoundaryField, CornerRule};
pub use cross::Cross;
pub use distance::{DistanceField, Footpoint, Footpoints, MedialAxis, Sight, Weighting};
pub use domain::{Corner, Cursor, Domain, DomainOptions, Exit, LineEdge, Piece};
pub use error::FieldError;
pub use field::{Field, FieldDesign};
pub use geo_types;
pub use harmonic::HarmonicField;
pub use operators::Laplacian;
pub use report::{compare, Comparison, FieldReport};
pub use singularity::{IndexCheck, Singularity};
pub use turning::{AlongCurve, Turning};
