//! What the search does to a network: each move changes the state by any
//! number of logged steps, and whoever asked for it takes them back or not.

mod relay;
mod repair;
mod sinks;

use super::ears::{Finder, Manner};
use super::model::{Fate, Model};
use super::score::Fines;
use super::state::State;
use super::ways::Ways;
use crate::dice::Dice;

/// The share of moves that lay a part of a chain anew. Without them the search
/// hardly finds from one network of few long chains to another; from a fifth to
/// three fifths of them it hardly matters how many.
const RELAYS: f64 = 0.4;

/// A state with all that its moves need.
#[derive(Debug)]
pub(super) struct Walk<'m, 'p> {
    pub(super) model: &'m Model<'p>,
    pub(super) state: State,
    pub(super) ways: Ways,
    pub(super) dice: Dice,
    pub(super) fines: Fines,
    pub(super) finder: Finder,
    /// The move in which each edge was added, so that it is not shoved away in it.
    added: Vec<u64>,
    pub(super) moves: u64,
    /// Vertices near what the move has removed.
    near: Vec<usize>,
    /// Whether it is certain that the rooms tile the faces in no way.
    pub(super) untileable: bool,
}

impl<'m, 'p> Walk<'m, 'p> {
    pub(super) fn new(model: &'m Model<'p>, seed: u64) -> Self {
        Self {
            model,
            state: State::new(model),
            ways: Ways::new(model),
            dice: Dice::new(seed),
            fines: Fines::new(model.unit),
            finder: Finder::new(model),
            added: vec![0; model.problem.edges()],
            moves: 0,
            near: Vec::new(),
            untileable: false,
        }
    }

    /// One move, drawn at random.
    pub(super) fn step(&mut self) {
        self.moves += 1;
        self.near.clear();
        let draw = self.dice.unit();
        if !self.state.rooms.bare.is_empty() {
            self.tile_bare();
            return;
        }
        if !self.state.turnable.is_empty() && self.dice.chance(0.15) {
            self.turn();
            return;
        }
        if let Some(room) = self.dice.pick(self.state.rooms.placed.items()) {
            if self.dice.chance(0.3) {
                match self.dice.pick(self.state.rooms.denied.items()) {
                    Some(wish) if self.dice.chance(0.3) => {
                        self.grant(wish);
                    }
                    _ => {
                        let count = 2 + self.dice.below(4);
                        self.retile(room, count);
                    }
                }
                self.repair(2);
                return;
            }
        }
        if self.model.placing.is_some() && self.dice.chance(0.12) {
            self.move_sink();
            self.repair(2);
            return;
        }
        if !self.state.lapsed.is_empty() && self.dice.chance(0.08) {
            if let Some(route) = self.dice.pick(self.state.lapsed.items()) {
                self.open_route(route);
                self.repair(3);
                return;
            }
        }
        if self.dice.chance(RELAYS) {
            self.relay();
            return;
        }
        if self.state.removable.is_empty() || draw < 0.1 {
            if !self.repair(4) {
                self.extend();
            }
        } else if draw < 0.12 {
            self.flip();
        } else if draw < 0.27 {
            self.drop_chain();
        } else if draw < 0.57 {
            self.drop_chain();
            let rounds = 1 + self.dice.below(3);
            self.extend_near();
            self.repair(rounds);
        } else if draw < 0.62 {
            self.ruin();
            self.repair(8);
        } else if draw < 0.81 {
            self.toggle_cycle();
            if self.model.rooms.is_some() {
                self.repair(3);
            }
        } else {
            self.force();
            self.repair(3);
        }
    }

    /// One edge alone, whatever that does: no network is out of reach.
    fn flip(&mut self) {
        let e = self.dice.below(self.model.problem.edges());
        if self.model.fates[e] == Fate::Open {
            self.add(e);
        }
    }

    pub(super) fn manner(&mut self, breach: f64) -> Manner {
        let noise = [0.0, 0.5, 1.0, 3.0][self.dice.below(4)];
        Manner {
            noise,
            salt: self.dice.bits(),
            breach,
            breakthrough: f64::INFINITY,
            reward: self.fines.rate(0) * self.dice.unit(),
            opening: self.fines.rate(5) * self.dice.unit(),
            reached: false,
            heading: None,
            through: false,
            pull: 3.0 * self.dice.unit(),
        }
    }

