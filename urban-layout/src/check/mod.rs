//! The certificate: does a layout keep the laws on its site?
//!
//! [`check`](fn@check) judges a finished layout from the outside, from the site
//! and the geometry alone; nothing that the planner claims is taken on trust.
//! Every law is listed with what was measured and what is allowed, passed or
//! not, so that a certificate also says how far a layout is from failing.
//!
//! | law | what it says |
//! |---|---|
//! | `ids` | every feature has an id of its own |
//! | `valid` | every tile and block is a valid polygon (OGC simple features) |
//! | `overlap`, `gap`, `spill` | the tiles cover the site once, by area (at most 20 m2 per km2) |
//! | `twins` | the tiles cover the site once, by counting: each directed edge has its reverse in exactly one other tile or lies on the site's boundary |
//! | `parcels` | a site over 5000 m2 has parcels |
//! | `junctions` | street ends meet at junction points of the right place and degree |
//! | `crossings` | streets meet only at junctions |
//! | `paved` | streets lie in the street area |
//! | `exits` | every street component leads out of the site |
//! | `served_area` | every part of the street area has a street that leads out |
//! | `networks` | one street network per connected part of the site |
//! | `frontage` | every parcel has frontage on a street that leads out |
//! | `exempt` | few parcels are exempt from that (2 % + 1) |
//! | `given_elements`, `given_roads` | what came with the site is still there |
//! | `stubs` | no street ends inside the site but a cul-de-sac |
//! | `junction_spacing` | no two junctions closer than a street width |
//! | `meeting_angle` | no two streets meet under 60 degrees |
//! | `sharp_turns`, `zigzags` | no street turns sharply or swerves left and right |

mod access;
mod exits;
mod given;
mod network;
mod streets;
mod tiling;
mod valid;

use serde_json::{json, Value};

use crate::layout::{Layout, TileKind};
use crate::site::Site;

pub use crate::io::layout_geojson::read_layout;
pub use access::frontages;
pub(crate) use exits::Exits;
pub(crate) use network::Network;
pub use valid::polygon_fault;

/// What a check may be told.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckOptions {
    /// Least frontage of a parcel on a street that leads out, metres. Default 3.
    pub frontage: f64,
    /// Width of a street where its junction's streets do not say one, metres:
    /// no two junctions may be closer. Default 15.
    pub junction_spacing: f64,
    /// Least angle between two streets at a junction, degrees. Default 60.
    pub meeting_angle_deg: f64,
    /// Most faults of one law that a certificate spells out. Default 20.
    pub details: usize,
}

impl Default for CheckOptions {
    fn default() -> Self {
        Self {
            frontage: 3.0,
            junction_spacing: 15.0,
            meeting_angle_deg: 60.0,
            details: 20,
        }
    }
}

/// How one law fared.
#[derive(Clone, Debug, PartialEq)]
pub struct LawResult {
    /// The law's name, as in the table of [`crate::check`].
    pub law: &'static str,
    /// Whether the layout keeps it.
    pub passed: bool,
    /// What was measured: a count of faults, or an area in square metres.
    pub measured: f64,
    /// The most that is allowed of it.
    pub allowed: f64,
    /// The faults, worst or first, at most [`CheckOptions::details`] of them.
    pub detail: Vec<String>,
}

/// What was found of a layout, law by law.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// Every law, in the order of the table of [`crate::check`].
    pub laws: Vec<LawResult>,
    /// Ids of the parcels that the layout exempts from frontage.
    pub exempt: Vec<u64>,
    /// Ids of the parcels without enough frontage that are not exempt.
    pub without_access: Vec<u64>,
    /// Street networks that are not connected to each other.
    pub components: usize,
    /// Junctions of one street that are no way out: cul-de-sacs and stubs.
    pub dead_ends: usize,
}

impl Certificate {
    /// Whether every law is kept.
    #[must_use]
    pub fn is_ok(&self) -> bool {
        self.laws.iter().all(|law| law.passed)
    }

    /// The laws that are not kept.
    pub fn failed(&self) -> impl Iterator<Item = &LawResult> {
        self.laws.iter().filter(|law| !law.passed)
    }

    /// One law by name.
    #[must_use]
    pub fn law(&self, name: &str) -> Option<&LawResult> {
        self.laws.iter().find(|law| law.law == name)
    }

