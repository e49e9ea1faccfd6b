//! Where a block's vertices would like to be: the strip of section 6.

use crate::mesh::predicates::{dist, dot, lerp, norm, sub, P};
use geo_types::Coord;

/// A shape that a block would like to have.
///
/// Implementors must be deterministic, and should move with the block
/// (targets of a moved ring are the moved targets), or else the optimisation
/// is not place-independent. They need not be cheap: each block is asked once
/// per iteration.
pub trait TargetShape {
    /// A target for each vertex of a block, or `None` if the shape does not
    /// apply (the block then pulls at no vertex).
    ///
    /// `ring` is the block's outer loop, counter-clockwise, open (the first
    /// point not repeated); `corners` are the positions in it of the block's
    /// four corners in ring order, if it has four. The result is as long as
    /// `ring`.
    fn targets(&self, ring: &[Coord<f64>], corners: Option<[usize; 4]>) -> Option<Vec<Coord<f64>>>;

    /// May a block have this ring? A step of the optimisation that leads to a
    /// ring refused here is shortened or taken back, unless the block was
    /// refused to begin with. By default every ring is accepted.
    fn accepts(&self, ring: &[Coord<f64>], corners: Option<[usize; 4]>) -> bool {
        let _ = (ring, corners);
        true
    }
}

impl<T: TargetShape + ?Sized> TargetShape for &T {
    fn targets(&self, ring: &[Coord<f64>], corners: Option<[usize; 4]>) -> Option<Vec<Coord<f64>>> {
        (**self).targets(ring, corners)
    }
    fn accepts(&self, ring: &[Coord<f64>], corners: Option<[usize; 4]>) -> bool {
        (**self).accepts(ring, corners)
    }
}

/// The paper's target: a strip, bounded by two offset curves of one middle
/// line (section 6, "Regularity").
///
/// Of a block's two pairs of opposite sides, the one whose distance varies
/// less makes the strip. Both its sides are sampled evenly, the midpoints
/// form the middle polyline, and the target sides lie half the width to its
/// left and right; the other two sides are straight. Each vertex goes to the
/// point of the target side that has its arc-length parameter.
///
/// # Differs from the paper
///
/// - The width is measured across the middle line, not between samples: for a
///   skewed block that keeps the area, where the paper's would grow it.
/// - Normals are those of the circle through three neighbouring midpoints, so
///   that evenly sampled circular strips are fixed points exactly.
/// - The number of samples, left open there, is that of the side with more
///   edges, at least 8.
#[derive(Clone, Debug, PartialEq)]
pub struct StripFit {
    /// Preferred width of a strip, metres (twice a parcel's depth, measured
    /// between street centres). Used where the block's own width is within a
    /// factor of 1.5 of it; `None` keeps each block's own mean width.
    ///
    /// Default value: `None`.
    pub width: Option<f64>,
}

impl StripFit {
    /// How far a block's own width may be from the preferred one for the
    /// preference to count: beyond it, it is a strip of another kind.
    const REACH: f64 = 1.5;
    /// Fewest intervals to sample a side in.
    const SAMPLES: usize = 8;

    /// The strip of the paper, with each block's own width.
    #[must_use]
    pub const fn new() -> Self {
        Self { width: None }
    }
}

impl Default for StripFit {
    fn default() -> Self {
        Self::new()
    }
}

impl TargetShape for StripFit {
    fn targets(&self, ring: &[Coord<f64>], corners: Option<[usize; 4]>) -> Option<Vec<Coord<f64>>> {
        let corners = corners?;
        let n = ring.len();
        if n < 4 || corners.iter().any(|&c| c >= n) {
            return None;
        }
        // The four sides as positions in the ring, corner to corner.
        let sides: Vec<Vec<usize>> = (0..4)
            .map(|k| {
                let (from, to) = (corners[k], corners[(k + 1) % 4]);
                let count = (to + n - from) % n;
                (0..=count).map(|i| (from + i) % n).collect()
            })
            .collect();
        if sides.iter().any(|s| s.len() < 2)
            || sides.iter().map(|s| s.len() - 1).sum::<usize>() != n
        {
            return None;
        }
        let line = |k: usize| -> Vec<P> { sides[k].iter().map(|&i| ring[i]).collect() };
        let pair = |k: usize| -> Option<Pair> {
            let (right, mut left) = (line(k), line(k + 2));
            left.reverse();
            let count = right.len().max(left.len()).max(Self::SAMPLES + 1) - 1;
            Pair::new(&right, &left, count)
        };
        // Within rounding of each other the longer pair wins.
        let (a, b) = (pair(0)?, pair(1)?);
        let slack = 1e-9 * (a.length + b.length);
        let second = if (a.deviation - b.deviation).abs() <= slack {
            b.length > a.length
        } else {
            b.deviation < a.deviation
        };
        let (k, pair) = if second { (1, b) } else { (0, a) };
        let width = match self.width {
            Some(w) if w < pair.width * Self::REACH && w * Self::REACH > pair.width => w,
            _ => pair.width,
        };
        let (right, left) = pair.offset(width);

        let mut out = ring.to_vec();
        let last = right.len() - 1;
        let mut place = |side: &[usize], target: &[P]| -> Option<()> {
            let own: Vec<P> = side.iter().map(|&i| ring[i]).collect();
            for (t, &i) in parameters(&own)?.into_iter().zip(side) {
                out[i] = at_parameter(target, t)?;
            }
            Some(())
        };
        let backwards: Vec<P> = left.iter().rev().copied().collect();
        place(&sides[(k + 1) % 4], &[right[last], left[last]])?;
        place(&sides[(k + 3) % 4], &[left[0], right[0]])?;
        place(&sides[k], &right)?;
        place(&sides[k + 2], &backwards)?;
        Some(out)
    }
}

