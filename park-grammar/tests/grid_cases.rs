//! What `Grid` and `FitRectangle` make, by examples with known answers.

mod common;

use park_grammar::geo_types::{polygon, Coord, Polygon};
use park_grammar::scene::Piece;
use park_grammar::{ParkError, Scene};

use common::{near, of, rectangle, size};

fn park(outline: &Polygon<f64>, rules: &str) -> Result<Scene, ParkError> {
    common::park(outline, rules, 0)
}

/// Width and height of a piece's extent.
fn extent(piece: &Piece) -> [f64; 2] {
    let points = &piece.polygon.exterior().0;
    let fold = |of: &dyn Fn(&Coord<f64>) -> f64| {
        let most = |sign: f64| points.iter().map(|p| sign * of(p)).fold(f64::MIN, f64::max);
        most(1.0) + most(-1.0)
    };
    [fold(&|p| p.x), fold(&|p| p.y)]
}

/// The notes' simple square park: four quarters without a third of the romb
/// each, one path with four arms, and the romb of 2 * 3 * 3 square metres.
#[test]
fn the_simple_square_park() {
    let rules = "PathWidth = 2\nRegion -> Grid(2, 2) { Quarter } { CementPath } { Romb(3) Gravel Fountain }\nQuarter -> GREEN_GRASS Place(CENTRE) { Tree }";
    let scene = park(&rectangle(80.0, 50.0), rules).expect("derives");
    let quarters = of(&scene, "GREEN_GRASS");
    assert_eq!(quarters.len(), 4);
    // The romb takes a triangle of 1 x 1 beyond the crossing from each.
    assert!(quarters
        .iter()
        .all(|q| near(size(&q.polygon), 39.0 * 24.0 - 0.5)));
    let centre = of(&scene, "Gravel");
    assert!(centre.len() == 1 && near(size(&centre[0].polygon), 18.0));
    // Arms of 39 - 2 and 24 - 2 up to the romb, and pieces between its sides.
    let paths = of(&scene, "CementPath");
    assert_eq!(paths.len(), 4);
    let fountain = scene.objects.iter().find(|o| o.name == "Fountain");
    assert!(fountain.is_some_and(|f| near(f.at.x, 40.0) && near(f.at.y, 25.0)));
    assert_eq!(scene.objects.len(), 5);
}

/// A third block without a shape is done on the crossings themselves.
#[test]
fn crossings_are_centres() {
    let rules = "Region -> Grid(3, 2, width = 2) { Meadow } { Paving } { Gravel Lamp }";
    let scene = park(&rectangle(82.0, 50.0), rules).expect("derives");
    let centres = of(&scene, "Gravel");
    assert_eq!(centres.len(), 2);
    assert!(centres.iter().all(|c| near(size(&c.polygon), 4.0)));
    assert_eq!(scene.objects.len(), 2);
    // Two columns of two arms each, and three pieces of the row between.
    let paths = of(&scene, "Paving");
    assert_eq!(paths.len(), 7);
    let all: f64 = paths.iter().map(|p| size(&p.polygon)).sum();
    assert!(near(all, 2.0 * (2.0 * 48.0) + 2.0 * 78.0), "{all}");
    assert_eq!(of(&scene, "Meadow").len(), 6);
    // With a bar in the place of a block too; an empty block makes none, nor is
    // there a crossing where there are no paths.
    for (blocks, count) in [
        ("{ Meadow | Paving | Gravel }", 2),
        ("{ Meadow } { Paving } {}", 0),
        ("{ Meadow } {} { Gravel }", 0),
    ] {
        let rules = format!("Region -> Grid(3, 2) {blocks}");
        let scene = park(&rectangle(82.0, 50.0), &rules).expect("derives");
        assert_eq!(of(&scene, "Gravel").len(), count, "{blocks}");
    }
    // Lines that lean by 45 degrees make crossings of 2 m by 2 m / cos 45.
    let rules = "Region -> Grid(2 {a 45}, 2, width = 2) { Meadow } { Paving } { Gravel }";
    let scene = park(&rectangle(80.0, 50.0), rules).expect("derives");
    let centres = of(&scene, "Gravel");
    assert!(centres.len() == 1 && near(size(&centres[0].polygon), 4.0 * 2_f64.sqrt()));
    assert_eq!(of(&scene, "Paving").len(), 4);
}

