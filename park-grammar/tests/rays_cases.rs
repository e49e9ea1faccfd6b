//! What `CastRays` makes, by examples with known answers.

mod common;

use park_grammar::geo_types::{polygon, LineString, Polygon};
use park_grammar::Scene;

use common::{close, of, park, rectangle, size, sum};

/// 40 wide and high.
fn square() -> Polygon<f64> {
    rectangle(40., 40.)
}

fn derive(rules: &str) -> Scene {
    park(&square(), rules, 1).expect("derives")
}

/// The area of a circle of 36 corners.
fn circle(radius: f64) -> f64 {
    18.0 * radius * radius * (std::f64::consts::PI / 18.0).sin()
}

/// Rays to the corners of a square: four triangles, whose sides along the diagonals
/// are 1 m aside.
#[test]
fn rays_to_the_corners() {
    let scene =
        derive("Region -> CastRays(CENTRE, Corners(Region), width = 2) { Meadow } { Paving }");
    let cells = of(&scene, "Meadow");
    assert_eq!(cells.len(), 4);
    // The base loses sqrt 2 at both ends, the height half of that.
    let base = 40.0 - 2.0 * 2.0_f64.sqrt();
    assert!(cells
        .iter()
        .all(|c| close(size(&c.polygon), base * base / 4.0)));
    assert_eq!(of(&scene, "Paving").len(), 1);
}

/// The notes' example, blocks in the order of all partitions: a centre of 5 m.
#[test]
fn the_notes_example() {
    let scene = derive(
        "CentreRegionSize = 5
        Region -> CastRays(CentrePoint [CentreRegionSize], CastToList) { CutRegion } { Gravel } { CentreRegion }
        CentrePoint -> ScatterCircles(1 {15})
        CastToList -> Corners(Region)
        CentreRegion -> Sand Fountain
        CutRegion -> Meadow",
    );
    assert_eq!(of(&scene, "Meadow").len(), 4);
    assert!(close(sum(&of(&scene, "Sand")), circle(5.0)));
    assert_eq!(scene.objects.len(), 1);
    // Four paths, cut off by the centre.
    assert_eq!(of(&scene, "Gravel").len(), 4);
}

/// Without a third block a size that is written makes the path round there, one
/// that is the room of a scattered circle does not.
#[test]
fn sizes_without_a_block_belong_to_the_path() {
    let with = derive("Region -> CastRays(CENTRE[8], 4) { Meadow } { Paving }");
    let without = derive("Region -> CastRays(CENTRE, 4) { Meadow } { Paving }");
    assert!(close(sum(&of(&without, "Paving")), 2.0 * 80.0 - 4.0));
    // The cross of 2 m within the circle, by slices of the polygon's edges.
    let more = sum(&of(&with, "Paving")) - sum(&of(&without, "Paving"));
    assert!(
        more > circle(8.0) - 2.0 * 32.0 && more < circle(8.0) - 2.0 * 32.0 + 5.0,
        "{more}"
    );
    let scattered = derive("Region -> CastRays(ScatterCircles(1 {15}), 4) { Meadow } { Paving }");
    assert!(close(sum(&of(&scattered, "Paving")), 156.0));
}

/// Directions: a number of them from north on, a list, one.
#[test]
fn rays_in_directions() {
    let count = |targets: &str| {
        let scene = derive(&format!(
            "Region -> CastRays(CENTRE, {targets}) {{ Meadow }} {{ Paving }}"
        ));
        of(&scene, "Meadow").len()
    };
    assert_eq!(count("6"), 6);
    assert_eq!(count("[0 deg, 90 deg, 180 deg]"), 3);
    assert_eq!(count("[EDGE[0], EDGE[1], EDGE[3]]"), 3);
    // One ray leaves the region in one piece.
    assert_eq!(count("45 deg"), 1);
    // North and south: halves.
    let scene = derive("Region -> CastRays(CENTRE, 2) { Meadow } {}");
    assert!(scene.pieces.iter().all(|p| close(size(&p.polygon), 800.0)));
    let scene = derive("Region -> CastRays(CENTRE, 2, from = 45) { Meadow } {}");
    assert!(scene.pieces.len() == 2 && close(size(&scene.pieces[0].polygon), 800.0));
}

