//! Rings drawn anew where merging vertices made them meet.
//!
//! A strip thinner than the tolerance closes when its two sides become one: an
//! exterior then runs along a hole, or a ring touches itself. What is left of the
//! polygon is found by counting: opposite edges cancel, and the rest is walked
//! with the land on its left.

use std::collections::BTreeMap;

use geo_types::Coord;

use crate::layout::plane::{lerp, minus, signed_area};

/// A ring as numbers of places, not closed.
pub(super) type Chain = Vec<usize>;

/// Whether two vertices of a polygon's rings are in one place.
pub(super) fn meets_itself(rings: &[Chain]) -> bool {
    let mut all: Vec<usize> = rings.iter().flatten().copied().collect();
    all.sort_unstable();
    all.windows(2).any(|w| w[0] == w[1])
}

/// The polygons that a polygon's rings enclose once opposite edges have
/// cancelled: each an exterior and its holes, valid by OGC's rules, the largest
/// first; none if all has cancelled. `None` if the rings overlap, so that no
/// walk leads round.
pub(super) fn retraced(rings: &[Chain], places: &[Coord<f64>]) -> Option<Vec<Vec<Chain>>> {
    let cycles = cycles(&remaining_edges(rings), places)?;
    let area = |chain: &Chain| {
        let closed: Vec<Coord<f64>> = chain
            .iter()
            .chain(chain.first())
            .map(|&i| places[i])
            .collect();
        signed_area(&closed)
    };
    let mut polygons: Vec<(f64, Vec<Chain>)> = Vec::new();
    let mut free: Vec<Chain> = Vec::new();
    for cycle in cycles {
        let (outer, holes): (Vec<Chain>, Vec<Chain>) = loops(cycle)
            .into_iter()
            .partition(|chain| area(chain) > 0.0);
        let single = outer.len() == 1;
        for exterior in outer {
            polygons.push((area(&exterior), vec![exterior]));
        }
        match polygons.last_mut() {
            // A cycle bounds connected land, so that its holes are this exterior's.
            Some((_, polygon)) if single => polygon.extend(holes),
            _ => free.extend(holes),
        }
    }
    polygons.sort_by(|p, q| q.0.total_cmp(&p.0));
    for hole in free {
        let inner = lerp(places[hole[0]], places[hole[1]], 0.5);
        // The smallest that contains it.
        let around = polygons
            .iter_mut()
            .rev()
            .find(|(_, p)| contains(&p[0], places, inner))?;
        around.1.push(hole);
    }
    Some(polygons.into_iter().map(|(_, polygon)| polygon).collect())
}

/// Directed edges that no opposite edge cancels, in order.
fn remaining_edges(rings: &[Chain]) -> Vec<(usize, usize)> {
    let mut count: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for ring in rings {
        for (i, &a) in ring.iter().enumerate() {
            *count.entry((a, ring[(i + 1) % ring.len()])).or_default() += 1;
        }
    }
    let mut edges = Vec::new();
    for (&(a, b), &forth) in &count {
        let back = count.get(&(b, a)).copied().unwrap_or(0);
        edges.extend(std::iter::repeat_n((a, b), forth.saturating_sub(back)));
    }
    edges
}