/// One block with bars is the same as three blocks.
#[test]
fn the_alternative_notation() {
    let square = rectangle(80.0, 50.0);
    let three = park(
        &square,
        "Region -> Grid(2, 3) { Meadow } { Paving } { Circle(3) Water }",
    );
    let one = park(
        &square,
        "Region -> Grid(2, 3) { Meadow | Paving | Circle(3) Water }",
    );
    assert_eq!(three.expect("derives"), one.expect("derives"));
}

/// Empty braces: no paths, and so that a fourth block keeps its place.
#[test]
fn empty_braces_are_no_paths() {
    let scene = park(&rectangle(80.0, 50.0), "Region -> Grid(4, 5) { Meadow } {}");
    let scene = scene.expect("derives");
    assert_eq!(scene.pieces.len(), 20);
    assert!(scene.pieces.iter().all(|p| near(size(&p.polygon), 200.0)));
    let rules = "Region -> Grid(2 {10}, 2 {10}, Exact) { Meadow } {} {} { Sand }";
    let scene = park(&rectangle(80.0, 50.0), rules).expect("derives");
    let around: f64 = of(&scene, "Sand").iter().map(|p| size(&p.polygon)).sum();
    assert!(near(around, 80.0 * 50.0 - 400.0));
}

/// `3 {2, 6, 2}` in 24 m with paths of 2: sizes are doubled.
#[test]
fn sizes_fill_the_region() {
    let rules = "Region -> Grid(3 {2, 6, 2}, 1, width = 2) { Meadow } { Paving }";
    let scene = park(&rectangle(24.0, 10.0), rules).expect("derives");
    let widths: Vec<f64> = of(&scene, "Meadow").iter().map(|p| extent(p)[0]).collect();
    assert_eq!(widths.len(), 3);
    assert!(near(widths[0], 4.0) && near(widths[1], 12.0) && near(widths[2], 4.0));
}

/// As they are, the rest lies on either side.
#[test]
fn exact_sizes_leave_a_rest() {
    let rules = "Region -> Grid(3 {2, 6, 2}, 1 {10}, Exact, width = 2) { Meadow } { Paving } { Lawn } { Sand }";
    let scene = park(&rectangle(24.0, 10.0), rules).expect("derives");
    let rest = of(&scene, "Sand");
    assert_eq!(rest.len(), 2);
    assert!(rest.iter().all(|p| near(size(&p.polygon), 50.0)));
    let error = park(&rectangle(9.0, 10.0), rules).expect_err("no room");
    assert!(error.to_string().contains("do not fit"), "{error}");
}

/// Nothing said: cells of 4 m.
#[test]
fn a_grid_without_numbers_is_fitted() {
    let scene = park(
        &rectangle(22.0, 10.0),
        "Region -> Grid { Meadow } { Paving }",
    );
    // 4 x 2: (22 + 2) / (4 + 2) columns and (10 + 2) / (4 + 2) rows.
    let scene = scene.expect("derives");
    assert_eq!(of(&scene, "Meadow").len(), 8);
    assert!(of(&scene, "Meadow")
        .iter()
        .all(|p| near(size(&p.polygon), 16.0)));
}

/// The notes' nested grids.
#[test]
fn nested_grids() {
    let rules = "PathWidth = 2\nRegion -> Grid(3 {2, 6, 2}, 2 {6}) { Nested } { CementPath }\nNested -> Grid { Meadow } { StonePath }";
    let scene = park(&rectangle(24.0, 14.0), rules).expect("derives");
    // Cells of 4 x 6 m hold one of 4 x 6, those of 12 x 6 two of 5 x 6.
    let cells = of(&scene, "Meadow");
    assert_eq!(cells.len(), 8);
    assert!(cells.iter().all(|p| near(extent(p)[1], 6.0)));
}

