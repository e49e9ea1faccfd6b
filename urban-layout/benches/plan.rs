//! Whole plans: a square kilometre, and four, to see how time grows.

use std::hint::black_box;

use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion};
use urban_layout::geo_types::{Coord, LineString, Polygon};
use urban_layout::{generate, PlanOptions, Quiet, Site};

/// An irregular convex-ish outline of about `km2` square kilometres with a bay.
fn site(km2: f64) -> Site {
    let half = 500.0 * km2.sqrt();
    let ring = [
        (-1.0, -0.9),
        (0.2, -1.1),
        (1.0, -0.8),
        (1.1, 0.3),
        (0.7, 1.0),
        (0.1, 0.8),
        (-0.3, 1.05),
        (-1.05, 0.7),
        (-0.85, 0.0),
    ];
    let points: Vec<Coord<f64>> = ring
        .iter()
        .map(|&(x, y)| Coord {
            x: x * half,
            y: y * half,
        })
        .collect();
    let polygon = Polygon::new(LineString(points), Vec::new());
    Site::from_polygon(&polygon).expect("the outline is simple")
}

fn plans(c: &mut Criterion) {
    let mut group = c.benchmark_group("generate");
    group.sample_size(10);
    for km2 in [0.25, 1.0, 4.0] {
        let site = site(km2);
        group.bench_with_input(BenchmarkId::from_parameter(km2), &site, |b, site| {
            b.iter(|| generate(black_box(site), &PlanOptions::default(), &mut Quiet));
        });
    }
    group.finish();
}

criterion_group!(benches, plans);
criterion_main!(benches);
