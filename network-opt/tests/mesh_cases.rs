//! The mesh in single cases: known counts, refusals, stale ids.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use geo_types::{coord, Coord, LineString};
use network_opt::{End, FaceId, HalfEdgeId, MeshError, PlanarMesh, VertexId, Wire};

fn p(x: f64, y: f64) -> Coord<f64> {
    coord! { x: x, y: y }
}

fn wire(points: Vec<Coord<f64>>) -> Wire<u32> {
    Wire {
        line: LineString(points),
        left: 1,
        right: 2,
        priority: 0,
    }
}

/// A 4 by 3 grid of unit squares, scaled, with an island and a dead end.
fn start(scale: f64, at: Coord<f64>) -> PlanarMesh<u32> {
    let q = |x: f64, y: f64| p(at.x + scale * x, at.y + scale * y);
    let mut wires: Vec<Wire<u32>> = Vec::new();
    for i in 0..=4 {
        wires.push(wire(vec![q(f64::from(i), 0.0), q(f64::from(i), 3.0)]));
    }
    for j in 0..=3 {
        wires.push(wire(vec![q(0.0, f64::from(j)), q(4.0, f64::from(j))]));
    }
    let island = [(1.3, 1.3), (1.7, 1.35), (1.6, 1.7), (1.25, 1.6), (1.3, 1.3)];
    wires.push(wire(island.iter().map(|&(x, y)| q(x, y)).collect()));
    wires.push(wire(vec![q(2.0, 1.0), q(2.3, 1.4), q(2.6, 1.4)]));
    PlanarMesh::from_linework(&wires, 0.0).unwrap()
}

#[test]
fn a_grid_has_the_faces_it_should() {
    for (nx, ny) in [(1, 1), (7, 5), (40, 30)] {
        let (w, h) = (f64::from(nx), f64::from(ny));
        let mut wires = Vec::new();
        for i in 0..=nx {
            wires.push(wire(vec![p(f64::from(i), -0.5), p(f64::from(i), h + 0.5)]));
        }
        for j in 0..=ny {
            wires.push(wire(vec![p(-0.5, f64::from(j)), p(w + 0.5, f64::from(j))]));
        }
        let mesh = PlanarMesh::from_linework(&wires, 0.01).unwrap();
        let stubs = 2 * (nx + 1) + 2 * (ny + 1);
        assert_eq!(mesh.faces().count() as i32, nx * ny + 1);
        assert_eq!(mesh.vertices().count() as i32, (nx + 1) * (ny + 1) + stubs);
        assert!(mesh
            .bounded_faces()
            .all(|f| (mesh.area(f) - 1.0).abs() < 1e-12));
        assert_eq!(mesh.validate(), Ok(()));
    }
}

#[test]
fn overlaps_take_the_attributes_of_the_higher_priority() {
    let road = Wire {
        left: 10,
        right: 20,
        priority: 1,
        ..wire(vec![p(8., 0.), p(2., 0.)])
    };
    let rim = wire(vec![
        p(0., 0.),
        p(10., 0.),
        p(10., 10.),
        p(0., 10.),
        p(0., 0.),
    ]);
    let mesh = PlanarMesh::from_linework(&[rim, road], 0.01).unwrap();
    let attr = |x: f64| {
        let h = mesh.nearest_edge(p(x, 0.5)).unwrap().0;
        (*mesh.attr(h), *mesh.attr(h.twin()))
    };
    assert_eq!(attr(1.0), (1, 2));
    // The road runs west: the site is on its right.
    assert_eq!(attr(5.0), (20, 10));
    assert_eq!(attr(9.0), (1, 2));
    assert_eq!(mesh.edges().count(), 6);
}

#[test]
fn bad_linework_is_refused_with_its_place() {
    let line = |q: Vec<Coord<f64>>| {
        PlanarMesh::from_linework(&[wire(vec![p(0., 0.), p(1., 0.)]), wire(q)], 0.1)
    };
    assert!(matches!(
        line(vec![p(0., 0.), p(f64::NAN, 1.)]),
        Err(MeshError::NonFinite { wire: 1, index: 1 })
    ));
    assert!(matches!(
        line(vec![p(f64::INFINITY, 1.)]),
        Err(MeshError::NonFinite { wire: 1, index: 0 })
    ));
    let none: [Wire<u32>; 0] = [];
    assert!(matches!(
        PlanarMesh::from_linework(&none, 0.1),
        Err(MeshError::Empty { .. })
    ));
    let dot = [wire(vec![p(3., 3.), p(3.01, 3.)])];
    assert!(matches!(
        PlanarMesh::from_linework(&dot, 0.1),
        Err(MeshError::Empty { .. })
    ));
    let dot = [wire(vec![p(0., 0.), p(0., 0.)])];
    assert!(matches!(
        PlanarMesh::from_linework(&dot, 0.0),
        Err(MeshError::Empty { .. })
    ));
    for snap in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            PlanarMesh::from_linework(&dot, snap),
            Err(MeshError::BadSnap { .. })
        ));
    }
}

