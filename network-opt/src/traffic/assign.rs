//! Who takes which way: assignment of demand to links.

use super::demand::Demand;
use super::equilibrium::{equilibrium, Equilibrium, EquilibriumOptions};
use super::error::{TrafficError, NAMED};
use super::graph::{Link, StreetGraph};
use super::trees::{Network, Towards, Tree};

/// How drivers choose their ways.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Assignment {
    /// The quickest way while the streets are free, all drivers of a pair
    /// alike: what the paper predicts with (section 5.1). Of equally quick ways
    /// the shortest.
    #[default]
    ShortestTime,
    /// Ways of which none is quicker than those taken, with all the traffic
    /// that is there: Wardrop's first principle (section 3).
    Equilibrium(EquilibriumOptions),
}

/// What demand comes to on a network.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Traffic {
    /// Vehicles per hour on each link.
    pub vehicles: Vec<f64>,
    /// Seconds that each link takes with that traffic.
    pub times: Vec<f64>,
    /// Trips per hour, those of no length included.
    pub trips: f64,
    /// Mean metres of a trip; 0 if there is none.
    pub mean_distance: f64,
    /// Mean seconds of a trip; 0 if there is none.
    pub mean_time: f64,
    /// How near to the equilibrium the flows are; `None` for
    /// [`Assignment::ShortestTime`], which does not look for one.
    pub equilibrium: Option<Equilibrium>,
}

impl Traffic {
    /// Metres travelled in an hour.
    #[must_use]
    pub fn total_distance(&self) -> f64 {
        self.mean_distance * self.trips
    }

    /// Seconds spent on the way in an hour.
    #[must_use]
    pub fn total_time(&self) -> f64 {
        self.mean_time * self.trips
    }

    /// The traffic of each link and its reverse together, vehicles per hour:
    /// what passes on the street.
    #[must_use]
    pub fn both_ways(&self, graph: &StreetGraph) -> Vec<f64> {
        let links = graph.links.iter().zip(&self.vehicles);
        links
            .map(|(link, own)| own + link.reverse.map_or(0.0, |r| self.vehicles[r]))
            .collect()
    }
}

/// Assigns demand to the links of a graph.
///
/// # Errors
///
/// [`TrafficError::BadGraph`], [`TrafficError::BadDemand`] and
/// [`TrafficError::BadOption`] for input that is not sound;
/// [`TrafficError::Unreachable`], which names pairs that no way joins.
///
/// # Complexity
///
/// For each different origin, or destination if there are fewer, one run of
/// Dijkstra's algorithm, O(l log n), until all its partners are reached; the
/// equilibrium does that once a round.
///
/// # Examples
///
/// ```
/// use network_opt::geo_types::coord;
/// use network_opt::traffic::{assign, Assignment, Demand, StreetGraph};
///
/// let mut graph = StreetGraph::default();
/// let nodes = [0.0, 100.0, 250.0].map(|x| graph.add_node(coord! { x: x, y: 0. }));
/// graph.add_street(nodes[0], nodes[1], 2, true)?;
/// graph.add_street(nodes[1], nodes[2], 2, true)?;
/// let demand = Demand::pairs(&[(0, 1), (0, 2)], 40.0);
/// let traffic = assign(&graph, &demand, &Assignment::ShortestTime)?;
/// assert_eq!(traffic.vehicles, [40.0, 0.0, 20.0, 0.0]);
/// assert_eq!(traffic.mean_distance, 175.0);
/// # Ok::<(), network_opt::traffic::TrafficError>(())
/// ```
pub fn assign(
    graph: &StreetGraph,
    demand: &Demand,
    assignment: &Assignment,
) -> Result<Traffic, TrafficError> {
    graph.check()?;
    check(graph, demand)?;
    let plan = Plan::new(graph, demand);
    let free: Vec<f64> = graph.links.iter().map(Link::free_time).collect();
    let trips = demand.total();
    let (vehicles, times, equilibrium) = match assignment {
        Assignment::ShortestTime => (plan.load(&free)?, free, None),
        Assignment::Equilibrium(options) => {
            let (vehicles, times, found) = equilibrium(graph, &plan, free, options)?;
            (vehicles, times, Some(found))
        }
    };
    let mean = |of: &dyn Fn(usize) -> f64| {
        let sum: f64 = vehicles.iter().enumerate().map(|(l, v)| v * of(l)).sum();
        if trips > 0.0 {
            sum / trips
        } else {
            0.0
        }
    };
    Ok(Traffic {
        mean_distance: mean(&|l| graph.links[l].length),
        mean_time: mean(&|l| times[l]),
        vehicles,
        times,
        trips,
        equilibrium,
    })
}

