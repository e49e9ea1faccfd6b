//! `Smooth(round, radius = 4 m) { Smooth | Rest }`: a region with its boundary
//! smoothed, and what that cuts off.
//!
//! The notes ask for smoothed regions and leave open how they are smoothed; the ways
//! are those of [`smoothing`](super::smoothing): `average` (twice, as the notes have
//! it for Voronoi regions, unless said), `chaikin`, `round`, with `times`, `radius`
//! and `reach`. The second value, or `along`, is the part of the boundary to be
//! smoothed: vertices inside of it and at corners between its edges; all of it
//! unless said.
//!
//! A partition stays within its region, so that corners that turn inwards cannot be
//! filled: a smooth border would have to swing out around them. It does if it gets
//! room: with `margin = 1 m` the boundary is drawn in by so much before it is
//! smoothed, and what is smoothed may use the margin.
//!
//! With the flag `SplitHoles` neither output has holes.
//!
//! Outputs: the smoothed region, what is cut off.

use geo_types::Coord;

use super::parts::Parts;
use super::smoothing::Smoother;
use super::{holes, Arguments, Ask, Output, Partition};
use crate::error::Failure;
use crate::plane::{difference, inset, intersection, with_vertices, Area, Ring};
use crate::select::{Selection, Step};
use crate::shape::{Region, Role};

pub(crate) fn smooth(ask: &mut Ask<'_, '_>) -> Result<Partition, Failure> {
    let span = ask.operation.span;
    let scope = &mut ask.scope;
    let mut arguments = Arguments::new(ask.operation);
    let split = holes::wanted(&mut arguments, scope)?;
    let way = arguments.next().map(|argument| &argument.value);
    let smoother = Smoother::of(way, &mut arguments, scope, Some(Smoother::AVERAGE))?;
    let along = arguments.next().map(|argument| &argument.value);
    let along = along.or_else(|| arguments.named("along"));
    let along = along.map(|expr| scope.selection(expr)).transpose()?;
    let margin = arguments.metres(scope, "margin")?.unwrap_or(0.0);
    if margin < 0.0 || (margin > 0.0 && along.is_some()) {
        let failure = Failure::fault(span, "a margin is 0 or more, and all along the boundary");
        return Err(failure.hint("leave out margin, or the selection"));
    }
    arguments.done()?;
    let region = scope.region;
    let watch = scope.watch();
    let land = std::slice::from_ref(&region.area);
    let areas = match smoother {
        None => land.to_vec(),
        Some(smoother) if margin > 0.0 => {
            let free = |ring: &Ring| smoother.ring(ring, &vec![false; ring.len()]);
            let inner = inset(&region.area, margin, || watch.look())?;
            let smoothed = inner
                .iter()
                .map(|area| Area::new(free(&area.outer), area.holes.iter().map(free).collect()));
            smoothed.collect()
        }
        Some(smoother) => {
            let along = along.unwrap_or_else(|| Selection::all(region));
            vec![smoothed(region, &along, &smoother)]
        }
    };
    let vertices: Vec<Coord<f64>> = areas
        .iter()
        .flat_map(Area::rings)
        .flatten()
        .copied()
        .collect();
    let land = with_vertices(&region.area, &vertices);
    let land = std::slice::from_ref(&land);
    watch.look()?;
    let inner = intersection(&areas, land);
    watch.look()?;
    let rest = difference(land, &areas);
    watch.look()?;
    let parts = Parts::new(region, "Smooth");
    let inner = parts.regions(inner, Role::Seam, &watch)?;
    if inner.is_empty() {
        return Err(Failure::unfit(span, "nothing is left of this region"));
    }
    let mut outputs = vec![
        Output::lawns(inner),
        Output::lawns(parts.regions(rest, Role::Seam, &watch)?),
    ];
    if split {
        holes::split_all(&mut outputs, &watch)?;
    }
    Ok(Partition { outputs })
}

/// The region with a part of its boundary smoothed.
fn smoothed(region: &Region, along: &Selection, smoother: &Smoother) -> Area {
    let rings = along.steps(region);
    let ring = |steps: &Vec<Step>| {
        let n = steps.len();
        let points: Ring = steps
            .iter()
            .map(|step| step.at)
            .collect::<Vec<Coord<f64>>>();
        // A vertex is free between two edges that are selected.
        let stays = |k: usize| !(steps[k].picked && steps[(k + n - 1) % n].picked);
        let pinned: Vec<bool> = (0..n).map(stays).collect();
        smoother.ring(&points, &pinned)
    };
    let mut rings = rings.iter().map(ring);
    let outer = rings.next().unwrap_or_default();
    Area::new(outer, rings.collect())
}
