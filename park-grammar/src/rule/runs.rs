//! Sides of cells that have no cardinal directions: runs of edges beside one
//! neighbour, numbered from one of them on.

use geo_types::Coord;

use crate::plane::{box_along, dist, named_by, right, unit};
use crate::shape::{Local, Region};

/// Lengths that differ by less, as a share, are equal.
const SAME: f64 = 1e-9;

/// A run of edges of the outer ring that have one label.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Run<L> {
    pub(crate) label: L,
    /// Its edges, clockwise.
    pub(crate) edges: Vec<usize>,
    pub(crate) length: f64,
    /// Where it begins and ends.
    pub(crate) ends: [Coord<f64>; 2],
}

/// The runs of a region's outer ring, clockwise; `labels` has one for each edge.
pub(crate) fn runs<L: PartialEq + Copy>(region: &Region, labels: &[L]) -> Vec<Run<L>> {
    let ring = region.ring(0);
    let n = ring.len();
    let begins = |k: &usize| labels[*k] != labels[(*k + n - 1) % n];
    let first = (0..n).find(begins).unwrap_or(0);
    let mut found: Vec<Run<L>> = Vec::new();
    for k in (first..first + n).map(|k| k % n) {
        let (a, b) = (ring[k], ring[(k + 1) % n]);
        match found.last_mut().filter(|run| run.label == labels[k]) {
            Some(run) => {
                run.edges.push(k);
                run.length += dist(a, b);
                run.ends[1] = b;
            }
            None => found.push(Run {
                label: labels[k],
                edges: vec![k],
                length: dist(a, b),
                ends: [a, b],
            }),
        }
    }
    found
}

/// The longest of the runs that `wanted` holds for; of several as long the one of
/// the lowest label.
pub(crate) fn longest<L: Ord>(runs: &[Run<L>], wanted: impl Fn(&L) -> bool) -> Option<usize> {
    let mut best: Option<usize> = None;
    for (k, run) in runs.iter().enumerate().filter(|(_, r)| wanted(&r.label)) {
        let better = best.is_none_or(|b| {
            let longer = run.length - runs[b].length;
            let same = longer.abs() <= SAME * run.length;
            (same && run.label < runs[b].label) || (!same && longer > 0.0)
        });
        if better {
            best = Some(k);
        }
    }
    best
}

/// Numbers the sides of a region: the run `start` has the number `from`, those
/// after it clockwise, or where the region is mirrored counter-clockwise, the
/// following ones.
pub(crate) fn number<L>(region: &mut Region, runs: &[Run<L>], start: usize, from: usize) {
    let m = runs.len();
    let mirrored = region.local.mirrored();
    for (k, run) in runs.iter().enumerate() {
        let steps = if mirrored {
            (start + m - k) % m
        } else {
            (k + m - start) % m
        };
        for &edge in &run.edges {
            region.edges[0][edge].side = Some(from + steps);
        }
    }
    region.sides = from + m;
}

/// Coordinates in which a run is the western side: those of the box along it,
/// mirrored if asked.
pub(crate) fn local_beside<L>(region: &Region, run: &Run<L>, mirrored: bool) -> Local {
    let [from, to] = run.ends;
    let along = unit(to - from);
    if along == Coord::default() {
        return Local::upright(region.ring(0)).flipped(mirrored, false);
    }
    let up = if mirrored { -along } else { along };
    let x = right(along);
    Local::new(named_by(box_along(region.ring(0), x), x, up))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Area;
    use geo_types::coord;

    fn square() -> Region {
        let ring = [(0., 0.), (0., 2.), (0., 4.), (4., 4.), (4., 0.)];
        let ring = ring.map(|(x, y)| coord! { x: x, y: y }).to_vec();
        Region::bare(Area::new(ring, Vec::new()))
    }

    fn sides(region: &Region) -> Vec<Option<usize>> {
        region.edges[0].iter().map(|edge| edge.side).collect()
    }

    #[test]
    fn runs_are_numbered_on() {
        let mut region = square();
        let found = runs(&region, &[7, 7, 3, 3, 7]);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].length, found[1].length), (8.0, 8.0));
        assert_eq!(longest(&found, |_| true), Some(0));
        assert_eq!(found[0].label, 3);
        number(&mut region, &found, 1, 0);
        let (zero, one) = (Some(0), Some(1));
        assert_eq!(sides(&region), [zero, zero, one, one, zero]);
        assert_eq!(region.sides, 2);
    }

    /// A mirrored region is numbered the other way, and its coordinates turn so.
    #[test]
    fn mirrored_regions_are_numbered_back() {
        for mirrored in [false, true] {
            let mut region = square();
            let found = runs(&region, &[0, 0, 1, 2, 3]);
            region.local = local_beside(&region, &found[0], mirrored);
            assert_eq!(region.local.mirrored(), mirrored);
            number(&mut region, &found, 0, 0);
            let wanted = if mirrored {
                [0, 0, 3, 2, 1]
            } else {
                [0, 0, 1, 2, 3]
            };
            assert_eq!(sides(&region), wanted.map(Some));
            // The western edge is where x is 0, walked along y.
            let at = region.local.point(coord! { x: 0.0, y: 0.0 });
            let corner = coord! { x: 0.0, y: if mirrored { 4.0 } else { 0.0 } };
            assert_eq!(at, Some(corner));
        }
    }
}
