//! The cross field of a whole site, by itself: what `urban-layout field` shows.
//!
//! A plan designs a field for each region anew; this is the first of them, over
//! the site before anything splits it.

use std::time::Instant;

use crossfield::{
    BoundaryField, DistanceField, Domain, DomainOptions, Field, FieldDesign, FieldError,
    HarmonicField, Singularity,
};
use serde_json::{json, Value};

use crate::error::{Error, Result};
use crate::options::FieldKind;
use crate::site::Site;

/// What [`FieldStudy::new`] may be told.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldOptions {
    /// Which field. Default: distance.
    pub kind: FieldKind,
    /// Wanted edge length of the mesh, metres; 0 for a fortieth of the square
    /// root of the area. Default 0.
    pub edge_length: f64,
    /// How strongly a boundary field keeps to the boundary. Default: as
    /// [`BoundaryField`].
    pub omega: f64,
    /// Rounds of smoothing: of a distance field within its design, of any other
    /// after it. Default: the field's own, 1 and 0.
    pub smoothing: Option<usize>,
    /// Seed of designs that draw at random: the harmonic field's search.
    /// Default 0.
    pub seed: u64,
}

impl Default for FieldOptions {
    fn default() -> Self {
        Self {
            kind: FieldKind::default(),
            edge_length: 0.0,
            omega: BoundaryField::default().omega,
            smoothing: None,
            seed: 0,
        }
    }
}

/// A field over each part of a site, and how long it took.
#[derive(Debug)]
pub struct FieldStudy {
    /// One field for each of [`Site::parts`], in local metres.
    pub fields: Vec<Field>,
    /// Seconds that meshing took.
    pub mesh_seconds: f64,
    /// Seconds that the design took.
    pub field_seconds: f64,
    pub(crate) options: FieldOptions,
}

/// Most smooth pieces of a boundary that a harmonic field takes: more than its
/// own default, for the coasts of whole towns. Each costs eighty bytes a vertex.
const MOST_PIECES: usize = 500;
/// Most vertices of a mesh: some 3 GB.
const MOST_VERTICES: usize = 4_000_000;

impl FieldStudy {
    /// Designs a field on each part of `site`: the polygon with its holes. Key
    /// elements and given roads are not part of it.
    ///
    /// # Errors
    ///
    /// Options out of their range, and an edge length that asks for over four
    /// million vertices are errors of usage; what is wrong with the site itself,
    /// such as a triangle that has no harmonic field, is one of input.
    ///
    /// # Examples
    ///
    /// ```
    /// use urban_layout::field::{FieldOptions, FieldStudy};
    /// use urban_layout::site::{Site, Units};
    ///
    /// let site = Site::from_geojson(
    ///     r#"{"type": "Polygon", "coordinates": [[[0, 0], [300, 0], [300, 200], [0, 200], [0, 0]]]}"#,
    ///     Units::Metres,
    /// )?;
    /// let figures = FieldStudy::new(&site, &FieldOptions::default())?.to_json(&site);
    /// assert_eq!(figures["index_sum"], 0);
    /// assert_eq!(figures["boundary_quarter_turns"], 4);
    /// # Ok::<(), urban_layout::Error>(())
    /// ```
    pub fn new(site: &Site, options: &FieldOptions) -> Result<Self> {
        let start = Instant::now();
        let domain_options = DomainOptions {
            edge_length: options.edge_length,
            max_vertices: MOST_VERTICES,
            ..DomainOptions::default()
        };
        let domains = site
            .parts
            .iter()
            .map(|part| Domain::new(part, &domain_options).map_err(reported))
            .collect::<Result<Vec<_>>>()?;
        let mesh_seconds = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let fields = domains
            .iter()
            .map(|domain| design(domain, options).map_err(reported))
            .collect::<Result<Vec<_>>>()?;
        Ok(Self {
            fields,
            mesh_seconds,
            field_seconds: start.elapsed().as_secs_f64(),
            options: options.clone(),
        })
    }

    /// All singularities, in local metres.
    #[must_use]
    pub fn singularities(&self) -> Vec<Singularity> {
        self.fields.iter().flat_map(Field::singularities).collect()
    }

