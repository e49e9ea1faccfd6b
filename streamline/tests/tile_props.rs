//! Laws of tiles, on hostile lines: a lattice makes them touch, overlap, retrace
//! themselves and coincide with the boundary; free ones cross anywhere.
#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod support;

use geo_types::{coord, LineString, Polygon};
use proptest::prelude::*;
use streamline::{
    arm_nearest, candidates, from_fn, tiles, CandidateOptions, Dangling, HalfEdge, Seed,
    Streamline, TileOptions, Tiling,
};
use support::*;

/// Twice the signed area of a ring without its repeated last point.
fn ring_area(points: &[P]) -> f64 {
    let o = points[0];
    let sum: f64 = (0..points.len())
        .map(|i| cross(points[i] - o, points[(i + 1) % points.len()] - o))
        .sum();
    0.5 * sum
}

fn domain_area(domain: &Polygon<f64>) -> f64 {
    let area = |line: &LineString<f64>| ring_area(&line.0[..line.0.len() - 1]).abs();
    area(domain.exterior()) - domain.interiors().iter().map(area).sum::<f64>()
}

/// A square of 12 units with a square hole, on whole numbers.
fn lattice_domain() -> Polygon<f64> {
    let ring = |low: f64, high: f64| {
        LineString(
            [(low, low), (high, low), (high, high), (low, high)]
                .map(|(x, y)| coord! { x: x, y: y })
                .to_vec(),
        )
    };
    Polygon::new(ring(0.0, 12.0), vec![ring(5.0, 7.0)])
}

/// Lines from lattice point to lattice point, some beyond the domain.
fn lattice_lines() -> impl Strategy<Value = Vec<LineString<f64>>> {
    let at =
        (-2..15_i32, -2..15_i32).prop_map(|(x, y)| coord! { x: f64::from(x), y: f64::from(y) });
    let line = prop::collection::vec(at, 0..6).prop_map(LineString);
    prop::collection::vec(line, 0..14)
}

/// Lines that cross a star-shaped domain about the origin anyhow.
fn free_lines() -> impl Strategy<Value = Vec<LineString<f64>>> {
    let at = (-300.0..300.0_f64, -300.0..300.0_f64).prop_map(|(x, y)| coord! { x: x, y: y });
    let line = prop::collection::vec(at, 2..6).prop_map(LineString);
    prop::collection::vec(line, 0..10)
}

fn any_case() -> impl Strategy<Value = (Polygon<f64>, Vec<LineString<f64>>)> {
    prop_oneof![
        (Just(lattice_domain()), lattice_lines()),
        (domain(), free_lines()),
    ]
}

fn moved(lines: &[LineString<f64>], motion: &Motion) -> Vec<LineString<f64>> {
    let line = |l: &LineString<f64>| LineString(l.0.iter().map(|&p| motion.apply(p)).collect());
    lines.iter().map(line).collect()
}

fn options(dangling: Dangling) -> TileOptions {
    TileOptions {
        dangling,
        ..TileOptions::default()
    }
}

fn dangling() -> impl Strategy<Value = Dangling> {
    prop_oneof![
        Just(Dangling::Prune),
        Just(Dangling::Bridges),
        Just(Dangling::Keep)
    ]
}

/// Components of the graph of vertices and edges.
fn components(tiling: &Tiling) -> usize {
    let mut root: Vec<usize> = (0..tiling.vertices.len()).collect();
    fn find(root: &mut [usize], mut v: usize) -> usize {
        while root[v] != v {
            root[v] = root[root[v]];
            v = root[v];
        }
        v
    }
    for edge in &tiling.edges {
        let (a, b) = (
            find(&mut root, edge.vertices[0]),
            find(&mut root, edge.vertices[1]),
        );
        root[a] = b;
    }
    (0..root.len()).filter(|&v| find(&mut root, v) == v).count()
}

/// Exact: coordinates are multiples of the precision below 2^39 of it, so their
/// differences are too, and products of those fit 128 bits.
fn orient(tiling: &Tiling, a: P, b: P, c: P) -> i128 {
    let g = tiling.precision();
    let whole = |v: f64| {
        let n = v / g;
        assert_eq!(n, n.round(), "off the grid");
        n as i128
    };
    let (u, v) = (b - a, c - a);
    whole(u.x) * whole(v.y) - whole(u.y) * whole(v.x)
}

