//! Ten grammars to begin with, or to learn from.
//!
//! Each adapts to its park: they have been derived on real outlines from a third
//! of a hectare to fourteen, narrow, concave and with holes among them. Their
//! texts are written to be read, with comments that say what is done and why;
//! copy one, and change it.
//!
//! ```
//! use park_grammar::geo_types::polygon;
//! use park_grammar::{grammars, DeriveOptions};
//!
//! let square = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 60., y: 60.), (x: 0., y: 60.)];
//! for one in &grammars::ALL {
//!     let park = one.grammar()?.derive(&square, &DeriveOptions::default())?;
//!     assert!(!park.objects.is_empty(), "{}", one.title);
//! }
//! # Ok::<(), park_grammar::ParkError>(())
//! ```

use crate::{Grammar, ParkError};

/// A grammar of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Named {
    /// What it is called, such as `simple_square`.
    pub name: &'static str,
    /// What it makes, in a few words.
    pub title: &'static str,
    /// Its text.
    pub text: &'static str,
}

impl Named {
    /// The grammar, read and checked.
    ///
    /// # Errors
    ///
    /// None for the grammars of [`ALL`]; [`ParkError::Grammar`] for a text of your
    /// own that is not what it should be.
    pub fn grammar(&self) -> Result<Grammar, ParkError> {
        let unread = |file: &str| {
            Err(format!(
                "{file} cannot be read: {} includes none",
                self.name
            ))
        };
        Grammar::with_includes(&format!("{}.park", self.name), self.text, &unread)
    }
}

macro_rules! library {
    ($($name:literal: $title:literal,)*) => {
        /// All of them; the first six are examples of the notes that the language
        /// follows.
        pub const ALL: [Named; 10] = [$(Named {
            name: $name,
            title: $title,
            text: include_str!(concat!("../grammars/", $name, ".park")),
        },)*];
    };
}

library! {
    "simple_square": "Crossing paths with a fountain, and trees around four lawns",
    "circular_paths": "A round place in the middle, ring walks and rays to the corners",
    "free_form": "Soft lawns between winding paths, as between blocks of flats",
    "nested_grids": "Gardens within gardens, each level with paths of its own",
    "irregular_grid": "Leaning beds around a house, with a curved edge",
    "beam_park": "Straight views between several places",
    "pocket_park": "A sheltered lawn with benches that face in",
    "woodland": "Trees, a winding path and a clearing",
    "formal_garden": "Parterres that mirror each other around a round basin",
    "allotments": "Plots without paths between, fenced and each its own",
}

/// The grammar of that name.
#[must_use]
pub fn named(name: &str) -> Option<&'static Named> {
    static KNOWN: [Named; 10] = ALL;
    KNOWN.iter().find(|one| one.name == name)
}
