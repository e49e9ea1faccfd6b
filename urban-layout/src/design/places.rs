//! Places of a specification, in the site's own coordinates, and the vertices
//! of a mesh that they are.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use geo_types::{Coord, LineString, Polygon};
use network_opt::design::{EdgeState, Sinks, Specification, Tessellation};
use serde::Deserialize;

use crate::error::{Error, Result};
use crate::network::{entries, inside};
use crate::plane::{cross, dist, dot, nearest_on};
use crate::site::{Boundary, Site};

/// Where the things are that a level is told of, as coordinates of the site's
/// file (longitude and latitude, or metres): meshes are cut anew for each site,
/// so that numbers of vertices mean nothing to a reader.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, rename_all = "kebab-case", deny_unknown_fields)]
pub struct Places {
    /// Where traffic goes; takes the place of the specification's sinks.
    /// Default: nothing.
    pub sinks: Option<SinkPlaces>,
    /// Streets that must be there, each from place to place by the shortest and
    /// straightest way: the paper's figure 6d with `through`. Default: none.
    pub routes: Vec<Vec<[f64; 2]>>,
    /// Rings that no street may enter, besides the site's key elements.
    /// Default: none.
    pub obstacles: Vec<Vec<[f64; 2]>>,
}

/// Sinks by their place.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SinkPlaces {
    /// Where streets outside meet the boundary.
    OutsideStreets,
    /// The vertices nearest to these points; of a site in several regions
    /// each point counts for the nearest region alone.
    At(Vec<[f64; 2]>),
}

impl Places {
    /// Whether nothing is said.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Puts into `spec` what the places mean on `mesh`, the mesh of one of
    /// `regions`. Where no sink lies at this region its sinks stay as they were.
    pub(super) fn settle(
        &self,
        spec: &mut Specification,
        mesh: &Tessellation,
        regions: &[Polygon<f64>],
        region: usize,
        site: &Site,
    ) -> Result<()> {
        self.check()?;
        let local = |place: &[f64; 2]| site.frame.to_local(Coord::from(*place));
        let rings = self.obstacles.iter();
        let rings = rings.map(|ring| LineString(ring.iter().map(local).collect()));
        let obstacles: Vec<Polygon<f64>> = rings.map(|r| Polygon::new(r, Vec::new())).collect();
        spec.obstacles.extend(within(mesh, &obstacles));
        if let Some(sinks) = &self.sinks {
            let points: Vec<Coord<f64>> = match sinks {
                SinkPlaces::At(places) => places.iter().map(local).collect(),
                SinkPlaces::OutsideStreets => entries(site).iter().map(|e| e.at).collect(),
            };
            if points.is_empty() {
                return Err(Error::input(
                    "no street outside meets the site's boundary, so that there is no sink; give places",
                ));
            }
            let rim = on_rim(mesh);
            let mut found: Vec<usize> = Vec::new();
            for p in points {
                if nearest_region(regions, p) != region {
                    continue;
                }
                let boundary_only = matches!(sinks, SinkPlaces::OutsideStreets);
                let allowed = |v: usize| !boundary_only || rim[v];
                found.extend(nearest(mesh, p, allowed));
            }
            found.sort_unstable();
            found.dedup();
            if !found.is_empty() {
                spec.sinks = Sinks::At(found);
            }
        }
        if self.routes.is_empty() {
            return Ok(());
        }
        let problem = spec.on(mesh).map_err(|e| Error::input(e.to_string()))?;
        let closed: Vec<bool> = problem
            .states
            .iter()
            .map(|&state| state == EdgeState::Closed)
            .collect();
        for (number, route) in self.routes.iter().enumerate() {
            let points: Vec<Coord<f64>> = route.iter().map(local).collect();
            if points
                .first()
                .is_none_or(|&p| nearest_region(regions, p) != region)
            {
                continue;
            }
            let free = |v: usize| mesh.around(v).iter().any(|&(e, _)| !closed[e]);
            let stops: Vec<usize> = points
                .iter()
                .filter_map(|&p| nearest(mesh, p, free))
                .collect();
            let mut whole: Vec<usize> = Vec::new();
            for pair in stops.windows(2) {
                let Some(way) = straightest(mesh, pair[0], pair[1], &closed) else {
                    return Err(Error::input(format!(
                        "route {number} cannot be led around what is closed to streets"
                    )));
                };
                whole.extend(way.into_iter().skip(usize::from(!whole.is_empty())));
            }
            spec.routes.push(whole);
        }
        Ok(())
    }

