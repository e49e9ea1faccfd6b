//! One-way streets in the search: ways out and in, and moves that give streets
//! their directions.
//!
//! With all sinks taken for one vertex a network with one-way streets is
//! valid if it is strongly connected, and such graphs too are made of ears, each
//! a path in its direction from the network to the network. So an ear through a
//! vertex is a path from it and a path to it; the streets on them that may run
//! either way are turned along. Besides, chains are turned, and whole tours from
//! a sink to a sink, which keep the network strongly connected. An edge that
//! cannot be reached, or from which no sink can, counts as an island.

use super::ears::{other, Manner};
use super::lists::Lists;
use super::model::{ways, Fate, Model};
use super::moves::Walk;
use super::state::State;
use super::ways::{Travel, Ways};
use crate::design::{mean_way, Heading, Problem, Way};

/// What a problem with one-way streets has besides.
#[derive(Debug)]
pub(super) struct Turns {
    /// The way to each vertex from a sink over given edges alone.
    pub(super) base: Vec<f64>,
    /// The way over all edges that may be active.
    pub(super) least: Vec<f64>,
    /// Given edges whose direction is open.
    loose: Vec<usize>,
}

impl Turns {
    /// None if no edge is one-way.
    pub(super) fn new(
        problem: &Problem,
        around: &Lists<(usize, usize)>,
        given: &[bool],
        fates: &[Fate],
    ) -> Option<Self> {
        problem.has_one_way().then(|| Self {
            base: ways(problem, around, &problem.sinks, Heading::In, |e, end| {
                given[e] && problem.way(e).runs_from(end)
            }),
            least: ways(problem, around, &problem.sinks, Heading::In, |e, end| {
                fates[e] != Fate::Off && problem.way(e).may_run_from(end)
            }),
            loose: (0..problem.edges())
                .filter(|&e| given[e] && problem.way(e) == Way::Either)
                .collect(),
        })
    }
}

/// Whether traffic of an edge reaches no sink, or none reaches the edge.
pub(super) fn is_lost(ends: [usize; 2], way: Way, to: &[f64], from: &[f64]) -> bool {
    mean_way(ends, way, to, from).is_infinite()
}

/// By edge, the least that its travel can be; 0 for edges that can be part of
/// no network.
pub(super) fn floors(problem: &Problem, least: &[f64], turns: Option<&Turns>) -> Vec<f64> {
    let floor = |(e, &ends): (usize, &[usize; 2])| {
        let floor = match turns {
            None => least[ends[0]].min(least[ends[1]]),
            Some(turns) => {
                let mean = |way| mean_way(ends, way, least, &turns.least);
                match problem.way(e) {
                    Way::Either => mean(Way::Forward).min(mean(Way::Backward)),
                    way => mean(way),
                }
            }
        };
        if floor.is_finite() {
            floor
        } else {
            0.0
        }
    };
    problem.ends.iter().enumerate().map(floor).collect()
}

/// Whether a path may lead on over an edge to `w`, with traffic in its heading.
pub(super) fn passes(
    model: &Model<'_>,
    state: &State,
    e: usize,
    w: usize,
    heading: Option<Heading>,
) -> bool {
    heading.is_none_or(|heading| {
        let near = usize::from(model.problem.ends[e][0] == w);
        let tail = heading.tail(near);
        if state.active[e] {
            state.way(model, e).runs_from(tail)
        } else {
            model.problem.way(e).may_run_from(tail)
        }
    })
}

impl State {
    /// Which way traffic runs over an edge.
    pub(super) fn way(&self, model: &Model<'_>, e: usize) -> Way {
        match model.problem.way(e) {
            Way::Either if self.backward[e] => Way::Backward,
            Way::Either => Way::Forward,
            decided => decided,
        }
    }

    /// The directions of the network.
    pub(super) fn decided_ways(&self, model: &Model<'_>) -> Vec<Way> {
        let backward = |e: usize| self.backward[e];
        model.problem.decided_ways(&self.active, backward)
    }
}

