//! How centres join: pairs of them to be connected.
//!
//! The notes list: leave them disconnected; a loop or closed path; "a loop without
//! a single edge, a tree, chosen at random"; pairs; opposites, with questions;
//! completely random; and, among the issues, the Delaunay triangulation, which
//! "connects into a graph" that "must be planar". Decided, in the order of their
//! questions:
//!
//! * A loop is a short tour, from which crossings and detours are taken until
//!   exchanging two of its edges makes it no shorter. Of two centres it is the
//!   path between them.
//! * Pairs are short in sum, so that they do not cross. Of an odd number the one
//!   that is left joins its nearest neighbour: no centre stays alone.
//! * Opposites lie across the middle of all centres in the order around it. Of an
//!   odd number each has two across, and takes the one that lies straighter; if
//!   both do equally ("how to select two equally weighted opposites?"), chance
//!   decides. Where their paths cross is a crossing.
//! * Completely random would cross: a tree of Delaunay edges, taken by chance.

use geo_types::Coord;

use crate::derive::Stream;
use crate::plane::{cross, dist, dot};

/// Lengths that differ by less, as a share, are equal.
const SAME: f64 = 1e-9;

/// Sweeps through all exchanges, should rounding make them go on.
const SWEEPS: usize = 1000;

/// How centres join.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Join {
    None,
    Loop,
    Open,
    Pairs,
    Opposites,
    Delaunay,
    Tree,
}

/// What the words of `join =` mean.
pub(super) const WORDS: [(&str, Join); 7] = [
    ("none", Join::None),
    ("loop", Join::Loop),
    ("open", Join::Open),
    ("pairs", Join::Pairs),
    ("opposites", Join::Opposites),
    ("delaunay", Join::Delaunay),
    ("tree", Join::Tree),
];

/// A connection of two centres, the lower number first.
pub(super) type Link = [usize; 2];

impl Join {
    /// The links of centres, sorted; `delaunay` gives those whose Voronoi cells
    /// meet.
    pub(super) fn links(
        self,
        at: &[Coord<f64>],
        delaunay: impl FnOnce() -> Vec<Link>,
        chance: &mut Stream,
    ) -> Vec<Link> {
        if at.len() < 2 {
            return Vec::new();
        }
        let mut links = match self {
            Self::None => Vec::new(),
            Self::Loop => around(&tour(at)),
            Self::Open => {
                let mut links = around(&tour(at));
                if links.len() > 2 {
                    links.remove(chance.below(links.len()));
                }
                links
            }
            Self::Pairs => pairs(at),
            Self::Opposites => opposites(at, chance),
            Self::Delaunay => delaunay(),
            Self::Tree => tree(at.len(), delaunay(), chance),
        };
        for link in &mut links {
            link.sort_unstable();
        }
        links.sort_unstable();
        links.dedup();
        links
    }
}

/// The links of a closed tour.
fn around(tour: &[usize]) -> Vec<Link> {
    let n = tour.len();
    let count = if n == 2 { 1 } else { n };
    let mut links: Vec<Link> = (0..count).map(|k| [tour[k], tour[(k + 1) % n]]).collect();
    // An order that does not depend on where the tour begins.
    links.iter_mut().for_each(|link| link.sort_unstable());
    links.sort_unstable();
    links
}

/// A short closed tour: each centre put where it makes the tour least longer,
/// then two edges exchanged as long as that helps (Croes 1958).
fn tour(at: &[Coord<f64>]) -> Vec<usize> {
    let away = |a: usize, b: usize| dist(at[a], at[b]);
    let mut tour: Vec<usize> = Vec::with_capacity(at.len());
    for k in 0..at.len() {
        let n = tour.len();
        let longer = |j: usize| {
            let (a, b) = (tour[j], tour[(j + 1) % n]);
            away(a, k) + away(k, b) - away(a, b)
        };
        let best = (0..n).min_by(|&a, &b| longer(a).total_cmp(&longer(b)));
        tour.insert(best.map_or(0, |j| j + 1), k);
    }
    let n = tour.len();
    let whole: f64 = (0..n).map(|k| away(tour[k], tour[(k + 1) % n])).sum();
    for _ in 0..SWEEPS {
        let mut better = false;
        for i in 0..n.saturating_sub(1) {
            for j in i + 2..n {
                let (a, b) = (tour[i], tour[i + 1]);
                let (c, d) = (tour[j], tour[(j + 1) % n]);
                if a == d {
                    continue;
                }
                let less = away(a, b) + away(c, d) - away(a, c) - away(b, d);
                if less > SAME * whole {
                    tour[i + 1..=j].reverse();
                    better = true;
                }
            }
        }
        if !better {
            break;
        }
    }
    tour
}

