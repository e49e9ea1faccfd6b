//! A network in the making, with counters of all that can be wrong with it.

use super::lists::Subset;
use super::model::{Fate, Model};
use crate::design::{Network, Way};

/// What was done, to be undone.
#[derive(Clone, Copy, Debug)]
enum Deed {
    Flip(usize),
    Turn(usize),
    Place(usize),
    Clear(usize),
    /// A sink was moved from one vertex to another.
    Move(usize, usize),
}

/// Active edges and placed rooms. Every change keeps the counters right and is
/// logged, so that it can be taken back.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) active: Vec<bool>,
    pub(super) degree: Vec<usize>,
    /// Active edges that may be removed.
    pub(super) removable: Subset,
    /// Active edges that were not given.
    pub(super) charged: Subset,
    /// Whether each edge whose direction is open runs from its second end to its
    /// first, and which of these are active.
    pub(super) backward: Vec<bool>,
    pub(super) turnable: Subset,
    /// Active vertices of each row, and rows with none.
    covers: Vec<usize>,
    pub(super) missing: Subset,
    /// Of those, how many each vertex would cover.
    gains: Vec<usize>,
    /// Dead ends where they are forbidden.
    pub(super) dead_ends: Subset,
    /// Literals of each pattern that do not hold.
    pub(super) unmet: Vec<usize>,
    /// Forbidden patterns that occur.
    pub(super) broken: Subset,
    pub(super) pattern_cost: f64,
    pub(super) length: f64,
    /// Edges of each path that are not active, whole paths of each route, and
    /// routes without.
    pub(super) lacking: Vec<usize>,
    whole: Vec<usize>,
    /// Those that have to be there, and what the others cost.
    pub(super) cut: Subset,
    pub(super) lapsed: Subset,
    pub(super) route_cost: f64,
    /// Whether each vertex is a sink, those that were placed, and of those the
    /// ones without an active edge.
    pub(super) sinks: Vec<bool>,
    pub(super) placed: Subset,
    pub(super) idle: Subset,
    pub(super) rooms: Rooms,
    log: Vec<Deed>,
}

/// Placed rooms; empty for streets.
#[derive(Clone, Debug)]
pub(super) struct Rooms {
    pub(super) placed: Subset,
    /// The room on each face.
    pub(super) owner: Vec<Option<usize>>,
    /// Active edges on the border of each placement, and inside.
    doors: Vec<usize>,
    crossings: Vec<usize>,
    /// Placed rooms without a door, and with a corridor inside.
    pub(super) shut: Subset,
    pub(super) crossed: Subset,
    /// Placed rooms that have each edge inside.
    pub(super) inside: Vec<usize>,
    /// Faces to be covered without a room.
    pub(super) bare: Subset,
    /// Placed rooms of each count, counts that are off, and by how much in all.
    pub(super) tallies: Vec<usize>,
    pub(super) wrong: Subset,
    pub(super) off: usize,
    /// Literals of each wish that do not hold, wishes that are denied, and
    /// demands that are not met.
    lacking: Vec<usize>,
    pub(super) denied: Subset,
    pub(super) unmet: Subset,
    pub(super) wish_cost: f64,
}

