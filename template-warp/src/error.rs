//! What can go wrong, in one enum.

/// Why a region, a template or a warp was refused.
///
/// Each message says what was wrong, where, and what to do about it. Refusals
/// of a warp ([`WarpError::FoldedFace`], [`WarpError::NotTiled`],
/// [`WarpError::NoFrontage`], ...) are ordinary outcomes of trying a template
/// on a region it does not suit: try the next candidate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WarpError {
    /// A region has fewer than three vertices.
    #[error("the region has {count} vertices; give at least 3, the first not repeated at the end")]
    TooFewVertices {
        /// Vertices given.
        count: usize,
    },
    /// A region coordinate is NaN or infinite.
    #[error("region vertex {index} is not finite; give finite coordinates in metres")]
    NonFinite {
        /// Position in the ring, counted from 0.
        index: usize,
    },
    /// Two successive region vertices coincide.
    #[error("region vertices {index} and the next one coincide at ({x}, {y}); remove one")]
    RepeatedVertex {
        /// Position of the first of the two in the ring, counted from 0.
        index: usize,
        /// Easting of the vertex, metres.
        x: f64,
        /// Northing of the vertex, metres.
        y: f64,
    },
    /// The number of edge uses differs from the number of edges.
    #[error("the region has {edges} edges but {uses} edge uses; give one use per edge")]
    UseCount {
        /// Edges of the ring.
        edges: usize,
        /// Uses given.
        uses: usize,
    },
    /// The region's ring encloses no area.
    #[error("the region's ring of {count} vertices encloses no area; check its coordinates")]
    ZeroArea {
        /// Vertices given.
        count: usize,
    },
    /// Two edges of the region cross or touch.
    #[error("region edges {first} and {second} cross or touch; give a simple ring")]
    SelfIntersection {
        /// The lower of the two edge numbers (edge i runs from vertex i to i + 1).
        first: usize,
        /// The higher of the two edge numbers.
        second: usize,
    },
    /// A library file is not valid TOML or lacks a field.
    #[error("the template file cannot be read: {message}")]
    Format {
        /// The reader's own words, with line and column.
        message: String,
    },
    /// A template contradicts itself.
    #[error("template `{template}`: {problem}")]
    BadTemplate {
        /// Name of the template.
        template: String,
        /// What is wrong and what to do.
        problem: String,
    },
    /// No template has this name.
    #[error("no template is called `{name}`; the library has: {known}")]
    UnknownTemplate {
        /// The name asked for.
        name: String,
        /// The names there are, separated by commas.
        known: String,
    },
    /// A size or option is not a positive, finite number.
    #[error("{option} is {value}; give a positive, finite number")]
    BadOption {
        /// Name of the option.
        option: &'static str,
        /// The value given.
        value: f64,
    },
    /// A candidate does not belong to this library and region.
    #[error(
        "the candidate does not fit: {problem}; match it anew with the same library and region"
    )]
    BadCandidate {
        /// What does not fit.
        problem: String,
    },
    /// A face came out with no or negative area, or crosses itself.
    #[error("template `{template}` folds on this region: face {face} near ({x:.2}, {y:.2}) is not simple with positive area; try another template or split the region")]
    FoldedFace {
        /// Name of the block template.
        template: String,
        /// Number of the face in the result, counted from 0.
        face: usize,
        /// Easting of a vertex of the face, metres.
        x: f64,
        /// Northing of that vertex, metres.
        y: f64,
    },
    /// The faces do not tile the region.
    #[error("template `{template}` does not tile the region: the edge at ({x:.3}, {y:.3}) {problem}; try another template")]
    NotTiled {
        /// Name of the block template.
        template: String,
        /// Easting of the edge's start, metres.
        x: f64,
        /// Northing of the edge's start, metres.
        y: f64,
        /// What is wrong with the edge.
        problem: &'static str,
    },
    /// A parcel has too little street frontage.
    #[error("template `{template}` leaves parcel {face} near ({x:.2}, {y:.2}) with {frontage:.2} m of street, under {required} m; try another template")]
    NoFrontage {
        /// Name of the block template.
        template: String,
        /// Number of the face in the result, counted from 0.
        face: usize,
        /// Easting of a vertex of the face, metres.
        x: f64,
        /// Northing of that vertex, metres.
        y: f64,
        /// Metres of street that it has.
        frontage: f64,
        /// Metres of street that it needs.
        required: f64,
    },
    /// A parcel is far from the size that the template gives it.
    #[error("template `{template}` makes face {face} near ({x:.2}, {y:.2}) {ratio:.2} times its ideal area; try another template or change the sizes")]
    WrongSize {
        /// Name of the block template.
        template: String,
        /// Number of the face in the result, counted from 0.
        face: usize,
        /// Easting of a vertex of the face, metres.
        x: f64,
        /// Northing of that vertex, metres.
        y: f64,
        /// Area of the face over its ideal area.
        ratio: f64,
    },
}
