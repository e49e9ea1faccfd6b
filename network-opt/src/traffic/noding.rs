//! From lines to a graph: nodes where roads meet.

use geo_types::{Coord, LineString};

use super::class::RoadClass;
use super::error::TrafficError;
use super::graph::{distance, StreetGraph};
use crate::mesh::{HalfEdgeId, PlanarMesh, VertexId, Wire};

/// A street as a line.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Road {
    /// Where it runs; a ring repeats its first point.
    pub line: LineString<f64>,
    /// Position in the list of classes.
    pub class: usize,
    /// Whether traffic goes along the line only.
    pub one_way: bool,
}

/// How roads become a graph.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NodingOptions {
    /// Points closer than this are one, metres.
    ///
    /// Default value: 0.01.
    pub snap: f64,
    /// Links are cut into equal pieces no longer than this, metres, so that
    /// trips may start along a street and not at its ends alone; 0 leaves them
    /// whole.
    ///
    /// Default value: 0.
    pub pieces: f64,
    /// Places where a node must be, at the nearest point of a road.
    pub stops: Vec<Coord<f64>>,
}

impl Default for NodingOptions {
    fn default() -> Self {
        Self {
            snap: 0.01,
            pieces: 0.0,
            stops: Vec::new(),
        }
    }
}

/// What a side of an edge of the mesh belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Side {
    road: usize,
    /// Whether who goes with this side on the left goes along the road's line.
    along: bool,
}

impl StreetGraph {
    /// Joins roads to a graph. They meet wherever their lines do: at shared
    /// points, at crossings, and where one ends on another; there are no bridges.
    /// Where two run on top of each other the one of the class that comes first
    /// stays. [`Link::road`](super::Link::road) is the position in `roads`.
    ///
    /// Nodes are numbered along the roads as they come, links likewise, so that
    /// the same roads give the same graph.
    ///
    /// # Errors
    ///
    /// [`TrafficError::BadGraph`] for a class that is not there or not sound;
    /// [`TrafficError::BadOption`]; [`TrafficError::Linework`] if there is no
    /// road with any length, or a coordinate is not finite.
    ///
    /// # Examples
    ///
    /// ```
    /// use network_opt::geo_types::line_string;
    /// use network_opt::traffic::{NodingOptions, Road, RoadClass, StreetGraph};
    ///
    /// let road = |line, class| Road { line, class, one_way: false };
    /// let roads = [
    ///     road(line_string![(x: 0., y: 0.), (x: 200., y: 0.)], 1),
    ///     road(line_string![(x: 100., y: 0.), (x: 100., y: 80.)], 2),
    /// ];
    /// let graph = StreetGraph::from_roads(&roads, &RoadClass::paper(), &NodingOptions::default())?;
    /// // A T-junction: four nodes, and three pieces of street both ways.
    /// assert_eq!((graph.nodes.len(), graph.links.len()), (4, 6));
    /// assert_eq!(graph.street_length(), 280.0);
    /// # Ok::<(), network_opt::traffic::TrafficError>(())
    /// ```
    pub fn from_roads(
        roads: &[Road],
        classes: &[RoadClass],
        options: &NodingOptions,
    ) -> Result<Self, TrafficError> {
        if !(options.pieces >= 0.0 && options.pieces.is_finite()) {
            return Err(TrafficError::BadOption {
                what: format!("pieces is {}; give metres, or 0", options.pieces),
            });
        }
        let mut graph = Self {
            classes: classes.to_vec(),
            ..Self::default()
        };
        graph.check()?;
        let mut wires = Vec::new();
        for (road, r) in roads.iter().enumerate() {
            if r.class >= classes.len() {
                return Err(TrafficError::BadGraph {
                    what: format!("road {road} is of class {}, of {}", r.class, classes.len()),
                });
            }
            let first = u8::try_from(r.class).unwrap_or(u8::MAX);
            wires.push(Wire {
                line: r.line.clone(),
                left: Side { road, along: true },
                right: Side { road, along: false },
                priority: u8::MAX - first,
            });
        }
        let mut mesh = PlanarMesh::from_linework(&wires, options.snap)?;
        let mut stops = Vec::new();
        for &at in &options.stops {
            if !(at.x.is_finite() && at.y.is_finite()) {
                return Err(TrafficError::BadOption {
                    what: "a stop is not at a finite place".to_owned(),
                });
            }
            if let Some((edge, at, _)) = mesh.nearest_edge(at) {
                stops.push(mesh.split_edge(edge, at)?);
            }
        }
        let mut draft = Draft {
            is_node: nodes(&mesh, &stops),
            number: vec![None; mesh.vertex_bound()],
            used: vec![false; mesh.half_edge_bound()],
            mesh,
        };
        let edges: Vec<HalfEdgeId> = draft.mesh.edges().collect();
        // From nodes first; what is left are rings that meet nothing.
        for pass in 0..2 {
            for &edge in &edges {
                for h in [edge, edge.twin()] {
                    let from = draft.mesh.origin(h);
                    if draft.used[h.0 as usize] {
                        continue;
                    }
                    if pass == 1 {
                        draft.is_node[from.0 as usize] = true;
                    }
                    if draft.is_node[from.0 as usize] {
                        draft.chain(h, roads, options.pieces, &mut graph)?;
                    }
                }
            }
        }
        Ok(graph)
    }
}

