//! The H-fields of a domain as a linear family.
//!
//! One Neumann problem for each boundary piece, with one factorisation for
//! all; then second derivatives once. Every H-field is a linear combination.

use nalgebra::DMatrix;

use super::discs::Discs;
use super::elements::Nodes;
use super::family::{complement, Alignment, Family, Kind};
use super::pieces::{BoundaryPiece, Pieces};
use super::recovery::{Condition, Derivative, Patch, Recovery};
use super::HarmonicField;
use crate::domain::Domain;
use crate::field::Field;
use crate::plane::V2;
use crate::FieldError;

/// All H-fields of a domain: one for each vector of constants, the fluxes
/// through the pieces of its boundary (supplement, section 4.2, equation 2).
///
/// Made by [`HarmonicField::basis`]; what costs time is done there, and any
/// field of the family is then a linear combination.
///
/// ```
/// use crossfield::{geo_types::polygon, Domain, DomainOptions, HarmonicField};
///
/// let site = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 60., y: 20.), (x: 30., y: 20.),
///     (x: 30., y: 50.), (x: 0., y: 50.)];
/// let domain = Domain::new(&site, &DomainOptions::default())?;
/// let basis = HarmonicField::default().basis(&domain)?;
/// assert_eq!((basis.pieces().len(), basis.dimension()), (6, 3));
/// // z = x^2 - y^2 about the corner at the lower left: the constant field.
/// let fluxes = [0.0, 120.0, -40.0, 60.0, -100.0, 0.0];
/// let field = basis.field(&fluxes)?;
/// assert!(basis.energy(&field)? < 1e-9 && field.singularities().is_empty());
/// # Ok::<(), crossfield::FieldError>(())
/// ```
#[derive(Clone, Debug)]
pub struct HarmonicBasis {
    pub(crate) family: Family,
    pub(crate) pieces: Vec<BoundaryPiece>,
}

impl HarmonicBasis {
    pub(crate) fn new(design: &HarmonicField, domain: &Domain) -> Result<Self, FieldError> {
        design.check()?;
        let pieces = Pieces::cut(domain, design.max_turn_deg.to_radians(), design.max_pieces)?;
        let space = search_space(&pieces);
        if space.ncols() == 0 {
            return Err(FieldError::NoHarmonicField {
                pieces: pieces.len(),
            });
        }
        let radius = disc_radius(design.disc_radius, domain);
        let nodes = Nodes::new(domain, design.elements);
        let solutions = solutions(domain, &nodes, &pieces)?;
        let family = Family {
            domain: domain.clone(),
            kind: Kind::Hessian,
            count: pieces.len(),
            columns: hessians(domain, &nodes, &pieces, &solutions),
            space,
            radius,
            discs: singular_ends(domain, &pieces, radius),
            charged: bent(domain, &pieces),
            charge: design.alignment,
        };
        Ok(Self {
            family,
            pieces: pieces.all,
        })
    }

    /// The pieces of the boundary, in the order of the coefficients: ring by
    /// ring, each walked with the domain on its left.
    #[must_use]
    pub fn pieces(&self) -> &[BoundaryPiece] {
        &self.pieces
    }

    /// Number of independent H-fields: the pieces less three, for the balance
    /// of fluxes and the two directions of linear functions, which have no
    /// Hessian. One for a rectangle, none for a triangle. If a piece is bent
    /// by more than a degree, the pieces less one.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.family.dimension()
    }

    /// Radius of the discs that the energy leaves out, metres.
    #[must_use]
    pub fn disc_radius(&self) -> f64 {
        self.family.radius
    }

    /// The H-field with these fluxes through the pieces.
    ///
    /// What does not balance is spread evenly over the boundary. A field does
    /// not change when all fluxes are multiplied by a number, nor when those
    /// of a linear function are added.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if there is not one finite number for each
    /// piece.
    pub fn field(&self, coefficients: &[f64]) -> Result<Field, FieldError> {
        if coefficients.len() != self.pieces.len() || !coefficients.iter().all(|c| c.abs() < 1e100)
        {
            return Err(FieldError::option(
                "coefficients",
                format!("must be {} finite numbers, one a piece", self.pieces.len()),
            ));
        }
        self.family.field(coefficients)
    }

    /// The energy of a field of this basis: the integral of the squared
    /// divergence of the better of its two arms, outside discs around its
    /// singularities and around the ends of boundary pieces where H-fields
    /// have no limit. Has no unit; 0 for a constant field.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if the field belongs to another domain.
    pub fn energy(&self, field: &Field) -> Result<f64, FieldError> {
        self.same_domain(field)?;
        let [one, other] = self.family.energies(field);
        Ok(one.min(other))
    }

    /// How closely a field of this basis follows the boundary: exactly, up to
    /// the mesh, along straight pieces; along bent ones about as well as they
    /// are straight.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if the field belongs to another domain.
    pub fn alignment(&self, field: &Field) -> Result<Alignment, FieldError> {
        self.same_domain(field)?;
        Ok(self.family.alignment(field))
    }

    fn same_domain(&self, field: &Field) -> Result<(), FieldError> {
        if self.family.domain.is_same(field.domain()) {
            return Ok(());
        }
        Err(FieldError::option(
            "field",
            "belongs to another domain than the basis; design it from this basis",
        ))
    }
}

