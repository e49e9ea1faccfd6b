//! `urban-layout floorplan` as a user meets it.
#![cfg(feature = "cli")]

mod bench;

use bench::{json, names, Bench, BOW_TIE};
use geo_types::{Coord, LineString, Polygon};
use serde_json::Value;

/// An L of 30 by 24 metres with 12 by 10 cut out.
const BUILDING: &str = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "building", "name": "Annex"}, "geometry":
{"type": "Polygon", "coordinates": [[[0, 0], [30, 0], [30, 14], [18, 14], [18, 24], [0, 24], [0, 0]]]}}]}"#;

const SPEC: &str = r###"
cell = 3.0
corridor-width = 1.5
[[shaft]]
at = [10.5, 7.5]
shape = "#"
[[room]]
name = "office"
shapes = ["##/##", "##/#."]
window = { weighted = 1.0 }
least = 3
[[room]]
name = "store"
shapes = ["#", "##"]
cost = 1.0
[[storey]]
name = "Ground floor"
entrances = [[15.0, 0.0]]
[[storey]]
name = "First floor"
[[storey.obstacles]]
name = "terrace"
polygon = [[0, 18], [18, 18], [18, 24], [0, 24]]
open = true
"###;

fn points(list: &Value) -> Vec<Coord<f64>> {
    let number = |v: &Value| v.as_f64().expect("a number");
    let all = list.as_array().expect("points").iter();
    all.map(|p| Coord {
        x: number(&p[0]),
        y: number(&p[1]),
    })
    .collect()
}

fn polygon(feature: &Value) -> Polygon<f64> {
    let rings = feature["geometry"]["coordinates"]
        .as_array()
        .expect("rings");
    let mut rings = rings.iter().map(|r| LineString(points(r)));
    let exterior = rings.next().expect("a ring");
    Polygon::new(exterior, rings.collect())
}

/// Square metres of a ring, counter-clockwise.
fn signed(ring: &LineString<f64>) -> f64 {
    let pairs = ring.0.windows(2);
    0.5 * pairs
        .map(|w| w[0].x * w[1].y - w[1].x * w[0].y)
        .sum::<f64>()
}

fn area(polygon: &Polygon<f64>) -> f64 {
    let holes: f64 = polygon.interiors().iter().map(|r| signed(r).abs()).sum();
    signed(polygon.exterior()).abs() - holes
}

fn contains(polygon: &Polygon<f64>, p: Coord<f64>) -> bool {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    let crosses = |w: &[Coord<f64>]| {
        (w[0].y > p.y) != (w[1].y > p.y)
            && p.x < w[0].x + (p.y - w[0].y) / (w[1].y - w[0].y) * (w[1].x - w[0].x)
    };
    rings
        .flat_map(|r| r.0.windows(2))
        .filter(|w| crosses(w))
        .count()
        % 2
        == 1
}

fn away(polygon: &Polygon<f64>, p: Coord<f64>) -> f64 {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    let to = |w: &[Coord<f64>]| {
        let (a, d) = (w[0], w[1] - w[0]);
        let t = ((p.x - a.x) * d.x + (p.y - a.y) * d.y) / (d.x * d.x + d.y * d.y);
        let near = a + d * t.clamp(0.0, 1.0);
        (near.x - p.x).hypot(near.y - p.y)
    };
    rings
        .flat_map(|r| r.0.windows(2))
        .map(to)
        .fold(f64::INFINITY, f64::min)
}

