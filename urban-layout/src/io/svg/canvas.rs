//! The sheet in whole units of 0.01 mm, and what is drawn on it.

use std::fmt::Write as _;

use geo_types::{Coord, Polygon};

use super::font;
use crate::layout::plane::{open_ring, rings};

/// From local metres to the sheet: y down, one scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transform {
    /// Sheet units per metre.
    pub(super) scale: f64,
    /// Local metres that go to `at`.
    pub(super) centre: Coord<f64>,
    /// Where they go, sheet units.
    pub(super) at: Coord<f64>,
}

impl Transform {
    /// What is between two corners, lowest and highest coordinates, from a place
    /// of the sheet on: to the right and down.
    pub(super) fn from_corner(
        scale: f64,
        (low, high): (Coord<f64>, Coord<f64>),
        at: Coord<f64>,
    ) -> Self {
        Self {
            scale,
            centre: Coord {
                x: low.x,
                y: high.y,
            },
            at,
        }
    }

    pub(super) fn place(&self, c: Coord<f64>) -> Coord<f64> {
        Coord {
            x: self.at.x + (c.x - self.centre.x) * self.scale,
            y: self.at.y - (c.y - self.centre.y) * self.scale,
        }
    }
}

/// Path data of polylines in whole units with relative lines: a vertex moves by
/// at most half a unit, and the error does not add up along a path.
#[derive(Debug, Default)]
pub(super) struct PathData(pub(super) String);

impl PathData {
    pub(super) fn line(&mut self, points: impl IntoIterator<Item = Coord<f64>>, closed: bool) {
        let mut last: Option<(i64, i64)> = None;
        let mut drawn = false;
        for p in points {
            let p = (p.x.round() as i64, p.y.round() as i64);
            match last {
                None => {
                    let _ = write!(self.0, "M{} {}", p.0, p.1);
                }
                Some(q) if q == p => continue,
                Some(q) => {
                    self.0.push_str(if drawn { "" } else { "l" });
                    let (dx, dy) = (p.0 - q.0, p.1 - q.1);
                    let _ = write!(self.0, "{}{dx}", if drawn && dx >= 0 { " " } else { "" });
                    let _ = write!(self.0, "{}{dy}", if dy >= 0 { " " } else { "" });
                    drawn = true;
                }
            }
            last = Some(p);
        }
        if closed && drawn {
            self.0.push('z');
        }
    }

    pub(super) fn polygon(&mut self, polygon: &Polygon<f64>, to: &Transform) {
        for ring in rings(polygon) {
            self.line(open_ring(ring).iter().map(|c| to.place(*c)), true);
        }
    }
}

/// Text in XML.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// Where a text stands relative to its point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
}

/// How a text is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lettering {
    /// Height of capitals, sheet units.
    pub(super) cap: f64,
    /// Pen width over the height of capitals.
    pub(super) weight: f64,
    pub(super) colour: &'static str,
    pub(super) anchor: Anchor,
}

/// The SVG text as far as it is written.
#[derive(Debug, Default)]
pub(super) struct Canvas(pub(super) String);

impl Canvas {
    pub(super) fn raw(&mut self, text: &str) {
        self.0.push_str(text);
    }

    /// One path; nothing if it has no data.
    pub(super) fn path(&mut self, data: &str, attributes: &str) {
        if !data.is_empty() {
            let _ = writeln!(self.0, "<path {attributes} d=\"{data}\"/>");
        }
    }

    pub(super) fn rect(&mut self, x: f64, y: f64, w: f64, h: f64, attributes: &str) {
        let _ = writeln!(
            self.0,
            "<rect x=\"{x:.0}\" y=\"{y:.0}\" width=\"{w:.0}\" height=\"{h:.0}\" {attributes}/>"
        );
    }

    /// A line of text as strokes; in a script that the lettering lacks, as text
    /// in a font of the viewer.
    pub(super) fn text(&mut self, text: &str, x: f64, y: f64, style: Lettering) {
        let Lettering {
            cap,
            weight,
            colour,
            anchor,
        } = style;
        if !font::can_draw(text) {
            let (word, size) = (["start", "middle", "end"][anchor as usize], cap * 1.4);
            let _ = writeln!(
                self.0,
                "<text x=\"{x:.0}\" y=\"{y:.0}\" font-family=\"sans-serif\" font-size=\"{size:.0}\" fill=\"{colour}\" \
                 text-anchor=\"{word}\">{}</text>",
                escaped(text)
            );
            return;
        }
        let back = match anchor {
            Anchor::Left => 0.0,
            Anchor::Middle => 0.5,
            Anchor::Right => 1.0,
        };
        let data = font::path(text, cap, x - back * font::width(text, cap), y);
        self.path(
            &data,
            &format!(
                "class=\"t\" stroke=\"{colour}\" stroke-width=\"{:.0}\"",
                cap * weight
            ),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn path_data_is_short_and_exact() {
        let mut data = PathData::default();
        let points = [
            (0.0, 0.0),
            (10.4, 0.0),
            (10.4, 0.3),
            (20.0, -5.0),
            (20.0, 7.0),
        ];
        data.line(points.map(|(x, y)| Coord { x, y }), true);
        assert_eq!(data.0, "M0 0l10 0 10-5 0 12z");
    }

    #[test]
    fn xml_is_escaped() {
        assert_eq!(escaped("<a & \"b\">\n"), "&lt;a &amp; &quot;b&quot;&gt; ");
    }
}
