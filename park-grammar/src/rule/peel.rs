//! `Peel(OUTER) { 0.2: TreeStrip | GrassRegion }`: a strip along a part of the
//! boundary, and the rest.
//!
//! # What the notes ask, and what was decided
//!
//! The notes: the edges of a selection are extruded inwards, along their normals;
//! two closed regions come of it, the new one and what is left, with one border
//! between them. The selection is any: single edges, whole sides, or ranges of
//! parameters of them.
//!
//! **Size.** The notes give it as the second value, and in their example as the
//! number of the first branch; both are understood. A length with its unit is
//! metres; a percentage is a share; of bare numbers those below 1 are shares and
//! all others metres. A share of 1 is the depth at which nothing is left (with the
//! mitres of corners that turn inwards it may be so a little before): the distance to the land that is farthest from the selection (for the whole boundary
//! the radius of the largest circle inside), or, if that is less, how far the region
//! reaches behind the line of a selected edge (the most of all), so that 0.5 halves
//! a rectangle from one of its sides.
//!
//! **Corners** follow the edges next to the selection unless the flag
//! `CornersOrthogonal` is given: then the strip ends at right angles to the edge
//! that was peeled. Where the neighbour leads away from the land, or so flat along
//! that the strip would reach more than four depths beyond its end, it ends at
//! right angles in any case. Between selected edges the strip has mitred corners.
//! An edge is moved until it meets the boundary: land behind a bay is not peeled.
//!
//! **Several strips.** `Peel(OUTER) { 2 m: Hedge | 3 m: Path | Lawn }` peels one
//! strip after the other: each branch but the last has its size, a share always one
//! of the whole. It is the same as peeling the inner edge of what was left again.
//!
//! **Smoothing**, which the notes leave as a question: `smooth = average`,
//! `chaikin` or `round` (see [`smoothing`](super::smoothing)) smooths the border
//! between strip and rest, from one end of it to the other. The region's own
//! boundary stays; the strip is nowhere less than half as deep as asked. `reach` is
//! twice the depth unless given.
//!
//! **Holes.** A strip all round is a ring with a hole. With the flag `SplitHoles`
//! it is cut at its corners (see [`holes`]).
//!
//! **Memory.** In the strip, what was selected is `PEELED_BASE`, the border to the
//! rest `PEELED_INNER`, and with the short edges at the ends `PEELED_SEGMENT`; in
//! the rest the border is `PEELED_INNER` too. The rest keeps the numbers of its
//! sides: the border has those of the edges that it was moved from, and descends
//! from the sides of the park that those do. The strip is numbered by its own
//! coordinates; a whole ring as the region is.
//!
//! Outputs: the strips in their order, the rest.

use geo_types::Coord;

use super::smoothing::Smoother;
use super::{holes, Arguments, Ask, Output, Partition};
use crate::derive::{outputs, Number, Watch};
use crate::error::Failure;
use crate::plane::{
    box_along, difference, dist, farthest, intersection, lerp, named_by, nearest_on, right, trim,
    unit, Area, Band, Bound, Ends, Segment,
};
use crate::select::{named, Selection, Step};
use crate::shape::{Edge, Heritage, Local, Mark, Origin, Region, Role};
use crate::syntax::ast::{Head, Span, Unit};

/// What is smaller than this share of the region is rounding.
const SLIVER: f64 = 1e-12;

/// Points this near, as a share of the region's size, are on a line.
const ON: f64 = 1e-7;

/// Strips thinner than this share of the region's size are none.
const THINNEST: f64 = 1e-5;

/// A border that is smoothed leaves at least this share of the depth.
const LEAST: f64 = 0.5;

/// How a strip is peeled.
#[derive(Clone, Copy, Debug)]
struct Way {
    ends: Ends,
    smoother: Option<Smoother>,
}

