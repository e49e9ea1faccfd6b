//! Cells of a region of any shape.
//!
//! Cells of the plane are clipped to the region; where it is concave or has holes
//! a cell may fall into parts. The part with the site is the cell; any other joins
//! the neighbour that it has the longest border with, those with the longest
//! border first. (The other way, nearness by the way inside the region, has
//! borders that are hyperbolas; this one keeps them straight.) Since the region
//! is connected each part finds a neighbour.

use std::collections::BTreeMap;

use geo_types::Coord;

use crate::plane::{dist, extent, intersection, sides, union, Area, Ring, Weld};

/// Vertices this near, as a share of the region's size, are one.
const SAME: f64 = 1e-9;

/// What lies across an edge of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Beside {
    /// The cell of a site.
    Cell(usize),
    /// The region's boundary.
    Boundary,
}

/// The cell of a site.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub(super) site: usize,
    pub(super) area: Area,
    /// For each ring what lies across the edge from each vertex.
    pub(super) beside: Vec<Vec<Beside>>,
}

/// A part of a cell, by its vertices.
struct Part {
    cell: usize,
    rings: Vec<Vec<usize>>,
    owner: Option<usize>,
}

/// The cells of a region from those of the plane, which tile it; by site.
pub(super) fn within(region: &Area, rings: &[Ring], sites: &[Coord<f64>]) -> Vec<Cell> {
    let mut found = clipped(region, rings);
    let (low, high) = region.extent();
    let tolerance = SAME * (high.x - low.x).max(high.y - low.y);
    let all = found.iter().flat_map(|(_, area)| area.rings());
    let mut weld = Weld::for_rings(tolerance, region.rings().chain(all));
    let outline: Vec<Vec<usize>> = region.rings().map(|ring| weld.ring(ring)).collect();
    let mut parts: Vec<Part> = Vec::new();
    let mut seeds: BTreeMap<usize, (f64, usize)> = BTreeMap::new();
    for (cell, area) in found.drain(..) {
        let away = if area.contains(sites[cell]) {
            0.0
        } else {
            area.nearest(sites[cell]).1
        };
        let rings: Vec<Vec<usize>> = area.rings().map(|ring| weld.ring(ring)).collect();
        if rings[0].len() < 3 {
            continue;
        }
        let seed = seeds.entry(cell).or_insert((away, parts.len()));
        if away < seed.0 {
            *seed = (away, parts.len());
        }
        parts.push(Part {
            cell,
            rings,
            owner: None,
        });
    }
    for part in &mut parts {
        for ring in &mut part.rings {
            *ring = weld.noded(ring);
        }
    }
    for (&cell, &(_, part)) in &seeds {
        parts[part].owner = Some(cell);
    }
    attach(&mut parts, &weld);
    let merged = merged(&parts, &weld, &mut seeds.into_keys());
    beside(merged, outline, weld)
}

/// What of each cell lies in the region.
fn clipped(region: &Area, rings: &[Ring]) -> Vec<(usize, Area)> {
    let edges: Vec<[Coord<f64>; 2]> = region
        .rings()
        .flat_map(|ring| sides(ring))
        .map(|(a, b)| {
            let (low, high) = extent(&[a, b]);
            [low, high]
        })
        .collect();
    let mut found = Vec::new();
    for (cell, ring) in rings.iter().enumerate() {
        if ring.len() < 3 {
            continue;
        }
        let (low, high) = extent(ring);
        let meets = |[from, to]: &[Coord<f64>; 2]| {
            from.x <= high.x && to.x >= low.x && from.y <= high.y && to.y >= low.y
        };
        let area = Area::new(ring.clone(), Vec::new());
        if edges.iter().any(meets) {
            let parts = intersection(&[area], std::slice::from_ref(region));
            found.extend(parts.into_iter().map(|part| (cell, part)));
        } else if region.contains(ring[0]) {
            found.push((cell, area));
        }
    }
    found
}