/// A line that leans 45 degrees about its middle.
#[test]
fn lines_lean_about_their_middle() {
    let rules = "Region -> Grid(2 {a 45}, 1) { Meadow } {}";
    let scene = park(&rectangle(20.0, 10.0), rules).expect("derives");
    let sizes: Vec<f64> = scene.pieces.iter().map(|p| size(&p.polygon)).collect();
    assert!(near(sizes[0], 100.0) && near(sizes[1], 100.0), "{sizes:?}");
    // Counter-clockwise: its upper end lies 5 m to the west.
    let west = &scene.pieces[0].polygon.exterior().0;
    let top: Vec<&Coord<f64>> = west.iter().filter(|p| p.y > 9.9).collect();
    assert!(top.iter().all(|p| p.x < 5.0 + 1e-9), "{west:?}");
}

/// A region without right angles is fitted, or refused where that was asked.
#[test]
fn guarantees_are_kept() {
    // Angles of 45 and 135 degrees.
    let slanted = polygon![(x: 0., y: 0.), (x: 30., y: 0.), (x: 40., y: 10.), (x: 10., y: 10.)];
    let error = park(&slanted, "Region -> Grid(2, 2, fit = own) { Meadow }").expect_err("slanted");
    assert!(error.to_string().contains("45 degrees"), "{error}");
    let own = "Region -> Grid(2, 1, fit = own, min_angle = 45) { Meadow } {}";
    let scene = park(&slanted, own).expect("derives");
    assert!(scene.pieces.iter().all(|p| near(size(&p.polygon), 150.0)));
    let scene = park(&slanted, "Region -> Grid(2, 2) { Meadow }").expect("a box is fitted");
    let all: f64 = scene.pieces.iter().map(|p| size(&p.polygon)).sum();
    assert!(near(all, 300.0));
    let rules = "Region -> Grid(2, 2, min_area = 301) { Meadow } else { Sand }";
    let scene = park(&slanted, rules).expect("else");
    assert_eq!(of(&scene, "Sand").len(), 1);
}

/// All fits make exact partitions of an L with a slant, and what lies outside
/// is an output.
#[test]
fn every_fit_divides() {
    let l = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 60., y: 20.), (x: 25., y: 24.), (x: 20., y: 50.), (x: 0., y: 50.)];
    for fit in [
        "oriented",
        "bounding",
        "axis",
        "inscribed",
        "optimised",
        "indexed",
        "meeting",
        "blend",
    ] {
        let rules = format!(
            "Region -> Grid(3, 3, fit = {fit}, min_angle = 10) {{ Meadow }} {{ Paving }} {{ Circle(2) Water }} {{ Sand }}"
        );
        let scene = park(&l, &rules).unwrap_or_else(|e| panic!("{fit}: {e}"));
        let all: f64 = scene.pieces.iter().map(|p| size(&p.polygon)).sum();
        assert!((all / size(&l) - 1.0).abs() < 1e-9, "{fit}: {all}");
        let outside = of(&scene, "Sand").len();
        let around = ["oriented", "bounding"].contains(&fit);
        assert_eq!(outside == 0, around, "{fit}");
    }
}

/// A blend of the box around and the largest rectangle inside lies between.
#[test]
fn blends_lie_between() {
    let triangle = polygon![(x: 0., y: 0.), (x: 40., y: 0.), (x: 20., y: 30.)];
    let fitted = |factor: f64| {
        let rules = format!(
            "Region -> FitRectangle(fit = blend, of = [bounding, axis], factor = {factor}) {{ Meadow | Sand }}"
        );
        let scene = park(&triangle, &rules).expect("derives");
        of(&scene, "Meadow")
            .iter()
            .map(|p| size(&p.polygon))
            .sum::<f64>()
    };
    // The box holds all, the largest rectangle half: 20 x 15 of 600.
    assert!(near(fitted(0.0), 600.0));
    assert!((fitted(1.0) - 300.0).abs() < 1e-2, "{}", fitted(1.0));
    // 30 x 22.5 around the middle line, less what sticks out of the triangle.
    assert!(fitted(0.5) > 300.0 && fitted(0.5) < 600.0);
}

