//! Laws of quad meshes: whatever polygon they are made of.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use geo_types::{coord, Coord, LineString, Polygon};
use network_opt::design::Tessellation;
use network_opt::quad::{quads, QuadOptions, QuadQuality};
use proptest::prelude::*;

fn config() -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    ProptestConfig::with_cases(if long { 1000 } else { 40 })
}

fn ring(radii: &[f64], centre: Coord<f64>, phase: f64) -> LineString<f64> {
    let count = radii.len() as f64;
    radii
        .iter()
        .enumerate()
        .map(|(k, r)| {
            let angle = phase + std::f64::consts::TAU * k as f64 / count;
            centre + coord! { x: r * angle.cos(), y: r * angle.sin() }
        })
        .collect::<Vec<_>>()
        .into()
}

/// A star of 4 to 40 corners, often ragged, with up to two holes, anywhere up
/// to the far corner of a map.
fn site() -> impl Strategy<Value = Polygon<f64>> {
    let outer = prop::collection::vec(120.0..260.0_f64, 4..40);
    let holes = prop::collection::vec(prop::collection::vec(6.0..36.0_f64, 3..9), 0..3);
    let shift = prop_oneof![
        Just(coord! { x: 0.0, y: 0.0 }),
        (1e5..9e5, 0.0..9e6).prop_map(|(x, y)| coord! { x: x, y: y }),
    ];
    (outer, holes, 0.0..6.3_f64, shift).prop_map(|(outer, holes, phase, shift)| {
        let centres = [coord! { x: -42., y: 3. }, coord! { x: 42., y: -5. }];
        let holes = holes.iter().zip(centres);
        Polygon::new(
            ring(&outer, shift, phase),
            holes
                .map(|(hole, centre)| ring(hole, shift + centre, 1.1 * phase))
                .collect(),
        )
    })
}

fn area(points: &[Coord<f64>]) -> f64 {
    let origin = points[0];
    let cross = |k: usize| {
        let (a, b) = (points[k] - origin, points[(k + 1) % points.len()] - origin);
        a.x * b.y - a.y * b.x
    };
    (0..points.len()).map(cross).sum::<f64>() / 2.0
}

fn corners(mesh: &Tessellation, face: &[usize]) -> Vec<Coord<f64>> {
    face.iter().map(|&v| mesh.points()[v]).collect()
}

