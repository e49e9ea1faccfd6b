//! Where a template fits on a mesh of quads.

use std::collections::BTreeSet;

use super::template::{Shape, SIDES};
use crate::design::{Placement, Tessellation};

/// All ways in which a shape fits on a mesh, each set of faces once, in the
/// order of their faces.
///
/// A shape is laid on the mesh by walking: the first square is put on a face in
/// one of four directions, the next ones follow across the opposite sides of
/// quads. It fits where every two squares that share a side do so on the mesh,
/// whichever way one walks, and no face comes twice; so a place where four
/// squares meet is a vertex of four quads.
///
/// With `irregular` one of these places may be an inner vertex of three or five
/// quads (the paper's figure 9a): the shape is cut along the four lines that
/// leave the place into quarters, and one of them is left out or comes twice.
/// So two by two squares become three or five quads around a vertex. Every other
/// place where four squares meet is regular.
///
/// With `mirrored` the shape may also lie on its back. Faces that are no quads
/// are in no placement.
///
/// # Complexity
///
/// O(faces times squares), and for irregular vertices their number times the
/// squares times the places where four of them meet.
///
/// # Examples
///
/// ```
/// use network_opt::design::Tessellation;
/// use network_opt::floor::placements;
/// use network_opt::geo_types::coord;
///
/// // Three by two squares.
/// let points = (0..12).map(|k| coord! { x: f64::from(k % 4), y: f64::from(k / 4) }).collect();
/// let faces = [0, 1, 2, 4, 5, 6].map(|a| vec![a, a + 1, a + 5, a + 4]);
/// let mesh = Tessellation::new(points, faces.to_vec())?;
/// let count = |shape: &str| Ok(placements(&mesh, "room", &shape.parse()?, true, true).len());
/// assert_eq!(count("##/##")?, 2);
/// assert_eq!(count("###/###")?, 1);
/// // Four ways in each two by two squares.
/// assert_eq!(count("##/#.")?, 8);
/// # Ok::<(), network_opt::DesignError>(())
/// ```
#[must_use]
pub fn placements(
    mesh: &Tessellation,
    template: &str,
    shape: &Shape,
    mirrored: bool,
    irregular: bool,
) -> Vec<Placement> {
    let steps = Steps::new(mesh);
    let mut found: BTreeSet<Vec<usize>> = BTreeSet::new();
    let mut shapes = vec![shape.clone()];
    if mirrored {
        shapes.push(shape.mirrored());
        shapes.dedup();
    }
    for shape in &shapes {
        let flat = Walk::flat(shape);
        for f in 0..mesh.faces().len() {
            for k in 0..4 {
                found.extend(steps.lay(&flat, (f, k)));
            }
        }
        if !irregular {
            continue;
        }
        for valence in [3, 5] {
            let starts = steps.corners(mesh, valence);
            if starts.is_empty() {
                continue;
            }
            for crossing in shape.crossings() {
                for walk in Walk::around(shape, crossing, valence) {
                    for &start in &starts {
                        found.extend(steps.lay(&walk, start));
                    }
                }
            }
        }
    }
    found
        .into_iter()
        .map(|faces| placement(mesh, template, faces))
        .collect()
}

/// A room of these faces: which edges are inside, and which around it.
pub(super) fn placement(mesh: &Tessellation, template: &str, faces: Vec<usize>) -> Placement {
    let mut edges: Vec<usize> = faces
        .iter()
        .flat_map(|&f| mesh.edges_of(f))
        .copied()
        .collect();
    edges.sort_unstable();
    let (mut inner, mut border) = (Vec::new(), Vec::new());
    for run in edges.chunk_by(|a, b| a == b) {
        if run.len() > 1 {
            inner.push(run[0]);
        } else {
            border.push(run[0]);
        }
    }
    Placement {
        template: template.to_owned(),
        faces,
        inner,
        border,
    }
}

/// A face, and which of its sides is in the first direction.
type Frame = (usize, usize);

/// A shape as squares with what lies beyond their sides.
#[derive(Debug)]
struct Walk {
    /// For each square and direction (first, second, and back the two) the square
    /// there, and the direction in its own terms in which this one is seen from
    /// there.
    links: Vec<[Option<(usize, usize)>; 4]>,
}

