//! The fields that are compared, and what is measured of each.

use crossfield::Field;
use geo_types::Coord;
use streamline::{Criteria, CriteriaOptions, CriteriaTotals, Streamline};
use urban_layout::field::{FieldOptions, FieldStudy};
use urban_layout::streamlines::{StreamlineOptions, StreamlineStudy};
use urban_layout::{FieldKind, Result, Site};

use crate::findings::Figures;

/// A tile's corner, as the paper's metrics have it.
const CORNER_DEG: f64 = 20.0;

/// One field of the comparison.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Design {
    /// For file names.
    pub(crate) key: &'static str,
    /// For tables.
    pub(crate) name: &'static str,
    kind: FieldKind,
    omega: f64,
    smoothing: Smoothing,
}

/// Which vertices of a D-field are averaged with their neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Smoothing {
    Nowhere,
    /// Those inside, as in the 2013 supplement: the boundary keeps its crosses.
    Inside,
    /// All of them, as UrbanFab's algorithm 1 is written.
    Everywhere,
}

/// From left to right as in the paper's figures, then the H-field, which the
/// paper leaves out.
pub(crate) const DESIGNS: [Design; 6] = {
    use FieldKind::{Boundary, Distance, Harmonic};
    use Smoothing::{Everywhere, Inside, Nowhere};
    [
        design("d", "D-field", Distance, 100.0, Nowhere),
        design(
            "d-inside",
            "D-field, smoothed inside",
            Distance,
            100.0,
            Inside,
        ),
        design(
            "d-all",
            "D-field, smoothed everywhere",
            Distance,
            100.0,
            Everywhere,
        ),
        design("b-strong", "B-field, omega 100", Boundary, 100.0, Nowhere),
        design("b-weak", "B-field, omega 1", Boundary, 1.0, Nowhere),
        design("h", "H-field", Harmonic, 100.0, Nowhere),
    ]
};

const fn design(
    key: &'static str,
    name: &'static str,
    kind: FieldKind,
    omega: f64,
    smoothing: Smoothing,
) -> Design {
    Design {
        key,
        name,
        kind,
        omega,
        smoothing,
    }
}

/// What all fields of a comparison share. Lengths follow the site: sites of any
/// size have as many lines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setting {
    /// Rounds of smoothing of the smoothed D-field.
    pub(crate) rounds: usize,
    /// Separations along the square root of the area.
    pub(crate) lines: f64,
}

impl Default for Setting {
    fn default() -> Self {
        Self {
            rounds: 300,
            lines: 20.0,
        }
    }
}

impl Setting {
    /// Distance between lines, metres.
    pub(crate) fn separation(&self, site: &Site) -> f64 {
        site.area().sqrt() / self.lines
    }

    /// Turns are looked for within half a separation: the fields bend over
    /// edges of the mesh, which the paper's 4 m are far below.
    pub(crate) fn criteria(&self, site: &Site) -> CriteriaOptions {
        CriteriaOptions {
            step: self.separation(site) / 20.0,
            region: self.separation(site) / 2.0,
            ..CriteriaOptions::default()
        }
    }
}

/// A field of a site, or why there is none.
#[derive(Debug)]
pub(crate) struct Case {
    pub(crate) design: Design,
    pub(crate) measured: Option<Measured>,
    pub(crate) refusal: Option<String>,
}

/// Everything that is known of one field.
#[derive(Debug)]
pub(crate) struct Measured {
    pub(crate) study: StreamlineStudy,
    /// Within one separation of the boundary alone.
    pub(crate) near: CriteriaTotals,
    /// With turns as the 2013 paper has them: 20 degrees within 4 m.
    pub(crate) sharp: CriteriaTotals,
    separation: f64,
}

/// Designs, traces and measures fields on a site. That a site has no field of
/// some sort is an answer; an option that is wrong is an error.
pub(crate) fn study(site: &Site, setting: &Setting, designs: &[Design]) -> Result<Vec<Case>> {
    designs
        .iter()
        .map(|design| case(site, setting, *design))
        .collect()
}

fn case(site: &Site, setting: &Setting, design: Design) -> Result<Case> {
    let smoothing = match (design.kind, design.smoothing) {
        (FieldKind::Distance, Smoothing::Inside) => Some(setting.rounds),
        (FieldKind::Distance, _) => Some(0),
        _ => None,
    };
    let options = StreamlineOptions {
        field: FieldOptions {
            kind: design.kind,
            omega: design.omega,
            smoothing,
            ..FieldOptions::default()
        },
        separation: setting.separation(site),
        criteria: setting.criteria(site),
        ..StreamlineOptions::default()
    };
    // A refusal names an option of the field as often as the site's shape.
    let mut field = match FieldStudy::new(site, &options.field) {
        Ok(field) => field,
        Err(error) if error.is_input() || error.is_usage() => {
            return Ok(Case {
                design,
                measured: None,
                refusal: Some(error.to_string()),
            })
        }
        Err(error) => return Err(error),
    };
    if design.smoothing == Smoothing::Everywhere {
        for of_part in &mut field.fields {
            *of_part = smoothed_everywhere(of_part, setting.rounds);
        }
    }
    let study = StreamlineStudy::of_field(site, field, &options)?;
    let totals = |options: CriteriaOptions| -> Result<CriteriaTotals> {
        study.judged(site, &options).map(|c: Criteria| c.totals)
    };
    let near = totals(CriteriaOptions {
        reach: Some(options.separation),
        ..options.criteria
    })?;
    let sharp = totals(CriteriaOptions {
        region: CriteriaOptions::default().region,
        ..options.criteria
    })?;
    Ok(Case {
        design,
        measured: Some(Measured {
            near,
            sharp,
            separation: options.separation,
            study,
        }),
        refusal: None,
    })
}

