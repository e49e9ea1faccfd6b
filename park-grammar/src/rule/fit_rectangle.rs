//! `FitRectangle() { Rectangle | Rest }`: a rectangle in a region of any shape.
//!
//! The notes' idea for regions whose sides are not parallel: "a new rule that
//! would fit in the rectangular shape into the available space". By default it is
//! the largest one inside; `fit = ` and its arguments choose another as for a
//! grid, of which the part inside the region is taken.
//!
//! Outputs: what lies in the rectangle, the rest.

use super::fit::{Fit, Fitting};
use super::grid::piece;
use super::{Arguments, Ask, Output, Partition};
use crate::error::Failure;
use crate::shape::{Heritage, Local, Role};

pub(crate) fn fit_rectangle(ask: &mut Ask<'_, '_>) -> Result<Partition, Failure> {
    let span = ask.operation.span;
    let mut arguments = Arguments::new(ask.operation);
    let fitting = Fitting::read(&mut arguments, &mut ask.scope, Fit::Inscribed)?;
    arguments.done()?;
    let region = ask.scope.region;
    let fitted = fitting.cut(region, span)?;
    let heritage = Heritage::new(region, "FitRectangle");
    let local = Local::new(fitted.quad);
    let inner = fitted.inside.into_iter().map(|area| {
        let mut region = heritage.piece(area, local, |_, _| Some(Role::Seam));
        crate::index::by_local(&mut region);
        region
    });
    let outside = fitted.outside.into_iter();
    let rest = outside.map(|area| piece(&heritage, area, local.axes(), Role::Seam));
    Ok(Partition {
        outputs: vec![
            Output::lawns(inner.collect()),
            Output::lawns(rest.collect()),
        ],
    })
}
