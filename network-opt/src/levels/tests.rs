use super::*;
use crate::design::{verify, Among, EdgeState, OneWay, Rim, Sinks};
use crate::snake::SnakeOptions;
use crate::solve::Search;

fn two_levels(obstacles: Vec<usize>) -> Vec<Level> {
    let limits = Limits {
        deadline: None,
        ..Limits::default()
    };
    let search = Search { moves: Some(3000) };
    let first = Specification {
        obstacles,
        ..Specification::default()
    };
    let second = Specification {
        sinks: Sinks::Streets,
        ..Specification::default()
    };
    let mesh = Tessellation::grid(6, 6);
    design_levels(mesh, &[first, second], &search, &limits, &mut |_| true).expect("fits")
}

/// The second level has the first one's streets twice as finely, and both
/// are valid.
#[test]
fn lower_levels_build_on_higher_ones() {
    let levels = two_levels(vec![]);
    assert_eq!(levels.len(), 2);
    assert_eq!(levels[1].mesh.faces().len(), 4 * 36);
    for level in &levels {
        let network = level.outcome.network.as_ref().expect("found");
        assert_eq!(verify(&level.problem, network), []);
    }
    let above = levels[0].outcome.network.as_ref().expect("found");
    for (e, &on) in above.active.iter().enumerate() {
        for half in [2 * e, 2 * e + 1] {
            assert_eq!(levels[1].problem.is_given(half), on);
        }
    }
    let streets = streets(&levels, &SnakeOptions::default()).expect("smooth");
    for street in &streets {
        assert_eq!(street.away.len() + 1, street.line.0.len());
        assert!(street.away.iter().all(|metres| metres.is_finite()));
    }
    assert!(streets.iter().any(|s| s.level == 0) && streets.iter().any(|s| s.level == 1));
}

/// A street that leads to a single place ends there, on the boundary and
/// inside it.
#[test]
fn streets_end_at_lone_sinks() {
    for sink in [3, 24] {
        let spec = Specification {
            sinks: Sinks::At(vec![sink]),
            rim: Rim::Closed,
            ..Specification::default()
        };
        let limits = Limits {
            deadline: None,
            ..Limits::default()
        };
        let search = Search { moves: Some(2000) };
        let mesh = Tessellation::grid(6, 6);
        let at = mesh.points()[sink];
        let levels = design_levels(mesh, &[spec], &search, &limits, &mut |_| true).expect("fits");
        let streets = streets(&levels, &SnakeOptions::default()).expect("smooth");
        let meets = |street: &Street| street.line.0.contains(&at);
        assert!(streets.iter().any(meets), "a street at vertex {sink}");
    }
}

/// Sinks that the first level places are what its ways lead to.
#[test]
fn ways_lead_to_placed_sinks() {
    let limits = Limits {
        deadline: None,
        ..Limits::default()
    };
    let search = Search { moves: Some(3000) };
    let first = Specification {
        rim: Rim::Open,
        sinks: Sinks::Placed {
            count: 2,
            among: Among::Interior,
        },
        ..Specification::default()
    };
    let second = Specification {
        rim: Rim::Open,
        sinks: Sinks::Streets,
        ..Specification::default()
    };
    let mesh = Tessellation::grid(6, 6);
    let levels = design_levels(mesh, &[first, second], &search, &limits, &mut |_| true);
    let levels = levels.expect("fits");
    let sinks = |level: &Level| level.outcome.network.as_ref().map(|n| n.sinks.len());
    assert_eq!([sinks(&levels[0]), sinks(&levels[1])], [Some(2), Some(0)]);
    for street in streets(&levels, &SnakeOptions::default()).expect("smooth") {
        assert!(street.away.iter().all(|metres| metres.is_finite()));
    }
}

/// A square of obstacles stays empty on the finer mesh too.
#[test]
fn obstacles_grow_with_the_mesh() {
    // Vertices 16, 17, 23, 24: a face in the middle of the grid.
    let levels = two_levels(vec![16, 17, 23, 24]);
    let fine = &levels[1];
    let face = (0..36).find(|&f| levels[0].mesh.faces()[f] == [16, 17, 24, 23]);
    let centre = 49 + levels[0].mesh.edges().len() + face.expect("a face");
    for &(e, _) in fine.mesh.around(centre) {
        assert_eq!(fine.problem.states[e], EdgeState::Closed);
    }
}

fn plans(one_way: [OneWay; 2]) -> Vec<LevelPlan> {
    let plan = |(name, one_way)| LevelPlan {
        class: StreetClass::new(name, 10.0),
        specification: Specification {
            one_way,
            travel: 0.2,
            ..Specification::default()
        },
    };
    ["collector", "local"]
        .into_iter()
        .zip(one_way)
        .map(plan)
        .collect()
}

