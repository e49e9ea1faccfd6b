//! Separatrices: the lines that leave the singularities of a cross field.

mod arms;
mod junctions;

use crate::error::TraceError;
use crate::field::DirectionField;
use crate::trace::{trace_ahead, Stop, TraceOptions};
use crate::vector::{distance, dot, is_finite, nearest_parameter, turn, unit, Point};
use arms::{arms, radial};
use geo_types::{Coord, LineString};
use rstar::{primitives::GeomWithData, RTree};
use std::f64::consts::PI;

/// How much larger the circle is on which a line is judged to be on its way
/// into a singularity than [`SeparatrixOptions::capture`].
const CIRCLE: f64 = 4.0;

/// A point around which a cross field turns by a multiple of a right angle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Singularity {
    /// Where, in metres.
    pub at: Coord<f64>,
    /// By how many right angles the cross turns anticlockwise on an
    /// anticlockwise way around: four times the index.
    pub quarters: i32,
}

impl Singularity {
    /// How many arms of the field leave it: 4 less the quarters, five for the
    /// index -1/4 and three for +1/4; none from a full turn on, where all
    /// directions are alike.
    #[must_use]
    pub fn arms(&self) -> usize {
        usize::try_from(4_i64 - i64::from(self.quarters)).unwrap_or(0)
    }
}

/// How separatrices are traced. Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SeparatrixOptions {
    /// Radius of the circle around a singularity on which its arms are sought.
    /// Halved, eight times at most, where that circle leaves the domain or does
    /// not show the arms that the index calls for, as when it holds another
    /// singularity.
    ///
    /// Default value: 0.5 m.
    pub radius: f64,
    /// A line on course to pass a singularity this near is led into it: one
    /// that comes within four times as much heads for it to within 14.5
    /// degrees. It is then the separatrix of both, and traced once. 0 lets none
    /// end at a singularity.
    ///
    /// Default value: 0.5 m.
    pub capture: f64,
    /// Whether a line ends where it meets one that was there before (all leave
    /// at the same time, at the same speed; those between two singularities
    /// were there from the start, and are never cut). Otherwise lines cross.
    ///
    /// Default value: true.
    pub junctions: bool,
    /// How the lines are traced.
    pub trace: TraceOptions,
}

impl Default for SeparatrixOptions {
    fn default() -> Self {
        Self {
            radius: 0.5,
            capture: 0.5,
            junctions: true,
            trace: TraceOptions::default(),
        }
    }
}

/// Where a separatrix ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SeparatrixEnd {
    /// Where tracing ended: at the boundary, as a rule.
    Stop(Stop),
    /// At a singularity.
    Singularity {
        /// Its position in the input.
        index: usize,
        /// The arm of it that this line is, too.
        arm: usize,
    },
    /// On another separatrix, or on an earlier part of itself.
    Junction {
        /// Position of that separatrix in the answer.
        separatrix: usize,
    },
}

/// A line that leaves a singularity.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Separatrix {
    /// Position of the singularity in the input.
    pub singularity: usize,
    /// Which of its arms, counted anticlockwise from east.
    pub arm: usize,
    /// Points along the line, from the singularity on, in metres.
    pub points: Vec<Coord<f64>>,
    /// How it ends.
    pub end: SeparatrixEnd,
}

impl Separatrix {
    /// The points as a line, for [`tiles`](crate::tiles).
    #[must_use]
    pub fn to_line_string(&self) -> LineString<f64> {
        LineString(self.points.clone())
    }
}

/// The angles, from east, in which a cross field points straight away from a
/// singularity, on a circle of the given radius around it (halved where needed,
/// see [`SeparatrixOptions::radius`]). Ascending, in [0, 2 pi).
///
/// Fewer than [`Singularity::arms`] where part of every circle lies outside the
/// domain; not that number either if the index is wrong.
///
/// # Errors
///
/// [`TraceError::SeedNotFinite`], [`TraceError::BadOption`] for the radius.
///
/// # Examples
///
/// A cross that turns back by a right angle on a way around the origin:
///
/// ```
/// use geo_types::{coord, polygon};
/// use streamline::{arm_nearest, from_fn, separatrix_arms, Singularity};
///
/// let land = polygon![(x: -9., y: -9.), (x: 9., y: -9.), (x: 9., y: 9.), (x: -9., y: 9.)];
/// let field = from_fn(land, |at, heading| Some(arm_nearest(-0.25 * at.y.atan2(at.x), heading)));
/// let fivefold = Singularity { at: coord! { x: 0., y: 0. }, quarters: -1 };
/// let arms = separatrix_arms(&field, &fivefold, 1.0)?;
/// assert_eq!(arms.len(), 5);
/// assert!((arms[1] - 72_f64.to_radians()).abs() < 1e-9);
/// # Ok::<(), streamline::TraceError>(())
/// ```
pub fn separatrix_arms<F: DirectionField + ?Sized>(
    field: &F,
    singularity: &Singularity,
    radius: f64,
) -> Result<Vec<f64>, TraceError> {
    TraceError::unless_positive("radius", radius)?;
    finite(std::slice::from_ref(singularity))?;
    Ok(arms(field, singularity, radius).angles)
}

