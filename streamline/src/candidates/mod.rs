//! Candidate streamlines from many seeds, spread by switching off what is near.

mod grid;

use crate::error::TraceError;
use crate::field::DirectionField;
use crate::random::Stream;
use crate::streamline::Streamline;
use crate::trace::{RungeKutta, Stop, TraceOptions, Tracer};
use crate::vector::{dot, is_finite, unit};
use geo_types::Coord;
use grid::SeedGrid;

/// A place to trace from, with the cross there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Seed {
    /// The place, in metres; usually an inner vertex of a triangulation.
    pub at: Coord<f64>,
    /// The two orientations of the cross there, non-zero vectors of any length
    /// and sign. Their positions, 0 and 1, are the families of the lines.
    pub directions: [Coord<f64>; 2],
}

/// How candidates are generated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CandidateOptions {
    /// A line switches off its orientation at all seeds this near, in metres:
    /// d_eps of the paper, speed against quality.
    ///
    /// Default value: 9 m, 0.3 times a parcel length of 30 m.
    pub separation: f64,
    /// Seed of the random order, through PCG XSL RR 128/64 (`Pcg64`): the same
    /// number gives the same lines on every machine with the same arithmetic.
    ///
    /// Default value: 0.
    pub seed: u64,
    /// How each line is traced.
    pub trace: TraceOptions,
    /// Keeps lines that end at a singularity, or where the field ends.
    ///
    /// Default value: false, as the paper has it.
    pub keep_singular: bool,
    /// Keeps closed lines, which divide a region only into a ring and a core.
    ///
    /// Default value: false.
    pub keep_closed: bool,
}

impl Default for CandidateOptions {
    fn default() -> Self {
        Self {
            separation: 9.0,
            seed: 0,
            trace: TraceOptions::default(),
            keep_singular: false,
            keep_closed: false,
        }
    }
}

/// Why a seed's own line is no candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Unfit {
    /// The field has no direction at the seed.
    NoDirection,
    /// An end is a singularity, or the end of the field.
    Singular,
    /// The line is closed.
    Closed,
    /// The line ran alongside itself.
    SelfApproach,
    /// The line crosses itself.
    SelfCrossing,
    /// The line was cut off at [`TraceOptions::max_length`].
    LengthLimit,
    /// The line has no length: the seed lies in a corner of the boundary.
    NoLength,
}

/// A seed's orientation whose line is no candidate.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Discarded {
    /// Position of the seed in the list.
    pub seed_index: usize,
    /// Which of its two orientations.
    pub family: u8,
    /// Why.
    pub reason: Unfit,
    /// The line, where there is one.
    pub line: Option<Streamline>,
}

impl Discarded {
    /// Whether the line switched off its orientation at the seeds near it, as
    /// a candidate does. True of lines that are well placed but of no use for
    /// dividing a region: closed ones, spirals, cut-off ones. Their neighbours
    /// would end likewise, each after a long trace of its own.
    #[must_use]
    pub fn switches_off(&self) -> bool {
        matches!(
            self.reason,
            Unfit::Closed | Unfit::SelfApproach | Unfit::LengthLimit
        )
    }
}

/// All lines that were traced: each orientation of each seed was traced, or
/// lies near a line of its orientation.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Survey {
    /// The candidates, in the order of their making.
    pub lines: Vec<Streamline>,
    /// What was traced and set aside, in the order of its making.
    pub discarded: Vec<Discarded>,
}

