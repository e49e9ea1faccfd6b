//! Laws of `Contract`, `Rings`, `Smooth`, `SplitAlong` and `SplitHoles`: what they
//! make tiles the region, and moves, turns and mirrors with it.

mod common;

use common::{
    any_outline, config, has_no_hairs, is_image, is_tiled, mirrors, of, park, polygon, rectangle,
    Motion,
};
use park_grammar::geo_types::{Coord, Polygon};
use park_grammar::Scene;
use proptest::collection::vec;
use proptest::prelude::*;

/// Contractions of every sort.
fn contract() -> impl Strategy<Value = String> {
    let amount = prop_oneof![
        (0.05..0.95_f64).prop_map(|s| format!("{s}")),
        (0.5..9.0_f64).prop_map(|s| format!("{s} m"))
    ];
    let centre = prop_oneof![
        3 => Just(""),
        1 => Just(", CENTRE"),
        1 => Just(", POLE"),
        1 => Just(", CORNER[0]"),
        1 => Just(", by = scale"),
        1 => Just(", centre = (0.3, 0.6)"),
        1 => Just(", SplitHoles"),
    ];
    (amount, centre)
        .prop_map(|(amount, centre)| format!("Contract({amount}{centre}) {{ Meadow | Sand }}"))
}

fn rings() -> impl Strategy<Value = String> {
    let radii = prop_oneof![
        1 => Just(String::new()),
        2 => (3.0..60.0_f64).prop_map(|r| format!("{r} m")),
        2 => (3.0..20.0_f64, 25.0..60.0_f64).prop_map(|(a, b)| format!("{a}, {b}")),
        1 => Just("30%, 0.9".to_owned()),
        1 => (1..6_u32).prop_map(|n| format!("{n} {{4, [2, 9]}}")),
    ];
    let options = prop_oneof![
        2 => Just(""),
        1 => Just("centre = POLE"),
        1 => Just("centre = CORNER[1]"),
        1 => Just("width = 4 m"),
        1 => Just("SplitHoles"),
        1 => Just("centre = (0.2, 0.7), width = 0.5"),
    ];
    let paths = prop_oneof![3 => Just("{ Paving }"), 1 => Just("{}")];
    (radii, options, paths).prop_map(|(radii, options, paths)| {
        let comma = if radii.is_empty() || options.is_empty() {
            ""
        } else {
            ", "
        };
        format!("Rings({radii}{comma}{options}) {{ Meadow }} {paths} {{ Sand }}")
    })
}

fn smooth() -> impl Strategy<Value = String> {
    let way = prop_oneof![
        Just("average"),
        Just("chaikin, times = 3"),
        Just("round, radius = 6 m"),
        Just("average, reach = 5 m"),
        Just("none"),
        Just("chaikin, OUTER"),
        Just("round, Part(ALL, [0.1, 0.6]), radius = 20"),
        Just("round, margin = 3 m, radius = 8"),
        Just("average, margin = 0.5, SplitHoles"),
    ];
    way.prop_map(|way| format!("Smooth({way}) {{ Meadow | Sand }}"))
}

fn split() -> impl Strategy<Value = String> {
    let place = prop_oneof![
        (0.0..1.0_f64).prop_map(|t| format!("ALL: {t}")),
        (0.0..1.0_f64).prop_map(|t| format!("WEST: {t}")),
        (0.0..1.0_f64).prop_map(|t| format!("EAST: {t}")),
        (0.1..0.9_f64, 0.1..0.9_f64).prop_map(|(x, y)| format!("({x}, {y})")),
        Just("CENTRE".to_owned()),
        Just("CORNER[2]".to_owned()),
    ];
    let curve = prop_oneof![
        3 => Just(""),
        1 => Just(", curve = smooth"),
        1 => Just(", curve = arc"),
        1 => Just(", curve = arc, bulge = -9 m"),
        1 => Just(", curve = sinus"),
        1 => Just(", curve = sinus, amplitude = 6 m, waves = 3"),
        1 => Just(", width = 3"),
        1 => Just(", SplitHoles"),
    ];
    let blocks = prop_oneof![
        Just("{ Meadow | Sand }"),
        Just("{ Meadow | Sand | Paving }")
    ];
    (vec(place, 2..5), curve, blocks)
        .prop_filter("a line that comes back", |(places, ..)| {
            let mut sorted = places.clone();
            sorted.sort();
            sorted.dedup();
            sorted.len() == places.len()
        })
        .prop_map(|(places, curve, blocks)| {
            format!("SplitAlong({}{curve}) {blocks}", places.join(", "))
        })
}

/// Lines from one side to the opposite one, which meet the boundary at an angle.
fn across() -> impl Strategy<Value = String> {
    let curve = prop_oneof![
        Just(""),
        Just(", CENTRE, curve = smooth"),
        Just(", curve = arc"),
        Just(", curve = sinus, amplitude = 3 m, waves = 2"),
    ];
    let blocks = prop_oneof![
        Just("{ Meadow | Sand }"),
        Just("{ Meadow | Sand | Paving }")
    ];
    (0.1..0.9_f64, 0.1..0.9_f64, curve, blocks).prop_map(|(a, b, curve, blocks)| {
        let (via, curve) = match curve.strip_prefix(", CENTRE") {
            Some(curve) => (", CENTRE", curve),
            None => ("", curve),
        };
        format!("SplitAlong(WEST: {a}{via}, EAST: {b}{curve}) {blocks}")
    })
}

/// What goes by the shape of the region alone, or crosses it.
fn sound_rule() -> impl Strategy<Value = String> {
    prop_oneof![contract(), rings(), smooth(), across()]
}

