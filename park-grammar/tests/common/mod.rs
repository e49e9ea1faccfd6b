//! What tests have in common: outlines, parks, and whether pieces tile.

#![allow(unreachable_pub, dead_code, reason = "each test takes what it needs")]

use park_grammar::geo_types::{Coord, Line, LineString, Polygon};
use park_grammar::scene::Piece;
use park_grammar::{DeriveOptions, Grammar, ParkError, Scene};
use proptest::collection::vec;
use proptest::prelude::*;

/// Few cases, or with `URBAN_LAYOUT_LONG` many.
pub fn config(few: u32, many: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    let cases = if long { many } else { few };
    ProptestConfig {
        cases,
        // Some laws hold for a part of what is drawn only.
        max_global_rejects: 20 * cases,
        ..ProptestConfig::default()
    }
}

pub fn park(outline: &Polygon<f64>, rules: &str, seed: u64) -> Result<Scene, ParkError> {
    let grammar = Grammar::new(&format!("grammar 1\n{rules}"))?;
    let options = DeriveOptions {
        seed,
        ..DeriveOptions::default()
    };
    grammar.derive(outline, &options)
}

pub fn rectangle(width: f64, height: f64) -> Polygon<f64> {
    polygon(&[(0., 0.), (width, 0.), (width, height), (0., height)])
}

pub fn polygon(points: &[(f64, f64)]) -> Polygon<f64> {
    Polygon::new(
        points.iter().map(|&(x, y)| Coord { x, y }).collect(),
        vec![],
    )
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

fn lines(polygon: &Polygon<f64>) -> impl Iterator<Item = Line<f64>> + '_ {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    rings.flat_map(|ring| ring.lines())
}

pub fn within(polygon: &Polygon<f64>, p: Coord<f64>) -> bool {
    let crosses = |a: Coord<f64>, b: Coord<f64>| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)
    };
    lines(polygon).filter(|l| crosses(l.start, l.end)).count() % 2 == 1
}

/// How far a point is from any edge of a polygon.
pub fn clearance(polygon: &Polygon<f64>, p: Coord<f64>) -> f64 {
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
    lines(polygon).map(away).fold(f64::MAX, f64::min)
}

/// Where the middle of a polygon's mass lies.
pub fn middle(polygon: &Polygon<f64>) -> Coord<f64> {
    let (mut sum, mut doubled) = (Coord::default(), 0.0);
    let origin = polygon.exterior().0[0];
    for line in lines(polygon) {
        let (a, b) = (line.start - origin, line.end - origin);
        let part = a.x * b.y - a.y * b.x;
        sum = sum + (a + b) * part;
        doubled += part;
    }
    origin + sum / (3.0 * doubled)
}

/// The pieces of a material.
pub fn of<'s>(scene: &'s Scene, material: &str) -> Vec<&'s Piece> {
    let wanted = scene.pieces.iter().filter(|p| p.material == material);
    wanted.collect()
}

/// The size of all pieces.
pub fn sum(pieces: &[&Piece]) -> f64 {
    pieces.iter().map(|p| size(&p.polygon)).sum()
}

/// The size of all that is of a material.
pub fn total(scene: &Scene, material: &str) -> f64 {
    sum(&of(scene, material))
}

/// To six digits behind the point, where trigonometry has a part.
pub fn close(found: f64, wanted: f64) -> bool {
    (found - wanted).abs() < 1e-6
}

pub fn near(found: f64, wanted: f64) -> bool {
    (found - wanted).abs() < 1e-9 * wanted.abs().max(1.0)
}

/// A polygon of any shape around a middle, up to 40 vertices, concave as a rule.
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

/// Outlines of right angles only: what lies under two skylines, turned.
pub fn stairs() -> impl Strategy<Value = Polygon<f64>> {
    let column = (1.0..12.0_f64, 4.0..30.0_f64, 4.0..30.0_f64);
    (vec(column, 2..=9), 0..8_u32).prop_map(|(columns, turn)| {
        let mut x = 0.0;
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for (width, up, down) in columns {
            above.extend([(x, up), (x + width, up)]);
            below.extend([(x, -down), (x + width, -down)]);
            x += width;
        }
        above.reverse();
        below.extend(above);
        below.dedup();
        let (sin, cos) = (f64::from(turn) * 0.37).sin_cos();
        let turned = below.iter().map(|&(x, y)| Coord {
            x: x * cos - y * sin,
            y: x * sin + y * cos,
        });
        Polygon::new(turned.collect(), vec![])
    })
}

