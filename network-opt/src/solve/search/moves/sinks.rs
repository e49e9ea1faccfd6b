//! Moves of sinks whose places are open, and of routes that need not be there.

use super::Walk;

impl Walk<'_, '_> {
    /// Moves a sink that was placed to a candidate nearby, on a street, or
    /// anywhere; a street follows it.
    pub(super) fn move_sink(&mut self) {
        let Some(from) = self.dice.pick(self.state.placed.items()) else {
            return;
        };
        let Some(to) = self.next_place(from) else {
            return;
        };
        let mark = self.state.mark();
        self.state.move_sink(self.model, from, to);
        self.near.extend([from, to]);
        if self.state.degree[to] == 0 {
            let manner = self.manner(f64::INFINITY);
            if !self.path_from(to, usize::MAX, &manner) {
                self.state.undo(self.model, mark);
                return;
            }
        }
        if !self.model.problem.dead_ends && self.dice.chance(0.7) {
            self.trim(from);
        }
        self.drop_islands();
    }

    /// A candidate that is no sink.
    fn next_place(&mut self, from: usize) -> Option<usize> {
        let placing = self.model.placing.as_ref()?;
        let draw = self.dice.unit();
        for _ in 0..8 {
            let to = if draw < 0.5 {
                self.dice.pick(placing.near.of(from))
            } else if draw < 0.6 && !self.state.dead_ends.is_empty() {
                self.dice.pick(self.state.dead_ends.items())
            } else {
                self.dice.pick(&placing.candidates)
            };
            let to = to?;
            let may = self.model.may_sink[to] && !self.state.sinks[to];
            // Mostly to where there is a street already.
            if may && (draw < 0.6 || draw > 0.85 || self.state.degree[to] > 0) {
                return Some(to);
            }
        }
        None
    }

    /// Gives a sink without a street one, or another place.
    pub(super) fn serve_sink(&mut self, sink: usize) -> bool {
        if self.dice.chance(0.6) {
            let manner = self.manner(f64::INFINITY);
            if self.path_from(sink, usize::MAX, &manner) {
                return true;
            }
        }
        match self.next_place(sink) {
            Some(to) => {
                self.state.move_sink(self.model, sink, to);
                true
            }
            None => false,
        }
    }

    /// Makes one of the paths of a route active: of a few the one that lacks the
    /// fewest edges.
    pub(super) fn open_route(&mut self, route: usize) -> bool {
        let mut best = None;
        for _ in 0..4 {
            let Some(path) = self.dice.pick(self.model.routes.of(route)) else {
                return false;
            };
            let lacks = self.state.lacking[path];
            if best.is_none_or(|(least, _)| lacks < least) {
                best = Some((lacks, path));
            }
        }
        let Some((_, path)) = best else {
            return false;
        };
        for &e in self.model.paths.of(path) {
            if !self.state.active[e] {
                self.add(e);
            }
        }
        self.shove();
        true
    }
}
