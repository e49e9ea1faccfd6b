//! A mesh cut into connected parts of about the same area.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use geo_types::Coord;

use super::tessellation::Tessellation;
use crate::dice::Dice;
use crate::error::DesignError;

/// Rounds of growing from the middles of the parts before.
const ROUNDS: usize = 16;

/// Cuts the faces of a mesh into parts: connected by common edges, of about the
/// same area, and compact. Gives the part of each face, from 0; the same every
/// time for the same seed.
///
/// Seeds are faces far from each other; parts grow from them, the smallest
/// first, by the face nearest to its seed; the next seeds are the middles of
/// the parts (Lloyd's iteration on the dual graph), and of all rounds the most
/// compact counts. At last faces on the seams change sides where that makes
/// areas more alike.
///
/// # Errors
///
/// [`DesignError::BadOption`] for no parts, for more than there are faces, and
/// for fewer than the mesh has pieces, which cannot be connected then.
///
/// # Examples
///
/// ```
/// use network_opt::design::{partition, Tessellation};
/// use network_opt::geo_types::coord;
///
/// // Two by six squares in three parts: four each.
/// let points = (0..21).map(|k| coord! { x: f64::from(k % 7), y: f64::from(k / 7) }).collect();
/// let faces = (0..12).map(|k| k / 6 * 7 + k % 6).map(|a| vec![a, a + 1, a + 8, a + 7]);
/// let mesh = Tessellation::new(points, faces.collect())?;
/// let parts = partition(&mesh, 3, 0)?;
/// let mut sizes = [0; 3];
/// parts.iter().for_each(|&part| sizes[part] += 1);
/// assert_eq!(sizes, [4, 4, 4]);
/// # Ok::<(), network_opt::DesignError>(())
/// ```
pub fn partition(mesh: &Tessellation, parts: usize, seed: u64) -> Result<Vec<usize>, DesignError> {
    let bad = |what: String| Err(DesignError::BadOption { what });
    let dual = Dual::new(mesh);
    let faces = dual.centres.len();
    if parts == 0 || parts > faces {
        return bad(format!(
            "{parts} parts of {faces} faces; ask for 1 to {faces}"
        ));
    }
    let pieces = dual.pieces();
    if pieces > parts {
        return bad(format!(
            "{parts} parts of a mesh of {pieces} pieces; ask for {pieces} at least"
        ));
    }
    let mut seeds = dual.far_apart(parts, Dice::new(seed).below(faces));
    let mut best: Option<(f64, Vec<usize>)> = None;
    let mut seen = BTreeSet::new();
    for _ in 0..ROUNDS {
        if !seen.insert(seeds.clone()) {
            break;
        }
        let grown = dual.grow(&seeds);
        let spread = dual.spread(&grown, parts);
        seeds = dual.middles(&grown, parts);
        if best.as_ref().is_none_or(|(least, _)| spread < *least) {
            best = Some((spread, grown));
        }
    }
    let mut grown = best.map_or_else(Vec::new, |(_, grown)| grown);
    dual.balance(&mut grown, parts);
    Ok(grown)
}

/// The parts that grow from given places, each from the face nearest to it: a
/// partition by hand where faces have no names.
///
/// # Errors
///
/// As [`partition`], and for places that are nearest to one and the same face.
pub fn partition_around(
    mesh: &Tessellation,
    places: &[Coord<f64>],
) -> Result<Vec<usize>, DesignError> {
    let bad = |what: String| Err(DesignError::BadOption { what });
    let dual = Dual::new(mesh);
    let mut seeds = Vec::with_capacity(places.len());
    for (k, &place) in places.iter().enumerate() {
        let Some(face) = dual.nearest(place, 0..dual.centres.len()) else {
            return bad("a mesh without faces has no parts".to_owned());
        };
        if let Some(other) = seeds.iter().position(|&known| known == face) {
            return bad(format!(
                "places {other} and {k} of parts are nearest to one face, {face}; move one of them"
            ));
        }
        seeds.push(face);
    }
    let pieces = dual.pieces();
    if seeds.is_empty() || pieces > seeds.len() {
        return bad(format!(
            "{} parts of a mesh of {pieces} pieces; give a place in each",
            seeds.len()
        ));
    }
    let grown = dual.grow(&seeds);
    if grown.contains(&NONE) {
        return bad("a piece of the mesh has no part; give a place in each piece".to_owned());
    }
    Ok(grown)
}

