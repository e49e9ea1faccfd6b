//! Continuity: how often a line turns.

use super::{CriteriaOptions, TurnRule};
use crate::streamline::Streamline;
use crate::vector::{distance, turn, Point};
use std::collections::VecDeque;

/// A polyline without its doubled points: arc length and signed turn at each
/// inner vertex, and at the seam of a closed line.
struct Bends(Vec<(f64, f64)>);

impl Bends {
    fn new(points: &[Point], closed: bool) -> Self {
        let mut kept: Vec<Point> = points.to_vec();
        kept.dedup();
        let mut bends = Vec::with_capacity(kept.len());
        let mut passed = 0.0;
        for p in kept.windows(3) {
            passed += distance(p[0], p[1]);
            bends.push((passed, turn(p[1] - p[0], p[2] - p[1])));
        }
        let n = kept.len();
        if closed && n > 2 {
            passed += distance(kept[n - 2], kept[n - 1]);
            bends.push((passed, turn(kept[n - 1] - kept[n - 2], kept[1] - kept[0])));
        }
        Self(bends)
    }
}

/// Where along a line it turns, by arc length in metres, ascending: the end of
/// the stretch, or the point between two segments.
pub(super) fn turns(line: &Streamline, options: &CriteriaOptions) -> Vec<f64> {
    let limit = options.angle_deg.to_radians();
    match options.turns {
        TurnRule::Stretches => stretches(
            &Bends::new(&line.points, line.is_closed()),
            options.region,
            limit,
        ),
        TurnRule::Segments => {
            let points = line.resample(options.region).points;
            let bends = Bends::new(&points, line.is_closed());
            let beyond = bends.0.into_iter().filter(|bend| bend.1.abs() > limit);
            beyond.map(|bend| bend.0).collect()
        }
    }
}

/// Total absolute turn of a line, in radians.
pub(super) fn turning(line: &Streamline) -> f64 {
    let bends = Bends::new(&line.points, line.is_closed());
    bends.0.iter().map(|bend| bend.1.abs()).sum()
}

