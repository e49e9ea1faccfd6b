//! Rooms: exact tilings of bare faces, and new tilings of a few rooms.

use super::moves::Walk;
use super::rooms::RoomModel;

/// Placements that are tried for one tiling.
const TRIES: usize = 300;

impl Walk<'_, '_> {
    /// Tiles all faces that are bare. Says whether it could; otherwise nothing
    /// has changed.
    pub(super) fn tile_bare(&mut self) -> bool {
        let bare = self.state.rooms.bare.items().to_vec();
        let mut tries = TRIES + 2 * bare.len();
        let all = self.state.rooms.placed.is_empty();
        let tiled = self.tile(&bare, false, &mut tries);
        // With tries left everything was tried.
        self.untileable |= all && !tiled && tries > 0;
        tiled
    }

    /// Tiles the faces of some rooms around one anew, without corridors inside.
    /// Says whether it could; otherwise nothing has changed.
    pub(super) fn retile(&mut self, room: usize, count: usize) -> bool {
        let Some(rooms) = &self.model.rooms else {
            return false;
        };
        let mut region = vec![room];
        for _ in 0..8 * count {
            if region.len() >= count {
                break;
            }
            let near = self.dice.pick(&region);
            let near = near.and_then(|r| self.neighbour(rooms, r));
            if let Some(other) = near.filter(|r| !region.contains(r)) {
                region.push(other);
            }
        }
        let mark = self.state.mark();
        let mut faces: Vec<usize> = Vec::new();
        for &room in &region {
            faces.extend(rooms.faces.of(room));
            self.state.clear(self.model, room);
        }
        let mut tries = TRIES;
        if self.tile(&faces, true, &mut tries) {
            return true;
        }
        self.state.undo(self.model, mark);
        false
    }

    /// Makes a count less wrong: places a room of it if there are too few, and
    /// tiles the faces of one anew if there are too many.
    pub(super) fn even(&mut self, count: usize) -> bool {
        let Some(rooms) = &self.model.rooms else {
            return false;
        };
        let tally = self.state.rooms.tallies[count];
        let few = tally < rooms.limits[count][0];
        for _ in 0..8 {
            let Some(room) = self.dice.pick(rooms.counted.of(count)) else {
                return false;
            };
            let placed = self.state.rooms.placed.contains(room);
            if placed == few {
                continue;
            }
            let done = if few {
                self.insist(room)
            } else {
                let region = 2 + self.dice.below(4);
                self.retile(room, region)
            };
            if done && self.state.rooms.tallies[count] != tally {
                return true;
            }
        }
        false
    }

    /// Grants a wish: places a room that it wants, or tiles one that it is about
    /// anew.
    pub(super) fn grant(&mut self, wish: usize) -> bool {
        let Some(rooms) = &self.model.rooms else {
            return false;
        };
        let wanted = self.dice.chance(0.6);
        let literals = rooms.wishes.of(wish).iter();
        let some: Vec<usize> = (literals.filter(|l| l.1 != wanted).map(|l| l.0)).collect();
        match self.dice.pick(&some) {
            Some(room) if wanted => self.insist(room),
            Some(room) if self.state.rooms.placed.contains(room) => {
                let region = 2 + self.dice.below(4);
                self.retile(room, region)
            }
            _ => false,
        }
    }

    /// Places a room whatever is in its way, and tiles what is bare then. Says
    /// whether it could; otherwise nothing has changed.
    fn insist(&mut self, room: usize) -> bool {
        let Some(rooms) = &self.model.rooms else {
            return false;
        };
        if rooms.barred[room] || self.state.rooms.placed.contains(room) {
            return false;
        }
        let mark = self.state.mark();
        let mut region: Vec<usize> = Vec::new();
        let owner = &self.state.rooms.owner;
        let in_way = rooms.faces.of(room).iter().filter_map(|&f| owner[f]);
        for other in in_way {
            if !region.contains(&other) {
                region.push(other);
            }
        }
        for _ in 0..self.dice.below(3) {
            let near = self.dice.pick(&region);
            let near = near.and_then(|r| self.neighbour(rooms, r));
            if let Some(other) = near.filter(|r| !region.contains(r)) {
                region.push(other);
            }
        }
        let mut faces: Vec<usize> = Vec::new();
        for &other in &region {
            faces.extend(rooms.faces.of(other));
            self.state.clear(self.model, other);
        }
        let strict = self.dice.chance(0.5);
        if strict && !self.state.rooms.would_do(room).1 {
            self.state.undo(self.model, mark);
            return false;
        }
        self.state.place(self.model, room);
        let mut tries = TRIES;
        if self.tile(&faces, strict, &mut tries) {
            return true;
        }
        self.state.undo(self.model, mark);
        false
    }

    /// Another room on the border of a room.
    fn neighbour(&mut self, rooms: &RoomModel, room: usize) -> Option<usize> {
        let e = self.dice.pick(rooms.borders.of(room))?;
        let beside = rooms.border_at.of(e).iter();
        let mut placed = beside.filter(|&&p| p != room && self.state.rooms.placed.contains(p));
        placed.next().copied()
    }

