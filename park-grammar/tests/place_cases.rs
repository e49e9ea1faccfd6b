//! What operations put where, by examples with known answers.

mod common;

use park_grammar::geo_types::{polygon, Coord, Polygon};
use park_grammar::scene::{Ground, Object};
use park_grammar::{DeriveOptions, Grammar, ParkError, Scene};

use common::size;

/// 80 wide, 50 high.
fn rectangle() -> Polygon<f64> {
    common::rectangle(80., 50.)
}

/// A square of 40 without its north-eastern quarter.
fn bend() -> Polygon<f64> {
    polygon![
        (x: 0., y: 0.), (x: 40., y: 0.), (x: 40., y: 20.),
        (x: 20., y: 20.), (x: 20., y: 40.), (x: 0., y: 40.)
    ]
}

fn on(park: &Polygon<f64>, rules: &str) -> Result<Scene, ParkError> {
    common::park(park, rules, 0)
}

fn derive(rules: &str) -> Scene {
    on(&rectangle(), rules).expect("derives")
}

fn near(a: Coord<f64>, x: f64, y: f64) -> bool {
    (a.x - x).hypot(a.y - y) < 1e-5
}

fn has(objects: &[Object], x: f64, y: f64) -> bool {
    objects.iter().any(|o| near(o.at, x, y))
}

#[test]
fn places_of_all_sorts() {
    let park =
        derive("Region -> Place(CORNER[0], (0.5, 0.25), EDGE[1]: 0.25, CENTRE) { Fountain }");
    // In a corner of 90 degrees 2 m from both sides, at the boundary 2 m inside.
    for (x, y) in [(2., 2.), (40., 12.5), (20., 48.), (40., 25.)] {
        assert!(has(&park.objects, x, y), "{x} {y} {:?}", park.objects);
    }
    assert_eq!((park.objects.len(), park.skipped), (4, 0));
    let park = derive("Region -> Place(Along(EDGE[0], 3, offset = 5)) { Bench }");
    assert!(has(&park.objects, 5., 25.));
    // Those at the ends of the side are on the boundary of the neighbours.
    assert_eq!((park.objects.len(), park.skipped), (1, 2));
    let park = derive("Region -> Corners(EDGE[0]) { Tree } Place(EDGE[2], offset = 3) { Lamp }");
    assert!(park.objects.len() == 1 && has(&park.objects, 77., 25.));
}

#[test]
fn things_face_as_they_are_told() {
    for (facing, degrees) in [
        ("in", -90.0),
        ("out", 90.0),
        ("along", 0.0),
        ("30", 30.0),
        ("centre", -90.0),
    ] {
        let park = derive(&format!(
            "Region -> Place(EDGE[1], facing = {facing}) {{ Bench }}"
        ));
        let found = park.objects[0].facing.to_degrees();
        assert!((found - degrees).abs() < 1e-6, "{facing}: {found}");
    }
}

#[test]
fn footprints_do_not_overlap() {
    // The second is left out, the lamp beside it stands.
    let park = derive(
        "Region -> Place(CENTRE) { Fountain } Place(CENTRE) { Statue } Place((0.55, 0.5)) { Lamp }",
    );
    assert_eq!((park.objects.len(), park.skipped), (2, 1));
    let park = derive("Region -> Place(CENTRE) { Fountain } Place(CENTRE) { Statue } else { Place((0.1, 0.5)) { Statue } }");
    assert_eq!((park.objects.len(), park.skipped), (2, 0));
    assert!(has(&park.objects, 8., 25.));
    // A shape is not cut from under what stands there.
    let error = on(
        &rectangle(),
        "Region -> Place(CENTRE) { Tree } Place(CENTRE) { Circle(3) Gravel }",
    );
    assert!(error.expect_err("no room").to_string().contains("no room"));
    // Nor is a thing put onto what was cut.
    let park = derive("Region -> Place(CENTRE) { Circle(3) Gravel } Place((0.5, 0.55)) { Tree }");
    assert_eq!((park.objects.len(), park.skipped), (0, 1));
}