impl Ways {
    /// Whether an active edge is an island, by the ways measured last.
    pub(super) fn loses(&self, model: &Model<'_>, state: &State, e: usize) -> bool {
        let ends = model.problem.ends[e];
        if model.turns.is_some() {
            is_lost(ends, state.way(model, e), &self.away, &self.from)
        } else {
            self.away[ends[0]].is_infinite()
        }
    }

    /// Finds all ways out and in anew.
    pub(super) fn measure_turns(
        &mut self,
        model: &Model<'_>,
        turns: &Turns,
        state: &State,
    ) -> Travel {
        self.spread(model, turns, state, Heading::Out);
        self.spread(model, turns, state, Heading::In);
        let mut travel = Travel {
            sum: 0.0,
            islands: 0,
        };
        for &e in state.charged.items() {
            let ends = model.problem.ends[e];
            let way = mean_way(ends, state.way(model, e), &self.away, &self.from);
            if way.is_finite() {
                travel.sum += way;
            } else {
                travel.islands += 1;
            }
        }
        let lost = |&&e: &&usize| self.loses(model, state, e);
        travel.islands += model.stray.iter().filter(lost).count();
        travel
    }

    fn spread(&mut self, model: &Model<'_>, turns: &Turns, state: &State, heading: Heading) {
        let problem = model.problem;
        let (labels, base) = match heading {
            Heading::Out => (&mut self.away, &model.base),
            Heading::In => (&mut self.from, &turns.base),
        };
        labels.copy_from_slice(base);
        for &e in state.charged.items().iter().chain(&turns.loose) {
            for v in problem.ends[e] {
                if labels[v].is_finite() && !self.waiting[v] {
                    self.waiting[v] = true;
                    self.queue.push_back(v);
                }
            }
        }
        while let Some(v) = self.queue.pop_front() {
            self.waiting[v] = false;
            let gone = labels[v];
            for &(e, w) in model.around.of(v) {
                let there = gone + problem.travel_cost(e);
                let tail = heading.tail(usize::from(problem.ends[e][1] == w));
                if state.active[e] && there < labels[w] && state.way(model, e).runs_from(tail) {
                    labels[w] = there;
                    if !self.waiting[w] {
                        self.waiting[w] = true;
                        self.queue.push_back(w);
                    }
                }
            }
        }
    }

    fn labels(&self, heading: Heading) -> &[f64] {
        match heading {
            Heading::Out => &self.away,
            Heading::In => &self.from,
        }
    }
}

impl Walk<'_, '_> {
    /// Turns an edge that may run either way so that traffic leaves `at` over it,
    /// or comes to it.
    fn point(&mut self, e: usize, at: usize, heading: Heading) {
        if self.model.problem.way(e) == Way::Either {
            let near = usize::from(self.model.problem.ends[e][1] == at);
            let backward = heading.tail(near) == 1;
            if self.state.backward[e] != backward {
                self.state.turn(e);
            }
        }
    }

    fn coin(&mut self) -> Heading {
        if self.dice.chance(0.5) {
            Heading::Out
        } else {
            Heading::In
        }
    }

    /// What a vertex lacks: a street that leads on from it, or one that leads to
    /// it; either, if it has both.
    fn heading_at(&mut self, v: usize) -> Heading {
        let (state, model) = (&self.state, self.model);
        let leads = |heading: Heading| {
            model.around.of(v).iter().any(|&(e, _)| {
                let near = usize::from(model.problem.ends[e][1] == v);
                state.active[e] && state.way(model, e).runs_from(heading.tail(near))
            })
        };
        match Heading::BOTH.map(leads) {
            [false, true] => Heading::Out,
            [true, false] => Heading::In,
            _ => self.coin(),
        }
    }

