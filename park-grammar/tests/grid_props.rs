//! Laws of `Grid` and `FitRectangle`: what they make tiles the region, moves and
//! turns with it, and is symmetric where cells are mirror images.

mod common;

use park_grammar::geo_types::Coord;
use park_grammar::Scene;
use proptest::collection::vec;
use proptest::prelude::*;

use common::{config, is_tiled, middle, mirrors, outline, park, rectangle, size, tiling, Motion};

/// One dimension of a grid.
fn dimension() -> impl Strategy<Value = String> {
    prop_oneof![
        (1..7_u32).prop_map(|n| n.to_string()),
        (1..6_u32, 2..9_u32, 3..20_u32).prop_map(|(n, a, b)| format!("{n} {{{a}, {b}}}")),
        (5..25_u32).prop_map(|a| format!("{{{a}}}")),
        (2..6_u32, 0..40_u32).prop_map(|(n, a)| format!("{n} {{a[-{a}, {a}]}}")),
        (3..9_u32, 0..30_u32).prop_map(|(s, a)| format!("{{[{s}, {}]a[-{a}, {a}]}}", 3 * s)),
    ]
}

fn arguments() -> impl Strategy<Value = String> {
    let fit = prop_oneof![
        4 => Just(""),
        1 => Just(", fit = oriented"),
        1 => Just(", fit = bounding, direction = 20"),
        1 => Just(", fit = axis"),
        1 => Just(", fit = inscribed"),
        1 => Just(", fit = optimised"),
        1 => Just(", fit = indexed"),
        1 => Just(", fit = meeting"),
        1 => Just(", fit = blend, factor = 0.3"),
    ];
    let flags = prop_oneof![Just(""), Just(", Exact"), Just(", Apart")];
    (dimension(), dimension(), fit, flags)
        .prop_map(|(x, y, fit, flags)| format!("{x}, {y}{fit}{flags}, min_angle = 5"))
}

proptest! {
    #![proptest_config(config(96, 20_000))]

    /// Whatever is asked of whatever shape, the pieces tile it, or the region does
    /// not suit and the error says why.
    #[test]
    fn grids_tile_any_region(
        outline in outline(),
        arguments in arguments(),
        paths in prop_oneof![Just("{}"), Just("{ Paving }"), Just("{ Paving } { Circle(3) Sand }"), Just("{} { Romb(4) Sand }"), Just("{ Paving } { Sand }")],
        points in vec((-80.0..80.0_f64, -80.0..80.0_f64), 30),
        seed in 0..1000_u64,
    ) {
        let rules = format!("Region -> Grid({arguments}) {{ Meadow }} {paths}");
        tiling(&outline, &rules, &points, seed)?;
    }

    /// Grids in the cells of grids tile too, on cells of any shape.
    #[test]
    fn nested_grids_tile_any_region(
        outline in outline(),
        first in arguments(),
        second in arguments(),
        points in vec((-80.0..80.0_f64, -80.0..80.0_f64), 30),
        seed in 0..1000_u64,
    ) {
        let rules = format!(
            "Region -> Grid({first}) {{ Inner }} {{ Paving }} {{ Circle(3) Sand }}\nInner -> Grid({second}) {{ Meadow }} else {{ Soil }}"
        );
        if let Ok(scene) = park(&outline, &rules, seed) {
            is_tiled(&outline, &scene, &points)?;
        }
    }

    /// A rectangle and the rest tile too.
    #[test]
    fn rectangles_and_the_rest_tile(
        outline in outline(),
        fit in prop_oneof![Just("inscribed"), Just("optimised"), Just("axis")],
        points in vec((-80.0..80.0_f64, -80.0..80.0_f64), 30),
    ) {
        let rules = format!("Region -> FitRectangle(fit = {fit}) {{ Meadow | Sand }}");
        let scene = park(&outline, &rules, 0).expect("something fits");
        is_tiled(&outline, &scene, &points)?;
        if fit != "optimised" {
            let inner: Vec<_> = scene.pieces.iter().filter(|p| p.material == "Meadow").collect();
            prop_assert_eq!(inner.len(), 1, "one rectangle, without a hole");
            prop_assert!(inner[0].polygon.interiors().is_empty());
        }
    }
}

