//! Exact orientation tests and the distances built next to them.
//!
//! Signs come from adaptive-precision predicates, so topology never hangs on
//! rounding; distances are ordinary floating point and only ever compared
//! with tolerances far above it.

use geo_types::Coord;

/// A point.
pub(crate) type P = Coord<f64>;

/// Twice the signed area of `abc`, with the exact sign: positive if
/// counter-clockwise.
#[inline]
pub(crate) fn orient(a: P, b: P, c: P) -> f64 {
    let r = |p: P| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(r(a), r(b), r(c))
}

/// `a - b` as a vector.
#[inline]
pub(crate) fn sub(a: P, b: P) -> P {
    Coord {
        x: a.x - b.x,
        y: a.y - b.y,
    }
}

/// Scalar product.
#[inline]
pub(crate) fn dot(a: P, b: P) -> f64 {
    a.x * b.x + a.y * b.y
}

/// z of the vector product.
#[inline]
pub(crate) fn cross(a: P, b: P) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Length. By a square root, which is the same on every machine, where a
/// library's `hypot` need not be; coordinates are far from over- or underflow.
#[inline]
pub(crate) fn norm(a: P) -> f64 {
    dot(a, a).sqrt()
}

/// Distance of two points.
#[inline]
pub(crate) fn dist(a: P, b: P) -> f64 {
    norm(sub(a, b))
}

/// `a + (b - a) t`.
#[inline]
pub(crate) fn lerp(a: P, b: P, t: f64) -> P {
    Coord {
        x: a.x + (b.x - a.x) * t,
        y: a.y + (b.y - a.y) * t,
    }
}

/// Are both coordinates finite?
#[inline]
pub(crate) fn finite(a: P) -> bool {
    a.x.is_finite() && a.y.is_finite()
}

/// Is `distance` at most `limit`, or not a number?
#[inline]
pub(crate) fn within(distance: f64, limit: f64) -> bool {
    distance.partial_cmp(&limit) != Some(std::cmp::Ordering::Greater)
}

