//! Streamlines as GeoJSON: one feature a line, in the coordinates of the site's
//! file.

use std::fmt::Write as _;

use super::coordinates::{collection, number, push_line};
use super::frame::Frame;
use crate::streamlines::{stop_word, StreamlineStudy};

/// Writes the lines of a study as a GeoJSON FeatureCollection in the
/// coordinates of the frame's source: longitude and latitude, or metres (then
/// the collection says `"coordinate_units": "metres"`).
///
/// Every feature is a LineString with `id` (its position), `part` of the site,
/// `family` (0 or 1), how its ends came about (`end_start`, `end_stop`:
/// `boundary`, `neighbour`, `junction`, `singularity`, `closed_loop`,
/// `self_approach`, `length_limit` or `field_end`), `length_m`, and its own
/// criteria, `null` where there is nothing to compare with. A closed line
/// repeats its first point at the end.
#[must_use]
pub fn streamlines_to_geojson(study: &StreamlineStudy, frame: &Frame) -> String {
    let mut text = collection(frame);
    text.push_str("\"features\":[");
    let mut id = 0;
    for (index, part) in study.parts.iter().enumerate() {
        for (line, judged) in part.lines.iter().zip(&part.criteria.lines) {
            let optional = |value: Option<f64>, decimals: usize| {
                value.map_or_else(|| "null".to_owned(), |v| number(v, decimals))
            };
            let _ = write!(
                text,
                "{}\n{{\"type\":\"Feature\",\"properties\":{{\"kind\":\"streamline\",\"id\":{id},\"part\":{index},\
                 \"family\":{},\"end_start\":\"{}\",\"end_stop\":\"{}\",\"length_m\":{},\"divergence\":{},\"turns\":{},\
                 \"parallelism\":{},\"perpendicularity\":{}}},\"geometry\":{{\"type\":\"LineString\",\"coordinates\":",
                if id == 0 { "" } else { "," },
                line.family,
                stop_word(line.start),
                stop_word(line.end),
                number(judged.length, 3),
                optional(judged.divergence, 9),
                judged.turns,
                optional(judged.parallelism, 6),
                optional(judged.perpendicularity, 6),
            );
            push_line(&mut text, frame, &line.to_line_string());
            text.push_str("}}");
            id += 1;
        }
    }
    text.push_str("\n]}\n");
    text
}
