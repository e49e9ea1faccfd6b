//! The block parceler: any block, divided exactly into parcels with access.
//!
//! The templates serve the blocks that look like a template; this room takes
//! the rest: wedges, strips with a ragged property line behind, L and T
//! shapes, leftovers at the site's edge, pie pieces, needles. It replaces the
//! rule-based parceling that the paper falls back on (Vanegas, Kelly, Weber,
//! Halatsch, Aliaga and Müller, "Procedural generation of parcels in urban
//! modeling", 2012), which slices straight-skeleton rows or splits oriented
//! boxes without asking what comes out. Here every candidate is measured with
//! the paper's own figures (Yang et al. 2013, section 7) and the best wins.
//!
//! # How a block is divided
//!
//! 1. **Fronts** (`shape`). The street edges are split into fronts at corners
//!    (over 35 degrees within a lot's width, so that a rounded corner is one
//!    corner and a curve none) and where a front bends round to face itself.
//! 2. **Rows** (`row`). A shape behind a front is sliced by rungs: chords from
//!    the front to the first thing behind. Regular slices come in a few ways
//!    to spread the lean of the row's ends (a fan over all lots, over two
//!    and a half, or none).
//! 3. **Structural cuts** (`cuts`, `trace`, `search`). Blocks that do not
//!    slice well are cut first: along the spine between two fronts, along the
//!    offset of a front, through reflex corners, straight across. A beam
//!    search prices each cut by the sliced rows it leaves and takes the best
//!    few further; what stays poor is planned again by itself. Work is
//!    counted, not timed, so that results do not depend on the machine.
//! 4. **Growth** (`absorb`). Rows reach into landlocked land behind them as
//!    far as lots of sensible depth go.
//! 5. **Rungs** (`ladder`). The rungs of each row are found anew as a shortest
//!    path over a grid of places and leans, then polished.
//! 6. **Repairs** (`weld`, `improve`). The pieces become one mesh; every bad
//!    parcel is joined with a neighbour, or the pair is cut again, where that
//!    is cheaper. At last, short edges are closed (`tidy`).
//!
//! The result is checked before it is returned: simple rings, every inner edge
//! shared by exactly two pieces, the outline and the area those of the block.
//!
//! # Decisions
//!
//! - *One cost for everything* (`quality`): the certificate's limits are steps,
//!   size, frontage and aspect are slopes, green land costs by area. A green
//!   scrap at a sharp corner is dearer than one bad parcel of half a lot.
//! - *Level lines instead of a straight skeleton.* For straight fronts they are
//!   the same lines; along a curve of many short edges the skeleton has an arc
//!   for each vertex, of which a row wants none.
//! - *A spine never ends in the corner of two fronts* unless that is cheapest:
//!   one row takes the corner (the skeleton's diagonal makes acute lots).
//! - *Slants over 30 degrees leave one bad lot.* A quadrilateral with one side
//!   leaning by φ has a mean corner deviation of φ/2 however it is turned;
//!   spreading helps only up to twice the limit. The cost then prefers one
//!   larger bad lot to two, and a right-angled lot beside a green scrap where
//!   the scrap is small.
//! - *Through lots are dear.* A lot of twice the depth with two streets costs
//!   more than two lots back to back, less than a lot with a green behind.

mod absorb;
mod cuts;
mod geom;
mod improve;
mod ladder;
mod quality;
mod row;
mod search;
mod shape;
#[cfg(test)]
mod tests;
mod tidy;
mod trace;
mod weld;

use geo_types::Coord;

use row::Bench;
use shape::Shape;

/// A block to divide: a simple counter-clockwise ring and its street edges.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block {
    /// Open ring, counter-clockwise, metres.
    pub(crate) ring: Vec<Coord<f64>>,
    /// As long as `ring`: edge i, from `ring[i]` to `ring[i + 1]` (the last
    /// one closes the ring), lies on a street that gives access.
    pub(crate) front: Vec<bool>,
}

/// What parcels should be like. Lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ParcelOptions {
    /// Wished depth, from the street back.
    pub(crate) depth: f64,
    /// Wished width along the street.
    pub(crate) width: f64,
    /// No parcel has less street frontage than this.
    pub(crate) min_frontage: f64,
    /// Parcels should have at least this much frontage.
    pub(crate) good_frontage: f64,
}

