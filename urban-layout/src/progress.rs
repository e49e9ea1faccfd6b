//! Reporting from, and cancelling of, long work.

/// Receives the progress of a run, and may stop it.
///
/// ```
/// use urban_layout::{Progress, Stage};
/// struct Budget(u32);
/// impl Progress for Budget {
///     fn report(&mut self, _stage: Stage, _fraction: f64) -> bool {
///         self.0 = self.0.saturating_sub(1);
///         self.0 > 0 // false: stop
///     }
/// }
/// ```
pub trait Progress {
    /// Called often, with the share of `stage` that is done (0 to 1). Returns
    /// whether the work should go on.
    fn report(&mut self, stage: Stage, fraction: f64) -> bool;
}

/// The stages of a run, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Regions are split by streets.
    Split,
    /// The network's shape is optimised.
    Optimize,
    /// Blocks are filled with parcels.
    Fill,
}

impl Stage {
    /// A word for people.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Split => "splitting",
            Self::Optimize => "optimising",
            Self::Fill => "parcelling",
        }
    }
}

/// Progress that nobody looks at; never cancels.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quiet;

impl Progress for Quiet {
    fn report(&mut self, _stage: Stage, _fraction: f64) -> bool {
        true
    }
}
