//! The plan itself: land, parcels by quality, streets, names.

use std::collections::BTreeMap;

use geo_types::{Coord, LineString};
use park_grammar::picture::PictureOptions;

use super::canvas::{Anchor, Canvas, Lettering, PathData, Transform};
use super::font::{self, Pen};
use super::palette::{land, street_style, LAND, SHADES};
use super::SvgOptions;
use crate::layout::plane::{distance, length, lerp, polygon_area};
use crate::layout::{measure_parcel, Layout, Tile, TileKind};
use crate::site::{GivenRoad, RoadClass, Site};

/// The shade of a parcel: how far its corner deviation and box ratio have come
/// towards undesirable (15 degrees, 1.2), in five steps.
pub(super) fn shade(tile: &Tile) -> usize {
    let (deviation, ratio) = tile.parcel.as_ref().map_or_else(
        || measure_parcel(&tile.polygon),
        |info| (info.corner_deviation_deg, info.box_ratio),
    );
    let badness = (deviation / 15.0).max((ratio - 1.0) / 0.2);
    SHADES
        .iter()
        .position(|shade| badness <= shade.most)
        .unwrap_or(SHADES.len() - 1)
}

/// Draws the map inside the frame (x, y, width, height in sheet units).
pub(super) fn draw(
    canvas: &mut Canvas,
    layout: &Layout,
    site: &Site,
    options: &SvgOptions,
    to: &Transform,
    frame: [f64; 4],
) {
    let [x, y, w, h] = frame;
    canvas.raw(&format!(
        "<clipPath id=\"frame\"><rect x=\"{x:.0}\" y=\"{y:.0}\" width=\"{w:.0}\" height=\"{h:.0}\"/></clipPath>\n"
    ));
    canvas.raw("<g clip-path=\"url(#frame)\">\n");
    canvas.rect(x, y, w, h, "fill=\"#f1eee5\"");
    if options.context {
        context(canvas, site, to);
    }
    tiles(canvas, layout, to);
    parks(canvas, layout, to);
    given_roads(canvas, layout, to);
    outlines(canvas, layout, to);
    centrelines(canvas, layout, to);
    boundary(canvas, site, to);
    if options.names {
        names(canvas, layout, site, to);
    }
    canvas.raw("</g>\n");
    canvas.rect(
        x,
        y,
        w,
        h,
        "fill=\"none\" stroke=\"#6d6656\" stroke-width=\"25\"",
    );
}

/// Existing streets outside, in grey, with a kerb.
fn context(canvas: &mut Canvas, site: &Site, to: &Transform) {
    for (extra, colour) in [(30.0, "#c6bfad"), (0.0, "#e3ddcf")] {
        let mut widths: Vec<(i64, PathData)> = Vec::new();
        for street in &site.outside_streets {
            let wide = (street.width * to.scale + extra).round() as i64;
            let at = widths
                .iter()
                .position(|(known, _)| *known == wide)
                .unwrap_or_else(|| {
                    widths.push((wide, PathData::default()));
                    widths.len() - 1
                });
            widths[at]
                .1
                .line(street.line.0.iter().map(|c| to.place(*c)), false);
        }
        for (wide, data) in widths {
            canvas.path(
                &data.0,
                &format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{wide}\" stroke-linejoin=\"round\""),
            );
        }
    }
}

/// Land by kind, parcels by shade; one path each.
fn tiles(canvas: &mut Canvas, layout: &Layout, to: &Transform) {
    for style in LAND {
        let mut data = PathData::default();
        layout
            .tiles_of(style.kind)
            .for_each(|tile| data.polygon(&tile.polygon, to));
        canvas.path(
            &data.0,
            &format!("fill=\"{}\" fill-rule=\"evenodd\"", style.fill),
        );
        if let Some(pattern) = style.pattern {
            canvas.path(
                &data.0,
                &format!("fill=\"url(#{pattern})\" fill-rule=\"evenodd\""),
            );
        }
        if !style.edge.is_empty() {
            canvas.path(
                &data.0,
                &format!(
                    "fill=\"none\" stroke=\"{}\" stroke-width=\"16\" stroke-linejoin=\"round\"",
                    style.edge
                ),
            );
        }
    }
    let mut shades: Vec<PathData> = SHADES.iter().map(|_| PathData::default()).collect();
    let mut landlocked = PathData::default();
    for tile in layout.parcels() {
        shades[shade(tile)].polygon(&tile.polygon, to);
        if tile
            .parcel
            .as_ref()
            .is_some_and(|info| !info.street_access && !info.access_exempt)
        {
            landlocked.polygon(&tile.polygon, to);
        }
    }
    for (shade, data) in SHADES.iter().zip(&shades) {
        canvas.path(
            &data.0,
            &format!(
                "fill=\"{}\" fill-rule=\"evenodd\" stroke=\"#a3926b\" stroke-width=\"9\" stroke-linejoin=\"round\"",
                shade.fill
            ),
        );
    }
    canvas.path(&landlocked.0, "fill=\"url(#barred)\"");
}

