//! The command as a user meets it: exit statuses, files written whole or not at
//! all, figures as JSON.
#![cfg(feature = "cli")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A field of 3.6 hectares: a plan of it takes a moment.
const FIELD: &str = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "site", "name": "Field"}, "geometry":
{"type": "Polygon", "coordinates": [[[0, 0], [240, 0], [240, 150], [0, 150], [0, 0]]]}}]}"#;

/// A ring that crosses itself.
const BOW_TIE: &str = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "site"}, "geometry":
{"type": "Polygon", "coordinates": [[[0, 0], [240, 150], [240, 0], [0, 150], [0, 0]]]}}]}"#;

/// A folder of one's own with a site in it.
struct Bench {
    folder: TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let bench = Self { folder };
        std::fs::write(bench.path("site.geojson"), FIELD).expect("written");
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs the command in the folder.
    fn run(&self, words: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_urban-layout"))
            .current_dir(self.folder.path())
            .args(words)
            .output()
            .expect("the command starts")
    }

    /// Runs the command, expecting an exit status; gives its standard output.
    #[track_caller]
    fn expect(&self, status: i32, words: &[&str]) -> String {
        let output = self.run(words);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{words:?}: {said}");
        String::from_utf8(output.stdout).expect("UTF-8")
    }

    /// The one line on standard error of a run that ends with this status.
    #[track_caller]
    fn complaint(&self, status: i32, words: &[&str]) -> String {
        let output = self.run(words);
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(status), "{words:?}: {said}");
        assert!(output.stdout.is_empty(), "nothing goes to stdout");
        assert_eq!(said.lines().count(), 1, "one line: {said}");
        said
    }
}

/// Every file below a folder with its bytes, sorted.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut out = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let bytes = std::fs::read(&path).expect("readable");
                out.push((path, bytes));
            }
        }
    }
    out.sort();
    out
}

fn names(folder: &Path) -> Vec<String> {
    let name = |(path, _): &(PathBuf, Vec<u8>)| {
        let below = path.strip_prefix(folder).expect("below the folder");
        below.to_string_lossy().replace('\\', "/")
    };
    files(folder).iter().map(name).collect()
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

#[test]
fn a_plan_is_written_and_certified() {
    let bench = Bench::new();
    let said = bench.expect(0, &["generate", "site.geojson", "--out", "plan"]);
    assert!(said.contains("parcels"), "{said}");
    assert_eq!(
        names(&bench.path("plan")),
        ["layout.geojson", "layout.svg", "metrics.json"]
    );
    let said = bench.expect(0, &["check", "site.geojson", "plan/layout.geojson"]);
    assert!(said.lines().count() > 15 && !said.contains("FAILED"));
}

#[test]
#[cfg(feature = "png")]
fn a_picture_comes_with_png() {
    let bench = Bench::new();
    bench.expect(0, &["generate", "site.geojson", "--out", "plan", "--png"]);
    let bytes = std::fs::read(bench.path("plan/layout.png")).expect("a picture");
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.len() > 10_000);
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let bench = Bench::new();
    for (folder, threads) in [("one", "1"), ("two", "2")] {
        let words = ["generate", "site.geojson", "--seed", "7"];
        bench.expect(
            0,
            &[&words[..], &["--out", folder, "--threads", threads]].concat(),
        );
    }
    for name in ["layout.geojson", "layout.svg"] {
        let bytes = |folder| std::fs::read(bench.path(folder).join(name)).expect("written");
        assert!(bytes("one") == bytes("two"), "{name}");
    }
}

#[test]
fn figures_are_one_json_object() {
    let bench = Bench::new();
    let words = ["generate", "site.geojson", "--out", "plan", "--json"];
    let figures = json(&bench.expect(0, &words));
    assert!(figures["parcels"].as_u64().is_some_and(|n| n > 10));
    assert!(figures["seconds"]["total"]
        .as_f64()
        .is_some_and(|s| s > 0.0));
    let written = std::fs::read_to_string(bench.path("plan/metrics.json")).expect("written");
    assert_eq!(json(&written), figures);

    let words = ["check", "site.geojson", "plan/layout.geojson", "--json"];
    let certificate = json(&bench.expect(0, &words));
    assert_eq!(certificate["ok"], true);
    assert!(certificate["laws"].as_array().is_some_and(|l| l.len() > 15));
}

