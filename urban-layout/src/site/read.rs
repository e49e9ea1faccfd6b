//! From the file's features to a site.

use geo_types::{Coord, LineString, Polygon};
use serde_json::Value;

use super::boolean::{open, total_area};
use super::boundary::Boundary;
use super::element;
use super::fault::{shorten, Axis, Place, SiteError};
use super::kind::{ElementKind, RoadClass, Units};
use super::measure::{bounds, centroid, clean_line, length};
use super::polygon::{admit, join, report};
use super::warning::{Warning, WarningKind};
use super::{Element, GivenRoad, Site};
use crate::error::Result;
use crate::io::frame::Frame;
use crate::io::geojson::{describe, Document, RawFeature, RawPolygon};

/// The largest site, in square kilometres.
const MOST_KM2: f64 = 1000.0;
/// One parcel of 30 m by 18 m.
const PARCEL_M2: f64 = 540.0;
/// The widest road, in metres: more is a slip of the unit.
const MOST_WIDTH: f64 = 200.0;
/// The width of a street outside that has none, in metres.
const STREET_WIDTH: f64 = 12.0;
/// Farther than this from the origin is no map coordinate, in metres.
const FARTHEST: f64 = 1e9;
/// Nearer to a pole, metres per degree change too fast for one frame.
const NORTHERNMOST: f64 = 85.0;

type RawPart = (Place, RawPolygon);

/// See [`Site::from_geojson`]; `wanted` is a kind that is the land besides `site`.
pub(crate) fn read(text: &str, units: Units, wanted: &str) -> Result<Site> {
    let document = Document::parse(text)?;
    let degrees = in_degrees(&document, units)?;
    let mut warnings = Vec::new();
    let land = land(&document, wanted, &mut warnings)?;
    let named = land.iter().find_map(|feature| feature.text("name"));
    let name = named.or_else(|| member(&document, "name"));
    let mut raw: Vec<RawPart> = Vec::new();
    for feature in &land {
        raw.extend(feature.polygons()?);
    }
    let (parts, frame) = parts(&raw, degrees, &mut warnings)?;
    // Of a building or park nobody expects parcels.
    warnings.retain(|w| wanted == "site" || w.kind != WarningKind::TinySite);

    let mut given = Given::new(frame, &parts);
    let site: Vec<usize> = land.iter().map(|feature| feature.index).collect();
    for feature in &document.features {
        // Of a park the site around it is no part.
        let around = feature.kind() == Some("site");
        if !site.contains(&feature.index) && !around {
            given.take(feature, &mut warnings)?;
        }
    }
    let roads: Vec<&GivenRoad> = given.roads.iter().chain(&given.boundary_roads).collect();
    let elements = element::fit(
        given.elements,
        &parts,
        &given.boundary,
        &roads,
        &mut warnings,
    );
    let attribution = member(&document, "attribution").or_else(|| member(&document, "source"));
    Ok(Site {
        parts,
        elements,
        roads: given.roads,
        boundary_roads: given.boundary_roads,
        outside_streets: given.outside_streets,
        frame,
        warnings,
        name: name.map(str::to_owned),
        attribution: attribution.map(str::to_owned),
    })
}

/// See [`Site::from_polygon`].
pub(crate) fn from_polygon(polygon: &Polygon<f64>) -> Result<Site> {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    let raw: RawPolygon = rings.map(|ring| ring.0.clone()).collect();
    let place = Place::feature(0, Some("site"));
    for (k, ring) in raw.iter().enumerate() {
        for (vertex, c) in ring.iter().enumerate() {
            let bad = [(Axis::X, c.x), (Axis::Y, c.y)]
                .into_iter()
                .find(|(_, value)| !value.is_finite());
            if let Some((axis, _)) = bad {
                let place = place.ring(k).vertex(vertex);
                return Err(SiteError::NotFinite { place, axis }.into());
            }
        }
    }
    let mut warnings = Vec::new();
    let (parts, frame) = parts(&[(place, raw)], false, &mut warnings)?;
    Ok(Site {
        parts,
        roads: Vec::new(),
        boundary_roads: Vec::new(),
        elements: Vec::new(),
        outside_streets: Vec::new(),
        frame,
        warnings,
        name: None,
        attribution: None,
    })
}

