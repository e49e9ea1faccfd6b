//! Even placement on squares of 1 and 10 square kilometres.

use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion, Throughput};
use geo_types::{coord, polygon, Rect};
use std::hint::black_box;
use streamline::{
    arm_nearest, from_fn, lattice, place, Ends, PlacementOptions, Strategy, TraceOptions,
};

fn placement(c: &mut Criterion) {
    let mut group = c.benchmark_group("placement");
    group.sample_size(10);
    for (name, half) in [("1 km2", 500.0), ("10 km2", 500.0 * 10.0_f64.sqrt())] {
        let square = polygon![(x: -half, y: -half), (x: half, y: -half), (x: half, y: half), (x: -half, y: half)];
        let field = from_fn(square, |at, heading| {
            let angle = 0.3 + 0.5 * (at.x / 130.0 + at.y / 410.0).sin();
            Some(arm_nearest(
                angle + 0.4 * (at.y / 170.0 - at.x / 600.0).cos(),
                heading,
            ))
        });
        let corner = coord! { x: half, y: half };
        let Ok(seeds) = lattice(&field, Rect::new(corner * -1.0, corner), 10.0) else {
            continue;
        };
        let fine = PlacementOptions {
            separation: [20.0, 20.0],
            trace: TraceOptions {
                step: 1.0,
                ..PlacementOptions::default().trace
            },
            ..PlacementOptions::default()
        };
        let cases = [
            ("neighbour", fine),
            (
                "neighbour, none lonely",
                PlacementOptions {
                    test: 0.86,
                    widest: Some(1.29),
                    ..fine
                },
            ),
            (
                "farthest",
                PlacementOptions {
                    strategy: Strategy::Farthest,
                    ..fine
                },
            ),
            (
                "streets with junctions",
                PlacementOptions {
                    ends: Ends::Junction,
                    ..PlacementOptions::default()
                },
            ),
        ];
        for (case, options) in cases {
            let lines = place(&field, &seeds, &options).map_or(0, |lines| lines.len());
            group.throughput(Throughput::Elements(lines as u64));
            group.bench_with_input(BenchmarkId::new(case, name), &options, |b, options| {
                b.iter(|| place(black_box(&field), &seeds, options));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, placement);
criterion_main!(benches);
