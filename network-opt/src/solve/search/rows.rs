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
//! - **Doors.** Each face f is covered by a room of at most m_f faces, so there
//!   are at least `N = sum of 1 / m_f` rooms, each with an active edge on its
//!   border. An edge e is on the border of at most h_e rooms at once: h_e faces
//!   suffice to meet all placements that have it on their border, and no face
//!   is covered twice. So `sum of h_e x_e >= N`, N rounded up.

use super::model::{Fate, Model};

/// An inequality.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    /// Edges with their factors.
    pub(super) terms: Vec<(usize, f64)>,
    pub(super) least: f64,
}

/// How many rings of neighbours are put around a set.
const RINGS: usize = 24;
/// Steps of the enumeration of cycles for one set.
const STEPS: usize = 20_000;

/// All inequalities that are found.
pub(super) fn rows(model: &Model<'_>) -> Vec<Row> {
    let mut rows = Vec::new();
    let anchored: Vec<bool> = (0..model.problem.vertices)
        .map(|v| {
            model
                .around
                .of(v)
                .iter()
                .any(|&(e, _)| model.fates[e] == Fate::On)
        })
        .collect();
    let barrier: Vec<bool> = (0..model.problem.vertices)
        .map(|v| anchored[v] || model.problem.sinks[v])
        .collect();
    for r in 0..model.rows.len() {
        let set = model.rows.of(r);
        let free = !set.iter().any(|&v| barrier[v]);
        let twice = free && !model.problem.dead_ends;
        // Rows with a vertex that is active anyway were left out of the model.
        let here = touching(model, set);
        rows.push(even(here, if twice { 2.0 } else { 1.0 }));
        if free {
            nested(model, set, &barrier, &mut rows);
            if twice {
                leave_twice(model, set, &mut rows);
            }
        }
    }
    doors(model, &barrier, &mut rows);
    // One without edges says that there is no solution; that is not for a bound.
    rows.retain(|row| row.least > 0.0 && !row.terms.is_empty());
    rows
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

/// Leave: for the set and its neighbourhoods, until they meet a sink.
fn nested(model: &Model<'_>, set: &[usize], barrier: &[bool], rows: &mut Vec<Row>) {
    let mut inside = vec![false; model.problem.vertices];
    let mut union = set.to_vec();
    set.iter().for_each(|&v| inside[v] = true);
    for _ in 0..RINGS {
        let mut leaving = Vec::new();
        let mut ring = Vec::new();
        for &v in &union {
            for &(e, w) in model.around.of(v) {
                if model.fates[e] == Fate::Open && !inside[w] {
                    leaving.push(e);
                    ring.push(w);
                }
            }
        }
        rows.push(even(leaving, 1.0));
        if ring.is_empty() || ring.iter().any(|&v| barrier[v]) {
            return;
        }
        for v in ring {
            if !inside[v] {
                inside[v] = true;
                union.push(v);
            }
        }
    }
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
        for k in 0..edges.len() {
            // Each cycle from its first edge on, one way around.
            let [a, b] = model.problem.ends[edges[k]];
            search.path.push(edges[k]);
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

/// Door and doors.
fn doors(model: &Model<'_>, barrier: &[bool], rows: &mut Vec<Row>) {
    let (Some(rooms), Some(spec)) = (&model.rooms, &model.problem.rooms) else {
        return;
    };
    let mut count = 0.0;
    for f in (0..spec.covered.len()).filter(|&f| spec.covered[f]) {
        let usable: Vec<usize> = (rooms.at_face.of(f).iter().copied())
            .filter(|&p| !rooms.barred[p])
            .collect();
        let Some(most) = usable.iter().map(|&p| rooms.faces.of(p).len()).max() else {
            continue;
        };
        count += 1.0 / most as f64;
        let mut edges: Vec<usize> = (usable.iter())
            .flat_map(|&p| rooms.borders.of(p))
            .copied()
            .collect();
        edges.sort_unstable();
        edges.dedup();
        if edges.iter().any(|&e| model.fates[e] == Fate::On) {
            continue;
        }
        edges.retain(|&e| model.fates[e] == Fate::Open);
        let mut ends: Vec<usize> = edges.iter().flat_map(|&e| model.problem.ends[e]).collect();
        ends.sort_unstable();
        ends.dedup();
        rows.push(even(edges, 1.0));
        if !ends.iter().any(|&v| barrier[v]) {
            nested(model, &ends, barrier, rows);
        }
    }
    // Rounded up, but not by what sums of fractions are wrong.
    let mut row = Row {
        terms: Vec::new(),
        least: (count - 1e-9).ceil(),
    };
    for e in 0..model.problem.edges() {
        if model.fates[e] == Fate::Off {
            continue;
        }
        let at_once = at_once(model, e) as f64;
        if model.fates[e] == Fate::On {
            row.least -= at_once;
        } else if at_once > 0.0 {
            row.terms.push((e, at_once));
        }
    }
    rows.push(row);
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
