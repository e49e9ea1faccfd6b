//! For each law of parcels and other tiles a plan that breaks it.

mod judged;
mod synthetic;

use judged::{breaks, failed, judged};
use synthetic::Town;
use urban_layout::check::{check, CheckOptions};
use urban_layout::geo_types::{Coord, LineString, Polygon};
use urban_layout::layout::{Layout, Tile, TileKind};
use urban_layout::site::{GivenRoad, RoadClass, Site};

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
