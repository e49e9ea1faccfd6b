//! A plan on a sheet: the park at a round scale, and beside it what one needs to
//! read it.

use std::fmt::Write as _;

use geo_types::Coord;

use super::legend::{self, Entry};
use super::pen::{escaped, Pen, UNITS};
use super::{ground, standing, PictureOptions};
use crate::scene::Scene;

const INK: &str = "#3a3428";
const SOFT: &str = "#857b68";

/// Sheet units in a millimetre.
const MM: f64 = 100.0;
/// Around everything, sheet units.
const MARGIN: f64 = 900.0;
/// The column of texts on a lying sheet.
const COLUMN: f64 = 5600.0;
/// The strip of texts on an upright sheet.
const STRIP: f64 = 6800.0;
/// Between map and texts, and around the park on the map.
const GAP: f64 = 650.0;
/// From one line of the legend to the next, at most.
const LEADING: f64 = 470.0;

/// How a sheet is laid out.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SheetOptions {
    /// The longer side of the sheet, millimetres.
    ///
    /// Default value: 297 (A4).
    pub long_side_mm: f64,
    /// The shorter side of the sheet, millimetres.
    ///
    /// Default value: 210 (A4).
    pub short_side_mm: f64,
    /// The title.
    ///
    /// Default value: `Park`.
    pub title: String,
    /// The line below it.
    ///
    /// Default value: `Park plan`.
    pub subtitle: String,
    /// Whose data the plan shows, to be printed on it.
    ///
    /// Default value: none.
    pub attribution: Option<String>,
}

impl Default for SheetOptions {
    fn default() -> Self {
        Self {
            long_side_mm: 297.0,
            short_side_mm: 210.0,
            title: "Park".to_owned(),
            subtitle: "Park plan".to_owned(),
            attribution: None,
        }
    }
}

impl SheetOptions {
    /// Sets the title.
    #[must_use]
    pub fn with_title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Sets the line below the title.
    #[must_use]
    pub fn with_subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = subtitle.into();
        self
    }

    /// Sets whose data the plan shows.
    #[must_use]
    pub fn with_attribution(mut self, attribution: Option<String>) -> Self {
        self.attribution = attribution;
        self
    }
}

/// Where a text stands relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// It begins there.
    Left,
    /// Its middle is there.
    Middle,
    /// It ends there.
    Right,
}

/// How a text is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Height of capitals, sheet units.
    pub cap: f64,
    /// Pen width over the height of capitals.
    pub weight: f64,
    /// `#rrggbb`.
    pub colour: &'static str,
    /// Where it stands.
    pub anchor: Anchor,
}

/// What writes on sheets: the viewer's font ([`ViewersFont`]), or letters of
/// one's own that look the same everywhere.
pub trait Lettering {
    /// Elements of SVG for a line of text with its baseline at a point.
    fn text(&self, text: &str, at: Coord<f64>, style: Style) -> String;

    /// How wide a text is, sheet units.
    fn width(&self, text: &str, style: Style) -> f64;
}

/// Text elements in a font without serifs, whichever the viewer has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ViewersFont;

impl Lettering for ViewersFont {
    fn text(&self, text: &str, at: Coord<f64>, style: Style) -> String {
        let anchor = match style.anchor {
            Anchor::Left => "start",
            Anchor::Middle => "middle",
            Anchor::Right => "end",
        };
        let weight = if style.weight > BOLD {
            "bold"
        } else {
            "normal"
        };
        format!(
            "<text x=\"{:.0}\" y=\"{:.0}\" font-family=\"Helvetica,Arial,'DejaVu Sans',sans-serif\" font-size=\"{:.0}\" \
             font-weight=\"{weight}\" fill=\"{}\" text-anchor=\"{anchor}\">{}</text>\n",
            at.x,
            at.y,
            1.38 * style.cap,
            style.colour,
            escaped(text)
        )
    }

    fn width(&self, text: &str, style: Style) -> f64 {
        // What wide fonts of this sort need on average.
        let wide = if style.weight > BOLD { 0.97 } else { 0.85 };
        wide * style.cap * text.chars().count() as f64
    }
}

const fn style(cap: f64, weight: f64, colour: &'static str, anchor: Anchor) -> Style {
    Style {
        cap,
        weight,
        colour,
        anchor,
    }
}

