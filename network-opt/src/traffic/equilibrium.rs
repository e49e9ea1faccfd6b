//! User equilibrium: Wardrop's first principle, by conjugate directions.
//!
//! Nobody can be quicker by another way where the flows minimise Beckmann's
//! function Z(v) = sum over links of the integral of t from 0 to v (Beckmann,
//! McGuire and Winsten 1956), convex for times t that grow with the flow. It is
//! minimised by the method of Frank and Wolfe: all-or-nothing flows y by the
//! times of now are where to go, and a line search says how far. Instead of y
//! alone, which zig-zags, the goal is a mix of y and the last goal that makes
//! directions conjugate (M. Mitradjieva, P. O. Lindberg, *The Stiff Is Moving*,
//! Transportation Science 47, 2013).

use super::assign::Plan;
use super::error::TrafficError;
use super::graph::StreetGraph;

/// How traffic slows down, and how near to the equilibrium to come.
///
/// The time of a link is that of the Bureau of Public Roads, t = t0 (1 + alpha
/// (v / c)^beta), for v vehicles per hour, a capacity of c, and free time t0.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EquilibriumOptions {
    /// What traffic at capacity adds to a link's time, as a share of it; 0 or
    /// more.
    ///
    /// Default value: 0.15.
    pub alpha: f64,
    /// How suddenly congestion sets in; 1 to 20.
    ///
    /// Default value: 4.
    pub beta: f64,
    /// The relative gap that is near enough; 0 or more.
    ///
    /// Default value: 1e-4.
    pub gap: f64,
    /// Rounds at most.
    ///
    /// Default value: 500.
    pub rounds: usize,
}

impl Default for EquilibriumOptions {
    fn default() -> Self {
        Self {
            alpha: 0.15,
            beta: 4.0,
            gap: 1e-4,
            rounds: 500,
        }
    }
}

/// How near to the equilibrium flows are.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Equilibrium {
    /// The relative gap: by how much all drivers together would be quicker, as
    /// a share of their time, if each could take the quickest way at the times
    /// of now. 0 at the equilibrium.
    pub relative_gap: f64,
    /// After each round how far Beckmann's function is over its best known lower
    /// bound, as a share of the function, 0 to 1; never grows.
    pub gaps: Vec<f64>,
}

/// How much of the last goal may stay in the next one.
const KEPT: f64 = 0.99;

/// Flows, their times, and how good they are.
pub(super) fn equilibrium(
    graph: &StreetGraph,
    plan: &Plan<'_>,
    free: Vec<f64>,
    options: &EquilibriumOptions,
) -> Result<(Vec<f64>, Vec<f64>, Equilibrium), TrafficError> {
    let bad = |what: String| Err(TrafficError::BadOption { what });
    if !(options.alpha >= 0.0 && options.alpha.is_finite()) {
        return bad(format!("alpha is {}; give 0 or more", options.alpha));
    }
    if !(1.0..=20.0).contains(&options.beta) {
        return bad(format!("beta is {}; give 1 to 20", options.beta));
    }
    if options.gap.is_nan() || options.gap < 0.0 {
        return bad(format!("gap is {}; give 0 or more", options.gap));
    }
    let costs = Costs {
        free,
        capacity: graph.links.iter().map(|l| l.capacity).collect(),
        options,
    };
    let mut flow = plan.load(&costs.free)?;
    let mut goal: Vec<f64> = flow.clone();
    let mut found = Equilibrium::default();
    // No link is quicker than when it is free. Bounds by tangents may well be
    // negative at first, when all crowd on one way.
    let mut bound = dot(&costs.free, &flow);
    for round in 0..=options.rounds {
        let times = costs.times(&flow);
        let quick = plan.load(&times)?;
        let spent = dot(&times, &flow);
        let saved = spent - dot(&times, &quick);
        found.relative_gap = if spent > 0.0 {
            (saved / spent).max(0.0)
        } else {
            0.0
        };
        // Z is convex: nowhere less than its tangent here, which is least at the
        // quickest ways.
        let value = costs.value(&flow);
        bound = bound.max(value - saved);
        let gap = if value > 0.0 {
            ((value - bound) / value).max(0.0)
        } else {
            0.0
        };
        found.gaps.push(gap);
        if found.relative_gap <= options.gap || round == options.rounds {
            break;
        }
        let goal_share = costs.conjugate(&flow, &goal, &quick);
        for (goal, quick) in goal.iter_mut().zip(&quick) {
            *goal = goal_share * *goal + (1.0 - goal_share) * quick;
        }
        let mut step = costs.step(&flow, &goal);
        if step == 0.0 {
            // Not downhill any more to the last digits: the plain way.
            goal = quick;
            step = costs.step(&flow, &goal);
            if step == 0.0 {
                break;
            }
        }
        for (flow, goal) in flow.iter_mut().zip(&goal) {
            *flow += step * (goal - *flow);
        }
    }
    let times = costs.times(&flow);
    Ok((flow, times, found))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

struct Costs<'a> {
    free: Vec<f64>,
    capacity: Vec<f64>,
    options: &'a EquilibriumOptions,
}

