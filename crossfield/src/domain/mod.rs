//! A triangulated polygon, the ground that fields are designed on.

mod core;
mod cursor;
mod extract;
mod fault;
mod lattice;
mod lines;
mod locate;
mod mesh;
mod options;
mod pieces;
mod ring;
mod sight;
mod sizing;
mod topology;

use std::sync::{Arc, OnceLock};

use geo_types::{Coord, LineString, Polygon};
use nalgebra::Rotation2;

use crate::footpoint::EdgeTree;
use crate::plane::{coord, vector, V2};
use crate::FieldError;
pub use cursor::Cursor;
use lines::Lines;
pub(crate) use mesh::{Border, BORDER};
pub use options::DomainOptions;
pub use pieces::Piece;
pub(crate) use ring::Ring;
use sizing::Sizing;

/// A corner of the boundary: a vertex that turns by more than
/// [`DomainOptions::corner_deg`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Corner {
    /// Where it is.
    pub at: Coord<f64>,
    /// Its ring, 0 for the exterior.
    pub ring: usize,
    /// Its vertex in the input ring.
    pub vertex: usize,
    /// By how much the boundary turns there, radians, with the domain on its
    /// left: positive at convex corners, negative at concave ones.
    pub turn: f64,
}

/// An edge of the mesh on a constraint line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LineEdge {
    /// Vertex at one end.
    pub from: usize,
    /// Vertex at the other end.
    pub to: usize,
    /// Which of the lines given.
    pub line: usize,
}

/// A point of the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Exit {
    /// Where it is, on the edge named below.
    pub point: Coord<f64>,
    /// Its ring, 0 for the exterior.
    pub ring: usize,
    /// Its edge in the input ring; edge `i` joins vertices `i` and `i + 1`.
    pub edge: usize,
}

/// A polygon with holes, triangulated with Steiner points inside and on the
/// boundary.
///
/// Cloning is cheap: clones share the mesh. Vertices are numbered with those
/// of the rings first. Computations run relative to the centre of the
/// bounding box, so that a domain far from the origin loses no digits.
///
/// The mesh is a lattice of equilateral triangles away from the boundary and
/// a refined constrained Delaunay triangulation near it (Shewchuk 1996, which
/// the paper uses, by way of the crate spade). On large meshes only a band
/// along the boundary goes through that, the rest being known beforehand.
///
/// ```
/// use crossfield::{geo_types::{coord, polygon}, Cursor, Domain, DomainOptions};
///
/// let square = polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.), (x: 0., y: 9.)];
/// let domain = Domain::new(&square, &DomainOptions::default())?;
/// assert!((domain.area() - 81.0).abs() < 1e-9);
/// assert_eq!(domain.corners().len(), 4);
///
/// // Eastwards from the middle, the boundary is met on edge 1.
/// let (from, to) = (coord! { x: 4.5, y: 4.0 }, coord! { x: 11.0, y: 4.0 });
/// let exit = domain.exit(from, to, &mut Cursor::default()).expect("it leaves");
/// assert_eq!((exit.edge, exit.point), (1, coord! { x: 9.0, y: 4.0 }));
/// # Ok::<(), crossfield::FieldError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Domain {
    pub(crate) inner: Arc<Inner>,
}

/// What a domain holds; coordinates are relative to `frame.origin`.
#[derive(Debug)]
pub(crate) struct Inner {
    pub(crate) frame: ring::Frame,
    pub(crate) rings: Vec<Ring>,
    pub(crate) mesh: mesh::Mesh,
    pub(crate) adjacency: topology::Adjacency,
    pub(crate) area: f64,
    edge_length: f64,
    boundary: Vec<bool>,
    grid: locate::Grid,
    edges: OnceLock<EdgeTree>,
}

impl Domain {
    /// Triangulates `polygon`.
    ///
    /// Rings may be oriented either way and closed or open; vertices nearer
    /// than 1e-9 of the polygon's size are merged. Rings may touch at points.
    ///
    /// # Errors
    ///
    /// Each kind of bad input has its variant of [`FieldError`]: coordinates
    /// that are not finite, rings without area, edges that cross or overlap,
    /// holes outside the exterior, options out of range, and more vertices
    /// than allowed.
    ///
    /// # Complexity
    ///
    /// O(n) in the vertices of the mesh, about 0.3 microseconds each, and
    /// O(b log b), some 3 microseconds each, in those near the boundary (all
    /// of them below 6,000); 208 bytes of memory a vertex at the peak.
    pub fn new(polygon: &Polygon<f64>, options: &DomainOptions) -> Result<Self, FieldError> {
        Self::with_lines(polygon, &[], options)
    }

