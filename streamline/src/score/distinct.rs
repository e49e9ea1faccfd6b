//! Near-duplicates collapse to one.

use super::Ranked;
use crate::streamline::Streamline;
use crate::vector::{distance, nearest_on_segment, Point};
use rstar::{primitives::GeomWithData, primitives::Line, RTree};

type Piece = GeomWithData<Line<[f64; 2]>, usize>;

/// The best of each group of near-duplicates, as indices into `lines`, best
/// first.
///
/// Walks the ranking and takes a line unless it is a near-duplicate of one
/// taken before: every point of either within `separation` metres of the other
/// (Hausdorff distance). A line beside a part of a longer one is no duplicate.
/// Entries of `ranked` beyond `lines`, and lines without points, are left out.
///
/// # Complexity
///
/// One look into a spatial index for each point of each line, and the pieces
/// found there.
#[must_use]
pub fn distinct(lines: &[Streamline], ranked: &[Ranked], separation: f64) -> Vec<usize> {
    let mut taken = Vec::new();
    let mut pieces: RTree<Piece> = RTree::new();
    let origin = lines
        .iter()
        .find_map(|line| line.points.first().copied())
        .unwrap_or(geo_types::Coord::zero());
    for index in ranked.iter().map(|r| r.index) {
        let Some(line) = lines.get(index) else {
            continue;
        };
        if line.points.is_empty() || !line.points.iter().all(|&p| crate::vector::is_finite(p)) {
            continue;
        }
        let points: Vec<Point> = line.points.iter().map(|&p| p - origin).collect();
        let twin = |&other: &usize| covers(&points, &lines[other].points, origin, separation);
        if beside(&pieces, &points, separation).iter().any(twin) {
            continue;
        }
        taken.push(index);
        // A single point is a piece without length.
        let ends = points
            .windows(2)
            .map(|p| (p[0], p[1]))
            .chain((points.len() == 1).then(|| (points[0], points[0])));
        for (a, b) in ends {
            pieces.insert(Piece::new(Line::new([a.x, a.y], [b.x, b.y]), index));
        }
    }
    taken
}

/// Lines taken that have a piece within reach of every one of the points.
fn beside(pieces: &RTree<Piece>, points: &[Point], reach: f64) -> Vec<usize> {
    let mut common: Option<Vec<usize>> = None;
    for p in points {
        let mut here: Vec<usize> = pieces
            .locate_within_distance([p.x, p.y], reach * reach)
            .map(|piece| piece.data)
            .collect();
        here.sort_unstable();
        here.dedup();
        let still = match common {
            None => here,
            Some(before) => before
                .into_iter()
                .filter(|index| here.binary_search(index).is_ok())
                .collect(),
        };
        if still.is_empty() {
            return still;
        }
        common = Some(still);
    }
    common.unwrap_or_default()
}

/// True if all points of `other` lie within reach of the polyline `line`.
///
/// Both run side by side, so each point starts looking where the last one was
/// found; only then everywhere.
fn covers(line: &[Point], other: &[Point], origin: Point, reach: f64) -> bool {
    let close = |p: Point, i: usize| {
        distance(
            p,
            nearest_on_segment(p, line[i], line[(i + 1).min(line.len() - 1)]),
        ) <= reach
    };
    let mut place = 0;
    other.iter().all(|&p| {
        let p = p - origin;
        let around = (0..line.len().div_ceil(2) + 1)
            .flat_map(|k| [place + k, (place + line.len()).wrapping_sub(k)]);
        let found = around.map(|i| i % line.len()).find(|&i| close(p, i));
        found.inspect(|&i| place = i).is_some()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Stop;
    use crate::vector::point;

    fn line(points: impl Iterator<Item = Point>) -> Streamline {
        let points: Vec<Point> = points.collect();
        let seed = points.first().copied().unwrap_or(point(0.0, 0.0));
        Streamline {
            points,
            start: Stop::FieldEnd,
            end: Stop::FieldEnd,
            seed,
            family: 0,
            seed_index: 0,
        }
    }

    fn order(indices: &[usize]) -> Vec<Ranked> {
        indices
            .iter()
            .map(|&index| Ranked {
                index,
                total: 0.0,
                parts: vec![],
                raw: vec![],
            })
            .collect()
    }

    #[test]
    fn duplicates_fall_to_the_best_of_them() {
        let at = |y: f64, to: f64| line((0..=20).map(move |i| point(to * i as f64 / 20.0, y)));
        let backwards = line((0..=7).map(|i| point(100.0 - 100.0 * i as f64 / 7.0, 3.0)));
        let lines = [
            at(0.0, 100.0),
            at(4.0, 100.0),
            at(20.0, 100.0),
            at(2.0, 60.0),
            backwards,
            line(std::iter::empty()),
        ];
        assert_eq!(
            distinct(&lines, &order(&[1, 0, 2, 3, 4, 5, 77]), 5.0),
            [1, 2, 3]
        );
        assert_eq!(distinct(&lines, &order(&[0, 1, 2]), 1.0), [0, 1, 2]);
        // A short line beside a long one stays, and does not hide the long one.
        assert_eq!(distinct(&lines, &order(&[3, 0]), 5.0), [3, 0]);
        assert_eq!(distinct(&lines, &[], 5.0), Vec::<usize>::new());
    }
}
