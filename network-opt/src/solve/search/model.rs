//! A problem made ready for the search: what is already decided, and who is
//! touched by which edge.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::lists::{inverse, Lists};
use super::patterns::{decide, literals, triples, Triple};
use super::placing::Placing;
use super::rooms::RoomModel;
use super::turns::{floors, is_lost, Turns};
use crate::design::{EdgeState, Heading, Problem};

/// What is decided of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    Open,
    On,
    Off,
}

/// The parts of a problem by edge, vertex and face.
#[derive(Debug)]
pub(super) struct Model<'p> {
    pub(super) problem: &'p Problem,
    pub(super) around: Lists<(usize, usize)>,
    pub(super) fates: Vec<Fate>,
    pub(super) given: Vec<bool>,
    /// Sets of vertices of which one must be active; those implied by others
    /// left out.
    pub(super) rows: Lists<usize>,
    pub(super) rows_at: Lists<usize>,
    /// Literals of each pattern: an edge, and whether it is to be active.
    pub(super) patterns: Lists<(usize, bool)>,
    pub(super) pattern_costs: Vec<Option<f64>>,
    /// By edge, the patterns with its literal.
    pub(super) patterns_at: Lists<(usize, bool)>,
    /// By edge, the patterns that it completes as part of a path.
    pub(super) triples: Lists<Triple>,
    /// All paths of all routes, by their edges.
    pub(super) paths: Lists<usize>,
    pub(super) paths_at: Lists<usize>,
    /// The route of each path, and the paths of each route.
    pub(super) route_of: Vec<usize>,
    pub(super) routes: Lists<usize>,
    /// What each route costs that is not there; `None` if it has to be.
    pub(super) route_costs: Vec<Option<f64>>,
    /// Whether each vertex is a sink or may become one.
    pub(super) may_sink: Vec<bool>,
    /// Sinks that are to be placed.
    pub(super) placing: Option<Placing>,
    pub(super) rooms: Option<RoomModel>,
    /// The way of each vertex to a sink over given edges alone.
    pub(super) base: Vec<f64>,
    /// Directions, if any edge is one-way.
    pub(super) turns: Option<Turns>,
    /// By edge, the least that its travel can be.
    pub(super) floor: Vec<f64>,
    /// Given edges that reach no sink by themselves.
    pub(super) stray: Vec<usize>,
    /// Shortest cycles, by their edges, and which pass each edge.
    pub(super) cycles: Lists<usize>,
    pub(super) cycles_at: Lists<usize>,
    /// What an average edge costs: the scale of penalties and temperatures.
    pub(super) unit: f64,
}

/// No network can be valid.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Hopeless;

