//! The evenly spaced streamlines of a whole site, the tiles between them, and
//! how they are judged: what `urban-layout streamlines` shows.

use std::time::Instant;

use crossfield::Field;
use geo_types::{Polygon, Rect};
use serde_json::{json, Value};
use streamline::{
    criteria, lattice, place, tiles, Criteria, CriteriaOptions, Criterion, DirectionField, Ends,
    PlacementOptions, Singularity, Spread, Stop, Streamline, TileOptions, Tiling, Total,
    TraceError, TraceOptions,
};

use crate::adapt::Arms;
use crate::error::{Error, Result};
use crate::field::{FieldOptions, FieldStudy};
use crate::plane::extent;
use crate::site::Site;

/// Most seeds, half a separation apart, over a site: some minutes of work.
const MOST_SEEDS: f64 = 4e6;

/// What [`StreamlineStudy::new`] may be told.
#[derive(Clone, Debug, PartialEq)]
pub struct StreamlineOptions {
    /// The field that the lines follow.
    pub field: FieldOptions,
    /// Distance between neighbouring lines of either family, metres.
    /// Default 75.
    pub separation: f64,
    /// A line ends before it comes nearer than this to another that runs
    /// alongside, metres: from a tenth of the separation to all of it. `None`
    /// for 0.87 of the separation. Default `None`.
    pub test: Option<f64>,
    /// What becomes of the ends of such lines. Default: they stay in the open.
    pub ends: Ends,
    /// What the criteria are measured with. Default: as [`CriteriaOptions`].
    pub criteria: CriteriaOptions,
}

impl Default for StreamlineOptions {
    fn default() -> Self {
        Self {
            field: FieldOptions::default(),
            separation: 75.0,
            test: None,
            ends: Ends::Open,
            criteria: CriteriaOptions::default(),
        }
    }
}

impl StreamlineOptions {
    /// How lines are placed. Lengths of the tracer follow the separation: at
    /// 75 m they are its defaults.
    fn placement(&self) -> Result<PlacementOptions> {
        let base = PlacementOptions::default();
        if !(self.separation > 0.0 && self.separation.is_finite()) {
            return Err(Error::usage(format!(
                "the separation is {} m; it must be positive",
                self.separation
            )));
        }
        let share = self.test.map_or(base.test, |test| test / self.separation);
        if !(0.1..=1.0).contains(&share) {
            return Err(Error::usage(format!(
                "the test distance is {} m; it must be from a tenth of the separation of {} m to all of it",
                self.test.unwrap_or(f64::NAN),
                self.separation
            )));
        }
        let factor = self.separation / base.separation[0];
        Ok(PlacementOptions {
            separation: [self.separation; 2],
            test: share,
            ends: self.ends,
            trace: TraceOptions {
                tolerance: base.trace.tolerance * factor,
                ..TraceOptions::scaled(factor)
            },
            ..base
        })
    }
}

/// The streamlines of one part of a site.
#[derive(Clone, Debug)]
pub struct PartStreamlines {
    /// In the order of placement; local metres.
    pub lines: Vec<Streamline>,
    /// The part cut along them. Pieces that do not divide are left out.
    pub tiling: Tiling,
    /// Line by line, tile by tile and in total.
    pub criteria: Criteria,
}

/// Streamlines of a field over each part of a site, and what they are worth.
#[derive(Debug)]
pub struct StreamlineStudy {
    /// The fields that the lines follow.
    pub field: FieldStudy,
    /// Lines, tiles and criteria of each of [`Site::parts`].
    pub parts: Vec<PartStreamlines>,
    /// The criteria of all parts together.
    pub criteria: Criteria,
    /// Seconds that placing the lines took.
    pub placement_seconds: f64,
    /// Seconds that the tiles and the criteria took.
    pub criteria_seconds: f64,
    options: StreamlineOptions,
}

impl StreamlineStudy {
    /// Designs a field on each part of `site`, as [`FieldStudy::new`] does, and
    /// places evenly spaced streamlines of both families over it.
    ///
    /// # Errors
    ///
    /// Those of [`FieldStudy::new`]; errors of usage for options out of their
    /// range, and for a separation that asks for over four million seeds.
    ///
    /// # Examples
    ///
    /// ```
    /// use urban_layout::site::{Site, Units};
    /// use urban_layout::streamlines::{StreamlineOptions, StreamlineStudy};
    ///
    /// let site = Site::from_geojson(
    ///     r#"{"type": "Polygon", "coordinates": [[[0, 0], [300, 0], [300, 200], [0, 200], [0, 0]]]}"#,
    ///     Units::Metres,
    /// )?;
    /// let options = StreamlineOptions { separation: 50.0, ..StreamlineOptions::default() };
    /// let study = StreamlineStudy::new(&site, &options)?;
    /// // A rectangle: a grid, 0 in all six criteria.
    /// let figures = study.to_json();
    /// assert_eq!(figures["singularities"], 0);
    /// for key in ["divergence", "continuity", "parallelism", "perpendicularity", "convexity"] {
    ///     assert!(figures[key].as_f64().is_some_and(|value| value < 1e-9), "{key}");
    /// }
    /// # Ok::<(), urban_layout::Error>(())
    /// ```
    pub fn new(site: &Site, options: &StreamlineOptions) -> Result<Self> {
        Self::of_field(site, FieldStudy::new(site, &options.field)?, options)
    }

