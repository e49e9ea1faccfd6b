//! The result: tiles, streets, junctions and blocks of one plan.
//!
//! All coordinates are local metres of the site's [`Frame`](crate::io::frame::Frame),
//! x east and y north; exterior rings run counter-clockwise, holes clockwise.
//! The [`Tile`]s cover the site without gap or overlap and share vertices
//! exactly (see [`seam`]); streets run between [`Junction`]s along centrelines
//! and lie inside the tiles of kind [`TileKind::StreetArea`]; [`Block`]s are the
//! land between streets and overlap the tiles that stand on them.

mod measure;
pub(crate) mod plane;
mod seam;

use geo_types::{Coord, LineString, MultiPolygon, Polygon};

use crate::site::RoadClass;

pub use measure::{corner_deviations, is_undesirable, measure_parcel, min_box_area};
pub use seam::{seam, seam_to, SeamReport};

/// What a tile of land is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TileKind {
    /// A residential parcel.
    Parcel,
    /// Open green space.
    Park,
    /// Shops, offices, schools: built, but not divided into parcels.
    Commercial,
    /// Water.
    Lake,
    /// A landmark that was given with the site.
    Landmark,
    /// Land set aside that the plan leaves alone.
    Reserved,
    /// Land that none of the other words fits.
    Other,
    /// The land that streets take.
    StreetArea,
}

impl TileKind {
    /// Every kind, in the order in which files list them.
    pub const ALL: [Self; 8] = [
        Self::StreetArea,
        Self::Parcel,
        Self::Park,
        Self::Commercial,
        Self::Lake,
        Self::Landmark,
        Self::Reserved,
        Self::Other,
    ];

    /// The word that files use in `kind`.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Parcel => "parcel",
            Self::Park => "park",
            Self::Commercial => "commercial",
            Self::Lake => "lake",
            Self::Landmark => "landmark",
            Self::Reserved => "reserved",
            Self::Other => "other",
            Self::StreetArea => "street_area",
        }
    }

    /// The kind that a file's word means, or `None` if it is no tile's.
    #[must_use]
    pub fn parse(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.as_str() == word)
    }
}

/// Why a parcel, block or street is there.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Lineage {
    /// Path in the split tree, child numbers joined by dots: `0.1.1.0`.
    pub split: String,
    /// Name of the splitter that made it.
    pub by: String,
    /// Cross field that guided it, for a streamline split.
    pub field: Option<String>,
    /// The streamline's normalised costs, each in \[0, 1\], 0 best: divergence,
    /// distance to the boundary, distance to singularities, continuity
    /// (paper section 5).
    pub scores: Option<[f64; 4]>,
    /// Warping energy, for a template split (paper section 4).
    pub energy: Option<f64>,
    /// Seed of the node's own random stream.
    pub seed: u64,
}

/// What is known of a parcel besides its outline.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ParcelInfo {
    /// Id of the [`Block`] that it stands on.
    pub block: u64,
    /// Template or rule that shaped it.
    pub template: String,
    /// Mean deviation of its corners from right angles, degrees
    /// ([`measure_parcel`]).
    pub corner_deviation_deg: f64,
    /// Area of the smallest enclosing rectangle over its own area, 1 at best
    /// ([`measure_parcel`]).
    pub box_ratio: f64,
    /// Root mean square distance to the undeformed template face after the best
    /// registration, metres, where a template made it.
    pub registration: Option<f64>,
    /// Whether it has enough frontage on a street that leads out.
    pub street_access: bool,
    /// Whether its template means it to have none of its own.
    pub access_exempt: bool,
    /// Area of the undeformed template face, square metres.
    pub ideal_area: Option<f64>,
}

