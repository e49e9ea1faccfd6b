//! The middle of an area, where something can stand.

use geo_types::Coord;

use super::Area;

/// The search ends at cells this small, as a share of the area's size.
const FINEST: f64 = 1e-4;

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

/// The point farthest from the boundary, to within [`FINEST`]: cells of a grid,
/// the most promising divided on (Garcia-Castellanos and Lombardo's question,
/// answered as Mapbox's polylabel does).
pub(crate) fn pole(area: &Area) -> Coord<f64> {
    let (low, high) = area.extent();
    let size = (high.x - low.x).max(high.y - low.y);
    let inside = |p: Coord<f64>| {
        let away = area.nearest(p).1;
        if area.contains(p) {
            away
        } else {
            -away
        }
    };
    let mut best = (area.centroid(), inside(area.centroid()));
    // Middle, half of the side, room at the middle.
    let mut cells = vec![(super::lerp(low, high, 0.5), 0.5 * size)];
    while let Some((_, half)) = cells.first().copied() {
        let mut next = Vec::new();
        for &(at, _) in &cells {
            let room = inside(at);
            if room > best.1 {
                best = (at, room);
            }
            next.push((at, room));
        }
        if half < FINEST * size {
            break;
        }
        // Only cells that may hold something better.
        let reach = half * std::f64::consts::SQRT_2;
        next.retain(|&(_, room)| room + reach > best.1 + FINEST * size);
        let quarter = 0.5 * half;
        cells = next
            .iter()
            .flat_map(|&(at, _)| {
                [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(x, y)| {
                    let by = Coord {
                        x: x * quarter,
                        y: y * quarter,
                    };
                    (at + by, quarter)
                })
            })
            .collect();
    }
    best.0
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
        assert!(deep.nearest(at).1 > room.max(0.5) - 1e-3);
    }
}
