//! Processor time of meshing and of D-fields at ten thousand, a hundred
//! thousand and a million vertices; [`benches/triangle_peer.py`] runs Triangle on
//! the same outlines.
//!
//! `cargo bench -p crossfield --bench domain [-- VERTICES ...]`
//!
//! No statistics: on a shared machine the smallest of a few runs, counted in
//! the thread's own processor time, is what can be compared.

use std::f64::consts::TAU;
use std::time::Instant;

use crossfield::geo_types::Polygon;
use crossfield::{DistanceField, Domain, DomainOptions, FieldDesign, Weighting};

/// A wavy region of 0.5 km2 with a hole, 300 boundary vertices or a multiple.
fn region(dense: usize) -> Polygon<f64> {
    let ring = |count: usize, f: &dyn Fn(f64) -> (f64, f64)| {
        let points: Vec<(f64, f64)> = (0..count)
            .map(|k| f(TAU * k as f64 / count as f64))
            .collect();
        points
    };
    let outer = ring(240 * dense, &|a| {
        let r = 390.0 * (1.0 + 0.25 * (3.0 * a).sin() + 0.08 * (7.0 * a).cos());
        (5e5 + r * a.cos(), 5e6 + r * a.sin())
    });
    let hole = ring(60 * dense, &|a| {
        (5e5 + 60.0 + 80.0 * a.cos(), 5e6 - 40.0 + 50.0 * a.sin())
    });
    Polygon::new(outer.into(), vec![hole.into()])
}

/// A disc of 0.5 km2, all of whose edges are equally near to its centre.
fn disc(count: usize) -> Polygon<f64> {
    let points: Vec<(f64, f64)> = (0..count)
        .map(|k| {
            let (s, c) = (TAU * k as f64 / count as f64).sin_cos();
            (400.0 * c, 400.0 * s)
        })
        .collect();
    Polygon::new(points.into(), vec![])
}

/// Nanoseconds this thread has run, where the system tells; else a clock.
fn processor_seconds(start: Instant) -> f64 {
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split(' ').next()?.parse::<f64>().ok())
        .map_or_else(|| start.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// Processor time of a run, and its last result: the smallest mean of some
/// batches, each long enough for a system that counts in hundredths.
fn least<T>(batches: usize, mut run: impl FnMut() -> T) -> (f64, T) {
    let start = Instant::now();
    let mut best = f64::INFINITY;
    let mut last = None;
    for _ in 0..batches {
        let before = processor_seconds(start);
        let mut runs = 0;
        let mean = loop {
            drop(last.take());
            last = Some(run());
            runs += 1;
            let spent = processor_seconds(start) - before;
            if spent > 0.3 {
                break spent / f64::from(runs);
            }
        };
        best = best.min(mean);
    }
    (best, last.expect("at least one run"))
}

fn main() {
    let wanted: Vec<f64> = std::env::args()
        .skip(1)
        .filter_map(|word| word.parse().ok())
        .collect();
    let wanted = if wanted.is_empty() {
        vec![1e4, 1e5, 1e6]
    } else {
        wanted
    };
    let outlines = [
        ("region, 300 edges", region(1)),
        ("region, 12 000 edges", region(40)),
        ("disc, 10 000 edges", disc(10_000)),
    ];
    for (name, outline) in outlines {
        println!("\n{name}\n");
        table(&outline, &wanted);
    }
}

fn table(outline: &Polygon<f64>, wanted: &[f64]) {
    let area = Domain::new(outline, &DomainOptions::default())
        .expect("valid")
        .area();
    println!(
        "| vertices | triangles | min angle | domain s | D-field s | ns a vertex | smoothing s | weighted s |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for &count in wanted {
        let runs = 3;
        let options = DomainOptions {
            // An equilateral triangle has sqrt(3) / 4 h^2, a vertex has two.
            edge_length: (area / count / 0.75_f64.sqrt()).sqrt(),
            max_vertices: 4_000_000,
            ..DomainOptions::default()
        };
        let (mesh, domain) = least(runs, || Domain::new(outline, &options).expect("valid"));
        let (raw, _) = least(runs, || {
            let design = DistanceField {
                smoothing_rounds: 0,
                ..DistanceField::default()
            };
            design.design(&domain).expect("a field")
        });
        let (whole, _) = least(runs, || {
            DistanceField::default().design(&domain).expect("a field")
        });
        let weights = std::iter::once(outline.exterior())
            .chain(outline.interiors())
            .map(|ring| {
                let count = ring.0.len() - 1;
                let angle = |k: usize| TAU * k as f64 / count as f64;
                (0..count).map(|k| 2.0 + angle(k).sin()).collect()
            })
            .collect();
        let by_vertex = DistanceField {
            weights,
            weighting: Weighting::Vertices,
            ..DistanceField::default()
        };
        let (weighted, _) = least(runs, || by_vertex.design(&domain).expect("a field"));
        println!(
            "| {} | {} | {:.1} | {mesh:.4} | {whole:.4} | {:.0} | {:.4} | {weighted:.4} |",
            domain.vertex_count(),
            domain.triangles().len(),
            domain.min_angle().to_degrees(),
            whole / domain.vertex_count() as f64 * 1e9,
            whole - raw,
        );
    }
}
