//! The shortest way inside an area.
//!
//! It bends at corners of the area that turn inwards, so that it is found among
//! those by A* (Hart, Nilsson and Raphael 1968), which looks around only where it
//! comes to.

use geo_types::Coord;

use super::{cross, dist, sees, Area, Ring};

/// Finds ways in an area.
#[derive(Clone, Debug)]
pub(crate) struct Router {
    area: Area,
    /// Corners that turn inwards.
    bends: Vec<Coord<f64>>,
}

impl Router {
    pub(crate) fn new(area: Area) -> Self {
        let bends = |ring: &Ring| {
            let n = ring.len();
            let at = |k: usize| ring[k % n];
            let turns = |&k: &usize| cross(at(k) - at(k + n - 1), at(k + 1) - at(k)) > 0.0;
            (0..n).filter(turns).map(at).collect::<Vec<_>>()
        };
        Self {
            bends: area.rings().flat_map(bends).collect(),
            area,
        }
    }

    /// The shortest way from one place to another, both included; `None` where
    /// there is none.
    ///
    /// # Cost
    ///
    /// For each bend that the search comes to, a look at every other past every
    /// edge.
    pub(crate) fn way(&self, from: Coord<f64>, to: Coord<f64>) -> Option<Vec<Coord<f64>>> {
        let inside = |p| self.area.contains(p) || sees(&self.area, p, self.area.nearest(p).0);
        if !inside(from) || !inside(to) {
            return None;
        }
        let mut places = vec![from, to];
        places.extend(&self.bends);
        let n = places.len();
        let mut least = vec![f64::INFINITY; n];
        let mut before = vec![0; n];
        let mut done = vec![false; n];
        least[0] = 0.0;
        loop {
            let open = (0..n).filter(|&k| !done[k] && least[k].is_finite());
            let guess = |k: usize| least[k] + dist(places[k], to);
            let here = open.min_by(|&a, &b| guess(a).total_cmp(&guess(b)))?;
            if here == 1 {
                break;
            }
            done[here] = true;
            for k in 1..n {
                let there = least[here] + dist(places[here], places[k]);
                if !done[k] && there < least[k] && sees(&self.area, places[here], places[k]) {
                    least[k] = there;
                    before[k] = here;
                }
            }
        }
        let mut line = vec![to];
        let mut k = 1;
        while k != 0 {
            k = before[k];
            line.push(places[k]);
        }
        line.reverse();
        Some(line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn ring(points: &[(f64, f64)]) -> Ring {
        points.iter().map(|&(x, y)| coord! { x: x, y: y }).collect()
    }

    #[test]
    fn ways_bend_at_inner_corners() {
        let l = ring(&[(0., 0.), (0., 9.), (3., 9.), (3., 3.), (9., 3.), (9., 0.)]);
        let router = Router::new(Area::new(l, Vec::new()));
        let (a, b) = (coord! { x: 2., y: 8. }, coord! { x: 8., y: 2. });
        let bend = coord! { x: 3., y: 3. };
        assert_eq!(router.way(a, b), Some(vec![a, bend, b]));
        let c = coord! { x: 1., y: 1. };
        assert_eq!(router.way(a, c), Some(vec![a, c]));
        assert_eq!(router.way(a, coord! { x: 5., y: 5. }), None);
    }

    /// Around a hole on its shorter side.
    #[test]
    fn ways_go_round_holes() {
        let outer = ring(&[(0., 0.), (0., 12.), (12., 12.), (12., 0.)]);
        let hole = ring(&[(4., 3.), (8., 3.), (8., 8.), (4., 8.)]);
        let router = Router::new(Area::new(outer, vec![hole]));
        let (a, b) = (coord! { x: 2., y: 5. }, coord! { x: 10., y: 5. });
        let way = router.way(a, b).expect("there is a way");
        assert_eq!(way[1..3], ring(&[(4., 3.), (8., 3.)]));
        assert_eq!(way.len(), 4);
    }
}
