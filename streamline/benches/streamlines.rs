//! Tracing, candidates and ranking on regions of 1 and 10 square kilometres.
//!
//! Two fields: a formula (`from_fn`), and a lattice of triangles between whose
//! corners the representative (cos 4u, sin 4u) is interpolated, which is what a
//! solved cross field looks like to the tracer.

use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion, Throughput};
use geo_types::{coord, polygon, Coord, LineString, Polygon};
use std::hint::black_box;
use streamline::{
    arm_nearest, candidates, from_fn, rank, tiles, trace, BoundaryDistance, BoundaryOptions,
    CandidateOptions, Continuity, Cursor, DirectionField, Divergence, Exit, Score, Seed,
    SingularityDistance, TileOptions, TraceOptions, WidthTable,
};

fn angle(at: Coord<f64>) -> f64 {
    0.3 + 0.5 * (at.x / 130.0 + at.y / 410.0).sin() + 0.4 * (at.y / 170.0 - at.x / 600.0).cos()
}

fn square(half: f64) -> Polygon<f64> {
    polygon![(x: -half, y: -half), (x: half, y: -half), (x: half, y: half), (x: -half, y: half)]
}

/// Representatives at the corners of a square lattice, each square cut into
/// two triangles; the domain is the whole square.
struct Lattice {
    half: f64,
    spacing: f64,
    side: usize,
    corner: Vec<Coord<f64>>,
}

impl Lattice {
    fn new(half: f64, spacing: f64) -> Self {
        let side = (2.0 * half / spacing).ceil() as usize + 1;
        let at = |i: usize| coord! { x: (i % side) as f64 * spacing - half, y: (i / side) as f64 * spacing - half };
        let representative =
            |p| coord! { x: f64::cos(4.0 * angle(p)), y: f64::sin(4.0 * angle(p)) };
        Self {
            half,
            spacing,
            side,
            corner: (0..side * side).map(|i| representative(at(i))).collect(),
        }
    }
}

impl DirectionField for Lattice {
    fn direction(&self, at: Coord<f64>, heading: Coord<f64>, _: &mut Cursor) -> Option<Coord<f64>> {
        if at.x.abs().max(at.y.abs()) > self.half {
            return None;
        }
        let (x, y) = (
            (at.x + self.half) / self.spacing,
            (at.y + self.half) / self.spacing,
        );
        let (i, j) = (
            (x as usize).min(self.side - 2),
            (y as usize).min(self.side - 2),
        );
        let (u, v) = (x - i as f64, y - j as f64);
        let c = |a: usize, b: usize| self.corner[(j + b) * self.side + i + a];
        let d = if u >= v {
            c(0, 0) * (1.0 - u) + c(1, 0) * (u - v) + c(1, 1) * v
        } else {
            c(0, 0) * (1.0 - v) + c(0, 1) * (v - u) + c(1, 1) * u
        };
        Some(arm_nearest(0.25 * d.y.atan2(d.x), heading))
    }

    fn exit(&self, from: Coord<f64>, to: Coord<f64>, _: &mut Cursor) -> Option<Exit> {
        let run = to - from;
        let sides = [
            (run.y, from.y, -1.0),
            (run.x, from.x, 1.0),
            (run.y, from.y, 1.0),
            (run.x, from.x, -1.0),
        ];
        let leave = sides
            .iter()
            .enumerate()
            .filter(|(_, (run, _, sign))| run * sign > 0.0)
            .map(|(edge, (run, at, sign))| ((sign * self.half - at) / run, edge));
        let (t, edge) = leave.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (t < 1.0).then(|| Exit {
            point: from + run * t.max(0.0),
            ring: 0,
            edge,
        })
    }
}

fn seeds(half: f64, count: usize) -> Vec<Seed> {
    let side = (count as f64).sqrt().round() as usize;
    let spacing = 2.0 * half / (side + 1) as f64;
    let at = |i: usize| coord! { x: (i % side + 1) as f64 * spacing - half, y: (i / side + 1) as f64 * spacing - half };
    let seed = |at| {
        let arm = arm_nearest(angle(at), coord! { x: 1.0, y: 0.0 });
        Seed {
            at,
            directions: [arm, coord! { x: -arm.y, y: arm.x }],
        }
    };
    (0..side * side).map(|i| seed(at(i))).collect()
}

