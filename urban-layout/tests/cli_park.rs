//! `urban-layout park` as a user meets it.
#![cfg(feature = "cli")]

mod bench;

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use bench::{files, json, names, Bench, BOW_TIE};
use serde_json::Value;

/// An oblong of 90 by 60 metres.
const POLYGON: &str = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "park", "name": "Little park"}, "geometry":
{"type": "Polygon", "coordinates": [[[0, 0], [90, 0], [90, 60], [0, 60], [0, 0]]]}}]}"#;

const GRAMMAR: &str = "grammar 1
param Wide = 3 m
Region -> Grid(2, 2, width = Wide) { Quarter } { Gravel } { Circle(5) Paving Fountain }
Quarter -> Place((0.3, 0.3)) { Circle(3) FlowerBed } Sweep(OUTER: 0.5) { Hedge } Scatter(12) { Tree | Bush }
";

fn bench() -> Bench {
    let bench = Bench::new();
    std::fs::write(bench.path("park.geojson"), POLYGON).expect("written");
    std::fs::write(bench.path("my.park"), GRAMMAR).expect("written");
    bench
}

/// The words that make a park of a file, in the folder `plan`.
fn park<'w>(polygon: &'w str, grammar: &'w str, more: &[&'w str]) -> Vec<&'w str> {
    let words = ["park", polygon, "--grammar", grammar, "--out", "plan"];
    [&words[..], more].concat()
}

fn number(of: &Value, key: &str) -> f64 {
    of[key]
        .as_f64()
        .unwrap_or_else(|| panic!("{key} is no number: {of}"))
}

/// The whole numbers that features have by a name.
fn numbers(features: &[Value], key: &str) -> BTreeSet<u64> {
    let of = |f: &Value| f["properties"][key].as_u64().expect("an integer");
    features.iter().map(of).collect()
}

/// The park that was written into a folder.
fn written(bench: &Bench, folder: &str) -> String {
    let file = bench.path(folder).join("park.geojson");
    std::fs::read_to_string(file).expect("written")
}

fn features(text: &str) -> Vec<Value> {
    let all = json(text)["features"].clone();
    all.as_array().expect("features").clone()
}

fn of<'f>(features: &'f [Value], kind: &str) -> Vec<&'f Value> {
    let found = features.iter().filter(|f| f["properties"]["kind"] == kind);
    found.collect()
}

type Position = [f64; 2];

/// The rings of a polygon, exterior first.
fn rings(feature: &Value) -> Vec<Vec<Position>> {
    let number = |v: &Value| v.as_f64().expect("a number");
    let ring = |ring: &Value| -> Vec<Position> {
        let points = ring.as_array().expect("a ring").iter();
        points.map(|p| [number(&p[0]), number(&p[1])]).collect()
    };
    let all = feature["geometry"]["coordinates"].as_array();
    all.expect("rings").iter().map(ring).collect()
}

fn signed(ring: &[Position]) -> f64 {
    let [x, y] = ring[0];
    let part = |w: &[Position]| (w[0][0] - x) * (w[1][1] - y) - (w[1][0] - x) * (w[0][1] - y);
    0.5 * ring.windows(2).map(part).sum::<f64>()
}

/// Tiles: every side of one is, the other way, a side of another; what is left
/// over bounds the land. Gives the area that the left-over sides enclose.
fn tiled(tiles: &[&Value]) -> f64 {
    let key = |p: Position| p.map(f64::to_bits);
    let mut sides: BTreeMap<[[u64; 2]; 2], [Position; 2]> = BTreeMap::new();
    for ring in tiles.iter().flat_map(|tile| rings(tile)) {
        for w in ring.windows(2) {
            if sides.remove(&[key(w[1]), key(w[0])]).is_none() {
                let twice = sides.insert([key(w[0]), key(w[1])], [w[0], w[1]]);
                assert!(twice.is_none(), "two tiles on one side of {w:?}");
            }
        }
    }
    let [x, y] = sides.values().next().expect("a boundary")[0];
    let part = |[a, b]: &[Position; 2]| (a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y);
    0.5 * sides.values().map(part).sum::<f64>()
}

