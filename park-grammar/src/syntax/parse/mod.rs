//! From tokens to the tree, by descent.
//!
//! A fault ends what it stands in: a branch of a block, or else an item of the
//! file. The parser goes on with the next one, so that one run reports all
//! faults of a text.

mod expr;

use super::ast::{
    Argument, Block, Body, Branch, File, Head, Item, ItemKind, Meaning, Name, Operation, Span, Text,
};
use super::diagnose::Diagnostic;
use super::lex::{tokens, Token, TokenKind};

/// The version of the language that this crate reads.
pub const VERSION: u32 = 1;

/// Words that cannot be names.
pub const RESERVED: [&str; 8] = [
    "and", "or", "not", "minus", "else", "param", "fun", "include",
];

/// Deepest nesting of blocks and brackets: a bound on the stack.
const DEEPEST: usize = 64;

/// A fault that has been reported; what it stands in has no tree.
struct Fault;

type Parsed<T> = Result<T, Fault>;

/// Reads a text. The tree holds what could be read; it is the whole text if no
/// fault is found.
pub(super) fn parse(text: &str, file: usize) -> (File, Vec<Diagnostic>) {
    let mut found = Vec::new();
    let tokens = tokens(text, file, &mut found);
    let mut parser = Parser {
        tokens,
        at: 0,
        depth: 0,
        pending: Vec::new(),
        found,
    };
    let tree = parser.file();
    let mut found = parser.found;
    found.sort_by_key(|fault| fault.span.start);
    (tree, found)
}

struct Parser {
    tokens: Vec<Token>,
    at: usize,
    depth: usize,
    /// Comments passed by that wait for an item or operation to stand above.
    pending: Vec<String>,
    found: Vec<Diagnostic>,
}

impl Parser {
    fn token(&self) -> &Token {
        &self.tokens[self.at]
    }

    /// The kind of the token so many places ahead; the end beyond the end.
    fn ahead(&self, by: usize) -> &TokenKind {
        let last = self.tokens.len() - 1;
        &self.tokens[(self.at + by).min(last)].kind
    }

    fn is_mark(&self, mark: &str) -> bool {
        matches!(self.ahead(0), TokenKind::Mark(m) if *m == mark)
    }

    fn is_word(&self, word: &str) -> bool {
        matches!(self.ahead(0), TokenKind::Word(w) if w == word)
    }

    /// Passes the token by, and keeps its comments.
    fn pass(&mut self) -> Span {
        let token = &mut self.tokens[self.at];
        self.pending.append(&mut token.comments);
        let span = token.span;
        if self.at + 1 < self.tokens.len() {
            self.at += 1;
        }
        span
    }

    fn take_mark(&mut self, mark: &str) -> Option<Span> {
        self.is_mark(mark).then(|| self.pass())
    }

    fn take_word(&mut self, word: &str) -> Option<Span> {
        self.is_word(word).then(|| self.pass())
    }

    fn comments(&mut self) -> Vec<String> {
        let here = std::mem::take(&mut self.tokens[self.at].comments);
        let mut all = std::mem::take(&mut self.pending);
        all.extend(here);
        all
    }

    /// The span of the token before.
    fn before(&self) -> Span {
        self.tokens[self.at.saturating_sub(1)].span
    }

    fn fault<T>(&mut self, error: Diagnostic) -> Parsed<T> {
        self.found.push(error);
        Err(Fault)
    }

    /// The fault that something else is expected here.
    fn expected<T>(&mut self, what: &str) -> Parsed<T> {
        let token = self.token();
        let found = match &token.kind {
            TokenKind::Word(word) => format!("the word {word}"),
            TokenKind::Number(..) => "a number".to_owned(),
            TokenKind::Text(_) => "a text".to_owned(),
            TokenKind::Mark(mark) => format!("{mark:?}"),
            TokenKind::End => "the end of the text".to_owned(),
        };
        let error = Diagnostic::new(token.span, format!("expected {what}, found {found}"));
        self.fault(error)
    }

    fn need_mark(&mut self, mark: &str) -> Parsed<Span> {
        match self.take_mark(mark) {
            Some(span) => Ok(span),
            None => self.expected(&format!("{mark:?}")),
        }
    }

    fn name(&mut self, what: &str) -> Parsed<Name> {
        let TokenKind::Word(word) = self.ahead(0) else {
            return self.expected(what);
        };
        let text = word.clone();
        if RESERVED.contains(&text.as_str()) {
            let span = self.token().span;
            let error = Diagnostic::new(span, format!("expected {what}, found the word {text}"));
            return self
                .fault(error.hint(format!("{text} means something else; take another name")));
        }
        let span = self.pass();
        Ok(Name { text, span })
    }

