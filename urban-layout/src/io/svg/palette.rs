//! Colours, patterns and line styles.

use crate::layout::TileKind;
use crate::site::RoadClass;

/// A shade of parcels.
#[derive(Debug)]
pub(super) struct Shade {
    pub(super) fill: &'static str,
    /// Most badness, 1 being undesirable.
    pub(super) most: f64,
    pub(super) words: &'static str,
}

/// Parcels from good to undesirable.
pub(super) const SHADES: [Shade; 5] = [
    Shade {
        fill: "#f8efd8",
        most: 0.2,
        words: "under 3\u{b0} and 1.04",
    },
    Shade {
        fill: "#f4e2b4",
        most: 0.45,
        words: "under 7\u{b0} and 1.09",
    },
    Shade {
        fill: "#efcd8d",
        most: 0.75,
        words: "under 11\u{b0} and 1.15",
    },
    Shade {
        fill: "#e6a566",
        most: 1.0,
        words: "under 15\u{b0} and 1.20",
    },
    Shade {
        fill: "#cf6250",
        most: f64::INFINITY,
        words: "undesirable",
    },
];

/// How a kind of land is drawn.
#[derive(Debug)]
pub(super) struct LandStyle {
    pub(super) kind: TileKind,
    pub(super) fill: &'static str,
    pub(super) pattern: Option<&'static str>,
    pub(super) edge: &'static str,
    /// Colour of labels.
    pub(super) ink: &'static str,
    pub(super) words: &'static str,
}

/// All kinds of land but parcels, in the order in which they are drawn.
pub(super) const LAND: &[LandStyle] = &[
    LandStyle {
        kind: TileKind::StreetArea,
        fill: "#fffdf8",
        pattern: None,
        edge: "",
        ink: "#4d4637",
        words: "Streets",
    },
    LandStyle {
        kind: TileKind::Park,
        fill: "#cfe0b4",
        pattern: Some("trees"),
        edge: "#93ad72",
        ink: "#3f5a2a",
        words: "Parks",
    },
    LandStyle {
        kind: TileKind::Lake,
        fill: "#b5d3e3",
        pattern: Some("waves"),
        edge: "#6f9db8",
        ink: "#2d5a75",
        words: "Water",
    },
    LandStyle {
        kind: TileKind::Commercial,
        fill: "#e6c9d2",
        pattern: None,
        edge: "#b58797",
        ink: "#6b3548",
        words: "Commercial",
    },
    LandStyle {
        kind: TileKind::Landmark,
        fill: "#d5c6e2",
        pattern: None,
        edge: "#9c83b5",
        ink: "#4f3670",
        words: "Landmarks",
    },
    LandStyle {
        kind: TileKind::Reserved,
        fill: "#e4e2dc",
        pattern: Some("hatch"),
        edge: "#a5a196",
        ink: "#55524a",
        words: "Reserved",
    },
    LandStyle {
        kind: TileKind::Other,
        fill: "#dcdfcf",
        pattern: None,
        edge: "#aeb29d",
        ink: "#55584a",
        words: "Other open land",
    },
];

/// The style of a kind; streets' for parcels, which have shades instead.
pub(super) fn land(kind: TileKind) -> &'static LandStyle {
    LAND.iter()
        .find(|style| style.kind == kind)
        .unwrap_or(&LAND[0])
}

/// Patterns that the styles name, in sheet units.
pub(super) const PATTERNS: &str = "\
<pattern id=\"trees\" width=\"420\" height=\"420\" patternUnits=\"userSpaceOnUse\">\
<g fill=\"#b3cd92\"><circle cx=\"70\" cy=\"80\" r=\"46\"/><circle cx=\"290\" cy=\"60\" r=\"36\"/>\
<circle cx=\"190\" cy=\"220\" r=\"52\"/><circle cx=\"370\" cy=\"260\" r=\"40\"/><circle cx=\"70\" cy=\"330\" r=\"38\"/>\
<circle cx=\"265\" cy=\"365\" r=\"44\"/></g>\
<g fill=\"#a0bd7d\"><circle cx=\"76\" cy=\"86\" r=\"14\"/><circle cx=\"198\" cy=\"227\" r=\"16\"/>\
<circle cx=\"271\" cy=\"371\" r=\"13\"/></g></pattern>\n\
<pattern id=\"waves\" width=\"700\" height=\"420\" patternUnits=\"userSpaceOnUse\">\
<path d=\"M60 120q60-45 120 0t120 0M380 330q60-45 120 0t120 0\" fill=\"none\" stroke=\"#8fb8cf\" stroke-width=\"14\"/></pattern>\n\
<pattern id=\"hatch\" width=\"150\" height=\"150\" patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\">\
<path d=\"M0 0v150\" stroke=\"#c2beb3\" stroke-width=\"22\"/></pattern>\n\
<pattern id=\"barred\" width=\"110\" height=\"110\" patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\">\
<path d=\"M0 0v110\" stroke=\"#8c1d12\" stroke-width=\"26\"/></pattern>\n";

/// How the centreline of a class is drawn.
#[derive(Debug)]
pub(super) struct StreetStyle {
    pub(super) class: RoadClass,
    pub(super) stroke: &'static str,
    pub(super) words: &'static str,
}

/// Styles of the classes, highest rank first.
pub(super) const STREETS: [StreetStyle; 4] = [
    StreetStyle {
        class: RoadClass::Major,
        stroke: "stroke=\"#6b5f49\" stroke-width=\"34\" stroke-dasharray=\"560 110\"",
        words: "Major road",
    },
    StreetStyle {
        class: RoadClass::Collector,
        stroke: "stroke=\"#82765f\" stroke-width=\"24\" stroke-dasharray=\"330 110\"",
        words: "Collector",
    },
    StreetStyle {
        class: RoadClass::Local,
        stroke: "stroke=\"#a2967f\" stroke-width=\"15\" stroke-dasharray=\"170 110\"",
        words: "Local street",
    },
    StreetStyle {
        class: RoadClass::CulDeSac,
        stroke: "stroke=\"#a2967f\" stroke-width=\"15\" stroke-dasharray=\"40 80\"",
        words: "Cul-de-sac",
    },
];

/// The style of a class.
pub(super) fn street_style(class: RoadClass) -> &'static StreetStyle {
    STREETS
        .iter()
        .find(|style| style.class == class)
        .unwrap_or(&STREETS[2])
}