    /// The same on fields that are there already; of the options those of the
    /// field are left aside.
    ///
    /// # Errors
    ///
    /// As [`StreamlineStudy::new`], and an error of usage if there is not one
    /// field for each part.
    pub fn of_field(site: &Site, field: FieldStudy, options: &StreamlineOptions) -> Result<Self> {
        let placement = options.placement()?;
        if field.fields.len() != site.parts.len() {
            return Err(Error::usage(format!(
                "there are {} fields for the {} parts of the site; give one for each",
                field.fields.len(),
                site.parts.len()
            )));
        }
        let mut seeds = 0.0;
        for part in &site.parts {
            let (low, high) = extent(part);
            seeds += (high.x - low.x) * (high.y - low.y) * 4.0 / options.separation.powi(2);
        }
        if seeds > MOST_SEEDS {
            return Err(Error::usage(format!(
                "a separation of {} m asks for some {:.0} million places to start from; choose a larger one",
                options.separation,
                seeds / 1e6
            )));
        }
        let start = Instant::now();
        let mut placed = Vec::with_capacity(site.parts.len());
        for (part, design) in site.parts.iter().zip(&field.fields) {
            placed.push(lines(part, &Arms(design), &placement).map_err(reported)?);
        }
        let placement_seconds = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let mut parts = Vec::with_capacity(site.parts.len());
        for ((part, design), lines) in site.parts.iter().zip(&field.fields).zip(placed) {
            let strings: Vec<_> = lines.iter().map(Streamline::to_line_string).collect();
            let cut = TileOptions {
                snap: options.criteria.snap,
                ..TileOptions::default()
            };
            let tiling = tiles(part, &strings, &cut).map_err(reported)?;
            parts.push(PartStreamlines {
                criteria: judge(part, design, &lines, &tiling, &options.criteria)?,
                lines,
                tiling,
            });
        }
        let all = parts.iter().map(|part| part.criteria.clone());
        Ok(Self {
            criteria: Criteria::joined(all, &options.criteria),
            field,
            parts,
            placement_seconds,
            criteria_seconds: start.elapsed().as_secs_f64(),
            options: options.clone(),
        })
    }

    /// Judges the same lines and tiles with other options, such as another
    /// detect region or a limit of reach.
    ///
    /// # Errors
    ///
    /// Errors of usage for options out of their range, and for another site
    /// than that of the study.
    pub fn judged(&self, site: &Site, options: &CriteriaOptions) -> Result<Criteria> {
        if site.parts.len() != self.parts.len() {
            return Err(Error::usage(
                "the site is not that of the study; give the same one",
            ));
        }
        let parts = site.parts.iter().zip(&self.field.fields).zip(&self.parts);
        let judged = parts
            .map(|((part, design), of)| judge(part, design, &of.lines, &of.tiling, options))
            .collect::<Result<Vec<_>>>()?;
        Ok(Criteria::joined(judged, options))
    }

    /// The figures of `criteria.json`: the six, each 0 at best, and behind
    /// them what they are made of. Lengths are in metres, angles in right
    /// angles, `convexity` is 1 - hull perimeter / perimeter; `singularities`
    /// is their number. A criterion that nothing was measured for is `null`.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let totals = &self.criteria.totals;
        let mean =
            |criterion: Criterion| criterion.is_measured(totals).then(|| criterion.of(totals));
        let options = &self.options;
        json!({
            "field": self.field.options.kind.as_str(),
            "seed": self.field.options.seed,
            "separation_m": options.separation,
            "divergence": mean(Criterion::Divergence),
            "continuity": mean(Criterion::Continuity),
            "parallelism": mean(Criterion::Parallelism),
            "perpendicularity": mean(Criterion::Perpendicularity),
            "convexity": mean(Criterion::Convexity),
            "singularities": totals.singularities,
            "singularities_per_km2": totals.singularity_density() * 1e6,
            "quarter_indices": totals.quarters,
            "lines": totals.lines,
            "length_m": totals.length,
            "tiles": totals.tiles,
            "area_m2": totals.area,
            "totals": {
                "divergence": total(&totals.divergence),
                "continuity": total(&totals.continuity),
                "parallelism": total(&totals.parallelism),
                "perpendicularity": total(&totals.perpendicularity),
                "convexity": spread(&totals.convexity),
            },
            "turns": { "region_m": options.criteria.region, "angle_deg": options.criteria.angle_deg },
            "seconds": {
                "mesh": self.field.mesh_seconds,
                "field": self.field.field_seconds,
                "placement": self.placement_seconds,
                "criteria": self.criteria_seconds,
            },
        })
    }
}

