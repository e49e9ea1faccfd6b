//! A plan that keeps every law, and for each law a plan that breaks it.

mod synthetic;

use synthetic::Town;
use urban_layout::check::{check, Certificate, CheckOptions};
use urban_layout::geo_types::{Coord, LineString, Polygon};
use urban_layout::layout::{Junction, Layout, Street, Tile, TileKind};
use urban_layout::metrics::metrics;
use urban_layout::site::{GivenRoad, RoadClass, Site};

fn judged(spoil: impl FnOnce(&mut Site, &mut Layout)) -> Certificate {
    let (mut site, mut layout) = Town::default().build();
    spoil(&mut site, &mut layout);
    check(&site, &layout, &CheckOptions::default())
}

fn failed(certificate: &Certificate) -> Vec<&'static str> {
    certificate.failed().map(|law| law.law).collect()
}

/// Asserts that exactly these laws fail, and that each says why.
fn breaks(laws: &[&str], spoil: impl FnOnce(&mut Site, &mut Layout)) {
    let certificate = judged(spoil);
    assert_eq!(failed(&certificate), laws, "{certificate}");
    for law in certificate
        .failed()
        .filter(|law| !["overlap", "gap", "spill"].contains(&law.law))
    {
        assert!(!law.detail.is_empty(), "{} has no detail", law.law);
    }
}

/// Number of the first parcel.
fn first_parcel(layout: &Layout) -> usize {
    layout
        .tiles
        .iter()
        .position(|t| t.kind == TileKind::Parcel)
        .expect("a parcel")
}

/// Moves a vertex of one tile alone.
fn push_vertex(layout: &mut Layout, tile: usize, vertex: usize, by: Coord<f64>) {
    let mut ring = layout.tiles[tile].polygon.exterior().0.clone();
    ring.pop();
    ring[vertex] = ring[vertex] + by;
    layout.tiles[tile].polygon = Polygon::new(LineString::new(ring), vec![]);
}

/// A street that is not given, ends inside at both junctions, and is straight.
fn inner_street(layout: &Layout) -> usize {
    let degree = |id: u64| {
        layout
            .junctions
            .iter()
            .find(|j| j.id == id)
            .map_or(0, |j| j.degree)
    };
    layout
        .streets
        .iter()
        .position(|s| !s.given && s.line.0.len() == 2 && degree(s.from) > 2 && degree(s.to) > 2)
        .expect("an inner street")
}

fn remove_street(layout: &mut Layout, number: usize) {
    let street = layout.streets.remove(number);
    for id in [street.from, street.to] {
        let place = layout
            .junctions
            .iter()
            .position(|j| j.id == id)
            .expect("a junction");
        layout.junctions[place].degree -= 1;
        if layout.junctions[place].degree == 0 {
            layout.junctions.remove(place);
        }
    }
}

/// Puts extra vertices into a street, at parts of its way and metres to its left.
fn bend(layout: &mut Layout, number: usize, vertices: &[(f64, f64)]) {
    let line = &mut layout.streets[number].line.0;
    let (a, b) = (line[0], line[line.len() - 1]);
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let long = dx.hypot(dy);
    let extra = vertices.iter().map(|(along, left)| Coord {
        x: a.x + along * dx - left * dy / long,
        y: a.y + along * dy + left * dx / long,
    });
    line.splice(1..1, extra.collect::<Vec<_>>());
}

#[test]
fn a_sound_plan_keeps_every_law() {
    for town in [
        Town::default(),
        Town {
            parcels: 3,
            columns: 2,
            streets: 1,
            wave: 0.0,
        },
        Town {
            columns: 5,
            streets: 4,
            ..Town::default()
        },
    ] {
        let (site, layout) = town.build();
        let certificate = check(&site, &layout, &CheckOptions::default());
        assert!(certificate.is_ok(), "{certificate}");
        assert_eq!(certificate.components, 1);
        let json = certificate.to_json();
        assert_eq!(json["ok"], true);
        assert_eq!(
            json["laws"].as_array().map(Vec::len),
            Some(certificate.laws.len())
        );
    }
}

