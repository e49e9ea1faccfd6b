//! Laws of `Peel`: strips and rests tile the region, move and turn with it, and
//! shares are what they are said to be.

mod common;

use common::{
    any_outline, config, has_no_hairs, is_image, is_tiled, mirrors, of, outline, park, rectangle,
    total, Motion,
};
use park_grammar::geo_types::{Coord, Polygon};
use park_grammar::Scene;
use proptest::collection::vec;
use proptest::prelude::*;

fn selection() -> impl Strategy<Value = String> {
    let range = (0.0..1.0_f64, 0.0..1.0_f64);
    prop_oneof![
        Just("OUTER".to_owned()),
        Just("ALL".to_owned()),
        Just("WEST".to_owned()),
        Just("NORTH or SOUTH".to_owned()),
        Just("EDGE[0, 1]".to_owned()),
        Just("INCIDENT".to_owned()),
        Just("Angle([-20, 70])".to_owned()),
        Just("HOLES or EAST".to_owned()),
        range
            .clone()
            .prop_map(|(a, b)| format!("Part(ALL, [{a}, {b}])")),
        (range.clone(), range.clone())
            .prop_map(|((a, b), (c, d))| format!("Part(OUTER, [{a}, {b}], [{c}, {d}])")),
        range.prop_map(|(a, b)| format!("Part(NORTH, [{a}, {b}]) or Part(WEST, [0, {b}])")),
    ]
}

fn size_of() -> impl Strategy<Value = String> {
    prop_oneof![
        1 => (0.02..0.98_f64).prop_map(|s| format!("{s}")),
        1 => metres(),
    ]
}

fn metres() -> impl Strategy<Value = String> {
    prop_oneof![
        2 => (0.5..12.0_f64).prop_map(|s| format!("{s} m")),
        1 => Just("[1 m, 3 m]".to_owned()),
    ]
}

fn flags() -> impl Strategy<Value = &'static str> {
    prop_oneof![
        4 => Just(""),
        2 => Just(", CornersOrthogonal"),
        1 => Just(", SplitHoles"),
        1 => Just(", smooth = average"),
        1 => Just(", smooth = chaikin, times = 3"),
        1 => Just(", smooth = round, radius = 5"),
        1 => Just(", CornersOrthogonal, smooth = round, reach = 30"),
    ]
}

/// Why nothing may be peeled.
const KNOWN: [&str; 3] = ["leaves nothing", "nothing to peel", "too thin"];

fn derived(outline: &Polygon<f64>, rules: &str, seed: u64) -> Result<Option<Scene>, TestCaseError> {
    common::derived(outline, rules, seed, &KNOWN)
}

