//! What a run may be told: sizes, field, seed, weights and limits.

use crate::park::ParkChoice;
use crate::splitter::NetworkOptions;

/// Which cross field guides the streets (supplement 2013, section 4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FieldKind {
    /// D-field: crosses follow the distance to the boundary (section 4.1).
    #[default]
    Distance,
    /// H-field: crosses from harmonic functions (section 4.2).
    Harmonic,
    /// B-field: crosses interpolated smoothly from the boundary (section 4.3).
    Boundary,
}

impl FieldKind {
    /// The word used on the command line and in `layout.geojson`.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Harmonic => "harmonic",
            Self::Boundary => "boundary",
        }
    }
}

/// Weights of a streamline's scores (paper section 5); each score is
/// normalised to \[0, 1\] over the candidates first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScoreWeights {
    /// Weight lambda_1 of the divergence score. Default 1.
    pub divergence: f64,
    /// Weight lambda_2 of the distance to the boundary. Default 1.
    pub boundary: f64,
    /// Weight lambda_3 of the distance to singularities. Default 1.
    pub singularities: f64,
    /// Weight lambda_4 of continuity. Default 1.
    pub continuity: f64,
    /// Weight of the balance of the two sides, which the paper does not have:
    /// it keeps the split tree shallow and the blocks of a kind. Default 1.5.
    pub balance: f64,
    /// Weight of the land that a street brings within reach, which the paper
    /// does not have either. Default 1.
    pub service: f64,
}

impl Default for ScoreWeights {
    fn default() -> Self {
        Self {
            divergence: 1.0,
            boundary: 1.0,
            singularities: 1.0,
            continuity: 1.0,
            balance: 1.5,
            service: 1.0,
        }
    }
}

/// Options of [`generate`](crate::generate).
#[derive(Clone, Debug, PartialEq)]
pub struct PlanOptions {
    /// Seed of every random choice. Default 0.
    pub seed: u64,
    /// The field that streets follow. Default: distance.
    pub field: FieldKind,
    /// Length (depth) of the ideal parcel, metres. Default 30 (paper section 8).
    pub parcel_length: f64,
    /// Width (frontage) of the ideal parcel, metres. Default 18.
    pub parcel_width: f64,
    /// Width of new streets, metres. Default 15.
    pub street_width: f64,
    /// Least frontage of a parcel on a street, metres. Default 3.
    pub min_frontage: f64,
    /// Longest block side along a street before a cross street is wanted,
    /// metres. Default 240.
    pub block_length: f64,
    /// Weights of the streamline scores.
    pub weights: ScoreWeights,
    /// Whether the boundary score shares a misfit out over the rows of parcels
    /// (default), or measures it in metres as the paper does.
    pub row_fit: bool,
    /// How freely the streamline is chosen by quality: 0 takes the best, larger
    /// values give more variety. Default 0.06.
    pub temperature: f64,
    /// Whether the network is optimised globally (paper section 6). Default true.
    pub optimize: bool,
    /// Names of the templates that may be used; empty for all.
    pub templates: Vec<String>,
    /// Most warping energy at which a template is accepted (paper's threshold).
    /// Default 0.02.
    pub template_energy: f64,
    /// Where the streets of a region come from its specification as a network,
    /// how: see [`NetworkOptions`]. Default: `None`, from streamlines alone.
    pub network: Option<NetworkOptions>,
    /// How the parks of the plan are designed. Default: by grammars of the library
    /// that suit their size and shape.
    pub parks: ParkChoice,
    /// Worker threads; 0 for as many as there are cores. The result does not
    /// depend on it.
    pub threads: usize,
}

impl Default for PlanOptions {
    fn default() -> Self {
        Self {
            seed: 0,
            field: FieldKind::Distance,
            parcel_length: 30.0,
            parcel_width: 18.0,
            street_width: 15.0,
            min_frontage: 3.0,
            block_length: 240.0,
            weights: ScoreWeights::default(),
            row_fit: true,
            temperature: 0.06,
            optimize: true,
            templates: Vec::new(),
            template_energy: 0.02,
            network: None,
            parks: ParkChoice::Fitting,
            threads: 0,
        }
    }
}
