//! Linework in, points and edges that meet only at points out.
//!
//! Rounds of iterated snapping: pieces that come near a vertex are bent
//! through it, pieces that cross are cut at a vertex there, until nothing
//! changes.
//!
//! Near means closer than [`NEAR`] times the snap distance. As input vertices
//! are a whole snap distance apart, a bent piece's parts are then shorter
//! than the piece (near is under 1 / sqrt 2 of the separation), and bending
//! must end. Crossings may come closer to each other than input vertices do;
//! there, two neighbouring vertices could take turns in bending one piece for
//! ever. So a piece that comes back after it was bent only bends for half the
//! distance, up to [`HALVINGS`] times.

use super::index::SegmentIndex;
use super::predicates::{crosses, dist, dist_to_segment, dot, finite, lerp, orient, sub, P};
use super::PlanarMesh;
use crate::error::MeshError;
use geo_types::LineString;
use std::collections::HashMap;

/// A polyline to build a mesh from, with the attributes of its two sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Wire<E> {
    /// The polyline; close it by repeating its first point.
    pub line: LineString<f64>,
    /// Attribute of the side on the left when walking along the line.
    pub left: E,
    /// Attribute of the side on the right.
    pub right: E,
    /// Where wires run on top of each other the one with the higher priority
    /// gives the attributes of both sides, and of points that fall together
    /// its point stays in place; the earlier wire breaks ties.
    pub priority: u8,
}

/// One piece of a wire between two vertices, in the wire's direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) a: u32,
    pub(super) b: u32,
    pub(super) wire: u32,
}

/// The settled linework.
#[derive(Debug)]
pub(super) struct Arrangement {
    pub(super) points: Vec<P>,
    pub(super) pieces: Vec<Piece>,
    pub(super) tolerance: f64,
    pub(super) snap: f64,
}

/// Pieces and vertices are numbered in 32 bits, two half-edges a piece; the
/// limit also keeps memory within some gigabytes.
const LIMIT: usize = 20_000_000;
/// Fraction of the snap distance below which a piece bends to a vertex.
const NEAR: f64 = 0.7;
/// How often that distance may be halved for a piece that keeps coming back.
const HALVINGS: u8 = 3;
/// The least snap distance, in tolerances: after all halvings, the distance
/// is still over the tolerance.
const LEAST: f64 = 16.0;
/// Settling takes two to five rounds on real linework.
const ROUNDS: usize = 100;

/// Vertices that are farther apart than the snap distance, in a hash grid of
/// cells of that size. The map is only looked up, never iterated.
struct Vertices {
    points: Vec<P>,
    cells: HashMap<(i64, i64), Vec<u32>>,
    origin: P,
    snap: f64,
}

impl Vertices {
    fn cell(&self, p: P) -> (i64, i64) {
        let c = |v: f64| (v / self.snap).floor() as i64;
        (c(p.x - self.origin.x), c(p.y - self.origin.y))
    }

    /// The vertex nearest to `p` within `reach` (at most the snap distance),
    /// or a new one.
    fn at(&mut self, p: P, reach: f64) -> u32 {
        let (cx, cy) = self.cell(p);
        let mut best: Option<(f64, u32)> = None;
        for x in cx - 1..=cx + 1 {
            for y in cy - 1..=cy + 1 {
                for &i in self.cells.get(&(x, y)).into_iter().flatten() {
                    let d = dist(self.points[i as usize], p);
                    if d <= reach && best.is_none_or(|b| (d, i) < b) {
                        best = Some((d, i));
                    }
                }
            }
        }
        best.map_or_else(
            || {
                let i = self.points.len() as u32;
                self.points.push(p);
                self.cells.entry((cx, cy)).or_default().push(i);
                i
            },
            |b| b.1,
        )
    }
}

/// The pieces, without duplicates.
struct Pieces<'a> {
    all: Vec<Piece>,
    live: Vec<bool>,
    dirty: Vec<bool>,
    by_ends: HashMap<(u32, u32), u32>,
    /// How often a piece between two vertices was bent, by its ends.
    bent: HashMap<(u32, u32), u8>,
    /// Below which distance each piece bends, in snap distances.
    near: Vec<f64>,
    /// Rank of each wire: lower wins.
    rank: &'a [u32],
}