/// Pairs that are short in sum.
fn pairs(at: &[Coord<f64>]) -> Vec<Link> {
    let n = at.len();
    let away = |a: usize, b: usize| dist(at[a], at[b]);
    let mut all: Vec<Link> = (0..n)
        .flat_map(|a| (a + 1..n).map(move |b| [a, b]))
        .collect();
    all.sort_by(|a, b| away(a[0], a[1]).total_cmp(&away(b[0], b[1])).then(a.cmp(b)));
    let mut alone = vec![true; n];
    let mut links: Vec<Link> = Vec::new();
    for [a, b] in all {
        if alone[a] && alone[b] {
            (alone[a], alone[b]) = (false, false);
            links.push([a, b]);
        }
    }
    let whole: f64 = links.iter().map(|&[a, b]| away(a, b)).sum();
    for _ in 0..SWEEPS {
        let mut better = false;
        for i in 0..links.len() {
            for j in i + 1..links.len() {
                let ([a, b], [c, d]) = (links[i], links[j]);
                let now = away(a, b) + away(c, d);
                let ways = [[[a, c], [b, d]], [[a, d], [b, c]]];
                for [one, two] in ways {
                    if now - away(one[0], one[1]) - away(two[0], two[1]) > SAME * whole {
                        (links[i], links[j]) = (one, two);
                        better = true;
                        break;
                    }
                }
            }
        }
        if !better {
            break;
        }
    }
    // The one that is left joins its nearest, without crossing others if it can.
    if let Some(last) = alone.iter().position(|&is| is) {
        let crosses = |k: usize| {
            let others = links.iter().filter(|link| !link.contains(&k));
            others.into_iter().any(|&[a, b]| {
                let side = |p: usize, q: usize, r: usize| cross(at[q] - at[p], at[r] - at[p]) > 0.0;
                side(last, k, a) != side(last, k, b) && side(a, b, last) != side(a, b, k)
            })
        };
        let others = (0..n).filter(|&k| k != last);
        let nearest = others.min_by(|&a, &b| {
            let key = |k: usize| (crosses(k), away(last, k));
            let (x, y) = (key(a), key(b));
            x.0.cmp(&y.0).then(x.1.total_cmp(&y.1))
        });
        links.extend(nearest.map(|k| [last, k]));
    }
    links
}

/// Each centre with the one across the middle.
fn opposites(at: &[Coord<f64>], chance: &mut Stream) -> Vec<Link> {
    let n = at.len();
    let middle = at.iter().fold(Coord::default(), |sum, &p| sum + p) / n as f64;
    let angle = |k: usize| {
        let way = at[k] - middle;
        way.y.atan2(way.x)
    };
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)).then(a.cmp(&b)));
    let mut places = vec![0; n];
    for (place, &k) in order.iter().enumerate() {
        places[k] = place;
    }
    let mut links = Vec::new();
    for k in 0..n {
        let place = places[k];
        let across = |by: usize| order[(place + by) % n];
        if n.is_multiple_of(2) {
            links.push([k, across(n / 2)]);
            continue;
        }
        // How far from straight across, as the angle between.
        let off = |other: usize| {
            let (u, v) = (middle - at[k], at[other] - middle);
            cross(u, v).atan2(dot(u, v)).abs()
        };
        let (a, b) = (across(n / 2), across(n / 2 + 1));
        let straighter = off(a) - off(b);
        let first = if straighter.abs() <= SAME {
            // The same whichever way round the centres are counted.
            let (low, high) = (a.min(b), a.max(b));
            if chance.unit() < 0.5 {
                low
            } else {
                high
            }
        } else if straighter < 0.0 {
            a
        } else {
            b
        };
        links.push([k, first]);
    }
    links
}

/// A tree of links taken by chance (Kruskal 1956, in a random order).
fn tree(count: usize, mut links: Vec<Link>, chance: &mut Stream) -> Vec<Link> {
    for k in (1..links.len()).rev() {
        links.swap(k, chance.below(k + 1));
    }
    let mut groups = Groups::new(count);
    links.retain(|&[a, b]| groups.join(a, b));
    links
}