impl State {
    /// The edges that are active in any case, and no rooms.
    pub(super) fn new(model: &Model<'_>) -> Self {
        let (vertices, edges) = (model.problem.vertices, model.problem.edges());
        let placements = model.rooms.as_ref().map_or(0, |r| r.faces.len());
        let covered = model.problem.rooms.as_ref().map_or(&[][..], |r| &r.covered);
        let mut bare = Subset::new(covered.len());
        (0..covered.len())
            .filter(|&f| covered[f])
            .for_each(|f| bare.insert(f));
        let mut state = Self {
            active: vec![false; edges],
            degree: vec![0; vertices],
            removable: Subset::new(edges),
            charged: Subset::new(edges),
            backward: vec![false; edges],
            turnable: Subset::new(edges),
            covers: vec![0; model.rows.len()],
            missing: all(model.rows.len()),
            gains: (0..vertices).map(|v| model.rows_at.of(v).len()).collect(),
            dead_ends: Subset::new(vertices),
            unmet: (0..model.patterns.len())
                .map(|p| model.patterns.of(p).iter().filter(|l| l.1).count())
                .collect(),
            broken: Subset::new(model.patterns.len()),
            pattern_cost: 0.0,
            length: 0.0,
            lacking: (0..model.paths.len())
                .map(|k| model.paths.of(k).len())
                .collect(),
            whole: vec![0; model.routes.len()],
            cut: Subset::new(model.routes.len()),
            lapsed: Subset::new(model.routes.len()),
            route_cost: 0.0,
            sinks: model.problem.sinks.clone(),
            placed: Subset::new(vertices),
            idle: Subset::new(vertices),
            rooms: Rooms {
                placed: Subset::new(placements),
                owner: vec![None; covered.len()],
                doors: vec![0; placements],
                crossings: vec![0; placements],
                shut: Subset::new(placements),
                crossed: Subset::new(placements),
                inside: vec![0; edges],
                bare,
                ..Rooms::counters(model.rooms.as_ref())
            },
            log: Vec::new(),
        };
        for k in 0..model.paths.len() {
            if state.lacking[k] == 0 {
                state.whole[model.route_of[k]] += 1;
            }
        }
        for route in 0..model.routes.len() {
            if state.whole[route] == 0 {
                state.lapse(model, route, true);
            }
        }
        for &v in model.placing.iter().flat_map(|placing| &placing.first) {
            state.sinks[v] = true;
            state.placed.insert(v);
            state.idle.insert(v);
        }
        for p in (0..model.patterns.len()).filter(|&p| state.unmet[p] == 0) {
            match model.pattern_costs[p] {
                Some(cost) => state.pattern_cost += cost,
                None => state.broken.insert(p),
            }
        }
        for e in (0..edges).filter(|&e| model.fates[e] == Fate::On) {
            state.flip(model, e);
        }
        state.log.clear();
        state
    }

    /// Makes an edge active, or inactive if it was.
    pub(super) fn flip(&mut self, model: &Model<'_>, e: usize) {
        self.log.push(Deed::Flip(e));
        self.apply(model, e);
    }

    fn apply(&mut self, model: &Model<'_>, e: usize) {
        let on = !self.active[e];
        self.active[e] = on;
        if model.fates[e] == Fate::Open {
            self.removable.set(e, on);
        }
        if model.problem.way(e) == Way::Either {
            self.turnable.set(e, on);
        }
        if !model.given[e] {
            self.charged.set(e, on);
            let length = model.problem.lengths[e];
            self.length += if on { length } else { -length };
        }
        for v in model.problem.ends[e] {
            let before = self.degree[v];
            self.degree[v] = if on { before + 1 } else { before - 1 };
            if before.min(self.degree[v]) == 0 {
                self.touch(model, v, on);
            }
            if !model.problem.dead_ends && !self.sinks[v] {
                self.dead_ends.set(v, self.degree[v] == 1);
            }
        }
        for &(p, wanted) in model.patterns_at.of(e) {
            let before = self.unmet[p];
            self.unmet[p] = if on == wanted { before - 1 } else { before + 1 };
            if before.min(self.unmet[p]) == 0 {
                let occurs = self.unmet[p] == 0;
                match model.pattern_costs[p] {
                    None => self.broken.set(p, occurs),
                    Some(cost) => self.pattern_cost += if occurs { cost } else { -cost },
                }
            }
        }
        for &k in model.paths_at.of(e) {
            let before = self.lacking[k];
            self.lacking[k] = if on { before - 1 } else { before + 1 };
            if before.min(self.lacking[k]) == 0 {
                let route = model.route_of[k];
                self.whole[route] = if on {
                    self.whole[route] + 1
                } else {
                    self.whole[route] - 1
                };
                if self.whole[route] == usize::from(on) {
                    self.lapse(model, route, !on);
                }
            }
        }
        if let Some(rooms) = &model.rooms {
            self.rooms.corridor(rooms, e, on);
        }
    }

    /// A route is no longer there, or is there again.
    fn lapse(&mut self, model: &Model<'_>, route: usize, lapsed: bool) {
        match model.route_costs[route] {
            None => self.cut.set(route, lapsed),
            Some(cost) => {
                self.lapsed.set(route, lapsed);
                self.route_cost += if lapsed { cost } else { -cost };
            }
        }
    }

    /// Turns a one-way edge whose direction is open, active or not.
    pub(super) fn turn(&mut self, e: usize) {
        self.log.push(Deed::Turn(e));
        self.backward[e] = !self.backward[e];
    }

    /// A vertex has become active, or inactive.
    fn touch(&mut self, model: &Model<'_>, v: usize, on: bool) {
        if self.placed.contains(v) {
            self.idle.set(v, !on);
        }
        for &row in model.rows_at.of(v) {
            if on {
                self.covers[row] += 1;
                if self.covers[row] == 1 {
                    self.missing.remove(row);
                    model.rows.of(row).iter().for_each(|&v| self.gains[v] -= 1);
                }
            } else {
                self.covers[row] -= 1;
                if self.covers[row] == 0 {
                    self.missing.insert(row);
                    model.rows.of(row).iter().for_each(|&v| self.gains[v] += 1);
                }
            }
        }
    }

