//! Laws of graphs, demand, assignment and SUMO's files.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{config, grid};
use network_opt::design::{verify, Coverage, Feature, Problem, Specification};
use network_opt::geo_types::{coord, Coord};
use network_opt::solve::{Limits, NetworkSolver, Stochastic};
use network_opt::traffic::sumo::{is_installed, SumoFiles, SumoOptions};
use network_opt::traffic::{
    assign, Assignment, Demand, EquilibriumOptions, Flow, Link, NodingOptions, Road, RoadClass,
    StreetGraph, Traffic, TrafficError,
};
use proptest::prelude::*;

/// A tree of two-way streets, so that all is connected, with more streets of
/// either kind; lengths are no round numbers, so that no two ways are equal.
fn graphs() -> impl Strategy<Value = StreetGraph> {
    (2_usize..12).prop_flat_map(|n| {
        let offset = (0.0..900.0, 0.0..900.0);
        let parent = prop::collection::vec(0.0..1.0_f64, n - 1);
        let more = prop::collection::vec((0..n, 0..n, 0..4_usize, any::<bool>()), 0..2 * n);
        (prop::collection::vec(offset, n), parent, more).prop_map(|(offsets, parents, more)| {
            let mut graph = StreetGraph::default();
            for (k, (x, y)) in offsets.into_iter().enumerate() {
                // Each in a square of its own, so that no two are at one place;
                // strategies like round numbers, which make ways equal.
                let (column, row) = ((k % 4) as f64, (k / 4) as f64);
                let shift = |root: f64| 50.0 * (root * (k + 1) as f64).fract();
                graph.add_node(coord! {
                    x: 1000.0 * column + x + shift(2.0_f64.sqrt()),
                    y: 1000.0 * row + y + shift(3.0_f64.sqrt())
                });
            }
            for (k, share) in parents.into_iter().enumerate() {
                let parent = (share * (k + 1) as f64) as usize;
                graph.add_street(k + 1, parent, 2, true).unwrap();
            }
            for (a, b, class, both) in more.into_iter().filter(|more| more.0 != more.1) {
                graph.add_street(a, b, class, both).unwrap();
            }
            graph
        })
    })
}

fn demands(nodes: usize) -> impl Strategy<Value = Demand> {
    let flow = (0..nodes, 0..nodes, 0.0..300.0_f64).prop_map(|(from, to, per_hour)| Flow {
        from,
        to,
        per_hour,
    });
    prop::collection::vec(flow, 0..20).prop_map(|flows| Demand { flows })
}

fn cases() -> impl Strategy<Value = (StreetGraph, Demand)> {
    graphs().prop_flat_map(|graph| {
        let nodes = graph.nodes.len();
        (Just(graph), demands(nodes))
    })
}

/// Times of all pairs by Floyd and Warshall, and metres of the quickest ways.
fn all_pairs(graph: &StreetGraph) -> Vec<Vec<(f64, f64)>> {
    let n = graph.nodes.len();
    let mut best = vec![vec![(f64::INFINITY, f64::INFINITY); n]; n];
    for (k, row) in best.iter_mut().enumerate() {
        row[k] = (0.0, 0.0);
    }
    for link in &graph.links {
        let way = (link.free_time(), link.length);
        if way < best[link.from][link.to] {
            best[link.from][link.to] = way;
        }
    }
    for k in 0..n {
        for i in 0..n {
            for j in 0..n {
                let (a, b) = (best[i][k], best[k][j]);
                let way = (a.0 + b.0, a.1 + b.1);
                if way < best[i][j] {
                    best[i][j] = way;
                }
            }
        }
    }
    best
}

/// What leaves a node less what reaches it is what starts there less what ends
/// there. Sums of some dozen numbers up to 6,000: 1e-9 of that.
fn conserves(graph: &StreetGraph, demand: &Demand, traffic: &Traffic) -> Result<(), TestCaseError> {
    let mut left = vec![0.0; graph.nodes.len()];
    for (link, v) in graph.links.iter().zip(&traffic.vehicles) {
        prop_assert!(*v >= 0.0);
        left[link.from] += v;
        left[link.to] -= v;
    }
    for f in &demand.flows {
        left[f.from] -= f.per_hour;
        left[f.to] += f.per_hour;
    }
    prop_assert!(left.iter().all(|l| l.abs() < 1e-5), "{left:?}");
    Ok(())
}