/// That each piece and object of one scene has its image in the other.
fn has_all_images(a: &Scene, b: &Scene, motion: Motion, far: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(a.pieces.len(), b.pieces.len());
    prop_assert_eq!(a.objects.len(), b.objects.len());
    let places: Vec<_> = b
        .pieces
        .iter()
        .map(|p| (middle(&p.polygon), size(&p.polygon), p.material.as_str()))
        .collect();
    let near = |p: Coord<f64>, q: Coord<f64>| (p.x - q.x).hypot(p.y - q.y) < far;
    for piece in &a.pieces {
        let (at, here) = (motion.of(middle(&piece.polygon)), size(&piece.polygon));
        // Of a sliver the middle is not known to so many digits.
        let found = places.iter().any(|(p, size, material)| {
            (near(*p, at) || here < 1e-3)
                && (size - here).abs() < far * 100.0
                && *material == piece.material
        });
        prop_assert!(found, "{} at {at:?} of {here}", piece.material);
    }
    for object in &a.objects {
        let found = b
            .objects
            .iter()
            .any(|o| near(o.at, motion.of(object.at)) && o.name == object.name);
        prop_assert!(found, "{} at {:?}", object.name, object.at);
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(48, 5_000))]

    /// A grid in the oriented box moves, turns and mirrors with its region. Which
    /// of its axes is x depends on the map, so that both have as many cells.
    #[test]
    fn oriented_grids_move_with_the_region(
        outline in outline(),
        count in 2..6_u32,
        angle in -3.2..3.2_f64,
        mirror in any::<bool>(),
        by in (-1e4..1e4_f64, -1e4..1e4_f64),
        centre in prop_oneof![Just("Circle(2) Sand"), Just("Sand")],
    ) {
        let rules = format!("Region -> Grid({count}, {count}, fit = oriented) {{ Meadow }} {{ Paving }} {{ {centre} }}");
        let motion = Motion { angle, mirror, by: Coord { x: by.0, y: by.1 } };
        let here = park(&outline, &rules, 0);
        let there = park(&motion.polygon(&outline), &rules, 0);
        match (here, there) {
            (Ok(here), Ok(there)) => has_all_images(&here, &there, motion, 1e-6)?,
            (here, there) => prop_assert_eq!(here.is_err(), there.is_err()),
        }
    }

    /// A move alone changes nothing of any grid.
    #[test]
    fn grids_move_with_the_region(
        outline in outline(),
        arguments in arguments(),
        by in (-1e4..1e4_f64, -1e4..1e4_f64),
    ) {
        let rules = format!("Region -> Grid({arguments}) {{ Meadow }} {{ Paving }}");
        let motion = Motion { angle: 0.0, mirror: false, by: Coord { x: by.0.round(), y: by.1.round() } };
        let searched = ["optimised", "inscribed", "blend", "axis"].iter().any(|fit| arguments.contains(fit));
        let here = park(&outline, &rules, 7);
        let there = park(&motion.polygon(&outline), &rules, 7);
        match (here, there) {
            (Ok(here), Ok(there)) if !searched => {
                has_all_images(&here, &there, motion, 1e-5)?;
            }
            // A search for the best box ends within its own tolerance.
            _ if searched => {}
            (here, there) => prop_assert_eq!(here.is_err(), there.is_err()),
        }
    }

    /// On a rectangle what cells do is symmetric under both mirrors of the grid.
    #[test]
    fn grids_of_rectangles_are_symmetric(
        width in 60.0..140.0_f64,
        height in 60.0..140.0_f64,
        columns in 2..6_u32,
        rows in 2..6_u32,
        at in (0.0..1.0_f64, 0.0..1.0_f64),
        treatment in prop_oneof![
            Just(""), Just(", middle = centre"), Just(", symmetry = mirror"), Just(", symmetry = pair"), Just(", symmetry = extended"),
        ],
        rule in 0..4_usize,
        centre in prop_oneof![Just("Circle(2) Gravel"), Just("Gravel Place(CENTRE) { Lamp }")],
    ) {
        let cell = match rule {
            0 => format!("Place(({}, {})) {{ Bush }}", at.0, at.1),
            1 => format!("Case {{ metric_x > 0 and outer > 1: Sand | metric_y == 1: Soil | else: Meadow }} Place(({}, 0.5)) {{ Tree }} Place((1.4, {})) {{ Lamp }}", at.0, at.1),
            2 => "Grid(2, 3 {1, 2, 1}, width = 1) { Meadow } { Paving } { Romb(2) Sand }".to_owned(),
            // In even grids whatever is inside is mirrored with the cell; in odd
            // ones a middle cell is its own mirror image, and what a rule makes
            // there must be so too.
            _ if columns % 2 == 0 && rows % 2 == 0 => {
                "Grid({1, 3, 2}, {1 m, 2, 3}, width = 0.3) { Meadow } { Paving } { Polygon(3, 0.5) Sand }".to_owned()
            }
            _ => "Grid(2, 2, fit = bounding) { Meadow Place(CENTRE) { Tree } }".to_owned(),
        };
        let rules = format!("Region -> Grid({columns}, {rows}{treatment}) {{ Cell }} {{ Paving }} {{ {centre} }}\nCell -> {cell}");
        let scene = park(&rectangle(width, height), &rules, 3).expect("derives");
        for mirror in mirrors(width, height) {
            has_all_images(&scene, &scene, mirror, 1e-6)?;
        }
    }
}
