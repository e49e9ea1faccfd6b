//! The boundary in smooth pieces, each of which carries one constant of the
//! boundary value problem.
//!
//! A piece is cut at corners. What lies between two corners is cut further
//! until the directions of the edges of each piece span no more than an
//! allowed angle: on a straight piece the crosses of an H-field follow the
//! boundary exactly, on a bent one only about as well as the piece is straight.

use crate::domain::{Domain, Ring};
use crate::plane::{left, wedge, V2};
use crate::FieldError;

/// A run of boundary edges that share one constant of the boundary value
/// problem.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BoundaryPiece {
    /// Its ring, 0 for the exterior.
    pub ring: usize,
    /// Its first edge in the input ring, walking with the domain on the left;
    /// edge `i` joins vertices `i` and `i + 1`.
    pub first_edge: usize,
    /// Number of its edges, those of no length not counted.
    pub edges: usize,
    /// Length, metres.
    pub length: f64,
    /// Angle between its two most different edges, radians; 0 if straight.
    pub turn: f64,
    /// Integral of the outward normal along the piece, metres: length times
    /// the mean normal.
    pub(crate) normal: (f64, f64),
}

/// Pieces, and which one each edge of each (cleaned) ring belongs to.
#[derive(Clone, Debug)]
pub(crate) struct Pieces {
    pub(crate) all: Vec<BoundaryPiece>,
    of_edge: Vec<Vec<u32>>,
}

impl Pieces {
    /// Cuts the boundary of `domain` at its corners, and so that no piece
    /// spans more than `max_turn` radians.
    pub(crate) fn cut(domain: &Domain, max_turn: f64, most: usize) -> Result<Self, FieldError> {
        let mut pieces = Self {
            all: Vec::new(),
            of_edge: Vec::new(),
        };
        for (index, ring) in domain.inner.rings.iter().enumerate() {
            pieces.of_edge.push(vec![0; ring.len()]);
            for run in runs(ring, max_turn) {
                pieces.push(index, ring, &run);
            }
        }
        if pieces.all.len() > most {
            return Err(FieldError::option(
                "max_pieces",
                format!(
                    "is {most}; the boundary has {} smooth pieces, allow as many, \
                     raise `max_turn_deg` or simplify the boundary",
                    pieces.all.len()
                ),
            ));
        }
        Ok(pieces)
    }

    fn push(&mut self, index: usize, ring: &Ring, run: &[usize]) {
        let mut normal = V2::zeros();
        let mut length = 0.0;
        for &edge in run {
            let (a, b) = ring.edge(edge);
            normal -= left(b - a);
            length += (b - a).norm();
            self.of_edge[index][edge] = self.all.len() as u32;
        }
        self.all.push(BoundaryPiece {
            ring: index,
            first_edge: ring.input_edge[run[0]] as usize,
            edges: run.len(),
            length,
            turn: span(&headings(ring, run)),
            normal: (normal.x, normal.y),
        });
    }

    /// The piece that an edge of a cleaned ring belongs to.
    pub(crate) fn of(&self, ring: u32, edge: u32) -> usize {
        self.of_edge[ring as usize][edge as usize] as usize
    }

    /// Number of pieces.
    pub(crate) fn len(&self) -> usize {
        self.all.len()
    }

    /// Length of the whole boundary.
    pub(crate) fn perimeter(&self) -> f64 {
        self.all.iter().map(|piece| piece.length).sum()
    }
}

/// The edges of each piece of a ring, in the order of the ring.
fn runs(ring: &Ring, max_turn: f64) -> Vec<Vec<usize>> {
    let count = ring.len();
    let corners: Vec<usize> = (0..count).filter(|&k| ring.corner[k]).collect();
    // A ring without a corner is opened where it turns most.
    let cuts = if corners.is_empty() {
        let sharpest = (0..count).fold(0, |best, k| {
            // Equal up to rounding: the first.
            if ring.turn[k].abs() > ring.turn[best].abs() + 1e-9 {
                k
            } else {
                best
            }
        });
        vec![sharpest]
    } else {
        corners
    };
    let mut runs = Vec::new();
    for (k, &from) in cuts.iter().enumerate() {
        let to = cuts.get(k + 1).map_or(cuts[0] + count, |&to| to);
        let run: Vec<usize> = (from..to).map(|edge| edge % count).collect();
        bisect(ring, run, max_turn, &mut runs);
    }
    runs
}

