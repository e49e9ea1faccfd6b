//! Triangulation: the only place that knows spade.

use std::cell::Cell;

use spade::handles::FixedVertexHandle;
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation,
};

use super::core::Core;
use super::extract::{extract, Given};
use super::fault::{crossing, misplaced, overlapping};
use super::lattice::{boundary, interior, Segment, LINE};
use super::lines::Lines;
use super::ring::{Frame, Ring};
use super::sizing::Sizing;
use super::DomainOptions;
use crate::plane::V2;
use crate::FieldError;

pub(super) type Cdt = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// Set in a neighbour entry when it is a border instead of a triangle.
pub(crate) const BORDER: u32 = 1 << 31;

/// A boundary edge of the mesh, the domain on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Border {
    /// Start vertex.
    pub(crate) from: u32,
    /// End vertex.
    pub(crate) to: u32,
    /// Ring it lies on.
    pub(crate) ring: u32,
    /// Edge of the (cleaned) ring it lies on.
    pub(crate) edge: u32,
}

/// What the triangulation gives.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    pub(crate) points: Vec<V2>,
    /// Counter-clockwise.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Entry `k`: the triangle across the edge from corner `k` to `k + 1`, or
    /// `BORDER | index` into `borders`.
    pub(crate) neighbours: Vec<[u32; 3]>,
    pub(crate) borders: Vec<Border>,
    /// Edges on constraint lines: from, to, and which line.
    pub(crate) line_edges: Vec<(u32, u32, u32)>,
}

/// Triangulates the rings with triangle edges as long as `sizing` says.
///
/// Constraint lines are put in after refinement: their segments are as short
/// as the lattice keeps away from them, so that most are edges already, and
/// spade takes what lies behind a constraint for outside.
pub(crate) fn triangulate(
    rings: &[Ring],
    lines: &Lines,
    frame: Frame,
    sizing: &Sizing,
    options: &DomainOptions,
) -> Result<Mesh, FieldError> {
    let allowed = options.max_vertices;
    let too_many = |needed: usize| FieldError::TooManyVertices { needed, allowed };
    let (points, mut segments) = boundary(rings, lines, sizing, allowed);
    if points.len() > allowed {
        return Err(too_many(points.len()));
    }
    let (inside, core) = interior(
        rings,
        &points,
        &segments,
        sizing,
        sizing.is_large(),
        allowed,
    );
    if points.len() + inside.len() > allowed {
        return Err(too_many(points.len() + inside.len()));
    }
    let on_lines: Vec<Segment> = segments.extract_if(.., |s| s.is_line()).collect();
    overlapping(rings, frame, &segments)?;
    let job = Job {
        rings,
        frame,
        points: &points,
        segments: &segments,
        on_lines: &on_lines,
        step: sizing.step,
        options,
    };
    if !core.triangles.is_empty() {
        if let Some(mesh) = job.run(&inside, &core)? {
            return Ok(mesh);
        }
        // Refinement reached the core: all goes through the triangulation.
        let both = segments
            .iter()
            .chain(&on_lines)
            .copied()
            .collect::<Vec<_>>();
        let (inside, core) = interior(rings, &points, &both, sizing, false, allowed);
        return job.run(&inside, &core)?.ok_or_else(without_core);
    }
    job.run(&inside, &core)?.ok_or_else(without_core)
}

/// A core that is empty cannot be in the way.
fn without_core() -> FieldError {
    FieldError::MeshFailed {
        what: "the triangulation did not come together".into(),
    }
}

/// All that a triangulation is made from, but the points inside.
struct Job<'a> {
    rings: &'a [Ring],
    frame: Frame,
    points: &'a [V2],
    segments: &'a [Segment],
    on_lines: &'a [Segment],
    step: f64,
    options: &'a DomainOptions,
}

impl Job<'_> {
    /// The mesh, or `None` if refinement has split the rim of the core.
    fn run(&self, inside: &[V2], core: &Core) -> Result<Option<Mesh>, FieldError> {
        let Self {
            rings,
            frame,
            points,
            segments,
            ..
        } = *self;
        let total = points.len() + inside.len() + core.points.len();
        let options = self.options;
        if total > options.max_vertices {
            return Err(FieldError::TooManyVertices {
                needed: total,
                allowed: options.max_vertices,
            });
        }
        // A power of two scales without rounding; it keeps spade's absolute
        // limits (1e-43, 1e60) out of reach whatever the units of the domain.
        let scale = frame.size.log2().round().exp2().recip();
        let vertices: Vec<Point2<f64>> = points
            .iter()
            .chain(inside)
            .chain(&core.points[..core.rim])
            .map(|p| Point2::new(flush(p.x * scale), flush(p.y * scale)))
            .collect();
        let rim_start = points.len() + inside.len();
        let rim_edges = core.rim_edges();
        let rim = rim_edges
            .iter()
            .map(|e| [e.0, e.1].map(|v| rim_start + v as usize));
        let constraints: Vec<[usize; 2]> = segments
            .iter()
            .map(|s| [s.from as usize, s.to as usize])
            .chain(rim)
            .collect();
        let conflict = Cell::new(None);
        let load = || {
            Cdt::try_bulk_load_cdt(vertices.clone(), constraints.clone(), |pair| {
                conflict.set(conflict.get().or(Some(pair)));
            })
            .map_err(|error| FieldError::MeshFailed {
                what: format!("a vertex was refused ({error:?})"),
            })
        };
        let plain = load()?;
        if let Some(pair) = conflict.get() {
            return Err(crossing(rings, frame, points, segments, pair));
        }
        let budget = (options.max_vertices - total).min(2 * total + 1000);
        let parameters = refinement(self.step * scale, options.min_angle_deg, budget);
        // spade asserts on a circumcentre that rounding put out of range. That
        // has not been seen, but must not take the caller down: the mesh then
        // stays as it was, valid but not refined.
        let refined = std::panic::catch_unwind(|| {
            let mut cdt = plain;
            cdt.refine(parameters);
            cdt
        });
        let mut cdt = refined.or_else(|_| load())?;
        let inner_edges = add_lines(&mut cdt, self.on_lines)?;
        let given = Given {
            points,
            segments,
            rings,
            core,
            rim_start,
            rim_edges: &rim_edges,
        };
        let Some(mesh) = extract(&cdt, scale.recip(), &given, &inner_edges)? else {
            return Ok(None);
        };
        let expected: f64 = rings.iter().map(Ring::area).sum();
        let got = mesh.area();
        if (got - expected).abs() > 1e-7 * expected.abs() + 1e-12 * frame.size * frame.size {
            return Err(misplaced(rings, frame, expected, got));
        }
        Ok(Some(mesh))
    }
}

