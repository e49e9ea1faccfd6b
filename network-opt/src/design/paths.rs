//! All paths between two vertices that are nearly as short as the shortest.

use std::collections::{BTreeSet, VecDeque};

use super::tessellation::Tessellation;
use crate::dice::Dice;

/// Which paths between two places are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathOptions {
    /// How many edges more than the shortest path a path may have.
    ///
    /// Default value: 2, as in the paper.
    pub tolerance: usize,
    /// How many paths at most.
    ///
    /// Default value: 128.
    pub most: usize,
    /// Seed of the draw where there are more.
    ///
    /// Default value: 0.
    pub seed: u64,
}

impl Default for PathOptions {
    fn default() -> Self {
        Self {
            tolerance: 2,
            most: 128,
            seed: 0,
        }
    }
}

/// Walks of one length up to which all of them are listed.
const LISTED: f64 = 100_000.0;
/// Walks that are drawn at most, for each path that is wanted, if there are
/// more.
const DRAWN: usize = 24;

/// The simple paths between two vertices over edges that are `open`, by their
/// edges in order, of at most `tolerance` edges more than the shortest
/// (Peng et al. 2016, section 4.2, L1).
///
/// Shorter paths come first, paths of one length in the order of their edges.
/// The number of paths grows exponentially with their length, so there is a
/// cap: if there are more than `most`, the longest are left out, and of the
/// last length that fits in part a random sample is taken, evenly over all of
/// that length. None, if there is no path, and no path from a vertex to itself.
///
/// # Panics
///
/// If a vertex is not in the mesh, or `open` has not one entry an edge.
///
/// # Examples
///
/// ```
/// use network_opt::design::{paths_between, PathOptions, Tessellation};
/// use network_opt::geo_types::coord;
///
/// let points = (0..9).map(|k| coord! { x: f64::from(k % 3), y: f64::from(k / 3) }).collect();
/// let faces = [0, 1, 3, 4].map(|a| vec![a, a + 1, a + 4, a + 3]).to_vec();
/// let mesh = Tessellation::new(points, faces)?;
/// let all = [true; 12];
/// // Across two by two squares: six ways of four edges, and four of six.
/// let short = PathOptions { tolerance: 0, ..PathOptions::default() };
/// assert_eq!(paths_between(&mesh, &all, [0, 8], &short).len(), 6);
/// assert_eq!(paths_between(&mesh, &all, [0, 8], &PathOptions::default()).len(), 10);
/// # Ok::<(), network_opt::DesignError>(())
/// ```
#[must_use]
pub fn paths_between(
    mesh: &Tessellation,
    open: &[bool],
    ends: [usize; 2],
    options: &PathOptions,
) -> Vec<Vec<usize>> {
    paths_where(mesh, open, ends, options, &|_| true)
}

/// As [`paths_between`], of those paths of which every beginning is `allowed`.
pub(super) fn paths_where(
    mesh: &Tessellation,
    open: &[bool],
    [from, to]: [usize; 2],
    options: &PathOptions,
    allowed: &dyn Fn(&[usize]) -> bool,
) -> Vec<Vec<usize>> {
    let Some(shortest) = steps(mesh, open, from, to) else {
        return Vec::new();
    };
    // No simple path is longer.
    let longest = shortest
        .saturating_add(options.tolerance)
        .min(mesh.points().len().saturating_sub(1));
    let mut search = Search {
        mesh,
        open,
        to,
        allowed,
        walks: Walks::new(mesh, to),
        path: Vec::new(),
        on_path: vec![false; mesh.points().len()],
        found: Vec::new(),
    };
    search.on_path[from] = true;
    let mut dice = Dice::new(options.seed);
    let mut paths = Vec::new();
    for length in shortest..=longest {
        let room = options.most - paths.len();
        if room == 0 {
            break;
        }
        search.walks.extend(mesh, open, length);
        let count = search.walks.count(length, from);
        if count <= LISTED {
            search.list(from, length);
        } else {
            search.draw(from, length, room, &mut dice);
        }
        let mut found = std::mem::take(&mut search.found);
        if found.len() > room {
            dice.shuffle(&mut found);
            found.truncate(room);
        }
        found.sort_unstable();
        paths.append(&mut found);
    }
    paths
}

/// Edges of the shortest path; none between a vertex and itself.
fn steps(mesh: &Tessellation, open: &[bool], from: usize, to: usize) -> Option<usize> {
    let mut steps = vec![None; mesh.points().len()];
    steps[from] = Some(0);
    let mut queue = VecDeque::from([from]);
    while let Some(v) = queue.pop_front() {
        for &(e, w) in mesh.around(v) {
            if open[e] && steps[w].is_none() {
                steps[w] = steps[v].map(|n: usize| n + 1);
                queue.push_back(w);
            }
        }
    }
    steps[to].filter(|&n| n > 0)
}

/// How many walks of each length lead from each vertex to one of them, vertices
/// met twice included: what a path that begins may still become.
struct Walks(Vec<Vec<f64>>);

impl Walks {
    fn new(mesh: &Tessellation, to: usize) -> Self {
        let mut none = vec![0.0; mesh.points().len()];
        none[to] = 1.0;
        Self(vec![none])
    }

