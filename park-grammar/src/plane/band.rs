//! The band along a part of a boundary: what its edges pass over where they are
//! moved into the land.
//!
//! Each edge passes over a cell: the quadrangle between it and its place after the
//! move. At a corner of more than half a turn between two moved edges lies a wedge
//! besides, in a mitre of at most four depths; at other corners cells overlap, and
//! the edges end where they meet. What the end of a run of edges does is the matter
//! of [`Ends`].
//!
//! An edge moves on until it meets the boundary: land behind a bay, which is in the
//! way, is not reached. Where cells could go on beyond the boundary they are cut to
//! what their edge sees along its way. In that, and in its mitres, a band differs from
//! what [`erode`](fn@super::erode) takes away, which is all land within a width: peeled
//! strips have the same depth and sharp corners everywhere, and leave what they pass
//! by alone.
//!
//! The band is had as areas that overlap and go on beyond the land where it ends.
//! Their vertices on the boundary are vertices of the boundary to the last digit:
//! so the land may be cut by them without hairs along its edge.

use std::slice::from_ref;

use geo_types::Coord;

use super::inset::{wedge, REACH, STRAIGHT};
use super::{
    cross, difference, dist, dot, intersection, lerp, right, sides, trim, union, unit, Area,
    Corner, Ring, Segment,
};

/// What is told from zero, as a share.
const TINY: f64 = 1e-9;

/// So many areas may overlap.
const FEW: usize = 16;

/// A cell and the wedge beside it, and the next cell.
const OVERLAP: usize = 3;

/// Corners this near to a right angle, by the cosine, are right.
const RIGHT: f64 = 1e-6;

/// A vertex of the boundary, and whether the edge that begins there moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bound {
    pub(crate) at: Coord<f64>,
    pub(crate) moves: bool,
}

/// How a run of moved edges ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// Its corners slide along the edges next to it, unless those lead away from
    /// the land (a corner of half a turn or more), or would lead them farther
    /// along than mitres reach, four depths: then as below.
    Follow,
    /// At right angles to the moved edge.
    Square,
}

/// A band.
#[derive(Clone, Debug)]
pub(crate) struct Band {
    /// The land, with vertices where the band ends at its boundary.
    pub(crate) land: Area,
    /// What the edges pass over: areas that overlap, and may go on beyond the land.
    pub(crate) cover: Vec<Area>,
    /// Where the band ends sideways within the land.
    pub(crate) flanks: Vec<Segment>,
}

/// An edge that moves, by ring and number.
#[derive(Clone, Copy, Debug)]
struct Mover {
    ring: usize,
    edge: usize,
    a: Coord<f64>,
    b: Coord<f64>,
    /// Into the land.
    inward: Coord<f64>,
}

/// One end of a mover's cell.
#[derive(Clone, Debug, Default)]
struct End {
    /// Vertices of the boundary from the mover's end on, without that.
    chain: Vec<Coord<f64>>,
    /// Where the moved edge ends.
    tip: Coord<f64>,
    /// Edges of the boundary that the chain follows.
    follows: Vec<usize>,
    /// The edge of the boundary that gets the tip as a vertex.
    onto: Option<usize>,
    flank: Option<Segment>,
}

impl Band {
    /// The band so deep along the moving edges of a boundary: its rings, the land
    /// on the right.
    ///
    /// # Errors
    ///
    /// What `look` gives, which is called for each edge and between booleans.
    pub(crate) fn new<E>(
        rings: &[Vec<Bound>],
        depth: f64,
        ends: Ends,
        look: impl Fn() -> Result<(), E>,
    ) -> Result<Self, E> {
        let shaping = Shaping { rings, depth, ends };
        let movers = shaping.movers();
        let shapes: Vec<[End; 2]> = movers
            .iter()
            .map(|mover| [true, false].map(|start| shaping.end(mover, start)))
            .collect();
        let land = shaping.land(&movers, &shapes);
        let edges = shaping.edges();
        let mut band = Self {
            land,
            cover: Vec::new(),
            flanks: Vec::new(),
        };
        let joints = shaping.joints(&movers);
        for ((mover, [start, end]), joint) in movers.iter().zip(&shapes).zip(joints) {
            look()?;
            let mut ring = vec![mover.a, mover.b];
            ring.extend(&end.chain);
            ring.extend([end.tip, start.tip]);
            ring.extend(start.chain.iter().rev());
            ring.dedup();
            let turned = dot(end.tip - start.tip, mover.b - mover.a) < 0.0;
            let mut cells = vec![Area::new(ring, Vec::new())];
            if turned {
                // Its ends crossed on their way.
                cells = union(&cells);
            }
            band.flanks.extend(start.flank.iter().chain(&end.flank));
            let own = |ring: usize, edge: usize| {
                let follows = || start.follows.contains(&edge) || end.follows.contains(&edge);
                ring == mover.ring && (edge == mover.edge || follows())
            };
            let others: Vec<Segment> = edges
                .iter()
                .filter(|(ring, edge, _)| !own(*ring, *edge))
                .map(|(_, _, segment)| *segment)
                .collect();
            band.cell(mover, cells, &others, depth);
            if let Some(joint) = joint {
                band.wedge(joint, depth, &edges);
            }
        }
        band.cover = merged(band.cover, look)?;
        Ok(band)
    }

