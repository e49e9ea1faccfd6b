//! Shapes: `Circle(r)`, `Romb(r)`, `Square(a)`, `Rectangle(w, h)`, `Polygon(n, r)`.
//!
//! In a region a shape is cut out of its middle, at a place around that place;
//! the operations that follow go on with what was cut out. At a crossing the
//! shape is that of the centre.

use geo_types::Coord;

use super::Arguments;
use crate::derive::Scope;
use crate::error::Failure;
use crate::plane::{circle, Ring};
use crate::syntax::ast::Operation;

/// A shape without a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Primitive {
    /// Radius.
    Circle(f64),
    /// Half of its diagonal: a square on its corner.
    Romb(f64),
    /// Width and height.
    Rectangle(f64, f64),
    /// Corners and radius.
    Polygon(usize, f64),
}

impl Primitive {
    /// What an operation asks for.
    pub(crate) fn read(operation: &Operation, scope: &mut Scope<'_>) -> Result<Self, Failure> {
        let mut arguments = Arguments::new(operation);
        let mut length = |arguments: &mut Arguments<'_>, what: &str| {
            let argument = arguments.need(what)?;
            let metres = scope.metres(&argument.value)?;
            if metres > 0.0 {
                Ok(metres)
            } else {
                Err(Failure::fault(
                    argument.value.span,
                    format!("{what} must be positive"),
                ))
            }
        };
        let shape = match operation.name.text.as_str() {
            "Circle" => Self::Circle(length(&mut arguments, "a radius")?),
            "Romb" => Self::Romb(length(&mut arguments, "a radius")?),
            "Square" => {
                let side = length(&mut arguments, "a side")?;
                Self::Rectangle(side, side)
            }
            "Rectangle" => Self::Rectangle(
                length(&mut arguments, "a width")?,
                length(&mut arguments, "a height")?,
            ),
            _ => {
                let argument = arguments.need("a number of corners")?;
                let corners = scope.count(&argument.value)?;
                if !(3..=360).contains(&corners) {
                    let error = "a polygon has 3 to 360 corners";
                    return Err(Failure::fault(argument.value.span, error));
                }
                let argument = arguments.need("a radius")?;
                let radius = scope.metres(&argument.value)?;
                if radius <= 0.0 {
                    return Err(Failure::fault(
                        argument.value.span,
                        "a radius must be positive",
                    ));
                }
                Self::Polygon(corners, radius)
            }
        };
        arguments.done()?;
        Ok(shape)
    }

    /// The shape at a place, turned by `facing` radians.
    pub(crate) fn ring(self, at: Coord<f64>, facing: f64) -> Ring {
        let (cos, sin) = (facing.cos(), facing.sin());
        let turned = |x: f64, y: f64| {
            at + Coord {
                x: x * cos - y * sin,
                y: x * sin + y * cos,
            }
        };
        let regular = |corners: usize, radius: f64| -> Ring {
            let step = std::f64::consts::TAU / corners as f64;
            let corner = |k| {
                // Clockwise from the north.
                let angle = std::f64::consts::FRAC_PI_2 - step * k as f64;
                turned(radius * angle.cos(), radius * angle.sin())
            };
            (0..corners).map(corner).collect()
        };
        match self {
            Self::Circle(radius) => circle(at, radius),
            Self::Romb(radius) => regular(4, radius),
            Self::Polygon(corners, radius) => regular(corners, radius),
            Self::Rectangle(width, height) => {
                let (x, y) = (0.5 * width, 0.5 * height);
                vec![turned(-x, -y), turned(-x, y), turned(x, y), turned(x, -y)]
            }
        }
    }

    /// Radius of the circle in it; that of a circle itself, though its polygon
    /// lies within.
    pub(crate) fn inner_radius(self) -> f64 {
        match self {
            Self::Circle(radius) => radius,
            Self::Romb(radius) => radius * std::f64::consts::FRAC_1_SQRT_2,
            Self::Polygon(corners, radius) => {
                radius * (std::f64::consts::PI / corners as f64).cos()
            }
            Self::Rectangle(width, height) => 0.5 * width.min(height),
        }
    }

    /// Radius of the circle around it.
    pub(crate) fn radius(self) -> f64 {
        match self {
            Self::Circle(radius) | Self::Romb(radius) | Self::Polygon(_, radius) => radius,
            Self::Rectangle(width, height) => 0.5 * width.hypot(height),
        }
    }
}
