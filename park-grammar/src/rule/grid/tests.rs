//! Cells of grids on rectangles: what is mirrored is mirrored wholly.

use super::cells::without;
use super::sizes::Cuts;
use super::*;
use crate::derive::{DeriveOptions, Limits, Watch};
use crate::select::named;
use crate::shape::Cell;
use geo_types::coord;

/// 84 x 60 m.
const SIZE: [f64; 2] = [84.0, 60.0];

fn rectangle() -> Region {
    let [x, y] = SIZE;
    let ring = vec![
        coord! { x: 0., y: 0. },
        coord! { x: 0., y: y },
        coord! { x: x, y: y },
        coord! { x: x, y: 0. },
    ];
    let mut region = Region::bare(Area::new(ring, Vec::new()));
    crate::index::park(&mut region);
    region
}

fn even(count: usize, extent: f64, width: f64) -> Cuts {
    let size = (extent - width * (count - 1) as f64) / count as f64;
    let at = |k: usize| (k + 1) as f64 * size + (k as f64 + 0.5) * width;
    Cuts {
        from: 0.0,
        to: extent,
        extent,
        lines: (0..count - 1)
            .map(|k| Cut {
                at: at(k),
                lean: 0.0,
            })
            .collect(),
    }
}

/// The cells of a grid with a romb at each crossing.
fn cells(of: [usize; 2]) -> Vec<Region> {
    let region = rectangle();
    let cuts = [0, 1].map(|k| even(of[k], SIZE[k], 2.0));
    let lattice = Lattice::new(region.local.corners, &cuts[0], &cuts[1], 1.0);
    let inside = [region.area.clone()];
    let centres = lattice.whole_centres(&inside, Primitive::Romb(3.0));
    assert_eq!(centres.len(), (of[0] - 1) * (of[1] - 1));
    let heritage = Heritage::new(&region, "Grid");
    let symmetry = Symmetry::default();
    let options = DeriveOptions::default();
    let limits = Limits::new(&options, &|_| true);
    let watch = Watch::new(&limits, &"Region".into());
    let near = Centres::new(&centres);
    let all = lattice.cells(&watch, &inside).expect("time enough");
    without(all, &near)
        .into_iter()
        .map(|piece| lattice.region(&heritage, piece, &near, &symmetry))
        .collect()
}

fn mirrored(p: Coord<f64>, axis: usize) -> Coord<f64> {
    if axis == 0 {
        coord! { x: SIZE[0] - p.x, y: p.y }
    } else {
        coord! { x: p.x, y: SIZE[1] - p.y }
    }
}

/// The edges that a selection holds, as sorted pairs of ends.
fn ends(
    region: &Region,
    selection: &crate::select::Selection,
    axis: Option<usize>,
) -> Vec<[i64; 4]> {
    let mut found = Vec::new();
    for line in selection.lines(region) {
        for pair in line.windows(2) {
            let mut ends: Vec<(i64, i64)> = pair
                .iter()
                .map(|&p| axis.map_or(p, |axis| mirrored(p, axis)))
                .map(|p| ((p.x * 1e6).round() as i64, (p.y * 1e6).round() as i64))
                .collect();
            ends.sort_unstable();
            found.push([ends[0].0, ends[0].1, ends[1].0, ends[1].1]);
        }
    }
    found.sort_unstable();
    found
}

/// `EDGE[k]`, `OUTER` and every local point of a cell lie mirrored in its mirror
/// image, in grids of 2 x 2 up to 5 x 5, on both axes; and a cell on an axis is
/// its own mirror image.
#[test]
fn selections_and_places_are_mirrored() {
    for of in (2..=5).flat_map(|x| (2..=5).map(move |y| [x, y])) {
        let all = cells(of);
        assert_eq!(all.len(), of[0] * of[1]);
        for region in &all {
            let cell = region.cell.expect("a cell");
            for axis in 0..2 {
                let mut at = cell.at;
                at[axis] = of[axis] - 1 - at[axis];
                let image = all.iter().find(|r| r.cell == Some(Cell { at, of }));
                let image = image.expect("its image");
                for side in 0..4 {
                    let here = ends(region, &named::sides(region, &[side]), None);
                    let there = ends(image, &named::sides(image, &[side]), Some(axis));
                    assert_eq!(here, there, "side {side} of {cell:?}, axis {axis}");
                }
                for name in ["OUTER", "INNER", "EDGE"] {
                    let of = |r: &Region| named::named(r, name).expect("a selector");
                    let (here, there) = (
                        ends(region, &of(region), None),
                        ends(image, &of(image), Some(axis)),
                    );
                    assert_eq!(here, there, "{name} of {cell:?}, axis {axis}");
                }
                for (x, y) in [(0.0, 0.0), (0.8, 0.1), (0.3, 1.0)] {
                    let at = coord! { x: x, y: y };
                    let here = region.local.point(at).expect("lies here");
                    let there = image.local.point(at).expect("lies there");
                    assert!(dist(here, mirrored(there, axis)) < 1e-9, "{cell:?}");
                }
            }
        }
    }
}

/// What a romb cuts off at 45 degrees belongs to side 2 in all four quadrants:
/// the side that faces along x.
#[test]
fn edges_of_45_degrees_belong_to_one_side() {
    for region in cells([2, 2]) {
        let east = named::sides(&region, &[2]);
        // 29 m of height less 1, and the slant over 1 x 1.
        let wanted = 28.0 + std::f64::consts::SQRT_2;
        assert!((east.length() - wanted).abs() < 1e-9, "{}", east.length());
        let marks = region.edges(0).flat_map(|(_, _, edge)| &edge.origin.marks);
        let roles: Vec<Role> = marks.map(|mark| mark.role).collect();
        let count = |role| roles.iter().filter(|r| **r == role).count();
        assert_eq!((count(Role::Path), count(Role::Centre)), (2, 1));
    }
}

/// Edges of the region keep what they were.
#[test]
fn cells_know_the_boundary() {
    for region in cells([3, 3]) {
        let outer = named::named(&region, "OUTER").expect("a selector");
        let metric = region.cell.expect("a cell").metric();
        let sides = metric.iter().filter(|m| **m == 0).count();
        let found: Vec<usize> = region
            .edges(0)
            .filter_map(|(_, _, edge)| edge.origin.boundary)
            .collect();
        assert_eq!(
            (found.len(), outer.stretches().is_empty()),
            (sides, sides == 0)
        );
    }
}
