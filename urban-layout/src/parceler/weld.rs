//! The pieces as one mesh: shared vertices, no vertex on a neighbour's edge.
//!
//! Pieces are cut one by one, so a dividing line may end on an edge whose
//! other side has been cut already. The mesh numbers the points, puts every
//! point that lies on an edge into that edge, and so makes neighbours share
//! their boundary vertex by vertex.

use std::collections::BTreeMap;

use geo_types::Coord;

use super::geom::{area, dist, is_simple, lerp, nearest_on, P};
use super::quality::{is_green, measure, Scratch};
use super::shape::Shape;
use super::{ParcelOptions, Piece, PieceKind};

/// Pieces over a common list of points.
#[derive(Clone, Debug)]
pub(super) struct Mesh {
    pub(super) points: Vec<P>,
    /// Rings of point numbers; the first points are the block's own vertices.
    pub(super) rings: Vec<Vec<usize>>,
    /// For each ring, which of its edges give access.
    pub(super) front: Vec<Vec<bool>>,
    pub(super) green: Vec<bool>,
    /// How many points are the block's own.
    pub(super) own: usize,
    eps: f64,
    /// Directed edge to ring and place, kept by [`Mesh::refresh`].
    edges: BTreeMap<(usize, usize), (usize, usize)>,
}

/// Two pieces as one.
#[derive(Clone, Debug)]
pub(super) struct Union {
    pub(super) ids: Vec<usize>,
    pub(super) shape: Shape,
    /// Place on the ring where the first piece ends and the second begins;
    /// the second ends, and the first begins, at place 0.
    pub(super) joint: usize,
    /// The edges that both had in common, from the joint to place 0.
    pub(super) border: Vec<P>,
}

