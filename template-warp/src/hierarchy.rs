//! From blocks to rows to parcels (paper, Fig. 5): each level is initialised,
//! optimised, and hands its areas down as regions of their own.

use crate::error::WarpError;
use crate::geometry::{cross, dist, dot, norm, p, signed_area, simplify, Path, P};
use crate::instance::{Domain, DomainSide, Instance};
use crate::library::Library;
use crate::region::EdgeUse;
use crate::solve::Anchor;
use crate::template::model::Template;
use crate::warp::WarpOptions;
use std::collections::BTreeMap;

/// Levels below a block; deeper nesting is an error of the library.
const MAX_DEPTH: usize = 6;

/// Share of a parcel's width within which a division moves onto a vertex of the
/// side on which it slides, so that no sliver edges arise.
const SNAP: f64 = 0.02;

/// Share of a parcel's width within which divisions of two rows meet at one
/// point of the line between them instead of two.
const MEET: f64 = 0.08;

/// Share of a parcel's width by which a line between rows may be simplified.
const SMOOTH: f64 = 0.004;

/// A face that is not replaced by a template.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub(crate) label: String,
    pub(crate) ring: Vec<P>,
    pub(crate) ideal_area: f64,
    /// Mean squared registration distance, square metres.
    pub(crate) mean_square: f64,
    pub(crate) access_exempt: bool,
}

/// All pieces of a warped template.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pieces {
    pub(crate) faces: Vec<Piece>,
    pub(crate) centrelines: Vec<Vec<P>>,
    pub(crate) iterations: usize,
}

impl Pieces {
    /// Mean squared registration distance over the faces other than streets,
    /// weighted by their areas: one spoilt park counts like the parcels that
    /// would have room in it.
    pub(crate) fn mean_square(&self) -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for face in self.faces.iter().filter(|f| f.label != "street") {
            let area = signed_area(&face.ring).abs();
            sum += area * face.mean_square;
            total += area;
        }
        if total > 0.0 {
            sum / total
        } else {
            0.0
        }
    }
}

/// Warps a template to a domain with as many corners, and its areas after it.
pub(crate) fn warp_domain(
    library: &Library,
    template: &Template,
    domain: &Domain,
    options: &WarpOptions,
    level: usize,
) -> Result<Pieces, WarpError> {
    let bad = |problem: String| WarpError::BadTemplate {
        template: template.name.clone(),
        problem,
    };
    if level > MAX_DEPTH {
        return Err(bad(format!(
            "its children nest deeper than {MAX_DEPTH} levels; check for a cycle"
        )));
    }
    let sizes = library.sizes();
    let mut instance = Instance::new(template, domain);
    let solution = instance.problem.solve(options, sizes.parcel_area());
    snap(&mut instance, SNAP * sizes.parcel_width);

    let outline = Outline::new(&instance, domain);
    let mut out = Pieces {
        iterations: solution.iterations,
        ..Pieces::default()
    };
    let mut between_areas: Vec<Vec<P>> = Vec::new();
    let tolerance = SMOOTH * sizes.parcel_width;
    for edge in outline.edges.keys() {
        if outline.between_areas(*edge)
            && outline.rim(edge.0, edge.1).is_none()
            && outline.rim(edge.1, edge.0).is_none()
        {
            between_areas.push(outline.polyline(edge.0, edge.1, tolerance));
        }
    }
    for (k, face) in template.faces.iter().enumerate() {
        if !face.is_area() {
            for c in instance.cells_of[k].clone() {
                let nodes = &instance.problem.cells[c].nodes;
                let n = nodes.len();
                let mut ring = Vec::new();
                for i in 0..n {
                    ring.extend(outline.piece(nodes[i], nodes[(i + 1) % n]));
                }
                out.faces.push(Piece {
                    label: face.label.clone(),
                    ring,
                    ideal_area: instance.ideal_area[c],
                    mean_square: instance.problem.mean_square(c, &solution.maps[c]),
                    access_exempt: face.access_exempt,
                });
            }
            continue;
        }
        let sub = outline.subdomain(k, tolerance);
        let mut best: Option<(f64, Pieces)> = None;
        let mut refused = None;
        for name in &face.child {
            let child = library.find(name)?;
            if child.sides.len() != sub.sides.len() {
                return Err(bad(format!(
                    "face {k} has {} corners but its child `{name}` has {}",
                    sub.sides.len(),
                    child.sides.len()
                )));
            }
            match warp_domain(library, child, &sub, options, level + 1) {
                Ok(pieces) => {
                    let cost = pieces.mean_square() / child.probability;
                    if best.as_ref().is_none_or(|b| cost < b.0) {
                        best = Some((cost, pieces));
                    }
                }
                Err(e) => refused = Some(e),
            }
        }
        let Some((_, pieces)) = best else {
            return Err(refused.unwrap_or_else(|| bad(format!("face {k} has no child"))));
        };
        out.iterations = out.iterations.max(pieces.iterations);
        out.faces.extend(pieces.faces);
        out.centrelines.extend(pieces.centrelines);
    }
    for line in &between_areas {
        meet(line, &mut out.faces, MEET * sizes.parcel_width);
    }
    for line in &template.centrelines {
        let cell = instance.cells_of[line.face].start;
        let points = line
            .points
            .iter()
            .map(|&k| {
                if instance.problem.owned(k) || instance.problem.anchor[k] != Anchor::Free {
                    instance.problem.pos[k]
                } else {
                    solution.maps[cell].apply(in_frame(template, line.face, template.points[k]))
                }
            })
            .collect();
        out.centrelines.push(points);
    }
    Ok(out)
}

