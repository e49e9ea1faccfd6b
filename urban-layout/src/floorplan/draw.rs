//! From chosen edges and faces to rooms, corridors and doors.
//!
//! A corridor is carved out of the rooms on both sides of its edges, half its
//! width from each, or all of it from one side where the other is the facade, an
//! obstacle or a shaft. What is left of a room is the room; floor that is no
//! room, obstacle or shaft is corridor. So all of them tile the floor. The mesh
//! follows the outline to within what its edges can; what lies between the two
//! goes to the square beside it.

use std::collections::BTreeMap;

use geo_types::{Coord, Polygon};
use network_opt::design::{distances, Tessellation};
use network_opt::floor::Storey;

use super::FloorplanSpec;
use crate::network::inside;
use crate::plane::{cross, dist, dot, left, nearest_on, signed_area, unit};
use crate::site::boolean::{area, difference, intersection, total_area, union};

/// Overlap of strips that go on straight, metres.
const LAP: f64 = 1e-3;

/// A storey ready to be drawn; local metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// The rooms.
    pub rooms: Vec<DrawnRoom>,
    /// The corridors, joined.
    pub corridors: Vec<Polygon<f64>>,
    /// The shafts that take room.
    pub shafts: Vec<DrawnRoom>,
    /// The obstacles: name, whether open to the sky, land.
    pub obstacles: Vec<(String, bool, Vec<Polygon<f64>>)>,
    /// Where people come in, with the unit direction inwards.
    pub entrances: Vec<(Coord<f64>, Coord<f64>)>,
    /// Middle lines of corridors.
    pub lines: Vec<[Coord<f64>; 2]>,
}

/// A room, or a shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnRoom {
    /// What it is called.
    pub name: String,
    /// Its floor.
    pub outline: Polygon<f64>,
    /// Square metres.
    pub area: f64,
    /// Whether it has a window.
    pub window: bool,
    /// Its door onto the corridor.
    pub door: Option<Door>,
}

/// A door in the wall of a room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Door {
    /// Its middle.
    pub at: Coord<f64>,
    /// Unit direction along the wall.
    pub along: Coord<f64>,
    /// Unit direction into the room.
    pub inwards: Coord<f64>,
    /// Metres.
    pub width: f64,
    /// From the corridor there to the nearest entrance or shaft that corridors
    /// lead to, metres along corridors.
    pub away: f64,
}

impl Drawing {
    /// Square metres of all that is drawn.
    #[must_use]
    pub fn area(&self) -> f64 {
        let rooms = self.rooms.iter().chain(&self.shafts);
        let obstacles = self.obstacles.iter().map(|o| total_area(&o.2));
        rooms.map(|r| r.area).sum::<f64>() + self.corridor_area() + obstacles.sum::<f64>()
    }

    /// Square metres of corridors.
    #[must_use]
    pub fn corridor_area(&self) -> f64 {
        total_area(&self.corridors)
    }
}

