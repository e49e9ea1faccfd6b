//! Every way in which a site can be wrong, each with its place and its remedy.

use std::fmt;

use geo_types::Coord;

/// Where in the file something is wrong; all numbers count from 0, as the
/// arrays of the file do.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub(crate) struct Place {
    /// Position of the feature in the collection.
    pub(crate) feature: usize,
    /// Its `kind`, if it has one.
    pub(crate) kind: Option<String>,
    /// Which polygon of a MultiPolygon, or line of a MultiLineString.
    pub(crate) part: Option<usize>,
    /// Which ring of the polygon; 0 is the exterior.
    pub(crate) ring: Option<usize>,
    /// Which position of the ring or line.
    pub(crate) vertex: Option<usize>,
}

impl Place {
    pub(crate) fn feature(feature: usize, kind: Option<&str>) -> Self {
        Self {
            feature,
            kind: kind.map(str::to_owned),
            ..Self::default()
        }
    }

    pub(crate) fn part(&self, part: Option<usize>) -> Self {
        Self {
            part,
            ..self.clone()
        }
    }

    pub(crate) fn ring(&self, ring: usize) -> Self {
        Self {
            ring: Some(ring),
            ..self.clone()
        }
    }

    pub(crate) fn vertex(&self, vertex: usize) -> Self {
        Self {
            vertex: Some(vertex),
            ..self.clone()
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "feature {}", self.feature)?;
        if let Some(kind) = &self.kind {
            write!(f, " ({})", shorten(kind))?;
        }
        if let Some(part) = self.part {
            write!(f, ", part {part}")?;
        }
        if let Some(ring) = self.ring {
            write!(f, ", ring {ring}")?;
        }
        if let Some(vertex) = self.vertex {
            write!(f, ", vertex {vertex}")?;
        }
        Ok(())
    }
}

/// A foreign text, made fit for a one-line message.
pub(crate) fn shorten(text: &str) -> String {
    let clean: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .take(60)
        .collect();
    if text.chars().count() > 60 {
        format!("{clean}...")
    } else {
        clean
    }
}

/// A coordinate of the source, as a user would look it up in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct At(pub(crate) Coord<f64>);

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Nine decimals are 0.1 mm in degrees, and no noise in metres.
        let short = |value: f64| {
            let text = format!("{value:.9}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        };
        write!(f, "({}, {})", short(self.0.x), short(self.0.y))
    }
}

/// The axis of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    X,
    Y,
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::X => "x",
            Self::Y => "y",
        })
    }
}

const SAY_METRES: &str = "if the coordinates are metres, add \"coordinate_units\": \"metres\" \
     beside the top-level \"type\", or tell the command so";

/// What is wrong with a site.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum SiteError {
    #[error("the file is empty; give a GeoJSON Feature or FeatureCollection")]
    EmptyFile,
    #[error("the JSON ends too early, at line {line}, column {column}; is the file cut short?")]
    TruncatedJson { line: usize, column: usize },
    #[error("no JSON: {reason} at line {line}, column {column}")]
    NotJson {
        reason: String,
        line: usize,
        column: usize,
    },
    #[error("no GeoJSON: {reason}; give a Feature or FeatureCollection (RFC 7946)")]
    NotGeoJson { reason: String },
    #[error("the collection has no features; give at least one of kind \"site\"")]
    EmptyCollection,
    #[error("no feature is the site ({reason}); give the region to lay out as a Polygon or MultiPolygon with \"kind\": \"site\"")]
    NoSite { reason: String },
    #[error("{place}: the geometry is missing; give a {expected}")]
    NoGeometry {
        place: Place,
        expected: &'static str,
    },
    #[error("{place}: the geometry is a {found}; give a {expected}")]
    WrongGeometry {
        place: Place,
        found: String,
        expected: &'static str,
    },
    #[error("{place}: {reason}")]
    BadPosition { place: Place, reason: String },
    #[error("{place}: {axis} is no finite number (NaN, infinite or too large); correct it or leave the vertex out")]
    NotFinite { place: Place, axis: Axis },
    #[error("{place}: {axis} = {value} cannot be a {}; {SAY_METRES}", if *axis == Axis::X { "longitude" } else { "latitude" })]
    NotDegrees {
        place: Place,
        axis: Axis,
        value: f64,
    },
    #[error("{place}: {axis} = {value:e} m is farther from the origin than any map's coordinates; correct it")]
    TooFar {
        place: Place,
        axis: Axis,
        value: f64,
    },
    #[error("\"coordinate_units\" is {found}; write \"metres\" or \"degrees\"")]
    BadUnits { found: String },
    #[error("the coordinates are said to be in {name}, which is neither longitude/latitude nor declared as metres; {SAY_METRES}, or write them as longitude/latitude")]
    ForeignCrs { name: String },
    #[error("{place}: longitudes run from {west} to {east}, across the antimeridian; give the site in metres of a local projection")]
    Antimeridian { place: Place, west: f64, east: f64 },
    #[error("the site's centre is at latitude {latitude:.4}, too near a pole for longitude/latitude; give it in metres of a local projection")]
    NearPole { latitude: f64 },
    #[error("the site covers {km2:.0} km2, and at most 1000 can be laid out at once; give a smaller region{}", if *degrees { format!(", or {SAY_METRES}") } else { String::new() })]
    TooLarge { km2: f64, degrees: bool },
    #[error(
        "{place}: the ring has {found} positions; a ring needs at least 4, the last like the first"
    )]
    TooFewVertices { place: Place, found: usize },
    #[error("{place}: the line has {found} position(s); a line needs at least 2")]
    TooShortLine { place: Place, found: usize },
    #[error("{place}: the polygon has no rings; give at least its exterior")]
    NoRings { place: Place },
    #[error("{place}: the ring encloses no area, its vertices lie on one line or in one point; correct its coordinates")]
    ZeroArea { place: Place },
    #[error("{place}: the ring crosses itself at {at}, where its edges after vertices {first} and {second} meet; reorder the vertices, or cut the ring into simple ones")]
    SelfCrossing {
        place: Place,
        first: usize,
        second: usize,
        at: At,
    },
    #[error("{place}: the ring runs over itself near {at} so that its inside is not clear; cut it into simple rings")]
    SelfOverlapping { place: Place, at: At },
    #[error("{place}: the hole lies outside its polygon's exterior, at {at}; move it inside or remove it")]
    HoleOutside { place: Place, at: At },
    #[error(
        "{place}: the hole crosses the exterior ring at {at}; cut it at the boundary, or draw the boundary around it"
    )]
    HoleCrossesBoundary { place: Place, at: At },
    #[error(
        "{place}: the hole overlaps the hole in ring {other} at {at}; draw the two as one hole"
    )]
    OverlappingHoles { place: Place, other: usize, at: At },
    #[error("{place}: the rings touch at {at} in a way that leaves it unclear what is inside; move them apart")]
    UnclearTouch { place: Place, at: At },
    #[error("{place}: the holes leave nothing of the polygon; remove the hole that fills it")]
    HolesFillAll { place: Place },
    #[error("{place}: width_m is {found}; give a number of metres over 0 and at most {most}")]
    BadWidth {
        place: Place,
        found: String,
        most: f64,
    },
}

