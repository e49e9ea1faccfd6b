//! Land beyond a neck is opened by streets, and they are one network.

use urban_layout::check::{check, CheckOptions};
use urban_layout::geo_types::{Coord, LineString, Polygon};
use urban_layout::metrics::metrics;
use urban_layout::{generate, PlanOptions, Quiet, Site};
use urban_layout_tests::long;

/// A field with a creek from the north that leaves `width` metres of land between
/// its end and the south side.
fn creek(width: f64) -> Vec<[f64; 2]> {
    vec![
        [0.0, 0.0],
        [700.0, 0.0],
        [690.0, 260.0],
        [372.0, 270.0],
        [352.0, width],
        [340.0, width],
        [320.0, 280.0],
        [-10.0, 270.0],
    ]
}

/// Two fields, joined by a strip of land `width` metres wide and 60 m long.
fn neck(width: f64) -> Vec<[f64; 2]> {
    vec![
        [0.0, 0.0],
        [420.0, 0.0],
        [420.0, 150.0],
        [480.0, 150.0],
        [480.0, 10.0],
        [720.0, -30.0],
        [740.0, 240.0],
        [480.0, 300.0],
        [480.0, 150.0 + width],
        [420.0, 150.0 + width],
        [400.0, 330.0],
        [-20.0, 310.0],
    ]
}

/// No law is broken, and no field is given up as green: together they are two
/// times a third of the land and more.
fn is_opened(name: &str, ring: &[[f64; 2]]) {
    let corners = ring.iter().map(|&[x, y]| Coord { x, y });
    let land = Polygon::new(corners.collect::<LineString<f64>>(), Vec::new());
    let site = Site::from_polygon(&land).expect("a site");
    for seed in 0..if long() { 12 } else { 4 } {
        let options = PlanOptions {
            seed,
            ..PlanOptions::default()
        };
        let plan = generate(&site, &options, &mut Quiet).expect("a plan");
        let certificate = check(&site, &plan.layout, &CheckOptions::default());
        let broken: Vec<_> = certificate.failed().map(|law| law.law).collect();
        assert!(broken.is_empty(), "{name}, seed {seed}: {broken:?}");
        assert_eq!(certificate.components, 1, "{name}, seed {seed}");
        let figures = metrics(&plan.layout, &site);
        let open = figures.l_p + figures.l_o;
        assert!(
            open < 6.0,
            "{name}, seed {seed}: {open:.1} % of the land open"
        );
    }
}

#[test]
fn beside_a_creek() {
    is_opened("24 m", &creek(24.0));
    is_opened("40 m", &creek(40.0));
}

#[test]
fn beyond_a_neck() {
    is_opened("24 m", &neck(24.0));
    is_opened("40 m", &neck(40.0));
}
