//! Where a line has met edges: does it come alongside itself?
//!
//! A line whose tangents span less than half a turn always advances along the
//! middle of that span. It cannot meet an edge twice in the same sense: between
//! the two it would pass the edge's line beyond one of its ends, and have to
//! come back. Nor in the opposite sense, along the same lane. So most lines
//! only keep a list, and one that turns more is put under an index.

use crate::vector::{turn, Point};
use std::collections::HashMap;

/// Span of the tangents, in radians, below which nothing is looked up.
const SPAN: f64 = 3.0;

/// An edge, and one of the two families that cross it.
pub(super) type Passage = (usize, usize);

/// The passages of one line, traced first forwards, then backwards.
#[derive(Debug, Default)]
pub(super) struct Passed {
    list: Vec<(Passage, f64)>,
    /// Looked up by key only, never iterated.
    index: HashMap<Passage, Vec<f64>>,
    indexed: bool,
    /// Angle of the tangent against that at the seed, and its extremes.
    angle: f64,
    span: (f64, f64),
}

impl Passed {
    /// Back to the seed.
    pub(super) fn restart(&mut self) {
        self.angle = 0.0;
    }

    /// The line turns from one direction to another.
    pub(super) fn turn(&mut self, from: Point, to: Point) {
        self.angle += turn(from, to);
        self.span.0 = self.span.0.min(self.angle);
        self.span.1 = self.span.1.max(self.angle);
    }

    /// The line meets an edge at fraction `t`; true if `near` holds of an
    /// earlier fraction at which it did.
    pub(super) fn meets(&mut self, passage: Passage, t: f64, near: impl Fn(f64) -> bool) -> bool {
        if !self.indexed && self.span.1 - self.span.0 < SPAN {
            self.list.push((passage, t));
            return false;
        }
        self.indexed = true;
        for (passage, t) in self.list.drain(..) {
            self.index.entry(passage).or_default().push(t);
        }
        let before = self.index.entry(passage).or_default();
        if before.iter().any(|&t| near(t)) {
            return true;
        }
        before.push(t);
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::point;

    #[test]
    fn looks_back_once_the_line_has_turned() {
        let mut passed = Passed::default();
        let near = |t: f64| (t - 0.5).abs() < 0.1;
        assert!(!passed.meets((7, 0), 0.45, near));
        passed.turn(point(1.0, 0.0), point(0.0, 1.0));
        assert!(!passed.meets((7, 0), 0.5, near), "it cannot be back yet");
        passed.restart();
        passed.turn(point(-1.0, 0.0), point(0.1, -1.0));
        assert!(!passed.meets((7, 1), 0.5, near), "another family");
        passed.turn(point(1.0, 0.0), point(0.0, -1.0));
        passed.turn(point(1.0, 0.0), point(0.0, -1.0));
        assert!(passed.meets((7, 0), 0.5, near));
        assert!(!passed.meets((8, 0), 0.5, near));
    }
}
