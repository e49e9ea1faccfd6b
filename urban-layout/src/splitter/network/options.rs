//! What a network is asked for.

use network_opt::design::{Coverage, OneWay, Sinks, Specification};

use crate::design::{LevelSpec, NetworkSpec};
use crate::error::{Error, Result};
use crate::options::{FieldKind, PlanOptions};
use crate::site::RoadClass;

/// How [`NetworkSplitter`](super::NetworkSplitter) lays out streets.
///
/// Quads of the last level are one row of parcels deep by default: half a
/// street and a parcel. Streets keep two edges apart, since opposite edges of a
/// quad are too close, so that blocks hold two rows; and a quad that touches no
/// street costs [`fronts`](Self::fronts), so that no third row lies between.
#[derive(Clone, Debug, PartialEq)]
pub struct NetworkOptions {
    /// The levels of streets, the widest first, with the edge length of the
    /// first level's mesh.
    ///
    /// Default value: `None`. Local streets along every quad, the edges of which
    /// are as long as a parcel and half a street; those with much traffic are
    /// collectors, see [`collector_parcels`](Self::collector_parcels).
    pub spec: Option<NetworkSpec>,
    /// The cross field that quads follow.
    ///
    /// Default value: that of the boundary, the smoothest: irregular vertices of
    /// the mesh, of which there are the fewest then, are where blocks are odd.
    pub field: FieldKind,
    /// Moves of the search for each level: its time, by a measure that no clock
    /// and no other process changes.
    ///
    /// Default value: 10,000.
    pub moves: u64,
    /// Networks that are found, each from another seed; the one whose streets
    /// can be built best and leave the squarest blocks is taken.
    ///
    /// Default value: 3.
    pub tries: u32,
    /// What a quad of the last level costs that no street runs along, in edges.
    ///
    /// Default value: 1.5.
    pub fronts: f64,
    /// What a bend costs where a street turns a corner of a quad, in edges.
    ///
    /// Default value: 0.75.
    pub bends: f64,
    /// What a street costs that ends at the edge of the land, in edges, where
    /// the specification forbids dead ends: elsewhere none does.
    ///
    /// Default value: 0.5.
    pub ends: f64,
    /// Land that gets a network, in ideal parcels; smaller regions are split by
    /// the splitters that come after.
    ///
    /// Default value: 60.
    pub least_parcels: f64,
    /// Where there is no [`spec`](Self::spec), a street over which so many
    /// parcels have their way out is a collector.
    ///
    /// Default value: 150.
    pub collector_parcels: f64,
}

impl Default for NetworkOptions {
    fn default() -> Self {
        Self {
            spec: None,
            field: FieldKind::Boundary,
            moves: 10_000,
            tries: 3,
            fronts: 1.5,
            bends: 0.75,
            ends: 0.5,
            least_parcels: 60.0,
            collector_parcels: 150.0,
        }
    }
}

/// A level that is ready for use.
#[derive(Clone, Debug)]
pub(super) struct LevelPlan {
    pub(super) class: RoadClass,
    pub(super) width: f64,
    pub(super) network: Specification,
}

/// Weight of travel in the standard levels: of networks that are about as long
/// the one with the shorter ways.
const TRAVEL: f64 = 0.01;

