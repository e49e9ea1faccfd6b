//! The loop: fit targets, solve, guard, keep the best.

use super::guard::{between, BlockRing, Guard};
use super::options::{Block, Energy, Fairness, Freedom, OptimizeOptions, Report, Step};
use super::rails::{rail, room, Rail};
use super::target::TargetShape;
use crate::error::{MeshFault, OptimizeError};
use crate::mesh::predicates::{dist, dot, finite, sub, P};
use crate::mesh::{PlanarMesh, VertexId};
use crate::quadratic::{Bounds, System, Term, Var};

/// Optimises the vertices of a street network: blocks become more like their
/// target shapes, roads smoother, nothing strays far, no face turns inside
/// out.
///
/// `blocks` are the faces that have a target; `roads` the chains of vertices
/// whose fairness counts (see [`roads`](crate::roads); a closed one repeats
/// its first vertex); `freedom` says how each vertex may move. `progress` is
/// called with the fraction done and stops the run by returning `false`.
///
/// Topology does not change, and the energy of the result is never more than
/// that of the start: the best round is kept. Every face that was sound
/// stays sound.
///
/// # Errors
///
/// Options, blocks, roads or targets that make no sense, a face around a
/// moving vertex that is not sound to start with, a singular system,
/// cancellation. The mesh is then unchanged.
///
/// # Complexity
///
/// One sparse factorisation, one more whenever a sliding junction starts or
/// stops being held at the end of its room; per round O(n log n) for the
/// guard. A network of 3000 vertices takes well under 0.1 s.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, line_string};
/// use network_opt::{optimize, roads, Block, Freedom, OptimizeOptions, PlanarMesh, StripFit, Wire};
///
/// // Two blocks with a crooked street between them.
/// let wire = |line, rim| Wire { line, left: rim, right: rim, priority: 0 };
/// let mut mesh = PlanarMesh::from_linework(&[
///     wire(line_string![(x: 0., y: 0.), (x: 90., y: 0.), (x: 90., y: 99.), (x: 0., y: 99.), (x: 0., y: 0.)], true),
///     wire(line_string![(x: 0., y: 49.), (x: 30., y: 58.), (x: 60., y: 43.), (x: 90., y: 50.)], false),
/// ], 0.01)?;
/// let find = |x, y| mesh.vertices().find(|&v| mesh.point(v) == coord! { x: x, y: y }).unwrap();
/// let (west, east) = (find(0., 49.), find(90., 50.));
/// let blocks = [
///     Block { face: mesh.face_at(coord! { x: 1., y: 1. }), corners: Some([find(0., 0.), find(90., 0.), east, west]) },
///     Block { face: mesh.face_at(coord! { x: 1., y: 98. }), corners: Some([west, east, find(90., 99.), find(0., 99.)]) },
/// ];
/// let streets = roads(&mesh, |&rim| !rim, 45.0);
/// let rim: Vec<_> = mesh.walk(mesh.loops(mesh.outside())[0]).map(|h| mesh.origin(h)).collect();
/// let freedom = |v| match (rim.contains(&v), v == west || v == east) {
///     (false, _) => Freedom::Free,
///     (true, true) => Freedom::Slide,
///     (true, false) => Freedom::Fixed,
/// };
/// let options = OptimizeOptions::default();
/// let report = optimize(&mut mesh, &blocks, &streets, &freedom, &StripFit::new(), &options, &mut |_| true)?;
/// assert!(report.after.total() < 0.7 * report.before.total());
/// assert_eq!(mesh.point(west).x, 0.0); // it slid along the rim
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
///
/// Yang, Wang, Vouga, Wonka: Urban Pattern: Layout Design by Hierarchical
/// Domain Splitting, 2013, section 6. Differs from the paper in the fairness
/// (see [`Fairness`]), in keeping the best round, and in the guard.
pub fn optimize<E: Clone>(
    mesh: &mut PlanarMesh<E>,
    blocks: &[Block],
    roads: &[Vec<VertexId>],
    freedom: &dyn Fn(VertexId) -> Freedom,
    target: &dyn TargetShape,
    options: &OptimizeOptions,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Report, OptimizeError> {
    options.check()?;
    let mut run = Run::new(mesh, blocks, roads, freedom, target, options)?;
    let best = run.iterate(options, progress)?;
    for (i, (&new, &old)) in best.iter().zip(&run.begin).enumerate() {
        if new != old {
            mesh.set_point(VertexId(i as u32), new);
            run.report.moved = run.report.moved.max(dist(new, old));
        }
    }
    Ok(run.report)
}

/// All that stays the same from round to round.
struct Run<'a> {
    target: &'a dyn TargetShape,
    blocks: Vec<BlockRing>,
    begin: Vec<P>,
    vars: Vec<Var>,
    rails: Vec<Option<Rail>>,
    guard: Guard,
    fair: Vec<Term>,
    close: Vec<Term>,
    shape_weight: f64,
    report: Report,
}

