//! Sinks that are to be placed: where they may be, and where they begin.

use std::collections::VecDeque;

use super::lists::Lists;
use super::model::{Fate, Hopeless};
use crate::design::PlacedSinks;

/// The candidates of a problem whose sinks are to be placed.
#[derive(Debug)]
pub(super) struct Placing {
    /// Vertices that may become sinks and can be active.
    pub(super) candidates: Vec<usize>,
    /// Those near each candidate, the nearest first; by vertex.
    pub(super) near: Lists<usize>,
    /// Where the search begins: near the middles of as many parts.
    pub(super) first: Vec<usize>,
}

/// How many candidates count as near.
const NEAR: usize = 12;
/// Candidates that are tried for the first places, and places that are chosen
/// with care.
const TRIED: usize = 128;
const CHOSEN: usize = 16;

impl Placing {
    /// # Errors
    ///
    /// [`Hopeless`] if there are fewer candidates that can be active than sinks.
    pub(super) fn new(
        placed: &PlacedSinks,
        around: &Lists<(usize, usize)>,
        fates: &[Fate],
    ) -> Result<Self, Hopeless> {
        let walks = Walks { around, fates };
        let mut candidates = placed.candidates.clone();
        candidates.retain(|&v| walks.beside(v).next().is_some());
        candidates.sort_unstable();
        if candidates.len() < placed.count {
            return Err(Hopeless);
        }
        let mut may = vec![false; around.len()];
        candidates.iter().for_each(|&v| may[v] = true);
        let mut near = vec![Vec::new(); around.len()];
        for &v in &candidates {
            near[v] = walks.nearest(v, &may);
        }
        Ok(Self {
            first: walks.middles(&candidates, placed.count),
            near: Lists::new(near),
            candidates,
        })
    }
}

/// Steps over edges that may be active.
struct Walks<'a> {
    around: &'a Lists<(usize, usize)>,
    fates: &'a [Fate],
}

impl Walks<'_> {
    fn beside(&self, v: usize) -> impl Iterator<Item = usize> + '_ {
        let may = |&&(e, _): &&(usize, usize)| self.fates[e] != Fate::Off;
        self.around.of(v).iter().filter(may).map(|&(_, w)| w)
    }

    /// The candidates nearest to one of them.
    fn nearest(&self, from: usize, may: &[bool]) -> Vec<usize> {
        let mut found = Vec::new();
        let mut seen = std::collections::BTreeSet::from([from]);
        let mut queue = VecDeque::from([from]);
        while let Some(v) = queue.pop_front() {
            for w in self.beside(v) {
                if seen.insert(w) {
                    queue.push_back(w);
                    if may[w] {
                        found.push(w);
                    }
                }
            }
            if found.len() >= NEAR {
                break;
            }
        }
        found.truncate(NEAR);
        found
    }

    /// Steps from a vertex to all others; as many as there are vertices where
    /// there is no way.
    fn steps(&self, from: usize) -> Vec<usize> {
        let far = self.around.len();
        let mut steps = vec![far; far];
        steps[from] = 0;
        let mut queue = VecDeque::from([from]);
        while let Some(v) = queue.pop_front() {
            for w in self.beside(v) {
                if steps[w] == far {
                    steps[w] = steps[v] + 1;
                    queue.push_back(w);
                }
            }
        }
        steps
    }

    /// Some of the candidates from which all vertices are near: one after the
    /// other where it saves the most steps (the greedy k-median); after the
    /// first few, the one farthest from the others.
    fn middles(&self, candidates: &[usize], count: usize) -> Vec<usize> {
        let tried = TRIED.max(count).min(candidates.len());
        let pool = (0..tried).map(|k| candidates[k * candidates.len() / tried]);
        let pool: Vec<(usize, Vec<usize>)> = pool.map(|v| (v, self.steps(v))).collect();
        let mut near = vec![usize::MAX; self.around.len()];
        let mut chosen: Vec<usize> = Vec::new();
        for k in 0..count {
            let free = pool.iter().filter(|(v, _)| !chosen.contains(v));
            let next = if k < CHOSEN {
                let all = |steps: &[usize]| -> usize {
                    steps.iter().zip(&near).map(|(&a, &b)| a.min(b)).sum()
                };
                free.min_by_key(|(v, steps)| (all(steps), *v))
            } else {
                free.min_by_key(|(v, _)| (usize::MAX - near[*v], *v))
            };
            // The pool is no smaller than the count.
            let Some((v, steps)) = next else { break };
            chosen.push(*v);
            near.iter_mut()
                .zip(steps)
                .for_each(|(near, &steps)| *near = steps.min(*near));
        }
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path of nine vertices.
    fn place(candidates: Vec<usize>, count: usize) -> Result<Placing, Hopeless> {
        let mut around = vec![Vec::new(); 9];
        for e in 0..8 {
            around[e].push((e, e + 1));
            around[e + 1].push((e, e));
        }
        let placed = PlacedSinks { candidates, count };
        Placing::new(&placed, &Lists::new(around), &[Fate::Open; 8])
    }

    #[test]
    fn first_places_are_in_the_middle_of_what_they_serve() {
        let placing = place((0..9).collect(), 1).expect("enough");
        assert_eq!(placing.first, [4]);
        assert_eq!(&placing.near.of(4)[..4], [3, 5, 2, 6]);
        let two = place(vec![0, 4, 8], 2).expect("enough");
        assert_eq!(two.first, [4, 0]);
        assert!(two.near.of(1).is_empty());
        assert_eq!(place((0..9).collect(), 9).expect("all").first.len(), 9);
        assert!(place(vec![1], 2).is_err());
    }
}
