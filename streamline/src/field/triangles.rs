//! A cross field on a triangulation.

use super::cells::{Cells, INSIDE};
use super::edges::Edges;
use super::mesh::{Mesh, MeshError};
use super::{arm_nearest, Cursor, DirectionField, Exit};
use crate::vector::{cross, dot, is_finite, left, norm, Point};
use geo_types::{Coord, LineString, Polygon};
use rstar::{primitives::GeomWithData, primitives::Rectangle, RTree, AABB};
use std::collections::BTreeMap;
use std::fmt;

/// A cross field given by one vector per vertex of a plane triangulation and
/// interpolated between them.
///
/// The vector of a cross with an arm at angle u is r (cos 4u, sin 4u), the same
/// for all four arms. Vectors are interpolated linearly over each triangle, so
/// that the cross is continuous; where the sum vanishes, the field is singular.
/// Coordinates are in metres; the length r is a weight, of any unit.
///
/// It is a [`DirectionField`] for [`trace`](crate::trace), and what
/// [`EdgeMaps`](crate::EdgeMaps) traces without ever crossing lines.
///
/// # Examples
///
/// ```
/// use streamline::geo_types::{coord, Coord};
/// use streamline::{DirectionField, TriangleField};
///
/// let points = vec![coord! { x: 0., y: 0. }, coord! { x: 9., y: 0. }, coord! { x: 0., y: 9. }];
/// let turned = |u: f64| coord! { x: (4. * u).cos(), y: (4. * u).sin() };
/// let field = TriangleField::new(points, vec![[0, 1, 2]], vec![turned(0.2); 3])?;
/// let east = coord! { x: 1., y: 0. };
/// let arm = field.direction(coord! { x: 2., y: 3. }, east, &mut Default::default()).expect("inside");
/// assert!((arm.y - 0.2_f64.sin()).abs() < 1e-12);
/// # Ok::<(), streamline::MeshError>(())
/// ```
#[derive(Clone)]
pub struct TriangleField {
    mesh: Mesh,
    cells: Cells,
    tree: RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>,
    border: Edges,
    rings: Vec<Vec<usize>>,
    labels: BTreeMap<(usize, usize), (usize, usize)>,
}

impl TriangleField {
    /// A field from points, triangles (three indices each, either way round)
    /// and one vector per point: zero at a singularity.
    ///
    /// # Errors
    ///
    /// A [`MeshError`] where lengths differ, a number is not finite, an index
    /// does not exist, a triangle is flat, or two lie on one side of an edge.
    ///
    /// # Complexity
    ///
    /// O(n log n) in the number of triangles.
    pub fn new(
        points: Vec<Coord<f64>>,
        triangles: Vec<[usize; 3]>,
        vectors: Vec<Coord<f64>>,
    ) -> Result<Self, MeshError> {
        Ok(Self::of(Mesh::new(points, vectors, triangles)?))
    }

