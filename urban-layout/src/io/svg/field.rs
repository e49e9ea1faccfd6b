//! A field as SVG: its streamlines over the divergence, and its singularities.

use super::field_map::FieldMap;
use super::picture::Picture;
use crate::field::FieldStudy;
use crate::site::Site;

/// Longer side of the picture, sheet units (200 mm).
const LONG_SIDE: f64 = 20_000.0;
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
    let mut picture = Picture::new(site, LONG_SIDE, 0.0);
    let map = FieldMap {
        parts: &site.parts,
        fields: &study.fields,
        size: picture.size,
        to: picture.to,
    };
    map.divergence(&mut picture.canvas, CELLS, "land");
    map.streamlines(&mut picture.canvas, LINES, 18.0);
    picture.outline();
    picture.singularities(&study.singularities());
    picture.finish()
}
