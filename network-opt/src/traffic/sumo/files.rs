//! Plain files: nodes, edges, types, trips, and how to run the programs.

use std::path::Path;

use super::xml::{number, Document};
use crate::traffic::{StreetGraph, TrafficError, Trip};

/// What is written besides the graph and its trips.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SumoOptions {
    /// What the files are called, up to the first dot: letters, digits, `-` and
    /// `_`.
    ///
    /// Default value: "network".
    pub name: String,
    /// The names of the roads, by [`Link::road`](crate::traffic::Link::road);
    /// where there is none the class is named. Any text.
    ///
    /// Default value: none.
    pub road_names: Vec<String>,
    /// Whether vehicles look for a quicker way every minute, by the traffic that
    /// there is: the "traffic-dependent dynamic route assignments" for which the
    /// paper took SUMO (section 2).
    ///
    /// Default value: true.
    pub reroute: bool,
}

impl Default for SumoOptions {
    fn default() -> Self {
        Self {
            name: "network".to_owned(),
            road_names: Vec::new(),
            reroute: true,
        }
    }
}

/// A graph and its trips as SUMO's plain XML.
///
/// For the name `network` these are `network.nod.xml` (a node `n3` for node 3),
/// `network.edg.xml` (an edge `e7` for link 7), `network.typ.xml` (a type `c1`
/// for class 1), `network.trips.xml` (a trip `t9` for trip 9), and three files of
/// options, so that
///
/// ```text
/// netconvert -c network.netccfg && duarouter -c network.duarcfg && sumo -c network.sumocfg
/// ```
///
/// builds the network, finds the ways, and writes `network.tripinfo.xml`.
///
/// # Examples
///
/// ```
/// use network_opt::geo_types::coord;
/// use network_opt::traffic::sumo::{SumoFiles, SumoOptions};
/// use network_opt::traffic::{StreetGraph, Trip};
///
/// let mut graph = StreetGraph::default();
/// let ends = [0.0, 250.0].map(|x| graph.add_node(coord! { x: x, y: 0. }));
/// graph.add_street(ends[0], ends[1], 1, true)?;
/// let trips = [Trip { from: 0, to: 1, depart: 2.5 }];
/// let sumo = SumoFiles::new(&graph, &trips, &SumoOptions::default())?;
/// let (name, nodes) = &sumo.files()[0];
/// assert_eq!(name, "network.nod.xml");
/// assert!(nodes.contains("<node id=\"n1\" x=\"250\" y=\"0\""));
/// # Ok::<(), network_opt::traffic::TrafficError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SumoFiles {
    pub(super) name: String,
    pub(super) trips: usize,
    files: Vec<(String, String)>,
}

impl SumoFiles {
    /// Writes the files, to memory.
    ///
    /// # Errors
    ///
    /// [`TrafficError::BadGraph`]; [`TrafficError::BadDemand`] for a trip from or
    /// to a node that is not there, of no length, or without a time of
    /// departure; [`TrafficError::BadOption`] for a name that is none.
    pub fn new(
        graph: &StreetGraph,
        trips: &[Trip],
        options: &SumoOptions,
    ) -> Result<Self, TrafficError> {
        graph.check()?;
        let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if options.name.is_empty() || !options.name.chars().all(fits) {
            return Err(TrafficError::BadOption {
                what: format!(
                    "the name of the files is {:?}; give letters, digits, - and _",
                    options.name
                ),
            });
        }
        let count = graph.nodes.len();
        let fits =
            |t: &Trip| t.from.max(t.to) < count && t.from != t.to && (0.0..1e9).contains(&t.depart);
        if let Some(k) = trips.iter().position(|t| !fits(t)) {
            let t = trips[k];
            return Err(TrafficError::BadDemand {
                what: format!(
                    "trip {k} goes from node {} to {}, of {count}, at {} s",
                    t.from, t.to, t.depart
                ),
            });
        }
        let name = &options.name;
        let file = |end: &str, text: String| (format!("{name}.{end}"), text);
        let last = trips.iter().map(|t| t.depart).fold(0.0, f64::max);
        Ok(Self {
            name: name.clone(),
            trips: trips.len(),
            files: vec![
                file("nod.xml", nodes(graph)),
                file("edg.xml", edges(graph, &options.road_names)),
                file("typ.xml", types(graph)),
                file("trips.xml", demand(trips)),
                file("netccfg", net_options(name)),
                file("duarcfg", route_options(name)),
                file("sumocfg", sumo_options(name, last, options.reroute)),
            ],
        })
    }

