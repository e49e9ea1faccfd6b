//! Where a site lies on its map changes nothing about its plan.

use geo_types::Coord;
use urban_layout::metrics::metrics;
use urban_layout::site::Units;
use urban_layout::{generate, Plan, PlanOptions, Quiet, Site};
use urban_layout_tests::{in_metres, long, Shipped};

fn plan_at(site: &Site, origin: Coord<f64>) -> Plan {
    let text = in_metres(site, origin);
    let moved = Site::from_geojson(&text, Units::Auto).expect("the site elsewhere");
    generate(&moved, &PlanOptions::default(), &mut Quiet).expect("a plan")
}

/// A plan is made in metres around the site's centre, so a copy of the site at
/// the coordinates of a UTM zone gets the very same one: not nearly, but to the
/// bit, ids and seeds included.
fn the_same_at_utm_coordinates(name: &str) {
    let site = Shipped::named(name).site();
    let here = plan_at(&site, Coord { x: 0.0, y: 0.0 });
    let there = plan_at(&site, Coord { x: 5e5, y: 5e6 });
    let at = there.site().frame.to_source(Coord { x: 0.0, y: 0.0 });
    assert!(at.x > 4e5 && at.y > 4.9e6, "it was not moved: {at:?}");
    assert_eq!(
        metrics(&here.layout, here.site()),
        metrics(&there.layout, there.site()),
        "{name}"
    );
    // Not assert_eq: two layouts are too long to read.
    assert!(here.layout == there.layout, "{name}: the layouts differ");
}

#[test]
fn kotka_north_is_the_same_at_utm_coordinates() {
    the_same_at_utm_coordinates("kotka_north");
}

#[test]
fn sites_with_roads_are_the_same_at_utm_coordinates() {
    if long() {
        the_same_at_utm_coordinates("kotka_east");
        the_same_at_utm_coordinates("kotka_district");
    }
}

/// Degrees and metres are two ways to say the same site. The frame of degrees is
/// affine, so its local coordinates are those of the file in metres but for the
/// rounding to 1/1024 m: a plan of the same sort must come out.
#[test]
fn degrees_and_metres_give_plans_of_a_kind() {
    let site = Shipped::named("kotka_north").site();
    let degrees = generate(&site, &PlanOptions::default(), &mut Quiet).expect("a plan in degrees");
    let metres = plan_at(&site, Coord { x: 0.0, y: 0.0 });
    let (a, b) = (
        metrics(&degrees.layout, degrees.site()),
        metrics(&metres.layout, metres.site()),
    );
    assert!((a.site_km2 - b.site_km2).abs() < 1e-5 * a.site_km2);
    assert!(
        (a.p_n - b.p_n).abs() < 0.15 * a.p_n,
        "{} and {} parcels per km2",
        a.p_n,
        b.p_n
    );
}
