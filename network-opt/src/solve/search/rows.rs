//! Inequalities that every valid network keeps: sums of edges that are at
//! least so much.
//!
//! Each is of the form `sum of a_e x_e >= d` with `a_e >= 0`, over edges that
//! are not decided yet. Proofs, for a set R of vertices of which one must be
//! active (a row of the coverage constraint, or a required vertex):
//!
//! - **Leave.** If no vertex of R is a sink or has a given or required edge:
//!   whatever is active in R reaches a sink, which lies outside, so one edge of
//!   those that leave R is active. The same holds for any set U of vertices
//!   that contains R and no sink and no vertex with such an edge, so for the
//!   nested neighbourhoods of R: paths to far sinks cost what they are long.
//! - **Leave twice.** If dead ends are forbidden besides: take the component,
//!   of the active network within U (edges with both ends in U), of an active
//!   vertex of R. If it contains a cycle then it has an edge of K, a set of
//!   edges that meets each cycle within U that contains no forbidden pattern,
//!   and one edge of the component's vertices leaves U, as above. Otherwise it
//!   is a tree: a single vertex, which has two active edges or more, all of
//!   them leaving; or it has two leaves or more, each with an active edge more
//!   than the tree has, which leaves. So `x(leaving) + x(K) >= 2`. With K the
//!   edges outside a spanning forest this holds on any mesh; on a grid where
//!   opposite edges of a quad exclude each other, K is often a single edge.
//! - **Be there.** If R has no given or required edge but maybe sinks: one
//!   vertex of R is active, so one of the edges at vertices of R is, and two if
//!   R has no sink and dead ends are forbidden.
//!
//! For rooms:
//!
//! - **Door.** A face is covered by one of the placements that can; so of the
//!   edges on their borders one is active; and one leaves any set U of vertices
//!   that contains their ends as above.
//! - **Door twice.** If dead ends are forbidden besides, with B the ends of those
//!   borders, none of them a sink or at an edge that is active anyway, and g the
//!   least number of edges of a cycle that may be active: `(g - 1) x(leaving B) +
//!   x(within B) >= 2 g - 1`. The proof is that of cuts (25) in
//!   `formulate/room_balls.rs`.
//! - **Doors.** Each face f is covered by a room of at most m_f faces, so there
//!   are at least `N = sum of 1 / m_f` rooms, each with an active edge on its
//!   border. An edge e is on the border of at most h_e rooms at once: h_e faces
//!   suffice to meet all placements that have it on their border, and no face
//!   is covered twice. So `sum of h_e x_e >= N`, N rounded up.

use super::model::{Fate, Model};
use crate::formulate::least_cycle;

/// An inequality.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    /// Edges with their factors.
    pub(super) terms: Vec<(usize, f64)>,
    pub(super) least: f64,
}

/// How many rings of neighbours are put around a set.
const RINGS: usize = 24;
/// Terms of all rows together from which on no more rings are added.
const TERMS: usize = 2_000_000;
/// Steps of the enumeration of cycles for one set.
const STEPS: usize = 20_000;

/// Finds the inequalities a few at a time, since there are many.
#[derive(Debug)]
pub(super) struct Quarry {
    /// Vertices around which no further ring may be put: what may be a sink, and
    /// those of edges that are active anyway.
    barrier: Vec<bool>,
    /// Rows, then faces, then edges that were dealt with.
    at: usize,
    terms: usize,
    /// Factors of edges that leave, of those within and what they reach at least,
    /// in rows of doors where dead ends are forbidden.
    twice: Option<[f64; 3]>,
    /// The row of all doors, as far as it is known.
    doors: Row,
    pub(super) rows: Vec<Row>,
}

