//! Time of H-fields: the basis (solves and Hessians), the gallery, and one
//! field of the basis, by the size of the mesh; and of gradient-aligned fields.

use std::f64::consts::TAU;

use criterion::{criterion_group, criterion_main, BenchmarkId, Criterion};
use crossfield::geo_types::Polygon;
use crossfield::{Domain, DomainOptions, GradientField, HarmonicField};

/// An irregular star of twenty straight sides, about a square kilometre at a
/// map-sized offset: twenty pieces.
fn site() -> Polygon<f64> {
    let ring: Vec<(f64, f64)> = (0..20)
        .map(|k| {
            let k = f64::from(k);
            let angle = TAU * (k + 0.2 * (1.7 * k).sin()) / 20.0;
            let r = if k % 2.0 == 0.0 { 640.0 } else { 490.0 } + 40.0 * (2.3 * k).cos();
            (5e5 + r * angle.cos(), 5e6 + r * angle.sin())
        })
        .collect();
    Polygon::new(ring.into(), vec![])
}

fn domain(vertices: f64) -> Domain {
    let polygon = site();
    let options = |edge_length| DomainOptions {
        edge_length,
        ..DomainOptions::default()
    };
    let area = Domain::new(&polygon, &options(100.0))
        .expect("valid")
        .area();
    // An equilateral lattice has one vertex per 0.87 edges squared.
    Domain::new(&polygon, &options((area / vertices / 0.87).sqrt())).expect("valid")
}

fn bench(c: &mut Criterion) {
    let mut group = c.benchmark_group("twenty pieces");
    group.sample_size(10);
    for vertices in [1e3, 1e4, 1e5] {
        let domain = domain(vertices);
        let count = domain.vertex_count();
        let design = HarmonicField {
            starts: 50,
            entries: 50,
            ..HarmonicField::default()
        };
        let basis = design.basis(&domain).expect("a basis");
        let gallery = design.gallery_of(&basis).expect("a gallery");
        println!(
            "{count} vertices, {} pieces, {} distinct minima of 50 starts",
            basis.pieces().len(),
            gallery.len()
        );
        let id = |name| BenchmarkId::new(name, count);
        group.bench_function(id("basis"), |b| {
            b.iter(|| design.basis(&domain).expect("a basis"));
        });
        group.bench_function(id("gallery of 50 starts"), |b| {
            b.iter(|| design.gallery_of(&basis).expect("a gallery"));
        });
        group.bench_function(id("one field"), |b| {
            b.iter(|| basis.field(&gallery[0].coefficients).expect("a field"));
        });
        group.bench_function(id("gradient-aligned, one assignment"), |b| {
            let one = GradientField {
                assignments: 1,
                ..GradientField::default()
            };
            b.iter(|| one.gallery(&domain).expect("a gallery"));
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
