//! What `VoronoiRegions` makes, by examples with known answers.

mod common;

use park_grammar::geo_types::{polygon, Polygon};
use park_grammar::scene::Ground;
use park_grammar::Scene;

use common::{close, of, park, rectangle, size, sum};

/// 60 wide, 40 high.
fn oblong() -> Polygon<f64> {
    rectangle(60., 40.)
}

fn derive(rules: &str) -> Scene {
    park(&oblong(), rules, 1).expect("derives")
}

/// Two places: one border in the middle, half of its width taken from each.
#[test]
fn regions_give_way_to_the_paths() {
    let scene = derive("PathWidth = 3\nRegion -> VoronoiRegions([(0.25, 0.5), (0.75, 0.5)], none) { Meadow } { Paving }");
    let regions = of(&scene, "Meadow");
    assert_eq!(regions.len(), 2);
    assert!(regions.iter().all(|p| close(size(&p.polygon), 28.5 * 40.0)));
    let paths = of(&scene, "Paving");
    assert!(paths.len() == 1 && close(size(&paths[0].polygon), 120.0));
    assert_eq!(paths[0].ground, Ground::Path);
}

/// The notes' two names, and what is not said: smoothed regions and gravel paths.
#[test]
fn the_notes_examples() {
    let rules = |name: &str| {
        format!("Region -> {name}(CircleRegions) {{ SmoothRegions }} {{ Path }}\nCircleRegions -> ScatterCircles(5 {{[5-10]}})\nSmoothRegions -> Meadow\nPath -> Gravel")
    };
    let scene = derive(&rules("VoronoiSmoothed"));
    assert_eq!(scene, derive(&rules("VoronoiRegions")));
    assert_eq!(of(&scene, "Meadow").len(), 5);
    assert!(close(
        sum(&of(&scene, "Meadow")) + sum(&of(&scene, "Gravel")),
        2400.0
    ));
    let sharp =
        derive("Region -> VoronoiRegions(ScatterCircles(5 {[5-10]}), none) { Meadow } { Gravel }");
    assert!(sum(&of(&scene, "Gravel")) > sum(&of(&sharp, "Gravel")) + 1.0);
}

/// A path of its own width all around: what is left is 28.5 - 2 by 36.
#[test]
fn a_path_all_around() {
    let places = "[(0.25, 0.5), (0.75, 0.5)], none, width = 3";
    let scene = derive(&format!(
        "Region -> VoronoiRegions({places}, around = 2) {{ Meadow }} {{ Paving }}"
    ));
    assert!(of(&scene, "Meadow")
        .iter()
        .all(|p| close(size(&p.polygon), 26.5 * 36.0)));
    assert_eq!(of(&scene, "Paving").len(), 1);
    assert_eq!(of(&scene, "Paving")[0].polygon.interiors().len(), 2);
    let scene = derive(&format!(
        "Region -> VoronoiRegions({places}, Around) {{ Meadow }} {{ Paving }}"
    ));
    assert!(of(&scene, "Meadow")
        .iter()
        .all(|p| close(size(&p.polygon), 25.5 * 34.0)));
}

/// Weights: with radii of 10 and 5 at 30 from each other the border lies where
/// x^2 - 100 = (30 - x)^2 - 25.
#[test]
fn larger_circles_grow_further() {
    let places = "Places[10], Others[5]";
    let rules = format!("fun Places = Along(EDGE[1], at = 0.25, offset = 20)\nfun Others = 1\nRegion -> VoronoiRegions([{places}], Weighted) {{ Meadow }} {{}}");
    // What has no places has none.
    assert!(park(&oblong(), &rules, 1).is_err());
    let rules = "Region -> VoronoiRegions([One, Two], Weighted) { Meadow } {}\nfun One() = Along(EDGE[1], at = 0.25, offset = 20)[10]\nfun Two() = Along(EDGE[1], at = 0.75, offset = 20)[5]";
    let rules = rules.replace("[One, Two]", "[One(), Two()]");
    let scene = derive(&rules);
    let mut sizes: Vec<f64> = scene.pieces.iter().map(|p| size(&p.polygon)).collect();
    sizes.sort_by(f64::total_cmp);
    let border = 15.0 + (30.0_f64.powi(2) + 75.0) / 60.0;
    assert!(
        close(sizes[1], 40.0 * border) && close(sizes[0], 40.0 * (60.0 - border)),
        "{sizes:?}"
    );
}