    /// Runs `inner` one level deeper.
    fn nested<T>(&mut self, inner: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth == DEEPEST {
            let span = self.token().span;
            let error = Diagnostic::new(span, "this is nested too deeply");
            return self
                .fault(error.hint("give a part of it a name of its own, as a rule or function"));
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        result
    }

    fn file(&mut self) -> File {
        let mut file = File {
            version: VERSION,
            head: self.comments(),
            ..File::default()
        };
        self.version();
        while *self.ahead(0) != TokenKind::End {
            let comments = self.comments();
            let start = self.token().span;
            match self.item() {
                Ok(kind) => file.items.push(Item {
                    comments,
                    kind,
                    span: start.to(self.before()),
                }),
                Err(Fault) => {
                    self.depth = 0;
                    self.skip_item();
                }
            }
        }
        file.foot = self.comments();
        file
    }

    /// The line `grammar 1`.
    fn version(&mut self) {
        let span = self.token().span;
        if !(self.is_word("grammar") && matches!(self.ahead(1), TokenKind::Number(..))) {
            let start = Span {
                end: span.start,
                ..span
            };
            let error = Diagnostic::new(start, "a grammar begins with its version");
            self.found
                .push(error.hint(format!("write grammar {VERSION} above the first rule")));
            return;
        }
        self.pass();
        let known = matches!(self.ahead(0), TokenKind::Number(v, super::ast::Unit::None) if *v == f64::from(VERSION));
        let span = self.pass();
        if !known {
            let error = Diagnostic::new(span, "this version of the language is not known");
            self.found
                .push(error.hint(format!("this release reads version {VERSION}")));
        }
    }

    /// Whether an item of the file begins here: what ends the one before.
    fn starts_item(&self) -> bool {
        let TokenKind::Word(word) = self.ahead(0) else {
            return false;
        };
        match (word.as_str(), self.ahead(1)) {
            ("include", TokenKind::Text(_)) | ("param" | "fun", TokenKind::Word(_)) => true,
            (_, TokenKind::Mark("->" | "=")) => true,
            (_, TokenKind::Mark("(")) => {
                let places =
                    |k: &usize| matches!(self.ahead(*k), TokenKind::Word(_) | TokenKind::Mark(","));
                let close = 2 + (2..).take_while(places).count();
                *self.ahead(close) == TokenKind::Mark(")")
                    && *self.ahead(close + 1) == TokenKind::Mark("->")
            }
            _ => false,
        }
    }

    /// Goes on to where the next item begins.
    fn skip_item(&mut self) {
        // Whatever was wrong, one token at least is passed by.
        self.pass();
        while *self.ahead(0) != TokenKind::End && !self.starts_item() {
            self.pass();
        }
    }

    fn item(&mut self) -> Parsed<ItemKind> {
        if !self.starts_item() {
            let error = Diagnostic::new(self.token().span, "no rule begins here");
            return self.fault(error.hint("a rule is written Name -> operations"));
        }
        if self.is_word("include") && matches!(self.ahead(1), TokenKind::Text(_)) {
            self.pass();
            let TokenKind::Text(text) = self.ahead(0) else {
                return self.expected("the name of a file in quotes");
            };
            let text = text.clone();
            let span = self.pass();
            return Ok(ItemKind::Include(Text { text, span }));
        }
        let after_keyword = matches!(self.ahead(1), TokenKind::Word(_));
        if after_keyword && self.is_word("fun") {
            self.pass();
            let name = self.name("the name of a function")?;
            let places = self.places()?;
            let meaning = if self.take_mark("=").is_some() {
                Meaning::Value(self.expr()?)
            } else {
                self.need_mark("->")?;
                Meaning::Body(self.body()?)
            };
            return Ok(ItemKind::Function {
                name,
                places,
                meaning,
            });
        }
        let keyword = after_keyword && self.take_word("param").is_some();
        let name = self.name("the name of a rule")?;
        if keyword || self.is_mark("=") {
            self.need_mark("=")?;
            let value = self.expr()?;
            return Ok(ItemKind::Param { name, value });
        }
        let places = if self.is_mark("(") {
            self.places()?
        } else {
            Vec::new()
        };
        self.need_mark("->")?;
        let body = self.body()?;
        Ok(ItemKind::Rule { name, places, body })
    }

    /// `(a, b)`
    fn places(&mut self) -> Parsed<Vec<Name>> {
        self.need_mark("(")?;
        let mut places = Vec::new();
        while !self.is_mark(")") {
            places.push(self.name("the name of a place")?);
            if self.take_mark(",").is_none() {
                break;
            }
        }
        self.need_mark(")")?;
        Ok(places)
    }

    fn body(&mut self) -> Parsed<Body> {
        let mut body = Body::default();
        while matches!(self.ahead(0), TokenKind::Word(_))
            && !self.is_word("else")
            && !self.starts_item()
        {
            body.operations.push(self.operation()?);
        }
        // What is no operation must be what ends a body.
        match self.ahead(0) {
            TokenKind::End | TokenKind::Mark("|" | "}" | ",") => Ok(body),
            TokenKind::Word(_) => Ok(body),
            _ => self.expected("an operation, a rule, a material or an object"),
        }
    }

    fn operation(&mut self) -> Parsed<Operation> {
        let comments = self.comments();
        let name = self.name("an operation")?;
        let arguments = if self.is_mark("(") {
            Some(self.nested(Self::arguments)?)
        } else {
            None
        };
        let mut blocks = Vec::new();
        while self.is_mark("{") {
            blocks.push(self.nested(Self::block)?);
        }
        let otherwise = if self.take_word("else").is_some() {
            Some(self.nested(Self::block)?)
        } else {
            None
        };
        let span = name.span.to(self.before());
        Ok(Operation {
            comments,
            name,
            arguments,
            blocks,
            otherwise,
            span,
        })
    }

    fn arguments(&mut self) -> Parsed<Vec<Argument>> {
        self.need_mark("(")?;
        let mut arguments = Vec::new();
        while !self.is_mark(")") {
            let named = matches!(self.ahead(0), TokenKind::Word(_))
                && *self.ahead(1) == TokenKind::Mark("=");
            let name = if named {
                let name = self.name("the name of an argument")?;
                self.need_mark("=")?;
                Some(name)
            } else {
                None
            };
            let value = self.expr()?;
            let at = match self.take_mark(":") {
                Some(_) => Some(self.expr()?),
                None => None,
            };
            arguments.push(Argument { name, value, at });
            if self.take_mark(",").is_none() {
                break;
            }
        }
        if !self.is_mark(")") {
            return self.expected("\",\" or \")\"");
        }
        self.pass();
        Ok(arguments)
    }

    /// Branches between braces. A branch with a fault is left out.
    fn block(&mut self) -> Parsed<Block> {
        let open = self.need_mark("{")?;
        let mut branches = Vec::new();
        if !self.is_mark("}") {
            loop {
                match self.branch() {
                    Ok(branch) => branches.push(branch),
                    Err(Fault) => self.skip_branch(),
                }
                if self.take_mark("|").is_none() && self.take_mark(",").is_none() {
                    break;
                }
            }
        }
        if !self.is_mark("}") {
            let span = self.token().span;
            let error = Diagnostic::new(span, "a block is not closed before this");
            let place = self
                .found
                .iter()
                .any(|fault| fault.span.start == span.start && fault.span.end == span.end);
            if place {
                // The same place is at fault already.
                return Err(Fault);
            }
            return self.fault(error.hint("a } is missing"));
        }
        let close = self.pass();
        Ok(Block {
            branches,
            span: open.to(close),
        })
    }

    /// Goes on to the end of a branch of this block.
    fn skip_branch(&mut self) {
        let mut depth = 0_usize;
        while *self.ahead(0) != TokenKind::End && !self.starts_item() {
            match self.ahead(0) {
                TokenKind::Mark("{" | "(" | "[") => depth += 1,
                TokenKind::Mark("|" | "}") if depth == 0 => return,
                TokenKind::Mark("}" | ")" | "]") => depth = depth.saturating_sub(1),
                _ => {}
            }
            self.pass();
        }
    }

    fn branch(&mut self) -> Parsed<Branch> {
        let start = self.token().span;
        let head = if self.is_word("else") && *self.ahead(1) == TokenKind::Mark(":") {
            let span = self.pass();
            Some(Head::Else(span))
        } else if self.has_head() {
            Some(Head::Value(self.expr()?))
        } else {
            None
        };
        if head.is_some() {
            self.need_mark(":")?;
        }
        let body = self.body()?;
        Ok(Branch {
            head,
            body,
            span: start.to(self.before()),
        })
    }

    /// Whether a colon stands in this branch, outside all brackets.
    fn has_head(&self) -> bool {
        let mut depth = 0_usize;
        for token in &self.tokens[self.at..] {
            match token.kind {
                TokenKind::Mark("{" | "(" | "[") => depth += 1,
                TokenKind::Mark(":") if depth == 0 => return true,
                TokenKind::Mark("|" | "," | "->") | TokenKind::End if depth == 0 => return false,
                TokenKind::Mark("}" | ")" | "]") if depth == 0 => return false,
                TokenKind::Mark("}" | ")" | "]") => depth -= 1,
                _ => {}
            }
        }
        false
    }
}

#[cfg(test)]
mod tests;
