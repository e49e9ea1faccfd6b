//! Areas that are taken: shapes cut out of a region, hedges and walls on it.

use geo_types::Coord;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{RTree, AABB};

use crate::plane::Area;

type Extent = GeomWithData<Rectangle<[f64; 2]>, usize>;

/// Areas in the order in which they were taken, with an index of their extents.
#[derive(Clone, Debug, Default)]
pub(crate) struct Patches {
    areas: Vec<Area>,
    /// None before the first area: most regions never have one.
    extents: Option<RTree<Extent>>,
}

impl Patches {
    pub(crate) fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    pub(crate) fn len(&self) -> usize {
        self.areas.len()
    }

    /// All of them.
    pub(crate) fn all(&self) -> &[Area] {
        &self.areas
    }

    pub(crate) fn push(&mut self, area: Area) {
        let extent = extent(&area, self.areas.len());
        self.extents.get_or_insert_default().insert(extent);
        self.areas.push(area);
    }

    /// Leaves the first ones only.
    pub(crate) fn truncate(&mut self, count: usize) {
        while self.areas.len() > count {
            if let Some(area) = self.areas.pop() {
                let extent = extent(&area, self.areas.len());
                self.extents.as_mut().and_then(|all| all.remove(&extent));
            }
        }
    }

    /// Those whose extents meet a box, in the order in which they were taken.
    pub(crate) fn near(&self, low: Coord<f64>, high: Coord<f64>) -> Vec<&Area> {
        let mut found: Vec<usize> = self.met(low, high).collect();
        found.sort_unstable();
        found.into_iter().map(|k| &self.areas[k]).collect()
    }

    /// Whether a disc lies outside of all of them.
    pub(crate) fn clear(&self, at: Coord<f64>, radius: f64) -> bool {
        let by = Coord {
            x: radius,
            y: radius,
        };
        self.met(at - by, at + by)
            .all(|k| super::clear(&self.areas[k], at, radius))
    }

    fn met(&self, low: Coord<f64>, high: Coord<f64>) -> impl Iterator<Item = usize> + '_ {
        let wanted = AABB::from_corners([low.x, low.y], [high.x, high.y]);
        let extents = self.extents.iter();
        let found = extents.flat_map(move |all| all.locate_in_envelope_intersecting(&wanted));
        found.map(|extent| extent.data)
    }
}

fn extent(area: &Area, number: usize) -> Extent {
    let (low, high) = area.extent();
    GeomWithData::new(
        Rectangle::from_corners([low.x, low.y], [high.x, high.y]),
        number,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::circle;
    use geo_types::coord;

    #[test]
    fn what_is_taken_is_found_and_given_back() {
        let mut patches = Patches::default();
        for k in 0..20 {
            let at = coord! { x: 10.0 * f64::from(k), y: 0.0 };
            patches.push(Area::new(circle(at, 2.0), Vec::new()));
        }
        let at = coord! { x: 25.0, y: 0.0 };
        assert!(patches.clear(at, 2.9) && !patches.clear(at, 3.1));
        let near = patches.near(coord! { x: 15.0, y: -1.0 }, coord! { x: 45.0, y: 1.0 });
        let middles: Vec<f64> = near.iter().map(|a| a.centroid().x.round()).collect();
        assert_eq!(middles, [20.0, 30.0, 40.0]);
        patches.truncate(3);
        assert!(patches.clear(at, 2.9) && patches.len() == 3);
        assert!(!patches.clear(at, 3.1) && patches.clear(coord! { x: 30.0, y: 0.0 }, 3.0));
    }
}
