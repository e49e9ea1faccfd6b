//! The arguments of an operation, by place and by name.
//!
//! Words among them are written so that they tell what they are: flags, which
//! stand alone, in capitalised words as the notes' `CornersOrthogonal` (`Exact`,
//! `Through`); modes, the values of named arguments, in lower case (`facing =
//! in`); selectors and places in capitals (`OUTER`, `CENTRE`).

use crate::derive::{Number, Scope, Value};
use crate::error::Failure;
use crate::syntax::ast::{Argument, Expr, ExprKind, Operation};
use crate::syntax::nearest;

/// Arguments that are asked for one by one; what nobody asked for is a fault.
pub(crate) struct Arguments<'a> {
    operation: &'a Operation,
    plain: Vec<&'a Argument>,
    named: Vec<&'a Argument>,
    next: usize,
    asked: Vec<&'static str>,
    flags: Vec<&'static str>,
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
            flags: Vec::new(),
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

    /// The mode that an argument by name is set to, one of those that the rule
    /// knows; `None` if nothing is said.
    pub(crate) fn mode<T: Copy>(
        &mut self,
        scope: &mut Scope<'_>,
        name: &'static str,
        modes: &[(&'static str, T)],
    ) -> Result<Option<T>, Failure> {
        let Some(expr) = self.named(name) else {
            return Ok(None);
        };
        mode(scope, expr, name, modes).map(Some)
    }

    /// Whether a flag stands among the arguments that follow; passes it by.
    pub(crate) fn flag(
        &mut self,
        scope: &mut Scope<'_>,
        word: &'static str,
    ) -> Result<bool, Failure> {
        self.flags.push(word);
        let rest = self.plain.iter().enumerate().skip(self.next);
        let found = rest
            .filter(|(_, argument)| scope.word(&argument.value) == Some(word))
            .map(|(k, _)| k)
            .next();
        if let Some(k) = found {
            self.plain.remove(k);
        }
        Ok(found.is_some())
    }

    /// That all have been asked for.
    pub(crate) fn done(self) -> Result<(), Failure> {
        let name = &self.operation.name.text;
        if let Some(argument) = self.plain.get(self.next) {
            let error = format!("{name} has no use for this value");
            let failure = Failure::fault(argument.value.span, error);
            return Err(match &argument.value.kind {
                ExprKind::Name(word) if !self.flags.is_empty() => {
                    meant(failure, word, &self.flags, "its flags are")
                }
                _ => failure,
            });
        }
        for argument in self.named {
            let Some(given) = argument.name.as_ref() else {
                continue;
            };
            if !self.asked.contains(&given.text.as_str()) {
                let error = format!("{name} has no argument {}", given.text);
                let failure = Failure::fault(given.span, error);
                return Err(meant(failure, &given.text, &self.asked, "it has"));
            }
        }
        Ok(())
    }
}

/// The mode that an expression names.
pub(crate) fn mode<T: Copy>(
    scope: &mut Scope<'_>,
    expr: &Expr,
    name: &str,
    modes: &[(&'static str, T)],
) -> Result<T, Failure> {
    let word = match (&expr.kind, scope.word(expr)) {
        (ExprKind::Name(_), word) => word.map(str::to_owned),
        _ => match scope.value(expr)? {
            Value::Word(word) => Some(word),
            _ => None,
        },
    };
    let word = word.as_deref();
    if let Some((_, found)) = modes.iter().find(|(known, _)| word == Some(known)) {
        return Ok(*found);
    }
    let known: Vec<&str> = modes.iter().map(|(known, _)| *known).collect();
    let (last, others) = known.split_last().unwrap_or((&"", &[]));
    let error = format!("{name} is {} or {last}", others.join(", "));
    let failure = Failure::fault(expr.span, error);
    Err(
        match word.and_then(|word| nearest(word, known.into_iter())) {
            Some(near) => failure.hint(format!("did you mean {near}?")),
            None => failure,
        },
    )
}

/// A failure with the known word that another may have been meant to be, or all
/// of them.
fn meant(failure: Failure, word: &str, known: &[&str], all: &str) -> Failure {
    match nearest(word, known.iter().copied()) {
        Some(near) => failure.hint(format!("did you mean {near}?")),
        None if known.is_empty() => failure,
        None => failure.hint(format!("{all} {}", known.join(", "))),
    }
}
