//! Streets look like streets: no stubs, no crowded junctions, no sharp angles,
//! no zigzags.

use geo_types::Coord;
use rstar::primitives::GeomWithData;
use rstar::{RTree, AABB};

use super::network::{place, End, Node};
use super::{CheckOptions, Exits, Findings, Network};
use crate::layout::plane::{cross, distance, dot, lerp, minus, turn_deg, usable};
use crate::layout::Layout;
use crate::site::RoadClass;

/// A street's direction at a junction is measured over this length, metres.
const DIRECTION_LENGTH: f64 = 10.0;
/// Most that a street may turn at one vertex, degrees.
const SHARP_DEG: f64 = 45.0;
/// Two opposite turns of more than this make a zigzag, degrees ...
const SWERVE_DEG: f64 = 25.0;
/// ... if they lie within this length of the street, metres.
const SWERVE_LENGTH: f64 = 30.0;
/// Turns under this are straight on, degrees.
const STRAIGHT_DEG: f64 = 0.05;

/// Judges `stubs`, `junction_spacing`, `meeting_angle`, `sharp_turns` and
/// `zigzags`.
pub(crate) fn judge(
    layout: &Layout,
    network: &Network<'_>,
    exits: &Exits,
    options: &CheckOptions,
    findings: &mut Findings,
) {
    findings.none_of("stubs", stubs(network, exits));
    findings.none_of("junction_spacing", crowded(network, options));
    findings.none_of("meeting_angle", acute(network, options));
    let (mut sharp, mut zigzags) = (Vec::new(), Vec::new());
    for street in layout.streets.iter().filter(|s| !s.given) {
        let line = &street.line.0;
        if let Some((turn, at)) = sharpest(line).filter(|(turn, _)| turn.abs() > SHARP_DEG) {
            sharp.push(format!(
                "street {} turns {turn:.0} degrees at one vertex {}",
                street.id,
                place(at)
            ));
        }
        if let Some((long, at)) = tightest_swerve(line).filter(|(long, _)| *long <= SWERVE_LENGTH) {
            zigzags.push(format!(
                "street {} swerves left and right within {long:.1} m {}",
                street.id,
                place(at)
            ));
        }
    }
    findings.none_of("sharp_turns", sharp);
    findings.none_of("zigzags", zigzags);
}

/// Ends inside the site that are no cul-de-sac's and no given road's.
fn stubs(network: &Network<'_>, exits: &Exits) -> Vec<String> {
    let mut faults = Vec::new();
    for node in network.nodes.iter().filter(|node| node.ends.len() == 1) {
        let street = &network.streets[node.ends[0].street];
        let meant = street.class == RoadClass::CulDeSac || street.given;
        if !meant && !exits.at_boundary(node.at) {
            faults.push(format!(
                "street {} ends inside the site {}",
                street.id,
                place(node.at)
            ));
        }
    }
    faults
}

/// For each node, the number of the connected set of given roads that it is on.
fn given_sets(network: &Network<'_>) -> Vec<Option<usize>> {
    let mut set: Vec<Option<usize>> = vec![None; network.nodes.len()];
    let given = |node: &Node| node.ends.iter().any(|e| network.streets[e.street].given);
    for start in 0..set.len() {
        if set[start].is_some() || !given(&network.nodes[start]) {
            continue;
        }
        let mut stack = vec![start];
        set[start] = Some(start);
        while let Some(at) = stack.pop() {
            for end in network.nodes[at]
                .ends
                .iter()
                .filter(|e| network.streets[e.street].given)
            {
                let street = &network.streets[end.street];
                for other in [street.from, street.to]
                    .into_iter()
                    .filter_map(|id| network.number(id))
                {
                    if set[other].is_none() {
                        set[other] = Some(start);
                        stack.push(other);
                    }
                }
            }
        }
    }
    set
}

