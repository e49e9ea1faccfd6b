//! The machinery of UrbanFab's comparison: the example's own files, on a shipped
//! site and on shapes whose figures are known. Whether the paper's findings hold
//! is measured, and not asserted.

#[path = "../examples/urbanfab_comparison/cases.rs"]
mod cases;
#[path = "../examples/urbanfab_comparison/findings.rs"]
mod findings;
#[path = "../examples/urbanfab_comparison/page.rs"]
mod page;
#[path = "../examples/urbanfab_comparison/sheet.rs"]
mod sheet;

use cases::{corners, study, Case, Setting, DESIGNS};
use findings::{Compared, Figures};
use urban_layout::io::svg::{streamlines_svg, StreamlineSvgOptions};
use urban_layout::site::Units;
use urban_layout::Site;

fn kotka() -> Site {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    Site::read(folder.join("../tests/data/sites/kotka_fields.geojson")).expect("a shipped site")
}

fn metres(text: &str) -> Site {
    let text = format!(r#"{{"type": "Polygon", "coordinates": [{text}]}}"#);
    Site::from_geojson(&text, Units::Metres).expect("a site")
}

#[test]
fn a_shipped_site_is_compared() {
    let (site, setting) = (kotka(), Setting::default());
    let cases = study(&site, &setting, &DESIGNS).expect("fields");
    let rows: Vec<_> = cases.iter().map(Case::figures).collect();
    let text = page::of_site("kotka_fields", &site, &setting, &cases, &rows);
    // D- and B-fields there are on every site.
    let [Some(d), Some(inside), Some(everywhere), Some(strong), Some(weak), _] = rows[..] else {
        panic!("{text}");
    };
    for row in [d, inside, everywhere, strong, weak] {
        let totals = row.totals;
        // The tiles are the land, whatever the lines.
        assert!((totals.area / site.area() - 1.0).abs() < 1e-9);
        assert!(totals.lines > 20 && totals.tiles > 100, "{text}");
        for share in [row.triangles, row.short, totals.parallelism.measured] {
            assert!((0.0..=1.0).contains(&share));
        }
        // A shorter detect region never sees more turns.
        assert!(row.sharp_turns <= totals.continuity.mean);
    }
    let compared = Compared::new(&rows).expect("all fields");
    let found = compared.findings();
    let table = page::of_findings(&[("kotka_fields".to_owned(), compared)]);
    for finding in &found {
        assert_eq!(table.matches(finding.claim).count(), 1, "{}", finding.claim);
    }
    let verdicts = table.matches("| holds (").count() + table.matches("does not hold").count();
    assert_eq!(verdicts, found.len());
    for page in [&text, &table] {
        assert!(!page.contains("NaN") && !page.contains("inf"), "{page}");
    }
    // The same again, without the H-field, which takes its time.
    let row = |case: &Case, row: &Option<Figures>| {
        let figures = row.expect("a field");
        (case.design.key, figures.totals, figures.triangles)
    };
    let before: Vec<_> = cases[..5]
        .iter()
        .zip(&rows)
        .map(|(c, r)| row(c, r))
        .collect();
    let again = study(&site, &setting, &DESIGNS[..5]).expect("fields");
    let after: Vec<_> = again.iter().map(|c| row(c, &c.figures())).collect();
    assert_eq!(before, after);
    assert!(page::opening(&setting).contains("300 rounds"));
}

/// On a rectangle all fields are the same grid: nothing differs, so no
/// comparison holds, and no field has singularities.
#[test]
fn no_strict_finding_holds_on_a_rectangle() {
    let site = metres("[[0, 0], [600, 0], [600, 400], [0, 400], [0, 0]]");
    let setting = Setting::default();
    let cases = study(&site, &setting, &DESIGNS[..5]).expect("fields");
    let rows: Vec<_> = cases.iter().map(Case::figures).collect();
    let [Some(d), Some(inside), Some(everywhere), Some(strong), Some(weak)] = rows[..] else {
        panic!("fields are missing");
    };
    for row in [d, inside, everywhere, strong, weak] {
        assert_eq!(
            (row.totals.singularities, row.triangles, row.short),
            (0, 0.0, 0.0)
        );
        assert!(row.totals.divergence.mean < 1e-9 && row.near_parallelism < 1e-9);
    }
    // Rounding alone could order figures that are all 0.
    let round = |mut row: Figures| {
        row.totals.divergence.mean = 0.0;
        row.totals.parallelism.mean = 0.0;
        row.near_parallelism = 0.0;
        row.field_divergence = 0.0;
        Some(row)
    };
    let rounded = [d, inside, everywhere, strong, weak].map(round);
    let compared = Compared::new(&rounded).expect("all fields");
    for finding in compared.findings() {
        assert!(!finding.holds, "{}: {:?}", finding.claim, finding.figures);
    }
}

/// A triangle has no H-field, and the page says why.
#[test]
fn a_field_that_is_not_there_is_explained() {
    let site = metres("[[0, 0], [420, 20], [150, 330], [0, 0]]");
    let setting = Setting::default();
    let cases = study(&site, &setting, &DESIGNS).expect("fields");
    let rows: Vec<_> = cases.iter().map(Case::figures).collect();
    assert!(rows[..5].iter().all(Option::is_some) && rows[5].is_none());
    let text = page::of_site("triangle", &site, &setting, &cases, &rows);
    assert!(text.contains("\nNo H-field: "), "{text}");
    // Without a D-field there is nothing to find.
    assert!(Compared::new(&rows).is_some());
    assert!(Compared::new(&[None, rows[1], rows[2], rows[3], rows[4]]).is_none());
    assert_eq!(page::of_findings(&[]).lines().count(), 7);
}

#[test]
fn findings_follow_their_figures() {
    let with = |divergence: f64, singularities: usize, spread: f64| {
        let mut figures = Figures::default();
        figures.totals.divergence.mean = divergence;
        figures.totals.singularities = singularities;
        figures.totals.convexity.deviation = spread;
        figures
    };
    let compared = Compared {
        d: with(0.004, 9, 0.03),
        inside: with(0.002, 9, 0.02),
        everywhere: with(0.0035, 6, 0.02),
        strong: with(0.003, 4, 0.02),
        weak: with(0.001, 1, 0.01),
    };
    let found = compared.findings();
    let holds = |words: &str| {
        let mut fitting = found.iter().filter(|f| f.claim.starts_with(words));
        let one = fitting.next().expect("a finding");
        assert!(fitting.next().is_none());
        one.holds
    };
    assert!(holds("B-fields have lower divergence"));
    assert!(!holds("... and than both"), "3 is more than 2");
    assert!(holds("Smoothing, inside or everywhere, lowers"));
    assert!(holds("Smoothing everywhere lowers the number"));
    assert!(!holds("... inside alone"), "9 and 9");
    assert!(holds("B-fields have fewer"));
    assert!(holds("Singularities remain"));
    assert!(holds("Convexity spreads"));
    assert_eq!(
        found[0].figures,
        ["4.000", "2.000", "3.500", "3.000", "1.000"]
    );
}

#[test]
fn corners_of_tiles() {
    let ring = |points: &[(f64, f64)]| -> Vec<geo_types::Coord<f64>> {
        points.iter().map(|&p| p.into()).collect()
    };
    // A vertex on a straight side, and one that bends by 11 degrees.
    let triangle = ring(&[(0., 0.), (5., 0.), (10., 1.), (0., 9.), (0., 0.)]);
    assert_eq!(corners(&triangle), 3);
    let square = ring(&[(0., 0.), (9., 0.), (9., 9.), (0., 9.), (0., 0.)]);
    assert_eq!(corners(&square), 4);
    assert_eq!(corners(&[]), 0);
}

#[test]
fn sheets_hold_all_pictures() {
    let site = metres("[[0, 0], [600, 0], [600, 400], [0, 400], [0, 0]]");
    let cases = study(&site, &Setting::default(), &DESIGNS[..5]).expect("fields");
    let picture = |case: &Case| {
        let measured = case.measured.as_ref()?;
        let options = StreamlineSvgOptions::default();
        Some(streamlines_svg(&measured.study, &site, &options))
    };
    let pictures: Vec<_> = cases.iter().filter_map(picture).collect();
    let sheet = sheet::beside(&pictures);
    assert_eq!(sheet.matches("<svg").count(), pictures.len() + 1);
    assert_eq!(sheet.matches("</svg>").count(), pictures.len() + 1);
    assert!(!sheet.contains("NaN"));
}