/// `Place((0.8, 0.1))` of the notes' picture: near the paths, at the region's
/// edge, in all four quadrants.
#[test]
fn places_are_mirrored() {
    let rules = "Region -> Grid(2, 2, width = 4) { Quarter } { Paving }\nQuarter -> Place((0.8, 0.1)) { Bush }";
    let scene = park(&rectangle(84.0, 44.0), rules).expect("derives");
    let mut at: Vec<(f64, f64)> = scene.objects.iter().map(|o| (o.at.x, o.at.y)).collect();
    at.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let wanted = [(32., 2.), (32., 42.), (52., 2.), (52., 42.)];
    for (found, wanted) in at.iter().zip(wanted) {
        assert!(near(found.0, wanted.0) && near(found.1, wanted.1), "{at:?}");
    }
}

/// The notes' four ways with a middle column, of 10 m cells without paths.
#[test]
fn middle_columns() {
    let places = |arguments: &str| {
        let rules = format!(
            "Region -> Grid(3, 1{arguments}) {{ Cell }} {{}}\nCell -> Place((0.8, 0.5)) {{ Bush }}"
        );
        let scene = park(&rectangle(30.0, 10.0), &rules).expect("derives");
        scene
            .objects
            .iter()
            .map(|o| o.at.x.round() as i64)
            .collect::<Vec<_>>()
    };
    assert_eq!(places(""), [8, 15, 22]);
    assert_eq!(places(", middle = centre"), [8, 15, 22]);
    assert_eq!(places(", middle = left"), [8, 22]);
    assert_eq!(places(", middle = right"), [8, 22]);
    assert_eq!(places(", middle = local"), [8, 18, 22]);
}

/// What goes on beyond 1 is drawn in the middle column alone: from the left or
/// from the right.
#[test]
fn extended_coordinates() {
    let places = |count: usize, arguments: &str, x: f64| {
        let rules = format!(
            "Region -> Grid({count}, 1, {arguments}) {{ Cell }} {{}}\nCell -> Place(({x}, 0.5)) {{ Bush }}"
        );
        let scene = park(&rectangle(10.0 * count as f64, 10.0), &rules).expect("derives");
        scene
            .objects
            .iter()
            .map(|o| o.at.x.round() as i64)
            .collect::<Vec<_>>()
    };
    assert_eq!(places(3, "middle = right", 1.2), [12]);
    assert_eq!(places(3, "middle = left", 1.2), [18]);
    assert_eq!(places(4, "symmetry = mirror", 0.8), [8, 18, 22, 32]);
    assert_eq!(places(4, "symmetry = pair", 0.8), [8, 12, 28, 32]);
    assert_eq!(places(4, "symmetry = extended", 0.8), [8, 32]);
    assert_eq!(places(4, "symmetry = extended", 1.8), [18, 22]);
}

/// Cells know where they are.
#[test]
fn cells_have_a_boundary_metric() {
    let rules = "Region -> Grid(5, 5) { Cell } {}\nCell -> Case { metric_x == 0 and metric_y == 0: Sand | metric_x == 2 and metric_y == 2: Water | column == 1 and row == 0: Soil | else: Meadow }";
    let scene = park(&rectangle(50.0, 50.0), rules).expect("derives");
    let count = |material| of(&scene, material).len();
    assert_eq!((count("Sand"), count("Water"), count("Soil")), (4, 1, 1));
    let soil = of(&scene, "Soil")[0].polygon.exterior().0[0];
    assert!(soil.x >= 10.0 - 1e-9 && soil.x <= 20.0 + 1e-9 && soil.y <= 10.0 + 1e-9);
}

/// A pentagon points away from the region's edge in all quadrants, nested ones
/// too.
#[test]
fn centres_are_mirrored_with_their_cell() {
    let rules = "Region -> Grid(2, 2) { Cell } {}\nCell -> Grid(2, 2) { Meadow } { Paving } { Polygon(5, 4) Water }";
    let scene = park(&rectangle(80.0, 80.0), rules).expect("derives");
    let centres = of(&scene, "Water");
    assert_eq!(centres.len(), 4);
    for centre in centres {
        let points = &centre.polygon.exterior().0;
        let towards = points
            .iter()
            .map(|p| (p.y - 40.0).abs())
            .fold(f64::MAX, f64::min);
        // Its tip, 4 m from its middle, which lies 20 m from the park's.
        assert!(near(towards, 16.0), "{towards}");
    }
}