impl Pieces<'_> {
    fn add(&mut self, piece: Piece) {
        if piece.a == piece.b {
            return;
        }
        let ends = (piece.a.min(piece.b), piece.a.max(piece.b));
        let fresh = self.all.len() as u32;
        let at = *self.by_ends.entry(ends).or_insert(fresh);
        if at == fresh {
            self.all.push(piece);
            self.live.push(true);
            self.dirty.push(true);
            let bent = self.bent.get(&ends).copied().unwrap_or(0);
            self.near
                .push(NEAR * 0.5_f64.powi(i32::from(bent.min(HALVINGS))));
        } else {
            let old = &mut self.all[at as usize];
            if self.rank[piece.wire as usize] < self.rank[old.wire as usize] {
                *old = piece;
            }
        }
    }

    fn remove(&mut self, i: u32) -> Piece {
        let piece = self.all[i as usize];
        self.live[i as usize] = false;
        let ends = (piece.a.min(piece.b), piece.a.max(piece.b));
        self.by_ends.remove(&ends);
        let bent = self.bent.entry(ends).or_insert(0);
        *bent = bent.saturating_add(1);
        piece
    }
}

pub(super) fn arrange<E>(wires: &[Wire<E>], snap: f64) -> Result<Arrangement, MeshError> {
    if !(snap.is_finite() && snap >= 0.0) {
        return Err(MeshError::BadSnap { snap });
    }
    let too_complex = MeshError::TooComplex { limit: LIMIT };
    let (mut lo, mut hi) = (
        P {
            x: f64::MAX,
            y: f64::MAX,
        },
        P {
            x: f64::MIN,
            y: f64::MIN,
        },
    );
    let mut count = 0_usize;
    for (w, wire) in wires.iter().enumerate() {
        for (i, &p) in wire.line.0.iter().enumerate() {
            if !finite(p) || p.x.abs() > 1e150 || p.y.abs() > 1e150 {
                return Err(MeshError::NonFinite { wire: w, index: i });
            }
            lo = P {
                x: lo.x.min(p.x),
                y: lo.y.min(p.y),
            };
            hi = P {
                x: hi.x.max(p.x),
                y: hi.y.max(p.y),
            };
            count += 1;
        }
    }
    if count == 0 {
        return Err(MeshError::Empty { snap });
    }
    if count > LIMIT || wires.len() > LIMIT {
        return Err(too_complex);
    }
    let largest = lo.x.abs().max(lo.y.abs()).max(hi.x.abs()).max(hi.y.abs());
    let tolerance = (1e-9 * dist(lo, hi)).max(16.0 * f64::EPSILON * largest);
    let snap = snap.max(LEAST * tolerance);
    if snap == 0.0 {
        return Err(MeshError::Empty { snap });
    }

    // The order of precedence: high priority first, then the input's order.
    let mut order: Vec<usize> = (0..wires.len()).collect();
    order.sort_by_key(|&w| (std::cmp::Reverse(wires[w].priority), w));
    let mut rank = vec![0_u32; wires.len()];
    let mut vertices = Vertices {
        points: Vec::new(),
        cells: HashMap::new(),
        origin: lo,
        snap,
    };
    let mut ids: Vec<Vec<u32>> = vec![Vec::new(); wires.len()];
    for (r, &w) in order.iter().enumerate() {
        rank[w] = r as u32;
        ids[w] = wires[w]
            .line
            .0
            .iter()
            .map(|&p| vertices.at(p, snap))
            .collect();
    }
    let mut pieces = Pieces {
        all: Vec::new(),
        live: Vec::new(),
        dirty: Vec::new(),
        by_ends: HashMap::new(),
        bent: HashMap::new(),
        near: Vec::new(),
        rank: &rank,
    };
    for (w, ids) in ids.iter().enumerate() {
        for pair in ids.windows(2) {
            pieces.add(Piece {
                a: pair[0],
                b: pair[1],
                wire: w as u32,
            });
        }
    }
    if pieces.all.is_empty() {
        return Err(MeshError::Empty { snap });
    }

    for _ in 0..ROUNDS {
        let Some(cuts) = contacts(&mut vertices, &pieces)? else {
            return Ok(finish(vertices, pieces, tolerance));
        };
        pieces.dirty.iter_mut().for_each(|d| *d = false);
        for (i, through) in cuts {
            let piece = pieces.remove(i);
            let mut from = piece.a;
            for v in through.into_iter().chain([piece.b]) {
                pieces.add(Piece {
                    a: from,
                    b: v,
                    wire: piece.wire,
                });
                from = v;
            }
        }
        if pieces.all.len() > LIMIT || vertices.points.len() > LIMIT {
            return Err(too_complex);
        }
    }
    let at = pieces
        .dirty
        .iter()
        .position(|&d| d)
        .map_or(lo, |i| vertices.points[pieces.all[i].a as usize]);
    Err(MeshError::Unsettled {
        rounds: ROUNDS,
        snap,
        x: at.x,
        y: at.y,
    })
}

