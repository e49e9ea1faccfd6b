//! From a streamline to a street that can be built: ends put on junctions or
//! kept off them, met squarely, kept smooth, with room for parcels beside it.

use geo_types::Coord;

use crate::network::{Side, SideKind};
use crate::options::PlanOptions;
use crate::plane::{angle, dist, dot, left, length, lerp, resample, simplify, turn, unit};
use crate::region::{Place, Region};
use crate::segments::SegmentGrid;
use crate::splitter::{Cut, Scene};

/// Makes [`Cut`]s for one region.
#[derive(Debug)]
pub(crate) struct CutMaker<'a> {
    region: &'a Region,
    options: &'a PlanOptions,
    grid: SegmentGrid,
    sides: Vec<Side>,
    major_junctions: Vec<Coord<f64>>,
    entries: Vec<(Coord<f64>, Coord<f64>)>,
    mouths: Vec<Coord<f64>>,
    needs_room: bool,
    yields: bool,
}

/// A path across a region: points with the place of either end.
#[derive(Clone, Debug)]
pub(crate) struct Path2 {
    pub(crate) from: Place,
    pub(crate) to: Place,
    pub(crate) points: Vec<Coord<f64>>,
}

/// Points along a path while it is shaped, metres apart.
const STEP: f64 = 8.0;
/// Least angle at which a street meets another, degrees (the law asks for 60).
const LEAST_MEETING_DEG: f64 = 66.0;
/// Most turn at one point of a street, degrees, at [`STEP`] spacing.
const MOST_TURN_DEG: f64 = 17.0;
/// Junctions on a major road are at least so far apart, metres (FORMATS).
const MAJOR_SPACING: f64 = 150.0;
/// A path end turns into the direction wanted there over this length, metres.
const BEND: f64 = 45.0;
/// Steps by which an end that yields slides along the boundary, and how many
/// of them each way, metres.
const SLIDE: f64 = 6.0;
const SLIDES: u8 = 5;
/// Share of a street's length that may lack room for parcels beside it.
const CRAMPED_SHARE: f64 = 0.15;
/// The same for a street that yields.
const YIELDING_SHARE: f64 = 0.4;

impl<'a> CutMaker<'a> {
    pub(crate) fn new(scene: &Scene<'a>, region: &'a Region) -> Self {
        let (grid, sides) = region.grid();
        let network = scene.network;
        let major_junctions = network
            .mesh
            .vertices()
            .filter(|&v| {
                let streets = network.streets_at(v);
                streets.len() >= 3
                    && streets.iter().any(|&h| {
                        network
                            .street_of(h)
                            .is_some_and(|s| s.class == crate::site::RoadClass::Major)
                    })
            })
            .map(|v| network.mesh.point(v))
            .collect();
        let mouths = network.mouths().map(|v| network.mesh.point(v)).collect();
        let entries = network.entries.iter().map(|e| (e.at, e.inward)).collect();
        Self {
            region,
            options: scene.options,
            grid,
            sides,
            major_junctions,
            entries,
            mouths,
            needs_room: true,
            yields: false,
        }
    }

    /// Makes streets that yield: their ends at the site's boundary may slide
    /// along it, and look at its course rather than at the single edge; and they
    /// may pass through necks of the land and have lots on one side only. For
    /// regions in which no better street can be built.
    pub(crate) fn yielding(mut self) -> Self {
        self.yields = true;
        self
    }

    /// Makes streets where parcels beside them may not fit: connections that
    /// the network needs.
    pub(crate) fn without_room(mut self) -> Self {
        self.needs_room = false;
        self
    }

    /// How near to another junction a connection may end where there is no
    /// choice, over the street's width.
    pub(crate) const TIGHT: f64 = 1.25;

    /// How far from other junctions a street's end stays, over its width.
    fn keep_off(&self) -> f64 {
        if self.needs_room {
            1.8
        } else {
            Self::TIGHT
        }
    }

    /// How far apart, as the crow flies, street ends on the boundary stay.
    fn spread(&self) -> f64 {
        if self.needs_room {
            1.5
        } else {
            1.1
        }
    }

    /// A street along `path`, or `None` if none can be built there.
    pub(crate) fn make(&self, path: &Path2) -> Option<Cut> {
        let total = length(&path.points);
        if total < if self.needs_room { 2.0 } else { 1.3 } * self.options.street_width {
            return None;
        }
        let mut points = smooth(&resample(&path.points, STEP), 3);
        let n = points.len();
        if n < 4 {
            return None;
        }
        let (start, start_dir) = self.anchor(&path.from, unit(points[2] - points[0]))?;
        pull(&mut points, start.at);
        bend(&mut points, start_dir);
        points.reverse();
        let (end, end_dir) = self.anchor(&path.to, unit(points[2] - points[0]))?;
        pull(&mut points, end.at);
        bend(&mut points, end_dir);
        points.reverse();
        if start.ring == end.ring {
            let l = &self.region.loops[start.ring];
            let apart = l.between(
                l.position(start.edge, start.at),
                l.position(end.edge, end.at),
            );
            if apart < 2.0 * self.options.street_width {
                return None;
            }
        }
        let points = smooth(&points, 1);
        self.buildable(&points, &start, &end).then(|| {
            let thin = simplify(&points, 0.08);
            Cut {
                from: start,
                path: thin[1..thin.len() - 1].to_vec(),
                to: end,
                class: None,
                width: None,
            }
        })
    }

