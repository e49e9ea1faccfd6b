//! The street graph: junctions, components, ways out, crossings.

use std::collections::BTreeMap;

use geo_types::Coord;
use i_overlay::core::overlay_rule::OverlayRule;

use super::{Exits, Findings};
use crate::layout::plane::{
    crossing, distance, distance_to_segment, lerp, overlay, polygon_area, Segment, Segments,
};
use crate::layout::{Layout, Street};
use crate::site::Site;

/// Street ends of one junction are this close, metres.
const SAME_END: f64 = 0.05;
/// Streets may touch this near to one of their ends, metres.
const NEAR_END: f64 = 0.1;

/// One end of a street at a junction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct End {
    /// Number of the street in the layout.
    pub(crate) street: usize,
    /// Whether it is the line's last point that is here.
    pub(crate) last: bool,
}

/// A junction as the streets tell it, not as the layout claims it.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) id: u64,
    pub(crate) at: Coord<f64>,
    pub(crate) ends: Vec<End>,
    pub(crate) component: usize,
}

/// The street graph of a layout.
#[derive(Debug)]
pub(crate) struct Network<'a> {
    pub(crate) streets: &'a [Street],
    pub(crate) nodes: Vec<Node>,
    by_id: BTreeMap<u64, usize>,
    /// Whether each component leads out of the site.
    leads_out: Vec<bool>,
}

impl<'a> Network<'a> {
    pub(crate) fn new(layout: &'a Layout, exits: &Exits) -> Self {
        let mut network = Self {
            streets: &layout.streets,
            nodes: Vec::new(),
            by_id: BTreeMap::new(),
            leads_out: Vec::new(),
        };
        for (street, s) in layout.streets.iter().enumerate() {
            let ends = [
                (s.from, s.line.0.first(), false),
                (s.to, s.line.0.last(), true),
            ];
            for (id, at, last) in ends {
                let Some(&at) = at else { continue };
                let nodes = &mut network.nodes;
                let number = *network.by_id.entry(id).or_insert_with(|| {
                    nodes.push(Node {
                        id,
                        at,
                        ends: Vec::new(),
                        component: usize::MAX,
                    });
                    nodes.len() - 1
                });
                network.nodes[number].ends.push(End { street, last });
            }
        }
        network.find_components(exits);
        network
    }

    fn find_components(&mut self, exits: &Exits) {
        for start in 0..self.nodes.len() {
            if self.nodes[start].component != usize::MAX {
                continue;
            }
            let component = self.leads_out.len();
            let mut out = false;
            let mut stack = vec![start];
            self.nodes[start].component = component;
            while let Some(number) = stack.pop() {
                out |= exits.at_exit(self.nodes[number].at);
                for end in self.nodes[number].ends.clone() {
                    let s = &self.streets[end.street];
                    for id in [s.from, s.to] {
                        let other = self.by_id[&id];
                        if self.nodes[other].component == usize::MAX {
                            self.nodes[other].component = component;
                            stack.push(other);
                        }
                    }
                }
            }
            self.leads_out.push(out);
        }
    }

    /// Number of street networks that are not connected to each other.
    pub(crate) fn components(&self) -> usize {
        self.leads_out.len()
    }

    /// Number of the node of an id.
    pub(crate) fn number(&self, id: u64) -> Option<usize> {
        self.by_id.get(&id).copied()
    }

    /// Component of a street.
    pub(crate) fn component_of(&self, street: &Street) -> Option<usize> {
        self.number(street.from)
            .map(|number| self.nodes[number].component)
    }

    /// Whether a street belongs to a component that leads out.
    pub(crate) fn leads_out(&self, street: &Street) -> bool {
        self.component_of(street).is_some_and(|c| self.leads_out[c])
    }

    /// Junctions of one street end that are no way out.
    pub(crate) fn dead_ends(&self, exits: &Exits) -> usize {
        self.nodes
            .iter()
            .filter(|node| node.ends.len() == 1 && !exits.at_exit(node.at))
            .count()
    }

