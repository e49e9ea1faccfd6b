//! Rings without hairs.

use geo_types::Coord;

use super::{cross, dist, dot, nearest_on, sides, Area, Ring};

/// Hairs are thinner than this, as a share of the size of what was cut.
const HAIR: f64 = 1e-11;

/// Areas without hairs: places where a ring goes out and comes back along itself.
///
/// Where a cut runs along an edge up to rounding, one of the two pieces may get such
/// a hair along it. `size` is that of the whole, metres; the loss is far below what
/// counts.
pub(crate) fn trim(areas: Vec<Area>, size: f64) -> Vec<Area> {
    let thin = HAIR * size;
    let trimmed = areas.into_iter().filter_map(|area| {
        let outer = trimmed(area.outer, thin)?;
        let holes = area
            .holes
            .into_iter()
            .filter_map(|hole| trimmed(hole, thin));
        Some(Area {
            outer,
            holes: holes.collect(),
        })
    });
    trimmed.collect()
}

/// An area with points as vertices that lie on its edges.
///
/// A boolean with a shape that shares parts of edges leaves no hairs along them if
/// both have the ends of those parts as vertices.
pub(crate) fn with_vertices(area: &Area, points: &[Coord<f64>]) -> Area {
    let (low, high) = area.extent();
    let thin = HAIR * dist(low, high);
    let ring = |ring: &Ring| {
        let mut found = Ring::new();
        for (a, b) in sides(ring) {
            found.push(a);
            let along = b - a;
            let on = |p: &&Coord<f64>| {
                dist(nearest_on(a, b, **p), **p) <= thin && dist(**p, a).min(dist(**p, b)) > thin
            };
            let mut here: Vec<Coord<f64>> = points.iter().filter(on).copied().collect();
            here.sort_by(|p, q| dot(*p - a, along).total_cmp(&dot(*q - a, along)));
            found.extend(here);
        }
        found.dedup();
        found
    };
    Area {
        outer: ring(&area.outer),
        holes: area.holes.iter().map(ring).collect(),
    }
}

/// A ring without hairs and without steps thinner than them; `None` if nothing is
/// left.
fn trimmed(ring: Ring, thin: f64) -> Option<Ring> {
    let mut left = ring;
    loop {
        let before = left.len();
        let mut kept: Ring = Vec::with_capacity(before);
        for &p in &left {
            push(&mut kept, p, thin);
        }
        // Where the ring closes.
        while kept.len() > 2 {
            let n = kept.len();
            if is_hair(kept[n - 2], kept[n - 1], kept[0], thin) {
                kept.pop();
            } else if is_hair(kept[n - 1], kept[0], kept[1], thin) {
                kept.remove(0);
            } else {
                break;
            }
        }
        left = kept;
        if left.len() < 3 {
            return None;
        }
        if left.len() == before {
            return Some(left);
        }
    }
}

/// Adds a vertex, and takes back what it makes a hair.
fn push(kept: &mut Ring, p: Coord<f64>, thin: f64) {
    while let [.., a, b] = kept.as_slice() {
        if !is_hair(*a, *b, p, thin) {
            break;
        }
        kept.pop();
    }
    if kept.last().is_none_or(|&last| dist(last, p) > thin) {
        kept.push(p);
    }
}

/// Whether the ring turns back on itself at `b`, or does not leave it.
fn is_hair(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>, thin: f64) -> bool {
    let (u, v) = (a - b, c - b);
    let (from, to) = (dist(a, b), dist(b, c));
    from.min(to) <= thin || (dot(u, v) > 0.0 && cross(u, v).abs() <= thin * from.max(to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    #[test]
    fn hairs_are_cut_off() {
        let ring: Ring = [
            (0., 0.),
            (0., 4.),
            (4., 4.),
            (4., 9.),
            (4., 4. + 1e-13),
            (4., 0.),
            (-5., 1e-13),
        ]
        .map(|(x, y)| coord! { x: x, y: y })
        .to_vec();
        let found = trim(vec![Area::new(ring, Vec::new())], 10.0);
        assert_eq!(found[0].outer.len(), 4);
        assert!((found[0].size() - 16.0).abs() < 1e-9);
        let flat = [(0., 0.), (5., 1e-13), (9., 0.)].map(|(x, y)| coord! { x: x, y: y });
        assert!(trim(vec![Area::new(flat.to_vec(), Vec::new())], 10.0).is_empty());
        // A sharp corner is no hair.
        let sharp = [(0., 0.), (100., 0.001), (0., 0.002)].map(|(x, y)| coord! { x: x, y: y });
        assert_eq!(
            trim(vec![Area::new(sharp.to_vec(), Vec::new())], 100.0).len(),
            1
        );
    }
}
