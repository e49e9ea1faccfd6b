//! Points to triangles, triangles to quads: the only place that knows spade.

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

use geo_types::Coord;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::outline::Outline;
use crate::error::DesignError;
use crate::mesh::predicates::orient;

type P = Coord<f64>;
type Cdt = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// A quad whose angles differ from 90 degrees by more than this is not made,
/// degrees: its two triangles are better cut in three each.
const WORST: f64 = 62.0;
/// Triangles that a chain of changed pairs may run through.
const CHAIN: usize = 24;

/// Faces, quads and some triangles, over the vertices of the outline and then
/// the points inside, counter-clockwise.
pub(super) fn faces(outline: &Outline, inside: &[P]) -> Result<Vec<Vec<usize>>, DesignError> {
    let points: Vec<P> = outline.points.iter().chain(inside).copied().collect();
    let triangles = triangulate(outline, &points)?;
    let pairs = Pairs::new(&points, &triangles);
    let matched = pairs.matched();
    let mut faces = Vec::new();
    for (t, triangle) in triangles.iter().enumerate() {
        match matched[t] {
            Some(other) if other < t => {}
            Some(other) => faces.push(quad(triangle, &triangles[other]).to_vec()),
            None => faces.push(triangle.to_vec()),
        }
    }
    Ok(faces)
}

/// The constrained Delaunay triangles inside, counter-clockwise.
fn triangulate(outline: &Outline, points: &[P]) -> Result<Vec<[usize; 3]>, DesignError> {
    let bad = |what: &str| DesignError::BadMesh {
        what: what.to_owned(),
    };
    let vertices: Vec<Point2<f64>> = points.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let edges = (0..outline.points.len()).map(|k| [k, outline.next(k)]);
    let conflict = Cell::new(false);
    let cdt = Cdt::try_bulk_load_cdt(vertices, edges.collect(), |_| conflict.set(true))
        .map_err(|_| bad("its coordinates are too large or too small to triangulate"))?;
    if conflict.get() || cdt.num_vertices() != points.len() {
        return Err(bad("rings of the polygon cross or touch"));
    }
    let all: Vec<[usize; 3]> = cdt
        .inner_faces()
        .map(|face| face.vertices().map(|v| v.index()))
        .collect();
    let inside = inside(outline, &all);
    let triangles: Vec<[usize; 3]> = all
        .into_iter()
        .zip(inside)
        .filter_map(|(triangle, inside)| inside.then_some(triangle))
        .collect();
    if triangles.is_empty() {
        return Err(bad("no triangle lies inside the polygon"));
    }
    Ok(triangles)
}

/// Which triangles lie inside. One with a side on the outline does if it walks
/// that side as the outline does; the others are as their neighbours, from
/// which no outline parts them. Nothing is measured, so that slivers between a
/// straight boundary and the hull of its rounded points are told apart too.
fn inside(outline: &Outline, triangles: &[[usize; 3]]) -> Vec<bool> {
    let rim = outline.points.len();
    let on_outline = |a: usize, b: usize| a < rim && outline.next(a) == b;
    let mut beside: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let sides = |t: usize| (0..3).map(move |k| (triangles[t][k], triangles[t][(k + 1) % 3]));
    for t in 0..triangles.len() {
        beside.extend(sides(t).map(|side| (side, t)));
    }
    let mut known: Vec<Option<bool>> = vec![None; triangles.len()];
    let mut queue = VecDeque::new();
    for (t, known) in known.iter_mut().enumerate() {
        let forward = sides(t).any(|(a, b)| on_outline(a, b));
        if forward || sides(t).any(|(a, b)| on_outline(b, a)) {
            *known = Some(forward);
            queue.push_back(t);
        }
    }
    while let Some(t) = queue.pop_front() {
        for (a, b) in sides(t) {
            if on_outline(a, b) || on_outline(b, a) {
                continue;
            }
            if let Some(&other) = beside.get(&(b, a)) {
                if known[other].is_none() {
                    known[other] = known[t];
                    queue.push_back(other);
                }
            }
        }
    }
    known
        .into_iter()
        .map(|inside| inside == Some(true))
        .collect()
}

