//! Which edges of a region's mesh become streets, level by level.

use network_opt::design::{
    distances, EdgeState, Network, Pattern, PatternKind, Problem, Sinks, Specification,
    Tessellation,
};
use network_opt::solve::{Limits, NetworkSolver, Search};

use super::options::{LevelPlan, NetworkOptions};
use super::rim::RimFacts;
use crate::plane::{angle, signed_area, unit};
use crate::planner::seed::mix;
use crate::region::Region;
use crate::splitter::{CutMaker, Scene};

/// The edges chosen, on the finest mesh.
#[derive(Debug)]
pub(super) struct Web {
    pub(super) mesh: Tessellation,
    /// The level of each edge that becomes a street.
    pub(super) level: Vec<Option<usize>>,
    /// Edges that are streets already.
    pub(super) given: Vec<bool>,
    /// Parcels that have their way out over each edge.
    pub(super) traffic: Vec<f64>,
}

/// What is to be laid out, and how.
#[derive(Clone, Copy)]
struct Order<'a> {
    scene: &'a Scene<'a>,
    region: &'a Region,
    options: &'a NetworkOptions,
}

/// Two edges of a vertex that meet at less than this make a bend, degrees.
const BEND_DEG: f64 = 130.0;
/// Share of the land that becomes parcels.
const PARCEL_LAND: f64 = 0.73;
/// Good enough: the search stops within this part of the bound.
const GAP: f64 = 0.01;
/// A first network is looked for within this part of the moves, with all that
/// is asked and then with less.
const TRIES: u64 = 8;
/// Vertices in which two entries lie too near each other for both to be
/// continued, in edges.
const APART: usize = 2;

/// Finds the networks of all levels, each on the mesh of the one before,
/// refined once, and with its streets given.
///
/// # Errors
///
/// In words for the warning, if there is no network for the first level: what
/// a later level lacks the splitters that follow supply.
pub(super) fn choose(
    scene: &Scene<'_>,
    region: &Region,
    mesh: Tessellation,
    levels: &[LevelPlan],
    options: &NetworkOptions,
    seed: u64,
) -> Result<Web, String> {
    let mut web = Web {
        level: vec![None; mesh.edges().len()],
        given: vec![false; mesh.edges().len()],
        traffic: vec![0.0; mesh.edges().len()],
        mesh,
    };
    let order = Order {
        scene,
        region,
        options,
    };
    for (index, level) in levels.iter().enumerate() {
        if index > 0 {
            web = web.refined();
        }
        let rim = RimFacts::of(&web.mesh, region, scene.network);
        web.given.fill(false);
        rim.given.iter().for_each(|&e| web.given[e] = true);
        let last = index + 1 == levels.len();
        let seed = mix(seed ^ index as u64);
        let found = web.solve(&order, &level.network, &rim, last, seed);
        match found {
            Ok((problem, active)) => {
                let parcel = scene.options.parcel_length * scene.options.parcel_width;
                web.traffic = web.traffic_of(&problem, &active, PARCEL_LAND / parcel);
                for (e, _) in active.iter().enumerate().filter(|(_, &on)| on) {
                    if !web.given[e] {
                        web.level[e].get_or_insert(index);
                    }
                }
            }
            // Land too small for the streets of this level may have others.
            Err(why) if last && web.level.iter().all(Option::is_none) => return Err(why),
            Err(_) => {}
        }
    }
    Ok(web)
}

impl Web {
    /// The same streets on the refined mesh.
    fn refined(&self) -> Self {
        let mesh = self.mesh.refined();
        let mut level: Vec<Option<usize>> = self.level.iter().flat_map(|&l| [l, l]).collect();
        level.resize(mesh.edges().len(), None);
        Self {
            given: vec![false; mesh.edges().len()],
            traffic: vec![0.0; mesh.edges().len()],
            level,
            mesh,
        }
    }

