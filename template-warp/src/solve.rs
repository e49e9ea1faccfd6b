//! The basic iteration (paper, section 4.1): register every cell, then regress
//! every node, until nothing improves.
//!
//! The energy is E = sum over cells and their vertices of w |alpha(p) - p*|^2
//! with the same weights w = 1 / tolerance in registration and regression.
//! Registration lowers it because each map is the class minimiser or the last
//! map, whichever is better; regression lowers it because a node moves to the
//! weighted mean of its images, or to that mean's nearest point on its curve.
//! Anderson acceleration proposes longer steps, which are taken only if E does
//! not rise. Smooth alignments and chords are no minimisers; with them the best
//! state seen is kept, so that the reported energy still never rises.

use crate::anderson::Anderson;
use crate::geometry::{dot, p, Path, P};
use crate::registration::{Affine, Deformation};
use crate::regression::{fit_alignment, CircleFit};
use crate::template::format::AlignKind;
use crate::warp::WarpOptions;
use std::sync::Arc;

/// What holds a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// A corner of the domain: never moves.
    Corner,
    /// Slides along a side of the domain.
    Side(usize),
    /// Moves freely, unless an alignment holds it.
    Free,
}

/// A piece of a face that is registered by one map.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) nodes: Vec<usize>,
    pub(crate) reference: Vec<P>,
    pub(crate) weights: Vec<f64>,
    pub(crate) class: Arc<dyn Deformation>,
}

impl Cell {
    pub(crate) fn new(
        nodes: Vec<usize>,
        reference: Vec<P>,
        weight: f64,
        class: Arc<dyn Deformation>,
    ) -> Self {
        let weights = vec![weight; nodes.len()];
        Self {
            nodes,
            reference,
            weights,
            class,
        }
    }
}

/// Nodes that lie on one curve.
#[derive(Clone, Debug)]
pub(crate) struct Align {
    pub(crate) kind: AlignKind,
    pub(crate) nodes: Vec<usize>,
}

impl Align {
    pub(crate) fn new(kind: AlignKind, nodes: Vec<usize>) -> Self {
        Self { kind, nodes }
    }
}

/// Unknown positions and everything that acts on them.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) pos: Vec<P>,
    /// Arc length on its side, for nodes that slide.
    pub(crate) param: Vec<f64>,
    pub(crate) anchor: Vec<Anchor>,
    pub(crate) paths: Vec<Path>,
    on_side: Vec<Vec<usize>>,
    pub(crate) cells: Vec<Cell>,
    aligns: Vec<Align>,
    node_weight: Vec<f64>,
}

/// The end of an iteration.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    pub(crate) maps: Vec<Affine>,
    pub(crate) iterations: usize,
    /// E after each accepted step, the initial one first.
    #[cfg_attr(
        not(test),
        allow(dead_code, reason = "the tests read the course of the energy")
    )]
    pub(crate) energies: Vec<f64>,
}

impl Problem {
    pub(crate) fn new(
        pos: Vec<P>,
        param: Vec<f64>,
        anchor: Vec<Anchor>,
        paths: Vec<Path>,
        on_side: Vec<Vec<usize>>,
        cells: Vec<Cell>,
        aligns: Vec<Align>,
    ) -> Self {
        let mut node_weight = vec![0.0; pos.len()];
        for cell in &cells {
            for (&k, &w) in cell.nodes.iter().zip(&cell.weights) {
                node_weight[k] += w;
            }
        }
        Self {
            pos,
            param,
            anchor,
            paths,
            on_side,
            cells,
            aligns,
            node_weight,
        }
    }

