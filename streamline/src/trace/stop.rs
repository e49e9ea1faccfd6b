//! Why a streamline ends where it does.

/// How one end of a streamline came about: an outcome, never an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Stop {
    /// It met the boundary of the domain, exactly there.
    Boundary {
        /// The ring, by the field's own labels ([`Exit::ring`](crate::Exit)).
        ring: usize,
        /// The edge of the ring, by the field's own labels.
        edge: usize,
    },
    /// The direction turns faster than any step can follow, or is missing at
    /// an isolated point.
    Singularity,
    /// It came back to its seed with its first direction; the first and the
    /// last point are the seed, and both ends say `ClosedLoop`.
    ClosedLoop,
    /// It ran alongside an earlier part of itself, nearer than
    /// [`TraceOptions::self_approach`](crate::TraceOptions) and at less than 45
    /// degrees to it (a spiral). Crossing itself more squarely is legitimate.
    SelfApproach,
    /// It reached [`TraceOptions::max_length`](crate::TraceOptions).
    LengthLimit,
    /// The field has no direction from here on, though the domain goes on.
    FieldEnd,
    /// It would have come too near to another line that runs alongside, or made
    /// way for two: only of lines made by [`place`](crate::place).
    Neighbour,
    /// It ends on another line, at a point of that line: only of lines made by
    /// [`place`](crate::place).
    Junction {
        /// The other line's position in the list of lines.
        line: usize,
    },
}

impl Stop {
    /// True for [`Stop::Boundary`].
    #[must_use]
    pub const fn is_boundary(self) -> bool {
        matches!(self, Self::Boundary { .. })
    }
}
