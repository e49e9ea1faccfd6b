//! What a block puts at a place: how much ground it takes, and the act of putting
//! it there.

use std::sync::Arc;

use super::standing::{inside, Disc};
use super::{Node, Places, Run, Spot, Value};
use crate::error::Failure;
use crate::library;
use crate::rule::{operator_named, Deed, Primitive};
use crate::scene::{Ground, Kind, Object};
use crate::syntax::ast::{Body, Operation, Span};

/// The ground that something takes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Size {
    /// Radius of its footprint.
    pub(crate) radius: f64,
    /// How far it reaches above the ground.
    pub(crate) spread: f64,
}

impl Run<'_> {
    /// The kind of object of a name: a place of the rule, a parameter, or one of
    /// the library's.
    pub(crate) fn kind(&self, name: &str, places: &Places) -> Option<Arc<Kind>> {
        match places.get(name).or_else(|| self.params.get(name)) {
            Some(Value::Kind(kind)) => return Some(kind.clone()),
            Some(Value::Word(word)) if word != name => return self.kind(word, &Places::new()),
            _ => {}
        }
        library::thing_named(name).map(|thing| Arc::new(Kind::from(thing)))
    }

    /// How much ground operations at a place take: all things before the first
    /// shape, and that.
    pub(crate) fn size(
        &mut self,
        node: &mut Node,
        body: &Body,
        places: &Places,
    ) -> Result<Size, Failure> {
        self.size_within(node, body, places, 0)
    }

    fn size_within(
        &mut self,
        node: &mut Node,
        body: &Body,
        places: &Places,
        depth: usize,
    ) -> Result<Size, Failure> {
        let mut size = Size::default();
        let mut take = |more: Size| {
            size.radius = size.radius.max(more.radius);
            size.spread = size.spread.max(more.spread);
        };
        if depth >= self.limits.depth() {
            return Ok(size);
        }
        let grammar = self.grammar;
        for operation in &body.operations {
            let name = operation.name.text.as_str();
            if let Some(rule) = grammar.rule(name) {
                let bound = self.bound(node, operation, &rule.places, places)?;
                take(self.size_within(node, &rule.body, &bound, depth + 1)?);
                continue;
            }
            match operator_named(name).map(|o| o.deed) {
                Some(Deed::Shape) => {
                    let primitive = Primitive::read(operation, &mut self.scope(node, places))?;
                    let radius = primitive.radius();
                    take(Size {
                        radius,
                        spread: radius,
                    });
                    break;
                }
                Some(Deed::Branch) => {
                    for branch in operation.blocks.iter().flat_map(|b| &b.branches) {
                        take(self.size_within(node, &branch.body, places, depth + 1)?);
                    }
                }
                Some(_) => {}
                None => {
                    if let Some(kind) = self.kind(name, places) {
                        take(Size {
                            radius: kind.radius,
                            spread: kind.spread,
                        });
                    }
                }
            }
        }
        Ok(size)
    }

    /// Whether a footprint has room on a region, `reach` from what others reach
    /// to.
    pub(crate) fn room(node: &Node, spot: Spot, radius: f64, reach: f64) -> bool {
        node.standing.apart(spot.at, radius, reach)
            && inside(&node.region.area, spot.at, radius)
            && node.carved.clear(spot.at, radius)
    }

    /// A thing at a place, if there is room for it; else it is left out, and
    /// counted.
    pub(crate) fn thing(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        places: &Places,
        spot: Spot,
    ) -> Result<(), Failure> {
        let name = operation.name.text.as_str();
        let Some(kind) = self.kind(name, places) else {
            return Err(Failure::fault(
                operation.span,
                format!("{name} is nothing that can stand here"),
            ));
        };
        if !Self::room(node, spot, kind.radius, kind.radius) {
            self.scene.skipped += 1;
            return Ok(());
        }
        node.standing.add(Disc {
            at: spot.at,
            radius: kind.radius,
            spread: kind.spread,
        });
        node.standing.objects.push(self.scene.objects.len());
        if library::thing_named(&kind.name).is_none()
            && self.scene.kinds.iter().all(|known| known.name != kind.name)
        {
            self.scene.kinds.push((*kind).clone());
        }
        self.scene.objects.push(Object {
            name: kind.name.clone(),
            at: spot.at,
            radius: kind.radius,
            spread: kind.spread,
            height: kind.height,
            facing: spot.facing,
            ground: Ground::Region,
        });
        Ok(())
    }

    /// Does operations at a place, where what does not fit is left out and
    /// counted.
    pub(crate) fn try_spot(
        &mut self,
        node: &mut Node,
        body: &[Operation],
        places: &Places,
        spot: Spot,
    ) -> Result<(), Failure> {
        match self.at_spot(node, body, places, spot) {
            Err(Failure::Unfit(_)) => {
                self.scene.skipped += 1;
                Ok(())
            }
            other => other,
        }
    }

    /// How many things have been put and left out, to see what an operation did.
    pub(crate) fn tally(&self) -> [usize; 2] {
        let scene = &self.scene;
        let put = scene.objects.len() + scene.volumes.len() + scene.pieces.len();
        [put, scene.skipped]
    }

    /// An operation that put nothing since nothing had room does not suit the
    /// region, if it has an alternative; else that is counted only.
    pub(crate) fn suited(&self, operation: &Operation, before: [usize; 2]) -> Result<(), Failure> {
        let [put, skipped] = self.tally();
        let nothing = put == before[0] && skipped > before[1];
        if nothing && operation.otherwise.is_some() {
            return Err(no_room(operation.span));
        }
        Ok(())
    }
}

fn no_room(span: Span) -> Failure {
    Failure::unfit(span, "there is no room for any of this")
}
