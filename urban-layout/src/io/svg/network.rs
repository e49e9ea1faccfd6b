//! A designed street network as SVG.

use geo_types::Coord;

use super::canvas::PathData;
use super::picture::{dot, Picture, INK};
use crate::design::NetworkStudy;
use crate::plane::{left, length, resample, unit};
use crate::site::Site;

/// From near a sink to far from it.
const SHADES: [&str; 5] = ["#1864ab", "#0b7285", "#2b8a3e", "#e67700", "#c92a2a"];

/// Draws the streets of a study, as wide as they are, on the faint mesh that
/// they were chosen from; along each a line whose colour says how far it is to
/// a sink of its level, from blue to red. Sinks that were placed are dots.
#[must_use]
pub fn network_svg(study: &NetworkStudy, site: &Site) -> String {
    let mut picture = Picture::with_legend(site);
    picture.land("#f8f9fa");
    let to = picture.to;
    let mut mesh = PathData::default();
    for part in &study.parts {
        let Some(level) = part.levels.last() else {
            continue;
        };
        for &[a, b] in level.mesh.edges() {
            let ends = [a, b].map(|v| to.place(level.mesh.points()[v]));
            mesh.line(ends, false);
        }
    }
    picture.canvas.path(
        &mesh.0,
        "fill=\"none\" stroke=\"#e9ecef\" stroke-width=\"12\"",
    );
    let round = "stroke-linecap=\"round\" stroke-linejoin=\"round\"";
    let mut elements = PathData::default();
    for element in &site.elements {
        let rings = std::iter::once(element.polygon.exterior()).chain(element.polygon.interiors());
        rings.for_each(|ring| elements.line(ring.0.iter().map(|&c| to.place(c)), true));
    }
    picture
        .canvas
        .path(&elements.0, "fill=\"#dee2e6\" fill-rule=\"evenodd\"");
    for road in &site.roads {
        let mut path = PathData::default();
        path.line(road.line.0.iter().map(|&c| to.place(c)), false);
        let pen = (road.width * to.scale).max(20.0);
        picture.canvas.path(
            &path.0,
            &format!("fill=\"none\" stroke=\"#ced4da\" stroke-width=\"{pen:.0}\" {round}"),
        );
    }
    let streets = || study.parts.iter().flat_map(|part| &part.streets);
    // Edges of all streets first, then their surfaces: crossings are open.
    for (colour, share) in [("#adb5bd", 1.0), ("#fff", 0.8)] {
        for (k, level) in study.spec.level.iter().enumerate() {
            let mut path = PathData::default();
            for street in streets().filter(|s| s.level == k) {
                path.line(street.line.0.iter().map(|&c| to.place(c)), false);
            }
            let pen = (share * level.width * to.scale).max(20.0);
            picture.canvas.path(
                &path.0,
                &format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{pen:.0}\" {round}"),
            );
        }
    }
    let far = streets()
        .flat_map(|s| s.away.iter().copied())
        .fold(1.0, f64::max);
    for (k, colour) in SHADES.iter().enumerate() {
        let mut path = PathData::default();
        let class = |metres: f64| ((5.0 * metres / far) as usize).min(4);
        for street in streets() {
            let mut run: Vec<Coord<f64>> = Vec::new();
            for (pair, &metres) in street.line.0.windows(2).zip(&street.away) {
                if class(metres) == k {
                    if run.is_empty() {
                        run.push(to.place(pair[0]));
                    }
                    run.push(to.place(pair[1]));
                } else {
                    path.line(run.drain(..), false);
                }
            }
            path.line(run, false);
        }
        picture.canvas.path(
            &path.0,
            &format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"45\" {round}"),
        );
    }
    let mut arrows = PathData::default();
    for street in streets().filter(|s| s.one_way) {
        for head in arrow(&street.line.0, ARROW / to.scale) {
            arrows.line(head.map(|c| to.place(c)), false);
        }
    }
    picture.canvas.path(
        &arrows.0,
        &format!("fill=\"none\" stroke=\"{INK}\" stroke-width=\"40\" {round}"),
    );
    picture.outline();
    for sink in few_sinks(study) {
        dot(&mut picture.canvas, to.place(sink), 110.0, "#c92a2a");
    }
    for (_, _, place) in study.placed_sinks() {
        dot(&mut picture.canvas, to.place(place), 150.0, "#fa5252");
    }
    legend(&mut picture, far);
    picture.finish()
}

/// Length of the arms of an arrow, sheet units; one for every twelve of them.
const ARROW: f64 = 170.0;

/// Arrows along a one-way street, one in its middle at least.
fn arrow(line: &[Coord<f64>], size: f64) -> Vec<[Coord<f64>; 3]> {
    let whole = length(line);
    let count = (whole / (12.0 * size)).floor().max(1.0);
    // The middles of so many equal parts, each with the point just before it.
    let points = resample(line, whole / (4.0 * count));
    let mut found = Vec::new();
    for k in (2..points.len()).step_by(4) {
        let (tip, along) = (points[k], unit(points[k] - points[k - 1]));
        let back = tip - along * size;
        let aside = left(along) * (0.6 * size);
        found.push([back + aside, tip, back - aside]);
    }
    found
}

/// The sinks of first levels, but where the whole boundary is one.
fn few_sinks(study: &NetworkStudy) -> Vec<Coord<f64>> {
    let mut found = Vec::new();
    for level in study.parts.iter().filter_map(|part| part.levels.first()) {
        let rim = level.mesh.edges().iter().zip(level.mesh.rim());
        let boundary: usize = rim.filter(|(_, rim)| *rim).count();
        let sinks = level.problem.sinks.iter().enumerate();
        let sinks: Vec<usize> = sinks.filter(|(_, &sink)| sink).map(|(v, _)| v).collect();
        if 2 * sinks.len() < boundary {
            found.extend(sinks.into_iter().map(|v| level.mesh.points()[v]));
        }
    }
    found
}

fn legend(picture: &mut Picture, far: f64) {
    let words = format!("way to a sink: 0 to {far:.0} m");
    let top = picture.legend(&words);
    for (k, colour) in SHADES.iter().enumerate() {
        let left = 500.0 + 900.0 * k as f64;
        picture.canvas.rect(
            left,
            top + 250.0,
            860.0,
            160.0,
            &format!("fill=\"{colour}\""),
        );
    }
}
