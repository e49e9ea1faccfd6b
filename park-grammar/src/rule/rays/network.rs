//! The walk-graph: joins of centres, and rays that cross none of them.
//!
//! "Cast ray to all corners, without intersecting other paths (how?)": joins come
//! first, then rays from the shortest on, each if it crosses nothing that is there
//! already, nor passes over another centre. A ray to a direction, which has no
//! target to miss, ends at the first path that it meets instead. Centres that
//! have no ray, nor are joined to any that has, get one to the nearest place of
//! the outline, so that one can walk in.
//!
//! A join that would leave the region, or come nearer to its boundary than half
//! of its width, goes round by the shortest way inside. Where joins that go round
//! meet they are one path.

use geo_types::Coord;

use super::joins::{Groups, Link};
use super::targets::{End, Targets};
use crate::derive::Watch;
use crate::error::Failure;
use crate::plane::{cross, dist, dot, erode, lerp, nearest_on, sees, sides, Area, Router};

/// Distances this small, as a share of the area's size, are none.
const NEAR: f64 = 1e-7;

/// Directions that differ by less, radians, are one.
const PARALLEL: f64 = 1e-6;

/// Which rays are cast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rays {
    /// From each centre to its nearest target.
    Nearest,
    /// To each target from its nearest centre.
    Unconnected,
    /// From each centre to each target.
    All,
}

/// What the words of `rays =` mean.
pub(super) const WORDS: [(&str, Rays); 3] = [
    ("nearest", Rays::Nearest),
    ("unconnected", Rays::Unconnected),
    ("all", Rays::All),
];

/// The middle line of a path.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Path {
    pub(super) line: Vec<Coord<f64>>,
    /// The centres at its beginning, and at its end if it is a join.
    pub(super) centres: [Option<usize>; 2],
    /// Whether it goes on over the boundary at its end.
    pub(super) leaves: bool,
}

/// A ray that could be cast.
struct Candidate {
    centre: usize,
    target: usize,
    end: End,
    length: f64,
}

/// Where a ray meets what is there.
struct Meeting {
    share: f64,
    /// A centre that hangs together with what is met.
    with: usize,
}

/// Paths so far.
#[derive(Debug)]
pub(super) struct Network<'a> {
    area: &'a Area,
    size: f64,
    half: f64,
    centres: &'a [Coord<f64>],
    /// How much room each centre keeps free of others' rays.
    room: Vec<f64>,
    groups: Groups,
    /// Whether a ray leaves from a centre.
    cast: Vec<bool>,
    /// The least angle between a ray and another path at one of its ends, radians.
    pub(super) narrow: f64,
    pub(super) watch: Option<Watch<'a>>,
    pub(super) paths: Vec<Path>,
}

impl<'a> Network<'a> {
    /// No paths yet between centres; those whose shapes share ground hang together
    /// already.
    pub(super) fn new(
        area: &'a Area,
        size: f64,
        half: f64,
        centres: &'a [Coord<f64>],
        radii: &[f64],
        touching: &[Link],
    ) -> Self {
        let mut groups = Groups::new(centres.len());
        for &[a, b] in touching {
            groups.join(a, b);
        }
        Self {
            area,
            size,
            half,
            centres,
            room: radii.iter().map(|r| r.max(half)).collect(),
            groups,
            cast: vec![false; centres.len()],
            narrow: 0.0,
            watch: None,
            paths: Vec::new(),
        }
    }

    /// Joins centres.
    pub(super) fn join(&mut self, links: &[Link]) -> Result<(), Failure> {
        if links.is_empty() {
            return Ok(());
        }
        let widths: Vec<Vec<f64>> = self
            .area
            .rings()
            .map(|ring| vec![self.half; ring.len()])
            .collect();
        let roomy: Vec<Router> = erode(self.area, &widths)
            .into_iter()
            .map(Router::new)
            .collect();
        let mut tight: Option<Router> = None;
        for &[a, b] in links {
            self.watch.as_ref().map_or(Ok(()), Watch::look)?;
            let (from, to) = (self.centres[a], self.centres[b]);
            let line = roomy
                .iter()
                .find_map(|router| router.way(from, to))
                // Through places narrower than the path.
                .or_else(|| sees(self.area, from, to).then(|| vec![from, to]))
                .or_else(|| {
                    let router = tight.get_or_insert_with(|| Router::new(self.area.clone()));
                    router.way(from, to)
                });
            let Some(line) = line else {
                continue;
            };
            self.groups.join(a, b);
            self.paths.push(Path {
                line,
                centres: [Some(a), Some(b)],
                leaves: false,
            });
        }
        Ok(())
    }

