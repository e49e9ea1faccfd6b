//! Places that a specification names, and the vertices that they are.

use geo_types::Coord;

use crate::design::tessellation::Tessellation;
use crate::error::DesignError;

/// A place on a mesh.
///
/// In TOML a number, `{ x = 120.0, y = 35.0 }` or `{ u = 0.5, v = 0.0 }`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(untagged))]
pub enum Place {
    /// This vertex.
    Vertex(usize),
    /// The vertex nearest to a point, in the coordinates of the mesh: metres.
    Point {
        /// To the east.
        x: f64,
        /// To the north.
        y: f64,
    },
    /// The vertex nearest to a point by shares of the mesh's bounding box, 0 to
    /// 1 from west to east and from south to north: independent of any mesh.
    Share {
        /// To the east.
        u: f64,
        /// To the north.
        v: f64,
    },
}

impl Place {
    /// Where it is.
    ///
    /// # Errors
    ///
    /// [`DesignError::BadProblem`] for a vertex that is not in the mesh, and a
    /// number that is not finite.
    pub(super) fn point(self, mesh: &Tessellation) -> Result<Coord<f64>, DesignError> {
        let bad = |what: String| Err(DesignError::BadProblem { what });
        let points = mesh.points();
        let point = match self {
            Self::Vertex(v) => match points.get(v) {
                Some(&point) => point,
                None => return bad(format!("vertex {v} is named, of {}", points.len())),
            },
            Self::Point { x, y } => Coord { x, y },
            Self::Share { u, v } => {
                let span = |of: fn(&Coord<f64>) -> f64, share: f64| {
                    let low = points.iter().map(of).fold(f64::INFINITY, f64::min);
                    let high = points.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
                    low + share * (high - low)
                };
                Coord {
                    x: span(|p| p.x, u),
                    y: span(|p| p.y, v),
                }
            }
        };
        if point.x.is_finite() && point.y.is_finite() {
            Ok(point)
        } else {
            bad(format!("the place {self:?} is not finite"))
        }
    }

    /// The vertex that it is: the nearest of those that `may` be, the first of
    /// equally near ones.
    ///
    /// # Errors
    ///
    /// As [`Place::point`], for a vertex by number that may not be, and if none
    /// may.
    pub(super) fn vertex(
        self,
        mesh: &Tessellation,
        may: &dyn Fn(usize) -> bool,
    ) -> Result<usize, DesignError> {
        let bad = |what: String| Err(DesignError::BadProblem { what });
        let point = self.point(mesh)?;
        if let Self::Vertex(v) = self {
            if may(v) {
                return Ok(v);
            }
            return bad(format!("vertex {v} is named, but it is off the boundary where it has to be on it, or no street can touch it"));
        }
        let away = |v: usize| {
            let way = mesh.points()[v] - point;
            way.x.hypot(way.y)
        };
        let near = (0..mesh.points().len()).filter(|&v| may(v));
        match near.min_by(|&a, &b| away(a).total_cmp(&away(b)).then(a.cmp(&b))) {
            Some(v) => Ok(v),
            None => bad(format!("there is no vertex for the place {self:?}")),
        }
    }
}

/// Where sinks may be placed.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Among {
    /// On the boundary.
    #[default]
    Boundary,
    /// Anywhere but on the boundary.
    Interior,
    /// Anywhere.
    Anywhere,
    /// At these places.
    List(Vec<Place>),
}

impl Among {
    /// The candidates: vertices that a street `may` touch, none twice.
    pub(super) fn candidates(
        &self,
        mesh: &Tessellation,
        may: &dyn Fn(usize) -> bool,
    ) -> Result<Vec<usize>, DesignError> {
        let on_rim = on_rim(mesh);
        let all = (0..on_rim.len()).filter(|&v| may(v));
        Ok(match self {
            Self::Boundary => all.filter(|&v| on_rim[v]).collect(),
            Self::Interior => all.filter(|&v| !on_rim[v]).collect(),
            Self::Anywhere => all.collect(),
            Self::List(places) => {
                let mut list = Vec::with_capacity(places.len());
                for place in places {
                    list.push(place.vertex(mesh, may)?);
                }
                list.sort_unstable();
                list.dedup();
                list
            }
        })
    }
}