#[test]
fn nonsense_is_refused() {
    for (rules, what) in [
        ("Region -> Grid(0, 2) { Meadow }", "1 to 100,000"),
        ("Region -> Grid(2.5, 2) { Meadow }", "1 to 100,000"),
        ("Region -> Grid(2 {0}, 2) { Meadow }", "positive"),
        ("Region -> Grid(2 {a 85}, 2) { Meadow }", "80 degrees"),
        (
            "Region -> Grid(2, 2, fit = left) { Meadow }",
            "fit is own, oriented",
        ),
        ("Region -> Grid(2, 2, middle = own) { Meadow }", "middle is"),
        (
            "Region -> Grid(2, 2, of = [blend, own]) { Meadow }",
            "two fits",
        ),
        (
            "Region -> Grid(2, 2, exact) { Meadow }",
            "did you mean Exact?",
        ),
        (
            "Region -> Grid(2, 2, Through) { Meadow }",
            "its flags are Exact, Apart",
        ),
        (
            "Region -> Grid(2, 2, fit = Oriented) { Meadow }",
            "did you mean oriented?",
        ),
        (
            "Region -> Grid(2, 2, middle = CENTRE) { Meadow }",
            "did you mean centre?",
        ),
        (
            "Region -> Grid(2, 2, widht = 3) { Meadow }",
            "did you mean width",
        ),
        ("Region -> Grid(90, 2) { Meadow }", "do not fit"),
        ("Region -> Grid({0.01}, {0.01}) { Meadow } {}", "too many"),
        ("Region -> Grid(2, 2, size = 0) { Meadow }", "positive"),
    ] {
        let error = park(&rectangle(80.0, 50.0), rules).expect_err(rules);
        assert!(error.to_string().contains(what), "{rules}: {error}");
    }
}

/// A path once had two arms joined by a hair: along the edge of a centre that had
/// been cut out of cells, and along the arcs of a cell that a nested grid divided.
#[test]
fn paths_have_no_hairs() {
    let rules = "Region -> Grid(2, 2, width = 2) { Cell } { Asphalt } { Circle(3) Sand }\nCell -> Grid(2, 2, width = 1) { Meadow } { Paving } { Romb(2) Water }";
    let scene = park(&rectangle(80.0, 50.0), rules).expect("derives");
    assert_eq!(of(&scene, "Asphalt").len(), 4);
    assert_eq!(of(&scene, "Paving").len(), 16);
    let longest = |p: &Piece| extent(p)[0].max(extent(p)[1]);
    assert!(of(&scene, "Paving").iter().all(|p| longest(p) < 20.0));
}

/// A cell once hung together by a hair between a centre and the region's edge that
/// had cut the centre off: whether it did depended on where the park lay.
#[test]
fn cells_have_no_hairs_beside_centres() {
    let corners = [
        (52.86457949273027, -61.7047256807094),
        (18.483567261209718, -7.639223867667209),
        (19.861366588919655, -2.3507694954091023),
        (78.5930776564524, 21.472905274063283),
        (16.808431902149774, 10.838663062887125),
        (12.021350216864477, 15.98396505762861),
        (18.36140920886932, 50.094495566508684),
        (2.811800943938417, 19.80135791938692),
        (-0.7910416408386638, 19.98435020515952),
        (-34.75979141467197, 79.641567548088),
        (-13.223305349941374, 15.004805750899004),
        (-74.49974578508848, 30.275494957996056),
        (-19.39838204185896, 4.868549492208529),
        (-19.905303060558236, 1.9439418888770548),
        (-19.1001844788669, -5.931521969381208),
        (-57.36489210817304, -49.529838582131575),
        (-15.211082114631635, -25.21575227039927),
        (-2.1884783188827446, -19.87990348688293),
        (3.686526490414079, -19.657302013131794),
        (10.019764518549426, -28.000865037592664),
        (38.20556731086746, -68.13308881137479),
    ];
    let rules = "Region -> Grid(4, 4, fit = oriented) { Meadow } { Paving } { Circle(2) Sand }";
    let count = |by: f64| {
        let ring = corners.iter().map(|&(x, y)| Coord { x, y: y + by });
        let outline = Polygon::new(ring.collect(), Vec::new());
        park(&outline, rules).expect("derives").pieces.len()
    };
    assert_eq!(count(0.0), count(-6125.796442092385));
}
