//! Random problems of streets, some with rooms, small enough to be tried out.

use network_opt::design::{
    EdgeState, Pattern, PatternKind, Placement, Problem, Rooms, Route, Tessellation,
};
use network_opt::geo_types::{coord, Coord};
use proptest::prelude::*;

/// A thousand cases at least in long runs.
pub(crate) fn config(cases: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    let cases = if long { cases.max(50) * 20 } else { cases };
    ProptestConfig {
        cases,
        // Problems with many open edges are drawn as well, and passed over.
        max_global_rejects: 50 * cases.max(100),
        ..ProptestConfig::default()
    }
}

/// A grid of quads, some of them cut into two triangles.
pub(crate) fn mesh(columns: usize, rows: usize, cut: &[bool]) -> Tessellation {
    let wide = columns + 1;
    let points: Vec<Coord<f64>> = (0..wide * (rows + 1))
        .map(|k| coord! { x: (k % wide) as f64, y: (k / wide) as f64 })
        .collect();
    let mut faces = Vec::new();
    for k in 0..columns * rows {
        let a = k / columns * wide + k % columns;
        let quad = [a, a + 1, a + wide + 1, a + wide];
        if cut[k % cut.len()] {
            faces.push(vec![quad[0], quad[1], quad[2]]);
            faces.push(vec![quad[0], quad[2], quad[3]]);
        } else {
            faces.push(quad.to_vec());
        }
    }
    Tessellation::new(points, faces).unwrap()
}

/// A pattern of active edges alone.
pub(crate) fn pattern(kind: PatternKind, active: &[usize], cost: Option<f64>) -> Pattern {
    Pattern {
        kind,
        active: active.to_vec(),
        inactive: Vec::new(),
        cost,
    }
}

/// What random problems are made of.
#[derive(Clone, Debug)]
pub(crate) struct Recipe {
    pub(crate) size: (usize, usize),
    pub(crate) cut: Vec<bool>,
    /// One number each, below 100.
    pub(crate) edges: Vec<u8>,
    pub(crate) vertices: Vec<u8>,
    pub(crate) range: usize,
    pub(crate) unit: bool,
    pub(crate) dead_ends: bool,
    pub(crate) close: u8,
    pub(crate) zig_zags: u8,
    pub(crate) branches: u8,
    pub(crate) weights: (u8, u8),
    pub(crate) route: bool,
    pub(crate) rooms: bool,
}

pub(crate) fn recipe() -> impl Strategy<Value = Recipe> {
    let size = prop_oneof![Just((2, 1)), Just((3, 1)), Just((2, 2)), Just((1, 1))];
    let shape = (
        size,
        prop::collection::vec(prop::bool::weighted(0.15), 4),
        0_usize..3,
    );
    let lists = (
        prop::collection::vec(0_u8..100, 20),
        prop::collection::vec(0_u8..100, 12),
    );
    let local = (any::<bool>(), any::<bool>(), 0_u8..4, 0_u8..4, 0_u8..6);
    let rest = (
        (0_u8..3, 0_u8..3),
        prop::bool::weighted(0.3),
        prop::bool::weighted(0.25),
    );
    (shape, lists, local, rest).prop_map(|(shape, lists, local, rest)| Recipe {
        size: shape.0,
        cut: shape.1,
        range: shape.2,
        edges: lists.0,
        vertices: lists.1,
        unit: local.0,
        dead_ends: local.1,
        close: local.2,
        zig_zags: local.3,
        branches: local.4,
        weights: rest.0,
        route: rest.1,
        rooms: rest.2,
    })
}

impl Recipe {
    pub(crate) fn mesh(&self) -> Tessellation {
        mesh(self.size.0, self.size.1, &self.cut)
    }