/// All separatrices of a cross field: the lines along which it leaves its
/// singularities, which cut the domain into blocks without one inside.
///
/// With [`tiles`](crate::tiles) they make the block decomposition; with
/// [`SeparatrixOptions::junctions`] it is a coarse one with T-junctions, as the
/// motorcycle graph has them. A closed region of the field that no separatrix
/// enters stays whole.
///
/// In the order of the singularities and of their arms, anticlockwise from
/// east. The separatrix of two singularities appears once, for the first.
///
/// # Errors
///
/// [`TraceError::BadOption`], [`TraceError::SeedNotFinite`] for a singularity
/// whose place is not finite, [`TraceError::NoArms`] if none of the arms that
/// the index calls for is found, or not all of them though the circle lies in
/// the domain: the index is wrong, or the place inaccurate.
///
/// # Complexity
///
/// Some hundred evaluations of the field for each singularity, a trace for each
/// arm, and O((n + k) log n) for n points with k crossings.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, polygon};
/// use streamline::{arm_nearest, from_fn, separatrices, tiles, Separatrix, SeparatrixOptions, Singularity, TileOptions};
///
/// let land = polygon![(x: -99., y: -90.), (x: 99., y: -90.), (x: 99., y: 90.), (x: -99., y: 90.)];
/// let field = from_fn(land.clone(), |at, heading| Some(arm_nearest(0.25 * at.y.atan2(at.x), heading)));
/// let singular = [Singularity { at: coord! { x: 0., y: 0. }, quarters: 1 }];
/// let lines = separatrices(&field, &singular, &SeparatrixOptions::default())?;
/// assert_eq!(lines.len(), 3);
/// let lines: Vec<_> = lines.iter().map(Separatrix::to_line_string).collect();
/// assert_eq!(tiles(&land, &lines, &TileOptions::default())?.tiles.len(), 3);
/// # Ok::<(), streamline::TraceError>(())
/// ```
///
/// # References
///
/// M. Campen, D. Bommes, L. Kobbelt, *Quantized global parametrization*, ACM
/// Trans. Graph. 34 (2015), for T-meshes traced from singularities; D.
/// Eppstein, M. T. Goodrich, E. Kim, R. Tamstorf, *Motorcycle graphs: canonical
/// quad mesh partitioning*, Computer Graphics Forum 27 (2008), for who stops
/// whom.
pub fn separatrices<F: DirectionField + ?Sized>(
    field: &F,
    singularities: &[Singularity],
    options: &SeparatrixOptions,
) -> Result<Vec<Separatrix>, TraceError> {
    options.trace.validate()?;
    TraceError::unless_positive("radius", options.radius)?;
    TraceError::unless_not_negative("capture", options.capture)?;
    finite(singularities)?;
    let mut all = Vec::with_capacity(singularities.len());
    for (index, singularity) in singularities.iter().enumerate() {
        let found = arms(field, singularity, options.radius);
        if !found.complete && (found.whole || found.angles.is_empty()) && singularity.arms() > 0 {
            return Err(TraceError::NoArms {
                index,
                x: singularity.at.x,
                y: singularity.at.y,
                expected: singularity.arms(),
                found: found.angles.len(),
            });
        }
        all.push(found);
    }
    let targets = Targets::new(singularities, options.capture);
    // Arms that a line from elsewhere has come in by.
    let mut taken: Vec<Vec<bool>> = all.iter().map(|a| vec![false; a.angles.len()]).collect();
    let mut lines = Vec::new();
    for (index, found) in all.iter().enumerate() {
        let centre = singularities[index].at;
        for (arm, &angle) in found.angles.iter().enumerate() {
            if taken[index][arm] {
                continue;
            }
            let out = radial(angle);
            let start = centre + out * found.radius;
            let (ahead, stop) = trace_ahead(field, start, out, &options.trace);
            let mut points = vec![centre, start];
            points.extend(ahead);
            let mut end = SeparatrixEnd::Stop(stop);
            if let Some((piece, entry, target, way)) = targets.first_reached(&points, index) {
                let arm = nearest_arm(&all[target].angles, way * -1.0);
                if let Some(arm) = arm.filter(|&arm| !taken[target][arm]) {
                    points.truncate(piece + 1);
                    if points.last() != Some(&entry) {
                        points.push(entry);
                    }
                    points.push(singularities[target].at);
                    taken[target][arm] = true;
                    end = SeparatrixEnd::Singularity { index: target, arm };
                }
            }
            taken[index][arm] = true;
            lines.push(Separatrix {
                singularity: index,
                arm,
                points,
                end,
            });
        }
    }
    if options.junctions {
        junctions::cut(&mut lines);
    }
    Ok(lines)
}

