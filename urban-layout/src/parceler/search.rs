//! The search for rows: which cuts make a block of rows that slice well.
//!
//! A shape is priced quickly as one parcel, as one row behind any of its
//! fronts, or as green land. Structural cuts (spines, offsets, chords at
//! reflex corners) are priced by the sum over their two sides; the best few
//! are taken further, until rows are clean, the depth is used up or the
//! budget of measured parcels is spent. The budget counts work, not time, so
//! that results do not depend on the machine.

use super::cuts::cuts;
use super::geom::P;
use super::ladder::refine;
use super::quality::{cost, green_cost, measure};
use super::row::{Bench, Row, Rung};
use super::shape::Shape;
use super::ParcelOptions;

/// A piece of the plan.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Part {
    pub(super) shape: Shape,
    pub(super) green: bool,
}

/// A piece that is not structurally cut any further.
#[derive(Clone, Debug)]
pub(super) enum Leaf {
    /// One parcel, or one green.
    Whole(Shape, bool),
    /// A row and its rungs.
    Row(Box<Row>, Vec<Rung>),
}

/// A division of a shape with its cost.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) cost: f64,
    pub(super) leaves: Vec<Leaf>,
}

/// How many cuts are taken further at each level.
const BEAM: [usize; 4] = [6, 3, 2, 1];
/// A shape is clean, and not cut further, below this cost per parcel.
const CLEAN: f64 = 0.08;

/// Divides a simple ring; the parts tile it.
pub(super) fn plan(shape: &Shape, options: &ParcelOptions, bench: &mut Bench) -> Vec<Part> {
    let lots = shape.area() / (options.depth * options.width);
    let budget = bench.measured + 4000 + (300.0 * lots.min(200.0)) as usize;
    let best = deepen(shape, options, bench, 0, budget);
    let mut parts = Vec::new();
    for leaf in &best.leaves {
        match leaf {
            Leaf::Whole(shape, green) => parts.push(Part {
                shape: shape.clone(),
                green: *green,
            }),
            Leaf::Row(row, rungs) => {
                let c = row.total(rungs, options, bench, f64::INFINITY).unwrap_or(f64::INFINITY);
                let (_, rungs) = refine(row, c, rungs, options, bench);
                for shape in row.shapes(&rungs, bench) {
                    parts.push(Part {
                        shape,
                        green: false,
                    });
                }
            }
        }
    }
    parts
}

/// The shape without structural cuts: one parcel, one row, or green.
fn quick(shape: &Shape, options: &ParcelOptions, bench: &mut Bench) -> Plan {
    let area = shape.area();
    let green = Plan {
        cost: green_cost(area, options),
        leaves: vec![Leaf::Whole(shape.clone(), true)],
    };
    if shape.frontage() < options.min_frontage {
        return green;
    }
    let mut best = green;
    bench.measured += 1;
    let q = measure(&shape.ring, &shape.front, &mut bench.scratch);
    let c = cost(&q, options);
    if c < best.cost {
        best = Plan {
            cost: c,
            leaves: vec![Leaf::Whole(shape.clone(), false)],
        };
    }
    if area < 0.9 * options.depth * options.width {
        return best;
    }
    let mut chains = shape.chains(options);
    chains.sort_by(|a, b| b.length.total_cmp(&a.length));
    for chain in chains.iter().take(3) {
        if clean(&best, area, options) {
            break;
        }
        let Some(row) = Row::new(shape, chain, options) else {
            continue;
        };
        if let Some((c, rungs)) = row.regular(options, bench) {
            if c < best.cost {
                best = Plan {
                    cost: c,
                    leaves: vec![Leaf::Row(Box::new(row), rungs)],
                };
            }
        }
    }
    best
}

fn clean(plan: &Plan, area: f64, options: &ParcelOptions) -> bool {
    plan.cost < CLEAN * (area / (options.depth * options.width)).max(1.0)
}

/// The best plan that the remaining levels and budget find.
fn deepen(
    shape: &Shape,
    options: &ParcelOptions,
    bench: &mut Bench,
    level: usize,
    budget: usize,
) -> Plan {
    let mut best = quick(shape, options, bench);
    let area = shape.area();
    let unit = options.depth * options.width;
    if level >= BEAM.len()
        || clean(&best, area, options)
        || shape.frontage() < options.min_frontage
        || area < 0.8 * unit
    {
        return best;
    }
    let mut found: Vec<(f64, Shape, Shape)> = Vec::new();
    for (l, r) in cuts(shape, options) {
        if bench.measured > budget {
            break;
        }
        if l.area().min(r.area()) < 0.1 * unit {
            continue;
        }
        let c = quick(&l, options, bench).cost + quick(&r, options, bench).cost;
        found.push((c, l, r));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (c, l, r) in found.into_iter().take(BEAM[level]) {
        if bench.measured > budget && c >= best.cost {
            break;
        }
        let pl = deepen(&l, options, bench, level + 1, budget);
        let pr = deepen(&r, options, bench, level + 1, budget);
        if pl.cost + pr.cost < best.cost {
            let mut leaves = pl.leaves;
            leaves.extend(pr.leaves);
            best = Plan {
                cost: pl.cost + pr.cost,
                leaves,
            };
        }
        if clean(&best, area, options) {
            break;
        }
    }
    best
}

/// Points of a polyline from `skip` metres on, with the point there first.
pub(super) fn beyond(path: &[P], skip: f64) -> Option<Vec<P>> {
    let mut left = skip;
    for i in 0..path.len().saturating_sub(1) {
        let d = super::geom::dist(path[i], path[i + 1]);
        if left < d {
            let mut out = vec![super::geom::lerp(path[i], path[i + 1], left / d)];
            out.extend_from_slice(&path[i + 1..]);
            return Some(out);
        }
        left -= d;
    }
    None
}