/// The radius of the discs that the energy leaves out, from the option.
pub(crate) fn disc_radius(option: f64, domain: &Domain) -> f64 {
    if option > 0.0 {
        option
    } else {
        domain.area().sqrt() / 25.0
    }
}

/// Orthonormal basis of the fluxes to search: balanced, and orthogonal to
/// those of the two linear functions.
///
/// On a bent piece the flux of a linear function is not constant. What is
/// nearest to it is then no null vector, and fields that are constant in
/// polar coordinates need it: it stays in.
fn search_space(pieces: &Pieces) -> DMatrix<f64> {
    let column = |f: fn(&BoundaryPiece) -> f64| pieces.all.iter().map(f).collect::<Vec<f64>>();
    let mut constraints = vec![column(|p| p.length)];
    if pieces.all.iter().all(|p| p.turn < NEARLY_STRAIGHT) {
        constraints.push(column(|p| p.normal.0 / p.length));
        constraints.push(column(|p| p.normal.1 / p.length));
    }
    complement(pieces.len(), &constraints)
}

/// Pieces that turn by less than this count as straight, radians: one degree.
const NEARLY_STRAIGHT: f64 = 0.0175;

/// Nodal values of the solution for each piece, node by node: the flux is 1
/// through the piece, less what balances it, evenly through the whole
/// boundary.
fn solutions(domain: &Domain, nodes: &Nodes, pieces: &Pieces) -> Result<Vec<f64>, FieldError> {
    let count = pieces.len();
    let inner = &*domain.inner;
    let perimeter = pieces.perimeter();
    let shares: Vec<f64> = pieces.all.iter().map(|p| p.length / perimeter).collect();
    let mut loads = vec![vec![0.0; nodes.count()]; count];
    for (k, border) in inner.mesh.borders.iter().enumerate() {
        let [a, b] = [border.from, border.to].map(|v| inner.mesh.points[v as usize]);
        let length = (b - a).norm();
        let piece = pieces.of(border.ring, border.edge);
        for (node, part) in nodes.border_shares(k) {
            for (i, load) in loads.iter_mut().enumerate() {
                let flux = f64::from(u8::from(i == piece)) - shares[i];
                load[node] += flux * part * length;
            }
        }
    }
    nodes.neumann(&mut loads)?;
    let mut all = vec![0.0; nodes.count() * count];
    for (i, load) in loads.iter().enumerate() {
        for (node, value) in load.iter().enumerate() {
            all[node * count + i] = *value;
        }
    }
    Ok(all)
}

/// Trace-free Hessians of the solutions at all vertices.
fn hessians(domain: &Domain, nodes: &Nodes, pieces: &Pieces, solutions: &[f64]) -> Vec<V2> {
    let count = pieces.len();
    let perimeter = pieces.perimeter();
    let conditions = vec![Condition::Flux; count];
    let recovery = Recovery::new(domain, nodes, pieces, conditions, Derivative::Hessian);
    let mut patch = Patch::default();
    let mut columns = vec![V2::zeros(); domain.vertex_count() * count];
    for v in 0..domain.vertex_count() {
        let stencil = recovery.stencil(v, &mut patch);
        let row = &mut columns[v * count..][..count];
        // Linear functions have no Hessian, so that values relative to the
        // vertex's own do as well, and lose less.
        let here = &solutions[v * count..][..count];
        for &(node, weight) in &stencil.nodes {
            let values = &solutions[node as usize * count..][..count];
            for ((column, value), here) in row.iter_mut().zip(values).zip(here) {
                *column += weight * (value - here);
            }
        }
        for &(piece, weight) in &stencil.fluxes {
            for (i, column) in row.iter_mut().enumerate() {
                let own = f64::from(u8::from(i == piece as usize));
                *column += weight * (own - pieces.all[i].length / perimeter);
            }
        }
    }
    columns
}

