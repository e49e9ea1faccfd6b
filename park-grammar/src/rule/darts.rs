//! Discs put at random where there is room for them.

use geo_types::Coord;

use crate::derive::{Stream, Watch};
use crate::error::Failure;
use crate::plane::Sampler;

/// Darts thrown for one disc before it is given up.
const TRIES: usize = 120;

/// Discs given up one after the other before an area counts as full.
pub(crate) const MISSES: usize = 30;

/// Darts around each disc of a full pattern (Bridson 2007 has 30).
const AROUND: usize = 24;

/// Darts over the whole area that must fail before it counts as full.
const FULL: usize = 200;

/// Most discs of a full pattern.
const MOST: usize = 100_000;

/// A place for one disc, each point of the area as likely as any other; `None` if
/// none of many darts had room.
pub(crate) fn one(
    chance: &mut Stream,
    sampler: &Sampler,
    free: impl Fn(Coord<f64>) -> bool,
) -> Option<Coord<f64>> {
    (0..TRIES).find_map(|_| dart(chance, sampler).filter(|&at| free(at)))
}

fn dart(chance: &mut Stream, sampler: &Sampler) -> Option<Coord<f64>> {
    let draws = [chance.unit(), chance.unit(), chance.unit()];
    sampler.point(draws)
}

/// Poisson-disc sampling after Bridson 2007, "Fast Poisson disk sampling in
/// arbitrary dimensions", with discs of several sizes: `put` puts a disc at a
/// place if it has room there and tells its radius, and new ones are tried around
/// those that stand. Where the area falls into parts, darts begin in each.
pub(crate) fn fill(
    watch: &Watch<'_>,
    chance: &mut Stream,
    sampler: &Sampler,
    gap: f64,
    mut put: impl FnMut(&mut Stream, Coord<f64>) -> Option<f64>,
) -> Result<(), Failure> {
    let (mut missed, mut count) = (0, 0);
    while missed < FULL && count < MOST {
        watch.tick()?;
        let Some(at) = dart(chance, sampler) else {
            return Ok(());
        };
        let Some(radius) = put(chance, at) else {
            missed += 1;
            continue;
        };
        missed = 0;
        count += 1;
        let mut active = vec![(at, radius)];
        while !active.is_empty() && count < MOST {
            watch.tick()?;
            let k = chance.below(active.len());
            let (middle, radius) = active[k];
            let reach = 2.0 * radius + gap;
            let found = (0..AROUND).find_map(|_| {
                let angle = chance.between([0.0, std::f64::consts::TAU]);
                // Even over the ring from one to two distances.
                let far = reach * (1.0 + 3.0 * chance.unit()).sqrt();
                let at = middle
                    + Coord {
                        x: angle.cos(),
                        y: angle.sin(),
                    } * far;
                put(chance, at).map(|radius| (at, radius))
            });
            match found {
                Some(disc) => {
                    active.push(disc);
                    count += 1;
                }
                None => {
                    active.swap_remove(k);
                }
            }
        }
    }
    Ok(())
}
