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

use super::draft::{Draft, Fill, Known, Term};

/// The columns of rooms.
#[derive(Debug)]
pub(super) struct Rooms {
    /// Each placement; off if it holds an obstacle or has an active edge inside.
    pub(super) r: Vec<Term>,
    /// The placements of each face that may be placed.
    pub(super) holding: Vec<Vec<usize>>,
}

/// Adds rows (15) to (17), if the problem has rooms; (16) as the paper has it
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
    Some(Rooms { r, holding })
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
    }
}
