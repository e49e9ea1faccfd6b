//! Rooms in place of coverage (the paper's section 5.2).
//!
//! With a column R for each room that may be placed:
//!
//! sum of R over the rooms that hold a face = 1, or 0 at an obstacle,   (15)
//! x_e + sum of R over the rooms that have e inside <= 1 for each edge,   (16)
//! R <= sum of x_e around the room.   (17)
//!
//! (16) holds for the sum over rooms because two rooms that have an edge inside
//! share its two faces; the paper's one row a room, n R <= sum of (1 - x_e), is
//! weaker for fractions.
//!
//! **Room cuts.** The border of a room that is placed has an active edge, so one
//! of its vertices B is active; if none of them is a sink, the ball cuts of
//! [`balls`](super::balls) hold with R on the right hand side, and without the
//! edges inside the room, which are inactive then:
//!
//! x(delta(B)) + x(K) >= 2 R.   (18)
//!
//! Alone they say little of a fraction of a room. But exactly one of the rooms
//! that hold a face is placed, so for any of them, Q, with the union U of their
//! sets delta(B) and K,
//!
//! x(U) >= 2 sum of R over Q:   (19)
//!
//! if one of Q is placed, its own row (18) implies it; if none is, it says
//! nothing. Where fractions of all rooms that hold a face are in Q the right
//! hand side is 2. There are too many sets Q to write down; [`Rooms::separate`]
//! finds those that a fractional solution violates.
//!
//! **Counts and wishes** are linear in the rooms. For each count
//!
//! least <= sum of R over the rooms that count <= most,   (20)
//!
//! and for each wish, with a column z in [0, 1] that costs what it costs to deny
//! it, and none if it is demanded,
//!
//! sum of R over `when` - sum of R over `then` - z <= |when| - 1.   (21)
//!
//! z may be real, since the least that it can be is 0 or 1. A wish of one room,
//! R <= sum of R over `then` + z, is as tight as a row can be.

use std::collections::BTreeSet;

use super::balls::cuts;
use super::draft::{Draft, Fill, Known, Term};
use crate::design::RoomWish;
use crate::mip::Row;

/// The columns of rooms, and what cuts are made of.
#[derive(Debug)]
pub(super) struct Rooms {
    /// Each placement; off if it holds an obstacle or has an active edge inside.
    r: Vec<Term>,
    /// The placements of each face that may be placed.
    holding: Vec<Vec<usize>>,
    /// Sets of edges with the number that is active at least if the room is
    /// placed: (18). Empty where its border touches a sink.
    cuts: Vec<Vec<(Vec<usize>, f64)>>,
    /// Each edge.
    x: Vec<Term>,
    /// Wishes that cost something, and their columns.
    z: Vec<(usize, usize)>,
    wishes: Vec<RoomWish>,
}

/// Adds rows (15) to (17), (20) and (21), if the problem has rooms; (16) as the paper has it
/// unless `tight`.
pub(super) fn add(draft: &mut Draft<'_>, tight: bool) -> Option<Rooms> {
    let rooms = draft.problem.rooms.as_ref()?;
    let mut holding = vec![Vec::new(); rooms.covered.len()];
    let mut inside: Vec<Vec<usize>> = vec![Vec::new(); draft.problem.edges()];
    let mut r = Vec::with_capacity(rooms.placements.len());
    for (k, placement) in rooms.placements.iter().enumerate() {
        let blocked = placement.faces.iter().any(|&f| !rooms.covered[f])
            || placement.inner.iter().any(|&e| draft.x[e] == Term::On);
        if blocked {
            r.push(Term::Off);
            continue;
        }
        placement.faces.iter().for_each(|&f| holding[f].push(k));
        placement.inner.iter().for_each(|&e| inside[e].push(k));
        r.push(Term::Column(draft.program.binary(0.0)));
    }
    for (f, placements) in holding.iter().enumerate() {
        let wanted = f64::from(u8::from(rooms.covered[f]));
        let terms: Vec<_> = placements.iter().map(|&k| (r[k], 1.0)).collect();
        draft.row(wanted, wanted, terms);
    }
    if tight {
        for (e, placements) in inside.iter().enumerate() {
            let mut terms: Vec<_> = placements.iter().map(|&k| (r[k], 1.0)).collect();
            terms.push((draft.x[e], 1.0));
            draft.row(f64::NEG_INFINITY, 1.0, terms);
        }
    }
    for (k, placement) in rooms.placements.iter().enumerate() {
        if r[k] == Term::Off {
            continue;
        }
        if !tight {
            let n = placement.inner.len() as f64;
            let mut terms: Vec<_> = placement.inner.iter().map(|&e| (draft.x[e], 1.0)).collect();
            terms.push((r[k], n));
            draft.row(f64::NEG_INFINITY, n, terms);
        }
        let mut terms: Vec<_> = placement
            .border
            .iter()
            .map(|&e| (draft.x[e], -1.0))
            .collect();
        terms.push((r[k], 1.0));
        draft.row(f64::NEG_INFINITY, 0.0, terms);
    }
    // Where a sink may be placed they would need its column; there are few such
    // borders.
    let sinks = draft.problem.possible_sinks();
    let z = wishes(draft, &r);
    let cuts = rooms.placements.iter().zip(&r).map(|(placement, &r)| {
        let ends = placement.border.iter().flat_map(|&e| draft.problem.ends[e]);
        let ball: BTreeSet<usize> = ends.collect();
        if r == Term::Off || ball.iter().any(|&v| sinks[v]) {
            return Vec::new();
        }
        let ball: Vec<usize> = ball.into_iter().collect();
        let without = placement.inner.iter().copied().collect();
        cuts(draft, &ball, &without)
    });
    Some(Rooms {
        cuts: cuts.collect(),
        r,
        holding,
        x: draft.x.clone(),
        z,
        wishes: rooms.wishes.clone(),
    })
}