/// Outlines of both sorts, so many times as many of any shape.
pub fn any_outline(times: u32) -> impl Strategy<Value = Polygon<f64>> {
    prop_oneof![times => outline(), 1 => stairs()]
}

/// Points in local coordinates, as a grammar writes them.
pub fn points_by_hand(count: std::ops::Range<usize>) -> impl Strategy<Value = String> {
    vec((0.0..1.0_f64, 0.0..1.0_f64), count).prop_map(|all| {
        let all: Vec<String> = all.iter().map(|(x, y)| format!("({x}, {y})")).collect();
        format!("[{}]", all.join(", "))
    })
}

/// What rules make of an outline; none if the region does not suit and the error
/// says why, in one of the ways that are known.
pub fn derived(
    outline: &Polygon<f64>,
    rules: &str,
    seed: u64,
    known: &[&str],
) -> Result<Option<Scene>, TestCaseError> {
    match park(outline, rules, seed) {
        Ok(scene) => Ok(Some(scene)),
        Err(error @ ParkError::Rule(_)) => {
            let said = error.to_string();
            prop_assert!(known.iter().any(|k| said.contains(k)), "{}", said);
            Ok(None)
        }
        Err(error) => {
            prop_assert!(false, "{}", error);
            Ok(None)
        }
    }
}

/// What rules make of an outline, which tiles it and is the same for one seed; none
/// if the region does not suit and the error says why.
pub fn tiling(
    outline: &Polygon<f64>,
    rules: &str,
    points: &[(f64, f64)],
    seed: u64,
) -> Result<Option<Scene>, TestCaseError> {
    match park(outline, rules, seed) {
        Ok(scene) => {
            is_tiled(outline, &scene, points)?;
            let again = park(outline, rules, seed);
            prop_assert_eq!(again.as_ref(), Ok(&scene));
            Ok(Some(scene))
        }
        Err(error) => {
            prop_assert!(matches!(error, ParkError::Rule(_)), "{}", error);
            Ok(None)
        }
    }
}

/// That pieces tile an outline: sizes to 1e-9, nothing outside, and each point in
/// one piece.
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
        let sure = scene
            .pieces
            .iter()
            .all(|piece| clearance(&piece.polygon, p) > 1e-7);
        let count = scene
            .pieces
            .iter()
            .filter(|piece| within(&piece.polygon, p))
            .count();
        prop_assert!(
            !sure || count == usize::from(within(outline, p)),
            "{count} at {p:?}"
        );
    }
    Ok(())
}

/// That no ring goes out and comes back along itself: no hairs.
pub fn has_no_hairs(scene: &Scene) -> Result<(), TestCaseError> {
    for piece in &scene.pieces {
        let rings = std::iter::once(piece.polygon.exterior()).chain(piece.polygon.interiors());
        for ring in rings {
            let n = ring.0.len() - 1;
            for k in 0..n {
                let (a, b, c) = (ring.0[(k + n - 1) % n], ring.0[k], ring.0[(k + 1) % n]);
                let (u, v) = (a - b, c - b);
                let (lu, lv) = (u.x.hypot(u.y), v.x.hypot(v.y));
                let wide = (u.x * v.y - u.y * v.x).abs() / lu.max(lv);
                let back = u.x * v.x + u.y * v.y > 0.0;
                prop_assert!(
                    !back || wide > 1e-10 || lu.min(lv) < 1e-6,
                    "a hair at {b:?} from {a:?} to {c:?} in {}",
                    piece.material
                );
            }
        }
    }
    Ok(())
}

/// Turns by `angle`, mirrors if wanted, and moves.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    pub angle: f64,
    pub mirror: bool,
    pub by: Coord<f64>,
}

impl Motion {
    pub fn of(self, p: Coord<f64>) -> Coord<f64> {
        let x = if self.mirror { -p.x } else { p.x };
        let (sin, cos) = self.angle.sin_cos();
        Coord {
            x: x * cos - p.y * sin + self.by.x,
            y: x * sin + p.y * cos + self.by.y,
        }
    }

