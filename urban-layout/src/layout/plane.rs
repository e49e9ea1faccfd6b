//! The little plane geometry that checks, metrics and writers share.
//!
//! Nothing here decides anything about a layout: areas, distances, stretches of
//! a segment near another, an index of segments, and polygon booleans.

use geo_types::{Coord, LineString, Polygon};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::float::overlay::{FloatOverlay, OverlayOptions};
use rstar::{RTree, RTreeObject, AABB};

/// `a - b`.
pub(crate) fn minus(a: Coord<f64>, b: Coord<f64>) -> Coord<f64> {
    Coord {
        x: a.x - b.x,
        y: a.y - b.y,
    }
}

/// The point at `t` of the way from `a` to `b`.
pub(crate) fn lerp(a: Coord<f64>, b: Coord<f64>, t: f64) -> Coord<f64> {
    Coord {
        x: a.x + t * (b.x - a.x),
        y: a.y + t * (b.y - a.y),
    }
}

/// Dot product.
pub(crate) fn dot(u: Coord<f64>, v: Coord<f64>) -> f64 {
    u.x * v.x + u.y * v.y
}

/// The z component of the cross product.
pub(crate) fn cross(u: Coord<f64>, v: Coord<f64>) -> f64 {
    u.x * v.y - u.y * v.x
}

/// Whether a coordinate can be that of a point of a plan: finite, and nearer than
/// the moon. What cannot is left out of indices and booleans.
pub(crate) fn usable(c: Coord<f64>) -> bool {
    c.x.abs() < 1e8 && c.y.abs() < 1e8
}

/// Distance between two points.
pub(crate) fn distance(a: Coord<f64>, b: Coord<f64>) -> f64 {
    (a.x - b.x).hypot(a.y - b.y)
}

