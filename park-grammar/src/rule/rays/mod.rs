//! `CastRays(centres, targets) { regions } { paths } { centres }`: paths that lead
//! straight from centres to the boundary, and from centre to centre.
//!
//! # What the notes ask, and what was decided
//!
//! *Blocks.* The notes' example has the centre's block first, their interface of
//! the rule regions and paths; all partitions here have regions, paths, centres.
//!
//! *Centres* are places; those outside of the region are left out. A centre may
//! have a size, `CentrePoint[5]`, or a shape, with which the third block begins.
//! With a third block it is a region of its own, a circle of its size if the block
//! begins with no shape; without one a size that is written makes a round place in
//! the path. What a circle of `ScatterCircles` keeps free is no size unless there
//! is a third block. A centre is clipped to the region, and to earlier ones.
//!
//! *Targets* are places, a number of directions or a list of them ([`targets`]);
//! `from` is the first of a number (90 degrees, north). `rays =` says which are
//! cast: `nearest`, from each centre to its nearest target; `unconnected`
//! (default), to each target from its nearest centre; `all`, from each centre to
//! each target. Rays cross no other path ([`network`]), and none leads outside;
//! one that would leave a centre, or reach a target, at less than `apart` (10
//! degrees) from another path is not cast, as it would be the same walk.
//!
//! *Joins* of centres are `join = none`, `loop` (default), `open` (a loop without
//! one edge), `pairs`, `opposites`, `delaunay` or `tree` ([`joins`]).
//!
//! *Paths* are `width` wide and cut off along the boundary; where they meet, they
//! are one. What is smaller than `least` (the square of the width) is path. `{}`
//! for the paths: the region is cut along their lines.
//!
//! *Sides* are counted from the centre, with signs ([`cells`]).
//!
//! Outputs: regions, paths, centres.
//!
//! # Cost
//!
//! The crossings of r rays r^2 segments; a join that goes round looks from each
//! bend it comes to at all others.

mod cells;
mod joins;
mod network;
mod targets;

use geo_types::Coord;

use super::grid::piece;
use super::sites::{self, shape_at, sites};
use super::{Arguments, Ask, Output, Partition, Primitive};
use crate::derive::{outputs, Scope, Spot, Stream, Watch};
use crate::error::Failure;
use crate::plane::{
    difference, dist, intersection, lerp, oriented_box, rest, slice, union, weld, Area, Diagram,
    Site,
};
use crate::shape::{Heritage, Region, Role};
use crate::syntax::ast::{Expr, ExprKind};

use cells::{clipped, extended, land, Between};
use joins::{Join, Link};
use network::{Network, Path, Rays};
use targets::Targets;

/// More centres are a mistake.
const MOST: usize = 1000;

/// What is smaller than this share of the region is rounding.
const SLIVER: f64 = 1e-12;

/// The least angle between paths unless the grammar says so: 10 degrees.
const NARROW: f64 = std::f64::consts::PI / 18.0;

/// Vertices this near, as a share of the region's size, are one.
const SAME: f64 = 1e-9;

/// How far beyond the boundary a line without a width is drawn to cut all of the
/// region, as a share of its size.
const BEYOND: f64 = 1e-6;

/// What is asked, apart from the region.
struct Asked {
    spots: Vec<Spot>,
    targets: Option<Targets>,
    rays: Rays,
    join: Join,
    hidden: bool,
    /// The least angle between a ray and a path beside it, radians.
    narrow: f64,
    width: f64,
    least: f64,
    /// The shape of each centre.
    shapes: Vec<Option<Primitive>>,
    /// Whether centres are an output of their own.
    output: bool,
}

pub(crate) fn rays(ask: &mut Ask<'_, '_>) -> Result<Partition, Failure> {
    let asked = read(ask)?;
    let mut chance = ask.scope.chance.child();
    let watch = ask.scope.watch();
    let found = divided(ask.scope.region, &asked, &mut chance, Some(&watch))?;
    super::with_room(found, ask.operation)
}

/// The walk-graph of a region.
fn walks(
    region: &Region,
    asked: &Asked,
    chance: &mut Stream,
    watch: Option<&Watch<'_>>,
) -> Result<Vec<Path>, Failure> {
    let (area, size) = (&region.area, sites::size(region));
    let at: Vec<Coord<f64>> = asked.spots.iter().map(|spot| spot.at).collect();
    let links = asked.join.links(&at, || neighbours(region, &at), chance);
    let radius = |shape: &Option<Primitive>| shape.map_or(0.0, Primitive::radius);
    let radii: Vec<f64> = asked.shapes.iter().map(radius).collect();
    let touching = touching(region, asked, &radii);
    let mut network = Network::new(area, size, 0.5 * asked.width, &at, &radii, &touching);
    network.narrow = asked.narrow;
    network.watch = watch.cloned();
    network.join(&links)?;
    if let Some(targets) = &asked.targets {
        network.cast(targets, asked.rays, asked.hidden)?;
        network.exits();
    }
    Ok(network.paths)
}