/// Terms of the shape energy with their aims, in the order of vertices.
type Aims = Vec<(Term, P)>;

impl<'a> Run<'a> {
    fn new<E: Clone>(
        mesh: &PlanarMesh<E>,
        blocks: &[Block],
        roads: &[Vec<VertexId>],
        freedom: &dyn Fn(VertexId) -> Freedom,
        target: &'a dyn TargetShape,
        options: &OptimizeOptions,
    ) -> Result<Self, OptimizeError> {
        let blocks = block_rings(mesh, blocks)?;
        for (road, chain) in roads.iter().enumerate() {
            if let Some(&vertex) = chain.iter().find(|&&v| !mesh.has_vertex(v)) {
                return Err(OptimizeError::BadRoad { road, vertex });
            }
        }
        let count = mesh.vertex_bound();
        let begin: Vec<P> = (0..count as u32).map(|i| mesh.point(VertexId(i))).collect();
        let mut wish = vec![Freedom::Fixed; count];
        for v in mesh.vertices() {
            wish[v.0 as usize] = freedom(v);
        }
        let mut report = Report::default();
        let mut vars = vec![Var::Fixed; count];
        let mut rails = vec![None; count];
        for v in mesh.vertices() {
            let i = v.0 as usize;
            match wish[i] {
                Freedom::Fixed => {}
                Freedom::Free => {
                    vars[i] = Var::Free(report.unknowns);
                    report.unknowns += 2;
                }
                Freedom::Slide => match rail(mesh, v, &wish) {
                    Some(found) => {
                        vars[i] = Var::Slide(report.unknowns, found.along);
                        rails[i] = Some(found);
                        report.unknowns += 1;
                    }
                    None => report.fixed_at_bends += 1,
                },
            }
        }
        let moving: Vec<bool> = vars.iter().map(|v| *v != Var::Fixed).collect();
        let guard = Guard::new(
            mesh,
            &moving,
            &blocks,
            target,
            &begin,
            options.min_angle_deg.to_radians(),
        );
        if let Some((face, what, p)) = guard.first_fault(&begin) {
            let (x, y) = (p.x, p.y);
            return Err(MeshFault::Face { face, what, x, y }.into());
        }
        let close = (0..count)
            .filter(|&i| moving[i] && options.closeness > 0.0)
            .map(|i| Term::one(options.closeness, i))
            .collect();
        Ok(Self {
            target,
            fair: fairness_terms(roads, &begin, &vars, &rails, options),
            blocks,
            begin,
            vars,
            rails,
            guard,
            close,
            shape_weight: options.shape,
            report,
        })
    }

    /// Fits all targets to the given positions.
    fn fit(&self, points: &[P]) -> Result<Aims, OptimizeError> {
        let mut sum = vec![P { x: 0.0, y: 0.0 }; points.len()];
        let mut count = vec![0_u32; points.len()];
        if self.shape_weight > 0.0 {
            for (i, block) in self.blocks.iter().enumerate() {
                let ring = block.points(points);
                let Some(aims) = self.target.targets(&ring, block.corners) else {
                    continue;
                };
                if aims.len() != ring.len() || !aims.iter().all(|&p| finite(p)) {
                    return Err(OptimizeError::BadTarget {
                        block: i,
                        given: aims.len(),
                        expected: ring.len(),
                    });
                }
                // Averages of differences keep the digits of large coordinates.
                for (v, aim) in block.ring.iter().zip(aims) {
                    let i = v.0 as usize;
                    let d = sub(aim, points[i]);
                    sum[i].x += d.x;
                    sum[i].y += d.y;
                    count[i] += 1;
                }
            }
        }
        Ok((0..points.len())
            .filter(|&i| count[i] > 0 && self.vars[i] != Var::Fixed)
            .map(|i| {
                let n = f64::from(count[i]);
                let aim = P {
                    x: points[i].x + sum[i].x / n,
                    y: points[i].y + sum[i].y / n,
                };
                (Term::one(self.shape_weight, i), aim)
            })
            .collect())
    }

