//! Laws of traffic types: parts, paths, and what specifications make of them.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::collections::BTreeSet;

use common::{config, grid, part_of_grid, search};
use network_opt::design::{
    check_partition, partition, paths_between, verify, Across, Among, Feature, Inside, Pairs,
    Parts, PathOptions, Place, PlacedSinks, Problem, Rim, Route, RouteKind, Sinks, Specification,
    Tessellation, Traffic,
};
use network_opt::mip::Microlp;
use network_opt::solve::{conflicts, Constraints, Limits, Outcome};
use proptest::prelude::*;

/// All simple paths of at most so many edges, by extending every walk.
fn every_path(
    mesh: &Tessellation,
    open: &[bool],
    from: usize,
    to: usize,
    most: usize,
) -> Vec<Vec<usize>> {
    let mut found = Vec::new();
    let mut walks = vec![(vec![from], Vec::new())];
    while let Some((met, path)) = walks.pop() {
        let at = met[met.len() - 1];
        if at == to {
            found.push(path);
            continue;
        }
        for (e, &[a, b]) in mesh.edges().iter().enumerate() {
            let next = if a == at { b } else { a };
            if open[e] && (a == at || b == at) && !met.contains(&next) && path.len() < most {
                let (mut met, mut path): (Vec<usize>, Vec<usize>) = (met.clone(), path.clone());
                met.push(next);
                path.push(e);
                walks.push((met, path));
            }
        }
    }
    found
}

proptest! {
    #![proptest_config(config(60))]

    /// Parts cover all faces, each connected, none empty; the same for the same
    /// seed. What is not connected has no fewer parts than pieces.
    #[test]
    fn parts_are_connected_and_cover(
        size in (1_usize..8, 1_usize..8),
        gone in prop::collection::vec(prop::bool::weighted(0.2), 64),
        count in 1_usize..12,
        seed in any::<u64>(),
    ) {
        prop_assume!((0..size.0 * size.1).any(|f| !gone[f]));
        let mesh = part_of_grid(size.0, size.1, &|f| !gone[f]);
        let faces = mesh.faces().len();
        match partition(&mesh, count, seed) {
            Ok(parts) => {
                prop_assert_eq!(&check_partition(&mesh, &parts), &Ok(parts.clone()));
                let names: BTreeSet<usize> = parts.iter().copied().collect();
                prop_assert!(names.into_iter().eq(0..count));
                prop_assert_eq!(partition(&mesh, count, seed), Ok(parts));
            }
            Err(_) => {
                // Too many parts, or too few: as many as faces is never that.
                prop_assert!(count > faces || partition(&mesh, faces, seed).is_ok());
            }
        }
    }

    /// The paths listed are those that extending every walk finds.
    #[test]
    fn paths_are_all_paths(
        size in (1_usize..4, 1_usize..4),
        closed in prop::collection::vec(prop::bool::weighted(0.2), 24),
        ends in (0_usize..16, 0_usize..16),
        tolerance in 0_usize..5,
        most in 1_usize..40,
        seed in any::<u64>(),
    ) {
        let mesh = grid(size.0, size.1);
        let n = mesh.points().len();
        let (a, b) = (ends.0 % n, ends.1 % n);
        let open: Vec<bool> = (0..mesh.edges().len()).map(|e| !closed[e]).collect();
        let all = PathOptions { tolerance, most: usize::MAX, seed };
        let mut found = paths_between(&mesh, &open, [a, b], &all);
        let everything = every_path(&mesh, &open, a, b, n);
        let shortest = everything.iter().map(Vec::len).min().unwrap_or(0);
        let mut wanted: Vec<Vec<usize>> = everything.into_iter()
            .filter(|path| !path.is_empty() && path.len() <= shortest + tolerance)
            .collect();
        prop_assert!(found.windows(2).all(|pair| pair[0].len() <= pair[1].len()));
        // Of a few the shortest: as many of each length as there is room for.
        let few = paths_between(&mesh, &open, [a, b], &PathOptions { most, ..all });
        prop_assert_eq!(few.len(), found.len().min(most));
        for (few, all) in few.iter().zip(&found) {
            prop_assert_eq!(few.len(), all.len());
        }
        prop_assert!(few.iter().all(|path| found.contains(path)));
        found.sort_unstable();
        wanted.sort_unstable();
        prop_assert_eq!(found, wanted);
    }
}

fn town(traffic: Traffic, sinks: Sinks) -> (Tessellation, Problem) {
    let mesh = grid(10, 10);
    let spec = Specification {
        travel: 0.2,
        traffic,
        sinks,
        ..Specification::default()
    };
    let problem = spec.on(&mesh).unwrap();
    (mesh, problem)
}

