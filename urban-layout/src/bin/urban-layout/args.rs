//! What the command line may say.

use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand, ValueEnum};
use streamline::{CriteriaOptions, Criterion, Ends};
use urban_layout::design::NetworkSpec;
use urban_layout::field::FieldOptions;
use urban_layout::io::svg::Paint;
use urban_layout::park::ParkChoice;
use urban_layout::site::Units;
use urban_layout::splitter::NetworkOptions;
use urban_layout::streamlines::StreamlineOptions;
use urban_layout::{Error, FieldKind, PlanOptions, Result, Site};

/// Neighbourhood plans from a site boundary.
#[derive(Debug, Parser)]
#[command(name = "urban-layout", version, about, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Lay out a site: writes layout.geojson, layout.svg, metrics.json and parks.geojson.
    Generate(Generate),
    /// Prove a layout against its site; exit status 3 if a law fails.
    Check(Check),
    /// Design a cross field on a site: writes field.svg and field.json.
    Field(FieldJob),
    /// Place evenly spaced streamlines and judge them: writes streamlines.svg, streamlines.geojson and criteria.json.
    Streamlines(StreamlineJob),
    /// Design a street network from a specification: writes network.svg, traffic.svg, network.geojson and network.json.
    Network(NetworkJob),
    /// Plan the floors of a building, rooms and corridors: writes floorplan.svg, floorplan.geojson and floorplan.json.
    Floorplan(FloorplanJob),
    /// Derive a park from a grammar: writes park.svg and park.geojson.
    Park(ParkJob),
}

#[derive(Debug, Args)]
pub(crate) struct Generate {
    /// The site, a GeoJSON file.
    pub(crate) site: PathBuf,
    /// Folder for the results; made if it is not there.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
    /// Make so many plans, with seeds counted up from --seed, in folders 001, 002, ...
    #[arg(long, default_value_t = 1)]
    pub(crate) variations: u32,
    /// The cross field that streets follow.
    #[arg(long, value_enum, default_value_t = Field::Distance)]
    pub(crate) field: Field,
    /// Depth of the ideal parcel, metres.
    #[arg(long, default_value_t = 30.0)]
    pub(crate) parcel_length: f64,
    /// Frontage of the ideal parcel, metres.
    #[arg(long, default_value_t = 18.0)]
    pub(crate) parcel_width: f64,
    /// Width of new streets, metres.
    #[arg(long, default_value_t = 15.0)]
    pub(crate) street_width: f64,
    /// Templates that may be used, by name; all if none is named.
    #[arg(long, value_delimiter = ',')]
    pub(crate) templates: Vec<String>,
    /// Where streets come from.
    #[arg(long, value_enum, default_value_t = StreetWord::Streamlines)]
    pub(crate) streets: StreetWord,
    /// With --streets network: its levels, a TOML file; collectors and local streets that suit the parcels if not given.
    #[arg(long, value_name = "FILE")]
    pub(crate) spec: Option<PathBuf>,
    /// With --streets network: moves of the search for each level, its time.
    #[arg(long, default_value_t = NetworkOptions::default().moves, value_name = "N")]
    pub(crate) moves: u64,
    /// With --streets network: networks that are found for each region, of which the best is taken.
    #[arg(long, default_value_t = NetworkOptions::default().tries, value_name = "N")]
    pub(crate) tries: u32,
    /// How freely streets are chosen by quality; 0 always takes the best.
    #[arg(long, default_value_t = PlanOptions::default().temperature)]
    pub(crate) temperature: f64,
    /// Leave the network as the splits made it.
    #[arg(long)]
    pub(crate) no_optimize: bool,
    /// How the parks that the plan makes are designed: auto, none, a grammar of the
    /// library or a grammar's file.
    #[arg(long, default_value = "auto", value_name = "NAME|FILE")]
    pub(crate) park_grammar: String,
    /// Also draw layout.png.
    #[arg(long)]
    pub(crate) png: bool,
    /// Worker threads; 0 for one a core. The result does not depend on it.
    #[arg(long, default_value_t = 0)]
    pub(crate) threads: usize,
    #[command(flatten)]
    pub(crate) common: Common,
}

