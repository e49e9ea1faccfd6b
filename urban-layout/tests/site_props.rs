//! Laws of reading a site. `URBAN_LAYOUT_LONG=1` tries many more cases.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

use std::f64::consts::TAU;

use geo_types::{Coord, LineString, Polygon};
use proptest::prelude::*;
use urban_layout::io::frame::Frame;
use urban_layout::site::{Site, Units};

fn cases(few: u32) -> ProptestConfig {
    let long = std::env::var_os("URBAN_LAYOUT_LONG").is_some();
    ProptestConfig::with_cases(if long { few * 50 } else { few })
}

/// A ring on a small integer grid: repeats, spikes, touches, overlaps and
/// crossings all turn up by themselves.
fn grid_ring(size: i32, most: usize) -> impl Strategy<Value = Vec<Coord<f64>>> {
    prop::collection::vec((0..size, 0..size), 3..most).prop_map(|points| {
        let at = |(x, y): (i32, i32)| Coord {
            x: f64::from(x) * 10.0,
            y: f64::from(y) * 10.0,
        };
        points.into_iter().map(at).collect()
    })
}

/// A ring that is a star around its centre, thus simple.
fn star() -> impl Strategy<Value = Vec<Coord<f64>>> {
    prop::collection::vec(20.0..300.0_f64, 3..30).prop_map(|radii| {
        let n = radii.len() as f64;
        let at = |(k, r): (usize, &f64)| Coord {
            x: r * (k as f64 / n * TAU).cos(),
            y: r * (k as f64 / n * TAU).sin(),
        };
        radii.iter().enumerate().map(at).collect()
    })
}

fn closed(mut ring: Vec<Coord<f64>>) -> LineString<f64> {
    ring.extend(ring.first().copied());
    LineString(ring)
}

fn signed(ring: &LineString<f64>) -> f64 {
    let Some(&o) = ring.0.first() else { return 0.0 };
    let cross = |w: &[Coord<f64>]| {
        let (a, b) = (w[0] - o, w[1] - o);
        (a.x * b.y - a.y * b.x) / 2.0
    };
    ring.0.windows(2).map(cross).sum()
}

/// Whether two segments have a point in common other than ends that coincide.
fn bad_meeting(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>, d: Coord<f64>) -> bool {
    let side = |a: Coord<f64>, b: Coord<f64>, c: Coord<f64>| {
        let (u, v) = (b - a, c - a);
        let cross = u.x * v.y - u.y * v.x;
        // Results of cutting are rounded: a nanometre is no crossing.
        if cross.abs() <= 1e-9 * u.x.hypot(u.y) {
            0.0
        } else {
            cross.signum()
        }
    };
    let (s, t, u, v) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    if s == 0.0 && t == 0.0 {
        // Collinear: bad if they overlap by more than a point.
        let along = |p: Coord<f64>| (p - a).x * (b - a).x + (p - a).y * (b - a).y;
        let (low, high) = (along(c).min(along(d)), along(c).max(along(d)));
        return low.max(0.0) < high.min(along(b)) - 1e-6;
    }
    let touch = [s, t, u, v].contains(&0.0);
    if touch {
        // A vertex on the inside of an edge is no common vertex.
        let inner = |p: Coord<f64>, a: Coord<f64>, b: Coord<f64>| {
            let d = b - a;
            let f = ((p - a).x * d.x + (p - a).y * d.y) / (d.x * d.x + d.y * d.y);
            let gap = 1e-9 / d.x.hypot(d.y);
            f > gap && f < 1.0 - gap
        };
        return (s == 0.0 && inner(c, a, b))
            || (t == 0.0 && inner(d, a, b))
            || (u == 0.0 && inner(a, c, d))
            || (v == 0.0 && inner(b, c, d));
    }
    s != t && u != v
}

