//! Symmetries of a problem, and rows that leave one of all images of a network.
//!
//! A symmetry takes vertices to vertices and edges to edges, and leaves all that
//! a problem says as it is: lengths, states, sinks, coverage, patterns. The image
//! of a valid network is one too, and costs the same. Let G be the group of the
//! symmetries that are known, and Q edges of which no two images have one in
//! common. Then for each g of G
//!
//! x(Q) >= x(g Q).   (30)
//!
//! Valid networks are cut off by that, but not all images of one: *Proof.* Of
//! the images of a network let h be one of those with most active edges in Q.
//! The edges of h in g Q are the image under g of those that g^-1 h has in Q, which
//! are no more. []
//!
//! A solver that finds symmetries by itself finds none here: what it does to the
//! program before it looks is not symmetric. And branches on single edges come
//! to the same networks over and over, in one corner after the other.
//!
//! Q is what is nearer, in edges, to one vertex than to all of its images, and one
//! of the images of what is as near: with the corner of a square a quarter of it. Symmetries are found by refinement:
//! vertices get the colours of their neighbours until nothing changes, once with
//! one vertex marked and once with another; where all colours are different there
//! is one candidate, and it is checked. Else a second vertex is marked.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::draft::Term;
use super::Formulated;
use crate::design::{Network, Problem};

/// Symmetries, the identity included, from which on none are looked for; a
/// square has eight.
const MANY: usize = 16;
/// Edges of a problem from which on no symmetries are looked for: the search takes
/// some tenths of a second then, and no program of that size is solved to proof.
const LARGE: usize = 800;

/// The symmetries of a problem, and the part of it that they are told apart by.
#[derive(Clone, Debug)]
pub(super) struct Symmetries {
    /// For each, where each edge goes; a group, without the identity.
    edges: Vec<Vec<usize>>,
    /// Q.
    part: Vec<usize>,
}

impl Formulated<'_> {
    /// Adds rows (30), if the problem has symmetries that are understood here.
    /// From then on solutions of networks meet all rows if the networks are those
    /// of [`Formulated::image`].
    pub(crate) fn order_images(&mut self) {
        let Some(symmetries) = Symmetries::of(self.problem) else {
            return;
        };
        for edges in &symmetries.edges {
            let own = symmetries.part.iter().map(|&e| (e, 1.0));
            let other = symmetries.part.iter().map(|&e| (edges[e], -1.0));
            let mut low = 0.0;
            let mut terms = Vec::new();
            for (e, factor) in own.chain(other) {
                match self.x[e] {
                    Term::Off => {}
                    Term::On => low -= factor,
                    Term::Column(column) => terms.push((column, factor)),
                }
            }
            self.program.row(low, f64::INFINITY, terms);
        }
        self.symmetries = Some(symmetries);
    }

    /// The image of a network that meets rows (30); itself if there are none.
    pub(crate) fn image(&self, network: &Network) -> Network {
        let mut image = network.clone();
        if let Some(symmetries) = &self.symmetries {
            image.active = symmetries.image(&network.active);
        }
        image
    }
}

impl Symmetries {
    /// None if there are none but the identity, or too many, or none that tell
    /// two parts of the problem apart.
    fn of(problem: &Problem) -> Option<Self> {
        let plain = problem.rooms.is_none()
            && problem.placed.is_none()
            && problem.routes.is_empty()
            && !problem.has_one_way();
        if !plain || problem.edges() > LARGE || problem.vertices == 0 {
            return None;
        }
        let looked_at = Looked::new(problem)?;
        let vertices = group(looked_at.found())?;
        let edges: Option<Vec<Vec<usize>>> = (vertices.iter())
            .map(|symmetry| looked_at.edges(symmetry))
            .collect();
        let edges = edges?;
        let part = looked_at.part(&vertices, &edges)?;
        Some(Self { edges, part })
    }

    /// The image with most active edges in the part; the network itself, or the
    /// first, of equal ones.
    fn image(&self, active: &[bool]) -> Vec<bool> {
        let in_part = |active: &[bool]| self.part.iter().filter(|&&e| active[e]).count();
        let mut best = active.to_vec();
        for edges in &self.edges {
            let mut image = vec![false; active.len()];
            for (e, &to) in edges.iter().enumerate() {
                image[to] = active[e];
            }
            if in_part(&image) > in_part(&best) {
                best = image;
            }
        }
        best
    }
}