pub(crate) fn peel(ask: &mut Ask<'_, '_>) -> Result<Partition, Failure> {
    let span = ask.operation.span;
    let scope = &mut ask.scope;
    let mut arguments = Arguments::new(ask.operation);
    let first = arguments.need("a selection, such as OUTER")?;
    let selection = scope.selection(&first.value)?;
    let square = arguments.flag(scope, "CornersOrthogonal")?;
    let split = holes::wanted(&mut arguments, scope)?;
    let smoother = Smoother::read(&mut arguments, scope, None)?;
    let mut sizes: Vec<(Number, Span)> = Vec::new();
    let mut given = first.at.iter().collect::<Vec<_>>();
    given.extend(arguments.next().map(|argument| &argument.value));
    given.extend(arguments.named("size"));
    for expr in given {
        sizes.push((scope.number(expr)?, expr.span));
    }
    arguments.done()?;
    let heads = heads(ask)?;
    match (sizes.len(), heads.len()) {
        (0, 0) => {
            let failure = Failure::fault(span, "Peel needs a size");
            return Err(failure.hint("write Peel(OUTER, 3 m), or the size before a branch"));
        }
        (1, 0) | (0, _) => sizes.extend(heads),
        _ => return Err(Failure::fault(span, "the size is given twice")),
    }
    let region = ask.scope.region;
    if selection.stretches().is_empty() {
        return Err(Failure::unfit(
            span,
            "there is nothing to peel: the selection is empty",
        ));
    }
    let watch = ask.scope.watch();
    let whole = whole(region, &selection);
    let mut depths = Vec::with_capacity(sizes.len());
    for (size, at) in sizes {
        depths.push(depth(size, whole, at)?);
    }
    let way = Way {
        ends: if square { Ends::Square } else { Ends::Follow },
        smoother,
    };
    let mut strips: Vec<Vec<Region>> = Vec::with_capacity(depths.len());
    let mut rests: Vec<Region> = Vec::new();
    for (k, &depth) in depths.iter().enumerate() {
        if depth < THINNEST * size(region) {
            return Err(Failure::unfit(
                span,
                format!("a strip of {depth} m is too thin to be made"),
            ));
        }
        let mut strip = Vec::new();
        if k == 0 {
            [strip, rests] = once(region, &selection, depth, way, &watch)?;
        } else {
            let mut left = Vec::new();
            for rest in &rests {
                let inner = named::named(rest, "PEELED_INNER").unwrap_or_default();
                let [more, rest] = once(rest, &inner, depth, way, &watch)?;
                strip.extend(more);
                left.extend(rest);
            }
            rests = left;
        }
        if rests.is_empty() {
            let deep: f64 = depths[..=k].iter().sum();
            let error = format!("a strip of {deep:.1} m leaves nothing of this region");
            return Err(Failure::unfit(span, error));
        }
        strips.push(strip);
    }
    let mut outputs: Vec<Output> = strips.into_iter().map(Output::lawns).collect();
    outputs.push(Output::lawns(rests));
    if split {
        holes::split_all(&mut outputs, &watch)?;
    }
    Ok(Partition { outputs })
}

/// The sizes before the branches: of none, or of all but the last one.
fn heads(ask: &mut Ask<'_, '_>) -> Result<Vec<(Number, Span)>, Failure> {
    let mut sizes = Vec::new();
    let mut bare = None;
    for branch in outputs(ask.operation).into_iter().flatten() {
        match &branch.head {
            None => bare = Some(branch.span),
            Some(Head::Else(span)) => {
                return Err(Failure::fault(
                    *span,
                    "Peel has sizes; else belongs to Case",
                ));
            }
            Some(Head::Value(expr)) => {
                if bare.is_some() {
                    let failure = Failure::fault(expr.span, "what is left has no size");
                    return Err(
                        failure.hint("the last branch takes the rest, those before have sizes")
                    );
                }
                sizes.push((ask.scope.number(expr)?, expr.span));
            }
        }
    }
    Ok(sizes)
}

/// Whether a size is a share: a percentage, or a bare number below 1.
pub(crate) fn is_share(size: Number) -> bool {
    match size.unit {
        Unit::Percent => true,
        Unit::None => size.value.abs() < 1.0,
        _ => false,
    }
}

/// A size in metres, a share being one of `whole`.
pub(crate) fn metres(size: Number, whole: f64) -> Option<f64> {
    if is_share(size) {
        size.share(1.0).map(|share| share * whole)
    } else {
        size.metres()
    }
}

/// A size in metres that is one.
pub(crate) fn depth(size: Number, whole: f64, span: Span) -> Result<f64, Failure> {
    match metres(size, whole) {
        Some(metres) if metres > 0.0 && metres.is_finite() => Ok(metres),
        Some(_) => Err(Failure::fault(span, "a size must be positive")),
        None => Err(Failure::fault(span, "a length or a share was expected")),
    }
}