impl Walk {
    /// Squares of a plane.
    fn flat(shape: &Shape) -> Self {
        let cells = shape.cells();
        let link = |cell: &(i32, i32), d: usize| {
            let there = (cell.0 + SIDES[d].0, cell.1 + SIDES[d].1);
            let k = cells.binary_search(&there).ok()?;
            Some((k, (d + 2) % 4))
        };
        Self {
            links: cells
                .iter()
                .map(|cell| std::array::from_fn(|d| link(cell, d)))
                .collect(),
        }
    }

    /// The shape with one quarter around a crossing left out, or twice.
    fn around(shape: &Shape, crossing: (i32, i32), valence: usize) -> Vec<Self> {
        let quarters = quarters(shape, crossing);
        let orders: Vec<Vec<usize>> = (0..4)
            .map(|q| match valence {
                3 => (0..4).filter(|&k| k != q).collect(),
                _ => (0..4)
                    .flat_map(|k| if k == q { vec![k, k] } else { vec![k] })
                    .collect(),
            })
            .collect();
        orders
            .iter()
            .map(|order| Self::sectors(&quarters, order))
            .collect()
    }

    /// Quarters in this order around a vertex.
    fn sectors(quarters: &[Vec<(i32, i32)>; 4], order: &[usize]) -> Self {
        // Squares by sector and position; the first is at the vertex.
        let mut nodes: Vec<(usize, (i32, i32))> = Vec::new();
        for (s, &q) in order.iter().enumerate() {
            nodes.extend(quarters[q].iter().map(|&cell| (s, cell)));
        }
        let n = order.len();
        let find = |s: usize, cell: (i32, i32)| nodes.iter().position(|&node| node == (s, cell));
        let link = |(s, cell): (usize, (i32, i32)), d: usize| match (d, cell) {
            // Across the second axis into the next sector, and back.
            (2, (0, j)) => Some((find((s + 1) % n, (j, 0))?, 3)),
            (3, (i, 0)) => Some((find((s + n - 1) % n, (0, i))?, 2)),
            _ => Some((
                find(s, (cell.0 + SIDES[d].0, cell.1 + SIDES[d].1))?,
                (d + 2) % 4,
            )),
        };
        Self {
            links: nodes
                .iter()
                .map(|&node| std::array::from_fn(|d| link(node, d)))
                .collect(),
        }
    }
}

/// The squares of each quarter around a crossing, counter-clockwise, in axes of
/// its own: along its first border, and along its second.
fn quarters(shape: &Shape, (x, y): (i32, i32)) -> [Vec<(i32, i32)>; 4] {
    let mut quarters: [Vec<(i32, i32)>; 4] = Default::default();
    for &(cx, cy) in shape.cells() {
        let (east, north) = (cx - x, cy - y);
        let (west, south) = (-1 - east, -1 - north);
        let (q, cell) = match (east >= 0, north >= 0) {
            (true, true) => (0, (east, north)),
            (false, true) => (1, (north, west)),
            (false, false) => (2, (west, south)),
            (true, false) => (3, (south, east)),
        };
        quarters[q].push(cell);
    }
    // The one at the vertex first.
    quarters.iter_mut().for_each(|q| q.sort_unstable());
    quarters
}

/// What lies beyond the sides of faces.
struct Steps {
    /// For each quad and side the face there, and which of its sides it is; none
    /// at the rim, and at faces that are no quads.
    beyond: Vec<[Option<Frame>; 4]>,
    quads: Vec<bool>,
}

impl Steps {
    fn new(mesh: &Tessellation) -> Self {
        let quads: Vec<bool> = mesh.faces().iter().map(|face| face.len() == 4).collect();
        let across = |f: usize, side: usize| {
            let e = *mesh.edges_of(f).get(side).filter(|_| quads[f])?;
            let g = *mesh.faces_of(e).iter().find(|&&g| g != f)?;
            let back = mesh.edges_of(g).iter().position(|&other| other == e)?;
            Some((g, back)).filter(|_| quads[g])
        };
        Self {
            beyond: (0..quads.len())
                .map(|f| std::array::from_fn(|side| across(f, side)))
                .collect(),
            quads,
        }
    }

    /// Frames whose square lies at an inner vertex of so many quads, between the
    /// two axes from there.
    fn corners(&self, mesh: &Tessellation, valence: usize) -> Vec<Frame> {
        let inner = |v: usize| {
            let around = mesh.around(v);
            around.len() == valence && around.iter().all(|&(e, _)| mesh.faces_of(e).len() == 2)
        };
        let frames = (0..self.quads.len()).flat_map(|f| (0..4).map(move |k| (f, k)));
        frames
            // Sides turn counter-clockwise: first, second, and back the two. The
            // last one begins where the third ends.
            .filter(|&(f, k)| self.quads[f] && inner(mesh.faces()[f][(k + 3) % 4]))
            .collect()
    }

