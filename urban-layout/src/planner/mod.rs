//! The planner: hierarchical splitting as a search over splitters (paper
//! section 3). It knows no splitter by name; it asks them in order of
//! preference and takes the first proposal that the network can still take.

use std::collections::BTreeMap;

use network_opt::FaceId;

use crate::error::{Error, Result};
use crate::lay::{lay, KEEP_OFF};
use crate::layout::Lineage;
use crate::network::{Network, StreetInfo};
use crate::options::PlanOptions;
use crate::progress::{Progress, Stage};
use crate::region::Region;
use crate::site::{RoadClass, Site};
use crate::splitter::{Action, Cut, Fill, Proposal, Scene, Splitter};

mod backtrack;
mod connect;
mod improve;
pub(crate) mod parallel;
mod reroll;
pub mod seed;

pub(crate) use backtrack::backtrack;
pub(crate) use connect::{is_connected, is_exit};
pub(crate) use improve::{faults, improve};
pub(crate) use reroll::clear;
use seed::{mix, Path};

/// A region that is split no further, and what fills it.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// Its place in the split tree.
    pub path: Path,
    /// Its face of the network.
    pub face: FaceId,
    /// What fills the land inside its streets.
    pub fill: Fill,
    /// Why.
    pub lineage: Lineage,
}

/// The state of a search: the network and the leaves of the split tree.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The street network.
    pub network: Network,
    /// The leaves by path.
    pub leaves: BTreeMap<Path, Leaf>,
    /// Seeds that replace the user's below a path (re-rolled regions).
    pub rerolled: BTreeMap<Path, u64>,
    /// What the user should know of how regions were split, by path.
    pub warnings: BTreeMap<Path, String>,
}

/// Splits deeper than this are not tried: no site needs them.
const MAX_DEPTH: usize = 48;
/// How often a region may find its proposals overtaken by its neighbours'
/// streets before it is asked alone.
const MAX_DEFERRALS: usize = 3;

/// A region that waits to be split.
#[derive(Clone, Debug)]
pub(crate) struct Pending {
    pub(crate) face: FaceId,
    pub(crate) path: Path,
    deferred: usize,
}

impl Pending {
    pub(crate) fn new(face: FaceId, path: Path) -> Self {
        Self {
            face,
            path,
            deferred: 0,
        }
    }
}

impl Tree {
    /// The leaves at a path and below it.
    pub(crate) fn within<'t>(&'t self, root: &'t Path) -> impl Iterator<Item = &'t Leaf> {
        self.leaves
            .values()
            .filter(|leaf| leaf.path.is_within(root))
    }

    /// The tree of a site before any split, and its root regions.
    pub(crate) fn new(site: &Site) -> Result<(Self, Vec<Pending>)> {
        let network = Network::new(site)?;
        let roots = network
            .mesh
            .faces()
            .filter(|&f| network.content(site, f) == Some(None))
            .enumerate()
            .map(|(i, f)| Pending::new(f, Path::root(i)))
            .collect();
        Ok((
            Self {
                network,
                leaves: BTreeMap::new(),
                rerolled: BTreeMap::new(),
                warnings: BTreeMap::new(),
            },
            roots,
        ))
    }

    /// The seed in force at a path.
    pub(crate) fn seed_at(&self, path: &Path, seed: u64) -> u64 {
        self.rerolled
            .iter()
            .filter(|(root, _)| path.is_within(root))
            .max_by_key(|(root, _)| root.depth())
            .map_or(seed, |(_, &s)| s)
    }

    /// The view of a face at a path.
    pub(crate) fn region(&self, face: FaceId, path: &Path, seed: u64) -> Region {
        Region::new(&self.network, face, path.clone(), self.seed_at(path, seed))
    }
}

/// Splits `pending` and everything below, level by level. Regions of a level
/// are asked side by side, against the network as the level found it, and
/// their proposals are taken one after the other: the outcome is the same on
/// any number of threads.
pub(crate) fn split(
    tree: &mut Tree,
    mut pending: Vec<Pending>,
    splitters: &[Box<dyn Splitter>],
    options: &PlanOptions,
    progress: &mut dyn Progress,
) -> Result<()> {
    let whole: f64 = pending
        .iter()
        .map(|p| tree.network.mesh.area(p.face))
        .sum::<f64>()
        .max(1e-9);
    while !pending.is_empty() {
        let open: f64 = pending.iter().map(|p| tree.network.mesh.area(p.face)).sum();
        if !progress.report(Stage::Split, 1.0 - open / whole) {
            return Err(Error::cancelled());
        }
        let asked = parallel::map(&pending, options.threads, |p| {
            let region = tree.region(p.face, &p.path, options.seed);
            ask(&tree.network, &region, splitters, options)
        });
        let mut next = Vec::new();
        for (p, proposals) in pending.into_iter().zip(asked) {
            // Asked again alone if its neighbours keep overtaking it.
            let proposals = if p.deferred >= MAX_DEFERRALS {
                ask(
                    &tree.network,
                    &tree.region(p.face, &p.path, options.seed),
                    splitters,
                    options,
                )
            } else {
                proposals
            };
            commit(tree, p, proposals, options, &mut next);
        }
        pending = next;
    }
    Ok(())
}

