//! Floors: what is asked for is there, storeys share their shafts, and what
//! cannot be is said.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{forever, grid};
use network_opt::design::{Placement, RoomCount, RoomWish, Rooms, Tessellation};
use network_opt::floor::{
    design_storeys, spread_shafts, Beside, FloorSpecification, Near, Obstacle, Place, Room,
    ShaftRole, Wish,
};
use network_opt::mip::Microlp;
use network_opt::solve::{conflicts, Constraints, NetworkSolver, Search};
use network_opt::DesignError;

fn solved(spec: &FloorSpecification, mesh: &Tessellation) -> (Rooms, Vec<Placement>) {
    let floor = spec.on(mesh, &[]).unwrap();
    let search = Search {
        moves: Some(20_000),
    };
    let found = search
        .solve(&floor.problem, None, &forever(), &mut |_| true)
        .unwrap();
    let network = found.network.expect("a plan");
    let rooms = floor.problem.rooms.unwrap();
    let placed = network.rooms.iter().map(|&k| rooms.placements[k].clone());
    let placed = placed.collect();
    (rooms, placed)
}

fn room(name: &str, shapes: &[&str]) -> Room {
    Room {
        name: name.into(),
        shapes: shapes.iter().map(|s| s.parse().unwrap()).collect(),
        ..Room::default()
    }
}

fn neighbours(a: &Placement, b: &Placement) -> bool {
    a.faces != b.faces && a.border.iter().any(|e| b.border.contains(e))
}

/// What an architect asks for is there.
#[test]
fn wishes_are_granted_where_they_are_demanded() {
    let mesh = grid(8, 5);
    let spec = FloorSpecification {
        rooms: vec![
            Room {
                window: Wish::Required,
                least: 4,
                ..room("office", &["##/##", "###/##."])
            },
            Room {
                least: 1,
                most: Some(2),
                beside: vec![Beside {
                    room: "meeting".into(),
                    wish: Wish::Required,
                }],
                ..room("kitchen", &["##"])
            },
            Room {
                apart: vec!["meeting".into(), "office".into()],
                most: Some(2),
                ..room("copier", &["#"])
            },
            Room {
                near_entrance: Some(Near {
                    within: 3.0,
                    wish: Wish::Required,
                }),
                least: 1,
                most: Some(1),
                ..room("reception", &["###", "##"])
            },
            room("meeting", &["##/#.", "##"]),
            Room {
                cost: 1.0,
                ..room("store", &["#"])
            },
        ],
        ..FloorSpecification::default()
    };
    let (_, placed) = solved(&spec, &mesh);
    let of = |name: &'static str| placed.iter().filter(move |p| p.template == name);
    assert!(of("office").count() >= 4);
    let rim: Vec<bool> = mesh.rim().collect();
    assert!(of("office").all(|p| p.border.iter().any(|&e| rim[e])));
    assert!((1..=2).contains(&of("kitchen").count()));
    assert!(of("kitchen").all(|k| of("meeting").any(|m| neighbours(k, m))));
    assert!(of("copier").all(|c| {
        let others = placed
            .iter()
            .filter(|p| p.template == "meeting" || p.template == "office");
        others.into_iter().all(|o| !neighbours(c, o))
    }));
    assert_eq!(of("reception").count(), 1);
}

