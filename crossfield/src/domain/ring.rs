//! Cleaning of input rings, and where their corners are.

use geo_types::{Coord, LineString, Polygon};

use super::Corner;
use crate::plane::{vector, wedge, V2};
use crate::FieldError;

/// One boundary ring, relative to the domain's centre, walked with the domain
/// on its left: the exterior counter-clockwise, holes clockwise.
#[derive(Clone, Debug)]
pub(crate) struct Ring {
    /// Vertices, without a closing copy of the first.
    pub(crate) points: Vec<V2>,
    /// For edge `k`, from vertex `k` to `k + 1`: which edge of the input.
    pub(crate) input_edge: Vec<u32>,
    /// For vertex `k`: which vertex of the input.
    pub(crate) input_vertex: Vec<u32>,
    /// Turn at each vertex, radians, positive to the left (convex).
    pub(crate) turn: Vec<f64>,
    /// Whether the turn exceeds the corner threshold.
    pub(crate) corner: Vec<bool>,
    /// Number of edges of the input ring.
    pub(crate) input_edges: usize,
}

impl Ring {
    /// Start and end of edge `k`.
    pub(crate) fn edge(&self, k: usize) -> (V2, V2) {
        (self.points[k], self.points[self.next(k)])
    }

    /// Unit direction of edge `k`.
    pub(crate) fn direction(&self, k: usize) -> V2 {
        let (a, b) = self.edge(k);
        (b - a).normalize()
    }

    /// Number of vertices, and of edges.
    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    /// The vertex after `k`.
    pub(crate) fn next(&self, k: usize) -> usize {
        if k + 1 == self.len() {
            0
        } else {
            k + 1
        }
    }

    /// The vertex before `k`.
    pub(crate) fn previous(&self, k: usize) -> usize {
        if k == 0 {
            self.len() - 1
        } else {
            k - 1
        }
    }

    /// Signed area, positive counter-clockwise.
    pub(crate) fn area(&self) -> f64 {
        signed_area(&self.points)
    }

    /// Length of all edges.
    pub(crate) fn perimeter(&self) -> f64 {
        (0..self.len())
            .map(|k| {
                let (a, b) = self.edge(k);
                (b - a).norm()
            })
            .sum()
    }

    /// Recomputes turns and corners from the points.
    fn find_corners(&mut self, corner: f64) {
        self.turn = (0..self.len())
            .map(|k| {
                let (before, after) = (self.direction(self.previous(k)), self.direction(k));
                wedge(before, after).atan2(before.dot(&after))
            })
            .collect();
        self.corner = self.turn.iter().map(|turn| turn.abs() > corner).collect();
    }

    /// Whether `p` lies inside, by the even-odd rule.
    pub(crate) fn contains(&self, p: V2) -> bool {
        (0..self.len())
            .filter(|&k| {
                let (a, b) = self.edge(k);
                (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
            })
            .count()
            % 2
            == 1
    }
}

/// Signed area of a closed chain, positive counter-clockwise.
fn signed_area(points: &[V2]) -> f64 {
    let Some(&origin) = points.first() else {
        return 0.0;
    };
    points
        .windows(2)
        .map(|pair| wedge(pair[0] - origin, pair[1] - origin))
        .sum::<f64>()
        / 2.0
}

/// The frame of a domain: its centre, and the diagonal of its bounding box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) origin: V2,
    pub(crate) size: f64,
}

/// All rings of `polygon`, cleaned and oriented, with their frame.
pub(crate) fn rings(polygon: &Polygon<f64>, corner: f64) -> Result<(Frame, Vec<Ring>), FieldError> {
    let inputs = || std::iter::once(polygon.exterior()).chain(polygon.interiors());
    for (ring, line) in inputs().enumerate() {
        for (vertex, c) in line.0.iter().enumerate() {
            // Areas are products of two lengths: beyond this they overflow.
            let usable = |value: f64| value.is_finite() && value.abs() < 1e150;
            if !usable(c.x) || !usable(c.y) {
                return Err(FieldError::NonFinite { ring, vertex });
            }
        }
    }
    let frame = frame(polygon.exterior()).ok_or(FieldError::ZeroArea { ring: 0 })?;
    let rings = inputs()
        .enumerate()
        .map(|(index, line)| clean(line, index, frame, corner))
        .collect::<Result<Vec<_>, _>>()?;
    Ok((frame, rings))
}

/// Centre and size of the bounding box; `None` for an empty or point-like ring.
fn frame(line: &LineString<f64>) -> Option<Frame> {
    let first = vector(*line.0.first()?);
    let (low, high) = line.0.iter().fold((first, first), |(low, high), &c| {
        (low.inf(&vector(c)), high.sup(&vector(c)))
    });
    let size = (high - low).norm();
    (size > 1e-150).then_some(Frame {
        origin: low + (high - low) / 2.0,
        size,
    })
}

