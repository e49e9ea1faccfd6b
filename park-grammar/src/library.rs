//! Materials and objects that every grammar knows by name.

/// What ground can be made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Its name in grammars.
    pub name: &'static str,
    /// Its colour, `#rrggbb`.
    pub colour: &'static str,
    /// Whether one walks on it.
    pub path: bool,
}

/// A thing that can stand in a park.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thing {
    /// Its name in grammars.
    pub name: &'static str,
    /// Radius of its footprint, metres.
    pub radius: f64,
    /// How high it is, metres.
    pub height: f64,
    /// The colour of its picture, `#rrggbb`.
    pub colour: &'static str,
}

const fn material(name: &'static str, colour: &'static str, path: bool) -> Material {
    Material { name, colour, path }
}

const fn thing(name: &'static str, radius: f64, height: f64, colour: &'static str) -> Thing {
    Thing {
        name,
        radius,
        height,
        colour,
    }
}

/// All materials; the names in capitals are those of the notes.
pub const MATERIALS: [Material; 16] = [
    material("Lawn", "#b7d58a", false),
    material("Meadow", "#c9d98b", false),
    material("GREEN_GRASS", "#a9cf7d", false),
    material("BLUE_GRASS", "#9cc8a6", false),
    material("FlowerBed", "#e7b8c4", false),
    material("ShrubBed", "#8db36b", false),
    material("Soil", "#b99a78", false),
    material("Water", "#9cc9e3", false),
    material("Sand", "#ead9ae", false),
    material("Planting", "#98bf78", false),
    material("Gravel", "#e3d9c4", true),
    material("Paving", "#d5d0c8", true),
    material("CementPath", "#d9d7d2", true),
    material("StonePath", "#cfc6b8", true),
    material("Asphalt", "#bcbcbc", true),
    material("Deck", "#c9a779", true),
];

/// All things.
pub const THINGS: [Thing; 12] = [
    thing("Tree", 2.5, 9.0, "#5f9a4a"),
    thing("TallTree", 3.0, 15.0, "#4c8540"),
    thing("SmallTree", 1.5, 5.0, "#74ab58"),
    thing("Bush", 0.7, 1.2, "#6d9f50"),
    thing("Bench", 0.9, 0.8, "#8a6a45"),
    thing("Lamp", 0.25, 4.0, "#f2c14e"),
    thing("Fountain", 2.0, 2.5, "#7fb5d6"),
    thing("Statue", 0.8, 3.0, "#9a9a9a"),
    thing("Pond", 3.0, 0.0, "#8ec3e0"),
    thing("Playground", 4.0, 2.5, "#e0936a"),
    thing("Table", 1.2, 0.8, "#a07f55"),
    thing("Bin", 0.3, 1.0, "#555555"),
];

/// The material of that name.
#[must_use]
pub fn material_named(name: &str) -> Option<&'static Material> {
    MATERIALS.iter().find(|m| m.name == name)
}

/// The thing of that name.
#[must_use]
pub fn thing_named(name: &str) -> Option<&'static Thing> {
    THINGS.iter().find(|t| t.name == name)
}
