//! Short edges of the finished mesh are closed.
//!
//! Dividing lines that come from either side of a spine often end a few
//! centimetres apart. Such edges help nobody and may vanish in rounding later,
//! so their ends become one point wherever no ring suffers.

use super::geom::{area, dist, is_simple, P};
use super::quality::{measure, Scratch};
use super::weld::Mesh;
use super::ParcelOptions;

/// Collapses edges shorter than the snapping distance, where that moves
/// neither the block's outline nor its vertices.
pub(super) fn tidy(mesh: &mut Mesh, options: &ParcelOptions) {
    let limit = options.snap();
    for r in 0..mesh.rings.len() {
        let mut i = 0;
        while i < mesh.rings[r].len() {
            let ring = &mesh.rings[r];
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            let short = dist(mesh.points[a], mesh.points[b]) < limit;
            // Either end may stay; the block's own vertices must.
            let closed = short && (collapse(mesh, b, a, options) || collapse(mesh, a, b, options));
            if !closed {
                i += 1;
            }
        }
    }
}

/// Moves point `w` onto its neighbour `v`, unless that would hurt.
fn collapse(mesh: &mut Mesh, w: usize, v: usize, options: &ParcelOptions) -> bool {
    if w < mesh.own {
        return false;
    }
    let touched: Vec<usize> = (0..mesh.rings.len())
        .filter(|&r| mesh.rings[r].contains(&w))
        .collect();
    // A point of the outline may slide along its own edge of the block only.
    let alone =
        |a: usize, b: usize| mesh.find_edge((a, b)).is_some() != mesh.find_edge((b, a)).is_some();
    let on_outline = touched.iter().any(|&r| {
        let ring = &mesh.rings[r];
        let n = ring.len();
        (0..n).any(|i| {
            ring[i] == w && (alone(ring[i], ring[(i + 1) % n]) || alone(ring[(i + n - 1) % n], w))
        })
    });
    if on_outline && !alone(v, w) {
        return false;
    }
    let mut scratch = Scratch::default();
    let mut changed = Vec::with_capacity(touched.len());
    for &r in &touched {
        let (ring, front) = (&mesh.rings[r], &mesh.front[r]);
        let n = ring.len();
        let moved = |id: usize| if id == w { v } else { id };
        let (mut ids, mut flags) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for i in 0..n {
            // An edge from w to v, or from v to w, has no length any more.
            if moved(ring[i]) != moved(ring[(i + 1) % n]) {
                ids.push(moved(ring[i]));
                flags.push(front[i]);
            }
        }
        let points: Vec<P> = ids.iter().map(|&i| mesh.points[i]).collect();
        if points.len() < 3 || area(&points) <= 0.0 || !is_simple(&points) {
            return false;
        }
        let (was, is) = (
            measure(&mesh.ring(r), &mesh.front[r], &mut scratch),
            measure(&points, &flags, &mut scratch),
        );
        let less = is.frontage < 1.001 * options.min_frontage && was.frontage > is.frontage;
        if less || (is.is_bad() && !was.is_bad()) {
            return false;
        }
        changed.push((r, ids, flags));
    }
    for (r, ids, flags) in changed {
        mesh.rings[r] = ids;
        mesh.front[r] = flags;
    }
    mesh.refresh();
    true
}

#[cfg(test)]
mod tests {
    use super::super::geom::pt;
    use super::super::shape::Shape;
    use super::*;

    #[test]
    fn two_ends_on_a_spine_become_one() {
        // Four lots whose dividing lines miss each other by 10 cm.
        let lot = |p: [(f64, f64); 4]| Shape {
            ring: p.iter().map(|&(x, y)| pt(x, y)).collect(),
            front: vec![true, false, false, false],
        };
        let block = lot([(0., 0.), (36., 0.), (36., 60.), (0., 60.)]);
        let parts = [
            lot([(0., 0.), (18., 0.), (18., 30.), (0., 30.)]),
            lot([(18., 0.), (36., 0.), (36., 30.), (18., 30.)]),
            lot([(36., 60.), (18.1, 60.), (18.1, 30.), (36., 30.)]),
            lot([(18.1, 60.), (0., 60.), (0., 30.), (18.1, 30.)]),
        ];
        let options = ParcelOptions::default();
        let mut mesh = Mesh::new(&block, &parts, &options);
        assert_eq!(mesh.rings[0].len() + mesh.rings[1].len(), 9);
        tidy(&mut mesh, &options);
        assert!(mesh.rings.iter().all(|r| r.len() == 4), "{:?}", mesh.rings);
        assert!(mesh.holds(&block));
    }
}
