//! Draws a distance, a boundary and a harmonic field of each site and prints
//! what they are compared by:
//! `cargo run --release --example field_gallery -- SITES_FOLDER OUT_FOLDER`.
//!
//! Writes `SITE-FIELD.svg`, land shaded by divergence under dense streamlines;
//! a field that a site does not admit is said to be missing.

use std::path::{Path, PathBuf};

use crossfield::{compare, Field};
use urban_layout::field::{FieldOptions, FieldStudy};
use urban_layout::io::svg::field_svg;
use urban_layout::io::write::write_all_or_nothing;
use urban_layout::{FieldKind, Site};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words = std::env::args_os().skip(1).map(PathBuf::from);
    let (Some(sites), Some(out)) = (words.next(), words.next()) else {
        return Err("usage: field_gallery SITES_FOLDER OUT_FOLDER".into());
    };
    let mut paths: Vec<PathBuf> = std::fs::read_dir(&sites)?
        .map(|entry| entry.map(|e| e.path()))
        .collect::<Result<_, _>>()?;
    paths.retain(|path| path.extension().is_some_and(|e| e == "geojson"));
    paths.sort();
    for path in paths {
        draw(&path, &out)?;
    }
    Ok(())
}

fn draw(path: &Path, out: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let site = Site::read(path)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    println!("{stem}");
    let mut files = Vec::new();
    let mut fields: Vec<(&str, Field)> = Vec::new();
    for kind in [
        FieldKind::Distance,
        FieldKind::Boundary,
        FieldKind::Harmonic,
    ] {
        let options = FieldOptions {
            kind,
            ..FieldOptions::default()
        };
        match FieldStudy::new(&site, &options) {
            Ok(study) => {
                let file = out.join(format!("{stem}-{}.svg", kind.as_str()));
                files.push((file, field_svg(&study, &site).into_bytes()));
                if let Some(field) = study.fields.into_iter().next() {
                    fields.push((kind.as_str(), field));
                }
            }
            Err(error) => println!("  {}: {error}", kind.as_str()),
        }
    }
    let named: Vec<(&str, &Field)> = fields.iter().map(|(name, f)| (*name, f)).collect();
    println!("{}", compare(&named)?);
    write_all_or_nothing(&files)?;
    Ok(())
}
