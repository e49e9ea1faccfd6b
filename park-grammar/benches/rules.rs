//! How long rules take; one group a rule.
//!
//! The aim is a derivation with ten thousand objects in less than 50 ms.

use std::hint::black_box;

use criterion::{criterion_group, criterion_main, Criterion};
use park_grammar::geo_types::{Coord, Polygon};
use park_grammar::{grammars, DeriveOptions, Grammar, Scene};

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

/// Benches of one group, each a grammar on an outline.
fn group(c: &mut Criterion, name: &str, park: &Polygon<f64>, rules: &[(&str, &str)]) {
    let mut group = c.benchmark_group(name);
    for (name, rules) in rules {
        let grammar = read(rules);
        group.bench_function(*name, |b| b.iter(|| derive(&grammar, park)));
    }
    group.finish();
}

/// Ten thousand things by each rule that puts them; the bay has 85,000 square
/// metres, so that lamps have room.
fn placing(c: &mut Criterion) {
    let rules = [
        ("scatter_10000", "Region -> Scatter(10000) { Lamp }"),
        (
            "scatter_full",
            "Region -> Scatter(Poisson, room = 1.4) { Lamp }",
        ),
        (
            "distribute_10000",
            "Region -> Distribute(ALL: 1, count = 10000) { Bin }",
        ),
        (
            "circles_1000",
            "Region -> ScatterCircles(1000 {[1-3]}) { Sand }",
        ),
        (
            "along_10000",
            "Region -> Place(Along(ALL, 10000, offset = 1)) { Bin }",
        ),
    ];
    group(c, "place", &bay(180.0), &rules);
    let rules = [
        ("hedge", "Region -> Sweep(ALL: 1, 0.8) { Hedge }"),
        (
            "hedge_mitre",
            "Region -> Sweep(ALL: 1, 0.8, Mitre) { Hedge }",
        ),
        (
            "hedge_past_1000_trees",
            "Region -> Scatter(1000) { Tree } Sweep(ALL: 2, 2) { Hedge }",
        ),
    ];
    group(c, "sweep", &bay(180.0), &rules);
}

/// The other rules that divide, each on a concave outline of 40 vertices.
fn dividing(c: &mut Criterion) {
    let park = bay(60.0);
    let rules = [
        ("peel_all", "Region -> Peel(ALL, 4 m) { ShrubBed | Lawn }"),
        (
            "peel_side",
            "Region -> Peel(EDGE[0], 4 m) { ShrubBed | Lawn }",
        ),
        (
            "peel_smooth",
            "Region -> Peel(ALL, 4 m, smooth = round, radius = 5) { ShrubBed | Lawn }",
        ),
        ("contract", "Region -> Contract(4 m) { Lawn | ShrubBed }"),
        (
            "contract_centre",
            "Region -> Contract(0.4, CENTRE) { Lawn | ShrubBed }",
        ),
        (
            "rings",
            "Region -> Rings(10, 20, 30) { Meadow } { Gravel } { Lawn }",
        ),
        (
            "smooth",
            "Region -> Smooth(round, radius = 6) { Lawn | ShrubBed }",
        ),
        (
            "split_along",
            "Region -> SplitAlong(WEST, EAST, curve = sinus, waves = 3) { Meadow | Lawn | Gravel }",
        ),
        (
            "split_holes",
            "Region -> Peel(ALL, 4 m, SplitHoles) { ShrubBed | Lawn }",
        ),
        ("fit_rectangle", "Region -> FitRectangle { Sand | Lawn }"),
    ];
    group(c, "divide", &park, &rules);
    let rules = [
        ("20_places", "Region -> VoronoiRegions(ScatterCircles(20 {2})) { Meadow } { Gravel }"),
        ("20_places_straight", "Region -> VoronoiRegions(ScatterCircles(20 {2}), none) { Meadow } { Gravel }"),
        ("500_places", "Region -> VoronoiRegions(ScatterCircles(500 {0.6}), width = 0.5) { Meadow } { Gravel }"),
    ];
    group(c, "voronoi", &park, &rules);
    let rules = [
        ("corners", "Region -> CastRays(CENTRE, Corners(Region)) { Meadow } { Gravel } { Circle(5) Paving }"),
        ("12_centres", "Region -> CastRays(ScatterCircles(12 {3}), Corners(Region), join = delaunay) { Meadow } { Gravel } { Circle(2) Paving }"),
        ("36_directions", "Region -> CastRays(CENTRE, 36) { Meadow } { Gravel }"),
    ];
    group(c, "rays", &park, &rules);
}

/// Whole parks, by the grammars of the library.
fn library(c: &mut Criterion) {
    let mut group = c.benchmark_group("library");
    group.sample_size(10);
    let park = bay(60.0);
    for named in &grammars::ALL {
        let grammar = named.grammar().expect("a grammar");
        group.bench_function(named.name, |b| b.iter(|| derive(&grammar, &park)));
    }
    group.finish();
}

fn selecting(c: &mut Criterion) {
    let selectors = [
        ("edge_index", "EDGE[0]"),
        ("outer", "OUTER"),
        ("cardinal_corners", "WEST"),
        ("cardinal_dominant", "Cardinal(WEST, Dominant)"),
        ("angle", "Angle([45, 135])"),
        ("sector", "Sector([45, 135])"),
        ("grow", "Grow([WEST, NORTH, EAST, SOUTH])"),
        ("continuous", "Continuous(WEST)"),
        ("history", "History(\"Grid\")"),
        ("nearest", "Nearest(CENTRE, 3)"),
        ("part", "Part(OUTER, [0.1, 0.9])"),
        ("combination", "(OUTER and not WEST) minus EDGE[1]"),
    ];
    let mut group = c.benchmark_group("select");
    let park = bay(60.0);
    for (name, selector) in selectors {
        // A hundred times, so that the derivation around it does not count.
        let rules = format!(
            "Region -> {}",
            format!("Case {{ Length({selector}) < 0: Sand }} ").repeat(100)
        );
        let grammar = read(&rules);
        group.bench_function(name, |b| b.iter(|| derive(&grammar, &park)));
    }
    group.finish();
}

fn fits(c: &mut Criterion) {
    let mut group = c.benchmark_group("fit");
    let concave = bay(60.0);
    for fit in [
        "oriented",
        "axis",
        "inscribed",
        "optimised",
        "indexed",
        "meeting",
        "blend",
    ] {
        let rules = format!("Region -> Grid(3, 3, fit = {fit}, min_angle = 10) {{ Meadow }}");
        let grammar = read(&rules);
        group.bench_function(fit, |b| b.iter(|| derive(&grammar, &concave)));
    }
    group.finish();
}

criterion_group!(benches, grid, fits, dividing, placing, selecting, library);
criterion_main!(benches);