proptest! {
    #![proptest_config(config(6))]

    /// Whatever the search says of a whole town is valid, and has the spans that
    /// it has to have.
    #[test]
    fn what_the_search_says_of_towns_is_valid(
        parts in 1_usize..7,
        pairs in 1_usize..4,
        seed in any::<u64>(),
        inside in prop_oneof![Just(Feature::Forbidden), Just(Feature::Weighted(0.5))],
        across in prop_oneof![Just(Feature::Free), Just(Feature::Weighted(1.0))],
        count in prop::option::of(1_usize..4),
        among in prop_oneof![Just(Among::Boundary), Just(Among::Interior), Just(Among::Anywhere)],
    ) {
        let traffic = Traffic {
            inside: Some(Inside { parts: Parts::Count(parts), seed, missing: inside, ..Inside::default() }),
            across: Some(Across { pairs: Pairs::Count(pairs), seed, missing: across, ..Across::default() }),
            ..Traffic::default()
        };
        let sinks = count.map_or(Sinks::Boundary, |count| Sinks::Placed { count, among });
        let (_, problem) = town(traffic, sinks);
        let expected = if across == Feature::Free { 0 } else { pairs };
        let of = |kind| problem.routes.iter().filter(move |r| r.kind == kind);
        prop_assert_eq!(of(RouteKind::Across).count(), expected);
        // Parts are joined to each other, so pairs to a connected graph.
        prop_assert!(of(RouteKind::Inside).count() + 1 >= parts);
        for route in &problem.routes {
            prop_assert_eq!(route.cost.is_none(), route.kind == RouteKind::Inside && inside == Feature::Forbidden);
        }
        let found = search(&problem, 1500, seed);
        if let Some(network) = &found.network {
            prop_assert_eq!(verify(&problem, network), vec![]);
            prop_assert_eq!(network.sinks.len(), count.unwrap_or(0));
            let missing = problem.routes.iter().filter(|r| !r.is_there(&network.active));
            let cost: f64 = missing.map(|r| r.cost.unwrap()).sum();
            prop_assert!((found.cost.routes - cost).abs() < 1e-9);
        }
        let again = search(&problem, 1500, seed);
        prop_assert_eq!(again.network, found.network);
    }
}

/// Figures 2c and 8e in small: spans tie the network together, and sinks find
/// places on the boundary.
#[test]
fn spans_and_sinks_do_what_they_are_for() {
    let (_, plain) = town(Traffic::default(), Sinks::Boundary);
    let inside = Traffic {
        inside: Some(Inside::default()),
        ..Traffic::default()
    };
    let (_, joined) = town(inside, Sinks::Boundary);
    assert!(joined.routes.len() >= 3);
    let [a, b] = [&plain, &joined].map(|problem| search(problem, 8000, 0));
    // Spans only add.
    assert!(b.cost.objective > a.cost.objective);
    let there = |o: &Outcome| {
        let active = o.network.as_ref().unwrap().active.clone();
        joined
            .routes
            .iter()
            .filter(move |r| r.is_there(&active))
            .count()
    };
    assert_eq!(there(&b), joined.routes.len());
    assert!(there(&a) < joined.routes.len());
    let placed = Sinks::Placed {
        count: 3,
        among: Among::Boundary,
    };
    let (mesh, problem) = town(Traffic::default(), placed);
    let found = search(&problem, 8000, 0);
    let network = found.network.unwrap();
    assert_eq!(verify(&problem, &network), []);
    assert_eq!(network.sinks.len(), 3);
    // All side by side would be a bad choice: some two are five apart or more.
    let apart = |a: usize, b: usize| {
        let way = mesh.points()[a] - mesh.points()[b];
        way.x.hypot(way.y)
    };
    let s = &network.sinks;
    assert!([apart(s[0], s[1]), apart(s[1], s[2]), apart(s[0], s[2])]
        .iter()
        .any(|&d| d >= 5.0));
}

