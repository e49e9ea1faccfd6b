//! One dimension of a grid: how many cells, how large, and where the lines between
//! them lie.
//!
//! Sizes without a length share what the others leave; if those leave nothing, or
//! if none has a length, all are equal. A length that is a range is drawn for each
//! cell, an angle for each line: that of the cell before it. The angle of the last
//! cell has no line.

use crate::derive::{Number, Scope, SizeRange, Sizing, Stream, Value};
use crate::error::Failure;
use crate::syntax::ast::{Expr, Span, Unit};

/// Lines lean by less than this, radians.
const LEAN: f64 = 80.0 * std::f64::consts::PI / 180.0;

/// The end of a line that is kept apart goes so far into the smaller of the cells
/// beside it, as a share, so that two that lean towards each other do not meet.
const APART: f64 = 0.45;

/// More cells in one dimension are a mistake.
const MOST: usize = 100_000;

/// A dimension as the grammar says it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Dimension {
    count: Option<usize>,
    sizes: Vec<SizeRange>,
}

/// A dividing line: where it crosses the middle of the quad, and how much it
/// leans, radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    pub(super) at: f64,
    pub(super) lean: f64,
}

/// A dimension as it is laid into a quad; metres along its middle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cuts {
    /// Where the first cell begins and the last one ends.
    pub(super) from: f64,
    pub(super) to: f64,
    /// How long the quad is.
    pub(super) extent: f64,
    pub(super) lines: Vec<Cut>,
}

/// How a dimension is laid into a quad.
#[derive(Clone, Copy, Debug)]
pub(super) struct Laying {
    /// Of paths, metres.
    pub(super) width: f64,
    /// Of cells of which nothing is said, metres.
    pub(super) size: f64,
    /// Whether sizes are not scaled.
    pub(super) exact: bool,
    /// Length of the lines, where they are to be kept apart.
    pub(super) apart: Option<f64>,
}

impl Cuts {
    pub(super) fn cells(&self) -> usize {
        self.lines.len() + 1
    }
}

impl Dimension {
    pub(super) fn read(scope: &mut Scope<'_>, expr: &Expr) -> Result<Self, Failure> {
        let span = expr.span;
        let dimension = match scope.value(expr)? {
            Value::Number(number) if number.unit == Unit::None => Self::count(number.value, span)?,
            Value::Number(number) => Self::size([number, number], span)?,
            Value::List(items) => match items.as_slice() {
                [Value::Number(a), Value::Number(b)]
                    if a.unit == Unit::None && b.unit == Unit::None =>
                {
                    // A range of counts: each whole number is as likely.
                    let (low, high) = (a.value.min(b.value), a.value.max(b.value));
                    let drawn = scope.chance.between([low, high + 1.0]).floor().min(high);
                    Self::count(drawn, span)?
                }
                [Value::Number(a), Value::Number(b)] => Self::size([*a, *b], span)?,
                _ => return Err(Value::List(items).wrong(span, "a count, sizes or a range")),
            },
            Value::Sizing(Sizing { count, sizes }) => Self { count, sizes },
            other => return Err(other.wrong(span, "a count or sizes, such as 3 {2, 6, 2}")),
        };
        if dimension
            .count
            .is_some_and(|count| !(1..=MOST).contains(&count))
        {
            return Err(Failure::fault(span, "a grid has 1 to 100,000 cells a side"));
        }
        for size in &dimension.sizes {
            if size
                .length
                .is_some_and(|[low, _]| !(low > 0.0 && low.is_finite()))
            {
                return Err(Failure::fault(span, "a size must be positive"));
            }
            if size
                .angle
                .is_some_and(|[low, high]| low < -LEAN || high > LEAN)
            {
                return Err(Failure::fault(
                    span,
                    "lines lean by no more than 80 degrees",
                ));
            }
        }
        Ok(dimension)
    }

    fn count(value: f64, span: Span) -> Result<Self, Failure> {
        if value.fract() != 0.0 || !(1.0..=MOST as f64).contains(&value) {
            return Err(Failure::fault(span, "a grid has 1 to 100,000 cells a side")
                .hint("a size is written with its unit, or in braces: {2.5}"));
        }
        Ok(Self {
            count: Some(value as usize),
            sizes: Vec::new(),
        })
    }

