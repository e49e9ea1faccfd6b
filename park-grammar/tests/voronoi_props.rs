//! Laws of `VoronoiRegions` as grammars use it; those of its cells are beside it.

mod common;

use park_grammar::geo_types::Coord;
use proptest::collection::vec;
use proptest::prelude::*;

use common::{
    any_outline, config, has_no_hairs, is_mirrored_in_cells, is_tiled, park, points_by_hand, size,
    tiling, total, within,
};

fn points() -> impl Strategy<Value = String> {
    prop_oneof![
        3 => points_by_hand(1..20),
        1 => (1..12_u32).prop_map(|n| format!("ScatterCircles({n})")),
        1 => (2..9_u32).prop_map(|r| format!("ScatterCircles({{[{r}, {}]}})", 2 * r)),
        1 => Just("Corners(Region)".to_owned()),
        1 => (1..12_u32).prop_map(|n| format!("Along(ALL, {n}, offset = 2)")),
    ]
}

fn arguments() -> impl Strategy<Value = String> {
    let smoothing = prop_oneof![
        Just(""),
        Just(", none"),
        Just(", chaikin"),
        Just(", average, times = 3"),
        Just(", smooth = round, radius = 4"),
        Just(", average, reach = 5"),
    ];
    let flags = prop_oneof![
        3 => Just(""),
        1 => Just(", Weighted"),
        1 => Just(", Around"),
        1 => Just(", around = 3"),
        1 => Just(", least = 40"),
    ];
    let wave = prop_oneof![
        2 => Just(String::new()),
        1 => (1..12_u32).prop_map(|a| format!(", amplitude = {a}")),
        1 => (1..8_u32, 2..20_u32).prop_map(|(a, l)| format!(", amplitude = {a}, wavelength = {l}")),
    ];
    (smoothing, flags, wave).prop_map(|(a, b, c)| format!("{a}{b}{c}"))
}

fn blocks() -> impl Strategy<Value = &'static str> {
    prop_oneof![
        Just("{ Meadow } { Paving }"),
        Just("{ Meadow } {}"),
        Just("{ Meadow } { Paving } { Circle(2) Sand }"),
        Just("{ Meadow } {} { Rectangle(3, 5) Sand }"),
    ]
}

fn probes() -> impl Strategy<Value = Vec<(f64, f64)>> {
    vec((-80.0..80.0_f64, -80.0..80.0_f64), 30)
}

proptest! {
    #![proptest_config(config(96, 10_000))]

    /// Whatever is asked of whatever shape, the pieces tile it, the same for one
    /// seed; or the region does not suit and the error says why.
    #[test]
    fn cells_and_paths_tile_any_region(
        outline in any_outline(3),
        points in points(),
        arguments in arguments(),
        blocks in blocks(),
        probes in probes(),
        seed in 0..1000_u64,
    ) {
        let rules = format!("Region -> VoronoiRegions({points}{arguments}) {blocks}");
        if let Some(scene) = tiling(&outline, &rules, &probes, seed)? {
            has_no_hairs(&scene)?;
        }
    }

    /// Cells of cells, of any shape, tile too; with grids and rays in them.
    #[test]
    fn nested_cells_tile(
        outline in any_outline(3),
        first in arguments(),
        inner in prop_oneof![
            Just("VoronoiRegions(ScatterCircles(4), amplitude = 1) { Meadow } { Gravel }"),
            Just("CastRays(CENTRE, Corners(Region), width = 1) { Meadow } { Gravel }"),
            Just("CastRays(ScatterCircles(3), 4, rays = all, width = 1) { Meadow } { Gravel } { Circle(1) Sand }"),
            Just("Grid(2, 2, width = 1) { Meadow } { Gravel }"),
        ],
        probes in probes(),
        seed in 0..1000_u64,
    ) {
        let rules = format!("Region -> VoronoiRegions(ScatterCircles(6){first}) {{ Inner }} {{ Paving }}\nInner -> {inner} else {{ Soil }}");
        if let Ok(scene) = park(&outline, &rules, seed) {
            is_tiled(&outline, &scene, &probes)?;
        }
    }

    /// What is smoothed away goes to the paths: where there is path without
    /// smoothing, there is path with it.
    #[test]
    fn smoothing_gives_to_the_paths(
        outline in any_outline(3),
        smoothing in prop_oneof![Just("average"), Just("chaikin"), Just("round, radius = 5"), Just("average, reach = 4")],
        amplitude in 0..6_u32,
        probes in probes(),
        seed in 0..1000_u64,
    ) {
        let rules = |how: &str| format!("Region -> VoronoiRegions(ScatterCircles(7), {how}, amplitude = {amplitude}, least = 0) {{ Meadow }} {{ Paving }}");
        let both = (park(&outline, &rules("none"), seed), park(&outline, &rules(smoothing), seed));
        let (Ok(sharp), Ok(smooth)) = both else { return Ok(()) };
        prop_assert!(total(&smooth, "Paving") >= total(&sharp, "Paving") - 1e-6 * size(&outline));
        for (x, y) in probes {
            let p = Coord { x, y };
            let path = |scene: &park_grammar::Scene| {
                scene.pieces.iter().any(|piece| piece.material == "Paving" && within(&piece.polygon, p))
            };
            prop_assert!(!path(&sharp) || path(&smooth), "{p:?}");
        }
    }
}

proptest! {
    #![proptest_config(config(32, 2_000))]

    /// In cells of a grid that are mirror images regions are mirrored, and what goes by
    /// their sides and coordinates with them.
    #[test]
    fn mirrored_cells_are_mirrored(
        width in 60.0..140.0_f64,
        height in 60.0..140.0_f64,
        a in (0.1..0.9_f64, 0.1..0.9_f64),
        b in (0.1..0.9_f64, 0.1..0.9_f64),
        smoothing in prop_oneof![Just("none"), Just("average"), Just("round")],
    ) {
        let rule = |places: &str| format!("VoronoiRegions({places}, {smoothing}, width = 1)");
        is_mirrored_in_cells([width, height], a, b, rule)?;
    }
}
