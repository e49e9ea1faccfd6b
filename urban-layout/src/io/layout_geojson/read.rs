//! Reads a layout back, our own or another tool's.

use geo_types::{Coord, LineString, MultiPolygon, Polygon};
use serde_json::{Map, Value};

use crate::error::{Error, Result};
use crate::io::frame::Frame;
use crate::layout::plane::{distance, oriented};
use crate::layout::{
    measure_parcel, Block, Junction, Layout, Lineage, ParcelInfo, Street, Tile, TileKind,
};
use crate::site::RoadClass;

/// A street end without a junction's id belongs to a junction this near, metres.
const SAME_PLACE: f64 = 0.05;

/// Reads a layout from GeoJSON, into the local metres of the site's frame.
///
/// Reads what [`layout_to_geojson`](super::layout_to_geojson) writes, and layouts
/// of other tools that follow the same format: whatever is not needed to judge the geometry may be missing
/// (a parcel's figures are then measured, a street's width is taken as 12 m, its
/// ends go to the junction points within 5 cm). Rings may run either way. The
/// polygons of a MultiPolygon become tiles of their own, the first with the
/// feature's id. Features of unknown kinds are left out.
///
/// # Errors
///
/// An input error naming the feature: text that is no GeoJSON, coordinates in
/// other units than the site's, a missing or fractional `id`, a geometry that
/// does not suit its kind. A layout that is well formed but wrong is no error:
/// [`check`](fn@crate::check::check) judges it.
pub fn read_layout(text: &str, frame: &Frame) -> Result<Layout> {
    let document: Value = serde_json::from_str(text)
        .map_err(|e| Error::input(format!("the layout is not JSON: {e}; write it anew")))?;
    let features: Vec<&Value> = match document.get("type").and_then(Value::as_str) {
        Some("FeatureCollection") => {
            let list = document.get("features").and_then(Value::as_array);
            list.ok_or_else(|| {
                Error::input("the layout's FeatureCollection has no array `features`")
            })?
            .iter()
            .collect()
        }
        Some("Feature") => vec![&document],
        _ => {
            return Err(Error::input(
                "the layout is no GeoJSON FeatureCollection; `generate` writes one",
            ))
        }
    };
    let metres = document.get("coordinate_units").and_then(Value::as_str) == Some("metres");
    if metres == frame.is_degrees() && metres {
        return Err(Error::input(
            "the layout is in metres but the site in degrees; give both in the same units",
        ));
    }
    let mut reader = Reader {
        frame,
        layout: Layout::default(),
        loose: Vec::new(),
        spare: Vec::new(),
    };
    reader.layout.seed = document.get("seed").and_then(Value::as_u64).unwrap_or(0);
    for (number, feature) in features.into_iter().enumerate() {
        reader.feature(number, feature)?;
    }
    Ok(reader.finish())
}

/// What is read so far.
struct Reader<'a> {
    frame: &'a Frame,
    layout: Layout,
    /// (street, is its last end) of ends that named no junction.
    loose: Vec<(usize, bool)>,
    /// Tiles that are further polygons of one feature and need an id.
    spare: Vec<usize>,
}

fn fault(number: usize, what: &str) -> Error {
    Error::input(format!("feature {number} of the layout: {what}"))
}

fn text(properties: &Map<String, Value>, name: &str) -> Option<String> {
    properties
        .get(name)
        .and_then(Value::as_str)
        .map(str::to_owned)
}

fn real(properties: &Map<String, Value>, name: &str) -> Option<f64> {
    properties.get(name).and_then(Value::as_f64)
}

fn whole(properties: &Map<String, Value>, name: &str) -> Option<u64> {
    properties.get(name).and_then(Value::as_u64)
}

fn truth(properties: &Map<String, Value>, name: &str) -> bool {
    properties
        .get(name)
        .and_then(Value::as_bool)
        .unwrap_or(false)
}

