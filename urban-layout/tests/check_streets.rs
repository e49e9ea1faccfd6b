//! For each law of streets and junctions a plan that breaks it.

mod judged;
mod synthetic;

use judged::{breaks, failed, judged};
use synthetic::Town;
use urban_layout::check::{check, CheckOptions};
use urban_layout::geo_types::{Coord, LineString};
use urban_layout::layout::{Junction, Layout, Street};
use urban_layout::site::{RoadClass, Site};

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
