//! The best rungs of a row: dynamic programming, then polishing.
//!
//! The cost of a row is a sum over parcels, and a parcel depends on its two
//! rungs only. So the cheapest sequence of rungs from a grid of candidates
//! (places along the front times leans against its normal) is found exactly,
//! as a shortest path. The grid is coarse; polishing then moves each rung a
//! little, in place and lean, as long as its two parcels gain.

use super::geom::{angle, dist, turned, P};
use super::row::{Bench, Row, Rung};
use super::ParcelOptions;

/// Leans of candidate rungs, degrees against the front's normal.
const LEANS: [f64; 7] = [0.0, -6.0, 6.0, -13.0, 13.0, -22.0, 22.0];
/// Neighbouring rungs lean apart by no more than this, degrees.
const TWIST: f64 = 16.0;

/// A candidate rung: its place on the front and its lean.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    s: f64,
    lean: f64,
    rung: Rung,
}

/// Improves a row's rungs; the cost never rises.
pub(super) fn refine(
    row: &Row,
    cost: f64,
    rungs: &[Rung],
    options: &ParcelOptions,
    bench: &mut Bench,
) -> (f64, Vec<Rung>) {
    let mut best = polish(row, cost, rungs.to_vec(), options, bench);
    if best.0 > 0.05 * (best.1.len() + 1) as f64 {
        if let Some((c, found)) = shortest(row, &best.1, options, bench) {
            let other = polish(row, c, found, options, bench);
            if other.0 < best.0 {
                best = other;
            }
        }
    }
    best
}

/// Arc length of a rung's front end.
fn place(row: &Row, r: &Rung) -> f64 {
    let k = (r.uf.floor() as usize).min(row.m - 1);
    row.arc.s[k] + dist(row.arc.p[k], r.pf)
}

fn candidates(row: &Row, extra: &[Rung], options: &ParcelOptions) -> Vec<Candidate> {
    let l = row.length();
    let mut out: Vec<Candidate> = Vec::new();
    let steps = (l / (0.25 * options.width)).ceil().clamp(2.0, 90.0) as usize;
    // Corners of the back: a rung that ends there saves both parcels a bend.
    let n = row.shape.len();
    let back: Vec<usize> = (row.m + 1..n)
        .filter(|&i| {
            let (p, q, r) = (
                row.shape.ring[i - 1],
                row.shape.ring[i],
                row.shape.ring[(i + 1) % n],
            );
            angle(q - p, r - q).abs() > 0.2
        })
        .collect();
    for k in 1..steps {
        let s = l * k as f64 / steps as f64;
        let normal = row.normal(s);
        let t = s / l;
        let fan = (row.slant[0] * (1.0 - t) + row.slant[1] * t).to_degrees();
        let mut leans: Vec<f64> = LEANS.to_vec();
        if LEANS.iter().all(|&x| (x - fan).abs() > 2.0) {
            leans.push(fan);
        }
        for lean in leans {
            if let Some(rung) = row.rung(s, turned(normal, lean.to_radians())) {
                out.push(Candidate { s, lean, rung });
            }
        }
    }
    for &i in back.iter().take(24) {
        let q = row.shape.ring[i];
        // From the foot on the front, and from a little to either side.
        let Some((s0, _)) = foot(row, q) else {
            continue;
        };
        for ds in [0.0, -0.25, 0.25] {
            let s = s0 + ds * options.width;
            if s <= 0.0 || s >= l {
                continue;
            }
            let from = row.arc.at(s).1;
            let lean = angle(row.normal(s), q - from).to_degrees();
            if lean.abs() < 30.0 {
                if let Some(rung) = row.rung(s, q - from) {
                    if dist(rung.pb, q) < options.snap() {
                        out.push(Candidate { s, lean, rung });
                    }
                }
            }
        }
    }
    for rung in extra {
        let s = place(row, rung);
        let lean = angle(row.normal(s), rung.pb - rung.pf).to_degrees();
        out.push(Candidate {
            s,
            lean,
            rung: *rung,
        });
    }
    out.sort_by(|a, b| a.s.total_cmp(&b.s).then(a.lean.total_cmp(&b.lean)));
    out
}

/// The front's place nearest to `q`.
fn foot(row: &Row, q: P) -> Option<(f64, f64)> {
    let mut best: Option<(f64, f64)> = None;
    for k in 0..row.m {
        let (a, b) = (row.arc.p[k], row.arc.p[k + 1]);
        let t = super::geom::nearest_on(a, b, q);
        let d = dist(super::geom::lerp(a, b, t), q);
        if best.is_none_or(|x| d < x.1) {
            best = Some((row.arc.s[k] + t * dist(a, b), d));
        }
    }
    best
}

