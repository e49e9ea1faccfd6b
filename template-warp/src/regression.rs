//! Alignments of the regression step (paper, section 4.1, "Regression"): nodes
//! on a fitted line, a chord, a fitted circle or a free smooth curve.

use crate::geometry::{dist, dot, exceeds, norm, p, P};
use crate::solve::{Align, Anchor};
use crate::template::format::AlignKind;

/// A circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CircleFit {
    pub(crate) centre: P,
    pub(crate) radius: f64,
}

/// Projects the free nodes of an alignment onto its curve, which is fitted to
/// all its nodes. `circle` holds the last circle, so that the fit never gets
/// worse from one step to the next.
pub(crate) fn fit_alignment(
    align: &Align,
    anchor: &[Anchor],
    weight: &[f64],
    x: &mut [P],
    circle: &mut Option<CircleFit>,
) {
    let nodes = &align.nodes;
    if nodes.len() < 3 {
        return;
    }
    let points: Vec<P> = nodes.iter().map(|&k| x[k]).collect();
    let weights: Vec<f64> = nodes.iter().map(|&k| weight[k].max(1e-12)).collect();
    let target: Vec<P> = match align.kind {
        AlignKind::Line => {
            let (o, u) = fit_line(&points, &weights);
            points.iter().map(|&q| o + u * dot(q - o, u)).collect()
        }
        AlignKind::Chord => {
            let (a, b) = (points[0], points[points.len() - 1]);
            let d = b - a;
            let l2 = dot(d, d);
            if l2 <= 0.0 {
                return;
            }
            points
                .iter()
                .map(|&q| a + d * (dot(q - a, d) / l2))
                .collect()
        }
        AlignKind::Circle => {
            let Some(fit) = fit_circle(&points, &weights, *circle) else {
                return;
            };
            *circle = Some(fit);
            points
                .iter()
                .map(|&q| {
                    let r = q - fit.centre;
                    let l = norm(r);
                    if l > 0.0 {
                        fit.centre + r * (fit.radius / l)
                    } else {
                        q
                    }
                })
                .collect()
        }
        AlignKind::Smooth => smooth(&points, &weights),
    };
    for (&k, t) in nodes.iter().zip(target) {
        if anchor[k] == Anchor::Free {
            x[k] = t;
        }
    }
}

/// The weighted mean of points.
fn centre(points: &[P], weights: &[f64]) -> P {
    let total: f64 = weights.iter().sum();
    points
        .iter()
        .zip(weights)
        .fold(p(0.0, 0.0), |s, (&q, &w)| s + q * w)
        / total
}

/// Weighted total least squares: a point of the line and its unit direction.
fn fit_line(points: &[P], weights: &[f64]) -> (P, P) {
    let o = centre(points, weights);
    let (mut a, mut b) = (0.0, 0.0);
    for (&q, &w) in points.iter().zip(weights) {
        let r = q - o;
        a += w * (r.x * r.x - r.y * r.y);
        b += w * 2.0 * r.x * r.y;
    }
    // The principal direction has half the angle of the second moment's deviator.
    let angle = 0.5 * b.atan2(a);
    (o, p(angle.cos(), angle.sin()))
}

fn circle_cost(points: &[P], weights: &[f64], c: &CircleFit) -> f64 {
    points
        .iter()
        .zip(weights)
        .map(|(&q, &w)| w * (dist(q, c.centre) - c.radius).powi(2))
        .sum()
}

/// Geometric circle fit by Gauss-Newton steps from the last circle or, for the
/// first time, from the algebraic fit. Steps that do not lower the cost are
/// refused, hence the energy law for circles.
fn fit_circle(points: &[P], weights: &[f64], last: Option<CircleFit>) -> Option<CircleFit> {
    let mut best = match last {
        Some(c) => c,
        None => algebraic_circle(points, weights)?,
    };
    let mut cost = circle_cost(points, weights, &best);
    for _ in 0..8 {
        // Unknowns: centre and radius; residual |q - c| - r, gradient (-u, -1).
        let mut a = nalgebra::Matrix3::zeros();
        let mut b = nalgebra::Vector3::zeros();
        for (&q, &w) in points.iter().zip(weights) {
            let r = q - best.centre;
            let l = norm(r);
            if l <= 0.0 {
                continue;
            }
            let g = nalgebra::Vector3::new(-r.x / l, -r.y / l, -1.0);
            a += g * g.transpose() * w;
            b += g * (w * (l - best.radius));
        }
        let Some(step) = a.cholesky().map(|c| c.solve(&b)) else {
            break;
        };
        let next = CircleFit {
            centre: best.centre - p(step.x, step.y),
            radius: best.radius - step.z,
        };
        let next_cost = circle_cost(points, weights, &next);
        if !exceeds(cost, next_cost) || !exceeds(next.radius, 0.0) {
            break;
        }
        let done = cost - next_cost < 1e-12 * cost;
        (best, cost) = (next, next_cost);
        if done {
            break;
        }
    }
    Some(best)
}

