//! Convergence under refinement, against a field known in closed form.

use std::fmt;

use geo_types::Coord;

use super::{at_vertex, LawBroken};
use crate::cross::Cross;
use crate::domain::Domain;
use crate::field::FieldDesign;

/// Errors on one mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Level {
    /// Edge length, metres.
    pub edge_length: f64,
    /// Number of vertices.
    pub vertices: usize,
    /// Mean deviation from the exact cross over the vertices compared, each
    /// with a third of the area of its triangles; radians.
    pub mean: f64,
    /// Largest deviation of a vertex compared, radians.
    pub max: f64,
}

/// Errors on meshes of falling edge length.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Convergence {
    /// Coarsest first.
    pub levels: Vec<Level>,
}

/// Designs on each of `domains`, coarsest first, and compares with `exact`;
/// vertices where that is `None` are left out (a medial axis, where the exact
/// field jumps; a corner).
///
/// ```
/// use crossfield::geo_types::{Coord, Polygon};
/// use crossfield::laws::{converge, shapes};
/// use crossfield::{Cross, DistanceField, Domain, DomainOptions, FieldError};
///
/// // A disc, its circle resolved as finely as its inside: radial crosses.
/// let domains = [12.0, 6.0, 3.0].map(|edge_length| {
///     let circle = shapes::circle((628.0 / edge_length) as usize, 100.0);
///     let options = DomainOptions { edge_length, ..DomainOptions::default() };
///     Domain::new(&Polygon::new(circle.into(), vec![]), &options)
/// });
/// let domains = domains.into_iter().collect::<Result<Vec<_>, FieldError>>()?;
/// // Off the centre, which is all there is of a medial axis.
/// let radial = |p: Coord<f64>| Cross::from_direction(p).filter(|_| p.x.hypot(p.y) > 50.0);
/// let table = converge(&DistanceField::default(), &domains, radial)?;
/// assert!(table.order().mean > 0.8);
/// println!("{table}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`LawBroken`] if the design fails on one of the domains, or a field
/// vanishes where `exact` does not.
pub fn converge<D: FieldDesign + ?Sized>(
    design: &D,
    domains: &[Domain],
    exact: impl Fn(Coord<f64>) -> Option<Cross>,
) -> Result<Convergence, LawBroken> {
    const LAW: &str = "convergence";
    let level = |domain: &Domain| {
        let field = design.design(domain).map_err(LawBroken::failed(LAW))?;
        let mut shares = vec![0.0; domain.vertex_count()];
        for triangle in domain.triangles() {
            let [a, b, c] = triangle.map(|v| domain.vertex(v as usize));
            let twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
            triangle.iter().for_each(|&v| shares[v as usize] += twice);
        }
        let (mut sum, mut total, mut max) = (0.0, 0.0, 0.0_f64);
        for (v, share) in shares.iter().enumerate() {
            let Some(wanted) = exact(domain.vertex(v)) else {
                continue;
            };
            let Some(cross) = at_vertex(&field, v) else {
                return Err(LawBroken::new(
                    LAW,
                    format!("there is no cross at vertex {v}"),
                ));
            };
            let off = cross.deviation(&wanted);
            sum += share * off;
            total += share;
            max = max.max(off);
        }
        Ok(Level {
            edge_length: domain.edge_length(),
            vertices: domain.vertex_count(),
            mean: if total > 0.0 { sum / total } else { 0.0 },
            max,
        })
    };
    Ok(Convergence {
        levels: domains.iter().map(level).collect::<Result<_, _>>()?,
    })
}

/// Orders of convergence: the error falls as the edge length to this power.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Order {
    /// Of the mean error.
    pub mean: f64,
    /// Of the largest error.
    pub max: f64,
}

impl Convergence {
    /// The orders observed from the coarsest to the finest mesh; infinite
    /// where the finest is exact, not a number with fewer than two meshes.
    #[must_use]
    pub fn order(&self) -> Order {
        match (self.levels.first(), self.levels.last()) {
            (Some(first), Some(last)) => order(first, last),
            _ => Order {
                mean: f64::NAN,
                max: f64::NAN,
            },
        }
    }
}

fn order(coarse: &Level, fine: &Level) -> Order {
    let ratio = (coarse.edge_length / fine.edge_length).ln();
    let of = |a: f64, b: f64| (a / b).ln() / ratio;
    Order {
        mean: of(coarse.mean, fine.mean),
        max: of(coarse.max, fine.max),
    }
}

/// Errors below this are rounding, radians: angles of unit vectors are rounded
/// to 1e-16, and to 1e-9 at map coordinates.
const EXACT: f64 = 1e-9;

impl fmt::Display for Convergence {
    /// A table in Markdown: errors in degrees, and the order from each mesh to
    /// the next.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "| h, m | vertices | mean, deg | order | max, deg | order |"
        )?;
        writeln!(f, "|---|---|---|---|---|---|")?;
        for (k, level) in self.levels.iter().enumerate() {
            let from = k.checked_sub(1).map(|k| order(&self.levels[k], level));
            let cells = |error: f64, order: Option<f64>| match order {
                _ if error < EXACT => "exact | ".to_owned(),
                Some(order) if order.is_finite() => {
                    format!("{:.2e} | {order:.2}", error.to_degrees())
                }
                _ => format!("{:.2e} | ", error.to_degrees()),
            };
            writeln!(
                f,
                "| {} | {} | {} | {} |",
                level.edge_length,
                level.vertices,
                cells(level.mean, from.map(|o| o.mean)),
                cells(level.max, from.map(|o| o.max)),
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_read_off_the_errors() {
        let level = |edge_length: f64, mean: f64| Level {
            edge_length,
            vertices: 7,
            mean,
            max: 2.0 * edge_length,
        };
        let table = Convergence {
            levels: vec![level(4.0, 0.16), level(2.0, 0.04), level(1.0, 0.01)],
        };
        let Order { mean, max } = table.order();
        assert!((mean - 2.0).abs() < 1e-12 && (max - 1.0).abs() < 1e-12);
        let text = table.to_string();
        assert_eq!(text.lines().count(), 5);
        assert!(
            text.contains("| 1 | 7 | 5.73e-1 | 2.00 | 1.15e2 | 1.00 |"),
            "{text}"
        );
        assert!(Convergence { levels: vec![] }.order().mean.is_nan());
    }
}
