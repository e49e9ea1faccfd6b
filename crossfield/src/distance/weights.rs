//! The weight function of a D-field along the boundary.

use super::{DistanceField, Weighting};
use crate::domain::{Domain, Ring};
use crate::FieldError;

/// Weight along one edge, linear between its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EdgeWeight {
    pub(super) start: f64,
    pub(super) end: f64,
}

impl EdgeWeight {
    fn even(weight: f64) -> Self {
        Self {
            start: weight,
            end: weight,
        }
    }

    /// The mean over the edge.
    pub(super) fn mean(self) -> f64 {
        (self.start + self.end) / 2.0
    }
}

impl DistanceField {
    /// Weights by cleaned ring and edge.
    pub(super) fn edge_weights(&self, domain: &Domain) -> Result<Vec<Vec<EdgeWeight>>, FieldError> {
        let rings = &domain.inner.rings;
        if !self.weights.is_empty() && self.weights.len() != rings.len() {
            return Err(FieldError::option(
                "weights",
                format!(
                    "has {} rings, the domain has {}; give one list a ring, or none",
                    self.weights.len(),
                    rings.len()
                ),
            ));
        }
        let given = |index: usize| self.weights.get(index).map_or(&[][..], Vec::as_slice);
        rings
            .iter()
            .enumerate()
            .map(|(index, ring)| self.ring_weights(given(index), index, ring))
            .collect()
    }

    fn ring_weights(
        &self,
        given: &[f64],
        index: usize,
        ring: &Ring,
    ) -> Result<Vec<EdgeWeight>, FieldError> {
        if given.is_empty() {
            return Ok(vec![EdgeWeight::even(1.0); ring.len()]);
        }
        let (wanted, word) = match self.weighting {
            Weighting::Edges => (ring.input_edges, "edge"),
            Weighting::Vertices => (ring.input_edges, "vertex"),
            Weighting::Pieces => (ring.piece_count(), "piece"),
        };
        if given.len() != wanted {
            return Err(FieldError::option(
                "weights",
                format!(
                    "has {} numbers for ring {index}; give one for each {word}, {wanted} in all",
                    given.len(),
                ),
            ));
        }
        if let Some(bad) = given.iter().position(|w| !(1e-6..=1e6).contains(w)) {
            return Err(FieldError::option(
                "weights",
                format!(
                    "is {} for {word} {bad} of ring {index}; give 1e-6 to 1e6",
                    given[bad]
                ),
            ));
        }
        Ok(match self.weighting {
            Weighting::Edges => ring
                .input_edge
                .iter()
                .map(|&k| EdgeWeight::even(given[k as usize]))
                .collect(),
            Weighting::Vertices => (0..ring.len())
                .map(|k| EdgeWeight {
                    start: given[ring.input_vertex[k] as usize],
                    end: given[ring.input_vertex[ring.next(k)] as usize],
                })
                .collect(),
            Weighting::Pieces => ring
                .piece_of_edges()
                .into_iter()
                .map(|piece| EdgeWeight::even(given[piece]))
                .collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DomainOptions;
    use geo_types::polygon;

    #[test]
    fn weights_follow_edges_vertices_and_pieces() {
        // Clockwise, so that walking order is the reverse of the input's; the
        // vertex (9, 4) is no corner.
        let shape = polygon![(x: 0., y: 0.), (x: 0., y: 9.), (x: 8., y: 9.), (x: 9., y: 4.), (x: 9., y: 0.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let ring = &domain.inner.rings[0];
        assert_eq!(ring.piece_count(), 4);
        let of = |weighting, numbers: &[f64]| {
            let design = DistanceField {
                weights: vec![numbers.to_vec()],
                weighting,
                ..DistanceField::default()
            };
            design.edge_weights(&domain).map(|mut w| w.remove(0))
        };
        let edges = of(Weighting::Edges, &[1., 2., 3., 4., 5.]).expect("fits");
        let vertices = of(Weighting::Vertices, &[1., 2., 3., 4., 5.]).expect("fits");
        for k in 0..5 {
            let (a, b) = ring.edge(k);
            let input = |p: crate::plane::V2| {
                let at = p + domain.inner.frame.origin;
                shape.exterior().0[..5]
                    .iter()
                    .position(|c| (c.x - at.x).hypot(c.y - at.y) < 1e-9)
                    .expect("a vertex") as f64
            };
            assert_eq!(
                (vertices[k].start, vertices[k].end),
                (input(a) + 1.0, input(b) + 1.0)
            );
            // Walked backwards, edge i starts where it ends in the input.
            assert_eq!(edges[k].mean(), input(b) + 1.0);
        }
        let pieces = of(Weighting::Pieces, &[1., 2., 3., 4.]).expect("fits");
        let mut of_piece: Vec<f64> = pieces.iter().map(|w| w.mean()).collect();
        of_piece.dedup();
        assert!(of_piece.len() == 4 || of_piece.first() == of_piece.last());
        assert!(of(Weighting::Pieces, &[1.0; 5]).is_err());
        assert!(of(Weighting::Vertices, &[1.0; 4]).is_err());
    }
}
