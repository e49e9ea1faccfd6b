//! The last resort: land that no street reaches becomes open space.

use crate::inset::inset;
use crate::layout::Lineage;
use crate::region::Region;
use crate::splitter::{Action, FaceUse, Fill, FillFace, Proposal, Scene, Splitter};

/// Fills a region with a park. Never declines.
///
/// The park gets its design, like those of templates, when the plan is assembled
/// and its outline does not change any more: see
/// [`ParkChoice`](crate::park::ParkChoice).
#[derive(Clone, Copy, Debug, Default)]
pub struct ParkFill;

impl Splitter for ParkFill {
    fn name(&self) -> &'static str {
        "park"
    }

    fn propose(&self, _scene: &Scene<'_>, region: &Region) -> Vec<Proposal> {
        let faces = inset(region)
            .iter()
            .flat_map(|plot| plot.without_holes(region))
            .filter_map(|plot| plot.rings.into_iter().next())
            .map(|ring| FillFace::plain(ring, FaceUse::Park))
            .collect();
        vec![Proposal {
            cost: 1.0,
            action: Action::Fill(Fill {
                faces,
                streets: Vec::new(),
                template: self.name().to_owned(),
            }),
            lineage: Lineage::of(region, self.name()),
            warning: None,
        }]
    }
}

impl FillFace {
    /// A face that no template made.
    #[must_use]
    pub fn plain(ring: Vec<geo_types::Coord<f64>>, use_: FaceUse) -> Self {
        Self {
            ring,
            use_,
            ideal_area: None,
            registration: None,
            access_exempt: false,
        }
    }
}

impl Lineage {
    /// Lineage of what splitter `by` does with `region`.
    #[must_use]
    pub fn of(region: &Region, by: &str) -> Self {
        Self {
            split: region.path.to_string(),
            by: by.to_owned(),
            field: None,
            scores: None,
            energy: None,
            seed: region.seed,
        }
    }
}