#[test]
fn metrics_are_those_of_the_geometry() {
    let (site, layout) = Town {
        wave: 0.0,
        ..Town::default()
    }
    .build();
    let m = metrics(&layout, &site);
    let blocks = 3 * 4;
    assert_eq!(layout.blocks.len(), blocks);
    // Two columns whole; in the middle one a lake, a park and shops but for one row.
    assert_eq!(m.parcels, 2 * 7 * 6 + 7);
    assert!((m.p_angle).abs() < 1e-6 && (m.p_area - 1.0).abs() < 1e-9);
    assert_eq!((m.undesirable, m.without_access), (0, 0));
    assert!((m.l_s + m.l_r + m.l_p + m.l_o - 100.0).abs() < 1e-9);
    let km2 = site.area() / 1e6;
    assert!((m.b_n * km2 - blocks as f64).abs() < 1e-9);
    assert!(
        (m.b_max - 2.0 * (126.0 + 60.0)).abs() < 1e-6
            && (m.b_min - 2.0 * (126.0 + 30.0)).abs() < 1e-6
    );
    assert!((m.s_i * km2 - 6.0).abs() < 1e-9);
    // Ends at the boundary where nothing is given outside are no ways out here,
    // since a street outside and a road are given.
    assert!((m.s_d * km2 - 8.0).abs() < 1e-9);
    assert_eq!(m.p_ideal, Some(1.0));
    assert_eq!(m.p_similarity, Some(0.25));
    assert_eq!(m.seed, 7);
}

#[test]
fn two_features_of_one_id() {
    breaks(&["ids"], |_, layout| {
        layout.blocks[0].id = layout.blocks[1].id
    });
}

#[test]
fn no_parcels() {
    breaks(&["parcels"], |_, layout| {
        for tile in layout
            .tiles
            .iter_mut()
            .filter(|t| t.kind == TileKind::Parcel)
        {
            tile.kind = TileKind::Other;
        }
    });
}

#[test]
fn a_bow_tie() {
    let certificate = judged(|_, layout| {
        let i = first_parcel(layout);
        let mut ring = layout.tiles[i].polygon.exterior().0.clone();
        ring.swap(1, 2);
        layout.tiles[i].polygon = Polygon::new(LineString::new(ring), vec![]);
    });
    assert!(failed(&certificate).contains(&"valid"));
    assert!(certificate.law("valid").expect("a law").detail[0].contains("crosses itself"));
}

#[test]
fn an_overlap() {
    // The vertex between four parcels, moved in one of them alone.
    breaks(&["overlap", "twins"], |_, layout| {
        let i = first_parcel(layout) + 8;
        push_vertex(layout, i, 2, Coord { x: 2.0, y: 1.0 });
    });
}

#[test]
fn a_gap() {
    breaks(&["gap", "twins"], |_, layout| {
        layout.tiles.remove(first_parcel(layout));
    });
}

#[test]
fn a_spill() {
    breaks(&["spill", "twins"], |_, layout| {
        let i = first_parcel(layout);
        let ring = &layout.tiles[i].polygon.exterior().0;
        // Along the lower boundary, beyond its end.
        let by = Coord {
            x: (ring[0].x - ring[1].x) / 6.0,
            y: (ring[0].y - ring[1].y) / 6.0,
        };
        push_vertex(layout, i, 0, by);
    });
}

#[test]
fn a_crack_that_no_area_shows() {
    breaks(&["twins"], |_, layout| {
        let i = first_parcel(layout) + 8;
        push_vertex(layout, i, 2, Coord { x: 0.002, y: 0.0 });
    });
}

#[test]
fn a_vertex_that_the_neighbour_lacks() {
    breaks(&["twins"], |_, layout| {
        let i = first_parcel(layout) + 8;
        let mut ring = layout.tiles[i].polygon.exterior().0.clone();
        let middle = Coord {
            x: (ring[1].x + ring[2].x) / 2.0,
            y: (ring[1].y + ring[2].y) / 2.0,
        };
        ring.insert(2, middle);
        layout.tiles[i].polygon = Polygon::new(LineString::new(ring), vec![]);
    });
}

#[test]
fn a_junction_with_a_wrong_degree() {
    breaks(&["junctions"], |_, layout| layout.junctions[0].degree += 1);
}