/// Pairs of junctions closer than the width of the narrowest street at either.
/// Pairs that the site itself gives are not counted: both of given roads alone,
/// or on given roads that are not connected to each other by given roads.
fn crowded(network: &Network<'_>, options: &CheckOptions) -> Vec<String> {
    let narrowest = |node: &Node| {
        let widths = node
            .ends
            .iter()
            .map(|e| network.streets[e.street].width)
            .filter(|w| *w > 0.0);
        widths.fold(f64::INFINITY, f64::min)
    };
    let width: Vec<f64> = network
        .nodes
        .iter()
        .map(narrowest)
        .map(|w| {
            if w.is_finite() {
                w
            } else {
                options.junction_spacing
            }
        })
        .collect();
    let only_given: Vec<bool> = network
        .nodes
        .iter()
        .map(|n| n.ends.iter().all(|e| network.streets[e.street].given))
        .collect();
    let sets = given_sets(network);
    let points = network
        .nodes
        .iter()
        .enumerate()
        .filter(|(_, n)| usable(n.at))
        .map(|(i, n)| GeomWithData::new([n.at.x, n.at.y], i));
    let tree = RTree::bulk_load(points.collect::<Vec<_>>());
    let mut pairs = Vec::new();
    for (i, node) in network
        .nodes
        .iter()
        .enumerate()
        .filter(|(_, n)| usable(n.at))
    {
        let reach = width[i];
        let low = [node.at.x - reach, node.at.y - reach];
        let high = [node.at.x + reach, node.at.y + reach];
        for other in tree.locate_in_envelope(&AABB::from_corners(low, high)) {
            let j = other.data;
            let apart = distance(node.at, network.nodes[j].at);
            // Each pair once, found from either side.
            if i == j || apart >= width[i].min(width[j]) || (only_given[i] && only_given[j]) {
                continue;
            }
            if matches!((sets[i], sets[j]), (Some(a), Some(b)) if a != b) {
                continue;
            }
            pairs.push((i.min(j), i.max(j), apart));
        }
    }
    pairs.sort_by_key(|pair| (pair.0, pair.1));
    pairs.dedup_by(|next, kept| (next.0, next.1) == (kept.0, kept.1));
    pairs
        .into_iter()
        .map(|(i, j, apart)| {
            let (a, b) = (&network.nodes[i], &network.nodes[j]);
            format!(
                "junctions {} and {} are {apart:.1} m apart {}",
                a.id,
                b.id,
                place(a.at)
            )
        })
        .collect()
}

/// Unit direction in which a street leaves a junction, over its first
/// [`DIRECTION_LENGTH`] or its whole length if that is less.
fn direction(network: &Network<'_>, end: End) -> Option<Coord<f64>> {
    let line = &network.streets[end.street].line.0;
    let point = |i: usize| {
        if end.last {
            line[line.len() - 1 - i]
        } else {
            line[i]
        }
    };
    let start = *line.first().filter(|_| line.len() > 1).map(|first| {
        if end.last {
            line.last().unwrap_or(first)
        } else {
            first
        }
    })?;
    let mut left = DIRECTION_LENGTH;
    let mut tip = start;
    for i in 1..line.len() {
        let (a, b) = (point(i - 1), point(i));
        let step = distance(a, b);
        if step >= left {
            tip = lerp(a, b, left / step);
            break;
        }
        left -= step;
        tip = b;
    }
    let long = distance(start, tip);
    let u = minus(tip, start);
    (long > 0.0).then(|| Coord {
        x: u.x / long,
        y: u.y / long,
    })
}

/// Pairs of streets that leave a junction with less than the least angle
/// between them; two given roads are the site's own affair.
fn acute(network: &Network<'_>, options: &CheckOptions) -> Vec<String> {
    let mut faults = Vec::new();
    for node in &network.nodes {
        let leaving: Vec<(End, Coord<f64>)> = node
            .ends
            .iter()
            .filter_map(|end| Some((*end, direction(network, *end)?)))
            .collect();
        for (i, (e, u)) in leaving.iter().enumerate() {
            for (f, v) in &leaving[..i] {
                let (s, t) = (&network.streets[e.street], &network.streets[f.street]);
                let angle = cross(*u, *v).abs().atan2(dot(*u, *v)).to_degrees();
                if angle < options.meeting_angle_deg && !(s.given && t.given) {
                    faults.push(format!(
                        "streets {} and {} meet at {angle:.0} degrees, junction {} {}",
                        t.id,
                        s.id,
                        node.id,
                        place(node.at)
                    ));
                }
            }
        }
    }
    faults
}

