//! One polygon of the file admitted: checked, cleaned, wound, taken apart.

use geo_types::{Coord, Polygon};

use super::boolean::{difference_noded, odd, oriented, total_area};
use super::contact::{contacts, inside, nearest, Contacts, Edge, Touch};
use super::fault::{At, Place, SiteError};
use super::measure::{bounds, edges};
use super::ring::{Cleaned, Ring, ROUNDING};
use super::warning::{Warning, WarningKind};
use crate::error::Result;
use crate::io::frame::Frame;

/// Makes valid polygons in local metres of one polygon of the file: one, unless
/// its rings touch so as to cut it. Exteriors are counter-clockwise and holes
/// clockwise; rings do not cross; a hole may touch another ring in a vertex of
/// both, never along an edge.
///
/// # Errors
///
/// What cleaning cannot mend, with ring and vertex.
pub(crate) fn admit(
    place: &Place,
    raw: &[Vec<Coord<f64>>],
    frame: &Frame,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Polygon<f64>>> {
    let mut rings = Vec::with_capacity(raw.len());
    let mut numbers = Vec::with_capacity(raw.len());
    for (k, positions) in raw.iter().enumerate() {
        let place = place.ring(k);
        let mut ring = take(&place, positions, frame, warnings)?;
        report(&place, &ring.clean(), warnings);
        if ring.points.len() >= 3 {
            rings.push(ring);
            numbers.push(k);
        } else if k == 0 {
            return Err(SiteError::ZeroArea { place }.into());
        }
        // A hole without area takes nothing away: cleaning has cut it off.
    }
    let admission = Admission {
        place,
        rings,
        numbers,
        frame,
    };
    admission.polygons(warnings)
}

/// The positions of a ring in local metres, closing position dropped.
fn take(
    place: &Place,
    positions: &[Coord<f64>],
    frame: &Frame,
    warnings: &mut Vec<Warning>,
) -> Result<Ring> {
    let closed = positions.len() > 1 && positions.first() == positions.last();
    let open = &positions[..positions.len() - usize::from(closed)];
    if open.len() < 3 {
        return Err(SiteError::TooFewVertices {
            place: place.clone(),
            found: positions.len(),
        }
        .into());
    }
    if !closed {
        warnings.push(Warning::new(
            WarningKind::UnclosedRing,
            Some(place.feature),
            format!("{place}: the last position differs from the first; the ring was closed"),
        ));
    }
    Ok(Ring {
        points: open.iter().map(|&c| frame.to_local(c)).collect(),
        source: (0..open.len()).collect(),
    })
}

/// Says what cleaning a ring or line has dropped.
pub(crate) fn report(place: &Place, cleaned: &Cleaned, warnings: &mut Vec<Warning>) {
    let sorts = [
        (
            WarningKind::DuplicateVertices,
            cleaned.duplicates,
            "repeated vertices",
        ),
        (
            WarningKind::CollinearVertices,
            cleaned.collinear,
            "collinear vertices",
        ),
        (WarningKind::Spikes, cleaned.spikes, "spikes"),
    ];
    for (kind, count, what) in sorts {
        if count > 0 {
            warnings.push(Warning::new(
                kind,
                Some(place.feature),
                format!("{place}: {count} {what} dropped"),
            ));
        }
    }
}

/// A polygon under examination.
struct Admission<'a> {
    place: &'a Place,
    /// Cleaned rings, exterior first.
    rings: Vec<Ring>,
    /// The number of each in the file.
    numbers: Vec<usize>,
    frame: &'a Frame,
}

