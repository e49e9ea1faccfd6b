//! The result of a design: a cross at every point of a domain.

use geo_types::Coord;

use crate::cross::{Cross, SINGULAR};
use crate::domain::{Cursor, Domain};
use crate::plane::{coord, orient, vector, V2};
use crate::symmetry::{Rosy, Symmetry};
use crate::FieldError;

/// A way of designing a cross field on a domain.
///
/// Implement this for a design of your own: compute one representation vector
/// for each vertex of the domain and hand them to
/// [`Field::from_representatives`].
///
/// ```
/// use crossfield::{geo_types::Coord, Cross, Domain, Field, FieldDesign, FieldError};
///
/// /// The same cross everywhere.
/// struct Grid { angle: f64 }
///
/// impl FieldDesign for Grid {
///     fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
///         let cross = Cross::from_angle(self.angle).representative();
///         Field::from_representatives(domain, vec![cross; domain.vertex_count()])
///     }
/// }
/// ```
pub trait FieldDesign {
    /// Designs a field on `domain`.
    ///
    /// # Errors
    ///
    /// What can go wrong is the design's own to say.
    fn design(&self, domain: &Domain) -> Result<Field, FieldError>;
}

impl<T: FieldDesign + ?Sized> FieldDesign for &T {
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        (**self).design(domain)
    }
}

impl<T: FieldDesign + ?Sized> FieldDesign for Box<T> {
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        (**self).design(domain)
    }
}

/// A cross field: one representation vector for each vertex of a domain,
/// linear in between.
///
/// Or a field of any other [`Symmetry`]: then every count of quarter turns
/// below is one of N-th turns.
///
/// Cloning copies the vectors and shares the domain.
#[derive(Clone, Debug)]
pub struct Field {
    domain: Domain,
    symmetry: Symmetry,
    crosses: Vec<V2>,
    roots: Option<Roots>,
}

/// Vectors of any length whose powers are the representation vectors.
///
/// They are interpolated instead of these: a root turns more slowly around a
/// singularity, which then is one point of the mesh even where the
/// representation vectors turn more than once.
#[derive(Clone, Debug)]
struct Roots {
    vectors: Vec<V2>,
    power: u8,
}

impl Field {
    /// A field from one representation vector `(cos 4u, sin 4u)` for each
    /// vertex of `domain`, of any length.
    ///
    /// Vectors are scaled to unit length; those shorter than 1e-9 become
    /// zero, and their vertices singular.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if their number is not that of the vertices,
    /// or a component is not finite.
    pub fn from_representatives(
        domain: &Domain,
        representatives: Vec<Coord<f64>>,
    ) -> Result<Self, FieldError> {
        Self::with_symmetry(domain, Symmetry::Cross, representatives)
    }

