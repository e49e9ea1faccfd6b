//! Where rays are cast to.
//!
//! Targets are places (corners of the region, points of its boundary or inside),
//! or directions: a number of them, evenly spaced, or a list of angles. A ray to a
//! place on the boundary ends there, one to a place inside goes on through it: the
//! notes have rays end where the boundary is met. A place that a centre does not
//! see has no ray from there, since it would lead through the outside ("remove
//! paths that are casted to the outside area"); `hidden = end` lets such a ray end
//! where it first meets the boundary instead.

use geo_types::Coord;

use crate::derive::{Number, Scope, Value};
use crate::error::Failure;
use crate::plane::{dist, leaves, sees, unit, Area};
use crate::rule::points;
use crate::select::Frame;
use crate::syntax::ast::{Expr, Unit};

/// Distances this small, as a share of the area's size, are none.
const NEAR: f64 = 1e-7;

/// More directions are a mistake.
const MOST: usize = 3600;

/// What rays are cast to.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Targets {
    Places(Vec<Coord<f64>>),
    /// Unit vectors.
    Directions(Vec<Coord<f64>>),
}

/// Where a ray ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    pub(super) at: Coord<f64>,
    /// Whether the ray would leave the region there: then the path is cut off
    /// along the boundary.
    pub(super) leaves: bool,
}

impl Targets {
    /// The second argument; the first of evenly spaced directions is `from`.
    pub(super) fn read(scope: &mut Scope<'_>, expr: &Expr, from: f64) -> Result<Self, Failure> {
        let frame = Frame::of(scope.region);
        let value = scope.value(expr)?;
        let wrong = || Failure::fault(expr.span, "a direction was expected");
        let towards = |number: &Number| {
            let angle = number.radians().ok_or_else(wrong)?;
            Ok(frame.direction(angle))
        };
        match &value {
            Value::Number(number) if number.unit == Unit::None => {
                let count = scope.count(expr)?;
                if count > MOST {
                    let error = format!("{count} directions are too many, {MOST} at most");
                    return Err(Failure::fault(expr.span, error));
                }
                let step = std::f64::consts::TAU / count.max(1) as f64;
                // Clockwise, as sides are counted.
                let all = (0..count).map(|k| frame.direction(from - step * k as f64));
                Ok(Self::Directions(all.collect()))
            }
            Value::Number(number) => Ok(Self::Directions(vec![towards(number)?])),
            Value::List(items)
                if !items.is_empty() && items.iter().all(|i| matches!(i, Value::Number(_))) =>
            {
                let numbers = items.iter().filter_map(|item| match item {
                    Value::Number(number) => Some(number),
                    _ => None,
                });
                let found: Result<Vec<_>, Failure> = numbers.map(towards).collect();
                Ok(Self::Directions(found?))
            }
            _ => {
                let spots = points::spots(scope.region, value, expr.span)?;
                if spots.len() > MOST {
                    let error = format!("{} targets are too many, {MOST} at most", spots.len());
                    return Err(Failure::unfit(expr.span, error));
                }
                Ok(Self::Places(spots.into_iter().map(|s| s.at).collect()))
            }
        }
    }

    pub(super) fn count(&self) -> usize {
        match self {
            Self::Places(all) | Self::Directions(all) => all.len(),
        }
    }

    /// Where the ray from a place to a target ends, if there is one.
    pub(super) fn cast(
        &self,
        area: &Area,
        size: f64,
        from: Coord<f64>,
        target: usize,
        hidden: bool,
    ) -> Option<End> {
        let near = NEAR * size;
        let to = match self {
            Self::Directions(all) => {
                let at = leaves(area, from, all[target])?;
                return Some(End { at, leaves: true });
            }
            Self::Places(all) => all[target],
        };
        if dist(from, to) <= near {
            return None;
        }
        let along = unit(to - from);
        let end = leaves(area, from, along)?;
        if !sees(area, from, to) {
            let at = end;
            return hidden.then_some(End { at, leaves: true });
        }
        let on_boundary = area.nearest(to).1 <= near;
        Some(if on_boundary && dist(end, to) > near {
            // The ray would go on inside.
            End {
                at: to,
                leaves: false,
            }
        } else {
            End {
                at: if on_boundary { to } else { end },
                leaves: true,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn l() -> Area {
        let ring = [(0., 0.), (0., 9.), (3., 9.), (3., 3.), (9., 3.), (9., 0.)];
        Area::new(
            ring.map(|(x, y)| coord! { x: x, y: y }).to_vec(),
            Vec::new(),
        )
    }

    #[test]
    fn rays_end_at_the_boundary() {
        let p = |x: f64, y: f64| coord! { x: x, y: y };
        let all = [p(0., 0.), p(2., 1.), p(3., 3.), p(9., 1.5), p(8., 0.5)];
        let places = Targets::Places(all.to_vec());
        let cast = |from, k, hidden| places.cast(&l(), 9.0, from, k, hidden);
        let end = |at, leaves| Some(End { at, leaves });
        let from = p(1., 1.);
        assert_eq!(cast(from, 0, false), end(p(0., 0.), true));
        // Through a place inside.
        assert_eq!(cast(from, 1, false), end(p(9., 1.), true));
        // From above, the inner corner is passed; from below it is not.
        assert_eq!(cast(p(2., 6.), 2, false), end(p(3., 3.), false));
        // Hidden behind it.
        assert_eq!(cast(p(2., 8.), 3, false), None);
        assert_eq!(cast(p(2., 8.), 4, false), None);
        let wall = cast(p(2., 8.), 4, true).expect("ends");
        assert!(wall.leaves && (wall.at.x - 3.0).abs() < 1e-9);
    }
}
