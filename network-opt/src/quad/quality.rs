//! How good a quad mesh is.

use std::fmt;

use crate::design::Tessellation;

/// What the paper asks of a mesh: mostly valence 4, near to squares, of one
/// size. Faces that are no quads are left out of the angles and sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct QuadQuality {
    /// Number of quads.
    pub quads: usize,
    /// Share of inner vertices with four edges, 0 to 1.
    pub regular: f64,
    /// Inner vertices with three edges, five, and any other number but four.
    pub irregular: [usize; 3],
    /// Smallest and largest angle, degrees.
    pub min_angle_deg: f64,
    /// See [`min_angle_deg`](Self::min_angle_deg).
    pub max_angle_deg: f64,
    /// Mean deviation of angles from 90 degrees, degrees.
    pub mean_deviation_deg: f64,
    /// Longest over shortest side of a quad: the mean, and the worst.
    pub mean_aspect: f64,
    /// See [`mean_aspect`](Self::mean_aspect).
    pub worst_aspect: f64,
    /// Standard deviation of the edges' lengths over their mean.
    pub edge_spread: f64,
}

impl QuadQuality {
    /// Measures a mesh; all zero, and regular, without quads.
    #[must_use]
    pub fn of(mesh: &Tessellation) -> Self {
        let mut on_rim = vec![false; mesh.points().len()];
        for (&[a, b], rim) in mesh.edges().iter().zip(mesh.rim()) {
            on_rim[a] |= rim;
            on_rim[b] |= rim;
        }
        let (mut inner, mut irregular) = (0_usize, [0; 3]);
        for v in (0..mesh.points().len()).filter(|&v| !on_rim[v]) {
            inner += 1;
            match mesh.around(v).len() {
                4 => {}
                3 => irregular[0] += 1,
                5 => irregular[1] += 1,
                _ => irregular[2] += 1,
            }
        }
        let (mut low, mut high, mut off, mut aspects, mut worst) =
            (f64::INFINITY, 0.0_f64, 0.0, 0.0, 0.0_f64);
        let mut quads = 0;
        for face in mesh.faces().iter().filter(|face| face.len() == 4) {
            quads += 1;
            let corner = |k: usize| mesh.points()[face[k % 4]];
            let (mut short, mut long) = (f64::INFINITY, 0.0_f64);
            for k in 0..4 {
                let (to, from) = (corner(k + 1) - corner(k), corner(k + 3) - corner(k));
                let angle = (to.x * from.y - to.y * from.x)
                    .atan2(to.x * from.x + to.y * from.y)
                    .to_degrees();
                low = low.min(angle);
                high = high.max(angle);
                off += (angle - 90.0).abs();
                let side = to.x.hypot(to.y);
                short = short.min(side);
                long = long.max(side);
            }
            aspects += long / short;
            worst = worst.max(long / short);
        }
        let count = f64::from(u32::try_from(quads).unwrap_or(u32::MAX)).max(1.0);
        let lengths: Vec<f64> = (0..mesh.edges().len()).map(|e| mesh.length(e)).collect();
        let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
        let square: f64 = lengths.iter().map(|l| (l - mean) * (l - mean)).sum();
        let spread = (square / lengths.len().max(1) as f64).sqrt();
        Self {
            quads,
            regular: if inner == 0 {
                1.0
            } else {
                1.0 - irregular.iter().sum::<usize>() as f64 / inner as f64
            },
            irregular,
            min_angle_deg: if quads == 0 { 0.0 } else { low },
            max_angle_deg: high,
            mean_deviation_deg: off / (4.0 * count),
            mean_aspect: aspects / count,
            worst_aspect: worst,
            edge_spread: if mean > 0.0 { spread / mean } else { 0.0 },
        }
    }
}

impl fmt::Display for QuadQuality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} quads, {:.1} % of inner vertices regular ({} of valence 3, {} of 5, {} others), angles {:.0} to {:.0} \
             deg, off by {:.1} on average, sides {:.2} (worst {:.1}), edges spread {:.2}",
            self.quads,
            100.0 * self.regular,
            self.irregular[0],
            self.irregular[1],
            self.irregular[2],
            self.min_angle_deg,
            self.max_angle_deg,
            self.mean_deviation_deg,
            self.mean_aspect,
            self.worst_aspect,
            self.edge_spread
        )
    }
}
