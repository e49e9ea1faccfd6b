//! The audit goes red on every kind of broken scene, and says by how much.

mod common;

use park_grammar::audit::Violation;
use park_grammar::geo_types::{coord, polygon, Coord, LineString, Polygon};
use park_grammar::scene::{Ground, Object, Piece, Volume};
use park_grammar::{Audit, DeriveOptions, Grammar, Scene};

use common::mapped;

const RULES: &str = "grammar 1
Region -> Grid(2, 2) { Quarter } { Gravel } { Circle(4) Paving Fountain }
Quarter -> Place((0.3, 0.3)) { Circle(3) FlowerBed }
    Sweep(OUTER: 0.5) { Hedge } Distribute(INNER: 1, 6) { Bench } Scatter(20) { Tree | Bush }
";

/// An oblong of 80 by 60.
fn outline() -> Polygon<f64> {
    rectangle(0.0, 0.0, 80.0, 60.0)
}

fn rectangle(x: f64, y: f64, to_x: f64, to_y: f64) -> Polygon<f64> {
    polygon![(x: x, y: y), (x: to_x, y: y), (x: to_x, y: to_y), (x: x, y: to_y)]
}

fn park() -> Scene {
    let grammar = Grammar::new(RULES).expect("reads");
    grammar
        .derive(&outline(), &DeriveOptions::default())
        .expect("derives")
}

fn only(audit: &Audit) -> &Violation {
    let [only] = audit.violations.as_slice() else {
        panic!("{:?}", audit.violations);
    };
    only
}

fn moved(polygon: &Polygon<f64>, by: Coord<f64>) -> Polygon<f64> {
    mapped(polygon, |c| c + by)
}

fn object(name: &str, x: f64, y: f64, radius: f64) -> Object {
    Object {
        name: name.to_owned(),
        at: coord! { x: x, y: y },
        radius,
        spread: radius,
        height: 1.0,
        facing: 0.0,
        ground: Ground::Region,
    }
}

fn piece(polygon: Polygon<f64>, ground: Ground) -> Piece {
    Piece {
        polygon,
        ground,
        material: "Lawn".to_owned(),
        rule: "Region".to_owned(),
    }
}

#[test]
fn a_park_keeps_the_laws_wherever_it_lies() {
    let grammar = Grammar::new(RULES).expect("reads");
    for by in [coord! { x: 0., y: 0. }, coord! { x: 4e5, y: 6.7e6 }] {
        let outline = moved(&outline(), by);
        let park = grammar
            .derive(&outline, &DeriveOptions::default())
            .expect("derives");
        assert!(park.objects.len() > 40 && !park.volumes.is_empty());
        let audit = park.audit(&outline);
        assert_eq!(audit.violations, []);
        assert!((audit.area - 4800.0).abs() < 1e-6);
        assert!(audit.tiling_error() < 1e-11, "{}", audit.tiling_error());
        // A cross of paths 2 m wide leads out at four places.
        assert_eq!(audit.paths.len(), 1);
        assert!((audit.paths[0].entrance - 8.0).abs() < 1e-6);
    }
}

#[test]
fn a_piece_that_is_missing_is_a_gap() {
    let mut park = park();
    let k = park.pieces.iter().position(|p| p.material == "FlowerBed");
    park.pieces.remove(k.expect("a bed"));
    let audit = park.audit(&outline());
    // 36 corners on a circle of 3 m.
    let bed = 0.5 * 36.0 * 9.0 * (std::f64::consts::TAU / 36.0).sin();
    assert!((audit.gap - bed).abs() < 1e-6, "{audit:?}");
    assert!(matches!(only(&audit), Violation::Gap { area } if (area - bed).abs() < 1e-6));
}

