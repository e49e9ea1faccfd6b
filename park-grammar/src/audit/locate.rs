//! Which rings surround a point, and which pass near it.

use std::collections::BTreeMap;

use geo_types::Coord;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{RTree, AABB};

use crate::plane::{dist, nearest_on, sides, Area};

/// An edge, and the area that it bounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) a: Coord<f64>,
    pub(super) b: Coord<f64>,
    pub(super) owner: usize,
}

type Entry = GeomWithData<Rectangle<[f64; 2]>, Edge>;

/// The edges of some areas, by place.
#[derive(Debug)]
pub(super) struct Locator {
    tree: RTree<Entry>,
    west: f64,
}

impl Locator {
    pub(super) fn new<'a>(areas: impl IntoIterator<Item = (usize, &'a Area)>) -> Self {
        let edges = areas.into_iter().flat_map(|(owner, area)| {
            let edges = area.rings().flat_map(|ring| sides(ring));
            edges.map(move |(a, b)| Edge { a, b, owner })
        });
        let entry =
            |edge: Edge| GeomWithData::new(Rectangle::from_corners(at(edge.a), at(edge.b)), edge);
        let entries: Vec<Entry> = edges.map(entry).collect();
        let west = entries.iter().map(|e| e.geom().lower()[0]);
        Self {
            west: west.fold(0.0, f64::min) - 1.0,
            tree: RTree::bulk_load(entries),
        }
    }

    /// Edges whose boxes meet a box.
    pub(super) fn meeting(
        &self,
        low: Coord<f64>,
        high: Coord<f64>,
    ) -> impl Iterator<Item = &Edge> + '_ {
        let found = self
            .tree
            .locate_in_envelope_intersecting(&AABB::from_corners(at(low), at(high)));
        found.map(|entry| &entry.data)
    }

    /// The areas that a point lies in: those with an odd number of edges in the
    /// west of it.
    pub(super) fn around(&self, p: Coord<f64>) -> Vec<usize> {
        let mut odd: BTreeMap<usize, bool> = BTreeMap::new();
        for edge in self.meeting(Coord { x: self.west, ..p }, p) {
            let (a, b) = (edge.a, edge.b);
            if (a.y > p.y) != (b.y > p.y) && p.x >= a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y) {
                let odd = odd.entry(edge.owner).or_default();
                *odd = !*odd;
            }
        }
        let inside = odd.into_iter().filter(|(_, odd)| *odd);
        inside.map(|(owner, _)| owner).collect()
    }

    /// The areas with an edge within a distance of a point, and how near the
    /// nearest is.
    pub(super) fn near(&self, p: Coord<f64>, within: f64) -> BTreeMap<usize, f64> {
        let by = Coord {
            x: within,
            y: within,
        };
        let mut found: BTreeMap<usize, f64> = BTreeMap::new();
        for edge in self.meeting(p - by, p + by) {
            let away = dist(p, nearest_on(edge.a, edge.b, p));
            if away < within {
                let least = found.entry(edge.owner).or_insert(away);
                *least = least.min(away);
            }
        }
        found
    }

    /// All edges.
    pub(super) fn edges(&self) -> impl Iterator<Item = &Edge> + '_ {
        self.tree.iter().map(|entry| &entry.data)
    }
}

fn at(c: Coord<f64>) -> [f64; 2] {
    [c.x, c.y]
}