#[test]
fn variations_have_a_folder_each_and_a_page() {
    let bench = Bench::new();
    let words = ["generate", "site.geojson", "--out", "plans"];
    let figures = bench.expect(0, &[&words[..], &["--variations", "2", "--json"]].concat());
    let list = json(&figures)["variations"].clone();
    let seeds: Vec<_> = list.as_array().expect("a list").iter().collect();
    assert_eq!(seeds.len(), 2);
    assert_eq!(
        (&seeds[0]["seed"], &seeds[1]["seed"]),
        (&0.into(), &1.into())
    );
    assert_eq!(
        names(&bench.path("plans")),
        [
            "001/layout.geojson",
            "001/layout.svg",
            "001/metrics.json",
            "002/layout.geojson",
            "002/layout.svg",
            "002/metrics.json",
            "index.html"
        ]
    );
    let page = std::fs::read_to_string(bench.path("plans/index.html")).expect("a page");
    for picture in ["001/layout.svg", "002/layout.svg"] {
        assert!(page.contains(picture), "{picture}");
    }
}

#[test]
fn wrong_input_is_status_1_and_one_line() {
    let bench = Bench::new();
    let complaint = bench.complaint(1, &["generate", "nowhere.geojson", "--out", "plan"]);
    assert!(complaint.contains("nowhere.geojson"), "{complaint}");

    for (text, word) in [
        (BOW_TIE, "cross"),
        (&FIELD[..150], "JSON"),
        ("", "JSON"),
        ("{}", "GeoJSON"),
        (
            &FIELD.replace(r#""coordinate_units": "metres","#, ""),
            "metres",
        ),
    ] {
        std::fs::write(bench.path("bad.geojson"), text).expect("written");
        let complaint = bench.complaint(1, &["generate", "bad.geojson", "--out", "plan"]);
        assert!(complaint.contains(word), "{word}: {complaint}");
    }
    assert!(!bench.path("plan").exists(), "nothing may be written");

    // A layout that is none, and one that is not there.
    for layout in ["site.geojson.bak", "bad.geojson"] {
        bench.complaint(1, &["check", "site.geojson", layout]);
    }
}

#[test]
fn bytes_that_are_no_text_are_wrong_input() {
    let bench = Bench::new();
    std::fs::write(bench.path("bad.geojson"), [0xff, 0xfe, 0x00, 0x80]).expect("written");
    let complaint = bench.complaint(1, &["generate", "bad.geojson", "--out", "plan"]);
    assert!(complaint.contains("UTF-8"), "{complaint}");
}

#[test]
fn earlier_outputs_survive_a_failed_run() {
    let bench = Bench::new();
    bench.expect(0, &["generate", "site.geojson", "--out", "plan"]);
    let before = files(&bench.path("plan"));

    std::fs::write(bench.path("bad.geojson"), BOW_TIE).expect("written");
    bench.expect(1, &["generate", "bad.geojson", "--out", "plan"]);
    let words = ["generate", "site.geojson", "--out", "plan"];
    bench.expect(2, &[&words[..], &["--parcel-width=-3"]].concat());
    bench.expect(2, &[&words[..], &["--templates", "no-such"]].concat());
    assert!(files(&bench.path("plan")) == before, "changed");
}

/// One file that cannot be replaced keeps all others as they were.
#[test]
fn outputs_are_replaced_all_or_none() {
    let bench = Bench::new();
    std::fs::create_dir_all(bench.path("plan/layout.svg")).expect("a folder in the way");
    std::fs::write(bench.path("plan/metrics.json"), "earlier").expect("written");
    let complaint = bench.complaint(1, &["generate", "site.geojson", "--out", "plan"]);
    assert!(complaint.contains("layout.svg"), "{complaint}");
    assert_eq!(names(&bench.path("plan")), ["metrics.json"]);
    let kept = std::fs::read_to_string(bench.path("plan/metrics.json")).expect("readable");
    assert_eq!(kept, "earlier");
}

#[test]
fn wrong_usage_is_status_2() {
    let bench = Bench::new();
    let generate = ["generate", "site.geojson", "--out", "plan"];
    for more in [
        &["--no-such-option"][..],
        &["--seed", "minus one"],
        &["--field", "magnetic"],
        &["--variations", "0"],
        &["--parcel-width", "0"],
        &["--parcel-length", "nan"],
        &["--street-width", "1e9"],
        &["--temperature=-1"],
        &["--templates", "no-such-template"],
        &["--units", "feet"],
    ] {
        bench.expect(2, &[&generate[..], more].concat());
    }
    bench.expect(2, &[]);
    bench.expect(2, &["demolish", "site.geojson"]);
    bench.expect(2, &["generate", "site.geojson"]);
    bench.expect(2, &["check", "site.geojson"]);
    assert!(!bench.path("plan").exists(), "nothing may be written");
}

/// A site of three straight sides: no H-field follows them.
const TRIANGLE: &str = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "site"}, "geometry":
{"type": "Polygon", "coordinates": [[[0, 0], [420, 20], [150, 330], [0, 0]]]}}]}"#;