/// In the middle of each cell a shape, at the place; where there is no room for it
/// there, where most room is, or nowhere.
#[test]
fn centres_are_cut_out() {
    let scene = derive("Region -> VoronoiRegions([(0.25, 0.5), (0.75, 0.5)], none) { Meadow } { Paving } { Square(6) Sand Fountain }");
    let centres = of(&scene, "Sand");
    assert!(centres.len() == 2 && centres.iter().all(|p| close(size(&p.polygon), 36.0)));
    let mut at: Vec<f64> = scene.objects.iter().map(|o| o.at.x).collect();
    at.sort_by(f64::total_cmp);
    assert!(
        close(at[0], 15.0)
            && close(at[1], 45.0)
            && scene.objects.iter().all(|o| close(o.at.y, 20.0))
    );
    assert!(of(&scene, "Meadow")
        .iter()
        .all(|p| p.polygon.interiors().len() == 1));
    // 1 m from the edge there is no room for 6 m: it moves.
    let scene = derive("Region -> VoronoiRegions([(0.25, 0.02), (0.75, 0.5)], none) { Meadow } { Paving } { Square(6) Sand }");
    assert_eq!(of(&scene, "Sand").len(), 2);
    let scene = derive("Region -> VoronoiRegions([(0.25, 0.5), (0.75, 0.5)]) { Meadow } { Paving } { Circle(30) Sand }");
    assert!(of(&scene, "Sand").is_empty());
}

/// A third block without a shape has the room of the place; without any it says
/// what is missing.
#[test]
fn centres_without_a_shape_have_the_places_room() {
    let scene = derive("Region -> VoronoiRegions(CENTRE[5], none) { Meadow } { Paving } { Sand }");
    let circle = 36.0 * 0.5 * 25.0 * (std::f64::consts::PI / 18.0).sin();
    assert!(close(sum(&of(&scene, "Sand")), circle));
    let rules = "Region -> VoronoiRegions(CENTRE) { Meadow } { Paving } { Sand }";
    let error = park(&oblong(), rules, 1).expect_err("no size").to_string();
    assert!(
        error.contains("how large") && error.contains("Circle(2)"),
        "{error}"
    );
}

/// Edges along paths are `PATH`, those on the boundary of the park `OUTER`, and
/// side 0 is the longest of these.
#[test]
fn selections_go_by_what_edges_are() {
    let rules = "Region -> VoronoiRegions([(0.25, 0.5), (0.75, 0.5)], none) { Cell } { Paving }\nCell -> Meadow Case { Length(PATH) == 40 and Length(OUTER) == 98 and Length(EDGE[0]) == 40 and sides == 4: Place(CENTRE) { Tree } | else: Place(CENTRE) { Lamp } }";
    let scene = derive(rules);
    assert!(
        scene.objects.iter().all(|o| o.name == "Tree"),
        "{:?}",
        scene.objects
    );
    assert_eq!(scene.objects.len(), 2);
}

/// Smaller regions than `least` are path.
#[test]
fn small_regions_are_path() {
    let rules = |least: u32| {
        format!("Region -> VoronoiRegions([(0.02, 0.5), (0.08, 0.5), (0.75, 0.5)], none, least = {least}) {{ Meadow }} {{ Paving }}")
    };
    assert_eq!(of(&derive(&rules(0)), "Meadow").len(), 3);
    // The first cell is 3 m wide, less 1 m for the path.
    assert_eq!(of(&derive(&rules(90)), "Meadow").len(), 2);
}

/// What cannot be done is said, with the place.
#[test]
fn faults_are_told() {
    for (rules, says) in [
        ("VoronoiRegions() { Meadow }", "needs places"),
        ("VoronoiRegions(5) { Meadow }", "a place"),
        (
            "VoronoiRegions(CENTRE, flat) { Meadow }",
            "nothing called flat",
        ),
        (
            "VoronoiRegions(CENTRE, left) { Meadow }",
            "no way to smooth",
        ),
        (
            "VoronoiRegions(CENTRE, amplitude = -1) { Meadow }",
            "0 or more",
        ),
        (
            "VoronoiRegions(CENTRE, amplitude = 2, wavelength = 0) { Meadow }",
            "positive",
        ),
        (
            "VoronoiRegions(CENTRE, around = -1) { Meadow }",
            "0 or more",
        ),
        (
            "VoronoiRegions(CENTRE, ammplitude = 1) { Meadow }",
            "did you mean amplitude",
        ),
        (
            "VoronoiRegions(CENTRE, Around, width = 50) { Meadow } { Paving }",
            "no room",
        ),
        ("VoronoiRegions((3, 3)) { Meadow }", "none of these places"),
    ] {
        let error = park(&oblong(), &format!("Region -> {rules}"), 0);
        let error = error.expect_err(rules).to_string();
        assert!(error.contains(says), "{rules}: {error}");
    }
    let scene = derive("Region -> VoronoiRegions((3, 3)) { Meadow } else { Sand }");
    assert_eq!(of(&scene, "Sand").len(), 1);
}

/// Of several places at one point one counts, and those outside do not.
#[test]
fn places_count_once() {
    let rules = "Region -> VoronoiRegions([(0.5, 0.5), (0.2, 0.5), (0.5, 0.5), (1, 1)], none) { Meadow } {}";
    assert_eq!(derive(rules).pieces.len(), 3);
    let l = polygon![(x: 0., y: 0.), (x: 40., y: 0.), (x: 40., y: 20.), (x: 20., y: 20.), (x: 20., y: 40.), (x: 0., y: 40.)];
    let rules =
        "Region -> VoronoiRegions([(0.2, 0.2), (0.9, 0.9), (0.2, 0.9)], none) { Meadow } {}";
    assert_eq!(park(&l, rules, 0).expect("derives").pieces.len(), 2);
}