/// Two centres and the corners of a square, in the order of the walk-graph.
#[test]
fn centres_join() {
    let cells = |how: &str| {
        let rules = format!("Region -> CastRays([(0.25, 0.5), (0.75, 0.5)], Corners(Region){how}, width = 1) {{ Meadow }} {{ Paving }}");
        of(&derive(&rules), "Meadow").len()
    };
    // Each corner from the nearer centre: four rays, and between the centres.
    assert_eq!(cells(", join = loop"), 4);
    // Without: west, east, and all that lies between.
    assert_eq!(cells(", join = none"), 3);
    // Of the two to the far corners of a side one crosses the other: two more.
    assert_eq!(cells(", join = loop, rays = all"), 6);
    assert_eq!(cells(", join = none, rays = all, apart = 0"), 5);
    // One ray from each centre, joined: two cells.
    assert_eq!(cells(", join = pairs, rays = nearest"), 2);
}

/// Three centres: a triangle, or one without an edge, with a ray from each.
#[test]
fn loops_and_trees() {
    let cells = |join: &str| {
        let rules = format!("Region -> CastRays([(0.5, 0.75), (0.3, 0.3), (0.7, 0.3)], [EDGE[1], CORNER[0], CORNER[3]], join = {join}, width = 1) {{ Meadow }} {{ Paving }}");
        of(&derive(&rules), "Meadow").len()
    };
    assert_eq!((cells("loop"), cells("open"), cells("none")), (4, 3, 1));
    assert_eq!((cells("delaunay"), cells("tree")), (4, 3));
}

/// In an L a corner behind the bend is not seen: no ray, or one up to the wall.
#[test]
fn no_paths_lead_outside() {
    let l = polygon![(x: 0., y: 0.), (x: 40., y: 0.), (x: 40., y: 20.), (x: 20., y: 20.), (x: 20., y: 40.), (x: 0., y: 40.)];
    let cells = |more: &str| {
        // The corners of the eastern end, from the northern arm.
        let rules = format!("Region -> CastRays((0.25, 0.9), [CORNER[3], CORNER[4]]{more}) {{ Meadow }} {{ Paving }}");
        let scene = park(&l, &rules, 0).expect("derives");
        let all: f64 = scene.pieces.iter().map(|p| size(&p.polygon)).sum();
        assert!(close(all, 1200.0));
        of(&scene, "Meadow").len()
    };
    // A way out to the nearest place instead.
    assert_eq!(cells(""), 1);
    assert_eq!(cells(", hidden = end, apart = 0"), 2);
}

/// Signed sides: trees along the first side from the centre, lamps along the last,
/// and what lies beyond.
#[test]
fn sides_are_signed() {
    let rules = "Region -> CastRays(CENTRE, [EDGE[0], EDGE[1], EDGE[2], EDGE[3]], width = 2) { Cell } { Paving }
        Cell -> Meadow Place(EDGE[1], offset = 3) { Tree } Place(EDGE[-1], offset = 3) { Lamp } Place(CORNER[0], offset = 8) { Fountain } Place((0.9, 0.9)) { Bench }";
    let scene = derive(rules);
    let at = |name: &str| -> Vec<(f64, f64)> {
        let found = scene.objects.iter().filter(|o| o.name == name);
        let mut all: Vec<(f64, f64)> = found
            .map(|o| {
                (
                    (o.at.x * 10.0).round() / 10.0,
                    (o.at.y * 10.0).round() / 10.0,
                )
            })
            .collect();
        all.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
        all
    };
    // In the north-eastern quarter side 1 goes north from the centre.
    assert!(at("Tree").contains(&(24.0, 30.5)), "{:?}", at("Tree"));
    assert!(at("Lamp").contains(&(30.5, 24.0)), "{:?}", at("Lamp"));
    for name in ["Tree", "Lamp", "Fountain", "Bench"] {
        assert_eq!(at(name).len(), 4, "{name} {:?}", scene.skipped);
    }
    let inner = 21.0 + 8.0 / 2.0_f64.sqrt();
    assert!(
        at("Fountain").contains(&((inner * 10.0).round() / 10.0, (inner * 10.0).round() / 10.0))
    );
}

