//! Closed-form registrations against brute force (laws 1 of the templates).

use proptest::prelude::*;
use template_warp::geo_types::{coord, Coord};
use template_warp::{Affine, AreaAffine, Deformation, PrincipalAffine, Rigid, Similarity};

type P = Coord<f64>;

fn cases() -> ProptestConfig {
    ProptestConfig::with_cases(if std::env::var_os("URBAN_LAYOUT_LONG").is_some() {
        4000
    } else {
        64
    })
}

/// A face and where its vertices went: mostly near a map of some class, at
/// times anywhere, at times nearly on a line.
fn correspondence() -> impl Strategy<Value = (Vec<P>, Vec<P>, Vec<f64>)> {
    let point = (-30.0..30.0f64, -30.0..30.0f64).prop_map(|(x, y)| coord! { x: x, y: y });
    (3usize..9).prop_flat_map(move |n| {
        (
            prop::collection::vec(point.clone(), n),
            prop::collection::vec(point.clone(), n),
            prop::collection::vec(0.2..5.0f64, n),
            prop::array::uniform4(-2.0..2.0f64),
            prop_oneof![Just(0.0), Just(0.05), Just(1.0)],
            prop_oneof![4 => Just(1.0), 1 => Just(1e-3)],
        )
            .prop_map(|(from, noise, weights, m, amount, flat)| {
                let from: Vec<P> = from.into_iter().map(|q| coord! { x: q.x, y: q.y * flat }).collect();
                let to = from
                    .iter()
                    .zip(&noise)
                    .map(|(&q, &e)| coord! { x: m[0] * q.x + m[1] * q.y + 7.0, y: m[2] * q.x + m[3] * q.y - 3.0 } + e * amount)
                    .collect();
                (from, to, weights)
            })
    })
}

/// The map with this matrix that takes barycentre to barycentre: the best
/// translation for it.
fn centred(a: [[f64; 2]; 2], from: &[P], to: &[P], weights: &[f64]) -> Affine {
    let total: f64 = weights.iter().sum();
    let mean = |v: &[P]| {
        v.iter()
            .zip(weights)
            .fold(coord! { x: 0.0, y: 0.0 }, |s, (&q, &w)| s + q * w)
            / total
    };
    let (f, t) = (mean(from), mean(to));
    let image = coord! { x: a[0][0] * f.x + a[0][1] * f.y, y: a[1][0] * f.x + a[1][1] * f.y };
    Affine {
        linear: a,
        translation: t - image,
    }
}

fn rotated(angle: f64, sx: f64, sy: f64) -> [[f64; 2]; 2] {
    let (s, c) = angle.sin_cos();
    [[sx * c, -sy * s], [sx * s, sy * c]]
}

