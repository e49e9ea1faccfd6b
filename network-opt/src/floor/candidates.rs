//! The rooms that may be placed on a floor, with counts and wishes.

use std::collections::BTreeMap;

use geo_types::Coord;

use super::measure::{area, centre, distance, is_inside};
use super::on::bad;
use super::place::placements;
use super::spec::{FloorSpecification, Room};
use crate::design::{Placement, RoomCount, RoomWish, Rooms, Tessellation};
use crate::error::DesignError;

impl FloorSpecification {
    /// All rooms that may be placed, with counts and wishes.
    pub(super) fn rooms(
        &self,
        mesh: &Tessellation,
        middles: &[Coord<f64>],
        free: &[bool],
        windows: &[bool],
        entrances: &[Coord<f64>],
    ) -> Result<Rooms, DesignError> {
        let mut rooms = Rooms {
            covered: free.to_vec(),
            ..Rooms::default()
        };
        let mut of_kind: Vec<std::ops::Range<usize>> = Vec::new();
        let mut sizes: Vec<usize> = Vec::new();
        for room in &self.rooms {
            let first = rooms.placements.len();
            let mut own: BTreeMap<Vec<usize>, Placement> = BTreeMap::new();
            for shape in &room.shapes {
                let found = placements(mesh, &room.name, shape, room.mirrored, self.irregular);
                let fits = found.into_iter().filter(|p| {
                    p.faces.iter().all(|&f| free[f]) && is_allowed(room, mesh, middles, p)
                });
                own.extend(fits.map(|p| (p.faces.clone(), p)));
            }
            for placement in own.into_values() {
                let mut cost = Some(room.cost);
                let mut add = |wanted: Option<Option<f64>>, granted: bool| {
                    if let (Some(wanted), false) = (wanted, granted) {
                        cost = cost.zip(wanted).map(|(a, b)| a + b);
                    }
                };
                let window = placement.border.iter().any(|&e| windows[e]);
                add(room.window.cost(), window);
                if let Some(near) = room.near_entrance {
                    let at = centre(middles, &placement.faces);
                    let way = |&c: &Coord<f64>| distance(c, at);
                    let away = entrances.iter().map(way).fold(f64::INFINITY, f64::min);
                    add(near.wish.cost(), away <= near.within);
                }
                // What is demanded and not there is no place for the room.
                let Some(cost) = cost else { continue };
                if cost > 0.0 {
                    rooms.wishes.push(RoomWish {
                        when: vec![rooms.placements.len()],
                        then: vec![],
                        cost: Some(cost),
                    });
                }
                sizes.push(placement.faces.len());
                rooms.placements.push(placement);
            }
            let last = rooms.placements.len();
            if room.least > 0 || room.most.is_some() {
                rooms.counts.push(RoomCount {
                    name: room.name.clone(),
                    rooms: (first..last).collect(),
                    least: room.least,
                    most: room.most,
                });
                if last - first < room.least {
                    return bad(format!(
                        "there is room for {} of {:?}, of which there are to be {} at least",
                        last - first,
                        room.name,
                        room.least
                    ));
                }
            }
            of_kind.push(first..last);
        }
        self.is_there_a_room_everywhere(&rooms, middles, &sizes)?;
        self.neighbours(mesh, &of_kind, &mut rooms);
        Ok(rooms)
    }

    fn is_there_a_room_everywhere(
        &self,
        rooms: &Rooms,
        middles: &[Coord<f64>],
        sizes: &[usize],
    ) -> Result<(), DesignError> {
        let mut fits = vec![false; rooms.covered.len()];
        let faces = rooms.placements.iter().flat_map(|p| &p.faces);
        faces.for_each(|&f| fits[f] = true);
        let bare = (0..fits.len()).filter(|&f| rooms.covered[f] && !fits[f]);
        let bare: Vec<usize> = bare.collect();
        if let Some(&f) = bare.first() {
            return bad(format!(
                "no room fits on {} of the squares, such as the one at ({:.2}, {:.2}); allow smaller shapes, or make it an obstacle",
                bare.len(),
                middles[f].x,
                middles[f].y
            ));
        }
        let count = rooms.covered.iter().filter(|c| **c).count();
        let step = sizes.iter().copied().fold(0, common);
        if step > 1 && count % step != 0 {
            return bad(format!(
                "the floor has {count} squares, and all rooms have multiples of {step}; allow another shape"
            ));
        }
        Ok(())
    }