/// A pair of opposite sides, sampled evenly in the same direction.
struct Pair {
    middle: Vec<P>,
    /// Unit normals of the middle line, pointing to its left.
    normals: Vec<P>,
    /// Standard deviation of the distances between opposite samples.
    deviation: f64,
    /// Mean distance across the middle line.
    width: f64,
    /// Length of the middle line.
    length: f64,
}

impl Pair {
    fn new(right: &[P], left: &[P], count: usize) -> Option<Self> {
        let (right, left) = (sample(right, count)?, sample(left, count)?);
        let middle: Vec<P> = right
            .iter()
            .zip(&left)
            .map(|(&a, &b)| lerp(a, b, 0.5))
            .collect();
        let length: f64 = middle.windows(2).map(|w| dist(w[0], w[1])).sum();
        let gaps: Vec<f64> = right.iter().zip(&left).map(|(&a, &b)| dist(a, b)).collect();
        let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
        let deviation =
            (gaps.iter().map(|g| (g - mean).powi(2)).sum::<f64>() / gaps.len() as f64).sqrt();
        let normals = normals(&middle)?;
        let width = right
            .iter()
            .zip(&left)
            .zip(&normals)
            .map(|((&a, &b), &n)| dot(sub(b, a), n))
            .sum::<f64>()
            / gaps.len() as f64;
        // A block turned inside out has no strip.
        (width > 1e-9 * (length + mean)).then_some(Self {
            middle,
            normals,
            deviation,
            width,
            length,
        })
    }

    /// The curves half of `width` to the right and the left of the middle.
    fn offset(&self, width: f64) -> (Vec<P>, Vec<P>) {
        let side = |d: f64| {
            let shift = |(m, n): (&P, &P)| P {
                x: m.x + d * n.x,
                y: m.y + d * n.y,
            };
            self.middle.iter().zip(&self.normals).map(shift).collect()
        };
        (side(-width / 2.0), side(width / 2.0))
    }
}

/// Unit left normals of a polyline at its points: of the circle through the
/// point and its two neighbours (at the ends, through the first three).
///
/// By inversion about the point, the circle becomes a line along its tangent:
/// the images of the neighbours, at d / |d|^2, span it.
fn normals(line: &[P]) -> Option<Vec<P>> {
    let inverse = |d: P| {
        let d2 = dot(d, d);
        (d2 > 0.0).then(|| P {
            x: d.x / d2,
            y: d.y / d2,
        })
    };
    let unit = |t: P| {
        let l = norm(t);
        (l > 0.0 && l.is_finite()).then(|| P {
            x: -t.y / l,
            y: t.x / l,
        })
    };
    let n = line.len();
    let at_end = |p: P, q: P, r: P| -> Option<P> {
        let (d, e) = (sub(q, p), sub(r, p));
        let fitted = sub(inverse(d)?, inverse(e)?);
        // A fold right at the end has no sensible circle: use the chord.
        unit(if dot(fitted, d) > 0.5 * norm(fitted) * norm(d) {
            fitted
        } else {
            d
        })
    };
    if n == 2 {
        let normal = unit(sub(line[1], line[0]))?;
        return Some(vec![normal; 2]);
    }
    let mut all = Vec::with_capacity(n);
    for i in 0..n {
        all.push(if i == 0 {
            at_end(line[0], line[1], line[2])?
        } else if i + 1 == n {
            let m = at_end(line[n - 1], line[n - 2], line[n - 3])?;
            P { x: -m.x, y: -m.y }
        } else {
            let (a, b) = (
                inverse(sub(line[i], line[i - 1]))?,
                inverse(sub(line[i + 1], line[i]))?,
            );
            unit(P {
                x: a.x + b.x,
                y: a.y + b.y,
            })?
        });
    }
    Some(all)
}