    /// [`Walk::path_from`] with traffic in one direction: away from `v` or to it.
    pub(super) fn path_one_way(&mut self, v: usize, besides: usize, manner: &Manner) -> bool {
        let heading = match manner.heading {
            Some(heading) => heading,
            None => self.heading_at(v),
        };
        let manner = Manner {
            heading: Some(heading),
            ..*manner
        };
        let labels = self.ways.labels(heading);
        let found = self
            .finder
            .find(self.model, &self.state, labels, v, besides, &manner);
        let mut at = v;
        for k in 0..self.finder.path.len() {
            let e = self.finder.path[k];
            if !self.state.active[e] {
                self.point(e, at, heading);
                self.add(e);
            }
            at = other(self.model.problem.ends[e], at);
        }
        found.is_some()
    }

    /// [`Walk::ear_through`] with directions: one path from the vertex and one to
    /// it, each between it and what has a way to a sink, or from one.
    pub(super) fn loop_through(&mut self, v: usize, manner: &Manner) -> bool {
        const NOWHERE: usize = usize::MAX;
        let mark = self.state.mark();
        let inside = self.state.is_stop(v);
        // The second path must not end on the first one, which has no way yet.
        self.ways.measure(self.model, &self.state);
        let heading = if inside {
            self.heading_at(v)
        } else {
            self.coin()
        };
        let first = Manner {
            heading: Some(heading),
            reached: true,
            ..*manner
        };
        if !self.path_one_way(v, NOWHERE, &first) {
            return false;
        }
        if inside {
            return true;
        }
        let problem = self.model.problem;
        let two_way = |&e: &usize| problem.way(e) == Way::Both;
        let may_end = problem.dead_ends && self.finder.path.iter().all(two_way);
        if may_end && self.dice.chance(0.7) {
            return true;
        }
        let second = Manner {
            heading: Some(heading.other()),
            ..first
        };
        if self.path_one_way(v, NOWHERE, &second) || may_end {
            return true;
        }
        self.state.undo(self.model, mark);
        false
    }

    /// Paths from the ends of an edge that was added to the network, as needed;
    /// `inside` says which ends were part of it before.
    pub(super) fn join_ends(
        &mut self,
        e: usize,
        [a, b]: [usize; 2],
        [near, far]: [bool; 2],
        manner: &Manner,
    ) -> bool {
        let way = self.state.way(self.model, e);
        let end = usize::from(self.model.problem.ends[e][1] == a);
        let heading = match way {
            Way::Both | Way::Either => self.coin(),
            // Traffic that leaves over the edge has to come from somewhere.
            _ if way.runs_from(end) => Heading::In,
            _ => Heading::Out,
        };
        let at = |heading| Manner {
            heading: Some(heading),
            ..*manner
        };
        let may_end = self.model.problem.dead_ends && way == Way::Both;
        let first = near || far && may_end || self.path_one_way(a, b, &at(heading));
        let second = far || may_end || self.path_one_way(b, usize::MAX, &at(heading.other()));
        first && second
    }

    /// Joins to the rest what reaches no sink or is reached from none: by another
    /// direction, or by paths.
    pub(super) fn join_lost(&mut self) -> bool {
        let model = self.model;
        let turnable = self.state.turnable.items().iter();
        let lost: Vec<usize> = turnable
            .filter(|&&e| self.ways.loses(model, &self.state, e))
            .copied()
            .collect();
        if let (Some(e), true) = (self.dice.pick(&lost), self.dice.chance(0.5)) {
            self.turn_chain(e);
            return true;
        }
        let lacks = |walk: &Self, v: usize| {
            Heading::BOTH.map(|heading| walk.ways.labels(heading)[v].is_infinite())
        };
        let lost: Vec<usize> = (0..model.problem.vertices)
            .filter(|&v| self.state.degree[v] > 0 && lacks(self, v).contains(&true))
            .collect();
        let Some(v) = self.dice.pick(&lost) else {
            return false;
        };
        let lacking = lacks(self, v);
        let mut any = false;
        for (heading, _) in Heading::BOTH.into_iter().zip(lacking).filter(|&(_, l)| l) {
            let mut manner = self.manner(f64::INFINITY);
            manner.through = true;
            manner.heading = Some(heading);
            any |= self.path_one_way(v, usize::MAX, &manner);
        }
        any
    }