/// Checks a partition by hand: a label for each face, faces of a label
/// connected by common edges. Gives the parts, numbered from 0 in the order of
/// their labels.
///
/// # Errors
///
/// [`DesignError::BadOption`] for another number of labels than faces, and for
/// faces of one label that are apart.
pub fn check_partition(mesh: &Tessellation, labels: &[usize]) -> Result<Vec<usize>, DesignError> {
    let bad = |what: String| Err(DesignError::BadOption { what });
    let dual = Dual::new(mesh);
    let faces = dual.centres.len();
    if labels.len() != faces {
        return bad(format!("{} labels for {faces} faces", labels.len()));
    }
    let names: Vec<usize> = BTreeSet::from_iter(labels.iter().copied())
        .into_iter()
        .collect();
    let numbered = labels
        .iter()
        .map(|label| names.partition_point(|k| k < label));
    let parts: Vec<usize> = numbered.collect();
    let mut reached = vec![false; faces];
    for (part, name) in names.iter().enumerate() {
        let Some(first) = parts.iter().position(|&p| p == part) else {
            continue;
        };
        for f in dual.connected(&parts, first) {
            reached[f] = true;
        }
        if let Some(f) = (0..faces).find(|&f| parts[f] == part && !reached[f]) {
            return bad(format!(
                "the faces of label {name} are not connected: no way from {first} to {f}"
            ));
        }
    }
    Ok(parts)
}

const NONE: usize = usize::MAX;

/// Faces as vertices, common edges as edges.
struct Dual {
    centres: Vec<Coord<f64>>,
    areas: Vec<f64>,
    beside: Vec<Vec<usize>>,
}

impl Dual {
    fn new(mesh: &Tessellation) -> Self {
        let points = mesh.points();
        let centre = |face: &Vec<usize>| {
            let sum = face.iter().fold(Coord::zero(), |sum, &v| sum + points[v]);
            sum / face.len() as f64
        };
        let area = |face: &Vec<usize>| {
            let base = points[face[0]];
            let cross = (0..face.len()).map(|k| {
                let (a, b) = (
                    points[face[k]] - base,
                    points[face[(k + 1) % face.len()]] - base,
                );
                a.x * b.y - a.y * b.x
            });
            0.5 * cross.sum::<f64>().abs()
        };
        let mut beside = vec![Vec::new(); mesh.faces().len()];
        for e in 0..mesh.edges().len() {
            if let &[f, g] = mesh.faces_of(e) {
                beside[f].push(g);
                beside[g].push(f);
            }
        }
        Self {
            centres: mesh.faces().iter().map(centre).collect(),
            areas: mesh.faces().iter().map(area).collect(),
            beside,
        }
    }

    fn step(&self, f: usize, g: usize) -> f64 {
        let way = self.centres[f] - self.centres[g];
        way.x.hypot(way.y)
    }

    fn nearest(&self, place: Coord<f64>, among: impl Iterator<Item = usize>) -> Option<usize> {
        let away = |f: usize| {
            let way = self.centres[f] - place;
            way.x.hypot(way.y)
        };
        among.min_by(|&f, &g| away(f).total_cmp(&away(g)).then(f.cmp(&g)))
    }

    /// Shortens ways from all faces to the nearest seed by those to one more.
    fn approach(&self, away: &mut [f64], seed: usize) {
        away[seed] = 0.0;
        // Of numbers that are not negative the bits are in order.
        let mut queue = BinaryHeap::from([(Reverse(0_u64), seed)]);
        while let Some((Reverse(bits), f)) = queue.pop() {
            let gone = f64::from_bits(bits);
            if gone > away[f] {
                continue;
            }
            for &g in &self.beside[f] {
                let there = gone + self.step(f, g);
                if there < away[g] {
                    away[g] = there;
                    queue.push((Reverse(there.to_bits()), g));
                }
            }
        }
    }

    fn pieces(&self) -> usize {
        let whole = vec![0; self.centres.len()];
        let mut seen = vec![false; self.centres.len()];
        let mut pieces = 0;
        for f in 0..seen.len() {
            if !seen[f] {
                pieces += 1;
                self.connected(&whole, f)
                    .into_iter()
                    .for_each(|g| seen[g] = true);
            }
        }
        pieces
    }

