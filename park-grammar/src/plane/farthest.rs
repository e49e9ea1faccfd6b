//! The land that lies farthest from something.

use geo_types::Coord;

use super::{cross, dist, dot, lerp, nearest_on, right, sides, unit, Area, Segment};

/// The search by cells ends where none can hold what is better by more than this
/// share of the best.
const FINEST: f64 = 2e-3;

/// Cells looked at, at most: long strips have as good places all along.
const CELLS: usize = 6_000;

/// Candidates of the search that are climbed from.
const CANDIDATES: usize = 48;

/// Rounds of climbing at most.
const ROUNDS: usize = 40;

/// Constraints of each sort on a step, at most: the nearest ones.
const ACTIVE: usize = 10;

/// The point of an area that is farthest from some segments, and how far it is;
/// of several the centre of mass if it is one.
///
/// Cells of a grid are divided on while they may hold something better, as for
/// [`middle`](super::middle); then the best are climbed from: a distance to a
/// segment is convex, so that its tangent lies below it, and the best point under
/// all tangents (a linear programme of two variables) is better in truth. What is
/// found is exact up to rounding, unless there are many places as good to within
/// [`FINEST`], as in a long strip: then it may be less by that share.
pub(crate) fn farthest(area: &Area, from: &[Segment]) -> (Coord<f64>, f64) {
    let away = |p: Coord<f64>| {
        let far = from.iter().map(|&(a, b)| dist(nearest_on(a, b, p), p));
        far.fold(f64::INFINITY, f64::min)
    };
    let (low, high) = area.extent();
    let size = (high.x - low.x).max(high.y - low.y);
    let centroid = area.centroid();
    let mut found: Vec<(Coord<f64>, f64)> = Vec::new();
    if area.contains(centroid) {
        found.push((centroid, away(centroid)));
    }
    found.extend(area.rings().flatten().map(|&p| (p, away(p))));
    let mut most = found.iter().map(|f| f.1).fold(0.0, f64::max);
    let mut count = 0;
    // Middle and half of the side.
    let mut cells = vec![(lerp(low, high, 0.5), 0.5 * size)];
    while let Some((_, half)) = cells.first().copied() {
        let reach = half * std::f64::consts::SQRT_2;
        let mut next = Vec::new();
        for (at, _) in cells {
            let inside = area.contains(at);
            if !inside && area.nearest(at).1 > reach {
                continue;
            }
            let far = away(at);
            if inside {
                found.push((at, far));
                most = most.max(far);
            }
            next.push((at, far));
        }
        count += next.len();
        if reach < FINEST * most || count > CELLS {
            break;
        }
        next.retain(|&(_, far)| far + reach > most * (1.0 + FINEST));
        let quarter = 0.5 * half;
        cells = next
            .iter()
            .flat_map(|&(at, _)| {
                [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(x, y)| {
                    let by = Coord {
                        x: x * quarter,
                        y: y * quarter,
                    };
                    (at + by, quarter)
                })
            })
            .collect();
    }
    // Stable, so that the centre of mass stays the first among equals.
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    let tied = 1e-9 * size;
    let mut top = found
        .iter()
        .find(|f| f.1 >= most - tied)
        .copied()
        .unwrap_or((centroid, 0.0));
    if let Some(first) = found.iter().find(|f| f.0 == centroid) {
        if first.1 >= most - tied {
            top = *first;
        }
    }
    let mut climbed: Vec<Coord<f64>> = Vec::new();
    for &(at, far) in &found {
        if climbed.len() >= CANDIDATES || far < most * (1.0 - 4.0 * FINEST) {
            break;
        }
        if climbed.iter().any(|&c| dist(c, at) < 20.0 * FINEST * most) {
            continue;
        }
        climbed.push(at);
        let reached = climb(area, from, at, &away, 8.0 * FINEST * most);
        if reached.1 > top.1 + tied {
            top = reached;
        }
    }
    top
}

/// Goes up from a point until no step leads on.
fn climb(
    area: &Area,
    from: &[Segment],
    start: Coord<f64>,
    away: &impl Fn(Coord<f64>) -> f64,
    trust: f64,
) -> (Coord<f64>, f64) {
    let (mut at, mut height) = (start, away(start));
    let mut trust = trust;
    for _ in 0..ROUNDS {
        let Some(step) = step(area, from, at, height, trust) else {
            break;
        };
        let next = at + step;
        let reached = away(next);
        // On the boundary rounding leads out of the area.
        let inside = area.contains(next) || area.nearest(next).1 <= 1e-12 * (trust + height);
        if inside && reached > height * (1.0 + 1e-15) {
            (at, height) = (next, reached);
        } else {
            trust *= 0.25;
            if trust < 1e-13 * height {
                break;
            }
        }
    }
    (at, height)
}

/// One line of a programme: `offset + slope . step >= height * share`.
struct Plane {
    slope: Coord<f64>,
    offset: f64,
    /// 1 for what bounds the height, 0 for what bounds the step alone.
    share: f64,
}

