//! What the search minimises: the divergence energy of a combination, smooth
//! in its coefficients, with its gradient in closed form.
//!
//! The mesh is lumped into samples of a few triangles each, with area A and
//! the means of F and G = F', both linear in the coefficients y. With
//! X = |F|^2, Y = |G|^2, p = 2 for H-fields and n = 2 + 2 / p = 3 (p = 1 and
//! n = 4 for gradients), the divergence of an arm is
//! `div^2 = (Y + Re(G^2 conj(F)^n) / X^{n/2}) / (2 p^2 X)`, which is 1 / r^2
//! at a singularity. It is weighed by `(X / (X + r0^2 Y))^2`: the smooth
//! weight |H|^2 / (|H|^2 + eps^2) of the design notes with eps = r0 |G|, since
//! |F| = |G| r at the distance r from a simple zero. It leaves out, softly,
//! the disc of radius r0 around each singularity wherever it moves, it knows
//! no unit, and squared it makes the energy continuously differentiable.
//!
//! The paper's directional derivative lacks a factor of 2 (supplement,
//! section 4.2); differences are the oracle of the tests.

use nalgebra::DMatrix;

use super::family::{holomorphic_slope, Family, C};
use super::misfit::Misfit;
use crate::plane::orient;

/// Most samples: beyond this, triangles are lumped.
const MOST_SAMPLES: usize = 4000;

/// The sampled energy of a family.
pub(crate) struct Objective {
    /// Area of each sample, in units of r0 squared.
    areas: Vec<f64>,
    /// Real and imaginary parts of F and of G: for each of the four, the
    /// values of the first member of the search space at all samples, then
    /// those of the second, and so on. F of size about 1, G times r0.
    parts: [Vec<f64>; 4],
    dimension: usize,
    /// n of the module's documentation.
    power: i32,
    /// 1 / (2 p^2).
    scale: f64,
    misfit: Misfit,
}

/// Values and derivatives at each sample; reused between evaluations.
#[derive(Default)]
pub(crate) struct Scratch {
    parts: [Vec<f64>; 4],
}

impl Objective {
    pub(crate) fn new(family: &Family) -> Self {
        let (clusters, count) = clusters(family, MOST_SAMPLES);
        let inner = &*family.domain.inner;
        let dimension = family.dimension();
        let mut areas = vec![0.0; count];
        // Means over the samples for the members of the family first.
        let mut means = vec![[C::new(0.0, 0.0); 2]; count * family.count];
        for (triangle, &cluster) in inner.mesh.triangles.iter().zip(&clusters) {
            if cluster == SKIPPED {
                continue;
            }
            let points = triangle.map(|v| inner.mesh.points[v as usize]);
            let area = orient(points[0], points[1], points[2]) / 2.0;
            areas[cluster as usize] += area;
            let means = &mut means[cluster as usize * family.count..][..family.count];
            for (i, mean) in means.iter_mut().enumerate() {
                let values = triangle.map(|v| family.columns[v as usize * family.count + i]);
                let sum = values[0] + values[1] + values[2];
                mean[0] += C::new(sum.x, -sum.y) * (area / 3.0);
                if let Some(slope) = holomorphic_slope(points, values) {
                    mean[1] += slope * area;
                }
            }
        }
        let mut parts = [0, 1, 2, 3].map(|_| vec![0.0; count * dimension]);
        for (s, &area) in areas.iter().enumerate().filter(|(_, &area)| area > 0.0) {
            let means = &means[s * family.count..][..family.count];
            for j in 0..dimension {
                let mut sums = [C::new(0.0, 0.0); 2];
                for (i, mean) in means.iter().enumerate() {
                    let share = family.space[(i, j)] / area;
                    sums[0] += mean[0] * share;
                    sums[1] += mean[1] * share;
                }
                let values = [sums[0].re, sums[0].im, sums[1].re, sums[1].im];
                for (part, value) in parts.iter_mut().zip(values) {
                    part[j * count + s] = value;
                }
            }
        }
        // Without units: lengths in r0, and F of size 1.
        let size = parts[0].iter().chain(&parts[1]).map(|v| v * v).sum::<f64>();
        let unit = (size / (count * dimension).max(1) as f64).sqrt();
        let unit = if unit > 0.0 { unit } else { 1.0 };
        for (k, part) in parts.iter_mut().enumerate() {
            let scale = if k < 2 { 1.0 } else { family.radius } / unit;
            part.iter_mut().for_each(|value| *value *= scale);
        }
        for area in &mut areas {
            *area /= family.radius * family.radius;
        }
        let fold = family.kind.fold();
        Self {
            areas,
            parts,
            dimension,
            power: 2 + 2 / fold,
            scale: 1.0 / f64::from(2 * fold * fold),
            misfit: Misfit::new(family, unit),
        }
    }

