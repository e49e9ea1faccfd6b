//! Rows that grow into the green behind them.
//!
//! The search fixes a row's depth before it knows what becomes of the land
//! behind. Where that ended up landlocked, each row on its border is offered
//! the whole of it, and keeps what lots of sensible depth can use.

use super::geom::{angle, dot, left, lerp, unit, P};
use super::quality::{cost, measure};
use super::row::Bench;
use super::search::{quick, Leaf};
use super::shape::{Mark, Shape};
use super::trace::Path;
use super::weld::{Mesh, Union};
use super::ParcelOptions;

/// How much deeper a row is tried, in wished depths.
const DEEPER: [f64; 8] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85];

/// Offers every landlocked leaf to the rows around it.
pub(super) fn absorb(
    block: &Shape,
    leaves: Vec<(f64, Leaf)>,
    options: &ParcelOptions,
    bench: &mut Bench,
) -> Vec<(f64, Leaf)> {
    let lot = options.depth * options.width;
    let locked = |leaf: &Leaf| {
        leaf.shape().frontage() < options.min_frontage && leaf.shape().area() > 0.15 * lot
    };
    let mut leaves = leaves;
    // Each gain changes the pieces, so the mesh is built anew.
    for _ in 0..12 {
        let greens: Vec<usize> = (0..leaves.len())
            .filter(|&i| locked(&leaves[i].1))
            .collect();
        if greens.is_empty() {
            return leaves;
        }
        let shapes: Vec<Shape> = leaves.iter().map(|l| l.1.shape().clone()).collect();
        let mesh = Mesh::new(block, &shapes, options);
        let mut best: Option<(usize, usize, Use)> = None;
        for &g in &greens {
            for r in mesh.neighbours(g) {
                if mesh.front[r].iter().all(|f| !f) {
                    continue;
                }
                let Some(union) = mesh.union(r, g) else {
                    continue;
                };
                let now = leaves[r].0 + leaves[g].0;
                for (c, found) in uses(&union, options, bench) {
                    if c < now - 0.05 && best.as_ref().is_none_or(|b| now - c > b.2 .0) {
                        best = Some((r, g, (now - c, found)));
                    }
                }
            }
        }
        let Some((r, g, (_, found))) = best else {
            return leaves;
        };
        let (hi, lo) = (r.max(g), r.min(g));
        leaves.remove(hi);
        leaves.remove(lo);
        leaves.extend(found);
    }
    leaves
}

/// A division of a shape: its cost and its leaves.
type Use = (f64, Vec<(f64, Leaf)>);

/// Ways to use a row together with the green behind it.
fn uses(union: &Union, options: &ParcelOptions, bench: &mut Bench) -> Vec<Use> {
    let all = quick(&union.shape, options, bench);
    let mut out = vec![(all.cost, all.leaves)];
    for d in DEEPER {
        let Some(path) = shifted(union, d * options.depth, options) else {
            continue;
        };
        let Some((row, rest)) = union.shape.cut(path.from, &path.inner, path.to) else {
            continue;
        };
        let rest_cost = cost(
            &measure(&rest.ring, &rest.front, &mut bench.scratch),
            options,
        );
        let plan = quick(&row, options, bench);
        let mut leaves = plan.leaves;
        leaves.push((rest_cost, Leaf::Whole(rest)));
        out.push((plan.cost + rest_cost, leaves));
    }
    out
}

/// The row's back moved by `d` into the green.
fn shifted(union: &Union, d: f64, options: &ParcelOptions) -> Option<Path> {
    let (shape, border) = (&union.shape, &union.border);
    let n = shape.len();
    // The row lies to the left of its border, so the green to the right.
    let normals: Vec<P> = border
        .windows(2)
        .filter_map(|w| unit(w[1] - w[0]).map(|u| left(u) * -1.0))
        .collect();
    if normals.len() + 1 != border.len() {
        return None;
    }
    let mut inner = Vec::new();
    for (k, &p) in border.iter().enumerate() {
        let (a, b) = (
            normals[k.saturating_sub(1)],
            normals[k.min(normals.len() - 1)],
        );
        // Mitre, so that the offset edges stay parallel.
        let m = a + b;
        let l = dot(m, m);
        if l < 1.0 {
            return None;
        }
        inner.push(p + m * (2.0 * d / l));
    }
    // An end on a boundary that runs on from the row's side slides along it;
    // any other end is a leg out of the row's corner.
    let slide = |forward: bool, normal: P| -> Option<Mark> {
        let mut i = if forward { union.joint } else { 0 };
        let origin = shape.ring[i];
        for _ in 0..n {
            let j = if forward {
                (i + 1) % n
            } else {
                (i + n - 1) % n
            };
            let (p, q) = (shape.ring[i], shape.ring[j]);
            if angle(normal, q - p).abs() > 0.7 {
                return None;
            }
            let (hp, hq) = (dot(p - origin, normal), dot(q - origin, normal));
            if hq >= d {
                let at = lerp(p, q, (d - hp) / (hq - hp));
                return Some(shape.mark(if forward { i } else { j }, at, options.snap()));
            }
            i = j;
        }
        None
    };
    let corner = |i: usize| Mark {
        edge: i,
        vertex: true,
        at: shape.ring[i],
    };
    let (first, last) = (normals[0], normals[normals.len() - 1]);
    let from = match slide(true, first) {
        Some(mark) => {
            inner.remove(0);
            mark
        }
        None => corner(union.joint),
    };
    let to = match slide(false, last) {
        Some(mark) => {
            inner.pop();
            mark
        }
        None => corner(0),
    };
    Some(Path { from, inner, to })
}

#[cfg(test)]
mod tests {
    use super::super::geom::pt;
    use super::*;

    #[test]
    fn a_row_grows_into_the_land_behind_it() {
        // A row of 60 by 30 with 50 m of landlocked depth behind, of which
        // lots of up to about twice the depth can use a part.
        let block = Shape {
            ring: vec![pt(0., 0.), pt(60., 0.), pt(60., 80.), pt(0., 80.)],
            front: vec![true, false, false, false],
        };
        let options = ParcelOptions::default();
        let (a, b) = (
            block.mark(1, pt(60., 30.), 0.1),
            block.mark(3, pt(0., 30.), 0.1),
        );
        let (back, row) = block.cut(b, &[], a).expect("a cut across");
        let (row, back) = if row.frontage() > 1.0 {
            (row, back)
        } else {
            (back, row)
        };
        let mut bench = Bench::default();
        let mut leaves = quick(&row, &options, &mut bench).leaves;
        leaves.extend(quick(&back, &options, &mut bench).leaves);
        let before: f64 = leaves.iter().map(|l| l.0).sum();
        let after = absorb(&block, leaves, &options, &mut bench);
        assert!(after.iter().map(|l| l.0).sum::<f64>() < before - 1.0);
        let total: f64 = after.iter().map(|l| l.1.shape().area()).sum();
        assert!((total - 4800.0).abs() < 1e-9);
    }
}
