//! Limits: what leads back to itself and what takes too long is stopped, with an
//! error that names the rule.

mod common;

use std::time::Duration;

use park_grammar::geo_types::{coord, Polygon};
use park_grammar::{DeriveOptions, Grammar, ParkError};

fn square(side: f64) -> Polygon<f64> {
    common::rectangle(side, side)
}

fn grammar(rules: &str) -> Grammar {
    Grammar::new(&format!("grammar 1\n{rules}")).expect("reads")
}

/// What the error says of the limit.
fn limit(rules: &str, options: &DeriveOptions) -> String {
    match grammar(rules).derive(&square(80.0), options) {
        Err(ParkError::Limit { what }) => what,
        Err(other) => panic!("{rules}: {other}"),
        Ok(park) => panic!("{rules}: {} things, no limit", park.objects.len()),
    }
}

#[test]
fn rules_that_lead_back_to_themselves() {
    let options = DeriveOptions::default();
    for rules in [
        "Region -> Bed\nBed -> Region",
        "Region -> Bed\nBed -> Case { else: Bed }",
        "Region -> Bed\nBed -> Grid(1, 1) { Bed } {}",
        "Region -> Bed\nBed -> Peel(ALL, 0.1 %) { Lawn | Bed }",
        "Region -> Bed\nBed -> Place(CENTRE) { Spot }\nSpot -> Spot",
        "Region -> Bed\nBed -> Bed2(1)\nBed2(x) -> Bed",
        "Region -> Bed\nfun Bed() -> Bed()",
    ] {
        let what = limit(rules, &options);
        assert!(what.contains("rules lead to rules 64 deep"), "{what}");
        assert!(what.contains("in the rule"), "{what}");
    }
    let what = limit(
        "Region -> Grid(2, 2) { Quarter } {}\nQuarter -> Region",
        &options,
    );
    assert!(what.ends_with("in the rule Quarter") || what.ends_with("in the rule Region"));
}

#[test]
fn operations_are_counted() {
    let options = DeriveOptions {
        operations: 500,
        ..DeriveOptions::default()
    };
    let rules = "Region -> Grid(40, 40) { Cell } {}\nCell -> Place(CENTRE) { Bin }";
    let what = limit(rules, &options);
    assert_eq!(what, "it came to 500 operations, the last in the rule Cell");
    let rules = "Region -> Scatter(1000, room = 0.1) { Bin }";
    assert!(limit(rules, &options).ends_with("in the rule Region"));
}

/// What each has to do takes any machine longer than a thousandth of a second, and
/// the operations look at the clock on their way: none is done to its end.
#[test]
fn time_holds_within_one_operation() {
    let options = DeriveOptions {
        time: Some(Duration::from_millis(1)),
        ..DeriveOptions::default()
    };
    for rules in [
        "Region -> Scatter(100000, room = 0.05) { Flowers }",
        "Region -> Scatter(Poisson, room = 0.05) { Lamp }",
        "Region -> ScatterCircles(100000 {0.05}) { Sand }",
        "Region -> ScatterCircles({0.05}) { Sand }",
        "Region -> Grid(500, 500, width = 0.01) { Lawn }",
        "Region -> Grid(500, 500) { Lawn } {}",
        "Region -> Distribute(ALL, 0.004) { Bin }",
        "Region -> VoronoiRegions(ScatterCircles(5000 {0.2}), width = 0.1) { Lawn }",
        "Region -> CastRays(ScatterCircles(500 {0.3}), 3600, rays = all, width = 0.1) { Lawn }",
        "Region -> Place(Along(ALL, 90000)) { Bin }",
        &format!(
            "Region -> Peel(ALL) {{ {} Lawn }}",
            "0.1 m: Lawn | ".repeat(300)
        ),
        "Region -> Rings(900 {0.04}, width = 0.01) { Lawn }",
    ] {
        let what = limit(rules, &options);
        assert_eq!(
            what, "it took more than 0.001 s, the last in the rule Region",
            "{rules}"
        );
    }
}

/// How often a derivation asks whether to go on, in all and before its first
/// operation is done; and that it stops when told.
fn asked(outline: &Polygon<f64>, rules: &str) -> [usize; 2] {
    let grammar = grammar(rules);
    let [mut asked, mut first] = [0; 2];
    let options = DeriveOptions {
        time: None,
        ..DeriveOptions::default()
    };
    let all = grammar.derive_watched(outline, &options, &mut |operations| {
        asked += 1;
        first += usize::from(operations <= 1);
        true
    });
    assert!(all.is_ok(), "{rules}: {:?}", all.err());
    for stop in [first / 2, asked / 2] {
        let mut left = stop.max(1);
        let half = grammar.derive_watched(outline, &options, &mut |_| {
            left -= 1;
            left > 0
        });
        assert_eq!(half, Err(ParkError::Cancelled), "{rules}");
        assert_eq!(left, 0, "{rules}");
    }
    [asked, first]
}

