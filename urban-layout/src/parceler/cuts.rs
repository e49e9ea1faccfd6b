//! Structural cuts of a shape: the candidates of the search.

use super::geom::{angle, cross, dist, dot, left, lerp, nearest_on, ray_hit, unit, P};
use super::search::beyond;
use super::shape::{Chain, Mark, Shape};
use super::trace::{level_lines, simplify, Base, Level, Path};
use super::ParcelOptions;

/// How many kinds of cuts there are; the search takes one after the other.
pub(super) const KINDS: usize = 4;

/// Pairs of shapes that the cuts of one kind leave: left and right of the cut.
///
/// 0: spines between two fronts; 1: offsets of one front; 2: chords at reflex
/// corners; 3: chords straight across.
pub(super) fn cuts(shape: &Shape, options: &ParcelOptions, kind: usize) -> Vec<(Shape, Shape)> {
    let mut paths = Vec::new();
    let mut chains = shape.chains(options);
    chains.retain(|c| c.length >= 0.5 * options.good_frontage);
    chains.sort_by(|a, b| b.length.total_cmp(&a.length));
    chains.truncate(5);
    match kind {
        0 => spines(shape, &chains, options, &mut paths),
        1 => offsets(shape, &chains, options, &mut paths),
        2 => reflex(shape, options, &mut paths),
        _ => across(shape, &chains, options, &mut paths),
    }
    paths
        .iter()
        .filter_map(|p| shape.cut(p.from, &p.inner, p.to))
        .collect()
}

/// A front as a line to measure from: without detail far below a lot's size,
/// which a level line would not show and which costs time at every step.
fn base_line(shape: &Shape, chain: &Chain, options: &ParcelOptions) -> Vec<P> {
    let p = shape.chain_points(chain);
    let (a, b) = (p[0], p[p.len() - 1]);
    let mut out = vec![a];
    out.extend(simplify(a, &p[1..p.len() - 1], b, 0.004 * options.depth));
    out.push(b);
    out
}

fn step(options: &ParcelOptions) -> f64 {
    0.12 * options.depth
}

/// Lines halfway between two fronts, with the corner between neighbouring
/// fronts given to one of them.
fn spines(shape: &Shape, chains: &[Chain], options: &ParcelOptions, out: &mut Vec<Path>) {
    let snap = options.snap();
    for i in 0..chains.len() {
        for j in i + 1..chains.len() {
            let (a, b) = (
                shape.chain_points(&chains[i]),
                shape.chain_points(&chains[j]),
            );
            let level = Level::Between(Base::new(a.clone(), true), Base::new(b.clone(), true));
            for path in level_lines(shape, &level, step(options), snap) {
                corner_variants(shape, &path, [&a, &b], options, out);
                out.push(path);
            }
        }
    }
}

/// A spine that starts in the corner of its two fronts leaves two acute lots.
/// Instead, one row takes the corner: the line drops from the spine at the
/// row's depth straight onto the other front.
fn corner_variants(
    shape: &Shape,
    path: &Path,
    fronts: [&Vec<P>; 2],
    options: &ParcelOptions,
    out: &mut Vec<Path>,
) {
    let snap = options.snap();
    for backwards in [false, true] {
        let (from, to) = if backwards {
            (path.to, path.from)
        } else {
            (path.from, path.to)
        };
        let mut line: Vec<P> = vec![from.at];
        if backwards {
            line.extend(path.inner.iter().rev());
        } else {
            line.extend(path.inner.iter());
        }
        line.push(to.at);
        let touches = |f: &Vec<P>| f.iter().any(|&q| dist(q, from.at) < 0.5 * options.width);
        if !(touches(fronts[0]) && touches(fronts[1])) {
            continue;
        }
        for depth in [1.0, 0.7] {
            for front in fronts {
                // Walk until the spine is one row deep.
                let mut skip = 0.0;
                let mut found = None;
                while let Some(rest) = beyond(&line, skip) {
                    let (d, foot) = foot(front, rest[0]);
                    if d >= depth * options.depth {
                        found = Some((rest, foot));
                        break;
                    }
                    skip += 1.0;
                }
                let Some((rest, foot)) = found else { continue };
                let Some(mark) = locate(shape, foot, snap) else {
                    continue;
                };
                let inner = rest[..rest.len() - 1].to_vec();
                out.push(Path {
                    from: mark,
                    inner,
                    to,
                });
            }
        }
    }
}

