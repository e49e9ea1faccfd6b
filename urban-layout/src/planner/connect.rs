//! One network, leading out: streets that join components of the network, or
//! lead one to an exit, where the splits alone did not.

use std::collections::BTreeMap;

use geo_types::Coord;
use network_opt::VertexId;

use crate::layout::Lineage;
use crate::network::{Network, SideKind};
use crate::options::PlanOptions;
use crate::plane::dist;
use crate::planner::{apply, faults, Pending, Tree};
use crate::region::{Place, Region};
use crate::site::Site;
use crate::splitter::{Cut, CutMaker, Path2, Scene, Ways};

/// Streets tried between the places of one region, nearest pairs first.
const TRIED: usize = 600;
/// Spacing of the places tried along a side, metres.
const SPACING: f64 = 12.0;

/// Lays connecting streets until none is missing or none can be laid. Returns
/// the regions that arise, to be split and filled anew.
pub(super) fn connect(tree: &mut Tree, site: &Site, options: &PlanOptions) -> Vec<Pending> {
    let mut out: Vec<Pending> = Vec::new();
    // Each street joins two components, so there cannot be more rounds.
    let most = tree.network.mesh.faces().count() + 1;
    for _ in 0..most {
        let components = Components::of(&tree.network, site);
        if components.satisfied(site.parts.len()) {
            break;
        }
        let open: Vec<Pending> = out
            .iter()
            .cloned()
            .chain(
                tree.leaves
                    .values()
                    .map(|l| Pending::new(l.face, l.path.clone())),
            )
            .collect();
        let found = super::parallel::map(&open, options.threads, |p| {
            let region = tree.region(p.face, &p.path, options.seed);
            let home = region.loops.first().and_then(|l| {
                let inner = crate::plane::inner_point(
                    &region
                        .loops
                        .iter()
                        .map(|l| l.points.clone())
                        .collect::<Vec<_>>(),
                );
                let p = inner.or(l.points.first().copied())?;
                site.parts.iter().position(|q| crate::network::inside(q, p))
            });
            // Land that has no street yet gets its first one here.
            let first = home.is_some_and(|h| !components.part.contains(&h));
            best_link(&tree.network, &region, &components, options, first)
        });
        let mut order: Vec<(f64, usize, Vec<Cut>)> = found
            .into_iter()
            .enumerate()
            .filter_map(|(i, f)| f.map(|(cost, cuts)| (cost, i, cuts)))
            .collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        // Links that keep the laws of streets first; a network in pieces is
        // worse than a link that does not.
        let joined = [true, false].into_iter().any(|lawful| {
            order.iter().any(|(_, i, cuts)| {
                let p = &open[*i];
                let Some(children) = link(tree, p, cuts, options, lawful) else {
                    return false;
                };
                tree.leaves.remove(&p.path);
                out.retain(|q| q.path != p.path);
                out.extend(children);
                true
            })
        });
        if !joined {
            break;
        }
    }
    out
}

/// Lays the first of `cuts` that can be laid, if `lawful` without breaking a
/// law of streets.
fn link(
    tree: &mut Tree,
    p: &Pending,
    cuts: &[Cut],
    options: &PlanOptions,
    lawful: bool,
) -> Option<Vec<Pending>> {
    let lineage = Lineage {
        split: p.path.to_string(),
        by: "connector".to_owned(),
        ..Lineage::default()
    };
    let before = faults(&tree.network, options);
    cuts.iter().find_map(|cut| {
        let kept = lawful.then(|| tree.network.clone());
        let one = std::slice::from_ref(cut);
        let children = apply(tree, p, one, &lineage, options, CutMaker::TIGHT - 0.05)?;
        match kept {
            Some(kept) if faults(&tree.network, options) > before => {
                tree.network = kept;
                None
            }
            _ => Some(children),
        }
    })
}

/// Whether each part of the site has one network of streets, which leads out.
pub(crate) fn is_connected(tree: &Tree, site: &Site) -> bool {
    Components::of(&tree.network, site).satisfied(site.parts.len())
}

/// The connected components of the streets, and which of them lead out.
pub(super) struct Components {
    pub(super) of: BTreeMap<VertexId, usize>,
    /// Per component: does it reach a way out of the site?
    pub(super) out: Vec<bool>,
    /// Per component: the site's part it lies in.
    pub(super) part: Vec<usize>,
}

impl Components {
    pub(super) fn of(network: &Network, site: &Site) -> Self {
        let mesh = &network.mesh;
        let mut of: BTreeMap<VertexId, usize> = BTreeMap::new();
        let (mut out, mut part) = (Vec::new(), Vec::new());
        for start in mesh.vertices() {
            if of.contains_key(&start) || network.streets_at(start).is_empty() {
                continue;
            }
            let id = out.len();
            let (mut stack, mut leads, mut home) = (vec![start], false, 0);
            of.insert(start, id);
            while let Some(v) = stack.pop() {
                leads |= is_exit(network, v);
                let p = mesh.point(v);
                home = site
                    .parts
                    .iter()
                    .position(|q| crate::network::inside(q, p))
                    .unwrap_or(home);
                for h in network.streets_at(v) {
                    let w = mesh.dest(h);
                    if of.insert(w, id).is_none() {
                        stack.push(w);
                    }
                }
            }
            out.push(leads);
            part.push(home);
        }
        Self { of, out, part }
    }

