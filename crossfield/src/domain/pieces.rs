//! Smooth pieces of the boundary, from corner to corner.

use super::ring::Ring;
use super::Domain;

/// A smooth piece of the boundary: the edges between two corners, or a whole
/// ring that has none.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Piece {
    /// Its ring, 0 for the exterior.
    pub ring: usize,
    /// Its edges, numbered as in the input ring, in walking order: the domain
    /// on the left.
    pub edges: Vec<usize>,
    /// Whether it is a whole ring without corners.
    pub closed: bool,
    /// Sum of the lengths of its edges, metres.
    pub length: f64,
    /// Sum of the turns at its inner vertices (all of them if it is closed),
    /// radians, positive to the left.
    pub turn: f64,
}

impl Ring {
    /// The cleaned edges of each piece, in walking order from corner to
    /// corner, beginning with the first corner.
    pub(crate) fn pieces(&self) -> Vec<Vec<usize>> {
        let count = self.len();
        let first = self.corner.iter().position(|&corner| corner).unwrap_or(0);
        let mut pieces: Vec<Vec<usize>> = Vec::new();
        for step in 0..count {
            let k = (first + step) % count;
            match pieces.last_mut() {
                Some(piece) if !self.corner[k] => piece.push(k),
                _ => pieces.push(vec![k]),
            }
        }
        pieces
    }

    pub(crate) fn piece_count(&self) -> usize {
        self.corner.iter().filter(|&&corner| corner).count().max(1)
    }

    /// For each cleaned edge the piece it is part of.
    pub(crate) fn piece_of_edges(&self) -> Vec<usize> {
        let mut of = vec![0; self.len()];
        for (index, piece) in self.pieces().iter().enumerate() {
            piece.iter().for_each(|&k| of[k] = index);
        }
        of
    }
}

impl Domain {
    /// The smooth pieces of the boundary, ring by ring in walking order (the
    /// domain on the left), in each ring beginning with its first
    /// [corner](Domain::corners).
    ///
    /// ```
    /// use crossfield::{geo_types::polygon, Domain, DomainOptions};
    ///
    /// // The vertex at (60, 20) turns by 5.7 degrees only.
    /// let site = polygon![(x: 0., y: 0.), (x: 58., y: 0.), (x: 60., y: 20.), (x: 60., y: 40.), (x: 0., y: 40.)];
    /// let pieces = Domain::new(&site, &DomainOptions::default())?.pieces();
    /// let edges: Vec<&[usize]> = pieces.iter().map(|p| &p.edges[..]).collect();
    /// assert_eq!(edges, [&[0][..], &[1, 2], &[3], &[4]]);
    /// # Ok::<(), crossfield::FieldError>(())
    /// ```
    #[must_use]
    pub fn pieces(&self) -> Vec<Piece> {
        let mut all = Vec::new();
        for (index, ring) in self.inner.rings.iter().enumerate() {
            let closed = !ring.corner.contains(&true);
            for edges in ring.pieces() {
                let inner = if closed { &edges[..] } else { &edges[1..] };
                let length = |&k: &usize| {
                    let (a, b) = ring.edge(k);
                    (b - a).norm()
                };
                all.push(Piece {
                    ring: index,
                    closed,
                    length: edges.iter().map(length).sum(),
                    turn: inner.iter().map(|&k| ring.turn[k]).sum(),
                    edges: edges.iter().map(|&k| ring.input_edge[k] as usize).collect(),
                });
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DomainOptions;
    use geo_types::{polygon, LineString, Polygon};
    use std::f64::consts::{FRAC_PI_2, TAU};

    #[test]
    fn pieces_run_from_corner_to_corner() {
        // A square with a rounded corner in the north-east and a round hole.
        let arc = (0..=9).map(|k| {
            let angle = FRAC_PI_2 * f64::from(k) / 9.0;
            (60.0 + 40.0 * angle.cos(), 60.0 + 40.0 * angle.sin())
        });
        let outer: Vec<(f64, f64)> = [(100.0, 0.0)]
            .into_iter()
            .chain(arc)
            .chain([(0.0, 100.0), (0.0, 0.0)])
            .collect();
        let hole: Vec<(f64, f64)> = (0..40)
            .map(|k| {
                let angle = TAU * f64::from(k) / 40.0;
                (40.0 + 10.0 * angle.cos(), 40.0 + 10.0 * angle.sin())
            })
            .collect();
        let shape = Polygon::new(LineString::from(outer), vec![LineString::from(hole)]);
        let pieces = Domain::new(&shape, &DomainOptions::default())
            .expect("valid")
            .pieces();
        assert_eq!(pieces.len(), 4);
        // East side, arc and north side are one piece, which turns by 90 degrees.
        assert_eq!(pieces[0].edges, (0..=10).collect::<Vec<_>>());
        assert!((pieces[0].turn - FRAC_PI_2).abs() < 1e-9);
        let hole = &pieces[3];
        assert!(hole.closed && hole.ring == 1 && hole.edges.len() == 40);
        assert!((hole.turn + TAU).abs() < 1e-9);
        let total: f64 = pieces.iter().map(|p| p.length).sum();
        let chord = |radius: f64, angle: f64| 2.0 * radius * (angle / 2.0).sin();
        let wanted = 100.0
            + 100.0
            + 60.0
            + 60.0
            + 9.0 * chord(40.0, FRAC_PI_2 / 9.0)
            + 40.0 * chord(10.0, TAU / 40.0);
        assert!((total - wanted).abs() < 1e-9);
    }

    #[test]
    fn a_square_is_four_pieces() {
        let square = polygon![(x: 0., y: 0.), (x: 1., y: 0.), (x: 1., y: 1.), (x: 0., y: 1.)];
        let domain = Domain::new(&square, &DomainOptions::default()).expect("valid");
        assert!(domain
            .pieces()
            .iter()
            .all(|p| !p.closed && p.turn == 0.0 && p.length == 1.0));
        assert_eq!(domain.pieces().len(), 4);
    }
}
