//! Laws of the audit itself: what it measures adds up, and does not depend on
//! where the park lies or how it is turned.

mod common;

use park_grammar::geo_types::{coord, Coord, LineString, Polygon};
use park_grammar::scene::{Ground, Piece};
use park_grammar::{Audit, Scene};
use proptest::prelude::*;

use common::{config, mapped, size};

/// A star-shaped ring: simple, concave as a rule.
fn star() -> impl Strategy<Value = Polygon<f64>> {
    let radii = proptest::collection::vec(3.0..20.0_f64, 3..16);
    (radii, -15.0..15.0_f64, -15.0..15.0_f64).prop_map(|(radii, x, y)| {
        let n = radii.len() as f64;
        let points = radii.iter().enumerate().map(|(k, r)| {
            let angle = std::f64::consts::TAU * (k as f64 + 0.3) / n;
            coord! { x: x + r * angle.cos(), y: y + r * angle.sin() }
        });
        Polygon::new(LineString(points.collect()), Vec::new())
    })
}

fn scene(pieces: &[Polygon<f64>]) -> Scene {
    let piece = |polygon: &Polygon<f64>| Piece {
        polygon: polygon.clone(),
        ground: Ground::Region,
        material: "Lawn".to_owned(),
        rule: "Region".to_owned(),
    };
    Scene {
        pieces: pieces.iter().map(piece).collect(),
        ..Scene::default()
    }
}

fn figures(audit: &Audit) -> [f64; 4] {
    [audit.area, audit.gap, audit.overlap, audit.outside]
}

proptest! {
    #![proptest_config(config(60, 2000))]

    /// What pieces cover is the outline, less the gap, and what they cover again
    /// or outside.
    #[test]
    fn land_adds_up(outline in star(), pieces in proptest::collection::vec(star(), 0..6)) {
        let [whole, gap, overlap, outside] = figures(&scene(&pieces).audit(&outline));
        let covered: f64 = pieces.iter().map(size).sum();
        prop_assert!((whole - size(&outline)).abs() < 1e-9);
        prop_assert!(gap >= 0.0 && overlap >= 0.0 && outside >= 0.0 && gap <= whole + 1e-9);
        prop_assert!((covered - (whole - gap + overlap + outside)).abs() < 1e-8);
    }

    #[test]
    fn figures_stay_when_all_is_moved(
        outline in star(),
        pieces in proptest::collection::vec(star(), 1..5),
        angle in 0.0..6.3_f64,
        mirror in any::<bool>(),
    ) {
        let before = figures(&scene(&pieces).audit(&outline));
        let (sin, cos) = angle.sin_cos();
        let to = |c: Coord<f64>| {
            let x = if mirror { -c.x } else { c.x };
            coord! { x: 4e5 + x * cos - c.y * sin, y: 6.7e6 + x * sin + c.y * cos }
        };
        let there: Vec<_> = pieces.iter().map(|p| mapped(p, to)).collect();
        let after = figures(&scene(&there).audit(&mapped(&outline, to)));
        // Coordinates there have 1e-9 m left.
        for (a, b) in before.iter().zip(after) {
            prop_assert!((a - b).abs() < 1e-5, "{before:?} {after:?}");
        }
    }

    /// A piece is its own outline, whatever its form.
    #[test]
    fn an_outline_is_tiled_by_itself(outline in star()) {
        prop_assert!(scene(std::slice::from_ref(&outline)).audit(&outline).is_lawful());
    }
}