    /// Places a room on bare faces.
    pub(super) fn place(&mut self, model: &Model<'_>, room: usize) {
        self.log.push(Deed::Place(room));
        self.set_room(model, room, true);
    }

    /// Takes a room away.
    pub(super) fn clear(&mut self, model: &Model<'_>, room: usize) {
        self.log.push(Deed::Clear(room));
        self.set_room(model, room, false);
    }

    fn set_room(&mut self, model: &Model<'_>, room: usize, on: bool) {
        let rooms = model.rooms.as_ref().expect("only floorplans have rooms");
        self.rooms.set(rooms, room, on);
    }

    /// Rows that a vertex would cover and that nothing covers.
    pub(super) fn gain(&self, v: usize) -> usize {
        self.gains[v]
    }

    /// Whether the edges that have to be inactive in a pattern are.
    pub(super) fn allows(&self, model: &Model<'_>, pattern: usize) -> bool {
        (model.patterns.of(pattern).iter()).all(|&(e, on)| on || !self.active[e])
    }

    /// Whether a path may end here: at a sink or an active vertex.
    pub(super) fn is_stop(&self, v: usize) -> bool {
        self.degree[v] > 0 || self.sinks[v]
    }

    /// What was done so far, to come back to.
    pub(super) fn mark(&self) -> usize {
        self.log.len()
    }

    /// Takes back all that was done since.
    pub(super) fn undo(&mut self, model: &Model<'_>, mark: usize) {
        while self.log.len() > mark {
            match self.log.pop() {
                Some(Deed::Flip(e)) => self.apply(model, e),
                Some(Deed::Turn(e)) => self.backward[e] = !self.backward[e],
                Some(Deed::Place(room)) => self.set_room(model, room, false),
                Some(Deed::Clear(room)) => self.set_room(model, room, true),
                Some(Deed::Move(from, to)) => self.shift(model, to, from),
                None => break,
            }
        }
    }

    /// Forgets what was done: it stays.
    pub(super) fn settle(&mut self) {
        self.log.clear();
    }

    /// Moves a sink that was placed to a vertex that is none.
    pub(super) fn move_sink(&mut self, model: &Model<'_>, from: usize, to: usize) {
        self.log.push(Deed::Move(from, to));
        self.shift(model, from, to);
    }

    fn shift(&mut self, model: &Model<'_>, from: usize, to: usize) {
        self.sinks[from] = false;
        self.sinks[to] = true;
        self.placed.remove(from);
        self.placed.insert(to);
        self.idle.remove(from);
        self.idle.set(to, self.degree[to] == 0);
        if !model.problem.dead_ends {
            self.dead_ends.set(from, self.degree[from] == 1);
            self.dead_ends.remove(to);
        }
    }

    /// As an answer.
    pub(super) fn network(&self, model: &Model<'_>) -> Network {
        let sorted = |subset: &Subset| {
            let mut items = subset.items().to_vec();
            items.sort_unstable();
            items
        };
        Network {
            active: self.active.clone(),
            rooms: sorted(&self.rooms.placed),
            sinks: sorted(&self.placed),
            ways: self.decided_ways(model),
        }
    }

    /// Becomes a network.
    pub(super) fn become_network(&mut self, model: &Model<'_>, network: &Network) {
        let Network {
            active,
            rooms,
            sinks,
            ways,
        } = network;
        for (e, &way) in ways.iter().enumerate() {
            if way == Way::Forward || way == Way::Backward {
                self.backward[e] = way == Way::Backward;
            }
        }
        // As many sinks are placed as the network has, or it were not valid.
        let left = self.placed.items().iter().filter(|v| !sinks.contains(v));
        let new = sinks.iter().filter(|&&v| !self.placed.contains(v));
        let moves: Vec<(usize, usize)> = left.copied().zip(new.copied()).collect();
        for (from, to) in moves {
            self.move_sink(model, from, to);
        }
        for (e, &on) in active.iter().enumerate() {
            if self.active[e] != on {
                self.flip(model, e);
            }
        }
        for room in self.rooms.placed.items().to_vec() {
            if !rooms.contains(&room) {
                self.clear(model, room);
            }
        }
        for &room in rooms {
            if !self.rooms.placed.contains(room) {
                self.place(model, room);
            }
        }
        self.settle();
        // Sums of many differences drift; here they are set right.
        self.length = (0..active.len())
            .filter(|&e| active[e] && !model.given[e])
            .map(|e| model.problem.lengths[e])
            .sum();
        self.pattern_cost = (0..self.unmet.len())
            .filter(|&p| self.unmet[p] == 0)
            .filter_map(|p| model.pattern_costs[p])
            .sum();
        self.route_cost = (self.lapsed.items().iter())
            .filter_map(|&r| model.route_costs[r])
            .sum();
        if let Some(rooms) = &model.rooms {
            let denied = self.rooms.denied.items().iter();
            self.rooms.wish_cost = denied.filter_map(|&w| rooms.wish_costs[w]).sum();
        }
    }
}

