//! Laws of D-fields: the nearest weighted footpoint against an independent
//! search through the polygon itself, weights, sight and the medial axis.

mod shapes;

use crossfield::geo_types::{coord, Coord, Polygon};
use crossfield::{
    Cursor, DistanceField, Domain, FieldDesign, Footpoints, MedialAxis, Sight, Weighting,
};
use proptest::prelude::*;
use shapes::{config, domain, polygon, shape};

type Point = (f64, f64);

fn sub(a: Point, b: Point) -> Point {
    (a.0 - b.0, a.1 - b.1)
}

fn dot(a: Point, b: Point) -> f64 {
    a.0 * b.0 + a.1 * b.1
}

fn wedge(a: Point, b: Point) -> f64 {
    a.0 * b.1 - a.1 * b.0
}

fn unit(a: Point) -> Point {
    let length = a.0.hypot(a.1);
    (a.0 / length, a.1 / length)
}

/// An edge walked with the domain on its left, and the weights of its ends.
#[derive(Clone, Copy, Debug)]
struct Edge {
    a: Point,
    b: Point,
    weights: (f64, f64),
}

/// Each ring of `polygon` with the domain on its left; `weight` is asked by
/// ring and input vertex.
fn rings(polygon: &Polygon<f64>, weight: impl Fn(usize, usize) -> f64) -> Vec<Vec<Edge>> {
    let lines = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    lines
        .enumerate()
        .map(|(r, line)| {
            let mut nodes: Vec<(Point, f64)> = line.0[1..]
                .iter()
                .enumerate()
                .map(|(k, c)| ((c.x, c.y), weight(r, (k + 1) % (line.0.len() - 1))))
                .collect();
            let area: f64 = (0..nodes.len())
                .map(|k| wedge(nodes[k].0, nodes[(k + 1) % nodes.len()].0))
                .sum();
            if (area > 0.0) != (r == 0) {
                nodes.reverse();
            }
            (0..nodes.len())
                .map(|k| {
                    let (a, b) = (nodes[k], nodes[(k + 1) % nodes.len()]);
                    Edge {
                        a: a.0,
                        b: b.0,
                        weights: (a.1, b.1),
                    }
                })
                .collect()
        })
        .collect()
}

/// Whether the open way from `p` to `f` crosses no edge but those that end
/// or run at `f`.
fn seen(rings: &[Vec<Edge>], p: Point, f: Point) -> bool {
    rings.iter().flatten().all(|e| {
        let d = unit(sub(e.b, e.a));
        let gap = |q: Point| {
            let along = dot(d, sub(q, e.a)).clamp(0.0, dot(d, sub(e.b, e.a)));
            let foot = (e.a.0 + d.0 * along, e.a.1 + d.1 * along);
            sub(q, foot).0.hypot(sub(q, foot).1)
        };
        gap(f) < 1e-9
            || wedge(sub(f, p), sub(e.a, p)) * wedge(sub(f, p), sub(e.b, p)) >= 0.0
            || wedge(d, sub(p, e.a)) * wedge(d, sub(f, e.a)) >= 0.0
    })
}

/// Smallest weighted distance of all normal footpoints of `p`, as the
/// supplement defines it in section 4.1.
fn least(rings: &[Vec<Edge>], p: Point, tangents: bool, clear: bool) -> f64 {
    let mut least = f64::INFINITY;
    let mut take = |distance: f64, target: Point| {
        if distance < least && (!clear || seen(rings, p, target)) {
            least = distance;
        }
    };
    for ring in rings {
        for (k, e) in ring.iter().enumerate() {
            let d = unit(sub(e.b, e.a));
            let length = dot(d, sub(e.b, e.a));
            let (along, height) = (dot(d, sub(p, e.a)), wedge(d, sub(p, e.a)));
            if (0.0..=length).contains(&along) && height >= 0.0 {
                let weight = e.weights.0 + (e.weights.1 - e.weights.0) * along / length;
                take(height / weight, (e.a.0 + d.0 * along, e.a.1 + d.1 * along));
            }
            let last = ring[(k + ring.len() - 1) % ring.len()];
            let before = unit(sub(last.b, last.a));
            let turn = wedge(before, d).atan2(dot(before, d));
            let from = sub(p, e.a);
            if turn >= 0.0 || dot(before, from) < 0.0 || dot(d, from) > 0.0 {
                continue;
            }
            let weights = (last.weights.1, e.weights.0);
            if !tangents || turn > -(30.0_f64.to_radians()) {
                take(from.0.hypot(from.1) / weights.0.max(weights.1), e.a);
                continue;
            }
            let (a, b) = (wedge(before, from) / weights.0, wedge(d, from) / weights.1);
            if turn > -(135.0_f64.to_radians()) {
                take(a.max(b), e.a);
                continue;
            }
            // Two corners of half the turn, with a tangent across the tip.
            let (s, c) = (turn / 2.0).sin_cos();
            let cap = (c * before.0 - s * before.1, s * before.0 + c * before.1);
            let across = wedge(cap, from) / ((weights.0 + weights.1) / 2.0);
            if dot(cap, from) <= 0.0 {
                take(a.max(across), e.a);
            }
            if dot(cap, from) >= 0.0 {
                take(across.max(b), e.a);
            }
        }
    }
    least
}