#[test]
fn a_piece_that_is_moved_overlaps() {
    let outline = rectangle(0.0, 0.0, 20.0, 10.0);
    let mut scene = Scene::default();
    for x in [0.0, 10.0] {
        let square = rectangle(x, 0.0, x + 10.0, 10.0);
        scene.pieces.push(piece(square, Ground::Region));
    }
    assert!(scene.audit(&outline).is_lawful());
    // By a millimetre to the east: as much is gap, overlap and outside.
    scene.pieces[0].polygon = moved(&scene.pieces[0].polygon, coord! { x: 1e-3, y: 0. });
    let audit = scene.audit(&outline);
    for (is, must) in [
        (audit.gap, 1e-2),
        (audit.overlap, 1e-2),
        (audit.outside, 0.0),
    ] {
        assert!((is - must).abs() < 1e-9, "{audit:?}");
    }
    scene.pieces[1].polygon = moved(&scene.pieces[1].polygon, coord! { x: 1e-3, y: 0. });
    let audit = scene.audit(&outline);
    assert!((audit.outside - 1e-2).abs() < 1e-9 && audit.overlap < 1e-9);
    // Far less than a millimetre is still seen: 1e-7 m of 10 m are 1e-6 of 200 m2.
    scene.pieces.truncate(1);
    scene.pieces[0].polygon = rectangle(0.0, 0.0, 10.0 + 1e-7, 10.0);
    scene
        .pieces
        .push(piece(rectangle(10.0, 0.0, 20.0, 10.0), Ground::Region));
    assert!(matches!(
        only(&scene.audit(&outline)),
        Violation::Overlap { .. }
    ));
}

#[test]
fn objects_have_their_own_ground() {
    let mut park = park();
    // The fountain was put on paving.
    park.objects.retain(|object| object.name == "Fountain");
    park.volumes.clear();
    assert_eq!(park.objects.len(), 1);
    assert!(park.audit(&outline()).is_lawful());
    // On the path from west to east, which runs from 29 to 31 m.
    park.objects.push(object("Tree", 20.0, 28.8, 0.5));
    let audit = park.audit(&outline());
    assert!(
        matches!(only(&audit), Violation::WrongGround { object: 1, depth, .. } if (depth - 0.3).abs() < 1e-6),
        "{audit:?}"
    );
    park.objects[1] = object("Tree", 20.0, 30.0, 0.5);
    let audit = park.audit(&outline());
    assert!(
        matches!(only(&audit), Violation::WrongGround { depth, .. } if (depth - 1.0).abs() < 1e-6),
        "{audit:?}"
    );
    park.objects[1].ground = Ground::Path;
    assert!(park.audit(&outline()).is_lawful());
    // Out of the park by less than its radius, and wholly.
    for (x, must) in [(0.2, 0.3), (-0.2, 0.7), (-5.0, 1.0)] {
        park.objects[1] = object("Tree", x, 10.0, 0.5);
        let audit = park.audit(&outline());
        assert!(
            matches!(only(&audit), Violation::ObjectOutside { object: 1, depth } if (depth - must).abs() < 1e-6),
            "{audit:?}"
        );
    }
}

/// An object around a whole bed of path is on the path, though no border of it
/// crosses that.
#[test]
fn a_small_path_beneath_an_object_is_seen() {
    let outline = rectangle(0.0, 0.0, 20.0, 10.0);
    let mut lawn = outline.clone();
    let hole = rectangle(9.0, 4.0, 11.0, 6.0);
    lawn.interiors_push(hole.exterior().clone());
    let mut scene = Scene {
        pieces: vec![piece(lawn, Ground::Region), piece(hole, Ground::Path)],
        objects: vec![object("Pond", 9.5, 5.0, 3.0)],
        ..Scene::default()
    };
    let found = scene.audit(&outline).violations;
    assert!(found
        .iter()
        .any(|v| matches!(v, Violation::WrongGround { piece: 1, .. })));
    assert!(found
        .iter()
        .any(|v| matches!(v, Violation::NoEntrance { .. })));
    scene.pieces[1].ground = Ground::Region;
    assert!(scene.audit(&outline).is_lawful());
}

