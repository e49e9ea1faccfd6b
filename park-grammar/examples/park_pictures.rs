//! Draws the pictures of the guide's pages about parks and that of the crate's
//! front page, from the examples in their texts.
//!
//! `cargo run -p park-grammar --example park_pictures`

#[path = "../tests/guide/mod.rs"]
mod guide;

use std::error::Error;
use std::path::Path;

use guide::{folder, samples, PAGES};
use park_grammar::picture::PictureOptions;
use park_grammar::{DeriveOptions, Grammar, Scene};

/// Around a park, centimetres.
const MARGIN: f64 = 100.0;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = folder().ok_or("the guide is not here")?;
    let images = folder.join("images/park");
    std::fs::create_dir_all(&images)?;
    for page in PAGES {
        let text = std::fs::read_to_string(folder.join(page))?;
        for sample in samples(page, &text) {
            if sample.fault.is_some() {
                continue;
            }
            let place = format!("{}:{} {}", sample.page, sample.line, sample.name);
            let scene = sample.derive().map_err(|e| format!("{place}: {e}"))?;
            let file = images.join(format!("{}.svg", sample.name));
            std::fs::write(&file, picture(&scene))?;
            println!("{}", file.display());
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("README.md"))?;
    let rules = page
        .split_once("Grammar::new(\"")
        .and_then(|(_, rest)| rest.split_once("\")?;"));
    let (rules, _) = rules.ok_or("the front page has no grammar")?;
    let park = guide::outline("large").ok_or("there is no such outline")?;
    let scene = Grammar::new(rules)?.derive(&park, &DeriveOptions::default())?;
    std::fs::create_dir_all(root.join("images"))?;
    std::fs::write(root.join("images/square.svg"), picture(&scene))?;
    Ok(())
}

/// The park alone, without a sheet around it.
fn picture(scene: &Scene) -> String {
    let points = || scene.pieces.iter().flat_map(|p| &p.polygon.exterior().0);
    let most =
        |of: &dyn Fn(f64, f64) -> f64| points().map(|c| of(c.x, c.y)).fold(f64::MIN, f64::max);
    let width = most(&|x, _| x) + most(&|x, _| -x);
    let height = most(&|_, y| y) + most(&|_, y| -y);
    let (width, height) = (100.0 * width + 2.0 * MARGIN, 100.0 * height + 2.0 * MARGIN);
    let drawing = scene.draw(&PictureOptions::default());
    let defs: String = drawing.defs.into_values().collect();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"360\" viewBox=\"{:.0} {:.0} {width:.0} {height:.0}\">\
         <defs>{defs}</defs>{}</svg>\n",
        -0.5 * width,
        -0.5 * height,
        drawing.body
    )
}
