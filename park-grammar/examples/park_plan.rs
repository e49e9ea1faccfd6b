//! Draws the plan of a park: a grammar's file, an outline in GeoJSON (degrees or
//! metres), a seed.
//!
//! `cargo run -p park-grammar --example park_plan -- GRAMMAR OUTLINE [SEED] > plan.svg`
//!
//! Laws that the park breaks are told on standard error.

use park_grammar::geo_types::{coord, Coord, LineString, Polygon};
use park_grammar::picture::{SheetOptions, ViewersFont};
use park_grammar::{DeriveOptions, Grammar};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [grammar, file, rest @ ..] = words.as_slice() else {
        return Err("name a grammar and an outline".into());
    };
    let outline = outline(&std::fs::read_to_string(file)?)?;
    let options = DeriveOptions {
        seed: rest.first().map_or(Ok(0), |seed| seed.parse())?,
        ..DeriveOptions::default()
    };
    let park = Grammar::read(grammar)?.derive(&outline, &options)?;
    for violation in park.audit(&outline).violations {
        eprintln!("{violation}");
    }
    let stem = |path: &str| {
        let stem = std::path::Path::new(path).file_stem();
        stem.unwrap_or_default().to_string_lossy().replace('_', " ")
    };
    let sheet = SheetOptions::default()
        .with_title(stem(file))
        .with_subtitle(format!("{}, seed {}", stem(grammar), options.seed));
    print!("{}", park.sheet(&sheet, &ViewersFont));
    Ok(())
}

/// The first polygon of a GeoJSON text, degrees made metres around its middle.
fn outline(text: &str) -> Result<Polygon<f64>, String> {
    let missing = "there are no coordinates";
    let start = text.find("\"coordinates\"").ok_or(missing)?;
    let (mut depth, mut rings, mut number) = (0_i32, Vec::<Vec<f64>>::new(), String::new());
    for c in text[start + 13..].chars() {
        match c {
            '[' => {
                depth += 1;
                if depth == 2 {
                    rings.push(Vec::new());
                }
            }
            c if c.is_ascii_digit() || "+-.eE".contains(c) => number.push(c),
            _ => {
                if let (Ok(value), Some(ring)) = (number.parse(), rings.last_mut()) {
                    ring.push(value);
                }
                number.clear();
                if c == ']' {
                    depth -= 1;
                    if depth == 0 {
                        break;
                    }
                }
            }
        }
    }
    let all: Vec<Coord<f64>> = rings
        .iter()
        .flat_map(|ring| ring.chunks_exact(2))
        .map(|p| coord! { x: p[0], y: p[1] })
        .collect();
    let first = *all.first().ok_or(missing)?;
    let degrees = !text.contains("metres");
    let place = |p: &[f64]| {
        let c = coord! { x: p[0], y: p[1] };
        if !degrees {
            return c;
        }
        let metres = 111_320.0;
        coord! { x: (c.x - first.x) * metres * first.y.to_radians().cos(), y: (c.y - first.y) * metres }
    };
    let mut rings = rings
        .iter()
        .map(|ring| LineString(ring.chunks_exact(2).map(place).collect()));
    let exterior = rings.next().ok_or(missing)?;
    Ok(Polygon::new(exterior, rings.collect()))
}