    /// Judges `junctions`, `crossings` and `exits`.
    pub(crate) fn judge(&self, layout: &Layout, findings: &mut Findings) {
        findings.none_of("junctions", self.junction_faults(layout));
        findings.none_of("crossings", self.crossing_faults());
        let mut lost = Vec::new();
        for (component, out) in self.leads_out.iter().enumerate() {
            if let (false, Some(node)) =
                (*out, self.nodes.iter().find(|n| n.component == component))
            {
                lost.push(format!(
                    "the streets around junction {} never reach a way out {}",
                    node.id,
                    place(node.at)
                ));
            }
        }
        findings.none_of("exits", lost);
    }

    fn junction_faults(&self, layout: &Layout) -> Vec<String> {
        let mut faults = Vec::new();
        let claimed: BTreeMap<u64, _> = layout.junctions.iter().map(|j| (j.id, j)).collect();
        for node in &self.nodes {
            for end in &node.ends {
                let line = &self.streets[end.street].line.0;
                let at = if end.last { line.last() } else { line.first() };
                let apart = at.map_or(f64::INFINITY, |at| distance(*at, node.at));
                if apart > SAME_END {
                    let street = self.streets[end.street].id;
                    faults.push(format!(
                        "street {street} ends {apart:.2} m from the others at junction {}",
                        node.id
                    ));
                }
            }
            match claimed.get(&node.id) {
                None => faults.push(format!(
                    "junction {} has streets but no point {}",
                    node.id,
                    place(node.at)
                )),
                Some(j) if distance(j.at, node.at) > SAME_END => {
                    faults.push(format!(
                        "junction {} lies {:.2} m from its streets",
                        node.id,
                        distance(j.at, node.at)
                    ));
                }
                Some(j) if j.degree != node.ends.len() => {
                    let ends = node.ends.len();
                    faults.push(format!(
                        "junction {} says degree {}, {ends} streets end there",
                        node.id, j.degree
                    ));
                }
                Some(_) => {}
            }
        }
        for j in layout
            .junctions
            .iter()
            .filter(|j| !self.by_id.contains_key(&j.id))
        {
            faults.push(format!("junction {} has no streets {}", j.id, place(j.at)));
        }
        for s in layout.streets.iter().filter(|s| s.line.0.len() < 2) {
            faults.push(format!("street {} has fewer than two points", s.id));
        }
        faults
    }

    /// Places where two streets, or a street and itself, meet away from ends.
    fn crossing_faults(&self) -> Vec<String> {
        let index = Segments::of_lines(self.streets.iter().map(|s| s.line.0.as_slice()));
        let mut found: Vec<(usize, usize, Coord<f64>)> = Vec::new();
        for s in index.iter() {
            for t in index.near(s.a, s.b, NEAR_END) {
                if (t.owner, t.index) <= (s.owner, s.index) {
                    continue;
                }
                if let Some(at) = self.illicit_meeting(s, t) {
                    found.push((s.owner, t.owner, at));
                }
            }
        }
        found.sort_by(|p, q| {
            (p.0, p.1)
                .cmp(&(q.0, q.1))
                .then(p.2.x.total_cmp(&q.2.x))
                .then(p.2.y.total_cmp(&q.2.y))
        });
        found.dedup_by(|next, kept| (next.0, next.1) == (kept.0, kept.1));
        found
            .into_iter()
            .map(|(i, j, at)| {
                let (a, b) = (self.streets[i].id, self.streets[j].id);
                format!("streets {a} and {b} meet without a junction {}", place(at))
            })
            .collect()
    }

    /// A place where two segments cross or overlap, or the end of one street
    /// stands on the other, and not both streets end there.
    fn illicit_meeting(&self, s: &Segment, t: &Segment) -> Option<Coord<f64>> {
        let ends = |owner: usize| {
            let line = &self.streets[owner].line.0;
            [line.first(), line.last()].into_iter().flatten().copied()
        };
        let ends_near =
            |owner: usize, p: Coord<f64>| ends(owner).any(|e| distance(e, p) <= NEAR_END);
        let excused = |p: Coord<f64>| ends_near(s.owner, p) && ends_near(t.owner, p);
        if s.owner == t.owner && t.index == s.index + 1 {
            return None; // they share a vertex; doubling back is a sharp turn
        }
        // Segments with an end in common meet there and, unless they overlap,
        // nowhere else; where they are nearly in line, the crossing of their
        // lines could be computed anywhere along them.
        let joined = [s.a, s.b].iter().any(|p| [t.a, t.b].contains(p));
        if let Some((at, _)) = crossing(s.a, s.b, t.a, t.b).filter(|_| !joined) {
            let p = lerp(s.a, s.b, at);
            return (!excused(p)).then_some(p);
        }
        // Overlapping, or an end of one street (almost) on the other.
        for (p, owner, a, b) in [
            (s.a, s.owner, t.a, t.b),
            (s.b, s.owner, t.a, t.b),
            (t.a, t.owner, s.a, s.b),
            (t.b, t.owner, s.a, s.b),
        ] {
            let reach = if ends(owner).any(|e| e == p) {
                NEAR_END
            } else {
                1e-6
            };
            if distance_to_segment(p, a, b) <= reach && !excused(p) {
                return Some(p);
            }
        }
        None
    }
}

