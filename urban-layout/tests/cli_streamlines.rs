//! `urban-layout streamlines` as a user meets it.
#![cfg(feature = "cli")]

mod bench;

use bench::{json, names, Bench, BOW_TIE, TRIANGLE};
use serde_json::Value;

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
