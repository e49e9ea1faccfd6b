//! The mesh read out of a triangulation: inside faces, borders by ring edge,
//! and the core put in.

use spade::Triangulation;

use super::core::{Core, NONE};
use super::lattice::Segment;
use super::mesh::{Border, Cdt, Mesh, BORDER};
use super::ring::Ring;
use crate::plane::V2;
use crate::FieldError;

/// What the triangulation was made from.
pub(super) struct Given<'a> {
    pub(super) points: &'a [V2],
    pub(super) segments: &'a [Segment],
    pub(super) rings: &'a [Ring],
    pub(super) core: &'a Core,
    /// Index of the first vertex on the core's rim.
    pub(super) rim_start: usize,
    pub(super) rim_edges: &'a [(u32, u32, u32, u32)],
}

impl Given<'_> {
    /// Position among the rim's edges of the one between two vertices, the
    /// core on its right.
    fn rim_edge(&self, from: usize, to: usize) -> Option<usize> {
        let on_rim = |v: usize| {
            let v = v.checked_sub(self.rim_start)?;
            (v < self.core.rim).then_some(v as u32)
        };
        let key = (on_rim(to)?, on_rim(from)?);
        self.rim_edges
            .binary_search_by_key(&key, |e| (e.0, e.1))
            .ok()
    }
}

/// Reads the triangles inside the rings out of the triangulation, and puts
/// the core in; `None` if an edge of its rim is missing.
pub(super) fn extract(
    cdt: &Cdt,
    scale: f64,
    given: &Given<'_>,
    line_of: &[u32],
) -> Result<Option<Mesh>, FieldError> {
    let known = given.points.len();
    let is_line = |edge: usize| line_of.get(edge).is_some_and(|&line| line != u32::MAX);
    let inside = inner_faces(cdt, is_line);
    let mut number = vec![u32::MAX; cdt.num_all_faces()];
    let mut vertex = vec![u32::MAX; cdt.num_vertices()];
    let mut original = Vec::new();
    let mut mesh = Mesh {
        points: Vec::new(),
        triangles: Vec::new(),
        neighbours: Vec::new(),
        borders: Vec::new(),
        line_edges: Vec::new(),
    };
    for face in cdt.inner_faces().filter(|face| inside[face.index()]) {
        number[face.index()] = mesh.triangles.len() as u32;
        mesh.triangles
            .push(face.vertices().map(|v| v.index() as u32));
    }
    // Vertices keep their order: rings first, then lattice, then refinement.
    for triangle in &mesh.triangles {
        for &v in triangle {
            vertex[v as usize] = 0;
        }
    }
    for v in cdt.vertices() {
        if vertex[v.index()] == u32::MAX {
            continue;
        }
        let p = v.position();
        vertex[v.index()] = original.len() as u32;
        original.push(v.index());
        // Ring points as given, to the bit.
        mesh.points.push(if v.index() < known {
            given.points[v.index()]
        } else {
            V2::new(p.x, p.y) * scale
        });
    }
    let band = mesh.triangles.len() as u32;
    let mut core_neighbours = given.core.neighbours.clone();
    core_neighbours
        .iter_mut()
        .flatten()
        .filter(|t| **t != NONE)
        .for_each(|t| *t += band);
    let mut rim_met = 0;
    for face in cdt.inner_faces().filter(|face| inside[face.index()]) {
        let mut neighbours = [u32::MAX; 3];
        for (k, edge) in face.adjacent_edges().into_iter().enumerate() {
            let across = edge.rev().face();
            neighbours[k] = match across.as_inner() {
                Some(inner)
                    if inside[inner.index()]
                        && (!edge.as_undirected().is_constraint_edge()
                            || is_line(edge.as_undirected().index())) =>
                {
                    number[inner.index()]
                }
                _ => {
                    let ends = [edge.from(), edge.to()].map(|v| v.index());
                    if let Some(rim) = given.rim_edge(ends[0], ends[1]) {
                        let (_, _, triangle, side) = given.rim_edges[rim];
                        core_neighbours[triangle as usize][side as usize] =
                            mesh.neighbours.len() as u32;
                        rim_met += 1;
                        neighbours[k] = band + triangle;
                        continue;
                    }
                    mesh.borders.push(Border {
                        from: vertex[edge.from().index()],
                        to: vertex[edge.to().index()],
                        ring: u32::MAX,
                        edge: u32::MAX,
                    });
                    BORDER | (mesh.borders.len() - 1) as u32
                }
            };
        }
        // `vertices` and `adjacent_edges` start at the same edge: the first
        // edge leaves the first vertex.
        let triangle = face.vertices();
        let edges = face.adjacent_edges();
        debug_assert!((0..3).all(|k| edges[k].from() == triangle[k]));
        mesh.neighbours.push(neighbours);
    }
    if rim_met != given.rim_edges.len() {
        return Ok(None);
    }
    for triangle in &mut mesh.triangles {
        *triangle = triangle.map(|v| vertex[v as usize]);
    }
    let within = mesh.points.len() as u32;
    let rim = given.core.rim as u32;
    mesh.points.extend(&given.core.points[given.core.rim..]);
    let core_triangles = given.core.triangles.iter().map(|triangle| {
        triangle.map(|v| {
            if v < rim {
                vertex[given.rim_start + v as usize]
            } else {
                within + v - rim
            }
        })
    });
    mesh.triangles.extend(core_triangles);
    mesh.neighbours.extend(core_neighbours);
    if mesh.triangles.is_empty() {
        return Err(FieldError::MeshFailed {
            what: "no triangle lies inside the polygon".into(),
        });
    }
    label(&mut mesh, &original, known, given.segments, given.rings);
    for (edge, &line) in cdt.undirected_edges().zip(line_of) {
        let [from, to] = edge.vertices().map(|v| vertex[v.index()]);
        // Across a hole that is thinner than points are told apart, a line
        // may have an edge outside.
        let sides = [edge.as_directed(), edge.as_directed().rev()];
        if line != u32::MAX && sides.iter().any(|side| inside[side.face().index()]) {
            mesh.line_edges.push((from, to, line));
        }
    }
    mesh.line_edges.sort_unstable_by_key(|e| (e.2, e.0, e.1));
    Ok(Some(mesh))
}

