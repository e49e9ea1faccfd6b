//! GeoJSON text taken apart: features, kinds and coordinate arrays.
//!
//! The generic readers of GeoJSON say that *something* is wrong with a file, or
//! drop the position of what they refuse. A site is drawn by hand and exported by many
//! programs, so this reader walks the JSON itself and names the feature, part,
//! ring and vertex of each fault. It knows nothing of sites: rings come out as
//! the file has them, in the file's coordinates.

use geo_types::Coord;
use serde_json::{Map, Value};

use crate::error::Result;
use crate::site::fault::{shorten, Axis, Place, SiteError};

/// One polygon as the file has it: rings of positions, exterior first, closing
/// position included where the file has it.
pub(crate) type RawPolygon = Vec<Vec<Coord<f64>>>;

/// A GeoJSON file, opened.
#[derive(Clone, Debug)]
pub(crate) struct Document {
    /// The features in the order of the file.
    pub(crate) features: Vec<RawFeature>,
    /// The file is one Feature or geometry, no collection.
    pub(crate) lone: bool,
    /// Members beside `type` and `features` of the top-level object.
    pub(crate) members: Map<String, Value>,
}

/// A feature, its geometry still in JSON.
#[derive(Clone, Debug)]
pub(crate) struct RawFeature {
    /// Position in the collection.
    pub(crate) index: usize,
    /// Its properties; empty when they are null.
    pub(crate) properties: Map<String, Value>,
    geometry: Value,
}

impl Document {
    /// Parses a text: a FeatureCollection, a Feature or a geometry.
    pub(crate) fn parse(text: &str) -> Result<Self> {
        let text = text.trim_start_matches('\u{feff}');
        if text.trim().is_empty() {
            return Err(SiteError::EmptyFile.into());
        }
        let root = match parse_json(text)? {
            Value::Object(root) => root,
            other => {
                let reason = format!("the file holds {}, no object", describe(&other));
                return Err(SiteError::NotGeoJson { reason }.into());
            }
        };
        let lone = |feature, members| Self {
            features: vec![feature],
            lone: true,
            members,
        };
        let not_geojson = |reason: String| Err(SiteError::NotGeoJson { reason }.into());
        match root.get("type").and_then(Value::as_str) {
            Some("FeatureCollection") => Self::collection(root),
            Some("Feature") => Ok(lone(RawFeature::feature(0, root.clone()), root)),
            Some(kind) if is_geometry(kind) => {
                Ok(lone(RawFeature::bare(0, Value::Object(root.clone())), root))
            }
            Some(kind) => not_geojson(format!("its type is \"{}\"", shorten(kind))),
            None => not_geojson("the top-level object has no \"type\"".to_owned()),
        }
    }

    fn collection(mut root: Map<String, Value>) -> Result<Self> {
        let features = match root.remove("features") {
            Some(Value::Array(features)) => features,
            Some(other) => {
                let reason = format!("\"features\" is {}, no array", describe(&other));
                return Err(SiteError::NotGeoJson { reason }.into());
            }
            None => {
                let reason = "the FeatureCollection has no \"features\"".to_owned();
                return Err(SiteError::NotGeoJson { reason }.into());
            }
        };
        if features.is_empty() {
            return Err(SiteError::EmptyCollection.into());
        }
        let features = features
            .into_iter()
            .enumerate()
            .map(|(index, value)| match value {
                Value::Object(object) => match object.get("type").and_then(Value::as_str) {
                    Some("Feature") => Ok(RawFeature::feature(index, object)),
                    Some(kind) if is_geometry(kind) => {
                        Ok(RawFeature::bare(index, Value::Object(object)))
                    }
                    _ => Err(SiteError::NotGeoJson {
                        reason: format!("entry {index} of \"features\" is no Feature"),
                    }
                    .into()),
                },
                other => Err(SiteError::NotGeoJson {
                    reason: format!(
                        "entry {index} of \"features\" is {}, no Feature",
                        describe(&other)
                    ),
                }
                .into()),
            })
            .collect::<Result<Vec<_>>>()?;
        Ok(Self {
            features,
            lone: false,
            members: root,
        })
    }

    /// The name in an old-style `crs` member, unless it is longitude/latitude.
    pub(crate) fn foreign_crs(&self) -> Option<String> {
        let crs = self.members.get("crs")?.as_object()?;
        let name = crs.get("properties")?.get("name")?.as_str()?;
        let geographic = name.contains("CRS84") || name.ends_with("4326");
        (!geographic).then(|| shorten(name))
    }
}

impl RawFeature {
    fn feature(index: usize, mut object: Map<String, Value>) -> Self {
        let geometry = object.remove("geometry").unwrap_or(Value::Null);
        let properties = match object.remove("properties") {
            Some(Value::Object(properties)) => properties,
            _ => Map::new(),
        };
        Self {
            index,
            properties,
            geometry,
        }
    }

    fn bare(index: usize, geometry: Value) -> Self {
        Self {
            index,
            properties: Map::new(),
            geometry,
        }
    }

