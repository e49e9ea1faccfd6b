//! Where normal footpoints can lie, and which of them is nearest.

use nalgebra::Rotation2;

use super::weights::EdgeWeight;
use crate::domain::{Domain, Ring};
use crate::footpoint::{Bound, Tree};
use crate::plane::{fourth_power, left, V2};

/// What a footpoint can lie on.
#[derive(Clone, Copy, Debug)]
enum Shape {
    /// The inside of an edge; its weight grows by `slope` a metre.
    Edge {
        start: V2,
        direction: V2,
        length: f64,
        weight: f64,
        slope: f64,
        cross: V2,
    },
    /// A concave vertex that is turned around.
    Turn {
        at: V2,
        before: V2,
        after: V2,
        weight: f64,
    },
    /// A concave corner that counts by its tangents.
    Tangents {
        at: V2,
        before: V2,
        after: V2,
        per_weight: [f64; 2],
        crosses: [V2; 2],
    },
}

/// A footpoint, relative to the centre of the domain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    /// Distance over weight, what the nearest one is chosen by.
    pub(super) weighted: f64,
    /// Representation vector of the cross that it gives.
    pub(super) cross: V2,
    /// Where it is; for a corner that counts by its tangents, on the tangent.
    pub(super) point: V2,
}

impl Shape {
    /// The footpoint of `p` here, if there is one.
    #[inline]
    fn foot(&self, p: V2, slack: f64) -> Option<Foot> {
        match *self {
            Self::Edge {
                start,
                direction,
                length,
                weight,
                slope,
                cross,
            } => {
                let d = p - start;
                let along = direction.dot(&d);
                let height = left(direction).dot(&d);
                (height >= -slack && along >= -slack && along <= length + slack).then(|| {
                    let along = along.clamp(0.0, length);
                    Foot {
                        weighted: height.max(0.0) / (weight + slope * along),
                        cross,
                        point: start + direction * along,
                    }
                })
            }
            Self::Turn {
                at,
                before,
                after,
                weight,
            } => {
                let d = p - at;
                let length = d.norm();
                (before.dot(&d) >= 0.0 && after.dot(&d) <= 0.0 && length > slack).then(|| Foot {
                    weighted: length / weight,
                    cross: fourth_power(d),
                    point: at,
                })
            }
            Self::Tangents {
                at,
                before,
                after,
                per_weight,
                crosses,
            } => {
                let d = p - at;
                let (along, back) = (before.dot(&d), after.dot(&d));
                if along < 0.0 || back > 0.0 {
                    return None;
                }
                let first = left(before).dot(&d) * per_weight[0];
                let second = left(after).dot(&d) * per_weight[1];
                Some(if first >= second {
                    Foot {
                        weighted: first,
                        cross: crosses[0],
                        point: at + before * along,
                    }
                } else {
                    Foot {
                        weighted: second,
                        cross: crosses[1],
                        point: at + after * back,
                    }
                })
            }
        }
    }
}

impl Shape {
    /// Distance of `p` from the part of the boundary that the shape stands on.
    fn gap(&self, p: V2) -> f64 {
        match *self {
            Self::Edge {
                start,
                direction,
                length,
                ..
            } => {
                let d = p - start;
                (d - direction * direction.dot(&d).clamp(0.0, length)).norm()
            }
            Self::Turn { at, .. } | Self::Tangents { at, .. } => (p - at).norm(),
        }
    }
}

/// A shape and the part of the boundary it belongs to.
#[derive(Clone, Copy, Debug)]
struct Site {
    shape: Shape,
    /// Ring, and its (cleaned) edge; for a vertex the edge that leaves it.
    ring: u32,
    edge: u32,
}

/// All places for footpoints, in a tree.
#[derive(Debug)]
pub(super) struct Sites<'a> {
    domain: &'a Domain,
    /// In the order of the tree's leaves.
    sites: Vec<Site>,
    tree: Tree,
    slack: f64,
    /// One over the smallest weight.
    most_per_weight: f64,
    /// Whether footpoints that `p` cannot see are left out.
    seen_only: bool,
}