    /// The certificate as JSON: `ok`, `laws` (each with `law passed measured
    /// allowed detail`), `exempt`, `without_access`, `street_components`,
    /// `dead_ends`.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let laws: Vec<Value> = self
            .laws
            .iter()
            .map(|law| {
                json!({
                    "law": law.law,
                    "passed": law.passed,
                    "measured": crate::metrics::rounded(law.measured),
                    "allowed": crate::metrics::rounded(law.allowed),
                    "detail": law.detail,
                })
            })
            .collect();
        json!({
            "ok": self.is_ok(),
            "laws": laws,
            "exempt": self.exempt,
            "without_access": self.without_access,
            "street_components": self.components,
            "dead_ends": self.dead_ends,
        })
    }
}

impl std::fmt::Display for Certificate {
    /// One line a law, then the faults of those that failed.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for law in &self.laws {
            let word = if law.passed { "ok    " } else { "FAILED" };
            writeln!(
                f,
                "{word} {:<18} {:.4} (allowed {:.4})",
                law.law, law.measured, law.allowed
            )?;
            if !law.passed {
                for line in &law.detail {
                    writeln!(f, "         {line}")?;
                }
            }
        }
        Ok(())
    }
}

/// Collects results while the rooms of this module judge.
#[derive(Debug)]
pub(crate) struct Findings {
    laws: Vec<LawResult>,
    details: usize,
}

impl Findings {
    fn new(details: usize) -> Self {
        Self {
            laws: Vec::new(),
            details,
        }
    }

    /// A law that counts faults and allows none.
    pub(crate) fn none_of(&mut self, law: &'static str, faults: Vec<String>) {
        self.at_most(law, faults.len() as f64, 0.0, faults);
    }

    /// A law that allows a measure up to a limit.
    pub(crate) fn at_most(
        &mut self,
        law: &'static str,
        measured: f64,
        allowed: f64,
        mut detail: Vec<String>,
    ) {
        let more = detail.len().saturating_sub(self.details);
        if more > 0 {
            detail.truncate(self.details);
            detail.push(format!("and {more} more"));
        }
        let measured = measured + 0.0; // a plain zero for -0
                                       // NaN does not pass.
        let passed = measured <= allowed;
        self.laws.push(LawResult {
            law,
            passed,
            measured,
            allowed,
            detail,
        });
    }
}

/// Judges a layout against its site, law by law (see [`crate::check`]).
///
/// Bad layouts give failed laws, never an error or a panic: this is also how
/// layouts made by other tools are judged.
///
/// # Units
///
/// Both in local metres of the same frame.
///
/// # Complexity
///
/// O(n log n) for n vertices, but for the crossings that actually exist.
#[must_use]
pub fn check(site: &Site, layout: &Layout, options: &CheckOptions) -> Certificate {
    let mut findings = Findings::new(options.details);
    ids(layout, &mut findings);
    tiling::judge(site, layout, &mut findings);
    let exits = Exits::new(site);
    let network = Network::new(layout, &exits);
    network.judge(layout, &mut findings);
    let served = access::judge_streets(layout, &network, &mut findings);
    network::judge_parts(site, &network, &mut findings);
    let (exempt, without_access) =
        access::judge_parcels(site, layout, &served, options, &mut findings);
    given::judge(site, layout, &mut findings);
    streets::judge(layout, &network, &exits, options, &mut findings);
    Certificate {
        laws: findings.laws,
        exempt,
        without_access,
        components: network.components(),
        dead_ends: network.dead_ends(&exits),
    }
}

/// Every feature has an id of its own, and a large site has parcels.
fn ids(layout: &Layout, findings: &mut Findings) {
    let mut all: Vec<(u64, &str)> = Vec::new();
    all.extend(layout.tiles.iter().map(|t| (t.id, t.kind.as_str())));
    all.extend(layout.streets.iter().map(|s| (s.id, "street")));
    all.extend(layout.junctions.iter().map(|j| (j.id, "junction")));
    all.extend(layout.blocks.iter().map(|b| (b.id, "block")));
    all.sort_unstable();
    let twice = all.windows(2).filter(|w| w[0].0 == w[1].0);
    let faults = twice
        .map(|w| format!("id {} is used by a {} and a {}", w[0].0, w[0].1, w[1].1))
        .collect();
    findings.none_of("ids", faults);
    let bare = layout.site_area() > 5000.0 && layout.tiles_of(TileKind::Parcel).next().is_none();
    findings.none_of(
        "parcels",
        if bare {
            vec!["no parcels".to_owned()]
        } else {
            Vec::new()
        },
    );
}
