//! Input that is sound in an odd way, or can be mended: a valid site, with warnings
//! that say what was done.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod input;

use input::{accept, collection, line, pierced, polygon, refused, site, with, SITE, SQUARE};
use urban_layout::site::{Site, Units, WarningKind};

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
fn holes_that_touch_each_other() {
    let a = "[[50, 50], [150, 50], [150, 150], [50, 150], [50, 50]]";
    let b = "[[150, 50], [250, 50], [250, 150], [150, 150], [150, 50]]";
    let text = pierced(&format!("{a}, {b}"));
    let site_ = accept(&text, 100_000.0, &[WarningKind::TouchingRings]);
    assert_eq!(site_.parts[0].interiors().len(), 1);
}

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
    for jag in [0.0, 200.0] {
        let text = ring(jag);
        let start = input::seconds();
        let site_ = Site::from_geojson(&text, Units::Auto).unwrap();
        // Half a second; comparing all teeth that overlap takes a minute.
        let spent = input::seconds() - start;
        assert!(spent < 4.0, "{spent} s");
        assert_eq!(site_.parts[0].exterior().0.len(), 100_001);
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