    pub(super) fn add(&mut self, e: usize) {
        self.added[e] = self.moves;
        self.state.flip(self.model, e);
    }

    /// Removes an edge and, if that is wanted, what it leaves as dead ends.
    fn remove(&mut self, e: usize, trim: bool) {
        if !self.state.removable.contains(e) {
            return;
        }
        self.state.flip(self.model, e);
        for v in self.model.problem.ends[e] {
            self.near.push(v);
            if trim {
                self.trim(v);
            }
        }
    }

    /// Removes edges from a dead end on to where there is none.
    fn trim(&mut self, v: usize) {
        self.shorten(v, usize::MAX);
    }

    /// Removes edges from a dead end on, so many at most, and not beyond where
    /// chains meet. Says where it comes to.
    fn shorten(&mut self, mut v: usize, steps: usize) -> usize {
        for _ in 0..steps {
            if self.state.degree[v] != 1 || self.state.sinks[v] {
                break;
            }
            let active = |&&(e, _): &&(usize, usize)| self.state.active[e];
            let Some(&(e, w)) = self.model.around.of(v).iter().find(active) else {
                break;
            };
            if !self.state.removable.contains(e) {
                break;
            }
            self.state.flip(self.model, e);
            self.near.push(w);
            v = w;
        }
        v
    }

    /// Removes what reaches no sink.
    fn drop_islands(&mut self) {
        if self.ways.measure(self.model, &self.state).islands == 0 {
            return;
        }
        let ends = &self.model.problem.ends;
        let lost: Vec<usize> = (self.state.removable.items().iter())
            .filter(|&&e| self.ways.loses(self.model, &self.state, e))
            .copied()
            .collect();
        for e in lost {
            self.state.flip(self.model, e);
            self.near.extend(ends[e]);
        }
    }

    /// Removes a chain.
    fn drop_chain(&mut self) {
        if let Some(e) = self.dice.pick(self.state.removable.items()) {
            // Where dead ends are allowed a chain may also be shortened.
            let trim = !self.model.problem.dead_ends || self.dice.chance(0.5);
            self.remove(e, trim);
            self.drop_islands();
        }
    }

    /// Removes all chains within a few steps of a vertex.
    fn ruin(&mut self) {
        let Some(e) = self.dice.pick(self.state.removable.items()) else {
            return;
        };
        let hops = 1 + self.dice.below(3);
        let mut ball = vec![self.model.problem.ends[e][0]];
        let mut last = 0..1;
        for _ in 0..hops {
            for at in last.clone() {
                for &(_, w) in self.model.around.of(ball[at]) {
                    if !ball.contains(&w) {
                        ball.push(w);
                    }
                }
            }
            last = last.end..ball.len();
        }
        for v in ball {
            for &(e, _) in self.model.around.of(v) {
                self.remove(e, !self.model.problem.dead_ends);
            }
        }
        self.drop_islands();
    }

    /// Swaps active and inactive edges of a short cycle: slides a corner, makes
    /// or flattens a bump.
    fn toggle_cycle(&mut self) {
        let Some(e) = self.dice.pick(self.state.removable.items()) else {
            return;
        };
        let Some(cycle) = self.dice.pick(self.model.cycles_at.of(e)) else {
            return;
        };
        let edges = self.model.cycles.of(cycle);
        self.point_cycle(edges);
        for &e in edges {
            if self.state.active[e] {
                self.state.flip(self.model, e);
            } else {
                self.add(e);
            }
        }
        if !self.model.problem.dead_ends {
            for &e in edges {
                for v in self.model.problem.ends[e] {
                    self.trim(v);
                }
            }
        }
        self.shove();
        self.drop_islands();
    }

    /// An ear through any vertex.
    fn extend(&mut self) {
        let v = self.dice.below(self.model.problem.vertices);
        let manner = self.manner(f64::INFINITY);
        self.ear_through(v, &manner);
    }

    /// An ear through a vertex near what was removed.
    fn extend_near(&mut self) {
        if let Some(v) = self.dice.pick(&self.near) {
            let v = match self.dice.pick(self.model.around.of(v)) {
                Some((_, w)) if self.dice.chance(0.7) => w,
                _ => v,
            };
            let manner = self.manner(f64::INFINITY);
            self.ear_through(v, &manner);
        }
    }