/// What [`Site`] promises of its parts, checked by brute force.
fn sound(site: &Site) -> Result<(), TestCaseError> {
    for part in &site.parts {
        prop_assert!(signed(part.exterior()) > 0.0);
        for hole in part.interiors() {
            prop_assert!(signed(hole) < 0.0);
        }
        let edges: Vec<(Coord<f64>, Coord<f64>)> = std::iter::once(part.exterior())
            .chain(part.interiors())
            .flat_map(|ring| ring.0.windows(2).map(|w| (w[0], w[1])))
            .collect();
        for (i, &(a, b)) in edges.iter().enumerate() {
            prop_assert!(a != b);
            for &(c, d) in &edges[i + 1..] {
                prop_assert!(
                    !bad_meeting(a, b, c, d),
                    "{a:?} {b:?} meets {c:?} {d:?} in {part:?}"
                );
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(400))]

    /// A ring of the grid is refused or becomes sound parts of the same area.
    #[test]
    fn a_ring_is_refused_or_made_sound(ring in grid_ring(5, 12)) {
        let line = closed(ring);
        let polygon = Polygon::new(line.clone(), vec![]);
        if let Ok(site) = Site::from_polygon(&polygon) {
            let area = signed(&line).abs();
            prop_assert!((site.area() - area).abs() < 1e-6 * area, "{} {area}", site.area());
            sound(&site)?;
        }
    }

    /// So are polygons with holes that touch each other in every way.
    #[test]
    fn holes_are_refused_or_made_sound(
        outer in grid_ring(7, 7),
        holes in prop::collection::vec(grid_ring(7, 5), 1..4),
    ) {
        let outer = closed(outer);
        let holes: Vec<_> = holes.into_iter().map(closed).collect();
        let area = signed(&outer).abs() - holes.iter().map(|h| signed(h).abs()).sum::<f64>();
        if let Ok(site) = Site::from_polygon(&Polygon::new(outer, holes)) {
            prop_assert!((site.area() - area).abs() < 1e-6 * area, "{} {area}", site.area());
            sound(&site)?;
        }
    }

    /// A simple ring is accepted from any place, in either winding, from any first
    /// vertex, with the same local vertices.
    #[test]
    fn place_winding_and_start_do_not_matter(
        ring in star(),
        shift in (-4096..4096_i32, -4096..4096_i32),
        turn in 0..30_usize,
        back: bool,
    ) {
        let first = Site::from_polygon(&Polygon::new(closed(ring.clone()), vec![])).unwrap();
        let move_by = Coord { x: f64::from(shift.0) * 1024.0, y: f64::from(shift.1) * 1024.0 };
        let mut other: Vec<_> = ring.iter().map(|&c| c + move_by).collect();
        other.rotate_left(turn % ring.len());
        if back {
            other.reverse();
        }
        let second = Site::from_polygon(&Polygon::new(closed(other), vec![])).unwrap();
        prop_assert!((first.area() - second.area()).abs() < 1e-6 * first.area());
        let (a, b) = (first.parts[0].exterior(), second.parts[0].exterior());
        prop_assert_eq!(a.0.len(), b.0.len());
        // The centres may be rounded apart by a grid step of 2^-10 m.
        for p in &a.0 {
            let near = |q: &Coord<f64>| (q.x - p.x).abs() < 2e-3 && (q.y - p.y).abs() < 2e-3;
            prop_assert!(b.0.iter().any(near));
        }
    }

    /// Vertices that cleaning and clipping leave are those of the file, to the bit.
    #[test]
    fn vertices_of_the_file_come_back(ring in star()) {
        let at = Coord { x: 497_123.4, y: 6_702_345.6 };
        let ring: Vec<_> = ring.iter().map(|&c| c + at).collect();
        let site = Site::from_polygon(&Polygon::new(closed(ring.clone()), vec![])).unwrap();
        for &p in &site.parts[0].exterior().0 {
            prop_assert!(ring.contains(&site.frame.to_source(p)));
        }
    }

    /// Degrees come back within a tenth of a nanodegree, anywhere.
    #[test]
    fn degrees_come_back(
        centre in (-180.0..180.0_f64, -85.0..85.0_f64),
        off in (-0.2..0.2_f64, -0.2..0.2_f64),
    ) {
        let frame = Frame::degrees(Coord { x: centre.0, y: centre.1 });
        let c = Coord { x: centre.0 + off.0, y: centre.1 + off.1 };
        let back = frame.to_source(frame.to_local(c));
        prop_assert!((back.x - c.x).abs() < 1e-10 && (back.y - c.y).abs() < 1e-10);
        // East is x and north is y.
        let local = frame.to_local(c);
        prop_assert!(local.x * off.0 >= -1e-2 && local.y * off.1 >= -1e-2);
    }

    /// A road's pieces lie inside, and what is cut off does not: lengths agree with
    /// counting samples.
    #[test]
    fn roads_are_clipped_to_the_site(ring in star(), road in prop::collection::vec((-350.0..350.0_f64, -350.0..350.0_f64), 2..6)) {
        let text = |ring: &[Coord<f64>], road: &[(f64, f64)]| {
            let pair = |x: f64, y: f64| format!("[{x}, {y}]");
            let mut outline: Vec<String> = ring.iter().map(|c| pair(c.x, c.y)).collect();
            outline.push(outline[0].clone());
            let line: Vec<String> = road.iter().map(|&(x, y)| pair(x, y)).collect();
            format!(
                r#"{{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
                {{"type": "Feature", "properties": {{"kind": "site"}}, "geometry":
                {{"type": "Polygon", "coordinates": [[{}]]}}}},
                {{"type": "Feature", "properties": {{"kind": "road"}}, "geometry":
                {{"type": "LineString", "coordinates": [{}]}}}}]}}"#,
                outline.join(", "), line.join(", "))
        };
        let site = Site::from_geojson(&text(&ring, &road), Units::Auto).unwrap();
        let length = |line: &LineString<f64>| -> f64 {
            line.0.windows(2).map(|w| (w[1] - w[0]).x.hypot((w[1] - w[0]).y)).sum()
        };
        for piece in &site.roads {
            for w in piece.line.0.windows(2) {
                prop_assert!(site.contains((w[0] + w[1]) / 2.0));
                prop_assert!(site.contains(w[0]) && site.contains(w[1]));
            }
        }
        if site.boundary_roads.is_empty() {
            let found: f64 = site.roads.iter().map(|r| length(&r.line)).sum();
            let mut expected = 0.0;
            for w in road.windows(2) {
                let (p, q) = (Coord::from(w[0]), Coord::from(w[1]));
                let (p, q) = (site.frame.to_local(p), site.frame.to_local(q));
                let n = 400;
                let inside = (0..n).filter(|&k| {
                    let f = (f64::from(k) + 0.5) / f64::from(n);
                    site.contains(p + (q - p) * f)
                });
                let d = q - p;
                expected += inside.count() as f64 / f64::from(n) * d.x.hypot(d.y);
            }
            // Each crossing is off by one sample of at most 2.5 m, and at most
            // 30 edges are crossed by each of 5 segments.
            let crossings = 5.0 * (ring.len() as f64).min(12.0);
            prop_assert!((found - expected).abs() < 2.5 * crossings + 0.5, "{found} {expected}");
        }
    }
}

