//! Backtracking (paper section 3): where the finished splits leave the streets
//! in more than one network, and no link can be laid between them, the region
//! that parted them is split anew under another seed.

use crate::error::Result;
use crate::network::Network;
use crate::options::PlanOptions;
use crate::planner::connect::Components;
use crate::planner::seed::{mix, Path};
use crate::planner::{clear, connect, split, Tree};
use crate::progress::Progress;
use crate::site::Site;
use crate::splitter::Splitter;

/// Regions split anew before what there is must do.
const MOST: usize = 12;
/// Seeds tried at one region before the region around it is tried.
const SEEDS_EACH: usize = 3;

/// Splits regions anew until each part of the site has one network that leads
/// out, or [`MOST`] attempts have passed. An attempt counts only if it leaves
/// fewer networks apart than before; the tree never gets worse.
pub(crate) fn backtrack(
    tree: &mut Tree,
    site: &Site,
    splitters: &[Box<dyn Splitter>],
    options: &PlanOptions,
    progress: &mut dyn Progress,
) -> Result<()> {
    let mut components = Components::of(&tree.network, site);
    let mut failed = 0;
    for attempt in 0..MOST {
        let surplus = surplus(&components);
        let Some(&apart) = surplus.first() else {
            break;
        };
        let Some(root) = parting_region(tree, &components, apart, failed / SEEDS_EACH) else {
            break;
        };
        failed += 1;
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
        let joined = Components::of(&trial.network, site);
        if self::surplus(&joined).len() < surplus.len() {
            (*tree, components, failed) = (trial, joined, 0);
        }
    }
    Ok(())
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

/// The smallest region that holds all regions along the network `apart`, and
/// `up` levels above it.
fn parting_region(tree: &Tree, components: &Components, apart: usize, up: usize) -> Option<Path> {
    let mut common: Option<Path> = None;
    for leaf in tree.leaves.values() {
        if along(&tree.network, components, leaf.face, apart) {
            common = Some(match common {
                None => leaf.path.clone(),
                Some(path) => path.common(&leaf.path),
            });
        }
    }
    let mut path = common?;
    for _ in 0..up {
        path = path.parent()?;
    }
    Some(path)
}

/// Whether a face has a street of component `apart` on its rim.
fn along(
    network: &Network,
    components: &Components,
    face: network_opt::FaceId,
    apart: usize,
) -> bool {
    network.mesh.loops(face).into_iter().any(|start| {
        network
            .mesh
            .walk(start)
            .any(|h| components.of.get(&network.mesh.origin(h)) == Some(&apart))
    })
}
