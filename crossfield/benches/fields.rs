//! Time of a domain and of each design, by the size of the region.

use std::f64::consts::TAU;

use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion};
use crossfield::geo_types::{coord, Polygon};
use crossfield::{BoundaryField, Cursor, DistanceField, Domain, DomainOptions, FieldDesign};

/// A wavy region of about `area` square metres at a map-sized offset, its
/// boundary sampled every 15 metres as that of a traced road is.
fn region(area: f64) -> Polygon<f64> {
    let radius = (area / 3.24).sqrt();
    let count = (radius * 7.5 / 15.0).ceil() as usize;
    let ring: Vec<(f64, f64)> = (0..count)
        .map(|k| {
            let angle = TAU * k as f64 / count as f64;
            let r = radius * (1.0 + 0.25 * (3.0 * angle).sin() + 0.08 * (7.0 * angle).cos());
            (5e5 + r * angle.cos(), 5e6 + r * angle.sin())
        })
        .collect();
    Polygon::new(ring.into(), vec![])
}

fn options() -> DomainOptions {
    DomainOptions {
        edge_length: 20.0,
        ..DomainOptions::default()
    }
}

fn bench(c: &mut Criterion) {
    let mut group = c.benchmark_group("region");
    group.sample_size(20);
    for hectares in [1_u32, 10, 100, 1000] {
        let polygon = region(f64::from(hectares) * 1e4);
        let domain = Domain::new(&polygon, &options()).expect("valid");
        let id = |name| BenchmarkId::new(name, format!("{hectares} ha"));
        println!("{hectares} ha: {} vertices", domain.vertex_count());
        group.bench_function(id("domain"), |b| {
            b.iter(|| Domain::new(&polygon, &options()).expect("valid"));
        });
        group.bench_function(id("distance field"), |b| {
            b.iter(|| DistanceField::default().design(&domain).expect("a field"));
        });
        group.bench_function(id("boundary field"), |b| {
            b.iter(|| BoundaryField::default().design(&domain).expect("a field"));
        });
    }
    group.finish();

    let domain = Domain::new(&region(1e6), &options()).expect("valid");
    let field = BoundaryField::default().design(&domain).expect("a field");
    let east = coord! {x: 1.0, y: 0.0};
    c.bench_function("direction, 1000 steps of 1 m", |b| {
        b.iter(|| {
            let mut cursor = Cursor::default();
            (0..1000)
                .filter_map(|k| {
                    let at = coord! {x: 5e5 - 300.0 + 0.6 * f64::from(k), y: 5e6 + 0.8 * f64::from(k) - 300.0};
                    field.direction(at, east, &mut cursor)
                })
                .count()
        });
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