impl Quarry {
    pub(super) fn new(model: &Model<'_>) -> Self {
        let settled = |v: usize| {
            let mut around = model.around.of(v).iter();
            around.any(|&(e, _)| model.fates[e] == Fate::On)
        };
        Self {
            barrier: (0..model.problem.vertices)
                .map(|v| model.may_sink[v] || settled(v))
                .collect(),
            at: 0,
            terms: 0,
            twice: (model.problem.rooms.is_some() && !model.problem.dead_ends).then(|| {
                match least_cycle(model.problem) {
                    Some(g) => [g as f64 - 1.0, 1.0, 2.0 * g as f64 - 1.0],
                    None => [1.0, 0.0, 2.0],
                }
            }),
            doors: Row {
                terms: Vec::new(),
                least: 0.0,
            },
            rows: Vec::new(),
        }
    }

    /// Goes on for one place, face or edge. Says whether there are more.
    pub(super) fn dig(&mut self, model: &Model<'_>) -> bool {
        let places = model.rows.len();
        let faces = model.problem.rooms.as_ref().map_or(0, |r| r.covered.len());
        let edges = if faces > 0 { model.problem.edges() } else { 0 };
        let at = self.at;
        self.at += 1;
        if at < places {
            self.cover(model, model.rows.of(at));
        } else if at < places + faces {
            self.door(model, at - places);
        } else if at < places + faces + edges {
            self.doors(model, at - places - faces);
        } else {
            // Rounded up, but not by what sums of fractions are wrong.
            let mut doors = self.doors.clone();
            doors.least = (doors.least - 1e-9).ceil();
            self.push(doors);
            return false;
        }
        true
    }

    fn push(&mut self, row: Row) {
        // One without edges says that there is no solution; that is not for a
        // bound.
        if row.least > 0.0 && !row.terms.is_empty() {
            self.terms += row.terms.len();
            self.rows.push(row);
        }
    }

    /// The rows of a set of vertices of which one is active. None of them has
    /// an edge that is active anyway, or the model had left the set out.
    fn cover(&mut self, model: &Model<'_>, set: &[usize]) {
        let free = !set.iter().any(|&v| self.barrier[v]);
        let twice = free && !model.problem.dead_ends;
        let here = touching(model, set);
        self.push(even(here, if twice { 2.0 } else { 1.0 }));
        if free {
            self.nested(model, set);
            if twice {
                let mut rows = Vec::new();
                leave_twice(model, set, &mut rows);
                rows.into_iter().for_each(|row| self.push(row));
            }
        }
    }

    /// Leave: for the set and its neighbourhoods, until they meet a barrier.
    fn nested(&mut self, model: &Model<'_>, set: &[usize]) {
        let mut inside = vec![false; model.problem.vertices];
        set.iter().for_each(|&v| inside[v] = true);
        let mut last = set.to_vec();
        for _ in 0..RINGS {
            let mut leaving = Vec::new();
            let mut ring = Vec::new();
            // Whatever leaves the union leaves its last ring.
            for &v in &last {
                for &(e, w) in model.around.of(v) {
                    if model.fates[e] == Fate::Open && !inside[w] {
                        leaving.push(e);
                        ring.push(w);
                    }
                }
            }
            self.push(even(leaving, 1.0));
            let stop = ring.is_empty() || ring.iter().any(|&v| self.barrier[v]);
            if stop || self.terms > TERMS {
                return;
            }
            ring.sort_unstable();
            ring.dedup();
            ring.iter().for_each(|&v| inside[v] = true);
            last = ring;
        }
    }

    /// Door: of the borders of what can cover a face.
    fn door(&mut self, model: &Model<'_>, f: usize) {
        let (Some(rooms), Some(spec)) = (&model.rooms, &model.problem.rooms) else {
            return;
        };
        let usable: Vec<usize> = (rooms.at_face.of(f).iter().copied())
            .filter(|&p| !rooms.barred[p])
            .collect();
        let most = usable.iter().map(|&p| rooms.faces.of(p).len()).max();
        let Some(most) = most.filter(|_| spec.covered[f]) else {
            return;
        };
        self.doors.least += 1.0 / most as f64;
        let mut edges: Vec<usize> = (usable.iter())
            .flat_map(|&p| rooms.borders.of(p))
            .copied()
            .collect();
        edges.sort_unstable();
        edges.dedup();
        if edges.iter().any(|&e| model.fates[e] == Fate::On) {
            return;
        }
        edges.retain(|&e| model.fates[e] == Fate::Open);
        let mut ends: Vec<usize> = edges.iter().flat_map(|&e| model.problem.ends[e]).collect();
        ends.sort_unstable();
        ends.dedup();
        self.push(even(edges, 1.0));
        if !ends.iter().any(|&v| self.barrier[v]) {
            self.nested(model, &ends);
            self.door_twice(model, &ends);
        }
    }

