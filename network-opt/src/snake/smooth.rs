//! All snakes of a network in one sparse system.

use geo_types::{Coord, LineString};

use super::chains::{snakes, Snake};
use crate::design::Tessellation;
use crate::error::DesignError;
use crate::quadratic::{Bounds, System, Term, Var};

/// How stiff streets are, and how far they may go.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SnakeOptions {
    /// alpha, the weight of stretching: what pulls a street short.
    ///
    /// Default value: 0.2.
    pub elasticity: f64,
    /// beta, the weight of bending.
    ///
    /// Default value: 1.
    pub rigidity: f64,
    /// The weight of staying where the mesh has the street.
    ///
    /// Default value: 0.02.
    pub closeness: f64,
    /// Pieces that each edge is cut into.
    ///
    /// Default value: 4.
    pub pieces: usize,
    /// Steps of implicit time, each as long as all weights say 1.
    ///
    /// Default value: 40.
    pub steps: usize,
    /// Most that a vertex on the boundary slides along it, as a share of the
    /// boundary edge on that side.
    ///
    /// Default value: 0.4.
    pub slide: f64,
    /// Two edges at a crossing belong to one street if they turn by less,
    /// degrees.
    ///
    /// Default value: 50.
    pub through_deg: f64,
    /// Vertices that stay where they are, wherever they lie: places that a
    /// street leads to.
    ///
    /// Default value: none.
    pub pinned: Vec<usize>,
}

impl Default for SnakeOptions {
    fn default() -> Self {
        Self {
            elasticity: 0.2,
            rigidity: 1.0,
            closeness: 0.02,
            pieces: 4,
            steps: 40,
            slide: 0.4,
            through_deg: 50.0,
            pinned: Vec::new(),
        }
    }
}

impl SnakeOptions {
    fn check(&self) -> Result<(), DesignError> {
        let bad = |what: String| Err(DesignError::BadOption { what });
        for (name, value) in [
            ("elasticity", self.elasticity),
            ("rigidity", self.rigidity),
            ("closeness", self.closeness),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return bad(format!("{name} is {value}; give 0 or more"));
            }
        }
        if !(0.0..=1.0).contains(&self.slide) {
            return bad(format!("slide is {}; give a share from 0 to 1", self.slide));
        }
        if !(1..=64).contains(&self.pieces) {
            return bad(format!("pieces is {}; give 1 to 64", self.pieces));
        }
        if !(0.0..=180.0).contains(&self.through_deg) {
            return bad(format!(
                "through_deg is {}; give degrees up to 180",
                self.through_deg
            ));
        }
        Ok(())
    }
}

/// Streets as smooth lines.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SmoothNetwork {
    /// The snakes, with the line that each has become.
    pub streets: Vec<(Snake, LineString<f64>)>,
    /// Where each vertex of the mesh has gone; those that no street touches
    /// stay.
    pub vertices: Vec<Coord<f64>>,
}

/// Smooths the active edges of a mesh. Those marked `given`, such as existing
/// streets, stay as they are, and so do their vertices, but where another
/// street ends on a straight stretch of the rim: such an end slides along it.
/// Snakes meet where they met before: a crossing is one point of all of them.
///
/// The internal energy of a snake is, for unit pieces,
/// `alpha |v_i+1 - v_i|^2 + beta |v_i-1 - 2 v_i + v_i+1|^2`, the external one
/// `closeness |v_i - v0_i|^2`; each step solves the implicit Euler system, one
/// factorisation for all. Corners where only two streets meet at a right
/// angle are eased too: a stair becomes a slope.
///
/// # Errors
///
/// [`DesignError::BadOption`] for a number out of its range;
/// [`DesignError::BadProblem`] if a list has not one entry an edge, or a vertex
/// is pinned that the mesh has not;
/// [`DesignError::OutOfMemory`] if memory does not suffice.
///
/// # Complexity
///
/// One sparse factorisation in the number of points, and one solve a step.
pub fn smooth(
    mesh: &Tessellation,
    active: &[bool],
    given: &[bool],
    options: &SnakeOptions,
) -> Result<SmoothNetwork, DesignError> {
    options.check()?;
    let edges = mesh.edges().len();
    if active.len() != edges || given.len() != edges {
        return Err(DesignError::BadProblem {
            what: format!("there must be one entry for each of {edges} edges"),
        });
    }
    let own: Vec<bool> = (0..edges).map(|e| active[e] && !given[e]).collect();
    let found = snakes(mesh, &own, options.through_deg.to_radians());
    smooth_snakes(mesh, found, given, options)
}

