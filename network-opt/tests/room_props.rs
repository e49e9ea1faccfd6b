//! Laws of placements: where a room of some shape can be on a mesh.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeSet;

use common::{config, grid};
use network_opt::design::{Placement, Tessellation};
use network_opt::floor::{placements, Shape};
use network_opt::geo_types::polygon;
use network_opt::quad::{quads, QuadOptions};
use proptest::prelude::*;

/// Any shape of up to six squares: each next one beside one that is there.
fn shape() -> impl Strategy<Value = Shape> {
    prop::collection::vec((0..100_usize, 0..4_usize), 0..6).prop_map(|steps| {
        let mut cells = vec![(0, 0)];
        for (from, side) in steps {
            let (x, y) = cells[from % cells.len()];
            let (dx, dy) = [(1, 0), (0, 1), (-1, 0), (0, -1)][side];
            if !cells.contains(&(x + dx, y + dy)) {
                cells.push((x + dx, y + dy));
            }
        }
        Shape::new(&cells).unwrap()
    })
}

/// Where a shape fits on a grid, by shifting its squares.
fn shifted(shape: &Shape, columns: usize, rows: usize, mirrored: bool) -> BTreeSet<Vec<usize>> {
    let mut found = BTreeSet::new();
    let mut turned = shape.clone();
    let mut forms = Vec::new();
    for _ in 0..4 {
        forms.push(turned.clone());
        if mirrored {
            forms.push(turned.mirrored());
        }
        turned = turned.turned();
    }
    for form in forms {
        for y in 0..rows as i32 {
            for x in 0..columns as i32 {
                let cells = form.cells().iter().map(|c| (c.0 + x, c.1 + y));
                let inside = |c: &(i32, i32)| c.0 < columns as i32 && c.1 < rows as i32;
                if cells.clone().all(|c| inside(&c)) {
                    let mut faces: Vec<usize> = cells
                        .map(|c| c.1 as usize * columns + c.0 as usize)
                        .collect();
                    faces.sort_unstable();
                    found.insert(faces);
                }
            }
        }
    }
    found
}

fn faces_of(found: &[Placement]) -> BTreeSet<Vec<usize>> {
    found.iter().map(|p| p.faces.clone()).collect()
}

/// A mesh with irregular vertices: a bent block.
fn bent() -> Tessellation {
    let block = polygon![
        (x: 0., y: 0.), (x: 40., y: 0.), (x: 52., y: 20.), (x: 30., y: 34.), (x: 24., y: 20.), (x: 0., y: 16.),
    ];
    let options = QuadOptions {
        edge_length: 3.0,
        ..QuadOptions::default()
    };
    quads(&block, &options).unwrap()
}

/// The instance `floor16x15` of the benchmark: 511 edges, and squares, boxes and
/// bends of eight squares in 1,329 places.
#[test]
fn the_benchmark_has_as_many_placements() {
    let mesh = grid(16, 15);
    assert_eq!(mesh.edges().len(), 511);
    let count = |text: &str| placements(&mesh, "room", &text.parse().unwrap(), true, true).len();
    assert_eq!(
        [count("##/##"), count("###/###"), count("###/###/##.")],
        [210, 391, 728]
    );
}

proptest! {
    #![proptest_config(config(40))]

    /// On a grid placements are the shifted, turned and mirrored shapes.
    #[test]
    fn on_a_grid_shapes_are_shifted(shape in shape(), columns in 1..6_usize, rows in 1..5_usize, mirrored in any::<bool>()) {
        let mesh = grid(columns, rows);
        let found = placements(&mesh, "room", &shape, mirrored, true);
        let faces = faces_of(&found);
        prop_assert_eq!(faces.len(), found.len(), "each once");
        prop_assert_eq!(faces, shifted(&shape, columns, rows, mirrored));
    }

    /// On any mesh: faces hang together, edges inside have both faces in the
    /// room and those around it one, irregular placements are more and hold an
    /// irregular vertex, and a shape turned or mirrored fits where it does.
    #[test]
    fn rooms_are_what_they_say_on_any_mesh(shape in shape()) {
        let mesh = bent();
        let regular = placements(&mesh, "room", &shape, true, false);
        let all = placements(&mesh, "room", &shape, true, true);
        prop_assert!(faces_of(&regular).is_subset(&faces_of(&all)));
        for turned in [shape.turned(), shape.mirrored()] {
            let same = placements(&mesh, "room", &turned, true, true);
            prop_assert_eq!(faces_of(&same), faces_of(&all));
        }
        for room in &all {
            for (edges, sides) in [(&room.inner, 2), (&room.border, 1)] {
                for &e in edges {
                    let inside = mesh.faces_of(e).iter().filter(|f| room.faces.contains(f));
                    prop_assert_eq!(inside.count(), sides);
                }
            }
            let corners = room.faces.iter().map(|&f| mesh.faces()[f].len()).sum::<usize>();
            prop_assert_eq!(2 * room.inner.len() + room.border.len(), corners);
            let mut seen = vec![room.faces[0]];
            let mut at = 0;
            while at < seen.len() {
                let inside: Vec<usize> = mesh.edges_of(seen[at]).iter().copied().filter(|e| room.inner.contains(e)).collect();
                for e in inside {
                    let faces = mesh.faces_of(e).iter().copied();
                    let next: Vec<usize> = faces.filter(|f| !seen.contains(f)).collect();
                    seen.extend(next);
                }
                at += 1;
            }
            prop_assert_eq!(seen.len(), room.faces.len());
            if !faces_of(&regular).contains(&room.faces) {
                let inner = |v: &&usize| mesh.around(**v).iter().all(|(e, _)| room.inner.contains(e));
                let odd = room.faces.iter().flat_map(|&f| &mesh.faces()[f]).filter(inner)
                    .any(|&v| matches!(mesh.around(v).len(), 3 | 5));
                prop_assert!(odd, "{:?} has no irregular vertex inside", room.faces);
                // One quad less or more for each that the quarter has.
                prop_assert!(room.faces.len() != shape.cells().len());
            }
        }
    }

    /// Vertices numbered otherwise: the same rooms.
    #[test]
    fn numbers_do_not_matter(shape in shape(), shift in 1..60_usize, turn in 0..4_usize) {
        let mesh = bent();
        let n = mesh.points().len();
        let new = |v: usize| (v + shift) % n;
        let mut points = mesh.points().to_vec();
        (0..n).for_each(|v| points[new(v)] = mesh.points()[v]);
        let faces = mesh.faces().iter().map(|face| {
            let mut face: Vec<usize> = face.iter().map(|&v| new(v)).collect();
            face.rotate_left(turn);
            face
        });
        let other = Tessellation::new(points, faces.collect()).unwrap();
        let of = |mesh: &Tessellation| faces_of(&placements(mesh, "room", &shape, true, true));
        prop_assert_eq!(of(&other), of(&mesh));
    }
}
