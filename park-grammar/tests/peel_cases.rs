//! What `Peel` makes, by examples with known answers.

mod common;

use common::{near, of, park, polygon, rectangle, size, total};
use park_grammar::Scene;

fn derived(width: f64, height: f64, rules: &str) -> Scene {
    park(&rectangle(width, height), rules, 0).expect("derives")
}

/// The ground that hedges take.
fn swept(scene: &Scene) -> f64 {
    scene.volumes.iter().map(|v| size(&v.polygon)).sum()
}

/// The notes' example: the two outer sides of a quarter, three quarters of the way
/// to where nothing would be left. Quarters of 39 x 24: 24 m are all, so that 18 are
/// peeled and 21 x 6 are left.
#[test]
fn the_notes_quarter() {
    let rules = "Region -> Grid(2, 2) { ParkQuarter } { ParkPath }\nParkQuarter -> Peel(OUTER) { 0.75: TreeStrip | GrassRegion }\nTreeStrip -> BLUE_GRASS\nGrassRegion -> GREEN_GRASS\nParkPath -> Paving";
    let scene = derived(80.0, 50.0, rules);
    let rest = of(&scene, "GREEN_GRASS");
    assert_eq!(rest.len(), 4);
    assert!(rest.iter().all(|p| near(size(&p.polygon), 21.0 * 6.0)));
    let strips = of(&scene, "BLUE_GRASS");
    assert!(strips.len() == 4 && strips.iter().all(|p| p.polygon.interiors().is_empty()));
}

/// As a second value, by name, after a colon, as a share, a percentage or metres.
#[test]
fn sizes_are_written_in_many_ways() {
    for peel in [
        "Peel(WEST, 0.25) { Meadow | Sand }",
        "Peel(WEST, 25%) { Meadow | Sand }",
        "Peel(WEST, 10) { Meadow | Sand }",
        "Peel(WEST, 10 m) { Meadow | Sand }",
        "Peel(WEST, 1000 cm) { Meadow | Sand }",
        "Peel(WEST, size = 0.25) { Meadow | Sand }",
        "Peel(WEST: 0.25) { Meadow | Sand }",
        "Peel(WEST) { 0.25: Meadow | Sand }",
        "Peel(WEST) { 10 m: Meadow } { Sand }",
        "Peel(WEST, CornersOrthogonal) { 10: Meadow | Sand }",
    ] {
        let scene = derived(40.0, 30.0, &format!("Region -> {peel}"));
        assert!(near(total(&scene, "Meadow"), 300.0), "{peel}");
        assert!(near(total(&scene, "Sand"), 900.0), "{peel}");
    }
}

#[test]
fn sizes_that_make_no_sense_are_faults() {
    let fault = |rules: &str| {
        let error = park(&rectangle(40.0, 30.0), &format!("Region -> {rules}"), 0);
        error.expect_err("a fault").to_string()
    };
    assert!(fault("Peel(WEST) { Meadow | Sand }").contains("needs a size"));
    assert!(fault("Peel(WEST, 3) { 2: Meadow | Sand }").contains("given twice"));
    assert!(fault("Peel(WEST) { Meadow | 2: Sand }").contains("has no size"));
    assert!(fault("Peel(WEST, -2) { Meadow | Sand }").contains("positive"));
    assert!(fault("Peel(WEST, 20 deg) { Meadow | Sand }").contains("expected"));
    assert!(fault("Peel(WEST, 45) { Meadow | Sand }").contains("leaves nothing"));
    assert!(fault("Peel(PI, 5) { Meadow | Sand }").contains("nothing to peel"));
    // What does not suit goes on with its alternative.
    let scene = derived(
        40.0,
        30.0,
        "Region -> Peel(WEST, 45) { Meadow | Sand } else { Soil }",
    );
    assert!(near(total(&scene, "Soil"), 1200.0));
}

