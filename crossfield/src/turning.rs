//! How a field turns: in a triangle, and along a curve.

use geo_types::{Coord, LineString};

use crate::cross::Cross;
use crate::domain::Cursor;
use crate::field::Field;
use crate::plane::{coord, left, vector, V2};

/// How a field turns within a triangle, see [`Field::turning_in`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Turning {
    /// The cross in the middle of the triangle.
    pub cross: Cross,
    /// Gradient of the angle u of its arms, radians per metre.
    pub gradient: Coord<f64>,
}

impl Turning {
    fn arms(&self) -> [V2; 2] {
        let [first, second, ..] = self.cross.arms();
        [vector(first), vector(second)]
    }

    /// Divergence of the first two arms of the cross, 1 / metre; the other two
    /// have the opposite ones.
    #[must_use]
    pub fn divergence(&self) -> [f64; 2] {
        self.arms().map(|arm| vector(self.gradient).dot(&left(arm)))
    }

    /// Curvature of the streamlines along the first two arms, 1 / metre,
    /// positive to the left; the other two have the opposite ones.
    ///
    /// The streamlines of one family bend as those of the other spread:
    /// `curvature[1] == divergence[0]` and `curvature[0] == -divergence[1]`.
    #[must_use]
    pub fn curvature(&self) -> [f64; 2] {
        self.arms().map(|arm| vector(self.gradient).dot(&arm))
    }
}

/// Integrals of a field along a curve, see [`Field::along`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AlongCurve {
    /// Length of the curve within the domain, singular triangles left out,
    /// metres. All integrals run over this part.
    pub length: f64,
    /// Length outside the domain and in singular triangles, metres.
    pub left_out: f64,
    /// Integral of div d, d the arm nearest to the curve's direction: signed,
    /// so that spreading and narrowing cancel.
    pub divergence: f64,
    /// Integral of |div d|.
    pub abs_divergence: f64,
    /// Integral of the curvature of the streamlines met along d: by how much
    /// a streamline of this length would turn, radians.
    pub curvature: f64,
    /// Integral of its absolute value.
    pub abs_curvature: f64,
    /// Mean angle between the curve and the arm nearest to it, radians,
    /// between 0 and pi/4: 0 for a streamline.
    pub mean_deviation: f64,
}

impl Field {
    /// How the field turns in `triangle`, an index into
    /// [`Domain::triangles`](crate::Domain::triangles); `None` where it is
    /// singular.
    ///
    /// ```
    /// use crossfield::{geo_types::polygon, BoundaryField, Domain, DomainOptions, FieldDesign};
    ///
    /// let site = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 50., y: 40.), (x: 0., y: 40.)];
    /// let field = BoundaryField::default().design(&Domain::new(&site, &DomainOptions::default())?)?;
    /// // The triangle whose streamlines spread most.
    /// let spread = |t: &usize| {
    ///     let [a, b] = field.turning_in(*t)?.divergence();
    ///     Some(a.abs().max(b.abs()))
    /// };
    /// let triangles = 0..field.domain().triangles().len();
    /// let most = triangles.filter_map(|t| spread(&t)).fold(0.0, f64::max);
    /// assert!(most > 1e-3);
    /// # Ok::<(), crossfield::FieldError>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If `triangle` is not a triangle of the domain.
    #[must_use]
    pub fn turning_in(&self, triangle: usize) -> Option<Turning> {
        let inner = &*self.domain().inner;
        let middle = inner.mesh.triangles[triangle]
            .iter()
            .fold(V2::zeros(), |sum, &v| sum + inner.mesh.points[v as usize])
            / 3.0;
        Some(Turning {
            cross: Cross::from_vector(self.interpolate(triangle, middle))?,
            gradient: coord(self.angle_gradient(triangle)?),
        })
    }

    /// Integrals of divergence, curvature and deviation along `curve`, a
    /// street say.
    ///
    /// Exact in where the curve passes from triangle to triangle; within each
    /// the gradient of u is constant, and the arm is taken in the middle of
    /// the way through it, which is of second order in the edge length.
    ///
    /// # Complexity
    ///
    /// O(triangles met), after a cold start.
    #[must_use]
    pub fn along(&self, curve: &LineString<f64>) -> AlongCurve {
        let mut sums = AlongCurve::default();
        let mut cursor = Cursor::default();
        let total: f64 = curve
            .0
            .windows(2)
            .map(|pair| self.along_segment(pair[0], pair[1], &mut cursor, &mut sums))
            .sum();
        sums.left_out = (total - sums.length).max(0.0);
        if sums.length > 0.0 {
            sums.mean_deviation /= sums.length;
        }
        sums
    }