impl Mesh {
    /// Numbers the points of the parts and puts in the missing vertices.
    pub(super) fn new(block: &Shape, parts: &[Shape], options: &ParcelOptions) -> Self {
        let size = block
            .ring
            .iter()
            .fold(options.width, |m, p| m.max(p.x.abs()).max(p.y.abs()));
        let mut mesh = Self {
            points: block.ring.clone(),
            rings: Vec::new(),
            front: Vec::new(),
            green: Vec::new(),
            own: block.len(),
            eps: 1e-10 * size,
            edges: BTreeMap::new(),
        };
        // The same place may have been computed twice, from either side of a
        // line, with different last digits: points within a hair are one.
        let mut number = Numbering::new(1e-7 * options.width);
        for &p in &block.ring {
            number.insert(p);
        }
        for part in parts {
            let mut ring: Vec<usize> = Vec::with_capacity(part.len());
            let mut front = Vec::with_capacity(part.len());
            for (&p, &f) in part.ring.iter().zip(&part.front) {
                let (id, new) = number.find(p);
                if new {
                    mesh.points.push(p);
                }
                if ring.last() == Some(&id) {
                    front.pop();
                } else {
                    ring.push(id);
                }
                front.push(f);
            }
            if ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
                front.pop();
            }
            mesh.rings.push(ring);
            mesh.front.push(front);
            mesh.green.push(false);
        }
        mesh.weld();
        mesh.refresh();
        mesh
    }

    /// Numbers the edges anew, after rings have changed.
    pub(super) fn refresh(&mut self) {
        self.edges.clear();
        for (r, ring) in self.rings.iter().enumerate() {
            for i in 0..ring.len() {
                self.edges
                    .insert((ring[i], ring[(i + 1) % ring.len()]), (r, i));
            }
        }
    }

    /// Ring and place of a directed edge.
    pub(super) fn find_edge(&self, edge: (usize, usize)) -> Option<(usize, usize)> {
        self.edges.get(&edge).copied()
    }

    /// Puts a new point on the edge `a` to `b`, in the rings on both sides,
    /// and returns its number. Call [`Mesh::refresh`] once done.
    pub(super) fn insert(&mut self, a: usize, b: usize, p: P) -> usize {
        let id = self.points.len();
        self.points.push(p);
        for edge in [(a, b), (b, a)] {
            if let Some(&(r, _)) = self.edges.get(&edge) {
                // Earlier insertions may have moved the place.
                let ring = &mut self.rings[r];
                let n = ring.len();
                if let Some(i) = (0..n).find(|&i| (ring[i], ring[(i + 1) % n]) == edge) {
                    ring.insert(i + 1, id);
                    let f = self.front[r][i];
                    self.front[r].insert(i + 1, f);
                }
            }
        }
        id
    }

    /// The pieces that share an edge with piece `r`, in order round it.
    pub(super) fn neighbours(&self, r: usize) -> Vec<usize> {
        let mut out = Vec::new();
        let ring = &self.rings[r];
        for i in 0..ring.len() {
            let twin = (ring[(i + 1) % ring.len()], ring[i]);
            if let Some((q, _)) = self.find_edge(twin) {
                if q != r && !out.contains(&q) {
                    out.push(q);
                }
            }
        }
        out
    }

    /// Pieces `r` and `q` joined, if what they share is one stretch of edges.
    pub(super) fn union(&self, r: usize, q: usize) -> Option<Union> {
        let (a, b) = (&self.rings[r], &self.rings[q]);
        let (n, m) = (a.len(), b.len());
        let shared: Vec<bool> = (0..n)
            .map(|i| {
                self.find_edge((a[(i + 1) % n], a[i]))
                    .is_some_and(|(t, _)| t == q)
            })
            .collect();
        // The first edge of the stretch, and that there is only one.
        let mut starts = (0..n).filter(|&i| shared[i] && !shared[(i + n - 1) % n]);
        let start = starts.next()?;
        if starts.next().is_some() {
            return None;
        }
        let len = (0..n).take_while(|&k| shared[(start + k) % n]).count();
        let (mut ids, mut front) = (Vec::new(), Vec::new());
        // Round the first piece from the stretch's end to its start.
        for k in len..n {
            let i = (start + k) % n;
            ids.push(a[i]);
            front.push(self.front[r][i]);
        }
        // Round the second piece from there back to the stretch's end.
        let from = b.iter().position(|&id| id == a[start])?;
        for k in 0..m - len {
            let i = (from + k) % m;
            ids.push(b[i]);
            front.push(self.front[q][i]);
        }
        // A stretch with no more than its ends in common, or a pinch: no ring.
        let mut sorted = ids.clone();
        sorted.sort_unstable();
        sorted.dedup();
        if sorted.len() != ids.len() || ids.len() < 3 {
            return None;
        }
        let ring = ids.iter().map(|&i| self.points[i]).collect();
        let border = (0..=len).map(|k| self.points[a[(start + k) % n]]).collect();
        Some(Union {
            ids,
            shape: Shape { ring, front },
            joint: n - len,
            border,
        })
    }

    /// Forgets pieces that have been joined into others.
    pub(super) fn drop_empty(&mut self) {
        let keep: Vec<bool> = self.rings.iter().map(|r| !r.is_empty()).collect();
        let mut k = keep.iter();
        self.rings.retain(|_| *k.next().unwrap_or(&true));
        let mut k = keep.iter();
        self.front.retain(|_| *k.next().unwrap_or(&true));
        let mut k = keep.iter();
        self.green.retain(|_| *k.next().unwrap_or(&true));
        self.refresh();
    }

    /// Puts every point that lies on an edge into that edge.
    pub(super) fn weld(&mut self) {
        let eps = self.eps;
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        order.sort_by(|&i, &j| {
            let (a, b) = (self.points[i], self.points[j]);
            a.x.total_cmp(&b.x)
                .then(a.y.total_cmp(&b.y))
                .then(i.cmp(&j))
        });
        let xs: Vec<f64> = order.iter().map(|&i| self.points[i].x).collect();
        for r in 0..self.rings.len() {
            let (ring, front) = (self.rings[r].clone(), self.front[r].clone());
            let n = ring.len();
            let (mut out, mut flags) = (Vec::with_capacity(n), Vec::with_capacity(n));
            for i in 0..n {
                let (ia, ib) = (ring[i], ring[(i + 1) % n]);
                let (a, b) = (self.points[ia], self.points[ib]);
                out.push(ia);
                flags.push(front[i]);
                let (x0, x1) = (a.x.min(b.x) - eps, a.x.max(b.x) + eps);
                let (y0, y1) = (a.y.min(b.y) - eps, a.y.max(b.y) + eps);
                let from = xs.partition_point(|&x| x < x0);
                let mut on: Vec<(f64, usize)> = Vec::new();
                for k in from..order.len() {
                    if xs[k] > x1 {
                        break;
                    }
                    let id = order[k];
                    let q = self.points[id];
                    if id == ia || id == ib || q.y < y0 || q.y > y1 {
                        continue;
                    }
                    let t = nearest_on(a, b, q);
                    if t > 0.0 && t < 1.0 && dist(lerp(a, b, t), q) <= eps {
                        on.push((t, id));
                    }
                }
                on.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
                for (_, id) in on {
                    if !ring.contains(&id) {
                        out.push(id);
                        flags.push(front[i]);
                    }
                }
            }
            self.rings[r] = out;
            self.front[r] = flags;
        }
    }

    pub(super) fn ring(&self, r: usize) -> Vec<P> {
        self.rings[r].iter().map(|&i| self.points[i]).collect()
    }

    pub(super) fn area(&self, r: usize) -> f64 {
        area(&self.ring(r))
    }

    pub(super) fn shape(&self, r: usize) -> Shape {
        Shape {
            ring: self.ring(r),
            front: self.front[r].clone(),
        }
    }

    /// Settles which pieces are parcels and which are green.
    pub(super) fn settle_kinds(&mut self, options: &ParcelOptions) {
        let mut scratch = Scratch::default();
        for r in 0..self.rings.len() {
            self.green[r] = is_green(
                &measure(&self.ring(r), &self.front[r], &mut scratch),
                options,
            );
        }
    }

    /// Whether the pieces are simple rings that add up to the block.
    pub(super) fn holds(&self, block: &Shape) -> bool {
        let total = block.area();
        let mut sum = 0.0;
        for r in 0..self.rings.len() {
            let ring = self.ring(r);
            let a = area(&ring);
            if a <= 0.0 || !is_simple(&ring) {
                return false;
            }
            sum += a;
        }
        // Every inner edge has its twin, every other edge is the block's.
        let mut edges: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for ring in &self.rings {
            for i in 0..ring.len() {
                if edges
                    .insert((ring[i], ring[(i + 1) % ring.len()]), 0)
                    .is_some()
                {
                    return false;
                }
            }
        }
        let size = self
            .points
            .iter()
            .fold(1.0, |m: f64, p| m.max(p.x.abs()).max(p.y.abs()));
        let open: f64 = edges
            .keys()
            .filter(|&&(a, b)| !edges.contains_key(&(b, a)))
            .map(|&(a, b)| dist(self.points[a], self.points[b]))
            .sum();
        let outline: f64 = (0..block.len())
            .map(|i| dist(block.edge(i).0, block.edge(i).1))
            .sum();
        (sum - total).abs() <= 1e-10 * total + 1e-12 * size * size
            && (open - outline).abs() <= 1e-9 * outline
    }

    /// The pieces in the caller's frame; the block's own vertices come back
    /// to the bit.
    pub(super) fn pieces(&self, own: &[Coord<f64>], origin: Coord<f64>) -> Vec<Piece> {
        self.rings
            .iter()
            .zip(&self.green)
            .map(|(ring, &green)| Piece {
                ring: ring
                    .iter()
                    .map(|&i| {
                        if i < self.own {
                            own[i]
                        } else {
                            self.points[i] + origin
                        }
                    })
                    .collect(),
                kind: if green {
                    PieceKind::Green
                } else {
                    PieceKind::Parcel
                },
            })
            .collect()
    }
}

