//! Laws of the whole warp: exact tiling, fixed points, equivariance,
//! independence of the start vertex, frontage.

#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on should stop where it stands"
)]

use proptest::prelude::*;
use std::collections::BTreeMap;
use template_warp::geo_types::{coord, Coord};
use template_warp::{
    match_templates, warp, EdgeUse, Library, MatchOptions, Region, WarpError, WarpOptions, Warped,
};

type P = Coord<f64>;

fn cases(n: u32) -> ProptestConfig {
    ProptestConfig::with_cases(if std::env::var_os("URBAN_LAYOUT_LONG").is_some() {
        40 * n
    } else {
        n
    })
}

fn area(ring: &[P]) -> f64 {
    let o = ring[0];
    (0..ring.len())
        .map(|i| {
            let (a, b) = (ring[i] - o, ring[(i + 1) % ring.len()] - o);
            0.5 * (a.x * b.y - a.y * b.x)
        })
        .sum()
}

/// A quadrilateral block with slanted, bent and unevenly sampled sides, every
/// side a street.
fn block() -> impl Strategy<Value = Vec<P>> {
    (
        60.0..240.0f64,
        48.0..74.0f64,
        prop::array::uniform4(-0.6..0.6f64),
        -12.0..12.0f64,
        6.0..24.0f64,
        0.0..6.3f64,
    )
        .prop_map(|(length, depth, slant, bend, step, angle)| {
            let c = [
                coord! { x: 0.3 * depth * slant[0], y: 0.0 },
                coord! { x: length + 0.5 * depth * slant[1], y: 0.1 * depth * slant[2] },
                coord! { x: length + 0.3 * depth * slant[2], y: depth },
                coord! { x: 0.5 * depth * slant[3], y: depth * (1.0 + 0.1 * slant[0]) },
            ];
            let mut ring = Vec::new();
            for i in 0..4 {
                let (a, b) = (c[i], c[(i + 1) % 4]);
                let d = b - a;
                let k = (d.x.hypot(d.y) / step).round().max(1.0) as usize;
                let amount = if i % 2 == 0 {
                    bend * (length / 150.0).min(1.0)
                } else {
                    0.0
                };
                for j in 0..k {
                    let t = j as f64 / k as f64;
                    let q = a + d * t + coord! { x: 0.0, y: 4.0 * amount * t * (1.0 - t) };
                    let (s, c) = angle.sin_cos();
                    ring.push(coord! { x: c * q.x - s * q.y, y: s * q.x + c * q.y });
                }
            }
            ring
        })
}

fn region(ring: &[P]) -> Region {
    Region::new(ring.to_vec(), vec![EdgeUse::Street; ring.len()], "block").unwrap()
}

fn first(library: &Library, region: &Region) -> Option<Warped> {
    let candidate = match_templates(library, region, &MatchOptions::default())
        .into_iter()
        .next()?;
    warp(library, region, &candidate, &WarpOptions::default()).ok()
}

/// Checks the tiling without the crate's own bookkeeping: areas, and every edge
/// matched by its reverse or part of the region's boundary.
fn check_tiling(ring: &[P], warped: &Warped) -> Result<(), TestCaseError> {
    let total: f64 = warped.faces.iter().map(|f| area(&f.ring)).sum();
    prop_assert!(
        (total - area(ring)).abs() < 1e-9 * area(ring),
        "{total} {}",
        area(ring)
    );
    let key = |q: P| (q.x.to_bits(), q.y.to_bits());
    let mut edges: BTreeMap<_, i32> = BTreeMap::new();
    let mut vertices = std::collections::BTreeSet::new();
    for face in &warped.faces {
        prop_assert!(area(&face.ring) > 0.0);
        for (i, &a) in face.ring.iter().enumerate() {
            let b = face.ring[(i + 1) % face.ring.len()];
            *edges.entry((key(a), key(b))).or_default() += 1;
            vertices.insert(key(a));
        }
    }
    prop_assert!(edges.values().all(|&n| n == 1));
    for &q in ring {
        prop_assert!(
            vertices.contains(&key(q)),
            "region vertex {q:?} is no vertex of a face"
        );
    }
    // Unmatched edges form the boundary: their lengths add up to the perimeter
    // and each lies on it.
    let value = |k: (u64, u64)| coord! { x: f64::from_bits(k.0), y: f64::from_bits(k.1) };
    let perimeter: f64 = (0..ring.len())
        .map(|i| ring[(i + 1) % ring.len()] - ring[i])
        .map(|d| d.x.hypot(d.y))
        .sum();
    let mut open = 0.0;
    for (a, b) in edges.keys() {
        if !edges.contains_key(&(*b, *a)) {
            let d = value(*b) - value(*a);
            open += d.x.hypot(d.y);
        }
    }
    prop_assert!(
        (open - perimeter).abs() < 1e-9 * perimeter,
        "{open} {perimeter}"
    );
    Ok(())
}

