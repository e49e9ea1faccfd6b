//! Tiles, their common edges and vertices.

use super::faces::Faces;
use super::grid::{Grid, Node};
use super::Edge;
use geo_types::{Coord, LineString, Polygon};

/// An edge between two vertices of a [`Tiling`], straight and without a vertex
/// in between.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TileEdge {
    /// Indices of its vertices, the lesser first.
    pub vertices: [usize; 2],
    /// The tile to the left of the way from the first vertex to the second, and
    /// that to the right; `None` outside the domain. The same twice for an edge
    /// that does not divide ([`Dangling`](crate::Dangling)).
    pub tiles: [Option<usize>; 2],
    /// The lines that run along it, by their positions in the input, ascending.
    pub lines: Vec<usize>,
    /// Ring (0 is the exterior) and edge of the domain's boundary that it is
    /// part of.
    pub boundary: Option<(usize, usize)>,
}

/// An edge in the direction in which a tile's ring follows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HalfEdge {
    /// Index of the edge.
    pub edge: usize,
    /// From the edge's first vertex to its second?
    pub forward: bool,
}

/// One face of a [`Tiling`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tile {
    /// Its border, the tile to the left: the exterior, anticlockwise, then what
    /// bounds it inside, clockwise. A ring may touch itself in a vertex.
    pub rings: Vec<Vec<HalfEdge>>,
    /// Area in square metres: exact for the tile's vertices but for one
    /// rounding. Positive.
    pub area: f64,
}

/// What [`tiles`](crate::tiles) cuts a domain into.
///
/// Vertices are in the order of their coordinates (x, then y), edges in that of
/// their vertices, tiles in that of their first edges: the numbering does not
/// depend on the order of the lines.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tiling {
    /// Where edges meet, in metres; no two are the same.
    pub vertices: Vec<Coord<f64>>,
    /// All edges of tiles, each once.
    pub edges: Vec<TileEdge>,
    /// The tiles.
    pub tiles: Vec<Tile>,
    precision: f64,
}

impl Tiling {
    /// Spacing of the grid that vertices lie on, in metres: a power of two.
    #[must_use]
    pub fn precision(&self) -> f64 {
        self.precision
    }

    /// Index of the vertex that a half-edge starts from.
    ///
    /// # Panics
    ///
    /// If its edge is not of this tiling.
    #[must_use]
    pub fn tail(&self, half_edge: HalfEdge) -> usize {
        self.edges[half_edge.edge].vertices[usize::from(!half_edge.forward)]
    }

    /// What lies across a half-edge of a tile; `None` outside the domain.
    ///
    /// # Panics
    ///
    /// If its edge is not of this tiling.
    #[must_use]
    pub fn across(&self, half_edge: HalfEdge) -> Option<usize> {
        self.edges[half_edge.edge].tiles[usize::from(half_edge.forward)]
    }

    /// A tile as a polygon with all its vertices, those on straight sides
    /// included. With kept dangling edges a ring runs along them and back.
    ///
    /// # Panics
    ///
    /// If there is no such tile.
    #[must_use]
    pub fn polygon(&self, tile: usize) -> Polygon<f64> {
        let mut rings = self.tiles[tile].rings.iter().map(|ring| {
            let points = ring.iter().map(|&h| self.vertices[self.tail(h)]);
            LineString(points.collect())
        });
        let exterior = rings.next().unwrap_or_else(|| LineString(Vec::new()));
        Polygon::new(exterior, rings.collect())
    }

    /// The tiles that share an edge with this one, ascending, itself excepted.
    ///
    /// # Panics
    ///
    /// If there is no such tile.
    #[must_use]
    pub fn neighbours(&self, tile: usize) -> Vec<usize> {
        let sides = self.tiles[tile].rings.iter().flatten();
        distinct(sides.filter_map(|&h| self.across(h)).filter(|&t| t != tile))
    }

    /// The lines that bound this tile, ascending, by their positions in the
    /// input.
    ///
    /// # Panics
    ///
    /// If there is no such tile.
    #[must_use]
    pub fn lines(&self, tile: usize) -> Vec<usize> {
        let sides = self.tiles[tile].rings.iter().flatten();
        distinct(sides.flat_map(|h| self.edges[h.edge].lines.iter().copied()))
    }
}

fn distinct(values: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut values: Vec<usize> = values.collect();
    values.sort_unstable();
    values.dedup();
    values
}

/// The inner faces as tiles. Every edge has one beside it.
pub(super) fn build(
    grid: &Grid,
    nodes: &[Node],
    edges: Vec<Edge>,
    faces: &Faces,
    inside: &[bool],
) -> Tiling {
    let mut used = vec![false; nodes.len()];
    for edge in &edges {
        used[edge.ends.0] = true;
        used[edge.ends.1] = true;
    }
    let mut number = vec![usize::MAX; nodes.len()];
    let mut vertices = Vec::new();
    for (v, &node) in nodes.iter().enumerate().filter(|&(v, _)| used[v]) {
        number[v] = vertices.len();
        vertices.push(grid.coord(node));
    }
    // Cycles come in the order of their first half-edges: so do the tiles.
    let mut tile_of = vec![None; faces.count];
    let mut tiles: Vec<Tile> = Vec::new();
    let mut areas: Vec<i128> = Vec::new();
    let outer_first = faces
        .cycles
        .iter()
        .filter(|c| c.area2 > 0)
        .chain(faces.cycles.iter().filter(|c| c.area2 <= 0));
    for cycle in outer_first.filter(|c| inside[c.face]) {
        let ring = turned(&cycle.half_edges, nodes, &edges);
        match tile_of[cycle.face] {
            None => {
                tile_of[cycle.face] = Some(tiles.len());
                tiles.push(Tile {
                    rings: vec![ring],
                    area: 0.0,
                });
                areas.push(cycle.area2);
            }
            Some(tile) => {
                let tile: usize = tile;
                tiles[tile].rings.push(ring);
                areas[tile] += cycle.area2;
            }
        }
    }
    for (tile, area) in tiles.iter_mut().zip(areas) {
        tile.area = area as f64 / 2.0 * grid.spacing * grid.spacing;
    }
    let edges = edges
        .into_iter()
        .enumerate()
        .map(|(e, edge)| TileEdge {
            vertices: [number[edge.ends.0], number[edge.ends.1]],
            tiles: [tile_of[faces.left[2 * e]], tile_of[faces.left[2 * e + 1]]],
            lines: edge.lines,
            boundary: edge.boundary,
        })
        .collect();
    Tiling {
        vertices,
        edges,
        tiles,
        precision: grid.spacing,
    }
}

/// The cycle from its least vertex on.
fn turned(cycle: &[usize], nodes: &[Node], edges: &[Edge]) -> Vec<HalfEdge> {
    let tail = |h: usize| {
        let ends = edges[h / 2].ends;
        nodes[if h & 1 == 0 { ends.0 } else { ends.1 }]
    };
    let first = (0..cycle.len())
        .min_by_key(|&i| (tail(cycle[i]), cycle[i]))
        .unwrap_or(0);
    let order = (0..cycle.len()).map(|i| cycle[(first + i) % cycle.len()]);
    order
        .map(|h| HalfEdge {
            edge: h / 2,
            forward: h % 2 == 0,
        })
        .collect()
}
