//! A designed street network as GeoJSON: one feature a street, in the
//! coordinates of the site's file.

use std::fmt::Write as _;

use super::coordinates::{collection, number, push_line, push_position};
use super::frame::Frame;
use crate::design::NetworkStudy;

/// Writes the streets of a study as a GeoJSON FeatureCollection in the
/// coordinates of the frame's source: longitude and latitude, or metres (then
/// the collection says `"coordinate_units": "metres"`).
///
/// Every feature is a LineString with `id` (its position), `part` of the site,
/// `class`, `level` (0 for the widest), `width_m`, `speed_kmh`, `length_m` and
/// `one_way`: a one-way street runs in its direction. A ring repeats its first
/// point at the end. After the streets come the sinks that were placed, if any:
/// Points of the kind `sink` with `id`, `part` and `level`.
#[must_use]
pub fn network_to_geojson(study: &NetworkStudy, frame: &Frame) -> String {
    let mut text = collection(frame);
    text.push_str("\"features\":[");
    let mut id = 0;
    for (index, part) in study.parts.iter().enumerate() {
        for street in &part.streets {
            let level = &study.spec.level[street.level];
            let class = serde_json::Value::from(level.class.as_str());
            let _ = write!(
                text,
                "{}\n{{\"type\":\"Feature\",\"properties\":{{\"kind\":\"street\",\"id\":{id},\"part\":{index},\
                 \"class\":{class},\"level\":{},\"width_m\":{},\"speed_kmh\":{},\"length_m\":{},\
                 \"one_way\":{}}},\
                 \"geometry\":{{\"type\":\"LineString\",\"coordinates\":",
                if id == 0 { "" } else { "," },
                street.level,
                number(level.width, 3),
                number(level.speed(), 2),
                number(crate::plane::length(&street.line.0), 3),
                street.one_way,
            );
            push_line(&mut text, frame, &street.line);
            text.push_str("}}");
            id += 1;
        }
    }
    for (part, level, place) in study.placed_sinks() {
        let _ = write!(
            text,
            "{}\n{{\"type\":\"Feature\",\"properties\":{{\"kind\":\"sink\",\"id\":{id},\"part\":{part},\
             \"level\":{level}}},\"geometry\":{{\"type\":\"Point\",\"coordinates\":",
            if id == 0 { "" } else { "," },
        );
        push_position(&mut text, frame, place);
        text.push_str("}}");
        id += 1;
    }
    text.push_str("\n]}\n");
    text
}
