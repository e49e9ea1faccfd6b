//! What expressions come to.

use std::sync::Arc;

use geo_types::Coord;

use super::eval::Places;
use crate::error::Failure;
use crate::scene::Kind;
use crate::select::Selection;
use crate::syntax::ast::{Expr, Span, Unit};

/// A number with its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Number {
    pub(crate) value: f64,
    pub(crate) unit: Unit,
}

/// A place with room around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spot {
    pub(crate) at: Coord<f64>,
    /// The room, metres; 0 if nothing is said.
    pub(crate) radius: f64,
    /// Which way it faces, radians counter-clockwise from east.
    pub(crate) facing: f64,
}

impl Spot {
    /// One that faces east, as all do of which nothing is said.
    pub(crate) fn new(at: Coord<f64>, radius: f64) -> Self {
        Self {
            at,
            radius,
            facing: 0.0,
        }
    }
}

/// One entry of a list of sizes: bounds of a length in metres, and of an angle in
/// radians; both drawn by whoever uses them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SizeRange {
    pub(crate) length: Option<[f64; 2]>,
    pub(crate) angle: Option<[f64; 2]>,
}

/// How many pieces, and how large.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sizing {
    pub(crate) count: Option<usize>,
    pub(crate) sizes: Vec<SizeRange>,
}

/// What an expression comes to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Number(Number),
    Bool(bool),
    Text(String),
    /// A word that is neither parameter nor selector nor attribute: a flag, a
    /// mode, a material, an object.
    Word(String),
    /// A point in local coordinates.
    Point(Coord<f64>),
    /// Places of the plane.
    Spots(Vec<Spot>),
    Selection(Selection),
    Sizing(Sizing),
    List(Vec<Value>),
    /// Whole numbers from the first to the last.
    Span([i64; 2]),
    /// A selection that has been drawn in from the boundary so many metres.
    Inset(Selection, f64),
    /// An object of the grammar's own.
    Kind(Arc<Kind>),
    /// What is evaluated for the region where it is used: a selection as the
    /// value of a parameter or of a place.
    Late(Arc<Late>),
}

/// An expression with the values that it was written among.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Late {
    pub(crate) expr: Expr,
    pub(crate) places: Places,
}

impl Number {
    pub(crate) fn plain(value: f64) -> Self {
        Self {
            value,
            unit: Unit::None,
        }
    }

    /// As a length in metres; without a unit it is metres.
    pub(crate) fn metres(self) -> Option<f64> {
        Some(match self.unit {
            Unit::None | Unit::Metres => self.value,
            Unit::Centimetres => 0.01 * self.value,
            Unit::Feet => 0.3048 * self.value,
            Unit::Degrees | Unit::Radians | Unit::Percent => return None,
        })
    }

    /// As an angle in radians; without a unit it is degrees.
    pub(crate) fn radians(self) -> Option<f64> {
        match self.unit {
            Unit::None | Unit::Degrees => Some(self.value.to_radians()),
            Unit::Radians => Some(self.value),
            _ => None,
        }
    }

    /// As a share of something `whole` metres long: a percentage or a number
    /// from 0 to 1 without a unit is a share, a length is divided by the whole.
    pub(crate) fn share(self, whole: f64) -> Option<f64> {
        match self.unit {
            Unit::None => Some(self.value),
            Unit::Percent => Some(0.01 * self.value),
            _ => Some(self.metres()? / whole),
        }
    }
}

impl Value {
    /// What it is, for errors.
    pub(crate) fn sort(&self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::Bool(_) => "a condition",
            Self::Text(_) => "a text",
            Self::Word(_) => "a word",
            Self::Point(_) => "a point",
            Self::Spots(_) => "places",
            Self::Selection(_) => "a selection",
            Self::Sizing(_) => "sizes",
            Self::List(_) => "a list",
            Self::Span(_) => "a span of whole numbers",
            Self::Inset(..) => "lines at a distance from the boundary",
            Self::Kind(_) => "an object",
            Self::Late(_) => "a selection",
        }
    }

    /// Whether it belongs to one region.
    pub(crate) fn is_local(&self) -> bool {
        match self {
            Self::Selection(_) | Self::Inset(..) | Self::Spots(_) => true,
            Self::List(items) => items.iter().any(Self::is_local),
            _ => false,
        }
    }

    /// The failure that something else was wanted.
    pub(crate) fn wrong(&self, span: Span, wanted: &str) -> Failure {
        let found = match self {
            Self::Word(word) => format!("the word {word}, which means nothing here"),
            other => other.sort().to_owned(),
        };
        let failure = Failure::fault(span, format!("expected {wanted}, found {found}"));
        match self {
            Self::Word(word) => match crate::rule::in_other_case(word) {
                Some(other) => failure.hint(format!("did you mean {other}?")),
                None => failure,
            },
            _ => failure,
        }
    }
}