#[test]
fn a_park_is_derived_and_drawn() {
    let bench = bench();
    let words = park("park.geojson", "my.park", &[]);
    let said = bench.expect(0, &words);
    assert!(
        said.contains("0.54 ha") && said.contains("things"),
        "{said}"
    );
    assert_eq!(names(&bench.path("plan")), ["park.geojson", "park.svg"]);
    let text = written(&bench, "plan");
    assert_eq!(json(&text)["coordinate_units"], "metres");
    let all = features(&text);
    assert_eq!(numbers(&all, "id").len(), all.len());
    let (regions, paths) = (of(&all, "region"), of(&all, "path"));
    assert!(regions.len() >= 8 && !paths.is_empty());
    let tiles = [regions, paths].concat();
    assert!((tiled(&tiles) - 5400.0).abs() < 5400.0 * 1e-9);
    for tile in &tiles {
        let rings = rings(tile);
        let size: f64 = rings.iter().map(|r| signed(r)).sum();
        assert!(signed(&rings[0]) > 0.0 && rings[1..].iter().all(|r| signed(r) < 0.0));
        let told = number(&tile["properties"], "area_m2");
        assert!((told - size).abs() < 1e-3);
        assert!(tile["properties"]["material"].is_string());
    }
    let objects = of(&all, "object");
    assert!(objects.len() > 20);
    for object in &objects {
        let p = &object["properties"];
        let number = |key: &str| number(p, key);
        assert!(number("radius_m") > 0.0 && number("spread_m") >= number("radius_m"));
        assert!((0.0..360.0).contains(&number("rotation_deg")));
        assert_eq!(object["geometry"]["type"], "Point");
        let on = if p["name"] == "Fountain" {
            "path"
        } else {
            "region"
        };
        assert_eq!(p["on"], on);
    }
    assert_eq!(of(&all, "volume").len(), 4);
    let svg = std::fs::read_to_string(bench.path("plan/park.svg")).expect("written");
    assert!(svg.starts_with("<svg") && svg.contains("<title>Little park</title>"));
}

