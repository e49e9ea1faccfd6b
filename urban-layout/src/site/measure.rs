//! Rings and lines measured and tidied: bounds, centroid, length, repeats.

use geo_types::{Coord, LineString, Polygon};

use super::boolean::{area, open};
use super::ring::{Cleaned, ROUNDING};

/// The edges of an open ring, the closing one last.
pub(crate) fn edges(points: &[Coord<f64>]) -> impl Iterator<Item = (Coord<f64>, Coord<f64>)> + '_ {
    let next = points.iter().skip(1).chain(points.first());
    points.iter().copied().zip(next.copied())
}

/// The corners of the bounding box.
pub(crate) fn bounds(points: &[Coord<f64>]) -> (Coord<f64>, Coord<f64>) {
    let (mut low, mut high) = (
        Coord {
            x: f64::INFINITY,
            y: f64::INFINITY,
        },
        Coord {
            x: f64::NEG_INFINITY,
            y: f64::NEG_INFINITY,
        },
    );
    for p in points {
        low = Coord {
            x: low.x.min(p.x),
            y: low.y.min(p.y),
        };
        high = Coord {
            x: high.x.max(p.x),
            y: high.y.max(p.y),
        };
    }
    (low, high)
}

/// The area-weighted centroid of polygons; `None` when they have no area.
pub(crate) fn centroid(polygons: &[Polygon<f64>]) -> Option<Coord<f64>> {
    let origin = polygons.first()?.exterior().0.first().copied()?;
    let (mut weight, mut moment) = (0.0, Coord { x: 0.0, y: 0.0 });
    for polygon in polygons {
        let rings = std::iter::once((polygon.exterior(), 1.0))
            .chain(polygon.interiors().iter().map(|ring| (ring, -1.0)));
        for (ring, sign) in rings {
            let (own, first) = moments(open(ring), origin);
            // Rings count by what they enclose, however they are wound.
            let sign = sign * own.signum();
            weight += sign * own;
            moment = moment + first * sign;
        }
    }
    let found = origin + moment / (3.0 * weight);
    (weight > 0.0 && found.x.is_finite() && found.y.is_finite()).then_some(found)
}

/// Doubled area and six-fold first moment of an open ring about a point.
fn moments(ring: &[Coord<f64>], origin: Coord<f64>) -> (f64, Coord<f64>) {
    let mut sums = (0.0, Coord { x: 0.0, y: 0.0 });
    for (a, b) in edges(ring) {
        let (a, b) = (a - origin, b - origin);
        let cross = a.x * b.y - a.y * b.x;
        sums.0 += cross;
        sums.1 = sums.1 + (a + b) * cross;
    }
    sums
}

/// A line in local metres without repeated vertices and out-and-back spikes.
pub(crate) fn clean_line(points: Vec<Coord<f64>>) -> (Vec<Coord<f64>>, Cleaned) {
    let tolerance = ROUNDING * super::ring::extent(&points);
    let mut cleaned = Cleaned::default();
    let mut kept: Vec<Coord<f64>> = Vec::with_capacity(points.len());
    for p in points {
        loop {
            if let Some(&last) = kept.last() {
                let v = p - last;
                if v.x.hypot(v.y) <= tolerance {
                    cleaned.duplicates += 1;
                    break;
                }
                if let [.., before, _] = kept.as_slice() {
                    let u = last - *before;
                    let (lu, lv) = (u.x.hypot(u.y), v.x.hypot(v.y));
                    let cross = (u.x * v.y - u.y * v.x).abs();
                    let back = u.x * v.x + u.y * v.y < 0.0 && cross <= tolerance * lu.max(lv);
                    if back {
                        cleaned.spikes += 1;
                        kept.pop();
                        continue;
                    }
                }
            }
            kept.push(p);
            break;
        }
    }
    (kept, cleaned)
}

/// The length of a line.
pub(crate) fn length(points: &[Coord<f64>]) -> f64 {
    points
        .windows(2)
        .map(|w| (w[1] - w[0]).x.hypot((w[1] - w[0]).y))
        .sum()
}

/// All rings of polygons, closed.
pub(crate) fn rings(polygons: &[Polygon<f64>]) -> impl Iterator<Item = &LineString<f64>> {
    polygons
        .iter()
        .flat_map(|polygon| std::iter::once(polygon.exterior()).chain(polygon.interiors()))
}

/// Drops what is too small to be land: rounding along a common edge.
pub(crate) fn without_slivers(mut polygons: Vec<Polygon<f64>>, least: f64) -> Vec<Polygon<f64>> {
    polygons.retain(|polygon| area(polygon) > least);
    polygons
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
pub(crate) mod tests {
    use super::*;

    /// A closed ring.
    pub(crate) fn ring(points: &[(f64, f64)]) -> Vec<Coord<f64>> {
        let mut ring: Vec<_> = points.iter().map(|&(x, y)| Coord { x, y }).collect();
        ring.push(ring[0]);
        ring
    }

    pub(crate) fn square(x: f64, y: f64, s: f64) -> Vec<Coord<f64>> {
        ring(&[(x, y), (x + s, y), (x + s, y + s), (x, y + s)])
    }

    #[test]
    fn the_centroid_knows_holes_and_windings() {
        let mut hole = square(1.0, 1.0, 1.0);
        for _ in 0..2 {
            let polygon = Polygon::new(LineString(square(0.0, 0.0, 3.0)), vec![]);
            let pierced = Polygon::new(polygon.exterior().clone(), vec![LineString(hole.clone())]);
            let c = centroid(&[pierced]).unwrap();
            assert!((c.x - 1.5).abs() < 1e-12 && (c.y - 1.5).abs() < 1e-12);
            hole.reverse();
        }
    }

    #[test]
    fn lines_lose_repeats_and_spikes() {
        let line = [
            (0.0, 0.0),
            (5.0, 0.0),
            (5.0, 0.0),
            (9.0, 0.0),
            (5.0, 0.0),
            (5.0, 7.0),
        ];
        let (line, cleaned) = clean_line(line.map(|(x, y)| Coord { x, y }).to_vec());
        assert_eq!(line.len(), 3);
        assert!(cleaned.spikes == 1 && cleaned.duplicates >= 1);
    }
}
