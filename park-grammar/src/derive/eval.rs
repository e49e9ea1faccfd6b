//! Expressions, evaluated for a region.

use std::collections::BTreeMap;
use std::sync::Arc;

use geo_types::Coord;

use super::limits::{Limits, Watch};
use super::math;
use super::object::{declared, OBJECT};
use super::random::Stream;
use super::value::{Late, Number, SizeRange, Sizing, Value};
use crate::error::Failure;
use crate::grammar::Grammar;
use crate::plane::{dot, pole};
use crate::rule::points;
use crate::select::{named, Selection};
use crate::shape::Region;
use crate::syntax::ast::{
    Argument, BinaryOp, Block, Expr, ExprKind, Meaning, Name, Size, Span, UnaryOp, Unit,
};

/// Values of the places of a rule or function.
pub(crate) type Places = BTreeMap<String, Value>;

/// Deepest calls of functions within each other.
const DEEPEST: usize = 64;

/// No length is greater, metres.
const LONGEST: f64 = 1e7;

/// What an expression is evaluated for.
pub(crate) struct Scope<'s> {
    pub(crate) grammar: &'s Grammar,
    pub(crate) params: &'s BTreeMap<String, Value>,
    pub(crate) places: &'s Places,
    pub(crate) region: &'s Region,
    pub(crate) chance: &'s mut Stream,
    pub(crate) depth: usize,
    pub(crate) limits: &'s Limits<'s>,
    /// The rule that the region follows.
    pub(crate) rule: &'s Arc<str>,
}

type Found = Result<Value, Failure>;