    fn of(mesh: Mesh) -> Self {
        let boxes = mesh.triangles.iter().enumerate().map(|(i, corners)| {
            let [a, b, c] = corners.map(|v| mesh.points[v]);
            let low = [a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y)];
            let high = [a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y)];
            GeomWithData::new(Rectangle::from_corners(low, high), i)
        });
        let tree = RTree::bulk_load(boxes.collect());
        let rings = mesh.rings();
        let mut labels = BTreeMap::new();
        for (ring, vertices) in rings.iter().enumerate() {
            for (edge, &u) in vertices.iter().enumerate() {
                let v = vertices[(edge + 1) % vertices.len()];
                labels.insert((u.min(v), u.max(v)), (ring, edge));
            }
        }
        let mut lines = rings
            .iter()
            .map(|ring| LineString(ring.iter().map(|&v| mesh.points[v]).collect()));
        let outer = lines.next().unwrap_or(LineString(Vec::new()));
        let border = Edges::new(&Polygon::new(outer, lines.collect()));
        let cells = Cells::new(&mesh);
        Self {
            mesh,
            cells,
            tree,
            border,
            rings,
            labels,
        }
    }

    /// The points, in metres.
    #[must_use]
    pub fn points(&self) -> &[Coord<f64>] {
        &self.mesh.points
    }

    /// The triangles, all counterclockwise.
    #[must_use]
    pub fn triangles(&self) -> &[[usize; 3]] {
        &self.mesh.triangles
    }

    /// The vectors, one per point.
    #[must_use]
    pub fn vectors(&self) -> &[Coord<f64>] {
        &self.mesh.vectors
    }

    /// The border: rings of vertices with the domain to their left, the outer
    /// one first. Edge `i` of a ring runs from its vertex `i` to the next: so
    /// [`Stop::Boundary`](crate::Stop) and [`Exit`] count.
    #[must_use]
    pub fn rings(&self) -> &[Vec<usize>] {
        &self.rings
    }

    /// The same field on four times the triangles, each cut at the middles of
    /// its sides.
    ///
    /// Points keep their indices, new ones follow; edge `i` of a ring becomes
    /// the edges `2 i` and `2 i + 1`. Interpolated vectors do not change.
    #[must_use]
    pub fn refined(&self) -> Self {
        let (mesh, count) = (&self.mesh, self.mesh.points.len());
        let (mut points, mut vectors) = (mesh.points.clone(), mesh.vectors.clone());
        for e in &mesh.edges {
            points.push(mesh.points[e.a] + (mesh.points[e.b] - mesh.points[e.a]) * 0.5);
            vectors.push((mesh.vectors[e.a] + mesh.vectors[e.b]) * 0.5);
        }
        let mut triangles = Vec::with_capacity(4 * mesh.triangles.len());
        for (&[a, b, c], edges) in mesh.triangles.iter().zip(&mesh.edges_of) {
            let [ab, bc, ca] = edges.map(|e| count + e);
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        // Halving a triangle that is far from flat leaves it so, unless it is
        // at the limit of the numbers: then it stays whole.
        match Mesh::new(points, vectors, triangles) {
            Ok(mesh) => Self::of(mesh),
            Err(_) => self.clone(),
        }
    }

    pub(crate) fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Ring and edge of a border edge between two vertices.
    pub(crate) fn label(&self, a: usize, b: usize) -> Option<(usize, usize)> {
        self.labels.get(&(a.min(b), a.max(b))).copied()
    }

    /// The triangle that holds `at` with its barycentric coordinates there; on
    /// a shared edge or vertex the first.
    pub(crate) fn locate(&self, at: Point) -> Option<(usize, [f64; 3])> {
        let (place, weights) = self.find(at, usize::MAX)?;
        Some((self.cells.triangle(place), weights))
    }

    /// [`locate`](Self::locate) with places among the cells for triangles. The
    /// answer does not depend on `hint`.
    #[inline]
    fn find(&self, at: Point, hint: usize) -> Option<(usize, [f64; 3])> {
        if !is_finite(at) {
            return None;
        }
        self.cells.find(at, hint).or_else(|| self.search(at))
    }

    /// The place of the triangle that holds `at`, and the vector there; `None`
    /// outside, and where the field is singular.
    #[inline]
    fn vector(&self, at: Point, cursor: &mut Cursor) -> Option<(usize, Point)> {
        let (place, weights) = self.find(at, cursor.0 as usize)?;
        cursor.0 = place as u64;
        let vectors = self.cells.vectors(place);
        let sum = vectors[0] * weights[0] + vectors[1] * weights[1] + vectors[2] * weights[2];
        // Below this the sum is rounding, and its angle means nothing.
        let clear = || {
            let largest = vectors.iter().map(|&v| norm(v)).fold(0.0, f64::max);
            norm(sum) > 1e-14 * largest
        };
        // Nearly always far above it, which squares tell sooner.
        let square = dot(sum, sum);
        let far = vectors.iter().all(|&v| dot(v, v) < 1e6 * square) && square > 1e-200;
        (far || clear()).then_some((place, sum))
    }

    /// The answer from the tree.
    #[cold]
    fn search(&self, at: Point) -> Option<(usize, [f64; 3])> {
        // Points on the border are rounded off it by as much as this.
        let skin = 1e-15 * (at.x.abs() + at.y.abs()) + 1e-12 * self.border.size;
        let near = AABB::from_corners([at.x - skin, at.y - skin], [at.x + skin, at.y + skin]);
        let holds = |t: usize| {
            let weights = self.cells.weights(self.cells.place(t), at);
            let outside = (0..3).map(|i| {
                let side = self.mesh.along(t, (i + 1) % 3);
                let other = self.mesh.along(t, i);
                // Distance beyond side i + 1, opposite to vertex i.
                -weights[i] * cross(other, side).abs() / norm(side)
            });
            (outside.fold(f64::NEG_INFINITY, f64::max) <= skin).then_some((t, weights))
        };
        self.tree
            .locate_in_envelope_intersecting(&near)
            .filter_map(|found| holds(found.data))
            .min_by_key(|found| (found.1.iter().any(|&w| w <= INSIDE), found.0))
            .map(|(triangle, weights)| (self.cells.place(triangle), weights))
    }
}