/// Width or height of a region, whichever is larger.
fn size(region: &Region) -> f64 {
    let (low, high) = region.area.extent();
    (high.x - low.x).max(high.y - low.y)
}

/// The depth that is all of a region, seen from a selection.
pub(crate) fn whole(region: &Region, selection: &Selection) -> f64 {
    let lines = selection.lines(region);
    let segments: Vec<Segment> = lines
        .iter()
        .flat_map(|line| line.windows(2).map(|pair| (pair[0], pair[1])))
        .collect();
    let behind = segments.iter().map(|&(a, b)| {
        let inward = right(unit(b - a));
        let deep = |p: &Coord<f64>| crate::plane::dot(*p - a, inward);
        region.area.outer.iter().map(deep).fold(0.0, f64::max)
    });
    farthest(&region.area, &segments)
        .1
        .min(behind.fold(0.0, f64::max))
}

/// An edge that was moved.
struct Base<'r> {
    a: Coord<f64>,
    b: Coord<f64>,
    edge: &'r Edge,
}

/// What is known of the new edges of one peel.
struct Cut<'r> {
    region: &'r Region,
    bases: Vec<Base<'r>>,
    flanks: Vec<Segment>,
    on: f64,
}

/// Peels one strip: the strip, and what is left.
fn once(
    region: &Region,
    selection: &Selection,
    depth: f64,
    way: Way,
    watch: &Watch<'_>,
) -> Result<[Vec<Region>; 2], Failure> {
    watch.look()?;
    let steps = selection.steps(region);
    let bounds = |rings: &[Vec<Step>]| -> Vec<Vec<Bound>> {
        let bound = |step: &Step| Bound {
            at: step.at,
            moves: step.picked,
        };
        rings
            .iter()
            .map(|ring| ring.iter().map(bound).collect())
            .collect()
    };
    let bounds = bounds(&steps);
    let band = Band::new(&bounds, depth, way.ends, || watch.look())?;
    watch.look()?;
    let land = std::slice::from_ref(&band.land);
    let mut rest = difference(land, &band.cover);
    if let Some(smoother) = way.smoother {
        rest = trim(rest, size(region));
        watch.look()?;
        rest = smoothed(region, &band, rest, &smoother.within(2.0 * depth));
        let least = Band::new(&bounds, LEAST * depth, way.ends, || watch.look())?;
        watch.look()?;
        rest = difference(&rest, &least.cover);
    }
    let least = SLIVER * region.area.size();
    rest = trim(rest, size(region));
    rest.retain(|area| area.size() > least);
    watch.look()?;
    // Not by the band, whose cells meet in edges that would be slits up to rounding.
    let mut strip = difference(land, &rest);
    strip = trim(strip, size(region));
    strip.retain(|area| area.size() > least);

    let bases = steps.iter().enumerate().flat_map(|(ring, steps)| {
        let n = steps.len();
        let edges = &region.edges[ring];
        (0..n).filter(|&k| steps[k].picked).map(move |k| Base {
            a: steps[k].at,
            b: steps[(k + 1) % n].at,
            edge: &edges[steps[k].edge],
        })
    });
    let cut = Cut {
        region,
        bases: bases.collect(),
        flanks: band.flanks,
        on: ON * size(region),
    };
    let heritage = Heritage::new(region, "Peel");
    let made = |areas: Vec<Area>, made: &dyn Fn(Area) -> Region| -> Result<Vec<Region>, Failure> {
        let each = |area| watch.look().map(|()| made(area));
        areas.into_iter().map(each).collect()
    };
    Ok([
        made(strip, &|area| cut.strip(&heritage, area))?,
        made(rest, &|area| cut.rest(&heritage, area))?,
    ])
}

/// What is left, with its border smoothed where it is not the region's own.
fn smoothed(region: &Region, band: &Band, rest: Vec<Area>, smoother: &Smoother) -> Vec<Area> {
    let near = 1e-9 * size(region);
    let ring = |ring: &crate::plane::Ring| {
        let pinned: Vec<bool> = ring
            .iter()
            .map(|&p| region.area.nearest(p).1 <= near)
            .collect();
        smoother.ring(ring, &pinned)
    };
    let areas: Vec<Area> = rest
        .iter()
        .map(|area| Area::new(ring(&area.outer), area.holes.iter().map(ring).collect()))
        .collect();
    intersection(&areas, std::slice::from_ref(&band.land))
}

