//! Cells drawn in for the paths, smoothed, with a shape in the middle.

use geo_types::Coord;

use super::cells::{Beside, Cell};
use crate::derive::Spot;
use crate::plane::{difference, dist, erode, intersection, lerp, nearest_on, pole, sides, Area};
use crate::rule::sites::{fits, part_at, shape_at};
use crate::rule::smoothing::Smoother;
use crate::rule::{runs, Primitive};
use crate::shape::{Heritage, Region, Role};

/// Edges this near to the boundary, as a share of the region's size, are on it.
const ON: f64 = 1e-7;

/// How much of a circle's radius stays free where it has just room.
const ROOM: f64 = 0.98;

/// What is to become of cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// Half the width of a path.
    pub(super) half: f64,
    /// Width of the path along the boundary.
    pub(super) around: f64,
    /// Square metres of the smallest region; smaller ones are path.
    pub(super) least: f64,
    pub(super) smoother: Option<Smoother>,
    /// Size of the region.
    pub(super) size: f64,
}

/// What stands in the middle of cells.
#[derive(Clone, Copy, Debug)]
pub(super) enum Content {
    Nothing,
    Shape(Primitive),
    /// A circle with the room that the place has.
    Room,
}

/// What lies across an edge: the region's own boundary first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Label {
    /// A side of the region that was divided; of a hole without a number.
    Boundary(Option<usize>),
    Cell(usize),
}

/// The edges of a cell, each with what lies across.
pub(super) struct Walls {
    edges: Vec<(Coord<f64>, Coord<f64>, Label)>,
}

impl Walls {
    pub(super) fn new(cell: &Cell, heritage: &Heritage<'_>) -> Self {
        let rings = cell.area.rings().zip(&cell.beside);
        let edges = rings.flat_map(|(ring, beside)| sides(ring).zip(beside));
        let label = |((a, b), beside): ((Coord<f64>, Coord<f64>), &Beside)| {
            let label = match beside {
                Beside::Cell(other) => Label::Cell(*other),
                Beside::Boundary => {
                    Label::Boundary(heritage.source(a, b).and_then(|edge| edge.side))
                }
            };
            (a, b, label)
        };
        Self {
            edges: edges.map(label).collect(),
        }
    }

    /// What lies across an edge of something inside, and how far.
    pub(super) fn across(&self, a: Coord<f64>, b: Coord<f64>) -> (Label, f64) {
        let middle = lerp(a, b, 0.5);
        let mut best = (Label::Boundary(None), f64::INFINITY);
        for &(p, q, label) in &self.edges {
            let away = dist(nearest_on(p, q, middle), middle);
            if away < best.1 {
                best = (label, away);
            }
        }
        best
    }
}

impl Plan {
    /// What is left of a cell.
    pub(super) fn lawns(&self, cell: &Cell, walls: &Walls) -> Vec<Area> {
        let width = |beside: &Beside| match beside {
            Beside::Cell(_) => self.half,
            Beside::Boundary => self.around,
        };
        let widths: Vec<Vec<f64>> = cell
            .beside
            .iter()
            .map(|ring| ring.iter().map(width).collect())
            .collect();
        let mut found = erode(&cell.area, &widths);
        if let Some(smoother) = self.smoother {
            found = found
                .iter()
                .flat_map(|area| self.smoothed(area, walls, smoother))
                .collect();
        }
        found.retain(|area| area.size() > self.least);
        found
    }

    /// Smoothed inside itself; what lies on the region's boundary stays.
    fn smoothed(&self, area: &Area, walls: &Walls, smoother: Smoother) -> Vec<Area> {
        let ring = |ring: &Vec<Coord<f64>>| {
            let fixed: Vec<bool> = sides(ring)
                .map(|(a, b)| {
                    let (label, away) = walls.across(a, b);
                    matches!(label, Label::Boundary(_)) && away <= ON * self.size
                })
                .collect();
            let n = fixed.len();
            let pinned: Vec<bool> = (0..n).map(|k| fixed[k] || fixed[(k + n - 1) % n]).collect();
            smoother.ring(ring, &pinned)
        };
        let outer = ring(&area.outer);
        if outer.len() < 3 {
            return Vec::new();
        }
        let holes = area.holes.iter().map(ring).filter(|hole| hole.len() > 2);
        let smoothed = Area::new(outer, holes.collect());
        intersection(&[smoothed], std::slice::from_ref(area))
    }

    /// The shape in the middle of one of the lawns of a cell, if it has room: at
    /// its site, else where the lawn has most room.
    pub(super) fn centre(
        &self,
        lawn: &Area,
        spot: Spot,
        content: Content,
        heritage: &Region,
    ) -> Option<Area> {
        let inside = |at: Coord<f64>| lawn.contains(at).then(|| lawn.nearest(at).1);
        let places = [spot.at, pole(lawn)];
        match content {
            Content::Nothing => None,
            Content::Shape(shape) => places
                .into_iter()
                .map(|at| shape_at(shape, at, &heritage.local))
                .find(|area| fits(area, lawn)),
            Content::Room => {
                let (at, room) = places
                    .into_iter()
                    .filter_map(|at| inside(at).map(|room| (at, ROOM * room)))
                    // The site's own place unless it has hardly any room.
                    .find(|(_, room)| *room >= 0.5 * spot.radius)
                    .or_else(|| inside(places[1]).map(|room| (places[1], ROOM * room)))?;
                let radius = room.min(spot.radius);
                (radius > 0.0).then(|| shape_at(Primitive::Circle(radius), at, &heritage.local))
            }
        }
    }
}

/// Cuts centres out of the lawns that hold them.
pub(super) fn without(lawns: Vec<Area>, centre: Option<&Area>) -> Vec<Area> {
    match centre {
        Some(centre) => difference(&lawns, std::slice::from_ref(centre)),
        None => lawns,
    }
}

/// The lawn on which the middle of a cell lies, out of all of them.
pub(super) fn middle_of(lawns: &[Area], at: Coord<f64>) -> Option<Area> {
    part_at(lawns.to_vec(), at)
}

/// A lawn as a region: its sides are runs of edges beside one neighbour or one
/// side of the divided region, counted from the longest one on the boundary, or
/// the longest of all.
pub(super) fn region(
    heritage: &Heritage<'_>,
    parent: &Region,
    area: Area,
    walls: &Walls,
    centre: Option<&Area>,
    paths: bool,
) -> Region {
    let on = ON * crate::rule::sites::size(parent);
    let role = |a: Coord<f64>, b: Coord<f64>| {
        let middle = lerp(a, b, 0.5);
        Some(if centre.is_some_and(|c| c.nearest(middle).1 < on) {
            Role::Centre
        } else if paths {
            Role::Path
        } else {
            Role::Seam
        })
    };
    let local = parent.local;
    let mut region = heritage.piece(area, local, role);
    let labels: Vec<Label> = sides(region.ring(0))
        .map(|(a, b)| walls.across(a, b).0)
        .collect();
    let found = runs::runs(&region, &labels);
    let outer = runs::longest(&found, |label| matches!(label, Label::Boundary(_)));
    let start = outer
        .or_else(|| runs::longest(&found, |_| true))
        .unwrap_or(0);
    if let Some(run) = found.get(start) {
        region.local = runs::local_beside(&region, run, parent.local.mirrored());
        runs::number(&mut region, &found, start, 0);
    }
    for ring in region.edges.iter_mut().skip(1) {
        ring.iter_mut().for_each(|edge| edge.side = None);
    }
    region
}
