//! Laws of the cells of regions of any shape, with places put by hand.

use super::*;
use crate::plane::{cross, dist, dot, sides};
use crate::rule::trial::{self, config, outline, Motion, Outline};
use geo_types::{coord, Coord};
use proptest::prelude::*;

/// Where the corners of a hole are.
fn angles(start: f64) -> [f64; 6] {
    [0, 1, 2, 3, 4, 5].map(|k| f64::from(k) / 6.0 * std::f64::consts::TAU + start)
}

fn region(outline: &Outline, motion: Motion) -> Region {
    trial::region(outline, angles(0.3), motion)
}

fn asked(spots: Vec<Spot>, width: f64, amplitude: f64, region: &Region) -> Asked {
    Asked {
        spots,
        weighted: false,
        wave: Wave {
            amplitude,
            length: 6.0,
        },
        plan: Plan {
            half: 0.5 * width,
            around: 0.0,
            least: 0.0,
            smoother: None,
            size: sites::size(region),
        },
        content: Content::Nothing,
    }
}

fn spots(region: &Region, at: &[(f64, f64)], motion: Motion) -> Vec<Spot> {
    trial::spots(region, at, motion, 1e-3)
}

fn sizes(partition: &Partition, output: usize) -> Vec<f64> {
    let regions = &partition.outputs[output].regions;
    regions.iter().map(|r| r.area.size()).collect()
}

fn is_exact(region: &Region, partition: &Partition) -> Result<(), TestCaseError> {
    let all: f64 = (0..3).flat_map(|k| sizes(partition, k)).sum();
    prop_assert!((all / region.area.size() - 1.0).abs() < 1e-9);
    Ok(())
}

fn places() -> impl Strategy<Value = Vec<(f64, f64)>> {
    proptest::collection::vec((-70.0..70.0_f64, -70.0..70.0_f64), 1..30)
}