fn bench_trace(c: &mut Criterion) {
    let (formula, lattice) = (
        from_fn(square(500.0), |at, heading| {
            Some(arm_nearest(angle(at), heading))
        }),
        Lattice::new(500.0, 18.0),
    );
    let (seed, heading) = (coord! { x: 12.0, y: 7.0 }, coord! { x: 1.0, y: 0.0 });
    let mut group = c.benchmark_group("trace one line across 1 km");
    for tolerance in [0.1, 0.01, 0.001] {
        let options = TraceOptions {
            tolerance,
            ..TraceOptions::default()
        };
        group.bench_function(BenchmarkId::new("formula", tolerance), |b| {
            b.iter(|| trace(black_box(&formula), seed, heading, &options))
        });
        group.bench_function(BenchmarkId::new("lattice", tolerance), |b| {
            b.iter(|| trace(black_box(&lattice), seed, heading, &options))
        });
    }
    group.finish();
}

fn bench_candidates(c: &mut Criterion) {
    let mut group = c.benchmark_group("candidates");
    group.sample_size(10);
    for (km2, half, count) in [(1, 500.0, 3000), (10, 1581.0, 30_000)] {
        let (lattice, seeds) = (Lattice::new(half, 18.0), seeds(half, count));
        group.throughput(Throughput::Elements(seeds.len() as u64));
        let options = CandidateOptions::default();
        group.bench_function(BenchmarkId::new("lattice", format!("{km2} km2")), |b| {
            b.iter(|| candidates(black_box(&lattice), &seeds, &options))
        });
        let formula = from_fn(square(half), |at, heading| {
            Some(arm_nearest(angle(at), heading))
        });
        group.bench_function(BenchmarkId::new("formula", format!("{km2} km2")), |b| {
            b.iter(|| candidates(black_box(&formula), &seeds, &options))
        });
    }
    group.finish();
}

fn bench_rank(c: &mut Criterion) {
    let mut group = c.benchmark_group("rank by four scores");
    group.sample_size(10);
    for (km2, half, count) in [(1, 500.0, 3000), (10, 1581.0, 30_000)] {
        let lattice = Lattice::new(half, 18.0);
        let lines = candidates(&lattice, &seeds(half, count), &CandidateOptions::default())
            .expect("valid seeds");
        let walls: Vec<_> = square(half)
            .exterior()
            .lines()
            .map(|l| (l.start, l.end, 7.5))
            .collect();
        let boundary = BoundaryDistance::new(
            &walls,
            WidthTable::new(&[45.0, 75.0], 600.0, 0.1),
            BoundaryOptions::default(),
        );
        let near = SingularityDistance {
            singularities: vec![coord! { x: 1.0, y: 2.0 }],
        };
        let scores: [(&dyn Score, f64); 4] = [
            (&Divergence::default(), 1.0),
            (&boundary, 1.0),
            (&near, 1.0),
            (&Continuity::default(), 1.0),
        ];
        group.throughput(Throughput::Elements(lines.len() as u64));
        group.bench_function(format!("{km2} km2"), |b| {
            b.iter(|| rank(black_box(&lines), &lattice, &scores))
        });
    }
    group.finish();
}

/// The tiles between two crossed families of lines.
fn bench_tiles(c: &mut Criterion) {
    let mut group = c.benchmark_group("tiles");
    group.sample_size(10);
    for (km2, half) in [(1, 500.0), (10, 1581.0)] {
        // Crossed families of waves, 30 m apart: pieces in proportion to area.
        let count = (2.0 * half / 30.0) as usize;
        let steps = (2.0 * half / 5.0) as usize;
        let line = |i: usize, flip: bool| {
            let points = (0..=steps).map(|j| {
                let u = 2.2 * half * j as f64 / steps as f64 - 1.1 * half;
                let v = 30.0 * i as f64 - half + 12.0 * (u / 70.0 + i as f64).sin() + 7.0;
                if flip {
                    coord! { x: v, y: u }
                } else {
                    coord! { x: u, y: v }
                }
            });
            LineString(points.collect())
        };
        let lines: Vec<_> = (0..count)
            .flat_map(|i| [line(i, false), line(i, true)])
            .collect();
        let land = square(half);
        group.throughput(Throughput::Elements((lines.len() * steps) as u64));
        group.bench_function(format!("{km2} km2"), |b| {
            b.iter(|| tiles(black_box(&land), &lines, &TileOptions::default()))
        });
    }
    group.finish();
}

criterion_group!(
    benches,
    bench_trace,
    bench_candidates,
    bench_rank,
    bench_tiles
);
criterion_main!(benches);
