//! Streamline-based splitting (paper section 5): a cross field over the
//! region, candidate streamlines, their scores, and streets along the best.

use crossfield::{
    BoundaryField, DistanceField, Domain, DomainOptions, Field, FieldDesign, HarmonicField,
};
use geo_types::Coord;
use streamline::{
    candidates, rank, BoundaryDistance, BoundaryOptions, CandidateOptions, Continuity, Divergence,
    Score, Seed, SingularityDistance, Stop, Streamline, TraceOptions, WidthTable,
};

use crate::adapt::Arms;
use crate::assemble::polygon_of;
use crate::inset::{clean_ring, difference};
use crate::layout::Lineage;
use crate::network::{Network, SideKind};
use crate::options::{FieldKind, PlanOptions};
use crate::plane::{at, cross, dist, left, signed_area, unit};
use crate::region::{Place, Region};
use crate::splitter::rows::RowFit;
use crate::splitter::{Action, Cut, CutMaker, Path2, Proposal, Scene, Service, Splitter};

/// Splits a region along one or several streamlines of a cross field.
#[derive(Clone, Copy, Debug, Default)]
pub struct StreamlineSplitter;

/// Proposals offered to the planner for one region.
const OFFERED: usize = 6;
/// Streets made ready, from which those that go together are picked.
const MADE: usize = 16;
/// How much less several streets at once cost than the best of them alone.
const TOGETHER: f64 = 0.05;
/// Largest misfit of the rows between two streets laid at once (0 to 1).
const PARALLEL_MISFIT: f64 = 0.03;
/// Candidates tried before a region counts as one that no street fits.
const TRIED: usize = 400;
/// Half the width of the gap opened along a street inside a region, metres.
const GAP: f64 = 0.25;
/// Longest boundary distance that the width table knows, metres.
const TABLE_REACH: f64 = 400.0;

impl Splitter for StreamlineSplitter {
    fn name(&self) -> &'static str {
        "streamline"
    }

    fn propose(&self, scene: &Scene<'_>, region: &Region) -> Vec<Proposal> {
        let service = Service::of(region, scene.options);
        if !service.wants_street(region) && !service.too_long {
            return Vec::new();
        }
        let Some(field) = field_of(region, scene.options.field) else {
            return Vec::new();
        };
        propose_from(scene, region, &service, &field)
    }
}

/// A region's mesh, `None` where it cannot be meshed.
pub(crate) fn mesh_of(region: &Region, edge_length: f64) -> Option<Domain> {
    mesh(&open_rings(region)?, edge_length)
}

fn mesh(rings: &[Vec<Coord<f64>>], edge_length: f64) -> Option<Domain> {
    Domain::new(
        &polygon_of(rings),
        &DomainOptions {
            edge_length,
            ..DomainOptions::default()
        },
    )
    .ok()
}

/// The cross field of a region, `None` where the region cannot be meshed.
pub(crate) fn field_of(region: &Region, kind: FieldKind) -> Option<Field> {
    let edge_length = (region.area.sqrt() / 28.0).clamp(5.0, 25.0);
    let rings = open_rings(region)?;
    let domain = mesh(&rings, edge_length)?;
    let distance = || {
        DistanceField {
            weights: weights(&rings),
            ..DistanceField::default()
        }
        .design(&domain)
        .ok()
    };
    match kind {
        FieldKind::Distance => distance(),
        FieldKind::Boundary => BoundaryField::default().design(&domain).ok(),
        // A triangle has no H-field, and a boundary of very many pieces is not
        // worth one.
        FieldKind::Harmonic => HARMONIC.design(&domain).ok().or_else(distance),
    }
}

/// H-fields of regions, which are many and small: the best of a few starts.
const HARMONIC: HarmonicField = HarmonicField {
    starts: 3,
    entries: 1,
    max_pieces: 80,
    ..HarmonicField::DEFAULT
};

