//! The same rough field, as if measured, followed by both tracers: by
//! Runge-Kutta lines come together and cross at flat angles where directions at
//! neighbouring vertices hardly agree; by edge maps none do.
//!
//! `cargo run -p streamlines --example edge_maps` counts them, and writes
//! `images/edge_maps.svg` into the crate.

use geo_types::{coord, Coord};
use std::fmt::Write as _;
use streamline::{
    candidates_by, CandidateOptions, EdgeMaps, EdgeOptions, EdgeTracer, RungeKutta, Seed,
    Streamline, TraceOptions, Tracer, TriangleField,
};

/// By how many right angles the cross turns around which points.
const SINGULAR: [(Coord<f64>, f64); 4] = [
    (Coord { x: 92., y: 88. }, -1.0),
    (Coord { x: 208., y: 96. }, 1.0),
    (Coord { x: 150., y: 190. }, -1.0),
    (Coord { x: 168., y: 174. }, 1.0),
];
const SIZE: f64 = 280.0;
/// Points along a side: triangles of 14 m.
const SIDE: usize = 21;
/// By how much directions are off at most, radians of four times the angle.
const NOISE: f64 = 1.9;

fn field() -> Result<TriangleField, Box<dyn std::error::Error>> {
    let spacing = SIZE / (SIDE - 1) as f64;
    let at = |i: usize| coord! { x: (i % SIDE) as f64 * spacing, y: (i / SIDE) as f64 * spacing };
    let points: Vec<_> = (0..SIDE * SIDE).map(at).collect();
    let vectors = points
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let turn = |(s, k): &(Coord<f64>, f64)| k * (p.y - s.y).atan2(p.x - s.x);
            // Noise without a pattern, the same on every machine.
            let noise = NOISE * ((i * 7919 % 1009) as f64 / 504.5 - 1.0);
            let angle = 0.9 + SINGULAR.iter().map(turn).sum::<f64>() + noise;
            coord! { x: angle.cos(), y: angle.sin() }
        })
        .collect();
    let cells = (0..SIDE - 1).flat_map(|j| (0..SIDE - 1).map(move |i| j * SIDE + i));
    let triangles = cells
        .flat_map(|a| [[a, a + 1, a + SIDE + 1], [a, a + SIDE + 1, a + SIDE]])
        .collect();
    Ok(TriangleField::new(points, triangles, vectors)?)
}

/// How often two lines, or one with itself, cross under 45 degrees.
fn flat_crossings(lines: &[Streamline]) -> usize {
    let pieces: Vec<[Coord<f64>; 2]> = lines
        .iter()
        .flat_map(|line| line.points.windows(2).map(|p| [p[0], p[1]]))
        .collect();
    let cross = |u: Coord<f64>, v: Coord<f64>| u.x * v.y - u.y * v.x;
    let crossed = |s: [Coord<f64>; 2], t: [Coord<f64>; 2]| {
        let (u, v) = (s[1] - s[0], t[1] - t[0]);
        let apart = |w, from, ends: [Coord<f64>; 2]| {
            let side = ends.map(|end| cross(w, end - from));
            side[0] * side[1] < 0.0
        };
        apart(u, s[0], t) && apart(v, t[0], s) && cross(u, v).abs() < (u.x * v.x + u.y * v.y).abs()
    };
    let later = |i: usize| pieces[i + 1..].iter();
    (0..pieces.len())
        .map(|i| later(i).filter(|&&t| crossed(pieces[i], t)).count())
        .sum()
}

fn draw(svg: &mut String, field: &TriangleField, lines: &[Streamline], left: f64) {
    let place = |p: Coord<f64>| (left + p.x, 10.0 + SIZE - p.y);
    let path = |points: &[Coord<f64>]| {
        let mut data = String::new();
        for (k, &p) in points.iter().enumerate() {
            let (x, y) = place(p);
            let _ = write!(data, "{}{x:.1} {y:.1}", if k == 0 { 'M' } else { 'L' });
        }
        data
    };
    let mesh: String = field
        .triangles()
        .iter()
        .map(|t| path(&t.map(|v| field.points()[v])) + "Z")
        .collect();
    let drawn: String = lines
        .iter()
        .map(|line| path(&line.simplify(0.15).points))
        .collect();
    let _ = writeln!(
        svg,
        "<path d=\"{mesh}\" stroke=\"#e9ecef\" stroke-width=\"0.6\"/>\n<path d=\"{drawn}\" stroke=\"#1864ab\" stroke-width=\"0.7\"/>"
    );
    for (at, turns) in SINGULAR {
        let (x, y) = place(at);
        let colour = if turns > 0.0 { "#d9480f" } else { "#212529" };
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>"
        );
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let field = field()?;
    let maps = EdgeMaps::new(&field);
    let seeds: Vec<Seed> = (0..40 * 40)
        .map(|k| Seed {
            at: coord! { x: 3.5 + 7.0 * f64::from(k % 40), y: 3.4 + 7.0 * f64::from(k / 40) },
            directions: [coord! { x: 0.8, y: 0.6 }, coord! { x: -0.6, y: 0.8 }],
        })
        .collect();
    let options = CandidateOptions {
        separation: 7.0,
        keep_singular: true,
        keep_closed: true,
        ..CandidateOptions::default()
    };
    let runge_kutta = RungeKutta {
        field: &field,
        options: TraceOptions::default(),
    };
    let edges = EdgeTracer {
        maps: &maps,
        options: EdgeOptions::default(),
    };
    let tracers: [(&str, &dyn Tracer); 2] = [("Runge-Kutta", &runge_kutta), ("edge maps", &edges)];
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" fill=\"none\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        2.0 * SIZE + 30.0,
        SIZE + 20.0
    );
    for (k, (name, tracer)) in tracers.into_iter().enumerate() {
        let lines = candidates_by(tracer, &seeds, &options)?;
        println!(
            "{name}: {} lines, {} crossings under 45 degrees",
            lines.len(),
            flat_crossings(&lines)
        );
        draw(&mut svg, &field, &lines, 10.0 + k as f64 * (SIZE + 10.0));
    }
    svg.push_str("</svg>\n");
    std::fs::write(
        concat!(env!("CARGO_MANIFEST_DIR"), "/images/edge_maps.svg"),
        svg,
    )?;
    Ok(())
}