    /// All faces of a face's part that it is connected with.
    fn connected(&self, parts: &[usize], from: usize) -> Vec<usize> {
        let mut found = vec![from];
        let mut seen = BTreeSet::from([from]);
        let mut at = 0;
        while at < found.len() {
            for &g in &self.beside[found[at]] {
                if parts[g] == parts[from] && seen.insert(g) {
                    found.push(g);
                }
            }
            at += 1;
        }
        found
    }

    /// Faces far from each other: each the farthest from those before it, the
    /// first the farthest from `from`. What cannot be reached is farther than
    /// all that can.
    fn far_apart(&self, count: usize, from: usize) -> Vec<usize> {
        let farthest = |away: &[f64]| {
            let all = 0..away.len();
            all.max_by(|&f, &g| away[f].total_cmp(&away[g]).then(g.cmp(&f)))
        };
        let mut away = vec![f64::INFINITY; self.centres.len()];
        self.approach(&mut away, from);
        let mut next = farthest(&away);
        away.fill(f64::INFINITY);
        let mut seeds = Vec::with_capacity(count);
        while let (Some(seed), true) = (next, seeds.len() < count) {
            seeds.push(seed);
            self.approach(&mut away, seed);
            next = farthest(&away);
        }
        seeds
    }

    /// Parts that grow from seeds, the smallest first, by the face nearest to
    /// its seed.
    fn grow(&self, seeds: &[usize]) -> Vec<usize> {
        let mut parts = vec![NONE; self.centres.len()];
        let mut areas = vec![0.0; seeds.len()];
        let mut open: Vec<BinaryHeap<(Reverse<u64>, Reverse<usize>)>> =
            vec![BinaryHeap::new(); seeds.len()];
        // A seed is its own part's whatever grows faster.
        for (part, &seed) in seeds.iter().enumerate() {
            parts[seed] = part;
        }
        for (part, &seed) in seeds.iter().enumerate() {
            areas[part] += self.areas[seed];
            self.reach(&parts, &mut open[part], seeds[part], seed);
        }
        loop {
            let growing = (0..seeds.len()).filter(|&part| !open[part].is_empty());
            let Some(part) = growing.min_by(|&a, &b| areas[a].total_cmp(&areas[b]).then(a.cmp(&b)))
            else {
                return parts;
            };
            if let Some((_, Reverse(f))) = open[part].pop() {
                if parts[f] == NONE {
                    parts[f] = part;
                    areas[part] += self.areas[f];
                    self.reach(&parts, &mut open[part], seeds[part], f);
                }
            }
        }
    }

    fn reach(
        &self,
        parts: &[usize],
        open: &mut BinaryHeap<(Reverse<u64>, Reverse<usize>)>,
        seed: usize,
        from: usize,
    ) {
        for &g in self.beside[from].iter().filter(|&&g| parts[g] == NONE) {
            open.push((Reverse(self.step(seed, g).to_bits()), Reverse(g)));
        }
    }

    /// The centre of each part.
    fn centroids(&self, parts: &[usize], count: usize) -> (Vec<Coord<f64>>, Vec<f64>) {
        let mut sums = vec![Coord::zero(); count];
        let mut areas = vec![0.0; count];
        for (f, &part) in parts.iter().enumerate() {
            // So that flat faces count too.
            let area = self.areas[f].max(f64::MIN_POSITIVE);
            sums[part] = sums[part] + self.centres[f] * area;
            areas[part] += area;
        }
        let centroids = sums.iter().zip(&areas).map(|(&sum, &area)| sum / area);
        (centroids.collect(), areas)
    }

    /// How far faces are from the centres of their parts, and parts from equal.
    fn spread(&self, parts: &[usize], count: usize) -> f64 {
        let (centroids, areas) = self.centroids(parts, count);
        let spread = parts.iter().enumerate().map(|(f, &part)| {
            let way = self.centres[f] - centroids[part];
            self.areas[f] * (way.x * way.x + way.y * way.y)
        });
        spread.sum::<f64>() * areas.iter().copied().fold(0.0, f64::max)
    }

    /// The face of each part nearest to its centre.
    fn middles(&self, parts: &[usize], count: usize) -> Vec<usize> {
        let (centroids, _) = self.centroids(parts, count);
        let own = |part: usize| (0..parts.len()).filter(move |&f| parts[f] == part);
        let middles = (0..count).filter_map(|part| self.nearest(centroids[part], own(part)));
        middles.collect()
    }

