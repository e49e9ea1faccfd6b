//! From a [`FloorSpecification`] to a [`Problem`] on a mesh.

use std::collections::BTreeMap;

use geo_types::Coord;

use super::place::{placement, placements};
use super::spec::{FloorSpecification, Place, Room, Shaft, ShaftRole};
use crate::design::{
    EdgeState, Feature, Pattern, PatternKind, Placement, Problem, Rim, RoomCount, RoomWish, Rooms,
    Sinks, Specification, Tessellation,
};
use crate::error::DesignError;

/// A storey on its mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Floor {
    /// What is asked: the rooms of a [`FloorSpecification`] by name, then one
    /// for each shaft that takes faces, which is placed in every valid answer.
    pub problem: Problem,
    /// The vertices at which people come in.
    pub entrances: Vec<usize>,
    /// The shafts.
    pub shafts: Vec<ShaftPlace>,
    /// The obstacle on each face, by its position in
    /// [`FloorSpecification::obstacles`].
    pub obstacles: Vec<Option<usize>>,
    /// Whether each edge has windows: the facade, and the borders of obstacles
    /// that are open to the sky.
    pub windows: Vec<bool>,
}

/// Where a shaft came to lie.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaftPlace {
    /// Its faces; none for a mere vertex.
    pub faces: Vec<usize>,
    /// The vertex at which one leaves it: passed by a corridor, or a sink.
    pub landing: usize,
    /// Its position among the placements; none for a mere vertex.
    pub placement: Option<usize>,
}

fn bad<T>(what: String) -> Result<T, DesignError> {
    Err(DesignError::BadFloor { what })
}

impl FloorSpecification {
    /// What the specification means on a mesh with these shafts. Lengths are
    /// counted in mean edges, as by [`Specification::on`].
    ///
    /// A shaft that takes faces is a room that is there in any case; its door is
    /// at its landing, the corner of it that is farthest from the facade. So a
    /// corridor passes there, whatever the role of shafts is.
    ///
    /// # Errors
    ///
    /// [`DesignError::BadFloor`] for names that come twice or are not there,
    /// places outside the mesh, shafts that lie on each other or on obstacles or
    /// fit nowhere, a face that no room fits on, and rooms whose numbers of faces
    /// cannot add up to that of the floor; [`DesignError::BadProblem`] for
    /// weights out of their range.
    ///
    /// # Examples
    ///
    /// ```
    /// use network_opt::floor::FloorSpecification;
    /// use network_opt::geo_types::polygon;
    /// use network_opt::quad::{quads, QuadOptions};
    /// use network_opt::solve::{Limits, NetworkSolver, Search};
    ///
    /// let hall = polygon![(x: 0., y: 0.), (x: 18., y: 0.), (x: 18., y: 12.), (x: 0., y: 12.)];
    /// let mesh = quads(&hall, &QuadOptions { edge_length: 3.0, ..QuadOptions::default() })?;
    /// let floor = FloorSpecification::default().on(&mesh, &[])?;
    /// let search = Search { moves: Some(3000) };
    /// let limits = Limits { deadline: None, ..Limits::default() };
    /// let found = search.solve(&floor.problem, None, &limits, &mut |_| true)?;
    /// let rooms = found.network.expect("a plan").rooms;
    /// // 24 squares in rooms of at most six.
    /// assert!(rooms.len() >= 4);
    /// # Ok::<(), network_opt::DesignError>(())
    /// ```
    pub fn on(&self, mesh: &Tessellation, shafts: &[Shaft]) -> Result<Floor, DesignError> {
        self.check(mesh)?;
        let middles: Vec<Coord<f64>> = (0..mesh.faces().len()).map(|f| middle(mesh, f)).collect();
        let obstacles = self.obstacle_faces(&middles);
        let mut free: Vec<bool> = obstacles.iter().map(Option::is_none).collect();
        let rim: Vec<bool> = mesh.rim().collect();
        let mut places = Vec::new();
        for shaft in shafts {
            places.push(place_shaft(mesh, &rim, &middles, shaft, &mut free)?);
        }
        let closed = self.closed_edges(mesh, &obstacles, &places);
        let windows: Vec<bool> = (0..mesh.edges().len())
            .map(|e| rim[e] || self.is_open_border(mesh, &obstacles, e))
            .collect();
        let entrances = self.entrance_vertices(mesh, &rim, &closed, shafts.is_empty())?;
        let as_sinks = match self.shafts {
            ShaftRole::Auto => entrances.is_empty(),
            ShaftRole::Pass => false,
            ShaftRole::Sinks => true,
        };
        let mut sinks = entrances.clone();
        if as_sinks {
            sinks.extend(places.iter().map(|p| p.landing));
        }
        if sinks.is_empty() {
            return bad("there is neither an entrance nor a shaft that corridors lead to".into());
        }
        let mut problem = self.network(sinks).on(mesh)?;
        problem.coverage.clear();
        for (e, closed) in closed.iter().enumerate() {
            if *closed {
                problem.states[e] = EdgeState::Closed;
            }
        }
        if let Feature::Weighted(cost) = self.facade {
            let along = (0..mesh.edges().len()).filter(|&e| rim[e] && !closed[e]);
            problem.patterns.extend(along.map(|e| Pattern {
                kind: PatternKind::Facade,
                active: vec![e],
                inactive: vec![],
                cost: Some(cost),
            }));
        }
        // An entrance, or a lift, that no corridor leads to is none.
        let bare = places.iter().filter(|p| p.faces.is_empty());
        problem.required_vertices.extend(&entrances);
        problem.required_vertices.extend(bare.map(|p| p.landing));
        let here: Vec<Coord<f64>> = entrances.iter().map(|&v| mesh.points()[v]).collect();
        let mut rooms = self.rooms(mesh, &middles, &free, &windows, &here)?;
        for (place, shaft) in places.iter_mut().zip(shafts) {
            if place.faces.is_empty() {
                continue;
            }
            place.placement = Some(rooms.placements.len());
            let mut own = placement(mesh, &shaft.name, place.faces.clone());
            own.border
                .retain(|&e| mesh.edges()[e].contains(&place.landing));
            place.faces.iter().for_each(|&f| rooms.covered[f] = true);
            rooms.placements.push(own);
        }
        problem.rooms = Some(rooms);
        problem.check()?;
        Ok(Floor {
            problem,
            entrances,
            shafts: places,
            obstacles,
            windows,
        })
    }

