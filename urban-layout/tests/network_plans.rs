//! Plans whose streets come from a specification: on land of every kind that a
//! site may be they keep the laws, and the same seed gives the same plan.

use urban_layout::check::{check, CheckOptions};
use urban_layout::design::NetworkSpec;
use urban_layout::site::{RoadClass, Units};
use urban_layout::splitter::NetworkOptions;
use urban_layout::{generate, Plan, PlanOptions, Progress, Quiet, Site, Stage};

/// A site in metres: its rings, and features besides.
fn site(rings: &str, others: &str) -> Site {
    let text = format!(
        r#"{{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
        {{"type": "Feature", "properties": {{"kind": "site"}}, "geometry":
        {{"type": "Polygon", "coordinates": {rings}}}}}{others}]}}"#
    );
    Site::from_geojson(&text, Units::Auto).expect("a site")
}

/// 7.2 ha.
const SQUARE: &str = "[[[0, 0], [300, 0], [300, 240], [0, 240], [0, 0]]]";

fn network(options: NetworkOptions) -> PlanOptions {
    PlanOptions {
        network: Some(options),
        ..PlanOptions::default()
    }
}

/// Few moves: what is tested is not how short the streets are.
fn quick() -> NetworkOptions {
    NetworkOptions {
        moves: 1500,
        tries: 1,
        ..NetworkOptions::default()
    }
}

fn plan_of(site: &Site, options: &PlanOptions) -> Plan {
    generate(site, options, &mut Quiet).expect("a plan")
}

/// A plan by network that keeps every law; how many streets the network made.
#[track_caller]
fn lawful(site: &Site, options: NetworkOptions) -> usize {
    let plan = plan_of(site, &network(options));
    let certificate = check(site, &plan.layout, &CheckOptions::default());
    assert!(
        certificate.is_ok(),
        "{:?}",
        certificate.failed().collect::<Vec<_>>()
    );
    assert!(plan.layout.parcels().count() > 20);
    let by_network = |street: &&urban_layout::layout::Street| {
        street.lineage.as_ref().is_some_and(|l| l.by == "network")
    };
    plan.layout.streets.iter().filter(by_network).count()
}

#[test]
fn a_rectangle_is_rows_of_parcels() {
    let site = site(SQUARE, "");
    assert!(lawful(&site, quick()) > 0);
    // Four rows of quads deep: three streets at the least if one lies between
    // any two, and the land of 30 m parcels is the most of it.
    let plan = plan_of(&site, &network(quick()));
    let land: f64 = plan.layout.parcels().count() as f64 * 540.0;
    assert!(land > 0.55 * site.area(), "{land} of {}", site.area());
    assert_eq!(plan.warnings().count(), 0);
}

#[test]
fn an_l_shape_is_laid_out() {
    let rings = "[[[0, 0], [360, 0], [360, 150], [150, 150], [150, 360], [0, 360], [0, 0]]]";
    assert!(lawful(&site(rings, ""), quick()) > 0);
}

#[test]
fn streets_go_around_a_hole() {
    let rings = "[[[0, 0], [400, 0], [400, 330], [0, 330], [0, 0]], \
                 [[170, 130], [170, 200], [240, 200], [240, 130], [170, 130]]]";
    assert!(lawful(&site(rings, ""), quick()) > 0);
}

#[test]
fn streets_keep_out_of_a_lake() {
    let lake = r#",{"type": "Feature", "properties": {"kind": "lake"}, "geometry": {"type": "Polygon", "coordinates":
        [[[140, 110], [190, 90], [230, 130], [200, 170], [150, 160], [140, 110]]]}}"#;
    let rings = "[[[0, 0], [400, 0], [400, 280], [0, 280], [0, 0]]]";
    let site = site(rings, lake);
    assert!(lawful(&site, quick()) > 0);
    let plan = plan_of(&site, &network(quick()));
    let lake = &site.elements[0].polygon.exterior().0;
    for street in &plan.layout.streets {
        for p in &street.line.0 {
            let crossings = lake.windows(2).filter(|w| {
                let (a, b) = (w[0], w[1]);
                (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
            });
            assert!(crossings.count() % 2 == 0, "{p:?} lies in the lake");
        }
    }
}

#[test]
fn given_roads_bound_regions_and_are_joined() {
    let road = r#",{"type": "Feature", "properties": {"kind": "road", "class": "collector", "width_m": 16}, "geometry":
        {"type": "LineString", "coordinates": [[210, 0], [200, 140], [215, 300]]}}"#;
    let rings = "[[[0, 0], [430, 0], [430, 300], [0, 300], [0, 0]]]";
    let site = site(rings, road);
    assert!(lawful(&site, quick()) > 0);
    let plan = plan_of(&site, &network(quick()));
    let given = plan.layout.streets.iter().filter(|s| s.given);
    assert!(given.count() > 1, "no street meets the given road");
}

