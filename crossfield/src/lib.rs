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
#[cfg(any(test, feature = "laws"))]
pub mod laws;
mod measure;
mod operators;
mod optimal;
mod plane;
mod prescribed;
mod random;
mod report;
mod singularity;
mod symmetry;
mod system;
mod turning;

pub use boundary::{BoundaryField, CornerRule, Start};
pub use constraint::{
    ConstrainedField, Constraint, HeightMap, PointDirection, Pulls, Raster, SlopeArm, Stroke,
    Terrain,
};
pub use cross::Cross;
pub use distance::{DistanceField, Footpoint, Footpoints, MedialAxis, Sight, Weighting};
pub use domain::{Corner, Cursor, Domain, DomainOptions, Exit, LineEdge, Piece};
pub use error::FieldError;
pub use field::{Field, FieldDesign};
pub use geo_types;
pub use harmonic::{
    Alignment, BoundaryPiece, Elements, GalleryEntry, GradientField, HarmonicBasis, HarmonicField,
};
pub use operators::Laplacian;
pub use optimal::OptimalField;
pub use prescribed::{Connection, PrescribedField};
pub use report::{compare, Comparison, FieldReport};
pub use singularity::{IndexCheck, Singularity};
pub use symmetry::{Rosy, Symmetry};
pub use turning::{AlongCurve, Turning};