/// Pieces to be cut, and the vertices to cut them at, in order along each.
type Cuts = Vec<(u32, Vec<u32>)>;

/// One round: which pieces must be bent through vertices near them, or cut
/// where they cross? `None` if none.
fn contacts(vertices: &mut Vertices, pieces: &Pieces<'_>) -> Result<Option<Cuts>, MeshError> {
    let live = |i: &usize| pieces.live[*i];
    let ends = |vertices: &Vertices, i: u32| {
        let p = pieces.all[i as usize];
        (vertices.points[p.a as usize], vertices.points[p.b as usize])
    };
    let index = SegmentIndex::new((0..pieces.all.len()).filter(live).map(|i| {
        let (a, b) = ends(vertices, i as u32);
        (i as u32, a, b)
    }));
    let snap = vertices.snap;
    let mut cuts: Vec<(u32, u32)> = Vec::new();
    let mut crossing: Vec<(u32, u32)> = Vec::new();
    let mut near = Vec::new();
    for s in (0..pieces.all.len()).filter(|&i| pieces.live[i] && pieces.dirty[i]) {
        let piece = pieces.all[s];
        let (a, b) = ends(vertices, s as u32);
        index.near(a, b, snap, &mut near);
        for &t in &near {
            // Two dirty pieces meet once, from the lower number.
            if t as usize == s || (pieces.dirty[t as usize] && (t as usize) < s) {
                continue;
            }
            let other = pieces.all[t as usize];
            let (c, d) = ends(vertices, t);
            let before = cuts.len();
            for (v, p) in [(other.a, c), (other.b, d)] {
                if v != piece.a && v != piece.b && dist_to_segment(p, a, b) <= snap * pieces.near[s]
                {
                    cuts.push((s as u32, v));
                }
            }
            for (v, p) in [(piece.a, a), (piece.b, b)] {
                if v != other.a
                    && v != other.b
                    && dist_to_segment(p, c, d) <= snap * pieces.near[t as usize]
                {
                    cuts.push((t, v));
                }
            }
            if cuts.len() == before && crosses(a, b, c, d) {
                crossing.push((s as u32, t));
            }
            if cuts.len() + crossing.len() > LIMIT {
                return Err(MeshError::TooComplex { limit: LIMIT });
            }
        }
    }
    // Cut crossings only where both pieces stay as they are; bent ones are
    // looked at again in the next round.
    let mut bent = vec![false; pieces.all.len()];
    for &(i, _) in &cuts {
        bent[i as usize] = true;
    }
    for (s, t) in crossing {
        if bent[s as usize] || bent[t as usize] {
            continue;
        }
        let ((a, b), (c, d)) = (ends(vertices, s), ends(vertices, t));
        // Orientations are accurate relative to themselves, so the point
        // lies on ab to the last place, however flat the crossing.
        let (oa, ob) = (orient(c, d, a), orient(c, d, b));
        let v = vertices.at(lerp(a, b, oa / (oa - ob)), NEAR * snap);
        for i in [s, t] {
            let piece = pieces.all[i as usize];
            if v != piece.a && v != piece.b {
                cuts.push((i, v));
            }
        }
    }
    if cuts.is_empty() {
        return Ok(None);
    }
    cuts.sort_unstable();
    cuts.dedup();
    let mut grouped: Cuts = Vec::new();
    for (i, v) in cuts {
        match grouped.last_mut() {
            Some((last, through)) if *last == i => through.push(v),
            _ => grouped.push((i, vec![v])),
        }
    }
    for (i, through) in &mut grouped {
        let (a, b) = ends(vertices, *i);
        let along = |v: &u32| dot(sub(vertices.points[*v as usize], a), sub(b, a));
        through.sort_by(|v, w| along(v).total_cmp(&along(w)).then(v.cmp(w)));
    }
    Ok(Some(grouped))
}

