//! Where a line has no near neighbour on either side, two take its place.
//!
//! In a field that spreads, a gap widens from d_test until a new line fits into
//! its middle, at twice that. A line between two such gaps has a neighbour on
//! neither side. But its two gaps together are then wider than three times
//! d_test (for `widest` is at least 1.5 `test`), and two lines at the thirds fit
//! where it was.

use super::chords::Own;
use super::grow::Placer;
use super::watch::Watch;
use crate::field::DirectionField;
use crate::streamline::{Sample, Streamline};
use crate::trace::Stop;
use crate::vector::{distance, left, Point};
use std::ops::Range;

/// Distance between the places of a line that are looked at, in separations.
const PIECE: f64 = 0.25;
/// Shorter stretches stay, in separations: two more ends at either side of one
/// would be worse.
const LEAST: f64 = 1.5;
/// A look that finds a line as near as this, in separations, need not find the
/// nearest.
const ENOUGH: f64 = 1.0;
/// Chords of its own nearer along a line than this many separations are no
/// neighbours of it.
const OWN_GAP: f64 = 3.0;
/// Most rounds: each leaves some tenth of what the one before it found.
const ROUNDS: usize = 4;
/// A neighbour farther than this many times the widest gap is none.
const REACH: f64 = 1.6;

/// A stretch of a line without near neighbours.
struct Lonely {
    /// Arc lengths from the start of the line.
    from: f64,
    to: f64,
    /// Where the lines that take its place start.
    seeds: [Option<Point>; 2],
    heading: Point,
}

