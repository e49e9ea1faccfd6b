//! Makes tiles share their vertices exactly.
//!
//! Tiles come from different hands (template faces, insets, booleans), and
//! where two of them meet, their vertices agree only up to rounding, or one has
//! a vertex in the middle of the other's edge. After [`seam`] every directed
//! edge of a tile has its reverse in exactly one other tile, or lies on the
//! boundary of their union: tiling becomes a matter of counting.

mod retrace;

use std::collections::BTreeMap;

use geo_types::{Coord, LineString, MultiPolygon, Polygon};
use rstar::primitives::GeomWithData;
use rstar::{RTree, AABB};

use retrace::{meets_itself, retraced, Chain};

use super::plane::{dot, lerp, minus, nearest_parameter, open_ring, rings, usable};

/// Rounds of inserting vertices into edges before giving up; each round may
/// bend an edge by the tolerance and so bring another vertex into reach.
const MAX_ROUNDS: usize = 12;

/// What [`seam`] did, and what it could not mend.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeamReport {
    /// Vertices that moved to a neighbour's place.
    pub merged: usize,
    /// Vertices inserted into edges.
    pub inserted: usize,
    /// Polygons whose exterior has no area left after merging; their polygon is
    /// now empty and should be dropped (their neighbours meet each other).
    pub collapsed: Vec<usize>,
    /// Holes that closed up or opened to the outside.
    pub closed_holes: usize,
    /// Polygons left alone because a coordinate is no number or beyond 1e8 m, or
    /// because their rings overlap themselves.
    pub unusable: Vec<usize>,
    /// Polygons that fell apart, where a strip thinner than the tolerance
    /// closed: the polygon's number and its pieces, largest first. The polygon
    /// itself is left with rings that meet themselves; put the pieces in its
    /// place.
    pub pieces: Vec<(usize, Vec<Polygon<f64>>)>,
}

/// Makes polygons share vertices exactly: [`seam_to`] without fixed vertices.
///
/// # Examples
///
/// ```
/// use geo_types::polygon;
/// use urban_layout::layout::seam;
///
/// // A tall tile beside two low ones, which disagree by a hundredth of a millimetre.
/// let mut tiles = vec![
///     polygon![(x: 0., y: 0.), (x: 10., y: 0.), (x: 10., y: 20.), (x: 0., y: 20.)],
///     polygon![(x: 10.00001, y: 0.), (x: 20., y: 0.), (x: 20., y: 10.), (x: 10.00001, y: 10.)],
///     polygon![(x: 10., y: 10.00001), (x: 20., y: 10.), (x: 20., y: 20.), (x: 10., y: 20.)],
/// ];
/// let report = seam(&mut tiles, 1e-4);
/// assert_eq!(report.inserted, 1);
/// assert!(tiles[0].exterior().0.contains(&tiles[1].exterior().0[3]));
/// ```
pub fn seam(polygons: &mut [Polygon<f64>], tolerance: f64) -> SeamReport {
    seam_to(polygons, &MultiPolygon::new(Vec::new()), tolerance)
}

