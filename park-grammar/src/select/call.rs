//! Selectors with values: what their arguments are.

use geo_types::Coord;

use super::cardinal::{Cardinal, Ties, Way};
use super::frame::Frame;
use super::{angle, continuous, grow, history, near, part, sector, Selection};
use crate::derive::{Number, Scope, Spot, Value};
use crate::error::Failure;
use crate::rule::{contract, points, Arguments};
use crate::syntax::ast::{Argument, Block, Expr, ExprKind, Name, Operation, Span, Unit};

/// Selectors that take values, for hints.
pub(crate) const CALLS: [&str; 10] = [
    "Angle",
    "Sector",
    "Grow",
    "Continuous",
    "Cardinal",
    "History",
    "Nearest",
    "Part",
    "Length",
    "Contract",
];

/// A selector with values, such as `Part(OUTER, [0, 0.5])`, or an operation that
/// gives places.
pub(crate) fn call(
    scope: &mut Scope<'_>,
    name: &Name,
    arguments: &[Argument],
    blocks: &[Block],
) -> Result<Value, Failure> {
    let operation = Operation {
        comments: Vec::new(),
        name: name.clone(),
        arguments: Some(arguments.to_vec()),
        blocks: blocks.to_vec(),
        otherwise: None,
        span: name.span,
    };
    if points::gives_points(&operation) {
        return points::of_operation(scope, &operation, name.span);
    }
    if name.text == "Contract" {
        return contract::lines(scope, &operation);
    }
    let mut arguments = Arguments::new(&operation);
    let selection = match name.text.as_str() {
        "Angle" => by_angle(scope, &mut arguments)?,
        "Sector" => by_sector(scope, &mut arguments)?,
        "Grow" => return growing(scope, arguments),
        "Continuous" => continuity(scope, &mut arguments)?,
        "Cardinal" => cardinal(scope, &mut arguments)?,
        "History" => by_history(scope, &mut arguments)?,
        "Nearest" => nearest(scope, &mut arguments)?,
        "Part" => parts(scope, &mut arguments)?,
        "Length" => {
            let selection = scope.selection(&arguments.need("a selection")?.value)?;
            arguments.done()?;
            return Ok(Value::Number(Number {
                value: selection.length(),
                unit: Unit::Metres,
            }));
        }
        other => {
            return Err(Failure::fault(name.span, format!("{other} has no value")));
        }
    };
    arguments.done()?;
    Ok(Value::Selection(selection))
}

/// What has entries: `CORNER[0]`.
pub(crate) fn index(
    scope: &mut Scope<'_>,
    of: Value,
    items: &[Expr],
    span: Span,
) -> Result<Value, Failure> {
    if matches!(&of, Value::Word(word) if word == "CORNER") {
        let numbers = scope.wholes(items)?;
        return Ok(Value::Spots(corners(scope, &numbers)));
    }
    Err(of.wrong(span, "something that has entries"))
}

/// The corners of these numbers, each facing into the land; negative ones count
/// from the last.
fn corners(scope: &Scope<'_>, numbers: &[i64]) -> Vec<Spot> {
    let region = scope.region;
    let count = i64::try_from(region.sides).unwrap_or(i64::MAX).max(1);
    let index = |k: &i64| usize::try_from(k.rem_euclid(count)).ok();
    let found = numbers
        .iter()
        .filter_map(index)
        .filter_map(|k| region.corner(k));
    found.map(|at| points::corner_spot(region, at)).collect()
}

fn by_angle(scope: &mut Scope<'_>, arguments: &mut Arguments<'_>) -> Result<Selection, Failure> {
    let range = angles(scope, &arguments.need("a range of angles")?.value)?;
    let line = arguments.flag(scope, "Line")?;
    let frame = frame(scope, arguments)?;
    Ok(if line {
        angle::lying(scope.region, frame, range)
    } else {
        angle::facing(scope.region, frame, range)
    })
}