impl<'s> Scope<'s> {
    /// What a long operation looks at on its way.
    pub(crate) fn watch(&self) -> Watch<'s> {
        Watch::new(self.limits, self.rule)
    }

    pub(crate) fn value(&mut self, expr: &Expr) -> Found {
        let span = expr.span;
        self.limits.value(self.rule)?;
        Ok(match &expr.kind {
            ExprKind::Number(value, unit) => Value::Number(Number {
                value: *value,
                unit: *unit,
            }),
            ExprKind::Text(text) => Value::Text(text.clone()),
            ExprKind::Name(name) => return self.name(name, span),
            ExprKind::Call {
                name,
                arguments,
                blocks,
            } => return self.call(name, arguments, blocks),
            ExprKind::List(items) => {
                let items: Result<Vec<Value>, Failure> =
                    items.iter().map(|item| self.value(item)).collect();
                Value::List(items?)
            }
            ExprKind::Point(parts) => {
                let [x, y] = [&parts[0], &parts[1]].map(|part| self.number(part));
                Value::Point(Coord {
                    x: x?.value,
                    y: y?.value,
                })
            }
            ExprKind::Index(base, items) => return self.index(base, items, span),
            ExprKind::Span(ends) => Value::Span([self.whole(&ends[0])?, self.whole(&ends[1])?]),
            ExprKind::Sizes { count, sizes } => {
                let count = match count {
                    Some(count) => Some(self.count(count)?),
                    None => None,
                };
                let sizes: Result<Vec<SizeRange>, Failure> =
                    sizes.iter().map(|size| self.size(size)).collect();
                Value::Sizing(Sizing {
                    count,
                    sizes: sizes?,
                })
            }
            ExprKind::Unary(op, inner) => return self.unary(*op, inner),
            ExprKind::Binary(op, sides) => return self.binary(*op, sides, span),
        })
    }

    fn name(&mut self, name: &str, span: Span) -> Found {
        if let Some(value) = self.places.get(name).or_else(|| self.params.get(name)) {
            return match value.clone() {
                Value::Late(late) => {
                    self.within(span, &late.places, |scope| scope.value(&late.expr))
                }
                value => Ok(value),
            };
        }
        if let Some(selection) = named::named(self.region, name) {
            return Ok(Value::Selection(selection));
        }
        if let Some(value) = attribute(self.region, name) {
            return Ok(value);
        }
        // A rule that gives places, such as CentrePoint -> ScatterCircles(1 {15}).
        if let Some(value) = points::of_rule(self, name, span)? {
            return Ok(value);
        }
        Ok(Value::Word(name.to_owned()))
    }

    /// The word that an expression is, if it is one; nothing is evaluated, so
    /// that flags may be looked for among values that are drawn by chance.
    pub(crate) fn word<'e>(&'e self, expr: &'e Expr) -> Option<&'e str> {
        let ExprKind::Name(name) = &expr.kind else {
            return None;
        };
        match self.places.get(name).or_else(|| self.params.get(name)) {
            Some(Value::Word(word)) => Some(word),
            Some(_) => None,
            None => Some(name),
        }
    }

    fn call(&mut self, name: &Name, arguments: &[Argument], blocks: &[Block]) -> Found {
        if let Some(function) = self.grammar.function(&name.text) {
            let places = self.bind(name.span, &function.places, arguments)?;
            return self.within(name.span, &places, |inner| match &function.meaning {
                Meaning::Value(value) => inner.value(value),
                Meaning::Body(body) => points::of_body(inner, body, name.span),
            });
        }
        if name.text == OBJECT {
            return declared(self, name, arguments);
        }
        if let Some(value) = math::call(self, name, arguments)? {
            return Ok(value);
        }
        crate::select::call(self, name, arguments, blocks)
    }

    /// Evaluates among other values.
    fn within(
        &mut self,
        span: Span,
        places: &Places,
        inner: impl FnOnce(&mut Scope<'_>) -> Found,
    ) -> Found {
        if self.depth >= DEEPEST {
            return Err(Failure::fault(
                span,
                "functions call each other without end",
            ));
        }
        inner(&mut Scope {
            grammar: self.grammar,
            params: self.params,
            places,
            region: self.region,
            chance: self.chance,
            depth: self.depth + 1,
            limits: self.limits,
            rule: self.rule,
        })
    }

    /// The values of arguments for the places of a rule or function.
    pub(crate) fn bind(
        &mut self,
        span: Span,
        places: &[Name],
        arguments: &[Argument],
    ) -> Result<Places, Failure> {
        if places.len() != arguments.len() {
            let wanted = places.len();
            let error = format!("expected {wanted} values, found {}", arguments.len());
            return Err(Failure::fault(span, error));
        }
        let mut bound = Places::new();
        for (place, argument) in places.iter().zip(arguments) {
            let place = argument.name.as_ref().unwrap_or(place);
            let value = self.lasting(&argument.value)?;
            bound.insert(place.text.clone(), value);
        }
        if let Some(place) = places.iter().find(|p| !bound.contains_key(&p.text)) {
            let error = format!("the place {} has no value", place.text);
            return Err(Failure::fault(span, error));
        }
        Ok(bound)
    }

    /// A value that may be used on other regions: what belongs to this one is
    /// evaluated anew for each.
    pub(crate) fn lasting(&mut self, expr: &Expr) -> Found {
        let value = self.value(expr)?;
        if !value.is_local() {
            return Ok(value);
        }
        if let ExprKind::Name(name) = &expr.kind {
            let known = self.places.get(name).or_else(|| self.params.get(name));
            if let Some(late @ Value::Late(_)) = known {
                return Ok(late.clone());
            }
        }
        Ok(Value::Late(Arc::new(Late {
            expr: expr.clone(),
            places: self.places.clone(),
        })))
    }

    fn index(&mut self, base: &Expr, items: &[Expr], span: Span) -> Found {
        if matches!(&base.kind, ExprKind::Name(name) if name == "EDGE") {
            let numbers = self.wholes(items)?;
            return Ok(Value::Selection(named::sides(self.region, &numbers)));
        }
        match self.value(base)? {
            Value::Spots(spots) => match items {
                // CentrePoint [5]: places with room around them.
                [size] => {
                    let radius = self.metres(size)?;
                    Ok(Value::Spots(points::with_room(spots, radius)))
                }
                _ => Err(Failure::fault(span, "a place has one size")),
            },
            Value::Word(word) if word == "CENTRE" => {
                let centre = points::spots(self.region, Value::Word(word), span)?;
                match items {
                    [size] => Ok(Value::Spots(points::with_room(centre, self.metres(size)?))),
                    _ => Err(Failure::fault(span, "a place has one size")),
                }
            }
            Value::List(list) => {
                let numbers = self.wholes(items)?;
                let [k] = numbers[..] else {
                    return Err(Failure::fault(span, "an entry of a list has one number"));
                };
                let count = i64::try_from(list.len()).unwrap_or(i64::MAX);
                let entry = usize::try_from(if k < 0 { count + k } else { k }).ok();
                let entry = entry.and_then(|k| list.get(k).cloned());
                entry.ok_or_else(|| Failure::fault(span, format!("the list has {count} entries")))
            }
            other => crate::select::index(self, other, items, span),
        }
    }

    fn size(&mut self, size: &Size) -> Result<SizeRange, Failure> {
        let length = match &size.length {
            Some(expr) => Some(self.range(expr, "a length", Number::metres)?),
            None => None,
        };
        let angle = match &size.angle {
            Some(expr) => Some(self.range(expr, "an angle", Number::radians)?),
            None => None,
        };
        Ok(SizeRange { length, angle })
    }

    fn unary(&mut self, op: UnaryOp, inner: &Expr) -> Found {
        let value = self.value(inner)?;
        Ok(match (op, value) {
            (UnaryOp::Negate, Value::Number(n)) => Value::Number(Number {
                value: -n.value,
                ..n
            }),
            (UnaryOp::Not, Value::Bool(holds)) => Value::Bool(!holds),
            (UnaryOp::Not, Value::Selection(s)) => Value::Selection(s.not(self.region)),
            (UnaryOp::Negate, other) => return Err(other.wrong(inner.span, "a number")),
            (UnaryOp::Not, other) => {
                return Err(other.wrong(inner.span, "a condition or a selection"))
            }
        })
    }

    fn binary(&mut self, op: BinaryOp, sides: &[Expr; 2], span: Span) -> Found {
        let (a, b) = (self.value(&sides[0])?, self.value(&sides[1])?);
        if let (Value::Selection(a), Value::Selection(b)) = (&a, &b) {
            return match op {
                BinaryOp::Or => Ok(Value::Selection(a.or(b))),
                BinaryOp::And => Ok(Value::Selection(a.and(b))),
                BinaryOp::Minus => Ok(Value::Selection(a.minus(b))),
                _ => Err(Failure::fault(
                    span,
                    "selections are joined by and, or and minus",
                )),
            };
        }
        if let (Value::Bool(a), Value::Bool(b)) = (&a, &b) {
            return match op {
                BinaryOp::Or => Ok(Value::Bool(*a || *b)),
                BinaryOp::And => Ok(Value::Bool(*a && *b)),
                BinaryOp::Equal => Ok(Value::Bool(a == b)),
                BinaryOp::NotEqual => Ok(Value::Bool(a != b)),
                _ => Err(Failure::fault(span, "conditions are joined by and and or")),
            };
        }
        let same = match (&a, &b) {
            (Value::Word(a), Value::Word(b)) | (Value::Text(a), Value::Text(b)) => Some(a == b),
            _ => None,
        };
        if let Some(same) = same {
            return match op {
                BinaryOp::Equal => Ok(Value::Bool(same)),
                BinaryOp::NotEqual => Ok(Value::Bool(!same)),
                _ => Err(a.wrong(sides[0].span, "a number")),
            };
        }
        let a = self.drawn(a, sides[0].span)?;
        let b = self.drawn(b, sides[1].span)?;
        arithmetic(op, a, b, span)
    }

    /// A number; one of a range is drawn.
    pub(crate) fn number(&mut self, expr: &Expr) -> Result<Number, Failure> {
        let value = self.value(expr)?;
        self.drawn(value, expr.span)
    }

    fn drawn(&mut self, value: Value, span: Span) -> Result<Number, Failure> {
        match value {
            Value::Number(number) => Ok(number),
            Value::List(items) => match items.as_slice() {
                [Value::Number(low), Value::Number(high)] => Ok(Number {
                    value: self.chance.between([low.value, high.value]),
                    unit: if low.unit == Unit::None {
                        high.unit
                    } else {
                        low.unit
                    },
                }),
                [Value::Number(only)] => Ok(*only),
                _ => Err(Value::List(items).wrong(span, "a number or a range")),
            },
            other => Err(other.wrong(span, "a number")),
        }
    }

    /// The bounds of a number or range, in the unit that `to` gives.
    fn range(
        &mut self,
        expr: &Expr,
        what: &str,
        to: impl Fn(Number) -> Option<f64>,
    ) -> Result<[f64; 2], Failure> {
        let wrong = || Failure::fault(expr.span, format!("this is not {what}"));
        let bounds = match self.value(expr)? {
            Value::Number(number) => [number, number],
            Value::List(items) => match items.as_slice() {
                [Value::Number(low), Value::Number(high)] => [*low, *high],
                [Value::Number(only)] => [*only, *only],
                _ => return Err(wrong()),
            },
            other => return Err(other.wrong(expr.span, what)),
        };
        let [low, high] = bounds.map(&to);
        let (low, high) = (low.ok_or_else(wrong)?, high.ok_or_else(wrong)?);
        if low.abs().max(high.abs()) > LONGEST {
            return Err(Failure::fault(expr.span, "this is more than 10,000,000"));
        }
        Ok([low.min(high), low.max(high)])
    }

    pub(crate) fn metres(&mut self, expr: &Expr) -> Result<f64, Failure> {
        let number = self.number(expr)?;
        let wrong = || Failure::fault(expr.span, "a length was expected");
        let metres = number.metres().ok_or_else(wrong)?;
        if metres.abs() > LONGEST {
            return Err(Failure::fault(expr.span, "this is longer than 10,000 km"));
        }
        Ok(metres)
    }

    pub(crate) fn whole(&mut self, expr: &Expr) -> Result<i64, Failure> {
        let number = self.number(expr)?;
        let rounded = number.value.round();
        let fits = number.unit == Unit::None && rounded.abs() < 1e9;
        // What was drawn from a range is rounded; what is written must be whole.
        if fits && (rounded == number.value || matches!(expr.kind, ExprKind::List(_))) {
            return Ok(rounded as i64);
        }
        Err(Failure::fault(expr.span, "a whole number was expected"))
    }

    pub(crate) fn count(&mut self, expr: &Expr) -> Result<usize, Failure> {
        let whole = self.whole(expr)?;
        usize::try_from(whole)
            .ok()
            .filter(|&n| n <= 100_000)
            .ok_or_else(|| Failure::fault(expr.span, "a number from 0 to 100,000 was expected"))
    }

    /// Whole numbers, with those that spans stand for.
    pub(crate) fn wholes(&mut self, items: &[Expr]) -> Result<Vec<i64>, Failure> {
        let mut numbers = Vec::new();
        for item in items {
            if let ExprKind::Span(ends) = &item.kind {
                let [low, high] = [self.whole(&ends[0])?, self.whole(&ends[1])?];
                if high - low > 100_000 {
                    return Err(Failure::fault(item.span, "this span is too long"));
                }
                numbers.extend(low..=high);
            } else {
                numbers.push(self.whole(item)?);
            }
        }
        Ok(numbers)
    }

    pub(crate) fn condition(&mut self, expr: &Expr) -> Result<bool, Failure> {
        match self.value(expr)? {
            Value::Bool(holds) => Ok(holds),
            other => Err(other.wrong(expr.span, "a condition")),
        }
    }

    pub(crate) fn selection(&mut self, expr: &Expr) -> Result<Selection, Failure> {
        match self.value(expr)? {
            Value::Selection(selection) => Ok(selection),
            // Several, as `Grow` gives for several directions.
            Value::List(items) if !items.is_empty() => {
                let mut all = Selection::default();
                for item in items {
                    match item {
                        Value::Selection(one) => all = all.or(&one),
                        other => {
                            return Err(other.wrong(expr.span, "a selection of the boundary"));
                        }
                    }
                }
                Ok(all)
            }
            other => Err(other.wrong(expr.span, "a selection of the boundary")),
        }
    }
}

