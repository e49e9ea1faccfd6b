//! Rooms made ready for the search.

use super::lists::{inverse, Lists};
use super::model::Fate;
use crate::design::Problem;

/// Rooms by edge and face.
#[derive(Debug)]
pub(super) struct RoomModel {
    pub(super) faces: Lists<usize>,
    pub(super) at_face: Lists<usize>,
    pub(super) borders: Lists<usize>,
    pub(super) border_at: Lists<usize>,
    pub(super) inners: Lists<usize>,
    pub(super) inner_at: Lists<usize>,
    /// Placements that can never be: over an obstacle or an active edge, or
    /// unwelcome in any case.
    pub(super) barred: Vec<bool>,
    /// The placements of each count, and the counts of each placement.
    pub(super) counted: Lists<usize>,
    pub(super) counts_at: Lists<usize>,
    /// The least and the most of each count.
    pub(super) limits: Vec<[usize; 2]>,
    /// Literals of each wish: a placement, and whether placing it denies it.
    pub(super) wishes: Lists<(usize, bool)>,
    pub(super) wish_costs: Vec<Option<f64>>,
    pub(super) wishes_at: Lists<(usize, bool)>,
}

impl RoomModel {
    /// By how much a count is off.
    pub(super) fn off(&self, count: usize, rooms: usize) -> usize {
        let [least, most] = self.limits[count];
        least.saturating_sub(rooms) + rooms.saturating_sub(most)
    }

    pub(super) fn new(problem: &Problem, fates: &[Fate]) -> Self {
        let rooms = problem.rooms.as_ref().expect("a floorplan");
        let list = |of: fn(&crate::design::Placement) -> &Vec<usize>| {
            Lists::new(
                (rooms.placements.iter())
                    .map(|p| {
                        let mut list = of(p).clone();
                        list.sort_unstable();
                        list.dedup();
                        list
                    })
                    .collect(),
            )
        };
        let (faces, borders, inners) =
            (list(|p| &p.faces), list(|p| &p.border), list(|p| &p.inner));
        let unwelcome: std::collections::BTreeSet<usize> = (rooms.wishes.iter())
            .filter(|w| w.cost.is_none() && w.when.len() == 1 && w.then.is_empty())
            .map(|w| w.when[0])
            .collect();
        let (wishes, wish_costs) = wish_literals(&rooms.wishes);
        let mut wishes_at = vec![Vec::new(); rooms.placements.len()];
        for w in 0..wishes.len() {
            for &(r, wanted) in wishes.of(w) {
                wishes_at[r].push((w, wanted));
            }
        }
        let counted = Lists::new(rooms.counts.iter().map(|c| c.rooms.clone()).collect());
        let barred = (rooms.placements.iter().enumerate())
            .map(|(k, placement)| {
                // A face named twice would be covered twice.
                faces.of(k).len() != placement.faces.len()
                    || faces.of(k).iter().any(|&f| !rooms.covered[f])
                    || inners.of(k).iter().any(|&e| fates[e] == Fate::On)
                    || borders.of(k).iter().all(|&e| fates[e] == Fate::Off)
                    || unwelcome.contains(&k)
            })
            .collect();
        Self {
            at_face: inverse(&faces, rooms.covered.len()),
            border_at: inverse(&borders, problem.edges()),
            inner_at: inverse(&inners, problem.edges()),
            faces,
            borders,
            inners,
            barred,
            counts_at: inverse(&counted, rooms.placements.len()),
            counted,
            limits: (rooms.counts.iter())
                .map(|c| [c.least, c.most.unwrap_or(usize::MAX)])
                .collect(),
            wishes,
            wish_costs,
            wishes_at: Lists::new(wishes_at),
        }
    }
}

/// The literals of each wish that can be denied.
fn wish_literals(wishes: &[crate::design::RoomWish]) -> (Lists<(usize, bool)>, Vec<Option<f64>>) {
    let (mut lists, mut costs) = (Vec::new(), Vec::new());
    for wish in wishes {
        if wish.cost == Some(0.0) || wish.when.iter().any(|r| wish.then.contains(r)) {
            continue;
        }
        let when = wish.when.iter().map(|&r| (r, true));
        let then = wish.then.iter().map(|&r| (r, false));
        let mut list: Vec<_> = when.chain(then).collect();
        list.sort_unstable();
        list.dedup();
        lists.push(list);
        costs.push(wish.cost);
    }
    (Lists::new(lists), costs)
}
