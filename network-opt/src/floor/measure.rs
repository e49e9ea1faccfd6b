//! Distances, middles and areas on the mesh of a floor.

use geo_types::Coord;

use super::on::bad;
use crate::design::Tessellation;
use crate::error::DesignError;

/// The nearest vertex of some.
pub(super) fn nearest(
    mesh: &Tessellation,
    p: Coord<f64>,
    may: &dyn Fn(usize) -> bool,
) -> Option<usize> {
    let away = |v: usize| distance(mesh.points()[v], p);
    (0..mesh.points().len())
        .filter(|&v| may(v))
        .min_by(|&a, &b| away(a).total_cmp(&away(b)).then(a.cmp(&b)))
}

/// A point whose coordinates are numbers, or the error that says whose are not.
pub(super) fn finite([x, y]: [f64; 2], what: &str) -> Result<Coord<f64>, DesignError> {
    if x.is_finite() && y.is_finite() {
        Ok(Coord { x, y })
    } else {
        bad(format!("{what} is at ({x}, {y})"))
    }
}

pub(super) fn distance(a: Coord<f64>, b: Coord<f64>) -> f64 {
    (a.x - b.x).hypot(a.y - b.y)
}

/// The mean of a face's corners.
pub(super) fn middle(mesh: &Tessellation, f: usize) -> Coord<f64> {
    let face = &mesh.faces()[f];
    let sum = face
        .iter()
        .fold(Coord { x: 0.0, y: 0.0 }, |sum, &v| sum + mesh.points()[v]);
    sum / face.len() as f64
}

/// The mean of the middles of some faces.
pub(super) fn centre(middles: &[Coord<f64>], faces: &[usize]) -> Coord<f64> {
    let sum = faces
        .iter()
        .fold(Coord { x: 0.0, y: 0.0 }, |sum, &f| sum + middles[f]);
    sum / faces.len().max(1) as f64
}

/// Square metres of a face.
pub(super) fn area(mesh: &Tessellation, f: usize) -> f64 {
    let face = &mesh.faces()[f];
    let origin = mesh.points()[face[0]];
    let at = |k: usize| mesh.points()[face[k % face.len()]] - origin;
    let twice: f64 = (0..face.len())
        .map(|k| at(k).x * at(k + 1).y - at(k).y * at(k + 1).x)
        .sum();
    0.5 * twice
}

/// Whether a point is inside a ring, open or closed; of no points nothing is.
pub(super) fn is_inside(ring: &[[f64; 2]], p: Coord<f64>) -> bool {
    let n = ring.len();
    let crosses = |k: usize| {
        let ([ax, ay], [bx, by]) = (ring[k], ring[(k + 1) % n]);
        (ay > p.y) != (by > p.y) && p.x < ax + (p.y - ay) / (by - ay) * (bx - ax)
    };
    (0..n).filter(|&k| crosses(k)).count() % 2 == 1
}
