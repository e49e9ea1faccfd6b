//! Which paths are connected, and where they lead out.

use std::collections::BTreeMap;

use geo_types::Coord;

use super::locate::{Edge, Locator};
use super::PathNetwork;
use crate::plane::{cross, dot, norm, Area};

/// Narrower openings, metres, let nobody through: parts that share less of their
/// borders are not connected, and a park that is entered over less is not
/// entered.
pub(super) const WAY: f64 = 0.5;

/// The connected parts of all paths, the largest first. `paths` are numbers of
/// pieces with their areas; `near` is how far apart borders may lie that are one.
pub(super) fn networks(outline: &Area, paths: &[(usize, &Area)], near: f64) -> Vec<PathNetwork> {
    let locator = Locator::new(paths.iter().copied());
    // Not a hole's border: what lies in a hole is no way out.
    let rim = Area::new(outline.outer.clone(), Vec::new());
    let rim = Locator::new([(0, &rim)]);
    let by = Coord { x: near, y: near };
    let mut shared: BTreeMap<[usize; 2], f64> = BTreeMap::new();
    let mut entrances: BTreeMap<usize, f64> = BTreeMap::new();
    for edge in locator.edges() {
        let (low, high) = crate::plane::extent(&[edge.a, edge.b]);
        let others = locator.meeting(low - by, high + by);
        for other in others.filter(|other| other.owner > edge.owner) {
            let length = common(edge, other, near, -1.0);
            if length > 0.0 {
                *shared.entry([edge.owner, other.owner]).or_default() += length;
            }
        }
        for other in rim.meeting(low - by, high + by) {
            *entrances.entry(edge.owner).or_default() += common(edge, other, near, 1.0);
        }
    }
    let mut parts: Vec<usize> = (0..paths.len()).collect();
    let number: BTreeMap<usize, usize> = paths
        .iter()
        .enumerate()
        .map(|(k, (p, _))| (*p, k))
        .collect();
    for ([a, b], length) in shared {
        if length >= WAY {
            let (a, b) = (root(&parts, number[&a]), root(&parts, number[&b]));
            parts[a.max(b)] = a.min(b);
        }
    }
    let mut found: BTreeMap<usize, PathNetwork> = BTreeMap::new();
    for (k, (piece, area)) in paths.iter().enumerate() {
        let network = found.entry(root(&parts, k)).or_default();
        network.pieces.push(*piece);
        network.area += area.size();
        network.entrance += entrances.get(piece).copied().unwrap_or(0.0);
    }
    let mut found: Vec<PathNetwork> = found.into_values().collect();
    found.sort_by(|a, b| b.area.total_cmp(&a.area));
    found
}

fn root(parts: &[usize], mut k: usize) -> usize {
    while parts[k] != k {
        k = parts[k];
    }
    k
}

/// How much of an edge another runs along, `way` 1 for the same direction and -1
/// for the opposite one.
fn common(edge: &Edge, other: &Edge, near: f64, way: f64) -> f64 {
    let along = edge.b - edge.a;
    let length = norm(along);
    if length == 0.0 || way * dot(along, other.b - other.a) <= 0.0 {
        return 0.0;
    }
    let along = along / length;
    let place = |p: Coord<f64>| (dot(p - edge.a, along), cross(along, p - edge.a));
    let (mut from, mut to) = (place(other.a), place(other.b));
    if from.0 > to.0 {
        std::mem::swap(&mut from, &mut to);
    }
    let (start, end) = (from.0.max(0.0), to.0.min(length));
    if end <= start {
        return 0.0;
    }
    // How far the other is off at both ends of what they might share.
    let off = |t: f64| from.1 + (to.1 - from.1) * (t - from.0) / (to.0 - from.0);
    if off(start).abs() <= near && off(end).abs() <= near {
        end - start
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn edge(a: (f64, f64), b: (f64, f64)) -> Edge {
        Edge {
            a: coord! { x: a.0, y: a.1 },
            b: coord! { x: b.0, y: b.1 },
            owner: 0,
        }
    }

    #[test]
    fn borders_are_shared_along_their_common_part() {
        let east = edge((0., 0.), (10., 0.));
        let back = edge((14., 0.), (4., 0.));
        assert_eq!(common(&east, &back, 1e-6, -1.0), 6.0);
        assert_eq!(common(&east, &back, 1e-6, 1.0), 0.0);
        // Beyond its end, across, and beside it.
        for other in [
            edge((14., 0.), (10., 0.)),
            edge((5., 1.), (5., -1.)),
            edge((10., 0.1), (0., 0.1)),
        ] {
            assert_eq!(common(&east, &other, 1e-6, -1.0), 0.0);
        }
    }
}