impl Costs<'_> {
    /// alpha (v / c)^beta; 0 for an infinite capacity.
    fn extra(&self, l: usize, flow: f64) -> f64 {
        self.options.alpha * (flow / self.capacity[l]).max(0.0).powf(self.options.beta)
    }

    fn time(&self, l: usize, flow: f64) -> f64 {
        self.free[l] * (1.0 + self.extra(l, flow))
    }

    fn times(&self, flow: &[f64]) -> Vec<f64> {
        flow.iter()
            .enumerate()
            .map(|(l, &v)| self.time(l, v))
            .collect()
    }

    /// Beckmann's function: the integral of a time is t0 v (1 + extra / (beta + 1)).
    fn value(&self, flow: &[f64]) -> f64 {
        let links = flow.iter().enumerate();
        links
            .map(|(l, &v)| self.free[l] * v * (1.0 + self.extra(l, v) / (self.options.beta + 1.0)))
            .sum()
    }

    /// The derivative of a time by the flow.
    fn slope(&self, l: usize, flow: f64) -> f64 {
        let share = (flow / self.capacity[l]).max(0.0);
        self.free[l] * self.options.alpha * self.options.beta / self.capacity[l]
            * share.powf(self.options.beta - 1.0)
    }

    /// How much of the last goal makes the next direction conjugate to the last
    /// one: (g - v)' H (a g + (1 - a) y - v) = 0 for the last goal g, the
    /// quickest ways y and the second derivatives H of Z.
    fn conjugate(&self, flow: &[f64], goal: &[f64], quick: &[f64]) -> f64 {
        let (mut with_quick, mut with_goal) = (0.0, 0.0);
        for (l, &v) in flow.iter().enumerate() {
            let last = (goal[l] - v) * self.slope(l, v);
            with_quick += last * (quick[l] - v);
            with_goal += last * (goal[l] - v);
        }
        let whole = with_quick - with_goal;
        if whole == 0.0 || !whole.is_finite() {
            return 0.0;
        }
        let share = with_quick / whole;
        if (0.0..=1.0).contains(&share) {
            share.min(KEPT)
        } else {
            0.0
        }
    }

    /// How far to go towards a goal, 0 to 1, so that Z is least: where its
    /// derivative along the way changes sign, by bisection.
    fn step(&self, flow: &[f64], goal: &[f64]) -> f64 {
        let slope = |step: f64| -> f64 {
            let links = flow.iter().zip(goal).enumerate();
            links
                .map(|(l, (v, g))| self.time(l, v + step * (g - v)) * (g - v))
                .sum()
        };
        if slope(0.0) >= 0.0 {
            return 0.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        if slope(high) <= 0.0 {
            return high;
        }
        for _ in 0..52 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}
