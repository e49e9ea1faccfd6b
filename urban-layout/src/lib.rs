//! Neighbourhood plans from a site boundary.
mod adapt;
mod assemble;
pub mod check;
mod error;
mod inset;
pub mod io;
pub mod layout;
pub mod metrics;
mod network;
mod options;
mod parceler;
mod plan;
mod plane;
pub mod planner;
mod progress;
mod region;
mod segments;
pub mod site;
pub mod splitter;

pub use geo_types;
pub use error::{Error, Result};
pub use layout::Layout;
pub use options::{FieldKind, PlanOptions, ScoreWeights};
pub use plan::{generate, generate_with, standard_splitters, Plan};
pub use progress::{Progress, Quiet, Stage};
pub use site::Site;