/// Edges and regions that rooms keep to.
#[test]
fn rooms_keep_to_their_place() {
    let mesh = grid(6, 4);
    let left = vec![[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 4.0]];
    let edge = mesh.edge_between(5, 6).unwrap();
    let spec = FloorSpecification {
        rooms: vec![
            Room {
                within: left,
                least: 1,
                ..room("left", &["##/##", "##"])
            },
            Room {
                touching: vec![edge],
                avoiding: vec![edge + 1],
                ..room("there", &["##/##"])
            },
            Room {
                most_area: Some(3.5),
                least_area: 1.5,
                ..room("other", &["#", "##", "##/#.", "##/##"])
            },
        ],
        ..FloorSpecification::default()
    };
    let floor = spec.on(&mesh, &[]).unwrap();
    let rooms = floor.problem.rooms.unwrap();
    let of = |name: &'static str| rooms.placements.iter().filter(move |p| p.template == name);
    assert!(of("left").all(|p| p.faces.iter().all(|f| f % 6 < 3)));
    assert!(of("there").all(|p| p.border.contains(&edge) && !p.border.contains(&(edge + 1))));
    assert!(of("other").all(|p| (2..=3).contains(&p.faces.len())));
    assert_eq!(of("left").filter(|p| p.faces.len() == 4).count(), 2 * 3);
}

/// Shafts are rooms that are there, with a corridor at their landing; on upper
/// storeys corridors lead to them.
#[test]
fn storeys_share_their_shafts() {
    let mesh = grid(9, 6);
    let shafts = spread_shafts(&mesh, 2);
    assert_eq!(shafts.len(), 2);
    let roof = FloorSpecification {
        name: "roof".into(),
        obstacles: vec![Obstacle {
            name: "garden".into(),
            polygon: vec![[0.0, 0.0], [2.0, 0.0], [2.0, 6.0], [0.0, 6.0]],
            open: true,
            ..Obstacle::default()
        }],
        ..FloorSpecification::default()
    };
    let specs = [FloorSpecification::default(), roof];
    let search = Search { moves: Some(6000) };
    let storeys =
        design_storeys(&mesh, &shafts, &specs, &search, &forever(), &mut |_| true).unwrap();
    assert_eq!(storeys.len(), 2);
    let places = |k: usize| {
        let shafts = storeys[k].floor.shafts.iter();
        shafts
            .map(|s| (s.faces.clone(), s.landing))
            .collect::<Vec<_>>()
    };
    assert_eq!(places(0), places(1));
    assert_eq!(storeys[0].floor.entrances.len(), 1);
    assert!(storeys[1].floor.entrances.is_empty());
    for storey in &storeys {
        assert!(storey.is_valid());
        let network = storey.outcome.network.as_ref().unwrap();
        let floor = &storey.floor;
        for shaft in &floor.shafts {
            assert_eq!(shaft.faces.len(), 1);
            assert!(network.rooms.contains(&shaft.placement.unwrap()));
            let around = mesh.around(shaft.landing);
            assert!(around.iter().any(|&(e, _)| network.active[e]));
            let is_sink = floor.problem.sinks[shaft.landing];
            assert_eq!(is_sink, floor.entrances.is_empty());
        }
    }
    // Nothing in the garden, and windows onto it.
    let upper = &storeys[1].floor;
    let rooms = upper.problem.rooms.as_ref().unwrap();
    for face in (0..54).filter(|f| f % 9 < 2) {
        assert!(!rooms.covered[face] && upper.obstacles[face] == Some(0));
    }
    let beside = mesh.edge_between(2, 12).unwrap();
    assert!(upper.windows[beside] && !storeys[0].floor.windows[beside]);
    // A mere vertex is passed, or is a sink.
    let mut at = shafts[0].clone();
    at.shape = None;
    at.at = Place::Vertex(33);
    let passed = FloorSpecification {
        entrances: vec![Place::Vertex(5)],
        ..FloorSpecification::default()
    };
    let floor = passed.on(&mesh, &[at.clone()]).unwrap();
    assert_eq!(floor.problem.required_vertices, [5, 33]);
    let sink = FloorSpecification {
        shafts: ShaftRole::Sinks,
        ..passed
    };
    let floor = sink.on(&mesh, &[at]).unwrap();
    assert!(floor.problem.sinks[33]);
    assert!(floor.problem.sinks[5]);
}

