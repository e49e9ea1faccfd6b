//! What `Contract`, `Rings`, `Smooth` and `SplitAlong` make, by examples with known
//! answers.

mod common;

use common::{near, of, park, rectangle, size, total};
use park_grammar::geo_types::Coord;
use park_grammar::Scene;

fn derived(rules: &str) -> Scene {
    park(&rectangle(40.0, 30.0), &format!("Region -> {rules}"), 0).expect("derives")
}

fn error(rules: &str) -> String {
    let failed = park(&rectangle(40.0, 30.0), &format!("Region -> {rules}"), 0);
    failed.expect_err("fails").to_string()
}

/// Area of the circle's polygon of 36 corners.
fn disc(radius: f64) -> f64 {
    18.0 * radius * radius * 10f64.to_radians().sin()
}

#[test]
fn contractions() {
    // Drawn in by 2 m, or by a third of the inscribed circle's 15.
    assert!(near(
        total(&derived("Contract(2 m) { Meadow | Sand }"), "Meadow"),
        36.0 * 26.0
    ));
    assert!(near(
        total(&derived("Contract(20%) { Meadow | Sand }"), "Meadow"),
        34.0 * 24.0
    ));
    // Half way to the centre; 3 m where it is nearest, of 15 and so a fifth.
    assert!(near(
        total(
            &derived("Contract(0.5, CENTRE) { Meadow | Sand }"),
            "Meadow"
        ),
        300.0
    ));
    assert!(near(
        total(
            &derived("Contract(3 m, by = scale) { Meadow | Sand }"),
            "Meadow"
        ),
        1200.0 * 0.64
    ));
    // Towards a corner two sides stay where they are.
    let scene = derived("Contract(0.5, CORNER[0]) { Meadow | Sand }");
    assert!(near(total(&scene, "Meadow"), 300.0));
    let at = common::middle(&of(&scene, "Meadow")[0].polygon);
    assert!(near(at.x, 10.0) && near(at.y, 7.5));
    assert!(error("Contract(15 m) { Meadow | Sand }").contains("nothing is left"));
    assert!(error("Contract(2, by = round) { Meadow | Sand }").contains("no way to contract"));
}

/// The notes' function: stretches of the perimeter, drawn in by 1 m; and as a value
/// without `Parametrise`.
#[test]
fn contracted_lines() {
    let rules = "Lawn DistributeSmooth(Boundary1(Perimeter), 0.5) { Hedge }\nfun Boundary1(area) ->\nParametrise([0, 1], [], [], 0) { Contract(1, area) }";
    let swept = |scene: &Scene| scene.volumes.iter().map(|v| size(&v.polygon)).sum::<f64>();
    // West only, from 1 m inside on.
    let scene = derived(rules);
    assert!(near(swept(&scene), 0.5 * 30.0));
    let all = derived("Lawn Sweep(Contract(1, ALL), 0.5) { Hedge }");
    assert!(near(swept(&all), 38.0 * 28.0 - 37.0 * 27.0));
    let twice = derived("Lawn Sweep(Contract(1, Contract(0.5, ALL)), 0.5) { Hedge }");
    assert!(near(swept(&twice), 37.0 * 27.0 - 36.0 * 26.0));
}

#[test]
fn rings_and_paths() {
    let scene = derived("Rings(4, 10, width = 2) { Meadow } { Paving } { Sand }");
    assert!(near(
        total(&scene, "Meadow"),
        disc(3.0) + disc(9.0) - disc(5.0)
    ));
    assert!(near(
        total(&scene, "Paving"),
        disc(5.0) - disc(3.0) + disc(11.0) - disc(9.0)
    ));
    assert!(near(total(&scene, "Sand"), 1200.0 - disc(11.0)));
    // No circle given: the path touches the boundary from inside.
    let scene = derived("Rings(width = 2) { Meadow } { Paving } { Sand }");
    assert!(near(total(&scene, "Meadow"), disc(13.0)));
    assert!(near(total(&scene, "Paving"), disc(15.0) - disc(13.0)));
    // Shares are of 15, and {} is no path.
    let scene = derived("Rings(0.2, 60%) { Meadow } {} { Sand }");
    assert!(near(total(&scene, "Meadow"), disc(9.0)) && of(&scene, "Meadow").len() == 2);
    // Widths: a disc of 3, then 2 and 3 with paths of 1 between and around.
    let scene = derived("Rings(3 {3, 2}, width = 1) { Meadow } { Paving } { Sand }");
    assert!(near(
        total(&scene, "Meadow"),
        disc(3.0) + disc(6.0) - disc(4.0) + disc(10.0) - disc(7.0)
    ));
    // Rings are numbered from the centre.
    let scene = derived(
        "Rings(3 {3, 2}) { Ring } {} { Sand }\nRing -> Case { column == 1: Water | else: Meadow }",
    );
    assert!(near(total(&scene, "Water"), disc(5.0) - disc(3.0)));
}

