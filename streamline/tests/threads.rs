//! The number of threads changes nothing.
#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
#![cfg(feature = "rayon")]

mod support;

use geo_types::{coord, polygon};
use streamline::{rank, survey, CandidateOptions, Divergence};
use support::*;

#[test]
fn any_number_of_threads_gives_the_same_lines_and_ranking() {
    let domain = polygon![(x: -300., y: -250.), (x: 280., y: -300.), (x: 320., y: 260.), (x: -240., y: 300.)];
    let wave = |height, x, y, phase| (height, coord! { x: x, y: y }, phase);
    let waves = Waves {
        base: 0.3,
        wave: [wave(0.6, 0.015, 0.004, 1.0), wave(0.5, -0.005, 0.02, 2.0)],
    };
    let field = wavy(domain, waves);
    let seeds = lattice(&field, 300.0, 14.0);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let all = survey(&field, &seeds, &CandidateOptions::default()).unwrap();
            let ranked = rank(&all.lines, &field, &[(&Divergence::default(), 1.0)]);
            (all, ranked)
        })
    };
    let alone = run(1);
    assert!(alone.0.lines.len() > 40);
    for threads in [2, 3, 7] {
        assert_eq!(alone, run(threads), "{threads} threads");
    }
}