    /// The active edges of one level: with all that is asked of it, or else
    /// without its wishes.
    fn solve(
        &self,
        order: &Order<'_>,
        specification: &Specification,
        rim: &RimFacts,
        last: bool,
        seed: u64,
    ) -> Result<(Problem, Vec<bool>), String> {
        let above: Vec<usize> = (0..self.level.len())
            .filter(|&e| self.level[e].is_some())
            .collect();
        let mut sinks = match specification.sinks {
            Sinks::Streets => Vec::new(),
            Sinks::Boundary | Sinks::At(_) | Sinks::Placed { .. } => rim.sinks.clone(),
        };
        let streets = above.iter().chain(&rim.given);
        sinks.extend(streets.flat_map(|&e| self.mesh.edges()[e]));
        sinks.sort_unstable();
        sinks.dedup();
        let specification = Specification {
            sinks: Sinks::At(sinks),
            rim: network_opt::design::Rim::Closed,
            given: rim.given.iter().chain(&above).copied().collect(),
            ..specification.clone()
        };
        let mut problem = specification.on(&self.mesh).map_err(|e| e.to_string())?;
        let options = order.options;
        self.close_bad_ends(&mut problem, order.scene, order.region);
        self.drop_out_of_reach(&mut problem);
        if !problem.dead_ends {
            self.add_ends(&mut problem, options.ends);
        }
        self.add_bends(&mut problem, options.bends);
        if last {
            self.add_fronts(&mut problem, options.fronts);
        }
        problem.required_vertices = self.continued(&problem, rim);
        let search = |problem: &Problem, moves: u64, start: Option<&Network>| {
            let limits = Limits {
                deadline: None,
                gap: GAP,
                threads: 1,
                seed,
            };
            let search = Search { moves: Some(moves) };
            let outcome = search.solve(problem, start, &limits, &mut |_| true);
            outcome.map(|o| o.network).map_err(|e| e.to_string())
        };
        let first = (options.moves / TRIES).max(1);
        let mut start = search(&problem, first, None)?;
        if start.is_none() {
            // What cannot be kept where the land is too narrow for streets that
            // come back; fronts still ask for it.
            problem.coverage.clear();
            start = search(&problem, first, None)?;
        }
        if start.is_none() {
            problem.required_vertices.clear();
            start = search(&problem, first, None)?;
        }
        let start = start.ok_or_else(|| {
            format!(
                "none was found within {first} moves on {} edges",
                problem.edges()
            )
        })?;
        let best = search(&problem, options.moves, Some(&start))?.unwrap_or(start);
        if (0..best.active.len()).all(|e| !best.active[e] || problem.is_given(e)) {
            return Err("the cheapest one is no street at all".to_owned());
        }
        Ok((problem, best.active))
    }

    /// The parcels of the quads along each edge and along all edges from which
    /// the shortest way to a sink leads over it; `density` parcels a square
    /// metre.
    fn traffic_of(&self, problem: &Problem, active: &[bool], density: f64) -> Vec<f64> {
        let away = distances(problem, active);
        let points = self.mesh.points();
        let mut traffic = vec![0.0; active.len()];
        for (f, face) in self.mesh.faces().iter().enumerate() {
            let own: Vec<usize> = self
                .mesh
                .edges_of(f)
                .iter()
                .copied()
                .filter(|&e| active[e])
                .collect();
            let ring: Vec<_> = face.iter().map(|&v| points[v]).collect();
            let parcels = density * signed_area(&ring).abs() / own.len().max(1) as f64;
            own.iter().for_each(|&e| traffic[e] += parcels);
        }
        // From the farthest vertex on, all that arrives goes the shortest way.
        let mut order: Vec<usize> = (0..points.len())
            .filter(|&v| away[v] > 0.0 && away[v].is_finite())
            .collect();
        order.sort_by(|&v, &w| away[w].total_cmp(&away[v]).then(v.cmp(&w)));
        for v in order {
            let on = |&&(e, w): &&(usize, usize)| {
                active[e] && away[w] + problem.lengths[e] <= away[v] + 1e-9
            };
            let Some(&(next, _)) = self.mesh.around(v).iter().find(on) else {
                continue;
            };
            let arrives =
                |&&(e, w): &&(usize, usize)| e != next && active[e] && (away[w], w) > (away[v], v);
            let sum: f64 = self
                .mesh
                .around(v)
                .iter()
                .filter(arrives)
                .map(|&(e, _)| traffic[e])
                .sum();
            traffic[next] += sum;
        }
        traffic
    }