#[test]
fn collisions_are_measured() {
    let outline = rectangle(0.0, 0.0, 20.0, 10.0);
    let mut scene = Scene {
        pieces: vec![piece(outline.clone(), Ground::Region)],
        objects: vec![object("Bush", 5.0, 5.0, 1.0), object("Bush", 7.0, 5.0, 1.0)],
        ..Scene::default()
    };
    assert!(
        scene.audit(&outline).is_lawful(),
        "touching is no collision"
    );
    scene.objects[1].at.x = 6.75;
    let audit = scene.audit(&outline);
    assert!(
        matches!(only(&audit), Violation::Collision { objects: [0, 1], depth } if (depth - 0.25).abs() < 1e-9)
    );
    scene.objects.pop();
    scene.volumes.push(Volume {
        name: "Hedge".to_owned(),
        polygon: rectangle(5.5, 1.0, 6.5, 9.0),
        height: 1.0,
    });
    let audit = scene.audit(&outline);
    assert!(
        matches!(only(&audit), Violation::InVolume { object: 0, volume: 0, depth } if (depth - 0.5).abs() < 1e-9)
    );
    scene.objects.clear();
    scene.volumes.push(Volume {
        name: "Wall".to_owned(),
        polygon: rectangle(6.0, 8.5, 6.5, 11.0),
        height: 1.0,
    });
    let audit = scene.audit(&outline);
    assert!((audit.volume_overlap - 0.25).abs() < 1e-9);
    assert!((audit.volume_outside - 0.5).abs() < 1e-9);
    assert_eq!(audit.violations.len(), 2);
}

/// Parts that meet in a corner only are not connected, and a corner on the
/// boundary is no entrance.
#[test]
fn paths_lead_out_over_a_stretch() {
    let outline = rectangle(0.0, 0.0, 30.0, 30.0);
    let cell = |x: usize, y: usize| {
        let (x, y) = (10.0 * x as f64, 10.0 * y as f64);
        rectangle(x, y, x + 10.0, y + 10.0)
    };
    let scene = |paths: &[(usize, usize)]| Scene {
        pieces: (0..9)
            .map(|k| {
                let at = (k % 3, k / 3);
                let path = paths.contains(&at);
                piece(
                    cell(at.0, at.1),
                    if path { Ground::Path } else { Ground::Region },
                )
            })
            .collect(),
        ..Scene::default()
    };
    // The middle cell alone, with a corner cell, and with one beside it.
    let audit = scene(&[(1, 1)]).audit(&outline);
    assert!(
        matches!(only(&audit), Violation::NoEntrance { pieces, entrance, .. } if pieces == &[4] && *entrance == 0.0)
    );
    let audit = scene(&[(1, 1), (0, 0)]).audit(&outline);
    assert_eq!(audit.paths.len(), 2);
    assert!(matches!(only(&audit), Violation::NoEntrance { pieces, .. } if pieces == &[4]));
    let audit = scene(&[(1, 1), (1, 0)]).audit(&outline);
    assert!(audit.is_lawful());
    assert_eq!(audit.paths[0].entrance, 10.0);
    assert_eq!(audit.paths[0].pieces, [1, 4]);
    // A hole's border is no way out.
    let mut holed = outline.clone();
    holed.interiors_push(cell(1, 1).exterior().clone());
    let mut ring = scene(&[(1, 0)]);
    ring.pieces.remove(4);
    assert!(ring.audit(&holed).is_lawful());
}

#[test]
fn what_has_no_place_is_named() {
    let outline = rectangle(0.0, 0.0, 20.0, 10.0);
    let mut scene = Scene {
        pieces: vec![piece(outline.clone(), Ground::Region)],
        objects: vec![object("Bush", f64::NAN, 5.0, 1.0)],
        ..Scene::default()
    };
    let line = Polygon::new(
        LineString::from(vec![(0.0, 0.0), (4.0, 0.0), (0.0, 0.0)]),
        Vec::new(),
    );
    scene.pieces.push(piece(line, Ground::Region));
    let audit = scene.audit(&outline);
    let words: Vec<String> = audit.violations.iter().map(ToString::to_string).collect();
    assert_eq!(words, ["piece 1 has no area", "a Bush has no place"]);
}