/// Makes polygons of the plan of a storey; nothing of a storey without one.
/// `outline` is that of the building.
#[must_use]
pub fn draw(
    mesh: &Tessellation,
    storey: &Storey,
    outline: &Polygon<f64>,
    spec: &FloorplanSpec,
) -> Drawing {
    let (Some(network), Some(rooms)) = (
        storey.outcome.network.as_ref(),
        storey.floor.problem.rooms.as_ref(),
    ) else {
        return Drawing::default();
    };
    let land = Land::new(mesh, outline);
    let shafts: Vec<usize> = storey
        .floor
        .shafts
        .iter()
        .filter_map(|s| s.placement)
        .collect();
    let mut carved = vec![false; mesh.faces().len()];
    for &k in network.rooms.iter().filter(|k| !shafts.contains(k)) {
        rooms.placements[k]
            .faces
            .iter()
            .for_each(|&f| carved[f] = true);
    }
    let strips = Strips {
        mesh,
        active: &network.active,
        carved: &carved,
        width: spec.corridor_width,
        entrances: &storey.floor.entrances,
    };
    let corridor = union(&strips.polygons());
    let metres = mean_length(mesh);
    let away: Vec<f64> = distances(&storey.floor.problem, &network.active)
        .into_iter()
        .map(|way| way * metres)
        .collect();
    let mut drawing = Drawing::default();
    let mut floor: Vec<Polygon<f64>> = Vec::new();
    for &k in &network.rooms {
        let placement = &rooms.placements[k];
        let whole = land.of(&placement.faces);
        let is_shaft = shafts.contains(&k);
        let mut pieces = if is_shaft {
            whole
        } else {
            floor.extend(whole.iter().cloned());
            difference(&whole, &corridor)
        };
        // Splinters that a corridor cuts off are part of it.
        pieces.sort_by(|a, b| area(b).total_cmp(&area(a)));
        let Some(outline) = pieces.into_iter().next() else {
            continue;
        };
        let mut doors: Vec<usize> = placement.border.clone();
        doors.retain(|&e| network.active[e]);
        let nearer = |e: usize| {
            let [a, b] = mesh.edges()[e];
            away[a].min(away[b])
        };
        doors.sort_by(|&a, &b| nearer(a).total_cmp(&nearer(b)).then(a.cmp(&b)));
        // Where its leaf has room to swing, if there is such a place.
        let door = [true, false]
            .into_iter()
            .flat_map(|deep| doors.iter().map(move |&e| (e, deep)))
            .find_map(|(e, deep)| {
                let wanted = (spec.door_width, deep);
                strips.door(e, &placement.faces, &outline, wanted, nearer(e))
            })
            .or_else(|| {
                let e = *doors.first()?;
                strips.any_door(e, &outline, spec.door_width, nearer(e))
            });
        let drawn = DrawnRoom {
            name: placement.template.clone(),
            area: area(&outline),
            outline,
            window: placement.border.iter().any(|&e| storey.floor.windows[e]),
            door,
        };
        if is_shaft {
            drawing.shafts.push(drawn);
        } else {
            drawing.rooms.push(drawn);
        }
    }
    let left_over: Vec<Polygon<f64>> = drawing.rooms.iter().map(|r| r.outline.clone()).collect();
    drawing.corridors = difference(&union(&floor), &left_over);
    for (k, obstacle) in storey.specification.obstacles.iter().enumerate() {
        let faces: Vec<usize> = (0..mesh.faces().len())
            .filter(|&f| storey.floor.obstacles[f] == Some(k))
            .collect();
        if !faces.is_empty() {
            let name = obstacle.name.clone();
            drawing
                .obstacles
                .push((name, obstacle.open, land.of(&faces)));
        }
    }
    drawing.entrances = (storey.floor.entrances.iter())
        .map(|&v| (mesh.points()[v], inwards(mesh, v)))
        .collect();
    drawing.lines = (mesh.edges().iter().zip(&network.active))
        .filter(|(_, &on)| on)
        .map(|(ends, _)| ends.map(|v| mesh.points()[v]))
        .collect();
    drawing
}

fn mean_length(mesh: &Tessellation) -> f64 {
    let edges = mesh.edges().len();
    (0..edges).map(|e| mesh.length(e)).sum::<f64>() / edges.max(1) as f64
}

/// The direction into the building from a vertex of its boundary: towards the
/// middle of the faces there.
fn inwards(mesh: &Tessellation, v: usize) -> Coord<f64> {
    let around = mesh.around(v);
    let rim = |e: usize| mesh.faces_of(e).len() == 1;
    let sides: Vec<Coord<f64>> = (around.iter())
        .filter(|&&(e, _)| rim(e))
        .map(|&(_, w)| unit(mesh.points()[w] - mesh.points()[v]))
        .collect();
    let all = around.iter().filter(|&&(e, _)| !rim(e));
    let sum = all.fold(Coord { x: 0.0, y: 0.0 }, |sum, &(_, w)| {
        sum + unit(mesh.points()[w] - mesh.points()[v])
    });
    let sum = if sum == (Coord { x: 0.0, y: 0.0 }) {
        sides.iter().fold(sum, |sum, &d| sum + d)
    } else {
        sum
    };
    match sides.as_slice() {
        // Across the facade, to the side on which the faces are.
        [a, b] if dot(*a, *b) < -0.5 => {
            let normal = left(unit(*a - *b));
            if dot(normal, sum) < 0.0 {
                normal * -1.0
            } else {
                normal
            }
        }
        _ => unit(sum),
    }
}

/// The faces with the land of the building that belongs to them.
struct Land {
    faces: Vec<Vec<Polygon<f64>>>,
}

