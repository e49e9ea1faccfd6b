//! Selectors on shapes with known answers.

use std::collections::BTreeMap;

use geo_types::{coord, Coord};
use proptest::prelude::*;

use super::*;
use crate::derive::{DeriveOptions, Limits, Places, Scope, Stream, Value};
use crate::error::Failure;
use crate::grammar::Grammar;
use crate::plane::Area;
use crate::shape::{Mark, Role};
use crate::syntax::ast::{Expr, ItemKind};
use crate::syntax::{parse, Sources};

pub(super) fn region(points: &[(f64, f64)]) -> Region {
    let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
    let mut region = Region::bare(Area::new(ring, Vec::new()));
    upright(&mut region);
    region
}

/// Numbers the sides of a park by the axes that it has.
fn upright(region: &mut Region) {
    crate::index::by_local(region);
    for edge in region.edges.iter_mut().flatten() {
        edge.origin.boundary = edge.side;
        edge.origin.descent = edge.side;
    }
}

/// 4 wide, 2 high.
fn rectangle() -> Region {
    region(&[(0., 0.), (0., 2.), (4., 2.), (4., 0.)])
}

/// A square of 4 without its north-eastern quarter.
fn bend() -> Region {
    region(&[(0., 0.), (0., 4.), (2., 4.), (2., 2.), (4., 2.), (4., 0.)])
}

/// A square of 4 with a niche of 1 x 2 in its western side.
fn niche() -> Region {
    region(&[
        (0., 0.),
        (0., 1.),
        (1., 1.),
        (1., 3.),
        (0., 3.),
        (0., 4.),
        (4., 4.),
        (4., 0.),
    ])
}

fn diamond() -> Region {
    region(&[(-1., 0.), (0., 1.), (1., 0.), (0., -1.)])
}

fn expr(text: &str) -> Expr {
    let mut sources = Sources::default();
    sources.add("test", format!("grammar 1\nparam x = {text}"));
    let file = parse(&sources, 0).expect("reads");
    match file.items.into_iter().next().map(|item| item.kind) {
        Some(ItemKind::Param { value, .. }) => value,
        other => panic!("{other:?}"),
    }
}

fn value(region: &Region, text: &str) -> Result<Value, Failure> {
    let grammar = Grammar::new("grammar 1\nRegion -> Lawn").expect("reads");
    let mut scope = Scope {
        grammar: &grammar,
        params: &BTreeMap::new(),
        places: &Places::new(),
        region,
        chance: &mut Stream::new(0),
        depth: 0,
        limits: &Limits::new(&DeriveOptions::default(), &|_| true),
        rule: &"Region".into(),
    };
    scope.value(&expr(text))
}

pub(super) fn select(region: &Region, text: &str) -> Selection {
    match value(region, text) {
        Ok(Value::Selection(selection)) => selection,
        other => panic!("{text}: {other:?}"),
    }
}

fn length(region: &Region, text: &str) -> f64 {
    let whole = 1e9 * select(region, text).length();
    whole.round() / 1e9
}

/// The middle of what is selected, weighted by length.
fn middle(region: &Region, text: &str) -> (f64, f64) {
    let selection = select(region, text);
    let (mut sum, mut whole) = (Coord::default(), 0.0);
    for line in selection.lines(region) {
        for pair in line.windows(2) {
            let step = dist(pair[0], pair[1]);
            sum = sum + lerp(pair[0], pair[1], 0.5) * step;
            whole += step;
        }
    }
    let round = |x: f64| (x * 1e9).round() / 1e9 + 0.0;
    (round(sum.x / whole), round(sum.y / whole))
}

fn mirrored(region: &Region) -> Region {
    let ring = region.area.outer.iter().map(|p| coord! { x: -p.x, y: p.y });
    let mut image = Region::bare(Area::new(ring.collect(), Vec::new()));
    // Local west is where the original had it.
    let flip = |p: Coord<f64>| coord! { x: -p.x, y: p.y };
    image.local.corners = region.local.corners.map(flip);
    upright(&mut image);
    image
}

