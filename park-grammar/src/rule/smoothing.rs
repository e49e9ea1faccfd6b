//! `smooth = round, radius = 3 m`: how a rule's borders are smoothed.
//!
//! `smooth = average` averages vertices with their neighbours, `smooth = chaikin`
//! cuts corners off, both `times = 2` times unless said; `smooth = round` makes
//! corners arcs of `radius = 2 m`. `smooth = none` leaves them as they are. `reach`
//! keeps what is smoothed within so many metres of a corner.

use super::Arguments;
use crate::derive::{Scope, Value};
use crate::error::Failure;
use crate::plane::{smooth, Ring, Smoothing};
use crate::syntax::ast::Expr;

/// Passes of a filter unless the grammar says otherwise.
const TIMES: usize = 2;

/// Each pass doubles the vertices.
const MOST: usize = 6;

/// Radius of rounded corners unless the grammar says otherwise, metres.
const RADIUS: f64 = 2.0;

/// A way to smooth, and how far from corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Smoother {
    kernel: Smoothing,
    reach: Option<f64>,
}

impl Smoother {
    /// The argument `smooth` and those that go with it; `None` for `none`, and
    /// `default` where nothing is said.
    pub(crate) fn read(
        arguments: &mut Arguments<'_>,
        scope: &mut Scope<'_>,
        default: Option<Self>,
    ) -> Result<Option<Self>, Failure> {
        let way = arguments.named("smooth");
        Self::of(way, arguments, scope, default)
    }

    /// The same where the word stands at a place of its own.
    pub(crate) fn of(
        way: Option<&Expr>,
        arguments: &mut Arguments<'_>,
        scope: &mut Scope<'_>,
        default: Option<Self>,
    ) -> Result<Option<Self>, Failure> {
        let times = match arguments.named("times") {
            Some(expr) => {
                let times = scope.count(expr)?;
                if times > MOST {
                    let error = format!("a border is smoothed up to {MOST} times");
                    return Err(Failure::fault(expr.span, error));
                }
                Some(times)
            }
            None => None,
        };
        let mut positive = |name: &'static str| match arguments.named(name) {
            Some(expr) => {
                let metres = scope.metres(expr)?;
                if metres > 0.0 {
                    Ok(Some(metres))
                } else {
                    Err(Failure::fault(
                        expr.span,
                        format!("{name} must be positive"),
                    ))
                }
            }
            None => Ok(None),
        };
        let (radius, reach) = (positive("radius")?, positive("reach")?);
        let Some(expr) = way else {
            return Ok(default.map(|found| Self {
                kernel: match found.kernel {
                    Smoothing::Average(n) => Smoothing::Average(times.unwrap_or(n)),
                    Smoothing::Chaikin(n) => Smoothing::Chaikin(times.unwrap_or(n)),
                    Smoothing::Round(r) => Smoothing::Round(radius.unwrap_or(r)),
                },
                reach: reach.or(found.reach),
            }));
        };
        let kernel = match scope.value(expr)? {
            Value::Word(word) => match word.as_str() {
                "none" => return Ok(None),
                "average" => Some(Smoothing::Average(times.unwrap_or(TIMES))),
                "chaikin" => Some(Smoothing::Chaikin(times.unwrap_or(TIMES))),
                "round" => Some(Smoothing::Round(radius.unwrap_or(RADIUS))),
                _ => None,
            },
            _ => None,
        };
        let wrong = || {
            Failure::fault(expr.span, "this is no way to smooth")
                .hint("there are average, chaikin, round and none")
        };
        let kernel = kernel.ok_or_else(wrong)?;
        Ok(Some(Self { kernel, reach }))
    }

    /// Average, as the notes have it where nothing is said.
    pub(crate) const AVERAGE: Self = Self {
        kernel: Smoothing::Average(TIMES),
        reach: None,
    };

    /// The same, kept within a reach of corners unless the grammar gives one.
    pub(crate) fn within(self, reach: f64) -> Self {
        Self {
            reach: self.reach.or(Some(reach)),
            ..self
        }
    }

    /// A ring smoothed; pinned vertices stay.
    pub(crate) fn ring(&self, ring: &Ring, pinned: &[bool]) -> Ring {
        smooth(ring, pinned, self.kernel, self.reach)
    }
}
