//! Laws of floors: placements, counts, wishes, shafts and storeys.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;

use network_opt::design::{
    cost_of, verify, EdgeState, Network, Placement, Problem, RoomCount, RoomWish, Rooms,
    Tessellation, Violation,
};
use network_opt::floor::{
    design_storeys, placements, spread_shafts, Beside, FloorSpecification, Near, Obstacle, Place,
    Room, ShaftRole, Shape, Wish,
};
use network_opt::formulate::{Formulated, Formulation};
use network_opt::geo_types::{coord, polygon};
use network_opt::mip::Microlp;
use network_opt::quad::{quads, QuadOptions};
use network_opt::solve::{conflicts, Constraints, Ended, Exact, Limits, NetworkSolver, Search};
use network_opt::DesignError;
use proptest::prelude::*;

/// Few cases by default; many with `URBAN_LAYOUT_LONG=1`.
fn config(cases: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some_and(|v| v == "1");
    ProptestConfig::with_cases(if long { cases * 20 } else { cases })
}

/// Sums of a few dozen numbers below 100.
const CLOSE: f64 = 1e-6;

fn grid(columns: usize, rows: usize) -> Tessellation {
    let wide = columns + 1;
    let points = (0..wide * (rows + 1))
        .map(|k| coord! { x: (k % wide) as f64, y: (k / wide) as f64 })
        .collect();
    let faces = (0..columns * rows).map(|k| {
        let a = k / columns * wide + k % columns;
        vec![a, a + 1, a + wide + 1, a + wide]
    });
    Tessellation::new(points, faces.collect()).unwrap()
}

/// Any shape of up to six squares: each next one beside one that is there.
fn shape() -> impl Strategy<Value = Shape> {
    prop::collection::vec((0..100_usize, 0..4_usize), 0..6).prop_map(|steps| {
        let mut cells = vec![(0, 0)];
        for (from, side) in steps {
            let (x, y) = cells[from % cells.len()];
            let (dx, dy) = [(1, 0), (0, 1), (-1, 0), (0, -1)][side];
            if !cells.contains(&(x + dx, y + dy)) {
                cells.push((x + dx, y + dy));
            }
        }
        Shape::new(&cells).unwrap()
    })
}

/// Where a shape fits on a grid, by shifting its squares.
fn shifted(shape: &Shape, columns: usize, rows: usize, mirrored: bool) -> BTreeSet<Vec<usize>> {
    let mut found = BTreeSet::new();
    let mut turned = shape.clone();
    let mut forms = Vec::new();
    for _ in 0..4 {
        forms.push(turned.clone());
        if mirrored {
            forms.push(turned.mirrored());
        }
        turned = turned.turned();
    }
    for form in forms {
        for y in 0..rows as i32 {
            for x in 0..columns as i32 {
                let cells = form.cells().iter().map(|c| (c.0 + x, c.1 + y));
                let inside = |c: &(i32, i32)| c.0 < columns as i32 && c.1 < rows as i32;
                if cells.clone().all(|c| inside(&c)) {
                    let mut faces: Vec<usize> = cells
                        .map(|c| c.1 as usize * columns + c.0 as usize)
                        .collect();
                    faces.sort_unstable();
                    found.insert(faces);
                }
            }
        }
    }
    found
}

fn faces_of(found: &[Placement]) -> BTreeSet<Vec<usize>> {
    found.iter().map(|p| p.faces.clone()).collect()
}

/// A mesh with irregular vertices: a bent block.
fn bent() -> Tessellation {
    let block = polygon![
        (x: 0., y: 0.), (x: 40., y: 0.), (x: 52., y: 20.), (x: 30., y: 34.), (x: 24., y: 20.), (x: 0., y: 16.),
    ];
    let options = QuadOptions {
        edge_length: 3.0,
        ..QuadOptions::default()
    };
    quads(&block, &options).unwrap()
}