    /// Moves faces on seams to a smaller part, where both stay connected.
    fn balance(&self, parts: &mut [usize], count: usize) {
        let mut areas = self.centroids(parts, count).1;
        // Each move makes the sum of squared areas less; this many are enough to
        // move every face once or twice.
        let mut left = 2 * parts.len();
        loop {
            let mut moved = false;
            for f in 0..parts.len() {
                let (from, area) = (parts[f], self.areas[f]);
                let shared =
                    |part: usize| self.beside[f].iter().filter(|&&g| parts[g] == part).count();
                let others = self.beside[f].iter().map(|&g| parts[g]);
                // No more of a seam than before, so parts stay compact.
                let target = others
                    .filter(|&p| p != from && areas[from] - areas[p] > 1.001 * area)
                    .filter(|&p| shared(p) >= shared(from))
                    .min_by(|&a, &b| areas[a].total_cmp(&areas[b]).then(a.cmp(&b)));
                let Some(target) = target else { continue };
                parts[f] = target;
                let rest: Vec<usize> = (0..parts.len()).filter(|&g| parts[g] == from).collect();
                let whole = rest
                    .first()
                    .is_some_and(|&g| self.connected(parts, g).len() == rest.len());
                if whole && left > 0 {
                    areas[from] -= area;
                    areas[target] += area;
                    left -= 1;
                    moved = true;
                } else {
                    parts[f] = from;
                }
            }
            if !moved {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sizes(parts: &[usize]) -> Vec<usize> {
        let count = parts.iter().max().map_or(0, |most| most + 1);
        let mut sizes = vec![0; count];
        parts.iter().for_each(|&part| sizes[part] += 1);
        sizes
    }

    /// Twelve by twelve squares: areas within a fifth of equal.
    #[test]
    fn parts_of_a_square_are_alike() {
        let mesh = Tessellation::grid(12, 12);
        for parts in [2, 4, 5, 6, 9] {
            for seed in 0..4 {
                let found = sizes(&partition(&mesh, parts, seed).expect("fits"));
                let mean = 144.0 / parts as f64;
                let fine = |&n: &usize| (n as f64 - mean).abs() <= 0.2 * mean + 1.0;
                assert!(found.len() == parts && found.iter().all(fine), "{found:?}");
            }
        }
        assert_eq!(sizes(&partition(&mesh, 144, 3).expect("all")), vec![1; 144]);
        assert!(partition(&mesh, 0, 0).is_err() && partition(&mesh, 145, 0).is_err());
    }

    #[test]
    fn parts_by_hand_are_connected_or_refused() {
        let mesh = Tessellation::grid(3, 1);
        assert_eq!(check_partition(&mesh, &[7, 7, 2]), Ok(vec![1, 1, 0]));
        let error = check_partition(&mesh, &[1, 2, 1]).expect_err("apart");
        assert!(error.to_string().contains("not connected"), "{error}");
        assert!(check_partition(&mesh, &[1, 1]).is_err());
        let at = |x: f64| Coord { x, y: 0.5 };
        let parts = partition_around(&mesh, &[at(0.0), at(2.9)]).expect("fits");
        assert_eq!((parts[0], parts[2]), (0, 1));
        assert!(partition_around(&mesh, &[at(0.0), at(0.1)]).is_err());
        assert!(partition_around(&mesh, &[]).is_err());
    }

    /// Two squares that touch in a corner only.
    #[test]
    fn pieces_are_never_in_one_part() {
        let c = |x: f64, y: f64| Coord { x, y };
        let points = vec![
            c(0., 0.),
            c(1., 0.),
            c(1., 1.),
            c(0., 1.),
            c(2., 1.),
            c(2., 2.),
            c(1., 2.),
        ];
        let mesh =
            Tessellation::new(points, vec![vec![0, 1, 2, 3], vec![2, 4, 5, 6]]).expect("a mesh");
        assert!(partition(&mesh, 1, 0).is_err());
        assert_eq!(sizes(&partition(&mesh, 2, 0).expect("fits")), [1, 1]);
        assert!(partition_around(&mesh, &[c(0.5, 0.5)]).is_err());
    }
}
