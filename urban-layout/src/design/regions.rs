//! The regions that a network is designed for: a site's parts, cut along the
//! roads that are given.

use geo_types::{Coord, LineString, Polygon};

use crate::error::Result;
use crate::network::Network;
use crate::plane::signed_area;
use crate::site::Site;

/// Smaller regions, square metres, are left as they are: the corners that roads
/// cut off.
const LEAST: f64 = 1.0;

/// The regions of a site, the given roads and the boundary their rims; key
/// elements are not cut out.
///
/// # Errors
///
/// Those of [`Network::new`].
pub(super) fn regions(site: &Site) -> Result<Vec<Polygon<f64>>> {
    if site.roads.is_empty() {
        return Ok(site.parts.clone());
    }
    let bare = Site {
        elements: Vec::new(),
        ..site.clone()
    };
    let network = Network::new(&bare)?;
    let mut regions = Vec::new();
    for face in network.mesh.faces() {
        if network.content(&bare, face).is_none() {
            continue;
        }
        let mut rings = network.rings(face).into_iter().map(without_spurs);
        let Some(outer) = rings.next() else { continue };
        let holes: Vec<LineString<f64>> = rings.filter(|r| r.len() > 2).map(LineString).collect();
        if signed_area(&outer).abs() >= LEAST {
            regions.push(Polygon::new(LineString(outer), holes));
        }
    }
    Ok(regions)
}

/// A region's area, square metres.
pub(super) fn area(region: &Polygon<f64>) -> f64 {
    let of = |ring: &LineString<f64>| signed_area(&ring.0[..ring.0.len().saturating_sub(1)]).abs();
    of(region.exterior()) - region.interiors().iter().map(of).sum::<f64>()
}

/// An open ring without the ways into it and back that a road makes which ends
/// in the open.
fn without_spurs(ring: Vec<Coord<f64>>) -> Vec<Coord<f64>> {
    let mut kept: Vec<Coord<f64>> = Vec::with_capacity(ring.len());
    for p in ring {
        kept.push(p);
        while kept.len() >= 3 && kept[kept.len() - 1] == kept[kept.len() - 3] {
            kept.truncate(kept.len() - 2);
        }
    }
    // A spur at the seam.
    while kept.len() >= 3 && kept[kept.len() - 1] == kept[1] {
        kept.pop();
        kept.remove(0);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::site::Units;

    fn square(roads: &str) -> Vec<Polygon<f64>> {
        let text = format!(
            r#"{{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
            {{"type": "Feature", "properties": {{"kind": "site"}}, "geometry": {{"type": "Polygon",
            "coordinates": [[[0, 0], [400, 0], [400, 400], [0, 400], [0, 0]]]}}}}{roads}]}}"#
        );
        let site = Site::from_geojson(&text, Units::Auto).expect("a site");
        regions(&site).expect("regions")
    }

    fn road(points: &str) -> String {
        format!(
            r#", {{"type": "Feature", "properties": {{"kind": "road"}}, "geometry":
            {{"type": "LineString", "coordinates": {points}}}}}"#
        )
    }

    #[test]
    fn roads_cut_a_site() {
        assert_eq!(square("").len(), 1);
        let cross = road("[[100, 0], [100, 400]]") + &road("[[0, 300], [400, 300]]");
        let mut areas: Vec<f64> = square(&cross).iter().map(area).collect();
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas.len(), 4);
        for (found, wanted) in areas.iter().zip([1e4, 3e4, 3e4, 9e4]) {
            assert!(
                (found - wanted).abs() < 1e-6 * wanted,
                "{found} of {wanted}"
            );
        }
    }

    #[test]
    fn spurs_are_cut_off() {
        let at = |x: f64, y: f64| Coord { x, y };
        let clean = vec![at(0., 0.), at(2., 0.), at(2., 2.), at(0., 2.)];
        let spur = vec![
            at(0., 0.),
            at(1., 0.),
            at(1., 1.),
            at(1., 0.),
            at(2., 0.),
            at(2., 2.),
            at(0., 2.),
        ];
        let mut wanted = clean.clone();
        wanted.insert(1, at(1., 0.));
        assert_eq!(without_spurs(spur), wanted);
        let seam = vec![
            at(1., 1.),
            at(0., 0.),
            at(2., 0.),
            at(2., 2.),
            at(0., 2.),
            at(0., 0.),
        ];
        assert_eq!(without_spurs(seam).len(), 4);
        assert_eq!(without_spurs(clean.clone()), clean);
    }
}
