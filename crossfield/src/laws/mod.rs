//! Laws that every cross field obeys, for testing designs of your own.
//!
//! The crate's own designs are held to these laws on thousands of random
//! domains. Feature `laws` makes them public, without a dependency on any
//! testing framework: each law is a function that says what is broken, and
//! shapes are made from a seed, so that any property test can drive them.
//!
//! ```
//! use crossfield::laws::{self, shapes};
//! use crossfield::{BoundaryField, Domain, DomainOptions};
//!
//! let design = BoundaryField::default();
//! for seed in 0..20 {
//!     let domain = Domain::new(&shapes::polygon(seed), &DomainOptions::default())?;
//!     laws::repeats(&design, &domain)?;
//!     laws::turns_with_the_mesh(&design, &domain, 0.1 * seed as f64, 1e-6)?;
//!     laws::indices_add_up(&design, &domain)?;
//! }
//! laws::constant_on_rectangles(&design, 300.0, 180.0, 0.4, 1e-8)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![doc = include_str!("../../convergence.md")]

mod convergence;
pub mod shapes;

#[cfg(test)]
mod fuzz;

use geo_types::{Coord, LineString, Polygon};
use thiserror::Error;

use crate::cross::Cross;
use crate::domain::{Domain, DomainOptions};
use crate::field::{Field, FieldDesign};
use crate::FieldError;
pub use convergence::{converge, Convergence, Level, Order};

/// A law that a design breaks.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("the law of {law} is broken: {detail}")]
pub struct LawBroken {
    /// Which law.
    pub law: &'static str,
    /// Where and by how much, or why it could not be tried.
    pub detail: String,
}

impl LawBroken {
    fn new(law: &'static str, detail: impl Into<String>) -> Self {
        Self {
            law,
            detail: detail.into(),
        }
    }

    fn failed(law: &'static str) -> impl Fn(FieldError) -> Self {
        move |error| Self::new(law, format!("the design failed: {error}"))
    }
}

/// The cross at vertex `v`, `None` where the field vanishes.
fn at_vertex(field: &Field, v: usize) -> Option<Cross> {
    Cross::from_representative(field.representative(v))
}

/// The same domain gives the same field, to the bit.
///
/// # Errors
///
/// [`LawBroken`] with the first vertex that differs.
pub fn repeats<D: FieldDesign + ?Sized>(design: &D, domain: &Domain) -> Result<(), LawBroken> {
    const LAW: &str = "repetition";
    let one = design.design(domain).map_err(LawBroken::failed(LAW))?;
    let two = design.design(domain).map_err(LawBroken::failed(LAW))?;
    let bits = |c: Coord<f64>| (c.x.to_bits(), c.y.to_bits());
    let differs = |v: &usize| bits(one.representative(*v)) != bits(two.representative(*v));
    match (0..domain.vertex_count()).find(differs) {
        Some(v) => Err(LawBroken::new(LAW, format!("vertex {v} differs"))),
        None => Ok(()),
    }
}

/// On a mesh that is turned by `angle` (and moved) every cross is turned by as
/// much, up to `tolerance` radians.
///
/// # Errors
///
/// [`LawBroken`] with the first vertex whose cross is not.
pub fn turns_with_the_mesh<D: FieldDesign + ?Sized>(
    design: &D,
    domain: &Domain,
    angle: f64,
    tolerance: f64,
) -> Result<(), LawBroken> {
    const LAW: &str = "rotation";
    let moved = domain.moved(angle, Coord { x: 1e5, y: -3e5 });
    let here = design.design(domain).map_err(LawBroken::failed(LAW))?;
    let there = design.design(&moved).map_err(LawBroken::failed(LAW))?;
    for v in 0..domain.vertex_count() {
        let off = match (at_vertex(&here, v), at_vertex(&there, v)) {
            (Some(a), Some(b)) => a.turned(angle).deviation(&b),
            (None, None) => 0.0,
            _ => f64::INFINITY,
        };
        if off > tolerance {
            let at = domain.vertex(v);
            let detail = format!("vertex {v} at ({}, {}) is {off} rad off", at.x, at.y);
            return Err(LawBroken::new(LAW, detail));
        }
    }
    Ok(())
}

/// The indices of all triangles add up to the winding along the boundary, and
/// where the field follows the boundary, with its corners to four times the
/// Euler characteristic ([`IndexCheck`](crate::IndexCheck)).
///
/// # Errors
///
/// [`LawBroken`] with the balance.
pub fn indices_add_up<D: FieldDesign + ?Sized>(
    design: &D,
    domain: &Domain,
) -> Result<(), LawBroken> {
    const LAW: &str = "indices";
    let field = design.design(domain).map_err(LawBroken::failed(LAW))?;
    let check = field.index_check();
    if !check.holds() {
        return Err(LawBroken::new(LAW, check.to_string()));
    }
    let listed: i32 = field.singularities().iter().map(|s| s.quarter_index).sum();
    if listed != check.interior {
        let detail = format!("singularities have {listed}, triangles {}", check.interior);
        return Err(LawBroken::new(LAW, detail));
    }
    Ok(())
}

/// A rectangle, turned by `angle`, has the constant field along its sides, up
/// to `tolerance` radians. For fields that follow the boundary.
///
/// # Errors
///
/// [`LawBroken`] with the cross that is farthest off.
pub fn constant_on_rectangles<D: FieldDesign + ?Sized>(
    design: &D,
    width: f64,
    height: f64,
    angle: f64,
    tolerance: f64,
) -> Result<(), LawBroken> {
    const LAW: &str = "rectangles";
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    let (s, c) = angle.sin_cos();
    let turned: Vec<(f64, f64)> = corners
        .iter()
        .map(|&(x, y)| (c * x - s * y, s * x + c * y))
        .collect();
    constant(
        LAW,
        design,
        &Polygon::new(turned.into(), vec![]),
        angle,
        tolerance,
    )
}

