//! All valid networks of a small problem of two-way streets, by trying every
//! set of edges, every tiling with rooms and every choice of sinks.

use network_opt::design::{verify, EdgeState, Network, Problem};
use proptest::prelude::*;

/// All ways to cover the faces; one empty way without rooms.
fn tilings(problem: &Problem) -> Vec<Vec<usize>> {
    let Some(rooms) = &problem.rooms else {
        return vec![Vec::new()];
    };
    let mut found = Vec::new();
    let mut open = vec![(Vec::new(), vec![false; rooms.covered.len()])];
    while let Some((placed, full)) = open.pop() {
        let next = (0..full.len()).find(|&f| rooms.covered[f] && !full[f]);
        let Some(next) = next else {
            let mut placed: Vec<usize> = placed;
            placed.sort_unstable();
            found.push(placed);
            continue;
        };
        for (k, placement) in rooms.placements.iter().enumerate() {
            let fits = placement.faces.contains(&next)
                && placement
                    .faces
                    .iter()
                    .all(|&f| rooms.covered[f] && !full[f]);
            if fits {
                let (mut placed, mut full) = (placed.clone(), full.clone());
                placed.push(k);
                placement.faces.iter().for_each(|&f| full[f] = true);
                open.push((placed, full));
            }
        }
    }
    found
}

/// All choices of sinks: one empty choice if none is to be placed.
pub(crate) fn choices(problem: &Problem) -> Vec<Vec<usize>> {
    let Some(placed) = &problem.placed else {
        return vec![Vec::new()];
    };
    let all = 0_u32..1 << placed.candidates.len();
    let chosen = all.filter(|set| set.count_ones() as usize == placed.count);
    let choice = chosen.map(|set| {
        let all = placed.candidates.iter().enumerate();
        let mut chosen: Vec<usize> = all
            .filter(|(k, _)| set >> k & 1 == 1)
            .map(|(_, &v)| v)
            .collect();
        chosen.sort_unstable();
        chosen
    });
    choice.collect()
}

/// All valid networks.
pub(crate) fn all_valid(problem: &Problem) -> Vec<Network> {
    let open: Vec<usize> = (0..problem.edges())
        .filter(|&e| problem.states[e] == EdgeState::Open)
        .collect();
    let choices: Vec<(Vec<usize>, Vec<usize>)> = (tilings(problem).into_iter())
        .flat_map(|rooms| (choices(problem).into_iter()).map(move |sinks| (rooms.clone(), sinks)))
        .collect();
    let mut found = Vec::new();
    for set in 0_u32..1 << open.len() {
        let mut active: Vec<bool> = (problem.states.iter())
            .map(|s| matches!(s, EdgeState::Given | EdgeState::Required))
            .collect();
        for (k, &e) in open.iter().enumerate() {
            active[e] = set >> k & 1 == 1;
        }
        for (rooms, sinks) in &choices {
            let network = Network {
                active: active.clone(),
                rooms: rooms.clone(),
                sinks: sinks.clone(),
                ..Network::default()
            };
            if verify(problem, &network).is_empty() {
                found.push(network);
            }
        }
    }
    found
}

/// How many edges there are to be tried.
pub(crate) fn open_edges(problem: &Problem) -> usize {
    let open = problem.states.iter().filter(|s| **s == EdgeState::Open);
    open.count()
}

/// Other numbers for `count` things: all of them, shuffled.
pub(crate) fn other_numbers(count: usize) -> impl Strategy<Value = Vec<usize>> {
    Just((0..count).collect::<Vec<_>>()).prop_shuffle()
}

/// The same problem with other numbers: vertex v becomes `vertices[v]`, edge e
/// `edges[e]`.
pub(crate) fn renamed(problem: &Problem, vertices: &[usize], edges: &[usize]) -> Problem {
    let mut other = problem.clone();
    let rename = |list: &mut Vec<usize>, to: &[usize]| list.iter_mut().for_each(|k| *k = to[*k]);
    for (e, &to) in edges.iter().enumerate() {
        other.ends[to] = problem.ends[e].map(|v| vertices[v]);
        other.lengths[to] = problem.lengths[e];
        other.states[to] = problem.states[e];
    }
    for (v, &to) in vertices.iter().enumerate() {
        other.sinks[to] = problem.sinks[v];
    }
    other
        .coverage
        .iter_mut()
        .for_each(|ball| rename(ball, vertices));
    rename(&mut other.required_vertices, vertices);
    for p in &mut other.patterns {
        rename(&mut p.active, edges);
        rename(&mut p.inactive, edges);
    }
    let paths = other.routes.iter_mut().flat_map(|r| &mut r.paths);
    paths.for_each(|path| rename(path, edges));
    for room in other.rooms.iter_mut().flat_map(|r| &mut r.placements) {
        rename(&mut room.inner, edges);
        rename(&mut room.border, edges);
    }
    if let Some(placed) = &mut other.placed {
        rename(&mut placed.candidates, vertices);
    }
    other
}
