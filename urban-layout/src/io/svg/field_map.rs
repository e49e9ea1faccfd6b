//! What pictures of fields are made of: divergence, streamlines, crosses,
//! singularities and the outline, on a sheet of any scale.

use crossfield::{Cross, Cursor, Field, Singularity};
use geo_types::{Coord, Polygon};
use streamline::{candidates, CandidateOptions, Seed, TraceOptions};

use super::canvas::{Canvas, PathData, Transform};
use super::picture::singularities;
use crate::adapt::Arms;
use crate::plane::extent;

/// Mean |div| from which a colour holds, 1 / metre: streamlines 20 m apart
/// come a tenth nearer or farther within 200, 100, 50, 25 and 10 m.
const CLASSES: [(f64, &str); 5] = [
    (0.0005, "#fff3d6"),
    (0.001, "#ffe3ae"),
    (0.002, "#ffcb80"),
    (0.004, "#ffa94d"),
    (0.01, "#f76707"),
];

/// The fields of the parts of a site, and where they go on the sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct FieldMap<'a> {
    pub(super) parts: &'a [Polygon<f64>],
    /// One for each part.
    pub(super) fields: &'a [Field],
    /// The longer side of the whole site, metres.
    pub(super) size: f64,
    pub(super) to: Transform,
}

impl<'a> FieldMap<'a> {
    fn pairs(&self) -> impl Iterator<Item = (&'a Polygon<f64>, &'a Field)> {
        self.parts.iter().zip(self.fields)
    }

    /// Path data of the outline.
    pub(super) fn outline(&self) -> PathData {
        let mut outline = PathData::default();
        for part in self.parts {
            outline.polygon(part, &self.to);
        }
        outline
    }

    /// The mean absolute divergence of both arms, in `cells` along the longer
    /// side, clipped to the outline; `name` is that of the clip.
    pub(super) fn divergence(&self, canvas: &mut Canvas, cells: f64, name: &str) {
        canvas.raw(&format!(
            "<clipPath id=\"{name}\"><path clip-rule=\"evenodd\" d=\"{}\"/></clipPath>\n<g clip-path=\"url(#{name})\">\n",
            self.outline().0
        ));
        for (part, field) in self.pairs() {
            shade(canvas, part, field, self.size / cells, &self.to);
        }
        canvas.raw("</g>\n");
    }

    /// Streamlines of both families, `count` side by side along the longer
    /// side.
    pub(super) fn streamlines(&self, canvas: &mut Canvas, count: f64, pen: f64) {
        let mut path = PathData::default();
        for (part, field) in self.pairs() {
            streamlines(&mut path, part, field, self.size / count, &self.to);
        }
        canvas.path(
            &path.0,
            &format!("fill=\"none\" stroke=\"#495057\" stroke-width=\"{pen}\""),
        );
    }

    /// Crosses on a lattice of `count` points along the longer side.
    pub(super) fn crosses(&self, canvas: &mut Canvas, count: f64, pen: f64) {
        let gap = self.size / count;
        let mut path = PathData::default();
        for (part, field) in self.pairs() {
            for (at, cross) in lattice(part, field, gap) {
                let arms = cross.arms();
                for (from, to) in [(arms[0], arms[2]), (arms[1], arms[3])] {
                    let end = |arm: Coord<f64>| {
                        self.to.place(Coord {
                            x: at.x + 0.42 * gap * arm.x,
                            y: at.y + 0.42 * gap * arm.y,
                        })
                    };
                    path.line([end(from), end(to)], false);
                }
            }
        }
        canvas.path(
            &path.0,
            &format!("fill=\"none\" stroke=\"#343a40\" stroke-width=\"{pen}\""),
        );
    }

    /// The singularities of all parts.
    pub(super) fn singularities(&self, canvas: &mut Canvas, radius: f64, growth: f64) {
        let all: Vec<Singularity> = self.fields.iter().flat_map(Field::singularities).collect();
        singularities(canvas, &self.to, &all, radius, growth);
    }
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

/// Lines of both families some `gap` apart.
fn streamlines(path: &mut PathData, part: &Polygon<f64>, field: &Field, gap: f64, to: &Transform) {
    let seeds: Vec<Seed> = lattice(part, field, gap / 2.0)
        .into_iter()
        .map(|(at, cross)| {
            let [first, second, ..] = cross.arms();
            Seed {
                at,
                directions: [first, second],
            }
        })
        .collect();
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
    for line in lines {
        let line = line.simplify(gap / 60.0).to_line_string();
        path.line(line.0.iter().map(|&c| to.place(c)), false);
    }
}

/// The crosses of a field at the points of a square lattice.
fn lattice(part: &Polygon<f64>, field: &Field, gap: f64) -> Vec<(Coord<f64>, Cross)> {
    let (low, high) = extent(part);
    let steps = |length: f64| (length / gap).ceil() as i64;
    let mut cursor = Cursor::default();
    let mut crosses = Vec::new();
    for row in 0..steps(high.y - low.y) {
        for column in 0..steps(high.x - low.x) {
            let at = Coord {
                x: low.x + (column as f64 + 0.5) * gap,
                y: low.y + (row as f64 + 0.5) * gap,
            };
            if let Some(cross) = field.cross(at, &mut cursor) {
                crosses.push((at, cross));
            }
        }
    }
    crosses
}
