//! The lines so far, as chords in a growing grid: how near is the nearest one
//! that runs alongside?

use crate::vector::{cross, dot, norm, point, Point};

/// Cosine of 45 degrees: below it two lines cross rather than run alongside.
const ALONGSIDE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Cosine of 60 degrees: what may come alongside before the next look.
const SOON: f64 = 0.5;
/// Most cells of the grid; beyond it cells grow.
const MOST_CELLS: usize = 1 << 24;

/// A stretch of a line, replaced by its chord.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    middle: Point,
    /// Unit vector.
    along: Point,
    half: f64,
    /// Which line.
    line: u32,
    /// Which family that line was started in.
    family: u8,
    /// Arc length of the middle from the line's seed, negative behind it.
    arc: f64,
}

impl Chord {
    /// `None` if the two points are the same.
    pub(super) fn new(a: Point, b: Point, line: u32, family: u8, arc: f64) -> Option<Self> {
        let length = norm(b - a);
        (length > 0.0).then(|| Self {
            middle: (a + b) / 2.0,
            along: (b - a) / length,
            half: 0.5 * length,
            line,
            family,
            arc,
        })
    }

    /// Squared distance from `p`, and the signed distance along the chord of
    /// the perpendicular's foot from its middle.
    fn offset(&self, p: Point) -> (f64, f64) {
        let off = p - self.middle;
        let foot = dot(off, self.along);
        let beyond = (foot.abs() - self.half).max(0.0);
        let aside = cross(self.along, off);
        (aside * aside + beyond * beyond, foot)
    }
}

/// What a line that is being traced needs to recognise its own chords.
#[derive(Clone, Copy, Debug)]
pub(super) struct Own {
    pub(super) line: u32,
    /// Arc length at the point in question.
    pub(super) arc: f64,
    /// Own chords nearer than this along the line are neighbours, not
    /// approaches.
    pub(super) gap: f64,
}

/// The nearest chord that runs alongside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub(super) distance: f64,
    /// Its line is the one that asks.
    pub(super) own: bool,
    /// The family that its line was started in.
    pub(super) family: u8,
}

/// Chords by the cell of their middle. Cells grow where the lines go; nothing
/// depends on their number.
#[derive(Debug)]
pub(super) struct Chords {
    cell: f64,
    low: Point,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<Chord>>,
    longest_half: f64,
    /// Middles in order of insertion, to take the last ones back.
    order: Vec<Point>,
}

impl Chords {
    /// Cells of about `cell`, first around `low` to `high`.
    pub(super) fn new(low: Point, high: Point, cell: f64) -> Self {
        let mut chords = Self {
            cell,
            low,
            columns: 0,
            rows: 0,
            cells: Vec::new(),
            longest_half: 0.0,
            order: Vec::new(),
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
        let old = std::mem::take(&mut self.cells);
        self.low = low;
        self.columns = (width / self.cell) as usize + 1;
        self.rows = (height / self.cell) as usize + 1;
        self.cells = vec![Vec::new(); self.columns * self.rows];
        for chord in old.into_iter().flatten() {
            let index = self.index(chord.middle);
            self.cells[index].push(chord);
        }
    }

    fn index(&self, p: Point) -> usize {
        let x = ((p.x - self.low.x) / self.cell) as usize;
        let y = ((p.y - self.low.y) / self.cell) as usize;
        y.min(self.rows - 1) * self.columns + x.min(self.columns - 1)
    }

    fn high(&self) -> Point {
        self.low + point(self.columns as f64, self.rows as f64) * self.cell
    }

    pub(super) fn len(&self) -> usize {
        self.order.len()
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
        let index = self.index(p);
        self.cells[index].push(chord);
        self.order.push(p);
        self.longest_half = self.longest_half.max(chord.half);
    }

    /// Takes back all but the first `len` chords.
    pub(super) fn truncate(&mut self, len: usize) {
        while self.order.len() > len {
            if let Some(middle) = self.order.pop() {
                let index = self.index(middle);
                let cell = &mut self.cells[index];
                // The last one, unless the grid was laid out anew since.
                if let Some(i) = cell.iter().rposition(|c| c.middle == middle) {
                    cell.remove(i);
                }
            }
        }
    }

    /// The nearest chord within `reach` of `p` that runs within 45 degrees of
    /// the unit vector `along`; between 45 and 60 degrees too if `soon`. Of an
    /// own chord only what `p` is abreast of counts, so that a closing loop may
    /// come up to its seed from behind.
    pub(super) fn nearest(
        &self,
        p: Point,
        along: Point,
        reach: f64,
        own: Option<Own>,
        soon: bool,
    ) -> Option<Nearest> {
        let min_cosine = if soon { SOON } else { ALONGSIDE };
        let mut best: Option<(f64, bool, u8)> = None;
        let mut limit = reach * reach;
        self.visit(p, reach, |chord| {
            if dot(chord.along, along).abs() <= min_cosine {
                return;
            }
            let (square, foot) = chord.offset(p);
            if square >= limit {
                return;
            }
            let mut is_own = false;
            if let Some(own) = own.filter(|own| own.line == chord.line) {
                if (own.arc - chord.arc).abs() < own.gap + chord.half || foot.abs() > chord.half {
                    return;
                }
                is_own = true;
            }
            limit = square;
            best = Some((square, is_own, chord.family));
        });
        best.map(|(square, own, family)| Nearest {
            distance: square.sqrt(),
            own,
            family,
        })
    }

    fn visit(&self, p: Point, reach: f64, mut look: impl FnMut(&Chord)) {
        let wide = reach + self.longest_half;
        let span = |from: f64, low: f64, count: usize| {
            let first = ((from - wide - low) / self.cell).max(0.0) as usize;
            let last = ((from + wide - low) / self.cell).max(0.0) as usize;
            (first.min(count - 1), last.min(count - 1))
        };
        let (x0, x1) = span(p.x, self.low.x, self.columns);
        let (y0, y1) = span(p.y, self.low.y, self.rows);
        for y in y0..=y1 {
            for cell in &self.cells[y * self.columns + x0..=y * self.columns + x1] {
                cell.iter().for_each(&mut look);
            }
        }
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
            let found = chords.nearest(p, along, 25.0, None, false);
            let expected = all
                .iter()
                .filter(|(a, b)| dot(*b - *a, along).abs() > ALONGSIDE * distance(*a, *b))
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
    fn truncate_takes_back_the_last() {
        let all = random_chords();
        let mut chords = Chords::new(point(0.0, 0.0), point(0.0, 0.0), 9.0);
        for (i, &(a, b)) in all.iter().enumerate() {
            chords.push(Chord::new(a, b, i as u32, 0, 0.0).unwrap());
        }
        chords.truncate(10);
        assert_eq!(chords.len(), 10);
        let left: usize = chords.cells.iter().map(Vec::len).sum();
        assert_eq!(left, 10);
        assert!(chords.cells.iter().flatten().all(|c| c.line < 10));
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
            chords.nearest(p, point(1.0, 0.0), 10.0, Some(own), false)
        };
        assert!(ask(point(-1.0, 0.5), 100.0).is_none());
        assert!(ask(point(1.0, 0.5), 20.0).is_none());
        assert!(ask(point(1.0, 0.5), 100.0).unwrap().own);
        let crossing = chords.nearest(point(1.0, 1.0), point(0.0, 1.0), 10.0, None, true);
        assert!(crossing.is_none());
    }
}