/// Which vertices are junctions, ends, places where a road becomes another, or
/// stops.
fn nodes(mesh: &PlanarMesh<Side>, stops: &[VertexId]) -> Vec<bool> {
    let mut is_node = vec![false; mesh.vertex_bound()];
    for v in mesh.vertices() {
        let out: Vec<HalfEdgeId> = mesh.outgoing(v).collect();
        is_node[v.0 as usize] = match out[..] {
            // One comes in along the twin of an outgoing edge.
            [a, b] => mesh.attr(a.twin()) != mesh.attr(b),
            _ => true,
        };
    }
    stops.iter().for_each(|v| is_node[v.0 as usize] = true);
    is_node
}

struct Draft {
    mesh: PlanarMesh<Side>,
    is_node: Vec<bool>,
    /// The number that a vertex has as a node.
    number: Vec<Option<usize>>,
    /// Half-edges of chains that are links already.
    used: Vec<bool>,
}

impl Draft {
    fn node(&mut self, v: VertexId, graph: &mut StreetGraph) -> usize {
        let at = self.mesh.point(v);
        *self.number[v.0 as usize].get_or_insert_with(|| graph.add_node(at))
    }

    /// The links of the chain that begins with a half-edge at a node.
    fn chain(
        &mut self,
        first: HalfEdgeId,
        roads: &[Road],
        pieces: f64,
        graph: &mut StreetGraph,
    ) -> Result<(), TrafficError> {
        let side = *self.mesh.attr(first);
        let start = self.mesh.origin(first);
        let mut line = vec![self.mesh.point(start)];
        let mut h = first;
        loop {
            self.used[h.0 as usize] = true;
            self.used[h.twin().0 as usize] = true;
            let at = self.mesh.dest(h);
            line.push(self.mesh.point(at));
            if self.is_node[at.0 as usize] {
                break;
            }
            // Two half-edges leave there: back, and on.
            let on = self.mesh.outgoing(at).find(|&o| o != h.twin());
            let Some(on) = on else { break };
            h = on;
        }
        let end = self.mesh.dest(h);
        let road = &roads[side.road];
        if !side.along {
            line.reverse();
        }
        let ends = if side.along {
            [start, end]
        } else {
            [end, start]
        };
        let ends = ends.map(|v| self.node(v, graph));
        let length: f64 = line.windows(2).map(|w| distance(w[0], w[1])).sum();
        let mut count = if pieces > 0.0 {
            ((length / pieces).ceil() as usize).max(1)
        } else {
            1
        };
        if ends[0] == ends[1] {
            // A link leads to another node: two for a ring.
            count = count.max(2);
        }
        let parts = cut(&line, length, count);
        let mut from = ends[0];
        for (k, part) in parts.iter().enumerate() {
            let to = match part.last() {
                Some(&at) if k + 1 < parts.len() => graph.add_node(at),
                _ => ends[1],
            };
            graph.add_line(
                part.clone(),
                (from, to),
                road.class,
                side.road,
                !road.one_way,
            )?;
            from = to;
        }
        Ok(())
    }
}