    /// Casts rays.
    pub(super) fn cast(
        &mut self,
        targets: &Targets,
        rays: Rays,
        hidden: bool,
    ) -> Result<(), Failure> {
        let mut candidates: Vec<Candidate> = Vec::new();
        for (centre, &from) in self.centres.iter().enumerate() {
            for target in 0..targets.count() {
                self.watch.as_ref().map_or(Ok(()), Watch::tick)?;
                let end = targets.cast(self.area, self.size, from, target, hidden);
                candidates.extend(end.map(|end| Candidate {
                    centre,
                    target,
                    end,
                    length: dist(from, end.at),
                }));
            }
        }
        // Lengths that are equal but for rounding must not change the order.
        let grain = NEAR * self.size;
        let key = |c: &Candidate| ((c.length / grain).round() as i64, c.target, c.centre);
        candidates.sort_by_key(key);
        let directed = matches!(targets, Targets::Directions(_));
        let mut reached = vec![false; targets.count()];
        for candidate in candidates {
            self.watch.as_ref().map_or(Ok(()), Watch::tick)?;
            let skip = match rays {
                Rays::Nearest => self.cast[candidate.centre],
                Rays::Unconnected => !directed && reached[candidate.target],
                Rays::All => false,
            };
            let Candidate { centre, end, .. } = candidate;
            if !skip && self.is_apart(centre, end.at) && self.ray(centre, end, directed) {
                reached[candidate.target] = true;
            }
        }
        Ok(())
    }

    /// Gives centres without a way out one.
    pub(super) fn exits(&mut self) {
        // Each turn gives a group its way out, or joins two.
        for _ in 0..2 * self.centres.len() {
            let shut = |&k: &usize| self.groups.of(k) == k && !self.has_exit(k);
            let Some(group) = (0..self.centres.len()).find(shut) else {
                return;
            };
            self.exit(group);
        }
    }

    /// A way out for a group of centres.
    fn exit(&mut self, group: usize) {
        let members = (0..self.centres.len()).filter(|&k| self.groups.of(k) == group);
        let mut ends: Vec<(f64, usize, Coord<f64>)> = Vec::new();
        for k in members {
            let from = self.centres[k];
            for (a, b) in sides(&self.area.outer) {
                let at = nearest_on(a, b, from);
                ends.push((dist(from, at), k, at));
            }
        }
        ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let Some(&(least, nearest, end)) = ends.first() else {
            return;
        };
        // One that lies on the outline is a way in itself.
        if least <= NEAR * self.size {
            self.cast[nearest] = true;
            return;
        }
        ends.retain(|(_, k, at)| sees(self.area, self.centres[*k], *at));
        for &(_, k, at) in &ends {
            let own = |met: &Meeting| self.groups.of(met.with) == group;
            if !self.meeting(k, at).as_ref().is_some_and(own) {
                let end = End { at, leaves: true };
                if self.ray(k, end, true) {
                    return;
                }
            }
        }
        // Through the group's own paths, or past holes.
        let straight = ends
            .first()
            .map(|&(_, k, at)| (k, vec![self.centres[k], at]));
        let found = straight.or_else(|| {
            let way = Router::new(self.area.clone()).way(self.centres[nearest], end);
            way.map(|line| (nearest, line))
        });
        self.cast[nearest] = true;
        if let Some((k, line)) = found {
            self.paths.push(Path {
                line,
                centres: [Some(k), None],
                leaves: true,
            });
        }
    }

