//! The lines so far, as chords in a growing grid: how near is the nearest one
//! that runs alongside?

use super::near::{Chord, Nearest, Own, Search, Vicinity, END, LATER, TURN};
use crate::vector::{cross, dot, point, Point};
use std::ops::Range;

/// Most cells of the grid; beyond it cells grow.
const MOST_CELLS: usize = 1 << 24;

/// Chords by the cell of their middle. The grid grows where the lines go;
/// nothing depends on its size.
#[derive(Debug)]
pub(super) struct Chords {
    cell: f64,
    /// 1 / `cell`.
    scale: f64,
    low: Point,
    columns: usize,
    rows: usize,
    /// The last chord of each cell, which names the one before it.
    last: Vec<u32>,
    /// In order of insertion, so that the last ones can be taken back.
    chords: Vec<Chord>,
    longest_half: f64,
}

impl Chords {
    /// Cells of about `cell`, first around `low` to `high`.
    pub(super) fn new(low: Point, high: Point, cell: f64) -> Self {
        let mut chords = Self {
            cell,
            scale: 1.0 / cell,
            low,
            columns: 0,
            rows: 0,
            last: Vec::new(),
            chords: Vec::new(),
            longest_half: 0.0,
        };
        chords.lay_out(low, high);
        chords
    }

    /// Makes the grid hold everything from `low` to `high` and fills it anew.
    fn lay_out(&mut self, low: Point, high: Point) {
        let (width, height) = ((high.x - low.x).max(0.0), (high.y - low.y).max(0.0));
        while (width / self.cell + 1.0) * (height / self.cell + 1.0) > MOST_CELLS as f64 {
            self.cell *= 2.0;
        }
        self.low = low;
        self.scale = 1.0 / self.cell;
        self.columns = (width / self.cell) as usize + 1;
        self.rows = (height / self.cell) as usize + 1;
        self.last = vec![END; self.columns * self.rows];
        for i in 0..self.chords.len() {
            self.link(i);
        }
    }

    /// Puts a chord at the head of its cell's list.
    fn link(&mut self, i: usize) {
        let index = self.index(self.chords[i].middle);
        self.chords[i].next = std::mem::replace(&mut self.last[index], i as u32);
    }

    fn index(&self, p: Point) -> usize {
        let x = ((p.x - self.low.x) * self.scale) as usize;
        let y = ((p.y - self.low.y) * self.scale) as usize;
        y.min(self.rows - 1) * self.columns + x.min(self.columns - 1)
    }

    fn high(&self) -> Point {
        self.low + point(self.columns as f64, self.rows as f64) * self.cell
    }

    pub(super) fn len(&self) -> usize {
        self.chords.len()
    }

    pub(super) fn push(&mut self, chord: Chord) {
        let (p, low, high) = (chord.middle, self.low, self.high());
        if p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y {
            // Half as much again on the side in question: amortised O(1).
            let grow = (high - low) * 0.5;
            let new_low = point(
                if p.x < low.x {
                    p.x.min(low.x - grow.x)
                } else {
                    low.x
                },
                if p.y < low.y {
                    p.y.min(low.y - grow.y)
                } else {
                    low.y
                },
            );
            let new_high = point(
                if p.x > high.x {
                    p.x.max(high.x + grow.x)
                } else {
                    high.x
                },
                if p.y > high.y {
                    p.y.max(high.y + grow.y)
                } else {
                    high.y
                },
            );
            self.lay_out(new_low, new_high);
        }
        self.chords.push(chord);
        self.link(self.chords.len() - 1);
        self.longest_half = self.longest_half.max(chord.half);
    }

    /// Takes back all but the first `len` chords.
    pub(super) fn truncate(&mut self, len: usize) {
        while self.chords.len() > len {
            if let Some(chord) = self.chords.pop() {
                let index = self.index(chord.middle);
                self.last[index] = chord.next;
            }
        }
    }

    /// The nearest chord within `reach` of `p` that runs within 45 degrees of
    /// the unit vector `along`.
    pub(super) fn nearest(&self, p: Point, along: Point, reach: f64) -> Option<Nearest> {
        self.near(p, along, (reach, 0.0), None)
    }

    /// [`nearest`](Self::nearest), or any that is nearer than `enough`. Of an
    /// own chord only what `p` is abreast of counts.
    pub(super) fn near(
        &self,
        p: Point,
        along: Point,
        (reach, enough): (f64, f64),
        own: Option<Own>,
    ) -> Option<Nearest> {
        let mut search = Search::new(p, along, reach, own, false);
        // What is found at once narrows the rest.
        let home = self.index(p);
        self.look_into(home..home + 1, |chord| search.look(chord));
        let wide = search.limit.sqrt() + self.longest_half;
        let (bottom, top) = self.span(p.y, wide, self.low.y, self.rows);
        let middle = home / self.columns;
        for y in (middle..=top).chain((bottom..middle).rev()) {
            if search.limit < enough * enough {
                break;
            }
            let wide = search.limit.sqrt() + self.longest_half;
            self.look_along(y, p, wide, |chord| search.look(chord));
        }
        search.nearest()
    }