proptest! {
    #![proptest_config(cases(300))]

    /// Any text is answered.
    #[test]
    fn any_text_is_answered(text in ".{0,200}") {
        let _ = Site::from_geojson(&text, Units::Auto);
    }

    /// Any JSON is answered, GeoJSON words and all.
    #[test]
    fn any_json_is_answered(text in json(4)) {
        for units in [Units::Auto, Units::Metres, Units::Degrees] {
            if let Err(error) = Site::from_geojson(&text, units) {
                prop_assert!(error.is_input());
                prop_assert!(!error.to_string().contains('\n'));
            }
        }
    }

    /// A sound file with a few bytes changed is answered.
    #[test]
    fn a_damaged_file_is_answered(
        changes in prop::collection::vec((0..4000_usize, prop::sample::select(b"0123456789.,-[]{}\":eNn x".to_vec())), 1..6),
    ) {
        let sound = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
            {"type": "Feature", "properties": {"kind": "site"}, "geometry": {"type": "Polygon",
             "coordinates": [[[0, 0], [400, 0], [400, 300], [0, 300], [0, 0]],
             [[100, 100], [200, 100], [200, 200], [100, 200], [100, 100]]]}},
            {"type": "Feature", "properties": {"kind": "road", "width_m": 14}, "geometry":
             {"type": "LineString", "coordinates": [[-10, 50], [210, 60], [410, 150]]}},
            {"type": "Feature", "properties": {"kind": "lake"}, "geometry": {"type": "Polygon",
             "coordinates": [[[250, 50], [350, 50], [350, 90], [250, 90], [250, 50]]]}},
            {"type": "Feature", "properties": {"kind": "park"}, "geometry": {"type": "Polygon",
             "coordinates": [[[300, 70], [390, 70], [390, 190], [300, 190], [300, 70]]]}}]}"#;
        let mut bytes = sound.as_bytes().to_vec();
        for (at, byte) in changes {
            let n = bytes.len();
            bytes[at % n] = byte;
        }
        if let Ok(text) = String::from_utf8(bytes) {
            if let Ok(site) = Site::from_geojson(&text, Units::Auto) {
                sound_elements(&site)?;
                sound_(&site)?;
            }
        }
    }
}

