//! What is wrong with a network, and moves that mend it.

use super::Walk;
use crate::solve::search::ears::Manner;

/// Something that is wrong, and where.
#[derive(Clone, Copy, Debug)]
enum Fault {
    DeadEnd(usize),
    Missing(usize),
    Cut(usize),
    Crossed(usize),
    Shut(usize),
    Idle(usize),
    Count(usize),
    Wish(usize),
}

impl Walk<'_, '_> {
    /// Mends faults one by one, as often as told. Says whether it mended any.
    pub(super) fn repair(&mut self, rounds: usize) -> bool {
        let mut any = false;
        for _ in 0..rounds {
            if self.model.turns.is_some() && self.dice.chance(0.3) {
                any |= self.join_island();
            }
            let Some(fault) = self.fault() else {
                return self.join_island() || any;
            };
            let forced = self.dice.chance(0.2);
            let breach = if forced {
                3.0 * self.model.unit
            } else {
                f64::INFINITY
            };
            let manner = self.manner(breach);
            let mended = match fault {
                Fault::DeadEnd(v) => self.path_from(v, usize::MAX, &manner),
                Fault::Missing(row) => match self.vertex_of(row) {
                    Some(v) => self.ear_through(v, &manner),
                    None => false,
                },
                Fault::Cut(route) => self.open_route(route),
                Fault::Crossed(room) => self.free_room(room),
                Fault::Idle(sink) => self.serve_sink(sink),
                Fault::Shut(room) if self.dice.chance(0.4) => {
                    let count = 2 + self.dice.below(4);
                    self.retile(room, count)
                }
                Fault::Shut(room) => self.open_room(room, &manner),
                Fault::Count(count) => self.even(count),
                Fault::Wish(wish) => self.grant(wish),
            };
            if mended && forced {
                self.shove();
                self.drop_islands();
            }
            if !mended && self.dice.chance(0.3) {
                // What cannot be reached now may be from elsewhere.
                self.extend();
            }
            any |= mended;
        }
        any
    }

    /// A fault to be mended: mostly of the first kind that there is, since what
    /// is mended last may mend others by the way.
    fn fault(&mut self) -> Option<Fault> {
        let (state, dice) = (&self.state, &mut self.dice);
        let faults = [
            dice.pick(state.dead_ends.items()).map(Fault::DeadEnd),
            dice.pick(state.missing.items()).map(Fault::Missing),
            dice.pick(state.cut.items()).map(Fault::Cut),
            dice.pick(state.rooms.crossed.items()).map(Fault::Crossed),
            dice.pick(state.rooms.shut.items()).map(Fault::Shut),
            dice.pick(state.rooms.wrong.items()).map(Fault::Count),
            dice.pick(state.rooms.unmet.items()).map(Fault::Wish),
            dice.pick(state.idle.items()).map(Fault::Idle),
        ];
        let kinds = faults.iter().flatten().count();
        if kinds == 0 {
            return None;
        }
        let which = if dice.chance(0.8) {
            0
        } else {
            dice.below(kinds)
        };
        faults.into_iter().flatten().nth(which)
    }

    /// The best of some vertices that would cover a row.
    fn vertex_of(&mut self, row: usize) -> Option<usize> {
        let mut best = None;
        for _ in 0..3 {
            let v = self.dice.pick(self.model.rows.of(row))?;
            let gain = self.state.gain(v);
            if best.is_none_or(|(_, known)| gain > known) {
                best = Some((v, gain));
            }
        }
        best.map(|(v, _)| v)
    }

    /// Gives a room a corridor on its border.
    fn open_room(&mut self, room: usize, manner: &Manner) -> bool {
        let Some(rooms) = &self.model.rooms else {
            return false;
        };
        match self.dice.pick(rooms.borders.of(room)) {
            Some(e) if self.state.rooms.inside[e] == 0 => self.ear_over(e, manner),
            _ => false,
        }
    }

    /// Takes the corridors out of a room: by other rooms in its place, or else
    /// by removing them.
    fn free_room(&mut self, room: usize) -> bool {
        for _ in 0..2 {
            let count = 2 + self.dice.below(4);
            if self.retile(room, count) {
                return true;
            }
        }
        let Some(rooms) = &self.model.rooms else {
            return false;
        };
        for &e in rooms.inners.of(room) {
            if self.state.active[e] {
                self.remove(e, !self.model.problem.dead_ends);
            }
        }
        self.drop_islands();
        true
    }

    /// Joins an island to the rest, if there is one.
    fn join_island(&mut self) -> bool {
        if self.ways.measure(self.model, &self.state).islands == 0 {
            return false;
        }
        if self.model.turns.is_some() {
            return self.join_lost();
        }
        let lost: Vec<usize> = (0..self.model.problem.vertices)
            .filter(|&v| self.state.degree[v] > 0 && self.ways.away[v].is_infinite())
            .collect();
        let mut manner = self.manner(f64::INFINITY);
        manner.reached = true;
        match self.dice.pick(&lost) {
            Some(v) => self.path_from(v, usize::MAX, &manner),
            None => false,
        }
    }
}