#[test]
fn a_missing_junction() {
    breaks(&["junctions"], |_, layout| {
        layout.junctions.remove(0);
    });
}

#[test]
fn a_junction_beside_its_streets() {
    breaks(&["junctions"], |_, layout| layout.junctions[0].at.x += 0.2);
}

#[test]
fn a_junction_without_streets() {
    breaks(&["junctions"], |_, layout| {
        layout.junctions.push(Junction {
            id: 9,
            at: Coord { x: 0.0, y: 0.0 },
            degree: 0,
        });
    });
}

#[test]
fn streets_that_cross_without_a_junction() {
    let certificate = judged(|_, layout| {
        // Two streets in one line become one that passes the junction.
        let i = inner_street(layout);
        let street = layout.streets[i].clone();
        let j = layout
            .streets
            .iter()
            .position(|s| s.line.0.len() == 2 && s.to == street.from)
            .expect("the street before");
        layout.streets[j].to = street.to;
        layout.streets[j].line.0[1] = street.line.0[1];
        let node = layout
            .junctions
            .iter_mut()
            .find(|j| j.id == street.from)
            .expect("a junction");
        node.degree -= 2;
        layout.streets.remove(i);
    });
    assert!(failed(&certificate).contains(&"crossings"), "{certificate}");
    assert!(
        !failed(&certificate).contains(&"junctions"),
        "{certificate}"
    );
}

#[test]
fn a_street_off_the_street_area() {
    let certificate = judged(|_, layout| {
        let i = inner_street(layout);
        bend(layout, i, &[(0.3, 1.0), (0.5, 12.0), (0.7, 1.0)]);
    });
    assert!(failed(&certificate).contains(&"paved"), "{certificate}");
}

/// Takes out the streets that the collector's junctions have besides it.
fn cut_off_collector(layout: &mut Layout) {
    let own: Vec<u64> = layout
        .streets
        .iter()
        .filter(|s| s.given)
        .flat_map(|s| [s.from, s.to])
        .collect();
    while let Some(i) = layout
        .streets
        .iter()
        .position(|s| !s.given && (own.contains(&s.from) || own.contains(&s.to)))
    {
        remove_street(layout, i);
    }
}

#[test]
fn streets_that_lead_nowhere() {
    let certificate = judged(|_, layout| cut_off_collector(layout));
    // The other streets reach the boundary, but not where a street is given.
    for law in ["exits", "networks"] {
        assert!(failed(&certificate).contains(&law), "{certificate}");
    }
    // Where nothing is given, they lead out.
    let certificate = judged(|site, layout| {
        cut_off_collector(layout);
        site.outside_streets.clear();
        site.roads.clear();
    });
    assert!(!failed(&certificate).contains(&"exits"), "{certificate}");
    assert!(failed(&certificate).contains(&"networks"), "{certificate}");
}

#[test]
fn an_exit_is_where_a_street_is_given() {
    let (mut site, layout) = Town::default().build();
    site.roads.clear();
    let options = CheckOptions::default();
    assert!(check(&site, &layout, &options).is_ok());
    // An outside street at the boundary, but far from any street end.
    let line = &mut site.outside_streets[0].line.0;
    line.iter_mut().for_each(|c| c.y += 45.0);
    let failed: Vec<_> = check(&site, &layout, &options)
        .failed()
        .map(|law| law.law)
        .collect();
    assert!(
        failed.contains(&"exits") && failed.contains(&"frontage"),
        "{failed:?}"
    );
    // A street outside that never comes near is as none.
    site.outside_streets[0]
        .line
        .0
        .iter_mut()
        .for_each(|c| c.x -= 500.0);
    assert!(check(&site, &layout, &options).is_ok());
}

#[test]
fn street_area_without_streets() {
    let certificate = judged(|_, layout| {
        layout.streets.clear();
        layout.junctions.clear();
    });
    for law in ["served_area", "frontage", "given_roads"] {
        assert!(failed(&certificate).contains(&law), "{certificate}");
    }
}