/// What a search leaves for the next one, a point nearby.
#[derive(Debug, Default)]
pub(super) struct Search {
    last: Option<usize>,
    found: Vec<(u32, f64)>,
}

impl<'a> Sites<'a> {
    pub(super) fn new(
        domain: &'a Domain,
        weights: &[Vec<EdgeWeight>],
        tangents: bool,
        seen_only: bool,
    ) -> Self {
        let rings = &domain.inner.rings;
        let mut sites = Vec::new();
        let mut bounds = Vec::new();
        let mut size = 0.0_f64;
        let mut least = f64::INFINITY;
        for (index, (ring, weights)) in rings.iter().zip(weights).enumerate() {
            for (k, &weight) in weights.iter().enumerate() {
                let mut push = |shape, bound| {
                    sites.push(Site {
                        shape,
                        ring: index as u32,
                        edge: k as u32,
                    });
                    bounds.push(bound);
                };
                let (a, b) = ring.edge(k);
                size = size.max(a.amax());
                least = least.min(weight.start).min(weight.end);
                let direction = ring.direction(k);
                let length = (b - a).norm();
                let shape = Shape::Edge {
                    start: a,
                    direction,
                    length,
                    weight: weight.start,
                    slope: (weight.end - weight.start) / length,
                    cross: fourth_power(direction),
                };
                push(shape, Bound::of_segment(a, b, weight.start.max(weight.end)));
                if ring.turn[k] < 0.0 {
                    let pair = [weights[ring.previous(k)].end, weight.start];
                    concave(ring, k, pair, tangents, push);
                }
            }
        }
        let mut tree = Tree::new(&bounds);
        // Sites of one leaf lie side by side.
        let sites = tree
            .take_order()
            .into_iter()
            .map(|k| sites[k as usize])
            .collect();
        Self {
            domain,
            sites,
            tree,
            slack: 1e-12 * size,
            most_per_weight: least.recip(),
            seen_only,
        }
    }

    fn foot(&self, site: usize, p: V2) -> Option<Foot> {
        self.sites[site].shape.foot(p, self.slack)
    }

    /// Whether the straight way from `p` to its footpoint stays inside.
    ///
    /// A corner that counts by its tangents is seen when the corner is.
    fn sees(&self, site: usize, p: V2) -> bool {
        let Site { shape, ring, edge } = self.sites[site];
        let (target, at_vertex) = match shape {
            Shape::Edge { .. } => match shape.foot(p, self.slack) {
                Some(foot) => (foot.point, false),
                None => return false,
            },
            Shape::Turn { at, .. } | Shape::Tangents { at, .. } => (at, true),
        };
        self.domain.inner.sees(p, target, ring, edge, at_vertex)
    }

    /// Ring and edge of a site.
    pub(super) fn name(&self, site: usize) -> (u32, u32) {
        (self.sites[site].ring, self.sites[site].edge)
    }

    /// The best site for `p` and its footpoint, whose cross is averaged over
    /// all sites that are equally near; `None` if there is none.
    ///
    /// Ties do happen: refinement places vertices at circumcentres, equally
    /// far from three vertices of the boundary, where rounding would choose
    /// otherwise in each direction of the compass.
    ///
    /// The site that `search` found last, for a point nearby, gives a first
    /// bound. The result does not depend on it.
    pub(super) fn nearest(&self, p: V2, search: &mut Search) -> Option<(usize, Foot)> {
        if let Some(found) = self.search(p, search, self.seen_only) {
            return Some(found);
        }
        // The nearest boundary point of all is always seen, but for rounding.
        self.seen_only
            .then(|| self.search(p, search, false))
            .flatten()
    }