/// One ring: duplicates merged, oriented with the domain on its left.
fn clean(
    line: &LineString<f64>,
    index: usize,
    frame: Frame,
    corner: f64,
) -> Result<Ring, FieldError> {
    let coords = open(&line.0);
    let count = coords.len();
    // Closer vertices than this are one: a thousandth of a millimetre on a
    // kilometre, below what any survey means, yet far above rounding.
    let merge = (1e-9 * frame.size).powi(2);
    let near = |a: V2, b: V2| (a - b).norm_squared() <= merge;
    let local: Vec<V2> = coords.iter().map(|&c| vector(c) - frame.origin).collect();
    let mut kept: Vec<usize> = Vec::with_capacity(count);
    for k in 0..count {
        if kept.last().is_none_or(|&last| !near(local[last], local[k])) {
            kept.push(k);
        }
    }
    // Vertices at the end that repeat the first one: the edge that closes the
    // ring is then the one that arrives at the earliest of them.
    let mut end = count;
    while kept.len() > 1 && near(local[kept[0]], local[kept[kept.len() - 1]]) {
        end = kept.pop().unwrap_or(end);
    }
    if kept.len() < 3 {
        return Err(FieldError::ZeroArea { ring: index });
    }
    // Of the input edges between two kept vertices all but the last are of
    // (almost) no length.
    let arrivals = kept[1..].iter().copied().chain([end]);
    let mut input_edge: Vec<u32> = arrivals.map(|k| (k - 1) as u32).collect();
    let mut input_vertex: Vec<u32> = kept.iter().map(|&k| k as u32).collect();
    let mut points: Vec<V2> = kept.iter().map(|&k| local[k]).collect();
    let area = signed_area(&points);
    if area.abs() <= 1e-13 * frame.size * frame.size && !has_width(&points, frame.size) {
        return Err(FieldError::ZeroArea { ring: index });
    }
    if (area > 0.0) != (index == 0) {
        points.reverse();
        input_vertex.reverse();
        // Vertex k was vertex m-1-k, so edge k was edge m-2-k.
        input_edge.reverse();
        input_edge.rotate_left(1);
    }
    let mut ring = Ring {
        points,
        input_edge,
        input_vertex,
        turn: Vec::new(),
        corner: Vec::new(),
        input_edges: count,
    };
    ring.find_corners(corner);
    Ok(ring)
}

/// Whether a ring of tiny area is tiny rather than flat (a small hole in a
/// large domain is legitimate).
fn has_width(points: &[V2], size: f64) -> bool {
    let reach = points
        .iter()
        .map(|p| (p - points[0]).norm())
        .fold(0.0, f64::max);
    let area = signed_area(points).abs();
    reach < 1e-3 * size && area > 1e-9 * reach * reach
}

/// The vertices without the closing copy of the first.
fn open(coords: &[Coord<f64>]) -> &[Coord<f64>] {
    match coords {
        [first, rest @ .., last] if first == last && !rest.is_empty() => {
            &coords[..coords.len() - 1]
        }
        _ => coords,
    }
}

/// The corners of all rings.
pub(crate) fn corners(rings: &[Ring], origin: V2) -> Vec<Corner> {
    let mut corners = Vec::new();
    for (index, ring) in rings.iter().enumerate() {
        for k in (0..ring.len()).filter(|&k| ring.corner[k]) {
            corners.push(Corner {
                at: crate::plane::coord(ring.points[k] + origin),
                ring: index,
                vertex: ring.input_vertex[k] as usize,
                turn: ring.turn[k],
            });
        }
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::polygon;

    fn clean_rings(polygon: &Polygon<f64>) -> Vec<Ring> {
        rings(polygon, 0.5).expect("valid").1
    }

    #[test]
    fn clockwise_exterior_keeps_its_input_edges() {
        // Input edges: 0 north, 1 east, 2 south, 3 west.
        let square = polygon![(x: 0., y: 0.), (x: 0., y: 1.), (x: 1., y: 1.), (x: 1., y: 0.)];
        let ring = &clean_rings(&square)[0];
        assert!(ring.area() > 0.0);
        for k in 0..4 {
            let (a, b) = ring.edge(k);
            let expected = match ring.input_edge[k] {
                0 => V2::new(0.0, -1.0),
                1 => V2::new(-1.0, 0.0),
                2 => V2::new(0.0, 1.0),
                _ => V2::new(1.0, 0.0),
            };
            assert!((b - a - expected).norm() < 1e-12);
        }
        assert!(ring.corner.iter().all(|&corner| corner));
    }

    #[test]
    fn duplicates_are_merged_and_edges_still_named() {
        let square = polygon![(x: 0., y: 0.), (x: 1., y: 0.), (x: 1., y: 0.), (x: 1., y: 1.),
            (x: 0., y: 1.), (x: 0., y: 1e-13), (x: 0., y: 0.)];
        let ring = &clean_rings(&square)[0];
        assert_eq!(ring.len(), 4);
        assert_eq!(ring.input_edge, vec![0, 2, 3, 4]);
        assert_eq!(ring.input_vertex, vec![0, 1, 3, 4]);
    }

    #[test]
    fn flat_rings_are_refused() {
        let flat = polygon![(x: 0., y: 0.), (x: 1., y: 0.), (x: 2., y: 0.)];
        assert_eq!(
            rings(&flat, 0.5).map(|_| ()),
            Err(FieldError::ZeroArea { ring: 0 })
        );
    }
}