    fn size(bounds: [Number; 2], span: Span) -> Result<Self, Failure> {
        let wrong = || Failure::fault(span, "this is not a length");
        let [a, b] = bounds.map(Number::metres);
        let (a, b) = (a.ok_or_else(wrong)?, b.ok_or_else(wrong)?);
        Ok(Self {
            count: None,
            sizes: vec![SizeRange {
                length: Some([a.min(b), a.max(b)]),
                angle: None,
            }],
        })
    }

    /// The lines in `extent` metres with paths of `width` between cells; `size`
    /// metres for cells of which nothing is said.
    pub(super) fn cuts(
        &self,
        extent: f64,
        laying: &Laying,
        chance: &mut Stream,
    ) -> Result<Cuts, String> {
        let &Laying {
            width,
            exact,
            apart,
            ..
        } = laying;
        let drawn = self.drawn(extent, laying, chance);
        if drawn.len() > MOST {
            return Err(format!("{} cells in a row are too many", drawn.len()));
        }
        let room = extent - width * (drawn.len() - 1) as f64;
        if room <= 1e-9 * extent {
            return Err(format!(
                "{} cells with paths of {width:.1} m between do not fit into {extent:.1} m",
                drawn.len()
            ));
        }
        let given: f64 = drawn.iter().flatten().sum();
        let open = drawn.iter().filter(|length| length.is_none()).count();
        // What has no length shares what is left, or is as long as the others
        // are on average.
        let share = if open == drawn.len() {
            room / open as f64
        } else if room > given {
            (room - given) / open.max(1) as f64
        } else {
            given / (drawn.len() - open) as f64
        };
        let lengths: Vec<f64> = drawn.iter().map(|length| length.unwrap_or(share)).collect();
        let all: f64 = lengths.iter().sum();
        let scale = if exact && open == 0 { 1.0 } else { room / all };
        if exact && all * scale > room * (1.0 + 1e-9) {
            return Err(format!(
                "sizes of {all:.1} m in all do not fit into {room:.1} m"
            ));
        }
        let taken = all * scale + extent - room;
        let from = 0.5 * (extent - taken).max(0.0);
        let mut end = from;
        let mut lines = Vec::with_capacity(lengths.len() - 1);
        for (k, pair) in lengths.windows(2).enumerate() {
            end += pair[0] * scale;
            let angle = self.entry(k).and_then(|s| s.angle);
            let mut lean = angle.map_or(0.0, |a| chance.between(a));
            if let Some(across) = apart {
                let farthest = APART * scale * pair[0].min(pair[1]);
                let most = farthest.atan2(0.5 * across);
                lean = lean.clamp(-most, most);
            }
            lines.push(Cut {
                at: end + 0.5 * width,
                lean,
            });
            end += width;
        }
        Ok(Cuts {
            from,
            to: extent - from,
            extent,
            lines,
        })
    }

    fn entry(&self, k: usize) -> Option<&SizeRange> {
        (!self.sizes.is_empty()).then(|| &self.sizes[k % self.sizes.len()])
    }

