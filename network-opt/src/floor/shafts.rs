//! Where shafts come to lie.

use geo_types::Coord;

use super::measure::{centre, distance, finite, nearest};
use super::on::bad;
use super::place::placements;
use super::spec::{Place, Shaft};
use crate::design::Tessellation;
use crate::error::DesignError;

/// Where a shaft came to lie.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaftPlace {
    /// Its faces; none for a mere vertex.
    pub faces: Vec<usize>,
    /// The vertex at which one leaves it: passed by a corridor, or a sink.
    pub landing: usize,
    /// Its position among the placements; none for a mere vertex.
    pub placement: Option<usize>,
}

/// The faces and the landing of a shaft; takes the faces out of `free`.
pub(super) fn place_shaft(
    mesh: &Tessellation,
    rim: &[bool],
    middles: &[Coord<f64>],
    shaft: &Shaft,
    free: &mut [bool],
) -> Result<ShaftPlace, DesignError> {
    let name = &shaft.name;
    let vertices = mesh.points().len();
    let inside = |v: usize| mesh.around(v).iter().all(|&(e, _)| !rim[e]);
    let serves = |v: usize| {
        let faces = mesh.around(v).iter().flat_map(|&(e, _)| mesh.faces_of(e));
        inside(v) && faces.into_iter().any(|&f| free[f])
    };
    let at = match shaft.at {
        Place::Vertex(v) if v >= vertices => {
            return bad(format!("{name:?} is at vertex {v}, of {vertices}"));
        }
        Place::Vertex(v) => mesh.points()[v],
        Place::Point(p) => finite(p, name)?,
    };
    let Some(shape) = &shaft.shape else {
        let landing = match shaft.at {
            Place::Vertex(v) => Some(v),
            Place::Point(_) => nearest(mesh, at, &serves),
        };
        return match landing {
            Some(landing) => Ok(ShaftPlace {
                faces: vec![],
                landing,
                placement: None,
            }),
            None => bad(format!("there is no place inside for {name:?}")),
        };
    };
    let hops = hops_from(mesh, rim);
    // The corner farthest from the facade that has something to lead to.
    let landing = |faces: &[usize]| {
        let corners = faces.iter().flat_map(|&f| &mesh.faces()[f]).copied();
        let leads = |v: usize| {
            let around = mesh.around(v).iter();
            let mut beside = around.flat_map(|&(e, _)| mesh.faces_of(e));
            beside.any(|f| free[*f] && !faces.contains(f))
        };
        corners
            .filter(|&v| leads(v))
            .max_by_key(|&v| (hops[v], std::cmp::Reverse(v)))
    };
    let best = placements(mesh, name, shape, true, true)
        .into_iter()
        .filter(|p| p.faces.iter().all(|&f| free[f]))
        .filter_map(|p| {
            let landing = landing(&p.faces)?;
            // One without a corner inside can only be reached along the facade.
            let outside = hops[landing] == 0;
            Some((
                outside,
                distance(centre(middles, &p.faces), at),
                p.faces,
                landing,
            ))
        })
        .min_by(|a, b| {
            (a.0.cmp(&b.0))
                .then(a.1.total_cmp(&b.1))
                .then(a.2.cmp(&b.2))
        });
    let Some((_, _, faces, landing)) = best else {
        return bad(format!(
            "there is no place for {name:?} of the shape {shape}"
        ));
    };
    faces.iter().for_each(|&f| free[f] = false);
    Ok(ShaftPlace {
        faces,
        landing,
        placement: None,
    })
}

/// Edges from each vertex to the rim.
fn hops_from(mesh: &Tessellation, rim: &[bool]) -> Vec<usize> {
    let mut hops = vec![usize::MAX; mesh.points().len()];
    let mut queue = std::collections::VecDeque::new();
    for (ends, _) in mesh.edges().iter().zip(rim).filter(|(_, rim)| **rim) {
        for &v in ends {
            if hops[v] != 0 {
                hops[v] = 0;
                queue.push_back(v);
            }
        }
    }
    while let Some(v) = queue.pop_front() {
        for &(_, w) in mesh.around(v) {
            if hops[w] == usize::MAX {
                hops[w] = hops[v] + 1;
                queue.push_back(w);
            }
        }
    }
    hops
}
