//! Every kind of bad input that cannot be mended: a clear error that names its
//! place, never a panic. What can be mended is in `mended_input.rs`.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod input;

use input::{
    accept, collection, line, pierced, polygon, refuse, refused, site, with, SITE, SQUARE,
};
use urban_layout::site::{Site, Units};

#[test]
fn an_empty_file() {
    refuse("", "empty-file", (None, None, None), &["GeoJSON"]);
    refuse("\u{feff} \n", "empty-file", (None, None, None), &[]);
}

#[test]
fn json_cut_short() {
    let whole = site(SQUARE);
    for keep in [1, 20, whole.len() / 2, whole.len() - 1] {
        refuse(
            &whole[..keep],
            "truncated-json",
            (None, None, None),
            &["line 1", "cut short"],
        );
    }
}

#[test]
fn no_json_at_all() {
    refuse(
        "<kml></kml>",
        "not-json",
        (None, None, None),
        &["line 1, column 1"],
    );
    refuse("{\"type\": oops}", "not-json", (None, None, None), &[]);
    let deep = "[".repeat(100_000);
    assert!(refused(&deep).is_input());
}

#[test]
fn json_that_is_no_geojson() {
    for text in ["[1, 2]", "7", "null", "{}", r#"{"type": "Topology"}"#] {
        refuse(text, "not-geojson", (None, None, None), &["Feature"]);
    }
    refuse(
        r#"{"type": "FeatureCollection"}"#,
        "not-geojson",
        (None, None, None),
        &[],
    );
    let text = r#"{"type": "FeatureCollection", "features": {}}"#;
    refuse(text, "not-geojson", (None, None, None), &["no array"]);
    let text = r#"{"type": "FeatureCollection", "features": [{"type": "Feature"}, 5]}"#;
    refuse(text, "not-geojson", (None, None, None), &["entry 1"]);
}

#[test]
fn an_empty_collection() {
    let text = r#"{"type": "FeatureCollection", "features": []}"#;
    refuse(text, "empty-collection", (None, None, None), &["site"]);
}