    /// Triangulates `polygon` with edges of the mesh along `lines`.
    ///
    /// Lines may cross and touch each other and the boundary; what lies
    /// outside is left out. Each is subdivided as the boundary is, and
    /// [`Domain::line_edges`] tells which edges of the mesh lie on it. The
    /// lattice keeps clear of them, so that triangles along a line are well
    /// shaped where it is alone; where lines meet at small angles they are
    /// not, since refinement does not look at them.
    ///
    /// ```
    /// use crossfield::{geo_types::{line_string, polygon}, Domain, DomainOptions};
    ///
    /// let square = polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.), (x: 0., y: 9.)];
    /// let creek = line_string![(x: -3., y: 2.), (x: 4., y: 5.), (x: 9., y: 5.)];
    /// let domain = Domain::with_lines(&square, &[creek], &DomainOptions::default())?;
    /// let length = |e: &crossfield::LineEdge| {
    ///     let (a, b) = (domain.vertex(e.from), domain.vertex(e.to));
    ///     (a.x - b.x).hypot(a.y - b.y)
    /// };
    /// let total: f64 = domain.line_edges().iter().map(length).sum();
    /// let wanted = 4.0 / 7.0 * 7.0_f64.hypot(3.0) + 5.0; // from x = 0 on
    /// assert!((total - wanted).abs() < 1e-9);
    /// # Ok::<(), crossfield::FieldError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Domain::new`], and [`FieldError::BadLine`] for a line that is not
    /// finite or cannot be told from the boundary beside it.
    pub fn with_lines(
        polygon: &Polygon<f64>,
        lines: &[LineString<f64>],
        options: &DomainOptions,
    ) -> Result<Self, FieldError> {
        options.check()?;
        let input = polygon.exterior().0.len()
            + polygon.interiors().iter().map(|r| r.0.len()).sum::<usize>();
        let allowed = options.max_vertices.min(MOST_VERTICES);
        if input > allowed {
            return Err(FieldError::TooManyVertices {
                needed: input,
                allowed,
            });
        }
        let (frame, rings) = ring::rings(polygon, options.corner_deg.to_radians())?;
        let area: f64 = rings.iter().map(Ring::area).sum();
        if area <= 0.0 {
            // More hole than polygon: some hole lies outside.
            return Err(FieldError::HoleOutside { ring: 1 });
        }
        let perimeter: f64 = rings.iter().map(Ring::perimeter).sum();
        let step = if options.edge_length > 0.0 {
            options.edge_length
        } else {
            (area.sqrt() / 40.0).max(perimeter / MOST_AUTOMATIC)
        };
        // Before any point is made: an edge length in the wrong unit must not
        // fill the memory.
        let sizing = Sizing::new(&rings, step, options);
        let lines = Lines::new(lines, &rings, frame)?;
        let drawn: f64 = lines.pieces.iter().map(|p| (p.to - p.from).norm()).sum();
        // Grading: a strip along the boundary in which edges grow.
        let edge = sizing.boundary;
        let graded = if edge < step {
            (perimeter + drawn) / (0.87 * sizing.grading) * (edge.recip() - step.recip())
        } else {
            0.0
        };
        let estimate = area / (0.87 * step * step) + (perimeter + drawn) / edge + graded;
        if estimate > 1.2 * allowed as f64 {
            return Err(FieldError::TooManyVertices {
                needed: estimate as usize,
                allowed,
            });
        }
        let options = DomainOptions {
            max_vertices: allowed,
            ..options.clone()
        };
        let mesh = mesh::triangulate(&rings, &lines, frame, &sizing, &options)?;
        Ok(Self::assemble(frame, rings, mesh, area, step))
    }

