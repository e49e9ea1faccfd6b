//! Laws of measuring, sewing, judging, writing and reading layouts.
//! `URBAN_LAYOUT_LONG=1` tries many more cases.

mod synthetic;

use std::collections::BTreeMap;

use proptest::prelude::*;
use synthetic::Town;
use urban_layout::check::{check, polygon_fault, read_layout, CheckOptions};
use urban_layout::geo_types::{Coord, LineString, Polygon};
use urban_layout::io::frame::Frame;
use urban_layout::io::layout_geojson::layout_to_geojson;
use urban_layout::layout::{measure_parcel, min_box_area, seam};
use urban_layout::metrics::metrics;

fn cases(few: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    ProptestConfig::with_cases(if long { few * 50 } else { few })
}

fn polygon(points: Vec<Coord<f64>>) -> Polygon<f64> {
    Polygon::new(LineString::new(points), vec![])
}

/// A star-shaped ring of parcel size: simple, with concave corners and slivers.
fn star() -> impl Strategy<Value = Vec<Coord<f64>>> {
    prop::collection::vec(4.0..40.0_f64, 3..14).prop_map(|radii| {
        let n = radii.len() as f64;
        let at = |(i, r): (usize, f64)| {
            let a = std::f64::consts::TAU * i as f64 / n;
            Coord {
                x: r * a.cos(),
                y: r * a.sin(),
            }
        };
        radii.into_iter().enumerate().map(at).collect()
    })
}

fn moved(points: &[Coord<f64>], angle: f64, scale: f64, by: Coord<f64>) -> Vec<Coord<f64>> {
    let (sin, cos) = angle.sin_cos();
    let at = |c: &Coord<f64>| Coord {
        x: scale * (c.x * cos - c.y * sin) + by.x,
        y: scale * (c.x * sin + c.y * cos) + by.y,
    };
    points.iter().map(at).collect()
}

/// Area of the upright box around a turned ring.
fn box_at(points: &[Coord<f64>], angle: f64) -> f64 {
    let turned = moved(points, angle, 1.0, Coord { x: 0.0, y: 0.0 });
    let range = |f: fn(&Coord<f64>) -> f64| {
        let high = turned.iter().map(f).fold(f64::NEG_INFINITY, f64::max);
        high - turned.iter().map(f).fold(f64::INFINITY, f64::min)
    };
    range(|c| c.x) * range(|c| c.y)
}

proptest! {
    #![proptest_config(cases(60))]

    /// No direction in steps of a quarter degree has a smaller box, and the
    /// smallest of those is hardly larger (the area's slope is at most
    /// diameter^2 per radian: 80^2 * pi / 1440).
    #[test]
    fn the_least_box_is_the_least(points in star()) {
        let least = min_box_area(&polygon(points.clone()));
        let steps = (0..360).map(|k| box_at(&points, f64::from(k).to_radians() / 4.0));
        let brute = steps.fold(f64::INFINITY, f64::min);
        prop_assert!(least <= brute * (1.0 + 1e-9), "{least} {brute}");
        prop_assert!(brute - least < 14.0, "{least} {brute}");
    }

    /// A parcel measures the same wherever it lies, however it is turned, scaled
    /// or mirrored, and wherever its ring starts.
    #[test]
    fn measures_do_not_depend_on_the_place(
        points in star(),
        angle in -3.2..3.2_f64,
        scale in 0.5..4.0_f64,
        by in (-5e3..5e3_f64, -5e3..5e3_f64),
        start in 0..14_usize,
    ) {
        let (deviation, ratio) = measure_parcel(&polygon(points.clone()));
        let there = moved(&points, angle, scale, Coord { x: by.0, y: by.1 });
        // A turn within rounding of a threshold may fall on either side of it.
        let n = points.len();
        let near = |limit: f64| (0..n).any(|i| {
            let (a, b, c) = (points[(i + n - 1) % n], points[i], points[(i + 1) % n]);
            let (u, v) = (b - a, c - b);
            let turn = (u.x * v.y - u.y * v.x).atan2(u.x * v.x + u.y * v.y).to_degrees().abs();
            (turn - limit).abs() < 0.6
        });
        prop_assume!(!near(0.5) && !near(20.0));
        let (d, r) = measure_parcel(&polygon(there.clone()));
        prop_assert!((d - deviation).abs() < 1e-6 && (r - ratio).abs() < 1e-7 * ratio);
        let mut mirrored: Vec<_> = points.iter().map(|c| Coord { x: -c.x, y: c.y }).collect();
        mirrored.rotate_left(start % n);
        let (d, r) = measure_parcel(&polygon(mirrored));
        prop_assert!((d - deviation).abs() < 1e-6 && (r - ratio).abs() < 1e-7 * ratio);
    }

    /// Valid is what has no two edges that meet but at the vertex they share.
    #[test]
    fn faults_are_those_of_a_search_through_all_pairs(
        points in prop::collection::vec((0..7_i32, 0..7_i32), 3..8),
    ) {
        let mut ring: Vec<Coord<f64>> =
            points.iter().map(|p| Coord { x: f64::from(p.0), y: f64::from(p.1) }).collect();
        ring.dedup();
        prop_assume!(ring.len() > 2 && ring.first() != ring.last());
        prop_assert_eq!(polygon_fault(&polygon(ring.clone())).is_none(), is_simple(&points), "{:?}", ring);
    }
}

