//! Which edges make a side: the logical sides of regions that come without.
//!
//! The notes name five sorts of input, and this is what becomes of each:
//!
//! 1. A quad along the axes of the map: west 0, north 1, east 2, south 3.
//! 2. A quad that is turned: seen in its oriented box, whose longest edge is laid
//!    along the x axis; then as above. The notes' simpler way, numbers that go on
//!    from the first edge, depends on the order of vertices, so it is not taken.
//!    A quad that is turned by little ([`Thresholds::axis`]) keeps the names that
//!    the map gives.
//! 3. More than four edges that look like a quad: the four groups of cardinal
//!    directions ([`cardinal`]), in the frame of 2. It looks like one if it has
//!    four corners, or fills its box ([`Thresholds::quad`]).
//! 4. More sides than that: corners by length and angle ([`corners`]), numbered
//!    clockwise from the side that faces west most.
//! 5. Concave ones: as 4; corners that turn inwards count like others.
//!
//! Edges of holes have no side.

mod cardinal;
mod corners;

use geo_types::Coord;

use crate::plane::{cross, named_by, oriented_box, quad_angles, quad_area, right, unit, Ring};
use crate::shape::{Local, Region};

/// What makes a corner, and what looks like a quad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Thresholds {
    /// A box turned by no more than this keeps the names of the map's
    /// directions, radians.
    ///
    /// Default value: 15 degrees.
    pub(crate) axis: f64,
    /// Corners turn by at least this, radians.
    ///
    /// Default value: 35 degrees.
    pub(crate) angle: f64,
    /// Sides are at least as long as this share of the perimeter.
    ///
    /// Default value: 0.02.
    pub(crate) length: f64,
    /// What fills at least this share of its oriented box looks like a quad.
    ///
    /// Default value: 0.85, between a regular octagon (0.83) and a rectangle
    /// whose corners are cut off at a quarter of its sides (0.875).
    pub(crate) quad: f64,
    /// A quad whose angles are all at least this has coordinates that follow its
    /// sides; any other those of its box, radians.
    ///
    /// Default value: 45 degrees.
    pub(crate) square: f64,
}

impl Thresholds {
    /// The default values.
    pub(crate) const DEFAULT: Self = Self {
        axis: 15.0 * DEGREE,
        angle: 35.0 * DEGREE,
        length: 0.02,
        quad: 0.85,
        square: 45.0 * DEGREE,
    };
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Numbers the sides of a piece by its local coordinates: 0 where x is low, 1
/// where y is high, 2 and 3 opposite. The one entry for what rules make.
pub(crate) fn by_local(region: &mut Region) {
    let [x, y] = region.local.axes();
    let corners = cardinal::corners(&region.area.outer, x, y);
    set_sides(region, corners, region.local.mirrored());
}

/// Keeps the numbers that the edges of a piece have from its region, of `sides`
/// sides, if it has each of them as one run; else numbers them by its local
/// coordinates. Where the four corners of a region that looks like a quad are
/// still there, local coordinates follow them.
pub(crate) fn kept(region: &mut Region, sides: usize) {
    for edge in region.edges.iter_mut().skip(1).flatten() {
        edge.side = None;
    }
    let all = region.edges[0].iter().all(|edge| edge.side.is_some());
    let mut runs: Vec<usize> = region.logical().iter().map(|side| side.index).collect();
    runs.sort_unstable();
    if !all || !runs.into_iter().eq(0..sides) {
        by_local(region);
        return;
    }
    region.sides = sides;
    if sides == 4 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| region.corner(k));
        if let (Some(a), Some(b), Some(c), Some(d)) = (a, b, c, d) {
            let places = [a, b, c, d];
            let least = Thresholds::DEFAULT.square;
            let square = |angles: [f64; 4]| angles.iter().all(|a| *a >= least);
            let same = Local::new(places).mirrored() == region.local.mirrored();
            if same && quad_angles(&places).is_some_and(square) {
                region.local.corners = places;
            }
        }
    }
}

/// The vertices of a ring at which its groups of cardinal directions meet: those
/// at (0, 0), (0, 1), (1, 1) and (1, 0) of axes.
pub(crate) fn meeting_points(ring: &Ring, x: Coord<f64>, y: Coord<f64>) -> [usize; 4] {
    cardinal::corners(ring, x, y)
}

/// The vertices of a ring that are corners.
pub(crate) fn corner_vertices(ring: &Ring) -> Vec<usize> {
    corners::corners(ring, &Thresholds::DEFAULT)
}