    /// Vertices of each component.
    pub(super) fn sizes(&self) -> Vec<usize> {
        let mut sizes = vec![0; self.out.len()];
        for &component in self.of.values() {
            sizes[component] += 1;
        }
        sizes
    }

    /// One component in each part of the site, each leading out.
    fn satisfied(&self, parts: usize) -> bool {
        (0..parts).all(|p| self.part.iter().filter(|&&q| q == p).count() == 1)
            && self.out.iter().all(|&o| o)
    }
}

/// Whether a street that ends at this vertex leads out of the site.
pub(crate) fn is_exit(network: &Network, v: VertexId) -> bool {
    let mesh = &network.mesh;
    let on_boundary = mesh
        .outgoing(v)
        .any(|h| mesh.attr(h).kind == SideKind::Boundary);
    if !on_boundary {
        return false;
    }
    let given = network
        .streets_at(v)
        .iter()
        .any(|&h| network.street_of(h).is_some_and(|s| s.given));
    given || !network.restricted_exits || network.zones.covers(mesh.point(v))
}

/// A place from which a link may start, or where it may end.
struct Spot {
    place: Place,
    inward: Coord<f64>,
    /// The component of the street here; `None` at the site's boundary.
    component: Option<usize>,
    /// A street that ends here leads out of the site.
    exit: bool,
}

/// The cheapest links across a region that are still wanted, best first.
fn best_link(
    network: &Network,
    region: &Region,
    components: &Components,
    options: &PlanOptions,
    first: bool,
) -> Option<(f64, Vec<Cut>)> {
    let spots = spots(network, region, components);
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (i, a) in spots.iter().enumerate() {
        for (j, b) in spots.iter().enumerate() {
            let wanted = match (a.component, b.component) {
                (Some(ca), Some(cb)) => cb > ca && components.part[ca] == components.part[cb],
                (Some(ca), None) => b.exit && !components.out[ca],
                (None, None) => first && a.exit && i != j,
                (None, Some(_)) => false,
            };
            if wanted {
                let along = crate::plane::unit(b.place.at - a.place.at);
                let skew =
                    2.0 - crate::plane::dot(along, a.inward) + crate::plane::dot(along, b.inward);
                let path = Path2 {
                    from: a.place,
                    to: b.place,
                    points: vec![a.place.at, b.place.at],
                };
                // A first street should have land on both sides.
                let lopsided = if first {
                    10.0 * crate::splitter::imbalance(region, &path)
                } else {
                    0.0
                };
                pairs.push((dist(a.place.at, b.place.at) * (1.0 + skew + lopsided), i, j));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let scene = Scene {
        network,
        options,
        draft: true,
    };
    let maker = CutMaker::new(&scene, region).without_room();
    let mut cuts = Vec::new();
    let mut cost = None;
    for (c, i, j) in pairs.into_iter().take(TRIED) {
        let (a, b) = (spots[i].place, spots[j].place);
        if let Some(cut) = maker.make(&Path2 {
            from: a,
            to: b,
            points: vec![a.at, b.at],
        }) {
            cost.get_or_insert(c);
            cuts.push(cut);
            if cuts.len() >= 4 {
                break;
            }
        }
    }
    if cuts.is_empty() {
        let (link, length) = winding_link(region, &maker, &spots, components, first)?;
        // Straight links are preferred, whatever their length.
        return Some((1e6 + length, vec![link]));
    }
    cost.map(|c| (c, cuts))
}

/// A link that follows the shape of the region, and its length.
fn winding_link(
    region: &Region,
    maker: &CutMaker<'_>,
    spots: &[Spot],
    components: &Components,
    first: bool,
) -> Option<(Cut, f64)> {
    let mut own: Vec<usize> = spots.iter().filter_map(|s| s.component).collect();
    own.sort_unstable();
    own.dedup();
    let lead = *own.first()?;
    if first || (own.len() < 2 && components.out[lead]) {
        return None;
    }
    let from: Vec<&Spot> = spots.iter().filter(|s| s.component == Some(lead)).collect();
    let to: Vec<&Spot> = spots
        .iter()
        .filter(|s| match s.component {
            Some(c) => c != lead && components.part[c] == components.part[lead],
            None => s.exit && !components.out[lead],
        })
        .collect();
    let place = |s: &&Spot| s.place.at;
    let starts: Vec<Coord<f64>> = from.iter().map(place).collect();
    let goals: Vec<Coord<f64>> = to.iter().map(place).collect();
    let (i, j, points) = Ways::of(region)?.path(&starts, &goals)?;
    let length = crate::plane::length(&points);
    let cut = maker.make(&Path2 {
        from: from[i].place,
        to: to[j].place,
        points,
    })?;
    Some((cut, length))
}

/// Places along a region's streets and exits.
fn spots(network: &Network, region: &Region, components: &Components) -> Vec<Spot> {
    region
        .places(SPACING)
        .into_iter()
        .filter_map(|place| {
            let l = &region.loops[place.ring];
            let (component, exit) = match l.sides[place.edge].kind {
                SideKind::Street => {
                    let component = components.of.get(&l.vertices[place.edge]);
                    (component.copied(), false)
                }
                SideKind::Boundary => {
                    let exit = !network.restricted_exits || network.zones.covers(place.at);
                    (None, exit)
                }
                SideKind::Element => return None,
            };
            let (a, b) = l.edge(place.edge);
            Some(Spot {
                place,
                inward: crate::plane::left(crate::plane::unit(b - a)),
                component,
                exit,
            })
        })
        .collect()
}
