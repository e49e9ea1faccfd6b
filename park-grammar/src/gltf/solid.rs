//! Solids of triangles in several colours, and the simple ones that things are
//! made of. Metres, y up; triangles are counter-clockwise from outside.

use std::collections::BTreeMap;

use super::buffer::Surface;
use crate::mesh::Mesh;

pub(super) type Point = [f64; 3];

/// What a triangle is painted with.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Paint {
    /// `#rrggbb`.
    pub(super) colour: String,
    /// The material, if it is one of the library's.
    pub(super) name: Option<&'static str>,
    /// Whether it is seen from behind too.
    pub(super) thin: bool,
}

impl Paint {
    pub(super) fn plain(colour: &str) -> Self {
        Self {
            colour: colour.to_owned(),
            name: None,
            thin: false,
        }
    }
}

/// Triangles, by what they are painted with.
#[derive(Clone, Debug, Default)]
pub(super) struct Solid {
    surfaces: BTreeMap<Paint, Surface>,
}

impl Solid {
    pub(super) fn surfaces(&self) -> impl Iterator<Item = (Paint, &Surface)> + '_ {
        self.surfaces.iter().map(|(paint, s)| (paint.clone(), s))
    }

    /// A flat triangle; nothing if it has no area.
    pub(super) fn triangle(&mut self, paint: &Paint, corners: [Point; 3]) {
        let corners = corners.map(|p| p.map(|x| x as f32));
        let [p, q, r] = corners.map(|c| c.map(f64::from));
        let (u, v) = (minus(q, p), minus(r, p));
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let size = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        if size <= 0.0 || !size.is_finite() {
            return;
        }
        // Adding zero makes -0 a 0: corners that are alike are one.
        let normal = normal.map(|n| (n / size) as f32 + 0.0);
        if !self.surfaces.contains_key(paint) {
            self.surfaces.insert(paint.clone(), Surface::default());
        }
        if let Some(surface) = self.surfaces.get_mut(paint) {
            for corner in corners {
                surface.corner(corner.map(|x| x + 0.0), normal);
            }
        }
    }

    /// A flat face of four corners.
    pub(super) fn quad(&mut self, paint: &Paint, [a, b, c, d]: [Point; 4]) {
        self.triangle(paint, [a, b, c]);
        self.triangle(paint, [a, c, d]);
    }

    /// A box upright on its foot: the middle of that, half its length along x and
    /// z, and its height.
    pub(super) fn upright(&mut self, paint: &Paint, foot: Point, half: [f64; 2], height: f64) {
        let [x, y, z] = foot;
        let at = |u: f64, v: f64, h: f64| [x + u * half[0], y + h, z + v * half[1]];
        let ring = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
        for (k, (u, v)) in ring.into_iter().enumerate() {
            let (s, t) = ring[(k + 1) % 4];
            self.quad(
                paint,
                [
                    at(u, v, 0.0),
                    at(s, t, 0.0),
                    at(s, t, height),
                    at(u, v, height),
                ],
            );
        }
        self.quad(paint, ring.map(|(u, v)| at(u, v, height)));
        let [a, b, c, d] = ring.map(|(u, v)| at(u, v, 0.0));
        self.quad(paint, [d, c, b, a]);
    }

    /// What a line of radii and heights sweeps when it is turned about an upright
    /// axis, in so many parts; the line goes up along the outside.
    pub(super) fn lathe(&mut self, paint: &Paint, foot: Point, line: &[[f64; 2]], parts: usize) {
        let at = |[r, y]: [f64; 2], k: usize| {
            let angle = std::f64::consts::TAU * (k % parts) as f64 / parts as f64;
            [
                foot[0] + r * angle.cos(),
                foot[1] + y,
                foot[2] - r * angle.sin(),
            ]
        };
        for pair in line.windows(2) {
            for k in 0..parts {
                let [a, b] = [at(pair[0], k), at(pair[0], k + 1)];
                let [c, d] = [at(pair[1], k + 1), at(pair[1], k)];
                self.triangle(paint, [a, b, c]);
                self.triangle(paint, [a, c, d]);
            }
        }
    }

    /// An ellipsoid with uneven sides, as leaves have: its middle, its radii along
    /// the ground and upwards.
    pub(super) fn leaves(&mut self, paint: &Paint, middle: Point, radii: [f64; 2]) {
        const PARTS: usize = 9;
        const RINGS: usize = 5;
        let at = |ring: usize, k: usize| {
            let k = k % PARTS;
            let up = std::f64::consts::PI * (ring as f64 / RINGS as f64 - 0.5);
            // Every other ring is turned by half a part.
            let turn = 0.5 * (ring % 2) as f64;
            let angle = std::f64::consts::TAU * (k as f64 + turn) / PARTS as f64;
            let pole = ring == 0 || ring == RINGS;
            let bump = if pole {
                1.0
            } else {
                1.0 - 0.1 * ((ring * 7 + k * 5) % 4) as f64 / 3.0
            };
            let flat = radii[0] * up.cos().abs() * bump;
            let flat = if pole { 0.0 } else { flat };
            [
                middle[0] + flat * angle.cos(),
                middle[1] + radii[1] * up.sin() * bump,
                middle[2] - flat * angle.sin(),
            ]
        };
        for ring in 0..RINGS {
            for k in 0..PARTS {
                // The ring above begins half a part later, or half a part earlier.
                let [a, b, c, d] = [
                    at(ring, k),
                    at(ring, k + 1),
                    at(ring + 1, k + 1),
                    at(ring + 1, k),
                ];
                if ring % 2 == 0 {
                    self.triangle(paint, [a, b, d]);
                    self.triangle(paint, [b, c, d]);
                } else {
                    self.triangle(paint, [a, b, c]);
                    self.triangle(paint, [a, c, d]);
                }
            }
        }
    }

    /// A mesh that a grammar brought; nobody knows how its triangles are wound.
    pub(super) fn of_mesh(mesh: &Mesh, colour: &str) -> Self {
        let mut solid = Self::default();
        let paint = Paint {
            thin: true,
            ..Paint::plain(colour)
        };
        for triangle in &mesh.triangles {
            let corners = triangle.map(|k| mesh.vertices.get(k).copied());
            if let [Some(a), Some(b), Some(c)] = corners {
                solid.triangle(&paint, [a, b, c]);
            }
        }
        solid
    }
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