/// Coordinates are those of the file: a corner of the outline comes back as it
/// was, and the tiles are the park to 1e-9 of its area.
#[test]
fn parks_in_degrees_come_back_in_degrees() {
    let bench = bench();
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../tests/data/parks");
    for name in ["helsinki_makasiini", "helsinki_vanha_kirkkopuisto"] {
        let file = folder.join(format!("{name}.geojson"));
        let words = [
            "park",
            &file.to_string_lossy(),
            "--grammar",
            "formal_garden",
        ];
        bench.expect(0, &[&words[..], &["--out", name]].concat());
        let given = std::fs::read_to_string(&file).expect("readable");
        let outline = rings(&features(&given)[0]);
        let must: f64 = outline.iter().map(|r| signed(r)).sum::<f64>().abs();
        let text = written(&bench, name);
        assert!(json(&text).get("coordinate_units").is_none());
        let all = features(&text);
        let tiles = [of(&all, "region"), of(&all, "path")].concat();
        assert!(tiles.len() > 4);
        assert!((tiled(&tiles) - must).abs() < 1e-9 * must);
        let corners: Vec<Position> = tiles.iter().flat_map(|t| rings(t).concat()).collect();
        for corner in &outline[0] {
            let near = |p: &Position| (p[0] - corner[0]).abs() + (p[1] - corner[1]).abs() < 1e-12;
            assert!(corners.iter().any(near), "{corner:?}");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let bench = bench();
    let words = ["park", "park.geojson", "--grammar", "woodland", "--gltf"];
    for (folder, seed) in [("one", "7"), ("two", "7"), ("other", "8")] {
        bench.expect(
            0,
            &[&words[..], &["--seed", seed, "--out", folder]].concat(),
        );
    }
    for name in ["park.geojson", "park.svg", "park.glb"] {
        let bytes = |folder| std::fs::read(bench.path(folder).join(name)).expect("written");
        assert!(bytes("one") == bytes("two"), "{name}");
        assert!(bytes("one") != bytes("other"), "{name}");
    }
}

#[test]
fn models_and_pictures_come_when_asked_for() {
    let bench = bench();
    // A mesh beside the grammar.
    let grammar = format!("{GRAMMAR}param Stone = Object(radius = 1, mesh = \"stone.obj\")\n");
    let grammar = grammar.replace("| Bush", "| Stone");
    std::fs::write(bench.path("my.park"), grammar).expect("written");
    let stone = "v 1 0 0\nv -1 0 1\nv -1 0 -1\nv 0 1 0\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
    std::fs::write(bench.path("stone.obj"), stone).expect("written");
    let words = park("park.geojson", "my.park", &["--gltf"]);
    bench.expect(0, &words);
    assert_eq!(
        names(&bench.path("plan")),
        ["park.geojson", "park.glb", "park.svg"]
    );
    let model = std::fs::read(bench.path("plan/park.glb")).expect("written");
    assert!(model.starts_with(b"glTF\x02\0\0\0") && model.len() > 10_000);
    if cfg!(feature = "png") {
        bench.expect(0, &[&words[..], &["--png"]].concat());
        let picture = std::fs::read(bench.path("plan/park.png")).expect("written");
        assert!(picture.starts_with(b"\x89PNG\r\n\x1a\n") && picture.len() > 10_000);
    }
}

#[test]
fn figures_are_one_json_object() {
    let bench = bench();
    let words = park("park.geojson", "my.park", &["--json"]);
    let figures = json(&bench.expect(0, &words));
    let number = |key: &str| self::number(&figures, key);
    assert!((number("area_m2") - 5400.0).abs() < 1e-6);
    // Paths of 3 m along 90 and 60 m, less their crossing, and what a circle of 5 m
    // with 36 corners has besides: 78.1 less 50 m2.
    assert!(
        (number("path_m2") - 441.0 - 28.1).abs() < 1.0,
        "{}",
        number("path_m2")
    );
    assert!((number("entrance_m") - 12.0).abs() < 1e-6);
    assert!(number("tiling_error") < 1e-9);
    assert_eq!(figures["violations"], serde_json::json!([]));
    assert_eq!(figures["objects_by_name"]["Fountain"], 1);
    assert_eq!(figures["grammar"], "my");
    // A parameter of one's own makes the paths twice as wide.
    let figures = json(&bench.expect(0, &[&words[..], &["--param", "Wide=6"]].concat()));
    assert!((self::number(&figures, "entrance_m") - 24.0).abs() < 1e-6);
}

#[test]
fn each_part_of_the_land_is_a_park() {
    let bench = bench();
    let two = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "site"}, "geometry": {"type": "Polygon",
"coordinates": [[[-50, -50], [400, -50], [400, 200], [-50, 200], [-50, -50]]]}},
{"type": "Feature", "properties": {"kind": "park"}, "geometry": {"type": "MultiPolygon", "coordinates":
[[[[0, 0], [90, 0], [90, 60], [0, 60], [0, 0]]], [[[200, 0], [260, 0], [260, 40], [200, 40], [200, 0]]]]}}]}"#;
    std::fs::write(bench.path("two.geojson"), two).expect("written");
    let words = park("two.geojson", "my.park", &["--json"]);
    let figures = json(&bench.expect(0, &words));
    assert_eq!(figures["parts"], 2);
    assert!((number(&figures, "area_m2") - 7800.0).abs() < 1e-6);
    assert_eq!(figures["path_networks"], 2);
    let text = written(&bench, "plan");
    let all = features(&text);
    assert_eq!(numbers(&all, "part").len(), 2);
    assert!((tiled(&[of(&all, "region"), of(&all, "path")].concat()) - 7800.0).abs() < 1e-5);
}