/// The proposals of the first splitter that has any.
fn ask(
    network: &Network,
    region: &Region,
    splitters: &[Box<dyn Splitter>],
    options: &PlanOptions,
) -> Vec<Proposal> {
    let scene = Scene {
        network,
        options,
        draft: true,
    };
    splitters
        .iter()
        .map(|s| s.propose(&scene, region))
        .find(|proposals| {
            let cuts = proposals.iter().any(|p| matches!(p.action, Action::Cut(_)));
            !proposals.is_empty() && (!cuts || region.path.depth() < MAX_DEPTH)
        })
        .unwrap_or_default()
}

/// Takes one of a region's proposals, chosen at random by quality.
fn commit(
    tree: &mut Tree,
    p: Pending,
    mut proposals: Vec<Proposal>,
    options: &PlanOptions,
    next: &mut Vec<Pending>,
) {
    let seed = p.path.hash(tree.seed_at(&p.path, options.seed));
    let had_cuts = proposals.iter().any(|q| matches!(q.action, Action::Cut(_)));
    let mut turn = 0;
    while !proposals.is_empty() {
        let chosen = choose(
            &proposals,
            options.temperature,
            mix(seed.wrapping_add(turn)),
        );
        turn += 1;
        let Proposal {
            action,
            lineage,
            warning,
            ..
        } = proposals.remove(chosen);
        match action {
            Action::Fill(fill) => {
                tree.leaves.insert(
                    p.path.clone(),
                    Leaf {
                        path: p.path,
                        face: p.face,
                        fill,
                        lineage,
                    },
                );
                return;
            }
            Action::Cut(cuts) => {
                if let Some(children) = apply(tree, &p, &cuts, &lineage, options, KEEP_OFF) {
                    tree.warnings
                        .extend(warning.map(|text| (p.path.clone(), text)));
                    next.extend(children);
                    return;
                }
            }
        }
    }
    if had_cuts && p.deferred <= MAX_DEFERRALS {
        next.push(Pending {
            deferred: p.deferred + 1,
            ..p
        });
    } else {
        let lineage = Lineage {
            split: p.path.to_string(),
            by: "none".to_owned(),
            seed,
            ..Lineage::default()
        };
        tree.leaves.insert(
            p.path.clone(),
            Leaf {
                path: p.path,
                face: p.face,
                fill: Fill::default(),
                lineage,
            },
        );
    }
}

/// Index of a proposal, drawn with weights that fall with its cost over the best.
fn choose(proposals: &[Proposal], temperature: f64, random: u64) -> usize {
    let best = proposals
        .iter()
        .map(|p| p.cost)
        .fold(f64::INFINITY, f64::min);
    let weight = |p: &Proposal| {
        if temperature > 0.0 {
            (-(p.cost - best) / temperature).exp()
        } else {
            f64::from(u8::from(p.cost <= best))
        }
    };
    let total: f64 = proposals.iter().map(weight).sum();
    let mut left = (random >> 11) as f64 / (1u64 << 53) as f64 * total;
    for (i, p) in proposals.iter().enumerate() {
        left -= weight(p);
        if left <= 0.0 {
            return i;
        }
    }
    0
}

/// Lays the cuts through a region, if the network still has room for them.
/// Returns the regions that arise.
pub(crate) fn apply(
    tree: &mut Tree,
    p: &Pending,
    cuts: &[Cut],
    lineage: &Lineage,
    options: &PlanOptions,
    keep_off: f64,
) -> Option<Vec<Pending>> {
    let mut parts = vec![p.face];
    let mut laid = 0;
    for cut in cuts {
        let middle = cut
            .path
            .get(cut.path.len() / 2)
            .copied()
            .unwrap_or((cut.from.at + cut.to.at) * 0.5);
        let Some(slot) = parts.iter().position(|&f| {
            tree.network
                .rings(f)
                .first()
                .is_some_and(|ring| crate::plane::in_ring(ring, middle))
        }) else {
            continue;
        };
        let region = tree.region(parts[slot], &p.path, options.seed);
        let class = cut.class.unwrap_or_else(|| {
            if cuts.len() == 1 && p.path.depth() < 2 && region.area > 250_000.0 {
                RoadClass::Collector
            } else {
                RoadClass::Local
            }
        });
        let info = StreetInfo {
            class,
            width: cut.width.unwrap_or(options.street_width),
            given: false,
            name: None,
            lineage: Some(lineage.clone()),
        };
        let clear = keep_off * options.street_width;
        let Some(faces) = lay(&mut tree.network, &region, cut, info, clear) else {
            continue;
        };
        laid += 1;
        parts.splice(slot..=slot, faces);
    }
    if laid == 0 {
        return None;
    }
    Some(
        parts
            .into_iter()
            .enumerate()
            .map(|(i, f)| Pending::new(f, p.path.child(i)))
            .collect(),
    )
}

/// Joins what is not yet joined: see [`connect`].
pub(crate) fn connect(tree: &mut Tree, site: &Site, options: &PlanOptions) -> Vec<Pending> {
    connect::connect(tree, site, options)
}
