//! From a grammar and an outline to a park.
//!
//! A node of the derivation is a region with the operations to be done on it. An
//! operation divides the region into others, which become nodes with the
//! operations of its blocks; or cuts a shape out of it; or puts things on it. A
//! region that nothing divides is left as a piece of ground.

mod content;
mod divide;
mod eval;
mod limits;
mod math;
mod node;
mod object;
mod options;
mod patches;
mod random;
mod run;
mod spot;
mod standing;
mod start;
mod value;
mod walk;

pub(crate) use content::Size;
pub(crate) use divide::{outputs, path_width};
pub(crate) use eval::{Places, Scope, ATTRIBUTES};
#[cfg(test)]
pub(crate) use limits::Limits;
pub(crate) use limits::Watch;
pub(crate) use math::NAMES as FUNCTIONS;
pub(crate) use node::Node;
pub(crate) use object::{mesh_file, OBJECT};
pub use options::DeriveOptions;
pub(crate) use patches::Patches;
pub(crate) use random::Stream;
pub(crate) use run::Run;
pub(crate) use standing::{clear, inside, Disc, Standing};
pub(crate) use value::{Number, SizeRange, Sizing, Spot, Value};