fn total(total: &Total) -> Value {
    json!({
        "sum": total.sum,
        "mean": total.mean,
        "line_mean": total.line_mean,
        "worst": total.worst,
        "measured": total.measured,
    })
}

fn spread(spread: &Spread) -> Value {
    let [p10, p25, p50, p75, p90] = spread.quantiles;
    json!({
        "sum": spread.sum,
        "mean": spread.mean,
        "area_mean": spread.area_mean,
        "deviation": spread.deviation,
        "p10": p10, "p25": p25, "p50": p50, "p75": p75, "p90": p90,
        "worst": spread.worst,
    })
}

/// The word for how a line ends, in `streamlines.geojson`.
#[must_use]
pub const fn stop_word(stop: Stop) -> &'static str {
    match stop {
        Stop::Boundary { .. } => "boundary",
        Stop::Singularity => "singularity",
        Stop::ClosedLoop => "closed_loop",
        Stop::SelfApproach => "self_approach",
        Stop::LengthLimit => "length_limit",
        Stop::FieldEnd => "field_end",
        Stop::Neighbour => "neighbour",
        Stop::Junction { .. } => "junction",
    }
}

/// Lines over one part, from seeds half a separation apart.
fn lines(
    part: &Polygon<f64>,
    field: &impl DirectionField,
    options: &PlacementOptions,
) -> std::result::Result<Vec<Streamline>, TraceError> {
    let (low, high) = extent(part);
    let seeds = lattice(field, Rect::new(low, high), options.separation[0] / 2.0)?;
    place(field, &seeds, options)
}

/// The criteria of one part.
fn judge(
    part: &Polygon<f64>,
    design: &Field,
    lines: &[Streamline],
    tiling: &Tiling,
    options: &CriteriaOptions,
) -> Result<Criteria> {
    let singular: Vec<Singularity> = design
        .singularities()
        .iter()
        .map(|s| Singularity {
            at: s.at,
            quarters: s.quarter_index,
        })
        .collect();
    criteria(&Arms(design), part, lines, tiling, &singular, options).map_err(reported)
}

/// The error of a tracer as one of ours.
fn reported(error: TraceError) -> Error {
    match error {
        TraceError::BadOption { .. } => Error::usage(error.to_string()),
        _ => Error::stage("streamlines", error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::FieldKind;
    use crate::site::Units;

    fn site(text: &str) -> Site {
        Site::from_geojson(text, Units::Metres).expect("a site")
    }

    #[test]
    fn parts_are_joined() {
        // A square with a square hole, and a rectangle beside it.
        let site = site(
            r#"{"type": "MultiPolygon", "coordinates": [
            [[[0, 0], [300, 0], [300, 300], [0, 300], [0, 0]],
             [[100, 100], [100, 200], [200, 200], [200, 100], [100, 100]]],
            [[[400, 0], [600, 0], [600, 100], [400, 100], [400, 0]]]]}"#,
        );
        let options = StreamlineOptions {
            field: FieldOptions {
                kind: FieldKind::Boundary,
                ..FieldOptions::default()
            },
            separation: 40.0,
            test: Some(30.0),
            ..StreamlineOptions::default()
        };
        let study = StreamlineStudy::new(&site, &options).expect("lines");
        assert_eq!(study.parts.len(), 2);
        let count = |of: fn(&PartStreamlines) -> usize| study.parts.iter().map(of).sum::<usize>();
        let figures = study.to_json();
        assert_eq!(figures["lines"], count(|part| part.lines.len()));
        assert_eq!(figures["tiles"], count(|part| part.tiling.tiles.len()));
        let area = figures["area_m2"].as_f64().expect("a number");
        assert!((area - 100_000.0).abs() < 1e-3);
        assert_eq!(figures["singularities"], 0, "right angles alone");
    }

    #[test]
    fn options_out_of_range_are_usage() {
        let site = site(
            r#"{"type": "Polygon", "coordinates": [[[0, 0], [300, 0], [300, 200], [0, 200], [0, 0]]]}"#,
        );
        let good = StreamlineOptions::default();
        for (separation, test) in [
            (0.0, None),
            (-5.0, None),
            (f64::NAN, None),
            (f64::INFINITY, None),
            (0.01, None),
            (75.0, Some(7.0)),
            (75.0, Some(76.0)),
            (75.0, Some(f64::NAN)),
        ] {
            let options = StreamlineOptions {
                separation,
                test,
                ..good.clone()
            };
            let error = StreamlineStudy::new(&site, &options).expect_err("refused");
            assert!(error.is_usage(), "{separation} {test:?}: {error}");
        }
        let options = StreamlineOptions {
            criteria: CriteriaOptions {
                region: -1.0,
                ..CriteriaOptions::default()
            },
            ..good
        };
        let error = StreamlineStudy::new(&site, &options).expect_err("refused");
        assert!(error.is_usage() && error.to_string().contains("region"));
    }
}
