//! Laws of candidate generation and of the scores.
#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use geo_types::{coord, Polygon};
use proptest::prelude::*;
use streamline::{
    arm_nearest, candidates, distinct, from_fn, rank, survey, BoundaryDistance, BoundaryMeasure,
    BoundaryOptions, CandidateOptions, Continuity, Divergence, Score, Seed, SingularityDistance,
    Streamline, WidthTable,
};
use support::*;

fn options(seed: u64) -> CandidateOptions {
    CandidateOptions {
        separation: 15.0,
        seed,
        ..CandidateOptions::default()
    }
}

/// True if `line` switches off this orientation of the seed.
fn covers(line: &Streamline, seed: &Seed, family: u8, separation: f64) -> bool {
    let (gap, tangent) = nearest_piece(line, seed.at);
    let likeness = |k: usize| dot(seed.directions[k], tangent).abs() / norm(seed.directions[k]);
    gap <= separation * (1.0 + 1e-9)
        && likeness(family as usize) >= likeness(1 - family as usize) * (1.0 - 1e-9)
}

fn four_scores(
    domain: &Polygon<f64>,
    measure: BoundaryMeasure,
    motion: Motion,
) -> Vec<Box<dyn Score>> {
    let walls: Vec<_> = edges(domain)
        .iter()
        .map(|&(_, _, a, b)| (a, b, 4.0))
        .collect();
    let table = WidthTable::new(&[45.0, 75.0], 600.0, 0.05);
    let singularities = vec![
        motion.apply(coord! { x: 61., y: -12. }),
        motion.apply(coord! { x: -40., y: 55. }),
    ];
    let ends = vec![
        (
            motion.apply(coord! { x: 100., y: 9. }),
            motion.turn(coord! { x: 1., y: 0.1 }),
        ),
        (
            motion.apply(coord! { x: -95., y: 40. }),
            motion.turn(coord! { x: 1., y: -0.2 }),
        ),
    ];
    vec![
        Box::new(Divergence::default()),
        Box::new(BoundaryDistance::new(
            &walls,
            table,
            BoundaryOptions {
                measure,
                ..BoundaryOptions::default()
            },
        )),
        Box::new(SingularityDistance { singularities }),
        Box::new(Continuity {
            ends,
            distance: 40.0,
            angle_deg: 25.0,
        }),
    ]
}

