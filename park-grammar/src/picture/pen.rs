//! What writes a drawing: whole centimetres, y down.

use std::fmt::Write as _;

use geo_types::{Coord, Polygon};

use super::{Drawing, PictureOptions};

/// Units of the drawing in a metre.
pub(super) const UNITS: f64 = 100.0;

/// Writes elements.
#[derive(Debug)]
pub(super) struct Pen {
    pub(super) drawing: Drawing,
    origin: Coord<f64>,
    /// Width of the thinnest lines, units.
    pub(super) line: f64,
    pub(super) shadows: bool,
    /// Things that reach less far, metres, are not drawn.
    pub(super) least: f64,
    prefix: String,
    clips: usize,
}

impl Pen {
    pub(super) fn new(options: &PictureOptions, origin: Coord<f64>) -> Self {
        Self {
            drawing: Drawing::default(),
            origin,
            line: (UNITS * options.line).max(0.0),
            shadows: options.shadows,
            least: options.least,
            prefix: escaped(&options.prefix),
            clips: 0,
        }
    }

    /// Where a point of the plane is drawn.
    pub(super) fn place(&self, c: Coord<f64>) -> [i64; 2] {
        let c = (c - self.origin) * UNITS;
        [c.x.round() as i64, -c.y.round() as i64]
    }

    pub(super) fn raw(&mut self, text: &str) {
        self.drawing.body.push_str(text);
    }

    /// A path; nothing if it has no data.
    pub(super) fn path(&mut self, data: &str, attributes: &str) {
        if !data.is_empty() {
            let _ = writeln!(self.drawing.body, "<path {attributes} d=\"{data}\"/>");
        }
    }

    /// Puts something among the definitions, under `park-` and its name; gives
    /// the whole id.
    pub(super) fn define(&mut self, name: &str, element: impl FnOnce(&str) -> String) -> String {
        let id = format!("park-{}", escaped(name));
        if !self.drawing.defs.contains_key(&id) {
            let element = element(&id);
            self.drawing.defs.insert(id.clone(), element);
        }
        id
    }

    /// A clip that nothing else in the document is called by.
    pub(super) fn clip(&mut self, data: &str) -> String {
        self.clips += 1;
        let id = format!("{}-clip{}", self.prefix, self.clips);
        let _ = writeln!(
            self.drawing.body,
            "<clipPath id=\"{id}\"><path d=\"{data}\" clip-rule=\"evenodd\"/></clipPath>"
        );
        id
    }

    /// Path data of a polygon, its rings as they are wound.
    pub(super) fn polygon(&self, polygon: &Polygon<f64>) -> String {
        let mut data = String::new();
        let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
        for ring in rings {
            let points = ring.0.iter().map(|&c| self.place(c));
            closed(&mut data, points);
        }
        data
    }
}

/// Appends a closed line: relative steps, so that the text is short; a step is
/// taken from where the last one really ended, so that errors do not add up.
pub(super) fn closed(data: &mut String, points: impl Iterator<Item = [i64; 2]>) {
    let mut points: Vec<[i64; 2]> = points.collect();
    points.dedup();
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let [first, rest @ ..] = points.as_slice() else {
        return;
    };
    let _ = write!(data, "M{} {}", first[0], first[1]);
    let mut last = *first;
    for (k, p) in rest.iter().enumerate() {
        let [x, y] = [p[0] - last[0], p[1] - last[1]];
        let open = match (k, x < 0) {
            (0, _) => "l",
            (_, true) => "",
            (_, false) => " ",
        };
        let gap = if y < 0 { "" } else { " " };
        let _ = write!(data, "{open}{x}{gap}{y}");
        last = *p;
    }
    data.push('z');
}

/// Appends a round dot.
pub(super) fn dot(data: &mut String, [x, y]: [i64; 2], r: i64) {
    let (start, wide) = (x - r, 2 * r);
    let _ = write!(
        data,
        "M{start} {y}a{r} {r} 0 1 0 {wide} 0a{r} {r} 0 1 0-{wide} 0z"
    );
}

/// Text for XML.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_short_and_exact() {
        let mut data = String::new();
        let points = [[0, 0], [10, 0], [10, 0], [20, -5], [20, 7], [0, 0]];
        closed(&mut data, points.into_iter());
        assert_eq!(data, "M0 0l10 0 10-5 0 12z");
    }
}