/// The instance `floor16x15` of the benchmark: 511 edges, and squares, boxes and
/// bends of eight squares in 1,329 places.
#[test]
fn the_benchmark_has_as_many_placements() {
    let mesh = grid(16, 15);
    assert_eq!(mesh.edges().len(), 511);
    let count = |text: &str| placements(&mesh, "room", &text.parse().unwrap(), true, true).len();
    assert_eq!(
        [count("##/##"), count("###/###"), count("###/###/##.")],
        [210, 391, 728]
    );
}

proptest! {
    #![proptest_config(config(40))]

    /// On a grid placements are the shifted, turned and mirrored shapes.
    #[test]
    fn on_a_grid_shapes_are_shifted(shape in shape(), columns in 1..6_usize, rows in 1..5_usize, mirrored in any::<bool>()) {
        let mesh = grid(columns, rows);
        let found = placements(&mesh, "room", &shape, mirrored, true);
        let faces = faces_of(&found);
        prop_assert_eq!(faces.len(), found.len(), "each once");
        prop_assert_eq!(faces, shifted(&shape, columns, rows, mirrored));
    }

    /// On any mesh: faces hang together, edges inside have both faces in the
    /// room and those around it one, irregular placements are more and hold an
    /// irregular vertex, and a shape turned or mirrored fits where it does.
    #[test]
    fn rooms_are_what_they_say_on_any_mesh(shape in shape()) {
        let mesh = bent();
        let regular = placements(&mesh, "room", &shape, true, false);
        let all = placements(&mesh, "room", &shape, true, true);
        prop_assert!(faces_of(&regular).is_subset(&faces_of(&all)));
        for turned in [shape.turned(), shape.mirrored()] {
            let same = placements(&mesh, "room", &turned, true, true);
            prop_assert_eq!(faces_of(&same), faces_of(&all));
        }
        for room in &all {
            for (edges, sides) in [(&room.inner, 2), (&room.border, 1)] {
                for &e in edges {
                    let inside = mesh.faces_of(e).iter().filter(|f| room.faces.contains(f));
                    prop_assert_eq!(inside.count(), sides);
                }
            }
            let corners = room.faces.iter().map(|&f| mesh.faces()[f].len()).sum::<usize>();
            prop_assert_eq!(2 * room.inner.len() + room.border.len(), corners);
            let mut seen = vec![room.faces[0]];
            let mut at = 0;
            while at < seen.len() {
                let inside: Vec<usize> = mesh.edges_of(seen[at]).iter().copied().filter(|e| room.inner.contains(e)).collect();
                for e in inside {
                    let faces = mesh.faces_of(e).iter().copied();
                    let next: Vec<usize> = faces.filter(|f| !seen.contains(f)).collect();
                    seen.extend(next);
                }
                at += 1;
            }
            prop_assert_eq!(seen.len(), room.faces.len());
            if !faces_of(&regular).contains(&room.faces) {
                let inner = |v: &&usize| mesh.around(**v).iter().all(|(e, _)| room.inner.contains(e));
                let odd = room.faces.iter().flat_map(|&f| &mesh.faces()[f]).filter(inner)
                    .any(|&v| matches!(mesh.around(v).len(), 3 | 5));
                prop_assert!(odd, "{:?} has no irregular vertex inside", room.faces);
                // One quad less or more for each that the quarter has.
                prop_assert!(room.faces.len() != shape.cells().len());
            }
        }
    }

    /// Vertices numbered otherwise: the same rooms.
    #[test]
    fn numbers_do_not_matter(shape in shape(), shift in 1..60_usize, turn in 0..4_usize) {
        let mesh = bent();
        let n = mesh.points().len();
        let new = |v: usize| (v + shift) % n;
        let mut points = mesh.points().to_vec();
        (0..n).for_each(|v| points[new(v)] = mesh.points()[v]);
        let faces = mesh.faces().iter().map(|face| {
            let mut face: Vec<usize> = face.iter().map(|&v| new(v)).collect();
            face.rotate_left(turn);
            face
        });
        let other = Tessellation::new(points, faces.collect()).unwrap();
        let of = |mesh: &Tessellation| faces_of(&placements(mesh, "room", &shape, true, true));
        prop_assert_eq!(of(&other), of(&mesh));
    }
}

