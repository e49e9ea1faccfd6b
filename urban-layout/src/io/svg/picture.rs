//! A site by itself on a picture: what the drawings of fields and streamlines
//! have in common.

use crossfield::Singularity;
use geo_types::{Coord, Polygon};

use super::canvas::{Anchor, Canvas, Lettering, PathData, Transform};
use crate::plane::extent;
use crate::site::Site;

/// Around the site, as a share of the longer side of the picture.
const MARGIN: f64 = 0.025;

/// Longer side of a picture with a legend, sheet units (200 mm), and the legend
/// below.
const LONG_SIDE: f64 = 20_000.0;
const FOOT: f64 = 1500.0;
/// Its letters.
pub(super) const INK: &str = "#343a40";

/// A picture as far as it is drawn.
pub(super) struct Picture {
    pub(super) canvas: Canvas,
    pub(super) to: Transform,
    /// The longer side of the site, metres.
    pub(super) size: f64,
    /// The longer side of the picture over that of a picture of 200 mm: what
    /// strokes and signs are scaled by.
    pub(super) grain: f64,
    /// Sheet units of the site with its margins: what stands below is the foot.
    pub(super) width: f64,
    pub(super) height: f64,
    outline: String,
}

impl Picture {
    /// Opens a picture of so many sheet units along the longer side of the
    /// site, and leaves room for a foot of so many more.
    pub(super) fn new(site: &Site, long_side: f64, foot: f64) -> Self {
        let (low, high) = bounds(&site.parts);
        let margin = MARGIN * long_side;
        let size = (high.x - low.x).max(high.y - low.y);
        let scale = (long_side - 2.0 * margin) / size;
        let at = Coord {
            x: margin,
            y: margin,
        };
        let to = Transform::from_corner(scale, (low, high), at);
        let width = (high.x - low.x) * scale + 2.0 * margin;
        let height = (high.y - low.y) * scale + 2.0 * margin;
        let sheet = height + foot;
        let mut canvas = Canvas::default();
        canvas.raw(&format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.1}mm\" height=\"{:.1}mm\" viewBox=\"0 0 {width:.0} {sheet:.0}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
            width / super::UNITS,
            sheet / super::UNITS,
        ));
        let mut outline = PathData::default();
        for part in &site.parts {
            outline.polygon(part, &to);
        }
        Self {
            canvas,
            to,
            size,
            grain: long_side / (200.0 * super::UNITS),
            width,
            height,
            outline: outline.0,
        }
    }

    /// Opens a picture of 200 mm with room for a legend.
    pub(super) fn with_legend(site: &Site) -> Self {
        Self::new(site, LONG_SIDE, FOOT)
    }

    /// Writes what a legend says, and how its samples are drawn; gives how far down
    /// it stands.
    pub(super) fn legend(&mut self, words: &str) -> f64 {
        let top = self.height + 0.35 * FOOT;
        let letters = Lettering {
            cap: 220.0,
            weight: 0.13,
            colour: INK,
            anchor: Anchor::Left,
        };
        self.canvas
            .raw("<style>.t{fill:none;stroke-linecap:round;stroke-linejoin:round}</style>\n");
        self.canvas.text(words, 500.0, top, letters);
        top
    }

    /// Fills the site.
    pub(super) fn land(&mut self, colour: &str) {
        self.canvas.path(
            &self.outline,
            &format!("fill=\"{colour}\" fill-rule=\"evenodd\""),
        );
    }

    /// Draws the boundary.
    pub(super) fn outline(&mut self) {
        self.canvas.path(
            &self.outline,
            &format!(
                "fill=\"none\" stroke=\"#212529\" stroke-width=\"{:.0}\" stroke-linejoin=\"round\"",
                60.0 * self.grain
            ),
        );
    }

    /// Draws singularities.
    pub(super) fn singularities(&mut self, found: &[Singularity]) {
        let (radius, growth) = (110.0 * self.grain, 40.0 * self.grain);
        singularities(&mut self.canvas, &self.to, found, radius, growth);
    }

    /// The document.
    pub(super) fn finish(mut self) -> String {
        self.canvas.raw("</svg>\n");
        self.canvas.0
    }
}

/// Draws singularities, orange where three streets meet and blue where five do,
/// larger by `growth` for each further quarter of their index.
pub(super) fn singularities(
    canvas: &mut Canvas,
    to: &Transform,
    found: &[Singularity],
    radius: f64,
    growth: f64,
) {
    for singularity in found {
        let at = to.place(singularity.at);
        let colour = if singularity.quarter_index > 0 {
            "#d9480f"
        } else {
            "#1864ab"
        };
        let radius = radius + growth * f64::from(singularity.quarter_index.abs() - 1);
        dot(canvas, at, radius, colour);
    }
}

/// A dot with a white edge.
pub(super) fn dot(canvas: &mut Canvas, at: Coord<f64>, radius: f64, colour: &str) {
    canvas.raw(&format!(
        "<circle cx=\"{:.0}\" cy=\"{:.0}\" r=\"{radius:.0}\" fill=\"{colour}\" stroke=\"#fff\" stroke-width=\"{:.0}\"/>\n",
        at.x, at.y, 0.27 * radius
    ));
}

/// Lowest and highest coordinates of all parts.
pub(super) fn bounds(parts: &[Polygon<f64>]) -> (Coord<f64>, Coord<f64>) {
    let mut boxes = parts.iter().map(extent);
    let first = boxes.next().unwrap_or_default();
    boxes.fold(first, |(low, high), (l, h)| {
        (
            Coord {
                x: low.x.min(l.x),
                y: low.y.min(l.y),
            },
            Coord {
                x: high.x.max(h.x),
                y: high.y.max(h.y),
            },
        )
    })
}
