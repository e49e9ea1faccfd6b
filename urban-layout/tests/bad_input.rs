//! Every kind of bad input that we know of: a clear error that names its place, or a
//! valid site with a warning that says what was mended. Never a panic.

use urban_layout::site::{Site, Units, WarningKind};
use urban_layout::Error;

/// A collection in metres of features given as (properties, geometry).
fn collection(features: &[(&str, &str)]) -> String {
    let features: Vec<String> = features
        .iter()
        .map(|(properties, geometry)| {
            format!(r#"{{"type": "Feature", "properties": {properties}, "geometry": {geometry}}}"#)
        })
        .collect();
    format!(
        r#"{{"type": "FeatureCollection", "coordinate_units": "metres", "features": [{}]}}"#,
        features.join(", ")
    )
}

fn polygon(rings: &str) -> String {
    format!(r#"{{"type": "Polygon", "coordinates": [{rings}]}}"#)
}

fn line(positions: &str) -> String {
    format!(r#"{{"type": "LineString", "coordinates": [{positions}]}}"#)
}

const SITE: &str = r#"{"kind": "site"}"#;
const SQUARE: &str = "[[0, 0], [400, 0], [400, 300], [0, 300], [0, 0]]";

/// A site of the rings given.
fn site(rings: &str) -> String {
    collection(&[(SITE, &polygon(rings))])
}

/// The square site, and one feature more.
fn with(properties: &str, geometry: &str) -> String {
    collection(&[(SITE, &polygon(SQUARE)), (properties, geometry)])
}

/// The square site with a hole.
fn pierced(hole: &str) -> String {
    site(&format!("{SQUARE}, {hole}"))
}

fn refused(text: &str) -> Error {
    match Site::from_geojson(text, Units::Auto) {
        Ok(site) => panic!("accepted, {} m2: {text:.300}", site.area()),
        Err(error) => error,
    }
}

/// Refused with this code, at this place, in one line that says these words.
#[track_caller]
fn refuse(
    text: &str,
    code: &str,
    place: (Option<usize>, Option<usize>, Option<usize>),
    says: &[&str],
) {
    let error = refused(text);
    let message = error.to_string();
    assert_eq!(error.code(), code, "{message}");
    assert_eq!(
        (error.feature(), error.ring(), error.vertex()),
        place,
        "{message}"
    );
    assert!(error.is_input() && error.exit_code() == 1, "{message}");
    assert!(!message.contains('\n') && message.len() < 400, "{message}");
    for words in says {
        assert!(message.contains(words), "no {words:?} in: {message}");
    }
}

/// Accepted with this area and these warnings.
#[track_caller]
fn accept(text: &str, area: f64, warnings: &[WarningKind]) -> Site {
    let site = match Site::from_geojson(text, Units::Auto) {
        Ok(site) => site,
        Err(error) => panic!("{error}"),
    };
    let kinds: Vec<WarningKind> = site.warnings.iter().map(|w| w.kind).collect();
    assert_eq!(kinds, warnings, "{:?}", site.warnings);
    assert!((site.area() - area).abs() < 1e-6 * area, "{}", site.area());
    for warning in &site.warnings {
        assert!(!warning.message.contains('\n') && !warning.message.is_empty());
    }
    site
}

// What is no GeoJSON, or holds no site.

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

// Numbers.

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

// Rings.

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
fn repeated_vertices_collinear_ones_and_spikes_are_cleaned() {
    let text = site("[[0, 0], [0, 0], [400, 0], [400, 0], [400, 300], [0, 300], [0, 300], [0, 0]]");
    let site_ = accept(&text, 120_000.0, &[WarningKind::DuplicateVertices]);
    assert_eq!(site_.parts[0].exterior().0.len(), 5);
    let text =
        site("[[0, 0], [100, 0], [200, 0], [400, 0], [400, 300], [0, 300], [0, 150], [0, 0]]");
    let site_ = accept(&text, 120_000.0, &[WarningKind::CollinearVertices]);
    assert_eq!(site_.parts[0].exterior().0.len(), 5);
    let text = site("[[0, 0], [400, 0], [400, 300], [700, 500], [400, 300], [0, 300], [0, 0]]");
    let site_ = accept(&text, 120_000.0, &[WarningKind::Spikes]);
    assert_eq!(site_.parts[0].exterior().0.len(), 5);
    assert_eq!(
        site_.warnings[0].to_string(),
        "feature 0 (site), ring 0: 1 spikes dropped"
    );
}

#[test]
fn an_open_ring_is_closed() {
    let text = site("[[0, 0], [400, 0], [400, 300], [0, 300]]");
    accept(&text, 120_000.0, &[WarningKind::UnclosedRing]);
}

#[test]
fn either_winding_is_welcome() {
    let backwards = "[[0, 0], [0, 300], [400, 300], [400, 0], [0, 0]]";
    let hole = "[[100, 100], [200, 100], [200, 200], [100, 200], [100, 100]]";
    let site_ = accept(&site(&format!("{backwards}, {hole}")), 110_000.0, &[]);
    let signed = |ring: &geo_types::LineString<f64>| -> f64 {
        let cross = |w: &[geo_types::Coord<f64>]| w[0].x * w[1].y - w[1].x * w[0].y;
        ring.0.windows(2).map(cross).sum()
    };
    assert!(signed(site_.parts[0].exterior()) > 0.0);
    assert!(signed(&site_.parts[0].interiors()[0]) < 0.0);
}

// Holes.

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
fn a_hole_that_touches_the_boundary() {
    let touching = [WarningKind::TouchingRings];
    let vertex = "[[200, 0], [250, 80], [150, 80], [200, 0]]";
    accept(&pierced(vertex), 116_000.0, &touching);
    let edge = "[[150, 0], [250, 0], [250, 80], [150, 80], [150, 0]]";
    let site_ = accept(&pierced(edge), 112_000.0, &touching);
    assert!(site_.parts[0].interiors().is_empty());
    let through = "[[150, 0], [250, 0], [250, 300], [150, 300], [150, 0]]";
    assert_eq!(
        accept(&pierced(through), 90_000.0, &touching).parts.len(),
        2
    );
}

#[test]
fn a_hole_that_fills_its_polygon() {
    assert_eq!(refused(&pierced(SQUARE)).code(), "holes-fill-all");
}

#[test]
fn holes_that_touch_each_other() {
    let a = "[[50, 50], [150, 50], [150, 150], [50, 150], [50, 50]]";
    let b = "[[150, 50], [250, 50], [250, 150], [150, 150], [150, 50]]";
    let text = pierced(&format!("{a}, {b}"));
    let site_ = accept(&text, 100_000.0, &[WarningKind::TouchingRings]);
    assert_eq!(site_.parts[0].interiors().len(), 1);
}

// Several parts.

#[test]
fn parts_that_overlap_or_share_an_edge_are_joined() {
    let multi = |second: &str| {
        let geometry =
            format!(r#"{{"type": "MultiPolygon", "coordinates": [[{SQUARE}], [{second}]]}}"#);
        collection(&[(SITE, &geometry)])
    };
    let joined = [WarningKind::JoinedParts];
    let overlapping = multi("[[300, 0], [600, 0], [600, 300], [300, 300], [300, 0]]");
    let site_ = accept(&overlapping, 180_000.0, &joined);
    assert_eq!(site_.parts.len(), 1);
    // The centre is that of the land, not of the parts as they come.
    assert!((site_.frame.centre().x - 300.0).abs() < 1e-2);
    let beside = multi("[[400, 0], [600, 0], [600, 300], [400, 300], [400, 0]]");
    assert_eq!(accept(&beside, 180_000.0, &joined).parts.len(), 1);
    let apart = multi("[[500, 0], [600, 0], [600, 300], [500, 300], [500, 0]]");
    assert_eq!(accept(&apart, 150_000.0, &[]).parts.len(), 2);
    let twice = collection(&[(SITE, &polygon(SQUARE)), (SITE, &polygon(SQUARE))]);
    accept(&twice, 120_000.0, &joined);
    let bad = multi("[[500, 0], [600, 300], [600, 0], [500, 300], [500, 0]]");
    let message = refused(&bad).to_string();
    assert!(
        message.starts_with("feature 0 (site), part 1, ring 0, vertex 0:"),
        "{message}"
    );
}

// Sites of odd sizes.

#[test]
fn a_site_smaller_than_a_parcel() {
    let text = site("[[0, 0], [5, 0], [5, 4], [0, 4], [0, 0]]");
    accept(&text, 20.0, &[WarningKind::TinySite]);
    let text = site("[[0, 0], [1e-3, 0], [1e-3, 1e-3], [0, 1e-3], [0, 0]]");
    accept(&text, 1e-6, &[WarningKind::TinySite]);
}

#[test]
fn a_site_as_thin_as_a_needle() {
    accept(&site("[[0, 0], [2000, 0.5], [0, 1], [0, 0]]"), 1000.0, &[]);
    let text = site("[[0, 0], [20000, 0.001], [0, 0.002], [0, 0]]");
    accept(&text, 20.0, &[WarningKind::TinySite]);
}

#[test]
fn a_ring_of_a_hundred_thousand_vertices() {
    let n = 100_000;
    let ring = |jag: f64| -> String {
        let positions: Vec<String> = (0..=n)
            .map(|k| {
                let angle = f64::from(k % n) / f64::from(n) * std::f64::consts::TAU;
                let r = 800.0 + jag * f64::from(k % 2);
                format!("[{:.9}, {:.9}]", r * angle.cos(), r * angle.sin())
            })
            .collect();
        site(&format!("[{}]", positions.join(",")))
    };
    for jag in [0.0, 50.0] {
        let text = ring(jag);
        let start = std::time::Instant::now();
        let site_ = Site::from_geojson(&text, Units::Auto).unwrap();
        // Under 1 s on an idle machine; tests share theirs.
        assert!(start.elapsed().as_secs_f64() < 4.0, "{:?}", start.elapsed());
        assert_eq!(site_.parts[0].exterior().0.len(), 100_001);
    }
}

// Roads and elements.

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
fn widths_and_classes_by_default() {
    let road = line("[-10, 100], [410, 100]");
    for (properties, width) in [
        (r#"{"kind": "road"}"#, 12.0),
        (r#"{"kind": "road", "class": "major"}"#, 22.0),
        (
            r#"{"kind": "road", "class": "collector", "width_m": null}"#,
            16.0,
        ),
        (r#"{"kind": "road", "class": "cul_de_sac"}"#, 12.0),
        (r#"{"kind": "road", "class": "major", "width_m": 7.5}"#, 7.5),
    ] {
        assert_eq!(
            accept(&with(properties, &road), 120_000.0, &[]).roads[0].width,
            width
        );
    }
    let street = r#"{"kind": "street", "class": "major", "name": "A 1"}"#;
    let site_ = accept(&with(street, &road), 120_000.0, &[]);
    assert_eq!(site_.outside_streets[0].width, 12.0);
    assert_eq!(site_.outside_streets[0].name.as_deref(), Some("A 1"));
    let strange = with(r#"{"kind": "road", "class": "motorway"}"#, &road);
    accept(&strange, 120_000.0, &[WarningKind::UnknownClass]);
}

#[test]
fn a_road_outside() {
    let text = with(r#"{"kind": "road"}"#, &line("[500, 0], [900, 100]"));
    let site_ = accept(&text, 120_000.0, &[WarningKind::Outside]);
    assert!(site_.roads.is_empty());
}

#[test]
fn a_road_along_the_boundary() {
    let text = with(r#"{"kind": "road"}"#, &line("[0, 0.5], [400, -0.5]"));
    let site_ = accept(&text, 120_000.0, &[WarningKind::AlongBoundary]);
    assert!(site_.roads.is_empty());
    let edge = |k: usize| site_.frame.to_source(site_.boundary_roads[0].line.0[k]);
    assert_eq!(site_.boundary_roads[0].line.0.len(), 2);
    assert!(edge(0).y.abs() < 1e-9 && edge(1).y.abs() < 1e-9);
    assert!((site_.access().covered_length(site_.parts[0].exterior()) - 424.0).abs() < 0.1);
}

#[test]
fn roads_that_cross_and_a_road_that_crosses_itself() {
    let text = collection(&[
        (SITE, &polygon(SQUARE)),
        (r#"{"kind": "road"}"#, &line("[-10, 100], [410, 120]")),
        (r#"{"kind": "road"}"#, &line("[200, -10], [220, 310]")),
        (
            r#"{"kind": "road"}"#,
            &line("[50, 50], [150, 150], [150, 50], [50, 150]"),
        ),
    ]);
    assert_eq!(accept(&text, 120_000.0, &[]).roads.len(), 3);
}

#[test]
fn a_road_across_a_hole() {
    let hole = "[[150, 100], [250, 100], [250, 200], [150, 200], [150, 100]]";
    let text = collection(&[
        (SITE, &polygon(&format!("{SQUARE}, {hole}"))),
        (r#"{"kind": "road"}"#, &line("[-10, 150], [410, 150]")),
    ]);
    assert_eq!(accept(&text, 110_000.0, &[]).roads.len(), 2);
}

#[test]
fn a_road_of_no_length() {
    let text = with(r#"{"kind": "road"}"#, &line("[10, 10], [10, 10]"));
    let kinds = [WarningKind::DuplicateVertices, WarningKind::NoLength];
    assert!(accept(&text, 120_000.0, &kinds).roads.is_empty());
}

#[test]
fn a_lake_over_a_road() {
    let lake = polygon("[[100, 50], [300, 50], [300, 250], [100, 250], [100, 50]]");
    let text = collection(&[
        (SITE, &polygon(SQUARE)),
        (r#"{"kind": "road"}"#, &line("[0, 150], [400, 150]")),
        (r#"{"kind": "lake"}"#, &lake),
    ]);
    let site_ = accept(&text, 120_000.0, &[WarningKind::RoadThroughElement]);
    assert_eq!(site_.elements.len(), 2);
    let message = &site_.warnings[0].message;
    assert!(
        message.starts_with("feature 2 (lake)") && message.contains("2400 m2"),
        "{message}"
    );
}

#[test]
fn elements_that_overlap_or_lie_outside() {
    let park = polygon("[[100, 50], [300, 50], [300, 250], [100, 250], [100, 50]]");
    let lake = polygon("[[200, 50], [500, 50], [500, 250], [200, 250], [200, 50]]");
    let far = polygon("[[900, 50], [950, 50], [950, 250], [900, 50]]");
    let text = collection(&[
        (SITE, &polygon(SQUARE)),
        (r#"{"kind": "park", "label": "P"}"#, &park),
        (r#"{"kind": "lake", "name": "L"}"#, &lake),
        (r#"{"kind": "reserved"}"#, &far),
    ]);
    let kinds = [
        WarningKind::Clipped,
        WarningKind::OverlappingElements,
        WarningKind::Outside,
    ];
    let site_ = accept(&text, 120_000.0, &kinds);
    let labels: Vec<_> = site_.elements.iter().map(|e| e.label.as_deref()).collect();
    assert_eq!(labels, [Some("P"), Some("L")]);
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
fn unknown_kinds_and_features_of_no_place_are_left_out() {
    let building = with(r#"{"kind": "building"}"#, r#"{"type": "Nonsense"}"#);
    accept(&building, 120_000.0, &[WarningKind::UnknownKind]);
    accept(
        &with("null", "null"),
        120_000.0,
        &[WarningKind::UnknownKind],
    );
    accept(
        &with(r#"{"kind": 7}"#, "null"),
        120_000.0,
        &[WarningKind::UnknownKind],
    );
    let nowhere = with(r#"{"kind": "road"}"#, "null");
    accept(&nowhere, 120_000.0, &[WarningKind::NoGeometry]);
}

// Other shapes of a sound file.

#[test]
fn a_lone_feature_or_geometry_is_the_site() {
    let ring = "[[25, 60], [25.01, 60], [25.01, 60.01], [25, 60.01], [25, 60]]";
    let high = "[[25, 60, 7], [25.01, 60, 8.5], [25.01, 60.01, 9], [25, 60, 7]]";
    assert!(Site::from_geojson(&polygon(ring), Units::Auto).is_ok());
    assert!(Site::from_geojson(&polygon(high), Units::Auto).is_ok());
    let feature = format!(
        r#"{{"type": "Feature", "properties": {{"name": "N"}}, "geometry": {}}}"#,
        polygon(ring)
    );
    let site = Site::from_geojson(&feature, Units::Auto).unwrap();
    assert_eq!(site.name.as_deref(), Some("N"));
    // 557.9 m by 1114.1 m on the ellipsoid at this latitude.
    assert!(
        (site.area() - 557.9 * 1114.1).abs() < 1e-3 * site.area(),
        "{}",
        site.area()
    );
    let nulls = feature.replace(r#"{"name": "N"}"#, "null");
    assert!(Site::from_geojson(&nulls, Units::Auto).is_ok());
    // A lone polygon without a kind among other things.
    let text = collection(&[
        ("null", &polygon(SQUARE)),
        (r#"{"kind": "road"}"#, &line("[-10, 100], [410, 100]")),
    ]);
    let site = Site::from_geojson(&text, Units::Auto).unwrap();
    assert_eq!(site.roads.len(), 1);
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