/// Discs around the ends of pieces where the angle of H has no limit.
///
/// Near a corner of inner angle alpha, H grows like r^(pi/alpha - 2) and
/// turns by as much with the angle around it: only a convex right angle is
/// free of that. Where a bent piece was cut without a corner, H has a weak
/// pole if the two fluxes differ. No disc takes more than a quarter of a
/// piece, so that short pieces are not hidden from the energy.
fn singular_ends(domain: &Domain, pieces: &Pieces, radius: f64) -> Discs {
    let inner = &*domain.inner;
    let mut discs = Vec::new();
    for (index, ring) in inner.rings.iter().enumerate() {
        for k in 0..ring.len() {
            let before = pieces.of(index as u32, ring.previous(k) as u32);
            let after = pieces.of(index as u32, k as u32);
            let right = (ring.turn[k] - crate::cross::QUARTER).abs() < RIGHT;
            if (before != after || ring.corner[k]) && !right {
                let shorter = pieces.all[before].length.min(pieces.all[after].length);
                discs.push((ring.points[k], radius.min(shorter / 4.0)));
            }
        }
    }
    Discs::new(discs)
}

/// The borders of pieces that are not straight.
fn bent(domain: &Domain, pieces: &Pieces) -> Vec<u32> {
    let borders = &domain.inner.mesh.borders;
    (0..borders.len() as u32)
        .filter(|&k| {
            let border = borders[k as usize];
            pieces.all[pieces.of(border.ring, border.edge)].turn > 1e-6
        })
        .collect()
}

