//! `ScatterCircles(5 {[5, 10]})`: circles that touch neither each other nor the
//! boundary.
//!
//! As a value the circles are places with room around them, for `VoronoiRegions`
//! and `CastRays`; with a block they are cut out of the region, and the block is
//! done on each. Radii are drawn from the list in turn; without a list they are
//! such that the circles take a quarter of the region. Without a number as many
//! are scattered as there is room for (Poisson-disc sampling).
//!
//! Arguments by name: `gap` between circles and `margin` to the boundary (metres,
//! both 0 but for touching), `least`, the number of circles below which the
//! operation does not suit the region (1). Large circles are put first; one that
//! has no room anywhere is tried with the smallest radius of its range, and then
//! left out. The flag `Poisson` spreads a given number evenly: a full pattern is
//! made, and so many of it chosen.

use geo_types::Coord;

use super::{darts, Arguments, Primitive};
use crate::derive::{Disc, Node, Places, Run, Scope, Spot, Standing, Stream, Value, Watch};
use crate::error::Failure;
use crate::plane::{middle, pole, Sampler};
use crate::shape::Region;
use crate::syntax::ast::Operation;

/// More than touching, as a share of a radius.
const CLEAR: f64 = 1.0 + 1e-6;

/// Ways to put all circles that are tried before some are left out.
const ROUNDS: usize = 6;

/// What is asked.
struct Plan {
    count: Option<usize>,
    /// Ranges of radii.
    sizes: Vec<[f64; 2]>,
    gap: f64,
    margin: f64,
    least: usize,
    even: bool,
}

impl Plan {
    fn read(scope: &mut Scope<'_>, operation: &Operation) -> Result<Self, Failure> {
        let mut arguments = Arguments::new(operation);
        let even = arguments.flag(scope, "Poisson")?;
        let (mut count, mut sizes) = (None, Vec::new());
        if let Some(argument) = arguments.next() {
            let span = argument.value.span;
            match scope.value(&argument.value)? {
                Value::Sizing(sizing) => {
                    count = sizing.count;
                    for size in sizing.sizes {
                        let radius = size.length.filter(|r| r[0] > 0.0);
                        let wrong = || Failure::fault(span, "a circle has a radius above 0");
                        sizes.push(radius.ok_or_else(wrong)?);
                    }
                }
                Value::Number(_) | Value::List(_) => count = Some(scope.count(&argument.value)?),
                other => return Err(other.wrong(span, "a number of circles, such as 5 {[5, 10]}")),
            }
        }
        let gap = arguments.metres(scope, "gap")?.unwrap_or(0.0).max(0.0);
        let margin = arguments.metres(scope, "margin")?.unwrap_or(0.0).max(0.0);
        let least = match arguments.named("least") {
            Some(expr) => scope.count(expr)?,
            None => 1,
        };
        arguments.done()?;
        if sizes.is_empty() {
            let Some(count) = count.filter(|&n| n > 0) else {
                let failure = Failure::fault(operation.span, "how many circles, or how large?");
                return Err(failure.hint("write ScatterCircles(5) or ScatterCircles({[5, 10]})"));
            };
            let radius =
                (0.25 * scope.region.area.size() / (count as f64 * std::f64::consts::PI)).sqrt();
            sizes.push([0.7 * radius, radius]);
        }
        Ok(Self {
            count,
            sizes,
            gap,
            margin,
            least,
            even,
        })
    }

    /// The circles, where `free` ground is.
    fn scatter(
        &self,
        watch: &Watch<'_>,
        region: &Region,
        chance: &mut Stream,
        free: &dyn Fn(Coord<f64>, f64) -> bool,
    ) -> Result<Vec<Spot>, Failure> {
        let sampler = Sampler::new(&region.area);
        match self.count {
            None => self.full(watch, chance, &sampler, free),
            Some(count) if self.even => {
                let mut all = self.full(watch, chance, &sampler, free)?;
                while all.len() > count {
                    let k = chance.below(all.len());
                    all.swap_remove(k);
                }
                Ok(all)
            }
            Some(count) => {
                let mut best: Vec<Spot> = Vec::new();
                for round in 0..ROUNDS {
                    let found = self.some(watch, count, round, region, chance, &sampler, free)?;
                    if round == 0 || found.len() > best.len() {
                        best = found;
                    }
                    if best.len() == count {
                        break;
                    }
                }
                Ok(best)
            }
        }
    }

