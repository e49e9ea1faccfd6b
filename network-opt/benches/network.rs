//! Building, splitting and optimising at the size of a site and ten times it.

use criterion::{criterion_group, criterion_main, BatchSize, BenchmarkId, Criterion};
use network_opt::geo_types::{coord, Coord, LineString};
use network_opt::{
    optimize, roads, Block, End, Freedom, OptimizeOptions, PlanarMesh, StripFit, VertexId, Wire,
};
use std::hint::black_box;

/// A bent grid of blocks of 120 m by 55 m, `pieces` pieces a side.
struct Grid {
    wires: Vec<Wire<bool>>,
    blocks: (usize, usize),
}

fn bent(x: f64, y: f64, (nx, ny): (usize, usize)) -> Coord<f64> {
    let (w, h) = (nx as f64, ny as f64);
    let rim = (x.min(w - x)).min(y.min(h - y)).clamp(0.0, 1.0);
    let push = 9.0 * rim * ((1.7 * x + 0.6 * y).sin() + (0.9 * y - 0.4 * x).cos());
    coord! { x: 120.0 * x + push, y: 55.0 * y + 0.8 * push }
}

fn grid(nx: usize, ny: usize, pieces: usize) -> Grid {
    let mut wires = Vec::new();
    for (count, lines, along_x) in [(nx, ny, true), (ny, nx, false)] {
        for k in 0..=lines {
            let line = (0..=count * pieces)
                .map(|i| {
                    let t = i as f64 / pieces as f64;
                    let (x, y) = if along_x {
                        (t, k as f64)
                    } else {
                        (k as f64, t)
                    };
                    bent(x, y, (nx, ny))
                })
                .collect();
            let rim = k == 0 || k == lines;
            wires.push(Wire {
                line: LineString(line),
                left: rim,
                right: rim,
                priority: 0,
            });
        }
    }
    Grid {
        wires,
        blocks: (nx, ny),
    }
}

fn network(
    g: &Grid,
) -> (
    PlanarMesh<bool>,
    Vec<Block>,
    Vec<Vec<VertexId>>,
    Vec<Freedom>,
) {
    let mesh = PlanarMesh::from_linework(&g.wires, 0.01).expect("sound linework");
    let locator = mesh.locator();
    let (nx, ny) = g.blocks;
    let corner = |i: usize, j: usize| {
        let at = bent(i as f64, j as f64, g.blocks);
        let (h, q, _) = locator.nearest_edge(at).expect("not empty");
        let (a, b) = (mesh.point(mesh.origin(h)), mesh.point(mesh.dest(h)));
        let d = |p: Coord<f64>| (p.x - q.x).hypot(p.y - q.y);
        if d(a) < d(b) {
            mesh.origin(h)
        } else {
            mesh.dest(h)
        }
    };
    let mut blocks = Vec::new();
    for i in 0..nx {
        for j in 0..ny {
            let centre = bent(i as f64 + 0.5, j as f64 + 0.5, g.blocks);
            let ids = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(di, dj)| corner(i + di, j + dj));
            blocks.push(Block {
                face: locator.face_at(centre),
                corners: Some(ids),
            });
        }
    }
    let mut freedom = vec![Freedom::Free; mesh.vertex_bound()];
    for h in mesh.half_edges().filter(|&h| *mesh.attr(h)) {
        let v = mesh.origin(h);
        freedom[v.0 as usize] = if mesh.degree(v) > 2 {
            Freedom::Slide
        } else {
            Freedom::Fixed
        };
    }
    let roads = roads(&mesh, |&rim| !rim, 60.0);
    (mesh, blocks, roads, freedom)
}

fn build(c: &mut Criterion) {
    let mut group = c.benchmark_group("from_linework");
    group.sample_size(10);
    for (nx, ny, pieces) in [(10, 15, 10), (32, 47, 10), (60, 85, 10)] {
        let g = grid(nx, ny, pieces);
        let segments: usize = g.wires.iter().map(|w| w.line.0.len() - 1).sum();
        group.bench_function(BenchmarkId::from_parameter(segments), |b| {
            b.iter(|| PlanarMesh::from_linework(black_box(&g.wires), 0.01));
        });
    }
    group.finish();
}

fn optimise(c: &mut Criterion) {
    let mut group = c.benchmark_group("optimize");
    group.sample_size(10);
    for (nx, ny) in [(10, 15), (32, 47)] {
        let (mesh, blocks, roads, freedom) = network(&grid(nx, ny, 10));
        let vertices = mesh.vertices().count();
        group.bench_function(BenchmarkId::from_parameter(vertices), |b| {
            b.iter_batched(
                || mesh.clone(),
                |mut mesh| {
                    optimize(
                        &mut mesh,
                        &blocks,
                        &roads,
                        &|v| freedom[v.0 as usize],
                        &StripFit::new(),
                        &OptimizeOptions::default(),
                        &mut |_| true,
                    )
                },
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

fn split(c: &mut Criterion) {
    let mut group = c.benchmark_group("split_face");
    group.sample_size(10);
    for n in [1_000_u32, 10_000, 100_000] {
        // A round lake-shore of n vertices, and a street of n / 10 across it.
        let shore = (0..=n)
            .map(|i| {
                let a = std::f64::consts::TAU * f64::from(i % n) / f64::from(n);
                coord! { x: 1000.0 * a.cos(), y: 1000.0 * a.sin() }
            })
            .collect();
        let wire = Wire {
            line: LineString(shore),
            left: 0_u8,
            right: 0,
            priority: 0,
        };
        let mesh = PlanarMesh::from_linework(&[wire], 0.0).expect("sound linework");
        let f = mesh.face_at(coord! { x: 0., y: 0. });
        let street: Vec<Coord<f64>> = (1..n / 10)
            .map(|i| {
                let t = 2.0 * f64::from(i) / f64::from(n / 10) - 1.0;
                coord! { x: 1000.0 * t, y: 200.0 * (3.0 * t).sin() * (1.0 - t * t) }
            })
            .collect();
        let end = |x: f64| {
            mesh.vertices()
                .min_by(|&a, &b| {
                    let d = |v| (mesh.point(v).x - x).abs();
                    d(a).total_cmp(&d(b))
                })
                .expect("not empty")
        };
        let (from, to) = (End::Vertex(end(-1000.0)), End::Vertex(end(1000.0)));
        group.bench_function(BenchmarkId::from_parameter(n), |b| {
            b.iter_batched(
                || mesh.clone(),
                |mut mesh| mesh.split_face(f, &street, from, to, 1, 1).map(|_| mesh),
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, build, split, optimise);
criterion_main!(benches);
