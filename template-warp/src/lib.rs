#![doc = include_str!("../README.md")]
//!
//! # The way of the data
//!
//! [`Region`] -> [`corners`] -> [`match_templates`] -> [`warp`]: arc length and mean
//! value coordinates place the template's points; cells are registered and points
//! regressed until the energy rests; areas go down a level as regions of their own;
//! the pieces are stitched and certified; [`Warped`] comes out.
//!
//! # Features
//!
//! - `serde`: `geo_types` with serde support, for callers who store results.
//!
//! # References
//!
//! - Y.-L. Yang, J. Wang, E. Vouga, P. Wonka: Urban Pattern: Layout Design by
//!   Hierarchical Domain Splitting. ACM TOG 32(6), 2013.
//! - K. Hormann, M. Floater: Mean value coordinates for arbitrary planar polygons.
//!   ACM TOG 25(4), 2006.
//! - D. Anderson: Iterative procedures for nonlinear integral equations. JACM 12(4),
//!   1965; on geometry solvers: Y. Peng et al., ACM TOG 37(4), 2018.
//! - L. Liu et al.: A local/global approach to mesh parameterization. CGF 27(5), 2008.

#![cfg_attr(
    test,
    allow(
        clippy::unwrap_used,
        reason = "a test that cannot go on should stop where it stands"
    )
)]

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
