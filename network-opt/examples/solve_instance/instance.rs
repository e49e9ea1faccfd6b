//! The files of instances: one mesh, what is asked of it, and the best value
//! that is known.

use network_opt::design::{
    EdgeState, Pattern, PatternKind, Placement, Problem, Rooms, Tessellation,
};
use network_opt::geo_types::{coord, Coord};
use serde::Deserialize;

#[derive(Deserialize)]
pub(crate) struct Instance {
    vertices: Vec<[f64; 2]>,
    faces: Vec<Vec<usize>>,
    edges: Vec<[usize; 2]>,
    sinks: Vec<usize>,
    coverage_hops: usize,
    deadends: Allowance,
    unit_lengths: bool,
    /// Length, travel, zig-zag; no number forbids.
    lambda: [Option<f64>; 3],
    forbidden_patterns: Patterns,
    #[serde(default)]
    rooms: Vec<Room>,
    #[serde(default)]
    obstacle_faces: Vec<usize>,
    #[serde(default)]
    inactive_edges: Vec<usize>,
    #[serde(default)]
    must_active_vertices: Vec<usize>,
}

#[derive(Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
enum Allowance {
    Allow,
    Forbid,
}

#[derive(Deserialize)]
struct Patterns {
    too_close_pairs: Vec<[usize; 2]>,
    zigzag_triples: Vec<[usize; 3]>,
    given_edges: Vec<usize>,
    removed_edges: Vec<usize>,
}

#[derive(Deserialize)]
struct Room {
    #[serde(rename = "type")]
    template: String,
    faces: Vec<usize>,
    inner: Vec<usize>,
    border: Vec<usize>,
}

impl Instance {
    pub(crate) fn problem(self) -> Result<Problem, Box<dyn std::error::Error>> {
        let points: Vec<Coord<f64>> = self
            .vertices
            .iter()
            .map(|&[x, y]| coord! { x: x, y: y })
            .collect();
        let mesh = Tessellation::with_edges(points, self.faces, self.edges)?;
        let edges = mesh.edges().len();
        let mut states = vec![EdgeState::Open; edges];
        let marked = [
            (&self.forbidden_patterns.given_edges, EdgeState::Given),
            (&self.forbidden_patterns.removed_edges, EdgeState::Closed),
            (&self.inactive_edges, EdgeState::Closed),
        ];
        for (list, state) in marked {
            for &e in list {
                *states
                    .get_mut(e)
                    .ok_or("an edge that does not exist is named")? = state;
            }
        }
        let mean = (0..edges).map(|e| mesh.length(e)).sum::<f64>() / edges as f64;
        let lengths = (0..edges).map(|e| {
            if self.unit_lengths {
                1.0
            } else {
                // As the best known values were measured.
                (mesh.length(e) / mean * 1000.0).round() / 1000.0
            }
        });
        let mut sinks = vec![false; mesh.points().len()];
        for &v in &self.sinks {
            *sinks
                .get_mut(v)
                .ok_or("a sink that does not exist is named")? = true;
        }
        let rooms = (!self.rooms.is_empty()).then(|| Rooms {
            covered: (0..mesh.faces().len())
                .map(|f| !self.obstacle_faces.contains(&f))
                .collect(),
            placements: self
                .rooms
                .into_iter()
                .map(|room| Placement {
                    template: room.template,
                    faces: room.faces,
                    inner: room.inner,
                    border: room.border,
                })
                .collect(),
        });
        let coverage = if rooms.is_none() {
            let balls = (0..mesh.points().len()).map(|v| mesh.ball(v, self.coverage_hops));
            balls.collect()
        } else {
            Vec::new()
        };
        let [length, travel, zig_zag] = self.lambda;
        let mut patterns: Vec<Pattern> = Vec::new();
        let mut add = |kind, mut active: Vec<usize>, cost: Option<f64>| {
            active.sort_unstable();
            // Listed once for each half-edge that sees it, and paid as often.
            match patterns
                .iter_mut()
                .find(|p| p.kind == kind && p.active == active)
            {
                Some(known) => {
                    if let (Some(sum), Some(cost)) = (&mut known.cost, cost) {
                        *sum += cost;
                    }
                }
                None => patterns.push(Pattern {
                    kind,
                    active,
                    inactive: Vec::new(),
                    cost,
                }),
            }
        };
        for pair in &self.forbidden_patterns.too_close_pairs {
            add(PatternKind::TooClose, pair.to_vec(), None);
        }
        for triple in &self.forbidden_patterns.zigzag_triples {
            add(PatternKind::ZigZag, triple.to_vec(), zig_zag);
        }
        let problem = Problem {
            vertices: mesh.points().len(),
            ends: mesh.edges().to_vec(),
            lengths: lengths.collect(),
            states,
            sinks,
            coverage,
            required_vertices: self.must_active_vertices,
            dead_ends: self.deadends == Allowance::Allow,
            patterns,
            routes: Vec::new(),
            rooms,
            length_weight: length.unwrap_or(0.0),
            travel_weight: travel.unwrap_or(0.0),
            ..Problem::default()
        };
        problem.check()?;
        Ok(problem)
    }
}
