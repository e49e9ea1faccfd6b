//! Why no park came about.

use crate::syntax::ast::Span;
use crate::syntax::{Diagnostic, Diagnostics, Sources};

/// Why a grammar could not be read, or a park not be derived.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ParkError {
    /// The grammar is not what it should be; every fault with its place.
    #[error("{0}")]
    Grammar(Diagnostics),
    /// A rule could not be applied to a region, and named no alternative.
    #[error("{0}")]
    Rule(Diagnostics),
    /// A grammar's file cannot be read.
    #[error("{what}")]
    File {
        /// Which, and why.
        what: String,
    },
    /// The outline of the park is none.
    #[error("the park's outline: {what}")]
    Outline {
        /// What is wrong with it.
        what: String,
    },
    /// The caller sets a parameter that the grammar does not have.
    #[error("the grammar has no parameter {name}, its parameters are: {known}")]
    Parameter {
        /// Its name.
        name: String,
        /// Those that the grammar has.
        known: String,
    },
    /// The derivation did not come to an end.
    #[error("the derivation was stopped: {what}; look for a rule that leads back to itself, or raise the limit")]
    Limit {
        /// Which limit was met.
        what: String,
    },
    /// The caller asked to stop.
    #[error("the derivation was cancelled")]
    Cancelled,
}

/// Why an operation cannot be done: what is said where it stands in the grammar.
/// An operation with an `else` does that instead.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Failure {
    /// The region does not suit the rule.
    Unfit(Diagnostic),
    /// The grammar asks for what makes no sense: no `else` helps.
    Fault(Diagnostic),
    /// Not a matter of this rule.
    Stopped(ParkError),
}

impl Failure {
    pub(crate) fn unfit(span: Span, what: impl Into<String>) -> Self {
        Self::Unfit(
            Diagnostic::new(span, what).hint("give the operation an alternative: else { ... }"),
        )
    }

    pub(crate) fn fault(span: Span, what: impl Into<String>) -> Self {
        Self::Fault(Diagnostic::new(span, what))
    }

    pub(crate) fn hint(self, hint: impl Into<String>) -> Self {
        match self {
            Self::Unfit(d) => Self::Unfit(d.hint(hint)),
            Self::Fault(d) => Self::Fault(d.hint(hint)),
            Self::Stopped(error) => Self::Stopped(error),
        }
    }

    pub(crate) fn into_error(self, sources: &Sources) -> ParkError {
        match self {
            Self::Unfit(d) | Self::Fault(d) => ParkError::Rule(Diagnostics {
                all: vec![d],
                sources: sources.clone(),
            }),
            Self::Stopped(error) => error,
        }
    }
}