/// The greatest turn at one vertex, degrees, and where.
fn sharpest(line: &[Coord<f64>]) -> Option<(f64, Coord<f64>)> {
    line.windows(3)
        .map(|w| (turn_deg(w[0], w[1], w[2]), w[1]))
        .max_by(|p, q| p.0.abs().total_cmp(&q.0.abs()))
}

/// The shortest stretch in which the line turns by more than [`SWERVE_DEG`] to
/// one side and then, in the next bend, as much to the other; and where it
/// changes sides. A bend is a run of vertices that turn to one side, so that a
/// swerve counts whether it is made of sharp vertices or of small ones.
fn tightest_swerve(line: &[Coord<f64>]) -> Option<(f64, Coord<f64>)> {
    // (arc length, turn, vertex) of every vertex that turns.
    let mut turns: Vec<(f64, f64, usize)> = Vec::new();
    let mut at = 0.0;
    for (i, w) in line.windows(3).enumerate() {
        at += distance(w[0], w[1]);
        let turn = turn_deg(w[0], w[1], w[2]);
        if turn.abs() > STRAIGHT_DEG {
            turns.push((at, turn, i + 1));
        }
    }
    let bends: Vec<&[(f64, f64, usize)]> =
        turns.chunk_by(|p, q| (p.1 > 0.0) == (q.1 > 0.0)).collect();
    let mut best: Option<(f64, Coord<f64>)> = None;
    for pair in bends.windows(2) {
        let reach = |turns: &mut dyn Iterator<Item = &(f64, f64, usize)>| {
            let mut sum = 0.0;
            for turn in turns {
                sum += turn.1.abs();
                if sum > SWERVE_DEG {
                    return Some(turn.0);
                }
            }
            None
        };
        let (Some(from), Some(to)) = (reach(&mut pair[0].iter().rev()), reach(&mut pair[1].iter()))
        else {
            continue;
        };
        if best.is_none_or(|(long, _)| to - from < long) {
            best = Some((to - from, line[pair[1][0].2]));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[(f64, f64)]) -> Vec<Coord<f64>> {
        points.iter().map(|&(x, y)| Coord { x, y }).collect()
    }

    #[test]
    fn a_jog_is_a_zigzag_and_a_wide_curve_is_not() {
        let jog = line(&[(0., 0.), (50., 0.), (60., 8.), (110., 8.)]);
        assert!(tightest_swerve(&jog).is_some_and(|(long, _)| long < 15.0));
        // An S of two quarter circles of radius 40 m, 9 degrees a vertex: it
        // takes 2 x 2 steps of 6.3 m to swerve by 18 degrees, more for 25.
        let mut s = Vec::new();
        for k in 0..=10 {
            let a = f64::from(k) * 9.0_f64.to_radians();
            s.push((40.0 * a.sin(), 40.0 - 40.0 * a.cos()));
        }
        for k in 1..=10 {
            let a = f64::from(k) * 9.0_f64.to_radians();
            s.push((80.0 - 40.0 * a.cos(), 40.0 + 40.0 * a.sin()));
        }
        let s = line(&s);
        assert!(tightest_swerve(&s).is_some_and(|(long, _)| long > 25.0));
        assert!(tightest_swerve(&line(&[(0., 0.), (9., 0.), (18., 5.)])).is_none());
    }

    #[test]
    fn the_sharpest_turn_is_found() {
        let bent = line(&[(0., 0.), (10., 0.), (20., 1.), (20., 9.)]);
        let (turn, at) = sharpest(&bent).expect("three points");
        assert!(turn > 80.0 && at == Coord { x: 20.0, y: 1.0 });
    }
}