    /// As [`Field::from_representatives`], for directions of any symmetry:
    /// vectors `(cos Nu, sin Nu)`.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn with_symmetry(
        domain: &Domain,
        symmetry: Symmetry,
        representatives: Vec<Coord<f64>>,
    ) -> Result<Self, FieldError> {
        let vectors = representatives.into_iter().map(vector).collect();
        Ok(Self::from_vectors(domain, vectors)?.of_symmetry(symmetry))
    }

    /// The same vectors, standing for directions of another symmetry.
    pub(crate) fn of_symmetry(mut self, symmetry: Symmetry) -> Self {
        self.symmetry = symmetry;
        self
    }

    pub(crate) fn from_vectors(domain: &Domain, mut crosses: Vec<V2>) -> Result<Self, FieldError> {
        if crosses.len() != domain.vertex_count() {
            return Err(FieldError::option(
                "representatives",
                format!(
                    "has {} vectors; the domain has {} vertices, give one a vertex",
                    crosses.len(),
                    domain.vertex_count()
                ),
            ));
        }
        for (v, cross) in crosses.iter_mut().enumerate() {
            let length = cross.norm();
            if !length.is_finite() {
                return Err(FieldError::option(
                    "representatives",
                    format!("is not finite at vertex {v}; give finite vectors"),
                ));
            }
            // Vectors of unit length keep their bits.
            if length < SINGULAR {
                *cross = V2::zeros();
            } else if (length - 1.0).abs() > 4.0 * f64::EPSILON {
                *cross /= length;
            }
        }
        Ok(Self {
            domain: domain.clone(),
            symmetry: Symmetry::Cross,
            crosses,
            roots: None,
        })
    }

    /// A field from vectors whose `power`-th powers (2 or 4, of their unit
    /// vectors as complex numbers) are the representation vectors. Their
    /// lengths count in the interpolation.
    pub(crate) fn from_roots(
        domain: &Domain,
        vectors: Vec<V2>,
        power: u8,
    ) -> Result<Self, FieldError> {
        let crosses = vectors.iter().map(|&root| raised(root, power)).collect();
        let mut field = Self::from_vectors(domain, crosses)?;
        field.roots = Some(Roots { vectors, power });
        Ok(field)
    }

    /// The vectors that are interpolated, and the power of them that
    /// represents the cross: the phase of D is `power` times theirs.
    pub(crate) fn roots(&self) -> (&[V2], u8) {
        match &self.roots {
            Some(roots) => (&roots.vectors, roots.power),
            None => (&self.crosses, 1),
        }
    }

    /// The domain that the field lives on.
    #[must_use]
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// How many arms its directions have; four unless it was designed
    /// otherwise.
    #[must_use]
    pub fn symmetry(&self) -> Symmetry {
        self.symmetry
    }

    /// The representation vector at vertex `v`: of unit length, or zero at a
    /// singular vertex.
    ///
    /// # Panics
    ///
    /// If `v` is not a vertex of the domain.
    #[must_use]
    pub fn representative(&self, v: usize) -> Coord<f64> {
        coord(self.crosses[v])
    }

    pub(crate) fn vectors(&self) -> &[V2] {
        &self.crosses
    }

    /// The cross at `at`, or `None` outside the domain and where the
    /// interpolated representation vector is shorter than 1e-9.
    ///
    /// `None` everywhere in a field of another symmetry, see [`Field::rosy`].
    #[must_use]
    pub fn cross(&self, at: Coord<f64>, cursor: &mut Cursor) -> Option<Cross> {
        self.rosy(at, cursor)?.as_cross()
    }

    /// The arms at `at`, whatever their symmetry; `None` outside the domain
    /// and where the interpolated representation vector is shorter than 1e-9.
    #[must_use]
    pub fn rosy(&self, at: Coord<f64>, cursor: &mut Cursor) -> Option<Rosy> {
        let triangle = self.domain.locate(at, cursor)?;
        let d = self.interpolate(triangle, self.domain.local(at));
        Rosy::from_vector(self.symmetry, d)
    }

    /// The arm at `at` that turns least from `heading`, a unit vector; `None`
    /// where there is no arm.
    #[must_use]
    pub fn direction(
        &self,
        at: Coord<f64>,
        heading: Coord<f64>,
        cursor: &mut Cursor,
    ) -> Option<Coord<f64>> {
        Some(self.rosy(at, cursor)?.arm_towards(heading))
    }

    /// Linear interpolation of the representation vectors in a triangle.
    pub(crate) fn interpolate(&self, triangle: usize, p: V2) -> V2 {
        let inner = &*self.domain.inner;
        let vertices = inner.mesh.triangles[triangle].map(|v| v as usize);
        let [a, b, c] = vertices.map(|v| inner.mesh.points[v]);
        let shares = [orient(b, c, p), orient(c, a, p), orient(a, b, p)];
        // A point that is inside but for rounding stays on the edge.
        let shares = shares.map(|share| share.max(0.0));
        let total = shares[0] + shares[1] + shares[2];
        let (vectors, power) = self.roots();
        let sum = (0..3).fold(V2::zeros(), |sum, k| sum + vectors[vertices[k]] * shares[k]);
        if total <= 0.0 {
            return self.crosses[vertices[0]];
        }
        if power == 1 {
            return sum / total;
        }
        // Short against its own terms, not absolutely: roots have any size.
        let scale: f64 = (0..3)
            .map(|k| vectors[vertices[k]].norm() * shares[k])
            .sum();
        if sum.norm() > SINGULAR * scale {
            raised(sum, power)
        } else {
            V2::zeros()
        }
    }

    /// The field after further rounds of smoothing over the inner vertices,
    /// as in [`DistanceField`](crate::DistanceField::smoothing_rounds).
    #[must_use]
    pub fn smoothed(&self, rounds: usize) -> Self {
        let mut field = self.clone();
        field.roots = None;
        smooth(&self.domain, &mut field.crosses, rounds);
        field
    }
}