fn member<'a>(document: &'a Document, key: &str) -> Option<&'a str> {
    document.members.get(key).and_then(Value::as_str)
}

/// Whether the numbers are longitude and latitude.
fn in_degrees(document: &Document, units: Units) -> Result<bool> {
    match units {
        Units::Metres => return Ok(false),
        Units::Degrees => return Ok(true),
        Units::Auto => {}
    }
    match document.members.get("coordinate_units") {
        Some(Value::String(word)) if word == "metres" => return Ok(false),
        None | Some(Value::Null) => {}
        Some(Value::String(word)) if word == "degrees" => {}
        Some(other) => {
            let found = describe(other);
            return Err(SiteError::BadUnits { found }.into());
        }
    }
    match document.foreign_crs() {
        Some(name) => Err(SiteError::ForeignCrs { name }.into()),
        None => Ok(true),
    }
}

/// The features that are the site.
fn land<'a>(
    document: &'a Document,
    wanted: &str,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<&'a RawFeature>> {
    let no_site = |reason: String| Err(SiteError::NoSite { reason }.into());
    let known =
        |kind: &str| matches!(kind, "road" | "street") || ElementKind::parse(kind).is_some();
    let called = |kinds: &[&str]| -> Vec<&RawFeature> {
        let all = document.features.iter();
        all.filter(|feature| matches!(feature.kind(), Some(kind) if kinds.contains(&kind)))
            .collect()
    };
    // A building is land like the site; a park may lie in one.
    let named = match called(&[wanted]) {
        parks if wanted == "park" && !parks.is_empty() => parks,
        _ => called(&["site", wanted]),
    };
    if !named.is_empty() {
        return Ok(named);
    }
    if document.lone {
        let feature = &document.features[0];
        return match feature.kind() {
            Some(kind) if known(kind) => no_site(format!("the only one is a {kind}")),
            _ => Ok(vec![feature]),
        };
    }
    let unnamed: Vec<&RawFeature> = document
        .features
        .iter()
        .filter(|feature| feature.kind().is_none() && feature.is_polygonal())
        .collect();
    match unnamed.as_slice() {
        [feature] => {
            if document.features.len() > 1 {
                warnings.push(Warning::new(
                    WarningKind::UnknownKind,
                    Some(feature.index),
                    format!(
                        "feature {}: the only polygon without a kind is taken as the site",
                        feature.index
                    ),
                ));
            }
            Ok(unnamed)
        }
        [] => {
            let mut kinds: Vec<String> = document
                .features
                .iter()
                .map(|feature| feature.kind().map_or_else(|| "none".to_owned(), shorten))
                .collect();
            kinds.sort_unstable();
            kinds.dedup();
            kinds.truncate(8);
            no_site(format!("the kinds are: {}", kinds.join(", ")))
        }
        several => no_site(format!("{} polygons have no kind", several.len())),
    }
}

