//! Vertices along the boundary: corners kept, the rest evenly spaced.

use geo_types::{Coord, LineString, Polygon};

use crate::error::DesignError;
use crate::mesh::index::SegmentIndex;
use crate::mesh::predicates::{crosses, dist, dist_to_segment, foot, lerp, west_of};

type P = Coord<f64>;

/// A place on the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) ring: usize,
    /// Metres from the ring's first vertex.
    pub(super) at: f64,
    /// Whether it is a corner, which stays where it is.
    pub(super) corner: bool,
}

/// A ring as given, relative to the centre, the domain on its left.
#[derive(Clone, Debug)]
struct Ring {
    points: Vec<P>,
    /// Metres from the first vertex to each, and the length of the whole.
    along: Vec<f64>,
}

impl Ring {
    fn new(line: &LineString<f64>, origin: P, left: bool) -> Result<Self, DesignError> {
        let mut points: Vec<P> = Vec::with_capacity(line.0.len());
        for &c in &line.0 {
            if !(c.x.is_finite() && c.y.is_finite()) {
                return Err(DesignError::BadMesh {
                    what: "a vertex of the polygon is not finite".to_owned(),
                });
            }
            let p = c - origin;
            if points.last() != Some(&p) {
                points.push(p);
            }
        }
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() < 3 {
            return Err(DesignError::BadMesh {
                what: format!(
                    "a ring of the polygon has {} different vertices",
                    points.len()
                ),
            });
        }
        if (signed_area(&points) > 0.0) != left {
            points.reverse();
        }
        let mut along = vec![0.0];
        for k in 0..points.len() {
            along.push(along[k] + dist(points[k], points[(k + 1) % points.len()]));
        }
        Ok(Self { points, along })
    }

    fn length(&self) -> f64 {
        self.along[self.points.len()]
    }

    fn edge(&self, k: usize) -> (P, P) {
        (self.points[k], self.points[(k + 1) % self.points.len()])
    }

    /// The point this many metres on.
    fn point(&self, at: f64) -> P {
        let at = at.rem_euclid(self.length());
        let k = self
            .along
            .partition_point(|&a| a <= at)
            .clamp(1, self.points.len())
            - 1;
        let (a, b) = self.edge(k);
        let span = self.along[k + 1] - self.along[k];
        lerp(
            a,
            b,
            if span > 0.0 {
                (at - self.along[k]) / span
            } else {
                0.0
            },
        )
    }

    /// Corners, by their place along the ring: where the boundary turns by more
    /// than `least`, seen over half a `step` on either side, so that a rounded
    /// corner is one too. Of corners nearer than half a step only the sharpest
    /// stays.
    fn corners(&self, step: f64, least: f64) -> Vec<f64> {
        let reach = (0.25 * step).min(self.length() / 8.0);
        let turn = |k: usize| {
            let (at, here) = (self.along[k], self.points[k]);
            let (before, after) = (here - self.point(at - reach), self.point(at + reach) - here);
            (before.x * after.y - before.y * after.x)
                .atan2(before.x * after.x + before.y * after.y)
                .abs()
        };
        let mut sharp: Vec<(f64, f64)> = (0..self.points.len())
            .map(|k| (turn(k), self.along[k]))
            .filter(|&(turn, _)| turn > least)
            .collect();
        sharp.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)));
        let mut kept: Vec<f64> = Vec::new();
        for (_, at) in sharp {
            let apart = |other: &f64| {
                let gap = (at - other).rem_euclid(self.length());
                gap.min(self.length() - gap) > 0.5 * step
            };
            if kept.iter().all(apart) {
                kept.push(at);
            }
        }
        kept.sort_by(f64::total_cmp);
        kept
    }

    /// Places along the ring, those of the corners among them, at most about
    /// `step` apart.
    fn places(&self, ring: usize, step: f64, corners: &[f64]) -> Vec<Place> {
        let length = self.length();
        let least = |count: f64, pieces: f64| count.max((3.0 / pieces).ceil());
        let mut starts = corners.to_vec();
        let has_corners = !starts.is_empty();
        if !has_corners {
            starts.push(0.0);
        }
        let mut places = Vec::new();
        for (k, &from) in starts.iter().enumerate() {
            let to = starts.get(k + 1).copied().unwrap_or(starts[0] + length);
            let count = least(((to - from) / step).round(), starts.len() as f64);
            for i in 0..count as usize {
                places.push(Place {
                    ring,
                    at: (from + (to - from) * i as f64 / count).rem_euclid(length),
                    corner: has_corners && i == 0,
                });
            }
        }
        places
    }
}

/// The boundary of a polygon, and the vertices on it, relative to its centre.
#[derive(Debug)]
pub(super) struct Outline {
    pub(super) origin: P,
    rings: Vec<Ring>,
    /// The vertices, ring by ring.
    pub(super) places: Vec<Place>,
    pub(super) points: Vec<P>,
    /// Where each ring's vertices begin, and the number of all.
    pub(super) starts: Vec<usize>,
    /// The edges between the vertices.
    index: SegmentIndex,
    low: P,
}

