//! Laws of the planar mesh: whatever linework it is built from and whatever
//! is done to it, it stays a proper subdivision of the plane.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use geo_types::{coord, Coord, LineString};
use network_opt::{End, HalfEdgeId, MeshError, PlanarMesh, VertexId, Wire};
use proptest::prelude::*;

fn config(cases: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    ProptestConfig::with_cases(if long { cases * 20 } else { cases })
}

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

fn total_area(mesh: &PlanarMesh<u32>) -> f64 {
    mesh.bounded_faces().map(|f| mesh.area(f)).sum()
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

/// One random operation.
#[derive(Clone, Debug)]
struct Op {
    kind: u8,
    pick: (usize, usize),
    at: (f64, f64),
    path: Vec<(f64, f64)>,
}

fn op() -> impl Strategy<Value = Op> {
    (
        0_u8..10,
        (any::<usize>(), any::<usize>()),
        // Ends and halves of edges are the hard places.
        (
            prop_oneof![Just(0.0), Just(0.5), Just(1.0), 0.0..1.0_f64],
            prop_oneof![Just(0.0), Just(0.5), Just(1.0), 0.0..1.0_f64],
        ),
        prop::collection::vec(
            prop_oneof![
                (0.0..1.0_f64, 0.0..1.0_f64),
                (0_u8..9, 0_u8..9).prop_map(|(x, y)| (f64::from(x) / 8.0, f64::from(y) / 8.0))
            ],
            0..4,
        ),
    )
        .prop_map(|(kind, pick, at, path)| Op {
            kind,
            pick,
            at,
            path,
        })
}

fn on_edge(mesh: &PlanarMesh<u32>, h: HalfEdgeId, t: f64) -> Coord<f64> {
    let (a, b) = (mesh.point(mesh.origin(h)), mesh.point(mesh.dest(h)));
    p(a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t)
}

/// Does one operation; what it returned, and whether areas must add up.
fn run(mesh: &mut PlanarMesh<u32>, op: &Op) -> (Result<(), MeshError>, bool) {
    let sides: Vec<HalfEdgeId> = mesh.half_edges().collect();
    let corners: Vec<VertexId> = mesh.vertices().collect();
    if sides.is_empty() {
        return (Ok(()), true);
    }
    let h = sides[op.pick.0 % sides.len()];
    match op.kind {
        0 | 1 => (
            mesh.split_edge(h, on_edge(mesh, h, op.at.0)).map(|_| ()),
            true,
        ),
        2..=6 => {
            // Within one face, or (rarely sound) anywhere.
            let f = mesh.face(h);
            let around: Vec<HalfEdgeId> = mesh
                .loops(f)
                .into_iter()
                .flat_map(|l| mesh.walk(l))
                .collect();
            let g = around[op.pick.1 % around.len()];
            let from = if [2, 4, 6].contains(&op.kind) {
                End::Vertex(mesh.origin(h))
            } else {
                End::Edge(h, on_edge(mesh, h, op.at.0))
            };
            let to = if op.kind < 4 {
                End::Vertex(mesh.dest(g))
            } else {
                End::Edge(g.twin(), on_edge(mesh, g.twin(), op.at.1))
            };
            // Points in the box of the face.
            let ring = mesh.ring(h);
            let fold = |pick: fn(f64, f64) -> f64, of: fn(&Coord<f64>) -> f64| {
                ring.iter().map(of).reduce(pick).unwrap()
            };
            let (w, e) = (fold(f64::min, |p| p.x), fold(f64::max, |p| p.x));
            let (s, n) = (fold(f64::min, |p| p.y), fold(f64::max, |p| p.y));
            let path: Vec<Coord<f64>> = op
                .path
                .iter()
                .map(|&(x, y)| p(w + (e - w) * x, s + (n - s) * y))
                .collect();
            let bounded = !mesh.is_outside(f);
            (
                mesh.split_face(f, &path, from, to, 7, 8).map(|_| ()),
                bounded,
            )
        }
        7 => {
            // Areas add up unless the unbounded face swallows something.
            let keeps = !mesh.is_outside(mesh.face(h)) && !mesh.is_outside(mesh.face(h.twin()));
            (mesh.remove_edge(h).map(|_| ()), keeps)
        }
        8 => (
            mesh.collapse_edge(h, on_edge(mesh, h, op.at.0)).map(|_| ()),
            false,
        ),
        _ => {
            let v = corners[op.pick.1 % corners.len()];
            (mesh.remove_vertex_of_degree_2(v).map(|_| ()), false)
        }
    }
}

proptest! {
    #![proptest_config(config(96))]

    /// Any sequence of operations keeps the mesh sound after each one, splits
    /// and merges conserve area, and a refused operation changes nothing.
    #[test]
    fn operations_keep_the_mesh_sound(
        ops in prop::collection::vec(op(), 1..40),
        scale in prop_oneof![Just(1.0), Just(1e-3), Just(250.0)],
        far in prop_oneof![Just((0.0, 0.0)), Just((5e5, 5e6))],
    ) {
        let far = if scale < 1.0 { p(0.0, 0.0) } else { p(far.0, far.1) };
        let mut mesh = start(scale, far);
        prop_assert_eq!(mesh.validate(), Ok(()));
        for op in &ops {
            let (area, before) = (total_area(&mesh), format!("{mesh:?}"));
            let (result, conserves) = run(&mut mesh, op);
            prop_assert_eq!(mesh.validate(), Ok(()), "after {:?}: {:?}", op, result);
            if let Err(error) = result {
                prop_assert_eq!(&before, &format!("{mesh:?}"), "refused {:?}: {}", op, error);
            } else if conserves {
                // Cuts move a point by an ulp of its coordinates at most.
                let ulp = f64::EPSILON * (far.x.abs() + far.y.abs() + 10.0 * scale);
                let slack = 16.0 * ulp * 4.0 * scale + 1e-12 * scale * scale;
                prop_assert!((total_area(&mesh) - area).abs() <= slack, "{:?}", op);
            }
        }
    }

    /// The left face keeps its id, the path lies between the two, and
    /// removing the path's edges gives the face back.
    #[test]
    fn a_split_can_be_undone(bulge in -0.4..0.4_f64, from in 0.05..0.95_f64, to in 0.05..0.95_f64) {
        let mut mesh = start(100.0, p(0.0, 0.0));
        let f = mesh.face_at(p(350.0, 50.0));
        let side = |mesh: &PlanarMesh<u32>, at| mesh.nearest_edge(at).unwrap().0;
        let (south, north) = (p(300.0 + 100.0 * from, 0.0), p(300.0 + 100.0 * to, 100.0));
        let (a, b) = (side(&mesh, south), side(&mesh, p(north.x, 99.0)));
        let middle = p(350.0 + 100.0 * bulge, 50.0);
        let split = mesh
            .split_face(f, &[middle], End::Edge(a, south), End::Edge(b, north), 7, 8)
            .unwrap();
        prop_assert_eq!(split.faces[0], f);
        prop_assert_eq!(mesh.point(split.from), south);
        prop_assert_eq!(mesh.point(split.to), north);
        // Walking north, the left is the west.
        let want = 100.0 * (100.0 * from + 100.0 * to) / 4.0 + (50.0 + 100.0 * bulge) * 50.0;
        prop_assert!((mesh.area(f) - want).abs() < 1e-6);
        for &h in &split.path {
            prop_assert_eq!((mesh.face(h), mesh.face(h.twin())), (f, split.faces[1]));
            prop_assert_eq!((*mesh.attr(h), *mesh.attr(h.twin())), (7, 8));
        }
        for &h in &split.path {
            mesh.remove_edge(h).unwrap();
            prop_assert_eq!(mesh.validate(), Ok(()));
        }
        prop_assert!(!mesh.has_face(split.faces[1]));
        prop_assert!((mesh.area(f) - 1e4).abs() < 1e-6);
    }
}

/// Polylines on a small grid, perturbed by nothing, by rounding or a little:
/// full of overlaps, touches, repeated points and near misses.
fn hostile() -> impl Strategy<Value = Vec<Vec<(f64, f64)>>> {
    let coordinate = (
        0_i32..7,
        prop_oneof![
            4 => Just(0.0),
            1 => (-4_i32..5).prop_map(|u| f64::from(u) * f64::EPSILON * 4.0),
            1 => -0.02..0.02_f64
        ],
    )
        .prop_map(|(c, d)| f64::from(c) + d);
    let point = (coordinate.clone(), coordinate);
    prop::collection::vec(prop::collection::vec(point, 1..7), 1..9)
}

fn distance(at: Coord<f64>, a: Coord<f64>, b: Coord<f64>) -> f64 {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let t = (((at.x - a.x) * dx + (at.y - a.y) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    (at.x - a.x - t * dx).hypot(at.y - a.y - t * dy)
}

/// Even-odd, for the oracle.
fn inside(at: Coord<f64>, ring: &LineString<f64>) -> bool {
    ring.lines()
        .filter(|l| (l.start.y > at.y) != (l.end.y > at.y))
        .filter(|l| {
            let t = (at.y - l.start.y) / (l.end.y - l.start.y);
            l.start.x + t * (l.end.x - l.start.x) < at.x
        })
        .count()
        % 2
        == 1
}

proptest! {
    #![proptest_config(config(192))]

    /// Any linework gives a sound mesh, in which no vertex comes near an
    /// edge that it does not end, every bounded face's polygon
    /// has its area and holds its points, and each input point is near the
    /// mesh.
    #[test]
    fn linework_of_any_kind(
        lines in hostile(),
        snap in prop_oneof![Just(0.0), Just(0.01), Just(0.05), Just(0.7)],
        far in prop_oneof![Just((0.0, 0.0)), Just((5e5, 5e6))],
        probes in prop::collection::vec((-0.5..6.5_f64, -0.5..6.5_f64), 12),
    ) {
        let place = |&(x, y): &(f64, f64)| p(far.0 + x, far.1 + y);
        let wires: Vec<Wire<u32>> = lines
            .iter()
            .enumerate()
            .map(|(i, l)| Wire { priority: (i % 3) as u8, ..wire(l.iter().map(place).collect()) })
            .collect();
        let mesh = match PlanarMesh::from_linework(&wires, snap) {
            Ok(mesh) => mesh,
            Err(MeshError::Empty { .. }) => return Ok(()),
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        prop_assert_eq!(mesh.validate(), Ok(()));
        let snap = mesh.snap();
        for v in mesh.vertices() {
            for h in mesh.edges().filter(|&h| mesh.origin(h) != v && mesh.dest(h) != v) {
                let d = distance(mesh.point(v), mesh.point(mesh.origin(h)), mesh.point(mesh.dest(h)));
                // 0.7, halved at most three times.
                prop_assert!(d > 0.0875 * snap * (1.0 - 1e-6), "{d} to {:?}", mesh.point(v));
            }
        }
        // A bounded face's polygon.
        for f in mesh.bounded_faces() {
            let polygon = mesh.polygon(f).unwrap();
            let area = |r: &LineString<f64>| {
                let o = r.0[0];
                r.lines()
                    .map(|l| (l.start.x - o.x) * (l.end.y - o.y) - (l.end.x - o.x) * (l.start.y - o.y))
                    .sum::<f64>()
                    / 2.0
            };
            prop_assert!(area(polygon.exterior()) > 0.0);
            prop_assert!(polygon.interiors().iter().all(|r| area(r) < 0.0));
            let sum = area(polygon.exterior()) + polygon.interiors().iter().map(area).sum::<f64>();
            prop_assert!((sum - mesh.area(f)).abs() < 1e-6);
        }
        // Points away from edges are in the face that `face_at` says.
        let locator = mesh.locator();
        for probe in &probes {
            let at = place(probe);
            let f = mesh.face_at(at);
            prop_assert_eq!(f, locator.face_at(at));
            prop_assert_eq!(mesh.nearest_edge(at), locator.nearest_edge(at));
            let (h, q, d) = mesh.nearest_edge(at).unwrap();
            prop_assert!((at.x - q.x).hypot(at.y - q.y) - d < 1e-9);
            if d > 1e-6 {
                prop_assert_eq!(mesh.face(h), f);
                for g in mesh.bounded_faces() {
                    let polygon = mesh.polygon(g).unwrap();
                    let holds = inside(at, polygon.exterior())
                        && !polygon.interiors().iter().any(|r| inside(at, r));
                    prop_assert_eq!(holds, f == g);
                }
            }
        }
        // With little snapping nothing is lost but wires that fall to a point.
        let extent = |w: &Wire<u32>| {
            let far = |q: &Coord<f64>| (q.x - w.line.0[0].x).hypot(q.y - w.line.0[0].y);
            w.line.0.iter().map(far).fold(0.0, f64::max)
        };
        if snap < 0.02 {
            for q in wires.iter().filter(|w| extent(w) > 0.1).flat_map(|w| &w.line.0) {
                prop_assert!(mesh.nearest_edge(*q).unwrap().2 < 0.1);
            }
        }
    }

    /// A drawing and its copy elsewhere, turned by a right angle (exact), give
    /// meshes of the same shape.
    #[test]
    fn arrangement_is_equivariant(lines in hostile()) {
        let build = |f: &dyn Fn(&(f64, f64)) -> Coord<f64>| {
            let wires: Vec<_> = lines.iter().map(|l| wire(l.iter().map(f).collect())).collect();
            PlanarMesh::from_linework(&wires, 0.05)
        };
        match (build(&|&(x, y)| p(x, y)), build(&|&(x, y)| p(-y, x))) {
            (Ok(a), Ok(b)) => {
                prop_assert_eq!(a.vertices().count(), b.vertices().count());
                prop_assert_eq!(a.edges().count(), b.edges().count());
                prop_assert_eq!(a.faces().count(), b.faces().count());
                prop_assert!((total_area(&a) - total_area(&b)).abs() < 1e-9);
            }
            (a, b) => prop_assert_eq!(a.is_err(), b.is_err()),
        }
    }
}