fn any_rule() -> impl Strategy<Value = String> {
    prop_oneof![contract(), rings(), smooth(), split()]
}

/// Why a region may not be divided.
const KNOWN: [&str; 8] = [
    "nothing is left",
    "no room",
    "paths meet",
    "no part of these",
    "does not divide",
    "no such place",
    "one and the same",
    "nothing",
];

fn derived(outline: &Polygon<f64>, rules: &str) -> Result<Option<Scene>, TestCaseError> {
    common::derived(outline, rules, 7, &KNOWN)
}

proptest! {
    #![proptest_config(config(300, 30_000))]

    /// Whatever is asked of whatever shape, the pieces tile it, or the region does
    /// not suit and the error says why.
    #[test]
    fn all_tile_any_region(
        outline in any_outline(2),
        rule in any_rule(),
        points in vec((-80.0..80.0_f64, -80.0..80.0_f64), 30),
    ) {
        let rules = format!("Region -> {rule}");
        if let Some(scene) = derived(&outline, &rules)? {
            is_tiled(&outline, &scene, &points)?;
            has_no_hairs(&scene)?;
            if rule.contains("SplitHoles") {
                prop_assert!(scene.pieces.iter().all(|p| p.polygon.interiors().is_empty()));
            }
        }
    }

    /// So do rules in the parts that others made, and without any holes if the
    /// grammar wants none.
    #[test]
    fn nested_rules_tile_any_region(
        outline in any_outline(2),
        first in any_rule(),
        second in any_rule(),
        holes in any::<bool>(),
        points in vec((-80.0..80.0_f64, -80.0..80.0_f64), 30),
    ) {
        let first = first.replace("Meadow", "Inner").replace("Sand", "Inner");
        let param = if holes { "" } else { "param NoHoles = 1\n" };
        let rules = format!("{param}Region -> {first}\nInner -> {second} else {{ Soil }}");
        if let Some(scene) = derived(&outline, &rules)? {
            is_tiled(&outline, &scene, &points)?;
            has_no_hairs(&scene)?;
            let whole = |p: &park_grammar::scene::Piece| p.polygon.interiors().is_empty();
            prop_assert!(holes || scene.pieces.iter().filter(|p| p.material != "Soil").all(whole));
        }
    }

    /// They move with their region; what goes by no direction turns and mirrors too.
    #[test]
    fn all_move_with_the_region(
        outline in any_outline(2),
        rule in sound_rule(),
        angle in -3.2..3.2_f64,
        mirror in any::<bool>(),
        by in (-1e3..1e3_f64, -1e3..1e3_f64),
    ) {
        let directed = ["Rings", "SplitAlong", "CORNER", "(0.3", "WEST", "EAST", "ALL", "OUTER", "SplitHoles"];
        // The point with the most room may be one of several, and what share 1 is
        // may be less by a search's 0.2 % in long strips.
        prop_assume!(!rule.contains("POLE") && !rule.starts_with("Contract(0."));
        // What goes by directions keeps them.
        let by = Coord { x: by.0, y: by.1 };
        let motion = if directed.iter().any(|word| rule.contains(word)) {
            Motion { angle: 0.0, mirror: false, by }
        } else {
            Motion { angle, mirror, by }
        };
        let rules = format!("Region -> {rule}");
        match (derived(&outline, &rules)?, derived(&motion.polygon(&outline), &rules)?) {
            (Some(here), Some(there)) => is_image(&here, &there, motion, 1e-6)?,
            // A line that runs along edges of the boundary, as between steps of the same
            // height, divides or does not by a rounding.
            _ if rule.contains("WEST") => {}
            (here, there) => prop_assert_eq!(here.is_none(), there.is_none()),
        }
    }

    /// In the cells of a grid all are mirrored with their cells.
    #[test]
    fn all_are_mirrored_with_their_cells(
        width in 60.0..140.0_f64,
        height in 60.0..140.0_f64,
        rule in sound_rule(),
    ) {
        prop_assume!(!rule.contains("[2, 9]"));
        let rules = format!("Region -> Grid(2, 2) {{ Cell }} {{ Asphalt }}\nCell -> {rule} else {{ Soil }}");
        let scene = park(&rectangle(width, height), &rules, 3).expect("derives");
        for mirror in mirrors(width, height) {
            is_image(&scene, &scene, mirror, 1e-6)?;
        }
    }

    /// A contraction by a share is the whole at that scale; one by metres keeps
    /// that far from the boundary.
    #[test]
    fn contractions_are_as_asked(sides in 3..12_u32, share in 0.1..0.9_f64, metres in 0.5..9.0_f64) {
        let step = std::f64::consts::TAU / f64::from(sides);
        let points: Vec<(f64, f64)> = (0..sides).map(|k| (40.0 * (step * f64::from(k)).cos(), 40.0 * (step * f64::from(k)).sin())).collect();
        let outline = polygon(&points);
        let scaled = park(&outline, &format!("Region -> Contract({share}, CENTRE) {{ Meadow | Sand }}"), 0).expect("derives");
        let wanted = common::size(&outline) * (1.0 - share).powi(2);
        prop_assert!((common::total(&scaled, "Meadow") - wanted).abs() < 1e-9 * wanted.max(1.0));
        for by in ["inset", "scale"] {
            let scene = park(&outline, &format!("Region -> Contract({metres} m, by = {by}) {{ Meadow | Sand }}"), 0).expect("derives");
            for piece in of(&scene, "Meadow") {
                for p in &piece.polygon.exterior().0 {
                    prop_assert!(common::clearance(&outline, *p) > metres - 1e-9);
                }
            }
        }
    }
}