    /// Where a street that arrives near `place` along `inward` should end, and
    /// the direction in which it should leave there.
    pub(crate) fn anchor(&self, place: &Place, inward: Coord<f64>) -> Option<(Place, Coord<f64>)> {
        let l = &self.region.loops[place.ring];
        let side = l.sides[place.edge];
        let keep_off = self.keep_off() * self.options.street_width;
        let position = l.position(place.edge, place.at);
        // A street outside waits to be continued.
        if side.kind == SideKind::Boundary {
            let entry = self
                .entries
                .iter()
                .filter(|(at, dir)| {
                    dist(*at, place.at) < 2.0 * keep_off && angle(*dir, inward) < 50f64.to_radians()
                })
                .min_by(|a, b| dist(a.0, place.at).total_cmp(&dist(b.0, place.at)));
            if let Some(&(at, dir)) = entry {
                let (s, edge, at) = l.nearest(at);
                let clear = l
                    .nodes
                    .iter()
                    .filter(|n| n.junction)
                    .all(|n| l.between(n.position, s) > keep_off);
                if clear && l.sides[edge].kind == SideKind::Boundary {
                    return Some((
                        Place {
                            ring: place.ring,
                            edge,
                            at,
                        },
                        dir,
                    ));
                }
            }
        }
        let near = |s: f64, reach: f64| {
            l.nodes
                .iter()
                .filter(move |n| l.between(n.position, s) < reach)
                .min_by(move |a, b| {
                    l.between(a.position, s)
                        .total_cmp(&l.between(b.position, s))
                })
        };
        let mut target = position;
        if let Some(node) = near(position, keep_off) {
            if let Some(dir) = node.continues {
                if angle(dir, inward) < 24f64.to_radians() {
                    let edge = l.vertices.iter().position(|&v| v == node.vertex)?;
                    return Some((
                        Place {
                            ring: place.ring,
                            edge,
                            at: node.at,
                        },
                        dir,
                    ));
                }
            }
            // Step off along the loop, away from the node.
            let ahead = (position - node.position).rem_euclid(l.length()) < 0.5 * l.length();
            target = node.position + if ahead { keep_off } else { -keep_off };
            if near(target, 0.98 * keep_off).is_some() {
                return None;
            }
        }
        let slides = self.yields && side.kind == SideKind::Boundary;
        let steps = if slides { SLIDES } else { 0 };
        (0..=steps)
            .flat_map(|k| [f64::from(k), -f64::from(k)])
            .map(|k| target + k * SLIDE)
            .filter(|&s| s == target || near(s, 0.98 * keep_off).is_none())
            .find_map(|s| self.end_at(place.ring, s, inward))
    }

    /// An end at a place along a ring of the region, and the direction in which
    /// the street should leave there; `None` if none may stand there.
    fn end_at(&self, ring: usize, target: f64, inward: Coord<f64>) -> Option<(Place, Coord<f64>)> {
        let l = &self.region.loops[ring];
        let (edge, at) = l.at(target);
        let side = l.sides[edge];
        let (a, b) = l.edge(edge);
        let normal = if self.yields && side.kind == SideKind::Boundary {
            let reach = self.options.street_width;
            left(unit(l.at(target + reach).1 - l.at(target - reach).1))
        } else {
            left(unit(b - a))
        };
        if side.kind == SideKind::Element {
            return None;
        }
        if side.kind == SideKind::Street
            && !side.access
            && self
                .major_junctions
                .iter()
                .any(|&j| dist(j, at) < MAJOR_SPACING)
        {
            return None;
        }
        // Off the vertices of the loop: an end a hand's breadth from one would
        // leave a crumb of an edge.
        let at = if dist(at, a) < 1.0 {
            a
        } else if dist(at, b) < 1.0 {
            b
        } else {
            at
        };
        // Across a notch of the boundary another street's end may be near.
        if self
            .mouths
            .iter()
            .any(|&m| dist(m, at) < self.spread() * self.options.street_width)
        {
            return None;
        }
        let off = angle(normal, inward);
        if off > 55f64.to_radians() {
            return None;
        }
        Some((Place { ring, edge, at }, normal))
    }