fn to_boundary(p: Coord<f64>, polygon: &Polygon<f64>) -> f64 {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    rings
        .flat_map(|ring| ring.0.windows(2))
        .map(|s| {
            let (way, off) = (s[1] - s[0], p - s[0]);
            let t =
                ((off.x * way.x + off.y * way.y) / (way.x * way.x + way.y * way.y)).clamp(0.0, 1.0);
            let gap = off - way * t;
            gap.x.hypot(gap.y)
        })
        .fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(config())]

    /// All faces are convex quads that tile a region of the polygon's topology;
    /// vertices on its rim lie on the polygon's boundary, or, where that cannot
    /// be without a quad that is not convex, within an edge of it.
    #[test]
    fn quads_tile_the_site(site in site(), edge in 8.0..40.0_f64) {
        let options = QuadOptions { edge_length: edge, ..QuadOptions::default() };
        let mesh = quads(&site, &options).unwrap();
        let mut total = 0.0;
        for face in mesh.faces() {
            prop_assert_eq!(face.len(), 4);
            let own = corners(&mesh, face);
            total += area(&own);
            for k in 0..4 {
                let turn = area(&[own[k], own[(k + 1) % 4], own[(k + 2) % 4]]);
                prop_assert!(turn > 0.0, "{own:?}");
            }
        }
        // Vertices less edges plus faces: 1 less the number of holes.
        let euler = (mesh.points().len() + mesh.faces().len()) as i64 - mesh.edges().len() as i64;
        prop_assert_eq!(euler, 1 - site.interiors().len() as i64);
        // The rim's edges enclose what the faces cover.
        let mut on_rim = vec![0; mesh.points().len()];
        for (&[a, b], _) in mesh.edges().iter().zip(mesh.rim()).filter(|e| e.1) {
            on_rim[a] += 1;
            on_rim[b] += 1;
        }
        for (v, &count) in on_rim.iter().enumerate() {
            prop_assert!(count == 0 || count == 2, "vertex {v} has {count} edges on the rim");
            if count == 2 {
                prop_assert!(to_boundary(mesh.points()[v], &site) < edge, "vertex {v}");
            }
        }
        let whole = area(&site.exterior().0[1..]) - site.interiors().iter().map(|h| area(&h.0[1..])).sum::<f64>();
        // Chords two edges long cut off what bends more sharply: the largest
        // corners of a ragged star, a quad for each of its corners at most.
        let slack = edge * edge * 2.0 * (site.exterior().0.len() + 30) as f64;
        prop_assert!((total - whole).abs() < slack, "{total} of {whole}");
    }

    /// Where the site lies does not matter: to the bit, where coordinates are
    /// such that moving rounds nothing.
    #[test]
    fn quads_move_with_the_site(site in site(), x in -1e3..1e3_f64, y in -1e3..1e3_f64) {
        let round = |v: f64| (v * 1024.0).round() / 1024.0;
        let moved = |shift: Coord<f64>| {
            let line = |line: &LineString<f64>| {
                let whole = |p: &Coord<f64>| coord! { x: round(p.x), y: round(p.y) } + shift;
                LineString(line.0.iter().map(whole).collect())
            };
            Polygon::new(line(site.exterior()), site.interiors().iter().map(line).collect())
        };
        let shift = coord! { x: x.round(), y: y.round() };
        let options = QuadOptions { edge_length: 25.0, ..QuadOptions::default() };
        let here = quads(&moved(coord! { x: 0.0, y: 0.0 }), &options).unwrap();
        let there = quads(&moved(shift), &options).unwrap();
        prop_assert_eq!(here.faces(), there.faces());
        for (&a, &b) in here.points().iter().zip(there.points()) {
            let gap = a + shift - b;
            prop_assert!(gap.x.hypot(gap.y) < 1e-8);
        }
    }

    /// Rectangles, however they lie, are grids of equal rectangles.
    #[test]
    fn rectangles_are_grids(columns in 1..9_u32, rows in 1..9_u32, angle in 0.0..6.3_f64, stretch in 0.95..1.05_f64) {
        let (s, c) = angle.sin_cos();
        let at = |x: f64, y: f64| coord! { x: 5e5 + c * x - s * y, y: 5e6 + s * x + c * y };
        let (w, h) = (20.0 * stretch * f64::from(columns), 20.0 * f64::from(rows));
        let site = Polygon::new(LineString(vec![at(0., 0.), at(w, 0.), at(w, h), at(0., h)]), vec![]);
        let mesh = quads(&site, &QuadOptions { edge_length: 10.0, ..QuadOptions::default() }).unwrap();
        prop_assert_eq!(mesh.faces().len() as u32, 4 * columns * rows);
        let quality = QuadQuality::of(&mesh);
        prop_assert_eq!(quality.regular, 1.0);
        prop_assert!(quality.mean_deviation_deg < 1.0 && quality.worst_aspect < 1.12, "{}", quality);
    }
}

#[test]
fn bad_polygons_are_refused() {
    let refuse = |points: &[(f64, f64)]| {
        let ring: Vec<Coord<f64>> = points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect();
        quads(&Polygon::new(ring.into(), vec![]), &QuadOptions::default())
            .unwrap_err()
            .to_string()
    };
    assert!(refuse(&[]).contains("area"));
    assert!(refuse(&[(0., 0.), (1., 0.)]).contains("area"));
    assert!(refuse(&[(0., 0.), (1., f64::NAN), (0., 1.)]).contains("area"));
    // A bow tie with unequal halves.
    assert!(refuse(&[(0., 0.), (20., 10.), (20., 0.), (0., 9.)]).contains("cross"));
    let site = Polygon::new(vec![(0., 0.), (9., 0.), (9., 9.), (0., 9.)].into(), vec![]);
    for edge_length in [-1.0, f64::NAN, 1e-4] {
        assert!(quads(
            &site,
            &QuadOptions {
                edge_length,
                ..QuadOptions::default()
            }
        )
        .is_err());
    }
}

/// Directions that are given are followed: a square with a grid turned by 30
/// degrees inside.
#[test]
fn given_directions_are_followed() {
    let site = Polygon::new(
        vec![(0., 0.), (300., 0.), (300., 300.), (0., 300.)].into(),
        vec![],
    );
    let turned = |_: Coord<f64>| Some(0.5);
    let options = QuadOptions {
        edge_length: 10.0,
        directions: Some(&turned),
        rounds: 10,
        ..QuadOptions::default()
    };
    let mesh = quads(&site, &options).unwrap();
    let (mut along, mut all) = (0.0, 0.0);
    for (e, &[a, b]) in mesh.edges().iter().enumerate() {
        let (p, q) = (mesh.points()[a], mesh.points()[b]);
        let middle = (p + q) / 2.0;
        if middle.x.min(middle.y) < 60.0 || middle.x.max(middle.y) > 240.0 {
            continue;
        }
        let off = 4.0 * ((q.y - p.y).atan2(q.x - p.x) - 0.5);
        along += mesh.length(e) * off.cos();
        all += mesh.length(e);
    }
    assert!(along / all > 0.9, "{}", along / all);
}
