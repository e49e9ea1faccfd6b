//! What paths leave between them, and how the sides of that are counted.
//!
//! The notes' alternative, with signed indices: corner 0 is at the centre, side 1
//! the first one clockwise from there, side -1 the first one counter-clockwise,
//! and side 0 the centre's own boundary where it has a size. Negative numbers
//! count from the last side, so that `EDGE[-1]` is what they want; where the
//! centre has no size no edge has the number 0, and corner 0 is where side 1
//! begins. Of a cell at several centres the first in the order of centres counts;
//! one at none begins with its longest side on the boundary, as Voronoi cells do.
//!
//! In local coordinates (0, 0) is at the centre, (0, 1) where side 1 ends, (1, 0)
//! where side -1 does, and (1, 1) the corner between them, or half way.

use geo_types::Coord;

use super::network::Path;
use crate::plane::{
    cross, dist, intersection, lerp, nearest_on, quad_is_convex, sides, signed_area, stroke, unit,
    Area,
};
use crate::rule::runs::{self, Run};
use crate::rule::sites::part_at;
use crate::shape::{Heritage, Local, Region, Role};

/// Edges this near to something, as a share of the region's size, are on it.
const ON: f64 = 1e-7;

/// A path goes on so many widths beyond the boundary, to be cut off along it.
const BEYOND: f64 = 2.0;

/// The land of a path in an area: of what its width covers the part that can be
/// walked to, not that behind a fence. It is round where it begins, at bends, and
/// at an end that does not go on over the boundary; but not in `covered` centres,
/// whose shapes are as wide.
pub(super) fn land(
    path: &Path,
    width: f64,
    area: &Area,
    size: f64,
    covered: &dyn Fn(usize) -> bool,
) -> Vec<Area> {
    let line = extended(path, BEYOND * width);
    let mut found = Vec::new();
    for pair in line.windows(2) {
        found.extend(stroke(pair, width, false));
    }
    let inner = line.len() - usize::from(path.leaves);
    for k in 0..inner {
        let centre = match k {
            0 => path.centres[0],
            _ if k + 1 == line.len() => path.centres[1],
            _ => None,
        };
        if centre.is_some_and(covered) {
            continue;
        }
        let way = line[(k + 1).min(line.len() - 1)] - line[k.saturating_sub(1)];
        found.push(disc(line[k], 0.5 * width, unit(way)));
    }
    let mut found = intersection(&found, std::slice::from_ref(area));
    if found.len() > 1 {
        let near = ON * size;
        let middles: Vec<Coord<f64>> = path
            .line
            .windows(2)
            .map(|pair| lerp(pair[0], pair[1], 0.5))
            .collect();
        let walked = |part: &Area| {
            let on = |&at: &Coord<f64>| part.contains(at) || part.nearest(at).1 <= near;
            middles.iter().any(on)
        };
        found.retain(walked);
    }
    found
}

/// A circle whose polygon turns with a path.
fn disc(at: Coord<f64>, radius: f64, along: Coord<f64>) -> Area {
    let corner = |k: i32| {
        let (sin, cos) = f64::from(10 * k).to_radians().sin_cos();
        let turned = Coord {
            x: along.x * cos - along.y * sin,
            y: along.x * sin + along.y * cos,
        };
        at + turned * radius
    };
    Area::new((0..36).map(corner).collect(), Vec::new())
}

/// A path's line, longer where it goes on over the boundary.
pub(super) fn extended(path: &Path, by: f64) -> Vec<Coord<f64>> {
    let mut line = path.line.clone();
    if let (true, [.., before, end]) = (path.leaves, line.as_mut_slice()) {
        *end = *end + unit(*end - *before) * by;
    }
    line
}

