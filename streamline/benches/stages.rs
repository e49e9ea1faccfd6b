//! Runge-Kutta stages a second on a mesh: each is one look at the field. And
//! edges of the mesh a second by the second tracer.
//!
//! The rate that criterion reports counts stages, and what they cost includes
//! all else that a line takes: error control, dense output, boundary exits,
//! the watch for self-approach.

use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion, Throughput};
use geo_types::{coord, Coord};
use std::hint::black_box;
use std::sync::atomic::{AtomicU64, Ordering};
use streamline::{
    trace, Cursor, DirectionField, EdgeMaps, EdgeOptions, Exit, TraceOptions, TriangleField,
};

const EAST: Coord<f64> = Coord { x: 1.0, y: 0.0 };

fn angle(at: Coord<f64>) -> f64 {
    0.3 + 0.5 * (at.x / 130.0 + at.y / 410.0).sin() + 0.4 * (at.y / 170.0 - at.x / 600.0).cos()
}

/// A square of `side` x `side` vertices, inner ones shaken by a quarter of the
/// spacing, cut into triangles one way and the other.
fn mesh(half: f64, side: usize) -> TriangleField {
    let spacing = 2.0 * half / (side - 1) as f64;
    let shake = |i: usize| 0.5 * spacing * ((i * 7919 % 1009) as f64 / 1009.0 - 0.5);
    let point = |i: usize| {
        let (column, row) = (i % side, i / side);
        let inner = |k: usize| 0 < k && k + 1 < side;
        let off = if inner(column) && inner(row) {
            coord! { x: shake(i), y: shake(3 * i + 1) }
        } else {
            coord! { x: 0.0, y: 0.0 }
        };
        off + coord! { x: column as f64 * spacing - half, y: row as f64 * spacing - half }
    };
    let points: Vec<_> = (0..side * side).map(point).collect();
    let mut triangles = Vec::new();
    for row in 0..side - 1 {
        for column in 0..side - 1 {
            let a = row * side + column;
            let [b, c, d] = [a + 1, a + side, a + side + 1];
            if (row + column) % 2 == 0 {
                triangles.extend([[a, b, d], [a, d, c]]);
            } else {
                triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
    }
    let vectors = points
        .iter()
        .map(|&p| coord! { x: f64::cos(4.0 * angle(p)), y: f64::sin(4.0 * angle(p)) })
        .collect();
    TriangleField::new(points, triangles, vectors).expect("the lattice is a mesh")
}

/// Counts looks.
struct Counted<'a>(&'a TriangleField, AtomicU64);

impl DirectionField for Counted<'_> {
    fn direction(
        &self,
        at: Coord<f64>,
        heading: Coord<f64>,
        cursor: &mut Cursor,
    ) -> Option<Coord<f64>> {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.direction(at, heading, cursor)
    }

    fn exit(&self, from: Coord<f64>, to: Coord<f64>, cursor: &mut Cursor) -> Option<Exit> {
        self.0.exit(from, to, cursor)
    }
}

fn stages(c: &mut Criterion) {
    let mut group = c.benchmark_group("Runge-Kutta stages");
    group.sample_size(20);
    let (heading, options) = (EAST, TraceOptions::default());
    for (name, half, side) in [
        ("10^5 vertices on 10 km2", 1581.0, 317),
        ("10^5 vertices on 1 km2", 500.0, 317),
        ("10^4 vertices on 1 km2", 500.0, 101),
    ] {
        let field = mesh(half, side);
        let place = |i: usize| 0.9 * half * (i as f64 / 50.0 - 1.0);
        let seeds: Vec<_> = (0..100)
            .map(|i| coord! { x: place(i * 37 % 100), y: place(i * 71 % 100) })
            .collect();
        let counted = Counted(&field, AtomicU64::new(0));
        for &seed in &seeds {
            black_box(trace(&counted, seed, heading, &options)).ok();
        }
        group.throughput(Throughput::Elements(counted.1.into_inner()));
        group.bench_function(BenchmarkId::from_parameter(name), |b| {
            b.iter(|| {
                for &seed in &seeds {
                    black_box(trace(&field, seed, heading, &options)).ok();
                }
            });
        });
    }
    group.finish();
}

/// Preparing the edge maps of a mesh, and lines through them by the edges that
/// they cross.
fn edge_maps(c: &mut Criterion) {
    let mut group = c.benchmark_group("edge maps");
    group.sample_size(10);
    let field = mesh(500.0, 224);
    group.throughput(Throughput::Elements(field.triangles().len() as u64));
    group.bench_function("prepare 10^5 triangles", |b| {
        b.iter(|| EdgeMaps::new(black_box(&field)));
    });
    let maps = EdgeMaps::new(&field);
    let place = |i: usize| 450.0 * (i as f64 / 50.0 - 1.0);
    let seeds: Vec<_> = (0..100)
        .map(|i| coord! { x: place(i * 37 % 100), y: place(i * 71 % 100) })
        .collect();
    for (name, self_approach) in [("lines", 4.5), ("lines, self-approach allowed", 0.0)] {
        let options = EdgeOptions {
            self_approach,
            ..EdgeOptions::default()
        };
        let lines = || {
            let all = seeds.iter().map(|&seed| maps.trace(seed, EAST, &options));
            all.map(|line| line.map_or(0, |line| line.edges.len()))
                .sum()
        };
        let crossed: usize = lines();
        group.throughput(Throughput::Elements(crossed as u64));
        group.bench_function(name, |b| b.iter(lines));
    }
    group.finish();
}

criterion_group!(benches, stages, edge_maps);
criterion_main!(benches);