proptest! {
    #![proptest_config(config(60))]

    #[test]
    fn shortest_ways_carry_the_demand((graph, demand) in cases()) {
        let traffic = assign(&graph, &demand, &Assignment::ShortestTime).unwrap();
        conserves(&graph, &demand, &traffic)?;
        let best = all_pairs(&graph);
        let sum = |of: &dyn Fn((f64, f64)) -> f64| -> f64 {
            demand.flows.iter().map(|f| f.per_hour * of(best[f.from][f.to])).sum()
        };
        // Sums in another order: 1e-9 of totals below 10^8.
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(1.0);
        prop_assert!(near(traffic.total_time(), sum(&|way| way.0)));
        prop_assert!(near(traffic.total_distance(), sum(&|way| way.1)));
    }

    /// Other numbers of nodes, links in another order: the same traffic.
    #[test]
    fn relabelling_changes_nothing((graph, demand) in cases(), turn in 0..100_usize) {
        let n = graph.nodes.len();
        let to = |node: usize| (n - 1 - node + turn) % n;
        let mut other = StreetGraph { links: Vec::new(), ..graph.clone() };
        for (node, at) in graph.nodes.iter().enumerate() {
            other.nodes[to(node)] = *at;
        }
        let last = graph.links.len().saturating_sub(1);
        for link in graph.links.iter().rev() {
            let mut link = link.clone();
            (link.from, link.to) = (to(link.from), to(link.to));
            link.reverse = link.reverse.map(|r| last - r);
            other.links.push(link);
        }
        let turned = Demand {
            flows: demand.flows.iter().rev().map(|f| Flow { from: to(f.from), to: to(f.to), ..*f }).collect(),
        };
        let how = Assignment::ShortestTime;
        let (a, b) = (assign(&graph, &demand, &how).unwrap(), assign(&other, &turned, &how).unwrap());
        prop_assert!((a.mean_distance - b.mean_distance).abs() <= 1e-9 * a.mean_distance.max(1.0));
        prop_assert!((a.mean_time - b.mean_time).abs() <= 1e-9 * a.mean_time.max(1.0));
        for (l, v) in a.vehicles.iter().enumerate() {
            // Streets of the same speed between the same places are equal.
            let same = |o: &Link, p: &Link| (o.from, o.to) == (p.from, p.to) && o.speed == p.speed;
            let own = &graph.links[l];
            let twin = graph.links.iter().enumerate().any(|(k, o)| k != l && same(o, own));
            prop_assert!(twin || (v - b.vehicles[last - l]).abs() < 1e-5);
        }
    }

    /// Wardrop's first principle, to within the gap: all drivers together are no
    /// more than that part quicker by the quickest ways; and what Beckmann's
    /// function is over its bound never grows.
    #[test]
    fn equilibria_are_equilibria((graph, demand) in cases()) {
        let options = EquilibriumOptions { gap: 1e-3, ..EquilibriumOptions::default() };
        let busy = demand.scaled(4.0);
        let traffic = assign(&graph, &busy, &Assignment::Equilibrium(options)).unwrap();
        conserves(&graph, &busy, &traffic)?;
        let found = traffic.equilibrium.clone().unwrap();
        prop_assert!(found.relative_gap <= 1e-3, "{found:?}");
        prop_assert!(found.gaps.windows(2).all(|w| w[1] <= w[0] + 1e-12), "{found:?}");
        let mut slow = graph.clone();
        for (link, time) in slow.links.iter_mut().zip(&traffic.times) {
            link.speed = link.length / time;
        }
        let best = all_pairs(&slow);
        let quick: f64 = busy.flows.iter().map(|f| f.per_hour * best[f.from][f.to].0).sum();
        prop_assert!(traffic.total_time() * (1.0 - 1e-3) <= quick * (1.0 + 1e-9));
        prop_assert!(quick <= traffic.total_time() * (1.0 + 1e-9));
    }

    /// A graph of any roads is sound, and as long as they are unless they run on
    /// top of each other.
    #[test]
    fn roads_make_sound_graphs(
        lines in prop::collection::vec(prop::collection::vec((0..40_i32, 0..40_i32), 2..5), 1..8),
        pieces in prop_oneof![Just(0.0), 30.0..500.0],
        one_way in any::<bool>(),
    ) {
        let roads: Vec<Road> = lines
            .iter()
            .enumerate()
            .map(|(k, line)| Road {
                line: line.iter().map(|&(x, y)| coord! { x: 10.0 * f64::from(x), y: 10.0 * f64::from(y) }).collect(),
                class: k % 4,
                one_way,
            })
            .collect();
        let options = NodingOptions { pieces, ..NodingOptions::default() };
        match StreetGraph::from_roads(&roads, &RoadClass::paper(), &options) {
            Ok(graph) => {
                graph.check().unwrap();
                prop_assert!(pieces == 0.0 || graph.links.iter().all(|l| l.length <= pieces * (1.0 + 1e-9)));
                let step = |w: &[Coord<f64>]| (w[1].x - w[0].x).hypot(w[1].y - w[0].y);
                let length: f64 = roads.iter().flat_map(|r| r.line.0.windows(2).map(step)).sum();
                // Snapping moves points by up to 0.01.
                prop_assert!(graph.street_length() <= length * 1.001 + 1.0);
                prop_assert!(graph.links.iter().all(|l| l.reverse.is_none() == one_way));
            }
            // Lines without any length.
            Err(TrafficError::Linework(_)) => {
                let still = |line: &Vec<(i32, i32)>| line.iter().all(|p| *p == line[0]);
                prop_assert!(lines.iter().all(still));
            }
            Err(e) => prop_assert!(false, "{e}"),
        }
    }

    /// A reader of XML gets back every name, whatever is in it, and finds every
    /// node, edge and trip.
    #[test]
    fn files_are_xml((graph, demand) in cases(), names in prop::collection::vec(any::<String>(), 1..30), class in any::<String>()) {
        let mut graph = graph;
        graph.classes.iter_mut().for_each(|c| c.name = class.clone());
        let trips = demand.trips(0.1, 1).unwrap();
        let options = SumoOptions { road_names: names.clone(), ..SumoOptions::default() };
        let made = SumoFiles::new(&graph, &trips, &options).unwrap();
        for (name, text) in made.files() {
            let document = roxmltree::Document::parse(text).unwrap_or_else(|e| panic!("{name}: {e}\n{text}"));
            let of = |tag: &'static str| document.descendants().filter(move |n| n.has_tag_name(tag));
            if name.ends_with(".nod.xml") {
                prop_assert_eq!(of("node").count(), graph.nodes.len());
            } else if name.ends_with(".trips.xml") {
                prop_assert_eq!(of("trip").count(), trips.len());
            } else if name.ends_with(".edg.xml") {
                for (edge, link) in of("edge").zip(&graph.links) {
                    // Control characters have no place in XML.
                    let plain = |c: char| if matches!(c, '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}') && !"\t\n\r".contains(c) { '?' } else { c };
                    let wanted: String = names.get(link.road).unwrap_or(&class).chars().map(plain).collect();
                    prop_assert_eq!(edge.attribute("name"), Some(wanted.as_str()));
                }
                prop_assert_eq!(of("edge").count(), graph.links.len());
            }
        }
    }
}

