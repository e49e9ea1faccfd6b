//! What a grammar file says, as a tree.
//!
//! Every node that an error may point at carries its span; two trees that
//! differ in spans alone are equal, so that `parse(print(tree)) == tree` can be
//! asked of any tree.

use std::fmt;

/// Where a piece of text lies: bytes `start..end` of file number `file`.
///
/// All spans are equal: see the module's text.
#[derive(Clone, Copy, Default, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Span {
    /// The file, by its position in [`Sources`](super::Sources).
    pub file: usize,
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// From the start of one to the end of another of the same file.
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        Self {
            end: other.end.max(self.end),
            ..self
        }
    }
}

impl PartialEq for Span {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}..{}", self.file, self.start, self.end)
    }
}

/// A word with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Name {
    /// The word.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

/// A whole file.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct File {
    /// The version of the language, from the line `grammar 1`.
    pub version: u32,
    /// Comments above the line with the version.
    pub head: Vec<String>,
    /// What follows, in its order.
    pub items: Vec<Item>,
    /// Comments after the last item.
    pub foot: Vec<String>,
}

/// A comment-bearing entry of a file.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Item {
    /// Comments above it, without their marks.
    pub comments: Vec<String>,
    /// What it is.
    pub kind: ItemKind,
    /// Where it stands, comments apart.
    pub span: Span,
}

/// The sorts of entry.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ItemKind {
    /// `include "paths.park"`
    Include(Text),
    /// `param PathWidth = 2 m`, or without the first word.
    Param {
        /// What it is called.
        name: Name,
        /// Its value, unless the caller gives another.
        value: Expr,
    },
    /// `fun Edge(area) -> Contract(1, area)`, or `fun Far(k) = EDGE[k + 2]`: a
    /// name for operations or for a value, with places for values.
    Function {
        /// What it is called.
        name: Name,
        /// Its places.
        places: Vec<Name>,
        /// What it stands for.
        meaning: Meaning,
    },
    /// `Region -> Grid(2, 2) { Quarter } { Path }`
    Rule {
        /// What it is called.
        name: Name,
        /// Places for values, if any.
        places: Vec<Name>,
        /// What is done to a region of that name.
        body: Body,
    },
}

/// What a function stands for.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Meaning {
    /// Operations.
    Body(Body),
    /// A value.
    Value(Expr),
}

/// A text in quotes.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Text {
    /// Without quotes and escapes.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

/// Operations, done one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Body {
    /// The operations; none in `{}`.
    pub operations: Vec<Operation>,
}

/// An operation, a rule, a material or an object: `Grid(2, 2) { A } { B } else { C }`.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Operation {
    /// Comments above it.
    pub comments: Vec<String>,
    /// What is to be done.
    pub name: Name,
    /// With what; `None` without brackets.
    pub arguments: Option<Vec<Argument>>,
    /// What becomes of what it makes: regions, paths, centres.
    pub blocks: Vec<Block>,
    /// What to do where it fails.
    pub otherwise: Option<Block>,
    /// Where it stands, comments apart.
    pub span: Span,
}

/// `{ 0.75: TreeStrip | GrassRegion }`
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Block {
    /// What stands between the bars; none in `{}`.
    pub branches: Vec<Branch>,
    /// Where it stands, with its braces.
    pub span: Span,
}

/// One of several: with a size, a weight or a condition before it, or without.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Branch {
    /// What stands before the colon.
    pub head: Option<Head>,
    /// What is done.
    pub body: Body,
    /// Where it stands.
    pub span: Span,
}

/// What stands before the colon of a branch.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Head {
    /// A size, a weight, or a condition.
    Value(Expr),
    /// The word `else`.
    Else(Span),
}

/// `width = 2`, `OUTER: 0.375`, or a value alone.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Argument {
    /// The name before `=`.
    pub name: Option<Name>,
    /// The value.
    pub value: Expr,
    /// The value after `:`, which belongs to the one before.
    pub at: Option<Expr>,
}

/// A value with its place.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where it stands.
    pub span: Span,
}