    /// The files: their names and what is in them.
    #[must_use]
    pub fn files(&self) -> &[(String, String)] {
        &self.files
    }

    /// Writes the files into a folder that is there.
    ///
    /// # Errors
    ///
    /// [`TrafficError::Io`] for the first file that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), TrafficError> {
        for (name, text) in &self.files {
            let path = folder.join(name);
            std::fs::write(&path, text).map_err(|source| TrafficError::Io { path, source })?;
        }
        Ok(())
    }
}

/// Millimetres will do.
const DIGITS: usize = 3;

fn nodes(graph: &StreetGraph) -> String {
    let mut document = Document::new("nodes");
    for (n, at) in graph.nodes.iter().enumerate() {
        document.element(
            "node",
            &[
                ("id", &format!("n{n}")),
                ("x", &number(at.x, DIGITS)),
                ("y", &number(at.y, DIGITS)),
                ("type", "priority"),
            ],
        );
    }
    document.finish()
}

fn edges(graph: &StreetGraph, road_names: &[String]) -> String {
    let mut document = Document::new("edges");
    for (l, link) in graph.links.iter().enumerate() {
        let class = &graph.classes[link.class];
        let points = link.line.0.iter();
        let shape: Vec<String> = points
            .map(|p| format!("{},{}", number(p.x, DIGITS), number(p.y, DIGITS)))
            .collect();
        let name = road_names.get(link.road).unwrap_or(&class.name);
        document.element(
            "edge",
            &[
                ("id", &format!("e{l}")),
                ("from", &format!("n{}", link.from)),
                ("to", &format!("n{}", link.to)),
                ("type", &format!("c{}", link.class)),
                ("numLanes", &link.lanes.to_string()),
                ("speed", &number(link.speed, 4)),
                ("priority", &class.priority.to_string()),
                ("name", name),
                ("shape", &shape.join(" ")),
            ],
        );
    }
    document.finish()
}

fn types(graph: &StreetGraph) -> String {
    let mut document = Document::new("types");
    for (c, class) in graph.classes.iter().enumerate() {
        document.element(
            "type",
            &[
                ("id", &format!("c{c}")),
                ("priority", &class.priority.to_string()),
                ("numLanes", &class.lanes.to_string()),
                ("speed", &number(class.speed, 4)),
            ],
        );
    }
    document.finish()
}

fn demand(trips: &[Trip]) -> String {
    let mut document = Document::new("routes");
    document.element("vType", &[("id", "car"), ("vClass", "passenger")]);
    let mut order: Vec<usize> = (0..trips.len()).collect();
    // SUMO reads them by their times of departure.
    order.sort_by(|&a, &b| trips[a].depart.total_cmp(&trips[b].depart));
    for t in order {
        let trip = &trips[t];
        document.element(
            "trip",
            &[
                ("id", &format!("t{t}")),
                ("type", "car"),
                ("depart", &number(trip.depart, 2)),
                ("fromJunction", &format!("n{}", trip.from)),
                ("toJunction", &format!("n{}", trip.to)),
            ],
        );
    }
    document.finish()
}

