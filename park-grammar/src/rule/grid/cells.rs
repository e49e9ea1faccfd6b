//! The dividing lines of a grid in its quad, and what they cut a region into.

use super::symmetry::{number_sides, Symmetry};
use super::*;
use crate::derive::Watch;
use crate::plane::{lerp, quad_angles, quad_area, quad_coordinates, quad_is_convex, quad_point};
use crate::shape::Cell;

/// Points this near to a line, as a share of the quad's size, are on it.
pub(super) const ON: f64 = 1e-7;

/// A cell that fills less than this share of its quad has been cut off by the
/// region's edge, and not just by a centre.
const FULL: f64 = 0.85;

/// A grid's lines in its quad.
#[derive(Debug)]
pub(super) struct Lattice {
    pub(super) quad: Quad,
    /// Between columns and between rows, each with the lower cells on its left.
    pub(super) lines: [Vec<Line>; 2],
    /// Where the grid begins and ends along x and y, in the same way.
    ends: [[Line; 2]; 2],
    /// Whether the grid ends before its quad does, along x and along y.
    short: [bool; 2],
    /// Half the width of a path.
    pub(super) half: f64,
    /// Size of the quad.
    pub(super) size: f64,
}

/// A cell, or one of the parts that a region of any shape leaves of it.
#[derive(Debug)]
pub(super) struct Piece {
    pub(super) area: Area,
    pub(super) cell: Cell,
}

impl Lattice {
    pub(super) fn new(quad: Quad, x: &sizes::Cuts, y: &sizes::Cuts, half: f64) -> Self {
        let sign = if Local::new(quad).mirrored() {
            -1.0
        } else {
            1.0
        };
        let [a, b, c, d] = quad;
        let line = |cut: Cut, extent: f64, [from, to]: [[Coord<f64>; 2]; 2]| {
            let share = cut.at / extent;
            let (p, q) = (lerp(from[0], from[1], share), lerp(to[0], to[1], share));
            let (sin, cos) = (sign * cut.lean).sin_cos();
            let along = (q - p) * sign;
            let turned = Coord {
                x: along.x * cos - along.y * sin,
                y: along.x * sin + along.y * cos,
            };
            // A line leans about its middle.
            Line::new(lerp(p, q, 0.5), turned)
        };
        // Columns: lines that go up have what is lower along x on their left.
        // Rows: those that go down along x have what is lower along y there.
        let rails = [[[a, d], [b, c]], [[d, c], [a, b]]];
        let of = |k: usize, cuts: &sizes::Cuts| {
            let end = |at| line(Cut { at, lean: 0.0 }, cuts.extent, rails[k]);
            let lines = cuts
                .lines
                .iter()
                .map(|&cut| line(cut, cuts.extent, rails[k]));
            (lines.collect(), [end(cuts.from), end(cuts.to)])
        };
        let ((columns, x_ends), (rows, y_ends)) = (of(0, x), of(1, y));
        Self {
            quad,
            lines: [columns, rows],
            ends: [x_ends, y_ends],
            short: [x, y].map(|cuts| cuts.from > ON * cuts.extent),
            half,
            size: dist(a, c).max(dist(b, d)),
        }
    }

    /// What of areas lies between the ends of the grid, and what does not.
    pub(super) fn framed(&self, areas: &[Area]) -> (Vec<Area>, Vec<Area>) {
        let mut within = areas.to_vec();
        let mut rest = Vec::new();
        let short = self.ends.iter().zip(self.short).filter(|(_, short)| *short);
        for ([from, to], _) in short {
            let [before, after] = split(&within, from, 0.0);
            let [between, beyond] = split(&after, to, 0.0);
            rest.extend(before.into_iter().chain(beyond));
            within = between;
        }
        (within, rest)
    }