/// Its D-field takes the place of the H-field, in every region that is still a
/// triangle.
#[test]
fn a_triangle_without_a_harmonic_field_is_split_all_the_same() {
    let bench = Bench::new();
    std::fs::write(bench.path("triangle.geojson"), TRIANGLE).expect("written");
    let words = [
        "generate",
        "triangle.geojson",
        "--field",
        "harmonic",
        "--out",
        "plan",
    ];
    bench.expect(0, &words);
    bench.expect(0, &["check", "triangle.geojson", "plan/layout.geojson"]);
    let layout =
        json(&std::fs::read_to_string(bench.path("plan/layout.geojson")).expect("readable"));
    let features = layout["features"].as_array().expect("features");
    let streets = features
        .iter()
        .filter(|f| f["properties"]["kind"] == "street")
        .count();
    assert!(streets > 0, "not split at all");
}

/// Each field gives a layout that passes its own check, and two runs agree.
#[test]
fn harmonic_fields_make_layouts() {
    let bench = Bench::new();
    for plan in ["one", "two"] {
        let words = [
            "generate",
            "site.geojson",
            "--field",
            "harmonic",
            "--out",
            plan,
        ];
        bench.expect(0, &words);
    }
    bench.expect(0, &["check", "site.geojson", "one/layout.geojson"]);
    let read = |path| std::fs::read_to_string(bench.path(path)).expect("readable");
    assert_eq!(read("one/layout.geojson"), read("two/layout.geojson"));
}

#[test]
fn a_layout_that_breaks_a_law_is_status_3() {
    let bench = Bench::new();
    bench.expect(0, &["generate", "site.geojson", "--out", "plan"]);
    let text = std::fs::read_to_string(bench.path("plan/layout.geojson")).expect("readable");
    let mut layout = json(&text);
    let features = layout["features"].as_array_mut().expect("features");
    let parcel = features
        .iter()
        .position(|f| f["properties"]["kind"] == "parcel")
        .expect("a parcel");
    features.remove(parcel);
    std::fs::write(bench.path("holed.geojson"), layout.to_string()).expect("written");

    let said = bench.expect(3, &["check", "site.geojson", "holed.geojson"]);
    assert!(said.lines().any(|l| l.starts_with("FAILED gap")), "{said}");
    let words = ["check", "site.geojson", "holed.geojson", "--json"];
    let certificate = json(&bench.expect(3, &words));
    assert_eq!(certificate["ok"], false);
}

#[test]
fn a_field_is_drawn_and_measured() {
    let bench = Bench::new();
    for kind in ["distance", "boundary"] {
        let words = ["field", "site.geojson", "--out", kind, "--field", kind];
        let more = [
            "--edge-length",
            "8",
            "--omega",
            "50",
            "--smoothing",
            "2",
            "--seed",
            "3",
            "--json",
        ];
        let figures = json(&bench.expect(0, &[&words[..], &more].concat()));
        assert_eq!(names(&bench.path(kind)), ["field.json", "field.svg"]);
        let written =
            std::fs::read_to_string(bench.path(kind).join("field.json")).expect("written");
        assert_eq!(json(&written), figures);
        for key in ["vertices", "triangles"] {
            assert!(figures[key].as_u64().is_some_and(|n| n > 500), "{key}");
        }
        for key in ["mesh", "field"] {
            assert!(
                figures["seconds"][key].as_f64().is_some_and(|s| s > 0.0),
                "{key}"
            );
        }
        // A rectangle: a constant field.
        for key in ["energy", "mean_abs_divergence"] {
            assert!(
                figures[key].as_f64().is_some_and(|v| v.abs() < 1e-9),
                "{key}"
            );
        }
        assert_eq!(figures["singularities"], Value::Array(vec![]));
        assert_eq!(figures["index_sum"], 0);
        assert_eq!(figures["boundary_quarter_turns"], 4);
        assert_eq!(figures["euler"], 1);
        let svg = std::fs::read_to_string(bench.path(kind).join("field.svg")).expect("drawn");
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
        assert!(svg.len() < 200_000 && svg.matches("<path").count() >= 2);
    }
    let said = bench.expect(0, &["field", "site.geojson", "--out", "plain"]);
    assert!(
        said.contains("0 singularities, indices 0 + 4 at corners = 4 x 1; "),
        "{said}"
    );
}