/// Whether a ring of integer points is simple, exactly and by brute force.
fn is_simple(points: &[(i32, i32)]) -> bool {
    let mut ring = points.to_vec();
    ring.dedup();
    let n = ring.len();
    let side = |a: (i32, i32), b: (i32, i32), c: (i32, i32)| {
        ((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)).signum()
    };
    let on = |p: (i32, i32), a: (i32, i32), b: (i32, i32)| {
        side(a, b, p) == 0
            && p.0 >= a.0.min(b.0)
            && p.0 <= a.0.max(b.0)
            && p.1 >= a.1.min(b.1)
            && p.1 <= a.1.max(b.1)
    };
    for i in 0..n {
        let (a, b) = (ring[i], ring[(i + 1) % n]);
        for j in 0..n {
            let (c, d) = (ring[j], ring[(j + 1) % n]);
            let crosses = side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
            // A vertex on an edge of which it is no end, or two vertices in one place.
            let touches = j != i && j != (i + 1) % n && on(c, a, b);
            if i != j && (crosses || touches) {
                return false;
            }
        }
    }
    true
}

/// A wall of bricks, half a brick's shift a course: T-junctions everywhere.
fn bricks(courses: usize, long: usize) -> Vec<Vec<Coord<f64>>> {
    let mut all = Vec::new();
    for course in 0..courses {
        for k in 0..long {
            let (x, y) = (
                20.0 * k as f64 + 10.0 * (course % 2) as f64,
                9.0 * course as f64,
            );
            let corners = [(x, y), (x + 20.0, y), (x + 20.0, y + 9.0), (x, y + 9.0)];
            all.push(corners.map(|(x, y)| Coord { x, y }).to_vec());
        }
    }
    all
}

proptest! {
    #![proptest_config(cases(24))]

    /// Bricks turned any way whose corners each are off by up to a third of the
    /// tolerance: sewn, every inner edge has its twin and only the rim is left.
    #[test]
    fn seams_match_edge_by_edge(
        courses in 2..6_usize,
        long in 2..6_usize,
        angle in 0.0..6.3_f64,
        noise in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 144),
    ) {
        let tolerance = 1e-4;
        let mut noise = noise.into_iter();
        let by = Coord { x: 310.0, y: -1250.0 };
        let before: Vec<Polygon<f64>> = bricks(courses, long)
            .into_iter()
            .map(|ring| {
                let ring = moved(&ring, angle, 1.0, by).into_iter().map(|c| {
                    let (dx, dy) = noise.next().unwrap_or((0.3, -0.7));
                    Coord { x: c.x + dx * tolerance / 5.0, y: c.y + dy * tolerance / 5.0 }
                });
                polygon(ring.collect())
            })
            .collect();
        let mut after = before.clone();
        let report = seam(&mut after, tolerance);
        prop_assert!(report.collapsed.is_empty() && report.pieces.is_empty());
        for (p, q) in before.iter().zip(&after) {
            for c in &p.exterior().0 {
                let nearest = q.exterior().0.iter().map(|d| (c.x - d.x).hypot(c.y - d.y)).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest <= tolerance);
            }
        }
        let mut balance: BTreeMap<[u64; 4], i32> = BTreeMap::new();
        for w in after.iter().flat_map(|p| p.exterior().0.windows(2)) {
            let (a, b) = ([w[0].x.to_bits(), w[0].y.to_bits()], [w[1].x.to_bits(), w[1].y.to_bits()]);
            let (key, way) = if a < b { ([a, b], 1) } else { ([b, a], -1) };
            *balance.entry([key[0][0], key[0][1], key[1][0], key[1][1]]).or_default() += way;
        }
        let lone = balance.values().filter(|v| **v != 0).count();
        // The rim of the wall in half bricks, below and above, and the toothed sides.
        let rim = 2 * long + 2 * courses + 2 * (courses - 1);
        prop_assert_eq!(lone, rim);
        // Sewing again changes nothing.
        let mut again = after.clone();
        let report = seam(&mut again, tolerance);
        prop_assert_eq!((report.merged, report.inserted), (0, 0));
        prop_assert_eq!(again, after);
    }

    /// Any tile's vertex moved by a centimetre or more is found.
    #[test]
    fn a_moved_vertex_is_found(tile in 0..90_usize, vertex in 0..4_usize, angle in 0.0..6.3_f64, far in 0.01..20.0_f64) {
        let (site, mut layout) = Town::default().build();
        let mut ring = layout.tiles[tile].polygon.exterior().0.clone();
        ring.pop();
        let vertex = vertex % ring.len();
        ring[vertex] = ring[vertex] + Coord { x: far * angle.cos(), y: far * angle.sin() };
        layout.tiles[tile].polygon = polygon(ring);
        let certificate = check(&site, &layout, &CheckOptions::default());
        let twins = certificate.law("twins").expect("a law");
        prop_assert!(!twins.passed);
    }

    /// What is written is read back: same figures, same certificate, and the
    /// same text when written again.
    #[test]
    fn layouts_survive_their_file(
        parcels in 2..6_usize,
        columns in 2..4_usize,
        streets in 1..4_usize,
        wave in 0.0..12.0_f64,
        latitude in -60.0..70.0_f64,
        degrees in any::<bool>(),
    ) {
        let (mut site, layout) = Town { parcels, columns, streets, wave }.build();
        if degrees {
            site.frame = Frame::degrees(Coord { x: 25.0, y: latitude });
        }
        let text = layout_to_geojson(&layout, &site.frame);
        let back = read_layout(&text, &site.frame).expect("our own file");
        prop_assert_eq!(layout_to_geojson(&back, &site.frame), text);
        let certificate = check(&site, &back, &CheckOptions::default());
        prop_assert!(certificate.is_ok(), "{}", certificate);
        let (m, n) = (metrics(&layout, &site), metrics(&back, &site));
        prop_assert_eq!((m.parcels, m.undesirable, m.without_access), (n.parcels, n.undesirable, n.without_access));
        for (a, b) in [(m.p_angle, n.p_angle), (m.l_r, n.l_r), (m.s_l, n.s_l), (m.b_avg, n.b_avg)] {
            prop_assert!((a - b).abs() < 1e-3, "{a} {b}");
        }
    }

    /// Reading never panics: any text is a layout or an error of one line.
    #[test]
    fn garbage_is_an_error(cut in 0..20_000_usize, swap in 0..20_000_usize, with in "[\\[\\]{},:a0\"-]") {
        let (site, layout) = Town { parcels: 2, columns: 2, streets: 1, wave: 3.0 }.build();
        let text = layout_to_geojson(&layout, &site.frame);
        let cut = text.floor_char_boundary(cut.min(text.len()));
        if let Err(error) = read_layout(&text[..cut], &site.frame) {
            prop_assert!(error.is_input() && !error.to_string().contains('\n'));
        }
        let at = text.floor_char_boundary(swap.min(text.len() - 1));
        let mut broken = text.clone();
        broken.replace_range(at..at + 1, &with);
        if let Ok(layout) = read_layout(&broken, &site.frame) {
            let _ = check(&site, &layout, &CheckOptions::default());
            let _ = metrics(&layout, &site);
        }
    }
}

