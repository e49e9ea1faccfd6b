//! Parks as GeoJSON: one feature a line, in the coordinates of the park's file.

use std::fmt::Write as _;

use geo_types::{Coord, LineString, Polygon};
use park_grammar::scene::{Ground, Object, Piece, Volume};
use park_grammar::Scene;

use super::coordinates::{collection, number, push_finer};
use super::frame::Frame;
use crate::layout::plane::rings;
use crate::layout::Layout;
use crate::park::ParkStudy;
use crate::site::boolean::area;

/// Decimals beyond those of a plan: a corner in the middle of a side of the park
/// stays on that to 1e-9 of its length.
const MORE: usize = 3;

/// Writes a park as a GeoJSON FeatureCollection in the coordinates of the frame's
/// source: longitude and latitude, or metres (then the collection says
/// `"coordinate_units": "metres"`).
///
/// Every feature has `kind` and `id`, an integer that no other has. Polygons of
/// the kinds `region` and `path` tile the park (`material`, `rule`, `area_m2`); a
/// corner on a neighbour's side is a corner of both. Points of the kind `object`
/// are things (`name`, `radius_m` of the footprint, `spread_m` of what reaches
/// farther above the ground, `height_m`, `rotation_deg` counter-clockwise from
/// east, `on`: `region` or `path`). Polygons of the kind `volume` are hedges and
/// walls, on top of the others (`name`, `height_m`). Where the land has several
/// parts, each feature says of which `part` it is.
#[must_use]
pub fn park_to_geojson(study: &ParkStudy, frame: &Frame) -> String {
    let about = format!(
        "\"grammar\":{},\"seed\":{},",
        quoted(&study.grammar),
        study.seed
    );
    let mut writer = Writer::new(frame, &about);
    for (k, part) in study.parts.iter().enumerate() {
        if study.parts.len() > 1 {
            writer.of = format!(",\"part\":{k}");
        }
        writer.scene(&part.scene);
    }
    writer.finish()
}

/// Writes the designs of a layout's parks as one FeatureCollection, as
/// [`park_to_geojson`] does; each feature says in `park` on which tile of the
/// layout it stands, and by which `grammar`.
#[must_use]
pub fn parks_to_geojson(layout: &Layout, frame: &Frame) -> String {
    let mut writer = Writer::new(frame, &format!("\"seed\":{},", layout.seed));
    for design in &layout.parks {
        writer.of = format!(
            ",\"park\":{},\"grammar\":{}",
            design.tile,
            quoted(&design.grammar)
        );
        writer.scene(&design.scene);
    }
    writer.finish()
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

const fn word(ground: Ground) -> &'static str {
    match ground {
        Ground::Region => "region",
        Ground::Path => "path",
    }
}

struct Writer<'f> {
    text: String,
    frame: &'f Frame,
    id: usize,
    /// What every feature says of the park that it is part of.
    of: String,
}

impl<'f> Writer<'f> {
    fn new(frame: &'f Frame, about: &str) -> Self {
        let mut text = collection(frame);
        text.push_str(about);
        text.push_str("\"features\":[");
        Self {
            text,
            frame,
            id: 0,
            of: String::new(),
        }
    }

    fn finish(mut self) -> String {
        self.text.push_str("\n]}\n");
        self.text
    }

    fn scene(&mut self, scene: &Scene) {
        scene.pieces.iter().for_each(|piece| self.piece(piece));
        scene.volumes.iter().for_each(|volume| self.volume(volume));
        scene.objects.iter().for_each(|object| self.object(object));
    }

    fn open(&mut self, kind: &str) {
        let comma = if self.id == 0 { "" } else { "," };
        let _ = write!(
            self.text,
            "{comma}\n{{\"type\":\"Feature\",\"properties\":{{\"kind\":\"{kind}\",\"id\":{}",
            self.id
        );
        self.text.push_str(&self.of);
        self.id += 1;
    }

    fn piece(&mut self, piece: &Piece) {
        self.open(word(piece.ground));
        let _ = write!(
            self.text,
            ",\"material\":{},\"rule\":{},\"area_m2\":{}",
            quoted(&piece.material),
            quoted(&piece.rule),
            number(area(&piece.polygon), 3)
        );
        self.polygon(&piece.polygon);
    }

    fn volume(&mut self, volume: &Volume) {
        self.open("volume");
        let _ = write!(
            self.text,
            ",\"name\":{},\"height_m\":{}",
            quoted(&volume.name),
            number(volume.height, 3)
        );
        self.polygon(&volume.polygon);
    }

    fn object(&mut self, object: &Object) {
        self.open("object");
        let _ = write!(
            self.text,
            ",\"name\":{},\"radius_m\":{},\"spread_m\":{},\"height_m\":{},\"rotation_deg\":{},\"on\":\"{}\"\
             }},\"geometry\":{{\"type\":\"Point\",\"coordinates\":",
            quoted(&object.name),
            number(object.radius, 4),
            number(object.spread, 4),
            number(object.height, 3),
            number(object.facing.to_degrees().rem_euclid(360.0), 3),
            word(object.ground),
        );
        self.position(object.at);
        self.text.push_str("}}");
    }

    fn polygon(&mut self, polygon: &Polygon<f64>) {
        self.text
            .push_str("},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[");
        for (k, ring) in rings(polygon).enumerate() {
            self.text.push_str(if k == 0 { "" } else { "," });
            self.ring(ring);
        }
        self.text.push_str("]}}");
    }

    fn ring(&mut self, ring: &LineString<f64>) {
        self.text.push('[');
        for (k, c) in ring.0.iter().enumerate() {
            self.text.push_str(if k == 0 { "" } else { "," });
            self.position(*c);
        }
        self.text.push(']');
    }

    fn position(&mut self, c: Coord<f64>) {
        push_finer(&mut self.text, self.frame, c, MORE);
    }
}
