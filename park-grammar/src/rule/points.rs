//! Places and lines as the value of an operation: `ScatterCircles(5 {[5, 10]})`,
//! `Corners(Region)`, `Along(OUTER, 5)`, `Parametrise([0, 1], [0, 0.5])`.
//!
//! With a block the ones that give places are operations: the block is done at
//! each of the places.

use std::f64::consts::FRAC_PI_2;

use geo_types::Coord;

use super::{circles, mode, operator_named, Arguments, Deed};
use crate::derive::{Node, Places, Run, Scope, Spot, Value};
use crate::error::Failure;
use crate::plane::{middle, pole, right, unit};
use crate::select::{parametrise, range, Lines, Selection};
use crate::shape::Region;
use crate::syntax::ast::{Body, Expr, ExprKind, Operation, Span};

/// The value of a rule, if all that it does is to give places.
pub(crate) fn of_rule(
    scope: &mut Scope<'_>,
    name: &str,
    span: Span,
) -> Result<Option<Value>, Failure> {
    let grammar = scope.grammar;
    let Some(rule) = grammar.rule(name) else {
        return Ok(None);
    };
    match rule.body.operations.as_slice() {
        [only] if gives_points(only) => of_operation(scope, only, span).map(Some),
        _ => Ok(None),
    }
}

/// The value of the body of a function.
pub(crate) fn of_body(scope: &mut Scope<'_>, body: &Body, span: Span) -> Result<Value, Failure> {
    match body.operations.as_slice() {
        [only] if gives_points(only) => of_operation(scope, only, span),
        _ => Err(Failure::fault(
            span,
            "this function has operations and no value",
        )),
    }
}

pub(crate) fn gives_points(operation: &Operation) -> bool {
    operator_named(&operation.name.text).is_some_and(|o| matches!(o.deed, Deed::Points))
}

/// The same places with so much room.
pub(crate) fn with_room(spots: Vec<Spot>, radius: f64) -> Vec<Spot> {
    spots
        .into_iter()
        .map(|spot| Spot { radius, ..spot })
        .collect()
}

pub(crate) fn of_operation(
    scope: &mut Scope<'_>,
    operation: &Operation,
    span: Span,
) -> Result<Value, Failure> {
    Ok(match operation.name.text.as_str() {
        "Corners" => Value::Spots(corners(scope, operation)?),
        "Along" => Value::Spots(along(scope, operation)?),
        "ScatterCircles" => Value::Spots(circles::circles(scope, operation)?),
        "Parametrise" => ranges(scope, operation)?,
        other => return Err(Failure::fault(span, format!("{other} gives no places"))),
    })
}

/// The block of an operation that gives places, done at each of them.
pub(crate) fn act(
    run: &mut Run<'_>,
    node: &mut Node,
    operation: &Operation,
    places: &Places,
) -> Result<(), Failure> {
    let name = operation.name.text.as_str();
    if operation.blocks.is_empty() || name == "Parametrise" {
        let error = format!("{name} gives places and does nothing");
        return Err(Failure::fault(operation.span, error)
            .hint("use it as the argument of another operation"));
    }
    if name == "ScatterCircles" {
        return circles::act(run, node, operation, places);
    }
    let value = of_operation(&mut run.scope(node, places), operation, operation.span)?;
    let found = spots(&node.region, value, operation.span)?;
    run.at_spots(node, operation, places, &found)
}

/// The places that a value stands for.
pub(crate) fn spots(region: &Region, value: Value, span: Span) -> Result<Vec<Spot>, Failure> {
    let spot = |at| Spot::new(at, 0.0);
    Ok(match value {
        Value::Word(word) if word == "CENTRE" => vec![spot(middle(&region.area))],
        // Where there is the most room, which `room` tells.
        Value::Word(word) if word == "POLE" => vec![spot(pole(&region.area))],
        // Nothing is drawn where a cell has no such coordinates.
        Value::Point(at) => region.local.point(at).into_iter().map(spot).collect(),
        Value::Spots(spots) => spots,
        Value::Selection(selection) => share_of(region, &selection, 0.5).into_iter().collect(),
        Value::List(items) => {
            let mut all = Vec::new();
            for item in items {
                all.extend(spots(region, item, span)?);
            }
            all
        }
        other => return Err(other.wrong(span, "a place")),
    })
}