impl Default for ParcelOptions {
    fn default() -> Self {
        Self {
            depth: 30.0,
            width: 18.0,
            min_frontage: 3.0,
            good_frontage: 10.0,
        }
    }
}

impl ParcelOptions {
    /// Ends of dividing lines closer than this to a vertex move onto it.
    fn snap(&self) -> f64 {
        0.02 * self.width
    }
}

/// What a piece of a block is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PieceKind {
    /// A lot with at least the least frontage on a street.
    Parcel,
    /// Land that no street reaches, or too little of it to build on.
    Green,
}

/// A piece of a divided block.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Piece {
    /// Open ring, counter-clockwise; every vertex of a neighbour on it is a
    /// vertex of it, with the same coordinates to the bit.
    pub(crate) ring: Vec<Coord<f64>>,
    /// Parcel or green.
    pub(crate) kind: PieceKind,
}

/// Divides a block into parcels, and green land where no street reaches.
///
/// The pieces tile the block: they share vertices to the bit, their rings
/// contain every vertex of the block's ring unchanged, new vertices on the
/// block's edges appear in each piece there, and the areas add up to 1e-9.
/// Every parcel has at least [`ParcelOptions::min_frontage`] of street edges.
///
/// A ring that is not simple, or runs clockwise, comes back as one piece. Only
/// what is no ring at all (fewer than three vertices, a coordinate that is not
/// finite, flags of another length) gives no piece. A block without enough
/// frontage becomes one green piece. The same input gives the same bytes.
///
/// # Complexity
///
/// Work is bounded by a budget that grows with the block's area. On one core a
/// rectangle of 20 parcels takes well under a millisecond, a curved double row
/// of 20 about 5 ms, an irregular leftover of 8 about 5 ms and a hopeless one
/// of 20 (all corners oblique) up to 30 ms.
pub(crate) fn parcel(block: &Block, options: &ParcelOptions) -> Vec<Piece> {
    let options = &sane(options);
    let Some((shape, origin)) = local(block) else {
        return Vec::new();
    };
    let whole = || {
        let reach = shape.frontage() >= options.min_frontage;
        let kind = if reach {
            PieceKind::Parcel
        } else {
            PieceKind::Green
        };
        vec![Piece {
            ring: block.ring.clone(),
            kind,
        }]
    };
    if !geom::is_simple(&shape.ring) || shape.area() <= 0.0 {
        return whole();
    }
    let mut bench = Bench::default();
    let parts = search::plan(&shape, options, &mut bench);
    let plain = weld::Mesh::new(&shape, &parts, options);
    let mut better = plain.clone();
    improve::improve(&mut better, options, &mut bench);
    let mut tidied = better.clone();
    tidy::tidy(&mut tidied, options);
    // What is returned is proved, not hoped: rounding could, in a freak case,
    // let a dividing line graze another.
    for mut mesh in [tidied, better, plain] {
        if mesh.holds(&shape) {
            mesh.settle_kinds(options);
            return mesh.pieces(&block.ring, origin);
        }
    }
    whole()
}

/// Options with every length positive and finite.
fn sane(options: &ParcelOptions) -> ParcelOptions {
    let d = ParcelOptions::default();
    let ok = |v: f64, d: f64| if v.is_finite() && v > 1e-6 { v } else { d };
    let width = ok(options.width, d.width);
    let min_frontage = ok(options.min_frontage, 1e-6);
    ParcelOptions {
        depth: ok(options.depth, d.depth),
        width,
        min_frontage,
        good_frontage: ok(options.good_frontage, min_frontage).max(min_frontage),
    }
}

/// The block in its own frame, without repeated vertices.
fn local(block: &Block) -> Option<(Shape, Coord<f64>)> {
    let n = block.ring.len();
    if n < 3
        || block.front.len() != n
        || block
            .ring
            .iter()
            .any(|c| !(c.x.is_finite() && c.y.is_finite()))
    {
        return None;
    }
    let origin = block.ring[0];
    let ring: Vec<_> = block.ring.iter().map(|&c| c - origin).collect();
    Some((
        Shape {
            ring,
            front: block.front.clone(),
        },
        origin,
    ))
}
