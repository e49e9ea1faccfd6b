//! A site in metres of a map, anywhere on it.

use geo_types::{Coord, LineString, Polygon};
use serde_json::{json, Value};
use urban_layout::site::{GivenRoad, Site};

/// The site as GeoJSON in metres, its local origin at `origin`.
///
/// Local coordinates are rounded to 1/1024 m first: two copies whose origins are
/// whole metres below 2^42 are then equal but for an exact translation, and
/// whatever differs between their plans is the planner's doing.
#[must_use]
pub fn in_metres(site: &Site, origin: Coord<f64>) -> String {
    let place = |c: &Coord<f64>| {
        let on_grid = |v: f64| (v * 1024.0).round() / 1024.0;
        json!([on_grid(c.x) + origin.x, on_grid(c.y) + origin.y])
    };
    let line = |line: &LineString<f64>| Value::from_iter(line.0.iter().map(place));
    let rings = |polygon: &Polygon<f64>| {
        let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
        Value::from_iter(rings.map(line))
    };
    let feature = |properties: Value, kind: &str, coordinates: Value| {
        json!({
            "type": "Feature",
            "properties": properties,
            "geometry": { "type": kind, "coordinates": coordinates },
        })
    };
    let road = |kind: &str, road: &GivenRoad| {
        feature(
            json!({ "kind": kind, "class": road.class.as_str(), "width_m": road.width }),
            "LineString",
            line(&road.line),
        )
    };

    let parts = Value::from_iter(site.parts.iter().map(rings));
    let mut features = vec![feature(json!({ "kind": "site" }), "MultiPolygon", parts)];
    let inside = site.roads.iter().chain(&site.boundary_roads);
    features.extend(inside.map(|r| road("road", r)));
    features.extend(site.outside_streets.iter().map(|r| road("street", r)));
    features.extend(site.elements.iter().map(|element| {
        feature(
            json!({ "kind": element.kind.as_str() }),
            "Polygon",
            rings(&element.polygon),
        )
    }));
    json!({
        "type": "FeatureCollection",
        "coordinate_units": "metres",
        "features": features,
    })
    .to_string()
}