/// A tiny floor with counts and wishes drawn at random.
#[derive(Clone, Debug)]
struct Recipe {
    rows: usize,
    dead_ends: bool,
    travel: f64,
    sink: usize,
    closed: Vec<usize>,
    counts: Vec<(Vec<usize>, usize, usize)>,
    wishes: Vec<(Vec<usize>, Vec<usize>, Option<u8>)>,
}

fn recipe() -> impl Strategy<Value = Recipe> {
    let some = |most: usize| prop::collection::vec(0..100_usize, 0..most);
    let wish = (
        prop::collection::vec(0..100_usize, 1..3),
        some(4),
        prop::option::of(0..4_u8),
    );
    (
        1..3_usize,
        any::<bool>(),
        prop_oneof![Just(0.0), Just(0.5)],
        0..100_usize,
        some(2),
        prop::collection::vec((some(6), 0..3_usize, 0..4_usize), 0..3),
        prop::collection::vec(wish, 0..5),
    )
        .prop_map(
            |(rows, dead_ends, travel, sink, closed, counts, wishes)| Recipe {
                rows,
                dead_ends,
                travel,
                sink,
                closed,
                counts,
                wishes,
            },
        )
}

impl Recipe {
    fn problem(&self) -> Problem {
        let mesh = grid(2, self.rows);
        let mut found = placements(&mesh, "one", &"#".parse().unwrap(), true, true);
        found.extend(placements(&mesh, "two", &"##".parse().unwrap(), true, true));
        let (n, m) = (mesh.points().len(), mesh.edges().len());
        let count = found.len();
        let draw = |list: &[usize]| -> Vec<usize> {
            let set: BTreeSet<usize> = list.iter().map(|k| k % count).collect();
            set.into_iter().collect()
        };
        let mut states = vec![EdgeState::Open; m];
        self.closed
            .iter()
            .for_each(|&e| states[e % m] = EdgeState::Closed);
        Problem {
            vertices: n,
            ends: mesh.edges().to_vec(),
            lengths: vec![1.0; m],
            states,
            sinks: (0..n).map(|v| v == self.sink % n).collect(),
            dead_ends: self.dead_ends,
            rooms: Some(Rooms {
                placements: found,
                covered: vec![true; 2 * self.rows],
                counts: (self.counts.iter())
                    .map(|(rooms, least, more)| RoomCount {
                        name: "some".into(),
                        rooms: draw(rooms),
                        least: *least,
                        most: (*more < 3).then_some(least + more),
                    })
                    .collect(),
                wishes: (self.wishes.iter())
                    .map(|(when, then, cost)| RoomWish {
                        when: draw(when),
                        then: draw(then),
                        cost: cost.map(f64::from),
                    })
                    .collect(),
            }),
            length_weight: 1.0,
            travel_weight: self.travel,
            ..Problem::default()
        }
    }
}

/// All valid plans, by trying all sets of edges and of rooms.
fn all_valid(problem: &Problem) -> Vec<Network> {
    let m = problem.edges();
    let count = problem.rooms.as_ref().unwrap().placements.len();
    let mut tilings = Vec::new();
    for bits in 0_u32..1 << count {
        let rooms: Vec<usize> = (0..count).filter(|k| bits >> k & 1 == 1).collect();
        let network = Network {
            active: vec![true; m],
            rooms,
            ..Network::default()
        };
        // With all edges active what is wrong with tiling, counts and wishes
        // stays wrong.
        let about_rooms = |v: &Violation| {
            matches!(
                v,
                Violation::Tiling { .. } | Violation::Count { .. } | Violation::Wish { .. }
            )
        };
        if !verify(problem, &network).iter().any(about_rooms) {
            tilings.push(network.rooms);
        }
    }
    let mut found = Vec::new();
    for bits in 0_u32..1 << m {
        let active: Vec<bool> = (0..m).map(|e| bits >> e & 1 == 1).collect();
        for rooms in &tilings {
            let network = Network {
                active: active.clone(),
                rooms: rooms.clone(),
                ..Network::default()
            };
            if verify(problem, &network).is_empty() {
                found.push(network);
            }
        }
    }
    found
}

