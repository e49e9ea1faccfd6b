#![doc = include_str!("../README.md")]
//!
//! # The way of the data
//!
//! [`site::Site`] reads the boundary, its key elements and given roads;
//! [`network::Network`] is the planar map that they make; [`generate`] splits it
//! by asking [`splitter::Splitter`]s, optimises the streets and fills the
//! blocks; the [`Plan`] holds a [`Layout`], which [`metrics`](mod@metrics)
//! measures, [`check`](mod@check) proves and [`io`] writes.
//!
//! # Features
//!
//! - `cli` (default): the command `urban-layout`.
//! - `png` (default): plans as PNG pictures.
//! - `rayon` (default): several regions at a time; the result does not depend
//!   on it.
//!
//! # Papers
//!
//! Yang, Wang, Vouga and Wonka, "Urban Pattern: Layout Design by Hierarchical
//! Domain Splitting", ACM Transactions on Graphics 32(6), 2013, and its
//! supplement on cross fields.

pub mod adapt;
mod assemble;
pub mod check;
pub mod design;
mod error;
pub mod field;
pub mod floorplan;
mod inset;
pub mod io;
mod lay;
pub mod layout;
pub mod metrics;
pub mod network;
mod options;
mod parceler;
pub mod park;
mod plan;
mod plane;
pub mod planner;
mod progress;
pub mod region;
mod segments;
pub mod site;
pub mod splitter;
pub mod streamlines;

pub use error::{Error, Result};
pub use geo_types;
pub use layout::Layout;
pub use options::{FieldKind, PlanOptions, ScoreWeights};
pub use plan::{generate, generate_with, standard_splitters, Plan};
pub use progress::{Progress, Quiet, Stage};
pub use site::Site;