    fn check(&self) -> Result<()> {
        let sinks = match &self.sinks {
            Some(SinkPlaces::At(list)) => list.as_slice(),
            _ => &[],
        };
        let all = self.routes.iter().chain(&self.obstacles).flatten();
        if all.chain(sinks).flatten().any(|x| !x.is_finite()) {
            return Err(Error::input("a place of the specification is not a number"));
        }
        if let Some(k) = self.routes.iter().position(|route| route.len() < 2) {
            return Err(Error::input(format!(
                "route {k} has fewer than two places; give where it starts and where it ends"
            )));
        }
        if let Some(k) = self.obstacles.iter().position(|ring| ring.len() < 3) {
            return Err(Error::input(format!(
                "obstacle {k} has fewer than three corners"
            )));
        }
        Ok(())
    }
}

/// Vertices within polygons, but those on the boundary, where streets exist.
pub(super) fn within(mesh: &Tessellation, polygons: &[Polygon<f64>]) -> Vec<usize> {
    let rim = on_rim(mesh);
    let inside = Boundary::new(polygons);
    (0..mesh.points().len())
        .filter(|&v| !rim[v] && inside.contains(mesh.points()[v]))
        .collect()
}

fn on_rim(mesh: &Tessellation) -> Vec<bool> {
    let mut on_rim = vec![false; mesh.points().len()];
    for (ends, rim) in mesh.edges().iter().zip(mesh.rim()) {
        ends.iter().for_each(|&v| on_rim[v] |= rim);
    }
    on_rim
}

fn nearest(mesh: &Tessellation, p: Coord<f64>, allowed: impl Fn(usize) -> bool) -> Option<usize> {
    let away = |v: usize| dist(mesh.points()[v], p);
    (0..mesh.points().len())
        .filter(|&v| allowed(v))
        .min_by(|&a, &b| away(a).total_cmp(&away(b)))
}

/// The region that a point lies in or is nearest to; on a rim, the first.
fn nearest_region(regions: &[Polygon<f64>], p: Coord<f64>) -> usize {
    let away = |region: &Polygon<f64>| {
        if inside(region, p) {
            return 0.0;
        }
        let rings = std::iter::once(region.exterior()).chain(region.interiors());
        let sides = rings.flat_map(|ring| ring.0.windows(2));
        sides
            .map(|side| dist(nearest_on(side[0], side[1], p).0, p))
            .fold(f64::INFINITY, f64::min)
    };
    let all = regions.iter().map(away).enumerate();
    all.min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |(region, _)| region)
}

/// A turn of a right angle costs as much as so many edges.
const TURN: f64 = 1.5;

