//! The arrangement of lines in a polygon as polygons.

mod faces;
mod grid;
mod join;
mod snap;
mod tiling;

pub use tiling::{HalfEdge, Tile, TileEdge, Tiling};

use crate::error::TraceError;
use faces::{faces, Ends, Faces};
use geo_types::{LineString, Polygon};
use grid::{usable, Grid, Node};
use join::{join, Raw};
use snap::{snap, Piece, Source};
use std::collections::VecDeque;

/// How lines become tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TileOptions {
    /// An end of a line that lies within this distance of the boundary or of a
    /// line (its own included, but for what leads up to the end) is joined to
    /// the nearest point there, in metres. 0 joins nothing.
    ///
    /// Default value: 0.001 m.
    pub snap: f64,
    /// What to do with pieces of lines that have the same tile on both sides.
    ///
    /// Default value: [`Dangling::Prune`].
    pub dangling: Dangling,
}

/// What becomes of pieces that do not divide. Where they are kept, their edges
/// occur twice in the rings of their tile, once each way; where they are not,
/// the vertices that they had on other edges stay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Dangling {
    /// All are removed: every inner edge has two different tiles.
    #[default]
    Prune,
    /// Loose ends and lines that touch nothing are removed; bridges stay, as a
    /// single line from a hole to the exterior, which makes a tile around the
    /// hole simply connected.
    Bridges,
    /// All are kept.
    Keep,
}

impl Default for TileOptions {
    fn default() -> Self {
        Self {
            snap: 1e-3,
            dangling: Dangling::Prune,
        }
    }
}

/// An edge of the arrangement before it is known what lies beside it.
struct Edge {
    ends: Ends,
    /// Ring and edge of the domain; `None` for what does not divide inside from
    /// outside.
    boundary: Option<(usize, usize)>,
    lines: Vec<usize>,
}

/// Cuts a polygon along lines.
///
/// The result is watertight: tiles share vertices by index, wherever a line
/// ends on a side of a tile the tiles on both sides have a vertex, no two tiles
/// overlap, and together they are the domain. It does not matter whether lines
/// cross, touch, overlap, retrace themselves, run along the boundary or leave
/// the domain (what lies outside is cut off). Holes are recognised by the
/// even-odd rule over all rings, whatever their orientation.
///
/// # Accuracy
///
/// Coordinates are rounded to a grid of about 2^-38 of the size of the domain,
/// or four units in the last place of its largest coordinate
/// ([`Tiling::precision`]); everything after that is exact. A line moves by at
/// most one spacing of the grid, an end of one by at most [`TileOptions::snap`]
/// more. Domains thinner than the grid have no tiles.
///
/// # Errors
///
/// [`TraceError::LineNotFinite`], [`TraceError::DomainNotFinite`] for
/// coordinates that are not finite, or beyond 1e100;
/// [`TraceError::DomainWithoutArea`]; [`TraceError::BadOption`].
///
/// # Complexity
///
/// O((n + k) log n) for n pieces with k crossings, as long as the boxes of
/// pieces seldom overlap without need, which holds for traced lines. Each
/// component of the lines that is not connected to the boundary costs a ray.
///
/// # Examples
///
/// ```
/// use geo_types::{line_string, polygon};
/// use streamline::{tiles, TileOptions};
///
/// let land = polygon![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 60.), (x: 0., y: 60.)];
/// let street = line_string![(x: 30., y: 0.), (x: 30., y: 60.)];
/// let lane = line_string![(x: 30., y: 20.), (x: 90., y: 20.)]; // ends on the street
/// let tiling = tiles(&land, &[street, lane], &TileOptions::default())?;
///
/// assert_eq!(tiling.tiles.len(), 3);
/// let areas: Vec<f64> = tiling.tiles.iter().map(|tile| tile.area).collect();
/// assert_eq!(areas, [1800., 1200., 2400.]);
/// assert_eq!(tiling.neighbours(0), [1, 2]);
/// assert_eq!(tiling.lines(1), [0, 1]);
/// assert_eq!(tiling.polygon(0).exterior().0.len(), 6); // the T is a vertex here too
/// # Ok::<(), streamline::TraceError>(())
/// ```
pub fn tiles(
    domain: &Polygon<f64>,
    lines: &[LineString<f64>],
    options: &TileOptions,
) -> Result<Tiling, TraceError> {
    TraceError::unless_not_negative("snap", options.snap)?;
    let grid = Grid::new(domain)?;
    let (raw, ranges) = gather(&grid, domain, lines)?;
    let pieces = snap(&join(&raw, &ranges, options.snap / grid.spacing));
    let (nodes, mut edges) = graph(&pieces);
    if options.dangling != Dangling::Keep {
        prune_trees(nodes.len(), &mut edges);
    }
    loop {
        let ends: Vec<Ends> = edges.iter().map(|edge| edge.ends).collect();
        let faces = faces(&nodes, &ends);
        let inside = inside(&faces, &edges);
        // What does not divide: with it gone the faces are the same, so that
        // the second round finds nothing more.
        let idle: Vec<bool> = (0..edges.len())
            .map(|e| {
                let (left, right) = (faces.left[2 * e], faces.left[2 * e + 1]);
                let outside = !inside[left] && !inside[right];
                outside || (left == right && options.dangling == Dangling::Prune)
            })
            .collect();
        if !idle.contains(&true) {
            return Ok(tiling::build(&grid, &nodes, edges, &faces, &inside));
        }
        let mut idle = idle.into_iter();
        edges.retain(|_| !idle.next().unwrap_or(false));
    }
}