/// The largest number of disjoint stretches within which the direction changes
/// by more than `limit`: each is taken where it ends first, which leaves most
/// room for the others.
///
/// Directions count before and behind each bend, so a stretch from bend `i` to
/// bend `j` changes the direction by the turns of both and of all between.
fn stretches(bends: &Bends, region: f64, limit: f64) -> Vec<f64> {
    let mut found = Vec::new();
    // Directions, as sums of turns, that a stretch may start from, each with
    // the place of the bend behind it: those of the window that are least and
    // greatest so far, best first.
    let mut low: VecDeque<(f64, f64)> = VecDeque::new();
    let mut high: VecDeque<(f64, f64)> = VecDeque::new();
    let mut direction = 0.0;
    for &(at, angle) in &bends.0 {
        while low.back().is_some_and(|&(_, d)| d >= direction) {
            low.pop_back();
        }
        while high.back().is_some_and(|&(_, d)| d <= direction) {
            high.pop_back();
        }
        low.push_back((at, direction));
        high.push_back((at, direction));
        for queue in [&mut low, &mut high] {
            while queue.front().is_some_and(|&(from, _)| at - from > region) {
                queue.pop_front();
            }
        }
        direction += angle;
        let least = low.front().map_or(direction, |&(_, d)| d);
        let most = high.front().map_or(direction, |&(_, d)| d);
        if direction - least > limit || most - direction > limit {
            found.push(at);
            low.clear();
            high.clear();
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Stop;
    use crate::vector::point;

    fn line(points: &[(f64, f64)], end: Stop) -> Streamline {
        let points: Vec<Point> = points.iter().map(|&(x, y)| point(x, y)).collect();
        Streamline {
            seed: points[0],
            points,
            start: end,
            end,
            family: 0,
            seed_index: 0,
        }
    }

    /// From the origin: lengths and then turns to the left, in degrees.
    fn walk(steps: &[(f64, f64)]) -> Streamline {
        let (mut at, mut way) = (point(0.0, 0.0), 0.0_f64);
        let mut points = vec![(0.0, 0.0)];
        for &(length, turn) in steps {
            at = at + point(way.cos(), way.sin()) * length;
            way += turn.to_radians();
            points.push((at.x, at.y));
        }
        line(&points, Stop::LengthLimit)
    }

    fn count(line: &Streamline, turns_by: TurnRule) -> usize {
        let options = CriteriaOptions {
            turns: turns_by,
            ..CriteriaOptions::default()
        };
        turns(line, &options).len()
    }

    #[test]
    fn a_kink_is_a_turn_from_its_angle_on() {
        for (angle, wanted) in [(19.9, 0), (20.1, 1), (-90.0, 1), (-19.9, 0)] {
            let kinked = walk(&[(50.0, angle), (50.0, 0.0)]);
            assert_eq!(count(&kinked, TurnRule::Stretches), wanted, "{angle}");
        }
        assert_eq!(
            turns(
                &walk(&[(50.0, 30.0), (50.0, 0.0)]),
                &CriteriaOptions::default()
            ),
            [50.0]
        );
    }

    #[test]
    fn what_turns_within_the_region_is_one_turn() {
        // 15 and 15 degrees, 3 m apart, 5 m apart; there and back again.
        assert_eq!(
            count(
                &walk(&[(50.0, 15.0), (3.0, 15.0), (50.0, 0.0)]),
                TurnRule::Stretches
            ),
            1
        );
        assert_eq!(
            count(
                &walk(&[(50.0, 15.0), (5.0, 15.0), (50.0, 0.0)]),
                TurnRule::Stretches
            ),
            0
        );
        assert_eq!(
            count(
                &walk(&[(50.0, 15.0), (3.0, -15.0), (50.0, 0.0)]),
                TurnRule::Stretches
            ),
            0
        );
        // Each kink is a turn of its own, however near.
        assert_eq!(
            count(
                &walk(&[(50.0, 90.0), (1.0, -90.0), (50.0, 0.0)]),
                TurnRule::Stretches
            ),
            2
        );
        // A circle of radius 5 in bends of 5.5 degrees, 0.48 m apart: four of
        // them are a turn of 22 degrees within 1.4 m. The last step has no bend.
        let circle = walk(&vec![(10.0 * 2.75_f64.to_radians().sin(), 5.5); 65]);
        assert_eq!(count(&circle, TurnRule::Stretches), 64 / 4);
        let wide = walk(&vec![(1.0, 2.0); 180]);
        assert_eq!(count(&wide, TurnRule::Stretches), 0, "10 degrees in 4 m");
    }

    #[test]
    fn a_segment_may_share_a_kink_out() {
        // 32 m in eight segments of 4: the kink lies on a division, then in
        // the middle of a segment, where 30 degrees are 15 and 15.
        let on = walk(&[(16.0, 30.0), (16.0, 0.0)]);
        let within = walk(&[(14.0, 30.0), (18.0, 0.0)]);
        assert_eq!(count(&on, TurnRule::Segments), 1);
        assert_eq!(count(&within, TurnRule::Segments), 0);
        assert_eq!(count(&within, TurnRule::Stretches), 1);
    }

    #[test]
    fn a_closed_line_turns_at_its_seam_too() {
        let square = [(0., 0.), (50., 0.), (50., 50.), (0., 50.), (0., 0.)];
        let closed = line(&square, Stop::ClosedLoop);
        assert_eq!(count(&closed, TurnRule::Stretches), 4);
        assert!((turning(&closed) - std::f64::consts::TAU).abs() < 1e-12);
        assert_eq!(
            count(&line(&square, Stop::LengthLimit), TurnRule::Stretches),
            3
        );
    }

    #[test]
    fn short_and_doubled_points_do_no_harm() {
        assert!(turns(
            &line(&[(1., 1.)], Stop::FieldEnd),
            &CriteriaOptions::default()
        )
        .is_empty());
        let doubled = line(
            &[(0., 0.), (9., 0.), (9., 0.), (9., 9.), (9., 9.)],
            Stop::FieldEnd,
        );
        assert_eq!(count(&doubled, TurnRule::Stretches), 1);
        let still = line(&[(1., 1.), (1., 1.), (1., 1.)], Stop::FieldEnd);
        assert_eq!(count(&still, TurnRule::Stretches), 0);
        assert_eq!(count(&still, TurnRule::Segments), 0);
    }
}
