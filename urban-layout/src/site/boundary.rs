//! The site's boundary as lines meet it: clipping, and running along.

use geo_types::{Coord, LineString, Polygon};

use super::contact::{distance, nearest, side};
use super::index::{merged, Segments};
use super::measure::{clean_line, length, rings};
use super::ring::{extent, ROUNDING};

/// A line this near the boundary means the boundary, in metres.
pub(crate) const ALONG: f64 = 1.0;

/// Pieces shorter than this are no roads but corners touched, in metres.
const SHORTEST: f64 = 0.5;

/// The boundary of the site's parts, indexed.
#[derive(Clone, Debug)]
pub(crate) struct Boundary {
    segments: Segments,
    rings: Vec<LineString<f64>>,
    /// Length of each ring up to each of its vertices.
    lengths: Vec<Vec<f64>>,
    pub(crate) tolerance: f64,
}

/// A point on the boundary.
#[derive(Clone, Copy, Debug)]
struct Place {
    ring: usize,
    /// Length along the ring.
    along: f64,
    at: Coord<f64>,
}

/// A line divided by how it lies to the boundary.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Divided {
    /// Pieces inside, ends on the boundary where they leave.
    pub(crate) inside: Vec<Vec<Coord<f64>>>,
    /// Stretches along the boundary, put onto its own vertices.
    pub(crate) along: Vec<Vec<Coord<f64>>>,
}

impl Boundary {
    pub(crate) fn new(parts: &[Polygon<f64>]) -> Self {
        let rings: Vec<LineString<f64>> = rings(parts).cloned().collect();
        let lengths = rings
            .iter()
            .map(|ring| {
                let mut sum = 0.0;
                let mut lengths = vec![0.0];
                for w in ring.0.windows(2) {
                    sum += (w[1] - w[0]).x.hypot((w[1] - w[0]).y);
                    lengths.push(sum);
                }
                lengths
            })
            .collect();
        let all: Vec<Coord<f64>> = rings
            .iter()
            .flat_map(|ring| ring.0.iter().copied())
            .collect();
        Self {
            segments: Segments::from_lines(rings.iter().map(|ring| (ring, 0.0))),
            lengths,
            tolerance: ROUNDING * extent(&all),
            rings,
        }
    }

    /// Whether a point lies inside, or on the boundary within rounding.
    pub(crate) fn contains(&self, p: Coord<f64>) -> bool {
        self.segments.encloses(p) || self.segments.distance(p) <= self.tolerance
    }

    /// Whether the segment comes within rounding of the boundary.
    pub(crate) fn meets(&self, p: Coord<f64>, q: Coord<f64>) -> bool {
        let stretches = self.segments.stretches(p, q, Some(self.tolerance));
        !stretches.is_empty()
    }

    /// Divides a road: what runs within [`ALONG`] of the boundary for longer
    /// than its own width (4 m at least) is put onto the boundary; of the rest,
    /// what lies inside is kept. A road that merely crosses the boundary, at any
    /// angle over 10 degrees, is divided at the boundary itself.
    pub(crate) fn divide(&self, line: &[Coord<f64>], width: f64) -> Divided {
        let mut divided = Divided::default();
        let least = width.max(4.0 * ALONG);
        for (along, mut piece) in self.pieces(line, least) {
            if along {
                divided.along.extend(self.snapped(&piece));
                continue;
            }
            // Ends that join a stretch along the boundary follow it there.
            let last = piece.len() - 1;
            if piece[0] != line[0] {
                piece[0] = self.project(piece[0]);
            }
            if piece[last] != line[line.len() - 1] {
                piece[last] = self.project(piece[last]);
            }
            divided.inside.extend(self.clip(&piece));
        }
        divided
    }

    fn project(&self, p: Coord<f64>) -> Coord<f64> {
        self.place(p).map_or(p, |place| place.at)
    }

    /// Where on the boundary a point beside it belongs: the nearest point, or
    /// the vertex within [`ALONG`] of that, so that a road that starts beside a
    /// corner starts at the corner.
    fn place(&self, p: Coord<f64>) -> Option<Place> {
        let (segment, mut t, mut at) = self.segments.nearest(p)?;
        let gap = |q: Coord<f64>| (q - at).x.hypot((q - at).y);
        let (a, b) = (gap(segment.a), gap(segment.b));
        if a.min(b) <= ALONG {
            (t, at) = if a <= b {
                (0.0, segment.a)
            } else {
                (1.0, segment.b)
            };
        }
        let (ring, k) = segment.id;
        let lengths = &self.lengths[ring];
        let along = lengths[k] + t * (lengths[k + 1] - lengths[k]);
        Some(Place { ring, along, at })
    }