/// A line in so many parts of the same length.
fn cut(line: &[Coord<f64>], length: f64, count: usize) -> Vec<Vec<Coord<f64>>> {
    let mut parts = Vec::with_capacity(count);
    let mut part: Vec<Coord<f64>> = line.first().copied().into_iter().collect();
    let mut gone = 0.0;
    for pair in line.windows(2) {
        let step = distance(pair[0], pair[1]);
        while parts.len() + 1 < count {
            let goal = length * (parts.len() + 1) as f64 / count as f64;
            if goal >= gone + step {
                break;
            }
            let at = pair[0] + (pair[1] - pair[0]) * ((goal - gone) / step);
            // Where a cut falls on a point that point is not there twice.
            if part.last() != Some(&at) {
                part.push(at);
            }
            parts.push(std::mem::replace(&mut part, vec![at]));
        }
        if part.last() != Some(&pair[1]) {
            part.push(pair[1]);
        }
        gone += step;
    }
    parts.push(part);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{coord, line_string};

    fn road(line: LineString<f64>, class: usize) -> Road {
        Road {
            line,
            class,
            one_way: false,
        }
    }

    fn square() -> LineString<f64> {
        line_string![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 90.), (x: 0., y: 90.), (x: 0., y: 0.)]
    }

    fn graph(roads: &[Road], options: &NodingOptions) -> StreetGraph {
        let graph = StreetGraph::from_roads(roads, &RoadClass::paper(), options).expect("joins");
        graph.check().expect("sound");
        graph
    }

    /// A ring alone has two nodes or more, since no link is a loop.
    #[test]
    fn a_ring_is_cut() {
        let whole = graph(&[road(square(), 0)], &NodingOptions::default());
        assert_eq!((whole.nodes.len(), whole.links.len()), (2, 4));
        assert!((whole.street_length() - 360.0).abs() < 1e-9);
        let fine = NodingOptions {
            pieces: 50.0,
            ..NodingOptions::default()
        };
        // 360 in pieces of up to 50: eight of 45.
        let fine = graph(&[road(square(), 0)], &fine);
        assert_eq!((fine.nodes.len(), fine.links.len()), (8, 16));
        assert!(fine.links.iter().all(|l| (l.length - 45.0).abs() < 1e-9));
    }

    #[test]
    fn a_one_way_road_goes_along_its_line() {
        let mut one = road(line_string![(x: 80., y: 45.), (x: 0., y: 45.)], 2);
        one.one_way = true;
        let cross = road(line_string![(x: 40., y: 0.), (x: 40., y: 90.)], 1);
        let got = graph(&[one, cross], &NodingOptions::default());
        let ways: Vec<_> = got.links.iter().filter(|l| l.road == 0).collect();
        assert_eq!(ways.len(), 2);
        for link in ways {
            assert!(got.nodes[link.to].x < got.nodes[link.from].x);
            assert_eq!(link.reverse, None);
            let ends = [link.line.0[0], link.line.0[link.line.0.len() - 1]];
            assert_eq!(ends, [link.from, link.to].map(|n| got.nodes[n]));
        }
        assert_eq!(got.links.iter().filter(|l| l.road == 1).count(), 4);
    }

    #[test]
    fn stops_become_nodes() {
        let options = NodingOptions {
            stops: vec![coord! { x: 33., y: -2. }, coord! { x: 33., y: -2. }],
            ..NodingOptions::default()
        };
        let got = graph(&[road(square(), 0)], &options);
        assert!(got
            .nodes
            .iter()
            .any(|n| distance(*n, coord! { x: 33., y: 0. }) < 1e-9));
    }

    #[test]
    fn bad_roads_are_refused() {
        let refuse = |roads: &[Road], options: &NodingOptions| {
            StreetGraph::from_roads(roads, &RoadClass::paper(), options).is_err()
        };
        let plain = NodingOptions::default();
        assert!(refuse(&[], &plain));
        assert!(refuse(&[road(line_string![(x: 1., y: 1.)], 0)], &plain));
        assert!(refuse(&[road(square(), 4)], &plain));
        let far = line_string![(x: 0., y: 0.), (x: f64::NAN, y: 0.)];
        assert!(refuse(&[road(far, 0)], &plain));
        let pieces = NodingOptions {
            pieces: -1.0,
            ..NodingOptions::default()
        };
        assert!(refuse(&[road(square(), 0)], &pieces));
        let stops = NodingOptions {
            stops: vec![coord! { x: f64::NAN, y: 0. }],
            ..NodingOptions::default()
        };
        assert!(refuse(&[road(square(), 0)], &stops));
    }

    /// Where two roads run on top of each other, there is one.
    #[test]
    fn the_wider_of_two_stays() {
        let line = || line_string![(x: 0., y: 0.), (x: 90., y: 0.)];
        let got = graph(
            &[road(line(), 2), road(line(), 0)],
            &NodingOptions::default(),
        );
        assert_eq!(got.links.len(), 2);
        assert!(got.links.iter().all(|l| l.class == 0 && l.road == 1));
    }
}
