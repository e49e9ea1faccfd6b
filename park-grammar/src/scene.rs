//! What a derivation makes: a park.

use geo_types::{Coord, Polygon};

use crate::mesh::Mesh;

/// What a piece of ground is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Ground {
    /// Not for walking: lawn, beds, water.
    Region,
    /// For walking.
    Path,
}

/// A piece of the park's ground; the pieces tile the park.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Piece {
    /// Its outline, metres; exterior counter-clockwise.
    pub polygon: Polygon<f64>,
    /// What it is.
    pub ground: Ground,
    /// What it is made of, such as `Lawn`.
    pub material: String,
    /// The rule that it was left by.
    pub rule: String,
}

/// A thing that stands somewhere.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Object {
    /// What it is, such as `Tree`.
    pub name: String,
    /// Where its middle stands.
    pub at: Coord<f64>,
    /// Radius of its footprint, metres; footprints do not overlap, and lie on the
    /// ground that they were put on.
    pub radius: f64,
    /// How far it reaches above the ground, metres: a crown.
    pub spread: f64,
    /// How high it is, metres.
    pub height: f64,
    /// Which way it faces, radians counter-clockwise from east.
    pub facing: f64,
    /// What it was put on: a fountain may be put on a path, no tree comes to
    /// stand on one by chance.
    pub ground: Ground,
}

/// A kind of object that the grammar brought with it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Kind {
    /// Its name, that of the parameter.
    pub name: String,
    /// Radius of its footprint, metres.
    pub radius: f64,
    /// How far it reaches above the ground, metres.
    pub spread: f64,
    /// How high it is, metres.
    pub height: f64,
    /// The colour of its picture, `#rrggbb`.
    pub colour: String,
    /// Its shape, if there is a file of it; one for all objects of this kind,
    /// each turned about its upright axis.
    pub mesh: Option<Mesh>,
}

/// Something with an outline that rises from the ground: a hedge, a wall.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Volume {
    /// What it is, such as `Hedge`.
    pub name: String,
    /// Its footprint, metres.
    pub polygon: Polygon<f64>,
    /// How high it is, metres.
    pub height: f64,
}

/// A park: ground that tiles its outline, and what stands on it.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Scene {
    /// The ground.
    pub pieces: Vec<Piece>,
    /// Things.
    pub objects: Vec<Object>,
    /// Hedges, walls and the like.
    pub volumes: Vec<Volume>,
    /// The grammar's own kinds among the things.
    pub kinds: Vec<Kind>,
    /// How many things had no room where a rule would have put them.
    pub skipped: usize,
}
