//! How often each point of a park is covered by its pieces.
//!
//! Between two heights at which no edge begins, ends or crosses another, edges
//! stand in a fixed order from west to east, and with each of them the number of
//! pieces goes up or down by one. The land between two neighbours is a trapezoid,
//! whose area belongs to what is covered once, not at all or several times. This
//! shares nothing with the booleans that cut the pieces.

use geo_types::Coord;

use crate::plane::{sides, Area};

/// Edges that change places by less, as a share of the park's size, do so by
/// rounding.
const ROUNDING: f64 = 1e-12;

/// What is not covered exactly once, square metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Coverage {
    /// Land of the outline that no piece covers.
    pub(super) gap: f64,
    /// Land that pieces cover beyond once, each time counted.
    pub(super) overlap: f64,
    /// Land outside of the outline that some piece covers.
    pub(super) outside: f64,
}

/// An edge walked upwards.
#[derive(Clone, Copy, Debug)]
struct Edge {
    low: Coord<f64>,
    high: Coord<f64>,
    /// What crossing it eastwards does to the number of pieces.
    step: i32,
    /// Whether it belongs to the outline.
    rim: bool,
}

impl Edge {
    fn at(&self, y: f64) -> f64 {
        if y <= self.low.y {
            self.low.x
        } else if y >= self.high.y {
            self.high.x
        } else {
            let t = (y - self.low.y) / (self.high.y - self.low.y);
            self.low.x + (self.high.x - self.low.x) * t
        }
    }
}

/// An edge between two heights: where it stands at both.
#[derive(Clone, Copy, Debug)]
struct Bar {
    bottom: f64,
    top: f64,
    step: i32,
    rim: bool,
}

impl Bar {
    fn at(&self, t: f64) -> f64 {
        self.bottom + (self.top - self.bottom) * t
    }
}

/// Measures pieces against an outline. The cost is that of sorting the edges
/// times how many of them a level line meets.
pub(super) fn coverage(outline: &Area, pieces: &[Area]) -> Coverage {
    let (low, high) = outline.extent();
    let rounding = ROUNDING * (high.x - low.x).max(high.y - low.y);
    let mut edges = Vec::new();
    push(&mut edges, outline, true);
    pieces
        .iter()
        .for_each(|piece| push(&mut edges, piece, false));
    edges.sort_by(|a, b| a.low.y.total_cmp(&b.low.y));
    let mut heights: Vec<f64> = edges.iter().flat_map(|e| [e.low.y, e.high.y]).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    let mut found = Coverage::default();
    let mut waiting = edges.iter().peekable();
    let mut active: Vec<&Edge> = Vec::new();
    for pair in heights.windows(2) {
        let (bottom, top) = (pair[0], pair[1]);
        active.retain(|edge| edge.high.y > bottom);
        while let Some(edge) = waiting.next_if(|edge| edge.low.y <= bottom) {
            active.push(edge);
        }
        let bars = active.iter().map(|edge| Bar {
            bottom: edge.at(bottom),
            top: edge.at(top),
            step: edge.step,
            rim: edge.rim,
        });
        slab(bars.collect(), top - bottom, rounding, &mut found);
    }
    found
}

fn push(edges: &mut Vec<Edge>, area: &Area, rim: bool) {
    for (a, b) in area.rings().flat_map(|ring| sides(ring)) {
        // The land lies on the right of every edge.
        let (low, high, step) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
        if low.y < high.y {
            edges.push(Edge {
                low,
                high,
                step,
                rim,
            });
        }
    }
}

/// The land between two heights, cut at the heights where edges cross.
fn slab(mut bars: Vec<Bar>, height: f64, rounding: f64, found: &mut Coverage) {
    bars.sort_by(|a, b| {
        let bottom = a.bottom.total_cmp(&b.bottom);
        bottom.then(a.top.total_cmp(&b.top))
    });
    let mut cuts = vec![0.0, 1.0];
    // All pairs only where some neighbours change places: in a park that is as it
    // must be, none do.
    if bars.windows(2).any(|w| w[0].top - w[1].top > rounding) {
        for (k, a) in bars.iter().enumerate() {
            for b in &bars[k + 1..] {
                let (before, after) = (b.bottom - a.bottom, a.top - b.top);
                if before > rounding && after > rounding {
                    cuts.push(before / (before + after));
                }
            }
        }
        cuts.sort_by(f64::total_cmp);
    }
    for pair in cuts.windows(2) {
        let mut part: Vec<Bar> = bars
            .iter()
            .map(|bar| Bar {
                bottom: bar.at(pair[0]),
                top: bar.at(pair[1]),
                ..*bar
            })
            .collect();
        // Where they are halfway: edges may meet at both ends.
        part.sort_by(|a, b| (a.bottom + a.top).total_cmp(&(b.bottom + b.top)));
        strips(&part, (pair[1] - pair[0]) * height, found);
    }
}