/// All pieces of the input in grid units, and which of them make up each line
/// where nothing was cut off.
#[allow(
    clippy::type_complexity,
    reason = "pieces, and ranges of them: used once"
)]
fn gather(
    grid: &Grid,
    domain: &Polygon<f64>,
    lines: &[LineString<f64>],
) -> Result<(Vec<Raw>, Vec<std::ops::Range<usize>>), TraceError> {
    let mut raw = Vec::new();
    let rings = std::iter::once(domain.exterior()).chain(domain.interiors());
    for (ring, line) in rings.enumerate() {
        for (edge, pair) in line.0.windows(2).enumerate() {
            raw.push(Raw {
                from: grid.scaled(pair[0]),
                to: grid.scaled(pair[1]),
                source: Source::Boundary { ring, edge },
            });
        }
    }
    let mut ranges = Vec::with_capacity(lines.len());
    for (index, line) in lines.iter().enumerate() {
        if let Some(p) = line.0.iter().find(|&&p| !usable(p)) {
            return Err(TraceError::LineNotFinite {
                index,
                x: p.x,
                y: p.y,
            });
        }
        let start = raw.len();
        for pair in line.0.windows(2) {
            if let Some((a, b)) = grid.clip(pair[0], pair[1]) {
                raw.push(Raw {
                    from: grid.scaled(a),
                    to: grid.scaled(b),
                    source: Source::Line(index),
                });
            }
        }
        ranges.push(start..raw.len());
    }
    Ok((raw, ranges))
}

/// Vertices in the order of their coordinates and edges in that of their
/// vertices: neither depends on the order of the lines.
fn graph(pieces: &[Piece]) -> (Vec<Node>, Vec<Edge>) {
    let mut nodes: Vec<Node> = pieces.iter().flat_map(|p| [p.nodes.0, p.nodes.1]).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let vertex = |node: Node| {
        nodes
            .binary_search(&node)
            .expect("every end of a piece is among the nodes")
    };
    let mut edges = Vec::new();
    for same in pieces.chunk_by(|a, b| a.nodes == b.nodes) {
        let mut rings = Vec::new();
        let mut lines = Vec::new();
        for piece in same {
            match piece.source {
                Source::Boundary { ring, edge } => rings.push((ring, edge)),
                Source::Line(line) => lines.push(line),
            }
        }
        lines.dedup(); // Pieces are sorted by source.
        let boundary = if rings.len() % 2 == 1 {
            rings.first().copied()
        } else {
            None // The rings fold back onto themselves here.
        };
        if boundary.is_some() || !lines.is_empty() {
            edges.push(Edge {
                ends: (vertex(same[0].nodes.0), vertex(same[0].nodes.1)),
                boundary,
                lines,
            });
        }
    }
    (nodes, edges)
}

/// Removes what hangs on one vertex only, again and again. Boundary edges meet
/// in even numbers, so that none of them hangs.
fn prune_trees(vertices: usize, edges: &mut Vec<Edge>) {
    let mut at: Vec<Vec<usize>> = vec![Vec::new(); vertices];
    for (e, edge) in edges.iter().enumerate() {
        at[edge.ends.0].push(e);
        at[edge.ends.1].push(e);
    }
    let mut degree: Vec<usize> = at.iter().map(Vec::len).collect();
    let mut gone = vec![false; edges.len()];
    let mut queue: VecDeque<usize> = (0..vertices).filter(|&v| degree[v] == 1).collect();
    while let Some(v) = queue.pop_front() {
        let Some(&e) = at[v].iter().find(|&&e| !gone[e]) else {
            continue; // Its last edge went with the other end.
        };
        gone[e] = true;
        let (a, b) = edges[e].ends;
        let other = if a == v { b } else { a };
        degree[v] -= 1;
        degree[other] -= 1;
        if degree[other] == 1 {
            queue.push_back(other);
        }
    }
    let mut gone = gone.into_iter();
    edges.retain(|_| !gone.next().unwrap_or(false));
}

