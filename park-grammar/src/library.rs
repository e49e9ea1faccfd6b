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

/// The outline of a crown from above, and of the leaves in its middle.
macro_rules! crown_outline {
    () => {
        "M0.87 -0.09Q1.08 -0.32 0.75 -0.38Q0.79 -0.89 0.29 -0.78Q0.13 -1.14 -0.11 -0.85Q-0.44 -1.04 -0.55 -0.69Q-0.97 -0.6 -0.86 -0.18Q-1.12 -0.01 -0.84 0.15Q-1 0.64 -0.49 0.68Q-0.46 1.05 -0.16 0.84Q0.13 1.14 0.36 0.8Q0.76 0.84 0.77 0.43Q1.11 0.23 0.87 -0.09Z"
    };
}
macro_rules! crown_middle {
    () => {
        "M0.36 -0.29Q0.42 -0.58 0.15 -0.42Q-0.19 -0.76 -0.33 -0.3Q-0.69 -0.26 -0.46 0.01Q-0.66 0.32 -0.3 0.36Q-0.1 0.75 0.19 0.43Q0.47 0.54 0.38 0.25Q0.79 -0.04 0.36 -0.29Z"
    };
}

/// The picture of a crown: leaves, lighter ones in the middle, and their edge.
macro_rules! crown {
    ($leaves:literal, $middle:literal, $edge:literal) => {
        concat!(
            "<path d=\"",
            crown_outline!(),
            "\" fill=\"",
            $leaves,
            "\" fill-opacity=\".9\" stroke=\"",
            $edge,
            "\" stroke-width=\".05\" stroke-linejoin=\"round\"/><path d=\"",
            crown_middle!(),
            "\" fill=\"",
            $middle,
            "\" fill-opacity=\".75\"/><circle r=\".07\" fill=\"#4e3b28\"/>"
        )
    };
}

/// The picture of a crown in colours that a grammar brought.
pub(crate) fn crown(leaves: &str, middle: &str, edge: &str) -> String {
    format!(
        "<path d=\"{}\" fill=\"{leaves}\" fill-opacity=\".9\" stroke=\"{edge}\" stroke-width=\".05\" stroke-linejoin=\"round\"/>\
         <path d=\"{}\" fill=\"{middle}\" fill-opacity=\".75\"/><circle r=\".07\" fill=\"#4e3b28\"/>",
        crown_outline!(),
        crown_middle!()
    )
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
        crown!("#5f9a4a", "#78b05f", "#365f2a"),
    ),
    thing(
        "TallTree",
        [0.35, 3.0, 15.0],
        "#4c8540",
        crown!("#4c8540", "#639d54", "#2c5526"),
    ),
    thing(
        "SmallTree",
        [0.2, 1.5, 5.0],
        "#74ab58",
        crown!("#74ab58", "#8ec272", "#467634"),
    ),
    thing(
        "Conifer",
        [0.3, 1.8, 14.0],
        "#3f6f4e",
        r##"<path d="M1 0L0.66 0.15L0.9 0.43L0.53 0.42L0.62 0.78L0.3 0.61L0.22 0.97L0 0.68L-0.22 0.97L-0.3 0.61L-0.62 0.78L-0.53 0.42L-0.9 0.43L-0.66 0.15L-1 0L-0.66 -0.15L-0.9 -0.43L-0.53 -0.42L-0.62 -0.78L-0.3 -0.61L-0.22 -0.97L0 -0.68L0.22 -0.97L0.3 -0.61L0.62 -0.78L0.53 -0.42L0.9 -0.43L0.66 -0.15Z" fill="#3f6f4e" stroke="#26472f" stroke-width=".05" stroke-linejoin="round"/><path d="M0 0L0.92 0M0 0L0.83 0.4M0 0L0.57 0.72M0 0L0.2 0.9M0 0L-0.2 0.9M0 0L-0.57 0.72M0 0L-0.83 0.4M0 0L-0.92 0M0 0L-0.83 -0.4M0 0L-0.57 -0.72M0 0L-0.2 -0.9M0 0L0.2 -0.9M0 0L0.57 -0.72M0 0L0.83 -0.4" fill="none" stroke="#2f5a3c" stroke-width=".05"/><circle r=".1" fill="#26472f"/>"##,
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
        r##"<path d="M1 0L0.71 -0.71L0 -1L-0.71 -0.71L-1 0L-0.71 0.71L0 1L0.71 0.71Z" fill="#b58b5a" stroke="#7a5a35" stroke-width=".05"/><path d="M0 0L1 0L0.71 -0.71ZM0 0L0 -1L-0.71 -0.71ZM0 0L-1 0L-0.71 0.71ZM0 0L0 1L0.71 0.71Z" fill="#a67d4d"/><path d="M0 0L1 0M0 0L0.71 -0.71M0 0L0 -1M0 0L-0.71 -0.71M0 0L-1 0M0 0L-0.71 0.71M0 0L0 1M0 0L0.71 0.71" stroke="#7a5a35" stroke-width=".04"/><circle r=".12" fill="#7a5a35"/>"##,
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
