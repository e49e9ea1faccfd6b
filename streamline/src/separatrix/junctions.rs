//! Who stops whom where separatrices meet.

use super::{Separatrix, SeparatrixEnd};
use crate::vector::{cross, distance, Point};
use rstar::{primitives::GeomWithData, primitives::Line, RTree, RTreeObject};

/// Where a line meets one that was there before.
struct Meeting {
    /// When it gets there.
    time: f64,
    /// Which line arrives, and on which piece.
    late: usize,
    piece: usize,
    /// Which was there, and when it had come by.
    early: usize,
    passed: f64,
    at: Point,
}

/// Ends each line at the first meeting with one that came by before and had not
/// ended by then.
///
/// In the order of arrival: whether the earlier line got as far as the meeting
/// was settled by meetings before it. Of two that arrive together the first in
/// the list goes on.
pub(super) fn cut(lines: &mut [Separatrix]) {
    let arcs: Vec<Vec<f64>> = lines.iter().map(|line| arcs(&line.points)).collect();
    let mut meetings = meetings(lines, &arcs);
    meetings.sort_by(|a, b| {
        a.time
            .total_cmp(&b.time)
            .then(a.late.cmp(&b.late))
            .then(a.early.cmp(&b.early))
    });
    let mut length = vec![f64::INFINITY; lines.len()];
    for meeting in meetings {
        if meeting.time > length[meeting.late] || meeting.passed > length[meeting.early] {
            continue;
        }
        if length[meeting.late].is_finite() {
            continue;
        }
        length[meeting.late] = meeting.time;
        let line = &mut lines[meeting.late];
        line.points.truncate(meeting.piece + 1);
        if line.points.last() != Some(&meeting.at) {
            line.points.push(meeting.at);
        }
        line.end = SeparatrixEnd::Junction {
            separatrix: meeting.early,
        };
    }
}

fn arcs(points: &[Point]) -> Vec<f64> {
    let mut gone = 0.0;
    let mut arcs = vec![0.0];
    for pair in points.windows(2) {
        gone += distance(pair[0], pair[1]);
        arcs.push(gone);
    }
    arcs
}

/// All crossings of pieces, those at common singularities excepted.
fn meetings(lines: &[Separatrix], arcs: &[Vec<f64>]) -> Vec<Meeting> {
    let whole = |l: usize| matches!(lines[l].end, SeparatrixEnd::Singularity { .. });
    let origin = lines.first().map_or(Point::zero(), |line| line.points[0]);
    let mut pieces = Vec::new();
    for (l, line) in lines.iter().enumerate() {
        for (i, pair) in line.points.windows(2).enumerate() {
            let (a, b) = (pair[0] - origin, pair[1] - origin);
            pieces.push(GeomWithData::new(Line::new([a.x, a.y], [b.x, b.y]), (l, i)));
        }
    }
    let tree = RTree::bulk_load(pieces.clone());
    let mut meetings = Vec::new();
    for piece in &pieces {
        let (l, i) = piece.data;
        for other in tree.locate_in_envelope_intersecting(&piece.envelope()) {
            let (m, j) = other.data;
            if (m, j) <= (l, i)
                || share_singularity(lines, (l, i), (m, j))
                || (l == m && j == i + 1)
            {
                continue;
            }
            let (a, b) = (lines[l].points[i], lines[l].points[i + 1]);
            let (c, d) = (lines[m].points[j], lines[m].points[j + 1]);
            let Some((t, u)) = crossing(a, b, c, d) else {
                continue;
            };
            let when = |l: usize, i: usize, t: f64| {
                if whole(l) {
                    0.0
                } else {
                    arcs[l][i] + t * (arcs[l][i + 1] - arcs[l][i])
                }
            };
            let (first, second) = (when(l, i, t), when(m, j, u));
            let (late, piece, time, early, passed) = if first > second {
                (l, i, first, m, second)
            } else {
                (m, j, second, l, first)
            };
            if whole(late) {
                continue; // Two between singularities: neither is cut.
            }
            meetings.push(Meeting {
                time,
                late,
                piece,
                early,
                passed,
                at: a + (b - a) * t,
            });
        }
    }
    meetings
}

/// Pieces next to the same singularity meet there.
fn share_singularity(lines: &[Separatrix], (l, i): (usize, usize), (m, j): (usize, usize)) -> bool {
    let ends = |l: usize, i: usize| {
        let line = &lines[l];
        let start = (i == 0).then_some(line.singularity);
        let end = match line.end {
            SeparatrixEnd::Singularity { index, .. } if i + 2 == line.points.len() => Some(index),
            _ => None,
        };
        [start, end]
    };
    let other = ends(m, j);
    ends(l, i)
        .iter()
        .any(|one| one.is_some() && other.contains(one))
}

/// Parameters of the point that two pieces share, ends included; none where
/// they are parallel.
fn crossing(a: Point, b: Point, c: Point, d: Point) -> Option<(f64, f64)> {
    let (e, f) = (b - a, d - c);
    let area = cross(e, f);
    if area == 0.0 {
        return None;
    }
    let t = cross(c - a, f) / area;
    let u = cross(c - a, e) / area;
    let inside = |v: f64| (0.0..=1.0).contains(&v);
    (inside(t) && inside(u)).then_some((t, u))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Stop;
    use crate::vector::point;

    fn line(singularity: usize, points: &[(f64, f64)]) -> Separatrix {
        Separatrix {
            singularity,
            arm: 0,
            points: points.iter().map(|&(x, y)| point(x, y)).collect(),
            end: SeparatrixEnd::Stop(Stop::LengthLimit),
        }
    }

    #[test]
    fn who_was_there_first_goes_on_and_who_was_stopped_stops_nobody() {
        // The second reaches the first's way after 10, the first after 20. The
        // third would be stopped by the first at (30, 0), which never comes
        // there.
        let mut lines = vec![
            line(0, &[(0., 0.), (50., 0.)]),
            line(1, &[(20., -10.), (20., 40.)]),
            line(2, &[(30., -35.), (30., 40.)]),
        ];
        cut(&mut lines);
        assert_eq!(lines[0].points[1], point(20.0, 0.0));
        assert_eq!(lines[0].end, SeparatrixEnd::Junction { separatrix: 1 });
        assert_eq!(lines[1].end, SeparatrixEnd::Stop(Stop::LengthLimit));
        assert_eq!(lines[2].end, SeparatrixEnd::Stop(Stop::LengthLimit));
    }

    #[test]
    fn lines_between_singularities_are_never_cut() {
        let mut lines = vec![
            line(0, &[(20., -1.), (20., 40.)]),
            line(1, &[(0., 0.), (30., 0.), (50., 0.)]),
        ];
        lines[1].end = SeparatrixEnd::Singularity { index: 5, arm: 0 };
        let whole = lines[1].clone();
        cut(&mut lines);
        assert_eq!(lines[1], whole);
        assert_eq!(lines[0].points[1], point(20.0, 0.0));
    }

    #[test]
    fn a_line_stops_at_itself() {
        let mut lines = vec![line(
            0,
            &[(0., 0.), (9., 0.), (9., 5.), (4., 5.), (4., -5.)],
        )];
        cut(&mut lines);
        assert_eq!(lines[0].points.last(), Some(&point(4.0, 0.0)));
        assert_eq!(lines[0].end, SeparatrixEnd::Junction { separatrix: 0 });
    }
}
