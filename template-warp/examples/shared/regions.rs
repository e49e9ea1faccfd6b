//! Regions as insets of blocks give them: vertices 5 to 30 m apart, three to
//! eight real corners, centred on the origin.

use template_warp::{geo_types::Coord, EdgeUse};

type P = Coord<f64>;
type Shape = (&'static str, Vec<P>, Vec<EdgeUse>);

fn p(x: f64, y: f64) -> P {
    Coord { x, y }
}

/// Corners joined by straight sides with a vertex about every `step` metres.
/// `street[i]` tells whether the side from corner i on is a street.
fn polygon(corners: &[P], street: &[bool], step: f64) -> (Vec<P>, Vec<EdgeUse>) {
    let (mut ring, mut uses) = (Vec::new(), Vec::new());
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let d = b - a;
        let k = (d.x.hypot(d.y) / step).round().max(1.0) as usize;
        for j in 0..k {
            ring.push(a + d * (j as f64 / k as f64));
            uses.push(if street[i % street.len()] {
                EdgeUse::Street
            } else {
                EdgeUse::NoStreet
            });
        }
    }
    centred(ring, uses)
}

fn centred(mut ring: Vec<P>, uses: Vec<EdgeUse>) -> (Vec<P>, Vec<EdgeUse>) {
    let lo = ring
        .iter()
        .fold(ring[0], |a, q| p(a.x.min(q.x), a.y.min(q.y)));
    let hi = ring
        .iter()
        .fold(ring[0], |a, q| p(a.x.max(q.x), a.y.max(q.y)));
    for q in &mut ring {
        *q = *q - (lo + hi) * 0.5;
    }
    (ring, uses)
}

/// A strip of width `d` about a centre curve given by its heading as a function
/// of the arc length share, `length` metres long.
fn strip(length: f64, d: f64, heading: impl Fn(f64) -> f64, ends: bool) -> (Vec<P>, Vec<EdgeUse>) {
    let n = (length / 12.0).round() as usize;
    let fine = 50;
    let (mut left, mut right) = (Vec::new(), Vec::new());
    let mut q = p(0.0, 0.0);
    for i in 0..=n {
        let a = heading(i as f64 / n as f64);
        let normal = p(-a.sin(), a.cos());
        left.push(q + normal * (0.5 * d));
        right.push(q - normal * (0.5 * d));
        for j in 0..fine {
            let a = heading((i as f64 + (j as f64 + 0.5) / fine as f64) / n as f64);
            q = q + p(a.cos(), a.sin()) * (length / (n * fine) as f64);
        }
    }
    left.reverse();
    let mut uses = vec![EdgeUse::Street; 2 * n + 2];
    if !ends {
        uses[n] = EdgeUse::NoStreet;
        uses[2 * n + 1] = EdgeUse::NoStreet;
    }
    right.extend(left);
    centred(right, uses)
}

/// The regions of the README's picture.
pub(crate) const FEW: [&str; 12] = [
    "rectangle 180 x 60",
    "one end slanted 35",
    "trapezoid 20/20",
    "parallelogram 25",
    "arc strip R 144",
    "S strip",
    "slim wedge",
    "L double skew",
    "L single",
    "pentagon 90",
    "rectangle 150 x 100",
    "cul-de-sac 75 x 150",
];

