//! Placing line after line: beside earlier ones, or where most room is left.

use super::chords::Chords;
use super::near::Nearest;
use super::options::{PlacementOptions, Strategy};
use super::spacing::Spacing;
use super::watch::Watch;
use crate::candidates::Seed;
use crate::field::{Cursor, DirectionField};
use crate::streamline::Streamline;
use crate::trace::{trace_watched, TraceOptions};
use crate::vector::{distance, left, point, unit, Point};
use std::ops::Range;

/// Width of a cell of the grid, in separations.
const CELL: f64 = 1.0;
/// A line starts beside another one where no third is nearer than this, in
/// separations (or than d_test, if that is more): less than 1, so that a gap
/// that widens is filled before it is two separations wide.
const CLEARANCE: f64 = 0.92;
/// Least advance along a line between two places that are tried, in
/// separations.
const ADVANCE: f64 = 0.125;
/// Rooms wider than this many separations count as equally wide.
const WIDE: f64 = 4.0;
/// So many levels to a separation are told apart by who has most room.
const LEVELS: f64 = 16.0;

pub(super) struct Placer<'a, F: ?Sized> {
    pub(super) field: &'a F,
    pub(super) options: &'a PlacementOptions,
    pub(super) spacing: &'a Spacing<'a>,
    trace: TraceOptions,
    pub(super) chords: Chords,
    /// Lines that were given up have no points.
    pub(super) lines: Vec<Streamline>,
    /// Where the chords of each line are.
    pub(super) laid: Vec<Range<usize>>,
    pub(super) cursor: Cursor,
    /// The first lines beside which, and across which, nothing was tried yet.
    beside: usize,
    across: usize,
}

/// Most rounds of cutting and filling.
const ROUNDS: usize = 4;

/// An orientation at a seed.
#[derive(Clone, Copy)]
struct Way {
    family: u8,
    heading: Point,
    /// A line runs along it within the separation.
    taken: bool,
}

/// On which side of a line new ones are tried.
#[derive(Clone, Copy)]
enum Side {
    /// One separation to the left (1) or right (-1) of it.
    Beside(f64),
    /// On it, across.
    Across,
}

impl<'a, F: DirectionField + ?Sized> Placer<'a, F> {
    pub(super) fn new(
        field: &'a F,
        options: &'a PlacementOptions,
        spacing: &'a Spacing<'a>,
        seeds: &[Seed],
    ) -> Self {
        let mut low = point(f64::INFINITY, f64::INFINITY);
        let mut high = low * -1.0;
        for seed in seeds {
            low = point(low.x.min(seed.at.x), low.y.min(seed.at.y));
            high = point(high.x.max(seed.at.x), high.y.max(seed.at.y));
        }
        if seeds.is_empty() {
            (low, high) = (Point::zero(), Point::zero());
        }
        Self {
            field,
            options,
            spacing,
            trace: TraceOptions {
                self_approach: 0.0,
                ..options.trace
            },
            chords: Chords::new(low, high, CELL * spacing.typical()),
            lines: Vec::new(),
            laid: Vec::new(),
            cursor: Cursor::default(),
            beside: 0,
            across: 0,
        }
    }

    pub(super) fn run(mut self, seeds: &[Seed]) -> Vec<Streamline> {
        let mut full = match (self.options.strategy, middle(seeds)) {
            (Strategy::Farthest, _) => {
                self.farthest(seeds);
                true
            }
            (Strategy::Neighbour, first) => {
                // From the middle outwards.
                if let Some(index) = first {
                    self.start_at(seeds, index);
                }
                false
            }
        };
        // Cutting comes before the seeds are seen to, as far as it can.
        if let Some(widest) = self.options.widest {
            let mut seen = 0;
            for _ in 0..ROUNDS {
                self.grow();
                full &= !self.even_out(widest, seen);
                seen = self.lines.len();
                if !full {
                    self.fill(seeds);
                    full = true;
                }
                if seen == self.lines.len() {
                    break;
                }
            }
        } else if !full {
            self.fill(seeds);
        }
        self.lines.retain(|line| !line.points.is_empty());
        self.lines
    }

    /// Lines beside and across all earlier ones, and at the seeds, in order,
    /// that none of these serves.
    fn fill(&mut self, seeds: &[Seed]) {
        self.grow();
        for index in 0..seeds.len() {
            self.start_at(seeds, index);
            self.grow();
        }
    }