/// A shape in the area, of its parts the one at a place, without what others have
/// taken.
pub(super) fn clipped(shape: &Area, area: &Area, at: Coord<f64>, taken: &[Area]) -> Option<Area> {
    let inside = intersection(std::slice::from_ref(shape), std::slice::from_ref(area));
    let whole = part_at(inside, at)?;
    let free = crate::plane::difference(&[whole], taken);
    part_at(free, at)
}

/// What an edge of a cell borders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Label {
    Centre(usize),
    /// A path, on its left or not.
    Path(usize, bool),
    /// A side of the region that was divided; of a hole without a number.
    Boundary(Option<usize>),
}

/// What cells lie between.
pub(super) struct Between<'a> {
    pub(super) region: &'a Region,
    pub(super) heritage: &'a Heritage<'a>,
    pub(super) paths: &'a [Path],
    /// Where centres are, and what land they have, if any.
    pub(super) centres: &'a [Coord<f64>],
    pub(super) lands: &'a [Option<Area>],
    pub(super) width: f64,
    pub(super) size: f64,
}

impl Between<'_> {
    /// A cell as a region.
    pub(super) fn cell(&self, area: Area) -> Region {
        let role = |a: Coord<f64>, b: Coord<f64>| {
            Some(match self.label(a, b) {
                Label::Centre(_) => Role::Centre,
                _ if self.width > 0.0 => Role::Path,
                _ => Role::Seam,
            })
        };
        let mut cell = self.heritage.piece(area, self.region.local, role);
        let labels: Vec<Label> = sides(cell.ring(0)).map(|(a, b)| self.label(a, b)).collect();
        let runs = runs::runs(&cell, &labels);
        let mirrored = self.region.local.mirrored();
        if let Some((start, from, centre)) = self.start(&runs, mirrored) {
            cell.local = self.local(&cell, &runs, start, from, centre);
            // What is counted must not depend on what the quad looks like.
            if cell.local.mirrored() != mirrored {
                cell.local = cell.local.flipped(true, false);
            }
            runs::number(&mut cell, &runs, start, from);
        } else {
            let outer = runs::longest(&runs, |label| matches!(label, Label::Boundary(_)));
            let start = outer
                .or_else(|| runs::longest(&runs, |_| true))
                .unwrap_or(0);
            if let Some(run) = runs.get(start) {
                cell.local = runs::local_beside(&cell, run, mirrored);
                runs::number(&mut cell, &runs, start, 0);
            }
        }
        for ring in cell.edges.iter_mut().skip(1) {
            ring.iter_mut().for_each(|edge| edge.side = None);
        }
        cell
    }

    fn label(&self, a: Coord<f64>, b: Coord<f64>) -> Label {
        if let Some(edge) = self.heritage.source(a, b) {
            return Label::Boundary(edge.side);
        }
        let middle = lerp(a, b, 0.5);
        let on = ON * self.size;
        let centre = self.lands.iter().position(|land| {
            let land = land.as_ref();
            land.is_some_and(|land| land.nearest(middle).1 <= on)
        });
        if let Some(k) = centre {
            return Label::Centre(k);
        }
        let mut best = (f64::INFINITY, Label::Boundary(None));
        for (k, path) in self.paths.iter().enumerate() {
            for pair in path.line.windows(2) {
                let away = dist(nearest_on(pair[0], pair[1], middle), middle);
                if away < best.0 {
                    let left = cross(pair[1] - pair[0], middle - pair[0]) > 0.0;
                    best = (away, Label::Path(k, left));
                }
            }
        }
        best.1
    }

    /// The run from which sides are counted, its number, and the centre that the
    /// cell lies at.
    fn start(&self, runs: &[Run<Label>], mirrored: bool) -> Option<(usize, usize, usize)> {
        let n = runs.len();
        let mut best: Option<(usize, f64, usize, usize)> = None;
        let mut offer = |centre: usize, rank: f64, run: usize, from: usize| {
            let better = best.is_none_or(|(c, r, _, _)| (centre, rank) < (c, r));
            if better {
                best = Some((centre, rank, run, from));
            }
        };
        for (k, run) in runs.iter().enumerate() {
            if let Label::Centre(centre) = run.label {
                offer(centre, -run.length, k, 0);
            }
            // The corner where this run begins.
            let before = (k + n - 1) % n;
            let (Label::Path(p, _), Label::Path(q, _)) = (runs[before].label, run.label) else {
                continue;
            };
            if n < 2 {
                continue;
            }
            for centre in self.paths[p].centres.into_iter().flatten() {
                let both = self.paths[q].centres.contains(&Some(centre));
                if both && self.lands[centre].is_none() {
                    let away = dist(run.ends[0], self.centres[centre]);
                    let first = if mirrored { before } else { k };
                    offer(centre, away, first, 1);
                }
            }
        }
        best.map(|(centre, _, run, from)| (run, from, centre))
    }

    /// Coordinates from the centre outwards.
    fn local(
        &self,
        cell: &Region,
        runs: &[Run<Label>],
        start: usize,
        from: usize,
        centre: usize,
    ) -> Local {
        let n = runs.len();
        let mirrored = self.region.local.mirrored();
        // Side 1 and side -1, and where each ends.
        let step = |k: usize, by: usize| {
            if mirrored {
                (k + n - by % n) % n
            } else {
                (k + by) % n
            }
        };
        let (one, last) = (step(start, 1 - from), step(start, n - 1));
        let ends = |run: usize| {
            let [a, b] = runs[run].ends;
            if mirrored {
                [b, a]
            } else {
                [a, b]
            }
        };
        let inner = if from == 0 {
            let [a, b] = ends(start);
            lerp(a, b, 0.5)
        } else {
            ends(one)[0]
        };
        let (first, second) = (ends(one)[1], ends(last)[0]);
        let outer: Vec<usize> = (0..n)
            .map(|k| step(one, k + 1))
            .take_while(|&k| k != last)
            .collect();
        let far = self.far(cell, runs, &outer, mirrored).unwrap_or(first);
        let quad = [inner, first, far, second];
        let turns = (signed_area(&quad) > 0.0) == mirrored;
        if one != last && turns && quad_is_convex(&quad) {
            return Local::new(quad);
        }
        // What is no quad has the coordinates of its box, seen from the centre.
        let out = unit(cell.area.centroid() - self.centres[centre]);
        let up = if out == Coord::default() {
            self.region.local.axes()[1]
        } else {
            out
        };
        let right = crate::plane::right(up);
        let x = if mirrored { -right } else { right };
        Local::new(crate::plane::named_by(
            crate::plane::box_along(cell.ring(0), x),
            x,
            up,
        ))
    }

    /// The corner between runs that lies nearest to their middle, or, of one run,
    /// the point half way.
    fn far(
        &self,
        cell: &Region,
        runs: &[Run<Label>],
        outer: &[usize],
        mirrored: bool,
    ) -> Option<Coord<f64>> {
        let whole: f64 = outer.iter().map(|&k| runs[k].length).sum();
        let mut passed = 0.0;
        let mut best: Option<(f64, Coord<f64>)> = None;
        for &k in outer.iter().take(outer.len().saturating_sub(1)) {
            passed += runs[k].length;
            let off = (passed - 0.5 * whole).abs();
            if best.is_none_or(|(least, _)| off < least) {
                best = Some((off, runs[k].ends[usize::from(!mirrored)]));
            }
        }
        if let Some((_, corner)) = best {
            return Some(corner);
        }
        let only = &runs[*outer.first()?];
        let ring = cell.ring(0);
        let mut left = 0.5 * only.length;
        for &edge in &only.edges {
            let (a, b) = (ring[edge], ring[(edge + 1) % ring.len()]);
            let long = dist(a, b);
            if left <= long && long > 0.0 {
                return Some(lerp(a, b, left / long));
            }
            left -= long;
        }
        Some(only.ends[1])
    }
}
