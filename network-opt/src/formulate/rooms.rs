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
//! What rooms, connectivity and the ban of dead ends say together is cut off in
//! [`room_balls`](super::room_balls).
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

use super::draft::{Draft, Fill, Known, Term};
use crate::design::RoomWish;

/// The columns of rooms.
#[derive(Debug)]
pub(super) struct Rooms {
    /// Each placement; off if it holds an obstacle or has an active edge inside.
    pub(super) r: Vec<Term>,
    /// The placements of each face that may be placed.
    pub(super) holding: Vec<Vec<usize>>,
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
    let z = wishes(draft, &r);
    Some(Rooms {
        r,
        holding,
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