/// Corners this near to a right angle count as one, radians: H turns by a
/// quarter of a degree around them.
pub(crate) const RIGHT: f64 = 0.005;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cross::Cross;
    use crate::harmonic::elements::Elements;
    use crate::harmonic::family::C;
    use crate::DomainOptions;
    use geo_types::polygon;

    fn quadrilateral(edge_length: f64) -> Domain {
        let shape = polygon![(x: -0.3, y: -0.2), (x: 0.9, y: -0.4), (x: 1.1, y: 0.5),
            (x: 0.2, y: 0.8)];
        let options = DomainOptions {
            edge_length,
            ..DomainOptions::default()
        };
        Domain::new(&shape, &options).expect("valid")
    }

    /// Largest and mean error of the trace-free Hessian inside, for the
    /// solution of the Neumann problem of z = Re exp(3 w).
    fn errors(edge_length: f64, elements: Elements) -> (f64, f64) {
        let domain = quadrilateral(edge_length);
        let mesh = &domain.inner.mesh;
        let nodes = Nodes::new(&domain, elements);
        let slope = |p: V2| (C::new(p.x, p.y) * 3.0).exp() * 3.0;
        let mut loads = vec![vec![0.0; nodes.count()]];
        for (k, border) in mesh.borders.iter().enumerate() {
            let [a, b] = [border.from, border.to].map(|v| mesh.points[v as usize]);
            let normal = -crate::plane::left(b - a);
            let ends: Vec<usize> = nodes.border_shares(k).map(|(node, _)| node).collect();
            // Gauss's rule with three points.
            for (t, weight) in [
                (-(0.6_f64.sqrt()), 5.0 / 18.0),
                (0.0, 4.0 / 9.0),
                (0.6_f64.sqrt(), 5.0 / 18.0),
            ] {
                let t = (1.0 + t) / 2.0;
                let f = slope(a + (b - a) * t);
                let flux = weight * (f * C::new(normal.x, normal.y)).re;
                let hats = match elements {
                    Elements::Quadratic => vec![
                        (1.0 - t) * (1.0 - 2.0 * t),
                        t * (2.0 * t - 1.0),
                        4.0 * t * (1.0 - t),
                    ],
                    Elements::Linear => vec![1.0 - t, t],
                };
                for (&node, hat) in ends.iter().zip(hats) {
                    loads[0][node] += flux * hat;
                }
            }
        }
        // Balanced but for the rule's error.
        let excess: f64 = loads[0].iter().sum::<f64>() / nodes.count() as f64;
        loads[0].iter_mut().for_each(|load| *load -= excess);
        nodes.neumann(&mut loads).expect("definite");
        let pieces = Pieces::cut(&domain, 0.3, 10).expect("four");
        let conditions = vec![Condition::Value; 4];
        let recovery = Recovery::new(&domain, &nodes, &pieces, conditions, Derivative::Hessian);
        let (mut max, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
        let mut patch = Patch::default();
        for v in domain.inner_vertices() {
            let stencil = recovery.stencil(v, &mut patch);
            let got = stencil.nodes.iter().fold(V2::zeros(), |sum, &(node, w)| {
                sum + w * loads[0][node as usize]
            });
            let wanted = slope(mesh.points[v]) * 3.0;
            let error = (got - V2::new(wanted.re, -wanted.im)).norm() / wanted.norm();
            max = max.max(error);
            sum += error;
            count += 1.0;
        }
        (max, sum / count)
    }

    /// Second derivatives inside, against the closed form, as the mesh is
    /// halved four times. The mesh is a lattice but for a belt along the
    /// boundary: quadratic elements reach the second order on average and the
    /// first at the worst vertex (the belt), linear ones stall.
    #[test]
    fn hessians_converge_with_quadratic_elements() {
        println!("edge, quadratic max and mean, linear max and mean");
        let mut table = Vec::new();
        for halvings in 0..5 {
            let edge = 0.1 / f64::from(1 << halvings);
            let (a, b) = errors(edge, Elements::Quadratic);
            let (c, d) = errors(edge, Elements::Linear);
            println!("{edge:.5}: {a:.2e} {b:.2e} {c:.2e} {d:.2e}");
            table.push([a, b, c, d]);
        }
        let orders = [0, 1, 2, 3].map(|k| (table[0][k] / table[4][k]).log2() / 4.0);
        println!("orders: {orders:.2?}");
        assert!(orders[0] > 0.9 && orders[1] > 1.8, "{orders:?}");
        assert!(orders[2] < 0.7, "linear elements do not converge");
    }

    /// A mirror image has the mirrored crosses, for the mirrored fluxes.
    #[test]
    fn a_mirror_image_has_mirrored_fields() {
        let shape = polygon![
            exterior: [(x: 0., y: 0.), (x: 90., y: 10.), (x: 99., y: 30.), (x: 97., y: 50.),
                (x: 40., y: 85.), (x: -5., y: 50.)],
            interiors: [[(x: 30., y: 30.), (x: 50., y: 32.), (x: 40., y: 45.)]],
        ];
        let here = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let there = here.mirrored();
        let design = HarmonicField::default();
        let cut = |domain| Pieces::cut(domain, design.max_turn_deg.to_radians(), 200).expect("few");
        let (own, other) = (cut(&here), cut(&there));
        let fluxes: Vec<f64> = (0..own.len()).map(|k| (k as f64 * 1.7).sin()).collect();
        let mut image = vec![f64::NAN; other.len()];
        for (a, b) in here
            .inner
            .mesh
            .borders
            .iter()
            .zip(&there.inner.mesh.borders)
        {
            image[other.of(b.ring, b.edge)] = fluxes[own.of(a.ring, a.edge)];
        }
        let [a, b] = [(&here, fluxes), (&there, image)].map(|(domain, fluxes)| {
            let basis = design.basis(domain).expect("a basis");
            let field = basis.field(&fluxes).expect("fluxes");
            let energy = basis.energy(&field).expect("its own");
            (field, energy)
        });
        assert!((a.1 / b.1 - 1.0).abs() < 1e-7);
        for (p, q) in a.0.vectors().iter().zip(b.0.vectors()) {
            let [p, q] = [p, q].map(|d| Cross::from_vector(*d).expect("regular"));
            assert!(Cross::from_angle(-p.angle()).deviation(&q) < 1e-7);
        }
    }

    /// What is left out: corners but convex right angles, and cuts of bent
    /// pieces, none beyond a quarter of a piece.
    #[test]
    fn discs_lie_at_singular_ends() {
        let shape = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 60., y: 20.), (x: 58., y: 20.),
            (x: 58., y: 50.), (x: 0., y: 50.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let pieces = Pieces::cut(&domain, 0.3, 10).expect("six");
        let discs = singular_ends(&domain, &pieces, 3.0);
        assert_eq!(discs.all().len(), 1);
        let at = V2::new(58.0, 20.0) - domain.inner.frame.origin;
        assert_eq!(discs.all()[0], (at, 0.5));
    }
}
