//! Selections: parts of a region's boundary.
//!
//! A selector goes by what edges are and where they came from, never by their
//! numbers in a ring, so that it means the same after every rule: it is
//! evaluated for the region at hand. Directions and parameters are those of the
//! region's own axes, mirrored where the region is.

mod angle;
mod call;
mod cardinal;
mod continuous;
mod frame;
mod grow;
mod history;
pub(crate) mod named;
mod near;
mod part;
mod sector;
mod steps;
mod walk;

use geo_types::Coord;

use crate::plane::{dist, lerp};
use crate::shape::{Edge, Region};

pub(crate) use call::{call, index, range, CALLS};
pub(crate) use frame::Frame;
pub(crate) use named::NAMES;
pub(crate) use part::parametrise;
pub(crate) use steps::Step;
pub(crate) use walk::Lines;

/// Shorter spans are rounding, as a share of the ring.
const LEAST: f64 = 1e-9;

/// A stretch of a ring, by arc length from its first vertex, clockwise on the
/// outer one; `from < to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stretch {
    pub(crate) ring: usize,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// A set of points of a region's boundary, as stretches that are sorted and
/// disjoint.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Selection {
    stretches: Vec<Stretch>,
}

impl Selection {
    /// All stretches, joined where they overlap or touch.
    pub(crate) fn new(mut stretches: Vec<Stretch>) -> Self {
        stretches.retain(|s| s.to > s.from);
        stretches.sort_by(|a, b| a.ring.cmp(&b.ring).then(a.from.total_cmp(&b.from)));
        let mut joined: Vec<Stretch> = Vec::with_capacity(stretches.len());
        for s in stretches {
            match joined.last_mut() {
                Some(last) if last.ring == s.ring && s.from <= last.to => {
                    last.to = last.to.max(s.to);
                }
                _ => joined.push(s),
            }
        }
        Self { stretches: joined }
    }

    /// The whole boundary.
    pub(crate) fn all(region: &Region) -> Self {
        Self::edges(region, |_, _, _| true)
    }

    /// The physical edges for which `wanted` holds.
    pub(crate) fn edges(
        region: &Region,
        wanted: impl Fn(Coord<f64>, Coord<f64>, &Edge) -> bool,
    ) -> Self {
        Self::those(region, |_, _, (a, b, edge)| wanted(a, b, edge))
    }

    /// The physical edges, by ring and place in it, for which `wanted` holds.
    pub(crate) fn numbered(region: &Region, wanted: impl Fn(usize, usize) -> bool) -> Self {
        Self::those(region, |ring, k, _| wanted(ring, k))
    }

    fn those(
        region: &Region,
        wanted: impl Fn(usize, usize, (Coord<f64>, Coord<f64>, &Edge)) -> bool,
    ) -> Self {
        let mut stretches = Vec::new();
        for ring in 0..region.rings() {
            let mut from = 0.0;
            for (k, (a, b, edge)) in region.edges(ring).enumerate() {
                let to = from + dist(a, b);
                if wanted(ring, k, (a, b, edge)) {
                    stretches.push(Stretch { ring, from, to });
                }
                from = to;
            }
        }
        Self::new(stretches)
    }

    pub(crate) fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// Metres.
    pub(crate) fn length(&self) -> f64 {
        self.stretches.iter().map(|s| s.to - s.from).sum()
    }

    pub(crate) fn or(&self, other: &Self) -> Self {
        Self::new([self.stretches.as_slice(), &other.stretches].concat())
    }

    pub(crate) fn and(&self, other: &Self) -> Self {
        let mut common = Vec::new();
        for a in &self.stretches {
            let same = other.stretches.iter().filter(|b| b.ring == a.ring);
            common.extend(same.map(|b| Stretch {
                ring: a.ring,
                from: a.from.max(b.from),
                to: a.to.min(b.to),
            }));
        }
        Self::new(common)
    }

    /// What this selects and the other does not.
    pub(crate) fn minus(&self, other: &Self) -> Self {
        let mut rest = self.stretches.clone();
        for b in &other.stretches {
            rest = rest
                .into_iter()
                .flat_map(|a| {
                    if a.ring != b.ring || b.to <= a.from || b.from >= a.to {
                        return vec![a];
                    }
                    vec![Stretch { to: b.from, ..a }, Stretch { from: b.to, ..a }]
                })
                .collect();
        }
        let lengths: f64 = self.length();
        rest.retain(|s| s.to - s.from > LEAST * lengths);
        Self::new(rest)
    }

    pub(crate) fn not(&self, region: &Region) -> Self {
        Self::all(region).minus(self)
    }

    /// The selected lines, each as far as it goes on, walked clockwise on the
    /// outer ring (the land on the right); a whole ring ends where it began.
    pub(crate) fn lines(&self, region: &Region) -> Vec<Vec<Coord<f64>>> {
        let mut lines = Vec::new();
        for ring in 0..region.rings() {
            let whole = perimeter(region, ring);
            let here = self.runs(ring, whole);
            lines.extend(here.into_iter().map(|s| part(region, s, whole)));
        }
        lines
    }
}

/// Length of a ring, metres.
pub(crate) fn perimeter(region: &Region, ring: usize) -> f64 {
    region.edges(ring).map(|(a, b, _)| dist(a, b)).sum()
}

/// The points of a stretch, which may run over the ring's first vertex.
fn part(region: &Region, s: Stretch, whole: f64) -> Vec<Coord<f64>> {
    let mut line = Vec::new();
    let tiny = LEAST * whole;
    // A stretch that reaches over a vertex by rounding has no edge there.
    let least = tiny.min(0.25 * (s.to - s.from));
    let mut from = 0.0;
    for _ in 0..2 {
        for (a, b, _) in region.edges(s.ring) {
            let to = from + dist(a, b);
            let (low, high) = (s.from.max(from), s.to.min(to));
            if high > low + least {
                let at = |x: f64| lerp(a, b, (x - from) / (to - from));
                if line.is_empty() {
                    line.push(if low <= from + tiny { a } else { at(low) });
                }
                line.push(if high >= to - tiny { b } else { at(high) });
            }
            from = to;
        }
    }
    line
}

#[cfg(test)]
mod tests;
