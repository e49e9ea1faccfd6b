//! Parks from a grammar: `park-grammar` on what a file holds, and on the parks of
//! a plan.

mod fill;

use std::collections::BTreeMap;
use std::time::Instant;

pub(crate) use fill::design;
pub use fill::ParkChoice;
use geo_types::{MultiPolygon, Polygon};
use park_grammar::scene::{Ground, Piece};
use park_grammar::{grammars, Audit, DeriveOptions, Grammar, ParkError, Scene};
use serde_json::{json, Value};

use crate::error::{Error, Result};
use crate::layout::seam_to;
use crate::site::boolean::area;
use crate::site::Site;

/// Corners of pieces this near to each other, metres, are one.
const SEAM: f64 = 1e-8;

/// A park, or several: one for each part of the land.
#[derive(Clone, Debug)]
pub struct ParkStudy {
    /// What the grammar is called.
    pub grammar: String,
    /// The seed of the first part; each further one has the next.
    pub seed: u64,
    /// A park for each part of the land, in its order.
    pub parts: Vec<ParkPart>,
    /// Seconds that the derivation took, all parts together.
    pub seconds: f64,
}

/// The park on one part of the land.
#[derive(Clone, Debug)]
pub struct ParkPart {
    /// The park, in local metres. Pieces that meet share their corners.
    pub scene: Scene,
    /// Its laws.
    pub audit: Audit,
}

/// The grammar that a word means: one of the library, or a file.
///
/// # Errors
///
/// [`Error::is_input`] for a grammar with faults, naming the first of them, and
/// for a word that is neither a file nor a grammar of the library.
pub fn grammar(word: &str) -> Result<Grammar> {
    let read = match grammars::named(word) {
        Some(known) => known.grammar(),
        None => Grammar::read(word),
    };
    read.map_err(|error| match &error {
        ParkError::File { what } if !std::path::Path::new(word).exists() => {
            let known: Vec<&str> = grammars::ALL.iter().map(|one| one.name).collect();
            Error::input(format!(
                "{what}; there is no such file, and no grammar of that name: there are {}",
                known.join(", ")
            ))
        }
        _ => refused(&error),
    })
}

impl ParkStudy {
    /// Derives a park on each part of a site; what else the site has is no part
    /// of the park. `watch` is told how many operations have been done, and stops
    /// the work by answering false.
    ///
    /// # Errors
    ///
    /// [`Error::is_unsatisfied`] where a rule does not suit a part and names no
    /// alternative; [`Error::is_usage`] for a parameter that the grammar does not
    /// have; [`Error::is_cancelled`].
    pub fn new(
        site: &Site,
        grammar: &Grammar,
        options: &DeriveOptions,
        watch: &mut dyn FnMut(usize) -> bool,
    ) -> Result<Self> {
        let began = Instant::now();
        let mut parts = Vec::with_capacity(site.parts.len());
        for (k, outline) in site.parts.iter().enumerate() {
            let options = DeriveOptions {
                seed: options.seed.wrapping_add(k as u64),
                ..options.clone()
            };
            let derived = grammar.derive_watched(outline, &options, watch);
            parts.push((outline, derived.map_err(|error| refused(&error))?));
        }
        let seconds = began.elapsed().as_secs_f64();
        let parts = parts.into_iter().map(|(outline, mut scene)| {
            sewn(&mut scene, outline);
            ParkPart {
                audit: scene.audit(outline),
                scene,
            }
        });
        Ok(Self {
            grammar: name_of(grammar),
            seed: options.seed,
            parts: parts.collect(),
            seconds,
        })
    }

    /// All parts as one scene.
    #[must_use]
    pub fn scene(&self) -> Scene {
        let mut whole = Scene::default();
        for ParkPart { scene, .. } in &self.parts {
            whole.pieces.extend(scene.pieces.iter().cloned());
            whole.objects.extend(scene.objects.iter().cloned());
            whole.volumes.extend(scene.volumes.iter().cloned());
            for kind in &scene.kinds {
                if whole.kinds.iter().all(|known| known.name != kind.name) {
                    whole.kinds.push(kind.clone());
                }
            }
            whole.skipped += scene.skipped;
        }
        whole
    }