    /// Turns a chain, or a tour.
    pub(super) fn turn(&mut self) {
        let Some(e) = self.dice.pick(self.state.turnable.items()) else {
            return;
        };
        if self.dice.chance(0.6) {
            self.turn_chain(e);
        } else {
            self.turn_tour(e);
        }
    }

    /// Turns an edge, and the edges that follow on both sides as far as there is
    /// nowhere else to go.
    fn turn_chain(&mut self, e: usize) {
        self.state.turn(e);
        let [a, b] = self.model.problem.ends[e];
        let (tail, head) = if self.state.backward[e] {
            (b, a)
        } else {
            (a, b)
        };
        for (start, heading) in [(head, Heading::Out), (tail, Heading::In)] {
            let (mut at, mut last) = (start, e);
            while self.state.degree[at] == 2 && !self.model.problem.sinks[at] {
                let mut next = self.model.around.of(at).iter();
                let next = next.find(|&&(k, _)| k != last && self.state.active[k]);
                let Some(&(k, w)) = next else { break };
                if k == e || self.model.problem.way(k) != Way::Either {
                    break;
                }
                self.point(k, at, heading);
                (at, last) = (w, k);
            }
        }
    }

    /// Turns a way from a sink over an edge to a sink.
    fn turn_tour(&mut self, e: usize) {
        self.ways.measure(self.model, &self.state);
        if self.ways.loses(self.model, &self.state, e) {
            return;
        }
        let (model, problem) = (self.model, self.model.problem);
        let [a, b] = problem.ends[e];
        let (tail, head) = if self.state.backward[e] {
            (b, a)
        } else {
            (a, b)
        };
        let mut tour = vec![e];
        for (start, heading) in [(head, Heading::Out), (tail, Heading::In)] {
            let labels = self.ways.labels(heading);
            let mut at = start;
            while !problem.sinks[at] {
                let next = model.around.of(at).iter().find(|&&(k, w)| {
                    let near = usize::from(problem.ends[k][1] == at);
                    // The way was computed as this very sum.
                    self.state.active[k]
                        && labels[at] == labels[w] + problem.travel_cost(k)
                        && self.state.way(model, k).runs_from(heading.tail(near))
                });
                let Some(&(k, w)) = next else { return };
                tour.push(k);
                at = w;
            }
        }
        // What lies on both of its halves is passed both ways, and stays.
        tour.sort_unstable();
        for (k, &e) in tour.iter().enumerate() {
            let twice = k > 0 && tour[k - 1] == e || tour.get(k + 1) == Some(&e);
            if !twice && problem.way(e) == Way::Either {
                self.state.turn(e);
            }
        }
    }

