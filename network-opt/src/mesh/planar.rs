//! The half-edge structure: ids, links, walks and attributes.

use super::predicates::{finite, P};
use geo_types::Coord;

/// A vertex of a [`PlanarMesh`]. Ids are never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct VertexId(pub u32);

/// One side of an edge of a [`PlanarMesh`], with the face on its left. Ids
/// are never reused; the two sides of an edge are `2 k` and `2 k + 1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HalfEdgeId(pub u32);

/// A face of a [`PlanarMesh`]. Ids are never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FaceId(pub u32);

impl VertexId {
    /// The id that no vertex has.
    pub const NONE: Self = Self(u32::MAX);
}
impl HalfEdgeId {
    /// The id that no half-edge has.
    pub const NONE: Self = Self(u32::MAX);
    /// The other side of the same edge.
    #[must_use]
    pub const fn twin(self) -> Self {
        Self(self.0 ^ 1)
    }
    /// The one of the two sides that stands for the edge: the even id.
    #[must_use]
    pub const fn edge(self) -> Self {
        Self(self.0 & !1)
    }
}
impl FaceId {
    /// The id that no face has.
    pub const NONE: Self = Self(u32::MAX);
}

#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Vertex {
    pub(super) point: P,
    /// Some half-edge that leaves the vertex.
    pub(super) half: HalfEdgeId,
    pub(super) live: bool,
}

#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Half<E> {
    pub(super) origin: VertexId,
    pub(super) next: HalfEdgeId,
    pub(super) prev: HalfEdgeId,
    pub(super) face: FaceId,
    pub(super) live: bool,
    pub(super) attr: E,
}

#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Face {
    /// One half-edge per boundary loop, the outer loop first; the unbounded
    /// face has only holes.
    pub(super) loops: Vec<HalfEdgeId>,
    pub(super) live: bool,
}

/// A planar straight-line mesh with an attribute on each side of each edge.
///
/// Vertices, half-edges and faces carry ids that stay valid through edits and
/// are never reused. A street that ends on another is an ordinary vertex of
/// both; an edge that ends inside a face (a cul-de-sac) has that face on both
/// sides. Faces may have holes, and there is exactly one unbounded face,
/// [`outside`](Self::outside), so that the twin of every half-edge exists.
///
/// # Stale ids
///
/// The walks below never panic. An id that was removed keeps its last links
/// (ask [`has_half_edge`](Self::has_half_edge) and its likes), and an id that
/// the mesh never gave out yields `NONE` or a NaN coordinate. Operations that
/// change the mesh refuse both with an error. Only [`attr`](Self::attr) and
/// [`attr_mut`](Self::attr_mut), which must return a value, panic for an id
/// that was never given out; [`get_attr`](Self::get_attr) does not.
///
/// A mesh read back through `serde` is as good as its source: call
/// [`validate`](Self::validate) on one from elsewhere before anything else.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, line_string};
/// use network_opt::{End, PlanarMesh, Wire};
///
/// // A square site, and a street across it.
/// let site = line_string![(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 100.), (x: 0., y: 100.), (x: 0., y: 0.)];
/// let wire = Wire { line: site, left: "boundary", right: "boundary", priority: 1 };
/// let mut mesh = PlanarMesh::from_linework(&[wire], 0.01)?;
/// let site = mesh.faces().find(|&f| !mesh.is_outside(f)).unwrap();
/// let [south, north] = [(50., 0.), (50., 100.)].map(|(x, y)| {
///     let at = coord! { x: x, y: y };
///     End::Edge(mesh.nearest_edge(at).unwrap().0, at)
/// });
/// let split = mesh.split_face(site, &[coord! { x: 55., y: 50. }], south, north, "street", "street")?;
/// assert_eq!(split.faces.len(), 2);
/// assert_eq!(mesh.area(split.faces[0]) + mesh.area(split.faces[1]), 10_000.0);
/// assert!(mesh.validate().is_ok());
/// # Ok::<(), network_opt::MeshError>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlanarMesh<E> {
    pub(super) vertices: Vec<Vertex>,
    pub(super) halves: Vec<Half<E>>,
    pub(super) faces: Vec<Face>,
    /// Below this distance things count as touching.
    pub(super) tolerance: f64,
    /// An end this near to a vertex is that vertex.
    pub(super) snap: f64,
}