fn set_sides(region: &mut Region, corners: [usize; 4], mirrored: bool) {
    let groups = cardinal::groups(region.area.outer.len(), corners, mirrored);
    for (edge, side) in region.edges[0].iter_mut().zip(groups) {
        edge.side = Some(side);
    }
    region.sides = 4;
}

/// Numbers the sides of the park itself, gives it coordinates, and makes each of
/// its edges a part of the boundary. The one entry for the park.
pub(crate) fn park(region: &mut Region) {
    with(region, &Thresholds::DEFAULT);
    for edges in &mut region.edges {
        for edge in edges {
            edge.origin.boundary = Some(edge.side.unwrap_or(region.sides));
            edge.origin.descent = edge.side;
        }
    }
}

/// Numbers the sides of a region by its shape alone, and gives it coordinates.
pub(crate) fn with(region: &mut Region, thresholds: &Thresholds) {
    let ring = &region.area.outer;
    let around = frame(ring, thresholds);
    let [x, y] = Local::new(around).axes();
    let found = corners::corners(ring, thresholds);
    let full = crate::plane::signed_area(ring).abs() >= thresholds.quad * quad_area(&around);
    region.local = Local::new(around);
    if let Some(corners) = quad(ring, &found, x, y).or_else(|| {
        let corners = cardinal::corners(ring, x, y);
        full.then_some(corners).filter(distinct)
    }) {
        let places = corners.map(|k| ring[k]);
        let square = |angles: [f64; 4]| angles.iter().all(|a| *a >= thresholds.square);
        if quad_angles(&places).is_some_and(square) {
            region.local = Local::new(places);
        }
        set_sides(region, corners, false);
        return;
    }
    number_from_west(region, &found, x);
}

/// The oriented box, as its axes are named: by the map's directions if it is
/// turned by little, with its longest edge along x otherwise.
fn frame(ring: &Ring, thresholds: &Thresholds) -> [Coord<f64>; 4] {
    let found = oriented_box(ring);
    let [x, _] = Local::new(found).axes();
    // The box's x axis points east, within 45 degrees.
    if x.y.abs() <= thresholds.axis.sin() {
        return found;
    }
    let [width, height] = crate::plane::quad_extent(&found);
    let x = if width >= height * (1.0 - 1e-9) {
        x
    } else {
        right(x)
    };
    // Of the two ways along the longest edge the one that goes east.
    let x = if x.x < 0.0 { x * -1.0 } else { x };
    named_by(found, x, right(x) * -1.0)
}

fn distinct(corners: &[usize; 4]) -> bool {
    (0..4).all(|k| corners[k] != corners[(k + 1) % 4])
}

/// Four corners as those at (0, 0), (0, 1), (1, 1) and (1, 0) of axes.
fn quad(ring: &Ring, found: &[usize], x: Coord<f64>, y: Coord<f64>) -> Option<[usize; 4]> {
    let four: [usize; 4] = found.try_into().ok()?;
    let places = four.map(|k| ring[k]);
    quad_angles(&places)?;
    let named = named_by(places, x, y);
    let start = places.iter().position(|&p| p == named[0])?;
    Some([0, 1, 2, 3].map(|k| four[(start + k) % 4]))
}

/// Numbers sides between corners clockwise from the one that faces most against
/// `x`.
fn number_from_west(region: &mut Region, corners: &[usize], x: Coord<f64>) {
    let ring = &region.area.outer;
    let m = corners.len();
    // The land lies on the right, so that an edge faces to its left. Summed along
    // a side that is its length times how much it faces that way.
    let west = |side: usize| {
        let (a, b) = (ring[corners[side]], ring[corners[(side + 1) % m]]);
        cross(x, b - a).max(0.0) * (1.0 + cross(x, unit(b - a)))
    };
    let mut first = 0;
    for side in 1..m {
        if west(side) > west(first) * (1.0 + 1e-9) {
            first = side;
        }
    }
    let n = ring.len();
    let mut sides = vec![0; n];
    for k in 0..m {
        let side = (first + k) % m;
        let (mut at, end) = (corners[side], corners[(side + 1) % m]);
        while at != end {
            sides[at] = k;
            at = (at + 1) % n;
        }
    }
    for (edge, side) in region.edges[0].iter_mut().zip(sides) {
        edge.side = Some(side);
    }
    region.sides = m;
}

#[cfg(test)]
mod tests;
