//! Where a line has no near neighbour on either side, two take its place.
//!
//! In a field that spreads, a gap widens from d_test until a new line fits into
//! its middle, at twice that. A line between two such gaps has a neighbour on
//! neither side. But its two gaps together are then wider than three times
//! d_test (for `widest` is at least 1.5 `test`), and two lines at the thirds fit
//! where it was.

use super::grow::Placer;
use super::near::Own;
use super::watch::Watch;
use crate::field::DirectionField;
use crate::streamline::Streamline;
use crate::trace::Stop;
use crate::vector::{distance, left, unit, Point};
use std::ops::Range;

/// Distance between the places of a line that are looked at, in separations.
const PIECE: f64 = 0.4;
/// Shorter stretches stay, in separations: two more ends at either side of one
/// would be worse.
const LEAST: f64 = 1.5;
/// A look that finds a line as near as this, in separations, need not find the
/// nearest.
const ENOUGH: f64 = 1.1;
/// Chords of its own nearer along a line than this many separations are no
/// neighbours of it.
const OWN_GAP: f64 = 3.0;
/// Most rounds; more find nothing.
const ROUNDS: usize = 4;
/// A neighbour farther than this many times the widest gap is none.
const REACH: f64 = 1.6;

/// A point of a line, and its arc length from the start.
#[derive(Clone, Copy)]
struct Place {
    point: usize,
    arc: f64,
}

/// A stretch of a line without near neighbours.
struct Lonely {
    /// From the first point of it to the first after it.
    points: Range<usize>,
    length: f64,
    /// Where the lines that take its place start.
    seeds: [Option<Point>; 2],
    heading: Point,
}

