//! Words, numbers and marks of a text, each with its place and the comments
//! before it.

use winnow::ascii::{digit1, multispace1};
use winnow::combinator::{alt, delimited, opt, repeat};
use winnow::error::ContextError;
use winnow::prelude::*;
use winnow::stream::{LocatingSlice, Stream};
use winnow::token::{any, one_of, take_until, take_while};

use super::ast::{Span, Unit};
use super::diagnose::Diagnostic;

/// A word, number or mark.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum TokenKind {
    Word(String),
    Number(f64, Unit),
    Text(String),
    /// `->`, `..`, `==`, `{` and so on.
    Mark(&'static str),
    End,
}

/// A token with what stands before it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) span: Span,
    /// Comments between the token before and this one.
    pub(super) comments: Vec<String>,
    /// Whether something stands between the token before and this one.
    pub(super) apart: bool,
}

/// All marks, longer ones first.
const MARKS: [&str; 22] = [
    "->", "..", "==", "!=", "<=", ">=", "{", "}", "(", ")", "[", "]", "|", ",", ":", "=", "+", "-",
    "*", "/", "<", ">",
];

type Input<'s> = LocatingSlice<&'s str>;

/// What can stand in a text.
enum Piece {
    Space,
    Comment(String),
    Token(TokenKind),
    /// A comment or text that does not end.
    Open(&'static str),
    /// A number beyond all that can be counted with.
    Huge,
    Strange(char),
}

/// Takes a text to pieces; what it cannot read it reports and passes over. The
/// last token is [`TokenKind::End`].
pub(super) fn tokens(text: &str, file: usize, found: &mut Vec<Diagnostic>) -> Vec<Token> {
    let mut input = LocatingSlice::new(text);
    let mut tokens: Vec<Token> = Vec::new();
    let mut comments = Vec::new();
    let mut apart = true;
    let span = |start: usize, end: usize| Span { file, start, end };
    while !input.is_empty() {
        // `any` is the last choice, so that some piece there always is.
        let Ok((piece, range)) = piece.with_span().parse_next(&mut input) else {
            break;
        };
        let place = span(range.start, range.end);
        match piece {
            Piece::Space => apart = true,
            Piece::Comment(words) => {
                apart = true;
                comments.push(words);
            }
            Piece::Token(kind) => {
                tokens.push(Token {
                    kind,
                    span: place,
                    comments: std::mem::take(&mut comments),
                    apart: std::mem::take(&mut apart),
                });
            }
            Piece::Open(what) => found.push(Diagnostic::new(
                span(range.start, range.start + 1),
                format!("this {what} does not end"),
            )),
            Piece::Huge => found.push(Diagnostic::new(place, "this number is too large")),
            Piece::Strange('#') => {
                // A comment as other languages have it: one fault, not one for
                // each of its words.
                found.push(strange('#', place));
                let rest: &str = input.as_ref();
                let line = rest.find('\n').unwrap_or(rest.len());
                input.next_slice(line);
            }
            Piece::Strange(c) => found.push(strange(c, place)),
        }
    }
    tokens.push(Token {
        kind: TokenKind::End,
        span: span(text.len(), text.len()),
        comments,
        apart: true,
    });
    tokens
}

fn strange(c: char, place: Span) -> Diagnostic {
    let error = Diagnostic::new(place, format!("the character {c:?} has no meaning here"));
    match c {
        '\u{2192}' => error.hint("write -> for an arrow"),
        '\u{d7}' => error.hint("write * for a product"),
        '\u{201c}' | '\u{201d}' | '\'' => error.hint("write \"...\" for a text"),
        ';' => error.hint("operations follow each other without a mark"),
        '#' => error.hint("a comment begins with //"),
        '&' => error.hint("write and"),
        '!' => error.hint("write not"),
        _ => error,
    }
}

fn piece(input: &mut Input<'_>) -> Result<Piece, ContextError> {
    alt((
        multispace1.map(|_| Piece::Space),
        comment,
        number,
        word,
        text,
        mark,
        any.map(Piece::Strange),
    ))
    .parse_next(input)
}

fn comment(input: &mut Input<'_>) -> Result<Piece, ContextError> {
    fn trimmed(words: &str) -> Piece {
        Piece::Comment(words.trim().to_owned())
    }
    let line = ("//", take_while(0.., |c| c != '\n')).map(|(_, words)| trimmed(words));
    let block = delimited("/*", take_until(0.., "*/"), "*/").map(trimmed);
    let open = ("/*", take_while(0.., |_| true)).map(|_| Piece::Open("comment"));
    alt((line, block, open)).parse_next(input)
}

fn number(input: &mut Input<'_>) -> Result<Piece, ContextError> {
    // A dot belongs to a number only if a digit follows: 0..2 is a span.
    let fraction = ('.', digit1);
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    let whole = (digit1, opt(fraction), opt(exponent)).take();
    let (digits, unit) = (whole, opt(unit)).parse_next(input)?;
    let value = digits.parse::<f64>().map_err(|_| ContextError::new())?;
    if !value.is_finite() {
        return Ok(Piece::Huge);
    }
    let unit = unit.unwrap_or_default();
    Ok(Piece::Token(TokenKind::Number(value, unit)))
}

/// A unit right after a number or after spaces on its line; longer words are no
/// unit.
fn unit(input: &mut Input<'_>) -> Result<Unit, ContextError> {
    let spaces = take_while(0.., [' ', '\t']);
    let letters = take_while(1.., |c: char| c.is_alphanumeric() || c == '_');
    let known = |word: &str| Unit::parse(word);
    (spaces, alt((letters, "%")))
        .map(|(_, word)| word)
        .verify_map(known)
        .parse_next(input)
}

fn word(input: &mut Input<'_>) -> Result<Piece, ContextError> {
    let first = one_of(|c: char| c.is_alphabetic() || c == '_');
    let rest = take_while(0.., |c: char| c.is_alphanumeric() || c == '_');
    let word = (first, rest).take();
    word.map(|word: &str| Piece::Token(TokenKind::Word(word.to_owned())))
        .parse_next(input)
}

fn text(input: &mut Input<'_>) -> Result<Piece, ContextError> {
    let escaped = ('\\', one_of(['"', '\\'])).map(|(_, c)| c);
    let plain = take_one_of_text;
    let inside = repeat(0.., alt((escaped, plain))).fold(String::new, |mut text, c| {
        text.push(c);
        text
    });
    let whole = delimited('"', inside, '"').map(|text| Piece::Token(TokenKind::Text(text)));
    let open = ('"', take_while(0.., |c| c != '\n')).map(|_| Piece::Open("text"));
    alt((whole, open)).parse_next(input)
}

fn take_one_of_text(input: &mut Input<'_>) -> Result<char, ContextError> {
    one_of(|c: char| c != '"' && c != '\\' && c != '\n').parse_next(input)
}

fn mark(input: &mut Input<'_>) -> Result<Piece, ContextError> {
    let rest: &str = input.as_ref();
    let found = MARKS.into_iter().find(|mark| rest.starts_with(mark));
    let mark = found.ok_or_else(ContextError::new)?;
    mark.map(|_: &str| Piece::Token(TokenKind::Mark(mark)))
        .parse_next(input)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<TokenKind> {
        let mut found = Vec::new();
        let tokens = tokens(text, 0, &mut found);
        assert_eq!(found.len(), 0, "{found:?}");
        tokens.into_iter().map(|t| t.kind).collect()
    }

    fn number(value: f64, unit: Unit) -> TokenKind {
        TokenKind::Number(value, unit)
    }

    #[test]
    fn numbers_have_units_and_spans_have_dots() {
        use TokenKind::{End, Mark, Word};
        let wanted = vec![
            number(0.0, Unit::None),
            Mark(".."),
            number(2.5, Unit::Metres),
            number(30.0, Unit::Degrees),
            number(40.0, Unit::Percent),
            number(2.0, Unit::None),
            Word("metro".into()),
            number(1e-3, Unit::None),
            End,
        ];
        assert_eq!(kinds("0..2.5m 30 deg 40 % 2 metro 1e-3"), wanted);
        // A unit does not wait on the next line.
        let lines = kinds("2\nm");
        assert_eq!(lines[1], Word("m".into()));
    }

    #[test]
    fn comments_go_to_what_follows() {
        let mut found = Vec::new();
        let tokens = tokens("a // one\n/* two */ b // end", 7, &mut found);
        assert!(found.is_empty());
        assert_eq!(tokens[1].comments, ["one", "two"]);
        assert_eq!(tokens[2].comments, ["end"]);
        let place = tokens[1].span;
        assert_eq!((place.file, place.start, place.end), (7, 19, 20));
    }

    /// What cannot be read is reported where it is, and the rest is read.
    #[test]
    fn strange_text_is_passed_over() {
        let mut found = Vec::new();
        let tokens = super::tokens("a \u{2192} b \"open", 0, &mut found);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].span.start, found[0].span.end), (2, 5));
        assert!(found[0].hint.as_deref().is_some_and(|h| h.contains("->")));
        assert_eq!(tokens.len(), 3);
        let tokens = super::tokens("a # b; c.\nd", 0, &mut found);
        assert_eq!((found.len(), tokens.len()), (3, 3));
    }

    #[test]
    fn texts_may_hold_quotes() {
        assert_eq!(
            kinds(r#""a \"b\" \\""#)[0],
            TokenKind::Text(r#"a "b" \"#.into())
        );
    }
}