    /// Adds the ray from a centre, if it crosses nothing; one that may end early
    /// ends at what it meets.
    fn ray(&mut self, centre: usize, end: End, early: bool) -> bool {
        let from = self.centres[centre];
        let met = self.meeting(centre, end.at);
        let (at, leaves, with) = match met {
            Some(_) if !early => return false,
            // What begins along another path is that path.
            Some(met) if met.share * dist(from, end.at) <= 2.0 * self.half => return false,
            Some(met) => (lerp(from, end.at, met.share), false, Some(met.with)),
            None => (end.at, end.leaves, None),
        };
        self.cast[centre] = true;
        if let Some(other) = with {
            let out = self.cast[other] || self.has_exit(other);
            self.groups.join(centre, other);
            self.cast[centre] = out;
        }
        self.paths.push(Path {
            line: vec![from, at],
            centres: [Some(centre), None],
            leaves,
        });
        true
    }

    /// Whether the way from a centre keeps the least angle from all paths that
    /// begin or end where it does.
    fn is_apart(&self, centre: usize, to: Coord<f64>) -> bool {
        let from = self.centres[centre];
        let near = NEAR * self.size;
        let narrow = |u: Coord<f64>, v: Coord<f64>| {
            cross(u, v).abs().atan2(dot(u, v)) < self.narrow * (1.0 - NEAR)
        };
        self.paths.iter().all(|path| {
            let line = &path.line;
            let (n, first) = (line.len(), line[1] - line[0]);
            let last = line[n - 2] - line[n - 1];
            [(line[0], first), (line[n - 1], last)]
                .into_iter()
                .all(|(end, way)| {
                    let begins = dist(end, from) <= near && narrow(to - from, way);
                    let ends = dist(end, to) <= near && narrow(from - to, way);
                    !begins && !ends
                })
        })
    }

    fn has_exit(&self, centre: usize) -> bool {
        let group = self.groups.of(centre);
        (0..self.centres.len()).any(|k| self.cast[k] && self.groups.of(k) == group)
    }

    /// Where the way from a centre first meets a path or another centre.
    fn meeting(&self, centre: usize, to: Coord<f64>) -> Option<Meeting> {
        let from = self.centres[centre];
        let near = NEAR * self.size;
        let long = dist(from, to);
        let mut first: Option<Meeting> = None;
        let mut meet = |share: f64, with: usize| {
            if first.as_ref().is_none_or(|f| share < f.share) {
                first = Some(Meeting { share, with });
            }
        };
        for (k, &at) in self.centres.iter().enumerate() {
            if k != centre && dist(from, at) >= self.room[k] {
                let on = nearest_on(from, to, at);
                if dist(on, at) < self.room[k] {
                    meet(dist(from, on) / long, k);
                }
            }
        }
        for path in &self.paths {
            let with = path.centres[0].or(path.centres[1]).unwrap_or(centre);
            for pair in path.line.windows(2) {
                if let Some(share) = meets([from, to], [pair[0], pair[1]], near) {
                    meet(share, with);
                }
            }
        }
        first
    }
}

