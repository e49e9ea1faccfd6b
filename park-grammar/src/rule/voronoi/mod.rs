//! `VoronoiRegions(places, smoothing) { regions } { paths } { centres }`, also
//! called `VoronoiSmoothed`: regions that grow from places until they meet, with
//! paths between them.
//!
//! # What the notes ask, and what was decided
//!
//! *Places* are those of `ScatterCircles` or any others; what lies outside the
//! region is left out, and of several at one point all but the first. The cell of
//! a place is what lies nearer to it than to any other. In a region that is
//! concave or has holes a part of a cell that is cut off from its place joins the
//! neighbour with which it has the longest border ([`cells`]), so that each cell
//! is one piece. With the flag `Weighted` larger circles grow further: cells of
//! the power distance with the places' radii, in which circles that do not touch
//! lie whole in their own cells.
//!
//! *Borders* are displaced along their normals by random values of at most
//! `amplitude` (0 m: straight) every `wavelength` (six amplitudes), the same for
//! both neighbours ([`borders`]).
//!
//! *Paths.* "Regions are reduced by path_width/2 to give way to the paths": on
//! either side of each border, so that paths have their width everywhere and
//! meet in junctions. Along the region's own boundary nothing is taken, unless
//! `around = 2 m` asks for a path of that width all around (`Around` one of the
//! width of the others). What is smaller than `least` (the square of the width)
//! is path. `{}` for the paths: cells border each other.
//!
//! *Smoothing* is the second argument, or `smooth =`: `average`, `chaikin`,
//! `round` or `none`, with `times`, `radius` and `reach` as
//! [`smoothing`](super::smoothing) has them. Unspecified it is `average`, twice,
//! as the notes say, within four widths of a path from each corner; without paths
//! none. A region is smoothed inside itself, so
//! that paths only become wider; what lies on the boundary of the divided region
//! is not moved.
//!
//! *Centres*: "it should also be possible to build something at the region
//! centres". The shape that the third block begins with is cut out at the place
//! of each cell, or where its region has most room if it does not fit there;
//! where it does not fit at all there is none. A block without a shape has a
//! circle with the place's own room (`ScatterCircles`, `Places[5]`), as far as
//! there is room.
//!
//! *Sides.* Of "one selection method has to be chosen": a side is a run of edges
//! beside one neighbour or one side of the divided region. Side 0 is the longest
//! one on the boundary, else the longest; the others follow clockwise. In local
//! coordinates side 0 is the western one of the box along it.
//!
//! Outputs: regions, paths, centres.
//!
//! # Cost
//!
//! About n^1.5 for n places spread evenly, with one boolean for each cell.

mod borders;
mod cells;
mod lawns;

use super::grid::piece;
use super::sites::{self, sites};
use super::smoothing::Smoother;
use super::{Arguments, Ask, Output, Partition};
use crate::derive::{outputs, Spot, Stream, Watch};
use crate::error::Failure;
use crate::plane::{lerp, oriented_box, rest, Diagram, Ring, Site};
use crate::shape::{Heritage, Region, Role};

use borders::Wave;
use lawns::{Content, Plan, Walls};

/// More places are a mistake.
const MOST: usize = 20_000;

/// What is smaller than this share of the region is rounding.
const SLIVER: f64 = 1e-12;

/// Unless the grammar says how regions are smoothed, that is done within so many
/// widths of a path from corners.
const REACH: f64 = 4.0;

/// What is asked, apart from the region.
struct Asked {
    spots: Vec<Spot>,
    weighted: bool,
    wave: Wave,
    plan: Plan,
    content: Content,
}

pub(crate) fn voronoi(ask: &mut Ask<'_, '_>) -> Result<Partition, Failure> {
    let asked = read(ask)?;
    let mut chance = ask.scope.chance.child();
    let watch = ask.scope.watch();
    let found = divided(ask.scope.region, &asked, &mut chance, Some(&watch))?;
    super::with_room(found, ask.operation)
}

/// Divides a region, however long it takes.
#[cfg(test)]
fn divide(region: &Region, asked: &Asked, chance: &mut Stream) -> Option<Partition> {
    divided(region, asked, chance, None).ok().flatten()
}