/// Arc-length parameters of a polyline's points, 0 to 1.
fn parameters(line: &[P]) -> Option<Vec<f64>> {
    let mut at = 0.0;
    let mut all = vec![0.0];
    for w in line.windows(2) {
        at += dist(w[0], w[1]);
        all.push(at);
    }
    if !(at > 0.0 && at.is_finite()) {
        return None;
    }
    all.iter_mut().for_each(|t| *t /= at);
    if let Some(last) = all.last_mut() {
        *last = 1.0;
    }
    Some(all)
}

/// The point of a polyline at an arc-length parameter.
fn at_parameter(line: &[P], t: f64) -> Option<P> {
    let all = parameters(line)?;
    let i = all.partition_point(|&s| s <= t).clamp(1, line.len() - 1);
    let span = all[i] - all[i - 1];
    let local = if span > 0.0 {
        (t - all[i - 1]) / span
    } else {
        1.0
    };
    Some(lerp(line[i - 1], line[i], local))
}

/// `count + 1` points of a polyline, evenly spaced along it.
fn sample(line: &[P], count: usize) -> Option<Vec<P>> {
    let all = parameters(line)?;
    let mut i = 1;
    let mut out = Vec::with_capacity(count + 1);
    for k in 0..=count {
        let t = k as f64 / count as f64;
        while i + 1 < line.len() && all[i] < t {
            i += 1;
        }
        let span = all[i] - all[i - 1];
        let local = if span > 0.0 {
            ((t - all[i - 1]) / span).clamp(0.0, 1.0)
        } else {
            1.0
        };
        out.push(lerp(line[i - 1], line[i], local));
    }
    Some(out)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::mesh::predicates::cross;
    use geo_types::coord;

    fn p(x: f64, y: f64) -> P {
        coord! { x: x, y: y }
    }

    #[test]
    fn a_rectangle_is_its_own_strip() {
        let ring = [
            p(0., 0.),
            p(30., 0.),
            p(100., 0.),
            p(100., 40.),
            p(50., 40.),
            p(0., 40.),
            p(0., 20.),
        ];
        let got = StripFit::new().targets(&ring, Some([0, 2, 3, 5])).unwrap();
        for (a, b) in ring.iter().zip(&got) {
            assert!(dist(*a, *b) < 1e-12, "{a:?} {b:?}");
        }
    }

    #[test]
    fn a_preferred_width_counts_where_it_is_near() {
        let ring = [p(0., 0.), p(100., 0.), p(100., 40.), p(0., 40.)];
        let near = StripFit { width: Some(50.0) }
            .targets(&ring, Some([0, 1, 2, 3]))
            .unwrap();
        assert!(dist(near[0], p(0., -5.)) < 1e-12 && dist(near[2], p(100., 45.)) < 1e-12);
        let far = StripFit { width: Some(90.0) }
            .targets(&ring, Some([0, 1, 2, 3]))
            .unwrap();
        assert!(dist(far[0], ring[0]) < 1e-12);
    }

    #[test]
    fn a_circular_strip_is_its_own_strip() {
        let at = |r: f64, a: f64| p(r * a.cos(), r * a.sin());
        let angles: Vec<f64> = (0..=12).map(|i| 0.3 + 0.1 * f64::from(i)).collect();
        let mut ring: Vec<P> = angles.iter().map(|&a| at(140.0, a)).collect();
        ring.extend(angles.iter().rev().map(|&a| at(100.0, a)));
        let got = StripFit::new()
            .targets(&ring, Some([0, 12, 13, 25]))
            .unwrap();
        for (a, b) in ring.iter().zip(&got) {
            assert!(dist(*a, *b) < 1e-9, "{a:?} {b:?}");
        }
    }

    #[test]
    fn without_four_proper_corners_there_is_none() {
        let ring = [p(0., 0.), p(100., 0.), p(100., 40.), p(0., 40.)];
        let fit = StripFit::new();
        assert!(fit.targets(&ring, None).is_none());
        assert!(fit.targets(&ring, Some([0, 2, 1, 3])).is_none());
        assert!(fit.targets(&ring, Some([0, 1, 2, 9])).is_none());
        assert!(fit.targets(&[p(1., 1.); 4], Some([0, 1, 2, 3])).is_none());
    }

    #[test]
    fn a_taper_becomes_parallel() {
        let ring = [p(0., 0.), p(100., 5.), p(100., 35.), p(0., 40.)];
        let got = StripFit::new().targets(&ring, Some([0, 1, 2, 3])).unwrap();
        let lower = sub(got[1], got[0]);
        assert!(cross(lower, sub(got[2], got[3])).abs() < 1e-9);
        assert!(dot(lower, sub(got[3], got[0])).abs() < 1e-9);
        assert!((dist(got[0], got[3]) - 35.0).abs() < 1e-9);
    }
}
