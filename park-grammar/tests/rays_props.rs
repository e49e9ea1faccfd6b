//! Laws of `CastRays` as grammars use it; those of its paths are beside it.

mod common;

use park_grammar::geo_types::Coord;
use proptest::collection::vec;
use proptest::prelude::*;

use common::{
    any_outline, clearance, config, has_no_hairs, is_mirrored_in_cells, park, points_by_hand,
    tiling, within,
};

fn centres() -> impl Strategy<Value = String> {
    prop_oneof![
        3 => points_by_hand(1..7),
        1 => Just("CENTRE".to_owned()),
        1 => Just("CENTRE[4]".to_owned()),
        1 => (1..7_u32).prop_map(|n| format!("ScatterCircles({n})")),
        1 => Just("Corners(Region)".to_owned()),
    ]
}

fn targets() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(", Corners(Region)".to_owned()),
        (1..9_u32).prop_map(|n| format!(", {n}, from = 20")),
        Just(", [10 deg, 100 deg, 250 deg]".to_owned()),
        (1..9_u32).prop_map(|n| format!(", Along(ALL, {n})")),
        Just(", Corners(Region), hidden = end".to_owned()),
        Just(String::new()),
    ]
}

fn arguments() -> impl Strategy<Value = String> {
    let rays = prop_oneof![Just(""), Just(", rays = nearest"), Just(", rays = all")];
    let join = prop_oneof![
        Just(""),
        Just(", join = none"),
        Just(", join = open"),
        Just(", join = pairs"),
        Just(", join = opposites"),
        Just(", join = delaunay"),
        Just(", join = tree"),
    ];
    let more = prop_oneof![
        Just(""),
        Just(", apart = 0"),
        Just(", width = 4"),
        Just(", least = 30")
    ];
    (rays, join, more).prop_map(|(a, b, c)| format!("{a}{b}{c}"))
}

fn blocks() -> impl Strategy<Value = &'static str> {
    prop_oneof![
        Just("{ Meadow } { Paving }"),
        Just("{ Meadow } {}"),
        Just("{ Meadow } { Paving } { Circle(4) Sand }"),
        Just("{ Meadow } {} { Rectangle(3, 5) Sand }"),
    ]
}

proptest! {
    #![proptest_config(config(96, 10_000))]

    /// Whatever is asked of whatever shape, the pieces tile it, the same for one
    /// seed; or the region does not suit and the error says why.
    #[test]
    fn cells_and_paths_tile_any_region(
        outline in any_outline(3),
        centres in centres(),
        targets in targets(),
        arguments in arguments(),
        blocks in blocks(),
        probes in vec((-80.0..80.0_f64, -80.0..80.0_f64), 30),
        seed in 0..1000_u64,
    ) {
        let rules = format!("Region -> CastRays({centres}{targets}{arguments}) {blocks}");
        if let Some(scene) = tiling(&outline, &rules, &probes, seed)? {
            has_no_hairs(&scene)?;
        }
    }

    /// One can walk from the outline to each piece of path: pieces that touch each
    /// other are one walk, and each walk comes to the outline.
    #[test]
    fn walks_lead_to_the_outline(
        outline in any_outline(3),
        count in 1..6_u32,
        targets in prop_oneof![Just("Corners(Region)"), Just("5"), Just("Along(ALL, 3)")],
        arguments in arguments(),
        seed in 0..1000_u64,
    ) {
        let rules = format!("Region -> CastRays(ScatterCircles({count}), {targets}{arguments}) {{ Meadow }} {{ Paving }} {{ Circle(2) Sand }}");
        let Ok(scene) = park(&outline, &rules, seed) else { return Ok(()) };
        let paths: Vec<_> = scene.pieces.iter().filter(|p| p.material != "Meadow").collect();
        let vertices = |k: usize| -> Vec<Coord<f64>> {
            let polygon = &paths[k].polygon;
            let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
            rings.flat_map(|ring| ring.0.clone()).collect()
        };
        let touch = |a: usize, b: usize| {
            vertices(a).iter().any(|&p| clearance(&paths[b].polygon, p) < 1e-6)
                || vertices(b).iter().any(|&p| clearance(&paths[a].polygon, p) < 1e-6)
        };
        let mut out: Vec<bool> = (0..paths.len())
            .map(|k| vertices(k).iter().any(|&p| clearance(&outline, p) < 1e-6))
            .collect();
        while let Some(next) = (0..paths.len()).find(|&k| !out[k] && (0..paths.len()).any(|j| out[j] && touch(j, k))) {
            out[next] = true;
        }
        prop_assert!(out.iter().all(|is| *is), "{rules}");
    }

    /// The middle of every centre lies in the outline, and none on a cell.
    #[test]
    fn centres_lie_inside(outline in any_outline(3), count in 1..6_u32, seed in 0..1000_u64) {
        let rules = format!("Region -> CastRays(ScatterCircles({count}), Corners(Region)) {{ Meadow }} {{ Paving }} {{ Romb(3) Sand Fountain }}");
        let Ok(scene) = park(&outline, &rules, seed) else { return Ok(()) };
        for object in &scene.objects {
            prop_assert!(within(&outline, object.at));
            let on = scene.pieces.iter().find(|p| within(&p.polygon, object.at));
            prop_assert!(on.is_some_and(|piece| piece.material == "Sand"));
        }
    }
}

proptest! {
    #![proptest_config(config(32, 2_000))]

    /// In cells of a grid that are mirror images paths are mirrored, and what goes by
    /// their sides and coordinates with them.
    #[test]
    fn mirrored_cells_are_mirrored(
        width in 60.0..140.0_f64,
        height in 60.0..140.0_f64,
        a in (0.1..0.9_f64, 0.1..0.9_f64),
        b in (0.1..0.9_f64, 0.1..0.9_f64),
        rays in prop_oneof![Just("nearest"), Just("unconnected"), Just("all")],
    ) {
        let rule = |places: &str| format!("CastRays({places}, Corners(Region), rays = {rays}, width = 1)");
        is_mirrored_in_cells([width, height], a, b, rule)?;
    }
}
