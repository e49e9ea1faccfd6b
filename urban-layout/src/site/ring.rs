//! One ring cleaned: repeated vertices, collinear ones and spikes.

use geo_types::Coord;

use super::measure::bounds;

/// A ring on its way in: local coordinates, open (the first vertex is not
/// repeated), each vertex with its position in the file's ring.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Ring {
    pub(crate) points: Vec<Coord<f64>>,
    pub(crate) source: Vec<usize>,
}

/// How many vertices of each sort were dropped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cleaned {
    pub(crate) duplicates: usize,
    pub(crate) collinear: usize,
    pub(crate) spikes: usize,
}

/// Deviations below this part of the extent are rounding: a nanometre per metre,
/// under the 1e-9 degrees to which careful files are written.
pub(crate) const ROUNDING: f64 = 1e-9;

/// The sine below which three vertices are collinear. The sides of a circle of
/// 1e5 vertices turn by 6e-5, so no curve is ever straightened.
const STRAIGHT: f64 = 1e-9;

impl Ring {
    /// The doubled signed area, positive when counter-clockwise.
    pub(crate) fn doubled_area(&self) -> f64 {
        doubled_area(&self.points)
    }

    /// The diagonal of the bounding box.
    pub(crate) fn extent(&self) -> f64 {
        extent(&self.points)
    }

    /// Drops repeated vertices, spikes and exactly collinear vertices, so that
    /// every vertex left is a corner. The outline moves by at most [`ROUNDING`]
    /// times its extent, beyond which nothing is dropped.
    ///
    /// Spikes nest (out, out farther, back, back), so this is a stack: each
    /// vertex is tried against the two before it until nothing more falls off.
    pub(crate) fn clean(&mut self) -> Cleaned {
        let tolerance = ROUNDING * self.extent();
        let mut cleaned = Cleaned::default();
        let mut stack = Vec::with_capacity(self.points.len());
        for (k, &at) in self.points.iter().enumerate() {
            let vertex = Vertex {
                at,
                source: self.source[k],
                drift: 0.0,
            };
            push(&mut stack, vertex, tolerance, &mut cleaned);
        }
        close(&mut stack, tolerance, &mut cleaned);
        self.points = stack.iter().map(|v| v.at).collect();
        self.source = stack.iter().map(|v| v.source).collect();
        cleaned
    }
}

/// A vertex kept so far.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    at: Coord<f64>,
    source: usize,
    /// How far vertices dropped from the edge that ends here may lie off it.
    drift: f64,
}

/// What the middle one of three vertices is.
enum Middle {
    Corner,
    /// Drop it; the edge over it lies within this distance of the outline.
    Duplicate(f64),
    Collinear(f64),
    Spike(f64),
}

/// `before` and `after` are the vertices beside `middle`.
fn judge(before: &Vertex, middle: &Vertex, after: &Vertex, tolerance: f64) -> Middle {
    let (u, v) = (middle.at - before.at, after.at - middle.at);
    let (lu, lv) = (u.x.hypot(u.y), v.x.hypot(v.y));
    let drift = middle.drift.max(after.drift);
    let allowed = |by: f64| drift + by <= tolerance;
    if lu <= tolerance {
        return Middle::Duplicate(drift);
    }
    if lv <= tolerance {
        // Left to the next vertex, which is the duplicate of this one.
        return Middle::Corner;
    }
    let cross = (u.x * v.y - u.y * v.x).abs();
    let dot = u.x * v.x + u.y * v.y;
    if dot > 0.0 {
        // The distance of the middle from the chord.
        let w = after.at - before.at;
        let height = cross / w.x.hypot(w.y);
        if cross <= STRAIGHT * lu * lv && allowed(height) {
            return Middle::Collinear(drift + height);
        }
    } else {
        // The distance between the way out and the way back at their open end.
        let height = cross / lu.max(lv);
        if allowed(height) {
            return Middle::Spike(drift + height);
        }
    }
    Middle::Corner
}

fn count(middle: &Middle, cleaned: &mut Cleaned) {
    match middle {
        Middle::Corner => {}
        Middle::Duplicate(_) => cleaned.duplicates += 1,
        Middle::Collinear(_) => cleaned.collinear += 1,
        Middle::Spike(_) => cleaned.spikes += 1,
    }
}

/// Adds a vertex, dropping whatever it shows to be no corner.
fn push(stack: &mut Vec<Vertex>, mut vertex: Vertex, tolerance: f64, cleaned: &mut Cleaned) {
    let mut spiked = false;
    loop {
        if let Some(last) = stack.last() {
            let d = vertex.at - last.at;
            if d.x.hypot(d.y) <= tolerance {
                // The way back of a spike ends where it began: no fault of its own.
                cleaned.duplicates += usize::from(!spiked);
                return;
            }
        }
        let [.., before, middle] = stack.as_slice() else {
            break;
        };
        let middle = judge(before, middle, &vertex, tolerance);
        match middle {
            Middle::Corner => break,
            Middle::Duplicate(drift) | Middle::Collinear(drift) | Middle::Spike(drift) => {
                count(&middle, cleaned);
                spiked |= matches!(middle, Middle::Spike(_));
                vertex.drift = drift;
                stack.pop();
            }
        }
    }
    stack.push(vertex);
}