/// Divides a region, however long it takes.
#[cfg(test)]
fn divide(region: &Region, asked: &Asked, chance: &mut Stream) -> Option<Partition> {
    divided(region, asked, chance, None).ok().flatten()
}

/// Centres whose shapes share ground.
fn touching(region: &Region, asked: &Asked, radii: &[f64]) -> Vec<Link> {
    let shape = |k: usize| {
        let shape = asked.shapes[k]?;
        Some(shape_at(shape, asked.spots[k].at, &region.local))
    };
    let mut found = Vec::new();
    for k in 0..radii.len() {
        for j in 0..k {
            if dist(asked.spots[j].at, asked.spots[k].at) >= radii[j] + radii[k] {
                continue;
            }
            let both = shape(j).zip(shape(k));
            if both.is_some_and(|(a, b)| !intersection(&[a], &[b]).is_empty()) {
                found.push([j, k]);
            }
        }
    }
    found
}

/// Divides a region; `None` if nothing but paths would be left.
fn divided(
    region: &Region,
    asked: &Asked,
    chance: &mut Stream,
    watch: Option<&Watch<'_>>,
) -> Result<Option<Partition>, Failure> {
    let look = || watch.map_or(Ok(()), Watch::look);
    let (area, size) = (&region.area, sites::size(region));
    let at: Vec<Coord<f64>> = asked.spots.iter().map(|spot| spot.at).collect();
    let paths = walks(region, asked, chance, watch)?;
    let mut lands: Vec<Option<Area>> = Vec::new();
    for (&at, shape) in at.iter().zip(&asked.shapes) {
        look()?;
        let taken: Vec<Area> = lands.iter().flatten().cloned().collect();
        let whole = shape.map(|shape| shape_at(shape, at, &region.local));
        lands.push(whole.and_then(|whole| clipped(&whole, area, at, &taken)));
    }
    let cells = between(area, asked, &paths, &lands, size);
    look()?;
    let least = asked.least.max(SLIVER * area.size());
    let mut pieces: Vec<Area> = cells.into_iter().filter(|a| a.size() > least).collect();
    let count = pieces.len();
    let centres = lands.iter().flatten().filter(|_| asked.output);
    pieces.extend(centres.cloned());
    if pieces.is_empty() {
        return Ok(None);
    }
    let (mut pieces, walked) = rest(area, pieces);
    let centres = pieces.split_off(count);

    let heritage = Heritage::new(region, "CastRays");
    let between = Between {
        region,
        heritage: &heritage,
        paths: &paths,
        centres: &at,
        lands: &lands,
        width: asked.width,
        size,
    };
    let axes = region.local.axes();
    let plain = |areas: Vec<Area>, role| -> Vec<Region> {
        let solid = areas
            .into_iter()
            .filter(|a| a.size() > SLIVER * area.size());
        solid
            .map(|area| piece(&heritage, area, axes, role))
            .collect()
    };
    let regions = pieces.into_iter().map(|area| between.cell(area));
    Ok(Some(Partition {
        outputs: vec![
            Output::lawns(regions.collect()),
            Output::paths(plain(walked, Role::Path)),
            Output::paths(plain(centres, Role::Centre)),
        ],
    }))
}

/// What the paths and centres leave.
fn between(
    area: &Area,
    asked: &Asked,
    paths: &[Path],
    lands: &[Option<Area>],
    size: f64,
) -> Vec<Area> {
    let mut taken: Vec<Area> = lands.iter().flatten().cloned().collect();
    if asked.width > 0.0 {
        let covered = |centre: usize| {
            let shape = asked.shapes[centre];
            shape.is_some_and(|shape| shape.inner_radius() >= 0.5 * asked.width)
        };
        for path in paths {
            taken.extend(land(path, asked.width, area, size, &covered));
        }
    }
    // Strokes that lie on each other but for the last digits have no end of
    // crossings: first they must share their vertices.
    let taken = union(&weld(&taken.iter().collect::<Vec<_>>(), SAME * size));
    let all: Vec<&Area> = std::iter::once(area).chain(&taken).collect();
    let mut welded = weld(&all, SAME * size);
    let outline = if welded.is_empty() {
        area.clone()
    } else {
        welded.remove(0)
    };
    let left = difference(&[outline], &welded);
    if asked.width > 0.0 {
        return left;
    }
    let lines: Vec<Vec<Coord<f64>>> = paths
        .iter()
        .map(|path| extended(path, BEYOND * size))
        .collect();
    left.iter().flat_map(|area| slice(area, &lines)).collect()
}