/// [`smooth`] for snakes that were found otherwise: of streets of several
/// classes, say, none of which is to run on into another.
///
/// # Errors
///
/// As [`smooth`]; [`DesignError::BadProblem`] too for a snake with a vertex
/// that the mesh has not.
pub fn smooth_snakes(
    mesh: &Tessellation,
    snakes: Vec<Snake>,
    given: &[bool],
    options: &SnakeOptions,
) -> Result<SmoothNetwork, DesignError> {
    options.check()?;
    let vertices = mesh.points().len();
    let strange = |s: &Snake| s.vertices.len() < 2 || s.vertices.iter().any(|&v| v >= vertices);
    if given.len() != mesh.edges().len() || snakes.iter().any(strange) {
        return Err(DesignError::BadProblem {
            what: "the snakes, or the list of given edges, are not of this mesh".to_owned(),
        });
    }
    if let Some(v) = options.pinned.iter().find(|&&v| v >= vertices) {
        return Err(DesignError::BadProblem {
            what: format!("vertex {v} is pinned, of {vertices}"),
        });
    }
    let mut draft = Draft::new(mesh, &snakes, options.pieces);
    draft.hold(mesh, given, options.slide);
    for &v in &options.pinned {
        draft.holds[v] = Hold::Fixed;
    }
    draft.relax(&snakes, options)?;
    let streets = snakes
        .into_iter()
        .zip(&draft.lines)
        .map(|(snake, line)| {
            let points: Vec<Coord<f64>> = line.iter().map(|&p| draft.points[p]).collect();
            (snake, points.into())
        })
        .collect();
    Ok(SmoothNetwork {
        streets,
        vertices: draft.points[..vertices].to_vec(),
    })
}

/// Points in the making: those of the mesh, then those between.
struct Draft {
    points: Vec<Coord<f64>>,
    /// The points of each snake.
    lines: Vec<Vec<usize>>,
    /// How far a point may slide along a direction, back and ahead; free points
    /// have none.
    holds: Vec<Hold>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Hold {
    Free,
    Fixed,
    Slide(Coord<f64>, [f64; 2]),
}

impl Draft {
    fn new(mesh: &Tessellation, snakes: &[Snake], pieces: usize) -> Self {
        let mut points = mesh.points().to_vec();
        let mut lines = Vec::new();
        for snake in snakes {
            let mut line = vec![snake.vertices[0]];
            for pair in snake.vertices.windows(2) {
                let (a, b) = (mesh.points()[pair[0]], mesh.points()[pair[1]]);
                for k in 1..pieces {
                    line.push(points.len());
                    points.push(a + (b - a) * (k as f64 / pieces as f64));
                }
                line.push(pair[1]);
            }
            lines.push(line);
        }
        let holds = vec![Hold::Free; points.len()];
        Self {
            points,
            lines,
            holds,
        }
    }

    /// Vertices of given streets and of the rim stay; the end of a street on a
    /// straight stretch of either slides.
    fn hold(&mut self, mesh: &Tessellation, given: &[bool], slide: f64) {
        let rim: Vec<bool> = mesh.rim().collect();
        for v in 0..mesh.points().len() {
            let here = mesh.points()[v];
            let fixed: Vec<Coord<f64>> = mesh
                .around(v)
                .iter()
                .filter(|&&(e, _)| given[e] || rim[e])
                .map(|&(_, w)| mesh.points()[w] - here)
                .collect();
            self.holds[v] = match fixed.as_slice() {
                [] => Hold::Free,
                &[back, ahead] => {
                    let (b, a) = (back.x.hypot(back.y), ahead.x.hypot(ahead.y));
                    let cross = (back.x * ahead.y - back.y * ahead.x).abs() / (a * b);
                    let opposite = back.x * ahead.x + back.y * ahead.y < 0.0;
                    if opposite && cross < 1e-3 {
                        Hold::Slide(ahead / a, [-slide * b, slide * a])
                    } else {
                        Hold::Fixed
                    }
                }
                _ => Hold::Fixed,
            };
        }
    }

