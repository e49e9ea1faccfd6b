//! How well rows of parcels fit beside a street: the paper's distance to the
//! boundary, with the misfit shared out over the rows.

use streamline::{DirectionField, Score, Streamline};

use crate::network::Side;
use crate::options::PlanOptions;
use crate::plane::left;
use crate::segments::SegmentGrid;

/// A [`Score`] like the paper's DB (section 5): land between a candidate and
/// what lies opposite should be a whole number of double rows with streets
/// between. The paper measures the misfit in metres; here it is the change of
/// each row's depth (the logarithm of depth over ideal depth), since 25 m too
/// many are a great deal for two rows and nothing for ten.
#[derive(Debug)]
pub(crate) struct RowFit<'a> {
    grid: &'a SegmentGrid,
    sides: &'a [Side],
    half: f64,
    depth: f64,
    /// Misfit by width, half a metre a step.
    table: Vec<f64>,
}

/// Spacing of samples along a candidate, metres.
const SPACING: f64 = 12.0;
/// Farther than this anything fits, metres.
const REACH: f64 = 400.0;
/// Metres a table step.
const RESOLUTION: f64 = 0.5;
/// Misfit that counts as no fit at all: rows half or twice as deep.
const WORST: f64 = 0.7;

impl<'a> RowFit<'a> {
    pub(crate) fn new(grid: &'a SegmentGrid, sides: &'a [Side], options: &PlanOptions) -> Self {
        let (depth, street) = (options.parcel_length, options.street_width);
        let misfit = |width: f64| {
            (1..=8)
                .map(|k| {
                    let k = f64::from(k);
                    let row = (width - (k - 1.0) * street) / (2.0 * k);
                    if row > 1.0 {
                        (row / depth).ln().abs()
                    } else {
                        WORST
                    }
                })
                .fold(WORST, f64::min)
        };
        let steps = (REACH / RESOLUTION) as usize;
        let table = (0..=steps)
            .map(|i| (misfit(i as f64 * RESOLUTION) / WORST).powi(2))
            .collect();
        Self {
            grid,
            sides,
            half: 0.5 * street,
            depth,
            table,
        }
    }

    /// The misfit of land `width` metres wide between two streets' edges, 0 to 1.
    pub(crate) fn at_width(&self, width: f64) -> f64 {
        if width <= 0.0 {
            return 1.0;
        }
        self.table
            .get((width / RESOLUTION).round() as usize)
            .copied()
            .unwrap_or(0.0)
    }
}

impl Score for RowFit<'_> {
    fn name(&self) -> &str {
        "boundary"
    }

    fn cost(&self, line: &Streamline, _field: &dyn DirectionField) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for sample in line.samples(SPACING) {
            for side in [1.0, -1.0] {
                let normal = left(sample.tangent) * side;
                count += 1.0;
                let Some(hit) = self.grid.ray(sample.at, normal, 0.0, REACH) else {
                    continue;
                };
                let met = self.sides[hit.segment];
                // A boundary without a street counts as one a row farther on.
                let beyond = if met.access { 0.0 } else { self.depth };
                sum += self.at_width(hit.distance - self.half - met.inset + beyond);
            }
        }
        if count > 0.0 {
            sum / count
        } else {
            1.0
        }
    }
}
