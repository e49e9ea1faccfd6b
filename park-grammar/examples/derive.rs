//! Derives a park and draws it as SVG: a grammar of the library or a file, on an
//! outline of a GeoJSON file in degrees.
//!
//! `cargo run -p park-grammar --example derive -- simple_square park.geojson plan.svg [SEED]`

#[path = "../tests/outline/mod.rs"]
mod outline;

use std::error::Error;
use std::fmt::Write as _;
use std::process::ExitCode;
use std::time::Instant;

use park_grammar::geo_types::{coord, Coord, Polygon};
use park_grammar::{grammars, library, DeriveOptions, Grammar, Scene};

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
    let [grammar, park, out, rest @ ..] = arguments.as_slice() else {
        return Err("usage: derive GRAMMAR PARK.geojson OUT.svg [SEED]".into());
    };
    let grammar = match grammars::named(grammar) {
        Some(known) => known.grammar()?,
        None => Grammar::read(grammar)?,
    };
    let park = outline::outline(&std::fs::read_to_string(park)?)?;
    let options = DeriveOptions {
        seed: rest.first().map_or(Ok(0), |seed| seed.parse())?,
        ..DeriveOptions::default()
    };
    let began = Instant::now();
    let scene = grammar.derive(&park, &options)?;
    println!(
        "{out}: {} pieces, {} objects, {} volumes, {} left out, {:.0?}",
        scene.pieces.len(),
        scene.objects.len(),
        scene.volumes.len(),
        scene.skipped,
        began.elapsed()
    );
    for broken in scene.audit(&park).violations {
        println!("  {broken}");
    }
    std::fs::write(out, svg(&scene))?;
    Ok(())
}

fn svg(scene: &Scene) -> String {
    let points = || scene.pieces.iter().flat_map(|p| &p.polygon.exterior().0);
    let low = points().fold(
        coord! { x: f64::MAX, y: f64::MAX },
        |a, p| coord! { x: a.x.min(p.x), y: a.y.min(p.y) },
    );
    let high = points().fold(
        coord! { x: f64::MIN, y: f64::MIN },
        |a, p| coord! { x: a.x.max(p.x), y: a.y.max(p.y) },
    );
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{} {} {} {}\">\n",
        low.x - 2.0,
        -high.y - 2.0,
        high.x - low.x + 4.0,
        high.y - low.y + 4.0
    );
    for piece in &scene.pieces {
        let colour = library::material_named(&piece.material).map_or("#cccccc", |m| m.colour);
        shape(&mut out, &piece.polygon, colour);
    }
    for volume in &scene.volumes {
        let colour = library::barrier_named(&volume.name).map_or("#777777", |b| b.colour);
        shape(&mut out, &volume.polygon, colour);
    }
    let mut objects: Vec<_> = scene.objects.iter().collect();
    objects.sort_by(|a, b| a.height.total_cmp(&b.height));
    for object in objects {
        let Coord { x, y } = object.at;
        let turn = -object.facing.to_degrees();
        let picture = library::thing_named(&object.name).map_or_else(
            || {
                let kind = scene.kinds.iter().find(|k| k.name == object.name);
                let colour = kind.map_or("#777777", |k| k.colour.as_str());
                format!("<circle r=\"1\" fill=\"{colour}\" fill-opacity=\".85\"/>")
            },
            |thing| thing.picture.to_owned(),
        );
        let _ = writeln!(
            out,
            "<g transform=\"translate({x:.2} {:.2}) rotate({turn:.1}) scale({})\">{picture}</g>",
            -y, object.spread
        );
    }
    out + "</svg>"
}

fn shape(out: &mut String, polygon: &Polygon<f64>, colour: &str) {
    let mut path = String::new();
    for ring in std::iter::once(polygon.exterior()).chain(polygon.interiors()) {
        for (k, c) in ring.0.iter().enumerate() {
            let _ = write!(
                path,
                "{}{:.2} {:.2}",
                if k == 0 { 'M' } else { 'L' },
                c.x,
                -c.y
            );
        }
        path.push('Z');
    }
    let _ = writeln!(out, "<path d=\"{path}\" fill=\"{colour}\" fill-rule=\"evenodd\" stroke=\"#555\" stroke-width=\".06\"/>");
}