const PROGRAMS: [Formulation; 4] = [
    Formulation::Flow,
    Formulation::TravelFlow,
    Formulation::SingleSink,
    Formulation::Paper,
];

fn forever() -> Limits {
    Limits {
        deadline: None,
        ..Limits::default()
    }
}

proptest! {
    #![proptest_config(config(24))]

    /// Programs and brute force agree on counts and wishes: every valid plan
    /// meets every row and costs there what the checker says, the optimum is the
    /// least cost, and where nothing is valid the solver says so.
    #[test]
    fn programs_agree_with_brute_force(recipe in recipe()) {
        let problem = recipe.problem();
        let valid = all_valid(&problem);
        let costs = valid.iter().map(|n| cost_of(&problem, n).objective);
        let least = costs.fold(f64::INFINITY, f64::min);
        for formulation in PROGRAMS {
            let formulated = Formulated::new(&problem, formulation, None).unwrap();
            for network in &valid {
                let values = formulated.solution(network);
                let violation = formulated.program().violation(&values);
                prop_assert!(violation < CLOSE, "{formulation:?} by {violation}");
                prop_assert_eq!(&formulated.network(&values), network);
                let cost = cost_of(&problem, network);
                let (said, mut is) = (formulated.program().objective(&values), cost.objective);
                if formulation == Formulation::Flow {
                    is -= problem.travel_weight * cost.travel;
                }
                prop_assert!((said - is).abs() < CLOSE, "{formulation:?}: {said} for {is}");
                let step = formulated.program().step();
                prop_assert!(step == 0.0 || (is / step - (is / step).round()).abs() < CLOSE);
            }
        }
        let found = Exact::new(Microlp).solve(&problem, None, &forever(), &mut |_| true).unwrap();
        match &found.network {
            Some(network) => {
                prop_assert_eq!(verify(&problem, network), []);
                prop_assert!((found.cost.objective - least).abs() < CLOSE, "{} for {least}", found.cost.objective);
                prop_assert!((found.cost.objective - cost_of(&problem, network).objective).abs() < CLOSE);
            }
            None => {
                prop_assert_eq!(found.ended, Ended::Infeasible);
                prop_assert!(valid.is_empty());
            }
        }
    }

    /// So does the search: what it finds is valid and costs what it says, its
    /// bound is none that a plan undercuts, it says that there is nothing only
    /// where there is nothing, and given some time it finds the optimum.
    #[test]
    fn the_search_agrees_with_brute_force(recipe in recipe(), seed in 0..1000_u64) {
        let problem = recipe.problem();
        let valid = all_valid(&problem);
        let costs = valid.iter().map(|n| cost_of(&problem, n).objective);
        let least = costs.fold(f64::INFINITY, f64::min);
        let limits = Limits { seed, ..forever() };
        let search = Search { moves: Some(8000) };
        let found = search.solve(&problem, None, &limits, &mut |_| true).unwrap();
        prop_assert!(found.ended == Ended::Infeasible || found.bound <= least + CLOSE);
        match &found.network {
            Some(network) => {
                prop_assert_eq!(verify(&problem, network), []);
                let cost = cost_of(&problem, network).objective;
                prop_assert!((found.cost.objective - cost).abs() < CLOSE);
                prop_assert!((cost - least).abs() < CLOSE, "{cost} for {least}");
            }
            None => prop_assert!(valid.is_empty(), "there is one of {least}"),
        }
    }

    /// A count more, or a demand more, never makes the optimum better.
    #[test]
    fn more_is_never_cheaper(recipe in recipe()) {
        let problem = recipe.problem();
        let solve = |problem: &Problem| {
            let found = Exact::new(Microlp).solve(problem, None, &forever(), &mut |_| true).unwrap();
            found.network.map_or(f64::INFINITY, |_| found.cost.objective)
        };
        let asked = solve(&problem);
        let mut fewer = problem.clone();
        let rooms = fewer.rooms.as_mut().unwrap();
        rooms.counts.pop();
        rooms.wishes.pop();
        prop_assert!(solve(&fewer) <= asked + CLOSE);
    }
}

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