impl<'p> Model<'p> {
    pub(super) fn new(problem: &'p Problem) -> Result<Self, Hopeless> {
        let (vertices, edges) = (problem.vertices, problem.edges());
        let around = Lists::new(problem.around());
        let may_sink = problem.possible_sinks();
        let (patterns, pattern_costs) = literals(problem);
        let mut by_edge = vec![Vec::new(); edges];
        for p in 0..patterns.len() {
            for &(e, wanted) in patterns.of(p) {
                by_edge[e].push((p, wanted));
            }
        }
        let patterns_at = Lists::new(by_edge);
        let mut fates: Vec<Fate> = (problem.states.iter())
            .map(|state| match state {
                EdgeState::Open => Fate::Open,
                EdgeState::Given | EdgeState::Required => Fate::On,
                EdgeState::Closed => Fate::Off,
            })
            .collect();
        let parts = (&patterns, pattern_costs.as_slice());
        decide(problem, &around, parts, &may_sink, &mut fates)?;
        let usable = |v: usize| around.of(v).iter().any(|&(e, _)| fates[e] != Fate::Off);
        let settled = |v: usize| around.of(v).iter().any(|&(e, _)| fates[e] == Fate::On);
        let triples = triples(&patterns, &pattern_costs, &fates);
        let mut rows: Vec<Vec<usize>> = problem.coverage.clone();
        rows.extend(problem.required_vertices.iter().map(|&v| vec![v]));
        rows.retain(|row| !row.iter().any(|&v| settled(v)));
        for row in &mut rows {
            row.retain(|&v| usable(v));
            row.sort_unstable();
            row.dedup();
        }
        if rows.iter().any(Vec::is_empty) {
            return Err(Hopeless);
        }
        let rows = Lists::new(undominated(rows, vertices));
        let rows_at = inverse(&rows, vertices);

        let given: Vec<bool> = (0..edges).map(|e| problem.is_given(e)).collect();
        let base = ways(problem, &around, &problem.sinks, Heading::Out, |e, end| {
            given[e] && problem.way(e).runs_from(end)
        });
        let least = ways(problem, &around, &may_sink, Heading::Out, |e, end| {
            fates[e] != Fate::Off && problem.way(e).may_run_from(end)
        });
        let turns = Turns::new(problem, &around, &given, &fates);
        let lost = |e: usize, to: &[f64], from: Option<&Vec<f64>>| match from {
            Some(from) => is_lost(problem.ends[e], problem.way(e), to, from),
            None => to[problem.ends[e][0]].is_infinite(),
        };
        let stray = (0..edges)
            .filter(|&e| given[e] && lost(e, &base, turns.as_ref().map(|t| &t.base)))
            .collect();
        for (fate, ends) in fates.iter_mut().zip(&problem.ends) {
            let far = |way: &[f64]| ends.iter().any(|&v| way[v].is_infinite());
            // What reaches no sink is an island; what none reaches is no use.
            if far(&least) || turns.as_ref().is_some_and(|t| far(&t.least)) {
                if *fate == Fate::On {
                    return Err(Hopeless);
                }
                *fate = Fate::Off;
            }
        }
        let floor = floors(problem, &least, turns.as_ref());

        let mut route_of = Vec::new();
        let mut paths = Vec::new();
        for (r, route) in problem.routes.iter().enumerate() {
            for path in &route.paths {
                if path.iter().all(|&e| fates[e] != Fate::Off) {
                    let mut path = path.clone();
                    path.sort_unstable();
                    path.dedup();
                    paths.push(path);
                    route_of.push(r);
                }
            }
        }
        let mut routes = vec![Vec::new(); problem.routes.len()];
        for (k, &r) in route_of.iter().enumerate() {
            routes[r].push(k);
        }
        let route_costs: Vec<Option<f64>> = problem.routes.iter().map(|r| r.cost).collect();
        let mut needed = routes.iter().zip(&route_costs);
        if needed.any(|(paths, cost)| paths.is_empty() && cost.is_none()) {
            return Err(Hopeless);
        }
        let placing = match &problem.placed {
            Some(placed) => Some(Placing::new(placed, &around, &fates)?),
            None => None,
        };
        let paths = Lists::new(paths);
        let paths_at = inverse(&paths, edges);
        let rooms = problem
            .rooms
            .as_ref()
            .map(|_| RoomModel::new(problem, &fates));
        let cycles = cycles(problem, &around, &fates);
        let cycles_at = inverse(&cycles, edges);
        let unit = unit(problem, &fates, &floor);
        Ok(Self {
            problem,
            around,
            fates,
            given,
            rows,
            rows_at,
            patterns,
            pattern_costs,
            patterns_at,
            triples,
            paths,
            paths_at,
            route_of,
            routes: Lists::new(routes),
            route_costs,
            may_sink,
            placing,
            rooms,
            base,
            turns,
            floor,
            stray,
            cycles,
            cycles_at,
            unit,
        })
    }

    /// The price of an edge whose nearer end has this way to a sink.
    pub(super) fn price(&self, e: usize, away: f64) -> f64 {
        let p = self.problem;
        p.length_weight * p.lengths[e] + p.travel_weight * away
    }
}

/// Rows that contain no other row.
fn undominated(mut rows: Vec<Vec<usize>>, vertices: usize) -> Vec<Vec<usize>> {
    rows.sort_by(|a, b| (a.len(), a).cmp(&(b.len(), b)));
    rows.dedup();
    let lists = Lists::new(rows.clone());
    let at = inverse(&lists, vertices);
    let mut keep = vec![true; rows.len()];
    for (k, row) in rows.iter().enumerate() {
        if !keep[k] {
            continue;
        }
        for &other in at.of(row[0]) {
            // Sorted: one that contains this one is no shorter, and comes later.
            if other > k && keep[other] {
                keep[other] = !row.iter().all(|v| rows[other].binary_search(v).is_ok());
            }
        }
    }
    let mut kept = keep.into_iter();
    rows.retain(|_| kept.next() == Some(true));
    rows
}

/// The way from each vertex to the nearest of some sinks, or to it from one, over
/// some of the edges, by the end from which traffic runs over them.
pub(super) fn ways(
    problem: &Problem,
    around: &Lists<(usize, usize)>,
    sinks: &[bool],
    heading: Heading,
    may: impl Fn(usize, usize) -> bool,
) -> Vec<f64> {
    let mut away = vec![f64::INFINITY; problem.vertices];
    let mut queue = BinaryHeap::new();
    for v in (0..problem.vertices).filter(|&v| sinks[v]) {
        away[v] = 0.0;
        // Of numbers that are not negative the bits are in order.
        queue.push(Reverse((0.0_f64.to_bits(), v)));
    }
    while let Some(Reverse((bits, v))) = queue.pop() {
        let gone = f64::from_bits(bits);
        if gone > away[v] {
            continue;
        }
        for &(e, w) in around.of(v) {
            let there = gone + problem.travel_cost(e);
            let tail = heading.tail(usize::from(problem.ends[e][1] == w));
            if there < away[w] && may(e, tail) {
                away[w] = there;
                queue.push(Reverse((there.to_bits(), w)));
            }
        }
    }
    away
}

