//! The block parceler: any block, divided exactly into parcels with access.
//!
//! (doc below is completed with the search)

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
mod trace;
mod weld;

use geo_types::Coord;

use row::Bench;
use shape::Shape;

/// A block to divide: a simple counter-clockwise ring and its street edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Open ring, counter-clockwise, metres.
    pub ring: Vec<Coord<f64>>,
    /// As long as `ring`: edge i, from `ring[i]` to `ring[i + 1]` (the last
    /// one closes the ring), lies on a street that gives access.
    pub front: Vec<bool>,
}

/// What parcels should be like. Lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct ParcelOptions {
    /// Wished depth, from the street back.
    pub depth: f64,
    /// Wished width along the street.
    pub width: f64,
    /// No parcel has less street frontage than this.
    pub min_frontage: f64,
    /// Parcels should have at least this much frontage.
    pub good_frontage: f64,
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
pub enum PieceKind {
    /// A lot with at least the least frontage on a street.
    Parcel,
    /// Land that no street reaches, or too little of it to build on.
    Green,
}

/// A piece of a divided block.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Open ring, counter-clockwise; every vertex of a neighbour on it is a
    /// vertex of it, with the same coordinates to the bit.
    pub ring: Vec<Coord<f64>>,
    /// Parcel or green.
    pub kind: PieceKind,
}

/// Divides a block into parcels, and green land where no street reaches.
pub fn parcel(block: &Block, options: &ParcelOptions) -> Vec<Piece> {
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
    #[cfg(feature = "stat")]
    let n1 = bench.work;
    let plain = weld::Mesh::new(&shape, &parts, options);
    let mut mesh = plain.clone();
    improve::improve(&mut mesh, options, &mut bench);
    #[cfg(feature = "stat")]
    if shape.area() > 0.0 {
        eprintln!(
            "stat {} {} {}",
            (shape.area() / 540.0) as usize,
            n1,
            bench.work - n1
        );
    }
    // What is returned is proved, not hoped: rounding could, in a freak case,
    // let a dividing line graze another.
    for mut mesh in [mesh, plain] {
        if mesh.holds(&shape) {
            mesh.settle_kinds(options);
            return mesh.pieces(&block.ring, origin);
        }
        #[cfg(feature = "stat")]
        eprintln!("doesnothold {}", shape.area());
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
