//! Draws the picture of evenly placed streets.
//!
//! `cargo run -p streamlines --example even_streets` writes
//! `images/even_streets.svg` into the crate: blocks of 32 by 64 units around
//! two singularities, denser towards the south-west, every street ending at the
//! boundary or in a T-junction.

use std::fmt::Write as _;
use streamline::geo_types::{coord, polygon, Coord, Polygon, Rect};
use streamline::{
    arm_nearest, from_fn, lattice, place_scaled, Ends, PlacementOptions, Stop, Streamline,
    TraceOptions,
};

const CENTRES: [(Coord<f64>, f64); 2] = [
    (Coord { x: 205., y: 150. }, -1.0),
    (Coord { x: 430., y: 235. }, 1.0),
];

fn angle(at: Coord<f64>) -> f64 {
    let turn = |(p, index): &(Coord<f64>, f64)| 0.25 * index * (at.y - p.y).atan2(at.x - p.x);
    0.12 + CENTRES.iter().map(turn).sum::<f64>()
}

fn land() -> Polygon<f64> {
    polygon![(x: 10., y: 40.), (x: 300., y: 5.), (x: 560., y: 60.), (x: 590., y: 300.), (x: 380., y: 370.), (x: 60., y: 340.)]
}

fn path(points: &[Coord<f64>]) -> String {
    let mut text = String::new();
    for (i, p) in points.iter().enumerate() {
        // y north on paper.
        let _ = write!(
            text,
            "{}{:.1} {:.1}",
            if i == 0 { "M" } else { "L" },
            p.x,
            380.0 - p.y
        );
    }
    text
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let field = from_fn(land(), |at, heading| Some(arm_nearest(angle(at), heading)));
    let extent = Rect::new(coord! { x: 0., y: 0. }, coord! { x: 600., y: 380. });
    let seeds = lattice(&field, extent, 6.0)?;
    let options = PlacementOptions {
        separation: [32.0, 64.0],
        test: 0.7,
        ends: Ends::Junction,
        trace: TraceOptions {
            step: 3.0,
            ..PlacementOptions::default().trace
        },
        ..PlacementOptions::default()
    };
    let scale = |at: Coord<f64>| 0.45 + 0.55 * ((at.x + at.y) / 900.0).clamp(0.0, 1.0);
    let lines = place_scaled(&field, &seeds, &options, &scale)?;

    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 600 380\" width=\"900\" height=\"570\">\n<rect width=\"600\" height=\"380\" fill=\"#fff\"/>\n",
    );
    writeln!(
        svg,
        "<path d=\"{}Z\" fill=\"#f3efe6\" stroke=\"#555\" stroke-width=\"1.5\"/>",
        path(&land().exterior().0)
    )?;
    for line in &lines {
        let (colour, width) = if line.family == 0 {
            ("#2b5c8a", 1.6)
        } else {
            ("#b5562b", 1.6)
        };
        writeln!(
            svg,
            "<path d=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>",
            path(&line.simplify(0.05).points)
        )?;
    }
    for (stop, end) in lines.iter().flat_map(ends) {
        if matches!(stop, Stop::Junction { .. }) {
            writeln!(
                svg,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.4\" fill=\"#222\"/>",
                end.x,
                380.0 - end.y
            )?;
        }
    }
    svg.push_str("</svg>\n");
    let target = concat!(env!("CARGO_MANIFEST_DIR"), "/images/even_streets.svg");
    std::fs::write(target, svg)?;
    println!("{} lines in {target}", lines.len());
    Ok(())
}

fn ends(line: &Streamline) -> impl Iterator<Item = (Stop, Coord<f64>)> + '_ {
    let first = line.points.first().map(|&p| (line.start, p));
    let last = line.points.last().map(|&p| (line.end, p));
    first.into_iter().chain(last)
}
