//! The lanes of a triangulated cross: in each triangle one constant direction
//! per family, chosen so that neighbours agree on every edge.
//!
//! Between neighbours with directions of their own choice, lines merge: both
//! may flow into their common edge. Here every edge is entered from one side
//! and left to the other, by each family. An edge whose line lies between the
//! two directions is *contested*: one of the triangles yields and turns its
//! direction to just beyond the edge's. Where neither can without turning too
//! far, one of them is blocked.

use crate::field::mesh::{Mesh, NONE};
use crate::vector::{cross, dot, norm, point, Point};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// How far a lane may turn from the field in the middle of its triangle, in
/// radians. The field at a vertex is less than 45 degrees from that, so that no
/// lane runs against the cross of a vertex: a line cannot wind about it.
const SLACK: f64 = 0.999 * FRAC_PI_4;
/// Most by which the turns of the two lanes of a triangle differ: keeps them 45
/// degrees apart.
const APART: f64 = FRAC_PI_4;
/// Least angle between a lane and an edge, in radians: keeps the maps
/// invertible in floating point.
const CLEAR: f64 = 1e-6;
/// How far a triangle yields, if there is room, beyond the edge, as a part of
/// the angle between the two directions: lines that hardly cross an edge lie
/// hardly apart behind it.
const BEYOND: f64 = 0.2;

/// The lines of one family in one triangle: parallels.
///
/// The parallel through one vertex, the apex, meets the side opposite, the
/// `odd` one. All lines run between that side and the other two, by maps that
/// are linear on the two parts of it, so that their order never changes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lane {
    pub(crate) along: Point,
    /// Local edge opposite to the apex.
    pub(crate) odd: usize,
    /// Where the parallel through the apex meets it, in (0, 1).
    pub(crate) split: f64,
    /// True if `along` leaves the triangle through the odd edge.
    pub(crate) out_at_odd: bool,
}

impl Lane {
    fn new(mesh: &Mesh, triangle: usize, angle: f64) -> Option<Self> {
        let along = point(angle.cos(), angle.sin());
        let outward = [0, 1, 2].map(|i| cross(mesh.along(triangle, i), along) < 0.0);
        let odd = (0..3)
            .find(|&i| outward[i] != outward[(i + 1) % 3] && outward[i] != outward[(i + 2) % 3])?;
        // From vertex `odd` to the apex, against the edge between them.
        let to_apex = mesh.along(triangle, (odd + 2) % 3) * -1.0;
        let split = cross(to_apex, along) / cross(mesh.along(triangle, odd), along);
        Some(Self {
            along,
            odd,
            split: split.clamp(1e-12, 1.0 - 1e-12),
            out_at_odd: outward[odd],
        })
    }

    /// Where the line that meets local edge `local` at fraction `t` of it meets
    /// the triangle again.
    pub(crate) fn across(&self, local: usize, t: f64) -> (usize, f64) {
        let m = self.split;
        if local == self.odd {
            if t <= m {
                ((self.odd + 2) % 3, 1.0 - t / m)
            } else {
                ((self.odd + 1) % 3, (1.0 - t) / (1.0 - m))
            }
        } else if local == (self.odd + 2) % 3 {
            (self.odd, m * (1.0 - t))
        } else {
            (self.odd, 1.0 - (1.0 - m) * t)
        }
    }

    /// Where the parallel through `at`, in the triangle, meets the odd edge.
    pub(crate) fn project(&self, mesh: &Mesh, triangle: usize, at: Point) -> f64 {
        let from = mesh.points[mesh.triangles[triangle][self.odd]];
        let side = mesh.along(triangle, self.odd);
        (cross(at - from, self.along) / cross(side, self.along)).clamp(0.0, 1.0)
    }
}

/// The lanes of a mesh.
#[derive(Clone, Debug)]
pub(crate) struct Lanes {
    /// Of each triangle the first and the second family; none where the
    /// triangle is blocked.
    pub(crate) of: Vec<Option<[Lane; 2]>>,
    /// Arm `k` on the left of an edge is arm `k + shift` (modulo 4) on its right.
    pub(crate) shift: Vec<usize>,
}

/// The cross of a triangle by its middle, and continued to its vertices.
#[derive(Clone, Copy, Debug)]
struct Frame {
    angle: f64,
    at: [Option<f64>; 3],
}

