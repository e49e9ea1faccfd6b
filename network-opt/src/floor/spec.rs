//! What a floor is for, in an architect's words.

use super::template::Shape;
use crate::design::Feature;

/// How much something is wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Wish {
    /// Not at all.
    #[default]
    Free,
    /// Doing without costs so much, in edges of corridor at a weight of 1.
    Weighted(f64),
    /// It has to be.
    Required,
}

impl Wish {
    /// What doing without costs: nothing to say if it is free, `Some(None)` if
    /// it is required.
    pub(super) fn cost(self) -> Option<Option<f64>> {
        match self {
            Self::Free => None,
            Self::Weighted(cost) => Some(Some(cost)),
            Self::Required => Some(None),
        }
    }
}

/// A place on a floor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(untagged))]
pub enum Place {
    /// The vertex of this number.
    Vertex(usize),
    /// The one nearest to this point, in the coordinates of the mesh.
    Point([f64; 2]),
}

/// Another kind of room, and how much it is wanted beside one.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub struct Beside {
    /// Its name.
    pub room: String,
    /// How much.
    pub wish: Wish,
}

/// Near an entrance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub struct Near {
    /// So many metres, straight, from the middle of the room to an entrance.
    pub within: f64,
    /// How much that is wanted.
    pub wish: Wish,
}

/// A kind of room: its shapes, how many there may be, and where.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(default, rename_all = "kebab-case", deny_unknown_fields)
)]
pub struct Room {
    /// What it is called. Not empty, and no other's.
    pub name: String,
    /// The shapes that it may have.
    ///
    /// Default value: two by two squares.
    pub shapes: Vec<Shape>,
    /// Whether shapes may be mirrored.
    ///
    /// Default value: yes.
    pub mirrored: bool,
    /// So many at least.
    ///
    /// Default value: 0.
    pub least: usize,
    /// So many at most.
    ///
    /// Default value: `None`, any number.
    pub most: Option<usize>,
    /// No smaller than this, square metres.
    ///
    /// Default value: 0.
    pub least_area: f64,
    /// No larger than this, square metres.
    ///
    /// Default value: `None`.
    pub most_area: Option<f64>,
    /// What each costs, in edges of corridor: more for rooms that are of little
    /// use.
    ///
    /// Default value: 0.
    pub cost: f64,
    /// A wall at the facade, or at an obstacle that is open to the sky.
    ///
    /// Default value: free.
    pub window: Wish,
    /// Near an entrance.
    ///
    /// Default value: `None`.
    pub near_entrance: Option<Near>,
    /// A wall in common with another room.
    pub beside: Vec<Beside>,
    /// Kinds of rooms with which it must have no wall in common.
    pub apart: Vec<String>,
    /// If there are any: only where it touches one of these edges.
    pub touching: Vec<usize>,
    /// Only where it touches none of these edges.
    pub avoiding: Vec<usize>,
    /// If there are any points: only with all its squares' middles inside this
    /// ring, in the coordinates of the mesh.
    pub within: Vec<[f64; 2]>,
}

impl Default for Room {
    fn default() -> Self {
        let square = [(0, 0), (1, 0), (0, 1), (1, 1)];
        Self {
            name: "room".to_owned(),
            shapes: Shape::new(&square).into_iter().collect(),
            mirrored: true,
            least: 0,
            most: None,
            least_area: 0.0,
            most_area: None,
            cost: 0.0,
            window: Wish::Free,
            near_entrance: None,
            beside: Vec::new(),
            apart: Vec::new(),
            touching: Vec::new(),
            avoiding: Vec::new(),
            within: Vec::new(),
        }
    }
}

/// Elevators or stairs, at the same place on all storeys.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub struct Shaft {
    /// What it is called.
    ///
    /// Default value: "lift".
    #[cfg_attr(feature = "serde", serde(default = "lift"))]
    pub name: String,
    /// Where it is: its faces are those of the nearest place where its shape
    /// fits; of a shaft without a shape this is the vertex itself.
    pub at: Place,
    /// The faces that it takes, which no room may have; `None` for a mere
    /// vertex that corridors pass or end at.
    #[cfg_attr(feature = "serde", serde(default))]
    pub shape: Option<Shape>,
}

#[cfg(feature = "serde")]
fn lift() -> String {
    "lift".to_owned()
}

/// What shafts are to the corridors of a storey.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum ShaftRole {
    /// Places to pass where there are entrances, and sinks where there are none.
    #[default]
    Auto,
    /// Places that corridors have to pass on the way to the entrances: the
    /// paper's figure 9 (1).
    Pass,
    /// Sinks: where corridors lead, the paper's figure 9 (2).
    Sinks,
}