/// Two numbers in a common unit: what has no unit takes the other's; others are
/// brought to metres or radians.
pub(super) fn compared(a: Number, b: Number, span: Span) -> Result<(f64, f64, Unit), Failure> {
    let common = if a.unit == b.unit || b.unit == Unit::None {
        Some((a.value, b.value, a.unit))
    } else if a.unit == Unit::None {
        Some((a.value, b.value, b.unit))
    } else if a.unit.is_angle() && b.unit.is_angle() {
        let both = a.radians().zip(b.radians());
        both.map(|(x, y)| (x, y, Unit::Radians))
    } else {
        let both = a.metres().zip(b.metres());
        both.map(|(x, y)| (x, y, Unit::Metres))
    };
    common.ok_or_else(|| {
        let error = format!(
            "{} and {} do not go together",
            a.unit.as_str(),
            b.unit.as_str()
        );
        Failure::fault(span, error)
    })
}

fn arithmetic(op: BinaryOp, a: Number, b: Number, span: Span) -> Found {
    let (x, y, unit) = compared(a, b, span)?;
    let number = |value: f64| {
        if value.is_finite() {
            Ok(Value::Number(Number { value, unit }))
        } else {
            Err(Failure::fault(span, "this comes to no number"))
        }
    };
    Ok(Value::Bool(match op {
        BinaryOp::Add => return number(x + y),
        BinaryOp::Subtract => return number(x - y),
        BinaryOp::Multiply => return number(x * y),
        BinaryOp::Divide => return number(x / y),
        BinaryOp::Equal => x == y,
        BinaryOp::NotEqual => x != y,
        BinaryOp::Less => x < y,
        BinaryOp::AtMost => x <= y,
        BinaryOp::Greater => x > y,
        BinaryOp::AtLeast => x >= y,
        BinaryOp::Or | BinaryOp::And | BinaryOp::Minus => {
            return Err(Failure::fault(span, "numbers cannot be joined by a word"))
        }
    }))
}

