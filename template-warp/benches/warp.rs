//! Time of matching and warping; see README.md in this folder for figures.

use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion};
use std::hint::black_box;
use template_warp::Deformation;
use template_warp::{
    geo_types::Coord, match_templates, warp, EdgeUse, Library, MatchOptions, PrincipalAffine,
    Region, WarpOptions,
};

/// A block with slanted ends and a vertex about every 12 m.
fn block(parcels: f64) -> Region {
    let length = 9.0 * parcels;
    let corners = [
        (0.0, 0.0),
        (length, -4.0),
        (length + 14.0, 58.0),
        (-9.0, 61.0),
    ];
    let mut ring = Vec::new();
    for i in 0..4 {
        let (a, b): ((f64, f64), (f64, f64)) = (corners[i], corners[(i + 1) % 4]);
        let k = ((b.0 - a.0).hypot(b.1 - a.1) / 12.0).round().max(1.0) as usize;
        for j in 0..k {
            let t = j as f64 / k as f64;
            ring.push(Coord {
                x: a.0 + t * (b.0 - a.0),
                y: a.1 + t * (b.1 - a.1),
            });
        }
    }
    let uses = vec![EdgeUse::Street; ring.len()];
    Region::new(ring, uses, "block").expect("the block is simple")
}

fn benches(c: &mut Criterion) {
    let all = Library::standard();
    let library = all.subset(&["double-row"]).expect("it is in the library");
    let mut group = c.benchmark_group("double_row");
    for parcels in [12, 24, 48, 240] {
        let region = block(f64::from(parcels));
        let candidates = match_templates(&library, &region, &MatchOptions::default());
        group.bench_function(BenchmarkId::new("warp", parcels), |b| {
            b.iter(|| {
                warp(
                    &library,
                    black_box(&region),
                    &candidates[0],
                    &WarpOptions::default(),
                )
            });
        });
    }
    group.finish();
    let region = block(24.0);
    c.bench_function("match_whole_library", |b| {
        b.iter(|| match_templates(&all, black_box(&region), &MatchOptions::default()))
    });
    c.bench_function("read_library", |b| b.iter(Library::standard));
    let from: Vec<_> = [(0., 0.), (18., 0.), (18., 30.), (0., 30.)]
        .map(|(x, y)| Coord { x, y })
        .to_vec();
    let to: Vec<_> = [(0., 1.), (19., 0.), (24., 31.), (4., 28.)]
        .map(|(x, y)| Coord { x, y })
        .to_vec();
    let class = PrincipalAffine {
        x: [0.85, 1.2],
        y: [0.8, 1.25],
    };
    c.bench_function("register_principal_affine", |b| {
        b.iter(|| class.register(black_box(&from), black_box(&to), &[1.0; 4]))
    });
}

criterion_group!(all, benches);
criterion_main!(all);