impl fmt::Debug for TriangleField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TriangleField")
            .field("points", &self.mesh.points.len())
            .field("triangles", &self.mesh.triangles.len())
            .field("rings", &self.rings.len())
            .finish_non_exhaustive()
    }
}

impl DirectionField for TriangleField {
    fn direction(
        &self,
        at: Coord<f64>,
        heading: Coord<f64>,
        cursor: &mut Cursor,
    ) -> Option<Coord<f64>> {
        let (_, vector) = self.vector(at, cursor)?;
        Some(arm_of(vector, heading))
    }

    fn exit(&self, from: Coord<f64>, to: Coord<f64>, _: &mut Cursor) -> Option<Exit> {
        self.border.exit(from, to)
    }

    /// Exact: that of the interpolated field, which has a kink at every edge,
    /// so that its divergence jumps there; on the edge itself it is that of the
    /// first triangle.
    fn divergence(&self, at: Coord<f64>, heading: Coord<f64>, cursor: &mut Cursor) -> Option<f64> {
        let (place, vector) = self.vector(at, cursor)?;
        let normal = left(arm_of(vector, heading));
        let change = self.cells.slope(place, normal);
        // The vector turns four times as fast as the arms.
        Some(0.25 * cross(vector, change) / dot(vector, vector))
    }
}

