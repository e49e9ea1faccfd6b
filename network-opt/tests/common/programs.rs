//! Integer programs against all valid networks: their rows, their prices and
//! their optima.

use network_opt::design::{cost_of, verify, Network, Problem};
use network_opt::formulate::{longest_ways, prepare, Fate, Formulated, Formulation};
use network_opt::mip::{Microlp, MipReply, MipSolver, MipStatus};
use network_opt::solve::{Ended, Exact, NetworkSolver};
use proptest::prelude::*;

use super::brute::all_valid;
use super::forever;

/// Solvers hold rows to a millionth; sums here have some tens of terms of size
/// one to ten.
pub(crate) const CLOSE: f64 = 1e-4;

pub(crate) const PROGRAMS: [Formulation; 4] = [
    Formulation::Flow,
    Formulation::TravelFlow,
    Formulation::SingleSink,
    Formulation::Paper,
];

/// What a program says that a network costs.
pub(crate) fn priced(problem: &Problem, formulation: Formulation, network: &Network) -> f64 {
    let cost = cost_of(problem, network);
    match formulation {
        Formulation::Flow => problem.length_weight * cost.length + cost.patterns + cost.routes,
        _ => cost.objective,
    }
}

/// The paper's distances are the true ones only of edges of length 1.
pub(crate) fn comparable(problem: &Problem, formulation: Formulation) -> bool {
    formulation != Formulation::Paper
        || problem.travel_weight == 0.0
        || problem.lengths.iter().all(|&l| l == 1.0)
}

/// A valid network is not decided away, meets every row of a program, and comes back
/// from its solution, of which it gives the cost.
pub(crate) fn is_kept(
    formulated: &Formulated<'_>,
    fates: &[Fate],
    network: &Network,
) -> Result<f64, TestCaseError> {
    let formulation = formulated.formulation();
    for (e, &fate) in fates.iter().enumerate() {
        prop_assert!(fate == Fate::Open || (fate == Fate::On) == network.active[e]);
    }
    let values = formulated.solution(network);
    let violation = formulated.program().violation(&values);
    prop_assert!(violation < CLOSE, "{formulation:?} by {violation}");
    prop_assert_eq!(&formulated.network(&values), network);
    Ok(formulated.program().objective(&values))
}

/// Every valid network meets every row of every program, cuts included, and
/// costs there what the checker says; none is decided away before.
pub(crate) fn no_row_cuts_off(problem: &Problem, valid: &[Network]) -> Result<(), TestCaseError> {
    let fates = prepare(problem);
    let costs = valid.iter().map(|n| cost_of(problem, n).objective);
    let worst = costs.fold(0.0, f64::max);
    for formulation in PROGRAMS {
        let longest = longest_ways(problem, worst);
        let formulated = Formulated::new(problem, formulation, Some(longest)).unwrap();
        if !valid.is_empty() {
            prop_assert!(!formulated.contradicts());
        }
        for network in valid {
            let said = is_kept(&formulated, &fates, network)?;
            if comparable(problem, formulation) {
                let is = priced(problem, formulation, network);
                prop_assert!(
                    (said - is).abs() < CLOSE,
                    "{formulation:?}: {said} for {is}"
                );
                let step = formulated.program().step();
                prop_assert!(step == 0.0 || (is / step - (is / step).round()).abs() < 1e-6);
            }
        }
    }
    Ok(())
}

/// The least cost that a solver finds; none if there is no network.
pub(crate) fn optimum(
    problem: &Problem,
    formulation: Formulation,
    solver: &impl MipSolver,
) -> Option<f64> {
    let formulated = Formulated::new(problem, formulation, None).unwrap();
    if formulated.contradicts() {
        return None;
    }
    let found = solver
        .solve(formulated.program(), None, &forever(), &mut |_| {
            MipReply::GoOn
        })
        .unwrap();
    if found.status == MipStatus::Infeasible {
        return None;
    }
    assert_eq!(found.status, MipStatus::Optimal);
    let values = found.solution.unwrap();
    let network = formulated.network(&values);
    assert_eq!(verify(problem, &network), [], "{formulation:?}");
    // The network itself costs no more than its solution says, and no less
    // where distances are the true ones.
    if comparable(problem, formulation) {
        let is = priced(problem, formulation, &network);
        assert!(
            (is - found.objective).abs() < 1e-3,
            "{formulation:?}: {is} for {}",
            found.objective
        );
    }
    Some(found.objective)
}

/// Whether two optima are one, or there is neither.
pub(crate) fn same(a: Option<f64>, b: Option<f64>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-3,
        (a, b) => a == b,
    }
}

/// Every program has the optimum that trying all networks has, and a network
/// exactly where there is one.
pub(crate) fn agrees(problem: &Problem, solver: &impl MipSolver) -> Result<(), TestCaseError> {
    let valid = all_valid(problem);
    for formulation in PROGRAMS {
        let best = (valid.iter().map(|n| priced(problem, formulation, n))).min_by(f64::total_cmp);
        let found = optimum(problem, formulation, solver);
        if comparable(problem, formulation) {
            prop_assert!(
                same(best, found),
                "{formulation:?} found {found:?}, the best is {best:?}"
            );
        } else {
            prop_assert_eq!(best.is_some(), found.is_some());
        }
    }
    Ok(())
}

/// The optimum by the exact solver; none if there is no network.
pub(crate) fn solved(problem: &Problem) -> Option<f64> {
    solved_by(&Exact::new(Microlp), problem)
}

/// The optimum by an exact solver that goes on to the end.
pub(crate) fn solved_by(solver: &impl NetworkSolver, problem: &Problem) -> Option<f64> {
    let found = solver
        .solve(problem, None, &forever(), &mut |_| true)
        .unwrap();
    match found.ended {
        Ended::Proven => {
            assert!(found.bound <= found.cost.objective + 1e-6);
            Some(found.cost.objective)
        }
        Ended::Infeasible => None,
        other => panic!("{other:?} without a limit"),
    }
}