#[test]
fn rows_of_trees() {
    // 46 m in the west, 2 m from the other sides too: 9 steps of about 5.
    let park = derive("Region -> Distribute(EDGE[0]: 2, 5) { Tree }");
    assert_eq!(park.objects.len(), 10);
    assert!(has(&park.objects, 2., 2.) && has(&park.objects, 2., 48.));
    let park = derive("Region -> Distribute(EDGE[0]: 2, 5, Middles) { Tree }");
    assert!(park.objects.len() == 9 && has(&park.objects, 2., 2. + 46. / 18.));
    let park = derive("Region -> Distribute(EDGE[0]: 2, 10, Exact) { Tree }");
    // 4 steps, the rest of 6 at both ends.
    assert!(park.objects.len() == 5 && has(&park.objects, 2., 5.) && has(&park.objects, 2., 45.));
    let park = derive("Region -> Distribute(EDGE[0]: 2, count = 3) { Tree }");
    assert!(park.objects.len() == 3 && has(&park.objects, 2., 25.));
    let park = derive("Region -> Distribute([(0.1, 0.5), (0.9, 0.5)], 16) { Lamp }");
    assert!(park.objects.len() == 5 && has(&park.objects, 24., 25.));
}

#[test]
fn rows_have_a_tree_on_each_corner() {
    // A ring of 70 by 40, 5 m inside.
    let park = derive("Region -> Distribute(OUTER: 5, 10) { Tree }");
    assert_eq!(park.objects.len(), 22);
    for (x, y) in [
        (5., 5.),
        (5., 45.),
        (75., 45.),
        (75., 5.),
        (15., 5.),
        (5., 35.),
    ] {
        assert!(has(&park.objects, x, y), "{x} {y}");
    }
    let first = &park.objects[0];
    // The first stands at corner 0 and looks half way between its sides.
    assert!(near(first.at, 5., 5.) && (first.facing.to_degrees() - 45.0).abs() < 1e-6);
    // A and B by turns, twice as many of the first.
    let park = derive("Region -> Distribute(EDGE[1]: 5, 9) { 2: Tree | Bush }");
    let bushes = park.objects.iter().filter(|o| o.name == "Bush").count();
    // From 2.5 to 77.5, crowns inside: 8 steps, 9 things.
    assert_eq!((park.objects.len(), bushes), (9, 3));
}

#[test]
fn the_notes_strip_of_trees_has_room() {
    // Without Peel: trees 0.375 from the edge, 2 m apart, as the notes have it.
    let park = derive("Region -> BLUE_GRASS\nDistribute (OUTER_EDGE: 0.375, 2) {TallTree}");
    // 2 * (79.25 + 49.25) = 257 in steps of about 2: 40 and 25 on the sides.
    assert_eq!((park.objects.len(), park.skipped), (130, 0));
}

#[test]
fn hedges_run_along_lines() {
    let park = derive("Region -> Sweep(EDGE[0], 1, 1.5) { Hedge }");
    assert_eq!(park.volumes.len(), 1);
    assert!((size(&park.volumes[0].polygon) - 50.0).abs() < 1e-6);
    assert_eq!(
        (park.volumes[0].name.as_str(), park.volumes[0].height),
        ("Hedge", 1.5)
    );
    // A ring between 2 and 3 m inside.
    let park = derive("Region -> DistributeSmooth(Perimeter: 2, 1) { Bush }");
    let ring = 76.0 * 46.0 - 74.0 * 44.0;
    assert!((size(&park.volumes[0].polygon) - ring).abs() < 1e-6);
    assert_eq!(park.volumes[0].polygon.interiors().len(), 1);
    let park = derive("Region -> Sweep([(0.25, 0.5), (0.75, 0.5)]) { Wall }");
    assert!((size(&park.volumes[0].polygon) - 40.0 * 0.4).abs() < 1e-6);
    let park = derive("Region -> Sweep(AREA, height = 1) { Bush }");
    assert!((size(&park.volumes[0].polygon) - 4000.0).abs() < 1e-6);
}