#[derive(Debug, Args)]
pub(crate) struct Check {
    /// The site, a GeoJSON file.
    pub(crate) site: PathBuf,
    /// The layout to judge, a GeoJSON file.
    pub(crate) layout: PathBuf,
    /// Least frontage of a parcel on a street, metres.
    #[arg(long, default_value_t = 3.0)]
    pub(crate) frontage: f64,
    #[command(flatten)]
    pub(crate) common: Common,
}

#[derive(Debug, Args)]
pub(crate) struct FieldJob {
    /// The site, a GeoJSON file.
    pub(crate) site: PathBuf,
    /// Folder for the results; made if it is not there.
    #[arg(long)]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) design: Design,
    #[command(flatten)]
    pub(crate) common: Common,
}

#[derive(Debug, Args)]
pub(crate) struct StreamlineJob {
    /// The site, a GeoJSON file.
    pub(crate) site: PathBuf,
    /// Folder for the results; made if it is not there.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Distance between neighbouring lines of either family, metres.
    #[arg(long, default_value_t = StreamlineOptions::default().separation, value_name = "M")]
    pub(crate) separation: f64,
    /// How near a line may come to one beside it, metres; 0.87 of the separation if not given.
    #[arg(long, value_name = "M")]
    pub(crate) test: Option<f64>,
    /// What becomes of ends that come near other lines.
    #[arg(long, value_enum, default_value_t = EndWord::Open)]
    pub(crate) ends: EndWord,
    /// Within what length a change of direction is a turn, metres.
    #[arg(long, default_value_t = CriteriaOptions::default().region, value_name = "M")]
    pub(crate) turn_region: f64,
    /// By how much the direction must change for a turn, degrees.
    #[arg(long, default_value_t = CriteriaOptions::default().angle_deg, value_name = "DEG")]
    pub(crate) turn_angle: f64,
    /// What the colours of the picture say.
    #[arg(long, value_enum, default_value_t = PaintWord::Families)]
    pub(crate) paint: PaintWord,
    /// Also draw streamlines.png.
    #[arg(long)]
    pub(crate) png: bool,
    #[command(flatten)]
    pub(crate) design: Design,
    #[command(flatten)]
    pub(crate) common: Common,
}

#[derive(Debug, Args)]
pub(crate) struct FloorplanJob {
    /// The building, a GeoJSON file.
    pub(crate) building: PathBuf,
    /// Folder for the results; made if it is not there.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Rooms, entrances, shafts and storeys, a TOML file; one storey of offices if not given.
    #[arg(long, value_name = "FILE")]
    pub(crate) spec: Option<PathBuf>,
    /// Seconds to search for.
    #[arg(long, default_value_t = 10.0, value_name = "S")]
    pub(crate) deadline: f64,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
    /// Threads of the search.
    #[arg(long, default_value_t = 1)]
    pub(crate) threads: usize,
    /// Also draw floorplan.png.
    #[arg(long)]
    pub(crate) png: bool,
    #[command(flatten)]
    pub(crate) common: Common,
}

