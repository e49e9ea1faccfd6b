//! Values.

use super::{Fault, Parsed, Parser, RESERVED};
use crate::syntax::ast::{BinaryOp, Expr, ExprKind, Name, Size, Span, UnaryOp, Unit};
use crate::syntax::lex::TokenKind;

impl Parser {
    pub(super) fn expr(&mut self) -> Parsed<Expr> {
        self.nested(|parser| parser.binary(1))
    }

    /// Operators at least this firm.
    fn binary(&mut self, least: u8) -> Parsed<Expr> {
        let mut left = self.unary()?;
        while let Some(op) = self.operator().filter(|op| op.strength() >= least) {
            self.pass();
            let right = self.binary(op.strength() + 1)?;
            let span = left.span.to(right.span);
            left = Expr {
                kind: ExprKind::Binary(op, Box::new([left, right])),
                span,
            };
            let again = self.operator().is_some_and(BinaryOp::compares);
            if op.compares() && again {
                return self.expected("and, or or the end of the comparison");
            }
        }
        Ok(left)
    }

    fn operator(&self) -> Option<BinaryOp> {
        let written = match self.ahead(0) {
            TokenKind::Word(word) => word.as_str(),
            TokenKind::Mark(mark) => mark,
            _ => return None,
        };
        BinaryOp::ALL.into_iter().find(|op| op.as_str() == written)
    }

    fn unary(&mut self) -> Parsed<Expr> {
        let op = match self.ahead(0) {
            TokenKind::Mark("-") => UnaryOp::Negate,
            TokenKind::Word(word) if word == "not" => UnaryOp::Not,
            _ => return self.postfix(),
        };
        let start = self.pass();
        // A minus binds more firmly than any operator between values; `not`
        // takes a whole comparison.
        let inner = self.nested(|parser| match op {
            UnaryOp::Negate => parser.unary(),
            UnaryOp::Not => parser.binary(BinaryOp::Equal.strength()),
        })?;
        let span = start.to(inner.span);
        Ok(Expr {
            kind: ExprKind::Unary(op, Box::new(inner)),
            span,
        })
    }

    /// A value with what may follow it: `[...]`, `{...}`, `..`.
    fn postfix(&mut self) -> Parsed<Expr> {
        let mut value = self.primary()?;
        loop {
            let start = value.span;
            // What begins a list, not an index, cannot follow a value.
            let kind = if self.is_mark("[") {
                let (items, _) = self.nested(Self::items)?;
                ExprKind::Index(Box::new(value), items)
            } else if self.is_mark("{") && !matches!(value.kind, ExprKind::Sizes { .. }) {
                let sizes = self.nested(Self::sizes)?;
                ExprKind::Sizes {
                    count: Some(Box::new(value)),
                    sizes,
                }
            } else {
                return Ok(value);
            };
            let span = start.to(self.before());
            value = Expr { kind, span };
        }
    }

    fn primary(&mut self) -> Parsed<Expr> {
        let start = self.token().span;
        let kind = match self.ahead(0).clone() {
            TokenKind::Number(value, unit) => {
                self.pass();
                ExprKind::Number(value, unit)
            }
            TokenKind::Text(text) => {
                self.pass();
                ExprKind::Text(text)
            }
            TokenKind::Word(text) if !RESERVED.contains(&text.as_str()) => {
                let span = self.pass();
                if self.is_mark("(") {
                    self.call(Name { text, span })?
                } else {
                    ExprKind::Name(text)
                }
            }
            TokenKind::Mark("[") => {
                let (items, _) = self.nested(Self::items)?;
                ExprKind::List(items)
            }
            TokenKind::Mark("{") => ExprKind::Sizes {
                count: None,
                sizes: self.nested(Self::sizes)?,
            },
            TokenKind::Mark("(") => return self.group(),
            _ => return self.expected("a value"),
        };
        Ok(Expr {
            kind,
            span: start.to(self.before()),
        })
    }

