//! The library of grammars: each derives on parks of any shape, with several
//! seeds, and keeps the laws of a park.

mod outline;

use std::path::{Path, PathBuf};

use park_grammar::geo_types::{Coord, LineString, Polygon};
use park_grammar::scene::Piece;
use park_grammar::syntax::{parse, print, Sources};
use park_grammar::{grammars, DeriveOptions, Grammar, Scene};

/// A park, by its corners in metres.
fn park(points: &[(f64, f64)], hole: &[(f64, f64)]) -> Polygon<f64> {
    let ring = |points: &[(f64, f64)]| -> LineString<f64> {
        points.iter().map(|&(x, y)| Coord { x, y }).collect()
    };
    let holes = (!hole.is_empty()).then(|| ring(hole));
    Polygon::new(ring(points), holes.into_iter().collect())
}

fn parks() -> Vec<(String, Polygon<f64>)> {
    let all = shapes();
    all.into_iter()
        .map(|(name, park)| (name.to_owned(), park))
        .collect()
}

/// The repository's parks (a package has none), and those of a folder of GeoJSON
/// files that `URBAN_LAYOUT_PARKS` names.
fn more() -> Vec<(String, Polygon<f64>)> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/parks");
    let named = std::env::var_os("URBAN_LAYOUT_PARKS").map(PathBuf::from);
    let folders = own.is_dir().then_some(own).into_iter().chain(named);
    folders.flat_map(folder).collect()
}

fn folder(path: PathBuf) -> Vec<(String, Polygon<f64>)> {
    let files = std::fs::read_dir(path).expect("a folder");
    let mut files: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
    files.sort();
    let read = |path: std::path::PathBuf| {
        let text = std::fs::read_to_string(&path).expect("a text");
        let park = outline::outline(&text).expect("a park");
        (
            path.file_stem()
                .map_or_else(String::new, |s| s.display().to_string()),
            park,
        )
    };
    files.into_iter().map(read).collect()
}

/// Parks as they are: narrow, bent, with a bay, with a building in them.
fn shapes() -> Vec<(&'static str, Polygon<f64>)> {
    vec![
        (
            "square",
            park(&[(0., 0.), (60., 0.), (60., 60.), (0., 60.)], &[]),
        ),
        (
            "strip",
            park(&[(0., 0.), (250., 40.), (247., 55.), (-2., 13.)], &[]),
        ),
        (
            "block",
            park(
                &[
                    (3., -8.),
                    (118., 4.),
                    (127., 71.),
                    (104., 96.),
                    (22., 103.),
                    (-6., 61.),
                ],
                &[],
            ),
        ),
        (
            "bend",
            park(
                &[
                    (0., 0.),
                    (140., 10.),
                    (150., 60.),
                    (75., 52.),
                    (62., 70.),
                    (70., 160.),
                    (8., 168.),
                    (-14., 90.),
                ],
                &[],
            ),
        ),
        (
            "bay",
            park(
                &[
                    (0., 0.),
                    (210., -12.),
                    (230., 120.),
                    (150., 131.),
                    (141., 60.),
                    (118., 41.),
                    (92., 49.),
                    (87., 140.),
                    (12., 128.),
                ],
                &[],
            ),
        ),
        (
            "house",
            park(
                &[
                    (-4., 0.),
                    (170., 22.),
                    (181., 90.),
                    (160., 155.),
                    (60., 170.),
                    (0., 120.),
                ],
                &[(70., 70.), (104., 74.), (101., 99.), (67., 95.)],
            ),
        ),
        ("triangle", park(&[(0., 0.), (90., 14.), (30., 75.)], &[])),
        (
            "hourglass",
            park(
                &[
                    (0., 0.),
                    (80., 5.),
                    (64., 50.),
                    (70., 62.),
                    (120., 110.),
                    (40., 140.),
                    (-20., 95.),
                    (43., 60.),
                    (44., 48.),
                ],
                &[],
            ),
        ),
    ]
}

fn derive(grammar: &Grammar, park: &Polygon<f64>, seed: u64) -> Result<Scene, String> {
    let options = DeriveOptions {
        seed,
        ..DeriveOptions::default()
    };
    grammar.derive(park, &options).map_err(|e| e.to_string())
}

fn check(name: &str) {
    let known = grammars::named(name).expect("in the library");
    let grammar = known.grammar().unwrap_or_else(|error| panic!("{error}"));
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    let mut broken = Vec::new();
    for (park, outline) in parks().into_iter().chain(more()) {
        for seed in 0..if long { 25 } else { 2 } {
            match derive(&grammar, &outline, seed) {
                Ok(scene) => {
                    let found = scene.audit(&outline).violations;
                    broken.extend(found.iter().map(|w| format!("{park}, seed {seed}: {w}")));
                }
                Err(error) => broken.push(format!("{park}, seed {seed}: {error}")),
            }
        }
    }
    assert!(broken.is_empty(), "{name}\n{}", broken.join("\n"));
}

#[test]
fn simple_square() {
    check("simple_square");
}

#[test]
fn circular_paths() {
    check("circular_paths");
}

#[test]
fn free_form() {
    check("free_form");
}

#[test]
fn nested_grids() {
    check("nested_grids");
}

#[test]
fn irregular_grid() {
    check("irregular_grid");
}

#[test]
fn beam_park() {
    check("beam_park");
}

#[test]
fn pocket_park() {
    check("pocket_park");
}

#[test]
fn woodland() {
    check("woodland");
}

#[test]
fn formal_garden() {
    check("formal_garden");
}

#[test]
fn allotments() {
    check("allotments");
}