    /// Which vertices lie on the rim.
    fn on_rim(&self) -> Vec<bool> {
        let mut on_rim = vec![false; self.mesh.points().len()];
        for (ends, rim) in self.mesh.edges().iter().zip(self.mesh.rim()) {
            ends.iter().for_each(|&v| on_rim[v] |= rim);
        }
        on_rim
    }

    /// Takes away what no street can cover: pockets inside where one would end
    /// blind.
    fn drop_out_of_reach(&self, problem: &mut Problem) {
        let on_rim = self.on_rim();
        let around = problem.around();
        let mut open: Vec<bool> = problem
            .states
            .iter()
            .map(|&s| s != EdgeState::Closed)
            .collect();
        if !problem.dead_ends {
            let degree =
                |open: &[bool], v: usize| around[v].iter().filter(|&&(e, _)| open[e]).count();
            let mut queue: Vec<usize> = (0..problem.vertices).collect();
            while let Some(v) = queue.pop() {
                if problem.sinks[v] || on_rim[v] || degree(&open, v) != 1 {
                    continue;
                }
                for &(e, w) in around[v].iter().filter(|&&(e, _)| open[e]) {
                    if !problem.is_given(e) {
                        queue.push(w);
                    }
                }
                for &(e, _) in &around[v] {
                    open[e] &= problem.is_given(e);
                }
            }
        }
        let mut reached = problem.sinks.clone();
        let mut stack: Vec<usize> = (0..problem.vertices).filter(|&v| reached[v]).collect();
        while let Some(v) = stack.pop() {
            for &(e, w) in around[v].iter().filter(|&&(e, _)| open[e]) {
                if !reached[w] && open[e] {
                    reached[w] = true;
                    stack.push(w);
                }
            }
        }
        let usable: Vec<bool> = (0..problem.vertices)
            .map(|v| reached[v] && around[v].iter().any(|&(e, _)| open[e]))
            .collect();
        for row in &mut problem.coverage {
            row.retain(|&v| usable[v]);
        }
        problem.coverage.retain(|row| !row.is_empty());
    }

    /// No street may lead to a place of the rim where none can be built: near
    /// another junction, at a corner, at too sharp an angle. And none may touch
    /// the rim and go on.
    fn close_bad_ends(&self, problem: &mut Problem, scene: &Scene<'_>, region: &Region) {
        let rim: Vec<bool> = self.mesh.rim().collect();
        let points = self.mesh.points();
        let strict = CutMaker::new(scene, region);
        let yielding = CutMaker::new(scene, region).yielding();
        let on_rim = self.on_rim();
        for v in (0..points.len()).filter(|&v| on_rim[v]) {
            let inner: Vec<(usize, usize)> = self
                .mesh
                .around(v)
                .iter()
                .copied()
                .filter(|&(e, _)| !rim[e])
                .collect();
            for &(e, w) in &inner {
                let place = region.place_facing(points[v], points[w]);
                let inward = unit(points[w] - points[v]);
                let can = [&strict, &yielding]
                    .iter()
                    .any(|maker| maker.anchor(&place, inward).is_some());
                if !can && problem.states[e] == EdgeState::Open {
                    problem.states[e] = EdgeState::Closed;
                }
            }
            for (i, &(e, _)) in inner.iter().enumerate() {
                for &(f, _) in &inner[i + 1..] {
                    problem.patterns.push(Pattern {
                        kind: PatternKind::TooClose,
                        active: vec![e, f],
                        inactive: Vec::new(),
                        cost: None,
                    });
                }
            }
        }
    }

