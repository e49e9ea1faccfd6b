//! Where things are distributed and volumes drawn: a selection, a line through
//! places, or a whole region.

use geo_types::Coord;

use super::{points, Arguments};
use crate::derive::{Scope, Value};
use crate::error::Failure;
use crate::plane::{dist, inset_lines};
use crate::select::{Lines, Selection};
use crate::shape::Region;
use crate::syntax::ast::Argument;

/// What the first argument names.
#[derive(Clone, Debug)]
pub(crate) enum Target {
    /// A selection of the boundary, drawn in by a length.
    Boundary { selection: Selection, inset: f64 },
    /// A line.
    Line(Vec<Coord<f64>>),
    /// `AREA`: all of the region.
    Area,
}

impl Target {
    /// Reads a target and the offset after its colon or by name.
    pub(crate) fn read(
        arguments: &mut Arguments<'_>,
        scope: &mut Scope<'_>,
    ) -> Result<(Self, Option<f64>), Failure> {
        let Argument {
            value: expr, at, ..
        } = arguments.need("a selection, such as OUTER")?;
        let target = match scope.value(expr)? {
            Value::Selection(selection) => Self::Boundary {
                selection,
                inset: 0.0,
            },
            Value::Inset(selection, inset) => Self::Boundary { selection, inset },
            Value::Word(word) if word == "AREA" => Self::Area,
            Value::List(items) if items.iter().all(|i| matches!(i, Value::Selection(_))) => {
                Self::Boundary {
                    selection: scope.selection(expr)?,
                    inset: 0.0,
                }
            }
            value => {
                let spots = points::spots(scope.region, value, expr.span)?;
                if spots.len() < 2 {
                    return Err(Failure::fault(
                        expr.span,
                        "a line goes through two places or more",
                    ));
                }
                Self::Line(spots.into_iter().map(|spot| spot.at).collect())
            }
        };
        let offset = match at {
            Some(at) => Some(scope.metres(at)?),
            None => None,
        };
        let named = arguments.metres(scope, "offset")?;
        let offset = offset.or(named);
        if offset.is_some_and(|o| o < 0.0) {
            return Err(Failure::fault(expr.span, "an offset leads into the region"));
        }
        Ok((target, offset))
    }
}

/// The lines so far inside of a selection, in the order and sense in which it is
/// walked; each begins, if it is closed, nearest to where the walk does.
pub(crate) fn lines_at(
    region: &Region,
    selection: &Selection,
    offset: f64,
) -> Vec<Vec<Coord<f64>>> {
    let walk = Lines::new(selection, region);
    let start = walk
        .at(region, 0.0)
        .map_or_else(Coord::default, |stop| stop.at);
    let back = region.local.mirrored();
    let mut lines: Vec<(f64, Vec<Coord<f64>>)> =
        inset_lines(&region.area, &selection.lines(region), offset)
            .into_iter()
            .map(|mut line| {
                if back {
                    line.reverse();
                }
                if is_closed(&line) {
                    begin_near(&mut line, start);
                }
                let first = line.first().copied().unwrap_or_default();
                (walk.nearest(region, first), line)
            })
            .collect();
    lines.sort_by(|a, b| a.0.total_cmp(&b.0));
    lines.into_iter().map(|(_, line)| line).collect()
}

pub(crate) fn is_closed(line: &[Coord<f64>]) -> bool {
    line.len() > 3 && line.first() == line.last()
}

/// Lets a closed line begin at its vertex nearest to a point.
fn begin_near(line: &mut Vec<Coord<f64>>, at: Coord<f64>) {
    line.pop();
    let nearest = (0..line.len()).min_by(|&a, &b| dist(line[a], at).total_cmp(&dist(line[b], at)));
    line.rotate_left(nearest.unwrap_or(0));
    line.extend(line.first().copied());
}
