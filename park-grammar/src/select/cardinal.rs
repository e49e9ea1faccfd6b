//! `WEST`, `NORTH`, `EAST`, `SOUTH`: the four sides that every region has.
//!
//! The notes want a cardinal selection of every polygon with four edges or more,
//! and list ways that fail: by the edges' angles for concave regions, by sectors
//! where sides differ much in length. Decided: `WEST` alone goes from corner to
//! corner. The corners are the vertices nearest to those of the region's box,
//! sides measured by the box's width and height. Vertices that are equally near
//! share: the side changes half way between the first and the last of them, so
//! that what is symmetric is cut symmetrically (an edge at 45 degrees, in its
//! middle). Where one vertex is nearest to two corners, as in a triangle, the
//! diagonals of the box cut instead. All four together are the outer boundary,
//! each is a single line, and none is empty unless the diagonals cut.
//!
//! The other ways are `Cardinal(WEST, Angle)`, `Cardinal(WEST, Sector)`,
//! `Cardinal(WEST, Grow)` and `Cardinal(WEST, Dominant)`. The last gives every
//! edge to the direction that it faces, edges at 45 degrees to west or east; with
//! `Northern` to north or south; with `Split` half to each neighbour. Directions
//! are the region's own; with `Compass` the compass's.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use geo_types::Coord;

use super::frame::{apart, outward, Frame};
use super::sector::{pieces, positive};
use super::{angle, grow, perimeter, sector, Selection, Stretch};
use crate::plane::{cross, dist, unit};
use crate::shape::Region;

/// Distances this near are the same, as a share.
const SAME: f64 = 1e-6;

/// A direction of the compass, with the number of its side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cardinal {
    West,
    North,
    East,
    South,
}

/// How a cardinal direction selects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Corners,
    Angle,
    Sector,
    Grow,
    Dominant(Ties),
}

/// Who has the edges at 45 degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ties {
    Western,
    Northern,
    Split,
}

impl Cardinal {
    pub(crate) const ALL: [Self; 4] = [Self::West, Self::North, Self::East, Self::South];

    pub(crate) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "WEST" => Self::West,
            "NORTH" => Self::North,
            "EAST" => Self::East,
            "SOUTH" => Self::South,
            _ => return None,
        })
    }

    /// Its angle, radians from east.
    pub(crate) fn angle(self) -> f64 {
        match self {
            Self::West => PI,
            Self::North => FRAC_PI_2,
            Self::East => 0.0,
            Self::South => -FRAC_PI_2,
        }
    }

    pub(super) fn side(self) -> usize {
        self as usize
    }

    pub(super) fn select(self, region: &Region, frame: Frame, way: Way) -> Selection {
        let middle = self.angle();
        let quarter = [middle - FRAC_PI_4, middle + FRAC_PI_4];
        match way {
            Way::Corners => corners(region, frame, self),
            Way::Angle => outer(region, angle::facing(region, frame, quarter)),
            Way::Sector => {
                let centre = region.area.centroid();
                outer(region, sector::between(region, frame, centre, quarter))
            }
            Way::Grow => {
                let directions = Self::ALL.map(Self::angle);
                let mut groups =
                    grow::grow(region, frame, &directions, FRAC_PI_4, grow::Rest::Grow);
                groups.swap_remove(self.side())
            }
            Way::Dominant(ties) => dominant(region, frame, self, ties),
        }
    }
}

/// The part on the outer ring.
fn outer(region: &Region, selection: Selection) -> Selection {
    let whole = perimeter(region, 0);
    let ring = Selection::new(vec![Stretch {
        ring: 0,
        from: 0.0,
        to: whole,
    }]);
    selection.and(&ring)
}

/// The edges that face one direction more than any other.
fn dominant(region: &Region, frame: Frame, cardinal: Cardinal, ties: Ties) -> Selection {
    let western = matches!(cardinal, Cardinal::West | Cardinal::East);
    let n = region.area.outer.len();
    let mut stretches = Vec::new();
    let mut along = 0.0;
    for (k, (a, b, _)) in region.edges(0).enumerate() {
        let step = dist(a, b);
        let off = apart(frame.angle(outward(a, b)), cardinal.angle());
        let tie = (off - FRAC_PI_4).abs() < SAME;
        let whole = match ties {
            Ties::Western => western,
            Ties::Northern => !western,
            Ties::Split => false,
        };
        let mut take = |from: f64, to: f64| stretches.push(Stretch { ring: 0, from, to });
        if tie && ties == Ties::Split {
            // The half that is nearer to the neighbour which faces this way more.
            let at = |k: usize| region.area.outer[k % n];
            let faces = |p, q| apart(frame.angle(outward(p, q)), cardinal.angle());
            let before = faces(at(k + n - 1), a);
            let after = faces(b, at(k + 2));
            let half = along + 0.5 * step;
            // Alike on both sides: the direction comes first if turning on from
            // it clockwise leads to the other.
            let first = if (before - after).abs() > SAME {
                before < after
            } else {
                let towards = frame.direction(cardinal.angle());
                cross(towards, outward(a, b)) < 0.0
            };
            if first {
                take(along, half);
            } else {
                take(half, along + step);
            }
        } else if (tie && whole) || (!tie && off < FRAC_PI_4) {
            take(along, along + step);
        }
        along += step;
    }
    Selection::new(stretches)
}

