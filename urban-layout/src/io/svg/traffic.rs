//! The traffic on a designed network as SVG.

use super::canvas::PathData;
use super::picture::{dot, Picture};
use crate::design::StudyTraffic;
use crate::site::Site;

/// From little traffic to much, as wide as they are drawn, sheet units.
const SHADES: [(&str, f64); 5] = [
    ("#1864ab", 50.0),
    ("#0b7285", 80.0),
    ("#2b8a3e", 115.0),
    ("#e67700", 155.0),
    ("#c92a2a", 200.0),
];
const NONE: &str = "#adb5bd";

/// Draws the streets of a network by the cars that pass in an hour, both ways
/// together, in five even steps up to the busiest street: wider and from blue to
/// red; grey where nobody goes. Dots are the places where traffic leaves, as in
/// figure 8 of *Computational Network Design*.
#[must_use]
pub fn traffic_svg(traffic: &StudyTraffic, site: &Site) -> String {
    let mut picture = Picture::with_legend(site);
    picture.land("#f8f9fa");
    picture.outline();
    let to = picture.to;
    let graph = &traffic.graph;
    let cars = traffic.predicted.both_ways(graph);
    let most = cars.iter().copied().fold(0.0, f64::max);
    let mut none = PathData::default();
    let mut some = SHADES.map(|_| PathData::default());
    for (l, link) in graph.links.iter().enumerate() {
        if link.reverse.is_some_and(|r| r < l) {
            continue;
        }
        let path = if cars[l] > 0.0 {
            let steps = SHADES.len();
            // The step that a street is in has its upper bound.
            let step = (cars[l] / most * steps as f64).ceil() as usize;
            &mut some[step.clamp(1, steps) - 1]
        } else {
            &mut none
        };
        path.line(link.line.0.iter().map(|&c| to.place(c)), false);
    }
    let mut draw = |data: &str, colour: &str, pen: f64| {
        let pen = format!(
            "fill=\"none\" stroke=\"{colour}\" stroke-width=\"{pen:.0}\" stroke-linecap=\"round\" stroke-linejoin=\"round\""
        );
        picture.canvas.path(data, &pen);
    };
    draw(&none.0, NONE, 35.0);
    for (path, (colour, pen)) in some.iter().zip(SHADES) {
        draw(&path.0, colour, pen);
    }
    // Where somebody leaves; every node of a boundary may be an exit.
    let mut used = vec![false; graph.nodes.len()];
    traffic.trips.iter().for_each(|trip| used[trip.to] = true);
    for &exit in traffic.exits.iter().filter(|&&n| used[n]) {
        dot(
            &mut picture.canvas,
            to.place(graph.nodes[exit]),
            110.0,
            "#862e9c",
        );
    }
    legend(&mut picture, most);
    picture.finish()
}

fn legend(picture: &mut Picture, most: f64) {
    let words = format!("cars per hour: none, up to {most:.0}");
    let top = picture.legend(&words);
    let boxes = std::iter::once((NONE, 35.0)).chain(SHADES);
    for (k, (colour, pen)) in boxes.enumerate() {
        let left = 500.0 + 900.0 * k as f64;
        let fill = format!("fill=\"{colour}\"");
        picture
            .canvas
            .rect(left, top + 330.0 - 0.5 * pen, 860.0, pen, &fill);
    }
}
