//! Point location: a grid for a cold start, a walk from triangle to triangle
//! otherwise; and where a segment leaves the domain.

use super::mesh::{Mesh, BORDER};
use super::{Cursor, Exit, Inner};
use crate::footpoint::EdgeTree;
use crate::plane::{nearest_on_segment, orient, orient_exact, wedge, V2};

/// A uniform grid over the bounding box: for each cell the triangles whose
/// bounding boxes meet it.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    low: V2,
    per_unit: f64,
    columns: usize,
    rows: usize,
    /// Cell `c` has the entries `starts[c]..starts[c + 1]` of `triangles`.
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Grid {
    /// About as many cells as triangles, so that an entry of the list is met
    /// by a constant number of cells on an even mesh.
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let first = mesh.points[0];
        let (low, high) = mesh
            .points
            .iter()
            .fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        let extent = high - low;
        let count = mesh.triangles.len() as f64;
        let cell = (extent.x * extent.y / count)
            .sqrt()
            // A sliver of a bounding box: still only some 4 cells a triangle.
            .max(extent.x.max(extent.y) / (4.0 * count));
        let cells = |length: f64| ((length / cell).floor() as usize).saturating_add(1);
        let mut grid = Self {
            low,
            per_unit: cell.recip(),
            columns: cells(extent.x),
            rows: cells(extent.y),
            starts: Vec::new(),
            triangles: Vec::new(),
        };
        let boxes = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| mesh.points[v as usize]);
            (a.inf(&b).inf(&c), a.sup(&b).sup(&c))
        };
        let mut starts = vec![0_u32; grid.columns * grid.rows + 1];
        for triangle in &mesh.triangles {
            let (low, high) = boxes(triangle);
            grid.cells(low, high, |cell| starts[cell + 1] += 1);
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut triangles = vec![0_u32; starts[starts.len() - 1] as usize];
        let mut next = starts.clone();
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            let (low, high) = boxes(triangle);
            grid.cells(low, high, |cell| {
                triangles[next[cell] as usize] = index as u32;
                next[cell] += 1;
            });
        }
        grid.starts = starts;
        grid.triangles = triangles;
        grid
    }

    fn column(&self, x: f64) -> usize {
        // The cast saturates: whatever lies outside goes to a border cell.
        (((x - self.low.x) * self.per_unit) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.low.y) * self.per_unit) as usize).min(self.rows - 1)
    }

    fn cells(&self, low: V2, high: V2, mut visit: impl FnMut(usize)) {
        for row in self.row(low.y)..=self.row(high.y) {
            for column in self.column(low.x)..=self.column(high.x) {
                visit(row * self.columns + column);
            }
        }
    }

    /// Triangles near `p`.
    fn candidates(&self, p: V2) -> &[u32] {
        let cell = self.row(p.y) * self.columns + self.column(p.x);
        &self.triangles[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

/// Steps of a walk before the grid is asked instead. A walk of this length
/// costs about as much as the grid.
const PATIENCE: usize = 24;

impl Inner {
    fn corners(&self, triangle: usize) -> [V2; 3] {
        self.mesh.triangles[triangle].map(|v| self.mesh.points[v as usize])
    }

    /// The triangle that contains `p`, borders included, with a tolerance of
    /// about 1e-10 of the domain's size for points computed to lie on them.
    pub(crate) fn locate(&self, p: V2, cursor: &mut Cursor) -> Option<usize> {
        if !(p.x.is_finite() && p.y.is_finite()) {
            return None;
        }
        let found = cursor
            .triangle(self.mesh.triangles.len())
            .and_then(|start| self.walk(p, start))
            .or_else(|| self.look_up(p))?;
        *cursor = Cursor::at(found);
        Some(found)
    }

    /// Walks towards `p`; `None` at a border or after too many steps.
    fn walk(&self, p: V2, start: usize) -> Option<usize> {
        let mut triangle = start;
        for _ in 0..PATIENCE {
            let corners = self.corners(triangle);
            let outside = (0..3).find(|&k| orient(corners[k], corners[(k + 1) % 3], p) < 0.0);
            let Some(k) = outside else {
                return Some(triangle);
            };
            let next = self.mesh.neighbours[triangle][k];
            if next & BORDER != 0 {
                return None;
            }
            triangle = next as usize;
        }
        None
    }

    /// Finds `p` among the triangles of its grid cell: the one that contains
    /// it best.
    fn look_up(&self, p: V2) -> Option<usize> {
        let mut best = (f64::NEG_INFINITY, usize::MAX);
        for &triangle in self.grid.candidates(p) {
            let corners = self.corners(triangle as usize);
            let mut depth = f64::INFINITY;
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                depth = depth.min(orient(a, b, p) / (b - a).norm());
            }
            if depth > best.0 {
                best = (depth, triangle as usize);
            }
            if depth >= 0.0 {
                break;
            }
        }
        // Behind a sharp corner a point can be near all three lines of a
        // triangle and yet far from the triangle itself.
        let slack = 1e-10 * self.frame.size;
        (best.0 >= 0.0 || (best.0 >= -slack && self.touches(best.1, p, slack))).then_some(best.1)
    }

    fn touches(&self, triangle: usize, p: V2, slack: f64) -> bool {
        let corners = self.corners(triangle);
        (0..3).any(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            (p - nearest_on_segment(p, a, b)).norm() <= slack
        })
    }

    /// Follows the segment through the mesh to the border it first crosses.
    pub(crate) fn exit(&self, from: V2, to: V2, cursor: &mut Cursor) -> Option<Exit> {
        let Some(start) = self.locate(from, cursor) else {
            return Some(self.nearest_boundary(from));
        };
        let mut last = start;
        let border = self.traverse(start, from, to, |triangle| last = triangle);
        *cursor = Cursor::at(last);
        border.map(|border| self.crossing(border, from, to))
    }

    /// Calls `visit` with each triangle on the way from `start`, in which
    /// `from` lies, along the segment; gives the border that the way ends at.
    fn traverse(
        &self,
        start: usize,
        from: V2,
        to: V2,
        mut visit: impl FnMut(usize),
    ) -> Option<usize> {
        let mut triangle = start;
        let mut entered = usize::MAX;
        // A straight line meets a triangle once.
        for _ in 0..=self.mesh.triangles.len() {
            visit(triangle);
            let corners = self.corners(triangle);
            let beyond: [f64; 3] =
                std::array::from_fn(|k| orient_exact(corners[k], corners[(k + 1) % 3], to));
            if beyond.iter().all(|&side| side >= 0.0) {
                break;
            }
            let side = corners.map(|corner| orient_exact(from, to, corner));
            let crossed = (0..3)
                .filter(|&k| k != entered && beyond[k] < 0.0)
                .find(|&k| side[k] <= 0.0 && side[(k + 1) % 3] >= 0.0)
                // `from` may lie outside its triangle by the tolerance of
                // location: then leave by the edge that `to` is farthest behind.
                .or_else(|| {
                    (0..3)
                        .filter(|&k| k != entered && beyond[k] < 0.0)
                        .min_by(|&a, &b| beyond[a].total_cmp(&beyond[b]))
                });
            let k = crossed?;
            let next = self.mesh.neighbours[triangle][k];
            if next & BORDER != 0 {
                return Some((next & !BORDER) as usize);
            }
            let shared = self.mesh.triangles[triangle][(k + 1) % 3];
            triangle = next as usize;
            entered = (0..3)
                .find(|&j| self.mesh.triangles[triangle][j] == shared)
                .unwrap_or(usize::MAX);
        }
        None
    }

    /// Calls `visit` with each triangle that the segment passes through and
    /// the part of the segment in it, as two numbers between 0 and 1.
    ///
    /// The segment may leave the domain and come back.
    pub(crate) fn follow(
        &self,
        from: V2,
        to: V2,
        cursor: &mut Cursor,
        mut visit: impl FnMut(usize, f64, f64),
    ) {
        let way = to - from;
        // Where the segment meets the boundary; between two such points it is
        // inside or outside.
        let mut cuts = vec![0.0, 1.0];
        let tree = self.edges.get_or_init(|| EdgeTree::new(&self.rings));
        tree.any_along(from, to, |ring, edge| {
            let (a, b) = self.rings[ring as usize].edge(edge as usize);
            let (one, two) = (orient(a, b, from), orient(a, b, to));
            let t = one / (one - two);
            if (0.0..=1.0).contains(&t) {
                cuts.push(t);
            }
            false
        });
        cuts.sort_by(f64::total_cmp);
        for pair in cuts.windows(2).filter(|pair| pair[1] - pair[0] > 1e-12) {
            let at = |part: f64| from + way * (pair[0] + (pair[1] - pair[0]) * part);
            // Off the boundary, where a point may be found on either side.
            let (a, b) = (at(1e-9), at(1.0 - 1e-9));
            let (Some(_), Some(start)) = (self.locate(at(0.5), cursor), self.locate(a, cursor))
            else {
                continue;
            };
            let mut last = start;
            self.traverse(start, a, b, |triangle| {
                last = triangle;
                if let Some((low, high)) = self.clip(triangle, from, way) {
                    let (low, high) = (low.max(pair[0]), high.min(pair[1]));
                    if high > low {
                        visit(triangle, low, high);
                    }
                }
            });
            *cursor = Cursor::at(last);
        }
    }

    /// The part of the line `from + t way` that lies in a triangle.
    fn clip(&self, triangle: usize, from: V2, way: V2) -> Option<(f64, f64)> {
        let corners = self.corners(triangle);
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let height = orient(a, b, from);
            let slope = wedge(b - a, way);
            if slope > 0.0 {
                low = low.max(-height / slope);
            } else if slope < 0.0 {
                high = high.min(-height / slope);
            } else if height < 0.0 {
                return None;
            }
        }
        (low < high).then_some((low, high))
    }

    /// Where the segment crosses a border, on the whole ring edge it is part
    /// of: refinement points are rounded, input edges are not.
    fn crossing(&self, border: usize, from: V2, to: V2) -> Exit {
        let border = self.mesh.borders[border];
        let (a, b) = self.rings[border.ring as usize].edge(border.edge as usize);
        let (inside, outside) = (orient(a, b, from), orient(a, b, to));
        let t = if inside > outside {
            (inside / (inside - outside)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let point = nearest_on_segment(from + (to - from) * t, a, b);
        self.named_exit(point, border.ring, border.edge)
    }

    pub(crate) fn named_exit(&self, point: V2, ring: u32, edge: u32) -> Exit {
        Exit {
            point: crate::plane::coord(point + self.frame.origin),
            ring: ring as usize,
            edge: self.rings[ring as usize].input_edge[edge as usize] as usize,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Cursor, Domain, DomainOptions};
    use geo_types::{coord, polygon};

    fn frame() -> Domain {
        let shape = polygon!(
            exterior: [(x: 0., y: 0.), (x: 10., y: 0.), (x: 10., y: 10.), (x: 0., y: 10.)],
            interiors: [[(x: 4., y: 4.), (x: 6., y: 4.), (x: 6., y: 6.), (x: 4., y: 6.)]],
        );
        Domain::new(&shape, &DomainOptions::default()).expect("valid")
    }

    #[test]
    fn the_hole_is_outside_and_borders_are_inside() {
        let domain = frame();
        let mut cursor = Cursor::default();
        assert!(domain
            .locate(coord! {x: 5.0, y: 5.0}, &mut cursor)
            .is_none());
        assert!(domain
            .locate(coord! {x: 5.0, y: -0.001}, &mut cursor)
            .is_none());
        assert!(domain
            .locate(coord! {x: f64::NAN, y: 1.0}, &mut cursor)
            .is_none());
        assert!(domain
            .locate(coord! {x: 1e300, y: -1e300}, &mut cursor)
            .is_none());
        for at in [
            coord! {x: 0.0, y: 0.0},
            coord! {x: 3.3, y: 10.0},
            coord! {x: 4.0, y: 5.1},
        ] {
            assert!(domain.locate(at, &mut cursor).is_some());
        }
    }

    #[test]
    fn a_segment_leaves_by_the_first_edge_it_meets() {
        let domain = frame();
        let mut cursor = Cursor::default();
        let from = coord! {x: 1.0, y: 5.0};
        let exit = domain
            .exit(from, coord! {x: 20.0, y: 5.0}, &mut cursor)
            .expect("leaves");
        // The hole's west side is edge 3 of its ring.
        assert_eq!((exit.ring, exit.edge), (1, 3));
        assert_eq!(exit.point, coord! {x: 4.0, y: 5.0});
        let exit = domain
            .exit(from, coord! {x: 1.0, y: 20.0}, &mut cursor)
            .expect("leaves");
        assert_eq!((exit.ring, exit.edge), (0, 2));
        assert!(domain
            .exit(from, coord! {x: 3.9, y: 9.9}, &mut cursor)
            .is_none());
        // From the boundary inwards is not an exit, outwards is one at once.
        let start = coord! {x: 0.0, y: 5.0};
        assert!(domain.exit(start, from, &mut cursor).is_none());
        let exit = domain
            .exit(start, coord! {x: -1.0, y: 5.0}, &mut cursor)
            .expect("leaves");
        assert_eq!((exit.point, exit.edge), (start, 3));
    }
}
