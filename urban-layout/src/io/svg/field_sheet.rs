//! Several fields of one site side by side.

use crossfield::Field;
use geo_types::{Coord, LineString};

use super::canvas::{Anchor, Canvas, Lettering, PathData, Transform};
use super::field_map::FieldMap;
use super::picture::bounds;
use crate::site::Site;

/// One field of a sheet.
#[derive(Clone, Debug)]
pub struct FieldPanel {
    /// What stands above it.
    pub name: String,
    /// One field for each of [`Site::parts`], in local metres.
    pub fields: Vec<Field>,
    /// Lines that are drawn with it, in local metres: what it was told to
    /// follow.
    pub strokes: Vec<LineString<f64>>,
}

/// Panels beside each other.
const COLUMNS: usize = 4;
/// Longer side of a panel, sheet units; fewer than in [`super::field_svg`],
/// for shorter numbers.
const PANEL: f64 = 1200.0;
/// Between panels.
const GAP: f64 = 60.0;
/// For the name above a panel.
const CAPTION: f64 = 110.0;
/// Crosses along the longer side of a panel, cells of its divergence map, and
/// streamlines.
const CROSSES: f64 = 26.0;
const CELLS: f64 = 80.0;
const LINES: f64 = 32.0;

const NAME: Lettering = Lettering {
    cap: 38.0,
    weight: 0.13,
    colour: "#212529",
    anchor: Anchor::Left,
};

/// Draws each field twice: its crosses, and below them streamlines over the
/// divergence, as [`super::field_svg`] does, both with singularities.
#[must_use]
pub fn field_sheet_svg(site: &Site, panels: &[FieldPanel]) -> String {
    let (low, high) = bounds(&site.parts);
    let size = (high.x - low.x).max(high.y - low.y);
    let scale = PANEL / size;
    let (width, height) = ((high.x - low.x) * scale, (high.y - low.y) * scale);
    let columns = panels.len().clamp(1, COLUMNS);
    let rows = panels.len().div_ceil(COLUMNS);
    let (across, down) = (width + GAP, 2.0 * height + CAPTION + 2.0 * GAP);
    let sheet = (columns as f64 * across + GAP, rows as f64 * down + GAP);
    let mut canvas = Canvas::default();
    canvas.raw(&format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0} {:.0}\">\n\
         <style>.t{{fill:none;stroke-linecap:round;stroke-linejoin:round}}</style>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        sheet.0, sheet.1
    ));
    for (k, panel) in panels.iter().enumerate() {
        let left = GAP + (k % COLUMNS) as f64 * across;
        let top = GAP + (k / COLUMNS) as f64 * down + CAPTION;
        canvas.text(&panel.name, left, top - 0.4 * CAPTION, NAME);
        for row in 0..2 {
            let at = Coord {
                x: left,
                y: top + f64::from(row) * (height + GAP),
            };
            let map = FieldMap {
                parts: &site.parts,
                fields: &panel.fields,
                size,
                to: Transform::from_corner(scale, (low, high), at),
            };
            if row == 0 {
                map.crosses(&mut canvas, CROSSES, 3.0);
            } else {
                map.divergence(&mut canvas, CELLS, &format!("land{k}"));
                map.streamlines(&mut canvas, LINES, 2.5);
            }
            canvas.path(
                &map.outline().0,
                "fill=\"none\" stroke=\"#212529\" stroke-width=\"7\" stroke-linejoin=\"round\"",
            );
            let mut strokes = PathData::default();
            for stroke in &panel.strokes {
                strokes.line(stroke.0.iter().map(|&c| map.to.place(c)), false);
            }
            canvas.path(
                &strokes.0,
                "fill=\"none\" stroke=\"#2b8a3e\" stroke-width=\"12\" stroke-linejoin=\"round\"",
            );
            map.singularities(&mut canvas, 15.0, 5.0);
        }
    }
    canvas.raw("</svg>\n");
    canvas.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::site::Units;
    use crossfield::{BoundaryField, Domain, DomainOptions, FieldDesign};

    /// Five panels take two rows of four; each has its own clip, and two
    /// outlines.
    #[test]
    fn panels_are_drawn_side_by_side() {
        let site = Site::from_geojson(
            r#"{"type": "Polygon", "coordinates": [[[0, 0], [200, 0], [200, 100], [0, 100], [0, 0]]]}"#,
            Units::Metres,
        )
        .expect("valid");
        let domain = Domain::new(&site.parts[0], &DomainOptions::default()).expect("valid");
        let panel = FieldPanel {
            name: "B-field".to_owned(),
            fields: vec![BoundaryField::default().design(&domain).expect("valid")],
            strokes: Vec::new(),
        };
        let svg = field_sheet_svg(&site, &vec![panel; 5]);
        // 1200 wide and 600 high: 4 x 1260 + 60 by 2 x (1200 + 110 + 120) + 60.
        assert!(svg.contains("viewBox=\"0 0 5100 2920\""), "{}", &svg[..200]);
        assert_eq!(svg.matches("<clipPath").count(), 5);
        assert!(svg.contains("id=\"land4\""));
        assert_eq!(
            svg.matches("stroke=\"#212529\" stroke-width=\"7\"").count(),
            10
        );
        assert!(!field_sheet_svg(&site, &[]).contains("<path"));
    }
}