/// What each file promises: rooms, corridors, shafts and obstacles tile each
/// storey, and every room has a door between it and a corridor.
#[test]
fn storeys_are_planned_and_drawn() {
    let bench = Bench::new();
    std::fs::write(bench.path("annex.geojson"), BUILDING).expect("written");
    std::fs::write(bench.path("spec.toml"), SPEC).expect("written");
    let words = [
        "floorplan",
        "annex.geojson",
        "--spec",
        "spec.toml",
        "--deadline",
        "2",
        "--out",
        "plan",
        "--json",
    ];
    let figures = json(&bench.expect(0, &words));
    assert_eq!(
        names(&bench.path("plan")),
        ["floorplan.geojson", "floorplan.json", "floorplan.svg"]
    );
    let read = |name: &str| std::fs::read_to_string(bench.path("plan").join(name)).expect(name);
    assert_eq!(json(&read("floorplan.json")), figures);
    assert_eq!(figures["valid"], true);
    let number = |key: &str| figures[key].as_f64().expect(key);
    assert!(number("bound") <= number("objective") && (0.0..=1.0).contains(&number("gap")));
    assert!(number("length_m") > 0.0 && number("travel_m") >= 0.0);
    assert!(number("first_feasible_seconds") <= number("seconds"));
    assert_eq!(figures["storeys"][1]["name"], "First floor");

    let plan = json(&read("floorplan.geojson"));
    assert_eq!(plan["coordinate_units"], "metres");
    let features = plan["features"].as_array().expect("features");
    for (k, feature) in features.iter().enumerate() {
        assert_eq!(feature["properties"]["id"], k);
    }
    // 30 by 24 without 12 by 10.
    let floor = 30.0 * 24.0 - 12.0 * 10.0;
    for storey in 0..2 {
        let of = |kind: &'static str| {
            features.iter().filter(move |f| {
                f["properties"]["storey"] == storey && f["properties"]["kind"] == kind
            })
        };
        let tiles: Vec<Polygon<f64>> = ["room", "corridor", "shaft", "obstacle"]
            .into_iter()
            .flat_map(of)
            .map(polygon)
            .collect();
        // Corners are written to a millionth of a metre.
        let sum: f64 = tiles.iter().map(area).sum();
        assert!((sum - floor).abs() < 0.01, "{sum} of {floor}");
        // As much as the floor, and no place twice, so no gap either.
        for k in 0..400 {
            let p = Coord {
                x: 0.733 + 1.497 * f64::from(k % 20),
                y: 0.611 + 1.193 * f64::from(k / 20),
            };
            let inside = p.x < 18.0 || p.y < 14.0;
            let on = tiles.iter().filter(|t| contains(t, p)).count();
            let clear = tiles.iter().all(|t| away(t, p) > 1e-3);
            assert!(!clear || on == usize::from(inside), "{on} tiles at {p:?}");
        }
        assert_eq!(of("shaft").count(), 1);
        assert_eq!(of("obstacle").count(), storey);
        assert_eq!(of("entrance").count(), 1 - storey);
        assert!(
            of("room")
                .filter(|f| f["properties"]["name"] == "office")
                .count()
                >= 3
        );
        let corridors: Vec<Polygon<f64>> = of("corridor").map(polygon).collect();
        for room in of("room").chain(of("shaft")) {
            let id = &room["properties"]["id"];
            let door = of("door").find(|d| &d["properties"]["of"] == id);
            let door = door.unwrap_or_else(|| panic!("room {id} has no door"));
            let at = points(&Value::Array(vec![door["geometry"]["coordinates"].clone()]))[0];
            assert!(away(&polygon(room), at) < 0.05, "door {at:?} of {id}");
            let near = corridors.iter().map(|c| away(c, at));
            assert!(
                near.fold(f64::INFINITY, f64::min) < 0.05,
                "door {at:?} of {id}"
            );
        }
    }
    let svg = read("floorplan.svg");
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
}

/// Without a specification there are offices; the outline may be tilted, in
/// degrees, or with a court.
#[test]
fn any_building_has_a_plan() {
    let bench = Bench::new();
    let court = r#"{"type": "Polygon", "coordinates":
        [[[24.94, 60.17], [24.9406, 60.1701], [24.9405, 60.1704], [24.9399, 60.1703], [24.94, 60.17]],
         [[24.94015, 60.17012], [24.94038, 60.17016], [24.94033, 60.1703], [24.94012, 60.17025], [24.94015, 60.17012]]]}"#;
    std::fs::write(bench.path("court.geojson"), court).expect("written");
    let words = [
        "floorplan",
        "court.geojson",
        "--deadline",
        "1",
        "--out",
        "plan",
        "--json",
    ];
    let figures = json(&bench.expect(0, &words));
    assert_eq!(figures["valid"], true);
    assert!(
        figures["storeys"][0]["floor_m2"]
            .as_f64()
            .expect("a number")
            > 500.0
    );
}

#[test]
fn what_is_wrong_is_said() {
    let bench = Bench::new();
    std::fs::write(bench.path("annex.geojson"), BUILDING).expect("written");
    let said = |spec: &str, status: i32| {
        std::fs::write(bench.path("bad.toml"), spec).expect("written");
        let words = [
            "floorplan",
            "annex.geojson",
            "--spec",
            "bad.toml",
            "--deadline",
            "0.3",
            "--out",
            "plan",
        ];
        bench.complaint(status, &words)
    };
    for (spec, word) in [
        ("storey = []", "no storey"),
        ("cell = -1.0", "cell"),
        ("door-width = 0.0", "doors"),
        ("[[room]]\nnmae = 3", "nmae"),
        (
            "[[room]]\nname = \"x\"\nshapes = [\"#.#\"]",
            "hang together",
        ),
        (
            "[[room]]\nname = \"x\"\nbeside = [{ room = \"y\", wish = \"required\" }]",
            "\"y\"",
        ),
        (
            "cell = 3.0\n[[room]]\nname = \"x\"\nshapes = [\"##########\"]",
            "no room fits",
        ),
    ] {
        let said = said(spec, 1);
        assert!(said.contains(word), "{said}");
    }
    // At most two rooms of at most four squares on all of the floor.
    let said = said(
        "cell = 3.0\n[[room]]\nname = \"x\"\nshapes = [\"##/##\", \"#\"]\nmost = 2",
        3,
    );
    assert!(said.contains("how many rooms"), "{said}");
    let words = [
        "floorplan",
        "annex.geojson",
        "--deadline",
        "0",
        "--out",
        "plan",
    ];
    assert!(bench.complaint(2, &words).contains("deadline"));
    std::fs::write(bench.path("tie.geojson"), BOW_TIE).expect("written");
    bench.expect(1, &["floorplan", "tie.geojson", "--out", "plan"]);
    assert!(!bench.path("plan").exists());
}