/// A file of options: sections with their options and values.
fn options(sections: &[(&'static str, Vec<(&str, String)>)]) -> String {
    let mut document = Document::new("configuration");
    for (section, entries) in sections {
        document.open(section);
        for (name, value) in entries {
            document.element(name, &[("value", value)]);
        }
        document.close();
    }
    document.finish()
}

fn net_options(name: &str) -> String {
    options(&[
        (
            "input",
            vec![
                ("node-files", format!("{name}.nod.xml")),
                ("edge-files", format!("{name}.edg.xml")),
                ("type-files", format!("{name}.typ.xml")),
            ],
        ),
        ("output", vec![("output-file", format!("{name}.net.xml"))]),
    ])
}

fn route_options(name: &str) -> String {
    options(&[
        (
            "input",
            vec![
                ("net-file", format!("{name}.net.xml")),
                ("route-files", format!("{name}.trips.xml")),
            ],
        ),
        ("output", vec![("output-file", format!("{name}.rou.xml"))]),
        ("processing", vec![("junction-taz", "true".to_owned())]),
    ])
}

/// The simulation ends when all have arrived, or four hours after the last
/// departure.
fn sumo_options(name: &str, last: f64, reroute: bool) -> String {
    let mut sections = vec![
        (
            "input",
            vec![
                ("net-file", format!("{name}.net.xml")),
                ("route-files", format!("{name}.rou.xml")),
            ],
        ),
        (
            "output",
            vec![("tripinfo-output", format!("{name}.tripinfo.xml"))],
        ),
        (
            "time",
            vec![
                ("begin", "0".to_owned()),
                ("end", number((last + 4.0 * 3600.0).ceil(), 0)),
            ],
        ),
        ("processing", vec![("junction-taz", "true".to_owned())]),
        (
            "report",
            vec![
                ("no-step-log", "true".to_owned()),
                ("duration-log.disable", "true".to_owned()),
            ],
        ),
    ];
    if reroute {
        sections.push((
            "routing",
            vec![
                ("device.rerouting.probability", "1".to_owned()),
                ("device.rerouting.period", "60".to_owned()),
            ],
        ));
    }
    options(&sections)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn graph() -> StreetGraph {
        let mut graph = StreetGraph::default();
        for x in [0.0, 100.0] {
            graph.add_node(coord! { x: x, y: 0. });
        }
        graph.add_street(0, 1, 1, true).expect("a street");
        graph
    }

    const TRIP: Trip = Trip {
        from: 0,
        to: 1,
        depart: 3.0,
    };

    #[test]
    fn links_have_the_speed_of_their_class() {
        let later = Trip {
            depart: 1.0,
            ..TRIP
        };
        let options = SumoOptions {
            road_names: vec!["A & B".to_owned()],
            ..SumoOptions::default()
        };
        let made = SumoFiles::new(&graph(), &[TRIP, later], &options).expect("written");
        let text = |end: &str| {
            let file = made.files().iter().find(|(name, _)| name.ends_with(end));
            file.expect("there").1.clone()
        };
        // 30 mph are 13.4112 m/s.
        let edge = "<edge id=\"e1\" from=\"n1\" to=\"n0\" type=\"c1\" numLanes=\"1\" speed=\"13.4112\" priority=\"7\" name=\"A &amp; B\" shape=\"100,0 0,0\"/>";
        assert!(text(".edg.xml").contains(edge), "{}", text(".edg.xml"));
        let trips = text(".trips.xml");
        assert!(trips.find("\"t1\"") < trips.find("\"t0\""));
        assert!(text(".sumocfg").contains("device.rerouting"));
        assert_eq!(made.files().len(), 7);
    }

    #[test]
    fn strange_names_and_trips_are_refused() {
        for name in ["", "a/b", "..", "a b", "å"] {
            let options = SumoOptions {
                name: name.to_owned(),
                ..SumoOptions::default()
            };
            assert!(SumoFiles::new(&graph(), &[TRIP], &options).is_err());
        }
        for trip in [
            Trip { to: 2, ..TRIP },
            Trip { to: 0, ..TRIP },
            Trip {
                depart: -1.0,
                ..TRIP
            },
            Trip {
                depart: f64::NAN,
                ..TRIP
            },
        ] {
            assert!(SumoFiles::new(&graph(), &[trip], &SumoOptions::default()).is_err());
        }
    }
}
