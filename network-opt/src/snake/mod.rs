//! Networks on a mesh drawn to smooth streets: active contours (snakes).
//!
//! Networks that follow the edges of a mesh turn in steps. The paper's appendix
//! (Peng et al. 2016, after Kass, Witkin and Terzopoulos 1988) decomposes a
//! network into snakes, which run on through crossings, subdivides them, and
//! lets each become short and stiff. In the order of the data: `chains` finds
//! the snakes, `smooth` moves them, all at once, since they share their
//! crossings.

mod chains;
mod smooth;

pub use chains::{snakes, Snake};
pub use smooth::{smooth, smooth_snakes, SmoothNetwork, SnakeOptions};
