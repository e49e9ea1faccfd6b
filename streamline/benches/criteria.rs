//! UrbanFab's criteria of even lines on squares of 1 and 10 square kilometres.

use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion, Throughput};
use geo_types::{coord, polygon, Rect};
use std::hint::black_box;
use streamline::{
    arm_nearest, criteria, from_fn, lattice, place, tiles, CriteriaOptions, PlacementOptions,
    Streamline, TileOptions, TraceError,
};

fn judge(c: &mut Criterion) -> Result<(), TraceError> {
    let mut group = c.benchmark_group("criteria");
    group.sample_size(10);
    for (name, half) in [("1 km2", 500.0), ("10 km2", 500.0 * 10.0_f64.sqrt())] {
        let square = polygon![(x: -half, y: -half), (x: half, y: -half), (x: half, y: half), (x: -half, y: half)];
        let field = from_fn(square.clone(), |at, heading| {
            let angle = 0.3 + 0.5 * (at.x / 130.0 + at.y / 410.0).sin();
            Some(arm_nearest(
                angle + 0.4 * (at.y / 170.0 - at.x / 600.0).cos(),
                heading,
            ))
        });
        let corner = coord! { x: half, y: half };
        let seeds = lattice(&field, Rect::new(corner * -1.0, corner), 20.0)?;
        let placement = PlacementOptions {
            separation: [40.0, 40.0],
            ..PlacementOptions::default()
        };
        let lines = place(&field, &seeds, &placement)?;
        let strings: Vec<_> = lines.iter().map(Streamline::to_line_string).collect();
        let tiling = tiles(&square, &strings, &TileOptions::default())?;
        let options = CriteriaOptions::default();
        let found = criteria(&field, &square, &lines, &tiling, &[], &options)?;
        let segments: usize = found.lines.iter().map(|line| line.segments.len()).sum();
        group.throughput(Throughput::Elements(segments as u64));
        group.bench_with_input(BenchmarkId::new("segments", name), &options, |b, o| {
            b.iter(|| criteria(black_box(&field), &square, &lines, &tiling, &[], o));
        });
    }
    group.finish();
    Ok(())
}

fn run(c: &mut Criterion) {
    judge(c).expect("options in their ranges, and a tiling of these lines");
}

criterion_group!(benches, run);
criterion_main!(benches);
