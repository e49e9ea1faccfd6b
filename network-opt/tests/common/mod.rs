//! What tests share: how many cases, grids, limits, and the modules below.
//!
//! - [`recipe`]: random problems of streets and rooms;
//! - [`ways`]: random problems of one-way streets, and all their networks;
//! - [`brute`]: all valid networks of a problem of two-way streets;
//! - [`programs`]: integer programs and their optima against those.

#![allow(dead_code, reason = "each test file uses its own part")]

pub(crate) mod brute;
pub(crate) mod programs;
pub(crate) mod recipe;
pub(crate) mod ways;

use std::collections::BTreeSet;

use network_opt::design::{Problem, Tessellation};
use network_opt::geo_types::{coord, Coord};
use network_opt::solve::{Limits, NetworkSolver, Outcome, Search};
use proptest::prelude::*;

/// Few cases by default; many with `URBAN_LAYOUT_LONG=1`.
pub(crate) fn config(cases: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some_and(|v| v == "1");
    ProptestConfig::with_cases(if long { cases * 20 } else { cases })
}

/// A grid of squares of side 1, row by row.
pub(crate) fn grid(columns: usize, rows: usize) -> Tessellation {
    let wide = columns + 1;
    let points = (0..wide * (rows + 1))
        .map(|k| coord! { x: (k % wide) as f64, y: (k / wide) as f64 })
        .collect();
    let faces = (0..columns * rows).map(|k| {
        let a = k / columns * wide + k % columns;
        vec![a, a + 1, a + wide + 1, a + wide]
    });
    Tessellation::new(points, faces.collect()).unwrap()
}

/// A grid of squares, without some of them.
pub(crate) fn part_of_grid(
    columns: usize,
    rows: usize,
    keep: &dyn Fn(usize) -> bool,
) -> Tessellation {
    let wide = columns + 1;
    let faces = (0..columns * rows).filter(|&f| keep(f)).map(|f| {
        let a = f / columns * wide + f % columns;
        [a, a + 1, a + wide + 1, a + wide]
    });
    let faces: Vec<[usize; 4]> = faces.collect();
    let used: Vec<usize> = BTreeSet::from_iter(faces.iter().flatten().copied())
        .into_iter()
        .collect();
    let points = used.iter().map(|&k| -> Coord<f64> {
        coord! { x: (k % wide) as f64, y: (k / wide) as f64 }
    });
    let named = faces
        .iter()
        .map(|face| face.map(|v| used.partition_point(|&w| w < v)).to_vec());
    Tessellation::new(points.collect(), named.collect()).unwrap()
}

/// No deadline, and all else as ever.
pub(crate) fn forever() -> Limits {
    Limits {
        deadline: None,
        ..Limits::default()
    }
}

/// So many moves of the search, without a clock.
pub(crate) fn search(problem: &Problem, moves: u64, seed: u64) -> Outcome {
    let limits = Limits { seed, ..forever() };
    Search { moves: Some(moves) }
        .solve(problem, None, &limits, &mut |_| true)
        .unwrap()
}