/// Two triangles with a common side as a quad.
fn quad(one: &[usize; 3], other: &[usize; 3]) -> [usize; 4] {
    let shared = |v: &usize| other.contains(v);
    let apex = (0..3).find(|&k| !shared(&one[k])).unwrap_or(0);
    let across = other.iter().find(|v| !one.contains(v)).copied();
    let [a, b, c] = [one[apex], one[(apex + 1) % 3], one[(apex + 2) % 3]];
    [a, b, across.unwrap_or(a), c]
}

/// How far the angles of a quad are from right ones at worst, degrees;
/// infinite if it is not convex.
fn crookedness(corners: [P; 4]) -> f64 {
    (0..4)
        .map(|k| {
            let (before, at, after) = (corners[(k + 3) % 4], corners[k], corners[(k + 1) % 4]);
            if orient(before, at, after) <= 0.0 {
                return f64::INFINITY;
            }
            let (u, v) = (before - at, after - at);
            let angle = (v.x * u.y - v.y * u.x).atan2(u.x * v.x + u.y * v.y);
            (angle.to_degrees() - 90.0).abs()
        })
        .fold(0.0, f64::max)
}

/// Triangles and the quads that two of them could make.
struct Pairs {
    /// For each triangle its possible partners, the best first.
    partners: Vec<Vec<(usize, f64)>>,
}

impl Pairs {
    fn new(points: &[P], triangles: &[[usize; 3]]) -> Self {
        let mut beside: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        let mut partners: Vec<Vec<(usize, f64)>> = vec![Vec::new(); triangles.len()];
        for (t, triangle) in triangles.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                let Some(&other) = beside.get(&(b, a)) else {
                    beside.insert((a, b), t);
                    continue;
                };
                let shape = quad(triangle, &triangles[other]).map(|v| points[v]);
                let cost = crookedness(shape);
                if cost < WORST {
                    partners[t].push((other, cost));
                    partners[other].push((t, cost));
                }
            }
        }
        for own in &mut partners {
            own.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        }
        Self { partners }
    }

    /// Partners: the squarest quads first; then chains of changed pairs from
    /// one single triangle to another, as long as there are any.
    fn matched(&self) -> Vec<Option<usize>> {
        let mut order: Vec<(f64, usize, usize)> = Vec::new();
        for (t, own) in self.partners.iter().enumerate() {
            order.extend(
                own.iter()
                    .filter(|o| o.0 > t)
                    .map(|&(o, cost)| (cost, t, o)),
            );
        }
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut partner = vec![None; self.partners.len()];
        for (_, a, b) in order {
            if partner[a].is_none() && partner[b].is_none() {
                (partner[a], partner[b]) = (Some(b), Some(a));
            }
        }
        for t in 0..partner.len() {
            if partner[t].is_none() {
                self.augment(t, &mut partner);
            }
        }
        partner
    }

    /// Looks for the shortest alternating chain from single triangle `start`
    /// to another one, and changes the pairs along it.
    fn augment(&self, start: usize, partner: &mut [Option<usize>]) {
        // For each triangle reached as the outer one of a pair, from where.
        let mut from: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
        // Each triangle is the inner or the outer one of a pair, never both.
        let mut seen = BTreeSet::from([start]);
        let mut queue = VecDeque::from([(start, 0)]);
        while let Some((at, depth)) = queue.pop_front() {
            for &(next, _) in &self.partners[at] {
                if seen.contains(&next) {
                    continue;
                }
                let Some(beyond) = partner[next] else {
                    // Change the pairs back to the start.
                    let (mut outer, mut inner) = (at, next);
                    loop {
                        (partner[outer], partner[inner]) = (Some(inner), Some(outer));
                        let Some(&(before, middle)) = from.get(&outer) else {
                            return;
                        };
                        (outer, inner) = (before, middle);
                    }
                };
                if depth + 2 < CHAIN && !seen.contains(&beyond) {
                    seen.extend([next, beyond]);
                    from.insert(beyond, (at, next));
                    queue.push_back((beyond, depth + 2));
                }
            }
        }
    }
}
