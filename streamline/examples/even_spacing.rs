//! How evenly are lines placed, how fast, and how well do they follow the
//! field? One family, as other libraries place it, on a square of 1000 x 1000
//! at separation 20 and step 1, by both strategies, and with lines cut where
//! they are lonely.
//!
//! `cargo run --release -p streamlines --example even_spacing`

use std::time::Instant;
use streamline::geo_types::{coord, polygon, Coord, Rect};
use streamline::{
    from_fn, lattice, place, Cursor, DirectionField, PlacementOptions, Strategy, Streamline,
    TraceOptions,
};

const SEPARATION: f64 = 20.0;

/// Gathers and spreads; the more, the larger `strength`.
fn direction(at: Coord<f64>, strength: f64) -> Coord<f64> {
    let angle = 0.3
        + strength
            * (0.5 * (at.x / 130.0 + at.y / 410.0).sin()
                + 0.4 * (at.y / 170.0 - at.x / 600.0).cos());
    coord! { x: angle.cos(), y: angle.sin() }
}

fn distance(a: Coord<f64>, b: Coord<f64>) -> f64 {
    (a.x - b.x).hypot(a.y - b.y)
}

/// For each point of each line the distance to the nearest point of another
/// one, in separations, ascending; and the distances to the nearest on either
/// side.
fn spacing(lines: &[Streamline]) -> [Vec<f64>; 2] {
    let cell = |v: f64| ((v + 500.0) / (2.0 * SEPARATION)) as usize;
    let side = cell(500.0) + 1;
    let mut grid = vec![Vec::new(); side * side];
    let points = || {
        lines
            .iter()
            .enumerate()
            .flat_map(|(i, line)| line.points.iter().map(move |&p| (i, p)))
    };
    for (i, p) in points() {
        grid[cell(p.y) * side + cell(p.x)].push((i, p));
    }
    let (mut nearest, mut both) = (Vec::new(), Vec::new());
    for (i, line) in lines.iter().enumerate() {
        for (k, &p) in line.points.iter().enumerate() {
            let (before, after) = (k.saturating_sub(1), (k + 1).min(line.points.len() - 1));
            let way = line.points[after] - line.points[before];
            let (x, y) = (cell(p.x), cell(p.y));
            let mut sides = [f64::INFINITY; 2];
            for row in y.saturating_sub(1)..(y + 2).min(side) {
                for column in x.saturating_sub(1)..(x + 2).min(side) {
                    for &(j, q) in &grid[row * side + column] {
                        let off = q - p;
                        let beside = &mut sides[usize::from(way.x * off.y < way.y * off.x)];
                        if j != i {
                            *beside = beside.min(distance(p, q));
                        }
                    }
                }
            }
            nearest.push(sides[0].min(sides[1]) / SEPARATION);
            // Beyond the outermost lines there are none.
            both.extend(
                sides
                    .iter()
                    .filter(|side| side.is_finite())
                    .map(|s| s / SEPARATION),
            );
        }
    }
    for all in [&mut nearest, &mut both] {
        all.sort_by(f64::total_cmp);
    }
    [nearest, both]
}

/// Mean angle between pieces and the field at their middles, in degrees.
fn tangent_error(lines: &[Streamline], strength: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for pair in lines.iter().flat_map(|line| line.points.windows(2)) {
        let (e, d) = (
            pair[1] - pair[0],
            direction((pair[0] + pair[1]) / 2.0, strength),
        );
        sum += (e.x * d.y - e.y * d.x)
            .atan2(e.x * d.x + e.y * d.y)
            .abs()
            .to_degrees();
        count += 1.0;
    }
    sum / count
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for strength in [1.0, 0.25] {
        println!("strength {strength}");
        table(strength)?;
    }
    Ok(())
}

fn table(strength: f64) -> Result<(), Box<dyn std::error::Error>> {
    let square = polygon![(x: -500., y: -500.), (x: 500., y: -500.), (x: 500., y: 500.), (x: -500., y: 500.)];
    let field = from_fn(square, |at, _| Some(direction(at, strength)));
    let extent = Rect::new(coord! { x: -500., y: -500. }, coord! { x: 500., y: 500. });
    // A vector field has one family; a seed's second direction is never used.
    let seeds = lattice(&field, extent, 0.5 * SEPARATION)?;
    println!(
        "strategy   test widest  lines lines/s points/s  p1   p50  p99   sides p50 p99  farthest  tangent error"
    );
    for (strategy, test, widest) in [
        (Strategy::Neighbour, 0.5, None),
        (Strategy::Neighbour, 0.87, None),
        (Strategy::Neighbour, 0.86, Some(1.29)),
        (Strategy::Farthest, 0.5, None),
        (Strategy::Farthest, 0.87, None),
        (Strategy::Farthest, 0.86, Some(1.29)),
    ] {
        let options = PlacementOptions {
            separation: [SEPARATION; 2],
            test,
            widest,
            families: [true, false],
            strategy,
            trace: TraceOptions {
                step: 1.0,
                ..PlacementOptions::default().trace
            },
            ..PlacementOptions::default()
        };
        let mut lines = Vec::new();
        let mut best = f64::INFINITY;
        for _ in 0..9 {
            let start = Instant::now();
            lines = place(&field, &seeds, &options)?;
            best = best.min(start.elapsed().as_secs_f64());
        }
        let [spread, sides] = spacing(&lines);
        let percentile = |all: &[f64], p: f64| all[(p * (all.len() - 1) as f64) as usize];
        let farthest = seeds
            .iter()
            .step_by(17)
            .filter(|seed| {
                field
                    .direction(seed.at, seed.directions[0], &mut Cursor::default())
                    .is_some()
            })
            .map(|seed| {
                lines
                    .iter()
                    .map(|line| line.distance_to(seed.at))
                    .fold(f64::INFINITY, f64::min)
            })
            .fold(0.0, f64::max);
        println!(
            "{:<10} {test:<4} {:<7} {:<5} {:<7.0} {:<9.0} {:<4.2} {:<4.2} {:<5.2} {:<9.2} {:<4.2} {:<9.2} {:.4}",
            format!("{strategy:?}"),
            widest.map_or("-".into(), |w: f64| w.to_string()),
            lines.len(),
            lines.len() as f64 / best,
            spread.len() as f64 / best,
            percentile(&spread, 0.01),
            percentile(&spread, 0.5),
            percentile(&spread, 0.99),
            percentile(&sides, 0.5),
            percentile(&sides, 0.99),
            farthest / SEPARATION,
            tangent_error(&lines, strength),
        );
    }
    Ok(())
}