impl Land {
    fn new(mesh: &Tessellation, outline: &Polygon<f64>) -> Self {
        let ring = |f: usize| {
            let points = mesh.faces()[f].iter().map(|&v| mesh.points()[v]);
            Polygon::new(points.collect(), vec![])
        };
        let mut faces: Vec<Vec<Polygon<f64>>> =
            (0..mesh.faces().len()).map(|f| vec![ring(f)]).collect();
        let all: Vec<Polygon<f64>> = faces.iter().flatten().cloned().collect();
        let building = std::slice::from_ref(outline);
        let cover = union(&all);
        let beyond = !difference(&cover, building).is_empty();
        let rim: Vec<usize> = (mesh.rim().enumerate())
            .filter(|(_, rim)| *rim)
            .map(|(e, _)| e)
            .collect();
        for piece in difference(building, &cover) {
            // It lies between an edge of the mesh and the outline.
            let points = &piece.exterior().0;
            let gap = |v: usize| {
                let p = mesh.points()[v];
                let sides = points
                    .windows(2)
                    .map(|w| dist(nearest_on(w[0], w[1], p).0, p));
                sides.fold(f64::INFINITY, f64::min)
            };
            let away = |e: usize| {
                let [a, b] = mesh.edges()[e];
                gap(a) + gap(b)
            };
            let nearest = rim
                .iter()
                .map(|&e| (away(e), e))
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            if let Some(&f) = nearest.and_then(|(_, e)| mesh.faces_of(e).first()) {
                faces[f].push(piece);
            }
        }
        if beyond {
            for &f in rim.iter().flat_map(|&e| mesh.faces_of(e)) {
                faces[f] = intersection(&faces[f], building);
            }
        }
        Self { faces }
    }

    /// The land of some faces, joined.
    fn of(&self, faces: &[usize]) -> Vec<Polygon<f64>> {
        let all: Vec<Polygon<f64>> = faces
            .iter()
            .flat_map(|&f| &self.faces[f])
            .cloned()
            .collect();
        union(&all)
    }
}

/// What corridors take.
struct Strips<'a> {
    mesh: &'a Tessellation,
    active: &'a [bool],
    /// Faces that a corridor may take land of.
    carved: &'a [bool],
    width: f64,
    entrances: &'a [usize],
}