/// Where there are no rooms and no corridors.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(default, rename_all = "kebab-case", deny_unknown_fields)
)]
pub struct Obstacle {
    /// What it is called.
    pub name: String,
    /// A ring, in the coordinates of the mesh: all faces with their middle inside.
    pub polygon: Vec<[f64; 2]>,
    /// Faces besides.
    pub faces: Vec<usize>,
    /// Whether it is open to the sky, as a roof garden is: rooms beside it have
    /// windows.
    pub open: bool,
}

/// What one storey is for (section 5.2 of the paper).
///
/// All weights are in the objective that corridors are counted in: an edge of
/// mean length costs [`length`](Self::length).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(default, rename_all = "kebab-case", deny_unknown_fields)
)]
pub struct FloorSpecification {
    /// What it is called.
    pub name: String,
    /// The rooms that there may be.
    ///
    /// Default value: those of [`FloorSpecification::default`], which tile any
    /// mesh of quads.
    pub rooms: Vec<Room>,
    /// Where people come in, on the boundary: sinks, each of which a corridor
    /// leads to.
    ///
    /// Default value: none. A storey without any and without shafts has one in
    /// the middle of its longest straight facade.
    pub entrances: Vec<Place>,
    /// What shafts are to its corridors.
    ///
    /// Default value: automatic.
    pub shafts: ShaftRole,
    /// Where there are no rooms.
    pub obstacles: Vec<Obstacle>,
    /// Whether a room may lie around an inner vertex of three or five quads.
    ///
    /// Default value: yes.
    pub irregular: bool,
    /// Corridors along the facade: each edge an occurrence.
    ///
    /// Default value: 2 each.
    pub facade: Feature,
    /// Corridors that end in the open.
    ///
    /// Default value: 3 each.
    pub dead_ends: Feature,
    /// Vertices with three corridors or more.
    ///
    /// Default value: free.
    pub branches: Feature,
    /// Three edges that turn one way and then the other.
    ///
    /// Default value: 5 each.
    pub zig_zags: Feature,
    /// Opposite edges of a quad.
    ///
    /// Default value: 4 each.
    pub too_close: Feature,
    /// Three corridors at a vertex of four edges.
    ///
    /// Default value: free.
    pub t_junctions: Feature,
    /// lambda_L, the weight of length.
    ///
    /// Default value: 1.
    pub length: f64,
    /// lambda_D, the weight of travel.
    ///
    /// Default value: 0, as in the paper's figure 9.
    pub travel: f64,
}

impl Default for FloorSpecification {
    fn default() -> Self {
        Self {
            name: String::new(),
            rooms: default_rooms(),
            entrances: Vec::new(),
            shafts: ShaftRole::Auto,
            obstacles: Vec::new(),
            irregular: true,
            facade: Feature::Weighted(2.0),
            dead_ends: Feature::Weighted(3.0),
            branches: Feature::Free,
            zig_zags: Feature::Weighted(5.0),
            too_close: Feature::Weighted(4.0),
            t_junctions: Feature::Free,
            length: 1.0,
            travel: 0.0,
        }
    }
}

/// Offices by windows, meeting rooms, and store rooms of one or two squares for
/// what is left over, which are dear.
fn default_rooms() -> Vec<Room> {
    let shapes = |texts: &[&str]| texts.iter().filter_map(|t| t.parse().ok()).collect();
    let room = |name: &str, texts: &[&str], cost: f64, window: Wish| Room {
        name: name.to_owned(),
        shapes: shapes(texts),
        cost,
        window,
        ..Room::default()
    };
    vec![
        room("office", &["##/##"], 0.0, Wish::Weighted(0.5)),
        room("team", &["###/###"], 0.0, Wish::Weighted(0.5)),
        room("corner", &["###/##."], 0.2, Wish::Weighted(0.5)),
        room("meeting", &["##/#.", "###"], 1.2, Wish::Free),
        room("store", &["#", "##"], 2.5, Wish::Free),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_has_shapes_that_are_shapes() {
        let spec = FloorSpecification::default();
        let shapes: Vec<usize> = spec.rooms.iter().map(|r| r.shapes.len()).collect();
        assert_eq!(shapes, [1, 1, 1, 2, 2]);
        assert_eq!(Room::default().shapes[0].to_string(), "##/##");
        assert_eq!(Wish::Weighted(2.0).cost(), Some(Some(2.0)));
        assert_eq!(Wish::Required.cost(), Some(None));
    }
}