/// Cleans across the seam between the last vertex and the first.
fn close(stack: &mut Vec<Vertex>, tolerance: f64, cleaned: &mut Cleaned) {
    let mut start = 0;
    let mut spiked = false;
    while stack.len() - start >= 3 {
        let n = stack.len();
        let (first, second) = (stack[start], stack[start + 1]);
        let (last, previous) = (stack[n - 1], stack[n - 2]);
        let d = first.at - last.at;
        if d.x.hypot(d.y) <= tolerance {
            cleaned.duplicates += usize::from(!spiked);
            stack.pop();
            continue;
        }
        let middle = judge(&previous, &last, &first, tolerance);
        if let Middle::Duplicate(drift) | Middle::Collinear(drift) | Middle::Spike(drift) = middle {
            count(&middle, cleaned);
            spiked |= matches!(middle, Middle::Spike(_));
            stack[start].drift = drift;
            stack.pop();
            continue;
        }
        let middle = judge(&last, &first, &second, tolerance);
        if let Middle::Duplicate(drift) | Middle::Collinear(drift) | Middle::Spike(drift) = middle {
            count(&middle, cleaned);
            spiked |= matches!(middle, Middle::Spike(_));
            stack[start + 1].drift = drift;
            start += 1;
            continue;
        }
        break;
    }
    stack.drain(..start);
}

/// The doubled signed area of an open ring, relative to its first vertex.
pub(crate) fn doubled_area(points: &[Coord<f64>]) -> f64 {
    let Some(&origin) = points.first() else {
        return 0.0;
    };
    points
        .windows(2)
        .map(|w| {
            let (a, b) = (w[0] - origin, w[1] - origin);
            a.x * b.y - a.y * b.x
        })
        .sum()
}

/// The diagonal of the bounding box.
pub(crate) fn extent(points: &[Coord<f64>]) -> f64 {
    if points.is_empty() {
        return 0.0;
    }
    let (low, high) = bounds(points);
    (high.x - low.x).hypot(high.y - low.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Ring {
        Ring {
            points: points.iter().map(|&(x, y)| Coord { x, y }).collect(),
            source: (0..points.len()).collect(),
        }
    }

    fn cleaned(points: &[(f64, f64)]) -> (Vec<usize>, Cleaned) {
        let mut ring = ring(points);
        let cleaned = ring.clean();
        (ring.source, cleaned)
    }

    #[test]
    fn corners_stay() {
        let (kept, cleaned) = cleaned(&[(0.0, 0.0), (100.0, 0.0), (100.0, 50.0), (0.0, 50.0)]);
        assert_eq!(kept, [0, 1, 2, 3]);
        assert_eq!(cleaned, Cleaned::default());
    }

    #[test]
    fn duplicates_collinear_and_spikes_go_also_across_the_seam() {
        let points = [
            (50.0, 0.0), // collinear across the seam
            (100.0, 0.0),
            (100.0, 0.0), // duplicate
            (100.0, 50.0),
            (150.0, 50.0), // nested spike
            (200.0, 50.0),
            (150.0, 50.0),
            (100.0, 50.0),
            (40.0, 50.0), // collinear
            (0.0, 50.0),
            (0.0, 0.0),
            (0.0, -20.0), // spike
            (0.0, 0.0),
        ];
        let (kept, cleaned) = cleaned(&points);
        // Of two equal vertices either may stay.
        assert!(kept == [1, 3, 9, 10] || kept == [1, 3, 9, 12], "{kept:?}");
        assert_eq!((cleaned.collinear, cleaned.spikes), (4, 3));
    }

    #[test]
    fn a_ring_that_is_all_spike_vanishes() {
        let (kept, _) = cleaned(&[(0.0, 0.0), (10.0, 0.0), (20.0, 0.0), (10.0, 0.0)]);
        assert!(kept.len() < 3);
        let (kept, _) = cleaned(&[(5.0, 5.0); 6]);
        assert!(kept.len() < 3);
    }

    #[test]
    fn a_fine_circle_keeps_all_its_vertices() {
        let n = 100_000;
        let points: Vec<(f64, f64)> = (0..n)
            .map(|k| {
                let angle = f64::from(k) / f64::from(n) * std::f64::consts::TAU;
                (1000.0 * angle.cos(), 1000.0 * angle.sin())
            })
            .collect();
        let (kept, cleaned) = cleaned(&points);
        assert_eq!(kept.len(), points.len());
        assert_eq!(cleaned, Cleaned::default());
    }

    #[test]
    fn the_area_stays_to_nine_digits() {
        let mut points = vec![(0.0, 0.0), (800.0, 123.4), (700.0, 600.0), (20.0, 580.0)];
        let before = ring(&points).doubled_area();
        // Vertices within 1e-8 m of an edge, and a spike not quite closed.
        points.insert(1, (400.0, 61.7 + 1e-8));
        points.insert(4, (1500.0, 1000.0));
        points.insert(5, (700.0, 600.0 - 1e-8));
        let mut noisy = ring(&points);
        noisy.clean();
        assert_eq!(noisy.points.len(), 4);
        assert!((noisy.doubled_area() - before).abs() < 1e-9 * before);
    }
}
