//! The streets of a finished plan, built into a mesh again by another crate: two
//! independent counts of the same network must agree.

use network_opt::{PlanarMesh, Wire};
use urban_layout::layout::Layout;
use urban_layout_tests::{Shipped, SITES};

use crate::plan;

/// Nearer than this two points are one, metres: far below the 3 m that any
/// frontage takes, far above the rounding of coordinates.
const SNAP: f64 = 0.01;

fn mesh_of(layout: &Layout) -> PlanarMesh<()> {
    let wires: Vec<Wire<()>> = layout
        .streets
        .iter()
        .map(|street| Wire {
            line: street.line.clone(),
            left: (),
            right: (),
            priority: 0,
        })
        .collect();
    PlanarMesh::from_linework(&wires, SNAP).expect("streets make a mesh")
}

fn streets_make_a_sound_mesh(shipped: Shipped) {
    let layout = &plan(shipped).layout;
    let mesh = mesh_of(layout);
    mesh.validate().expect(shipped.name);

    // The arrangement would make a vertex of each crossing that the layout does
    // not know; so vertices of any degree but two are junctions, and the other
    // way round.
    let mut of_mesh: Vec<usize> = mesh
        .vertices()
        .map(|v| mesh.degree(v))
        .filter(|&degree| degree != 2)
        .collect();
    let mut of_layout: Vec<usize> = layout
        .junctions
        .iter()
        .map(|junction| junction.degree)
        .filter(|&degree| degree != 2)
        .collect();
    of_mesh.sort_unstable();
    of_layout.sort_unstable();
    assert_eq!(of_mesh, of_layout, "{}: degrees", shipped.name);
}

#[test]
fn streets_of_every_site_make_a_sound_mesh() {
    for shipped in SITES {
        streets_make_a_sound_mesh(shipped);
    }
}