/// Walks the edges: at a vertex the way goes on along the first edge clockwise
/// from the one it came by, which is the far side of the land on its left.
fn cycles(edges: &[(usize, usize)], places: &[Coord<f64>]) -> Option<Vec<Chain>> {
    let angle = |from: usize, to: usize| {
        let u = minus(places[to], places[from]);
        u.y.atan2(u.x)
    };
    let mut next = vec![usize::MAX; edges.len()];
    let mut taken = vec![false; edges.len()];
    for (e, &(u, v)) in edges.iter().enumerate() {
        let back = angle(v, u);
        let first = edges.partition_point(|edge| edge.0 < v);
        let leaving = (first..edges.len()).take_while(|f| edges[*f].0 == v);
        let clockwise = |f: &usize| {
            let turn = (back - angle(v, edges[*f].1)).rem_euclid(std::f64::consts::TAU);
            if turn > 0.0 {
                turn
            } else {
                std::f64::consts::TAU
            }
        };
        let best = leaving.min_by(|p, q| clockwise(p).total_cmp(&clockwise(q)))?;
        if std::mem::replace(&mut taken[best], true) {
            return None;
        }
        next[e] = best;
    }
    let mut walked = vec![false; edges.len()];
    let mut all = Vec::new();
    for start in 0..edges.len() {
        let (mut e, mut cycle) = (start, Vec::new());
        while !std::mem::replace(&mut walked[e], true) {
            cycle.push(edges[e].0);
            e = next[e];
        }
        if !cycle.is_empty() {
            all.push(cycle);
        }
    }
    Some(all)
}

/// A cycle cut where it comes by a place again, into simple rings.
fn loops(cycle: Chain) -> Vec<Chain> {
    let mut found = Vec::new();
    let mut way: Chain = Vec::new();
    for i in cycle {
        if let Some(at) = way.iter().position(|k| *k == i) {
            found.push(way.split_off(at));
        }
        way.push(i);
    }
    found.push(way);
    found.retain(|ring| ring.len() > 2);
    found
}

/// Whether a point is inside a ring, by crossings of the ray towards east.
fn contains(ring: &Chain, places: &[Coord<f64>], p: Coord<f64>) -> bool {
    let n = ring.len();
    let crossed = (0..n).filter(|&i| {
        let (a, b) = (places[ring[i]], places[ring[(i + 1) % n]]);
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of 5 x 5 places, number x + 5 y.
    fn grid() -> Vec<Coord<f64>> {
        (0..25)
            .map(|i| Coord {
                x: f64::from(i % 5),
                y: f64::from(i / 5),
            })
            .collect()
    }

    #[test]
    fn a_hole_along_the_exterior_becomes_a_bay() {
        // The frame 0..4 and a hole that shares the middle of its lower side.
        let outer = vec![0, 1, 3, 4, 24, 20];
        let hole = vec![3, 1, 11, 13];
        let done = retraced(&[outer, hole], &grid()).expect("a walk");
        assert_eq!(done, vec![vec![vec![0, 1, 11, 13, 3, 4, 24, 20]]]);
    }

    #[test]
    fn a_hole_across_cuts_in_two() {
        let outer = vec![0, 1, 3, 4, 24, 23, 21, 20];
        let hole = vec![3, 1, 21, 23];
        let done = retraced(&[outer, hole], &grid()).expect("a walk");
        assert_eq!(
            done,
            vec![vec![vec![0, 1, 21, 20]], vec![vec![3, 4, 24, 23]]]
        );
    }

    #[test]
    fn touching_points_are_kept_as_rings() {
        // A hole that touches the exterior in one point.
        let (outer, hole) = (vec![0, 2, 4, 24, 20], vec![2, 11, 13]);
        let done = retraced(&[outer.clone(), hole.clone()], &grid()).expect("a walk");
        assert_eq!(done.len(), 1);
        assert_eq!((done[0][0].len(), done[0][1].len()), (5, 3));
        // Two lobes that touch: two polygons.
        let done = retraced(&[vec![0, 2, 12, 14, 24, 22, 12, 10]], &grid()).expect("a walk");
        assert_eq!(done.len(), 2);
        // The same hole written as part of the exterior.
        let done = retraced(&[vec![0, 2, 11, 13, 2, 4, 24, 20]], &grid()).expect("a walk");
        assert_eq!((done.len(), done[0].len()), (1, 2));
    }

    #[test]
    fn what_cancels_is_nothing() {
        assert_eq!(
            retraced(&[vec![0, 4, 24], vec![24, 4, 0]], &grid()),
            Some(vec![])
        );
    }
}