/// Which centres hang together.
#[derive(Clone, Debug)]
pub(super) struct Groups(Vec<usize>);

impl Groups {
    pub(super) fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    pub(super) fn of(&self, mut k: usize) -> usize {
        while self.0[k] != k {
            k = self.0[k];
        }
        k
    }

    /// Whether they were apart.
    pub(super) fn join(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.of(a), self.of(b));
        let (low, high) = (a.min(b), a.max(b));
        self.0[high] = low;
        a != b
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn random(count: usize, seed: u64) -> Vec<Coord<f64>> {
        let mut chance = Stream::new(seed);
        (0..count)
            .map(|_| coord! { x: 100.0 * chance.unit(), y: 100.0 * chance.unit() })
            .collect()
    }

    fn crossing(at: &[Coord<f64>], a: Link, b: Link) -> bool {
        if a.iter().any(|k| b.contains(k)) {
            return false;
        }
        let side = |l: Link, k: usize| cross(at[l[1]] - at[l[0]], at[k] - at[l[0]]) > 0.0;
        side(a, b[0]) != side(a, b[1]) && side(b, a[0]) != side(b, a[1])
    }

    fn degrees(count: usize, links: &[Link]) -> Vec<usize> {
        let mut degrees = vec![0; count];
        links.iter().flatten().for_each(|&k| degrees[k] += 1);
        degrees
    }

    fn links(join: Join, at: &[Coord<f64>]) -> Vec<Link> {
        join.links(at, Vec::new, &mut Stream::new(5))
    }

    /// A loop visits each once, and neither it nor pairs cross themselves.
    #[test]
    fn loops_and_pairs_do_not_cross() {
        for seed in 0..40 {
            let count = 2 + (seed as usize * 7) % 40;
            let at = random(count, seed);
            for join in [Join::Loop, Join::Open, Join::Pairs] {
                let links = links(join, &at);
                // An odd one may have to cross, if it is walled in by pairs.
                if join != Join::Pairs || count.is_multiple_of(2) {
                    let apart = |k: usize| links[..k].iter().all(|&l| !crossing(&at, l, links[k]));
                    assert!((0..links.len()).all(apart), "{join:?} {seed}");
                }
                let degrees = degrees(count, &links);
                match join {
                    Join::Loop if count > 2 => assert!(degrees.iter().all(|d| *d == 2)),
                    Join::Open if count > 2 => assert_eq!(links.len(), count - 1),
                    Join::Pairs => {
                        assert_eq!(links.len(), count.div_ceil(2));
                        assert!(degrees.iter().all(|d| *d >= 1));
                    }
                    _ => assert_eq!(links, [[0, 1]]),
                }
            }
        }
    }

    /// In a hexagon each meets the one across; in a pentagon one of two, and no
    /// centre is left out.
    #[test]
    fn opposites_lie_across() {
        let regular = |n: usize| -> Vec<Coord<f64>> {
            let angle = |k: usize| k as f64 / n as f64 * std::f64::consts::TAU;
            (0..n)
                .map(|k| coord! { x: angle(k).cos(), y: angle(k).sin() })
                .collect()
        };
        assert_eq!(
            links(Join::Opposites, &regular(6)),
            [[0, 3], [1, 4], [2, 5]]
        );
        let five = links(Join::Opposites, &regular(5));
        assert!(five.iter().all(|[a, b]| [2, 3].contains(&(b - a))));
        assert!(degrees(5, &five).iter().all(|d| *d >= 1));
        // One that lies aside has a straighter one across.
        let mut bent = regular(3);
        bent[0].y += 0.3;
        assert!(links(Join::Opposites, &bent).contains(&[0, 2]));
        assert_eq!(links(Join::Opposites, &regular(2)), [[0, 1]]);
    }

    #[test]
    fn trees_join_all() {
        let square = vec![[0, 1], [1, 2], [2, 3], [0, 3], [0, 2]];
        let at = random(4, 1);
        let found: Vec<Vec<Link>> = (0..20)
            .map(|seed| Join::Tree.links(&at, || square.clone(), &mut Stream::new(seed)))
            .collect();
        for links in &found {
            let mut groups = Groups::new(4);
            assert_eq!(links.len(), 3);
            assert!(links.iter().all(|&[a, b]| groups.join(a, b)));
        }
        assert!(found.iter().any(|links| *links != found[0]));
    }
}
