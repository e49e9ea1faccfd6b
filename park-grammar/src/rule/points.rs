//! Places as the value of an operation: `ScatterCircles(5 {[5, 10]})`,
//! `Corners(Region)`.

use crate::derive::{Scope, Spot, Value};
use crate::error::Failure;
use crate::syntax::ast::{Body, Operation, Span};

use super::{operator_named, Arguments, Deed};

/// The places that a rule stands for, if all that it does is to give places.
pub(crate) fn of_rule(
    scope: &mut Scope<'_>,
    name: &str,
    span: Span,
) -> Result<Option<Vec<Spot>>, Failure> {
    let grammar = scope.grammar;
    let Some(rule) = grammar.rule(name) else {
        return Ok(None);
    };
    match rule.body.operations.as_slice() {
        [only] if gives_points(only) => of_operation(scope, only, span).map(Some),
        _ => Ok(None),
    }
}

/// The places that the body of a function gives.
pub(crate) fn of_body(scope: &mut Scope<'_>, body: &Body, span: Span) -> Result<Value, Failure> {
    match body.operations.as_slice() {
        [only] if gives_points(only) => of_operation(scope, only, span).map(Value::Spots),
        _ => Err(Failure::fault(
            span,
            "this function has operations and no value",
        )),
    }
}

fn gives_points(operation: &Operation) -> bool {
    operator_named(&operation.name.text).is_some_and(|o| matches!(o.deed, Deed::Points))
}

/// The same places with so much room.
pub(crate) fn with_room(spots: Vec<Spot>, radius: f64) -> Vec<Spot> {
    spots
        .into_iter()
        .map(|spot| Spot { radius, ..spot })
        .collect()
}

fn of_operation(
    scope: &mut Scope<'_>,
    operation: &Operation,
    span: Span,
) -> Result<Vec<Spot>, Failure> {
    match operation.name.text.as_str() {
        "Corners" => Ok(corners(scope)),
        other => Err(Failure::fault(span, format!("{other} gives no places"))),
    }
}

/// The corners of the region, clockwise.
fn corners(scope: &Scope<'_>) -> Vec<Spot> {
    let sides = scope.region.logical();
    sides
        .iter()
        .map(|side| Spot {
            at: side.line[0],
            radius: 0.0,
            facing: 0.0,
        })
        .collect()
}
