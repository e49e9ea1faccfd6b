//! Types of traffic: from the interior to sinks, from place to place inside, and
//! across from boundary to boundary (section 3, iii, and 4.2, L1).

use super::places::{on_rim, outline};
use super::{Feature, Place, Specification};
use crate::design::partition::{check_partition, partition, partition_around};
use crate::design::paths::{paths_where, PathOptions};
use crate::design::problem::{EdgeState, Problem};
use crate::design::route::{Route, RouteKind};
use crate::design::tessellation::Tessellation;
use crate::dice::Dice;
use crate::error::DesignError;
use crate::formulate::{prepare, Fate};

/// What traffic a network is for, besides access to everything.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(default, rename_all = "kebab-case", deny_unknown_fields)
)]
pub struct Traffic {
    /// How much traffic to sinks counts: a factor of
    /// [`Specification::travel`].
    ///
    /// Default value: 1.
    pub to_sinks: f64,
    /// Interior to interior: the point-to-point constraint.
    ///
    /// Default value: none.
    pub inside: Option<Inside>,
    /// Boundary to boundary: through traffic.
    ///
    /// Default value: none.
    pub across: Option<Across>,
}

impl Default for Traffic {
    fn default() -> Self {
        Self {
            to_sinks: 1.0,
            inside: None,
            across: None,
        }
    }
}

impl Traffic {
    /// The three types mixed by weights: interior to boundary, interior to
    /// interior, boundary to boundary; 0 leaves a type out.
    ///
    /// The spans of a type that is alone have to be there. Of a mixture they
    /// need not be: a span that is missing costs its weight for each edge of its
    /// shortest path, with weight 1 as much as a street along it by
    /// [`Specification::length`] 1. (All at once would overconstrain the
    /// network, as the paper says of spans alone.)
    ///
    /// ```
    /// use network_opt::design::{Feature, Traffic};
    ///
    /// let inside = Traffic::mixed([0.0, 1.0, 0.0]).inside.unwrap();
    /// assert_eq!(inside.missing, Feature::Forbidden);
    /// let across = Traffic::mixed([1.0, 0.0, 0.5]).across.unwrap();
    /// assert_eq!(across.missing, Feature::Weighted(0.5));
    /// ```
    #[must_use]
    pub fn mixed([to_sinks, inside, across]: [f64; 3]) -> Self {
        let types = [to_sinks, inside, across];
        let alone = types.iter().filter(|&&weight| weight != 0.0).count() == 1;
        let missing = |weight: f64| match alone {
            true => Feature::Forbidden,
            false => Feature::Weighted(weight),
        };
        Self {
            to_sinks,
            inside: (inside != 0.0).then(|| Inside {
                missing: missing(inside),
                ..Inside::default()
            }),
            across: (across != 0.0).then(|| Across {
                missing: missing(across),
                ..Across::default()
            }),
        }
    }
}

/// Traffic from place to place inside: the mesh is cut into parts, one vertex is
/// drawn of each, and the vertices of parts side by side are to be joined by a
/// nearly shortest path.
///
/// Vertices are drawn at random of those that streets can touch: of those off
/// the boundary that belong to no other part; if there are none, of those on it;
/// else of those that parts share.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(default, rename_all = "kebab-case", deny_unknown_fields)
)]
pub struct Inside {
    /// How the mesh is cut.
    ///
    /// Default value: into four parts, automatically.
    pub parts: Parts,
    /// Edges that a path may have more than the shortest.
    ///
    /// Default value: 2.
    pub tolerance: usize,
    /// Paths of each pair at most; see
    /// [`paths_between`](crate::design::paths_between).
    ///
    /// Default value: 128.
    pub most: usize,
    /// Seed of parts, vertices and paths.
    ///
    /// Default value: 0.
    pub seed: u64,
    /// What becomes of a pair that is not joined: `Weighted` costs so much for
    /// each edge of its shortest path.
    ///
    /// Default value: forbidden.
    pub missing: Feature,
}

impl Default for Inside {
    fn default() -> Self {
        Self {
            parts: Parts::Count(4),
            tolerance: 2,
            most: 128,
            seed: 0,
            missing: Feature::Forbidden,
        }
    }
}

/// How a mesh is cut into parts.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Parts {
    /// Into so many, automatically, by [`partition`].
    Count(usize),
    /// By hand, a label for each face; faces of one label are connected.
    Labels(Vec<usize>),
    /// By hand, around these places.
    Around(Vec<Place>),
}

/// Traffic from boundary to boundary: pairs of vertices on it are to be joined
/// by a nearly shortest path.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(default, rename_all = "kebab-case", deny_unknown_fields)
)]
pub struct Across {
    /// Between which places.
    ///
    /// Default value: two pairs, chosen automatically.
    pub pairs: Pairs,
    /// Edges that a path may have more than the shortest.
    ///
    /// Default value: 2.
    pub tolerance: usize,
    /// Paths of each pair at most.
    ///
    /// Default value: 128.
    pub most: usize,
    /// Seed of pairs and paths.
    ///
    /// Default value: 0.
    pub seed: u64,
    /// What becomes of a pair that is not joined: `Weighted` costs so much for
    /// each edge of its shortest path.
    ///
    /// Default value: forbidden.
    pub missing: Feature,
}

