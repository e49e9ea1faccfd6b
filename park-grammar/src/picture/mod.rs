//! Parks as pictures: plans that a garden architect would pin up.
//!
//! [`Scene::draw`] draws what a park is made of, as elements of SVG to be put
//! into a document of one's own: ground with the texture of its material, paths
//! with kerbs, water with its banks, and what stands on it with shadows that are
//! as long as it is high. [`Scene::sheet`] puts that onto a sheet with a title, a
//! legend of all that the park has, a scale bar and a north arrow.
//!
//! Pictures depend on the scene and the options alone, byte by byte.

mod colour;
mod ground;
mod legend;
mod pen;
mod sheet;
mod standing;
mod texture;

use std::collections::BTreeMap;

use geo_types::Coord;

#[cfg(feature = "gltf")]
pub(crate) use colour::{darker, lighter, parts};
pub use sheet::{Anchor, Lettering, SheetOptions, Style, ViewersFont};
#[cfg(feature = "gltf")]
pub(crate) use standing::has_crown;

use crate::scene::Scene;
use pen::Pen;

/// How a park is drawn.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PictureOptions {
    /// The point of the plane that the picture's origin shows; the middle of the
    /// park's box if none is given.
    ///
    /// Default value: none.
    pub origin: Option<Coord<f64>>,
    /// Width of the thinnest lines, metres: what is thinner, such as a fence, is
    /// drawn as wide as that.
    ///
    /// Default value: 0.1 m.
    pub line: f64,
    /// Things that reach less far, metres, are not drawn.
    ///
    /// Default value: 0.
    pub least: f64,
    /// Whether what stands there throws a shadow.
    ///
    /// Default value: true.
    pub shadows: bool,
    /// What names of clips begin with: one of its own for each of several parks
    /// in one document.
    ///
    /// Default value: `park`.
    pub prefix: String,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            origin: None,
            line: 0.1,
            least: 0.0,
            shadows: true,
            prefix: "park".to_owned(),
        }
    }
}

impl PictureOptions {
    /// Sets the point that the picture's origin shows.
    #[must_use]
    pub fn with_origin(mut self, origin: Coord<f64>) -> Self {
        self.origin = Some(origin);
        self
    }

    /// Sets the width of the thinnest lines, metres.
    #[must_use]
    pub fn with_line(mut self, line: f64) -> Self {
        self.line = line;
        self
    }

    /// Sets how far a thing must reach to be drawn, metres.
    #[must_use]
    pub fn with_least(mut self, least: f64) -> Self {
        self.least = least;
        self
    }

    /// Sets what names of clips begin with.
    #[must_use]
    pub fn with_prefix(mut self, prefix: impl Into<String>) -> Self {
        self.prefix = prefix.into();
        self
    }
}

/// A park as elements of SVG.
///
/// One unit is a centimetre, x to the east and y to the south; scale the body to
/// what the document wants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Patterns and symbols that the body uses, by their ids, for the document's
    /// `defs`; those of several parks may be thrown together.
    pub defs: BTreeMap<String, String>,
    /// What is drawn.
    pub body: String,
}

impl Scene {
    /// Draws the park.
    ///
    /// # Examples
    ///
    /// ```
    /// use park_grammar::geo_types::polygon;
    /// use park_grammar::picture::PictureOptions;
    /// use park_grammar::{DeriveOptions, Grammar};
    ///
    /// let square = polygon![(x: 0., y: 0.), (x: 40., y: 0.), (x: 40., y: 40.), (x: 0., y: 40.)];
    /// let grammar = Grammar::new("grammar 1\nRegion -> Meadow Place(CENTRE) { Tree }")?;
    /// let park = grammar.derive(&square, &DeriveOptions::default())?;
    /// let drawing = park.draw(&PictureOptions::default());
    /// assert!(drawing.defs.contains_key("park-Tree"));
    /// let svg = format!(
    ///     "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-2000 -2000 4000 4000\"><defs>{}</defs>{}</svg>",
    ///     drawing.defs.values().cloned().collect::<String>(),
    ///     drawing.body,
    /// );
    /// # let _ = svg;
    /// # Ok::<(), park_grammar::ParkError>(())
    /// ```
    #[must_use]
    pub fn draw(&self, options: &PictureOptions) -> Drawing {
        let (low, high) = self.extent();
        let mut pen = Pen::new(options, options.origin.unwrap_or((low + high) / 2.0));
        ground::draw(&mut pen, self);
        standing::draw(&mut pen, self);
        pen.drawing
    }

    /// Lowest and highest coordinates of the ground.
    pub(crate) fn extent(&self) -> (Coord<f64>, Coord<f64>) {
        let points = self.pieces.iter().flat_map(|p| &p.polygon.exterior().0);
        let points: Vec<Coord<f64>> = points.copied().collect();
        crate::plane::extent(&points)
    }
}
