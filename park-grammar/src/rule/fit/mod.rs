//! Four corners for a region that a grid is laid into, or a rectangle.
//!
//! The notes: "Grid rule requires for input region to be a quad and ideally
//! rectangular or close to rectangular", and they list what the region must
//! guarantee (four corners, angles of at least 70 degrees, a least area,
//! convex) and fixes where it does not. Here the fixes are what `fit =` names:
//!
//! | `fit =` | the quad | what of the notes |
//! |---|---|---|
//! | nothing | the region's own corners where they meet the guarantees, else as `oriented` | |
//! | `own` | the region's own corners, without a fix | the guarantees |
//! | `oriented` | the box of least area around it | Oriented Rectangle (Box) |
//! | `bounding` | the box around it along `direction`, by default the map's axes | Bounding Box |
//! | `axis` | the largest rectangle in it along `direction` | Axis-aligned box |
//! | `inscribed` | the largest rectangle in it | Inscribed Box |
//! | `optimised` | the rectangle that differs least from it | Optimised Box that occupies area sufficient for a park |
//! | `indexed` | the corners that indexing finds if they are four, else its vertices nearest to the corners of the oriented box | Autoindexing; Autoindexing + Oriented Box |
//! | `meeting` | the vertices where its four groups of cardinal directions meet | Cardinal directions: a quad with vertices corresponding to the meeting points |
//! | `blend` | between the two of `of = [oriented, inscribed]`, by the share `factor = 0.5` | Linear Combination |
//!
//! The thresholds are the arguments `min_angle` (70 degrees) and `min_area` (none
//! unless it is given: parts of a park are small). Where the quad that was asked
//! for does not meet them, the region does not suit the rule.

mod inscribed;
mod optimised;

use geo_types::Coord;

use super::{mode, Arguments};
use crate::derive::Scope;
use crate::error::Failure;
use crate::index::{self, Thresholds};
use crate::plane::{
    box_along, difference, dist, dot, extent, intersection, named_by, norm, oriented_box,
    quad_angles, right, unit, Area,
};
use crate::shape::Region;
use crate::syntax::ast::{Expr, ExprKind, Span};

/// Corners at (0, 0), (0, 1), (1, 1) and (1, 0).
pub(crate) type Quad = [Coord<f64>; 4];

/// A quad is made larger by this share of the region's size before the region is
/// cut along it, so that rounding along common edges makes no slivers.
const SLACK: f64 = 1e-7;

/// What the words of `fit =` mean.
const WORDS: [(&str, Fit); 9] = [
    ("own", Fit::Own),
    ("oriented", Fit::Oriented),
    ("bounding", Fit::Bounding),
    ("axis", Fit::Axis),
    ("inscribed", Fit::Inscribed),
    ("optimised", Fit::Optimised),
    ("indexed", Fit::Indexed),
    ("meeting", Fit::Meeting),
    ("blend", Fit::Blend),
];

/// Which four corners; see the module's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fit {
    Default,
    Own,
    Oriented,
    Bounding,
    Axis,
    Inscribed,
    Optimised,
    Indexed,
    Meeting,
    Blend,
}

/// What a fit is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fitting {
    pub(crate) fit: Fit,
    of: [Fit; 2],
    factor: f64,
    /// Of length 1.
    direction: Coord<f64>,
    /// Radians.
    min_angle: f64,
    /// Square metres.
    min_area: f64,
}

/// A region with the quad that was fitted to it.
#[derive(Clone, Debug)]
pub(crate) struct Fitted {
    pub(crate) quad: Quad,
    /// What of the region belongs to the quad.
    pub(crate) inside: Vec<Area>,
    /// What lies outside of it.
    pub(crate) outside: Vec<Area>,
}

