//! `urban-layout network` as a user meets it.
#![cfg(feature = "cli")]

mod bench;

use bench::{json, names, Bench, BOW_TIE};
use serde_json::Value;

const SPEC: &str = r#"
edge-length = 25.0
[[level]]
class = "collector"
[[level]]
class = "local"
width = 7.5
[level.network]
sinks = "streets"
coverage = { hops = 2 }
travel = 0.1
"#;

/// A lake in the middle of a square.
const LAKE: &str = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "site"}, "geometry":
{"type": "Polygon", "coordinates": [[[0, 0], [400, 0], [400, 400], [0, 400], [0, 0]]]}},
{"type": "Feature", "properties": {"kind": "water"}, "geometry":
{"type": "Polygon", "coordinates": [[[150, 150], [250, 150], [250, 250], [150, 250], [150, 150]]]}}]}"#;

/// The words that design a network for a site, in the folder `net`.
fn network<'w>(site: &'w str, more: &[&'w str]) -> Vec<&'w str> {
    let words = ["network", site, "--out", "net"];
    [&words[..], more].concat()
}

/// The figures of a network to a specification, for which there are so many seconds.
fn designed(bench: &Bench, spec: &str, seconds: &str) -> Value {
    std::fs::write(bench.path("spec.toml"), spec).expect("written");
    let more = ["--spec", "spec.toml", "--deadline", seconds, "--json"];
    json(&bench.expect(0, &network("site.geojson", &more)))
}

fn points(feature: &Value) -> Vec<(f64, f64)> {
    let all = feature["geometry"]["coordinates"]
        .as_array()
        .expect("points");
    let number = |v: &Value| v.as_f64().expect("a number");
    all.iter().map(|p| (number(&p[0]), number(&p[1]))).collect()
}

/// Sinks find their places, and spans are counted.
#[test]
fn sinks_are_placed_and_places_joined() {
    let spec = r#"
edge-length = 25.0
[[level]]
[level.network]
rim = "open"
sinks = { placed = { count = 2, among = "boundary" } }
[level.network.traffic]
inside = { parts = { count = 3 }, missing = { weighted = 1.0 } }
across = { pairs = { between = [[{ u = 0.0, v = 0.5 }, { u = 1.0, v = 0.5 }]] }, missing = { weighted = 5.0 } }
"#;
    let bench = Bench::new();
    let figures = designed(&bench, spec, "1.0");
    let level = &figures["levels"][0];
    assert_eq!(level["placed_sinks"], 2);
    // Three parts are joined in a row or all to all.
    let spans = level["spans"].as_u64().expect("spans");
    assert!((3..=4).contains(&spans), "{spans}");
    assert!(level["spans_there"].as_u64().expect("spans") <= spans);
    let text = std::fs::read_to_string(bench.path("net").join("network.geojson")).expect("text");
    let streets = json(&text);
    let features = streets["features"].as_array().expect("features");
    let sinks = features
        .iter()
        .filter(|f| f["properties"]["kind"] == "sink");
    assert_eq!(sinks.count(), 2);
}

/// What each file promises, and that levels meet.
#[test]
fn a_network_is_designed_and_drawn() {
    let bench = Bench::new();
    let figures = designed(&bench, SPEC, "1.0");
    assert_eq!(
        names(&bench.path("net")),
        [
            "network.geojson",
            "network.json",
            "network.svg",
            "traffic.svg"
        ]
    );
    let read = |name: &str| std::fs::read_to_string(bench.path("net").join(name)).expect(name);
    assert_eq!(json(&read("network.json")), figures);
    assert_eq!(figures["valid"], true);
    let number = |key: &str| figures[key].as_f64().expect(key);
    assert!(number("bound") <= number("objective") && (0.0..=1.0).contains(&number("gap")));
    assert!(number("first_feasible_seconds") <= number("seconds"));

    let streets = json(&read("network.geojson"));
    assert_eq!(streets["coordinate_units"], "metres");
    let features = streets["features"].as_array().expect("features");
    let of = |level: u64| {
        features
            .iter()
            .filter(move |f| f["properties"]["level"] == level)
    };
    assert!(of(0).count() > 0 && of(1).count() > 0);
    assert!(of(0).all(|f| f["properties"]["class"] == "collector"));
    assert!(of(1).all(|f| f["properties"]["width_m"] == 7.5));
    // All within the site, and each open end on the boundary or on a street.
    let all: Vec<(f64, f64)> = features.iter().flat_map(points).collect();
    assert!(all
        .iter()
        .all(|&(x, y)| (-1e-6..240.0 + 1e-6).contains(&x) && (-1e-6..150.0 + 1e-6).contains(&y)));
    for feature in features {
        let line = points(feature);
        let (first, last) = (line[0], line[line.len() - 1]);
        if first == last {
            continue;
        }
        for (x, y) in [first, last] {
            let rim = x.min(240.0 - x).min(y).min(150.0 - y).abs() < 1e-6;
            let shared = all
                .iter()
                .filter(|&&(a, b)| (a - x).hypot(b - y) < 1e-6)
                .count()
                > 1;
            assert!(rim || shared, "a street ends at ({x}, {y})");
        }
    }
    for name in ["network.svg", "traffic.svg"] {
        let svg = read(name);
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
    }
    // 250 cars per square kilometre on 240 m by 150 m: 9 an hour.
    let traffic = &figures["traffic"];
    let rate = traffic["cars_per_hour"].as_f64().expect("a rate");
    assert!((8.0..=10.0).contains(&rate), "{traffic}");
    assert!(traffic["mean_distance_m"].as_f64().expect("metres") > 0.0);
    assert_eq!(traffic["simulated"], Value::Null);
}

/// Files for SUMO, and if it is there what it says: near to what was predicted
/// for the few cars of a small site.
#[test]
fn files_for_sumo_are_written() {
    let bench = Bench::new();
    let words = network(
        "site.geojson",
        &["--deadline", "0.5", "--cars", "2000", "--sumo", "--json"],
    );
    let figures = json(&bench.expect(0, &words));
    let written = names(&bench.path("net"));
    for end in ["nod.xml", "edg.xml", "typ.xml", "trips.xml", "sumocfg"] {
        assert!(written.contains(&format!("network.{end}")), "{written:?}");
    }
    let simulated = &figures["traffic"]["simulated"];
    if simulated.is_null() {
        eprintln!("SUMO is not installed; nothing was simulated");
        return;
    }
    assert_eq!(simulated["arrived"], simulated["trips"]);
    let ratio = simulated["distance_ratio"].as_f64().expect("a ratio");
    // Trips of some dozen metres lose and gain metres at junctions.
    assert!((0.7..1.3).contains(&ratio), "{simulated}");
}

/// 150 cars an hour for two hours from corner to corner, and nobody else.
#[test]
fn demand_is_part_of_a_specification() {
    let bench = Bench::new();
    let demand =
        "[demand]\ncars-per-km2 = 0.0\npairs = [{ from = [5, 5], to = [235, 145], cars = 150 }]\n";
    let traffic = &designed(&bench, demand, "0.5")["traffic"];
    assert_eq!(traffic["trips"], 300);
    assert_eq!(traffic["cars_per_hour"], 150.0);
    // Along a straight line at least, and not round the whole block.
    let metres = traffic["mean_distance_m"].as_f64().expect("metres");
    assert!((269.0..600.0).contains(&metres), "{metres}");
}

#[test]
fn strange_numbers_of_cars_are_refused() {
    let bench = Bench::new();
    for cars in ["-1", "NaN", "1e12"] {
        let cars = format!("--cars={cars}");
        let words = network("site.geojson", &["--deadline", "0.3", &cars]);
        assert_eq!(bench.run(&words).status.code(), Some(2), "{cars}");
    }
    assert!(!bench.path("net").exists());
}

/// Without a specification there are collectors; streets keep out of a lake.
#[test]
fn streets_keep_out_of_elements() {
    let bench = Bench::new();
    std::fs::write(bench.path("lake.geojson"), LAKE).expect("written");
    bench.expect(0, &network("lake.geojson", &["--deadline", "0.5"]));
    let text = std::fs::read_to_string(bench.path("net/network.geojson")).expect("written");
    let streets = json(&text);
    let features = streets["features"].as_array().expect("features");
    assert!(!features.is_empty());
    for (x, y) in features.iter().flat_map(points) {
        // Smoothing may round a corner of the lake by less than an edge.
        let deep = (x - 150.0).min(250.0 - x).min(y - 150.0).min(250.0 - y);
        assert!(deep < 20.0, "({x}, {y}) lies {deep} m within the lake");
    }
}

#[test]
fn what_is_wrong_is_said() {
    let bench = Bench::new();
    let stderr = |words: &[&str], status: i32| {
        let output = bench.run(words);
        assert_eq!(output.status.code(), Some(status), "{words:?}");
        String::from_utf8(output.stderr).expect("UTF-8")
    };
    for (text, word) in [
        ("level = []", "no level"),
        ("[[level]]\nwidht = 3", "widht"),
        ("[[level]]\nwidth = -3", "metres"),
        ("[[level]]\n[level.network]\nobstacles = [9999]", "9999"),
    ] {
        std::fs::write(bench.path("bad.toml"), text).expect("written");
        let said = stderr(&network("site.geojson", &["--spec", "bad.toml"]), 1);
        assert!(said.contains(word), "{said}");
    }
    let said = stderr(&network("site.geojson", &["--deadline", "0"]), 2);
    assert!(said.contains("deadline"), "{said}");
    stderr(&network("site.geojson", &["--spec", "none.toml"]), 1);
    std::fs::write(bench.path("tie.geojson"), BOW_TIE).expect("written");
    stderr(&network("tie.geojson", &[]), 1);
    assert!(!bench.path("net").exists());
}
