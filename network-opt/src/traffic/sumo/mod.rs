//! The traffic simulator SUMO (Eclipse; Lopez et al. 2018): a graph and its
//! trips as SUMO's plain files, and what SUMO makes of them.
//!
//! The paper evaluates with it (section 5.1): what was predicted by shortest
//! ways is compared with a simulation of every car. [`SumoFiles`] needs nothing
//! but this crate; [`SumoFiles::simulate`] runs SUMO's programs `netconvert`,
//! `duarouter` and `sumo`, which Debian has in the package `sumo`. Version 1.15
//! was tried.

mod files;
mod run;
mod tripinfo;
mod xml;

pub use files::{SumoFiles, SumoOptions};
pub use run::{is_installed, Simulated, SimulatedRun};
