//! The axes that directions are told by.

use geo_types::Coord;

use crate::plane::{dot, right, unit};
use crate::shape::Region;

/// Two axes at right angles: x to the region's own east and y to its own north,
/// so that a mirrored region has a mirrored pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    pub(crate) x: Coord<f64>,
    pub(crate) y: Coord<f64>,
    /// Whether y lies to the right of x.
    pub(crate) mirrored: bool,
}

impl Frame {
    /// The axes of the compass.
    pub(crate) const COMPASS: Self = Self {
        x: Coord { x: 1.0, y: 0.0 },
        y: Coord { x: 0.0, y: 1.0 },
        mirrored: false,
    };

    /// The axes of a region. Where its local coordinates are not at right
    /// angles, x is the line through the middles of the western and eastern
    /// side.
    pub(crate) fn of(region: &Region) -> Self {
        let local = region.local;
        let [a, b, c, d] = local.corners;
        let x = unit((d - a) + (c - b));
        if x == Coord::default() {
            return Self::COMPASS;
        }
        let mirrored = local.mirrored();
        let aside = right(x);
        Self {
            x,
            y: if mirrored { aside } else { -aside },
            mirrored,
        }
    }

    /// The unit vector at an angle, radians from x towards y.
    pub(crate) fn direction(&self, angle: f64) -> Coord<f64> {
        self.x * angle.cos() + self.y * angle.sin()
    }

    /// The angle of a vector, radians from x towards y, within half a turn.
    pub(crate) fn angle(&self, v: Coord<f64>) -> f64 {
        dot(v, self.y).atan2(dot(v, self.x))
    }

    /// A point by its distances along the axes.
    pub(crate) fn coordinates(&self, p: Coord<f64>) -> Coord<f64> {
        Coord {
            x: dot(p, self.x),
            y: dot(p, self.y),
        }
    }
}

/// Which way an edge faces: away from the land, which lies on its right.
pub(crate) fn outward(a: Coord<f64>, b: Coord<f64>) -> Coord<f64> {
    -right(unit(b - a))
}

/// How far an angle lies from another, radians, 0 to half a turn.
pub(crate) fn apart(a: f64, b: f64) -> f64 {
    let turn = (a - b).rem_euclid(std::f64::consts::TAU);
    turn.min(std::f64::consts::TAU - turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Area;
    use geo_types::coord;

    #[test]
    fn mirrored_regions_have_mirrored_axes() {
        let ring = vec![
            coord! { x: 0., y: 0. },
            coord! { x: 0., y: 2. },
            coord! { x: 4., y: 2. },
            coord! { x: 4., y: 0. },
        ];
        let mut region = Region::bare(Area::new(ring, Vec::new()));
        assert_eq!(Frame::of(&region), Frame::COMPASS);
        region.local = region.local.flipped(true, false);
        let frame = Frame::of(&region);
        assert!(frame.mirrored);
        assert_eq!(frame.direction(0.0), coord! { x: -1., y: 0. });
        assert_eq!(frame.angle(coord! { x: 0., y: 3. }).to_degrees(), 90.0);
        assert_eq!(frame.angle(coord! { x: -1., y: 0. }), 0.0);
    }

    #[test]
    fn angles_wrap() {
        let degrees = |a: f64, b: f64| apart(a.to_radians(), b.to_radians()).to_degrees();
        assert!((degrees(170.0, -170.0) - 20.0).abs() < 1e-9);
        assert!((degrees(-45.0, 45.0) - 90.0).abs() < 1e-9);
    }
}