/// Halves a run until each part spans at most `max_turn`.
///
/// The cut leaves the smaller spans on both sides; among equal cuts it is the
/// one nearest to the middle, and the first of these. Walked backwards the run
/// is cut alike but for that, so that mirror images have mirrored pieces.
fn bisect(ring: &Ring, run: Vec<usize>, max_turn: f64, out: &mut Vec<Vec<usize>>) {
    let mut open = vec![run];
    while let Some(run) = open.pop() {
        let headings = headings(ring, &run);
        // Headings are summed up turn by turn: leave room for rounding.
        if run.len() < 2 || span(&headings) <= max_turn + 1e-9 {
            out.push(run);
            continue;
        }
        let forwards = running_spans(headings.iter());
        let backwards = running_spans(headings.iter().rev());
        let count = run.len();
        let mut along = vec![0.0];
        for &edge in &run {
            let (a, b) = ring.edge(edge);
            along.push(along[along.len() - 1] + (b - a).norm());
        }
        let cost = |k: usize| {
            let worse = forwards[k - 1].max(backwards[count - k - 1]);
            let off = (2.0 * along[k] - along[count]).abs() / along[count];
            (worse, off)
        };
        let best = (2..count).fold(1, |best, k| {
            let ((a, off_a), (b, off_b)) = (cost(k), cost(best));
            // Equal up to rounding counts as equal.
            let better = a < b - 1e-9 || (a <= b + 1e-9 && off_a < off_b - 1e-9);
            if better {
                k
            } else {
                best
            }
        });
        let (first, second) = run.split_at(best);
        // The stack gives the first half back first.
        open.push(second.to_vec());
        open.push(first.to_vec());
    }
}

/// Direction of each edge of a run, radians from the first, unwrapped.
fn headings(ring: &Ring, run: &[usize]) -> Vec<f64> {
    let mut heading = 0.0;
    run.iter()
        .enumerate()
        .map(|(k, &edge)| {
            if k > 0 {
                let (before, after) = (ring.direction(run[k - 1]), ring.direction(edge));
                heading += wedge(before, after).atan2(before.dot(&after));
            }
            heading
        })
        .collect()
}

/// Difference of the largest and the smallest heading.
fn span(headings: &[f64]) -> f64 {
    running_spans(headings.iter())
        .last()
        .copied()
        .unwrap_or(0.0)
}

/// The span of each beginning of a sequence of headings.
fn running_spans<'a>(headings: impl Iterator<Item = &'a f64>) -> Vec<f64> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    headings
        .map(|&heading| {
            (low, high) = (heading.min(low), heading.max(high));
            high - low
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DomainOptions;
    use geo_types::{polygon, Polygon};

    fn cut(shape: &Polygon<f64>, max_turn_deg: f64) -> Pieces {
        let domain = Domain::new(shape, &DomainOptions::default()).expect("valid");
        Pieces::cut(&domain, max_turn_deg.to_radians(), 100).expect("few pieces")
    }

    fn disc(count: usize) -> Polygon<f64> {
        let step = std::f64::consts::TAU / count as f64;
        let ring: Vec<(f64, f64)> = (0..count)
            .map(|k| (k as f64 * step).sin_cos())
            .map(|(y, x)| (50.0 * x, 50.0 * y))
            .collect();
        Polygon::new(ring.into(), vec![])
    }

    #[test]
    fn straight_sides_are_pieces_whatever_lies_on_them() {
        let shape = polygon![(x: 0., y: 0.), (x: 3., y: 0.), (x: 9., y: 0.), (x: 9., y: 6.),
            (x: 0., y: 6.)];
        let pieces = cut(&shape, 15.0);
        assert_eq!(pieces.len(), 4);
        assert_eq!((pieces.all[0].first_edge, pieces.all[0].edges), (0, 2));
        assert_eq!(pieces.all[0].length, 9.0);
        assert_eq!(pieces.all[0].normal, (0.0, -9.0));
        assert_eq!(pieces.all[1].normal, (6.0, 0.0));
        assert_eq!(pieces.perimeter(), 30.0);
        assert_eq!((pieces.of(0, 1), pieces.of(0, 4)), (0, 3));
    }

    #[test]
    fn a_disc_is_cut_until_each_piece_spans_little() {
        // 72 edges, 5 degrees apart: halved to 36, 18, 9 and 5 or 4 edges.
        let pieces = cut(&disc(72), 22.0);
        assert_eq!(pieces.len(), 16);
        for piece in &pieces.all {
            assert!(piece.edges == 4 || piece.edges == 5);
            let turn = 5.0 * (piece.edges - 1) as f64;
            assert!((piece.turn.to_degrees() - turn).abs() < 1e-9);
        }
        assert_eq!(pieces.all.iter().map(|p| p.edges).sum::<usize>(), 72);
    }

    #[test]
    fn too_many_pieces_are_refused() {
        let domain = Domain::new(&disc(72), &DomainOptions::default()).expect("valid");
        let error = Pieces::cut(&domain, 0.01, 71).expect_err("72 pieces");
        assert!(error.to_string().contains("72 smooth pieces"));
        assert!(Pieces::cut(&domain, 0.01, 72).is_ok());
    }
}
