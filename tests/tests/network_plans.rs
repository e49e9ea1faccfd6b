//! Plans of real sites whose streets come from a specification keep every law.

use urban_layout::check::{check, CheckOptions};
use urban_layout::splitter::NetworkOptions;
use urban_layout::{generate, PlanOptions, Quiet};
use urban_layout_tests::SITES;

/// The smallest site; all of them with `URBAN_LAYOUT_LONG=1`.
#[test]
fn networks_on_shipped_sites_keep_the_laws() {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    let options = PlanOptions {
        network: Some(NetworkOptions::default()),
        ..PlanOptions::default()
    };
    for shipped in SITES.iter().take(if long { SITES.len() } else { 1 }) {
        let site = shipped.site();
        let plan = generate(&site, &options, &mut Quiet).expect("a plan");
        let certificate = check(&site, &plan.layout, &CheckOptions::default());
        assert!(
            certificate.is_ok(),
            "{}: {:?}",
            shipped.name,
            certificate.failed().collect::<Vec<_>>()
        );
        let ours = plan.layout.streets.iter().filter(|s| !s.given);
        let (mut by_network, mut all) = (0, 0);
        for street in ours {
            all += 1;
            let by = street.lineage.as_ref().map(|l| l.by.as_str());
            by_network += usize::from(by == Some("network"));
        }
        assert!(
            2 * by_network > all,
            "{}: {by_network} of {all}",
            shipped.name
        );
    }
}
