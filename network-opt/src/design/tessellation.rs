//! The mesh whose edges are the candidates for streets or corridors.

use geo_types::Coord;

use crate::error::DesignError;

/// A polygonal mesh: its edges may become streets, its vertices are what they
/// have to cover. Usually quads; any polygons will do (the paper's future
/// work: quads and triangles mixed).
///
/// Vertices, edges and faces are numbered from 0.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tessellation {
    points: Vec<Coord<f64>>,
    faces: Vec<Vec<usize>>,
    edges: Vec<[usize; 2]>,
    /// The edges of each face, edge `k` from corner `k` to the next.
    face_edges: Vec<Vec<usize>>,
    /// The faces beside each edge: one or two.
    edge_faces: Vec<Vec<usize>>,
    /// The edges at each vertex with their other ends, counter-clockwise.
    around: Vec<Vec<(usize, usize)>>,
}

impl Tessellation {
    /// A mesh of these faces, each a loop of at least three different
    /// vertices, counter-clockwise. Edges are numbered as the faces meet them.
    ///
    /// # Errors
    ///
    /// [`DesignError::BadMesh`] for a coordinate that is not finite, a vertex
    /// that does not exist or comes twice in a face, a face with less than three corners,
    /// and an edge with over two faces or two on the same side.
    ///
    /// # Examples
    ///
    /// ```
    /// use network_opt::design::Tessellation;
    /// use network_opt::geo_types::coord;
    ///
    /// let points = (0..6).map(|k| coord! { x: f64::from(k % 3), y: f64::from(k / 3) }).collect();
    /// let mesh = Tessellation::new(points, vec![vec![0, 1, 4, 3], vec![1, 2, 5, 4]])?;
    /// assert_eq!(mesh.edges().len(), 7);
    /// assert_eq!(mesh.rim().filter(|&on_rim| on_rim).count(), 6);
    /// # Ok::<(), network_opt::DesignError>(())
    /// ```
    pub fn new(points: Vec<Coord<f64>>, faces: Vec<Vec<usize>>) -> Result<Self, DesignError> {
        let mut edges: Vec<[usize; 2]> = Vec::new();
        let mut known = std::collections::BTreeMap::new();
        for face in &faces {
            for (a, b) in sides(face) {
                let ends = [a.min(b), a.max(b)];
                known.entry(ends).or_insert_with(|| {
                    edges.push(ends);
                    edges.len() - 1
                });
            }
        }
        Self::with_edges(points, faces, edges)
    }

    /// A mesh with its edges numbered as given; they must be those of the
    /// faces, each once.
    ///
    /// # Errors
    ///
    /// As [`Tessellation::new`], and for edges that are not those of the faces.
    pub fn with_edges(
        points: Vec<Coord<f64>>,
        faces: Vec<Vec<usize>>,
        edges: Vec<[usize; 2]>,
    ) -> Result<Self, DesignError> {
        let bad = |what: String| Err(DesignError::BadMesh { what });
        if let Some(k) = points
            .iter()
            .position(|p| !(p.x.is_finite() && p.y.is_finite()))
        {
            return bad(format!("vertex {k} is not finite"));
        }
        let mut known = std::collections::BTreeMap::new();
        for (k, &[a, b]) in edges.iter().enumerate() {
            if a == b || a.max(b) >= points.len() {
                return bad(format!(
                    "edge {k} joins {a} and {b}, of {} vertices",
                    points.len()
                ));
            }
            if known.insert([a.min(b), a.max(b)], k).is_some() {
                return bad(format!("edge {k}, from {a} to {b}, comes twice"));
            }
        }
        let mut edge_faces: Vec<Vec<usize>> = vec![Vec::new(); edges.len()];
        let mut leaves = std::collections::BTreeSet::new();
        let mut face_edges = Vec::with_capacity(faces.len());
        for (f, face) in faces.iter().enumerate() {
            if face.len() < 3 {
                return bad(format!("face {f} has {} corners", face.len()));
            }
            let mut own = Vec::with_capacity(face.len());
            for (k, (a, b)) in sides(face).enumerate() {
                if face[..k].contains(&a) {
                    return bad(format!("face {f} meets vertex {a} twice"));
                }
                let Some(&edge) = known.get(&[a.min(b), a.max(b)]) else {
                    return bad(format!(
                        "face {f} has a side from {a} to {b}, which is no edge"
                    ));
                };
                if !leaves.insert((a, b)) {
                    return bad(format!(
                        "two faces have a side from {a} to {b}; turn all of them counter-clockwise"
                    ));
                }
                edge_faces[edge].push(f);
                own.push(edge);
            }
            face_edges.push(own);
        }
        if let Some(k) = edge_faces.iter().position(Vec::is_empty) {
            return bad(format!("edge {k} belongs to no face"));
        }
        let mut around: Vec<Vec<(usize, usize)>> = vec![Vec::new(); points.len()];
        for (k, &[a, b]) in edges.iter().enumerate() {
            around[a].push((k, b));
            around[b].push((k, a));
        }
        for (v, around) in around.iter_mut().enumerate() {
            let bearing = |w: usize| {
                let way = points[w] - points[v];
                way.y.atan2(way.x)
            };
            around.sort_by(|a, b| bearing(a.1).total_cmp(&bearing(b.1)));
        }
        Ok(Self {
            points,
            faces,
            edges,
            face_edges,
            edge_faces,
            around,
        })
    }

