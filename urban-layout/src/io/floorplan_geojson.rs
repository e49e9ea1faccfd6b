//! Floorplans as GeoJSON, in the coordinates of the building's file.

use std::fmt::Write as _;

use geo_types::{Coord, Polygon};

use super::coordinates::{collection, number, push_line, push_position};
use super::frame::Frame;
use crate::floorplan::draw::DrawnRoom;
use crate::floorplan::FloorplanStudy;

/// Writes all storeys of a study as one FeatureCollection in the coordinates of
/// the frame's source: longitude and latitude, or metres (then the collection
/// says `"coordinate_units": "metres"`).
///
/// Every feature has `id` (its position), `storey` (0 for the ground floor),
/// `storey_name` and `kind`: `room` (Polygon: `name`, `area_m2`, `window`,
/// `door_m` along corridors to an entrance or shaft), `corridor` (Polygon:
/// `width_m`, `area_m2`), `shaft` (Polygon: `name`, `area_m2`), `obstacle`
/// (Polygon: `name`, `open`, `area_m2`), which tile the floor; `door` (Point:
/// `of`, the id of its room or shaft, `width_m`) and `entrance` (Point).
#[must_use]
pub fn floorplan_to_geojson(study: &FloorplanStudy, frame: &Frame) -> String {
    let mut text = collection(frame);
    text.push_str("\"features\":[");
    let mut writer = Writer {
        text,
        frame,
        id: 0,
        storey: String::new(),
    };
    for (k, (storey, drawing)) in study.storeys.iter().zip(&study.drawings).enumerate() {
        writer.storey = format!(
            "\"storey\":{k},\"storey_name\":{}",
            quoted(&storey.specification.name)
        );
        for (kind, rooms) in [("room", &drawing.rooms), ("shaft", &drawing.shafts)] {
            for room in rooms {
                writer.room(kind, room);
            }
        }
        for corridor in &drawing.corridors {
            let words = format!(
                "\"width_m\":{},\"area_m2\":{}",
                number(study.spec.corridor_width, 3),
                number(area(corridor), 3)
            );
            writer.polygon("corridor", &words, corridor);
        }
        for (name, open, pieces) in &drawing.obstacles {
            for piece in pieces {
                let words = format!(
                    "\"name\":{},\"open\":{open},\"area_m2\":{}",
                    quoted(name),
                    number(area(piece), 3)
                );
                writer.polygon("obstacle", &words, piece);
            }
        }
        for (at, _) in &drawing.entrances {
            writer.point("entrance", "", *at);
        }
    }
    writer.text.push_str("\n]}\n");
    writer.text
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn area(polygon: &Polygon<f64>) -> f64 {
    crate::site::boolean::area(polygon)
}

struct Writer<'a> {
    text: String,
    frame: &'a Frame,
    id: usize,
    storey: String,
}

impl Writer<'_> {
    fn open(&mut self, kind: &str, words: &str) {
        let comma = if self.id == 0 { "" } else { "," };
        let more = if words.is_empty() { "" } else { "," };
        let _ = write!(
            self.text,
            "{comma}\n{{\"type\":\"Feature\",\"properties\":{{\"kind\":\"{kind}\",\"id\":{},{}{more}{words}}},\"geometry\":",
            self.id, self.storey
        );
        self.id += 1;
    }

    fn polygon(&mut self, kind: &str, words: &str, polygon: &Polygon<f64>) {
        self.open(kind, words);
        self.text
            .push_str("{\"type\":\"Polygon\",\"coordinates\":[");
        let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
        for (k, ring) in rings.enumerate() {
            self.text.push_str(if k == 0 { "" } else { "," });
            push_line(&mut self.text, self.frame, ring);
        }
        self.text.push_str("]}}");
    }

    fn point(&mut self, kind: &str, words: &str, at: Coord<f64>) {
        self.open(kind, words);
        self.text.push_str("{\"type\":\"Point\",\"coordinates\":");
        push_position(&mut self.text, self.frame, at);
        self.text.push_str("}}");
    }

    fn room(&mut self, kind: &str, room: &DrawnRoom) {
        let id = self.id;
        let mut words = format!(
            "\"name\":{},\"area_m2\":{}",
            quoted(&room.name),
            number(room.area, 3)
        );
        if kind == "room" {
            let _ = write!(words, ",\"window\":{}", room.window);
        }
        if let Some(door) = &room.door {
            let _ = write!(words, ",\"door_m\":{}", number(door.away, 2));
        }
        self.polygon(kind, &words, &room.outline);
        if let Some(door) = &room.door {
            let words = format!("\"of\":{id},\"width_m\":{}", number(door.width, 3));
            self.point("door", &words, door.at);
        }
    }
}