proptest! {
    #![proptest_config(cases())]

    /// Every orientation of every seed lies near a placed line of its kind, or
    /// its own line was set aside; and no candidate is traced in vain.
    #[test]
    fn candidates_cover_all_seeds(domain in domain(), waves in waves(), seed: u64) {
        let field = wavy(domain, waves);
        let seeds = lattice(&field, 220.0, 19.0);
        let options = options(seed);
        let all = survey(&field, &seeds, &options).unwrap();
        let placed: Vec<&Streamline> = all.lines.iter()
            .chain(all.discarded.iter().filter(|d| d.switches_off()).filter_map(|d| d.line.as_ref()))
            .collect();
        for (i, seed) in seeds.iter().enumerate() {
            for family in 0..2 {
                let covered = placed.iter().any(|line| covers(line, seed, family, options.separation));
                let aside = all.discarded.iter().any(|d| (d.seed_index, d.family) == (i, family));
                prop_assert!(covered || aside, "seed {i} family {family}");
            }
        }
        for (k, line) in all.lines.iter().enumerate() {
            let seed = &seeds[line.seed_index];
            prop_assert_eq!(line.seed, seed.at);
            prop_assert!(line.start.is_boundary() && line.end.is_boundary() && line.is_simple());
            // The line follows the orientation that its family names.
            prop_assert!(covers(line, seed, line.family, 1e-6));
            for earlier in &all.lines[..k] {
                let (gap, tangent) = nearest_piece(earlier, seed.at);
                let own = dot(seed.directions[line.family as usize], tangent).abs();
                let other = dot(seed.directions[1 - line.family as usize], tangent).abs();
                prop_assert!(gap > options.separation * (1.0 - 1e-9) || own <= other * (1.0 + 1e-9));
            }
        }
        prop_assert_eq!(&all.lines, &candidates(&field, &seeds, &options).unwrap());
    }

    /// Costs do not depend on where the region lies, how it is turned, or
    /// which hand it has.
    #[test]
    fn scores_move_with_the_region(domain in domain(), waves in waves(), motion in motion()) {
        let home = wavy(domain.clone(), waves);
        let moved = motion.polygon(&domain);
        let away = from_fn(moved.clone(), |at, heading| {
            Some(motion.turn(arm_nearest(waves.angle(motion.undo(at)), motion.undo_turn(heading))))
        });
        let lines = candidates(&home, &lattice(&home, 150.0, 40.0), &options(1)).unwrap();
        let stay = Motion { angle: 0.0, mirror: false, shift: coord! { x: 0., y: 0. } };
        for measure in [BoundaryMeasure::Normals, BoundaryMeasure::Nearest] {
            let (here, there) = (four_scores(&domain, measure, stay), four_scores(&moved, measure, motion));
            for line in &lines {
                let points: Vec<_> = line.points.iter().map(|&p| motion.apply(p)).collect();
                let image = Streamline { points, seed: motion.apply(line.seed), ..line.clone() };
                for (a, b) in here.iter().zip(&there) {
                    let (cost, other) = (a.cost(line, &home), b.cost(&image, &away));
                    // A ray that passes a corner by a hair may fall to either
                    // side: one sample in the average of a line.
                    let slack = if a.name() == "boundary" && measure == BoundaryMeasure::Normals { 40.0 * 5.0 / line.length() } else { 1e-4 };
                    prop_assert!((cost - other).abs() <= slack, "{}: {cost} and {other}", a.name());
                    prop_assert!(cost >= 0.0 && cost.is_finite());
                }
            }
        }
    }

    /// Parts lie in [0, 1] and reach both ends, or are all 0; totals ascend;
    /// every line is there once; reversing a line changes no cost.
    #[test]
    fn ranking_is_a_normalised_order(domain in domain(), waves in waves(), weights in prop::array::uniform4(0.0..3.0)) {
        let field = wavy(domain.clone(), waves);
        let lines = candidates(&field, &lattice(&field, 150.0, 40.0), &options(2)).unwrap();
        let stay = Motion { angle: 0.0, mirror: false, shift: coord! { x: 0., y: 0. } };
        let scores = four_scores(&domain, BoundaryMeasure::Normals, stay);
        let weighted: Vec<(&dyn Score, f64)> = scores.iter().map(|s| &**s).zip(weights).collect();
        let ranked = rank(&lines, &field, &weighted);
        let mut seen: Vec<usize> = ranked.iter().map(|r| r.index).collect();
        seen.sort_unstable();
        prop_assert_eq!(seen, (0..lines.len()).collect::<Vec<_>>());
        prop_assert!(ranked.windows(2).all(|r| (r[0].total, r[0].index) <= (r[1].total, r[1].index)));
        for k in 0..4 {
            let parts = || ranked.iter().map(|r| r.parts[k]);
            prop_assert!(parts().all(|p| (0.0..=1.0).contains(&p)));
            if lines.is_empty() {
                continue;
            }
            prop_assert_eq!(parts().fold(f64::INFINITY, f64::min), 0.0);
            let top = parts().fold(0.0, f64::max);
            prop_assert!(top == 0.0 || top == 1.0);
        }
        for line in lines.iter().take(5) {
            let reversed = Streamline { points: line.points.iter().rev().copied().collect(), start: line.end, end: line.start, ..line.clone() };
            for (score, _) in &weighted {
                let (a, b) = (score.cost(line, &field), score.cost(&reversed, &field));
                prop_assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{}: {a} and {b}", score.name());
            }
        }
        let few = distinct(&lines, &ranked, 30.0);
        prop_assert!(few.len() <= lines.len() && few.first() == ranked.first().map(|r| &r.index));
        for (i, &a) in few.iter().enumerate() {
            for &b in &few[..i] {
                let apart = |p: &Streamline, q: &Streamline| p.points.iter().any(|&at| q.distance_to(at) > 30.0 * (1.0 - 1e-9));
                prop_assert!(apart(&lines[a], &lines[b]) || apart(&lines[b], &lines[a]));
            }
        }
    }

    /// The table agrees with all sums by brute force, and no distance is
    /// explained worse than its neighbours by more than the step between.
    #[test]
    fn width_table_is_the_distance_to_the_sums(widths in prop::collection::vec(20.0..90.0, 1..4), y in -30.0..900.0_f64, step in 0.0..5.0_f64) {
        let table = WidthTable::new(&widths, 500.0, 0.1);
        let mut sums: Vec<f64> = Vec::new();
        let mut last = vec![0.0];
        while !last.is_empty() {
            last = last.iter().flat_map(|s: &f64| widths.iter().map(move |w| s + w)).filter(|s| *s < 1000.0).collect();
            last.sort_by(f64::total_cmp);
            last.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
            sums.extend(&last);
        }
        let plain = sums.iter().map(|s| (s - y).abs()).fold(f64::INFINITY, f64::min);
        if y <= 500.0 {
            prop_assert!((table.cost(y) - plain).abs() <= 0.05 + 1e-9, "{} {}", table.cost(y), plain);
        } else {
            // Beyond the threshold an upper bound.
            prop_assert!(table.cost(y) >= plain - 0.05 - 1e-9);
        }
        if y + step <= 500.0 {
            prop_assert!((table.cost(y) - table.cost(y + step)).abs() <= step + 0.1 + 1e-9);
        }
    }
}
