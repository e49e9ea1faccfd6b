//! Tracing one streamline both ways from its seed.

pub(crate) mod adaptive;
mod curve;
mod edge_map;
mod march;
mod options;
mod quartic;
mod stop;
mod tracer;
mod track;

pub use curve::Curve;
pub use edge_map::{EdgeLine, EdgeMaps, EdgeOptions};
pub use options::TraceOptions;
pub use stop::Stop;
pub use tracer::{EdgeTracer, RungeKutta, Tracer};

use crate::error::TraceError;
use crate::field::{Cursor, DirectionField};
use crate::streamline::Streamline;
use crate::vector::{is_finite, unit};
use curve::Pieces;
use geo_types::Coord;
use march::{Keep, March};
use track::Track;

/// Traces the streamline through `seed` both ways: along the arm nearest to
/// `heading`, and against it.
///
/// The field is integrated by the Dormand-Prince pair of orders 5 and 4 with
/// error control, each stage following the arm nearest to the incoming
/// direction; boundary exits are exact; the line ends as its two
/// [`Stop`]s say.
///
/// # Shape
///
/// The points run from the far end of the backward half over the seed, itself
/// a point, to the far end of the forward half: `heading` points from the
/// start to the end. Consecutive points are at most [`TraceOptions::step`]
/// apart, up to the tolerance, and turn by about 10 degrees at most. `family`
/// and `seed_index` are 0.
///
/// A seed on the boundary with nothing ahead has one empty half; if both are
/// empty the line is the single point.
///
/// # Accuracy
///
/// Each step's *estimated* error stays below [`TraceOptions::tolerance`]; this
/// is not a rigorous bound where the field has kinks, though the estimate sees
/// them. A gap in the field narrower than half of [`TraceOptions::max_step`]
/// may be stepped over if the domain goes on there (a hole of the domain never
/// is). Points of a line lie on the curve to that accuracy; chords cut corners
/// by up to curvature * step^2 / 8.
///
/// # Errors
///
/// [`TraceError::BadOption`], [`TraceError::SeedNotFinite`],
/// [`TraceError::NoHeading`], or [`TraceError::NoDirection`] where the field
/// has no direction at the seed.
///
/// # Complexity
///
/// Six evaluations of the field a step, one [`DirectionField::exit`] a point.
///
/// # Examples
///
/// A circle about the origin closes:
///
/// ```
/// use geo_types::{coord, polygon};
/// use streamline::{arm_nearest, from_fn, trace, Stop, TraceOptions};
///
/// let domain = polygon![(x: -99., y: -99.), (x: 99., y: -99.), (x: 99., y: 99.), (x: -99., y: 99.)];
/// let polar = from_fn(domain, |at, heading| Some(arm_nearest(at.y.atan2(at.x), heading)));
/// let line = trace(&polar, coord! { x: 50., y: 0. }, coord! { x: 0., y: 1. }, &TraceOptions::default())?;
/// assert_eq!(line.end, Stop::ClosedLoop);
/// assert!((line.length() / (2.0 * std::f64::consts::PI * 50.0) - 1.0).abs() < 1e-3);
/// # Ok::<(), streamline::TraceError>(())
/// ```
///
/// # References
///
/// Y.-L. Yang, J. Wang, E. Vouga, P. Wonka, *Urban Pattern: Layout Design by
/// Hierarchical Domain Splitting*, ACM Trans. Graph. 32 (2013), section 5
/// (which names Runge-Kutta without an order or error control).
pub fn trace<F: DirectionField + ?Sized>(
    field: &F,
    seed: Coord<f64>,
    heading: Coord<f64>,
    options: &TraceOptions,
) -> Result<Streamline, TraceError> {
    let heading = checked(seed, heading, options)?;
    trace_watched(field, seed, heading, options, &mut |_, _, _| None)
        .ok_or_else(|| TraceError::no_direction(seed))
}

/// The heading as a unit vector, if all arguments are in order.
fn checked(
    seed: Coord<f64>,
    heading: Coord<f64>,
    options: &TraceOptions,
) -> Result<Coord<f64>, TraceError> {
    options.validate()?;
    if !is_finite(seed) {
        return Err(TraceError::SeedNotFinite {
            index: 0,
            x: seed.x,
            y: seed.y,
        });
    }
    unit(heading).ok_or(TraceError::NoHeading {
        index: 0,
        x: heading.x,
        y: heading.y,
    })
}