/// Makes polygons share vertices exactly, and take over the vertices of
/// `boundary` (the site), which do not move.
///
/// Vertices within `tolerance` (metres; 1e-4 suits) of each other become one;
/// every vertex within `tolerance` of another polygon's edge becomes a vertex of
/// that edge; repeated points and spikes go. A vertex moves by at most
/// `tolerance`, and which one stays is decided by: a vertex of `boundary`, then
/// the one that most rings use, then the least x and y. Overlaps wider than the
/// tolerance are left alone, for [`check`](fn@crate::check::check) to find. Rings
/// keep their direction and their first vertex.
///
/// # Complexity
///
/// O(n log n) for n vertices, by an R-tree of vertices.
pub fn seam_to(
    polygons: &mut [Polygon<f64>],
    boundary: &MultiPolygon<f64>,
    tolerance: f64,
) -> SeamReport {
    let mut report = SeamReport::default();
    let bad = |p: &Polygon<f64>| !rings(p).flat_map(|r| &r.0).all(|c| usable(*c));
    report.unusable = (0..polygons.len()).filter(|i| bad(&polygons[*i])).collect();
    let taken: Vec<(usize, Polygon<f64>)> = report
        .unusable
        .iter()
        .map(|i| (*i, std::mem::replace(&mut polygons[*i], nothing())))
        .collect();
    let (places, of) = merge_vertices(polygons, boundary, tolerance);
    // Rings as numbers of places.
    let mut chains: Vec<Vec<Vec<usize>>> = Vec::with_capacity(polygons.len());
    for polygon in polygons.iter() {
        let mut own = Vec::new();
        for ring in rings(polygon) {
            let open = open_ring(ring);
            let chain: Vec<usize> = open.iter().map(|c| of[&key(*c)]).collect();
            report.merged += open
                .iter()
                .zip(&chain)
                .filter(|(c, i)| **c != places[**i])
                .count();
            own.push(without_spikes(chain));
        }
        chains.push(own);
    }
    report.inserted = insert_vertices(&mut chains, &places, tolerance);
    for (number, own) in chains.into_iter().enumerate() {
        let mut own: Vec<Chain> = own.into_iter().map(without_spikes).collect();
        let before = own.len();
        let exterior_left = own[0].len() > 2;
        own.retain(|chain| chain.len() > 2);
        let done = match (exterior_left, meets_itself(&own)) {
            (false, _) => Vec::new(),
            (true, false) => vec![own],
            (true, true) => match retraced(&own, &places) {
                Some(pieces) if pieces.len() > 1 => {
                    let pieces = pieces.iter().map(|rings| drawn(rings, &places)).collect();
                    report.pieces.push((number, pieces));
                    vec![own]
                }
                Some(single) => single,
                None => {
                    report.unusable.push(number);
                    vec![own]
                }
            },
        };
        polygons[number] = match done.first() {
            Some(rings) => {
                report.closed_holes += before.saturating_sub(rings.len());
                drawn(rings, &places)
            }
            None => {
                report.collapsed.push(number);
                nothing()
            }
        };
    }
    report.unusable.sort_unstable();
    report
        .collapsed
        .retain(|i| report.unusable.binary_search(i).is_err());
    for (number, polygon) in taken {
        polygons[number] = polygon;
    }
    report
}

/// A polygon of rings of places.
fn drawn(rings: &[Chain], places: &[Coord<f64>]) -> Polygon<f64> {
    let mut rings = rings.iter().map(|chain| -> LineString<f64> {
        chain
            .iter()
            .chain(chain.first())
            .map(|&i| places[i])
            .collect()
    });
    let exterior = rings.next().unwrap_or_else(|| LineString::new(Vec::new()));
    Polygon::new(exterior, rings.collect())
}

/// A polygon without vertices.
fn nothing() -> Polygon<f64> {
    Polygon::new(LineString::new(Vec::new()), Vec::new())
}

/// The bits of a coordinate.
type Key = (u64, u64);

/// A coordinate as a map key: its bits, with both zeros one.
fn key(c: Coord<f64>) -> Key {
    ((c.x + 0.0).to_bits(), (c.y + 0.0).to_bits())
}

/// The places that remain, and which of them each coordinate goes to.
fn merge_vertices(
    polygons: &[Polygon<f64>],
    boundary: &MultiPolygon<f64>,
    tolerance: f64,
) -> (Vec<Coord<f64>>, BTreeMap<Key, usize>) {
    let mut uses: BTreeMap<Key, (bool, usize)> = BTreeMap::new();
    for c in boundary.iter().flat_map(rings).flat_map(open_ring) {
        uses.entry(key(*c)).or_default().0 = true;
    }
    for c in polygons.iter().flat_map(rings).flat_map(open_ring) {
        uses.entry(key(*c)).or_default().1 += 1;
    }
    let at = |k: Key| Coord {
        x: f64::from_bits(k.0),
        y: f64::from_bits(k.1),
    };
    let mut order: Vec<_> = uses
        .into_iter()
        .map(|(k, (fixed, count))| (fixed, count, at(k), k))
        .collect();
    order.sort_by(|p, q| {
        (q.0, q.1)
            .cmp(&(p.0, p.1))
            .then(p.2.x.total_cmp(&q.2.x))
            .then(p.2.y.total_cmp(&q.2.y))
    });
    let mut places: Vec<Coord<f64>> = Vec::with_capacity(order.len());
    let mut of = BTreeMap::new();
    let mut tree: RTree<GeomWithData<[f64; 2], usize>> = RTree::new();
    for (fixed, _, c, k) in order {
        // A boundary vertex never moves, not even to another of the boundary.
        let near = if fixed {
            None
        } else {
            tree.nearest_neighbor(&[c.x, c.y])
        };
        let near = near.filter(|p| (p.geom()[0] - c.x).hypot(p.geom()[1] - c.y) <= tolerance);
        let place = near.map(|p| p.data).unwrap_or(places.len());
        if place == places.len() {
            tree.insert(GeomWithData::new([c.x, c.y], place));
            places.push(c);
        }
        of.insert(k, place);
    }
    (places, of)
}