impl Admission<'_> {
    fn polygons(mut self, warnings: &mut Vec<Warning>) -> Result<Vec<Polygon<f64>>> {
        let extent = self.rings[0].extent();
        let tolerance = ROUNDING * extent;
        let found = contacts(&self.rings, tolerance);
        self.refuse_crossing(&found)?;
        for (r, ring) in self.rings.iter().enumerate() {
            // Thinner than rounding over its whole length; a ring that runs over
            // itself is told apart below.
            let empty = ring.doubled_area().abs() / 2.0 <= tolerance * ring.extent();
            if empty && !found.touches.iter().any(|t| t.edge.0 == r) {
                let place = self.place(r);
                return Err(SiteError::ZeroArea { place }.into());
            }
        }
        self.refuse_misplaced_holes(&found)?;
        if found.touches.is_empty() {
            let mut rings = self.rings.into_iter().map(|ring| ring.points);
            let exterior = rings.next().unwrap_or_default();
            return Ok(vec![oriented(exterior, rings.collect())]);
        }
        let touch = found.touches[0];
        let at = self.at(self.vertex(touch.vertex));
        warnings.push(Warning::new(
            WarningKind::TouchingRings,
            Some(self.place.feature),
            format!(
                "{}: touches ring {} at {at}; they were taken apart there",
                self.named(touch.vertex),
                self.numbers[touch.edge.0]
            ),
        ));
        self.node(&found.touches, tolerance);
        self.taken_apart(&found.touches, tolerance * extent)
    }

    /// Crossings are beyond mending: what the author meant is not known.
    fn refuse_crossing(&self, found: &Contacts) -> Result<()> {
        let Some(crossing) = found.crossing else {
            return Ok(());
        };
        let (a, b) = (crossing.first, crossing.second);
        let at = self.at(crossing.at);
        Err(if a.0 == b.0 {
            SiteError::SelfCrossing {
                place: self.named(a),
                first: self.source(a),
                second: self.source(b),
                at,
            }
        } else if a.0 == 0 {
            let place = self.named(b);
            SiteError::HoleCrossesBoundary { place, at }
        } else {
            SiteError::OverlappingHoles {
                place: self.named(b),
                other: self.numbers[a.0],
                at,
            }
        }
        .into())
    }

    /// Holes outside the exterior or inside one another. Rings do not cross
    /// here, so one point of a hole that lies on no other ring decides.
    fn refuse_misplaced_holes(&self, found: &Contacts) -> Result<()> {
        let boxes: Vec<_> = self.rings.iter().map(|r| bounds(&r.points)).collect();
        for hole in 1..self.rings.len() {
            let Some((edge, p)) = self.free_point(hole, &found.touches) else {
                continue;
            };
            let at = self.at(p);
            if !inside(&self.rings[0].points, p) {
                let place = self.named(edge);
                return Err(SiteError::HoleOutside { place, at }.into());
            }
            for (other, (low, high)) in boxes.iter().enumerate().skip(1) {
                let within = low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
                if other != hole && within && inside(&self.rings[other].points, p) {
                    return Err(SiteError::OverlappingHoles {
                        place: self.named(edge),
                        other: self.numbers[other],
                        at,
                    }
                    .into());
                }
            }
        }
        Ok(())
    }

    /// A point of a ring that no other ring touches: a vertex, or the middle of
    /// an edge; none where the ring runs along others all the way.
    fn free_point(&self, ring: usize, touches: &[Touch]) -> Option<(Edge, Coord<f64>)> {
        let points = &self.rings[ring].points;
        let mut taken = vec![false; points.len()];
        for touch in touches {
            if touch.vertex.0 == ring {
                taken[touch.vertex.1] = true;
            }
            if touch.edge.0 == ring {
                // Both its ends, to be safe: the touch may be at either.
                taken[touch.edge.1] = true;
                taken[(touch.edge.1 + 1) % points.len()] = true;
            }
        }
        let free = taken.iter().position(|&taken| !taken);
        if let Some(k) = free {
            return Some(((ring, k), points[k]));
        }
        // Middles of edges that lie on no edge of another ring.
        let on_other = |p: Coord<f64>| {
            let extent = self.rings[0].extent();
            self.rings.iter().enumerate().any(|(r, other)| {
                r != ring
                    && edges(&other.points).any(|(a, b)| {
                        let d = p - nearest(p, a, b).1;
                        d.x.hypot(d.y) <= 10.0 * ROUNDING * extent
                    })
            })
        };
        edges(points).enumerate().find_map(|(k, (a, b))| {
            let middle = (a + b) / 2.0;
            (!on_other(middle)).then_some(((ring, k), middle))
        })
    }

    /// Gives touching rings common vertices, to the bit: vertices that nearly
    /// coincide are made one, and one on another ring's edge is put into it.
    fn node(&mut self, touches: &[Touch], tolerance: f64) {
        let mut inserted: Vec<(Edge, f64, Coord<f64>)> = Vec::new();
        for touch in touches {
            let p = self.vertex(touch.vertex);
            let n = self.rings[touch.edge.0].points.len();
            let ends = [touch.edge, (touch.edge.0, (touch.edge.1 + 1) % n)];
            let near = ends.into_iter().find(|&end| {
                let d = self.vertex(end) - p;
                d.x.hypot(d.y) <= tolerance
            });
            if let Some(end) = near {
                // The earlier vertex of the file is the one that stays.
                let (keep, move_) = (end.min(touch.vertex), end.max(touch.vertex));
                self.rings[move_.0].points[move_.1] = self.vertex(keep);
            } else {
                let (a, b) = (self.vertex(ends[0]), self.vertex(ends[1]));
                inserted.push((touch.edge, nearest(p, a, b).0, p));
            }
        }
        // From the last to the first, so that positions stay true.
        inserted.sort_unstable_by(|a, b| b.0.cmp(&a.0).then(b.1.total_cmp(&a.1)));
        for ((r, k), _, p) in inserted {
            let source = self.rings[r].source[k];
            self.rings[r].points.insert(k + 1, p);
            self.rings[r].source.insert(k + 1, source);
        }
        for ring in &mut self.rings {
            ring.points.dedup();
        }
    }

    /// The polygons that touching rings enclose.
    ///
    /// A ring that touches itself without crossing encloses its signed area; one that
    /// crosses at a vertex or covers ground twice encloses less or more of it
    /// an odd number of times. And holes that only touch take their whole area
    /// away. So areas tell what was meant from what was not.
    fn taken_apart(&self, touches: &[Touch], slack: f64) -> Result<Vec<Polygon<f64>>> {
        let mut whole = Vec::new();
        let mut holes = Vec::new();
        let mut expected = 0.0;
        for (r, ring) in self.rings.iter().enumerate() {
            let own = ring.doubled_area().abs() / 2.0;
            let parts = odd(&ring.points);
            if (total_area(&parts) - own).abs() > slack {
                let touch = touches
                    .iter()
                    .find(|t| t.vertex.0 == r && t.edge.0 == r)
                    .unwrap_or(&touches[0]);
                return Err(SiteError::SelfOverlapping {
                    place: self.named(touch.vertex),
                    at: self.at(self.vertex(touch.vertex)),
                }
                .into());
            }
            if r == 0 {
                expected += own;
                whole = parts;
            } else {
                expected -= own;
                holes.extend(parts);
            }
        }
        let result = if holes.is_empty() {
            whole
        } else {
            difference_noded(&whole, &holes)
        };
        if expected.abs() <= slack && total_area(&result) <= slack {
            let place = self.place.clone();
            return Err(SiteError::HolesFillAll { place }.into());
        }
        if (total_area(&result) - expected).abs() > slack {
            let touch = touches[0];
            return Err(SiteError::UnclearTouch {
                place: self.named(touch.vertex),
                at: self.at(self.vertex(touch.vertex)),
            }
            .into());
        }
        Ok(result)
    }

    fn vertex(&self, (r, k): Edge) -> Coord<f64> {
        // Noding may have shortened a ring that is only named in a message.
        let points = &self.rings[r].points;
        points[k.min(points.len() - 1)]
    }

    fn source(&self, (r, k): Edge) -> usize {
        let source = &self.rings[r].source;
        source[k.min(source.len() - 1)]
    }

    fn place(&self, ring: usize) -> Place {
        self.place.ring(self.numbers[ring])
    }

    fn named(&self, at: Edge) -> Place {
        self.place(at.0).vertex(self.source(at))
    }

    fn at(&self, local: Coord<f64>) -> At {
        At(self.frame.to_source(local))
    }
}