impl Frame {
    /// `None` if the cross turns about the triangle, or has no direction.
    fn new(mesh: &Mesh, triangle: usize) -> Option<Self> {
        let corners = mesh.triangles[triangle];
        let vectors = corners.map(|v| mesh.vectors[v]);
        let live: Vec<usize> = (0..3).filter(|&i| norm(vectors[i]) > 0.0).collect();
        let first = *live.first().filter(|_| live.len() >= 2)?;
        let mut turned = 0.0;
        for (n, &i) in live.iter().enumerate() {
            let j = live[(n + 1) % live.len()];
            let change = angle_between(vectors[i], vectors[j]);
            if change.abs() > PI - 1e-9 {
                return None;
            }
            turned += change;
        }
        if turned.abs() > PI {
            return None;
        }
        let base = 0.25 * vectors[first].y.atan2(vectors[first].x);
        let mut at = [None; 3];
        for &i in &live {
            at[i] = Some(base + 0.25 * angle_between(vectors[first], vectors[i]));
        }
        let sum = vectors[0] + vectors[1] + vectors[2];
        Some(Self {
            angle: base + 0.25 * angle_between(vectors[first], sum),
            at,
        })
    }
}

fn angle_between(a: Point, b: Point) -> f64 {
    cross(a, b).atan2(dot(a, b))
}

fn wrapped(angle: f64, period: f64) -> f64 {
    angle - period * (angle / period).round()
}

/// What an edge asks of one family on one side of it: to turn less than
/// `offset` from the field, or more.
#[derive(Clone, Copy, Debug)]
struct Side {
    triangle: usize,
    family: usize,
    offset: f64,
}

/// The turns from the field that are left to each family of each triangle.
struct Room(Vec<[(f64, f64); 2]>);

impl Room {
    /// What is left if the family of `side` keeps to the left of the edge's
    /// line, or to its right.
    fn kept(&self, side: Side, left: bool, clear: f64) -> (f64, f64) {
        let (low, high) = self.0[side.triangle][side.family];
        if left {
            (low.max(side.offset + clear), high)
        } else {
            (low, high.min(side.offset - clear))
        }
    }

    fn keep(&mut self, side: Side, left: bool, clear: f64) {
        self.0[side.triangle][side.family] = self.kept(side, left, clear);
    }

    /// Whether the family of `side` can keep so far off the edge's line, next
    /// to the other family of its triangle.
    fn fits(&self, side: Side, left: bool, clear: f64) -> bool {
        let mut both = self.0[side.triangle];
        both[side.family] = self.kept(side, left, clear);
        turns(both).is_some()
    }
}

/// The least turns in the room of the two families of a triangle.
fn turns(room: [(f64, f64); 2]) -> Option<[f64; 2]> {
    if room.iter().any(|(low, high)| low > high) {
        return None;
    }
    let least = room.map(|(low, high)| 0.0_f64.clamp(low, high));
    ((least[0] - least[1]).abs() <= APART).then_some(least)
}

impl Lanes {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let count = mesh.triangles.len();
        let mut frames: Vec<_> = (0..count).map(|t| Frame::new(mesh, t)).collect();
        let shift: Vec<usize> = (0..mesh.edges.len())
            .map(|e| shift_across(mesh, &frames, e))
            .collect();
        let mut room = Room(vec![[(-SLACK, SLACK); 2]; count]);
        let mut contested = Vec::new();
        for (index, edge) in mesh.edges.iter().enumerate() {
            let along = mesh.points[edge.b] - mesh.points[edge.a];
            let line = along.y.atan2(along.x);
            let frame = |side: usize| frames.get(edge.sides[side]).copied().flatten();
            let both = [frame(0), frame(1)];
            for family in 0..2 {
                let side = |which: usize, family: usize, offset: f64| Side {
                    triangle: edge.sides[which],
                    family,
                    offset,
                };
                let toward = |angle: f64, arm: usize| line - angle - arm as f64 * FRAC_PI_2;
                match both {
                    [Some(left), Some(right)] => {
                        let arm = (family + shift[index]) % 4;
                        let first = wrapped(toward(left.angle, family), PI);
                        let turn = toward(left.angle, family) - toward(right.angle, arm);
                        // Continued from the left, lest a line seen nearly
                        // square be taken for its reverse.
                        let second = first - wrapped(turn, 2.0 * PI);
                        let sides = [side(0, family, first), side(1, arm % 2, second)];
                        let lefts = [0.0 >= first, 0.0 >= second];
                        if lefts[0] == lefts[1] {
                            sides.iter().for_each(|&s| room.keep(s, lefts[0], CLEAR));
                        } else {
                            let cost = first.abs().min(second.abs());
                            contested.push((cost, index, family, sides, lefts));
                        }
                    }
                    [Some(only), None] => {
                        let offset = wrapped(toward(only.angle, family), PI);
                        room.keep(side(0, family, offset), 0.0 >= offset, CLEAR);
                    }
                    [None, Some(only)] => {
                        let offset = wrapped(toward(only.angle, family), PI);
                        room.keep(side(1, family, offset), 0.0 >= offset, CLEAR);
                    }
                    [None, None] => {}
                }
            }
        }
        contested.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, _, _, sides, lefts) in contested {
            if sides.iter().any(|s| frames[s.triangle].is_none()) {
                continue;
            }
            let gap = sides[0].offset.abs() + sides[1].offset.abs();
            let mut ways = lefts;
            // The one that turns less yields: it takes the other's side.
            if sides[0].offset.abs() < sides[1].offset.abs() {
                ways.swap(0, 1);
            }
            let found = [CLEAR.max(BEYOND * gap), CLEAR].iter().find_map(|&clear| {
                let fits = |&left: &bool| sides.iter().all(|&s| room.fits(s, left, clear));
                Some((ways.iter().copied().find(fits)?, clear))
            });
            match found {
                Some((left, clear)) => sides.iter().for_each(|&s| room.keep(s, left, clear)),
                // Nobody can yield: lines end at one of the two, the one that
                // would have had to turn more.
                None => {
                    let worse = usize::from(sides[1].offset.abs() > sides[0].offset.abs());
                    frames[sides[worse].triangle] = None;
                }
            }
        }
        let of = (0..count)
            .map(|t| {
                let angle = frames[t]?.angle;
                let turn = turns(room.0[t])?;
                let lane = |family: usize| {
                    Lane::new(mesh, t, angle + family as f64 * FRAC_PI_2 + turn[family])
                };
                Some([lane(0)?, lane(1)?])
            })
            .collect();
        Self { of, shift }
    }
}