    fn energy(&self, points: &[P], aims: &Aims) -> Energy {
        let zero = P { x: 0.0, y: 0.0 };
        Energy {
            shape: aims.iter().map(|(t, aim)| t.value(points, *aim)).sum(),
            fairness: self.fair.iter().map(|t| t.value(points, zero)).sum(),
            closeness: self
                .close
                .iter()
                .map(|t| t.value(points, self.begin[t.parts[0].0]))
                .sum(),
        }
    }

    /// All terms with what they aim at.
    fn terms(&self, aims: &Aims) -> Vec<(Term, P)> {
        let zero = P { x: 0.0, y: 0.0 };
        let fair = self.fair.iter().map(|&t| (t, zero));
        let close = self.close.iter().map(|&t| (t, self.begin[t.parts[0].0]));
        aims.iter().copied().chain(fair).chain(close).collect()
    }

    /// Runs the rounds; the positions with the least energy.
    fn iterate(
        &mut self,
        options: &OptimizeOptions,
        progress: &mut dyn FnMut(f64) -> bool,
    ) -> Result<Vec<P>, OptimizeError> {
        let mut points = self.begin.clone();
        let mut best = points.clone();
        let mut aims = self.fit(&points)?;
        self.report.before = self.energy(&points, &aims);
        self.report.after = self.report.before;
        let mut system: Option<(System, Vec<usize>)> = None;
        let rounds = if self.report.unknowns == 0 {
            0
        } else {
            options.iterations
        };
        let singular = OptimizeError::Singular {
            unknowns: self.report.unknowns,
        };
        for round in 0..rounds {
            if !progress(round as f64 / rounds as f64) {
                return Err(OptimizeError::Cancelled);
            }
            // The matrix depends on which vertices have targets, not where.
            let drawn: Vec<usize> = aims.iter().map(|(t, _)| t.parts[0].0).collect();
            let terms = self.terms(&aims);
            let ready = system.take().filter(|(_, old)| *old == drawn);
            let (mut solver, drawn) = match ready {
                Some(ready) => ready,
                None => {
                    let plain: Vec<Term> = terms.iter().map(|t| t.0).collect();
                    let fresh = System::new(self.report.unknowns, &self.vars, &plain);
                    (fresh.ok_or_else(|| singular.clone())?, drawn)
                }
            };
            let counted = solver.factorizations;
            let rhs = solver.rhs(&self.vars, &self.begin, &terms);
            let (mut q, bounds) = self.unknowns(&points, options);
            let clamped = solver
                .minimise(&mut q, &rhs, &bounds)
                .ok_or_else(|| singular.clone())?;
            self.report.factorizations += solver.factorizations - counted;
            system = Some((solver, drawn));

            let before = self.energy(&points, &aims).total();
            let (next, damped) = self.step(&points, &q, &aims, before);
            let after = self.energy(&next, &aims).total();
            let still = next == points;
            points = next;
            aims = self.fit(&points)?;
            let energy = self.energy(&points, &aims);
            self.report.steps.push(Step {
                before,
                after,
                refitted: energy.total(),
                clamped,
                damped,
            });
            if energy.total() < self.report.after.total() {
                self.report.after = energy;
                self.report.best = round + 1;
                best.clone_from(&points);
            }
            if still {
                break;
            }
        }
        if !progress(1.0) {
            return Err(OptimizeError::Cancelled);
        }
        Ok(best)
    }

    /// The unknowns of given positions, and the bounds of the sliding ones.
    fn unknowns(&self, points: &[P], options: &OptimizeOptions) -> (Vec<f64>, Bounds) {
        let n = self.report.unknowns;
        let mut q = vec![0.0; n];
        let mut bounds = Bounds {
            low: vec![f64::NEG_INFINITY; n],
            high: vec![f64::INFINITY; n],
        };
        let place = |v: VertexId| points[v.0 as usize];
        let slides = |v: VertexId| self.rails[v.0 as usize].is_some();
        for (i, var) in self.vars.iter().enumerate() {
            let d = sub(points[i], self.begin[i]);
            match *var {
                Var::Fixed => {}
                Var::Free(k) => (q[k], q[k + 1]) = (d.x, d.y),
                Var::Slide(k, along) => {
                    q[k] = dot(d, along);
                    if let Some(rail) = &self.rails[i] {
                        let (margin, clearance) = (options.margin, options.clearance);
                        let room = room(rail, points[i], &place, &slides, margin, clearance);
                        bounds.low[k] = q[k] + room.0;
                        bounds.high[k] = q[k] + room.1;
                    }
                }
            }
        }
        (q, bounds)
    }