/// The parts of the site, and the frame around them.
fn parts(
    raw: &[RawPart],
    degrees: bool,
    warnings: &mut Vec<Warning>,
) -> Result<(Vec<Polygon<f64>>, Frame)> {
    let Some((first, _)) = raw.first() else {
        let reason = "its MultiPolygon is empty".to_owned();
        return Err(SiteError::NoSite { reason }.into());
    };
    for (place, polygon) in raw {
        for (k, ring) in polygon.iter().enumerate() {
            check_numbers(&place.ring(k), ring, degrees)?;
        }
    }
    let all: Vec<Coord<f64>> = raw
        .iter()
        .flat_map(|(_, p)| p.iter().flatten())
        .copied()
        .collect();
    let (low, high) = bounds(&all);
    if all.is_empty() {
        let place = first.ring(0);
        return Err(SiteError::TooFewVertices { place, found: 0 }.into());
    }
    if degrees && high.x - low.x > 180.0 {
        return Err(SiteError::Antimeridian {
            place: first.clone(),
            west: low.x,
            east: high.x,
        }
        .into());
    }
    // Before any check of shape, the centre: parts counted as they come.
    let middle = (low + high) / 2.0;
    let rough: Vec<Polygon<f64>> = raw.iter().filter_map(|(_, p)| about(p, middle)).collect();
    let centre = centroid(&rough).map_or(middle, |c| c + middle);
    let frame_at = |centre| {
        if degrees {
            Frame::degrees(centre)
        } else {
            Frame::metres(centre)
        }
    };
    let mut frame = frame_at(centre);
    if degrees && centre.y.abs() > NORTHERNMOST {
        let latitude = centre.y;
        return Err(SiteError::NearPole { latitude }.into());
    }
    let unit = frame.to_local(frame.centre() + Coord { x: 1.0, y: 1.0 });
    refuse_large(total_area(&rough) * unit.x * unit.y, degrees)?;

    let admitted = |frame: &Frame, warnings: &mut Vec<Warning>| -> Result<Vec<Polygon<f64>>> {
        let mut parts = Vec::new();
        for (place, polygon) in raw {
            parts.extend(admit(place, polygon, frame, warnings)?);
        }
        Ok(parts)
    };
    let mut own = Vec::new();
    let (mut parts, mut joined, overlap) = join(admitted(&frame, &mut own)?);
    if overlap {
        // Ground covered twice has drawn the centre towards it: once again.
        if let Some(c) = centroid(&parts) {
            frame = frame_at(frame.to_source(c));
            own.clear();
            (parts, joined, _) = join(admitted(&frame, &mut own)?);
        }
    }
    warnings.append(&mut own);
    if joined {
        let how = if overlap { "overlap" } else { "share an edge" };
        warnings.push(Warning::new(
            WarningKind::JoinedParts,
            Some(first.feature),
            format!("parts of the site {how}; they were joined"),
        ));
    }
    let area = total_area(&parts);
    refuse_large(area, degrees)?;
    if area < PARCEL_M2 {
        warnings.push(Warning::new(
            WarningKind::TinySite,
            Some(first.feature),
            format!("the site covers {area:.1} m2, less than one parcel of {PARCEL_M2:.0} m2"),
        ));
    }
    Ok((parts, frame))
}

fn refuse_large(m2: f64, degrees: bool) -> Result<()> {
    let km2 = m2 / 1e6;
    if km2 > MOST_KM2 {
        return Err(SiteError::TooLarge { km2, degrees }.into());
    }
    Ok(())
}

/// A raw polygon relative to a point, whatever its shape.
fn about(raw: &RawPolygon, centre: Coord<f64>) -> Option<Polygon<f64>> {
    let mut rings = raw.iter().map(|ring| {
        let ring: Vec<Coord<f64>> = ring.iter().map(|&c| c - centre).collect();
        LineString(ring)
    });
    let exterior = rings.next().filter(|ring| open(ring).len() > 2)?;
    Some(Polygon::new(exterior, rings.collect()))
}

/// Numbers that can be what they are said to be.
fn check_numbers(place: &Place, positions: &[Coord<f64>], degrees: bool) -> Result<()> {
    for (vertex, c) in positions.iter().enumerate() {
        for (axis, value, most) in [(Axis::X, c.x, 180.0), (Axis::Y, c.y, 90.0)] {
            let place = || place.vertex(vertex);
            if degrees && value.abs() > most {
                let place = place();
                return Err(SiteError::NotDegrees { place, axis, value }.into());
            }
            if value.abs() > FARTHEST {
                let place = place();
                return Err(SiteError::TooFar { place, axis, value }.into());
            }
        }
    }
    Ok(())
}

/// What is given on and around the site, gathered feature by feature.
struct Given {
    frame: Frame,
    boundary: Boundary,
    roads: Vec<GivenRoad>,
    boundary_roads: Vec<GivenRoad>,
    outside_streets: Vec<GivenRoad>,
    elements: Vec<Element>,
}

impl Given {
    fn new(frame: Frame, parts: &[Polygon<f64>]) -> Self {
        Self {
            frame,
            boundary: Boundary::new(parts),
            roads: Vec::new(),
            boundary_roads: Vec::new(),
            outside_streets: Vec::new(),
            elements: Vec::new(),
        }
    }