/// Edges as they are walked, with whose they are, sorted.
fn edges<'r>(rings: impl Iterator<Item = (usize, &'r Vec<usize>)>) -> Vec<(usize, usize, usize)> {
    let mut edges = Vec::new();
    for (whose, ring) in rings {
        let next = ring.iter().cycle().skip(1);
        edges.extend(ring.iter().zip(next).map(|(&a, &b)| (a, b, whose)));
    }
    edges.sort_unstable();
    edges
}

/// Whose edge lies across another.
fn across(edges: &[(usize, usize, usize)], from: usize, to: usize) -> Option<usize> {
    let k = edges.partition_point(|&(a, b, _)| (a, b) < (to, from));
    edges
        .get(k)
        .filter(|e| (e.0, e.1) == (to, from))
        .map(|e| e.2)
}

/// Gives parts without a site to their neighbours.
fn attach(parts: &mut [Part], weld: &Weld) {
    let mut free: Vec<usize> = (0..parts.len())
        .filter(|&k| parts[k].owner.is_none())
        .collect();
    if free.is_empty() {
        return;
    }
    let all = parts
        .iter()
        .enumerate()
        .flat_map(|(k, part)| part.rings.iter().map(move |ring| (k, ring)));
    let edges = edges(all);
    let mut common: BTreeMap<usize, BTreeMap<usize, f64>> = BTreeMap::new();
    for &k in &free {
        let lengths = common.entry(k).or_default();
        for ring in &parts[k].rings {
            for (j, &from) in ring.iter().enumerate() {
                let to = ring[(j + 1) % ring.len()];
                if let Some(other) = across(&edges, from, to) {
                    *lengths.entry(other).or_default() += dist(weld.at(from), weld.at(to));
                }
            }
        }
    }
    while !free.is_empty() {
        let mut best: Option<(f64, usize, usize)> = None;
        for (place, k) in free.iter().enumerate() {
            let mut by_owner: BTreeMap<usize, f64> = BTreeMap::new();
            for (&other, &length) in &common[k] {
                if let Some(owner) = parts[other].owner {
                    *by_owner.entry(owner).or_default() += length;
                }
            }
            for (owner, length) in by_owner {
                if best.is_none_or(|(most, _, _)| length > most) {
                    best = Some((length, place, owner));
                }
            }
        }
        match best {
            Some((_, place, owner)) => {
                let k = free.remove(place);
                parts[k].owner = Some(owner);
            }
            // A part that meets others in points alone.
            None => {
                for k in free.drain(..) {
                    parts[k].owner = Some(parts[k].cell);
                }
            }
        }
    }
}

/// The parts of each cell as one.
fn merged(
    parts: &[Part],
    weld: &Weld,
    cells: &mut dyn Iterator<Item = usize>,
) -> Vec<(usize, Area)> {
    let area = |part: &Part| {
        let mut rings = part.rings.iter().map(|ring| weld.points(ring));
        let outer = rings.next().unwrap_or_default();
        let holes = rings.filter(|ring| ring.len() > 2).collect();
        Area { outer, holes }
    };
    let mut found = Vec::new();
    for cell in cells {
        let mut own: Vec<Area> = parts
            .iter()
            .filter(|part| part.owner == Some(cell))
            .map(area)
            .collect();
        if own.len() > 1 {
            own = union(&own);
        }
        found.extend(own.into_iter().map(|area| (cell, area)));
    }
    found
}