/// The names of attributes, for hints.
pub(crate) const ATTRIBUTES: [&str; 16] = [
    "area",
    "perimeter",
    "width",
    "height",
    "extent_x",
    "extent_y",
    "room",
    "sides",
    "depth",
    "convex",
    "holes",
    "column",
    "row",
    "metric_x",
    "metric_y",
    "outer",
];

/// What can be asked of a region.
fn attribute(region: &Region, name: &str) -> Option<Value> {
    let (low, high) = region.area.extent();
    let cell = region.cell;
    let metres = |value: f64| Number {
        value,
        unit: Unit::Metres,
    };
    // Without a grid all cells are corner cells of a grid of one.
    let count = |of: &dyn Fn(crate::shape::Cell) -> usize| Number::plain(cell.map_or(0, of) as f64);
    Some(Value::Number(match name {
        "area" => Number::plain(region.area.size()),
        "perimeter" => metres(Selection::all(region).length()),
        "width" => metres(high.x - low.x),
        "height" => metres(high.y - low.y),
        "extent_x" => metres(own_extent(region, 0)),
        "extent_y" => metres(own_extent(region, 1)),
        // Radius of the largest circle that it holds.
        "room" => metres(region.area.nearest(pole(&region.area)).1),
        "sides" => Number::plain(region.sides as f64),
        "depth" => Number::plain(region.depth as f64),
        "holes" => Number::plain(region.area.holes.len() as f64),
        "column" => count(&|c| c.at[0]),
        "row" => count(&|c| c.at[1]),
        "metric_x" => count(&|c| c.metric()[0]),
        "metric_y" => count(&|c| c.metric()[1]),
        "outer" => metres(named::named(region, "OUTER")?.length()),
        "convex" => return Some(Value::Bool(convex(region))),
        _ => return None,
    }))
}

/// How far a region reaches along one of its own axes, those that a grid follows.
fn own_extent(region: &Region, axis: usize) -> f64 {
    let along = region.local.axes()[axis];
    let ends = |(low, high): (f64, f64), &p: &Coord<f64>| {
        let at = dot(along, p);
        (low.min(at), high.max(at))
    };
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = region.area.outer.iter().fold(none, ends);
    high - low
}

fn convex(region: &Region) -> bool {
    let ring = &region.area.outer;
    let n = ring.len();
    let turn = |k: usize| {
        let (a, b, c) = (ring[k], ring[(k + 1) % n], ring[(k + 2) % n]);
        crate::plane::cross(crate::plane::unit(b - a), crate::plane::unit(c - b))
    };
    region.area.holes.is_empty() && (0..n).all(|k| turn(k) < 1e-9)
}