    /// Runs the iteration and leaves the best positions in `pos` and `param`.
    pub(crate) fn solve(&mut self, options: &WarpOptions, scale2: f64) -> Solution {
        let mut maps = vec![Affine::IDENTITY; self.cells.len()];
        let mut scratch = Vec::new();
        // The initial positions may violate alignments; only the projected
        // ones are a state of the problem.
        let mut circles = vec![None; self.aligns.len()];
        let mut x = self.pos.clone();
        let mut param = self.param.clone();
        self.project(&mut x, &mut param, &mut circles);
        let mut energy = self.register(&x, &mut maps, true, &mut scratch);
        let total_weight: f64 = self.node_weight.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        // Below this the mean squared distance is rounding of the coordinates.
        let floor = 1e-20 * scale2 * total_weight;
        let mut energies = vec![energy];
        let mut anderson = Anderson::new(options.anderson_depth);
        let mut best = (energy, x.clone(), param.clone(), maps.clone());
        let mut iterations = 0;
        let mut quiet = 0;
        while iterations < options.iterations && energy > floor {
            iterations += 1;
            let mut plain = self.regress(&maps, &x);
            let mut plain_param = param.clone();
            self.project(&mut plain, &mut plain_param, &mut circles);
            let proposal = anderson.propose(&x, &plain);
            let mut taken = false;
            if let Some(mut y) = proposal {
                let mut y_param = param.clone();
                let mut y_circles = circles.clone();
                self.project(&mut y, &mut y_param, &mut y_circles);
                let mut y_maps = maps.clone();
                let e = self.register(&y, &mut y_maps, false, &mut scratch);
                if e <= energy {
                    (x, param, maps, circles) = (y, y_param, y_maps, y_circles);
                    taken = true;
                    quiet = if energy - e < options.tolerance * energy {
                        quiet + 1
                    } else {
                        0
                    };
                    energy = e;
                }
            }
            if !taken {
                anderson.reset_if_proposed();
                (x, param) = (plain, plain_param);
                let e = self.register(&x, &mut maps, false, &mut scratch);
                quiet = if energy - e < options.tolerance * energy {
                    quiet + 1
                } else {
                    0
                };
                energy = e;
            }
            energies.push(energy);
            if energy <= best.0 {
                best = (energy, x.clone(), param.clone(), maps.clone());
            }
            if quiet >= 2 {
                break;
            }
        }
        let (_, x, param, maps) = best;
        self.pos = x;
        self.param = param;
        Solution {
            maps,
            iterations,
            energies,
        }
    }

    /// Registers all cells to the positions `x`; a cell keeps its last map where
    /// that is better. Returns E.
    fn register(&self, x: &[P], maps: &mut [Affine], first: bool, to: &mut Vec<P>) -> f64 {
        let mut energy = 0.0;
        for (cell, map) in self.cells.iter().zip(maps.iter_mut()) {
            to.clear();
            to.extend(cell.nodes.iter().map(|&k| x[k]));
            let new = cell.class.register(&cell.reference, to, &cell.weights);
            let new_residual = new.residual(&cell.reference, to, &cell.weights);
            let residual = if first {
                f64::INFINITY
            } else {
                map.residual(&cell.reference, to, &cell.weights)
            };
            if residual < new_residual {
                energy += residual;
            } else {
                *map = new;
                energy += new_residual;
            }
        }
        energy
    }

    /// Weighted means of the images of each node; nodes of no cell stay.
    fn regress(&self, maps: &[Affine], x: &[P]) -> Vec<P> {
        let mut sum = vec![p(0.0, 0.0); x.len()];
        for (cell, map) in self.cells.iter().zip(maps) {
            for ((&k, &r), &w) in cell.nodes.iter().zip(&cell.reference).zip(&cell.weights) {
                sum[k] = sum[k] + map.apply(r) * w;
            }
        }
        (0..x.len())
            .map(|k| {
                if self.node_weight[k] > 0.0 {
                    sum[k] / self.node_weight[k]
                } else {
                    x[k]
                }
            })
            .collect()
    }

    /// Puts positions onto what holds them: corners, sides (in order), curves.
    fn project(&self, x: &mut [P], param: &mut [f64], circles: &mut [Option<CircleFit>]) {
        for ((q, &start), &anchor) in x.iter_mut().zip(&self.pos).zip(&self.anchor) {
            if anchor == Anchor::Corner {
                *q = start;
            }
        }
        for (side, nodes) in self.on_side.iter().enumerate() {
            self.slide(side, nodes, x, param);
        }
        for (align, circle) in self.aligns.iter().zip(circles) {
            fit_alignment(align, &self.anchor, &self.node_weight, x, circle);
        }
    }

    /// Nearest points on a side, kept in order: where two nodes would meet or
    /// pass, all nodes of the side go only part of the way.
    fn slide(&self, side: usize, nodes: &[usize], x: &mut [P], param: &mut [f64]) {
        if nodes.is_empty() {
            return;
        }
        let path = &self.paths[side];
        let goal: Vec<f64> = nodes
            .iter()
            .map(|&k| path.nearest_from(x[k], param[k]))
            .collect();
        let gap = 0.02 * path.length() / (nodes.len() + 1) as f64;
        let mut step = 1.0;
        loop {
            let mut last = 0.0;
            let mut ordered = true;
            for (&k, &g) in nodes.iter().zip(&goal) {
                let s = param[k] + step * (g - param[k]);
                ordered &= s - last >= gap;
                last = s;
            }
            if ordered && path.length() - last >= gap {
                break;
            }
            step *= 0.5;
            if step < 0.05 {
                step = 0.0;
                break;
            }
        }
        for (&k, &g) in nodes.iter().zip(&goal) {
            param[k] += step * (g - param[k]);
            x[k] = path.at(param[k]);
        }
    }