    /// Adds the integrals of one segment; gives its whole length.
    fn along_segment(
        &self,
        from: Coord<f64>,
        to: Coord<f64>,
        cursor: &mut Cursor,
        sums: &mut AlongCurve,
    ) -> f64 {
        let (a, b) = (self.domain().local(from), self.domain().local(to));
        let way = b - a;
        let length = way.norm();
        if !(length > 0.0 && length.is_finite()) {
            return 0.0;
        }
        let along = way / length;
        self.domain()
            .inner
            .follow(a, b, cursor, |triangle, start, end| {
                let middle = a + way * ((start + end) / 2.0);
                let cross = Cross::from_vector(self.interpolate(triangle, middle));
                let (Some(slope), Some(cross)) = (self.angle_gradient(triangle), cross) else {
                    return;
                };
                let part = (end - start) * length;
                let arm = vector(cross.arm_towards(coord(along)));
                let (divergence, curvature) = (slope.dot(&left(arm)), slope.dot(&arm));
                sums.length += part;
                sums.divergence += divergence * part;
                sums.abs_divergence += divergence.abs() * part;
                sums.curvature += curvature * part;
                sums.abs_curvature += curvature.abs() * part;
                sums.mean_deviation += along.dot(&arm).clamp(-1.0, 1.0).acos() * part;
            });
        length
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::{coord, line_string, polygon};
    use std::f64::consts::{FRAC_PI_2, TAU};

    /// Radial and tangential crosses around the origin, on a frame around it.
    fn polar(edge_length: f64) -> Field {
        let shape = polygon!(
            exterior: [(x: -20., y: -20.), (x: 20., y: -20.), (x: 20., y: 20.), (x: -20., y: 20.)],
            interiors: [[(x: -3., y: -3.), (x: 3., y: -3.), (x: 3., y: 3.), (x: -3., y: 3.)]],
        );
        Field::polar(&shape, edge_length)
    }

    #[test]
    fn integrals_along_rays_and_circles_are_known() {
        let field = polar(0.3);
        // Along a ray div = 1 / r: the logarithm of the ratio of the radii.
        let ray = field.along(&line_string![(x: 6., y: 3.), (x: 16., y: 8.)]);
        assert!(
            (ray.divergence - (8.0_f64 / 3.0).ln()).abs() < 2e-3,
            "{ray:?}"
        );
        assert!((ray.length - 125.0_f64.sqrt()).abs() < 1e-9 && ray.left_out < 1e-9);
        assert!(ray.abs_curvature < 0.01 && ray.mean_deviation < 0.002);
        // Around a circle the arm turns by a full turn.
        let circle: Vec<(f64, f64)> = (0..=720)
            .map(|k| {
                let (s, c) = (TAU * f64::from(k) / 720.0).sin_cos();
                (10.0 * c, 10.0 * s)
            })
            .collect();
        let circle = field.along(&LineString::from(circle));
        assert!((circle.curvature - TAU).abs() < 5e-3, "{circle:?}");
        assert!(circle.divergence.abs() < 0.02 && circle.mean_deviation < 0.01);
        // Through the hole: what is outside is told apart.
        let across = field.along(&line_string![(x: -30., y: 1.), (x: 10., y: 1.)]);
        assert!((across.length - 24.0).abs() < 1e-9, "{across:?}");
        assert!((across.left_out - 16.0).abs() < 1e-9);
    }

    #[test]
    fn a_bent_curve_deviates_and_points_do_not() {
        let field = polar(0.5);
        // At 45 degrees to a ray all the way is impossible to miss.
        let short = field.along(&line_string![(x: 10., y: 0.), (x: 10.01, y: 0.01)]);
        assert!((short.mean_deviation - FRAC_PI_2 / 2.0).abs() < 0.02);
        let nothing = field.along(&LineString::from(vec![coord! {x: 1.0, y: 1.0}]));
        assert_eq!(nothing, AlongCurve::default());
        let nan = field.along(&line_string![(x: 1., y: 1.), (x: f64::NAN, y: 1.)]);
        assert_eq!(nan, AlongCurve::default());
    }

    #[test]
    fn what_one_family_spreads_the_other_bends() {
        let field = polar(1.0);
        for t in 0..field.domain().triangles().len() {
            let turning = field.turning_in(t).expect("regular");
            let (d, c) = (turning.divergence(), turning.curvature());
            assert!((c[1] - d[0]).abs() < 1e-12 && (c[0] + d[1]).abs() < 1e-12);
        }
    }
}
