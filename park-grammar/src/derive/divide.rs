//! Regions that are divided, and the rules of their parts.

use std::collections::BTreeMap;

use super::{Node, Places, Run, Value};
use crate::error::Failure;
use crate::rule::{holes, operator_named, Ask, Deed, Partition, Primitive};
use crate::syntax::ast::{Body, Branch, Operation};

/// Width of paths where nothing is said, metres.
const PATH: f64 = 2.0;

impl Run<'_> {
    /// Divides a region, and goes on with each of the parts.
    pub(super) fn divide(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        places: &Places,
        divide: fn(&mut Ask<'_, '_>) -> Result<Partition, Failure>,
        centred: bool,
    ) -> Result<(), Failure> {
        if node.divided || !node.carved.is_empty() || !node.standing.is_empty() {
            let error = "this region has been divided already";
            return Err(Failure::fault(operation.span, error)
                .hint("divide first, and put things onto the parts in their own rules"));
        }
        let outputs = outputs(operation);
        let third = outputs.get(2).copied().flatten().filter(|_| centred);
        let centre = match third {
            Some(branch) => self.leading_shape(node, &branch.body, places, 0)?,
            None => None,
        };
        // Empty braces: the grammar wants no paths between.
        let no_paths = operation.blocks.get(1).is_some_and(|block| {
            block
                .branches
                .iter()
                .all(|branch| branch.body.operations.is_empty())
        });
        let path_width = if no_paths {
            0.0
        } else {
            path_width(&self.params)
        };
        let mut partition = divide(&mut Ask {
            operation,
            scope: self.scope(node, places),
            path_width,
            centre,
            centred: third.is_some_and(|branch| !branch.body.operations.is_empty()),
        })?;
        if holes::everywhere(&self.params) {
            holes::split_all(&mut partition.outputs, &self.watch(node))?;
        }
        node.divided = true;
        for (k, output) in partition.outputs.into_iter().enumerate() {
            let branch = outputs.get(k).copied().flatten();
            for region in output.regions {
                let mut child = node.child(region);
                child.ground = output.ground;
                child.material = output.material;
                child.shaped = k == 2 && centre.is_some();
                if let Some(branch) = branch {
                    self.deeper(&mut child, |run, child| {
                        run.body(child, &branch.body.operations, places)
                    })?;
                }
                self.finish(&mut child)?;
            }
        }
        Ok(())
    }

    /// The shape that operations begin with, through rules that do nothing
    /// before.
    fn leading_shape(
        &mut self,
        node: &mut Node,
        body: &Body,
        places: &Places,
        depth: usize,
    ) -> Result<Option<Primitive>, Failure> {
        let Some(first) = body.operations.first() else {
            return Ok(None);
        };
        let operator = operator_named(&first.name.text);
        if operator.is_some_and(|o| matches!(o.deed, Deed::Shape)) {
            return Primitive::read(first, &mut self.scope(node, places)).map(Some);
        }
        let grammar = self.grammar;
        match grammar.rule(&first.name.text) {
            Some(rule) if depth < self.limits.depth() => {
                let bound = self.bound(node, first, &rule.places, places)?;
                self.leading_shape(node, &rule.body, &bound, depth + 1)
            }
            _ => Ok(None),
        }
    }
}

/// `PathWidth`, as the grammar sets it.
pub(crate) fn path_width(params: &BTreeMap<String, Value>) -> f64 {
    match params.get("PathWidth") {
        Some(Value::Number(number)) => number.metres().unwrap_or(PATH),
        _ => PATH,
    }
}

/// The outputs that the blocks of an operation name: the branches of its only
/// block, or one for each block; `None` for an empty one.
pub(crate) fn outputs(operation: &Operation) -> Vec<Option<&Branch>> {
    match operation.blocks.as_slice() {
        [only] => only.branches.iter().map(Some).collect(),
        blocks => blocks.iter().map(|block| block.branches.first()).collect(),
    }
}
