//! From the search's end state to a [`Layout`]: tiles that share their
//! vertices, streets between junctions, blocks.

use std::collections::{BTreeMap, BTreeSet};

use geo_types::{Coord, LineString, MultiPolygon, Polygon};
use network_opt::{HalfEdgeId, VertexId};

use crate::inset::{boolean, clean_ring, inset, without_parts, Shapes};
use crate::layout::{
    measure_parcel, seam_to, Block, Junction, Layout, Lineage, ParcelInfo, Street, Tile, TileKind,
};
use crate::network::{Network, SideKind, StreetInfo};
use crate::plane::{at, dist, nearest_on, signed_area, turn};
use crate::planner::seed::{mix, Path};
use crate::planner::{Leaf, Tree};
use crate::region::Region;
use crate::site::{ElementKind, RoadClass, Site};
use crate::splitter::FaceUse;
use i_overlay::core::overlay_rule::OverlayRule;

pub(crate) mod outline;

/// Vertices closer than this become one, metres.
const SEAM: f64 = 2e-4;
/// Street land in pieces smaller than this goes to a neighbour by the seam, square metres.
const CRUMB: f64 = 0.05;
/// By how much the land of streets may differ from what it should be, square
/// metres: hairs along the boundary are less, a block that was lost is more.
const AMISS: f64 = 1.0;

/// Unique ids that depend on the split path alone, below 2^53 so that they
/// survive readers that keep numbers as doubles.
#[derive(Debug, Default)]
struct Ids(BTreeSet<u64>);

impl Ids {
    fn next(&mut self, root: u64, index: usize) -> u64 {
        let mut id = mix(root ^ mix(index as u64)) >> 11;
        while id == 0 || !self.0.insert(id) {
            id = mix(id) >> 11;
        }
        id
    }
}

/// A street inside a block, joined to the network at a vertex.
#[derive(Clone, Debug)]
struct Spur {
    from: VertexId,
    points: Vec<Coord<f64>>,
    lineage: Lineage,
}

/// The layout of a finished tree.
pub(crate) fn assemble(
    tree: &Tree,
    site: &Site,
    seed: u64,
    street_width: f64,
    min_frontage: f64,
) -> Layout {
    let mut network = tree.network.clone();
    let spurs = join_spurs(&mut network, tree);
    let mut ids = Ids::default();
    let mut layout = Layout {
        site: MultiPolygon(site.parts.clone()),
        seed,
        ..Layout::default()
    };
    let mut built: Shapes = Vec::new();
    for leaf in tree.leaves.values() {
        let region = Region::new(&tree.network, leaf.face, leaf.path.clone(), seed);
        block_of(&mut layout, &mut ids, &mut built, leaf, &region);
    }
    elements(&mut layout, &mut ids, &mut built, site);
    street_area(&mut layout, &built, site);
    sew(&mut layout, &mut ids);
    streets(&mut layout, &mut ids, &network, &spurs, street_width);
    measure(&mut layout, site, min_frontage);
    layout
}

/// The tiles of one leaf, and its blocks.
fn block_of(layout: &mut Layout, ids: &mut Ids, built: &mut Shapes, leaf: &Leaf, region: &Region) {
    let root = leaf.path.hash(0);
    let plots = inset(region);
    let mut blocks = Vec::new();
    for (k, plot) in plots.iter().enumerate() {
        let id = ids.next(root, 1_000_000 + k);
        blocks.push(id);
        let polygon = polygon_of(&plot.rings);
        layout.blocks.push(Block {
            id,
            polygon,
            lineage: leaf.lineage.clone(),
        });
    }
    let mut faces = leaf.fill.faces.clone();
    if faces.is_empty() {
        // Nothing fills this land: it stays open.
        faces = plots
            .iter()
            .flat_map(|p| p.without_holes(region))
            .filter_map(|p| p.rings.into_iter().next())
            .map(|ring| crate::splitter::FillFace::plain(ring, FaceUse::Park))
            .collect();
    }
    for (k, face) in faces.into_iter().enumerate() {
        let kind = match face.use_ {
            FaceUse::Parcel => TileKind::Parcel,
            FaceUse::Park => TileKind::Park,
            FaceUse::Other => TileKind::Other,
            FaceUse::Street => continue,
        };
        built.push(vec![face.ring.iter().map(|p| [p.x, p.y]).collect()]);
        let parcel = (kind == TileKind::Parcel).then(|| ParcelInfo {
            block: block_with(&plots, &blocks, &face.ring),
            template: leaf.fill.template.clone(),
            registration: face.registration,
            ideal_area: face.ideal_area,
            access_exempt: face.access_exempt,
            ..ParcelInfo::default()
        });
        layout.tiles.push(Tile {
            id: ids.next(root, k),
            kind,
            polygon: polygon_of(&[face.ring]),
            label: None,
            parcel,
            lineage: Some(leaf.lineage.clone()),
            given: false,
        });
    }
}

