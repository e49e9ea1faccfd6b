//! What was mended or left out on the way in.

use std::fmt;

/// Something about the input that was mended, left out or decided, and that the
/// author of the file may want to know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// What happened.
    pub kind: WarningKind,
    /// The feature of the file, counted from 0, when it is one.
    pub feature: Option<usize>,
    /// One line: where, what, and what was done.
    pub message: String,
}

impl Warning {
    pub(crate) fn new(kind: WarningKind, feature: Option<usize>, message: String) -> Self {
        Self {
            kind,
            feature,
            message,
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// The sorts of [`Warning`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum WarningKind {
    /// Vertices that repeat their neighbour were dropped.
    DuplicateVertices,
    /// Vertices in the middle of a straight edge were dropped.
    CollinearVertices,
    /// Spikes, where a ring or line goes out and back the same way, were cut off.
    Spikes,
    /// A ring whose last position differs from its first was closed.
    UnclosedRing,
    /// A ring that touches itself, or a hole that touches the boundary or another
    /// hole, was taken apart.
    TouchingRings,
    /// Parts of the site that overlap or share an edge were joined.
    JoinedParts,
    /// A feature of a kind that is not known was left out.
    UnknownKind,
    /// A feature without a geometry was left out.
    NoGeometry,
    /// A road class that is not known; the road is taken as local.
    UnknownClass,
    /// A road or element outside the site was left out.
    Outside,
    /// A road or element was clipped to the site.
    Clipped,
    /// A road runs along the site's boundary.
    AlongBoundary,
    /// A road of no length was left out.
    NoLength,
    /// Elements overlap; the later kind lost the common part.
    OverlappingElements,
    /// A road runs through an element, which lost the road's width.
    RoadThroughElement,
    /// The site is smaller than one parcel.
    TinySite,
}