impl<E: Clone> PlanarMesh<E> {
    /// Live vertices, ascending.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        (0_u32..)
            .zip(&self.vertices)
            .filter(|(_, v)| v.live)
            .map(|(i, _)| VertexId(i))
    }

    /// Live half-edges, ascending: both sides of each edge.
    pub fn half_edges(&self) -> impl Iterator<Item = HalfEdgeId> + '_ {
        (0_u32..)
            .zip(&self.halves)
            .filter(|(_, h)| h.live)
            .map(|(i, _)| HalfEdgeId(i))
    }

    /// One half-edge (the even one) per live edge, ascending.
    pub fn edges(&self) -> impl Iterator<Item = HalfEdgeId> + '_ {
        self.half_edges().filter(|h| h.0 & 1 == 0)
    }

    /// Live faces, ascending; the unbounded one comes first.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> + '_ {
        (0_u32..)
            .zip(&self.faces)
            .filter(|(_, f)| f.live)
            .map(|(i, _)| FaceId(i))
    }

    /// Live bounded faces, ascending.
    pub fn bounded_faces(&self) -> impl Iterator<Item = FaceId> + '_ {
        self.faces().filter(|&f| !self.is_outside(f))
    }

    /// Is there (still) such a vertex?
    pub fn has_vertex(&self, v: VertexId) -> bool {
        self.vertices.get(v.0 as usize).is_some_and(|v| v.live)
    }

    /// Is there (still) such a half-edge?
    pub fn has_half_edge(&self, h: HalfEdgeId) -> bool {
        self.halves.get(h.0 as usize).is_some_and(|h| h.live)
    }

    /// Is there (still) such a face?
    pub fn has_face(&self, f: FaceId) -> bool {
        self.faces.get(f.0 as usize).is_some_and(|f| f.live)
    }

    /// Number of vertex ids given out so far: the length of an array that is
    /// indexed by vertex id.
    pub fn vertex_bound(&self) -> usize {
        self.vertices.len()
    }

    /// Number of half-edge ids given out so far.
    pub fn half_edge_bound(&self) -> usize {
        self.halves.len()
    }

    /// Number of face ids given out so far.
    pub fn face_bound(&self) -> usize {
        self.faces.len()
    }

    /// Below this distance (input units) two things count as touching:
    /// 1e-9 of the extent of the linework, or 16 units in the last place of
    /// its largest coordinate where that is more.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The snap distance that the mesh was built with, no less than 16 times
    /// [`tolerance`](Self::tolerance).
    pub fn snap(&self) -> f64 {
        self.snap
    }

    /// Where a vertex is.
    pub fn point(&self, v: VertexId) -> Coord<f64> {
        self.vertices.get(v.0 as usize).map_or(
            Coord {
                x: f64::NAN,
                y: f64::NAN,
            },
            |v| v.point,
        )
    }

    /// Moves a vertex, without looking whether faces stay simple
    /// ([`validate`](Self::validate) and [`face_is_sound`](Self::face_is_sound)
    /// do). Returns whether it moved: not if the id is stale or the point is
    /// not finite.
    pub fn set_point(&mut self, v: VertexId, at: Coord<f64>) -> bool {
        match self.vertices.get_mut(v.0 as usize) {
            Some(vertex) if vertex.live && finite(at) => {
                vertex.point = at;
                true
            }
            _ => false,
        }
    }

    /// Vertex at which a half-edge starts.
    pub fn origin(&self, h: HalfEdgeId) -> VertexId {
        self.half(h).map_or(VertexId::NONE, |h| h.origin)
    }

    /// Vertex at which a half-edge ends.
    pub fn dest(&self, h: HalfEdgeId) -> VertexId {
        self.origin(h.twin())
    }

    /// The other side of the edge.
    pub fn twin(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.half(h).map_or(HalfEdgeId::NONE, |_| h.twin())
    }

    /// The half-edge that follows along the same face, face on the left.
    pub fn next(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.half(h).map_or(HalfEdgeId::NONE, |h| h.next)
    }

    /// The half-edge before, along the same face.
    pub fn prev(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.half(h).map_or(HalfEdgeId::NONE, |h| h.prev)
    }

    /// The face on the left.
    pub fn face(&self, h: HalfEdgeId) -> FaceId {
        self.half(h).map_or(FaceId::NONE, |h| h.face)
    }

    /// The attribute of this side of the edge.
    ///
    /// # Panics
    ///
    /// If the mesh never gave out this id.
    pub fn attr(&self, h: HalfEdgeId) -> &E {
        &self.halves[h.0 as usize].attr
    }

    /// The attribute of this side of the edge, to be changed.
    ///
    /// # Panics
    ///
    /// If the mesh never gave out this id.
    pub fn attr_mut(&mut self, h: HalfEdgeId) -> &mut E {
        &mut self.halves[h.0 as usize].attr
    }

    /// The attribute of this side of the edge, if the half-edge exists.
    pub fn get_attr(&self, h: HalfEdgeId) -> Option<&E> {
        self.half(h).filter(|h| h.live).map(|h| &h.attr)
    }

    /// Sets the attributes of both sides: `left` for `h`, `right` for its
    /// twin. Returns whether the half-edge exists.
    pub fn set_attrs(&mut self, h: HalfEdgeId, left: E, right: E) -> bool {
        if !self.has_half_edge(h) {
            return false;
        }
        self.halves[h.0 as usize].attr = left;
        self.halves[h.twin().0 as usize].attr = right;
        true
    }

    /// The unbounded face. It exists from the start and is never replaced.
    pub fn outside(&self) -> FaceId {
        FaceId(0)
    }

    /// Is this the unbounded face?
    pub fn is_outside(&self, f: FaceId) -> bool {
        f == self.outside()
    }

    /// One half-edge per boundary loop of a face: the outer loop first, then
    /// the holes; of the unbounded face, only holes. Empty if there is no
    /// such face.
    pub fn loops(&self, f: FaceId) -> Vec<HalfEdgeId> {
        match self.faces.get(f.0 as usize) {
            Some(face) if face.live => face.loops.clone(),
            _ => Vec::new(),
        }
    }

    /// The half-edges of a loop, from `h` on, face on the left; empty if `h`
    /// does not exist.
    pub fn walk(&self, h: HalfEdgeId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let mut at = self.has_half_edge(h).then_some(h);
        // The bound is never met in a sound mesh; it keeps a broken one from
        // hanging its own check.
        std::iter::from_fn(move || {
            let now = at?;
            let next = self.next(now);
            at = (next != h).then_some(next);
            Some(now)
        })
        .take(self.halves.len())
    }

    /// The half-edges that leave a vertex, counter-clockwise, from an
    /// arbitrary but fixed one; empty if there is no such vertex.
    pub fn outgoing(&self, v: VertexId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let first = match self.vertices.get(v.0 as usize) {
            Some(vertex) if vertex.live => Some(vertex.half),
            _ => None,
        };
        let mut at = first;
        std::iter::from_fn(move || {
            let now = at?;
            let next = self.prev(now).twin();
            at = (Some(next) != first).then_some(next);
            Some(now)
        })
        .take(self.halves.len())
    }

    /// Number of edges at a vertex.
    pub fn degree(&self, v: VertexId) -> usize {
        self.outgoing(v).count()
    }

    /// The half-edge from `a` to `b`, if there is one.
    pub fn find_edge(&self, a: VertexId, b: VertexId) -> Option<HalfEdgeId> {
        self.outgoing(a).find(|&h| self.dest(h) == b)
    }

    /// Position of a half-edge's start.
    pub(crate) fn start(&self, h: HalfEdgeId) -> P {
        self.point(self.origin(h))
    }

    /// Position of a half-edge's end.
    pub(crate) fn end(&self, h: HalfEdgeId) -> P {
        self.point(self.dest(h))
    }

    pub(super) fn half(&self, h: HalfEdgeId) -> Option<&Half<E>> {
        self.halves.get(h.0 as usize)
    }

    /// Makes `b` follow `a`.
    pub(super) fn link(&mut self, a: HalfEdgeId, b: HalfEdgeId) {
        self.halves[a.0 as usize].next = b;
        self.halves[b.0 as usize].prev = a;
    }
}