#[test]
fn stale_and_foreign_ids_do_no_harm() {
    let mut mesh = start(1.0, p(0., 0.));
    let h = mesh.half_edges().next().unwrap();
    let v = mesh.origin(h);
    mesh.remove_edge(h).unwrap();
    for h in [h, h.twin(), HalfEdgeId(9999), HalfEdgeId::NONE] {
        assert!(!mesh.has_half_edge(h));
        assert_eq!(mesh.walk(h).count(), 0);
        assert_eq!(mesh.split_edge(h, p(0., 0.)), Err(MeshError::NoHalfEdge(h)));
        assert_eq!(mesh.remove_edge(h), Err(MeshError::NoHalfEdge(h)));
        assert_eq!(
            mesh.collapse_edge(h, p(0., 0.)),
            Err(MeshError::NoHalfEdge(h))
        );
        assert_eq!(mesh.get_attr(h), None);
        let f = mesh.bounded_faces().next().unwrap();
        let end = End::Edge(h, p(0., 0.));
        let got = mesh.split_face(f, &[], end, End::Vertex(v), 0, 0);
        assert_eq!(got, Err(MeshError::NoHalfEdge(h)));
        let _ = (
            mesh.next(h),
            mesh.prev(h),
            mesh.face(h),
            mesh.dest(h),
            mesh.twin(h),
            mesh.length(h),
        );
    }
    for v in [VertexId(9999), VertexId::NONE] {
        assert!(mesh.point(v).x.is_nan());
        assert_eq!((mesh.degree(v), mesh.outgoing(v).count()), (0, 0));
        assert_eq!(
            mesh.remove_vertex_of_degree_2(v),
            Err(MeshError::NoVertex(v))
        );
        assert!(!mesh.set_point(v, p(0., 0.)));
        assert_eq!(mesh.find_edge(v, v), None);
    }
    for f in [FaceId(9999), FaceId::NONE] {
        assert_eq!(mesh.area(f), 0.0);
        assert!(mesh.loops(f).is_empty() && mesh.polygon(f).is_none() && !mesh.face_is_sound(f));
        let end = End::Vertex(VertexId(0));
        assert_eq!(
            mesh.split_face(f, &[], end, end, 0, 0),
            Err(MeshError::NoFace(f))
        );
    }
    assert_eq!(mesh.validate(), Ok(()));
}

#[test]
fn a_broken_mesh_is_found_out() {
    let sound = start(100.0, p(0., 0.));
    let inner = sound
        .vertices()
        .find(|&v| sound.point(v) == p(100., 200.))
        .unwrap();
    for at in [
        p(100., 100.),
        p(290., 290.),
        p(100., 300.),
        p(-1., 250.),
        p(140., 150.),
    ] {
        let mut mesh = sound.clone();
        assert!(mesh.set_point(inner, at));
        assert!(mesh.validate().is_err(), "{at:?}");
    }
    let mut mesh = sound.clone();
    assert!(!mesh.set_point(inner, p(f64::NAN, 0.)));
    assert_eq!(mesh.validate(), Ok(()));
    // The island moved into another face, all of it: only nesting is wrong.
    let hole = sound.face_at(p(150., 150.));
    for h in sound.walk(sound.loops(hole)[0]) {
        let v = sound.origin(h);
        let q = sound.point(v);
        mesh.set_point(v, p(q.x + 200.0, q.y - 100.0));
    }
    assert!(mesh.validate().is_err());
}

