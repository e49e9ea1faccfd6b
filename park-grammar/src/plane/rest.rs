//! What pieces leave of an area, so that all together tile it.

use super::{difference, dist, trim, weld, Area};

/// Vertices this near, as a share of the area's size, are one.
const SAME: f64 = 1e-9;

/// Shares of an area that are rounding.
const ROUNDING: f64 = 1e-11;

/// The pieces, with the vertices that they share with each other and with the
/// whole, and what they leave of it. Pieces must lie inside and not overlap.
///
/// Booleans leave edges of a piece along those of the whole up to rounding only:
/// what is left would go along them as thin as a hair. With shared vertices
/// common edges are the same to the last bit.
pub(crate) fn rest(whole: &Area, pieces: Vec<Area>) -> (Vec<Area>, Vec<Area>) {
    let (low, high) = whole.extent();
    let tolerance = SAME * (high.x - low.x).max(high.y - low.y);
    let all: Vec<&Area> = std::iter::once(whole).chain(&pieces).collect();
    let mut welded = weld(&all, tolerance);
    let total = |areas: &[Area]| -> f64 { areas.iter().map(Area::size).sum() };
    let must = whole.size();
    // Areas too small for the tolerance have gone.
    if welded.len() == all.len() {
        let outline = welded.remove(0);
        // A piece that touches the outline in a point may leave a hair there.
        let left = trim(difference(&[outline], &welded), dist(low, high));
        if (total(&left) + total(&welded) - must).abs() <= ROUNDING * must {
            return (welded, left);
        }
    }
    let left = difference(std::slice::from_ref(whole), &pieces);
    (pieces, trim(left, dist(low, high)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::intersection;
    use geo_types::coord;

    /// Pieces cut from a slanting outline leave the strip between them, and
    /// nothing along the outline.
    #[test]
    fn nothing_is_left_along_the_outline() {
        let ring = [(0.1, 0.2), (3.7, 19.3), (31.9, 23.1), (27.3, 1.7)];
        let whole = Area::new(
            ring.map(|(x, y)| coord! { x: x, y: y }).to_vec(),
            Vec::new(),
        );
        let half = |from: f64, to: f64| {
            let ring = [(from, -9.0), (from, 40.0), (to, 40.0), (to, -9.0)];
            let plane = Area::new(
                ring.map(|(x, y)| coord! { x: x, y: y }).to_vec(),
                Vec::new(),
            );
            intersection(std::slice::from_ref(&whole), &[plane])
        };
        let mut pieces = half(-9.0, 14.0 / 3.0);
        pieces.extend(half(17.0 / 3.0, 50.0));
        let (pieces, left) = rest(&whole, pieces);
        assert_eq!((pieces.len(), left.len(), left[0].outer.len()), (2, 1, 4));
    }
}
