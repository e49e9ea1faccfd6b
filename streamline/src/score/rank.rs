//! All scores together: the order of the candidates, and a choice among them.

use super::Score;
use crate::field::DirectionField;
use crate::random::Stream;
use crate::streamline::Streamline;

/// A candidate with its scores.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ranked {
    /// Position of the line in the list that was ranked.
    pub index: usize,
    /// Weighted sum of the parts: lower is better.
    pub total: f64,
    /// Each score's cost, normalised over the candidates to [0, 1], in the
    /// order of the scores.
    pub parts: Vec<f64>,
    /// Each score's cost as it was, in its own unit.
    pub raw: Vec<f64>,
}

/// Ranks candidates by the weighted sum of their normalised scores, the best
/// first; of equals the one earlier in the list.
///
/// Each score's finite costs are mapped to [0, 1] by their minimum and maximum
/// over the candidates; if these are equal all become 0. Costs that are not
/// finite become 1, the worst. A weight that is not finite counts as 0. The
/// paper's default is all four scores with weight 1.
///
/// # Complexity
///
/// Each score once for each line, on all threads with the feature `rayon`,
/// and a sort.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, polygon};
/// use streamline::{from_fn, rank, trace, Divergence, SingularityDistance, TraceOptions};
///
/// let domain = polygon![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 90.), (x: 0., y: 90.)];
/// let east = from_fn(domain, |_, _| Some(coord! { x: 1.0, y: 0.0 }));
/// let lines: Vec<_> = [20.0, 50.0, 70.0]
///     .map(|y| trace(&east, coord! { x: 45., y: y }, coord! { x: 1., y: 0. }, &TraceOptions::default()))
///     .into_iter()
///     .collect::<Result<_, _>>()?;
/// let near = SingularityDistance { singularities: vec![coord! { x: 10., y: 55. }] };
/// let ranked = rank(&lines, &east, &[(&Divergence::default(), 1.0), (&near, 1.0)]);
/// assert_eq!(ranked[0].index, 1);
/// assert_eq!(ranked[2].parts[1], 1.0);
/// # Ok::<(), streamline::TraceError>(())
/// ```
///
/// # References
///
/// Yang, Wang, Vouga, Wonka 2013, section 5, "Quality Score" (all four are
/// costs here; the paper leaves the signs to the reader).
pub fn rank(
    lines: &[Streamline],
    field: &dyn DirectionField,
    scores: &[(&dyn Score, f64)],
) -> Vec<Ranked> {
    let raw = cost_all(lines, |line| {
        scores
            .iter()
            .map(|(score, _)| score.cost(line, field))
            .collect::<Vec<f64>>()
    });
    let ranges: Vec<(f64, f64)> = (0..scores.len())
        .map(|k| {
            let finite = raw
                .iter()
                .map(|costs| costs[k])
                .filter(|cost| cost.is_finite());
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), cost| {
                (low.min(cost), high.max(cost))
            })
        })
        .collect();
    let mut ranked: Vec<Ranked> =
        raw.into_iter()
            .enumerate()
            .map(|(index, raw)| {
                let parts: Vec<f64> = raw
                    .iter()
                    .zip(&ranges)
                    .map(|(&cost, &range)| normalise(cost, range))
                    .collect();
                let weighted = parts.iter().zip(scores).map(|(part, (_, weight))| {
                    part * if weight.is_finite() { *weight } else { 0.0 }
                });
                Ranked {
                    index,
                    total: weighted.sum(),
                    parts,
                    raw,
                }
            })
            .collect();
    ranked.sort_by(|a, b| a.total.total_cmp(&b.total).then(a.index.cmp(&b.index)));
    ranked
}

