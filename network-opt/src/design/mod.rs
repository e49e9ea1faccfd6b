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
//! - [`Network`]: an answer; [`verify`] says what is wrong with it and [`cost`]
//!   what it costs, both without knowledge of any solver.

mod problem;
mod spec;
mod tessellation;
mod verify;

pub use problem::{
    EdgeState, Network, Pattern, PatternKind, Placement, Problem, RoomCount, RoomWish, Rooms,
};
pub use spec::{Coverage, Feature, Rim, Sinks, Specification};
pub use tessellation::Tessellation;
pub use verify::{cost, distances, full_cost, verify, Cost, Violation};