/// Heavier pens than this are bold letters.
const BOLD: f64 = 0.125;

const BODY: Style = style(195.0, 0.11, INK, Anchor::Left);
const FIGURE: Style = style(195.0, 0.12, SOFT, Anchor::Right);
const NOTE: Style = style(145.0, 0.11, SOFT, Anchor::Left);

/// A rectangle of the sheet.
#[derive(Clone, Copy, Debug)]
struct Frame {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

/// The sheet, and where the map is on it.
struct Sheet {
    width: f64,
    height: f64,
    lying: bool,
    map: Frame,
    /// Sheet units in a metre.
    scale: f64,
}

impl Scene {
    /// Draws the park on a sheet, as a whole SVG document: to scale when it is
    /// printed at its size.
    ///
    /// # Examples
    ///
    /// ```
    /// use park_grammar::geo_types::polygon;
    /// use park_grammar::picture::{SheetOptions, ViewersFont};
    /// use park_grammar::{DeriveOptions, Grammar};
    ///
    /// let square = polygon![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 60.), (x: 0., y: 60.)];
    /// let grammar = Grammar::new("grammar 1\nRegion -> Grid(3, 2) { Lawn Scatter(6) { Tree } }")?;
    /// let park = grammar.derive(&square, &DeriveOptions::default())?;
    /// let svg = park.sheet(&SheetOptions::default().with_title("Six lawns"), &ViewersFont);
    /// assert!(svg.starts_with("<svg") && svg.contains("1 : "));
    /// # Ok::<(), park_grammar::ParkError>(())
    /// ```
    #[must_use]
    pub fn sheet(&self, options: &SheetOptions, letters: &dyn Lettering) -> String {
        let (low, high) = self.extent();
        let sheet = Sheet::new(high - low, options);
        let picture = PictureOptions {
            // A tenth of a millimetre on paper.
            line: f64::max(0.06, 10.0 / sheet.scale),
            ..PictureOptions::default()
        };
        let mut pen = Pen::new(&picture, (low + high) / 2.0);
        ground::draw(&mut pen, self);
        standing::draw(&mut pen, self);
        let entries = legend::entries(&mut pen, self);
        let mut out = Writer {
            text: String::new(),
            letters,
        };
        out.open(&sheet, options, &pen);
        let map = sheet.map;
        out.push(&format!(
            "<g clip-path=\"url(#map)\"><g transform=\"translate({:.0} {:.0})scale({:.5})\">\n{}</g></g>\n",
            map.x + map.width / 2.0,
            map.y + map.height / 2.0,
            sheet.scale / UNITS,
            pen.drawing.body
        ));
        out.frame(map);
        out.north(map.x + map.width - 620.0, map.y + 380.0);
        out.words(&sheet, options, &entries, self);
        out.push("</svg>\n");
        out.text
    }
}

impl Sheet {
    /// Upright or lying, whichever shows the park at the larger round scale.
    fn new(size: Coord<f64>, options: &SheetOptions) -> Self {
        let (long, short) = (
            MM * options.long_side_mm.max(150.0),
            MM * options.short_side_mm.max(120.0),
        );
        let sheet = |lying: bool| {
            let (width, height) = if lying { (long, short) } else { (short, long) };
            let aside = if lying { COLUMN + GAP } else { 0.0 };
            let below = if lying { 0.0 } else { STRIP + GAP };
            let map = Frame {
                x: MARGIN,
                y: MARGIN,
                width: width - 2.0 * MARGIN - aside,
                height: height - 2.0 * MARGIN - below,
            };
            let room = |side: f64, of: f64| (side - 2.0 * GAP) / of.max(1e-3);
            let scale = round_scale(room(map.width, size.x).min(room(map.height, size.y)));
            Self {
                width,
                height,
                lying,
                map,
                scale,
            }
        };
        let (lying, upright) = (sheet(true), sheet(false));
        if upright.scale > lying.scale {
            upright
        } else {
            lying
        }
    }
}

/// The largest scale up to one, in sheet units a metre, of a round number to 1.
fn round_scale(most: f64) -> f64 {
    let least = 1000.0 * MM / most;
    if !least.is_finite() || least <= 0.0 {
        return 1.0;
    }
    let tens = 10_f64.powf(least.log10().floor());
    let round = [1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.5, 10.0];
    let found = round.iter().map(|k| k * tens);
    let number = found.into_iter().find(|n| *n >= least * (1.0 - 1e-9));
    1000.0 * MM / number.unwrap_or(10.0 * tens)
}

/// The document as far as it is written.
struct Writer<'l> {
    text: String,
    letters: &'l dyn Lettering,
}