    /// A length for each cell, or none where nothing is said.
    fn drawn(&self, extent: f64, laying: &Laying, chance: &mut Stream) -> Vec<Option<f64>> {
        let &Laying {
            width, size, exact, ..
        } = laying;
        let mut next = |k: usize| {
            let length = self.entry(k).and_then(|s| s.length);
            length.map(|bounds| chance.between(bounds))
        };
        if let Some(count) = self.count {
            return (0..count).map(next).collect();
        }
        // How many cells of one size come nearest to filling it.
        let fill = |size: f64| {
            let count = ((extent + width) / (size + width)).round();
            (count.max(1.0) as usize).min(MOST + 1)
        };
        if self.sizes.iter().all(|s| s.length.is_none()) {
            return vec![None; fill(size)];
        }
        let mut lengths = Vec::new();
        let mut end = 0.0;
        while lengths.len() <= MOST {
            let length = next(lengths.len());
            end += length.unwrap_or(size);
            // A last cell that sticks out by less than half is squeezed in, unless
            // sizes are to stay as they are.
            let most = if exact {
                0.0
            } else {
                0.5 * length.unwrap_or(size)
            };
            if !lengths.is_empty() && end - extent > most {
                break;
            }
            lengths.push(length);
            end += width;
            if end >= extent {
                break;
            }
        }
        lengths
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sized(count: Option<usize>, lengths: &[Option<f64>]) -> Dimension {
        let size = |length: &Option<f64>| SizeRange {
            length: length.map(|l| [l, l]),
            angle: None,
        };
        Dimension {
            count,
            sizes: lengths.iter().map(size).collect(),
        }
    }

    fn laying(width: f64, exact: bool) -> Laying {
        Laying {
            width,
            size: 4.0,
            exact,
            apart: None,
        }
    }

    fn places(dimension: &Dimension, extent: f64, width: f64, exact: bool) -> Vec<f64> {
        let mut chance = Stream::new(1);
        let cuts = dimension
            .cuts(extent, &laying(width, exact), &mut chance)
            .expect("fits");
        cuts.lines.iter().map(|cut| cut.at).collect()
    }

    /// The notes' `3 {2, 6, 2}` with paths of 2 m: 14 m, here in 24, so that
    /// sizes are doubled and paths are not.
    #[test]
    fn sizes_are_scaled_and_paths_are_not() {
        let notes = sized(Some(3), &[Some(2.0), Some(6.0), Some(2.0)]);
        assert_eq!(places(&notes, 24.0, 2.0, false), [5.0, 19.0]);
        assert_eq!(places(&notes, 24.0, 2.0, true), [8.0, 16.0]);
        let short = sized(Some(3), &[Some(2.0), Some(6.0)]);
        assert_eq!(places(&short, 10.0, 0.0, false), [2.0, 8.0]);
    }

    #[test]
    fn as_many_as_fit() {
        // 4 + 2 + 4 + 2 + 4: a fourth of 4 would stick out of 19 by 3.
        let dimension = sized(None, &[Some(4.0)]);
        assert_eq!(places(&dimension, 19.0, 2.0, false).len(), 2);
        // Out of 21 by 1 only.
        assert_eq!(places(&dimension, 21.0, 2.0, false).len(), 3);
        assert_eq!(places(&Dimension::default(), 16.0, 2.0, false), [5.0, 11.0]);
        // As they are, no more than there is room for.
        assert_eq!(places(&dimension, 21.0, 2.0, true).len(), 2);
    }

    #[test]
    fn what_has_no_size_takes_the_rest() {
        let dimension = sized(Some(3), &[Some(2.0), None, Some(2.0)]);
        assert_eq!(places(&dimension, 20.0, 0.0, false), [2.0, 18.0]);
    }

    #[test]
    fn paths_need_room() {
        let many = sized(Some(11), &[]);
        let found = many.cuts(20.0, &laying(2.0, false), &mut Stream::new(1));
        assert!(found.is_err());
        let large = sized(Some(3), &[Some(9.0)]);
        assert!(large
            .cuts(20.0, &laying(0.0, true), &mut Stream::new(1))
            .is_err());
    }

    /// Of cells of 2 m and lines of 10 m: 45 % of 2 m in half of 10 m.
    #[test]
    fn lines_can_be_kept_apart() {
        let leaning = Dimension {
            count: Some(5),
            sizes: vec![SizeRange {
                length: None,
                angle: Some([0.5, 0.5]),
            }],
        };
        let mut apart = laying(0.0, false);
        let free = leaning
            .cuts(10.0, &apart, &mut Stream::new(1))
            .expect("fits");
        assert!(free.lines.iter().all(|line| line.lean == 0.5));
        apart.apart = Some(10.0);
        let kept = leaning
            .cuts(10.0, &apart, &mut Stream::new(1))
            .expect("fits");
        assert!(kept
            .lines
            .iter()
            .all(|line| (line.lean.tan() - 0.18).abs() < 1e-12));
    }
}