    /// Distances to the nearest chords within `reach` of `p` that run within 45
    /// degrees of the unit vector `along`, to its left and to its right. Of an
    /// own chord only what `p` is abreast of counts.
    pub(super) fn beside(&self, p: Point, along: Point, reach: f64, own: Own) -> [Option<f64>; 2] {
        let mut searches = [0, 1].map(|_| Search::new(p, along, reach, Some(own), false));
        let wide = reach + self.longest_half;
        let (bottom, top) = self.span(p.y, wide, self.low.y, self.rows);
        for y in bottom..=top {
            self.look_along(y, p, wide, |chord| {
                let right = cross(along, chord.middle - p) < 0.0;
                searches[usize::from(right)].look(chord);
            });
        }
        searches.map(|search| Some(search.nearest()?.distance))
    }

    /// Takes chords out of all answers, in place: a chord without a direction
    /// runs alongside nothing.
    pub(super) fn hide(&mut self, range: Range<usize>) -> Vec<Chord> {
        let hidden = self.chords[range.clone()].to_vec();
        for chord in &mut self.chords[range] {
            chord.along = Point::zero();
        }
        hidden
    }

    /// Undoes [`hide`](Self::hide).
    pub(super) fn show(&mut self, from: usize, hidden: &[Chord]) {
        for (chord, hidden) in self.chords[from..].iter_mut().zip(hidden) {
            chord.along = hidden.along;
        }
    }

    /// Gathers the chords that looks need which reach as far as `reach`, from
    /// anywhere within `radius` of `p`, by a line that has not turned by more
    /// than 15 degrees from `along` since. Chords that are added later are not
    /// among them, nor own ones that stay neighbours all the way.
    pub(super) fn gather(
        &self,
        p: Point,
        along: Point,
        own: Own,
        (reach, radius): (f64, f64),
        vicinity: &mut Vicinity,
    ) {
        (vicinity.centre, vicinity.along, vicinity.radius) = (p, along, radius);
        vicinity.chords.clear();
        let wide = reach + radius + self.longest_half;
        let (bottom, top) = self.span(p.y, wide, self.low.y, self.rows);
        for y in bottom..=top {
            self.look_along(y, p, wide, |chord| {
                // So straight a way out of the circle is at most this long.
                let gone = (own.arc - chord.arc).abs() + radius / TURN;
                if chord.line == own.line && gone < own.gap + chord.half {
                    return;
                }
                let off = chord.middle - p;
                let near = reach + radius + chord.half;
                if dot(off, off) <= near * near && dot(chord.along, along).abs() >= LATER {
                    vicinity.chords.push(*chord);
                }
            });
        }
    }

    /// The cells of one row that a circle of radius `wide` around `p` meets.
    fn look_along(&self, y: usize, p: Point, wide: f64, mut look: impl FnMut(&Chord)) {
        let bottom = self.low.y + y as f64 * self.cell;
        // The first and the last row also hold what lies a hair beyond them.
        let above = if y == 0 { 0.0 } else { (bottom - p.y).max(0.0) };
        let below = if y + 1 == self.rows {
            0.0
        } else {
            (p.y - bottom - self.cell).max(0.0)
        };
        let off = above.max(below);
        if off > wide {
            return;
        }
        let half = (wide * wide - off * off).sqrt() * (1.0 + 1e-9);
        let (first, last) = self.span(p.x, half, self.low.x, self.columns);
        let row = y * self.columns;
        self.look_into(row + first..row + last + 1, &mut look);
    }

    #[inline]
    fn look_into(&self, cells: Range<usize>, mut look: impl FnMut(&Chord)) {
        for &head in &self.last[cells] {
            let mut i = head;
            while let Some(chord) = self.chords.get(i as usize) {
                look(chord);
                i = chord.next;
            }
        }
    }

