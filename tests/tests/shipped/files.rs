//! The same bytes from any number of threads, and back from them.

use urban_layout::check::{check, read_layout, CheckOptions};
use urban_layout::io::layout_geojson::layout_to_geojson;
use urban_layout::io::svg::{svg, SvgOptions};
use urban_layout::metrics::metrics;
use urban_layout::{Plan, PlanOptions};
use urban_layout_tests::SITES;

use crate::{broken, plan};

/// The files of a plan that must not depend on anything but site and options.
fn files(plan: &Plan) -> [String; 2] {
    [
        layout_to_geojson(&plan.layout, &plan.site().frame),
        svg(&plan.layout, plan.site(), &SvgOptions::default()),
    ]
}

#[test]
fn one_thread_and_two_write_the_same_bytes() {
    for shipped in SITES {
        let two = shipped.plan(&PlanOptions {
            threads: 2,
            ..PlanOptions::default()
        });
        let [layout, picture] = files(plan(shipped));
        let [layout_of_two, picture_of_two] = files(&two);
        // Not assert_eq: a megabyte of difference helps nobody.
        assert!(layout == layout_of_two, "{}: layout.geojson", shipped.name);
        assert!(picture == picture_of_two, "{}: layout.svg", shipped.name);
    }
}

#[test]
fn a_layout_read_back_is_as_good_as_before() {
    for shipped in SITES {
        let plan = plan(shipped);
        let site = plan.site();
        let text = layout_to_geojson(&plan.layout, &site.frame);
        let back = read_layout(&text, &site.frame).expect("what was written is read");
        let certificate = check(site, &back, &CheckOptions::default());
        assert!(
            certificate.is_ok(),
            "{}{}",
            shipped.name,
            broken(&certificate)
        );

        let (before, after) = (metrics(&plan.layout, site), metrics(&back, site));
        assert_eq!(before.parcels, after.parcels, "{}", shipped.name);
        assert_eq!(before.undesirable, after.undesirable, "{}", shipped.name);
        assert_eq!(before.seed, after.seed, "{}", shipped.name);
        // Nine decimals of a degree are 0.1 mm; a share of land or a mean angle
        // moves by far less than these.
        let pairs = [
            (before.l_s, after.l_s, 1e-4),
            (before.l_r, after.l_r, 1e-4),
            (before.l_p, after.l_p, 1e-4),
            (before.b_avg, after.b_avg, 1e-2),
            (before.s_l, after.s_l, 1e-4),
            (before.p_angle, after.p_angle, 1e-2),
            (before.p_area, after.p_area, 1e-4),
        ];
        for (i, (a, b, tolerance)) in pairs.into_iter().enumerate() {
            assert!(
                (a - b).abs() < tolerance,
                "{} figure {i}: {a} {b}",
                shipped.name
            );
        }
        // Figures are of the geometry before its coordinates were rounded, so one
        // may differ in its last digit; read and written again, not a byte changes.
        let text = layout_to_geojson(&back, &site.frame);
        let back = read_layout(&text, &site.frame).expect("what was written is read");
        let again = layout_to_geojson(&back, &site.frame);
        for (old, new) in text.lines().zip(again.lines()) {
            assert_eq!(old, new, "{}", shipped.name);
        }
        assert_eq!(text.len(), again.len(), "{}", shipped.name);
    }
}