/// What cannot be done is said.
#[test]
fn faults_are_told() {
    for (rules, says) in [
        ("CastRays() { Meadow }", "needs centres"),
        ("CastRays(CENTRE, 5 m) { Meadow }", "a direction"),
        (
            "CastRays(CENTRE, 4, rays = left) { Meadow }",
            "nearest, unconnected, all",
        ),
        ("CastRays(CENTRE, 4, join = all) { Meadow }", "delaunay"),
        (
            "CastRays(CENTRE, 4, jion = loop) { Meadow }",
            "did you mean join",
        ),
        (
            "CastRays(CENTRE, 4) { Meadow } { Paving } { Sand }",
            "how large",
        ),
        ("CastRays((2, 2), 4) { Meadow }", "none of these places"),
        (
            "CastRays(CENTRE, 4, width = 90) { Meadow } { Paving }",
            "no room",
        ),
        ("CastRays(CENTRE, 4, least = -1) { Meadow }", "0 or more"),
        ("CastRays(CENTRE, 5000) { Meadow }", "too many"),
    ] {
        let error = park(&square(), &format!("Region -> {rules}"), 0);
        let error = error.expect_err(rules).to_string();
        assert!(error.contains(says), "{rules}: {error}");
    }
}

/// Joins of all corners of a star that go round each other's bends: strokes that lie
/// on each other but for the last digits kept the booleans splitting without end.
#[test]
fn paths_along_each_other_come_to_an_end() {
    let points = [
        (61.87354616255034, -3.472629162498636),
        (31.02863644448191, 2.5750742280394854),
        (77.26805791629849, 23.360103726240112),
        (59.768763626504416, 40.96229822871079),
        (31.1183434264766, 27.908001038266008),
        (49.56576212551315, 52.37889901991108),
        (51.4228565172032, 67.22128123880361),
        (41.260727322094105, 71.09383650766023),
        (12.694099443785177, 39.33692602066702),
        (4.339953901951762, 80.43374298223469),
        (-11.170290733951557, 58.148596211000225),
        (-34.243587757413565, 65.65756202405646),
        (-39.06494289476428, 51.70513424481805),
        (-46.7435102215415, 34.405618208061135),
        (-23.755284447710704, 12.55565821147232),
        (-59.59300285898231, 23.388836839893454),
        (-59.48949032165583, 11.603458971830316),
        (-59.91077673035692, -4.146422183067348),
        (-23.1453937634162, -5.506840277743051),
        (-69.76951447686234, -29.080147296981774),
        (-59.69782702533626, -51.53982164084227),
        (-46.84286138858854, -71.06261463543362),
        (-30.654099376631983, -61.75074898266606),
        (-32.82226039411103, -81.25539913343277),
        (-3.9335372392546293, -57.693522832103305),
        (7.609876517929914, -32.66159376221812),
        (28.107095732396473, -63.65568653531867),
        (34.39399959585698, -43.331788076303766),
        (15.679813309606487, -13.448672856782112),
        (33.39884107279982, -22.189725033747546),
        (44.97544368681775, -12.108627230893749),
        (50.2517895669772, -6.193770555494329),
        (61.87354616255034, -3.472629162498636),
    ];
    let line: LineString<f64> = points.into_iter().collect();
    let star = Polygon::new(line, Vec::new());
    let rules = "Region -> CastRays(Corners(Region), rays = nearest, join = delaunay, width = 4) { Meadow } { Paving }";
    let scene = park(&star, rules, 566).expect("derives");
    let all: f64 = scene.pieces.iter().map(|p| size(&p.polygon)).sum();
    assert!((all / size(&star) - 1.0).abs() < 1e-9);
}

/// A centre as wide as the paths has no slivers of path around it: its polygon and
/// that of a path's end are not turned alike.
#[test]
fn centres_as_wide_as_paths_are_clean() {
    let rules =
        "Region -> CastRays(CENTRE, 37 deg, width = 4) { Meadow } { Paving } { Circle(2) Sand }";
    let scene = derive(rules);
    assert_eq!(
        (of(&scene, "Paving").len(), of(&scene, "Sand").len()),
        (1, 1)
    );
    assert!(close(sum(&of(&scene, "Sand")), circle(2.0)));
}
