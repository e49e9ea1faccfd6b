//! Backtracking (paper section 3): where the finished splits leave the streets
//! in more than one network with no link between them, or much land that no
//! street reaches, the region that is to blame is split anew under another seed.

use std::collections::BTreeMap;

use crate::error::Result;
use crate::options::PlanOptions;
use crate::planner::connect::Components;
use crate::planner::seed::{mix, Path};
use crate::planner::{clear, connect, split, Tree};
use crate::progress::Progress;
use crate::site::Site;
use crate::splitter::{Service, Splitter};

/// Regions split anew before what there is must do.
const MOST: usize = 12;
/// Seeds tried at one region before the region around it is tried.
const SEEDS_EACH: usize = 3;
/// Regions tried, each around the last, before a fault counts as incurable.
const LEVELS: usize = 3;
/// Land of one block out of reach that is worth backtracking, in ideal parcels.
const OPEN: f64 = 20.0;

/// Splits regions anew until each part of the site has one network that leads
/// out and no block has much land out of reach, or nothing helps. An attempt
/// counts only if it leaves fewer faults than before, networks first: the tree
/// never gets worse.
pub(crate) fn backtrack(
    tree: &mut Tree,
    site: &Site,
    splitters: &[Box<dyn Splitter>],
    options: &PlanOptions,
    progress: &mut dyn Progress,
) -> Result<()> {
    let mut faults = Faults::of(tree, site, options);
    let mut tried: BTreeMap<Path, usize> = BTreeMap::new();
    for attempt in 0..MOST {
        let curable = |path: &&Path| tried.get(*path).is_none_or(|&n| n < LEVELS * SEEDS_EACH);
        let Some(fault) = faults.regions.iter().find(curable).cloned() else {
            break;
        };
        let times = tried.entry(fault.clone()).or_insert(0);
        let root = (0..*times / SEEDS_EACH).try_fold(fault, |path, _| path.parent());
        *times += 1;
        let Some(root) = root else {
            continue;
        };
        let mut trial = tree.clone();
        // A region that given roads divide is no single face: the one around it.
        let Ok(pending) = clear(&mut trial, &root) else {
            continue;
        };
        let seed = mix(tree.seed_at(&root, options.seed) ^ mix(attempt as u64 + 1));
        trial.rerolled.retain(|path, _| !path.is_within(&root));
        trial.rerolled.insert(root, seed);
        split(&mut trial, vec![pending], splitters, options, progress)?;
        let more = connect(&mut trial, site, options);
        split(&mut trial, more, splitters, options, progress)?;
        let left = Faults::of(&trial, site, options);
        if left.count() < faults.count() {
            (*tree, faults) = (trial, left);
        }
    }
    Ok(())
}

/// What is wrong with a tree.
struct Faults {
    /// Networks that should not be.
    networks: usize,
    /// The regions to blame, for networks and then for land out of reach.
    regions: Vec<Path>,
}

impl Faults {
    fn of(tree: &Tree, site: &Site, options: &PlanOptions) -> Self {
        let components = Components::of(&tree.network, site);
        let apart = surplus(&components);
        let parting = apart
            .iter()
            .filter_map(|&c| parting_region(tree, &components, c));
        Self {
            networks: apart.len(),
            regions: parting.chain(open_regions(tree, options)).collect(),
        }
    }

    fn count(&self) -> (usize, usize) {
        (self.networks, self.regions.len())
    }
}

/// The networks that should not be: in each part of the site all but the
/// largest, and those that lead nowhere.
fn surplus(components: &Components) -> Vec<usize> {
    let size = components.sizes();
    (0..size.len())
        .filter(|&c| {
            let larger = (0..size.len())
                .any(|d| components.part[d] == components.part[c] && (size[d], c) > (size[c], d));
            larger || !components.out[c]
        })
        .collect()
}

/// The smallest region that holds all regions along the network `apart`.
fn parting_region(tree: &Tree, components: &Components, apart: usize) -> Option<Path> {
    let along = |leaf: &&crate::planner::Leaf| {
        let mesh = &tree.network.mesh;
        let mut rim = mesh.loops(leaf.face).into_iter().flat_map(|l| mesh.walk(l));
        rim.any(|h| components.of.get(&mesh.origin(h)) == Some(&apart))
    };
    tree.leaves
        .values()
        .filter(along)
        .map(|leaf| leaf.path.clone())
        .reduce(|common, path| common.common(&path))
}

/// The regions around blocks with much land out of reach.
fn open_regions(tree: &Tree, options: &PlanOptions) -> Vec<Path> {
    let least = OPEN * options.parcel_length * options.parcel_width;
    tree.leaves
        .values()
        .filter(|leaf| tree.network.mesh.area(leaf.face) > least)
        .filter(|leaf| {
            let region = tree.region(leaf.face, &leaf.path, options.seed);
            let service = Service::of(&region, options);
            region.has_access() && service.unserved.len() as f64 * service.cell > least
        })
        .filter_map(|leaf| leaf.path.parent())
        .collect()
}