/// A point of the drawing in the frame of an undivided face.
fn in_frame(template: &Template, face: usize, q: P) -> P {
    let corners = &template.faces[face].corners;
    let o = template.points[corners[0]];
    let u = template.points[corners[1 % corners.len()]] - o;
    let l = norm(u).max(f64::MIN_POSITIVE);
    p(dot(q - o, u) / l, cross(u, q - o) / l)
}

/// Moves sliding nodes onto vertices of their sides that are very near.
fn snap(instance: &mut Instance<'_>, reach: f64) {
    let problem = &mut instance.problem;
    for k in 0..problem.pos.len() {
        if let Anchor::Side(side) = problem.anchor[k] {
            let s = problem.paths[side].snap(problem.param[k], reach);
            // The ends of a side are corners, which have nodes of their own.
            if s > 0.0 && s < problem.paths[side].length() {
                problem.param[k] = s;
                problem.pos[k] = problem.paths[side].at(s);
            }
        }
    }
}

/// The edges of an instance with what lies along and across them.
struct Outline<'a> {
    instance: &'a Instance<'a>,
    domain: &'a Domain,
    /// For successive nodes of the boundary: side and arc lengths.
    rim: BTreeMap<(usize, usize), (usize, f64, f64)>,
    /// Faces at each edge of the drawing (points in increasing order).
    edges: BTreeMap<(usize, usize), Vec<usize>>,
}

impl<'a> Outline<'a> {
    fn new(instance: &'a Instance<'a>, domain: &'a Domain) -> Self {
        let template = instance.template;
        let mut edges: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
        for (f, face) in template.faces.iter().enumerate() {
            let n = face.points.len();
            for i in 0..n {
                let (a, b) = (face.points[i], face.points[(i + 1) % n]);
                edges.entry((a.min(b), a.max(b))).or_default().push(f);
            }
        }
        let mut outline = Self {
            instance,
            domain,
            rim: BTreeMap::new(),
            edges,
        };
        for (k, side) in template.sides.iter().enumerate() {
            let length = domain.sides[k].path.length();
            let mut s = 0.0;
            for e in side.nodes.windows(2) {
                let chain = outline.chain(e[0], e[1]);
                for pair in chain.windows(2) {
                    let end = if Some(&pair[1]) == side.nodes.last() {
                        length
                    } else {
                        instance.problem.param[pair[1]]
                    };
                    outline.rim.insert((pair[0], pair[1]), (k, s, end));
                    s = end;
                }
            }
        }
        outline
    }

    /// All nodes of an edge of the drawing, both ends included.
    fn chain(&self, a: usize, b: usize) -> Vec<usize> {
        let mut v = vec![a];
        if let Some(nodes) = self.instance.inner.get(&(a.min(b), a.max(b))) {
            if a < b {
                v.extend(nodes.iter());
            } else {
                v.extend(nodes.iter().rev());
            }
        }
        v.push(b);
        v
    }

    /// Side and arc lengths of a stretch of boundary from node `a` to node `b`,
    /// walked counter-clockwise.
    fn rim(&self, a: usize, b: usize) -> Option<(usize, f64, f64)> {
        let chain = self.chain(a, b);
        let mut whole: Option<(usize, f64, f64)> = None;
        for pair in chain.windows(2) {
            let &(k, s0, s1) = self.rim.get(&(pair[0], pair[1]))?;
            whole = Some(whole.map_or((k, s0, s1), |w| (w.0, w.1, s1)));
        }
        whole
    }

    /// Whether only faces that are handed down lie at the edge.
    fn between_areas(&self, edge: (usize, usize)) -> bool {
        let faces = &self.instance.template.faces;
        self.edges
            .get(&edge)
            .is_some_and(|f| f.iter().all(|&k| faces[k].is_area()))
    }

    /// Points from node `a` up to but without node `b`, adjacent in a cell.
    fn piece(&self, a: usize, b: usize) -> Vec<P> {
        let mut points = vec![self.instance.problem.pos[a]];
        if let Some(&(k, s0, s1)) = self.rim.get(&(a, b)) {
            let path = &self.domain.sides[k].path;
            points.extend(path.between(s0, s1).map(|i| path.points[i]));
        }
        points
    }