/// Parameter in `[0, 1]` of the point of segment `ab` nearest to `p`.
#[inline]
pub(crate) fn foot(p: P, a: P, b: P) -> f64 {
    let d = sub(b, a);
    let len2 = dot(d, d);
    if len2 > 0.0 {
        (dot(sub(p, a), d) / len2).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Distance of `p` from the segment `ab`.
#[inline]
pub(crate) fn dist_to_segment(p: P, a: P, b: P) -> f64 {
    dist(p, lerp(a, b, foot(p, a, b)))
}

/// Orders points from west to east, then from south to north.
#[inline]
pub(crate) fn lexical(a: P, b: P) -> std::cmp::Ordering {
    let by = |a: f64, b: f64| a.partial_cmp(&b).unwrap_or(std::cmp::Ordering::Equal);
    by(a.x, b.x).then(by(a.y, b.y))
}

/// Do the segments cross at a point inside both?
#[inline]
pub(crate) fn crosses(a: P, b: P, c: P, d: P) -> bool {
    let (o1, o2) = (orient(a, b, c), orient(a, b, d));
    if !((o1 > 0.0 && o2 < 0.0) || (o1 < 0.0 && o2 > 0.0)) {
        return false;
    }
    let (o3, o4) = (orient(c, d, a), orient(c, d, b));
    (o3 > 0.0 && o4 < 0.0) || (o3 < 0.0 && o4 > 0.0)
}

/// Do the segments come within `tol` of each other (crossing included)?
#[inline]
pub(crate) fn near_segments(a: P, b: P, c: P, d: P, tol: f64) -> bool {
    dist_to_segment(a, c, d) <= tol
        || dist_to_segment(b, c, d) <= tol
        || dist_to_segment(c, a, b) <= tol
        || dist_to_segment(d, a, b) <= tol
        || crosses(a, b, c, d)
}

/// Does the direction from `centre` to `d` lie strictly inside the wedge
/// swept counter-clockwise from `out` to `back`? A wedge whose two sides are
/// one direction is the whole turn.
pub(crate) fn in_wedge(centre: P, out: P, back: P, d: P) -> bool {
    let o = orient(centre, out, back);
    if o > 0.0 {
        orient(centre, out, d) > 0.0 && orient(centre, d, back) > 0.0
    } else if o < 0.0 {
        !(orient(centre, back, d) >= 0.0 && orient(centre, d, out) >= 0.0)
    } else if dot(sub(out, centre), sub(back, centre)) < 0.0 {
        orient(centre, out, d) > 0.0
    } else {
        orient(centre, out, d) != 0.0 || dot(sub(out, centre), sub(d, centre)) < 0.0
    }
}

/// Orders directions from `centre` counter-clockwise, starting with +x.
pub(crate) fn by_angle(centre: P, a: P, b: P) -> std::cmp::Ordering {
    let half = |p: P| u8::from(!(p.y > centre.y || (p.y == centre.y && p.x > centre.x)));
    half(a).cmp(&half(b)).then_with(|| {
        let o = orient(centre, a, b);
        0.0_f64.total_cmp(&if o == 0.0 { 0.0 } else { o })
    })
}

/// Does the half-open edge `ab` cross the ray from `p` towards -x?
#[inline]
pub(crate) fn west_of(p: P, a: P, b: P) -> bool {
    let (lo, hi) = if a.y <= b.y { (a, b) } else { (b, a) };
    lo.y <= p.y && p.y < hi.y && orient(lo, hi, p) < 0.0
}

/// Is `p` inside the closed ring (even-odd, exact, boundary undecided)?
pub(crate) fn in_ring(p: P, ring: impl Iterator<Item = (P, P)>) -> bool {
    ring.filter(|&(a, b)| west_of(p, a, b)).count() % 2 == 1
}

/// Of two edges that cross one horizontal line and not each other: does
/// `ab` pass east of `cd`?
pub(crate) fn east_of(a: P, b: P, c: P, d: P) -> bool {
    let up = |p: P, q: P| if p.y <= q.y { (p, q) } else { (q, p) };
    let ((al, ah), (cl, ch)) = (up(a, b), up(c, d));
    // The higher of the two low ends lies within the other edge's height,
    // so that its side of that edge decides; then the lower high end.
    let low = if al.y >= cl.y {
        -orient(cl, ch, al)
    } else {
        orient(al, ah, cl)
    };
    if low != 0.0 {
        return low > 0.0;
    }
    let high = if ah.y <= ch.y {
        -orient(cl, ch, ah)
    } else {
        orient(al, ah, ch)
    };
    high > 0.0
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
    fn wedges() {
        let o = p(0., 0.);
        let (e, n, w, s) = (p(1., 0.), p(0., 1.), p(-1., 0.), p(0., -1.));
        let ne = p(1., 1.);
        assert!(in_wedge(o, e, n, ne));
        assert!(!in_wedge(o, n, e, ne));
        assert!(in_wedge(o, n, e, s));
        assert!(in_wedge(o, e, w, n));
        assert!(!in_wedge(o, e, w, s));
        assert!(in_wedge(o, e, e, w) && in_wedge(o, e, e, n) && !in_wedge(o, e, e, p(2., 0.)));
        assert!(!in_wedge(o, e, n, e) && !in_wedge(o, n, e, e));
    }

    #[test]
    fn angles_start_east() {
        let o = p(0., 0.);
        let mut v = [
            p(0., -1.),
            p(-1., 0.),
            p(1., 0.),
            p(1., -1e-9),
            p(0., 1.),
            p(-1., -1.),
        ];
        v.sort_by(|&a, &b| by_angle(o, a, b));
        assert_eq!(
            v,
            [
                p(1., 0.),
                p(0., 1.),
                p(-1., 0.),
                p(-1., -1.),
                p(0., -1.),
                p(1., -1e-9)
            ]
        );
    }

    #[test]
    fn east_is_decided_at_a_shared_low_end() {
        let a = p(0., 0.);
        assert!(east_of(a, p(2., 1.), a, p(1., 1.)));
        assert!(!east_of(a, p(1., 1.), a, p(2., 1.)));
        assert!(east_of(p(3., -1.), p(3., 5.), p(0., 0.), p(1., 1.)));
        assert!(!east_of(p(0., 0.), p(1., 1.), p(3., -1.), p(3., 5.)));
    }
}