#[test]
fn hedges_turn_at_corners() {
    let corner = |mode: &str| {
        let rules = format!(
            "Region -> Sweep(Angle([-45, 45]) or Angle([45, 135]): 0, 2{mode}) {{ Hedge }}"
        );
        let park = on(&bend(), &rules).expect("derives");
        park.volumes.iter().map(|v| size(&v.polygon)).sum::<f64>()
    };
    // North and east facing sides of 20 each, 2 wide; at the two outer corners 4
    // are shared, round the inner one lies a quarter of a disc or a square.
    let straight = 4.0 * 40.0 - 2.0 * 4.0;
    assert!((corner(", Mitre") - straight - 4.0).abs() < 1e-6);
    let arc = 9.0 * 0.5 * 4.0 * 10_f64.to_radians().sin();
    assert!((corner("") - straight - arc).abs() < 1e-6);
}

#[test]
fn hedges_leave_out_what_stands_there() {
    let park = derive(
        "Region -> Place((0.5, 0.5)) { Fountain } Sweep([(0.25, 0.5), (0.75, 0.5)], 1) { Hedge }",
    );
    assert_eq!(park.volumes.len(), 2);
    // And nothing is put onto a hedge.
    let park = derive("Region -> Sweep(EDGE[0], 2) { Hedge } Distribute(EDGE[0]: 1, 5) { Tree }");
    assert_eq!((park.objects.len(), park.skipped), (0, 11));
    let park = derive("Region -> Sweep(EDGE[0]: 60, 1, 1) { Hedge } else { Sand }");
    assert_eq!((park.volumes.len(), park.volumes.is_empty()), (1, false));
    let park = derive("Region -> Sweep(EDGE[0]: 90, 1, 1) { Hedge } else { Sand }");
    assert_eq!(
        (park.volumes.len(), park.pieces[0].material.as_str()),
        (0, "Sand")
    );
}

#[test]
fn ranges_of_sides_are_drawn_in() {
    let rules = "Region -> DistributeSmooth(Bound(Perimeter), 0.5) { Bush }\nfun Bound(area) = Parametrise([0, 1], [0.25, 0.75], [], 0, area, inset = 1)";
    let park = derive(rules);
    let total: f64 = park.volumes.iter().map(|v| size(&v.polygon)).sum();
    // 50 m of the west, less nothing at its ends, and 40 m of the north.
    assert_eq!(park.volumes.len(), 2);
    assert!((total - 0.5 * (50.0 + 40.0)).abs() < 1e-6, "{total}");
}

#[test]
fn circles_do_not_touch() {
    let park = derive("Region -> ScatterCircles(5 {[5-10]}) { FlowerBed Statue }");
    assert_eq!(park.pieces.len(), 6);
    let lawn = park
        .pieces
        .iter()
        .find(|p| p.material == "Lawn")
        .expect("the rest");
    assert_eq!(lawn.polygon.interiors().len(), 5);
    assert_eq!(park.objects.len(), 5);
    for (k, a) in park.objects.iter().enumerate() {
        for b in &park.objects[..k] {
            assert!((a.at.x - b.at.x).hypot(a.at.y - b.at.y) > 10.0);
        }
    }
    let error = on(&rectangle(), "Region -> ScatterCircles(3 {30}) { Sand }").expect_err("no room");
    assert!(error.to_string().contains("room for 0 circles"), "{error}");
    let park = derive("Region -> ScatterCircles(5 {15}, least = 4) { Sand } else { Soil }");
    assert_eq!(park.pieces[0].material, "Soil");
    // As many as there is room for: 4000 m2 hold more than 40 circles of 3 m.
    let park = derive("Region -> ScatterCircles({3}, gap = 0.5) { Sand }");
    assert!(park.pieces.len() > 41, "{}", park.pieces.len());
    // As places: a fountain at each.
    let park =
        derive("Region -> Place(Spots) { Fountain }\nSpots -> ScatterCircles(4 {4}, Poisson)");
    assert_eq!(park.objects.len(), 4);
}