    fn call(&mut self, name: Name) -> Parsed<ExprKind> {
        let arguments = self.nested(Self::arguments)?;
        let mut blocks = Vec::new();
        while self.is_mark("{") {
            blocks.push(self.nested(Self::block)?);
        }
        Ok(ExprKind::Call {
            name,
            arguments,
            blocks,
        })
    }

    /// `(value)` or `(x, y)`.
    fn group(&mut self) -> Parsed<Expr> {
        let open = self.pass();
        let first = self.expr()?;
        if self.take_mark(",").is_none() {
            let close = self.need_mark(")")?;
            let span = open.to(close);
            return Ok(Expr { span, ..first });
        }
        let second = self.expr()?;
        let close = self.need_mark(")")?;
        Ok(Expr {
            kind: ExprKind::Point(Box::new([first, second])),
            span: open.to(close),
        })
    }

    /// Values between square brackets. `[5-10]`, one difference of two, is
    /// `[5, 10]`; `a..b` stands for whole numbers from a to b.
    fn items(&mut self) -> Parsed<(Vec<Expr>, Span)> {
        let open = self.pass();
        let mut items = Vec::new();
        while !self.is_mark("]") {
            items.push(self.item_or_span()?);
            if self.take_mark(",").is_none() {
                break;
            }
        }
        if !self.is_mark("]") {
            return self.expected("\",\" or \"]\"");
        }
        let close = self.pass();
        if let [only] = items.as_slice() {
            if let ExprKind::Binary(BinaryOp::Subtract, ends) = &only.kind {
                // A difference in brackets of its own begins before its first part.
                if ends[0].span.start == only.span.start {
                    items = ends.to_vec();
                }
            }
        }
        Ok((items, open.to(close)))
    }

    fn item_or_span(&mut self) -> Parsed<Expr> {
        let first = self.expr()?;
        if self.take_mark("..").is_none() {
            return Ok(first);
        }
        let last = self.expr()?;
        let span = first.span.to(last.span);
        Ok(Expr {
            kind: ExprKind::Span(Box::new([first, last])),
            span,
        })
    }

    /// `{2, [5, 7]a[-15, 15], a[-5, 5]}`
    fn sizes(&mut self) -> Parsed<Vec<Size>> {
        let open = self.pass();
        let mut sizes = Vec::new();
        while !self.is_mark("}") {
            let length = if self.at_angle() {
                None
            } else {
                Some(self.expr()?)
            };
            let angle = if self.at_angle() {
                self.pass();
                Some(self.nested(Self::postfix_or_negative)?)
            } else {
                None
            };
            sizes.push(Size { length, angle });
            if self.take_mark(",").is_none() {
                break;
            }
        }
        if !self.is_mark("}") {
            let fault = self.expected("\",\" or \"}\"");
            let block = matches!(
                self.ahead(0),
                TokenKind::Word(_) | TokenKind::Mark("|" | ":")
            );
            if let Some(last) = self.found.last_mut().filter(|_| block) {
                // Words and bars belong into a block, which an operation has.
                last.hint = Some(
                    "within round brackets braces hold sizes; is a ) missing before the {?"
                        .to_owned(),
                );
            }
            return fault;
        }
        self.pass();
        if sizes.is_empty() {
            self.found.push(
                super::Diagnostic::new(open.to(self.before()), "these braces hold no size")
                    .hint("leave them out to have sizes fitted"),
            );
            return Err(Fault);
        }
        Ok(sizes)
    }

    /// Whether the mark of an angle stands here: `a` before a number or range.
    fn at_angle(&self) -> bool {
        let value = matches!(
            self.ahead(1),
            TokenKind::Mark("[" | "-") | TokenKind::Number(..)
        );
        self.is_word("a") && value
    }

    fn postfix_or_negative(&mut self) -> Parsed<Expr> {
        // An angle is a number or a range, so that a size may follow it.
        if self.is_mark("-") {
            self.unary()
        } else {
            self.primary()
        }
    }
}

impl Unit {
    /// Whether a number of this unit is an angle.
    #[must_use]
    pub fn is_angle(self) -> bool {
        matches!(self, Self::Degrees | Self::Radians)
    }
}
