//! `Choose { 3: A | 1: B }` and `Case { area > 500: A | else: B }`.

use crate::derive::Scope;
use crate::error::Failure;
use crate::syntax::ast::{Branch, Head, Operation};

/// The branch that an operation goes on with; `None` if there is none for this
/// region.
pub(crate) fn branch<'o>(
    operation: &'o Operation,
    scope: &mut Scope<'_>,
) -> Result<Option<&'o Branch>, Failure> {
    let branches: Vec<&Branch> = operation.blocks.iter().flat_map(|b| &b.branches).collect();
    if operation.name.text == "Case" {
        case(&branches, scope)
    } else {
        choose(operation, &branches, scope)
    }
}

/// The first branch whose condition holds.
fn case<'o>(branches: &[&'o Branch], scope: &mut Scope<'_>) -> Result<Option<&'o Branch>, Failure> {
    for branch in branches {
        let holds = match &branch.head {
            None => {
                let failure = Failure::fault(branch.span, "a branch of Case needs a condition");
                return Err(failure.hint("write else: before the last one"));
            }
            Some(Head::Else(_)) => true,
            Some(Head::Value(condition)) => scope.condition(condition)?,
        };
        if holds {
            return Ok(Some(branch));
        }
    }
    Ok(None)
}

/// One of the branches by chance; each weighs 1 where it does not say.
fn choose<'o>(
    operation: &Operation,
    branches: &[&'o Branch],
    scope: &mut Scope<'_>,
) -> Result<Option<&'o Branch>, Failure> {
    let mut weights = Vec::new();
    for branch in branches {
        let weight = match &branch.head {
            None => 1.0,
            Some(Head::Else(span)) => {
                return Err(Failure::fault(*span, "Choose weighs; else belongs to Case"));
            }
            Some(Head::Value(weight)) => {
                let number = scope.number(weight)?.value;
                if number < 0.0 {
                    return Err(Failure::fault(weight.span, "a weight is 0 or more"));
                }
                number
            }
        };
        weights.push(weight);
    }
    let all: f64 = weights.iter().sum();
    if branches.is_empty() || all <= 0.0 {
        return Err(Failure::fault(
            operation.span,
            "there is nothing to choose from",
        ));
    }
    let mut left = scope.chance.unit() * all;
    for (branch, weight) in branches.iter().zip(&weights) {
        if left < *weight {
            return Ok(Some(branch));
        }
        left -= weight;
    }
    Ok(branches
        .iter()
        .zip(&weights)
        .rev()
        .find(|(_, w)| **w > 0.0)
        .map(|(b, _)| *b))
}