/// The region's rings, with the streets that end in the open or lead to a hole
/// (whose two sides are both the region's) opened to a narrow gap: a mesh needs
/// simple rings.
pub(crate) fn open_rings(region: &Region) -> Option<Vec<Vec<Coord<f64>>>> {
    if !region.has_slits() {
        return Some(region.loops.iter().map(|l| l.points.clone()).collect());
    }
    let mut gaps = Vec::new();
    for l in &region.loops {
        for (i, _) in l.slits.iter().enumerate().filter(|(_, &slit)| slit) {
            let (a, b) = l.edge(i);
            let (along, across) = (unit(b - a) * GAP, left(unit(b - a)) * GAP);
            gaps.push(
                [
                    a - along - across,
                    b + along - across,
                    b + along + across,
                    a - along + across,
                ]
                .map(|p| [p.x, p.y])
                .to_vec(),
            );
        }
    }
    let subject: Vec<Vec<[f64; 2]>> = region
        .loops
        .iter()
        .map(|l| l.points.iter().map(|p| [p.x, p.y]).collect())
        .collect();
    let shapes = difference(&[subject], &gaps);
    let rings_of = |shape: &Vec<Vec<[f64; 2]>>| -> Vec<Vec<Coord<f64>>> {
        shape
            .iter()
            .map(|r| clean_ring(&r.iter().map(|p| at(p[0], p[1])).collect::<Vec<_>>()))
            .filter(|r| r.len() >= 3)
            .collect()
    };
    shapes.iter().map(rings_of).max_by(|a, b| {
        let area = |rings: &Vec<Vec<Coord<f64>>>| rings.iter().map(|r| signed_area(r)).sum::<f64>();
        area(a).total_cmp(&area(b))
    })
}

/// Influence of each edge on the D-field: a long smooth side decides about
/// more land than a jog of the boundary (the supplement's weights, section
/// 4.1, which it leaves to the user).
fn weights(rings: &[Vec<Coord<f64>>]) -> Vec<Vec<f64>> {
    let edge = |ring: &[Coord<f64>], i: usize| (ring[i], ring[(i + 1) % ring.len()]);
    rings
        .iter()
        .map(|ring| {
            let n = ring.len();
            let corner: Vec<bool> = (0..n)
                .map(|i| {
                    let (a, b) = edge(ring, (i + n - 1) % n);
                    crate::plane::turn(b - a, edge(ring, i).1 - b).abs() > 30f64.to_radians()
                })
                .collect();
            let mut out = vec![1.0; n];
            let start = corner.iter().position(|&c| c).unwrap_or(0);
            let mut k = 0;
            while k < n {
                let mut run = vec![(start + k) % n];
                k += 1;
                while k < n && !corner[(start + k) % n] {
                    run.push((start + k) % n);
                    k += 1;
                }
                let length: f64 = run
                    .iter()
                    .map(|&i| dist(edge(ring, i).0, edge(ring, i).1))
                    .sum();
                for i in run {
                    out[i] = (length / 90.0).sqrt().clamp(0.35, 1.0);
                }
            }
            out
        })
        .collect()
}

