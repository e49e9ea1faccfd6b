//! Networks and floorplans from functional specifications.
//!
//! After C.-H. Peng, Y.-L. Yang, F. Bao, D. Fink, D.-M. Yan, P. Wonka, N. J.
//! Mitra, *Computational Network Design from Functional Specifications*, ACM
//! Trans. Graph. 35 (2016): choose edges of a mesh so that every place is near
//! a street, every street leads to a sink, and length and travel are small.
//!
//! - [`Tessellation`]: the mesh;
//! - [`Specification`]: what the network is for, in a designer's words;
//! - [`Problem`]: what is asked of it, edge by edge;
//! - [`Way`], [`OneWay`]: streets over which traffic runs one way;
//! - [`Network`]: an answer; [`verify`] says what is wrong with it and [`cost`]
//!   what it costs, both without knowledge of any solver.

mod cost;
mod one_way;
mod partition;
mod paths;
mod placed;
mod problem;
mod route;
mod spec;
mod tessellation;
mod verify;
mod violation;
mod ways;

pub use cost::{cost, cost_of, Cost};
pub use one_way::OneWay;
pub use partition::{check_partition, partition, partition_around};
pub use paths::{paths_between, PathOptions};
pub use placed::PlacedSinks;
pub use problem::{
    EdgeState, Network, Pattern, PatternKind, Placement, Problem, RoomCount, RoomWish, Rooms,
};
pub use route::{Route, RouteKind};
pub use spec::{
    Across, Among, Coverage, Feature, Inside, Pairs, Parts, Place, Rim, Sinks, Specification,
    Traffic,
};
pub use tessellation::Tessellation;
pub use verify::verify;
pub use violation::Violation;
pub use ways::{distances, distances_from, Streets, Way};
pub(crate) use ways::{mean_way, ways_to, Heading};
