//! Rings that share their vertices.
//!
//! Booleans compute a vertex anew for each area that has it, so that neighbours
//! agree on it up to rounding only, and one may have a vertex where the other has
//! an edge. Welded rings have the same vertices to the last bit, with one on every
//! edge where any other has one: then what two of them share is found by its
//! numbers, and booleans of them leave no hair between.

use std::collections::BTreeMap;

use geo_types::Coord;

use super::{cross, dist, dot, sides, Area, Ring};

/// Vertices, each with a number.
#[derive(Clone, Debug)]
pub(crate) struct Weld {
    /// Points this near to each other are one.
    tolerance: f64,
    /// Side of a square of the grid in which vertices are found.
    cell: f64,
    points: Vec<Coord<f64>>,
    squares: BTreeMap<(i64, i64), Vec<usize>>,
}

/// A ring by the numbers of its vertices.
pub(crate) type Numbers = Vec<usize>;

impl Weld {
    /// For rings of about so many metres an edge.
    pub(crate) fn new(tolerance: f64, edge: f64) -> Self {
        Self {
            tolerance,
            cell: edge.max(16.0 * tolerance).max(f64::MIN_POSITIVE),
            points: Vec::new(),
            squares: BTreeMap::new(),
        }
    }

    /// For rings, by the mean length of their edges.
    pub(crate) fn for_rings<'r>(tolerance: f64, rings: impl IntoIterator<Item = &'r Ring>) -> Self {
        let (mut sum, mut count) = (0.0, 0.0);
        for (a, b) in rings.into_iter().flat_map(|ring| sides(ring)) {
            sum += dist(a, b);
            count += 1.0;
        }
        Self::new(tolerance, if count > 0.0 { sum / count } else { 1.0 })
    }

    pub(crate) fn at(&self, number: usize) -> Coord<f64> {
        self.points[number]
    }

    fn square(&self, x: f64) -> i64 {
        // Saturates far out, where all share a square.
        (x / self.cell).floor() as i64
    }

    /// The number of the vertex at a point, a new one if there is none near.
    pub(crate) fn vertex(&mut self, at: Coord<f64>) -> usize {
        let far = self.tolerance;
        let (left, right) = (self.square(at.x - far), self.square(at.x + far));
        let (low, high) = (self.square(at.y - far), self.square(at.y + far));
        let mut best: Option<(f64, usize)> = None;
        for row in low..=high {
            for (_, here) in self.squares.range((row, left)..=(row, right)) {
                for &k in here {
                    let away = dist(self.points[k], at);
                    if away <= far && best.is_none_or(|(least, _)| away < least) {
                        best = Some((away, k));
                    }
                }
            }
        }
        if let Some((_, found)) = best {
            return found;
        }
        let number = self.points.len();
        self.points.push(at);
        let square = (self.square(at.y), self.square(at.x));
        self.squares.entry(square).or_default().push(number);
        number
    }

    /// The numbers of a ring's vertices, in its order.
    pub(crate) fn ring(&mut self, ring: &[Coord<f64>]) -> Numbers {
        tidy(ring.iter().map(|&at| self.vertex(at)).collect())
    }

    /// The ring with all vertices that lie on its edges.
    pub(crate) fn noded(&self, ring: &[usize]) -> Numbers {
        let mut found = Vec::with_capacity(ring.len());
        for (k, &from) in ring.iter().enumerate() {
            let to = ring[(k + 1) % ring.len()];
            found.push(from);
            found.extend(self.between(from, to));
        }
        tidy(found)
    }

    /// The vertices on the way from one to another.
    fn between(&self, from: usize, to: usize) -> Vec<usize> {
        let (a, b) = (self.points[from], self.points[to]);
        let (along, far) = (b - a, self.tolerance);
        let long = dot(along, along).sqrt();
        if long <= 2.0 * far {
            return Vec::new();
        }
        let mut on: Vec<(f64, usize)> = Vec::new();
        let (low, high) = (a.y.min(b.y) - far, a.y.max(b.y) + far);
        for row in self.square(low)..=self.square(high) {
            // The part of the edge that runs through this row of squares.
            let floor = row as f64 * self.cell;
            let bounds = [floor - far, floor + self.cell + far].map(|y| {
                if along.y == 0.0 {
                    None
                } else {
                    Some(((y - a.y) / along.y).clamp(0.0, 1.0))
                }
            });
            let xs = match bounds {
                [Some(s), Some(t)] => [a.x + s * along.x, a.x + t * along.x],
                _ => [a.x, b.x],
            };
            let (left, right) = (xs[0].min(xs[1]) - far, xs[0].max(xs[1]) + far);
            let range = (row, self.square(left))..=(row, self.square(right));
            for &k in self.squares.range(range).flat_map(|(_, here)| here) {
                if k == from || k == to {
                    continue;
                }
                let to_it = self.points[k] - a;
                let share = dot(to_it, along) / (long * long);
                let aside = cross(along, to_it).abs() / long;
                if share > 0.0 && share < 1.0 && aside <= far {
                    on.push((share, k));
                }
            }
        }
        on.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        on.dedup_by_key(|(_, k)| *k);
        on.into_iter().map(|(_, k)| k).collect()
    }

    /// The ring of numbers as points.
    pub(crate) fn points(&self, ring: &[usize]) -> Ring {
        ring.iter().map(|&k| self.points[k]).collect()
    }
}