#[test]
fn layouts_of_other_tools_are_read() {
    let (site, _) = Town::default().build();
    let frame = site.frame;
    let text = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
        {"type": "Feature", "properties": {"kind": "parcel", "id": 4}, "geometry": {"type": "MultiPolygon", "coordinates":
            [[[[0, 0], [0, 30], [18, 30], [18, 0], [0, 0]]], [[[20, 0, 5], [38, 0], [38, 30], [20, 30], [20, 0]]]]}},
        {"type": "Feature", "properties": {"kind": "tree", "id": "x"}, "geometry": null},
        {"type": "Feature", "properties": null, "geometry": null},
        {"type": "Feature", "properties": {"kind": "junction", "id": 7}, "geometry": {"type": "Point", "coordinates": [0, -5]}},
        {"type": "Feature", "properties": {"kind": "street", "id": 8}, "geometry":
            {"type": "LineString", "coordinates": [[0, -5], [40, -5]]}}]}"#;
    let layout = read_layout(text, &frame).expect("a layout");
    assert_eq!(
        layout.tiles.iter().map(|t| t.id).collect::<Vec<_>>(),
        [4, 0]
    );
    let info = layout.tiles[0].parcel.as_ref().expect("a parcel");
    assert!(info.corner_deviation_deg < 1e-6 && (info.box_ratio - 1.0).abs() < 1e-6);
    assert_eq!((layout.streets[0].from, layout.streets[0].width), (7, 12.0));

    for (wrong, says) in [
        (r#"{"kind": "parcel"}"#, "feature 0 of the layout: `id`"),
        (
            r#"{"kind": "parcel", "id": 1.5}"#,
            "feature 0 of the layout: `id`",
        ),
        (r#"{"kind": "street", "id": 1}"#, "a street is a LineString"),
        (r#"{"kind": "junction", "id": 1}"#, "a junction is a Point"),
    ] {
        let text = format!(
            r#"{{"type": "FeatureCollection", "features": [{{"type": "Feature", "properties": {wrong},
            "geometry": {{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}}}}]}}"#
        );
        let error = read_layout(&text, &frame).expect_err(wrong);
        assert!(
            error.is_input() && error.to_string().contains(says),
            "{error}"
        );
    }
    let metres = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": []}"#;
    let error =
        read_layout(metres, &Frame::degrees(Coord { x: 25.0, y: 60.0 })).expect_err("units differ");
    assert!(error.to_string().contains("metres"));
}