/// Splits edges at the places that lie on them; how many were put in.
fn insert_vertices(chains: &mut [Vec<Vec<usize>>], places: &[Coord<f64>], tolerance: f64) -> usize {
    let tree = RTree::bulk_load(
        places
            .iter()
            .enumerate()
            .map(|(i, c)| GeomWithData::new([c.x, c.y], i))
            .collect::<Vec<_>>(),
    );
    // Edges are looked up both ways round as one, so that twins split alike.
    let mut known: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    let mut inserted = 0;
    for _ in 0..MAX_ROUNDS {
        let before = inserted;
        for chain in chains.iter_mut().flatten() {
            let n = chain.len();
            let mut split = Vec::with_capacity(n);
            for i in 0..n {
                let (a, b) = (chain[i], chain[(i + 1) % n]);
                let ends = (a.min(b), a.max(b));
                let inner = known
                    .entry(ends)
                    .or_insert_with(|| on_edge(&tree, places, ends, tolerance));
                split.push(a);
                inserted += inner.len();
                if a < b {
                    split.extend(inner.iter());
                } else {
                    split.extend(inner.iter().rev());
                }
            }
            *chain = split;
        }
        if inserted == before {
            break;
        }
    }
    inserted
}

/// Places within `tolerance` of an edge, other than its ends, in order along it.
fn on_edge(
    tree: &RTree<GeomWithData<[f64; 2], usize>>,
    places: &[Coord<f64>],
    (a, b): (usize, usize),
    tolerance: f64,
) -> Vec<usize> {
    /// A slanting edge is looked up in this many boxes, since one box around
    /// all of it would hold most of the plan.
    const PIECES: usize = 16;
    let (from, to) = (places[a], places[b]);
    let u = minus(to, from);
    let slanting = u.x.abs().min(u.y.abs()) > 64.0 * tolerance;
    let pieces = if slanting { PIECES } else { 1 };
    let mut found: Vec<(f64, usize)> = Vec::new();
    for piece in 0..pieces {
        let p = lerp(from, to, piece as f64 / pieces as f64);
        let q = lerp(from, to, (piece + 1) as f64 / pieces as f64);
        let low = [p.x.min(q.x) - tolerance, p.y.min(q.y) - tolerance];
        let high = [p.x.max(q.x) + tolerance, p.y.max(q.y) + tolerance];
        for near in tree.locate_in_envelope(&AABB::from_corners(low, high)) {
            let c = places[near.data];
            if near.data == a || near.data == b {
                continue;
            }
            let t = nearest_parameter(c, from, to);
            let foot = lerp(from, to, t);
            if t > 0.0 && t < 1.0 && dot(minus(c, foot), minus(c, foot)) <= tolerance * tolerance {
                found.push((t, near.data));
            }
        }
    }
    found.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    let mut inner: Vec<usize> = found.into_iter().map(|(_, i)| i).collect();
    inner.dedup();
    inner
}

