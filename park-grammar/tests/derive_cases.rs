//! What grammars make of outlines, by examples with known answers.

mod common;

use park_grammar::geo_types::{polygon, Polygon};
use park_grammar::scene::Ground;
use park_grammar::{DeriveOptions, Grammar, ParkError, Scene};

fn square() -> Polygon<f64> {
    common::rectangle(80., 50.)
}

fn derive(rules: &str) -> Result<Scene, ParkError> {
    common::park(&square(), rules, 0)
}

#[test]
fn shapes_are_cut_out() {
    let park = derive(
        "Region -> Meadow\n    Place((0.25, 0.5)) { Square(10) Gravel Fountain }\n    Place(CENTRE) { Tree }",
    )
    .expect("derives");
    assert_eq!(park.pieces.len(), 2);
    assert_eq!(park.pieces[0].ground, Ground::Path);
    assert_eq!(park.pieces[1].material, "Meadow");
    let names: Vec<&str> = park.objects.iter().map(|o| o.name.as_str()).collect();
    assert_eq!(names, ["Fountain", "Tree"]);
    let at = park.objects[0].at;
    assert!((at.x - 20.0).abs() < 1e-9 && (at.y - 25.0).abs() < 1e-9);
}

#[test]
fn what_has_no_room_has_an_alternative() {
    let error = derive("Region -> Circle(26) Gravel").expect_err("no room");
    assert!(error.to_string().contains("no room"), "{error}");
    let park =
        derive("Region -> Place(CENTRE) { Circle(26) Gravel } else { Sand }").expect("derives");
    assert_eq!(park.pieces.len(), 1);
    assert_eq!(park.pieces[0].material, "Sand");
}

#[test]
fn branches_are_chosen() {
    let park = derive("Region -> Case { area > 4000: Water | sides == 4: Sand | else: Soil }");
    assert_eq!(park.expect("derives").pieces[0].material, "Sand");
    let park = derive("Region -> Choose { 0: Water | 2: Soil }").expect("derives");
    assert_eq!(park.pieces[0].material, "Soil");
}

#[test]
fn rules_without_end_are_stopped() {
    for rules in ["Region -> Region", "Region -> Case { else: Region }"] {
        let error = derive(rules).expect_err("endless");
        assert!(matches!(error, ParkError::Limit { .. }), "{error}");
    }
}

#[test]
fn functions_and_parameters_have_values() {
    let rules = "param Size = 4 m\nfun twice(x) = 2 * x\nRegion -> Disc(twice(Size))\nDisc(r) -> Place(CENTRE) { Circle(r) Sand }";
    let park = derive(rules).expect("derives");
    // A polygon of 36 corners on a circle of 8 m.
    let wanted = 18.0 * 64.0 * (std::f64::consts::PI / 18.0).sin();
    let ring = park.pieces[0].polygon.exterior();
    let doubled: f64 = ring.lines().map(|l| l.determinant()).sum();
    assert!((doubled / 2.0 - wanted).abs() < 1e-6, "{}", doubled / 2.0);
}

#[test]
fn bad_outlines_are_named() {
    let grammar = Grammar::new("grammar 1\nRegion -> Lawn").expect("reads");
    let line = polygon![(x: 0., y: 0.), (x: 80., y: 0.), (x: 0., y: 0.)];
    let nan = polygon![(x: 0., y: f64::NAN), (x: 80., y: 0.), (x: 0., y: 9.)];
    for bad in [line, nan] {
        let found = grammar.derive(&bad, &DeriveOptions::default());
        assert!(matches!(found, Err(ParkError::Outline { .. })), "{found:?}");
    }
}

/// The park is 80 by 50: the largest circle in it has a radius of 25, and lies
/// anywhere between 25 m from both ends.
#[test]
fn sizes_follow_the_region() {
    let disc = |radius: &str| {
        let rules = format!("Region -> Place(POLE) {{ Circle({radius}) Sand }}");
        derive(&rules).map(|park| {
            let ring = park.pieces[0].polygon.exterior();
            let doubled: f64 = ring.lines().map(|l| l.determinant()).sum();
            // A polygon of 36 corners.
            (doubled / (36.0 * (std::f64::consts::PI / 18.0).sin())).sqrt()
        })
    };
    for (radius, wanted) in [
        ("0.9 * room", 22.5),
        ("min(8, 0.4 * room)", 8.0),
        ("min(80, 0.4 * room, 30 ft)", 9.144),
        ("max(3 m, sqrt(area) / 20)", 3.1622776601683795),
        ("0.1 * extent_x + 0.2 * extent_y", 18.0),
    ] {
        let found = disc(radius).expect("derives");
        assert!((found - wanted).abs() < 1e-2, "{radius}: {found}");
    }
    for (radius, wanted) in [
        ("min()", "min needs numbers to choose from"),
        ("sqrt(4, 9)", "sqrt needs one number"),
        ("sqrt(0 - area)", "no root of less than nothing"),
        ("sqrt(room)", "the root of a length"),
        ("max(3 m, 20 deg)", "do not go together"),
        ("mim(3, 4)", "did you mean min?"),
    ] {
        let error = disc(radius).expect_err("no number").to_string();
        assert!(error.contains(wanted), "{radius}: {error}");
    }
}

/// What is planted is not walked on, wherever it lies.
#[test]
fn materials_say_what_is_walked_on() {
    let park = derive("Region -> Grid(2, 2) { Lawn } { Gravel } { Circle(4) FlowerBed Statue }");
    let park = park.expect("derives");
    let walked: Vec<&str> = park
        .pieces
        .iter()
        .filter(|piece| piece.ground == Ground::Path)
        .map(|piece| piece.material.as_str())
        .collect();
    assert_eq!(walked, ["Gravel"; 4]);
    assert_eq!(park.objects[0].ground, Ground::Region);
    let park = derive("Region -> Grid(2, 1) { Lawn } { GrassPath }").expect("derives");
    assert_eq!(park.pieces[2].ground, Ground::Path);
}

/// A path ends with the boundary up to rounding; once it left a hair there that
/// joined both sides.
#[test]
fn paths_cut_regions_through() {
    let park = polygon![
        (x: -0.02, y: -6.48), (x: 66.73, y: -99.95), (x: 181.98, y: -19.75),
        (x: 114.17, y: 77.28), (x: 76.63, y: 52.85), (x: 30.43, y: 21.49)
    ];
    for y in 0..40 {
        let y = 0.3 + 0.01 * f64::from(y);
        let rules = format!(
            "grammar 1\nRegion -> SplitAlong((0, 0.4), (0.2, {y}), (1, 0.5), curve = smooth, width = 3) {{ Lawn | Meadow | Gravel }}"
        );
        let grammar = Grammar::new(&rules).expect("reads");
        let scene = grammar.derive(&park, &DeriveOptions::default());
        assert_eq!(scene.map(|s| s.pieces.len()), Ok(3), "{y}");
    }
}