/// Which faces belong to the domain: those that an odd number of boundary edges
/// parts from the unbounded face.
fn inside(faces: &Faces, edges: &[Edge]) -> Vec<bool> {
    let mut borders: Vec<Vec<usize>> = vec![Vec::new(); faces.count];
    for cycle in &faces.cycles {
        borders[cycle.face].extend(&cycle.half_edges);
    }
    let mut known: Vec<Option<bool>> = vec![None; faces.count];
    known[0] = Some(false);
    let mut queue = VecDeque::from([0]);
    while let Some(face) = queue.pop_front() {
        let here = known[face] == Some(true);
        for &h in &borders[face] {
            let beyond = faces.left[h ^ 1];
            if known[beyond].is_none() {
                known[beyond] = Some(here ^ edges[h / 2].boundary.is_some());
                queue.push_back(beyond);
            }
        }
    }
    known.into_iter().map(|k| k == Some(true)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{line_string, polygon};

    fn yard() -> Polygon<f64> {
        polygon!(
            exterior: [(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 100.), (x: 0., y: 100.)],
            interiors: [[(x: 40., y: 40.), (x: 60., y: 40.), (x: 60., y: 60.), (x: 40., y: 60.)]],
        )
    }

    fn cut(lines: &[LineString<f64>], dangling: Dangling) -> Tiling {
        let options = TileOptions {
            dangling,
            ..TileOptions::default()
        };
        tiles(&yard(), lines, &options).unwrap()
    }

    #[test]
    fn without_lines_the_domain_is_the_tile() {
        let tiling = cut(&[], Dangling::Prune);
        assert_eq!(tiling.tiles.len(), 1);
        assert_eq!(tiling.tiles[0].area, 9600.0);
        assert_eq!(tiling.tiles[0].rings.len(), 2);
        assert_eq!(tiling.edges.len(), 8);
        assert!(tiling.edges.iter().all(|e| e.boundary.is_some()));
        assert_eq!(tiling.polygon(0).interiors().len(), 1);
    }

    #[test]
    fn what_does_not_divide_is_pruned_or_kept() {
        // From the hole to the boundary; a loose line; one that ends in the open.
        let lines = [
            line_string![(x: 60., y: 50.), (x: 100., y: 50.)],
            line_string![(x: 10., y: 10.), (x: 20., y: 20.), (x: 20., y: 30.)],
            line_string![(x: 0., y: 80.), (x: 30., y: 80.)],
        ];
        let pruned = cut(&lines, Dangling::Prune);
        assert_eq!(pruned.tiles.len(), 1);
        // Where pruned lines met the boundary their vertices stay.
        assert_eq!(pruned.edges.len(), 8 + 3);
        let bridged = cut(&lines, Dangling::Bridges);
        assert_eq!(bridged.tiles[0].rings.len(), 1);
        assert_eq!(bridged.edges.len(), 8 + 3 + 1);
        assert_eq!(bridged.lines(0), [0]);
        let kept = cut(&lines, Dangling::Keep);
        assert_eq!(kept.tiles.len(), 1);
        assert_eq!(kept.tiles[0].area, 9600.0);
        // The line from the hole makes one ring of the two; the loose line is
        // a ring of its own. 8 + 3 vertices split edges on the boundary; edges
        // of lines: 1 + 2 + 1.
        assert_eq!(kept.tiles[0].rings.len(), 2);
        assert_eq!(kept.edges.len(), 8 + 3 + 4);
        assert_eq!(kept.lines(0), [0, 1, 2]);
        assert_eq!(kept.neighbours(0), Vec::<usize>::new());
    }

    #[test]
    fn lines_leave_the_domain_and_return() {
        let tiling = cut(
            &[line_string![(x: -50., y: 50.), (x: 300., y: 50.)]],
            Dangling::Prune,
        );
        assert_eq!(tiling.tiles.len(), 2);
        assert_eq!(tiling.tiles[0].area, 4800.0);
        assert_eq!(tiling.neighbours(0), [1]);
        let shared: Vec<_> = tiling
            .edges
            .iter()
            .filter(|e| e.boundary.is_none())
            .collect();
        assert_eq!(shared.len(), 2);
        assert!(shared.iter().all(|e| e.lines == [0]));
    }

    #[test]
    fn a_line_along_the_boundary_bounds_without_dividing() {
        let tiling = cut(
            &[line_string![(x: 20., y: 0.), (x: 70., y: 0.)]],
            Dangling::Prune,
        );
        assert_eq!(tiling.tiles.len(), 1);
        let along: Vec<_> = tiling.edges.iter().filter(|e| e.lines == [0]).collect();
        assert_eq!(along.len(), 1);
        assert_eq!(along[0].boundary, Some((0, 0)));
    }

    #[test]
    fn an_end_just_short_of_its_goal_is_joined() {
        let short = line_string![(x: 0.0005, y: 20.), (x: 99.9995, y: 20.)];
        assert_eq!(
            cut(std::slice::from_ref(&short), Dangling::Prune)
                .tiles
                .len(),
            2
        );
        let options = TileOptions {
            snap: 0.0,
            ..TileOptions::default()
        };
        assert_eq!(tiles(&yard(), &[short], &options).unwrap().tiles.len(), 1);
    }

    #[test]
    fn bad_input_is_named() {
        let bad = [
            line_string![(x: 0., y: 0.)],
            line_string![(x: 0., y: f64::NAN)],
        ];
        assert!(matches!(
            tiles(&yard(), &bad, &TileOptions::default()),
            Err(TraceError::LineNotFinite { index: 1, .. })
        ));
        let options = TileOptions {
            snap: -1.0,
            ..TileOptions::default()
        };
        assert!(matches!(
            tiles(&yard(), &[], &options),
            Err(TraceError::BadOption { name: "snap", .. })
        ));
    }
}