    pub fn polygon(self, polygon: &Polygon<f64>) -> Polygon<f64> {
        mapped(polygon, |c| self.of(c))
    }
}

/// A polygon with each of its points moved.
pub fn mapped(polygon: &Polygon<f64>, to: impl Fn(Coord<f64>) -> Coord<f64>) -> Polygon<f64> {
    let ring = |line: &LineString<f64>| line.0.iter().map(|&c| to(c)).collect();
    Polygon::new(
        ring(polygon.exterior()),
        polygon.interiors().iter().map(ring).collect(),
    )
}

/// The two mirror images of a park of that width and height whose lower left corner
/// is the origin: left and right, and upside down.
pub fn mirrors(width: f64, height: f64) -> [Motion; 2] {
    [
        Motion {
            angle: 0.0,
            mirror: true,
            by: Coord { x: width, y: 0.0 },
        },
        // Mirrored and turned by half a turn.
        Motion {
            angle: std::f64::consts::PI,
            mirror: true,
            by: Coord { x: 0.0, y: height },
        },
    ]
}

/// That in the cells of a grid, which are mirror images, what a rule makes of two
/// places is mirrored, and what goes by sides and coordinates of its parts with it.
/// The rule is given the places.
pub fn is_mirrored_in_cells(
    [width, height]: [f64; 2],
    a: (f64, f64),
    b: (f64, f64),
    rule: impl Fn(&str) -> String,
) -> Result<(), TestCaseError> {
    if (a.0 - b.0).hypot(a.1 - b.1) < 0.1 {
        return Ok(());
    }
    let rule = rule(&format!("[({}, {}), ({}, {})]", a.0, a.1, b.0, b.1));
    let rules = format!(
        "Region -> Grid(2, 2) {{ Quarter }} {{ Paving }}
        Quarter -> {rule} {{ Cell }} {{ Gravel }}
        Cell -> Meadow Place(EDGE[0]: 0.3, EDGE[1]: 0.3, EDGE[-1]: 0.2, CORNER[0]) {{ Lamp }} Place((0.7, 0.6)) {{ Bush }}"
    );
    let scene = park(&rectangle(width, height), &rules, 3).expect("derives");
    for mirror in mirrors(width, height) {
        is_image(&scene, &scene, mirror, 1e-5)?;
    }
    Ok(())
}

/// An oblong of 80 by 60 that begins at a point.
pub fn oblong(x: f64, y: f64) -> Polygon<f64> {
    polygon(&[(x, y), (x + 80., y), (x + 80., y + 60.), (x, y + 60.)])
}

/// The park of a whole grammar on an oblong, where every mesh that it names is one
/// and the same.
pub fn park_with_mesh(grammar: &str, mesh: &str, x: f64, y: f64) -> Scene {
    let load = |_: &str| Ok(mesh.to_owned());
    Grammar::with_includes("park", grammar, &load)
        .and_then(|grammar| grammar.derive(&oblong(x, y), &DeriveOptions::default()))
        .expect("derives")
}

/// That what one scene has of each material has its image in the other: as much,
/// around the same middle. Pieces that touch in a point may count as one or two, by
/// rounding.
pub fn is_image(a: &Scene, b: &Scene, motion: Motion, far: f64) -> Result<(), TestCaseError> {
    let all = |scene: &Scene, material: &str| {
        let pieces = of(scene, material).into_iter();
        pieces.fold((Coord::default(), 0.0), |(sum, whole), piece| {
            let here = size(&piece.polygon);
            (sum + middle(&piece.polygon) * here, whole + here)
        })
    };
    for piece in a.pieces.iter().chain(&b.pieces) {
        let [(here, much), (there, as_much)] = [a, b].map(|scene| all(scene, &piece.material));
        prop_assert!(
            (much - as_much).abs() < 100.0 * far,
            "{}: {much} {as_much}",
            piece.material
        );
        // Of a sliver the middle is not known to so many digits.
        if much > 1e-3 {
            let by = motion.of(here / much) - there / as_much;
            prop_assert!(
                by.x.hypot(by.y) < far * (1.0 + 1.0 / much),
                "{}: {by:?} of {much}",
                piece.material
            );
        }
    }
    Ok(())
}
