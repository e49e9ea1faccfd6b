//! The largest rectangle inside an area.
//!
//! For each of some directions a raster of the area is searched for its largest
//! empty rectangle (the histogram method), and the best few of what was found are
//! polished: moved, turned and stretched with the rectangle's own extent along x
//! as far as the edges beside it allow. The measure of that is exact, so that the
//! result lies inside whatever the raster was. It is a search: which of two
//! rectangles of nearly one size it ends at may depend on rounding.

use geo_types::Coord;

use crate::plane::{climb, dist, dot, norm, right, unit, Area};

/// Rows and columns of the raster.
const RASTER: usize = 48;

/// Directions of edges that are tried, the longest edges first.
const EDGES: usize = 24;

/// Directions besides, evenly spread.
const EVEN: usize = 12;

/// How many of the best are polished.
const POLISHED: usize = 6;

/// Directions that differ by less are one, radians.
const SAME: f64 = 1e-3;

/// A rectangle: the direction of its x axis, its extent along y, and a place
/// along x that is in it.
type Draft = [f64; 4];

/// The largest rectangle in any direction.
pub(super) fn largest(area: &Area) -> Option<[Coord<f64>; 4]> {
    best(area, &directions(area), true)
}

/// The largest rectangle along `x`.
pub(super) fn along(area: &Area, x: Coord<f64>) -> Option<[Coord<f64>; 4]> {
    best(area, &[x.y.atan2(x.x)], false)
}

fn best(area: &Area, directions: &[f64], turning: bool) -> Option<[Coord<f64>; 4]> {
    let (low, high) = area.extent();
    let size = norm(high - low);
    let mut drafts: Vec<(f64, Draft)> = directions
        .iter()
        .filter_map(|&angle| {
            let draft = raster(&Turned::new(area, angle))?;
            Some((Turned::new(area, angle).measure(&draft).0, draft))
        })
        .collect();
    drafts.sort_by(|a, b| b.0.total_cmp(&a.0));
    drafts.truncate(POLISHED);
    let measure = |draft: &Draft| Turned::new(area, draft[0]).measure(draft).0;
    let turn = if turning { 0.03 } else { 0.0 };
    let step = [turn, 0.02 * size, 0.02 * size, 0.02 * size];
    // Along a wall a corner is left by moving both ends at once, which the middle
    // and half of the height as coordinates allow.
    let ends = |[angle, middle, half, x]: Draft| [angle, middle - half, middle + half, x];
    let middle = |[angle, low, high, x]: Draft| [angle, 0.5 * (low + high), 0.5 * (high - low), x];
    let polished = |draft: Draft, least: f64| {
        let (at, _) = climb(draft, step, least, measure);
        let (at, top) = climb(middle(at), step, least, |p| measure(&ends(*p)));
        (ends(at), top)
    };
    // The best after a rough climb goes on to the top.
    let rough = drafts.into_iter().map(|(_, draft)| polished(draft, 1e-2));
    let (best, _) = rough.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    let (draft, top) = polished(best, 1e-10);
    if top <= 0.0 {
        return None;
    }
    let turned = Turned::new(area, draft[0]);
    let (_, [left, right]) = turned.measure(&draft);
    let [_, low, high, _] = draft;
    Some([(left, low), (left, high), (right, high), (right, low)].map(|(x, y)| turned.back(x, y)))
}

/// Directions modulo a quarter turn, radians.
fn directions(area: &Area) -> Vec<f64> {
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut edges: Vec<(Coord<f64>, Coord<f64>)> = area
        .rings()
        .flat_map(|ring| crate::plane::sides(ring))
        .collect();
    edges.sort_by(|a, b| dist(b.0, b.1).total_cmp(&dist(a.0, a.1)));
    let mut found: Vec<f64> = Vec::new();
    let even = (0..EVEN).map(|k| k as f64 * quarter / EVEN as f64);
    let of_edges = edges.iter().map(|(a, b)| {
        let d = *b - *a;
        let angle = d.y.atan2(d.x).rem_euclid(quarter);
        // A quarter less by rounding is none.
        if quarter - angle < SAME * SAME {
            0.0
        } else {
            angle
        }
    });
    for angle in of_edges.take(4 * EDGES) {
        if found.len() < EDGES && found.iter().all(|a| (a - angle).abs() > SAME) {
            found.push(angle);
        }
    }
    found.extend(even);
    found
}

