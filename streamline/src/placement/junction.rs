//! Ends in the open are cut back to the last crossing.

use crate::streamline::Streamline;
use crate::trace::Stop;
use crate::vector::{cross, distance, dot, Point};
use rstar::{primitives::GeomWithData, primitives::Line, RTree, AABB};
use std::collections::VecDeque;

/// A place on a line: piece and fraction of it, added.
type Place = f64;

/// Where two lines cross: the place on the line that was asked about, and the
/// other line with its place.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    here: Place,
    line: usize,
    there: Place,
    point: Point,
}

/// What is left of a line.
#[derive(Clone, Debug)]
struct Part {
    /// Places of the two ends.
    ends: [Place; 2],
    /// The crossings that the ends were cut to.
    cut: [Option<Crossing>; 2],
    /// Ends of other lines that were cut to this one.
    guests: Vec<(usize, usize)>,
    gone: bool,
}

type Pieces = RTree<GeomWithData<Line<[f64; 2]>, (usize, usize)>>;

/// Cuts each end in the open back to the last crossing with another line, at a
/// point of that line, and drops what gets shorter than `least` says.
///
/// A cut line may take a crossing away that another was cut to, which then is
/// cut once more: ends only move back, so that this comes to an end.
pub(super) fn cut(lines: Vec<Streamline>, least: &dyn Fn(&Streamline) -> f64) -> Vec<Streamline> {
    let pieces = index(&lines);
    let mut parts: Vec<Part> = lines
        .iter()
        .map(|line| Part {
            ends: [0.0, (line.points.len() - 1) as f64],
            cut: [None, None],
            guests: Vec::new(),
            gone: false,
        })
        .collect();
    let mut open: VecDeque<(usize, usize)> = VecDeque::new();
    for (i, line) in lines.iter().enumerate() {
        for (end, stop) in [line.start, line.end].into_iter().enumerate() {
            if matches!(
                stop,
                Stop::Neighbour | Stop::SelfApproach | Stop::LengthLimit
            ) {
                open.push_back((i, end));
            }
        }
    }
    while let Some((i, end)) = open.pop_front() {
        if parts[i].gone {
            continue;
        }
        // It may have been cut, or its crossing been restored, meanwhile.
        if let Some(held) = parts[i].cut[end] {
            if holds(&parts[held.line], held.there) {
                continue;
            }
        }
        match last_crossing(&lines, &pieces, &parts, i, end) {
            Some(crossing) => {
                parts[i].ends[end] = crossing.here;
                parts[i].cut[end] = Some(crossing);
                parts[crossing.line].guests.push((i, end));
                parts[i].gone = length(&lines[i], &parts[i]) < least(&lines[i]);
            }
            None => parts[i].gone = true,
        }
        // Whoever was cut to the part that is gone has to move on.
        open.extend(parts[i].guests.iter().filter(|&&(guest, side)| {
            parts[guest].cut[side]
                .is_some_and(|held| held.line == i && !holds(&parts[i], held.there))
        }));
    }
    rebuild(lines, &parts)
}

fn index(lines: &[Streamline]) -> Pieces {
    let mut pieces = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        for (k, pair) in line.points.windows(2).enumerate() {
            let (a, b) = (pair[0], pair[1]);
            pieces.push(GeomWithData::new(Line::new([a.x, a.y], [b.x, b.y]), (i, k)));
        }
    }
    RTree::bulk_load(pieces)
}

/// True if the place, and not only as an end in the open, is left of the line.
fn holds(part: &Part, place: Place) -> bool {
    !part.gone && part.ends[0] <= place && place <= part.ends[1]
}

fn at(line: &Streamline, place: Place) -> Point {
    let piece = (place as usize).min(line.points.len() - 2);
    let (a, b) = (line.points[piece], line.points[piece + 1]);
    a + (b - a) * (place - piece as f64)
}

fn length(line: &Streamline, part: &Part) -> f64 {
    let [from, to] = part.ends;
    if to <= from {
        return 0.0;
    }
    let inner = line.points[from as usize + 1..to.ceil() as usize].iter();
    let mut last = at(line, from);
    let mut sum = 0.0;
    for &p in inner.chain([&at(line, to)]) {
        sum += distance(last, p);
        last = p;
    }
    sum
}