impl Default for Across {
    fn default() -> Self {
        Self {
            pairs: Pairs::Count(2),
            tolerance: 2,
            most: 128,
            seed: 0,
            missing: Feature::Forbidden,
        }
    }
}

/// Which places on the boundary are joined.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Pairs {
    /// So many, each of two vertices half of the outer boundary apart, spread
    /// evenly along it from a random one on.
    Count(usize),
    /// The vertices on the boundary nearest to these places.
    Between(Vec<[Place; 2]>),
}

/// Longer paths than that are no near-shortest ones.
const TOLERANCE: usize = 16;

impl Specification {
    /// The routes of traffic from place to place in a problem that has all else.
    ///
    /// # Errors
    ///
    /// Those of [`partition`] and its like; [`DesignError::BadProblem`] for a
    /// weight that is negative or not finite, a tolerance over 16, a place that
    /// is not there, two places at one vertex, and a pair that has to be joined
    /// and that no path joins.
    pub(super) fn spans(
        &self,
        mesh: &Tessellation,
        problem: &Problem,
    ) -> Result<Vec<Route>, DesignError> {
        let Traffic { inside, across, .. } = &self.traffic;
        if inside.is_none() && across.is_none() {
            return Ok(Vec::new());
        }
        let ground = Ground::new(mesh, problem);
        let mut routes = Vec::new();
        if let Some(inside) = inside {
            let wanted = Wanted {
                kind: RouteKind::Inside,
                options: PathOptions {
                    tolerance: inside.tolerance,
                    most: inside.most,
                    seed: inside.seed,
                },
                missing: inside.missing,
            };
            let pairs = ground.neighbours(inside)?;
            ground.routes(pairs, &wanted, &mut routes)?;
        }
        if let Some(across) = across {
            let wanted = Wanted {
                kind: RouteKind::Across,
                options: PathOptions {
                    tolerance: across.tolerance,
                    most: across.most,
                    seed: across.seed,
                },
                missing: across.missing,
            };
            let pairs = ground.opposites(across)?;
            ground.routes(pairs, &wanted, &mut routes)?;
        }
        Ok(routes)
    }
}

/// How pairs are to be joined.
struct Wanted {
    kind: RouteKind,
    options: PathOptions,
    missing: Feature,
}

/// A mesh with what is known of its edges.
struct Ground<'a> {
    mesh: &'a Tessellation,
    /// Edges that can be active, and those that are in any case.
    open: Vec<bool>,
    on: Vec<bool>,
    /// Whether streets can touch each vertex.
    may: Vec<bool>,
    on_rim: Vec<bool>,
    /// Sets of edges that are never all active, by edge.
    never: Vec<Vec<&'a [usize]>>,
}

impl<'a> Ground<'a> {
    fn new(mesh: &'a Tessellation, problem: &'a Problem) -> Self {
        let open: Vec<bool> = prepare(problem).iter().map(|&f| f != Fate::Off).collect();
        let mut may = vec![false; mesh.points().len()];
        for (ends, _) in mesh.edges().iter().zip(&open).filter(|(_, &open)| open) {
            ends.iter().for_each(|&v| may[v] = true);
        }
        let mut never = vec![Vec::new(); mesh.edges().len()];
        let plain = problem.patterns.iter();
        for p in plain.filter(|p| p.cost.is_none() && p.inactive.is_empty()) {
            p.active
                .iter()
                .for_each(|&e| never[e].push(p.active.as_slice()));
        }
        let state = |e: usize| matches!(problem.states[e], EdgeState::Given | EdgeState::Required);
        Self {
            on: (0..open.len()).map(state).collect(),
            on_rim: on_rim(mesh),
            mesh,
            open,
            may,
            never,
        }
    }

    /// One route for each pair.
    fn routes(
        &self,
        pairs: Vec<[usize; 2]>,
        wanted: &Wanted,
        routes: &mut Vec<Route>,
    ) -> Result<(), DesignError> {
        let bad = |what: String| Err(DesignError::BadProblem { what });
        if wanted.options.tolerance > TOLERANCE {
            return bad(format!(
                "paths may be {} edges longer than the shortest; give {TOLERANCE} at most",
                wanted.options.tolerance
            ));
        }
        if wanted.options.most == 0 {
            return bad("spans of at most 0 paths are never there; give 1 or more".to_owned());
        }
        let Some(price) = wanted.missing.cost() else {
            return Ok(());
        };
        // A path that holds what is forbidden is never active.
        let allowed = |path: &[usize]| {
            path.last().is_none_or(|&last| {
                let all = |set: &&[usize]| set.iter().all(|e| self.on[*e] || path.contains(e));
                !self.never[last].iter().any(all)
            })
        };
        for ends in pairs {
            let paths = paths_where(self.mesh, &self.open, ends, &wanted.options, &allowed);
            let shortest = paths.first().map(Vec::len);
            let cost = match (price, shortest) {
                (None, None) => {
                    let kind = wanted.kind.as_str();
                    return bad(format!(
                        "no path that keeps what is forbidden joins vertices {} and {} ({kind}); \
                         let it be missing at a cost, or move or allow what is in its way",
                        ends[0], ends[1]
                    ));
                }
                // It is missing whatever is built.
                (Some(_), None) => continue,
                (price, Some(edges)) => price.map(|price| price * edges as f64),
            };
            routes.push(Route {
                kind: wanted.kind,
                paths,
                cost,
            });
        }
        Ok(())
    }