/// The place at a share of a selection, facing into the land.
pub(crate) fn share_of(region: &Region, selection: &Selection, share: f64) -> Option<Spot> {
    let lines = Lines::new(selection, region);
    let stop = lines.at(region, share * lines.length())?;
    Some(Spot {
        at: stop.at,
        radius: 0.0,
        facing: stop.inward.y.atan2(stop.inward.x),
    })
}

/// A corner, facing into the land half way between its sides.
pub(crate) fn corner_spot(region: &Region, at: Coord<f64>) -> Spot {
    let mut inward = Coord::default();
    for (a, b, _) in region.edges(0) {
        if a == at || b == at {
            inward = inward + right(unit(b - a));
        }
    }
    Spot {
        at,
        radius: 0.0,
        facing: inward.y.atan2(inward.x),
    }
}

/// `Corners(Region)`, `Corners(OUTER)`: the corners of the region in the order of
/// its sides, or those where a selection begins, ends or goes through.
fn corners(scope: &mut Scope<'_>, operation: &Operation) -> Result<Vec<Spot>, Failure> {
    let mut arguments = Arguments::new(operation);
    let of = match arguments.next() {
        Some(argument) => match scope.value(&argument.value)? {
            // The name of a rule stands for the region at hand.
            Value::Word(_) => None,
            Value::Selection(selection) => Some(selection),
            other => return Err(other.wrong(argument.value.span, "a selection")),
        },
        None => None,
    };
    arguments.done()?;
    let region = scope.region;
    let corners = (0..region.sides).filter_map(|k| region.corner(k));
    let mut found: Vec<Coord<f64>> = corners.collect();
    // A side without edges begins where the next one does.
    found.dedup();
    if let Some(selection) = of {
        let ends: Vec<Coord<f64>> = selection.lines(region).concat();
        found.retain(|at| ends.contains(at));
    }
    Ok(found
        .into_iter()
        .map(|at| corner_spot(region, at))
        .collect())
}

/// `Along(OUTER, 5)`: so many places along a selection, the ends among them;
/// `Along(OUTER, at = 0.25)`: the place at a share or a length. `offset` draws
/// them in.
fn along(scope: &mut Scope<'_>, operation: &Operation) -> Result<Vec<Spot>, Failure> {
    let mut arguments = Arguments::new(operation);
    let selection = scope.selection(&arguments.need("a selection")?.value)?;
    let count = match arguments.next() {
        Some(argument) => Some(scope.count(&argument.value)?),
        None => None,
    };
    let lines = Lines::new(&selection, scope.region);
    let whole = lines.length();
    let at = match arguments.named("at") {
        Some(expr) => Some(share(scope, expr, whole)?),
        None => None,
    };
    let offset = arguments.metres(scope, "offset")?.unwrap_or(0.0);
    arguments.done()?;
    let closed = lines.0.len() == 1 && lines.0[0].closed();
    let shares: Vec<f64> = match (count, at) {
        (None, at) => vec![at.unwrap_or(0.5)],
        (Some(1), _) => vec![0.5],
        (Some(n), _) => {
            let parts = if closed { n } else { n.saturating_sub(1) };
            (0..n).map(|k| k as f64 / parts as f64).collect()
        }
    };
    let places = shares
        .into_iter()
        .filter_map(|share| share_of(scope.region, &selection, share));
    Ok(places
        .map(|spot| Spot {
            at: spot.at + direction(spot.facing) * offset,
            ..spot
        })
        .collect())
}

/// A share of something so long, as it is written.
pub(crate) fn share(scope: &mut Scope<'_>, expr: &Expr, whole: f64) -> Result<f64, Failure> {
    let number = scope.number(expr)?;
    let wrong = || Failure::fault(expr.span, "a share or a length was expected");
    let share = number.share(whole).filter(|s| s.is_finite());
    share.ok_or_else(wrong)
}

pub(crate) fn direction(facing: f64) -> Coord<f64> {
    Coord {
        x: facing.cos(),
        y: facing.sin(),
    }
}