fn propose_from(
    scene: &Scene<'_>,
    region: &Region,
    service: &Service,
    field: &Field,
) -> Vec<Proposal> {
    let options = scene.options;
    let arms = Arms(field);
    let lines = trace_candidates(scene.network, region, options, field, &arms);
    if lines.is_empty() {
        return Vec::new();
    }
    let paths: Vec<Option<Path2>> = lines.iter().map(|line| to_path(region, line)).collect();
    let measures = Measures::new(scene, region, service, field, &lines, &paths);
    let w = &options.weights;
    let (grid, sides) = region.grid();
    let rows = RowFit::new(&grid, &sides, options);
    let scores: Vec<(&dyn Score, f64)> = vec![
        (&measures.divergence, w.divergence),
        if options.row_fit {
            (&rows, w.boundary)
        } else {
            (&measures.boundary, w.boundary)
        },
        (&measures.singularities, w.singularities),
        (&measures.continuity, w.continuity),
    ];
    let ranked = rank(&lines, &arms, &scores);
    // The planner's own terms, on top of the paper's four.
    let mut order: Vec<(f64, usize, [f64; 4])> = ranked
        .iter()
        .filter(|r| {
            paths[r.index]
                .as_ref()
                .is_some_and(|p| isolation(region, p, options).is_finite())
        })
        .map(|r| {
            let parts = [r.parts[0], r.parts[1], r.parts[2], r.parts[3]];
            let alone = paths[r.index]
                .as_ref()
                .map_or(0.0, |p| isolation(region, p, options));
            let own = w.balance * measures.balance[r.index] + w.service * measures.service[r.index];
            (r.total + own + alone, r.index, parts)
        })
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let pick = |maker: &CutMaker<'_>| {
        let mut made: Vec<Made> = Vec::new();
        for &(cost, index, parts) in order.iter().take(TRIED) {
            let Some(cut) = paths[index].as_ref().and_then(|path| maker.make(path)) else {
                continue;
            };
            if made.iter().all(|other| !alike(&cut, &other.cut)) {
                let family = lines[index].family;
                made.push(Made {
                    cost,
                    cut,
                    parts,
                    family,
                });
            }
            if made.len() >= MADE {
                break;
            }
        }
        made
    };
    let mut made = pick(&CutMaker::new(scene, region));
    if made.is_empty() {
        made = pick(&CutMaker::new(scene, region).yielding());
    }
    let lineage = |parts| Lineage {
        split: region.path.to_string(),
        by: "streamline".to_owned(),
        field: Some(options.field.as_str().to_owned()),
        scores: Some(parts),
        energy: None,
        seed: region.seed,
    };
    let proposal = |cost: f64, cuts: Vec<Cut>, parts| Proposal {
        cost,
        action: Action::Cut(cuts),
        lineage: lineage(parts),
        warning: None,
    };
    let mut out: Vec<Proposal> = Vec::new();
    if !service.too_long {
        // As long as a block: what is left to choose is where its neighbours
        // run, all at once.
        let together = companions(&made, &rows, options);
        if let ([first, ..], 2..) = (made.as_slice(), together.len()) {
            out.push(proposal(first.cost - TOGETHER, together, first.parts));
        }
    }
    out.extend(
        made.into_iter()
            .take(OFFERED)
            .map(|m| proposal(m.cost, vec![m.cut], m.parts)),
    );
    out
}

/// A street that can be built, with what is known of its streamline.
struct Made {
    cost: f64,
    cut: Cut,
    parts: [f64; 4],
    family: u8,
}

/// The best street, and those beside it that run along it at distances that
/// rows of parcels fill.
fn companions(made: &[Made], rows: &RowFit<'_>, options: &PlanOptions) -> Vec<Cut> {
    let Some(first) = made.first() else {
        return Vec::new();
    };
    let mut chosen = vec![first.cut.clone()];
    for other in made[1..].iter().filter(|m| m.family == first.family) {
        let fits = |cut: &Cut| {
            let line = cut.points();
            let gaps: Vec<f64> = crate::plane::resample(&other.cut.points(), 20.0)
                .into_iter()
                .map(|p| distance_to(&line, p))
                .collect();
            let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
            let most = gaps.iter().copied().fold(0.0, f64::max);
            let mean = gaps.iter().sum::<f64>() / gaps.len().max(1) as f64;
            most < 1.3 * least && rows.at_width(mean - options.street_width) < PARALLEL_MISFIT
        };
        if chosen.iter().all(fits) {
            chosen.push(other.cut.clone());
        }
    }
    chosen
}

/// Distance of a point from a polyline.
fn distance_to(line: &[Coord<f64>], p: Coord<f64>) -> f64 {
    line.windows(2)
        .map(|w| dist(crate::plane::nearest_on(w[0], w[1], p).0, p))
        .fold(f64::INFINITY, f64::min)
}

/// Candidate streamlines from all inner vertices in both orientations.
fn trace_candidates(
    network: &Network,
    region: &Region,
    options: &PlanOptions,
    field: &Field,
    arms: &Arms<'_>,
) -> Vec<Streamline> {
    let domain = field.domain();
    let vertices = domain.vertices();
    let seeds: Vec<Seed> = domain
        .inner_vertices()
        .filter_map(|v| {
            let mut cursor = crossfield::Cursor::default();
            let cross = field.cross(vertices[v], &mut cursor)?;
            let arms = cross.arms();
            Some(Seed {
                at: vertices[v],
                directions: [arms[0], arms[1]],
            })
        })
        .collect();
    // The paper's d_eps; coarser on large regions, where a street may lie
    // anywhere within a block's depth.
    let separation = (0.3 * options.parcel_length).max(region.area.sqrt() / 70.0);
    let trace = TraceOptions {
        step: 8.0,
        max_length: 4.0 * region.perimeter(),
        ..TraceOptions::default()
    };
    let mut lines: Vec<Streamline> = invitations(network, region)
        .into_iter()
        .filter_map(|(at, inward)| streamline::trace(arms, at + inward * 2.0, inward, &trace).ok())
        .collect();
    let options = CandidateOptions {
        separation,
        seed: region.seed,
        trace,
        ..CandidateOptions::default()
    };
    lines.extend(candidates(arms, &seeds, &options).unwrap_or_default());
    lines
}