/// A piece of the site's land; all tiles together cover it once.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Unique among all features of the layout.
    pub id: u64,
    /// What it is for.
    pub kind: TileKind,
    /// Its outline, local metres.
    pub polygon: Polygon<f64>,
    /// Name or label, if it has one.
    pub label: Option<String>,
    /// Present on parcels.
    pub parcel: Option<ParcelInfo>,
    /// Why it is there.
    pub lineage: Option<Lineage>,
    /// Whether it came with the site (a key element) and was kept.
    pub given: bool,
}

/// A street between two junctions.
#[derive(Clone, Debug, PartialEq)]
pub struct Street {
    /// Unique among all features of the layout.
    pub id: u64,
    /// Centreline from junction `from` to junction `to`, local metres.
    pub line: LineString<f64>,
    /// Its rank.
    pub class: RoadClass,
    /// Width of the land it takes, metres.
    pub width: f64,
    /// Id of the [`Junction`] at the line's first point.
    pub from: u64,
    /// Id of the [`Junction`] at the line's last point.
    pub to: u64,
    /// Whether it came with the site.
    pub given: bool,
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Why it is there.
    pub lineage: Option<Lineage>,
}

/// A place where streets meet or end.
#[derive(Clone, Debug, PartialEq)]
pub struct Junction {
    /// Unique among all features of the layout.
    pub id: u64,
    /// Where it is, local metres.
    pub at: Coord<f64>,
    /// How many street ends meet here (a street that returns counts twice).
    pub degree: usize,
}

/// The land between streets.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Unique among all features of the layout.
    pub id: u64,
    /// Its outline, local metres.
    pub polygon: Polygon<f64>,
    /// Why it is there.
    pub lineage: Lineage,
}

/// The design of a park: what stands on one of the tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct ParkDesign {
    /// Id of the [`Tile`], whose land the pieces of the scene tile.
    pub tile: u64,
    /// The grammar that it was derived from.
    pub grammar: String,
    /// The park, in local metres.
    pub scene: park_grammar::Scene,
}

/// One plan of one site.
///
/// # Examples
///
/// ```
/// use urban_layout::layout::Layout;
///
/// let empty = Layout::default();
/// assert!(empty.parcels().next().is_none());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Tiles; they cover the site without gap or overlap.
    pub tiles: Vec<Tile>,
    /// Streets between junctions, given roads among them.
    pub streets: Vec<Street>,
    /// Where streets meet or end.
    pub junctions: Vec<Junction>,
    /// The land between streets.
    pub blocks: Vec<Block>,
    /// Designs of parks among the tiles; a park without one is open land.
    pub parks: Vec<ParkDesign>,
    /// The site, local metres.
    pub site: MultiPolygon<f64>,
    /// Seed that the plan was made with.
    pub seed: u64,
}

impl Default for Layout {
    fn default() -> Self {
        Self {
            tiles: Vec::new(),
            streets: Vec::new(),
            junctions: Vec::new(),
            blocks: Vec::new(),
            parks: Vec::new(),
            site: MultiPolygon::new(Vec::new()),
            seed: 0,
        }
    }
}

impl Layout {
    /// The tiles of one kind, in order.
    pub fn tiles_of(&self, kind: TileKind) -> impl Iterator<Item = &Tile> {
        self.tiles.iter().filter(move |tile| tile.kind == kind)
    }

    /// The parcels, in order.
    pub fn parcels(&self) -> impl Iterator<Item = &Tile> {
        self.tiles_of(TileKind::Parcel)
    }

    /// Land of the tiles of one kind, square metres.
    #[must_use]
    pub fn area_of(&self, kind: TileKind) -> f64 {
        self.tiles_of(kind)
            .map(|tile| plane::polygon_area(&tile.polygon))
            .sum()
    }

    /// Area of the site, square metres.
    #[must_use]
    pub fn site_area(&self) -> f64 {
        self.site.iter().map(plane::polygon_area).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_means_its_kind() {
        for kind in TileKind::ALL {
            assert_eq!(TileKind::parse(kind.as_str()), Some(kind));
        }
        assert_eq!(TileKind::parse("street"), None);
    }
}