impl NetworkOptions {
    /// Checks numbers and specification.
    ///
    /// # Errors
    ///
    /// [`Error::is_usage`] for a number out of its range, a class of street
    /// that there is not, and a specification that names vertices or edges: the
    /// meshes of regions are not known beforehand.
    pub(crate) fn check(&self) -> Result<()> {
        for (name, value) in [
            ("fronts", self.fronts),
            ("bends", self.bends),
            ("ends", self.ends),
            ("least_parcels", self.least_parcels),
            ("collector_parcels", self.collector_parcels),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Error::usage(format!(
                    "{name} of the network is {value}; give 0 or more"
                )));
            }
        }
        if self.moves == 0 {
            return Err(Error::usage(
                "the search for a network has 0 moves; give 1 or more",
            ));
        }
        if self.tries == 0 {
            return Err(Error::usage("0 networks are tried; give 1 or more"));
        }
        let Some(spec) = &self.spec else {
            return Ok(());
        };
        if !(spec.edge_length >= 0.0 && spec.edge_length.is_finite()) {
            return Err(Error::usage(format!(
                "the edge length is {}; give metres, or 0 for automatic",
                spec.edge_length
            )));
        }
        if spec.level.is_empty() {
            return Err(Error::usage(
                "the specification has no level; give a [[level]]",
            ));
        }
        spec.level.iter().try_for_each(check_level)
    }

    /// The levels of a region.
    pub(super) fn levels(&self, options: &PlanOptions) -> Vec<LevelPlan> {
        if let Some(spec) = &self.spec {
            return spec
                .level
                .iter()
                .map(|l| LevelPlan {
                    class: RoadClass::parse(&l.class).unwrap_or(RoadClass::Local),
                    width: l.width,
                    network: l.network.clone(),
                })
                .collect();
        }
        vec![LevelPlan {
            class: RoadClass::Local,
            width: options.street_width,
            network: Specification {
                coverage: Coverage::Hops(2),
                travel: TRAVEL,
                ..Specification::default()
            },
        }]
    }

    /// Length of the edges of the first of `levels` levels, metres.
    pub(super) fn edge_length(&self, options: &PlanOptions, levels: usize) -> f64 {
        let given = self.spec.as_ref().map_or(0.0, |spec| spec.edge_length);
        if given > 0.0 {
            return given;
        }
        let row = options.parcel_length + 0.5 * options.street_width;
        row * 2f64.powi(i32::try_from(levels).unwrap_or(1) - 1)
    }

    /// Area below which a region gets no network, square metres.
    pub(super) fn least_area(&self, options: &PlanOptions) -> f64 {
        self.least_parcels * parcel(options)
    }
}

fn parcel(options: &PlanOptions) -> f64 {
    options.parcel_length * options.parcel_width
}

fn check_level(level: &LevelSpec) -> Result<()> {
    let LevelSpec {
        class,
        width,
        network,
        speed,
        places,
    } = level;
    if RoadClass::parse(class).is_none() {
        return Err(Error::usage(format!(
            "a level of streets has the class {class:?}; say collector, local or major"
        )));
    }
    if !(2.0..=100.0).contains(width) {
        return Err(Error::usage(format!(
            "streets of the class {class:?} are {width} m wide; give 2 to 100 m"
        )));
    }
    let named = matches!(network.sinks, Sinks::At(_) | Sinks::Placed { .. })
        || !places.is_empty()
        || !(network.given.is_empty() && network.obstacles.is_empty() && network.routes.is_empty());
    if named {
        return Err(Error::usage(format!(
            "the level of class {class:?} names vertices, edges or places; regions of a plan are cut into quads of \
             their own and lead to the streets around them, so leave out given, obstacles, routes, places and sinks \
             but \"boundary\" and \"streets\""
        )));
    }
    let directed = network.one_way != OneWay::default() || !network.one_way_runs.is_empty();
    if directed || speed.is_some() {
        return Err(Error::usage(format!(
            "the level of class {class:?} has a speed or one-way streets; streets of a plan run both ways and know no \
             speed, so leave them out"
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half a street and a parcel on the last level, twice that above it.
    #[test]
    fn a_quad_of_the_last_level_is_a_row_of_parcels() {
        let plan = PlanOptions::default();
        let options = NetworkOptions::default();
        assert_eq!(options.edge_length(&plan, 1), 37.5);
        assert_eq!(options.edge_length(&plan, 2), 75.0);
        let spec = NetworkSpec {
            edge_length: 50.0,
            ..NetworkSpec::default()
        };
        let given = NetworkOptions {
            spec: Some(spec),
            ..options
        };
        assert_eq!(given.edge_length(&plan, 3), 50.0);
        assert_eq!(given.levels(&plan).len(), 1);
        assert_eq!(given.levels(&plan)[0].class, RoadClass::Collector);
    }
}