    /// Adds the cell of a mover, as far as the mover sees it.
    fn cell(&mut self, mover: &Mover, cells: Vec<Area>, others: &[Segment], depth: f64) {
        let along = unit(mover.b - mover.a);
        let coordinates = |p: Coord<f64>| [dot(p - mover.a, along), dot(p - mover.a, mover.inward)];
        let tiny = TINY * depth;
        let laterals = cells
            .iter()
            .flat_map(|c| &c.outer)
            .map(|&p| coordinates(p)[0]);
        let (low, high) = laterals.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        let meets = |&(p, q): &Segment| {
            let ([x, y], [u, v]) = (coordinates(p), coordinates(q));
            x.max(u) > low + tiny
                && x.min(u) < high - tiny
                && y.max(v) > tiny
                && y.min(v) < depth - tiny
        };
        let inward = |(p, q): Segment| dot(right(unit(q - p)), mover.inward);
        // Whoever goes along the way enters the land again only over an edge that
        // faces as the mover does.
        let enters = |s: &&Segment| inward(**s) > TINY && meets(s);
        if !others.iter().any(|s| enters(&s)) {
            self.cover.extend(cells);
            return;
        }
        let mut shadows = Vec::new();
        for &(p, q) in others.iter().filter(|s| inward(**s) < -TINY && meets(s)) {
            // Only what lies on the way, not what lies behind the mover.
            let (y, v) = (coordinates(p)[1], coordinates(q)[1]);
            let front = |p: Coord<f64>, q: Coord<f64>, y: f64, v: f64| {
                if y < 0.0 {
                    lerp(p, q, y / (y - v))
                } else {
                    p
                }
            };
            let (from, to) = (front(p, q, y, v), front(q, p, v, y));
            let far = mover.inward * (2.0 * depth);
            shadows.push(Area::new(vec![from, to, to + far, from + far], Vec::new()));
            self.flanks.extend([(from, from + far), (to, to + far)]);
        }
        let seen = intersection(&cells, from_ref(&self.land));
        self.cover.extend(difference(&seen, &shadows));
    }

    /// Adds the wedge at a joint, as far as it hangs together with the joint.
    fn wedge(&mut self, joint: Joint, depth: f64, edges: &[(usize, usize, Segment)]) {
        let Joint { at, sides, turn } = joint;
        let ring: Ring = wedge(at, sides, turn, depth, Corner::Mitre);
        let reach = ring.iter().map(|&p| dist(p, at)).fold(0.0, f64::max);
        let area = Area::new(ring, Vec::new());
        let (low, high) = area.extent();
        let tiny = TINY * depth;
        let enters = |&(p, q): &Segment| {
            let near = p.x.max(q.x) > low.x + tiny
                && p.x.min(q.x) < high.x - tiny
                && p.y.max(q.y) > low.y + tiny
                && p.y.min(q.y) < high.y - tiny;
            let facing = dot(right(unit(q - p)), p - at);
            near && facing > tiny && facing < reach
        };
        if !edges.iter().any(|(_, _, segment)| enters(segment)) {
            self.cover.push(area);
            return;
        }
        let parts = intersection(&[area], from_ref(&self.land));
        let whole = parts.into_iter().filter(|part| part.nearest(at).1 <= tiny);
        self.cover.extend(whole);
    }
}

