//! Other seeds give other plans, each as valid as the first.

use urban_layout::check::{check, CheckOptions};
use urban_layout::{Plan, PlanOptions};
use urban_layout_tests::{long, new_streets, share_elsewhere, Shipped};

/// How far a street must lie from all streets of another plan to count as a
/// different one, metres: two thirds of a street's width.
const REACH: f64 = 10.0;

/// The least share of a plan's streets that lies elsewhere in any other plan.
const LEAST_SHARE: f64 = 0.05;

fn ten_seeds(name: &str) {
    let shipped = Shipped::named(name);
    let plans: Vec<Plan> = (0..10)
        .map(|seed| {
            shipped.plan(&PlanOptions {
                seed,
                ..PlanOptions::default()
            })
        })
        .collect();

    let mut faults = Vec::new();
    for (seed, plan) in plans.iter().enumerate() {
        assert_eq!(plan.layout.seed, seed as u64);
        let certificate = check(plan.site(), &plan.layout, &CheckOptions::default());
        for law in certificate.failed() {
            faults.push(format!("seed {seed}: {} {:?}", law.law, law.detail.first()));
        }
    }
    let streets: Vec<_> = plans.iter().map(|plan| new_streets(&plan.layout)).collect();
    for (i, a) in streets.iter().enumerate() {
        for (j, b) in streets.iter().enumerate().skip(i + 1) {
            let share = share_elsewhere(a, b, REACH).max(share_elsewhere(b, a, REACH));
            if share < LEAST_SHARE {
                faults.push(format!("seeds {i} and {j} differ in {share:.3} only"));
            }
        }
    }
    assert!(faults.is_empty(), "{name}\n{}", faults.join("\n"));
}

#[test]
fn ten_seeds_give_ten_plans_of_kotka_north() {
    ten_seeds("kotka_north");
}

#[test]
fn ten_seeds_give_ten_plans_of_the_larger_sites() {
    if long() {
        for name in ["kotka_northwest", "kotka_fields", "kotka_east"] {
            ten_seeds(name);
        }
    }
}