/// Pigou's two ways: one of 20 s whatever the traffic, one of 10 s that is slower
/// with it. Drivers take the second until it is as slow as the first: 10 (1 +
/// 0.15 (v / 100)^4) = 20 at v = 100 (1 / 0.15)^(1/4) = 160.685 vehicles an hour.
#[test]
fn pigou() {
    let mut graph = StreetGraph::default();
    let (a, b) = (
        graph.add_node(coord! { x: 0., y: 0. }),
        graph.add_node(coord! { x: 100., y: 0. }),
    );
    let slow = graph.add_street(a, b, 0, false).unwrap();
    let quick = graph.add_street(a, b, 0, false).unwrap();
    for (link, seconds, capacity) in [(slow, 20.0, f64::INFINITY), (quick, 10.0, 100.0)] {
        graph.links[link].speed = graph.links[link].length / seconds;
        graph.links[link].capacity = capacity;
    }
    let options = EquilibriumOptions {
        gap: 1e-9,
        ..EquilibriumOptions::default()
    };
    let share = 100.0 * (1.0_f64 / 0.15).powf(0.25);
    assert!((share - 160.685).abs() < 1e-3);
    let how = Assignment::Equilibrium(options);
    let busy = assign(&graph, &Demand::pairs(&[(a, b)], 500.0), &how).unwrap();
    assert!((busy.vehicles[quick] - share).abs() < 1e-3, "{busy:?}");
    assert!((busy.times[quick] - 20.0).abs() < 1e-4 && (busy.mean_time - 20.0).abs() < 1e-4);
    // Fifty times the capacity on one way: tangents there are far below zero.
    let jam = assign(&graph, &Demand::pairs(&[(a, b)], 5000.0), &how).unwrap();
    let gaps = jam.equilibrium.unwrap().gaps;
    assert!(gaps.iter().all(|gap| (0.0..=1.0).contains(gap)), "{gaps:?}");
    assert!(gaps.windows(2).all(|w| w[1] <= w[0] + 1e-12), "{gaps:?}");
    // With less all take the quick one.
    let calm = assign(&graph, &Demand::pairs(&[(a, b)], 150.0), &how).unwrap();
    assert!((calm.vehicles[quick] - 150.0).abs() < 1e-6);
    assert!(calm.times[quick] < 20.0);
}