/// All round: a ring with a hole, or with the flag four mitred pieces, those of the
/// long sides of 40 and 30 by 5.
#[test]
fn a_full_peel_is_a_ring() {
    let scene = derived(40.0, 30.0, "Region -> Peel(ALL, 5 m) { Meadow | Sand }");
    let ring = of(&scene, "Meadow");
    assert_eq!((ring.len(), ring[0].polygon.interiors().len()), (1, 1));
    assert!(near(total(&scene, "Sand"), 600.0));
    let scene = derived(
        40.0,
        30.0,
        "Region -> Peel(ALL, 5 m, SplitHoles) { Meadow | Sand }",
    );
    let mut pieces: Vec<f64> = of(&scene, "Meadow")
        .iter()
        .map(|p| size(&p.polygon))
        .collect();
    pieces.sort_by(f64::total_cmp);
    assert_eq!(pieces.len(), 4);
    assert!(near(pieces[0], 125.0) && near(pieces[1], 125.0));
    assert!(near(pieces[2], 175.0) && near(pieces[3], 175.0));
    let everywhere = "param NoHoles = 1\nRegion -> Peel(ALL, 5 m) { Meadow | Sand }";
    assert_eq!(of(&derived(40.0, 30.0, everywhere), "Meadow").len(), 4);
    let later = "Region -> Peel(ALL, 5 m) { Ring | Sand }\nRing -> SplitHoles { Meadow }";
    assert_eq!(of(&derived(40.0, 30.0, later), "Meadow").len(), 4);
}

/// The northern side of a trapezoid, 10 wide, 20 below, 5 high.
#[test]
fn corners_follow_or_are_orthogonal() {
    let trapezoid = polygon(&[(0., 0.), (20., 0.), (15., 5.), (5., 5.)]);
    let strip = |flag: &str| {
        let rules = format!("Region -> Peel(NORTH, 2 m{flag}) {{ Meadow | Sand }}");
        total(&park(&trapezoid, &rules, 0).expect("derives"), "Meadow")
    };
    assert!(near(strip(""), 24.0));
    assert!(near(strip(", CornersOrthogonal"), 20.0));
}

/// A range of a side, and several ranges: strips with square ends, one for each.
#[test]
fn parts_of_sides() {
    let scene = derived(
        40.0,
        30.0,
        "Region -> Peel(Part(NORTH, [0.25, 0.5]), 4 m) { Meadow | Sand }",
    );
    assert!(near(total(&scene, "Meadow"), 40.0));
    let rules =
        "Region -> Peel(Part(NORTH or SOUTH, [0, 0.125], [0.5, 0.75]), 4 m) { Meadow | Sand }";
    let scene = derived(40.0, 30.0, rules);
    assert_eq!(of(&scene, "Meadow").len(), 2);
    assert!(near(total(&scene, "Meadow"), 4.0 * 30.0));
}

/// The peeled border is smoothed, the boundary stays: with a radius of 3 the rest
/// of 30 x 20 loses what four corners lose to arcs, of 9 pieces each.
#[test]
fn peeled_borders_are_smoothed() {
    let rules = "Region -> Peel(ALL, 5 m, smooth = round, radius = 3) { Meadow | Sand }";
    let scene = derived(40.0, 30.0, rules);
    let quarter = 4.5 * 9.0 * 10f64.to_radians().sin();
    assert!(near(total(&scene, "Sand"), 600.0 - 4.0 * (9.0 - quarter)));
    let ring = of(&scene, "Meadow");
    assert_eq!(ring[0].polygon.exterior().0.len(), 5);
}

/// Strips one after the other: 2, then 3 m along the west and north.
#[test]
fn several_strips() {
    let rules = "Region -> Peel(WEST or NORTH) { 2 m: Meadow | 3 m: Sand | Soil }";
    let scene = derived(40.0, 30.0, rules);
    assert!(near(total(&scene, "Soil"), 35.0 * 25.0));
    assert!(near(total(&scene, "Meadow"), 1200.0 - 38.0 * 28.0));
    assert!(near(total(&scene, "Sand"), 38.0 * 28.0 - 35.0 * 25.0));
    // Shares are of the whole: each a fifth of 30.
    let rules = "Region -> Peel(WEST or NORTH) { 20%: Meadow | 20%: Sand | Soil }";
    assert!(near(
        total(&derived(40.0, 30.0, rules), "Soil"),
        28.0 * 18.0
    ));
}

