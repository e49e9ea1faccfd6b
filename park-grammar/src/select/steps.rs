//! The boundary of a region with the ends of a selection as vertices.

use geo_types::Coord;

use super::{perimeter, Selection, LEAST};
use crate::plane::dist;
use crate::plane::lerp;
use crate::shape::Region;

/// A vertex, and what begins there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Step {
    pub(crate) at: Coord<f64>,
    /// Whether what begins here is selected, up to the next vertex.
    pub(crate) picked: bool,
    /// The physical edge that it is part of.
    pub(crate) edge: usize,
}

impl Selection {
    /// All rings of a region, cut where the selection begins and ends.
    pub(crate) fn steps(&self, region: &Region) -> Vec<Vec<Step>> {
        let ring = |ring: usize| {
            let tiny = LEAST * perimeter(region, ring);
            let here: Vec<[f64; 2]> = self
                .stretches
                .iter()
                .filter(|s| s.ring == ring)
                .map(|s| [s.from, s.to])
                .collect();
            let mut steps = Vec::new();
            let mut from = 0.0;
            for (edge, (a, b, _)) in region.edges(ring).enumerate() {
                let to = from + dist(a, b);
                let mut cuts = vec![from];
                let within = |x: &f64| *x > from + tiny && *x < to - tiny;
                cuts.extend(here.iter().flatten().copied().filter(within));
                cuts.sort_by(f64::total_cmp);
                cuts.dedup();
                for (k, &cut) in cuts.iter().enumerate() {
                    let end = cuts.get(k + 1).copied().unwrap_or(to);
                    let middle = 0.5 * (cut + end);
                    steps.push(Step {
                        at: if k == 0 {
                            a
                        } else {
                            lerp(a, b, (cut - from) / (to - from))
                        },
                        picked: here
                            .iter()
                            .any(|[low, high]| (*low..=*high).contains(&middle)),
                        edge,
                    });
                }
                from = to;
            }
            steps
        };
        (0..region.rings()).map(ring).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Stretch;
    use super::*;
    use crate::plane::Area;
    use geo_types::coord;

    #[test]
    fn ends_become_vertices() {
        let square = [(0., 0.), (0., 4.), (4., 4.), (4., 0.)];
        let ring = square.map(|(x, y)| coord! { x: x, y: y }).to_vec();
        let region = Region::bare(Area::new(ring, Vec::new()));
        let stretch = |from, to| Stretch { ring: 0, from, to };
        // From the middle of the west over the north-west corner, all of the east.
        let picked = Selection::new(vec![stretch(2.0, 5.0), stretch(8.0, 12.0)]);
        let steps = picked.steps(&region);
        let found: Vec<_> = steps[0]
            .iter()
            .map(|s| (s.at.x, s.at.y, s.picked, s.edge))
            .collect();
        assert_eq!(
            found,
            [
                (0., 0., false, 0),
                (0., 2., true, 0),
                (0., 4., true, 1),
                (1., 4., false, 1),
                (4., 4., true, 2),
                (4., 0., false, 3),
            ]
        );
    }
}
