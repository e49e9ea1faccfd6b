//! From edges of a mesh to streets that can be built: smooth lines, laid one
//! after the other on a copy of the network, each from streets or boundary to
//! streets or boundary.

use std::collections::BTreeMap;

use geo_types::Coord;
use network_opt::snake::{smooth_snakes, snakes, Snake, SnakeOptions};
use network_opt::{FaceId, VertexId};

use super::choose::Web;
use super::options::LevelPlan;
use crate::lay::{lay, KEEP_OFF};
use crate::network::{Network, StreetInfo};
use crate::plane::{angle, dist, in_ring, length, resample, turn, unit};
use crate::planner::{faults, is_exit};
use crate::region::{Place, Region};
use crate::segments::SegmentGrid;
use crate::site::RoadClass;
use crate::splitter::{smooth, Cut, CutMaker, Path2, Scene, Service};

/// The end of a street may be so far from the street that it leads to, which
/// was smoothed, over the width of new streets.
const GAP: f64 = 1.6;

/// Spacing of the points along a line, metres.
const STEP: f64 = 8.0;
/// Rounds of smoothing with which such a street is tried, one after the other.
const ROUNDS: [usize; 3] = [8, 24, 64];
/// A street is led squarely out of a junction for so many metres, and eased
/// into its own line up to so many, and so many more for each metre that its
/// end lies beside the line.
const SQUARE: f64 = 32.0;
const EASED: f64 = 64.0;
const SIDEWAYS: f64 = 2.5;
/// What a point next to the boundary counts, in degrees of a turn.
const NEAR: f64 = 10.0;

/// Streets that can be built.
#[derive(Debug)]
pub(super) struct Laid {
    /// In the order in which they are to be laid.
    pub(super) cuts: Vec<Cut>,
    /// How bad it is: see [`Draft::fault_of_all`].
    pub(super) fault: f64,
}

/// All streets of a web that can be built and lead out. Those over which
/// `busy_from` parcels or more have their way are collectors.
pub(super) fn lay_all(
    scene: &Scene<'_>,
    region: &Region,
    web: &Web,
    levels: &[LevelPlan],
    busy_from: f64,
) -> Laid {
    let nothing = Laid {
        cuts: Vec::new(),
        fault: f64::INFINITY,
    };
    let Some(mut draft) = Draft::new(scene, region, web) else {
        return nothing;
    };
    let mut cuts = Vec::new();
    while let Some(piece) = draft.next() {
        let level = web.level[piece.edges[0]].unwrap_or(0);
        let LevelPlan { class, width, .. } = levels[level];
        let busy = |&e: &usize| web.traffic[e] >= busy_from;
        let class = if piece.edges.iter().any(busy) {
            RoadClass::Collector
        } else {
            class
        };
        let laid = draft.lay(&piece, class, width);
        draft.settle(&piece, laid.is_some());
        cuts.extend(laid);
    }
    let fault = draft.fault_of_all();
    let leads_out = draft.led_out();
    let all = cuts.len();
    cuts = cuts
        .into_iter()
        .zip(leads_out)
        .filter_map(|(cut, out)| out.then_some(cut))
        .collect();
    if cuts.is_empty() {
        return nothing;
    }
    let lost = (all - cuts.len()) as f64;
    Laid {
        cuts,
        fault: fault + LOST * lost,
    }
}

/// A turn beyond this is a corner of a block, degrees.
const CORNER_DEG: f64 = 30.0;
/// What a parcel's land out of reach, a corner too many or too few, an edge
/// that is no street after all, and a street that leads nowhere count, in
/// corners as wrong as can be.
const OUT_OF_REACH: f64 = 0.2;
const ODD: f64 = 0.3;
const DROPPED: f64 = 0.3;
const LOST: f64 = 3.0;

/// A run of edges from one vertex where streets are to another.
#[derive(Clone, Debug)]
struct Piece {
    vertices: Vec<usize>,
    edges: Vec<usize>,
}

/// What has become of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    /// No street of ours.
    None,
    Waiting,
    Laid,
    Dropped,
}

struct Draft<'a> {
    scene: &'a Scene<'a>,
    region: &'a Region,
    web: &'a Web,
    /// The lines of edges, from the first end to the second.
    lines: BTreeMap<usize, Vec<Coord<f64>>>,
    snakes: Vec<Snake>,
    fates: Vec<Fate>,
    /// Vertices where a street may end: on the rim, or on a street that is laid.
    anchors: Vec<bool>,
    rim: SegmentGrid,
    network: Network,
    /// Laws of streets that the network breaks.
    faults: usize,
    faces: Vec<FaceId>,
}