/// `Parametrise([0.02, 1], [0, 1], [], 0) { Contract(1, area) }`: see
/// [`parametrise`].
fn ranges(scope: &mut Scope<'_>, operation: &Operation) -> Result<Value, Failure> {
    let mut arguments = Arguments::new(operation);
    let (mut ranges, mut first, mut of) = (Vec::new(), 0, None);
    while let Some(argument) = arguments.next() {
        collect(scope, &argument.value, &mut ranges, &mut first, &mut of)?;
    }
    let mut inset = arguments.metres(scope, "inset")?.unwrap_or(0.0);
    arguments.done()?;
    let contents = operation.blocks.iter().flat_map(|b| &b.branches);
    for inner in contents.flat_map(|branch| &branch.body.operations) {
        if inner.name.text != "Contract" {
            let failure = Failure::fault(inner.span, "here only Contract has a meaning");
            return Err(failure.hint("write Contract(1) to draw the lines in by 1 m"));
        }
        let mut arguments = Arguments::new(inner);
        inset += scope.metres(&arguments.need("a length")?.value)?;
        if let Some(argument) = arguments.next() {
            of = Some(scope.selection(&argument.value)?);
        }
        arguments.done()?;
    }
    let of = of.unwrap_or_else(|| Selection::all(scope.region));
    let wrong = || Failure::fault(operation.span, "ranges are of shares or of lengths");
    let found = parametrise(scope.region, &of, &ranges, first).ok_or_else(wrong)?;
    Ok(if inset > 0.0 {
        Value::Inset(found, inset)
    } else {
        Value::Selection(found)
    })
}

/// Sorts one argument of `Parametrise`. The notes leave out commas between
/// ranges, which then read as entries of the first.
fn collect(
    scope: &mut Scope<'_>,
    expr: &Expr,
    ranges: &mut Vec<Option<[crate::derive::Number; 2]>>,
    first: &mut i64,
    of: &mut Option<Selection>,
) -> Result<(), Failure> {
    if let ExprKind::Index(base, items) = &expr.kind {
        if matches!(base.kind, ExprKind::List(_) | ExprKind::Index(..)) {
            collect(scope, base, ranges, first, of)?;
            let entry = Expr {
                kind: ExprKind::List(items.clone()),
                span: expr.span,
            };
            return collect(scope, &entry, ranges, first, of);
        }
    }
    match scope.value(expr)? {
        Value::Number(_) => *first = scope.whole(expr)?,
        Value::Selection(selection) => *of = Some(selection),
        value => match range(&value) {
            Some(range) => ranges.push(range),
            None => return Err(value.wrong(expr.span, "a range, such as [0, 0.5] or []")),
        },
    }
    Ok(())
}

/// What the words of `facing =` mean.
const FACING: [(&str, Facing); 5] = [
    ("in", Facing::Own),
    ("out", Facing::Out),
    ("along", Facing::Along),
    ("centre", Facing::Centre),
    ("random", Facing::Random),
];

/// Which way things face: `facing = in`, `out`, `along`, `centre`, `random` or an
/// angle from the region's own east.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Facing {
    /// As the place has it: into the land at the boundary, else the region's own
    /// east.
    Own,
    Out,
    Along,
    Centre,
    Random,
    Angle(f64),
}

impl Facing {
    pub(crate) fn read(
        arguments: &mut Arguments<'_>,
        scope: &mut Scope<'_>,
    ) -> Result<Self, Failure> {
        let Some(expr) = arguments.named("facing") else {
            return Ok(Self::Own);
        };
        if scope.word(expr).is_some() {
            return mode(scope, expr, "facing", &FACING);
        }
        let number = scope.number(expr)?;
        let wrong = || Failure::fault(expr.span, "a direction was expected");
        let angle = number.radians().ok_or_else(wrong)?;
        let towards = crate::select::Frame::of(scope.region).direction(angle);
        Ok(Self::Angle(towards.y.atan2(towards.x)))
    }

    pub(crate) fn turn(self, node: &mut Node, spot: Spot) -> Spot {
        let facing = match self {
            Self::Own => spot.facing,
            Self::Out => spot.facing + 2.0 * FRAC_PI_2,
            // Clockwise along the boundary, in mirror images counter-clockwise.
            Self::Along if node.region.local.mirrored() => spot.facing - FRAC_PI_2,
            Self::Along => spot.facing + FRAC_PI_2,
            Self::Centre => {
                let to = middle(&node.region.area) - spot.at;
                to.y.atan2(to.x)
            }
            Self::Random => node.chance.between([0.0, std::f64::consts::TAU]),
            Self::Angle(angle) => angle,
        };
        Spot { facing, ..spot }
    }
}
