//! Pictures side by side in one file.

use std::fmt::Write as _;

/// Between pictures, sheet units of 0.01 mm.
const GAP: f64 = 200.0;

/// Puts SVG documents of this crate beside each other, two in a row.
pub(crate) fn beside(pictures: &[String]) -> String {
    let sizes: Vec<(f64, f64)> = pictures.iter().map(|svg| view_box(svg)).collect();
    let width = sizes.iter().map(|s| s.0).fold(0.0, f64::max);
    let height = sizes.iter().map(|s| s.1).fold(0.0, f64::max);
    let columns = if width > 2.0 * height { 1 } else { 2 };
    let rows = pictures.len().div_ceil(columns);
    let all = (
        columns as f64 * (width + GAP) - GAP,
        rows as f64 * (height + GAP) - GAP,
    );
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.1}mm\" height=\"{:.1}mm\" viewBox=\"0 0 {:.0} {:.0}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        all.0 / 100.0,
        all.1 / 100.0,
        all.0,
        all.1
    );
    for (i, (svg, (w, h))) in pictures.iter().zip(sizes).enumerate() {
        let (column, row) = (i % columns, i / columns);
        // What is within the outer element, in an element of its own.
        let inner = svg.split_once('>').map_or("", |(_, rest)| rest);
        let _ = write!(
            text,
            "<svg x=\"{:.0}\" y=\"{:.0}\" width=\"{w:.0}\" height=\"{h:.0}\" viewBox=\"0 0 {w:.0} {h:.0}\">{inner}",
            column as f64 * (width + GAP),
            row as f64 * (height + GAP),
        );
    }
    text.push_str("</svg>\n");
    text
}

/// Width and height of a document, from its `viewBox="0 0 w h"`.
fn view_box(svg: &str) -> (f64, f64) {
    let numbers = svg.split_once("viewBox=\"0 0 ").and_then(|(_, rest)| {
        let (numbers, _) = rest.split_once('"')?;
        let (w, h) = numbers.split_once(' ')?;
        Some((w.parse().ok()?, h.parse().ok()?))
    });
    numbers.unwrap_or((0.0, 0.0))
}