#[test]
fn new_families_are_named_in_conflicts() {
    let mesh = grid(4, 2);
    // The middle column is an obstacle, so nothing leads from side to side.
    let spec = Specification {
        rim: Rim::Open,
        too_close: Feature::Free,
        dead_ends: Feature::Free,
        obstacles: vec![2, 7, 12],
        sinks: Sinks::At(vec![0, 4]),
        ..Specification::default()
    };
    let limits = Limits::default();
    let named = |problem: &Problem| conflicts(problem, &Microlp, &limits).unwrap();
    let mut problem = spec.on(&mesh).unwrap();
    assert_eq!(named(&problem), None);
    let route = |kind, cost| Route {
        kind,
        cost,
        paths: vec![vec![
            mesh.edge_between(1, 2).unwrap(),
            mesh.edge_between(2, 3).unwrap(),
        ]],
    };
    for (kind, family) in [
        (RouteKind::Inside, Constraints::Inside),
        (RouteKind::Across, Constraints::Across),
        (RouteKind::Asked, Constraints::Routes),
    ] {
        problem.routes = vec![route(kind, Some(3.0))];
        assert_eq!(named(&problem), None);
        problem.routes = vec![route(kind, None)];
        let conflict = named(&problem).unwrap();
        assert_eq!(conflict.each, [Constraints::ClosedEdges, family]);
    }
    // Two sinks to be placed on the left alone, with places on the right to be
    // covered: without placing, or with sinks everywhere, there is a network.
    problem.routes.clear();
    problem.sinks = vec![false; 15];
    problem.placed = Some(PlacedSinks {
        candidates: vec![0, 1, 4],
        count: 1,
    });
    let conflict = named(&problem).unwrap();
    assert!(conflict.each.contains(&Constraints::PlacedSinks));
    assert!(conflict.each.contains(&Constraints::Connectivity));
}

#[test]
fn specifications_that_do_not_fit_say_why() {
    let mesh = grid(6, 6);
    let with = |traffic: Traffic, sinks: Sinks| {
        let spec = Specification {
            traffic,
            sinks,
            ..Specification::default()
        };
        spec.on(&mesh).map_err(|e| e.to_string())
    };
    let inside = |inside: Inside| {
        let traffic = Traffic {
            inside: Some(inside),
            ..Traffic::default()
        };
        with(traffic, Sinks::Boundary)
    };
    let across = |across: Across| {
        let traffic = Traffic {
            across: Some(across),
            ..Traffic::default()
        };
        with(traffic, Sinks::Boundary)
    };
    let says = |result: Result<Problem, String>, word: &str| {
        let error = result.unwrap_err();
        assert!(error.contains(word), "{error}");
    };
    says(
        inside(Inside {
            parts: Parts::Count(0),
            ..Inside::default()
        }),
        "parts",
    );
    says(
        inside(Inside {
            parts: Parts::Labels(vec![0]),
            ..Inside::default()
        }),
        "labels",
    );
    says(
        inside(Inside {
            tolerance: 40,
            ..Inside::default()
        }),
        "longer",
    );
    says(
        inside(Inside {
            most: 0,
            ..Inside::default()
        }),
        "0 paths",
    );
    // More parts than vertices that streets can touch.
    says(
        inside(Inside {
            parts: Parts::Count(36),
            ..Inside::default()
        }),
        "fewer",
    );
    says(
        across(Across {
            pairs: Pairs::Count(0),
            ..Across::default()
        }),
        "pairs",
    );
    says(
        across(Across {
            pairs: Pairs::Count(99),
            ..Across::default()
        }),
        "pairs",
    );
    let twice = [Place::Vertex(3), Place::Share { u: 0.5, v: 0.0 }];
    says(
        across(Across {
            pairs: Pairs::Between(vec![twice]),
            ..Across::default()
        }),
        "nothing joins",
    );
    let inner = [Place::Vertex(24), Place::Vertex(0)];
    says(
        across(Across {
            pairs: Pairs::Between(vec![inner]),
            ..Across::default()
        }),
        "24",
    );
    let missing = Feature::Weighted(-1.0);
    says(
        inside(Inside {
            missing,
            ..Inside::default()
        }),
        "costs -",
    );
    says(
        with(
            Traffic {
                to_sinks: f64::NAN,
                ..Traffic::default()
            },
            Sinks::Boundary,
        ),
        "NaN",
    );
    for count in [0, 25] {
        let placed = Sinks::Placed {
            count,
            among: Among::Boundary,
        };
        says(with(Traffic::default(), placed), "ask for 1 to 24");
    }
    let nowhere = Among::List(vec![Place::Vertex(99)]);
    says(
        with(
            Traffic::default(),
            Sinks::Placed {
                count: 1,
                among: nowhere,
            },
        ),
        "99",
    );
    // Where nothing can join two places it is an error, or no matter.
    let across_wall = |missing| {
        let spec = Specification {
            rim: Rim::Open,
            obstacles: (0..7).map(|k| 3 + 7 * k).collect(),
            traffic: Traffic {
                across: Some(Across {
                    pairs: Pairs::Between(vec![[Place::Vertex(21), Place::Vertex(27)]]),
                    missing,
                    ..Across::default()
                }),
                ..Traffic::default()
            },
            ..Specification::default()
        };
        spec.on(&mesh).map_err(|e| e.to_string())
    };
    says(across_wall(Feature::Forbidden), "no path");
    assert_eq!(across_wall(Feature::Weighted(2.0)).unwrap().routes, []);
}
