//! The site: the region to lay out and what is given on it, in local metres.

mod access;
pub(crate) mod boolean;
mod boundary;
mod contact;
mod element;
pub(crate) mod fault;
mod index;
mod kind;
mod measure;
mod polygon;
mod read;
mod ring;
mod sweep;
mod warning;

use std::path::Path;

use geo_types::{Coord, LineString, MultiPolygon, Polygon};

pub use access::AccessZones;
pub(crate) use boundary::Boundary;
pub(crate) use fault::SiteError;
pub use kind::{ElementKind, RoadClass, Units};
pub use warning::{Warning, WarningKind};

use crate::error::{Error, Result};
use crate::io::frame::Frame;

/// A street or road whose centreline is given.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenRoad {
    /// The centreline, in local metres; at least two vertices, no two
    /// successive ones equal.
    pub line: LineString<f64>,
    /// Its class.
    pub class: RoadClass,
    /// Its width from property line to property line, in metres.
    pub width: f64,
    /// Its name, if the file has one.
    pub name: Option<String>,
    /// The feature that it comes from, counted from 0.
    pub feature: usize,
}

/// A piece of land whose use is given and that stays as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// What it is.
    pub kind: ElementKind,
    /// Its outline, in local metres; exterior counter-clockwise, holes
    /// clockwise.
    pub polygon: Polygon<f64>,
    /// Its `label` or, failing that, its `name`.
    pub label: Option<String>,
    /// The feature that it comes from, counted from 0.
    pub feature: usize,
}

/// A site ready to be laid out.
///
/// All coordinates are metres relative to the site's centre, x east and y
/// north; [`Site::frame`] leads back to those of the file. What holds of every
/// site:
///
/// - `parts` are valid, disjoint polygons (they may touch in single points), exteriors
///   counter-clockwise and holes clockwise, without repeated or collinear vertices. A
///   hole may share single vertices with another ring, never an edge. Vertices of the file
///   are kept to the bit, except where rings touch within 1e-9 of the site's size.
/// - `roads` lie inside the parts; where one leaves, its end is on the boundary.
///   They may cross each other anywhere.
/// - `elements` lie inside the parts, do not overlap each other, and leave the width of
///   every given road free. Where elements overlap, the first kind in the order of
///   [`ElementKind`] keeps the common part.
/// - `boundary_roads` run along the boundary (within 1 m, for longer than
///   their width) and have been put onto its very vertices.
///
/// # Examples
///
/// ```
/// use urban_layout::site::{Site, Units};
///
/// let site = Site::from_geojson(r#"{
///     "type": "FeatureCollection", "coordinate_units": "metres", "features": [
///     {"type": "Feature", "properties": {"kind": "site"}, "geometry": {"type": "Polygon",
///         "coordinates": [[[0, 0], [400, 0], [400, 300], [0, 300], [0, 0]]]}},
///     {"type": "Feature", "properties": {"kind": "road", "class": "collector"}, "geometry":
///         {"type": "LineString", "coordinates": [[-50, 100], [450, 100]]}}
/// ]}"#, Units::Auto)?;
/// assert_eq!(site.area(), 120_000.0);
/// assert_eq!(site.roads[0].width, 16.0);
/// assert_eq!(site.roads[0].line.0[0], (-200.0, -50.0).into());
/// # Ok::<(), urban_layout::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Site {
    /// The land to lay out.
    pub parts: Vec<Polygon<f64>>,
    /// Given roads inside the site, clipped to it; a road that leaves and
    /// returns is several.
    pub roads: Vec<GivenRoad>,
    /// Given roads that run along the boundary.
    pub boundary_roads: Vec<GivenRoad>,
    /// Land whose use is given; an element cut in pieces is several.
    pub elements: Vec<Element>,
    /// Streets that exist outside (kind `street`), not clipped.
    pub outside_streets: Vec<GivenRoad>,
    /// From and to the coordinates of the file.
    pub frame: Frame,
    /// What was mended, left out or decided, in the order of the file.
    pub warnings: Vec<Warning>,
    /// The site's name, if the file has one.
    pub name: Option<String>,
    /// Whom to name as the source of the data, if the file does.
    pub attribution: Option<String>,
}

