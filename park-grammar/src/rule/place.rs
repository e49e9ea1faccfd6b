//! `Place(CENTRE) { Tree }`, `Place((0.8, 0.1), CORNER[0]) { Circle(1) Tree }`,
//! `Place(OUTER: 0.25, facing = in) { Bench }`: something at places of the region.
//!
//! Places are `CENTRE` (the centre of mass, or if that lies outside the point
//! with the most room), `POLE` (that point, so that `Circle(0.9 * room)` has room
//! in any region), points in local coordinates, corners, places that other
//! rules give, and parameters along selections (`OUTER: 0.25`; without one the
//! middle). What is to stand at a place of the boundary is drawn in until its
//! footprint lies inside, or by `offset`.
//!
//! Decided: a thing that has no room is left out and counted in
//! [`Scene::skipped`](crate::Scene); an operation that puts nothing for want of
//! room goes on with its `else`, if it has one. A shape that has no room does not
//! suit the region if it is for one place, and is left out if it is for several.

use crate::derive::{Node, Places, Run, Spot, Value};
use crate::error::Failure;
use crate::rule::points::{self, Facing};
use crate::rule::Arguments;
use crate::syntax::ast::Operation;

/// A place this near to the boundary, as a share of the region's size, is on it.
const NEAR: f64 = 1e-9;

pub(crate) fn place(
    run: &mut Run<'_>,
    node: &mut Node,
    operation: &Operation,
    places: &Places,
) -> Result<(), Failure> {
    let mut arguments = Arguments::new(operation);
    let mut next = Some(arguments.need("a place, such as CENTRE or (0.5, 0.5)")?);
    let mut spots = Vec::new();
    while let Some(argument) = next {
        let mut scope = run.scope(node, places);
        let value = scope.value(&argument.value)?;
        let span = argument.value.span;
        match (&argument.at, value) {
            (Some(at), Value::Selection(selection)) => {
                let share = points::share(&mut scope, at, selection.length())?;
                spots.extend(points::share_of(&node.region, &selection, share));
            }
            (Some(_), other) => return Err(other.wrong(span, "a selection before the colon")),
            (None, value) => spots.extend(points::spots(&node.region, value, span)?),
        }
        next = arguments.next();
    }
    let offset = arguments.metres(&mut run.scope(node, places), "offset")?;
    let facing = Facing::read(&mut arguments, &mut run.scope(node, places))?;
    arguments.done()?;
    let before = run.tally();
    let single = spots.len() == 1;
    for spot in spots {
        for branch in operation.blocks.iter().flat_map(|b| &b.branches) {
            let radius = run.size(node, &branch.body, places)?.radius;
            let spot = drawn_in(node, spot, offset, radius);
            let spot = facing.turn(node, spot);
            let body = &branch.body.operations;
            if single {
                run.at_spot(node, body, places, spot)?;
            } else {
                run.try_spot(node, body, places, spot)?;
            }
        }
    }
    run.suited(operation, before)
}

/// A place on the boundary moved the way it faces, by `offset` or until there is
/// room for a footprint.
fn drawn_in(node: &Node, spot: Spot, offset: Option<f64>, radius: f64) -> Spot {
    let area = &node.region.area;
    let (low, high) = area.extent();
    let size = (high.x - low.x).max(high.y - low.y);
    if area.nearest(spot.at).1 > NEAR * size {
        return spot;
    }
    let by = points::direction(spot.facing);
    let moved = |way: f64| Spot {
        at: spot.at + by * way,
        ..spot
    };
    if let Some(offset) = offset {
        return moved(offset);
    }
    let mut way = radius;
    // In a corner the room grows with the way: one step is enough unless other
    // sides are near.
    for _ in 0..8 {
        let room = area.nearest(moved(way).at).1;
        if room >= radius || room <= 0.0 {
            break;
        }
        way *= (1.0 + NEAR) * radius / room;
    }
    moved(way)
}