/// The crossing nearest to an end, of those that are left of both lines and lie
/// before the end.
fn last_crossing(
    lines: &[Streamline],
    pieces: &Pieces,
    parts: &[Part],
    i: usize,
    end: usize,
) -> Option<Crossing> {
    let points = &lines[i].points;
    let [from, to] = parts[i].ends;
    let (low, high) = (from as usize, (to.ceil() as usize).max(1) - 1);
    let back = (low..=high).rev();
    let forth = low..=high;
    let order: Box<dyn Iterator<Item = usize>> = if end == 1 {
        Box::new(back)
    } else {
        Box::new(forth)
    };
    for piece in order {
        let (a, b) = (points[piece], points[piece + 1]);
        let around = AABB::from_corners([a.x, a.y], [b.x, b.y]);
        let mut best: Option<Crossing> = None;
        for other in pieces.locate_in_envelope_intersecting(&around) {
            let (line, k) = other.data;
            if line == i || parts[line].gone {
                continue;
            }
            let (c, d) = (lines[line].points[k], lines[line].points[k + 1]);
            // Always by the lower line: the same numbers whoever asks.
            let Some((t, u, point)) = (if i < line {
                crossing(a, b, c, d)
            } else {
                crossing(c, d, a, b).map(|(u, t, point)| (t, u, point))
            }) else {
                continue;
            };
            let found = Crossing {
                here: piece as f64 + t,
                line,
                there: k as f64 + u,
                point,
            };
            // Not where it ends now: that crossing was lost.
            let inside = from <= found.here && found.here <= to;
            if !inside || !holds(&parts[line], found.there) {
                continue;
            }
            let nearer = best.is_none_or(|best| {
                let (x, y) = (found.here, best.here);
                let ahead = if end == 1 { x > y } else { x < y };
                ahead || (x == y && line < best.line)
            });
            if nearer {
                best = Some(found);
            }
        }
        if best.is_some() {
            return best;
        }
    }
    None
}

/// Fractions along two pieces of the point where they cross, or touch, and the
/// point.
fn crossing(a: Point, b: Point, c: Point, d: Point) -> Option<(f64, f64, Point)> {
    let (e, f) = (b - a, d - c);
    let area = cross(e, f);
    // Under 45 degrees two lines meet, rather than one end on the other.
    if area == 0.0 || area.abs() < dot(e, f).abs() {
        return None;
    }
    let (t, u) = (cross(c - a, f) / area, cross(c - a, e) / area);
    let inside = 0.0..=1.0;
    (inside.contains(&t) && inside.contains(&u)).then_some((t, u, a + e * t))
}

/// The lines that are left, cut, each with a point where another ends on it.
fn rebuild(lines: Vec<Streamline>, parts: &[Part]) -> Vec<Streamline> {
    let mut new_index = Vec::with_capacity(parts.len());
    let mut count = 0;
    for part in parts {
        new_index.push(count);
        count += usize::from(!part.gone);
    }
    let mut left = Vec::with_capacity(count);
    for (i, mut line) in lines.into_iter().enumerate() {
        let part = &parts[i];
        if part.gone {
            continue;
        }
        // Junctions on this line.
        let mut stops: Vec<(Place, Point)> = Vec::new();
        for &(guest, side) in &part.guests {
            if let Some(held) = parts[guest].cut[side].filter(|held| held.line == i) {
                if !parts[guest].gone {
                    stops.push((held.there, held.point));
                }
            }
        }
        for (end, held) in part.cut.iter().enumerate() {
            let Some(held) = held else { continue };
            let stop = Stop::Junction {
                line: new_index[held.line],
            };
            if end == 0 {
                line.start = stop;
            } else {
                line.end = stop;
            }
        }
        let cut = part.cut.map(|held| held.map(|held| held.point));
        if !stops.is_empty() || cut != [None, None] {
            line.points = with_stops(&line.points, part.ends, cut, stops);
            let seed = line.seed;
            if !line.points.contains(&seed) {
                let middle = line.points.len() / 2;
                line.seed = line.points[middle];
            }
        }
        left.push(line);
    }
    left
}

/// Vertices nearer to a stop than this share of a piece give way to it.
const SAME: f64 = 1e-9;