    /// The figures of `field.json`: sums over the parts of the site, means by
    /// area. Singularities are in the coordinates of the site's file; energy
    /// is the integral of |grad u|^2, divergence is averaged over both arms,
    /// in 1 / metre; `boundary_quarter_turns` counts the corners, so that
    /// `index_sum + boundary_quarter_turns = 4 euler` where the field follows
    /// the boundary (`aligned`).
    #[must_use]
    pub fn to_json(&self, site: &Site) -> Value {
        let sum = |of: &dyn Fn(&Field) -> f64| self.fields.iter().map(of).sum::<f64>();
        let count = |of: &dyn Fn(&Field) -> i64| self.fields.iter().map(of).sum::<i64>();
        let checks: Vec<_> = self.fields.iter().map(Field::index_check).collect();
        let of_checks = |of: fn(&crossfield::IndexCheck) -> i32| checks.iter().map(of).sum::<i32>();
        let area = sum(&|f| f.domain().area());
        let divergence = sum(&|f| f.mean_abs_divergence() * f.domain().area());
        let singularities: Vec<Value> = self
            .singularities()
            .iter()
            .map(|s| {
                let at = site.frame.to_source(s.at);
                json!({ "x": at.x, "y": at.y, "quarter_index": s.quarter_index })
            })
            .collect();
        json!({
            "field": self.options.kind.as_str(),
            "seed": self.options.seed,
            "vertices": count(&|f| f.domain().vertex_count() as i64),
            "triangles": count(&|f| f.domain().triangles().len() as i64),
            "seconds": { "mesh": self.mesh_seconds, "field": self.field_seconds },
            "energy": sum(&Field::energy),
            "mean_abs_divergence": if area > 0.0 { divergence / area } else { 0.0 },
            "singularities": singularities,
            "index_sum": of_checks(|c| c.interior),
            "boundary_quarter_turns": of_checks(|c| c.corners),
            "euler": of_checks(|c| c.euler),
            "aligned": checks.iter().all(|c| c.aligned),
        })
    }
}

fn design(domain: &Domain, options: &FieldOptions) -> std::result::Result<Field, FieldError> {
    let smoothed = |field: Field| match options.smoothing {
        Some(rounds) if rounds > 0 => field.smoothed(rounds),
        _ => field,
    };
    match options.kind {
        FieldKind::Distance => {
            let standard = DistanceField::default();
            DistanceField {
                smoothing_rounds: options.smoothing.unwrap_or(standard.smoothing_rounds),
                ..standard
            }
            .design(domain)
        }
        FieldKind::Boundary => BoundaryField {
            omega: options.omega,
            ..BoundaryField::default()
        }
        .design(domain)
        .map(smoothed),
        FieldKind::Harmonic => {
            let seeded = HarmonicField {
                seed: options.seed,
                max_pieces: MOST_PIECES,
                ..HarmonicField::DEFAULT
            };
            seeded.design(domain).map(smoothed)
        }
    }
}

/// The error of a field as one of ours.
fn reported(error: FieldError) -> Error {
    match error {
        FieldError::BadOption { .. } | FieldError::TooManyVertices { .. } => {
            Error::usage(error.to_string())
        }
        _ => Error::input(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::site::Units;

    #[test]
    fn parts_are_added_up() {
        // A square with a square hole, and a triangle beside it.
        let text = r#"{"type": "MultiPolygon", "coordinates": [
            [[[0, 0], [300, 0], [300, 300], [0, 300], [0, 0]],
             [[100, 100], [100, 200], [200, 200], [200, 100], [100, 100]]],
            [[[400, 0], [600, 0], [500, 173.2], [400, 0]]]]}"#;
        let site = Site::from_geojson(text, Units::Metres).expect("a site");
        for kind in [FieldKind::Distance, FieldKind::Boundary] {
            let options = FieldOptions {
                kind,
                ..FieldOptions::default()
            };
            let figures = FieldStudy::new(&site, &options)
                .expect("a field")
                .to_json(&site);
            // 4 - 4 corners; a triangle turns by 120 degrees thrice, rounded
            // to one quarter each.
            assert_eq!(figures["euler"], 1, "{figures}");
            assert_eq!(figures["boundary_quarter_turns"], 3);
            assert_eq!(figures["index_sum"], 1);
            let sum: i64 = figures["singularities"]
                .as_array()
                .expect("a list")
                .iter()
                .map(|s| s["quarter_index"].as_i64().expect("an integer"))
                .sum();
            assert_eq!(sum, 1);
        }
    }
}
