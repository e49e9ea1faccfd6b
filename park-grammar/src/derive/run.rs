//! A derivation under way: its parameters, its limits, and what it leaves.

use std::collections::BTreeMap;
use std::slice::from_ref;
use std::time::Instant;

use super::{DeriveOptions, Node, Number, Places, Scope, Value};
use crate::error::{Failure, ParkError};
use crate::grammar::Grammar;
use crate::library;
use crate::plane::difference;
use crate::scene::{Ground, Piece, Scene};
use crate::syntax::ast::Operation;

/// A derivation under way.
pub(crate) struct Run<'g> {
    pub(super) grammar: &'g Grammar,
    pub(super) params: BTreeMap<String, Value>,
    pub(crate) scene: Scene,
    pub(super) options: &'g DeriveOptions,
    pub(super) began: Instant,
    pub(super) operations: usize,
    pub(super) steps: std::cell::Cell<usize>,
    pub(super) watch: &'g mut dyn FnMut(usize) -> bool,
}

impl Run<'_> {
    pub(super) fn set_params(&mut self, node: &mut Node) -> Result<(), Failure> {
        let known: Vec<&str> = self.grammar.params().collect();
        if let Some(name) = self
            .options
            .params
            .keys()
            .find(|k| !known.contains(&k.as_str()))
        {
            let known = if known.is_empty() {
                "none".to_owned()
            } else {
                known.join(", ")
            };
            return Err(Failure::Stopped(ParkError::Param {
                name: name.clone(),
                known,
            }));
        }
        for (name, expr) in self.grammar.param_values() {
            let mut value = match self.options.params.get(&name.text) {
                Some(&value) => Value::Number(Number::plain(value)),
                None => self.scope(node, &Places::new()).lasting(expr)?,
            };
            if let Value::Kind(kind) = &mut value {
                std::sync::Arc::make_mut(kind).name.clone_from(&name.text);
            }
            self.params.insert(name.text.clone(), value);
        }
        Ok(())
    }

    pub(super) fn start(&mut self, node: &mut Node) -> Result<(), Failure> {
        let grammar = self.grammar;
        if let Some(rule) = grammar.rule(&node.rule) {
            self.body(node, &rule.body.operations, &Places::new())?;
        }
        self.finish(node)
    }

    /// What expressions of a node are evaluated in.
    pub(crate) fn scope<'s>(&'s self, node: &'s mut Node, places: &'s Places) -> Scope<'s> {
        Scope {
            grammar: self.grammar,
            params: &self.params,
            places,
            region: &node.region,
            chance: &mut node.chance,
            depth: 0,
            steps: &self.steps,
        }
    }

    /// Counts an operation, and sees that there are not too many.
    pub(crate) fn count(&mut self) -> Result<(), Failure> {
        let stopped = |error| Err(Failure::Stopped(error));
        self.operations += 1;
        if self.operations > self.options.operations {
            return stopped(ParkError::Limit {
                what: format!("it came to {} operations", self.options.operations),
            });
        }
        if self
            .options
            .time
            .is_some_and(|time| self.began.elapsed() > time)
        {
            return stopped(ParkError::Limit {
                what: "it took too long".to_owned(),
            });
        }
        if !(self.watch)(self.operations) {
            return stopped(ParkError::Cancelled);
        }
        Ok(())
    }

    pub(crate) fn bound(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        wanted: &[crate::syntax::ast::Name],
        places: &Places,
    ) -> Result<Places, Failure> {
        let arguments = operation.arguments.as_deref().unwrap_or(&[]);
        self.scope(node, places)
            .bind(operation.span, wanted, arguments)
    }

    pub(super) fn deeper(
        &mut self,
        node: &mut Node,
        inner: impl FnOnce(&mut Self, &mut Node) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        if node.level >= self.options.depth {
            return Err(Failure::Stopped(ParkError::Limit {
                what: format!(
                    "rules lead to rules {} deep, at {}",
                    self.options.depth, node.rule
                ),
            }));
        }
        node.level += 1;
        let done = inner(self, node);
        node.level -= 1;
        done
    }

    /// Leaves a region that nothing divided as ground.
    pub(super) fn finish(&mut self, node: &mut Node) -> Result<(), Failure> {
        if node.divided {
            return Ok(());
        }
        let left = if node.carved.is_empty() {
            vec![node.region.area.clone()]
        } else {
            difference(from_ref(&node.region.area), &node.carved)
        };
        let walked = library::material_named(&node.material).is_some_and(|m| m.path);
        let ground = if walked { Ground::Path } else { node.ground };
        for &k in &node.standing.objects {
            self.scene.objects[k].ground = ground;
        }
        for area in left {
            self.scene.pieces.push(Piece {
                polygon: area.to_polygon(),
                ground,
                material: node.material.clone(),
                rule: node.rule.clone(),
            });
        }
        Ok(())
    }
}
