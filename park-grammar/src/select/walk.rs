//! The order in which a selection is walked: what parameters along it mean.
//!
//! A selection is walked clockwise from the region's corner 0, in a mirrored
//! region counter-clockwise, so that one parameter is the same place in all
//! mirror images. A line that runs over corner 0 stays whole, and comes where it
//! begins. Holes follow the outer ring, each from its vertex nearest to the
//! local origin.

use geo_types::Coord;

use super::{part, perimeter, Selection, Stretch, LEAST};
use crate::plane::{dist, lerp, nearest_on, right, unit};
use crate::shape::Region;

/// A selected line, as far as it goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    /// By arc length; the end may lie beyond the ring's first vertex.
    stretch: Stretch,
    /// Length of the ring.
    whole: f64,
    /// Whether it is walked counter-clockwise.
    back: bool,
}

/// All lines of a selection in their order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lines(pub(crate) Vec<Line>);

/// A place on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stop {
    pub(crate) at: Coord<f64>,
    /// Unit vector into the land.
    pub(crate) inward: Coord<f64>,
}

impl Line {
    /// Metres.
    pub(crate) fn length(&self) -> f64 {
        self.stretch.to - self.stretch.from
    }

    /// Whether it is a whole ring.
    pub(crate) fn closed(&self) -> bool {
        self.length() >= self.whole * (1.0 - LEAST)
    }

    /// Its vertices, in the order of the walk.
    pub(crate) fn points(&self, region: &Region) -> Vec<Coord<f64>> {
        let mut line = part(region, self.stretch, self.whole);
        if self.back {
            line.reverse();
        }
        line
    }

    /// What lies between two distances from its beginning.
    fn between(&self, from: f64, to: f64) -> Vec<Stretch> {
        let Stretch {
            ring,
            from: a,
            to: b,
        } = self.stretch;
        let (from, to) = (from.max(0.0), to.min(self.length()));
        let (low, high) = if self.back {
            (b - to, b - from)
        } else {
            (a + from, a + to)
        };
        let whole = self.whole;
        let piece = |from: f64, to: f64| Stretch { ring, from, to };
        if low >= whole {
            vec![piece(low - whole, high - whole)]
        } else if high > whole {
            vec![piece(low, whole), piece(0.0, high - whole)]
        } else {
            vec![piece(low, high)]
        }
    }

    /// The place so many metres from its beginning.
    fn at(&self, region: &Region, along: f64) -> Stop {
        let Stretch { ring, from, to } = self.stretch;
        let along = along.clamp(0.0, self.length());
        let mut rest = if self.back { to - along } else { from + along };
        if rest > self.whole {
            rest -= self.whole;
        }
        let mut stop = Stop {
            at: Coord::default(),
            inward: Coord::default(),
        };
        for (a, b, _) in region.edges(ring) {
            let step = dist(a, b);
            if step > 0.0 {
                stop = Stop {
                    at: lerp(a, b, (rest / step).min(1.0)),
                    inward: right(unit(b - a)),
                };
                if rest <= step {
                    break;
                }
            }
            rest -= step;
        }
        stop
    }
}

impl Lines {
    pub(crate) fn new(selection: &Selection, region: &Region) -> Self {
        let back = region.local.mirrored();
        let mut lines = Vec::new();
        for ring in 0..region.rings() {
            let whole = perimeter(region, ring);
            let start = start(region, ring);
            let mut here: Vec<Line> = selection
                .runs(ring, whole)
                .into_iter()
                .map(|stretch| {
                    let mut line = Line {
                        stretch,
                        whole,
                        back,
                    };
                    if line.closed() {
                        line.stretch = Stretch {
                            ring,
                            from: start,
                            to: start + whole,
                        };
                    }
                    line
                })
                .collect();
            let order = |line: &Line| {
                let s = line.stretch;
                let from = if back { start - s.to } else { s.from - start };
                let u = from.rem_euclid(whole);
                if whole - u < LEAST * whole {
                    0.0
                } else {
                    u
                }
            };
            here.sort_by(|a, b| order(a).total_cmp(&order(b)));
            lines.extend(here);
        }
        Self(lines)
    }

    /// Metres.
    pub(crate) fn length(&self) -> f64 {
        self.0.iter().map(Line::length).sum()
    }

    /// What lies between two distances from the beginning of the first line, the
    /// lines put one behind the other.
    pub(crate) fn between(&self, from: f64, to: f64) -> Selection {
        let mut stretches = Vec::new();
        let mut before = 0.0;
        for line in &self.0 {
            if from < before + line.length() && to > before {
                stretches.extend(line.between(from - before, to - before));
            }
            before += line.length();
        }
        Selection::new(stretches)
    }

