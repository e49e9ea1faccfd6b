//! Layouts as SVG: a plan that a planner would pin up.
//!
//! One sheet (A3 by default, upright or lying, whichever shows the site
//! larger) at a round scale, with the plan, title, key figures, legend, scale
//! bar and north arrow. Parcels are shaded by quality, so that the bad ones are
//! seen first. All lettering is drawn as lines: it looks the same everywhere and
//! does not depend on fonts. Coordinates are whole units of 0.01 mm, one path a
//! colour, so that a plan of 1500 parcels stays well under a megabyte.

mod canvas;
mod field;
mod field_map;
mod field_sheet;
mod floorplan;
mod font;
mod map;
mod network;
mod palette;
mod park;
mod picture;
mod sheet;
mod streamlines;
mod traffic;

use geo_types::Coord;

use crate::layout::Layout;
use crate::metrics::metrics;
use crate::site::Site;

use canvas::{escaped, Canvas, Transform};
pub use field::field_svg;
pub use field_sheet::{field_sheet_svg, FieldPanel};
pub use floorplan::floorplan_svg;
pub use network::network_svg;
pub use park::park_svg;
pub use streamlines::{streamlines_svg, Paint, StreamlineSvgOptions};
pub use traffic::traffic_svg;

/// How a plan is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct SvgOptions {
    /// The longer side of the sheet, millimetres. Default 420 (A3).
    pub long_side_mm: f64,
    /// The shorter side of the sheet, millimetres. Default 297 (A3).
    pub short_side_mm: f64,
    /// Title; the site's name by default.
    pub title: Option<String>,
    /// Line under the title. Default: "Street and parcel plan".
    pub subtitle: String,
    /// Whose data the plan shows, to be printed on it; what the site says by default.
    pub attribution: Option<String>,
    /// Whether existing streets outside are drawn. Default true.
    pub context: bool,
    /// Whether names of given roads and labels of open land are drawn. Default true.
    pub names: bool,
}

impl Default for SvgOptions {
    fn default() -> Self {
        Self {
            long_side_mm: 420.0,
            short_side_mm: 297.0,
            title: None,
            subtitle: "Street and parcel plan".to_owned(),
            attribution: None,
            context: true,
            names: true,
        }
    }
}

/// Sheet units per millimetre.
const UNITS: f64 = 100.0;
/// Around everything, sheet units.
const MARGIN: f64 = 1000.0;
/// The column of texts on a lying sheet, and each of the columns on an upright one.
const COLUMN: f64 = 7200.0;
/// The strip of texts on an upright sheet.
const STRIP: f64 = 8700.0;

/// The sheet and where the map is on it.
struct Sheet {
    width: f64,
    height: f64,
    lying: bool,
    /// x, y, width, height of the map's frame.
    frame: [f64; 4],
    to: Transform,
}