#[derive(Debug, Args)]
pub(crate) struct NetworkJob {
    /// The site, a GeoJSON file.
    pub(crate) site: PathBuf,
    /// Folder for the results; made if it is not there.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// What the network is for, a TOML file; short collectors within two edges of everything if not given.
    #[arg(long, value_name = "FILE")]
    pub(crate) spec: Option<PathBuf>,
    /// Seconds to search for.
    #[arg(long, default_value_t = 10.0, value_name = "S")]
    pub(crate) deadline: f64,
    /// Stop where the cost is proven to be within this part of the least.
    #[arg(long, default_value_t = 0.0)]
    pub(crate) gap: f64,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
    /// Threads of the search.
    #[arg(long, default_value_t = 1)]
    pub(crate) threads: usize,
    /// Also draw network.png and traffic.png.
    #[arg(long)]
    pub(crate) png: bool,
    /// Cars per square kilometre and hour that leave the site [default: as the
    /// specification says, 250].
    #[arg(long, value_name = "N")]
    pub(crate) cars: Option<f64>,
    /// Cars an hour besides from each place where a street outside meets the
    /// boundary to the others, in all [default: as the specification says, 0].
    #[arg(long, value_name = "N")]
    pub(crate) external: Option<f64>,
    /// Write files for the traffic simulator SUMO, and run it if it is installed.
    #[arg(long)]
    pub(crate) sumo: bool,
    #[command(flatten)]
    pub(crate) common: Common,
}

#[derive(Debug, Args)]
pub(crate) struct ParkJob {
    /// The park's outline, a GeoJSON file; a park for each of its parts.
    pub(crate) polygon: PathBuf,
    /// Folder for the results; made if it is not there.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// The grammar: a file, or the name of one of the library, such as simple_square.
    #[arg(long, value_name = "FILE|NAME")]
    pub(crate) grammar: String,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
    /// Gives a parameter of the grammar another value; may be repeated.
    #[arg(long, value_name = "NAME=VALUE")]
    pub(crate) param: Vec<String>,
    /// Also write the model park.glb, glTF 2.0.
    #[arg(long)]
    pub(crate) gltf: bool,
    /// Also draw park.png.
    #[arg(long)]
    pub(crate) png: bool,
    #[command(flatten)]
    pub(crate) common: Common,
}

/// How a field is designed.
#[derive(Debug, Args)]
pub(crate) struct Design {
    /// The design.
    #[arg(long, value_enum, default_value_t = Field::Distance)]
    pub(crate) field: Field,
    /// Wanted edge length of the mesh, metres; 0 for a fortieth of the square root of the area.
    #[arg(long, default_value_t = 0.0, value_name = "M")]
    pub(crate) edge_length: f64,
    /// How strongly a boundary field keeps to the boundary.
    #[arg(long, default_value_t = FieldOptions::default().omega)]
    pub(crate) omega: f64,
    /// Rounds of smoothing; 1 for a distance field and 0 for others if not given.
    #[arg(long)]
    pub(crate) smoothing: Option<usize>,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
}