impl Strips<'_> {
    /// How far a corridor reaches to the left of an edge from `a` on, and to the
    /// right.
    fn reach(&self, e: usize, a: usize) -> [f64; 2] {
        let mut sides = [false; 2];
        for &f in self.mesh.faces_of(e) {
            let face = &self.mesh.faces()[f];
            let at = face.iter().position(|&v| v == a);
            let [p, q] = self.mesh.edges()[e];
            let b = p + q - a;
            // Faces are counter-clockwise: one on the left has the edge as it is.
            let on_left = at.is_some_and(|k| face[(k + 1) % face.len()] == b);
            sides[usize::from(!on_left)] |= self.carved[f];
        }
        match sides {
            [true, true] => [0.5 * self.width; 2],
            [true, false] => [self.width, 0.0],
            [false, true] => [0.0, self.width],
            [false, false] => [0.0; 2],
        }
    }

    /// How far an edge's strip is to reach beyond a vertex where the corridor
    /// goes on nearly straight: else rounding leaves a crack between the two.
    fn lap(&self, e: usize, v: usize) -> f64 {
        let points = self.mesh.points();
        let towards = |w: usize| unit(points[w] - points[v]);
        let [a, b] = self.mesh.edges()[e];
        let back = towards(a + b - v);
        let goes_on =
            self.mesh.around(v).iter().any(|&(other, w)| {
                other != e && self.active[other] && dot(towards(w), back) < -0.8
            });
        if goes_on {
            LAP
        } else {
            0.0
        }
    }

    fn polygons(&self) -> Vec<Polygon<f64>> {
        let points = self.mesh.points();
        let mut found = Vec::new();
        let mut add = |ring: Vec<Coord<f64>>| {
            let ring = if signed_area(&ring) < 0.0 {
                ring.into_iter().rev().collect()
            } else {
                ring
            };
            if signed_area(&ring) > 1e-9 {
                found.push(Polygon::new(ring.into(), vec![]));
            }
        };
        for (e, &[a, b]) in self.mesh.edges().iter().enumerate() {
            if !self.active[e] {
                continue;
            }
            let [l, r] = self.reach(e, a);
            let (mut from, mut to) = (points[a], points[b]);
            let along = unit(to - from);
            let across = left(along);
            // Through the facade, which need not be at a right angle.
            let through = self.mesh.faces_of(e).len() > 1;
            from = from - along * self.lap(e, a);
            to = to + along * self.lap(e, b);
            if through && self.entrances.contains(&a) {
                from = from - along * (0.6 * self.width);
            }
            if through && self.entrances.contains(&b) {
                to = to + along * (0.6 * self.width);
            }
            add(vec![
                from - across * r,
                to - across * r,
                to + across * l,
                from + across * l,
            ]);
        }
        for v in 0..points.len() {
            let mut around: Vec<(usize, usize)> = self.mesh.around(v).to_vec();
            around.retain(|&(e, _)| self.active[e]);
            let n = around.len();
            if n < 2 {
                continue;
            }
            for k in 0..n {
                let ((e0, w0), (e1, w1)) = (around[k], around[(k + 1) % n]);
                let (d0, d1) = (unit(points[w0] - points[v]), unit(points[w1] - points[v]));
                // Counter-clockwise from one to the next: outside of a bend.
                let turn = cross(d0, d1);
                if turn >= -1e-9 {
                    continue;
                }
                let h0 = self.reach(e0, v)[0];
                let h1 = self.reach(e1, v)[1];
                let (p0, p1) = (points[v] + left(d0) * h0, points[v] - left(d1) * h1);
                // Where the two sides meet, if that is not far.
                let t = cross(p1 - p0, d1) / turn;
                let mitre = p0 + d0 * t;
                let mut ring = vec![points[v], p0];
                if dist(mitre, points[v]) < 2.5 * self.width {
                    ring.push(mitre);
                }
                ring.push(p1);
                add(ring);
            }
        }
        found
    }

    /// A door of a room in the wall along an edge, if there is wall enough: in
    /// its middle, or else to one side; `deep` if the room must have space for
    /// it to open.
    fn door(
        &self,
        e: usize,
        faces: &[usize],
        outline: &Polygon<f64>,
        (width, deep): (f64, bool),
        away: f64,
    ) -> Option<Door> {
        let [a, b] = self.mesh.edges()[e];
        let face = self.mesh.faces_of(e).iter().find(|f| faces.contains(f))?;
        let corners = &self.mesh.faces()[*face];
        let k = corners.iter().position(|&v| v == a)?;
        let (a, b) = if corners[(k + 1) % corners.len()] == b {
            (a, b)
        } else {
            (b, a)
        };
        let (from, to) = (self.mesh.points()[a], self.mesh.points()[b]);
        let along = unit(to - from);
        let inwards = left(along);
        let wall = self.reach(e, a)[0];
        for share in [1.0, 0.7] {
            for t in [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8] {
                let at = from + (to - from) * t + inwards * wall;
                // With a hand's breadth of wall on both sides.
                let reach = 0.5 * share * width + 0.1;
                let swing = |side: f64| {
                    let leaf = at + along * (side * width) + inwards * (share * width);
                    inside(outline, leaf)
                };
                if deep && !(swing(0.5 * share) && swing(-0.5 * share)) {
                    continue;
                }
                if (on_wall(outline, at - along * reach) && on_wall(outline, at + along * reach))
                    && on_wall(outline, at)
                {
                    return Some(Door {
                        at,
                        along,
                        inwards,
                        width: share * width,
                        away,
                    });
                }
            }
        }
        None
    }

    /// A door in the wall of a room that is nearest to an edge, where there is no
    /// wall along it.
    fn any_door(&self, e: usize, outline: &Polygon<f64>, width: f64, away: f64) -> Option<Door> {
        let [a, b] = self.mesh.edges()[e].map(|v| self.mesh.points()[v]);
        let middle = (a + b) * 0.5;
        let rings = std::iter::once(outline.exterior()).chain(outline.interiors());
        let walls = rings.flat_map(|ring| ring.0.windows(2));
        // Long enough walls first; of those the nearest.
        let best = walls
            .map(|w| {
                let long = dist(w[0], w[1]);
                let at = (w[0] + w[1]) * 0.5;
                let near = dist(nearest_on(w[0], w[1], middle).0, middle);
                (long < 0.7 * width, near, at, unit(w[1] - w[0]), long)
            })
            .min_by(|x, y| x.0.cmp(&y.0).then(x.1.total_cmp(&y.1)))?;
        let (_, _, at, along, long) = best;
        Some(Door {
            at,
            along,
            inwards: left(along),
            width: width.min(0.9 * long),
            away,
        })
    }
}

/// Whether a point lies on the boundary of a polygon, to within a few
/// centimetres.
fn on_wall(polygon: &Polygon<f64>, p: Coord<f64>) -> bool {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    rings
        .flat_map(|ring| ring.0.windows(2))
        .any(|w| dist(nearest_on(w[0], w[1], p).0, p) < 0.03)
}

/// The kinds of rooms in the order of the specification, with how many there are
/// and their area.
pub(crate) fn kinds(storey: &Storey, drawing: &Drawing) -> Vec<(String, usize, f64)> {
    let mut sums: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
    for room in &drawing.rooms {
        let sum = sums.entry(&room.name).or_default();
        *sum = (sum.0 + 1, sum.1 + room.area);
    }
    (storey.specification.rooms.iter())
        .filter_map(|kind| {
            let &(count, area) = sums.get(kind.name.as_str())?;
            Some((kind.name.clone(), count, area))
        })
        .collect()
}
