//! Frames with given windings, and how they turn along edges.
//!
//! A frame `F(p) = prod((p - p_i) / |p - p_i|)^k_i` winds k_i times around each
//! of its poles. Fields are measured against it in
//! [`PrescribedField`](crate::PrescribedField).

use crate::domain::{Border, Domain, Ring};
use crate::plane::{orient, wedge, V2};
use crate::symmetry::{product, Symmetry};

/// A place that F winds around: a singularity, or a hole.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pole {
    pub(crate) at: V2,
    pub(crate) index: i32,
}

/// F at `p`.
pub(crate) fn frame(poles: &[Pole], p: V2) -> V2 {
    let power = |pole: &Pole| {
        let d = p - pole.at;
        let (y, x) = (f64::from(pole.index) * d.y.atan2(d.x)).sin_cos();
        V2::new(x, y)
    };
    poles.iter().map(power).fold(V2::new(1.0, 0.0), product)
}

/// By how much F turns on the straight way from `p` to `q`.
pub(crate) fn transport(poles: &[Pole], p: V2, q: V2) -> f64 {
    let seen = |pole: &Pole| {
        let (a, b) = (p - pole.at, q - pole.at);
        f64::from(pole.index) * wedge(a, b).atan2(a.dot(&b))
    };
    poles.iter().map(seen).sum()
}

/// How often the wanted D~ turns along a ring, the domain on its left.
pub(crate) fn winding(ring: &Ring, symmetry: Symmetry) -> i32 {
    let around = if ring.area() > 0.0 { 1 } else { -1 };
    let corners: i32 = ring.turn.iter().map(|&turn| whole(turn, symmetry)).sum();
    around * symmetry.folds() as i32 - corners
}

/// A turn of the boundary in whole N-th turns.
pub(crate) fn whole(turn: f64, symmetry: Symmetry) -> i32 {
    (turn / symmetry.period()).round() as i32
}

/// The borders of each ring, in the order in which it is walked.
pub(crate) fn chains(domain: &Domain) -> Vec<Vec<Border>> {
    let inner = &*domain.inner;
    let mut chains = vec![Vec::new(); inner.rings.len()];
    for &border in &inner.mesh.borders {
        chains[border.ring as usize].push(border);
    }
    for (chain, ring) in chains.iter_mut().zip(&inner.rings) {
        let place = |border: &Border| {
            let (start, _) = ring.edge(border.edge as usize);
            (inner.mesh.points[border.from as usize] - start).norm_squared()
        };
        chain.sort_by(|a, b| {
            let edges = a.edge.cmp(&b.edge);
            edges.then_with(|| place(a).total_cmp(&place(b)))
        });
    }
    chains
}

/// `p`, moved so far into its triangle that each corner has a share of a
/// seventh or more: no vertex comes near it, and no edge is seen under more
/// than 152 degrees in a triangle with even sides. By a quarter of a side at
/// most.
pub(crate) fn well_inside(corners: [V2; 3], p: V2) -> V2 {
    let [a, b, c] = corners;
    let shares = [orient(b, c, p), orient(c, a, p), orient(a, b, p)];
    let whole = orient(a, b, c);
    let shares = shares.map(|s| {
        if whole > 0.0 {
            (s / whole).max(0.2)
        } else {
            1.0
        }
    });
    let total: f64 = shares.iter().sum();
    (a * shares[0] + b * shares[1] + c * shares[2]) / total
}

/// A point inside a hole: in the middle of the widest piece of a line
/// across it.
pub(crate) fn inside(ring: &Ring) -> V2 {
    let mut heights: Vec<f64> = ring.points.iter().map(|p| p.y).collect();
    heights.sort_by(f64::total_cmp);
    // Half-way between two heights that differ most: no vertex is met.
    let gap = (0..heights.len() - 1)
        .max_by(|&i, &j| (heights[i + 1] - heights[i]).total_cmp(&(heights[j + 1] - heights[j])));
    let k = gap.unwrap_or(0);
    let y = f64::midpoint(heights[k], heights[k + 1]);
    let mut met: Vec<f64> = (0..ring.len())
        .filter_map(|k| {
            let (a, b) = ring.edge(k);
            ((a.y > y) != (b.y > y)).then(|| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
        })
        .collect();
    met.sort_by(f64::total_cmp);
    let widest = met
        .chunks_exact(2)
        .max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let x = widest.map_or(ring.points[0].x, |pair| f64::midpoint(pair[0], pair[1]));
    V2::new(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DomainOptions;
    use geo_types::polygon;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn a_point_inside_a_hole_is_inside() {
        let shape = polygon!(
            exterior: [(x: 0., y: 0.), (x: 40., y: 0.), (x: 40., y: 40.), (x: 0., y: 40.)],
            // A horseshoe, whose centre lies outside it.
            interiors: [[(x: 10., y: 10.), (x: 30., y: 10.), (x: 30., y: 30.), (x: 27., y: 30.),
                (x: 27., y: 13.), (x: 13., y: 13.), (x: 13., y: 30.), (x: 10., y: 30.)]],
        );
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let ring = &domain.inner.rings[1];
        assert!(ring.contains(inside(ring)));
        assert!(winding(ring, Symmetry::Cross) == 0);
        assert_eq!(winding(&domain.inner.rings[0], Symmetry::Cross), 0);
    }

    #[test]
    fn transport_is_the_turn_of_the_frame() {
        let poles = [
            Pole {
                at: V2::new(0.3, 0.2),
                index: 1,
            },
            Pole {
                at: V2::new(-0.4, 0.1),
                index: -3,
            },
        ];
        let (p, q) = (V2::new(1.0, -0.5), V2::new(0.7, 1.1));
        let theta = transport(&poles, p, q);
        let (y, x) = theta.sin_cos();
        let turned = product(frame(&poles, p), V2::new(x, y));
        assert!((turned - frame(&poles, q)).norm() < 1e-12);
        assert!(theta.abs() < PI * 4.0);
        // Around both, in steps: their indices.
        let walk =
            [(1., -1.), (1., 1.), (-1., 1.), (-1., -1.), (1., -1.)].map(|(x, y)| V2::new(x, y));
        let around: f64 = walk.windows(2).map(|w| transport(&poles, w[0], w[1])).sum();
        assert!((around + 2.0 * TAU).abs() < 1e-12);
    }
}