/// Centres whose Voronoi cells meet in the frame of the region: its Delaunay
/// edges, without those between centres that only see each other far outside.
fn neighbours(region: &Region, at: &[Coord<f64>]) -> Vec<Link> {
    let corners = oriented_box(&region.area.outer);
    let middle = lerp(corners[0], corners[2], 0.5);
    let frame = corners.map(|corner| lerp(middle, corner, 1.2)).to_vec();
    let sites: Vec<Site> = at.iter().map(|&at| Site { at, weight: 0.0 }).collect();
    let borders = Diagram::new(&sites, &frame).borders();
    borders.into_iter().map(|border| border.between).collect()
}

fn read(ask: &mut Ask<'_, '_>) -> Result<Asked, Failure> {
    let span = ask.operation.span;
    let scope = &mut ask.scope;
    let mut arguments = Arguments::new(ask.operation);
    let centres = &arguments.need("centres, such as CENTRE")?.value;
    let targets = arguments.next().map(|argument| &argument.value);
    let width = super::path_width(&mut arguments, scope, ask.path_width)?;
    let least = arguments.number(scope, "least")?.map(|n| n.value);
    let least = least.unwrap_or(width * width);
    if least < 0.0 {
        return Err(Failure::fault(span, "least is 0 or more"));
    }
    let rays = word(
        scope,
        arguments.named("rays"),
        &network::WORDS,
        "which rays",
    )?;
    let join = word(scope, arguments.named("join"), &joins::WORDS, "how to join")?;
    let ways = [("drop", false), ("end", true)];
    let hidden = word(scope, arguments.named("hidden"), &ways, "what to do")?;
    let mut angle = |name: &'static str, default: f64| match arguments.named(name) {
        Some(expr) => {
            let wrong = || Failure::fault(expr.span, "an angle was expected");
            scope.number(expr)?.radians().ok_or_else(wrong)
        }
        None => Ok(default),
    };
    let from = angle("from", std::f64::consts::FRAC_PI_2)?;
    let narrow = angle("apart", NARROW)?;
    arguments.done()?;
    let targets = match targets {
        Some(expr) => Some(Targets::read(scope, expr, from)?),
        None => None,
    };
    let spots = sites(scope, centres, MOST)?;
    let third = outputs(ask.operation).get(2).copied().flatten();
    // Only what is written is a size where centres are no output.
    let written = third.is_some() || matches!(centres.kind, ExprKind::Index(..));
    let shape = |spot: &Spot| {
        let round = (written && spot.radius > 0.0).then_some(Primitive::Circle(spot.radius));
        ask.centre.or(round)
    };
    let shapes: Vec<Option<Primitive>> = spots.iter().map(shape).collect();
    if let Some(block) = third.filter(|_| shapes.iter().all(Option::is_none)) {
        let failure = Failure::fault(block.span, "how large are the centres?");
        return Err(failure.hint("begin with a shape, such as Circle(5), or write CENTRE[5]"));
    }
    Ok(Asked {
        spots,
        targets,
        rays: rays.unwrap_or(Rays::Unconnected),
        join: join.unwrap_or(Join::Loop),
        hidden: hidden.unwrap_or(false),
        width,
        least,
        shapes,
        output: third.is_some(),
        narrow,
    })
}

/// What a word means.
fn word<T: Copy>(
    scope: &mut Scope<'_>,
    expr: Option<&Expr>,
    words: &[(&str, T)],
    what: &str,
) -> Result<Option<T>, Failure> {
    let Some(expr) = expr else {
        return Ok(None);
    };
    let found = match scope.value(expr)? {
        crate::derive::Value::Word(word) => words.iter().find(|(name, _)| *name == word).copied(),
        _ => None,
    };
    if let Some((_, meaning)) = found {
        return Ok(Some(meaning));
    }
    let names: Vec<&str> = words.iter().map(|(name, _)| *name).collect();
    let failure = Failure::fault(expr.span, format!("this does not say {what}"));
    Err(failure.hint(format!("there are {}", names.join(", "))))
}

#[cfg(test)]
mod tests;