/// Coordinates for a message.
pub(crate) fn place(at: Coord<f64>) -> String {
    format!("at ({:.1}, {:.1}) m", at.x, at.y)
}

/// Judges `networks`: the streets that touch one connected part of the site's
/// land (the site less what is given on it) are all connected.
pub(crate) fn judge_parts(site: &Site, network: &Network<'_>, findings: &mut Findings) {
    let land = overlay(
        &site.parts,
        site.elements.iter().map(|e| &e.polygon),
        OverlayRule::Difference,
    );
    let index = Segments::of_polygons(&land);
    let mut met: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for street in network.streets {
        let Some(component) = network.component_of(street) else {
            continue;
        };
        for w in street.line.0.windows(2) {
            for part in index.containing(lerp(w[0], w[1], 0.5)) {
                *met.entry((part, component)).or_default() += distance(w[0], w[1]);
            }
        }
    }
    let mut faults = Vec::new();
    for (number, part) in land.iter().enumerate() {
        // A few metres are a street that grazes the part's edge.
        let here = met
            .iter()
            .filter(|((part, _), long)| *part == number && **long > 5.0)
            .count();
        if here > 1 {
            let at = part.exterior().0.first().copied().unwrap_or_default();
            let km2 = polygon_area(part) / 1e6;
            faults.push(format!(
                "{here} street networks on one part of {km2:.4} km2 with a vertex {}",
                place(at)
            ));
        }
    }
    findings.none_of("networks", faults);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::site::RoadClass;
    use geo_types::LineString;

    fn street(id: u64, from: u64, to: u64, line: Vec<Coord<f64>>) -> Street {
        Street {
            id,
            line: LineString::new(line),
            class: RoadClass::Local,
            width: 15.0,
            from,
            to,
            given: false,
            name: None,
            lineage: None,
        }
    }

    fn faults(streets: Vec<Street>) -> usize {
        let layout = Layout {
            streets,
            ..Layout::default()
        };
        let network = Network {
            streets: &layout.streets,
            nodes: Vec::new(),
            by_id: BTreeMap::new(),
            leads_out: Vec::new(),
        };
        network.crossing_faults().len()
    }

    /// Two streets in line, but for the last digits, were once said to cross far
    /// from the junction where they meet.
    #[test]
    fn regression_streets_in_line_meet_at_their_junction_only() {
        for k in 0..2000 {
            let angle = f64::from(k) * 0.003;
            let at = |r: f64, turn: f64| Coord {
                x: 400.0 + r * (angle + turn).cos(),
                y: -300.0 + r * (angle + turn).sin(),
            };
            let joint = at(0.0, 0.0);
            for turn in [0.0, 1e-15, 1e-13, 1e-9, 1e-3] {
                let streets = vec![
                    street(1, 1, 2, vec![at(-60.0, 0.0), joint]),
                    street(2, 2, 3, vec![joint, at(70.0, turn)]),
                ];
                assert_eq!(faults(streets), 0, "{angle} {turn}");
            }
        }
    }

    #[test]
    fn streets_that_cross_or_lie_on_each_other_are_found() {
        let c = |x: f64, y: f64| Coord { x, y };
        let main = street(1, 1, 2, vec![c(0., 0.), c(100., 0.)]);
        let across = street(2, 3, 4, vec![c(50., -40.), c(51., 40.)]);
        assert_eq!(faults(vec![main.clone(), across]), 1);
        let upon = street(2, 1, 4, vec![c(0., 0.), c(60., 0.)]);
        assert_eq!(faults(vec![main, upon]), 1);
    }
}
