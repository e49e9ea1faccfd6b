//! A lower bound: the relaxation of the inequalities of [`rows`](super::rows),
//! by its dual, which needs no solver of linear programs.
//!
//! Every active edge costs at least c_e, its weighted length and the weighted
//! shortest way that any network could leave it. Weights `y >= 0` of the rows
//! with `sum over rows of a_re y_r <= c_e` for each edge (a packing) give
//!
//! `objective >= sum c_e x_e >= sum_e sum_r y_r a_re x_e >= sum y_r d_r`
//!
//! whatever the network, so each packing is a bound, and the best one equals
//! the linear relaxation. It is approached by multiplicative weights (Garg and
//! Konemann, *Faster and simpler algorithms for multicommodity flow and other
//! fractional packing problems*, SIAM J. Comput. 37, 2007): again and again
//! the row that is cheapest under prices that grow exponentially with the load
//! of each edge receives more weight; dividing by the greatest relative load
//! makes any such weights a packing.

use super::model::{Fate, Model};
use super::rows::{Quarry, Row};

/// The approach of the best packing, step by step.
#[derive(Debug)]
pub(super) struct Bound {
    /// Where rows come from, until there are no more.
    quarry: Option<Quarry>,
    rows: Vec<Row>,
    costs: Vec<f64>,
    /// Load of each edge relative to its cost, and its price.
    loads: Vec<f64>,
    prices: Vec<f64>,
    value: f64,
    heaviest: f64,
    /// Where the search for a cheap row goes on, and how cheap is cheap.
    at: usize,
    level: f64,
    best: f64,
    /// What is paid in any case.
    fixed: f64,
    /// All objectives are multiples of it; 0 if they are not.
    quantum: f64,
    steps: usize,
}

/// Precision of the approach: step sizes relative to what is left.
const EPSILON: f64 = 0.05;
/// Rows looked at before it ends, and in one call.
const STEPS: usize = 400_000;
const SLICE: usize = 200;

impl Bound {
    pub(super) fn new(model: &Model<'_>) -> Self {
        let problem = model.problem;
        let costs: Vec<f64> = (0..problem.edges())
            .map(|e| model.price(e, model.floor[e]))
            .collect();
        let chosen = |e: usize| model.fates[e] == Fate::On && !model.given[e];
        let fixed = (0..problem.edges())
            .filter(|&e| chosen(e))
            .map(|e| costs[e])
            .sum();
        let prices = costs
            .iter()
            .map(|c| 1.0 / c.max(f64::MIN_POSITIVE))
            .collect();
        Self {
            quarry: Some(Quarry::new(model)),
            rows: Vec::new(),
            loads: vec![0.0; costs.len()],
            prices,
            costs,
            value: 0.0,
            heaviest: 0.0,
            at: 0,
            level: 0.0,
            best: 0.0,
            fixed,
            quantum: quantum(problem),
            steps: 0,
        }
    }

    /// Looks for more rows. Says whether it did.
    fn dig(&mut self, model: &Model<'_>) -> bool {
        let Some(quarry) = &mut self.quarry else {
            return false;
        };
        if !quarry.dig(model) {
            self.rows = std::mem::take(&mut quarry.rows);
            self.quarry = None;
            // One with an edge that costs nothing can be kept at no cost.
            let costs = &self.costs;
            (self.rows).retain(|row| row.terms.iter().all(|&(e, _)| costs[e] > 0.0));
            let worths = (0..self.rows.len()).map(|r| self.worth(r));
            self.level = worths.fold(f64::INFINITY, f64::min);
        }
        true
    }

    /// What a row costs for what it demands.
    fn worth(&self, r: usize) -> f64 {
        let row = &self.rows[r];
        row.terms
            .iter()
            .map(|&(e, a)| a * self.prices[e])
            .sum::<f64>()
            / row.least
    }

    /// Works on the bound for a moment. Gives the best so far.
    pub(super) fn improve(&mut self, model: &Model<'_>) -> f64 {
        if self.dig(model) {
            return self.rounded(self.fixed);
        }
        if self.steps < STEPS && !self.rows.is_empty() {
            for _ in 0..SLICE {
                self.step();
            }
            self.steps += SLICE;
            if self.steps.is_multiple_of(10 * SLICE) {
                self.fill();
            }
        }
        self.rounded(self.best + self.fixed)
    }

