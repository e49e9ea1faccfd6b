//! The places that regions grow from and rays are cast from, and the shapes that
//! stand on them.

use geo_types::Coord;

use super::{points, Primitive};
use crate::derive::{Scope, Spot};
use crate::error::Failure;
use crate::plane::{dist, intersection, right, Area, Weld};
use crate::shape::{Local, Region};
use crate::syntax::ast::Expr;

/// Places this near to each other or to the boundary, as a share of the region's
/// size, are one, and on it.
const NEAR: f64 = 1e-7;

/// Shares of a shape that are rounding.
const ROUNDING: f64 = 1e-9;

/// The places in the region that an expression stands for, in their order: those
/// outside are left out, and of several at one point all but the first.
pub(crate) fn sites(scope: &mut Scope<'_>, expr: &Expr, most: usize) -> Result<Vec<Spot>, Failure> {
    let value = scope.value(expr)?;
    let found = points::spots(scope.region, value, expr.span)?;
    if found.len() > most {
        let error = format!("{} places are too many, {most} at most", found.len());
        return Err(Failure::unfit(expr.span, error));
    }
    let region = scope.region;
    let near = NEAR * size(region);
    let mut weld = Weld::new(near, size(region) / 64.0);
    let mut count = 0;
    let mut kept = Vec::new();
    for spot in found {
        let finite = spot.at.x.is_finite() && spot.at.y.is_finite();
        let area = &region.area;
        if !finite || !(area.contains(spot.at) || area.nearest(spot.at).1 <= near) {
            continue;
        }
        if weld.vertex(spot.at) == count {
            count += 1;
            kept.push(spot);
        }
    }
    if kept.is_empty() {
        let failure = Failure::unfit(expr.span, "none of these places lies in the region");
        return Err(failure);
    }
    Ok(kept)
}

/// The longer extent of a region, metres.
pub(crate) fn size(region: &Region) -> f64 {
    let (low, high) = region.area.extent();
    (high.x - low.x).max(high.y - low.y)
}

/// A shape at a place, upright as the region's own coordinates have it.
pub(crate) fn shape_at(shape: Primitive, at: Coord<f64>, local: &Local) -> Area {
    let [along, _] = local.axes();
    let sign = if local.mirrored() { 1.0 } else { -1.0 };
    let up = right(along) * sign;
    let upright = shape.ring(Coord::default(), 0.0);
    let ring = upright.iter().map(|p| at + along * p.x + up * p.y);
    Area::new(ring.collect(), Vec::new())
}

/// Whether an area lies whole in another.
pub(crate) fn fits(inner: &Area, outer: &Area) -> bool {
    let within: f64 = intersection(std::slice::from_ref(inner), std::slice::from_ref(outer))
        .iter()
        .map(Area::size)
        .sum();
    (within - inner.size()).abs() <= ROUNDING * inner.size()
}

/// The part of areas that holds a point, or lies nearest to it.
pub(crate) fn part_at(areas: Vec<Area>, at: Coord<f64>) -> Option<Area> {
    let away = |area: &Area| {
        if area.contains(at) {
            0.0
        } else {
            dist(area.nearest(at).0, at)
        }
    };
    areas
        .into_iter()
        .map(|area| (away(&area), area))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, area)| area)
}