/// One line, the status of its sort, and what was written before stays.
#[test]
fn what_is_wrong_is_said_and_nothing_is_written() {
    let bench = bench();
    let words = park("park.geojson", "my.park", &[]);
    bench.expect(0, &words);
    let before = files(&bench.path("plan"));
    std::fs::write(bench.path("bow.geojson"), BOW_TIE).expect("written");
    let grammars = [
        ("typo.park", "grammar 1\nRegion -> Gird(2, 2) { Lawn }\n"),
        (
            "unfit.park",
            "grammar 1\nRegion -> Lawn Place(CENTRE) { Circle(500) Water }\n",
        ),
        (
            "endless.park",
            "grammar 1\nRegion -> Grid(2, 1) { Region } {}\n",
        ),
    ];
    for (name, text) in grammars {
        std::fs::write(bench.path(name), text).expect("written");
    }
    let table = [
        (
            1,
            park("park.geojson", "typo.park", &[]),
            "typo.park:2:11: there is nothing called Gird; did you mean Grid?",
        ),
        (
            1,
            park("park.geojson", "nowhere.park", &[]),
            "simple_square",
        ),
        (1, park("bow.geojson", "my.park", &[]), "cross"),
        (
            1,
            park("nowhere.geojson", "my.park", &[]),
            "nowhere.geojson",
        ),
        (
            2,
            park("park.geojson", "my.park", &["--param", "Narrow=1"]),
            "its parameters are: Wide",
        ),
        (
            2,
            park("park.geojson", "my.park", &["--param", "Wide"]),
            "NAME=VALUE",
        ),
        (3, park("park.geojson", "unfit.park", &[]), "unfit.park:2:"),
        (3, park("park.geojson", "endless.park", &[]), "stopped"),
    ];
    for (status, words, must) in table {
        let said = bench.complaint(status, &words);
        assert!(said.contains(must), "{words:?}: {said}");
    }
    assert!(files(&bench.path("plan")) == before);
    // Without a grammar the command line is not understood.
    assert_eq!(
        bench
            .run(&["park", "park.geojson", "--out", "plan"])
            .status
            .code(),
        Some(2)
    );
}

/// A grammar may break the laws of a park; that is told, and the park is written.
#[test]
fn broken_laws_are_warnings() {
    let bench = bench();
    let island = "grammar 1\nRegion -> Lawn Place(CENTRE) { Circle(5) Gravel }\n";
    std::fs::write(bench.path("island.park"), island).expect("written");
    let words = park("park.geojson", "island.park", &[]);
    let output = bench.run(&words);
    assert_eq!(output.status.code(), Some(0));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.starts_with("warning: ") && said.contains("of the park's boundary only"),
        "{said}"
    );
}

/// Parks of plans have designs of their own; the plan itself is the same without.
#[test]
fn parks_of_a_plan_are_designed() {
    let bench = bench();
    let site = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let site = site.join("../tests/data/sites/kotka_north.geojson");
    let site = site.to_string_lossy();
    let words = ["generate", &*site, "--out"];
    bench.expect(0, &[&words[..], &["auto"]].concat());
    bench.expect(
        0,
        &[&words[..], &["woods", "--park-grammar", "woodland"]].concat(),
    );
    bench.expect(
        0,
        &[&words[..], &["plain", "--park-grammar", "none"]].concat(),
    );
    let read = |name: &str| std::fs::read_to_string(bench.path(name)).expect("written");
    let parks = |folder: &str| features(&read(&format!("{folder}/parks.geojson")));
    let auto = parks("auto");
    assert!(auto.iter().any(|f| f["properties"]["name"] == "Tree"));
    let layout = features(&read("auto/layout.geojson"));
    let ids: BTreeSet<u64> = of(&layout, "park")
        .iter()
        .filter_map(|f| f["properties"]["id"].as_u64())
        .collect();
    for feature in &auto {
        assert!(ids.contains(&feature["properties"]["park"].as_u64().expect("a tile")));
    }
    let woods = parks("woods");
    assert!(woods
        .iter()
        .all(|f| f["properties"]["grammar"] == "woodland"));
    assert!(parks("plain").is_empty());
    assert!(read("auto/layout.geojson") == read("plain/layout.geojson"));
    assert!(read("auto/layout.svg").contains("park-on-Lawn"));
    assert!(!read("plain/layout.svg").contains("park-on-"));
    let words = [&words[..], &["other", "--park-grammar", "nonsense"]].concat();
    assert!(bench.complaint(1, &words).contains("woodland"));
}