/// Numbers points, taking those within a tolerance for the same.
struct Numbering {
    cell: f64,
    grid: BTreeMap<(i64, i64), Vec<(usize, P)>>,
    next: usize,
}

impl Numbering {
    fn new(tolerance: f64) -> Self {
        Self {
            cell: tolerance,
            grid: BTreeMap::new(),
            next: 0,
        }
    }

    fn cell_of(&self, p: P) -> (i64, i64) {
        (
            (p.x / self.cell).floor() as i64,
            (p.y / self.cell).floor() as i64,
        )
    }

    /// A new number, whatever is near.
    fn insert(&mut self, p: P) {
        let c = self.cell_of(p);
        self.grid.entry(c).or_default().push((self.next, p));
        self.next += 1;
    }

    /// The number of the point, and whether it is new.
    fn find(&mut self, p: P) -> (usize, bool) {
        let (x, y) = self.cell_of(p);
        let mut best: Option<(f64, usize)> = None;
        for i in x - 1..=x + 1 {
            for j in y - 1..=y + 1 {
                for &(id, q) in self.grid.get(&(i, j)).into_iter().flatten() {
                    let d = dist(p, q);
                    if d <= self.cell && best.is_none_or(|b| (d, id) < b) {
                        best = Some((d, id));
                    }
                }
            }
        }
        if let Some((_, id)) = best {
            return (id, false);
        }
        self.insert(p);
        (self.next - 1, true)
    }
}