    /// Door twice: for the ends of the borders, ascending.
    fn door_twice(&mut self, model: &Model<'_>, ends: &[usize]) {
        let Some([leaving, within, least]) = self.twice else {
            return;
        };
        let mut terms = Vec::new();
        for &v in ends {
            for &(e, w) in model.around.of(v) {
                let inside = ends.binary_search(&w).is_ok();
                let factor = if inside { within } else { leaving };
                // Within, seen from both ends and counted once.
                if model.fates[e] == Fate::Open && factor > 0.0 && (!inside || v < w) {
                    terms.push((e, factor));
                }
            }
        }
        terms.sort_unstable_by_key(|&(e, _)| e);
        self.push(Row { terms, least });
    }

    /// Doors: what an edge contributes. Faces come first, so that `least` is
    /// the number of rooms when it is reduced by edges that are active anyway;
    /// those serve whole rooms, so rounding up may wait.
    fn doors(&mut self, model: &Model<'_>, e: usize) {
        let count = match model.fates[e] {
            Fate::Off => 0,
            Fate::On | Fate::Open => at_once(model, e),
        };
        if model.fates[e] == Fate::On {
            self.doors.least -= count as f64;
        } else if count > 0 {
            self.doors.terms.push((e, count as f64));
        }
    }
}

fn even(edges: Vec<usize>, least: f64) -> Row {
    Row {
        terms: edges.into_iter().map(|e| (e, 1.0)).collect(),
        least,
    }
}

/// Undecided edges with an end in the set.
fn touching(model: &Model<'_>, set: &[usize]) -> Vec<usize> {
    let mut edges: Vec<usize> = (set.iter())
        .flat_map(|&v| model.around.of(v))
        .map(|&(e, _)| e)
        .filter(|&e| model.fates[e] == Fate::Open)
        .collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Leave twice: one row for each edge that meets all cycles, or one for a set
/// that does.
fn leave_twice(model: &Model<'_>, set: &[usize], rows: &mut Vec<Row>) {
    let edges = touching(model, set);
    let contains = |v: &usize| set.binary_search(v).is_ok();
    let (within, leaving): (Vec<usize>, Vec<usize>) =
        (edges.into_iter()).partition(|&e| model.problem.ends[e].iter().all(contains));
    let cycles = Cycles::of(model, &within);
    let Some(cycles) = cycles else {
        // Too many to list: all edges outside a forest meet all of them.
        let mut row = leaving;
        row.extend(outside_forest(model, &within));
        rows.push(even(row, 2.0));
        return;
    };
    if cycles.is_empty() {
        rows.push(even(leaving, 2.0));
        return;
    }
    let hits = |e: usize, cycles: &[Vec<usize>]| cycles.iter().filter(|c| c.contains(&e)).count();
    let single: Vec<usize> = (within.iter().copied())
        .filter(|&e| hits(e, &cycles) == cycles.len())
        .collect();
    if single.is_empty() {
        let mut left = cycles;
        let mut row = leaving;
        while !left.is_empty() {
            let most = within.iter().copied().max_by_key(|&e| hits(e, &left));
            let Some(e) = most else {
                return;
            };
            row.push(e);
            left.retain(|c| !c.contains(&e));
        }
        rows.push(even(row, 2.0));
        return;
    }
    for e in single {
        let mut row = leaving.clone();
        row.push(e);
        rows.push(even(row, 2.0));
    }
}

/// Edges that close cycles as a forest grows.
fn outside_forest(model: &Model<'_>, edges: &[usize]) -> Vec<usize> {
    let mut root: std::collections::BTreeMap<usize, usize> = std::collections::BTreeMap::new();
    fn find(root: &std::collections::BTreeMap<usize, usize>, mut v: usize) -> usize {
        while let Some(&up) = root.get(&v) {
            v = up;
        }
        v
    }
    let mut outside = Vec::new();
    for &e in edges {
        let [a, b] = model.problem.ends[e].map(|v| find(&root, v));
        if a == b {
            outside.push(e);
        } else {
            root.insert(a, b);
        }
    }
    outside
}

/// Enumerates cycles without forbidden patterns.
struct Cycles<'a> {
    model: &'a Model<'a>,
    edges: &'a [usize],
    path: Vec<usize>,
    visited: Vec<usize>,
    steps: usize,
    found: Vec<Vec<usize>>,
}

