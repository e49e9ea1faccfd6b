//! `History("Peel", INNER, -1)`: edges by what rules did.
//!
//! Every rule marks the edges that it makes (see [`Mark`]), so that one selector
//! serves all of them. Levels count the times that the rule was done on the way
//! to this region, those among them that left a mark on its edges: 0 is the
//! first, -1 the last, as the notes' negative indices "count from the front of
//! history". `PEELED_BASE` (`PB`), `PEELED_INNER` (`PI`) and `PEELED_SEGMENT`
//! (`PS`, the inner edges with those that join them to the base) are those of
//! the last peel. Without a level any is meant, without a role any role.
//!
//! [`Mark`]: crate::shape::Mark

use super::Selection;
use crate::shape::{Edge, Region, Role};

/// The roles that a word stands for.
pub(super) fn roles(word: &str) -> Option<&'static [Role]> {
    Some(match word {
        "BASE" => &[Role::Base],
        "INNER" => &[Role::Inner],
        "FLANK" => &[Role::Flank],
        "SEGMENT" => &[Role::Inner, Role::Flank],
        "PATH" => &[Role::Path],
        "CENTRE" => &[Role::Centre],
        "SEAM" => &[Role::Seam],
        "ANY" => &[
            Role::Base,
            Role::Inner,
            Role::Flank,
            Role::Path,
            Role::Centre,
            Role::Seam,
        ],
        _ => return None,
    })
}

/// The edges to which a rule gave one of these roles, at a level or at any.
pub(super) fn history(
    region: &Region,
    rule: &str,
    roles: &[Role],
    level: Option<i64>,
) -> Selection {
    let mut depths: Vec<usize> = region
        .edges
        .iter()
        .flatten()
        .flat_map(|edge| &edge.origin.marks)
        .filter(|mark| mark.rule == rule)
        .map(|mark| mark.depth)
        .collect();
    depths.sort_unstable();
    depths.dedup();
    let depth = level.map(|level| {
        let count = i64::try_from(depths.len()).unwrap_or(i64::MAX);
        let k = if level < 0 { count + level } else { level };
        usize::try_from(k).ok().and_then(|k| depths.get(k)).copied()
    });
    Selection::edges(region, |_, _, edge: &Edge| {
        edge.origin.marks.iter().any(|mark| {
            let at = depth.is_none_or(|depth| depth == Some(mark.depth));
            mark.rule == rule && at && roles.contains(&mark.role)
        })
    })
}

/// The edges that any rule gave a role.
pub(super) fn role(region: &Region, role: Role) -> Selection {
    Selection::edges(region, |_, _, edge: &Edge| {
        edge.origin.marks.iter().any(|mark| mark.role == role)
    })
}