/// The gallery's regions.
pub(crate) fn all() -> Vec<Shape> {
    let tan = |deg: f64| deg.to_radians().tan();
    let mut shapes: Vec<Shape> = Vec::new();
    let mut add = |name, (ring, uses): (Vec<P>, Vec<EdgeUse>)| shapes.push((name, ring, uses));
    let quad = |a: f64, b: f64, w: f64, d: f64| {
        [p(0., 0.), p(w, 0.), p(w + d * tan(b), d), p(-d * tan(a), d)]
    };
    add(
        "rectangle 180 x 60",
        polygon(&quad(0., 0., 180., 60.), &[true], 15.0),
    );
    add(
        "rectangle 150 x 76",
        polygon(&quad(0., 0., 150., 76.), &[true], 15.0),
    );
    add(
        "one end slanted 35",
        polygon(&quad(0., 35., 170., 62.), &[true], 15.0),
    );
    add(
        "trapezoid 20/20",
        polygon(&quad(20., 20., 130., 60.), &[true], 15.0),
    );
    add(
        "trapezoid -25/15",
        polygon(&quad(-25., 15., 180., 58.), &[true], 15.0),
    );
    add(
        "parallelogram 25",
        polygon(&quad(-25., 25., 170., 60.), &[true], 15.0),
    );
    add(
        "tapered 50-70",
        polygon(
            &[p(0., 0.), p(190., 0.), p(190., 70.), p(0., 50.)],
            &[true],
            15.0,
        ),
    );
    add("arc strip R 144", strip(230.0, 60.0, |t| 1.6 * t, true));
    add("arc strip R 95", strip(190.0, 62.0, |t| 2.0 * t, true));
    add(
        "S strip",
        strip(
            300.0,
            60.0,
            |t| 0.55 * (2.0 * std::f64::consts::PI * t).sin(),
            true,
        ),
    );
    add(
        "single row",
        polygon(
            &quad(0., 10., 150., 30.),
            &[true, false, false, false],
            15.0,
        ),
    );
    add("single row curved", strip(170.0, 31.0, |t| 1.2 * t, false));
    add(
        "block with dead end side",
        polygon(&quad(5., -5., 140., 64.), &[true, false, true, true], 15.0),
    );
    add(
        "wedge",
        polygon(&[p(0., 0.), p(190., 0.), p(0., 85.)], &[true], 15.0),
    );
    add(
        "slim wedge",
        polygon(&[p(0., -32.), p(170., 0.), p(0., 32.)], &[true], 15.0),
    );
    add(
        "triangle 130",
        polygon(&[p(0., 0.), p(130., 0.), p(62., 115.)], &[true], 15.0),
    );
    add(
        "triangle with one street",
        polygon(
            &[p(0., 0.), p(130., 0.), p(10., 42.)],
            &[true, false, false],
            15.0,
        ),
    );
    add(
        "L double",
        polygon(
            &[
                p(0., 0.),
                p(190., 0.),
                p(190., 60.),
                p(62., 60.),
                p(62., 180.),
                p(0., 180.),
            ],
            &[true],
            15.0,
        ),
    );
    add(
        "L double skew",
        polygon(
            &[
                p(0., 0.),
                p(180., -15.),
                p(188., 47.),
                p(66., 58.),
                p(70., 170.),
                p(8., 174.),
            ],
            &[true],
            15.0,
        ),
    );
    add(
        "L single",
        polygon(
            &[
                p(0., 0.),
                p(150., 0.),
                p(150., 31.),
                p(32., 31.),
                p(32., 120.),
                p(0., 120.),
            ],
            &[true, true, false, false, true, true],
            15.0,
        ),
    );
    let gon = |n: usize, r: f64| -> Vec<P> {
        (0..n)
            .map(|i| {
                (i as f64 + 0.5) / n as f64 * 2.0 * std::f64::consts::PI
                    - std::f64::consts::FRAC_PI_2
            })
            .map(|a| p(r * a.cos(), r * a.sin()))
            .collect()
    };
    add("pentagon 90", polygon(&gon(5, 90.0), &[true], 15.0));
    add(
        "pentagon askew",
        polygon(
            &[
                p(-80., -70.),
                p(75., -80.),
                p(105., 20.),
                p(10., 95.),
                p(-95., 30.),
            ],
            &[true],
            15.0,
        ),
    );
    add("hexagon 95", polygon(&gon(6, 95.0), &[true], 15.0));
    add(
        "big quad 140 x 130",
        polygon(&quad(5., 8., 140., 130.), &[true], 15.0),
    );
    add(
        "rectangle 150 x 100",
        polygon(&quad(0., 3., 150., 100.), &[true], 15.0),
    );
    add(
        "cul-de-sac 78 x 90",
        polygon(&quad(0., 0., 78., 90.), &[true, false, false, false], 15.0),
    );
    add(
        "cul-de-sac 75 x 150",
        polygon(
            &quad(-2., 3., 75., 150.),
            &[true, false, false, false],
            15.0,
        ),
    );
    add(
        "five corners",
        polygon(
            &[
                p(0., 0.),
                p(100., -18.),
                p(190., 10.),
                p(190., 70.),
                p(0., 66.),
            ],
            &[true],
            15.0,
        ),
    );
    add(
        "deep row 45",
        polygon(&quad(3., 3., 120., 46.), &[true], 15.0),
    );
    add(
        "short block 60 x 60",
        polygon(&quad(3., -3., 62., 60.), &[true], 15.0),
    );
    add(
        "kite",
        polygon(
            &[p(0., 0.), p(100., -30.), p(150., 20.), p(40., 80.)],
            &[true],
            15.0,
        ),
    );
    shapes
}
