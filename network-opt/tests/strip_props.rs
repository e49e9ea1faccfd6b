//! Laws of the strip optimisation (NUMERICS, "Strip fitting").

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use geo_types::{coord, Coord, LineString};
use network_opt::{
    optimize, roads, Block, FaceId, Fairness, Freedom, OptimizeError, OptimizeOptions, PlanarMesh,
    Report, StripFit, VertexId, Wire,
};
use proptest::prelude::*;

fn config(cases: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    ProptestConfig::with_cases(if long { cases * 20 } else { cases })
}

fn p(x: f64, y: f64) -> Coord<f64> {
    coord! { x: x, y: y }
}

/// A network of `nx` by `ny` quadrilateral blocks, its crossings where `map`
/// puts the points of a unit grid, each side with `cuts` edges.
struct Network {
    mesh: PlanarMesh<bool>,
    blocks: Vec<Block>,
    roads: Vec<Vec<VertexId>>,
    rim: Vec<bool>,
    corner: Vec<bool>,
}

fn network(nx: usize, ny: usize, cuts: usize, map: &dyn Fn(f64, f64) -> Coord<f64>) -> Network {
    let line = |a: (f64, f64), b: (f64, f64), n: usize| {
        LineString(
            (0..=n)
                .map(|i| {
                    let t = i as f64 / n as f64;
                    map(a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))
                })
                .collect(),
        )
    };
    let (w, h) = (nx as f64, ny as f64);
    let mut wires = Vec::new();
    for i in 0..=nx {
        wires.push(line((i as f64, 0.0), (i as f64, h), ny * cuts));
    }
    for j in 0..=ny {
        wires.push(line((0.0, j as f64), (w, j as f64), nx * cuts));
    }
    let wires: Vec<Wire<bool>> = wires
        .into_iter()
        .map(|line| Wire {
            line,
            left: true,
            right: true,
            priority: 0,
        })
        .collect();
    let mesh = PlanarMesh::from_linework(&wires, 0.0).unwrap();
    mesh.validate().unwrap();
    let find = |i: usize, j: usize| -> VertexId {
        let at = map(i as f64, j as f64);
        mesh.vertices()
            .min_by(|&a, &b| {
                let d = |v| (mesh.point(v).x - at.x).hypot(mesh.point(v).y - at.y);
                d(a).total_cmp(&d(b))
            })
            .unwrap()
    };
    let mut blocks = Vec::new();
    for i in 0..nx {
        for j in 0..ny {
            let ids = [
                find(i, j),
                find(i + 1, j),
                find(i + 1, j + 1),
                find(i, j + 1),
            ];
            let centre = map(i as f64 + 0.5, j as f64 + 0.5);
            blocks.push(Block {
                face: mesh.face_at(centre),
                corners: Some(ids),
            });
        }
    }
    let mut rim = vec![false; mesh.vertex_bound()];
    for l in mesh.loops(mesh.outside()) {
        for h in mesh.walk(l) {
            rim[mesh.origin(h).0 as usize] = true;
        }
    }
    let mut corner = vec![false; mesh.vertex_bound()];
    for (i, j) in [(0, 0), (nx, 0), (0, ny), (nx, ny)] {
        corner[find(i, j).0 as usize] = true;
    }
    let roads = roads(&mesh, |&s| s, 50.0);
    Network {
        mesh,
        blocks,
        roads,
        rim,
        corner,
    }
}

impl Network {
    fn points(&self) -> Vec<Coord<f64>> {
        self.mesh.vertices().map(|v| self.mesh.point(v)).collect()
    }

    /// Rim vertices slide if `slide` (or are fixed), corners are fixed.
    fn run(&mut self, slide: bool, options: &OptimizeOptions) -> Report {
        self.try_run(slide, options).unwrap()
    }

    fn try_run(&mut self, slide: bool, options: &OptimizeOptions) -> Result<Report, OptimizeError> {
        let (rim, corner) = (self.rim.clone(), self.corner.clone());
        let degrees: Vec<usize> = (0..self.mesh.vertex_bound() as u32)
            .map(|i| self.mesh.degree(VertexId(i)))
            .collect();
        let freedom = |v: VertexId| {
            let i = v.0 as usize;
            if !rim[i] {
                Freedom::Free
            } else if slide && !corner[i] && degrees[i] > 2 {
                Freedom::Slide
            } else {
                Freedom::Fixed
            }
        };
        optimize(
            &mut self.mesh,
            &self.blocks,
            &self.roads,
            &freedom,
            &StripFit::new(),
            options,
            &mut |_| true,
        )
    }
}