/// A shape with right angles only, whose sides run along `angle` and across,
/// has the constant field. For smooth fields that follow the boundary (a
/// B-field; distance fields jump beside concave corners).
///
/// # Errors
///
/// [`LawBroken`] with the cross that is farthest off.
pub fn constant_on_right_angles<D: FieldDesign + ?Sized>(
    design: &D,
    shape: &Polygon<f64>,
    angle: f64,
    tolerance: f64,
) -> Result<(), LawBroken> {
    constant("right angles", design, shape, angle, tolerance)
}

fn constant<D: FieldDesign + ?Sized>(
    law: &'static str,
    design: &D,
    shape: &Polygon<f64>,
    angle: f64,
    tolerance: f64,
) -> Result<(), LawBroken> {
    let domain = Domain::new(shape, &DomainOptions::default()).map_err(LawBroken::failed(law))?;
    let field = design.design(&domain).map_err(LawBroken::failed(law))?;
    let wanted = Cross::from_angle(angle);
    within(law, &field, tolerance, |_| Some(wanted))
}

/// A ring between two circles of `count` vertices has radial and tangential
/// crosses, up to `tolerance` radians, and no singularity. For fields that
/// follow the boundary; an edge of the outer circle is off by up to half the
/// angle it spans, pi / `count`, whatever the design.
///
/// # Errors
///
/// [`LawBroken`] with the cross that is farthest off.
pub fn radial_on_rings<D: FieldDesign + ?Sized>(
    design: &D,
    outer: f64,
    inner: f64,
    count: usize,
    tolerance: f64,
) -> Result<(), LawBroken> {
    const LAW: &str = "rings";
    let circle = |radius: f64| LineString::from(shapes::circle(count, radius));
    let shape = Polygon::new(circle(outer), vec![circle(inner)]);
    let options = DomainOptions {
        edge_length: (outer - inner) / 8.0,
        ..DomainOptions::default()
    };
    let domain = Domain::new(&shape, &options).map_err(LawBroken::failed(LAW))?;
    let field = design.design(&domain).map_err(LawBroken::failed(LAW))?;
    if let Some(singularity) = field.singularities().first() {
        return Err(LawBroken::new(LAW, format!("{singularity:?}")));
    }
    within(LAW, &field, tolerance, Cross::from_direction)
}

/// All crosses of a field within `tolerance` of what they should be; where
/// that is `None`, anything will do.
fn within(
    law: &'static str,
    field: &Field,
    tolerance: f64,
    wanted: impl Fn(Coord<f64>) -> Option<Cross>,
) -> Result<(), LawBroken> {
    let mut worst = (0.0, 0);
    for v in 0..field.domain().vertex_count() {
        if let Some(wanted) = wanted(field.domain().vertex(v)) {
            let off = at_vertex(field, v).map_or(f64::INFINITY, |c| c.deviation(&wanted));
            if off > worst.0 {
                worst = (off, v);
            }
        }
    }
    if worst.0 <= tolerance {
        return Ok(());
    }
    let at = field.domain().vertex(worst.1);
    let detail = format!("the cross at ({}, {}) is {} rad off", at.x, at.y, worst.0);
    Err(LawBroken::new(law, detail))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BoundaryField, DistanceField};

    /// Crosses that point east, whatever the domain: it breaks three laws.
    struct East;

    impl FieldDesign for East {
        fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
            let east = vec![Coord { x: 1.0, y: 0.0 }; domain.vertex_count()];
            Field::from_representatives(domain, east)
        }
    }

    #[test]
    fn laws_can_be_broken() {
        let domain = Domain::new(&shapes::polygon(1), &DomainOptions::default()).expect("valid");
        assert!(repeats(&East, &domain).is_ok() && indices_add_up(&East, &domain).is_ok());
        let broken = turns_with_the_mesh(&East, &domain, 0.3, 1e-6).expect_err("broken");
        assert!(broken
            .to_string()
            .contains("law of rotation is broken: vertex 0"));
        assert!(constant_on_rectangles(&East, 30.0, 20.0, 0.0, 1e-9).is_ok());
        let broken = constant_on_rectangles(&East, 30.0, 20.0, 0.3, 1e-9).expect_err("broken");
        assert!(broken.detail.contains("0.3 rad off"), "{broken}");
        assert_eq!(
            radial_on_rings(&East, 9.0, 4.0, 60, 0.1)
                .expect_err("broken")
                .law,
            "rings"
        );
    }

    #[test]
    fn our_designs_keep_them() {
        let designs: [Box<dyn FieldDesign>; 2] = [
            Box::new(DistanceField::default()),
            Box::new(BoundaryField::default()),
        ];
        for design in &designs {
            for seed in 0..12 {
                let shape = shapes::polygon(seed);
                let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
                repeats(design, &domain).expect("kept");
                turns_with_the_mesh(design, &domain, seed as f64, 1e-6).expect("kept");
                indices_add_up(design, &domain).expect("kept");
            }
            constant_on_rectangles(design, 300.0, 200.0, 0.7, 1e-8).expect("kept");
            radial_on_rings(design, 100.0, 50.0, 96, 0.07).expect("kept");
        }
        for seed in 0..12 {
            let shape = shapes::right_angled(seed);
            let smooth = BoundaryField::default();
            constant_on_right_angles(&smooth, &shape, 0.0, 1e-8).expect("kept");
        }
    }
}