#[test]
fn a_landlocked_parcel() {
    let certificate = judged(|_, layout| {
        let i = first_parcel(layout);
        // The lowest row fronts north: cut off its southern half.
        let ring = layout.tiles[i].polygon.exterior().0.clone();
        let half = |a: Coord<f64>, b: Coord<f64>| Coord {
            x: (a.x + b.x) / 2.0,
            y: (a.y + b.y) / 2.0,
        };
        let (left, right) = (half(ring[0], ring[3]), half(ring[1], ring[2]));
        let south = vec![ring[0], ring[1], right, left];
        let north = vec![left, right, ring[2], ring[3]];
        layout.tiles[i].polygon = Polygon::new(LineString::new(north), vec![]);
        let mut other: Tile = layout.tiles[i].clone();
        other.id = 5;
        other.polygon = Polygon::new(LineString::new(south), vec![]);
        layout.tiles.push(other);
    });
    let law = certificate.law("frontage").expect("a law");
    assert_eq!((law.passed, law.measured), (false, 1.0), "{certificate}");
    assert_eq!(certificate.without_access, vec![5]);
}

#[test]
fn access_from_outside_counts() {
    let (mut site, mut layout) = Town::default().build();
    let i = first_parcel(&layout);
    let front = layout.tiles[i].polygon.exterior().0[0];
    layout.streets.clear();
    layout.junctions.clear();
    let without = |site: &Site| {
        check(site, &layout, &CheckOptions::default())
            .without_access
            .len()
    };
    let all = without(&site);
    // A street along the lower boundary of the first two parcels; the first has
    // access from the street in the west already.
    let line = vec![
        Coord {
            x: front.x + 2.0,
            y: front.y - 8.0,
        },
        Coord {
            x: front.x + 22.0,
            y: front.y - 8.0,
        },
    ];
    site.outside_streets.push(GivenRoad {
        line: LineString::new(line),
        class: RoadClass::Local,
        width: 12.0,
        name: None,
        feature: 4,
    });
    assert_eq!(without(&site), all - 1);
}

#[test]
fn too_many_exempt_parcels() {
    breaks(&["exempt"], |_, layout| {
        for tile in layout
            .tiles
            .iter_mut()
            .filter(|t| t.kind == TileKind::Parcel)
            .take(9)
        {
            tile.parcel.as_mut().expect("a parcel").access_exempt = true;
        }
    });
}

#[test]
fn a_given_lake_drained() {
    breaks(&["given_elements"], |_, layout| {
        for tile in layout.tiles.iter_mut().filter(|t| t.kind == TileKind::Lake) {
            tile.kind = TileKind::Other;
        }
    });
}

#[test]
fn a_given_road_not_built() {
    breaks(&["given_roads"], |site, _| {
        let mut road = site.roads[0].clone();
        road.line.0.iter_mut().for_each(|c| c.y += 3.0);
        site.roads.push(road);
    });
}

#[test]
fn a_dead_stub() {
    let shorten = |class: RoadClass| {
        move |_: &mut Site, layout: &mut Layout| {
            let i = layout
                .streets
                .iter()
                .position(|s| {
                    !s.given
                        && layout
                            .junctions
                            .iter()
                            .any(|j| j.id == s.from && j.degree == 1)
                })
                .expect("a street from the boundary");
            let line = &mut layout.streets[i].line.0;
            line[0].x += 0.3 * (line[1].x - line[0].x);
            line[0].y += 0.3 * (line[1].y - line[0].y);
            let (id, at) = (layout.streets[i].from, layout.streets[i].line.0[0]);
            layout.streets[i].class = class;
            layout
                .junctions
                .iter_mut()
                .find(|j| j.id == id)
                .expect("a junction")
                .at = at;
        }
    };
    breaks(&["stubs"], shorten(RoadClass::Local));
    breaks(&[], shorten(RoadClass::CulDeSac));
}

