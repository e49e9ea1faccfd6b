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
    /// Radius of its footprint, metres: of the ground that it alone takes, such
    /// as a tree's trunk.
    pub radius: f64,
    /// How far it reaches above the ground, metres: a tree's crown, which may
    /// hang over paths and meet other crowns.
    pub spread: f64,
    /// How high it is, metres.
    pub height: f64,
    /// The colour of its picture, `#rrggbb`.
    pub colour: &'static str,
    /// Its picture from above: elements of SVG in the square from -1 to 1, which
    /// the spread stretches; it faces east.
    pub picture: &'static str,
}

/// A volume that can be drawn along a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barrier {
    /// Its name in grammars.
    pub name: &'static str,
    /// How wide it is unless the grammar says, metres.
    pub width: f64,
    /// How high it is unless the grammar says, metres.
    pub height: f64,
    /// The colour of its picture, `#rrggbb`.
    pub colour: &'static str,
}

const fn material(name: &'static str, colour: &'static str, path: bool) -> Material {
    Material { name, colour, path }
}

const fn barrier(name: &'static str, size: [f64; 2], colour: &'static str) -> Barrier {
    Barrier {
        name,
        width: size[0],
        height: size[1],
        colour,
    }
}

const fn thing(
    name: &'static str,
    size: [f64; 3],
    colour: &'static str,
    picture: &'static str,
) -> Thing {
    Thing {
        name,
        radius: size[0],
        spread: size[1],
        height: size[2],
        colour,
        picture,
    }
}

/// All materials; the names in capitals are those of the notes.
pub const MATERIALS: [Material; 17] = [
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
    // Mown, and walked on.
    material("GrassPath", "#c3dd98", true),
];

