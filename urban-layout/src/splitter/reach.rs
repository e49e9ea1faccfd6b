//! Streets to land that no streamline serves: beyond a neck, behind a spur of
//! the boundary, in the far end of a pocket.
//!
//! The paper's streamlines cross a region from side to side and have parcels on
//! both sides; where the land narrows between two fields, none does, and all
//! that lies beyond would stay open. A street along the shortest way through
//! the region opens it, and its two sides are then split like any other land.

use geo_types::Coord;

use crate::layout::Lineage;
use crate::network::SideKind;
use crate::plane::{dist, length, resample};
use crate::region::{Place, Region};
use crate::segments::SegmentGrid;
use crate::splitter::{Action, Cut, CutMaker, Path2, Proposal, Scene, Service, Splitter, Ways};

/// Opens land that lies out of reach with a street that winds its way there.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReachSplitter;

/// Land out of reach that is worth a street of its own, in ideal parcels.
const WORTH: f64 = 4.0;
/// The least land that a street opens, over the land that it takes.
const GAIN: f64 = 3.0;
/// Ends tried at the boundary, and starts tried for each.
const GOALS: usize = 8;
const STARTS: usize = 3;
/// Spacing of the places tried along a side, metres.
const SPACING: f64 = 12.0;
/// Starts within this distance of one that failed are not tried again, metres.
const APART: f64 = 25.0;

impl Splitter for ReachSplitter {
    fn name(&self) -> &'static str {
        "reach"
    }

    fn propose(&self, scene: &Scene<'_>, region: &Region) -> Vec<Proposal> {
        let options = scene.options;
        let service = Service::of(region, options);
        let parcel = options.parcel_length * options.parcel_width;
        let open = |samples: usize| samples as f64 * service.cell;
        if open(service.unserved.len()) < WORTH * parcel {
            return Vec::new();
        }
        let starts = places(region, |kind, access| kind == SideKind::Street && access);
        let ends = places(region, |kind, _| kind == SideKind::Boundary);
        let reach = 1.5 * options.parcel_length + 0.5 * options.street_width;
        let goals = goals(&service, &starts, &ends, reach);
        if starts.is_empty() || goals.is_empty() {
            return Vec::new();
        }
        let Some(ways) = Ways::of(region) else {
            return Vec::new();
        };
        let maker = CutMaker::new(scene, region).yielding().without_room();
        let (rim, _) = region.grid();
        let mut proposals: Vec<Proposal> = goals
            .iter()
            .filter_map(|goal| {
                let cut = street(&ways, &maker, &starts, goal)?;
                let line = cut.points();
                let gain = open(served(&service.unserved, &line, reach));
                let taken = length(&line) * options.street_width;
                let worth = gain >= 0.5 * WORTH * parcel && gain >= GAIN * taken;
                (worth && passes(&rim, &line, options.street_width)).then(|| Proposal {
                    cost: (taken - gain) / region.area,
                    action: Action::Cut(vec![cut]),
                    lineage: Lineage::of(region, self.name()),
                    warning: None,
                })
            })
            .collect();
        proposals.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        proposals
    }
}

/// Places along the sides of a kind, evenly spaced.
fn places(region: &Region, wanted: impl Fn(SideKind, bool) -> bool) -> Vec<Place> {
    let mut all = region.places(SPACING);
    all.retain(|p| {
        let side = region.loops[p.ring].sides[p.edge];
        wanted(side.kind, side.access)
    });
    all
}

/// Ends beside land out of reach: the one farthest from all starts, then each
/// time the one farthest from those chosen.
fn goals(service: &Service, starts: &[Place], ends: &[Place], reach: f64) -> Vec<Place> {
    let beside = |p: &&Place| service.unserved.iter().any(|&q| dist(p.at, q) < reach);
    let ends: Vec<Place> = ends.iter().filter(beside).copied().collect();
    let mut away: Vec<f64> = ends
        .iter()
        .map(|p| {
            starts
                .iter()
                .map(|s| dist(s.at, p.at))
                .fold(f64::INFINITY, f64::min)
        })
        .collect();
    let mut chosen = Vec::new();
    while chosen.len() < GOALS {
        let farthest = (0..ends.len()).max_by(|&i, &j| away[i].total_cmp(&away[j]).then(j.cmp(&i)));
        let Some(next) = farthest.filter(|&i| away[i] > SPACING) else {
            break;
        };
        for (a, p) in away.iter_mut().zip(&ends) {
            *a = a.min(dist(p.at, ends[next].at));
        }
        chosen.push(ends[next]);
    }
    chosen
}

/// A street from one of the starts to the goal that can be built.
fn street(ways: &Ways, maker: &CutMaker<'_>, starts: &[Place], goal: &Place) -> Option<Cut> {
    let mut left: Vec<Place> = starts.to_vec();
    for _ in 0..STARTS {
        let from: Vec<Coord<f64>> = left.iter().map(|p| p.at).collect();
        let (i, _, points) = ways.path(&from, &[goal.at])?;
        let start = left[i];
        let path = Path2 {
            from: start,
            to: *goal,
            points,
        };
        if let Some(cut) = maker.make(&path) {
            return Some(cut);
        }
        left.retain(|p| dist(p.at, start.at) > APART);
    }
    None
}

/// How many of the samples a street brings within reach.
fn served(samples: &[Coord<f64>], line: &[Coord<f64>], reach: f64) -> usize {
    let along = resample(line, 0.5 * reach);
    let near = |p: &&Coord<f64>| along.iter().any(|&q| dist(**p, q) < reach);
    samples.iter().filter(near).count()
}

/// Whether the land is wide enough for the street all along, its ends apart;
/// at a pinch a fifth of its width may be wanting.
fn passes(rim: &SegmentGrid, line: &[Coord<f64>], width: f64) -> bool {
    let points = resample(line, 0.25 * width);
    let ends = 6.min(points.len() / 2);
    points[ends..points.len() - ends]
        .iter()
        .all(|&p| rim.nearest(p, 0.4 * width).is_none())
}
