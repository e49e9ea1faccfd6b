//! The certificate of every shipped site.

use urban_layout::check::{check, CheckOptions};
use urban_layout_tests::Shipped;

use crate::{broken, plan};

fn keeps_the_laws(name: &str) {
    let plan = plan(Shipped::named(name));
    let certificate = check(plan.site(), &plan.layout, &CheckOptions::default());
    assert!(certificate.is_ok(), "{name}{}", broken(&certificate));
    assert_eq!(certificate.without_access, Vec::<u64>::new(), "{name}");
    assert!(certificate.components >= 1, "{name} has no street");
}

#[test]
fn kotka_north_keeps_the_laws() {
    keeps_the_laws("kotka_north");
}

#[test]
fn kotka_northwest_keeps_the_laws() {
    keeps_the_laws("kotka_northwest");
}

#[test]
fn kotka_fields_keeps_the_laws() {
    keeps_the_laws("kotka_fields");
}

#[test]
fn kotka_east_keeps_the_laws() {
    keeps_the_laws("kotka_east");
}

#[test]
fn kotka_district_keeps_the_laws() {
    keeps_the_laws("kotka_district");
}
