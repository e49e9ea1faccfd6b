//! What is done at places of a region: things put there, and shapes cut out.

use std::slice::from_ref;

use geo_types::Coord;

use super::{clear, Node, Places, Run, Spot};
use crate::error::Failure;
use crate::index;
use crate::plane::{difference, intersection, Area};
use crate::rule::{control, operator_named, Deed, Primitive};
use crate::shape::{Heritage, Role};
use crate::syntax::ast::{Operation, Span};

/// More than a radius, by more than rounding.
const CLEAR: f64 = 1.0 + 1e-6;

impl Run<'_> {
    /// Cuts a shape out of a region, and does the rest on what was cut out.
    pub(crate) fn carve(
        &mut self,
        node: &mut Node,
        span: Span,
        primitive: Primitive,
        spot: Spot,
        rest: &[Operation],
        places: &Places,
    ) -> Result<(), Failure> {
        if node.divided {
            return Err(Failure::fault(span, "this region has been divided already"));
        }
        let ring = primitive.ring(spot.at, spot.facing);
        let shape = Area::new(ring, Vec::new());
        let Some(area) = free_ground(node, shape, spot.at, primitive.radius()) else {
            return Err(Failure::unfit(span, "there is no room for this shape"));
        };
        let local = crate::shape::Local::upright(&area.outer);
        let heritage = Heritage::new(&node.region, "Shape");
        let mut region = heritage.piece(area.clone(), local, |_, _| Some(Role::Centre));
        index::by_local(&mut region);
        node.carved.push(area);
        let mut child = node.child(region);
        self.deeper(&mut child, |run, child| run.body(child, rest, places))?;
        self.finish(&mut child)
    }

    /// Does the operations of the blocks at each of some places of a region.
    pub(crate) fn at_spots(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        places: &Places,
        spots: &[Spot],
    ) -> Result<(), Failure> {
        let branches = || operation.blocks.iter().flat_map(|b| &b.branches);
        for &spot in spots {
            for branch in branches() {
                self.at_spot(node, &branch.body.operations, places, spot)?;
            }
        }
        Ok(())
    }

    pub(crate) fn at_spot(
        &mut self,
        node: &mut Node,
        body: &[Operation],
        places: &Places,
        spot: Spot,
    ) -> Result<(), Failure> {
        for (k, operation) in body.iter().enumerate() {
            self.count(node)?;
            let name = operation.name.text.as_str();
            let grammar = self.grammar;
            if let Some(rule) = grammar.rule(name) {
                let bound = self.bound(node, operation, &rule.places, places)?;
                self.deeper(node, |run, node| {
                    run.at_spot(node, &rule.body.operations, &bound, spot)
                })?;
                continue;
            }
            match operator_named(name).map(|o| o.deed) {
                Some(Deed::Shape) => {
                    let primitive = Primitive::read(operation, &mut self.scope(node, places))?;
                    let rest = &body[k + 1..];
                    return self.carve(node, operation.span, primitive, spot, rest, places);
                }
                Some(Deed::Branch) => {
                    let chosen = control::branch(operation, &mut self.scope(node, places))?;
                    if let Some(branch) = chosen {
                        self.at_spot(node, &branch.body.operations, places, spot)?;
                    }
                }
                Some(_) => {
                    let error = format!("{name} needs a region, and here is a place");
                    return Err(Failure::fault(operation.span, error)
                        .hint("begin with a shape, such as Circle(1)"));
                }
                None => self.thing(node, operation, places, spot)?,
            }
        }
        Ok(())
    }
}

/// A shape, if all of it lies on ground that is free, as the region has it.
/// `radius` is that of the circle around it.
fn free_ground(node: &Node, shape: Area, at: Coord<f64>, radius: f64) -> Option<Area> {
    let around = Spot::new(at, radius * CLEAR);
    if Run::room(node, around, around.radius, around.radius) {
        // Where the circle has room, so has the shape.
        return Some(shape);
    }
    let (low, high) = shape.extent();
    let discs = node.standing.near(low, high);
    let mut taken = discs.iter().map(|disc| (disc.at, disc.radius));
    if taken.any(|(at, radius)| !clear(&shape, at, radius)) {
        return None;
    }
    let built: Vec<Area> = node
        .standing
        .built
        .near(low, high)
        .into_iter()
        .cloned()
        .collect();
    if !built.is_empty() && !intersection(from_ref(&shape), &built).is_empty() {
        return None;
    }
    let mut found = intersection(from_ref(&shape), from_ref(&node.region.area));
    let carved: Vec<Area> = node.carved.near(low, high).into_iter().cloned().collect();
    if !carved.is_empty() {
        found = difference(&found, &carved);
    }
    match found.as_slice() {
        [area] if (area.size() - shape.size()).abs() <= 1e-6 * shape.size() => found.pop(),
        _ => None,
    }
}
