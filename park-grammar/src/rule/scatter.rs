//! `Scatter(12) { 3: Tree | Bush }`: things at random places, without contact.
//!
//! `Scatter(12)` puts so many, `Scatter(density = 2)` so many on 100 square
//! metres; each point of the region is as likely as any other. The branches are
//! kinds, chosen by seed with the weights before their colons. Things keep apart
//! by their `room`, a radius that is the spread of the thing unless given, so
//! that crowns do not meet, and stay clear of what was put before. `margin` is
//! kept between footprints and the boundary. With `Poisson` the region is filled
//! as densely as the rooms allow (Poisson-disc sampling), or so many of such a
//! pattern are chosen. What finds no room is left out, and counted; after 30 in a row that
//! find none the rest is.

use geo_types::Coord;

use super::{darts, Arguments};
use crate::derive::{inside, Disc, Node, Places, Run, Size, Spot, Standing, Stream};
use crate::error::Failure;
use crate::plane::Sampler;
use crate::syntax::ast::{Branch, Head, Operation};

/// Most things of one operation.
const MOST: usize = 100_000;

/// Kinds with their weights and sizes.
struct Kinds<'o> {
    all: Vec<(&'o Branch, f64, Size)>,
    weight: f64,
}

pub(crate) fn scatter(
    run: &mut Run<'_>,
    node: &mut Node,
    operation: &Operation,
    places: &Places,
) -> Result<(), Failure> {
    let kinds = kinds(run, node, operation, places)?;
    let mut scope = run.scope(node, places);
    let mut arguments = Arguments::new(operation);
    let full = arguments.flag(&mut scope, "Poisson")?;
    let mut count = match arguments.next() {
        Some(argument) => Some(scope.count(&argument.value)?),
        None => None,
    };
    if let Some(density) = arguments.number(&mut scope, "density")? {
        let wanted = 0.01 * density.value * scope.region.area.size();
        count = Some(wanted.round().clamp(0.0, MOST as f64) as usize);
    }
    let room = arguments.metres(&mut scope, "room")?;
    let margin = arguments.metres(&mut scope, "margin")?.unwrap_or(0.0);
    arguments.done()?;
    if count.is_none() && !full {
        let failure = Failure::fault(operation.span, "how many things?");
        return Err(failure.hint("write Scatter(12), Scatter(density = 2) or Scatter(Poisson)"));
    }
    let before = run.tally();
    let sampler = Sampler::new(&node.region.area);
    let mut chance = node.chance.child();
    let mut own = Standing::default();
    let reach = |size: Size| room.unwrap_or(size.spread).max(0.0);
    let free = |node: &Node, own: &Standing, size: Size, at: Coord<f64>| {
        let (spot, reach) = (Spot::new(at, size.radius), reach(size));
        own.apart(at, reach, reach)
            && Run::room(node, spot, size.radius, reach)
            && (margin <= 0.0 || inside(&node.region.area, at, size.radius + margin))
    };
    let mut chosen: Vec<(Coord<f64>, usize)> = Vec::new();
    if full {
        darts::fill(
            &run.watch(node),
            &mut chance,
            &sampler,
            0.0,
            |chance, at| {
                let k = kinds.choose(chance);
                let size = kinds.all[k].2;
                free(node, &own, size, at).then(|| {
                    let radius = reach(size);
                    own.add(Disc::new(at, radius));
                    chosen.push((at, k));
                    // Without room of its own a thing has that of its footprint.
                    radius.max(size.radius).max(0.1)
                })
            },
        )?;
        while count.is_some_and(|count| chosen.len() > count) {
            let k = chance.below(chosen.len());
            chosen.swap_remove(k);
        }
        put(run, node, places, &kinds, &chosen, &mut chance)?;
    }
    let (mut left, mut missed) = (count.filter(|_| !full).unwrap_or(0), 0);
    while left > 0 {
        run.count(node)?;
        left -= 1;
        let k = kinds.choose(&mut chance);
        let size = kinds.all[k].2;
        let Some(at) = darts::one(&mut chance, &sampler, |at| free(node, &own, size, at)) else {
            run.scene.skipped += 1;
            missed += 1;
            if missed == darts::MISSES {
                run.scene.skipped += left;
                break;
            }
            continue;
        };
        missed = 0;
        let radius = reach(size);
        own.add(Disc::new(at, radius));
        put(run, node, places, &kinds, &[(at, k)], &mut chance)?;
    }
    run.suited(operation, before)
}

impl Kinds<'_> {
    fn choose(&self, chance: &mut Stream) -> usize {
        let mut left = chance.unit() * self.weight;
        for (k, (_, weight, _)) in self.all.iter().enumerate() {
            if left < *weight {
                return k;
            }
            left -= weight;
        }
        self.all.len().saturating_sub(1)
    }
}

fn put(
    run: &mut Run<'_>,
    node: &mut Node,
    places: &Places,
    kinds: &Kinds<'_>,
    chosen: &[(Coord<f64>, usize)],
    chance: &mut Stream,
) -> Result<(), Failure> {
    for &(at, k) in chosen {
        let spot = Spot {
            at,
            radius: kinds.all[k].2.radius,
            facing: chance.between([0.0, std::f64::consts::TAU]),
        };
        run.try_spot(node, &kinds.all[k].0.body.operations, places, spot)?;
    }
    Ok(())
}

fn kinds<'o>(
    run: &mut Run<'_>,
    node: &mut Node,
    operation: &'o Operation,
    places: &Places,
) -> Result<Kinds<'o>, Failure> {
    let mut all = Vec::new();
    for branch in operation.blocks.iter().flat_map(|b| &b.branches) {
        let weight = match &branch.head {
            None => 1.0,
            Some(Head::Value(expr)) => run.scope(node, places).number(expr)?.value,
            Some(Head::Else(span)) => {
                return Err(Failure::fault(
                    *span,
                    "Scatter weighs; else belongs to Case",
                ));
            }
        };
        if weight < 0.0 {
            return Err(Failure::fault(branch.span, "a weight is 0 or more"));
        }
        all.push((branch, weight, run.size(node, &branch.body, places)?));
    }
    let weight = all.iter().map(|kind| kind.1).sum();
    if weight <= 0.0 {
        let failure = Failure::fault(operation.span, "there is nothing to scatter");
        return Err(failure.hint("write what in braces: Scatter(12) { Tree }"));
    }
    Ok(Kinds { all, weight })
}
