//! Re-rolling: a region of the split tree becomes one face again.

use std::collections::BTreeSet;

use network_opt::{FaceId, HalfEdgeId};

use crate::error::{Error, Result};
use crate::network::SideKind;
use crate::planner::seed::Path;
use crate::planner::{Pending, Tree};

/// Takes the streets inside the subtree at `root` out of the network and its
/// leaves out of the tree; what is left is the one region that waits there.
/// Everything outside stays as it is.
pub(crate) fn clear(tree: &mut Tree, root: &Path) -> Result<Pending> {
    let faces: BTreeSet<FaceId> = tree.within(root).map(|leaf| leaf.face).collect();
    if faces.is_empty() {
        return Err(Error::usage(format!(
            "no region has the path {root}; paths are the `split` of the layout's features"
        )));
    }
    let mesh = &mut tree.network.mesh;
    let inner: Vec<HalfEdgeId> = mesh
        .edges()
        .filter(|&h| faces.contains(&mesh.face(h)) && faces.contains(&mesh.face(mesh.twin(h))))
        .filter(|&h| mesh.attr(h).kind == SideKind::Street)
        .filter(|&h| {
            mesh.attr(h).street.is_none_or(|s| {
                tree.network
                    .streets
                    .get(s as usize)
                    .is_none_or(|s| !s.given)
            })
        })
        .collect();
    let mut face = None;
    for h in inner {
        if mesh.has_half_edge(h) {
            face = Some(
                mesh.remove_edge(h)
                    .map_err(|e| Error::stage("re-roll", e))?,
            );
        }
    }
    let left: BTreeSet<FaceId> = faces
        .iter()
        .copied()
        .filter(|&f| mesh.has_face(f))
        .collect();
    let [only] = left.iter().copied().collect::<Vec<_>>()[..] else {
        return Err(Error::usage(format!(
            "the regions below {root} are divided by given roads; re-roll one of them"
        )));
    };
    tree.leaves.retain(|path, _| !path.is_within(root));
    tree.warnings.retain(|path, _| !path.is_within(root));
    Ok(Pending::new(
        face.filter(|f| *f == only).unwrap_or(only),
        root.clone(),
    ))
}