    pub(crate) fn dimension(&self) -> usize {
        self.dimension
    }

    /// F and G at all samples.
    fn combine(&self, y: &[f64], scratch: &mut Scratch) {
        let count = self.areas.len();
        for (sum, part) in scratch.parts.iter_mut().zip(&self.parts) {
            sum.clear();
            sum.resize(count, 0.0);
            for (&y, member) in y.iter().zip(part.chunks_exact(count.max(1))) {
                for (sum, value) in sum.iter_mut().zip(member) {
                    *sum += y * value;
                }
            }
        }
    }

    /// The energy of the arm d1 (`sign` 1) or d2 (`sign` -1) of the field with
    /// coefficients `y`, the charge for leaving the boundary included, and its
    /// gradient.
    ///
    /// d1 is the arm at u = -arg F / p. For H-fields the sign of `y` exchanges
    /// the arms as well.
    pub(crate) fn evaluate(
        &self,
        y: &[f64],
        sign: f64,
        gradient: &mut [f64],
        scratch: &mut Scratch,
    ) -> f64 {
        self.combine(y, scratch);
        let count = self.areas.len();
        let n = self.power;
        let half = f64::from(n - 2) / 2.0;
        let mut energy = 0.0;
        let [f_re, f_im, g_re, g_im] = &mut scratch.parts;
        for s in 0..count {
            let (f, g) = (C::new(f_re[s], f_im[s]), C::new(g_re[s], g_im[s]));
            let (x, y) = (f.norm_sqr(), g.norm_sqr());
            let m = x + y;
            if x <= f64::MIN_POSITIVE || !(m * m).is_normal() {
                (f_re[s], f_im[s], g_re[s], g_im[s]) = (0.0, 0.0, 0.0, 0.0);
                continue;
            }
            let back = f.conj();
            // conj(F)^(n-1), and |F|^(n-2).
            let (power, size) = if n == 3 {
                (back * back, x.sqrt())
            } else {
                (back * back * back, x)
            };
            let apart = sign * (g * g * power * back).re / size;
            let factor = self.scale * self.areas[s] / (m * m);
            let value = factor * (x * y + apart);
            energy += value;
            // Partial derivatives by X, Y and Re(G^2 conj(F)^n).
            let by_x = factor * (y - half * apart / x) - 2.0 * value / m;
            let by_y = factor * x - 2.0 * value / m;
            let by_r = sign * factor / size;
            // dE = Re(conj(by_f) dF) + Re(conj(by_g) dG).
            let by_f = f * (2.0 * by_x) + g * g * power * (f64::from(n) * by_r);
            let by_g = g * (2.0 * by_y) + (g * power * back).conj() * (2.0 * by_r);
            (f_re[s], f_im[s]) = (by_f.re, by_f.im);
            (g_re[s], g_im[s]) = (by_g.re, by_g.im);
        }
        for (j, slope) in gradient.iter_mut().enumerate() {
            *slope = (0..4)
                .map(|k| dot(&scratch.parts[k], &self.parts[k][j * count..][..count]))
                .sum();
        }
        energy + self.misfit.add(y, gradient)
    }

    /// Quadratic forms in y whose quotient is the energy for |F| of even
    /// size: the integral of |F|^2, and what the two arms and the misfit add
    /// up to times that.
    pub(crate) fn forms(&self) -> [DMatrix<f64>; 2] {
        let count = self.areas.len();
        let mut weighted = vec![0.0; count];
        let [mass, mut stiffness] = [[0, 1], [2, 3]].map(|parts| {
            let mut form = DMatrix::zeros(self.dimension, self.dimension);
            for k in parts {
                for i in 0..self.dimension {
                    let member = &self.parts[k][i * count..][..count];
                    for ((w, v), a) in weighted.iter_mut().zip(member).zip(&self.areas) {
                        *w = v * a;
                    }
                    for j in 0..=i {
                        form[(i, j)] += dot(&weighted, &self.parts[k][j * count..][..count]);
                    }
                }
            }
            form.fill_upper_triangle_with_lower_triangle();
            form
        });
        stiffness *= self.scale;
        let total: f64 = self.areas.iter().sum();
        stiffness += self.misfit.form(self.dimension);
        // The mean of |F|^2 is its integral over the area.
        [mass / total.max(f64::MIN_POSITIVE), stiffness]
    }