fn designed(plans: &[LevelPlan], existing: Option<f64>) -> Vec<Level> {
    let limits = Limits {
        deadline: None,
        ..Limits::default()
    };
    let search = Search { moves: Some(3000) };
    let mesh = Tessellation::grid(6, 6);
    design_plans(mesh, plans, existing, &search, &limits, &mut |_| true).expect("fits")
}

/// Streets of the level above are faster, the boundary fastest.
#[test]
fn travel_counts_time() {
    let levels = designed(&plans([OneWay::None; 2]), Some(usual_speed("major")));
    for (level, own) in levels.iter().zip([30.0, 20.0]) {
        let problem = &level.problem;
        for e in 0..problem.edges() {
            let rim = problem.ends[e].iter().all(|&v| {
                let point = level.mesh.points()[v];
                [point.x, point.y].iter().any(|&c| c == 0.0 || c == 6.0)
            });
            let mph = match problem.is_given(e) {
                true if rim => 40.0,
                true => 30.0,
                false => own,
            };
            let share = problem.travel_cost(e) / problem.lengths[e];
            assert!(
                (share - own / mph).abs() < 1e-12,
                "{share} for {own} / {mph}"
            );
        }
    }
    // One speed for all is none, and what design_levels does.
    let mut same = plans([OneWay::None; 2]);
    same[1].class.speed = same[0].class.speed;
    let levels = designed(&same, None);
    assert!(levels
        .iter()
        .all(|level| level.problem.travel_costs.is_empty()));
    let specifications: Vec<Specification> =
        same.into_iter().map(|plan| plan.specification).collect();
    let limits = Limits {
        deadline: None,
        ..Limits::default()
    };
    let search = Search { moves: Some(3000) };
    let mesh = Tessellation::grid(6, 6);
    let plain = design_levels(mesh, &specifications, &search, &limits, &mut |_| true);
    for (a, b) in plain.expect("fits").iter().zip(&levels) {
        assert_eq!(
            (&a.problem, &a.outcome.network),
            (&b.problem, &b.outcome.network)
        );
    }
}

/// The next level has to do with the directions that there are, and streets
/// are drawn in theirs.
#[test]
fn directions_go_down() {
    let levels = designed(&plans([OneWay::All, OneWay::None]), None);
    assert_eq!(levels.len(), 2);
    for level in &levels {
        let network = level.outcome.network.as_ref().expect("found");
        assert_eq!(verify(&level.problem, network), []);
    }
    let above = levels[0].outcome.network.as_ref().expect("found");
    for (e, &on) in above.active.iter().enumerate() {
        for half in [2 * e, 2 * e + 1].into_iter().filter(|_| on) {
            assert_eq!(levels[1].problem.way(half), above.ways[e]);
            assert_ne!(above.ways[e], Way::Both);
        }
    }
    let options = SnakeOptions {
        // No snake moves, so that its points are the mesh's.
        closeness: 1e9,
        ..SnakeOptions::default()
    };
    let found = streets(&levels, &options).expect("smooth");
    assert!(found
        .iter()
        .all(|street| street.one_way == (street.level == 0)));
    let mesh = &levels[1].mesh;
    for street in &found {
        assert_eq!(street.away.len() + 1, street.line.0.len());
        assert!(street.away.iter().all(|metres| metres.is_finite()));
        let at = |p: geo_types::Coord<f64>| {
            let near = |q: &geo_types::Coord<f64>| (q.x - p.x).hypot(q.y - p.y) < 1e-3;
            mesh.points().iter().position(near)
        };
        let stops: Vec<usize> = street.line.0.iter().filter_map(|&p| at(p)).collect();
        for pair in stops.windows(2).filter(|_| street.one_way) {
            let e = mesh.edge_between(pair[0], pair[1]).expect("an edge");
            let end = usize::from(mesh.edges()[e][0] != pair[0]);
            assert!(levels[1].problem.way(e).runs_from(end));
        }
    }
}

#[test]
fn speeds_have_to_be_positive() {
    let mut bad = plans([OneWay::None; 2]);
    bad[1].class.speed = 0.0;
    let run = |plans: &[LevelPlan], existing| {
        let mesh = Tessellation::grid(2, 2);
        let search = Search { moves: Some(1) };
        design_plans(
            mesh,
            plans,
            existing,
            &search,
            &Limits::default(),
            &mut |_| true,
        )
    };
    assert!(run(&bad, None).is_err());
    bad[1].class.speed = 30.0;
    assert!(run(&bad, Some(f64::NAN)).is_err());
    bad[0].class.width = -1.0;
    assert!(run(&bad, None).is_err());
    assert_eq!(run(&[], None).expect("nothing to do"), vec![]);
}
