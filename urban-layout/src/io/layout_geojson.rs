//! Layouts as GeoJSON: one feature a line, in the coordinates of the site's file.

mod read;

use std::fmt::Write as _;

use geo_types::{Coord, LineString, MultiPolygon, Polygon};

use super::coordinates::{collection, number, push_line, push_position};
use super::frame::Frame;
use crate::layout::plane::{polygon_area, rings};
use crate::layout::{Block, Junction, Layout, Lineage, ParcelInfo, Street, Tile, TileKind};

pub use read::read_layout;

/// Writes a layout as a GeoJSON FeatureCollection in the coordinates of the
/// frame's source: longitude and latitude, or metres (then the collection says
/// `"coordinate_units": "metres"`).
///
/// The order of features is: site, blocks, tiles, streets, junctions, each in the
/// order of the layout. The text depends on nothing but the layout and the
/// frame, byte by byte; vertices that tiles share are written alike. The site
/// feature takes the least id that no other feature has.
///
/// # Examples
///
/// ```
/// use geo_types::coord;
/// use urban_layout::io::frame::Frame;
/// use urban_layout::io::layout_geojson::layout_to_geojson;
/// use urban_layout::layout::Layout;
///
/// let text = layout_to_geojson(&Layout::default(), &Frame::metres(coord! { x: 0.0, y: 0.0 }));
/// assert!(text.starts_with(r#"{"type":"FeatureCollection","coordinate_units":"metres""#));
/// ```
#[must_use]
pub fn layout_to_geojson(layout: &Layout, frame: &Frame) -> String {
    let mut out = Writer {
        text: collection(frame),
        frame,
        empty: true,
    };
    let _ = write!(out.text, "\"seed\":{},\"features\":[", layout.seed);
    out.site(layout);
    layout.blocks.iter().for_each(|block| out.block(block));
    layout.tiles.iter().for_each(|tile| out.tile(tile));
    layout.streets.iter().for_each(|street| out.street(street));
    layout
        .junctions
        .iter()
        .for_each(|junction| out.junction(junction));
    out.text.push_str("\n]}\n");
    out.text
}

/// The least id that no feature uses.
fn free_id(layout: &Layout) -> u64 {
    let mut used: Vec<u64> = layout.tiles.iter().map(|t| t.id).collect();
    used.extend(layout.streets.iter().map(|s| s.id));
    used.extend(layout.junctions.iter().map(|j| j.id));
    used.extend(layout.blocks.iter().map(|b| b.id));
    used.sort_unstable();
    used.dedup();
    (0..)
        .zip(&used)
        .find(|(i, id)| i != *id)
        .map_or(used.len() as u64, |(i, _)| i)
}

/// A JSON string.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// The text as far as it is written.
struct Writer<'a> {
    text: String,
    frame: &'a Frame,
    empty: bool,
}