/// Adds rows (20) and (21).
fn wishes(draft: &mut Draft<'_>, r: &[Term]) -> Vec<(usize, usize)> {
    let Some(rooms) = draft.problem.rooms.as_ref() else {
        return Vec::new();
    };
    for count in &rooms.counts {
        let most = count.most.map_or(f64::INFINITY, |most| most as f64);
        let terms = count.rooms.iter().map(|&k| (r[k], 1.0));
        draft.row(count.least as f64, most, terms.collect::<Vec<_>>());
    }
    let mut z = Vec::new();
    for (w, wish) in rooms.wishes.iter().enumerate() {
        // Each once: all of a room named twice is the room.
        let once = |list: &[usize]| list.iter().copied().collect::<BTreeSet<_>>();
        let (when, then) = (once(&wish.when), once(&wish.then));
        let granted = !when.is_disjoint(&then) || when.iter().any(|&k| r[k] == Term::Off);
        if granted || wish.cost == Some(0.0) {
            continue;
        }
        let most = when.len() as f64 - 1.0;
        let mut terms: Vec<_> = when.iter().map(|&k| (r[k], 1.0)).collect();
        terms.extend(then.iter().map(|&k| (r[k], -1.0)));
        if let Some(cost) = wish.cost {
            let column = draft.program.real(cost, 1.0);
            z.push((w, column));
            terms.push((Term::Column(column), -1.0));
        }
        draft.row(f64::NEG_INFINITY, most, terms);
    }
    z
}

impl Rooms {
    /// Rows (19) that a fractional solution violates by over `tolerance`, at
    /// most one for each face.
    pub(super) fn separate(&self, values: &[f64], tolerance: f64) -> Vec<Row> {
        let value = |term: Term| match term {
            Term::Off => 0.0,
            Term::On => 1.0,
            Term::Column(column) => values[column],
        };
        let mut rows: Vec<Row> = Vec::new();
        for placements in &self.holding {
            // The rooms by how much their own cuts lack, relative to their part.
            let mut used: Vec<usize> = (placements.iter().copied())
                .filter(|&k| value(self.r[k]) > 1e-6 && !self.cuts[k].is_empty())
                .collect();
            used.sort_by(|&a, &b| {
                value(self.r[b])
                    .total_cmp(&value(self.r[a]))
                    .then(a.cmp(&b))
            });
            let mut union: BTreeSet<usize> = BTreeSet::new();
            let (mut part, mut best) = (0.0, (tolerance, 0));
            let mut unions = Vec::new();
            for (n, &k) in used.iter().enumerate() {
                let added = |edges: &[usize]| -> f64 {
                    let new = edges.iter().filter(|e| !union.contains(e));
                    new.map(|&e| value(self.x[e])).sum()
                };
                let least = self.cuts[k]
                    .iter()
                    .min_by(|a, b| added(&a.0).total_cmp(&added(&b.0)));
                let (edges, wanted) = least.expect("cuts are not empty");
                union.extend(edges);
                part += wanted * value(self.r[k]);
                let sum: f64 = union.iter().map(|&e| value(self.x[e])).sum();
                if part - sum > best.0 {
                    best = (part - sum, n + 1);
                }
                unions.push((union.clone(), *wanted));
            }
            if best.1 == 0 {
                continue;
            }
            let (edges, wanted) = &unions[best.1 - 1];
            let mut low = 0.0;
            let mut terms = Vec::new();
            for &e in edges {
                match self.x[e] {
                    Term::Column(column) => terms.push((column, 1.0)),
                    Term::On => low -= 1.0,
                    Term::Off => {}
                }
            }
            for &k in &used[..best.1] {
                if let Term::Column(column) = self.r[k] {
                    terms.push((column, -wanted));
                }
            }
            terms.sort_unstable_by_key(|&(column, _)| column);
            let row = Row {
                terms,
                low,
                high: f64::INFINITY,
            };
            if !rows.contains(&row) {
                rows.push(row);
            }
        }
        rows
    }

    /// The column of a placement, if it may be placed.
    pub(super) fn column(&self, placement: usize) -> Option<usize> {
        match self.r[placement] {
            Term::Column(column) => Some(column),
            Term::Off | Term::On => None,
        }
    }

    /// The rooms of a solution.
    pub(super) fn placed(&self, values: &[f64]) -> Vec<usize> {
        let placed = self.r.iter().enumerate().filter(|(_, r)| match r {
            Term::Column(column) => values[*column] > 0.5,
            _ => false,
        });
        placed.map(|(k, _)| k).collect()
    }
}

impl Fill for Rooms {
    fn fill(&self, known: &Known<'_>, values: &mut [f64]) {
        for &k in known.rooms {
            if let Some(Term::Column(column)) = self.r.get(k) {
                values[*column] = 1.0;
            }
        }
        let mut placed = vec![false; self.r.len()];
        for &k in known.rooms {
            if let Some(placed) = placed.get_mut(k) {
                *placed = true;
            }
        }
        for &(w, column) in &self.z {
            let denied = self.wishes[w].is_denied(|k| placed[k]);
            values[column] = f64::from(u8::from(denied));
        }
    }
}