/// Where a street waits to be continued into the region, and its direction:
/// T-junctions across a street, and mouths of streets outside.
fn invitations(network: &Network, region: &Region) -> Vec<(Coord<f64>, Coord<f64>)> {
    let junctions = region.loops.iter().flat_map(|l| {
        l.nodes
            .iter()
            .filter_map(|n| n.continues.map(|d| (n.at, d)))
    });
    let mouths = network.entries.iter().filter(|e| {
        region
            .loops
            .iter()
            .any(|l| dist(l.nearest(e.at).2, e.at) < 0.01)
    });
    junctions.chain(mouths.map(|e| (e.at, e.inward))).collect()
}

/// A streamline that ends at the boundary on both sides, as a path.
fn to_path(region: &Region, line: &Streamline) -> Option<Path2> {
    let n = line.points.len();
    if n < 2 {
        return None;
    }
    let slits = region.has_slits();
    let place = |stop: Stop, at: Coord<f64>, towards: Coord<f64>| match stop {
        // Where a gap was opened, the mesh's edges are not the region's.
        Stop::Boundary { .. } if slits => Some(region.place_facing(at, towards)),
        Stop::Boundary { ring, edge } => Some(Place { ring, edge, at }),
        _ => None,
    };
    let from = place(line.start, line.points[0], line.points[1])?;
    let to = place(line.end, line.points[n - 1], line.points[n - 2])?;
    let mut points = line.points.clone();
    points[0] = from.at;
    points[n - 1] = to.at;
    Some(Path2 { from, to, points })
}

/// Everything that ranks a region's candidates.
struct Measures {
    divergence: Divergence,
    boundary: BoundaryDistance,
    singularities: SingularityDistance,
    continuity: Continuity,
    /// 0 where both sides are equally large, 1 where one is nothing.
    balance: Vec<f64>,
    /// 0 for the candidate that brings most land within reach of a street.
    service: Vec<f64>,
}

impl Measures {
    fn new(
        scene: &Scene<'_>,
        region: &Region,
        service: &Service,
        field: &Field,
        lines: &[Streamline],
        paths: &[Option<Path2>],
    ) -> Self {
        let options = scene.options;
        let half = 0.5 * options.street_width;
        // Between two streets fit 60 + 75 k metres (parcels back to back); up
        // to a boundary without one, 30 + 75 k. The latter counts as a street
        // one row beyond the boundary.
        let segments: Vec<(Coord<f64>, Coord<f64>, f64)> = region
            .edges()
            .map(|(a, b, side)| {
                let beyond = if side.access {
                    0.0
                } else {
                    options.parcel_length
                };
                (a, b, half + side.inset - beyond)
            })
            .collect();
        let row = 2.0 * options.parcel_length;
        let widths: Vec<f64> = (0..8)
            .map(|k| row + f64::from(k) * (row + options.street_width))
            .collect();
        let table = WidthTable::new(&widths[..], TABLE_REACH, 0.5);
        let network = scene.network;
        let ends = region
            .loops
            .iter()
            .flat_map(|l| {
                l.nodes
                    .iter()
                    .filter_map(|n| n.continues.map(|d| (n.at, d * -1.0)))
            })
            .chain(network.entries.iter().map(|e| (e.at, e.inward * -1.0)))
            .collect();
        let balance = paths
            .iter()
            .map(|p| p.as_ref().map_or(1.0, |p| imbalance(region, p)))
            .collect();
        Self {
            divergence: Divergence::default(),
            boundary: BoundaryDistance::new(&segments, table, BoundaryOptions::default()),
            singularities: SingularityDistance {
                singularities: field.singularities().iter().map(|s| s.at).collect(),
            },
            continuity: Continuity {
                ends,
                ..Continuity::default()
            },
            balance,
            service: unserved_left(service, lines, options),
        }
    }
}

