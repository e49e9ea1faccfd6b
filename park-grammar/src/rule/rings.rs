//! `Rings(6, 14) { Ring } { Path } { Outside }`: a region broken along circles, with
//! paths on them.
//!
//! The notes want "an operator that breaks the region of the park along the circle",
//! and show a circle somewhere in the park with what lies in it and around it. The
//! rest is decided here.
//!
//! The values are the radii of circles around one centre, each metres, a range, or,
//! as a percentage or a bare number below 1, a share of the radius of the largest
//! circle around the centre that has room in the region. A value with sizes gives
//! widths instead, as for a grid: `Rings(3 {4, 2})` is a disc of radius 4 and rings 2
//! and 4 wide, with paths between and one around. Without any value there is one
//! circle, whose path touches the boundary from inside; the place of a rule that has
//! room around it gives its own radius (`centre = ScatterCircles(1 {15})`).
//!
//! A path runs on each circle, half of `width` (`PathWidth` unless said) on either
//! side; with `{}` for the second block there are none, and rings touch. `centre` is
//! any one place; `CENTRE` unless said, and `POLE` is the point with the most room.
//!
//! Circles are polygons of 36 sides with vertices on the circle. What of them lies
//! outside of the region is cut off, so that rings and paths may fall into parts.
//!
//! Rings are numbered from the centre: the attribute `column` of the disc is 0. They
//! are marked `SEAM` or `PATH`, local coordinates are those of their boxes. With the
//! flag `SplitHoles` all parts are without holes.
//!
//! Outputs: the disc and rings, paths, what is outside.

use geo_types::Coord;

use super::parts::{centre, room, Parts};
use super::peel::depth;
use super::{holes, path_width, Arguments, Ask, Output, Partition};
use crate::derive::{Number, Scope, Sizing, Value, Watch};
use crate::error::Failure;
use crate::plane::{circle, difference, intersection, middle, Area};
use crate::shape::{Cell, Region, Role};
use crate::syntax::ast::{Expr, Span};

/// More circles are a mistake.
const MOST: usize = 1000;

pub(crate) fn rings(ask: &mut Ask<'_, '_>) -> Result<Partition, Failure> {
    let span = ask.operation.span;
    let scope = &mut ask.scope;
    let mut arguments = Arguments::new(ask.operation);
    let split = holes::wanted(&mut arguments, scope)?;
    let spot = centre(scope, &mut arguments)?;
    let width = path_width(&mut arguments, scope, ask.path_width)?;
    let at = spot.map_or_else(|| middle(&scope.region.area), |spot| spot.at);
    let mut laying = Laying {
        at,
        room: room(scope.region, at),
        half: 0.5 * width,
        radii: Vec::new(),
    };
    while let Some(argument) = arguments.next() {
        laying.add(scope, &argument.value)?;
    }
    arguments.done()?;
    if laying.radii.is_empty() {
        let given = spot.map(|spot| spot.radius).filter(|&radius| radius > 0.0);
        laying
            .radii
            .push(given.unwrap_or(laying.room - laying.half));
    }
    laying.check(span)?;
    let watch = scope.watch();
    let mut outputs = laying.cut(scope.region, span, &watch)?;
    if split {
        holes::split_all(&mut outputs, &watch)?;
    }
    Ok(Partition { outputs })
}

/// Circles around a centre.
struct Laying {
    at: Coord<f64>,
    /// Radius of the largest circle inside; negative for a centre outside.
    room: f64,
    /// Half the width of paths.
    half: f64,
    /// From the inside out.
    radii: Vec<f64>,
}

impl Laying {
    /// What one value gives.
    fn add(&mut self, scope: &mut Scope<'_>, expr: &Expr) -> Result<(), Failure> {
        match scope.value(expr)? {
            Value::Sizing(sizing) => self.widths(scope, &sizing, expr.span),
            Value::List(items)
                if !matches!(items.as_slice(), [Value::Number(_), Value::Number(_)]) =>
            {
                for item in items {
                    let Value::Number(number) = item else {
                        return Err(item.wrong(expr.span, "a radius"));
                    };
                    self.radius(number, expr.span)?;
                }
                Ok(())
            }
            _ => {
                let number = scope.number(expr)?;
                self.radius(number, expr.span)
            }
        }
    }