    /// The lines that meet inside the areas, and where.
    pub(super) fn meetings(&self, inside: &[Area]) -> Vec<(&Line, &Line, Coord<f64>)> {
        let mut found = Vec::new();
        for column in &self.lines[0] {
            let crossings = self.lines[1].iter();
            let crossings = crossings.filter_map(|row| Some((column, row, column.meets(row)?)));
            found.extend(crossings.filter(|(_, _, at)| inside.iter().any(|a| a.contains(*at))));
        }
        found
    }

    /// The shape at each crossing inside the areas; whole ones, which may go on
    /// beyond and overlap.
    pub(super) fn whole_centres(&self, inside: &[Area], shape: Primitive) -> Vec<Area> {
        let meetings = self.meetings(inside).into_iter();
        meetings.map(|(_, _, at)| self.placed(shape, at)).collect()
    }

    /// A shape whose upright is that of the grid, mirrored with it.
    fn placed(&self, shape: Primitive, at: Coord<f64>) -> Area {
        let local = Local::new(self.quad);
        let [along, _] = local.axes();
        let sign = if local.mirrored() { 1.0 } else { -1.0 };
        let up = crate::plane::right(along) * sign;
        let upright = shape.ring(Coord::default(), 0.0);
        let ring = upright.iter().map(|p| at + along * p.x + up * p.y);
        Area::new(ring.collect(), Vec::new())
    }

    /// The cells of areas.
    pub(super) fn cells(&self, watch: &Watch<'_>, inside: &[Area]) -> Result<Vec<Piece>, Failure> {
        self.some_cells(watch, inside, |_| true)
    }

    /// The cells of areas for which `wanted` holds, by column and row.
    pub(super) fn some_cells(
        &self,
        watch: &Watch<'_>,
        inside: &[Area],
        wanted: impl Fn([usize; 2]) -> bool,
    ) -> Result<Vec<Piece>, Failure> {
        let of = [self.lines[0].len() + 1, self.lines[1].len() + 1];
        let rows_of = |column: usize| (0..of[1]).map(move |row| [column, row]);
        let mut found = Vec::new();
        let any: Vec<bool> = (0..of[0])
            .map(|column| rows_of(column).any(&wanted))
            .collect();
        let columns = strips(watch, inside.to_vec(), &self.lines[0], self.half, &any)?;
        for (column, strip) in columns.into_iter().enumerate() {
            let these: Vec<bool> = rows_of(column).map(&wanted).collect();
            let rows = strips(watch, strip, &self.lines[1], self.half, &these)?;
            for (row, areas) in rows.into_iter().enumerate() {
                let at = [column, row];
                let cell = Cell { at, of };
                found.extend(areas.into_iter().map(|area| Piece { area, cell }));
            }
        }
        Ok(found)
    }

    /// A cell as a region.
    pub(super) fn region(
        &self,
        heritage: &Heritage<'_>,
        piece: Piece,
        centres: &Centres<'_>,
        symmetry: &Symmetry,
    ) -> Region {
        let Piece { area, cell } = piece;
        let local = symmetry.local(self.local(&area, cell), cell);
        let around: Vec<(&Line, f64)> = self.around(cell).into_iter().flatten().collect();
        let on = ON * self.size;
        let centres: Vec<&Area> = centres.within(&area, on).collect();
        let role = |a: Coord<f64>, b: Coord<f64>| {
            let along = around
                .iter()
                .any(|(line, off)| [a, b].iter().all(|&p| (line.aside(p) - off).abs() < on));
            let middle = lerp(a, b, 0.5);
            Some(if along && self.half > 0.0 {
                Role::Path
            } else if !along && centres.iter().any(|c| !c.keeps_away(middle, on)) {
                Role::Centre
            } else {
                Role::Seam
            })
        };
        let mut region = heritage.piece(area, local, role);
        region.cell = Some(cell);
        number_sides(&mut region);
        region
    }