proptest! {
    #![proptest_config(config(64, 10_000))]

    /// Without paths each place has one cell, in one piece, that holds it, and all
    /// of them are the region; displaced or not.
    #[test]
    fn each_place_has_one_cell(
        outline in outline(),
        at in places(),
        amplitude in prop_oneof![Just(0.0), 0.5..20.0_f64],
        seed in 0..1000_u64,
    ) {
        let region = region(&outline, Motion::NONE);
        let spots = spots(&region, &at, Motion::NONE);
        if spots.is_empty() {
            return Ok(());
        }
        let asked = asked(spots.clone(), 0.0, amplitude, &region);
        let partition = divide(&region, &asked, &mut Stream::new(seed)).expect("has cells");
        is_exact(&region, &partition)?;
        prop_assert!(partition.outputs[1].regions.is_empty());
        let cells = &partition.outputs[0].regions;
        prop_assert_eq!(cells.len(), spots.len());
        for (cell, spot) in cells.iter().zip(&spots) {
            prop_assert!(cell.area.contains(spot.at));
        }
    }

    /// Paths lie along borders: what is farther from all borders than half their
    /// width is region, and what is nearer is path. In a convex region the border
    /// of two places is their bisector.
    #[test]
    fn paths_have_their_width(
        corners in proptest::collection::vec(0.0..std::f64::consts::TAU, 3..12),
        at in places(),
        width in 0.5..6.0_f64,
        probes in proptest::collection::vec((-80.0..80.0_f64, -80.0..80.0_f64), 60),
    ) {
        let mut angles = corners;
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|a, b| (*a - *b).abs() < 0.1);
        if angles.len() < 3 {
            return Ok(());
        }
        let ring: Vec<Coord<f64>> = angles.iter().map(|a| coord! { x: 80.0 * a.cos(), y: 80.0 * a.sin() }).collect();
        let region = region(&(ring, false), Motion::NONE);
        let spots = spots(&region, &at, Motion::NONE);
        if spots.is_empty() {
            return Ok(());
        }
        let asked = asked(spots.clone(), width, 0.0, &region);
        let Some(partition) = divide(&region, &asked, &mut Stream::new(0)) else { return Ok(()) };
        is_exact(&region, &partition)?;
        for (x, y) in probes {
            let p = coord! { x: x, y: y };
            if !region.area.contains(p) {
                continue;
            }
            let nearest = spots.iter().min_by(|a, b| dist(a.at, p).total_cmp(&dist(b.at, p))).expect("some");
            let off = |other: &Spot| {
                let (d, e) = (dist(nearest.at, p), dist(other.at, p));
                (e * e - d * d) / (2.0 * dist(nearest.at, other.at))
            };
            let others = spots.iter().filter(|s| s.at != nearest.at);
            let away = others.map(off).fold(f64::INFINITY, f64::min);
            let on = |k: usize| partition.outputs[k].regions.iter().any(|r| r.area.contains(p));
            if away > 0.5 * width + 1e-4 {
                prop_assert!(on(0) && !on(1), "{away} of {width} at {p:?}");
            } else if away < 0.5 * width - 1e-4 {
                // Of a border that ends at the outline the strip goes on along it.
                prop_assert!(on(1) && !on(0), "{away} of {width} at {p:?}");
            }
        }
    }

    /// Cells move, turn and mirror with their region and places, displacements with
    /// them.
    #[test]
    fn cells_move_with_the_region(
        outline in outline(),
        at in places(),
        amplitude in prop_oneof![Just(0.0), 0.5..5.0_f64],
        width in prop_oneof![Just(0.0), 1.0..4.0_f64],
        angle in -3.2..3.2_f64,
        mirror in any::<bool>(),
        by in (-500.0..500.0_f64, -500.0..500.0_f64),
    ) {
        let motion = Motion { angle, mirror, by: coord! { x: by.0, y: by.1 } };
        let (here, there) = (region(&outline, Motion::NONE), region(&outline, motion));
        let divided = |region: &Region, motion: Motion| {
            let spots = spots(region, &at, motion);
            let asked = asked(spots, width, amplitude, region);
            (!asked.spots.is_empty()).then(|| divide(region, &asked, &mut Stream::new(9))).flatten()
        };
        let (Some(a), Some(b)) = (divided(&here, Motion::NONE), divided(&there, motion)) else { return Ok(()) };
        for k in 0..2 {
            let (a, b) = (&a.outputs[k].regions, &b.outputs[k].regions);
            // Slivers come and go by rounding.
            let solid = |r: &&Region| r.area.size() > 1e-3;
            let (a, b): (Vec<_>, Vec<_>) = (a.iter().filter(solid).collect(), b.iter().filter(solid).collect());
            prop_assert_eq!(a.len(), b.len());
            for one in a {
                let image = motion.of(one.area.centroid());
                let found = b.iter().any(|other| {
                    dist(other.area.centroid(), image) < 1e-4
                        && (other.area.size() - one.area.size()).abs() < 1e-4 * one.area.size().max(1.0)
                });
                prop_assert!(found, "{} at {image:?}", one.area.size());
            }
        }
    }

    /// With the squares of radii as weights circles that do not touch lie in
    /// their own cells.
    #[test]
    fn circles_lie_in_their_own_cells(
        all in proptest::collection::vec((-60.0..60.0_f64, -60.0..60.0_f64, 0.5..25.0_f64), 2..25),
    ) {
        let square = [(-90.0, -90.0), (-90.0, 90.0), (90.0, 90.0), (90.0, -90.0)];
        let ring = square.map(|(x, y)| coord! { x: x, y: y }).to_vec();
        let region = region(&(ring, false), Motion::NONE);
        let mut spots: Vec<Spot> = Vec::new();
        for (x, y, radius) in all {
            let at = coord! { x: x, y: y };
            if spots.iter().all(|s| dist(s.at, at) > s.radius + radius) {
                spots.push(Spot::new(at, radius));
            }
        }
        let mut asked = asked(spots.clone(), 0.0, 0.0, &region);
        asked.weighted = true;
        let partition = divide(&region, &asked, &mut Stream::new(0)).expect("has cells");
        is_exact(&region, &partition)?;
        for (cell, spot) in partition.outputs[0].regions.iter().zip(&spots) {
            prop_assert!(cell.area.contains(spot.at));
            prop_assert!(cell.area.nearest(spot.at).1 > spot.radius - 1e-3);
        }
    }

    /// Displaced borders stay within their amplitude.
    #[test]
    fn displacements_keep_their_amplitude(
        at in places(),
        amplitude in 0.5..30.0_f64,
        seed in 0..1000_u64,
        probes in proptest::collection::vec((-80.0..80.0_f64, -80.0..80.0_f64), 40),
    ) {
        let square = [(-90.0, -90.0), (-90.0, 90.0), (90.0, 90.0), (90.0, -90.0)];
        let ring = square.map(|(x, y)| coord! { x: x, y: y }).to_vec();
        let region = region(&(ring, false), Motion::NONE);
        let spots = spots(&region, &at, Motion::NONE);
        let asked = asked(spots.clone(), 0.0, amplitude, &region);
        let partition = divide(&region, &asked, &mut Stream::new(seed)).expect("has cells");
        is_exact(&region, &partition)?;
        for (x, y) in probes {
            let p = coord! { x: x, y: y };
            let nearest = (0..spots.len()).min_by(|&a, &b| dist(spots[a].at, p).total_cmp(&dist(spots[b].at, p))).expect("some");
            let off = |k: usize| {
                let (d, e) = (dist(spots[nearest].at, p), dist(spots[k].at, p));
                (e * e - d * d) / (2.0 * dist(spots[nearest].at, spots[k].at))
            };
            let away = (0..spots.len()).filter(|&k| k != nearest).map(off).fold(f64::INFINITY, f64::min);
            if away > amplitude + 1e-4 {
                prop_assert!(partition.outputs[0].regions[nearest].area.contains(p));
            }
        }
    }
}