/// Singularities are in the coordinates of the file.
#[test]
fn singularities_of_a_field_are_where_the_file_has_them() {
    let bench = Bench::new();
    let triangle = FIELD.replace(
        "[[[0, 0], [240, 0], [240, 150], [0, 150], [0, 0]]]",
        "[[[5000, 7000], [5240, 7000], [5120, 7207.8], [5000, 7000]]]",
    );
    std::fs::write(bench.path("triangle.geojson"), triangle).expect("written");
    let words = [
        "field",
        "triangle.geojson",
        "--out",
        "t",
        "--field",
        "boundary",
        "--json",
    ];
    let figures = json(&bench.expect(0, &words));
    let found = figures["singularities"].as_array().expect("a list");
    assert_eq!(found.len(), 1);
    assert_eq!(found[0]["quarter_index"], 1);
    let near = |key: &str, wanted: f64| {
        found[0][key]
            .as_f64()
            .is_some_and(|value| (value - wanted).abs() < 10.0)
    };
    assert!(
        near("x", 5120.0) && near("y", 7000.0 + 207.8 / 3.0),
        "{figures}"
    );
}

#[test]
fn wrong_fields_are_refused() {
    let bench = Bench::new();
    let field = ["field", "site.geojson", "--out", "field"];
    for more in [
        &["--field", "magnetic"][..],
        &["--edge-length=-1"],
        &["--edge-length", "nan"],
        &["--edge-length", "0.001"],
        &["--field", "boundary", "--omega", "0"],
        &["--smoothing", "some"],
    ] {
        bench.expect(2, &[&field[..], more].concat());
    }
    bench.expect(2, &["field", "site.geojson"]);
    std::fs::write(bench.path("bad.geojson"), BOW_TIE).expect("written");
    bench.complaint(1, &["field", "bad.geojson", "--out", "field"]);
    bench.complaint(1, &["field", "nowhere.geojson", "--out", "field"]);
    assert!(!bench.path("field").exists(), "nothing may be written");
}

/// A square with a square hole, and a rectangle beside it.
const TWO_PARTS: &str = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "site"}, "geometry":
{"type": "MultiPolygon", "coordinates": [
[[[0, 0], [300, 0], [300, 300], [0, 300], [0, 0]], [[100, 100], [100, 200], [200, 200], [200, 100], [100, 100]]],
[[[400, 0], [600, 0], [600, 100], [400, 100], [400, 0]]]]}}]}"#;

