//! Cutting areas along lines without a width.

use geo_types::Coord;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::solver::Solver;
use i_overlay::float::overlay::OverlayOptions;
use i_overlay::float::slice::FloatSlice;

use super::{Area, Ring};

/// What lines cut areas into. A line that ends inside cuts nothing off.
pub(crate) fn sliced(areas: &[Area], lines: &[Vec<Coord<f64>>]) -> Vec<Area> {
    let pairs =
        |points: &[Coord<f64>]| -> Vec<[f64; 2]> { points.iter().map(|c| [c.x, c.y]).collect() };
    let shapes: Vec<Vec<Vec<[f64; 2]>>> = areas
        .iter()
        .map(|area| area.rings().map(|ring| pairs(ring)).collect())
        .collect();
    let lines: Vec<Vec<[f64; 2]>> = lines.iter().map(|line| pairs(line)).collect();
    if lines.is_empty() {
        return areas.to_vec();
    }
    let mut options = OverlayOptions::<f64, i64>::ogc();
    options.preserve_output_collinear = true;
    let found =
        shapes.slice_custom_by_as::<i64>(&lines, FillRule::NonZero, options, Solver::default());
    let coords =
        |ring: &Vec<[f64; 2]>| -> Ring { ring.iter().map(|&[x, y]| Coord { x, y }).collect() };
    let areas = found.iter().filter_map(|rings| {
        let (outer, holes) = rings.split_first()?;
        let area = Area::new(coords(outer), holes.iter().map(coords).collect());
        (area.size() > 0.0).then_some(area)
    });
    areas.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn line(points: &[(f64, f64)]) -> Ring {
        points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect()
    }

    /// Three lines from one point to beyond the edges make three pieces; one that
    /// ends inside makes none more.
    #[test]
    fn stars_cut_into_pieces() {
        let square = Area::new(
            line(&[(0., 0.), (0., 10.), (10., 10.), (10., 0.)]),
            Vec::new(),
        );
        let mut lines = vec![
            line(&[(5., 5.), (5., 11.)]),
            line(&[(5., 5.), (11., 5.)]),
            line(&[(5., 5.), (-1., 5.)]),
        ];
        let sizes = |lines: &[Ring]| -> Vec<f64> {
            let found = sliced(std::slice::from_ref(&square), lines);
            let mut sizes: Vec<f64> = found.iter().map(Area::size).collect();
            sizes.sort_by(f64::total_cmp);
            sizes
        };
        assert_eq!(sizes(&lines), [25.0, 25.0, 50.0]);
        lines.push(line(&[(5., 5.), (5., 2.)]));
        assert_eq!(sizes(&lines), [25.0, 25.0, 50.0]);
        // A closed line cuts out what lies in it.
        let ring = line(&[(2., 2.), (4., 2.), (4., 4.), (2., 4.), (2., 2.)]);
        assert_eq!(sizes(&[ring]), [4.0, 96.0]);
    }
}
