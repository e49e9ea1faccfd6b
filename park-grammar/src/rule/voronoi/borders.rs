//! Borders between cells, displaced by chance.
//!
//! The notes: "The resulting boundary can be varied by offsetting it with random
//! values along the averaged normal." A border is moved along its normal by values
//! drawn every wavelength, eased from one to the next; both cells share the moved
//! line. It stays in the two triangles that the border makes with the hearts of
//! its cells, which are disjoint for all borders: so no moved line meets another,
//! and each cell keeps its site, whatever amplitude is asked for. Towards its
//! ends, where borders meet, the displacement comes to nothing.

use std::collections::BTreeMap;

use geo_types::Coord;

use crate::derive::Stream;
use crate::plane::{aside, dist, dot, heart, leeway, unit, Border, Diagram, Ring, Site};

/// Of the way to the heart of a cell a border may go this share.
const SHARE: f64 = 0.7;

/// Points of a line for each wavelength.
const FINE: f64 = 4.0;

/// Most points of a border.
const MOST: f64 = 400.0;

/// How borders are displaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wave {
    /// Metres to either side at most; 0 for straight borders.
    pub(super) amplitude: f64,
    /// Metres from one value to the next.
    pub(super) length: f64,
}

/// The rings of all cells, by site.
pub(super) fn rings(
    diagram: &Diagram,
    sites: &[Site],
    wave: &Wave,
    chance: &mut Stream,
) -> Vec<Ring> {
    let plain = |ring: &Vec<usize>| diagram.weld.points(ring);
    if wave.amplitude <= 0.0 {
        return diagram.cells.iter().map(plain).collect();
    }
    let lines = lines(diagram, sites, wave, chance);
    let cells = diagram.cells.iter();
    cells
        .map(|ring| {
            let mut points = Ring::new();
            for (k, &from) in ring.iter().enumerate() {
                let to = ring[(k + 1) % ring.len()];
                points.push(diagram.weld.at(from));
                if let Some(line) = lines.get(&(from, to)) {
                    points.extend(line);
                } else if let Some(line) = lines.get(&(to, from)) {
                    points.extend(line.iter().rev());
                }
            }
            points
        })
        .collect()
}

/// The inner points of each displaced border, by its ends.
fn lines(
    diagram: &Diagram,
    sites: &[Site],
    wave: &Wave,
    chance: &mut Stream,
) -> BTreeMap<(usize, usize), Vec<Coord<f64>>> {
    let hearts: Vec<Coord<f64>> = diagram
        .cells
        .iter()
        .zip(sites)
        .map(|(ring, site)| heart(&diagram.weld.points(ring), site.at))
        .collect();
    // The cells at each junction: what tells its borders' ends apart.
    let mut around: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (cell, ring) in diagram.cells.iter().enumerate() {
        for &vertex in ring {
            around.entry(vertex).or_default().push(cell);
        }
    }
    let third = |vertex: usize, between: [usize; 2]| {
        let cells = around.get(&vertex).into_iter().flatten();
        cells.copied().find(|cell| !between.contains(cell))
    };
    let mut lines = BTreeMap::new();
    for border in diagram.borders() {
        let mut chance = chance.child();
        let ends = border.ends.map(|k| diagram.weld.at(k));
        let long = dist(ends[0], ends[1]);
        // Where the values are counted from: the end where the cell of the lower
        // number meets; between the sites where neither end is a junction.
        let thirds = border.ends.map(|end| third(end, border.between));
        let from = match thirds {
            [Some(a), Some(b)] if b < a => long,
            [None, Some(_)] => long,
            [None, None] => between(&border, sites, ends),
            _ => 0.0,
        };
        let count = (long / wave.length * FINE).ceil().min(MOST);
        let mut values = Vec::new();
        let mut value = |k: usize| {
            while values.len() <= k {
                values.push(chance.between([-1.0, 1.0]));
            }
            values[k]
        };
        let inner = (1..count as usize).map(|k| {
            let share = k as f64 / count;
            let steps = (share * long - from).abs() / wave.length;
            let t = steps.fract();
            let ease = t * t * (3.0 - 2.0 * t);
            let whole = steps.floor() as usize;
            let noise = value(whole) * (1.0 - ease) + value(whole + 1) * ease;
            let wanted = wave.amplitude * noise;
            // The land of the lower number lies on the right.
            let side = usize::from(wanted > 0.0);
            let room = SHARE * leeway(ends, hearts[border.between[side]], share);
            if room <= 0.0 {
                return aside(ends, share, 0.0);
            }
            aside(ends, share, wanted / (1.0 + (wanted / room).powi(2)).sqrt())
        });
        lines.insert((border.ends[0], border.ends[1]), inner.collect());
    }
    lines
}

/// Where a border passes between its sites, metres from its first end.
fn between(border: &Border, sites: &[Site], [a, b]: [Coord<f64>; 2]) -> f64 {
    let [p, q] = border.between.map(|k| sites[k].at);
    dot((p + q) / 2.0 - a, unit(b - a))
}
