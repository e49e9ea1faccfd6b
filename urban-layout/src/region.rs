//! A face of the street network as the splitters see it.

use geo_types::{Coord, LineString, Polygon};
use network_opt::{FaceId, HalfEdgeId, VertexId};

use crate::network::{Network, Side, SideKind};
use crate::plane::{dist, lerp, nearest_on, signed_area, turn, unit};
use crate::planner::seed::Path;
use crate::segments::SegmentGrid;

/// A region to be split or filled: one face of the network with its sides.
#[derive(Clone, Debug)]
pub struct Region {
    /// The face.
    pub face: FaceId,
    /// Its place in the split tree.
    pub path: Path,
    /// The start of its random stream.
    pub seed: u64,
    /// Its boundary, outer loop first; the land lies on the left.
    pub loops: Vec<Loop>,
    /// Area, square metres.
    pub area: f64,
}

/// A boundary loop of a region.
#[derive(Clone, Debug)]
pub struct Loop {
    /// The half-edges in walking order.
    pub half_edges: Vec<HalfEdgeId>,
    /// Where each half-edge starts.
    pub points: Vec<Coord<f64>>,
    /// What each edge is to this region.
    pub sides: Vec<Side>,
    /// The vertex at which each half-edge starts.
    pub vertices: Vec<VertexId>,
    /// Arc length up to each vertex; one more entry, the total.
    pub lengths: Vec<f64>,
    /// For each edge, whether the region lies on its other side too: a street
    /// that ends in the open, or that leads to a hole.
    pub slits: Vec<bool>,
    /// Vertices that a new street's end must keep away from.
    pub nodes: Vec<Node>,
}

/// A junction or a sharp corner on a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Arc length along the loop.
    pub position: f64,
    /// The vertex.
    pub vertex: VertexId,
    /// Where it lies.
    pub at: Coord<f64>,
    /// The direction of the one street that arrives here from the other side,
    /// pointing into this region: a new street may continue it.
    pub continues: Option<Coord<f64>>,
    /// Whether streets meet here (else it is a corner of the outline).
    pub junction: bool,
}

/// A point on a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Which loop.
    pub ring: usize,
    /// Which of its edges.
    pub edge: usize,
    /// The point.
    pub at: Coord<f64>,
}

/// A turn beyond this makes a corner of a region's outline, degrees.
const CORNER_DEG: f64 = 30.0;

impl Region {
    /// The view of `face`.
    #[must_use]
    pub fn new(network: &Network, face: FaceId, path: Path, seed: u64) -> Self {
        let mesh = &network.mesh;
        let loops: Vec<Loop> = mesh
            .loops(face)
            .into_iter()
            .map(|start| {
                let half_edges: Vec<HalfEdgeId> = mesh.walk(start).collect();
                let vertices: Vec<VertexId> = half_edges.iter().map(|&h| mesh.origin(h)).collect();
                let points: Vec<Coord<f64>> = vertices.iter().map(|&v| mesh.point(v)).collect();
                let sides: Vec<Side> = half_edges.iter().map(|&h| *mesh.attr(h)).collect();
                let n = points.len();
                let mut lengths = vec![0.0];
                for i in 0..n {
                    lengths.push(lengths[i] + dist(points[i], points[(i + 1) % n]));
                }
                let slits = half_edges
                    .iter()
                    .map(|&h| mesh.face(mesh.twin(h)) == face)
                    .collect();
                let mut out = Loop {
                    half_edges,
                    points,
                    sides,
                    vertices,
                    lengths,
                    slits,
                    nodes: Vec::new(),
                };
                out.nodes = nodes(network, face, &out);
                out
            })
            .collect();
        let area = loops.iter().map(|l| signed_area(&l.points)).sum();
        let seed = path.hash(seed);
        Self {
            face,
            path,
            seed,
            loops,
            area,
        }
    }

    /// The region as a polygon; edge `i` of ring `r` is edge `i` of loop `r`.
    #[must_use]
    pub fn polygon(&self) -> Polygon<f64> {
        let close = |l: &Loop| {
            let mut points = l.points.clone();
            points.extend(l.points.first().copied());
            LineString(points)
        };
        let mut rings = self.loops.iter().map(close);
        let outer = rings.next().unwrap_or_else(|| LineString(Vec::new()));
        Polygon::new(outer, rings.collect())
    }

