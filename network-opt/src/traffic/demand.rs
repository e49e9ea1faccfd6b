//! Who wants to go where.

use super::error::TrafficError;
use super::graph::StreetGraph;
use super::trees::{Network, Towards};
use crate::random::Random;

/// Vehicles from one node to another.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Flow {
    /// The node where they start.
    pub from: usize,
    /// The node that they go to; who starts there is there already, and counts
    /// as a trip of no length.
    pub to: usize,
    /// Vehicles per hour, 0 or more.
    pub per_hour: f64,
}

/// One vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Trip {
    /// The node where it starts.
    pub from: usize,
    /// The node that it goes to.
    pub to: usize,
    /// When it starts, seconds, 0 or more.
    pub depart: f64,
}

/// Origin-destination pairs, *demand* in the words of the paper's section 3:
/// fixed, whatever the network.
///
/// # Examples
///
/// The mixes of section 5.1 on a street of four nodes: from two nodes within to
/// the nearer end, and between the ends.
///
/// ```
/// use network_opt::geo_types::coord;
/// use network_opt::traffic::{Demand, StreetGraph};
///
/// let mut graph = StreetGraph::default();
/// for x in [0.0, 100.0, 200.0, 300.0] {
///     graph.add_node(coord! { x: x, y: 0. });
/// }
/// for n in 0..3 {
///     graph.add_street(n, n + 1, 2, true)?;
/// }
/// let out = Demand::to_nearest(&graph, &[1, 2], &[0, 3], 250.0)?;
/// assert_eq!(out.flows.iter().map(|f| (f.from, f.to)).collect::<Vec<_>>(), [(1, 0), (2, 3)]);
/// let through = Demand::among(&[0, 3], 1000.0);
/// assert_eq!(out.plus(&through).total(), 1250.0);
/// # Ok::<(), network_opt::traffic::TrafficError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Demand {
    /// The pairs; a pair may be named more than once.
    pub flows: Vec<Flow>,
}

impl Demand {
    /// These pairs, origin first, each with the same share of `per_hour`
    /// vehicles: the arrows of figure 8a.
    #[must_use]
    pub fn pairs(pairs: &[(usize, usize)], per_hour: f64) -> Self {
        let each = per_hour / pairs.len() as f64;
        let flow = |&(from, to)| Flow {
            from,
            to,
            per_hour: each,
        };
        Self {
            flows: pairs.iter().map(flow).collect(),
        }
    }

    /// From each of some nodes to each other, `per_hour` vehicles in all,
    /// uniformly: the external sources and sinks of section 5.1.
    #[must_use]
    pub fn among(nodes: &[usize], per_hour: f64) -> Self {
        let pair = |&from: &usize| nodes.iter().map(move |&to| (from, to));
        let pairs: Vec<_> = nodes.iter().flat_map(pair).collect();
        let pairs: Vec<_> = pairs.into_iter().filter(|(from, to)| from != to).collect();
        Self::pairs(&pairs, per_hour)
    }

    /// From each of the origins to each of the destinations, uniformly,
    /// `per_hour` vehicles in all. A node that is named more than once counts
    /// so many times; pairs of a node and itself are left out.
    #[must_use]
    pub fn between(origins: &[usize], destinations: &[usize], per_hour: f64) -> Self {
        let (from, to) = (counted(origins), counted(destinations));
        let mut flows = Vec::with_capacity(from.len() * to.len());
        let mut total = 0.0;
        for &(from, many) in &from {
            for &(to, more) in &to {
                if from != to {
                    let per_hour = many * more;
                    total += per_hour;
                    flows.push(Flow { from, to, per_hour });
                }
            }
        }
        flows
            .iter_mut()
            .for_each(|flow| flow.per_hour *= per_hour / total);
        Self { flows }
    }

    /// From each of the origins to whichever of the sinks is reached first when
    /// the streets are free, `per_hour` vehicles in all: interior-to-boundary
    /// traffic, with the 250 cars per square kilometre and hour of section 5.1
    /// if the origins are nearest to [`spread_points`](super::spread_points). An
    /// origin that is named more than once counts so many times; flows are in
    /// the order of the origins.
    ///
    /// # Errors
    ///
    /// [`TrafficError::BadDemand`] for a node that is not there, or no sink;
    /// [`TrafficError::Unreachable`] with the first sink as destination if an
    /// origin reaches none.
    pub fn to_nearest(
        graph: &StreetGraph,
        origins: &[usize],
        sinks: &[usize],
        per_hour: f64,
    ) -> Result<Self, TrafficError> {
        graph.check()?;
        let count = graph.nodes.len();
        if let Some(n) = origins.iter().chain(sinks).find(|&&n| n >= count) {
            return Err(TrafficError::BadDemand {
                what: format!("node {n} is named, of {count}"),
            });
        }
        let Some(&first) = sinks.first() else {
            return Err(TrafficError::BadDemand {
                what: "there is no sink to go to".to_owned(),
            });
        };
        let times: Vec<f64> = graph.links.iter().map(super::Link::free_time).collect();
        let nearest = Network::new(graph).nearest(&times, sinks, Towards::Roots);
        let lost = origins.iter().filter(|&&n| nearest[n].is_none());
        let lost: Vec<_> = lost.map(|&n| (n, first)).collect();
        if !lost.is_empty() {
            return Err(super::assign::unreachable(lost));
        }
        let pairs: Vec<_> = origins
            .iter()
            .filter_map(|&n| nearest[n].map(|to| (n, to)))
            .collect();
        Ok(Self::pairs(&pairs, per_hour))
    }

