//! Where the site's boundary meets streets that are there already.

use geo_types::{Coord, LineString};

use super::index::Segments;

/// How far beyond a street's edge it still gives access, in metres: a verge and
/// a footpath.
pub(crate) const VERGE: f64 = 6.0;

/// The stretches of the boundary from which a street outside can be reached:
/// those within half its width and 6 m of its centreline.
///
/// Made by [`Site::access`](super::Site::access) and
/// [`Site::exits`](super::Site::exits). Indexed: a question costs O(log n) in
/// the number of street segments.
#[derive(Clone, Debug)]
pub struct AccessZones(Segments);

impl AccessZones {
    /// Zones around centrelines, each with its street's width, in local metres.
    pub(crate) fn new<'a>(streets: impl Iterator<Item = (&'a LineString<f64>, f64)>) -> Self {
        Self(Segments::from_lines(
            streets.map(|(line, width)| (line, width / 2.0 + VERGE)),
        ))
    }

    /// Whether a point (in local metres; meant to lie on the boundary) is in a
    /// zone.
    #[must_use]
    pub fn covers(&self, c: Coord<f64>) -> bool {
        self.0.covers(c)
    }

    /// Whether there is no street at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The stretches of the segment from `a` to `b` that lie in a zone, exact:
    /// disjoint intervals `[from, to]` of its parameter (0 at `a`, 1 at `b`),
    /// ascending.
    #[must_use]
    pub fn stretches(&self, a: Coord<f64>, b: Coord<f64>) -> Vec<[f64; 2]> {
        let found = self.0.stretches(a, b, None);
        found.into_iter().map(|(from, to)| [from, to]).collect()
    }

    /// The length of a line that lies in a zone, in metres.
    #[must_use]
    pub fn covered_length(&self, line: &LineString<f64>) -> f64 {
        line.0
            .windows(2)
            .map(|w| {
                let d = w[1] - w[0];
                let share: f64 = self.stretches(w[0], w[1]).iter().map(|s| s[1] - s[0]).sum();
                share * d.x.hypot(d.y)
            })
            // An empty sum is -0.
            .fold(0.0, |sum, length| sum + length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zone_reaches_half_the_width_and_the_verge() {
        let street = LineString::from(vec![(0.0, -10.0), (100.0, -10.0)]);
        let zones = AccessZones::new(std::iter::once((&street, 12.0)));
        assert!(!zones.is_empty());
        assert!(zones.covers(Coord { x: 50.0, y: 1.9 }));
        assert!(!zones.covers(Coord { x: 50.0, y: 2.1 }));
        assert!(!zones.covers(Coord { x: 115.0, y: 0.0 }));
        // At y = 0 the round end reaches sqrt(12^2 - 10^2) past x = 100.
        let line = LineString::from(vec![(50.0, 0.0), (150.0, 0.0)]);
        let expected = 50.0 + 44.0_f64.sqrt();
        assert!((zones.covered_length(&line) - expected).abs() < 1e-9);
        assert!(AccessZones::new(std::iter::empty()).is_empty());
    }
}
