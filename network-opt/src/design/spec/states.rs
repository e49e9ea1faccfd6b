//! What a specification says of each edge beforehand.

use super::{Feature, Rim, Specification};
use crate::design::problem::EdgeState;
use crate::design::tessellation::Tessellation;
use crate::error::DesignError;

impl Specification {
    /// What is known of each edge: the boundary, streets that exist, what is too
    /// close to them, obstacles and routes.
    pub(super) fn states(
        &self,
        mesh: &Tessellation,
        rim: &[bool],
    ) -> Result<Vec<EdgeState>, DesignError> {
        let bad = |what: String| Err(DesignError::BadProblem { what });
        let on_rim = match self.rim {
            Rim::Given => EdgeState::Given,
            Rim::Open => EdgeState::Open,
            Rim::Closed => EdgeState::Closed,
        };
        let mut states: Vec<EdgeState> = rim
            .iter()
            .map(|&rim| if rim { on_rim } else { EdgeState::Open })
            .collect();
        self.given
            .iter()
            .for_each(|&e| states[e] = EdgeState::Given);
        let close = |states: &mut Vec<EdgeState>, e: usize| {
            if states[e] == EdgeState::Open {
                states[e] = EdgeState::Closed;
            }
        };
        if self.too_close == Feature::Forbidden {
            for [a, b] in mesh.opposite_edges() {
                for (given, other) in [(a, b), (b, a)] {
                    if states[given] == EdgeState::Given {
                        close(&mut states, other);
                    }
                }
            }
        }
        for &v in &self.obstacles {
            for &(e, _) in mesh.around(v) {
                if states[e] == EdgeState::Given {
                    return bad(format!(
                        "vertex {v} is an obstacle, but a street that exists touches it"
                    ));
                }
                close(&mut states, e);
            }
        }
        for (r, route) in self.routes.iter().enumerate() {
            for pair in route.windows(2) {
                let Some(e) = mesh.edge_between(pair[0], pair[1]) else {
                    return bad(format!(
                        "route {r} jumps from vertex {} to {}, which no edge joins",
                        pair[0], pair[1]
                    ));
                };
                if pair.iter().any(|v| self.obstacles.contains(v)) {
                    return bad(format!("route {r} runs into the obstacle at {}", pair[1]));
                }
                if states[e] != EdgeState::Given {
                    states[e] = EdgeState::Required;
                }
            }
            if self.through {
                for &v in route.get(1..route.len().saturating_sub(1)).unwrap_or(&[]) {
                    mesh.around(v)
                        .iter()
                        .for_each(|&(e, _)| close(&mut states, e));
                }
            }
        }
        Ok(states)
    }
}