impl Reader<'_> {
    fn feature(&mut self, number: usize, feature: &Value) -> Result<()> {
        let none = Map::new();
        let properties = feature
            .get("properties")
            .and_then(Value::as_object)
            .unwrap_or(&none);
        let Some(kind) = properties.get("kind").and_then(Value::as_str) else {
            return Ok(());
        };
        let geometry = || {
            let geometry = feature.get("geometry").and_then(Value::as_object);
            geometry.ok_or_else(|| fault(number, "it has no geometry"))
        };
        let id = || {
            whole(properties, "id")
                .ok_or_else(|| fault(number, "`id` must be an integer of its own"))
        };
        match kind {
            "site" => {
                let polygons = self.polygons(number, geometry()?)?;
                self.layout.site = MultiPolygon::new(polygons);
            }
            "block" => {
                let polygon = self.polygons(number, geometry()?)?.into_iter().next();
                let polygon = polygon.ok_or_else(|| fault(number, "a block is a Polygon"))?;
                let lineage = lineage(properties).unwrap_or_default();
                self.layout.blocks.push(Block {
                    id: id()?,
                    polygon,
                    lineage,
                });
            }
            "street" => {
                let line = self.line(number, geometry()?)?;
                self.street(id()?, line, properties);
            }
            "junction" => {
                let point = geometry()?
                    .get("coordinates")
                    .and_then(|c| self.position(c));
                let at = point.ok_or_else(|| fault(number, "a junction is a Point"))?;
                let degree = whole(properties, "degree")
                    .and_then(|d| usize::try_from(d).ok())
                    .unwrap_or(0);
                self.layout.junctions.push(Junction {
                    id: id()?,
                    at,
                    degree,
                });
            }
            other => {
                if let Some(kind) = TileKind::parse(other) {
                    let polygons = self.polygons(number, geometry()?)?;
                    self.tiles(kind, id()?, polygons, properties);
                }
            }
        }
        Ok(())
    }

    fn tiles(
        &mut self,
        kind: TileKind,
        id: u64,
        polygons: Vec<Polygon<f64>>,
        properties: &Map<String, Value>,
    ) {
        for (i, polygon) in polygons.into_iter().enumerate() {
            if i > 0 {
                self.spare.push(self.layout.tiles.len());
            }
            let parcel = (kind == TileKind::Parcel).then(|| {
                let (deviation, ratio) = measure_parcel(&polygon);
                ParcelInfo {
                    block: whole(properties, "block").unwrap_or(0),
                    template: text(properties, "template").unwrap_or_default(),
                    corner_deviation_deg: real(properties, "corner_deviation_deg")
                        .unwrap_or(deviation),
                    box_ratio: real(properties, "box_ratio").unwrap_or(ratio),
                    registration: real(properties, "registration_m"),
                    street_access: truth(properties, "street_access"),
                    access_exempt: truth(properties, "access_exempt"),
                    ideal_area: real(properties, "ideal_area_m2"),
                }
            });
            self.layout.tiles.push(Tile {
                id,
                kind,
                polygon,
                label: text(properties, "label"),
                parcel,
                lineage: lineage(properties),
                given: truth(properties, "given"),
            });
        }
    }

    fn street(&mut self, id: u64, line: LineString<f64>, properties: &Map<String, Value>) {
        let number = self.layout.streets.len();
        let (from, to) = (whole(properties, "from"), whole(properties, "to"));
        if from.is_none() {
            self.loose.push((number, false));
        }
        if to.is_none() {
            self.loose.push((number, true));
        }
        let class = properties
            .get("class")
            .and_then(Value::as_str)
            .and_then(RoadClass::parse);
        self.layout.streets.push(Street {
            id,
            line,
            class: class.unwrap_or(RoadClass::Local),
            width: real(properties, "width_m").unwrap_or(12.0),
            from: from.unwrap_or(u64::MAX),
            to: to.unwrap_or(u64::MAX),
            given: truth(properties, "given"),
            name: text(properties, "name"),
            lineage: lineage(properties),
        });
    }

    /// Gives loose street ends their junctions and further polygons their ids.
    fn finish(mut self) -> Layout {
        for (number, last) in self.loose {
            let street = &mut self.layout.streets[number];
            let end = if last {
                street.line.0.last()
            } else {
                street.line.0.first()
            };
            let near = |j: &&Junction| end.is_some_and(|end| distance(j.at, *end) <= SAME_PLACE);
            // A loose end is rare, so a search through all junctions will do.
            let Some(junction) = self.layout.junctions.iter().find(near) else {
                continue;
            };
            *(if last {
                &mut street.to
            } else {
                &mut street.from
            }) = junction.id;
        }
        let layout = &self.layout;
        let mut used: Vec<u64> = layout.tiles.iter().map(|t| t.id).collect();
        used.extend(layout.streets.iter().map(|s| s.id));
        used.extend(layout.junctions.iter().map(|j| j.id));
        used.extend(layout.blocks.iter().map(|b| b.id));
        used.sort_unstable();
        let mut free = (0..u64::MAX).filter(|id| used.binary_search(id).is_err());
        for (tile, id) in self.spare.iter().zip(&mut free) {
            self.layout.tiles[*tile].id = id;
        }
        self.layout
    }

    fn position(&self, value: &Value) -> Option<Coord<f64>> {
        let pair = value.as_array()?;
        let (x, y) = (pair.first()?.as_f64()?, pair.get(1)?.as_f64()?);
        Some(self.frame.to_local(Coord { x, y }))
    }

    fn path(&self, value: &Value) -> Option<LineString<f64>> {
        value
            .as_array()?
            .iter()
            .map(|c| self.position(c))
            .collect::<Option<Vec<_>>>()
            .map(LineString::new)
    }

    fn polygon(&self, value: &Value) -> Option<Polygon<f64>> {
        let mut rings = value
            .as_array()?
            .iter()
            .map(|ring| self.path(ring))
            .collect::<Option<Vec<_>>>()?
            .into_iter();
        let exterior = rings.next()?;
        Some(oriented(Polygon::new(exterior, rings.collect())))
    }

    fn line(&self, number: usize, geometry: &Map<String, Value>) -> Result<LineString<f64>> {
        let is_line = geometry.get("type").and_then(Value::as_str) == Some("LineString");
        let line = geometry
            .get("coordinates")
            .filter(|_| is_line)
            .and_then(|c| self.path(c));
        line.ok_or_else(|| fault(number, "a street is a LineString of numbers"))
    }

    fn polygons(&self, number: usize, geometry: &Map<String, Value>) -> Result<Vec<Polygon<f64>>> {
        let coordinates = geometry.get("coordinates");
        let polygons = match geometry.get("type").and_then(Value::as_str) {
            Some("Polygon") => coordinates.and_then(|c| self.polygon(c)).map(|p| vec![p]),
            Some("MultiPolygon") => coordinates
                .and_then(Value::as_array)
                .and_then(|list| list.iter().map(|p| self.polygon(p)).collect()),
            _ => None,
        };
        polygons.ok_or_else(|| {
            fault(
                number,
                "its geometry must be a Polygon or MultiPolygon of numbers",
            )
        })
    }
}

fn lineage(properties: &Map<String, Value>) -> Option<Lineage> {
    let scores = properties
        .get("scores")
        .and_then(Value::as_object)
        .and_then(|scores| {
            let score = |name| scores.get(name).and_then(Value::as_f64);
            Some([
                score("divergence")?,
                score("boundary")?,
                score("singularities")?,
                score("continuity")?,
            ])
        });
    Some(Lineage {
        split: text(properties, "split")?,
        by: text(properties, "by").unwrap_or_default(),
        field: text(properties, "field"),
        scores,
        energy: real(properties, "energy"),
        seed: whole(properties, "seed").unwrap_or(0),
    })
}
