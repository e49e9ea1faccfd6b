//! The walk through the operations of a body, one after the other.

use super::{Node, Places, Run, Spot};
use crate::error::Failure;
use crate::library;
use crate::plane::middle;
use crate::rule::{self, control, operator_named, Deed, Primitive};
use crate::syntax::ast::Operation;

/// How far the scene was, to go back to.
struct Before {
    pieces: usize,
    objects: usize,
    volumes: usize,
    kinds: usize,
    skipped: usize,
}

impl Run<'_> {
    pub(super) fn body(
        &mut self,
        node: &mut Node,
        body: &[Operation],
        places: &Places,
    ) -> Result<(), Failure> {
        for (k, operation) in body.iter().enumerate() {
            self.count(node)?;
            let shape =
                operator_named(&operation.name.text).is_some_and(|o| matches!(o.deed, Deed::Shape));
            if shape && std::mem::take(&mut node.shaped) {
                continue;
            }
            if shape {
                let primitive = Primitive::read(operation, &mut self.scope(node, places))?;
                let spot = Spot::new(middle(&node.region.area), 0.0);
                return self.carve(
                    node,
                    operation.span,
                    primitive,
                    spot,
                    &body[k + 1..],
                    places,
                );
            }
            self.attempt(node, operation, places)?;
        }
        Ok(())
    }

    /// An operation, or what it names in case it fails.
    fn attempt(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        places: &Places,
    ) -> Result<(), Failure> {
        let Some(otherwise) = &operation.otherwise else {
            return self.operation(node, operation, places);
        };
        let before = Before {
            pieces: self.scene.pieces.len(),
            objects: self.scene.objects.len(),
            volumes: self.scene.volumes.len(),
            kinds: self.scene.kinds.len(),
            skipped: self.scene.skipped,
        };
        let (material, carved) = (node.material, node.carved.len());
        let standing = node.standing.clone();
        match self.operation(node, operation, places) {
            Err(Failure::Unfit(_)) => {
                self.scene.pieces.truncate(before.pieces);
                self.scene.objects.truncate(before.objects);
                self.scene.volumes.truncate(before.volumes);
                self.scene.kinds.truncate(before.kinds);
                self.scene.skipped = before.skipped;
                node.standing = standing;
                node.material = material;
                node.carved.truncate(carved);
                node.divided = false;
                for branch in &otherwise.branches {
                    self.body(node, &branch.body.operations, places)?;
                }
                Ok(())
            }
            other => other,
        }
    }

    fn operation(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        places: &Places,
    ) -> Result<(), Failure> {
        let name = operation.name.text.as_str();
        let span = operation.span;
        let grammar = self.grammar;
        if let Some(rule) = grammar.rule(name) {
            let bound = self.bound(node, operation, &rule.places, places)?;
            let before = std::mem::replace(&mut node.rule, rule.label.clone());
            self.deeper(node, |run, node| {
                run.body(node, &rule.body.operations, &bound)
            })?;
            // What follows in the rule above stands on the same ground.
            if !node.divided {
                node.rule = before;
            }
            return Ok(());
        }
        if let Some(function) = grammar.function(name) {
            let bound = self.bound(node, operation, &function.places, places)?;
            let crate::syntax::ast::Meaning::Body(body) = &function.meaning else {
                return Err(Failure::fault(
                    span,
                    format!("{name} is a value and no operation"),
                ));
            };
            return self.deeper(node, |run, node| run.body(node, &body.operations, &bound));
        }
        if let Some(operator) = operator_named(name) {
            return match operator.deed {
                Deed::Divide(divide) => self.divide(node, operation, places, divide, true),
                Deed::Part(divide) => self.divide(node, operation, places, divide, false),
                Deed::Act(act) => act(self, node, operation, places),
                Deed::Branch => {
                    let chosen = control::branch(operation, &mut self.scope(node, places))?;
                    match chosen {
                        Some(branch) => self.body(node, &branch.body.operations, places),
                        None => Ok(()),
                    }
                }
                Deed::Points => rule::points::act(self, node, operation, places),
                // Taken care of by `body`.
                Deed::Shape => Ok(()),
            };
        }
        if let Some(material) = library::material_named(name) {
            node.material = material.name;
            return Ok(());
        }
        let spot = Spot::new(middle(&node.region.area), 0.0);
        let before = self.tally();
        self.thing(node, operation, places, spot)?;
        self.suited(operation, before)
    }
}