#[test]
fn edges_by_angle() {
    let shape = bend();
    assert_eq!(length(&shape, "Angle([-45, 45])"), 4.0);
    assert_eq!(length(&shape, "Angle([135, 225])"), 4.0);
    assert_eq!(length(&shape, "Angle([85, 95], Line)"), 8.0);
    assert_eq!(
        length(&diamond(), "Angle([0, 90])"),
        (2f64.sqrt() * 1e9).round() / 1e9
    );
    // Both ends belong to the range: the edges at 45 degrees.
    assert_eq!(select(&diamond(), "Angle([45, 135])").stretches().len(), 1);
}

#[test]
fn sectors_cut_edges() {
    let shape = rectangle();
    // From (2, 1) the diagonals at 45 degrees meet north and south at x = 3.
    assert_eq!(length(&shape, "Sector([-45, 45])"), 4.0);
    assert_eq!(length(&shape, "Sector([45, 135])"), 2.0);
    assert_eq!(length(&shape, "Sector([45, -45])"), 8.0);
    assert_eq!(length(&shape, "Sector([0, 360])"), 12.0);
    assert_eq!(length(&shape, "Sector([0, 90], centre = (0, 0))"), 12.0);
}

#[test]
fn cardinal_sides() {
    let shape = rectangle();
    for (k, name) in ["WEST", "NORTH", "EAST", "SOUTH"].into_iter().enumerate() {
        let side = select(&shape, &format!("EDGE[{k}]"));
        assert_eq!(select(&shape, name), side, "{name}");
        for way in ["Angle", "Grow", "Dominant", "Corners"] {
            assert_eq!(
                select(&shape, &format!("Cardinal({name}, {way})")),
                side,
                "{name} {way}"
            );
        }
    }
    assert_eq!(length(&shape, "Cardinal(EAST, Sector)"), 4.0);
    // A niche is part of its side.
    assert_eq!(length(&niche(), "WEST"), 6.0);
    assert_eq!(length(&niche(), "Cardinal(WEST, Angle)"), 4.0);
    // The north-eastern corner of the box is equally far from two vertices.
    assert_eq!(length(&bend(), "NORTH"), 4.0);
    assert_eq!(length(&bend(), "EAST"), 4.0);
}

#[test]
fn ties_at_45_degrees() {
    let half = (2f64.sqrt() * 1e9).round() / 1e9;
    let shape = diamond();
    for (name, at) in [
        ("WEST", (-0.75, 0.)),
        ("NORTH", (0., 0.75)),
        ("EAST", (0.75, 0.)),
        ("SOUTH", (0., -0.75)),
    ] {
        for text in [name.to_owned(), format!("Cardinal({name}, Split)")] {
            assert_eq!(length(&shape, &text), half, "{text}");
            assert_eq!(middle(&shape, &text), at, "{text}");
        }
    }
    assert_eq!(length(&shape, "Cardinal(WEST, Dominant)"), 2.828427125);
    assert!(select(&shape, "Cardinal(NORTH, Dominant)")
        .stretches()
        .is_empty());
    assert_eq!(middle(&shape, "Cardinal(NORTH, Northern)"), (0., 0.5));
    assert!(select(&shape, "Cardinal(EAST, Northern)")
        .stretches()
        .is_empty());
    // A kite, whose east is the vertex nearest to two corners.
    let kite = region(&[(-1., 0.), (0., 1.), (3., 0.), (0., -1.)]);
    assert_eq!(middle(&kite, "WEST").1, 0.0);
    assert_eq!(middle(&kite, "EAST").1, 0.0);
    let (north, south) = (middle(&kite, "NORTH"), middle(&kite, "SOUTH"));
    assert_eq!((north.0, north.1), (south.0, -south.1));
}