    fn check(&self, mesh: &Tessellation) -> Result<(), DesignError> {
        if self.rooms.is_empty() {
            return bad("there is no kind of room".into());
        }
        let mut names: Vec<&str> = self.rooms.iter().map(|r| r.name.as_str()).collect();
        names.sort_unstable();
        if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            return bad(format!("two kinds of rooms are called {:?}", pair[0]));
        }
        for room in &self.rooms {
            let name = &room.name;
            if name.is_empty() {
                return bad("a kind of room has no name".into());
            }
            if room.shapes.is_empty() {
                return bad(format!("{name:?} has no shape"));
            }
            let others = room.beside.iter().map(|b| &b.room).chain(&room.apart);
            if let Some(other) = others.into_iter().find(|o| !names.contains(&o.as_str())) {
                return bad(format!(
                    "{name:?} names {other:?}, which is no kind of room"
                ));
            }
            let edges = room.touching.iter().chain(&room.avoiding);
            if let Some(e) = edges.into_iter().find(|&&e| e >= mesh.edges().len()) {
                return bad(format!(
                    "{name:?} names edge {e}, of {}",
                    mesh.edges().len()
                ));
            }
            let areas = [Some(room.least_area), room.most_area];
            let near = room.near_entrance.map(|near| near.within);
            let mut numbers = areas.into_iter().chain([Some(room.cost), near]).flatten();
            if let Some(x) = numbers.find(|x| !(*x >= 0.0 && x.is_finite())) {
                return bad(format!("{name:?} has a number {x}; give 0 or more"));
            }
        }
        let faces = mesh.faces().len();
        let mut named = self.obstacles.iter().flat_map(|o| &o.faces);
        if let Some(f) = named.find(|&&f| f >= faces) {
            return bad(format!("an obstacle is on face {f}, of {faces}"));
        }
        Ok(())
    }

    /// The specification of the corridors.
    fn network(&self, sinks: Vec<usize>) -> Specification {
        Specification {
            length: self.length,
            travel: self.travel,
            sinks: Sinks::At(sinks),
            rim: match self.facade {
                Feature::Forbidden => Rim::Closed,
                Feature::Free | Feature::Weighted(_) => Rim::Open,
            },
            dead_ends: self.dead_ends,
            branches: self.branches,
            zig_zags: self.zig_zags,
            too_close: self.too_close,
            t_junctions: self.t_junctions,
            ..Specification::default()
        }
    }

    fn obstacle_faces(&self, middles: &[Coord<f64>]) -> Vec<Option<usize>> {
        let at = |(f, m): (usize, &Coord<f64>)| {
            (self.obstacles.iter()).position(|o| o.faces.contains(&f) || is_inside(&o.polygon, *m))
        };
        middles.iter().enumerate().map(at).collect()
    }

    /// Edges on which no corridor can be: inside an obstacle or a shaft, and
    /// where an obstacle lies along the facade.
    fn closed_edges(
        &self,
        mesh: &Tessellation,
        obstacles: &[Option<usize>],
        shafts: &[ShaftPlace],
    ) -> Vec<bool> {
        let mut taken: Vec<Option<usize>> = obstacles.to_vec();
        for (k, shaft) in shafts.iter().enumerate() {
            (shaft.faces.iter()).for_each(|&f| taken[f] = Some(self.obstacles.len() + k));
        }
        let closed = |e: usize| {
            let faces = mesh.faces_of(e);
            // Beside two obstacles there is nobody to walk for.
            faces.iter().all(|&f| taken[f].is_some())
        };
        (0..mesh.edges().len()).map(closed).collect()
    }

    fn is_open_border(&self, mesh: &Tessellation, obstacles: &[Option<usize>], e: usize) -> bool {
        let on = |&f: &usize| obstacles[f];
        let mut sides = mesh.faces_of(e).iter().map(on);
        let open = |o: Option<usize>| o.is_some_and(|o| self.obstacles[o].open);
        let (a, b) = (sides.next().flatten(), sides.next().flatten());
        open(a) && b.is_none() || open(b) && a.is_none()
    }

    fn entrance_vertices(
        &self,
        mesh: &Tessellation,
        rim: &[bool],
        closed: &[bool],
        alone: bool,
    ) -> Result<Vec<usize>, DesignError> {
        let along_facade = self.facade != Feature::Forbidden;
        let leads_in = |v: usize| {
            let around = mesh.around(v);
            around.iter().any(|&(e, _)| rim[e])
                && (around.iter()).any(|&(e, _)| !closed[e] && (along_facade || !rim[e]))
        };
        if self.entrances.is_empty() {
            let none = !alone || self.shafts == ShaftRole::Sinks;
            let at = if none {
                None
            } else {
                front(mesh, rim, &leads_in)
            };
            return Ok(at.into_iter().collect());
        }
        let mut found = Vec::new();
        for place in &self.entrances {
            let v = match *place {
                Place::Vertex(v) if v >= mesh.points().len() => {
                    return bad(format!(
                        "an entrance is at vertex {v}, of {}",
                        mesh.points().len()
                    ));
                }
                Place::Vertex(v) if !leads_in(v) => {
                    return bad(format!(
                        "an entrance is at vertex {v}, from which no corridor can lead inside"
                    ));
                }
                Place::Vertex(v) => Some(v),
                Place::Point(p) => nearest(mesh, finite(p, "an entrance")?, &leads_in),
            };
            match v {
                Some(v) if !found.contains(&v) => found.push(v),
                Some(_) => {}
                None => return bad("no corridor can lead inside from anywhere".into()),
            }
        }
        Ok(found)
    }

    /// All rooms that may be placed, with counts and wishes.
    fn rooms(
        &self,
        mesh: &Tessellation,
        middles: &[Coord<f64>],
        free: &[bool],
        windows: &[bool],
        entrances: &[Coord<f64>],
    ) -> Result<Rooms, DesignError> {
        let mut rooms = Rooms {
            covered: free.to_vec(),
            ..Rooms::default()
        };
        let mut of_kind: Vec<std::ops::Range<usize>> = Vec::new();
        let mut sizes: Vec<usize> = Vec::new();
        for room in &self.rooms {
            let first = rooms.placements.len();
            let mut own: BTreeMap<Vec<usize>, Placement> = BTreeMap::new();
            for shape in &room.shapes {
                let found = placements(mesh, &room.name, shape, room.mirrored, self.irregular);
                let fits = found.into_iter().filter(|p| {
                    p.faces.iter().all(|&f| free[f]) && is_allowed(room, mesh, middles, p)
                });
                own.extend(fits.map(|p| (p.faces.clone(), p)));
            }
            for placement in own.into_values() {
                let mut cost = Some(room.cost);
                let mut add = |wanted: Option<Option<f64>>, granted: bool| {
                    if let (Some(wanted), false) = (wanted, granted) {
                        cost = cost.zip(wanted).map(|(a, b)| a + b);
                    }
                };
                let window = placement.border.iter().any(|&e| windows[e]);
                add(room.window.cost(), window);
                if let Some(near) = room.near_entrance {
                    let at = centre(middles, &placement.faces);
                    let way = |&c: &Coord<f64>| distance(c, at);
                    let away = entrances.iter().map(way).fold(f64::INFINITY, f64::min);
                    add(near.wish.cost(), away <= near.within);
                }
                // What is demanded and not there is no place for the room.
                let Some(cost) = cost else { continue };
                if cost > 0.0 {
                    rooms.wishes.push(RoomWish {
                        when: vec![rooms.placements.len()],
                        then: vec![],
                        cost: Some(cost),
                    });
                }
                sizes.push(placement.faces.len());
                rooms.placements.push(placement);
            }
            let last = rooms.placements.len();
            if room.least > 0 || room.most.is_some() {
                rooms.counts.push(RoomCount {
                    name: room.name.clone(),
                    rooms: (first..last).collect(),
                    least: room.least,
                    most: room.most,
                });
                if last - first < room.least {
                    return bad(format!(
                        "there is room for {} of {:?}, of which there are to be {} at least",
                        last - first,
                        room.name,
                        room.least
                    ));
                }
            }
            of_kind.push(first..last);
        }
        self.is_there_a_room_everywhere(&rooms, middles, &sizes)?;
        self.neighbours(mesh, &of_kind, &mut rooms);
        Ok(rooms)
    }

    fn is_there_a_room_everywhere(
        &self,
        rooms: &Rooms,
        middles: &[Coord<f64>],
        sizes: &[usize],
    ) -> Result<(), DesignError> {
        let mut fits = vec![false; rooms.covered.len()];
        let faces = rooms.placements.iter().flat_map(|p| &p.faces);
        faces.for_each(|&f| fits[f] = true);
        let bare = (0..fits.len()).filter(|&f| rooms.covered[f] && !fits[f]);
        let bare: Vec<usize> = bare.collect();
        if let Some(&f) = bare.first() {
            return bad(format!(
                "no room fits on {} of the squares, such as the one at ({:.2}, {:.2}); allow smaller shapes, or make it an obstacle",
                bare.len(),
                middles[f].x,
                middles[f].y
            ));
        }
        let count = rooms.covered.iter().filter(|c| **c).count();
        let step = sizes.iter().copied().fold(0, common);
        if step > 1 && count % step != 0 {
            return bad(format!(
                "the floor has {count} squares, and all rooms have multiples of {step}; allow another shape"
            ));
        }
        Ok(())
    }

    /// Wishes and demands about walls in common.
    fn neighbours(
        &self,
        mesh: &Tessellation,
        of_kind: &[std::ops::Range<usize>],
        rooms: &mut Rooms,
    ) {
        let kind = |name: &str| self.rooms.iter().position(|r| r.name == name);
        // By edge and side the placements of a kind that have it on their border.
        let walls = |k: usize| {
            let mut walls: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
            for p in of_kind[k].clone() {
                let placement = &rooms.placements[p];
                for &e in &placement.border {
                    let side = mesh
                        .faces_of(e)
                        .iter()
                        .find(|f| placement.faces.contains(f));
                    if let Some(&f) = side {
                        walls.entry((e, f)).or_default().push(p);
                    }
                }
            }
            walls
        };
        let across = |e: usize, f: usize| mesh.faces_of(e).iter().copied().find(|&g| g != f);
        let (mut wishes, mut counts) = (Vec::new(), Vec::new());
        for (k, room) in self.rooms.iter().enumerate() {
            for beside in &room.beside {
                let (Some(cost), Some(other)) = (beside.wish.cost(), kind(&beside.room)) else {
                    continue;
                };
                let walls = walls(other);
                for p in of_kind[k].clone() {
                    let placement = &rooms.placements[p];
                    let mut then = Vec::new();
                    for &e in &placement.border {
                        let faces = mesh.faces_of(e).iter();
                        let there = faces.filter(|f| !placement.faces.contains(f));
                        let there = there.filter_map(|&f| walls.get(&(e, f))).flatten();
                        // A room across the wall must not be in the way.
                        then.extend(there.copied().filter(|&q| {
                            let faces = &rooms.placements[q].faces;
                            faces.iter().all(|f| !placement.faces.contains(f))
                        }));
                    }
                    then.sort_unstable();
                    then.dedup();
                    wishes.push(RoomWish {
                        when: vec![p],
                        then,
                        cost,
                    });
                }
            }
            let own = if room.apart.is_empty() {
                BTreeMap::new()
            } else {
                walls(k)
            };
            for name in &room.apart {
                let Some(other) = kind(name) else { continue };
                let others = walls(other);
                for (&(e, f), here) in &own {
                    // Two of one kind are met from both sides; once is enough.
                    let Some(g) = across(e, f).filter(|&g| other != k || f < g) else {
                        continue;
                    };
                    if let Some(there) = others.get(&(e, g)) {
                        // No face has two rooms, so this is one on each side.
                        counts.push(RoomCount {
                            name: format!("{} beside {name}", room.name),
                            rooms: here.iter().chain(there).copied().collect(),
                            least: 0,
                            most: Some(1),
                        });
                    }
                }
            }
        }
        rooms.wishes.extend(wishes);
        rooms.counts.extend(counts);
    }
}