/// Nearest point of a polyline.
fn foot(line: &[P], q: P) -> (f64, P) {
    let mut best = (f64::INFINITY, q);
    for w in line.windows(2) {
        let f = lerp(w[0], w[1], nearest_on(w[0], w[1], q));
        if dist(f, q) < best.0 {
            best = (dist(f, q), f);
        }
    }
    best
}

/// The mark of a point that lies on the ring.
fn locate(shape: &Shape, q: P, snap: f64) -> Option<Mark> {
    let mut best = (f64::INFINITY, 0, q);
    for i in 0..shape.len() {
        let (a, b) = shape.edge(i);
        let f = lerp(a, b, nearest_on(a, b, q));
        if dist(f, q) < best.0 {
            best = (dist(f, q), i, f);
        }
    }
    (best.0 < snap).then(|| shape.mark(best.1, best.2, snap))
}

/// Lines at a row's depth behind each front.
fn offsets(shape: &Shape, chains: &[Chain], options: &ParcelOptions, out: &mut Vec<Path>) {
    for c in chains.iter().take(4) {
        out.extend(offsets_of(shape, c, &[1.0, 1.35, 1.7, 0.8], options));
    }
}

/// Lines behind one front, at these multiples of the wished depth.
pub(super) fn offsets_of(
    shape: &Shape,
    chain: &Chain,
    depths: &[f64],
    options: &ParcelOptions,
) -> Vec<Path> {
    let base = Base::new(base_line(shape, chain, options), true);
    let mut out = Vec::new();
    for d in depths {
        let level = Level::At(base.clone(), d * options.depth);
        out.extend(level_lines(shape, &level, step(options), options.snap()));
    }
    out
}

/// The first thing that a ray from a mark meets.
fn shoot(shape: &Shape, from: Mark, dir: P, snap: f64) -> Option<Mark> {
    let n = shape.len();
    let mut best: Option<(f64, usize)> = None;
    for e in 0..n {
        if e == from.edge || (from.vertex && (e + 1) % n == from.edge) {
            continue;
        }
        let (a, b) = shape.edge(e);
        if let Some((t, _)) = ray_hit(from.at, dir, a, b) {
            if best.is_none_or(|x| t < x.0) {
                best = Some((t, e));
            }
        }
    }
    best.map(|(t, e)| shape.mark(e, from.at + dir * t, snap))
}

/// Chords from reflex corners: both edges run on, and the bisector.
fn reflex(shape: &Shape, options: &ParcelOptions, out: &mut Vec<Path>) {
    let n = shape.len();
    let mut corners: Vec<(f64, usize)> = Vec::new();
    for i in 0..n {
        let (p, q, r) = (
            shape.ring[(i + n - 1) % n],
            shape.ring[i],
            shape.ring[(i + 1) % n],
        );
        let turn = angle(q - p, r - q);
        if turn < -0.35 {
            corners.push((turn, i));
        }
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for &(_, i) in corners.iter().take(5) {
        let (p, q, r) = (
            shape.ring[(i + n - 1) % n],
            shape.ring[i],
            shape.ring[(i + 1) % n],
        );
        let (Some(u), Some(v)) = (unit(q - p), unit(q - r)) else {
            continue;
        };
        let from = Mark {
            edge: i,
            vertex: true,
            at: q,
        };
        let mut dirs = vec![u, v, left(r - q), left(q - p)];
        dirs.extend(unit(u + v));
        for d in dirs {
            if cross(q - p, d) < 0.0 && cross(r - q, d) < 0.0 {
                continue;
            }
            if let Some(to) = shoot(shape, from, d, options.snap()) {
                out.push(Path {
                    from,
                    inner: Vec::new(),
                    to,
                });
            }
        }
    }
}

/// Chords straight across from the two longest fronts.
fn across(shape: &Shape, chains: &[Chain], options: &ParcelOptions, out: &mut Vec<Path>) {
    for c in chains.iter().take(2) {
        let arc = super::shape::Arc::new(shape, c.start, c.count);
        let l = arc.total();
        for k in 1..=5 {
            let s = l * f64::from(k) / 6.0;
            if s < options.good_frontage || l - s < options.good_frontage {
                continue;
            }
            let (e, q) = arc.at(s);
            let from = shape.mark((c.start + e) % shape.len(), q, options.snap());
            let dir = arc.normal(s, 0.6 * options.width);
            let (a, b) = shape.edge((c.start + e) % shape.len());
            if dot(left(b - a), dir) <= 0.0 {
                continue;
            }
            if let Some(to) = shoot(shape, from, dir, options.snap()) {
                out.push(Path {
                    from,
                    inner: Vec::new(),
                    to,
                });
            }
        }
    }
}
