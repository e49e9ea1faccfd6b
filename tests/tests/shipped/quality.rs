//! The project's limits of quality.

use urban_layout::metrics::{metrics, Metrics};
use urban_layout_tests::{Shipped, SITES};

use crate::plan;

/// Limits of quality that a site's figures miss, for people.
///
/// The project's goals: on plain suburban land what the best of the paper's
/// results reach, elsewhere twice as much slack.
fn missed(shipped: Shipped, m: &Metrics) -> Vec<String> {
    let mut limits = vec![
        (
            "corner deviation, degrees",
            m.p_angle,
            if shipped.plain { 5.0 } else { 10.0 },
        ),
        ("box/area", m.p_area, if shipped.plain { 1.10 } else { 1.2 }),
    ];
    if shipped.plain {
        let share = 100.0 * m.undesirable as f64 / m.parcels.max(1) as f64;
        limits.push(("undesirable parcels, per cent", share, 8.0));
        limits.push(("land not in parcels, per cent", 100.0 - m.l_r, 45.0));
        limits.push(("less than 900 parcels per km2 by", 900.0 - m.p_n, 0.0));
        // None of the plain sites comes with a park: every park is unasked for.
        limits.push(("other land and parks, per cent", m.l_o + m.l_p, 6.0));
    }
    limits
        .into_iter()
        .filter(|(_, value, limit)| value > limit || value.is_nan())
        .map(|(what, value, limit)| format!("{}: {what} {value:.3} > {limit}", shipped.name))
        .collect()
}

#[test]
fn parcels_are_good_on_every_site() {
    let faults: Vec<String> = SITES
        .into_iter()
        .flat_map(|shipped| {
            let plan = plan(shipped);
            missed(shipped, &metrics(&plan.layout, plan.site()))
        })
        .collect();
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn limits_are_missed_by_what_misses_them() {
    let fields = Shipped::named("kotka_fields");
    let good = Metrics {
        l_r: 60.0,
        p_n: 1000.0,
        p_angle: 3.0,
        p_area: 1.05,
        parcels: 100,
        ..Metrics::default()
    };
    assert_eq!(missed(fields, &good), Vec::<String>::new());
    let bad = Metrics {
        p_angle: f64::NAN,
        undesirable: 9,
        l_p: 7.0,
        ..good.clone()
    };
    assert_eq!(missed(fields, &bad).len(), 3);
}
