//! `Grow(WEST, 30)`, `Grow([WEST, 45, EAST], 30, Leave)`: selections that grow
//! from where rays hit.
//!
//! Rays leave the region's centre of mass in each of the directions; the edge of
//! the outer ring that one hits first is where its selection begins. Selections
//! grow to the neighbours of their edges, those first that turn least, while the
//! turn is less than the threshold (45 degrees unless said).
//!
//! "What to do with unattached regions?" Decided: `Rest` (the default with
//! several directions) lets all go on growing, least turns first, until every
//! edge is attached, which is the notes' "that containing the more divergent
//! value continues" too, since of two that stand at an edge the one that turns
//! less into it has it; `Leave` (the default with one) leaves them. Where two
//! turn equally each has the half that is nearer to it: symmetric regions grow
//! symmetric selections. A ray into a vertex begins at both edges.

use geo_types::Coord;

use super::frame::{apart, outward, Frame};
use super::{Selection, Stretch};
use crate::plane::{cross, dist, dot};
use crate::shape::Region;

/// Turns this much apart are equal, radians; hits this near to a vertex, as a
/// share of the edge, are at it.
const SAME: f64 = 1e-9;

/// What becomes of edges beyond the threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rest {
    Grow,
    Leave,
}

/// Whose an edge is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Owner {
    Nobody,
    One(usize),
    /// The first part, up to a share of the edge, and the rest.
    Two(usize, usize, f64),
}

/// For each direction what grows from it.
pub(super) fn grow(
    region: &Region,
    frame: Frame,
    directions: &[f64],
    threshold: f64,
    rest: Rest,
) -> Vec<Selection> {
    let edges: Vec<(Coord<f64>, Coord<f64>)> = region.edges(0).map(|(a, b, _)| (a, b)).collect();
    let mut owners = seeds(&edges, region.area.centroid(), frame, directions);
    let n = edges.len();
    let faces: Vec<f64> = edges
        .iter()
        .map(|&(a, b)| Frame::COMPASS.angle(outward(a, b)))
        .collect();
    loop {
        // What may be attached: the edge, by whom, and how much it turns.
        let mut claims: Vec<(usize, usize, f64)> = Vec::new();
        for k in (0..n).filter(|&k| owners[k] == Owner::Nobody) {
            let (before, after) = ((k + n - 1) % n, (k + 1) % n);
            let first = match owners[before] {
                Owner::One(g) | Owner::Two(_, g, _) => Some(g),
                Owner::Nobody => None,
            };
            let second = match owners[after] {
                Owner::One(g) | Owner::Two(g, _, _) => Some(g),
                Owner::Nobody => None,
            };
            claims.extend(first.map(|g| (k, g, apart(faces[before], faces[k]))));
            claims.extend(second.map(|g| (k, g, apart(faces[after], faces[k]))));
        }
        let least = claims.iter().map(|c| c.2).fold(f64::INFINITY, f64::min);
        if claims.is_empty() || (rest == Rest::Leave && least >= threshold) {
            break;
        }
        let mut made: Vec<(usize, Owner)> = Vec::new();
        for &(k, group, _) in claims.iter().filter(|c| c.2 <= least + SAME) {
            match made.last_mut().filter(|(edge, _)| *edge == k) {
                Some((_, owner)) => {
                    if let Owner::One(other) = *owner {
                        if other != group {
                            // The claim from the beginning came first.
                            *owner = Owner::Two(other, group, 0.5);
                        }
                    }
                }
                None => made.push((k, Owner::One(group))),
            }
        }
        for (k, owner) in made {
            owners[k] = owner;
        }
    }
    (0..directions.len())
        .map(|group| of_group(&edges, &owners, group))
        .collect()
}

/// The edges that the rays hit first.
fn seeds(
    edges: &[(Coord<f64>, Coord<f64>)],
    centre: Coord<f64>,
    frame: Frame,
    directions: &[f64],
) -> Vec<Owner> {
    // For each edge who hit it and where, as a share of it.
    let mut hits: Vec<Vec<(f64, usize)>> = vec![Vec::new(); edges.len()];
    for (group, &angle) in directions.iter().enumerate() {
        let ray = frame.direction(angle);
        let met: Vec<(usize, f64, f64)> = edges
            .iter()
            .enumerate()
            .filter_map(|(k, &(a, b))| {
                let (u, v) = (cross(ray, a - centre), cross(ray, b - centre));
                if u == v {
                    return None;
                }
                let t = u / (u - v);
                let away = dot(ray, a + (b - a) * t - centre);
                ((-SAME..=1.0 + SAME).contains(&t) && away >= 0.0).then_some((k, t, away))
            })
            .collect();
        let least = met.iter().map(|m| m.2).fold(f64::INFINITY, f64::min);
        let near = SAME * (1.0 + least.min(1e300));
        for (k, t, _) in met.into_iter().filter(|m| m.2 <= least + near) {
            hits[k].push((t, group));
        }
    }
    let owner = |mut here: Vec<(f64, usize)>| {
        here.sort_by(|a, b| a.0.total_cmp(&b.0));
        match here.as_slice() {
            [] => Owner::Nobody,
            [(_, only)] => Owner::One(*only),
            // Of more than two that hit one edge the outer ones have it.
            [(s, first), .., (t, last)] => Owner::Two(*first, *last, 0.5 * (s + t)),
        }
    };
    hits.into_iter().map(owner).collect()
}

fn of_group(edges: &[(Coord<f64>, Coord<f64>)], owners: &[Owner], group: usize) -> Selection {
    let mut stretches = Vec::new();
    let mut along = 0.0;
    for (&(a, b), owner) in edges.iter().zip(owners) {
        let step = dist(a, b);
        let mut take = |from: f64, to: f64| stretches.push(Stretch { ring: 0, from, to });
        match *owner {
            Owner::One(g) if g == group => take(along, along + step),
            Owner::Two(first, second, share) => {
                if first == group {
                    take(along, along + share * step);
                }
                if second == group {
                    take(along + share * step, along + step);
                }
            }
            _ => {}
        }
        along += step;
    }
    Selection::new(stretches)
}