/// The block that a face lies in.
fn block_with(plots: &[crate::inset::Plot], blocks: &[u64], ring: &[Coord<f64>]) -> u64 {
    let Some(p) = crate::plane::inner_point(&[ring.to_vec()]) else {
        return blocks.first().copied().unwrap_or(0);
    };
    plots
        .iter()
        .position(|plot| crate::plane::in_ring(&plot.rings[0], p))
        .and_then(|i| blocks.get(i))
        .or(blocks.first())
        .copied()
        .unwrap_or(0)
}

/// The site's key elements, kept as they are.
fn elements(layout: &mut Layout, ids: &mut Ids, built: &mut Shapes, site: &Site) {
    for (k, element) in site.elements.iter().enumerate() {
        let kind = match element.kind {
            ElementKind::Lake => TileKind::Lake,
            ElementKind::Park => TileKind::Park,
            ElementKind::Landmark => TileKind::Landmark,
            ElementKind::Commercial => TileKind::Commercial,
            ElementKind::Reserved => TileKind::Reserved,
        };
        built.push(shape_of(&element.polygon));
        layout.tiles.push(Tile {
            id: ids.next(mix(0xe1e), k),
            kind,
            polygon: element.polygon.clone(),
            label: element.label.clone(),
            parcel: None,
            lineage: None,
            given: true,
        });
    }
}

/// What is neither built on nor given is street.
fn street_area(layout: &mut Layout, built: &Shapes, site: &Site) {
    let subject: Shapes = site.parts.iter().map(shape_of).collect();
    // Parcels first become whole blocks, so that no hair is left between two.
    let clip: Vec<Vec<[f64; 2]>> = boolean(built, &[], OverlayRule::Subject)
        .into_iter()
        .flatten()
        .collect();
    for shape in without_parts(&subject, &clip, AMISS) {
        let rings: Vec<Vec<Coord<f64>>> = shape
            .iter()
            .map(|r| clean_ring(&r.iter().map(|p| at(p[0], p[1])).collect::<Vec<_>>()))
            .filter(|r| r.len() >= 3 && signed_area(r).abs() > 1e-3)
            .collect();
        if rings.is_empty() || rings.iter().map(|r| signed_area(r)).sum::<f64>() < CRUMB {
            continue;
        }
        layout.tiles.push(street_tile(polygon_of(&rings)));
    }
}

/// Makes neighbouring tiles share vertices; drops what has no area.
fn sew(layout: &mut Layout, ids: &mut Ids) {
    let (paved, built): (Vec<Tile>, Vec<Tile>) = std::mem::take(&mut layout.tiles)
        .into_iter()
        .partition(|t| t.kind == TileKind::StreetArea);
    let mut polygons: Vec<Polygon<f64>> = built.iter().map(|t| t.polygon.clone()).collect();
    // The streets' land ring by ring: where its rings come to touch, they are
    // linked anew below.
    let mut is_hole = Vec::new();
    for tile in &paved {
        polygons.push(Polygon::new(tile.polygon.exterior().clone(), Vec::new()));
        is_hole.push(false);
        for hole in tile.polygon.interiors() {
            polygons.push(Polygon::new(reversed(hole), Vec::new()));
            is_hole.push(true);
        }
    }
    let report = seam_to(&mut polygons, &layout.site, SEAM);
    let gone: BTreeSet<usize> = report.collapsed.into_iter().collect();
    let rings = polygons.split_off(built.len());
    // Where a tile is thinner than the tolerance, its sides meet and it falls
    // apart: the largest piece goes on as the tile, the rest is open land.
    let mut scraps = Vec::new();
    for (number, pieces) in report.pieces {
        let Some(tile) = built.get(number) else {
            continue;
        };
        for (k, polygon) in pieces.into_iter().enumerate() {
            if k == 0 {
                polygons[number] = polygon;
            } else {
                scraps.push(scrap_of(tile, polygon, ids.next(mix(tile.id), k)));
            }
        }
    }
    layout.tiles = built
        .into_iter()
        .zip(polygons)
        .enumerate()
        .filter(|(i, _)| !gone.contains(i))
        .map(|(_, (tile, polygon))| Tile { polygon, ..tile })
        .chain(scraps)
        .collect();
    let directed: Vec<Polygon<f64>> = rings
        .into_iter()
        .zip(is_hole)
        .map(|(ring, hole)| {
            let flip = |r: &LineString<f64>| if hole { reversed(r) } else { r.clone() };
            Polygon::new(
                flip(ring.exterior()),
                ring.interiors().iter().map(flip).collect(),
            )
        })
        .collect();
    for (k, polygon) in outline::without_hairs(directed.iter())
        .into_iter()
        .enumerate()
    {
        layout.tiles.push(Tile {
            id: ids.next(mix(0x57ee7), k),
            ..street_tile(polygon)
        });
    }
}

