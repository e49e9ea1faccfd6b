#![doc = include_str!("../README.md")]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")
)]

mod candidates;
mod criteria;
mod error;
mod field;
mod placement;
mod random;
mod score;
mod separatrix;
mod smooth;
mod streamline;
mod tiles;
mod trace;
mod vector;

pub use geo_types;

pub use candidates::{
    candidates, candidates_by, survey, survey_by, CandidateOptions, Discarded, Seed, Survey, Unfit,
};
pub use criteria::{
    compare_criteria, criteria, Criteria, CriteriaComparison, CriteriaOptions, CriteriaTotals,
    Criterion, LineCriteria, SegmentCriteria, Spread, TileCriteria, Total, TurnRule,
};
pub use error::TraceError;
pub use field::{
    arm_nearest, from_fn, Cursor, DirectionField, Exit, FromFn, MeshError, TriangleField,
};
pub use placement::{lattice, place, place_scaled, Ends, PlacementOptions, Strategy};
pub use score::{
    choose, distinct, rank, BoundaryDistance, BoundaryMeasure, BoundaryOptions, Continuity,
    Divergence, Ranked, Score, SingularityDistance, WidthTable,
};
pub use separatrix::{
    separatrices, separatrix_arms, Separatrix, SeparatrixEnd, SeparatrixOptions, Singularity,
};
pub use streamline::{Sample, Streamline};
pub use tiles::{tiles, Dangling, HalfEdge, Tile, TileEdge, TileOptions, Tiling};
pub use trace::{
    trace, trace_dense, Curve, EdgeLine, EdgeMaps, EdgeOptions, EdgeTracer, RungeKutta, Stop,
    TraceOptions, Tracer,
};
