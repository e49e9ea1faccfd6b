//! What a network is worth to those who travel on it: demand, assignment, and
//! the traffic simulator SUMO.
//!
//! After C.-H. Peng et al., *Computational Network Design from Functional
//! Specifications*, ACM Trans. Graph. 35 (2016), sections 3 ("Transport
//! modeling") and 5.1 ("Evaluation"). In the order of the data:
//!
//! - [`RoadClass`]: how fast, how wide and how important streets are;
//! - [`Road`]: a street as a line; [`roads_of`] gives those of finished levels;
//! - [`StreetGraph`]: nodes and directed links, *supply*;
//! - [`Demand`]: who wants to go where, and [`Trip`]s drawn from it;
//! - [`assign`]: who takes which way, *assignment*, and what that comes to;
//! - [`sumo`]: the same network and trips as files of SUMO, and what SUMO says.
//!
//! Coordinates and lengths are metres, times seconds, speeds metres per
//! second, and flows vehicles per hour.

mod assign;
mod class;
mod demand;
mod equilibrium;
mod error;
mod graph;
mod levels;
mod noding;
mod places;
pub mod sumo;
mod trees;

pub use assign::{assign, Assignment, Traffic};
pub use class::{RoadClass, MPH};
pub use demand::{Demand, Flow, Trip};
pub use equilibrium::{Equilibrium, EquilibriumOptions};
pub use error::TrafficError;
pub use graph::{Link, StreetGraph};
pub use levels::{exits, roads_of};
pub use noding::{NodingOptions, Road};
pub use places::{nearest_nodes, spread_points};