    /// Turns the inactive edges of a cycle so that they lead from where its active
    /// ones lead from to where they lead to.
    pub(super) fn point_cycle(&mut self, edges: &[usize]) {
        let (model, problem) = (self.model, self.model.problem);
        if model.turns.is_none() {
            return;
        }
        // Edges in the order of the cycle, with the vertices that they start at.
        let Some(&first) = edges.first() else {
            return;
        };
        let [start, mut at] = problem.ends[first];
        let mut round = vec![(first, start)];
        while at != start && round.len() < edges.len() {
            let last = round.last().map_or(first, |&(e, _)| e);
            let next = (edges.iter()).find(|&&e| e != last && problem.ends[e].contains(&at));
            let Some(&e) = next else { return };
            round.push((e, at));
            at = other(problem.ends[e], at);
        }
        let mut along = 0_i32;
        for &(e, v) in round.iter().filter(|&&(e, _)| self.state.active[e]) {
            let end = usize::from(problem.ends[e][1] == v);
            let way = self.state.way(model, e);
            along += i32::from(way.runs_from(end)) - i32::from(way.runs_from(1 - end));
        }
        let heading = match along {
            0 => self.coin(),
            1.. => Heading::In,
            _ => Heading::Out,
        };
        for (e, v) in round {
            if !self.state.active[e] {
                self.point(e, v, heading);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{cost, verify, EdgeState, Network, Violation};
    use crate::dice::Dice;
    use crate::solve::search::score::Score;

    /// A ring of twelve with chords, some of it given, with all kinds of ways.
    fn ring() -> Problem {
        let mut ends: Vec<[usize; 2]> = (0..12).map(|v| [v, (v + 1) % 12]).collect();
        ends.extend([[0, 5], [2, 8], [3, 10]]);
        let mut states = vec![EdgeState::Open; 15];
        for e in [0, 1, 7] {
            states[e] = EdgeState::Given;
        }
        let mut ways = vec![Way::Both; 15];
        ways[1] = Way::Forward;
        ways[3] = Way::Backward;
        for e in [0, 7, 8, 10, 13, 14] {
            ways[e] = Way::Either;
        }
        Problem {
            vertices: 12,
            lengths: (0..15).map(|e| 1.0 + f64::from(e % 4)).collect(),
            travel_costs: (0..15).map(|e| 1.0 + f64::from(e % 3)).collect(),
            states,
            sinks: (0..12).map(|v| v == 0 || v == 6).collect(),
            dead_ends: true,
            length_weight: 1.0,
            travel_weight: 1.0,
            ways,
            ends,
            ..Problem::default()
        }
    }

    /// Whatever edges are flipped and turned, islands and travel are those of the
    /// checker, and all can be taken back.
    #[test]
    fn ways_with_directions_are_those_of_the_checker() {
        let problem = ring();
        problem.check().expect("fits together");
        let model = Model::new(&problem).expect("has solutions");
        let mut state = State::new(&model);
        let mut ways = Ways::new(&model);
        let mut dice = Dice::new(2);
        let mut valid = 0;
        let mut few = usize::MAX;
        for _ in 0..2000 {
            let e = dice.below(15);
            let before = (state.active.clone(), state.backward.clone());
            if model.fates[e] == Fate::Open && dice.chance(0.5) {
                state.flip(&model, e);
            } else {
                state.turn(e);
            }
            let score = Score::of(&model, &state, &mut ways);
            let network = Network {
                active: state.active.clone(),
                ways: state.decided_ways(&model),
                ..Network::default()
            };
            let found = verify(&problem, &network);
            assert_eq!(score.is_valid(), found.is_empty(), "{found:?}");
            assert!(!found.iter().any(|v| matches!(
                v,
                Violation::NoDirection { .. } | Violation::WrongWay { .. }
            )));
            if found.is_empty() {
                valid += 1;
                // Halves of whole numbers: no rounding anywhere.
                assert_eq!(score.objective, cost(&problem, &network).objective);
            }
            // Not to be lost among networks that are none.
            let islands = score.faults[2];
            if islands > few && dice.chance(0.9) {
                state.undo(&model, 0);
                assert_eq!(before, (state.active.clone(), state.backward.clone()));
            } else {
                few = islands;
                state.settle();
            }
        }
        assert!((20..1950).contains(&valid), "{valid}");
    }

    /// Moves alone find valid networks, and take back what they did.
    #[test]
    fn moves_keep_directions_and_take_them_back() {
        for dead_ends in [false, true] {
            let mut problem = ring();
            problem.dead_ends = dead_ends;
            problem.coverage = vec![vec![9], vec![4], vec![11]];
            let model = Model::new(&problem).expect("has solutions");
            let mut walk = Walk::new(&model, 5);
            let mut valid = 0;
            for k in 0..2000 {
                let before = (walk.state.active.clone(), walk.state.backward.clone());
                let mark = walk.state.mark();
                walk.step();
                let score = Score::of(&model, &walk.state, &mut walk.ways);
                valid += usize::from(score.is_valid());
                if k % 3 == 0 {
                    walk.state.undo(&model, mark);
                    assert_eq!(before.0, walk.state.active);
                    assert_eq!(before.1, walk.state.backward);
                } else {
                    walk.state.settle();
                }
            }
            assert!(valid > 20, "{valid}");
        }
    }
}
