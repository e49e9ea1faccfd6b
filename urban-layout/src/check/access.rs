//! Streets lie in the street area; parcels front on streets that lead out.

use geo_types::{Coord, Polygon};
use i_overlay::core::overlay_rule::OverlayRule;

use super::network::place;
use super::{CheckOptions, Exits, Findings, Network};
use crate::layout::plane::{
    crossing, distance, length, lerp, overlay, polygon_area, stretch_within, union_length, Segments,
};
use crate::layout::{Layout, TileKind};
use crate::site::Site;

/// A parcel's edge this near to the street area's edge fronts on it, metres.
const AT_STREET: f64 = 0.05;
/// How far beyond half its width a street outside gives access, metres.
const REACH: f64 = 6.0;
/// A centreline may leave the street area by this much, metres.
const OFF_PAVING: f64 = 0.1;

/// The street area in connected parts, and the edges of those parts that have
/// a street that leads out.
#[derive(Debug)]
pub(crate) struct Served {
    edges: Segments,
}

/// Length of a polyline inside each polygon of `index` (by number), and outside
/// all of them by more than [`OFF_PAVING`].
fn lengths(line: &[Coord<f64>], index: &Segments, inside: &mut [f64]) -> f64 {
    let mut outside = 0.0;
    for w in line.windows(2) {
        let mut cuts = vec![0.0, 1.0];
        let near = index.near(w[0], w[1], 0.0);
        cuts.extend(
            near.filter_map(|s| crossing(w[0], w[1], s.a, s.b))
                .map(|(t, _)| t),
        );
        cuts.sort_by(f64::total_cmp);
        for cut in cuts.windows(2) {
            let long = (cut[1] - cut[0]) * distance(w[0], w[1]);
            if long <= 0.0 {
                continue;
            }
            let middle = lerp(w[0], w[1], 0.5 * (cut[0] + cut[1]));
            let owners = index.containing(middle);
            if owners.is_empty() && !index.within(middle, OFF_PAVING) {
                outside += long;
            }
            for owner in owners {
                inside[owner] += long;
            }
        }
    }
    outside
}

/// The parts of the street area, and for each whether a street that leads out
/// runs in it; judges `paved` and `served_area`.
pub(crate) fn judge_streets(
    layout: &Layout,
    network: &Network<'_>,
    findings: &mut Findings,
) -> Served {
    let parts = street_parts(layout);
    let index = Segments::of_polygons(&parts);
    let mut faults = Vec::new();
    let mut used = vec![0.0; parts.len()];
    for street in &layout.streets {
        let mut inside = vec![0.0; parts.len()];
        let outside = lengths(&street.line.0, &index, &mut inside);
        if outside > 0.01 * length(&street.line.0) + 1.0 {
            faults.push(format!(
                "street {} runs {outside:.1} m outside the street area",
                street.id
            ));
        }
        if network.leads_out(street) {
            used.iter_mut()
                .zip(inside)
                .for_each(|(sum, add)| *sum += add);
        }
    }
    findings.none_of("paved", faults);
    let idle = |(part, used): (&Polygon<f64>, &f64)| *used <= 1.0 && polygon_area(part) > 1.0;
    let faults = parts
        .iter()
        .zip(&used)
        .filter(|pair| idle(*pair))
        .map(|(part, _)| {
            let at = part.exterior().0.first().copied().unwrap_or_default();
            format!(
                "{:.0} m2 of street area without a street that leads out, {}",
                polygon_area(part),
                place(at)
            )
        });
    findings.none_of("served_area", faults.collect());
    served(parts, &used)
}

fn street_parts(layout: &Layout) -> Vec<Polygon<f64>> {
    overlay(
        layout.tiles_of(TileKind::StreetArea).map(|t| &t.polygon),
        [],
        OverlayRule::Subject,
    )
}

fn served(parts: Vec<Polygon<f64>>, used: &[f64]) -> Served {
    let kept: Vec<Polygon<f64>> = parts
        .into_iter()
        .zip(used)
        .filter(|(_, used)| **used > 1.0)
        .map(|(part, _)| part)
        .collect();
    Served {
        edges: Segments::of_polygons(&kept),
    }
}