fn by_sector(scope: &mut Scope<'_>, arguments: &mut Arguments<'_>) -> Result<Selection, Failure> {
    let range = angles(scope, &arguments.need("a range of angles")?.value)?;
    let frame = frame(scope, arguments)?;
    let centre = match arguments.named("centre") {
        Some(expr) => points_of(scope, expr)?.first().copied(),
        None => None,
    };
    let centre = centre.unwrap_or_else(|| scope.region.area.centroid());
    Ok(sector::between(scope.region, frame, centre, range))
}

fn growing(scope: &mut Scope<'_>, mut arguments: Arguments<'_>) -> Result<Value, Failure> {
    let expr = &arguments.need("a direction, or several in brackets")?.value;
    let (several, directions) = match &expr.kind {
        ExprKind::List(items) => {
            let angles: Result<Vec<f64>, Failure> =
                items.iter().map(|item| direction(scope, item)).collect();
            (true, angles?)
        }
        _ => (false, vec![direction(scope, expr)?]),
    };
    let leave = arguments.flag(scope, "Leave")?;
    let grow_on = arguments.flag(scope, "Rest")?;
    let frame = frame(scope, &mut arguments)?;
    let threshold = match arguments.next() {
        Some(argument) => {
            let number = scope.number(&argument.value)?;
            let wrong = || Failure::fault(argument.value.span, "an angle was expected");
            number.radians().ok_or_else(wrong)?
        }
        None => std::f64::consts::FRAC_PI_4,
    };
    arguments.done()?;
    let rest = if leave || !(several || grow_on) {
        grow::Rest::Leave
    } else {
        grow::Rest::Grow
    };
    let groups = grow::grow(scope.region, frame, &directions, threshold, rest);
    let mut groups = groups.into_iter().map(Value::Selection);
    if several {
        return Ok(Value::List(groups.collect()));
    }
    let none = || Failure::fault(expr.span, "there is no direction");
    groups.next().ok_or_else(none)
}

fn continuity(scope: &mut Scope<'_>, arguments: &mut Arguments<'_>) -> Result<Selection, Failure> {
    let expr = &arguments.need("a direction or a selection")?.value;
    let frame = frame(scope, arguments)?;
    if let ExprKind::Name(name) = &expr.kind {
        if let Some(cardinal) = Cardinal::named(name) {
            return Ok(continuous::towards(scope.region, frame, cardinal));
        }
    }
    let base = scope.selection(expr)?;
    Ok(continuous::of(scope.region, &base))
}

fn cardinal(scope: &mut Scope<'_>, arguments: &mut Arguments<'_>) -> Result<Selection, Failure> {
    let expr = &arguments.need("a direction, such as WEST")?.value;
    let cardinal = match &expr.kind {
        ExprKind::Name(name) => Cardinal::named(name),
        _ => None,
    };
    let Some(cardinal) = cardinal else {
        let failure = Failure::fault(expr.span, "a direction of the compass was expected");
        return Err(failure.hint("write WEST, NORTH, EAST or SOUTH"));
    };
    let frame = frame(scope, arguments)?;
    let northern = arguments.flag(scope, "Northern")?;
    let split = arguments.flag(scope, "Split")?;
    let ways = [
        ("Corners", Way::Corners),
        ("Angle", Way::Angle),
        ("Sector", Way::Sector),
        ("Grow", Way::Grow),
    ];
    let mut way = Way::Corners;
    for (word, named) in ways {
        if arguments.flag(scope, word)? {
            way = named;
        }
    }
    if arguments.flag(scope, "Dominant")? || northern || split {
        way = Way::Dominant(match (northern, split) {
            (_, true) => Ties::Split,
            (true, false) => Ties::Northern,
            (false, false) => Ties::Western,
        });
    }
    Ok(cardinal.select(scope.region, frame, way))
}