    /// An ear that does not care what is in its way: that is removed.
    fn force(&mut self) {
        let v = self.dice.below(self.model.problem.vertices);
        let breach = self.model.unit * [0.3, 1.0, 3.0][self.dice.below(3)];
        let mut manner = self.manner(breach);
        manner.breakthrough = breach;
        if self.ear_through(v, &manner) {
            self.shove();
            self.drop_islands();
        }
    }

    /// Removes chains that make forbidden patterns with what was added.
    fn shove(&mut self) {
        for _ in 0..64 {
            let Some(p) = self.dice.pick(self.state.broken.items()) else {
                return;
            };
            let older: Vec<usize> = (self.model.patterns.of(p).iter())
                .filter(|&&(e, on)| on && self.added[e] != self.moves)
                .map(|&(e, _)| e)
                .filter(|&e| self.state.removable.contains(e))
                .collect();
            let Some(e) = self.dice.pick(&older) else {
                return;
            };
            self.remove(e, !self.model.problem.dead_ends);
        }
    }

    /// Adds a path from a vertex to the network, over edges that are inactive.
    pub(super) fn path_from(&mut self, v: usize, besides: usize, manner: &Manner) -> bool {
        if self.model.turns.is_some() {
            return self.path_one_way(v, besides, manner);
        }
        let (model, away) = (self.model, &self.ways.away);
        let found = self
            .finder
            .find(model, &self.state, away, v, besides, manner);
        for k in 0..self.finder.path.len() {
            self.add(self.finder.path[k]);
        }
        found.is_some()
    }

    /// Adds an ear through a vertex: two paths from it to the network, or one
    /// if it is part of it, or if dead ends are allowed.
    fn ear_through(&mut self, v: usize, manner: &Manner) -> bool {
        const NOWHERE: usize = usize::MAX;
        if self.model.turns.is_some() {
            return self.loop_through(v, manner);
        }
        let mark = self.state.mark();
        let inside = self.state.is_stop(v);
        if !self.path_from(v, NOWHERE, manner) {
            return false;
        }
        if inside || self.model.problem.dead_ends && self.dice.chance(0.7) {
            return true;
        }
        if self.path_from(v, NOWHERE, manner) || self.model.problem.dead_ends {
            return true;
        }
        self.state.undo(self.model, mark);
        false
    }