/// [`trace`] with its dense output: the curve between the points too, with
/// tangents, curvature and crossings.
///
/// Costs what [`trace`] does, and five points of memory a step.
///
/// # Errors
///
/// As [`trace`].
///
/// # Examples
///
/// ```
/// use streamline::geo_types::{coord, polygon};
/// use streamline::{arm_nearest, from_fn, trace_dense, TraceOptions};
///
/// let domain = polygon![(x: -99., y: -99.), (x: 99., y: -99.), (x: 99., y: 99.), (x: -99., y: 99.)];
/// let polar = from_fn(domain, |at, heading| Some(arm_nearest(at.y.atan2(at.x), heading)));
/// let circle = trace_dense(&polar, coord! { x: 50., y: 0. }, coord! { x: 0., y: 1. }, &TraceOptions::default())?;
/// // Between points as well the radius is kept.
/// for k in 0..1000 {
///     let at = circle.point_at(0.3141 * f64::from(k));
///     assert!((at.x.hypot(at.y) - 50.0).abs() < 0.005);
/// }
/// # Ok::<(), streamline::TraceError>(())
/// ```
pub fn trace_dense<F: DirectionField + ?Sized>(
    field: &F,
    seed: Coord<f64>,
    heading: Coord<f64>,
    options: &TraceOptions,
) -> Result<Curve, TraceError> {
    let heading = checked(seed, heading, options)?;
    let mut kept = [Pieces::default(), Pieces::default()];
    let watch = &mut |_, _, _| None;
    let line = both_ways(field, seed, heading, options, watch, &mut kept)
        .ok_or_else(|| TraceError::no_direction(seed))?;
    let [forward, backward] = kept;
    Ok(Curve::new(line, forward, backward))
}

/// [`trace`] for arguments that have been checked, with a watchman: it is shown
/// each new point, after the one before it and the sign of the half (1 forwards,
/// -1 backwards), and where it names a reason the half ends before that point.
/// `None` if the field has no direction at the seed.
pub(crate) fn trace_watched<F, W>(
    field: &F,
    seed: Coord<f64>,
    heading: Coord<f64>,
    options: &TraceOptions,
    watch: &mut W,
) -> Option<Streamline>
where
    F: DirectionField + ?Sized,
    W: FnMut(f64, Coord<f64>, Coord<f64>) -> Option<Stop>,
{
    both_ways(field, seed, heading, options, watch, &mut [(), ()])
}

/// Both halves of a line, the forward one first; `keep` is told of each.
fn both_ways<F, W, K>(
    field: &F,
    seed: Coord<f64>,
    heading: Coord<f64>,
    options: &TraceOptions,
    watch: &mut W,
    keep: &mut [K; 2],
) -> Option<Streamline>
where
    F: DirectionField + ?Sized,
    W: FnMut(f64, Coord<f64>, Coord<f64>) -> Option<Stop>,
    K: Keep,
{
    let along = field
        .direction(seed, heading, &mut Cursor::default())
        .and_then(unit)?;
    let march = March {
        field,
        options,
        seed,
    };
    let mut track = Track::new(seed, options.self_approach, options.step);
    let forward = march.run(
        along,
        1.0,
        &mut track,
        &mut |a, b| watch(1.0, a, b),
        &mut keep[0],
    );
    let (start, mut points) = if forward.stop == Stop::ClosedLoop {
        (Stop::ClosedLoop, vec![seed])
    } else {
        let backward = march.run(
            along * -1.0,
            -1.0,
            &mut track,
            &mut |a, b| watch(-1.0, a, b),
            &mut keep[1],
        );
        let mut points = backward.points;
        points.reverse();
        points.push(seed);
        (backward.stop, points)
    };
    points.extend(forward.points);
    Some(Streamline {
        points,
        start,
        end: forward.stop,
        seed,
        family: 0,
        seed_index: 0,
    })
}

/// One half of a streamline: the points after `seed` along the unit vector
/// `along`, where the field points, and why they end. Options must be valid.
pub(crate) fn trace_ahead<F: DirectionField + ?Sized>(
    field: &F,
    seed: Coord<f64>,
    along: Coord<f64>,
    options: &TraceOptions,
) -> (Vec<Coord<f64>>, Stop) {
    let march = March {
        field,
        options,
        seed,
    };
    let mut track = Track::new(seed, options.self_approach, options.step);
    let half = march.run(along, 1.0, &mut track, &mut |_, _| None, &mut ());
    (half.points, half.stop)
}