    fn search(&self, p: V2, search: &mut Search, seen: bool) -> Option<(usize, Foot)> {
        let widened = |d: f64| d * (1.0 + TIE) + self.slack;
        let accept = |k: usize| !seen || self.sees(k, p);
        let distance = |k: usize| self.foot(k, p).map(|foot| foot.weighted);
        // The nearest boundary point of all is a footpoint that is seen, and
        // no farther than any other boundary point.
        let limit = search.last.map_or(f64::INFINITY, |k| {
            let any = self.sites[k].shape.gap(p) * self.most_per_weight;
            match distance(k) {
                Some(d) if d < any && accept(k) => widened(d),
                _ => widened(any),
            }
        });
        search.found.clear();
        for limit in [limit, f64::INFINITY] {
            self.tree
                .nearest_and_ties(p, limit, widened, distance, accept, &mut search.found);
            // Outside the domain the first limit may be too low.
            if !search.found.is_empty() {
                break;
            }
        }
        let mut sum = V2::zeros();
        let mut best: Option<(usize, Foot)> = None;
        for &(k, _) in &search.found {
            let k = k as usize;
            let foot = self.foot(k, p)?;
            sum += foot.cross;
            let nearer = |&(b, least): &(usize, Foot)| (foot.weighted, k) < (least.weighted, b);
            if best.as_ref().is_none_or(nearer) {
                best = Some((k, foot));
            }
        }
        let (k, mut foot) = best?;
        search.last = Some(k);
        if let Some(mean) = sum.try_normalize(1e-6) {
            foot.cross = mean;
        }
        Some((k, foot))
    }

    /// All sites with a footpoint of `p`, by trying each, nearest first.
    pub(super) fn all(&self, p: V2) -> Vec<(usize, Foot)> {
        let mut all: Vec<(usize, Foot)> = (0..self.sites.len())
            .filter_map(|k| Some((k, self.foot(k, p)?)))
            .filter(|&(k, _)| !self.seen_only || self.sees(k, p))
            .collect();
        all.sort_by(|a, b| {
            a.1.weighted
                .total_cmp(&b.1.weighted)
                .then(self.name(a.0).cmp(&self.name(b.0)))
        });
        all
    }
}

/// The sites of a concave vertex: one, or two for a sharp corner.
fn concave(
    ring: &Ring,
    k: usize,
    pair: [f64; 2],
    tangents: bool,
    mut push: impl FnMut(Shape, Bound),
) {
    let at = ring.points[k];
    let [before, after] = [ring.previous(k), k].map(|e| ring.direction(e));
    let heavier = pair[0].max(pair[1]);
    if !(ring.corner[k] && tangents) {
        let shape = Shape::Turn {
            at,
            before,
            after,
            weight: heavier,
        };
        push(shape, Bound::of_segment(at, at, heavier));
        return;
    }
    let turn = ring.turn[k];
    // A sharper corner is capped: half its turn at either end.
    let cap = Rotation2::new(turn / 2.0) * before;
    let mean = (pair[0] + pair[1]) / 2.0;
    let capped = [
        ([before, cap], [pair[0], mean], turn / 2.0),
        ([cap, after], [mean, pair[1]], turn / 2.0),
    ];
    let plain = [([before, after], pair, turn)];
    let corners = if turn < -CAPPED {
        &capped[..]
    } else {
        &plain[..]
    };
    for &([before, after], pair, turn) in corners {
        let shape = Shape::Tangents {
            at,
            before,
            after,
            per_weight: pair.map(f64::recip),
            crosses: [before, after].map(fourth_power),
        };
        // In the cone between the two normals one of the tangents is at least
        // this part of the distance to `at` away.
        let part = (turn / 2.0).cos();
        push(shape, Bound::of_segment(at, at, heavier / part));
    }
}

/// Weighted distances this near to each other, in parts, are equal.
const TIE: f64 = 1e-9;

/// Concave turns beyond this, 135 degrees, are capped.
const CAPPED: f64 = 0.75 * std::f64::consts::PI;