/// Faces as centroids and areas in an order that does not depend on theirs.
fn fingerprint(warped: &Warped, undo: impl Fn(P) -> P) -> Vec<(f64, f64, f64)> {
    let mut v: Vec<(f64, f64, f64)> = warped
        .faces
        .iter()
        .map(|f| {
            // Area centroid: not moved by extra vertices on straight edges.
            let o = f.ring[0];
            let mut c = coord! { x: 0.0, y: 0.0 };
            for i in 0..f.ring.len() {
                let (a, b) = (f.ring[i] - o, f.ring[(i + 1) % f.ring.len()] - o);
                c = c + (a + b) * ((a.x * b.y - a.y * b.x) / 6.0);
            }
            let q = undo(o + c / area(&f.ring));
            (q.x, q.y, area(&f.ring))
        })
        .collect();
    v.sort_by(|a, b| (a.0 + 0.317 * a.1).total_cmp(&(b.0 + 0.317 * b.1)));
    v
}

fn same(a: &[(f64, f64, f64)], b: &[(f64, f64, f64)], tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(a.len(), b.len());
    for (p, q) in a.iter().zip(b) {
        prop_assert!(
            (p.0 - q.0).abs() < tolerance
                && (p.1 - q.1).abs() < tolerance
                && (p.2 - q.2).abs() < 60.0 * tolerance,
            "{p:?} {q:?}"
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(40))]

    /// Whatever is returned tiles the region exactly, whichever template it is.
    #[test]
    fn results_tile_exactly(ring in block()) {
        let library = Library::standard();
        let region = region(&ring);
        for candidate in match_templates(&library, &region, &MatchOptions::default()) {
            match warp(&library, &region, &candidate, &WarpOptions::default()) {
                Ok(warped) => {
                    check_tiling(region.ring(), &warped)?;
                    prop_assert!(warped.energy.is_finite() && warped.energy >= 0.0);
                    for face in warped.faces.iter().filter(|f| f.label == "parcel" && !f.access_exempt) {
                        prop_assert!(face.frontage >= 3.0);
                    }
                }
                Err(e) => prop_assert!(
                    matches!(e, WarpError::FoldedFace { .. } | WarpError::NotTiled { .. } | WarpError::NoFrontage { .. } | WarpError::WrongSize { .. }),
                    "{e}"
                ),
            }
        }
    }

    /// An ordinary block is never refused by the double row.
    #[test]
    fn double_rows_fit_ordinary_blocks(ring in block()) {
        let library = Library::standard().subset(&["double-row"]).unwrap();
        let region = region(&ring);
        let mut refusals = Vec::new();
        for candidate in match_templates(&library, &region, &MatchOptions::default()) {
            match warp(&library, &region, &candidate, &WarpOptions::default()) {
                Ok(_) => return Ok(()),
                Err(e) => refusals.push(e.to_string()),
            }
        }
        prop_assert!(false, "refused: {refusals:?}");
    }

    #[test]
    fn the_start_vertex_does_not_matter(ring in block(), shift in 0usize..1000) {
        let library = Library::standard().subset(&["double-row"]).unwrap();
        let mut turned = ring.clone();
        turned.rotate_left(shift % ring.len());
        if let (Some(a), Some(b)) = (first(&library, &region(&ring)), first(&library, &region(&turned))) {
            same(&fingerprint(&a, |q| q), &fingerprint(&b, |q| q), 1e-6)?;
        }
    }

    /// Moved and turned regions give moved and turned results. Without
    /// acceleration, whose steps are taken or not by a comparison that rounding
    /// can tip (then the results differ by centimetres), and with a fixed number
    /// of steps, only rounding is left: coordinates of 5e6 m hold 1e-9 m.
    #[test]
    fn the_warp_is_equivariant(ring in block(), angle in -3.0..3.0f64, east in -1.0..1.0f64) {
        let library = Library::standard().subset(&["double-row"]).unwrap();
        let options = WarpOptions { anderson_depth: 0, tolerance: 0.0, ..WarpOptions::default() };
        let run = |ring: &[P]| {
            let region = region(ring);
            let candidate = match_templates(&library, &region, &MatchOptions::default()).into_iter().next()?;
            warp(&library, &region, &candidate, &options).ok()
        };
        let (s, c) = angle.sin_cos();
        let offset = coord! { x: 5e5 * east, y: 5e6 };
        let moved: Vec<P> = ring.iter().map(|q| coord! { x: c * q.x - s * q.y, y: s * q.x + c * q.y } + offset).collect();
        let undo = |q: P| { let r = q - offset; coord! { x: c * r.x + s * r.y, y: -s * r.x + c * r.y } };
        if let (Some(a), Some(b)) = (run(&ring), run(&moved)) {
            same(&fingerprint(&a, |q| q), &fingerprint(&b, undo), 1e-4)?;
        }
    }
}