fn sound_(site: &Site) -> Result<(), TestCaseError> {
    sound(site)
}

/// Elements are wound as promised and no larger, together, than the land.
fn sound_elements(site: &Site) -> Result<(), TestCaseError> {
    let mut sum = 0.0;
    for element in &site.elements {
        let own = signed(element.polygon.exterior());
        prop_assert!(own > 0.0);
        sum += own + element.polygon.interiors().iter().map(signed).sum::<f64>();
    }
    prop_assert!(sum <= site.area() * (1.0 + 1e-6));
    Ok(())
}

/// JSON texts that look like GeoJSON more often than not.
fn json(depth: u32) -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        Just("null".to_owned()),
        Just("1e999".to_owned()),
        any::<f64>().prop_map(|v| v.to_string()),
        (-200..200_i32).prop_map(|v| v.to_string()),
        prop::sample::select(vec![
            "\"site\"",
            "\"road\"",
            "\"Feature\"",
            "\"Polygon\"",
            "\"LineString\""
        ])
        .prop_map(str::to_owned),
        ((-9..9_i32), (-9..9_i32)).prop_map(|(x, y)| format!("[{x},{y}]")),
    ];
    leaf.prop_recursive(depth, 60, 8, |inner| {
        let key = prop::sample::select(vec![
            "type", "features", "geometry", "coordinates", "properties", "kind", "width_m", "crs",
        ]);
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..8).prop_map(|v| format!("[{}]", v.join(","))),
            prop::collection::vec((key, inner.clone()), 0..5).prop_map(|v| {
                let members: Vec<String> =
                    v.into_iter().map(|(k, v)| format!("\"{k}\":{v}")).collect();
                format!("{{{}}}", members.join(","))
            }),
            (
                prop::sample::select(vec!["site", "road", "street", "lake", "park", "odd"]),
                prop::sample::select(vec!["Polygon", "MultiPolygon", "LineString", "Point"]),
                inner.clone(),
                inner,
            )
                .prop_map(|(kind, geometry, coordinates, other)| format!(
                    r#"{{"type":"FeatureCollection","features":[{{"type":"Feature","properties":
                    {{"kind":"site"}},"geometry":{{"type":"Polygon","coordinates":{other}}}}},
                    {{"type":"Feature","properties":{{"kind":"{kind}"}},"geometry":
                    {{"type":"{geometry}","coordinates":[[{coordinates},{coordinates},[3,4],[0,0]]]}}}}]}}"#
                )),
        ]
    })
}