/// Areas made one where they are many: neighbours first, so that no step meets
/// many that overlap. Along a fine curve all cells of a deep band do.
fn merged<E>(areas: Vec<Area>, look: impl Fn() -> Result<(), E>) -> Result<Vec<Area>, E> {
    let n = areas.len();
    if n <= FEW {
        return Ok(areas);
    }
    // Each group has the first of the next one too: what only touches may come out
    // with a slit between.
    let group = |start: usize| {
        let end = (start + FEW).min(n);
        let next = (end..end + OVERLAP).map(|k| &areas[k % n]);
        let group: Vec<Area> = areas[start..end].iter().chain(next).cloned().collect();
        union(&group)
    };
    let mut merged: Vec<Area> = Vec::new();
    for start in (0..n).step_by(FEW) {
        look()?;
        merged.extend(group(start));
    }
    while merged.len() > FEW {
        let mut fewer = Vec::new();
        for chunk in merged.chunks(FEW) {
            look()?;
            fewer.extend(union(chunk));
        }
        let stuck = fewer.len() == merged.len();
        merged = fewer;
        if stuck {
            break;
        }
    }
    look()?;
    Ok(union(&merged))
}

/// A corner of more than half a turn between two movers.
struct Joint {
    at: Coord<f64>,
    /// The inward directions of the two.
    sides: [Coord<f64>; 2],
    /// By how much the boundary turns, radians.
    turn: f64,
}

struct Shaping<'r> {
    rings: &'r [Vec<Bound>],
    depth: f64,
    ends: Ends,
}