impl Writer<'_> {
    /// Opens a feature up to its first two properties.
    fn open(&mut self, kind: &str, id: u64) {
        self.text.push_str(if self.empty { "\n" } else { ",\n" });
        self.empty = false;
        let _ = write!(
            self.text,
            "{{\"type\":\"Feature\",\"properties\":{{\"kind\":\"{kind}\",\"id\":{id}"
        );
    }

    fn property(&mut self, name: &str, json: &str) {
        let _ = write!(self.text, ",\"{name}\":{json}");
    }

    fn optional(&mut self, name: &str, json: Option<String>) {
        if let Some(json) = json {
            self.property(name, &json);
        }
    }

    /// Opens the geometry after the properties.
    fn geometry(&mut self, kind: &str) {
        let _ = write!(
            self.text,
            "}},\"geometry\":{{\"type\":\"{kind}\",\"coordinates\":"
        );
    }

    fn close(&mut self) {
        self.text.push_str("}}");
    }

    fn position(&mut self, c: Coord<f64>) {
        push_position(&mut self.text, self.frame, c);
    }

    fn line(&mut self, line: &LineString<f64>) {
        push_line(&mut self.text, self.frame, line);
    }

    fn polygon(&mut self, polygon: &Polygon<f64>) {
        self.text.push('[');
        for (i, ring) in rings(polygon).enumerate() {
            if i > 0 {
                self.text.push(',');
            }
            self.line(ring);
        }
        self.text.push(']');
    }

    fn multi_polygon(&mut self, polygons: &MultiPolygon<f64>) {
        if let [single] = polygons.0.as_slice() {
            self.geometry("Polygon");
            self.polygon(single);
            return;
        }
        self.geometry("MultiPolygon");
        self.text.push('[');
        for (i, polygon) in polygons.iter().enumerate() {
            if i > 0 {
                self.text.push(',');
            }
            self.polygon(polygon);
        }
        self.text.push(']');
    }

    fn site(&mut self, layout: &Layout) {
        self.open("site", free_id(layout));
        self.property("area_m2", &number(layout.site_area(), 2));
        self.multi_polygon(&layout.site);
        self.close();
    }

    fn block(&mut self, block: &Block) {
        self.open("block", block.id);
        self.property("area_m2", &number(polygon_area(&block.polygon), 2));
        self.lineage(&block.lineage);
        self.geometry("Polygon");
        self.polygon(&block.polygon);
        self.close();
    }

    fn tile(&mut self, tile: &Tile) {
        self.open(tile.kind.as_str(), tile.id);
        if let Some(info) = &tile.parcel {
            self.property("block", &info.block.to_string());
            self.property("template", &quoted(&info.template));
        }
        if tile.kind != TileKind::StreetArea {
            self.property(
                "label",
                &tile
                    .label
                    .as_deref()
                    .map_or_else(|| "null".to_owned(), quoted),
            );
        }
        self.property("area_m2", &number(polygon_area(&tile.polygon), 2));
        if let Some(info) = &tile.parcel {
            self.parcel(info);
        }
        if tile.given {
            self.property("given", "true");
        }
        if let Some(lineage) = &tile.lineage {
            self.lineage(lineage);
        }
        self.geometry("Polygon");
        self.polygon(&tile.polygon);
        self.close();
    }

    fn parcel(&mut self, info: &ParcelInfo) {
        self.property(
            "corner_deviation_deg",
            &number(info.corner_deviation_deg, 4),
        );
        self.property("box_ratio", &number(info.box_ratio, 5));
        self.property(
            "registration_m",
            &info
                .registration
                .map_or_else(|| "null".to_owned(), |d| number(d, 4)),
        );
        self.property(
            "street_access",
            if info.street_access { "true" } else { "false" },
        );
        self.property(
            "access_exempt",
            if info.access_exempt { "true" } else { "false" },
        );
        self.optional("ideal_area_m2", info.ideal_area.map(|a| number(a, 3)));
    }

    fn street(&mut self, street: &Street) {
        self.open("street", street.id);
        self.property("class", &quoted(street.class.as_str()));
        self.property("width_m", &number(street.width, 3));
        self.property("from", &street.from.to_string());
        self.property("to", &street.to.to_string());
        self.property("given", if street.given { "true" } else { "false" });
        self.optional("name", street.name.as_deref().map(quoted));
        if let Some(lineage) = &street.lineage {
            self.lineage(lineage);
        }
        self.geometry("LineString");
        self.line(&street.line);
        self.close();
    }

    fn junction(&mut self, junction: &Junction) {
        self.open("junction", junction.id);
        self.property("degree", &junction.degree.to_string());
        self.geometry("Point");
        self.position(junction.at);
        self.close();
    }

    fn lineage(&mut self, lineage: &Lineage) {
        self.property("split", &quoted(&lineage.split));
        self.property("by", &quoted(&lineage.by));
        self.optional("field", lineage.field.as_deref().map(quoted));
        self.optional(
            "scores",
            lineage
                .scores
                .map(|[divergence, boundary, singularities, continuity]| {
                    format!(
                    "{{\"divergence\":{},\"boundary\":{},\"singularities\":{},\"continuity\":{}}}",
                    number(divergence, 6),
                    number(boundary, 6),
                    number(singularities, 6),
                    number(continuity, 6)
                )
                }),
        );
        self.optional("energy", lineage.energy.map(|e| number(e, 9)));
        self.property("seed", &lineage.seed.to_string());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_site_takes_the_least_free_id() {
        let mut layout = Layout::default();
        assert_eq!(free_id(&layout), 0);
        for id in [2, 0, 1, 5] {
            layout.junctions.push(Junction {
                id,
                at: Coord { x: 0.0, y: 0.0 },
                degree: 1,
            });
        }
        assert_eq!(free_id(&layout), 3);
    }
}
