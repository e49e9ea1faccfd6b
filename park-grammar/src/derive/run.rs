//! A derivation under way: its parameters, its limits, and what it leaves.

use std::collections::BTreeMap;
use std::slice::from_ref;

use super::limits::Limits;
use super::{DeriveOptions, Node, Number, Places, Scope, Value, Watch};
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
    pub(super) limits: &'g Limits<'g>,
}

impl<'g> Run<'g> {
    pub(super) fn set_params(&mut self, node: &mut Node) -> Result<(), Failure> {
        let known: Vec<&str> = self.grammar.params().collect();
        if let Some(name) = self
            .options
            .params
            .keys()
            .find(|k| !known.contains(&k.as_str()))
        {
            return Err(Failure::Stopped(ParkError::Parameter {
                name: name.clone(),
                known: known.join(", "),
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
            limits: self.limits,
            rule: &node.rule,
        }
    }

    /// Counts an operation, and sees that there are not too many.
    pub(crate) fn count(&self, node: &Node) -> Result<(), Failure> {
        self.limits.operation(&node.rule)
    }

    /// What a long operation looks at on its way.
    pub(crate) fn watch(&self, node: &Node) -> Watch<'g> {
        Watch::new(self.limits, &node.rule)
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
        self.limits.deeper(&node.rule, node.level)?;
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
            difference(from_ref(&node.region.area), node.carved.all())
        };
        // What it is made of says whether one walks on it: a bed of flowers where
        // paths cross is no path, a paved place on a lawn is one.
        let ground = match library::material_named(node.material) {
            Some(material) if material.path => Ground::Path,
            Some(_) => Ground::Region,
            None => node.ground,
        };
        for &k in &node.standing.objects {
            self.scene.objects[k].ground = ground;
        }
        for area in left {
            self.scene.pieces.push(Piece {
                polygon: area.to_polygon(),
                ground,
                material: node.material.to_owned(),
                rule: node.rule.to_string(),
            });
        }
        Ok(())
    }
}