    /// The faces of a walk that begins with its first square there, ascending.
    fn lay(&self, walk: &Walk, start: Frame) -> Option<Vec<usize>> {
        if !self.quads[start.0] {
            return None;
        }
        let mut frames: Vec<Option<Frame>> = vec![None; walk.links.len()];
        frames[0] = Some(start);
        let mut queue = vec![0];
        while let Some(node) = queue.pop() {
            let (f, first) = frames[node]?;
            for (d, link) in walk.links[node].iter().enumerate() {
                let Some((to, seen)) = *link else { continue };
                let (g, side) = self.beyond[f][(first + d) % 4]?;
                let frame = (g, (side + 4 - seen) % 4);
                match frames[to] {
                    None => {
                        frames[to] = Some(frame);
                        queue.push(to);
                    }
                    Some(known) if known != frame => return None,
                    Some(_) => {}
                }
            }
        }
        let faces: Option<Vec<usize>> = frames.iter().map(|f| f.map(|(f, _)| f)).collect();
        let mut faces = faces?;
        faces.sort_unstable();
        let count = faces.len();
        faces.dedup();
        (faces.len() == count).then_some(faces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    /// `valence` quads around a vertex.
    fn star(valence: usize) -> Tessellation {
        let turn = std::f64::consts::TAU / valence as f64;
        let mut points = vec![coord! { x: 0.0, y: 0.0 }];
        for k in 0..valence {
            let (a, b) = (turn * k as f64, turn * (k as f64 + 0.5));
            points.push(coord! { x: a.cos(), y: a.sin() });
            points.push(coord! { x: 1.4 * b.cos(), y: 1.4 * b.sin() });
        }
        let next = |k: usize| 1 + 2 * ((k + 1) % valence);
        let faces = (0..valence).map(|k| vec![0, 1 + 2 * k, 2 + 2 * k, next(k)]);
        Tessellation::new(points, faces.collect()).expect("a mesh")
    }

    fn count(mesh: &Tessellation, shape: &str, irregular: bool) -> usize {
        let shape = shape.parse().expect("a shape");
        placements(mesh, "room", &shape, true, irregular).len()
    }

    #[test]
    fn squares_close_around_irregular_vertices_if_they_may() {
        for valence in [3, 5] {
            let mesh = star(valence);
            assert_eq!(count(&mesh, "##/##", false), 0);
            assert_eq!(count(&mesh, "##/##", true), 1);
            let found = placements(
                &mesh,
                "room",
                &"##/##".parse().expect("a shape"),
                true,
                true,
            );
            assert_eq!(found[0].faces, (0..valence).collect::<Vec<_>>());
            assert_eq!(
                (found[0].inner.len(), found[0].border.len()),
                (valence, 2 * valence)
            );
            // Two and three in a bend: around the vertex, from any of them. Three
            // of three would close, which a bend does not.
            assert_eq!(count(&mesh, "##", false), valence);
            assert_eq!(
                count(&mesh, "##/#.", false),
                if valence == 3 { 1 } else { 5 }
            );
        }
        assert_eq!(count(&star(4), "##/##", false), 1);
        // Six are out of the ordinary.
        assert_eq!(count(&star(6), "##/##", true), 0);
    }

    /// On a grid of w by h squares a box of a by b fits (w - a + 1) (h - b + 1)
    /// times, and turned.
    #[test]
    fn boxes_fit_as_often_as_they_should() {
        let mesh = Tessellation::grid(7, 5);
        assert_eq!(count(&mesh, "#", true), 35);
        assert_eq!(count(&mesh, "##/##", true), 6 * 4);
        assert_eq!(count(&mesh, "###/###", true), 5 * 4 + 6 * 3);
        assert_eq!(count(&mesh, "##/#.", true), 4 * 24);
        // An S has a mirror image of its own.
        let s: Shape = "##./.##".parse().expect("a shape");
        let both = placements(&mesh, "s", &s, true, true).len();
        assert_eq!(both, 2 * placements(&mesh, "s", &s, false, true).len());
        assert_eq!(both, 2 * (5 * 4 + 6 * 3));
        assert_eq!(count(&mesh, "########", true), 0);
    }
}