/// The points from one end to the other, with further ones at `stops`, the
/// line's own cuts at the very ends.
fn with_stops(
    points: &[Point],
    ends: [Place; 2],
    cut: [Option<Point>; 2],
    mut stops: Vec<(Place, Point)>,
) -> Vec<Point> {
    stops.retain(|&(place, _)| ends[0] <= place && place <= ends[1]);
    stops.sort_by(|a, b| a.0.total_cmp(&b.0));
    let near = |place: Place| {
        let next = stops.partition_point(|stop| stop.0 < place - SAME);
        let at_stop = stops.get(next).is_some_and(|stop| stop.0 <= place + SAME);
        let at_cut = [0, 1].map(|end| cut[end].is_some() && (place - ends[end]).abs() <= SAME);
        at_stop || at_cut[0] || at_cut[1]
    };
    let last = points.len() - 1;
    let mut merged: Vec<(Place, Point)> = (0..=last)
        .filter(|&k| ends[0] <= k as f64 && k as f64 <= ends[1])
        // An end on the boundary stays exactly there.
        .filter(|&k| {
            let whole = (k == 0 && cut[0].is_none()) || (k == last && cut[1].is_none());
            whole || !near(k as f64)
        })
        .map(|k| (k as f64, points[k]))
        .collect();
    merged.append(&mut stops);
    merged.sort_by(|a, b| a.0.total_cmp(&b.0));
    let inner = merged.into_iter().map(|(_, p)| p);
    let mut all: Vec<Point> = cut[0].into_iter().chain(inner).chain(cut[1]).collect();
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::point;

    fn line(points: Vec<Point>, start: Stop, end: Stop) -> Streamline {
        Streamline {
            seed: points[0],
            points,
            start,
            end,
            family: 0,
            seed_index: 0,
        }
    }

    const WALL: Stop = Stop::Boundary { ring: 0, edge: 0 };

    #[test]
    fn an_end_is_cut_to_the_last_crossing_and_the_other_gets_a_point() {
        let east = line(
            vec![point(0., 0.), point(50., 0.), point(95., 0.)],
            WALL,
            Stop::Neighbour,
        );
        let north = |x: f64| line(vec![point(x, -50.), point(x, 50.)], WALL, WALL);
        let cut = cut(vec![east, north(30.0), north(80.0)], &|_| 1.0);
        assert_eq!(
            cut[0].points,
            [point(0., 0.), point(50., 0.), point(80., 0.)]
        );
        assert_eq!(cut[0].end, Stop::Junction { line: 2 });
        assert_eq!(
            cut[2].points,
            [point(80., -50.), point(80., 0.), point(80., 50.)]
        );
        assert_eq!(cut[1].points.len(), 2);
    }

    #[test]
    fn a_lost_crossing_moves_the_end_further() {
        // The middle line itself is cut to below the first one's crossing.
        let east = line(vec![point(0., 0.), point(95., 0.)], WALL, Stop::Neighbour);
        let first = line(vec![point(30., -50.), point(30., 50.)], WALL, WALL);
        let second = line(
            vec![point(80., -50.), point(80., 10.)],
            WALL,
            Stop::Neighbour,
        );
        let low = line(vec![point(0., -20.), point(95., -20.)], WALL, WALL);
        let lines = vec![east, first, second, low];
        let all = cut(lines.clone(), &|_| 1.0);
        // East is cut to the second, which is cut to east: both can stay.
        assert_eq!(all[0].end, Stop::Junction { line: 2 });
        assert_eq!(all[2].end, Stop::Junction { line: 0 });
        assert_eq!(all[0].points.last(), all[2].points.last());
        // If short lines go, so does the second, and east moves on.
        let some = cut(lines, &|line| {
            if line.points[0].x == 80.0 {
                55.0
            } else {
                1.0
            }
        });
        assert_eq!(some.len(), 3);
        assert_eq!(some[0].end, Stop::Junction { line: 1 });
        assert_eq!(some[0].points.last(), Some(&point(30., 0.)));
    }

    #[test]
    fn lines_that_cross_nothing_go() {
        let open = line(vec![point(0., 0.), point(95., 0.)], Stop::Neighbour, WALL);
        assert!(cut(vec![open], &|_| 1.0).is_empty());
    }
}
