//! What goes into the optimisation, and what comes out beside the mesh.

use crate::error::OptimizeError;
use crate::mesh::{FaceId, VertexId};

/// A block: a face, and the four corners of its strip if it has four.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// The bounded face.
    pub face: FaceId,
    /// Four different vertices of the face's outer loop, counter-clockwise.
    /// What a block without corners wants is up to the
    /// [`TargetShape`](crate::TargetShape);
    /// [`StripFit`](crate::StripFit) leaves it alone.
    pub corners: Option<[VertexId; 4]>,
}

/// How a vertex may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Freedom {
    /// Not at all: it is given by the input.
    #[default]
    Fixed,
    /// Anywhere.
    Free,
    /// Along the straight boundary edge that it lies on, short of the
    /// neighbouring boundary vertices. The edge is recognised by its two
    /// halves lying in one line with neighbours that are not `Free`; where
    /// two lines cross, the one on the unbounded face, then the straighter
    /// one. At a bend of the boundary the vertex stays fixed.
    Slide,
}

/// Which second difference measures the fairness of a road.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Fairness {
    /// Weighted by the original spacing, so that a straight road is fair
    /// however its vertices are spaced: `2 (h2 a + h1 c) / (h1 + h2) - 2 b`
    /// for neighbours a, c at distances h1, h2 of b.
    #[default]
    SpacingWeighted,
    /// The paper's plain `a - 2 b + c` (equation 6), which also evens out the
    /// spacing along roads: by tens of metres where blocks differ in size.
    Plain,
}

/// Weights and limits of [`optimize`](crate::optimize).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OptimizeOptions {
    /// Weight w_s of the distance to the blocks' targets.
    ///
    /// Default value: 1.
    pub shape: f64,
    /// Weight w_f of the second differences along roads.
    ///
    /// Default value: 0.8.
    pub fairness: f64,
    /// Weight w_c of the distance to where vertices began. At 0 the system
    /// may be singular.
    ///
    /// Default value: 0.2.
    pub closeness: f64,
    /// Rounds of fitting and solving.
    ///
    /// Default value: 10.
    pub iterations: usize,
    /// Which second difference.
    ///
    /// Default value: [`Fairness::SpacingWeighted`].
    pub fairness_form: Fairness,
    /// A sliding junction stays this fraction of the gap short of its
    /// neighbours on the boundary; 0 to under 0.5.
    ///
    /// Default value: 0.05.
    pub margin: f64,
    /// A sliding junction stays this far (metres) from its neighbours on the
    /// boundary, or as far as it was if that was less.
    ///
    /// Default value: 0.
    pub clearance: f64,
    /// No corner of a face at a junction gets sharper than this (degrees, 0
    /// to 90), or than it was if that was sharper.
    ///
    /// Default value: 30.
    pub min_angle_deg: f64,
}

impl Default for OptimizeOptions {
    fn default() -> Self {
        Self {
            shape: 1.0,
            fairness: 0.8,
            closeness: 0.2,
            iterations: 10,
            fairness_form: Fairness::default(),
            margin: 0.05,
            clearance: 0.0,
            min_angle_deg: 30.0,
        }
    }
}

impl OptimizeOptions {
    pub(super) fn check(&self) -> Result<(), OptimizeError> {
        let weight = "not negative";
        for (name, value, ok, range) in [
            ("shape", self.shape, self.shape >= 0.0, weight),
            ("fairness", self.fairness, self.fairness >= 0.0, weight),
            ("closeness", self.closeness, self.closeness >= 0.0, weight),
            (
                "margin",
                self.margin,
                (0.0..0.5).contains(&self.margin),
                "at least 0 and under 0.5",
            ),
            ("clearance", self.clearance, self.clearance >= 0.0, weight),
            (
                "min_angle_deg",
                self.min_angle_deg,
                (0.0..=90.0).contains(&self.min_angle_deg),
                "from 0 to 90",
            ),
        ] {
            if !(value.is_finite() && ok) {
                return Err(OptimizeError::BadOption { name, value, range });
            }
        }
        Ok(())
    }
}

/// The energy of a network, square metres, weights included (equation 3).
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Energy {
    /// Distance of vertices to their targets (equation 5).
    pub shape: f64,
    /// Second differences along roads (equation 6).
    pub fairness: f64,
    /// Distance of vertices to where they began (equation 7).
    pub closeness: f64,
}

impl Energy {
    /// The sum of the three.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.shape + self.fairness + self.closeness
    }
}

/// One round of [`optimize`](crate::optimize).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Energy before the solve, for the targets held in it.
    pub before: f64,
    /// Energy after it, for the same targets: never more than `before`.
    pub after: f64,
    /// Energy after it, for the targets fitted anew: may be more.
    pub refitted: f64,
    /// Sliding junctions at the end of their room.
    pub clamped: usize,
    /// Vertices whose step was shortened to keep faces sound.
    pub damped: usize,
}

/// How an optimisation went.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Report {
    /// Energy before.
    pub before: Energy,
    /// Energy of the result, targets fitted to it; never more than before.
    pub after: Energy,
    /// The rounds, in order.
    pub steps: Vec<Step>,
    /// The round whose result was kept, from 1; 0 if none was better than
    /// the start.
    pub best: usize,
    /// Unknowns of the linear system.
    pub unknowns: usize,
    /// How often it was factored.
    pub factorizations: usize,
    /// The largest distance that a vertex moved, metres.
    pub moved: f64,
    /// Vertices that should slide but lie at a bend of the boundary, and so
    /// stayed fixed.
    pub fixed_at_bends: usize,
}