/// Parts joined where they overlap or share an edge; the second value says
/// whether any ground was covered twice. Parts that do not meet stay as they are.
pub(crate) fn join(parts: Vec<Polygon<f64>>) -> (Vec<Polygon<f64>>, bool, bool) {
    if parts.len() < 2 {
        return (parts, false, false);
    }
    let joined = super::boolean::union(&parts);
    let (sum, whole) = (total_area(&parts), total_area(&joined));
    let overlap = sum - whole > ROUNDING * sum * 10.0;
    if overlap || joined.len() != parts.len() {
        (joined, true, overlap)
    } else {
        (parts, false, false)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;
    use crate::site::measure::rings;
    use crate::site::measure::tests::{ring, square};

    fn admitted(raw: &[Vec<Coord<f64>>]) -> Result<(Vec<Polygon<f64>>, Vec<WarningKind>)> {
        let mut warnings = Vec::new();
        let frame = Frame::metres(Coord { x: 0.0, y: 0.0 });
        let place = Place::feature(0, None);
        let polygons = admit(&place, raw, &frame, &mut warnings)?;
        Ok((polygons, warnings.into_iter().map(|w| w.kind).collect()))
    }

    fn code(raw: &[Vec<Coord<f64>>]) -> &'static str {
        admitted(raw).unwrap_err().code()
    }

    #[test]
    fn a_hole_on_an_edge_becomes_a_notch() {
        let (polygons, kinds) =
            admitted(&[square(0.0, 0.0, 100.0), square(40.0, 0.0, 20.0)]).unwrap();
        assert_eq!(polygons.len(), 1);
        assert_eq!(polygons[0].interiors().len(), 0);
        assert!((total_area(&polygons) - 9600.0).abs() < 1e-6);
        assert_eq!(kinds, [WarningKind::TouchingRings]);
    }

    #[test]
    fn a_hole_that_touches_in_a_vertex_stays_a_hole_with_a_common_vertex() {
        let hole = ring(&[(50.0, 0.0), (60.0, 20.0), (40.0, 20.0)]);
        let (polygons, _) = admitted(&[square(0.0, 0.0, 100.0), hole]).unwrap();
        assert!((total_area(&polygons) - 9800.0).abs() < 1e-6);
        let at = Coord { x: 50.0, y: 0.0 };
        let found = rings(&polygons).filter(|ring| ring.0.contains(&at)).count();
        assert_eq!(found, polygons[0].interiors().len() + 1);
    }

    #[test]
    fn a_hole_that_reaches_from_side_to_side_cuts_the_site_in_two() {
        let hole = ring(&[(40.0, 0.0), (60.0, 0.0), (60.0, 100.0), (40.0, 100.0)]);
        let (polygons, _) = admitted(&[square(0.0, 0.0, 100.0), hole]).unwrap();
        assert_eq!(polygons.len(), 2);
        assert!((total_area(&polygons) - 8000.0).abs() < 1e-6);
    }

    #[test]
    fn a_keyhole_ring_becomes_a_ring_with_a_hole() {
        let keyhole = ring(&[
            (0.0, 0.0),
            (50.0, 0.0),
            (50.0, 40.0),
            (40.0, 40.0),
            (40.0, 60.0),
            (60.0, 60.0),
            (60.0, 40.0),
            (50.0, 40.0),
            (50.0, 0.0),
            (100.0, 0.0),
            (100.0, 100.0),
            (0.0, 100.0),
        ]);
        let (polygons, _) = admitted(&[keyhole]).unwrap();
        assert_eq!((polygons.len(), polygons[0].interiors().len()), (1, 1));
        assert!((total_area(&polygons) - 9600.0).abs() < 1e-6);
    }

    #[test]
    fn crossing_at_a_vertex_and_covering_twice_are_errors() {
        let bow_tie = ring(&[
            (0.0, 0.0),
            (50.0, 50.0),
            (100.0, 0.0),
            (100.0, 90.0),
            (50.0, 50.0),
            (0.0, 90.0),
        ]);
        assert!(admitted(&[bow_tie]).is_ok(), "this one only touches");
        let bow_tie = ring(&[
            (0.0, 0.0),
            (50.0, 50.0),
            (100.0, 90.0),
            (100.0, 0.0),
            (50.0, 50.0),
            (0.0, 90.0),
        ]);
        assert_eq!(code(&[bow_tie]), "self-overlapping-ring");
        let mut twice = square(0.0, 0.0, 100.0);
        twice.extend(square(0.0, 0.0, 100.0).into_iter().skip(1));
        assert_eq!(code(&[twice]), "self-overlapping-ring");
    }

    #[test]
    fn holes_in_the_wrong_place_are_errors() {
        let outer = || square(0.0, 0.0, 100.0);
        assert_eq!(code(&[outer(), square(200.0, 0.0, 10.0)]), "hole-outside");
        assert_eq!(code(&[outer(), square(100.0, 0.0, 10.0)]), "hole-outside");
        assert_eq!(
            code(&[outer(), square(90.0, 50.0, 30.0)]),
            "hole-crosses-boundary"
        );
        let nested = [outer(), square(10.0, 10.0, 50.0), square(20.0, 20.0, 10.0)];
        assert_eq!(code(&nested), "overlapping-holes");
        let crossing = [outer(), square(10.0, 10.0, 30.0), square(30.0, 30.0, 30.0)];
        assert_eq!(code(&crossing), "overlapping-holes");
        assert_eq!(code(&[outer(), outer()]), "holes-fill-all");
        let same = [outer(), square(10.0, 10.0, 30.0), square(10.0, 10.0, 30.0)];
        assert_eq!(code(&same), "unclear-touch");
    }
}
