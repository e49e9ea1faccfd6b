//! The tiles cover the site once: by area, and by counting edges.

use geo_types::{Coord, Polygon};
use i_overlay::core::overlay_rule::OverlayRule;

use super::network::place;
use super::valid::polygon_fault;
use super::Findings;
use crate::layout::plane::{area_outside, distance, lerp, overlay, polygon_area, rings, Segments};
use crate::layout::Layout;
use crate::site::Site;

/// Allowed overlap, gap and spill per area of the site: 20 m2 per km2, for the
/// rounding of projections and writers.
const AREA_TOLERANCE: f64 = 2e-5;
/// An edge on the site's boundary lies this near to it, metres.
const ON_BOUNDARY: f64 = 1e-3;

/// Judges `valid`, `overlap`, `gap`, `spill` and `twins`.
pub(crate) fn judge(site: &Site, layout: &Layout, findings: &mut Findings) {
    let mut faults = Vec::new();
    for tile in &layout.tiles {
        if let Some(fault) = polygon_fault(&tile.polygon) {
            faults.push(format!("the {} {}: {fault}", tile.kind.as_str(), tile.id));
        }
    }
    for block in &layout.blocks {
        if let Some(fault) = polygon_fault(&block.polygon) {
            faults.push(format!("the block {}: {fault}", block.id));
        }
    }
    findings.none_of("valid", faults);

    let tiles = || layout.tiles.iter().map(|tile| &tile.polygon);
    let whole = overlay(tiles(), [], OverlayRule::Subject);
    let land = |polygons: &[Polygon<f64>]| polygons.iter().map(polygon_area).sum::<f64>();
    let allowed = AREA_TOLERANCE * land(&site.parts);
    let overlap = tiles().map(polygon_area).sum::<f64>() - land(&whole);
    findings.at_most("overlap", overlap, allowed, Vec::new());
    findings.at_most(
        "gap",
        area_outside(&site.parts, &whole),
        allowed,
        Vec::new(),
    );
    findings.at_most(
        "spill",
        area_outside(&whole, &site.parts),
        allowed,
        Vec::new(),
    );
    findings.none_of("twins", lone_edges(site, layout));
}

/// A directed edge with its tile, keyed by its ends so that twins sort together.
struct Edge {
    key: [u64; 4],
    forward: bool,
    a: Coord<f64>,
    b: Coord<f64>,
    tile: usize,
}

/// Edges that do not have exactly one reverse in another tile and are not on
/// the site's boundary.
fn lone_edges(site: &Site, layout: &Layout) -> Vec<String> {
    let bits = |c: Coord<f64>| [(c.x + 0.0).to_bits(), (c.y + 0.0).to_bits()];
    let mut edges: Vec<Edge> = Vec::new();
    for (tile, t) in layout.tiles.iter().enumerate() {
        for w in rings(&t.polygon)
            .flat_map(|ring| ring.0.windows(2))
            .filter(|w| w[0] != w[1])
        {
            let (p, q) = (bits(w[0]), bits(w[1]));
            let forward = p < q;
            let (low, high) = if forward { (p, q) } else { (q, p) };
            edges.push(Edge {
                key: [low[0], low[1], high[0], high[1]],
                forward,
                a: w[0],
                b: w[1],
                tile,
            });
        }
    }
    edges.sort_by_key(|e| (e.key, e.forward, e.tile));
    let boundary = Segments::of_polygons(&site.parts);
    let mut lone: Vec<&Edge> = Vec::new();
    for run in edges.chunk_by(|p, q| p.key == q.key) {
        match run {
            [p, q] if p.forward != q.forward && p.tile != q.tile => {}
            [p] if on_boundary(&boundary, p.a, p.b) => {}
            others => lone.extend(others),
        }
    }
    lone.sort_by(|p, q| {
        distance(q.a, q.b)
            .total_cmp(&distance(p.a, p.b))
            .then(p.key.cmp(&q.key))
    });
    lone.into_iter()
        .map(|e| {
            let tile = &layout.tiles[e.tile];
            let (word, long) = (tile.kind.as_str(), distance(e.a, e.b));
            format!(
                "an edge of {long:.3} m of the {word} {} matches no neighbour, {}",
                tile.id,
                place(e.a)
            )
        })
        .collect()
}

/// Whether an edge runs along the site's boundary: its ends and points between
/// them, at least one for every 20 m.
fn on_boundary(boundary: &Segments, a: Coord<f64>, b: Coord<f64>) -> bool {
    let steps = (distance(a, b) / 20.0).ceil().clamp(2.0, 1000.0) as usize;
    (0..=steps).all(|i| boundary.within(lerp(a, b, i as f64 / steps as f64), ON_BOUNDARY))
}
