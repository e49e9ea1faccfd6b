//! How far a derivation may go, and who is told of it.
//!
//! Three things are bounded: how deep rules lead to rules, how many operations
//! there are in all, and the time. Rules that lead back to themselves meet the
//! first or the second; the third holds within one operation too, since whatever
//! loops over many things or cells looks at the clock on its way
//! ([`Watch::tick`]). What cannot be interrupted is one polygon boolean: a grid of
//! a quarter of a million cells has one that takes a second or two.

use std::cell::Cell;
use std::fmt::{self, Display};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::DeriveOptions;
use crate::error::{Failure, ParkError};

/// Most expressions evaluated in a derivation: selections that are passed on from
/// rule to rule are evaluated anew for each region, and may double each time.
const VALUES: usize = 5_000_000;

/// Ticks from one look at the clock to the next.
const PATIENCE: usize = 64;

/// The limits of a derivation, with what has been used of them.
pub(crate) struct Limits<'w> {
    depth: usize,
    operations: usize,
    time: Option<Duration>,
    began: Instant,
    done: Cell<usize>,
    values: Cell<usize>,
    ticks: Cell<usize>,
    /// Told of the number of operations; answers whether to go on.
    watch: &'w dyn Fn(usize) -> bool,
}

impl<'w> Limits<'w> {
    /// From now on.
    pub(crate) fn new(options: &DeriveOptions, watch: &'w dyn Fn(usize) -> bool) -> Self {
        Self {
            depth: options.depth,
            operations: options.operations,
            time: options.time,
            began: Instant::now(),
            done: Cell::new(0),
            values: Cell::new(0),
            ticks: Cell::new(0),
            watch,
        }
    }

    /// Deepest nesting of rules.
    pub(super) fn depth(&self) -> usize {
        self.depth
    }

    /// Counts an operation of a rule.
    pub(super) fn operation(&self, rule: &str) -> Result<(), Failure> {
        self.done.set(self.done.get() + 1);
        if self.done.get() > self.operations {
            return Err(stopped(
                rule,
                format_args!("it came to {} operations", self.operations),
            ));
        }
        self.look(rule)
    }

    /// Counts a value that is evaluated.
    pub(super) fn value(&self, rule: &str) -> Result<(), Failure> {
        self.values.set(self.values.get() + 1);
        if self.values.get() > VALUES {
            return Err(stopped(rule, format_args!("it came to {VALUES} values")));
        }
        self.tick(rule)
    }

    /// That a rule leads no deeper than is allowed.
    pub(super) fn deeper(&self, rule: &str, level: usize) -> Result<(), Failure> {
        if level >= self.depth {
            return Err(stopped(
                rule,
                format_args!("rules lead to rules {} deep", self.depth),
            ));
        }
        Ok(())
    }

    /// Looks at the clock once in a while.
    fn tick(&self, rule: &str) -> Result<(), Failure> {
        self.ticks.set(self.ticks.get() + 1);
        if self.ticks.get().is_multiple_of(PATIENCE) {
            return self.look(rule);
        }
        Ok(())
    }

    /// Looks at the clock, and asks whether to go on.
    fn look(&self, rule: &str) -> Result<(), Failure> {
        if let Some(time) = self.time.filter(|&time| self.began.elapsed() > time) {
            let seconds = time.as_secs_f64();
            return Err(stopped(rule, format_args!("it took more than {seconds} s")));
        }
        if (self.watch)(self.done.get()) {
            Ok(())
        } else {
            Err(Failure::Stopped(ParkError::Cancelled))
        }
    }
}

fn stopped(rule: &str, what: impl Display) -> Failure {
    Failure::Stopped(ParkError::Limit {
        what: format!("{what}, the last in the rule {rule}"),
    })
}

impl fmt::Debug for Watch<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Watch")
            .field("rule", &self.rule)
            .finish_non_exhaustive()
    }
}

/// What a long operation looks at on its way.
#[derive(Clone)]
pub(crate) struct Watch<'w> {
    limits: &'w Limits<'w>,
    /// The rule that the operation stands in.
    rule: Arc<str>,
}

impl<'w> Watch<'w> {
    pub(crate) fn new(limits: &'w Limits<'w>, rule: &Arc<str>) -> Self {
        Self {
            limits,
            rule: rule.clone(),
        }
    }

    /// To be called between steps that are long: an error when the time is up.
    pub(crate) fn look(&self) -> Result<(), Failure> {
        self.limits.look(&self.rule)
    }

    /// To be called each time round a loop that may be long: an error when the
    /// time is up.
    pub(crate) fn tick(&self) -> Result<(), Failure> {
        self.limits.tick(&self.rule)
    }
}
