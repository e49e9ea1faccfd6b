//! The designs of parks: those of plans on all shipped sites, and the library's
//! on the shipped parks, by the laws of parks.

use std::path::PathBuf;

use park_grammar::{grammars, DeriveOptions};
use serde_json::Value;
use urban_layout::geo_types::Polygon;
use urban_layout::io::park_geojson::parks_to_geojson;
use urban_layout::layout::TileKind;
use urban_layout::park::{ParkChoice, ParkStudy};
use urban_layout::site::Units;
use urban_layout::{PlanOptions, Site};
use urban_layout_tests::{long, Shipped, SITES};

/// Four parks of Helsinki (OpenStreetMap, ODbL 1.0).
const PARKS: [&str; 4] = [
    "helsinki_esplanadi",
    "helsinki_kaisaniemi",
    "helsinki_makasiini",
    "helsinki_vanha_kirkkopuisto",
];

fn area(polygon: &Polygon<f64>) -> f64 {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    let ring = |points: &[urban_layout::geo_types::Coord<f64>]| -> f64 {
        let [a, ..] = points else { return 0.0 };
        let parts = points.windows(2).map(|w| {
            let (u, v) = (w[0] - *a, w[1] - *a);
            0.5 * (u.x * v.y - u.y * v.x)
        });
        parts.sum()
    };
    let sizes: Vec<f64> = rings.map(|r| ring(&r.0).abs()).collect();
    sizes[0] - sizes[1..].iter().sum::<f64>()
}

#[test]
fn parks_of_plans_keep_the_laws() {
    for shipped in SITES {
        let plan = shipped.plan(&PlanOptions::default());
        let parks: Vec<_> = plan.layout.tiles_of(TileKind::Park).collect();
        for design in &plan.layout.parks {
            let tile = parks.iter().find(|tile| tile.id == design.tile);
            let tile = tile.expect("a design stands on a park");
            assert!(!tile.given, "given parks stay as they are");
            let audit = design.scene.audit(&tile.polygon);
            assert!(
                audit.is_lawful(),
                "{} {}: {:?}",
                shipped.name,
                design.grammar,
                audit.violations
            );
            assert!((audit.area - area(&tile.polygon)).abs() < 1e-6 * audit.area);
        }
        // What has room for a walk has a design.
        for tile in parks
            .iter()
            .filter(|tile| !tile.given && area(&tile.polygon) > 600.0)
        {
            let designed = plan.layout.parks.iter().any(|d| d.tile == tile.id);
            assert!(designed, "{}: tile {} is plain", shipped.name, tile.id);
        }
    }
}

#[test]
fn a_plan_is_the_same_whatever_its_parks_look_like() {
    let shipped = Shipped::named("kotka_north");
    let fitting = shipped.plan(&PlanOptions::default());
    let again = shipped.plan(&PlanOptions {
        threads: 2,
        ..PlanOptions::default()
    });
    assert!(fitting.layout.parks == again.layout.parks);
    let plain = shipped.plan(&PlanOptions {
        parks: ParkChoice::Plain,
        ..PlanOptions::default()
    });
    assert!(plain.layout.parks.is_empty());
    assert!(plain.layout.tiles == fitting.layout.tiles);
    let woodland = grammars::named("woodland").expect("known").grammar();
    let woods = shipped.plan(&PlanOptions {
        parks: ParkChoice::Grammar(Box::new(woodland.expect("reads"))),
        ..PlanOptions::default()
    });
    assert!(woods
        .layout
        .parks
        .iter()
        .all(|design| design.grammar == "woodland"));
    assert!(woods.layout.tiles == fitting.layout.tiles);

    let text = parks_to_geojson(&fitting.layout, &fitting.site().frame);
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let features = file["features"].as_array().expect("features");
    let mut ids: Vec<u64> = features
        .iter()
        .map(|f| f["properties"]["id"].as_u64().expect("an integer"))
        .collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), features.len());
    for feature in features {
        let park = feature["properties"]["park"].as_u64();
        assert!(fitting.layout.parks.iter().any(|d| Some(d.tile) == park));
    }
}

/// Every grammar of the library on every shipped park, by the figures that the
/// command prints.
#[test]
fn the_library_suits_the_shipped_parks() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("data/parks");
    for name in PARKS {
        let text = std::fs::read_to_string(folder.join(format!("{name}.geojson")));
        let text = text.expect("a shipped park");
        let site = Site::park_from_geojson(&text, Units::Auto).expect("a park");
        // The large park takes longer than all others.
        for known in grammars::ALL
            .iter()
            .filter(|_| long() || name != "helsinki_kaisaniemi")
        {
            let grammar = known.grammar().expect("reads");
            let options = DeriveOptions::default();
            let study = ParkStudy::new(&site, &grammar, &options, &mut |_| true);
            let study = study.unwrap_or_else(|e| panic!("{name} {}: {e}", known.name));
            let figures = study.to_json();
            assert_eq!(
                figures["violations"],
                serde_json::json!([]),
                "{name} {}",
                known.name
            );
            let error = figures["tiling_error"].as_f64().expect("a number");
            assert!(error < 1e-9, "{name} {}: {error}", known.name);
        }
    }
}