/// A piece that fell off a tile: of the tile's kind, but no parcel, since its
/// front, if it has one, is no wider than the tolerance where it broke off.
fn scrap_of(tile: &Tile, polygon: Polygon<f64>, id: u64) -> Tile {
    let kind = match tile.kind {
        TileKind::Parcel => TileKind::Park,
        kind => kind,
    };
    Tile {
        id,
        kind,
        polygon,
        parcel: None,
        ..tile.clone()
    }
}

fn reversed(ring: &LineString<f64>) -> LineString<f64> {
    LineString(ring.0.iter().rev().copied().collect())
}

fn street_tile(polygon: Polygon<f64>) -> Tile {
    Tile {
        id: 0,
        kind: TileKind::StreetArea,
        polygon,
        label: None,
        parcel: None,
        lineage: None,
        given: false,
    }
}

/// Joins the streets inside blocks to the centrelines of the network.
fn join_spurs(network: &mut Network, tree: &Tree) -> Vec<Spur> {
    let mut out = Vec::new();
    for leaf in tree.leaves.values() {
        for line in &leaf.fill.streets {
            let Some(&start) = line.0.first() else {
                continue;
            };
            let mut best: Option<(f64, HalfEdgeId, Coord<f64>)> = None;
            for h in network
                .mesh
                .loops(leaf.face)
                .into_iter()
                .flat_map(|l| network.mesh.walk(l).collect::<Vec<_>>())
            {
                if !network.mesh.attr(h).access || network.mesh.attr(h).kind != SideKind::Street {
                    continue;
                }
                let p = nearest_on(
                    network.mesh.point(network.mesh.origin(h)),
                    network.mesh.point(network.mesh.dest(h)),
                    start,
                )
                .0;
                if best.is_none_or(|b| dist(p, start) < b.0) {
                    best = Some((dist(p, start), h, p));
                }
            }
            let Some((_, h, p)) = best else { continue };
            let near = [network.mesh.origin(h), network.mesh.dest(h)]
                .into_iter()
                .find(|&v| dist(network.mesh.point(v), p) < 0.5);
            let from = match near {
                Some(v) => v,
                None => match network.mesh.split_edge(h, p) {
                    Ok(v) => v,
                    Err(_) => continue,
                },
            };
            let mut points = vec![network.mesh.point(from)];
            points.extend(line.0.iter().copied());
            out.push(Spur {
                from,
                points,
                lineage: leaf.lineage.clone(),
            });
        }
    }
    out
}

