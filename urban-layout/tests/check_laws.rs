//! A plan that keeps every law, what is measured of it, and plans that are
//! hardly plans. For each law of tiles and of streets a plan that breaks it:
//! `check_tiles.rs` and `check_streets.rs`.

mod judged;
mod synthetic;

use judged::{breaks, failed, judged};
use synthetic::Town;
use urban_layout::check::{check, CheckOptions};
use urban_layout::geo_types::{Coord, LineString, Polygon};
use urban_layout::layout::Layout;
use urban_layout::metrics::metrics;

#[test]
fn a_sound_plan_keeps_every_law() {
    for town in [
        Town::default(),
        Town {
            parcels: 3,
            columns: 2,
            streets: 1,
            wave: 0.0,
        },
        Town {
            columns: 5,
            streets: 4,
            ..Town::default()
        },
    ] {
        let (site, layout) = town.build();
        let certificate = check(&site, &layout, &CheckOptions::default());
        assert!(certificate.is_ok(), "{certificate}");
        assert_eq!(certificate.components, 1);
        let json = certificate.to_json();
        assert_eq!(json["ok"], true);
        assert_eq!(
            json["laws"].as_array().map(Vec::len),
            Some(certificate.laws.len())
        );
    }
}

#[test]
fn metrics_are_those_of_the_geometry() {
    let (site, layout) = Town {
        wave: 0.0,
        ..Town::default()
    }
    .build();
    let m = metrics(&layout, &site);
    let blocks = 3 * 4;
    assert_eq!(layout.blocks.len(), blocks);
    // Two columns whole; in the middle one a lake, a park and shops but for one row.
    assert_eq!(m.parcels, 2 * 7 * 6 + 7);
    assert!((m.p_angle).abs() < 1e-6 && (m.p_area - 1.0).abs() < 1e-9);
    assert_eq!((m.undesirable, m.without_access), (0, 0));
    assert!((m.l_s + m.l_r + m.l_p + m.l_o - 100.0).abs() < 1e-9);
    let km2 = site.area() / 1e6;
    assert!((m.b_n * km2 - blocks as f64).abs() < 1e-9);
    assert!(
        (m.b_max - 2.0 * (126.0 + 60.0)).abs() < 1e-6
            && (m.b_min - 2.0 * (126.0 + 30.0)).abs() < 1e-6
    );
    assert!((m.s_i * km2 - 6.0).abs() < 1e-9);
    // Ends at the boundary where nothing is given outside are no ways out here,
    // since a street outside and a road are given.
    assert!((m.s_d * km2 - 8.0).abs() < 1e-9);
    assert_eq!(m.p_ideal, Some(1.0));
    assert_eq!(m.p_similarity, Some(0.25));
    assert_eq!(m.seed, 7);
}

#[test]
fn two_features_of_one_id() {
    breaks(&["ids"], |_, layout| {
        layout.blocks[0].id = layout.blocks[1].id
    });
}

#[test]
fn nothing_at_all_is_judged_without_a_panic() {
    let (site, _) = Town::default().build();
    let certificate = check(&site, &Layout::default(), &CheckOptions::default());
    assert!(failed(&certificate).contains(&"gap"));
    let certificate = judged(|_, layout| {
        layout.streets[0].line.0.clear();
        layout.streets[1].line.0.truncate(1);
        layout.tiles[0].polygon = Polygon::new(LineString::new(vec![]), vec![]);
        layout.tiles[1].polygon = Polygon::new(
            LineString::new(vec![
                Coord {
                    x: f64::NAN,
                    y: 0.0
                };
                4
            ]),
            vec![],
        );
    });
    assert!(!certificate.is_ok());
}
