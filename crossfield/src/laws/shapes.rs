//! Domains for tests, each made from a seed: the same number gives the same
//! shape for as long as the crate has this major version.

use std::f64::consts::TAU;

use geo_types::{Coord, LineString, Polygon};

use crate::domain::DomainOptions;

/// Numbers from a seed (SplitMix64 of Steele, Lea and Flood 2014).
#[derive(Clone, Debug)]
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Below `count`.
    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// Between `low` and `high`.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// One of `values`.
    fn pick<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.below(values.len())]
    }
}

/// `count` points on a circle around the origin, counter-clockwise.
#[must_use]
pub fn circle(count: usize, radius: f64) -> Vec<(f64, f64)> {
    (0..count)
        .map(|k| {
            let (s, c) = (TAU * k as f64 / count as f64).sin_cos();
            (radius * c, radius * s)
        })
        .collect()
}

fn star(numbers: &mut Numbers, count: usize, low: f64, size: f64) -> Vec<(f64, f64)> {
    circle(count, 1.0)
        .into_iter()
        .map(|(x, y)| {
            let r = size * numbers.between(low, 1.0);
            (r * x, r * y)
        })
        .collect()
}

/// A valid polygon some 400 m across, star-shaped, with 5 to 40 vertices and
/// perhaps a hole: spiked, wavy or nearly round.
#[must_use]
pub fn polygon(seed: u64) -> Polygon<f64> {
    let mut numbers = Numbers(seed);
    let low = numbers.pick(&[0.4, 0.7, 0.97]);
    let count = 5 + numbers.below(36);
    let outer = star(&mut numbers, count, low, 200.0);
    let holes = if numbers.below(2) == 0 {
        let count = 3 + numbers.below(6);
        vec![star(&mut numbers, count, 0.5, 40.0).into()]
    } else {
        vec![]
    };
    Polygon::new(outer.into(), holes)
}

/// A valid polygon with right angles only, sides along the axes: columns of
/// random heights on one base line.
#[must_use]
pub fn right_angled(seed: u64) -> Polygon<f64> {
    let mut numbers = Numbers(seed);
    let columns: Vec<(f64, f64)> = (0..1 + numbers.below(6))
        .map(|_| (numbers.between(30.0, 90.0), numbers.between(30.0, 120.0)))
        .collect();
    let total: f64 = columns.iter().map(|c| c.0).sum();
    let mut points = vec![(0.0, 0.0), (total, 0.0)];
    let mut x = total;
    for &(width, height) in columns.iter().rev() {
        points.push((x, height));
        x -= width;
        points.push((x, height));
    }
    Polygon::new(points.into(), vec![])
}

/// What a program that knows no better might ask for: mostly not a valid
/// domain, and made to hurt.
#[derive(Clone, Debug)]
pub struct Hostile {
    /// Rings that cross, touch, repeat, vanish or overflow.
    pub polygon: Polygon<f64>,
    /// Constraint lines of the same kind.
    pub lines: Vec<LineString<f64>>,
    /// Options, some of them out of range; never more than some thousand
    /// vertices, so that thousands of domains can be tried.
    pub options: DomainOptions,
}

/// A hostile input. Anything may come of it but a panic, a hang or a wrong
/// mesh.
#[must_use]
pub fn hostile(seed: u64) -> Hostile {
    let mut numbers = Numbers(seed);
    let size =
        10.0_f64.powf(numbers.pick(&[-140.0, -9.0, -3.0, 0.0, 2.0, 3.0, 3.0, 3.0, 9.0, 140.0]));
    let offset = size * numbers.pick(&[0.0, 0.0, 0.0, 1.0, 1e3, 1e7, 1e12]);
    let mut rings = vec![ring(&mut numbers)];
    for _ in 0..numbers.pick(&[0, 0, 1, 1, 2, 5]) {
        rings.push(match numbers.below(4) {
            // The same ring again, a vertex of another, or a shrunk copy.
            0 => rings[0].clone(),
            1 => rings[0].iter().map(|&(x, y)| (0.3 * x, 0.3 * y)).collect(),
            _ => {
                let shift = (numbers.between(-0.6, 0.6), numbers.between(-0.6, 0.6));
                let part = numbers.pick(&[1e-9, 1e-3, 0.1, 0.3, 0.3]);
                let small = ring(&mut numbers);
                small
                    .into_iter()
                    .map(|(x, y)| (shift.0 + part * x, shift.1 + part * y))
                    .collect()
            }
        });
    }
    let place = |(x, y): (f64, f64)| Coord {
        x: x * size + offset,
        y: y * size - offset,
    };
    let mut lines: Vec<LineString<f64>> = rings
        .iter()
        .map(|ring| ring.iter().map(|&p| place(p)).collect())
        .collect();
    if numbers.below(12) == 0 {
        let bad = numbers.pick(&[f64::NAN, f64::INFINITY, -1e200, 1e-310, f64::MAX]);
        let ring = numbers.below(lines.len());
        let vertex = numbers.below(lines[ring].0.len().max(1));
        if let Some(c) = lines[ring].0.get_mut(vertex) {
            c.y = bad;
        }
    }
    let exterior = lines.remove(0);
    let drawn = (0..numbers.pick(&[0, 0, 0, 1, 3]))
        .map(|_| {
            let line = ring(&mut numbers);
            line.into_iter().map(place).collect()
        })
        .collect();
    Hostile {
        options: options(&mut numbers, size),
        polygon: Polygon::new(exterior, lines),
        lines: drawn,
    }
}