impl<'a> Draft<'a> {
    fn new(scene: &'a Scene<'a>, region: &'a Region, web: &'a Web) -> Option<Self> {
        let mesh = &web.mesh;
        let options = SnakeOptions::default();
        let last = web.level.iter().flatten().max().copied()?;
        // No street runs on into one of another level.
        let found: Vec<Snake> = (0..=last)
            .flat_map(|level| {
                let own: Vec<bool> = web.level.iter().map(|&l| l == Some(level)).collect();
                snakes(mesh, &own, options.through_deg.to_radians())
            })
            .collect();
        let smooth = smooth_snakes(mesh, found, &web.given, &options).ok()?;
        let mut lines = BTreeMap::new();
        for (snake, line) in &smooth.streets {
            for (k, &e) in snake.edges.iter().enumerate() {
                let from = k * options.pieces;
                let mut part = line.0[from..=from + options.pieces].to_vec();
                if mesh.edges()[e][0] != snake.vertices[k] {
                    part.reverse();
                }
                lines.insert(e, part);
            }
        }
        let mut anchors = vec![false; mesh.points().len()];
        for (ends, rim) in mesh.edges().iter().zip(mesh.rim()) {
            ends.iter().for_each(|&v| anchors[v] |= rim);
        }
        Some(Self {
            scene,
            region,
            web,
            lines,
            snakes: smooth.streets.into_iter().map(|(snake, _)| snake).collect(),
            fates: web
                .level
                .iter()
                .map(|l| l.map_or(Fate::None, |_| Fate::Waiting))
                .collect(),
            anchors,
            rim: region.grid().0,
            network: scene.network.clone(),
            faults: faults(scene.network, scene.options),
            faces: vec![region.face],
        })
    }

    /// The next street: the longest of the highest level that leads from
    /// anchor to anchor along a snake, or, if none does, any way that does.
    fn next(&self) -> Option<Piece> {
        let along = self.snakes.iter().flat_map(|snake| self.ready(snake));
        let level = |p: &Piece| self.web.level[p.edges[0]];
        along
            .min_by(|a, b| {
                let order = level(a).cmp(&level(b));
                order.then(b.edges.len().cmp(&a.edges.len()))
            })
            .or_else(|| self.winding())
    }

    /// The pieces of a snake between anchors that wait to be laid.
    fn ready(&self, snake: &Snake) -> Vec<Piece> {
        let mut out = Vec::new();
        let mut run: Option<Piece> = None;
        for (k, &e) in snake.edges.iter().enumerate() {
            let (v, w) = (snake.vertices[k], snake.vertices[k + 1]);
            if self.fates[e] != Fate::Waiting {
                run = None;
                continue;
            }
            if self.anchors[v] {
                run = Some(Piece {
                    vertices: vec![v],
                    edges: Vec::new(),
                });
            }
            let Some(piece) = &mut run else {
                continue;
            };
            piece.edges.push(e);
            piece.vertices.push(w);
            if self.anchors[w] {
                out.extend(run.take());
            }
        }
        out
    }

    /// A way over waiting edges from an anchor to another that bends as little
    /// as may be.
    fn winding(&self) -> Option<Piece> {
        let mesh = &self.web.mesh;
        let starts = (0..self.anchors.len()).filter(|&v| self.anchors[v]);
        starts
            .flat_map(|v| {
                let around = mesh.around(v).iter();
                around.map(move |&(e, w)| (v, e, w))
            })
            .filter(|&(_, e, _)| self.fates[e] == Fate::Waiting)
            .find_map(|(v, e, w)| self.follow(v, e, w))
    }

    /// The way from anchor `v` over edge `e` that goes straightest on at each
    /// vertex, other ways tried where it ends.
    fn follow(&self, v: usize, e: usize, w: usize) -> Option<Piece> {
        let mut piece = Piece {
            vertices: vec![v, w],
            edges: vec![e],
        };
        let mut tried = vec![false; self.fates.len()];
        tried[e] = true;
        loop {
            let &[.., before, at] = piece.vertices.as_slice() else {
                return None;
            };
            if self.anchors[at] {
                return Some(piece);
            }
            let points = self.web.mesh.points();
            let ahead = unit(points[at] - points[before]);
            let next = self
                .web
                .mesh
                .around(at)
                .iter()
                .filter(|&&(f, to)| {
                    self.fates[f] == Fate::Waiting && !tried[f] && !piece.vertices.contains(&to)
                })
                .min_by(|a, b| {
                    let off = |to: usize| angle(ahead, unit(points[to] - points[at]));
                    off(a.1).total_cmp(&off(b.1))
                });
            if let Some(&(f, to)) = next {
                tried[f] = true;
                piece.edges.push(f);
                piece.vertices.push(to);
            } else {
                piece.edges.pop();
                piece.vertices.pop();
                if piece.edges.is_empty() {
                    return None;
                }
            }
        }
    }