/// Share of the larger side beyond an even split, 0 to 1.
pub(crate) fn imbalance(region: &Region, path: &Path2) -> f64 {
    if path.from.ring != path.to.ring {
        return 0.4;
    }
    let l = &region.loops[path.from.ring];
    let n = l.points.len();
    // Area to the left of the path: the path, then the loop from its end back
    // to its start.
    let origin = path.from.at;
    let mut twice = 0.0;
    let mut previous = path.from.at;
    let mut add = |p: Coord<f64>| {
        twice += cross(previous - origin, p - origin);
        previous = p;
    };
    path.points.iter().for_each(|&p| add(p));
    let mut i = (path.to.edge + 1) % n;
    let mut guard = 0;
    let same_edge_ahead = path.to.edge == path.from.edge
        && dist(l.points[path.to.edge], path.to.at) < dist(l.points[path.from.edge], path.from.at);
    if !same_edge_ahead {
        loop {
            add(l.points[i]);
            if i == path.from.edge || guard > n {
                break;
            }
            i = (i + 1) % n;
            guard += 1;
        }
    }
    let share = (0.5 * twice / region.area).clamp(0.0, 1.0);
    (2.0 * share - 1.0).abs()
}

/// For each line the land it leaves out of reach, 0 for the best of them and
/// 1 where it helps no more than no line at all.
fn unserved_left(service: &Service, lines: &[Streamline], options: &PlanOptions) -> Vec<f64> {
    let reach = 1.5 * options.parcel_length + 0.5 * options.street_width;
    let size = reach;
    let cell = |p: Coord<f64>| ((p.x / size).floor() as i64, (p.y / size).floor() as i64);
    let mut grid: std::collections::BTreeMap<(i64, i64), Vec<usize>> =
        std::collections::BTreeMap::new();
    for (i, &p) in service.unserved.iter().enumerate() {
        grid.entry(cell(p)).or_default().push(i);
    }
    let mut mark = vec![usize::MAX; service.unserved.len()];
    let gains: Vec<f64> = lines
        .iter()
        .enumerate()
        .map(|(k, line)| {
            let mut gain = 0usize;
            for p in crate::plane::resample(&line.points, 0.5 * reach) {
                let (cx, cy) = cell(p);
                for c in (-1..=1).flat_map(|x| (-1..=1).map(move |y| (cx + x, cy + y))) {
                    for &i in grid.get(&c).map_or(&[][..], |v| v) {
                        if mark[i] != k && dist(service.unserved[i], p) < reach {
                            mark[i] = k;
                            gain += 1;
                        }
                    }
                }
            }
            gain as f64
        })
        .collect();
    let most = gains.iter().copied().fold(0.0, f64::max);
    gains
        .iter()
        .map(|g| if most > 0.0 { 1.0 - g / most } else { 0.0 })
        .collect()
}

/// Whether two cuts are nearly the same street.
fn alike(a: &Cut, b: &Cut) -> bool {
    let near = |p: Coord<f64>, q: Coord<f64>| dist(p, q) < 12.0;
    (near(a.from.at, b.from.at) && near(a.to.at, b.to.at))
        || (near(a.from.at, b.to.at) && near(a.to.at, b.from.at))
}

/// What it costs that a street would touch no other: once there are streets,
/// a new one should be reached from them.
fn isolation(region: &Region, path: &Path2, options: &PlanOptions) -> f64 {
    let joined = on_street(region, &path.from) || on_street(region, &path.to);
    let first = !region
        .edges()
        .any(|(_, _, side)| side.kind == SideKind::Street);
    if joined || first {
        0.0
    } else if region.area > 4.0 * options.block_length * options.block_length {
        0.5
    } else {
        f64::INFINITY
    }
}

/// Whether a place lies on a street.
fn on_street(region: &Region, place: &Place) -> bool {
    region.loops[place.ring].sides[place.edge].kind == SideKind::Street
}