#[test]
fn things_are_scattered() {
    let park = derive("Region -> Scatter(30) { 3: Tree | Bush }");
    assert_eq!(park.objects.len() + park.skipped, 30);
    assert!(park.objects.iter().any(|o| o.name == "Bush"));
    for (k, a) in park.objects.iter().enumerate() {
        for b in &park.objects[..k] {
            let far = (a.at.x - b.at.x).hypot(a.at.y - b.at.y);
            assert!(far >= (a.spread + b.spread) * (1.0 - 1e-6));
        }
    }
    let park = derive("Region -> Scatter(density = 0.5) { Lamp }");
    assert_eq!(park.objects.len(), 20);
    // 5 m from footprints to the boundary.
    let park = derive("Region -> Scatter(40, margin = 5, room = 0.5) { Tree }");
    assert!(park.objects.iter().all(|o| o.at.x > 5.3 && o.at.y < 44.7));
    // Crowns of 2.5 m at most 2 radii apart: a third of the ground at least.
    let park = derive("Region -> Scatter(Poisson) { Tree }");
    let covered = park.objects.len() as f64 * std::f64::consts::PI * 6.25;
    assert!(covered > 4000.0 / 2.2, "{covered}");
}

#[test]
fn objects_of_the_grammar() {
    let obj = "v -1 0 -1\nv 1 0 -1\nv 0 3 0\nf 1 2 3\n";
    let load = |name: &str| match name {
        "oak.obj" => Ok(obj.to_owned()),
        "bad.obj" => Ok("v 0 0 0\nf 1 2 3".to_owned()),
        _ => Err("there is no such file".to_owned()),
    };
    let text = |file: &str| {
        format!("grammar 1\nparam Oak = Object(radius = 0.4, spread = 3 m, mesh = \"{file}\", scale = 2)\nRegion -> Strip(Oak) Place(CENTRE) {{ Oak }}\nStrip(kind) -> Distribute(WEST: 4, 10) {{ kind }}")
    };
    let grammar = Grammar::with_includes("park", &text("oak.obj"), &load).expect("reads");
    let park = grammar
        .derive(&rectangle(), &DeriveOptions::default())
        .expect("derives");
    // Four steps of 11 m between 3 m and 47 m, and the centre.
    assert_eq!(park.objects.len(), 6);
    assert!(park
        .objects
        .iter()
        .all(|o| o.name == "Oak" && o.height == 6.0 && o.radius == 0.4));
    let [kind] = park.kinds.as_slice() else {
        panic!("one kind");
    };
    let mesh = kind.mesh.as_ref().expect("a mesh");
    assert_eq!(
        (mesh.triangles.len(), mesh.vertices[2]),
        (1, [0.0, 6.0, 0.0])
    );
    for (file, what) in [
        ("bad.obj", "line 2: there is no vertex 2"),
        ("none.obj", "no such file"),
    ] {
        let error = Grammar::with_includes("park", &text(file), &load).expect_err("no mesh");
        assert!(error.to_string().contains(what), "{error}");
    }
}

#[test]
fn selections_keep_their_meaning_on_parts() {
    // A selection as a value belongs to the region where it is used.
    let rules = "param Side = EDGE[0]\nRegion -> Place((0.25, 0.5)) { Square(10) Sand Row(Side) }\nRow(side) -> Distribute(side: 1, 2) { Lamp }";
    let park = derive(rules);
    assert!(!park.objects.is_empty());
    assert!(
        park.objects.iter().all(|o| (o.at.x - 16.0).abs() < 1e-6),
        "{:?}",
        park.objects
    );
}

#[test]
fn objects_know_their_ground() {
    let park = derive(
        "Region -> Place((0.25, 0.5)) { Square(10) Fountain Gravel } Place(CENTRE) { Tree }",
    );
    let ground: Vec<Ground> = park.objects.iter().map(|o| o.ground).collect();
    assert_eq!(ground, [Ground::Path, Ground::Region]);
}