#[test]
fn selections_grow_from_rays() {
    let shape = bend();
    // The ray east from (5/3, 5/3) meets x = 4; its neighbours turn by 90.
    assert_eq!(length(&shape, "Grow(EAST, 30)"), 2.0);
    assert_eq!(length(&shape, "Grow(EAST, 91)"), 16.0);
    assert_eq!(length(&shape, "Grow([EAST, WEST], 30, Leave)[1]"), 4.0);
    // An octagon has sides that turn by 45: each goes half to either neighbour.
    let s = 2f64.sqrt();
    let octagon = region(&[
        (0., 1.),
        (0., 1. + s),
        (1., 2. + s),
        (1. + s, 2. + s),
        (2. + s, 1. + s),
        (2. + s, 1.),
        (1. + s, 0.),
        (1., 0.),
    ]);
    for (k, at) in [(0, 2), (1, 3)] {
        let text = |k| format!("Grow([WEST, NORTH, EAST, SOUTH], 50)[{k}]");
        assert_eq!(length(&octagon, &text(k)), (2.0 * s * 1e9).round() / 1e9);
        assert_eq!(length(&octagon, &text(at)), (2.0 * s * 1e9).round() / 1e9);
    }
    assert_eq!(length(&octagon, "Grow(WEST, 44)"), (s * 1e9).round() / 1e9);
    // A ray into a vertex begins at both of its edges.
    assert_eq!(
        select(&diamond(), "Grow(EAST, 10)"),
        select(&diamond(), "Angle([-45, 45])")
    );
}

#[test]
fn directions_continue() {
    // The niche's own walls face north and south, and are enclosed by the west.
    assert_eq!(length(&niche(), "Continuous(WEST)"), 6.0);
    assert_eq!(length(&niche(), "Continuous(EAST)"), 4.0);
    assert_eq!(length(&rectangle(), "Continuous(NORTH)"), 4.0);
    // What a rule turned still belongs to where it came from.
    let mut shape = rectangle();
    shape.edges[0][1].origin.descent = Some(0);
    assert_eq!(length(&shape, "Continuous(WEST)"), 6.0);
    assert_eq!(length(&shape, "Continuous(EDGE[2])"), 2.0);
}

#[test]
fn boundaries_and_corners() {
    let mut shape = rectangle();
    assert_eq!(length(&shape, "INCIDENT"), 12.0);
    // Only the western and northern side are the park's.
    for k in [2, 3] {
        shape.edges[0][k].origin.boundary = None;
    }
    assert_eq!(length(&shape, "OUTER"), 6.0);
    assert_eq!(length(&shape, "INCIDENT"), 6.0);
    shape.edges[0][0].origin.boundary = Some(1);
    assert!(select(&shape, "INCIDENT").stretches().is_empty());
    assert_eq!(length(&shape, "not OUTER"), 6.0);
    assert_eq!(length(&shape, "EDGE[-1]"), 4.0);
    assert_eq!(length(&shape, "EDGE[0..2]"), 8.0);
    let corner = |text: &str| match value(&shape, text) {
        Ok(Value::Spots(spots)) => (spots[0].at, spots[0].facing.to_degrees().round()),
        other => panic!("{other:?}"),
    };
    assert_eq!(corner("CORNER[0]"), (coord! { x: 0., y: 0. }, 45.0));
    assert_eq!(corner("CORNER[-2]"), (coord! { x: 4., y: 2. }, -135.0));
}

#[test]
fn history_goes_by_rule_role_and_level() {
    let mut shape = rectangle();
    let mark = |depth, role| Mark {
        rule: "Peel".into(),
        depth,
        role,
    };
    let mut set = |k: usize, marks: Vec<Mark>| shape.edges[0][k].origin.marks = marks;
    set(0, vec![mark(1, Role::Base)]);
    set(1, vec![mark(1, Role::Inner), mark(4, Role::Base)]);
    set(2, vec![mark(4, Role::Flank)]);
    set(
        3,
        vec![
            mark(4, Role::Inner),
            Mark {
                rule: "Grid".into(),
                depth: 2,
                role: Role::Path,
            },
        ],
    );
    for (text, metres) in [
        ("PEELED_BASE", 4.0),
        ("PB", 4.0),
        ("PI", 4.0),
        ("PEELED_SEGMENT", 6.0),
        ("History(\"Peel\", BASE)", 6.0),
        ("History(\"Peel\", BASE, 0)", 2.0),
        ("History(\"Peel\", INNER, -2)", 4.0),
        ("History(\"Peel\", -1)", 10.0),
        ("History(\"Grid\", PATH, 0)", 4.0),
        ("History(\"Grid\", 1)", 0.0),
        ("PATH", 4.0),
    ] {
        assert_eq!(length(&shape, text), metres, "{text}");
    }
}