fn arm_of(vector: Point, heading: Point) -> Point {
    arm_nearest(0.25 * vector.y.atan2(vector.x), heading)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::point;

    /// A square of side 2 about the origin with a vertex in its middle, each
    /// cross along the polar angle.
    fn polar() -> TriangleField {
        let points = vec![
            point(-1., -1.),
            point(1., -1.),
            point(1., 1.),
            point(-1., 1.),
            point(0.1, 0.0),
        ];
        let vector = |p: &Point| {
            let u = 4.0 * p.y.atan2(p.x);
            point(u.cos(), u.sin())
        };
        let vectors = points.iter().map(vector).collect();
        let triangles = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        TriangleField::new(points, triangles, vectors).unwrap()
    }

    #[test]
    fn refining_changes_no_direction() {
        let (coarse, east) = (polar(), point(1.0, 0.3));
        let fine = coarse.refined().refined();
        assert_eq!(fine.triangles().len(), 64);
        assert_eq!(fine.rings()[0].len(), 16);
        for i in 0..20 {
            for j in 0..20 {
                let at = point(-1.0 + 0.1 * i as f64, -1.0 + 0.1003 * j as f64);
                let arm = |f: &TriangleField| f.direction(at, east, &mut Cursor::default());
                match (arm(&coarse), arm(&fine)) {
                    (Some(a), Some(b)) => assert!(norm(a - b) < 1e-9, "{at:?}: {a:?} {b:?}"),
                    (a, b) => assert_eq!(a, b),
                }
            }
        }
    }

    #[test]
    fn the_hint_does_not_matter() {
        let field = polar().refined();
        for i in 0..=8 {
            for j in 0..=8 {
                let at = point(-1.0 + 0.25 * i as f64, -1.0 + 0.25 * j as f64);
                let plain = field.find(at, usize::MAX);
                assert!(plain.is_some(), "{at:?}");
                for hint in 0..field.triangles().len() {
                    assert_eq!(field.find(at, hint), plain);
                }
            }
        }
        assert_eq!(field.find(point(1.1, 0.0), 0), None);
        assert_eq!(field.find(point(f64::NAN, 0.0), 0), None);
    }

    #[test]
    fn divergence_is_that_of_the_interpolated_field() {
        /// The same directions without the exact divergence.
        struct Plain<'a>(&'a TriangleField);
        impl DirectionField for Plain<'_> {
            fn direction(&self, at: Point, heading: Point, cursor: &mut Cursor) -> Option<Point> {
                self.0.direction(at, heading, cursor)
            }
            fn exit(&self, _: Point, _: Point, _: &mut Cursor) -> Option<Exit> {
                None
            }
            fn difference_step(&self) -> f64 {
                1e-5
            }
        }
        // Unequal vectors that turn from each to the next.
        let mesh = polar();
        let vector = |(i, p): (usize, &Point)| {
            let u = 4.0 * (0.3 * p.x - 0.17 * p.y + 0.05 * i as f64);
            point(u.cos(), u.sin()) * (1.0 + 0.2 * i as f64)
        };
        let vectors = mesh.points().iter().enumerate().map(vector).collect();
        let (points, triangles) = (mesh.points().to_vec(), mesh.triangles().to_vec());
        let field = TriangleField::new(points, triangles, vectors).unwrap();
        let cursor = &mut Cursor::default();
        let mut most = 0.0_f64;
        for i in 0..40 {
            // Off all edges, on which the two may differ.
            let u = 0.1 + 0.157 * i as f64;
            let (at, heading) = (point(0.7 * u.cos(), 0.7 * u.sin()), point(1.0, 0.4));
            let exact = field.divergence(at, heading, cursor).unwrap();
            let plain = Plain(&field).divergence(at, heading, cursor).unwrap();
            assert!(
                (exact - plain).abs() < 1e-7 * (1.0 + exact.abs()),
                "{exact} {plain}"
            );
            let back = field.divergence(at, heading * -1.0, cursor).unwrap();
            assert_eq!(back, -exact);
            most = most.max(exact.abs());
        }
        assert!(most > 0.1, "{most}");
        assert_eq!(
            field.divergence(point(3.0, 0.0), point(1.0, 0.0), cursor),
            None
        );
    }

    #[test]
    fn walks_end_where_the_tree_says() {
        // 1,024 triangles, more than a walk goes through.
        let mut field = polar();
        for _ in 0..4 {
            field = field.refined();
        }
        for i in 0..2000 {
            let at = |k: usize, n: usize| 1.05 * ((i * k % n) as f64 / n as f64 * 2.0 - 1.0);
            let p = point(at(797, 1999), at(1021, 1993));
            let expected = field.search(p);
            for hint in [0, i % 1024, usize::MAX] {
                assert_eq!(field.find(p, hint), expected, "{p:?} from {hint}");
            }
        }
    }

    #[test]
    fn exits_bear_the_labels_of_the_rings() {
        let field = polar();
        let exit = field
            .exit(point(0.0, 0.5), point(5.0, 0.5), &mut Cursor::default())
            .unwrap();
        assert_eq!((exit.ring, exit.edge), (0, 1));
        assert_eq!(field.label(2, 1), Some((0, 1)));
        assert_eq!(field.label(4, 1), None);
    }
}