    /// The vertices drawn of parts side by side, by pairs.
    fn neighbours(&self, inside: &Inside) -> Result<Vec<[usize; 2]>, DesignError> {
        let mesh = self.mesh;
        let parts = match &inside.parts {
            Parts::Count(count) => partition(mesh, *count, inside.seed)?,
            Parts::Labels(labels) => check_partition(mesh, labels)?,
            Parts::Around(places) => {
                let mut points = Vec::with_capacity(places.len());
                for place in places {
                    points.push(place.point(mesh)?);
                }
                partition_around(mesh, &points)?
            }
        };
        let count = parts.iter().max().map_or(0, |most| most + 1);
        let samples = self.samples(&parts, count, inside.seed)?;
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for e in 0..mesh.edges().len() {
            if let &[f, g] = mesh.faces_of(e) {
                let (a, b) = (parts[f].min(parts[g]), parts[f].max(parts[g]));
                if a != b {
                    pairs.push([a, b]);
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        Ok(pairs
            .into_iter()
            .map(|pair| pair.map(|part| samples[part]))
            .collect())
    }

    /// A vertex of each part, none twice.
    fn samples(&self, parts: &[usize], count: usize, seed: u64) -> Result<Vec<usize>, DesignError> {
        let mut of: Vec<Vec<usize>> = vec![Vec::new(); self.may.len()];
        for (face, &part) in self.mesh.faces().iter().zip(parts) {
            for &v in face {
                if !of[v].contains(&part) {
                    of[v].push(part);
                }
            }
        }
        let mut dice = Dice::new(seed);
        let mut samples: Vec<usize> = Vec::with_capacity(count);
        for part in 0..count {
            let own = (0..of.len()).filter(|&v| self.may[v] && of[v].contains(&part));
            let free: Vec<usize> = own.filter(|v| !samples.contains(v)).collect();
            let rank = |v: usize| (of[v].len() > 1, self.on_rim[v]);
            let best = free.iter().map(|&v| rank(v)).min();
            let best: Vec<usize> = free
                .into_iter()
                .filter(|&v| Some(rank(v)) == best)
                .collect();
            match dice.pick(&best) {
                Some(v) => samples.push(v),
                None => {
                    return Err(DesignError::BadProblem {
                        what: format!(
                            "no street can touch part {part} of {count} but where other parts \
                             are entered; ask for fewer parts"
                        ),
                    })
                }
            }
        }
        Ok(samples)
    }

    /// Pairs of vertices on the boundary.
    fn opposites(&self, across: &Across) -> Result<Vec<[usize; 2]>, DesignError> {
        let bad = |what: String| Err(DesignError::BadProblem { what });
        let may = |v: usize| self.may[v] && self.on_rim[v];
        match &across.pairs {
            Pairs::Between(places) => {
                let mut pairs = Vec::with_capacity(places.len());
                for &[a, b] in places {
                    let pair = [a.vertex(self.mesh, &may)?, b.vertex(self.mesh, &may)?];
                    if pair[0] == pair[1] {
                        return bad(format!(
                            "{a:?} and {b:?} are both nearest to vertex {}, so nothing joins them",
                            pair[0]
                        ));
                    }
                    pairs.push(pair);
                }
                Ok(pairs)
            }
            Pairs::Count(count) => {
                let (line, length) = outline(self.mesh);
                let usable = line.into_iter().filter(|&(v, _)| may(v));
                let mut left: Vec<(usize, f64)> = usable.collect();
                if *count == 0 || 2 * count > left.len() {
                    return bad(format!(
                        "{count} pairs of the {} vertices on the boundary that streets can touch",
                        left.len()
                    ));
                }
                let step = length / (2 * count) as f64;
                let from = step * Dice::new(across.seed).unit();
                let mut take = |at: f64| {
                    let away = |way: f64| {
                        let gap = (way - at).rem_euclid(length);
                        gap.min(length - gap)
                    };
                    let nearest = left.iter().enumerate();
                    let nearest = nearest.min_by(|(_, a), (_, b)| away(a.1).total_cmp(&away(b.1)));
                    // There are two for each pair.
                    nearest.map(|(k, _)| k).map(|k| left.remove(k).0)
                };
                let pairs = (0..*count).filter_map(|k| {
                    let at = from + step * k as f64;
                    Some([take(at)?, take(at + 0.5 * length)?])
                });
                Ok(pairs.collect())
            }
        }
    }
}