    /// Covers faces, all of them bare, by placements that fit, the face with
    /// the fewest of them first, those that have a door already mostly before
    /// others.
    fn tile(&mut self, faces: &[usize], strict: bool, tries: &mut usize) -> bool {
        let model = self.model;
        let Some(rooms) = &model.rooms else {
            return false;
        };
        let placed = &self.state.rooms;
        let fits = |p: usize| {
            !rooms.barred[p]
                && (!strict || placed.would_do(p).1)
                && rooms.faces.of(p).iter().all(|&f| placed.bare.contains(f))
        };
        let mut tightest: Option<(usize, usize)> = None;
        for &f in faces.iter().filter(|&&f| placed.bare.contains(f)) {
            let most = tightest.map_or(usize::MAX, |(count, _)| count);
            let count = rooms
                .at_face
                .of(f)
                .iter()
                .filter(|&&p| fits(p))
                .take(most)
                .count();
            if count < most {
                tightest = Some((count, f));
            }
            if count == 0 {
                return false;
            }
        }
        let Some((_, face)) = tightest else {
            return true;
        };
        let mut options: Vec<(u8, bool, u64, usize)> = (rooms.at_face.of(face).iter())
            .filter(|&&p| fits(p))
            .map(|&p| {
                // Mostly: a room with a door may be one that leads nowhere.
                let later = !placed.would_do(p).0 && self.dice.chance(0.8);
                let (mut lacking, mut enough) = (false, false);
                for &c in rooms.counts_at.of(p) {
                    let [least, most] = rooms.limits[c];
                    lacking |= placed.tallies[c] < least;
                    enough |= placed.tallies[c] >= most;
                }
                // Mostly here too: counts may come out right by another tiling.
                let rank = match self.dice.chance(0.8) {
                    true if enough => 2,
                    true if lacking => 0,
                    _ => 1,
                };
                (rank, later, self.dice.bits(), p)
            })
            .collect();
        options.sort_unstable();
        for (_, _, _, p) in options {
            if *tries == 0 {
                return false;
            }
            *tries -= 1;
            let mark = self.state.mark();
            self.state.place(model, p);
            if self.tile(faces, strict, tries) {
                return true;
            }
            self.state.undo(model, mark);
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{EdgeState, Placement, Problem, Rooms};
    use crate::solve::search::model::Model;

    /// A row of eight squares and rooms of so many of them in a row; the edges
    /// across it are 0 to 8, above 9 to 16, below 17 to 24.
    fn corridor(widths: &[usize]) -> Problem {
        let mut ends: Vec<[usize; 2]> = (0..9).map(|k| [k, k + 9]).collect();
        ends.extend((0..8).map(|k| [k + 9, k + 10]));
        ends.extend((0..8).map(|k| [k, k + 1]));
        let placements = (widths.iter())
            .flat_map(|&w| (0..=8 - w).map(move |at| (at, w)))
            .map(|(at, w)| Placement {
                template: "room".into(),
                faces: (at..at + w).collect(),
                inner: (at + 1..at + w).collect(),
                border: [at, at + w]
                    .into_iter()
                    .chain((at..at + w).flat_map(|k| [9 + k, 17 + k]))
                    .collect(),
            });
        let mut sinks = vec![false; 18];
        sinks[0] = true;
        Problem {
            vertices: 18,
            lengths: vec![1.0; 25],
            states: vec![EdgeState::Open; 25],
            sinks,
            rooms: Some(Rooms {
                placements: placements.collect(),
                covered: vec![true; 8],
                ..Rooms::default()
            }),
            length_weight: 1.0,
            ends,
            ..Problem::default()
        }
    }

    #[test]
    fn bare_faces_are_tiled_if_they_can_be() {
        for (widths, possible) in [
            (&[3, 5][..], true),
            (&[2], true),
            (&[3], false),
            (&[5], false),
        ] {
            let problem = corridor(widths);
            let model = Model::new(&problem).expect("no contradiction");
            let mut walk = Walk::new(&model, 0);
            assert_eq!(walk.tile_bare(), possible, "{widths:?}");
            assert_eq!(walk.untileable, !possible, "{widths:?}");
            assert_eq!(walk.state.rooms.bare.len(), if possible { 0 } else { 8 });
        }
    }

    #[test]
    fn new_tilings_keep_out_of_corridors() {
        let problem = corridor(&[1, 2, 3]);
        let model = Model::new(&problem).expect("no contradiction");
        let mut walk = Walk::new(&model, 3);
        assert!(walk.tile_bare());
        walk.state.flip(&model, 4);
        for _ in 0..100 {
            if let Some(room) = walk.dice.pick(walk.state.rooms.placed.items()) {
                walk.retile(room, 3);
            }
            assert!(walk.state.rooms.bare.is_empty());
        }
        // Edge 4 lies between the fourth and the fifth square.
        assert_ne!(walk.state.rooms.owner[3], walk.state.rooms.owner[4]);
        assert!(walk.state.rooms.crossed.is_empty());
    }
}
