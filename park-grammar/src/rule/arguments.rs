//! The arguments of an operation, by place and by name.

use crate::derive::{Number, Scope, Value};
use crate::error::Failure;
use crate::syntax::ast::{Argument, Expr, Operation};
use crate::syntax::nearest;

/// Arguments that are asked for one by one; what nobody asked for is a fault.
pub(crate) struct Arguments<'a> {
    operation: &'a Operation,
    plain: Vec<&'a Argument>,
    named: Vec<&'a Argument>,
    next: usize,
    asked: Vec<&'static str>,
}

impl<'a> Arguments<'a> {
    pub(crate) fn new(operation: &'a Operation) -> Self {
        let all = operation.arguments.iter().flatten();
        let (named, plain) = all.partition(|argument| argument.name.is_some());
        Self {
            operation,
            plain,
            named,
            next: 0,
            asked: Vec::new(),
        }
    }

    /// The next argument without a name.
    pub(crate) fn next(&mut self) -> Option<&'a Argument> {
        let argument = self.plain.get(self.next).copied();
        self.next += usize::from(argument.is_some());
        argument
    }

    /// The next one, which must be there.
    pub(crate) fn need(&mut self, what: &str) -> Result<&'a Argument, Failure> {
        let (span, name) = (self.operation.span, &self.operation.name.text);
        self.next()
            .ok_or_else(|| Failure::fault(span, format!("{name} needs {what}")))
    }

    /// The argument of a name.
    pub(crate) fn named(&mut self, name: &'static str) -> Option<&'a Expr> {
        self.asked.push(name);
        let found = self
            .named
            .iter()
            .find(|a| a.name.as_ref().is_some_and(|n| n.text == name));
        found.map(|argument| &argument.value)
    }

    /// A number by name.
    pub(crate) fn number(
        &mut self,
        scope: &mut Scope<'_>,
        name: &'static str,
    ) -> Result<Option<Number>, Failure> {
        self.named(name).map(|expr| scope.number(expr)).transpose()
    }

    /// A length in metres by name.
    pub(crate) fn metres(
        &mut self,
        scope: &mut Scope<'_>,
        name: &'static str,
    ) -> Result<Option<f64>, Failure> {
        self.named(name).map(|expr| scope.metres(expr)).transpose()
    }

    /// Whether a flag stands among the arguments that follow; passes it by.
    pub(crate) fn flag(&mut self, scope: &mut Scope<'_>, word: &str) -> Result<bool, Failure> {
        for k in self.next..self.plain.len() {
            if let Value::Word(found) = scope.value(&self.plain[k].value)? {
                if found == word {
                    self.plain.remove(k);
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// That all have been asked for.
    pub(crate) fn done(self) -> Result<(), Failure> {
        let name = &self.operation.name.text;
        if let Some(argument) = self.plain.get(self.next) {
            let error = format!("{name} has no use for this value");
            return Err(Failure::fault(argument.value.span, error));
        }
        for argument in self.named {
            let Some(given) = argument.name.as_ref() else {
                continue;
            };
            if !self.asked.contains(&given.text.as_str()) {
                let error = format!("{name} has no argument {}", given.text);
                let failure = Failure::fault(given.span, error);
                return Err(match nearest(&given.text, self.asked.iter().copied()) {
                    Some(near) => failure.hint(format!("did you mean {near}?")),
                    None => failure.hint(format!("it has {}", self.asked.join(", "))),
                });
            }
        }
        Ok(())
    }
}
