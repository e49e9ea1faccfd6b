//! Laws of snakes: networks of random edges on a grid.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use geo_types::{coord, Coord};
use network_opt::design::Tessellation;
use network_opt::snake::{smooth, snakes, SnakeOptions};
use proptest::prelude::*;

fn config() -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    ProptestConfig::with_cases(if long { 1000 } else { 50 })
}

/// A grid of squares of 10 m.
fn grid(side: usize, shift: Coord<f64>) -> Tessellation {
    let wide = side + 1;
    let points = (0..wide * wide)
        .map(|k| shift + coord! { x: 10.0 * (k % wide) as f64, y: 10.0 * (k / wide) as f64 })
        .collect();
    let faces = (0..side * side).map(|k| {
        let a = k / side * wide + k % side;
        vec![a, a + 1, a + wide + 1, a + wide]
    });
    Tessellation::new(points, faces.collect()).unwrap()
}

fn distance(a: Coord<f64>, b: Coord<f64>) -> f64 {
    (a.x - b.x).hypot(a.y - b.y)
}

const SIDE: usize = 6;

/// Active edges with the given probability in tenths; the rim given or not.
fn network() -> impl Strategy<Value = (Vec<bool>, bool)> {
    let edges = 2 * SIDE * (SIDE + 1);
    (1..10_u32).prop_flat_map(move |tenths| {
        let edge = (0..10_u32).prop_map(move |x| x < tenths);
        (prop::collection::vec(edge, edges), any::<bool>())
    })
}

fn parts(mesh: &Tessellation, mut active: Vec<bool>, rim: bool) -> (Vec<bool>, Vec<bool>) {
    let given: Vec<bool> = mesh.rim().map(|on| on && rim).collect();
    for (active, &given) in active.iter_mut().zip(&given) {
        *active |= given;
    }
    (active, given)
}

proptest! {
    #![proptest_config(config())]

    /// Snakes have each active edge once, in order, and meet themselves at
    /// their ends only.
    #[test]
    fn snakes_are_a_partition((active, _) in network(), turn in 0.0..3.2_f64) {
        let mesh = grid(SIDE, coord! { x: 0.0, y: 0.0 });
        let found = snakes(&mesh, &active, turn);
        let mut count = vec![0; active.len()];
        for snake in &found {
            prop_assert_eq!(snake.vertices.len(), snake.edges.len() + 1);
            for (k, &e) in snake.edges.iter().enumerate() {
                count[e] += 1;
                let mut ends = [snake.vertices[k], snake.vertices[k + 1]];
                ends.sort_unstable();
                prop_assert_eq!(mesh.edges()[e], ends);
            }
            let mut inner = snake.vertices[1..].to_vec();
            inner.sort_unstable();
            inner.dedup();
            prop_assert_eq!(inner.len(), snake.edges.len(), "{:?}", snake.vertices);
        }
        for (e, &times) in count.iter().enumerate() {
            prop_assert_eq!(times, i32::from(active[e]));
        }
    }

    /// What is given stays, crossings stay together, ends on a straight rim
    /// slide along it and no farther than allowed; and nowhere does the place
    /// of the site matter.
    #[test]
    fn streets_keep_together((active, rim) in network(), x in -1e6..1e6_f64, y in -1e6..1e6_f64) {
        let mesh = grid(SIDE, coord! { x: 0.0, y: 0.0 });
        let (active, given) = parts(&mesh, active, rim);
        let options = SnakeOptions::default();
        let found = smooth(&mesh, &active, &given, &options).unwrap();
        for (snake, line) in &found.streets {
            for (k, &v) in snake.vertices.iter().enumerate() {
                prop_assert_eq!(line.0[k * options.pieces], found.vertices[v]);
            }
        }
        let high = 10.0 * SIDE as f64;
        for (v, (&p, &q)) in mesh.points().iter().zip(&found.vertices).enumerate() {
            let on_x = p.x == 0.0 || p.x == high;
            let on_y = p.y == 0.0 || p.y == high;
            let touched = mesh.around(v).iter().any(|&(e, _)| active[e] && !given[e]);
            if !touched || (on_x && on_y) {
                prop_assert_eq!(p, q);
            } else if on_x {
                prop_assert!(p.x == q.x && (p.y - q.y).abs() <= 10.0 * options.slide + 1e-9);
            } else if on_y {
                prop_assert!(p.y == q.y && (p.x - q.x).abs() <= 10.0 * options.slide + 1e-9);
            }
            prop_assert!(distance(p, q) < 10.0, "vertex {v} has gone {} m", distance(p, q));
        }
        let shift = coord! { x: x, y: y };
        let there = smooth(&grid(SIDE, shift), &active, &given, &options).unwrap();
        for (&a, &b) in found.vertices.iter().zip(&there.vertices) {
            prop_assert!(distance(a + shift, b) < 1e-6);
        }
    }
}

/// Straight streets are a fixed point; a stair becomes nearly straight.
#[test]
fn straight_streets_stay_and_stairs_ease() {
    let mesh = grid(8, coord! { x: 0.0, y: 0.0 });
    let none = vec![false; mesh.edges().len()];
    let along = |steps: &[usize]| {
        let mut active = none.clone();
        for pair in steps.windows(2) {
            active[mesh.edge_between(pair[0], pair[1]).unwrap()] = true;
        }
        active
    };
    let wide = 9;
    let straight: Vec<usize> = (0..=8).map(|k| 4 * wide + k).collect();
    let found = smooth(&mesh, &along(&straight), &none, &SnakeOptions::default()).unwrap();
    for (&p, &q) in mesh.points().iter().zip(&found.vertices) {
        assert!(distance(p, q) < 1e-9);
    }
    // Right and up by turns, from one side to the other.
    let stair: Vec<usize> = (0..=12_usize)
        .map(|k| 2 * wide + k.div_ceil(2) + wide * (k / 2))
        .collect();
    let found = smooth(&mesh, &along(&stair), &none, &SnakeOptions::default()).unwrap();
    let (_, line) = &found.streets[0];
    let heading = |k: usize| {
        let way = line.0[k + 1] - line.0[k];
        way.y.atan2(way.x)
    };
    let middle = line.0.len() / 2;
    for k in middle - 8..middle + 8 {
        let off = heading(k) - std::f64::consts::FRAC_PI_4;
        assert!(off.abs() < 0.2, "{off} at {k}");
    }
}

#[test]
fn bad_options_are_named() {
    let mesh = grid(2, coord! { x: 0.0, y: 0.0 });
    let edges = vec![true; mesh.edges().len()];
    let good = SnakeOptions::default();
    for (bad, word) in [
        (
            SnakeOptions {
                rigidity: -1.0,
                ..good.clone()
            },
            "rigidity",
        ),
        (
            SnakeOptions {
                slide: 2.0,
                ..good.clone()
            },
            "slide",
        ),
        (
            SnakeOptions {
                pieces: 0,
                ..good.clone()
            },
            "pieces",
        ),
        (
            SnakeOptions {
                pinned: vec![9999],
                ..good.clone()
            },
            "pinned",
        ),
    ] {
        let error = smooth(&mesh, &edges, &edges, &bad).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
    assert!(smooth(&mesh, &[], &edges, &good).is_err());
}