    fn radius(&mut self, number: Number, span: Span) -> Result<(), Failure> {
        let radius = depth(number, self.room.max(0.0), span);
        self.radii.push(match radius {
            // A share of no room.
            Err(_) if self.room <= 0.0 && number.value > 0.0 => {
                let error = "the centre has no room around it, so that shares of it are nothing";
                return Err(Failure::unfit(span, error));
            }
            radius => radius?,
        });
        Ok(())
    }

    /// Rings of given widths, each with a path around.
    fn widths(
        &mut self,
        scope: &mut Scope<'_>,
        sizing: &Sizing,
        span: Span,
    ) -> Result<(), Failure> {
        let count = sizing.count.unwrap_or(sizing.sizes.len());
        if count > MOST {
            return Err(Failure::fault(span, "these are too many rings"));
        }
        let lengths: Vec<[f64; 2]> = sizing.sizes.iter().filter_map(|size| size.length).collect();
        if lengths.is_empty() || lengths.len() < sizing.sizes.len() {
            let failure = Failure::fault(span, "a ring has a width");
            return Err(
                failure.hint("write as many as there are, or some to be repeated: 3 {4 m, 2 m}")
            );
        }
        for k in 0..count {
            let inner = self.radii.last().map_or(0.0, |radius| radius + self.half);
            let width = scope.chance.between(lengths[k % lengths.len()]);
            self.radii.push(inner + width + self.half);
        }
        Ok(())
    }

    /// That circles follow each other, and leave room between their paths.
    fn check(&mut self, span: Span) -> Result<(), Failure> {
        if self.radii.len() > MOST {
            return Err(Failure::fault(span, "these are too many circles"));
        }
        self.radii.sort_by(f64::total_cmp);
        let first = self.radii.first().copied().unwrap_or(0.0);
        if first <= self.half || !first.is_finite() {
            let error = "there is no room for a circle with its path around this centre";
            return Err(Failure::unfit(span, error));
        }
        let apart = |pair: &[f64]| pair[1] - pair[0] > 2.0 * self.half + 1e-9 * pair[1];
        if !self.radii.windows(2).all(apart) {
            return Err(Failure::unfit(
                span,
                "circles lie so near that their paths meet",
            ));
        }
        Ok(())
    }

    fn cut(&self, region: &Region, span: Span, watch: &Watch<'_>) -> Result<Vec<Output>, Failure> {
        let parts = Parts::new(region, "Rings");
        let disc = |radius: f64| Area::new(circle(self.at, radius), Vec::new());
        let land = std::slice::from_ref(&region.area);
        let role = if self.half > 0.0 {
            Role::Path
        } else {
            Role::Seam
        };
        let (mut rings, mut paths) = (Vec::new(), Vec::new());
        // What lies outside of the circles and paths so far.
        let mut left = land.to_vec();
        let count = self.radii.len();
        for (k, radius) in self.radii.iter().enumerate() {
            watch.look()?;
            let inside = disc(radius - self.half);
            let ring = intersection(&left, std::slice::from_ref(&inside));
            for mut part in parts.regions(ring, role, watch)? {
                part.cell = Some(Cell {
                    at: [k, 0],
                    of: [count, 1],
                });
                rings.push(part);
            }
            watch.look()?;
            left = difference(&left, &[inside]);
            if self.half > 0.0 {
                let around = disc(radius + self.half);
                paths.extend(intersection(&left, std::slice::from_ref(&around)));
                left = difference(&left, &[around]);
            }
        }
        if rings.is_empty() {
            return Err(Failure::unfit(
                span,
                "no part of these circles lies in this region",
            ));
        }
        Ok(vec![
            Output::lawns(rings),
            Output::paths(parts.regions(paths, Role::Path, watch)?),
            Output::lawns(parts.regions(left, role, watch)?),
        ])
    }
}