/// Kasa's fit: linear in (centre, |centre|^2 - r^2).
fn algebraic_circle(points: &[P], weights: &[f64]) -> Option<CircleFit> {
    let total: f64 = weights.iter().sum();
    let o = centre(points, weights);
    let (mut xx, mut xy, mut yy, mut xz, mut yz, mut zz) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (&q, &w) in points.iter().zip(weights) {
        let r = q - o;
        let z = dot(r, r);
        xx += w * r.x * r.x;
        xy += w * r.x * r.y;
        yy += w * r.y * r.y;
        xz += w * r.x * z;
        yz += w * r.y * z;
        zz += w * z;
    }
    let det = xx * yy - xy * xy;
    if !exceeds(det, 1e-12 * (xx + yy).powi(2)) {
        return None;
    }
    let c = p(
        (xz * yy - yz * xy) / (2.0 * det),
        (yz * xx - xz * xy) / (2.0 * det),
    );
    Some(CircleFit {
        centre: o + c,
        radius: (zz / total + dot(c, c)).sqrt(),
    })
}

/// Moving least squares along the chain: each point is replaced by the value
/// there of a local quadratic in chord length, fitted with Gaussian weights two
/// spacings wide. End points stay; they belong to something else.
fn smooth(points: &[P], weights: &[f64]) -> Vec<P> {
    let n = points.len();
    let mut s = vec![0.0; n];
    for i in 1..n {
        s[i] = s[i - 1] + dist(points[i], points[i - 1]);
    }
    let h = 2.0 * s[n - 1] / (n - 1) as f64;
    let mut out = points.to_vec();
    if n < 4 || h <= 0.0 {
        return out;
    }
    for i in 1..n - 1 {
        let mut a = nalgebra::Matrix3::zeros();
        let mut b = nalgebra::Matrix3x2::zeros();
        for j in 0..n {
            let t = (s[j] - s[i]) / h;
            if t.abs() > 3.0 {
                continue;
            }
            let w = weights[j] * (-t * t).exp();
            let v = nalgebra::Vector3::new(1.0, t, t * t);
            a += v * v.transpose() * w;
            b += v
                * nalgebra::RowVector2::new(points[j].x - points[i].x, points[j].y - points[i].y)
                * w;
        }
        if let Some(c) = a.cholesky() {
            let r = c.solve(&b);
            out[i] = points[i] + p(r[(0, 0)], r[(0, 1)]);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::cross;

    /// Signed distance of `q` from the directed line `a b`.
    fn offset(q: P, a: P, b: P) -> f64 {
        cross(b - a, q - a) / dist(a, b)
    }

    #[test]
    fn line_fit_beats_every_turned_or_shifted_line() {
        let points = [p(0., 0.1), p(1., -0.2), p(2., 0.3), p(3., 0.1), p(4., -0.4)];
        let weights = [1.0, 2.0, 0.5, 1.0, 3.0];
        let (o, u) = fit_line(&points, &weights);
        let cost = |o: P, u: P| -> f64 {
            points
                .iter()
                .zip(&weights)
                .map(|(&q, &w)| w * offset(q, o, o + u).powi(2))
                .sum()
        };
        let best = cost(o, u);
        for i in -5..=5 {
            for j in -5..=5 {
                let (sn, cs) = (0.01 * f64::from(i)).sin_cos();
                let v = p(u.x * cs - u.y * sn, u.x * sn + u.y * cs);
                assert!(best <= cost(o + p(0.0, 0.01 * f64::from(j)), v) + 1e-15);
            }
        }
    }

    #[test]
    fn circle_fit_finds_a_circle_from_an_arc() {
        let points: Vec<P> = (0..9)
            .map(|i| 0.2 * f64::from(i))
            .map(|a| p(3.0 + 5.0 * a.cos(), -1.0 + 5.0 * a.sin()))
            .collect();
        let fit = fit_circle(&points, &[1.0; 9], None).unwrap();
        assert!(dist(fit.centre, p(3.0, -1.0)) < 1e-9 && (fit.radius - 5.0).abs() < 1e-9);
        assert!(fit_circle(&[p(0., 0.), p(1., 0.), p(2., 0.)], &[1.0; 3], None).is_none());
    }

    #[test]
    fn smoothing_keeps_a_parabola_nearly_and_calms_a_zigzag() {
        let zigzag: Vec<P> = (0..12)
            .map(|i| p(f64::from(i), if i % 2 == 0 { 0.2 } else { -0.2 }))
            .collect();
        let calm = smooth(&zigzag, &[1.0; 12]);
        assert!(calm[3..9].iter().all(|q| q.y.abs() < 0.08), "{calm:?}");
        assert_eq!((calm[0], calm[11]), (zigzag[0], zigzag[11]));
    }
}
