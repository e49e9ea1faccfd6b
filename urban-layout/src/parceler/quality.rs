//! What makes a parcel good: corners, box, size, frontage, as one cost.
//!
//! The corner deviation and the box ratio are those of the paper's section 7,
//! with the corner rule of the certificate: vertices that turn by less than
//! half a degree are dropped first, then a corner is a vertex that turns by
//! more than 20 degrees, and a reflex right angle is a right angle.

use super::geom::{cross, dist, dot, norm, P};
use super::ParcelOptions;

/// Tangent of half a degree: below it a vertex counts as straight.
const STRAIGHT: f64 = 0.008_726_867_790_758_93;
/// Cosine of 20 degrees: above it a vertex is no corner.
const CORNER_COS: f64 = 0.939_692_620_785_908_4;
/// A parcel is bad above this mean corner deviation, degrees.
pub(super) const BAD_DEVIATION: f64 = 15.0;
/// A parcel is bad above this ratio of box to area.
pub(super) const BAD_RATIO: f64 = 1.2;

/// What a piece measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quality {
    /// Square metres.
    pub(super) area: f64,
    /// Mean deviation of the corners from a right angle, degrees.
    pub(super) deviation: f64,
    /// Area of the smallest rotated rectangle over the area, at least 1.
    pub(super) ratio: f64,
    /// Long side of that rectangle over the short one.
    pub(super) aspect: f64,
    /// Metres of edges that give access.
    pub(super) frontage: f64,
}

impl Quality {
    /// Whether the certificate calls the parcel undesirable.
    pub(super) fn is_bad(&self) -> bool {
        self.deviation > BAD_DEVIATION || self.ratio > BAD_RATIO
    }
}

/// Buffers that are reused from one measurement to the next.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    clean: Vec<P>,
    hull: Vec<P>,
}

/// Measures a ring; `front[i]` says whether edge i gives access.
///
/// The search lives on this function: a convex ring is its own hull, and the
/// corners' angles need no arc tangents.
pub(super) fn measure(ring: &[P], front: &[bool], scratch: &mut Scratch) -> Quality {
    let n = ring.len();
    let mut frontage = 0.0;
    let (o, mut twice) = (ring[0], 0.0);
    for i in 0..n {
        let next = ring[if i + 1 < n { i + 1 } else { 0 }];
        if front[i] {
            frontage += dist(ring[i], next);
        }
        twice += cross(ring[i] - o, next - o);
    }
    let area = 0.5 * twice;
    clean(ring, &mut scratch.clean);
    let (deviation, convex) = corners(&scratch.clean);
    let (box_area, aspect) = if convex {
        smallest_box(&scratch.clean)
    } else {
        hull(&mut scratch.clean, &mut scratch.hull);
        smallest_box(&scratch.hull)
    };
    let ratio = if area > 0.0 {
        (box_area / area).max(1.0)
    } else {
        f64::INFINITY
    };
    Quality {
        area,
        deviation,
        ratio,
        aspect,
        frontage,
    }
}

/// Copies the ring without its straight vertices.
fn clean(ring: &[P], out: &mut Vec<P>) {
    out.clear();
    out.extend_from_slice(ring);
    let straight = |a: P, b: P, c: P| {
        let (u, v) = (b - a, c - b);
        let (x, d) = (cross(u, v), dot(u, v));
        (d > 0.0 && x.abs() < STRAIGHT * d) || dot(v, v) < 1e-12 || dot(u, u) < 1e-12
    };
    // Each removal changes its neighbours' turns, so go round until none is
    // left; rings are short and most passes find nothing.
    loop {
        let before = out.len();
        let mut i = 0;
        while i < out.len() && out.len() > 3 {
            let m = out.len();
            let (a, c) = (
                if i > 0 { i - 1 } else { m - 1 },
                if i + 1 < m { i + 1 } else { 0 },
            );
            if straight(out[a], out[i], out[c]) {
                out.remove(i);
            } else {
                i += 1;
            }
        }
        if out.len() == before {
            return;
        }
    }
}