    /// The same the other way: home in the evening.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let turn = |f: &Flow| Flow {
            from: f.to,
            to: f.from,
            ..*f
        };
        Self {
            flows: self.flows.iter().map(turn).collect(),
        }
    }

    /// So many times as many vehicles.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let scale = |f: &Flow| Flow {
            per_hour: f.per_hour * factor,
            ..*f
        };
        Self {
            flows: self.flows.iter().map(scale).collect(),
        }
    }

    /// Both together.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let flows = self.flows.iter().chain(&other.flows);
        Self {
            flows: flows.copied().collect(),
        }
    }

    /// Vehicles per hour in all.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.flows.iter().map(|f| f.per_hour).sum()
    }

    /// Single vehicles, in the order of departure: of each flow as many as it
    /// has in so many hours, one more or less, and never one more or less in any
    /// run of flows; they depart at random. The seed decides; trips of no length
    /// are left out.
    ///
    /// # Errors
    ///
    /// [`TrafficError::BadDemand`] if a flow is negative or not finite;
    /// [`TrafficError::BadOption`] if there are over a million vehicles, or the
    /// hours are not positive.
    pub fn trips(&self, hours: f64, seed: u64) -> Result<Vec<Trip>, TrafficError> {
        let amount = |f: &Flow| f.per_hour >= 0.0 && f.per_hour.is_finite();
        if let Some(k) = self.flows.iter().position(|f| !amount(f)) {
            return Err(TrafficError::BadDemand {
                what: format!("flow {k} has {} vehicles per hour", self.flows[k].per_hour),
            });
        }
        let expected = self.total() * hours;
        if !(hours > 0.0 && expected <= 1e6) {
            return Err(TrafficError::BadOption {
                what: format!("{expected} vehicles in {hours} hours; give up to a million"),
            });
        }
        let mut random = Random::new(seed);
        let mut due = random.unit();
        let mut trips = Vec::new();
        for f in &self.flows {
            due += f.per_hour * hours;
            while due >= 1.0 {
                due -= 1.0;
                let depart = random.unit() * hours * 3600.0;
                trips.push(Trip {
                    from: f.from,
                    to: f.to,
                    depart,
                });
            }
        }
        trips.retain(|t| t.from != t.to);
        trips.sort_by(|a, b| a.depart.total_cmp(&b.depart));
        Ok(trips)
    }

    /// What single vehicles within so many hours come to per hour.
    #[must_use]
    pub fn of_trips(trips: &[Trip], hours: f64) -> Self {
        let pairs: Vec<_> = trips.iter().map(|t| (t.from, t.to)).collect();
        Self::pairs(&pairs, trips.len() as f64 / hours)
    }
}

/// Different nodes, ascending, and how often each is named.
fn counted(nodes: &[usize]) -> Vec<(usize, f64)> {
    let mut sorted = nodes.to_vec();
    sorted.sort_unstable();
    let runs = sorted.chunk_by(|a, b| a == b);
    runs.map(|run| (run[0], run.len() as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_pairs_of_three_sources_are_six() {
        let three = Demand::among(&[4, 8, 15], 1000.0);
        assert_eq!(three.flows.len(), 6);
        assert!(three
            .flows
            .iter()
            .all(|f| (f.per_hour - 1000.0 / 6.0).abs() < 1e-9));
        assert_eq!(Demand::among(&[4], 1000.0), Demand::default());
        assert_eq!(Demand::pairs(&[], 1000.0), Demand::default());
    }

    /// Twice-named origins count twice: 2/3 of the traffic comes from node 1.
    #[test]
    fn between_counts_names() {
        let d = Demand::between(&[1, 2, 1], &[3], 90.0);
        let rates: Vec<_> = d
            .flows
            .iter()
            .map(|f| (f.from, f.per_hour.round()))
            .collect();
        assert_eq!(rates, [(1, 60.0), (2, 30.0)]);
        assert_eq!(Demand::between(&[1], &[1], 90.0).flows, []);
    }

    #[test]
    fn trips_follow_the_flows() {
        let d = Demand::pairs(&[(0, 1), (1, 2), (2, 2), (2, 0)], 10.0).scaled(2.0);
        // Five vehicles per hour and pair for three hours, of which one pair
        // goes nowhere.
        let trips = d.trips(3.0, 7).expect("trips");
        for pair in [(0, 1), (1, 2), (2, 0)] {
            let count = trips.iter().filter(|t| (t.from, t.to) == pair).count();
            assert!((14..=16).contains(&count));
        }
        assert!(trips
            .iter()
            .all(|t| t.from != t.to && (0.0..10_800.0).contains(&t.depart)));
        assert!(trips.windows(2).all(|w| w[0].depart <= w[1].depart));
        assert_eq!(d.trips(3.0, 7).expect("trips"), trips);
        assert_ne!(d.trips(3.0, 8).expect("trips"), trips);
        let again = Demand::of_trips(&trips, 3.0);
        assert!((again.total() - trips.len() as f64 / 3.0).abs() < 1e-9);
    }

    #[test]
    fn numbers_are_checked() {
        let d = Demand::pairs(&[(0, 1)], 10.0);
        assert!(d.trips(0.0, 0).is_err());
        assert!(d.trips(f64::NAN, 0).is_err());
        assert!(d.trips(1e9, 0).is_err());
        assert!(d.scaled(-1.0).trips(1.0, 0).is_err());
        assert!(d.scaled(f64::NAN).trips(1.0, 0).is_err());
        assert_eq!(Demand::default().trips(1.0, 0).expect("none"), []);
    }
}