    fn assemble(
        frame: ring::Frame,
        rings: Vec<Ring>,
        mesh: mesh::Mesh,
        area: f64,
        edge_length: f64,
    ) -> Self {
        let adjacency = topology::Adjacency::new(&mesh);
        let grid = locate::Grid::new(&mesh);
        let mut boundary = vec![false; mesh.points.len()];
        for border in &mesh.borders {
            boundary[border.from as usize] = true;
            boundary[border.to as usize] = true;
        }
        Self {
            inner: Arc::new(Inner {
                frame,
                rings,
                mesh,
                adjacency,
                area,
                edge_length,
                boundary,
                grid,
                edges: OnceLock::new(),
            }),
        }
    }

    /// The same mesh, turned by `angle` radians about the centre of its
    /// bounding box and then shifted.
    ///
    /// Not the same as triangulating a moved polygon anew, which gives other
    /// Steiner points: use it to compare fields vertex by vertex.
    #[must_use]
    pub fn moved(&self, angle: f64, shift: Coord<f64>) -> Self {
        let inner = &*self.inner;
        let turn = Rotation2::new(angle);
        let mut rings = inner.rings.clone();
        for ring in &mut rings {
            ring.points.iter_mut().for_each(|p| *p = turn * *p);
        }
        let mut mesh = inner.mesh.clone();
        mesh.points.iter_mut().for_each(|p| *p = turn * *p);
        let frame = ring::Frame {
            origin: inner.frame.origin + vector(shift),
            size: inner.frame.size,
        };
        Self::assemble(frame, rings, mesh, inner.area, inner.edge_length)
    }

    /// The same mesh seen in a mirror: x becomes -x relative to the centre of
    /// the bounding box. Vertices keep their numbers; rings and triangles are
    /// walked the other way.
    #[cfg(test)]
    pub(crate) fn mirrored(&self) -> Self {
        let inner = &*self.inner;
        let flip = |p: &mut V2| p.x = -p.x;
        let mut rings = inner.rings.clone();
        let mut mesh = inner.mesh.clone();
        for border in &mut mesh.borders {
            std::mem::swap(&mut border.from, &mut border.to);
            let count = rings[border.ring as usize].len() as u32;
            border.edge = (2 * count - 2 - border.edge) % count;
        }
        for ring in &mut rings {
            ring.points.iter_mut().for_each(flip);
            ring.points.reverse();
            ring.turn.reverse();
            ring.corner.reverse();
            ring.input_vertex.reverse();
            ring.input_edge.reverse();
            ring.input_edge.rotate_left(1);
        }
        mesh.points.iter_mut().for_each(flip);
        for (triangle, neighbours) in mesh.triangles.iter_mut().zip(&mut mesh.neighbours) {
            triangle.swap(1, 2);
            neighbours.swap(0, 2);
        }
        Self::assemble(inner.frame, rings, mesh, inner.area, inner.edge_length)
    }

    /// Positions of all vertices.
    #[must_use]
    pub fn vertices(&self) -> Vec<Coord<f64>> {
        (0..self.vertex_count()).map(|v| self.vertex(v)).collect()
    }

    /// Position of vertex `v`.
    ///
    /// # Panics
    ///
    /// If `v` is not below [`Domain::vertex_count`].
    #[must_use]
    pub fn vertex(&self, v: usize) -> Coord<f64> {
        coord(self.inner.mesh.points[v] + self.inner.frame.origin)
    }

