//! Ground as triangles, and volumes drawn up from their footprints.

use std::collections::{BTreeMap, VecDeque};

use geo_types::Coord;
use spade::handles::{FixedDirectedEdgeHandle, FixedFaceHandle, PossiblyOuterTag};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::solid::{Paint, Point, Solid};
use super::PLAIN;
use crate::library;
use crate::plane::{sides, Area};
use crate::scene::Scene;

/// Coordinates nearer to nothing than this, metres, are nothing: the
/// triangulation takes none that are smaller.
const NOTHING: f64 = 1e-12;

/// All pieces of ground, those of one material painted alike.
pub(super) fn ground(scene: &Scene, origin: Coord<f64>) -> Solid {
    let mut solid = Solid::default();
    for piece in &scene.pieces {
        let known = library::material_named(&piece.material);
        let paint = Paint {
            name: known.map(|m| m.name),
            ..Paint::plain(known.map_or("#d8d4c8", |m| m.colour))
        };
        let area = Area::from_polygon(&piece.polygon);
        for triangle in triangles(&area, origin) {
            solid.triangle(&paint, triangle.map(|c| place(c, origin, 0.0)));
        }
    }
    solid
}

/// All hedges and walls.
pub(super) fn volumes(scene: &Scene, origin: Coord<f64>) -> Solid {
    let mut solid = Solid::default();
    for volume in &scene.volumes {
        let barrier = library::barrier_named(&volume.name).map(|b| b.colour);
        let colour = barrier.or_else(|| library::thing_named(&volume.name).map(|t| t.colour));
        let paint = Paint::plain(colour.unwrap_or(PLAIN));
        let area = Area::from_polygon(&volume.polygon);
        for triangle in triangles(&area, origin) {
            solid.triangle(&paint, triangle.map(|c| place(c, origin, volume.height)));
        }
        for (a, b) in area.rings().flat_map(|ring| sides(ring)) {
            // The land lies on the right: the wall is seen from the left.
            let at = |c, h| place(c, origin, h);
            let high = volume.height;
            solid.quad(&paint, [at(b, 0.0), at(a, 0.0), at(a, high), at(b, high)]);
        }
    }
    solid
}

/// A point of the plan at a height: y up, z to the south.
fn place(c: Coord<f64>, origin: Coord<f64>, height: f64) -> Point {
    [c.x - origin.x, height, origin.y - c.y]
}

/// Triangles that tile an area, counter-clockwise, without further corners: its
/// constrained Delaunay triangulation, less what lies outside and in holes.
pub(super) fn triangles(area: &Area, origin: Coord<f64>) -> Vec<[Coord<f64>; 3]> {
    let mut numbers: BTreeMap<[u64; 2], usize> = BTreeMap::new();
    let mut points: Vec<Point2<f64>> = Vec::new();
    let mut number = |c: Coord<f64>| {
        let near = |x: f64| if x.abs() < NOTHING { 0.0 } else { x };
        let (x, y) = (near(c.x - origin.x), near(c.y - origin.y));
        let next = points.len();
        let known = *numbers.entry([x.to_bits(), y.to_bits()]).or_insert(next);
        if known == next {
            points.push(Point2::new(x, y));
        }
        known
    };
    let edges: Vec<[usize; 2]> = area
        .rings()
        .flat_map(|ring| sides(ring))
        .map(|(a, b)| [number(a), number(b)])
        .filter(|[a, b]| a != b)
        .collect();
    // Rings that cross each other are no area: their crossing edges are left out.
    let found =
        ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(points, edges, |_| {});
    let Ok(found) = found else {
        return Vec::new();
    };
    // From outside inwards: each constraint leads in or out.
    let mut inside: BTreeMap<usize, bool> = BTreeMap::new();
    let mut waiting: VecDeque<(FixedFaceHandle<PossiblyOuterTag>, bool)> = VecDeque::new();
    waiting.push_back((found.outer_face().fix(), false));
    inside.insert(found.outer_face().fix().index(), false);
    while let Some((face, within)) = waiting.pop_front() {
        let edges: Vec<FixedDirectedEdgeHandle> = match found.face(face).as_inner() {
            Some(inner) => inner.adjacent_edges().map(|e| e.fix()).to_vec(),
            None => found.convex_hull().map(|e| e.fix()).collect(),
        };
        for edge in edges {
            let edge = found.directed_edge(edge);
            let across = edge.rev().face().fix();
            let across = if across == face {
                edge.face().fix()
            } else {
                across
            };
            let within = within != found.is_constraint_edge(edge.as_undirected().fix());
            if let std::collections::btree_map::Entry::Vacant(entry) = inside.entry(across.index())
            {
                entry.insert(within);
                waiting.push_back((across, within));
            }
        }
    }
    found
        .inner_faces()
        .filter(|face| inside.get(&face.fix().index()) == Some(&true))
        .map(|face| {
            face.positions().map(|p| Coord {
                x: p.x + origin.x,
                y: p.y + origin.y,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn ring(points: &[(f64, f64)]) -> Vec<Coord<f64>> {
        points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect()
    }

    fn size(triangles: &[[Coord<f64>; 3]]) -> f64 {
        triangles
            .iter()
            .map(|[a, b, c]| 0.5 * crate::plane::cross(*b - *a, *c - *a))
            .sum()
    }

    #[test]
    fn holes_and_bays_are_left_out() {
        let outer = ring(&[
            (0., 0.),
            (9., 0.),
            (9., 9.),
            (5., 9.),
            (5., 5.),
            (4., 9.),
            (0., 9.),
        ]);
        let hole = ring(&[(1., 1.), (3., 1.), (3., 3.), (1., 3.)]);
        // A hole that touches the other in a point.
        let other = ring(&[(3., 3.), (4., 3.), (4., 4.)]);
        let area = Area::new(outer, vec![hole, other]);
        let found = triangles(&area, coord! { x: 4., y: 4. });
        assert!((size(&found) - area.size()).abs() < 1e-12);
        assert!(found.iter().all(|t| size(&[*t]) > 0.0), "counter-clockwise");
        for [a, b, c] in found {
            assert!(area.contains((a + b + c) / 3.0));
        }
    }
}