#[test]
fn rings_are_clipped() {
    // A quarter of each, around a corner.
    let scene = derived("Rings(8, centre = CORNER[0], width = 2) { Meadow } { Paving } { Sand }");
    assert!(near(total(&scene, "Meadow"), disc(7.0) / 4.0));
    assert!(near(total(&scene, "Paving"), (disc(9.0) - disc(7.0)) / 4.0));
    // Larger than the region is high: the path falls into two.
    let scene = derived("Rings(17, width = 2) { Meadow } { Paving } { Sand }");
    assert_eq!(of(&scene, "Paving").len(), 2);
    assert_eq!(of(&scene, "Sand").len(), 2);
    assert!(error("Rings(1, 2) { Meadow } { Paving }").contains("no room"));
    assert!(error("Rings(5, 6) { Meadow } { Paving }").contains("paths meet"));
    // A place with room around it has a radius: 6, half of the path beyond.
    let scene = derived("Rings(centre = CENTRE, 0.4) { Meadow } {} { Sand }");
    assert!(near(total(&scene, "Meadow"), disc(6.0)));
    let scene = derived("Rings(centre = ScatterCircles(1 {6})) { Meadow } {} { Sand }");
    assert!(near(total(&scene, "Meadow"), disc(6.0)));
}

#[test]
fn smoothed_regions() {
    // Four corners of 9 pieces each.
    let quarter = |r: f64| r * r - disc(r) / 4.0;
    let scene = derived("Smooth(round, radius = 4) { Meadow | Sand }");
    assert!(near(total(&scene, "Sand"), 4.0 * quarter(4.0)));
    assert_eq!(of(&scene, "Sand").len(), 4);
    // The corner between west and north alone.
    let scene = derived("Smooth(round, WEST or NORTH, radius = 4) { Meadow | Sand }");
    assert!(near(total(&scene, "Sand"), quarter(4.0)));
    // One pass cuts off a triangle of a quarter of both sides.
    let scene = derived("Smooth(chaikin, times = 1) { Meadow | Sand }");
    assert!(near(total(&scene, "Sand"), 4.0 * 0.5 * 10.0 * 7.5));
    let scene = derived("Smooth(chaikin, times = 1, margin = 5) { Meadow | Sand }");
    assert!(near(total(&scene, "Meadow"), 600.0 - 4.0 * 0.5 * 7.5 * 5.0));
    assert!(near(
        total(&derived("Smooth(none) { Meadow | Sand }"), "Meadow"),
        1200.0
    ));
    assert!(error("Smooth(much) { Meadow }").contains("much"));
}

#[test]
fn regions_are_split() {
    let scene = derived("SplitAlong(SOUTH: 0.5, NORTH: 0.5) { Meadow | Sand }");
    assert!(near(total(&scene, "Meadow"), 600.0) && near(total(&scene, "Sand"), 600.0));
    // Going north the west lies on the left.
    assert!(common::middle(&of(&scene, "Meadow")[0].polygon).x < 20.0);
    let scene = derived("SplitAlong(NORTH: 0.5, SOUTH: 0.5) { Meadow | Sand }");
    assert!(common::middle(&of(&scene, "Meadow")[0].polygon).x > 20.0);
    // A path 2 wide, or as wide as is said.
    let scene = derived("SplitAlong(SOUTH: 0.5, NORTH: 0.5) { Meadow | Sand | Paving }");
    assert!(near(total(&scene, "Paving"), 60.0) && near(total(&scene, "Meadow"), 570.0));
    let scene = derived("SplitAlong(SOUTH: 0.5, NORTH: 0.5, width = 4) { Meadow | Sand }");
    assert!(near(total(&scene, "Gravel"), 120.0));
    // From inside straight on.
    let scene = derived("SplitAlong((0.5, 0.4), (0.5, 0.6)) { Meadow | Sand }");
    assert!(near(total(&scene, "Meadow"), 600.0));
    assert!(error("SplitAlong(CENTRE, CENTRE) { Meadow | Sand }").contains("one and the same"));
    assert!(error("SplitAlong(CORNER[0], CORNER[1]) { Meadow | Sand }").contains("does not divide"));
    assert!(
        error("SplitAlong(CORNER[0], CORNER[2], bulge = 3) { Meadow | Sand }").contains("no use")
    );
}

#[test]
fn regions_are_split_along_curves() {
    // Half a circle of 10 around the middle of the south, bulging to the north: a
    // polygon of 36 corners has its vertices on the line.
    let rules = "SplitAlong(SOUTH: 0.75, SOUTH: 0.25, curve = arc, bulge = 10 m) { Meadow | Sand }";
    let scene = derived(rules);
    let arc = of(&scene, "Sand").len() + of(&scene, "Meadow").len();
    assert_eq!(arc, 2);
    let least = total(&scene, "Sand").min(total(&scene, "Meadow"));
    assert!(near(least, disc(10.0) / 2.0), "{least}");
    // A whole wave takes from one side what it gives to the other.
    let rules =
        "SplitAlong(WEST: 0.5, EAST: 0.5, curve = sinus, amplitude = 5 m) { Meadow | Sand }";
    let scene = derived(rules);
    assert!(near(total(&scene, "Meadow"), 600.0));
    let high = of(&scene, "Sand")[0]
        .polygon
        .exterior()
        .0
        .iter()
        .map(|p| p.y)
        .fold(0.0, f64::max);
    assert!(near(high, 20.0), "{high}");
    // A path along a curve is nowhere thinner than its width.
    let rules =
        "SplitAlong(WEST: 0.5, CENTRE, EAST: 0.3, curve = smooth) { Meadow | Sand | Paving }";
    let scene = derived(rules);
    let sides = [
        &of(&scene, "Meadow")[0].polygon,
        &of(&scene, "Sand")[0].polygon,
    ];
    let inside = |p: &&Coord<f64>| p.x > 1.0 && p.x < 39.0;
    for p in sides[0].exterior().0.iter().filter(inside) {
        let away = common::clearance(sides[1], *p);
        assert!(
            p.y > 29.0 || p.y < 1.0 || away > 2.0 - 1e-6,
            "{away} at {p:?}"
        );
    }
}