impl Site {
    /// Reads a site from GeoJSON text (RFC 7946); the guide lists the kinds of
    /// feature and their properties.
    ///
    /// # Errors
    ///
    /// Whatever is wrong with the text and cannot be mended, by feature, ring and
    /// vertex; see [`Error::code`].
    pub fn from_geojson(text: &str, units: Units) -> Result<Self> {
        read::read(text, units, "site")
    }

    /// Reads a building from GeoJSON text: as [`Site::from_geojson`], but that
    /// the land is the floor, and features of the kind `building` are it too.
    ///
    /// # Errors
    ///
    /// As for [`Site::from_geojson`].
    pub fn building_from_geojson(text: &str, units: Units) -> Result<Self> {
        read::read(text, units, "building")
    }

    /// Reads a park from GeoJSON text: as [`Site::from_geojson`], but that
    /// features of the kind `park` are the land if there are any, and the site
    /// around them is left out.
    ///
    /// # Errors
    ///
    /// As for [`Site::from_geojson`].
    pub fn park_from_geojson(text: &str, units: Units) -> Result<Self> {
        read::read(text, units, "park")
    }

    /// A site without anything on it, from a polygon in metres of any
    /// projection.
    ///
    /// # Errors
    ///
    /// As for [`Site::from_geojson`], feature 0 being the polygon.
    ///
    /// # Examples
    ///
    /// ```
    /// use urban_layout::{geo_types::polygon, site::Site};
    ///
    /// // At the coordinates of a UTM zone, wound clockwise.
    /// let field = polygon![
    ///     (x: 500_000.0, y: 6_700_000.0), (x: 500_000.0, y: 6_700_200.0),
    ///     (x: 500_300.0, y: 6_700_200.0), (x: 500_300.0, y: 6_700_000.0),
    /// ];
    /// let site = Site::from_polygon(&field)?;
    /// assert_eq!(site.area(), 60_000.0);
    /// assert_eq!(site.frame.to_source((-150.0, -100.0).into()), (500_000.0, 6_700_000.0).into());
    /// # Ok::<(), urban_layout::Error>(())
    /// ```
    pub fn from_polygon(polygon: &Polygon<f64>) -> Result<Self> {
        read::from_polygon(polygon)
    }

    /// Reads a site from a GeoJSON file, which says itself what its coordinates are
    /// ([`Units::Auto`]).
    ///
    /// # Errors
    ///
    /// A file that cannot be read ([`Error::is_io`]), and as for
    /// [`Site::from_geojson`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        Self::read_as(path, Units::Auto)
    }

    /// Reads a site from a GeoJSON file whose coordinates are known.
    ///
    /// # Errors
    ///
    /// As for [`Site::read`].
    pub fn read_as(path: impl AsRef<Path>, units: Units) -> Result<Self> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(|source| Error::reading(path, source))?;
        let text = String::from_utf8(bytes).map_err(|error| SiteError::NotGeoJson {
            reason: format!(
                "the file is no UTF-8 text (byte {})",
                error.utf8_error().valid_up_to()
            ),
        })?;
        Self::from_geojson(&text, units)
    }

    /// The area of the land, in square metres.
    #[must_use]
    pub fn area(&self) -> f64 {
        boolean::total_area(&self.parts)
    }

    /// The land as one value.
    #[must_use]
    pub fn outline(&self) -> MultiPolygon<f64> {
        MultiPolygon(self.parts.clone())
    }

    /// Whether a point lies on the site's land or its boundary. Builds an index
    /// every time: for a few questions.
    #[must_use]
    pub fn contains(&self, c: Coord<f64>) -> bool {
        Boundary::new(&self.parts).contains(c)
    }

    /// Where the boundary has access to a street outside: within half its width
    /// and 6 m of one. A given road along the boundary counts, for what fronts
    /// on that boundary fronts on it.
    #[must_use]
    pub fn access(&self) -> AccessZones {
        let streets = self.outside_streets.iter().chain(&self.boundary_roads);
        AccessZones::new(element::lines(streets))
    }

    /// Where streets may lead out of the site: the access zones, and where given
    /// roads reach the boundary. When it is empty, they may anywhere.
    #[must_use]
    pub fn exits(&self) -> AccessZones {
        let given = self.roads.iter().chain(&self.boundary_roads);
        AccessZones::new(element::lines(self.outside_streets.iter().chain(given)))
    }
}