/// An area seen in a direction.
struct Turned {
    x: Coord<f64>,
    y: Coord<f64>,
    edges: Vec<[[f64; 2]; 2]>,
}

impl Turned {
    fn new(area: &Area, angle: f64) -> Self {
        let x = unit(Coord {
            x: angle.cos(),
            y: angle.sin(),
        });
        let y = right(x) * -1.0;
        let own = |p: Coord<f64>| [dot(p, x), dot(p, y)];
        let rings = area.rings().flat_map(|ring| crate::plane::sides(ring));
        let edges = rings.map(|(a, b)| [own(a), own(b)]).collect();
        Self { x, y, edges }
    }

    fn back(&self, x: f64, y: f64) -> Coord<f64> {
        self.x * x + self.y * y
    }

    /// The part of an edge within the open band from `low` to `high`, along x.
    fn within([a, b]: &[[f64; 2]; 2], low: f64, high: f64) -> Option<[f64; 2]> {
        let (a, b) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        if b[1] <= low || a[1] >= high {
            return None;
        }
        let at = |y: f64| a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]));
        let from = if a[1] < low { at(low) } else { a[0] };
        let to = if b[1] > high { at(high) } else { b[0] };
        Some([from.min(to), from.max(to)])
    }

    /// Area of the largest rectangle between two heights around a place, and its
    /// extent along x; 0 where none is.
    fn measure(&self, [_, low, high, x]: &Draft) -> (f64, [f64; 2]) {
        let nothing = (0.0, [*x, *x]);
        if high <= low {
            return nothing;
        }
        let (mut left, mut right) = (f64::NEG_INFINITY, f64::INFINITY);
        let middle = 0.5 * (low + high);
        let mut beyond = 0_usize;
        for edge in &self.edges {
            let Some([from, to]) = Self::within(edge, *low, *high) else {
                continue;
            };
            if from < *x && to > *x {
                return nothing;
            }
            if to <= *x {
                left = left.max(to);
            } else {
                right = right.min(from);
            }
            // Whether the place lies inside: edges that pass on its right.
            if (edge[0][1] > middle) != (edge[1][1] > middle) && from >= *x {
                beyond += 1;
            }
        }
        if beyond.is_multiple_of(2) || !(left.is_finite() && right.is_finite()) {
            return nothing;
        }
        ((right - left) * (high - low), [left, right])
    }
}

/// The largest rectangle of the cells of a raster that lie inside.
fn raster(turned: &Turned) -> Option<Draft> {
    let ends = || turned.edges.iter().map(|edge| edge[0]);
    let fold = |k: usize| {
        ends().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            (low.min(p[k]), high.max(p[k]))
        })
    };
    let ((west, east), (south, north)) = (fold(0), fold(1));
    let step = [
        (east - west) / RASTER as f64,
        (north - south) / RASTER as f64,
    ];
    if !(step[0] > 0.0 && step[1] > 0.0) {
        return None;
    }
    let mut heights = [0_usize; RASTER];
    let mut best: Option<(usize, [usize; 4])> = None;
    for row in 0..RASTER {
        let (low, high) = (
            south + row as f64 * step[1],
            south + (row + 1) as f64 * step[1],
        );
        let free = free_cells(turned, west, step[0], low, high);
        for (height, free) in heights.iter_mut().zip(free) {
            *height = if free { *height + 1 } else { 0 };
        }
        // Columns whose heights rise, each with where its height began.
        let mut rising: Vec<(usize, usize)> = Vec::new();
        for column in 0..=RASTER {
            let height = heights.get(column).copied().unwrap_or(0);
            let mut start = column;
            while let Some(&(from, tall)) = rising.last().filter(|(_, tall)| *tall >= height) {
                let cells = tall * (column - from);
                if best.is_none_or(|(most, _)| cells > most) && cells > 0 {
                    best = Some((cells, [from, column, row + 1 - tall, row + 1]));
                }
                start = from;
                rising.pop();
            }
            rising.push((start, height));
        }
    }
    let (_, [from, to, bottom, top]) = best?;
    let angle = turned.x.y.atan2(turned.x.x);
    let x = west + 0.5 * (from + to) as f64 * step[0];
    Some([
        angle,
        south + bottom as f64 * step[1],
        south + top as f64 * step[1],
        x,
    ])
}