#[test]
fn the_seed_decides_and_threads_do_not() {
    let site = site(SQUARE, "");
    let lines = |seed: u64, threads: usize| {
        let options = PlanOptions {
            seed,
            threads,
            ..network(quick())
        };
        plan_of(&site, &options).layout
    };
    assert_eq!(lines(3, 1), lines(3, 2));
    // Among a few seeds two plans differ.
    let first = lines(0, 0).streets;
    assert!(
        (1..6).any(|seed| lines(seed, 0).streets.len() != first.len()
            || lines(seed, 0).streets[0].line != first[0].line)
    );
}

#[test]
fn levels_of_a_specification_have_their_class_and_width() {
    let spec = NetworkSpec::from_toml(
        r#"
        edge-length = 75.0
        [[level]]
        class = "collector"
        width = 18.0
        [level.network]
        coverage = { hops = 2 }
        [[level]]
        class = "local"
        width = 12.0
        [level.network]
        sinks = "streets"
        coverage = { hops = 2 }
        "#,
    )
    .expect("a specification");
    let options = NetworkOptions {
        spec: Some(spec),
        ..quick()
    };
    let rings = "[[[0, 0], [450, 0], [450, 375], [0, 375], [0, 0]]]";
    let site = site(rings, "");
    assert!(lawful(&site, options.clone()) > 0);
    let plan = plan_of(&site, &network(options));
    let mut classes = Vec::new();
    for street in &plan.layout.streets {
        let by = street.lineage.as_ref().map(|l| l.by.as_str());
        if by == Some("network") {
            let wide = match street.class {
                RoadClass::Collector => 18.0,
                _ => 12.0,
            };
            assert_eq!(street.width, wide);
            classes.push(street.class);
        }
    }
    assert!(classes.contains(&RoadClass::Collector));
}

/// Quads of 5 cm are too many: the streets follow a field, and the plan says
/// so, why, and what to do.
#[test]
fn where_there_is_no_network_streets_follow_a_field() {
    let spec = NetworkSpec::from_toml("edge-length = 0.05\n[[level]]\nclass = \"local\"");
    let options = NetworkOptions {
        spec: Some(spec.expect("a specification")),
        ..quick()
    };
    let site = site(SQUARE, "");
    let plan = plan_of(&site, &network(options));
    assert!(check(&site, &plan.layout, &CheckOptions::default()).is_ok());
    let warnings: Vec<&str> = plan.warnings().collect();
    assert!(
        warnings
            .iter()
            .any(|w| w.contains("no network") && w.contains("million quads")),
        "{warnings:?}"
    );
    assert!(plan
        .layout
        .streets
        .iter()
        .all(|s| s.lineage.as_ref().is_none_or(|l| l.by != "network")));
}

#[test]
fn options_out_of_range_are_errors_that_name_them() {
    let site = site(SQUARE, "");
    let spec = |text: &str| NetworkOptions {
        spec: Some(NetworkSpec::from_toml(text).expect("read")),
        ..NetworkOptions::default()
    };
    let wrong = [
        (
            NetworkOptions {
                moves: 0,
                ..quick()
            },
            "moves",
        ),
        (
            NetworkOptions {
                tries: 0,
                ..quick()
            },
            "tried",
        ),
        (
            NetworkOptions {
                fronts: -1.0,
                ..quick()
            },
            "fronts",
        ),
        (
            NetworkOptions {
                bends: f64::NAN,
                ..quick()
            },
            "bends",
        ),
        (spec("[[level]]\nclass = \"alley\""), "alley"),
        (spec("[[level]]\nwidth = 400.0"), "400"),
        (
            spec("[[level]]\n[level.network]\nobstacles = [3]"),
            "obstacles",
        ),
        (spec("edge-length = -2.0\n[[level]]"), "-2"),
    ];
    for (options, word) in wrong {
        let error = generate(&site, &network(options), &mut Quiet).expect_err(word);
        assert!(error.is_usage(), "{error}");
        assert!(error.to_string().contains(word), "{error}");
    }
}

#[test]
fn a_plan_can_be_cancelled() {
    struct Stop;
    impl Progress for Stop {
        fn report(&mut self, _stage: Stage, _fraction: f64) -> bool {
            false
        }
    }
    let site = site(SQUARE, "");
    let error = generate(&site, &network(quick()), &mut Stop).expect_err("stopped");
    assert!(error.is_cancelled());
}

/// Land of one row of parcels, a splinter, a triangle: nothing for a network,
/// and a plan all the same.
#[test]
fn small_and_narrow_land_is_no_trouble() {
    for rings in [
        "[[[0, 0], [60, 0], [60, 40], [0, 40], [0, 0]]]",
        "[[[0, 0], [900, 0], [900, 45], [0, 45], [0, 0]]]",
        "[[[0, 0], [420, 20], [150, 330], [0, 0]]]",
    ] {
        let site = site(rings, "");
        let plan = plan_of(&site, &network(quick()));
        let certificate = check(&site, &plan.layout, &CheckOptions::default());
        assert!(
            certificate.is_ok(),
            "{rings}: {:?}",
            certificate.failed().collect::<Vec<_>>()
        );
    }
}
