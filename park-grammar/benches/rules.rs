//! How long rules take; one group a rule.
//!
//! The aim is a derivation with ten thousand objects in less than 50 ms.

use std::hint::black_box;

use criterion::{criterion_group, criterion_main, Criterion};
use park_grammar::geo_types::{Coord, Polygon};
use park_grammar::{DeriveOptions, Grammar, Scene};

fn read(rules: &str) -> Grammar {
    Grammar::new(&format!("grammar 1\n{rules}")).expect("a grammar")
}

fn derive(grammar: &Grammar, park: &Polygon<f64>) -> Scene {
    let derived = grammar.derive(black_box(park), &DeriveOptions::default());
    derived.expect("derives")
}

fn square(side: f64) -> Polygon<f64> {
    let corners = [(0., 0.), (side, 0.), (side, side), (0., side)];
    let ring = corners.iter().map(|&(x, y)| Coord { x, y }).collect();
    Polygon::new(ring, Vec::new())
}

/// A concave outline of 40 vertices.
fn bay(size: f64) -> Polygon<f64> {
    let ring = (0..40).map(|k| {
        let angle = f64::from(k) / 40.0 * std::f64::consts::TAU;
        let radius = size * (1.0 + 0.3 * (3.0 * angle).sin() + 0.05 * (11.0 * angle).cos());
        Coord {
            x: radius * angle.cos(),
            y: radius * angle.sin(),
        }
    });
    Polygon::new(ring.collect(), Vec::new())
}

fn grid(c: &mut Criterion) {
    let mut group = c.benchmark_group("grid");
    let plain = read("Region -> Grid(100, 100) { Meadow } {}");
    let objects = read("Region -> Grid(100, 100) { Cell } {}\nCell -> Place(CENTRE) { Tree }");
    let paths = read(
        "Region -> Grid(100, 100, width = 1) { Cell } { Gravel }\nCell -> Place(CENTRE) { Tree }",
    );
    let centres = read("Region -> Grid(20, 20, width = 1) { Meadow } { Gravel } { Romb(2) Sand }");
    let nested = read("Region -> Grid(10, 10, width = 2) { Inner } { Gravel }\nInner -> Grid(10, 10, width = 0.5) { Meadow } { Gravel }");
    let large = square(400.0);
    for (name, grammar) in [
        ("10000_cells", &plain),
        ("10000_objects", &objects),
        ("10000_objects_with_paths", &paths),
        ("400_cells_with_centres", &centres),
        ("nested_100_times_100", &nested),
    ] {
        group.bench_function(name, |b| b.iter(|| derive(grammar, &large)));
    }
    let concave = bay(150.0);
    group.bench_function("10000_objects_with_paths_concave", |b| {
        b.iter(|| derive(&paths, &concave))
    });
    group.finish();
}

fn fits(c: &mut Criterion) {
    let mut group = c.benchmark_group("fit");
    let concave = bay(60.0);
    for fit in ["oriented", "inscribed", "optimised", "indexed"] {
        let rules = format!("Region -> Grid(3, 3, fit = {fit}, min_angle = 10) {{ Meadow }}");
        let grammar = read(&rules);
        group.bench_function(fit, |b| b.iter(|| derive(&grammar, &concave)));
    }
    group.finish();
}

criterion_group!(benches, grid, fits);
criterion_main!(benches);
