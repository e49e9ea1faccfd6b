//! Local repairs on the mesh: pairs of pieces are joined or divided anew.
//!
//! The search works row by row and never looks across a row's border. Here
//! every bad parcel (and every green with a street on it) is joined with one
//! neighbour at a time; the pair stays one parcel, or is cut again by the best
//! chord found from any of its sides, if that lowers the cost.

use std::collections::BTreeMap;

use super::geom::{turned, P};
use super::quality::{cost, measure};
use super::row::{Bench, Row, Rung};
use super::shape::Shape;
use super::weld::Mesh;
use super::ParcelOptions;

/// Pieces that cost less than this are left alone.
const WORTH: f64 = 0.45;
/// Leans of the chords tried, degrees against the side's normal.
const LEANS: [f64; 7] = [0.0, -7.0, 7.0, -15.0, 15.0, -25.0, 25.0];

/// Joins and recuts pairs until nothing gains or the passes are used up.
pub(super) fn improve(mesh: &mut Mesh, options: &ParcelOptions, bench: &mut Bench) {
    let mut tried: BTreeMap<(usize, usize), (u64, u64)> = BTreeMap::new();
    // A piece's version changes when its ring does: no pair is tried twice.
    let mut version: Vec<u64> = vec![0; mesh.rings.len()];
    for _ in 0..3 {
        let mut order: Vec<(f64, usize)> = (0..mesh.rings.len())
            .filter(|&r| !mesh.rings[r].is_empty())
            .map(|r| (piece_cost(mesh, r, options, bench), r))
            .filter(|x| x.0 > WORTH)
            .collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut gained = false;
        for (_, r) in order {
            if mesh.rings[r].is_empty() {
                continue;
            }
            let here = piece_cost(mesh, r, options, bench);
            if here <= WORTH {
                continue;
            }
            let mut best: Option<(f64, usize, Change)> = None;
            for q in mesh.neighbours(r) {
                let key = (r.min(q), r.max(q));
                let stamp = (version[key.0], version[key.1]);
                if tried.get(&key) == Some(&stamp) {
                    continue;
                }
                tried.insert(key, stamp);
                // A big green behind a lot offers thousands of chords and no gain.
                if mesh.area(r) + mesh.area(q) > 4.5 * options.depth * options.width {
                    continue;
                }
                let now = here + piece_cost(mesh, q, options, bench);
                let Some(union) = mesh.union(r, q) else {
                    continue;
                };
                if let Some((c, change)) = best_change(&union.shape, now - 0.03, options, bench) {
                    let gain = now - c;
                    if best.as_ref().is_none_or(|b| gain > b.0) {
                        best = Some((gain, q, change));
                    }
                }
            }
            if let Some((_, q, change)) = best {
                if apply(mesh, r, q, change, options) {
                    version[r] += 1;
                    version[q] += 1;
                    gained = true;
                }
            }
        }
        if !gained {
            break;
        }
    }
    mesh.drop_empty();
}

/// What to do with a union of two pieces.
#[derive(Clone, Debug)]
enum Change {
    /// One parcel.
    Join,
    /// Two pieces: the shape turned as the row had it, the front's edge
    /// count, and the rung.
    Cut {
        start: usize,
        count: usize,
        rung: Rung,
    },
}

fn piece_cost(mesh: &Mesh, r: usize, options: &ParcelOptions, bench: &mut Bench) -> f64 {
    let s = mesh.shape(r);
    price(&s.ring, &s.front, options, bench)
}

fn price(ring: &[P], front: &[bool], options: &ParcelOptions, bench: &mut Bench) -> f64 {
    bench.work += 1;
    cost(&measure(ring, front, &mut bench.scratch), options)
}