impl Rooms {
    fn corridor(&mut self, rooms: &super::rooms::RoomModel, e: usize, on: bool) {
        for &p in rooms.border_at.of(e) {
            self.doors[p] = if on {
                self.doors[p] + 1
            } else {
                self.doors[p] - 1
            };
            if self.placed.contains(p) {
                self.shut.set(p, self.doors[p] == 0);
            }
        }
        for &p in rooms.inner_at.of(e) {
            self.crossings[p] = if on {
                self.crossings[p] + 1
            } else {
                self.crossings[p] - 1
            };
            if self.placed.contains(p) {
                self.crossed.set(p, self.crossings[p] > 0);
            }
        }
    }

    fn set(&mut self, rooms: &super::rooms::RoomModel, room: usize, on: bool) {
        self.placed.set(room, on);
        self.shut.set(room, on && self.doors[room] == 0);
        self.crossed.set(room, on && self.crossings[room] > 0);
        for &f in rooms.faces.of(room) {
            self.owner[f] = on.then_some(room);
            self.bare.set(f, !on);
        }
        for &e in rooms.inners.of(room) {
            self.inside[e] = if on {
                self.inside[e] + 1
            } else {
                self.inside[e] - 1
            };
        }
        for &c in rooms.counts_at.of(room) {
            self.off -= rooms.off(c, self.tallies[c]);
            self.tallies[c] = if on {
                self.tallies[c] + 1
            } else {
                self.tallies[c] - 1
            };
            let off = rooms.off(c, self.tallies[c]);
            self.off += off;
            self.wrong.set(c, off > 0);
        }
        for &(w, wanted) in rooms.wishes_at.of(room) {
            let before = self.lacking[w];
            self.lacking[w] = if on == wanted { before - 1 } else { before + 1 };
            if before.min(self.lacking[w]) == 0 {
                self.deny(rooms, w, self.lacking[w] == 0);
            }
        }
    }

    /// A wish is denied now, or no longer.
    fn deny(&mut self, rooms: &super::rooms::RoomModel, w: usize, denied: bool) {
        self.denied.set(w, denied);
        match rooms.wish_costs[w] {
            None => self.unmet.set(w, denied),
            Some(cost) => self.wish_cost += if denied { cost } else { -cost },
        }
    }

    /// The counters of counts and wishes without any room; all others empty.
    fn counters(rooms: Option<&super::rooms::RoomModel>) -> Self {
        let counts = rooms.map_or(0, |r| r.limits.len());
        let wishes = rooms.map_or(0, |r| r.wishes.len());
        let mut counters = Self {
            placed: Subset::new(0),
            owner: Vec::new(),
            doors: Vec::new(),
            crossings: Vec::new(),
            shut: Subset::new(0),
            crossed: Subset::new(0),
            inside: Vec::new(),
            bare: Subset::new(0),
            tallies: vec![0; counts],
            wrong: Subset::new(counts),
            off: 0,
            lacking: vec![0; wishes],
            denied: Subset::new(wishes),
            unmet: Subset::new(wishes),
            wish_cost: 0.0,
        };
        if let Some(rooms) = rooms {
            for c in 0..counts {
                counters.off += rooms.off(c, 0);
                counters.wrong.set(c, rooms.off(c, 0) > 0);
            }
            for w in 0..wishes {
                counters.lacking[w] = rooms.wishes.of(w).iter().filter(|l| l.1).count();
                if counters.lacking[w] == 0 {
                    counters.deny(rooms, w, true);
                }
            }
        }
        counters
    }

    /// Whether a placement would have a door, and no corridor inside.
    pub(super) fn would_do(&self, room: usize) -> (bool, bool) {
        (self.doors[room] > 0, self.crossings[room] == 0)
    }
}

fn all(count: usize) -> Subset {
    let mut subset = Subset::new(count);
    (0..count).for_each(|k| subset.insert(k));
    subset
}