    /// The laws of a street, on its shaped points.
    fn buildable(&self, points: &[Coord<f64>], start: &Place, end: &Place) -> bool {
        let n = points.len();
        for w in points.windows(3) {
            let most: f64 = if self.needs_room { MOST_TURN_DEG } else { 23.0 };
            if turn(w[1] - w[0], w[2] - w[1]).abs() > most.to_radians() {
                return false;
            }
        }
        let meets = |place: &Place, inward: Coord<f64>| {
            let l = &self.region.loops[place.ring];
            let count = l.points.len();
            // At a vertex both edges count.
            [
                place.edge,
                (place.edge + count - 1) % count,
                (place.edge + 1) % count,
            ]
            .iter()
            .all(|&e| {
                let (a, b) = l.edge(e);
                let touches = dist(crate::plane::nearest_on(a, b, place.at).0, place.at) < 1e-6;
                let t = angle(b - a, inward);
                let least = if l.sides[e].kind == SideKind::Street {
                    LEAST_MEETING_DEG
                } else {
                    35.0
                };
                !touches
                    || (t > least.to_radians() && t < std::f64::consts::PI - least.to_radians())
            })
        };
        if !meets(start, points[1] - points[0]) || !meets(end, points[n - 2] - points[n - 1]) {
            return false;
        }
        // Inside all the way.
        for (i, w) in points.windows(2).enumerate() {
            let d = dist(w[0], w[1]);
            let dir = unit(w[1] - w[0]);
            let least = if i == 0 { 0.05 } else { 0.0 };
            let most = if i + 2 == n { d - 0.05 } else { d };
            if self.grid.ray(w[0], dir, least, most).is_some() {
                return false;
            }
        }
        if crosses_itself(points) {
            return false;
        }
        !self.needs_room || self.roomy(points)
    }

    /// Whether parcels fit on both sides along most of the way.
    fn roomy(&self, points: &[Coord<f64>]) -> bool {
        let half = 0.5 * self.options.street_width;
        let depth = self.options.parcel_length;
        let n = points.len();
        let skip = (4.0 * half / STEP).ceil() as usize;
        let (mut cramped, mut count) = (0usize, 0usize);
        for i in 1..n - 1 {
            let tangent = unit(points[i + 1] - points[i - 1]);
            for side in [1.0, -1.0] {
                let normal = left(tangent) * side;
                count += 1;
                let Some(hit) = self.grid.ray(points[i], normal, 0.0, 3.0 * depth) else {
                    continue;
                };
                let met = self.sides[hit.segment];
                // Two rows where a street lies opposite, one at a boundary.
                let least = half
                    + met.inset
                    + if met.access {
                        1.45 * depth
                    } else {
                        0.66 * depth
                    };
                if hit.distance < least {
                    cramped += 1;
                }
            }
            let clear = if self.yields { 1.15 } else { 2.2 } * half;
            if i > skip && i + skip < n && self.grid.nearest(points[i], clear).is_some() {
                return false;
            }
        }
        let share = if self.yields {
            YIELDING_SHARE
        } else {
            CRAMPED_SHARE
        };
        (cramped as f64) <= share * count as f64
    }
}

/// `rounds` of averaging with the neighbours, ends fixed.
pub(crate) fn smooth(points: &[Coord<f64>], rounds: usize) -> Vec<Coord<f64>> {
    let mut points = points.to_vec();
    for _ in 0..rounds {
        let old = points.clone();
        for i in 1..points.len().saturating_sub(1) {
            points[i] = (old[i - 1] + old[i] * 2.0 + old[i + 1]) * 0.25;
        }
    }
    points
}

/// Moves the first point to `to`, the others by ever less, so that the path
/// keeps its shape.
fn pull(points: &mut [Coord<f64>], to: Coord<f64>) {
    let shift = to - points[0];
    let move_by = dist(points[0], to);
    let reach = (10.0 * move_by).max(60.0).min(length(points));
    let mut s = 0.0;
    let mut previous = points[0];
    for p in points.iter_mut() {
        s += dist(previous, *p);
        previous = *p;
        *p = *p + shift * fade(s / reach);
    }
}

/// Turns the first stretch of the path smoothly into direction `dir`.
fn bend(points: &mut [Coord<f64>], dir: Coord<f64>) {
    let start = points[0];
    let reach = BEND.min(0.45 * length(points));
    let mut s = 0.0;
    let mut previous = start;
    for p in points.iter_mut().skip(1) {
        s += dist(previous, *p);
        previous = *p;
        if s >= reach {
            break;
        }
        let along = dot(*p - start, dir).max(0.3 * s);
        *p = lerp(*p, start + dir * along, fade(s / reach));
    }
}

/// 1 at 0, 0 from 1 on, level at both ends.
fn fade(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    1.0 - t * t * (3.0 - 2.0 * t)
}

fn crosses_itself(points: &[Coord<f64>]) -> bool {
    // Streets are a few dozen points long, and smooth: only those that wind
    // by more than half a turn can cross themselves.
    let wound: f64 = points
        .windows(3)
        .map(|w| turn(w[1] - w[0], w[2] - w[1]).abs())
        .sum();
    if wound < std::f64::consts::PI {
        return false;
    }
    let grid = SegmentGrid::new(points.windows(2).map(|w| (w[0], w[1])).collect());
    points.windows(2).enumerate().any(|(i, w)| {
        let d = dist(w[0], w[1]);
        grid.ray(w[0], unit(w[1] - w[0]), 1e-6, d - 1e-6)
            .is_some_and(|h| h.segment != i)
    })
}