    /// Whether a node belongs to a cell.
    pub(crate) fn owned(&self, node: usize) -> bool {
        self.node_weight[node] > 0.0
    }

    /// Mean squared registration distance of a cell, square metres.
    pub(crate) fn mean_square(&self, cell: usize, map: &Affine) -> f64 {
        let c = &self.cells[cell];
        let sum: f64 = c
            .nodes
            .iter()
            .zip(&c.reference)
            .map(|(&k, &r)| {
                let d = map.apply(r) - self.pos[k];
                dot(d, d)
            })
            .sum();
        sum / c.nodes.len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::norm;
    use crate::instance::{Domain, DomainSide, Instance};
    use crate::library::Library;
    use crate::region::EdgeUse;
    use crate::template::model::Template;
    use proptest::prelude::*;

    /// The template's own outline, moved by a map.
    fn domain(template: &Template, map: impl Fn(P) -> P) -> Domain {
        let sides = template
            .sides
            .iter()
            .map(|s| DomainSide {
                path: Path::new(s.nodes.iter().map(|&k| map(template.points[k])).collect()),
                uses: vec![EdgeUse::Street; s.nodes.len() - 1],
            })
            .collect();
        Domain { sides }
    }

    /// Every template of the library, not only those without children, fits its
    /// own outline moved rigidly without any residual on its first level.
    #[test]
    fn own_outline_moved_rigidly_is_a_fixed_point() {
        let library = Library::standard();
        for template in library.templates() {
            let (s, c) = 2.1f64.sin_cos();
            let map = |q: P| p(c * q.x - s * q.y + 41.0, s * q.x + c * q.y - 7.0);
            let mut instance = Instance::new(template, &domain(template, map));
            let start = instance.problem.pos.clone();
            let solution = instance.problem.solve(&WarpOptions::default(), 1.0);
            let e = solution.energies.last().copied().unwrap_or(f64::INFINITY);
            assert!(e < 1e-16, "{}: {e:e}", template.name());
            for (k, q) in instance
                .problem
                .pos
                .iter()
                .enumerate()
                .take(template.points.len())
            {
                if instance.problem.owned(k) {
                    assert!(
                        norm(map(template.points[k]) - *q) < 1e-7,
                        "{} point {k}",
                        template.name()
                    );
                    assert!(
                        norm(start[k] - *q) < 1e-6,
                        "{} moved at point {k}",
                        template.name()
                    );
                }
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(if std::env::var_os("URBAN_LAYOUT_LONG").is_some() { 2000 } else { 48 }))]
        /// E never rises: rows, whose alignments are sides alone, on bent quads.
        #[test]
        fn energy_never_rises(
            x in prop::array::uniform4(-25.0..25.0f64),
            y in prop::array::uniform4(-12.0..12.0f64),
            bend in -15.0..15.0f64,
            depth in 0usize..6,
            which in 0usize..3,
        ) {
            let library = Library::standard();
            let template = library.find(["double-row", "single-row", "row"][which]).unwrap();
            let o = [p(0., 0.), p(150., 0.), p(150., 60.), p(0., 60.)];
            let c: Vec<P> = (0..4).map(|i| o[i] + p(x[i], y[i])).collect();
            let sides = (0..4)
                .map(|i| {
                    let (a, b) = (c[i], c[(i + 1) % 4]);
                    let long = i % 2 == 0;
                    let k = if long { 10 } else { 3 };
                    let path = Path::new(
                        (0..=k)
                            .map(|j| {
                                let t = f64::from(j) / f64::from(k);
                                a + (b - a) * t + p(0.0, if long { 4.0 * bend * t * (1.0 - t) } else { 0.0 })
                            })
                            .collect(),
                    );
                    DomainSide { path, uses: vec![EdgeUse::Street; k as usize] }
                })
                .collect();
            let mut instance = Instance::new(template, &Domain { sides });
            let options = WarpOptions { anderson_depth: depth, tolerance: 0.0, ..WarpOptions::default() };
            let solution = instance.problem.solve(&options, 1.0);
            prop_assert!(solution.energies.len() > 2);
            for e in solution.energies.windows(2) {
                // 1e-12: the rounding of a sum of some hundred squares.
                prop_assert!(e[1] <= e[0] * (1.0 + 1e-12), "{:?}", solution.energies);
            }
        }
    }
}
