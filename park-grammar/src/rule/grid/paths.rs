//! The paths of a grid: what its region has besides cells and centres.

use std::collections::BTreeSet;

use super::cells::{Lattice, Piece, ON};
use super::*;
use crate::derive::Watch;

impl Lattice {
    /// What of areas neither cells nor whole centres cover.
    ///
    /// It is had as a difference, so that nothing is lost. Of a large grid most
    /// cells lie within: where no centre meets them they are holes of the paths as
    /// they are, since cells lie a path's width apart, and only those at the edge
    /// are cut out by a boolean.
    pub(super) fn paths(
        &self,
        watch: &Watch<'_>,
        inside: &[Area],
        cells: &[Piece],
        centres: &[Area],
    ) -> Result<Vec<Area>, Failure> {
        let on = ON * self.size;
        let within = |p: Coord<f64>| {
            let mut areas = inside.iter();
            areas.any(|area| area.keeps_away(p, on) && area.contains(p))
        };
        let mut holes = Vec::new();
        let mut at_edge = BTreeSet::new();
        for piece in cells {
            watch.tick()?;
            let area = &piece.area;
            if centres.is_empty() && area.holes.is_empty() && area.outer.iter().all(|&p| within(p))
            {
                holes.push(piece);
            } else {
                at_edge.insert(piece.cell.at);
            }
        }
        // A cell of which one part lies at the edge is cut out as a whole.
        holes.retain(|piece| !at_edge.contains(&piece.cell.at));
        let held: BTreeSet<[usize; 2]> = holes.iter().map(|piece| piece.cell.at).collect();
        let beside = self.beside(watch, inside, centres, |at| !held.contains(&at))?;
        let mut paths = difference(inside, &beside);
        for piece in holes {
            let ring = &piece.area.outer;
            let path = match paths.as_mut_slice() {
                [only] => Some(only),
                several => several.iter_mut().find(|path| path.contains(ring[0])),
            };
            if let Some(path) = path {
                let mut hole = ring.clone();
                hole[1..].reverse();
                path.holes.push(hole);
            }
        }
        Ok(paths)
    }

    /// All that paths do not cover: cells and centres that go on beyond the areas
    /// and overlap each other. Cells as the areas' edges and centres cut them have
    /// those edges up to rounding, which would leave paths as thin as a hair along
    /// them.
    fn beside(
        &self,
        watch: &Watch<'_>,
        inside: &[Area],
        centres: &[Area],
        wanted: impl Fn([usize; 2]) -> bool,
    ) -> Result<Vec<Area>, Failure> {
        let points: Vec<Coord<f64>> = inside
            .iter()
            .flat_map(|a| a.outer.iter().copied())
            .collect();
        let (low, high) = crate::plane::extent(&points);
        let more = (high - low) * 0.1
            + Coord {
                x: self.half,
                y: self.half,
            };
        let wide = box_along(&[low - more, high + more], Coord { x: 1.0, y: 0.0 });
        let wide = Area::new(wide.to_vec(), Vec::new());
        let mut found: Vec<Area> = self
            .some_cells(watch, &[wide], wanted)?
            .into_iter()
            .map(|piece| piece.area)
            .collect();
        found.extend_from_slice(centres);
        Ok(found)
    }

    /// What both paths cover at each crossing inside the areas; whole quads, which
    /// may go on beyond. Their corners are vertices of the paths, to the last
    /// digit, so that no hair joins the arms around a corner.
    pub(super) fn crossings(&self, inside: &[Area], paths: &[Area]) -> Vec<Area> {
        let mut vertices: Vec<Coord<f64>> = paths
            .iter()
            .flat_map(Area::rings)
            .flatten()
            .copied()
            .collect();
        vertices.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let on = ON * self.size;
        let vertex = |p: Coord<f64>| {
            let first = vertices.partition_point(|v| v.x < p.x - on);
            let near = vertices[first..].iter().take_while(|v| v.x <= p.x + on);
            let nearest = near.min_by(|a, b| dist(**a, p).total_cmp(&dist(**b, p)));
            nearest.filter(|v| dist(**v, p) <= on).copied().unwrap_or(p)
        };
        let sides = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
        let quad = |column: &Line, row: &Line| -> Option<Area> {
            let corner = |(x, y): (f64, f64)| {
                let met = column.moved(x * self.half).meets(&row.moved(y * self.half));
                met.map(vertex)
            };
            let ring: Option<Vec<Coord<f64>>> = sides.into_iter().map(corner).collect();
            Some(Area::new(ring?, Vec::new()))
        };
        let meetings = self.meetings(inside).into_iter();
        meetings
            .filter_map(|(column, row, _)| quad(column, row))
            .collect()
    }
}