#[test]
fn a_path_that_leaves_its_face_is_refused() {
    let mut mesh = start(100.0, p(0., 0.));
    let f = mesh.face_at(p(350., 50.));
    let find = |mesh: &PlanarMesh<u32>, x: f64, y: f64| {
        End::Vertex(mesh.vertices().find(|&v| mesh.point(v) == p(x, y)).unwrap())
    };
    let (sw, ne) = (find(&mesh, 300., 0.), find(&mesh, 400., 100.));
    let (se, far) = (find(&mesh, 400., 0.), find(&mesh, 0., 0.));
    let mut split =
        |path: &[Coord<f64>], from, to| mesh.split_face(f, path, from, to, 0, 0).unwrap_err();
    let off = |e: MeshError, at: usize| matches!(e, MeshError::OffFace { end, .. } if end == at);
    assert!(off(split(&[], far, ne), 0) && off(split(&[], sw, far), 1));
    assert!(matches!(
        split(&[p(410., 50.)], sw, ne),
        MeshError::PathMeetsBoundary { segment: 0 | 1, .. }
    ));
    assert!(matches!(
        split(&[p(400., 50.)], sw, ne),
        MeshError::PathMeetsBoundary { .. }
    ));
    // Along an edge that is there, and starting outwards.
    assert!(matches!(
        split(&[], sw, se),
        MeshError::PathMeetsBoundary { .. }
    ));
    assert!(matches!(
        split(&[p(350., -50.)], sw, se),
        MeshError::OffFace { .. }
    ));
    let eight = [p(380., 50.), p(380., 20.), p(320., 60.)];
    assert!(matches!(
        split(&eight, sw, ne),
        MeshError::PathMeetsItself { .. }
    ));
    assert!(matches!(
        split(&[p(350., 20.), p(350., 20.)], sw, ne),
        MeshError::DegeneratePath { segment: 1, .. }
    ));
    assert!(matches!(
        split(&[], sw, sw),
        MeshError::DegeneratePath { .. }
    ));
    assert!(matches!(
        split(&[p(350., f64::NAN)], sw, ne),
        MeshError::NonFinitePoint { .. }
    ));
    let h = mesh.nearest_edge(p(350., 1.)).unwrap().0;
    let high = End::Edge(h, p(350., 3.0));
    assert!(matches!(
        mesh.split_face(f, &[], high, ne, 0, 0),
        Err(MeshError::OffEdge { .. })
    ));
    assert_eq!(mesh.validate(), Ok(()));
}

#[test]
fn a_lollipop_on_the_rim_and_one_around_an_island() {
    let mut mesh = start(100.0, p(0., 0.));
    let f = mesh.face_at(p(350., 50.));
    let corner = End::Vertex(
        mesh.vertices()
            .find(|&v| mesh.point(v) == p(300., 0.))
            .unwrap(),
    );
    let path = [p(350., 20.), p(360., 60.), p(330., 50.)];
    let split = mesh.split_face(f, &path, corner, corner, 0, 0).unwrap();
    assert_eq!(mesh.validate(), Ok(()));
    assert_eq!((split.faces.len(), split.faces[0]), (2, f));
    assert!((mesh.area(f) + mesh.area(split.faces[1]) - 1e4).abs() < 1e-9);
    // Around the island, from its own corner, clockwise: outside is left.
    let around = mesh.face_at(p(190., 190.));
    let area = mesh.area(around);
    let tip = End::Vertex(
        mesh.vertices()
            .find(|&v| mesh.point(v) == p(130., 130.))
            .unwrap(),
    );
    let path = [p(110., 180.), p(190., 180.), p(180., 110.)];
    let split = mesh.split_face(around, &path, tip, tip, 0, 0).unwrap();
    assert_eq!(mesh.validate(), Ok(()));
    assert_eq!(split.faces[0], around);
    assert!((mesh.area(around) + mesh.area(split.faces[1]) - area).abs() < 1e-9);
    assert_eq!(mesh.loops(around).len(), 2);
    // Outside keeps its id on either side.
    for path in [
        [p(-50., -50.), p(-50., 150.)],
        [p(450., 350.), p(450., 150.)],
    ] {
        let from = mesh.nearest_edge(path[0]).unwrap();
        let to = mesh.nearest_edge(path[1]).unwrap();
        let split = mesh
            .split_face(
                mesh.outside(),
                &path,
                End::Edge(from.0, from.1),
                End::Edge(to.0, to.1),
                0,
                0,
            )
            .unwrap();
        assert_eq!(mesh.validate(), Ok(()));
        assert!(split.faces.contains(&mesh.outside()));
    }
}
