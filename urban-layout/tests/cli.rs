//! The command as a user meets it: exit statuses, files written whole or not at
//! all, figures as JSON.
#![cfg(feature = "cli")]

mod bench;

use bench::{files, json, names, Bench, BOW_TIE, FIELD, TRIANGLE};
use serde_json::Value;

#[test]
fn a_plan_is_written_and_certified() {
    let bench = Bench::new();
    let said = bench.expect(0, &["generate", "site.geojson", "--out", "plan"]);
    assert!(said.contains("parcels"), "{said}");
    assert_eq!(
        names(&bench.path("plan")),
        [
            "layout.geojson",
            "layout.svg",
            "metrics.json",
            "parks.geojson"
        ]
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
            "001/parks.geojson",
            "002/layout.geojson",
            "002/layout.svg",
            "002/metrics.json",
            "002/parks.geojson",
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