    /// The line cut where it begins and ceases to run along the boundary.
    fn pieces(&self, line: &[Coord<f64>], least: f64) -> Vec<(bool, Vec<Coord<f64>>)> {
        let mut near = Vec::new();
        let mut start = 0.0;
        for w in line.windows(2) {
            let len = length(w);
            let pad = 1e-6 * ALONG;
            for (from, to) in self.segments.stretches(w[0], w[1], Some(ALONG)) {
                near.push((start + from * len - pad, start + to * len + pad));
            }
            start += len;
        }
        let total = start;
        let stretches: Vec<(f64, f64)> = merged(near)
            .into_iter()
            .map(|(from, to)| (from.max(0.0), to.min(total)))
            .filter(|(from, to)| to - from > least)
            .collect();
        if stretches.is_empty() {
            return vec![(false, line.to_vec())];
        }
        let mut pieces = Vec::new();
        let mut done = 0.0;
        for (from, to) in stretches {
            pieces.push((false, cut(line, done, from)));
            pieces.push((true, cut(line, from, to)));
            done = to;
        }
        pieces.push((false, cut(line, done, total)));
        pieces.retain(|(_, piece)| piece.len() > 1 && length(piece) > self.tolerance);
        pieces
    }

    /// The stretches of boundary beside a line that runs along it.
    fn snapped(&self, line: &[Coord<f64>]) -> Vec<Vec<Coord<f64>>> {
        let mut chains = Vec::new();
        let mut chain: Vec<Coord<f64>> = Vec::new();
        let mut before: Option<Place> = None;
        for &p in line {
            let Some(here) = self.place(p) else {
                return chains;
            };
            let between = before.filter(|b| b.ring == here.ring).and_then(|before| {
                let gap = (here.at - before.at).x.hypot((here.at - before.at).y);
                let (arc, vertices) = self.shorter_arc(here.ring, before.along, here.along);
                // Farther than that is another side of a narrow site.
                (arc <= 2.0 * gap + 10.0 * ALONG).then_some(vertices)
            });
            match between {
                Some(vertices) => chain.extend(vertices),
                None => chains.push(std::mem::take(&mut chain)),
            }
            chain.push(here.at);
            before = Some(here);
        }
        chains.push(chain);
        chains
            .into_iter()
            .map(|chain| clean_line(chain).0)
            .filter(|chain| chain.len() > 1)
            .collect()
    }

    /// Length of the shorter way around a ring between two places on it, and
    /// the vertices passed.
    fn shorter_arc(&self, ring: usize, from: f64, to: f64) -> (f64, Vec<Coord<f64>>) {
        let lengths = &self.lengths[ring];
        let points = &self.rings[ring].0;
        let whole = lengths[lengths.len() - 1];
        let (low, high) = (from.min(to), from.max(to));
        let direct = high - low;
        // The closing vertex is the first: leave it out.
        let count = points.len() - 1;
        let first_over = |s: f64| lengths[..count].partition_point(|&l| l <= s);
        let first_from = |s: f64| lengths[..count].partition_point(|&l| l < s);
        let mut passed: Vec<usize> = if direct <= whole - direct {
            (first_over(low)..first_from(high)).collect()
        } else {
            (first_over(high)..count)
                .chain(0..first_from(low))
                .collect()
        };
        // `passed` leads from low to high directly, or from high around to low.
        let forwards = (direct <= whole - direct) == (from <= to);
        if !forwards {
            passed.reverse();
        }
        let arc = direct.min(whole - direct);
        (arc, passed.into_iter().map(|k| points[k]).collect())
    }

    /// The pieces of a line inside the boundary, in its direction.
    pub(crate) fn clip(&self, line: &[Coord<f64>]) -> Vec<Vec<Coord<f64>>> {
        let mut pieces: Vec<Vec<Coord<f64>>> = Vec::new();
        let mut open = false;
        for w in line.windows(2) {
            let cuts = self.cuts(w[0], w[1]);
            for pair in cuts.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                let inside = self.contains((a + b) / 2.0);
                match pieces.last_mut() {
                    Some(piece) if inside && open => piece.push(b),
                    _ if inside => pieces.push(vec![a, b]),
                    _ => {}
                }
                open = inside;
            }
        }
        pieces.retain(|piece| length(piece) >= SHORTEST);
        pieces
    }

    /// A segment's ends and, between them, where it meets the boundary.
    fn cuts(&self, p: Coord<f64>, q: Coord<f64>) -> Vec<Coord<f64>> {
        let mut cuts: Vec<(f64, Coord<f64>)> = Vec::new();
        for s in self.segments.near(p, q, self.tolerance) {
            let mut vertex = false;
            for end in [s.a, s.b] {
                if distance(end, p, q) <= self.tolerance {
                    // The boundary's own vertex, to the bit.
                    cuts.push((nearest(end, p, q).0, end));
                    vertex = true;
                }
            }
            let (u, v) = (side(s.a, s.b, p), side(s.a, s.b, q));
            let (f, g) = (side(p, q, s.a), side(p, q, s.b));
            if !vertex && (u > 0.0) != (v > 0.0) && (f > 0.0) != (g > 0.0) {
                let t = u / (u - v);
                cuts.push((t, p + (q - p) * t));
            }
        }
        cuts.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let far = |a: Coord<f64>, b: Coord<f64>| (a - b).x.hypot((a - b).y) > self.tolerance;
        let mut out = vec![p];
        for (_, c) in cuts {
            if far(out[out.len() - 1], c) && far(c, q) {
                out.push(c);
            }
        }
        out.push(q);
        out
    }
}

