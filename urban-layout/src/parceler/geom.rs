//! Small plane geometry for the parceler: vectors, rays, rings.
//!
//! Everything works on open rings (`ring[i]` to `ring[i + 1]`, the last edge
//! closing) in the block's own frame, so that no coordinate is large.

use geo_types::Coord;

/// A point or a vector of the block's frame, metres.
pub(super) type P = Coord<f64>;

pub(super) fn pt(x: f64, y: f64) -> P {
    Coord { x, y }
}

pub(super) fn cross(a: P, b: P) -> f64 {
    a.x * b.y - a.y * b.x
}

pub(super) fn dot(a: P, b: P) -> f64 {
    a.x * b.x + a.y * b.y
}

pub(super) fn norm(a: P) -> f64 {
    dot(a, a).sqrt()
}

pub(super) fn dist(a: P, b: P) -> f64 {
    norm(b - a)
}

/// The vector at unit length, or `None` if it has (almost) none.
pub(super) fn unit(a: P) -> Option<P> {
    let l = norm(a);
    (l > 1e-12 && l.is_finite()).then(|| a * (1.0 / l))
}

/// The vector turned a quarter to the left.
pub(super) fn left(a: P) -> P {
    pt(-a.y, a.x)
}

/// The vector turned counter-clockwise by `angle` radians.
pub(super) fn turned(a: P, angle: f64) -> P {
    let (s, c) = angle.sin_cos();
    pt(a.x * c - a.y * s, a.x * s + a.y * c)
}

/// The signed angle from `a` to `b`, in (-π, π].
pub(super) fn angle(a: P, b: P) -> f64 {
    cross(a, b).atan2(dot(a, b))
}

pub(super) fn lerp(a: P, b: P, t: f64) -> P {
    a + (b - a) * t
}

/// Signed area of a ring, positive when it runs counter-clockwise.
///
/// Taken about the first vertex, so that a ring far from the origin keeps its
/// digits.
pub(super) fn area(ring: &[P]) -> f64 {
    let Some(&o) = ring.first() else { return 0.0 };
    let mut sum = 0.0;
    for i in 1..ring.len().saturating_sub(1) {
        sum += cross(ring[i] - o, ring[i + 1] - o);
    }
    0.5 * sum
}

/// Whether `q` lies inside the ring (even-odd rule; undefined on the edges).
pub(super) fn inside(ring: &[P], q: P) -> bool {
    let mut odd = false;
    let n = ring.len();
    for i in 0..n {
        let (a, b) = (ring[i], ring[(i + 1) % n]);
        if (a.y > q.y) != (b.y > q.y) {
            let x = a.x + (q.y - a.y) / (b.y - a.y) * (b.x - a.x);
            if q.x < x {
                odd = !odd;
            }
        }
    }
    odd
}

/// The place nearest to `q` on the segment `ab`: its parameter in [0, 1].
pub(super) fn nearest_on(a: P, b: P, q: P) -> f64 {
    let d = b - a;
    let l = dot(d, d);
    if l <= 0.0 {
        return 0.0;
    }
    (dot(q - a, d) / l).clamp(0.0, 1.0)
}

/// Where the ray from `o` along `d` meets the segment `ab`: the parameters
/// along the ray and along the segment.
pub(super) fn ray_hit(o: P, d: P, a: P, b: P) -> Option<(f64, f64)> {
    let e = b - a;
    let den = cross(d, e);
    if den.abs() <= 1e-14 * norm(d) * norm(e) {
        return None;
    }
    let w = a - o;
    let t = cross(w, e) / den;
    let r = cross(w, d) / den;
    // A hair of slack, so that a ray through a vertex never slips between its
    // two edges.
    (t > 0.0 && (-1e-9..=1.0 + 1e-9).contains(&r)).then(|| (t, r.clamp(0.0, 1.0)))
}