/// The six, and what each file promises.
#[test]
fn streamlines_are_drawn_and_judged() {
    let bench = Bench::new();
    for kind in ["distance", "boundary"] {
        let words = [
            "streamlines",
            "site.geojson",
            "--out",
            kind,
            "--field",
            kind,
        ];
        let more = [
            "--separation",
            "30",
            "--test",
            "20",
            "--seed",
            "3",
            "--json",
        ];
        let figures = json(&bench.expect(0, &[&words[..], &more].concat()));
        assert_eq!(
            names(&bench.path(kind)),
            ["criteria.json", "streamlines.geojson", "streamlines.svg"]
        );
        let read = |name: &str| std::fs::read_to_string(bench.path(kind).join(name)).expect(name);
        assert_eq!(json(&read("criteria.json")), figures);
        // A rectangle of 240 x 150: lines 30 m apart along its sides, all six
        // at their best. Coordinates are rounded to nanometres.
        for key in [
            "divergence",
            "continuity",
            "parallelism",
            "perpendicularity",
            "convexity",
        ] {
            assert!(
                figures[key]
                    .as_f64()
                    .is_some_and(|v| (0.0..1e-9).contains(&v)),
                "{key}"
            );
        }
        assert_eq!(figures["singularities"], 0);
        let area = figures["area_m2"].as_f64().expect("a number");
        assert!((area - 36_000.0).abs() < 1e-3);
        assert_eq!(figures["seed"], 3);

        let lines = json(&read("streamlines.geojson"));
        assert_eq!(lines["coordinate_units"], "metres");
        let features = lines["features"].as_array().expect("features");
        assert_eq!(figures["lines"], features.len());
        let of = |family: u64| {
            let is = |f: &&Value| f["properties"]["family"] == family;
            features.iter().filter(is).count()
        };
        assert!((4..=5).contains(&of(0).min(of(1))) && (7..=8).contains(&of(0).max(of(1))));
        for feature in features {
            assert_eq!(feature["geometry"]["type"], "LineString");
            let ends = &feature["properties"];
            assert_eq!(
                (&ends["end_start"], &ends["end_stop"]),
                (&"boundary".into(), &"boundary".into())
            );
            let points = feature["geometry"]["coordinates"]
                .as_array()
                .expect("points");
            for end in [&points[0], &points[points.len() - 1]] {
                let (x, y) = (end[0].as_f64().expect("x"), end[1].as_f64().expect("y"));
                let inside = x.min(240.0 - x).min(y).min(150.0 - y);
                assert!(inside.abs() < 1e-6, "({x}, {y}) is not on the boundary");
            }
        }
        let svg = read("streamlines.svg");
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
        assert!(svg.len() < 100_000 && svg.matches("<path").count() >= 3);
    }
    let said = bench.expect(0, &["streamlines", "site.geojson", "--out", "plain"]);
    assert!(
        said.contains("tiles; mesh") && said.contains("off parallel deg"),
        "{said}"
    );
}

#[test]
fn streamlines_are_the_same_every_time() {
    let bench = Bench::new();
    std::fs::write(bench.path("two.geojson"), TWO_PARTS).expect("written");
    for out in ["one", "two"] {
        let words = [
            "streamlines",
            "two.geojson",
            "--separation",
            "25",
            "--out",
            out,
        ];
        bench.expect(0, &words);
    }
    for name in ["streamlines.geojson", "streamlines.svg"] {
        let bytes = |folder| std::fs::read(bench.path(folder).join(name)).expect("written");
        assert!(bytes("one") == bytes("two"), "{name}");
    }
}

#[test]
fn streamlines_of_parts_with_holes() {
    let bench = Bench::new();
    std::fs::write(bench.path("two.geojson"), TWO_PARTS).expect("written");
    for ends in ["open", "junction"] {
        let words = [
            "streamlines",
            "two.geojson",
            "--field",
            "boundary",
            "--separation",
            "25",
        ];
        let more = ["--ends", ends, "--out", ends, "--json"];
        let figures = json(&bench.expect(0, &[&words[..], &more].concat()));
        let area = figures["area_m2"].as_f64().expect("a number");
        assert!((area - 100_000.0).abs() < 1e-2, "the hole is no land");
        // Right angles alone: a constant field.
        assert_eq!(figures["singularities"], 0);
        let path = bench.path(ends).join("streamlines.geojson");
        let lines = json(&std::fs::read_to_string(path).expect("written"));
        let features = lines["features"].as_array().expect("features");
        for part in [0, 1] {
            assert!(features.iter().any(|f| f["properties"]["part"] == part));
        }
        for feature in features {
            let points = feature["geometry"]["coordinates"]
                .as_array()
                .expect("points");
            for p in points {
                let (x, y) = (p[0].as_f64().expect("x"), p[1].as_f64().expect("y"));
                let in_hole = (100.001..199.999).contains(&x) && (100.001..199.999).contains(&y);
                assert!(!in_hole && !(300.001..399.999).contains(&x), "({x}, {y})");
            }
            let known = ["boundary", "neighbour", "junction"];
            for key in ["end_start", "end_stop"] {
                let word = feature["properties"][key].as_str().expect("a word");
                assert!(known.contains(&word), "{word}");
            }
        }
    }
}

