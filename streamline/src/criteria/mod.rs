//! UrbanFab's six criteria: how good a set of streamlines is as an urban fabric.
//!
//! F. P. Ortner, Z. Chen, P. Song, P. Qiu, *Urban Fabric Generation: A
//! comparative analysis of multiple vector field methods*, 2023, "Field
//! evaluation criteria". The paper gives a paragraph to each and no formula:
//! each file here says how it reads its paragraph.

mod angle;
mod compare;
mod contact;
mod convexity;
mod judge;
mod nearby;
mod options;
mod strips;
mod total;
mod turns;

pub use compare::{compare_criteria, CriteriaComparison, Criterion};
pub use options::{CriteriaOptions, TurnRule};
pub use total::{Spread, Total};

use crate::error::TraceError;
use crate::field::DirectionField;
use crate::separatrix::Singularity;
use crate::streamline::{Sample, Streamline};
use crate::tiles::Tiling;
use crate::vector::{is_finite, Point};
use geo_types::Polygon;
use judge::Judge;
use total::Share;

/// One of the equal segments of a streamline, and what it is judged by. Each
/// figure is 0 at best.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SegmentCriteria {
    /// Its middle, which lies on the line, its direction from end to end, and
    /// its length along the line.
    pub piece: Sample,
    /// Absolute divergence of the field there, in 1/m. `None` where the field
    /// has none.
    pub divergence: Option<f64>,
    /// How many of the line's turns lie within it.
    pub turns: usize,
    /// Angle to the piece of the boundary that the adjacent streamlines split
    /// off, in right angles: from 0, parallel, to 1. `None` where that strip
    /// reaches no boundary, and off the tiles.
    pub parallelism: Option<f64>,
    /// How far from a right angle the segment is to the edge of the boundary
    /// that its line touches nearer by, in right angles: from 0 to 1, parallel.
    /// `None` on a line that touches none.
    pub perpendicularity: Option<f64>,
}

/// What a streamline is judged by: the means by length of its segments.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LineCriteria {
    /// In metres.
    pub length: f64,
    /// Mean divergence along the line, in 1/m
    /// ([`CriteriaOptions::signed`] says of what). `None` where nothing is
    /// known of it, as on a line without length.
    pub divergence: Option<f64>,
    /// Number of turns.
    pub turns: usize,
    /// Turns per length, in 1/m; 0 for a line without length.
    pub continuity: f64,
    /// Sum of all changes of direction, however gentle, in radians. Not one of
    /// the six; it has no limit to choose.
    pub turning: f64,
    /// Mean of [`SegmentCriteria::parallelism`].
    pub parallelism: Option<f64>,
    /// Mean of [`SegmentCriteria::perpendicularity`].
    pub perpendicularity: Option<f64>,
    /// The segments, from start to end; none for a line without length.
    pub segments: Vec<SegmentCriteria>,
}

/// What a tile is judged by.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TileCriteria {
    /// In square metres.
    pub area: f64,
    /// Of all its rings, in metres.
    pub perimeter: f64,
    /// 1 - perimeter of the convex hull / perimeter: 0 for a convex tile,
    /// always below 1. The inner rings of a tile count as dents.
    pub convexity: f64,
}

/// The criteria of a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CriteriaTotals {
    /// Number of streamlines.
    pub lines: usize,
    /// Their length, in metres.
    pub length: f64,
    /// Number of tiles, those too small for the statistics included.
    pub tiles: usize,
    /// Their area, in square metres.
    pub area: f64,
    /// In 1/m.
    pub divergence: Total,
    /// Turns per length, in 1/m.
    pub continuity: Total,
    /// In right angles.
    pub parallelism: Total,
    /// In right angles.
    pub perpendicularity: Total,
    /// Of the tiles; without unit.
    pub convexity: Spread,
    /// Number of singularities of the field.
    pub singularities: usize,
    /// Sum of the absolute values of their indices, in quarter turns.
    pub quarters: u64,
}