proptest! {
    #![proptest_config(config(200, 20_000))]

    /// Whatever is peeled from whatever shape, strip and rest tile it, or the
    /// region does not suit and the error says why.
    #[test]
    fn strips_and_rests_tile_any_region(
        outline in any_outline(2),
        selection in selection(),
        size in size_of(),
        flags in flags(),
        points in vec((-80.0..80.0_f64, -80.0..80.0_f64), 30),
        seed in 0..1000_u64,
    ) {
        let rules = format!("Region -> Peel({selection}, {size}{flags}) {{ Meadow | Sand }}");
        if let Some(scene) = derived(&outline, &rules, seed)? {
            is_tiled(&outline, &scene, &points)?;
            has_no_hairs(&scene)?;
            prop_assert!(!of(&scene, "Sand").is_empty());
            if flags.contains("SplitHoles") {
                prop_assert!(scene.pieces.iter().all(|p| p.polygon.interiors().is_empty()));
            }
            prop_assert_eq!(Some(scene), derived(&outline, &rules, seed)?);
        }
    }

    /// What was peeled off and what was left can be peeled again, by what they
    /// remember.
    #[test]
    fn peels_of_peels_tile_any_region(
        outline in any_outline(2),
        first in (selection(), size_of(), flags()),
        second in (prop_oneof![Just("PI"), Just("PB"), Just("PS"), Just("OUTER"), Just("not PI"), Just("History(\"Peel\", INNER, 0)")], 0.05..0.6_f64, flags()),
        points in vec((-80.0..80.0_f64, -80.0..80.0_f64), 30),
    ) {
        let (selection, size, flags) = first;
        let (inner, share, more) = second;
        let rules = format!(
            "Region -> Peel({selection}, {size}{flags}) {{ Strip | Rest }}\nStrip -> Peel({inner}, {share}{more}) {{ Meadow | Sand }} else {{ Soil }}\nRest -> Peel({inner}, {share}{more}) {{ Meadow | Again }} else {{ Soil }}\nAgain -> Peel(PI, 0.3) {{ Lawn | Sand }} else {{ Soil }}"
        );
        if let Some(scene) = derived(&outline, &rules, 0)? {
            is_tiled(&outline, &scene, &points)?;
            has_no_hairs(&scene)?;
        }
    }

    /// Several strips at once are the same as one after the other.
    #[test]
    fn strips_follow_each_other(
        outline in any_outline(2),
        selection in selection(),
        sizes in (1.0..4.0_f64, 1.0..4.0_f64),
        points in vec((-80.0..80.0_f64, -80.0..80.0_f64), 10),
    ) {
        let (a, b) = sizes;
        let at_once = format!("Region -> Peel({selection}) {{ {a}: Meadow | {b}: Sand | Soil }}");
        let one_by_one = format!("Region -> Peel({selection}) {{ {a}: Meadow | Rest }}\nRest -> Case {{ Length(PI) > 0: Peel(PI, {b}) {{ Sand | Soil }} else {{ Sand }} | else: Soil }}");
        if let (Some(once), Some(twice)) = (derived(&outline, &at_once, 0)?, derived(&outline, &one_by_one, 0)?) {
            is_tiled(&outline, &once, &points)?;
            for material in ["Meadow", "Sand", "Soil"] {
                let (a, b) = (total(&once, material), total(&twice, material));
                prop_assert!((a - b).abs() < 1e-9 * common::size(&outline), "{a} {b}");
            }
        }
    }

    /// The strip is deep as asked: no point of the rest is nearer to the selection,
    /// and none of the strip is farther than its mitres reach. Shares are of the
    /// radius of the largest circle if all is peeled.
    #[test]
    fn strips_are_deep_as_asked(outline in any_outline(2), share in 0.05..0.3_f64) {
        let scene = derived(&outline, &format!("Region -> Peel(ALL, {share}) {{ Meadow | Sand }}"), 0)?;
        let scene = scene.expect("something is left");
        let nearest = |p: Coord<f64>| common::clearance(&outline, p);
        let rest = of(&scene, "Sand");
        let corners = rest.iter().flat_map(|p| p.polygon.exterior().0.iter().copied());
        let deep = corners.map(nearest).fold(f64::MAX, f64::min);
        // Arcs round sharp corners come a little nearer at their chords only.
        let whole = deep / share;
        let grid = (-45..45).flat_map(|x| (-45..45).map(move |y| Coord { x: f64::from(2 * x), y: f64::from(2 * y) }));
        let most = grid.filter(|p| common::within(&outline, *p)).map(nearest).fold(0.0, f64::max);
        prop_assert!(whole >= most * 0.996 && whole < 1.05 * most + 1.5, "{whole} {most}");
        let error = park(&outline, "Region -> Peel(ALL, 101%) { Meadow | Sand }", 0);
        prop_assert!(error.is_err_and(|e| e.to_string().contains("leaves nothing")));
    }

    /// Moves, turns and mirrors with its region, where the selection does; in metres,
    /// since what share 1 is may be less by a search's 0.2 % in long strips.
    #[test]
    fn peels_move_with_the_region(
        outline in any_outline(2),
        size in metres(),
        flags in flags(),
        angle in -3.2..3.2_f64,
        mirror in any::<bool>(),
        by in (-1e3..1e3_f64, -1e3..1e3_f64),
    ) {
        // How a hole without corners is cut goes by the region's own axes.
        let flags = if flags.contains("SplitHoles") { "" } else { flags };
        let rules = format!("Region -> Peel(OUTER, {size}{flags}) {{ Meadow | Sand }}");
        let motion = Motion { angle, mirror, by: Coord { x: by.0, y: by.1 } };
        // Parts that touch in a point are one or two by rounding: as much land, but
        // another when each is smoothed by itself.
        if let Some((sharp, _)) = flags.split_once(", smooth") {
            let rules = format!("Region -> Peel(OUTER, {size}{sharp}) {{ Meadow | Sand }}");
            let sharp = [outline.clone(), motion.polygon(&outline)].map(|outline| park(&outline, &rules, 0));
            let [here, there] = sharp.map(|found| found.map_or(0, |scene| scene.pieces.len()));
            prop_assume!(here == there);
        }
        match (derived(&outline, &rules, 0)?, derived(&motion.polygon(&outline), &rules, 0)?) {
            (Some(here), Some(there)) => is_image(&here, &there, motion, 1e-6)?,
            (here, there) => prop_assert_eq!(here.is_none(), there.is_none(), "{:?}", park(&outline, &rules, 0)),
        }
    }

    /// Sides are the same wherever a region lies, those that end within an edge too.
    #[test]
    fn peels_of_sides_move_with_the_region(
        outline in outline(),
        side in prop_oneof![Just("WEST"), Just("NORTH"), Just("EDGE[1]"), Just("Part(ALL, [0.1, 0.63])")],
        size in metres(),
        by in (-1e3..1e3_f64, -1e3..1e3_f64),
    ) {
        let rules = format!("Region -> Peel({side}, {size}) {{ Meadow | Sand }}");
        let motion = Motion { angle: 0.0, mirror: false, by: Coord { x: by.0, y: by.1 } };
        match (derived(&outline, &rules, 0)?, derived(&motion.polygon(&outline), &rules, 0)?) {
            (Some(here), Some(there)) => is_image(&here, &there, motion, 1e-6)?,
            (here, there) => prop_assert_eq!(here.is_none(), there.is_none()),
        }
    }

    /// What was peeled is one strip wherever it lies, so that what is peeled of it, and
    /// of what was left, moves and turns too.
    #[test]
    fn peels_of_peels_move_with_the_region(
        outline in any_outline(2),
        size in 0.5..6.0_f64,
        (strip, by_what) in prop_oneof![
            Just((true, "PB")), Just((true, "PI")), Just((true, "PS")), Just((false, "PI")), Just((false, "PS"))
        ],
        angle in -3.2..3.2_f64,
        by in (-1e3..1e3_f64, -1e3..1e3_f64),
    ) {
        let outputs = if strip { "Again | Sand" } else { "Sand | Again" };
        let rules = format!("Region -> Peel(OUTER, {size} m) {{ {outputs} }}\nAgain -> Peel({by_what}, 0.4 m) {{ Meadow | Soil }}");
        let motion = Motion { angle, mirror: false, by: Coord { x: by.0, y: by.1 } };
        match (derived(&outline, &rules, 0)?, derived(&motion.polygon(&outline), &rules, 0)?) {
            (Some(here), Some(there)) => is_image(&here, &there, motion, 1e-6)?,
            (here, there) => prop_assert_eq!(here.is_none(), there.is_none()),
        }
    }

    /// In the cells of a grid peels are mirrored with their cells.
    #[test]
    fn peels_of_mirrored_cells_are_mirror_images(
        width in 60.0..140.0_f64,
        height in 60.0..140.0_f64,
        selection in prop_oneof![Just("OUTER"), Just("WEST"), Just("EDGE[1]"), Just("Part(OUTER, [0.1, 0.6])"), Just("PATH")],
        size in 0.05..0.5_f64,
        flags in flags(),
    ) {
        let rules = format!("Region -> Grid(2, 2) {{ Cell }} {{ Paving }}\nCell -> Peel({selection}, {size}{flags}) {{ Strip | Rest }}\nStrip -> Meadow Place((0.2, 0.3)) {{ Bush }}\nRest -> Peel(EDGE[2], 0.2) {{ Sand | Soil }}");
        let scene = park(&rectangle(width, height), &rules, 3).expect("derives");
        for mirror in mirrors(width, height) {
            is_image(&scene, &scene, mirror, 1e-6)?;
        }
        let count = scene.objects.len();
        prop_assert!(count.is_multiple_of(4), "{count}");
    }
}
