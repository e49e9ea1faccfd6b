//! Nodes of a derivation.

use std::sync::Arc;

use super::{Patches, Standing, Stream};
use crate::scene::Ground;
use crate::shape::Region;

/// A region in the making.
pub(crate) struct Node {
    pub(crate) region: Region,
    pub(crate) ground: Ground,
    /// What it is made of, one of the library's.
    pub(crate) material: &'static str,
    /// The rule that it follows.
    pub(crate) rule: Arc<str>,
    pub(crate) chance: Stream,
    /// What has been cut out of it.
    pub(crate) carved: Patches,
    /// What stands on it.
    pub(crate) standing: Standing,
    /// Whether other regions have taken its place.
    pub(super) divided: bool,
    /// Whether its first shape has been cut already: the centre of a crossing.
    pub(super) shaped: bool,
    /// How deep in rules.
    pub(super) level: usize,
}

impl Node {
    /// A region where a derivation begins.
    pub(super) fn new(region: Region, rule: Arc<str>, chance: Stream) -> Self {
        Self {
            region,
            ground: Ground::Region,
            material: "Lawn",
            rule,
            chance,
            carved: Patches::default(),
            standing: Standing::default(),
            divided: false,
            shaped: false,
            level: 0,
        }
    }

    /// A region that was cut from this one: it follows the same rule until
    /// another is named, with a chance of its own.
    pub(super) fn child(&mut self, region: Region) -> Self {
        Self {
            ground: self.ground,
            material: self.material,
            level: self.level,
            ..Self::new(region, self.rule.clone(), self.chance.child())
        }
    }
}