/// Divides a region; `None` if nothing but paths would be left.
fn divided(
    region: &Region,
    asked: &Asked,
    chance: &mut Stream,
    watch: Option<&Watch<'_>>,
) -> Result<Option<Partition>, Failure> {
    let look = || watch.map_or(Ok(()), Watch::look);
    let Asked {
        spots, wave, plan, ..
    } = asked;
    let grown: Vec<Site> = spots
        .iter()
        .map(|spot| Site {
            at: spot.at,
            weight: if asked.weighted {
                spot.radius * spot.radius
            } else {
                0.0
            },
        })
        .collect();
    let diagram = Diagram::new(&grown, &frame(region));
    look()?;
    let rings = borders::rings(&diagram, &grown, wave, chance);
    look()?;
    let at: Vec<_> = grown.iter().map(|site| site.at).collect();
    let cells = cells::within(&region.area, &rings, &at);

    let heritage = Heritage::new(region, "VoronoiRegions");
    let mut walls = Vec::new();
    // Lawns with the number of their walls, and centres.
    let (mut whose, mut pieces, mut centres) = (Vec::new(), Vec::new(), Vec::new());
    for cell in &cells {
        watch.map_or(Ok(()), Watch::tick)?;
        let wall = Walls::new(cell, &heritage);
        let lawns = plan.lawns(cell, &wall);
        let spot = spots[cell.site];
        let centre = lawns::middle_of(&lawns, spot.at)
            .and_then(|lawn| plan.centre(&lawn, spot, asked.content, region));
        for lawn in lawns::without(lawns, centre.as_ref()) {
            whose.push((walls.len(), centre.clone()));
            pieces.push(lawn);
        }
        centres.extend(centre);
        walls.push(wall);
    }
    if pieces.is_empty() && centres.is_empty() {
        return Ok(None);
    }
    look()?;
    let count = pieces.len();
    pieces.extend(centres);
    let (mut pieces, paths) = rest(&region.area, pieces);
    let centres = pieces.split_off(count);
    let has_paths = plan.half > 0.0 || plan.smoother.is_some();
    let regions = pieces.into_iter().zip(whose).map(|(area, (wall, centre))| {
        let walls = &walls[wall];
        lawns::region(&heritage, region, area, walls, centre.as_ref(), has_paths)
    });
    let axes = region.local.axes();
    let least = SLIVER * region.area.size();
    let plain = |areas: Vec<crate::plane::Area>, role| -> Vec<Region> {
        let solid = areas.into_iter().filter(|area| area.size() > least);
        solid
            .map(|area| piece(&heritage, area, axes, role))
            .collect()
    };
    Ok(Some(Partition {
        outputs: vec![
            Output::lawns(regions.collect()),
            Output::paths(plain(paths, Role::Path)),
            Output::paths(plain(centres, Role::Centre)),
        ],
    }))
}

fn read(ask: &mut Ask<'_, '_>) -> Result<Asked, Failure> {
    let span = ask.operation.span;
    let scope = &mut ask.scope;
    let mut arguments = Arguments::new(ask.operation);
    let places = arguments.need("places, such as ScatterCircles(5 {[5, 10]})")?;
    let weighted = arguments.flag(scope, "Weighted")?;
    let all_around = arguments.flag(scope, "Around")?;
    let width = super::path_width(&mut arguments, scope, ask.path_width)?;
    let not_negative = |value: Option<f64>, what: &str| match value {
        Some(value) if value < 0.0 => Err(Failure::fault(span, format!("{what} is 0 or more"))),
        other => Ok(other),
    };
    let around = not_negative(arguments.metres(scope, "around")?, "around")?;
    let amplitude = not_negative(arguments.metres(scope, "amplitude")?, "amplitude")?;
    let amplitude = amplitude.unwrap_or(0.0);
    let length = arguments.metres(scope, "wavelength")?;
    let length = length.unwrap_or(6.0 * amplitude);
    if amplitude > 0.0 && length <= 0.0 {
        return Err(Failure::fault(span, "wavelength must be positive"));
    }
    let least = arguments.number(scope, "least")?.map(|n| n.value);
    let least = not_negative(least, "least")?.unwrap_or(width * width);
    let named = arguments.named("smooth");
    let way = named.or(arguments.next().map(|argument| &argument.value));
    let default = (width > 0.0).then(|| Smoother::AVERAGE.within(REACH * width));
    let smoother = Smoother::of(way, &mut arguments, scope, default)?;
    arguments.done()?;
    let spots = sites(scope, &places.value, MOST)?;
    let third = outputs(ask.operation).get(2).copied().flatten();
    let content = match (third, ask.centre) {
        (None, _) => Content::Nothing,
        (_, Some(shape)) => Content::Shape(shape),
        (Some(_), None) if spots.iter().any(|spot| spot.radius > 0.0) => Content::Room,
        (Some(block), None) => {
            let failure = Failure::fault(block.span, "how large are the centres?");
            return Err(failure.hint("begin with a shape, such as Circle(2)"));
        }
    };
    let around = around.unwrap_or(if all_around { width } else { 0.0 });
    Ok(Asked {
        spots,
        weighted,
        wave: Wave { amplitude, length },
        plan: Plan {
            half: 0.5 * width,
            around,
            least: least.max(SLIVER * scope.region.area.size()),
            smoother,
            size: sites::size(scope.region),
        },
        content,
    })
}

/// A convex frame around a region that turns with it.
fn frame(region: &Region) -> Ring {
    let corners = oriented_box(&region.area.outer);
    let middle = lerp(corners[0], corners[2], 0.5);
    corners.map(|corner| lerp(middle, corner, 1.2)).to_vec()
}

#[cfg(test)]
mod tests;
