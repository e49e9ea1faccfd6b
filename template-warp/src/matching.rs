//! Which templates fit a region, and how (paper, section 4.1,
//! "Initialization": "for each template with the right arrangement of corners
//! and boundary curve semantics, we look for compatible boundary matches and
//! rank them according to the distortions of boundary curve lengths").

use crate::corner::{corners, Corner, CornerOptions};
use crate::geometry::{box_centre, dist, norm, P};
use crate::initial::{divide_of, least_length};
use crate::library::Library;
use crate::region::{EdgeUse, Region};
use crate::template::format::SideUse;
use crate::template::model::Template;

/// Most weak corners that are tried both ways; the weakest beyond that count as
/// bends. Bounds the search at 2^8 sets of corners.
const MAX_WEAK: usize = 8;

/// Parameters of matching.
#[derive(Clone, Debug, PartialEq)]
pub struct MatchOptions {
    /// Least turn of a corner, degrees. Default 30.
    pub corner_deg: f64,
    /// Turn, degrees, from which a corner must be matched; weaker ones may be
    /// taken for a bend in a side. Default 58.
    pub firm_deg: f64,
    /// Boundary length, metres, over which turns add up to one corner. Default 12.
    pub corner_span: f64,
    /// Share of a side's length that must have the use a template asks for.
    /// Default 0.9.
    pub use_share: f64,
    /// Candidates with more distortion are left out. Default 1.2.
    pub max_distortion: f64,
    /// Most candidates returned. Default 24.
    pub max_candidates: usize,
}

impl Default for MatchOptions {
    fn default() -> Self {
        Self {
            corner_deg: 30.0,
            firm_deg: 58.0,
            corner_span: 12.0,
            use_share: 0.9,
            max_distortion: 1.2,
            max_candidates: 24,
        }
    }
}

/// A template together with a compatible way to lay its boundary onto a region.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Number of the template in its library.
    pub template: usize,
    /// Name of the template.
    pub name: String,
    /// How much the boundary must be distorted, 0 for not at all: the mean over
    /// the sides of |ln(length on the region / drawn length)|, where divided
    /// edges may have any length but those divided together should have the same,
    /// plus half of the mean difference of the corners' turns in units of 90
    /// degrees, plus half of the turn of passed-over corners in the same unit.
    pub distortion: f64,
    /// Vertex of the region for each corner of the template, in its order.
    pub corners: Vec<usize>,
    /// Whether the mirror image of the template is used.
    pub mirrored: bool,
    /// The template's probability.
    pub probability: f64,
}