/// Whether a room may be there, whatever else is.
fn is_allowed(room: &Room, mesh: &Tessellation, middles: &[Coord<f64>], p: &Placement) -> bool {
    let touches = |edges: &[usize]| edges.iter().any(|e| p.border.contains(e));
    let area = || -> f64 { p.faces.iter().map(|&f| area(mesh, f)).sum() };
    (room.touching.is_empty() || touches(&room.touching))
        && !touches(&room.avoiding)
        && (room.within.is_empty()
            || (p.faces.iter()).all(|&f| is_inside(&room.within, middles[f])))
        && (room.least_area == 0.0 || area() >= room.least_area)
        && room.most_area.is_none_or(|most| area() <= most)
}

/// The faces and the landing of a shaft; takes the faces out of `free`.
fn place_shaft(
    mesh: &Tessellation,
    rim: &[bool],
    middles: &[Coord<f64>],
    shaft: &Shaft,
    free: &mut [bool],
) -> Result<ShaftPlace, DesignError> {
    let name = &shaft.name;
    let vertices = mesh.points().len();
    let inside = |v: usize| mesh.around(v).iter().all(|&(e, _)| !rim[e]);
    let serves = |v: usize| {
        let faces = mesh.around(v).iter().flat_map(|&(e, _)| mesh.faces_of(e));
        inside(v) && faces.into_iter().any(|&f| free[f])
    };
    let at = match shaft.at {
        Place::Vertex(v) if v >= vertices => {
            return bad(format!("{name:?} is at vertex {v}, of {vertices}"));
        }
        Place::Vertex(v) => mesh.points()[v],
        Place::Point(p) => finite(p, name)?,
    };
    let Some(shape) = &shaft.shape else {
        let landing = match shaft.at {
            Place::Vertex(v) => Some(v),
            Place::Point(_) => nearest(mesh, at, &serves),
        };
        return match landing {
            Some(landing) => Ok(ShaftPlace {
                faces: vec![],
                landing,
                placement: None,
            }),
            None => bad(format!("there is no place inside for {name:?}")),
        };
    };
    let hops = hops_from(mesh, rim);
    // The corner farthest from the facade that has something to lead to.
    let landing = |faces: &[usize]| {
        let corners = faces.iter().flat_map(|&f| &mesh.faces()[f]).copied();
        let leads = |v: usize| {
            let around = mesh.around(v).iter();
            let mut beside = around.flat_map(|&(e, _)| mesh.faces_of(e));
            beside.any(|f| free[*f] && !faces.contains(f))
        };
        corners
            .filter(|&v| leads(v))
            .max_by_key(|&v| (hops[v], std::cmp::Reverse(v)))
    };
    let best = placements(mesh, name, shape, true, true)
        .into_iter()
        .filter(|p| p.faces.iter().all(|&f| free[f]))
        .filter_map(|p| {
            let landing = landing(&p.faces)?;
            // One without a corner inside can only be reached along the facade.
            let outside = hops[landing] == 0;
            Some((
                outside,
                distance(centre(middles, &p.faces), at),
                p.faces,
                landing,
            ))
        })
        .min_by(|a, b| {
            (a.0.cmp(&b.0))
                .then(a.1.total_cmp(&b.1))
                .then(a.2.cmp(&b.2))
        });
    let Some((_, _, faces, landing)) = best else {
        return bad(format!(
            "there is no place for {name:?} of the shape {shape}"
        ));
    };
    faces.iter().for_each(|&f| free[f] = false);
    Ok(ShaftPlace {
        faces,
        landing,
        placement: None,
    })
}

