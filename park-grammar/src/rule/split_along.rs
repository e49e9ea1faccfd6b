//! `SplitAlong(WEST: 0.5, EAST: 0.3, curve = arc, width = 2) { Left | Right | Path }`:
//! a region cut along any line.
//!
//! The line goes through places, in their order: those of any rule (`CENTRE`,
//! `CORNER[0]`, `Along(OUTER, 5)`, points in local coordinates) or places at shares
//! of selections (`NORTH: 0.25`). From place to place it is
//!
//! * `curve = straight`, unless said otherwise;
//! * `curve = smooth`: a spline through all places (centripetal Catmull-Rom);
//! * `curve = arc`: an arc, `bulge` away from the chord in its middle (a bare number
//!   below 1 or a percentage is a share of the chord, 0.2 unless said; to the left,
//!   below 0 to the right);
//! * `curve = sinus`: `waves` (1) waves of the `amplitude` (a length or a share of
//!   the chord, 0.1 unless said), to the left first.
//!
//! What begins or ends inside the region goes straight on to its boundary. A line
//! that leaves the region and comes back cuts all that it crosses, so that there may
//! be several parts on each side. Left and right are those of someone who walks
//! along the line, in a mirrored region mirrored too. Where a line that crosses
//! itself has a part on both sides, the longer border says which.
//!
//! A path runs along the line if there is a third branch or block for it, `PathWidth`
//! wide unless `width` says otherwise; with a `width` alone it is of gravel. Without
//! either the parts touch.
//!
//! Edges along a path are marked `PATH`, others `SEAM`. With the flag `SplitHoles` no
//! part has holes.
//!
//! Outputs: what is on the left, what is on the right, the path.

use geo_types::Coord;

use super::parts::{places, Parts};
use super::peel::metres;
use super::{holes, Arguments, Ask, Output, Partition};
use crate::derive::{outputs, path_width, Scope, Watch};
use crate::error::Failure;
use crate::plane::{
    cross, curve, difference, dist, intersection, lerp, nearest_on, ribbon, right, sides, slice,
    unit, Area, Course,
};
use crate::shape::{Region, Role};
use crate::syntax::ast::{ExprKind, Span};

/// Places this near to the boundary, as a share of the region's size, are on it.
const ON: f64 = 1e-9;

/// How far a line goes on beyond the boundary so that it surely meets it, as a
/// share of the region's size.
const BEYOND: f64 = 1e-6;

/// A bulge and an amplitude where nothing is said, as shares of the chord.
const BULGE: f64 = 0.2;
const AMPLITUDE: f64 = 0.1;

pub(crate) fn split_along(ask: &mut Ask<'_, '_>) -> Result<Partition, Failure> {
    let span = ask.operation.span;
    let wants_path = outputs(ask.operation).get(2).copied().flatten().is_some();
    let scope = &mut ask.scope;
    let mut arguments = Arguments::new(ask.operation);
    let split = holes::wanted(&mut arguments, scope)?;
    let mut line = Vec::new();
    while let Some(argument) = arguments.next() {
        let spots = places(scope, argument)?;
        if spots.is_empty() {
            let error = "this region has no such place";
            return Err(Failure::unfit(argument.value.span, error));
        }
        line.extend(spots.into_iter().map(|spot| spot.at));
    }
    line.dedup();
    let (Some(&first), Some(&last)) = (line.first(), line.last()) else {
        return Err(Failure::fault(
            span,
            "a line goes through two places or more",
        ));
    };
    if line.len() < 2 {
        return Err(Failure::unfit(
            span,
            "the places of the line are one and the same",
        ));
    }
    let course = course(&mut arguments, scope, dist(first, last))?;
    let default = if wants_path {
        path_width(scope.params)
    } else {
        0.0
    };
    let width = arguments.metres(scope, "width")?.unwrap_or(default);
    if width < 0.0 {
        return Err(Failure::fault(span, "a width is 0 or more"));
    }
    arguments.done()?;
    let region = scope.region;
    let watch = scope.watch();
    let line = extended(region, curve(&line, course), width);
    let (areas, paths) = cut(region, &line, width, &watch)?;
    let role = if width > 0.0 { Role::Path } else { Role::Seam };
    let parts = Parts::new(region, "SplitAlong");
    let (mut left, mut right) = (Vec::new(), Vec::new());
    for part in parts.regions(areas, role, &watch)? {
        watch.look()?;
        let on_left = leans_left(&part, &line.middle) != region.local.mirrored();
        if on_left { &mut left } else { &mut right }.push(part);
    }
    if left.is_empty() || right.is_empty() {
        let error = "the line does not divide this region: all of it lies on one side";
        return Err(Failure::unfit(span, error));
    }
    let mut outputs = vec![
        Output::lawns(left),
        Output::lawns(right),
        Output::paths(parts.regions(paths, Role::Path, &watch)?),
    ];
    if split {
        holes::split_all(&mut outputs, &watch)?;
    }
    Ok(Partition { outputs })
}

