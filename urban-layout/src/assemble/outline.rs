//! Outlines from directed edges: hairs cancelled, rings simple.
//!
//! A boolean difference leaves hairs where two outlines agree only up to
//! rounding. Once vertices are shared, a hair is an edge walked both ways: the
//! two cancel, and what remains is linked into rings anew.

use std::collections::BTreeMap;

use geo_types::{Coord, Polygon};

use crate::assemble::polygon_of;
use crate::plane::{at, in_ring, inner_point, signed_area, turn};

type Key = (u64, u64);

fn key(p: Coord<f64>) -> Key {
    (p.x.to_bits(), p.y.to_bits())
}

fn point(k: Key) -> Coord<f64> {
    at(f64::from_bits(k.0), f64::from_bits(k.1))
}

/// The same land without hairs: every edge that is walked both ways goes, and
/// the rest forms polygons whose rings do not touch themselves.
pub(crate) fn without_hairs<'a>(
    polygons: impl Iterator<Item = &'a Polygon<f64>>,
) -> Vec<Polygon<f64>> {
    let mut next: BTreeMap<Key, Vec<Key>> = BTreeMap::new();
    for polygon in polygons {
        for ring in std::iter::once(polygon.exterior()).chain(polygon.interiors()) {
            for w in ring.0.windows(2) {
                let (a, b) = (key(w[0]), key(w[1]));
                if a == b {
                    continue;
                }
                let back = next
                    .get_mut(&b)
                    .and_then(|out| out.iter().position(|&c| c == a).map(|i| out.swap_remove(i)));
                if back.is_none() {
                    next.entry(a).or_default().push(b);
                }
            }
        }
    }
    let mut rings: Vec<Vec<Coord<f64>>> = Vec::new();
    let starts: Vec<Key> = next.keys().copied().collect();
    for start in starts {
        while let Some(first) = next.get_mut(&start).and_then(Vec::pop) {
            let mut chain = vec![start, first];
            while chain[chain.len() - 1] != start {
                let (u, v) = (chain[chain.len() - 2], chain[chain.len() - 1]);
                let Some(w) = take_leftmost(&mut next, u, v) else {
                    break;
                };
                chain.push(w);
            }
            if chain.pop() == Some(start) {
                simple_loops(&chain, &mut rings);
            }
        }
    }
    nest(rings)
}

/// The edge out of `v` that, coming from `u`, keeps the land on the left.
fn take_leftmost(next: &mut BTreeMap<Key, Vec<Key>>, u: Key, v: Key) -> Option<Key> {
    let out = next.get_mut(&v)?;
    let heading = point(v) - point(u);
    let best = (0..out.len()).max_by(|&i, &j| {
        turn(heading, point(out[i]) - point(v)).total_cmp(&turn(heading, point(out[j]) - point(v)))
    })?;
    Some(out.swap_remove(best))
}

/// Cuts a chain wherever it comes back to a vertex.
fn simple_loops(chain: &[Key], rings: &mut Vec<Vec<Coord<f64>>>) {
    let mut stack: Vec<Key> = Vec::new();
    for &k in chain {
        if let Some(i) = stack.iter().position(|&q| q == k) {
            rings.push(stack.drain(i..).map(point).collect());
        }
        stack.push(k);
    }
    rings.push(stack.into_iter().map(point).collect());
}

/// Rings as polygons: each clockwise one is a hole of the least ring around it.
fn nest(rings: Vec<Vec<Coord<f64>>>) -> Vec<Polygon<f64>> {
    let (mut outer, mut holes): (Vec<_>, Vec<_>) = (Vec::new(), Vec::new());
    for ring in rings {
        let area = signed_area(&ring);
        if ring.len() >= 3 && area > 0.0 {
            outer.push((area, vec![ring]));
        } else if ring.len() >= 3 && area < 0.0 {
            holes.push(ring);
        }
    }
    outer.sort_by(|a, b| a.0.total_cmp(&b.0));
    for hole in holes {
        let Some(p) = inner_point(std::slice::from_ref(&hole)) else {
            continue;
        };
        if let Some((_, rings)) = outer.iter_mut().find(|(_, rings)| in_ring(&rings[0], p)) {
            rings.push(hole);
        }
    }
    outer
        .into_iter()
        .map(|(_, rings)| polygon_of(&rings))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{polygon, LineString};

    #[test]
    fn a_hair_between_two_blocks_goes() {
        // A square with two holes side by side that share an edge.
        let square = polygon!(
            exterior: [(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.), (x: 0., y: 9.)],
            interiors: [
                [(x: 2., y: 2.), (x: 2., y: 4.), (x: 4., y: 4.), (x: 4., y: 2.)],
                [(x: 4., y: 2.), (x: 4., y: 4.), (x: 6., y: 4.), (x: 6., y: 2.)],
            ],
        );
        let out = without_hairs(std::iter::once(&square));
        assert_eq!(out.len(), 1);
        assert_eq!(out[0].interiors().len(), 1);
        let hole = &out[0].interiors()[0].0;
        assert_eq!(signed_area(&hole[..hole.len() - 1]), -8.0);
    }

    #[test]
    fn a_hole_that_touches_the_outline_at_a_point_stays_a_hole() {
        let ring = vec![
            (0., 0.),
            (9., 0.),
            (9., 9.),
            (0., 9.),
            (0., 5.),
            (2., 6.),
            (2., 4.),
            (0., 5.),
            (0., 0.),
        ];
        let pinched = Polygon::new(LineString::from(ring), vec![]);
        let out = without_hairs(std::iter::once(&pinched));
        assert_eq!(out.len(), 1);
        assert_eq!(
            (out[0].exterior().0.len(), out[0].interiors().len()),
            (6, 1)
        );
    }
}
