//! Shapes that the laws are tried on, shared by the test files.
#![allow(
    dead_code,
    unreachable_pub,
    reason = "each test file uses some of the shapes"
)]

use std::f64::consts::TAU;

use crossfield::geo_types::{Coord, LineString, Polygon};
use crossfield::{Domain, DomainOptions};
use proptest::prelude::*;
use proptest::test_runner::Config;

/// Few cases by default; many with `URBAN_LAYOUT_LONG=1`.
pub fn config(cases: u32) -> Config {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some_and(|v| v == "1");
    Config {
        failure_persistence: None,
        ..Config::with_cases(if long { (cases * 40).max(1000) } else { cases })
    }
}

pub fn ring(points: &[(f64, f64)]) -> LineString<f64> {
    points.to_vec().into()
}

pub fn shape(points: &[(f64, f64)]) -> Polygon<f64> {
    Polygon::new(ring(points), vec![])
}

/// A regular polygon around a centre.
pub fn regular(count: usize, radius: f64, centre: (f64, f64)) -> LineString<f64> {
    let points: Vec<(f64, f64)> = (0..count)
        .map(|k| {
            let angle = TAU * k as f64 / count as f64;
            (
                centre.0 + radius * angle.cos(),
                centre.1 + radius * angle.sin(),
            )
        })
        .collect();
    points.into()
}

pub fn annulus(count: usize, outer: f64, inner: f64) -> Polygon<f64> {
    Polygon::new(
        regular(count, outer, (0.0, 0.0)),
        vec![regular(count, inner, (0.0, 0.0))],
    )
}

pub fn map(polygon: &Polygon<f64>, f: impl Fn(Coord<f64>) -> Coord<f64>) -> Polygon<f64> {
    let line = |ring: &LineString<f64>| LineString(ring.0.iter().map(|&c| f(c)).collect());
    Polygon::new(
        line(polygon.exterior()),
        polygon.interiors().iter().map(line).collect(),
    )
}

pub fn turned(polygon: &Polygon<f64>, angle: f64, shift: (f64, f64)) -> Polygon<f64> {
    let (s, c) = angle.sin_cos();
    map(polygon, |p| Coord {
        x: c * p.x - s * p.y + shift.0,
        y: s * p.x + c * p.y + shift.1,
    })
}

pub fn domain(polygon: &Polygon<f64>, edge_length: f64) -> Domain {
    let options = DomainOptions {
        edge_length,
        ..DomainOptions::default()
    };
    Domain::new(polygon, &options).expect("a valid shape")
}

/// A star-shaped ring around the origin: radii between `low` and 1 times
/// `size`, at even angles.
fn star(
    low: f64,
    size: f64,
    count: impl Strategy<Value = usize>,
) -> impl Strategy<Value = Vec<(f64, f64)>> {
    count
        .prop_flat_map(move |count| proptest::collection::vec(low..1.0_f64, count))
        .prop_map(move |radii| {
            let step = TAU / radii.len() as f64;
            radii
                .iter()
                .enumerate()
                .map(|(k, r)| {
                    let angle = k as f64 * step;
                    (size * r * angle.cos(), size * r * angle.sin())
                })
                .collect()
        })
}

/// Random polygons with up to one hole, some hundred metres across, some of
/// them with spikes, some smooth.
pub fn polygon() -> impl Strategy<Value = Polygon<f64>> {
    let low = prop_oneof![Just(0.4), Just(0.7), Just(0.97)];
    (low, any::<bool>())
        .prop_flat_map(|(low, holed)| {
            let hole = star(0.5, 40.0, 3..9_usize);
            (star(low, 200.0, 5..40_usize), hole, Just(holed))
        })
        .prop_map(|(outer, hole, holed)| {
            let holes = if holed { vec![ring(&hole)] } else { vec![] };
            Polygon::new(ring(&outer), holes)
        })
}

/// A histogram: columns of random heights on one base line, with only right
/// angles.
pub fn rectilinear() -> impl Strategy<Value = Polygon<f64>> {
    proptest::collection::vec((30.0..90.0_f64, 30.0..120.0_f64), 1..6).prop_map(|columns| {
        let total: f64 = columns.iter().map(|c| c.0).sum();
        let mut points = vec![(0.0, 0.0), (total, 0.0)];
        let mut x = total;
        for &(width, height) in columns.iter().rev() {
            points.push((x, height));
            x -= width;
            points.push((x, height));
        }
        // Neighbouring columns of one height would leave equal points; they
        // differ almost surely, and would be merged.
        shape(&points)
    })
}