    /// The `kind` property, when it is a text.
    pub(crate) fn kind(&self) -> Option<&str> {
        self.text("kind")
    }

    /// A text property; an empty one counts as none.
    pub(crate) fn text(&self, key: &str) -> Option<&str> {
        let text = self.properties.get(key)?.as_str()?;
        (!text.trim().is_empty()).then_some(text)
    }

    /// Where the feature is.
    pub(crate) fn place(&self) -> Place {
        Place::feature(self.index, self.kind())
    }

    /// Whether it has a geometry at all (null is allowed by the format).
    pub(crate) fn has_geometry(&self) -> bool {
        !self.geometry.is_null()
    }

    /// Whether its geometry is a Polygon or MultiPolygon.
    pub(crate) fn is_polygonal(&self) -> bool {
        matches!(self.geometry_type(), Some("Polygon" | "MultiPolygon"))
    }

    fn geometry_type(&self) -> Option<&str> {
        self.geometry.get("type").and_then(Value::as_str)
    }

    /// The polygons of a Polygon or MultiPolygon, each with its place.
    pub(crate) fn polygons(&self) -> Result<Vec<(Place, RawPolygon)>> {
        let coordinates = self.coordinates("Polygon", "MultiPolygon", "Polygon or MultiPolygon")?;
        let place = self.place();
        if self.geometry_type() == Some("Polygon") {
            let polygon = polygon(&place, coordinates)?;
            return Ok(vec![(place, polygon)]);
        }
        array(&place, coordinates, "an array of polygons")?
            .iter()
            .enumerate()
            .map(|(k, value)| {
                let place = place.part(Some(k));
                let polygon = polygon(&place, value)?;
                Ok((place, polygon))
            })
            .collect()
    }

    /// The lines of a LineString or MultiLineString, each with its place.
    pub(crate) fn lines(&self) -> Result<Vec<(Place, Vec<Coord<f64>>)>> {
        let coordinates = self.coordinates("LineString", "MultiLineString", "LineString")?;
        let place = self.place();
        let line = |place: Place, value: &Value| {
            let line = positions(&place, value)?;
            if line.len() < 2 {
                let found = line.len();
                return Err(SiteError::TooShortLine { place, found }.into());
            }
            Ok((place, line))
        };
        if self.geometry_type() == Some("LineString") {
            return Ok(vec![line(place, coordinates)?]);
        }
        array(&place, coordinates, "an array of lines")?
            .iter()
            .enumerate()
            .map(|(k, value)| line(place.part(Some(k)), value))
            .collect()
    }

    /// The `coordinates` of a geometry of one of two types.
    fn coordinates(&self, one: &str, many: &str, expected: &'static str) -> Result<&Value> {
        let place = self.place();
        if !self.has_geometry() {
            return Err(SiteError::NoGeometry { place, expected }.into());
        }
        match self.geometry_type() {
            Some(found) if found == one || found == many => {
                self.geometry.get("coordinates").ok_or_else(|| {
                    let reason = format!("the {found} has no \"coordinates\"");
                    SiteError::BadPosition { place, reason }.into()
                })
            }
            found => {
                let found = found.map_or_else(|| "thing without a type".to_owned(), shorten);
                Err(SiteError::WrongGeometry {
                    place,
                    found,
                    expected,
                }
                .into())
            }
        }
    }
}

fn polygon(place: &Place, value: &Value) -> Result<RawPolygon> {
    let rings = array(place, value, "an array of rings")?;
    if rings.is_empty() {
        let place = place.clone();
        return Err(SiteError::NoRings { place }.into());
    }
    rings
        .iter()
        .enumerate()
        .map(|(k, ring)| positions(&place.ring(k), ring))
        .collect()
}

fn positions(place: &Place, value: &Value) -> Result<Vec<Coord<f64>>> {
    array(place, value, "an array of positions")?
        .iter()
        .enumerate()
        .map(|(k, position)| {
            // Heights and measures after the second number are dropped.
            let Some([x, y, ..]) = position.as_array().map(Vec::as_slice) else {
                let reason = format!(
                    "the position is {}; give an array of two numbers",
                    describe(position)
                );
                let place = place.vertex(k);
                return Err(SiteError::BadPosition { place, reason }.into());
            };
            Ok(Coord {
                x: number(place, k, Axis::X, x)?,
                y: number(place, k, Axis::Y, y)?,
            })
        })
        .collect()
}

fn number(place: &Place, vertex: usize, axis: Axis, value: &Value) -> Result<f64> {
    match value {
        Value::Number(number) => {
            let value = number.as_f64().filter(|value| value.is_finite());
            value.ok_or_else(|| {
                let place = place.vertex(vertex);
                SiteError::NotFinite { place, axis }.into()
            })
        }
        // What writers put for NaN and infinity (see `parse_json`).
        Value::Null => Err(SiteError::NotFinite {
            place: place.vertex(vertex),
            axis,
        }
        .into()),
        Value::String(text) if text.parse::<f64>().is_ok_and(|value| !value.is_finite()) => {
            Err(SiteError::NotFinite {
                place: place.vertex(vertex),
                axis,
            }
            .into())
        }
        other => Err(SiteError::BadPosition {
            place: place.vertex(vertex),
            reason: format!("{axis} is {}; give a number", describe(other)),
        }
        .into()),
    }
}