    /// Streets may end at the rim, at a price, and nowhere else.
    fn add_ends(&self, problem: &mut Problem, cost: f64) {
        let on_rim = self.on_rim();
        problem.dead_ends = true;
        for v in (0..problem.vertices).filter(|&v| !problem.sinks[v]) {
            let around: Vec<usize> = self.mesh.around(v).iter().map(|&(e, _)| e).collect();
            for &e in &around {
                if problem.states[e] == EdgeState::Closed {
                    continue;
                }
                problem.patterns.push(Pattern {
                    kind: PatternKind::DeadEnd,
                    active: vec![e],
                    inactive: around.iter().copied().filter(|&o| o != e).collect(),
                    cost: on_rim[v].then_some(cost),
                });
            }
        }
    }

    /// Two edges at a vertex that do not go on in line cost something, where
    /// they are the only two.
    fn add_bends(&self, problem: &mut Problem, cost: f64) {
        if cost == 0.0 {
            return;
        }
        let points = self.mesh.points();
        for v in 0..points.len() {
            let around = self.mesh.around(v);
            for (i, &(a, to)) in around.iter().enumerate() {
                for &(b, other) in &around[i + 1..] {
                    let between = angle(
                        unit(points[to] - points[v]),
                        unit(points[other] - points[v]),
                    );
                    let closed = [a, b]
                        .iter()
                        .any(|&e| problem.states[e] == EdgeState::Closed);
                    if closed || between.to_degrees() > BEND_DEG {
                        continue;
                    }
                    let rest = around.iter().map(|&(e, _)| e).filter(|&e| e != a && e != b);
                    problem.patterns.push(Pattern {
                        kind: PatternKind::ZigZag,
                        active: vec![a, b],
                        inactive: rest.collect(),
                        cost: Some(cost),
                    });
                }
            }
        }
    }

    /// A quad along which no street runs costs something: its parcels would
    /// lie behind others.
    fn add_fronts(&self, problem: &mut Problem, cost: f64) {
        if cost == 0.0 {
            return;
        }
        for f in 0..self.mesh.faces().len() {
            let sides = self.mesh.edges_of(f);
            let open = sides.iter().any(|&e| problem.states[e] == EdgeState::Open);
            let given = sides.iter().any(|&e| problem.is_given(e));
            if open && !given {
                problem.patterns.push(Pattern {
                    kind: PatternKind::TooClose,
                    active: Vec::new(),
                    inactive: sides.to_vec(),
                    cost: Some(cost),
                });
            }
        }
    }

