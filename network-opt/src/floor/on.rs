//! From a [`FloorSpecification`] to a [`Problem`] on a mesh.

use geo_types::Coord;

use super::measure::{is_inside, middle};
use super::place::placement;
use super::shafts::{place_shaft, ShaftPlace};
use super::spec::{FloorSpecification, Shaft, ShaftRole};
use crate::design::{
    EdgeState, Feature, Pattern, PatternKind, Problem, Rim, Sinks, Specification, Tessellation,
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

/// What is wrong with a floor, as an error.
pub(super) fn bad<T>(what: String) -> Result<T, DesignError> {
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
}