/// All compatible boundary matches, the least distorted first.
///
/// Every template with the region's label is tried with every cyclic shift of
/// its corners (up to its own symmetry), with every choice of the region's weak
/// corners, and as its mirror image if it allows that. Ties keep the order of the
/// library. A library without a fitting template gives an empty list.
///
/// # Examples
///
/// ```
/// use template_warp::{geo_types::coord, match_templates, EdgeUse, Library, MatchOptions, Region};
///
/// let ring = vec![
///     coord! { x: 0.0, y: 0.0 }, coord! { x: 90.0, y: 0.0 },
///     coord! { x: 90.0, y: 30.0 }, coord! { x: 0.0, y: 30.0 },
/// ];
/// use EdgeUse::{NoStreet, Street};
/// let region = Region::new(ring, vec![Street, NoStreet, NoStreet, NoStreet], "block")?;
/// let found = match_templates(&Library::standard(), &region, &MatchOptions::default());
/// assert_eq!(found[0].name, "single-row");
/// # Ok::<(), template_warp::WarpError>(())
/// ```
#[must_use]
pub fn match_templates(
    library: &Library,
    region: &Region,
    options: &MatchOptions,
) -> Vec<Candidate> {
    // Relative to the region's centre, so that the place of the site cannot
    // change a rank.
    let centre = box_centre(region.ring());
    let ring: Vec<P> = region.ring().iter().map(|&q| q - centre).collect();
    let corner_options = CornerOptions {
        corner_deg: options.corner_deg,
        firm_deg: options.firm_deg,
        span: options.corner_span,
    };
    let all = corners(&ring, &corner_options);
    let boundary = Boundary::new(&ring, region.uses());
    let mut found = Vec::new();
    for set in corner_sets(&all) {
        let chosen: Vec<Corner> = set.iter().map(|&i| all[i]).collect();
        let passed: f64 = (0..all.len())
            .filter(|i| !set.contains(i))
            .map(|i| all[i].turn.abs())
            .sum();
        for (k, template) in library.templates().iter().enumerate() {
            if template.label != region.label() || template.sides.len() != chosen.len() {
                continue;
            }
            for mirrored in [false, true] {
                if mirrored && !template.mirror {
                    continue;
                }
                let Ok(variant) = library.variant(k, mirrored) else {
                    continue;
                };
                let mut shifts: Vec<(f64, f64, Vec<usize>)> = Vec::new();
                for shift in 0..chosen.len() {
                    let turned: Vec<Corner> = (0..chosen.len())
                        .map(|i| chosen[(i + shift) % chosen.len()])
                        .collect();
                    if let Some((d, first)) =
                        boundary.distortion(variant, &turned, region.area(), options)
                    {
                        shifts.push((
                            d + 0.5 * passed / std::f64::consts::FRAC_PI_2,
                            first,
                            turned.iter().map(|c| c.vertex).collect(),
                        ));
                    }
                }
                keep_one_of_symmetric(&mut shifts, &chosen, variant.symmetry);
                for (distortion, first, corners) in shifts {
                    if distortion <= options.max_distortion {
                        found.push((
                            first,
                            Candidate {
                                template: k,
                                name: template.name.clone(),
                                distortion,
                                corners,
                                mirrored,
                                probability: template.probability,
                            },
                        ));
                    }
                }
            }
        }
    }
    // Rounded, so that equal matches of a ring that starts elsewhere stay equal;
    // then the longer first side decides, which is a matter of shape alone.
    let grain = |v: f64| (v * 1e9).round();
    let scale = boundary.along.last().copied().unwrap_or(1.0);
    found.sort_by(|(f, a), (g, b)| {
        grain(a.distortion)
            .total_cmp(&grain(b.distortion))
            .then(a.template.cmp(&b.template))
            .then(a.mirrored.cmp(&b.mirrored))
            .then(grain(g / scale).total_cmp(&grain(f / scale)))
            .then(a.corners.cmp(&b.corners))
    });
    found.truncate(options.max_candidates);
    found.into_iter().map(|f| f.1).collect()
}

/// All sets of corners that hold every firm one.
fn corner_sets(all: &[Corner]) -> Vec<Vec<usize>> {
    let mut weak: Vec<usize> = (0..all.len()).filter(|&i| !all[i].firm).collect();
    weak.sort_by(|&i, &j| {
        all[j]
            .turn
            .abs()
            .total_cmp(&all[i].turn.abs())
            .then(i.cmp(&j))
    });
    weak.truncate(MAX_WEAK);
    (0..1usize << weak.len())
        .map(|mask| {
            let mut set: Vec<usize> = (0..all.len()).filter(|&i| all[i].firm).collect();
            set.extend(
                weak.iter()
                    .enumerate()
                    .filter(|(b, _)| mask >> b & 1 == 1)
                    .map(|(_, &i)| i),
            );
            set.sort_unstable();
            set
        })
        .collect()
}

/// Among shifts that lay a symmetric template the same way, keeps the one whose
/// first side is longest: a choice that does not depend on where the ring
/// starts.
fn keep_one_of_symmetric(
    shifts: &mut Vec<(f64, f64, Vec<usize>)>,
    chosen: &[Corner],
    symmetry: usize,
) {
    if symmetry < 2 {
        return;
    }
    let step = chosen.len() / symmetry;
    let place =
        |s: &(f64, f64, Vec<usize>)| chosen.iter().position(|c| c.vertex == s.2[0]).unwrap_or(0);
    let mut best: Vec<(f64, f64, Vec<usize>)> = Vec::new();
    for s in shifts.drain(..) {
        match best
            .iter_mut()
            .find(|b| place(b) % step == place(&s) % step)
        {
            Some(b) => {
                if s.1 > b.1 * (1.0 + 1e-9) {
                    *b = s;
                }
            }
            None => best.push(s),
        }
    }
    *shifts = best;
}