impl Cut<'_> {
    /// The edge that a new one was moved from: the nearest, of several the one
    /// that it runs along most, of those the one whose side has the lowest number:
    /// that is so in mirror images too.
    fn mover(&self, a: Coord<f64>, b: Coord<f64>) -> Option<&Edge> {
        let (at, along) = (lerp(a, b, 0.5), unit(b - a));
        let key = |base: &Base<'_>| {
            let away = dist(nearest_on(base.a, base.b, at), at);
            let turned = crate::plane::dot(unit(base.b - base.a), along).abs();
            let rounded = |x: f64, to: f64| (x / to).round();
            (rounded(away, self.on), rounded(-turned, ON), base.edge.side)
        };
        let found = self.bases.iter().min_by(|x, y| {
            let (x, y) = (key(x), key(y));
            let turned = x.1.total_cmp(&y.1);
            x.0.total_cmp(&y.0).then(turned).then(x.2.cmp(&y.2))
        });
        found.map(|base| base.edge)
    }

    /// Whether both ends lie on a segment.
    fn lies_on(&self, (p, q): Segment, a: Coord<f64>, b: Coord<f64>) -> bool {
        [a, b]
            .iter()
            .all(|&x| dist(nearest_on(p, q, x), x) <= self.on)
    }

    fn is_base(&self, a: Coord<f64>, b: Coord<f64>) -> bool {
        let at = lerp(a, b, 0.5);
        self.bases.iter().any(|base| {
            dist(nearest_on(base.a, base.b, at), at) <= self.on
                && crate::plane::dot(unit(base.b - base.a), unit(b - a)) > 0.5
        })
    }

    /// A new edge, with the side that `side` gives it from its mover's.
    fn new_edge(&self, heritage: &Heritage<'_>, a: Coord<f64>, b: Coord<f64>, keep: bool) -> Edge {
        let flank = self.flanks.iter().any(|&flank| self.lies_on(flank, a, b));
        let mover = self.mover(a, b);
        Edge {
            side: mover.and_then(|edge| edge.side).filter(|_| keep),
            origin: Origin {
                boundary: None,
                descent: mover.and_then(|edge| edge.origin.descent),
                marks: vec![heritage.mark(if flank { Role::Flank } else { Role::Inner })],
            },
        }
    }

    fn strip(&self, heritage: &Heritage<'_>, area: Area) -> Region {
        let made = |a, b, source: Option<&Edge>| match source {
            Some(edge) => {
                let role = if self.is_base(a, b) {
                    Role::Base
                } else {
                    Role::Flank
                };
                marked(edge.clone(), heritage.mark(role))
            }
            None => self.new_edge(heritage, a, b, false),
        };
        self.finished(heritage, area, made)
    }

    fn rest(&self, heritage: &Heritage<'_>, area: Area) -> Region {
        let made = |a, b, source: Option<&Edge>| match source {
            Some(edge) => edge.clone(),
            None => self.new_edge(heritage, a, b, true),
        };
        self.finished(heritage, area, made)
    }

    fn finished(
        &self,
        heritage: &Heritage<'_>,
        area: Area,
        made: impl Fn(Coord<f64>, Coord<f64>, Option<&Edge>) -> Edge,
    ) -> Region {
        let local = within(self.region, &area);
        let mut piece = heritage.made(area, local, made);
        piece.cell = self.region.cell;
        crate::index::kept(&mut piece, self.region.sides);
        piece
    }
}

fn marked(mut edge: Edge, mark: Mark) -> Edge {
    edge.origin.marks.push(mark);
    edge
}

/// The local coordinates of a part of a region: those of its box along the
/// region's axes, which reach as the region's do.
pub(crate) fn within(region: &Region, area: &Area) -> Local {
    let [x, y] = region.local.axes();
    let corners = named_by(box_along(&area.outer, x), x, y);
    Local {
        corners,
        reach: region.local.reach,
    }
}