#[test]
fn texts_are_read_as_they_are_printed() {
    for one in &grammars::ALL {
        let tree = |text: &str| {
            let mut sources = Sources::default();
            sources.add(one.name, text);
            parse(&sources, 0).unwrap_or_else(|faults| panic!("{}\n{faults}", one.name))
        };
        let written = tree(one.text);
        assert_eq!(tree(&print(&written)), written, "{}", one.name);
        assert_eq!(grammars::named(one.name), Some(one));
        // What a landscape architect reads first says what the park is.
        assert!(
            written.items[0].comments.len() > 3 || written.head.len() > 3,
            "{}",
            one.name
        );
    }
}

/// The notes' own words, with rules for the names that they leave open, on a
/// square.
fn notes(side: f64, rules: &str) -> Scene {
    let square = park(&[(0., 0.), (side, 0.), (side, side), (0., side)], &[]);
    let grammar = Grammar::new(&format!("grammar 1\n{rules}")).expect("reads");
    let scene = derive(&grammar, &square, 0).expect("derives");
    let audit = scene.audit(&square);
    assert!(audit.is_lawful(), "{:?}", audit.violations);
    scene
}

fn count(scene: &Scene, material: &str) -> usize {
    let of = |piece: &&Piece| piece.material == material;
    scene.pieces.iter().filter(of).count()
}

#[test]
fn the_notes_nested_grid() {
    let scene = notes(
        40.0,
        "PathWidth = 2
         Region -> Grid(3 {2, 6, 2} , 2 {6} ) { NestedRegion } { CementPath }
         NestedRegion -> Grid { TreeRegion } { StonePath }
         TreeRegion -> GREEN_GRASS Place(CENTRE) { SmallTree }",
    );
    // Columns of 7.2, 21.6 and 7.2 m between paths of 2 m, rows of 19 m. Cells of 4 m
    // with paths of 2 m: (7.2 + 2) / 6 is nearest to 2, (21.6 + 2) / 6 to 4, and
    // (19 + 2) / 6 is half way from 3 to 4, which is rounded up.
    assert_eq!(count(&scene, "GREEN_GRASS"), 2 * (2 + 4 + 2) * 4);
    assert_eq!(count(&scene, "CementPath"), 1);
    assert_eq!(count(&scene, "StonePath"), 6);
    assert_eq!(scene.objects.len(), 64);
}

#[test]
fn the_notes_irregular_grid() {
    let scene = notes(
        40.0,
        "Region -> Grid (3 {[7,15]a[-15,15]}, 2) { NonWalkableRegion }
         NonWalkableRegion -> Grid (2 {a[-5,5]}, {[1.5,4]a[-25,25]}) { PlantedRegion } {}
         PlantedRegion -> Choose { GrassRegion, BushRegion, Plant1Region, Plant2Region /*, … */ }
         GrassRegion -> GREEN_GRASS
         BushRegion -> ShrubBed
         Plant1Region -> FlowerBed
         Plant2Region -> Planting",
    );
    // Six cells, each of two columns with several rows.
    assert_eq!(count(&scene, "Gravel"), 1);
    let planted = ["GREEN_GRASS", "ShrubBed", "FlowerBed", "Planting"];
    let planted = planted.map(|material| count(&scene, material));
    assert!(planted.iter().all(|&n| n > 0), "{planted:?}");
    assert!(planted.iter().sum::<usize>() >= 6 * 2 * 4, "{planted:?}");
}

#[test]
fn the_notes_circular_paths() {
    // The notes have the centre's block first here, and regions first where they
    // say what the rule is: that is the order.
    let scene = notes(
        40.0,
        "CentreRegionSize = 5
         Region -> CastRays(CentrePoint [CentreRegionSize], CastToList)
             { CutRegion } { Gravel } { CentreRegion }
         CentrePoint -> ScatterCircles(1 {15})
         CastToList -> Corners(Region)
         CentreRegion -> Fountain
         CutRegion -> Grass
         Grass -> GREEN_GRASS",
    );
    assert_eq!(count(&scene, "GREEN_GRASS"), 4);
    assert_eq!(scene.objects.len(), 1);
    // The circle of 15 m lies in the square.
    let at = scene.objects[0].at;
    assert!((15.0..=25.0).contains(&at.x) && (15.0..=25.0).contains(&at.y));
    // On the chords of a polygon of 36 corners.
    let round = |piece: &&Piece| {
        let ring = piece.polygon.exterior();
        ring.coords()
            .all(|c| ((c.x - at.x).hypot(c.y - at.y) - 5.0).abs() < 0.02)
    };
    assert_eq!(scene.pieces.iter().filter(round).count(), 1);
}

#[test]
fn the_notes_free_form() {
    let scene = notes(
        80.0,
        "Region -> VoronoiSmoothed(CircleRegions) { SmoothRegions } { Path }
         CircleRegions -> ScatterCircles(5 {[5-10]})
         SmoothRegions -> GREEN_GRASS
         Path -> Gravel",
    );
    assert_eq!(count(&scene, "GREEN_GRASS"), 5);
    assert!(count(&scene, "Gravel") >= 1);
}

#[test]
fn the_notes_simple_square() {
    let scene = notes(
        40.0,
        concat!(
            include_str!("notes/simple_square.park"),
            "ParkPath -> Gravel"
        ),
    );
    assert_eq!(count(&scene, "BLUE_GRASS"), 4);
    // The lawns, and the round ground of their trees, which is of the same.
    assert_eq!(count(&scene, "GREEN_GRASS"), 8);
    let of = |name: &str| scene.objects.iter().filter(|o| o.name == name).count();
    assert_eq!((of("Fountain"), of("Tree")), (1, 4));
    // Two sides of about 19 m, 2 m from tree to tree.
    assert!(of("TallTree") >= 4 * 18, "{}", of("TallTree"));
    assert!(!scene.volumes.is_empty());
}