/// Area of a polygon, holes taken off.
pub(super) fn area(polygon: &Polygon<f64>) -> f64 {
    let origin = polygon.exterior().0.first().copied().unwrap_or_default();
    let of = |line: &LineString<f64>| {
        let points: Vec<P> = line.0.iter().map(|&c| c - origin).collect();
        signed_area(&points).abs()
    };
    of(polygon.exterior()) - polygon.interiors().iter().map(of).sum::<f64>()
}

fn signed_area(points: &[P]) -> f64 {
    let next = |k: usize| points[(k + 1) % points.len()];
    (0..points.len())
        .map(|k| points[k].x * next(k).y - points[k].y * next(k).x)
        .sum::<f64>()
        / 2.0
}

/// Rounds in which edges that cross are bent to follow the polygon more
/// closely.
const ROUNDS: u32 = 24;

impl Outline {
    /// Vertices about `step` apart, and at corners that turn by over
    /// `corner` radians. Where edges between them cross, which those of the
    /// polygon do not, they follow it more closely.
    pub(super) fn new(polygon: &Polygon<f64>, step: f64, corner: f64) -> Result<Self, DesignError> {
        let outer = &polygon.exterior().0;
        let fold = |of: fn(&P) -> f64| {
            let values = || outer.iter().map(of);
            0.5 * (values().fold(f64::INFINITY, f64::min)
                + values().fold(f64::NEG_INFINITY, f64::max))
        };
        let origin = P {
            x: fold(|p| p.x),
            y: fold(|p| p.y),
        };
        let lines = std::iter::once(polygon.exterior()).chain(polygon.interiors());
        let rings = lines
            .enumerate()
            .map(|(k, line)| Ring::new(line, origin, k == 0))
            .collect::<Result<Vec<_>, _>>()?;
        let mut places = Vec::new();
        for (k, ring) in rings.iter().enumerate() {
            places.extend(ring.places(k, step, &ring.corners(step, corner)));
        }
        for _ in 0..ROUNDS {
            let outline = Self::at(origin, &rings, places);
            let crossed = outline.crossed();
            if crossed.is_empty() {
                return Ok(outline);
            }
            places = outline.halved(&crossed, step);
        }
        Err(DesignError::BadMesh {
            what: "rings of the polygon cross, or come nearer to each other than can be resolved; repair it, or \
                   simplify it"
                .to_owned(),
        })
    }

    fn at(origin: P, rings: &[Ring], places: Vec<Place>) -> Self {
        let mut starts = vec![0];
        for k in 0..rings.len() {
            starts.push(places.partition_point(|p| p.ring <= k));
        }
        let points: Vec<P> = places.iter().map(|p| rings[p.ring].point(p.at)).collect();
        let low = points.iter().fold(points[0], |low, p| P {
            x: low.x.min(p.x),
            y: low.y.min(p.y),
        });
        let next = |k: usize| {
            let ring = places[k].ring;
            if k + 1 == starts[ring + 1] {
                starts[ring]
            } else {
                k + 1
            }
        };
        let segments = (0..points.len()).map(|k| (k as u32, points[k], points[next(k)]));
        let index = SegmentIndex::new(segments);
        Self {
            origin,
            rings: rings.to_vec(),
            places,
            points,
            starts,
            index,
            low,
        }
    }

    /// The places with one more in the middle of each edge named: at the
    /// sharpest bend between its ends if there is one that is no nearer to
    /// them than a fiftieth of a step.
    fn halved(&self, edges: &std::collections::BTreeSet<usize>, step: f64) -> Vec<Place> {
        let mut places = Vec::new();
        for (k, &place) in self.places.iter().enumerate() {
            places.push(place);
            if edges.contains(&k) {
                let (a, b) = self.segment(k);
                let (middle, _) = self.between(k);
                let ring = &self.rings[place.ring];
                let length = ring.length();
                let span = 2.0 * (middle.at - place.at).rem_euclid(length);
                let bend = (0..ring.points.len())
                    .filter(|&i| {
                        let on = (ring.along[i] - place.at).rem_euclid(length);
                        on > 0.02 * step && on < span - 0.02 * step
                    })
                    .max_by(|&i, &j| {
                        let off = |i: usize| dist_to_segment(ring.points[i], a, b);
                        off(i).total_cmp(&off(j))
                    });
                places.push(bend.map_or(middle, |i| Place {
                    ring: place.ring,
                    at: ring.along[i],
                    corner: true,
                }));
            }
        }
        places
    }

    /// The vertex after vertex `k` on its ring.
    pub(super) fn next(&self, k: usize) -> usize {
        let ring = self.places[k].ring;
        if k + 1 == self.starts[ring + 1] {
            self.starts[ring]
        } else {
            k + 1
        }
    }

    fn segment(&self, k: usize) -> (P, P) {
        (self.points[k], self.points[self.next(k)])
    }

