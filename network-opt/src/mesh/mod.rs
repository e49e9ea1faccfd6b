//! The planar half-edge mesh: built from linework, walked, split, edited and
//! checked.
//!
//! In the order of the data: `arrange` turns linework into points and edges
//! that meet only at points, `build` links them into loops and faces,
//! `planar` is the structure and its walks, `rings` its geometry, `locate`
//! finds places in it, `split` (after a look by `path`) and `edit` change it
//! and `regroup` sorts the loops into faces again, `sound` judges a face's
//! geometry, `check` proves the whole.

mod arrange;
mod build;
mod check;
mod edit;
pub(crate) mod index;
mod locate;
mod path;
mod planar;
pub(crate) mod predicates;
mod regroup;
mod rings;
pub(crate) mod sound;
mod split;

pub use arrange::Wire;
pub use locate::Locator;
pub use planar::{FaceId, HalfEdgeId, PlanarMesh, VertexId};
pub use split::{End, Split};