/// A ring without repeated points and without spikes (there and straight back);
/// both halves of a spike cancel each other, so the neighbours still match.
fn without_spikes(chain: Vec<usize>) -> Vec<usize> {
    let first = chain.first().copied();
    let mut kept: Vec<usize> = Vec::with_capacity(chain.len());
    let push = |kept: &mut Vec<usize>, i: usize| {
        if kept.last() == Some(&i) {
            return;
        }
        if kept.len() >= 2 && kept[kept.len() - 2] == i {
            kept.pop();
            return;
        }
        kept.push(i);
    };
    for i in chain {
        push(&mut kept, i);
    }
    // The same across the seam of the ring.
    while kept.len() >= 2 {
        let n = kept.len();
        if kept[0] == kept[n - 1] {
            kept.pop();
        } else if n >= 3 && kept[1] == kept[n - 1] {
            kept.remove(0);
        } else if n >= 3 && kept[0] == kept[n - 2] {
            kept.pop();
        } else if n == 2 {
            kept.clear();
        } else {
            break;
        }
    }
    if let Some(start) = first.and_then(|f| kept.iter().position(|i| *i == f)) {
        kept.rotate_left(start);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::polygon;

    #[test]
    fn a_vertex_on_an_edge_is_shared() {
        let mut tiles = [
            polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.), (x: 0., y: 9.)],
            polygon![(x: 9., y: 0.), (x: 18., y: 0.), (x: 18., y: 4.), (x: 9.00005, y: 4.)],
            polygon![(x: 9., y: 4.), (x: 18., y: 4.), (x: 18., y: 9.), (x: 9., y: 9.)],
        ];
        let report = seam(&mut tiles, 1e-4);
        assert_eq!((report.inserted, report.merged), (1, 1));
        assert_eq!(tiles[0].exterior().0.len(), 6);
        assert!(report.collapsed.is_empty() && report.pieces.is_empty());
    }

    #[test]
    fn a_sliver_collapses_and_is_named() {
        let mut tiles = [
            polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.), (x: 0., y: 9.)],
            polygon![(x: 9., y: 0.), (x: 9.00001, y: 4.), (x: 9., y: 9.)],
        ];
        let report = seam(&mut tiles, 1e-4);
        assert_eq!(report.collapsed, vec![1]);
        assert!(tiles[1].exterior().0.is_empty());
    }

    #[test]
    fn the_site_s_vertices_stay() {
        let site = polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.), (x: 0., y: 9.)];
        let mut tiles =
            [polygon![(x: 1e-5, y: 0.), (x: 9., y: 1e-5), (x: 9., y: 9.), (x: 0., y: 9.)]];
        seam_to(&mut tiles, &MultiPolygon::new(vec![site.clone()]), 1e-4);
        assert_eq!(tiles[0], site);
    }

    #[test]
    fn spikes_go_even_across_the_start() {
        assert_eq!(without_spikes(vec![5, 0, 1, 2, 3, 0]), vec![0, 1, 2, 3]);
        assert_eq!(without_spikes(vec![0, 1, 2, 1, 3]), vec![0, 1, 3]);
        assert!(without_spikes(vec![0, 1, 0]).len() < 3);
        assert!(without_spikes(vec![0, 1, 2, 1]).len() < 3);
    }

    #[test]
    fn a_ring_that_meets_itself_is_parted() {
        let mut tiles = [polygon![
            (x: 0., y: 0.), (x: 4., y: 0.), (x: 2.00001, y: 2.0),
            (x: 4., y: 5.), (x: 0., y: 5.), (x: 1.99999, y: 2.0)
        ]];
        let report = seam(&mut tiles, 1e-4);
        assert_eq!(report.pieces.len(), 1);
        let (number, pieces) = &report.pieces[0];
        assert_eq!((*number, pieces.len()), (0, 2));
        assert!(pieces.iter().all(|piece| piece.exterior().0.len() == 4));
    }

    #[test]
    fn a_hair_of_street_along_the_site_closes() {
        // Street area around a block that comes within a hair of the site's edge.
        let block = [(3., 1e-6), (7., -1e-6), (7., 6.), (3., 6.)];
        let ring = |points: &[(f64, f64)]| {
            points
                .iter()
                .map(|&(x, y)| Coord { x, y })
                .collect::<LineString<f64>>()
        };
        let mut hole = ring(&block);
        hole.0.reverse();
        let street = Polygon::new(ring(&[(0., 0.), (9., 0.), (9., 9.), (0., 9.)]), vec![hole]);
        let mut tiles = [street, Polygon::new(ring(&block), vec![])];
        let report = seam(&mut tiles, 1e-4);
        assert!(tiles[0].interiors().is_empty() && report.pieces.is_empty());
        assert_eq!(report.closed_holes, 1);
        assert_eq!(crate::check::polygon_fault(&tiles[0]), None);
    }
}