#[test]
fn long_operations_ask_whether_to_go_on() {
    for (rules, least) in [
        ("Region -> Grid(60, 60, width = 0.1) { Lawn }", 100),
        ("Region -> Scatter(2000, room = 0.05) { Bin }", 2000),
        ("Region -> ScatterCircles({0.7}) { Sand }", 100),
        ("Region -> VoronoiRegions(Spots, width = 0.1) { Lawn }\nSpots -> ScatterCircles(300 {0.5})", 10),
        ("Region -> CastRays(CENTRE, 3600) { Lawn }", 50),
    ] {
        let [asked, _] = asked(&square(80.0), rules);
        assert!(asked >= least, "{rules}: {asked}");
    }
}

/// So do those that are one boolean after the other: `least` is what they have.
#[test]
fn strips_ask_whether_to_go_on() {
    let strips = "0.1 m: Lawn | ".repeat(100);
    let ranges: Vec<String> = (0..100)
        .map(|k| format!("[0.{k:02}1, 0.{k:02}5]"))
        .collect();
    let ranges = ranges.join(", ");
    for (rules, least) in [
        (format!("Region -> Peel(ALL) {{ {strips} Lawn }}"), 400),
        (
            format!("Region -> Peel(ALL, smooth = average) {{ {strips} Lawn }}"),
            600,
        ),
        (
            format!("Region -> Sweep(Part(ALL, {ranges})) {{ Hedge }}"),
            200,
        ),
        (
            "Region -> Rings(100 {0.2}, width = 0.1) { Lawn }".to_owned(),
            200,
        ),
    ] {
        let [_, first] = asked(&square(80.0), &rules);
        assert!(first >= least, "{rules}: {first}");
    }
    // A star of a thousand points: as many edges to be moved.
    let star = (0..2000).map(|k| {
        let (sin, cos) = (f64::from(k) * std::f64::consts::PI / 1000.0).sin_cos();
        let radius = if k % 2 == 0 { 80.0 } else { 79.9 };
        coord! { x: radius * cos, y: radius * sin }
    });
    let star = Polygon::new(star.collect(), vec![]);
    for (rules, least) in [
        ("Region -> Peel(ALL, 2 m) { Lawn | Meadow }", 2000),
        ("Region -> Contract(2 m) { Lawn | Meadow }", 2000),
        ("Region -> Smooth(average, margin = 2 m) { Lawn | Meadow }", 2000),
        // Each crosses a thousand points.
        ("Region -> SplitAlong((0, 0.5), (1, 0.5), curve = sinus, amplitude = 5 m, waves = 100) { Lawn | Meadow | Paving }", 8),
    ] {
        let [_, first] = asked(&star, rules);
        assert!(first >= least, "{rules}: {first}");
    }
}

#[test]
fn unknown_parameters_are_named() {
    let mut options = DeriveOptions::default();
    options.params.insert("PathWith".to_owned(), 3.0);
    let found = grammar("param PathWidth = 2\nRegion -> Lawn").derive(&square(9.0), &options);
    let error = found.expect_err("unknown").to_string();
    assert!(
        error.contains("no parameter PathWith") && error.contains("PathWidth"),
        "{error}"
    );
}

/// Found among changed grammars: a strip that was wider than the world made a
/// boolean panic.
#[test]
fn nothing_is_wider_than_the_world() {
    for rules in [
        "Region -> Sweep(ALL, 1e300) { Hedge }",
        "Region -> Sweep(ALL: 1e300, 1) { Hedge }",
        "Region -> Grid({1e300}, 2) { Lawn }",
        "Region -> Place((1e300, 0.5)) { Circle(1e300) Sand }",
        "Region -> Sweep([(0, 0), (1e300, 1)], 2) { Hedge }",
        "Region -> CastRays((0.5, 0.5), 5, width = 1e300) { Lawn }",
        "param A = Object(radius = 1, spread = 1e300)\nRegion -> Scatter(3) { A }",
    ] {
        let found = grammar(rules).derive(&square(80.0), &DeriveOptions::default());
        assert!(!matches!(found, Err(ParkError::Limit { .. })), "{rules}");
    }
    let found = grammar("Region -> Lawn").derive(&square(1e12), &DeriveOptions::default());
    assert!(matches!(found, Err(ParkError::Outline { .. })));
}
