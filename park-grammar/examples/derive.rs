//! Derives parks and draws them side by side: a grammar of the library, all of them
//! (`library`), or a file, on the outlines of GeoJSON files in degrees.
//!
//! `cargo run -p park-grammar --example derive -- simple_square plans.svg 0 parks/*.geojson`
//!
//! The number is the seed. Laws that a park breaks are told with it. The guide's
//! picture of the library is
//!
//! `cargo run -p park-grammar --example derive -- library docs/images/park/library.svg 1 tests/data/parks/helsinki_makasiini.geojson`

#[path = "../tests/outline/mod.rs"]
mod outline;

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use park_grammar::geo_types::{coord, Coord};
use park_grammar::picture::PictureOptions;
use park_grammar::{grammars, DeriveOptions, Grammar, Scene};

/// Plans in a row of the sheet.
const COLUMNS: usize = 5;

/// Width and height of each.
const CELL: [f64; 2] = [460.0, 400.0];

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Faults of a grammar are shown where they stand.
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [grammar, out, seed, parks @ ..] = arguments.as_slice() else {
        return Err("usage: derive GRAMMAR OUT.svg SEED PARK.geojson...".into());
    };
    let wanted = match (grammar.as_str(), grammars::named(grammar)) {
        ("library", _) => grammars::ALL.to_vec(),
        (_, Some(known)) => vec![*known],
        (_, None) => Vec::new(),
    };
    let mut all: Vec<(&str, Grammar)> = Vec::new();
    for known in &wanted {
        all.push((known.name, known.grammar()?));
    }
    if all.is_empty() {
        all.push(("", Grammar::read(grammar)?));
    }
    let options = DeriveOptions {
        seed: seed.parse()?,
        ..DeriveOptions::default()
    };
    let mut sheet = Sheet::default();
    for (kind, grammar) in &all {
        for park in parks {
            let stem = Path::new(park).file_stem().unwrap_or_default();
            let name = if all.len() > 1 && parks.len() == 1 {
                (*kind).to_owned()
            } else {
                stem.to_string_lossy().into_owned()
            };
            sheet.derive(&name.replace('_', " "), grammar, &options, park)?;
        }
    }
    std::fs::write(out, sheet.svg())?;
    Ok(())
}

/// Plans under each other's names, and what they are drawn with.
#[derive(Default)]
struct Sheet {
    defs: BTreeMap<String, String>,
    plans: usize,
    body: String,
}

impl Sheet {
    /// Derives a park, says what came of it, and draws it.
    fn derive(
        &mut self,
        name: &str,
        grammar: &Grammar,
        options: &DeriveOptions,
        park: &str,
    ) -> Result<(), Box<dyn Error>> {
        let outline = outline::outline(&std::fs::read_to_string(park)?)?;
        let began = Instant::now();
        match grammar.derive(&outline, options) {
            Ok(scene) => {
                let (time, things) = (began.elapsed(), scene.objects.len());
                let pieces = scene.pieces.len();
                println!("{name}: {pieces} pieces, {things} things, {time:.0?}");
                for broken in scene.audit(&outline).violations {
                    println!("  {broken}");
                }
                self.add(name, &scene);
            }
            Err(error) => println!("{name}: {error}"),
        }
        Ok(())
    }

    fn add(&mut self, name: &str, scene: &Scene) {
        let corners = || scene.pieces.iter().flat_map(|p| &p.polygon.exterior().0);
        let none = coord! { x: f64::MAX, y: f64::MAX };
        let least = |a: Coord<f64>, b: &Coord<f64>| coord! { x: a.x.min(b.x), y: a.y.min(b.y) };
        let most = |a: Coord<f64>, b: &Coord<f64>| coord! { x: a.x.max(b.x), y: a.y.max(b.y) };
        let (low, high) = (corners().fold(none, least), corners().fold(-none, most));
        let prefix = format!("plan{}", self.plans);
        let drawing = scene.draw(&PictureOptions::default().with_prefix(prefix));
        self.defs.extend(drawing.defs);
        let [column, row] = [self.plans % COLUMNS, self.plans / COLUMNS];
        let (x, y) = (column as f64 * CELL[0], row as f64 * CELL[1]);
        // A centimetre a unit, around the middle, and some land around it.
        let size = (high - low) * 100.0 + coord! { x: 600.0, y: 600.0 };
        let _ = writeln!(
            self.body,
            "<text x=\"{:.0}\" y=\"{:.0}\" font-size=\"14\" font-family=\"sans-serif\">{name}</text>\n\
             <svg x=\"{x}\" y=\"{}\" width=\"{}\" height=\"{}\" viewBox=\"{} {} {} {}\">{}</svg>",
            x + 6.0,
            y + 16.0,
            y + 20.0,
            CELL[0],
            CELL[1] - 20.0,
            -0.5 * size.x,
            -0.5 * size.y,
            size.x,
            size.y,
            drawing.body
        );
        self.plans += 1;
    }

    fn svg(&self) -> String {
        let columns = self.plans.clamp(1, COLUMNS) as f64;
        let rows = self.plans.div_ceil(COLUMNS).max(1) as f64;
        let defs: String = self.defs.values().map(String::as_str).collect();
        let [width, height] = [columns * CELL[0], rows * CELL[1]];
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\">\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/><defs>{defs}</defs>\n{}</svg>\n",
            self.body
        )
    }
}
