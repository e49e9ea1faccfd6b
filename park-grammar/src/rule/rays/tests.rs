//! Laws of paths and cells in regions of any shape, with centres put by hand.

use super::*;
use crate::plane::{dist, nearest_on, sees, sides, signed_area};
use crate::rule::trial::{self, config, outline, Motion, Outline};
use crate::select::named;
use geo_types::coord;
use proptest::prelude::*;

fn region(outline: &Outline, motion: Motion) -> Region {
    // Not regular: arcs of just so many steps have one more by rounding.
    let angle = |k: i32| (f64::from(k) + 0.01 * f64::from(k * k)) * 1.02 + 0.3;
    trial::region(outline, [0, 1, 2, 3, 4, 5].map(angle), motion)
}

/// Corners that no region's own numbering has a say in.
fn corners(outline: &Outline, motion: Motion) -> Targets {
    let corners = outline.0.iter().step_by(3).map(|&p| motion.of(p));
    Targets::Places(corners.collect())
}

fn spots(region: &Region, at: &[(f64, f64)], motion: Motion) -> Vec<Spot> {
    trial::spots(region, at, motion, 0.1)
}

fn asked(spots: Vec<Spot>, targets: Targets, rays: Rays, join: Join, width: f64) -> Asked {
    Asked {
        shapes: vec![None; spots.len()],
        spots,
        targets: Some(targets),
        rays,
        join,
        hidden: false,
        narrow: 0.0,
        width,
        least: 0.0,
        output: false,
    }
}

fn modes() -> impl Strategy<Value = (Rays, Join)> {
    let rays = prop_oneof![
        Just(Rays::Nearest),
        Just(Rays::Unconnected),
        Just(Rays::All)
    ];
    let join = prop_oneof![
        Just(Join::None),
        Just(Join::Loop),
        Just(Join::Open),
        Just(Join::Pairs),
        Just(Join::Opposites),
        Just(Join::Delaunay),
        Just(Join::Tree),
    ];
    (rays, join)
}

fn places() -> impl Strategy<Value = Vec<(f64, f64)>> {
    proptest::collection::vec((-60.0..60.0_f64, -60.0..60.0_f64), 1..7)
}

fn total(partition: &Partition) -> f64 {
    let all = partition.outputs.iter().flat_map(|o| &o.regions);
    all.map(|r| r.area.size()).sum()
}

