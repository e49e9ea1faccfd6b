//! Every face cut from its middle to the middles of its sides: a quad in four
//! quads, a triangle in three.

use std::collections::BTreeMap;

use geo_types::Coord;

use super::outline::{Outline, Place};
use super::Draft;
use crate::mesh::predicates::orient;

/// `least` is what [`least_corner`] must be after a vertex is moved.
pub(super) fn halve(
    outline: &Outline,
    inside: &[Coord<f64>],
    faces: &[Vec<usize>],
    least: f64,
) -> Draft {
    let mut points: Vec<_> = outline.points.iter().chain(inside).copied().collect();
    let mut on_rim: Vec<Option<Place>> = outline.places.iter().copied().map(Some).collect();
    on_rim.resize(points.len(), None);
    let mut middle: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let mut cut = Vec::with_capacity(4 * faces.len());
    for face in faces {
        let count = face.len();
        let centre = face.iter().fold(Coord::zero(), |sum, &v| sum + points[v]) / count as f64;
        let mut side = Vec::with_capacity(count);
        for k in 0..count {
            let (a, b) = (face[k], face[(k + 1) % count]);
            let known = *middle.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a] + points[b]) / 2.0);
                on_rim.push(None);
                points.len() - 1
            });
            side.push(known);
        }
        points.push(centre);
        on_rim.push(None);
        let centre = points.len() - 1;
        for k in 0..count {
            cut.push(vec![
                face[k],
                side[k],
                centre,
                side[(k + count - 1) % count],
            ]);
        }
    }
    let mut draft = Draft {
        points,
        faces: cut,
        on_rim,
    };
    follow(&mut draft, outline, &middle, least);
    draft
}

/// Moves the middles of sides on the boundary onto it, where that leaves all
/// quads convex enough.
fn follow(
    draft: &mut Draft,
    outline: &Outline,
    middle: &BTreeMap<(usize, usize), usize>,
    least: f64,
) {
    let mut quads_at: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for k in 0..outline.points.len() {
        let next = outline.next(k);
        if let Some(&v) = middle.get(&(k.min(next), k.max(next))) {
            quads_at.insert(v, Vec::new());
        }
    }
    for (q, face) in draft.faces.iter().enumerate() {
        for v in face {
            if let Some(quads) = quads_at.get_mut(v) {
                quads.push(q);
            }
        }
    }
    for k in 0..outline.points.len() {
        let next = outline.next(k);
        let Some(&v) = middle.get(&(k.min(next), k.max(next))) else {
            continue;
        };
        let (place, at) = outline.between(k);
        let before = std::mem::replace(&mut draft.points[v], at);
        if quads_at[&v].iter().all(|&q| least_corner(draft, q) > least) {
            draft.on_rim[v] = Some(place);
        } else {
            // On the chord: stays there.
            draft.points[v] = before;
            draft.on_rim[v] = Some(Place {
                corner: true,
                ..place
            });
        }
    }
}

/// The least area of the triangles at a quad's four corners, twice: positive if
/// it is convex.
pub(super) fn least_corner(draft: &Draft, q: usize) -> f64 {
    let face = &draft.faces[q];
    (0..4)
        .map(|k| {
            let [a, b, c] = [k, k + 1, k + 2].map(|i| draft.points[face[i % 4]]);
            orient(a, b, c)
        })
        .fold(f64::INFINITY, f64::min)
}
