//! The search for rows: which cuts make a block of rows that slice well.
//!
//! A shape is priced quickly as one parcel, as one row behind any of its
//! fronts, or as green land. Structural cuts (spines, offsets, chords at
//! reflex corners) are priced by the sum over their two sides; the best few
//! are taken further, until rows are clean, the depth is used up or the
//! budget of measured parcels is spent. The budget counts work, not time, so
//! that results do not depend on the machine.

use super::absorb::absorb;
use super::cuts::{cuts, KINDS};
use super::geom::P;
use super::ladder::refine;
use super::quality::{cost, measure};
use super::row::{Bench, Row, Rung};
use super::shape::Shape;
use super::ParcelOptions;

/// A piece that is not structurally cut any further.
#[derive(Clone, Debug)]
pub(super) enum Leaf {
    /// One parcel, or one green.
    Whole(Shape),
    /// A row and its rungs.
    Row(Box<Row>, Vec<Rung>),
}

/// A division of a shape with its cost.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) cost: f64,
    /// The leaves, each with its cost.
    pub(super) leaves: Vec<(f64, Leaf)>,
}

/// How many cuts are taken further at each level.
const BEAM: [usize; 4] = [4, 2, 1, 1];
/// A cut must gain this much: rows in one piece refine better than halves.
const GAIN: f64 = 0.1;
/// A shape is clean, and not cut further, below this cost per parcel.
const CLEAN: f64 = 0.15;

/// Divides a simple ring; the parts tile it.
pub(super) fn plan(shape: &Shape, options: &ParcelOptions, bench: &mut Bench) -> Vec<Shape> {
    let lots = shape.area() / (options.depth * options.width);
    let mut left = (5000.0 + 700.0 * lots.min(300.0)) as usize;
    let mut work = vec![(shape.clone(), f64::INFINITY, 0)];
    let mut leaves = Vec::new();
    // The levels reach for a few rows. What they leave in a poor state is
    // planned again by itself, with all levels, as long as that gains.
    while let Some((shape, was, round)) = work.pop() {
        let start = bench.work;
        let share = if round == 0 { left / 2 } else { left / 4 };
        let first = quick(&shape, options, bench);
        let best = deepen(&shape, first, options, bench, 0, start + share);
        left = left.saturating_sub(bench.work - start);
        let split = best.leaves.len() > 1 && best.cost < was - 1e-6;
        for (c, leaf) in best.leaves {
            let lots = leaf.shape().area() / (options.depth * options.width);
            let poor =
                lots > 1.5 && c > 0.3 * lots && leaf.shape().frontage() > options.good_frontage;
            if split && poor && round < 6 && left > 500 {
                work.push((leaf.into_shape(), c, round + 1));
            } else {
                leaves.push((c, leaf));
            }
        }
    }
    let mut parts = Vec::new();
    for (c, leaf) in absorb(shape, leaves, options, bench) {
        match leaf {
            Leaf::Whole(shape) => parts.push(shape),
            Leaf::Row(row, rungs) => {
                let (_, rungs) = refine(&row, c, &rungs, options, bench);
                parts.extend(row.shapes(&rungs, bench));
            }
        }
    }
    parts
}

impl Leaf {
    pub(super) fn shape(&self) -> &Shape {
        match self {
            Self::Whole(s) => s,
            Self::Row(r, _) => &r.shape,
        }
    }

    fn into_shape(self) -> Shape {
        match self {
            Self::Whole(s) => s,
            Self::Row(r, _) => r.shape,
        }
    }
}

/// The shape without structural cuts: one piece or one row.
pub(super) fn quick(shape: &Shape, options: &ParcelOptions, bench: &mut Bench) -> Plan {
    let area = shape.area();
    bench.work += 1;
    let c = cost(
        &measure(&shape.ring, &shape.front, &mut bench.scratch),
        options,
    );
    let mut best = Plan {
        cost: c,
        leaves: vec![(c, Leaf::Whole(shape.clone()))],
    };
    if area < 0.9 * options.depth * options.width || shape.frontage() < options.min_frontage {
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
                    leaves: vec![(c, Leaf::Row(Box::new(row), rungs))],
                };
            }
        }
    }
    best
}

fn clean(plan: &Plan, area: f64, options: &ParcelOptions) -> bool {
    plan.cost < CLEAN * (area / (options.depth * options.width)).max(1.0)
}

/// What no plan for the shape can undercut: land that no street reaches stays
/// green.
fn bound(shape: &Shape, options: &ParcelOptions, bench: &mut Bench) -> f64 {
    if shape.frontage() >= options.min_frontage {
        return 0.0;
    }
    bench.work += 1;
    cost(
        &measure(&shape.ring, &shape.front, &mut bench.scratch),
        options,
    )
}

/// A structural cut with the quick plans of its two sides.
struct Candidate {
    cost: f64,
    area: f64,
    sides: [(Shape, Plan); 2],
}

/// The best plan that the remaining levels and budget find, from the quick
/// plan `best` on.
fn deepen(
    shape: &Shape,
    mut best: Plan,
    options: &ParcelOptions,
    bench: &mut Bench,
    level: usize,
    budget: usize,
) -> Plan {
    let area = shape.area();
    let unit = options.depth * options.width;
    if level >= BEAM.len()
        || clean(&best, area, options)
        || shape.frontage() < options.min_frontage
        || area < 0.8 * unit
    {
        return best;
    }
    let mut found: Vec<Candidate> = Vec::new();
    for kind in 0..KINDS {
        // Deep down, cutting straight across only halves rows.
        if kind == 3 && level >= 2 {
            continue;
        }
        let pairs = cuts(shape, options, kind);
        // Tracing and shooting cost by the vertex, not by the parcel.
        bench.work += pairs.len() * shape.len() / 10;
        for (l, r) in pairs {
            if bench.work > budget {
                break;
            }
            if l.area().min(r.area()) < 0.1 * unit
                || bound(&l, options, bench) + bound(&r, options, bench) > best.cost - GAIN
            {
                continue;
            }
            let (pl, pr) = (quick(&l, options, bench), quick(&r, options, bench));
            found.push(Candidate {
                cost: pl.cost + pr.cost,
                area: l.area(),
                sides: [(l, pl), (r, pr)],
            });
        }
        // Nothing to look for beyond a plan that is as good as perfect.
        if found.iter().any(|c| c.cost < 0.25 * CLEAN * area / unit) {
            break;
        }
    }
    found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    // The same line often turns up twice, seen from either side: the beam is
    // for different plans.
    let like = |a: &Candidate, b: &Candidate| {
        let other = (a.area - b.area).abs().min((area - a.area - b.area).abs());
        (a.cost - b.cost).abs() < 0.02 && other < 0.02 * unit
    };
    let mut taken: Vec<Candidate> = Vec::new();
    for c in found {
        if taken.len() == BEAM[level] {
            break;
        }
        if !taken.iter().any(|t| like(t, &c)) {
            taken.push(c);
        }
    }
    for candidate in taken {
        if bench.work > budget && candidate.cost >= best.cost {
            break;
        }
        let [(l, pl), (r, pr)] = candidate.sides;
        let pl = deepen(&l, pl, options, bench, level + 1, budget);
        let pr = deepen(&r, pr, options, bench, level + 1, budget);
        if pl.cost + pr.cost < best.cost - GAIN {
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