proptest! {
    #![proptest_config(config(48, 5_000))]

    /// Whatever is cast and joined, cells, paths and centres tile the region; cells
    /// keep half a width from each path, unless a fence is between, and each path
    /// runs inside; no ray crosses another path; each centre is connected to the
    /// boundary.
    #[test]
    fn paths_and_cells_tile(
        outline in outline(),
        at in places(),
        (rays, join) in modes(),
        width in prop_oneof![Just(0.0), 0.5..4.0_f64],
        shape in prop_oneof![Just(None), Just(Some(Primitive::Circle(3.0))), Just(Some(Primitive::Romb(5.0)))],
        seed in 0..1000_u64,
    ) {
        let region = region(&outline, Motion::NONE);
        let spots = spots(&region, &at, Motion::NONE);
        if spots.is_empty() {
            return Ok(());
        }
        let mut asked = asked(spots.clone(), corners(&outline, Motion::NONE), rays, join, width);
        asked.shapes = vec![shape; spots.len()];
        asked.output = shape.is_some();
        let paths = walks(&region, &asked, &mut Stream::new(seed), None).expect("time enough");
        for path in &paths {
            for pair in path.line.windows(2) {
                prop_assert!(sees(&region.area, pair[0], pair[1]));
            }
        }
        let is_ray = |path: &&Path| path.centres[1].is_none();
        let mut reached = joins::Groups::new(spots.len());
        for path in paths.iter().filter(|path| !is_ray(path)) {
            let [a, b] = path.centres.map(|c| c.expect("a join has two"));
            reached.join(a, b);
        }
        let radii: Vec<f64> = asked.shapes.iter().map(|s| s.map_or(0.0, Primitive::radius)).collect();
        for [a, b] in touching(&region, &asked, &radii) {
            reached.join(a, b);
        }
        for k in 0..spots.len() {
            let group = reached.of(k);
            let mut rays = paths.iter().filter(is_ray);
            prop_assert!(rays.any(|ray| reached.of(ray.centres[0].expect("a ray has one")) == group), "{k} of {paths:?}");
        }
        let Some(partition) = divide(&region, &asked, &mut Stream::new(seed)) else { return Ok(()) };
        prop_assert!((total(&partition) / region.area.size() - 1.0).abs() < 1e-9);
        for cell in &partition.outputs[0].regions {
            prop_assert!(signed_area(cell.ring(0)) < 0.0);
            for path in &paths {
                let straight = path.line.windows(2).map(|pair| [pair[0], pair[1]]);
                for (p, [a, b]) in straight.flat_map(|s| cell.ring(0).iter().map(move |&p| (p, s))) {
                    let on = nearest_on(a, b, p);
                    // Arcs of ten degrees.
                    let inside = dist(on, p) < 0.5 * width * 0.995 - 1e-4;
                    prop_assert!(!inside || !sees(&region.area, p, on), "{p:?} is {} from {path:?}", dist(on, p));
                }
            }
        }
    }

    /// Rays cross nothing, whichever are cast.
    #[test]
    fn rays_cross_nothing(
        outline in outline(),
        at in places(),
        (rays, join) in modes(),
        directions in prop_oneof![Just(0_usize), 1..9_usize],
        seed in 0..1000_u64,
    ) {
        let region = region(&outline, Motion::NONE);
        let spots = spots(&region, &at, Motion::NONE);
        if spots.is_empty() {
            return Ok(());
        }
        let targets = if directions == 0 {
            corners(&outline, Motion::NONE)
        } else {
            let angle = |k: usize| k as f64 / directions as f64 * std::f64::consts::TAU + 0.1;
            Targets::Directions((0..directions).map(|k| coord! { x: angle(k).cos(), y: angle(k).sin() }).collect())
        };
        let asked = asked(spots, targets, rays, join, 2.0);
        let paths = walks(&region, &asked, &mut Stream::new(seed), None).expect("time enough");
        let crosses = |[a, b]: [Coord<f64>; 2], [p, q]: [Coord<f64>; 2]| {
            let side = |a: Coord<f64>, b: Coord<f64>, x: Coord<f64>| crate::plane::cross(b - a, x - a) / dist(a, b);
            // Well across, both ways.
            side(a, b, p).min(side(a, b, q)) < -1e-3 && side(a, b, p).max(side(a, b, q)) > 1e-3
                && side(p, q, a).min(side(p, q, b)) < -1e-3 && side(p, q, a).max(side(p, q, b)) > 1e-3
        };
        for (k, ray) in paths.iter().enumerate().filter(|(_, path)| path.centres[1].is_none() && path.line.len() == 2) {
            for (j, path) in paths.iter().enumerate().filter(|(j, _)| *j != k) {
                for pair in path.line.windows(2) {
                    prop_assert!(!crosses([ray.line[0], ray.line[1]], [pair[0], pair[1]]), "{k} {j} {paths:?}");
                }
            }
        }
    }

    /// All moves, turns and mirrors with the region, centres and targets.
    #[test]
    fn paths_move_with_the_region(
        outline in outline(),
        at in places(),
        (rays, join) in modes(),
        angle in -3.2..3.2_f64,
        mirror in any::<bool>(),
        by in (-500.0..500.0_f64, -500.0..500.0_f64),
    ) {
        let motion = Motion { angle, mirror, by: coord! { x: by.0, y: by.1 } };
        let cells = |motion: Motion| {
            let region = region(&outline, motion);
            let spots = spots(&region, &at, motion);
            if spots.is_empty() {
                return None;
            }
            let asked = asked(spots, corners(&outline, motion), rays, join, 2.0);
            let paths = walks(&region, &asked, &mut Stream::new(3), None).expect("time enough");
            Some((paths, divide(&region, &asked, &mut Stream::new(3))))
        };
        let (Some((a, here)), Some((b, there))) = (cells(Motion::NONE), cells(motion)) else { return Ok(()) };
        prop_assert_eq!(a.len(), b.len());
        for path in &a {
            let image: Vec<_> = path.line.iter().map(|&p| motion.of(p)).collect();
            let same = |other: &Path| {
                other.centres == path.centres && other.line.len() == image.len()
                    && other.line.iter().zip(&image).all(|(p, q)| dist(*p, *q) < 1e-5)
            };
            prop_assert!(b.iter().any(same), "{path:?}");
        }
        let (Some(here), Some(there)) = (here, there) else { return Ok(()) };
        let solid = |r: &&Region| r.area.size() > 1e-3;
        let others: Vec<_> = there.outputs[0].regions.iter().filter(solid).collect();
        for cell in here.outputs[0].regions.iter().filter(solid) {
            let image = motion.of(cell.area.centroid());
            let found = others.iter().any(|other| {
                dist(other.area.centroid(), image) < 1e-4
                    && (other.area.size() - cell.area.size()).abs() < 1e-4 * cell.area.size().max(1.0)
            });
            prop_assert!(found, "{} at {image:?}", cell.area.size());
        }
    }
}

fn square() -> (Vec<Coord<f64>>, bool) {
    let ring = [(0., 0.), (0., 40.), (40., 40.), (40., 0.)];
    (ring.map(|(x, y)| coord! { x: x, y: y }).to_vec(), false)
}

fn middles() -> Targets {
    let all = [(0., 20.), (20., 40.), (40., 20.), (20., 0.)];
    Targets::Places(all.map(|(x, y)| coord! { x: x, y: y }).to_vec())
}

fn lines(region: &Region, side: i64) -> Vec<Vec<Coord<f64>>> {
    named::sides(region, &[side]).lines(region)
}

