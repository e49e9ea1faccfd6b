//! A triangulation with its edges, and what can be wrong with one.

use crate::vector::{cross, is_finite, norm, Point};

/// Why points, triangles and vectors do not make a
/// [`TriangleField`](crate::TriangleField).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no triangle.
    #[error("the mesh has no triangle: give at least one")]
    Empty,
    /// The lists of points and of vectors differ in length.
    #[error("{points} points but {vectors} representation vectors: give one vector per point")]
    Counts {
        /// Number of points.
        points: usize,
        /// Number of representation vectors.
        vectors: usize,
    },
    /// A point or its vector has a coordinate that is NaN or infinite.
    #[error("vertex {vertex} has a point or a vector that is not finite: repair it")]
    NotFinite {
        /// Position in the list of points.
        vertex: usize,
    },
    /// A triangle names a point that does not exist.
    #[error("triangle {triangle} names vertex {vertex}, which does not exist: indices start at 0")]
    NoSuchVertex {
        /// Position in the list of triangles.
        triangle: usize,
        /// The index that was given.
        vertex: usize,
    },
    /// A triangle has no area, to rounding.
    #[error("triangle {triangle} is flat: remove it, or move one of its points")]
    Flat {
        /// Position in the list of triangles.
        triangle: usize,
    },
    /// Two triangles lie on the same side of an edge: they overlap.
    #[error("triangles {first} and {second} overlap next to the edge from vertex {a} to {b}: remove one")]
    Overlap {
        /// The lower triangle.
        first: usize,
        /// The higher triangle.
        second: usize,
        /// The lower vertex of the edge.
        a: usize,
        /// The higher vertex of the edge.
        b: usize,
    },
}

/// Stands for the triangle that a border edge lacks.
pub(crate) const NONE: usize = usize::MAX;

/// An edge from its lower vertex `a` to its higher `b`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MeshEdge {
    pub(crate) a: usize,
    pub(crate) b: usize,
    /// The triangles to its left and right, [`NONE`] beyond the border.
    pub(crate) sides: [usize; 2],
}

/// Points, counterclockwise triangles, edges. Local edge `i` of a triangle
/// runs from its vertex `i` to the next.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    pub(crate) points: Vec<Point>,
    /// Fourfold angle and strength of the cross; zero at a singularity.
    pub(crate) vectors: Vec<Point>,
    pub(crate) triangles: Vec<[usize; 3]>,
    pub(crate) edges: Vec<MeshEdge>,
    /// The edges of each triangle, by local edge.
    pub(crate) edges_of: Vec<[usize; 3]>,
}

impl Mesh {
    pub(crate) fn new(
        points: Vec<Point>,
        vectors: Vec<Point>,
        mut triangles: Vec<[usize; 3]>,
    ) -> Result<Self, MeshError> {
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        if points.len() != vectors.len() {
            return Err(MeshError::Counts {
                points: points.len(),
                vectors: vectors.len(),
            });
        }
        if let Some(vertex) =
            (0..points.len()).find(|&v| !is_finite(points[v]) || !is_finite(vectors[v]))
        {
            return Err(MeshError::NotFinite { vertex });
        }
        for (triangle, corners) in triangles.iter_mut().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v >= points.len()) {
                return Err(MeshError::NoSuchVertex { triangle, vertex });
            }
            let [a, b, c] = corners.map(|v| points[v]);
            let area = cross(b - a, c - a);
            let longest = norm(b - a).max(norm(c - b)).max(norm(a - c));
            // Height over the longest side below what rounding of map
            // coordinates leaves of it.
            let blur = 1e-12 * longest + 1e-15 * (a.x.abs() + a.y.abs());
            if area.is_nan() || area.abs() <= blur * longest {
                return Err(MeshError::Flat { triangle });
            }
            if area < 0.0 {
                corners.swap(1, 2);
            }
        }
        let (edges, edges_of) = connect(&triangles)?;
        Ok(Self {
            points,
            vectors,
            triangles,
            edges,
            edges_of,
        })
    }

    /// The vector along local edge `local` of a triangle.
    pub(crate) fn along(&self, triangle: usize, local: usize) -> Point {
        let corners = self.triangles[triangle];
        self.points[corners[(local + 1) % 3]] - self.points[corners[local]]
    }

    /// The triangle on the other side of an edge, or [`NONE`].
    pub(crate) fn beyond(&self, edge: usize, triangle: usize) -> usize {
        let sides = self.edges[edge].sides;
        if sides[0] == triangle {
            sides[1]
        } else {
            sides[0]
        }
    }

    /// The border as rings of vertices, the domain to the left, each from its
    /// lowest vertex on; the largest ring first, then by lowest vertex.
    pub(crate) fn rings(&self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.edges.len()];
        let mut rings = Vec::new();
        for first in 0..self.edges.len() {
            if seen[first] || !self.edges[first].sides.contains(&NONE) {
                continue;
            }
            let mut ring = Vec::new();
            let mut edge = first;
            while !seen[edge] {
                seen[edge] = true;
                let side = self.edges[edge].sides;
                let mut triangle = if side[0] == NONE { side[1] } else { side[0] };
                let mut local = self.local(triangle, edge);
                ring.push(self.triangles[triangle][local]);
                // Around the vertex where the edge ends, through its triangles.
                loop {
                    local = (local + 1) % 3;
                    edge = self.edges_of[triangle][local];
                    let next = self.beyond(edge, triangle);
                    if next == NONE {
                        break;
                    }
                    local = self.local(next, edge);
                    triangle = next;
                }
            }
            let lowest = (0..ring.len()).min_by_key(|&i| ring[i]).unwrap_or(0);
            ring.rotate_left(lowest);
            rings.push(ring);
        }
        let area = |ring: &[usize]| -> f64 {
            let origin = self.points[ring[0]];
            let next = ring.iter().cycle().skip(1);
            ring.iter()
                .zip(next)
                .map(|(&u, &v)| cross(self.points[u] - origin, self.points[v] - origin))
                .sum()
        };
        rings.sort();
        let outer = (0..rings.len())
            .max_by(|&i, &j| area(&rings[i]).total_cmp(&area(&rings[j])).then(j.cmp(&i)));
        rings[..=outer.unwrap_or(0)].rotate_right(1);
        rings
    }

    /// Which local edge of the triangle `edge` is; it must be one of them.
    pub(crate) fn local(&self, triangle: usize, edge: usize) -> usize {
        let of = self.edges_of[triangle];
        usize::from(of[1] == edge) + 2 * usize::from(of[2] == edge)
    }
}

