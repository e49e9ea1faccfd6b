//! Streamlines as SVG, painted by what they are judged by.

use geo_types::Coord;
use streamline::{CriteriaTotals, Criterion, LineCriteria, SegmentCriteria, Streamline};

use super::canvas::{Anchor, Canvas, Lettering, PathData};
use super::font;
use super::picture::Picture;
use crate::layout::plane::rings;
use crate::plane::simplify;
use crate::site::Site;
use crate::streamlines::{PartStreamlines, StreamlineStudy};

/// What the colours of a picture of streamlines say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Paint {
    /// Which of the two families a line belongs to.
    #[default]
    Families,
    /// How good lines, their segments or tiles are by a criterion, from blue
    /// to red; of [`Criterion::Singularities`], where they are.
    Criterion(Criterion),
}

/// How streamlines are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct StreamlineSvgOptions {
    /// What the colours say. Default: the families.
    pub paint: Paint,
    /// The longer side of the picture, millimetres, margins included and the
    /// legend below not. Default 200.
    pub long_side_mm: f64,
    /// How far a drawn line may lie from the traced one, in millimetres on the
    /// picture. Default 0.1.
    pub tolerance_mm: f64,
    /// Whether a legend stands below. Default true.
    pub legend: bool,
    /// What the legend begins with, such as the name of the field. Default
    /// nothing.
    pub title: Option<String>,
}

impl Default for StreamlineSvgOptions {
    fn default() -> Self {
        Self {
            paint: Paint::Families,
            long_side_mm: 200.0,
            tolerance_mm: 0.1,
            legend: true,
            title: None,
        }
    }
}

const FAMILIES: [(&str, &str); 2] = [("#0b7285", "family 0"), ("#9c36b5", "family 1")];
/// From best to worst.
const COLOURS: [&str; 6] = [
    "#1864ab", "#22b8cf", "#82c91e", "#fab005", "#f76707", "#c92a2a",
];
/// What nothing is known of.
const SILENT: &str = "#ced4da";
/// Lines that only show where they run.
const PLAIN: &str = "#868e96";
/// Letters of the legend.
const INK: &str = "#343a40";

/// Height of the legend, sheet units at 200 mm.
const FOOT: f64 = 1500.0;