fn by_history(scope: &mut Scope<'_>, arguments: &mut Arguments<'_>) -> Result<Selection, Failure> {
    let expr = &arguments
        .need("the name of a rule, such as \"Peel\"")?
        .value;
    let rule = match scope.value(expr)? {
        Value::Text(text) | Value::Word(text) => text,
        other => return Err(other.wrong(expr.span, "the name of a rule")),
    };
    let mut wanted = history::roles("ANY").unwrap_or(&[]);
    let mut level = None;
    while let Some(argument) = arguments.next() {
        let expr = &argument.value;
        // Some roles are the names of selectors too.
        let role = match &expr.kind {
            ExprKind::Name(name) => history::roles(name),
            _ => None,
        };
        match role {
            Some(roles) => wanted = roles,
            None => level = Some(scope.whole(expr)?),
        }
    }
    Ok(history::history(scope.region, &rule, wanted, level))
}

fn nearest(scope: &mut Scope<'_>, arguments: &mut Arguments<'_>) -> Result<Selection, Failure> {
    let expr = &arguments.need("a point or a selection")?.value;
    let count = match arguments.next() {
        Some(argument) => scope.count(&argument.value)?,
        None => 1,
    };
    if let Value::Selection(selection) = scope.value(expr)? {
        return Ok(near::to_selection(scope.region, &selection, count));
    }
    let points = points_of(scope, expr)?;
    Ok(near::to_points(scope.region, &points, count))
}

fn parts(scope: &mut Scope<'_>, arguments: &mut Arguments<'_>) -> Result<Selection, Failure> {
    let selection = scope.selection(&arguments.need("a selection")?.value)?;
    let mut all = Selection::default();
    let mut next = Some(arguments.need("a range, such as [0, 0.5]")?);
    while let Some(argument) = next {
        let expr = &argument.value;
        let wrong = || Failure::fault(expr.span, "a range of shares or lengths was expected");
        let value = scope.value(expr)?;
        if let Some(range) = range(&value).ok_or_else(wrong)? {
            let found = part::part(scope.region, &selection, range).ok_or_else(wrong)?;
            all = all.or(&found);
        }
        next = arguments.next();
    }
    Ok(all)
}

/// A range of parameters: `[]` is none of it. `None` for what is no range.
pub(crate) fn range(value: &Value) -> Option<Option<[Number; 2]>> {
    match value {
        Value::List(items) => match items.as_slice() {
            [] => Some(None),
            [Value::Number(from), Value::Number(to)] => Some(Some([*from, *to])),
            _ => None,
        },
        _ => None,
    }
}

/// The axes: the region's own, or with `Compass` those.
fn frame(scope: &mut Scope<'_>, arguments: &mut Arguments<'_>) -> Result<Frame, Failure> {
    let compass = arguments.flag(scope, "Compass")?;
    Ok(if compass {
        Frame::COMPASS
    } else {
        Frame::of(scope.region)
    })
}

/// `WEST` or an angle, radians from east.
fn direction(scope: &mut Scope<'_>, expr: &Expr) -> Result<f64, Failure> {
    if let ExprKind::Name(name) = &expr.kind {
        if let Some(cardinal) = Cardinal::named(name) {
            return Ok(cardinal.angle());
        }
    }
    let number = scope.number(expr)?;
    let wrong = || Failure::fault(expr.span, "a direction or an angle was expected");
    number.radians().ok_or_else(wrong)
}

/// A range of angles, radians, from the first on to the second, less than a turn
/// unless it is written so.
fn angles(scope: &mut Scope<'_>, expr: &Expr) -> Result<[f64; 2], Failure> {
    let wrong = || Failure::fault(expr.span, "a range of angles was expected");
    let value = scope.value(expr)?;
    let [low, high] = range(&value).flatten().ok_or_else(wrong)?;
    let (low, high) = low.radians().zip(high.radians()).ok_or_else(wrong)?;
    let turn = std::f64::consts::TAU;
    Ok(if high < low {
        [low, low + (high - low).rem_euclid(turn)]
    } else {
        [low, high]
    })
}

/// Points of the plane that an expression stands for.
fn points_of(scope: &mut Scope<'_>, expr: &Expr) -> Result<Vec<Coord<f64>>, Failure> {
    let value = scope.value(expr)?;
    let spots = points::spots(scope.region, value, expr.span)?;
    Ok(spots.into_iter().map(|spot| spot.at).collect())
}
