//! Quads drawn to squares, vertices on the boundary along it.

use geo_types::Coord;

use super::halve::least_corner;
use super::outline::Outline;
use super::Draft;

/// How far vertices go towards where their quads want them in one round.
const PACE: f64 = 0.7;
/// Side of the squares against that of a quad as it is: the rest is the wanted
/// edge length, so that sizes even out.
const OWN_SIZE: f64 = 0.6;

/// In each round every quad proposes the square that lies nearest to it, in
/// the sense of least squares, and every vertex goes most of the way to the
/// mean of what its quads propose; where that would leave a quad with a corner
/// smaller than `least` (see [`least_corner`]) and than before, it stays.
pub(super) fn relax(draft: &mut Draft, outline: &Outline, edge: f64, rounds: usize, least: f64) {
    let mut quads_at: Vec<Vec<usize>> = vec![Vec::new(); draft.points.len()];
    for (q, face) in draft.faces.iter().enumerate() {
        face.iter().for_each(|&v| quads_at[v].push(q));
    }
    let mut wanted = vec![Coord::zero(); draft.points.len()];
    for _ in 0..rounds {
        wanted.fill(Coord::zero());
        for face in &draft.faces {
            let corners = [0, 1, 2, 3].map(|k| draft.points[face[k]]);
            for (&v, target) in face.iter().zip(square(corners, edge)) {
                wanted[v] = wanted[v] + target;
            }
        }
        for v in 0..draft.points.len() {
            if quads_at[v].is_empty() {
                continue;
            }
            let here = draft.points[v];
            let worst = |draft: &Draft| {
                let corners = quads_at[v].iter().map(|&q| least_corner(draft, q));
                corners.fold(f64::INFINITY, f64::min)
            };
            let before = worst(draft);
            let target = here + (wanted[v] / quads_at[v].len() as f64 - here) * PACE;
            let place = draft.on_rim[v];
            let (place, at) = match place {
                Some(place) if place.corner => continue,
                Some(place) => {
                    let (place, at) = outline.slide(place, target, 0.5 * edge);
                    (Some(place), at)
                }
                None => (None, target),
            };
            draft.points[v] = at;
            if worst(draft) >= least.min(before) {
                draft.on_rim[v] = place;
            } else {
                draft.points[v] = here;
            }
        }
    }
}

/// The corners of the square nearest to a quad: turned by the mean of what its
/// corners say, as large as the quad and the wanted edge together.
fn square(corners: [Coord<f64>; 4], edge: f64) -> [Coord<f64>; 4] {
    let centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0;
    // Corner k turned back by k right angles: equal for a square.
    let mut sum = Coord::zero();
    for (k, &corner) in corners.iter().enumerate() {
        sum = sum + turned(corner - centre, (4 - k) % 4);
    }
    let mean = sum / 4.0;
    let size = mean.x.hypot(mean.y);
    if size <= 0.0 {
        return corners;
    }
    let half_diagonal = OWN_SIZE * size + (1.0 - OWN_SIZE) * edge * std::f64::consts::FRAC_1_SQRT_2;
    let first = mean * (half_diagonal / size);
    std::array::from_fn(|k| centre + turned(first, k))
}

/// Turned by so many right angles, counter-clockwise.
fn turned(v: Coord<f64>, quarters: usize) -> Coord<f64> {
    match quarters {
        0 => v,
        1 => Coord { x: -v.y, y: v.x },
        2 => Coord { x: -v.x, y: -v.y },
        _ => Coord { x: v.y, y: -v.x },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    #[test]
    fn squares_stay_and_rectangles_become_squares() {
        let corner = |x: f64, y: f64| coord! { x: x, y: y };
        let unit = [
            corner(0., 0.),
            corner(1., 0.),
            corner(1., 1.),
            corner(0., 1.),
        ];
        for (a, b) in square(unit, 1.0).iter().zip(unit) {
            assert!((a.x - b.x).hypot(a.y - b.y) < 1e-12);
        }
        // 3 by 1: the mean of the four turned corners is that of a 2 by 2.
        let long = [
            corner(0., 0.),
            corner(3., 0.),
            corner(3., 1.),
            corner(0., 1.),
        ];
        let found = square(long, 2.0);
        assert!((found[0].x - 0.5).abs() < 1e-12 && (found[0].y + 0.5).abs() < 1e-12);
    }
}
