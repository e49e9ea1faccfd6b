//! Laws of fields with prescribed singularities: just these, just there.

mod shapes;

use std::f64::consts::TAU;

use crossfield::geo_types::{coord, Coord, Polygon};
use crossfield::{
    Connection, Cross, Domain, Field, FieldDesign, PrescribedField, Singularity, Symmetry,
};
use proptest::prelude::*;
use shapes::{config, domain, polygon, regular, shape};

fn at(x: f64, y: f64, quarter_index: i32) -> Singularity {
    Singularity {
        at: coord! {x: x, y: y},
        quarter_index,
    }
}

/// Checks that `field` has the singularities `wanted` and no other, each
/// within `reach` edge lengths of its place. Indices beyond 1 may be spread
/// over several of the same sign.
fn just_these(field: &Field, wanted: &[Singularity], reach: f64) -> Result<(), String> {
    let found = field.singularities();
    let describe = || format!("wanted {wanted:?}, found {found:?}");
    let mut seen = 0;
    for w in wanted {
        let near = |f: &&Singularity| {
            (f.at.x - w.at.x).hypot(f.at.y - w.at.y) < reach * field.domain().edge_length()
        };
        let here: Vec<_> = found.iter().filter(near).collect();
        let sum: i32 = here.iter().map(|f| f.quarter_index).sum();
        let one = w.quarter_index.abs() > 1 || here.len() == 1;
        // Of one sign all: no pair was added.
        let same = here.iter().all(|f| f.quarter_index * sum > 0);
        if sum != w.quarter_index || !one || !same {
            return Err(describe());
        }
        seen += here.len();
    }
    if seen == found.len() {
        Ok(())
    } else {
        Err(describe())
    }
}

fn disc() -> Domain {
    domain(&Polygon::new(regular(120, 100.0, (0.0, 0.0)), vec![]), 4.0)
}

#[test]
fn four_quarters_in_a_disc() {
    let domain = disc();
    assert_eq!(PrescribedField::needed_sum(&domain, Symmetry::Cross), 4);
    for wanted in [
        vec![
            at(50., 3., 1),
            at(-50., 2., 1),
            at(7., 40., 1),
            at(-5., -60., 1),
        ],
        // All to one side.
        vec![
            at(50., 0., 1),
            at(70., 20., 1),
            at(60., -30., 1),
            at(40., 40., 1),
        ],
        // With a pair more than needed.
        vec![
            at(50., 3., 1),
            at(-50., 2., 1),
            at(7., 40., 1),
            at(-5., -60., 1),
            at(0., 0., 1),
            at(20., 10., -1),
        ],
    ] {
        for connection in [Connection::Phase, Connection::Vector] {
            let design = PrescribedField {
                connection,
                ..PrescribedField::new(wanted.clone())
            };
            let field = design.design(&domain).expect("possible");
            let check = field.index_check();
            assert!(
                check.aligned && check.boundary_law(),
                "{connection:?} {check:?}"
            );
            if connection == Connection::Phase {
                just_these(&field, &wanted, 1.0).expect("just these");
            }
        }
    }
}

/// Indices beyond a quarter turn spread over the triangles around the place.
#[test]
fn a_whole_turn_at_one_place() {
    let wanted = [at(0.0, 0.0, 4)];
    let field = PrescribedField::new(wanted.to_vec())
        .design(&disc())
        .expect("possible");
    just_these(&field, &wanted, 1.5).expect("just this");
    // By symmetry it is radial: off by half the angle that a boundary edge
    // spans; and by a quarter of an edge length, over the radius, by which the
    // place is moved into its triangle, and as much for the triangles there.
    for v in 0..field.domain().vertex_count() {
        let p = field.domain().vertex(v);
        if p.x.hypot(p.y) > 20.0 {
            let radial = Cross::from_direction(p).expect("off the middle");
            let cross = Cross::from_representative(field.representative(v)).expect("regular");
            let bound = 0.5 * TAU / 120.0 + 0.5 * 4.0 / p.x.hypot(p.y);
            let off = cross.deviation(&radial);
            assert!(off < bound, "{p:?} {off} {bound}");
        }
    }
    let wanted = [at(-30.0, 0.0, 2), at(30.0, 0.0, 3), at(0.0, 50.0, -1)];
    let field = PrescribedField::new(wanted.to_vec())
        .design(&disc())
        .expect("possible");
    just_these(&field, &wanted, 2.0).expect("just these");
}