/// Turn at `b` on the way from `a` to `c`, degrees, left positive.
pub(crate) fn turn_deg(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> f64 {
    let (u, v) = (minus(b, a), minus(c, b));
    cross(u, v).atan2(dot(u, v)).to_degrees()
}

/// A ring's vertices without the closing repetition.
pub(crate) fn open_ring(ring: &LineString<f64>) -> &[Coord<f64>] {
    match ring.0.as_slice() {
        [first, rest @ .., last] if first == last && !rest.is_empty() => {
            &ring.0[..ring.0.len() - 1]
        }
        all => all,
    }
}

/// Signed area of a ring, counter-clockwise positive; summed relative to the
/// first vertex so that a far origin costs no digits.
pub(crate) fn signed_area(ring: &[Coord<f64>]) -> f64 {
    let Some(&origin) = ring.first() else {
        return 0.0;
    };
    let twice: f64 = ring
        .windows(2)
        .map(|w| cross(minus(w[0], origin), minus(w[1], origin)))
        .sum();
    0.5 * twice
}

/// Area of a polygon less its holes, whatever way the rings run.
pub(crate) fn polygon_area(polygon: &Polygon<f64>) -> f64 {
    let holes: f64 = polygon
        .interiors()
        .iter()
        .map(|r| signed_area(&r.0).abs())
        .sum();
    signed_area(&polygon.exterior().0).abs() - holes
}

/// All rings, the exterior first.
pub(crate) fn rings(polygon: &Polygon<f64>) -> impl Iterator<Item = &LineString<f64>> {
    std::iter::once(polygon.exterior()).chain(polygon.interiors())
}

/// Length of a polyline.
pub(crate) fn length(line: &[Coord<f64>]) -> f64 {
    line.windows(2).map(|w| distance(w[0], w[1])).sum()
}

/// The same polygon, exterior counter-clockwise and holes clockwise.
pub(crate) fn oriented(polygon: Polygon<f64>) -> Polygon<f64> {
    let (mut exterior, mut interiors) = polygon.into_inner();
    if signed_area(&exterior.0) < 0.0 {
        exterior.0.reverse();
    }
    for hole in &mut interiors {
        if signed_area(&hole.0) > 0.0 {
            hole.0.reverse();
        }
    }
    Polygon::new(exterior, interiors)
}

/// Parameter in \[0, 1\] of the point of segment `a b` nearest `p`.
pub(crate) fn nearest_parameter(p: Coord<f64>, a: Coord<f64>, b: Coord<f64>) -> f64 {
    let u = minus(b, a);
    let square = dot(u, u);
    if square > 0.0 {
        (dot(minus(p, a), u) / square).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Distance of `p` to segment `a b`.
pub(crate) fn distance_to_segment(p: Coord<f64>, a: Coord<f64>, b: Coord<f64>) -> f64 {
    distance(p, lerp(a, b, nearest_parameter(p, a, b)))
}

/// Parameters (on `a b`, on `c d`) where two segments cross or touch, if they
/// are not parallel (to 1e-12 radians: over a kilometre a nanometre).
pub(crate) fn crossing(
    a: Coord<f64>,
    b: Coord<f64>,
    c: Coord<f64>,
    d: Coord<f64>,
) -> Option<(f64, f64)> {
    let (u, v, w) = (minus(b, a), minus(d, c), minus(c, a));
    let det = cross(u, v);
    if det * det <= 1e-24 * dot(u, u) * dot(v, v) {
        return None;
    }
    let (t, s) = (cross(w, v) / det, cross(w, u) / det);
    ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&s)).then_some((t, s))
}

/// Distance between two segments, 0 where they cross.
pub(crate) fn segment_distance(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>, d: Coord<f64>) -> f64 {
    if crossing(a, b, c, d).is_some() {
        return 0.0;
    }
    distance_to_segment(a, c, d)
        .min(distance_to_segment(b, c, d))
        .min(distance_to_segment(c, a, b))
        .min(distance_to_segment(d, a, b))
}

/// The stretch of segment `a b`, as parameters in \[0, 1\], that lies within `r`
/// of segment `c d`. It is one interval, since a capsule is convex.
pub(crate) fn stretch_within(
    a: Coord<f64>,
    b: Coord<f64>,
    c: Coord<f64>,
    d: Coord<f64>,
    r: f64,
) -> Option<(f64, f64)> {
    let u = minus(b, a);
    let square = dot(u, u);
    if square == 0.0 {
        return (distance_to_segment(a, c, d) <= r).then_some((0.0, 1.0));
    }
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for centre in [c, d] {
        let w = minus(a, centre);
        let (half, rest) = (dot(w, u), dot(w, w) - r * r);
        let root = half * half - square * rest;
        if root >= 0.0 {
            low = low.min((-half - root.sqrt()) / square);
            high = high.max((-half + root.sqrt()) / square);
        }
    }
    // The straight part: two slabs, across and along c d.
    let axis = minus(d, c);
    let long = axis.x.hypot(axis.y);
    if long > 0.0 {
        let (w, e) = (
            minus(a, c),
            Coord {
                x: axis.x / long,
                y: axis.y / long,
            },
        );
        let slabs = [
            (cross(e, w), cross(e, u), -r, r),
            (dot(e, w), dot(e, u), 0.0, long),
        ];
        let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
        for (at, rate, min, max) in slabs {
            if rate.abs() > 1e-14 * square.sqrt() {
                let (s, t) = ((min - at) / rate, (max - at) / rate);
                from = from.max(s.min(t));
                to = to.min(s.max(t));
            } else if at < min || at > max {
                to = f64::NEG_INFINITY;
            }
        }
        if from <= to {
            low = low.min(from);
            high = high.max(to);
        }
    }
    let (low, high) = (low.max(0.0), high.min(1.0));
    (low <= high).then_some((low, high))
}

/// Total length of a set of intervals, overlaps counted once.
pub(crate) fn union_length(intervals: &mut [(f64, f64)]) -> f64 {
    intervals.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.total_cmp(&q.1)));
    let (mut sum, mut end) = (0.0, f64::NEG_INFINITY);
    for &(from, to) in intervals.iter() {
        let from = from.max(end);
        if to > from {
            sum += to - from;
            end = to;
        }
    }
    sum
}