impl<'a> Cycles<'a> {
    /// All cycles of some edges; `None` if there are too many.
    fn of(model: &'a Model<'_>, edges: &'a [usize]) -> Option<Vec<Vec<usize>>> {
        let mut search = Self {
            model,
            edges,
            path: Vec::new(),
            visited: Vec::new(),
            steps: 0,
            found: Vec::new(),
        };
        for (k, &first) in edges.iter().enumerate() {
            // Each cycle from its first edge on, one way around.
            let [a, b] = model.problem.ends[first];
            search.path.push(first);
            search.visited.extend([a, b]);
            let whole = search.grow(k, b, a);
            search.path.clear();
            search.visited.clear();
            if !whole {
                return None;
            }
        }
        Some(search.found)
    }

    fn grow(&mut self, first: usize, at: usize, home: usize) -> bool {
        self.steps += 1;
        if self.steps > STEPS {
            return false;
        }
        for k in first + 1..self.edges.len() {
            let e = self.edges[k];
            let [a, b] = self.model.problem.ends[e];
            let next = match at {
                v if v == a => b,
                v if v == b => a,
                _ => continue,
            };
            if self.path.contains(&e) || next != home && self.visited.contains(&next) {
                continue;
            }
            self.path.push(e);
            if !self.breaks(e) {
                if next == home {
                    self.found.push(self.path.clone());
                } else {
                    self.visited.push(next);
                    if !self.grow(first, next, home) {
                        return false;
                    }
                    self.visited.pop();
                }
            }
            self.path.pop();
        }
        true
    }

    /// Whether the path contains a forbidden pattern with this edge, whatever
    /// else is active.
    fn breaks(&self, e: usize) -> bool {
        self.model.patterns_at.of(e).iter().any(|&(p, _)| {
            self.model.pattern_costs[p].is_none()
                && (self.model.patterns.of(p).iter()).all(|&(k, on)| on && self.path.contains(&k))
        })
    }
}