    /// Entries that streets must continue: those that can be, and are not next
    /// to each other.
    fn continued(&self, problem: &Problem, rim: &RimFacts) -> Vec<usize> {
        let mut chosen: Vec<usize> = Vec::new();
        for &v in &rim.entries {
            let around = self.mesh.around(v);
            let open = around
                .iter()
                .any(|&(e, _)| problem.states[e] == EdgeState::Open);
            let near = self.mesh.ball(v, APART);
            if open && !chosen.iter().any(|c| near.contains(c)) {
                chosen.push(v);
            }
        }
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::polygon;
    use network_opt::design::{Feature, Rim};
    use network_opt::quad::{quads, QuadOptions};

    /// 6 by 4 quads of 10 m.
    fn web() -> Web {
        let rectangle = polygon![
            (x: 0.0, y: 0.0), (x: 60.0, y: 0.0), (x: 60.0, y: 40.0), (x: 0.0, y: 40.0)
        ];
        let options = QuadOptions {
            edge_length: 10.0,
            ..QuadOptions::default()
        };
        let mesh = quads(&rectangle, &options).expect("quads");
        Web {
            level: vec![None; mesh.edges().len()],
            given: vec![false; mesh.edges().len()],
            traffic: vec![0.0; mesh.edges().len()],
            mesh,
        }
    }

    fn vertex(web: &Web, x: f64, y: f64) -> usize {
        let near = |p: &geo_types::Coord<f64>| (p.x - x).hypot(p.y - y) < 1e-6;
        web.mesh.points().iter().position(near).expect("a vertex")
    }

    fn problem(web: &Web) -> Problem {
        let specification = Specification {
            rim: Rim::Closed,
            too_close: Feature::Free,
            zig_zags: Feature::Free,
            sinks: Sinks::At(vec![vertex(web, 0.0, 20.0)]),
            ..Specification::default()
        };
        specification.on(&web.mesh).expect("fits")
    }

    /// A street along the middle: all that its twelve quads hold passes its
    /// first edge, a sixth of it starts at the last.
    #[test]
    fn traffic_adds_up_towards_the_way_out() {
        let web = web();
        let problem = problem(&web);
        let at = |k: usize| vertex(&web, 10.0 * k as f64, 20.0);
        let street: Vec<usize> = (0..6)
            .map(|k| web.mesh.edge_between(at(k), at(k + 1)).expect("an edge"))
            .collect();
        let active: Vec<bool> = (0..problem.edges()).map(|e| street.contains(&e)).collect();
        // One parcel in 100 m2: one a quad, two an edge.
        let traffic = web.traffic_of(&problem, &active, 0.01);
        for (k, &e) in street.iter().enumerate() {
            let wanted = 2.0 * (6 - k) as f64;
            assert!((traffic[e] - wanted).abs() < 1e-9, "{k}: {}", traffic[e]);
        }
        assert!((0..active.len()).all(|e| active[e] || traffic[e] == 0.0));
    }

    /// Of 24 quads the 12 in the middle rows have a front once the street is
    /// there, and each of the others costs; a given street counts as one.
    #[test]
    fn fronts_are_of_quads_without_a_street() {
        let web = web();
        let mut problem = problem(&web);
        let before = problem.patterns.len();
        web.add_fronts(&mut problem, 2.0);
        assert_eq!(problem.patterns.len() - before, 24);
        let given = web
            .mesh
            .edge_between(vertex(&web, 0.0, 20.0), vertex(&web, 10.0, 20.0))
            .expect("an edge");
        problem.patterns.truncate(before);
        problem.states[given] = EdgeState::Given;
        web.add_fronts(&mut problem, 2.0);
        assert_eq!(problem.patterns.len() - before, 22);
        problem.patterns.truncate(before);
        web.add_fronts(&mut problem, 0.0);
        assert_eq!(problem.patterns.len(), before);
    }

    /// Each inner vertex has a pattern for each of its four edges, forbidden;
    /// each on the rim one for its edge inwards, at a price; the sink has none.
    #[test]
    fn streets_end_at_the_rim_alone() {
        let web = web();
        let mut problem = problem(&web);
        let before = problem.patterns.len();
        web.add_ends(&mut problem, 0.5);
        let new = &problem.patterns[before..];
        let forbidden = new.iter().filter(|p| p.cost.is_none()).count();
        // 5 by 3 vertices inside; 20 on the rim, 4 of them corners.
        assert_eq!(forbidden, 15 * 4);
        assert_eq!(new.len() - forbidden, 20 - 4 - 1);
        assert!(problem.dead_ends);
    }

    /// With dead ends forbidden a vertex that only one open edge reaches is out
    /// of reach, and what it alone covers is no longer asked.
    #[test]
    fn pockets_are_not_to_be_covered() {
        let web = web();
        let mut problem = problem(&web);
        let corner = vertex(&web, 10.0, 10.0);
        for &(e, w) in web.mesh.around(corner) {
            if w != vertex(&web, 20.0, 10.0) {
                problem.states[e] = EdgeState::Closed;
            }
        }
        problem.coverage = vec![vec![corner], vec![corner, vertex(&web, 20.0, 10.0)]];
        web.drop_out_of_reach(&mut problem);
        assert_eq!(problem.coverage, [vec![vertex(&web, 20.0, 10.0)]]);
    }
}