/// Stretches of the site's boundary that streets outside give access to.
fn outside_access(site: &Site) -> Segments {
    let ways = Segments::of_lines(site.outside_streets.iter().map(|s| s.line.0.as_slice()));
    let reach = |owner: usize| site.outside_streets[owner].width / 2.0 + REACH;
    let margin = (0..site.outside_streets.len())
        .map(reach)
        .fold(0.0, f64::max);
    let mut open: Vec<[Coord<f64>; 2]> = Vec::new();
    for edge in Segments::of_polygons(&site.parts).iter() {
        for way in ways.near(edge.a, edge.b, margin) {
            if let Some((from, to)) = stretch_within(edge.a, edge.b, way.a, way.b, reach(way.owner))
            {
                open.push([lerp(edge.a, edge.b, from), lerp(edge.a, edge.b, to)]);
            }
        }
    }
    Segments::of_lines(open.iter().map(|pair| pair.as_slice()))
}

/// Length of a polygon's exterior within [`AT_STREET`] of any of the edges.
fn frontage(polygon: &Polygon<f64>, edges: [&Segments; 2]) -> f64 {
    let mut sum = 0.0;
    let mut stretches = Vec::new();
    for w in polygon.exterior().0.windows(2) {
        stretches.clear();
        let near = edges
            .iter()
            .flat_map(|index| index.near(w[0], w[1], AT_STREET));
        stretches.extend(near.filter_map(|s| stretch_within(w[0], w[1], s.a, s.b, AT_STREET)));
        sum += union_length(&mut stretches) * distance(w[0], w[1]);
    }
    sum
}

/// Every parcel's frontage, metres, as (id, frontage) in the order of the
/// layout: the length of its outline within 5 cm of the part of the street area
/// whose streets lead out, or of the site's boundary where a street outside
/// gives access.
#[must_use]
pub fn frontages(site: &Site, layout: &Layout) -> Vec<(u64, f64)> {
    let network = Network::new(layout, &Exits::new(site));
    let parts = street_parts(layout);
    let index = Segments::of_polygons(&parts);
    let mut used = vec![0.0; parts.len()];
    for street in layout.streets.iter().filter(|s| network.leads_out(s)) {
        lengths(&street.line.0, &index, &mut used);
    }
    measure(site, layout, &served(parts, &used))
}

fn measure(site: &Site, layout: &Layout, served: &Served) -> Vec<(u64, f64)> {
    let outside = outside_access(site);
    layout
        .parcels()
        .map(|tile| (tile.id, frontage(&tile.polygon, [&served.edges, &outside])))
        .collect()
}

/// Judges `frontage` and `exempt`; the ids of exempt parcels and of those that
/// lack frontage.
pub(crate) fn judge_parcels(
    site: &Site,
    layout: &Layout,
    served: &Served,
    options: &CheckOptions,
    findings: &mut Findings,
) -> (Vec<u64>, Vec<u64>) {
    let (mut exempt, mut without, mut faults) = (Vec::new(), Vec::new(), Vec::new());
    let measured = measure(site, layout, served);
    let parcels = measured.len();
    for (tile, (id, metres)) in layout.parcels().zip(measured) {
        if tile.parcel.as_ref().is_some_and(|info| info.access_exempt) {
            exempt.push(id);
        } else if metres < options.frontage {
            without.push(id);
            let at = tile
                .polygon
                .exterior()
                .0
                .first()
                .copied()
                .unwrap_or_default();
            faults.push(format!(
                "parcel {id} has {metres:.2} m of frontage, {}",
                place(at)
            ));
        }
    }
    findings.none_of("frontage", faults);
    let listed = exempt
        .iter()
        .map(|id| format!("parcel {id} is exempt"))
        .collect();
    findings.at_most(
        "exempt",
        exempt.len() as f64,
        0.02 * parcels as f64 + 1.0,
        listed,
    );
    (exempt, without)
}
