//! Lays out every site of some folders and prints a page with a table of the
//! figures:
//! `cargo run --release -p urban-layout --example site_table -- tests/data/sites > docs/src/sites.md`.
//!
//! A site is a file `NAME.geojson`; files `NAME.LAYER.geojson` beside it are not
//! looked at. The default options are used, on one thread.

use std::path::{Path, PathBuf};
use std::time::Instant;

use urban_layout::check::{check, Certificate, CheckOptions};
use urban_layout::metrics::{metrics, Metrics};
use urban_layout::{generate, PlanOptions, Quiet, Site};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// The page around the table.
const HEAD: &str = "\
# The sites in figures

Every site of `tests/data/sites`, laid out with the default options and seed 0 on one
thread, written by

```text
cargo run --release -p urban-layout --example site_table -- tests/data/sites > docs/src/sites.md
```

More folders with sites may be named after the first. Figures are those of
[metrics.json](metrics.md); *undesirable* parcels have corners that deviate by more than
15 degrees on average or a smallest enclosing rectangle of more than 1.2 times their
area, and are given as a share of all parcels. *Laws* says whether the
[certificate](check.md) holds.
";

fn main() -> Fallible<()> {
    let folders: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    if folders.is_empty() {
        return Err("usage: site_table FOLDER...".into());
    }
    let mut rows = Vec::new();
    for folder in &folders {
        for path in sites(folder)? {
            match row(&path) {
                Ok(done) => rows.push(done),
                Err(problem) => return Err(format!("{}: {problem}", path.display()).into()),
            }
        }
    }
    println!("{HEAD}");
    figures(&rows);
    println!("\n## Where the time goes\n");
    times(&rows);
    Ok(())
}

/// What is known of one site.
struct Row {
    name: String,
    metrics: Metrics,
    certificate: Certificate,
    check_seconds: f64,
}

/// The site files of a folder, by name.
fn sites(folder: &Path) -> Fallible<Vec<PathBuf>> {
    let mut out = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
        let stem = name.as_deref().and_then(|n| n.strip_suffix(".geojson"));
        if stem.is_some_and(|stem| !stem.contains('.')) {
            out.push(path);
        }
    }
    out.sort();
    Ok(out)
}

fn row(path: &Path) -> Fallible<Row> {
    let stem = path.file_stem().unwrap_or_default();
    let name = stem.to_string_lossy().into_owned();
    eprintln!("{name}");
    let start = Instant::now();
    let site = Site::read(path)?;
    let read = start.elapsed().as_secs_f64();
    let options = PlanOptions {
        threads: 1,
        ..PlanOptions::default()
    };
    let plan = generate(&site, &options, &mut Quiet)?;
    let mut figures = metrics(&plan.layout, &site);
    let mut seconds = plan.seconds.clone();
    seconds.read = read;
    figures.seconds = Some(seconds);
    let start = Instant::now();
    let certificate = check(&site, &plan.layout, &CheckOptions::default());
    Ok(Row {
        name,
        metrics: figures,
        certificate,
        check_seconds: start.elapsed().as_secs_f64(),
    })
}

/// Prints the table of qualities.
fn figures(rows: &[Row]) {
    println!(
        "| site | km2 | parcels | parcels /km2 | in parcels % | streets % | parks and other % \
         | corners deg | box/area | undesirable % | junctions /km2 | dead ends /km2 | laws |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|");
    for row in rows {
        let m = &row.metrics;
        let undesirable = 100.0 * m.undesirable as f64 / m.parcels.max(1) as f64;
        let broken: Vec<&str> = row.certificate.failed().map(|law| law.law).collect();
        let laws = if broken.is_empty() {
            "kept".to_owned()
        } else {
            format!("broken: {}", broken.join(", "))
        };
        println!(
            "| {} | {:.3} | {} | {:.0} | {:.1} | {:.1} | {:.1} | {:.2} | {:.3} | {:.1} | {:.0} | {:.0} | {laws} |",
            row.name,
            m.site_km2,
            m.parcels,
            m.p_n,
            m.l_r,
            m.l_s,
            m.l_p + m.l_o,
            m.p_angle,
            m.p_area,
            undesirable,
            m.s_i,
            m.s_d,
        );
    }
}

/// Prints the table of times; further stages that a run names get columns too.
fn times(rows: &[Row]) {
    if cfg!(debug_assertions) {
        println!("Measured with debug assertions: a release build is faster.\n");
    }
    let mut others: Vec<&str> = Vec::new();
    for row in rows {
        for (name, _) in row.metrics.seconds.iter().flat_map(|s| &s.others) {
            if !others.contains(&name.as_str()) {
                others.push(name);
            }
        }
    }
    print!("| site | km2 | read s | split s | backtrack s | optimise s |");
    others.iter().for_each(|name| print!(" {name} s |"));
    println!(" plan s | certificate s |");
    println!("|---|{}", "--:|".repeat(7 + others.len()));
    for row in rows {
        let s = row.metrics.seconds.clone().unwrap_or_default();
        print!(
            "| {} | {:.3} | {:.3} | {:.2} | {:.2} | {:.2} |",
            row.name, row.metrics.site_km2, s.read, s.split, s.backtrack, s.optimize
        );
        for name in &others {
            let spent: f64 = s.others.iter().filter(|o| o.0 == *name).map(|o| o.1).sum();
            print!(" {spent:.2} |");
        }
        println!(" {:.2} | {:.2} |", s.total, row.check_seconds);
    }
}
