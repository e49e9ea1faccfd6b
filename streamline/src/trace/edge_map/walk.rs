//! One half of a line: from edge to edge until something stops it.

use super::passed::Passed;
use super::{EdgeMaps, EdgeOptions};
use crate::field::mesh::NONE;
use crate::trace::Stop;
use crate::vector::{cross, dot, norm, Point};

/// Most edges that a half crosses: bounds the work where lines cross ever more
/// edges without gaining length.
const MOST: usize = 10_000_000;

/// A point of an edge, by its fraction from the lower vertex to the higher.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) edge: usize,
    pub(super) t: f64,
}

/// Where a line starts: in a triangle, along one of its arms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub(super) seed: Point,
    pub(super) triangle: usize,
    pub(super) arm: usize,
}

/// The edges crossed from the seed on, and why there are no more.
#[derive(Debug)]
pub(super) struct Half {
    pub(super) points: Vec<Point>,
    pub(super) edges: Vec<usize>,
    pub(super) stop: Stop,
}

impl EdgeMaps<'_> {
    /// Walks from the start to where the line of its arm ends. Ends: each edge
    /// adds length or brings the line around a vertex, in one direction only,
    /// since no lane of a triangle lies across the cross at its vertices.
    pub(super) fn walk(&self, start: Start, options: &EdgeOptions, passed: &mut Passed) -> Half {
        let mesh = &self.mesh;
        let mut half = Half {
            points: Vec::new(),
            edges: Vec::new(),
            stop: Stop::LengthLimit,
        };
        let Some(mut place) = self.leave(start) else {
            half.stop = Stop::Singularity;
            return half;
        };
        let (mut from, mut gone) = (start.seed, 0.0);
        let (mut triangle, mut arm) = (start.triangle, start.arm);
        let mut along = self.along(triangle, arm);
        passed.restart();
        for _ in 0..MOST {
            let to = self.point(place);
            let piece = norm(to - from);
            if gone + piece > options.max_length {
                half.points
                    .push(from + (to - from) * ((options.max_length - gone) / piece));
                break;
            }
            gone += piece;
            half.points.push(to);
            half.edges.push(place.edge);
            if let Some(stop) = self.ends(place, triangle, arm, options, passed) {
                half.stop = stop;
                break;
            }
            let edge = mesh.edges[place.edge];
            let from_left = edge.sides[0] == triangle;
            let shift = self.lanes.shift[place.edge];
            arm = (arm + if from_left { shift } else { 4 - shift }) % 4;
            triangle = mesh.beyond(place.edge, triangle);
            let Some(lanes) = &self.lanes.of[triangle] else {
                half.stop = Stop::Singularity;
                break;
            };
            if (triangle, arm) == (start.triangle, start.arm) {
                let along = lanes[arm % 2].along;
                let tolerance = options.loop_tolerance.max(1e-12 * self.size);
                if cross(start.seed - to, along).abs() <= tolerance {
                    half.points.push(start.seed);
                    half.stop = Stop::ClosedLoop;
                    break;
                }
            }
            if options.self_approach > 0.0 {
                let next = self.along(triangle, arm);
                passed.turn(along, next);
                along = next;
            }
            let local = mesh.local(triangle, place.edge);
            let (out, t) = lanes[arm % 2].across(local, self.turned(triangle, local, place.t));
            place = Place {
                edge: mesh.edges_of[triangle][out],
                t: self.turned(triangle, out, t),
            };
            from = to;
        }
        half
    }

    /// Where the line of the start leaves its triangle.
    fn leave(&self, start: Start) -> Option<Place> {
        let lane = self.lanes.of[start.triangle].as_ref()?[start.arm % 2];
        let t = lane.project(&self.mesh, start.triangle, start.seed);
        let forwards = start.arm < 2;
        let (local, t) = if lane.out_at_odd == forwards {
            (lane.odd, t)
        } else {
            lane.across(lane.odd, t)
        };
        Some(Place {
            edge: self.mesh.edges_of[start.triangle][local],
            t: self.turned(start.triangle, local, t),
        })
    }

    /// The direction of an arm in a triangle; zero where that is blocked.
    pub(super) fn along(&self, triangle: usize, arm: usize) -> Point {
        let lanes = self.lanes.of[triangle].as_ref();
        lanes.map_or(Point::zero(), |lanes| {
            lanes[arm % 2].along * if arm < 2 { 1.0 } else { -1.0 }
        })
    }

    /// A fraction of a triangle's local edge as one of the mesh's edge, or back.
    fn turned(&self, triangle: usize, local: usize, t: f64) -> f64 {
        let corners = self.mesh.triangles[triangle];
        if corners[local] < corners[(local + 1) % 3] {
            t
        } else {
            1.0 - t
        }
    }

    fn point(&self, place: Place) -> Point {
        let edge = self.mesh.edges[place.edge];
        let (a, b) = (self.mesh.points[edge.a], self.mesh.points[edge.b]);
        // From the nearer end, so that both are met exactly.
        if place.t <= 0.5 {
            a + (b - a) * place.t
        } else {
            b + (a - b) * (1.0 - place.t)
        }
    }

    /// Whether a line ends where it meets an edge, coming from a triangle
    /// along one of its arms.
    fn ends(
        &self,
        place: Place,
        triangle: usize,
        arm: usize,
        options: &EdgeOptions,
        passed: &mut Passed,
    ) -> Option<Stop> {
        let edge = self.mesh.edges[place.edge];
        let along = self.mesh.points[edge.b] - self.mesh.points[edge.a];
        let length = norm(along);
        for (vertex, fraction) in [(edge.a, place.t), (edge.b, 1.0 - place.t)] {
            let vector = self.mesh.vectors[vertex];
            if dot(vector, vector) == 0.0 && fraction * length <= options.singular_radius {
                return Some(Stop::Singularity);
            }
        }
        if self.mesh.beyond(place.edge, triangle) == NONE {
            let (ring, edge) = self.field.label(edge.a, edge.b)?;
            return Some(Stop::Boundary { ring, edge });
        }
        if options.self_approach > 0.0 {
            // Families are counted on the left of the edge.
            let on_left = if edge.sides[0] == triangle {
                arm
            } else {
                arm + 4 - self.lanes.shift[place.edge]
            };
            // How far apart two lines are that meet the edge at a slant.
            let lane = self.lanes.of[triangle].as_ref()?[arm % 2].along;
            let apart = cross(along, lane).abs();
            let near = |t: f64| (t - place.t).abs() * apart <= options.self_approach;
            if passed.meets((place.edge, on_left % 2), place.t, near) {
                return Some(Stop::SelfApproach);
            }
        }
        None
    }
}
