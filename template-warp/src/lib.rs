//! Warp parcel and block templates onto polygonal regions.
pub use geo_types;

mod anderson;
mod corner;
mod error;
mod geometry;
mod hierarchy;
mod initial;
mod instance;
mod library;
mod matching;
mod region;
mod registration;
mod regression;
mod solve;
mod template;
mod tiling;
mod warp;

pub use corner::{corners, Corner, CornerOptions};
pub use error::WarpError;
pub use library::Library;
pub use matching::{match_templates, Candidate, MatchOptions};
pub use region::{EdgeUse, Region};
pub use registration::{Affine, AreaAffine, Deformation, PrincipalAffine, Rigid, Similarity};
pub use template::{SideUse, Sizes, Template};
pub use warp::{warp, WarpOptions, Warped, WarpedFace};
