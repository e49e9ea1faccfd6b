//! Globally optimal fields, to compare with.
//!
//! Knoeppel, Crane, Pinkall and Schroeder 2013 (Globally Optimal Direction
//! Fields) minimise the energy `<D, L D>` over all D of the norm
//! `<D, M D> = 1`, M the areas of the vertices: the eigenvector of the
//! smallest eigenvalue, by inverse power iteration. Aligned with a field q,
//! they solve `(L - lambda M) D = q`, lambda below that eigenvalue: the
//! smoothest field of given agreement with q. Both are global optima, since
//! length is constrained in the mean only; at a point D may be as short as it
//! likes, and is scaled to unit length in the end.
//!
//! In the plane the connection is flat, L is that of functions, the smallest
//! eigenvalue is 0, and its eigenvectors are the constant fields. Unaligned
//! they say nothing about the domain, so here the one of them is taken that
//! agrees best with the boundary. For q we take the integral of D~ along the
//! boundary, with the corners of a B-field: their two edges' representation
//! vectors averaged.

use crate::boundary::{BoundaryField, FREE};
use crate::domain::Domain;
use crate::factor::Factor;
use crate::field::{Field, FieldDesign};
use crate::operators::{edge_weights, laplacian_plus, vertex_areas, Laplacian};
use crate::plane::V2;
use crate::symmetry::{product, quotient, Symmetry};
use crate::system::{random_units, to_unit};
use crate::FieldError;

/// The globally optimal field of a domain, in the sense of Knoeppel et al.
///
/// Other than in a [`BoundaryField`] the boundary does not enter the matrix:
/// it is agreed with in sum, not place by place, and the field follows it
/// less closely. Use it to compare with.
///
/// ```
/// use crossfield::{geo_types::polygon, Domain, DomainOptions, FieldDesign, OptimalField};
///
/// let site = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 60., y: 20.), (x: 30., y: 20.),
///     (x: 30., y: 50.), (x: 0., y: 50.)];
/// let domain = Domain::new(&site, &DomainOptions::default())?;
/// let field = OptimalField::default().design(&domain)?;
/// assert!(field.singularities().is_empty());
/// # Ok::<(), crossfield::FieldError>(())
/// ```
///
#[doc = include_str!("../images/o-field.svg")]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OptimalField {
    /// The shift lambda, in units of 1 / area: below 0, the smallest
    /// eigenvalue of a domain in the plane. What the boundary wants fades into
    /// the domain over a length of `sqrt(area / -lambda)`: the more negative,
    /// the closer is the field to the boundary near it, and the shorter
    /// inside.
    ///
    /// `None` for the unaligned field: the smallest eigenvector itself,
    /// constant.
    ///
    /// Default value: -100.
    pub lambda: Option<f64>,
    /// How many arms the directions have.
    ///
    /// Default value: [`Symmetry::Cross`].
    pub symmetry: Symmetry,
}

impl Default for OptimalField {
    fn default() -> Self {
        Self {
            lambda: Some(-100.0),
            symmetry: Symmetry::Cross,
        }
    }
}

impl FieldDesign for OptimalField {
    /// The optimal field of `domain`.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if lambda is not between -1e12 and -1e-6;
    /// [`FieldError::SingularSystem`] if the solution does not satisfy the
    /// system.
    ///
    /// # Complexity
    ///
    /// One sparse Cholesky factorisation; unaligned, a handful of solutions
    /// with it.
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        let shift = match self.lambda {
            None => NEARLY_NONE,
            Some(lambda) if (-1e12..=-1e-6).contains(&lambda) => -lambda,
            Some(lambda) => {
                return Err(FieldError::option(
                    "lambda",
                    format!("is {lambda}; give a number between -1e12 and -1e-6, or none"),
                ))
            }
        };
        let per_area = domain.area().recip();
        let areas: Vec<f64> = (vertex_areas(domain).into_iter())
            .map(|area| area * per_area)
            .collect();
        let masses: Vec<f64> = areas.iter().map(|area| area * shift).collect();
        let weights = edge_weights(domain, Laplacian::Cotangent);
        let matrix = laplacian_plus(domain, &weights, &masses);
        let factor = Factor::new(&matrix)?;
        let q = self.boundary(domain);
        let mut crosses = if self.lambda.is_some() {
            let mut columns = split(&q);
            factor.solve(&mut columns)?;
            join(&columns)
        } else {
            let eigenvector = smallest_eigenvector(&factor, &areas)?;
            // Any turn of it is as smooth; D turned by the mean of D~ / D.
            let turns = q.iter().zip(&eigenvector);
            let turn = turns.fold(V2::zeros(), |sum, (&q, &d)| sum + quotient(q, d));
            let turn = turn.try_normalize(FREE).unwrap_or_else(V2::x);
            eigenvector.iter().map(|&d| product(d, turn)).collect()
        };
        to_unit(&mut crosses);
        Ok(Field::from_vectors(domain, crosses)?.of_symmetry(self.symmetry))
    }
}

impl OptimalField {
    /// q: the integral of D~ over the part of the boundary of each vertex,
    /// over the square root of the area.
    fn boundary(&self, domain: &Domain) -> Vec<V2> {
        let base = BoundaryField {
            symmetry: self.symmetry,
            ..BoundaryField::default()
        };
        let (targets, lengths) = base.targets(domain);
        let pairs = targets.into_iter().zip(lengths);
        pairs.map(|(target, length)| target * length).collect()
    }
}

/// The shift of the inverse power iteration, in units of 1 / area. The second
/// eigenvalue of a compact domain is some 10 / area, so that each round leaves
/// a hundred-thousandth of the error; that of a needle, pi^2 width / length.
const NEARLY_NONE: f64 = 1e-4;

/// Most rounds of the inverse power iteration; a handful is usual.
const MOST_ROUNDS: usize = 200;

/// The eigenvector of the smallest eigenvalue of `L x = lambda M x`, of norm 1
/// under M, by inverse power iteration with the factor of `L + shift M`.
fn smallest_eigenvector(factor: &Factor<'_, u32>, areas: &[f64]) -> Result<Vec<V2>, FieldError> {
    let norm = |x: &[V2]| -> f64 {
        let squares = x.iter().zip(areas).map(|(d, area)| area * d.norm_squared());
        squares.sum::<f64>().sqrt()
    };
    // A start that surely has a part along every eigenvector: the same in
    // every frame, so that the result turns with the mesh.
    let mut x = random_units(areas.len(), 0);
    let scale = norm(&x);
    x.iter_mut().for_each(|d| *d /= scale);
    for _ in 0..MOST_ROUNDS {
        let loaded: Vec<V2> = x.iter().zip(areas).map(|(d, &area)| d * area).collect();
        let mut columns = split(&loaded);
        factor.solve(&mut columns)?;
        let mut next = join(&columns);
        let scale = norm(&next);
        next.iter_mut().for_each(|d| *d /= scale);
        let change: Vec<V2> = next.iter().zip(&x).map(|(a, b)| a - b).collect();
        x = next;
        if norm(&change) < 1e-12 {
            break;
        }
    }
    Ok(x)
}

fn split(vectors: &[V2]) -> [Vec<f64>; 2] {
    let (x, y) = vectors.iter().map(|d| (d.x, d.y)).unzip();
    [x, y]
}

fn join([x, y]: &[Vec<f64>; 2]) -> Vec<V2> {
    x.iter().zip(y).map(|(&x, &y)| V2::new(x, y)).collect()
}
