//! `Place(CENTRE) { Tree }`, `Place((0.8, 0.1)) { Circle(1) Tree }`: something at
//! a place of the region.

use crate::derive::{Node, Places, Run, Spot, Value};
use crate::error::Failure;
use crate::rule::Arguments;
use crate::syntax::ast::Operation;

pub(crate) fn place(
    run: &mut Run<'_>,
    node: &mut Node,
    operation: &Operation,
    places: &Places,
) -> Result<(), Failure> {
    let mut arguments = Arguments::new(operation);
    let argument = arguments.need("a place, such as CENTRE or (0.5, 0.5)")?;
    let value = run.scope(node, places).value(&argument.value)?;
    arguments.done()?;
    let spot = |at| Spot {
        at,
        radius: 0.0,
        facing: 0.0,
    };
    let spots = match value {
        Value::Word(word) if word == "CENTRE" => vec![spot(node.region.area.centroid())],
        // Nothing is drawn where a cell has no such coordinates.
        Value::Point(at) => node.region.local.point(at).into_iter().map(spot).collect(),
        Value::Spots(spots) => spots,
        other => return Err(other.wrong(argument.value.span, "a place")),
    };
    run.at_spots(node, operation, places, &spots)
}