fn normalise(cost: f64, (low, high): (f64, f64)) -> f64 {
    if !cost.is_finite() {
        1.0
    } else if high > low {
        // Halved, so that the range of huge costs does not overflow.
        ((0.5 * cost - 0.5 * low) / (0.5 * high - 0.5 * low)).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Chooses among ranked candidates at random by quality: each with a weight of
/// exp(-(total - best) / temperature). Temperature 0 takes the best, a high one
/// nearly any. Answers with a position in `ranked`; `None` only if it is empty.
///
/// The same arguments give the same choice (PCG XSL RR 128/64). A temperature
/// that is NaN or negative counts as 0.
#[must_use]
pub fn choose(ranked: &[Ranked], seed: u64, temperature: f64) -> Option<usize> {
    let best = ranked
        .iter()
        .map(|r| r.total)
        .filter(|t| !t.is_nan())
        .min_by(f64::total_cmp)?;
    let place = ranked.iter().position(|r| r.total == best)?;
    if temperature.is_nan() || temperature <= 0.0 || !best.is_finite() {
        return Some(place);
    }
    let weight = |r: &Ranked| {
        if r.total.is_finite() {
            (-(r.total - best) / temperature).exp()
        } else {
            0.0
        }
    };
    let sum: f64 = ranked.iter().map(weight).sum();
    let mut rest = Stream::new(seed).unit() * sum;
    for (i, r) in ranked.iter().enumerate() {
        rest -= weight(r);
        if rest < 0.0 {
            return Some(i);
        }
    }
    Some(place)
}

#[cfg(not(feature = "rayon"))]
fn cost_all<R>(lines: &[Streamline], f: impl Fn(&Streamline) -> R) -> Vec<R> {
    lines.iter().map(f).collect()
}

#[cfg(feature = "rayon")]
fn cost_all<R: Send>(lines: &[Streamline], f: impl Fn(&Streamline) -> R + Sync + Send) -> Vec<R> {
    use rayon::prelude::*;
    lines.par_iter().map(f).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::from_fn;
    use crate::trace::Stop;
    use crate::vector::point;
    use geo_types::polygon;

    /// Costs read off a table by the line's `seed_index`.
    struct Fixed(Vec<f64>);
    impl Score for Fixed {
        fn name(&self) -> &str {
            "fixed"
        }
        fn cost(&self, line: &Streamline, _: &dyn DirectionField) -> f64 {
            self.0[line.seed_index]
        }
    }

    fn ranked(costs: &[&[f64]], weights: &[f64]) -> Vec<Ranked> {
        let field = from_fn(
            polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.)],
            |_, heading| Some(heading),
        );
        let seed = point(0.0, 0.0);
        let line = |seed_index| Streamline {
            points: vec![seed],
            start: Stop::FieldEnd,
            end: Stop::FieldEnd,
            seed,
            family: 0,
            seed_index,
        };
        let lines: Vec<_> = (0..costs[0].len()).map(line).collect();
        let fixed: Vec<_> = costs.iter().map(|c| Fixed(c.to_vec())).collect();
        let scores: Vec<(&dyn Score, f64)> = fixed
            .iter()
            .zip(weights)
            .map(|(f, &w)| (f as &dyn Score, w))
            .collect();
        rank(&lines, &field, &scores)
    }

    #[test]
    fn costs_are_normalised_weighted_and_sorted() {
        let r = ranked(&[&[10.0, 30.0, 20.0], &[5.0, 5.0, 5.0]], &[2.0, 1.0]);
        assert_eq!(r.iter().map(|r| r.index).collect::<Vec<_>>(), [0, 2, 1]);
        assert_eq!(
            r.iter().map(|r| r.total).collect::<Vec<_>>(),
            [0.0, 1.0, 2.0]
        );
        assert_eq!(r[1].parts, [0.5, 0.0]);
        assert_eq!(r[1].raw, [20.0, 5.0]);
    }

    #[test]
    fn ties_keep_their_order_and_nonsense_is_the_worst() {
        let r = ranked(&[&[f64::NAN, 1.0, f64::INFINITY, 1.0, 3.0]], &[1.0]);
        assert_eq!(
            r.iter().map(|r| r.index).collect::<Vec<_>>(),
            [1, 3, 0, 2, 4]
        );
        assert!(r.iter().all(|r| r.total.is_finite()));
        let r = ranked(&[&[f64::NAN, f64::NAN]], &[f64::NAN]);
        assert!(r.iter().all(|r| r.total == 0.0 && r.parts == [1.0]));
        let r = ranked(&[&[-f64::MAX, f64::MAX, 0.0]], &[1.0]);
        assert_eq!(r[1].parts, [0.5]);
    }

    #[test]
    fn choice_follows_quality_and_seed() {
        let r = ranked(&[&[0.0, 0.5, 1.0, 1.0]], &[1.0]);
        assert_eq!(choose(&[], 1, 1.0), None);
        assert!((0..50).all(|seed| choose(&r, seed, 0.0) == Some(0)));
        assert!((0..50).all(|seed| choose(&r, seed, f64::NAN) == Some(0)));
        let count = |temperature: f64| {
            let mut count = [0; 4];
            (0..2000).for_each(|seed| count[choose(&r, seed, temperature).unwrap()] += 1);
            count
        };
        let warm = count(0.5);
        // Weights 1, e^-1, e^-2, e^-2: the first takes 61 % of the draws.
        assert!(
            (1130..1310).contains(&warm[0]) && warm[1] > warm[2] && warm[3] > 100,
            "{warm:?}"
        );
        assert!(count(f64::INFINITY).iter().all(|&n| n > 400));
        assert_eq!(choose(&r, 7, 0.5), choose(&r, 7, 0.5));
    }
}