    /// Points of an edge of the drawing, both ends included.
    fn polyline(&self, a: usize, b: usize, tolerance: f64) -> Vec<P> {
        let pos = &self.instance.problem.pos;
        let edge = (a.min(b), a.max(b));
        if let Some((k, s0, s1)) = self.rim(a, b) {
            let path = &self.domain.sides[k].path;
            let mut points = vec![pos[a]];
            if self.between_areas(edge) {
                points.extend(path.between(s0, s1).map(|i| path.points[i]));
            } else {
                let chain = self.chain(a, b);
                points.clear();
                for pair in chain.windows(2) {
                    points.extend(self.piece(pair[0], pair[1]));
                }
            }
            points.push(pos[b]);
            return points;
        }
        // One computation per edge, in one direction, so that both sides agree.
        let mut points: Vec<P> = self.chain(edge.0, edge.1).iter().map(|&k| pos[k]).collect();
        if self.between_areas(edge) {
            points = simplify(&points, tolerance);
        }
        if a > b {
            points.reverse();
        }
        points
    }

    /// The region of a face that is handed down.
    fn subdomain(&self, f: usize, tolerance: f64) -> Domain {
        let template = self.instance.template;
        let face = &template.faces[f];
        let n = face.points.len();
        let at = |c: usize| face.points.iter().position(|&q| q == c).unwrap_or(0);
        let m = face.corners.len();
        let mut sides = Vec::with_capacity(m);
        for c in 0..m {
            let (mut i, end) = (at(face.corners[c]), at(face.corners[(c + 1) % m]));
            let mut points: Vec<P> = Vec::new();
            let mut uses: Vec<EdgeUse> = Vec::new();
            while i != end {
                let (a, b) = (face.points[i], face.points[(i + 1) % n]);
                let line = self.polyline(a, b, tolerance);
                match self.rim(a, b) {
                    Some((k, start, _)) => {
                        // The line lies on the side, so lengths along it add up.
                        let side = &self.domain.sides[k];
                        let mut s = start;
                        for e in line.windows(2) {
                            let l = dist(e[0], e[1]);
                            let i = side
                                .path
                                .along
                                .partition_point(|&v| v <= s + 0.5 * l)
                                .saturating_sub(1);
                            uses.push(side.uses.get(i).copied().unwrap_or(EdgeUse::NoStreet));
                            s += l;
                        }
                    }
                    None => {
                        let edge = (a.min(b), a.max(b));
                        let street = self.edges.get(&edge).is_some_and(|fs| {
                            fs.iter()
                                .any(|&g| g != f && template.faces[g].label == "street")
                        });
                        let across = if street {
                            EdgeUse::Street
                        } else {
                            EdgeUse::NoStreet
                        };
                        uses.extend(std::iter::repeat_n(across, line.len() - 1));
                    }
                }
                points.pop();
                points.extend(line);
                i = (i + 1) % n;
            }
            sides.push(DomainSide {
                path: Path::new(points),
                uses,
            });
        }
        Domain { sides }
    }
}

/// Lets divisions of the rows on both sides of `line` end at one point where
/// they nearly do.
fn meet(line: &[P], faces: &mut [Piece], reach: f64) {
    let path = Path::new(line.to_vec());
    let length = path.length();
    let near = 1e-9 * length;
    let mut on: Vec<(f64, P)> = Vec::new();
    for q in faces.iter().flat_map(|f| f.ring.iter()) {
        let s = path.nearest(*q);
        if dist(path.at(s), *q) <= near {
            on.push((s, *q));
        }
    }
    on.sort_by(|a, b| a.0.total_cmp(&b.0));
    on.dedup_by(|a, b| a.1 == b.1);
    let fixed = |s: f64| path.along.iter().copied().find(|a| (a - s).abs() <= near);
    let mut moves: Vec<(P, P)> = Vec::new();
    let mut i = 0;
    while i < on.len() {
        let mut j = i + 1;
        while j < on.len() && on[j].0 - on[i].0 < reach {
            j += 1;
        }
        let group = &on[i..j];
        // A vertex of the line, and above all an end of it, stays in place.
        let hold = group
            .iter()
            .find_map(|g| fixed(g.0).filter(|&a| a <= 0.0 || a >= length))
            .or_else(|| group.iter().find_map(|g| fixed(g.0)));
        let others = group.iter().filter(|g| fixed(g.0).is_none()).count();
        if group.len() > 1 && others > 0 {
            let s =
                hold.unwrap_or_else(|| group.iter().map(|g| g.0).sum::<f64>() / group.len() as f64);
            let target = path.at(s);
            moves.extend(
                group
                    .iter()
                    .filter(|g| fixed(g.0).is_none())
                    .map(|g| (g.1, target)),
            );
        }
        i = j;
    }
    for q in faces.iter_mut().flat_map(|f| f.ring.iter_mut()) {
        if let Some(m) = moves.iter().find(|m| m.0 == *q) {
            *q = m.1;
        }
    }
    for face in faces {
        face.ring.dedup();
        if face.ring.len() > 1 && face.ring.first() == face.ring.last() {
            face.ring.pop();
        }
    }
}
