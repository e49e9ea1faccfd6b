//! Where streets may leave the site.

use geo_types::Coord;

use crate::layout::plane::{lerp, segment_distance, stretch_within, Segments};
use crate::site::Site;

/// How far beyond half its width a given street still gives access to the
/// site's boundary, metres (FORMATS, kind `street`).
const REACH: f64 = 6.0;
/// A street end this near to a way out has reached it, metres.
const AT_EXIT: f64 = 1.0;

/// The ways out of a site: the stretches of its boundary within 6 m and half the
/// width of a given street outside or road; where none is given or none comes
/// near, the whole outer boundary.
#[derive(Debug)]
pub(crate) struct Exits {
    /// Edges of all parts; even owners are exteriors, odd ones hole rings.
    boundary: Segments,
    ways: Segments,
    /// Reach of each way by its number.
    reach: Vec<f64>,
    longest_reach: f64,
    /// Whether some way comes near the boundary at all.
    given: bool,
}

impl Exits {
    pub(crate) fn new(site: &Site) -> Self {
        let mut lines: Vec<&[Coord<f64>]> = Vec::new();
        for part in &site.parts {
            lines.push(&part.exterior().0);
            lines.push(&[]);
            for hole in part.interiors() {
                lines.push(&[]);
                lines.push(&hole.0);
            }
        }
        let boundary = Segments::of_lines(lines);
        let given = || {
            site.outside_streets
                .iter()
                .chain(&site.roads)
                .chain(&site.boundary_roads)
        };
        let reach: Vec<f64> = given().map(|road| road.width / 2.0 + REACH).collect();
        let ways = Segments::of_lines(given().map(|road| road.line.0.as_slice()));
        let longest_reach = reach.iter().copied().fold(0.0, f64::max);
        let mut exits = Self {
            boundary,
            ways,
            reach,
            longest_reach,
            given: false,
        };
        exits.given = exits.ways.iter().any(|way| {
            let reach = exits.reach[way.owner];
            exits
                .boundary
                .near(way.a, way.b, reach)
                .any(|s| segment_distance(way.a, way.b, s.a, s.b) <= reach)
        });
        exits
    }

    /// Whether `p` is within 1 m of a way out.
    pub(crate) fn at_exit(&self, p: Coord<f64>) -> bool {
        self.boundary.near(p, p, AT_EXIT).any(|s| {
            let Some((from, to)) = stretch_within(s.a, s.b, p, p, AT_EXIT) else {
                return false;
            };
            if !self.given {
                return s.owner % 2 == 0;
            }
            let (a, b) = (lerp(s.a, s.b, from), lerp(s.a, s.b, to));
            self.ways
                .near(a, b, self.longest_reach)
                .any(|way| segment_distance(a, b, way.a, way.b) <= self.reach[way.owner])
        })
    }

    /// Whether `p` is within 1 m of the site's boundary, holes included.
    pub(crate) fn at_boundary(&self, p: Coord<f64>) -> bool {
        self.boundary.within(p, AT_EXIT)
    }
}
