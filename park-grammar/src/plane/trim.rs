//! Rings without hairs.

use geo_types::Coord;

use super::{cross, dist, dot, in_ring, nearest_on, sides, signed_area, Area, Ring};

/// Hairs are thinner than this, as a share of the size of what was cut.
const HAIR: f64 = 1e-11;

/// Areas without hairs, where a ring goes out and comes back along itself, and
/// without slits, where it does so around something else: a hole is then a hole
/// again, and parts that a hair joined are two.
///
/// Where a cut runs along an edge up to rounding, one of the two pieces may get such
/// a hair along it, and where two cuts meet in an edge, what they leave such a slit.
/// `size` is that of the whole, metres; the loss is far below what counts.
pub(crate) fn trim(areas: Vec<Area>, size: f64) -> Vec<Area> {
    let thin = HAIR * size;
    let mut found = Vec::new();
    for area in areas {
        let rings = || std::iter::once(&area.outer).chain(&area.holes).cloned();
        let parts = rings().flat_map(|ring| opened(ring, thin));
        match assembled(parts.filter_map(|ring| trimmed(ring, thin)).collect(), thin) {
            Some(parts) => found.extend(parts),
            // Slits so fine that what they part has no clear inside stay.
            None => found.extend(
                assembled(
                    rings().filter_map(|ring| trimmed(ring, thin)).collect(),
                    f64::INFINITY,
                )
                .into_iter()
                .flatten(),
            ),
        }
    }
    found
}

/// Areas from rings, holes by the tightest ring that is around them, which they may
/// touch within `near`; `None` if there is none around some.
fn assembled(rings: Vec<Ring>, near: f64) -> Option<Vec<Area>> {
    // Land is on the right.
    let (outers, holes): (Vec<Ring>, Vec<Ring>) =
        rings.into_iter().partition(|ring| signed_area(ring) < 0.0);
    let area = |outer| Area {
        outer,
        holes: Vec::new(),
    };
    let mut areas: Vec<Area> = outers.into_iter().map(area).collect();
    if let [only] = areas.as_mut_slice() {
        only.holes = holes;
        return Some(areas);
    }
    for hole in holes {
        let on = |ring: &Ring, p| sides(ring).any(|(a, b)| dist(nearest_on(a, b, p), p) <= near);
        let holds = |area: &&mut Area| {
            let mut points = hole.iter();
            points.all(|&p| in_ring(&area.outer, p) || on(&area.outer, p))
        };
        let tightest = areas.iter_mut().filter(holds).min_by(|a, b| {
            let [a, b] = [a, b].map(|area| signed_area(&area.outer).abs());
            a.total_cmp(&b)
        });
        tightest?.holes.push(hole);
    }
    Some(areas)
}

/// The rings that a ring consists of once it is cut wherever it comes back along an
/// edge of its own.
fn opened(ring: Ring, thin: f64) -> Vec<Ring> {
    let n = ring.len();
    let end = |k: usize| ring[(k + 1) % n];
    // Edges that are each other's reverse have the same middle.
    let mut order: Vec<(f64, usize)> = (0..n).map(|k| (ring[k].x + end(k).x, k)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut back: Vec<Option<usize>> = vec![None; n];
    for (at, &(x, i)) in order.iter().enumerate() {
        if back[i].is_some() {
            continue;
        }
        let near = order[at + 1..].iter().take_while(|o| o.0 - x <= 2.0 * thin);
        let twin = near.map(|o| o.1).find(|&j| {
            back[j].is_none() && dist(ring[i], end(j)) <= thin && dist(end(i), ring[j]) <= thin
        });
        if let Some(j) = twin {
            (back[i], back[j]) = (Some(j), Some(i));
        }
    }
    if back.iter().all(Option::is_none) {
        return vec![ring];
    }
    // From the start of an edge that is gone the ring goes on after its reverse.
    let mut seen = vec![false; n];
    let mut rings = Vec::new();
    for start in 0..n {
        let mut found = Ring::new();
        let mut k = start;
        while !seen[k] {
            seen[k] = true;
            match back[k] {
                Some(twin) => {
                    k = (twin + 1) % n;
                }
                None => {
                    found.push(ring[k]);
                    k = (k + 1) % n;
                }
            }
        }
        if found.len() > 2 {
            rings.push(found);
        }
    }
    rings
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

    fn ring(points: &[(f64, f64)]) -> Ring {
        points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect()
    }

    /// A square of 9 around one of 3, both as one ring through a slit that is open by
    /// a rounding: a square with a hole of 81 - 9.
    #[test]
    fn a_slit_leaves_a_hole() {
        let slit = [
            (0., 0.),
            (0., 9.),
            (9., 9.),
            (9., 0.),
            (0., 1e-14),
            (3., 3.),
            (6., 3.),
            (6., 6.),
            (3., 6.),
            (3., 3. - 1e-14),
        ];
        let found = trim(vec![Area::new(ring(&slit), Vec::new())], 10.0);
        assert_eq!((found.len(), found[0].holes.len()), (1, 1));
        assert_eq!((found[0].outer.len(), found[0].holes[0].len()), (4, 4));
        assert!((found[0].size() - 72.0).abs() < 1e-9);
    }

    /// Two squares that a hair joins are two.
    #[test]
    fn a_hair_joins_nothing() {
        let joined = [
            (0., 0.),
            (0., 2.),
            (2., 2.),
            (5., 2.),
            (5., 4.),
            (7., 4.),
            (7., 2.),
            (5., 2. - 1e-14),
            (2., 2. - 1e-14),
            (2., 0.),
        ];
        let found = trim(vec![Area::new(ring(&joined), Vec::new())], 10.0);
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|area| (area.size() - 4.0).abs() < 1e-9));
    }

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