/// Candidate streamlines through the seeds, in both orientations of each.
///
/// The paper's scheme: every orientation of every seed is active; in random
/// order, each that is still active is traced both ways; a candidate switches
/// off, at all seeds within `separation` of it, the orientation most similar to
/// its own direction where it comes nearest. Lines that end at singularities
/// or cross themselves are set aside, and switch off nothing but their own
/// seed's orientation. So are closed lines, spirals and cut-off ones, which do
/// switch off ([`Discarded::switches_off`]; the paper does not mention them).
///
/// See [`survey`] for the lines that were set aside.
///
/// # Errors
///
/// [`TraceError::BadOption`], or [`TraceError::SeedNotFinite`] and
/// [`TraceError::NoHeading`] with the position of the first bad seed. A seed
/// where the field has no direction is set aside.
///
/// # Complexity
///
/// One trace for each line, and for each of its points the seeds in the few
/// grid cells around. With the feature `rayon` lines are traced ahead on all
/// threads; the result is the same on any number of them.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, polygon};
/// use streamline::{arm_nearest, candidates, from_fn, CandidateOptions, Seed};
///
/// let domain = polygon![(x: 0., y: 0.), (x: 100., y: 0.), (x: 100., y: 100.), (x: 0., y: 100.)];
/// let grid = from_fn(domain, |_, heading| Some(arm_nearest(0.0, heading)));
/// let seeds: Vec<Seed> = (1..10)
///     .flat_map(|i| (1..10).map(move |j| coord! { x: 10.0 * i as f64, y: 10.0 * j as f64 }))
///     .map(|at| Seed { at, directions: [coord! { x: 1., y: 0. }, coord! { x: 0., y: 1. }] })
///     .collect();
/// // Nine lines each way, for the seeds stand 10 m apart and lines reach 9 m.
/// let lines = candidates(&grid, &seeds, &CandidateOptions::default())?;
/// assert_eq!(lines.len(), 18);
/// # Ok::<(), streamline::TraceError>(())
/// ```
///
/// # References
///
/// Yang, Wang, Vouga, Wonka 2013, section 5, "Streamline Candidate
/// Generation".
pub fn candidates<F: DirectionField + ?Sized>(
    field: &F,
    seeds: &[Seed],
    options: &CandidateOptions,
) -> Result<Vec<Streamline>, TraceError> {
    Ok(survey(field, seeds, options)?.lines)
}

/// [`candidates`] by any [`Tracer`]: by [`EdgeTracer`](crate::EdgeTracer), for
/// one, they can neither merge nor cross under 45 degrees. `options.trace` has
/// no effect.
///
/// # Errors
///
/// As [`candidates`], and what the tracer finds wrong.
pub fn candidates_by<T: Tracer + ?Sized>(
    tracer: &T,
    seeds: &[Seed],
    options: &CandidateOptions,
) -> Result<Vec<Streamline>, TraceError> {
    Ok(survey_by(tracer, seeds, options)?.lines)
}

/// [`candidates`] with an account of what was set aside.
///
/// # Errors
///
/// As [`candidates`].
pub fn survey<F: DirectionField + ?Sized>(
    field: &F,
    seeds: &[Seed],
    options: &CandidateOptions,
) -> Result<Survey, TraceError> {
    options.trace.validate()?;
    let tracer = RungeKutta {
        field,
        options: options.trace,
    };
    survey_by(&tracer, seeds, options)
}