type Edges = (Vec<MeshEdge>, Vec<[usize; 3]>);

/// Edges of counterclockwise triangles, ordered by their vertices.
fn connect(triangles: &[[usize; 3]]) -> Result<Edges, MeshError> {
    let mut halves = Vec::with_capacity(3 * triangles.len());
    for (triangle, corners) in triangles.iter().enumerate() {
        for local in 0..3 {
            let (from, to) = (corners[local], corners[(local + 1) % 3]);
            halves.push((
                from.min(to),
                from.max(to),
                usize::from(from > to),
                triangle,
                local,
            ));
        }
    }
    halves.sort_unstable();
    let mut edges: Vec<MeshEdge> = Vec::with_capacity(halves.len() / 2 + 1);
    let mut edges_of = vec![[0; 3]; triangles.len()];
    for (a, b, side, triangle, local) in halves {
        if edges.last().is_none_or(|e| (e.a, e.b) != (a, b)) {
            edges.push(MeshEdge {
                a,
                b,
                sides: [NONE; 2],
            });
        }
        let index = edges.len() - 1;
        let slot = &mut edges[index].sides[side];
        if *slot != NONE {
            let (first, second) = (*slot, triangle);
            return Err(MeshError::Overlap {
                first,
                second,
                a,
                b,
            });
        }
        *slot = triangle;
        edges_of[triangle][local] = index;
    }
    Ok((edges, edges_of))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::point;

    fn mesh(points: &[(f64, f64)], triangles: &[[usize; 3]]) -> Result<Mesh, MeshError> {
        Mesh::new(
            points.iter().map(|p| point(p.0, p.1)).collect(),
            vec![point(1.0, 0.0); points.len()],
            triangles.to_vec(),
        )
    }

    const SQUARE: [(f64, f64); 4] = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)];

    #[test]
    fn a_square_of_two_triangles() {
        let m = mesh(&SQUARE, &[[0, 1, 2], [0, 3, 2]]).unwrap();
        assert_eq!(m.triangles[1], [0, 2, 3], "made counterclockwise");
        assert_eq!(m.edges.len(), 5);
        let diagonal = m.edges.iter().position(|e| (e.a, e.b) == (0, 2)).unwrap();
        assert_eq!(m.edges[diagonal].sides, [1, 0]);
        assert_eq!(m.rings(), vec![vec![0, 1, 2, 3]]);
    }

    #[test]
    fn rings_of_a_frame_and_of_a_bow_tie() {
        let frame = [
            (1., 1.),
            (2., 1.),
            (2., 2.),
            (1., 2.),
            (0., 0.),
            (3., 0.),
            (3., 3.),
            (0., 3.),
        ];
        let strips: Vec<[usize; 3]> = (0..4)
            .flat_map(|i| {
                let j = (i + 1) % 4;
                [[4 + i, 4 + j, j], [4 + i, j, i]]
            })
            .collect();
        let rings = mesh(&frame, &strips).unwrap().rings();
        assert_eq!(rings, vec![vec![4, 5, 6, 7], vec![0, 3, 2, 1]]);
        let tie = [(0., 0.), (1., 0.), (0., 1.), (-1., 0.), (0., -1.)];
        let rings = mesh(&tie, &[[0, 1, 2], [0, 3, 4]]).unwrap().rings();
        assert_eq!(rings, vec![vec![0, 1, 2], vec![0, 3, 4]]);
    }

    #[test]
    fn each_defect_is_named() {
        let bad = |triangles: &[[usize; 3]]| mesh(&SQUARE, triangles).unwrap_err();
        assert_eq!(bad(&[]), MeshError::Empty);
        assert_eq!(
            bad(&[[0, 1, 9]]),
            MeshError::NoSuchVertex {
                triangle: 0,
                vertex: 9
            }
        );
        assert_eq!(bad(&[[0, 1, 1]]), MeshError::Flat { triangle: 0 });
        let overlap = bad(&[[0, 1, 2], [0, 1, 3]]);
        assert!(
            matches!(overlap, MeshError::Overlap { a: 0, b: 1, .. }),
            "{overlap}"
        );
        let counts = Mesh::new(vec![point(0., 0.)], vec![], vec![[0, 0, 0]]).unwrap_err();
        assert!(counts.to_string().contains("1 points but 0"));
        let nan = Mesh::new(
            vec![point(0., f64::NAN)],
            vec![point(0., 0.)],
            vec![[0, 0, 0]],
        );
        assert_eq!(nan.unwrap_err(), MeshError::NotFinite { vertex: 0 });
    }
}
