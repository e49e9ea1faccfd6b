//! The second tracer: consistent by construction.

mod lanes;
mod options;
mod passed;
mod walk;

pub use options::EdgeOptions;

use super::Stop;
use crate::error::TraceError;
use crate::field::mesh::Mesh;
use crate::field::TriangleField;
use crate::streamline::Streamline;
use crate::vector::{cross, dot, is_finite, norm, unit, Point};
use geo_types::Coord;
use lanes::Lanes;
use passed::Passed;
use walk::Start;

/// A [`TriangleField`] prepared for lines that can neither merge nor cross at
/// less than 45 degrees, one another or themselves.
///
/// In each triangle the lines of one family (an arm and its opposite) are
/// parallels along the field in its middle. Where the directions on the two
/// sides of an edge would both lead into it, or both out of it, one of them is
/// turned until they agree, by less than 45 degrees. So each edge is crossed
/// one way by each family, and each triangle maps the points where lines enter
/// it to those where they leave it, one to one and in order. A line is a walk
/// through these maps: there is no step length and no tolerance, and going back
/// retraces it.
///
/// # What holds
///
/// - Lines of one family in a triangle are parallel: they do not cross. Lines
///   of two families meet there at 45 degrees at least.
/// - Lines do not merge, as long as numbers resolve them: where a field pulls
///   lines together, their distance may fall below rounding (about 1e-16 of an
///   edge), and from there on they coincide. Their order never changes.
/// - The seed of a line closed with [`EdgeOptions::loop_tolerance`] above zero
///   may be reached by a step aside of that length, to which this does not
///   apply.
///
/// # Singularities
///
/// A triangle about which the cross turns is cut into three at the point where
/// the interpolated vectors vanish; lines pass by it on all sides, and those
/// that come within [`EdgeOptions::singular_radius`] end there. Where the field
/// is too coarse for its mesh to let two neighbours agree, one of them is
/// *blocked*: lines end at its edge, also with [`Stop::Singularity`]. See
/// [`blocked`](Self::blocked); [`TriangleField::refined`] helps.
///
/// # Accuracy
///
/// First order in the size of the triangles (measured: 1.4 to 1.9; on circles
/// of 90 to 170 m radius off by .5 m after half a round over 10 m triangles):
/// use [`trace`](crate::trace) where accuracy counts, or refine.
///
/// # References
///
/// H. Bhatia, S. Jadhav, P.-T. Bremer, G. Chen, J. A. Levine, L. G. Nonato,
/// V. Pascucci, *Flow visualization with quantified spatial and temporal errors
/// using edge maps*, IEEE TVCG 18 (2012); N. Ray, D. Sokolov, *Robust polylines
/// tracing for N-symmetry direction field on triangulated surfaces*, ACM Trans.
/// Graph. 33 (2014). Both divide edges where the field touches them; here an
/// edge is crossed one way as a whole, and the triangle's direction yields.
///
/// # Examples
///
/// ```
/// use streamline::geo_types::coord;
/// use streamline::{EdgeMaps, EdgeOptions, Stop, TriangleField};
///
/// let points = vec![
///     coord! { x: 0., y: 0. }, coord! { x: 9., y: 0. }, coord! { x: 9., y: 9. }, coord! { x: 0., y: 9. },
/// ];
/// // Axis-parallel crosses everywhere.
/// let field = TriangleField::new(points, vec![[0, 1, 2], [0, 2, 3]], vec![coord! { x: 1., y: 0. }; 4])?;
/// let east = EdgeMaps::new(&field)
///     .trace(coord! { x: 2., y: 5. }, coord! { x: 1., y: 0.2 }, &EdgeOptions::default())?;
/// assert_eq!(east.line.end, Stop::Boundary { ring: 0, edge: 1 });
/// assert_eq!(east.edges, [[0, 3], [0, 2], [1, 2]]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct EdgeMaps<'a> {
    field: &'a TriangleField,
    /// The field's mesh with singular triangles cut in three: the first stays
    /// in place, the two others are at the end.
    mesh: Mesh,
    lanes: Lanes,
    /// Of each triangle of the field the first of its two additional ones.
    cut: Vec<Option<usize>>,
    /// Diagonal of the bounding box.
    size: f64,
}

/// A line traced by [`EdgeMaps`], with the edges it crosses.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EdgeLine {
    /// The line: its points are where it meets edges, and its seed.
    pub line: Streamline,
    /// The edges it meets, from start to end, each by its two vertices, the
    /// lower first: one a point, but for the seed and for ends within a
    /// triangle; through a vertex several share a point. Indices from the number of the field's points on stand for
    /// the singular points within triangles.
    pub edges: Vec<[usize; 2]>,
}