/// The share of a way at which it meets a segment; ends that both have in common
/// are no meeting, unless one runs along the other.
fn meets([a, b]: [Coord<f64>; 2], [p, q]: [Coord<f64>; 2], near: f64) -> Option<f64> {
    let (way, other) = (b - a, q - p);
    let (long, short) = (dot(way, way).sqrt(), dot(other, other).sqrt());
    if long <= near || short <= near {
        return None;
    }
    let same = |x: Coord<f64>, y: Coord<f64>| dist(x, y) <= near;
    let det = cross(way, other);
    if det.abs() <= PARALLEL * long * short {
        // Side by side, or along each other.
        let aside = |x: Coord<f64>| cross(way, x - a).abs() / long;
        if aside(p).max(aside(q)) > near.max(PARALLEL * long) {
            return None;
        }
        let share = |x: Coord<f64>| dot(x - a, way) / (long * long);
        let (low, high) = (share(p).min(share(q)), share(p).max(share(q)));
        let (from, to) = (low.max(0.0), high.min(1.0));
        return ((to - from) * long > near).then_some(from);
    }
    let t = cross(p - a, other) / det;
    let u = cross(p - a, way) / det;
    let (off_way, off_other) = (near / long, near / short);
    let on = t > -off_way && t < 1.0 + off_way && u > -off_other && u < 1.0 + off_other;
    let common = [a, b].iter().any(|&x| same(x, p) || same(x, q));
    (on && !common).then(|| t.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::coord;

    fn p(x: f64, y: f64) -> Coord<f64> {
        coord! { x: x, y: y }
    }

    #[test]
    fn ways_meet() {
        let meets = |b: Coord<f64>, s: [Coord<f64>; 2]| meets([p(0., 0.), b], s, 1e-6);
        assert_eq!(meets(p(4., 0.), [p(1., -1.), p(1., 1.)]), Some(0.25));
        assert_eq!(meets(p(4., 0.), [p(5., -1.), p(5., 1.)]), None);
        // Common ends.
        assert_eq!(meets(p(4., 0.), [p(0., 0.), p(1., 1.)]), None);
        assert_eq!(meets(p(4., 0.), [p(2., 2.), p(4., 0.)]), None);
        // Along each other.
        assert_eq!(meets(p(4., 0.), [p(0., 0.), p(9., 0.)]), Some(0.0));
        assert_eq!(meets(p(4., 0.), [p(0., 0.), p(-9., 0.)]), None);
        assert_eq!(meets(p(4., 0.), [p(2., 0.), p(9., 0.)]), Some(0.5));
        // Ending on the other.
        assert_eq!(meets(p(4., 0.), [p(4., -1.), p(4., 1.)]), Some(1.0));
    }

    fn square() -> Area {
        let ring = [(0., 0.), (0., 20.), (20., 20.), (20., 0.)];
        Area::new(ring.map(|(x, y)| p(x, y)).to_vec(), Vec::new())
    }

    fn paths(centres: &[Coord<f64>], rays: Rays, links: &[Link]) -> Vec<Path> {
        let area = square();
        let targets = Targets::Places(area.outer.clone());
        let mut network = Network::new(&area, 20.0, 1.0, centres, &vec![0.0; centres.len()], &[]);
        network.join(links).expect("time enough");
        network.cast(&targets, rays, false).expect("time enough");
        network.exits();
        network.paths
    }

    /// Two centres in a square: each corner from the nearer one, the two nearest
    /// only, or all that do not cross.
    #[test]
    fn modes_differ_in_their_rays() {
        let two = [p(6., 9.), p(14., 11.)];
        assert_eq!(paths(&two, Rays::Unconnected, &[]).len(), 4);
        let nearest = paths(&two, Rays::Nearest, &[]);
        let ends: Vec<_> = nearest.iter().map(|path| path.line[1]).collect();
        assert_eq!(ends, [p(0., 0.), p(20., 20.)]);
        // Of eight rays the two to the farthest corners cross the others' on the
        // way to the two middling ones, each other not.
        let all = paths(&two, Rays::All, &[]);
        for (k, one) in all.iter().enumerate() {
            for two in &all[..k] {
                let [a, b] = [&one.line, &two.line];
                let met = meets([a[0], a[1]], [b[0], b[1]], 1e-6);
                assert_eq!(met, None, "{a:?} {b:?}");
            }
        }
        assert!(all.len() >= 6);
        assert_eq!(paths(&two, Rays::Unconnected, &[[0, 1]]).len(), 5);
    }

    /// A centre that sees no target gets a way out, and joins go round corners.
    #[test]
    fn all_centres_have_a_way_out() {
        let u = [
            (0., 0.),
            (0., 30.),
            (8., 30.),
            (8., 8.),
            (20., 8.),
            (20., 30.),
            (28., 30.),
            (28., 0.),
        ];
        let area = Area::new(u.map(|(x, y)| p(x, y)).to_vec(), Vec::new());
        let centres = [p(3., 26.), p(24., 26.)];
        let mut network = Network::new(&area, 30.0, 1.0, &centres, &[0.0; 2], &[]);
        network.join(&[[0, 1]]).expect("time enough");
        let line = &network.paths[0].line;
        assert!(line.len() > 3);
        // A metre from the corners.
        let room = |k: usize| area.nearest(lerp(line[k], line[k + 1], 0.5)).1;
        assert!((0..line.len() - 1).all(|k| room(k) > 0.99));
        let none = Targets::Places(Vec::new());
        network.cast(&none, Rays::All, false).expect("time enough");
        network.exits();
        assert_eq!(network.paths.len(), 2);
        assert_eq!(network.paths[1].line, [p(3., 26.), p(0., 26.)]);
    }
}