/// How the line goes, with bulges and amplitudes in metres.
fn course(
    arguments: &mut Arguments<'_>,
    scope: &mut Scope<'_>,
    chord: f64,
) -> Result<Course, Failure> {
    let word = match arguments.named("curve") {
        Some(expr) => match &expr.kind {
            ExprKind::Name(word) => Some((word.as_str(), expr.span)),
            _ => Some(("", expr.span)),
        },
        None => None,
    };
    let span = word.map_or_else(Span::default, |(_, span)| span);
    let bulge = aside(arguments, scope, "bulge", chord)?;
    let amplitude = aside(arguments, scope, "amplitude", chord)?;
    let waves = match arguments.named("waves") {
        Some(expr) => {
            let waves = scope.count(expr)?;
            if !(1..=100).contains(&waves) {
                return Err(Failure::fault(expr.span, "a line has 1 to 100 waves"));
            }
            Some(waves)
        }
        None => None,
    };
    let sign = if scope.region.local.mirrored() {
        -1.0
    } else {
        1.0
    };
    let course = match word {
        None | Some(("straight", _)) => Course::Straight,
        Some(("smooth", _)) => Course::Smooth,
        Some(("arc", _)) => Course::Arc(sign * bulge.unwrap_or(BULGE * chord)),
        Some(("sinus", _)) => {
            let amplitude = sign * amplitude.unwrap_or(AMPLITUDE * chord);
            Course::Sinus(amplitude, waves.unwrap_or(1))
        }
        Some((_, span)) => {
            let failure = Failure::fault(span, "this is no curve");
            return Err(failure.hint("there are straight, smooth, arc and sinus"));
        }
    };
    let idle = match course {
        Course::Arc(_) => amplitude.is_some() || waves.is_some(),
        Course::Sinus(..) => bulge.is_some(),
        _ => bulge.is_some() || amplitude.is_some() || waves.is_some(),
    };
    if idle {
        let failure = Failure::fault(span, "this curve has no use for these values");
        return Err(failure.hint("an arc has a bulge, a sinus an amplitude and waves"));
    }
    Ok(course)
}

/// How far to the left of a chord, metres: a length, or a share of the chord.
fn aside(
    arguments: &mut Arguments<'_>,
    scope: &mut Scope<'_>,
    name: &'static str,
    chord: f64,
) -> Result<Option<f64>, Failure> {
    let Some(expr) = arguments.named(name) else {
        return Ok(None);
    };
    let number = scope.number(expr)?;
    let wrong = || Failure::fault(expr.span, format!("{name} is a length or a share"));
    metres(number, chord).ok_or_else(wrong).map(Some)
}

/// A line that goes through the region from boundary to boundary.
struct Through {
    /// The line up to the boundary, and a hair beyond.
    middle: Vec<Coord<f64>>,
    /// The same, so far beyond that a path on it is cut off by the boundary alone.
    long: Vec<Coord<f64>>,
}

