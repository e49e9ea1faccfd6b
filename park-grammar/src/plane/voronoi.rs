//! Voronoi cells, and power cells of circles.
//!
//! The cell of a site is what lies nearer to it than to any other; with weights,
//! nearer by the power distance |x - site|^2 - weight (Aurenhammer 1987, "Power
//! diagrams: properties, algorithms and applications"), whose borders are
//! straight too. With the squares of radii as weights, circles that do not
//! overlap lie whole in their own cells.

use geo_types::Coord;

use super::{cross, dist, dot, lerp, Ring, Weld};

/// Vertices this near, as a share of the frame's size, are one: where more than
/// three cells meet, each computes the corner from other neighbours.
const SAME: f64 = 1e-8;

/// What a cell grows from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Site {
    pub(crate) at: Coord<f64>,
    /// Square metres; 0 for a plain diagram.
    pub(crate) weight: f64,
}

/// A diagram in a frame: cells that share their vertices.
#[derive(Clone, Debug)]
pub(crate) struct Diagram {
    pub(crate) weld: Weld,
    /// By site, clockwise; empty for a site that others leave nothing.
    pub(crate) cells: Vec<Vec<usize>>,
}

/// A line between two cells, from one junction to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Border {
    /// The cells beside it, the lower number first.
    pub(crate) between: [usize; 2],
    /// Its ends, as the cell of the lower number walks them.
    pub(crate) ends: [usize; 2],
}

impl Diagram {
    /// The cells of sites in a convex frame that runs clockwise. Sites must differ.
    ///
    /// # Cost
    ///
    /// Sites are visited from near to far along x until none can matter: about
    /// n^1.5 steps for n sites that are spread evenly.
    pub(crate) fn new(sites: &[Site], frame: &Ring) -> Self {
        let (low, high) = super::extent(frame);
        let size = dist(low, high);
        let mut order: Vec<usize> = (0..sites.len()).collect();
        order.sort_by(|&a, &b| sites[a].at.x.total_cmp(&sites[b].at.x).then(a.cmp(&b)));
        let heaviest = sites.iter().map(|s| s.weight).fold(0.0, f64::max);
        let rings: Vec<Ring> = {
            let mut rings = vec![Ring::new(); sites.len()];
            for (place, &k) in order.iter().enumerate() {
                rings[k] = cell(sites, &order, place, frame, heaviest);
            }
            rings
        };
        let mut weld = Weld::for_rings(SAME * size, &rings);
        let numbered: Vec<Vec<usize>> = rings.iter().map(|ring| weld.ring(ring)).collect();
        let cells = numbered.iter().map(|ring| weld.noded(ring));
        let cells = cells.map(|ring| if ring.len() > 2 { ring } else { Vec::new() });
        Self {
            cells: cells.collect(),
            weld,
        }
    }

    /// All borders between cells, sorted.
    pub(crate) fn borders(&self) -> Vec<Border> {
        let mut edges: Vec<(usize, usize, usize)> = Vec::new();
        for (cell, ring) in self.cells.iter().enumerate() {
            for (k, &from) in ring.iter().enumerate() {
                edges.push((from, ring[(k + 1) % ring.len()], cell));
            }
        }
        edges.sort_unstable();
        let mut borders = Vec::new();
        for &(from, to, cell) in &edges {
            let k = edges.partition_point(|&(a, b, _)| (a, b) < (to, from));
            let Some(&(_, _, other)) = edges.get(k).filter(|e| (e.0, e.1) == (to, from)) else {
                continue;
            };
            if cell < other {
                borders.push(Border {
                    between: [cell, other],
                    ends: [from, to],
                });
            }
        }
        borders.sort_unstable();
        borders
    }
}

/// The cell of the site at a place in the order along x.
fn cell(sites: &[Site], order: &[usize], place: usize, frame: &Ring, heaviest: f64) -> Ring {
    let own = sites[order[place]];
    let mut ring = frame.clone();
    let mut reach = radius(&ring, own.at);
    // How far, along the line to a site at a distance, the border lies at least.
    let border = |far: f64, weight: f64| 0.5 * (far * far + own.weight - weight) / far;
    let (mut left, mut right) = (place, place + 1);
    loop {
        let aside = |k: usize| (sites[order[k]].at.x - own.at.x).abs();
        let west = left.checked_sub(1).map(aside);
        let east = (right < order.len()).then(|| aside(right));
        let (next, off) = match (west, east) {
            (Some(w), Some(e)) if w <= e => (left - 1, w),
            (_, Some(e)) => (right, e),
            (Some(w), None) => (left - 1, w),
            (None, None) => return ring,
        };
        // All that follow are farther along x; the border moves out with the
        // distance once that is above the root of the difference of weights.
        let settled = off * off > (heaviest - own.weight).max(0.0);
        if settled && off > 0.0 && border(off, heaviest) > reach {
            return ring;
        }
        if next < left {
            left = next;
        } else {
            right = next + 1;
        }
        let other = sites[order[next]];
        let far = dist(own.at, other.at);
        if far == 0.0 || border(far, other.weight) > reach {
            continue;
        }
        ring = nearer(&ring, own, other);
        if ring.len() < 3 {
            return Ring::new();
        }
        reach = radius(&ring, own.at);
    }
}

