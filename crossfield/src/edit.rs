//! Fields from fields: blends, local smoothing, and strokes on what is there.
//!
//! All of it happens on representation vectors, never on angles, and what is
//! not meant stays as it is, bit for bit.

use geo_types::{Coord, Polygon};
use rstar::primitives::Line;
use rstar::RTree;
use sprs::CsMatI;

use crate::constraint::{Constraint, Pulls, Stroke};
use crate::factor;
use crate::field::Field;
use crate::operators::{edge_weights, Laplacian};
use crate::plane::{vector, V2};
use crate::system::to_unit;
use crate::FieldError;

impl Field {
    /// The convex blend of several fields on one domain: at each vertex the
    /// mean of their representation vectors by the given weights, scaled to
    /// unit length.
    ///
    /// Where the vectors cancel, the blend is singular.
    ///
    /// ```
    /// use crossfield::{geo_types::polygon, BoundaryField, DistanceField, Domain, DomainOptions,
    ///     Field, FieldDesign};
    ///
    /// let site = polygon![(x: 0., y: 0.), (x: 90., y: 0.), (x: 70., y: 60.), (x: 0., y: 50.)];
    /// let domain = Domain::new(&site, &DomainOptions::default())?;
    /// let straight = DistanceField::default().design(&domain)?;
    /// let smooth = BoundaryField::default().design(&domain)?;
    /// let between = Field::blend(&[(&straight, 0.3), (&smooth, 0.7)])?;
    /// assert!(between.energy() < straight.energy());
    /// # Ok::<(), crossfield::FieldError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if there is no field, they differ in mesh or
    /// symmetry, or the weights are negative, not finite, or all 0.
    pub fn blend(fields: &[(&Self, f64)]) -> Result<Self, FieldError> {
        let Some(&(first, _)) = fields.first() else {
            return Err(FieldError::option("fields", "is empty; give one or more"));
        };
        let total: f64 = fields.iter().map(|(_, weight)| weight).sum();
        let fair = |w: f64| w >= 0.0 && w.is_finite();
        let all_fair = fields.iter().all(|&(_, w)| fair(w));
        if !(all_fair && total > 0.0 && total.is_finite()) {
            return Err(FieldError::option(
                "weights",
                "of a blend are to be finite and not negative, and one of them positive",
            ));
        }
        let mut sums = vec![V2::zeros(); first.domain().vertex_count()];
        for &(field, weight) in fields {
            first.same_ground(field)?;
            for (sum, d) in sums.iter_mut().zip(field.vectors()) {
                *sum += d * (weight / total);
            }
        }
        Ok(Self::from_vectors(first.domain(), sums)?.of_symmetry(first.symmetry()))
    }

    /// A blend whose shares change from place to place: `share` of `other` at
    /// each vertex, from 0 to 1, and the rest of this field.
    ///
    /// Where `share` is 0 or 1 the result is the one field or the other, to
    /// the bit.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if the fields differ in mesh or symmetry, or
    /// a share is not between 0 and 1.
    pub fn blend_by(
        &self,
        other: &Self,
        share: impl Fn(Coord<f64>) -> f64,
    ) -> Result<Self, FieldError> {
        self.same_ground(other)?;
        let mut vectors = self.vectors().to_vec();
        for (v, d) in vectors.iter_mut().enumerate() {
            let part = share(self.domain().vertex(v));
            if !(0.0..=1.0).contains(&part) {
                return Err(FieldError::option(
                    "share",
                    format!("is {part} at vertex {v}; give 0 to 1"),
                ));
            }
            // Exactly so at both ends.
            *d = *d * (1.0 - part) + other.vectors()[v] * part;
        }
        Ok(Self::from_vectors(self.domain(), vectors)?.of_symmetry(self.symmetry()))
    }