/// [`survey`] by any [`Tracer`]; `options.trace` has no effect.
///
/// # Errors
///
/// As [`candidates`], and what the tracer finds wrong.
pub fn survey_by<T: Tracer + ?Sized>(
    tracer: &T,
    seeds: &[Seed],
    options: &CandidateOptions,
) -> Result<Survey, TraceError> {
    let directions = validate(seeds, options)?;
    let places: Vec<_> = seeds.iter().map(|seed| seed.at).collect();
    let mut grid = SeedGrid::new(&places, options.separation);
    let mut active = vec![[true; 2]; seeds.len()];
    let mut order: Vec<(usize, usize)> = (0..seeds.len()).flat_map(|i| [(i, 0), (i, 1)]).collect();
    Stream::new(options.seed).shuffle(&mut order);
    let mut survey = Survey::default();
    let width = batch_width();
    let mut waiting = order.into_iter();
    loop {
        // Tracing ahead cannot change the outcome: a line depends on its seed
        // alone, and those switched off meanwhile are dropped.
        let batch: Vec<_> = waiting
            .by_ref()
            .filter(|&(i, family)| active[i][family])
            .take(width)
            .collect();
        if batch.is_empty() {
            return Ok(survey);
        }
        let traced = trace_all(&batch, |(i, family)| {
            tracer.trace(places[i], seeds[i].directions[family])
        });
        for ((i, family), line) in batch.into_iter().zip(traced) {
            if !active[i][family] {
                continue;
            }
            active[i][family] = false;
            let line = match line {
                Ok(line) => Some(Streamline {
                    family: family as u8,
                    seed_index: i,
                    ..line
                }),
                Err(TraceError::NoDirection { .. }) => None,
                Err(error) => return Err(error),
            };
            let reason = judge(line.as_ref(), options);
            let aside = reason.map(|reason| Discarded {
                seed_index: i,
                family: family as u8,
                reason,
                line: None,
            });
            if let Some(line) = &line {
                if aside.as_ref().is_none_or(Discarded::switches_off) {
                    for near in grid.near(&line.points, options.separation) {
                        let [first, second] =
                            directions[near.seed].map(|d| dot(d, near.tangent).abs());
                        active[near.seed][usize::from(second > first)] = false;
                    }
                }
            }
            match (aside, line) {
                (None, line) => survey.lines.extend(line),
                (Some(aside), line) => survey.discarded.push(Discarded { line, ..aside }),
            }
        }
    }
}

fn judge(line: Option<&Streamline>, options: &CandidateOptions) -> Option<Unfit> {
    let Some(line) = line else {
        return Some(Unfit::NoDirection);
    };
    let ends = [line.start, line.end];
    let singular = ends
        .iter()
        .any(|end| matches!(end, Stop::Singularity | Stop::FieldEnd));
    if singular && !options.keep_singular {
        Some(Unfit::Singular)
    } else if ends.contains(&Stop::ClosedLoop) && !options.keep_closed {
        Some(Unfit::Closed)
    } else if ends.contains(&Stop::SelfApproach) {
        Some(Unfit::SelfApproach)
    } else if ends.contains(&Stop::LengthLimit) {
        Some(Unfit::LengthLimit)
    } else if line.points.len() < 2 {
        Some(Unfit::NoLength)
    } else if !line.is_simple() {
        Some(Unfit::SelfCrossing)
    } else {
        None
    }
}

/// Unit directions of all seeds.
fn validate(
    seeds: &[Seed],
    options: &CandidateOptions,
) -> Result<Vec<[Coord<f64>; 2]>, TraceError> {
    TraceError::unless_positive("separation", options.separation)?;
    let mut directions = Vec::with_capacity(seeds.len());
    for (index, seed) in seeds.iter().enumerate() {
        if !is_finite(seed.at) {
            return Err(TraceError::SeedNotFinite {
                index,
                x: seed.at.x,
                y: seed.at.y,
            });
        }
        let [a, b] = seed.directions;
        let of = |d: Coord<f64>| {
            unit(d).ok_or(TraceError::NoHeading {
                index,
                x: d.x,
                y: d.y,
            })
        };
        directions.push([of(a)?, of(b)?]);
    }
    Ok(directions)
}

#[cfg(not(feature = "rayon"))]
fn batch_width() -> usize {
    1
}

#[cfg(not(feature = "rayon"))]
fn trace_all<T: Copy, R>(batch: &[T], f: impl Fn(T) -> R) -> Vec<R> {
    batch.iter().map(|&item| f(item)).collect()
}

/// A few lines for each thread; alone, nothing is traced in vain.
#[cfg(feature = "rayon")]
fn batch_width() -> usize {
    match rayon::current_num_threads() {
        0 | 1 => 1,
        threads => 4 * threads,
    }
}

