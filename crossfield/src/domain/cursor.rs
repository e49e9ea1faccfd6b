//! Where the last point was found.

/// Remembers the triangle in which a point was last found, so that the next
/// one, not far away, is found in a few steps.
///
/// Any cursor may be used with any domain: a stale one costs time only, and
/// `Cursor::default()` starts anew.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cursor(u32);

impl Cursor {
    /// The cursor as a number, for those who keep it in a type of their own.
    #[must_use]
    pub const fn to_bits(self) -> u64 {
        self.0 as u64
    }

    /// The cursor that [`Cursor::to_bits`] gave; any number is safe, a wrong
    /// one only makes the next location slower.
    #[must_use]
    pub const fn from_bits(bits: u64) -> Self {
        Self(bits as u32)
    }

    pub(super) fn at(triangle: usize) -> Self {
        Self(triangle as u32 + 1)
    }

    pub(super) fn triangle(self, count: usize) -> Option<usize> {
        let triangle = (self.0 as usize).checked_sub(1)?;
        (triangle < count).then_some(triangle)
    }
}
