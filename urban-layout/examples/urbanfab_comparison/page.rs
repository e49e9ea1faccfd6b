//! The tables as a page of Markdown.

use std::fmt::Write as _;

use streamline::{compare_criteria, Criteria};
use urban_layout::Site;

use crate::cases::{Case, Setting};
use crate::findings::{Compared, Figures};

/// What stands above the sites.
pub(crate) fn opening(setting: &Setting) -> String {
    format!(
        "# UrbanFab's comparison\n\nSix fields on each site: lines 1/{:.0} of the square root of the area apart, meshes of edges of 1/40 of it, \
         {} rounds of smoothing, turns of 20 degrees within half a separation. Best figures in bold.\n",
        setting.lines, setting.rounds
    )
}

/// The figures of one site.
pub(crate) fn of_site(
    name: &str,
    site: &Site,
    setting: &Setting,
    cases: &[Case],
    rows: &[Option<Figures>],
) -> String {
    let mut text = format!(
        "\n## {name}\n\n{:.2} km2, lines {:.0} m apart.\n\n",
        site.area() / 1e6,
        setting.separation(site)
    );
    let measured = || {
        let known = cases.iter().zip(rows);
        known.filter_map(|(case, row)| Some((case, case.measured.as_ref()?, row.as_ref()?)))
    };
    let named = measured().map(|(case, m, _)| (case.design.name, &m.study.criteria));
    text.push_str(&compare_criteria(named.collect::<Vec<(&str, &Criteria)>>()).to_markdown());
    text.push_str(
        "\n| | median div along lines 1/km | div of the field 1/km | off parallel within a separation deg | turns within 4 m 1/km | triangles at the boundary % | short lines from boundary to boundary % | parallelism measured % | convexity by area |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for (case, _, row) in measured() {
        let _ = writeln!(
            text,
            "| {} | {:.3} | {:.3} | {:.1} | {:.3} | {:.1} | {:.1} | {:.0} | {:.4} |",
            case.design.name,
            row.median_divergence * 1e3,
            row.field_divergence * 1e3,
            row.near_parallelism * 90.0,
            row.sharp_turns * 1e3,
            row.triangles * 100.0,
            row.short * 100.0,
            row.totals.parallelism.measured * 100.0,
            row.totals.convexity.area_mean,
        );
    }
    for case in cases {
        if let Some(refusal) = &case.refusal {
            let _ = writeln!(text, "\nNo {}: {refusal}.", case.design.name);
        }
    }
    text
}

/// Every finding on every site, with the figures of all fields but the H-field.
pub(crate) fn of_findings(sites: &[(String, Compared)]) -> String {
    let mut text = String::from(
        "\n## The findings\n\nIn brackets the figures of the D-field, of that smoothed inside and everywhere, of the strong and the weak B-field.\n\n| the paper says |",
    );
    for (name, _) in sites {
        let _ = write!(text, " {name} |");
    }
    let _ = writeln!(text, "\n|---|{}", "---|".repeat(sites.len()));
    let found: Vec<_> = sites.iter().map(|(_, of)| of.findings()).collect();
    let claims = found.first().map_or(&[][..], |first| first);
    for (row, finding) in claims.iter().enumerate() {
        let _ = write!(text, "| {} |", finding.claim);
        for of_site in &found {
            let finding = &of_site[row];
            let verdict = if finding.holds {
                "holds"
            } else {
                "**does not hold**"
            };
            let _ = write!(text, " {verdict} ({}) |", finding.figures.join(", "));
        }
        text.push('\n');
    }
    text
}