    /// Number of vertices.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.inner.mesh.points.len()
    }

    /// Vertices of each triangle, counter-clockwise.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.inner.mesh.triangles
    }

    /// The vertices joined to vertex `v` by an edge, in ascending order.
    ///
    /// # Panics
    ///
    /// If `v` is not below [`Domain::vertex_count`].
    #[must_use]
    pub fn neighbours(&self, v: usize) -> &[u32] {
        self.inner.adjacency.of(v)
    }

    /// Whether vertex `v` lies on the boundary.
    ///
    /// # Panics
    ///
    /// If `v` is not below [`Domain::vertex_count`].
    #[must_use]
    pub fn is_boundary(&self, v: usize) -> bool {
        self.inner.boundary[v]
    }

    /// The vertices that do not lie on the boundary, in ascending order.
    pub fn inner_vertices(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.vertex_count()).filter(|&v| !self.is_boundary(v))
    }

    /// The triangle that contains `at`, or `None` outside.
    ///
    /// Points on the boundary are inside, with a tolerance of 1e-10 of the
    /// domain's size. Walks from the cursor's triangle, or looks into a grid
    /// if there is none, it is far away, or the boundary is in between.
    #[must_use]
    pub fn locate(&self, at: Coord<f64>, cursor: &mut Cursor) -> Option<usize> {
        self.inner.locate(self.local(at), cursor)
    }

    /// Where the segment from `from` to `to` first leaves the domain, or
    /// `None` if it stays inside.
    ///
    /// The sides of the mesh edges are decided exactly, so that no gap is
    /// slipped through; the point is rounded onto its edge. A segment that
    /// touches the boundary in a single vertex may count either way. If
    /// `from` lies outside, the boundary point nearest to it is returned.
    #[must_use]
    pub fn exit(&self, from: Coord<f64>, to: Coord<f64>, cursor: &mut Cursor) -> Option<Exit> {
        self.inner.exit(self.local(from), self.local(to), cursor)
    }

    /// The boundary point nearest to `at`, which may lie anywhere.
    ///
    /// # Complexity
    ///
    /// O(log n) in the edges of the rings, after a tree over them is built by
    /// the first call.
    #[must_use]
    pub fn nearest_boundary(&self, at: Coord<f64>) -> Exit {
        self.inner.nearest_boundary(self.local(at))
    }

    /// The edges of the mesh that lie on the lines given to
    /// [`Domain::with_lines`], by line. An edge on two lines is listed once.
    #[must_use]
    pub fn line_edges(&self) -> Vec<LineEdge> {
        let edges = self.inner.mesh.line_edges.iter();
        edges
            .map(|&(from, to, line)| LineEdge {
                from: from as usize,
                to: to as usize,
                line: line as usize,
            })
            .collect()
    }

    /// Area, holes taken off.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.inner.area
    }

    /// Wanted length of triangle edges: the option, or what was chosen for it.
    #[must_use]
    pub fn edge_length(&self) -> f64 {
        self.inner.edge_length
    }

    /// Number of boundary rings, the exterior included.
    #[must_use]
    pub fn ring_count(&self) -> usize {
        self.inner.rings.len()
    }

    /// Vertices less edges plus triangles of the mesh: 1 for a disc, one less
    /// for each hole.
    #[must_use]
    pub fn euler_characteristic(&self) -> i32 {
        let inner = &*self.inner;
        let edges = (3 * inner.mesh.triangles.len() + inner.mesh.borders.len()) / 2;
        (inner.mesh.points.len() + inner.mesh.triangles.len()) as i32 - edges as i32
    }

    /// The corners of the boundary, ring by ring in the direction that has
    /// the domain on its left.
    #[must_use]
    pub fn corners(&self) -> Vec<Corner> {
        ring::corners(&self.inner.rings, self.inner.frame.origin)
    }

    /// Smallest angle of any triangle, radians.
    #[must_use]
    pub fn min_angle(&self) -> f64 {
        topology::min_angle(&self.inner.mesh)
    }

    /// Whether both are one mesh: clones of each other, or triangulated alike to
    /// the bit, as equal polygons with equal options are.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        let (a, b) = (&*self.inner, &*other.inner);
        Arc::ptr_eq(&self.inner, &other.inner)
            || (a.frame.origin == b.frame.origin
                && a.mesh.points == b.mesh.points
                && a.mesh.triangles == b.mesh.triangles)
    }

    pub(crate) fn local(&self, at: Coord<f64>) -> V2 {
        vector(at) - self.inner.frame.origin
    }
}

impl Inner {
    pub(crate) fn nearest_boundary(&self, p: V2) -> Exit {
        let tree = self.edges.get_or_init(|| EdgeTree::new(&self.rings));
        let (point, ring, edge) = tree.nearest(&self.rings, p);
        self.named_exit(point, ring, edge)
    }
}

/// With an automatic edge length, about as many boundary vertices at most. A
/// compact domain has some 200; only needles come near it.
const MOST_AUTOMATIC: f64 = 8000.0;

/// Neighbour entries keep one bit for borders.
const MOST_VERTICES: usize = 1 << 28;
