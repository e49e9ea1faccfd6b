//! Ways to split a region: what the planner searches over.
//!
//! The paper's framework has two splitting operations and a rule-based
//! fallback; here each is a [`Splitter`], and the planner knows none of them
//! by name. A planner's own rule is one more implementation.

use geo_types::{Coord, LineString};

use crate::layout::Lineage;
use crate::network::Network;
use crate::options::PlanOptions;
use crate::region::{Place, Region};
use crate::site::RoadClass;

mod cut;
mod geodesic;
mod network;
mod parcels;
mod park;
mod reach;
mod rows;
mod service;
mod streamlines;
mod templates;

pub use network::{NetworkOptions, NetworkSplitter};
pub use parcels::SkeletonParceler;
pub use park::ParkFill;
pub use reach::ReachSplitter;
pub use streamlines::StreamlineSplitter;
pub use templates::TemplateSplitter;

pub(crate) use cut::{smooth, CutMaker, Path2};
pub(crate) use geodesic::Ways;
pub(crate) use service::Service;
pub(crate) use streamlines::{field_of, imbalance, mesh_of, open_rings};

/// What every splitter may look at.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The street network so far.
    pub network: &'a Network,
    /// The run's options.
    pub options: &'a PlanOptions,
    /// Only the way to go is asked for: a [`Fill`] may be left empty, since the
    /// block will be filled when the network has its final shape.
    pub draft: bool,
}

/// A way to split a region out, or to fill it.
pub trait Splitter: Sync + Send {
    /// The name that lineage records (`by`).
    fn name(&self) -> &'static str;

    /// What could be done with `region`, best first; empty if nothing.
    ///
    /// Proposals are only read, never changed: the planner checks each against
    /// the network as it is when it comes to be used.
    fn propose(&self, scene: &Scene<'_>, region: &Region) -> Vec<Proposal>;
}

/// One thing to do with a region.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// Lower is better; comparable among one splitter's proposals only.
    pub cost: f64,
    /// What is to be done.
    pub action: Action,
    /// Scores and energies, for the record.
    pub lineage: Lineage,
    /// What the user should know if this is taken, such as that it is not what
    /// was asked for; it becomes one of the plan's warnings.
    pub warning: Option<String>,
}

/// What a proposal does.
#[derive(Clone, Debug)]
pub enum Action {
    /// New streets across the region.
    Cut(Vec<Cut>),
    /// The region is a block: this is what fills the land inside its streets.
    Fill(Fill),
}

/// A new street from one place of a region's boundary to another.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// Where it starts.
    pub from: Place,
    /// Points between the ends.
    pub path: Vec<Coord<f64>>,
    /// Where it ends.
    pub to: Place,
    /// Its class; `None` for the planner's choice.
    pub class: Option<RoadClass>,
    /// Its full width, metres; `None` for [`PlanOptions::street_width`].
    pub width: Option<f64>,
}

/// What fills a block.
#[derive(Clone, Debug, Default)]
pub struct Fill {
    /// Polygons that tile the region's plots exactly.
    pub faces: Vec<FillFace>,
    /// Streets inside (cul-de-sacs): centrelines that start on the plot's
    /// street side.
    pub streets: Vec<LineString<f64>>,
    /// The template, or the rule, that made it.
    pub template: String,
}

/// One face of a [`Fill`].
#[derive(Clone, Debug)]
pub struct FillFace {
    /// Open ring, counter-clockwise.
    pub ring: Vec<Coord<f64>>,
    /// What it is.
    pub use_: FaceUse,
    /// Area of the undeformed template face, if it came from one.
    pub ideal_area: Option<f64>,
    /// Root mean square registration distance, metres, if it came from a template.
    pub registration: Option<f64>,
    /// The template means it to have no street access.
    pub access_exempt: bool,
}

/// What a [`FillFace`] is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceUse {
    /// A parcel.
    Parcel,
    /// Open space.
    Park,
    /// Land of a street inside the block.
    Street,
    /// Verge and remnants.
    Other,
}

impl Cut {
    /// All points, ends included.
    #[must_use]
    pub fn points(&self) -> Vec<Coord<f64>> {
        let mut out = vec![self.from.at];
        out.extend_from_slice(&self.path);
        out.push(self.to.at);
        out
    }
}