/// Draws a layout of a site as an SVG document.
///
/// The text depends on nothing but the layout, the site and the options, byte by
/// byte. The plan is to scale when printed at its size.
///
/// # Complexity
///
/// That of [`metrics`](fn@crate::metrics::metrics), whose figures it prints.
#[must_use]
pub fn svg(layout: &Layout, site: &Site, options: &SvgOptions) -> String {
    let sheet = Sheet::new(site, options);
    let figures = metrics(layout, site);
    let name = options
        .title
        .as_deref()
        .or(site.name.as_deref())
        .unwrap_or("Layout");
    let title = sheet::title_of(name);
    let attribution = options
        .attribution
        .as_deref()
        .or(site.attribution.as_deref());
    let mut canvas = Canvas::default();
    let (w, h) = (sheet.width, sheet.height);
    canvas.raw(&format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {w:.0} {h:.0}\">\n\
         <title>{}</title>\n\
         <desc>{} parcels on {:.3} km\u{b2}; parcels {:.1} %, streets {:.1} %, parks {:.1} % of the land</desc>\n\
         <style>.t{{fill:none;stroke-linecap:round;stroke-linejoin:round}}</style>\n<defs>\n{}</defs>\n",
        w / UNITS,
        h / UNITS,
        escaped(&title),
        figures.parcels,
        figures.site_km2,
        figures.l_r,
        figures.l_s,
        figures.l_p,
        palette::PATTERNS
    ));
    canvas.rect(0.0, 0.0, w, h, "fill=\"#fcfaf4\"");
    map::draw(&mut canvas, layout, site, options, &sheet.to, sheet.frame);
    let [fx, fy, fw, fh] = sheet.frame;
    sheet::north(&mut canvas, fx + fw - 750.0, fy + 450.0);
    if sheet.lying {
        let x = fx + fw + 800.0;
        let room = w - MARGIN - x;
        let mut y = sheet::title(&mut canvas, &title, &options.subtitle, x, fy, room);
        y = sheet::figures(&mut canvas, &figures, x, y + 300.0, room);
        y = sheet::land_use(&mut canvas, layout, &figures, x, y + 250.0, room);
        y = sheet::histogram(&mut canvas, layout, x, y + 250.0, room);
        sheet::legend(&mut canvas, layout, x, y + 200.0, room);
        sheet::scale_bar(&mut canvas, sheet.to.scale, x, fy + fh - 2100.0, room);
        sheet::imprint(&mut canvas, attribution, x, fy + fh, room);
    } else {
        let (top, gap) = (fy + fh + 500.0, 900.0);
        let room = (w - 2.0 * MARGIN - 2.0 * gap) / 3.0;
        let column = |k: f64| MARGIN + k * (room + gap);
        let y = sheet::title(
            &mut canvas,
            &title,
            &options.subtitle,
            column(0.0),
            top,
            room,
        );
        sheet::figures(&mut canvas, &figures, column(0.0), y + 100.0, room);
        let y = sheet::land_use(&mut canvas, layout, &figures, column(1.0), top, room);
        let y = sheet::histogram(&mut canvas, layout, column(1.0), y, room);
        sheet::scale_bar(
            &mut canvas,
            sheet.to.scale,
            column(1.0),
            y.min(h - MARGIN - 1500.0),
            room,
        );
        sheet::legend(&mut canvas, layout, column(2.0), top, room);
        sheet::imprint(&mut canvas, attribution, column(1.0), h - MARGIN, room);
    }
    canvas.raw("</svg>\n");
    canvas.0
}

impl Sheet {
    /// Upright or lying, whichever shows the site at the larger round scale.
    fn new(site: &Site, options: &SvgOptions) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for c in site.parts.iter().flat_map(|part| &part.exterior().0) {
            low = [low[0].min(c.x), low[1].min(c.y)];
            high = [high[0].max(c.x), high[1].max(c.y)];
        }
        let size = [(high[0] - low[0]).max(1e-3), (high[1] - low[1]).max(1e-3)];
        let centre = Coord {
            x: 0.5 * (low[0] + high[0]),
            y: 0.5 * (low[1] + high[1]),
        };
        let (long, short) = (
            options.long_side_mm.max(200.0) * UNITS,
            options.short_side_mm.max(150.0) * UNITS,
        );
        let sheet = |lying: bool| {
            let (width, height) = if lying { (long, short) } else { (short, long) };
            let frame = if lying {
                [
                    MARGIN,
                    MARGIN,
                    width - 2.0 * MARGIN - COLUMN - 800.0,
                    height - 2.0 * MARGIN,
                ]
            } else {
                [
                    MARGIN,
                    MARGIN,
                    width - 2.0 * MARGIN,
                    height - 2.0 * MARGIN - STRIP - 500.0,
                ]
            };
            // Room for the streets around the site.
            let scale = ((frame[2] - 2400.0) / size[0]).min((frame[3] - 2400.0) / size[1]);
            let at = Coord {
                x: frame[0] + frame[2] / 2.0,
                y: frame[1] + frame[3] / 2.0,
            };
            Self {
                width,
                height,
                lying,
                frame,
                to: Transform {
                    scale: round_scale(scale),
                    centre,
                    at,
                },
            }
        };
        let (lying, upright) = (sheet(true), sheet(false));
        if upright.to.scale > lying.to.scale {
            upright
        } else {
            lying
        }
    }
}

/// The greatest scale, in sheet units per metre, of a round denominator that is
/// not above `most`.
fn round_scale(most: f64) -> f64 {
    const ROUND: [f64; 11] = [1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.5, 10.0];
    let needed = 1000.0 * UNITS / most;
    if !(needed > 0.0 && needed.is_finite()) {
        return 1.0;
    }
    let power = 10_f64.powf(needed.log10().floor());
    let denominator = ROUND
        .iter()
        .map(|k| k * power)
        .find(|d| *d >= needed * (1.0 - 1e-9));
    1000.0 * UNITS / denominator.unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round() {
        // 1 km on 200 mm is 1 : 5000.
        assert!((round_scale(20.0) - 20.0).abs() < 1e-9);
        assert!((round_scale(19.9) - 100_000.0 / 6000.0).abs() < 1e-9);
    }
}