    fn take(&mut self, feature: &RawFeature, warnings: &mut Vec<Warning>) -> Result<()> {
        let place = feature.place();
        let mut warn = |kind, what: String| {
            warnings.push(Warning::new(
                kind,
                Some(feature.index),
                format!("{place}: {what}"),
            ));
        };
        let kind = feature.kind().unwrap_or_default();
        let element = ElementKind::parse(kind);
        if !matches!(kind, "road" | "street") && element.is_none() {
            let what = match feature.properties.get("kind") {
                Some(kind) => format!("the kind {} is not known; left out", describe(kind)),
                None => "it has no kind; left out".to_owned(),
            };
            warn(WarningKind::UnknownKind, what);
            return Ok(());
        }
        if !feature.has_geometry() {
            warn(
                WarningKind::NoGeometry,
                "it has no geometry; left out".to_owned(),
            );
            return Ok(());
        }
        match element {
            Some(kind) => self.take_element(feature, kind, warnings),
            None => self.take_road(feature, kind == "street", warnings),
        }
    }

    fn take_element(
        &mut self,
        feature: &RawFeature,
        kind: ElementKind,
        warnings: &mut Vec<Warning>,
    ) -> Result<()> {
        let label = feature.text("label").or_else(|| feature.text("name"));
        for (place, raw) in feature.polygons()? {
            for (k, ring) in raw.iter().enumerate() {
                check_numbers(&place.ring(k), ring, self.frame.is_degrees())?;
            }
            for polygon in admit(&place, &raw, &self.frame, warnings)? {
                self.elements.push(Element {
                    kind,
                    polygon,
                    label: label.map(str::to_owned),
                    feature: feature.index,
                });
            }
        }
        Ok(())
    }

    fn take_road(
        &mut self,
        feature: &RawFeature,
        outside: bool,
        warnings: &mut Vec<Warning>,
    ) -> Result<()> {
        let class = class(feature, warnings);
        let default = if outside {
            STREET_WIDTH
        } else {
            class.default_width()
        };
        let width = width(feature, default)?;
        let road = |line: Vec<Coord<f64>>| GivenRoad {
            line: LineString(line),
            class,
            width,
            name: feature.text("name").map(str::to_owned),
            feature: feature.index,
        };
        for (place, raw) in feature.lines()? {
            check_numbers(&place, &raw, self.frame.is_degrees())?;
            let local = raw.iter().map(|&c| self.frame.to_local(c)).collect();
            let (line, cleaned) = clean_line(local);
            report(&place, &cleaned, warnings);
            let mut warn = |kind, what: String| {
                let message = format!("{place}: {what}");
                warnings.push(Warning::new(kind, Some(feature.index), message));
            };
            if line.len() < 2 {
                warn(
                    WarningKind::NoLength,
                    "the line has no length; left out".to_owned(),
                );
                continue;
            }
            if outside {
                self.outside_streets.push(road(line));
                continue;
            }
            let divided = self.boundary.divide(&line, width);
            if !divided.along.is_empty() {
                let metres: f64 = divided.along.iter().map(|piece| length(piece)).sum();
                warn(
                    WarningKind::AlongBoundary,
                    format!("runs along the site's boundary for {metres:.0} m and was put onto it"),
                );
            } else if divided.inside.is_empty() {
                warn(
                    WarningKind::Outside,
                    "lies outside the site and was left out".to_owned(),
                );
            }
            self.roads.extend(divided.inside.into_iter().map(road));
            self.boundary_roads
                .extend(divided.along.into_iter().map(road));
        }
        Ok(())
    }
}

/// The class of a road; local when it has none or one that is not known.
fn class(feature: &RawFeature, warnings: &mut Vec<Warning>) -> RoadClass {
    let Some(value) = feature.properties.get("class").filter(|v| !v.is_null()) else {
        return RoadClass::Local;
    };
    value
        .as_str()
        .and_then(RoadClass::parse)
        .unwrap_or_else(|| {
            warnings.push(Warning::new(
                WarningKind::UnknownClass,
                Some(feature.index),
                format!(
                "{}: the class {} is none of major, collector, local, cul_de_sac; taken as local",
                feature.place(),
                describe(value)
            ),
            ));
            RoadClass::Local
        })
}

/// The width of a road: its own, or that of its class.
fn width(feature: &RawFeature, default: f64) -> Result<f64> {
    let Some(value) = feature.properties.get("width_m").filter(|v| !v.is_null()) else {
        return Ok(default);
    };
    match value.as_f64() {
        Some(width) if width > 0.0 && width <= MOST_WIDTH => Ok(width),
        _ => Err(SiteError::BadWidth {
            place: feature.place(),
            found: describe(value),
            most: MOST_WIDTH,
        }
        .into()),
    }
}