/// The group that symmetries generate, without the identity; none if that is
/// all, or if they are too many.
fn group(found: Vec<Vec<usize>>) -> Option<Vec<Vec<usize>>> {
    let first = found.first()?;
    let identity: Vec<usize> = (0..first.len()).collect();
    let mut all = BTreeSet::from([identity.clone()]);
    let mut queue = vec![identity.clone()];
    while let Some(a) = queue.pop() {
        for b in &found {
            let product: Vec<usize> = a.iter().map(|&v| b[v]).collect();
            if all.insert(product.clone()) {
                queue.push(product);
            }
        }
        if all.len() > MANY {
            return None;
        }
    }
    all.remove(&identity);
    (!all.is_empty()).then(|| all.into_iter().collect())
}

/// A problem in the form in which its symmetries are looked for.
struct Looked<'p> {
    problem: &'p Problem,
    around: Vec<Vec<(usize, usize)>>,
    /// The edge of each two ends.
    numbers: BTreeMap<[usize; 2], usize>,
    said: Said,
}

/// What a problem says of sets of vertices and edges, sorted.
#[derive(PartialEq)]
struct Said {
    coverage: Vec<Vec<usize>>,
    required: Vec<usize>,
    patterns: Vec<(Vec<usize>, Vec<usize>, Option<u64>)>,
}

impl<'p> Looked<'p> {
    /// None if two edges have the same ends.
    fn new(problem: &'p Problem) -> Option<Self> {
        let numbers: BTreeMap<[usize; 2], usize> = (problem.ends.iter().enumerate())
            .map(|(e, &[a, b])| ([a.min(b), a.max(b)], e))
            .collect();
        (numbers.len() == problem.edges()).then(|| Self {
            problem,
            around: problem.around(),
            numbers,
            said: Said::of(problem, &|v| v, &|e| e),
        })
    }

    /// Symmetries that generate others, none the identity.
    fn found(&self) -> Vec<Vec<usize>> {
        let start = vec![0; self.problem.vertices];
        let [colours, _] = self.refine([start.clone(), start]);
        let Some(marked) = rarest(&colours) else {
            return Vec::new();
        };
        let mut found = Vec::new();
        for other in like(&colours, marked) {
            let mut pair = [colours.clone(), colours.clone()];
            pair[0][marked] = usize::MAX;
            pair[1][other] = usize::MAX;
            let pair = self.refine(pair);
            let Some(second) = rarest(&pair[0]) else {
                found.extend(self.matched(&pair));
                continue;
            };
            for other in like_in(&pair[1], pair[0][second]) {
                let mut pair = pair.clone();
                pair[0][second] = usize::MAX;
                pair[1][other] = usize::MAX;
                found.extend(self.matched(&self.refine(pair)));
            }
        }
        let is_identity = |symmetry: &Vec<usize>| symmetry.iter().enumerate().all(|(v, &w)| v == w);
        found.retain(|symmetry| !is_identity(symmetry));
        found.truncate(MANY);
        found
    }

    /// Gives vertices of two colourings new colours until there are no more of
    /// them: one for each old colour with those of the neighbours and what the
    /// edges there are, the same in both.
    fn refine(&self, mut pair: [Vec<usize>; 2]) -> [Vec<usize>; 2] {
        let problem = self.problem;
        let mut before = 0;
        loop {
            let signature = |colours: &[usize], v: usize| {
                let edges = self.around[v].iter().map(|&(e, w)| {
                    let numbers = [problem.lengths[e], problem.travel_cost(e)];
                    (
                        colours[w],
                        problem.states[e] as usize,
                        numbers.map(f64::to_bits),
                    )
                });
                let mut edges: Vec<_> = edges.collect();
                edges.sort_unstable();
                (colours[v], problem.sinks[v], edges)
            };
            let signatures = pair.each_ref().map(|colours| {
                let all = (0..problem.vertices).map(|v| signature(colours, v));
                all.collect::<Vec<_>>()
            });
            let known: BTreeSet<_> = signatures.iter().flatten().cloned().collect();
            let numbers: BTreeMap<_, usize> = known.into_iter().zip(0..).collect();
            let count = numbers.len();
            pair = signatures.map(|all| all.iter().map(|s| numbers[s]).collect());
            if count == before {
                return pair;
            }
            before = count;
        }
    }

    /// The symmetry that takes each vertex to the one of its colour, if each
    /// colour is there once and it is one.
    fn matched(&self, pair: &[Vec<usize>; 2]) -> Option<Vec<usize>> {
        let there: BTreeMap<usize, usize> = pair[1].iter().copied().zip(0..).collect();
        let here: BTreeSet<usize> = pair[0].iter().copied().collect();
        if there.len() < pair[1].len() || here.len() < pair[0].len() {
            return None;
        }
        let symmetry: Option<Vec<usize>> = (pair[0].iter())
            .map(|colour| there.get(colour).copied())
            .collect();
        let symmetry = symmetry?;
        let edges = self.edges(&symmetry)?;
        let problem = self.problem;
        let same = (0..problem.vertices).all(|v| problem.sinks[v] == problem.sinks[symmetry[v]])
            && edges.iter().enumerate().all(|(e, &to)| {
                problem.lengths[e] == problem.lengths[to]
                    && problem.travel_cost(e) == problem.travel_cost(to)
                    && problem.states[e] == problem.states[to]
            })
            && Said::of(problem, &|v| symmetry[v], &|e| edges[e]) == self.said;
        same.then_some(symmetry)
    }

