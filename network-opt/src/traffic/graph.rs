//! Nodes and directed links.

use geo_types::{Coord, LineString};

use super::class::RoadClass;
use super::error::TrafficError;

/// One direction of a piece of street between two nodes.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Link {
    /// The node that it leaves.
    pub from: usize,
    /// The node that it leads to, another one.
    pub to: usize,
    /// Metres. Positive.
    pub length: f64,
    /// Speed of free traffic, metres per second. Positive.
    pub speed: f64,
    /// Lanes, 1 or more.
    pub lanes: usize,
    /// Vehicles per hour of all lanes at which congestion sets in. Positive, or
    /// infinite.
    pub capacity: f64,
    /// Position in [`StreetGraph::classes`].
    pub class: usize,
    /// Which road it is a piece of, as the caller counts them.
    pub road: usize,
    /// Where it runs, from its first node to its second.
    pub line: LineString<f64>,
    /// The link of the other direction; `None` on a one-way street.
    pub reverse: Option<usize>,
}

impl Link {
    /// Seconds that free traffic takes.
    #[must_use]
    pub fn free_time(&self) -> f64 {
        self.length / self.speed
    }
}

/// Streets for traffic: *supply*, in the words of the paper's section 3.
///
/// Made of lines by [`StreetGraph::from_roads`], or by hand.
///
/// # Examples
///
/// Two ways from a place to another, one of them one-way.
///
/// ```
/// use network_opt::geo_types::coord;
/// use network_opt::traffic::{assign, Assignment, Demand, StreetGraph};
///
/// let mut graph = StreetGraph::default();
/// let [home, bridge, shop] = [(0., 0.), (300., 400.), (600., 0.)].map(|(x, y)| graph.add_node(coord! { x: x, y: y }));
/// graph.add_street(home, bridge, 1, true)?;
/// graph.add_street(bridge, shop, 1, false)?;
/// graph.add_street(shop, home, 1, false)?;
/// let there = assign(&graph, &Demand::pairs(&[(home, shop)], 100.0), &Assignment::ShortestTime)?;
/// let back = assign(&graph, &Demand::pairs(&[(shop, home)], 100.0), &Assignment::ShortestTime)?;
/// assert!((there.mean_distance - 1000.0).abs() < 1e-9);
/// assert!((back.mean_distance - 600.0).abs() < 1e-9);
/// # Ok::<(), network_opt::traffic::TrafficError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StreetGraph {
    /// Where the nodes are.
    pub nodes: Vec<Coord<f64>>,
    /// The links.
    pub links: Vec<Link>,
    /// The classes that links are of.
    pub classes: Vec<RoadClass>,
}

impl Default for StreetGraph {
    /// Nothing yet, with [`RoadClass::paper`].
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            links: Vec::new(),
            classes: RoadClass::paper().to_vec(),
        }
    }
}

impl StreetGraph {
    /// Adds a node, and gives its number.
    pub fn add_node(&mut self, at: Coord<f64>) -> usize {
        self.nodes.push(at);
        self.nodes.len() - 1
    }

    /// Adds a straight street of a class between two nodes, for traffic both
    /// ways or from the first to the second only; its road is its number among
    /// the links. Gives the link from the first node to the second.
    ///
    /// # Errors
    ///
    /// [`TrafficError::BadGraph`] if there is no such node or class, or no way
    /// between the nodes.
    pub fn add_street(
        &mut self,
        from: usize,
        to: usize,
        class: usize,
        both_ways: bool,
    ) -> Result<usize, TrafficError> {
        let count = self.nodes.len();
        let (Some(&a), Some(&b)) = (self.nodes.get(from), self.nodes.get(to)) else {
            return Err(TrafficError::BadGraph {
                what: format!("a street joins nodes {from} and {to}, of {count}"),
            });
        };
        self.add_line(vec![a, b], (from, to), class, self.links.len(), both_ways)
    }

    /// Adds a street along a line; see [`StreetGraph::add_street`].
    pub(super) fn add_line(
        &mut self,
        line: Vec<Coord<f64>>,
        (from, to): (usize, usize),
        class: usize,
        road: usize,
        both_ways: bool,
    ) -> Result<usize, TrafficError> {
        let bad = |what: String| Err(TrafficError::BadGraph { what });
        let Some(kind) = self.classes.get(class) else {
            return bad(format!("class {class} is named, of {}", self.classes.len()));
        };
        let length: f64 = line.windows(2).map(|w| distance(w[0], w[1])).sum();
        if from == to || !(length > 0.0 && length.is_finite()) {
            return bad(format!(
                "a street from node {from} to node {to} is {length} m long; give two places apart"
            ));
        }
        let first = self.links.len();
        let link = Link {
            from,
            to,
            length,
            speed: kind.speed,
            lanes: kind.lanes,
            capacity: kind.capacity * kind.lanes as f64,
            class,
            road,
            line: line.into(),
            reverse: both_ways.then_some(first + 1),
        };
        if both_ways {
            let mut line = link.line.clone();
            line.0.reverse();
            let back = Link {
                from: to,
                to: from,
                line,
                reverse: Some(first),
                ..link.clone()
            };
            self.links.push(link);
            self.links.push(back);
        } else {
            self.links.push(link);
        }
        Ok(first)
    }