/// Degrees in, degrees out; one picture for each criterion.
#[test]
#[cfg(feature = "png")]
fn streamlines_in_degrees_and_in_colours() {
    let bench = Bench::new();
    // A pentagon of some 500 m: one singularity at least.
    let site = r#"{"type": "Polygon", "coordinates": [[[26.9, 60.4], [26.909, 60.4], [26.912, 60.404], [26.9045, 60.4065], [26.897, 60.404], [26.9, 60.4]]]}"#;
    std::fs::write(bench.path("pentagon.geojson"), site).expect("written");
    let mut pictures = Vec::new();
    for paint in [
        "families",
        "divergence",
        "continuity",
        "parallelism",
        "perpendicularity",
        "convexity",
        "singularities",
    ] {
        let words = ["streamlines", "pentagon.geojson", "--paint", paint, "--png"];
        let more = [
            "--turn-region",
            "30",
            "--turn-angle",
            "10",
            "--out",
            paint,
            "--json",
        ];
        let figures = json(&bench.expect(0, &[&words[..], &more].concat()));
        assert!(figures["singularities"].as_u64().is_some_and(|n| n >= 1));
        assert_eq!(figures["turns"]["region_m"], 30.0);
        let read = |name: &str| std::fs::read(bench.path(paint).join(name)).expect(name);
        assert!(read("streamlines.png").starts_with(b"\x89PNG\r\n\x1a\n"));
        let lines = json(&String::from_utf8(read("streamlines.geojson")).expect("UTF-8"));
        assert_eq!(lines.get("coordinate_units"), None);
        let first = &lines["features"][0]["geometry"]["coordinates"][0];
        assert!(first[0]
            .as_f64()
            .is_some_and(|x| (26.896..26.913).contains(&x)));
        assert!(first[1]
            .as_f64()
            .is_some_and(|y| (60.399..60.407).contains(&y)));
        pictures.push(read("streamlines.svg"));
    }
    for (i, picture) in pictures.iter().enumerate() {
        assert!(!pictures[..i].contains(picture), "colours say nothing");
    }
}

#[test]
fn wrong_streamlines_are_refused() {
    let bench = Bench::new();
    let words = ["streamlines", "site.geojson", "--out", "lines"];
    for more in [
        &["--separation", "0"][..],
        &["--separation=-20"],
        &["--separation", "nan"],
        &["--separation", "0.01"],
        &["--separation", "40", "--test", "41"],
        &["--separation", "40", "--test", "3"],
        &["--field", "magnetic"],
        &["--ends", "loose"],
        &["--paint", "beauty"],
        &["--turn-region", "0"],
        &["--turn-angle", "180"],
        &["--edge-length=-1"],
        &["--field", "boundary", "--omega", "0"],
    ] {
        bench.expect(2, &[&words[..], more].concat());
    }
    bench.expect(2, &["streamlines", "site.geojson"]);
    std::fs::write(bench.path("bad.geojson"), BOW_TIE).expect("written");
    bench.complaint(1, &["streamlines", "bad.geojson", "--out", "lines"]);
    bench.complaint(1, &["streamlines", "nowhere.geojson", "--out", "lines"]);
    // A triangle has no H-field.
    std::fs::write(bench.path("triangle.geojson"), TRIANGLE).expect("written");
    let words = [
        "streamlines",
        "triangle.geojson",
        "--field",
        "harmonic",
        "--out",
        "lines",
    ];
    bench.complaint(1, &words);
    assert!(!bench.path("lines").exists(), "nothing may be written");
    // A folder in the way of one file keeps the others as they were.
    std::fs::create_dir_all(bench.path("lines/criteria.json")).expect("a folder in the way");
    std::fs::write(bench.path("lines/streamlines.svg"), "earlier").expect("written");
    bench.complaint(1, &["streamlines", "site.geojson", "--out", "lines"]);
    assert_eq!(names(&bench.path("lines")), ["streamlines.svg"]);
    let kept = std::fs::read_to_string(bench.path("lines/streamlines.svg")).expect("readable");
    assert_eq!(kept, "earlier");
}

#[test]
fn help_and_version_are_no_errors() {
    let bench = Bench::new();
    for words in [
        &["--help"][..],
        &["generate", "--help"],
        &["check", "--help"],
        &["field", "--help"],
        &["streamlines", "--help"],
    ] {
        assert!(bench.expect(0, words).contains("Usage"), "{words:?}");
    }
    assert!(bench
        .expect(0, &["--version"])
        .contains(env!("CARGO_PKG_VERSION")));
}