#[cfg(feature = "rayon")]
fn trace_all<T: Copy + Sync, R: Send>(batch: &[T], f: impl Fn(T) -> R + Sync) -> Vec<R> {
    use rayon::prelude::*;
    batch.par_iter().map(|&item| f(item)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{arm_nearest, from_fn};
    use crate::vector::point;
    use geo_types::{polygon, Polygon};

    fn square() -> Polygon<f64> {
        polygon![(x: -50., y: -50.), (x: 50., y: -50.), (x: 50., y: 50.), (x: -50., y: 50.)]
    }

    fn seeds() -> Vec<Seed> {
        let at = (0..81).map(|i| point((i % 9) as f64 * 11.0 - 43.0, (i / 9) as f64 * 11.0 - 44.5));
        at.map(|at| Seed {
            at,
            directions: [at, crate::vector::left(at)],
        })
        .collect()
    }

    #[test]
    fn circles_are_set_aside_and_rays_kept() {
        // All rays run into the middle, where there is no direction.
        let polar = from_fn(square(), |at, heading| {
            (at.x.hypot(at.y) > 8.0).then(|| arm_nearest(at.y.atan2(at.x), heading))
        });
        let all = survey(&polar, &seeds(), &CandidateOptions::default()).unwrap();
        let closed = all
            .discarded
            .iter()
            .filter(|d| d.reason == Unfit::Closed)
            .count();
        assert!((3..9).contains(&closed), "{closed}");
        let rays = all
            .discarded
            .iter()
            .filter(|d| d.reason == Unfit::Singular)
            .count();
        assert!(rays > 20, "{rays}");
        assert!(
            all.lines.iter().all(|line| line.family == 1),
            "arcs that leave by the corners"
        );
        let keep = CandidateOptions {
            keep_closed: true,
            keep_singular: true,
            ..CandidateOptions::default()
        };
        let kept = survey(&polar, &seeds(), &keep).unwrap();
        assert!(kept.lines.len() >= all.lines.len() + closed);
    }

    #[test]
    fn the_seed_changes_the_lines_and_repeats_them() {
        let waves = from_fn(square(), |at, heading| {
            Some(arm_nearest((at.x / 30.0).sin(), heading))
        });
        let run = |seed| {
            candidates(
                &waves,
                &seeds(),
                &CandidateOptions {
                    seed,
                    ..CandidateOptions::default()
                },
            )
            .unwrap()
        };
        assert_eq!(run(1), run(1));
        assert_ne!(run(1), run(2));
    }

    #[test]
    fn bad_seeds_are_named() {
        let grid = from_fn(square(), |_, heading| Some(heading));
        let mut bad = seeds();
        bad[3].at.x = f64::NAN;
        let options = CandidateOptions::default();
        assert!(matches!(
            candidates(&grid, &bad, &options),
            Err(TraceError::SeedNotFinite { index: 3, .. })
        ));
        bad[3].at.x = 0.0;
        bad[5].directions[1] = point(0.0, 0.0);
        assert!(matches!(
            candidates(&grid, &bad, &options),
            Err(TraceError::NoHeading { index: 5, .. })
        ));
        let options = CandidateOptions {
            separation: 0.0,
            ..options
        };
        assert!(matches!(
            candidates(&grid, &seeds(), &options),
            Err(TraceError::BadOption {
                name: "separation",
                ..
            })
        ));
        assert_eq!(
            candidates(&grid, &[], &CandidateOptions::default()),
            Ok(vec![])
        );
        // Outside the domain: set aside, not an error.
        let outside = [Seed {
            at: point(500.0, 0.0),
            directions: [point(1., 0.), point(0., 1.)],
        }];
        let all = survey(&grid, &outside, &CandidateOptions::default()).unwrap();
        assert!(
            all.discarded.iter().all(|d| d.reason == Unfit::NoDirection)
                && all.discarded.len() == 2
        );
    }
}