    fn extend(&mut self, mesh: &Tessellation, open: &[bool], length: usize) {
        while self.0.len() <= length {
            let last = &self.0[self.0.len() - 1];
            let next = (0..mesh.points().len()).map(|v| {
                let around = mesh.around(v).iter().filter(|&&(e, _)| open[e]);
                around.map(|&(_, w)| last[w]).sum()
            });
            let next = next.collect();
            self.0.push(next);
        }
    }

    fn count(&self, length: usize, from: usize) -> f64 {
        self.0[length][from]
    }
}

struct Search<'a> {
    mesh: &'a Tessellation,
    open: &'a [bool],
    to: usize,
    allowed: &'a dyn Fn(&[usize]) -> bool,
    walks: Walks,
    path: Vec<usize>,
    on_path: Vec<bool>,
    found: Vec<Vec<usize>>,
}

impl Search<'_> {
    /// All paths that go on from here by `left` edges.
    fn list(&mut self, at: usize, left: usize) {
        if left == 0 {
            self.found.push(self.path.clone());
            return;
        }
        let mesh = self.mesh;
        for &(e, w) in mesh.around(at) {
            let leads = self.walks.count(left - 1, w) > 0.0;
            // Only its last vertex is where it is to end.
            if !self.open[e] || self.on_path[w] || !leads || (w == self.to && left > 1) {
                continue;
            }
            self.path.push(e);
            if (self.allowed)(&self.path) {
                self.on_path[w] = true;
                self.list(w, left - 1);
                self.on_path[w] = false;
            }
            self.path.pop();
        }
    }

    /// Some paths of `length` edges, all equally likely: walks are drawn step by
    /// step by the number that go on, and those kept that are paths.
    fn draw(&mut self, from: usize, length: usize, wanted: usize, dice: &mut Dice) {
        let mut kept = BTreeSet::new();
        for _ in 0..DRAWN * wanted {
            if kept.len() >= wanted {
                break;
            }
            if let Some(path) = self.walk(from, length, dice) {
                kept.insert(path);
            }
        }
        self.found.extend(kept);
    }

    fn walk(&self, from: usize, length: usize, dice: &mut Dice) -> Option<Vec<usize>> {
        let (mut at, mut path) = (from, Vec::with_capacity(length));
        let mut met = vec![from];
        for left in (0..length).rev() {
            let around = self.mesh.around(at).iter();
            let steps: Vec<(usize, usize, f64)> = around
                .filter(|&&(e, _)| self.open[e])
                .map(|&(e, w)| (e, w, self.walks.count(left, w)))
                .collect();
            let mut share = dice.unit() * steps.iter().map(|step| step.2).sum::<f64>();
            let mut next = None;
            for &(e, w, count) in steps.iter().filter(|step| step.2 > 0.0) {
                next = Some((e, w));
                share -= count;
                if share < 0.0 {
                    break;
                }
            }
            let (e, w) = next?;
            path.push(e);
            if met.contains(&w) || (w == self.to && left > 0) || !(self.allowed)(&path) {
                return None;
            }
            met.push(w);
            at = w;
        }
        Some(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cap_keeps_the_shortest_and_a_fair_sample() {
        let mesh = Tessellation::grid(10, 10);
        let open = vec![true; mesh.edges().len()];
        let options = |tolerance, most| PathOptions {
            tolerance,
            most,
            seed: 1,
        };
        // One straight path of four edges, and of six those that step aside for a
        // while, to either side, from one of 5 * 4 / 2 places to another.
        let all = paths_between(&mesh, &open, [55, 59], &options(2, 1000));
        assert_eq!(all.iter().filter(|path| path.len() == 4).count(), 1);
        let six = all.iter().filter(|path| path.len() == 6);
        assert_eq!(six.count(), 20);
        let few = paths_between(&mesh, &open, [55, 59], &options(2, 7));
        assert_eq!((few.len(), &few[0]), (7, &all[0]));
        assert!(few.iter().all(|path| all.contains(path)));
        // 184,756 ways across: a sample that begins in either direction.
        let sample = paths_between(&mesh, &open, [0, 120], &options(0, 60));
        assert_eq!(sample.len(), 60);
        let right = sample.iter().filter(|path| mesh.edges()[path[0]] == [0, 1]);
        // Of 60 draws 30 are expected, with a deviation of 3.9; five of them.
        let right = right.count();
        assert!((11..=49).contains(&right), "{right}");
        assert_eq!(
            sample,
            paths_between(&mesh, &open, [0, 120], &options(0, 60))
        );
    }

    #[test]
    fn nothing_leads_nowhere() {
        let mesh = Tessellation::grid(2, 2);
        let open = vec![true; 12];
        let options = PathOptions::default();
        assert!(paths_between(&mesh, &open, [4, 4], &options).is_empty());
        assert!(paths_between(&mesh, &[false; 12], [0, 8], &options).is_empty());
        let none = PathOptions { most: 0, ..options };
        assert!(paths_between(&mesh, &open, [0, 8], &none).is_empty());
        // A tolerance beyond everything: all simple paths of the window.
        let endless = PathOptions {
            tolerance: usize::MAX,
            ..options
        };
        assert_eq!(paths_between(&mesh, &open, [0, 8], &endless).len(), 12);
    }
}
