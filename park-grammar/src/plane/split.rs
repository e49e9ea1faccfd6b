//! Cutting areas along straight lines.

use geo_types::Coord;

use super::{cross, dot, extent, lerp, norm, unit, Area, Ring};

/// A straight line without ends; the land that it is walked past lies on both
/// sides of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) at: Coord<f64>,
    /// Of length 1.
    pub(crate) along: Coord<f64>,
}

impl Line {
    pub(crate) fn new(at: Coord<f64>, towards: Coord<f64>) -> Self {
        Self {
            at,
            along: unit(towards),
        }
    }

    /// How far a point lies on the right.
    pub(crate) fn aside(&self, p: Coord<f64>) -> f64 {
        -cross(self.along, p - self.at)
    }

    /// The line so far to its right.
    pub(crate) fn moved(&self, aside: f64) -> Self {
        Self {
            at: self.at + super::right(self.along) * aside,
            along: self.along,
        }
    }

    /// Where two lines meet; `None` for parallel ones.
    pub(crate) fn meets(&self, other: &Self) -> Option<Coord<f64>> {
        let det = cross(self.along, other.along);
        (det.abs() > 1e-9)
            .then(|| self.at + self.along * (cross(other.at - self.at, other.along) / det))
    }
}

/// What of areas lies on the left of a line and what on its right, both at least
/// `half` away.
pub(crate) fn split(areas: &[Area], line: &Line, half: f64) -> [Vec<Area>; 2] {
    let mut sides = [Vec::new(), Vec::new()];
    for area in areas {
        for (k, found) in sides.iter_mut().enumerate() {
            let sign = if k == 0 { -1.0 } else { 1.0 };
            part(
                area,
                &|p| sign * line.aside(p) - half,
                line,
                sign,
                half,
                found,
            );
        }
    }
    sides
}

/// What of an area lies where `depth` is positive: on one side of a line.
fn part(
    area: &Area,
    depth: &dyn Fn(Coord<f64>) -> f64,
    line: &Line,
    sign: f64,
    half: f64,
    found: &mut Vec<Area>,
) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for &p in &area.outer {
        let d = depth(p);
        low = low.min(d);
        high = high.max(d);
    }
    let tiny = 1e-12 * (high - low);
    if high <= tiny {
        return;
    }
    if low >= -tiny {
        found.push(area.clone());
        return;
    }
    if area.holes.is_empty() && is_convex(&area.outer) {
        let ring = clipped(&area.outer, depth);
        let piece = Area::new(ring, Vec::new());
        if piece.outer.len() >= 3 && piece.size() > 1e-13 * (high - low).powi(2) {
            found.push(piece);
        }
        return;
    }
    // A rectangle that holds all that lies on this side.
    let (a, b) = extent(&area.outer);
    let far = 2.0 * norm(b - a) + half;
    let middle = line.at + line.along * dot(lerp(a, b, 0.5) - line.at, line.along);
    let out = super::right(line.along) * sign;
    let near = middle + out * half;
    let along = line.along * far;
    // Beyond the area's own depth, so that its far edges are not met.
    let beyond = near + out * (high + 0.1 * far);
    let plane = Area::new(
        vec![near - along, near + along, beyond + along, beyond - along],
        Vec::new(),
    );
    found.extend(super::intersection(std::slice::from_ref(area), &[plane]));
}

fn is_convex(ring: &[Coord<f64>]) -> bool {
    let n = ring.len();
    (0..n).all(|k| {
        let (a, b, c) = (ring[k], ring[(k + 1) % n], ring[(k + 2) % n]);
        cross(b - a, c - b) <= 0.0
    })
}

/// Sutherland and Hodgman's clip of a ring by one line; right for convex rings,
/// and of the right area for any.
pub(crate) fn clipped(ring: &[Coord<f64>], depth: &dyn Fn(Coord<f64>) -> f64) -> Ring {
    let mut kept = Vec::with_capacity(ring.len() + 2);
    for (a, b) in super::sides(ring) {
        let (da, db) = (depth(a), depth(b));
        if da >= 0.0 {
            kept.push(a);
        }
        if (da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0) {
            // From the same end whichever side is kept, so that both agree.
            let at = if da > 0.0 {
                lerp(a, b, da / (da - db))
            } else {
                lerp(b, a, db / (db - da))
            };
            kept.push(at);
        }
    }
    kept.dedup();
    while kept.len() > 1 && kept.first() == kept.last() {
        kept.pop();
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn total(areas: &[Area]) -> f64 {
        areas.iter().map(Area::size).sum()
    }

    #[test]
    fn a_square_is_cut_in_two() {
        let square = Area::new(
            vec![
                coord! { x: 0., y: 0. },
                coord! { x: 0., y: 4. },
                coord! { x: 4., y: 4. },
                coord! { x: 4., y: 0. },
            ],
            Vec::new(),
        );
        let line = Line::new(coord! { x: 1., y: 0. }, coord! { x: 0., y: 1. });
        let [left, right] = split(std::slice::from_ref(&square), &line, 0.0);
        assert_eq!((total(&left), total(&right)), (4.0, 12.0));
        let [left, right] = split(&[square], &line, 0.5);
        assert_eq!((total(&left), total(&right)), (2.0, 10.0));
    }

    /// A U falls into two arms above, and one piece below.
    #[test]
    fn a_concave_area_falls_apart() {
        let points = [
            (0., 0.),
            (0., 5.),
            (1., 5.),
            (1., 1.),
            (3., 1.),
            (3., 5.),
            (4., 5.),
            (4., 0.),
        ];
        let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
        let line = Line::new(coord! { x: 0., y: 2. }, coord! { x: 1., y: 0. });
        let [above, below] = split(&[Area::new(ring, Vec::new())], &line, 0.0);
        assert_eq!((above.len(), below.len()), (2, 1));
        assert!((total(&above) - 6.0).abs() < 1e-9 && (total(&below) - 6.0).abs() < 1e-9);
    }
}
