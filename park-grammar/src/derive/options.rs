//! What a derivation is asked for besides its grammar and outline.

use std::collections::BTreeMap;
use std::time::Duration;

/// How a park is derived.
#[derive(Clone, Debug, PartialEq)]
pub struct DeriveOptions {
    /// Seed of all chance; the same seed gives the same park.
    ///
    /// Default value: 0.
    pub seed: u64,
    /// Values for parameters of the grammar, in the place of its own.
    ///
    /// Default value: none.
    pub params: BTreeMap<String, f64>,
    /// Deepest nesting of rules.
    ///
    /// Default value: 64.
    pub depth: usize,
    /// Most operations in all.
    ///
    /// Default value: 1,000,000.
    pub operations: usize,
    /// Time, by the clock; `None` for as long as it takes.
    ///
    /// Default value: 60 s.
    pub time: Option<Duration>,
}

impl Default for DeriveOptions {
    fn default() -> Self {
        Self {
            seed: 0,
            params: BTreeMap::new(),
            depth: 64,
            operations: 1_000_000,
            time: Some(Duration::from_secs(60)),
        }
    }
}
