//! Is a polygon valid by the rules of OGC simple features?

use geo_types::{Coord, Polygon};
use robust::orient2d;

use super::network::place;
use crate::layout::plane::{
    distance, dot, lerp, minus, nearest_parameter, rings, signed_area, Segment, Segments,
};

/// What is wrong with a polygon, or `None` if it is valid (OGC simple features,
/// as shapely's `is_valid`): finite coordinates, rings of at least three
/// vertices and some area that neither cross nor touch themselves, holes inside
/// the exterior and outside each other, rings that touch only at points, and a
/// connected interior.
///
/// Sides of lines are decided exactly (adaptive predicates), so a vertex almost
/// on an edge is judged right. Either winding is valid.
///
/// # Complexity
///
/// O(n log n) for n vertices, by an R-tree of edges.
///
/// # Examples
///
/// ```
/// use geo_types::polygon;
/// use urban_layout::check::polygon_fault;
///
/// let bow_tie = polygon![(x: 0., y: 0.), (x: 2., y: 2.), (x: 2., y: 0.), (x: 0., y: 2.)];
/// assert!(polygon_fault(&bow_tie).expect("it crosses").contains("crosses itself"));
/// ```
#[must_use]
pub fn polygon_fault(polygon: &Polygon<f64>) -> Option<String> {
    // Closed rings without repeated points.
    let mut clean: Vec<Vec<Coord<f64>>> = Vec::new();
    for (number, ring) in rings(polygon).enumerate() {
        if let Some(bad) = ring
            .0
            .iter()
            .find(|c| !(c.x.is_finite() && c.y.is_finite()))
        {
            return Some(format!(
                "ring {number} has a coordinate that is no number ({}, {})",
                bad.x, bad.y
            ));
        }
        let mut ring = ring.0.clone();
        ring.dedup();
        if ring.len() < 4 {
            return Some(format!("ring {number} has no area"));
        }
        clean.push(ring);
    }
    let index = Segments::of_lines(clean.iter().map(Vec::as_slice));
    let mut touches: Vec<Touch> = Vec::new();
    for s in index.iter() {
        for t in index.near(s.a, s.b, 0.0) {
            if (t.owner, t.index) <= (s.owner, s.index) {
                continue;
            }
            if let Some(fault) = pair_fault(&clean, s, t, &mut touches) {
                return Some(fault);
            }
        }
    }
    if let Some(flat) = clean.iter().position(|ring| signed_area(ring) == 0.0) {
        return Some(format!("ring {flat} has no area"));
    }
    hole_fault(&clean, &index, &touches).or_else(|| interior_fault(clean.len(), &touches))
}

/// A point that two different rings share.
#[derive(Clone, Copy, Debug)]
struct Touch {
    rings: [usize; 2],
    at: Coord<f64>,
}

