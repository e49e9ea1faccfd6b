//! Search for a maximum without derivatives.

/// Rounds at most, whatever is found.
const ROUNDS: usize = 400;

/// Goes uphill from `start`, along one axis at a time, with steps that are halved
/// where none leads up (Hooke and Jeeves' pattern search, with their leap along
/// what a round has found), until they are the share `least` of the first ones.
pub(crate) fn climb<const N: usize>(
    start: [f64; N],
    step: [f64; N],
    least: f64,
    height: impl Fn(&[f64; N]) -> f64,
) -> ([f64; N], f64) {
    let (mut at, mut best) = (start, height(&start));
    let mut scale = 1.0;
    for _ in 0..ROUNDS {
        let (before, low) = (at, best);
        for k in 0..N {
            for sign in [1.0, -1.0] {
                let mut next = at;
                next[k] += sign * scale * step[k];
                let found = height(&next);
                if found > best {
                    (at, best) = (next, found);
                    break;
                }
            }
        }
        if best > low {
            let mut leap = at;
            for k in 0..N {
                leap[k] += at[k] - before[k];
            }
            let found = height(&leap);
            if found > best {
                (at, best) = (leap, found);
            }
        } else {
            scale *= 0.5;
            if scale < least {
                break;
            }
        }
    }
    (at, best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_top_of_a_hill() {
        let hill = |p: &[f64; 2]| -(p[0] - 3.0).powi(2) - 4.0 * (p[1] + 1.0 - 0.2 * p[0]).powi(2);
        let (at, top) = climb([0.0, 0.0], [1.0, 1.0], 1e-10, hill);
        assert!(
            (at[0] - 3.0).abs() < 1e-4 && (at[1] + 0.4).abs() < 1e-4,
            "{at:?}"
        );
        assert!(top > -1e-8);
    }
}