    /// The field made as smooth as can be inside `region`, and left as it is
    /// elsewhere.
    ///
    /// The inner vertices of the mesh in the region take the least energy
    /// that their surroundings allow (each component harmonic, then scaled to
    /// unit length, as in a B-field); those on the boundary stay aligned. A
    /// singularity stays if the surroundings wind around it.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if the region has a coordinate that is not
    /// finite; [`FieldError::SingularSystem`] if the solution does not satisfy
    /// the system.
    pub fn smoothed_inside(&self, region: &Polygon<f64>) -> Result<Self, FieldError> {
        let coords = region.exterior().0.iter();
        let all = coords.chain(region.interiors().iter().flat_map(|ring| &ring.0));
        for c in all {
            if !(c.x.is_finite() && c.y.is_finite()) {
                return Err(FieldError::option(
                    "region",
                    format!("has a vertex ({}, {}); give finite numbers", c.x, c.y),
                ));
            }
        }
        let domain = self.domain();
        let free: Vec<usize> = domain
            .inner_vertices()
            .filter(|&v| contains(region, domain.vertex(v)))
            .collect();
        let count = domain.vertex_count();
        let nothing = (vec![0.0; count], vec![V2::zeros(); count]);
        let solved = self.relaxed(&free, self.vectors(), &nothing.0, &nothing.1)?;
        self.with_vertices(&free, solved)
    }

    /// The field bent so that it follows strokes, within `reach` metres of
    /// them, and left as it is elsewhere.
    ///
    /// Not the field but its change is as smooth as can be: it is that of
    /// the strokes where these lie and fades to nothing at the reach, so that
    /// what the field does on its own stays in it. Vertices on the boundary
    /// of the domain stay aligned. A stroke's
    /// [`weight`](Stroke::weight) is weighed against the smoothness of the
    /// change: 100 follows it closely.
    ///
    /// ```
    /// use crossfield::{geo_types::{coord, line_string, polygon}, BoundaryField, Cross, Cursor,
    ///     Domain, DomainOptions, FieldDesign, Stroke};
    ///
    /// let site = polygon![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 60.), (x: 0., y: 60.)];
    /// let domain = Domain::new(&site, &DomainOptions::default())?;
    /// let field = BoundaryField::default().design(&domain)?;
    /// let lane = Stroke::new(line_string![(x: 20., y: 25.), (x: 40., y: 35.)], 300.0);
    /// let edited = field.edited(&[lane], 15.0)?;
    /// let angle = |x, y| {
    ///     let cross = edited.cross(coord! { x: x, y: y }, &mut Cursor::default());
    ///     cross.expect("inside").angle()
    /// };
    /// assert!((angle(30.0, 30.0) - 0.5_f64.atan()).abs() < 0.1);
    /// assert!(angle(80.0, 30.0).abs() < 1e-9);
    /// # Ok::<(), crossfield::FieldError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if the reach is not positive and finite, or a
    /// stroke has no length, no finite coordinates or no positive weight;
    /// [`FieldError::SingularSystem`] if the solution does not satisfy the
    /// system.
    pub fn edited(&self, strokes: &[Stroke], reach: f64) -> Result<Self, FieldError> {
        if !(reach > 0.0 && reach.is_finite()) {
            return Err(FieldError::option(
                "reach",
                format!("is {reach}; give metres, more than 0"),
            ));
        }
        let domain = self.domain();
        let count = domain.vertex_count();
        let (mut masses, mut pulls) = (vec![0.0; count], vec![V2::zeros(); count]);
        let mut collected = Pulls::new(
            domain,
            self.symmetry(),
            Laplacian::Cotangent,
            &mut masses,
            &mut pulls,
        );
        for stroke in strokes {
            stroke.pull(&mut collected)?;
        }
        let tree = segments(strokes);
        let free: Vec<usize> = domain
            .inner_vertices()
            .filter(|&v| {
                let at = domain.vertex(v);
                let near = tree.locate_within_distance([at.x, at.y], reach * reach);
                near.into_iter().next().is_some()
            })
            .collect();
        // The change pulls towards what is missing.
        for (v, pull) in pulls.iter_mut().enumerate() {
            *pull -= self.vectors()[v] * masses[v];
        }
        let still = vec![V2::zeros(); count];
        let mut solved = self.relaxed(&free, &still, &masses, &pulls)?;
        for (d, &v) in solved.iter_mut().zip(&free) {
            *d += self.vectors()[v];
        }
        self.with_vertices(&free, solved)
    }

