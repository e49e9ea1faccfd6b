//! `Contract(2 m) { Inner | Around }`, `Contract(0.5, CENTRE) { Inner | Around }`: a
//! region drawn together, and what is left around it.
//!
//! The notes: "contracts the region towards the centre (of mass). Centre can also be
//! specified as a parameter", and the question whether CGA's `s`, which scales,
//! would be enough. The word has two meanings there: the park example draws the
//! perimeter of an area in by 1 m to lay a hedge along it. Both are offered:
//!
//! * Without a centre every edge is moved in by the amount, along its normal; mitred
//!   where the boundary turns inwards. The amount is metres, a percentage or a bare
//!   number below 1 a share of the radius of the largest circle inside.
//! * With a centre, a place as the second value or by name, the region is scaled
//!   towards it. A percentage or a bare number below 1 is the share of its way to
//!   the centre that each point goes. Metres are what the point of the boundary
//!   goes that is nearest to the centre, so that no edge seen from there goes less.
//!   What the scaled image has outside of the region, if it is not seen whole from
//!   the centre, is cut off.
//!
//! `by = inset` and `by = scale` say which is meant against the rule; scaling
//! without a centre goes to `CENTRE`, and an inset has no use for one.
//!
//! The border is marked as a peel's is, so that `History("Contract", INNER)`
//! selects it on both sides. With the flag `SplitHoles` what is around is cut at its
//! corners.
//!
//! As a value, `Contract(1, selection)` is lines drawn in by 1 m, for `Sweep`,
//! `Distribute` and the block of `Parametrise`.
//!
//! Outputs: the contracted region, what is around.

use geo_types::Coord;

use super::parts::{centre, only, places, room, Parts};
use super::peel::{depth, is_share, whole};
use super::{holes, Arguments, Ask, Output, Partition};
use crate::derive::{Scope, Spot, Value};
use crate::error::Failure;
use crate::plane::{difference, inset, intersection, lerp, middle, Area, Ring};
use crate::select::Selection;
use crate::shape::{Region, Role};
use crate::syntax::ast::{ExprKind, Operation, Span};

/// How a region is drawn together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum By {
    Inset,
    Scale,
}

pub(crate) fn contract(ask: &mut Ask<'_, '_>) -> Result<Partition, Failure> {
    let span = ask.operation.span;
    let scope = &mut ask.scope;
    let mut arguments = Arguments::new(ask.operation);
    let amount = &arguments.need("a length, such as 2 m")?.value;
    let split = holes::wanted(&mut arguments, scope)?;
    let mut towards: Option<Spot> = centre(scope, &mut arguments)?;
    if let Some(argument) = arguments.next() {
        towards = Some(only(&places(scope, argument)?, argument.value.span)?);
    }
    let by = match arguments.named("by") {
        Some(expr) => match &expr.kind {
            ExprKind::Name(word) if word == "inset" => By::Inset,
            ExprKind::Name(word) if word == "scale" => By::Scale,
            _ => {
                let failure = Failure::fault(expr.span, "this is no way to contract");
                return Err(failure.hint("there are inset and scale"));
            }
        },
        None if towards.is_some() => By::Scale,
        None => By::Inset,
    };
    arguments.done()?;
    let size = scope.number(amount)?;
    let region = scope.region;
    let watch = scope.watch();
    let inner = match by {
        By::Inset => {
            let all = whole(region, &Selection::all(region));
            let deep = depth(size, all, amount.span)?;
            inset(&region.area, deep, || watch.look())?
        }
        By::Scale => {
            let at = towards.map_or_else(|| middle(&region.area), |spot| spot.at);
            let near = room(region, at).max(0.0);
            // Of no use where the centre lies on the boundary: then only shares are.
            let amount = depth(size, 1.0, amount.span)?;
            let share = if is_share(size) {
                amount
            } else {
                amount / near
            };
            scaled(region, at, share, span)?
        }
    };
    let parts = Parts::new(region, "Contract");
    watch.look()?;
    let around = difference(std::slice::from_ref(&region.area), &inner);
    watch.look()?;
    let inner = parts.regions(inner, Role::Inner, &watch)?;
    if inner.is_empty() {
        return Err(Failure::unfit(
            span,
            "so contracted, nothing is left of this region",
        ));
    }
    let mut outputs = vec![
        Output::lawns(inner),
        Output::lawns(parts.regions(around, Role::Inner, &watch)?),
    ];
    if split {
        holes::split_all(&mut outputs, &watch)?;
    }
    Ok(Partition { outputs })
}

/// The region with all points moved by a share of their way to a place.
fn scaled(region: &Region, at: Coord<f64>, share: f64, span: Span) -> Result<Vec<Area>, Failure> {
    if !(share > 0.0 && share < 1.0) {
        return Err(Failure::unfit(
            span,
            "so contracted, nothing is left of this region",
        ));
    }
    let ring = |ring: &Ring| ring.iter().map(|&p| lerp(p, at, share)).collect();
    let image = Area {
        outer: ring(&region.area.outer),
        holes: region.area.holes.iter().map(ring).collect(),
    };
    Ok(intersection(&[image], std::slice::from_ref(&region.area)))
}

/// `Contract(1 m, selection)` as a value: its lines drawn in, those that have been
/// already by so much more.
pub(crate) fn lines(scope: &mut Scope<'_>, operation: &Operation) -> Result<Value, Failure> {
    let mut arguments = Arguments::new(operation);
    let expr = &arguments.need("a length")?.value;
    let by = scope.metres(expr)?;
    if by < 0.0 {
        return Err(Failure::fault(expr.span, "lines are drawn into the region"));
    }
    let of = match arguments.next() {
        Some(argument) => scope.value(&argument.value)?,
        None => Value::Selection(Selection::all(scope.region)),
    };
    arguments.done()?;
    Ok(match of {
        Value::Selection(selection) => Value::Inset(selection, by),
        Value::Inset(selection, before) => Value::Inset(selection, before + by),
        other => return Err(other.wrong(operation.span, "a selection to draw in")),
    })
}