    pub(crate) fn problem(&self) -> Problem {
        let mesh = self.mesh();
        let (edges, vertices) = (mesh.edges().len(), mesh.points().len());
        let draw = |list: &[u8], k: usize| list[k % list.len()];
        let states = (0..edges).map(|e| match draw(&self.edges, e) {
            0..=7 => EdgeState::Given,
            8..=10 => EdgeState::Required,
            11..=16 => EdgeState::Closed,
            _ => EdgeState::Open,
        });
        let lengths = (0..edges).map(|e| match self.unit {
            true => 1.0,
            false => 1.0 + f64::from(draw(&self.edges, e) % 5) / 4.0,
        });
        let drawn = |below: u8, from: u8| {
            let hits = (0..vertices).filter(move |&v| {
                let d = draw(&self.vertices, v);
                d >= from && d < from + below
            });
            hits.collect::<Vec<usize>>()
        };
        let mut sinks = vec![false; vertices];
        drawn(15, 0).into_iter().for_each(|v| sinks[v] = true);
        sinks[usize::from(self.vertices[0]) % vertices] = true;
        let mut patterns = Vec::new();
        let weight = |choice: u8| match choice {
            0 => None,
            1 => Some(Some(2.0)),
            _ => Some(None),
        };
        if let Some(cost) = weight(self.close) {
            let pairs = mesh.opposite_edges();
            patterns.extend(
                pairs
                    .iter()
                    .map(|p| pattern(PatternKind::TooClose, p, cost)),
            );
        }
        if let Some(cost) = weight(self.zig_zags) {
            let triples = mesh.zig_zags();
            patterns.extend(
                triples
                    .iter()
                    .map(|p| pattern(PatternKind::ZigZag, p, cost)),
            );
        }
        for v in (0..vertices).filter(|_| self.branches < 2) {
            let around: Vec<usize> = mesh.around(v).iter().map(|&(e, _)| e).collect();
            let cost = (self.branches == 1).then_some(1.0);
            for skipped in 0..around.len() {
                let mut three = around.clone();
                three.remove(skipped);
                if three.len() == 3 {
                    // Three of four: a T-junction.
                    patterns.push(Pattern {
                        inactive: vec![around[skipped]],
                        ..pattern(PatternKind::TJunction, &three, cost)
                    });
                }
            }
            if around.len() == 3 {
                patterns.push(pattern(PatternKind::Branch, &around, cost));
            }
        }
        let rooms = self.rooms.then(|| rooms(&mesh, &self.vertices));
        let places = if rooms.is_some() { 0 } else { vertices };
        let routes = if self.route {
            // Along the bottom, or along the top.
            let wide = self.size.0;
            let row = |base: usize| -> Vec<usize> {
                let steps = (0..wide).filter_map(|k| mesh.edge_between(base + k, base + k + 1));
                steps.collect()
            };
            vec![Route {
                cost: (self.zig_zags % 2 == 1).then_some(3.0),
                ..vec![row(0), row((wide + 1) * self.size.1)].into()
            }]
        } else {
            Vec::new()
        };
        Problem {
            vertices,
            ends: mesh.edges().to_vec(),
            lengths: lengths.collect(),
            states: states.collect(),
            sinks,
            coverage: (0..places).map(|v| mesh.ball(v, self.range)).collect(),
            required_vertices: drawn(6, 94),
            dead_ends: self.dead_ends,
            patterns,
            routes,
            rooms,
            length_weight: [1.0, 5.0, 1.0][usize::from(self.weights.0)],
            travel_weight: [0.0, 1.0, 0.001][usize::from(self.weights.1)],
            ..Problem::default()
        }
    }
}

/// Rooms of one face, and of two that share an edge.
fn rooms(mesh: &Tessellation, draws: &[u8]) -> Rooms {
    let faces = mesh.faces().len();
    let mut placements: Vec<Placement> = (0..faces)
        .map(|f| Placement {
            template: "one".into(),
            faces: vec![f],
            inner: Vec::new(),
            border: mesh.edges_of(f).to_vec(),
        })
        .collect();
    for e in 0..mesh.edges().len() {
        if let &[f, g] = mesh.faces_of(e) {
            let both = mesh.edges_of(f).iter().chain(mesh.edges_of(g));
            placements.push(Placement {
                template: "two".into(),
                faces: vec![f, g],
                inner: vec![e],
                border: both.copied().filter(|&k| k != e).collect(),
            });
        }
    }
    Rooms {
        placements,
        covered: (0..faces).map(|f| draws[f % draws.len()] >= 10).collect(),
        ..Rooms::default()
    }
}
