//! The local metric frame: metres around the site's centre, and back.

use geo_types::Coord;

/// First eccentricity squared of the WGS84 ellipsoid.
const E2: f64 = 0.006_694_379_990_14;
/// Semi-major axis of the WGS84 ellipsoid, in metres.
const A: f64 = 6_378_137.0;

/// Takes the coordinates of a file into local metres, and back.
///
/// All of this crate works in metres relative to the site's centre, x east and
/// y north, so that a site far from the origin of its map loses no digits and
/// gives the same plan as one near it. Two sorts of source:
///
/// - *longitude and latitude* in degrees. An edge of GeoJSON is straight in
///   these numbers (RFC 7946, 3.1.1), so the frame is affine in them: metres per
///   degree are those of the WGS84 radii of curvature (prime vertical N and
///   meridian M) at the centre, `kx = N cos(lat) pi/180`, `ky = M pi/180`.
///   Away from the centre scale errs by about `tan(lat) d/R` eastwards: 2e-4 at 1 km from
///   the centre of a site in Helsinki.
/// - *metres* of any projection: the centre is subtracted, no more, and added
///   again to the last bit.
///
/// # Examples
///
/// ```
/// use geo_types::coord;
/// use urban_layout::io::frame::Frame;
///
/// let helsinki = Frame::degrees(coord! { x: 24.94, y: 60.17 });
/// let local = helsinki.to_local(coord! { x: 24.94, y: 60.18 });
/// assert!(local.x.abs() < 1e-3 && (local.y - 1114.2).abs() < 0.1);
/// let back = helsinki.to_source(local);
/// assert!((back.x - 24.94).abs() < 1e-12 && (back.y - 60.18).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The source coordinates of the local origin.
    centre: Coord<f64>,
    /// Metres per source unit eastwards and northwards.
    scale: Coord<f64>,
    degrees: bool,
}

impl Frame {
    /// A frame for longitude (x) and latitude (y), centred on or within 1e-8
    /// degrees of the given point.
    #[must_use]
    pub fn degrees(centre: Coord<f64>) -> Self {
        // Coarse enough that a difference to it has no rounding error, and
        // fine enough (1 mm) that the radii are those of the centre.
        let centre = round_to(centre, (1_u64 << 26) as f64);
        let latitude = centre.y.to_radians();
        let w = (1.0 - E2 * latitude.sin().powi(2)).sqrt();
        Self {
            centre,
            scale: Coord {
                x: (A / w * latitude.cos()).to_radians(),
                y: (A * (1.0 - E2) / w.powi(3)).to_radians(),
            },
            degrees: true,
        }
    }

    /// A frame for metres of some projection, centred on or within 1 mm of the
    /// given point.
    #[must_use]
    pub fn metres(centre: Coord<f64>) -> Self {
        // With a centre on a coarse binary grid, differences are exact, and so
        // is the way back; two copies of a site a whole number of metres apart
        // get the same local coordinates, bit by bit.
        Self {
            centre: round_to(centre, 1024.0),
            scale: Coord { x: 1.0, y: 1.0 },
            degrees: false,
        }
    }

    /// From the coordinates of the file to local metres.
    #[must_use]
    pub fn to_local(&self, c: Coord<f64>) -> Coord<f64> {
        Coord {
            x: (c.x - self.centre.x) * self.scale.x,
            y: (c.y - self.centre.y) * self.scale.y,
        }
    }

    /// From local metres to the coordinates of the file.
    #[must_use]
    pub fn to_source(&self, c: Coord<f64>) -> Coord<f64> {
        Coord {
            x: c.x / self.scale.x + self.centre.x,
            y: c.y / self.scale.y + self.centre.y,
        }
    }

    /// Whether the file's coordinates are longitude and latitude (metres
    /// otherwise).
    #[must_use]
    pub fn is_degrees(&self) -> bool {
        self.degrees
    }

    /// The file's coordinates of the local origin.
    #[must_use]
    pub fn centre(&self) -> Coord<f64> {
        self.centre
    }
}

/// Rounds to a multiple of 1 / `parts`, unless that overflows.
fn round_to(c: Coord<f64>, parts: f64) -> Coord<f64> {
    let round = |value: f64| {
        let scaled = value * parts;
        if scaled.is_finite() {
            scaled.round() / parts
        } else {
            value
        }
    };
    Coord {
        x: round(c.x),
        y: round(c.y),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Metres per degree at latitude 45, from the tables of the ellipsoid
    /// (NIMA TR8350.2): 78 846.8 m eastwards, 111 131.7 m northwards.
    #[test]
    fn scale_is_that_of_the_ellipsoid() {
        let frame = Frame::degrees(Coord { x: 7.0, y: 45.0 });
        let d = frame.to_local(Coord { x: 8.0, y: 46.0 });
        assert!((d.x - 78_846.8).abs() < 0.1, "{}", d.x);
        assert!((d.y - 111_131.8).abs() < 0.1, "{}", d.y);
    }

    #[test]
    fn metres_come_back_to_the_bit() {
        let frame = Frame::metres(Coord {
            x: 497_212.345_6,
            y: 6_702_931.1,
        });
        for k in 0..1000 {
            let c = Coord {
                x: 497_000.0 + f64::from(k) * 0.123_456_7,
                y: 6_702_000.0 + f64::from(k) * 1.987_654_3,
            };
            assert_eq!(frame.to_source(frame.to_local(c)), c);
        }
        assert!(!frame.is_degrees());
    }

    #[test]
    fn a_site_moved_by_whole_metres_has_the_same_local_coordinates() {
        let (near, far) = (
            Frame::metres(Coord { x: 10.3, y: -4.7 }),
            Frame::metres(Coord {
                x: 500_010.3,
                y: 4_999_995.3,
            }),
        );
        for k in 0..100 {
            let c = Coord {
                x: f64::from(k) * 7.25,
                y: f64::from(k * k) * 0.5,
            };
            let moved = Coord {
                x: c.x + 500_000.0,
                y: c.y + 5_000_000.0,
            };
            assert_eq!(near.to_local(c), far.to_local(moved));
        }
    }
}
