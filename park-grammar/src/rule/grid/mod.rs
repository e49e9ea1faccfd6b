//! `Grid(x, y) { regions } { paths } { centres }`: columns and rows with paths
//! between them.
//!
//! # What the notes ask, and what was decided
//!
//! Each dimension is a count (`3`), a count with sizes (`3 {2, 6, 2}`; a shorter
//! list begins again), sizes alone (as many as fit), or nothing; a range is drawn
//! by chance, and an angle makes a dividing line lean ([`sizes`]). Sizes are those
//! of the cells, between paths. They are scaled so that the grid fills its quad,
//! unless the flag `Exact` stands among the arguments: then the grid has its sizes
//! and lies in the middle of the quad, and what is left around it is a part of the
//! output `outside`. A dimension that is not said is divided into as many cells as
//! come nearest to `size` (4 m). The notes' nested grid has no dimensions at all.
//!
//! Which quad is fitted to a region that is none is the matter of
//! [`fit`](super::fit). Columns run along its x axis from side 0 to side 2, rows
//! along y from side 3 to side 1, as the region's own coordinates have them: in a
//! cell of a grid above, mirrored with it.
//!
//! The region is cut along one dividing line after the other, so that lines which
//! lean until they cross make a partition all the same. With the flag `Apart` lines
//! lean no more than keeps them from meeting their neighbours. A path is what is left
//! between two cuts, half its width on either side of a line; it is had as the
//! difference of the region and all else, so that nothing is lost.
//!
//! A centre is the shape that the third block begins with, at each crossing of
//! lines inside the region, as far as it lies in the region. A third block that
//! begins with no shape is done on the crossings themselves: the quads that both
//! paths cover, cut out of the paths. Without a third block, or with an empty one,
//! crossings are part of the paths, the notes' "normal regular crossroads".
//!
//! How cells that are mirror images stand to each other is the matter of
//! [`symmetry`].
//!
//! Outputs: cells, paths, centres, outside.
//!
//! # Cost
//!
//! With n cells of a convex region O(n log n), the difference for the paths among
//! it; concave regions need a boolean for each cut that meets a concave part.

mod cells;
mod paths;
mod sizes;
mod symmetry;

use geo_types::Coord;

use super::fit::{Fit, Fitting, Quad};
use super::{Arguments, Ask, Output, Partition, Primitive};
use crate::error::Failure;
use crate::plane::{
    box_along, difference, dist, intersection, named_by, quad_extent, split, Area, Line,
};
use crate::shape::{Heritage, Local, Region, Role};

use cells::{Centres, Lattice};
use sizes::{Cut, Dimension, Laying};
use symmetry::Symmetry;

/// More cells are a mistake.
const MOST: usize = 250_000;

/// What is smaller than this share of the region is rounding where a line passes
/// along its edge or through a vertex.
const SLIVER: f64 = 1e-12;

/// Metres of a cell in a dimension of which nothing is said.
const SIZE: f64 = 4.0;

pub(crate) fn grid(ask: &mut Ask<'_, '_>) -> Result<Partition, Failure> {
    let span = ask.operation.span;
    let scope = &mut ask.scope;
    let mut arguments = Arguments::new(ask.operation);
    let exact = arguments.flag(scope, "Exact")?;
    let apart = arguments.flag(scope, "Apart")?;
    let width = super::path_width(&mut arguments, scope, ask.path_width)?;
    let size = match arguments.named("size") {
        Some(expr) => positive(scope.metres(expr)?, expr.span, "size")?,
        None => SIZE,
    };
    let fitting = Fitting::read(&mut arguments, scope, Fit::Default)?;
    let symmetry = Symmetry::read(&mut arguments, scope)?;
    let mut dimensions = Vec::new();
    for _ in 0..2 {
        dimensions.push(match arguments.next() {
            Some(argument) => Dimension::read(scope, &argument.value)?,
            None => Dimension::default(),
        });
    }
    arguments.done()?;

    let region = scope.region;
    let fitted = fitting.cut(region, span)?;
    let extent = quad_extent(&fitted.quad);
    let mut cuts = Vec::new();
    for (k, dimension) in dimensions.iter().enumerate() {
        let laying = Laying {
            width,
            size,
            exact,
            apart: apart.then_some(extent[1 - k]),
        };
        let found = dimension.cuts(extent[k], &laying, scope.chance);
        cuts.push(found.map_err(|error| Failure::unfit(span, error))?);
    }
    let (x, y) = (&cuts[0], &cuts[1]);
    if x.cells().saturating_mul(y.cells()) > MOST {
        let error = format!("{} x {} cells are too many", x.cells(), y.cells());
        return Err(Failure::unfit(span, error));
    }
    let lattice = Lattice::new(fitted.quad, x, y, 0.5 * width);
    let (inside, rest) = if exact {
        lattice.framed(&fitted.inside)
    } else {
        (fitted.inside, Vec::new())
    };
    let shape = ask.centre;
    let whole = shape.map_or_else(Vec::new, |shape| lattice.whole_centres(&inside, shape));
    let mut centres = cells::clipped_centres(&whole, &inside);
    let watch = scope.watch();
    let cells = lattice.cells(&watch, &inside)?;
    let mut paths = if width > 0.0 {
        lattice.paths(&watch, &inside, &cells, &whole)?
    } else {
        Vec::new()
    };
    if shape.is_none() && ask.centred {
        let crossings = lattice.crossings(&inside, &paths);
        centres = intersection(&crossings, &paths);
        paths = difference(&paths, &crossings);
    }
    let near = Centres::new(&whole);
    let mut cells = cells::without(cells, &near);
    let least = SLIVER * region.area.size();
    cells.retain(|cell| cell.area.size() > least);
    if cells.is_empty() {
        let error = "the paths and centres of the grid leave no room for cells";
        return Err(Failure::unfit(span, error));
    }

    let heritage = Heritage::new(region, "Grid");
    let mut regions = Vec::with_capacity(cells.len());
    for cell in cells {
        watch.tick()?;
        regions.push(lattice.region(&heritage, cell, &near, &symmetry));
    }
    let [along, up] = Local::new(lattice.quad).axes();
    let plain = |areas: Vec<Area>, role: Role| -> Vec<Region> {
        let piece = |area| piece(&heritage, area, [along, up], role);
        let solid = areas.into_iter().filter(|area| area.size() > least);
        solid.map(piece).collect()
    };
    let outside = fitted.outside.into_iter().chain(rest).collect();
    Ok(Partition {
        outputs: vec![
            Output::lawns(regions),
            Output::paths(plain(paths, Role::Path)),
            Output::paths(plain(centres, Role::Centre)),
            Output::lawns(plain(outside, Role::Seam)),
        ],
    })
}

/// A piece with the coordinates of its box along axes.
pub(crate) fn piece(
    heritage: &Heritage<'_>,
    area: Area,
    [x, y]: [Coord<f64>; 2],
    role: Role,
) -> Region {
    let corners = named_by(box_along(&area.outer, x), x, y);
    let mut region = heritage.piece(area, Local::new(corners), |_, _| Some(role));
    crate::index::by_local(&mut region);
    region
}

fn positive(value: f64, span: crate::syntax::ast::Span, what: &str) -> Result<f64, Failure> {
    if value > 0.0 {
        Ok(value)
    } else {
        Err(Failure::fault(span, format!("{what} must be positive")))
    }
}

#[cfg(test)]
mod tests;