    /// The positions of the vertices.
    #[must_use]
    pub fn points(&self) -> &[Coord<f64>] {
        &self.points
    }

    /// The corners of each face, counter-clockwise.
    #[must_use]
    pub fn faces(&self) -> &[Vec<usize>] {
        &self.faces
    }

    /// The two ends of each edge.
    #[must_use]
    pub fn edges(&self) -> &[[usize; 2]] {
        &self.edges
    }

    /// The edges of face `f`, in the order of its corners.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[must_use]
    pub fn edges_of(&self, f: usize) -> &[usize] {
        &self.face_edges[f]
    }

    /// The one or two faces beside edge `e`.
    ///
    /// # Panics
    ///
    /// If there is no such edge.
    #[must_use]
    pub fn faces_of(&self, e: usize) -> &[usize] {
        &self.edge_faces[e]
    }

    /// The edges at vertex `v`, counter-clockwise, each with its other end.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn around(&self, v: usize) -> &[(usize, usize)] {
        &self.around[v]
    }

    /// Whether each edge lies on the boundary.
    pub fn rim(&self) -> impl Iterator<Item = bool> + '_ {
        self.edge_faces.iter().map(|faces| faces.len() == 1)
    }

    /// Length of edge `e`.
    ///
    /// # Panics
    ///
    /// If there is no such edge.
    #[must_use]
    pub fn length(&self, e: usize) -> f64 {
        let [a, b] = self.edges[e].map(|v| self.points[v]);
        (a.x - b.x).hypot(a.y - b.y)
    }

    /// The edge between two vertices.
    #[must_use]
    pub fn edge_between(&self, a: usize, b: usize) -> Option<usize> {
        let around = self.around.get(a)?;
        around.iter().find(|&&(_, w)| w == b).map(|&(e, _)| e)
    }

    /// All vertices within `hops` edges of vertex `v`, itself first.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn ball(&self, v: usize, hops: usize) -> Vec<usize> {
        let mut ball = vec![v];
        let mut last = 0..1;
        for _ in 0..hops {
            for at in last.clone() {
                for &(_, w) in &self.around[ball[at]] {
                    if !ball.contains(&w) {
                        ball.push(w);
                    }
                }
            }
            last = last.end..ball.len();
        }
        ball
    }

    /// All vertices within `metres` of vertex `v` along edges, itself first.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn within(&self, v: usize, metres: f64) -> Vec<usize> {
        let mut found = vec![v];
        let mut away = vec![0.0];
        // Few vertices: what is reached anew, or by a shorter way, waits to be
        // gone on from.
        let mut waiting = std::collections::VecDeque::from([0]);
        while let Some(at) = waiting.pop_front() {
            for &(e, w) in &self.around[found[at]] {
                let there = away[at] + self.length(e);
                if there > metres {
                    continue;
                }
                match found.iter().position(|&known| known == w) {
                    Some(k) if there < away[k] => {
                        away[k] = there;
                        waiting.push_back(k);
                    }
                    Some(_) => {}
                    None => {
                        waiting.push_back(found.len());
                        found.push(w);
                        away.push(there);
                    }
                }
            }
        }
        found
    }

    /// The mesh of the next level: every face cut from its middle to the
    /// middles of its sides (the topology of Catmull and Clark's subdivision,
    /// vertices staying where they are, as the paper's section 5.1 has it).
    /// Quads become four quads each.
    ///
    /// Vertices keep their numbers; the middle of edge `e` is vertex
    /// `points().len() + e`, that of face `f` follows after those of all
    /// edges. Edge `e` becomes the edges `2 e` and `2 e + 1`, from its first
    /// end on.
    #[must_use]
    pub fn refined(&self) -> Self {
        let (vertices, edges) = (self.points.len(), self.edges.len());
        let mut points = self.points.clone();
        let middle = |of: &[usize]| {
            let sum = of
                .iter()
                .fold(Coord::zero(), |sum, &v| sum + self.points[v]);
            sum / of.len() as f64
        };
        points.extend(self.edges.iter().map(|ends| middle(ends)));
        points.extend(self.faces.iter().map(|face| middle(face)));
        let mut halves: Vec<[usize; 2]> = Vec::with_capacity(2 * edges + 4 * self.faces.len());
        for (e, &[a, b]) in self.edges.iter().enumerate() {
            halves.extend([[a, vertices + e], [vertices + e, b]]);
        }
        let mut faces = Vec::new();
        for (f, (face, own)) in self.faces.iter().zip(&self.face_edges).enumerate() {
            let centre = vertices + edges + f;
            halves.extend(own.iter().map(|&e| [vertices + e, centre]));
            for k in 0..face.len() {
                let before = own[(k + own.len() - 1) % own.len()];
                faces.push(vec![face[k], vertices + own[k], centre, vertices + before]);
            }
        }
        Self::with_edges(points, faces, halves).unwrap_or_else(|_| self.clone())
    }

    /// The two edges of each quad that lie opposite each other, by pairs: what
    /// the paper calls too close when both are active.
    #[must_use]
    pub fn opposite_edges(&self) -> Vec<[usize; 2]> {
        let quads = self.face_edges.iter().filter(|edges| edges.len() == 4);
        quads.flat_map(|e| [[e[0], e[2]], [e[1], e[3]]]).collect()
    }

    /// Paths of three edges that turn one way and then the other, S and Z of
    /// each inner edge between two quads: along the sides of its two faces.
    #[must_use]
    pub fn zig_zags(&self) -> Vec<[usize; 3]> {
        let mut found = Vec::new();
        for (e, faces) in self.edge_faces.iter().enumerate() {
            let &[f, g] = faces.as_slice() else {
                continue;
            };
            let side = |face: usize, step: usize| {
                let own = &self.face_edges[face];
                let at = own.iter().position(|&k| k == e)?;
                Some(own[(at + own.len() + step - 1) % own.len()])
            };
            // Both faces see the edge counter-clockwise: what follows it in the
            // one and in the other are at its two ends, on its two sides.
            for step in [2, 0] {
                if let (Some(a), Some(b)) = (side(f, step), side(g, step)) {
                    found.push([e, a, b]);
                }
            }
        }
        found
    }
}