/// What lies across each edge.
fn beside(found: Vec<(usize, Area)>, outline: Vec<Vec<usize>>, mut weld: Weld) -> Vec<Cell> {
    let numbered: Vec<(usize, Vec<Vec<usize>>)> = found
        .iter()
        .map(|(cell, area)| (*cell, area.rings().map(|ring| weld.ring(ring)).collect()))
        .collect();
    let noded: Vec<(usize, Vec<Vec<usize>>)> = numbered
        .into_iter()
        .map(|(cell, rings)| (cell, rings.iter().map(|ring| weld.noded(ring)).collect()))
        .collect();
    let outline: Vec<Vec<usize>> = outline.iter().map(|ring| weld.noded(ring)).collect();
    let own = edges(outline.iter().map(|ring| (0, ring)));
    let all = noded
        .iter()
        .flat_map(|(cell, rings)| rings.iter().map(move |ring| (*cell, ring)));
    let edges = edges(all);
    let mut cells = Vec::new();
    for (site, rings) in &noded {
        let solid: Vec<&Vec<usize>> = rings.iter().filter(|ring| ring.len() > 2).collect();
        let Some((outer, holes)) = solid.split_first() else {
            continue;
        };
        let beside = |ring: &&Vec<usize>| -> Vec<Beside> {
            let edge = |k: usize| {
                let (from, to) = (ring[k], ring[(k + 1) % ring.len()]);
                match across(&edges, from, to) {
                    Some(other) => Beside::Cell(other),
                    // What has no neighbour by rounding is a border all the same.
                    None if across(&own, to, from).is_none() => Beside::Cell(*site),
                    None => Beside::Boundary,
                }
            };
            (0..ring.len()).map(edge).collect()
        };
        cells.push(Cell {
            site: *site,
            beside: solid.iter().map(beside).collect(),
            area: Area {
                outer: weld.points(outer),
                holes: holes.iter().map(|ring| weld.points(ring)).collect(),
            },
        });
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::{Diagram, Site};
    use geo_types::coord;

    fn points(list: &[(f64, f64)]) -> Ring {
        list.iter().map(|&(x, y)| coord! { x: x, y: y }).collect()
    }

    fn cells(region: &Area, at: &[(f64, f64)]) -> Vec<Cell> {
        let at = points(at);
        let sites: Vec<Site> = at.iter().map(|&at| Site { at, weight: 0.0 }).collect();
        let frame = points(&[(-9., -9.), (-9., 99.), (99., 99.), (99., -9.)]);
        let diagram = Diagram::new(&sites, &frame);
        let rings: Vec<Ring> = diagram
            .cells
            .iter()
            .map(|ring| diagram.weld.points(ring))
            .collect();
        within(region, &rings, &at)
    }

    /// A U whose right arm lies nearer to a site in the left arm than to the one
    /// at the bottom: it belongs to the bottom, with which it is connected.
    #[test]
    fn parts_that_are_cut_off_join_a_neighbour() {
        let u = Area::new(
            points(&[
                (0., 0.),
                (0., 30.),
                (4., 30.),
                (4., 4.),
                (8., 4.),
                (8., 30.),
                (12., 30.),
                (12., 0.),
            ]),
            Vec::new(),
        );
        let found = cells(&u, &[(2., 20.), (2., 2.)]);
        assert_eq!(found.len(), 2);
        // Of the left arm all above 11.
        assert!((found[0].area.size() - 4.0 * 19.0).abs() < 1e-9);
        assert!((found[1].area.size() - (u.size() - 76.0)).abs() < 1e-9);
        let borders = |cell: &Cell| {
            let all = cell.beside.iter().flatten();
            all.filter(|b| **b != Beside::Boundary).count()
        };
        assert_eq!((borders(&found[0]), borders(&found[1])), (1, 1));
    }

    /// Around a hole of a ring the two cells meet twice.
    #[test]
    fn holes_keep_their_edges() {
        let ring = Area::new(
            points(&[(0., 0.), (0., 12.), (12., 12.), (12., 0.)]),
            vec![points(&[(4., 4.), (8., 4.), (8., 8.), (4., 8.)])],
        );
        let found = cells(&ring, &[(1., 6.), (11., 6.)]);
        assert_eq!(found.len(), 2);
        for (k, cell) in found.iter().enumerate() {
            assert!((cell.area.size() - 64.0).abs() < 1e-9);
            let other = Beside::Cell(1 - k);
            let count = cell.beside.iter().flatten().filter(|b| **b == other);
            assert_eq!(count.count(), 2);
        }
    }
}