/// The unit vector along `v` to the power 1, 2 or 4 as a complex number; zero
/// for a zero vector.
fn raised(v: V2, power: u8) -> V2 {
    // By its larger component first: no length may leave the range.
    let larger = v.amax();
    if larger == 0.0 {
        return v;
    }
    let mut unit = (v / larger).normalize();
    for _ in 0..power.ilog2() {
        unit = V2::new(unit.x * unit.x - unit.y * unit.y, 2.0 * unit.x * unit.y);
    }
    unit
}

/// Jacobi rounds: each inner vertex is averaged with its neighbours, itself
/// included, and scaled to unit length (supplement, section 4.1, "Smoothing").
///
/// A vertex whose average vanishes keeps its vector.
pub(crate) fn smooth(domain: &Domain, crosses: &mut Vec<V2>, rounds: usize) {
    smooth_over(domain, crosses, rounds, |_| true);
}

/// [`smooth`], with averages taken over the vertices that count only.
pub(crate) fn smooth_over(
    domain: &Domain,
    crosses: &mut Vec<V2>,
    rounds: usize,
    counts: impl Fn(usize) -> bool,
) {
    if rounds == 0 {
        return;
    }
    let inner: Vec<usize> = domain.inner_vertices().collect();
    let mut next = crosses.clone();
    for _ in 0..rounds {
        for &v in &inner {
            let neighbours = domain.neighbours(v);
            let mut sum = V2::zeros();
            for w in std::iter::once(v).chain(neighbours.iter().map(|&w| w as usize)) {
                if counts(w) {
                    sum += crosses[w];
                }
            }
            let least = SINGULAR * (neighbours.len() + 1) as f64;
            next[v] = sum.try_normalize(least).unwrap_or(crosses[v]);
        }
        std::mem::swap(crosses, &mut next);
    }
}

#[cfg(test)]
impl Field {
    /// Radial and tangential crosses around the origin, which lies outside.
    pub(crate) fn polar(shape: &geo_types::Polygon<f64>, edge_length: f64) -> Self {
        let options = crate::DomainOptions {
            edge_length,
            ..crate::DomainOptions::default()
        };
        let domain = Domain::new(shape, &options).expect("valid");
        let crosses = domain
            .vertices()
            .into_iter()
            .map(|p| Cross::from_direction(p).expect("off the origin"));
        let vectors = crosses.map(|cross| cross.representative()).collect();
        Self::from_representatives(&domain, vectors).expect("fits")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DomainOptions;
    use geo_types::{coord, polygon};

    fn square() -> Domain {
        let shape = polygon![(x: 0., y: 0.), (x: 4., y: 0.), (x: 4., y: 4.), (x: 0., y: 4.)];
        Domain::new(&shape, &DomainOptions::default()).expect("valid")
    }

    #[test]
    fn vectors_must_fit_and_are_scaled() {
        let domain = square();
        let count = domain.vertex_count();
        assert!(Field::from_representatives(&domain, vec![]).is_err());
        let nan = vec![coord! {x: f64::NAN, y: 0.0}; count];
        assert!(Field::from_representatives(&domain, nan).is_err());
        let long = vec![coord! {x: 0.0, y: -3.0}; count];
        let field = Field::from_representatives(&domain, long).expect("fits");
        assert_eq!(field.representative(5), coord! {x: 0.0, y: -1.0});
        let zero = vec![coord! {x: 0.0, y: 0.0}; count];
        let field = Field::from_representatives(&domain, zero).expect("fits");
        assert!(field
            .cross(coord! {x: 1.0, y: 1.0}, &mut Cursor::default())
            .is_none());
        assert_eq!(field.smoothed(2).representative(3), coord! {x: 0.0, y: 0.0});
    }

    #[test]
    fn direction_follows_the_heading_and_ends_outside() {
        let domain = square();
        let cross = Cross::from_angle(0.2).representative();
        let vectors = vec![cross; domain.vertex_count()];
        let field = Field::from_representatives(&domain, vectors).expect("fits");
        let mut cursor = Cursor::default();
        let west = coord! {x: -1.0, y: 0.1};
        let arm = field.direction(coord! {x: 1.0, y: 3.0}, west, &mut cursor);
        let arm = arm.expect("inside");
        assert!((arm.x + 0.2_f64.cos()).abs() < 1e-12 && (arm.y + 0.2_f64.sin()).abs() < 1e-12);
        assert!(field
            .direction(coord! {x: 9.0, y: 3.0}, west, &mut cursor)
            .is_none());
    }
}
