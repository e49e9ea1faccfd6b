//! A field as SVG: its streamlines over the divergence, and its singularities.

use geo_types::Coord;

use super::canvas::{Canvas, Transform};
use super::field_map::{bounds, FieldMap};
use crate::field::FieldStudy;
use crate::site::Site;

/// Longer side of the picture, sheet units (200 mm).
const LONG_SIDE: f64 = 20_000.0;
/// Around the site, sheet units.
const MARGIN: f64 = 500.0;
/// Cells of the divergence map along the longer side.
const CELLS: f64 = 160.0;
/// Streamlines side by side along the longer side.
const LINES: f64 = 56.0;

/// Draws the fields of a study: land shaded by the mean absolute divergence of
/// both arms (white below 1 / 2000 m, darkest from 1 / 100 m), streamlines of
/// both families, and singularities, orange where three streets meet and blue
/// where five do, larger for larger indices.
#[must_use]
pub fn field_svg(study: &FieldStudy, site: &Site) -> String {
    let (low, high) = bounds(&site.parts);
    let size = (high.x - low.x).max(high.y - low.y);
    let scale = (LONG_SIDE - 2.0 * MARGIN) / size;
    let map = FieldMap {
        parts: &site.parts,
        fields: &study.fields,
        size,
        to: Transform {
            scale,
            centre: Coord {
                x: low.x,
                y: high.y,
            },
            at: Coord {
                x: MARGIN,
                y: MARGIN,
            },
        },
    };
    let width = (high.x - low.x) * scale + 2.0 * MARGIN;
    let height = (high.y - low.y) * scale + 2.0 * MARGIN;
    let mut canvas = Canvas::default();
    canvas.raw(&format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.1}mm\" height=\"{:.1}mm\" viewBox=\"0 0 {width:.0} {height:.0}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        width / super::UNITS,
        height / super::UNITS,
    ));
    map.divergence(&mut canvas, CELLS, "land");
    map.streamlines(&mut canvas, LINES, 18.0);
    canvas.path(
        &map.outline().0,
        "fill=\"none\" stroke=\"#212529\" stroke-width=\"60\" stroke-linejoin=\"round\"",
    );
    map.singularities(&mut canvas, 110.0, 40.0);
    canvas.raw("</svg>\n");
    canvas.0
}