/// No vertex within an edge, no two edges that cross: all pairs.
fn check_planar(tiling: &Tiling) -> Result<(), TestCaseError> {
    let at = |v: usize| tiling.vertices[v];
    for e in &tiling.edges {
        let (a, b) = (at(e.vertices[0]), at(e.vertices[1]));
        for (v, &p) in tiling.vertices.iter().enumerate() {
            if !e.vertices.contains(&v) && orient(tiling, a, b, p) == 0 {
                let beyond = dot(p - a, b - a) < 0.0 || dot(p - b, a - b) < 0.0;
                prop_assert!(beyond, "vertex {p:?} within the edge {a:?} {b:?}");
            }
        }
        for f in &tiling.edges {
            let (c, d) = (at(f.vertices[0]), at(f.vertices[1]));
            let sides = (
                orient(tiling, a, b, c).signum() * orient(tiling, a, b, d).signum(),
                orient(tiling, c, d, a).signum() * orient(tiling, c, d, b).signum(),
            );
            prop_assert!(sides != (-1, -1), "{a:?} {b:?} crosses {c:?} {d:?}");
        }
    }
    Ok(())
}

/// Every edge is followed once by each tile beside it, and rings are closed.
fn check_twins(tiling: &Tiling) -> Result<(), TestCaseError> {
    let mut seen = vec![[None; 2]; tiling.edges.len()];
    for (t, tile) in tiling.tiles.iter().enumerate() {
        for ring in &tile.rings {
            for (i, &h) in ring.iter().enumerate() {
                let side = usize::from(!h.forward);
                prop_assert_eq!(seen[h.edge][side], None, "an edge followed twice");
                seen[h.edge][side] = Some(t);
                let twin = HalfEdge {
                    forward: !h.forward,
                    ..h
                };
                prop_assert_eq!(tiling.tail(twin), tiling.tail(ring[(i + 1) % ring.len()]));
                prop_assert_eq!(tiling.across(twin), Some(t));
            }
        }
    }
    for (edge, seen) in tiling.edges.iter().zip(seen) {
        prop_assert_eq!(edge.tiles, seen);
        // One side outside exactly where the boundary runs.
        prop_assert_eq!(edge.boundary.is_some(), seen.contains(&None));
        prop_assert!(seen != [None, None]);
        prop_assert!(edge.boundary.is_some() || !edge.lines.is_empty());
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases())]

    /// Partition, watertight: areas sum to the domain's, no overlap (the
    /// drawing is planar, and every edge has one tile on each side), positive
    /// areas that agree with the polygons.
    #[test]
    fn tiles_are_a_partition((land, lines) in any_case(), motion in motion(), keep in dangling()) {
        let land = motion.polygon(&land);
        let tiling = tiles(&land, &moved(&lines, &motion), &options(keep)).unwrap();
        check_twins(&tiling)?;
        check_planar(&tiling)?;
        let whole = domain_area(&land);
        let sum: f64 = tiling.tiles.iter().map(|t| t.area).sum();
        // Vertices move by up to a spacing each; lattice domains measure 12 m,
        // so at map coordinates (spacing 4e-9) the boundary of 56 m may sweep
        // 56 * 4e-9 m2 of 140. Else 1e-9 of the whole.
        let perimeter: f64 = edges(&land).iter().map(|e| norm(e.3 - e.2)).sum();
        let bound = (perimeter * tiling.precision()).max(1e-9 * whole);
        prop_assert!((sum - whole).abs() <= bound, "{sum} of {whole}, {bound}");
        for (t, tile) in tiling.tiles.iter().enumerate() {
            let areas: Vec<f64> = tile.rings.iter().map(|ring| {
                let points: Vec<P> = ring.iter().map(|&h| tiling.vertices[tiling.tail(h)]).collect();
                ring_area(&points)
            }).collect();
            prop_assert!(areas[0] > 0.0 && areas[1..].iter().all(|&a| a <= 0.0));
            prop_assert!(tile.area > 0.0);
            // The shoelace rounds at 1e-16 of products of up to 600 m squared.
            prop_assert!((areas.iter().sum::<f64>() - tile.area).abs() < 1e-8);
            for &h in tile.rings.iter().flatten() {
                let degree = tiling.edges.iter().filter(|e| e.vertices.contains(&tiling.tail(h))).count();
                prop_assert!(degree > usize::from(keep != Dangling::Keep), "a loose end");
            }
            for n in tiling.neighbours(t) {
                prop_assert!(tiling.neighbours(n).contains(&t));
            }
            prop_assert!(keep != Dangling::Prune || tile.rings.iter().flatten().all(|&h| tiling.across(h) != Some(t)));
        }
    }

    /// V - E + F = 1 + C, where F counts the tiles, the outside and the holes.
    #[test]
    fn euler((land, lines) in any_case(), keep in dangling()) {
        let tiling = tiles(&land, &lines, &options(keep)).unwrap();
        let faces = tiling.tiles.len() + 1 + land.interiors().len();
        let (v, e) = (tiling.vertices.len(), tiling.edges.len());
        prop_assert_eq!(v + faces, e + 1 + components(&tiling));
    }

    /// Neither the order nor the sense of lines matters.
    #[test]
    fn order_does_not_matter((land, lines) in any_case(), turn in 0..20_usize, keep in dangling()) {
        let n = lines.len();
        let there = |i: usize| n - 1 - (i + turn) % n;
        let mut other = vec![LineString(vec![]); n];
        for (i, line) in lines.iter().enumerate() {
            other[there(i)] = line.clone();
            other[there(i)].0.reverse();
        }
        let one = tiles(&land, &lines, &options(keep)).unwrap();
        let mut two = tiles(&land, &other, &options(keep)).unwrap();
        for edge in &mut two.edges {
            edge.lines = (0..n).filter(|&i| edge.lines.contains(&there(i))).collect();
        }
        prop_assert_eq!(one, two);
    }

    /// Turned and shifted lines cut turned and shifted tiles. Lines that cross
    /// at random; each tile of the one that is larger than what rounding can
    /// make has its like in the other.
    #[test]
    fn motions_move_the_tiles(land in domain(), lines in free_lines(), motion in motion()) {
        let one = tiles(&land, &lines, &options(Dangling::Prune)).unwrap();
        let two = tiles(&motion.polygon(&land), &moved(&lines, &motion), &options(Dangling::Prune)).unwrap();
        let large = |tiling: &Tiling| {
            let mut areas: Vec<f64> = tiling.tiles.iter().map(|t| t.area).filter(|&a| a > 1e-3).collect();
            areas.sort_by(f64::total_cmp);
            areas
        };
        let (a, b) = (large(&one), large(&two));
        // An area at the threshold itself may fall either way.
        prop_assume!(a.iter().chain(&b).all(|x| (x - 1e-3).abs() > 1e-4));
        prop_assert_eq!(a.len(), b.len());
        for (x, y) in a.iter().zip(&b) {
            // Perimeters below 1e4 m, vertices moved by a few 2e-9 m.
            prop_assert!((x - y).abs() < 1e-4, "{x} {y}");
        }
    }

    /// Where the grid is so coarse that everything is rounded onto everything:
    /// a domain of a hundred spacings across, far from the origin.
    #[test]
    fn rounding_alone_breaks_nothing(land in domain(), lines in free_lines(), keep in dangling(), size in 0.01..0.2_f64) {
        let far = 2.0_f64.powi(40); // Numbers are 2.4e-4 apart there, the grid 2e-3.
        let near = |l: &LineString<f64>| {
            LineString(l.0.iter().map(|p| coord! { x: far + p.x * size / 500.0, y: -far + p.y * size / 500.0 }).collect())
        };
        let land = Polygon::new(near(land.exterior()), land.interiors().iter().map(near).collect());
        let lines: Vec<_> = lines.iter().map(near).collect();
        let Ok(tiling) = tiles(&land, &lines, &TileOptions { snap: 0.0, dangling: keep }) else {
            // No extent is left.
            return Ok(());
        };
        check_twins(&tiling)?;
        check_planar(&tiling)?;
        prop_assert!(tiling.tiles.iter().all(|t| t.area > 0.0));
        let sum: f64 = tiling.tiles.iter().map(|t| t.area).sum();
        let perimeter: f64 = edges(&land).iter().map(|e| norm(e.3 - e.2)).sum();
        // Input to half a spacing, pieces to another 0.71.
        let g = tiling.precision();
        prop_assert!((sum - domain_area(&land)).abs() <= 2.0 * g * (perimeter + 40.0 * g));
    }

    /// What the tracer makes of a whole region: every line ends on the boundary,
    /// so that pruning finds nothing that hangs, and the tiles are a partition.
    #[test]
    fn traced_lines_divide(land in domain(), waves in waves(), motion in motion()) {
        let home = wavy(land.clone(), waves);
        let there = motion.polygon(&land);
        let field = from_fn(there.clone(), move |at, heading| {
            let arm = arm_nearest(waves.angle(motion.undo(at)), motion.undo_turn(heading));
            Some(motion.turn(arm))
        });
        let seeds: Vec<Seed> = lattice(&home, 260.0, 30.0).iter().map(|s| Seed {
            at: motion.apply(s.at),
            directions: s.directions.map(|d| motion.turn(d)),
        }).collect();
        let options_of_lines = CandidateOptions { separation: 30.0, ..CandidateOptions::default() };
        let lines = candidates(&field, &seeds, &options_of_lines).unwrap();
        let strings: Vec<_> = lines.iter().map(Streamline::to_line_string).collect();
        let tiling = tiles(&there, &strings, &options(Dangling::Bridges)).unwrap();
        let kept = tiles(&there, &strings, &options(Dangling::Keep)).unwrap();
        check_twins(&tiling)?;
        let whole = domain_area(&there);
        let sum: f64 = tiling.tiles.iter().map(|t| t.area).sum();
        // Vertices move by 4e-9 m along less than 4 km of 3e4 m2 at the least.
        prop_assert!((sum - whole).abs() <= 1e-9 * whole);
        if lines.iter().all(|l| l.start.is_boundary() && l.end.is_boundary()) {
            let stubs = |tiling: &Tiling| tiling.edges.iter().map(|e| {
                norm(tiling.vertices[e.vertices[1]] - tiling.vertices[e.vertices[0]])
            }).sum::<f64>();
            // Ends may overshoot by rounding, not more.
            prop_assert!((stubs(&tiling) - stubs(&kept)).abs() < 1e-6 * (1 + lines.len()) as f64);
        }
    }

    /// The same cut at any magnitude of the coordinates.
    #[test]
    fn magnitude_does_not_matter(lines in lattice_lines(), power in -60..60_i32) {
        let scale = 2.0_f64.powi(power);
        let scaled = |l: &LineString<f64>| LineString(l.0.iter().map(|&p| p * scale).collect());
        let land = lattice_domain();
        let grown = Polygon::new(scaled(land.exterior()), land.interiors().iter().map(scaled).collect());
        let none = TileOptions { snap: 0.0, ..TileOptions::default() };
        let one = tiles(&land, &lines, &none).unwrap();
        let two = tiles(&grown, &lines.iter().map(scaled).collect::<Vec<_>>(), &none).unwrap();
        // A power of two rounds nothing.
        prop_assert_eq!(&one.edges, &two.edges);
        prop_assert!(one.vertices.iter().zip(&two.vertices).all(|(&a, &b)| a * scale == b));
    }
}

