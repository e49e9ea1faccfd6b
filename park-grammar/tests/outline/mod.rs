//! Outlines of parks from GeoJSON.

use std::error::Error;

use geojson::GeoJson;
use park_grammar::geo_types::{coord, LineString, Polygon};

/// The largest polygon of a GeoJSON text, degrees made metres around its first
/// corner.
pub(crate) fn outline(text: &str) -> Result<Polygon<f64>, Box<dyn Error>> {
    let polygons = match text.parse::<GeoJson>()? {
        GeoJson::Geometry(geometry) => vec![Some(geometry)],
        GeoJson::Feature(feature) => vec![feature.geometry],
        GeoJson::FeatureCollection(all) => all.features.into_iter().map(|f| f.geometry).collect(),
    };
    let polygons = polygons.into_iter().flatten();
    let mut polygons: Vec<Polygon<f64>> = polygons
        .filter_map(|geometry| Polygon::try_from(geometry).ok())
        .collect();
    let largest = |p: &Polygon<f64>| p.exterior().lines().map(|l| l.determinant()).sum::<f64>();
    polygons.sort_by(|a, b| largest(b).abs().total_cmp(&largest(a).abs()));
    let park = polygons.into_iter().next().ok_or("there is no polygon")?;
    let origin = *park
        .exterior()
        .coords()
        .next()
        .ok_or("there is no corner")?;
    let metres = 111_320.0;
    let ring = |ring: &LineString<f64>| -> LineString<f64> {
        let local = ring.coords().map(|c| {
            coord! {
                x: (c.x - origin.x) * metres * origin.y.to_radians().cos(),
                y: (c.y - origin.y) * metres,
            }
        });
        local.collect()
    };
    let holes = park.interiors().iter().map(ring).collect();
    Ok(Polygon::new(ring(park.exterior()), holes))
}