impl<F: DirectionField + ?Sized> Placer<'_, F> {
    /// Cuts the lines from `first` on, then those that were added, and so on;
    /// true if any was cut.
    pub(super) fn even_out(&mut self, widest: f64, first: usize) -> bool {
        let (mut from, mut any) = (first, false);
        for _ in 0..ROUNDS {
            let to = self.lines.len();
            for index in from..to {
                for lonely in self.lonely(index, widest) {
                    // What was left before the last cut may have been too short.
                    if lonely.points.end < self.lines[index].points.len() {
                        any |= self.replace(index, &lonely);
                    }
                }
            }
            self.grow();
            // No line loses a neighbour but to nearer ones: the rest stay good.
            from = to;
        }
        any
    }

    /// The stretches of a line without a neighbour nearer than `widest`
    /// separations on either side, the last one first.
    fn lonely(&self, index: usize, widest: f64) -> Vec<Lonely> {
        let line = &self.lines[index];
        // A ring has no end to begin with, and neighbours all round.
        if line.points.len() < 2 || line.is_closed() {
            return Vec::new();
        }
        let points = &line.points;
        let own = Own {
            line: index as u32,
            arc: -arc_of_seed(line),
            gap: OWN_GAP * self.spacing.at(line.seed, line.family),
        };
        let mut found = Vec::new();
        let mut from: Option<Place> = None;
        let (mut arc, mut next) = (0.0, 0.0);
        for (point, &at) in points.iter().enumerate() {
            if point > 0 {
                arc += distance(points[point - 1], at);
            }
            let last = point + 1 == points.len();
            if arc < next && !last {
                continue;
            }
            let place = Place { point, arc };
            let separation = self.spacing.at(at, line.family);
            let (wide, piece) = (widest * separation, PIECE * separation);
            let own = Own {
                arc: own.arc + arc,
                ..own
            };
            let near = heading(points, point).and_then(|along| {
                let reach = (wide, ENOUGH * separation);
                self.chords.near(at, along, reach, Some(own))
            });
            match near {
                None => {
                    from.get_or_insert(place);
                    next = arc + piece;
                }
                // As far on as nothing can have changed.
                Some(near) => next = arc + piece.max(wide - near.distance),
            }
            if near.is_some() || last {
                let stretch = from.take().map(|from| (from, place));
                found.extend(stretch.and_then(|stretch| self.stretch(line, stretch, own, widest)));
            }
        }
        found.reverse();
        found
    }

    /// What to do about a lonely stretch, if it is long enough and there is
    /// room; `own` is for a look from its end.
    fn stretch(
        &self,
        line: &Streamline,
        (from, to): (Place, Place),
        own: Own,
        widest: f64,
    ) -> Option<Lonely> {
        let middle = (from.point + to.point) / 2;
        let at = line.points[middle];
        let separation = self.spacing.at(at, line.family);
        let length = to.arc - from.arc;
        if length < LEAST * separation {
            return None;
        }
        let own = Own {
            arc: own.arc - 0.5 * length,
            ..own
        };
        let along = heading(&line.points, middle)?;
        let reach = REACH * widest * separation;
        let gaps = self.chords.beside(at, along, reach, own);
        let places = self.places(gaps.map(|gap| Some(gap? / separation)), widest);
        let aside = left(along) * separation;
        let seeds = places.map(|off| Some(at + aside * off?));
        (seeds != [None, None]).then_some(Lonely {
            points: from.point..to.point,
            length,
            seeds,
            heading: along,
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
        let [before, after] = without(&old, &lonely.points);
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
        if filled >= lonely.length {
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

/// The direction of a line at one of its points.
fn heading(points: &[Point], i: usize) -> Option<Point> {
    unit(points[(i + 1).min(points.len() - 1)] - points[i.saturating_sub(1)])
}

/// What is left of a line before and after a stretch.
fn without(line: &Streamline, stretch: &Range<usize>) -> [Option<Streamline>; 2] {
    let part = |range: Range<usize>, start: Stop, end: Stop| {
        let points = line.points[range].to_vec();
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
        part(0..stretch.start + 1, line.start, Stop::Neighbour),
        part(stretch.end..line.points.len(), Stop::Neighbour, line.end),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::candidates::Seed;
    use crate::field::from_fn;
    use crate::placement::spacing::Spacing;
    use crate::placement::PlacementOptions;
    use crate::vector::point;
    use geo_types::polygon;

    fn east(y: f64, from: f64, to: f64) -> Streamline {
        let points: Vec<Point> = (0..=40)
            .map(|i| point(from + (to - from) * f64::from(i) / 40.0, y))
            .collect();
        Streamline {
            seed: points[3],
            points,
            start: Stop::FieldEnd,
            end: Stop::LengthLimit,
            family: 0,
            seed_index: 7,
        }
    }

    #[test]
    fn what_is_left_keeps_its_ends_and_has_a_seed() {
        let line = east(0.0, 0.0, 40.0);
        assert_eq!(arc_of_seed(&line), 3.0);
        let [before, after] = without(&line, &(10..25)).map(Option::unwrap);
        assert_eq!((before.points.len(), after.points.len()), (11, 16));
        assert_eq!(
            (before.start, before.end),
            (Stop::FieldEnd, Stop::Neighbour)
        );
        assert_eq!(
            (after.start, after.end),
            (Stop::Neighbour, Stop::LengthLimit)
        );
        assert_eq!((before.seed, after.seed_index), (line.seed, 7));
        assert!(after.points.contains(&after.seed));
        // Nothing before, one point after.
        assert_eq!(without(&line, &(0..40)), [None, None]);
    }

    /// Lines to the east at the given heights, across a square of 400 m, with a
    /// separation of 20 m: what becomes of them.
    fn evened(heights: &[f64]) -> Vec<f64> {
        let square =
            polygon![(x: 0., y: 0.), (x: 400., y: 0.), (x: 400., y: 400.), (x: 0., y: 400.)];
        let field = from_fn(square, |_, _| Some(point(1.0, 0.0)));
        let options = PlacementOptions {
            separation: [20.0; 2],
            test: 0.86,
            widest: Some(1.29),
            families: [true, false],
            ..PlacementOptions::default()
        };
        let seeds: Vec<Seed> = heights
            .iter()
            .map(|&y| Seed {
                at: point(200.0, y),
                directions: [point(1.0, 0.0), point(0.0, 1.0)],
            })
            .collect();
        let spacing = Spacing::new(options.separation, &|_| 1.0, &seeds).unwrap();
        let mut placer = Placer::new(&field, &options, &spacing, &seeds);
        for (i, seed) in seeds.iter().enumerate() {
            assert!(placer.start(seed.at, seed.directions[0], 0, i, 0.86));
        }
        // Without sweeps: they would fill the square.
        for index in 0..heights.len() {
            for lonely in placer.lonely(index, 1.29) {
                placer.replace(index, &lonely);
            }
        }
        let whole = placer.lines.iter().filter(|line| !line.points.is_empty());
        let mut heights: Vec<f64> = whole.map(|line| line.points[0].y).collect();
        heights.sort_by(f64::total_cmp);
        heights
    }

    #[test]
    fn two_lines_take_the_place_of_a_lonely_one() {
        let same = |found: Vec<f64>, expected: &[f64]| {
            let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-9;
            assert!(
                found.len() == expected.len() && found.iter().zip(expected).all(near),
                "{found:?}"
            );
        };
        // Gaps of 28 m, 1.4 separations, on both sides of the middle one.
        let thirds = [128.0 - 28.0 / 3.0, 128.0 + 28.0 / 3.0];
        same(
            evened(&[80.0, 100.0, 128.0, 156.0, 176.0]),
            &[80.0, 100.0, thirds[0], thirds[1], 156.0, 176.0],
        );
        // Next to the boundary lines move nearer to their only neighbour: to
        // 1.02 * 0.86 / 1.29 = 0.68 of the gap.
        same(
            evened(&[100.0, 128.0, 156.0]),
            &[128.0 - 0.68 * 28.0, 128.0, 128.0 + 0.68 * 28.0],
        );
        // Near enough on one side: nobody is lonely.
        assert_eq!(evened(&[100.0, 128.0, 150.0]).len(), 3);
        // One line alone has nothing to go by.
        assert_eq!(evened(&[200.0]), [200.0]);
    }
}