    /// The lines that a cell lies between, each with how far aside its edge is:
    /// west and east, south and north; none where the grid ends.
    fn around(&self, cell: Cell) -> [Option<(&Line, f64)>; 4] {
        let of = |k: usize| {
            let lines = &self.lines[k];
            let below = cell.at[k].checked_sub(1).and_then(|at| lines.get(at));
            let above = lines.get(cell.at[k]);
            [
                below.map(|l| (l, self.half)),
                above.map(|l| (l, -self.half)),
            ]
        };
        let ([west, east], [south, north]) = (of(0), of(1));
        [west, east, south, north]
    }

    /// Coordinates of a cell as a part of the grid: between its lines, as far as
    /// the piece reaches.
    fn local(&self, area: &Area, cell: Cell) -> Local {
        let sides = self.around(cell);
        let edge = |k: usize| {
            let end = &self.ends[k / 2][k % 2];
            sides[k].map_or(*end, |(line, off)| line.moved(off))
        };
        let [west, east, south, north] = [0, 1, 2, 3].map(edge);
        let corners = [
            west.meets(&south),
            west.meets(&north),
            east.meets(&north),
            east.meets(&south),
        ];
        let plain = Local::new(self.quad);
        let axes = plain.axes();
        let spanned = match corners {
            [Some(a), Some(b), Some(c), Some(d)] => {
                let quad = [a, b, c, d];
                let sound =
                    quad_angles(&quad).is_some() && Local::new(quad).mirrored() == plain.mirrored();
                sound.then(|| reached(&quad, area)).flatten()
            }
            _ => None,
        };
        // Lines that cross within a cell, or hardly meet, give it no corners.
        let spanned =
            spanned.unwrap_or_else(|| named_by(box_along(&area.outer, axes[0]), axes[0], axes[1]));
        // Of a cell that the region's edge cuts off much, a corner as the lines
        // have it may lie outside; then its own corners are those of its ground.
        let own = (area.size() < FULL * quad_area(&spanned))
            .then(|| meeting(area, axes))
            .flatten();
        Local::new(own.unwrap_or(spanned))
    }
}

/// The quad of an area's own vertices that lie farthest towards the four corners,
/// if it is one that coordinates can follow.
fn meeting(area: &Area, [x, y]: [Coord<f64>; 2]) -> Option<Quad> {
    let quad = crate::index::meeting_points(&area.outer, x, y).map(|k| area.outer[k]);
    let least = crate::index::Thresholds::DEFAULT.square;
    quad_angles(&quad)?
        .iter()
        .all(|a| *a >= least)
        .then_some(quad)
}

/// The part of a quad, between its own coordinates, that an area reaches.
fn reached(quad: &Quad, area: &Area) -> Option<Quad> {
    if area.outer.len() == 4 && area.size() > (1.0 - 1e-9) * quad_area(quad) {
        return Some(*quad);
    }
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for &p in &area.outer {
        let at = quad_coordinates(quad, p);
        for (k, x) in [at.x, at.y].into_iter().enumerate() {
            low[k] = low[k].min(x);
            high[k] = high[k].max(x);
        }
    }
    // What reaches the quad's edge up to rounding reaches it.
    for k in 0..2 {
        low[k] = if low[k].abs() < ON { 0.0 } else { low[k] };
        high[k] = if (high[k] - 1.0).abs() < ON {
            1.0
        } else {
            high[k]
        };
    }
    let at = |x: f64, y: f64| quad_point(quad, Coord { x, y });
    let part = [
        at(low[0], low[1]),
        at(low[0], high[1]),
        at(high[0], high[1]),
        at(high[0], low[1]),
    ];
    let finite = part.iter().all(|p| p.x.is_finite() && p.y.is_finite());
    let same = Local::new(part).mirrored() == Local::new(*quad).mirrored();
    (finite && same && quad_is_convex(&part)).then_some(part)
}