/// Braess's paradox: a new street makes everyone slower. Ways 0-1-3 and 0-2-3
/// of two links each, one of a s + v / 10 and one of 45 s; 400 vehicles an hour.
/// Half of them each way without the link from 1 to 2: a + 20 + 45. With it, of
/// no more than e s, all want 0-1-2-3 as long as a + 40 + e < 45: 2 a + 80 + e.
#[test]
fn braess() {
    let (small, bridge) = (0.01, 0.5);
    let build = |with_bridge: bool| {
        let mut graph = StreetGraph::default();
        for (x, y) in [(0., 0.), (100., 90.), (100., -90.), (200., 0.)] {
            graph.add_node(coord! { x: x, y: y });
        }
        let mut link = |from, to, seconds: f64, slope: f64| {
            let l = graph.add_street(from, to, 0, false).unwrap();
            graph.links[l].speed = graph.links[l].length / seconds;
            // t = t0 + t0 / c v for alpha = beta = 1.
            graph.links[l].capacity = if slope > 0.0 {
                seconds / slope
            } else {
                f64::INFINITY
            };
        };
        link(0, 1, small, 0.1);
        link(1, 3, 45.0, 0.0);
        link(0, 2, 45.0, 0.0);
        link(2, 3, small, 0.1);
        if with_bridge {
            link(1, 2, bridge, 0.0);
        }
        graph
    };
    let how = Assignment::Equilibrium(EquilibriumOptions {
        alpha: 1.0,
        beta: 1.0,
        gap: 1e-10,
        ..EquilibriumOptions::default()
    });
    let demand = Demand::pairs(&[(0, 3)], 400.0);
    let without = assign(&build(false), &demand, &how).unwrap();
    let with = assign(&build(true), &demand, &how).unwrap();
    assert!(
        (without.mean_time - (small + 20.0 + 45.0)).abs() < 1e-6,
        "{without:?}"
    );
    assert!((without.vehicles[0] - 200.0).abs() < 1e-4);
    assert!(
        (with.mean_time - (2.0 * small + 80.0 + bridge)).abs() < 1e-6,
        "{with:?}"
    );
    assert!((with.vehicles[4] - 400.0).abs() < 1e-4);
}