/// n x n lines: (n + 1)^2 tiles, of known areas and neighbours.
#[test]
fn a_grid_of_streets() {
    let n = 40;
    let size = f64::from(n + 1);
    let land = Polygon::new(
        LineString(vec![
            coord! { x: 0., y: 0. },
            coord! { x: size, y: 0. },
            coord! { x: size, y: size },
            coord! { x: 0., y: size },
        ]),
        vec![],
    );
    let lines: Vec<LineString<f64>> = (1..=n)
        .flat_map(|i| {
            let i = f64::from(i);
            [
                LineString(vec![coord! { x: i, y: 0. }, coord! { x: i, y: size }]),
                LineString(vec![coord! { x: 0., y: i }, coord! { x: size, y: i }]),
            ]
        })
        .collect();
    let tiling = tiles(&land, &lines, &TileOptions::default()).unwrap();
    assert_eq!(tiling.tiles.len(), 41 * 41);
    assert!(tiling
        .tiles
        .iter()
        .all(|t| t.area == 1.0 && t.rings[0].len() == 4));
    let count = |k| {
        (0..41 * 41)
            .filter(|&t| tiling.neighbours(t).len() == k)
            .count()
    };
    assert_eq!((count(2), count(3), count(4)), (4, 4 * 39, 39 * 39));
    assert!((0..41 * 41).all(|t| tiling.lines(t).len() == tiling.neighbours(t).len()));
}

/// Found by `order_does_not_matter`: the foot of an end that lay on another line
/// was rounded otherwise when that line ran the other way.
#[test]
fn the_sense_of_a_line_does_not_move_what_ends_on_it() {
    let p = |x: f64, y: f64| coord! { x: x, y: y };
    let long = LineString(vec![p(4., 5.), p(14., 13.)]);
    let short = LineString(vec![p(9., 9.), p(0., 0.)]);
    let back = |l: &LineString<f64>| LineString(l.0.iter().rev().copied().collect());
    let cut = |lines: &[LineString<f64>]| {
        tiles(&lattice_domain(), lines, &TileOptions::default()).unwrap()
    };
    let one = cut(&[long.clone(), short.clone(), short.clone()]);
    let two = cut(&[back(&long), back(&short), back(&short)]);
    assert_eq!(one, two);
    assert!(one.vertices.contains(&p(9., 9.)));
}
