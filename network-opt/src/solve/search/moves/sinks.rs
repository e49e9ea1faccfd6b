//! Moves of sinks whose places are open, and of routes that need not be there.

use super::Walk;
use crate::solve::search::score::Score;

impl Walk<'_, '_> {
    /// Moves a sink that was placed to a candidate nearby, on a street, or
    /// anywhere; a street follows it.
    pub(super) fn move_sink(&mut self) {
        let Some(from) = self.dice.pick(self.state.placed.items()) else {
            return;
        };
        if self.dice.chance(0.3) {
            self.fit_sink(from);
            return;
        }
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

    /// Moves all sinks that were placed to random candidates.
    pub(in super::super) fn scatter_sinks(&mut self) {
        let Some(placing) = &self.model.placing else {
            return;
        };
        for from in self.state.placed.items().to_vec() {
            match self.dice.pick(&placing.candidates) {
                Some(to) if !self.state.sinks[to] => self.state.move_sink(self.model, from, to),
                _ => {}
            }
        }
    }

    /// Moves a sink along the streets to where ways are shortest, of the places
    /// nearby.
    fn fit_sink(&mut self, sink: usize) {
        let Some(placing) = &self.model.placing else {
            return;
        };
        let (mut at, mut best) = (sink, None);
        for &to in std::iter::once(&sink).chain(placing.near.of(sink)) {
            if to != sink && (self.state.sinks[to] || self.state.degree[to] == 0) {
                continue;
            }
            if to != at {
                self.state.move_sink(self.model, at, to);
                at = to;
            }
            let score = Score::of(self.model, &self.state, &mut self.ways);
            let total = self.fines.total(&score);
            if to != sink && best.is_none_or(|(least, _)| total < least) {
                best = Some((total, to));
            }
        }
        if let Some((_, to)) = best.filter(|&(_, to)| to != at) {
            self.state.move_sink(self.model, at, to);
        }
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
            if may && (!(0.6..0.85).contains(&draw) || self.state.degree[to] > 0) {
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

    /// Makes all routes that are missing active at once: each alone may cost more
    /// than it saves until others share its streets.
    pub(in super::super) fn open_lapsed(&mut self) {
        let mut lapsed = self.state.lapsed.items().to_vec();
        self.dice.shuffle(&mut lapsed);
        for route in lapsed {
            self.open_route(route);
        }
        self.repair(16);
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
