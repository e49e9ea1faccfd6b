//! Draws the picture of the README.
//!
//! `cargo run -p streamlines --example pictures` writes
//! `images/candidates.svg` into the crate.

use geo_types::{coord, polygon, Coord, Polygon};
use std::fmt::Write as _;
use streamline::{
    arm_nearest, candidates, distinct, from_fn, rank, BoundaryDistance, BoundaryOptions,
    CandidateOptions, Cursor, DirectionField, Divergence, Score, Seed, SingularityDistance,
    Streamline, TraceOptions, WidthTable,
};

/// Two singularities: the cross turns by minus a quarter around the one and by
/// plus a quarter around the other.
const SINGULAR: [(Coord<f64>, f64); 2] = [
    (Coord { x: 205., y: 150. }, -1.0),
    (Coord { x: 420., y: 235. }, 1.0),
];

fn angle(at: Coord<f64>) -> f64 {
    0.12 + SINGULAR
        .iter()
        .map(|(p, index)| 0.25 * index * (at.y - p.y).atan2(at.x - p.x))
        .sum::<f64>()
}

fn land() -> Polygon<f64> {
    polygon!(
        exterior: [(x: 10., y: 40.), (x: 300., y: 5.), (x: 560., y: 60.), (x: 590., y: 300.), (x: 380., y: 370.), (x: 60., y: 340.)],
        interiors: [[(x: 300., y: 240.), (x: 330., y: 270.), (x: 350., y: 235.), (x: 325., y: 215.)]],
    )
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
    let mut seeds = Vec::new();
    for i in 0..75 {
        for j in 0..48 {
            let at = coord! { x: 8.0 * i as f64 + 1.0, y: 8.0 * j as f64 + 3.0 };
            if let Some(arm) = field.direction(at, coord! { x: 1., y: 0. }, &mut Cursor::default())
            {
                seeds.push(Seed {
                    at,
                    directions: [arm, coord! { x: -arm.y, y: arm.x }],
                });
            }
        }
    }
    // Coarser than the default of 9 m, so that single lines can be seen.
    let trace = TraceOptions {
        step: 8.0,
        ..TraceOptions::default()
    };
    let lines = candidates(
        &field,
        &seeds,
        &CandidateOptions {
            separation: 12.0,
            trace,
            ..CandidateOptions::default()
        },
    )?;

    let land = land();
    let rings: Vec<_> = std::iter::once(land.exterior())
        .chain(land.interiors())
        .collect();
    let walls: Vec<_> = rings
        .iter()
        .flat_map(|ring| ring.lines())
        .map(|side| (side.start, side.end, 0.0))
        .collect();
    let boundary = BoundaryDistance::new(
        &walls,
        WidthTable::new(&[45.0, 75.0], 600.0, 0.1),
        BoundaryOptions::default(),
    );
    let singular = SingularityDistance {
        singularities: SINGULAR.map(|s| s.0).to_vec(),
    };
    let divergence = Divergence::default();
    let scores: [(&dyn Score, f64); 3] = [(&divergence, 1.0), (&boundary, 1.0), (&singular, 1.0)];
    let ranked = rank(&lines, &field, &scores);
    let worst = ranked.last().map_or(1.0, |r| r.total);

    let mut svg = String::from("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 600 380\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<rect width=\"600\" height=\"380\" fill=\"#fdfcf8\"/>\n");
    let draw = |line: &Streamline| path(&line.simplify(0.3).points);
    // The worst first, so that the best lie on top.
    for r in ranked.iter().rev() {
        let t = (r.total / worst).clamp(0.0, 1.0);
        let mix = |good: f64, bad: f64| (good + (bad - good) * t.sqrt()).round();
        let colour = format!(
            "#{:02x}{:02x}{:02x}",
            mix(20.0, 226.0) as u8,
            mix(94.0, 205.0) as u8,
            mix(168.0, 178.0) as u8
        );
        writeln!(
            svg,
            "<path d=\"{}\" stroke=\"{colour}\" stroke-width=\"0.9\"/>",
            draw(&lines[r.index])
        )?;
    }
    for &index in distinct(&lines, &ranked, 45.0).iter().take(3) {
        writeln!(
            svg,
            "<path d=\"{}\" stroke=\"#c8371e\" stroke-width=\"3\"/>",
            draw(&lines[index])
        )?;
    }
    for (p, _) in SINGULAR {
        writeln!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"4\" fill=\"#222\"/>",
            p.x,
            380.0 - p.y
        )?;
    }
    for ring in rings {
        writeln!(
            svg,
            "<path d=\"{}Z\" stroke=\"#222\" stroke-width=\"1.6\"/>",
            path(&ring.0)
        )?;
    }
    svg.push_str("</svg>\n");
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("images/candidates.svg");
    std::fs::write(&file, &svg)?;
    println!(
        "images/candidates.svg: {} lines, {} bytes",
        lines.len(),
        svg.len()
    );
    Ok(())
}
