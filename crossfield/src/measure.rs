//! Divergence, curvature and energy of a field.
//!
//! Within a triangle, grad u comes from the unwrapped differences of 4u (of Nu
//! for N arms). With
//! d = (cos u, sin u) and d' = (-sin u, cos u) its left normal,
//! div d = grad u . d' and the curvature of the trajectory along d is
//! grad u . d: one gradient serves all.

use geo_types::Coord;

use crate::domain::Cursor;
use crate::field::Field;
use crate::operators::gradient;
use crate::plane::{left, vector, wedge, wrapped, V2};
use crate::symmetry::Rosy;

impl Field {
    /// Gradient of the angle u in a triangle, radians per metre; `None` if
    /// the triangle is singular.
    pub(crate) fn angle_gradient(&self, triangle: usize) -> Option<V2> {
        let inner = &*self.domain().inner;
        let vertices = inner.mesh.triangles[triangle].map(|v| v as usize);
        let (vectors, power) = self.roots();
        let phases = vertices.map(|v| {
            let d = vectors[v];
            d.y.atan2(d.x)
        });
        let differences = [
            wrapped(phases[0], phases[1]),
            wrapped(phases[1], phases[2]),
            wrapped(phases[2], phases[0]),
        ];
        // Around a regular triangle the differences add up to zero; around a
        // singular one, to a full turn.
        if differences.iter().sum::<f64>().abs() > 1.0 {
            return None;
        }
        let unwrapped = [0.0, differences[0], -differences[2]];
        let slope = gradient(vertices.map(|v| inner.mesh.points[v]), unwrapped)?;
        // The angle of the vectors is that of D over `power`.
        Some(slope * (f64::from(power) / self.symmetry().number()))
    }

    /// Gradient of u at `at`, and the arm nearest to `heading`.
    fn local_turning(
        &self,
        at: Coord<f64>,
        heading: Coord<f64>,
        cursor: &mut Cursor,
    ) -> Option<(V2, V2)> {
        let triangle = self.domain().locate(at, cursor)?;
        let d = self.interpolate(triangle, self.domain().local(at));
        let arm = vector(Rosy::from_vector(self.symmetry(), d)?.arm_towards(heading));
        Some((self.angle_gradient(triangle)?, arm))
    }

    /// Divergence of the arm nearest to `heading`, in 1 / metre: 0 where
    /// streamlines that way are parallel, positive where they spread.
    ///
    /// `None` outside the domain and in singular triangles. Constant in each
    /// triangle, but for the arm's own direction.
    #[must_use]
    pub fn divergence(
        &self,
        at: Coord<f64>,
        heading: Coord<f64>,
        cursor: &mut Cursor,
    ) -> Option<f64> {
        let (slope, arm) = self.local_turning(at, heading, cursor)?;
        Some(slope.dot(&left(arm)))
    }

    /// Curvature of the streamline at `at` that runs along the arm nearest to
    /// `heading`, in 1 / metre, positive to the left.
    ///
    /// `None` as for [`Field::divergence`].
    #[must_use]
    pub fn curvature(
        &self,
        at: Coord<f64>,
        heading: Coord<f64>,
        cursor: &mut Cursor,
    ) -> Option<f64> {
        let (slope, arm) = self.local_turning(at, heading, cursor)?;
        Some(slope.dot(&arm))
    }

    /// The integral of |grad u|^2 over the domain, without singular
    /// triangles: that of div^2 for both arms of the cross together.
    ///
    /// Has no unit. Grows with the logarithm of the mesh's fineness where the
    /// field has singularities.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.turning(|slope, _| slope.norm_squared())
    }

    /// Mean over the domain, without singular triangles, of |div|, averaged
    /// over both arms of the cross (over the lines of other symmetries); in
    /// 1 / metre.
    #[must_use]
    pub fn mean_abs_divergence(&self) -> f64 {
        let (lines, period) = (self.symmetry().lines(), self.symmetry().period());
        let total = self.turning(|slope, d| {
            let first = d.y.atan2(d.x) / self.symmetry().number();
            let divergence = |k: u32| {
                let (y, x) = (first + f64::from(k) * period).sin_cos();
                slope.dot(&left(V2::new(x, y))).abs()
            };
            (0..lines).map(divergence).sum::<f64>() / f64::from(lines)
        });
        total / self.domain().area()
    }

    /// Sum over regular triangles of area times a function of the gradient
    /// of u and D in the middle.
    fn turning(&self, function: impl Fn(V2, V2) -> f64) -> f64 {
        let mesh = &self.domain().inner.mesh;
        (0..mesh.triangles.len())
            .filter_map(|t| {
                let slope = self.angle_gradient(t)?;
                let [a, b, c] = mesh.triangles[t].map(|v| v as usize);
                let [p, q, r] = [a, b, c].map(|v| mesh.points[v]);
                let d = self.interpolate(t, (p + q + r) / 3.0);
                Some(function(slope, d) * wedge(q - p, r - p) / 2.0)
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{coord, polygon};

    /// Crosses along circles around the origin, seen from a square off it.
    fn polar(edge_length: f64) -> Field {
        let shape = polygon![(x: 10., y: 0.), (x: 20., y: 0.), (x: 20., y: 10.), (x: 10., y: 10.)];
        Field::polar(&shape, edge_length)
    }

    #[test]
    fn polar_crosses_diverge_outwards_and_bend_around() {
        let field = polar(0.25);
        let at = coord! {x: 15.0, y: 5.0};
        let radius = 15.0_f64.hypot(5.0);
        let around = coord! {x: -5.0, y: 15.0};
        let mut cursor = Cursor::default();
        let near = |value: Option<f64>, wanted: f64| {
            // First order in a triangle: the gradient varies by h / r.
            assert!((value.expect("inside") - wanted).abs() < 0.03 / radius);
        };
        near(field.divergence(at, at, &mut cursor), 1.0 / radius);
        near(field.divergence(at, around, &mut cursor), 0.0);
        near(field.curvature(at, at, &mut cursor), 0.0);
        near(field.curvature(at, around, &mut cursor), 1.0 / radius);
    }

    #[test]
    fn energy_and_mean_divergence_match_the_integrals() {
        // |grad u| = 1 / r; the integrals by a fine midpoint rule.
        let (mut energy, mut divergence) = (0.0, 0.0);
        let n = 400;
        for i in 0..n {
            for j in 0..n {
                let x = 10.0 + (f64::from(i) + 0.5) * 10.0 / f64::from(n);
                let y = (f64::from(j) + 0.5) * 10.0 / f64::from(n);
                energy += 1.0 / (x * x + y * y);
                divergence += 0.5 / x.hypot(y);
            }
        }
        let cell = (10.0 / f64::from(n)).powi(2);
        let field = polar(0.25);
        assert!((field.energy() / (energy * cell) - 1.0).abs() < 1e-3);
        assert!((field.mean_abs_divergence() / (divergence * cell / 100.0) - 1.0).abs() < 0.02);
    }
}
