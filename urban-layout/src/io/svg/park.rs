//! Plans of parks: `park-grammar`'s sheets in our letters.

use geo_types::Coord;
use park_grammar::picture::{self, SheetOptions, Style};

use super::canvas::{self, Canvas};
use super::{font, sheet};
use crate::park::ParkStudy;
use crate::site::Site;

/// Draws a park on a sheet with its title, legend, scale bar and north arrow.
///
/// The text depends on nothing but the park and the site's name and source, byte
/// by byte. The plan is to scale when printed at its size.
#[must_use]
pub fn park_svg(study: &ParkStudy, site: &Site) -> String {
    let name = site.name.as_deref().unwrap_or("Park");
    let words = study.grammar.replace(['_', '-'], " ");
    let options = SheetOptions::default()
        .with_title(sheet::title_of(name))
        .with_subtitle(format!("{words}, seed {}", study.seed))
        .with_attribution(site.attribution.clone());
    study.scene().sheet(&options, &Strokes)
}

/// Letters drawn as lines, which look the same everywhere.
struct Strokes;

impl picture::Lettering for Strokes {
    fn text(&self, text: &str, at: Coord<f64>, style: Style) -> String {
        let mut canvas = Canvas::default();
        let anchor = match style.anchor {
            picture::Anchor::Left => canvas::Anchor::Left,
            picture::Anchor::Middle => canvas::Anchor::Middle,
            picture::Anchor::Right => canvas::Anchor::Right,
        };
        let lettering = canvas::Lettering {
            cap: style.cap,
            weight: style.weight,
            colour: style.colour,
            anchor,
        };
        canvas.text(text, at.x, at.y, lettering);
        canvas.0
    }

    fn width(&self, text: &str, style: Style) -> f64 {
        font::width(text, style.cap)
    }
}
