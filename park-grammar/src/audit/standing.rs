//! What stands where it must not.

use geo_types::Coord;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{RTree, AABB};

use super::locate::Locator;
use super::Violation;
use crate::plane::{dist, Area};
use crate::scene::{Ground, Object};

/// What objects are judged by.
pub(super) struct Judge<'a> {
    pub(super) outline: &'a Area,
    /// Numbers of pieces with their areas.
    pub(super) pieces: &'a [(usize, &'a Area)],
    /// The ground of every piece.
    pub(super) grounds: &'a [Ground],
    pub(super) volumes: &'a [(usize, &'a Area)],
    /// How deep footprints may lie in what they must not, metres.
    pub(super) rounding: f64,
}

/// All that objects do wrong. `objects` are numbers with the objects, none with
/// coordinates that are not finite.
pub(super) fn objects(judge: &Judge<'_>, objects: &[(usize, Object)]) -> Vec<Violation> {
    let outline = Locator::new([(0, judge.outline)]);
    let pieces = Locator::new(judge.pieces.iter().copied());
    let volumes = Locator::new(judge.volumes.iter().copied());
    let mut found = Vec::new();
    for (number, object) in objects {
        let (number, at, radius) = (*number, object.at, object.radius);
        let out = reach(&outline, at, radius, Side::Out);
        let depth = out
            .iter()
            .fold(0.0, |most: f64, (_, depth)| most.max(*depth));
        if depth > judge.rounding {
            found.push(Violation::ObjectOutside {
                object: number,
                depth,
            });
        }
        // Of several pieces on wrong ground the deepest.
        let wrong = reach(&pieces, at, radius, Side::In);
        let wrong = wrong
            .into_iter()
            .filter(|(piece, _)| judge.grounds[*piece] != object.ground);
        if let Some((piece, depth)) = wrong
            .filter(|(_, depth)| *depth > judge.rounding)
            .max_by(|a, b| a.1.total_cmp(&b.1))
        {
            found.push(Violation::WrongGround {
                object: number,
                piece,
                depth,
            });
        }
        for (volume, depth) in reach(&volumes, at, radius, Side::In) {
            if depth > judge.rounding {
                found.push(Violation::InVolume {
                    object: number,
                    volume,
                    depth,
                });
            }
        }
    }
    found.extend(collisions(objects, judge.rounding));
    found
}

/// Which side of an area a footprint must not reach into.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    In,
    Out,
}

/// How far a footprint reaches into areas, or out of them, metres.
fn reach(areas: &Locator, at: Coord<f64>, radius: f64, side: Side) -> Vec<(usize, f64)> {
    let around = areas.around(at);
    let mut found: Vec<(usize, f64)> = Vec::new();
    for (owner, away) in areas.near(at, radius) {
        let within = around.contains(&owner) == (side == Side::In);
        found.push((owner, if within { radius + away } else { radius - away }));
    }
    // Wholly on the wrong side: no edge is near.
    let whole = 2.0 * radius;
    match side {
        Side::In => {
            let far = around.iter().filter(|k| found.iter().all(|f| f.0 != **k));
            let far: Vec<usize> = far.copied().collect();
            found.extend(far.into_iter().map(|owner| (owner, whole)));
        }
        Side::Out if around.is_empty() && found.is_empty() => found.push((0, whole)),
        Side::Out => {}
    }
    found
}

/// Pairs of footprints that share ground.
fn collisions(objects: &[(usize, Object)], rounding: f64) -> Vec<Violation> {
    let square = |object: &Object| {
        let (c, r) = (object.at, object.radius);
        ([c.x - r, c.y - r], [c.x + r, c.y + r])
    };
    let entries = objects.iter().enumerate().map(|(k, (_, object))| {
        let (low, high) = square(object);
        GeomWithData::new(Rectangle::from_corners(low, high), k)
    });
    let tree = RTree::bulk_load(entries.collect());
    let mut found = Vec::new();
    for (k, (number, object)) in objects.iter().enumerate() {
        let (low, high) = square(object);
        let mut met: Vec<usize> = tree
            .locate_in_envelope_intersecting(&AABB::from_corners(low, high))
            .map(|entry| entry.data)
            .filter(|other| *other > k)
            .collect();
        met.sort_unstable();
        for other in met {
            let (other_number, other) = &objects[other];
            let depth = object.radius + other.radius - dist(object.at, other.at);
            if depth > rounding {
                found.push(Violation::Collision {
                    objects: [*number, *other_number],
                    depth,
                });
            }
        }
    }
    found
}