/// Which cells of a row lie inside wholly.
fn free_cells(turned: &Turned, west: f64, step: f64, low: f64, high: f64) -> [bool; RASTER] {
    let mut free = [false; RASTER];
    let middle = 0.5 * (low + high);
    let mut passes: Vec<f64> = Vec::new();
    let mut blocked = [false; RASTER];
    let column = |x: f64| ((x - west) / step).max(0.0);
    for edge in &turned.edges {
        let Some([from, to]) = Turned::within(edge, low, high) else {
            continue;
        };
        // An edge along the side of a cell does not enter it.
        let first = (column(from) + 1e-6).floor() as usize;
        let last = ((column(to) - 1e-6).ceil() as usize).min(RASTER);
        for cell in blocked.iter_mut().take(last).skip(first) {
            *cell = true;
        }
        let [a, b] = edge;
        if (a[1] > middle) != (b[1] > middle) {
            passes.push(a[0] + (b[0] - a[0]) * ((middle - a[1]) / (b[1] - a[1])));
        }
    }
    passes.sort_by(f64::total_cmp);
    for (k, cell) in free.iter_mut().enumerate() {
        let x = west + (k as f64 + 0.5) * step;
        let before = passes.iter().take_while(|p| **p < x).count();
        *cell = before % 2 == 1 && !blocked[k];
    }
    free
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn area(points: &[(f64, f64)]) -> Area {
        let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
        Area::new(ring, Vec::new())
    }

    fn size(quad: &[Coord<f64>; 4]) -> f64 {
        crate::plane::quad_area(quad)
    }

    /// Of a triangle the largest rectangle is half.
    #[test]
    fn half_of_a_triangle() {
        let triangle = area(&[(0., 0.), (12., 0.), (3., 9.)]);
        let found = largest(&triangle).expect("fits");
        assert!((size(&found) - 27.0).abs() < 1e-4, "{}", size(&found));
        let found = along(&triangle, coord! { x: 1., y: 0. }).expect("fits");
        assert!((size(&found) - 27.0).abs() < 1e-4, "{}", size(&found));
    }

    /// A turned rectangle is its own, and an L has its longer arm.
    #[test]
    fn rectangles_are_found() {
        let turned = area(&[(0., 0.), (-3., 4.), (5., 10.), (8., 6.)]);
        let found = largest(&turned).expect("fits");
        assert!((size(&found) - 50.0).abs() < 1e-5, "{}", size(&found));
        let l = area(&[(0., 0.), (0., 9.), (4., 9.), (4., 3.), (8., 3.), (8., 0.)]);
        let found = along(&l, coord! { x: 1., y: 0. }).expect("fits");
        assert!((size(&found) - 36.0).abs() < 1e-6, "{}", size(&found));
    }

    /// A hole is no part of any rectangle.
    #[test]
    fn holes_are_kept_clear_of() {
        let mut square = area(&[(0., 0.), (0., 10.), (10., 10.), (10., 0.)]);
        let hole = area(&[(4., 4.), (4., 6.), (6., 6.), (6., 4.)]);
        square = Area::new(square.outer, vec![hole.outer]);
        let found = along(&square, coord! { x: 1., y: 0. }).expect("fits");
        assert!((size(&found) - 40.0).abs() < 1e-6, "{}", size(&found));
    }
}