/// UrbanFab's algorithm 1: rounds in which every vertex, those on the boundary
/// included, takes the mean of its own and its neighbours' representation
/// vectors, scaled to unit length.
fn smoothed_everywhere(field: &Field, rounds: usize) -> Field {
    let domain = field.domain();
    let count = domain.vertex_count();
    let mut vectors: Vec<Coord<f64>> = (0..count).map(|v| field.representative(v)).collect();
    for _ in 0..rounds {
        let mean = |v: usize| {
            let around = domain.neighbours(v).iter().map(|&w| vectors[w as usize]);
            let sum = around.fold(vectors[v], |sum, vector| sum + vector);
            let length = sum.x.hypot(sum.y);
            // What cancels stays as it is.
            if length > 1e-9 {
                sum / length
            } else {
                vectors[v]
            }
        };
        vectors = (0..count).map(mean).collect();
    }
    Field::from_representatives(domain, vectors).expect("one finite vector for each vertex")
}

impl Case {
    /// What the findings are checked with; `None` without a field.
    pub(crate) fn figures(&self) -> Option<Figures> {
        let measured = self.measured.as_ref()?;
        let study = &measured.study;
        let area = |f: &Field| f.domain().area();
        let fields = || study.field.fields.iter();
        let whole: f64 = fields().map(area).sum();
        let divergence: f64 = fields().map(|f| f.mean_abs_divergence() * area(f)).sum();
        let (triangles, at_boundary) = boundary_tiles(study);
        let cut_off = |line: &Streamline| {
            let ends = line.start.is_boundary() && line.end.is_boundary();
            ends && line.length() < 2.0 * measured.separation
        };
        let lines = study.parts.iter().flat_map(|part| &part.lines);
        let short = lines.filter(|line| cut_off(line)).count();
        let share = |part: usize, of: usize| part as f64 / of.max(1) as f64;
        Some(Figures {
            totals: study.criteria.totals,
            near_parallelism: measured.near.parallelism.mean,
            sharp_turns: measured.sharp.continuity.mean,
            field_divergence: divergence / whole,
            median_divergence: median_divergence(study),
            triangles: share(triangles, at_boundary),
            short: share(short, study.criteria.totals.lines),
        })
    }
}

/// The divergence that half of the lines' length stays below.
fn median_divergence(study: &StreamlineStudy) -> f64 {
    let lines = study.criteria.lines.iter();
    let mut pieces: Vec<(f64, f64)> = lines
        .flat_map(|line| &line.segments)
        .filter_map(|s| Some((s.divergence?, s.piece.length)))
        .collect();
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = pieces.iter().map(|p| p.1).sum::<f64>() / 2.0;
    let mut passed = 0.0;
    let middle = pieces.iter().find(|(_, length)| {
        passed += length;
        passed >= half
    });
    middle.map_or(0.0, |p| p.0)
}

/// How many tiles at the boundary have three corners, and how many there are.
fn boundary_tiles(study: &StreamlineStudy) -> (usize, usize) {
    let (mut triangles, mut all) = (0, 0);
    for part in &study.parts {
        let tiling = &part.tiling;
        for tile in 0..tiling.tiles.len() {
            let mut sides = tiling.tiles[tile].rings.iter().flatten();
            if sides.any(|side| tiling.edges[side.edge].boundary.is_some()) {
                all += 1;
                let polygon = tiling.polygon(tile);
                triangles += usize::from(corners(&polygon.exterior().0) == 3);
            }
        }
    }
    (triangles, all)
}

/// Vertices of a closed ring where it turns by more than 20 degrees.
pub(crate) fn corners(ring: &[Coord<f64>]) -> usize {
    let n = ring.len().saturating_sub(1);
    (0..n)
        .filter(|&i| {
            let (a, b) = (ring[i] - ring[(i + n - 1) % n], ring[i + 1] - ring[i]);
            let turn = (a.x * b.y - a.y * b.x).atan2(a.x * b.x + a.y * b.y);
            turn.abs() > CORNER_DEG.to_radians()
        })
        .count()
}
