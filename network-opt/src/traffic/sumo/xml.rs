//! XML, written.

use std::fmt::Write as _;

/// A document in the making.
#[derive(Debug)]
pub(super) struct Document {
    text: String,
    open: Vec<&'static str>,
}

impl Document {
    /// Opens a document with its root.
    pub(super) fn new(root: &'static str) -> Self {
        let mut document = Self {
            text: "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned(),
            open: Vec::new(),
        };
        document.open(root);
        document
    }

    /// Opens an element.
    pub(super) fn open(&mut self, name: &'static str) {
        let indent = 4 * self.open.len();
        let _ = writeln!(self.text, "{:indent$}<{name}>", "");
        self.open.push(name);
    }

    /// Closes the element that was opened last.
    pub(super) fn close(&mut self) {
        if let Some(name) = self.open.pop() {
            let indent = 4 * self.open.len();
            let _ = writeln!(self.text, "{:indent$}</{name}>", "");
        }
    }

    /// An element without content. Values may be any text.
    pub(super) fn element(&mut self, name: &str, attributes: &[(&str, &str)]) {
        let indent = 4 * self.open.len();
        let _ = write!(self.text, "{:indent$}<{name}", "");
        for (name, value) in attributes {
            let _ = write!(self.text, " {name}=\"{}\"", escaped(value));
        }
        self.text.push_str("/>\n");
    }

    /// The document, all that is open closed.
    pub(super) fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }
}

/// A text as it stands in an attribute. What XML 1.0 has no way to say, such as
/// control characters, becomes a question mark.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&apos;"),
            // Else a reader makes spaces of them.
            '\t' | '\n' | '\r' => {
                let _ = write!(out, "&#{};", u32::from(c));
            }
            // XML 1.0, production 2: what is no character.
            '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => out.push('?'),
            c => out.push(c),
        }
    }
    out
}

/// A number of at most so many digits after the point, without zeros at its end.
pub(super) fn number(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let short = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text.as_str()
    };
    if short == "-0" { "0" } else { short }.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_nest_and_values_are_escaped() {
        let mut document = Document::new("a");
        document.open("b");
        document.element("c", &[("d", "<\"&'>\u{1}\n\u{ffff}å")]);
        assert_eq!(
            document.finish(),
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<a>\n    <b>\n        <c d=\"&lt;&quot;&amp;&apos;&gt;?&#10;?å\"/>\n    </b>\n</a>\n"
        );
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(number(12.5, 3), "12.5");
        assert_eq!(number(100.0, 3), "100");
        assert_eq!(number(100.0, 0), "100");
        assert_eq!(number(-0.0001, 3), "0");
        assert_eq!(number(1.0 / 3.0, 3), "0.333");
    }
}
