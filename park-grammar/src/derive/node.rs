//! Nodes of a derivation.

use super::{Standing, Stream};
use crate::plane::Area;
use crate::scene::Ground;
use crate::shape::Region;

/// A region in the making.
pub(crate) struct Node {
    pub(crate) region: Region,
    pub(crate) ground: Ground,
    pub(crate) material: String,
    /// The rule that it follows.
    pub(crate) rule: String,
    pub(crate) chance: Stream,
    /// What has been cut out of it.
    pub(crate) carved: Vec<Area>,
    /// What stands on it.
    pub(crate) standing: Standing,
    /// Whether other regions have taken its place.
    pub(super) divided: bool,
    /// Whether its first shape has been cut already: the centre of a crossing.
    pub(super) shaped: bool,
    /// How deep in rules.
    pub(super) level: usize,
}