fn orientation(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> f64 {
    let p = |c: Coord<f64>| robust::Coord { x: c.x, y: c.y };
    orient2d(p(a), p(b), p(c))
}

/// Whether `p`, which is on the line through `a` and `b`, is between them.
fn between(p: Coord<f64>, a: Coord<f64>, b: Coord<f64>) -> bool {
    let within = |v: f64, u: f64, w: f64| u.min(w) <= v && v <= u.max(w);
    within(p.x, a.x, b.x) && within(p.y, a.y, b.y)
}

/// What is wrong with two edges of a polygon; touches of different rings are
/// noted instead.
fn pair_fault(
    rings: &[Vec<Coord<f64>>],
    s: &Segment,
    t: &Segment,
    touches: &mut Vec<Touch>,
) -> Option<String> {
    let itself = s.owner == t.owner;
    let n = rings[s.owner].len() - 1;
    let next = itself && t.index == s.index + 1;
    let around = itself && s.index == 0 && t.index == n - 1;
    if next || around {
        let (a, b, c) = if next {
            (s.a, s.b, t.b)
        } else {
            (t.a, t.b, s.b)
        };
        let back = orientation(a, b, c) == 0.0 && dot(minus(b, a), minus(c, b)) < 0.0;
        return back.then(|| format!("ring {} doubles back on itself {}", s.owner, place(b)));
    }
    let (ta, tb) = (orientation(s.a, s.b, t.a), orientation(s.a, s.b, t.b));
    let (sa, sb) = (orientation(t.a, t.b, s.a), orientation(t.a, t.b, s.b));
    if ta * tb < 0.0 && sa * sb < 0.0 {
        let at = lerp(s.a, s.b, sa / (sa - sb));
        let whom = if itself {
            "itself".to_owned()
        } else {
            format!("ring {}", t.owner)
        };
        return Some(format!("ring {} crosses {whom} {}", s.owner, place(at)));
    }
    let mut shared: Vec<Coord<f64>> = Vec::new();
    for (side, p, a, b) in [
        (ta, t.a, s.a, s.b),
        (tb, t.b, s.a, s.b),
        (sa, s.a, t.a, t.b),
        (sb, s.b, t.a, t.b),
    ] {
        if side == 0.0 && between(p, a, b) && !shared.contains(&p) {
            shared.push(p);
        }
    }
    let at = *shared.first()?;
    if itself {
        return Some(format!("ring {} touches itself {}", s.owner, place(at)));
    }
    if shared.len() > 1 {
        return Some(format!(
            "rings {} and {} share an edge {}",
            s.owner,
            t.owner,
            place(at)
        ));
    }
    touches.push(Touch {
        rings: [s.owner, t.owner],
        at,
    });
    None
}

/// A hole outside the exterior or inside another hole. No edges cross properly
/// here, so a hole changes sides only at a touch: one point between each two
/// touches decides.
fn hole_fault(rings: &[Vec<Coord<f64>>], index: &Segments, touches: &[Touch]) -> Option<String> {
    for (number, ring) in rings.iter().enumerate().skip(1) {
        let own: Vec<Coord<f64>> = touches
            .iter()
            .filter(|t| t.rings.contains(&number))
            .map(|t| t.at)
            .collect();
        for w in ring.windows(2) {
            let mut cuts = vec![0.0, 1.0];
            cuts.extend(
                own.iter()
                    .map(|p| (nearest_parameter(*p, w[0], w[1]), p))
                    .filter_map(|(t, p)| {
                        (t > 0.0
                            && t < 1.0
                            && distance(lerp(w[0], w[1], t), *p) <= 1e-9 * distance(w[0], w[1]))
                        .then_some(t)
                    }),
            );
            cuts.sort_by(f64::total_cmp);
            for cut in cuts.windows(2) {
                let p = lerp(w[0], w[1], 0.5 * (cut[0] + cut[1]));
                let mut around = index.containing(p);
                around.retain(|owner| *owner != number);
                if around != [0] {
                    let whom = if around.contains(&0) {
                        "lies in another hole"
                    } else {
                        "lies outside the exterior"
                    };
                    return Some(format!("ring {number} {whom} {}", place(p)));
                }
            }
            if own.is_empty() {
                break;
            }
        }
    }
    None
}

/// Rings that touch in a circle cut the interior apart: in the graph of rings
/// and touching points, an edge between nodes already connected closes one.
fn interior_fault(rings: usize, touches: &[Touch]) -> Option<String> {
    let same = |p: Coord<f64>, q: Coord<f64>| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y));
    let mut links: Vec<(Coord<f64>, usize)> = touches
        .iter()
        .flat_map(|t| t.rings.map(|r| (t.at, r)))
        .collect();
    links.sort_by(|p, q| same(p.0, q.0).then(p.1.cmp(&q.1)));
    links.dedup();
    let mut parent: Vec<usize> = (0..rings).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    for run in links.chunk_by(|p, q| p.0 == q.0) {
        let point = parent.len();
        parent.push(point);
        for (at, ring) in run {
            let (a, b) = (root(&mut parent, point), root(&mut parent, *ring));
            if a == b {
                return Some(format!(
                    "rings that touch cut the interior apart {}",
                    place(*at)
                ));
            }
            parent[a] = b;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::polygon;

    fn holed(hole: &[(f64, f64)]) -> Polygon<f64> {
        let outer = [(0., 0.), (9., 0.), (9., 9.), (0., 9.)];
        let ring = |points: &[(f64, f64)]| points.iter().map(|&(x, y)| Coord { x, y }).collect();
        Polygon::new(ring(&outer), vec![ring(hole)])
    }

    #[test]
    fn holes_may_touch_the_exterior_once() {
        assert_eq!(polygon_fault(&holed(&[(3., 3.), (3., 6.), (6., 6.)])), None);
        assert_eq!(polygon_fault(&holed(&[(0., 3.), (3., 6.), (6., 3.)])), None);
        let twice = polygon_fault(&holed(&[(0., 3.), (3., 9.), (6., 3.)]));
        assert!(twice.expect("cut").contains("apart"));
        let along = polygon_fault(&holed(&[(0., 3.), (0., 6.), (6., 3.)]));
        assert!(along.expect("shares").contains("share"));
        let out = polygon_fault(&holed(&[(20., 3.), (20., 6.), (26., 3.)]));
        assert!(out.expect("outside").contains("outside"));
        let across = polygon_fault(&holed(&[(5., 3.), (5., 6.), (16., 3.)]));
        assert!(across.expect("crosses").contains("crosses"));
    }

    #[test]
    fn rings_may_not_touch_themselves() {
        let pinched = polygon![(x: 0., y: 0.), (x: 4., y: 0.), (x: 2., y: 2.), (x: 4., y: 4.), (x: 0., y: 4.), (x: 2., y: 2.)];
        assert!(polygon_fault(&pinched)
            .expect("pinched")
            .contains("touches itself"));
        let spike = polygon![(x: 0., y: 0.), (x: 4., y: 0.), (x: 4., y: 9.), (x: 4., y: 4.), (x: 0., y: 4.)];
        assert!(polygon_fault(&spike).is_some());
        let repeated = polygon![(x: 0., y: 0.), (x: 4., y: 0.), (x: 4., y: 0.), (x: 4., y: 4.)];
        assert_eq!(polygon_fault(&repeated), None);
    }

    #[test]
    fn holes_may_not_lie_in_holes() {
        let mut polygon = holed(&[(1., 1.), (1., 8.), (8., 8.), (8., 1.)]);
        polygon.interiors_push(vec![(3., 3.), (3., 6.), (6., 6.)]);
        assert!(polygon_fault(&polygon)
            .expect("nested")
            .contains("another hole"));
    }

    #[test]
    fn numbers_must_be_numbers() {
        assert!(polygon_fault(&holed(&[(1., 1.), (f64::NAN, 8.), (8., 8.)])).is_some());
        assert!(polygon_fault(&holed(&[(1., 1.), (8., 8.)])).is_some());
    }
}
