//! Quad meshes of sites and buildings: the candidates of network design.
//!
//! The paper takes them from a patch-wise quadrangulation (Peng et al. 2014)
//! and asks that they be semi-regular, near to squares and even. Here, in the
//! order of the data: `outline` places vertices along the boundary, corners
//! kept; `rows` fills the inside with points along the arms of a cross field,
//! from the boundary inwards; `pairs` triangulates them and joins triangles to
//! quads; `halve` cuts each quad in four and each triangle that is left in
//! three, after which all faces are quads; `relax` draws them to squares;
//! `quality` says how good they are.

mod halve;
mod outline;
mod pairs;
mod quality;
mod relax;
mod rows;

pub use quality::QuadQuality;

use std::fmt;

use geo_types::{Coord, Polygon};

use crate::design::Tessellation;
use crate::error::DesignError;
use outline::Outline;

/// The angle, in radians, of one arm of a cross at a point; `None` where there
/// is none.
pub type Directions<'a> = dyn Fn(Coord<f64>) -> Option<f64> + 'a;

/// How a polygon is cut into quads.
pub struct QuadOptions<'a> {
    /// Wanted length of edges, metres.
    ///
    /// Default value: 0, a twelfth of the square root of the area (312 edges
    /// on a square, as in the paper's figure 2).
    pub edge_length: f64,
    /// Directions that quads should follow inside.
    ///
    /// Default value: `None`, those of the nearest edge of the boundary.
    pub directions: Option<&'a Directions<'a>>,
    /// A vertex of the boundary that turns by more than this is a corner of
    /// the mesh, degrees.
    ///
    /// Default value: 30.
    pub corner_deg: f64,
    /// Rounds in which quads are drawn to squares.
    ///
    /// Default value: 60.
    pub rounds: usize,
}

impl fmt::Debug for QuadOptions<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("QuadOptions")
            .field("edge_length", &self.edge_length)
            .field("directions", &self.directions.map(|_| "given"))
            .field("corner_deg", &self.corner_deg)
            .field("rounds", &self.rounds)
            .finish()
    }
}

impl Default for QuadOptions<'_> {
    fn default() -> Self {
        Self {
            edge_length: 0.0,
            directions: None,
            corner_deg: 30.0,
            rounds: 60,
        }
    }
}

/// No vertex is moved so that a corner of a quad becomes smaller than this share
/// of a square's.
const LEAST_CORNER: f64 = 0.03;
/// Most quads of a mesh.
const MOST: f64 = 1e6;

/// Cuts a polygon with holes into quads.
///
/// The boundary of the mesh follows that of the polygon: corners are vertices,
/// but for those nearer to the next than half an edge, and all other boundary
/// vertices lie on it. Edges between them are straight, so that a bent
/// boundary is met to within what an edge can.
///
/// # Errors
///
/// [`DesignError::BadMesh`] for a polygon whose rings are not finite, have no
/// area or cross, and for an edge length that asks for over a million quads.
///
/// # Complexity
///
/// O(n log n) in the number of quads.
///
/// # Examples
///
/// ```
/// use network_opt::geo_types::polygon;
/// use network_opt::quad::{quads, QuadOptions, QuadQuality};
///
/// let site = polygon![(x: 0., y: 0.), (x: 120., y: 0.), (x: 120., y: 80.), (x: 0., y: 80.)];
/// let options = QuadOptions { edge_length: 10.0, ..QuadOptions::default() };
/// let mesh = quads(&site, &options)?;
/// assert_eq!(mesh.faces().len(), 96);
/// let quality = QuadQuality::of(&mesh);
/// assert!(quality.regular == 1.0 && quality.min_angle_deg > 89.9);
/// # Ok::<(), network_opt::DesignError>(())
/// ```
pub fn quads(
    polygon: &Polygon<f64>,
    options: &QuadOptions<'_>,
) -> Result<Tessellation, DesignError> {
    let bad = |what: String| DesignError::BadMesh { what };
    let area = outline::area(polygon);
    if !(area > 0.0 && area.is_finite()) {
        return Err(bad(format!("the polygon has an area of {area}")));
    }
    let edge = if options.edge_length == 0.0 {
        area.sqrt() / 12.0
    } else {
        options.edge_length
    };
    if !(edge > 0.0 && edge.is_finite()) {
        return Err(bad(format!(
            "the edge length is {edge}; give metres, or 0 for automatic"
        )));
    }
    if area / (edge * edge) > MOST {
        return Err(bad(format!(
            "an edge length of {edge} asks for over a million quads"
        )));
    }
    let outline = Outline::new(polygon, 2.0 * edge, options.corner_deg.to_radians())?;
    let relative = |p: Coord<f64>| match options.directions {
        Some(directions) => directions(p + outline.origin).filter(|angle| angle.is_finite()),
        None => Some(outline.direction_near(p)),
    };
    let inside = rows::fill(&outline, 2.0 * edge, &relative);
    let faces = pairs::faces(&outline, &inside)?;
    let least = LEAST_CORNER * edge * edge;
    let mut mesh = halve::halve(&outline, &inside, &faces, least);
    relax::relax(&mut mesh, &outline, edge, options.rounds, least);
    mesh.points
        .iter_mut()
        .for_each(|p| *p = *p + outline.origin);
    Tessellation::new(mesh.points, mesh.faces)
}

/// A mesh in the making, relative to the centre of the polygon.
#[derive(Debug)]
struct Draft {
    points: Vec<Coord<f64>>,
    faces: Vec<Vec<usize>>,
    /// For vertices on the boundary where that is: ring and position along it;
    /// `None` inside.
    on_rim: Vec<Option<outline::Place>>,
}
