//! What is wrong with a grammar, shown in its text.

use std::fmt;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use super::ast::Span;

/// The texts of a grammar: its file, and those that it includes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sources {
    files: Vec<(String, String)>,
}

impl Sources {
    /// Adds a text under the name that errors give it; its number.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> usize {
        self.files.push((name.into(), text.into()));
        self.files.len() - 1
    }

    /// The text of a file.
    #[must_use]
    pub fn text(&self, file: usize) -> Option<&str> {
        self.files.get(file).map(|(_, text)| text.as_str())
    }

    /// The name of a file.
    #[must_use]
    pub fn name(&self, file: usize) -> Option<&str> {
        self.files.get(file).map(|(name, _)| name.as_str())
    }

    /// Line and column of the start of a span, from 1, columns in characters.
    #[must_use]
    pub fn position(&self, span: Span) -> (usize, usize) {
        let text = self.text(span.file).unwrap_or("");
        let mut before = span.start.min(text.len());
        while !text.is_char_boundary(before) {
            before -= 1;
        }
        let before = &text[..before];
        let line = before.bytes().filter(|&b| b == b'\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
        (line, column)
    }
}

/// A fault of a grammar, with its place and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Where.
    pub span: Span,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub hint: Option<String>,
}

impl Diagnostic {
    pub(crate) fn new(span: Span, message: impl Into<String>) -> Self {
        Self {
            span,
            message: message.into(),
            hint: None,
        }
    }

    pub(crate) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// The fault in its text, with a mark under the place.
    #[must_use]
    pub fn show(&self, sources: &Sources) -> String {
        let text = sources.text(self.span.file).unwrap_or("");
        let name = sources.name(self.span.file).unwrap_or("grammar");
        let end = self.span.end.min(text.len());
        let start = self.span.start.min(end);
        let snippet = Snippet::source(text)
            .path(name)
            .fold(true)
            .annotation(AnnotationKind::Primary.span(start..end));
        let mut group = Level::ERROR
            .primary_title(self.message.as_str())
            .element(snippet);
        if let Some(hint) = &self.hint {
            group = group.element(Level::HELP.message(hint.as_str()));
        }
        Renderer::plain().render(&[group])
    }
}

/// All that is wrong with a grammar, in the order of its text, with the texts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    /// The faults; never none.
    pub all: Vec<Diagnostic>,
    /// The texts that they point into.
    pub sources: Sources,
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, one) in self.all.iter().enumerate() {
            if k > 0 {
                f.write_str("\n\n")?;
            }
            f.write_str(&one.show(&self.sources))?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}

/// The one of `known` that `word` may have been meant to be.
pub(crate) fn nearest<'k>(word: &str, known: impl Iterator<Item = &'k str>) -> Option<&'k str> {
    let lower = word.to_lowercase();
    let near = |other: &&str| strsim::damerau_levenshtein(&lower, &other.to_lowercase());
    let allowed = 1 + word.chars().count() / 4;
    known
        .map(|other| (near(&other), other))
        .filter(|(away, _)| *away <= allowed)
        .min()
        .map(|(_, other)| other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_shown_in_its_text() {
        let mut sources = Sources::default();
        sources.add("a.park", "grammar 1\nRegion -> Gird(2, 2)\n");
        let span = Span {
            file: 0,
            start: 20,
            end: 24,
        };
        assert_eq!(sources.position(span), (2, 11));
        let shown = Diagnostic::new(span, "there is nothing called Gird")
            .hint("did you mean Grid?")
            .show(&sources);
        for part in [
            "a.park:2:11",
            "Region -> Gird(2, 2)",
            "^^^^",
            "did you mean Grid?",
        ] {
            assert!(shown.contains(part), "{part} in\n{shown}");
        }
    }

    #[test]
    fn near_words_are_found() {
        let known = ["Grid", "Peel", "CastRays"];
        assert_eq!(nearest("Gird", known.into_iter()), Some("Grid"));
        assert_eq!(nearest("castray", known.into_iter()), Some("CastRays"));
        assert_eq!(nearest("Fountain", known.into_iter()), None);
    }
}