    /// Where edges go if vertices go where `symmetry` says.
    fn edges(&self, symmetry: &[usize]) -> Option<Vec<usize>> {
        let ends = self.problem.ends.iter();
        let to = ends.map(|ends| {
            let [a, b] = ends.map(|v| symmetry[v]);
            self.numbers.get(&[a.min(b), a.max(b)]).copied()
        });
        to.collect()
    }

    /// The edges that are nearer to one vertex than to all its images, and of
    /// those as near to one of these one image: of the vertices that every symmetry
    /// moves, one that has most of them.
    fn part(&self, symmetries: &[Vec<usize>], edges: &[Vec<usize>]) -> Option<Vec<usize>> {
        let mut best: Vec<usize> = Vec::new();
        let mut seen = BTreeSet::new();
        for v in 0..self.problem.vertices {
            let images: BTreeSet<usize> = symmetries.iter().map(|symmetry| symmetry[v]).collect();
            let all_differ = images.len() == symmetries.len() && !images.contains(&v);
            // Of the images of one vertex the first will do, and a few vertices.
            if !all_differ || images.iter().any(|w| seen.contains(w)) || seen.len() >= MANY {
                continue;
            }
            seen.insert(v);
            let own = self.hops(&[v]);
            let others = self.hops(&images.into_iter().collect::<Vec<_>>());
            let mut part = Vec::new();
            let mut told = vec![false; self.problem.edges()];
            for (e, &[a, b]) in self.problem.ends.iter().enumerate() {
                let images: BTreeSet<usize> = edges.iter().map(|edges| edges[e]).collect();
                let all_differ = images.len() == edges.len() && !images.contains(&e);
                // Of edges as near to two of the vertices one of the images.
                if all_differ && !told[e] && own[a] + own[b] <= others[a] + others[b] {
                    part.push(e);
                    told[e] = true;
                    images.into_iter().for_each(|e| told[e] = true);
                }
            }
            if part.len() > best.len() {
                best = part;
            }
        }
        (!best.is_empty()).then_some(best)
    }

    /// The least number of edges from some vertices to each.
    fn hops(&self, from: &[usize]) -> Vec<usize> {
        let mut hops = vec![self.problem.vertices; self.problem.vertices];
        from.iter().for_each(|&v| hops[v] = 0);
        let mut queue: VecDeque<usize> = from.iter().copied().collect();
        while let Some(v) = queue.pop_front() {
            for &(_, w) in &self.around[v] {
                if hops[w] > hops[v] + 1 {
                    hops[w] = hops[v] + 1;
                    queue.push_back(w);
                }
            }
        }
        hops
    }
}

impl Said {
    /// With vertices and edges by other numbers.
    fn of(problem: &Problem, v: &dyn Fn(usize) -> usize, e: &dyn Fn(usize) -> usize) -> Self {
        let set = |list: &[usize], to: &dyn Fn(usize) -> usize| {
            let mut set: Vec<usize> = list.iter().map(|&k| to(k)).collect();
            set.sort_unstable();
            set.dedup();
            set
        };
        let mut coverage: Vec<Vec<usize>> = problem.coverage.iter().map(|b| set(b, v)).collect();
        coverage.sort_unstable();
        // What a pattern is called does not matter.
        let patterns = problem.patterns.iter().map(|p| {
            let cost = p.cost.map(f64::to_bits);
            (set(&p.active, e), set(&p.inactive, e), cost)
        });
        let mut patterns: Vec<_> = patterns.collect();
        patterns.sort_unstable();
        Self {
            coverage,
            required: set(&problem.required_vertices, v),
            patterns,
        }
    }
}

/// A vertex of the colour that the fewest have, but more than one; the first of
/// equal ones.
fn rarest(colours: &[usize]) -> Option<usize> {
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    colours
        .iter()
        .for_each(|&c| *counts.entry(c).or_default() += 1);
    let several = (0..colours.len()).filter(|&v| counts[&colours[v]] > 1);
    several.min_by_key(|&v| counts[&colours[v]])
}

/// The vertices of the colour of one of them.
fn like(colours: &[usize], v: usize) -> Vec<usize> {
    like_in(colours, colours[v])
}

