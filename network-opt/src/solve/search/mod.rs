//! Annealed large-neighbourhood search: networks and floorplans without an
//! integer programming solver.
//!
//! A network without dead ends is made of *ears*: paths whose two ends lie on
//! sinks or on other ears. So a move removes a chain, or all chains of a
//! region, and adds ears: cheapest paths under random prices, lower where they
//! pass what is not covered yet, through a place that is to be covered. Other
//! moves swap the edges of a short cycle, or force an ear through what is in
//! its way and shove that aside; rooms are tiled anew a few at a time. What is
//! still wrong afterwards (places uncovered, dead ends, islands, forbidden
//! patterns, rooms without a door) is fined, and fines rise while it stays;
//! worse networks are accepted as in annealing, in cycles each longer than the
//! last.
//!
//! The paper compares with a stochastic search of single edges (section 5.4),
//! which it finds hopeless; moves by ears are what makes the difference.

mod anneal;
mod bound;
mod ears;
mod lists;
mod model;
mod moves;
mod patterns;
mod placing;
mod rooms;
mod rows;
mod run;
mod score;
mod state;
mod tiling;
mod turns;
mod ways;

use super::{Limits, NetworkSolver, Outcome, Watch};
use crate::design::{Network, Problem};
use crate::error::DesignError;

/// A solver in pure Rust: a first network within milliseconds, good ones
/// within a second, and a bound that says how far from optimal they are at
/// most.
///
/// Whatever it reports is valid by [`verify`](crate::design::verify) and costs
/// what [`cost`](crate::design::cost) says. It stops with
/// [`Ended::Proven`](super::Ended::Proven) if the bound meets the objective
/// (within [`Limits::gap`]), and with
/// [`Ended::Infeasible`](super::Ended::Infeasible) only where simple
/// conclusions show that nothing is valid, or where the rooms tile the faces in
/// no way: it may well run to the deadline on a problem that has no solution,
/// and then gives no network.
///
/// Each of [`Limits::threads`] threads searches on its own, from its own
/// random stream. With [`moves`](Self::moves) given and no deadline the result
/// depends on the problem, the start, the seed and the number of threads alone
/// (of several threads, unless a proof by one that is not the first ends the
/// search early).
///
/// # Examples
///
/// A grid of four by four squares whose boundary is road; every place is to be
/// within one step of a street.
///
/// ```
/// use network_opt::design::{EdgeState, Problem, Tessellation};
/// use network_opt::geo_types::coord;
/// use network_opt::solve::{Limits, NetworkSolver, Search};
///
/// let points = (0..25).map(|k| coord! { x: f64::from(k % 5), y: f64::from(k / 5) }).collect();
/// let faces = (0..16).map(|k| k / 4 * 5 + k % 4).map(|a| vec![a, a + 1, a + 6, a + 5]);
/// let mesh = Tessellation::new(points, faces.collect())?;
/// let rim: Vec<bool> = mesh.rim().collect();
/// let mut problem = Problem {
///     vertices: 25,
///     ends: mesh.edges().to_vec(),
///     lengths: vec![1.0; 40],
///     states: rim.iter().map(|&r| if r { EdgeState::Given } else { EdgeState::Open }).collect(),
///     sinks: vec![false; 25],
///     coverage: (0..25).map(|v| mesh.ball(v, 1)).collect(),
///     length_weight: 1.0,
///     ..Problem::default()
/// };
/// for (edge, ends) in mesh.edges().iter().enumerate().filter(|&(e, _)| rim[e]) {
///     ends.iter().for_each(|&v| problem.sinks[v] = true);
/// }
/// let search = Search { moves: Some(2000) };
/// let found = search.solve(&problem, None, &Limits::default(), &mut |_| true)?;
/// // The middle vertex is two steps from the boundary, so a street has to pass
/// // a neighbour of it: one edge from the boundary there, two back, since there
/// // may be no dead end.
/// assert_eq!(found.cost.length, 3.0);
/// # Ok::<(), network_opt::DesignError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Search {
    /// Moves of each thread at most; with `None` the deadline alone ends the
    /// search. When they are used up it ends as at the deadline.
    ///
    /// Default value: `None`.
    pub moves: Option<u64>,
}

impl NetworkSolver for Search {
    fn solve(
        &self,
        problem: &Problem,
        start: Option<&Network>,
        limits: &Limits,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, DesignError> {
        run::run(self, problem, start, limits, watch)
    }
}