/// What is seen of parks: things that are this wide or more, sheet units.
const SEEN: f64 = 14.0;

/// The designs of parks.
fn parks(canvas: &mut Canvas, layout: &Layout, to: &Transform) {
    let mut defs: BTreeMap<String, String> = BTreeMap::new();
    let mut bodies = String::new();
    for (k, design) in layout.parks.iter().enumerate() {
        let options = PictureOptions::default()
            .with_origin(to.centre)
            .with_line(7.0 / to.scale)
            .with_least(0.5 * SEEN / to.scale)
            .with_prefix(format!("park{k}"));
        let drawing = design.scene.draw(&options);
        defs.extend(drawing.defs);
        bodies.push_str(&drawing.body);
    }
    if bodies.is_empty() {
        return;
    }
    canvas.raw("<defs>\n");
    defs.values().for_each(|definition| canvas.raw(definition));
    canvas.raw("</defs>\n");
    let Coord { x, y } = to.at;
    // A drawing's unit is a centimetre.
    canvas.raw(&format!(
        "<g transform=\"translate({x:.0} {y:.0})scale({:.6})\">\n{bodies}</g>\n",
        to.scale / 100.0
    ));
}

/// Paving of a given road.
const fn road_fill(class: RoadClass) -> &'static str {
    match class {
        RoadClass::Major => "#cfc6b2",
        _ => "#e0d9c9",
    }
}

/// Given roads, darker than new streets.
fn given_roads(canvas: &mut Canvas, layout: &Layout, to: &Transform) {
    for street in layout.streets.iter().filter(|s| s.given) {
        let mut data = PathData::default();
        data.line(street.line.0.iter().map(|c| to.place(*c)), false);
        let wide = street.width * to.scale;
        canvas.path(
            &data.0,
            &format!(
                "fill=\"none\" stroke=\"{}\" stroke-width=\"{wide:.0}\" stroke-linejoin=\"round\"",
                road_fill(street.class)
            ),
        );
    }
}

/// Kerbs: the outlines of blocks, or of the street area where there are none.
fn outlines(canvas: &mut Canvas, layout: &Layout, to: &Transform) {
    let mut data = PathData::default();
    layout
        .tiles_of(TileKind::StreetArea)
        .for_each(|tile| data.polygon(&tile.polygon, to));
    canvas.path(
        &data.0,
        "fill=\"none\" stroke=\"#7d7360\" stroke-width=\"17\" stroke-linejoin=\"round\"",
    );
    let mut data = PathData::default();
    layout
        .blocks
        .iter()
        .for_each(|block| data.polygon(&block.polygon, to));
    canvas.path(
        &data.0,
        "fill=\"none\" stroke=\"#7d7360\" stroke-width=\"17\" stroke-linejoin=\"round\"",
    );
}

/// Centrelines dashed by class, and small dots where they meet.
fn centrelines(canvas: &mut Canvas, layout: &Layout, to: &Transform) {
    for class in [
        RoadClass::Local,
        RoadClass::CulDeSac,
        RoadClass::Collector,
        RoadClass::Major,
    ] {
        let mut data = PathData::default();
        for street in layout.streets.iter().filter(|s| s.class == class) {
            data.line(street.line.0.iter().map(|c| to.place(*c)), false);
        }
        canvas.path(
            &data.0,
            &format!("fill=\"none\" {}", street_style(class).stroke),
        );
    }
    let mut dots = PathData::default();
    for junction in layout.junctions.iter().filter(|j| j.degree > 2) {
        let p = to.place(junction.at);
        dots.line(
            [
                p,
                Coord {
                    x: p.x + 1.0,
                    y: p.y,
                },
            ],
            false,
        );
    }
    canvas.path(
        &dots.0,
        "fill=\"none\" stroke=\"#a0957f\" stroke-width=\"52\" stroke-linecap=\"round\"",
    );
}

/// The site's outline: a soft band and a dash-dot line on it.
fn boundary(canvas: &mut Canvas, site: &Site, to: &Transform) {
    let mut data = PathData::default();
    site.parts.iter().for_each(|part| data.polygon(part, to));
    let line = "fill=\"none\" stroke-linejoin=\"round\"";
    canvas.path(
        &data.0,
        &format!("{line} stroke=\"#a8402d\" stroke-opacity=\"0.16\" stroke-width=\"150\""),
    );
    canvas.path(
        &data.0,
        &format!("{line} stroke=\"#a8402d\" stroke-width=\"42\" stroke-dasharray=\"420 90 60 90\""),
    );
}