/// The line with its ends on the boundary or outside.
fn extended(region: &Region, line: Vec<Coord<f64>>, width: f64) -> Through {
    let (low, high) = region.area.extent();
    let size = dist(low, high);
    let mut middle = line;
    let mut long = Vec::new();
    // One end, and after turning the line round the other.
    for _ in 0..2 {
        middle.reverse();
        long.reverse();
        let [.., before, end] = middle.as_slice() else {
            break;
        };
        let (end, along) = (*end, unit(*end - *before));
        let hair = BEYOND * size;
        let inside = region.area.contains(end) && region.area.nearest(end).1 > ON * size;
        let way = if inside {
            way_out(&region.area, end, along).unwrap_or(size)
        } else {
            0.0
        };
        if long.is_empty() {
            long.clone_from(&middle);
        }
        middle.push(end + along * (way + hair));
        // As far again as a path is wide for each unit that it leans. The end itself
        // is no vertex of it: the path has no joint there.
        long.pop();
        long.push(end + along * (way + 2.0 * width + hair));
    }
    Through { middle, long }
}

/// How far the boundary lies ahead.
fn way_out(area: &Area, from: Coord<f64>, along: Coord<f64>) -> Option<f64> {
    let meets = area
        .rings()
        .flat_map(|ring| sides(ring))
        .filter_map(|(a, b)| {
            let det = cross(along, b - a);
            let way = cross(a - from, b - a) / det;
            let share = cross(a - from, along) / det;
            (way > 0.0 && (-1e-12..=1.0 + 1e-12).contains(&share)).then_some(way)
        });
    meets.min_by(f64::total_cmp)
}

/// The parts beside a line, and the path on it.
fn cut(
    region: &Region,
    line: &Through,
    width: f64,
    watch: &Watch<'_>,
) -> Result<(Vec<Area>, Vec<Area>), Failure> {
    watch.look()?;
    let land = std::slice::from_ref(&region.area);
    if width <= 0.0 {
        let parts = slice(&region.area, std::slice::from_ref(&line.middle));
        return Ok((parts, Vec::new()));
    }
    let band = ribbon(&line.long, width);
    let near = BEYOND * width;
    // Whether the line runs in it: has a point there, or comes in at one of its edges.
    let met = |path: &Area| {
        let mut points = line.middle.iter();
        points.any(|&p| path.contains(p) || path.nearest(p).1 <= near)
            || line.middle.windows(2).any(|pair| {
                let way = pair[1] - pair[0];
                let mut edges = path.rings().flat_map(|ring| sides(ring));
                edges.any(|(a, b)| {
                    let [u, v] = [a, b].map(|x| cross(way, x - pair[0]));
                    let [p, q] = [pair[0], pair[1]].map(|x| cross(b - a, x - a));
                    u * v < 0.0 && p * q < 0.0
                })
            })
    };
    // Beyond its end a path may have met land that the line does not reach.
    let (mut paths, mut beyond) = (Vec::new(), Vec::new());
    for path in intersection(land, &band) {
        watch.look()?;
        if met(&path) { &mut paths } else { &mut beyond }.push(path);
    }
    // By the path as it goes on beyond the land: of its part inside, rounding would
    // leave hairs along the boundary, which join what it divides.
    let cover = if beyond.is_empty() {
        band
    } else {
        difference(&band, &beyond)
    };
    watch.look()?;
    Ok((difference(land, &cover), paths))
}

/// Whether a part lies to the left of a line, by its edges that border on it.
fn leans_left(part: &Region, line: &[Coord<f64>]) -> bool {
    let mut sum = 0.0;
    for ring in 0..part.rings() {
        for (a, b, edge) in part.edges(ring) {
            let own = edge.origin.marks.last();
            if own.is_none_or(|mark| mark.rule != "SplitAlong" || mark.depth + 1 != part.depth) {
                continue;
            }
            // A little into the land.
            let p = lerp(a, b, 0.5) + right(unit(b - a)) * (1e-6 * dist(a, b));
            let near = line.windows(2).map(|pair| {
                let at = nearest_on(pair[0], pair[1], p);
                (dist(at, p), cross(pair[1] - pair[0], p - at))
            });
            let found = near.min_by(|x, y| x.0.total_cmp(&y.0));
            sum += dist(a, b) * found.map_or(0.0, |(_, side)| side.signum());
        }
    }
    sum > 0.0
}