/// A segment of something: `owner` says of what, `index` which one of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment {
    pub(crate) a: Coord<f64>,
    pub(crate) b: Coord<f64>,
    pub(crate) owner: usize,
    pub(crate) index: usize,
}

impl RTreeObject for Segment {
    type Envelope = AABB<[f64; 2]>;
    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners([self.a.x, self.a.y], [self.b.x, self.b.y])
    }
}

/// Pairs of points as segments of one owner, counted.
fn segments<'a>(
    owner: usize,
    pairs: impl Iterator<Item = &'a [Coord<f64>]> + 'a,
) -> impl Iterator<Item = Segment> + 'a {
    pairs.enumerate().map(move |(index, w)| Segment {
        a: w[0],
        b: w[1],
        owner,
        index,
    })
}

/// An index of segments.
#[derive(Debug)]
pub(crate) struct Segments(RTree<Segment>);

impl Segments {
    /// Indexes the segments of polylines; `owner` is the polyline's number.
    pub(crate) fn of_lines<'a>(lines: impl IntoIterator<Item = &'a [Coord<f64>]>) -> Self {
        let mut all = Vec::new();
        for (owner, line) in lines.into_iter().enumerate() {
            all.extend(segments(owner, line.windows(2)));
        }
        Self::of(all)
    }

    /// Indexes the edges of polygons; `owner` is the polygon's number, `index`
    /// counts over all its rings.
    pub(crate) fn of_polygons<'a>(polygons: impl IntoIterator<Item = &'a Polygon<f64>>) -> Self {
        let mut all = Vec::new();
        for (owner, polygon) in polygons.into_iter().enumerate() {
            let edges = rings(polygon).flat_map(|ring| ring.0.windows(2));
            all.extend(segments(owner, edges));
        }
        Self::of(all)
    }

    /// Indexes those whose ends are numbers.
    fn of(mut all: Vec<Segment>) -> Self {
        all.retain(|s| usable(s.a) && usable(s.b));
        Self(RTree::bulk_load(all))
    }

    /// All segments.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Segment> {
        self.0.iter()
    }

    /// Segments whose box comes within `margin` of the box of `a b`.
    pub(crate) fn near(
        &self,
        a: Coord<f64>,
        b: Coord<f64>,
        margin: f64,
    ) -> impl Iterator<Item = &Segment> {
        let low = [a.x.min(b.x) - margin, a.y.min(b.y) - margin];
        let high = [a.x.max(b.x) + margin, a.y.max(b.y) + margin];
        self.0
            .locate_in_envelope_intersecting(&AABB::from_corners(low, high))
    }

    /// Whether some segment lies within `reach` of `p`.
    pub(crate) fn within(&self, p: Coord<f64>, reach: f64) -> bool {
        self.near(p, p, reach)
            .any(|s| distance_to_segment(p, s.a, s.b) <= reach)
    }

    /// Numbers of the polygons that contain `p`, by crossings of the ray
    /// towards east; for an index made by [`Self::of_polygons`].
    pub(crate) fn containing(&self, p: Coord<f64>) -> Vec<usize> {
        let far = Coord {
            x: f64::MAX,
            y: p.y,
        };
        let mut crossed: Vec<usize> = self
            .near(p, far, 0.0)
            .filter(|s| (s.a.y > p.y) != (s.b.y > p.y))
            .filter(|s| p.x < s.a.x + (p.y - s.a.y) / (s.b.y - s.a.y) * (s.b.x - s.a.x))
            .map(|s| s.owner)
            .collect();
        crossed.sort_unstable();
        crossed
            .chunk_by(|a, b| a == b)
            .filter(|run| run.len() % 2 == 1)
            .map(|run| run[0])
            .collect()
    }
}