impl Shaping<'_> {
    fn edge(&self, ring: usize, edge: usize) -> Segment {
        let points = &self.rings[ring];
        (points[edge].at, points[(edge + 1) % points.len()].at)
    }

    /// All edges, by ring and number.
    fn edges(&self) -> Vec<(usize, usize, Segment)> {
        let of = |ring: usize| (0..self.rings[ring].len()).map(move |edge| (ring, edge));
        (0..self.rings.len())
            .flat_map(of)
            .map(|(ring, edge)| (ring, edge, self.edge(ring, edge)))
            .collect()
    }

    fn movers(&self) -> Vec<Mover> {
        self.edges()
            .into_iter()
            .filter(|&(ring, edge, (a, b))| self.rings[ring][edge].moves && a != b)
            .map(|(ring, edge, (a, b))| Mover {
                ring,
                edge,
                a,
                b,
                inward: right(unit(b - a)),
            })
            .collect()
    }

    /// For each mover the joint at its end, if there is one.
    fn joints(&self, movers: &[Mover]) -> Vec<Option<Joint>> {
        let joint = |(k, before): (usize, &Mover)| {
            // The next mover of the ring, if it begins where this one ends.
            let next = movers.get(k + 1).filter(|m| m.ring == before.ring);
            let first = || movers.iter().find(|m| m.ring == before.ring);
            let after = next.or_else(first).filter(|m| m.a == before.b)?;
            let (u, v) = (unit(before.b - before.a), unit(after.b - after.a));
            let turn = cross(u, v).atan2(dot(u, v));
            // Where the boundary goes straight on, rounding could leave a slit.
            (turn > -STRAIGHT).then_some(Joint {
                at: after.a,
                sides: [before.inward, after.inward],
                turn: turn.max(0.0),
            })
        };
        movers.iter().enumerate().map(joint).collect()
    }

    /// Where the moved edge ends at one of its ends.
    fn end(&self, mover: &Mover, start: bool) -> End {
        let points = &self.rings[mover.ring];
        let n = points.len();
        let pivot = if start { mover.a } else { mover.b };
        let plain = pivot + mover.inward * self.depth;
        let next = if start {
            (mover.edge + n - 1) % n
        } else {
            (mover.edge + 1) % n
        };
        let joint = points[next].moves;
        let (p, q) = self.edge(mover.ring, next);
        let neighbour = unit(if start { p - q } else { q - p });
        let outward = unit(mover.b - mover.a) * if start { -1.0 } else { 1.0 };
        let (lean, down) = (dot(neighbour, outward), dot(neighbour, mover.inward));
        // A selection that ends within an edge has that itself as neighbour, whichever
        // way rounding turns it.
        if down > TINY {
            // As right angles come out by rounding, the neighbour is the end.
            let square = lean.abs() < RIGHT;
            let follows = !joint && self.ends == Ends::Follow && lean > 0.0;
            let most = match (follows, square) {
                (true, _) => Some((REACH * REACH - 1.0).sqrt()),
                (false, true) => Some(RIGHT),
                (false, false) => None,
            };
            let chain = |most: f64| self.follow(mover, start, most, joint);
            let found = most.and_then(chain);
            let found = found.or_else(|| (follows && square).then(|| chain(RIGHT)).flatten());
            if let Some(end) = found {
                return end;
            }
        }
        End {
            tip: plain,
            flank: (!joint).then_some((pivot, plain)),
            ..End::default()
        }
    }

    /// The boundary from an end of a mover as far as the depth, if it leads there
    /// without turning back, and no farther than `most` depths beyond the end.
    fn follow(&self, mover: &Mover, start: bool, most: f64, joint: bool) -> Option<End> {
        let points = &self.rings[mover.ring];
        let n = points.len();
        let pivot = if start { mover.a } else { mover.b };
        let outward = unit(mover.b - mover.a) * if start { -1.0 } else { 1.0 };
        let deep = |p: Coord<f64>| dot(p - pivot, mover.inward);
        let mut end = End::default();
        let (mut at, mut before) = (pivot, 0.0);
        for k in 0..n {
            let edge = if start {
                (mover.edge + 2 * n - 1 - k) % n
            } else {
                (mover.edge + 1 + k) % n
            };
            let (p, q) = self.edge(mover.ring, edge);
            let next = if start { p } else { q };
            let depth = deep(next);
            if depth <= before {
                return None;
            }
            end.follows.push(edge);
            let reached = depth >= self.depth * (1.0 - 1e-12);
            let tip = if depth > self.depth * (1.0 + 1e-12) {
                let share = (self.depth - before) / (depth - before);
                end.onto = (!points[edge].moves).then_some(edge);
                // Beside a neighbour that moves too, there is no need of a vertex.
                if end.onto.is_none() && joint {
                    return None;
                }
                lerp(at, next, share)
            } else {
                next
            };
            if dot(tip - pivot, outward).abs() > most * self.depth {
                return None;
            }
            if reached {
                end.tip = tip;
                return Some(end);
            }
            end.chain.push(next);
            (at, before) = (next, depth);
        }
        None
    }

    /// The land, with the tips that lie on its boundary as vertices.
    fn land(&self, movers: &[Mover], shapes: &[[End; 2]]) -> Area {
        let mut tips: Vec<(usize, usize, Coord<f64>)> = Vec::new();
        for (mover, ends) in movers.iter().zip(shapes) {
            let onto = |end: &End| end.onto.map(|edge| (mover.ring, edge, end.tip));
            tips.extend(ends.iter().filter_map(onto));
        }
        let ring = |ring: usize| {
            let mut points = Ring::new();
            for edge in 0..self.rings[ring].len() {
                let (a, b) = self.edge(ring, edge);
                points.push(a);
                let mut here: Vec<Coord<f64>> = tips
                    .iter()
                    .filter(|tip| tip.0 == ring && tip.1 == edge && tip.2 != b)
                    .map(|tip| tip.2)
                    .collect();
                here.sort_by(|p, q| dist(a, *p).total_cmp(&dist(a, *q)));
                points.extend(here);
            }
            points.dedup();
            points
        };
        Area {
            outer: ring(0),
            holes: (1..self.rings.len()).map(ring).collect(),
        }
    }
}

/// What cuts the land between a boundary and its whole self, drawn in so far.
///
/// # Errors
///
/// What `look` gives, which is called as by [`Band::new`].
pub(crate) fn inset<E>(
    area: &Area,
    depth: f64,
    look: impl Fn() -> Result<(), E>,
) -> Result<Vec<Area>, E> {
    let all = |ring: &Ring| -> Vec<Bound> {
        let bound = |(at, _)| Bound { at, moves: true };
        sides(ring).map(bound).collect()
    };
    let rings: Vec<Vec<Bound>> = area.rings().map(all).collect();
    let band = Band::new(&rings, depth, Ends::Follow, look)?;
    let (low, high) = area.extent();
    Ok(trim(
        difference(from_ref(&band.land), &band.cover),
        dist(low, high),
    ))
}

#[cfg(test)]
mod tests;