/// The outline of a template moved rigidly is warped to itself with zero energy,
/// children included where their rows hold whole parcels.
#[test]
fn templates_fit_their_own_outline() {
    let library = Library::standard();
    let (s, c) = 0.9f64.sin_cos();
    for (k, template) in library.templates().iter().enumerate() {
        let ring: Vec<P> = template
            .outline()
            .iter()
            .map(|q| coord! { x: c * q.x - s * q.y + 300.0, y: s * q.x + c * q.y - 80.0 })
            .collect();
        // Corners as drawn: every template names its own.
        let n = ring.len();
        let is_corner = |i: usize| {
            let (a, b, d) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
            let (u, v) = (b - a, d - b);
            (u.x * v.y - u.y * v.x).atan2(u.x * v.x + u.y * v.y).abs() > 0.5
        };
        let corners: Vec<usize> = (0..n).filter(|&i| is_corner(i)).collect();
        assert_eq!(
            corners.len(),
            template.corner_count(),
            "{}",
            template.name()
        );
        let region = Region::new(ring.clone(), vec![EdgeUse::Street; n], template.label()).unwrap();
        let candidate = template_warp::Candidate {
            template: k,
            name: template.name().to_owned(),
            distortion: 0.0,
            corners,
            mirrored: false,
            probability: 1.0,
        };
        let warped = warp(&library, &region, &candidate, &WarpOptions::default())
            .unwrap_or_else(|e| panic!("{e}"));
        check_tiling(region.ring(), &warped).unwrap();
        // Rectangular rows fit exactly; rows with slanted ends cannot.
        let exact = [
            "row",
            "double-row",
            "single-row",
            "double-row-capped",
            "double-row-half-capped",
            "l-double",
            "l-single",
            "court-park",
            "cul-de-sac",
        ];
        if exact.contains(&template.name()) {
            assert!(
                warped.energy < 1e-10,
                "{}: {:e}",
                template.name(),
                warped.energy
            );
        } else {
            assert!(
                warped.energy < 0.03,
                "{}: {:e}",
                template.name(),
                warped.energy
            );
        }
        for line in &warped.centrelines {
            let q = line.0[0];
            let on = (0..n).any(|i| {
                let (a, d) = (ring[i], ring[(i + 1) % n] - ring[i]);
                let r = q - a;
                let t = (r.x * d.x + r.y * d.y) / (d.x * d.x + d.y * d.y);
                (0.0..=1.0).contains(&t) && (r.x * d.y - r.y * d.x).abs() < 1e-6 * (d.x.hypot(d.y))
            });
            assert!(on, "{}: the centreline starts inside", template.name());
        }
    }
}