/// The streets between junctions.
fn streets(
    layout: &mut Layout,
    ids: &mut Ids,
    network: &Network,
    spurs: &[Spur],
    street_width: f64,
) {
    let mesh = &network.mesh;
    let mut degree: BTreeMap<VertexId, usize> = BTreeMap::new();
    let mut lines: Vec<(Vec<VertexId>, u32)> = Vec::new();
    let spur_starts: BTreeSet<VertexId> = spurs.iter().map(|s| s.from).collect();
    let is_street = |h: HalfEdgeId| mesh.attr(h).kind == SideKind::Street;
    let ends_chain = |v: VertexId| {
        let at_v = network.streets_at(v);
        at_v.len() != 2 || spur_starts.contains(&v) || !same_street(network, at_v[0], at_v[1])
    };
    let mut used: BTreeSet<HalfEdgeId> = BTreeSet::new();
    let mut trace = |start: HalfEdgeId, used: &mut BTreeSet<HalfEdgeId>| {
        let mut chain = vec![mesh.origin(start)];
        let mut h = start;
        loop {
            used.insert(h);
            used.insert(mesh.twin(h));
            let v = mesh.dest(h);
            chain.push(v);
            if v == chain[0] || ends_chain(v) {
                break;
            }
            let Some(on) = network
                .streets_at(v)
                .into_iter()
                .find(|&o| o != mesh.twin(h))
            else {
                break;
            };
            h = on;
        }
        lines.push((chain, mesh.attr(start).street.unwrap_or(0)));
    };
    for h in mesh.half_edges() {
        if is_street(h) && !used.contains(&h) && ends_chain(mesh.origin(h)) {
            trace(h, &mut used);
        }
    }
    for h in mesh.half_edges() {
        if is_street(h) && !used.contains(&h) {
            trace(h, &mut used);
        }
    }
    for (chain, _) in &lines {
        *degree.entry(chain[0]).or_default() += 1;
        *degree.entry(chain[chain.len() - 1]).or_default() += 1;
    }
    for spur in spurs {
        *degree.entry(spur.from).or_default() += 1;
    }
    let mut junction_ids: BTreeMap<VertexId, u64> = BTreeMap::new();
    for (&v, &degree) in &degree {
        let at = mesh.point(v);
        // By place, so that a junction keeps its id when others come or go.
        let id = ids.next(place_hash(at), 0);
        junction_ids.insert(v, id);
        layout.junctions.push(Junction { id, at, degree });
    }
    let mut pieces: BTreeMap<u64, usize> = BTreeMap::new();
    for (chain, street) in lines {
        let Some(info) = network.streets.get(street as usize) else {
            continue;
        };
        let root = street_root(info, street);
        let piece = pieces.entry(root).or_default();
        let id = ids.next(root, 2_000_000 + *piece);
        *piece += 1;
        layout.streets.push(Street {
            id,
            line: LineString(chain.iter().map(|&v| mesh.point(v)).collect()),
            class: info.class,
            width: info.width,
            from: junction_ids[&chain[0]],
            to: junction_ids[&chain[chain.len() - 1]],
            given: info.given,
            name: info.name.clone(),
            lineage: info.lineage.clone(),
        });
    }
    for (k, spur) in spurs.iter().enumerate() {
        let Some(&end) = spur.points.last() else {
            continue;
        };
        let to = ids.next(place_hash(end), 0);
        layout.junctions.push(Junction {
            id: to,
            at: end,
            degree: 1,
        });
        let root = Path::parse(&spur.lineage.split).map_or(k as u64, |p| p.hash(1));
        layout.streets.push(Street {
            id: ids.next(root, 3_000_000 + k),
            line: LineString(spur.points.clone()),
            class: RoadClass::CulDeSac,
            width: street_width,
            from: junction_ids[&spur.from],
            to,
            given: false,
            name: None,
            lineage: Some(spur.lineage.clone()),
        });
    }
}

/// Whether a street goes on as the same one through a vertex of two.
fn same_street(network: &Network, a: HalfEdgeId, b: HalfEdgeId) -> bool {
    match (network.street_of(a), network.street_of(b)) {
        (Some(p), Some(q)) => {
            let straight = turn(
                network.mesh.point(network.mesh.origin(a))
                    - network.mesh.point(network.mesh.dest(a)),
                network.mesh.point(network.mesh.dest(b))
                    - network.mesh.point(network.mesh.origin(b)),
            );
            p.class == q.class
                && p.width == q.width
                && p.given == q.given
                && (p.given || straight.abs() < 0.8)
        }
        _ => false,
    }
}

fn street_root(info: &StreetInfo, street: u32) -> u64 {
    match info.lineage.as_ref().and_then(|l| Path::parse(&l.split)) {
        Some(path) => path.hash(2),
        None => mix(0x61e4 ^ u64::from(street)),
    }
}

/// A number for a place, to the centimetre.
fn place_hash(p: Coord<f64>) -> u64 {
    mix(((p.x * 100.0).round() as i64 as u64) ^ mix((p.y * 100.0).round() as i64 as u64))
}

/// Figures of each parcel on its final outline.
fn measure(layout: &mut Layout, site: &Site, min_frontage: f64) {
    let access: BTreeMap<u64, f64> = crate::check::frontages(site, layout).into_iter().collect();
    for tile in &mut layout.tiles {
        if let Some(info) = &mut tile.parcel {
            let (deviation, ratio) = measure_parcel(&tile.polygon);
            info.corner_deviation_deg = deviation;
            info.box_ratio = ratio;
            info.street_access = access.get(&tile.id).is_some_and(|&f| f >= min_frontage);
        }
    }
}

pub(crate) fn polygon_of(rings: &[Vec<Coord<f64>>]) -> Polygon<f64> {
    let close = |ring: &Vec<Coord<f64>>| {
        let mut points = ring.clone();
        points.extend(ring.first().copied());
        LineString(points)
    };
    let mut rings = rings.iter().map(close);
    let outer = rings.next().unwrap_or_else(|| LineString(Vec::new()));
    Polygon::new(outer, rings.collect())
}

pub(crate) fn shape_of(polygon: &Polygon<f64>) -> Vec<Vec<[f64; 2]>> {
    std::iter::once(polygon.exterior())
        .chain(polygon.interiors())
        .map(|ring| {
            ring.0
                .iter()
                .take(ring.0.len().saturating_sub(1))
                .map(|p| [p.x, p.y])
                .collect()
        })
        .collect()
}