impl Fitting {
    /// From the arguments `fit`, `of`, `factor`, `direction`, `min_angle` and
    /// `min_area`.
    pub(crate) fn read(
        arguments: &mut Arguments<'_>,
        scope: &mut Scope<'_>,
        default: Fit,
    ) -> Result<Self, Failure> {
        let fit = arguments.mode(scope, "fit", &WORDS)?.unwrap_or(default);
        let mut of = [Fit::Oriented, Fit::Inscribed];
        if let Some(expr) = arguments.named("of") {
            of = pair(scope, expr)?;
        }
        let mut factor = 0.5;
        if let Some(expr) = arguments.named("factor") {
            factor = scope
                .number(expr)?
                .share(1.0)
                .filter(|f| (0.0..=1.0).contains(f))
                .ok_or_else(|| Failure::fault(expr.span, "a factor is a share from 0 to 1"))?;
        }
        let mut radians = |name, default: f64| match arguments.named(name) {
            Some(expr) => scope
                .number(expr)?
                .radians()
                .ok_or_else(|| Failure::fault(expr.span, "this is not an angle")),
            None => Ok(default),
        };
        let direction = radians("direction", 0.0)?;
        let min_angle = radians("min_angle", 70.0_f64.to_radians())?;
        let min_area = match arguments.named("min_area") {
            Some(expr) => scope.number(expr)?.value,
            None => 0.0,
        };
        Ok(Self {
            fit,
            of,
            factor,
            direction: Coord {
                x: direction.cos(),
                y: direction.sin(),
            },
            min_angle,
            min_area,
        })
    }

    /// The quad for a region, as its own axes name the corners.
    pub(crate) fn quad(&self, region: &Region, span: Span) -> Result<Quad, Failure> {
        self.checked(region, self.fit, span)
    }

    /// The quad, and the region cut along it.
    pub(crate) fn cut(&self, region: &Region, span: Span) -> Result<Fitted, Failure> {
        let quad = self.quad(region, span)?;
        // These take the whole region: its outer cells what lies beyond.
        let whole = matches!(self.fit, Fit::Default | Fit::Own);
        let fitted = if whole {
            Fitted {
                quad,
                inside: vec![region.area.clone()],
                outside: Vec::new(),
            }
        } else {
            cut(region, quad)
        };
        let size: f64 = fitted.inside.iter().map(Area::size).sum();
        if size < self.min_area {
            let least = self.min_area;
            let error = format!("{size:.1} square metres fit in here, and {least} are wanted");
            return Err(Failure::unfit(span, error));
        }
        if fitted.inside.is_empty() {
            return Err(Failure::unfit(span, "nothing fits into this region"));
        }
        Ok(fitted)
    }

    fn checked(&self, region: &Region, fit: Fit, span: Span) -> Result<Quad, Failure> {
        let quad = self.raw(region, fit, span)?;
        let [x, y] = region.local.axes();
        let quad = named_by(quad, x, y);
        match quad_angles(&quad) {
            None => Err(Failure::unfit(
                span,
                "the corners that fit this region are not those of a convex quad",
            )),
            Some(angles) => {
                let sharpest = angles.into_iter().fold(f64::INFINITY, f64::min);
                // Right angles are right up to rounding.
                if sharpest < self.min_angle - 1e-9 {
                    let error = format!(
                        "this region has a corner of {:.0} degrees, and at least {:.0} are wanted",
                        sharpest.to_degrees(),
                        self.min_angle.to_degrees()
                    );
                    return Err(Failure::unfit(span, error));
                }
                Ok(quad)
            }
        }
    }

    fn raw(&self, region: &Region, fit: Fit, span: Span) -> Result<Quad, Failure> {
        let ring = &region.area.outer;
        let nothing = || Failure::unfit(span, "no rectangle fits into this region");
        Ok(match fit {
            Fit::Default => {
                return match own(region) {
                    Some(quad) if self.suits(&quad) => Ok(quad),
                    _ => Ok(oriented_box(ring)),
                }
            }
            Fit::Own => own(region).ok_or_else(|| {
                Failure::unfit(span, "this region has not four corners").hint(
                    "leave fit away to have a box fitted, or give an alternative: else { ... }",
                )
            })?,
            Fit::Oriented => oriented_box(ring),
            Fit::Bounding => box_along(ring, self.direction),
            Fit::Axis => {
                let own = Own::of(region);
                let along = own.to(self.direction) - own.to(Coord::default());
                let found = inscribed::along(&own.area, along).ok_or_else(nothing)?;
                found.map(|p| own.from(p))
            }
            Fit::Inscribed => {
                let own = Own::of(region);
                let found = inscribed::largest(&own.area).ok_or_else(nothing)?;
                found.map(|p| own.from(p))
            }
            Fit::Optimised => {
                let own = Own::of(region);
                let found = optimised::nearest(&own.area).ok_or_else(nothing)?;
                found.map(|p| own.from(p))
            }
            Fit::Indexed => indexed(region),
            Fit::Meeting => {
                let [x, y] = region.local.axes();
                index::meeting_points(ring, x, y).map(|k| ring[k])
            }
            Fit::Blend => {
                let [x, y] = region.local.axes();
                let [a, b] = self.of.map(|fit| self.raw(region, fit, span));
                let (a, b) = (named_by(a?, x, y), named_by(b?, x, y));
                [0, 1, 2, 3].map(|k| crate::plane::lerp(a[k], b[k], self.factor))
            }
        })
    }

