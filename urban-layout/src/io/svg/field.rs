//! A field as SVG: its streamlines over the divergence, and its singularities.

use crossfield::{Cursor, Field};
use geo_types::{Coord, Polygon};
use streamline::{candidates, CandidateOptions, Seed, TraceOptions};

use super::canvas::{Canvas, PathData, Transform};
use super::picture::Picture;
use crate::adapt::Arms;
use crate::field::FieldStudy;
use crate::plane::extent;
use crate::site::Site;

/// Longer side of the picture, sheet units (200 mm).
const LONG_SIDE: f64 = 20_000.0;
/// Cells of the divergence map along the longer side.
const CELLS: f64 = 160.0;
/// Streamlines side by side along the longer side.
const LINES: f64 = 56.0;

/// Mean |div| from which a colour holds, 1 / metre: streamlines 20 m apart
/// come a tenth nearer or farther within 200, 100, 50, 25 and 10 m.
const CLASSES: [(f64, &str); 5] = [
    (0.0005, "#fff3d6"),
    (0.001, "#ffe3ae"),
    (0.002, "#ffcb80"),
    (0.004, "#ffa94d"),
    (0.01, "#f76707"),
];

/// Draws the fields of a study: land shaded by the mean absolute divergence of
/// both arms (white below 1 / 2000 m, darkest from 1 / 100 m), streamlines of
/// both families, and singularities, orange where three streets meet and blue
/// where five do, larger for larger indices.
#[must_use]
pub fn field_svg(study: &FieldStudy, site: &Site) -> String {
    let mut picture = Picture::new(site, LONG_SIDE, 0.0);
    let (size, to) = (picture.size, picture.to);
    picture.clip();
    for (part, field) in site.parts.iter().zip(&study.fields) {
        shade(&mut picture.canvas, part, field, size / CELLS, &to);
    }
    picture.canvas.raw("</g>\n");
    for (part, field) in site.parts.iter().zip(&study.fields) {
        streamlines(&mut picture.canvas, part, field, size / LINES, &to);
    }
    picture.outline();
    picture.singularities(&study.singularities());
    picture.finish()
}

/// Rows of cells of one colour, one path a colour.
fn shade(canvas: &mut Canvas, part: &Polygon<f64>, field: &Field, cell: f64, to: &Transform) {
    let (low, high) = extent(part);
    let mut paths: Vec<PathData> = CLASSES.iter().map(|_| PathData::default()).collect();
    let mut cursor = Cursor::default();
    let columns = ((high.x - low.x) / cell).ceil() as i64;
    let rows = ((high.y - low.y) / cell).ceil() as i64;
    for row in 0..rows {
        let y = low.y + row as f64 * cell;
        let mut run: Option<(usize, i64)> = None;
        for column in 0..=columns {
            let at = Coord {
                x: low.x + (column as f64 + 0.5) * cell,
                y: y + cell / 2.0,
            };
            let class = class_at(field, at, &mut cursor).filter(|_| column < columns);
            if run.map(|(c, _)| c) == class {
                continue;
            }
            if let Some((c, from)) = run {
                let x = [from, column].map(|k| low.x + k as f64 * cell);
                let ring = [
                    Coord { x: x[0], y },
                    Coord { x: x[1], y },
                    Coord {
                        x: x[1],
                        y: y + cell,
                    },
                    Coord {
                        x: x[0],
                        y: y + cell,
                    },
                ];
                paths[c].line(ring.map(|p| to.place(p)), true);
            }
            run = class.map(|c| (c, column));
        }
    }
    for (path, (_, colour)) in paths.iter().zip(CLASSES) {
        canvas.path(&path.0, &format!("fill=\"{colour}\""));
    }
}

/// Index into `CLASSES` at a point; `None` outside and where lines are parallel.
fn class_at(field: &Field, at: Coord<f64>, cursor: &mut Cursor) -> Option<usize> {
    let triangle = field.domain().locate(at, cursor)?;
    let mean = field.turning_in(triangle).map_or(f64::INFINITY, |turning| {
        let [a, b] = turning.divergence();
        (a.abs() + b.abs()) / 2.0
    });
    CLASSES.iter().rposition(|&(from, _)| mean >= from)
}

fn streamlines(canvas: &mut Canvas, part: &Polygon<f64>, field: &Field, gap: f64, to: &Transform) {
    let (low, high) = extent(part);
    let mut seeds = Vec::new();
    let mut cursor = Cursor::default();
    let steps = |length: f64| (2.0 * length / gap).ceil() as i64;
    for row in 0..steps(high.y - low.y) {
        for column in 0..steps(high.x - low.x) {
            let at = Coord {
                x: low.x + (column as f64 + 0.5) * gap / 2.0,
                y: low.y + (row as f64 + 0.5) * gap / 2.0,
            };
            if let Some(cross) = field.cross(at, &mut cursor) {
                let [first, second, ..] = cross.arms();
                seeds.push(Seed {
                    at,
                    directions: [first, second],
                });
            }
        }
    }
    // Lines that end at a singularity show it; all lengths follow the gap.
    let options = CandidateOptions {
        separation: gap,
        trace: TraceOptions::scaled(gap / 9.0),
        keep_singular: true,
        keep_closed: true,
        ..CandidateOptions::default()
    };
    // Options that follow from a finite gap are in their ranges, and a picture
    // without lines still shows all else.
    let lines = candidates(&Arms(field), &seeds, &options).unwrap_or_default();
    let mut path = PathData::default();
    for line in lines {
        let line = line.simplify(gap / 60.0).to_line_string();
        path.line(line.0.iter().map(|&c| to.place(c)), false);
    }
    canvas.path(
        &path.0,
        "fill=\"none\" stroke=\"#495057\" stroke-width=\"18\"",
    );
}