/// Pairs of consecutive corners.
fn sides(face: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..face.len()).map(|k| (face[k], face[(k + 1) % face.len()]))
}

#[cfg(test)]
impl Tessellation {
    /// A grid of unit squares.
    pub(crate) fn grid(columns: usize, rows: usize) -> Self {
        let wide = columns + 1;
        let points = (0..wide * (rows + 1)).map(|k| Coord {
            x: (k % wide) as f64,
            y: (k / wide) as f64,
        });
        let faces = (0..columns * rows).map(|k| {
            let a = k / columns * wide + k % columns;
            vec![a, a + 1, a + wide + 1, a + wide]
        });
        Self::new(points.collect(), faces.collect()).expect("a grid")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    #[test]
    fn a_grid_is_counted_right() {
        let mesh = Tessellation::grid(4, 3);
        assert_eq!((mesh.points().len(), mesh.faces().len()), (20, 12));
        assert_eq!(mesh.edges().len(), 4 * 4 + 3 * 5);
        assert_eq!(mesh.rim().filter(|&r| r).count(), 14);
        assert_eq!(mesh.opposite_edges().len(), 24);
        // S and Z for each of the 31 - 14 inner edges.
        assert_eq!(mesh.zig_zags().len(), 34);
        // Within two steps of an inner vertex lie 13 of an endless grid.
        assert_eq!(Tessellation::grid(6, 6).ball(24, 2).len(), 13);
        assert_eq!(mesh.around(6).len(), 4);
        assert_eq!(mesh.edge_between(0, 6), None);
    }

    /// A long way that a shorter one follows: around a flat square.
    #[test]
    fn reach_is_by_the_shortest_way() {
        let mesh = Tessellation::grid(6, 6);
        let (mut a, mut b) = (mesh.within(24, 2.5), mesh.ball(24, 2));
        a.sort_unstable();
        b.sort_unstable();
        assert_eq!(a, b);
        // Vertex 2 is two edges and 16 from vertex 0 over 1, but four edges and 9
        // along 4, 5 and 3; vertex 1 itself is at 9.9.
        let points = [(0., 0.), (7., 7.), (8., 1.), (8., 0.), (3., 0.), (6., 0.)];
        let faces = vec![vec![0, 4, 1], vec![4, 5, 3, 2, 1]];
        let flat = Tessellation::new(points.map(|(x, y)| coord! { x: x, y: y }).to_vec(), faces)
            .expect("a mesh");
        let mut near = flat.within(0, 9.95);
        near.sort_unstable();
        assert_eq!(near, [0, 1, 2, 3, 4, 5]);
        assert_eq!(flat.within(0, 8.5).len(), 4);
        assert_eq!(flat.within(0, 0.0), [0]);
    }

    #[test]
    fn the_next_level_has_four_quads_for_one() {
        let mesh = Tessellation::grid(3, 2);
        let fine = mesh.refined();
        assert_eq!(fine.faces().len(), 24);
        assert_eq!(fine.edges().len(), 6 * 5 + 7 * 4);
        assert_eq!(&fine.points()[..12], mesh.points());
        for (e, &[a, b]) in mesh.edges().iter().enumerate() {
            assert_eq!(fine.edges()[2 * e], [a, 12 + e]);
            assert_eq!(fine.edges()[2 * e + 1], [12 + e, b]);
        }
        let total = |m: &Tessellation| (0..m.edges().len()).map(|e| m.length(e)).sum::<f64>();
        assert!((total(&fine) - (4.0 * 7.0 + 6.0 * 5.0) / 2.0 - 0.0).abs() < 1e-12);
    }

    /// Each zig-zag is a path whose ends lie on different sides of its middle.
    #[test]
    fn zig_zags_turn_both_ways() {
        let mesh = Tessellation::grid(3, 3);
        for [e, a, b] in mesh.zig_zags() {
            let [p, q] = mesh.edges()[e];
            let other = |k: usize, v: usize| {
                let [x, y] = mesh.edges()[k];
                [x, y].contains(&v).then_some(if x == v { y } else { x })
            };
            let (i, j) = match (other(a, p), other(b, q)) {
                (Some(i), Some(j)) => (i, j),
                _ => (other(b, p).expect("a path"), other(a, q).expect("a path")),
            };
            let point = |v: usize| mesh.points()[v];
            let side = |v: usize| {
                let (along, to) = (point(q) - point(p), point(v) - point(p));
                along.x * to.y - along.y * to.x
            };
            assert!(side(i) * side(j) < 0.0, "{e} {a} {b}");
        }
    }

    #[test]
    fn bad_meshes_are_named() {
        let points = vec![
            coord! { x: 0., y: 0. },
            coord! { x: 1., y: 0. },
            coord! { x: 0., y: 1. },
        ];
        let error = |faces: Vec<Vec<usize>>| {
            Tessellation::new(points.clone(), faces)
                .expect_err("bad")
                .to_string()
        };
        assert!(error(vec![vec![0, 1, 3]]).contains("joins"));
        assert!(error(vec![vec![0, 1]]).contains("2 corners"));
        assert!(error(vec![vec![0, 1, 2], vec![0, 1, 2]]).contains("counter-clockwise"));
        assert!(error(vec![vec![0, 1, 2, 1]]).contains("twice"));
    }
}
