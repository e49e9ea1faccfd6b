//! Floorplans as SVG: storeys side by side, with walls, doors and labels.

use std::fmt::Write as _;

use geo_types::{Coord, Polygon};

use super::canvas::{Anchor, Canvas, Lettering, PathData, Transform};
use super::font;
use crate::floorplan::draw::{kinds, Door, Drawing, DrawnRoom};
use crate::floorplan::FloorplanStudy;
use crate::network::inside;
use crate::plane::{cross, dist, extent, left, unit};
use crate::site::Site;

/// Longer side of a storey on the sheet, sheet units (200 mm), the space around
/// it, the strip with its name above, and the legend below.
const LONG_SIDE: f64 = 20_000.0;
const GAP: f64 = 700.0;
const HEAD: f64 = 900.0;
const LINE: f64 = 420.0;
/// Kinds of rooms in the order of the specification.
const COLOURS: [&str; 10] = [
    "#d0ebff", "#ffec99", "#d3f9d8", "#ffe3e3", "#e5dbff", "#ffe8cc", "#c5f6fa", "#fcc2d7",
    "#e9fac8", "#dee2e6",
];
const INK: &str = "#212529";
const FAINT: &str = "#495057";

/// Draws all storeys of a study, side by side, to one scale: rooms in a colour
/// for each kind, with name and square metres; corridors white with their middle
/// lines; doors with their swing; shafts crossed out; obstacles hatched, green
/// where they are open to the sky; entrances as red arrows. Below, how many rooms
/// of each kind there are, a scale bar and north.
#[must_use]
pub fn floorplan_svg(study: &FloorplanStudy, site: &Site) -> String {
    let Some(outline) = site.parts.first() else {
        return String::new();
    };
    let (low, high) = extent(outline);
    let size = (high.x - low.x).max(high.y - low.y);
    let scale = (LONG_SIDE / size).min(LONG_SIDE);
    let (wide, tall) = ((high.x - low.x) * scale, (high.y - low.y) * scale);
    let lines = study
        .storeys
        .iter()
        .zip(&study.drawings)
        .map(|(s, d)| kinds(s, d).len());
    let foot = LINE * (3.0 + lines.max().unwrap_or(0) as f64);
    let count = study.storeys.len().max(1);
    // As near to a square as may be.
    let (cell_wide, cell_tall) = (wide.max(9000.0) + GAP, HEAD + tall + foot + GAP);
    let columns = (1..=count)
        .min_by(|&a, &b| {
            let side = |c: usize| (c as f64 * cell_wide).max(count.div_ceil(c) as f64 * cell_tall);
            side(a).total_cmp(&side(b))
        })
        .unwrap_or(1);
    let sheet = (
        columns as f64 * cell_wide + GAP,
        count.div_ceil(columns) as f64 * cell_tall + GAP,
    );
    let mut canvas = Canvas::default();
    canvas.raw(&format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.1}mm\" height=\"{:.1}mm\" viewBox=\"0 0 {:.0} {:.0}\">\n\
         <style>.t{{fill:none;stroke-linecap:round;stroke-linejoin:round}}</style>\n\
         <defs><pattern id=\"h\" width=\"260\" height=\"260\" patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\">\
         <path d=\"M0 0V260\" stroke=\"#868e96\" stroke-width=\"40\"/></pattern>\
         <pattern id=\"g\" width=\"300\" height=\"300\" patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\">\
         <path d=\"M0 0V300\" stroke=\"#69db7c\" stroke-width=\"90\"/></pattern></defs>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        sheet.0 / super::UNITS,
        sheet.1 / super::UNITS,
        sheet.0,
        sheet.1
    ));
    for (k, drawing) in study.drawings.iter().enumerate() {
        let left = GAP + (k % columns) as f64 * cell_wide;
        let top = GAP + (k / columns) as f64 * cell_tall;
        let at = Coord {
            x: left,
            y: top + HEAD,
        };
        let to = Transform::from_corner(scale, (low, high), at);
        let mut page = Page {
            canvas: &mut canvas,
            to,
            pen: (0.001 * size * scale).max(14.0),
        };
        let name = &study.storeys[k].specification.name;
        let title = match (name.is_empty(), count, &site.name) {
            (false, _, _) => name.clone(),
            (true, 1, Some(site)) => site.clone(),
            (true, 1, None) => "Floorplan".to_owned(),
            (true, _, _) => format!("Storey {k}"),
        };
        page.letters(&title, left, top + 0.5 * HEAD, 380.0, INK);
        page.storey(study, k, drawing, outline);
        page.legend(
            study,
            k,
            drawing,
            left,
            top + HEAD + tall + 2.0 * LINE,
            size,
        );
    }
    canvas.raw("</svg>\n");
    canvas.0
}

