//! The streets of finished levels as roads, and where their traffic leaves.

use geo_types::{Coord, LineString};

use super::graph::{distance, StreetGraph};
use super::noding::Road;
use crate::design::{Network, Streets, Way};
use crate::levels::{Level, Street};

/// The roads of a network that was designed in levels: what was given from the
/// start (such as the boundary) is of class 0, the streets of each level of the
/// classes after it, the last of which takes the levels that are left. So the
/// classes of [`RoadClass::paper`](super::RoadClass::paper) fit. All are for
/// both ways.
#[must_use]
pub fn roads_of(levels: &[Level], streets: &[Street], classes: usize) -> Vec<Road> {
    let road = |line: LineString<f64>, class: usize, one_way: bool| Road {
        line,
        class: class.min(classes.saturating_sub(1)),
        one_way,
    };
    let mut roads: Vec<Road> = streets
        .iter()
        .map(|street| road(street.line.clone(), street.level + 1, street.one_way))
        .collect();
    let Some(first) = levels.first() else {
        return roads;
    };
    let none = Network::default();
    let network = Streets::from(first.outcome.network.as_ref().unwrap_or(&none));
    let mut both_ways = Vec::new();
    for e in (0..first.problem.edges()).filter(|&e| first.problem.is_given(e)) {
        let [a, b] = first.mesh.edges()[e].map(|v| first.mesh.points()[v]);
        match network.way(&first.problem, e) {
            Way::Both | Way::Either => both_ways.push([a, b]),
            Way::Forward => roads.push(road(vec![a, b].into(), 0, true)),
            Way::Backward => roads.push(road(vec![b, a].into(), 0, true)),
        }
    }
    let lines = chained(both_ways).into_iter();
    roads.extend(lines.map(|line| road(line, 0, false)));
    roads
}

/// Segments that meet end to end as lines; where three or more meet lines end.
fn chained(segments: Vec<[Coord<f64>; 2]>) -> Vec<LineString<f64>> {
    let key = |p: Coord<f64>| (p.x.to_bits(), p.y.to_bits());
    let mut at = std::collections::BTreeMap::<(u64, u64), Vec<usize>>::new();
    for (s, ends) in segments.iter().enumerate() {
        ends.iter()
            .for_each(|&p| at.entry(key(p)).or_default().push(s));
    }
    let mut used = vec![false; segments.len()];
    let mut lines = Vec::new();
    // From places that are no mere passage first, then rings.
    for pass in 0..2 {
        for s in 0..segments.len() {
            for turn in 0..2 {
                let start = segments[s][turn];
                if used[s] || pass == 0 && at[&key(start)].len() == 2 {
                    continue;
                }
                let mut line = vec![start];
                let mut here = (s, segments[s][1 - turn]);
                loop {
                    used[here.0] = true;
                    line.push(here.1);
                    let next = match at[&key(here.1)][..] {
                        [a, b] => [a, b].into_iter().find(|&n| !used[n]),
                        _ => None,
                    };
                    let Some(next) = next else { break };
                    let [a, b] = segments[next];
                    here = (next, if a == here.1 { b } else { a });
                }
                lines.push(line.into());
            }
        }
    }
    lines
}

