//! One rule for mirrored cells puts mirrored things.

mod common;

use park_grammar::geo_types::{Coord, Polygon};
use park_grammar::Scene;

fn derive(outline: &Polygon<f64>, rules: &str) -> Scene {
    common::park(outline, rules, 0).expect("derives")
}

fn rectangle() -> Polygon<f64> {
    common::rectangle(80., 50.)
}

const CELLS: [&str; 10] = [
    "Distribute(WEST: 2, 5) { 2: Tree | Lamp }",
    "Distribute(EDGE[0] or EDGE[1]: 1.5, 3, facing = along) { Bench | Lamp }",
    "Distribute(Part(ALL, [0.1, 0.45]): 1, 2, Exact) { Lamp }",
    "Distribute(Parametrise([0.1, 0.6], [0.5, 1], inset = 2), 2) { Bush }",
    "Place((0.8, 0.1), CORNER[1], EDGE[2]: 0.3, facing = 20) { Bench }",
    "Place(Along(Part(OUTER, [0.1, 0.9]), 4, offset = 2)) { Lamp }",
    "Distribute(Sector([10, 100]): 1, 2) { Lamp }",
    "Distribute(Angle([80, 100]) or Continuous(WEST): 1, 2) { Lamp }",
    "Distribute(Cardinal(NORTH, Grow): 1, 2, count = 4) { Lamp | Bin }",
    "Sweep(PATH: 0.3, 0.6) { Hedge } Distribute(not OUTER: 2, 3, Middles) { Flowers }",
];

/// Both mirror images of each object stand too, and look the mirrored way.
#[test]
fn quarters_are_mirror_images() {
    for cell in CELLS {
        let park = derive(
            &rectangle(),
            &format!("Region -> Grid(2, 2) {{ Cell }}\nCell -> {cell}"),
        );
        assert!(
            !park.objects.is_empty() && park.skipped == 0,
            "{cell}: {}",
            park.skipped
        );
        for object in &park.objects {
            let Coord { x, y } = object.at;
            let (cos, sin) = (object.facing.cos(), object.facing.sin());
            for (at, looks) in [((80.0 - x, y), (-cos, sin)), ((x, 50.0 - y), (cos, -sin))] {
                let found = park.objects.iter().any(|o| {
                    let same = (o.at.x - at.0).hypot(o.at.y - at.1) < 1e-5;
                    let turned = (o.facing.cos() - looks.0).hypot(o.facing.sin() - looks.1) < 1e-5;
                    same && turned && o.name == object.name
                });
                assert!(found, "{cell}: no image of {object:?}");
            }
        }
    }
}

/// The notes' simple square park but for the peeled strip.
#[test]
fn the_notes_square_park() {
    let rules = "Region -> Grid(2, 2) { GrassRegion } { Gravel } { Romb(3) Fountain }
GrassRegion -> GREEN_GRASS
    Place(CENTRE) { TreeRegion }
    DistributeSmooth(Boundary1(Perimeter), 0.8) { Bush }
fun Boundary1(area) = Parametrise([0.02, 1], [0, 1], [0, 0.15], 0, area, inset = 1)
TreeRegion -> Circle(1)
    Place(CENTRE) { Tree }";
    let park = derive(&rectangle(), rules);
    let count = |name: &str| park.objects.iter().filter(|o| o.name == name).count();
    assert_eq!((count("Tree"), count("Fountain"), park.skipped), (4, 1, 0));
    assert!(park.volumes.len() >= 4);
}