impl<'a> EdgeMaps<'a> {
    /// Prepares a field.
    ///
    /// # Complexity
    ///
    /// O(n) in the number of triangles, and a sort of the edges along which
    /// neighbours disagree.
    #[must_use]
    pub fn new(field: &'a TriangleField) -> Self {
        let (mesh, cut) = cut_singular(field.mesh());
        let lanes = Lanes::new(&mesh);
        let mut corners = [mesh.points[0]; 2];
        for p in &mesh.points {
            corners[0] = Coord {
                x: corners[0].x.min(p.x),
                y: corners[0].y.min(p.y),
            };
            corners[1] = Coord {
                x: corners[1].x.max(p.x),
                y: corners[1].y.max(p.y),
            };
        }
        Self {
            field,
            mesh,
            lanes,
            cut,
            size: norm(corners[1] - corners[0]),
        }
    }

    /// How many triangles are blocked: of the field's, and of those that its
    /// singular ones are cut into. None on a smooth field that turns by less
    /// than the angles of its triangles from one to the next.
    #[must_use]
    pub fn blocked(&self) -> usize {
        self.lanes.of.iter().filter(|lanes| lanes.is_none()).count()
    }

    /// The singular points: where interpolated vectors vanish within a
    /// triangle, and the vertices whose vector is zero. By vertex index, those
    /// within triangles last.
    #[must_use]
    pub fn singular_points(&self) -> Vec<Coord<f64>> {
        let both = self.mesh.points.iter().zip(&self.mesh.vectors);
        both.filter(|(_, v)| dot(**v, **v) == 0.0)
            .map(|(&p, _)| p)
            .collect()
    }

    /// Traces the line through `seed` both ways: along the arm nearest to
    /// `heading`, and against it.
    ///
    /// The points run as those of [`trace`](crate::trace): from the far end of
    /// the backward half over the seed to that of the forward half; but they
    /// lie where the line meets edges of the mesh. Boundary stops carry the
    /// labels of [`TriangleField::rings`].
    ///
    /// # Errors
    ///
    /// [`TraceError::BadOption`], [`TraceError::SeedNotFinite`],
    /// [`TraceError::NoHeading`], or [`TraceError::NoDirection`] where the seed
    /// lies outside the mesh or in a blocked triangle.
    ///
    /// # Complexity
    ///
    /// O(log n) for the seed, then O(1) an edge; with
    /// [`EdgeOptions::self_approach`], the passages of an edge are looked
    /// through.
    pub fn trace(
        &self,
        seed: Coord<f64>,
        heading: Coord<f64>,
        options: &EdgeOptions,
    ) -> Result<EdgeLine, TraceError> {
        options.validate()?;
        let (index, x, y) = (0, seed.x, seed.y);
        if !is_finite(seed) {
            return Err(TraceError::SeedNotFinite { index, x, y });
        }
        let heading = unit(heading).ok_or(TraceError::NoHeading {
            index,
            x: heading.x,
            y: heading.y,
        })?;
        let (triangle, arm) = self
            .enter(seed, heading)
            .ok_or_else(|| TraceError::no_direction(seed))?;
        let mut passed = Passed::default();
        let start = |arm| Start {
            seed,
            triangle,
            arm,
        };
        let forward = self.walk(start(arm), options, &mut passed);
        let (mut points, mut edges, start_stop) = if forward.stop == Stop::ClosedLoop {
            (Vec::new(), Vec::new(), Stop::ClosedLoop)
        } else {
            let mut back = self.walk(start((arm + 2) % 4), options, &mut passed);
            back.points.reverse();
            back.edges.reverse();
            (back.points, back.edges, back.stop)
        };
        points.push(seed);
        points.extend(forward.points);
        edges.extend(forward.edges);
        // Where a line runs through a vertex it meets several edges in a point.
        points.dedup();
        let line = Streamline {
            points,
            start: start_stop,
            end: forward.stop,
            seed,
            family: 0,
            seed_index: 0,
        };
        let ends = |&e: &usize| [self.mesh.edges[e].a, self.mesh.edges[e].b];
        Ok(EdgeLine {
            line,
            edges: edges.iter().map(ends).collect(),
        })
    }

    /// The triangle that holds a point, and its arm nearest to a heading.
    fn enter(&self, at: Point, heading: Point) -> Option<(usize, usize)> {
        let (whole, _) = self.field.locate(at)?;
        let parts = match self.cut[whole] {
            Some(more) => vec![whole, more, more + 1],
            None => vec![whole],
        };
        // The part in which the point lies deepest.
        let depth = |&t: &usize| {
            let beyond = |i: usize| {
                let side = self.mesh.along(t, i);
                cross(side, at - self.mesh.points[self.mesh.triangles[t][i]]) / norm(side)
            };
            beyond(0).min(beyond(1)).min(beyond(2))
        };
        let triangle = parts
            .into_iter()
            .max_by(|a, b| depth(a).total_cmp(&depth(b)).then(b.cmp(a)))?;
        self.lanes.of[triangle].as_ref()?;
        let ahead = |arm: usize| dot(self.along(triangle, arm), heading);
        let arm = (0..4).max_by(|&a, &b| ahead(a).total_cmp(&ahead(b)).then(b.cmp(&a)))?;
        Some((triangle, arm))
    }
}