/// The cheapest way to use a shape as one or two pieces, if below `limit`.
fn best_change(
    shape: &Shape,
    limit: f64,
    options: &ParcelOptions,
    bench: &mut Bench,
) -> Option<(f64, Change)> {
    let mut best: Option<(f64, Change)> = None;
    let mut bound = limit;
    let whole = price(&shape.ring, &shape.front, options, bench);
    if whole < bound {
        bound = whole;
        best = Some((whole, Change::Join));
    }
    let lot = options.depth * options.width;
    let total = shape.area();
    if shape.frontage() < options.min_frontage || total < 0.6 * lot {
        return best;
    }
    // Every side in turn serves as the line that the chord leaves.
    let sides = Shape {
        ring: shape.ring.clone(),
        front: vec![true; shape.len()],
    };
    let n = shape.len();
    let mut done = vec![false; n];
    for side in sides.chains(options) {
        let Some(row) = Row::new(shape, &side, options) else {
            continue;
        };
        let l = row.length();
        let steps = (l / (0.17 * options.width)).ceil().clamp(2.0, 24.0) as usize;
        for k in 1..steps {
            let s = l * k as f64 / steps as f64;
            let normal = row.normal(s);
            for lean in LEANS {
                let Some(rung) = row.rung(s, turned(normal, lean.to_radians())) else {
                    continue;
                };
                // From the side it meets, the like of it has been tried.
                if done[(side.start + rung.ub.floor() as usize) % n] {
                    continue;
                }
                let (first, last) = (row.first(), row.last());
                if !Row::ordered(&first, &rung) || !Row::ordered(&rung, &last) {
                    continue;
                }
                row.parcel(&first, &rung, bench);
                let a = super::geom::area(&bench.ring);
                if a < 0.3 * lot || total - a < 0.3 * lot {
                    continue;
                }
                let c = price_bench(options, bench);
                if c >= bound {
                    continue;
                }
                row.parcel(&rung, &last, bench);
                let c = c + price_bench(options, bench);
                if c < bound {
                    bound = c;
                    best = Some((
                        c,
                        Change::Cut {
                            start: side.start,
                            count: side.count,
                            rung,
                        },
                    ));
                }
            }
        }
        for k in 0..side.count {
            done[(side.start + k) % n] = true;
        }
    }
    best
}

/// Price of the parcel on the bench, as the kind that costs less.
fn price_bench(options: &ParcelOptions, bench: &mut Bench) -> f64 {
    bench.work += 1 + bench.ring.len() / 8;
    let q = measure(&bench.ring, &bench.front, &mut bench.scratch);
    cost(&q, options)
}

/// Carries out a change of pieces `r` and `q`.
fn apply(mesh: &mut Mesh, r: usize, q: usize, change: Change, options: &ParcelOptions) -> bool {
    let Some(union) = mesh.union(r, q) else {
        return false;
    };
    match change {
        Change::Join => {
            mesh.rings[r] = union.ids;
            mesh.front[r] = union.shape.front;
            mesh.rings[q].clear();
            mesh.front[q].clear();
        }
        Change::Cut { start, count, rung } => {
            let chain = super::shape::Chain {
                start,
                count,
                length: f64::INFINITY,
            };
            let Some(row) = Row::new(&union.shape, &chain, options) else {
                return false;
            };
            let n = union.ids.len();
            // Numbers of the rung's two ends, new points put into the
            // neighbour's ring as well.
            let mut ids = union.ids.clone();
            ids.rotate_left(start);
            let front = &row.shape.front;
            let mut end = |u: f64, p: P| {
                let k = (u.floor() as usize) % n;
                if u == u.floor() {
                    ids[k]
                } else {
                    mesh.insert(ids[k], ids[(k + 1) % n], p)
                }
            };
            let (a, b) = (end(rung.uf, rung.pf), end(rung.ub, rung.pb));
            let walk = |u0: f64, p0: usize, u1: f64, p1: usize| {
                let (mut ring, mut flags) = (vec![p0], vec![front[(u0.floor() as usize) % n]]);
                let mut k = u0.floor() as usize + 1;
                while (k as f64) < u1 {
                    ring.push(ids[k % n]);
                    flags.push(front[k % n]);
                    k += 1;
                }
                ring.push(p1);
                flags.push(false);
                (ring, flags)
            };
            let (right, right_front) = walk(rung.uf, a, rung.ub, b);
            let (left, left_front) = walk(rung.ub, b, rung.uf + n as f64, a);
            for (t, ring, flags) in [(r, left, left_front), (q, right, right_front)] {
                mesh.rings[t] = ring;
                mesh.front[t] = flags;
            }
        }
    }
    mesh.refresh();
    true
}