/// Without edges of no length, and without edges that are walked back at once.
fn tidy(mut ring: Numbers) -> Numbers {
    loop {
        let n = ring.len();
        let idle = (0..n).find(|&k| {
            let next = ring[(k + 1) % n];
            ring[k] == next || (n > 2 && ring[k] == ring[(k + 2) % n])
        });
        let Some(k) = idle.filter(|_| n > 1) else {
            return ring;
        };
        if ring[k] != ring[(k + 1) % n] {
            // There and back: the end of the spike goes, then its doubled foot.
            ring.remove((k + 1) % n);
        } else {
            ring.remove(k);
        }
    }
}

/// Welds areas to each other; those without area go.
pub(crate) fn weld(areas: &[&Area], tolerance: f64) -> Vec<Area> {
    let rings = areas.iter().flat_map(|area| area.rings());
    let mut weld = Weld::for_rings(tolerance, rings);
    let numbered: Vec<Vec<Numbers>> = areas
        .iter()
        .map(|area| area.rings().map(|ring| weld.ring(ring)).collect())
        .collect();
    let area = |rings: &Vec<Numbers>| {
        let mut rings = rings.iter().map(|ring| weld.points(&weld.noded(ring)));
        let outer = rings.next().unwrap_or_default();
        let holes = rings.filter(|ring| ring.len() > 2).collect();
        Area { outer, holes }
    };
    numbered
        .iter()
        .map(area)
        .filter(|area| area.outer.len() > 2)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn ring(points: &[(f64, f64)]) -> Ring {
        points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect()
    }

    /// A square beside two smaller ones, whose common corner lies on its edge and
    /// was computed twice.
    #[test]
    fn neighbours_share_vertices() {
        let mut weld = Weld::new(1e-6, 1.0);
        let large = weld.ring(&ring(&[(0., 0.), (0., 4.), (4., 4.), (4., 0.)]));
        let upper = weld.ring(&ring(&[(4., 2.), (4., 4.), (6., 4.), (6., 2.)]));
        let lower = weld.ring(&ring(&[
            (4., 0.),
            (4.0 + 1e-9, 2.0 - 1e-9),
            (6., 2.),
            (6., 0.),
        ]));
        assert_eq!(upper[0], lower[1]);
        let noded = weld.noded(&large);
        assert_eq!(noded, [large[0], large[1], large[2], upper[0], large[3]]);
        assert_eq!(weld.noded(&upper), upper);
    }

    #[test]
    fn spikes_go() {
        assert_eq!(tidy(vec![0, 1, 2, 3, 2, 4]), [0, 1, 2, 4]);
        assert_eq!(tidy(vec![0, 0, 1, 2, 2]), [0, 1, 2]);
        assert!(tidy(vec![0, 1, 2, 1]).len() < 3);
    }

    /// Long edges are found whichever way they run over the grid.
    #[test]
    fn slanting_edges_find_their_vertices() {
        for angle in 0..24 {
            let angle = f64::from(angle) * 0.262;
            let way = coord! { x: angle.cos(), y: angle.sin() };
            let mut weld = Weld::new(1e-7, 0.7);
            let numbers: Vec<usize> = (0..50).map(|k| weld.vertex(way * f64::from(k))).collect();
            let found = weld.between(numbers[0], numbers[49]);
            assert_eq!(found, numbers[1..49], "{angle}");
        }
    }
}
