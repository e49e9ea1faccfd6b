//! `urban-layout generate`: plans of a site, written whole or not at all.

use std::path::{Path, PathBuf};
use std::time::Instant;

use urban_layout::io::{self, svg::SvgOptions};
use urban_layout::layout::TileKind;
use urban_layout::metrics::{metrics, Metrics};
use urban_layout::{generate, Plan, Result};

use crate::args::Generate;
use crate::bar::Bar;

pub(crate) fn run(job: &Generate) -> Result<u8> {
    if job.variations == 0 {
        return Err(urban_layout::Error::usage(
            "--variations is 0; ask for at least 1",
        ));
    }
    let start = Instant::now();
    let site = job.common.read(&job.site)?;
    for warning in &site.warnings {
        eprintln!("warning: {warning}");
    }
    let read = start.elapsed().as_secs_f64();
    let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    let mut cards = Vec::new();
    let mut figures = Vec::new();
    for k in 0..job.variations {
        let folder = if job.variations == 1 {
            PathBuf::new()
        } else {
            PathBuf::from(format!("{:03}", k + 1))
        };
        let began = Instant::now();
        let plan = {
            let mut bar = Bar::new();
            generate(&site, &job.options(k)?, &mut bar)?
        };
        for warning in plan.warnings() {
            eprintln!("warning: {warning}");
        }
        if let Some(plain) = plain_parks(job, &plan) {
            eprintln!("warning: {plain}");
        }
        let m = figures_of(&plan, read, began);
        files.extend(files_of(job, &plan, &m, &job.out.join(&folder))?);
        cards.push((
            folder
                .join("layout.svg")
                .to_string_lossy()
                .replace('\\', "/"),
            m.clone(),
        ));
        figures.push(m);
    }
    if job.variations > 1 {
        let page = io::html::index(site.name.as_deref().unwrap_or("Variations"), &cards);
        files.push((job.out.join("index.html"), page.into_bytes()));
    }
    io::write::write_all_or_nothing(&files)?;
    if job.common.json {
        let all: Vec<_> = figures.iter().map(Metrics::to_json).collect();
        match all.as_slice() {
            [one] => println!("{one}"),
            _ => println!("{}", serde_json::json!({ "variations": all })),
        }
    } else {
        for m in &figures {
            println!(
                "{} parcels ({:.0} per km2), {:.1} % of the land; streets {:.1} %, parks {:.1} %; corners {:.1} deg off, box/area {:.3}, {} undesirable; {:.2} s",
                m.parcels, m.p_n, m.l_r, m.l_s, m.l_p, m.p_angle, m.p_area, m.undesirable,
                m.seconds.as_ref().map_or(0.0, |s| s.total),
            );
        }
        println!("written to {}", job.out.display());
    }
    Ok(0)
}

/// What to say where a grammar that was asked for suits some parks only.
fn plain_parks(job: &Generate, plan: &Plan) -> Option<String> {
    if matches!(job.park_grammar.as_str(), "auto" | "none") {
        return None;
    }
    let parks = plan.layout.tiles_of(TileKind::Park);
    let (all, designed) = (
        parks.filter(|tile| !tile.given).count(),
        plan.layout.parks.len(),
    );
    (designed < all).then(|| {
        format!(
            "{} suits {designed} of {all} parks; the others stay plain",
            job.park_grammar
        )
    })
}

fn figures_of(plan: &Plan, read: f64, began: Instant) -> Metrics {
    let mut m = metrics(&plan.layout, plan.site());
    let mut seconds = plan.seconds.clone();
    seconds.read = read;
    seconds.total = read + began.elapsed().as_secs_f64();
    m.seconds = Some(seconds);
    m
}

fn files_of(
    job: &Generate,
    plan: &Plan,
    m: &Metrics,
    folder: &Path,
) -> Result<Vec<(PathBuf, Vec<u8>)>> {
    let site = plan.site();
    let svg = io::svg::svg(&plan.layout, site, &SvgOptions::default());
    let json = serde_json::to_string_pretty(&m.to_json())
        .map_err(|e| urban_layout::Error::stage("metrics", e))?;
    let mut files = vec![
        (
            folder.join("layout.geojson"),
            io::layout_geojson::layout_to_geojson(&plan.layout, &site.frame).into_bytes(),
        ),
        (folder.join("metrics.json"), (json + "\n").into_bytes()),
    ];
    // Even without a park: one that lies there from before is of another plan.
    let parks = io::park_geojson::parks_to_geojson(&plan.layout, &site.frame);
    files.push((folder.join("parks.geojson"), parks.into_bytes()));
    if job.png {
        files.push((folder.join("layout.png"), super::png(&svg, "layout.svg")?));
    }
    files.push((folder.join("layout.svg"), svg.into_bytes()));
    Ok(files)
}