/// Adds up trapezoids between edges that do not cross.
fn strips(bars: &[Bar], height: f64, found: &mut Coverage) {
    let (mut count, mut inside) = (0_i32, 0_i32);
    for pair in bars.windows(2) {
        if pair[0].rim {
            inside += pair[0].step;
        } else {
            count += pair[0].step;
        }
        let wide = |a: f64, b: f64| (b - a).max(0.0);
        let area =
            0.5 * height * (wide(pair[0].bottom, pair[1].bottom) + wide(pair[0].top, pair[1].top));
        if area <= 0.0 {
            continue;
        }
        match (inside > 0, count) {
            (true, ..=0) => found.gap += area * f64::from(1 - count),
            (false, 1..) => found.outside += area,
            // A ring that crosses itself covers land a negative number of times.
            (false, ..=-1) => found.outside += area,
            _ => {}
        }
        found.overlap += area * f64::from((count - 1).max(0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn rectangle(x: [f64; 2], y: [f64; 2]) -> Area {
        let corners = [(x[0], y[0]), (x[0], y[1]), (x[1], y[1]), (x[1], y[0])];
        let ring = corners.map(|(x, y)| coord! { x: x, y: y }).to_vec();
        Area::new(ring, Vec::new())
    }

    fn near(a: Coverage, [gap, overlap, outside]: [f64; 3]) -> bool {
        [(a.gap, gap), (a.overlap, overlap), (a.outside, outside)]
            .iter()
            .all(|(is, must)| (is - must).abs() < 1e-9)
    }

    #[test]
    fn tiles_cover_once() {
        let outline = rectangle([0.0, 10.0], [0.0, 6.0]);
        let mut frame = rectangle([0.0, 6.0], [0.0, 6.0]);
        let inner = rectangle([1.0, 4.0], [2.0, 5.0]);
        frame.holes = vec![inner.outer.iter().rev().copied().collect()];
        let pieces = [frame, inner, rectangle([6.0, 10.0], [0.0, 6.0])];
        assert!(near(coverage(&outline, &pieces), [0.0; 3]));
    }

    #[test]
    fn what_is_wrong_is_measured() {
        let outline = rectangle([0.0, 10.0], [0.0, 6.0]);
        // 2 wide gap, 1 wide overlap, 3 outside.
        let pieces = [
            rectangle([0.0, 5.0], [0.0, 6.0]),
            rectangle([4.0, 8.0], [0.0, 6.0]),
            rectangle([12.0, 13.0], [0.0, 3.0]),
        ];
        assert!(near(coverage(&outline, &pieces), [12.0, 6.0, 3.0]));
    }

    /// Two triangles over a square meet in its middle, between all vertices.
    #[test]
    fn crossings_within_a_slab_are_cut() {
        let outline = rectangle([0.0, 4.0], [0.0, 4.0]);
        let triangle = |points: [(f64, f64); 3]| {
            let ring = points.map(|(x, y)| coord! { x: x, y: y }).to_vec();
            Area::new(ring, Vec::new())
        };
        let pieces = [
            triangle([(0., 0.), (0., 4.), (4., 0.)]),
            triangle([(0., 0.), (4., 4.), (4., 0.)]),
        ];
        // Common is the lower quarter, the upper quarter has nothing.
        assert!(near(coverage(&outline, &pieces), [4.0, 4.0, 0.0]));
    }

    #[test]
    fn a_ring_that_crosses_itself_is_no_tile() {
        let outline = rectangle([0.0, 4.0], [0.0, 2.0]);
        let ring = [(0., 0.), (0., 2.), (4., 0.), (4., 2.)];
        let bow = Area {
            outer: ring.map(|(x, y)| coord! { x: x, y: y }).to_vec(),
            holes: Vec::new(),
        };
        let found = coverage(&outline, &[bow]);
        assert!(found.gap > 3.0, "{found:?}");
    }
}