/// Drops vertices that no piece uses, and dead pieces.
fn finish(vertices: Vertices, pieces: Pieces<'_>, tolerance: f64) -> Arrangement {
    let mut kept: Vec<Piece> = pieces
        .all
        .iter()
        .zip(&pieces.live)
        .filter(|(_, &live)| live)
        .map(|(&p, _)| p)
        .collect();
    let mut number = vec![u32::MAX; vertices.points.len()];
    for piece in &kept {
        number[piece.a as usize] = 0;
        number[piece.b as usize] = 0;
    }
    let mut points = Vec::new();
    for (n, &p) in number.iter_mut().zip(&vertices.points) {
        if *n == 0 {
            *n = points.len() as u32;
            points.push(p);
        }
    }
    for piece in &mut kept {
        piece.a = number[piece.a as usize];
        piece.b = number[piece.b as usize];
    }
    // In the order of the wires, so that ids follow the input.
    kept.sort_by_key(|p| p.wire);
    Arrangement {
        points,
        pieces: kept,
        tolerance,
        snap: vertices.snap,
    }
}

impl<E: Clone> PlanarMesh<E> {
    /// Builds a mesh from linework by a robust arrangement.
    ///
    /// Crossings become vertices; ends that touch another line become
    /// vertices of both; lines on top of each other become one edge, with the
    /// attributes of the wire of higher [priority](Wire::priority); points
    /// closer than `snap` become one vertex, and a line that passes a vertex
    /// closer than 0.7 `snap` is bent through it (less where crossings crowd
    /// within a snap distance, but never under
    /// [`tolerance`](Self::tolerance)). Each connected part of the
    /// linework that lies inside a face is a hole of that face. Lines that
    /// end inside a face are kept, with the face on both sides.
    ///
    /// # Units
    ///
    /// `snap` in the units of the coordinates (metres), used no smaller than
    /// 16 times [`tolerance`](Self::tolerance): 0 asks for as little snapping as
    /// double precision allows. A vertex moves by at most `snap` per round of
    /// snapping, in practice by at most `snap`.
    ///
    /// # Errors
    ///
    /// [`MeshError::NonFinite`], [`MeshError::BadSnap`], [`MeshError::Empty`]
    /// if no piece is longer than `snap`, [`MeshError::TooComplex`],
    /// [`MeshError::Unsettled`].
    ///
    /// # Complexity
    ///
    /// O((n + k) log n) for n segments with k crossings, n spread so that
    /// the boxes of few overlap; 10^5 segments of a street map take well
    /// under a second.
    pub fn from_linework(wires: &[Wire<E>], snap: f64) -> Result<Self, MeshError> {
        let arrangement = arrange(wires, snap)?;
        super::build::build(&arrangement, |piece| {
            let wire = &wires[piece.wire as usize];
            (wire.left.clone(), wire.right.clone())
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::mesh::predicates::foot;
    use geo_types::line_string;

    fn wire(line: LineString<f64>) -> Wire<()> {
        Wire {
            line,
            left: (),
            right: (),
            priority: 0,
        }
    }

    #[test]
    fn a_flat_crossing_is_cut_on_both() {
        let a = wire(line_string![(x: 0., y: 0.), (x: 1000., y: 0.001)]);
        let b = wire(line_string![(x: 0., y: 0.001), (x: 1000., y: 0.)]);
        let got = arrange(&[a, b], 0.0).unwrap();
        assert_eq!((got.points.len(), got.pieces.len()), (5, 4));
        let p = got.points[4];
        assert!(
            (p.x - 500.0).abs() < 1e-6 && (p.y - 0.0005).abs() < 1e-12,
            "{p:?}"
        );
        assert_eq!(foot(p, got.points[0], got.points[1]), 0.5);
    }

    #[test]
    fn a_touch_bends_the_line_and_priority_keeps_its_point() {
        let road = Wire {
            priority: 1,
            ..wire(line_string![(x: 0., y: 0.), (x: 10., y: 0.)])
        };
        let stub = wire(line_string![(x: 5., y: 5.), (x: 5., y: 0.05)]);
        let near = wire(line_string![(x: 10.03, y: 0.), (x: 10., y: 9.)]);
        let got = arrange(&[stub, near, road], 0.1).unwrap();
        assert_eq!((got.points.len(), got.pieces.len()), (5, 4));
        assert!(got.points.contains(&P { x: 10., y: 0. }));
        assert!(got.points.contains(&P { x: 5., y: 0.05 }));
    }
}