#[test]
fn the_nearest_edges() {
    let shape = rectangle();
    // North and south are equally near to the centre.
    assert_eq!(length(&shape, "Nearest(CENTRE)"), 8.0);
    assert_eq!(length(&shape, "Nearest((0.25, 0.5))"), 10.0);
    assert_eq!(length(&shape, "Nearest((0.1, 0.5))"), 2.0);
    assert_eq!(length(&shape, "Nearest((0.1, 0.5), 9)"), 12.0);
    assert_eq!(length(&shape, "Nearest(EDGE[0])"), 8.0);
    assert_eq!(length(&shape, "Nearest(CORNER[0], 1)"), 6.0);
}

#[test]
fn parameters_run_over_the_combined_length() {
    let shape = rectangle();
    // West and north, 2 and 4 long.
    let text = "Part(WEST or NORTH, [0, 0.5])";
    assert_eq!(length(&shape, text), 3.0);
    assert_eq!(middle(&shape, "Part(WEST or NORTH, [0, 1 m])"), (0., 0.5));
    assert_eq!(middle(&shape, "Part(ALL, [0.75, 1])"), (1.5, 0.));
    assert_eq!(length(&shape, "Part(ALL, [0.9, 0.1])"), 2.4);
    assert_eq!(length(&shape, "Part(WEST, [50 %, 2 m])"), 1.0);
    assert_eq!(
        length(&shape, "Parametrise([0, 1], [0, 0.25], [], [0.5, 1])"),
        5.0
    );
    assert_eq!(middle(&shape, "Parametrise([0, 0.5], 1)"), (1., 2.));
    assert_eq!(length(&shape, "Parametrise([0, 1] [] [0, 0.5])"), 3.0);
    match value(&shape, "Parametrise([0, 1], inset = 0.5)") {
        Ok(Value::Inset(selection, inset)) => assert_eq!((selection.length(), inset), (2.0, 0.5)),
        other => panic!("{other:?}"),
    }
    // As the notes write it: the second value of Contract is what is divided.
    let text = "Parametrise([0, 1], [0, 1], [0, 0.15], 0) { Contract(1, NORTH or EAST) }";
    match value(&shape, text) {
        Ok(Value::Inset(selection, inset)) => {
            assert!((selection.length() - 4.3).abs() < 1e-9 && inset == 1.0);
        }
        other => panic!("{other:?}"),
    }
    let text = "Parametrise([0, 1]) { Grid(2, 2) }";
    assert!(matches!(value(&shape, text), Err(Failure::Fault(_))));
    match value(&shape, "Length(WEST or EAST)") {
        Ok(Value::Number(number)) => assert_eq!(number.metres(), Some(4.0)),
        other => panic!("{other:?}"),
    }
    assert!(matches!(
        value(&shape, "Part(WEST, 3)"),
        Err(Failure::Fault(_))
    ));
}

/// A cut at a vertex missed it by rounding, and the line began with an edge of no
/// length that had a corner of its own.
#[test]
fn sides_begin_at_their_vertex() {
    for away in [0.0, 0.1, 438.186_349_999_566_23] {
        let points = [
            (9.30, 0.44),
            (5.68, 26.85),
            (-24.68, 38.45),
            (-38.78, 10.54),
            (-21.80, -3.90),
            (-21.18, -32.84),
            (-6.18, -10.31),
        ];
        let shape = region(&points.map(|(x, y)| (x, y + away)));
        for name in ["WEST", "NORTH", "EAST", "SOUTH"] {
            for line in select(&shape, name).lines(&shape) {
                assert!(
                    line.windows(2).all(|p| dist(p[0], p[1]) > 1.0),
                    "{name} {line:?}"
                );
                assert!(
                    line.iter().all(|p| shape.area.outer.contains(p)),
                    "{name} {line:?}"
                );
            }
        }
    }
}

