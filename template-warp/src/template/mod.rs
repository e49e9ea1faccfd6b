//! Templates: what they are made of, and the file format.

pub(crate) mod format;
pub(crate) mod length;
pub(crate) mod model;

pub use format::SideUse;
pub use length::Sizes;
pub use model::Template;
