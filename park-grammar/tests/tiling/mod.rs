//! Outlines of any shape, and the law that pieces tile them.

// Each test uses some of it.
#![allow(dead_code)]

use park_grammar::geo_types::{Coord, Line, LineString, Polygon};
use park_grammar::{DeriveOptions, Grammar, ParkError, Scene};
use proptest::collection::vec;
use proptest::prelude::*;

/// Few cases, or with `URBAN_LAYOUT_LONG` many.
pub fn config(few: u32, many: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    ProptestConfig::with_cases(if long { many } else { few })
}

pub fn park(outline: &Polygon<f64>, rules: &str, seed: u64) -> Result<Scene, ParkError> {
    let grammar = Grammar::new(&format!("grammar 1\n{rules}"))?;
    let options = DeriveOptions {
        seed,
        ..DeriveOptions::default()
    };
    grammar.derive(outline, &options)
}

fn signed(line: &LineString<f64>) -> f64 {
    let origin = line.0[0];
    let part = |l: Line<f64>| {
        let (a, b) = (l.start - origin, l.end - origin);
        a.x * b.y - a.y * b.x
    };
    line.lines().map(part).sum::<f64>() / 2.0
}

pub fn size(polygon: &Polygon<f64>) -> f64 {
    let holes: f64 = polygon.interiors().iter().map(|r| signed(r).abs()).sum();
    signed(polygon.exterior()).abs() - holes
}

pub fn within(polygon: &Polygon<f64>, p: Coord<f64>) -> bool {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    let crosses = |a: Coord<f64>, b: Coord<f64>| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)
    };
    let lines = rings.flat_map(|ring| ring.lines());
    lines.filter(|l| crosses(l.start, l.end)).count() % 2 == 1
}

/// How far a point is from any edge of a polygon.
pub fn clearance(polygon: &Polygon<f64>, p: Coord<f64>) -> f64 {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    let away = |l: Line<f64>| {
        let (d, v) = (l.delta(), p - l.start);
        let square = d.x * d.x + d.y * d.y;
        let t = if square > 0.0 {
            ((v.x * d.x + v.y * d.y) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (v.x - t * d.x).hypot(v.y - t * d.y)
    };
    let lines = rings.flat_map(|ring| ring.lines());
    lines.map(away).fold(f64::MAX, f64::min)
}

/// A polygon of any shape around a middle, up to 40 vertices, concave as a rule,
/// turned, with a hole or without.
pub fn outline() -> impl Strategy<Value = Polygon<f64>> {
    let ring = vec((0.2..1.0_f64, 20.0..90.0_f64), 4..=40);
    (ring, 0.0..6.3_f64, any::<bool>()).prop_map(|(steps, start, hole)| {
        let whole: f64 = steps.iter().map(|s| s.0).sum();
        let mut angle = start;
        let points: Vec<Coord<f64>> = steps
            .iter()
            .map(|(step, radius)| {
                angle += step / whole * std::f64::consts::TAU;
                Coord {
                    x: radius * angle.cos(),
                    y: radius * angle.sin(),
                }
            })
            .collect();
        // Within half of the least distance of an edge between two vertices.
        let round = |k: u32| f64::from(k) / 6.0 * std::f64::consts::TAU + start;
        let inner = (0..6).map(|k| Coord {
            x: 3.0 * round(k).cos(),
            y: 3.0 * round(k).sin(),
        });
        let holes = if hole && steps.len() > 8 {
            vec![inner.collect()]
        } else {
            Vec::new()
        };
        Polygon::new(LineString(points), holes)
    })
}

/// Pieces have all of the outline's area, lie inside, and each of some points lies
/// in one of them.
pub fn is_tiled(
    outline: &Polygon<f64>,
    scene: &Scene,
    points: &[(f64, f64)],
) -> Result<(), TestCaseError> {
    let whole = size(outline);
    let all: f64 = scene.pieces.iter().map(|p| size(&p.polygon)).sum();
    prop_assert!((all / whole - 1.0).abs() < 1e-9, "{all} of {whole}");
    for piece in &scene.pieces {
        prop_assert!(signed(piece.polygon.exterior()) > 0.0);
        for p in &piece.polygon.exterior().0 {
            prop_assert!(
                within(outline, *p) || clearance(outline, *p) < 1e-7,
                "{p:?} is outside"
            );
        }
    }
    for &(x, y) in points {
        let p = Coord { x, y };
        let mut pieces = scene.pieces.iter();
        if pieces.any(|piece| clearance(&piece.polygon, p) <= 1e-7) {
            continue;
        }
        let holding = scene
            .pieces
            .iter()
            .filter(|piece| within(&piece.polygon, p));
        prop_assert_eq!(holding.count(), usize::from(within(outline, p)));
    }
    Ok(())
}