/// The strip and the rest know what they were cut along: hedges of half a metre on
/// the base (40 + 30), the inner border (36 + 26), the flanks (4 + 4).
#[test]
fn strips_remember() {
    let hedged = |selection: &str, of: &str| {
        let (strip, rest) = if of == "strip" {
            (
                format!("Meadow Sweep({selection}, 0.5) {{ Hedge }}"),
                "Sand".to_owned(),
            )
        } else {
            (
                "Meadow".to_owned(),
                format!("Sand Sweep({selection}, 0.5) {{ Hedge }}"),
            )
        };
        let rules = format!("Region -> Peel(WEST or NORTH, 4 m) {{ Strip | Rest }}\nStrip -> {strip}\nRest -> {rest}");
        swept(&derived(40.0, 30.0, &rules))
    };
    // Base: two overlapping strips of 30 and 40.
    assert!(near(hedged("PB", "strip"), 0.5 * 70.0 - 0.25));
    // The strip's inner border turns outwards: both of its parts, and an arc.
    let inner = hedged("PI", "strip");
    assert!(inner > 0.5 * 62.0 && inner < 0.5 * 62.0 + 0.25, "{inner}");
    // With the two flanks of 4, which meet it at its ends.
    assert!((hedged("PS", "strip") - inner - 2.0 * (2.0 - 0.25)).abs() < 1e-9);
    // The rest: inner border, and no base.
    assert!(near(hedged("PI", "rest"), 0.5 * 62.0 - 0.25));
    assert!(near(hedged("PB", "rest"), 0.0));
    assert!(near(hedged("OUTER", "rest"), 0.5 * 62.0 - 0.25));
    // The rest keeps its sides: the border is west 0 and north 1 again.
    assert!(near(hedged("EDGE[0]", "rest"), 0.5 * 26.0));
    assert!(near(hedged("EDGE[1]", "rest"), 0.5 * 36.0));
    // What was moved from the west descends from it.
    assert!(near(hedged("Continuous(WEST)", "rest"), 0.5 * 26.0));
}

/// Peels of peels: levels count from either end.
#[test]
fn levels_of_peels() {
    let lengths = |selection: &str| {
        let rules = format!("Region -> Peel(WEST, 4 m) {{ Meadow | One }}\nOne -> Peel(NORTH, 5 m) {{ Sand | Two }}\nTwo -> Peel(PI, 2 m) {{ Soil | Rest }}\nRest -> Water Sweep({selection}, 0.5) {{ Hedge }}");
        let scene = derived(40.0, 30.0, &rules);
        // The second peel's border is 36 long, and the third's strip 2 deep.
        assert!(near(total(&scene, "Soil"), 72.0));
        swept(&scene)
    };
    assert!(near(lengths("PI"), 0.5 * 36.0));
    assert!(near(lengths("History(\"Peel\", INNER, -1)"), 0.5 * 36.0));
    // The first border is still there, 7 m shorter.
    assert!(near(lengths("History(\"Peel\", INNER, 0)"), 0.5 * 23.0));
    assert!(near(lengths("History(\"Peel\", INNER)"), 0.5 * 59.0 - 0.25));
}

/// A region that is deep only here falls into several rests; land behind a bay is
/// not peeled.
#[test]
fn bays_and_necks() {
    // Two rooms of 20 x 20 and a neck of 6 between.
    let rooms = polygon(&[
        (0., 0.),
        (20., 0.),
        (20., 7.),
        (30., 7.),
        (30., 0.),
        (50., 0.),
        (50., 20.),
        (30., 20.),
        (30., 13.),
        (20., 13.),
        (20., 20.),
        (0., 20.),
    ]);
    let scene = park(&rooms, "Region -> Peel(ALL, 4 m) { Meadow | Sand }", 0).expect("derives");
    assert_eq!(of(&scene, "Sand").len(), 2);
    assert!(near(total(&scene, "Sand"), 2.0 * 144.0));
    // The western side seen through the neck: its strip of 35 m goes through that,
    // and into the second room only as wide as the neck.
    let scene = park(
        &rooms,
        "Region -> Peel(EDGE[0] and Angle([170, 190]), 35 m) { Meadow | Sand }",
        0,
    );
    let scene = scene.expect("derives");
    assert!(total(&scene, "Meadow") >= 400.0 + 60.0 + 30.0 - 1e-6);
}