impl CriteriaTotals {
    /// All but the singularities.
    fn new(lines: &[LineCriteria], tiles: &[TileCriteria], options: &CriteriaOptions) -> Self {
        let of = |value: fn(&SegmentCriteria) -> Option<f64>| {
            Total::new(lines.iter().map(|line| line.share(value)))
        };
        let divergence = lines.iter().map(|line| {
            let known = line.share(|s| s.divergence);
            Share {
                // With signs, a line's figure is not made of those of segments.
                sum: line.divergence.unwrap_or(0.0) * known.measured,
                ..known
            }
        });
        let continuity = lines.iter().map(|line| Share {
            sum: line.turns as f64,
            measured: line.length,
            length: line.length,
        });
        let counted: Vec<(f64, f64)> = tiles
            .iter()
            .filter(|tile| tile.area >= options.min_tile_area)
            .map(|tile| (tile.convexity, tile.area))
            .collect();
        Self {
            lines: lines.len(),
            length: lines.iter().map(|line| line.length).sum(),
            tiles: tiles.len(),
            area: tiles.iter().map(|tile| tile.area).sum(),
            divergence: Total::new(divergence),
            continuity: Total::new(continuity),
            parallelism: of(|s| s.parallelism),
            perpendicularity: of(|s| s.perpendicularity),
            convexity: Spread::new(&counted),
            singularities: 0,
            quarters: 0,
        }
    }

    /// Singularities per area, in 1/m^2; 0 without area.
    #[must_use]
    pub fn singularity_density(&self) -> f64 {
        if self.area > 0.0 {
            self.singularities as f64 / self.area
        } else {
            0.0
        }
    }
}

/// UrbanFab's six criteria, line by line, tile by tile and in total.
///
/// `Display` writes the totals as a table.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Criteria {
    /// One for each line, in the order of the input.
    pub lines: Vec<LineCriteria>,
    /// One for each tile, in the order of the tiling.
    pub tiles: Vec<TileCriteria>,
    /// All of them together.
    pub totals: CriteriaTotals,
}

impl Criteria {
    /// The criteria of several domains as those of one, such as the parts of a
    /// site: lines and tiles in the order of the parts, totals anew.
    ///
    /// Give the options that the parts were judged with.
    #[must_use]
    pub fn joined(parts: impl IntoIterator<Item = Self>, options: &CriteriaOptions) -> Self {
        let mut all = Self::default();
        let (mut singularities, mut quarters) = (0, 0);
        for part in parts {
            all.lines.extend(part.lines);
            all.tiles.extend(part.tiles);
            singularities += part.totals.singularities;
            quarters += part.totals.quarters;
        }
        all.totals = CriteriaTotals {
            singularities,
            quarters,
            ..CriteriaTotals::new(&all.lines, &all.tiles, options)
        };
        all
    }
}