/// The part of a line between two lengths along it.
fn cut(line: &[Coord<f64>], from: f64, to: f64) -> Vec<Coord<f64>> {
    let mut out = Vec::new();
    let mut start = 0.0;
    for (k, w) in line.windows(2).enumerate() {
        let len = length(w);
        let end = start + len;
        // The ends of the line themselves, to the bit.
        if k == 0 && from <= 0.0 {
            out.push(w[0]);
        } else if start <= from && from < end {
            out.push(w[0] + (w[1] - w[0]) * ((from - start) / len));
        } else if start > from && start < to {
            out.push(w[0]);
        }
        if start < to && to < end {
            out.push(w[0] + (w[1] - w[0]) * ((to - start) / len));
        } else if start < to && to == end {
            out.push(w[1]);
        }
        start = end;
    }
    if to > start {
        out.extend(line.last());
    }
    out.dedup();
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::site::boolean::oriented;

    fn points(points: &[(f64, f64)]) -> Vec<Coord<f64>> {
        points.iter().map(|&(x, y)| Coord { x, y }).collect()
    }

    /// A square of 100 m with a square hole of 20 m in its middle.
    fn boundary() -> Boundary {
        let outer = points(&[(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)]);
        let hole = points(&[(40.0, 40.0), (60.0, 40.0), (60.0, 60.0), (40.0, 60.0)]);
        Boundary::new(&[oriented(outer, vec![hole])])
    }

    #[test]
    fn a_road_across_a_hole_becomes_two() {
        let road = points(&[(-50.0, 50.0), (150.0, 50.0)]);
        let divided = boundary().divide(&road, 12.0);
        assert_eq!(divided.along.len(), 0);
        let expected = [
            points(&[(0.0, 50.0), (40.0, 50.0)]),
            points(&[(60.0, 50.0), (100.0, 50.0)]),
        ];
        assert_eq!(divided.inside.len(), 2);
        for (found, expected) in divided.inside.iter().zip(&expected) {
            for (p, q) in found.iter().zip(expected) {
                assert!((p.x - q.x).abs() < 1e-12 && p.y == q.y, "{divided:?}");
            }
        }
    }

    #[test]
    fn a_road_near_the_boundary_is_put_onto_it() {
        for off in [-0.9, 0.0, 0.9] {
            let road = points(&[(20.0, off), (90.0, off)]);
            let divided = boundary().divide(&road, 12.0);
            assert!(divided.inside.is_empty(), "{off}: {divided:?}");
            assert_eq!(divided.along, [points(&[(20.0, 0.0), (90.0, 0.0)])]);
        }
        let divided = boundary().divide(&points(&[(20.0, 1.5), (90.0, 1.5)]), 12.0);
        assert_eq!(divided.along.len(), 0);
        assert_eq!(divided.inside.len(), 1);
    }

    #[test]
    fn a_road_along_the_boundary_that_turns_in_stays_connected() {
        let road = points(&[(10.0, 0.5), (70.0, 0.5), (70.0, 30.0)]);
        let divided = boundary().divide(&road, 12.0);
        assert_eq!((divided.along.len(), divided.inside.len()), (1, 1));
        let end = divided.along[0][1];
        assert_eq!(end.y, 0.0);
        assert_eq!(divided.inside[0][0], end);
        assert_eq!(divided.inside[0][1], Coord { x: 70.0, y: 30.0 });
    }

    #[test]
    fn a_road_around_the_corner_takes_the_corner() {
        let road = points(&[(50.0, 0.2), (99.8, 0.2), (99.8, 70.0)]);
        let divided = boundary().divide(&road, 12.0);
        let corner = Coord { x: 100.0, y: 0.0 };
        assert_eq!(divided.along.len(), 1);
        assert!(divided.along[0].contains(&corner), "{divided:?}");
    }

    #[test]
    fn a_road_that_ends_inside_or_touches_a_vertex_keeps_its_ends() {
        let road = points(&[(30.0, 20.0), (80.0, 20.0), (80.0, 70.0)]);
        let divided = boundary().divide(&road, 12.0);
        assert_eq!(divided.inside, [road]);
        let through_corner = points(&[(-10.0, -10.0), (30.0, 30.0)]);
        let divided = boundary().divide(&through_corner, 12.0);
        assert_eq!(divided.inside, [points(&[(0.0, 0.0), (30.0, 30.0)])]);
    }

    #[test]
    fn a_line_is_cut_by_length() {
        let line = points(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)]);
        assert_eq!(cut(&line, 0.0, 20.0), line);
        assert_eq!(
            cut(&line, 5.0, 15.0),
            points(&[(5.0, 0.0), (10.0, 0.0), (10.0, 5.0)])
        );
        assert_eq!(cut(&line, 10.0, 20.0), points(&[(10.0, 0.0), (10.0, 10.0)]));
        assert_eq!(cut(&line, 0.0, 10.0), points(&[(0.0, 0.0), (10.0, 0.0)]));
    }
}