/// The cheapest sequence of candidate rungs.
fn shortest(
    row: &Row,
    extra: &[Rung],
    options: &ParcelOptions,
    bench: &mut Bench,
) -> Option<(f64, Vec<Rung>)> {
    let l = row.length();
    let all = candidates(row, extra, options);
    let (first, last) = (row.first(), row.last());
    let lot = options.depth * options.width;
    let (lo, hi) = (0.45 * options.width, 1.75 * options.width);
    // cost and predecessor of the cheapest way to end with candidate i
    let mut way: Vec<(f64, usize)> = vec![(f64::INFINITY, usize::MAX); all.len()];
    let mut end = (f64::INFINITY, usize::MAX);
    for j in 0..=all.len() {
        let (s, rung) = if j < all.len() {
            (all[j].s, all[j].rung)
        } else {
            (l, last)
        };
        let final_one = j == all.len();
        let mut best = (f64::INFINITY, usize::MAX);
        // End parcels may be wider: they often must take a slanted corner.
        let reach = if final_one { 1.6 * hi } else { hi };
        if s <= 1.6 * hi && Row::ordered(&first, &rung) {
            best = (row.assess(&first, &rung, options, bench).0, usize::MAX);
        }
        for i in (0..j.min(all.len())).rev() {
            let w = s - all[i].s;
            if w > reach {
                break;
            }
            if w < lo || way[i].0 >= best.0 || !Row::ordered(&all[i].rung, &rung) {
                continue;
            }
            if !final_one {
                if (all[i].lean - all[j].lean).abs() > TWIST {
                    continue;
                }
                // The four corners tell when the size is hopeless.
                let a = super::geom::area(&[all[i].rung.pf, rung.pf, rung.pb, all[i].rung.pb]);
                if a < 0.4 * lot || a > 2.6 * lot {
                    continue;
                }
            }
            let c = way[i].0 + row.assess(&all[i].rung, &rung, options, bench).0;
            if c < best.0 {
                best = (c, i);
            }
        }
        if final_one {
            end = best;
        } else {
            way[j] = best;
        }
    }
    if !end.0.is_finite() {
        return None;
    }
    let mut rungs = Vec::new();
    let mut i = end.1;
    while i != usize::MAX {
        rungs.push(all[i].rung);
        i = way[i].1;
    }
    rungs.reverse();
    Some((end.0, rungs))
}

/// Moves and leans single rungs, and drops rungs, while that helps.
fn polish(
    row: &Row,
    cost: f64,
    mut rungs: Vec<Rung>,
    options: &ParcelOptions,
    bench: &mut Bench,
) -> (f64, Vec<Rung>) {
    let mut total = cost;
    let (first, last) = (row.first(), row.last());
    for scale in [1.0, 0.4, 0.15] {
        for _ in 0..3 {
            let mut gained = 0.0;
            let mut k = 0;
            while k < rungs.len() {
                let before = if k == 0 { first } else { rungs[k - 1] };
                let after = if k + 1 < rungs.len() {
                    rungs[k + 1]
                } else {
                    last
                };
                let now = row.assess(&before, &rungs[k], options, bench).0
                    + row.assess(&rungs[k], &after, options, bench).0;
                if now < 0.05 {
                    k += 1;
                    continue;
                }
                if Row::ordered(&before, &after) {
                    let merged = row.assess(&before, &after, options, bench).0;
                    if merged < now - 1e-6 {
                        gained += now - merged;
                        total -= now - merged;
                        rungs.remove(k);
                        continue;
                    }
                }
                let s = place(row, &rungs[k]);
                let dir = rungs[k].pb - rungs[k].pf;
                let mut best = (now, rungs[k]);
                let (ds, da) = (0.12 * options.width * scale, 0.09 * scale);
                for (x, y) in [
                    (1.0, 0.0),
                    (-1.0, 0.0),
                    (0.0, 1.0),
                    (0.0, -1.0),
                    (1.0, 1.0),
                    (-1.0, -1.0),
                    (1.0, -1.0),
                    (-1.0, 1.0),
                ] {
                    let Some(r) = row.rung(s + x * ds, turned(dir, y * da)) else {
                        continue;
                    };
                    if !Row::ordered(&before, &r) || !Row::ordered(&r, &after) {
                        continue;
                    }
                    let c = row.assess(&before, &r, options, bench).0;
                    if c >= best.0 {
                        continue;
                    }
                    let c = c + row.assess(&r, &after, options, bench).0;
                    if c < best.0 - 1e-9 {
                        best = (c, r);
                    }
                }
                gained += now - best.0;
                total -= now - best.0;
                rungs[k] = best.1;
                k += 1;
            }
            if gained < 0.01 {
                break;
            }
        }
    }
    (total, rungs)
}

#[cfg(test)]
mod tests {
    use super::super::geom::pt;
    use super::super::shape::Shape;
    use super::*;

    #[test]
    fn rungs_find_the_corners_of_a_jagged_back() {
        // The back steps down at x = 40: no regular rung hits that.
        let shape = Shape {
            ring: vec![
                pt(0., 0.),
                pt(80., 0.),
                pt(80., 24.),
                pt(41., 24.),
                pt(41., 36.),
                pt(0., 36.),
            ],
            front: vec![true, false, false, false, false, false],
        };
        let options = ParcelOptions::default();
        let chain = shape.chains(&options)[0];
        let row = Row::new(&shape, &chain, &options).expect("a row");
        let mut bench = Bench::default();
        let (c0, rungs) = row.regular(&options, &mut bench).expect("slices");
        let (c1, better) = refine(&row, c0, &rungs, &options, &mut bench);
        assert!(c1 < c0 && c1 < 0.3, "{c0} {c1}");
        let sum = row
            .total(&better, &options, &mut bench, f64::INFINITY)
            .expect("ordered");
        assert!((sum - c1).abs() < 1e-9);
        let area: f64 = row
            .shapes(&better, &mut bench)
            .iter()
            .map(Shape::area)
            .sum();
        assert!((area - shape.area()).abs() < 1e-9);
    }
}
