//! First positions of a template's points on a region: arc length on the
//! boundary, mean value coordinates inside (paper, section 4.1,
//! "Initialization"; coordinates after Floater, "Mean value coordinates", 2003,
//! and Hormann and Floater 2006 for polygons that are not convex).

use crate::geometry::{cross, dot, norm, P};
use crate::template::model::{Side, Template};

/// Arc lengths at which the nodes of a template side come to lie on a region
/// side of length `total`, from 0 to `total`.
///
/// Edges that are divided take up the slack and the others keep their drawn
/// length, because their parts repeat while the others hold one parcel or
/// street of fixed size. Where fixed lengths leave the divided edges less than a
/// part each, everything is scaled alike.
pub(crate) fn side_arc_lengths(template: &Template, side: &Side, total: f64) -> Vec<f64> {
    let edges: Vec<(f64, Option<f64>)> = side
        .nodes
        .windows(2)
        .map(|e| {
            let drawn = norm(template.points[e[1]] - template.points[e[0]]);
            (drawn, least_length(template, e[0], e[1]))
        })
        .collect();
    let fixed: f64 = edges.iter().filter(|e| e.1.is_none()).map(|e| e.0).sum();
    let elastic: f64 = edges.iter().filter(|e| e.1.is_some()).map(|e| e.0).sum();
    let least: f64 = edges
        .iter()
        .filter_map(|e| e.1)
        .map(|least| 0.6 * least)
        .sum();
    let (fixed_scale, elastic_scale) = if elastic > 0.0 && total - fixed >= least {
        (1.0, (total - fixed) / elastic)
    } else {
        (total / (fixed + elastic), total / (fixed + elastic))
    };
    let mut s = 0.0;
    let mut out = vec![0.0];
    for (drawn, divided) in edges {
        s += drawn
            * if divided.is_some() {
                elastic_scale
            } else {
                fixed_scale
            };
        out.push(s);
    }
    if let Some(last) = out.last_mut() {
        *last = total;
    }
    out
}

/// The divide that holds the edge, in either direction.
pub(crate) fn divide_of(template: &Template, a: usize, b: usize) -> Option<usize> {
    template
        .divides
        .iter()
        .position(|d| d.edges.iter().any(|e| *e == [a, b] || *e == [b, a]))
}

/// Least length of an edge that may be stretched, metres, or nothing for edges
/// that keep their drawn length.
pub(crate) fn least_length(template: &Template, a: usize, b: usize) -> Option<f64> {
    if let Some(d) = divide_of(template, a, b) {
        let divide = &template.divides[d];
        return Some(divide.length * divide.min as f64);
    }
    template
        .elastic
        .iter()
        .any(|e| *e == [a, b] || *e == [b, a])
        .then_some(0.0)
}

/// Mean value coordinates of `q` in a polygon: weights that sum to 1 and whose
/// mean of the vertices is `q`.
pub(crate) fn mean_value_weights(ring: &[P], q: P) -> Vec<f64> {
    let n = ring.len();
    let mut weights = vec![0.0; n];
    let scale = ring.iter().map(|&v| norm(v - q)).fold(0.0, f64::max);
    let to: Vec<P> = ring.iter().map(|&v| v - q).collect();
    let radius: Vec<f64> = to.iter().map(|&v| norm(v)).collect();
    // On a vertex or an edge the general formula divides by zero; its limit is
    // linear interpolation along the edge.
    for i in 0..n {
        let j = (i + 1) % n;
        if radius[i] <= 1e-12 * scale {
            weights[i] = 1.0;
            return weights;
        }
        if cross(to[i], to[j]).abs() <= 1e-12 * radius[i] * radius[j] && dot(to[i], to[j]) <= 0.0 {
            let sum = radius[i] + radius[j];
            weights[i] = radius[j] / sum;
            weights[j] = radius[i] / sum;
            return weights;
        }
    }
    // tan(angle / 2) = sin / (1 + cos), signed.
    let half: Vec<f64> = (0..n)
        .map(|i| {
            let j = (i + 1) % n;
            let s = cross(to[i], to[j]);
            let c = dot(to[i], to[j]);
            let r = radius[i] * radius[j];
            // Two forms of the same; each is exact where the other cancels.
            if c >= 0.0 {
                s / (r + c)
            } else {
                (r - c) / s
            }
        })
        .collect();
    let mut sum = 0.0;
    for i in 0..n {
        weights[i] = (half[(i + n - 1) % n] + half[i]) / radius[i];
        sum += weights[i];
    }
    for w in &mut weights {
        *w /= sum;
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::p;

    #[test]
    fn mean_value_coordinates_reproduce_points_of_a_concave_polygon() {
        let l = [
            p(0., 0.),
            p(4., 0.),
            p(4., 1.5),
            p(1.5, 1.5),
            p(1.5, 4.),
            p(0., 4.),
        ];
        for q in [
            p(0.7, 0.8),
            p(3.0, 1.0),
            p(0.2, 3.5),
            p(0.0, 2.0),
            p(4.0, 1.5),
            p(1.5, 2.0),
        ] {
            let w = mean_value_weights(&l, q);
            let mut r = p(0.0, 0.0);
            for (&v, &k) in l.iter().zip(&w) {
                r = r + v * k;
            }
            assert!(norm(r - q) < 1e-12, "{q:?} {r:?}");
            assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }
}