    /// The first and last of a row of cells within `wide` of `from`.
    fn span(&self, from: f64, wide: f64, low: f64, count: usize) -> (usize, usize) {
        let first = ((from - wide - low) * self.scale).max(0.0) as usize;
        let last = ((from + wide - low) * self.scale).max(0.0) as usize;
        (first.min(count - 1), last.min(count - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{distance, nearest_on_segment};

    fn random_chords() -> Vec<(Point, Point)> {
        (0..500)
            .map(|i| {
                let a = point((i * 73 % 401) as f64 - 90.0, (i * 151 % 397) as f64 - 200.0);
                let u = i as f64 * 0.37;
                (a, a + point(u.cos(), u.sin()) * (1.0 + (i % 7) as f64))
            })
            .collect()
    }

    #[test]
    fn nearest_agrees_with_looking_at_all() {
        let all = random_chords();
        // Starts far too small, so that it has to grow on every side.
        let mut chords = Chords::new(point(0.0, 0.0), point(10.0, 10.0), 9.0);
        for (i, &(a, b)) in all.iter().enumerate() {
            chords.push(Chord::new(a, b, i as u32, 0, 0.0).unwrap());
        }
        for i in 0..200 {
            let p = point((i * 37 % 450) as f64 - 110.0, (i * 91 % 440) as f64 - 220.0);
            let along = point((i as f64).cos(), (i as f64).sin());
            let found = chords.nearest(p, along, 25.0);
            let expected = all
                .iter()
                .filter(|(a, b)| dot(*b - *a, along).abs() > 0.5_f64.sqrt() * distance(*a, *b))
                .map(|&(a, b)| distance(nearest_on_segment(p, a, b), p))
                .min_by(f64::total_cmp)
                .filter(|&d| d < 25.0);
            match (found, expected) {
                (Some(found), Some(expected)) => {
                    assert!((found.distance - expected).abs() < 1e-9);
                }
                (found, expected) => assert!(found.is_none() && expected.is_none()),
            }
        }
    }

    #[test]
    fn a_vicinity_answers_like_the_whole() {
        let mut chords = Chords::new(point(0.0, 0.0), point(10.0, 10.0), 9.0);
        for (i, (a, b)) in random_chords().into_iter().enumerate() {
            chords.push(Chord::new(a, b, i as u32, 0, 0.0).unwrap());
        }
        let own = Own {
            line: u32::MAX,
            arc: 0.0,
            gap: 0.0,
        };
        let mut vicinity = Vicinity::default();
        for i in 0..100 {
            let p = point((i * 37 % 300) as f64, (i * 91 % 300) as f64 - 100.0);
            let way = |u: f64| point(u.cos(), u.sin());
            chords.gather(p, way(i as f64), own, (15.0, 8.0), &mut vicinity);
            for j in 0..20 {
                let q = p + way(j as f64) * (0.4 * j as f64);
                let along = way(i as f64 + 0.025 * (j - 10) as f64);
                assert!(vicinity.serves(q, along));
                let some = vicinity.nearest(q, along, 15.0, own, false);
                let all = chords.nearest(q, along, 15.0);
                assert_eq!(some.map(|n| n.distance), all.map(|n| n.distance));
            }
            assert!(!vicinity.serves(p + point(8.1, 0.0), way(i as f64)));
            assert!(!vicinity.serves(p, way(i as f64 + 0.3)));
        }
    }

    #[test]
    fn hidden_chords_are_not_seen_until_shown() {
        let mut chords = Chords::new(point(0.0, 0.0), point(50.0, 50.0), 10.0);
        for (line, y) in [(0, 2.0), (1, -7.0)] {
            let chord = Chord::new(point(0.0, y), point(5.0, y), line, 0, 2.5);
            chords.push(chord.unwrap());
        }
        let east = point(1.0, 0.0);
        let own = Own {
            line: 9,
            arc: 0.0,
            gap: 0.0,
        };
        let sides = |chords: &Chords| chords.beside(point(2.0, 0.0), east, 10.0, own);
        assert_eq!(sides(&chords), [Some(2.0), Some(7.0)]);
        assert_eq!(
            chords.beside(point(2.0, 0.0), east * -1.0, 5.0, own),
            [None, Some(2.0)]
        );
        let hidden = chords.hide(0..1);
        assert_eq!(sides(&chords), [None, Some(7.0)]);
        chords.show(0, &hidden);
        assert_eq!(sides(&chords), [Some(2.0), Some(7.0)]);
    }

    #[test]
    fn truncate_takes_back_the_last() {
        let all = random_chords();
        let mut chords = Chords::new(point(0.0, 0.0), point(0.0, 0.0), 9.0);
        for (i, &(a, b)) in all.iter().enumerate() {
            chords.push(Chord::new(a, b, i as u32, 0, 0.0).unwrap());
        }
        chords.truncate(10);
        assert_eq!(chords.len(), 10);
        let mut left = 0;
        for &head in &chords.last {
            let mut i = head;
            while let Some(chord) = chords.chords.get(i as usize) {
                left += 1;
                i = chord.next;
            }
        }
        assert_eq!(left, 10);
        assert!(Chord::new(all[0].0, all[0].0, 0, 0, 0.0).is_none());
    }

    #[test]
    fn own_chords_count_only_abreast_and_far_along() {
        let mut chords = Chords::new(point(0.0, 0.0), point(50.0, 50.0), 10.0);
        chords.push(Chord::new(point(0.0, 0.0), point(5.0, 0.0), 3, 0, 2.5).unwrap());
        let ask = |p: Point, arc: f64| {
            let own = Own {
                line: 3,
                arc,
                gap: 30.0,
            };
            let mut vicinity = Vicinity::default();
            let east = point(1.0, 0.0);
            assert!(!vicinity.serves(p, east));
            chords.gather(p, east, own, (10.0, 1.0), &mut vicinity);
            assert!(vicinity.serves(p, east));
            vicinity.nearest(p, east, 10.0, own, false)
        };
        assert!(ask(point(-1.0, 0.5), 100.0).is_none());
        assert!(ask(point(1.0, 0.5), 20.0).is_none());
        assert!(ask(point(1.0, 0.5), 100.0).unwrap().own);
        let crossing = chords.nearest(point(1.0, 1.0), point(0.0, 1.0), 10.0);
        assert!(crossing.is_none());
    }
}