    fn suits(&self, quad: &Quad) -> bool {
        quad_angles(quad).is_some_and(|a| a.iter().all(|a| *a >= self.min_angle - 1e-9))
    }
}

/// An area as the region's own coordinates have it, in metres: what is searched
/// there is found alike in regions that are mirror images.
struct Own {
    origin: Coord<f64>,
    x: Coord<f64>,
    y: Coord<f64>,
    area: Area,
}

impl Own {
    fn of(region: &Region) -> Self {
        let [x, _] = region.local.axes();
        let sign = if region.local.mirrored() { 1.0 } else { -1.0 };
        let mut own = Self {
            origin: region.local.corners[0],
            x,
            y: right(x) * sign,
            area: Area::default(),
        };
        let ring = |ring: &Vec<Coord<f64>>| ring.iter().map(|&p| own.to(p)).collect();
        let holes = region.area.holes.iter().map(ring).collect();
        let area = Area::new(ring(&region.area.outer), holes);
        own.area = area;
        own
    }

    fn to(&self, p: Coord<f64>) -> Coord<f64> {
        let away = p - self.origin;
        Coord {
            x: dot(away, self.x),
            y: dot(away, self.y),
        }
    }

    fn from(&self, p: Coord<f64>) -> Coord<f64> {
        self.origin + self.x * p.x + self.y * p.y
    }
}

/// The corners of the region itself, if it is a quad or looks like one.
fn own(region: &Region) -> Option<Quad> {
    if region.cell.is_some() {
        // A grid has given it the corners that its lines have, whatever centres
        // have taken of them.
        return Some(region.local.corners);
    }
    let mut bare = Region::bare(region.area.clone());
    index::with(&mut bare, &Thresholds::DEFAULT);
    (bare.sides == 4).then_some(bare.local.corners)
}

/// The corners of indexing, or vertices near to those of the oriented box.
fn indexed(region: &Region) -> Quad {
    let ring = &region.area.outer;
    if let [a, b, c, d] = index::corner_vertices(ring)[..] {
        return [a, b, c, d].map(|k| ring[k]);
    }
    oriented_box(ring).map(|corner| {
        let nearest = ring
            .iter()
            .min_by(|a, b| dist(**a, corner).total_cmp(&dist(**b, corner)));
        nearest.copied().unwrap_or(corner)
    })
}

/// A region cut along the edges of a quad.
pub(crate) fn cut(region: &Region, quad: Quad) -> Fitted {
    let (low, high) = extent(&region.area.outer);
    let slack = SLACK * norm(high - low);
    let middle = (quad[0] + quad[1] + quad[2] + quad[3]) / 4.0;
    // Twice as far outwards from the middle as a right angle needs.
    let wider = quad.map(|p| p + unit(p - middle) * (2.0 * slack));
    let frame = Area::new(wider.to_vec(), Vec::new());
    let holds = |p: &Coord<f64>| crate::plane::in_ring(&frame.outer, *p);
    if region.area.outer.iter().all(holds) {
        return Fitted {
            quad,
            inside: vec![region.area.clone()],
            outside: Vec::new(),
        };
    }
    let whole = [region.area.clone()];
    let frame = [frame];
    Fitted {
        quad,
        inside: intersection(&whole, &frame),
        outside: difference(&whole, &frame),
    }
}

/// The two fits that are blended.
fn pair(scope: &mut Scope<'_>, expr: &Expr) -> Result<[Fit; 2], Failure> {
    if let ExprKind::List(items) = &expr.kind {
        if let [a, b] = items.as_slice() {
            let pair = [mode(scope, a, "of", &WORDS)?, mode(scope, b, "of", &WORDS)?];
            if !pair.contains(&Fit::Blend) {
                return Ok(pair);
            }
        }
    }
    Err(Failure::fault(
        expr.span,
        "two fits other than blend are expected, such as [oriented, inscribed]",
    ))
}