impl Writer<'_> {
    fn push(&mut self, text: &str) {
        self.text.push_str(text);
    }

    fn write(&mut self, text: &str, x: f64, y: f64, style: Style) {
        let found = self.letters.text(text, Coord { x, y }, style);
        self.text.push_str(&found);
    }

    /// A text in lines no wider than there is room, broken at spaces.
    fn wrapped(&self, text: &str, style: Style, room: f64) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            match lines.last_mut() {
                Some(line) if self.letters.width(&format!("{line} {word}"), style) <= room => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_owned()),
            }
        }
        lines
    }

    fn open(&mut self, sheet: &Sheet, options: &SheetOptions, pen: &Pen) {
        let (w, h) = (sheet.width, sheet.height);
        let Frame {
            x,
            y,
            width,
            height,
        } = sheet.map;
        let _ = write!(
            self.text,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {w:.0} {h:.0}\">\n\
             <title>{}</title>\n<style>.t{{fill:none;stroke-linecap:round;stroke-linejoin:round}}</style>\n<defs>\n",
            w / MM,
            h / MM,
            escaped(&options.title)
        );
        for definition in pen.drawing.defs.values() {
            self.text.push_str(definition);
        }
        let _ = write!(
            self.text,
            "<clipPath id=\"map\"><rect x=\"{x:.0}\" y=\"{y:.0}\" width=\"{width:.0}\" height=\"{height:.0}\"/></clipPath>\n</defs>\n\
             <rect width=\"{w:.0}\" height=\"{h:.0}\" fill=\"#fcfaf4\"/>\n\
             <rect x=\"{x:.0}\" y=\"{y:.0}\" width=\"{width:.0}\" height=\"{height:.0}\" fill=\"#efece2\"/>\n"
        );
    }

    fn frame(&mut self, frame: Frame) {
        let Frame {
            x,
            y,
            width,
            height,
        } = frame;
        let _ = writeln!(
            self.text,
            "<rect x=\"{x:.0}\" y=\"{y:.0}\" width=\"{width:.0}\" height=\"{height:.0}\" fill=\"none\" stroke=\"#6d6656\" stroke-width=\"20\"/>"
        );
    }

    /// An arrow towards north, its tip at a point.
    fn north(&mut self, x: f64, y: f64) {
        for (side, fill) in [(1.0, INK), (-1.0, "#fffdf8")] {
            let _ = writeln!(
                self.text,
                "<path d=\"M{x:.0} {y:.0}l{:.0} 850 {:.0}-190z\" fill=\"{fill}\" stroke=\"{INK}\" stroke-width=\"18\" stroke-linejoin=\"round\"/>",
                260.0 * side,
                -260.0 * side
            );
        }
        self.write("N", x, y + 1220.0, style(250.0, 0.14, INK, Anchor::Middle));
    }

    /// All that stands beside the map, or below it.
    fn words(&mut self, sheet: &Sheet, options: &SheetOptions, entries: &[Entry], scene: &Scene) {
        let map = sheet.map;
        let (x, y, room) = if sheet.lying {
            (map.x + map.width + GAP, map.y, COLUMN)
        } else {
            (map.x, map.y + map.height + GAP, (map.width - GAP) / 2.0)
        };
        let below = self.title(options, scene, x, y, room);
        let foot = sheet.height - MARGIN;
        let bar = 1150.0;
        let head = self.imprint(options, x, foot, room);
        self.scale_bar(sheet.scale, x, head - bar, room);
        let (x, top, bottom) = if sheet.lying {
            (x, below, head - bar - 300.0)
        } else {
            (x + room + GAP, y, foot)
        };
        let step = LEADING.min((bottom - top) / entries.len().max(1) as f64);
        let size = (step / LEADING).min(1.0);
        for (k, entry) in entries.iter().enumerate() {
            let at = top + step * k as f64;
            let _ = writeln!(
                self.text,
                "<g transform=\"translate({x:.0} {at:.0})scale({size:.3})\">{}</g>",
                entry.swatch
            );
            let base = at + size * (0.5 * legend::HEIGHT + 0.5 * BODY.cap);
            let cap = BODY.cap * size;
            let left = x + size * (legend::WIDTH + 230.0);
            self.write(&entry.words, left, base, Style { cap, ..BODY });
            self.write(&entry.value, x + room, base, Style { cap, ..FIGURE });
        }
    }

    /// Title, subtitle and area; the y below them.
    fn title(&mut self, options: &SheetOptions, scene: &Scene, x: f64, y: f64, room: f64) -> f64 {
        let title = style(400.0, 0.13, INK, Anchor::Left);
        let mut at = y - 110.0;
        for line in self.wrapped(&options.title, title, room) {
            // A long word is set smaller rather than cut.
            let wide = self.letters.width(&line, title);
            let cap = title.cap * (room / wide.max(room)).max(0.35);
            at += 1.45 * title.cap;
            self.write(&line, x, at, Style { cap, ..title });
        }
        at += 60.0;
        let small = style(175.0, 0.11, SOFT, Anchor::Left);
        for line in self.wrapped(&options.subtitle, small, room) {
            at += 300.0;
            self.write(&line, x, at, small);
        }
        let area: f64 = scene
            .pieces
            .iter()
            .map(|p| crate::plane::Area::from_polygon(&p.polygon).size())
            .sum();
        let words = if area >= 1e4 {
            format!("{:.2} ha", area / 1e4)
        } else {
            format!("{area:.0} m\u{b2}")
        };
        at += 300.0;
        self.write(&words, x, at, small);
        at + 520.0
    }

    /// Whose data the plan shows, and what drew it, from the foot of the sheet up;
    /// the y above them.
    fn imprint(&mut self, options: &SheetOptions, x: f64, foot: f64, room: f64) -> f64 {
        let mut lines = vec!["Drawn by park-grammar".to_owned()];
        if let Some(attribution) = &options.attribution {
            lines.extend(self.wrapped(attribution, NOTE, room));
        }
        let mut at = foot - 230.0 * (lines.len() - 1) as f64;
        let top = at - 230.0;
        for line in lines {
            self.write(&line, x, at, NOTE);
            at += 230.0;
        }
        top
    }

    /// A bar of a round length, and the scale.
    fn scale_bar(&mut self, scale: f64, x: f64, y: f64, room: f64) {
        let most = 0.8 * room / scale;
        let tens = 10_f64.powf(most.log10().floor());
        let round = [8.0, 6.0, 4.0, 2.0, 1.0].into_iter().map(|k| k * tens);
        let metres = round.into_iter().find(|m| *m <= most).unwrap_or(tens);
        let wide = metres * scale;
        for k in 0..4 {
            let fill = if k % 2 == 0 { INK } else { "#fffdf8" };
            let _ = writeln!(
                self.text,
                "<rect x=\"{:.0}\" y=\"{:.0}\" width=\"{:.0}\" height=\"90\" fill=\"{fill}\" stroke=\"{INK}\" stroke-width=\"10\"/>",
                x + wide * f64::from(k) / 4.0,
                y + 260.0,
                wide / 4.0
            );
        }
        for share in [0.0, 0.5, 1.0] {
            let words = if share == 0.0 {
                "0".to_owned()
            } else {
                format!("{} m", metres * share)
            };
            let anchor = if share == 0.0 {
                Anchor::Left
            } else {
                Anchor::Middle
            };
            self.write(
                &words,
                x + wide * share,
                y + 170.0,
                Style { anchor, ..NOTE },
            );
        }
        let number = 1000.0 * MM / scale;
        self.write(&format!("1 : {number:.0}"), x, y + 680.0, BODY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round() {
        // 100 m on 190 mm: 1 to 526 at least, so 1 to 600.
        assert!((round_scale(190.0) - 100_000.0 / 600.0).abs() < 1e-9);
        assert!((round_scale(200.0) - 200.0).abs() < 1e-9);
        assert_eq!(round_scale(f64::INFINITY), 1.0);
    }

    #[test]
    fn long_parks_lie_and_high_ones_stand() {
        let sheet = |x: f64, y: f64| Sheet::new(Coord { x, y }, &SheetOptions::default());
        assert!(sheet(300.0, 100.0).lying && !sheet(100.0, 190.0).lying);
    }
}
