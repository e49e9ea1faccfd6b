//! Plane geometry on `Coord`: the few vector and polyline operations that the
//! planner's rooms share.

use geo_types::{Coord, Polygon};

/// A point from its two coordinates, metres.
pub(crate) const fn at(x: f64, y: f64) -> Coord<f64> {
    Coord { x, y }
}

pub(crate) fn dot(a: Coord<f64>, b: Coord<f64>) -> f64 {
    a.x * b.x + a.y * b.y
}

/// Positive where `b` lies to the left of `a`.
pub(crate) fn cross(a: Coord<f64>, b: Coord<f64>) -> f64 {
    a.x * b.y - a.y * b.x
}

pub(crate) fn norm(a: Coord<f64>) -> f64 {
    a.x.hypot(a.y)
}

pub(crate) fn dist(a: Coord<f64>, b: Coord<f64>) -> f64 {
    norm(b - a)
}

/// `a` at unit length; zero stays zero.
pub(crate) fn unit(a: Coord<f64>) -> Coord<f64> {
    let length = norm(a);
    if length > 0.0 {
        a / length
    } else {
        a
    }
}

/// `a` turned a quarter to the left.
pub(crate) fn left(a: Coord<f64>) -> Coord<f64> {
    at(-a.y, a.x)
}

pub(crate) fn lerp(a: Coord<f64>, b: Coord<f64>, t: f64) -> Coord<f64> {
    a + (b - a) * t
}

/// Angle between two directions, 0 to pi.
pub(crate) fn angle(a: Coord<f64>, b: Coord<f64>) -> f64 {
    cross(a, b).abs().atan2(dot(a, b))
}

/// Signed turn from direction `a` to `b`, left positive, -pi to pi.
pub(crate) fn turn(a: Coord<f64>, b: Coord<f64>) -> f64 {
    cross(a, b).atan2(dot(a, b))
}