/// Limits of the classes between the colours, in the criterion's unit, and what
/// they are called.
struct Scale {
    limits: [f64; 5],
    words: [&'static str; 5],
    unit: &'static str,
}

fn scale(criterion: Criterion) -> Scale {
    let right_angles = |degrees: f64| degrees / 90.0;
    match criterion {
        // As in pictures of fields: streamlines 20 m apart come a tenth nearer
        // or farther within 200, 100, 50, 25 and 10 m.
        Criterion::Divergence => Scale {
            limits: [0.0005, 0.001, 0.002, 0.004, 0.01],
            words: ["0.5", "1", "2", "4", "10"],
            unit: "1/km",
        },
        Criterion::Continuity => Scale {
            limits: [1e-12, 0.001, 0.002, 0.004, 0.008],
            words: ["0", "1", "2", "4", "8"],
            unit: "turns/km",
        },
        Criterion::Parallelism | Criterion::Perpendicularity => Scale {
            limits: [2.0, 5.0, 10.0, 20.0, 40.0].map(right_angles),
            words: ["2", "5", "10", "20", "40"],
            unit: "degrees",
        },
        Criterion::Convexity => Scale {
            limits: [0.001, 0.005, 0.01, 0.02, 0.05],
            words: ["0.001", "0.005", "0.01", "0.02", "0.05"],
            unit: "1 - hull/perimeter",
        },
        Criterion::Singularities => Scale {
            limits: [0.0; 5],
            words: [""; 5],
            unit: "",
        },
    }
}

impl Scale {
    /// Which colour a value has.
    fn class(&self, value: f64) -> usize {
        self.limits.iter().filter(|&&limit| value >= limit).count()
    }
}

/// Draws the lines of a study: coloured by family, or by one of UrbanFab's six
/// criteria in fixed classes, so that pictures can be compared. Divergence,
/// parallelism and perpendicularity colour each segment, continuity each line
/// with a dot at every turn, convexity each tile; singularities are marked on
/// the pictures of families and of singularities.
///
/// The text depends on nothing but the arguments, byte by byte.
#[must_use]
pub fn streamlines_svg(
    study: &StreamlineStudy,
    site: &Site,
    options: &StreamlineSvgOptions,
) -> String {
    let long_side = options.long_side_mm.max(20.0) * super::UNITS;
    let foot = FOOT * long_side / (200.0 * super::UNITS);
    let mut picture = Picture::new(site, long_side, if options.legend { foot } else { 0.0 });
    let tolerance = options.tolerance_mm.max(0.0) * super::UNITS / picture.to.scale;
    match options.paint {
        Paint::Families => families(&mut picture, study, tolerance),
        Paint::Criterion(Criterion::Convexity) => {
            tiles(&mut picture, study, tolerance);
            plain(&mut picture, study, tolerance, "#fff");
        }
        Paint::Criterion(Criterion::Singularities) => {
            plain(&mut picture, study, tolerance, PLAIN);
        }
        Paint::Criterion(criterion) => segments(&mut picture, study, criterion, tolerance),
    }
    picture.outline();
    if matches!(
        options.paint,
        Paint::Families | Paint::Criterion(Criterion::Singularities)
    ) {
        let found = study.field.singularities();
        picture.singularities(&found);
    }
    if options.legend {
        legend(&mut picture, &study.criteria.totals, options);
    }
    picture.finish()
}

fn stroke(picture: &Picture, colour: &str, width: f64) -> String {
    format!(
        "fill=\"none\" stroke=\"{colour}\" stroke-width=\"{:.0}\" stroke-linejoin=\"round\"",
        width * picture.grain
    )
}

/// All lines of the study with what they are judged by.
fn lines(study: &StreamlineStudy) -> impl Iterator<Item = (&Streamline, &LineCriteria)> {
    let parts = study.parts.iter();
    parts.flat_map(|part: &PartStreamlines| part.lines.iter().zip(&part.criteria.lines))
}

fn families(picture: &mut Picture, study: &StreamlineStudy, tolerance: f64) {
    for (family, (colour, _)) in FAMILIES.iter().enumerate() {
        let mut path = PathData::default();
        for (line, _) in lines(study).filter(|(line, _)| usize::from(line.family) == family) {
            let points = simplify(&line.points, tolerance);
            path.line(points.iter().map(|&c| picture.to.place(c)), false);
        }
        let style = stroke(picture, colour, 30.0);
        picture.canvas.path(&path.0, &style);
    }
}

fn plain(picture: &mut Picture, study: &StreamlineStudy, tolerance: f64, colour: &str) {
    let mut path = PathData::default();
    for (line, _) in lines(study) {
        let points = simplify(&line.points, tolerance);
        path.line(points.iter().map(|&c| picture.to.place(c)), false);
    }
    let style = stroke(picture, colour, 22.0);
    picture.canvas.path(&path.0, &style);
}

/// What a segment is coloured by; turns belong to the whole line.
fn value(criterion: Criterion, line: &LineCriteria, segment: &SegmentCriteria) -> Option<f64> {
    match criterion {
        Criterion::Divergence => segment.divergence,
        Criterion::Continuity => Some(line.continuity),
        Criterion::Parallelism => segment.parallelism,
        Criterion::Perpendicularity => segment.perpendicularity,
        Criterion::Convexity | Criterion::Singularities => None,
    }
}

fn segments(picture: &mut Picture, study: &StreamlineStudy, criterion: Criterion, tolerance: f64) {
    let scale = scale(criterion);
    let mut paths: Vec<PathData> = (0..=COLOURS.len()).map(|_| PathData::default()).collect();
    let mut turns = Vec::new();
    for (line, judged) in lines(study) {
        let class = |segment: &SegmentCriteria| {
            value(criterion, judged, segment).map_or(COLOURS.len(), |v| scale.class(v))
        };
        // The segments are the equal pieces between the points of this line.
        let points = line.resample(
            judged
                .segments
                .first()
                .map_or(0.0, |s| s.piece.length * (1.0 + 1e-9)),
        );
        let mut first = 0;
        for run in judged.segments.chunk_by(|a, b| class(a) == class(b)) {
            let last = (first + run.len()).min(points.points.len() - 1);
            let piece = simplify(&points.points[first..=last], tolerance);
            paths[class(&run[0])].line(piece.iter().map(|&c| picture.to.place(c)), false);
            first = last;
        }
        if criterion == Criterion::Continuity {
            let turning = judged.segments.iter().filter(|s| s.turns > 0);
            turns.extend(turning.map(|s| s.piece.at));
        }
    }
    // The worst on top.
    let colours = [SILENT].into_iter().chain(COLOURS);
    let order = [COLOURS.len()].into_iter().chain(0..COLOURS.len());
    for (colour, class) in colours.zip(order) {
        let style = stroke(picture, colour, 36.0);
        picture.canvas.path(&paths[class].0, &style);
    }
    for at in turns {
        let at = picture.to.place(at);
        let radius = 55.0 * picture.grain;
        picture.canvas.raw(&format!(
            "<circle cx=\"{:.0}\" cy=\"{:.0}\" r=\"{radius:.0}\" fill=\"#000\"/>\n",
            at.x, at.y
        ));
    }
}

/// All land in the best colour, and the other tiles on top: most are convex.
fn tiles(picture: &mut Picture, study: &StreamlineStudy, tolerance: f64) {
    let scale = scale(Criterion::Convexity);
    let mut paths: Vec<PathData> = COLOURS.iter().map(|_| PathData::default()).collect();
    for part in &study.parts {
        for (tile, judged) in part.criteria.tiles.iter().enumerate() {
            let class = scale.class(judged.convexity);
            if class == 0 {
                continue;
            }
            for ring in rings(&part.tiling.polygon(tile)) {
                let points = simplify(&ring.0, tolerance);
                let open = points[..points.len() - 1].iter();
                paths[class].line(open.map(|&c| picture.to.place(c)), true);
            }
        }
    }
    picture.land(COLOURS[0]);
    for (path, colour) in paths.iter().zip(COLOURS) {
        let style = format!("fill=\"{colour}\" fill-rule=\"evenodd\"");
        picture.canvas.path(&path.0, &style);
    }
}

/// The criterion's name, its figure, and what the colours mean.
fn legend(picture: &mut Picture, totals: &CriteriaTotals, options: &StreamlineSvgOptions) {
    let grain = picture.grain;
    let (left, room) = (500.0 * grain, picture.width - 1000.0 * grain);
    let top = picture.height + 250.0 * grain;
    let (headline, entries, unit) = match options.paint {
        Paint::Families => {
            let headline = format!(
                "{} streamlines, {:.1} km; {} tiles; {}",
                totals.lines,
                totals.length / 1e3,
                totals.tiles,
                singularities(totals)
            );
            let entries = FAMILIES.map(|(colour, word)| (colour, word.to_owned()));
            (headline, entries.to_vec(), "")
        }
        Paint::Criterion(criterion) => {
            let scale = scale(criterion);
            let mut entries = Vec::new();
            if criterion != Criterion::Singularities {
                for (colour, word) in COLOURS.iter().zip(scale.words) {
                    let first = if word == "0" { "" } else { "< " };
                    entries.push((*colour, format!("{first}{word}")));
                }
                entries.push((COLOURS[5], format!("from {}", scale.words[4])));
            }
            (words(criterion, totals), entries, scale.unit)
        }
    };
    let title = options
        .title
        .as_ref()
        .map_or_else(|| headline.clone(), |title| format!("{title}: {headline}"));
    // A long line of text shrinks to fit.
    let cap = (260.0 * grain).min(room / font::width(&title, 1.0));
    let text = |canvas: &mut Canvas, words: &str, x: f64, y: f64, cap: f64| {
        let style = Lettering {
            cap,
            weight: 0.13,
            colour: INK,
            anchor: Anchor::Left,
        };
        canvas.text(words, x, y, style);
    };
    picture
        .canvas
        .raw("<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n");
    text(&mut picture.canvas, &title, left, top + 260.0 * grain, cap);
    let places = entries.len() as f64 + if unit.is_empty() { 0.0 } else { 1.6 };
    let column = room / places.max(4.0);
    let small = (190.0 * grain).min(column / 7.0);
    let y = top + 750.0 * grain;
    for (i, (colour, words)) in entries.iter().enumerate() {
        let x = left + i as f64 * column;
        let swatch = format!("fill=\"{colour}\"");
        picture
            .canvas
            .rect(x, y, column * 0.22, 200.0 * grain, &swatch);
        let at = Coord {
            x: x + column * 0.28,
            y: y + 195.0 * grain,
        };
        text(&mut picture.canvas, words, at.x, at.y, small);
    }
    let x = left + entries.len() as f64 * column;
    text(&mut picture.canvas, unit, x, y + 195.0 * grain, small);
    picture.canvas.raw("</g>\n");
}

/// Their number in words.
fn singularities(totals: &CriteriaTotals) -> String {
    match totals.singularities {
        1 => "1 singularity".to_owned(),
        n => format!("{n} singularities"),
    }
}

/// A criterion's figure in words.
fn words(criterion: Criterion, totals: &CriteriaTotals) -> String {
    let value = criterion.of(totals);
    if !criterion.is_measured(totals) {
        return format!("{}: nothing to measure", criterion.name());
    }
    match criterion {
        Criterion::Divergence => format!("divergence: mean {:.2} per km", value * 1e3),
        Criterion::Continuity => format!(
            "continuity: {:.2} turns per km ({:.0} turns)",
            value * 1e3,
            totals.continuity.sum
        ),
        Criterion::Parallelism => {
            format!("boundary parallelism: mean {:.1}\u{b0} off", value * 90.0)
        }
        Criterion::Perpendicularity => {
            format!(
                "boundary perpendicularity: mean {:.1}\u{b0} off",
                value * 90.0
            )
        }
        Criterion::Convexity => format!(
            "tile convexity: mean {value:.4}, spread {:.4}",
            totals.convexity.deviation
        ),
        Criterion::Singularities => {
            format!("{}, {:.2} per km\u{b2}", singularities(totals), value * 1e6)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_rise_and_classes_follow() {
        for criterion in Criterion::ALL {
            let scale = scale(criterion);
            if criterion == Criterion::Singularities {
                continue;
            }
            assert!(scale.limits.windows(2).all(|l| l[0] < l[1]));
            assert_eq!(scale.class(0.0), 0);
            for (i, &limit) in scale.limits.iter().enumerate() {
                assert_eq!(scale.class(limit), i + 1);
                assert_eq!(scale.class(limit * 0.999), i);
            }
        }
    }
}