/// Whether the segments `ab` and `cd` have a point in common.
pub(super) fn meet(a: P, b: P, c: P, d: P) -> bool {
    // Most pairs are far apart: their boxes say so.
    if a.x.max(b.x) < c.x.min(d.x)
        || c.x.max(d.x) < a.x.min(b.x)
        || a.y.max(b.y) < c.y.min(d.y)
        || c.y.max(d.y) < a.y.min(b.y)
    {
        return false;
    }
    let r = |p: P, q: P, s: P| {
        let f = |v: P| robust::Coord { x: v.x, y: v.y };
        robust::orient2d(f(p), f(q), f(s))
    };
    let (o1, o2) = (r(a, b, c), r(a, b, d));
    if o1 * o2 > 0.0 {
        return false;
    }
    let (o3, o4) = (r(c, d, a), r(c, d, b));
    if o3 * o4 > 0.0 {
        return false;
    }
    if o1 * o2 < 0.0 && o3 * o4 < 0.0 {
        return true;
    }
    let on = |p: P, q: P, s: P| {
        s.x >= p.x.min(q.x) && s.x <= p.x.max(q.x) && s.y >= p.y.min(q.y) && s.y <= p.y.max(q.y)
    };
    (o1 == 0.0 && on(a, b, c))
        || (o2 == 0.0 && on(a, b, d))
        || (o3 == 0.0 && on(c, d, a))
        || (o4 == 0.0 && on(c, d, b))
}

/// Whether the ring is simple: no two edges meet but at their common vertex,
/// and no vertex is repeated.
pub(super) fn is_simple(ring: &[P]) -> bool {
    let n = ring.len();
    if n < 3 {
        return false;
    }
    // Edges sorted by their lowest x: only overlapping intervals are compared.
    let mut order: Vec<usize> = (0..n).collect();
    let lo = |i: usize| ring[i].x.min(ring[(i + 1) % n].x);
    let hi = |i: usize| ring[i].x.max(ring[(i + 1) % n].x);
    order.sort_by(|&i, &j| lo(i).total_cmp(&lo(j)).then(i.cmp(&j)));
    for (k, &i) in order.iter().enumerate() {
        let (a, b) = (ring[i], ring[(i + 1) % n]);
        if a == b {
            return false;
        }
        for &j in &order[k + 1..] {
            if lo(j) > hi(i) {
                break;
            }
            let (c, d) = (ring[j], ring[(j + 1) % n]);
            if (i + 1) % n == j || (j + 1) % n == i {
                // Neighbours share one end: they overlap only when one folds
                // back over the other.
                let (s, x, y) = if (i + 1) % n == j {
                    (b, a, d)
                } else {
                    (a, b, c)
                };
                if n > 3 && cross(x - s, y - s) == 0.0 && dot(x - s, y - s) > 0.0 {
                    return false;
                }
            } else if meet(a, b, c, d) {
                return false;
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simple_rings_are_told_from_crossed_ones() {
        let square = [pt(0., 0.), pt(1., 0.), pt(1., 1.), pt(0., 1.)];
        let bow = [pt(0., 0.), pt(1., 1.), pt(1., 0.), pt(0., 1.)];
        let spike = [pt(0., 0.), pt(2., 0.), pt(1., 0.), pt(1., 1.)];
        assert!(is_simple(&square));
        assert!(!is_simple(&bow));
        assert!(!is_simple(&spike));
        assert!((area(&square) - 1.0).abs() < 1e-15);
        assert!(inside(&square, pt(0.5, 0.5)) && !inside(&square, pt(1.5, 0.5)));
    }

    #[test]
    fn rays_meet_segments() {
        let hit = ray_hit(pt(0., 0.), pt(1., 0.), pt(2., -1.), pt(2., 3.));
        let (t, r) = hit.expect("the ray points at the segment");
        assert!((t - 2.0).abs() < 1e-15 && (r - 0.25).abs() < 1e-15);
        assert!(ray_hit(pt(0., 0.), pt(-1., 0.), pt(2., -1.), pt(2., 3.)).is_none());
    }
}