fn check(graph: &StreetGraph, demand: &Demand) -> Result<(), TrafficError> {
    let count = graph.nodes.len();
    for (k, f) in demand.flows.iter().enumerate() {
        if f.from.max(f.to) >= count {
            return Err(TrafficError::BadDemand {
                what: format!("flow {k} goes from node {} to {}, of {count}", f.from, f.to),
            });
        }
        if !(f.per_hour >= 0.0 && f.per_hour.is_finite()) {
            return Err(TrafficError::BadDemand {
                what: format!("flow {k} has {} vehicles per hour", f.per_hour),
            });
        }
    }
    Ok(())
}

pub(super) fn unreachable(mut pairs: Vec<(usize, usize)>) -> TrafficError {
    pairs.sort_unstable();
    pairs.dedup();
    let count = pairs.len();
    pairs.truncate(NAMED);
    TrafficError::Unreachable { pairs, count }
}

/// Demand by its origins, or by its destinations, whichever are fewer.
pub(super) struct Plan<'g> {
    network: Network<'g>,
    towards: Towards,
    /// Each root with its partners, ascending, and vehicles per hour.
    groups: Vec<(usize, Vec<(usize, f64)>)>,
}

impl<'g> Plan<'g> {
    fn new(graph: &'g StreetGraph, demand: &Demand) -> Self {
        let flows = || {
            demand
                .flows
                .iter()
                .filter(|f| f.from != f.to && f.per_hour > 0.0)
        };
        let by = |key: fn(&super::Flow) -> (usize, usize)| {
            let mut all: Vec<_> = flows().map(|f| (key(f), f.per_hour)).collect();
            // A stable order, so that sums are the same on every run.
            all.sort_by_key(|&(key, _)| key);
            let roots = all.chunk_by(|a, b| a.0 .0 == b.0 .0);
            let partners = |root: &[((usize, usize), f64)]| {
                root.chunk_by(|a, b| a.0 == b.0)
                    .map(|same| (same[0].0 .1, same.iter().map(|f| f.1).sum()))
                    .collect()
            };
            roots
                .map(|root| (root[0].0 .0, partners(root)))
                .collect::<Vec<(usize, Vec<(usize, f64)>)>>()
        };
        let from = by(|f| (f.from, f.to));
        let to = by(|f| (f.to, f.from));
        let (groups, towards) = if to.len() < from.len() {
            (to, Towards::Roots)
        } else {
            (from, Towards::Leaves)
        };
        Self {
            network: Network::new(graph),
            towards,
            groups,
        }
    }