    fn start_at(&mut self, seeds: &[Seed], index: usize) {
        for way in self.ways(&seeds[index]) {
            if !way.taken {
                self.start(seeds[index].at, way.heading, way.family, index, 1.0);
            }
        }
    }

    pub(super) fn grow(&mut self) {
        // Across only when nothing is left to do beside: neighbours are
        // exactly spaced, and rows of them begun far apart do not fit.
        while self.across < self.lines.len() {
            if self.beside < self.lines.len() {
                self.sweep(self.beside, &[Side::Beside(1.0), Side::Beside(-1.0)]);
                self.beside += 1;
            } else {
                self.sweep(self.across, &[Side::Across]);
                self.across += 1;
            }
        }
    }

    /// At the seed with most room first, up to a level; of a level in the order
    /// of the seeds, so that neighbours follow each other and what they look at
    /// stays in the cache. Room only shrinks: a seed that has less than it was
    /// noted for waits at a lower level, and one pass downwards sees to all.
    fn farthest(&mut self, seeds: &[Seed]) {
        if let Some(index) = middle(seeds) {
            self.start_at(seeds, index);
        }
        let level = |room: f64| (room * LEVELS) as usize;
        let mut waiting = vec![Vec::new(); level(WIDE) + 1];
        waiting[level(WIDE)] = (0..2 * seeds.len()).collect();
        while let Some(slots) = waiting.pop() {
            for slot in slots {
                let (index, at) = (slot / 2, seeds[slot / 2].at);
                let way = self.ways(&seeds[index])[slot % 2];
                let Some(along) = unit(way.heading).filter(|_| !way.taken) else {
                    continue;
                };
                let separation = self.spacing.at(at, way.family);
                let room = self
                    .room(at, along, WIDE * separation)
                    .map_or(WIDE, |near| near / separation);
                if room < 1.0 {
                    continue;
                }
                match waiting.get_mut(level(room)) {
                    Some(lower) => lower.push(slot),
                    None => {
                        self.start(at, way.heading, way.family, index, 1.0);
                    }
                }
            }
        }
    }

    /// The two orientations at a seed, with their families as the nearest line
    /// has them, for around singularities they change places.
    fn ways(&self, seed: &Seed) -> [Way; 2] {
        let [first, second] = seed.directions;
        let separation = [0, 1].map(|family| self.spacing.at(seed.at, family));
        let reach = (
            separation[0].max(separation[1]),
            separation[0].min(separation[1]),
        );
        let near = |way: Point| self.chords.near(seed.at, unit(way)?, reach, None);
        let one = near(first);
        // Without a use for the second family one look is enough.
        let known = one.as_ref().map(|near| near.family);
        let two = if known.is_none_or(|family| self.options.families[usize::from(1 - family)]) {
            near(second)
        } else {
            None
        };
        let family = known
            .or_else(|| Some(1 - two.as_ref()?.family))
            .unwrap_or(0);
        let taken = |near: Option<Nearest>, family: u8| {
            near.is_some_and(|near| near.distance < separation[usize::from(family)])
        };
        [
            Way {
                family,
                heading: first,
                taken: taken(one, family),
            },
            Way {
                family: 1 - family,
                heading: second,
                taken: taken(two, 1 - family),
            },
        ]
    }

    /// The unit direction of the arm nearest to `heading`.
    fn arm(&mut self, at: Point, heading: Point) -> Option<Point> {
        self.field
            .direction(at, heading, &mut self.cursor)
            .and_then(unit)
    }

    /// Traces a line unless another one runs alongside within `clearance`
    /// separations; true if it was placed.
    pub(super) fn start(
        &mut self,
        at: Point,
        heading: Point,
        family: u8,
        seed: usize,
        clearance: f64,
    ) -> bool {
        if !self.options.families[usize::from(family)] {
            return false;
        }
        let Some(along) = self.arm(at, heading) else {
            return false;
        };
        let separation = self.spacing.at(at, family);
        self.room(at, along, clearance * separation).is_none()
            && self.place(at, along, family, seed, separation)
    }

    /// Distance to the nearest line alongside, if within `reach`.
    fn room(&self, at: Point, along: Point, reach: f64) -> Option<f64> {
        self.chords
            .nearest(at, along, reach)
            .map(|near| near.distance)
    }