/// From corner to corner.
fn corners(region: &Region, frame: Frame, cardinal: Cardinal) -> Selection {
    let ring: Vec<Coord<f64>> = region
        .area
        .outer
        .iter()
        .map(|&p| frame.coordinates(p))
        .collect();
    let (low, high) = crate::plane::extent(&ring);
    let (width, height) = (high.x - low.x, high.y - low.y);
    if width <= 0.0 || height <= 0.0 {
        return Selection::default();
    }
    let whole = perimeter(region, 0);
    // South-west, north-west, north-east, south-east of the box.
    let wanted = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)];
    let cuts = wanted.map(|(x, y)| {
        let away = |p: &Coord<f64>| ((p.x - low.x) / width - x).hypot((p.y - low.y) / height - y);
        cut(region, &ring, away, whole)
    });
    // Clockwise where the frame is not mirrored.
    let step = |k: usize| {
        let (from, to) = (cuts[k], cuts[(k + 1) % 4]);
        let (from, to) = if frame.mirrored {
            (to, from)
        } else {
            (from, to)
        };
        (to - from).rem_euclid(whole)
    };
    let tiny = SAME * whole;
    let steps = [0, 1, 2, 3].map(step);
    let round: f64 = steps.iter().sum();
    if steps.iter().any(|&s| s <= tiny) || (round - whole).abs() > tiny {
        return diagonals(region, frame, cardinal, low, high);
    }
    let k = cardinal.side();
    let from = if frame.mirrored {
        cuts[(k + 1) % 4]
    } else {
        cuts[k]
    };
    let to = if frame.mirrored {
        cuts[k]
    } else {
        cuts[(k + 1) % 4]
    };
    let piece = |from: f64, to: f64| Stretch { ring: 0, from, to };
    if to < from {
        Selection::new(vec![piece(from, whole), piece(0.0, to)])
    } else {
        Selection::new(vec![piece(from, to)])
    }
}

/// Where on the ring its side changes, by arc length: at the vertex that is least
/// away, or half way along those that are equally so.
fn cut(region: &Region, ring: &[Coord<f64>], away: impl Fn(&Coord<f64>) -> f64, whole: f64) -> f64 {
    let far: Vec<f64> = ring.iter().map(away).collect();
    let least = far.iter().copied().fold(f64::INFINITY, f64::min);
    let mut at = Vec::new();
    let mut along = 0.0;
    for (k, (a, b, _)) in region.edges(0).enumerate() {
        if far[k] <= least + SAME {
            at.push(along);
        }
        along += dist(a, b);
    }
    if let [only] = at[..] {
        return only;
    }
    // The shortest way that takes in all of them leaves out the widest gap.
    let gap = |k: usize| {
        let next = if k + 1 < at.len() {
            at[k + 1]
        } else {
            at[0] + whole
        };
        next - at[k]
    };
    let widest = (0..at.len()).max_by(|&a, &b| gap(a).total_cmp(&gap(b)));
    let Some(k) = widest else {
        return 0.0;
    };
    let from = at[(k + 1) % at.len()];
    (from + 0.5 * (whole - gap(k))).rem_euclid(whole)
}

/// By the diagonals of the box.
fn diagonals(
    region: &Region,
    frame: Frame,
    cardinal: Cardinal,
    low: Coord<f64>,
    high: Coord<f64>,
) -> Selection {
    let middle = crate::plane::lerp(low, high, 0.5);
    let (width, height) = (high.x - low.x, high.y - low.y);
    let found = pieces(region, |a, b| {
        let place = |p| {
            let c = frame.coordinates(p) - middle;
            Coord {
                x: c.x / width,
                y: c.y / height,
            }
        };
        let (a, b) = (place(a), place(b));
        let towards = |p: Coord<f64>| match cardinal {
            Cardinal::West => [-p.x - p.y, -p.x + p.y],
            Cardinal::North => [p.y - p.x, p.y + p.x],
            Cardinal::East => [p.x - p.y, p.x + p.y],
            Cardinal::South => [-p.y - p.x, -p.y + p.x],
        };
        let (a, b) = (towards(a), towards(b));
        let (first, second) = (positive(a[0], b[0]), positive(a[1], b[1]));
        [first[0].max(second[0]), first[1].min(second[1])]
    });
    outer(region, found)
}

/// The direction of the compass that a vector is nearest to.
pub(super) fn nearest(v: Coord<f64>) -> Cardinal {
    let angle = Frame::COMPASS.angle(unit(v));
    let mut best = Cardinal::West;
    for cardinal in Cardinal::ALL {
        if apart(angle, cardinal.angle()) < apart(angle, best.angle()) {
            best = cardinal;
        }
    }
    best
}
