//! What rules have in common that make parts of a region without sides of their
//! own: the parts as regions, and the places and widths that their arguments name.

use geo_types::Coord;

use super::peel::within;
use super::points;
use super::Arguments;
use crate::derive::{Scope, Spot, Value, Watch};
use crate::error::Failure;
use crate::plane::{dist, trim, Area};
use crate::shape::{Heritage, Region, Role};
use crate::syntax::ast::{Argument, Span};

/// What is smaller than this share of the region is rounding.
const SLIVER: f64 = 1e-12;

/// Makes regions of the parts of one.
pub(crate) struct Parts<'r> {
    region: &'r Region,
    heritage: Heritage<'r>,
}

impl<'r> Parts<'r> {
    pub(crate) fn new(region: &'r Region, rule: &'static str) -> Self {
        Self {
            region,
            heritage: Heritage::new(region, rule),
        }
    }

    /// Areas as regions: edges within the region have a role, sides are numbered by
    /// coordinates along the region's axes. An error when the time is up.
    pub(crate) fn regions(
        &self,
        areas: Vec<Area>,
        role: Role,
        watch: &Watch<'_>,
    ) -> Result<Vec<Region>, Failure> {
        let (low, high) = self.region.area.extent();
        let least = SLIVER * self.region.area.size();
        trim(areas, dist(low, high))
            .into_iter()
            .filter(|area| area.size() > least)
            .map(|area| {
                watch.tick()?;
                let local = within(self.region, &area);
                let mut piece = self.heritage.piece(area, local, |_, _| Some(role));
                piece.cell = self.region.cell;
                crate::index::by_local(&mut piece);
                Ok(piece)
            })
            .collect()
    }
}

/// The places that an argument names: those of any rule, or the place at a share of
/// a selection, `NORTH: 0.25`.
pub(crate) fn places(scope: &mut Scope<'_>, argument: &Argument) -> Result<Vec<Spot>, Failure> {
    let value = scope.value(&argument.value)?;
    let span = argument.value.span;
    match (&argument.at, value) {
        (Some(at), Value::Selection(selection)) => {
            let share = points::share(scope, at, selection.length())?;
            let spot = points::share_of(scope.region, &selection, share);
            Ok(spot.into_iter().collect())
        }
        (Some(_), other) => Err(other.wrong(span, "a selection before the colon")),
        (None, value) => points::spots(scope.region, value, span),
    }
}

/// The one place of the argument `centre`, if it is given.
pub(crate) fn centre(
    scope: &mut Scope<'_>,
    arguments: &mut Arguments<'_>,
) -> Result<Option<Spot>, Failure> {
    let Some(expr) = arguments.named("centre") else {
        return Ok(None);
    };
    let value = scope.value(expr)?;
    let spots = points::spots(scope.region, value, expr.span)?;
    only(&spots, expr.span).map(Some)
}

/// The place that is a centre.
pub(crate) fn only(spots: &[Spot], span: Span) -> Result<Spot, Failure> {
    match spots {
        [only] => Ok(*only),
        [] => Err(Failure::unfit(span, "this region has no such place")),
        _ => Err(Failure::fault(span, "a centre is one place")),
    }
}

/// The distance of a place of a region from its boundary; negative outside.
pub(crate) fn room(region: &Region, at: Coord<f64>) -> f64 {
    let away = region.area.nearest(at).1;
    if region.area.contains(at) {
        away
    } else {
        -away
    }
}
