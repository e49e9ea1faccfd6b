//! A grammar's own objects: `param Oak = Object(radius = 0.4, height = 12,
//! spread = 4, colour = "#3f7a3a", mesh = "oak.obj")`.
//!
//! The name of the parameter is the object's. A mesh lies beside the grammar and
//! is read with it; the radius of its footprint and its height are the mesh's own
//! where they are not given. `scale` enlarges the mesh.

use std::sync::Arc;

use super::{Scope, Value};
use crate::error::Failure;
use crate::library::Thing;
use crate::rule::Arguments;
use crate::scene::Kind;
use crate::syntax::ast::{Argument, Expr, ExprKind, Name, Operation, Text};

/// The word for it.
pub(crate) const OBJECT: &str = "Object";

/// The file of the mesh that an expression names, if it is an object.
pub(crate) fn mesh_file(expr: &Expr) -> Option<Text> {
    let ExprKind::Call {
        name, arguments, ..
    } = &expr.kind
    else {
        return None;
    };
    let named = |a: &&Argument| a.name.as_ref().is_some_and(|n| n.text == "mesh");
    let argument = arguments
        .iter()
        .find(named)
        .filter(|_| name.text == OBJECT)?;
    match &argument.value.kind {
        ExprKind::Text(text) => Some(Text {
            text: text.clone(),
            span: argument.value.span,
        }),
        _ => None,
    }
}

/// The object, still without a name.
pub(crate) fn declared(
    scope: &mut Scope<'_>,
    name: &Name,
    arguments: &[Argument],
) -> Result<Value, Failure> {
    let operation = Operation {
        comments: Vec::new(),
        name: name.clone(),
        arguments: Some(arguments.to_vec()),
        blocks: Vec::new(),
        otherwise: None,
        span: name.span,
    };
    let mut arguments = Arguments::new(&operation);
    let mesh = match arguments.named("mesh") {
        Some(expr) => {
            let file = text(scope, expr)?;
            let known = scope.grammar.mesh(&file).cloned();
            let missing = || {
                let failure = Failure::fault(expr.span, format!("{file} has not been read"));
                failure.hint("name the file as the value of a param, in quotes")
            };
            Some(known.ok_or_else(missing)?)
        }
        None => None,
    };
    let scale = match arguments.number(scope, "scale")? {
        Some(number) if number.value > 0.0 => number.value,
        Some(_) => return Err(Failure::fault(name.span, "scale must be positive")),
        None => 1.0,
    };
    let mesh = mesh.map(|mesh| mesh.scaled(scale));
    let radius = arguments.metres(scope, "radius")?;
    let radius = radius.or_else(|| mesh.as_ref().map(crate::mesh::Mesh::radius));
    let Some(radius) = radius.filter(|&r| r > 0.0) else {
        return Err(Failure::fault(
            name.span,
            "an object needs a radius that is positive",
        ));
    };
    let height = arguments.metres(scope, "height")?;
    let height = height.or_else(|| mesh.as_ref().map(crate::mesh::Mesh::height));
    let spread = arguments.metres(scope, "spread")?.unwrap_or(radius);
    let colour = match arguments.named("colour") {
        Some(expr) => {
            let found = text(scope, expr)?;
            let hex = |c: char| c.is_ascii_hexdigit();
            let known =
                found.len() == 7 && found.starts_with('#') && found.chars().skip(1).all(hex);
            if !known {
                let failure = Failure::fault(expr.span, "this is no colour");
                return Err(failure.hint("write it as \"#rrggbb\""));
            }
            found
        }
        None => "#7a8a6a".to_owned(),
    };
    arguments.done()?;
    Ok(Value::Kind(Arc::new(Kind {
        name: String::new(),
        radius,
        spread: spread.max(radius),
        height: height.unwrap_or(0.0).max(0.0),
        colour,
        mesh,
    })))
}

fn text(scope: &mut Scope<'_>, expr: &Expr) -> Result<String, Failure> {
    match scope.value(expr)? {
        Value::Text(text) => Ok(text),
        other => Err(other.wrong(expr.span, "a text in quotes")),
    }
}

impl From<&Thing> for Kind {
    fn from(thing: &Thing) -> Self {
        Self {
            name: thing.name.to_owned(),
            radius: thing.radius,
            spread: thing.spread,
            height: thing.height,
            colour: thing.colour.to_owned(),
            mesh: None,
        }
    }
}