fn finite(singularities: &[Singularity]) -> Result<(), TraceError> {
    match singularities.iter().position(|s| !is_finite(s.at)) {
        Some(index) => Err(TraceError::SeedNotFinite {
            index,
            x: singularities[index].at.x,
            y: singularities[index].at.y,
        }),
        None => Ok(()),
    }
}

/// The arm within 45 degrees of `out`.
fn nearest_arm(angles: &[f64], out: Point) -> Option<usize> {
    let off = |i: usize| turn(radial(angles[i]), out).abs();
    (0..angles.len())
        .min_by(|&i, &j| off(i).total_cmp(&off(j)))
        .filter(|&i| off(i) <= 0.25 * PI)
}

/// The singularities that lines may run into.
struct Targets<'a> {
    singularities: &'a [Singularity],
    tree: RTree<GeomWithData<[f64; 2], usize>>,
    circle: f64,
}

impl<'a> Targets<'a> {
    fn new(singularities: &'a [Singularity], capture: f64) -> Self {
        let place = |(i, s): (usize, &Singularity)| GeomWithData::new([s.at.x, s.at.y], i);
        Self {
            singularities,
            tree: RTree::bulk_load(singularities.iter().enumerate().map(place).collect()),
            circle: CIRCLE * capture,
        }
    }

    /// The first piece of the line that enters the circle of a singularity on
    /// course for it: where, of which, and heading which way. That of its own
    /// counts once the line has left it.
    fn first_reached(&self, points: &[Point], own: usize) -> Option<(usize, Point, usize, Point)> {
        if self.circle <= 0.0 {
            return None;
        }
        let mut left_home = false;
        // Circles that the last piece ended in: these were judged on entry.
        let mut within: Vec<usize> = Vec::new();
        for piece in 1..points.len().saturating_sub(1) {
            let (a, b) = (points[piece], points[piece + 1]);
            let reach = self.circle + distance(a, b);
            let Some(way) = unit(b - a) else { continue };
            let mut near: Vec<usize> = self
                .tree
                .locate_within_distance([a.x, a.y], reach * reach)
                .map(|found| found.data)
                .collect();
            near.sort_unstable();
            let mut first: Option<(f64, Point, usize)> = None;
            let mut now = Vec::new();
            for i in near {
                let q = self.singularities[i].at;
                if distance(q, b) <= self.circle {
                    now.push(i);
                }
                if within.contains(&i) || (i == own && !left_home) {
                    continue;
                }
                let nearest = a + (b - a) * nearest_parameter(q, a, b);
                if distance(nearest, q) > self.circle {
                    continue;
                }
                // Back from the foot on the line's course to the circle.
                let ahead = dot(q - a, way);
                let miss = distance(a + way * ahead, q);
                let back = (self.circle * self.circle - miss * miss).max(0.0).sqrt();
                let s = (ahead - back).max(0.0);
                if ahead > 0.0
                    && miss * CIRCLE <= distance(a + way * s, q)
                    && first.is_none_or(|f| s < f.0)
                {
                    first = Some((s, a + way * s, i));
                }
            }
            if let Some((_, entry, i)) = first {
                return Some((piece, entry, i, way));
            }
            left_home |= distance(self.singularities[own].at, b) > self.circle;
            within = now;
        }
        None
    }
}