    /// Mean angle between the crosses of two combinations, by area, radians:
    /// pi/8 for fields that have nothing to do with each other.
    pub(crate) fn distance(&self, one: &Angles, other: &Angles) -> f64 {
        let mut sum = 0.0;
        let total: f64 = self.areas.iter().sum();
        for ((a, b), area) in one.0.iter().zip(&other.0).zip(&self.areas) {
            let turns = (a - b) / std::f64::consts::FRAC_PI_2;
            sum += area * (turns - turns.round()).abs();
        }
        if total > 0.0 {
            sum / total * std::f64::consts::FRAC_PI_2
        } else {
            0.0
        }
    }

    /// The angles u of a combination at all samples, to compare it with others.
    pub(crate) fn angles(&self, y: &[f64], scratch: &mut Scratch) -> Angles {
        self.combine(y, scratch);
        let fold = f64::from(2 / (self.power - 2));
        let [re, im, ..] = &scratch.parts;
        Angles(
            re.iter()
                .zip(im)
                .map(|(re, im)| -im.atan2(*re) / fold)
                .collect(),
        )
    }
}

/// Angles of crosses at the samples of an [`Objective`].
pub(crate) struct Angles(Vec<f64>);

/// A scalar product in four strands, which the processor runs side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut strands = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4
        .remainder()
        .iter()
        .zip(b4.remainder())
        .map(|(x, y)| x * y)
        .sum();
    for (x, y) in a4.zip(b4) {
        for k in 0..4 {
            strands[k] += x[k] * y[k];
        }
    }
    strands.iter().sum::<f64>() + rest
}

/// Marks triangles that no sample contains.
const SKIPPED: u32 = u32::MAX;

