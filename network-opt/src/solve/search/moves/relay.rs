//! Moves of a part of a chain.
//!
//! Where sinks lie inside the mesh, or are few, a network is two or three
//! chains, each as long as the mesh is wide or longer. To remove a whole one is
//! to begin anew, and to slide its corners one by one leads through what is
//! dearer; what lies between is a part of a chain that takes another way.

use super::Walk;

/// Edges of the part that is removed, at most, to either side of the first: of
/// all sizes, since corners are as far apart as what is to be covered lets them.
const REACHES: [usize; 5] = [3, 6, 12, 24, 48];

impl Walk<'_, '_> {
    /// Removes a part of a chain and lays its ends anew: to each other, or to
    /// whatever else they come to.
    pub(super) fn relay(&mut self) {
        let Some(first) = self.dice.pick(self.state.removable.items()) else {
            return;
        };
        let reach = REACHES[self.dice.below(REACHES.len())];
        let mut ends = self.model.problem.ends[first];
        if self.dice.chance(0.5) {
            ends.reverse();
        }
        self.state.flip(self.model, first);
        self.near.extend(ends);
        let ends = ends.map(|v| {
            let steps = self.dice.below(reach);
            self.shorten(v, steps)
        });
        if self.dice.chance(0.5) {
            // By way of a place beside.
            self.extend_near();
        }
        let breach = if self.dice.chance(0.5) {
            self.model.unit * [0.3, 1.0, 3.0][self.dice.below(3)]
        } else {
            f64::INFINITY
        };
        for v in ends {
            if self.state.dead_ends.contains(v) {
                let manner = self.manner(breach);
                self.path_from(v, usize::MAX, &manner);
            }
        }
        self.shove();
        let rounds = self.dice.below(3);
        self.repair(rounds);
        if !self.model.problem.dead_ends {
            ends.into_iter().for_each(|v| self.trim(v));
        }
        self.drop_islands();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{EdgeState, Network, Problem};
    use crate::solve::search::model::Model;
    use crate::solve::search::score::Score;

    /// A ladder of eight rungs between two sinks, and a street that leaves its
    /// lower rail for the upper one: swaps of single squares' edges bring it back
    /// square by square, this move at once.
    #[test]
    fn a_detour_of_many_edges_is_straightened_in_one_move() {
        const N: usize = 8;
        let mut ends: Vec<[usize; 2]> = Vec::new();
        ends.extend((0..N - 1).map(|v| [v, v + 1]));
        ends.extend((N..2 * N - 1).map(|v| [v, v + 1]));
        ends.extend((0..N).map(|v| [v, v + N]));
        let mut sinks = vec![false; 2 * N];
        sinks[0] = true;
        sinks[N - 1] = true;
        let edges = ends.len();
        let problem = Problem {
            vertices: 2 * N,
            lengths: vec![1.0; edges],
            states: vec![EdgeState::Open; edges],
            sinks,
            coverage: vec![vec![3, 3 + N], vec![4, 4 + N]],
            length_weight: 1.0,
            ends,
            ..Problem::default()
        };
        let model = Model::new(&problem).expect("no contradiction");
        let mut walk = Walk::new(&model, 3);
        let detour = |&[a, b]: &[usize; 2]| {
            let lower = b < N && (a < 1 || b > N - 2);
            let upper = a > N && b < 2 * N - 1;
            let rung = b == a + N && (a == 1 || a == N - 2);
            lower || upper || rung
        };
        let network = Network {
            active: problem.ends.iter().map(detour).collect(),
            ways: walk.state.network(&model).ways,
            ..Network::default()
        };
        walk.state.become_network(&model, &network);
        let before = Score::of(&model, &walk.state, &mut walk.ways);
        assert!(before.is_valid());
        assert_eq!(before.objective, (N + 1) as f64);
        let mut least = f64::INFINITY;
        for _ in 0..200 {
            walk.moves += 1;
            let mark = walk.state.mark();
            walk.relay();
            let after = Score::of(&model, &walk.state, &mut walk.ways);
            if after.is_valid() {
                least = least.min(after.objective);
            }
            walk.state.undo(&model, mark);
            assert_eq!(walk.state.network(&model), network);
        }
        assert_eq!(least, (N - 1) as f64);
    }
}