#[test]
fn pairs_in_a_rectangle() {
    let domain = domain(&shape(&[(0., 0.), (120., 0.), (120., 80.), (0., 80.)]), 3.0);
    for wanted in [
        vec![],
        vec![at(40., 40., 1), at(80., 40., -1)],
        vec![
            at(20., 20., 1),
            at(100., 20., -1),
            at(20., 60., -1),
            at(100., 60., 1),
        ],
        // Near the boundary, and near each other.
        vec![at(5., 40., 1), at(13., 40., -1)],
    ] {
        let field = PrescribedField::new(wanted.clone())
            .design(&domain)
            .expect("possible");
        just_these(&field, &wanted, 1.0).expect("just these");
        assert!(field.index_check().winding_law());
    }
}

/// Holes take the indices that their boundary asks for, and no other.
#[test]
fn domains_with_holes() {
    let round = |hole| Polygon::new(regular(120, 100.0, (0.0, 0.0)), hole);
    let cases = [
        // A round hole takes 4 of the disc's: none is needed.
        (round(vec![regular(60, 25.0, (30.0, 10.0))]), vec![]),
        (
            round(vec![regular(60, 25.0, (30.0, 10.0))]),
            vec![at(-50., 0., 1), at(-20., -50., -1)],
        ),
        // A square one takes none.
        (
            round(vec![regular(4, 30.0, (10.0, 5.0))]),
            vec![
                at(60., 3., 1),
                at(-60., 2., 1),
                at(7., 60., 1),
                at(-5., -60., 1),
            ],
        ),
        // A triangle takes 1.
        (
            round(vec![regular(3, 30.0, (10.0, 5.0))]),
            vec![at(60., 3., 1), at(-60., 2., 1), at(7., 60., 1)],
        ),
        (
            round(vec![
                regular(40, 20.0, (40.0, 0.0)),
                regular(40, 20.0, (-40.0, 10.0)),
            ]),
            vec![
                at(0., 60., -1),
                at(0., -60., -1),
                at(0., 30., -1),
                at(0., -30., -1),
            ],
        ),
    ];
    for (polygon, wanted) in cases {
        let domain = domain(&polygon, 3.0);
        let field = PrescribedField::new(wanted.clone())
            .design(&domain)
            .expect("possible");
        let check = field.index_check();
        assert!(check.aligned && check.boundary_law(), "{check:?}");
        just_these(&field, &wanted, 1.0).expect("just these");
    }
}

/// On an annulus the phase around the hole could be off by whole turns: the
/// smoothest field is the radial one.
#[test]
fn an_annulus_is_radial() {
    let domain = domain(&shapes::annulus(120, 100.0, 40.0), 5.0);
    let field = PrescribedField::new(vec![])
        .design(&domain)
        .expect("possible");
    for v in 0..domain.vertex_count() {
        let radial = Cross::from_direction(domain.vertex(v)).expect("off the centre");
        let cross = Cross::from_representative(field.representative(v)).expect("regular");
        // Half the angle that a boundary edge spans.
        assert!(cross.deviation(&radial) < 0.55 * TAU / 120.0);
    }
}

/// Every symmetry has its own sum.
#[test]
fn other_symmetries() {
    let domain = disc();
    for symmetry in Symmetry::ALL {
        let folds = symmetry.folds();
        assert_eq!(PrescribedField::needed_sum(&domain, symmetry), folds as i32);
        let wanted: Vec<Singularity> = (0..folds)
            .map(|k| {
                let (y, x) = (0.3 + f64::from(k) * symmetry.period()).sin_cos();
                at(50.0 * x, 50.0 * y, 1)
            })
            .collect();
        let design = PrescribedField {
            symmetry,
            ..PrescribedField::new(wanted.clone())
        };
        let field = design.design(&domain).expect("possible");
        just_these(&field, &wanted, 1.0).expect("just these");
        assert!(field.index_check().boundary_law());
    }
}

/// Points spread over a polygon's inside, well apart and off the boundary.
fn places(domain: &Domain, picks: &[f64], apart: f64) -> Vec<Coord<f64>> {
    let mut places: Vec<Coord<f64>> = Vec::new();
    for pick in picks {
        let v = (pick * domain.vertex_count() as f64) as usize;
        let p = domain.vertex(v);
        let clear = |q: Coord<f64>| (q.x - p.x).hypot(q.y - p.y) > apart;
        let edge = domain.nearest_boundary(p).point;
        if clear(edge) && places.iter().all(|&q| clear(q)) {
            places.push(p);
        }
    }
    places
}