/// Areas between lines that have what comes first on their left; halved again and
/// again, so that each is cut by few lines. What is not wanted is left empty.
fn strips(
    watch: &Watch<'_>,
    areas: Vec<Area>,
    lines: &[Line],
    half: f64,
    wanted: &[bool],
) -> Result<Vec<Vec<Area>>, Failure> {
    watch.tick()?;
    if !wanted.contains(&true) {
        return Ok(vec![Vec::new(); wanted.len()]);
    }
    if lines.is_empty() {
        return Ok(vec![areas]);
    }
    let middle = lines.len() / 2;
    let [before, after] = split(&areas, &lines[middle], half);
    let mut found = strips(watch, before, &lines[..middle], half, &wanted[..=middle])?;
    found.extend(strips(
        watch,
        after,
        &lines[middle + 1..],
        half,
        &wanted[middle + 1..],
    )?);
    Ok(found)
}

/// Whole centres as far as they lie inside the areas and in none before.
pub(super) fn clipped_centres(whole: &[Area], inside: &[Area]) -> Vec<Area> {
    let mut found = Vec::with_capacity(whole.len());
    let all = Centres::new(whole);
    for area in whole {
        let middle = area.centroid();
        let far = area.outer.iter().map(|&p| dist(p, middle));
        let radius = far.fold(0.0, f64::max);
        let clear = |land: &Area| land.contains(middle) && land.nearest(middle).1 > radius;
        let mut parts = vec![area.clone()];
        if !inside.iter().any(clear) {
            parts = intersection(&parts, inside);
        }
        let before: Vec<Area> = all
            .near(area)
            .take_while(|other| !std::ptr::eq(*other, area))
            .cloned()
            .collect();
        if !before.is_empty() {
            parts = difference(&parts, &before);
        }
        found.extend(parts);
    }
    found
}

/// What whole centres leave of cells. Centres that end with the region would leave
/// hairs along its edge.
pub(super) fn without(cells: Vec<Piece>, centres: &Centres<'_>) -> Vec<Piece> {
    let mut found = Vec::with_capacity(cells.len());
    for Piece { area, cell } in cells {
        let near: Vec<Area> = centres.near(&area).cloned().collect();
        if near.is_empty() {
            found.push(Piece { area, cell });
        } else {
            let parts = difference(&[area], &near);
            found.extend(parts.into_iter().map(|area| Piece { area, cell }));
        }
    }
    found
}

/// Centres, sorted so that those near a cell are soon found.
pub(super) struct Centres<'c> {
    /// With its extent, by where it begins along x.
    sorted: Vec<(Coord<f64>, Coord<f64>, &'c Area)>,
    widest: f64,
}

impl<'c> Centres<'c> {
    pub(super) fn new(centres: &'c [Area]) -> Self {
        let mut sorted: Vec<_> = centres
            .iter()
            .map(|area| {
                let (low, high) = area.extent();
                (low, high, area)
            })
            .collect();
        sorted.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
        let widest = sorted.iter().map(|(low, high, _)| high.x - low.x);
        Self {
            widest: widest.fold(0.0, f64::max),
            sorted,
        }
    }

    /// Those whose extents meet that of an area, in one order for all areas.
    fn near<'a>(&'a self, area: &Area) -> impl Iterator<Item = &'c Area> + 'a {
        self.within(area, 0.0)
    }

    /// Those whose extents come so near to that of an area.
    fn within<'a>(&'a self, area: &Area, far: f64) -> impl Iterator<Item = &'c Area> + 'a {
        let (low, high) = area.extent();
        let far = Coord { x: far, y: far };
        let (low, high) = (low - far, high + far);
        let first = self
            .sorted
            .partition_point(|(from, _, _)| from.x < low.x - self.widest);
        self.sorted[first..]
            .iter()
            .take_while(move |(from, _, _)| from.x < high.x)
            .filter(move |(from, to, _)| to.x > low.x && from.y < high.y && to.y > low.y)
            .map(|(_, _, area)| *area)
    }
}