/// Edges from each vertex to the rim.
fn hops_from(mesh: &Tessellation, rim: &[bool]) -> Vec<usize> {
    let mut hops = vec![usize::MAX; mesh.points().len()];
    let mut queue = std::collections::VecDeque::new();
    for (ends, _) in mesh.edges().iter().zip(rim).filter(|(_, rim)| **rim) {
        for &v in ends {
            if hops[v] != 0 {
                hops[v] = 0;
                queue.push_back(v);
            }
        }
    }
    while let Some(v) = queue.pop_front() {
        for &(_, w) in mesh.around(v) {
            if hops[w] == usize::MAX {
                hops[w] = hops[v] + 1;
                queue.push_back(w);
            }
        }
    }
    hops
}

/// The vertex nearest to the middle of the longest straight run of the outer
/// boundary from which a corridor can lead inside, one by an inner edge first.
fn front(mesh: &Tessellation, rim: &[bool], leads_in: &dyn Fn(usize) -> bool) -> Option<usize> {
    let mut best: Option<(f64, Coord<f64>)> = None;
    for ring in rings(mesh, rim) {
        let n = ring.len();
        let at = |k: usize| mesh.points()[ring[k % n]];
        let turns = |k: usize| {
            let (a, b, c) = (at(k + n - 1), at(k), at(k + 1));
            let (u, v) = (b - a, c - b);
            (u.x * v.y - u.y * v.x).atan2(u.x * v.x + u.y * v.y).abs() > 20_f64.to_radians()
        };
        let corners: Vec<usize> = (0..n).filter(|&k| turns(k)).collect();
        for (i, &from) in corners.iter().enumerate() {
            let to = corners.get(i + 1).copied().unwrap_or(corners[0] + n);
            let steps = (from..to).map(|k| distance(at(k), at(k + 1)));
            let length: f64 = steps.clone().sum();
            if best.is_some_and(|(longest, _)| length <= longest + 1e-9) {
                continue;
            }
            let (mut gone, mut middle) = (0.0, at(from));
            for (k, step) in (from..to).zip(steps) {
                if gone <= 0.5 * length {
                    let part = if step > 0.0 {
                        (0.5 * length - gone) / step
                    } else {
                        0.0
                    };
                    middle = at(k) + (at(k + 1) - at(k)) * part.min(1.0);
                }
                gone += step;
            }
            best = Some((length, middle));
        }
    }
    // A boundary without corners is round: anywhere will do.
    let middle = best.map_or_else(|| mesh.points().first().copied(), |(_, m)| Some(m))?;
    let inner = |v: usize| leads_in(v) && mesh.around(v).iter().any(|&(e, _)| !rim[e]);
    nearest(mesh, middle, &inner).or_else(|| nearest(mesh, middle, leads_in))
}

