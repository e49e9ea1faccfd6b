//! What the boundary of a region's mesh is: streets that exist, ways out,
//! sides that no street may follow.

use geo_types::Coord;
use network_opt::design::Tessellation;

use crate::network::{Network, Side, SideKind};
use crate::plane::{angle, dist, unit};
use crate::region::Region;
use crate::segments::SegmentGrid;
use crate::site::RoadClass;

/// The boundary of one mesh.
#[derive(Debug)]
pub(super) struct RimFacts {
    /// Edges that are streets already, for parcels to front on.
    pub(super) given: Vec<usize>,
    /// Vertices from which a street may lead out of the region.
    pub(super) sinks: Vec<usize>,
    /// Of those the ones where a street outside waits to be continued.
    pub(super) entries: Vec<usize>,
}

/// An entry belongs to a vertex of the mesh within so many edges.
const ENTRY_REACH: f64 = 1.5;
/// Distance between ways out to a road without frontage, metres: a little more
/// than what junctions on it keep.
const MAJOR_SPACING: f64 = 160.0;
/// Where nothing leads out, ways out are chosen one in so many metres of
/// boundary, at least two and at most six.
const OPENING: f64 = 500.0;
/// A vertex whose boundary turns by more is no place for a way out, degrees.
const BENT_DEG: f64 = 40.0;

impl RimFacts {
    pub(super) fn of(mesh: &Tessellation, region: &Region, network: &Network) -> Self {
        let (grid, sides) = region.grid();
        let rim: Vec<bool> = mesh.rim().collect();
        let points = mesh.points();
        let far = region.perimeter();
        let side_at =
            |p: Coord<f64>| -> Option<Side> { grid.nearest(p, far).map(|hit| sides[hit.segment]) };
        let middle = |e: usize| {
            let [a, b] = mesh.edges()[e];
            (points[a] + points[b]) * 0.5
        };
        let edges: Vec<(usize, Side)> = (0..rim.len())
            .filter(|&e| rim[e])
            .filter_map(|e| Some((e, side_at(middle(e))?)))
            .collect();
        let given: Vec<usize> = edges
            .iter()
            .filter(|(_, side)| side.access && side.kind != SideKind::Element)
            .map(|&(e, _)| e)
            .collect();
        let mut facts = Self {
            sinks: given.iter().flat_map(|&e| mesh.edges()[e]).collect(),
            given,
            entries: Vec::new(),
        };
        let reach = ENTRY_REACH * mean_edge(mesh);
        let opens = |v: usize| mesh.around(v).iter().any(|&(e, _)| !rim[e]);
        let outer: Vec<usize> = ring_vertices(mesh, &rim)
            .into_iter()
            .filter(|&v| opens(v))
            .collect();
        for entry in &network.entries {
            let near = |v: &&usize| dist(points[**v], entry.at) < reach;
            let best = outer
                .iter()
                .filter(near)
                .min_by(|&&v, &&w| dist(points[v], entry.at).total_cmp(&dist(points[w], entry.at)));
            if let Some(&v) = best {
                let faces = side_at(points[v]).is_some_and(|s| s.kind == SideKind::Boundary);
                if faces && on_rim_of(&grid, entry.at) {
                    facts.entries.push(v);
                }
            }
        }
        facts.sinks.extend(&facts.entries);
        facts.add_majors(mesh, network, &edges, &outer);
        if facts.sinks.is_empty() {
            facts.open(mesh, &outer, &side_at);
        }
        for list in [&mut facts.sinks, &mut facts.entries] {
            list.sort_unstable();
            list.dedup();
        }
        facts
    }

    /// Ways out to roads without frontage, far from each other.
    fn add_majors(
        &mut self,
        mesh: &Tessellation,
        network: &Network,
        edges: &[(usize, Side)],
        outer: &[usize],
    ) {
        let points = mesh.points();
        let mut taken: Vec<Coord<f64>> = network
            .mesh
            .vertices()
            .filter(|&v| {
                let streets = network.streets_at(v);
                let major = |&h: &network_opt::HalfEdgeId| {
                    network
                        .street_of(h)
                        .is_some_and(|s| s.class == RoadClass::Major)
                };
                streets.len() >= 3 && streets.iter().any(major)
            })
            .map(|v| network.mesh.point(v))
            .collect();
        let majors = edges
            .iter()
            .filter(|(_, side)| side.kind == SideKind::Street && !side.access);
        for v in majors.flat_map(|&(e, _)| mesh.edges()[e]) {
            let clear = taken.iter().all(|&p| dist(p, points[v]) > MAJOR_SPACING);
            if clear && outer.contains(&v) {
                taken.push(points[v]);
                self.sinks.push(v);
            }
        }
    }

    /// Ways out of land that nothing leads to, evenly along its outer boundary.
    fn open(
        &mut self,
        mesh: &Tessellation,
        outer: &[usize],
        side_at: &dyn Fn(Coord<f64>) -> Option<Side>,
    ) {
        let points = mesh.points();
        let straight: Vec<usize> = outer
            .iter()
            .copied()
            .filter(|&v| {
                let side = side_at(points[v]);
                side.is_some_and(|s| s.kind == SideKind::Boundary) && bend(mesh, v) < BENT_DEG
            })
            .collect();
        let length = mean_edge(mesh) * outer.len() as f64;
        let wanted = (length / OPENING).round().clamp(2.0, 6.0) as usize;
        let from: &[usize] = if straight.is_empty() {
            outer
        } else {
            &straight
        };
        let n = from.len();
        for k in 0..wanted.min(n) {
            self.sinks.push(from[(2 * k + 1) * n / (2 * wanted.min(n))]);
        }
        self.entries.clone_from(&self.sinks);
    }
}

/// Whether a point lies on a region's boundary.
fn on_rim_of(grid: &SegmentGrid, p: Coord<f64>) -> bool {
    grid.nearest(p, 0.01).is_some()
}

/// By how much the rim turns at a vertex, degrees.
fn bend(mesh: &Tessellation, v: usize) -> f64 {
    let points = mesh.points();
    let rim: Vec<usize> = mesh
        .around(v)
        .iter()
        .filter(|&&(e, _)| mesh.faces_of(e).len() == 1)
        .map(|&(_, w)| w)
        .collect();
    match rim.as_slice() {
        &[a, b] => angle(unit(points[v] - points[a]), unit(points[b] - points[v])).to_degrees(),
        _ => 180.0,
    }
}

pub(super) fn mean_edge(mesh: &Tessellation) -> f64 {
    let edges = mesh.edges().len();
    (0..edges).map(|e| mesh.length(e)).sum::<f64>() / edges.max(1) as f64
}

/// The vertices on the rim, ring by ring, each ring in walking order.
fn ring_vertices(mesh: &Tessellation, rim: &[bool]) -> Vec<usize> {
    let mut seen = vec![false; mesh.points().len()];
    let mut out = Vec::new();
    for start in (0..rim.len())
        .filter(|&e| rim[e])
        .map(|e| mesh.edges()[e][0])
    {
        let mut at = Some(start).filter(|&v| !seen[v]);
        while let Some(v) = at {
            seen[v] = true;
            out.push(v);
            at = mesh
                .around(v)
                .iter()
                .find(|&&(e, w)| rim[e] && !seen[w])
                .map(|&(_, w)| w);
        }
    }
    out
}
