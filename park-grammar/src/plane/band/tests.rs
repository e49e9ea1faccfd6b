use super::*;
use geo_types::coord;

fn ring(points: &[(f64, f64)], moves: &[usize]) -> Vec<Bound> {
    let bound = |(k, &(x, y)): (usize, &(f64, f64))| Bound {
        at: coord! { x: x, y: y },
        moves: moves.contains(&k),
    };
    points.iter().enumerate().map(bound).collect()
}

/// However long it takes.
fn band(ring: Vec<Bound>, depth: f64, ends: Ends) -> Band {
    Band::new(&[ring], depth, ends, || Ok::<(), ()>(())).expect("nothing stops it")
}

/// Sizes of the band and of the rest.
fn sizes(ring: Vec<Bound>, depth: f64, ends: Ends) -> (f64, f64) {
    let band = band(ring, depth, ends);
    let sum = |areas: Vec<Area>| areas.iter().map(Area::size).sum::<f64>();
    (
        sum(intersection(from_ref(&band.land), &band.cover)),
        sum(difference(from_ref(&band.land), &band.cover)),
    )
}

fn near(found: (f64, f64), wanted: (f64, f64)) {
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * (1.0 + b);
    assert!(
        close(found.0, wanted.0) && close(found.1, wanted.1),
        "{found:?} {wanted:?}"
    );
}

/// The northern side of a trapezoid 10 wide there, 20 below, 5 high: obtuse
/// corners of 135 degrees.
#[test]
fn ends_follow_or_are_square() {
    let trapezoid = [(0., 0.), (5., 5.), (15., 5.), (20., 0.)];
    let north = || ring(&trapezoid, &[1]);
    // 10 above and 14 below, 2 high.
    near(sizes(north(), 2.0, Ends::Follow), (24.0, 51.0));
    near(sizes(north(), 2.0, Ends::Square), (20.0, 55.0));
    // The southern one has acute corners, and is cut in both ways.
    let south = || ring(&trapezoid, &[3]);
    near(sizes(south(), 2.0, Ends::Follow), (36.0, 39.0));
    near(sizes(south(), 2.0, Ends::Square), (36.0, 39.0));
    near(sizes(north(), 5.0, Ends::Follow), (75.0, 0.0));
}

/// So is one within an edge, whichever way rounding bends that.
#[test]
fn ends_within_an_edge_are_square() {
    for off in [-1e-15, 0.0, 1e-15] {
        let bent = [(0., 0.), (0., 10.), (5., 10. + off), (10., 10.), (10., 0.)];
        near(sizes(ring(&bent, &[1]), 2.0, Ends::Follow), (10.0, 90.0));
    }
}

/// An end whose neighbour leads far away is square.
#[test]
fn flat_corners_are_not_followed() {
    let flat = [(0., 0.), (10., 2.), (20., 2.), (20., -10.), (0., -10.)];
    // Along the west of the roof 2 in 10: more than four depths for each.
    near(sizes(ring(&flat, &[1]), 1.0, Ends::Follow), (10.0, 220.0));
}

/// Chains of several edges are followed: a chamfered corner.
#[test]
fn ends_follow_chains() {
    let chamfered = [(0., 0.), (0., 9.), (1., 10.), (10., 10.), (10., 0.)];
    near(
        sizes(ring(&chamfered, &[2]), 3.0, Ends::Follow),
        (29.5, 70.0),
    );
    near(
        sizes(ring(&chamfered, &[2]), 3.0, Ends::Square),
        (27.0, 72.5),
    );
}

/// A corner of three quarters of a turn: mitred between two movers, square at
/// an end.
#[test]
fn corners_that_turn_inwards() {
    let l = [(0., 0.), (0., 9.), (4., 9.), (4., 4.), (9., 4.), (9., 0.)];
    near(sizes(ring(&l, &[2, 3]), 1.0, Ends::Follow), (11.0, 45.0));
    near(sizes(ring(&l, &[3]), 1.0, Ends::Follow), (5.0, 51.0));
    // All round, 1 deep: 7 x 2 and 2 x 5 less their corner are left.
    near(
        sizes(ring(&l, &[0, 1, 2, 3, 4, 5]), 1.0, Ends::Follow),
        (32.0, 24.0),
    );
}

/// A U whose arms are 2 wide and 2 apart: the outer western side moved in by 5
/// passes over the western arm, and not over the eastern one; at the bottom it
/// goes on.
#[test]
fn bays_are_in_the_way() {
    let u = [
        (0., 0.),
        (0., 10.),
        (2., 10.),
        (2., 2.),
        (4., 2.),
        (4., 10.),
        (6., 10.),
        (6., 0.),
    ];
    near(sizes(ring(&u, &[0]), 5.0, Ends::Follow), (26.0, 18.0));
    // Only its bottom.
    near(sizes(ring(&u, &[0]), 1.0, Ends::Follow), (10.0, 34.0));
}

#[test]
fn turned_rectangles_leave_no_hairs() {
    for k in 0..50 {
        let (sin, cos) = (0.1 + 0.12 * f64::from(k)).sin_cos();
        let turned: Vec<(f64, f64)> = [(0., 0.), (0., 10.), (20., 10.), (20., 0.)]
            .iter()
            .map(|&(x, y)| (x * cos - y * sin, x * sin + y * cos))
            .collect();
        for moves in [&[1][..], &[0, 1], &[0, 1, 2]] {
            let band = band(ring(&turned, moves), 3.0, Ends::Follow);
            let rest = difference(from_ref(&band.land), &band.cover);
            assert_eq!(rest.len(), 1);
            assert_eq!(rest[0].outer.len(), 4, "{moves:?}: {:?}", rest[0].outer);
        }
    }
}