/// Divides a street by a junction so many metres after its start.
fn divide(layout: &mut Layout, number: usize, metres: f64) {
    let street = layout.streets[number].clone();
    let (a, b) = (street.line.0[0], street.line.0[1]);
    let t = metres / (b.x - a.x).hypot(b.y - a.y);
    let at = Coord {
        x: a.x + t * (b.x - a.x),
        y: a.y + t * (b.y - a.y),
    };
    layout.junctions.push(Junction {
        id: 1,
        at,
        degree: 2,
    });
    layout.streets[number].line.0 = vec![a, at];
    layout.streets[number].to = 1;
    let rest = Street {
        id: 2,
        line: LineString::new(vec![at, b]),
        from: 1,
        ..street
    };
    layout.streets.push(rest);
}

#[test]
fn crowded_junctions() {
    let split = |metres: f64| {
        move |_: &mut Site, layout: &mut Layout| divide(layout, inner_street(layout), metres)
    };
    breaks(&["junction_spacing"], split(14.0));
    breaks(&[], split(16.0));
    // Two junctions of given roads alone are the site's own affair.
    breaks(&[], |_, layout| {
        let i = layout
            .streets
            .iter()
            .position(|s| s.given)
            .expect("a given street");
        let line = layout.streets[i].line.0.clone();
        layout.streets[i].line.0 = vec![line[0], line[1]];
        let far = layout.streets[i].to;
        layout.streets[i].to = 3;
        layout.junctions.push(Junction {
            id: 3,
            at: line[1],
            degree: 2,
        });
        let rest = Street {
            id: 4,
            line: LineString::new(line[1..].to_vec()),
            from: 3,
            to: far,
            ..layout.streets[i].clone()
        };
        layout.streets.push(rest);
        let i = layout.streets.len() - 1;
        let a = layout.streets[i].line.0[0];
        let b = layout.streets[i].line.0[1];
        let at = Coord {
            x: (a.x + b.x) / 2.0,
            y: (a.y + b.y) / 2.0,
        };
        let rest = layout.streets[i].clone();
        layout.streets[i].line.0 = vec![a, at];
        layout.streets[i].to = 1;
        let mut line = vec![at];
        line.extend(&rest.line.0[1..]);
        layout.streets.push(Street {
            id: 2,
            line: LineString::new(line),
            from: 1,
            ..rest
        });
        layout.junctions.push(Junction {
            id: 1,
            at,
            degree: 2,
        });
    });
}

#[test]
fn streets_that_meet_at_a_sharp_angle() {
    breaks(&["meeting_angle"], |_, layout| {
        let i = inner_street(layout);
        // 6 m to the side over the first 9 m, and gently back.
        bend(
            layout,
            i,
            &[
                (9.0 / 75.0, 6.5),
                (18.0 / 75.0, 7.4),
                (0.4, 7.4),
                (0.7, 4.0),
            ],
        );
    });
    breaks(&[], |_, layout| {
        let i = inner_street(layout);
        bend(layout, i, &[(0.5, 3.0)]);
    });
}

#[test]
fn a_sharp_turn() {
    breaks(&["sharp_turns"], |_, layout| {
        let i = inner_street(layout);
        // 47 degrees to the right, then gently back over more than 30 m.
        bend(
            layout,
            i,
            &[(17.0 / 75.0, 6.2), (27.7 / 75.0, 0.75), (47.1 / 75.0, -3.9)],
        );
    });
}

#[test]
fn a_zigzag() {
    breaks(&["zigzags"], |_, layout| {
        let i = inner_street(layout);
        bend(
            layout,
            i,
            &[(25.0 / 75.0, -1.0), (35.0 / 75.0, 5.0), (50.0 / 75.0, 5.0)],
        );
    });
}

#[test]
fn nothing_at_all_is_judged_without_a_panic() {
    let (site, _) = Town::default().build();
    let certificate = check(&site, &Layout::default(), &CheckOptions::default());
    assert!(failed(&certificate).contains(&"gap"));
    let certificate = judged(|_, layout| {
        layout.streets[0].line.0.clear();
        layout.streets[1].line.0.truncate(1);
        layout.tiles[0].polygon = Polygon::new(LineString::new(vec![]), vec![]);
        layout.tiles[1].polygon = Polygon::new(
            LineString::new(vec![
                Coord {
                    x: f64::NAN,
                    y: 0.0
                };
                4
            ]),
            vec![],
        );
    });
    assert!(!certificate.is_ok());
}
