//! The middle of an area, where something can stand.

use geo_types::Coord;

use super::{farthest, sides, Area, Segment};

/// The centre of mass where that lies inside, else the point that is farthest
/// from the boundary.
pub(crate) fn middle(area: &Area) -> Coord<f64> {
    let centroid = area.centroid();
    if area.contains(centroid) {
        centroid
    } else {
        pole(area)
    }
}

/// The point farthest from the boundary, which has the most room around it.
pub(crate) fn pole(area: &Area) -> Coord<f64> {
    let edges: Vec<Segment> = area.rings().flat_map(|ring| sides(ring)).collect();
    farthest(area, &edges).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    /// A square of 4 with a bay of 2 from the north: the centre of mass (2, 5/3)
    /// lies below the bay, but in a bay that is deep it does not lie inside.
    #[test]
    fn middles_lie_inside() {
        let bay = |depth: f64| {
            let ring = [
                (0., 0.),
                (4., 0.),
                (4., 4.),
                (3., 4.),
                (3., 4. - depth),
                (1., 4. - depth),
                (1., 4.),
                (0., 4.),
            ];
            Area::new(
                ring.map(|(x, y)| coord! { x: x, y: y }).to_vec(),
                Vec::new(),
            )
        };
        let at = middle(&bay(2.0));
        assert!((at.x - 2.0).abs() < 1e-12 && (at.y - 5.0 / 3.0).abs() < 1e-12);
        let deep = bay(3.6);
        let at = middle(&deep);
        assert!(deep.contains(at));
        // The legs are 1 wide, and their corners with the bar of 0.4 have more
        // room: the circle through the bay's corner that touches two sides.
        let room = 1.0_f64.min(0.4) / 2.0;
        assert!(deep.nearest(at).1 > room.max(0.5) - 1e-9);
    }
}
