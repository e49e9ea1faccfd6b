//! Areas of the plane: rings, and what polygon booleans make of them.
//!
//! All coordinates are metres. An outer ring runs clockwise and a hole
//! counter-clockwise, so that the land lies on the right of every edge; rings
//! are open (the first vertex is not repeated).

mod band;
mod boolean;
mod boxes;
mod climb;
mod curve;
mod erode;
mod farthest;
mod inset;
mod pole;
mod rest;
mod route;
mod sample;
mod sight;
mod smooth;
mod split;
mod stroke;
mod trim;
mod voronoi;
mod weld;

use geo_types::{Coord, LineString, Polygon};

pub(crate) use band::{inset, Band, Bound, Ends};
pub(crate) use boolean::{difference, intersection, slice, union, FARTHEST};
pub(crate) use boxes::{
    box_along, named_by, oriented_box, quad_angles, quad_area, quad_coordinates, quad_extent,
    quad_is_convex, quad_point,
};
pub(crate) use climb::climb;
pub(crate) use curve::{curve, Course};
pub(crate) use erode::erode;
pub(crate) use farthest::farthest;
pub(crate) use inset::{inset_lines, keep_apart, ribbon, strip, Corner, Segment};
pub(crate) use pole::{middle, pole};
pub(crate) use rest::rest;
pub(crate) use route::Router;
pub(crate) use sample::Sampler;
pub(crate) use sight::{leaves, sees};
pub(crate) use smooth::{smooth, Smoothing};
pub(crate) use split::{clipped, split, Line};
pub(crate) use stroke::{circle, stroke};
pub(crate) use trim::{trim, with_vertices};
pub(crate) use voronoi::{aside, heart, leeway, Border, Diagram, Site};
pub(crate) use weld::{weld, Weld};

/// The vertices of a closed line, the first not repeated.
pub(crate) type Ring = Vec<Coord<f64>>;

/// An outer ring with holes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Area {
    /// Clockwise.
    pub(crate) outer: Ring,
    /// Counter-clockwise.
    pub(crate) holes: Vec<Ring>,
}

impl Area {
    /// From rings wound either way.
    pub(crate) fn new(outer: Ring, holes: Vec<Ring>) -> Self {
        Self {
            outer: wound(outer, -1.0),
            holes: holes.into_iter().map(|hole| wound(hole, 1.0)).collect(),
        }
    }

    pub(crate) fn from_polygon(polygon: &Polygon<f64>) -> Self {
        let open = |line: &LineString<f64>| match line.0.as_slice() {
            [points @ .., last] if points.first() == Some(last) => points.to_vec(),
            points => points.to_vec(),
        };
        Self::new(
            open(polygon.exterior()),
            polygon.interiors().iter().map(open).collect(),
        )
    }

    /// The polygon, exterior counter-clockwise as GeoJSON has it.
    pub(crate) fn to_polygon(&self) -> Polygon<f64> {
        let reversed = |ring: &Ring| LineString(ring.iter().rev().copied().collect());
        Polygon::new(
            reversed(&self.outer),
            self.holes.iter().map(reversed).collect(),
        )
    }

    /// The outer ring, then the holes.
    pub(crate) fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Square metres.
    pub(crate) fn size(&self) -> f64 {
        // Clockwise rings have negative areas.
        -self.rings().map(|ring| signed_area(ring)).sum::<f64>()
    }

    /// Whether a point lies inside; on the boundary either may be answered.
    pub(crate) fn contains(&self, p: Coord<f64>) -> bool {
        self.rings().filter(|ring| in_ring(ring, p)).count() % 2 == 1
    }

    /// The nearest point of the boundary and how far it is.
    pub(crate) fn nearest(&self, p: Coord<f64>) -> (Coord<f64>, f64) {
        let mut best = (p, f64::INFINITY);
        for (a, b) in self.rings().flat_map(|ring| sides(ring)) {
            let q = nearest_on(a, b, p);
            let away = square(p - q);
            if away < best.1 {
                best = (q, away);
            }
        }
        (best.0, best.1.sqrt())
    }

    /// Whether the boundary is at least so far from a point.
    pub(crate) fn keeps_away(&self, p: Coord<f64>, far: f64) -> bool {
        let aside = |p: f64, a: f64, b: f64| p + far <= a.min(b) || p - far >= a.max(b);
        let mut edges = self.rings().flat_map(|ring| sides(ring));
        edges.all(|(a, b)| {
            // Most edges lie far to one side.
            aside(p.x, a.x, b.x)
                || aside(p.y, a.y, b.y)
                || square(p - nearest_on(a, b, p)) >= far * far
        })
    }

    /// The centre of mass.
    pub(crate) fn centroid(&self) -> Coord<f64> {
        let origin = self.outer.first().copied().unwrap_or_default();
        let (mut sum, mut doubled) = (Coord::default(), 0.0);
        for (a, b) in self.rings().flat_map(|ring| sides(ring)) {
            let (u, v) = (a - origin, b - origin);
            let part = cross(u, v);
            sum = sum + (u + v) * part;
            doubled += part;
        }
        if doubled == 0.0 {
            origin
        } else {
            origin + sum / (3.0 * doubled)
        }
    }

