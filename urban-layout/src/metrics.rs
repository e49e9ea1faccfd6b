//! The paper's quality metrics of a layout.
//!
//! Yang, Wang, Vouga and Wonka, "Urban Pattern: Layout Design by Hierarchical
//! Domain Splitting", 2013, section 7: land use, blocks, streets and parcels.
//! Everything is measured on the geometry, nothing taken from what the planner
//! noted, but for the distances to the ideal parcel that only it can know.

use serde_json::{json, Map, Value};

use crate::check::{frontages, CheckOptions, Exits, Network};
use crate::layout::plane::{length, polygon_area};
use crate::layout::{corner_deviations, is_undesirable, measure_parcel, Layout, TileKind};
use crate::site::Site;

/// Where the time went, in seconds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Seconds {
    /// Reading and cleaning the site.
    pub read: f64,
    /// Splitting regions and filling blocks.
    pub split: f64,
    /// Splitting that was undone again.
    pub backtrack: f64,
    /// Optimising the network and warping templates anew.
    pub optimize: f64,
    /// From start to end.
    pub total: f64,
    /// Further stages, each with its name, in order.
    pub others: Vec<(String, f64)>,
}

/// The figures of one layout, by the paper's symbols (section 7).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metrics {
    /// Land that streets take, per cent of the site.
    pub l_s: f64,
    /// Land in parcels, per cent.
    pub l_r: f64,
    /// Land in parks, per cent.
    pub l_p: f64,
    /// All other land, per cent.
    pub l_o: f64,
    /// Blocks per square kilometre.
    pub b_n: f64,
    /// Longest boundary of a block, metres; 0 without blocks.
    pub b_max: f64,
    /// Shortest boundary of a block, metres.
    pub b_min: f64,
    /// Mean boundary of the blocks, metres.
    pub b_avg: f64,
    /// Street length, kilometres per square kilometre.
    pub s_l: f64,
    /// Junctions of three or more street ends per square kilometre.
    pub s_i: f64,
    /// Dead ends per square kilometre: junctions of one street end that are no
    /// way out of the site.
    pub s_d: f64,
    /// Parcels per square kilometre.
    pub p_n: f64,
    /// Mean deviation of all parcels' corners from right angles, degrees.
    pub p_angle: f64,
    /// Mean ratio of a parcel's smallest enclosing rectangle to its area.
    pub p_area: f64,
    /// Mean area distortion against the undeformed template face,
    /// max(A / A0, A0 / A); `None` where no parcel has an ideal.
    pub p_ideal: Option<f64>,
    /// Root mean square registration distance to the undeformed template
    /// faces, metres; `None` where no parcel has one.
    pub p_similarity: Option<f64>,
    /// Number of parcels.
    pub parcels: usize,
    /// Parcels whose corners deviate by over 15 degrees on average or whose
    /// box ratio is over 1.2.
    pub undesirable: usize,
    /// Parcels without enough frontage, exempt ones included.
    pub without_access: usize,
    /// Area of the site, square kilometres.
    pub site_km2: f64,
    /// Seed of the plan.
    pub seed: u64,
    /// Where the time went, if the caller filled it in.
    pub seconds: Option<Seconds>,
}

/// Measures a layout on its site.
///
/// `without_access` asks for the frontage of [`CheckOptions::default`] (3 m);
/// use [`metrics_with`] for another. `seconds` is left for the caller.
///
/// # Units
///
/// Both in local metres of the same frame.
#[must_use]
pub fn metrics(layout: &Layout, site: &Site) -> Metrics {
    metrics_with(layout, site, CheckOptions::default().frontage)
}