fn radius(ring: &Ring, at: Coord<f64>) -> f64 {
    ring.iter().map(|&p| dist(p, at)).fold(0.0, f64::max)
}

/// What of a convex ring lies nearer to one site than to another.
fn nearer(ring: &Ring, own: Site, other: Site) -> Ring {
    let way = other.at - own.at;
    let far = dot(way, way).sqrt();
    let limit = 0.5 * (far * far + own.weight - other.weight) / far;
    super::clipped(ring, &|p| limit - dot(p - own.at, way) / far)
}

/// A place from which all of a convex cell is seen: its site if that lies in it.
pub(crate) fn heart(ring: &Ring, site: Coord<f64>) -> Coord<f64> {
    let inside = super::sides(ring).all(|(a, b)| cross(b - a, site - a) < 0.0);
    if inside {
        site
    } else {
        let sum = ring.iter().fold(Coord::default(), |sum, &p| sum + p);
        sum / ring.len().max(1) as f64
    }
}

/// How far a line may be moved at a share of its length, along its normal towards
/// a heart, without leaving the triangle that the two make.
pub(crate) fn leeway([a, b]: [Coord<f64>; 2], heart: Coord<f64>, share: f64) -> f64 {
    let along = b - a;
    let long = dot(along, along).sqrt();
    let foot = dot(heart - a, along) / (long * long);
    let height = cross(along, heart - a).abs() / long;
    let mut most = f64::INFINITY;
    if foot > 0.0 {
        most = most.min(height * share / foot);
    }
    if foot < 1.0 {
        most = most.min(height * (1.0 - share) / (1.0 - foot));
    }
    most
}

/// The point at a share of a line, moved to its left.
pub(crate) fn aside([a, b]: [Coord<f64>; 2], share: f64, left: f64) -> Coord<f64> {
    lerp(a, b, share) - super::right(super::unit(b - a)) * left
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::derive::Stream;
    use geo_types::coord;

    fn frame(size: f64) -> Ring {
        [(0., 0.), (0., size), (size, size), (size, 0.)]
            .map(|(x, y)| coord! { x: x, y: y })
            .to_vec()
    }

    fn site(x: f64, y: f64, weight: f64) -> Site {
        Site {
            at: coord! { x: x, y: y },
            weight,
        }
    }

    fn total(diagram: &Diagram) -> f64 {
        let area = |ring: &Vec<usize>| -super::super::signed_area(&diagram.weld.points(ring));
        diagram.cells.iter().map(area).sum()
    }

    /// Points of a grid, where four cells meet in each corner: whatever is
    /// computed, cells tile and each has the neighbours across its sides alone.
    #[test]
    fn grids_are_no_trouble() {
        let sites: Vec<Site> = (0..36)
            .map(|k| site(f64::from(k % 6) + 0.5, f64::from(k / 6) + 0.5, 0.0))
            .collect();
        let diagram = Diagram::new(&sites, &frame(6.0));
        assert!((total(&diagram) - 36.0).abs() < 1e-9);
        assert_eq!(diagram.borders().len(), 60);
        assert!(diagram.cells.iter().all(|ring| ring.len() == 4));
    }

    /// Each point of the frame lies in the cell of its nearest site.
    #[test]
    fn cells_hold_what_is_nearest() {
        let mut chance = Stream::new(3);
        for weighted in [false, true] {
            let sites: Vec<Site> = (0..120)
                .map(|_| {
                    let weight = if weighted { 20.0 * chance.unit() } else { 0.0 };
                    site(100.0 * chance.unit(), 100.0 * chance.unit(), weight)
                })
                .collect();
            let diagram = Diagram::new(&sites, &frame(100.0));
            assert!((total(&diagram) - 1e4).abs() < 1e-3);
            for _ in 0..2000 {
                let p = coord! { x: 100.0 * chance.unit(), y: 100.0 * chance.unit() };
                let power = |s: &Site| dot(p - s.at, p - s.at) - s.weight;
                let nearest = (0..sites.len())
                    .min_by(|&a, &b| power(&sites[a]).total_cmp(&power(&sites[b])))
                    .expect("there are sites");
                let ring = diagram.weld.points(&diagram.cells[nearest]);
                let deepest = super::super::sides(&ring)
                    .map(|(a, b)| cross(super::super::unit(b - a), p - a))
                    .fold(f64::MIN, f64::max);
                assert!(deepest < 1e-5, "{deepest}");
            }
        }
    }

    /// Lines stay on their side of the heart, and hearts in their cells.
    #[test]
    fn leeway_is_the_height_of_a_triangle() {
        let ends = [coord! { x: 0., y: 0. }, coord! { x: 10., y: 0. }];
        let heart = coord! { x: 4., y: 6. };
        assert!((leeway(ends, heart, 0.4) - 6.0).abs() < 1e-12);
        assert!((leeway(ends, heart, 0.2) - 3.0).abs() < 1e-12);
        let beyond = coord! { x: -10., y: 6. };
        assert!((leeway(ends, beyond, 0.5) - 1.5).abs() < 1e-12);
        assert_eq!(aside(ends, 0.5, 2.0), coord! { x: 5., y: 2. });
    }
}
