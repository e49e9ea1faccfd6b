//! Where people come in.

use std::collections::BTreeMap;

use geo_types::Coord;

use super::measure::{distance, finite, nearest};
use super::on::bad;
use super::spec::{FloorSpecification, Place, ShaftRole};
use crate::design::{Feature, Tessellation};
use crate::error::DesignError;

impl FloorSpecification {
    /// The vertices at which people come in: those named, or the middle of the
    /// front if none is and there are no shafts (`alone`) to come in by.
    pub(super) fn entrance_vertices(
        &self,
        mesh: &Tessellation,
        rim: &[bool],
        closed: &[bool],
        alone: bool,
    ) -> Result<Vec<usize>, DesignError> {
        let along_facade = self.facade != Feature::Forbidden;
        let leads_in = |v: usize| {
            let around = mesh.around(v);
            around.iter().any(|&(e, _)| rim[e])
                && (around.iter()).any(|&(e, _)| !closed[e] && (along_facade || !rim[e]))
        };
        if self.entrances.is_empty() {
            let none = !alone || self.shafts == ShaftRole::Sinks;
            let at = if none {
                None
            } else {
                front(mesh, rim, &leads_in)
            };
            return Ok(at.into_iter().collect());
        }
        let mut found = Vec::new();
        for place in &self.entrances {
            let v = match *place {
                Place::Vertex(v) if v >= mesh.points().len() => {
                    return bad(format!(
                        "an entrance is at vertex {v}, of {}",
                        mesh.points().len()
                    ));
                }
                Place::Vertex(v) if !leads_in(v) => {
                    return bad(format!(
                        "an entrance is at vertex {v}, from which no corridor can lead inside"
                    ));
                }
                Place::Vertex(v) => Some(v),
                Place::Point(p) => nearest(mesh, finite(p, "an entrance")?, &leads_in),
            };
            match v {
                Some(v) if !found.contains(&v) => found.push(v),
                Some(_) => {}
                None => return bad("no corridor can lead inside from anywhere".into()),
            }
        }
        Ok(found)
    }
}

/// The vertex nearest to the middle of the longest straight run of the outer
/// boundary from which a corridor can lead inside, one by an inner edge first.
fn front(mesh: &Tessellation, rim: &[bool], leads_in: &dyn Fn(usize) -> bool) -> Option<usize> {
    let mut best: Option<(f64, Coord<f64>)> = None;
    for ring in rings(mesh, rim) {
        let n = ring.len();
        let at = |k: usize| mesh.points()[ring[k % n]];
        let turns = |k: usize| {
            let (a, b, c) = (at(k + n - 1), at(k), at(k + 1));
            let (u, v) = (b - a, c - b);
            (u.x * v.y - u.y * v.x).atan2(u.x * v.x + u.y * v.y).abs() > 20_f64.to_radians()
        };
        let corners: Vec<usize> = (0..n).filter(|&k| turns(k)).collect();
        for (i, &from) in corners.iter().enumerate() {
            let to = corners.get(i + 1).copied().unwrap_or(corners[0] + n);
            let steps = (from..to).map(|k| distance(at(k), at(k + 1)));
            let length: f64 = steps.clone().sum();
            if best.is_some_and(|(longest, _)| length <= longest + 1e-9) {
                continue;
            }
            let (mut gone, mut middle) = (0.0, at(from));
            for (k, step) in (from..to).zip(steps) {
                if gone <= 0.5 * length {
                    let part = if step > 0.0 {
                        (0.5 * length - gone) / step
                    } else {
                        0.0
                    };
                    middle = at(k) + (at(k + 1) - at(k)) * part.min(1.0);
                }
                gone += step;
            }
            best = Some((length, middle));
        }
    }
    // A boundary without corners is round: anywhere will do.
    let middle = best.map_or_else(|| mesh.points().first().copied(), |(_, m)| Some(m))?;
    let inner = |v: usize| leads_in(v) && mesh.around(v).iter().any(|&(e, _)| !rim[e]);
    nearest(mesh, middle, &inner).or_else(|| nearest(mesh, middle, leads_in))
}

/// The loops of the boundary, the face on the left, by vertices.
fn rings(mesh: &Tessellation, rim: &[bool]) -> Vec<Vec<usize>> {
    let mut next: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (f, face) in mesh.faces().iter().enumerate() {
        for (k, &e) in mesh.edges_of(f).iter().enumerate() {
            if rim[e] {
                next.entry(face[k])
                    .or_default()
                    .push(face[(k + 1) % face.len()]);
            }
        }
    }
    let mut rings = Vec::new();
    while let Some((&first, _)) = next.iter().find(|(_, to)| !to.is_empty()) {
        let (mut ring, mut at) = (Vec::new(), first);
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            ring.push(at);
            at = to;
        }
        rings.push(ring);
    }
    rings
}
