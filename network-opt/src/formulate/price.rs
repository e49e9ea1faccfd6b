//! What networks cost by a program: its step, its unit, and parts of it that are
//! settled.

use super::{Formulated, Formulation};
use crate::design::Problem;

impl Formulated<'_> {
    /// Adds a row: length, patterns, routes and wishes cost `low` at least and `high` at most,
    /// by their weights. Patterns of [`Formulation::Paper`] are not counted.
    pub fn limit_length(&mut self, low: f64, high: f64) {
        let terms = self.length_terms();
        self.program.row(low, high, terms);
    }

    /// Settles what length, patterns, routes and wishes cost, by their weights: the
    /// program is of travel alone from then on, in its own units, which are easier
    /// to tell apart than if they were small parts of the whole. See
    /// [`Formulated::price`].
    ///
    /// Once, before there are cuts, and where travel costs something.
    pub(crate) fn settle_length(&mut self, cost: f64) {
        let unit = self.problem.travel_weight;
        debug_assert!(unit > 0.0 && self.priced.is_none() && self.added().is_empty());
        let terms = self.length_terms();
        for &(column, _) in &terms {
            self.program.set_cost(column, 0.0);
        }
        let slack = 1e-6 * cost.abs().max(1.0);
        self.program.row(cost - slack, cost + slack, terms);
        self.own_rows = self.program.rows().len();
        for column in 0..self.program.columns().len() {
            let cost = self.program.columns()[column].cost;
            self.program.set_cost(column, cost / unit);
        }
        let only_travel = Problem {
            length_weight: 0.0,
            travel_weight: 1.0,
            patterns: Vec::new(),
            routes: Vec::new(),
            rooms: None,
            ..self.problem.clone()
        };
        self.program
            .promise_step(step(&only_travel, self.formulation));
        self.priced = Some([cost, unit]);
    }

    /// What length, patterns, routes and wishes cost, if that is settled.
    pub(crate) fn settled(&self) -> Option<f64> {
        self.priced.map(|[cost, _]| cost)
    }

    /// What networks cost whose solutions cost so much by the program.
    #[must_use]
    pub fn price(&self, cost: f64) -> f64 {
        let [settled, unit] = self.priced.unwrap_or([0.0, 1.0]);
        settled + unit * cost
    }

    /// What solutions cost by the program whose networks cost so much.
    pub(crate) fn unpriced(&self, cost: f64) -> f64 {
        let [settled, unit] = self.priced.unwrap_or([0.0, 1.0]);
        (cost - settled) / unit
    }

    /// The columns of length, patterns, routes and wishes, with what they cost.
    fn length_terms(&self) -> Vec<(usize, f64)> {
        let [before, after] = self.plain;
        let columns = self.program.columns().iter().enumerate();
        columns
            .filter(|&(k, c)| c.cost != 0.0 && (k < before || k >= after))
            .map(|(k, c)| (k, c.cost))
            .collect()
    }
}

/// What the cost of every network is a multiple of, to a billionth; 0 if that
/// is too little to be of use.
pub(crate) fn step(problem: &Problem, formulation: Formulation) -> f64 {
    let fold = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, common);
    let length = fold(&mut problem.lengths.iter().copied());
    let over = fold(&mut (0..problem.edges()).map(|e| problem.travel_cost(e)));
    let travel = match formulation {
        Formulation::Flow => 0.0,
        // The mean of two ways.
        _ if problem.has_one_way() => 0.5 * problem.travel_weight * over,
        _ => problem.travel_weight * over,
    };
    let patterns = fold(&mut problem.patterns.iter().filter_map(|p| p.cost));
    let routes = fold(&mut problem.routes.iter().filter_map(|r| r.cost));
    let wishes = problem.rooms.iter().flat_map(|r| &r.wishes);
    let wishes = fold(&mut wishes.filter_map(|w| w.cost));
    let parts = [
        problem.length_weight * length,
        travel,
        patterns,
        routes,
        wishes,
    ];
    let step = fold(&mut parts.into_iter());
    if step > 1e-5 {
        step
    } else {
        0.0
    }
}

/// The largest number of which both are multiples, up to rounding.
fn common(mut a: f64, mut b: f64) -> f64 {
    let least = 1e-9 * a.max(b);
    while b > least {
        let rest = a % b;
        // What is a multiple but for rounding leaves nearly nothing, or nearly b.
        (a, b) = (b, rest.min(b - rest));
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_steps_are_found() {
        assert_eq!(common(0.0, 3.0), 3.0);
        assert_eq!(common(6.0, 4.0), 2.0);
        assert!((common(0.3, 0.1) - 0.1).abs() < 1e-12);
        assert!((common(1.0, 0.0001) - 0.0001).abs() < 1e-12);
    }
}
