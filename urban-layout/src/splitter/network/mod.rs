//! Streets of a region from a specification (Peng et al. 2016, figure 10): the
//! region is cut into quads, edges of the quads are chosen by `network_opt`,
//! level by level, and drawn to smooth streets; what lies between them are
//! blocks, which templates fill.
//!
//! In the order of the data: `rim` says what the boundary of the mesh is
//! (streets that exist, ways out, the site's edge), `choose` finds the edges,
//! `streets` makes cuts of them that can be built.

mod choose;
mod options;
mod rim;
mod streets;

pub use options::NetworkOptions;

use streets::Laid;

use std::cell::Cell;

use network_opt::design::Tessellation;
use network_opt::quad::{quads, QuadOptions};

use crate::assemble::polygon_of;
use crate::layout::Lineage;
use crate::options::FieldKind;
use crate::plane::at;
use crate::planner::seed::mix;
use crate::region::Region;
use crate::splitter::{
    field_of, open_rings, Action, Cut, Proposal, Scene, Service, Splitter, StreamlineSplitter,
};

/// Lays out all streets of a region at once, by integer programming from a
/// specification; see [`NetworkOptions`].
///
/// Regions that are too small for a network are left to the next splitter, and
/// so are the blocks between its streets where they want one street more.
/// It works only where [`PlanOptions::network`](crate::PlanOptions::network)
/// is given, though with its own options.
/// Where no network is found, the streets are those of [`StreamlineSplitter`],
/// and the proposal says so in its warning.
#[derive(Clone, Debug, Default)]
pub struct NetworkSplitter {
    options: NetworkOptions,
}

impl NetworkSplitter {
    /// A splitter with these options.
    #[must_use]
    pub fn new(options: NetworkOptions) -> Self {
        Self { options }
    }

    /// The streets of a region, or why there are none.
    fn streets(&self, scene: &Scene<'_>, region: &Region) -> Result<Vec<Cut>, String> {
        let levels = self.options.levels(scene.options);
        let edge = self.options.edge_length(scene.options, levels.len());
        let mesh = mesh(region, self.options.field, edge)?;
        // A specification says itself what its streets are.
        let busy_from = match self.options.spec {
            Some(_) => f64::INFINITY,
            None => self.options.collector_parcels,
        };
        let mut best: Option<Laid> = None;
        let mut why = String::new();
        for k in 0..self.options.tries {
            let seed = mix(region.seed ^ u64::from(k));
            let web =
                match choose::choose(scene, region, mesh.clone(), &levels, &self.options, seed) {
                    Ok(web) => web,
                    Err(reason) => {
                        why = reason;
                        continue;
                    }
                };
            let laid = streets::lay_all(scene, region, &web, &levels, busy_from);
            if best.as_ref().is_none_or(|best| laid.fault < best.fault) {
                best = Some(laid);
            }
        }
        match best {
            Some(laid) if !laid.cuts.is_empty() => Ok(laid.cuts),
            Some(_) => Err("none of its streets can be built".to_owned()),
            None => Err(why),
        }
    }
}

/// The quads of a region, along the field that streets would follow.
fn mesh(region: &Region, kind: FieldKind, edge: f64) -> Result<Tessellation, String> {
    let rings = open_rings(region).ok_or("the region has no interior")?;
    let field = field_of(region, kind);
    let cursor = Cell::new(crossfield::Cursor::default());
    let directions = |p| {
        let mut here = cursor.get();
        let cross = field.as_ref().and_then(|f| f.cross(p, &mut here));
        cursor.set(here);
        let arm = cross?.arms()[0];
        Some(arm.y.atan2(arm.x))
    };
    let wanted = QuadOptions {
        edge_length: edge,
        directions: field.is_some().then_some(&directions),
        ..QuadOptions::default()
    };
    quads(&polygon_of(&rings), &wanted).map_err(|e| e.to_string())
}

impl Splitter for NetworkSplitter {
    fn name(&self) -> &'static str {
        "network"
    }

    fn propose(&self, scene: &Scene<'_>, region: &Region) -> Vec<Proposal> {
        // What streets of ours have divided is no longer for a network: where
        // one was found these are its blocks, and where none was it would fail
        // again.
        let divided = region
            .edges()
            .filter_map(|(_, _, side)| scene.network.streets.get(side.street? as usize))
            .any(|street| !street.given);
        if divided
            || scene.options.network.is_none()
            || region.area < self.options.least_area(scene.options)
            || !Service::of(region, scene.options).wants_street(region)
        {
            return Vec::new();
        }
        match self.streets(scene, region) {
            Ok(cuts) => vec![Proposal {
                cost: 0.0,
                action: Action::Cut(cuts),
                lineage: Lineage {
                    field: Some(self.options.field.as_str().to_owned()),
                    ..Lineage::of(region, self.name())
                },
                warning: None,
            }],
            Err(why) => fallback(scene, region, &why),
        }
    }
}

/// What streamlines would do, with a warning.
fn fallback(scene: &Scene<'_>, region: &Region, why: &str) -> Vec<Proposal> {
    let middle = region
        .loops
        .first()
        .and_then(|l| l.points.first().copied())
        .unwrap_or(at(0.0, 0.0));
    let warning = format!(
        "region {} near ({:.0}, {:.0}): no network of streets fits, since {why}; its streets follow a field instead. \
         Allow the search more moves, ask less of the levels, or choose another length of edges",
        region.path, middle.x, middle.y
    );
    let mut proposals = StreamlineSplitter.propose(scene, region);
    for proposal in &mut proposals {
        proposal.warning = Some(warning.clone());
    }
    proposals
}