/// A ring of about unit size, of one of the kinds that break things.
fn ring(numbers: &mut Numbers) -> Vec<(f64, f64)> {
    let mut points = match numbers.below(9) {
        // Random points: it crosses itself.
        0 => {
            let count = numbers.below(12);
            (0..count)
                .map(|_| (numbers.between(-1.0, 1.0), numbers.between(-1.0, 1.0)))
                .collect()
        }
        // On a coarse grid: vertices repeat, edges overlap.
        1 => {
            let count = 3 + numbers.below(9);
            let mut whole = || numbers.below(5) as f64 / 4.0;
            (0..count).map(|_| (whole(), whole())).collect()
        }
        // A needle.
        2 => {
            let width = 10.0_f64.powf(numbers.between(-14.0, 0.0));
            let bend = numbers.pick(&[0.0, 1e-9, 0.3]);
            vec![
                (-1.0, 0.0),
                (0.0, bend),
                (1.0, 0.0),
                (1.0, width),
                (0.0, bend + width),
                (-1.0, width),
            ]
        }
        // Spikes in and out, over many orders of magnitude.
        3 => {
            let count = 3 + numbers.below(20);
            let deep = numbers.pick(&[-12.0, -6.0, -2.0]);
            let round = circle(count, 1.0);
            round
                .into_iter()
                .map(|(x, y)| {
                    let r = 10.0_f64.powf(numbers.between(deep, 0.0));
                    (r * x, r * y)
                })
                .collect()
        }
        // A noisy outline with hundreds of vertices.
        4 => {
            let count = 50 + numbers.below(600);
            let low = numbers.pick(&[0.5, 0.99, 1.0 - 1e-9]);
            star(numbers, count, low, 1.0)
        }
        // A comb: gaps and teeth that are as thin as they like.
        5 => {
            let teeth = 1 + numbers.below(6);
            let gap = 10.0_f64.powf(numbers.between(-9.0, -1.5));
            let mut points = vec![(1.0, -1.0), (1.0, 1.0)];
            for k in (0..teeth).rev() {
                let x = -1.0 + 2.0 * (k as f64 + 0.5) / teeth as f64;
                points.extend([(x + gap, 1.0), (x, -0.9), (x - gap, 1.0)]);
            }
            points.extend([(-1.0, 1.0), (-1.0, -1.0)]);
            points
        }
        // A square with a corner cut off by a hair, and doubled vertices.
        6 => {
            let hair = 10.0_f64.powf(numbers.between(-16.0, -1.0));
            vec![
                (-1.0, -1.0),
                (1.0, -1.0),
                (1.0, 1.0 - hair),
                (1.0, 1.0 - hair),
                (1.0 - hair, 1.0),
                (-1.0, 1.0),
                (-1.0, 1.0),
            ]
        }
        // Too few vertices.
        7 => circle(numbers.below(4), 1.0),
        _ => {
            let count = 3 + numbers.below(12);
            star(numbers, count, 0.3, 1.0)
        }
    };
    if numbers.below(2) == 0 {
        points.reverse();
    }
    if numbers.below(3) == 0 && !points.is_empty() {
        // A spike without width, or a vertex twice.
        let k = numbers.below(points.len());
        let p = points[k];
        let out = (p.0 * 1.5, p.1 * 1.5);
        points.insert(k, if numbers.below(2) == 0 { out } else { p });
        points.insert(k, p);
    }
    points
}

fn options(numbers: &mut Numbers, size: f64) -> DomainOptions {
    let mut options = DomainOptions {
        edge_length: size * numbers.pick(&[0.0, 0.05, 0.1, 0.3, 100.0]),
        max_vertices: numbers.pick(&[0, 10, 200, 400, 400, 1000, 3000]),
        min_angle_deg: numbers.pick(&[0.0, 20.0, 25.0, 32.0]),
        corner_deg: numbers.pick(&[1e-3, 30.0, 60.0, 179.0]),
        ..DomainOptions::default()
    };
    if numbers.below(4) == 0 {
        options.grading = numbers.pick(&[0.05, 0.3, 2.0]);
        options.boundary_length = options.edge_length * numbers.pick(&[0.0, 0.01, 0.3]);
    }
    if numbers.below(40) == 0 {
        let bad = numbers.pick(&[-1.0, f64::NAN, f64::INFINITY, 1e-300, 1e300]);
        match numbers.below(5) {
            0 => options.edge_length = bad,
            1 => options.min_angle_deg = bad,
            2 => options.corner_deg = bad,
            3 => options.grading = bad,
            _ => options.boundary_length = bad,
        }
    }
    options
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_splitmix64() {
        // The first outputs of the reference implementation for seed 1234567.
        let mut numbers = Numbers(1_234_567);
        let first = [numbers.next(), numbers.next(), numbers.next()];
        assert_eq!(
            first,
            [
                6_457_827_717_110_365_317,
                3_203_168_211_198_807_973,
                9_817_491_932_198_370_423
            ]
        );
        let mut numbers = Numbers(7);
        assert!((0..1000).all(|_| (2.0..3.0).contains(&numbers.between(2.0, 3.0))));
        assert!((0..1000).all(|_| numbers.below(3) < 3));
    }

    #[test]
    fn seeds_repeat_and_differ() {
        assert_eq!(polygon(5), polygon(5));
        assert_ne!(polygon(5), polygon(6));
        assert_ne!(right_angled(1), right_angled(2));
        let bits = |h: &Hostile| format!("{:?}", h.polygon);
        assert_eq!(bits(&hostile(3)), bits(&hostile(3)));
    }
}
