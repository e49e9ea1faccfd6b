//! Distinct local minima, ranked.

use super::family::{Alignment, Family, Kind};
use super::objective::{Angles, Objective, Scratch};
use super::search::{minima, Minimum};
use crate::cross::QUARTER;
use crate::field::Field;
use crate::FieldError;

/// One field of a gallery.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct GalleryEntry {
    /// The field.
    pub field: Field,
    /// Integral of the squared divergence of its better arm outside the discs
    /// (see [`HarmonicBasis::energy`](crate::HarmonicBasis::energy)); no unit.
    pub energy: f64,
    /// For an H-field the flux through each boundary piece, for a
    /// gradient-aligned field the constant of each run of sides that the
    /// gradient crosses; scaled to a square sum of 1. The sign is the one with
    /// which the arm along the positive eigenvector (or along the gradient) is
    /// the better one.
    pub coefficients: Vec<f64>,
    /// What the gallery is ordered by: the energy, and the charge for leaving
    /// bent boundaries ([`HarmonicField::alignment`](crate::HarmonicField::alignment)).
    pub cost: f64,
    /// For a gradient-aligned field, whether the gradient crosses each of the
    /// [`GradientField::sides`](crate::GradientField::sides); empty for an
    /// H-field.
    pub crossed: Vec<bool>,
    /// How closely it follows the boundary.
    pub alignment: Alignment,
    /// Mean angle to the most similar field before it in the gallery, radians
    /// between 0 and pi/4; pi/4 for the first one.
    pub distinction: f64,
}

/// Fields closer than this to each other, on average over the domain, are the
/// same: 2 degrees.
const SAME: f64 = 0.035;

/// Mean angle between crosses that have nothing to do with each other.
const UNRELATED: f64 = std::f64::consts::FRAC_PI_8;

/// How many starts and entries, and how they are weighed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    pub(crate) starts: usize,
    pub(crate) seed: u64,
    pub(crate) entries: usize,
    pub(crate) diversity: f64,
}

/// An entry that has been found, before it is placed.
pub(crate) struct Candidate {
    pub(crate) entry: GalleryEntry,
    /// Phases of D at some vertices, to compare it with others.
    phases: Vec<f64>,
}

impl Candidate {
    fn new(entry: GalleryEntry) -> Self {
        // Every vertex of a small mesh, one in some of a large one.
        let vectors = entry.field.vectors();
        let step = vectors.len().div_ceil(COMPARED);
        let phases = vectors
            .iter()
            .step_by(step)
            .map(|d| d.y.atan2(d.x))
            .collect();
        Self { entry, phases }
    }

    /// Mean angle between the crosses of two candidates on one mesh, radians.
    fn distance(&self, other: &Self) -> f64 {
        let apart = |(a, b): (&f64, &f64)| {
            let turns = (a - b) / std::f64::consts::TAU;
            (turns - turns.round()).abs()
        };
        let sum: f64 = self.phases.iter().zip(&other.phases).map(apart).sum();
        sum / self.phases.len() as f64 * QUARTER
    }
}

/// Vertices at which candidates are compared, about.
const COMPARED: usize = 2000;

/// The distinct local minima of a family, at most `most` of them.
pub(crate) fn candidates(
    family: &Family,
    wanted: &Wanted,
    most: usize,
) -> Result<Vec<Candidate>, FieldError> {
    let objective = Objective::new(family);
    let mut found: Vec<Minimum> = minima(family, &objective, wanted.starts, wanted.seed);
    // A stable sort: of equal minima the one of the earlier start comes first.
    found.sort_by(|a, b| a.energy.total_cmp(&b.energy));
    // Most starts end where another one did: those are dropped before their
    // fields are made.
    let mut scratch = Scratch::default();
    let mut kept: Vec<(Minimum, Angles)> = Vec::new();
    for minimum in found {
        let angles = objective.angles(&minimum.y, &mut scratch);
        let new = |other: &(Minimum, Angles)| objective.distance(&angles, &other.1) > SAME;
        if kept.len() < most && kept.iter().all(new) {
            kept.push((minimum, angles));
        }
    }
    kept.into_iter()
        .map(|(minimum, _)| {
            let mut coefficients = family.lift(&minimum.y);
            let field = family.field(&coefficients)?;
            let [one, other] = family.energies(&field);
            if other < one && family.kind == Kind::Hessian {
                // The same field with its arms exchanged.
                coefficients.iter_mut().for_each(|c| *c = -*c);
            }
            let alignment = family.alignment(&field);
            Ok(Candidate::new(GalleryEntry {
                energy: one.min(other),
                cost: one.min(other) + family.charge * alignment.misfit,
                coefficients,
                crossed: Vec::new(),
                alignment,
                distinction: QUARTER / 2.0,
                field,
            }))
        })
        .collect()
}

/// Of candidates that are the same field, the one of least cost; by cost.
pub(crate) fn distinct(mut candidates: Vec<Candidate>) -> Vec<Candidate> {
    candidates.sort_by(|a, b| a.entry.cost.total_cmp(&b.entry.cost));
    let mut kept: Vec<Candidate> = Vec::new();
    for candidate in candidates {
        if kept.iter().all(|other| candidate.distance(other) > SAME) {
            kept.push(candidate);
        }
    }
    kept
}

/// The gallery: first the entry of least cost, then always the one that is
/// best by cost and by its distance to those before it.
///
/// Both are scaled to [0, 1], the costs by the least and the largest of the
/// candidates, the distance by that of unrelated fields. Expects candidates
/// in the order of their cost.
pub(crate) fn ranked(mut candidates: Vec<Candidate>, wanted: &Wanted) -> Vec<GalleryEntry> {
    let costs = || candidates.iter().map(|c| c.entry.cost);
    let low = costs().fold(f64::INFINITY, f64::min);
    let range = costs().fold(0.0, f64::max) - low;
    let score = |candidate: &Candidate| {
        let cost = if range > 0.0 {
            (candidate.entry.cost - low) / range
        } else {
            0.0
        };
        let novelty = (candidate.entry.distinction / UNRELATED).min(1.0);
        wanted.diversity * novelty - (1.0 - wanted.diversity) * cost
    };
    let mut placed: Vec<Candidate> = Vec::new();
    while !candidates.is_empty() && placed.len() < wanted.entries {
        if let Some(last) = placed.last() {
            for candidate in &mut candidates {
                let apart = candidate.distance(last);
                candidate.entry.distinction = candidate.entry.distinction.min(apart);
            }
        }
        let best = if placed.is_empty() {
            // The best one, however much diversity counts.
            0
        } else {
            (1..candidates.len()).fold(0, |best, k| {
                if score(&candidates[k]) > score(&candidates[best]) {
                    k
                } else {
                    best
                }
            })
        };
        placed.push(candidates.remove(best));
    }
    placed
        .into_iter()
        .map(|candidate| candidate.entry)
        .collect()
}

/// The gallery of one family.
pub(crate) fn gallery(family: &Family, wanted: &Wanted) -> Result<Vec<GalleryEntry>, FieldError> {
    // More than are wanted, for a choice.
    let most = wanted.entries.saturating_mul(3);
    Ok(ranked(distinct(candidates(family, wanted, most)?), wanted))
}
