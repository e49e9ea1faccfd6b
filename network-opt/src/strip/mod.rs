//! Global optimisation of a street network (Urban Pattern, section 6).
//!
//! In the order of the data: `short` collapses short edges, `roads` finds the
//! chains whose fairness counts, `target` says where a block's vertices would like to be, `rails` where a
//! sliding junction may go, `guard` keeps faces from turning inside out,
//! `optimize` is the loop over `options`; `quadratic` has the energy and its
//! sparse matrix.

mod guard;
mod optimize;
mod options;
mod rails;
mod roads;
mod short;
mod target;

pub use optimize::optimize;
pub use options::{Block, Energy, Fairness, Freedom, OptimizeOptions, Report, Step};
pub use roads::{roads, streets};
pub use short::collapse_short_edges;
pub use target::{StripFit, TargetShape};
