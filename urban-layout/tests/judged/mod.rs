//! A sound town, spoilt, and the laws that it breaks then.

use urban_layout::check::{check, Certificate, CheckOptions};
use urban_layout::layout::Layout;
use urban_layout::site::Site;

use crate::synthetic::Town;

/// What is said of a town that was spoilt.
pub(crate) fn judged(spoil: impl FnOnce(&mut Site, &mut Layout)) -> Certificate {
    let (mut site, mut layout) = Town::default().build();
    spoil(&mut site, &mut layout);
    check(&site, &layout, &CheckOptions::default())
}

/// The laws that fail.
pub(crate) fn failed(certificate: &Certificate) -> Vec<&'static str> {
    certificate.failed().map(|law| law.law).collect()
}

/// Asserts that exactly these laws fail, and that each says why.
pub(crate) fn breaks(laws: &[&str], spoil: impl FnOnce(&mut Site, &mut Layout)) {
    let certificate = judged(spoil);
    assert_eq!(failed(&certificate), laws, "{certificate}");
    for law in certificate
        .failed()
        .filter(|law| !["overlap", "gap", "spill"].contains(&law.law))
    {
        assert!(!law.detail.is_empty(), "{} has no detail", law.law);
    }
}