/// The loops of the boundary, the face on the left, by vertices.
fn rings(mesh: &Tessellation, rim: &[bool]) -> Vec<Vec<usize>> {
    let mut next: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (f, face) in mesh.faces().iter().enumerate() {
        for (k, &e) in mesh.edges_of(f).iter().enumerate() {
            if rim[e] {
                next.entry(face[k])
                    .or_default()
                    .push(face[(k + 1) % face.len()]);
            }
        }
    }
    let mut rings = Vec::new();
    while let Some((&first, _)) = next.iter().find(|(_, to)| !to.is_empty()) {
        let (mut ring, mut at) = (Vec::new(), first);
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            ring.push(at);
            at = to;
        }
        rings.push(ring);
    }
    rings
}

/// The nearest vertex of some.
fn nearest(mesh: &Tessellation, p: Coord<f64>, may: &dyn Fn(usize) -> bool) -> Option<usize> {
    let away = |v: usize| distance(mesh.points()[v], p);
    (0..mesh.points().len())
        .filter(|&v| may(v))
        .min_by(|&a, &b| away(a).total_cmp(&away(b)).then(a.cmp(&b)))
}

fn finite([x, y]: [f64; 2], what: &str) -> Result<Coord<f64>, DesignError> {
    if x.is_finite() && y.is_finite() {
        Ok(Coord { x, y })
    } else {
        bad(format!("{what} is at ({x}, {y})"))
    }
}

