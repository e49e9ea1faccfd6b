//! What can go wrong: one enum for the mesh, one for its check, one for the
//! optimisation and one for network design.

use crate::mesh::{FaceId, HalfEdgeId, VertexId};

/// Why a mesh could not be built or changed.
///
/// Every operation that returns one of these leaves the mesh as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A coordinate was NaN or infinite.
    #[error("wire {wire}, point {index} is not finite; remove or repair that coordinate")]
    NonFinite {
        /// Position of the wire in the input, from 0.
        wire: usize,
        /// Position of the point in the wire, from 0.
        index: usize,
    },
    /// A coordinate handed to an editing operation was NaN or infinite.
    #[error("the coordinate ({x}, {y}) given to {operation} is not finite")]
    NonFinitePoint {
        /// The operation that refused.
        operation: &'static str,
        /// The x given.
        x: f64,
        /// The y given.
        y: f64,
    },
    /// The snap distance was negative, NaN or infinite.
    #[error("the snap distance {snap} must be finite and not negative")]
    BadSnap {
        /// The value given.
        snap: f64,
    },
    /// No wire has any length: there is nothing to make a mesh of.
    #[error("the linework holds no segment longer than the snap distance {snap}; lower it or check the input's units")]
    Empty {
        /// The snap distance in force.
        snap: f64,
    },
    /// The arrangement would have more pieces than can be numbered or held.
    #[error("the linework has over {limit} pieces or crossings; thin it out or cut it into tiles")]
    TooComplex {
        /// The largest number that is accepted.
        limit: usize,
    },
    /// Snapping moved linework into new crossings again and again.
    #[error("snapping did not settle in {rounds} rounds near ({x}, {y}); lower the snap distance {snap}")]
    Unsettled {
        /// Rounds spent.
        rounds: usize,
        /// The snap distance in force.
        snap: f64,
        /// A place where pieces still touch.
        x: f64,
        /// A place where pieces still touch.
        y: f64,
    },
    /// The vertex id is stale or of another mesh.
    #[error("vertex {} does not exist (any more)", .0.0)]
    NoVertex(VertexId),
    /// The half-edge id is stale or of another mesh.
    #[error("half-edge {} does not exist (any more)", .0.0)]
    NoHalfEdge(HalfEdgeId),
    /// The face id is stale or of another mesh.
    #[error("face {} does not exist (any more)", .0.0)]
    NoFace(FaceId),
    /// The mesh is full: ids are never reused and all 2^32 are spent.
    #[error("the mesh has run out of ids; build a fresh one from its linework")]
    Full,
    /// A point meant to lie on an edge does not.
    #[error("({x}, {y}) lies {distance} from half-edge {}, over the allowed {allowed}; project it first", .half_edge.0)]
    OffEdge {
        /// The edge named.
        half_edge: HalfEdgeId,
        /// The point given.
        x: f64,
        /// The point given.
        y: f64,
        /// Distance of the point from the edge.
        distance: f64,
        /// The largest distance accepted.
        allowed: f64,
    },
    /// An end of a path is not on the boundary of the face to be split.
    #[error("end {end} of the path at ({x}, {y}) is not on the boundary of face {}", .face.0)]
    OffFace {
        /// 0 for the start of the path, 1 for its end.
        end: usize,
        /// The face named.
        face: FaceId,
        /// Where the end is.
        x: f64,
        /// Where the end is.
        y: f64,
    },
    /// A path is too short, folds back on itself or starts where it ends.
    #[error("segment {segment} of the path is shorter than {tolerance}, folds back or closes too early; drop repeated points")]
    DegeneratePath {
        /// Position of the segment in the path, from 0.
        segment: usize,
        /// The shortest length accepted.
        tolerance: f64,
    },
    /// A path leaves its face: it crosses or touches the face's boundary.
    #[error("segment {segment} of the path crosses or touches the boundary of face {} near ({x}, {y}); cut the path there first", .face.0)]
    PathMeetsBoundary {
        /// Position of the segment in the path, from 0.
        segment: usize,
        /// The face to be split.
        face: FaceId,
        /// Near the contact.
        x: f64,
        /// Near the contact.
        y: f64,
    },
    /// A path crosses or touches itself.
    #[error("segments {first} and {second} of the path cross or touch near ({x}, {y}); cut the path there first")]
    PathMeetsItself {
        /// Position of the earlier segment in the path, from 0.
        first: usize,
        /// Position of the later segment.
        second: usize,
        /// Near the contact.
        x: f64,
        /// Near the contact.
        y: f64,
    },
    /// The change would make a face cross itself, vanish or turn inside out.
    #[error("{operation} at ({x}, {y}) would make face {} cross itself, vanish or turn inside out", .face.0)]
    WouldBreak {
        /// The operation that refused.
        operation: &'static str,
        /// A face that would break.
        face: FaceId,
        /// Where the change was to happen.
        x: f64,
        /// Where the change was to happen.
        y: f64,
    },
    /// The vertex does not have exactly two edges.
    #[error("vertex {} has {degree} edges, not two", .vertex.0)]
    NotDegreeTwo {
        /// The vertex named.
        vertex: VertexId,
        /// Its number of edges.
        degree: usize,
    },
}

