#![doc = include_str!("../README.md")]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")
)]

mod candidates;
mod error;
mod field;
mod placement;
mod random;
mod score;
mod streamline;
mod trace;
mod vector;

pub use geo_types;

pub use candidates::{candidates, survey, CandidateOptions, Discarded, Seed, Survey, Unfit};
pub use error::TraceError;
pub use field::{arm_nearest, from_fn, Cursor, DirectionField, Exit, FromFn};
pub use placement::{lattice, place, place_scaled, Ends, PlacementOptions, Strategy};
pub use score::{
    choose, distinct, rank, BoundaryDistance, BoundaryMeasure, BoundaryOptions, Continuity,
    Divergence, Ranked, Score, SingularityDistance, WidthTable,
};
pub use streamline::{Sample, Streamline};
pub use trace::{trace, Stop, TraceOptions};