/// [`metrics`] with another least frontage, metres.
#[must_use]
pub fn metrics_with(layout: &Layout, site: &Site, min_frontage: f64) -> Metrics {
    let area: f64 = site.parts.iter().map(polygon_area).sum();
    let km2 = area / 1e6;
    let share = |kind| 100.0 * layout.area_of(kind) / area;
    let (l_s, l_r, l_p) = (
        share(TileKind::StreetArea),
        share(TileKind::Parcel),
        share(TileKind::Park),
    );

    let around: Vec<f64> = layout
        .blocks
        .iter()
        .map(|b| length(&b.polygon.exterior().0))
        .collect();
    let exits = Exits::new(site);
    let network = Network::new(layout, &exits);
    let crossings = network
        .nodes
        .iter()
        .filter(|node| node.ends.len() > 2)
        .count();
    let street_m: f64 = layout.streets.iter().map(|s| length(&s.line.0)).sum();

    let (mut corners, mut ratios, mut ideals, mut squares) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut undesirable = 0;
    for tile in layout.parcels() {
        let (deviation, ratio) = measure_parcel(&tile.polygon);
        corners.extend(corner_deviations(&tile.polygon));
        ratios.push(ratio);
        undesirable += usize::from(is_undesirable(deviation, ratio));
        let Some(info) = &tile.parcel else { continue };
        let own = polygon_area(&tile.polygon);
        ideals.extend(
            info.ideal_area
                .filter(|a0| *a0 > 0.0 && own > 0.0)
                .map(|a0| (own / a0).max(a0 / own)),
        );
        squares.extend(info.registration.map(|d| d * d));
    }
    let exempt =
        |tile: &&crate::layout::Tile| tile.parcel.as_ref().is_some_and(|info| info.access_exempt);
    let without_access = layout
        .parcels()
        .zip(frontages(site, layout))
        .filter(|(tile, (_, metres))| exempt(tile) || *metres < min_frontage)
        .count();
    Metrics {
        l_s,
        l_r,
        l_p,
        l_o: 100.0 - l_s - l_r - l_p,
        b_n: around.len() as f64 / km2,
        b_max: around.iter().copied().fold(0.0, f64::max),
        b_min: around.iter().copied().reduce(f64::min).unwrap_or(0.0),
        b_avg: mean(&around).unwrap_or(0.0),
        s_l: street_m / 1000.0 / km2,
        s_i: crossings as f64 / km2,
        s_d: network.dead_ends(&exits) as f64 / km2,
        p_n: ratios.len() as f64 / km2,
        p_angle: mean(&corners).unwrap_or(0.0),
        p_area: mean(&ratios).unwrap_or(0.0),
        p_ideal: mean(&ideals),
        p_similarity: mean(&squares).map(f64::sqrt),
        parcels: ratios.len(),
        undesirable,
        without_access,
        site_km2: km2,
        seed: layout.seed,
        seconds: None,
    }
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// A figure for a file: to six decimals, `null` if it is no number.
pub(crate) fn rounded(value: f64) -> Value {
    json!((value * 1e6).round() / 1e6)
}

impl Metrics {
    /// The figures as JSON, keys being the paper's symbols.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let mut map = Map::new();
        let figures = [
            ("l_s", self.l_s),
            ("l_r", self.l_r),
            ("l_p", self.l_p),
            ("l_o", self.l_o),
            ("b_n", self.b_n),
            ("b_max", self.b_max),
            ("b_min", self.b_min),
            ("b_avg", self.b_avg),
            ("s_l", self.s_l),
            ("s_i", self.s_i),
            ("s_d", self.s_d),
            ("p_n", self.p_n),
            ("p_angle", self.p_angle),
            ("p_area", self.p_area),
        ];
        for (key, value) in figures {
            map.insert(key.to_owned(), rounded(value));
        }
        map.insert(
            "p_ideal".to_owned(),
            self.p_ideal.map_or(Value::Null, rounded),
        );
        map.insert(
            "p_similarity".to_owned(),
            self.p_similarity.map_or(Value::Null, rounded),
        );
        map.insert("parcels".to_owned(), json!(self.parcels));
        map.insert("undesirable".to_owned(), json!(self.undesirable));
        map.insert("without_access".to_owned(), json!(self.without_access));
        map.insert("site_km2".to_owned(), rounded(self.site_km2));
        map.insert("seed".to_owned(), json!(self.seed));
        if let Some(seconds) = &self.seconds {
            map.insert("seconds".to_owned(), seconds.to_json());
        }
        Value::Object(map)
    }
}

impl Seconds {
    /// One entry a stage, `total` last.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let mut map = Map::new();
        let stages = [
            ("read", self.read),
            ("split", self.split),
            ("backtrack", self.backtrack),
            ("optimize", self.optimize),
        ];
        for (key, value) in stages {
            map.insert(key.to_owned(), rounded(value));
        }
        for (key, value) in &self.others {
            map.insert(key.clone(), rounded(*value));
        }
        map.insert("total".to_owned(), rounded(self.total));
        Value::Object(map)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_null() {
        assert_eq!(rounded(f64::INFINITY), Value::Null);
        assert_eq!(rounded(1.234_567_89), json!(1.234568));
    }

    #[test]
    fn json_has_the_paper_s_symbols() {
        let seconds = Seconds {
            total: 2.5,
            others: vec![("write".to_owned(), 0.5)],
            ..Seconds::default()
        };
        let json = Metrics {
            parcels: 3,
            seconds: Some(seconds),
            ..Metrics::default()
        }
        .to_json();
        for key in [
            "l_s",
            "l_r",
            "l_p",
            "l_o",
            "b_n",
            "b_max",
            "b_min",
            "b_avg",
            "s_l",
            "s_i",
            "s_d",
            "p_n",
            "p_angle",
            "p_area",
            "p_ideal",
            "p_similarity",
            "parcels",
            "undesirable",
            "without_access",
            "site_km2",
            "seed",
        ] {
            assert!(json.get(key).is_some(), "{key}");
        }
        assert_eq!(json["seconds"]["total"], json!(2.5));
        assert_eq!(json["seconds"]["write"], json!(0.5));
    }
}