    /// Lowest and highest coordinates.
    pub(crate) fn extent(&self) -> (Coord<f64>, Coord<f64>) {
        extent(&self.outer)
    }
}

/// Lowest and highest coordinates of points.
pub(crate) fn extent(points: &[Coord<f64>]) -> (Coord<f64>, Coord<f64>) {
    let start = points.first().copied().unwrap_or_default();
    points.iter().fold((start, start), |(low, high), p| {
        (
            Coord {
                x: low.x.min(p.x),
                y: low.y.min(p.y),
            },
            Coord {
                x: high.x.max(p.x),
                y: high.y.max(p.y),
            },
        )
    })
}

fn wound(mut ring: Ring, sign: f64) -> Ring {
    if signed_area(&ring) * sign < 0.0 {
        // The first vertex stays the first.
        ring[1..].reverse();
    }
    ring
}

/// The edges of a ring.
pub(crate) fn sides(ring: &[Coord<f64>]) -> impl Iterator<Item = (Coord<f64>, Coord<f64>)> + '_ {
    let next = ring.iter().cycle().skip(1);
    ring.iter().copied().zip(next.copied())
}

/// Positive for a counter-clockwise ring.
pub(crate) fn signed_area(ring: &[Coord<f64>]) -> f64 {
    let origin = ring.first().copied().unwrap_or_default();
    let part = |(a, b): (Coord<f64>, Coord<f64>)| cross(a - origin, b - origin);
    sides(ring).map(part).sum::<f64>() / 2.0
}

pub(crate) fn length(line: &[Coord<f64>]) -> f64 {
    line.windows(2).map(|pair| dist(pair[0], pair[1])).sum()
}

pub(crate) fn in_ring(ring: &[Coord<f64>], p: Coord<f64>) -> bool {
    let crosses = |(a, b): (Coord<f64>, Coord<f64>)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)
    };
    sides(ring).filter(|&side| crosses(side)).count() % 2 == 1
}

pub(crate) fn dot(a: Coord<f64>, b: Coord<f64>) -> f64 {
    a.x * b.x + a.y * b.y
}

pub(crate) fn cross(a: Coord<f64>, b: Coord<f64>) -> f64 {
    a.x * b.y - a.y * b.x
}

fn square(a: Coord<f64>) -> f64 {
    dot(a, a)
}

/// The length of a vector. Parks are metres wide: no square overflows.
pub(crate) fn norm(a: Coord<f64>) -> f64 {
    square(a).sqrt()
}

pub(crate) fn dist(a: Coord<f64>, b: Coord<f64>) -> f64 {
    norm(b - a)
}

/// The direction of a vector; zero for a vector without one.
pub(crate) fn unit(a: Coord<f64>) -> Coord<f64> {
    let n = norm(a);
    if n > 0.0 {
        a / n
    } else {
        Coord::default()
    }
}

/// A vector turned a quarter to the right: into the land beside an edge.
pub(crate) fn right(a: Coord<f64>) -> Coord<f64> {
    Coord { x: a.y, y: -a.x }
}

pub(crate) fn lerp(a: Coord<f64>, b: Coord<f64>, t: f64) -> Coord<f64> {
    a + (b - a) * t
}

/// The point of a segment that is nearest to `p`.
pub(crate) fn nearest_on(a: Coord<f64>, b: Coord<f64>, p: Coord<f64>) -> Coord<f64> {
    let d = b - a;
    let square = dot(d, d);
    if square == 0.0 {
        return a;
    }
    lerp(a, b, (dot(p - a, d) / square).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    /// A square of 4 with a hole of 2 whose centre lies aside.
    fn holed() -> Area {
        let square = |x: f64, y: f64, s: f64| {
            vec![
                coord! { x: x, y: y },
                coord! { x: x + s, y: y },
                coord! { x: x + s, y: y + s },
                coord! { x: x, y: y + s },
            ]
        };
        Area::new(square(0.0, 0.0, 4.0), vec![square(1.0, 1.0, 2.0)])
    }

    #[test]
    fn rings_are_wound_and_measured() {
        let area = holed();
        assert!(signed_area(&area.outer) < 0.0 && signed_area(&area.holes[0]) > 0.0);
        assert_eq!(area.size(), 12.0);
        assert_eq!(area.centroid(), coord! { x: 2.0, y: 2.0 });
        assert!(area.contains(coord! { x: 0.5, y: 0.5 }));
        assert!(!area.contains(coord! { x: 2.0, y: 2.0 }));
        let back = Area::from_polygon(&area.to_polygon());
        assert_eq!(back.size(), 12.0);
        let (at, away) = area.nearest(coord! { x: 2.0, y: 2.5 });
        assert_eq!((at, away), (coord! { x: 2.0, y: 3.0 }, 0.5));
    }
}