/// On the borders of how many rooms an edge can be at once.
fn at_once(model: &Model<'_>, e: usize) -> usize {
    let Some(rooms) = &model.rooms else {
        return 0;
    };
    let mut left: Vec<usize> = (rooms.border_at.of(e).iter().copied())
        .filter(|&p| !rooms.barred[p])
        .collect();
    let mut faces = 0;
    while !left.is_empty() {
        let mut tally: std::collections::BTreeMap<usize, usize> = std::collections::BTreeMap::new();
        for &f in left.iter().flat_map(|&p| rooms.faces.of(p)) {
            *tally.entry(f).or_default() += 1;
        }
        let Some((&face, _)) = tally.iter().max_by_key(|&(&f, &n)| (n, usize::MAX - f)) else {
            return faces + left.len();
        };
        left.retain(|&p| !rooms.faces.of(p).contains(&face));
        faces += 1;
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{verify, EdgeState, Network, Pattern, PatternKind, Problem};

    /// Squares in rows of two, as many as told, and a diagonal in the first.
    fn strip(rows: usize, sink: usize, dead_ends: bool, close: bool) -> Problem {
        let n = 3 * (rows + 1);
        let mut ends: Vec<[usize; 2]> = Vec::new();
        ends.extend((0..n).filter(|v| v % 3 < 2).map(|v| [v, v + 1]));
        ends.extend((0..n - 3).map(|v| [v, v + 3]));
        ends.push([0, 4]);
        let edges = ends.len();
        let at = |a: usize, b: usize| ends.iter().position(|&e| e == [a, b]).expect("an edge");
        let squares = (0..n - 3).filter(|v| v % 3 < 2);
        let pairs = squares.flat_map(|v| {
            [
                [at(v, v + 1), at(v + 3, v + 4)],
                [at(v, v + 3), at(v + 1, v + 4)],
            ]
        });
        let patterns = (pairs.filter(|_| close))
            .map(|pair| Pattern {
                kind: PatternKind::TooClose,
                active: pair.to_vec(),
                inactive: vec![],
                cost: None,
            })
            .collect();
        let mut sinks = vec![false; n];
        sinks[sink] = true;
        let near = |v: usize| {
            let mut ball: Vec<usize> = (ends.iter().filter(|e| e.contains(&v)).flatten())
                .copied()
                .collect();
            ball.sort_unstable();
            ball.dedup();
            ball
        };
        Problem {
            vertices: n,
            coverage: (0..n).map(near).collect(),
            lengths: vec![1.0; edges],
            states: vec![EdgeState::Open; edges],
            sinks,
            dead_ends,
            patterns,
            length_weight: 1.0,
            ends,
            ..Problem::default()
        }
    }

    /// Every row holds for every valid network, by listing all of them.
    #[test]
    fn rows_hold_for_all_valid_networks() {
        let (mut rows_seen, mut networks) = (0, 0);
        for (sink, dead_ends, close, state) in [
            (0, false, false, EdgeState::Open),
            (0, false, true, EdgeState::Open),
            (4, true, true, EdgeState::Open),
            (8, false, false, EdgeState::Required),
            (6, true, false, EdgeState::Given),
        ] {
            let mut problem = strip(2, sink, dead_ends, close);
            let last = problem.edges() - 2;
            problem.states[last] = state;
            if state == EdgeState::Given {
                problem.sinks[problem.ends[last][0]] = true;
            }
            let Ok(model) = Model::new(&problem) else {
                continue;
            };
            let mut quarry = Quarry::new(&model);
            while quarry.dig(&model) {}
            rows_seen += quarry.rows.len();
            for set in 0..1_usize << problem.edges() {
                let active: Vec<bool> = (0..problem.edges()).map(|e| set >> e & 1 == 1).collect();
                let network = Network {
                    active,
                    ..Network::default()
                };
                if !verify(&problem, &network).is_empty() {
                    continue;
                }
                networks += 1;
                for row in &quarry.rows {
                    let terms = row.terms.iter().filter(|t| network.active[t.0]);
                    let sum: f64 = terms.map(|t| t.1).sum();
                    assert!(sum >= row.least, "{row:?} for {:?}", network.active);
                }
            }
        }
        assert!(rows_seen > 50 && networks > 100, "{rows_seen} {networks}");
    }

    #[test]
    fn cycles_are_listed_once_each() {
        // Ring of four with one chord: two triangles and the ring.
        let problem = Problem {
            vertices: 4,
            ends: vec![[0, 1], [1, 2], [2, 3], [0, 3], [0, 2]],
            lengths: vec![1.0; 5],
            states: vec![EdgeState::Open; 5],
            sinks: vec![true, false, false, false],
            length_weight: 1.0,
            ..Problem::default()
        };
        let model = Model::new(&problem).expect("has solutions");
        let mut cycles = Cycles::of(&model, &[0, 1, 2, 3, 4]).expect("few");
        cycles.iter_mut().for_each(|c| c.sort_unstable());
        cycles.sort();
        assert_eq!(cycles, [vec![0, 1, 2, 3], vec![0, 1, 4], vec![2, 3, 4]]);
        assert_eq!(outside_forest(&model, &[0, 1, 2, 3, 4]), [3, 4]);
    }
}
