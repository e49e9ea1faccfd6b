//! Draws the block decomposition of the README.
//!
//! `cargo run -p streamlines --example blocks` writes `images/blocks.svg` into
//! the crate.

use geo_types::{coord, polygon, Coord, LineString, Polygon};
use std::fmt::Write as _;
use streamline::{
    arm_nearest, from_fn, separatrices, tiles, Dangling, Separatrix, SeparatrixOptions,
    Singularity, TileOptions,
};

/// By how many right angles the cross turns around which points.
const SINGULAR: [(Coord<f64>, i32); 4] = [
    (Coord { x: 175., y: 150. }, -1),
    (Coord { x: 420., y: 235. }, 1),
    (Coord { x: 300., y: 110. }, 1),
    (Coord { x: 480., y: 110. }, -1),
];

fn angle(at: Coord<f64>) -> f64 {
    let seen = |(p, k): &(Coord<f64>, i32)| 0.25 * f64::from(*k) * (at.y - p.y).atan2(at.x - p.x);
    0.12 + SINGULAR.iter().map(seen).sum::<f64>()
}

fn land() -> Polygon<f64> {
    polygon!(
        exterior: [(x: 10., y: 40.), (x: 300., y: 5.), (x: 560., y: 60.), (x: 590., y: 300.), (x: 380., y: 370.), (x: 60., y: 340.)],
        interiors: [[(x: 300., y: 240.), (x: 330., y: 270.), (x: 350., y: 235.), (x: 325., y: 215.)]],
    )
}

/// A closed path; y north on paper.
fn path(ring: &LineString<f64>) -> String {
    let mut text = String::new();
    for (i, p) in ring.0.iter().skip(1).enumerate() {
        let letter = if i == 0 { "M" } else { "L" };
        let _ = write!(text, "{letter}{:.1} {:.1}", p.x, 380.0 - p.y);
    }
    text + "Z"
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let field = from_fn(land(), |at, heading| Some(arm_nearest(angle(at), heading)));
    let singular = SINGULAR.map(|(at, quarters)| Singularity { at, quarters });
    let lines = separatrices(&field, &singular, &SeparatrixOptions::default())?;
    let strings: Vec<_> = lines.iter().map(Separatrix::to_line_string).collect();
    // The only line to the hole divides nothing, but opens the block around it.
    let options = TileOptions {
        dangling: Dangling::Bridges,
        ..TileOptions::default()
    };
    let blocks = tiles(&land(), &strings, &options)?;

    let mut svg = String::from("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 600 380\" stroke-linejoin=\"round\">\n<rect width=\"600\" height=\"380\" fill=\"#fdfcf8\"/>\n");
    const COLOURS: [&str; 6] = [
        "#cfe3d4", "#f3dcb8", "#c9dbea", "#ecd0cf", "#e3e0b5", "#d9d1e8",
    ];
    // The least colour that no neighbour has.
    let mut colour: Vec<usize> = Vec::new();
    for tile in 0..blocks.tiles.len() {
        let near = blocks.neighbours(tile);
        let taken = |c: usize| near.iter().any(|&n| n < tile && colour[n] == c);
        colour.push((0..).find(|&c| !taken(c)).unwrap_or(0));
        let shape = blocks.polygon(tile);
        let rings = std::iter::once(shape.exterior()).chain(shape.interiors());
        writeln!(
            svg,
            "<path d=\"{}\" fill=\"{}\" fill-rule=\"evenodd\" stroke=\"#2a5d8a\" stroke-width=\"1.4\"/>",
            rings.map(path).collect::<String>(),
            COLOURS[colour[tile] % COLOURS.len()]
        )?;
    }
    for ring in std::iter::once(land().exterior()).chain(land().interiors()) {
        writeln!(
            svg,
            "<path d=\"{}\" fill=\"none\" stroke=\"#222\" stroke-width=\"2.2\"/>",
            path(ring)
        )?;
    }
    for (p, k) in SINGULAR {
        let fill = if k > 0 { "#c8371e" } else { "#222" };
        let c = coord! { x: p.x, y: 380.0 - p.y };
        writeln!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"4\" fill=\"{fill}\"/>",
            c.x, c.y
        )?;
    }
    svg.push_str("</svg>\n");
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("images/blocks.svg");
    std::fs::write(&file, &svg)?;
    println!(
        "images/blocks.svg: {} separatrices, {} blocks, {} bytes",
        lines.len(),
        blocks.tiles.len(),
        svg.len()
    );
    Ok(())
}