    /// The positions of `q`, or as far towards them as faces stay sound and
    /// the energy does not rise.
    fn step(&self, points: &[P], q: &[f64], aims: &Aims, before: f64) -> (Vec<P>, usize) {
        let full: Vec<P> = self
            .vars
            .iter()
            .zip(&self.begin)
            .map(|(var, p)| {
                let d = var.displacement(q);
                P {
                    x: p.x + d.x,
                    y: p.y + d.y,
                }
            })
            .collect();
        let mut next = full.clone();
        let damped = self
            .guard
            .damp(points, &mut next, &self.blocks, self.target);
        if self.energy(&next, aims).total() <= before {
            return (next, damped);
        }
        // Holding back single vertices has cost more than it gained. On the
        // straight line to the minimum the energy cannot rise.
        let mut share = 1.0;
        for _ in 0..10 {
            share /= 2.0;
            for (p, (&a, &b)) in next.iter_mut().zip(points.iter().zip(&full)) {
                *p = between(a, b, share);
            }
            if self.guard.all_accept(&next, &self.blocks, self.target)
                && self.energy(&next, aims).total() <= before
            {
                return (next, damped);
            }
        }
        (points.to_vec(), damped)
    }
}

/// Looks up the blocks' rings and corners.
fn block_rings<E: Clone>(
    mesh: &PlanarMesh<E>,
    blocks: &[Block],
) -> Result<Vec<BlockRing>, OptimizeError> {
    blocks
        .iter()
        .enumerate()
        .map(|(block, b)| {
            let face = b.face;
            let outer = mesh.loops(face).first().copied();
            let (Some(outer), false) = (outer, mesh.is_outside(face)) else {
                return Err(OptimizeError::BadFace { block, face });
            };
            let ring: Vec<VertexId> = mesh.walk(outer).map(|h| mesh.origin(h)).collect();
            let corners = match b.corners {
                None => None,
                Some(ids) => Some(
                    corner_positions(&ring, ids)
                        .ok_or(OptimizeError::BadCorners { block, face })?,
                ),
            };
            Ok(BlockRing {
                face,
                ring,
                corners,
            })
        })
        .collect()
}

/// Where four corners are in a ring, if they are there once around.
fn corner_positions(ring: &[VertexId], ids: [VertexId; 4]) -> Option<[usize; 4]> {
    let n = ring.len();
    let mut at = [0; 4];
    for (p, id) in at.iter_mut().zip(ids) {
        *p = ring.iter().position(|&v| v == id)?;
    }
    let gaps: Vec<usize> = (0..4).map(|k| (at[(k + 1) % 4] + n - at[k]) % n).collect();
    (gaps.iter().all(|&g| g > 0) && gaps.iter().sum::<usize>() == n).then_some(at)
}

/// The second differences along roads that can change.
fn fairness_terms(
    roads: &[Vec<VertexId>],
    begin: &[P],
    vars: &[Var],
    rails: &[Option<Rail>],
    options: &OptimizeOptions,
) -> Vec<Term> {
    let mut terms = Vec::new();
    if options.fairness == 0.0 {
        return terms;
    }
    for road in roads {
        let n = road.len();
        let closed = n > 3 && road[0] == road[n - 1];
        let around = closed.then(|| [road[n - 2], road[0], road[1]]);
        let along = road.windows(3).map(|w| [w[0], w[1], w[2]]);
        for [a, b, c] in along.chain(around) {
            let [i, j, k] = [a, b, c].map(|v| v.0 as usize);
            if i == k || [i, j, k].iter().all(|&x| vars[x] == Var::Fixed) {
                continue;
            }
            // Sliding along a straight boundary does not make it less fair.
            if rails[j].is_some_and(|r| r.ends == [a, c] || r.ends == [c, a]) {
                continue;
            }
            let (ci, ck) = match options.fairness_form {
                Fairness::Plain => (1.0, 1.0),
                Fairness::SpacingWeighted => {
                    let (h1, h2) = (dist(begin[i], begin[j]), dist(begin[j], begin[k]));
                    if h1 + h2 == 0.0 {
                        continue;
                    }
                    (2.0 * h2 / (h1 + h2), 2.0 * h1 / (h1 + h2))
                }
            };
            terms.push(Term {
                weight: options.fairness,
                parts: [(j, -2.0), (i, ci), (k, ck)],
            });
        }
    }
    terms
}