    /// Refuses another mesh or symmetry.
    fn same_ground(&self, other: &Self) -> Result<(), FieldError> {
        if !self.domain().is_same(other.domain()) {
            return Err(FieldError::option(
                "fields",
                "live on different domains; design them on clones of one",
            ));
        }
        if self.symmetry() != other.symmetry() {
            return Err(FieldError::option(
                "fields",
                format!(
                    "have {} and {} arms; blend fields of one symmetry",
                    self.symmetry().folds(),
                    other.symmetry().folds()
                ),
            ));
        }
        Ok(())
    }

    /// This field with other vectors, scaled to unit length, at some vertices.
    fn with_vertices(&self, free: &[usize], mut solved: Vec<V2>) -> Result<Self, FieldError> {
        to_unit(&mut solved);
        let mut vectors = self.vectors().to_vec();
        for (&v, d) in free.iter().zip(solved) {
            vectors[v] = d;
        }
        Ok(Self::from_vectors(self.domain(), vectors)?.of_symmetry(self.symmetry()))
    }

    /// The vectors at the vertices `free` (ascending) of least
    /// `sum w_ij |x_i - x_j|^2 + sum (m_i |x_i|^2 - 2 pull_i . x_i)`, those of
    /// `fixed` at all others.
    fn relaxed(
        &self,
        free: &[usize],
        fixed: &[V2],
        masses: &[f64],
        pulls: &[V2],
    ) -> Result<Vec<V2>, FieldError> {
        if free.is_empty() {
            return Ok(Vec::new());
        }
        let adjacency = &self.domain().inner.adjacency;
        let weights = edge_weights(self.domain(), Laplacian::Cotangent);
        let mut number = vec![u32::MAX; fixed.len()];
        for (k, &v) in free.iter().enumerate() {
            number[v] = k as u32;
        }
        let (mut starts, mut rows, mut values) = (vec![0_u32], Vec::new(), Vec::new());
        let mut columns = [Vec::new(), Vec::new()];
        for (k, &v) in free.iter().enumerate() {
            let mut diagonal = masses[v];
            let mut pull = pulls[v];
            for (&w, &weight) in adjacency.of(v).iter().zip(&weights[adjacency.row(v)]) {
                diagonal += weight;
                let other = number[w as usize];
                if other == u32::MAX {
                    pull += fixed[w as usize] * weight;
                } else if (other as usize) < k {
                    rows.push(other);
                    values.push(-weight);
                }
            }
            rows.push(k as u32);
            values.push(diagonal);
            starts.push(rows.len() as u32);
            columns[0].push(pull.x);
            columns[1].push(pull.y);
        }
        let matrix = CsMatI::new_csc((free.len(), free.len()), starts, rows, values);
        factor::solve(&matrix, &mut columns)?;
        let [x, y] = columns;
        Ok(x.into_iter().zip(y).map(|(x, y)| V2::new(x, y)).collect())
    }
}

/// A tree over the segments of all strokes.
fn segments(strokes: &[Stroke]) -> RTree<Line<[f64; 2]>> {
    let lines = strokes.iter().flat_map(|stroke| stroke.line.lines());
    let lines = lines.filter(|l| l.start != l.end);
    RTree::bulk_load(
        lines
            .map(|l| Line::new([l.start.x, l.start.y], [l.end.x, l.end.y]))
            .collect(),
    )
}

/// Whether `at` lies in the polygon, by the even-odd rule over all its rings.
fn contains(polygon: &Polygon<f64>, at: Coord<f64>) -> bool {
    let p = vector(at);
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    rings
        .flat_map(geo_types::LineString::lines)
        .filter(|line| {
            let (a, b) = (vector(line.start), vector(line.end));
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
        })
        .count()
        % 2
        == 1
}