struct Page<'c> {
    canvas: &'c mut Canvas,
    to: Transform,
    pen: f64,
}

impl Page<'_> {
    fn letters(&mut self, text: &str, x: f64, y: f64, cap: f64, colour: &'static str) {
        let style = Lettering {
            cap,
            weight: 0.13,
            colour,
            anchor: Anchor::Left,
        };
        self.canvas.text(text, x, y, style);
    }

    fn fill(&mut self, polygons: &[&Polygon<f64>], attributes: &str) {
        let mut path = PathData::default();
        for polygon in polygons {
            path.polygon(polygon, &self.to);
        }
        self.canvas
            .path(&path.0, &format!("fill-rule=\"evenodd\" {attributes}"));
    }

    fn storey(
        &mut self,
        study: &FloorplanStudy,
        k: usize,
        drawing: &Drawing,
        outline: &Polygon<f64>,
    ) {
        let wall = (0.12 * self.to.scale).clamp(1.2 * self.pen, 4.0 * self.pen);
        let corridors: Vec<&Polygon<f64>> = drawing.corridors.iter().collect();
        self.fill(&corridors, "fill=\"#fff\"");
        for (c, kind) in study.storeys[k].specification.rooms.iter().enumerate() {
            let of_kind = drawing.rooms.iter().filter(|r| r.name == kind.name);
            let of_kind: Vec<&Polygon<f64>> = of_kind.map(|r| &r.outline).collect();
            let colour = COLOURS[c % COLOURS.len()];
            self.fill(&of_kind, &format!("fill=\"{colour}\""));
        }
        for (_, open, pieces) in &drawing.obstacles {
            let pieces: Vec<&Polygon<f64>> = pieces.iter().collect();
            let (ground, hatch) = if *open {
                ("#ebfbee", "url(#g)")
            } else {
                ("#f1f3f5", "url(#h)")
            };
            self.fill(&pieces, &format!("fill=\"{ground}\""));
            let pen = wall;
            self.fill(
                &pieces,
                &format!("fill=\"{hatch}\" stroke=\"{INK}\" stroke-width=\"{pen:.0}\""),
            );
        }
        let walls: Vec<&Polygon<f64>> = drawing.rooms.iter().map(|r| &r.outline).collect();
        let walled = format!(
            "fill=\"none\" stroke=\"{INK}\" stroke-width=\"{wall:.0}\" stroke-linejoin=\"miter\""
        );
        self.fill(&walls, &walled);
        let mut middle = PathData::default();
        for line in &drawing.lines {
            middle.line(line.map(|c| self.to.place(c)), false);
        }
        self.canvas.path(
            &middle.0,
            &format!(
                "fill=\"none\" stroke=\"#adb5bd\" stroke-width=\"{:.0}\" stroke-dasharray=\"{:.0} {:.0}\"",
                0.6 * self.pen,
                6.0 * self.pen,
                4.0 * self.pen
            ),
        );
        for shaft in &drawing.shafts {
            self.shaft(shaft, wall);
        }
        self.fill(
            &[outline],
            &format!(
                "fill=\"none\" stroke=\"{INK}\" stroke-width=\"{:.0}\" stroke-linejoin=\"miter\"",
                2.2 * wall
            ),
        );
        for room in drawing.rooms.iter().chain(&drawing.shafts) {
            if let Some(door) = &room.door {
                self.door(door, wall, drawing.shafts.contains(room));
            }
        }
        for room in &drawing.rooms {
            self.label(room);
        }
        for (at, inwards) in &drawing.entrances {
            self.entrance(*at, *inwards, study.spec.corridor_width, wall);
        }
    }

    /// A shaft: grey, crossed out.
    fn shaft(&mut self, shaft: &DrawnRoom, wall: f64) {
        self.fill(
            &[&shaft.outline],
            &format!("fill=\"#ced4da\" stroke=\"{INK}\" stroke-width=\"{wall:.0}\""),
        );
        let ring = &shaft.outline.exterior().0;
        let n = ring.len().saturating_sub(1);
        let mut cross = PathData::default();
        for k in 0..n / 2 {
            let ends = [ring[k], ring[k + n / 2]];
            cross.line(ends.map(|c| self.to.place(c)), false);
        }
        self.canvas.path(
            &cross.0,
            &format!(
                "fill=\"none\" stroke=\"{INK}\" stroke-width=\"{:.0}\"",
                self.pen
            ),
        );
    }

    /// A door: an opening in the wall, and for a room its leaf and swing.
    fn door(&mut self, door: &Door, wall: f64, is_shaft: bool) {
        let half = door.along * (0.5 * door.width);
        let ends = [door.at - half, door.at + half].map(|c| self.to.place(c));
        let mut opening = PathData::default();
        opening.line(ends, false);
        self.canvas.path(
            &opening.0,
            &format!(
                "fill=\"none\" stroke=\"{}\" stroke-width=\"{:.0}\"",
                if is_shaft { "#1864ab" } else { "#fff" },
                1.6 * wall
            ),
        );
        if is_shaft {
            return;
        }
        let hinge = door.at - half;
        let tip = self.to.place(hinge + door.inwards * door.width);
        let (from, radius) = (self.to.place(hinge), door.width * self.to.scale);
        let end = ends[1];
        // From the tip to the far jamb; the sheet's y points down, so what is
        // counter-clockwise on the floor is clockwise here.
        let sweep = u8::from(cross(door.inwards, door.along) < 0.0);
        let mut data = String::new();
        let _ = write!(
            data,
            "M{:.0} {:.0}L{:.0} {:.0}A{radius:.0} {radius:.0} 0 0 {} {:.0} {:.0}",
            from.x, from.y, tip.x, tip.y, sweep, end.x, end.y
        );
        self.canvas.path(
            &data,
            &format!(
                "fill=\"none\" stroke=\"{FAINT}\" stroke-width=\"{:.0}\"",
                0.7 * self.pen
            ),
        );
    }

    /// Name and size of a room, as large as it may be, where it is widest.
    fn label(&mut self, room: &DrawnRoom) {
        let size = format!("{:.0} m\u{b2}", room.area);
        let width = font::width(&room.name, 1.0).max(font::width(&size, 1.0));
        let (low, high) = extent(&room.outline);
        let most = 0.011 * LONG_SIDE / self.to.scale;
        // Two lines of text in capitals of 1 are a box 4 high.
        let cap = |at: Coord<f64>| {
            let reach = |d: Coord<f64>| clearance(&room.outline, at, d);
            let half = |d: Coord<f64>| reach(d).min(reach(d * -1.0));
            // The least over a few directions of what the box has there.
            let corner = unit(Coord {
                x: 0.6 * width,
                y: 2.0,
            });
            let mirrored = Coord {
                x: corner.x,
                y: -corner.y,
            };
            let long = (0.6 * width).hypot(2.0);
            let across = half(Coord { x: 1.0, y: 0.0 }) / (0.6 * width);
            let up = half(Coord { x: 0.0, y: 1.0 }) / 2.0;
            let aslant = half(corner).min(half(mirrored)) / long;
            across.min(up).min(aslant).min(most)
        };
        let mut best: Option<(f64, f64, Coord<f64>)> = None;
        let middle = (low + high) * 0.5;
        for k in 0..169 {
            let share = |k: i32| (f64::from(k) + 0.5) / 13.0;
            let at = Coord {
                x: low.x + (high.x - low.x) * share(k % 13),
                y: low.y + (high.y - low.y) * share(k / 13),
            };
            if !inside(&room.outline, at) {
                continue;
            }
            // The largest, and of those the most central.
            let (cap, off) = (cap(at), dist(at, middle));
            if best.is_none_or(|(c, o, _)| cap > 1.02 * c || cap > 0.98 * c && off < o) {
                best = Some((cap, off, at));
            }
        }
        let Some((cap, _, at)) = best else {
            return;
        };
        let (centre, cap) = (self.to.place(at), cap * self.to.scale);
        if cap < 0.0022 * LONG_SIDE {
            return;
        }
        for (text, dy, colour) in [(room.name.as_str(), -0.3, INK), (size.as_str(), 1.4, FAINT)] {
            let style = Lettering {
                cap: if dy > 0.0 { 0.8 * cap } else { cap },
                weight: 0.12,
                colour,
                anchor: Anchor::Middle,
            };
            self.canvas.text(text, centre.x, centre.y + dy * cap, style);
        }
    }

    /// A gap in the facade and an arrow that points inside.
    fn entrance(&mut self, at: Coord<f64>, inwards: Coord<f64>, width: f64, wall: f64) {
        let along = left(inwards) * (0.5 * width);
        let mut opening = PathData::default();
        opening.line([at - along, at + along].map(|c| self.to.place(c)), false);
        self.canvas.path(
            &opening.0,
            &format!(
                "fill=\"none\" stroke=\"#fff\" stroke-width=\"{:.0}\"",
                3.0 * wall
            ),
        );
        let unit = (0.02 * LONG_SIDE / self.to.scale).max(0.5 * width);
        let base = at - inwards * unit;
        let side = left(inwards) * (0.45 * unit);
        let mut arrow = PathData::default();
        let tip = at - inwards * (0.1 * unit);
        arrow.line(
            [base - side, base + side, tip].map(|c| self.to.place(c)),
            true,
        );
        self.canvas.path(&arrow.0, "fill=\"#e03131\"");
    }

    fn legend(
        &mut self,
        study: &FloorplanStudy,
        k: usize,
        drawing: &Drawing,
        left: f64,
        top: f64,
        size: f64,
    ) {
        let storey = &study.storeys[k];
        let mut y = top;
        for (name, count, area) in kinds(storey, drawing) {
            let kind = storey
                .specification
                .rooms
                .iter()
                .position(|r| r.name == name);
            let colour = COLOURS[kind.unwrap_or(0) % COLOURS.len()];
            let style = format!("fill=\"{colour}\" stroke=\"{INK}\" stroke-width=\"15\"");
            self.canvas.rect(left, y - 230.0, 380.0, 240.0, &style);
            let words = format!("{count} {name}, {area:.0} m\u{b2}");
            self.letters(&words, left + 520.0, y, 210.0, INK);
            y += LINE;
        }
        let words = format!(
            "corridors {:.0} m\u{b2}, {:.0} % of the floor",
            drawing.corridor_area(),
            100.0 * drawing.corridor_area() / drawing.area().max(1e-9)
        );
        self.letters(&words, left, y, 210.0, FAINT);
        // A round length of about a quarter of the floor.
        let tenth = 10_f64.powf((0.25 * size).log10().floor());
        let round = [5.0, 2.0, 1.0]
            .into_iter()
            .find(|r| r * tenth <= 0.25 * size);
        let metres = round.unwrap_or(1.0) * tenth;
        let (x, long) = (left + 4800.0, metres * self.to.scale);
        let bar = top - 60.0;
        self.canvas
            .rect(x, bar - 70.0, long, 70.0, &format!("fill=\"{INK}\""));
        self.letters(&format!("{metres} m"), x, bar + 330.0, 210.0, INK);
        let north = Coord {
            x: x + 1800.0,
            y: bar + 420.0,
        };
        self.canvas.raw(&format!(
            "<path d=\"M{:.0} {:.0}l-110 330 110-80 110 80z\" fill=\"{INK}\"/>\n",
            north.x,
            north.y - 260.0
        ));
        self.letters("N", north.x + 200.0, north.y, 210.0, INK);
    }
}

/// How far it is from a point inside a polygon to its boundary in a direction.
fn clearance(polygon: &Polygon<f64>, at: Coord<f64>, direction: Coord<f64>) -> f64 {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    let hits = rings.flat_map(|ring| ring.0.windows(2)).filter_map(|w| {
        let side = w[1] - w[0];
        let turn = cross(direction, side);
        let (t, s) = (
            cross(w[0] - at, side) / turn,
            cross(w[0] - at, direction) / turn,
        );
        (turn != 0.0 && t >= 0.0 && (0.0..=1.0).contains(&s)).then_some(t)
    });
    hits.fold(f64::INFINITY, f64::min)
}