    #[allow(
        clippy::too_many_arguments,
        reason = "one round of a search that has no state of its own"
    )]
    fn some(
        &self,
        watch: &Watch<'_>,
        count: usize,
        round: usize,
        region: &Region,
        chance: &mut Stream,
        sampler: &Sampler,
        free: &dyn Fn(Coord<f64>, f64) -> bool,
    ) -> Result<Vec<Spot>, Failure> {
        let range = |k: usize| self.sizes[k % self.sizes.len()];
        let mut wanted: Vec<(f64, f64)> = (0..count)
            .map(|k| (chance.between(range(k)), range(k)[0]))
            .collect();
        wanted.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut standing = Standing::default();
        let mut spots = Vec::new();
        let mut missed = 0;
        for (radius, smallest) in wanted {
            watch.tick()?;
            if missed == darts::MISSES {
                break;
            }
            let fits = |at: Coord<f64>, radius: f64| self.fits(&standing, free, at, radius);
            let mut found =
                darts::one(chance, sampler, |at| fits(at, radius)).map(|at| (at, radius));
            if found.is_none() {
                let small = darts::one(chance, sampler, |at| fits(at, smallest));
                // Where there is little room darts may all miss it.
                let last = || [pole(&region.area), middle(&region.area)].into_iter();
                let small = small.or_else(|| last().find(|&at| round == 0 && fits(at, smallest)));
                found = small.map(|at| (at, smallest));
            }
            missed += 1;
            if let Some((at, radius)) = found {
                missed = 0;
                standing.add(Disc::new(at, radius));
                spots.push(Spot::new(at, radius));
            }
        }
        Ok(spots)
    }

    fn fits(
        &self,
        standing: &Standing,
        free: &dyn Fn(Coord<f64>, f64) -> bool,
        at: Coord<f64>,
        radius: f64,
    ) -> bool {
        let apart = radius * CLEAR + self.gap;
        standing.apart(at, apart, apart) && free(at, radius * CLEAR + self.margin)
    }

    fn full(
        &self,
        watch: &Watch<'_>,
        chance: &mut Stream,
        sampler: &Sampler,
        free: &dyn Fn(Coord<f64>, f64) -> bool,
    ) -> Result<Vec<Spot>, Failure> {
        let mut standing = Standing::default();
        let mut spots = Vec::new();
        darts::fill(watch, chance, sampler, self.gap, |chance, at| {
            let range = self.sizes[spots.len() % self.sizes.len()];
            let radius = chance.between(range);
            if !self.fits(&standing, free, at, radius) {
                return None;
            }
            standing.add(Disc::new(at, radius));
            spots.push(Spot::new(at, radius));
            Some(radius)
        })?;
        Ok(spots)
    }

    fn enough(&self, operation: &Operation, found: usize) -> Result<(), Failure> {
        if found < self.least {
            let wanted = self.least;
            let error = format!("there is room for {found} circles, and {wanted} are needed");
            return Err(Failure::unfit(operation.span, error));
        }
        Ok(())
    }
}

/// The circles as places.
pub(crate) fn circles(scope: &mut Scope<'_>, operation: &Operation) -> Result<Vec<Spot>, Failure> {
    let plan = Plan::read(scope, operation)?;
    let region = scope.region;
    let free = |at, radius| crate::derive::inside(&region.area, at, radius);
    let watch = scope.watch();
    let mut chance = scope.chance.child();
    let spots = plan.scatter(&watch, region, &mut chance, &free)?;
    plan.enough(operation, spots.len())?;
    Ok(spots)
}

/// The circles cut out of the region, each with the block done on it.
pub(crate) fn act(
    run: &mut Run<'_>,
    node: &mut Node,
    operation: &Operation,
    places: &Places,
) -> Result<(), Failure> {
    let watch = run.watch(node);
    let plan = Plan::read(&mut run.scope(node, places), operation)?;
    let mut chance = node.chance.child();
    let free = |at, radius| {
        let spot = Spot::new(at, radius);
        Run::room(node, spot, radius, radius)
    };
    let spots = plan.scatter(&watch, &node.region, &mut chance, &free)?;
    plan.enough(operation, spots.len())?;
    for spot in spots {
        for branch in operation.blocks.iter().flat_map(|b| &b.branches) {
            let shape = Primitive::Circle(spot.radius);
            let body = &branch.body.operations;
            run.carve(node, operation.span, shape, spot, body, places)?;
        }
    }
    Ok(())
}