fn array<'a>(place: &Place, value: &'a Value, expected: &str) -> Result<&'a Vec<Value>> {
    value.as_array().ok_or_else(|| {
        let reason = format!("found {} where {expected} belongs", describe(value));
        let place = place.clone();
        SiteError::BadPosition { place, reason }.into()
    })
}

fn is_geometry(kind: &str) -> bool {
    matches!(
        kind,
        "Point"
            | "MultiPoint"
            | "LineString"
            | "MultiLineString"
            | "Polygon"
            | "MultiPolygon"
            | "GeometryCollection"
    )
}

/// A JSON value in a few words.
pub(crate) fn describe(value: &Value) -> String {
    match value {
        Value::Null => "null".to_owned(),
        Value::Bool(value) => value.to_string(),
        Value::Number(value) => value.to_string(),
        Value::String(text) => format!("\"{}\"", shorten(text)),
        Value::Array(items) if items.is_empty() => "an empty array".to_owned(),
        Value::Array(items) => format!("an array of {}", items.len()),
        Value::Object(_) => "an object".to_owned(),
    }
}

/// Parses JSON, and NaN, Infinity and numbers beyond `f64` too (as texts), which
/// many writers emit: so the fault can be placed at its vertex later, or does no
/// harm in a property that nobody reads.
fn parse_json(text: &str) -> Result<Value> {
    let error = match serde_json::from_str(text) {
        Ok(value) => return Ok(value),
        Err(error) => error,
    };
    if let Some(quoted) = quote_wild_numbers(text) {
        if let Ok(value) = serde_json::from_str(&quoted) {
            return Ok(value);
        }
    }
    let (line, column) = (error.line(), error.column());
    if error.is_eof() {
        return Err(SiteError::TruncatedJson { line, column }.into());
    }
    // Its text ends with the place, which our message has already.
    let text = error.to_string();
    let reason = text.split(" at line ").next().unwrap_or(&text).to_owned();
    Err(SiteError::NotJson {
        reason,
        line,
        column,
    }
    .into())
}

/// Puts quotes around NaN, infinities and overflowing numbers outside texts, or
/// `None` when there are none.
fn quote_wild_numbers(text: &str) -> Option<String> {
    let mut out = String::with_capacity(text.len() + 16);
    let mut found = false;
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let len = match first {
            '"' => text_length(rest),
            c if is_word(c) => rest.find(|c| !is_word(c)).unwrap_or(rest.len()),
            c => c.len_utf8(),
        };
        let (token, after) = rest.split_at(len);
        // `f64` reads "nan", "inf" and "infinity" in any case, and overflow
        // as infinity.
        let wild = is_word(first) && token.parse::<f64>().is_ok_and(|v| !v.is_finite()) && len > 2;
        if wild {
            found = true;
            out.push('"');
        }
        out.push_str(token);
        if wild {
            out.push('"');
        }
        rest = after;
    }
    found.then_some(out)
}

fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.')
}

/// Bytes of the JSON text that starts `rest`, quotes included.
fn text_length(rest: &str) -> usize {
    let mut escaped = false;
    for (k, byte) in rest.bytes().enumerate().skip(1) {
        match byte {
            _ if escaped => escaped = false,
            b'\\' => escaped = true,
            b'"' => return k + 1,
            _ => {}
        }
    }
    rest.len()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;

    #[test]
    fn wild_numbers_are_quoted_outside_texts_only() {
        let text = r#"{"NaN \" NaN": [NaN, -Infinity, 1e999, 12.5], "b": "1e999"}"#;
        let quoted = quote_wild_numbers(text).unwrap();
        assert_eq!(
            quoted,
            r#"{"NaN \" NaN": ["NaN", "-Infinity", "1e999", 12.5], "b": "1e999"}"#
        );
        assert_eq!(quote_wild_numbers(r#"{"a": [1, true, null]}"#), None);
        assert_eq!(quote_wild_numbers("\"unfinished NaN"), None);
    }

    #[test]
    fn heights_are_dropped_and_multilines_split() {
        let text = r#"{"type": "Feature", "properties": null, "geometry": {
            "type": "MultiLineString", "coordinates": [[[1, 2, 3], [4, 5, 6, 7]], [[0, 0], [1, 1]]]}}"#;
        let document = Document::parse(text).unwrap();
        assert!(document.lone);
        let lines = document.features[0].lines().unwrap();
        assert_eq!(lines.len(), 2);
        assert_eq!(
            lines[0].1,
            [Coord { x: 1.0, y: 2.0 }, Coord { x: 4.0, y: 5.0 }]
        );
        assert_eq!(lines[1].0.to_string(), "feature 0, part 1");
    }
}