/// Values so small that spade refuses them are zero.
fn flush(value: f64) -> f64 {
    if value.abs() < 1e-30 {
        0.0
    } else {
        value
    }
}

/// Delaunay refinement within a budget of vertices.
///
/// A mesh that used up its budget is still a valid triangulation: only its
/// angles are worse. Refinement near tiny input angles can otherwise multiply
/// the vertices a hundredfold.
fn refinement(unit: f64, min_angle_deg: f64, budget: usize) -> RefinementParameters<f64> {
    RefinementParameters::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(min_angle_deg))
        // An equilateral triangle has 0.43 unit^2.
        .with_max_allowed_area(0.75 * unit * unit)
        // Grading down to a small feature costs some ten vertices a halving;
        // this ends it where slivers no longer matter to any field.
        .with_min_required_area(1e-8 * unit * unit)
        .with_max_additional_vertices(budget)
}

/// Adds the segments of constraint lines; gives for each undirected edge the
/// line it lies on, or `u32::MAX`. An empty list stands for no lines at all.
fn add_lines(cdt: &mut Cdt, on_lines: &[Segment]) -> Result<Vec<u32>, FieldError> {
    let mut added = Vec::with_capacity(on_lines.len());
    for segment in on_lines {
        let [from, to] =
            [segment.from, segment.to].map(|v| FixedVertexHandle::from_index(v as usize));
        let edges = cdt.try_add_constraint(from, to);
        if edges.is_empty() {
            return Err(FieldError::BadLine {
                line: (segment.ring & !LINE) as usize,
                why: "comes too near to the boundary or to another line to be told from it".into(),
            });
        }
        added.push((edges, segment.ring & !LINE));
    }
    if added.is_empty() {
        return Ok(Vec::new());
    }
    let mut line_of = vec![u32::MAX; cdt.num_undirected_edges()];
    for (edges, line) in added {
        for edge in edges {
            line_of[edge.as_undirected().index()] = line;
        }
    }
    Ok(line_of)
}

impl Mesh {
    /// Sum of the triangles' areas.
    pub(crate) fn area(&self) -> f64 {
        self.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| self.points[v as usize]);
                crate::plane::orient(a, b, c) / 2.0
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::ring::rings;
    use super::*;
    use geo_types::polygon;

    /// Each triangle by its corners, the lowest first, in order.
    fn sorted(mesh: &Mesh) -> Vec<[(u64, u64); 3]> {
        let bits = |v: u32| {
            let p = mesh.points[v as usize];
            (p.x.to_bits(), p.y.to_bits())
        };
        let mut all: Vec<[(u64, u64); 3]> = mesh
            .triangles
            .iter()
            .map(|t| {
                let mut corners = t.map(bits);
                let least = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
                corners.rotate_left(least);
                corners
            })
            .collect();
        all.sort_unstable();
        all
    }

    #[test]
    fn a_core_changes_nothing_but_numbers() {
        let shape = polygon!(
            exterior: [(x: 0., y: 0.), (x: 91., y: 3.), (x: 100., y: 70.), (x: 40., y: 64.), (x: 7., y: 88.)],
            interiors: [[(x: 30., y: 30.), (x: 50., y: 30.), (x: 40., y: 47.)]],
        );
        let options = DomainOptions {
            edge_length: 0.7,
            ..DomainOptions::default()
        };
        let (frame, rings) = rings(&shape, 0.5).expect("valid");
        let sizing = Sizing::new(&rings, 0.7, &options);
        assert!(sizing.is_large());
        let (points, segments) = boundary(&rings, &Lines::default(), &sizing, 100_000);
        let job = Job {
            rings: &rings,
            frame,
            points: &points,
            segments: &segments,
            on_lines: &[],
            step: 0.7,
            options: &options,
        };
        let [with, without] = [true, false].map(|cored| {
            let (inside, core) = interior(&rings, &points, &segments, &sizing, cored, 100_000);
            assert_eq!(cored, core.triangles.len() > 5000);
            job.run(&inside, &core)
                .expect("valid")
                .expect("the rim is whole")
        });
        // Points that go through spade are scaled by a power of two and back,
        // which keeps their bits.
        assert_eq!(sorted(&with), sorted(&without));
        assert_eq!(with.borders.len(), without.borders.len());
        for (t, neighbours) in with.neighbours.iter().enumerate() {
            for (k, &across) in neighbours.iter().enumerate() {
                let (a, b) = (with.triangles[t][k], with.triangles[t][(k + 1) % 3]);
                if across & BORDER == 0 {
                    let other = with.triangles[across as usize];
                    assert!((0..3).any(|j| (other[j], other[(j + 1) % 3]) == (b, a)));
                } else {
                    let border = with.borders[(across & !BORDER) as usize];
                    assert_eq!((border.from, border.to), (a, b));
                }
            }
        }
    }
}
