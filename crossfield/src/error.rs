//! The one error type of the crate.

use thiserror::Error;

/// Why a domain could not be triangulated or a field not be designed.
///
/// Rings are numbered as in the input polygon: 0 is the exterior, 1 the first
/// interior ring, and so on. Vertices and edges are counted from 0 within
/// their ring; edge `i` runs from vertex `i` to vertex `i + 1`.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FieldError {
    /// A coordinate was NaN or infinite, or too large to compute with.
    #[error(
        "vertex {vertex} of ring {ring} is not a usable number; \
         remove it or replace it by a finite coordinate"
    )]
    NonFinite {
        /// Ring of the vertex.
        ring: usize,
        /// Position of the vertex in its ring.
        vertex: usize,
    },
    /// A ring had fewer than three distinct vertices, or enclosed no area.
    #[error(
        "ring {ring} encloses no area (fewer than three distinct vertices, or all on a line); \
         remove the ring or give it area"
    )]
    ZeroArea {
        /// The ring.
        ring: usize,
    },
    /// Two edges of the boundary cross or lie on each other.
    #[error(
        "edge {edge} of ring {ring} crosses or overlaps edge {other_edge} of ring {other_ring} \
         near ({x}, {y}); split the polygon there or repair its boundary"
    )]
    SelfIntersecting {
        /// Ring of the first edge.
        ring: usize,
        /// First edge.
        edge: usize,
        /// Ring of the second edge.
        other_ring: usize,
        /// Second edge.
        other_edge: usize,
        /// Where, easting.
        x: f64,
        /// Where, northing.
        y: f64,
    },
    /// An interior ring lies outside the exterior or inside another hole.
    #[error(
        "interior ring {ring} does not lie inside the exterior ring, or lies in another hole; \
         remove it or make it a polygon of its own"
    )]
    HoleOutside {
        /// The ring.
        ring: usize,
    },
    /// The domain would need more vertices than [`max_vertices`] allows.
    ///
    /// [`max_vertices`]: crate::DomainOptions::max_vertices
    #[error(
        "the domain needs about {needed} vertices, and {allowed} are allowed; \
         raise `edge_length` or `max_vertices`"
    )]
    TooManyVertices {
        /// Vertices needed, estimated.
        needed: usize,
        /// The limit in force.
        allowed: usize,
    },
    /// A constraint line could not be used.
    #[error("constraint line {line} {why}; move or remove it")]
    BadLine {
        /// The line, counted from 0.
        line: usize,
        /// What is wrong with it.
        why: String,
    },
    /// The triangulation did not cover the polygon.
    #[error("triangulation failed: {what}; simplify the boundary or move its vertices apart")]
    MeshFailed {
        /// What went wrong.
        what: String,
    },
    /// An option was out of its range.
    #[error("option `{option}` {why}")]
    BadOption {
        /// Name of the option.
        option: &'static str,
        /// What is wrong with its value and which values are right.
        why: String,
    },
    /// The boundary has too few pieces for a harmonic field.
    #[error(
        "no harmonic field follows a boundary of {pieces} smooth pieces, such as a triangle's; \
         use a distance field or a boundary field (or lower an H-field's `max_turn_deg` \
         if the boundary is bent)"
    )]
    NoHarmonicField {
        /// Number of smooth pieces.
        pieces: usize,
    },
    /// The linear system of a field had no trustworthy solution.
    #[error(
        "the linear system of the field is singular ({why}); raise `omega`, \
         refine the domain or remove needle-thin parts"
    )]
    SingularSystem {
        /// How that was noticed.
        why: String,
    },
}

impl FieldError {
    /// [`FieldError::BadOption`], shorter.
    pub(crate) fn option(option: &'static str, why: impl Into<String>) -> Self {
        Self::BadOption {
            option,
            why: why.into(),
        }
    }
}