/// A square kilometre of blocks of 50 m with trips from every corner takes
/// milliseconds; a second on a busy machine is far more than that.
#[test]
fn a_square_kilometre_is_quick() {
    let line = |k: i32, across: bool| {
        let at = 50.0 * f64::from(k);
        let ends = if across {
            [(at, 0.0), (at, 1000.0)]
        } else {
            [(0.0, at), (1000.0, at)]
        };
        Road {
            line: ends.to_vec().into(),
            class: if k % 5 == 0 { 1 } else { 2 },
            one_way: false,
        }
    };
    let roads: Vec<Road> = (0..=20)
        .flat_map(|k| [line(k, true), line(k, false)])
        .collect();
    let graph =
        StreetGraph::from_roads(&roads, &RoadClass::paper(), &NodingOptions::default()).unwrap();
    assert_eq!((graph.nodes.len(), graph.links.len()), (441, 1680));
    let all: Vec<usize> = (0..graph.nodes.len()).collect();
    let rim: Vec<usize> = all
        .iter()
        .copied()
        .filter(|&n| {
            [graph.nodes[n].x, graph.nodes[n].y]
                .iter()
                .any(|x| !(1.0..=999.0).contains(x))
        })
        .collect();
    let began = std::time::Instant::now();
    let out = Demand::to_nearest(&graph, &all, &rim, 250.0).unwrap();
    let traffic = assign(&graph, &out, &Assignment::ShortestTime).unwrap();
    assert!((traffic.trips - 250.0).abs() < 1e-9);
    assert!(began.elapsed().as_secs_f64() < 1.0, "{:?}", began.elapsed());
}

/// What SUMO measures on a single street is what was predicted: 1,000 m, but for
/// the few metres of a junction, at 30 mph with time to get up to speed.
#[test]
fn sumo_agrees_on_a_single_street() {
    if !is_installed() {
        eprintln!("SUMO is not installed; nothing was simulated");
        return;
    }
    let mut graph = StreetGraph::default();
    for k in 0..=10 {
        graph.add_node(coord! { x: 100.0 * f64::from(k), y: 5.0 });
    }
    for k in 0..10 {
        graph.add_street(k, k + 1, 1, true).unwrap();
    }
    let demand = Demand::pairs(&[(0, 10), (10, 0)], 120.0);
    let predicted = assign(&graph, &demand, &Assignment::ShortestTime).unwrap();
    let options = SumoOptions {
        road_names: vec!["<\"&'>\u{1}".to_owned(); 3],
        ..SumoOptions::default()
    };
    let made = SumoFiles::new(&graph, &demand.trips(0.5, 3).unwrap(), &options).unwrap();
    let folder = std::env::temp_dir().join(format!("network-opt-sumo-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let found = made.simulate(&folder, &[1, 2]);
    std::fs::remove_dir_all(&folder).unwrap();
    let found = found.unwrap();
    assert!(found
        .runs
        .iter()
        .all(|run| run.arrived == run.wanted && run.wanted > 50));
    let ratio = found.mean_distance / predicted.mean_distance;
    assert!((0.98..1.02).contains(&ratio), "{ratio}");
    let ratio = found.mean_time / predicted.mean_time;
    assert!((0.9..1.3).contains(&ratio), "{ratio}");
}

/// Sides of a grid and what is asked of it.
fn problems() -> impl Strategy<Value = Problem> {
    let feature = || {
        prop_oneof![
            Just(Feature::Free),
            Just(Feature::Forbidden),
            Just(Feature::Weighted(2.0))
        ]
    };
    (
        2_usize..5,
        2_usize..5,
        1_usize..3,
        feature(),
        feature(),
        feature(),
        0.0..2.0_f64,
    )
        .prop_map(
            |(wide, high, hops, dead_ends, zig_zags, too_close, travel)| {
                let spec = Specification {
                    coverage: Coverage::Hops(hops),
                    dead_ends,
                    zig_zags,
                    too_close,
                    travel,
                    ..Specification::default()
                };
                spec.on(&grid(wide, high)).unwrap()
            },
        )
}

proptest! {
    #![proptest_config(config(20))]

    /// What the stochastic search of section 5.4 answers is valid, costs what it
    /// says, and is the same again.
    #[test]
    fn the_baseline_answers_valid_networks(problem in problems(), seed in any::<u64>()) {
        let limits = Limits { deadline: None, seed, ..Limits::default() };
        let solver = Stochastic { passes: Some(1), steps: 40, ..Stochastic::default() };
        let found = solver.solve(&problem, None, &limits, &mut |_| true).unwrap();
        if let Some(network) = &found.network {
            prop_assert_eq!(verify(&problem, network), []);
            let cost = network_opt::design::cost(&problem, &network.active);
            prop_assert_eq!(cost, found.cost);
        }
        let again = solver.solve(&problem, None, &limits, &mut |_| true).unwrap();
        prop_assert_eq!(found.network, again.network);
    }
}
