//! Which street divides this block best? Candidates, the four scores, a choice.
//!
//! `cargo run -p streamlines --example choose_street`

use geo_types::{coord, polygon};
use streamline::{
    arm_nearest, candidates, choose, distinct, from_fn, rank, BoundaryDistance, BoundaryOptions,
    CandidateOptions, Continuity, Divergence, Score, Seed, SingularityDistance, WidthTable,
};

fn main() -> Result<(), streamline::TraceError> {
    // A bent strip of land, 300 m by 165 m, and a cross that follows its bend.
    let land = polygon![(x: 0., y: 0.), (x: 300., y: 30.), (x: 285., y: 195.), (x: 0., y: 165.)];
    let walls: Vec<_> = land
        .exterior()
        .lines()
        .map(|side| (side.start, side.end, 0.0))
        .collect();
    let field = from_fn(land, |at, heading| {
        Some(arm_nearest(0.1 * (at.x / 95.0).sin(), heading))
    });

    let mut seeds = Vec::new();
    for i in 1..30 {
        for j in 1..20 {
            let at = coord! { x: 10.0 * i as f64, y: 10.0 * j as f64 };
            seeds.push(Seed {
                at,
                directions: [coord! { x: 1., y: 0. }, coord! { x: 0., y: 1. }],
            });
        }
    }
    let lines = candidates(&field, &seeds, &CandidateOptions::default())?;

    // Rows of one or two parcels of 30 m, with their share of a 15 m street.
    let table = WidthTable::new(&[37.5, 75.0], 600.0, 0.1);
    let boundary = BoundaryDistance::new(&walls, table, BoundaryOptions::default());
    let divergence = Divergence::default();
    let singularity = SingularityDistance::default();
    // A street arrives from the west.
    let continuity = Continuity {
        ends: vec![(coord! { x: 0., y: 82. }, coord! { x: 1., y: 0. })],
        ..Continuity::default()
    };
    let scores: [&dyn Score; 4] = [&divergence, &boundary, &singularity, &continuity];
    let ranked = rank(&lines, &field, &scores.map(|score| (score, 1.0)));

    println!(
        "{} seeds, {} candidates; the best five:",
        seeds.len(),
        lines.len()
    );
    println!(
        "{:>6} {:>8} {:>7}  {}",
        "line",
        "length",
        "total",
        scores.map(|s| format!("{:>13}", s.name())).join("")
    );
    for r in ranked.iter().take(5) {
        let raw: String = r.raw.iter().map(|cost| format!("{cost:>13.4}")).collect();
        println!(
            "{:>6} {:>6.0} m {:>7.3}  {raw}",
            r.index,
            lines[r.index].length(),
            r.total
        );
    }
    println!(
        "{} of them lie at least 20 m apart",
        distinct(&lines, &ranked, 20.0).len()
    );
    for seed in 0..3 {
        if let Some(place) = choose(&ranked, seed, 0.5) {
            println!("seed {seed} chooses place {} of the ranking", place + 1);
        }
    }
    Ok(())
}
