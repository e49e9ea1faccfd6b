//! Global optimisation of the network (paper section 6), kept within the laws
//! of streets: junctions apart, meeting squarely, no kinks.

use std::collections::BTreeSet;

use geo_types::Coord;
use network_opt::{
    collapse_short_edges, optimize, roads, Block, FaceId, Freedom, HalfEdgeId, OptimizeOptions,
    StripFit, VertexId,
};

use crate::error::{Error, Result};
use crate::network::{Network, SideKind};
use crate::options::PlanOptions;
use crate::plane::{angle, dist, lerp, turn, unit};
use crate::planner::seed::Path;
use crate::planner::Tree;
use crate::progress::{Progress, Stage};

/// Turn at which a block's outline has a corner, degrees.
const CORNER_DEG: f64 = 45.0;
/// A road goes through a crossing if it turns by less, degrees.
const THROUGH_DEG: f64 = 35.0;
/// Edges of new streets shorter than this share of the street's width are
/// collapsed before the optimisation.
const SHORT: f64 = 0.3;
/// The closeness weight is raised by this factor while the result breaks a law
/// of streets, so many times at the most.
const STIFFER: f64 = 6.0;
const TRIES: usize = 3;
/// Least angle between streets at a junction, degrees, with a margin over the
/// law's 60.
const LEAST_ANGLE_DEG: f64 = 62.0;
/// A street's direction at a junction is that of its first metres, as the
/// certificate has it.
const DIRECTION_LENGTH: f64 = 10.0;
/// Most turn at a vertex inside a street, degrees.
const MOST_KINK_DEG: f64 = 24.0;

/// Optimises the streets below `root`; all others stay where they are. Keeps
/// the network as it was if no result keeps the laws.
pub(crate) fn improve(
    tree: &mut Tree,
    root: &Path,
    options: &PlanOptions,
    progress: &mut dyn Progress,
) -> Result<()> {
    let whole = root.steps().is_empty();
    let faces: BTreeSet<FaceId> = tree.within(root).map(|leaf| leaf.face).collect();
    if whole {
        let network = &tree.network;
        let pinned: BTreeSet<VertexId> = network
            .mesh
            .vertices()
            .filter(|&v| {
                freedom(network, &faces, v) != Freedom::Free || network.streets_at(v).len() != 2
            })
            .collect();
        collapse_short_edges(&mut tree.network.mesh, SHORT * options.street_width, &|v| {
            pinned.contains(&v)
        });
    }
    // Ends that are near each other across a notch of the boundary stay put.
    let mouths: Vec<VertexId> = tree.network.mouths().collect();
    let held: BTreeSet<VertexId> = mouths
        .iter()
        .copied()
        .filter(|&v| {
            let at = tree.network.mesh.point(v);
            mouths.iter().any(|&w| {
                w != v && dist(tree.network.mesh.point(w), at) < 4.0 * options.street_width
            })
        })
        .collect();
    let before = tree.network.mesh.clone();
    let faults = faults(&tree.network, options);
    let mut settings = OptimizeOptions {
        clearance: 1.75 * options.street_width,
        ..OptimizeOptions::default()
    };
    for attempt in 0..TRIES {
        let network = &tree.network;
        let free: Vec<Freedom> = (0..network.mesh.vertex_bound())
            .map(|i| VertexId(u32::try_from(i).unwrap_or(u32::MAX)))
            .map(|v| {
                if network.mesh.has_vertex(v) && !held.contains(&v) {
                    freedom(network, &faces, v)
                } else {
                    Freedom::Fixed
                }
            })
            .collect();
        let blocks: Vec<Block> = tree
            .leaves
            .values()
            .filter(|l| faces.contains(&l.face))
            .map(|l| Block {
                face: l.face,
                corners: corners(tree, l.face),
            })
            .collect();
        let roads: Vec<Vec<VertexId>> = roads(
            &network.mesh,
            |side| side.kind == SideKind::Street,
            THROUGH_DEG,
        )
        .into_iter()
        .filter(|road| road.iter().any(|&v| free[v.0 as usize] == Freedom::Free))
        .collect();
        let mut cancelled = false;
        let mut hook = |fraction: f64| {
            cancelled =
                !progress.report(Stage::Optimize, (attempt as f64 + fraction) / TRIES as f64);
            !cancelled
        };
        let done = optimize(
            &mut tree.network.mesh,
            &blocks,
            &roads,
            &|v| free[v.0 as usize],
            &StripFit::new(),
            &settings,
            &mut hook,
        );
        if cancelled {
            return Err(Error::cancelled());
        }
        if done.is_ok() && self::faults(&tree.network, options) <= faults {
            return Ok(());
        }
        tree.network.mesh = before.clone();
        settings.closeness *= STIFFER;
    }
    Ok(())
}

