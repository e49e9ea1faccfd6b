//! H-fields with given fluxes: those of a harmonic function known in closed
//! form, so that its crosses are the exact ones.

use crossfield::geo_types::{Coord, LineString, Polygon};
use crossfield::{Cross, Domain, Field, FieldDesign, FieldError, HarmonicField};

use crate::shapes::circle;

/// Edges of a whole circle. Each is a piece of its own, whose flux is the mean
/// of the exact one: by symmetry the difference has no part that varies more
/// slowly than from edge to edge, and dies out within a few edges of the arc.
const EDGES: usize = 96;
const RADIUS: f64 = 100.0;

/// Crosses are compared up to here: on the sectors ripples from the arc are
/// below `0.6^(2 * EDGES / 3)`, some 1e-14, there.
const COMPARED: f64 = 0.6 * RADIUS;

/// The H-field of a harmonic function by its conjugate: the flux through a
/// piece of the boundary is the difference of the conjugate between its ends.
pub(crate) struct Fluxes {
    pub(crate) harmonic: HarmonicField,
    /// The exterior ring, counter-clockwise and open; then the hole's,
    /// clockwise.
    pub(crate) outline: fn(f64) -> Polygon<f64>,
    /// How much the conjugate grows along an edge.
    pub(crate) flux: fn(Coord<f64>, Coord<f64>) -> f64,
}

impl FieldDesign for Fluxes {
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        let basis = self.harmonic.basis(domain)?;
        let outline = (self.outline)(domain.edge_length());
        let rings: Vec<&LineString<f64>> = std::iter::once(outline.exterior())
            .chain(outline.interiors())
            .collect();
        let density = |piece: &crossfield::BoundaryPiece| {
            let points = &rings[piece.ring].0;
            let count = points.len() - 1;
            let total: f64 = (piece.first_edge..piece.first_edge + piece.edges)
                .map(|k| (self.flux)(points[k % count], points[(k + 1) % count]))
                .sum();
            total / piece.length
        };
        let densities: Vec<f64> = basis.pieces().iter().map(density).collect();
        basis.field(&densities)
    }
}

/// One piece for each edge of a circle.
pub(crate) fn by_edge() -> HarmonicField {
    HarmonicField {
        max_turn_deg: 1.0,
        ..HarmonicField::default()
    }
}

fn polar(at: Coord<f64>, cut: f64) -> (f64, f64) {
    let (s, c) = cut.sin_cos();
    // The angle from `cut - pi` to `cut + pi`.
    let angle = cut + (c * at.y - s * at.x).atan2(c * at.x + s * at.y);
    (at.x.hypot(at.y), angle)
}

/// Im w^a, the conjugate of Re w^a; the angle of w is continuous but opposite
/// to `middle`.
fn conjugate(at: Coord<f64>, power: f64, middle: f64) -> f64 {
    let (r, angle) = polar(at, middle);
    (r / RADIUS).powf(power) * (power * angle).sin()
}

/// Eigenvectors of the Hessian of Re w^a, which is a multiple of w^(a - 2).
fn power_cross(at: Coord<f64>, power: f64, middle: f64) -> Option<Cross> {
    let (r, angle) = polar(at, middle);
    // No angle at a singularity, and ripples near the arc.
    (r > 10.0 && r < COMPARED).then(|| Cross::from_angle(-0.5 * (power - 2.0) * angle))
}

fn sector(span: f64) -> Polygon<f64> {
    let count = (EDGES as f64 * span / std::f64::consts::TAU).round() as usize;
    let arc = (0..=count).map(|k| {
        let (s, c) = (span * k as f64 / count as f64).sin_cos();
        (RADIUS * c, RADIUS * s)
    });
    let ring: Vec<(f64, f64)> = std::iter::once((0.0, 0.0)).chain(arc).collect();
    Polygon::new(ring.into(), vec![])
}

/// Re w^3: one singularity of index -1/2 in the middle.
pub(crate) mod disc {
    use super::*;

    pub(crate) fn outline(_: f64) -> Polygon<f64> {
        Polygon::new(
            crossfield::laws::shapes::circle(EDGES, RADIUS).into(),
            vec![],
        )
    }

    pub(crate) fn flux(from: Coord<f64>, to: Coord<f64>) -> f64 {
        conjugate(to, 3.0, 0.0) - conjugate(from, 3.0, 0.0)
    }

    pub(crate) fn exact(at: Coord<f64>) -> Option<Cross> {
        power_cross(at, 3.0, 0.0)
    }
}

/// Re w^3 between two sides at 60 degrees, without flux through them.
pub(crate) mod wedge {
    use super::*;

    const SPAN: f64 = std::f64::consts::FRAC_PI_3;

    pub(crate) fn outline(_: f64) -> Polygon<f64> {
        sector(SPAN)
    }

    pub(crate) fn flux(from: Coord<f64>, to: Coord<f64>) -> f64 {
        conjugate(to, 3.0, SPAN / 2.0) - conjugate(from, 3.0, SPAN / 2.0)
    }

    pub(crate) fn exact(at: Coord<f64>) -> Option<Cross> {
        power_cross(at, 3.0, SPAN / 2.0)
    }
}

/// Re w^(2/3) around a concave right angle, as at the corner of an L: second
/// derivatives grow as r^(-4/3) towards it.
pub(crate) mod concave {
    use super::*;

    const SPAN: f64 = 1.5 * std::f64::consts::PI;

    pub(crate) fn outline(_: f64) -> Polygon<f64> {
        sector(SPAN)
    }

    pub(crate) fn flux(from: Coord<f64>, to: Coord<f64>) -> f64 {
        conjugate(to, 2.0 / 3.0, SPAN / 2.0) - conjugate(from, 2.0 / 3.0, SPAN / 2.0)
    }

    pub(crate) fn exact(at: Coord<f64>) -> Option<Cross> {
        power_cross(at, 2.0 / 3.0, SPAN / 2.0)
    }
}

/// log r between two circles that are sampled every h.
pub(crate) mod annulus {
    use super::*;

    pub(crate) fn outline(edge_length: f64) -> Polygon<f64> {
        let mut hole = circle(40.0, edge_length);
        hole.0.reverse();
        Polygon::new(circle(RADIUS, edge_length), vec![hole])
    }

    /// The angle that the edge spans, which is also what its fluxes take in:
    /// the same for all edges of a circle.
    pub(crate) fn flux(from: Coord<f64>, to: Coord<f64>) -> f64 {
        (from.x * to.y - from.y * to.x).atan2(from.x * to.x + from.y * to.y)
    }
}

/// x^2 - y^2 on an L that is turned.
pub(crate) mod corner {
    use super::*;
    use crate::shapes::l_shape;

    const TURN: f64 = 0.3;

    fn turned(at: Coord<f64>, angle: f64) -> Coord<f64> {
        let (s, c) = angle.sin_cos();
        Coord {
            x: c * at.x - s * at.y,
            y: s * at.x + c * at.y,
        }
    }

    pub(crate) fn outline(edge_length: f64) -> Polygon<f64> {
        let mut ring = l_shape(edge_length).exterior().clone();
        ring.0.iter_mut().for_each(|p| *p = turned(*p, TURN));
        Polygon::new(ring, vec![])
    }

    pub(crate) fn flux(from: Coord<f64>, to: Coord<f64>) -> f64 {
        let conjugate = |at: Coord<f64>| {
            let own = turned(at, -TURN);
            2.0 * own.x * own.y
        };
        conjugate(to) - conjugate(from)
    }

    pub(crate) fn exact(_: Coord<f64>) -> Option<Cross> {
        Some(Cross::from_angle(TURN))
    }
}
