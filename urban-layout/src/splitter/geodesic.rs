//! A way through a region that no straight street finds: the shortest path
//! through its mesh that keeps off the boundary.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crossfield::Domain;
use geo_types::Coord;

use crate::plane::{dist, left, resample, unit};
use crate::region::Region;
use crate::segments::SegmentGrid;
use crate::splitter::{mesh_of, smooth};

/// Triangles of the mesh the path runs through, metres across.
const EDGE: f64 = 7.0;
/// A path this near to the boundary costs up to three times its length, metres.
const SHY: f64 = 10.0;
/// Rounds in which a path moves off the rim, and by how much a round, metres.
const CENTRING: usize = 12;
const STRIDE: f64 = 1.0;
/// A place counts as reached within this distance, metres.
const REACH: f64 = 12.0;

/// A queue entry, least cost first.
#[derive(PartialEq)]
struct Entry(f64, usize);

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

/// The ways through one region.
pub(crate) struct Ways {
    domain: Domain,
    /// What a metre costs at each vertex.
    price: Vec<f64>,
    rim: SegmentGrid,
}

impl Ways {
    /// Meshes the region; `None` where it cannot be meshed.
    pub(crate) fn of(region: &Region) -> Option<Self> {
        let domain = mesh_of(region, EDGE)?;
        let (grid, _) = region.grid();
        let price = domain
            .vertices()
            .iter()
            .map(|&p| 1.0 + 2.0 * grid.nearest(p, SHY).map_or(0.0, |h| 1.0 - h.distance / SHY))
            .collect();
        Some(Self {
            domain,
            price,
            rim: grid,
        })
    }

    /// The cheapest path from one of `from` to one of `to`, smoothed: the indices
    /// of its two ends and its points, ends included.
    pub(crate) fn path(
        &self,
        from: &[Coord<f64>],
        to: &[Coord<f64>],
    ) -> Option<(usize, usize, Vec<Coord<f64>>)> {
        let Self { domain, price, rim } = self;
        let points = domain.vertices();
        let inner = |v: usize| !domain.is_boundary(v);
        let near = |p: Coord<f64>| {
            (0..points.len())
                .filter(|&v| inner(v) && dist(points[v], p) < REACH)
                .min_by(|&a, &b| dist(points[a], p).total_cmp(&dist(points[b], p)))
        };
        let mut cost = vec![f64::INFINITY; points.len()];
        let mut before: Vec<Option<usize>> = vec![None; points.len()];
        let mut start = vec![usize::MAX; points.len()];
        let mut queue = BinaryHeap::new();
        for (i, &p) in from.iter().enumerate() {
            if let Some(v) = near(p) {
                if dist(points[v], p) < cost[v] {
                    cost[v] = dist(points[v], p);
                    start[v] = i;
                    queue.push(Entry(cost[v], v));
                }
            }
        }
        let mut goal: Vec<Option<usize>> = vec![None; points.len()];
        for (j, &p) in to.iter().enumerate() {
            if let Some(v) = near(p) {
                goal[v].get_or_insert(j);
            }
        }
        while let Some(Entry(c, v)) = queue.pop() {
            if c > cost[v] {
                continue;
            }
            if let Some(j) = goal[v] {
                let mut chain = vec![to[j], points[v]];
                let mut at = v;
                while let Some(u) = before[at] {
                    chain.push(points[u]);
                    at = u;
                }
                chain.push(from[start[at]]);
                chain.reverse();
                return Some((
                    start[at],
                    j,
                    centred(rim, &smooth(&resample(&chain, EDGE), 14)),
                ));
            }
            for &u in domain.neighbours(v) {
                let u = u as usize;
                let next = c + dist(points[v], points[u]) * 0.5 * (price[v] + price[u]);
                if inner(u) && next < cost[u] {
                    cost[u] = next;
                    before[u] = Some(v);
                    queue.push(Entry(next, u));
                }
            }
        }
        None
    }
}

/// The path moved off the rim where that is near: in a neck to its middle.
fn centred(rim: &SegmentGrid, points: &[Coord<f64>]) -> Vec<Coord<f64>> {
    let clearance = |p: Coord<f64>| rim.nearest(p, SHY).map_or(SHY, |h| h.distance);
    let mut points = points.to_vec();
    for _ in 0..CENTRING {
        let old = points.clone();
        for (i, w) in old.windows(3).enumerate() {
            let normal = left(unit(w[2] - w[0]));
            let tried = [0.0, STRIDE, -STRIDE].map(|d| w[1] + normal * d);
            if let Some(&best) = tried
                .iter()
                .max_by(|a, b| clearance(**a).total_cmp(&clearance(**b)))
                .filter(|p| clearance(**p) > clearance(w[1]) + 0.1 * STRIDE)
            {
                points[i + 1] = best;
            }
        }
        points = smooth(&points, 1);
    }
    points
}