#[derive(Debug, Args)]
pub(crate) struct Common {
    /// Unit of the site's coordinates.
    #[arg(long, value_enum, default_value_t = UnitWord::Auto)]
    pub(crate) units: UnitWord,
    /// Print the figures as one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Field {
    Distance,
    Harmonic,
    Boundary,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StreetWord {
    /// One split after the other, along streamlines of the field.
    Streamlines,
    /// All at once, a network from a specification.
    Network,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UnitWord {
    /// Degrees, unless the file says metres.
    Auto,
    Metres,
    Degrees,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum EndWord {
    /// They stay in the open.
    Open,
    /// They are cut back to T-junctions.
    Junction,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PaintWord {
    Families,
    Divergence,
    Continuity,
    Parallelism,
    Perpendicularity,
    Convexity,
    Singularities,
}

impl From<EndWord> for Ends {
    fn from(word: EndWord) -> Self {
        match word {
            EndWord::Open => Self::Open,
            EndWord::Junction => Self::Junction,
        }
    }
}

impl From<PaintWord> for Paint {
    fn from(word: PaintWord) -> Self {
        Self::Criterion(match word {
            PaintWord::Families => return Self::Families,
            PaintWord::Divergence => Criterion::Divergence,
            PaintWord::Continuity => Criterion::Continuity,
            PaintWord::Parallelism => Criterion::Parallelism,
            PaintWord::Perpendicularity => Criterion::Perpendicularity,
            PaintWord::Convexity => Criterion::Convexity,
            PaintWord::Singularities => Criterion::Singularities,
        })
    }
}

impl From<Field> for FieldKind {
    fn from(word: Field) -> Self {
        match word {
            Field::Distance => Self::Distance,
            Field::Harmonic => Self::Harmonic,
            Field::Boundary => Self::Boundary,
        }
    }
}

impl From<UnitWord> for Units {
    fn from(word: UnitWord) -> Self {
        match word {
            UnitWord::Auto => Self::Auto,
            UnitWord::Metres => Self::Metres,
            UnitWord::Degrees => Self::Degrees,
        }
    }
}

impl Common {
    /// The site in a file, in the unit that the command line names.
    pub(crate) fn read(&self, path: &Path) -> Result<Site> {
        let text = std::fs::read_to_string(path).map_err(|e| Error::reading(path, e))?;
        Site::from_geojson(&text, self.units.into())
    }

    /// The building of a file.
    pub(crate) fn read_building(&self, path: &Path) -> Result<Site> {
        let text = std::fs::read_to_string(path).map_err(|e| Error::reading(path, e))?;
        Site::building_from_geojson(&text, self.units.into())
    }

    /// The land of a file that is to be a park.
    pub(crate) fn read_park(&self, path: &Path) -> Result<Site> {
        let text = std::fs::read_to_string(path).map_err(|e| Error::reading(path, e))?;
        Site::park_from_geojson(&text, self.units.into())
    }
}

impl StreamlineJob {
    pub(crate) fn options(&self) -> StreamlineOptions {
        StreamlineOptions {
            field: self.design.options(),
            separation: self.separation,
            test: self.test,
            ends: self.ends.into(),
            criteria: CriteriaOptions {
                region: self.turn_region,
                angle_deg: self.turn_angle,
                ..CriteriaOptions::default()
            },
        }
    }
}

impl Design {
    pub(crate) fn options(&self) -> FieldOptions {
        FieldOptions {
            kind: self.field.into(),
            edge_length: self.edge_length,
            omega: self.omega,
            smoothing: self.smoothing,
            seed: self.seed,
        }
    }
}

impl Generate {
    /// The options of the `k`-th variation.
    ///
    /// # Errors
    ///
    /// A specification that cannot be read, or that nobody asked for.
    pub(crate) fn options(&self, k: u32) -> Result<PlanOptions> {
        Ok(PlanOptions {
            seed: self.seed.wrapping_add(u64::from(k)),
            field: self.field.into(),
            parcel_length: self.parcel_length,
            parcel_width: self.parcel_width,
            street_width: self.street_width,
            templates: self.templates.clone(),
            temperature: self.temperature,
            optimize: !self.no_optimize,
            network: self.network()?,
            parks: match self.park_grammar.as_str() {
                "auto" => ParkChoice::Fitting,
                "none" => ParkChoice::Plain,
                word => ParkChoice::Grammar(Box::new(urban_layout::park::grammar(word)?)),
            },
            threads: self.threads,
            ..PlanOptions::default()
        })
    }

    fn network(&self) -> Result<Option<NetworkOptions>> {
        if self.streets != StreetWord::Network {
            return if self.spec.is_some() {
                Err(Error::usage(
                    "--spec describes a network of streets; ask for one with --streets network",
                ))
            } else {
                Ok(None)
            };
        }
        Ok(Some(NetworkOptions {
            spec: self.spec.as_deref().map(read_spec).transpose()?,
            moves: self.moves,
            tries: self.tries,
            ..NetworkOptions::default()
        }))
    }
}

/// The specification in a file.
pub(crate) fn read_spec(path: &Path) -> Result<NetworkSpec> {
    let text = std::fs::read_to_string(path).map_err(|e| Error::reading(path, e))?;
    NetworkSpec::from_toml(&text)
}