    /// Everyone on the way that is quickest by these times: vehicles per hour
    /// on each link.
    pub(super) fn load(&self, times: &[f64]) -> Result<Vec<f64>, TrafficError> {
        let mut tree = Tree::default();
        let mut flow = vec![0.0; times.len()];
        let mut loads: Vec<f64> = Vec::new();
        let mut lost = Vec::new();
        for (root, partners) in &self.groups {
            let is_wanted = |n: usize| {
                partners
                    .binary_search_by_key(&n, |&(partner, _)| partner)
                    .is_ok()
            };
            let roots = std::slice::from_ref(root);
            self.network.grow(
                &mut tree,
                times,
                roots,
                self.towards,
                partners.len(),
                &is_wanted,
            );
            loads.resize(tree.cost.len(), 0.0);
            for &(partner, per_hour) in partners {
                if tree.cost[partner].0.is_finite() {
                    loads[partner] = per_hour;
                } else {
                    lost.push(match self.towards {
                        Towards::Roots => (partner, *root),
                        Towards::Leaves => (*root, partner),
                    });
                }
            }
            self.network.pour(&tree, &mut loads, &mut flow);
        }
        if lost.is_empty() {
            Ok(flow)
        } else {
            Err(unreachable(lost))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    /// A one-way ring of four nodes, 100 m apart.
    fn ring() -> StreetGraph {
        let mut graph = StreetGraph::default();
        for (x, y) in [(0., 0.), (100., 0.), (100., 100.), (0., 100.)] {
            graph.add_node(coord! { x: x, y: y });
        }
        for n in 0..4 {
            graph
                .add_street(n, (n + 1) % 4, 1, false)
                .expect("a street");
        }
        graph
    }

    #[test]
    fn one_way_streets_lead_around() {
        let demand = Demand::pairs(&[(0, 1), (1, 0)], 20.0);
        let traffic = assign(&ring(), &demand, &Assignment::ShortestTime).expect("assigned");
        assert_eq!(traffic.vehicles, [10.0; 4]);
        assert_eq!((traffic.mean_distance, traffic.trips), (200.0, 20.0));
        let speed = ring().links[0].speed;
        assert!((traffic.mean_time - 200.0 / speed).abs() < 1e-9);
        assert!((traffic.total_time() - 20.0 * traffic.mean_time).abs() < 1e-9);
    }

    #[test]
    fn pairs_without_a_way_are_named() {
        let mut graph = ring();
        graph.links.pop();
        // Now 0 to 3 only: all pairs backwards are lost.
        let demand = Demand::among(&[0, 1, 2, 3], 12.0);
        match assign(&graph, &demand, &Assignment::ShortestTime) {
            Err(TrafficError::Unreachable { pairs, count }) => {
                assert_eq!(pairs, [(1, 0), (2, 0), (2, 1), (3, 0), (3, 1), (3, 2)]);
                assert_eq!(count, 6);
            }
            other => panic!("{other:?}"),
        }
        let lost = Demand::to_nearest(&graph, &[3], &[0, 1], 1.0);
        assert!(matches!(lost, Err(TrafficError::Unreachable { pairs, .. }) if pairs == [(3, 0)]));
    }

    #[test]
    fn no_demand_and_no_way_to_go_are_fine() {
        for demand in [
            Demand::default(),
            Demand::pairs(&[(2, 2)], 5.0),
            Demand::pairs(&[(0, 1)], 0.0),
        ] {
            let traffic = assign(&ring(), &demand, &Assignment::ShortestTime).expect("assigned");
            assert_eq!((traffic.mean_distance, traffic.mean_time), (0.0, 0.0));
        }
        let empty = StreetGraph::default();
        let none = assign(&empty, &Demand::default(), &Assignment::ShortestTime).expect("nothing");
        assert!(none.vehicles.is_empty());
    }

    #[test]
    fn strange_demand_is_refused() {
        for demand in [
            Demand::pairs(&[(0, 9)], 1.0),
            Demand::pairs(&[(0, 1)], f64::NAN),
            Demand::pairs(&[(0, 1)], -1.0),
        ] {
            let refused = assign(&ring(), &demand, &Assignment::ShortestTime);
            assert!(matches!(refused, Err(TrafficError::BadDemand { .. })));
        }
        assert!(Demand::to_nearest(&ring(), &[0], &[], 1.0).is_err());
        assert!(Demand::to_nearest(&ring(), &[9], &[0], 1.0).is_err());
    }
}