/// All things.
pub const THINGS: [Thing; 15] = [
    thing(
        "Tree",
        [0.3, 2.5, 9.0],
        "#5f9a4a",
        r##"<circle r="1" fill="#5f9a4a" fill-opacity=".85"/><circle cx="-0.2" cy="0.2" r="0.6" fill="#74ad5c" fill-opacity=".7"/><circle r="0.12" fill="#5a4630"/>"##,
    ),
    thing(
        "TallTree",
        [0.35, 3.0, 15.0],
        "#4c8540",
        r##"<circle r="1" fill="#4c8540" fill-opacity=".85"/><circle cx="-0.2" cy="0.2" r="0.6" fill="#619a52" fill-opacity=".7"/><circle r="0.12" fill="#4e3b28"/>"##,
    ),
    thing(
        "SmallTree",
        [0.2, 1.5, 5.0],
        "#74ab58",
        r##"<circle r="1" fill="#74ab58" fill-opacity=".85"/><circle cx="-0.2" cy="0.2" r="0.55" fill="#8cc070" fill-opacity=".7"/><circle r="0.12" fill="#5a4630"/>"##,
    ),
    thing(
        "Conifer",
        [0.3, 1.8, 14.0],
        "#3f6f4e",
        r##"<path d="M1 0 .35.2.7.7.2.35 0 1-.2.35-.7.7-.35.2-1 0-.35-.2-.7-.7-.2-.35 0-1 .2-.35.7-.7.35-.2Z" fill="#3f6f4e"/>"##,
    ),
    thing(
        "Bush",
        [0.5, 0.7, 1.2],
        "#6d9f50",
        r##"<circle cx="-0.3" cy="-0.2" r="0.62" fill="#6d9f50"/><circle cx="0.35" cy="-0.1" r="0.6" fill="#7dae60"/><circle cy="0.38" r="0.58" fill="#64954a"/>"##,
    ),
    thing(
        "Flowers",
        [0.4, 0.4, 0.5],
        "#d77f9a",
        r##"<circle r="0.95" fill="#8db36b"/><circle cx="-0.4" cy="-0.2" r="0.25" fill="#d77f9a"/><circle cx="0.4" cy="-0.3" r="0.25" fill="#e6b84d"/><circle cx="0.1" cy="0.45" r="0.25" fill="#d77f9a"/>"##,
    ),
    thing(
        "Bench",
        [0.9, 0.9, 0.8],
        "#8a6a45",
        r##"<rect x="-0.3" y="-0.95" width="0.6" height="1.9" fill="#8a6a45"/><rect x="-0.3" y="-0.95" width="0.14" height="1.9" fill="#5f472c"/>"##,
    ),
    thing(
        "Table",
        [1.2, 1.2, 0.8],
        "#a07f55",
        r##"<rect x="-0.35" y="-0.75" width="0.7" height="1.5" fill="#a07f55"/><rect x="-0.75" y="-0.75" width="0.22" height="1.5" fill="#8a6a45"/><rect x="0.53" y="-0.75" width="0.22" height="1.5" fill="#8a6a45"/>"##,
    ),
    thing(
        "Bin",
        [0.3, 0.3, 1.0],
        "#555555",
        r##"<circle r="0.95" fill="#555555"/><circle r="0.55" fill="#333333"/>"##,
    ),
    thing(
        "Lamp",
        [0.2, 0.5, 4.0],
        "#f2c14e",
        r##"<circle r="1" fill="#f2c14e" fill-opacity=".35"/><circle r="0.4" fill="#f2c14e"/><circle r="0.18" fill="#4a4a4a"/>"##,
    ),
    thing(
        "Fountain",
        [2.0, 2.0, 2.5],
        "#7fb5d6",
        r##"<circle r="1" fill="#cfc8bd"/><circle r="0.84" fill="#7fb5d6"/><circle r="0.36" fill="#cfc8bd"/><circle r="0.24" fill="#b9dcee"/>"##,
    ),
    thing(
        "Statue",
        [0.8, 0.8, 3.0],
        "#9a9a9a",
        r##"<rect x="-0.7" y="-0.7" width="1.4" height="1.4" fill="#c4bfb6"/><circle r="0.42" fill="#8a8a8a"/>"##,
    ),
    thing(
        "Pond",
        [3.0, 3.0, 0.0],
        "#8ec3e0",
        r##"<path d="M1 0C1 .5.6 1 .1 1-.5 1-1 .6-1 .1-1-.4-.7-1-.1-1 .5-1 1-.5 1 0Z" fill="#8ec3e0"/>"##,
    ),
    thing(
        "Playground",
        [4.0, 4.0, 2.5],
        "#e0936a",
        r##"<circle r="1" fill="#ead9ae"/><rect x="-0.55" y="-0.1" width="0.9" height="0.22" fill="#e0936a"/><circle cx="0.5" cy="0.4" r="0.22" fill="#c65a4a"/><rect x="-0.3" y="-0.65" width="0.35" height="0.35" fill="#5b8fb9"/>"##,
    ),
    thing(
        "Gazebo",
        [2.5, 2.8, 3.5],
        "#b58b5a",
        r##"<path d="M1 0 .71.71 0 1-.71.71-1 0-.71-.71 0-1 .71-.71Z" fill="#b58b5a"/><circle r="0.12" fill="#7a5a35"/>"##,
    ),
];

/// All volumes along lines.
pub const BARRIERS: [Barrier; 4] = [
    barrier("Hedge", [0.8, 1.4], "#5c8a47"),
    barrier("Wall", [0.4, 1.8], "#a89c8c"),
    barrier("Fence", [0.1, 1.2], "#6b5b47"),
    barrier("Bush", [1.0, 1.2], "#6d9f50"),
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

/// The volume of that name.
#[must_use]
pub fn barrier_named(name: &str) -> Option<&'static Barrier> {
    BARRIERS.iter().find(|b| b.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_as_wide_as_their_footprints() {
        for thing in THINGS {
            assert!(
                thing.radius > 0.0 && thing.spread >= thing.radius,
                "{}",
                thing.name
            );
            assert!(thing.picture.contains("fill="), "{}", thing.name);
            assert!(material_named(thing.name).is_none());
        }
    }
}