    /// Metres of street, each counted once whichever ways it goes.
    #[must_use]
    pub fn street_length(&self) -> f64 {
        let once = self.links.iter().enumerate();
        once.filter(|(l, link)| link.reverse.is_none_or(|r| *l < r))
            .map(|(_, link)| link.length)
            .sum()
    }

    /// Checks that nodes, links and classes fit together.
    ///
    /// # Errors
    ///
    /// [`TrafficError::BadGraph`], which says what does not.
    pub fn check(&self) -> Result<(), TrafficError> {
        let bad = |what: String| Err(TrafficError::BadGraph { what });
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let is_capacity = |x: f64| x > 0.0;
        if let Some(n) = self
            .nodes
            .iter()
            .position(|p| !(p.x.is_finite() && p.y.is_finite()))
        {
            return bad(format!("node {n} is not at a finite place"));
        }
        for (c, class) in self.classes.iter().enumerate() {
            if !positive(class.speed) || class.lanes == 0 || !is_capacity(class.capacity) {
                return bad(format!(
                    "class {c} ({:?}) has a speed of {} m/s, {} lanes and a capacity of {}; all are positive",
                    class.name, class.speed, class.lanes, class.capacity
                ));
            }
        }
        for (l, link) in self.links.iter().enumerate() {
            if link.from == link.to || link.from.max(link.to) >= self.nodes.len() {
                return bad(format!(
                    "link {l} leads from node {} to node {}, of {}",
                    link.from,
                    link.to,
                    self.nodes.len()
                ));
            }
            if !positive(link.length) || !positive(link.speed) {
                return bad(format!(
                    "link {l} is {} m long at {} m/s; both are positive",
                    link.length, link.speed
                ));
            }
            if link.lanes == 0 || !is_capacity(link.capacity) || link.class >= self.classes.len() {
                return bad(format!(
                    "link {l} has {} lanes, a capacity of {} and class {}, of {}",
                    link.lanes,
                    link.capacity,
                    link.class,
                    self.classes.len()
                ));
            }
            if link.line.0.len() < 2 || link.line.0.iter().any(|p| !finite(*p)) {
                return bad(format!("link {l} has no line of finite points"));
            }
            let back = link.reverse.map(|r| self.links.get(r));
            if let Some(back) = back {
                if back
                    .is_none_or(|b| b.reverse != Some(l) || (b.from, b.to) != (link.to, link.from))
                {
                    return bad(format!("link {l} is not the reverse of its reverse"));
                }
            }
        }
        Ok(())
    }
}

fn finite(p: Coord<f64>) -> bool {
    p.x.is_finite() && p.y.is_finite()
}

pub(super) fn distance(a: Coord<f64>, b: Coord<f64>) -> f64 {
    (b.x - a.x).hypot(b.y - a.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn two() -> StreetGraph {
        let mut graph = StreetGraph::default();
        let a = graph.add_node(coord! { x: 0., y: 0. });
        let b = graph.add_node(coord! { x: 3., y: 4. });
        graph.add_street(a, b, 2, true).expect("a street");
        graph.add_street(b, a, 0, false).expect("a street");
        graph
    }

    #[test]
    fn streets_are_counted_once() {
        let graph = two();
        graph.check().expect("sound");
        assert_eq!(graph.links.len(), 3);
        assert_eq!(graph.street_length(), 10.0);
        assert_eq!(graph.links[1].line.0[0], coord! { x: 3., y: 4. });
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let mut graph = two();
        assert!(graph.add_street(0, 0, 0, true).is_err());
        assert!(graph.add_street(0, 7, 0, true).is_err());
        assert!(graph.add_street(0, 1, 9, true).is_err());
        let breaks: [fn(&mut StreetGraph); 8] = [
            |g| g.nodes[1].x = f64::NAN,
            |g| g.links[0].to = 0,
            |g| g.links[0].length = 0.0,
            |g| g.links[2].speed = f64::INFINITY,
            |g| g.links[2].capacity = f64::NAN,
            |g| g.links[2].class = 4,
            |g| g.links[0].reverse = Some(2),
            |g| g.classes[3].lanes = 0,
        ];
        for harm in breaks {
            let mut graph = two();
            harm(&mut graph);
            assert!(graph.check().is_err());
        }
    }
}
