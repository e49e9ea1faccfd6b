//! What the paper says of the fields, one statement at a time, and whether the
//! figures of a site bear it out.

use streamline::CriteriaTotals;

/// What one field is measured by.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Figures {
    /// The six, turns within half a separation.
    pub(crate) totals: CriteriaTotals,
    /// Parallelism within one separation of the boundary, in right angles.
    pub(crate) near_parallelism: f64,
    /// Turns of over 20 degrees within 4 m, per metre.
    pub(crate) sharp_turns: f64,
    /// Mean absolute divergence of the field over the land, both arms, 1/m.
    pub(crate) field_divergence: f64,
    /// What half of the lines' length stays below, 1/m: the mean is governed by
    /// the few places where lines bend.
    pub(crate) median_divergence: f64,
    /// Share of the tiles at the boundary that are triangles.
    pub(crate) triangles: f64,
    /// Share of the lines that cut off a piece of the boundary within two
    /// separations of it: shorter than that, from boundary to boundary.
    pub(crate) short: f64,
}

/// The fields of the paper's figures; H-fields are not in them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Compared {
    pub(crate) d: Figures,
    pub(crate) inside: Figures,
    pub(crate) everywhere: Figures,
    pub(crate) strong: Figures,
    pub(crate) weak: Figures,
}

/// A statement of the paper against the figures.
#[derive(Clone, Debug)]
pub(crate) struct Finding {
    pub(crate) claim: &'static str,
    pub(crate) holds: bool,
    /// The figures of the fields, in the order of [`Compared`].
    pub(crate) figures: [String; 5],
}

impl Compared {
    /// Of the figures in the order of the designs; `None` if one is missing.
    pub(crate) fn new(rows: &[Option<Figures>]) -> Option<Self> {
        let [Some(d), Some(inside), Some(everywhere), Some(strong), Some(weak), ..] = *rows else {
            return None;
        };
        Some(Self {
            d,
            inside,
            everywhere,
            strong,
            weak,
        })
    }

    fn each<T>(&self, of: impl Fn(&Figures) -> T) -> [T; 5] {
        [
            of(&self.d),
            of(&self.inside),
            of(&self.everywhere),
            of(&self.strong),
            of(&self.weak),
        ]
    }

    fn finding(
        &self,
        claim: &'static str,
        of: impl Fn(&Figures) -> f64,
        decimals: usize,
        holds: impl Fn([f64; 5]) -> bool,
    ) -> Finding {
        let values = self.each(of);
        Finding {
            claim,
            holds: holds(values),
            figures: values.map(|v| format!("{v:.decimals$}")),
        }
    }

    /// All findings, in the order of the paper's text. Comparisons are strict:
    /// a tie does not hold.
    pub(crate) fn findings(&self) -> Vec<Finding> {
        let parallel = |f: &Figures| f.totals.parallelism.mean * 90.0;
        let near = |f: &Figures| f.near_parallelism * 90.0;
        let divergence = |f: &Figures| f.totals.divergence.mean * 1e3;
        let over_land = |f: &Figures| f.field_divergence * 1e3;
        let turns = |f: &Figures| f.totals.continuity.mean * 1e3;
        let sharp = |f: &Figures| f.sharp_turns * 1e3;
        let singular = |f: &Figures| f.totals.singularities as f64;
        let convexity = |f: &Figures| f.totals.convexity.mean;
        let by_area = |f: &Figures| f.totals.convexity.area_mean;
        let spread = |f: &Figures| f.totals.convexity.deviation;
        let triangles = |f: &Figures| f.triangles * 100.0;
        let short = |f: &Figures| f.short * 100.0;
        let most_turns = |[d, others @ ..]: [f64; 5]| others.iter().all(|&other| d > other);
        vec![
            self.finding(
                "B-fields have lower divergence along the lines than the D-field (1/km)",
                divergence,
                3,
                |[d, _, _, strong, weak]| strong.max(weak) < d,
            ),
            self.finding(
                "... and than both smoothed D-fields",
                divergence,
                3,
                |[_, inside, everywhere, strong, weak]| strong.max(weak) < inside.min(everywhere),
            ),
            self.finding(
                "... and so over the whole field (1/km)",
                over_land,
                3,
                |[d, _, _, strong, weak]| strong.max(weak) < d,
            ),
            self.finding(
                "Smoothing, inside or everywhere, lowers the D-field's divergence (1/km)",
                divergence,
                3,
                |[d, inside, everywhere, ..]| inside.max(everywhere) < d,
            ),
            self.finding(
                "The D-field is more parallel to the boundary than the weak B-field (degrees off)",
                parallel,
                1,
                |[d, .., weak]| d < weak,
            ),
            self.finding(
                "... and so within one separation of the boundary",
                near,
                1,
                |[d, .., weak]| d < weak,
            ),
            self.finding(
                "The weak B-field has triangular tiles in rows at the boundary: a larger share of the tiles there than the D-field (%)",
                triangles,
                1,
                |[d, .., weak]| weak > d,
            ),
            self.finding(
                "... and more short streamlines at the edges of the site: from boundary to boundary in under two separations (%)",
                short,
                1,
                |[d, .., weak]| weak > d,
            ),
            self.finding(
                "The D-field has the most turns per length, 20 degrees within half a separation (1/km)",
                turns,
                3,
                most_turns,
            ),
            self.finding("... and within 4 m", sharp, 3, most_turns),
            self.finding(
                "Smoothing everywhere lowers the number of singularities",
                singular,
                0,
                |[d, _, everywhere, ..]| everywhere < d,
            ),
            self.finding("... inside alone does so too", singular, 0, |[d, inside, ..]| {
                inside < d
            }),
            self.finding(
                "B-fields have fewer than the D-field, the weak one no more than the strong one",
                singular,
                0,
                |[d, _, _, strong, weak]| strong < d && weak < d && weak <= strong,
            ),
            self.finding(
                "Singularities remain in every field (said of the Jurong Lake District)",
                singular,
                0,
                |values| values.iter().all(|&n| n > 0.0),
            ),
            self.finding(
                "Smoothing, inside or everywhere, makes tiles more convex (mean of 1 - hull/perimeter)",
                convexity,
                5,
                |[d, inside, everywhere, ..]| inside.max(everywhere) < d,
            ),
            self.finding(
                "A weak boundary constraint makes tiles more convex",
                convexity,
                5,
                |[.., strong, weak]| weak < strong,
            ),
            self.finding(
                "... both so by area",
                by_area,
                5,
                |[d, inside, everywhere, strong, weak]| {
                    inside.max(everywhere) < d && weak < strong
                },
            ),
            self.finding(
                "Convexity spreads wider in the D-field than in the weak B-field (standard deviation)",
                spread,
                5,
                |[d, .., weak]| d > weak,
            ),
        ]
    }
}
