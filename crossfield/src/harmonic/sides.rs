//! Which sides of a boundary a gradient crosses and which it runs along.
//!
//! Sides lie between corners. At each corner a field that goes straight on
//! changes from one kind of side to the other if the corner turns by an odd
//! number of right angles, and stays with its kind if by an even one. Choices
//! against that are ranked by what they cost, so that the likeliest ways to
//! assign the kinds come first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::pieces::Pieces;
use crate::cross::QUARTER;
use crate::domain::Domain;
use crate::FieldError;

/// Subsets looked at before the search for assignments gives up.
const LOOKED_AT: usize = 20_000;

/// The sides of a domain and how they follow each other.
pub(crate) struct Sides {
    pub(crate) pieces: Pieces,
    /// For each ring its first side and how many there are.
    rings: Vec<(usize, usize)>,
    /// Turn at the start of each side; `None` where its ring has no corner.
    pub(crate) turns: Vec<Option<f64>>,
}

impl Sides {
    pub(crate) fn new(domain: &Domain, most: usize) -> Result<Self, FieldError> {
        let pieces = Pieces::cut(domain, f64::INFINITY, most)?;
        let mut rings = Vec::new();
        let mut turns = Vec::new();
        for ring in &domain.inner.rings {
            let first = turns.len();
            turns.extend(
                (0..ring.len())
                    .filter(|&k| ring.corner[k])
                    .map(|k| Some(ring.turn[k])),
            );
            if turns.len() == first {
                turns.push(None);
            }
            rings.push((first, turns.len() - first));
        }
        Ok(Self {
            pieces,
            rings,
            turns,
        })
    }

    /// For each crossed side the number of its run: crossed sides that meet at
    /// a corner share one value. With the number of runs.
    pub(crate) fn runs(&self, crossed: &[bool]) -> (Vec<Option<usize>>, usize) {
        let mut of = vec![None; crossed.len()];
        let mut runs = 0;
        for &(first, count) in &self.rings {
            let sides = first..first + count;
            // Start after a side that is not crossed, if there is one.
            let start = sides.clone().find(|&s| !crossed[s]).unwrap_or(first);
            let mut before = false;
            for s in (0..count).map(|k| first + (start - first + k) % count) {
                if crossed[s] {
                    runs += usize::from(!before);
                    of[s] = Some(runs - 1);
                }
                before = crossed[s];
            }
        }
        (of, runs)
    }

    /// Assignments with at least two runs of crossed sides, the likeliest
    /// first, at most `most`.
    pub(crate) fn assignments(&self, most: usize) -> Vec<Vec<bool>> {
        // What can be flipped: the choice at a corner, at its price, or all
        // sides of a ring, which costs nothing.
        let mut flips: Vec<(f64, Flip)> = Vec::new();
        for (ring, &(first, count)) in self.rings.iter().enumerate() {
            for side in first..first + count {
                if let Some(turn) = self.turns[side] {
                    let [stay, change] = prices(turn);
                    flips.push(((stay - change).abs(), Flip::Corner(side)));
                }
            }
            // Flipping all rings exchanges z for its conjugate, which has the
            // same crosses if there is no hole.
            if self.rings.len() > 1 {
                flips.push((0.0, Flip::Ring(ring)));
            }
        }
        flips.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut found = Vec::new();
        subsets(&flips, |chosen| {
            if let Some(crossed) = self.assign(chosen) {
                if self.runs(&crossed).1 >= 2 {
                    found.push(crossed);
                }
            }
            found.len() < most
        });
        found
    }

    /// The kinds of all sides after some flips; `None` if a ring does not
    /// close.
    fn assign(&self, flipped: &[&Flip]) -> Option<Vec<bool>> {
        let mut crossed = vec![false; self.turns.len()];
        for (ring, &(first, count)) in self.rings.iter().enumerate() {
            let begin = flipped
                .iter()
                .any(|f| matches!(f, Flip::Ring(r) if *r == ring));
            let mut kind = begin;
            // Side `first` keeps the ring's own kind; the turn at its start
            // closes the ring.
            for k in 0..count {
                crossed[first + k] = kind;
                let next = first + (k + 1) % count;
                if let Some(turn) = self.turns[next] {
                    let [stay, change] = prices(turn);
                    let flip = flipped
                        .iter()
                        .any(|f| matches!(f, Flip::Corner(s) if *s == next));
                    kind ^= (change < stay) != flip;
                }
            }
            if kind != begin {
                return None;
            }
        }
        Some(crossed)
    }
}

