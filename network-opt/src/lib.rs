#![doc = include_str!("../README.md")]

pub use geo_types;

pub mod design;
mod dice;
mod error;
pub mod floor;
pub mod formulate;
pub mod levels;
pub mod mesh;
pub mod mip;
pub mod quad;
mod quadratic;
mod random;
pub mod snake;
pub mod solve;
pub mod strip;
pub mod traffic;

pub use error::{DesignError, MeshError, MeshFault, OptimizeError};
pub use mesh::{End, FaceId, HalfEdgeId, Locator, PlanarMesh, Split, VertexId, Wire};
pub use strip::{
    collapse_short_edges, optimize, roads, streets, Block, Energy, Fairness, Freedom,
    OptimizeOptions, Report, Step, StripFit, TargetShape,
};