#[test]
fn a_collection_without_a_site() {
    let road = line("[0, 0], [9, 9]");
    let text = collection(&[(r#"{"kind": "road"}"#, &road)]);
    refuse(
        &text,
        "no-site",
        (None, None, None),
        &["the kinds are: road"],
    );
    let text = collection(&[("null", &polygon(SQUARE)), ("null", &polygon(SQUARE))]);
    refuse(
        &text,
        "no-site",
        (None, None, None),
        &["2 polygons have no kind"],
    );
    let text = format!(
        r#"{{"type": "Feature", "properties": {{"kind": "lake"}}, "geometry": {}}}"#,
        polygon(SQUARE)
    );
    refuse(&text, "no-site", (None, None, None), &["lake"]);
    let empty = r#"{"type": "MultiPolygon", "coordinates": []}"#;
    refuse(
        &collection(&[(SITE, empty)]),
        "no-site",
        (None, None, None),
        &[],
    );
}

#[test]
fn a_site_without_a_geometry() {
    refuse(
        &collection(&[(SITE, "null")]),
        "no-geometry",
        (Some(0), None, None),
        &["Polygon"],
    );
}

#[test]
fn a_geometry_of_the_wrong_type() {
    let point = r#"{"type": "Point", "coordinates": [1, 2]}"#;
    let place = (Some(0), None, None);
    refuse(
        &collection(&[(SITE, point)]),
        "wrong-geometry",
        place,
        &["Point", "Polygon"],
    );
    let place = (Some(1), None, None);
    let road = r#"{"kind": "road"}"#;
    refuse(
        &with(road, &polygon(SQUARE)),
        "wrong-geometry",
        place,
        &["LineString"],
    );
    let lake = r#"{"kind": "lake"}"#;
    refuse(
        &with(lake, &line("[0, 0], [1, 1]")),
        "wrong-geometry",
        place,
        &["(lake)"],
    );
    refuse(&with(lake, r#"{"type": 7}"#), "wrong-geometry", place, &[]);
}

#[test]
fn nan_infinity_and_overflow() {
    for wild in [
        "NaN",
        "Infinity",
        "-Infinity",
        "1e999",
        "-1e400",
        "null",
        "nan",
    ] {
        let text = site(&format!(
            "[[0, 0], [400, 0], [400, {wild}], [0, 300], [0, 0]]"
        ));
        refuse(
            &text,
            "not-finite",
            (Some(0), Some(0), Some(2)),
            &["y is no finite number"],
        );
    }
    let text = with(r#"{"kind": "road"}"#, &line("[0, 0], [NaN, 5]"));
    refuse(&text, "not-finite", (Some(1), None, Some(1)), &["x is"]);
    // In a property that nobody reads it does no harm.
    let text = collection(&[(r#"{"kind": "site", "height": NaN}"#, &polygon(SQUARE))]);
    accept(&text, 120_000.0, &[]);
}

#[test]
fn positions_that_are_none() {
    for bad in [
        "[400]",
        "[]",
        "400",
        "\"x\"",
        "{}",
        "[\"a\", 1]",
        "[true, 1]",
    ] {
        let text = site(&format!("[[0, 0], [400, 0], {bad}, [0, 300], [0, 0]]"));
        refuse(&text, "bad-position", (Some(0), Some(0), Some(2)), &[]);
    }
    refuse(
        &site("7"),
        "bad-position",
        (Some(0), Some(0), None),
        &["positions"],
    );
    let text = collection(&[(SITE, r#"{"type": "Polygon"}"#)]);
    refuse(
        &text,
        "bad-position",
        (Some(0), None, None),
        &["coordinates"],
    );
    let text = collection(&[(SITE, r#"{"type": "Polygon", "coordinates": 5}"#)]);
    refuse(&text, "bad-position", (Some(0), None, None), &["rings"]);
}

#[test]
fn numbers_beyond_any_map() {
    let text = site("[[0, 0], [4e200, 0], [400, 300], [0, 300], [0, 0]]");
    refuse(
        &text,
        "too-far",
        (Some(0), Some(0), Some(1)),
        &["x = 4e200"],
    );
}

#[test]
fn metres_that_are_not_said_to_be() {
    let utm = "[[497000, 6702000], [497400, 6702000], [497400, 6702300], [497000, 6702000]]";
    let text = format!(
        r#"{{"type": "Feature", "properties": {{}}, "geometry": {}}}"#,
        polygon(utm)
    );
    let place = (Some(0), Some(0), Some(0));
    refuse(
        &text,
        "not-degrees",
        place,
        &["x = 497000", "coordinate_units", "metres"],
    );
    assert!(Site::from_geojson(&text, Units::Metres).is_ok());
    let said = text.replacen('{', r#"{"coordinate_units": "metres", "#, 1);
    assert!(Site::from_geojson(&said, Units::Auto).is_ok());
    assert_eq!(
        Site::from_geojson(&said, Units::Degrees)
            .unwrap_err()
            .code(),
        "not-degrees"
    );
    let tall = polygon("[[10, 20], [11, 20], [11, 95], [10, 20]]");
    refuse(
        &tall,
        "not-degrees",
        (Some(0), Some(0), Some(2)),
        &["y = 95", "latitude"],
    );
    // Few metres look like many degrees.
    refuse(
        &polygon("[[0, 0], [100, 0], [100, 80], [0, 80], [0, 0]]"),
        "too-large",
        (None, None, None),
        &["km2", "coordinate_units"],
    );
}

#[test]
fn units_and_reference_systems_that_are_not_known() {
    let text = site(SQUARE).replace("\"metres\"", "\"feet\"");
    refuse(
        &text,
        "bad-units",
        (None, None, None),
        &["\"feet\"", "\"metres\""],
    );
    let crs = r#"{"type": "FeatureCollection", "crs": {"type": "name",
        "properties": {"name": "urn:ogc:def:crs:EPSG::3067"}}, "#;
    let text = site(SQUARE).replacen(r#"{"type": "FeatureCollection", "#, crs, 1);
    accept(&text, 120_000.0, &[]);
    let text = text.replace(r#""coordinate_units": "metres", "#, "");
    refuse(&text, "foreign-crs", (None, None, None), &["EPSG::3067"]);
}

#[test]
fn places_where_longitude_and_latitude_fail() {
    let place = (Some(0), None, None);
    let across = polygon("[[179.99, 1], [-179.99, 1], [-179.99, 1.01], [179.99, 1]]");
    refuse(&across, "antimeridian", place, &["179.99"]);
    let polar = polygon("[[10, 89.5], [10.01, 89.5], [10.01, 89.501], [10, 89.5]]");
    refuse(&polar, "near-pole", (None, None, None), &["89.5"]);
}

#[test]
fn a_site_over_a_thousand_square_kilometres() {
    let text = site("[[0, 0], [40000, 0], [40000, 30000], [0, 30000], [0, 0]]");
    refuse(
        &text,
        "too-large",
        (None, None, None),
        &["1200 km2", "at most 1000"],
    );
    let degrees = polygon("[[25, 60], [26, 60], [26, 60.5], [25, 60.5], [25, 60]]");
    refuse(&degrees, "too-large", (None, None, None), &["km2"]);
}

#[test]
fn too_few_vertices() {
    let place = (Some(0), Some(0), None);
    refuse(
        &site("[[0, 0], [400, 0], [0, 0]]"),
        "too-few-vertices",
        place,
        &["3 positions"],
    );
    refuse(&site("[]"), "too-few-vertices", place, &["0 positions"]);
    refuse(&site(""), "no-rings", (Some(0), None, None), &[]);
    let text = with(r#"{"kind": "road"}"#, &line("[0, 0]"));
    refuse(
        &text,
        "too-short-line",
        (Some(1), None, None),
        &["1 position"],
    );
}

#[test]
fn a_ring_that_crosses_itself() {
    let text = site("[[0, 0], [400, 0], [400, 300], [200, -100], [0, 300], [0, 0]]");
    refuse(
        &text,
        "self-crossing-ring",
        (Some(0), Some(0), Some(0)),
        &["vertices 0 and 2"],
    );
    // The numbers are those of the file, whatever was cleaned before.
    let text =
        site("[[0, 0], [0, 0], [400, 0], [400, 0], [400, 300], [200, -100], [0, 300], [0, 0]]");
    refuse(
        &text,
        "self-crossing-ring",
        (Some(0), Some(0), Some(0)),
        &["vertices 0 and 4"],
    );
}

#[test]
fn a_bow_tie() {
    let text = site("[[0, 0], [400, 300], [400, 0], [0, 300], [0, 0]]");
    refuse(
        &text,
        "self-crossing-ring",
        (Some(0), Some(0), Some(0)),
        &["(200, 150)"],
    );
    // Tied in a knot that is a vertex.
    let text = site("[[0, 0], [200, 150], [400, 300], [400, 0], [200, 150], [0, 300], [0, 0]]");
    assert!(["self-crossing-ring", "self-overlapping-ring"].contains(&refused(&text).code()));
}

#[test]
fn a_ring_run_twice() {
    let text = site("[[0, 0], [400, 0], [400, 300], [0, 0], [400, 0], [400, 300], [0, 0]]");
    assert_eq!(refused(&text).code(), "self-overlapping-ring");
}

#[test]
fn a_ring_without_area() {
    let place = (Some(0), Some(0), None);
    refuse(
        &site("[[0, 0], [400, 0], [900, 0], [0, 0]]"),
        "zero-area",
        place,
        &["one line"],
    );
    refuse(
        &site("[[5, 5], [5, 5], [5, 5], [5, 5]]"),
        "zero-area",
        place,
        &[],
    );
    let text = site("[[0, 0], [300, 200], [600, 400], [150, 100], [0, 0]]");
    refuse(&text, "zero-area", place, &[]);
}

#[test]
fn a_hole_outside() {
    let text = pierced("[[500, 10], [600, 10], [600, 90], [500, 90], [500, 10]]");
    refuse(
        &text,
        "hole-outside",
        (Some(0), Some(1), Some(0)),
        &["(500, 10)"],
    );
}

#[test]
fn a_hole_across_the_boundary() {
    let text = pierced("[[350, 10], [450, 10], [450, 90], [350, 90], [350, 10]]");
    refuse(
        &text,
        "hole-crosses-boundary",
        (Some(0), Some(1), Some(0)),
        &["(400, 10)"],
    );
}

#[test]
fn overlapping_holes() {
    let a = "[[50, 50], [150, 50], [150, 150], [50, 150], [50, 50]]";
    let b = "[[100, 100], [200, 100], [200, 200], [100, 200], [100, 100]]";
    let text = pierced(&format!("{a}, {b}"));
    refuse(
        &text,
        "overlapping-holes",
        (Some(0), Some(2), Some(0)),
        &["the hole in ring 1"],
    );
    let inner = "[[80, 80], [90, 80], [90, 90], [80, 90], [80, 80]]";
    let text = pierced(&format!("{a}, {inner}"));
    refuse(&text, "overlapping-holes", (Some(0), Some(2), Some(0)), &[]);
}

#[test]
fn a_hole_that_fills_its_polygon() {
    assert_eq!(refused(&pierced(SQUARE)).code(), "holes-fill-all");
}

#[test]
fn a_width_that_is_none() {
    for bad in ["0", "-3", "1e6", "\"wide\"", "[]", "NaN", "true"] {
        let properties = format!(r#"{{"kind": "road", "width_m": {bad}}}"#);
        let text = with(&properties, &line("[0, 100], [400, 100]"));
        refuse(
            &text,
            "bad-width",
            (Some(1), None, None),
            &["width_m", "metres"],
        );
    }
}

#[test]
fn a_bad_lake_is_named() {
    let lake = polygon("[[100, 50], [300, 250], [300, 50], [100, 250], [100, 50]]");
    let text = with(r#"{"kind": "lake"}"#, &lake);
    refuse(
        &text,
        "self-crossing-ring",
        (Some(1), Some(0), Some(0)),
        &["feature 1 (lake)"],
    );
}

#[test]
fn a_file_that_is_not_there_or_no_text() {
    let error = Site::read("no/such/site.geojson").unwrap_err();
    assert!(error.is_io() && error.to_string().contains("no/such/site.geojson"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("site.geojson");
    std::fs::write(&path, [0xff, 0xfe, 0x00]).unwrap();
    assert_eq!(Site::read(&path).unwrap_err().code(), "not-geojson");
    std::fs::write(&path, site(SQUARE)).unwrap();
    assert_eq!(Site::read(&path).unwrap().area(), 120_000.0);
}
