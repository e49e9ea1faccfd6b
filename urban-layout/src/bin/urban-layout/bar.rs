//! A progress bar on a terminal; silence elsewhere. Ctrl-C needs no handler:
//! files are written whole or not at all.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressStyle};
use urban_layout::{Progress, Stage};

#[derive(Debug)]
pub(crate) struct Bar(Option<ProgressBar>);

impl Bar {
    pub(crate) fn new() -> Self {
        if !std::io::stderr().is_terminal() {
            return Self(None);
        }
        let bar = ProgressBar::new(1000);
        if let Ok(style) =
            ProgressStyle::with_template("{msg:>12} {wide_bar} {percent:>3} %  {elapsed}")
        {
            bar.set_style(style);
        }
        Self(Some(bar))
    }
}

impl Progress for Bar {
    fn report(&mut self, stage: Stage, fraction: f64) -> bool {
        if let Some(bar) = &self.0 {
            bar.set_message(stage.as_str());
            bar.set_position((fraction.clamp(0.0, 1.0) * 1000.0) as u64);
        }
        true
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}

/// Counts operations of a derivation, of which nobody knows how many there will
/// be; on a terminal only.
#[derive(Debug)]
pub(crate) struct Counter(Option<ProgressBar>);

impl Counter {
    pub(crate) fn new(word: &'static str) -> Self {
        if !std::io::stderr().is_terminal() {
            return Self(None);
        }
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{msg:>12} {spinner} {pos}  {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(word);
        Self(Some(bar))
    }

    /// Tells how many have been done; whether to go on.
    pub(crate) fn report(&mut self, done: usize) -> bool {
        if let Some(bar) = &self.0 {
            bar.set_position(done as u64);
        }
        true
    }
}

impl Drop for Counter {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
