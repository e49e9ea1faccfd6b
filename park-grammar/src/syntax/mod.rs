//! The language: its tree, its parser, its printer and its faults.
//!
//! ```
//! use park_grammar::syntax::{parse, print, Sources};
//!
//! let mut sources = Sources::default();
//! sources.add("square.park", "grammar 1\nRegion->Grid(2,2){Quarter}{ }\nQuarter -> Lawn");
//! let tree = parse(&sources, 0)?;
//! assert_eq!(print(&tree), "grammar 1\n\nRegion -> Grid(2, 2) { Quarter } {}\n\nQuarter -> Lawn\n");
//! # Ok::<(), park_grammar::syntax::Diagnostics>(())
//! ```

pub mod ast;
mod diagnose;
mod lex;
mod parse;
mod print;

pub(crate) use diagnose::nearest;
pub use diagnose::{Diagnostic, Diagnostics, Sources};
pub use parse::{RESERVED, VERSION};
pub use print::print;

/// Reads one of the texts; includes are not followed.
///
/// # Errors
///
/// All faults of the text, each with its place.
pub fn parse(sources: &Sources, file: usize) -> Result<ast::File, Diagnostics> {
    let (tree, found) = parse::parse(sources.text(file).unwrap_or(""), file);
    if found.is_empty() {
        Ok(tree)
    } else {
        Err(Diagnostics {
            all: found,
            sources: sources.clone(),
        })
    }
}
