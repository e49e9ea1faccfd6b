//! Global optimisation of a street network (Urban Pattern, section 6).
//!
//! In the order of the data: `roads` finds the chains whose fairness counts,
//! `target` says where a block's vertices would like to be, `rails` where a
//! sliding junction may go, `system` is the energy and its sparse matrix,
//! `guard` keeps faces from turning inside out, `optimize` is the loop.

mod factor;
mod guard;
mod optimize;
mod rails;
mod roads;
mod system;
mod target;

pub use optimize::{optimize, Block, Energy, Fairness, Freedom, OptimizeOptions, Report, Step};
pub use roads::{roads, streets};
pub use target::{StripFit, TargetShape};
