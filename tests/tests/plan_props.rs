//! Laws of whole plans on sites that nobody drew: star-shaped fields of a few
//! hectares, some with a pond, at any place and of any number of corners.

use geo_types::{Coord, LineString, Polygon};
use proptest::prelude::*;
use urban_layout::check::{check, CheckOptions};
use urban_layout::metrics::metrics;
use urban_layout::{generate, PlanOptions, Quiet, Site};
use urban_layout_tests::long;

/// A ring around `centre`, one radius a corner.
fn star(centre: Coord<f64>, radii: &[f64], turn: f64) -> LineString<f64> {
    let step = std::f64::consts::TAU / radii.len() as f64;
    let corner = |(i, radius): (usize, &f64)| {
        let angle = turn + step * i as f64;
        centre
            + Coord {
                x: radius * angle.cos(),
                y: radius * angle.sin(),
            }
    };
    let mut ring: Vec<_> = radii.iter().enumerate().map(corner).collect();
    ring.push(ring[0]);
    LineString(ring)
}

/// A field of 2 to 20 hectares; every other one has a pond in the middle.
fn field() -> impl Strategy<Value = Polygon<f64>> {
    let radii = prop::collection::vec(90.0..240.0_f64, 4..9);
    let place = (-1e6..1e6_f64, -1e6..7e6_f64).prop_map(|(x, y)| Coord { x, y });
    (radii, place, 0.0..1.0_f64, any::<bool>(), 15.0..35.0_f64).prop_map(
        |(radii, centre, turn, pond, size)| {
            let holes = if pond {
                vec![star(centre, &[size; 6], turn)]
            } else {
                Vec::new()
            };
            Polygon::new(star(centre, &radii, turn), holes)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: if long() { 60 } else { 6 },
        max_shrink_iters: 40,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_field_gets_a_plan_that_keeps_the_laws(field in field(), seed in 0_u64..1000) {
        let site = Site::from_polygon(&field).expect("a field is a site");
        let options = PlanOptions { seed, ..PlanOptions::default() };
        let plan = generate(&site, &options, &mut Quiet).expect("any site gets a plan");
        let certificate = check(&site, &plan.layout, &CheckOptions::default());
        let broken: Vec<_> = certificate
            .failed()
            .map(|law| format!("{}: {:?}", law.law, law.detail.first()))
            .collect();
        prop_assert!(broken.is_empty(), "{broken:#?}");

        // The land is all there, and figures are figures.
        let m = metrics(&plan.layout, &site);
        prop_assert!((m.l_s + m.l_r + m.l_p + m.l_o - 100.0).abs() < 0.01);
        prop_assert!(m.parcels > 0 && m.p_area >= 1.0 && m.p_angle.is_finite());
    }
}