/// A departure from what each corner would choose.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Flip {
    Corner(usize),
    Ring(usize),
}

/// By how many right angles a corner misses an even number of them (sides of
/// one kind meet) and an odd one (they differ): numbers that add up to 1.
fn prices(turn: f64) -> [f64; 2] {
    let quarters = turn / QUARTER;
    let stay = 2.0 * (quarters / 2.0 - (quarters / 2.0).round()).abs();
    [stay, 1.0 - stay]
}

/// Calls `visit` with subsets of the (sorted) flips in the order of their
/// sums, the empty one first, until it returns false.
fn subsets(flips: &[(f64, Flip)], mut visit: impl FnMut(&[&Flip]) -> bool) {
    if !visit(&[]) {
        return;
    }
    // Each subset comes from exactly one other one: by adding the flip after
    // its last, or by exchanging its last for that.
    let mut heap = BinaryHeap::new();
    let key = |chosen: &[usize]| {
        let sum: f64 = chosen.iter().map(|&k| flips[k].0).sum();
        // Sums are compared as whole numbers, so that the order is total and
        // equal prices tie.
        (sum * 1e9).round() as u64
    };
    if !flips.is_empty() {
        heap.push(Reverse((key(&[0]), vec![0])));
    }
    for _ in 0..LOOKED_AT {
        let Some(Reverse((_, chosen))) = heap.pop() else {
            return;
        };
        let picked: Vec<&Flip> = chosen.iter().map(|&k| &flips[k].1).collect();
        if !visit(&picked) {
            return;
        }
        let last = chosen[chosen.len() - 1];
        if last + 1 < flips.len() {
            let mut longer = chosen.clone();
            longer.push(last + 1);
            heap.push(Reverse((key(&longer), longer)));
            let mut other = chosen;
            other.pop();
            other.push(last + 1);
            heap.push(Reverse((key(&other), other)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DomainOptions;
    use geo_types::polygon;

    fn sides(shape: &geo_types::Polygon<f64>) -> Sides {
        let domain = Domain::new(shape, &DomainOptions::default()).expect("valid");
        Sides::new(&domain, 100).expect("few sides")
    }

    #[test]
    fn the_sides_of_a_rectangle_alternate() {
        let shape = polygon![(x: 0., y: 0.), (x: 8., y: 0.), (x: 8., y: 5.), (x: 0., y: 5.)];
        let sides = sides(&shape);
        // Any other choice has a single run.
        assert_eq!(sides.assignments(10), [[false, true, false, true]]);
        assert_eq!(sides.runs(&[true, true, false, true]).1, 1);
        assert_eq!(
            sides.runs(&[false, true, false, true]),
            (vec![None, Some(0), None, Some(1)], 2)
        );
    }

    #[test]
    fn triangles_have_no_assignment() {
        let shape = polygon![(x: 0., y: 0.), (x: 8., y: 0.), (x: 3., y: 5.)];
        assert!(sides(&shape).assignments(10).is_empty());
    }

    #[test]
    fn an_l_alternates_first() {
        let shape = polygon![(x: 0., y: 0.), (x: 6., y: 0.), (x: 6., y: 2.), (x: 3., y: 2.),
            (x: 3., y: 5.), (x: 0., y: 5.)];
        let all = sides(&shape).assignments(100);
        assert_eq!(all[0], [false, true, false, true, false, true]);
        let mut unique = all.clone();
        unique.sort();
        unique.dedup();
        assert_eq!(unique.len(), all.len());
    }

    #[test]
    fn subsets_come_by_their_sums() {
        let flips: Vec<(f64, Flip)> = [0.1, 0.2, 0.25, 0.7]
            .iter()
            .enumerate()
            .map(|(k, &price)| (price, Flip::Corner(k)))
            .collect();
        let mut sums = Vec::new();
        subsets(&flips, |chosen| {
            let price = |f: &&Flip| flips.iter().find(|x| x.1 == **f).map_or(0.0, |x| x.0);
            sums.push(chosen.iter().map(price).sum::<f64>());
            true
        });
        assert_eq!(sums.len(), 16);
        assert!(sums.windows(2).all(|pair| pair[0] <= pair[1] + 1e-9));
    }
}