fn distance(a: Coord<f64>, b: Coord<f64>) -> f64 {
    (a.x - b.x).hypot(a.y - b.y)
}

/// The mean of a face's corners.
pub(super) fn middle(mesh: &Tessellation, f: usize) -> Coord<f64> {
    let face = &mesh.faces()[f];
    let sum = face
        .iter()
        .fold(Coord { x: 0.0, y: 0.0 }, |sum, &v| sum + mesh.points()[v]);
    sum / face.len() as f64
}

fn centre(middles: &[Coord<f64>], faces: &[usize]) -> Coord<f64> {
    let sum = faces
        .iter()
        .fold(Coord { x: 0.0, y: 0.0 }, |sum, &f| sum + middles[f]);
    sum / faces.len().max(1) as f64
}

/// Square metres of a face.
pub(super) fn area(mesh: &Tessellation, f: usize) -> f64 {
    let face = &mesh.faces()[f];
    let origin = mesh.points()[face[0]];
    let at = |k: usize| mesh.points()[face[k % face.len()]] - origin;
    let twice: f64 = (0..face.len())
        .map(|k| at(k).x * at(k + 1).y - at(k).y * at(k + 1).x)
        .sum();
    0.5 * twice
}

/// Whether a point is inside a ring, open or closed; of no points nothing is.
fn is_inside(ring: &[[f64; 2]], p: Coord<f64>) -> bool {
    let n = ring.len();
    let crosses = |k: usize| {
        let ([ax, ay], [bx, by]) = (ring[k], ring[(k + 1) % n]);
        (ay > p.y) != (by > p.y) && p.x < ax + (p.y - ay) / (by - ay) * (bx - ax)
    };
    (0..n).filter(|&k| crosses(k)).count() % 2 == 1
}

/// The largest number that divides both.
fn common(a: usize, b: usize) -> usize {
    if b == 0 {
        a
    } else {
        common(b, a % b)
    }
}