    /// How far along the point of the lines is that lies nearest to `p`.
    pub(crate) fn nearest(&self, region: &Region, p: Coord<f64>) -> f64 {
        let (mut best, mut found, mut along) = (f64::INFINITY, 0.0, 0.0);
        for line in &self.0 {
            for pair in line.points(region).windows(2) {
                let at = nearest_on(pair[0], pair[1], p);
                let away = dist(at, p);
                if away < best {
                    (best, found) = (away, along + dist(pair[0], at));
                }
                along += dist(pair[0], pair[1]);
            }
        }
        found
    }

    /// The place so many metres from the beginning of the first line.
    pub(crate) fn at(&self, region: &Region, along: f64) -> Option<Stop> {
        let mut rest = along.max(0.0);
        let last = self.0.last()?;
        for line in &self.0 {
            if rest <= line.length() {
                return Some(line.at(region, rest));
            }
            rest -= line.length();
        }
        Some(last.at(region, last.length()))
    }
}

impl Selection {
    /// The stretches of a ring, with what ends where the ring begins joined to
    /// what begins there.
    pub(super) fn runs(&self, ring: usize, whole: f64) -> Vec<Stretch> {
        let of_ring = self.stretches.iter().filter(|s| s.ring == ring);
        let mut here: Vec<Stretch> = of_ring.copied().collect();
        if let (Some(first), Some(last)) = (here.first().copied(), here.last().copied()) {
            let tiny = LEAST * whole;
            if here.len() > 1 && first.from <= tiny && last.to >= whole - tiny {
                here.remove(0);
                if let Some(last) = here.last_mut() {
                    last.to += first.to;
                }
            }
        }
        here
    }
}

/// Where the walk of a ring begins, by arc length.
fn start(region: &Region, ring: usize) -> f64 {
    let [origin, ..] = region.local.corners;
    // Of several lines that are side 0 the one that begins nearest to the origin.
    let mirrored = region.local.mirrored();
    let sides = if ring == 0 {
        region.logical()
    } else {
        Vec::new()
    };
    let corners = sides
        .iter()
        .filter(|side| side.index == 0)
        .filter_map(|side| {
            let end = if mirrored {
                side.line.last()
            } else {
                side.line.first()
            };
            end.copied()
        });
    let near = corners
        .min_by(|&a, &b| dist(a, origin).total_cmp(&dist(b, origin)))
        .unwrap_or(origin);
    let (mut best, mut found, mut along) = (f64::INFINITY, 0.0, 0.0);
    for (a, b, _) in region.edges(ring) {
        let away = dist(a, near);
        if away < best {
            (best, found) = (away, along);
        }
        along += dist(a, b);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Area;
    use crate::select::named;
    use geo_types::coord;

    /// 4 wide, 2 high, its ring begun in the middle of the north.
    fn rectangle() -> Region {
        let ring = [(2., 2.), (4., 2.), (4., 0.), (0., 0.), (0., 2.)];
        let ring = ring.map(|(x, y)| coord! { x: x, y: y }).to_vec();
        let mut region = Region::bare(Area::new(ring, Vec::new()));
        crate::index::by_local(&mut region);
        region
    }

    #[test]
    fn a_whole_ring_begins_at_corner_0() {
        let mut region = rectangle();
        let lines = Lines::new(&Selection::all(&region), &region);
        assert!(lines.0.len() == 1 && lines.0[0].closed());
        assert_eq!(
            lines.at(&region, 1.0).map(|s| s.at),
            Some(coord! { x: 0., y: 1. })
        );
        assert_eq!(
            lines.at(&region, 5.0).map(|s| s.at),
            Some(coord! { x: 3., y: 2. })
        );
        assert_eq!(
            lines.at(&region, 5.0).map(|s| s.inward),
            Some(coord! { x: 0., y: -1. })
        );
        // The mirror image has the mirrored places.
        region.local = region.local.flipped(true, false);
        crate::index::by_local(&mut region);
        let lines = Lines::new(&Selection::all(&region), &region);
        assert_eq!(
            lines.at(&region, 1.0).map(|s| s.at),
            Some(coord! { x: 4., y: 1. })
        );
        assert_eq!(
            lines.at(&region, 5.0).map(|s| s.at),
            Some(coord! { x: 1., y: 2. })
        );
    }

    #[test]
    fn lines_over_the_first_vertex_stay_whole() {
        let region = rectangle();
        let north = named::sides(&region, &[1]);
        assert_eq!(north.stretches().len(), 2);
        let lines = Lines::new(&north, &region);
        assert_eq!(lines.0.len(), 1);
        let points = lines.0[0].points(&region);
        assert_eq!(
            points,
            [(0., 2.), (2., 2.), (4., 2.)].map(|(x, y)| coord! { x: x, y: y })
        );
        let middle = lines.between(1.0, 3.0);
        assert!((middle.length() - 2.0).abs() < 1e-12);
        assert_eq!(middle.stretches().len(), 2);
    }
}
