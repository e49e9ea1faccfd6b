//! Ends of lines that miss what they end on by less than the snap distance.
//!
//! Such an end is led on to the nearest point there, and that point becomes a
//! vertex of what it lies on: no gap is left by the rounding of either.

use super::grid::{rounded, Node};
use super::snap::{Segment, Source};
use crate::vector::{distance, nearest_on_segment, nearest_parameter, Point};
use rstar::{primitives::GeomWithData, primitives::Line, RTree};

/// A piece of the input in grid units, not yet rounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raw {
    pub(super) from: Point,
    pub(super) to: Point,
    pub(super) source: Source,
}

/// An end of a line: where, and which pieces of its own line begin there and
/// may not catch it.
struct End {
    at: Point,
    line: usize,
    /// Range of pieces of its own that lie within twice the reach.
    own: std::ops::Range<usize>,
}

/// Rounds all pieces, the ends of lines joined to what lies within `reach`
/// (in grid units; 0 joins nothing).
pub(super) fn join(raw: &[Raw], lines: &[std::ops::Range<usize>], reach: f64) -> Vec<Segment> {
    let mut feet: Vec<(usize, f64, Node)> = Vec::new();
    let mut links: Vec<Segment> = Vec::new();
    if reach > 0.0 {
        let boxes = raw
            .iter()
            .enumerate()
            .map(|(i, r)| GeomWithData::new(Line::new([r.from.x, r.from.y], [r.to.x, r.to.y]), i));
        let tree = RTree::bulk_load(boxes.collect());
        for end in ends(raw, lines, reach) {
            let p = [end.at.x, end.at.y];
            let nearest = tree
                .locate_within_distance(p, reach * reach)
                .map(|found| found.data)
                .filter(|i| !end.own.contains(i))
                .map(|i| (foot(end.at, &raw[i]), i))
                // The nearest; of those equally near one that does not depend
                // on the order of the lines.
                .min_by(|(a, i), (b, j)| {
                    distance(end.at, *a)
                        .total_cmp(&distance(end.at, *b))
                        .then_with(|| order(&raw[*i], &raw[*j]))
                });
            if let Some((at, i)) = nearest {
                let node = rounded(at);
                feet.push((i, nearest_parameter(end.at, raw[i].from, raw[i].to), node));
                links.push(Segment {
                    from: rounded(end.at),
                    to: node,
                    source: Source::Line(end.line),
                });
            }
        }
    }
    feet.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut feet = feet.into_iter().peekable();
    let mut segments = Vec::with_capacity(raw.len() + 2 * links.len());
    for (i, r) in raw.iter().enumerate() {
        let mut from = rounded(r.from);
        let mut push = |to: Node| {
            if to != from {
                segments.push(Segment {
                    from,
                    to,
                    source: r.source,
                });
                from = to;
            }
        };
        while let Some((_, _, node)) = feet.next_if(|foot| foot.0 == i) {
            push(node);
        }
        push(rounded(r.to));
    }
    segments.extend(links.into_iter().filter(|s| s.from != s.to));
    segments
}

/// The piece from its lesser end to its greater: what is computed from it does
/// not depend on the sense of the line.
fn ascending(r: &Raw) -> (Point, Point) {
    let before = r
        .from
        .x
        .total_cmp(&r.to.x)
        .then(r.from.y.total_cmp(&r.to.y));
    if before.is_le() {
        (r.from, r.to)
    } else {
        (r.to, r.from)
    }
}

/// The nearest point of the piece; the point itself if that is nearer than the
/// grid can tell.
fn foot(p: Point, r: &Raw) -> Point {
    let (a, b) = ascending(r);
    let nearest = nearest_on_segment(p, a, b);
    if distance(p, nearest) <= 1.0 {
        p
    } else {
        nearest
    }
}

fn order(a: &Raw, b: &Raw) -> std::cmp::Ordering {
    let key = |r: &Raw| {
        let (a, b) = ascending(r);
        [a.x, a.y, b.x, b.y]
    };
    let (a, b) = (key(a), key(b));
    a.iter()
        .zip(&b)
        .map(|(u, v)| u.total_cmp(v))
        .find(|o| o.is_ne())
        .unwrap_or(std::cmp::Ordering::Equal)
}

/// Both ends of every line that is not closed.
fn ends(raw: &[Raw], lines: &[std::ops::Range<usize>], reach: f64) -> Vec<End> {
    let mut ends = Vec::new();
    for range in lines.iter().filter(|range| !range.is_empty()) {
        let (first, last) = (&raw[range.start], &raw[range.end - 1]);
        let Source::Line(line) = first.source else {
            continue;
        };
        if first.from == last.to {
            continue;
        }
        let mut stop = range.start;
        let mut gone = 0.0;
        while stop < range.end && gone <= 2.0 * reach {
            gone += distance(raw[stop].from, raw[stop].to);
            stop += 1;
        }
        ends.push(End {
            at: first.from,
            line,
            own: range.start..stop,
        });
        let mut start = range.end;
        gone = 0.0;
        while start > range.start && gone <= 2.0 * reach {
            start -= 1;
            gone += distance(raw[start].from, raw[start].to);
        }
        ends.push(End {
            at: last.to,
            line,
            own: start..range.end,
        });
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::point;

    #[test]
    fn a_near_miss_becomes_a_common_vertex() {
        let wall = Source::Boundary { ring: 0, edge: 0 };
        let raw = [
            Raw {
                from: point(0.0, 0.0),
                to: point(100.0, 1.0),
                source: wall,
            },
            Raw {
                from: point(50.0, 90.0),
                to: point(50.0, 3.0),
                source: Source::Line(0),
            },
        ];
        let lines = [0..0, 1..2]; // the first line was cut off wholly
                                  // The foot of (50, 3) on the wall is at (50.025, 0.500): node (50, 1).
        let joined = join(&raw, &lines, 4.0);
        let spans: Vec<_> = joined.iter().map(|s| (s.from, s.to)).collect();
        assert_eq!(
            spans,
            [
                ((0, 0), (50, 1)),
                ((50, 1), (100, 1)),
                ((50, 90), (50, 3)),
                ((50, 3), (50, 1))
            ]
        );
        assert_eq!(join(&raw, &lines, 2.0).len(), 2);
        assert_eq!(join(&raw, &lines, 0.0).len(), 2);
    }
}