/// Slack for comparisons: rounding of sums of squares of this size.
fn slack(to: &[P], from: &[P]) -> f64 {
    1e-9 * to
        .iter()
        .chain(from)
        .map(|q| q.x * q.x + q.y * q.y)
        .sum::<f64>()
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn rigid_beats_every_rotation((from, to, w) in correspondence()) {
        let best = Rigid.register(&from, &to, &w);
        prop_assert!((best.determinant() - 1.0).abs() < 1e-12);
        let e = best.residual(&from, &to, &w);
        for i in 0..720 {
            let other = centred(rotated(f64::from(i).to_radians() / 2.0, 1.0, 1.0), &from, &to, &w);
            prop_assert!(e <= other.residual(&from, &to, &w) + slack(&to, &from));
        }
    }

    #[test]
    fn similarity_beats_every_scaled_rotation((from, to, w) in correspondence(), lo in 0.3..1.0f64, range in 1.0..2.5f64) {
        let class = Similarity { min_scale: lo, max_scale: lo * range };
        let best = class.register(&from, &to, &w);
        let scale = best.determinant().sqrt();
        prop_assert!(scale >= lo - 1e-12 && scale <= lo * range + 1e-12);
        let e = best.residual(&from, &to, &w);
        for i in 0..180 {
            for j in 0..=10 {
                let s = lo * (1.0 + (range - 1.0) * f64::from(j) / 10.0);
                let other = centred(rotated(f64::from(2 * i).to_radians(), s, s), &from, &to, &w);
                prop_assert!(e <= other.residual(&from, &to, &w) + slack(&to, &from));
            }
        }
    }

    /// Brute force over a grid of rotations with both scales on grids; the grid
    /// must not beat the registration anywhere.
    #[test]
    fn principal_affine_beats_the_grid((from, to, w) in correspondence(), x in 0.5..1.0f64, y in 0.5..1.0f64, range in 1.0..2.0f64) {
        let class = PrincipalAffine { x: [x, x * range], y: [y, y * range] };
        let best = class.register(&from, &to, &w);
        let e = best.residual(&from, &to, &w);
        // Its matrix is a rotation times two scales within their ranges.
        let [[a, b], [c, d]] = best.linear;
        let (sx, sy) = (a.hypot(c), b.hypot(d));
        prop_assert!((a * b + c * d).abs() < 1e-9 && a * d - b * c > 0.0);
        prop_assert!(sx > x - 1e-9 && sx < x * range + 1e-9 && sy > y - 1e-9 && sy < y * range + 1e-9);
        for i in 0..180 {
            for j in 0..=6 {
                for k in 0..=6 {
                    let sx = x * (1.0 + (range - 1.0) * f64::from(j) / 6.0);
                    let sy = y * (1.0 + (range - 1.0) * f64::from(k) / 6.0);
                    let other = centred(rotated(f64::from(2 * i).to_radians(), sx, sy), &from, &to, &w);
                    prop_assert!(e <= other.residual(&from, &to, &w) + slack(&to, &from), "{i} {sx} {sy}");
                }
            }
        }
    }

    /// Random matrices of the class, and the best free affine map pulled into
    /// it, do not beat the registration.
    #[test]
    fn area_affine_beats_random_maps(
        (from, to, w) in correspondence(),
        ratio in 1.0..3.0f64,
        tries in prop::collection::vec(prop::array::uniform4(-2.0..2.0f64), 200),
    ) {
        let class = AreaAffine { max_area_ratio: ratio };
        let best = class.register(&from, &to, &w);
        let det = best.determinant();
        prop_assert!(det >= 1.0 / ratio * (1.0 - 1e-6) && det <= ratio * (1.0 + 1e-6), "{det}");
        let e = best.residual(&from, &to, &w);
        for t in tries {
            // Around the result, and all over: both scaled into the class.
            for (k, near) in [(0.02, true), (0.2, true), (1.0, false)] {
                let mut a = [[k * t[0], k * t[1]], [k * t[2], k * t[3]]];
                if near {
                    for (row, own) in a.iter_mut().zip(best.linear) {
                        row[0] += own[0];
                        row[1] += own[1];
                    }
                }
                let d = a[0][0] * a[1][1] - a[0][1] * a[1][0];
                if d <= 1e-6 {
                    continue;
                }
                let f = (d.clamp(1.0 / ratio, ratio) / d).sqrt();
                let a = a.map(|row| row.map(|v| v * f));
                // Flat faces leave the map undetermined across; they have their
                // own rule (a similarity), so compare within rounding only.
                let flat = from.iter().map(|q| q.y.abs()).fold(0.0, f64::max) < 0.1;
                if !flat {
                    prop_assert!(e <= centred(a, &from, &to, &w).residual(&from, &to, &w) + slack(&to, &from), "{a:?}");
                }
            }
        }
    }

    /// Registering to an image of the class gives that image: no residual.
    #[test]
    fn maps_of_the_class_are_found((from, _, w) in correspondence(), angle in -3.2..3.2f64, sx in 0.8..1.25f64, sy in 0.8..1.25f64) {
        let map = |a: [[f64; 2]; 2]| -> Vec<P> { let m = Affine { linear: a, translation: coord! { x: 12.0, y: -5.0 } }; from.iter().map(|&q| m.apply(q)).collect() };
        let zero = |class: &dyn Deformation, to: &[P]| class.register(&from, to, &w).residual(&from, to, &w) <= slack(to, &from);
        let similarity = Similarity { min_scale: 0.8, max_scale: 1.25 };
        let principal = PrincipalAffine { x: [0.8, 1.25], y: [0.8, 1.25] };
        let area = AreaAffine { max_area_ratio: 1.6 };
        prop_assert!(zero(&Rigid, &map(rotated(angle, 1.0, 1.0))), "rigid");
        prop_assert!(zero(&similarity, &map(rotated(angle, sx, sx))), "similarity");
        prop_assert!(zero(&principal, &map(rotated(angle, sx, sy))), "principal");
        prop_assert!(zero(&area, &map(rotated(angle, sx, sy))), "area");
    }
}