/// A square of 40 with places in four quarters: sides are counted from the longest
/// on the boundary, clockwise, and local coordinates begin there.
#[test]
fn sides_are_counted_from_the_boundary() {
    let ring = [(0., 0.), (0., 40.), (60., 40.), (60., 0.)];
    let ring = ring.map(|(x, y)| coord! { x: x, y: y }).to_vec();
    let region = region(&(ring, false), Motion::NONE);
    let at = [(15., 10.), (15., 30.), (45., 30.), (45., 10.)];
    let spots = spots(&region, &at, Motion::NONE);
    let partition = divide(
        &region,
        &asked(spots, 2.0, 0.0, &region),
        &mut Stream::new(0),
    );
    let cells = &partition.as_ref().expect("has cells").outputs[0].regions;
    assert_eq!(cells.len(), 4);
    // Cells of 29 x 19; the longer side on the boundary is north or south.
    for cell in cells {
        assert!((cell.area.size() - 29.0 * 19.0).abs() < 1e-6);
        assert_eq!(cell.sides, 4);
        let zero = cell
            .logical()
            .into_iter()
            .find(|s| s.index == 0)
            .expect("has side 0");
        assert!((dist(zero.line[0], zero.line[1]) - 29.0).abs() < 1e-6);
        let origin = cell
            .local
            .point(coord! { x: 0.0, y: 0.0 })
            .expect("lies here");
        assert!(dist(origin, zero.line[0]) < 1e-6);
        let marks: Vec<Role> = sides(cell.ring(0))
            .zip(&cell.edges[0])
            .flat_map(|(_, edge)| edge.origin.marks.iter().map(|m| m.role))
            .collect();
        assert_eq!(marks, [Role::Path, Role::Path]);
    }
    let paths = &partition.expect("has paths").outputs[1].regions;
    assert_eq!(paths.len(), 1);
    assert!((paths[0].area.size() - (2.0 * 58.0 + 2.0 * 40.0)).abs() < 1e-6);
}

/// Places at one point, on the boundary, in a row, on a grid.
#[test]
fn hard_places() {
    let ring = [(0., 0.), (0., 40.), (40., 40.), (40., 0.)];
    let ring = ring.map(|(x, y)| coord! { x: x, y: y }).to_vec();
    let region = region(&(ring, false), Motion::NONE);
    let cases: [Vec<(f64, f64)>; 4] = [
        vec![(20., 20.)],
        (1..9).map(|k| (4.0 * f64::from(k), 20.)).collect(),
        (0..25)
            .map(|k| (4.0 + 8.0 * f64::from(k % 5), 4.0 + 8.0 * f64::from(k / 5)))
            .collect(),
        vec![(0., 0.), (0., 40.), (40., 20.), (20., 20.)],
    ];
    for at in cases {
        let spots: Vec<Spot> = at
            .iter()
            .map(|&(x, y)| Spot::new(coord! { x: x, y: y }, 0.0))
            .collect();
        for width in [0.0, 1.0] {
            for amplitude in [0.0, 3.0] {
                let asked = asked(spots.clone(), width, amplitude, &region);
                let partition = divide(&region, &asked, &mut Stream::new(4)).expect("has cells");
                let all: f64 = (0..3).flat_map(|k| sizes(&partition, k)).sum();
                assert!((all - 1600.0).abs() < 1e-6);
                assert_eq!(partition.outputs[0].regions.len(), at.len());
            }
        }
    }
}

/// Thousands of places.
#[test]
fn many_places() {
    let ring = [(0., 0.), (0., 900.), (900., 900.), (900., 0.)];
    let ring = ring.map(|(x, y)| coord! { x: x, y: y }).to_vec();
    let region = region(&(ring, false), Motion::NONE);
    let mut chance = Stream::new(2);
    let spots: Vec<Spot> = (0..2000)
        .map(|_| {
            Spot::new(
                coord! { x: 900.0 * chance.unit(), y: 900.0 * chance.unit() },
                0.0,
            )
        })
        .collect();
    let partition = divide(&region, &asked(spots, 1.0, 0.0, &region), &mut chance);
    let partition = partition.expect("has cells");
    let all: f64 = (0..3).flat_map(|k| sizes(&partition, k)).sum();
    assert!((all / 810_000.0 - 1.0).abs() < 1e-9);
    assert!(partition.outputs[1].regions.len() < 20);
}

/// A convex quad is walked clockwise: the land lies on the right.
#[test]
fn frames_are_clockwise() {
    let ring = [(0., 0.), (3., 40.), (42., 31.), (40., -6.)];
    let ring = ring.map(|(x, y)| coord! { x: x, y: y }).to_vec();
    let region = region(&(ring, false), Motion::NONE);
    let frame = frame(&region);
    assert!(sides(&frame)
        .zip(sides(&frame).skip(1))
        .all(|((a, b), (c, d))| cross(b - a, d - c) < 0.0));
    assert!(region
        .area
        .outer
        .iter()
        .all(|&p| sides(&frame).all(|(a, b)| cross(b - a, p - a) < 0.0)));
    assert!(dot(frame[1] - frame[0], frame[2] - frame[1]).abs() < 1e-6);
}