    /// Adds an edge with paths from its ends to the network, as needed.
    fn ear_over(&mut self, e: usize, manner: &Manner) -> bool {
        if self.state.active[e] || self.model.fates[e] == Fate::Off {
            return false;
        }
        let mark = self.state.mark();
        let mut ends = self.model.problem.ends[e];
        if self.dice.chance(0.5) {
            ends.reverse();
        }
        let [a, b] = ends;
        let [near, far] = ends.map(|v| self.state.is_stop(v));
        self.add(e);
        if self.model.turns.is_some() {
            let done = self.join_ends(e, ends, [near, far], manner);
            if !done {
                self.state.undo(self.model, mark);
            }
            return done;
        }
        let dead_ends = self.model.problem.dead_ends;
        // The first path must not end at the other end, or it were an island.
        let first = near || far && dead_ends || self.path_from(a, b, manner);
        let second = far || dead_ends || self.path_from(b, usize::MAX, manner);
        if first && second {
            return true;
        }
        self.state.undo(self.model, mark);
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{
        cost_of, verify, EdgeState, Pattern, PatternKind, PlacedSinks, Placement, Problem, Rooms,
        Route,
    };
    use crate::solve::search::score::Score;

    /// A grid of four by four squares with a bit of everything.
    fn mixed(rooms: bool) -> Problem {
        let mut ends: Vec<[usize; 2]> = Vec::new();
        ends.extend((0..25).filter(|v| v % 5 < 4).map(|v| [v, v + 1]));
        ends.extend((0..20).map(|v| [v, v + 5]));
        let at = |a: usize, b: usize| ends.iter().position(|&e| e == [a, b]).expect("an edge");
        let corner = |f: usize| f / 4 * 5 + f % 4;
        let sides = |f: usize| {
            let v = corner(f);
            [
                at(v, v + 1),
                at(v + 1, v + 6),
                at(v + 5, v + 6),
                at(v, v + 5),
            ]
        };
        let pattern = |active: Vec<usize>, inactive: Vec<usize>, cost| Pattern {
            kind: PatternKind::TooClose,
            active,
            inactive,
            cost,
        };
        let mut patterns: Vec<Pattern> = (0..16)
            .map(|f| {
                pattern(
                    vec![sides(f)[0], sides(f)[2]],
                    vec![],
                    (f % 2 == 0).then_some(0.7),
                )
            })
            .collect();
        patterns.push(pattern(
            vec![at(6, 7), at(7, 8)],
            vec![at(7, 12)],
            Some(0.4),
        ));
        patterns.push(pattern(
            vec![at(16, 17), at(11, 16), at(11, 12)],
            vec![],
            None,
        ));
        let mut states = vec![EdgeState::Open; 40];
        states[at(0, 1)] = EdgeState::Given;
        states[at(1, 2)] = EdgeState::Required;
        states[at(18, 19)] = EdgeState::Closed;
        let mut sinks = vec![false; 25];
        sinks[0] = true;
        sinks[24] = true;
        // Single squares and pairs side by side.
        let mut placements: Vec<Placement> = (0..16)
            .map(|f| Placement {
                template: "one".into(),
                faces: vec![f],
                inner: vec![],
                border: sides(f).to_vec(),
            })
            .collect();
        placements.extend((0..16).filter(|f| f % 4 < 3).map(|f| {
            Placement {
                template: "two".into(),
                faces: vec![f, f + 1],
                inner: vec![sides(f)[1]],
                border: [sides(f).as_slice(), &sides(f + 1)]
                    .concat()
                    .into_iter()
                    .filter(|&e| e != sides(f)[1])
                    .collect(),
            }
        }));
        Problem {
            vertices: 25,
            lengths: (0..40).map(|e| 1.0 + f64::from(e % 3)).collect(),
            states,
            sinks,
            coverage: vec![vec![12], vec![3, 4, 9], vec![20, 21]],
            required_vertices: vec![22],
            routes: vec![
                vec![vec![at(2, 3), at(3, 8)], vec![at(2, 7), at(7, 8)]].into(),
                Route {
                    cost: Some(1.5),
                    ..vec![vec![at(6, 11), at(11, 16)], vec![at(13, 14)]].into()
                },
            ],
            patterns,
            rooms: rooms.then(|| Rooms {
                placements,
                covered: vec![true; 16],
                ..Rooms::default()
            }),
            length_weight: 1.0,
            travel_weight: 0.5,
            ends,
            ..Problem::default()
        }
    }

    /// After every move the counters say what the checker says, and a move
    /// taken back leaves no trace.
    #[test]
    fn counters_agree_with_the_checker_after_every_move() {
        for k in 0..8 {
            let [rooms, dead_ends, placed] = [1, 2, 4].map(|bit| k & bit != 0);
            let mut problem = mixed(rooms);
            problem.dead_ends = dead_ends;
            if placed {
                problem.sinks[24] = false;
                problem.placed = Some(PlacedSinks {
                    candidates: vec![4, 9, 12, 20, 23, 24],
                    count: 2,
                });
            }
            problem.check().expect("fits together");
            let model = Model::new(&problem).expect("no contradiction");
            let mut walk = Walk::new(&model, 7);
            let mut valid = 0;
            for k in 0..3000 {
                let before = (walk.state.network(&model), walk.state.rooms.owner.clone());
                let score = Score::of(&model, &walk.state, &mut walk.ways);
                let mark = walk.state.mark();
                walk.step();
                let after = Score::of(&model, &walk.state, &mut walk.ways);
                let network = walk.state.network(&model);
                let found = verify(&problem, &network);
                assert_eq!(
                    after.is_valid(),
                    found.is_empty(),
                    "{:?} {found:?}",
                    after.faults
                );
                if after.is_valid() {
                    valid += 1;
                    let cost = cost_of(&problem, &network).objective;
                    // A few thousand additions of numbers below 100.
                    assert!((cost - after.objective).abs() < 1e-9);
                }
                if k % 3 == 0 && walk.fines.total(&after) > walk.fines.total(&score) {
                    walk.state.undo(&model, mark);
                    let again = Score::of(&model, &walk.state, &mut walk.ways);
                    assert_eq!(again.faults, score.faults);
                    assert_eq!(
                        before,
                        (walk.state.network(&model), walk.state.rooms.owner.clone())
                    );
                } else {
                    walk.state.settle();
                }
            }
            assert!(valid > 20, "{valid} with rooms {rooms}");
        }
    }
}