impl SiteError {
    /// Where the fault is, when it is at one place.
    pub(crate) fn place(&self) -> Option<&Place> {
        match self {
            Self::NoGeometry { place, .. }
            | Self::WrongGeometry { place, .. }
            | Self::BadPosition { place, .. }
            | Self::NotFinite { place, .. }
            | Self::NotDegrees { place, .. }
            | Self::TooFar { place, .. }
            | Self::Antimeridian { place, .. }
            | Self::TooFewVertices { place, .. }
            | Self::TooShortLine { place, .. }
            | Self::NoRings { place }
            | Self::ZeroArea { place }
            | Self::SelfCrossing { place, .. }
            | Self::SelfOverlapping { place, .. }
            | Self::HoleOutside { place, .. }
            | Self::HoleCrossesBoundary { place, .. }
            | Self::OverlappingHoles { place, .. }
            | Self::UnclearTouch { place, .. }
            | Self::HolesFillAll { place }
            | Self::BadWidth { place, .. } => Some(place),
            Self::EmptyFile
            | Self::TruncatedJson { .. }
            | Self::NotJson { .. }
            | Self::NotGeoJson { .. }
            | Self::EmptyCollection
            | Self::NoSite { .. }
            | Self::BadUnits { .. }
            | Self::ForeignCrs { .. }
            | Self::NearPole { .. }
            | Self::TooLarge { .. } => None,
        }
    }

    /// The stable name that [`crate::Error::code`] returns.
    pub(crate) fn code(&self) -> &'static str {
        match self {
            Self::EmptyFile => "empty-file",
            Self::TruncatedJson { .. } => "truncated-json",
            Self::NotJson { .. } => "not-json",
            Self::NotGeoJson { .. } => "not-geojson",
            Self::EmptyCollection => "empty-collection",
            Self::NoSite { .. } => "no-site",
            Self::NoGeometry { .. } => "no-geometry",
            Self::WrongGeometry { .. } => "wrong-geometry",
            Self::BadPosition { .. } => "bad-position",
            Self::NotFinite { .. } => "not-finite",
            Self::NotDegrees { .. } => "not-degrees",
            Self::TooFar { .. } => "too-far",
            Self::BadUnits { .. } => "bad-units",
            Self::ForeignCrs { .. } => "foreign-crs",
            Self::Antimeridian { .. } => "antimeridian",
            Self::NearPole { .. } => "near-pole",
            Self::TooLarge { .. } => "too-large",
            Self::TooFewVertices { .. } => "too-few-vertices",
            Self::TooShortLine { .. } => "too-short-line",
            Self::NoRings { .. } => "no-rings",
            Self::ZeroArea { .. } => "zero-area",
            Self::SelfCrossing { .. } => "self-crossing-ring",
            Self::SelfOverlapping { .. } => "self-overlapping-ring",
            Self::HoleOutside { .. } => "hole-outside",
            Self::HoleCrossesBoundary { .. } => "hole-crosses-boundary",
            Self::OverlappingHoles { .. } => "overlapping-holes",
            Self::UnclearTouch { .. } => "unclear-touch",
            Self::HolesFillAll { .. } => "holes-fill-all",
            Self::BadWidth { .. } => "bad-width",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_reads_from_the_outside_in() {
        let place = Place::feature(3, Some("lake"))
            .part(Some(1))
            .ring(2)
            .vertex(17);
        assert_eq!(
            place.to_string(),
            "feature 3 (lake), part 1, ring 2, vertex 17"
        );
        assert_eq!(Place::feature(0, None).to_string(), "feature 0");
    }

    #[test]
    fn foreign_text_cannot_break_the_line() {
        assert_eq!(shorten("a\nb"), "a b");
        assert!(shorten(&"x".repeat(500)).len() < 70);
    }

    #[test]
    fn coordinates_are_short() {
        let at = At(Coord { x: 24.5, y: -3.0 });
        assert_eq!(at.to_string(), "(24.5, -3)");
    }
}