/// Whether each vertex lies on the boundary.
pub(super) fn on_rim(mesh: &Tessellation) -> Vec<bool> {
    let mut on_rim = vec![false; mesh.points().len()];
    for (ends, rim) in mesh.edges().iter().zip(mesh.rim()) {
        ends.iter().for_each(|&v| on_rim[v] |= rim);
    }
    on_rim
}

/// The vertices of the longest outer boundary in order, counter-clockwise, each
/// with its way along it, and the length of all of it.
pub(super) fn outline(mesh: &Tessellation) -> (Vec<(usize, f64)>, f64) {
    // The mesh lies on the left of each side on the boundary.
    let mut sides: Vec<Vec<usize>> = vec![Vec::new(); mesh.points().len()];
    for (face, edges) in mesh.faces().iter().zip(0..) {
        for (k, &e) in mesh.edges_of(edges).iter().enumerate() {
            if mesh.faces_of(e).len() == 1 {
                sides[face[k]].push(face[(k + 1) % face.len()]);
            }
        }
    }
    let mut best: (Vec<(usize, f64)>, f64) = (Vec::new(), 0.0);
    for start in 0..sides.len() {
        while let Some(mut next) = sides[start].pop() {
            let (mut line, mut length, mut area) = (vec![(start, 0.0)], 0.0, 0.0);
            let mut at = start;
            loop {
                let (a, b) = (mesh.points()[at], mesh.points()[next]);
                length += (b.x - a.x).hypot(b.y - a.y);
                area += a.x * b.y - a.y * b.x;
                at = next;
                if at == start {
                    break;
                }
                line.push((at, length));
                // As many sides leave a vertex as arrive there.
                let Some(following) = sides[at].pop() else {
                    break;
                };
                next = following;
            }
            if area > 0.0 && length > best.1 {
                best = (line, length);
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_the_nearest_vertices_that_may_be() {
        let mesh = Tessellation::grid(4, 2);
        let all = |_: usize| true;
        let at = |place: Place| place.vertex(&mesh, &all).expect("there");
        assert_eq!(at(Place::Vertex(7)), 7);
        assert_eq!(at(Place::Point { x: 2.2, y: 1.4 }), 7);
        assert_eq!(at(Place::Share { u: 1.0, v: 0.0 }), 4);
        assert_eq!(at(Place::Share { u: 0.5, v: 0.5 }), 7);
        let but = Place::Share { u: 0.5, v: 0.5 }.vertex(&mesh, &|v| v != 7);
        assert_eq!(but, Ok(2));
        assert!(Place::Vertex(7).vertex(&mesh, &|v| v != 7).is_err());
        assert!(Place::Vertex(15).vertex(&mesh, &all).is_err());
        let nowhere = Place::Point {
            x: f64::NAN,
            y: 0.0,
        };
        assert!(nowhere.vertex(&mesh, &all).is_err());
        assert!(Place::Share { u: 0.0, v: 0.0 }
            .vertex(&mesh, &|_| false)
            .is_err());
    }

    #[test]
    fn candidates_are_where_they_are_said_to_be() {
        let mesh = Tessellation::grid(4, 3);
        let count = |among: Among| among.candidates(&mesh, &|_| true).expect("there").len();
        assert_eq!(
            [Among::Boundary, Among::Interior, Among::Anywhere].map(count),
            [14, 6, 20]
        );
        let list = vec![
            Place::Vertex(3),
            Place::Share { u: 0.0, v: 0.0 },
            Place::Vertex(0),
        ];
        assert_eq!(
            Among::List(list).candidates(&mesh, &|_| true),
            Ok(vec![0, 3])
        );
    }

    #[test]
    fn the_outline_goes_once_around() {
        let (line, length) = outline(&Tessellation::grid(4, 3));
        assert_eq!((line.len(), length), (14, 14.0));
        assert_eq!(line[..3], [(0, 0.0), (1, 1.0), (2, 2.0)]);
        // A ring of eight squares: the hole's boundary is not it.
        let grid = Tessellation::grid(3, 3);
        let faces: Vec<Vec<usize>> = (grid.faces().iter().cloned().enumerate())
            .filter(|&(f, _)| f != 4)
            .map(|(_, face)| face)
            .collect();
        let ring = Tessellation::new(grid.points().to_vec(), faces).expect("a mesh");
        assert_eq!(outline(&ring).1, 12.0);
    }
}
