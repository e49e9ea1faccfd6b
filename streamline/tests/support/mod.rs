//! Fields with closed forms, random domains and random smooth crosses.

#![allow(dead_code, reason = "each test file uses its own part")]

use geo_types::{coord, Coord, LineString, Polygon};
use proptest::prelude::*;
use streamline::{arm_nearest, from_fn, DirectionField, FromFn, Seed, Streamline, TraceOptions};

pub(crate) type P = Coord<f64>;

pub(crate) fn cases() -> ProptestConfig {
    let long = std::env::var("URBAN_LAYOUT_LONG").is_ok_and(|value| value == "1");
    ProptestConfig {
        cases: if long { 500 } else { 24 },
        ..ProptestConfig::default()
    }
}

pub(crate) fn norm(a: P) -> f64 {
    a.x.hypot(a.y)
}

pub(crate) fn dot(a: P, b: P) -> f64 {
    a.x * b.x + a.y * b.y
}

pub(crate) fn cross(a: P, b: P) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Distance from `p` to segment `a b`, by the textbook.
pub(crate) fn to_segment(p: P, a: P, b: P) -> f64 {
    let e = b - a;
    let t = if dot(e, e) > 0.0 {
        (dot(p - a, e) / dot(e, e)).clamp(0.0, 1.0)
    } else {
        0.0
    };
    norm(a + e * t - p)
}

/// A rotation about the origin (mirrored in the x axis first if asked), then a
/// shift.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    pub(crate) angle: f64,
    pub(crate) mirror: bool,
    pub(crate) shift: P,
}

impl Motion {
    pub(crate) fn turn(&self, v: P) -> P {
        let v = if self.mirror {
            coord! { x: v.x, y: -v.y }
        } else {
            v
        };
        let (sin, cos) = self.angle.sin_cos();
        coord! { x: cos * v.x - sin * v.y, y: sin * v.x + cos * v.y }
    }

    pub(crate) fn apply(&self, p: P) -> P {
        self.turn(p) + self.shift
    }

    pub(crate) fn undo(&self, p: P) -> P {
        let q = p - self.shift;
        let (sin, cos) = self.angle.sin_cos();
        let v = coord! { x: cos * q.x + sin * q.y, y: -sin * q.x + cos * q.y };
        if self.mirror {
            coord! { x: v.x, y: -v.y }
        } else {
            v
        }
    }

    pub(crate) fn undo_turn(&self, v: P) -> P {
        Motion {
            shift: coord! { x: 0., y: 0. },
            ..*self
        }
        .undo(v)
    }

    pub(crate) fn polygon(&self, polygon: &Polygon<f64>) -> Polygon<f64> {
        let ring =
            |line: &LineString<f64>| LineString(line.0.iter().map(|&p| self.apply(p)).collect());
        Polygon::new(
            ring(polygon.exterior()),
            polygon.interiors().iter().map(ring).collect(),
        )
    }
}

/// Anywhere from the origin to the far corner of a map projection.
pub(crate) fn motion() -> impl Strategy<Value = Motion> {
    let shift = prop_oneof![
        Just(coord! { x: 0.0, y: 0.0 }),
        (-2e3..2e3, -2e3..2e3).prop_map(|(x, y)| coord! { x: x, y: y }),
        (1e5..9e5, 0.0..9e6).prop_map(|(x, y)| coord! { x: x, y: y }),
    ];
    (0.0..std::f64::consts::TAU, any::<bool>(), shift).prop_map(|(angle, mirror, shift)| Motion {
        angle,
        mirror,
        shift,
    })
}

/// A smooth cross without singularities: the angle is a sum of two waves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waves {
    pub(crate) base: f64,
    pub(crate) wave: [(f64, P, f64); 2],
}

impl Waves {
    pub(crate) fn angle(&self, p: P) -> f64 {
        self.base
            + self
                .wave
                .iter()
                .map(|(height, k, phase)| height * (dot(*k, p) + phase).sin())
                .sum::<f64>()
    }
}