    /// The edges that cross others or touch them at a vertex, by their first
    /// vertices.
    fn crossed(&self) -> std::collections::BTreeSet<usize> {
        let mut found = std::collections::BTreeSet::new();
        let mut near = Vec::new();
        for k in 0..self.points.len() {
            let (a, b) = self.segment(k);
            self.index.near(a, b, 0.0, &mut near);
            for &other in near.iter().filter(|&&other| other as usize > k) {
                let other = other as usize;
                if other == self.next(k) || k == self.next(other) {
                    continue;
                }
                let (c, d) = self.segment(other);
                let touch = [(a, c, d), (b, c, d), (c, a, b), (d, a, b)]
                    .iter()
                    .any(|&(p, x, y)| dist_to_segment(p, x, y) < 1e-9 * dist(x, y));
                if touch || crosses(a, b, c, d) {
                    found.extend([k, other]);
                }
            }
        }
        found
    }

    /// Whether a point lies inside the edges.
    pub(super) fn contains(&self, p: P) -> bool {
        let mut near = Vec::new();
        let west = P {
            x: self.low.x - 1.0,
            y: p.y,
        };
        self.index.near(west, p, 0.0, &mut near);
        let crossed = near.iter().filter(|&&k| {
            let (a, b) = self.segment(k as usize);
            west_of(p, a, b)
        });
        crossed.count() % 2 == 1
    }

    /// The nearest edge, by its first vertex, and the distance to it.
    pub(super) fn nearest(&self, p: P) -> (usize, f64) {
        let mut best = (0, f64::INFINITY);
        for (k, box_squared) in self.index.by_distance(p) {
            if box_squared > best.1 * best.1 {
                break;
            }
            let (a, b) = self.segment(k as usize);
            let away = dist_to_segment(p, a, b);
            if away < best.1 {
                best = (k as usize, away);
            }
        }
        best
    }

    /// Of the points of a lattice of this spacing, the one inside that is
    /// farthest from the boundary.
    pub(super) fn deepest(&self, spacing: f64) -> Option<P> {
        let high = self.points.iter().fold(self.low, |high, p| P {
            x: high.x.max(p.x),
            y: high.y.max(p.y),
        });
        let steps = |from: f64, to: f64| ((to - from) / spacing) as usize;
        let (columns, rows) = (steps(self.low.x, high.x), steps(self.low.y, high.y));
        let at = |k: usize| P {
            x: self.low.x + ((k % (columns + 1)) as f64 + 0.5) * spacing,
            y: self.low.y + ((k / (columns + 1)) as f64 + 0.5) * spacing,
        };
        (0..(columns + 1) * (rows + 1))
            .map(at)
            .filter(|&p| self.contains(p))
            .map(|p| (self.nearest(p).1, p))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|found| found.1)
    }

    /// The angle of the edge nearest to `p`.
    pub(super) fn direction_near(&self, p: P) -> f64 {
        let (a, b) = self.segment(self.nearest(p).0);
        (b.y - a.y).atan2(b.x - a.x)
    }

    /// The place half-way along the boundary between vertex `k` and the next,
    /// and the point there.
    pub(super) fn between(&self, k: usize) -> (Place, P) {
        let (from, to) = (self.places[k], self.places[self.next(k)]);
        let length = self.rings[from.ring].length();
        let span = (to.at - from.at).rem_euclid(length);
        let span = if span == 0.0 { length } else { span };
        let place = Place {
            ring: from.ring,
            at: (from.at + 0.5 * span).rem_euclid(length),
            corner: false,
        };
        (place, self.rings[place.ring].point(place.at))
    }

    /// The place nearest to `p` on the boundary, within `reach` metres along it
    /// of the given one.
    pub(super) fn slide(&self, from: Place, p: P, reach: f64) -> (Place, P) {
        let ring = &self.rings[from.ring];
        let (length, count) = (ring.length(), ring.points.len());
        let start = from.at - reach;
        let first = ring
            .along
            .partition_point(|&a| a <= start.rem_euclid(length))
            .clamp(1, count)
            - 1;
        let mut best = (from, ring.point(from.at));
        let mut passed = -(start.rem_euclid(length) - ring.along[first]);
        for i in 0..count {
            if passed > 2.0 * reach {
                break;
            }
            let k = (first + i) % count;
            let (a, b) = ring.edge(k);
            let span = ring.along[k + 1] - ring.along[k];
            // The part of this edge within reach.
            let clip = |s: f64| {
                if span > 0.0 {
                    (s / span).clamp(0.0, 1.0)
                } else {
                    0.0
                }
            };
            let t = foot(p, a, b).clamp(clip(-passed), clip(2.0 * reach - passed));
            let q = lerp(a, b, t);
            if dist(q, p) < dist(best.1, p) {
                let at = (ring.along[k] + t * span).rem_euclid(length);
                best = (Place { at, ..from }, q);
            }
            passed += span;
        }
        best
    }
}
