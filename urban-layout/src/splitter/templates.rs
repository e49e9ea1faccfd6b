//! Template-based splitting (paper section 4): the block's templates matched,
//! warped, and taken if the warp is gentle enough.

use template_warp::{
    match_templates, warp, EdgeUse, Library, MatchOptions, Region as TemplateRegion, WarpOptions,
    Warped,
};

use crate::assemble::polygon_of;
use crate::error::{Error, Result};
use crate::inset::{inset, Plot};
use crate::layout::{is_undesirable, measure_parcel, Lineage};
use crate::options::PlanOptions;
use crate::planner::seed::mix;
use crate::region::Region;
use crate::splitter::{Action, FaceUse, Fill, FillFace, Proposal, Scene, Service, Splitter};

/// Fills blocks with warped templates of a library.
#[derive(Clone, Debug)]
pub struct TemplateSplitter {
    templates: Library,
}

/// Matches that are warped before a block counts as one that no template fits.
const WARPED: usize = 4;
/// Share of the blocks on which a template with a private park may be used.
const PARK_CHANCE: f64 = 0.06;
/// Share of undesirable parcels that a template may have on a block.
const UNDESIRABLE: f64 = 0.10;

impl TemplateSplitter {
    /// The standard templates in the sizes of `options`, or those it names.
    ///
    /// # Errors
    /// If a name in [`PlanOptions::templates`] is not in the library.
    pub fn new(options: &PlanOptions) -> Result<Self> {
        let mut library = Library::standard();
        if !options.templates.is_empty() {
            let names: Vec<&str> = options.templates.iter().map(String::as_str).collect();
            library = library
                .subset(&names)
                .map_err(|e| Error::usage(format!("templates: {e}")))?;
        }
        Ok(Self {
            templates: library.with_sizes(
                options.parcel_length,
                options.parcel_width,
                options.street_width,
            ),
        })
    }
}

impl Splitter for TemplateSplitter {
    fn name(&self) -> &'static str {
        "template"
    }

    fn propose(&self, scene: &Scene<'_>, region: &Region) -> Vec<Proposal> {
        let options = scene.options;
        // A block of parcels is no larger than two rows of a long block.
        if region.loops.len() != 1
            || region.area > 3.0 * options.block_length * 2.6 * options.parcel_length
        {
            return Vec::new();
        }
        let service = Service::of(region, options);
        if service.too_long || service.wants_street(region) {
            return Vec::new();
        }
        let plots = inset(region);
        let [plot] = plots.as_slice() else {
            return Vec::new();
        };
        if plot.rings.len() != 1 || !plot.has_access() {
            return Vec::new();
        }
        let mut best: Option<(f64, Warped)> = None;
        let Ok(block) = template_region(plot) else {
            return Vec::new();
        };
        let candidates = match_templates(&self.templates, &block, &MatchOptions::default());
        if scene.draft {
            // The paper picks the template by its boundary, before any warp.
            let lineage = Lineage::of(region, self.name());
            let action = || {
                Action::Fill(Fill {
                    template: self.name().to_owned(),
                    ..Fill::default()
                })
            };
            return candidates
                .first()
                .map(|c| Proposal {
                    cost: c.distortion,
                    action: action(),
                    lineage,
                    warning: None,
                })
                .into_iter()
                .collect();
        }
        for candidate in candidates.iter().take(WARPED) {
            let Ok(warped) = warp(&self.templates, &block, candidate, &WarpOptions::default())
            else {
                continue;
            };
            if warped.energy > options.template_energy || undesirable(&warped) > UNDESIRABLE {
                continue;
            }
            // Land in private parks is land that nobody asked to keep open:
            // such templates stay rare.
            let opens_land = warped.faces.iter().any(|f| f.label == "park");
            if opens_land && !options.templates.contains(&warped.template) && !park_is_due(region) {
                continue;
            }
            // Energy over probability, as NUMERICS has it: a product would
            // prefer what is rare.
            let cost = warped.energy / candidate.probability.max(1e-3);
            if best.as_ref().is_none_or(|b| cost < b.0) {
                best = Some((cost, warped));
            }
        }
        best.into_iter()
            .map(|(cost, warped)| proposal(region, cost, warped))
            .collect()
    }
}

/// Whether this block may have a private park, drawn once for each block.
fn park_is_due(region: &Region) -> bool {
    let draw = (mix(region.seed ^ 0x9a4c) >> 11) as f64 / (1u64 << 53) as f64;
    draw < PARK_CHANCE
}

fn template_region(plot: &Plot) -> std::result::Result<TemplateRegion, template_warp::WarpError> {
    let uses = plot.sides[0]
        .iter()
        .map(|s| {
            if s.access {
                EdgeUse::Street
            } else {
                EdgeUse::NoStreet
            }
        })
        .collect();
    TemplateRegion::new(plot.rings[0].clone(), uses, "block")
}

/// Share of a warp's parcels that are undesirable (paper Fig. 12).
fn undesirable(warped: &Warped) -> f64 {
    let parcels: Vec<_> = warped
        .faces
        .iter()
        .filter(|f| f.label == "parcel")
        .collect();
    let bad = parcels
        .iter()
        .filter(|f| {
            let (deviation, ratio) = measure_parcel(&polygon_of(std::slice::from_ref(&f.ring)));
            is_undesirable(deviation, ratio)
        })
        .count();
    if parcels.is_empty() {
        1.0
    } else {
        bad as f64 / parcels.len() as f64
    }
}

fn proposal(region: &Region, cost: f64, warped: Warped) -> Proposal {
    let lineage = Lineage {
        energy: Some(warped.energy),
        ..Lineage::of(region, "template")
    };
    let faces = warped
        .faces
        .into_iter()
        .map(|face| FillFace {
            use_: match face.label.as_str() {
                "parcel" => FaceUse::Parcel,
                "street" => FaceUse::Street,
                "park" => FaceUse::Park,
                _ => FaceUse::Other,
            },
            ring: face.ring,
            ideal_area: Some(face.ideal_area),
            registration: Some(face.registration),
            access_exempt: face.access_exempt,
        })
        .collect();
    let fill = Fill {
        faces,
        streets: warped.centrelines,
        template: warped.template,
    };
    Proposal {
        cost,
        action: Action::Fill(fill),
        lineage,
        warning: None,
    }
}