/// Hostile and extreme input is an error that says what is wrong.
#[test]
fn what_cannot_be_is_said() {
    let mesh = grid(3, 3);
    let with = |change: fn(&mut FloorSpecification)| {
        let mut spec = FloorSpecification::default();
        change(&mut spec);
        match spec.on(&mesh, &[]) {
            Err(DesignError::BadFloor { what } | DesignError::BadProblem { what }) => what,
            other => panic!("{other:?}"),
        }
    };
    type Change = fn(&mut FloorSpecification);
    let cases: [(Change, &str); 17] = [
        (|s| s.rooms.clear(), "no kind of room"),
        (|s| s.rooms[1].name = "office".into(), "two kinds"),
        (|s| s.rooms[0].name.clear(), "no name"),
        (|s| s.rooms[0].shapes.clear(), "no shape"),
        (|s| s.rooms[0].apart.push("hall".into()), "hall"),
        (|s| s.rooms[0].avoiding.push(99), "edge 99"),
        (|s| s.rooms[0].cost = f64::NAN, "NaN"),
        (|s| s.rooms[0].least = 5, "5 at least"),
        (
            |s| (s.rooms[0].least, s.rooms[0].most) = (3, Some(2)),
            "3 to 2",
        ),
        (|s| s.entrances = vec![Place::Vertex(99)], "vertex 99"),
        (|s| s.entrances = vec![Place::Vertex(5)], "vertex 5"),
        (|s| s.entrances = vec![Place::Point([f64::NAN, 0.0])], "NaN"),
        (|s| s.shafts = ShaftRole::Sinks, "neither"),
        (|s| s.length = -1.0, "-1"),
        (
            |s| s.rooms = vec![room("big", &["##/##"])],
            "multiples of 4",
        ),
        (
            |s| s.rooms = vec![room("far", &["####"])],
            "no room fits on 9",
        ),
        (
            |s| {
                s.obstacles.push(Obstacle {
                    faces: vec![9],
                    ..Obstacle::default()
                })
            },
            "face 9",
        ),
    ];
    for (change, word) in cases {
        let what = with(change);
        assert!(what.contains(word), "{what} without {word}");
    }
    let far = network_opt::floor::Shaft {
        name: "lift".into(),
        at: Place::Point([1.5, 1.5]),
        shape: Some("#####".parse().unwrap()),
    };
    let error = FloorSpecification::default().on(&mesh, &[far]).unwrap_err();
    assert!(error.to_string().contains("no place"), "{error}");
    // One square, and no corridor but along the facade.
    let one = grid(1, 1);
    let floor = FloorSpecification::default().on(&one, &[]).unwrap();
    let found = Search { moves: Some(500) }
        .solve(&floor.problem, None, &forever(), &mut |_| true)
        .unwrap();
    assert!(found.network.is_some());
}

/// The families that conflict are named: counts, and demands on neighbours.
#[test]
fn conflicts_of_counts_and_wishes_are_named() {
    let mesh = grid(2, 2);
    let mut problem = FloorSpecification {
        rooms: vec![room("one", &["#"]), room("two", &["##"])],
        ..FloorSpecification::default()
    }
    .on(&mesh, &[])
    .unwrap()
    .problem;
    problem.patterns.clear();
    let rooms = problem.rooms.as_mut().unwrap();
    // Four squares are at most four rooms.
    rooms.counts.push(RoomCount {
        name: "all".into(),
        rooms: (0..rooms.placements.len()).collect(),
        least: 5,
        most: None,
    });
    let found = conflicts(&problem, &Microlp, &forever()).unwrap().unwrap();
    assert_eq!(found.each, [Constraints::Rooms, Constraints::RoomCounts]);
    let rooms = problem.rooms.as_mut().unwrap();
    rooms.counts.clear();
    for k in 0..rooms.placements.len() {
        rooms.wishes.push(RoomWish {
            when: vec![k],
            then: vec![],
            cost: None,
        });
    }
    let found = conflicts(&problem, &Microlp, &forever()).unwrap().unwrap();
    assert_eq!(found.each, [Constraints::Rooms, Constraints::RoomWishes]);
}