fn weight_lists(shape: &Polygon<f64>, f: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    std::iter::once(shape.exterior())
        .chain(shape.interiors())
        .enumerate()
        .map(|(r, line)| (0..line.0.len() - 1).map(|k| f(r, k)).collect())
        .collect()
}

fn nearest(footpoints: &Footpoints<'_>, p: Point) -> f64 {
    let found = footpoints.nearest(coord! {x: p.0, y: p.1});
    found.map_or(f64::INFINITY, |f| f.weighted_distance)
}

fn inner(domain: &Domain) -> impl Iterator<Item = Coord<f64>> + '_ {
    domain.inner_vertices().map(|v| domain.vertex(v))
}

/// Smooth, spiked and rectilinear polygons; on the last, many footpoints tie.
fn any_shape() -> impl Strategy<Value = Polygon<f64>> {
    prop_oneof![polygon(), shapes::rectilinear()]
}

proptest! {
    #![proptest_config(config(24))]

    /// The tree, with pruning, hints and ties, finds exactly what a search
    /// through all edges finds. Coordinates of 200 m are rounded to 3e-14 m
    /// and directions to 1e-16: distances of two ways of computing agree to
    /// about 1e-12 m over the smallest weight, 0.2.
    #[test]
    fn the_nearest_footpoint_is_that_of_a_full_search(
        shape in any_shape(),
        numbers in proptest::collection::vec(0.2..3.0_f64, 12),
        tangents in any::<bool>(), clear in any::<bool>(),
    ) {
        let domain = domain(&shape, 30.0);
        let weight = |r: usize, k: usize| numbers[(7 * r + k) % 12];
        let rings = rings(&shape, weight);
        let design = DistanceField {
            weights: weight_lists(&shape, weight),
            weighting: Weighting::Vertices,
            concave_tangents: tangents,
            sight: if clear { Sight::Clear } else { Sight::Through },
            ..DistanceField::default()
        };
        let footpoints = design.footpoints(&domain)?;
        for at in inner(&domain) {
            let p = (at.x, at.y);
            let found = nearest(&footpoints, p);
            let all = footpoints.all(at);
            prop_assert_eq!(all.first().map(|f| f.weighted_distance), Some(found));
            let wanted = least(&rings, p, tangents, clear);
            // Beside the end of an edge, or where a way grazes a vertex, the
            // two may differ by rounding on which side a point lies: then a
            // point a micrometre away agrees.
            let near = |(x, y): Point| {
                let q = (p.0 + x, p.1 + y);
                (nearest(&footpoints, q) - least(&rings, q, tangents, clear)).abs() < 1e-9
            };
            prop_assert!(
                (found - wanted).abs() < 1e-9
                    || [(1e-6, 3e-7), (-7e-7, 1e-6), (-4e-7, -1e-6)].into_iter().all(near),
                "at {:?}: {} but {} in all", p, found, wanted
            );
        }
    }

    /// Without weights and tangents the nearest footpoint is the nearest
    /// boundary point, and that one is seen.
    #[test]
    fn the_plain_distance_needs_no_sight(shape in any_shape()) {
        let domain = domain(&shape, 25.0);
        let plain = DistanceField { concave_tangents: false, ..DistanceField::default() };
        let clear = DistanceField { sight: Sight::Clear, ..plain.clone() };
        let footpoints = clear.footpoints(&domain)?;
        for at in inner(&domain) {
            let foot = domain.nearest_boundary(at).point;
            let distance = (foot.x - at.x).hypot(foot.y - at.y);
            prop_assert!((nearest(&footpoints, (at.x, at.y)) - distance).abs() < 1e-9);
        }
        let (a, b) = (plain.design(&domain)?, clear.design(&domain)?);
        for v in 0..domain.vertex_count() {
            prop_assert_eq!(a.representative(v), b.representative(v));
        }
    }

    /// Under [`Sight::Clear`] the way to the footpoint stays inside.
    #[test]
    fn what_counts_is_seen(shape in polygon(), heavy in 1.0..20.0_f64) {
        let domain = domain(&shape, 30.0);
        let design = DistanceField {
            weights: weight_lists(&shape, |_, k| if k % 4 == 0 { heavy } else { 1.0 }),
            concave_tangents: false,
            sight: Sight::Clear,
            ..DistanceField::default()
        };
        let footpoints = design.footpoints(&domain)?;
        for at in inner(&domain) {
            let foot = footpoints.nearest(at).expect("there is always one").point;
            // Not quite to the boundary itself.
            let to = coord! {x: foot.x + (at.x - foot.x) * 1e-6, y: foot.y + (at.y - foot.y) * 1e-6};
            prop_assert!(domain.exit(at, to, &mut Cursor::default()).is_none());
        }
    }

    /// Weights of a piece are those of its edges, and equal weights at all
    /// vertices those of the edges between them.
    #[test]
    fn the_ways_of_weighting_agree(
        shape in polygon(), numbers in proptest::collection::vec(0.2..3.0_f64, 12),
    ) {
        let domain = domain(&shape, 30.0);
        let mut by_piece = vec![Vec::new(); domain.ring_count()];
        let mut by_edge = weight_lists(&shape, |_, _| 0.0);
        for (k, piece) in domain.pieces().iter().enumerate() {
            by_piece[piece.ring].push(numbers[k % 12]);
            piece.edges.iter().for_each(|&e| by_edge[piece.ring][e] = numbers[k % 12]);
        }
        let design = |weights, weighting| DistanceField { weights, weighting, ..DistanceField::default() };
        let pairs = [
            (design(by_edge, Weighting::Edges), design(by_piece, Weighting::Pieces)),
            (
                design(weight_lists(&shape, |r, _| numbers[r]), Weighting::Edges),
                design(weight_lists(&shape, |r, _| numbers[r]), Weighting::Vertices),
            ),
        ];
        for (one, other) in pairs {
            let (one, other) = (one.design(&domain)?, other.design(&domain)?);
            for v in 0..domain.vertex_count() {
                prop_assert_eq!(one.representative(v), other.representative(v));
            }
        }
    }

    /// On a rectangle the medial axis is that of the straight skeleton: every
    /// vertex said to lie on it is within an edge of it, and every inner one
    /// within a quarter of an edge of its middle part is said to.
    #[test]
    fn the_medial_axis_of_a_rectangle(width in 200.0..400.0_f64, ratio in 0.3..1.0_f64) {
        let height = width * ratio;
        let domain = domain(&shape(&[(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]), 8.0);
        let medial = DistanceField::default().medial_axis(&domain)?;
        for v in domain.inner_vertices() {
            let at = domain.vertex(v);
            let gaps = [at.x, width - at.x, at.y, height - at.y];
            let mut sorted = gaps;
            sorted.sort_by(f64::total_cmp);
            // The two nearest sides are as far apart as twice the way to the
            // axis at most.
            if medial[v] {
                prop_assert!(sorted[1] - sorted[0] < 2.0 * 2.2 * 8.0);
            }
            let middle = at.x > height / 2.0 + 20.0 && at.x < width - height / 2.0 - 20.0;
            if middle && (at.y - height / 2.0).abs() < 2.0 {
                prop_assert!(medial[v], "{:?}", at);
            }
        }
        // Nothing jumps on a rectangle, so nothing changes.
        let design = DistanceField { medial_axis: MedialAxis::LeftOut, smoothing_rounds: 3, ..DistanceField::default() };
        prop_assert!(design.design(&domain)?.energy() < 1e-12);
    }
}

/// A heavy side behind a hole rules the land before the hole through it, and
/// not if it must be seen.
#[test]
fn a_hole_hides_what_is_behind_it() {
    let outer = shapes::ring(&[(0., 0.), (100., 0.), (100., 60.), (0., 60.)]);
    let hole = shapes::ring(&[(40., 20.), (60., 15.), (60., 45.), (40., 40.)]);
    let domain = domain(&Polygon::new(outer, vec![hole]), 4.0);
    let at = coord! {x: 20.0, y: 30.0};
    let of = |sight| {
        let design = DistanceField {
            weights: vec![vec![1.0, 9.0, 1.0, 1.0], vec![]],
            sight,
            ..DistanceField::default()
        };
        let footpoints = design.footpoints(&domain).expect("weights fit");
        footpoints.nearest(at).expect("inside")
    };
    let through = of(Sight::Through);
    assert_eq!((through.ring, through.edge), (0, 1));
    assert!((through.weighted_distance - 80.0 / 9.0).abs() < 1e-12);
    let clear = of(Sight::Clear);
    // The west side and the hole's are 20 m away.
    assert!((clear.weighted_distance - 20.0).abs() < 1e-12);
}

/// What jumps at the medial axis is not carried to its sides when the axis
/// is left out: the crosses of all other vertices but those beside it stay.
#[test]
fn the_axis_gives_nothing_when_left_out() {
    let wedge = shape(&[(0., 0.), (100., 0.), (90., 50.), (0., 20.)]);
    let domain = domain(&wedge, 2.0);
    let design = |medial_axis, smoothing_rounds| DistanceField {
        medial_axis,
        smoothing_rounds,
        ..DistanceField::default()
    };
    let raw = design(MedialAxis::Averaged, 0)
        .design(&domain)
        .expect("fits");
    let smooth = design(MedialAxis::LeftOut, 1)
        .design(&domain)
        .expect("fits");
    let medial = design(MedialAxis::LeftOut, 1)
        .medial_axis(&domain)
        .expect("fits");
    assert!(medial.iter().filter(|&&m| m).count() > 40);
    for v in domain.inner_vertices() {
        let beside = domain.neighbours(v).iter().any(|&w| medial[w as usize]);
        let (a, b) = (raw.representative(v), smooth.representative(v));
        let moved = (a.x - b.x).hypot(a.y - b.y);
        // Each part has a constant cross, its own averages included.
        if !medial[v] && !beside {
            assert!(moved < 1e-12);
        }
    }
}