/// Mean deviation of the corners of a cleaned ring from a right angle,
/// degrees, and whether the ring is convex.
fn corners(ring: &[P]) -> (f64, bool) {
    let n = ring.len();
    let (mut sum, mut count, mut convex, mut turning) = (0.0, 0usize, true, 0usize);
    let mut u = ring[0] - ring[n - 1];
    let mut lu = norm(u);
    for i in 0..n {
        let v = ring[if i + 1 < n { i + 1 } else { 0 }] - ring[i];
        let lv = norm(v);
        let c = dot(u, v);
        if cross(u, v) < 0.0 {
            convex = false;
        }
        // Turning by more than a right angle three times at most: else the
        // ring winds more than once and is not convex after all.
        turning += usize::from(c < 0.0);
        if c <= CORNER_COS * lu * lv {
            sum += arc_sine((c / (lu * lv)).abs().min(1.0));
            count += 1;
        }
        (u, lu) = (v, lv);
    }
    let mean = if count == 0 {
        0.0
    } else {
        (sum / count as f64).to_degrees()
    };
    (mean, convex && turning <= 4)
}

/// Arc sine on [0, 1] to 2e-8 (Abramowitz and Stegun 4.4.46).
fn arc_sine(x: f64) -> f64 {
    const C: [f64; 8] = [
        1.570_796_305_0,
        -0.214_598_801_6,
        0.088_978_987_4,
        -0.050_174_304_6,
        0.030_891_881_0,
        -0.017_088_125_6,
        0.006_670_090_1,
        -0.001_262_491_1,
    ];
    let poly = C.iter().rev().fold(0.0, |acc, &c| acc * x + c);
    (std::f64::consts::FRAC_PI_2 - (1.0 - x).max(0.0).sqrt() * poly).max(0.0)
}

/// Area and aspect of the smallest rectangle around a convex ring.
fn smallest_box(hull: &[P]) -> (f64, f64) {
    let n = hull.len();
    let mut best = (f64::INFINITY, 1.0);
    for i in 0..n {
        let e = hull[(i + 1) % n] - hull[i];
        let l = dot(e, e);
        if l <= 0.0 {
            continue;
        }
        let (mut lo, mut hi, mut top) = (0.0f64, 0.0f64, 0.0f64);
        for &q in hull {
            let w = q - hull[i];
            let along = dot(w, e);
            lo = lo.min(along);
            hi = hi.max(along);
            top = top.max(cross(e, w).abs());
        }
        // Both extents are scaled by the edge's length.
        let (a, b) = (hi - lo, top);
        if a * b < best.0 * l {
            best = (a * b / l, a.max(b) / a.min(b).max(1e-9 * l));
        }
    }
    best
}

/// Convex hull, counter-clockwise (Andrew's monotone chain). Sorts `points`.
fn hull(points: &mut [P], out: &mut Vec<P>) {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    out.clear();
    for pass in 0..2 {
        let start = out.len();
        for k in 0..points.len() {
            let q = if pass == 0 {
                points[k]
            } else {
                points[points.len() - 1 - k]
            };
            while out.len() >= start + 2
                && cross(
                    out[out.len() - 1] - out[out.len() - 2],
                    q - out[out.len() - 1],
                ) <= 0.0
            {
                out.pop();
            }
            out.push(q);
        }
        out.pop();
    }
}

/// Cost of a piece in its better use, parcel or green; 0 is perfect, about 1
/// or more is bad.
pub(super) fn cost(q: &Quality, options: &ParcelOptions) -> f64 {
    parcel_cost(q, options).min(green_cost(q, options))
}

/// Whether a piece is better left green than called a parcel.
pub(super) fn is_green(q: &Quality, options: &ParcelOptions) -> bool {
    q.frontage < options.min_frontage || parcel_cost(q, options) > green_cost(q, options)
}