    fn place(&mut self, at: Point, along: Point, family: u8, seed: usize, separation: f64) -> bool {
        let mark = self.chords.len();
        let name = (self.lines.len() as u32, family);
        let mut watch = Watch::new(&mut self.chords, self.spacing, self.options.test, name, at);
        let line = trace_watched(self.field, at, along, &self.trace, &mut |sign, a, b| {
            watch.step(sign, a, b)
        });
        let line = line.filter(|line| {
            watch.finish(line);
            let least = self.options.min_length * separation;
            let ends = (line.points.first(), line.points.last());
            let far = matches!(ends, (Some(&a), Some(&b)) if distance(a, b) > least);
            line.points.len() > 1 && (far || line.length() >= least)
        });
        match line {
            Some(mut line) => {
                (line.family, line.seed_index) = (family, seed);
                self.lines.push(line);
                self.laid.push(mark..self.chords.len());
                true
            }
            None => {
                self.chords.truncate(mark);
                false
            }
        }
    }

    /// Tries places along a line, on its sides in turn.
    fn sweep(&mut self, index: usize, sides: &[Side]) {
        let family = self.lines[index].family;
        let wanted = |side: &&Side| {
            let family = match side {
                Side::Beside(_) => family,
                Side::Across => 1 - family,
            };
            self.options.families[usize::from(family)]
        };
        let sides: Vec<Side> = sides.iter().filter(wanted).copied().collect();
        if sides.is_empty() {
            return;
        }
        // Nobody asks for its points meanwhile.
        let points = std::mem::take(&mut self.lines[index].points);
        let pieces = points.windows(2);
        let lengths: Vec<f64> = pieces.map(|pair| distance(pair[0], pair[1])).collect();
        let seed = self.lines[index].seed_index;
        for side in sides {
            self.sweep_side(&points, &lengths, (family, seed), side);
        }
        self.lines[index].points = points;
    }

    /// Tries places on one side of a line, each as far on as the lines near the
    /// last one demand.
    fn sweep_side(
        &mut self,
        points: &[Point],
        lengths: &[f64],
        (line_family, seed): (u8, usize),
        side: Side,
    ) {
        let (family, clearance) = match side {
            Side::Beside(_) => (line_family, CLEARANCE.max(self.options.test)),
            Side::Across => (1 - line_family, 1.0),
        };
        // Where the next place lies, from the start of the piece in question.
        let mut ahead = 0.0;
        for (pair, &length) in points.windows(2).zip(lengths) {
            while ahead <= length && length > 0.0 {
                let way = (pair[1] - pair[0]) / length;
                let on = pair[0] + way * ahead;
                let (at, heading) = match side {
                    Side::Beside(sign) => {
                        let aside = left(way) * sign;
                        let here = self.spacing.at(on, family);
                        // Halfway between the separations at the two places.
                        let there = self.spacing.at(on + aside * here, family);
                        (on + aside * (0.5 * (here + there)), way)
                    }
                    Side::Across => (on, left(way)),
                };
                ahead += self.try_at(at, heading, family, seed, clearance);
            }
            ahead -= length;
        }
    }

    /// Tries one place; how far to go on to the next.
    fn try_at(
        &mut self,
        at: Point,
        heading: Point,
        family: u8,
        seed: usize,
        clearance: f64,
    ) -> f64 {
        let separation = self.spacing.at(at, family);
        let least = ADVANCE * separation;
        let Some(along) = self.arm(at, heading) else {
            return least;
        };
        let reach = clearance * separation;
        match self.room(at, along, reach) {
            Some(room) => (reach - room).max(1e-3 * separation).max(match clearance {
                // Across, places follow each other exactly.
                c if c >= 1.0 => 0.0,
                _ => least,
            }),
            None if self.place(at, along, family, seed, separation) => reach,
            None => least,
        }
    }
}

/// The seed nearest to the middle of all.
fn middle(seeds: &[Seed]) -> Option<usize> {
    let origin = seeds.first()?.at;
    let sum = seeds
        .iter()
        .fold(Point::zero(), |sum, seed| sum + (seed.at - origin));
    let mean = origin + sum / seeds.len() as f64;
    (0..seeds.len())
        .min_by(|&i, &j| distance(seeds[i].at, mean).total_cmp(&distance(seeds[j].at, mean)))
}