/// The arm on the right of an edge that continues arm 0 on its left.
fn shift_across(mesh: &Mesh, frames: &[Option<Frame>], edge: usize) -> usize {
    let sides = mesh.edges[edge].sides;
    if sides.contains(&NONE) {
        return 0;
    }
    let (Some(left), Some(right)) = (frames[sides[0]], frames[sides[1]]) else {
        return 0;
    };
    let (i, j) = (mesh.local(sides[0], edge), mesh.local(sides[1], edge));
    // The edge's ends change places; a singular one has no angle.
    let ends = [
        (left.at[i], right.at[(j + 1) % 3]),
        (left.at[(i + 1) % 3], right.at[j]),
    ];
    let quarter = ends.iter().find_map(|&(a, b)| Some((a? - b?) / FRAC_PI_2));
    (quarter.unwrap_or(0.0).round() as i64).rem_euclid(4) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(angle: f64) -> (Mesh, Lanes) {
        let vector = point((4.0 * angle).cos(), (4.0 * angle).sin());
        let points = vec![point(0., 0.), point(10., 1.), point(3., 8.)];
        let mesh = Mesh::new(points, vec![vector; 3], vec![[0, 1, 2]]).unwrap();
        let lanes = Lanes::new(&mesh);
        (mesh, lanes)
    }

    #[test]
    fn lanes_run_along_the_field_and_back() {
        for k in 0..40 {
            let (mesh, lanes) = triangle(0.04 * k as f64);
            let pair = lanes.of[0].unwrap();
            assert!(dot(pair[0].along, pair[1].along).abs() < 3.0 * CLEAR);
            for lane in pair {
                for local in 0..3 {
                    for t in [0.01, 0.2, 0.5, 0.77, 0.99] {
                        let at = |local: usize, t: f64| {
                            mesh.points[mesh.triangles[0][local]] + mesh.along(0, local) * t
                        };
                        let (out, s) = lane.across(local, t);
                        let chord = at(out, s) - at(local, t);
                        assert!(out != local && cross(chord, lane.along).abs() < 1e-10);
                        let (back, u) = lane.across(out, s);
                        assert!(back == local && (u - t).abs() < 1e-12);
                        let middle = (at(out, s) + at(local, t)) * 0.5;
                        let odd = if local == lane.odd { t } else { s };
                        assert!((lane.project(&mesh, 0, middle) - odd).abs() < 1e-12);
                    }
                }
            }
        }
    }

    #[test]
    fn a_triangle_with_a_singularity_has_no_lanes() {
        let points = vec![point(0., 0.), point(10., 1.), point(3., 8.)];
        let vectors = [0.0, 2.0, 4.0].map(|a: f64| point(a.cos(), a.sin()));
        let mesh = Mesh::new(points, vectors.to_vec(), vec![[0, 1, 2]]).unwrap();
        assert!(Lanes::new(&mesh).of[0].is_none());
    }
}