struct Boundary {
    /// Arc length at each vertex; the last entry is the perimeter.
    along: Vec<f64>,
    /// Length of street edges up to each vertex.
    street: Vec<f64>,
}

impl Boundary {
    fn new(ring: &[P], uses: &[EdgeUse]) -> Self {
        let (mut along, mut street) = (vec![0.0], vec![0.0]);
        for i in 0..ring.len() {
            let l = dist(ring[i], ring[(i + 1) % ring.len()]);
            along.push(along[i] + l);
            street.push(street[i] + if uses[i] == EdgeUse::Street { l } else { 0.0 });
        }
        Self { along, street }
    }

    fn between(&self, sums: &[f64], a: usize, b: usize) -> f64 {
        let whole = sums[self.along.len() - 1];
        if b > a {
            sums[b] - sums[a]
        } else {
            whole - sums[a] + sums[b]
        }
    }

    /// Distortion of a match and the length of its first side, or nothing if
    /// corners or uses contradict.
    fn distortion(
        &self,
        template: &Template,
        corners: &[Corner],
        area: f64,
        options: &MatchOptions,
    ) -> Option<(f64, f64)> {
        let m = corners.len();
        let mut angle = 0.0;
        for (c, &t) in corners.iter().zip(&template.turns) {
            if c.turn * t <= 0.0 {
                return None;
            }
            angle += (c.turn - t).abs() / std::f64::consts::FRAC_PI_2;
        }
        let mut lengths = Vec::with_capacity(m);
        let mut sum = 0.0;
        for (k, side) in template.sides.iter().enumerate() {
            let (a, b) = (corners[k].vertex, corners[(k + 1) % m].vertex);
            let length = self.between(&self.along, a, b);
            let share = self.between(&self.street, a, b) / length;
            let fits = match side.across {
                SideUse::Street => share >= options.use_share,
                SideUse::NoStreet => share <= 1.0 - options.use_share,
                SideUse::Any => true,
            };
            if !fits {
                return None;
            }
            let (mut fixed, mut least, mut elastic) = (0.0, 0.0, false);
            for e in side.nodes.windows(2) {
                match least_length(template, e[0], e[1]) {
                    Some(l) => {
                        elastic = true;
                        least += l;
                    }
                    None => fixed += norm(template.points[e[1]] - template.points[e[0]]),
                }
            }
            sum += if !elastic {
                (length / fixed).ln().abs()
            } else {
                ((fixed + least) / length).ln().max(0.0)
            };
            lengths.push((length, length - fixed));
        }
        // Edges divided together: their lengths should agree.
        let mut first_divide = None;
        for (d, divide) in template.divides.iter().enumerate() {
            let on: Vec<f64> = template
                .sides
                .iter()
                .zip(&lengths)
                .filter(|(s, _)| {
                    s.nodes
                        .windows(2)
                        .any(|e| divide_of(template, e[0], e[1]) == Some(d))
                })
                .map(|(_, l)| l.1.max(divide.length))
                .collect();
            if on.is_empty() {
                continue;
            }
            let mean = on.iter().sum::<f64>() / on.len() as f64;
            sum += on.iter().map(|l| (l / mean).ln().abs()).sum::<f64>();
            first_divide.get_or_insert(mean);
        }
        if let Some([low, high]) = template.depth {
            let longest = || lengths.iter().map(|l| l.0).fold(0.0, f64::max);
            let depth = area / first_divide.unwrap_or_else(longest);
            if depth < low || depth > high {
                return None;
            }
        }
        Some((sum / m as f64 + 0.5 * angle / m as f64, lengths[0].0))
    }
}