fn apart(a: &[Coord<f64>], b: &[Coord<f64>]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a.x - b.x).hypot(a.y - b.y))
        .fold(0.0, f64::max)
}

/// Displacements of the grid's inner points, in fractions of the spacing.
fn jitter(n: usize, amount: f64) -> impl Strategy<Value = Vec<(f64, f64)>> {
    prop::collection::vec((-amount..amount, -amount..amount), n)
}

/// A jittered grid map: blocks of 120 m by 60 m, in the interior only.
fn jittered(nx: usize, ny: usize, shift: Vec<(f64, f64)>) -> impl Fn(f64, f64) -> Coord<f64> {
    move |x: f64, y: f64| {
        let at = |i: usize, j: usize| {
            let inner = i > 0 && i < nx && j > 0 && j < ny;
            let (dx, dy) = if inner {
                shift[(i - 1) * (ny - 1) + j - 1]
            } else {
                (0.0, 0.0)
            };
            (i as f64 + dx, j as f64 + dy)
        };
        let (i, j) = (
            (x.floor() as usize).min(nx - 1),
            (y.floor() as usize).min(ny - 1),
        );
        let (s, t) = (x - i as f64, y - j as f64);
        let mix =
            |a: (f64, f64), b: (f64, f64), t: f64| (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
        let low = mix(at(i, j), at(i + 1, j), s);
        let high = mix(at(i, j + 1), at(i + 1, j + 1), s);
        let (x, y) = mix(low, high, t);
        p(120.0 * x, 60.0 * y)
    }
}

#[test]
fn a_straight_grid_stays() {
    for form in [Fairness::SpacingWeighted, Fairness::Plain] {
        let mut net = network(4, 3, 4, &|x, y| p(120.0 * x, 60.0 * y));
        let before = net.points();
        let options = OptimizeOptions {
            fairness_form: form,
            ..Default::default()
        };
        let report = net.run(true, &options);
        assert!(report.before.total() < 1e-15, "{report:?}");
        assert!(apart(&before, &net.points()) < 1e-9);
    }
}

#[test]
fn uneven_spacing_stays_with_weights_and_shifts_without() {
    // Columns of 100, 40 and 160 m.
    let columns = [0.0, 100.0, 140.0, 300.0];
    let map = |x: f64, y: f64| {
        let i = (x.floor() as usize).min(2);
        p(
            columns[i] + (x - i as f64) * (columns[i + 1] - columns[i]),
            60.0 * y,
        )
    };
    let mut net = network(3, 2, 1, &map);
    let before = net.points();
    net.run(false, &OptimizeOptions::default());
    assert!(apart(&before, &net.points()) < 1e-9);
    let mut net = network(3, 2, 1, &map);
    let plain = OptimizeOptions {
        fairness_form: Fairness::Plain,
        ..Default::default()
    };
    net.run(false, &plain);
    assert!(apart(&before, &net.points()) > 5.0);
}

#[test]
fn circular_strips_stay_without_fairness() {
    let map = |x: f64, y: f64| {
        let (r, a) = (220.0 - 40.0 * y, 1.2 * x / 3.0);
        p(r * a.sin(), -r * a.cos())
    };
    let mut net = network(3, 3, 8, &map);
    let before = net.points();
    let options = OptimizeOptions {
        fairness: 0.0,
        ..Default::default()
    };
    net.run(false, &options);
    assert!(
        apart(&before, &net.points()) < 1e-7,
        "{}",
        apart(&before, &net.points())
    );
}

#[test]
fn a_bent_network_gets_straighter() {
    let shift = vec![(0.2, 0.15), (-0.2, 0.1), (0.15, -0.2), (-0.1, -0.1)];
    let mut net = network(3, 3, 3, &jittered(3, 3, shift));
    let report = net.run(true, &OptimizeOptions::default());
    net.mesh.validate().unwrap();
    assert!(
        report.after.total() < 0.5 * report.before.total(),
        "{report:?}"
    );
    assert!(report.steps.iter().all(|s| s.damped == 0));
    assert_eq!(report.factorizations, 1);
}

#[test]
fn a_crossing_at_a_bend_of_the_boundary_stays() {
    // The rim bends at every crossing.
    let map = |x: f64, y: f64| {
        p(
            120.0 * x,
            60.0 * y + if y > 1.5 { 20.0 * x * x } else { 0.0 },
        )
    };
    let mut net = network(3, 2, 1, &map);
    let before = net.points();
    let report = net.run(true, &OptimizeOptions::default());
    assert_eq!(report.fixed_at_bends, 2);
    for (i, (a, b)) in before.iter().zip(net.points()).enumerate() {
        let top = a.y >= 120.0 + 20.0 * (a.x / 120.0).powi(2) - 1e-9;
        assert!(!top || *a == b, "{i}");
    }
}

#[test]
fn sliders_keep_their_distance() {
    // A row so lopsided that its junctions want to slide a long way.
    let shift = vec![(0.45, 0.0), (-0.45, 0.0)];
    for (clearance, margin) in [(0.0, 0.05), (60.0, 0.05), (0.0, 0.45)] {
        let mut net = network(3, 2, 2, &jittered(3, 2, shift.clone()));
        let options = OptimizeOptions {
            clearance,
            margin,
            ..Default::default()
        };
        net.run(true, &options);
        net.mesh.validate().unwrap();
        let mut xs: Vec<f64> = net
            .points()
            .iter()
            .filter(|p| p.y == 0.0)
            .map(|p| p.x)
            .collect();
        xs.sort_by(f64::total_cmp);
        for w in xs.windows(2) {
            assert!(w[1] - w[0] >= clearance.min(60.0) - 1e-9, "{xs:?}");
        }
    }
}

#[test]
fn a_cancelled_run_changes_nothing() {
    let mut net = network(3, 3, 2, &jittered(3, 3, vec![(0.1, 0.2); 4]));
    let before = net.points();
    let rim = net.rim.clone();
    let freedom = |v: VertexId| {
        if rim[v.0 as usize] {
            Freedom::Fixed
        } else {
            Freedom::Free
        }
    };
    let mut calls = 0;
    let got = optimize(
        &mut net.mesh,
        &net.blocks,
        &net.roads,
        &freedom,
        &StripFit::new(),
        &OptimizeOptions::default(),
        &mut |_| {
            calls += 1;
            calls < 4
        },
    );
    assert_eq!(got, Err(OptimizeError::Cancelled));
    assert_eq!(before, net.points());
}

#[test]
fn nonsense_is_refused() {
    let mut net = network(2, 2, 1, &|x, y| p(9.0 * x, 9.0 * y));
    for (name, options) in [
        (
            "shape",
            OptimizeOptions {
                shape: -1.0,
                ..Default::default()
            },
        ),
        (
            "fairness",
            OptimizeOptions {
                fairness: f64::NAN,
                ..Default::default()
            },
        ),
        (
            "closeness",
            OptimizeOptions {
                closeness: f64::INFINITY,
                ..Default::default()
            },
        ),
        (
            "margin",
            OptimizeOptions {
                margin: 0.5,
                ..Default::default()
            },
        ),
        (
            "clearance",
            OptimizeOptions {
                clearance: -0.1,
                ..Default::default()
            },
        ),
        (
            "min_angle_deg",
            OptimizeOptions {
                min_angle_deg: 91.0,
                ..Default::default()
            },
        ),
    ] {
        match net.try_run(false, &options) {
            Err(OptimizeError::BadOption { name: got, .. }) => assert_eq!(got, name),
            other => panic!("{other:?}"),
        }
    }
    let good = net.blocks.clone();
    net.blocks[1].face = FaceId(99);
    let got = net.try_run(false, &OptimizeOptions::default());
    assert!(
        matches!(got, Err(OptimizeError::BadFace { block: 1, .. })),
        "{got:?}"
    );
    net.blocks = good.clone();
    net.blocks[0].corners.as_mut().unwrap().swap(1, 2);
    let got = net.try_run(false, &OptimizeOptions::default());
    assert!(
        matches!(got, Err(OptimizeError::BadCorners { block: 0, .. })),
        "{got:?}"
    );
    net.blocks = good;
    net.roads.push(vec![VertexId(0), VertexId(77)]);
    let got = net.try_run(false, &OptimizeOptions::default());
    assert!(matches!(got, Err(OptimizeError::BadRoad { .. })), "{got:?}");
    net.roads.pop();
    let inner = net
        .mesh
        .vertices()
        .find(|v| !net.rim[v.0 as usize])
        .unwrap();
    assert!(net.mesh.set_point(inner, p(30.0, 4.0)));
    let got = net.try_run(false, &OptimizeOptions::default());
    assert!(matches!(got, Err(OptimizeError::BadMesh(_))), "{got:?}");
}

#[test]
fn without_weights_nothing_can_be_solved() {
    let mut net = network(2, 2, 1, &|x, y| p(9.0 * x, 9.0 * y));
    let none = OptimizeOptions {
        shape: 0.0,
        fairness: 0.0,
        closeness: 0.0,
        ..Default::default()
    };
    assert!(matches!(
        net.try_run(false, &none),
        Err(OptimizeError::Singular { .. })
    ));
}

proptest! {
    #![proptest_config(config(24))]

    /// Energy falls in each solve for the targets held, the result is never
    /// worse than the start, and no face inverts, however wild the start.
    #[test]
    fn energy_falls_and_faces_stay(
        shift in jitter(6, 0.48),
        slide in any::<bool>(),
        weights in (0.1..3.0_f64, 0.0..3.0_f64, 0.01..1.0_f64),
    ) {
        let mut net = network(4, 3, 2, &jittered(4, 3, shift));
        let options = OptimizeOptions {
            shape: weights.0, fairness: weights.1, closeness: weights.2, ..Default::default()
        };
        let faces = net.mesh.faces().count();
        let report = net.run(slide, &options);
        prop_assert!(net.mesh.validate().is_ok());
        prop_assert_eq!(net.mesh.faces().count(), faces);
        for s in &report.steps {
            prop_assert!(s.after <= s.before * (1.0 + 1e-9) + 1e-9, "{:?}", s);
        }
        prop_assert!(report.after.total() <= report.before.total());
        let area: f64 = net.mesh.bounded_faces().map(|f| net.mesh.area(f)).sum();
        prop_assert!((area - 480.0 * 180.0).abs() < 1e-6);
    }

    /// Sliding junctions stay on their straight edge; all else on the rim
    /// stays where it is.
    #[test]
    fn sliding_stays_on_its_edge(shift in jitter(6, 0.3)) {
        let mut net = network(4, 3, 2, &jittered(4, 3, shift));
        let before = net.points();
        net.run(true, &OptimizeOptions::default());
        let mut slid = 0;
        for (v, a) in net.mesh.vertices().collect::<Vec<_>>().into_iter().zip(before) {
            let b = net.mesh.point(v);
            if !net.rim[v.0 as usize] {
                continue;
            }
            if net.mesh.degree(v) == 2 {
                prop_assert_eq!(a, b);
            } else {
                prop_assert!((a.x - b.x).abs() < 1e-9 || (a.y - b.y).abs() < 1e-9);
                slid += usize::from(a != b);
            }
        }
        prop_assert!(slid > 0);
    }

    /// Moving the plane moves the result.
    #[test]
    fn equivariance(
        shift in jitter(4, 0.3),
        angle in -3.2..3.2_f64,
        far in prop_oneof![Just((0.0, 0.0)), Just((5e5, 5e6)), (-1e4..1e4_f64, -1e4..1e4_f64)],
        mirror in any::<bool>(),
    ) {
        let (s, c) = angle.sin_cos();
        let m = if mirror { -1.0 } else { 1.0 };
        let place = |q: Coord<f64>| p(far.0 + c * q.x - m * s * q.y, far.1 + s * q.x + m * c * q.y);
        let map = jittered(3, 3, shift);
        let mut here = network(3, 3, 2, &map);
        let mut there = network(3, 3, 2, &|x, y| place(map(x, y)));
        if mirror {
            for b in &mut there.blocks {
                b.corners.as_mut().unwrap().reverse();
            }
        }
        here.run(true, &OptimizeOptions::default());
        there.run(true, &OptimizeOptions::default());
        let want: Vec<_> = here.points().into_iter().map(place).collect();
        // Ten rounds of solves on coordinates with an ulp of 1e-9.
        prop_assert!(apart(&want, &there.points()) < 1e-5, "{}", apart(&want, &there.points()));
    }
}
