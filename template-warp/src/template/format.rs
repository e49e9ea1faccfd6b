//! The TOML form of a library, as it is written. Every key is described in
//! `src/library/README.md`; [`super::model`] checks it and puts numbers in.

use super::length::Length;
use std::collections::BTreeMap;

#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct File {
    pub(crate) template: Vec<Spec>,
}

/// One template as written.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Spec {
    pub(crate) name: String,
    pub(crate) label: String,
    #[serde(default = "one")]
    pub(crate) probability: f64,
    #[serde(default)]
    pub(crate) mirror: bool,
    #[serde(default = "single")]
    pub(crate) symmetry: usize,
    pub(crate) depth: Option<[Length; 2]>,
    pub(crate) points: BTreeMap<String, [Length; 2]>,
    pub(crate) outline: Vec<String>,
    #[serde(default)]
    pub(crate) corners: BTreeMap<String, CornerSpec>,
    pub(crate) sides: Vec<SideUse>,
    #[serde(default)]
    pub(crate) elastic: Vec<[String; 2]>,
    #[serde(default)]
    pub(crate) divide: Vec<DivideSpec>,
    #[serde(default)]
    pub(crate) arc: Vec<ArcSpec>,
    pub(crate) face: Vec<FaceSpec>,
    #[serde(default)]
    pub(crate) align: Vec<AlignSpec>,
    #[serde(default)]
    pub(crate) centreline: Vec<CentrelineSpec>,
}

/// The user's word on whether a point of the outline is a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum CornerSpec {
    Convex,
    Concave,
    Regular,
}

/// What must lie across a side of a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum SideUse {
    /// A street along the whole side.
    Street,
    /// No street along the side.
    NoStreet,
    /// Anything, also a mixture.
    Any,
}

#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DivideSpec {
    pub(crate) edges: Vec<[String; 2]>,
    pub(crate) length: Length,
    #[serde(default = "single")]
    pub(crate) min: usize,
    #[serde(default)]
    pub(crate) wide_ends: f64,
    #[serde(default = "unchanged")]
    pub(crate) adapt: [f64; 2],
}

#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ArcSpec {
    pub(crate) points: Vec<String>,
    pub(crate) centre: [Length; 2],
}

#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FaceSpec {
    pub(crate) label: String,
    pub(crate) points: Vec<String>,
    #[serde(default)]
    pub(crate) child: Vec<String>,
    #[serde(default)]
    pub(crate) corners: Vec<String>,
    pub(crate) class: ClassSpec,
    #[serde(default = "one")]
    pub(crate) tolerance: f64,
    #[serde(default)]
    pub(crate) access_exempt: bool,
}

#[derive(Clone, Copy, Debug, serde::Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum ClassSpec {
    Rigid,
    Similarity([f64; 2]),
    Principal { x: [f64; 2], y: [f64; 2] },
    Area(f64),
}

#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AlignSpec {
    pub(crate) kind: AlignKind,
    pub(crate) points: Vec<String>,
}

/// What the points of an alignment lie on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum AlignKind {
    /// A straight line that is fitted to the points.
    Line,
    /// The straight line between the first and the last point.
    Chord,
    /// A circle that is fitted to the points.
    Circle,
    /// A free smooth curve through the points (moving least squares).
    Smooth,
}

#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CentrelineSpec {
    pub(crate) points: Vec<String>,
    /// Label-independent: the number of the face, in file order, whose map
    /// carries the points that no face owns.
    pub(crate) face: usize,
}

fn one() -> f64 {
    1.0
}

fn unchanged() -> [f64; 2] {
    [1.0, 1.0]
}

fn single() -> usize {
    1
}
