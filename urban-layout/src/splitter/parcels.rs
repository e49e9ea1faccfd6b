//! The rule-based fallback (Vanegas et al. 2012, as the paper's section 3
//! uses it): any block becomes parcels with access, and what has none a park.

use crate::inset::{inset, Plot};
use crate::layout::Lineage;
use crate::parceler::{parcel, Block, ParcelOptions, PieceKind};
use crate::region::Region;
use crate::splitter::{Action, FaceUse, Fill, FillFace, Proposal, Scene, Splitter};

/// Parcels any region that borders on a street.
#[derive(Clone, Copy, Debug, Default)]
pub struct SkeletonParceler;

impl Splitter for SkeletonParceler {
    fn name(&self) -> &'static str {
        "parceler"
    }

    fn propose(&self, scene: &Scene<'_>, region: &Region) -> Vec<Proposal> {
        if !region.has_access() {
            return Vec::new();
        }
        let mut fill = Fill {
            template: self.name().to_owned(),
            ..Fill::default()
        };
        if scene.draft {
            return vec![Proposal {
                cost: 0.0,
                action: Action::Fill(fill),
                lineage: Lineage::of(region, self.name()),
                warning: None,
            }];
        }
        let options = scene.options;
        let rule = ParcelOptions {
            depth: options.parcel_length,
            width: options.parcel_width,
            min_frontage: options.min_frontage,
            ..ParcelOptions::default()
        };
        for plot in inset(region).iter().flat_map(|p| p.without_holes(region)) {
            fill.faces.extend(fill_plot(plot, &rule));
        }
        vec![Proposal {
            cost: 0.0,
            action: Action::Fill(fill),
            lineage: Lineage::of(region, self.name()),
            warning: None,
        }]
    }
}

/// The pieces of one plot.
fn fill_plot(plot: Plot, rule: &ParcelOptions) -> Vec<FillFace> {
    let Plot {
        mut rings,
        mut sides,
        ..
    } = plot;
    if rings.is_empty() {
        return Vec::new();
    }
    let (ring, front) = (rings.swap_remove(0), sides.swap_remove(0));
    let block = Block {
        ring,
        front: front.iter().map(|s| s.access).collect(),
    };
    parcel(&block, rule)
        .into_iter()
        .map(|piece| {
            let use_ = match piece.kind {
                PieceKind::Parcel => FaceUse::Parcel,
                PieceKind::Green => FaceUse::Park,
            };
            FillFace::plain(piece.ring, use_)
        })
        .collect()
}