/// Names along given roads, once each on the longest, and labels of open land.
fn names(canvas: &mut Canvas, layout: &Layout, site: &Site, to: &Transform) {
    let mut named: Vec<(&str, &GivenRoad)> = Vec::new();
    for road in &site.roads {
        let Some(name) = road.name.as_deref().filter(|name| font::can_draw(name)) else {
            continue;
        };
        match named.iter_mut().find(|(known, _)| *known == name) {
            Some((_, best)) if length(&road.line.0) > length(&best.line.0) => *best = road,
            Some(_) => {}
            None => named.push((name, road)),
        }
    }
    for (name, road) in named {
        // The letters fill half of the street's width, but stay legible.
        let cap = (0.42 * road.width * to.scale).clamp(120.0, 300.0);
        if let Some((data, strip)) = along(name, cap, &road.line, to) {
            let paving = road_fill(road.class);
            let wide = cap * 1.5;
            canvas.path(
                &strip,
                &format!("class=\"t\" stroke=\"{paving}\" stroke-width=\"{wide:.0}\""),
            );
            let pen = cap * 0.13;
            canvas.path(
                &data,
                &format!("class=\"t\" stroke=\"#4d4637\" stroke-width=\"{pen:.0}\""),
            );
        }
    }
    for tile in layout
        .tiles
        .iter()
        .filter(|t| t.kind != TileKind::Parcel && t.kind != TileKind::StreetArea)
    {
        let Some(label) = tile.label.as_deref().filter(|label| font::can_draw(label)) else {
            continue;
        };
        let centre = centroid(&tile.polygon.exterior().0);
        let room = polygon_area(&tile.polygon).sqrt() * to.scale;
        let cap = 170.0;
        if font::width(label, cap) < 1.1 * room {
            let p = to.place(centre);
            let style = Lettering {
                cap,
                weight: 0.12,
                colour: land(tile.kind).ink,
                anchor: Anchor::Middle,
            };
            canvas.text(label, p.x, p.y + cap / 2.0, style);
        }
    }
}

/// Mean of the vertices; good enough for a label.
fn centroid(ring: &[Coord<f64>]) -> Coord<f64> {
    let n = ring.len().max(1) as f64;
    let sum = ring.iter().fold(Coord { x: 0.0, y: 0.0 }, |s, c| Coord {
        x: s.x + c.x,
        y: s.y + c.y,
    });
    Coord {
        x: sum.x / n,
        y: sum.y / n,
    }
}

/// Path data of a text along the straightest stretch of a line, upright, and of
/// that stretch; `None` where the line is too short or too bent.
fn along(text: &str, cap: f64, line: &LineString<f64>, to: &Transform) -> Option<(String, String)> {
    let mut points: Vec<Coord<f64>> = line.0.iter().map(|c| to.place(*c)).collect();
    let (long, wide) = (length(&points), font::width(text, cap));
    if wide * 1.2 > long {
        return None;
    }
    let ahead = |points: &[Coord<f64>], at: f64| Some((on(points, at)?, on(points, at + wide)?));
    let tries = 24;
    let mut best = (0.0, 0.0);
    for k in 1..tries {
        let at = (long - wide) * f64::from(k) / f64::from(tries);
        let (p, q) = ahead(&points, at)?;
        let middle = 1.0 - (2.0 * f64::from(k) / f64::from(tries) - 1.0).abs();
        let straight = distance(p, q) / wide + 0.02 * middle;
        if straight > best.0 {
            best = (straight, at);
        }
    }
    if best.0 < 0.97 {
        return None;
    }
    let (p, q) = ahead(&points, best.1)?;
    let mut start = best.1;
    if q.x < p.x {
        points.reverse();
        start = long - start - wide;
    }
    let at = |s: f64| on(&points, s).unwrap_or(p);
    let data = font::path_along(text, cap, |s| {
        let half = 0.3 * cap;
        let (a, b, c) = (at(start + s - half), at(start + s + half), at(start + s));
        let angle = (b.y - a.y).atan2(b.x - a.x);
        // The baseline lies half a letter below the line.
        Pen {
            x: c.x - 0.5 * cap * angle.sin(),
            y: c.y + 0.5 * cap * angle.cos(),
            angle,
        }
    });
    let mut strip = PathData::default();
    strip.line(
        (0..=12).map(|k| at(start + wide * f64::from(k) / 12.0)),
        false,
    );
    Some((data, strip.0))
}

/// The point at an arc length.
fn on(points: &[Coord<f64>], mut at: f64) -> Option<Coord<f64>> {
    for w in points.windows(2) {
        let step = distance(w[0], w[1]);
        if at <= step && step > 0.0 {
            return Some(lerp(w[0], w[1], (at / step).max(0.0)));
        }
        at -= step;
    }
    points.last().copied()
}