    /// Wishes and demands about walls in common.
    fn neighbours(
        &self,
        mesh: &Tessellation,
        of_kind: &[std::ops::Range<usize>],
        rooms: &mut Rooms,
    ) {
        let kind = |name: &str| self.rooms.iter().position(|r| r.name == name);
        // By edge and side the placements of a kind that have it on their border.
        let walls = |k: usize| {
            let mut walls: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
            for p in of_kind[k].clone() {
                let placement = &rooms.placements[p];
                for &e in &placement.border {
                    let side = mesh
                        .faces_of(e)
                        .iter()
                        .find(|f| placement.faces.contains(f));
                    if let Some(&f) = side {
                        walls.entry((e, f)).or_default().push(p);
                    }
                }
            }
            walls
        };
        let across = |e: usize, f: usize| mesh.faces_of(e).iter().copied().find(|&g| g != f);
        let (mut wishes, mut counts) = (Vec::new(), Vec::new());
        for (k, room) in self.rooms.iter().enumerate() {
            for beside in &room.beside {
                let (Some(cost), Some(other)) = (beside.wish.cost(), kind(&beside.room)) else {
                    continue;
                };
                let walls = walls(other);
                for p in of_kind[k].clone() {
                    let placement = &rooms.placements[p];
                    let mut then = Vec::new();
                    for &e in &placement.border {
                        let faces = mesh.faces_of(e).iter();
                        let there = faces.filter(|f| !placement.faces.contains(f));
                        let there = there.filter_map(|&f| walls.get(&(e, f))).flatten();
                        // A room across the wall must not be in the way.
                        then.extend(there.copied().filter(|&q| {
                            let faces = &rooms.placements[q].faces;
                            faces.iter().all(|f| !placement.faces.contains(f))
                        }));
                    }
                    then.sort_unstable();
                    then.dedup();
                    wishes.push(RoomWish {
                        when: vec![p],
                        then,
                        cost,
                    });
                }
            }
            let own = if room.apart.is_empty() {
                BTreeMap::new()
            } else {
                walls(k)
            };
            for name in &room.apart {
                let Some(other) = kind(name) else { continue };
                let others = walls(other);
                for (&(e, f), here) in &own {
                    // Two of one kind are met from both sides; once is enough.
                    let Some(g) = across(e, f).filter(|&g| other != k || f < g) else {
                        continue;
                    };
                    if let Some(there) = others.get(&(e, g)) {
                        // No face has two rooms, so this is one on each side.
                        counts.push(RoomCount {
                            name: format!("{} beside {name}", room.name),
                            rooms: here.iter().chain(there).copied().collect(),
                            least: 0,
                            most: Some(1),
                        });
                    }
                }
            }
        }
        rooms.wishes.extend(wishes);
        rooms.counts.extend(counts);
    }
}

/// Whether a room may be there, whatever else is.
fn is_allowed(room: &Room, mesh: &Tessellation, middles: &[Coord<f64>], p: &Placement) -> bool {
    let touches = |edges: &[usize]| edges.iter().any(|e| p.border.contains(e));
    let area = || -> f64 { p.faces.iter().map(|&f| area(mesh, f)).sum() };
    (room.touching.is_empty() || touches(&room.touching))
        && !touches(&room.avoiding)
        && (room.within.is_empty()
            || (p.faces.iter()).all(|&f| is_inside(&room.within, middles[f])))
        && (room.least_area == 0.0 || area() >= room.least_area)
        && room.most_area.is_none_or(|most| area() <= most)
}

/// The largest number that divides both.
fn common(a: usize, b: usize) -> usize {
    if b == 0 {
        a
    } else {
        common(b, a % b)
    }
}
