//! Where a block's vertices would like to be: the strip of section 6.

use crate::mesh::predicates::{cross, dist, dot, lerp, norm, sub, P};
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
/// less along its length makes the strip. Both its sides are sampled evenly, the midpoints
/// form the middle polyline, and the target sides lie half the width to its
/// left and right; the other two sides are straight. Each vertex goes to the
/// point of the target side that has its arc-length parameter.
///
/// # Differs from the paper
///
/// - The pair is chosen by the deviation of its distance over its length.
///   By the bare deviation, a long block with a slight wobble everywhere may
///   be taken for a strip across, as wide as the block is long.
/// - The width is measured across the middle line, not between samples: for a
///   skewed block that keeps the area, where the paper's would grow it.
/// - Normals (not specified there) are fitted over a width of the strip.
///   Evenly sampled circular strips are fixed points exactly; normals from
///   neighbouring samples would be so too, but turn a wobble of one vertex
///   into a larger one of the target, so that refitting diverges.
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
        let (ta, tb) = (a.deviation / a.length, b.deviation / b.length);
        let second = if (ta - tb).abs() <= 1e-9 {
            b.length > a.length
        } else {
            tb < ta
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
            let along = parameters(target)?;
            for (t, &i) in parameters(&own)?.into_iter().zip(side) {
                out[i] = at_parameter(target, &along, t);
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
        // Directions are taken over about a width of the strip.
        let reach = (0.5 * mean / length * count as f64)
            .round()
            .min(count as f64) as usize;
        let normals = normals(&middle, reach)?;
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

/// Unit left normals of an evenly sampled polyline at its points.
///
/// The direction at a point is that of a line fitted (least squares) to the
/// directions of the chords around it, over their number: exact on straight
/// lines and on circles, whose chords turn evenly, and steady where single
/// points are off, which a difference of neighbours is not. The window is
/// `reach` chords to each side; at the ends it is as long, but one-sided.
fn normals(line: &[P], reach: usize) -> Option<Vec<P>> {
    let chords = line.len().checked_sub(1).filter(|&n| n > 0)?;
    // Directions of the chords, unwrapped.
    let mut angles = Vec::with_capacity(chords);
    let mut last: Option<P> = None;
    for w in line.windows(2) {
        let d = sub(w[1], w[0]);
        if !(norm(d) > 0.0 && norm(d).is_finite()) {
            return None;
        }
        let angle = match (last, angles.last()) {
            (Some(l), Some(&a)) => a + cross(l, d).atan2(dot(l, d)),
            _ => d.y.atan2(d.x),
        };
        angles.push(angle);
        last = Some(d);
    }
    let span = (2 * reach.max(1)).min(chords);
    let normal = |i: usize| {
        let from = i.saturating_sub(span / 2).min(chords - span);
        let window = &angles[from..from + span];
        // Chord k of the window has its middle at k + 1/2; the point is at
        // i - from. The regression through the window's centre.
        let centre = span as f64 / 2.0;
        let mean = window.iter().sum::<f64>() / span as f64;
        let (mut top, mut bottom) = (0.0, 0.0);
        for (k, a) in window.iter().enumerate() {
            let x = k as f64 + 0.5 - centre;
            top += x * (a - mean);
            bottom += x * x;
        }
        let slope = if bottom > 0.0 { top / bottom } else { 0.0 };
        let (sin, cos) = (mean + slope * ((i - from) as f64 - centre)).sin_cos();
        P { x: -sin, y: cos }
    };
    Some((0..line.len()).map(normal).collect())
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

/// The point of a polyline at an arc-length parameter, given those of its
/// points.
fn at_parameter(line: &[P], all: &[f64], t: f64) -> P {
    let i = all.partition_point(|&s| s <= t).clamp(1, line.len() - 1);
    let span = all[i] - all[i - 1];
    let local = if span > 0.0 {
        (t - all[i - 1]) / span
    } else {
        1.0
    };
    lerp(line[i - 1], line[i], local)
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