/// Star-shaped polygons of 4 to 12 vertices.
fn shapes() -> impl Strategy<Value = Region> {
    prop::collection::vec(3.0..10.0f64, 4..12).prop_map(|radii| {
        let n = radii.len() as f64;
        let points: Vec<(f64, f64)> = radii
            .iter()
            .enumerate()
            .map(|(k, r)| {
                let angle = 0.3 - std::f64::consts::TAU * k as f64 / n;
                (r * angle.cos(), r * angle.sin())
            })
            .collect();
        region(&points)
    })
}

const SELECTORS: [&str; 14] = [
    "WEST",
    "NORTH",
    "Cardinal(EAST, Angle)",
    "Cardinal(EAST, Sector)",
    "Cardinal(SOUTH, Grow)",
    "Cardinal(SOUTH, Split)",
    "Angle([10, 120])",
    "Angle([10, 120], Line)",
    "Sector([10, 250])",
    "Grow(WEST, 40)",
    "Continuous(NORTH)",
    "Part(ALL, [0.1, 0.35])",
    "Part(EDGE[0] or EDGE[2], [0.3, 0.8])",
    "Nearest((0.2, 0.3), 2)",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn selections_are_sets(shape in shapes(), a in 0..14usize, b in 0..14usize) {
        let (a, b) = (select(&shape, SELECTORS[a]), select(&shape, SELECTORS[b]));
        let whole = Selection::all(&shape).length();
        let tiny = 1e-7 * whole;
        let near = |x: &Selection, y: &Selection| {
            x.minus(y).length() < tiny && y.minus(x).length() < tiny
        };
        prop_assert!(near(&a.or(&b).not(&shape), &a.not(&shape).and(&b.not(&shape))));
        prop_assert!(near(&a.and(&b).not(&shape), &a.not(&shape).or(&b.not(&shape))));
        prop_assert!(near(&a.minus(&b), &a.and(&b.not(&shape))));
        prop_assert!((a.length() + b.length() - a.or(&b).length() - a.and(&b).length()).abs() < tiny);
        prop_assert!((a.length() + a.not(&shape).length() - whole).abs() < tiny);
    }

    #[test]
    fn the_four_sides_are_the_boundary(shape in shapes(), split in any::<bool>()) {
        let whole = Selection::all(&shape).length();
        let way = if split { "Split" } else { "Corners" };
        let sides = ["WEST", "NORTH", "EAST", "SOUTH"]
            .map(|name| select(&shape, &format!("Cardinal({name}, {way})")));
        let all = sides.iter().fold(Selection::default(), |all, side| all.or(side));
        let sum: f64 = sides.iter().map(Selection::length).sum();
        prop_assert!((all.length() - whole).abs() < 1e-6 * whole);
        prop_assert!((sum - whole).abs() < 1e-6 * whole);
        if !split {
            prop_assert!(sides.iter().all(|side| side.length() > 0.0));
        }
    }

    #[test]
    fn mirror_images_have_mirrored_selections(shape in shapes(), k in 0..14usize) {
        let image = mirrored(&shape);
        let name = SELECTORS[k];
        let (a, b) = (select(&shape, name), select(&image, name));
        prop_assert!((a.length() - b.length()).abs() < 1e-6, "{name}");
        if a.length() > 1e-6 {
            let (p, q) = (middle(&shape, name), middle(&image, name));
            prop_assert!((p.0 + q.0).abs() < 1e-6 && (p.1 - q.1).abs() < 1e-6, "{name}");
        }
    }

    #[test]
    fn parts_add_up(shape in shapes(), k in 0..11usize, at in 0.05..0.95f64) {
        let name = SELECTORS[k];
        let part = |from: f64, to: f64| select(&shape, &format!("Part({name}, [{from:.6}, {to:.6}])"));
        let whole = select(&shape, name);
        let (first, second) = (part(0.0, at), part(at, 1.0));
        let tiny = 1e-6 * Selection::all(&shape).length();
        prop_assert!((first.length() + second.length() - whole.length()).abs() < tiny);
        prop_assert!(first.and(&second).length() < tiny);
        prop_assert!(whole.minus(&first.or(&second)).length() < tiny);
    }
}