/// Which faces lie inside, by the parity of constraint edges crossed on the
/// way in from the outer face; those on constraint lines do not count.
fn inner_faces(cdt: &Cdt, is_line: impl Fn(usize) -> bool) -> Vec<bool> {
    let mut depth = vec![u32::MAX; cdt.num_all_faces()];
    // Breadth first by depth: faces behind a constraint edge wait a round.
    let mut now = vec![cdt.outer_face().fix()];
    let mut later = Vec::new();
    let mut level = 0_u32;
    depth[cdt.outer_face().index()] = 0;
    let mut hull: Vec<_> = cdt.convex_hull().map(|edge| edge.fix()).collect();
    loop {
        let mut edges: Vec<_> = std::mem::take(&mut hull);
        while let Some(face) = now.pop() {
            if let Some(inner) = cdt.face(face).as_inner() {
                edges.extend(inner.adjacent_edges().map(|edge| edge.fix()));
            }
            for fixed in edges.drain(..) {
                let edge = cdt.directed_edge(fixed);
                let across = edge.rev().face();
                if depth[across.index()] <= level {
                    continue;
                }
                let undirected = edge.as_undirected();
                if undirected.is_constraint_edge() && !is_line(undirected.index()) {
                    later.push(across.fix());
                } else {
                    depth[across.index()] = level;
                    now.push(across.fix());
                }
            }
        }
        level += 1;
        for face in later.drain(..) {
            if depth[face.index()] == u32::MAX {
                depth[face.index()] = level;
                now.push(face);
            }
        }
        if now.is_empty() {
            break;
        }
    }
    depth.iter().map(|d| d % 2 == 1).collect()
}

/// Names the ring edge that each border lies on.
///
/// A border belongs to the chain between two given points; points that
/// refinement put in between have one border in and one out.
fn label(mesh: &mut Mesh, original: &[usize], known: usize, segments: &[Segment], rings: &[Ring]) {
    let mut table: Vec<(u32, u32, u32, u32)> = segments
        .iter()
        .map(|s| (s.from, s.to, s.ring, s.edge))
        .collect();
    table.sort_unstable();
    let mut after = vec![u32::MAX; mesh.points.len()];
    for (index, border) in mesh.borders.iter().enumerate() {
        after[border.from as usize] = index as u32;
    }
    let given = |v: u32| original[v as usize] < known;
    let mut chain = Vec::new();
    for start in 0..mesh.borders.len() {
        if !given(mesh.borders[start].from) {
            continue;
        }
        chain.clear();
        chain.push(start);
        let mut last = start;
        while !given(mesh.borders[last].to) && chain.len() <= mesh.borders.len() {
            last = after[mesh.borders[last].to as usize] as usize;
            chain.push(last);
        }
        let from = original[mesh.borders[start].from as usize] as u32;
        let to = original[mesh.borders[last].to as usize] as u32;
        let found = table.partition_point(|s| (s.0, s.1) < (from, to));
        let name = match table.get(found) {
            Some(&(f, t, ring, edge)) if (f, t) == (from, to) => (ring, edge),
            // A ring touches another in the middle of an edge, which splits
            // the segment: rare enough for a search through all edges.
            _ => {
                let middle = (mesh.points[mesh.borders[start].from as usize]
                    + mesh.points[mesh.borders[start].to as usize])
                    / 2.0;
                nearest_edge(rings, middle)
            }
        };
        for &border in &chain {
            (mesh.borders[border].ring, mesh.borders[border].edge) = name;
        }
    }
}

/// Ring and edge nearest to `p`, by trying all.
fn nearest_edge(rings: &[Ring], p: V2) -> (u32, u32) {
    let mut best = (f64::INFINITY, (0, 0));
    for (index, ring) in rings.iter().enumerate() {
        for k in 0..ring.len() {
            let (a, b) = ring.edge(k);
            let distance = crate::plane::segment_distance_squared(p, a, b);
            if distance < best.0 {
                best = (distance, (index as u32, k as u32));
            }
        }
    }
    best.1
}