/// The sample of each triangle: connected groups of about even area, at most
/// about `most` of them, and their number. Triangles in the discs around boundary centres belong
/// to none.
///
/// Groups grow from the lowest free triangle across edges, so that they move
/// with the mesh.
fn clusters(family: &Family, most: usize) -> (Vec<u32>, usize) {
    const FREE: u32 = u32::MAX - 1;
    let mesh = &family.domain.inner.mesh;
    let skipped = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| mesh.points[v as usize]);
        family.discs.contain((a + b + c) / 3.0)
    };
    let mut cluster: Vec<u32> = mesh
        .triangles
        .iter()
        .map(|triangle| if skipped(triangle) { SKIPPED } else { FREE })
        .collect();
    // On a coarse mesh, or in a tiny domain, the discs may take everything.
    if cluster.iter().all(|&c| c == SKIPPED) {
        cluster.fill(FREE);
    }
    let area = |t: usize| {
        let [a, b, c] = mesh.triangles[t].map(|v| mesh.points[v as usize]);
        orient(a, b, c) / 2.0
    };
    // One triangle a sample while there are few of them.
    let enough = if mesh.triangles.len() <= most {
        0.0
    } else {
        family.domain.area() / most as f64
    };
    let mut count = 0;
    let mut queue = std::collections::VecDeque::new();
    for seed in 0..cluster.len() {
        if cluster[seed] != FREE {
            continue;
        }
        let mut sum = 0.0;
        queue.clear();
        queue.push_back(seed);
        cluster[seed] = count;
        let mut waiting = Vec::new();
        while let Some(t) = queue.pop_front() {
            sum += area(t);
            if sum >= enough {
                waiting.extend(queue.drain(..));
                break;
            }
            for &next in &mesh.neighbours[t] {
                if next & crate::domain::BORDER == 0 && cluster[next as usize] == FREE {
                    cluster[next as usize] = count;
                    queue.push_back(next as usize);
                }
            }
        }
        for t in waiting {
            cluster[t] = FREE;
        }
        count += 1;
    }
    (cluster, count as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harmonic::discs::Discs;
    use crate::harmonic::family::Kind;
    use crate::plane::V2;
    use crate::{Domain, DomainOptions};
    use geo_types::polygon;

    /// Three holomorphic functions w^2, w, 1 plus an imaginary one.
    fn family(kind: Kind) -> Family {
        let shape = polygon![(x: -4., y: -3.), (x: 5., y: -4.), (x: 4., y: 4.), (x: -4., y: 5.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let members = |p: &V2| {
            let w = C::new(p.x, p.y);
            let all = [
                w * w * 0.1,
                w,
                C::new(1.0, 0.0),
                C::new(0.0, 1.0) * w.exp() * 0.05,
            ];
            all.map(|f| V2::new(f.re, -f.im))
        };
        let columns = domain.inner.mesh.points.iter().flat_map(members).collect();
        Family {
            kind,
            count: 4,
            columns,
            space: DMatrix::identity(4, 4),
            radius: 0.4,
            discs: Discs::new(vec![(V2::new(4.0, 4.0), 0.4)]),
            charged: (5..50).collect(),
            charge: 3.0,
            domain,
        }
    }

    /// The paper's gradient: differences, here central ones.
    fn differences(objective: &Objective, y: &[f64], sign: f64) -> Vec<f64> {
        let mut scratch = Scratch::default();
        let mut ignored = vec![0.0; y.len()];
        let step = 1e-5;
        (0..y.len())
            .map(|j| {
                let mut at = |offset: f64| {
                    let mut moved = y.to_vec();
                    moved[j] += offset;
                    objective.evaluate(&moved, sign, &mut ignored, &mut scratch)
                };
                (at(step) - at(-step)) / (2.0 * step)
            })
            .collect()
    }

    #[test]
    fn the_gradient_is_that_of_differences() {
        for kind in [Kind::Hessian, Kind::Gradient] {
            let objective = Objective::new(&family(kind));
            for y in [
                [0.3, 0.2, -0.7, 0.5],
                [-0.1, 1.0, 0.1, 0.4],
                [0.9, 0.1, 0.1, -0.6],
            ] {
                for sign in [1.0, -1.0] {
                    let mut gradient = [0.0; 4];
                    objective.evaluate(&y, sign, &mut gradient, &mut Scratch::default());
                    let wanted = differences(&objective, &y, sign);
                    // Where a zero of F lies near a sample the second
                    // derivative is large: that is what the differences lose.
                    let size = gradient.iter().fold(0.0_f64, |m, g| m.max(g.abs()));
                    for (a, b) in gradient.iter().zip(wanted) {
                        assert!((a - b).abs() < 1e-4 * size, "{a} {b} {size}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_sign_of_a_hessian_exchanges_its_arms() {
        let objective = Objective::new(&family(Kind::Hessian));
        let mut scratch = Scratch::default();
        let (y, minus) = ([0.3, 0.2, -0.7, 0.5], [-0.3, -0.2, 0.7, -0.5]);
        let (mut a, mut b) = ([0.0; 4], [0.0; 4]);
        let one = objective.evaluate(&y, -1.0, &mut a, &mut scratch);
        let other = objective.evaluate(&minus, 1.0, &mut b, &mut scratch);
        assert!((one - other).abs() < 1e-12 * one);
        let angles = [y, minus].map(|y| objective.angles(&y, &mut scratch));
        assert!(objective.distance(&angles[0], &angles[1]) < 1e-12);
    }

    /// F = w + c has one zero; div^2 of both arms together is 1 / (4 r^2) for
    /// a Hessian. With the weight (r^2 / (r^2 + r0^2))^2, F = w, the integral
    /// over a disc of radius R is pi/4 (ln(1 + t) + 1 / (1 + t) - 1), with
    /// t = (R / r0)^2.
    #[test]
    fn the_energy_of_a_simple_zero_is_known() {
        let ring: Vec<(f64, f64)> = (0..200)
            .map(|k| (f64::from(k) * std::f64::consts::TAU / 200.0).sin_cos())
            .map(|(y, x)| (10.0 * x, 10.0 * y))
            .collect();
        let shape = geo_types::Polygon::new(ring.into(), vec![]);
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let columns = domain
            .inner
            .mesh
            .points
            .iter()
            .map(|p| V2::new(p.x, -p.y))
            .collect();
        let family = Family {
            kind: Kind::Hessian,
            count: 1,
            columns,
            space: DMatrix::identity(1, 1),
            radius: 2.0,
            discs: Discs::default(),
            charged: vec![],
            charge: 0.0,
            domain,
        };
        let objective = Objective::new(&family);
        let mut gradient = [0.0];
        let mut scratch = Scratch::default();
        let sum: f64 = [1.0, -1.0]
            .map(|sign| objective.evaluate(&[0.7], sign, &mut gradient, &mut scratch))
            .iter()
            .sum();
        let t = 25.0_f64;
        let wanted = std::f64::consts::FRAC_PI_4 * ((1.0 + t).ln() + 1.0 / (1.0 + t) - 1.0);
        // Triangles of 0.44 metres against a disc of 2: (h / r0)^2 / 4.
        assert!((sum / wanted - 1.0).abs() < 0.015, "{sum} {wanted}");
    }
}
