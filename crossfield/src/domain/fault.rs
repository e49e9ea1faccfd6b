//! What is wrong with rings that could not be triangulated.

use super::lattice::Segment;
use super::ring::{Frame, Ring};
use crate::plane::{orient_exact, V2};
use crate::FieldError;

/// Refuses two segments between the same points: a zero-width slit, or rings
/// that share an edge.
pub(super) fn overlapping(
    rings: &[Ring],
    frame: Frame,
    segments: &[Segment],
) -> Result<(), FieldError> {
    let key = |s: &Segment| (s.from.min(s.to), s.from.max(s.to));
    let mut order: Vec<&Segment> = segments.iter().collect();
    order.sort_by_key(|s| (key(s), s.ring, s.edge));
    match order.windows(2).find(|pair| key(pair[0]) == key(pair[1])) {
        Some(pair) => {
            let at = rings[pair[0].ring as usize].points[pair[0].edge as usize];
            Err(intersecting(rings, frame, pair[0], pair[1], at))
        }
        None => Ok(()),
    }
}

/// The error for a segment that spade could not add: finds what it crosses.
pub(super) fn crossing(
    rings: &[Ring],
    frame: Frame,
    points: &[V2],
    segments: &[Segment],
    pair: [usize; 2],
) -> FieldError {
    let refused = segments.iter().find(|s| {
        pair == [s.from as usize, s.to as usize] || pair == [s.to as usize, s.from as usize]
    });
    let Some(refused) = refused else {
        return FieldError::MeshFailed {
            what: "two boundary edges cross".into(),
        };
    };
    let ends = |s: &Segment| (points[s.from as usize], points[s.to as usize]);
    let (a, b) = ends(refused);
    let across = |s: &&Segment| {
        let (c, d) = ends(s);
        cross_properly(a, b, c, d)
    };
    let other = segments.iter().find(across).unwrap_or(refused);
    intersecting(rings, frame, refused, other, (a + b) / 2.0)
}

fn intersecting(
    rings: &[Ring],
    frame: Frame,
    one: &Segment,
    other: &Segment,
    at: V2,
) -> FieldError {
    let edge = |s: &Segment| rings[s.ring as usize].input_edge[s.edge as usize] as usize;
    FieldError::SelfIntersecting {
        ring: one.ring as usize,
        edge: edge(one),
        other_ring: other.ring as usize,
        other_edge: edge(other),
        x: at.x + frame.origin.x,
        y: at.y + frame.origin.y,
    }
}

/// The error for rings whose triangles do not add up to their area: edges
/// that cross just where both were subdivided, or a hole in the wrong place.
pub(super) fn misplaced(rings: &[Ring], frame: Frame, expected: f64, got: f64) -> FieldError {
    if let Some((one, other, at)) = first_crossing(rings) {
        return intersecting(rings, frame, &one, &other, at);
    }
    for (index, ring) in rings.iter().enumerate().skip(1) {
        // A vertex may touch another ring; the majority decides.
        let outside = |p: &&V2| {
            let holes = rings.iter().enumerate().skip(1);
            !rings[0].contains(**p)
                || holes
                    .filter(|(k, _)| *k != index)
                    .any(|(_, r)| r.contains(**p))
        };
        if 2 * ring.points.iter().filter(outside).count() > ring.len() {
            return FieldError::HoleOutside { ring: index };
        }
    }
    FieldError::MeshFailed {
        what: format!("its triangles cover {got}, the polygon has {expected} square units"),
    }
}

/// Two ring edges that cross properly, by a sweep over their x ranges.
fn first_crossing(rings: &[Ring]) -> Option<(Segment, Segment, V2)> {
    let mut edges: Vec<(f64, f64, Segment)> = Vec::new();
    for (ring, points) in rings.iter().enumerate() {
        for k in 0..points.len() {
            let (a, b) = points.edge(k);
            let segment = Segment {
                from: 0,
                to: 0,
                ring: ring as u32,
                edge: k as u32,
            };
            edges.push((a.x.min(b.x), a.x.max(b.x), segment));
        }
    }
    edges.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ends = |s: &Segment| rings[s.ring as usize].edge(s.edge as usize);
    let mut open: Vec<(f64, Segment)> = Vec::new();
    for &(left, right, segment) in &edges {
        open.retain(|&(end, _)| end >= left);
        let (a, b) = ends(&segment);
        for (_, other) in &open {
            let (c, d) = ends(other);
            if cross_properly(a, b, c, d) {
                return Some((*other, segment, (a + b) / 2.0));
            }
        }
        open.push((right, segment));
    }
    None
}

/// Whether two segments cross in a point inside both.
fn cross_properly(a: V2, b: V2, c: V2, d: V2) -> bool {
    let apart = |u: f64, v: f64| (u > 0.0 && v < 0.0) || (u < 0.0 && v > 0.0);
    apart(orient_exact(a, b, c), orient_exact(a, b, d))
        && apart(orient_exact(c, d, a), orient_exact(c, d, b))
}