impl<F: DirectionField + ?Sized> Placer<'_, F> {
    /// Rounds over all lines, then over those that were added, and so on.
    pub(super) fn even_out(&mut self, widest: f64) {
        let mut from = 0;
        for _ in 0..ROUNDS {
            let to = self.lines.len();
            for index in from..to {
                for lonely in self.lonely(index, widest) {
                    self.replace(index, &lonely);
                }
            }
            self.grow();
            // No line loses a neighbour but to nearer ones: the rest stay good.
            from = to;
        }
    }

    /// The stretches of a line without a neighbour nearer than `widest`
    /// separations on either side, the last one first.
    fn lonely(&self, index: usize, widest: f64) -> Vec<Lonely> {
        let line = &self.lines[index];
        // A ring has no end to begin with, and neighbours all round.
        if line.points.len() < 2 || line.is_closed() {
            return Vec::new();
        }
        let typical = self.spacing.at(line.seed, line.family);
        let samples = line.samples(PIECE * typical);
        let seed = arc_of_seed(line);
        // Chords of its own that are near along it are no neighbours.
        let own = |i: usize| Own {
            line: index as u32,
            arc: (i as f64 + 0.5) * samples[i].length - seed,
            gap: OWN_GAP * typical,
        };
        let mut found = Vec::new();
        let (mut i, mut from) = (0, None);
        while let Some(sample) = samples.get(i) {
            let separation = self.spacing.at(sample.at, line.family);
            let wide = widest * separation;
            let reach = (wide, ENOUGH * separation);
            match self
                .chords
                .near(sample.at, sample.tangent, reach, Some(own(i)))
            {
                None => {
                    from.get_or_insert(i);
                    i += 1;
                }
                Some(near) => {
                    if let Some(from) = from.take() {
                        found.extend(self.stretch(line, &samples, from..i, &own, widest));
                    }
                    // As far on as nothing can have changed.
                    i += ((wide - near.distance) / sample.length) as usize + 1;
                }
            }
        }
        if let Some(from) = from {
            found.extend(self.stretch(line, &samples, from..samples.len(), &own, widest));
        }
        found.reverse();
        found
    }

    /// A stretch of lonely samples, if it is long enough and there is room.
    fn stretch(
        &self,
        line: &Streamline,
        samples: &[Sample],
        range: Range<usize>,
        own: &impl Fn(usize) -> Own,
        widest: f64,
    ) -> Option<Lonely> {
        let middle = (range.start + range.end) / 2;
        let sample = samples.get(middle)?;
        let separation = self.spacing.at(sample.at, line.family);
        if (range.len() as f64) * sample.length < LEAST * separation {
            return None;
        }
        let reach = REACH * widest * separation;
        let gaps = self
            .chords
            .beside(sample.at, sample.tangent, reach, own(middle));
        let places = self.places(gaps.map(|gap| Some(gap? / separation)), widest);
        let aside = left(sample.tangent) * separation;
        let seeds = places.map(|off| Some(sample.at + aside * off?));
        (seeds != [None, None]).then(|| Lonely {
            from: range.start as f64 * sample.length,
            to: range.end as f64 * sample.length,
            seeds,
            heading: sample.tangent,
        })
    }

    /// How far to the left of a line with these gaps new ones start, all in
    /// separations.
    fn places(&self, gaps: [Option<f64>; 2], widest: f64) -> [Option<f64>; 2] {
        let test = self.options.test;
        // Beside the boundary nearer to the one neighbour, so that the gap to it
        // grows from the least to the widest while the old one would from the
        // widest on.
        let near = |gap: f64| gap * (1.0 - 1.02 * test / widest);
        match gaps {
            [Some(l), Some(r)] if l + r > 3.0 * test => {
                let third = (l + r) / 3.0;
                [Some(l - third), Some(third - r)]
            }
            [Some(l), None] => [Some(near(l)), None],
            [None, Some(r)] => [Some(-near(r)), None],
            _ => [None, None],
        }
    }

    /// Cuts the stretch out of the line and starts the new ones; undone, and
    /// false, if these do not fill it.
    fn replace(&mut self, index: usize, lonely: &Lonely) -> bool {
        let old = self.lines[index].clone();
        let (chords, lines) = (self.chords.len(), self.lines.len());
        let laid = self.laid[index].clone();
        let hidden = self.chords.hide(laid.clone());
        let [before, after] = without(&old, lonely.from..lonely.to);
        let least = self.options.min_length * self.spacing.at(old.seed, old.family);
        let fit = |part: Option<Streamline>| part.filter(|part| part.length() >= least);
        let (before, after) = (fit(before), fit(after));
        self.lines[index] = before.unwrap_or_else(|| Streamline {
            points: Vec::new(),
            ..old.clone()
        });
        self.laid[index] = self.lay(index);
        if let Some(after) = after {
            self.lines.push(after);
            let laid = self.lay(self.lines.len() - 1);
            self.laid.push(laid);
        }
        let first = self.lines.len();
        for at in lonely.seeds.into_iter().flatten() {
            self.start(
                at,
                lonely.heading,
                old.family,
                old.seed_index,
                self.options.test,
            );
        }
        let filled: f64 = self.lines[first..].iter().map(Streamline::length).sum();
        if filled >= lonely.to - lonely.from {
            return true;
        }
        self.chords.truncate(chords);
        self.chords.show(laid.start, &hidden);
        self.lines.truncate(lines);
        self.laid.truncate(lines);
        (self.lines[index], self.laid[index]) = (old, laid);
        false
    }

    /// Lays the chords of a line anew.
    fn lay(&mut self, index: usize) -> Range<usize> {
        let line = &self.lines[index];
        let from = self.chords.len();
        if !line.points.is_empty() {
            let name = (index as u32, line.family);
            let test = self.options.test;
            Watch::new(&mut self.chords, self.spacing, test, name, line.seed).relay(line);
        }
        from..self.chords.len()
    }
}

/// Arc length from the start of a line to its seed.
fn arc_of_seed(line: &Streamline) -> f64 {
    let behind = line.points.iter().take_while(|&&p| p != line.seed).count();
    let behind = behind.min(line.points.len() - 1);
    line.points[..=behind]
        .windows(2)
        .map(|p| distance(p[0], p[1]))
        .sum()
}

/// What is left of a line before and after a stretch, up to whole pieces.
fn without(line: &Streamline, stretch: Range<f64>) -> [Option<Streamline>; 2] {
    let points = &line.points;
    let (mut arc, mut last, mut first) = (0.0, 0, points.len());
    for i in 0..points.len() {
        if i > 0 {
            arc += distance(points[i - 1], points[i]);
        }
        if arc <= stretch.start {
            last = i;
        }
        if arc >= stretch.end && first == points.len() {
            first = i;
        }
    }
    let part = |range: Range<usize>, start: Stop, end: Stop| {
        let points = points[range].to_vec();
        if points.len() < 2 {
            return None;
        }
        let seed = if points.contains(&line.seed) {
            line.seed
        } else {
            points[points.len() / 2]
        };
        Some(Streamline {
            points,
            start,
            end,
            seed,
            ..line.clone()
        })
    };
    [
        part(0..last + 1, line.start, Stop::Neighbour),
        part(first..points.len(), Stop::Neighbour, line.end),
    ]
}
