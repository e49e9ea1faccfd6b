#![doc = include_str!("../README.md")]

pub use geo_types;

mod error;
pub mod mesh;

pub use error::{MeshError, MeshFault, OptimizeError};
pub use mesh::{End, FaceId, HalfEdgeId, Locator, PlanarMesh, Split, VertexId, Wire};