/// The shortest way between two vertices along edges that are not closed, turns
/// counted as [`TURN`]: of the many shortest ways on a grid one that is a
/// street. Neither end nor edges of the boundary are passed through.
fn straightest(mesh: &Tessellation, from: usize, to: usize, closed: &[bool]) -> Option<Vec<usize>> {
    let edges = mesh.edges();
    let rim: Vec<bool> = mesh.rim().collect();
    let mean = (0..edges.len()).map(|e| mesh.length(e)).sum::<f64>() / edges.len().max(1) as f64;
    let turn = |before: usize, at: usize, after: usize| {
        let (a, b, c) = (
            mesh.points()[before],
            mesh.points()[at],
            mesh.points()[after],
        );
        let (u, v) = (b - a, c - b);
        TURN * mean * cross(u, v).abs().atan2(dot(u, v)) / std::f64::consts::FRAC_PI_2
    };
    // A state is a half-edge, by the edge and whether it is walked to its
    // first end; the heap orders by bits, as all costs are positive.
    let head = |state: usize| edges[state / 2][1 - state % 2];
    let tail = |state: usize| edges[state / 2][state % 2];
    let state_to = |e: usize, w: usize| 2 * e + usize::from(edges[e][0] == w);
    let usable = |e: usize| !closed[e] && !rim[e];
    let mut cost = vec![f64::INFINITY; 2 * edges.len()];
    let mut before: Vec<Option<usize>> = vec![None; 2 * edges.len()];
    let mut heap: BinaryHeap<Reverse<(u64, usize)>> = BinaryHeap::new();
    for &(e, w) in mesh.around(from) {
        if usable(e) {
            cost[state_to(e, w)] = mesh.length(e);
            heap.push(Reverse((mesh.length(e).to_bits(), state_to(e, w))));
        }
    }
    while let Some(Reverse((bits, state))) = heap.pop() {
        if bits != cost[state].to_bits() {
            continue;
        }
        let at = head(state);
        if at == to {
            let back = std::iter::successors(Some(state), |&s| before[s]);
            let mut way: Vec<usize> = back.map(head).collect();
            way.push(from);
            way.reverse();
            return Some(way);
        }
        for &(e, w) in mesh.around(at) {
            if !usable(e) || e == state / 2 || w == from {
                continue;
            }
            let there = cost[state] + mesh.length(e) + turn(tail(state), at, w);
            let next = state_to(e, w);
            if there < cost[next] {
                cost[next] = there;
                before[next] = Some(state);
                heap.push(Reverse((there.to_bits(), next)));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::site::Units;

    /// A square of 400 m with two streets outside and a mesh of 8 x 8.
    fn square() -> (Site, Tessellation) {
        let site = Site::from_geojson(
            r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
            {"type": "Feature", "properties": {"kind": "site"}, "geometry": {"type": "Polygon",
            "coordinates": [[[0, 0], [400, 0], [400, 400], [0, 400], [0, 0]]]}},
            {"type": "Feature", "properties": {"kind": "street"}, "geometry":
            {"type": "LineString", "coordinates": [[-200, 100], [0, 100]]}},
            {"type": "Feature", "properties": {"kind": "street"}, "geometry":
            {"type": "LineString", "coordinates": [[200, 700], [200, 400]]}}]}"#,
            Units::Auto,
        )
        .expect("a site");
        let options = network_opt::quad::QuadOptions {
            edge_length: 50.0,
            ..network_opt::quad::QuadOptions::default()
        };
        let mesh = network_opt::quad::quads(&site.parts[0], &options).expect("quads");
        (site, mesh)
    }

    /// A vertex by its place in the file.
    fn at(mesh: &Tessellation, x: f64, y: f64) -> usize {
        let p = Coord {
            x: x - 200.0,
            y: y - 200.0,
        };
        let v = nearest(mesh, p, |_| true).expect("a vertex");
        assert!(dist(mesh.points()[v], p) < 1e-6, "a vertex at {x} {y}");
        v
    }

    #[test]
    fn streets_outside_are_sinks() {
        let (site, mesh) = square();
        let mut spec = Specification::default();
        let places = Places {
            sinks: Some(SinkPlaces::OutsideStreets),
            ..Places::default()
        };
        places
            .settle(&mut spec, &mesh, &site.parts, 0, &site)
            .expect("settled");
        let mut wanted = vec![at(&mesh, 0.0, 100.0), at(&mesh, 200.0, 400.0)];
        wanted.sort_unstable();
        assert_eq!(spec.sinks, Sinks::At(wanted));
    }

    /// Straight where it can be, around an obstacle where not, and never along
    /// the boundary nor beside it.
    #[test]
    fn a_route_is_straight() {
        let (site, mesh) = square();
        let mut places = Places {
            routes: vec![vec![[200.0, 0.0], [200.0, 400.0]]],
            ..Places::default()
        };
        let mut spec = Specification::default();
        places
            .settle(&mut spec, &mesh, &site.parts, 0, &site)
            .expect("settled");
        let straight: Vec<usize> = (0..=8)
            .map(|k| at(&mesh, 200.0, 50.0 * f64::from(k)))
            .collect();
        assert_eq!(spec.routes, [straight]);

        places.obstacles = vec![vec![
            [180.0, 180.0],
            [260.0, 180.0],
            [260.0, 260.0],
            [180.0, 260.0],
        ]];
        let mut spec = Specification::default();
        places
            .settle(&mut spec, &mesh, &site.parts, 0, &site)
            .expect("settled");
        let blocked = [at(&mesh, 200.0, 200.0), at(&mesh, 250.0, 250.0)];
        assert!(spec.obstacles.contains(&blocked[0]) && spec.obstacles.contains(&blocked[1]));
        // One edge aside and back: two more edges than the straight way.
        assert_eq!(spec.routes[0].len(), 11);
        assert!(blocked.iter().all(|v| !spec.routes[0].contains(v)));
    }

    #[test]
    fn what_cannot_be_is_said() {
        let (site, mesh) = square();
        let error = |places: Places| {
            let mut spec = Specification::default();
            let settled = places.settle(&mut spec, &mesh, &site.parts, 0, &site);
            settled.expect_err("an error").to_string()
        };
        let short = Places {
            routes: vec![vec![[0.0, 0.0]]],
            ..Places::default()
        };
        assert!(error(short).contains("fewer than two places"));
        let line = Places {
            obstacles: vec![vec![[0.0, 0.0], [1.0, 1.0]]],
            ..Places::default()
        };
        assert!(error(line).contains("three corners"));
        let nowhere = Places {
            sinks: Some(SinkPlaces::At(vec![[f64::NAN, 0.0]])),
            ..Places::default()
        };
        assert!(error(nowhere).contains("not a number"));
        let walled = Places {
            routes: vec![vec![[200.0, 0.0], [200.0, 400.0]]],
            obstacles: vec![vec![
                [-1.0, 180.0],
                [401.0, 180.0],
                [401.0, 260.0],
                [-1.0, 260.0],
            ]],
            ..Places::default()
        };
        assert!(error(walled).contains("cannot be led around"));
    }
}
