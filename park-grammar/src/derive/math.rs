//! Functions of numbers: `min`, `max`, `sqrt`.
//!
//! The notes have no such functions, but a grammar that serves parks of half a
//! hectare and of fifty needs sizes that grow with the region and stop growing:
//! `Circle(min(8, 0.4 * room))`. Values of `min` and `max` are compared as
//! comparisons compare them: metres with feet, and with what has no unit. `sqrt`
//! is of a plain number: `sqrt(area)` is a length, metres.

use super::eval::compared;
use super::value::{Number, Value};
use super::Scope;
use crate::error::Failure;
use crate::syntax::ast::{Argument, Name, Unit};

/// Their names.
pub(crate) const NAMES: [&str; 3] = ["min", "max", "sqrt"];

/// The value of a function; `None` for a name that is none.
pub(super) fn call(
    scope: &mut Scope<'_>,
    name: &Name,
    arguments: &[Argument],
) -> Result<Option<Value>, Failure> {
    if !NAMES.contains(&name.text.as_str()) {
        return Ok(None);
    }
    let mut numbers = Vec::with_capacity(arguments.len());
    for argument in arguments {
        numbers.push((scope.number(&argument.value)?, argument.value.span));
    }
    let several = matches!(name.text.as_str(), "min" | "max");
    let wrong = || {
        let wanted = if several {
            "numbers to choose from"
        } else {
            "one number"
        };
        Failure::fault(name.span, format!("{} needs {wanted}", name.text))
    };
    let (&(first, span), rest) = numbers.split_first().ok_or_else(wrong)?;
    if !several && !rest.is_empty() {
        return Err(wrong());
    }
    let number = match name.text.as_str() {
        "sqrt" if first.value < 0.0 => {
            return Err(Failure::fault(
                span,
                "there is no root of less than nothing",
            ));
        }
        "sqrt" if first.unit == Unit::None => Number {
            value: first.value.sqrt(),
            unit: Unit::Metres,
        },
        "sqrt" => {
            let error = "the root of a length is nothing that one could use";
            return Err(Failure::fault(span, error));
        }
        word => {
            let mut best = first;
            for &(number, span) in rest {
                let (kept, new, unit) = compared(best, number, span)?;
                let take = if word == "min" {
                    new < kept
                } else {
                    new > kept
                };
                best = Number {
                    value: if take { new } else { kept },
                    unit,
                };
            }
            best
        }
    };
    Ok(Some(Value::Number(number)))
}