/// The mesh with a vertex in each triangle about which the cross turns, where
/// the interpolated vector is zero; and where the added triangles are.
fn cut_singular(mesh: &Mesh) -> (Mesh, Vec<Option<usize>>) {
    let (mut points, mut vectors) = (mesh.points.clone(), mesh.vectors.clone());
    let mut triangles = mesh.triangles.clone();
    let mut cut = vec![None; triangles.len()];
    for (index, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        let [u, v, w] = [a, b, c].map(|i| mesh.vectors[i]);
        let weights = [cross(v, w), cross(w, u), cross(u, v)];
        // The origin lies inside the triangle of the vectors.
        let inside = weights.iter().all(|&x| x > 0.0) || weights.iter().all(|&x| x < 0.0);
        let sum: f64 = weights.iter().sum();
        if !inside || !sum.is_normal() {
            continue;
        }
        // Off the sides, which the three parts need some height over.
        let share = weights.map(|x| (x / sum).max(1e-3));
        let sum: f64 = share.iter().sum();
        let side = |i: usize| mesh.points[i] - mesh.points[a];
        points.push(mesh.points[a] + (side(b) * share[1] + side(c) * share[2]) / sum);
        vectors.push(Point::zero());
        let middle = points.len() - 1;
        cut[index] = Some(triangles.len());
        triangles[index] = [a, b, middle];
        triangles.extend([[b, c, middle], [c, a, middle]]);
    }
    match Mesh::new(points, vectors, triangles) {
        Ok(fine) => (fine, cut),
        // Triangles at the limit of the numbers stay whole, and blocked.
        Err(_) => (mesh.clone(), vec![None; mesh.triangles.len()]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::point;

    fn single(angles: [f64; 3]) -> TriangleField {
        let points = vec![point(0., 0.), point(10., 1.), point(3., 8.)];
        let vectors = angles.map(|a| point(a.cos(), a.sin())).to_vec();
        TriangleField::new(points, vec![[0, 1, 2]], vectors).unwrap()
    }

    #[test]
    fn a_singular_triangle_is_cut_where_the_field_vanishes() {
        let field = single([0.0, 2.0, 4.0]);
        let maps = EdgeMaps::new(&field);
        assert_eq!((maps.blocked(), maps.singular_points().len()), (0, 1));
        let middle = maps.singular_points()[0];
        let at = |t: f64| middle * t + point(0., 0.) * (1.0 - t);
        let line = maps
            .trace(at(0.5), point(1., 0.), &EdgeOptions::default())
            .unwrap()
            .line;
        assert!(line.points.len() >= 3);
        let plain = single([0.0, 0.1, 0.2]);
        assert!(EdgeMaps::new(&plain).singular_points().is_empty());
    }

    #[test]
    fn errors_are_named() {
        let field = single([0.0; 3]);
        let maps = EdgeMaps::new(&field);
        let (east, good) = (point(1.0, 0.0), EdgeOptions::default());
        let outside = maps.trace(point(-1., 0.), east, &good).unwrap_err();
        assert_eq!(outside, TraceError::NoDirection { x: -1.0, y: 0.0 });
        let still = maps.trace(point(3., 3.), Point::zero(), &good).unwrap_err();
        assert!(matches!(still, TraceError::NoHeading { .. }));
        let nowhere = maps.trace(point(f64::NAN, 3.), east, &good).unwrap_err();
        assert!(matches!(nowhere, TraceError::SeedNotFinite { .. }));
    }

    #[test]
    fn a_line_through_vertices_keeps_going() {
        let points = (0..9)
            .map(|i| point((i % 3) as f64, (i / 3) as f64))
            .collect();
        let cells = [0, 1, 3, 4];
        let triangles = cells
            .iter()
            .flat_map(|&i| [[i, i + 1, i + 4], [i, i + 4, i + 3]]);
        let field =
            TriangleField::new(points, triangles.collect(), vec![point(1.0, 0.0); 9]).unwrap();
        let maps = EdgeMaps::new(&field);
        assert_eq!(maps.blocked(), 0);
        for heading in [point(1., 0.), point(0., -1.)] {
            let line = maps
                .trace(point(1., 1.), heading, &EdgeOptions::default())
                .unwrap()
                .line;
            assert!(line.start.is_boundary() && line.end.is_boundary());
            assert!((line.length() - 2.0).abs() < 1e-5, "{:?}", line.points);
        }
    }

    #[test]
    fn length_limit_is_exact() {
        let field = single([0.0; 3]).refined().refined();
        let options = EdgeOptions {
            max_length: 1.25,
            ..EdgeOptions::default()
        };
        let line = EdgeMaps::new(&field)
            .trace(point(4., 3.), point(1., 0.), &options)
            .unwrap()
            .line;
        assert_eq!(
            (line.start, line.end),
            (Stop::LengthLimit, Stop::LengthLimit)
        );
        assert!((line.length() - 2.5).abs() < 1e-12);
    }
}