/// The vertices of a colour; a few if they are many.
fn like_in(colours: &[usize], colour: usize) -> Vec<usize> {
    let alike = (0..colours.len()).filter(|&w| colours[w] == colour);
    alike.take(MANY).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::EdgeState;
    use crate::formulate::Formulation;
    use crate::mip::Microlp;
    use crate::solve::{Ended, Exact, Limits, NetworkSolver};

    /// A window of two by two panes with the sink in the middle.
    fn window() -> Problem {
        let across = (0..9).filter(|v| v % 3 < 2).map(|v| [v, v + 1]);
        let ends: Vec<[usize; 2]> = across.chain((0..6).map(|v| [v, v + 3])).collect();
        Problem {
            vertices: 9,
            lengths: vec![1.0; 12],
            states: vec![EdgeState::Open; 12],
            sinks: (0..9).map(|v| v == 4).collect(),
            length_weight: 1.0,
            travel_weight: 1.0,
            ends,
            ..Problem::default()
        }
    }

    fn count(problem: &Problem) -> usize {
        let looked_at = Looked::new(problem).expect("no two edges with the same ends");
        group(looked_at.found()).map_or(0, |all| all.len())
    }

    #[test]
    fn the_symmetries_of_a_window_are_found() {
        let mut problem = window();
        assert_eq!(count(&problem), 7);
        // Along the first diagonal.
        problem.required_vertices = vec![0];
        assert_eq!(count(&problem), 1);
        problem.required_vertices = vec![0, 8];
        assert_eq!(count(&problem), 3);
        problem.coverage = vec![vec![0, 1, 3], vec![5, 7, 8]];
        assert_eq!(count(&problem), 3);
        problem.coverage.pop();
        assert_eq!(count(&problem), 1);
        problem.lengths[0] = 1.25;
        assert_eq!(count(&problem), 0);
    }

    #[test]
    fn one_image_of_each_network_is_left() {
        let problem = window();
        let mut formulated = Formulated::new(&problem, Formulation::Flow, None).expect("fits");
        let before = formulated.program().rows().len();
        formulated.order_images();
        let rows = formulated.program().rows()[before..].to_vec();
        // The corners have fewer images than there are symmetries.
        assert!(rows.is_empty());
        // Half turns and quarter turns alone have as many.
        let mut turned = problem.clone();
        turned.patterns = (0..12)
            .flat_map(|a| (0..12).map(move |b| (a, b)))
            .filter(|&(a, b)| {
                // An edge at the rim, and the next one to the left of it.
                let ring = [0, 1, 8, 11, 5, 4, 9, 6];
                let at = |e| ring.iter().position(|&r| r == e);
                matches!((at(a), at(b)), (Some(a), Some(b)) if a % 2 == 1 && b == (a + 2) % 8)
            })
            .map(|(a, b)| crate::design::Pattern {
                kind: crate::design::PatternKind::ZigZag,
                active: vec![a],
                inactive: vec![b],
                cost: Some(0.5),
            })
            .collect();
        let mut formulated = Formulated::new(&turned, Formulation::Flow, None).expect("fits");
        let before = formulated.program().rows().len();
        formulated.order_images();
        let rows = formulated.program().rows()[before..].to_vec();
        assert_eq!(rows.len(), 3);
        let mut fewer = false;
        for set in 0..1 << 12 {
            let network = Network {
                active: (0..12).map(|e| set >> e & 1 == 1).collect(),
                ..Network::default()
            };
            let meets = |network: &Network| {
                // Columns of edges come first.
                let value = |c: usize| f64::from(u8::from(network.active[c]));
                let sum = |row: &crate::mip::Row| -> f64 {
                    row.terms.iter().map(|&(c, factor)| factor * value(c)).sum()
                };
                rows.iter().all(|row| sum(row) >= row.low)
            };
            let image = formulated.image(&network);
            assert!(meets(&image));
            let lengths = [&network, &image].map(|n| n.active.iter().filter(|&&on| on).count());
            assert_eq!(lengths[0], lengths[1]);
            fewer |= !meets(&network);
        }
        assert!(fewer);
        // And the optimum is the same, for any set of vertices that is needed.
        for needed in [vec![0, 2, 6, 8], vec![1, 3, 5, 7]] {
            turned.coverage = vec![needed.clone(), (0..9).filter(|&v| v != 4).collect()];
            let best = [true, false].map(|symmetry| {
                let exact = Exact {
                    symmetry,
                    ..Exact::new(Microlp)
                };
                let found = exact.solve(&turned, None, &Limits::default(), &mut |_| true);
                let found = found.expect("solved");
                assert_eq!(found.ended, Ended::Proven);
                found.cost.objective
            });
            assert_eq!(best[0], best[1]);
        }
    }
}