pub(crate) fn waves() -> impl Strategy<Value = Waves> {
    let wave = || {
        (0.0..0.7_f64, 0.0..6.3_f64, 80.0..500.0_f64, 0.0..6.3_f64).prop_map(
            |(height, way, length, phase): (f64, f64, f64, f64)| {
                let k = std::f64::consts::TAU / length;
                (height, coord! { x: k * way.cos(), y: k * way.sin() }, phase)
            },
        )
    };
    (0.0..6.3_f64, wave(), wave()).prop_map(|(base, a, b)| Waves { base, wave: [a, b] })
}

/// A star-shaped polygon about the origin, about half of them with a hole.
pub(crate) fn domain() -> impl Strategy<Value = Polygon<f64>> {
    let ring = |radii: Vec<f64>, phase: f64| {
        let n = radii.len() as f64;
        let at = |(i, r): (usize, &f64)| {
            let a = phase + i as f64 * std::f64::consts::TAU / n;
            coord! { x: r * a.cos(), y: r * a.sin() }
        };
        LineString(radii.iter().enumerate().map(at).collect())
    };
    let outer = (prop::collection::vec(100.0..260.0_f64, 5..16), 0.0..1.0_f64);
    let hole = prop::option::of((prop::collection::vec(8.0..40.0_f64, 3..8), 0.0..1.0_f64));
    (outer, hole).prop_map(move |((radii, phase), hole)| {
        Polygon::new(
            ring(radii, phase),
            hole.map(|(radii, phase)| ring(radii, phase))
                .into_iter()
                .collect(),
        )
    })
}

pub(crate) fn wavy(
    domain: Polygon<f64>,
    waves: Waves,
) -> FromFn<impl Fn(P, P) -> Option<P> + Sync> {
    from_fn(domain, move |at, heading| {
        Some(arm_nearest(waves.angle(at), heading))
    })
}

/// A lattice of seeds inside the field, with its crosses.
pub(crate) fn lattice(field: &impl DirectionField, half: f64, spacing: f64) -> Vec<Seed> {
    let n = (half / spacing) as i32;
    let mut seeds = Vec::new();
    for i in -n..=n {
        for j in -n..=n {
            // Rows slightly askew, so that no seed is special.
            let at = coord! { x: i as f64 * spacing + 0.137 * j as f64, y: j as f64 * spacing - 0.211 * i as f64 };
            if let Some(arm) =
                field.direction(at, coord! { x: 1.0, y: 0.0 }, &mut Default::default())
            {
                seeds.push(Seed {
                    at,
                    directions: [arm, coord! { x: -arm.y, y: arm.x }],
                });
            }
        }
    }
    seeds
}

/// Steps of fixed length, whatever their error.
pub(crate) fn fixed(step: f64) -> TraceOptions {
    TraceOptions {
        step,
        max_step: step,
        tolerance: 1e9,
        max_turn_deg: 45.0,
        self_approach: 0.0,
        ..TraceOptions::default()
    }
}

/// All rings of a polygon as segments with their labels.
pub(crate) fn edges(domain: &Polygon<f64>) -> Vec<(usize, usize, P, P)> {
    let rings = std::iter::once(domain.exterior()).chain(domain.interiors());
    rings
        .enumerate()
        .flat_map(|(ring, line)| {
            line.0
                .windows(2)
                .enumerate()
                .map(move |(edge, p)| (ring, edge, p[0], p[1]))
        })
        .collect()
}

/// The piece of the line nearest to `p`: distance and direction.
pub(crate) fn nearest_piece(line: &Streamline, p: P) -> (f64, P) {
    let pieces = line
        .points
        .windows(2)
        .map(|s| (to_segment(p, s[0], s[1]), s[1] - s[0]));
    pieces
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .expect("a line has pieces")
}
