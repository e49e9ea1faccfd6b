//! Laws of placing, on random outlines.

mod common;

use park_grammar::geo_types::{coord, LineString, Polygon};
use park_grammar::Scene;
use proptest::prelude::*;

use common::{clearance, config, mapped, size, within};

/// Grammars that put things in every way.
const GRAMMARS: [&str; 8] = [
    "Region -> Scatter(40) { 3: Tree | 2: Bush | Bench }",
    "Region -> Scatter(Poisson, room = 1.5) { Tree }",
    "Region -> Distribute(ALL, 6) { 2: Tree | Lamp } Scatter(20) { SmallTree }",
    "Region -> ScatterCircles(4 {[1.5-4]}) { Gravel Statue } Scatter(20, room = 0.6) { Tree } Distribute(ALL: 1, 4) { Lamp }",
    "Region -> Sweep(WEST or NORTH: 0.5, 0.8) { Hedge } Distribute(ALL: 1, 3) { Bush } Place(CENTRE, (0.3, 0.7)) { Fountain }",
    "Region -> Place(CENTRE) { Tree } Sweep([(0.1, 0.5), (0.9, 0.5)], 1) { Wall } Sweep(AREA, height = 1) { Bush }",
    "Region -> Distribute(Part(ALL, [0.2, 0.9]): 1.5, 3, Through) { Circle(0.8) Soil Tree }",
    "Region -> Distribute(Parametrise([0.1, 0.9], [0, 0.5], inset = 2), 2, Middles) { Lamp } Place(CORNER[0], CORNER[2], Along(ALL, 7)) { Bench }",
];

/// Star-shaped outlines of 4 to 24 vertices, turned and moved.
fn outlines() -> impl Strategy<Value = Polygon<f64>> {
    let radii = prop::collection::vec(8.0..40.0f64, 4..24);
    (radii, 0.0..6.3f64, -1e4..1e4f64).prop_map(|(radii, turn, away)| {
        let n = radii.len() as f64;
        let ring = radii.iter().enumerate().map(|(k, r)| {
            let angle = turn + std::f64::consts::TAU * k as f64 / n;
            coord! { x: away + r * angle.cos(), y: r * angle.sin() - away }
        });
        Polygon::new(LineString(ring.collect()), Vec::new())
    })
}

fn derive(rules: &str, outline: &Polygon<f64>, seed: u64) -> Scene {
    common::park(outline, rules, seed).expect("derives")
}

/// That every footprint lies on one piece of ground, clear of all others, of
/// volumes and of other footprints.
fn lawful(scene: &Scene, park: &Polygon<f64>) -> Result<(), TestCaseError> {
    let eps = 1e-5;
    for (k, object) in scene.objects.iter().enumerate() {
        prop_assert!(within(park, object.at), "outside {object:?}");
        prop_assert!(
            clearance(park, object.at) >= object.radius - eps,
            "over the edge {object:?}"
        );
        for other in &scene.objects[..k] {
            let far = (object.at.x - other.at.x).hypot(object.at.y - other.at.y);
            prop_assert!(
                far >= object.radius + other.radius - eps,
                "{object:?} {other:?}"
            );
        }
        for volume in &scene.volumes {
            prop_assert!(!within(&volume.polygon, object.at));
            prop_assert!(clearance(&volume.polygon, object.at) >= object.radius - eps);
        }
        let under = scene
            .pieces
            .iter()
            .filter(|p| within(&p.polygon, object.at));
        let under: Vec<_> = under.collect();
        prop_assert_eq!(under.len(), 1);
        prop_assert!(clearance(&under[0].polygon, object.at) >= object.radius - eps);
        prop_assert_eq!(under[0].ground, object.ground);
    }
    let volumes: f64 = scene.volumes.iter().map(|v| size(&v.polygon)).sum();
    prop_assert!(volumes <= size(park) * (1.0 + 1e-9));
    let ground: f64 = scene.pieces.iter().map(|p| size(&p.polygon)).sum();
    prop_assert!(
        (ground - size(park)).abs() <= 1e-7 * size(park),
        "{ground} {}",
        size(park)
    );
    Ok(())
}

proptest! {
    #![proptest_config(config(48, 4800))]

    #[test]
    fn things_have_their_own_ground(park in outlines(), k in 0..8usize, seed in any::<u64>()) {
        let scene = derive(GRAMMARS[k], &park, seed);
        lawful(&scene, &park)?;
        prop_assert_eq!(scene, derive(GRAMMARS[k], &park, seed));
    }

    /// Rows and hedges know no chance: moved parks have moved ones.
    #[test]
    fn rows_move_with_the_park(park in outlines(), x in -500.0..500.0f64, y in -500.0..500.0f64) {
        let rules = "Region -> Sweep(NORTH: 0.5, 0.8) { Hedge } Distribute(SOUTH: 1, 3) { Bush }";
        let by = coord! { x: x, y: y };
        let moved = mapped(&park, |c| c + by);
        let (a, b) = (derive(rules, &park, 1), derive(rules, &moved, 1));
        prop_assert_eq!(a.objects.len(), b.objects.len());
        for (p, q) in a.objects.iter().zip(&b.objects) {
            let off = q.at - p.at - by;
            prop_assert!(off.x.hypot(off.y) < 1e-5);
        }
        prop_assert_eq!(a.volumes.len(), b.volumes.len());
    }
}