/// How a vertex may move: the site's own do not, streets' do, and where a new
/// street meets what is fixed it slides.
fn freedom(network: &Network, faces: &BTreeSet<FaceId>, v: VertexId) -> Freedom {
    let mesh = &network.mesh;
    let fixed = mesh
        .outgoing(v)
        .filter(|&h| {
            mesh.attr(h).kind != SideKind::Street
                || network.street_of(h).is_some_and(|s| s.given)
                || !both(network, faces, h)
        })
        .count();
    let edges = mesh.degree(v);
    let at = mesh.point(v);
    let led_out = network.restricted_exits && network.zones.covers(at);
    if fixed == 0 {
        Freedom::Free
    } else if fixed == 2 && edges == 3 && !led_out {
        Freedom::Slide
    } else {
        Freedom::Fixed
    }
}

/// Whether an edge lies between two faces that may both change.
fn both(network: &Network, faces: &BTreeSet<FaceId>, h: network_opt::HalfEdgeId) -> bool {
    faces.contains(&network.mesh.face(h))
        && faces.contains(&network.mesh.face(network.mesh.twin(h)))
}

/// The four corners of a block, if it has four.
fn corners(tree: &Tree, face: FaceId) -> Option<[VertexId; 4]> {
    let region = crate::region::Region::new(&tree.network, face, Path::everything(), 0);
    let [l] = region.loops.as_slice() else {
        return None;
    };
    let n = l.points.len();
    let found: Vec<VertexId> = (0..n)
        .filter(|&i| {
            let (a, b, c) = (
                l.points[(i + n - 1) % n],
                l.points[i],
                l.points[(i + 1) % n],
            );
            turn(b - a, c - b) > CORNER_DEG.to_radians()
        })
        .map(|i| l.vertices[i])
        .collect();
    found.try_into().ok()
}

/// How many of a network's streets break a law: too sharp a meeting, too close
/// a pair of junctions, a kink.
pub(crate) fn faults(network: &Network, options: &PlanOptions) -> usize {
    let mesh = &network.mesh;
    let mut count = 0;
    for v in mesh.vertices() {
        let streets = network.streets_at(v);
        let ours = streets
            .iter()
            .any(|&h| network.street_of(h).is_some_and(|s| !s.given));
        if !ours {
            continue;
        }
        let dirs: Vec<_> = streets
            .iter()
            .map(|&h| unit(mesh.point(mesh.dest(h)) - mesh.point(v)))
            .collect();
        if let [a, b] = dirs.as_slice() {
            count += usize::from(turn(*a * -1.0, *b).abs() > MOST_KINK_DEG.to_radians());
            continue;
        }
        let leaving: Vec<_> = streets.iter().map(|&h| leaving(network, h)).collect();
        for (i, &a) in leaving.iter().enumerate() {
            count += leaving[i + 1..]
                .iter()
                .filter(|&&b| angle(a, b) < LEAST_ANGLE_DEG.to_radians())
                .count();
        }
        // The next junction along each street.
        for &h in &streets {
            let (mut at, mut walked) = (h, mesh.length(h));
            while network.streets_at(mesh.dest(at)).len() == 2 && walked < options.street_width {
                let end = mesh.dest(at);
                let Some(on) = network
                    .streets_at(end)
                    .into_iter()
                    .find(|&o| o != mesh.twin(at))
                else {
                    break;
                };
                at = on;
                walked += mesh.length(on);
            }
            let crow = dist(mesh.point(v), mesh.point(mesh.dest(at)));
            count += usize::from(
                network.streets_at(mesh.dest(at)).len() > 2 && crow < 1.2 * options.street_width,
            );
        }
    }
    count
}

/// Unit direction in which the street of half-edge `h` leaves its origin.
fn leaving(network: &Network, h: HalfEdgeId) -> Coord<f64> {
    let mesh = &network.mesh;
    let start = mesh.point(mesh.origin(h));
    let (mut at, mut left) = (h, DIRECTION_LENGTH);
    loop {
        let (long, end) = (mesh.length(at), mesh.dest(at));
        if long >= left {
            let tip = lerp(mesh.point(mesh.origin(at)), mesh.point(end), left / long);
            return unit(tip - start);
        }
        left -= long;
        let on = match network.streets_at(end).as_slice() {
            [a, b] if *a == mesh.twin(at) => *b,
            [a, b] if *b == mesh.twin(at) => *a,
            _ => return unit(mesh.point(end) - start),
        };
        at = on;
    }
}