/// The nodes where traffic leaves: those at the sinks of the first level, those
/// that were placed among them. Where sinks lie side by side on its mesh, as along the boundary, all nodes between
/// them; for a sink alone the nearest node.
///
/// `reach` is how far off a node may be from the line between two sinks, metres.
#[must_use]
pub fn exits(graph: &StreetGraph, levels: &[Level], reach: f64) -> Vec<usize> {
    let Some(first) = levels.first() else {
        return Vec::new();
    };
    let mesh = &first.mesh;
    let mut sinks = first.problem.sinks.clone();
    let placed = first.outcome.network.iter().flat_map(|n| &n.sinks);
    placed.for_each(|&v| sinks[v] = true);
    let rim: Vec<bool> = mesh.rim().collect();
    let mut found = Vec::new();
    let mut alone = sinks.clone();
    for (e, &[a, b]) in mesh.edges().iter().enumerate() {
        // Two sinks on the rim may be joined by an edge through the site.
        if !(sinks[a] && sinks[b] && (rim[e] || first.problem.is_given(e))) {
            continue;
        }
        (alone[a], alone[b]) = (false, false);
        let (p, q) = (mesh.points()[a], mesh.points()[b]);
        let along = graph.nodes.iter().enumerate();
        found.extend(
            along
                .filter(|(_, &n)| off(n, p, q) <= reach)
                .map(|(n, _)| n),
        );
    }
    for (v, _) in alone.iter().enumerate().filter(|(_, &alone)| alone) {
        let at = mesh.points()[v];
        let nearest = (0..graph.nodes.len())
            .min_by(|&a, &b| distance(graph.nodes[a], at).total_cmp(&distance(graph.nodes[b], at)));
        found.extend(nearest);
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// How far a point is from a segment.
fn off(p: Coord<f64>, a: Coord<f64>, b: Coord<f64>) -> f64 {
    let (ab, ap) = (b - a, p - a);
    let square = ab.x * ab.x + ab.y * ab.y;
    let along = if square > 0.0 {
        ((ap.x * ab.x + ap.y * ab.y) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    distance(p, a + ab * along)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Sinks, Specification, Tessellation};
    use crate::levels::{design_levels, streets};
    use crate::snake::SnakeOptions;
    use crate::solve::{Limits, Search};
    use crate::traffic::{NodingOptions, RoadClass};

    /// Streets after snakes meet at shared points, and end on the rim: a graph
    /// of two levels is in one piece, with an exit for each street at the rim.
    #[test]
    fn levels_become_one_graph() {
        let limits = Limits {
            deadline: None,
            ..Limits::default()
        };
        let second = Specification {
            sinks: Sinks::Streets,
            ..Specification::default()
        };
        let wanted = [Specification::default(), second];
        let search = Search { moves: Some(2000) };
        let mesh = Tessellation::grid(6, 6);
        let levels = design_levels(mesh, &wanted, &search, &limits, &mut |_| true).expect("fits");
        let streets = streets(&levels, &SnakeOptions::default()).expect("smooth");
        let roads = roads_of(&levels, &streets, 4);
        let rim: Vec<_> = roads.iter().filter(|r| r.class == 0).collect();
        assert_eq!(rim.len(), 1);
        assert!(rim[0].line.is_closed());
        let snap = NodingOptions {
            snap: 1e-4,
            ..NodingOptions::default()
        };
        let graph = StreetGraph::from_roads(&roads, &RoadClass::paper(), &snap).expect("joins");
        graph.check().expect("sound");
        let length: f64 = roads
            .iter()
            .flat_map(|r| r.line.0.windows(2).map(|w| distance(w[0], w[1])))
            .sum();
        assert!((graph.street_length() - length).abs() < 1e-2 * length);
        let exits = exits(&graph, &levels, 1e-3);
        let on_rim = |n: usize| graph.links.iter().any(|l| l.class == 0 && l.from == n);
        assert!(exits.len() > 1 && exits.iter().all(|&n| on_rim(n)));
        let all: Vec<usize> = (0..graph.nodes.len()).collect();
        crate::traffic::Demand::to_nearest(&graph, &all, &exits, 1.0).expect("all get out");
    }

    #[test]
    fn segments_chain() {
        let p = |x: f64, y: f64| Coord { x, y };
        let lines = chained(vec![
            [p(1., 0.), p(2., 0.)],
            [p(1., 0.), p(0., 0.)],
            [p(2., 0.), p(3., 1.)],
            [p(2., 0.), p(3., -1.)],
        ]);
        let sizes: Vec<usize> = lines.iter().map(|l| l.0.len()).collect();
        assert_eq!(sizes, [3, 2, 2]);
        assert!(chained(vec![]).is_empty());
    }
}
