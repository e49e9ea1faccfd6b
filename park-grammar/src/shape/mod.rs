//! Regions with a memory: where each edge came from, which side of the region
//! it belongs to, and how the region stands to the one that it was cut from.

mod inherit;
mod local;
mod logical;

use std::borrow::Cow;

use geo_types::{Coord, Polygon};

pub(crate) use inherit::Heritage;
pub use local::{Cell, Local, Reach};

use crate::plane::{Area, Ring};

/// What a rule did to make an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Role {
    /// The edge was the selection of a peel, and still is the outer side of what
    /// was peeled: the notes' `PEELED_BASE`.
    Base,
    /// The edge came about where a peel cut: `PEELED_INNER`.
    Inner,
    /// The short edges that join the two: with them `PEELED_SEGMENT`.
    Flank,
    /// The edge runs along a path.
    Path,
    /// The edge borders a centre.
    Centre,
    /// The edge borders another region directly.
    Seam,
}

/// A rule's trace on an edge.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Mark {
    /// The operation, such as `Peel`.
    pub rule: Cow<'static, str>,
    /// How deep in the derivation it was done, the park itself at 0.
    pub depth: usize,
    /// What the edge is to it.
    pub role: Role,
}

/// Where an edge came from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Origin {
    /// The logical side of the park that the edge is part of; `None` for edges
    /// within the park.
    pub boundary: Option<usize>,
    /// The logical side of the park that the edge descends from: its own, or
    /// that of the edge which a rule moved or copied. What the selection of
    /// direction continuity goes by.
    pub descent: Option<usize>,
    /// What rules did, the first one first.
    pub marks: Vec<Mark>,
}

/// A physical edge, from one vertex of a ring to the next, clockwise.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Edge {
    /// The logical side of this region that it belongs to; edges of holes have
    /// none.
    pub side: Option<usize>,
    /// Where it came from.
    pub origin: Origin,
}

/// A region of a park.
///
/// Sides are logical edges: runs of physical edges between two corners. They are
/// counted clockwise from the western one as 0, so that of a square 1 is north,
/// 2 east and 3 south; where a rule mirrors a region (see [`Local`]), its sides
/// are mirrored with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    pub(crate) area: Area,
    /// For each ring the edge that begins at each vertex.
    pub(crate) edges: Vec<Vec<Edge>>,
    /// How many sides there are.
    pub(crate) sides: usize,
    /// Coordinates of its own.
    pub(crate) local: Local,
    /// Which cell of a grid it is, if of any.
    pub(crate) cell: Option<Cell>,
    /// How deep in the derivation, the park itself at 0.
    pub(crate) depth: usize,
}

impl Region {
    /// A region all of whose outer edges are sides of the park, to be indexed.
    pub(crate) fn bare(area: Area) -> Self {
        let edges = area
            .rings()
            .map(|ring| vec![Edge::default(); ring.len()])
            .collect();
        let local = Local::upright(&area.outer);
        Self {
            area,
            edges,
            sides: 0,
            local,
            cell: None,
            depth: 0,
        }
    }

    /// Its outline, exterior counter-clockwise.
    #[must_use]
    pub fn polygon(&self) -> Polygon<f64> {
        self.area.to_polygon()
    }

    /// Square metres.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.area.size()
    }

    /// How many logical sides it has.
    #[must_use]
    pub fn sides(&self) -> usize {
        self.sides
    }

    /// Local coordinates.
    #[must_use]
    pub fn local(&self) -> &Local {
        &self.local
    }

    /// The vertices of a ring, the outer one first.
    pub(crate) fn ring(&self, ring: usize) -> &Ring {
        if ring == 0 {
            &self.area.outer
        } else {
            &self.area.holes[ring - 1]
        }
    }

    /// The physical edges of a ring with what is known of them.
    pub(crate) fn edges(
        &self,
        ring: usize,
    ) -> impl Iterator<Item = (Coord<f64>, Coord<f64>, &Edge)> + '_ {
        let points = crate::plane::sides(self.ring(ring));
        points.zip(&self.edges[ring]).map(|((a, b), e)| (a, b, e))
    }

    /// How many rings it has.
    pub(crate) fn rings(&self) -> usize {
        self.edges.len()
    }
}