/// The sorts of value.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ExprKind {
    /// `2`, `2 m`, `30 deg`, `40 %`; never negative, that is [`UnaryOp::Negate`].
    Number(f64, Unit),
    /// `"fountain"`
    Text(String),
    /// A parameter, place, selector, attribute, flag, object or rule.
    Name(String),
    /// `Corners(Region)`, `Part(OUTER, [0, 0.5])`; with blocks too where it
    /// stands for operations.
    Call {
        /// What is called.
        name: Name,
        /// With what.
        arguments: Vec<Argument>,
        /// What it is to do with what it finds.
        blocks: Vec<Block>,
    },
    /// `[5, 10]`, `[5-10]`, `[]`: a range, a set of two numbers or a list.
    List(Vec<Expr>),
    /// `(0.8, 0.1)`: a point.
    Point(Box<[Expr; 2]>),
    /// `EDGE[0, 2]`, `EDGE[0..2]`, `Centre[5]`
    Index(Box<Expr>, Vec<Expr>),
    /// `0..2`
    Span(Box<[Expr; 2]>),
    /// `3 {2, 6, 2}`, `{[7, 15]a[-15, 15]}`
    Sizes {
        /// How many, if that is said.
        count: Option<Box<Expr>>,
        /// How large.
        sizes: Vec<Size>,
    },
    /// `-x`, `not x`
    Unary(UnaryOp, Box<Expr>),
    /// `a + b`, `OUTER and not EDGE[0]`
    Binary(BinaryOp, Box<[Expr; 2]>),
}

/// One size of a list: a length or a range of lengths, and an angle or a range
/// of angles.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Size {
    /// How long; fitted if that is not said.
    pub length: Option<Expr>,
    /// How much the cut leans.
    pub angle: Option<Expr>,
}

/// What a number counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Unit {
    /// Nothing said: metres where a length is asked for, a share where one is.
    #[default]
    None,
    /// `m`
    Metres,
    /// `cm`
    Centimetres,
    /// `ft`, of 0.3048 m
    Feet,
    /// `deg`
    Degrees,
    /// `rad`
    Radians,
    /// `%`
    Percent,
}

impl Unit {
    /// All that are written.
    pub const WRITTEN: [Self; 6] = [
        Self::Metres,
        Self::Centimetres,
        Self::Feet,
        Self::Degrees,
        Self::Radians,
        Self::Percent,
    ];

    /// How it is written.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Metres => "m",
            Self::Centimetres => "cm",
            Self::Feet => "ft",
            Self::Degrees => "deg",
            Self::Radians => "rad",
            Self::Percent => "%",
        }
    }

    /// The unit that a word is.
    #[must_use]
    pub fn parse(word: &str) -> Option<Self> {
        Self::WRITTEN.into_iter().find(|unit| unit.as_str() == word)
    }
}

/// Operators before a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum UnaryOp {
    /// `-`
    Negate,
    /// `not`: all of the boundary but a selection; a condition turned round.
    Not,
}

/// Operators between two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum BinaryOp {
    /// `or`: what either selects; either holds.
    Or,
    /// `and`: what both select; both hold.
    And,
    /// `minus`: what the first selects and the second does not.
    Minus,
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    AtMost,
    /// `>`
    Greater,
    /// `>=`
    AtLeast,
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
}

impl BinaryOp {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::Or,
        Self::And,
        Self::Minus,
        Self::Equal,
        Self::NotEqual,
        Self::Less,
        Self::AtMost,
        Self::Greater,
        Self::AtLeast,
        Self::Add,
        Self::Subtract,
        Self::Multiply,
        Self::Divide,
    ];

    /// How it is written.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Or => "or",
            Self::And => "and",
            Self::Minus => "minus",
            Self::Equal => "==",
            Self::NotEqual => "!=",
            Self::Less => "<",
            Self::AtMost => "<=",
            Self::Greater => ">",
            Self::AtLeast => ">=",
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
        }
    }

    /// How firmly it binds; what binds more firmly is done first. Those of one
    /// strength are done from the left, but comparisons do not follow each
    /// other.
    #[must_use]
    pub fn strength(self) -> u8 {
        match self {
            Self::Or => 1,
            Self::And | Self::Minus => 2,
            Self::Equal
            | Self::NotEqual
            | Self::Less
            | Self::AtMost
            | Self::Greater
            | Self::AtLeast => 3,
            Self::Add | Self::Subtract => 4,
            Self::Multiply | Self::Divide => 5,
        }
    }

    /// Whether it compares.
    #[must_use]
    pub fn compares(self) -> bool {
        self.strength() == Self::Equal.strength()
    }
}
