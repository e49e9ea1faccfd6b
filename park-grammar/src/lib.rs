#![doc = include_str!("../README.md")]

pub mod audit;
mod derive;
mod error;
#[cfg(feature = "gltf")]
pub mod gltf;
mod grammar;
pub mod grammars;
mod index;
pub mod library;
pub mod mesh;
pub mod picture;
mod plane;
mod rule;
pub mod scene;
mod select;
pub mod shape;
pub mod syntax;

pub use geo_types;

pub use audit::Audit;
pub use derive::DeriveOptions;
pub use error::ParkError;
pub use grammar::{Grammar, Loader};
pub use scene::Scene;