proptest! {
    #![proptest_config(config(12))]

    /// Random domains, random places: indices of +1 and -1 that fit.
    #[test]
    fn just_the_wanted_singularities(
        polygon in polygon(), picks in proptest::collection::vec(0.0..1.0_f64, 60),
    ) {
        let domain = domain(&polygon, 8.0);
        let needed = PrescribedField::needed_sum(&domain, Symmetry::Cross);
        let places = places(&domain, &picks, 24.0);
        prop_assume!(places.len() >= needed.unsigned_abs() as usize);
        // What is over makes pairs.
        let pairs = ((places.len() - needed.unsigned_abs() as usize) / 2).min(2);
        let signs = std::iter::repeat_n(needed.signum(), needed.unsigned_abs() as usize)
            .chain([1, -1].into_iter().cycle().take(2 * pairs));
        let wanted: Vec<Singularity> = places.iter().zip(signs)
            .map(|(&at, quarter_index)| Singularity { at, quarter_index })
            .collect();
        // A neck that the mesh does not resolve is refused.
        let field = PrescribedField::new(wanted.clone()).design(&domain);
        let refused = field.as_ref().err().map(ToString::to_string);
        prop_assert!(refused.as_ref().is_none_or(|why| why.contains("too narrow")), "{:?}", refused);
        prop_assume!(refused.is_none());
        let field = field?;
        prop_assert!(field.index_check().winding_law());
        let check = just_these(&field, &wanted, 2.0);
        prop_assert!(check.is_ok(), "{:?}", check);
    }

    #[test]
    fn turning_the_mesh_turns_every_cross(
        polygon in polygon(), pick in 0.0..1.0_f64, angle in -4.0..4.0_f64,
    ) {
        let here = domain(&polygon, 20.0);
        let there = here.moved(angle, coord! {x: 5e5, y: -3e6});
        // One place takes the whole sum, where it can.
        let needed = PrescribedField::needed_sum(&here, Symmetry::Cross);
        prop_assume!(needed != 0 && needed.abs() <= 4);
        let v = (pick * here.vertex_count() as f64) as usize;
        let neighbours = here.triangles().iter().find(|t| t.contains(&(v as u32))).expect("used");
        // The same triangle in both meshes, whatever the rounding.
        let middle = |d: &Domain| {
            let c = neighbours.map(|v| d.vertex(v as usize));
            coord! {x: (c[0].x + c[1].x + c[2].x) / 3.0, y: (c[0].y + c[1].y + c[2].y) / 3.0}
        };
        let design = |d: &Domain| {
            PrescribedField::new(vec![Singularity { at: middle(d), quarter_index: needed }]).design(d)
        };
        let (a, b) = (design(&here), design(&there));
        // Both or neither find the domain too narrow for so coarse a mesh.
        prop_assert_eq!(a.is_ok(), b.is_ok());
        prop_assume!(a.is_ok());
        let (a, b) = (a?, b?);
        for v in 0..here.vertex_count() {
            let cross = |f: &Field| Cross::from_representative(f.representative(v)).expect("unit");
            prop_assert!(cross(&a).turned(angle).deviation(&cross(&b)) < 1e-6);
        }
    }
}

/// Rings that touch: their common vertices have no phase of their own, and
/// nothing goes wrong.
#[test]
fn rings_that_touch_are_no_problem() {
    let square = [(0., 0.), (60., 0.), (60., 60.), (0., 60.)];
    let holes = [
        vec![(0., 30.), (20., 20.), (20., 40.)],
        vec![(30., 10.), (50., 10.), (40., 25.)],
        vec![(40., 25.), (50., 45.), (30., 45.)],
    ];
    for count in 1..=holes.len() {
        let rings = holes[..count]
            .iter()
            .map(|hole| shapes::ring(hole))
            .collect();
        let domain = domain(&Polygon::new(shapes::ring(&square), rings), 2.0);
        let needed = PrescribedField::needed_sum(&domain, Symmetry::Cross);
        let wanted: Vec<Singularity> = (0..needed.unsigned_abs())
            .map(|k| at(8.0 + 10.0 * f64::from(k), 53.0, needed.signum()))
            .collect();
        let field = PrescribedField::new(wanted)
            .design(&domain)
            .expect("possible");
        assert!(field.index_check().winding_law());
        assert_eq!(field.index_sum(), needed, "{count}");
    }
}