    /// Notes what has become of a piece. Of one that cannot be built the worst
    /// stretch between two junctions is dropped, and the rest waits for other
    /// ways to streets.
    fn settle(&mut self, piece: &Piece, laid: bool) {
        if laid {
            piece.edges.iter().for_each(|&e| self.fates[e] = Fate::Laid);
            piece.vertices.iter().for_each(|&v| self.anchors[v] = true);
            return;
        }
        let worst = self
            .stretches(piece)
            .into_iter()
            .map(|stretch| (self.fault(&stretch), stretch))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, stretch)) = worst {
            stretch
                .edges
                .iter()
                .for_each(|&e| self.fates[e] = Fate::Dropped);
        }
    }

    /// A piece cut at its junctions.
    fn stretches(&self, piece: &Piece) -> Vec<Piece> {
        let open = |&&(e, _): &&(usize, usize)| matches!(self.fates[e], Fate::Waiting | Fate::Laid);
        let mut out: Vec<Piece> = Vec::new();
        for (k, &e) in piece.edges.iter().enumerate() {
            let (v, w) = (piece.vertices[k], piece.vertices[k + 1]);
            let junction = self.web.mesh.around(v).iter().filter(open).count() > 2;
            match out.last_mut().filter(|_| !junction) {
                Some(last) => {
                    last.edges.push(e);
                    last.vertices.push(w);
                }
                None => out.push(Piece {
                    vertices: vec![v, w],
                    edges: vec![e],
                }),
            }
        }
        out
    }

    /// How bad a stretch is: its sharpest turn, degrees, and its nearness to the
    /// region's boundary.
    fn fault(&self, stretch: &Piece) -> f64 {
        let points = smooth(&resample(&self.line(stretch), STEP), 3);
        let sharpest = points
            .windows(3)
            .map(|w| angle(w[1] - w[0], w[2] - w[1]))
            .fold(0.0, f64::max)
            .to_degrees();
        let width = self.scene.options.street_width;
        let near = points[1..points.len() - 1]
            .iter()
            .filter_map(|&p| self.rim.nearest(p, 2.0 * width))
            .map(|hit| 1.0 - hit.distance / (2.0 * width))
            .sum::<f64>();
        sharpest + NEAR * near
    }

    /// For each street that was laid, in order, whether it is connected to a
    /// way out of the site or to a street that was there before. All of them
    /// where nothing leads out of the region anyhow.
    fn led_out(&self) -> Vec<bool> {
        let network = &self.network;
        let before = self.scene.network.streets.len();
        let ours = |v: VertexId| {
            let streets = network.streets_at(v).into_iter();
            streets
                .filter_map(|h| Some((network.mesh.attr(h).street? as usize, network.mesh.dest(h))))
        };
        let count = network.streets.len() - before;
        let mut out = vec![false; count];
        let mut seen = vec![false; network.mesh.vertex_bound()];
        for start in network.mesh.vertices() {
            if seen[start.0 as usize] || network.streets_at(start).is_empty() {
                continue;
            }
            let (mut stack, mut members, mut leads) = (vec![start], Vec::new(), false);
            seen[start.0 as usize] = true;
            while let Some(v) = stack.pop() {
                leads |= is_exit(network, v);
                for (street, to) in ours(v) {
                    leads |= street < before;
                    members.push(street);
                    if !std::mem::replace(&mut seen[to.0 as usize], true) {
                        stack.push(to);
                    }
                }
            }
            if leads {
                for street in members.into_iter().filter(|&s| s >= before) {
                    out[street - before] = true;
                }
            }
        }
        out
    }

    /// How bad the blocks are, in wrong corners: corners by how far they are
    /// from square, blocks by how far from four corners, land out of reach, and
    /// streets that could not be built.
    fn fault_of_all(&self) -> f64 {
        let options = self.scene.options;
        let parcel = options.parcel_length * options.parcel_width;
        let mut fault = 0.0;
        for &face in &self.faces {
            let region = Region::new(&self.network, face, self.region.path.clone(), 0);
            let service = Service::of(&region, options);
            fault += OUT_OF_REACH * service.unserved.len() as f64 * service.cell / parcel;
            let mut corners = 0.0;
            for l in &region.loops {
                let n = l.points.len();
                for i in 0..n {
                    let (before, after) = (l.edge((i + n - 1) % n), l.edge(i));
                    let turn = turn(before.1 - before.0, after.1 - after.0).to_degrees();
                    if turn.abs() > CORNER_DEG {
                        corners += 1.0;
                        fault += (turn - 90.0).abs() / 90.0;
                    }
                }
            }
            fault += ODD * f64::abs(corners - 4.0);
        }
        let dropped = self
            .fates
            .iter()
            .filter(|&&f| f != Fate::None && f != Fate::Laid);
        fault + DROPPED * dropped.count() as f64
    }

    /// The line of a piece, ends included.
    fn line(&self, piece: &Piece) -> Vec<Coord<f64>> {
        let mut points: Vec<Coord<f64>> = Vec::new();
        for (k, e) in piece.edges.iter().enumerate() {
            let mut part = self.lines.get(e).cloned().unwrap_or_default();
            if self.web.mesh.edges()[*e][0] != piece.vertices[k] {
                part.reverse();
            }
            points.extend(part.into_iter().skip(usize::from(k > 0)));
        }
        points
    }

    /// Lays a piece through the copy of the network.
    fn lay(&mut self, piece: &Piece, class: RoadClass, width: f64) -> Option<Cut> {
        let points = self.line(piece);
        let middle = *points.get(points.len() / 2)?;
        let slot = self.faces.iter().position(|&f| {
            let rings = self.network.rings(f);
            rings.first().is_some_and(|ring| in_ring(ring, middle))
        })?;
        let region = Region {
            seed: self.region.seed,
            ..Region::new(&self.network, self.faces[slot], self.region.path.clone(), 0)
        };
        let options = self.scene.options;
        let n = points.len();
        let from = region.place_facing(points[0], points[1]);
        let to = region.place_facing(points[n - 1], points[n - 2]);
        let reach = GAP * options.street_width;
        if dist(from.at, points[0]) > reach || dist(to.at, points[n - 1]) > reach {
            return None;
        }
        let cut = {
            let scene = Scene {
                network: &self.network,
                ..*self.scene
            };
            let strict = CutMaker::new(&scene, &region);
            let yielding = CutMaker::new(&scene, &region).yielding();
            let made = [&strict, &yielding].into_iter().find_map(|maker| {
                let even = resample(&points, STEP);
                let square = squared(maker, &from, &to, &even);
                let mut tries = vec![even];
                tries.extend(
                    square
                        .iter()
                        .flat_map(|line| ROUNDS.iter().map(|&rounds| smooth(line, rounds))),
                );
                tries
                    .into_iter()
                    .find_map(|points| maker.make(&Path2 { from, to, points }))
            });
            made?
        };
        let cut = Cut {
            class: Some(class),
            width: Some(width),
            ..cut
        };
        let info = StreetInfo {
            class,
            width,
            given: false,
            name: None,
            lineage: None,
        };
        let clear = KEEP_OFF * options.street_width;
        let mut network = self.network.clone();
        let faces = lay(&mut network, &region, &cut, info, clear)?;
        let faults = faults(&network, options);
        if faults > self.faults {
            return None;
        }
        self.network = network;
        self.faults = faults;
        self.faces.splice(slot..=slot, faces);
        Some(cut)
    }
}

/// A line whose ends leave in the directions that they will have; `None` where
/// they may not stand.
fn squared(
    maker: &CutMaker<'_>,
    from: &Place,
    to: &Place,
    line: &[Coord<f64>],
) -> Option<Vec<Coord<f64>>> {
    let n = line.len();
    if n < 3 {
        return None;
    }
    let long = length(line);
    // The stem of an end, and how far from it the line is left.
    let stem = |place: &Place, inward: Coord<f64>| {
        let (end, dir) = maker.anchor(place, unit(inward))?;
        let eased = (EASED + SIDEWAYS * dist(end.at, place.at)).min(0.4 * long);
        let square = SQUARE.min(0.5 * eased);
        Some(([end.at, end.at + dir * square], eased))
    };
    let (first, after) = stem(from, line[2] - line[0])?;
    let (last, before) = stem(to, line[n - 3] - line[n - 1])?;
    let mut points = first.to_vec();
    let mut along = 0.0;
    for pair in line.windows(2) {
        along += dist(pair[0], pair[1]);
        if along > after && along < long - before {
            points.push(pair[1]);
        }
    }
    points.extend(last.into_iter().rev());
    Some(resample(&points, STEP))
}