/// Four rays from the middle of a square to the middles of its sides, 2 m wide:
/// in each quarter side 1 leads clockwise from the centre, side -1 ends there,
/// and corner 0 is the one at the centre.
#[test]
fn sides_have_signs() {
    for mirrored in [false, true] {
        let mut region = region(&square(), Motion::NONE);
        region.local = region.local.flipped(mirrored, false);
        let centre = coord! { x: 20., y: 20. };
        let spots = spots(&region, &[(20., 20.)], Motion::NONE);
        let asked = asked(spots, middles(), Rays::Unconnected, Join::Loop, 2.0);
        let partition = divide(&region, &asked, &mut Stream::new(0)).expect("has cells");
        let cells = &partition.outputs[0].regions;
        assert_eq!(cells.len(), 4);
        for cell in cells {
            // The first two and the last two sides, and none of number 0.
            assert_eq!(cell.sides, 5);
            assert!(lines(cell, 0).is_empty());
            let corner = cell.corner(0).expect("has a corner");
            assert!((dist(corner, centre) - 2.0_f64.sqrt()).abs() < 1e-9);
            let (one, last) = (&lines(cell, 1)[0], &lines(cell, -1)[0]);
            assert!((dist(one[0], one[1]) - 19.0).abs() < 1e-9);
            // Lines are walked clockwise whatever is counted how.
            let (first, second) = if mirrored { (last, one) } else { (one, last) };
            assert_eq!(first[0], corner);
            assert_eq!(second[1], corner);
            // Coordinates lead from the centre to the corner of the square.
            let at = |x: f64, y: f64| cell.local.point(coord! { x: x, y: y }).expect("lies here");
            assert_eq!(at(0.0, 0.0), corner);
            let outer = at(1.0, 1.0);
            assert!(dist(outer, centre) > 28.2);
            assert_eq!(at(0.0, 1.0), if mirrored { one[0] } else { one[1] });
            assert_eq!(cell.local.mirrored(), mirrored);
        }
    }
}

/// With a centre of a size side 0 is along it.
#[test]
fn side_0_is_the_centre() {
    let region = region(&square(), Motion::NONE);
    let spots = spots(&region, &[(20., 20.)], Motion::NONE);
    let mut asked = asked(spots, middles(), Rays::All, Join::Loop, 2.0);
    asked.shapes = vec![Some(Primitive::Circle(5.0))];
    for output in [false, true] {
        asked.output = output;
        let partition = divide(&region, &asked, &mut Stream::new(0)).expect("has cells");
        assert_eq!(partition.outputs[2].regions.len(), usize::from(output));
        for cell in &partition.outputs[0].regions {
            assert_eq!(cell.sides, 5);
            let arc = &lines(cell, 0)[0];
            let from_centre = |p: &Coord<f64>| dist(*p, coord! { x: 20., y: 20. });
            assert!(arc.iter().all(|p| (from_centre(p) - 5.0).abs() < 0.02));
            // A quarter less what the paths take on both ends.
            let angle = std::f64::consts::FRAC_PI_2 - 2.0 * 0.2_f64.asin();
            let length: f64 = arc.windows(2).map(|w| dist(w[0], w[1])).sum();
            assert!((length - 5.0 * angle).abs() < 0.02, "{length}");
            let roles = sides(cell.ring(0)).zip(&cell.edges[0]);
            let centre =
                roles.filter(|(_, e)| e.origin.marks.iter().any(|m| m.role == Role::Centre));
            assert_eq!(centre.count(), arc.len() - 1);
        }
    }
}

/// Without paths four rays cut a square into four quarters.
#[test]
fn lines_without_width_cut() {
    let region = region(&square(), Motion::NONE);
    let spots = spots(&region, &[(20., 20.)], Motion::NONE);
    let asked = asked(spots, middles(), Rays::All, Join::Loop, 0.0);
    let partition = divide(&region, &asked, &mut Stream::new(0)).expect("has cells");
    assert!(partition.outputs[1].regions.is_empty());
    let sizes = partition.outputs[0].regions.iter().map(|r| r.area.size());
    assert!(sizes.map(|s| (s - 400.0).abs()).fold(0.0, f64::max) < 1e-6);
    assert!(partition.outputs[0].regions.iter().all(|r| r.sides == 5));
}

/// One ray alone: the cell goes round it, and both its sides are told apart.
#[test]
fn a_single_ray_has_two_sides() {
    let region = region(&square(), Motion::NONE);
    let spots = spots(&region, &[(20., 20.)], Motion::NONE);
    let target = Targets::Places(vec![coord! { x: 0., y: 20. }]);
    let asked = asked(spots, target, Rays::All, Join::Loop, 2.0);
    let partition = divide(&region, &asked, &mut Stream::new(0)).expect("has cells");
    let cell = &partition.outputs[0].regions[0];
    // Two sides of the ray, and the western side in two parts.
    assert_eq!(cell.sides, 1 + 2 + 5);
    let (one, last) = (&lines(cell, 1)[0], &lines(cell, -1)[0]);
    assert!(one.iter().all(|p| p.y >= 20.0 - 1e-9), "{one:?}");
    assert!(last.iter().all(|p| p.y <= 20.0 + 1e-9), "{last:?}");
}