/// The step that leads highest, of those no longer than `trust` along each axis.
fn step(
    area: &Area,
    from: &[Segment],
    at: Coord<f64>,
    height: f64,
    trust: f64,
) -> Option<Coord<f64>> {
    let mut planes: Vec<Plane> = Vec::new();
    for &(a, b) in from {
        let near = nearest_on(a, b, at);
        let far = dist(near, at);
        if far <= height + 4.0 * trust && far > 0.0 {
            planes.push(Plane {
                slope: unit(at - near),
                offset: far,
                share: 1.0,
            });
        }
    }
    planes.sort_by(|a, b| a.offset.total_cmp(&b.offset));
    planes.truncate(ACTIVE);
    let mut walls: Vec<(f64, Segment)> = area
        .rings()
        .flat_map(|ring| sides(ring))
        .map(|(a, b)| (dist(nearest_on(a, b, at), at), (a, b)))
        .filter(|wall| wall.0 <= 2.0 * trust)
        .collect();
    walls.sort_by(|p, q| p.0.total_cmp(&q.0));
    walls.truncate(ACTIVE);
    for (_, (a, b)) in walls {
        let inward = right(unit(b - a));
        planes.push(Plane {
            slope: inward,
            offset: dot(at - a, inward).max(0.0),
            share: 0.0,
        });
    }
    for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        planes.push(Plane {
            slope: Coord { x, y },
            offset: trust,
            share: 0.0,
        });
    }
    // The best corner of the programme: three of its planes meet in each.
    let mut best: Option<(f64, Coord<f64>)> = None;
    let n = planes.len();
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let Some((step, height)) = corner([&planes[i], &planes[j], &planes[k]]) else {
                    continue;
                };
                if best.is_some_and(|b| b.0 >= height) {
                    continue;
                }
                let slack = |p: &Plane| p.offset + dot(p.slope, step) - p.share * height;
                if planes.iter().all(|p| slack(p) >= -1e-12 * (height + trust)) {
                    best = Some((height, step));
                }
            }
        }
    }
    best.map(|found| found.1)
}

/// Where three planes meet, by Cramer's rule.
fn corner([p, q, r]: [&Plane; 3]) -> Option<(Coord<f64>, f64)> {
    // slope . step - share * height = -offset
    let det = p.share * cross(q.slope, r.slope)
        + q.share * cross(r.slope, p.slope)
        + r.share * cross(p.slope, q.slope);
    if det.abs() < 1e-9 {
        return None;
    }
    let minor = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let column = |of: &dyn Fn(&Plane) -> f64| [of(p), of(q), of(r)];
    let (x, y) = (column(&|p| p.slope.x), column(&|p| p.slope.y));
    let (share, offset) = (column(&|p| -p.share), column(&|p| -p.offset));
    let whole = minor(x, y, share);
    (whole != 0.0).then(|| {
        let step = Coord {
            x: minor(offset, y, share) / whole,
            y: minor(x, offset, share) / whole,
        };
        (step, minor(x, y, offset) / whole)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn area(points: &[(f64, f64)]) -> Area {
        let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
        Area::new(ring, Vec::new())
    }

    fn all(area: &Area) -> Vec<Segment> {
        sides(&area.outer).collect()
    }

    /// The circle inscribed in a triangle of sides 3, 4, 5 has radius 1.
    #[test]
    fn the_inscribed_circle_is_exact() {
        let triangle = area(&[(0., 0.), (0., 3.), (4., 0.)]);
        let (at, far) = farthest(&triangle, &all(&triangle));
        assert!((far - 1.0).abs() < 1e-12, "{far}");
        assert!(dist(at, coord! { x: 1., y: 1. }) < 1e-9, "{at:?}");
    }

    /// Of the points in the middle of an oblong the centre of mass is taken.
    #[test]
    fn ties_go_to_the_centre() {
        let oblong = area(&[(0., 0.), (0., 50.), (80., 50.), (80., 0.)]);
        assert_eq!(
            farthest(&oblong, &all(&oblong)),
            (coord! { x: 40., y: 25. }, 25.0)
        );
        // From one side alone: the other one.
        let (at, far) = farthest(&oblong, &all(&oblong)[..1]);
        assert!(
            (far - 80.0).abs() < 1e-12 && (at.x - 80.0).abs() < 1e-9,
            "{at:?}"
        );
        // From two: their far corner is 80 and 50 away.
        let (_, far) = farthest(&oblong, &all(&oblong)[..2]);
        assert!((far - 50.0).abs() < 1e-12, "{far}");
    }

    /// In an L of arms 2 wide the circle at the inner corner touches it and the
    /// two outer sides: (2 - r) sqrt 2 = r, so r = 4 - 2 sqrt 2.
    #[test]
    fn corners_that_turn_inwards_count() {
        let l = area(&[(0., 0.), (0., 9.), (2., 9.), (2., 2.), (9., 2.), (9., 0.)]);
        let (at, far) = farthest(&l, &all(&l));
        let radius = 4.0 - 8f64.sqrt();
        assert!((far - radius).abs() < 1e-9, "{far} {radius}");
        assert!((at.x - radius).abs() < 1e-6 && (at.y - radius).abs() < 1e-6);
    }
}