/// Through each pair of open edges at a vertex the shortest cycle of at most
/// six edges, each cycle once.
fn cycles(problem: &Problem, around: &Lists<(usize, usize)>, fates: &[Fate]) -> Lists<usize> {
    const LONGEST: usize = 6;
    let mut found = std::collections::BTreeSet::new();
    let mut seen = vec![usize::MAX; problem.vertices];
    let mut round = 0;
    for v in 0..problem.vertices {
        let open: Vec<_> = (around.of(v).iter())
            .filter(|&&(e, _)| fates[e] == Fate::Open)
            .copied()
            .collect();
        for (k, &(first, from)) in open.iter().enumerate() {
            for &(last, to) in &open[k + 1..] {
                if from == to {
                    continue;
                }
                // From one neighbour to the other around the vertex.
                round += 1;
                seen[v] = round;
                seen[from] = round;
                let mut queue = vec![(from, usize::MAX, first)];
                let mut levels = vec![0];
                let mut at = 0;
                while at < queue.len() {
                    let here = queue[at].0;
                    if here == to {
                        break;
                    }
                    if levels[at] + 3 <= LONGEST {
                        for &(e, w) in around.of(here) {
                            if fates[e] == Fate::Open && seen[w] != round {
                                seen[w] = round;
                                queue.push((w, at, e));
                                levels.push(levels[at] + 1);
                            }
                        }
                    }
                    at += 1;
                }
                if at < queue.len() {
                    let mut cycle = vec![last];
                    while at != usize::MAX {
                        cycle.push(queue[at].2);
                        at = queue[at].1;
                    }
                    cycle.sort_unstable();
                    found.insert(cycle);
                }
            }
        }
    }
    Lists::new(found.into_iter().collect())
}

fn unit(problem: &Problem, fates: &[Fate], floor: &[f64]) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for (e, fate) in fates.iter().enumerate() {
        if *fate == Fate::Open {
            sum += problem.length_weight * problem.lengths[e] + problem.travel_weight * floor[e];
            count += 1;
        }
    }
    // If nothing costs anything, any scale will do.
    if sum > 0.0 {
        sum / f64::from(count)
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Pattern, PatternKind};

    /// A square with a diagonal 0-2 and a tail 3-4.
    fn kite() -> Problem {
        Problem {
            vertices: 5,
            ends: vec![[0, 1], [1, 2], [2, 3], [0, 3], [0, 2], [3, 4]],
            lengths: vec![1.0; 6],
            states: vec![EdgeState::Open; 6],
            sinks: vec![true, false, false, false, false],
            length_weight: 1.0,
            ..Problem::default()
        }
    }

    fn never(active: Vec<usize>, inactive: Vec<usize>) -> Pattern {
        Pattern {
            kind: PatternKind::Branch,
            active,
            inactive,
            cost: None,
        }
    }

    #[test]
    fn conclusions_go_on_as_far_as_they_lead() {
        let mut problem = kite();
        // The tail is a dead end; with 0-1 required 0-2 may not be, so 2-3
        // must, and 1-2 has to go on from 1 but is not concluded.
        problem.states[0] = EdgeState::Required;
        problem.patterns = vec![never(vec![0, 4], vec![]), never(vec![0], vec![4, 2])];
        let model = Model::new(&problem).expect("no contradiction");
        use Fate::{Off, On, Open};
        assert_eq!(model.fates, [On, Open, On, Open, Off, Off]);
        problem.patterns.push(never(vec![0, 2], vec![]));
        assert_eq!(Model::new(&problem).err(), Some(Hopeless));
        // Nothing covers the end of the tail without a dead end.
        let mut problem = kite();
        problem.coverage = vec![vec![4]];
        assert_eq!(Model::new(&problem).err(), Some(Hopeless));
        problem.dead_ends = true;
        assert!(Model::new(&problem).is_ok());
    }

    #[test]
    fn rows_that_follow_from_others_are_left_out() {
        let rows = vec![
            vec![1, 2, 3],
            vec![2, 3],
            vec![0, 4],
            vec![2, 3],
            vec![0, 1, 2],
        ];
        assert_eq!(
            undominated(rows, 5),
            [vec![0, 4], vec![2, 3], vec![0, 1, 2]]
        );
    }

    #[test]
    fn short_cycles_are_found_once() {
        let problem = kite();
        let around = Lists::new(problem.around());
        let found = cycles(&problem, &around, &[Fate::Open; 6]);
        let found: Vec<&[usize]> = (0..found.len()).map(|k| found.of(k)).collect();
        assert_eq!(found, [&[0, 1, 2, 3][..], &[0, 1, 4], &[2, 3, 4]]);
        assert_eq!(cycles(&problem, &around, &[Fate::Off; 6]).len(), 0);
    }
}