/// Judges a set of streamlines, and the tiles between them, by UrbanFab's six
/// criteria. Each is 0 at best, and a rectangle with lines along its sides has
/// 0 in all six.
///
/// `domain` is what the field is for, `tiling` what [`tiles`](crate::tiles)
/// makes of it and exactly these lines, in this order. Lines need not cover the
/// domain, nor the tiles use all of them.
///
/// # The criteria
///
/// | | measured | unit | in total |
/// |---|---|---|---|
/// | divergence | absolute divergence of the field along the lines | 1/m | mean by length |
/// | continuity | turns: changes of direction by more than 20 degrees within 4 m | 1/m | turns over length |
/// | parallelism | angle between a segment and the piece of the boundary that its adjacent streamlines split off | right angles | mean by length |
/// | perpendicularity | deviation from a right angle between a segment and the edge of the boundary that its line touches, at the nearer end | right angles | mean by length |
/// | convexity | 1 - perimeter of the convex hull / perimeter, of a tile | | mean over tiles |
/// | singularities | points without direction | 1/m^2 | number over area |
///
/// [`Total`] and [`Spread`] have sums, other means and the distribution besides.
/// Parallelism and perpendicularity have no value where no boundary is to be
/// compared with; [`Total::measured`] says for how much of the length they do.
///
/// # Units
///
/// Scaled by a factor f (options included), divergence and continuity change by
/// 1/f, singularities per area by 1/f^2, the others not at all. None depends on
/// place or rotation.
///
/// # Errors
///
/// [`TraceError::BadOption`]; [`TraceError::LineNotFinite`] and
/// [`TraceError::DomainNotFinite`] for coordinates that are not finite;
/// [`TraceError::BadTiling`] if the tiling does not fit the lines.
///
/// # Complexity
///
/// O(n log n) for n segments and edges of tiles, as long as tiles have few
/// sides, and one divergence for each segment.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, polygon, Rect};
/// use streamline::{arm_nearest, criteria, from_fn, lattice, place, tiles, CriteriaOptions,
///     Criterion, PlacementOptions, Streamline, TileOptions};
///
/// // A rectangle, and a grid that is 10 degrees askew in it.
/// let land = polygon![(x: 0., y: 0.), (x: 600., y: 0.), (x: 600., y: 400.), (x: 0., y: 400.)];
/// let judge = |degrees: f64| {
///     let field = from_fn(land.clone(), move |_, heading| {
///         Some(arm_nearest(degrees.to_radians(), heading))
///     });
///     let extent = Rect::new(coord! { x: 0., y: 0. }, coord! { x: 600., y: 400. });
///     let seeds = lattice(&field, extent, 37.5)?;
///     let lines = place(&field, &seeds, &PlacementOptions::default())?;
///     let strings: Vec<_> = lines.iter().map(Streamline::to_line_string).collect();
///     let tiling = tiles(&land, &strings, &TileOptions::default())?;
///     criteria(&field, &land, &lines, &tiling, &[], &CriteriaOptions::default())
/// };
/// let straight = judge(0.0)?;
/// assert!(Criterion::ALL.iter().all(|c| c.of(&straight.totals) < 1e-12));
/// let askew = judge(10.0)?;
/// assert!(askew.totals.parallelism.mean > 0.1); // 10 degrees are 0.11 right angles
/// assert_eq!(askew.totals.convexity.worst, 0.0); // convex even where cut off
/// # Ok::<(), streamline::TraceError>(())
/// ```
pub fn criteria<F: DirectionField + ?Sized>(
    field: &F,
    domain: &Polygon<f64>,
    lines: &[Streamline],
    tiling: &Tiling,
    singularities: &[Singularity],
    options: &CriteriaOptions,
) -> Result<Criteria, TraceError> {
    options.validate()?;
    let boundary = edges(domain)?;
    for (index, line) in lines.iter().enumerate() {
        if let Some(bad) = line.points.iter().find(|&&p| !is_finite(p)) {
            let (x, y) = (bad.x, bad.y);
            return Err(TraceError::LineNotFinite { index, x, y });
        }
    }
    fits(tiling, lines.len())?;
    let judge = Judge::new(&field, boundary, tiling, options);
    let lines: Vec<LineCriteria> = lines
        .iter()
        .enumerate()
        .map(|(i, line)| judge.line(i, line))
        .collect();
    let tiles: Vec<TileCriteria> = (0..tiling.tiles.len())
        .map(|tile| {
            let perimeter = convexity::perimeter(tiling, tile);
            TileCriteria {
                area: tiling.tiles[tile].area,
                perimeter,
                convexity: convexity::convexity(tiling, tile, perimeter),
            }
        })
        .collect();
    let quarters = singularities
        .iter()
        .map(|s| u64::from(s.quarters.unsigned_abs()));
    let totals = CriteriaTotals {
        singularities: singularities.len(),
        quarters: quarters.sum(),
        ..CriteriaTotals::new(&lines, &tiles, options)
    };
    Ok(Criteria {
        lines,
        tiles,
        totals,
    })
}

impl LineCriteria {
    fn share(&self, value: impl Fn(&SegmentCriteria) -> Option<f64>) -> Share {
        Share::new(self.segments.iter().map(|s| (value(s), s.piece.length)))
    }
}

/// The edges of a domain that have a length.
fn edges(domain: &Polygon<f64>) -> Result<Vec<(Point, Point)>, TraceError> {
    let mut edges = Vec::new();
    let rings = std::iter::once(domain.exterior()).chain(domain.interiors());
    for (ring, line) in rings.enumerate() {
        if let Some(bad) = line.0.iter().find(|&&p| !is_finite(p)) {
            let (x, y) = (bad.x, bad.y);
            return Err(TraceError::DomainNotFinite { ring, x, y });
        }
        edges.extend(line.0.windows(2).map(|p| (p[0], p[1])));
    }
    edges.retain(|(a, b)| a != b);
    Ok(edges)
}

/// Whether all that a tiling refers to is there, whoever made it.
fn fits(tiling: &Tiling, lines: usize) -> Result<(), TraceError> {
    let bad = |what: &'static str, index: usize| Err(TraceError::BadTiling { what, index });
    if let Some(v) = tiling.vertices.iter().position(|&v| !is_finite(v)) {
        return bad("vertex", v);
    }
    for (e, edge) in tiling.edges.iter().enumerate() {
        let vertices = edge.vertices.iter().all(|&v| v < tiling.vertices.len());
        let beside = edge.tiles.iter().flatten().all(|&t| t < tiling.tiles.len());
        if !(vertices && beside && edge.lines.iter().all(|&line| line < lines)) {
            return bad("edge", e);
        }
    }
    for (t, tile) in tiling.tiles.iter().enumerate() {
        let mut sides = tile.rings.iter().flatten();
        if !(tile.area.is_finite() && sides.all(|side| side.edge < tiling.edges.len())) {
            return bad("tile", t);
        }
    }
    Ok(())
}
