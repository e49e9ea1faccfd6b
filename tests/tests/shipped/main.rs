//! Every shipped site, laid out with the default options: the laws, the quality,
//! the streets, the way out to a file and back.
//!
//! One program, so that each plan is made once for all of them.

mod files;
mod laws;
mod quality;
mod streets;

use std::fmt::Write as _;
use std::sync::OnceLock;

use urban_layout::check::Certificate;
use urban_layout::{Plan, PlanOptions};
use urban_layout_tests::{Shipped, SITES};

/// The plan of a site with the default options on one thread, made once.
fn plan(shipped: Shipped) -> &'static Plan {
    static PLANS: [OnceLock<Plan>; SITES.len()] = [const { OnceLock::new() }; SITES.len()];
    let place = SITES.iter().position(|s| *s == shipped);
    PLANS[place.expect("a shipped site")].get_or_init(|| {
        shipped.plan(&PlanOptions {
            threads: 1,
            ..PlanOptions::default()
        })
    })
}

/// The laws that a certificate finds broken, with their faults, for people.
fn broken(certificate: &Certificate) -> String {
    let mut out = String::new();
    for law in certificate.failed() {
        let _ = write!(
            out,
            "\n  {}: {} (allowed {})",
            law.law, law.measured, law.allowed
        );
        for fault in law.detail.iter().take(4) {
            let _ = write!(out, "\n    {fault}");
        }
    }
    out
}