    fn relax(&mut self, snakes: &[Snake], options: &SnakeOptions) -> Result<(), DesignError> {
        let begin = self.points.clone();
        // Only points on a snake are unknown.
        let mut touched = vec![false; begin.len()];
        self.lines.iter().flatten().for_each(|&p| touched[p] = true);
        let mut size = 0;
        let (mut low, mut high) = (Vec::new(), Vec::new());
        let vars: Vec<Var> = (0..begin.len())
            .map(|p| {
                let from = size;
                match self.holds[p] {
                    _ if !touched[p] => Var::Fixed,
                    Hold::Fixed => Var::Fixed,
                    Hold::Free => {
                        size += 2;
                        low.extend([f64::NEG_INFINITY; 2]);
                        high.extend([f64::INFINITY; 2]);
                        Var::Free(from)
                    }
                    Hold::Slide(along, [back, ahead]) => {
                        size += 1;
                        low.push(back);
                        high.push(ahead);
                        Var::Slide(from, along)
                    }
                }
            })
            .collect();
        if size == 0 {
            return Ok(());
        }
        let fixed = self.energy(snakes, options);
        let inert = (0..begin.len()).filter(|&p| vars[p] != Var::Fixed);
        let inertia: Vec<Term> = inert.map(|p| Term::one(1.0, p)).collect();
        let all: Vec<Term> = fixed
            .iter()
            .map(|t| t.0)
            .chain(inertia.iter().copied())
            .collect();
        let failed = || DesignError::OutOfMemory {
            what: "smoothing a network".to_owned(),
        };
        let mut system = System::new(size, &vars, &all).ok_or_else(failed)?;
        let bounds = Bounds { low, high };
        let mut q = vec![0.0; size];
        for _ in 0..options.steps {
            let now = self.points.clone();
            let terms: Vec<(Term, Coord<f64>)> = fixed
                .iter()
                .copied()
                .chain(inertia.iter().map(|&t| (t, now[t.parts[0].0])))
                .collect();
            let rhs = system.rhs(&vars, &begin, &terms);
            system.minimise(&mut q, &rhs, &bounds).ok_or_else(failed)?;
            for (p, var) in vars.iter().enumerate() {
                self.points[p] = begin[p] + var.displacement(&q);
            }
        }
        Ok(())
    }

    /// Stretching, bending and closeness of all snakes, with their aims.
    fn energy(&self, snakes: &[Snake], options: &SnakeOptions) -> Vec<(Term, Coord<f64>)> {
        let mut terms = Vec::new();
        let none = Coord::zero();
        for (snake, line) in snakes.iter().zip(&self.lines) {
            for pair in line.windows(2) {
                let stretch = Term {
                    weight: options.elasticity,
                    parts: [(pair[0], -1.0), (pair[1], 1.0), (pair[1], 0.0)],
                };
                terms.push((stretch, none));
                let at = pair[1];
                terms.push((Term::one(options.closeness, at), self.points[at]));
            }
            let ring = snake
                .is_ring()
                .then(|| [line[line.len() - 2], line[0], line[1]]);
            let triples = line.windows(3).map(|t| [t[0], t[1], t[2]]);
            for [a, b, c] in triples.chain(ring) {
                let bend = Term {
                    weight: options.rigidity,
                    parts: [(a, 1.0), (b, -2.0), (c, 1.0)],
                };
                terms.push((bend, none));
            }
        }
        terms
    }
}
