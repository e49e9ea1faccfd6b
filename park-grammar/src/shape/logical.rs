//! Logical sides: runs of physical edges between two corners.

use geo_types::Coord;

use super::Region;

/// A side of a region, as a line walked clockwise.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Side {
    /// Its number.
    pub(crate) index: usize,
    /// Its physical edges in the outer ring, clockwise.
    pub(crate) edges: Vec<usize>,
    /// Where it runs, from corner to corner.
    pub(crate) line: Vec<Coord<f64>>,
}

impl Region {
    /// The sides, clockwise from where the ring begins; a number that no edge
    /// has is left out, and a run that the others interrupt comes twice.
    pub(crate) fn logical(&self) -> Vec<Side> {
        let edges = &self.edges[0];
        let n = edges.len();
        let starts = |k: &usize| edges[*k].side != edges[(*k + n - 1) % n].side;
        let first = (0..n).find(starts).unwrap_or(0);
        let mut sides: Vec<Side> = Vec::new();
        let mut before = None;
        for k in (0..n).map(|k| (first + k) % n) {
            let Some(index) = edges[k].side else {
                before = None;
                continue;
            };
            let end = self.area.outer[(k + 1) % n];
            match sides.last_mut().filter(|_| before == Some(index)) {
                Some(side) => {
                    side.edges.push(k);
                    side.line.push(end);
                }
                None => sides.push(Side {
                    index,
                    edges: vec![k],
                    line: vec![self.area.outer[k], end],
                }),
            }
            before = Some(index);
        }
        sides
    }

    /// The corners between sides; corner k is where side k begins, or, in a
    /// mirrored region, where it ends. A side that has no edges begins where the
    /// next one does: corner 0 of a cell at a centre without a size.
    pub(crate) fn corner(&self, index: usize) -> Option<Coord<f64>> {
        let sides = self.logical();
        let there = |k: usize| sides.iter().find(|s| s.index == k);
        let side = (index..self.sides).find_map(there)?;
        if self.local.mirrored() {
            side.line.last().copied()
        } else {
            side.line.first().copied()
        }
    }
}