/// What [`PlanarMesh::validate`](crate::PlanarMesh::validate) found broken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// Links between half-edges disagree.
    #[error("half-edge {}: {what}", .half_edge.0)]
    Links {
        /// Where.
        half_edge: HalfEdgeId,
        /// Which link.
        what: &'static str,
    },
    /// A vertex's links are broken.
    #[error("vertex {}: {what}", .vertex.0)]
    Vertex {
        /// Where.
        vertex: VertexId,
        /// What is wrong with it.
        what: &'static str,
    },
    /// A face's loops are broken, or its geometry is.
    #[error("face {} near ({x}, {y}): {what}", .face.0)]
    Face {
        /// Where.
        face: FaceId,
        /// What is wrong with it.
        what: &'static str,
        /// Near the fault.
        x: f64,
        /// Near the fault.
        y: f64,
    },
    /// `V - E + F = 1 + C` does not hold.
    #[error("Euler: {vertices} vertices - {edges} edges + {faces} faces is not 1 + {components} components")]
    Euler {
        /// Live vertices.
        vertices: usize,
        /// Live edges (pairs of half-edges).
        edges: usize,
        /// Live faces, the unbounded one included.
        faces: usize,
        /// Connected components.
        components: usize,
    },
}

/// Why the strip optimisation could not run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OptimizeError {
    /// An option was NaN, infinite, negative or out of its range.
    #[error("option `{name}` = {value} must be finite and {range}")]
    BadOption {
        /// Name of the field of `OptimizeOptions`.
        name: &'static str,
        /// The value given.
        value: f64,
        /// What is accepted.
        range: &'static str,
    },
    /// A block names a face that does not exist, or the unbounded one.
    #[error("block {block} names face {}, which does not exist or is the unbounded face", .face.0)]
    BadFace {
        /// Position of the block in the input, from 0.
        block: usize,
        /// The face it names.
        face: FaceId,
    },
    /// A block's corners are not four vertices of its ring in ring order.
    #[error("block {block}: its corners must be four different vertices of face {}'s outer ring, counter-clockwise", .face.0)]
    BadCorners {
        /// Position of the block in the input, from 0.
        block: usize,
        /// The face it names.
        face: FaceId,
    },
    /// A road names a vertex that does not exist.
    #[error("road {road} names vertex {}, which does not exist", .vertex.0)]
    BadRoad {
        /// Position of the road in the input, from 0.
        road: usize,
        /// The vertex it names.
        vertex: VertexId,
    },
    /// A target shape gave too few, too many or non-finite points.
    #[error("the target shape gave {given} points for block {block}, whose ring has {expected}, or a point that is not finite")]
    BadTarget {
        /// Position of the block in the input, from 0.
        block: usize,
        /// Points that the shape gave.
        given: usize,
        /// Points of the ring.
        expected: usize,
    },
    /// The mesh is not sound before the optimisation.
    #[error("the mesh is not sound to start with: {0}")]
    BadMesh(#[from] MeshFault),
    /// The linear system could not be factored or solved.
    ///
    /// With `closeness` above 0 it is positive definite; so the weights are
    /// too far apart in size for double precision.
    #[error("the linear system of {unknowns} unknowns is not positive definite in double precision; bring the weights closer together")]
    Singular {
        /// Unknowns of the system.
        unknowns: usize,
    },
    /// The progress hook asked to stop; the mesh is unchanged.
    #[error("cancelled; the mesh is unchanged")]
    Cancelled,
}

/// Why a network could not be designed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// The mesh is none.
    #[error("the mesh is not a polygonal mesh: {what}")]
    BadMesh {
        /// What is wrong, and where.
        what: String,
    },
    /// The lists of a problem do not fit together.
    #[error("the problem does not fit together: {what}")]
    BadProblem {
        /// What is wrong, and where.
        what: String,
    },
    /// A room, or a floor, is not what it should be.
    #[error("the floor is not what it should be: {what}")]
    BadFloor {
        /// What is wrong, where, and what to do.
        what: String,
    },
    /// An option is out of its range.
    #[error("an option is out of its range: {what}")]
    BadOption {
        /// Which, what it is, and what it may be.
        what: String,
    },
    /// A solver, or this machine, has not the memory that a program needs.
    #[error("out of memory: {what}; use a coarser mesh or fewer placements")]
    OutOfMemory {
        /// What needed it.
        what: String,
    },
    /// A solver did not do what it should.
    #[error("the solver {solver} failed: {what}")]
    SolverFailed {
        /// Its name.
        solver: &'static str,
        /// What it said.
        what: String,
    },
}