    /// Looks at one row, and gives it weight if it is cheap.
    fn step(&mut self) {
        let r = self.at;
        if self.worth(r) > self.level * (1.0 + EPSILON) {
            self.at += 1;
            if self.at == self.rows.len() {
                self.at = 0;
                self.level *= 1.0 + EPSILON;
            }
            return;
        }
        let row = &self.rows[r];
        // So much that the tightest of its edges is loaded by one more.
        let room = |&(e, a): &(usize, f64)| self.costs[e] / a;
        let weight = row.terms.iter().map(room).fold(f64::INFINITY, f64::min);
        let mut dear = false;
        for &(e, a) in &row.terms {
            let share = a * weight / self.costs[e];
            self.loads[e] += share;
            self.prices[e] *= 1.0 + EPSILON * share;
            self.heaviest = self.heaviest.max(self.loads[e]);
            dear |= self.prices[e] > 1e250;
        }
        self.value += weight * row.least;
        self.best = self.best.max(self.value / self.heaviest);
        if dear {
            self.prices.iter_mut().for_each(|p| *p *= 1e-200);
            self.level *= 1e-200;
        }
    }

    /// Makes the weights a packing, and gives row after row what its edges can
    /// still bear.
    fn fill(&mut self) {
        if self.heaviest == 0.0 {
            return;
        }
        let mut value = self.value / self.heaviest;
        let mut left: Vec<f64> = (self.costs.iter().zip(&self.loads))
            .map(|(cost, load)| cost * (1.0 - load / self.heaviest).max(0.0))
            .collect();
        for row in &self.rows {
            let room = |&(e, a): &(usize, f64)| left[e] / a;
            let weight = row.terms.iter().map(room).fold(f64::INFINITY, f64::min);
            row.terms.iter().for_each(|&(e, a)| left[e] -= a * weight);
            value += weight * row.least;
        }
        self.best = self.best.max(value);
    }

    /// Up to the next value that an objective can have.
    fn rounded(&self, bound: f64) -> f64 {
        // The sums are a little wrong.
        let safe = bound * (1.0 - 1e-9);
        if self.quantum > 0.0 {
            ((safe / self.quantum) - 1e-6).ceil().max(0.0) * self.quantum
        } else {
            safe
        }
    }
}

/// What all objectives are multiples of, if lengths and costs of travel are equal.
fn quantum(problem: &crate::design::Problem) -> f64 {
    let Some(&length) = problem.lengths.first() else {
        return 0.0;
    };
    let over = problem.travel_cost(0);
    let other = |e: usize| problem.lengths[e] != length || problem.travel_cost(e) != over;
    if (0..problem.edges()).any(other) {
        return 0.0;
    }
    // The mean of a way out and a way in may be a half.
    let share = if problem.has_one_way() { 0.5 } else { 1.0 };
    let mut parts = vec![
        problem.length_weight * length,
        share * problem.travel_weight * over,
    ];
    parts.extend(problem.patterns.iter().filter_map(|p| p.cost));
    parts.extend(problem.routes.iter().filter_map(|r| r.cost));
    let wishes = problem.rooms.iter().flat_map(|r| &r.wishes);
    parts.extend(wishes.filter_map(|w| w.cost));
    parts.retain(|&p| p > 0.0);
    let least = parts.iter().copied().fold(f64::INFINITY, f64::min);
    let whole = |p: &f64| (p / least - (p / least).round()).abs() < 1e-12 * p / least;
    if least.is_finite() && parts.iter().all(whole) {
        least
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{EdgeState, Problem};

    /// A path of three edges to the one place, of lengths 1, 2 and 4 from the
    /// sink: every way has all three.
    fn path(dead_ends: bool) -> Problem {
        Problem {
            vertices: 4,
            ends: vec![[0, 1], [1, 2], [2, 3]],
            lengths: vec![1.0, 2.0, 4.0],
            states: vec![EdgeState::Open; 3],
            sinks: vec![true, false, false, false],
            coverage: vec![vec![3]],
            dead_ends,
            length_weight: 1.0,
            travel_weight: 10.0,
            ..Problem::default()
        }
    }

    #[test]
    fn a_path_is_bounded_by_itself() {
        let problem = path(true);
        let model = Model::new(&problem).expect("has a solution");
        let mut bound = Bound::new(&model);
        let mut value = 0.0;
        for _ in 0..100 {
            value = f64::max(value, bound.improve(&model));
        }
        // Nested neighbourhoods cut each edge once: 7 long, ways 0, 1 and 3.
        assert!((value - (7.0 + 10.0 * 4.0)).abs() < 1e-6, "{value}");
        assert!(Model::new(&path(false)).is_err());
    }

    #[test]
    fn objectives_are_multiples_where_lengths_are_equal() {
        let mut problem = path(true);
        assert_eq!(quantum(&problem), 0.0);
        problem.lengths = vec![0.5; 3];
        assert_eq!(quantum(&problem), 0.5);
        problem.length_weight = 0.3;
        assert_eq!(quantum(&problem), 0.0);
        problem.travel_weight = 0.6;
        assert_eq!(quantum(&problem), 0.15);
    }
}