    /// All edges with their sides, loop by loop.
    pub fn edges(&self) -> impl Iterator<Item = (Coord<f64>, Coord<f64>, &Side)> + '_ {
        self.loops.iter().flat_map(|l| {
            let n = l.points.len();
            (0..n).map(move |i| (l.points[i], l.points[(i + 1) % n], &l.sides[i]))
        })
    }

    /// An index of [`Region::edges`], and the side of each.
    pub(crate) fn grid(&self) -> (SegmentGrid, Vec<Side>) {
        let (segments, sides) = self.edges().map(|(a, b, &side)| ((a, b), side)).unzip();
        (SegmentGrid::new(segments), sides)
    }

    /// Whether a street lies inside, both its sides the region's.
    #[must_use]
    pub fn has_slits(&self) -> bool {
        self.loops.iter().any(|l| l.slits.contains(&true))
    }

    /// The place of the boundary nearest to `p`, on the side of it that faces
    /// `towards`.
    #[must_use]
    pub fn place_facing(&self, p: Coord<f64>, towards: Coord<f64>) -> Place {
        let mut best = (
            f64::INFINITY,
            Place {
                ring: 0,
                edge: 0,
                at: p,
            },
        );
        for (ring, l) in self.loops.iter().enumerate() {
            for edge in 0..l.points.len() {
                let (a, b) = l.edge(edge);
                let at = nearest_on(a, b, p).0;
                let behind = if crate::plane::cross(b - a, towards - at) > 0.0 {
                    0.0
                } else {
                    1e-6
                };
                if dist(at, p) + behind < best.0 {
                    best = (dist(at, p) + behind, Place { ring, edge, at });
                }
            }
        }
        best.1
    }

    /// Places along all sides, at most `spacing` metres apart, ring by ring.
    pub(crate) fn places(&self, spacing: f64) -> Vec<Place> {
        let mut out = Vec::new();
        for (ring, l) in self.loops.iter().enumerate() {
            for edge in 0..l.points.len() {
                let (a, b) = l.edge(edge);
                let n = (dist(a, b) / spacing).ceil().max(1.0) as usize;
                out.extend((0..n).map(|k| Place {
                    ring,
                    edge,
                    at: lerp(a, b, (k as f64 + 0.5) / n as f64),
                }));
            }
        }
        out
    }

    /// Whether any side gives parcels access.
    #[must_use]
    pub fn has_access(&self) -> bool {
        self.edges().any(|(_, _, side)| side.access)
    }

    /// Length of all loops, metres.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        self.loops.iter().filter_map(|l| l.lengths.last()).sum()
    }

    /// The long side of the rectangle of the same area and perimeter, metres.
    #[must_use]
    pub fn rectangle_length(&self) -> f64 {
        let half = 0.5
            * self
                .loops
                .first()
                .and_then(|l| l.lengths.last())
                .copied()
                .unwrap_or(0.0);
        0.5 * (half + (half * half - 4.0 * self.area).max(0.0).sqrt())
    }
}

impl Loop {
    /// Total length, metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// Arc length of a point on edge `edge`.
    #[must_use]
    pub fn position(&self, edge: usize, at: Coord<f64>) -> f64 {
        self.lengths[edge] + dist(self.points[edge], at)
    }

    /// Distance along the loop between two positions, the shorter way.
    #[must_use]
    pub fn between(&self, a: f64, b: f64) -> f64 {
        let d = (a - b).abs();
        d.min(self.length() - d)
    }

    /// The edge and point at an arc length (any real number, taken around).
    #[must_use]
    pub fn at(&self, position: f64) -> (usize, Coord<f64>) {
        let s = position.rem_euclid(self.length().max(f64::MIN_POSITIVE));
        let edge = self
            .lengths
            .partition_point(|&l| l <= s)
            .saturating_sub(1)
            .min(self.points.len() - 1);
        let (a, b) = self.edge(edge);
        let d = dist(a, b);
        (
            edge,
            lerp(
                a,
                b,
                if d > 0.0 {
                    ((s - self.lengths[edge]) / d).clamp(0.0, 1.0)
                } else {
                    0.0
                },
            ),
        )
    }

    /// The two ends of an edge.
    #[must_use]
    pub fn edge(&self, edge: usize) -> (Coord<f64>, Coord<f64>) {
        (
            self.points[edge],
            self.points[(edge + 1) % self.points.len()],
        )
    }

    /// The nearest point of the loop, as arc length, edge and point.
    #[must_use]
    pub fn nearest(&self, p: Coord<f64>) -> (f64, usize, Coord<f64>) {
        let mut best = (f64::INFINITY, 0, p);
        for edge in 0..self.points.len() {
            let (a, b) = self.edge(edge);
            let q = nearest_on(a, b, p).0;
            if dist(p, q) < best.0 {
                best = (dist(p, q), edge, q);
            }
        }
        (self.position(best.1, best.2), best.1, best.2)
    }
}

/// The junctions and sharp corners of a loop.
fn nodes(network: &Network, face: FaceId, l: &Loop) -> Vec<Node> {
    let mesh = &network.mesh;
    let n = l.points.len();
    let mut out = Vec::new();
    for i in 0..n {
        let h = l.half_edges[i];
        let v = l.vertices[i];
        let streets = network.streets_at(v);
        let at = l.points[i];
        let (before, after) = (
            unit(at - l.points[(i + n - 1) % n]),
            unit(l.points[(i + 1) % n] - at),
        );
        let corner = turn(before, after).abs() > CORNER_DEG.to_radians();
        let boundary = l.sides[i].kind != SideKind::Street
            || l.sides[(i + n - 1) % n].kind != SideKind::Street;
        let junction = streets.len() >= 3
            || (boundary
                && !streets.is_empty()
                && streets
                    .iter()
                    .any(|&s| mesh.face(s) != face && mesh.face(mesh.twin(s)) != face));
        let turns_street = boundary
            && streets
                .iter()
                .any(|&s| s == h || mesh.twin(s) == l.half_edges[(i + n - 1) % n]);
        if !(corner || junction || turns_street) {
            continue;
        }
        // A lone street on the far side of a straight stretch can be continued.
        let far: Vec<HalfEdgeId> = streets
            .iter()
            .copied()
            .filter(|&s| mesh.face(s) != face && mesh.face(mesh.twin(s)) != face)
            .collect();
        let continues = match far.as_slice() {
            [one] if !corner && streets.len() == 3 => Some(unit(at - mesh.point(mesh.dest(*one)))),
            _ => None,
        };
        out.push(Node {
            position: l.lengths[i],
            vertex: v,
            at,
            continues,
            junction,
        });
    }
    out
}
