//! First checks of the mesh on small drawings.

use geo_types::{coord, line_string, Coord, LineString};
use network_opt::{End, PlanarMesh, Wire};

fn wire(line: LineString<f64>) -> Wire<u8> {
    Wire {
        line,
        left: 1,
        right: 2,
        priority: 0,
    }
}
fn square(x: f64, y: f64, s: f64) -> LineString<f64> {
    line_string![(x: x, y: y), (x: x + s, y: y), (x: x + s, y: y + s), (x: x, y: y + s), (x: x, y: y)]
}
fn p(x: f64, y: f64) -> Coord<f64> {
    coord! { x: x, y: y }
}

#[test]
fn a_square_with_a_hole_and_a_street_through() {
    let wires = [
        wire(square(0., 0., 100.)),
        wire(square(40., 40., 20.)),
        wire(line_string![(x: -10., y: 50.), (x: 30., y: 50.)]),
    ];
    let mut mesh = PlanarMesh::from_linework(&wires, 0.01).unwrap();
    mesh.validate().unwrap();
    assert_eq!(mesh.faces().count(), 3);
    let site = mesh.face_at(p(10., 10.));
    assert_eq!(mesh.area(site), 9600.0);
    assert_eq!(mesh.loops(site).len(), 2);
    assert_eq!(mesh.polygon(site).unwrap().interiors().len(), 1);
    // From the dead end to the hole: loops join.
    let dead_end = mesh
        .vertices()
        .find(|&v| mesh.point(v) == p(30., 50.))
        .unwrap();
    let (hole, at, _) = mesh.nearest_edge(p(39., 50.)).unwrap();
    let split = mesh
        .split_face(
            site,
            &[p(35., 52.)],
            End::Vertex(dead_end),
            End::Edge(hole, at),
            3,
            4,
        )
        .unwrap();
    mesh.validate().unwrap();
    assert_eq!(split.faces, vec![site]);
    assert_eq!(mesh.polygon(site).unwrap().interiors().len(), 1);
    // Across the rest: two faces.
    let (e, at, _) = mesh.nearest_edge(p(61., 50.)).unwrap();
    let (e2, at2, _) = mesh.nearest_edge(p(99., 50.)).unwrap();
    let split = mesh
        .split_face(site, &[], End::Edge(e, at), End::Edge(e2, at2), 3, 4)
        .unwrap();
    mesh.validate().unwrap();
    assert_eq!(split.faces.len(), 2);
    assert_eq!(split.faces[0], site);
    let (l, r) = (mesh.area(split.faces[0]), mesh.area(split.faces[1]));
    assert!((l + r - 9600.0).abs() < 1e-9);
    assert_eq!(mesh.attr(split.path[0]), &3);
    // And back.
    mesh.remove_edge(split.path[0]).unwrap();
    mesh.validate().unwrap();
    assert!((mesh.area(site) - 9600.0).abs() < 1e-9);
}