/// Cost of a piece as a parcel.
///
/// Costs add up over a block: a piece weighs half by its number, half by its
/// area, so that neither many bad slivers nor one large bad lot comes cheap.
/// The step at the certificate's limits is what counts; a gentle slope on
/// either side pulls towards right angles and rectangles everywhere.
fn parcel_cost(q: &Quality, options: &ParcelOptions) -> f64 {
    let a = q.area / (options.depth * options.width);
    // A hair above the hard limit, so that rounding cannot undercut it.
    if q.frontage < options.min_frontage * 1.001 || q.area.is_nan() || a <= 0.0 {
        return 1e3 * (1.0 + a.max(0.0));
    }
    let mut c = 0.0;
    let (x, y) = (
        q.deviation / BAD_DEVIATION,
        (q.ratio - 1.0) / (BAD_RATIO - 1.0),
    );
    c += 0.25 * x.min(1.0).powi(2) + 0.25 * y.min(1.0).powi(2);
    // A ramp just below each limit keeps a parcel from resting on it.
    c += 0.3 * ((x - 0.85) / 0.15).clamp(0.0, 1.0) + 0.3 * ((y - 0.85) / 0.15).clamp(0.0, 1.0);
    if q.is_bad() {
        c += 0.8 + (0.15 * (x - 1.0)).clamp(0.0, 0.4) + (0.12 * (y - 1.0)).clamp(0.0, 1.2);
    }
    let s = a.ln();
    c += 0.2 * s * s;
    // Above about 1.3 lots a through lot would do for two: it must be dearer
    // than two rows back to back, and cheaper than a lot with a green behind.
    c += (0.5 * (a - 1.3)).clamp(0.0, 0.35);
    if a < 0.6 {
        c += 0.3 + 1.2 * (0.6 - a);
    } else if a > 2.0 {
        c += 0.2 + 0.5 * (a - 2.0).min(4.0);
    }
    if q.frontage < options.good_frontage {
        c += 0.2 + 0.6 * (1.0 - q.frontage / options.good_frontage);
    }
    c += (0.3 * (q.aspect - 3.0)).clamp(0.0, 4.0);
    c * 0.5 * (1.0 + a)
}

/// Cost of a piece as green land: mostly its area. A scrap that no street
/// reaches is worth less than the same scrap on a street.
fn green_cost(q: &Quality, options: &ParcelOptions) -> f64 {
    let base = if q.frontage < options.min_frontage {
        1.3
    } else {
        0.6
    };
    base + 2.1 * q.area.max(0.0) / (options.depth * options.width)
}

#[cfg(test)]
mod tests {
    use super::super::geom::pt;
    use super::*;

    #[test]
    fn a_rectangle_is_perfect() {
        let ring = [
            pt(0., 0.),
            pt(9., 0.),
            pt(18., 0.),
            pt(18., 30.),
            pt(0., 30.),
        ];
        let front = [true, true, false, false, false];
        let q = measure(&ring, &front, &mut Scratch::default());
        assert!(q.deviation < 1e-4 && (q.ratio - 1.0).abs() < 1e-12);
        assert!((q.frontage - 18.0).abs() < 1e-12 && (q.aspect - 30.0 / 18.0).abs() < 1e-12);
        assert!(cost(&q, &ParcelOptions::default()) < 1e-9);
    }

    #[test]
    fn a_triangle_is_bad() {
        let ring = [pt(0., 0.), pt(30., 0.), pt(15., 26.0)];
        let q = measure(&ring, &[true, false, false], &mut Scratch::default());
        assert!((q.deviation - 30.0).abs() < 0.1 && (q.ratio - 2.0).abs() < 0.01);
        assert!(q.is_bad() && cost(&q, &ParcelOptions::default()) > 1.0);
    }

    #[test]
    fn a_reflex_right_angle_is_right() {
        let l = [
            pt(0., 0.),
            pt(4., 0.),
            pt(4., 2.),
            pt(2., 2.),
            pt(2., 4.),
            pt(0., 4.),
        ];
        let q = measure(&l, &[true; 6], &mut Scratch::default());
        assert!(q.deviation < 1e-4 && (q.ratio - 16.0 / 12.0).abs() < 1e-12);
    }
}