#[test]
fn faults_are_named() {
    for (rules, what) in [
        ("Region -> Scatter { Tree }", "how many things"),
        (
            "Region -> Scatter(POISSON) { Tree }",
            "did you mean Poisson?",
        ),
        ("Region -> Place(centre) { Tree }", "did you mean CENTRE?"),
        ("Region -> Place(west) { Tree }", "did you mean WEST?"),
        (
            "Region -> Place(CENTRE, facing = CENTRE) { Tree }",
            "did you mean centre?",
        ),
        (
            "Region -> Place(Cardinal(WEST, Comass)) { Tree }",
            "did you mean Compass?",
        ),
        ("Region -> Scatter(3)", "nothing to scatter"),
        ("Region -> Distribute(OUTER)", "nothing to distribute"),
        (
            "Region -> Distribute(OUTER, 0) { Tree }",
            "must be positive",
        ),
        ("Region -> Distribute(OUTER, 0.00001) { Tree }", "100,000"),
        ("Region -> Sweep(OUTER) { Lawn }", "cannot be drawn"),
        ("Region -> Sweep((0.5, 0.5)) { Hedge }", "two places"),
        ("Region -> ScatterCircles(3 {5})", "gives places"),
        ("Region -> ScatterCircles { Sand }", "how many circles"),
        ("Region -> Distribute(OUTER: -1) { Tree }", "leads into"),
        (
            "Region -> Place(Cardinal(3)) { Tree }",
            "direction of the compass",
        ),
        (
            "param A = Object(height = 3)\nRegion -> A",
            "needs a radius",
        ),
        (
            "param A = Object(radius = 1, colour = \"red\")\nRegion -> A",
            "no colour",
        ),
        (
            "Region -> Place(OUTER) { Case { Length(OUTER) > 200: Lawn } }",
            "can stand here",
        ),
    ] {
        let error = on(&rectangle(), rules).expect_err(rules).to_string();
        assert!(error.contains(what), "{rules}: {error}");
    }
}

/// The wedge at a corner left a slit to the strip beside it, as wide as rounding,
/// and the row began anew there.
#[test]
fn rows_go_on_round_inner_corners() {
    // The land turns by 40 degrees at (50, 10), in arcs of less than 30.
    let park = polygon![
        (x: 0., y: 0.), (x: 50., y: 10.), (x: 100., y: -15.), (x: 100., y: 50.), (x: 0., y: 50.)
    ];
    for dx in [0.0, 0.1, 1e3, 12_345.678] {
        let ring = park.exterior().0.iter().map(|c| Coord {
            x: c.x + dx,
            y: c.y,
        });
        let moved = Polygon::new(ring.collect(), Vec::new());
        let scene = on(&moved, "Region -> Distribute(EDGE[3]: 2, 7) { Lamp }").expect("derives");
        let steps: Vec<f64> = scene
            .objects
            .windows(2)
            .map(|o| (o[1].at.x - o[0].at.x).hypot(o[1].at.y - o[0].at.y))
            .collect();
        // All steps are the same but for the one that the arc shortens.
        let longest = steps.iter().copied().fold(0.0, f64::max);
        let shorter = steps.iter().filter(|&&s| s < longest - 1e-6).count();
        assert!(shorter <= 1, "{steps:?}");
    }
}

#[test]
fn hopeless_scattering_ends() {
    let park = derive("Region -> Scatter(100000, room = 30) { Tree }");
    assert_eq!(park.objects.len() + park.skipped, 100_000);
    let park = derive("Region -> Place(ScatterCircles(100000 {[9, 10]})) { Lamp }");
    assert!(park.objects.len() < 20);
}

#[test]
fn selections_that_double_are_stopped() {
    let rules = "Region -> R(WEST)\nR(s) -> R(s or s)";
    let error = on(&rectangle(), rules).expect_err("endless");
    assert!(matches!(error, ParkError::Limit { .. }) || error.to_string().contains("without end"));
}