    /// What the laws of a park complain of, in words.
    pub fn violations(&self) -> impl Iterator<Item = String> + '_ {
        let all = self.parts.iter().flat_map(|part| &part.audit.violations);
        all.map(ToString::to_string)
    }

    /// The figures: land by use, what stands there by name, how exactly the
    /// pieces tile the park, and how it is entered.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let scene = self.scene();
        let land = |wanted: &dyn Fn(&Piece) -> bool| -> f64 {
            let pieces = scene.pieces.iter().filter(|piece| wanted(piece));
            // From 0: a sum of nothing is -0.
            pieces.fold(0.0, |sum, piece| sum + area(&piece.polygon))
        };
        let mut materials: BTreeMap<&str, f64> = BTreeMap::new();
        for piece in &scene.pieces {
            *materials.entry(&piece.material).or_default() += area(&piece.polygon);
        }
        let count = |names: &mut dyn Iterator<Item = &str>| -> BTreeMap<String, usize> {
            let mut all = BTreeMap::new();
            names.for_each(|name| *all.entry(name.to_owned()).or_default() += 1);
            all
        };
        let sum = |figure: &dyn Fn(&Audit) -> f64| -> f64 {
            let figures = self.parts.iter().map(|part| figure(&part.audit));
            figures.fold(0.0, |sum, figure| sum + figure)
        };
        let whole = sum(&|audit| audit.area);
        let wrong = sum(&|audit| audit.gap + audit.overlap + audit.outside);
        let entrances = sum(&|audit| audit.paths.iter().map(|paths| paths.entrance).sum::<f64>());
        let networks: usize = self.parts.iter().map(|part| part.audit.paths.len()).sum();
        json!({
            "grammar": self.grammar,
            "seed": self.seed,
            "parts": self.parts.len(),
            "area_m2": whole,
            "path_m2": land(&|piece| piece.ground == Ground::Path),
            "pieces": scene.pieces.len(),
            "materials_m2": materials,
            "objects": scene.objects.len(),
            "objects_by_name": count(&mut scene.objects.iter().map(|o| o.name.as_str())),
            "volumes": scene.volumes.len(),
            "volumes_by_name": count(&mut scene.volumes.iter().map(|v| v.name.as_str())),
            "skipped": scene.skipped,
            "tiling_error": wrong / whole,
            "path_networks": networks,
            "entrance_m": entrances,
            "violations": self.violations().collect::<Vec<_>>(),
            "seconds": self.seconds,
        })
    }
}

/// What a grammar is called: its file, without folder and ending.
fn name_of(grammar: &Grammar) -> String {
    let name = grammar.sources().name(0).unwrap_or_default();
    let stem = std::path::Path::new(name).file_stem();
    stem.map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

/// Makes pieces share their corners, so that they tile the park in every
/// rounding: what booleans cut agrees only to the last digits, and a corner in
/// the middle of another's edge leaves that when either is rounded.
fn sewn(scene: &mut Scene, outline: &Polygon<f64>) {
    let mut polygons: Vec<Polygon<f64>> = scene.pieces.iter().map(|p| p.polygon.clone()).collect();
    let report = seam_to(&mut polygons, &MultiPolygon(vec![outline.clone()]), SEAM);
    let mut pieces = Vec::with_capacity(polygons.len());
    for (k, (piece, polygon)) in scene.pieces.drain(..).zip(polygons).enumerate() {
        let apart = report.pieces.iter().find(|(number, _)| *number == k);
        if let Some((_, parts)) = apart {
            pieces.extend(parts.iter().map(|part| Piece {
                polygon: part.clone(),
                ..piece.clone()
            }));
        } else if report.unusable.contains(&k) {
            // Left as it was.
            pieces.push(piece);
        } else if !report.collapsed.contains(&k) {
            pieces.push(Piece { polygon, ..piece });
        }
    }
    scene.pieces = pieces;
}

/// An error of the grammar's crate as one of this one.
pub(crate) fn refused(error: &ParkError) -> Error {
    match error {
        ParkError::Grammar(faults) => Error::input(line_of(faults)),
        ParkError::Rule(faults) => Error::unsatisfied(line_of(faults)),
        ParkError::File { .. } | ParkError::Outline { .. } => Error::input(error.to_string()),
        ParkError::Parameter { .. } => Error::usage(error.to_string()),
        ParkError::Cancelled => Error::cancelled(),
        _ => Error::unsatisfied(error.to_string()),
    }
}

/// The first fault of a grammar, where it stands, in one line.
fn line_of(faults: &park_grammar::syntax::Diagnostics) -> String {
    let Some(first) = faults.all.first() else {
        return "the grammar has a fault".to_owned();
    };
    let (line, column) = faults.sources.position(first.span);
    let file = faults.sources.name(first.span.file).unwrap_or("grammar");
    let mut words = format!("{file}:{line}:{column}: {}", first.message);
    if let Some(hint) = &first.hint {
        words.push_str("; ");
        words.push_str(hint);
    }
    if faults.all.len() > 1 {
        words.push_str(&format!(" (and {} more)", faults.all.len() - 1));
    }
    words.replace(['\n', '\r'], " ")
}
