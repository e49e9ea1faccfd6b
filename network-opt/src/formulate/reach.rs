//! Which vertices can be active at all, by the directions of streets.

use crate::design::{ways_to, Heading, Problem};

/// Whether a sink can be reached from each vertex, and it from a sink, over
/// edges that may be active, each in a direction that it may have. A vertex of
/// which that is false is active in no valid network: directions and edges of a
/// network are among those that may be.
pub(super) fn useful(problem: &Problem, possible: &dyn Fn(usize) -> bool) -> Vec<bool> {
    let around = problem.around();
    let mut useful = vec![true; problem.vertices];
    for heading in Heading::BOTH {
        let runs = |e: usize, from: usize| possible(e) && problem.way(e).may_run_from(from);
        let away = ways_to(problem, &around, &problem.sinks, heading, runs);
        useful
            .iter_mut()
            .zip(away)
            .for_each(|(useful, away)| *useful &= away.is_finite());
    }
    useful
}