/// The point of segment `a b` nearest to `p`, and its parameter.
pub(crate) fn nearest_on(a: Coord<f64>, b: Coord<f64>, p: Coord<f64>) -> (Coord<f64>, f64) {
    let d = b - a;
    let square = dot(d, d);
    let t = if square > 0.0 {
        (dot(p - a, d) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (lerp(a, b, t), t)
}

/// Where ray `from + s * dir` meets segment `a b`: the ray parameter `s >= 0`.
pub(crate) fn ray_hit(
    from: Coord<f64>,
    dir: Coord<f64>,
    a: Coord<f64>,
    b: Coord<f64>,
) -> Option<f64> {
    let d = b - a;
    let det = cross(dir, d);
    if det.abs() < 1e-12 * norm(dir) * norm(d) {
        return None;
    }
    let s = cross(a - from, d) / det;
    let t = cross(a - from, dir) / det;
    (s >= 0.0 && (-1e-9..=1.0 + 1e-9).contains(&t)).then_some(s)
}

/// Twice the signed area would be the sum; this is the signed area, positive
/// counter-clockwise, of an open ring.
pub(crate) fn signed_area(ring: &[Coord<f64>]) -> f64 {
    let Some(&origin) = ring.first() else {
        return 0.0;
    };
    let n = ring.len();
    0.5 * (0..n)
        .map(|i| cross(ring[i] - origin, ring[(i + 1) % n] - origin))
        .sum::<f64>()
}

/// Whether `p` lies inside the open ring (even-odd; points on it either way).
pub(crate) fn in_ring(ring: &[Coord<f64>], p: Coord<f64>) -> bool {
    let n = ring.len();
    let mut inside = false;
    for i in 0..n {
        let (a, b) = (ring[i], ring[(i + 1) % n]);
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}

/// The corners of the least box around a polygon, low ones first; the origin
/// twice if it has no points.
pub(crate) fn extent(polygon: &Polygon<f64>) -> (Coord<f64>, Coord<f64>) {
    let points = &polygon.exterior().0;
    let first = points.first().copied().unwrap_or_default();
    points.iter().fold((first, first), |(low, high), p| {
        (
            at(low.x.min(p.x), low.y.min(p.y)),
            at(high.x.max(p.x), high.y.max(p.y)),
        )
    })
}

pub(crate) fn length(line: &[Coord<f64>]) -> f64 {
    line.windows(2).map(|w| dist(w[0], w[1])).sum()
}

/// `line` at points about `step` apart, its two ends kept.
pub(crate) fn resample(line: &[Coord<f64>], step: f64) -> Vec<Coord<f64>> {
    let total = length(line);
    if line.len() < 2 || total <= 0.0 {
        return line.to_vec();
    }
    let n = (total / step).round().max(1.0) as usize;
    let mut out = Vec::with_capacity(n + 1);
    out.push(line[0]);
    let (mut segment, mut before) = (0, 0.0);
    for k in 1..n {
        let target = total * k as f64 / n as f64;
        while segment + 2 < line.len() && before + dist(line[segment], line[segment + 1]) < target {
            before += dist(line[segment], line[segment + 1]);
            segment += 1;
        }
        let d = dist(line[segment], line[segment + 1]);
        let t = if d > 0.0 {
            ((target - before) / d).clamp(0.0, 1.0)
        } else {
            0.0
        };
        out.push(lerp(line[segment], line[segment + 1], t));
    }
    out.push(line[line.len() - 1]);
    out
}

/// Douglas-Peucker: fewer points, none of the dropped ones farther than
/// `tolerance` from the result.
pub(crate) fn simplify(line: &[Coord<f64>], tolerance: f64) -> Vec<Coord<f64>> {
    if line.len() < 3 {
        return line.to_vec();
    }
    let mut keep = vec![false; line.len()];
    keep[0] = true;
    keep[line.len() - 1] = true;
    let mut stack = vec![(0, line.len() - 1)];
    while let Some((a, b)) = stack.pop() {
        let far = (a + 1..b)
            .map(|i| (i, dist(line[i], nearest_on(line[a], line[b], line[i]).0)))
            .max_by(|p, q| p.1.total_cmp(&q.1));
        if let Some((i, d)) = far {
            if d > tolerance {
                keep[i] = true;
                stack.push((a, i));
                stack.push((i, b));
            }
        }
    }
    line.iter()
        .zip(&keep)
        .filter(|(_, &k)| k)
        .map(|(&p, _)| p)
        .collect()
}

/// A point well inside a polygon given by open rings (outer and holes alike):
/// the middle of the longest chord among a few scan lines.
pub(crate) fn inner_point(rings: &[Vec<Coord<f64>>]) -> Option<Coord<f64>> {
    let ys = rings.iter().flatten().map(|p| p.y);
    let (low, high) = ys.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| {
        (l.min(y), h.max(y))
    });
    let mut best: Option<(f64, Coord<f64>)> = None;
    for k in 0..15 {
        // Irrational-looking fractions, so that lines rarely pass through vertices.
        let y = low + (high - low) * (0.0437 + 0.0651 * f64::from(k));
        let mut xs: Vec<f64> = Vec::new();
        for ring in rings {
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                if (a.y > y) != (b.y > y) {
                    xs.push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
                }
            }
        }
        xs.sort_by(f64::total_cmp);
        for pair in xs.chunks_exact(2) {
            let width = pair[1] - pair[0];
            if best.is_none_or(|(w, _)| width > w) {
                best = Some((width, at(0.5 * (pair[0] + pair[1]), y)));
            }
        }
    }
    best.map(|(_, p)| p)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resampling_keeps_ends_and_spacing() {
        let line = [at(0.0, 0.0), at(10.0, 0.0), at(10.0, 5.0)];
        let out = resample(&line, 5.0);
        assert_eq!(
            out,
            vec![at(0.0, 0.0), at(5.0, 0.0), at(10.0, 0.0), at(10.0, 5.0)]
        );
    }

    #[test]
    fn simplification_keeps_what_matters() {
        let line = [at(0.0, 0.0), at(5.0, 0.01), at(10.0, 0.0), at(10.0, 5.0)];
        assert_eq!(
            simplify(&line, 0.1),
            vec![at(0.0, 0.0), at(10.0, 0.0), at(10.0, 5.0)]
        );
        assert_eq!(simplify(&line, 0.001).len(), 4);
    }

    #[test]
    fn inner_points_avoid_holes() {
        let outer = vec![at(0.0, 0.0), at(10.0, 0.0), at(10.0, 10.0), at(0.0, 10.0)];
        let hole = vec![at(1.0, 1.0), at(1.0, 9.0), at(9.0, 9.0), at(9.0, 1.0)];
        let p = inner_point(&[outer.clone(), hole.clone()]).expect("the frame has a point");
        assert!(in_ring(&outer, p) && !in_ring(&hole, p));
    }

    #[test]
    fn rays_meet_segments() {
        assert_eq!(
            ray_hit(at(0.0, 0.0), at(1.0, 0.0), at(3.0, -1.0), at(3.0, 1.0)),
            Some(3.0)
        );
        assert_eq!(
            ray_hit(at(0.0, 0.0), at(-1.0, 0.0), at(3.0, -1.0), at(3.0, 1.0)),
            None
        );
    }
}
