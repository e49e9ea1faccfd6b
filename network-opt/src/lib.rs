#![doc = include_str!("../README.md")]

pub use geo_types;

mod error;
pub mod mesh;
pub mod strip;

pub use error::{MeshError, MeshFault, OptimizeError};
pub use mesh::{End, FaceId, HalfEdgeId, Locator, PlanarMesh, Split, VertexId, Wire};
pub use strip::{
    optimize, roads, streets, Block, Energy, Fairness, Freedom, OptimizeOptions, Report, Step,
    StripFit, TargetShape,
};
