//! Does the line carry on a street that ends here?

use super::Score;
use crate::field::DirectionField;
use crate::streamline::Streamline;
use crate::vector::{cross, dot, norm, unit};
use geo_types::Coord;

/// CT(s) of the paper: 1 less a half for each end that continues an existing
/// streamline. An end does so if it lies within [`distance`](Self::distance)
/// of an existing end and their directions differ by at most
/// [`angle_deg`](Self::angle_deg), whichever way they point: 1, 0.5 or 0.
///
/// Give the ends that lie on the region's boundary: all candidates are
/// compared with each of them. Ends without a direction continue nothing.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Continuity {
    /// Point and direction (non-zero, of any length and sign) of each end of an
    /// existing streamline.
    pub ends: Vec<(Coord<f64>, Coord<f64>)>,
    /// d_dist of the paper, in metres.
    ///
    /// Default value: 4 m.
    pub distance: f64,
    /// d_dir of the paper, in degrees.
    ///
    /// Default value: 20 degrees.
    pub angle_deg: f64,
}

impl Default for Continuity {
    fn default() -> Self {
        Self {
            ends: Vec::new(),
            distance: 4.0,
            angle_deg: 20.0,
        }
    }
}

impl Continuity {
    /// True if a line that ends at `at` with the given direction continues an
    /// existing one.
    #[must_use]
    pub fn continues(&self, at: Coord<f64>, direction: Coord<f64>) -> bool {
        let Some(direction) = unit(direction) else {
            return false;
        };
        self.ends.iter().any(|&(end, way)| {
            let gap = end - at;
            // The cheap test first: nearly all ends are far away.
            if gap.x.abs() > self.distance || norm(gap) > self.distance {
                return false;
            }
            unit(way).is_some_and(|way| {
                let between = cross(direction, way).abs().atan2(dot(direction, way).abs());
                between.to_degrees() <= self.angle_deg
            })
        })
    }
}

impl Score for Continuity {
    fn name(&self) -> &str {
        "continuity"
    }

    /// A closed line has no ends, and costs 1.
    fn cost(&self, line: &Streamline, _: &dyn DirectionField) -> f64 {
        let (Some(&start), Some(&end)) = (line.points.first(), line.points.last()) else {
            return 1.0;
        };
        if line.is_closed() {
            return 1.0;
        }
        let half = |continued| if continued { 0.5 } else { 0.0 };
        1.0 - half(self.continues(start, line.start_tangent()))
            - half(self.continues(end, line.end_tangent()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::eastwards;
    use crate::vector::point;

    #[test]
    fn one_half_for_each_end() {
        let (east, line) = eastwards();
        let cost = |ends: &[(Coord<f64>, Coord<f64>)]| {
            Continuity {
                ends: ends.to_vec(),
                ..Continuity::default()
            }
            .cost(&line, &east)
        };
        let west = (point(-3.0, 42.0), point(5.0, 1.7));
        let east_end = (point(100.0, 39.0), point(-1.0, 0.0));
        assert_eq!(cost(&[]), 1.0);
        assert_eq!(cost(&[west]), 0.5);
        assert_eq!(cost(&[west, east_end, east_end]), 0.0);
        assert_eq!(
            cost(&[(point(-3.0, 43.0), point(1.0, 0.0))]),
            1.0,
            "too far"
        );
        assert_eq!(
            cost(&[(point(-3.0, 42.0), point(5.0, 1.9))]),
            1.0,
            "too oblique: 20.8 degrees"
        );
        assert_eq!(
            cost(&[(point(0.0, 40.0), point(0.0, 0.0))]),
            1.0,
            "no direction"
        );
    }
}