/// Boolean of two sets of polygons, results valid by OGC's rules and oriented.
/// Subjects may overlap each other (they count once), so may clips.
pub(crate) fn overlay<'a>(
    subject: impl IntoIterator<Item = &'a Polygon<f64>>,
    clip: impl IntoIterator<Item = &'a Polygon<f64>>,
    rule: OverlayRule,
) -> Vec<Polygon<f64>> {
    fn shapes<'a>(polygons: impl IntoIterator<Item = &'a Polygon<f64>>) -> Vec<Vec<Vec<[f64; 2]>>> {
        polygons
            .into_iter()
            .filter(|p| rings(p).flat_map(|r| &r.0).all(|c| usable(*c)))
            .map(|p| {
                rings(p)
                    .map(|r| open_ring(r).iter().map(|c| [c.x, c.y]).collect())
                    .collect()
            })
            .collect()
    }
    let (subject, clip) = (shapes(subject), shapes(clip));
    let mut overlay = FloatOverlay::<[f64; 2], i64>::from_subj_and_clip_custom(
        &subject,
        &clip,
        OverlayOptions::ogc(),
        Solver::default(),
    );
    let coords = |path: Vec<[f64; 2]>| {
        path.into_iter()
            .map(|[x, y]| Coord { x, y })
            .collect::<LineString<f64>>()
    };
    overlay
        .overlay(rule, FillRule::NonZero)
        .into_iter()
        .filter_map(|shape| {
            let mut paths = shape.into_iter().map(coords);
            let exterior = paths.next()?;
            Some(oriented(Polygon::new(exterior, paths.collect())))
        })
        .collect()
}

/// Area of what `subject` has and `clip` has not, square metres.
pub(crate) fn area_outside<'a>(
    subject: impl IntoIterator<Item = &'a Polygon<f64>>,
    clip: impl IntoIterator<Item = &'a Polygon<f64>>,
) -> f64 {
    overlay(subject, clip, OverlayRule::Difference)
        .iter()
        .map(polygon_area)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{coord, polygon};

    #[test]
    fn the_stretch_near_a_segment_is_found() {
        let (a, b) = (coord! { x: 0.0, y: 0.0 }, coord! { x: 10.0, y: 0.0 });
        let (c, d) = (coord! { x: 4.0, y: 1.0 }, coord! { x: 6.0, y: 1.0 });
        let (low, high) = stretch_within(a, b, c, d, 2.0_f64.sqrt()).expect("near");
        assert!((low - 0.3).abs() < 1e-12 && (high - 0.7).abs() < 1e-12);
        assert!(stretch_within(a, b, c, d, 0.9).is_none());
        let across = stretch_within(
            a,
            b,
            coord! { x: 5.0, y: -3.0 },
            coord! { x: 5.0, y: 3.0 },
            1.0,
        );
        let (low, high) = across.expect("crosses");
        assert!((low - 0.4).abs() < 1e-12 && (high - 0.6).abs() < 1e-12);
    }

    #[test]
    fn points_are_in_the_polygons_around_them() {
        let ring = polygon!(exterior: [(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 9.), (x: 0., y: 9.)],
            interiors: [[(x: 3., y: 3.), (x: 3., y: 6.), (x: 6., y: 6.), (x: 6., y: 3.)]]);
        let index = Segments::of_polygons([&ring]);
        assert_eq!(index.containing(coord! { x: 1.0, y: 4.0 }), vec![0]);
        assert!(index.containing(coord! { x: 4.0, y: 4.0 }).is_empty());
        assert!(index.containing(coord! { x: 10.0, y: 4.0 }).is_empty());
    }

    #[test]
    fn intervals_count_once() {
        assert_eq!(union_length(&mut [(2.0, 3.0), (0.0, 1.0), (0.5, 1.5)]), 2.5);
    }
}
