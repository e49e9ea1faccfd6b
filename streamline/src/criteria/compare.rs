//! The six by name, and several results side by side.

use super::{Criteria, CriteriaTotals};
use std::fmt;

/// One of UrbanFab's six criteria. Each is 0 at best.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Criterion {
    /// Do neighbouring streamlines keep their distance? In 1/m.
    Divergence,
    /// How often do streamlines turn? In 1/m.
    Continuity,
    /// Do segments run along the boundary next to them? In right angles.
    Parallelism,
    /// Do lines meet the boundary squarely? In right angles.
    Perpendicularity,
    /// How far are tiles from their convex hulls? Without unit.
    Convexity,
    /// How many singularities has the field? In 1/m^2.
    Singularities,
}

impl Criterion {
    /// All six, in the order of the paper.
    pub const ALL: [Self; 6] = [
        Self::Divergence,
        Self::Continuity,
        Self::Parallelism,
        Self::Perpendicularity,
        Self::Convexity,
        Self::Singularities,
    ];

    /// A word for reports, such as `divergence`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Divergence => "divergence",
            Self::Continuity => "continuity",
            Self::Parallelism => "parallelism",
            Self::Perpendicularity => "perpendicularity",
            Self::Convexity => "convexity",
            Self::Singularities => "singularities",
        }
    }

    /// The one figure that stands for it: the mean by length of the first four,
    /// the mean over tiles of convexity, singularities per square metre.
    #[must_use]
    pub fn of(self, totals: &CriteriaTotals) -> f64 {
        match self {
            Self::Divergence => totals.divergence.mean,
            Self::Continuity => totals.continuity.mean,
            Self::Parallelism => totals.parallelism.mean,
            Self::Perpendicularity => totals.perpendicularity.mean,
            Self::Convexity => totals.convexity.mean,
            Self::Singularities => totals.singularity_density(),
        }
    }

    /// Whether there was anything to measure: 0 means "the best" only then.
    #[must_use]
    pub fn is_measured(self, totals: &CriteriaTotals) -> bool {
        match self {
            Self::Divergence => totals.divergence.measured > 0.0,
            Self::Continuity => totals.continuity.measured > 0.0,
            Self::Parallelism => totals.parallelism.measured > 0.0,
            Self::Perpendicularity => totals.perpendicularity.measured > 0.0,
            Self::Convexity => totals.convexity.count > 0,
            Self::Singularities => totals.area > 0.0,
        }
    }
}

/// Several results side by side, made by [`compare_criteria`].
///
/// `Display` writes a table with one line for each, in the units of the
/// headings.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CriteriaComparison {
    /// Name and totals of each result, in the order given.
    pub results: Vec<(String, CriteriaTotals)>,
}

/// Compares the criteria of several sets of streamlines.
///
/// Figures by length, by tile or by area may be compared between domains, sums
/// only on one.
///
/// # Examples
///
/// ```
/// use streamline::{compare_criteria, Criteria, Criterion};
///
/// let (mut plain, mut smooth) = (Criteria::default(), Criteria::default());
/// for (result, turns) in [(&mut plain, 0.004), (&mut smooth, 0.001)] {
///     result.totals.continuity.mean = turns;
///     result.totals.continuity.measured = 1.0;
/// }
/// let comparison = compare_criteria([("plain", &plain), ("smooth", &smooth)]);
/// assert_eq!(comparison.best(Criterion::Continuity), [1]);
/// assert_eq!(comparison.best(Criterion::Divergence), []); // nothing was measured
/// println!("{comparison}");
/// ```
#[must_use]
pub fn compare_criteria<'a>(
    results: impl IntoIterator<Item = (&'a str, &'a Criteria)>,
) -> CriteriaComparison {
    let results = results.into_iter();
    CriteriaComparison {
        results: results
            .map(|(name, criteria)| (name.to_owned(), criteria.totals))
            .collect(),
    }
}

/// Headings with their units.
const HEADINGS: [&str; 10] = [
    "div 1/km",
    "turns 1/km",
    "off parallel deg",
    "off perpend. deg",
    "convexity",
    "spread",
    "singular",
    "per km2",
    "lines",
    "tiles",
];

/// Decimals of each column.
const DECIMALS: [usize; 10] = [3, 3, 2, 2, 4, 4, 0, 2, 0, 0];

/// The columns of one row; `None` where nothing was measured.
fn columns(totals: &CriteriaTotals) -> [Option<f64>; 10] {
    let value = |criterion: Criterion, factor: f64| {
        criterion
            .is_measured(totals)
            .then(|| criterion.of(totals) * factor)
    };
    let spread = totals.convexity.deviation;
    [
        value(Criterion::Divergence, 1e3),
        value(Criterion::Continuity, 1e3),
        value(Criterion::Parallelism, 90.0),
        value(Criterion::Perpendicularity, 90.0),
        value(Criterion::Convexity, 1.0),
        (totals.convexity.count > 0).then_some(spread),
        Some(totals.singularities as f64),
        value(Criterion::Singularities, 1e6),
        Some(totals.lines as f64),
        Some(totals.tiles as f64),
    ]
}

impl CriteriaComparison {
    /// Which results are best by a criterion, by their positions: more than one
    /// if they are equal, none if nothing was measured.
    #[must_use]
    pub fn best(&self, criterion: Criterion) -> Vec<usize> {
        let measured = || {
            let rows = self.results.iter().enumerate();
            rows.filter(|(_, (_, totals))| criterion.is_measured(totals))
                .map(|(i, (_, totals))| (i, criterion.of(totals)))
        };
        let least = measured().map(|(_, value)| value).reduce(f64::min);
        measured()
            .filter(|&(_, value)| Some(value) == least)
            .map(|(i, _)| i)
            .collect()
    }

    /// The table of `Display` in Markdown; the best of each of the six in bold.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        // Which criterion a column shows; the spread goes with convexity.
        let shows = |column: usize| match column {
            0..=4 => Some(Criterion::ALL[column]),
            6 | 7 => Some(Criterion::Singularities),
            _ => None,
        };
        let mut text = format!("| | {} |\n|---|", HEADINGS.join(" | "));
        text.push_str(&"--:|".repeat(HEADINGS.len()));
        for (i, (name, totals)) in self.results.iter().enumerate() {
            text.push_str(&format!("\n| {} |", name.replace('|', "\\|")));
            for (column, value) in columns(totals).into_iter().enumerate() {
                let cell = cell(column, value);
                let best = shows(column).is_some_and(|c| self.best(c).contains(&i));
                let mark = if best && self.results.len() > 1 {
                    "**"
                } else {
                    ""
                };
                text.push_str(&format!(" {mark}{cell}{mark} |"));
            }
        }
        text.push('\n');
        text
    }
}

fn cell(column: usize, value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |v| format!("{v:.*}", DECIMALS[column]))
}

impl fmt::Display for CriteriaComparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = self.results.iter().map(|(name, _)| name.chars().count());
        let width = names.max().unwrap_or(0);
        write!(f, "{:width$}", "")?;
        for heading in HEADINGS {
            write!(f, " | {heading}")?;
        }
        for (name, totals) in &self.results {
            write!(f, "\n{name:width$}")?;
            for (column, value) in columns(totals).into_iter().enumerate() {
                let room = HEADINGS[column].chars().count();
                write!(f, " | {:>room$}", cell(column, value))?;
            }
        }
        writeln!(f)
    }
}

impl fmt::Display for Criteria {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        compare_criteria([("", self)]).fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn result(divergence: f64, singularities: usize) -> Criteria {
        let mut result = Criteria::default();
        let totals = &mut result.totals;
        totals.area = 2e6;
        totals.singularities = singularities;
        totals.divergence.mean = divergence;
        totals.divergence.measured = 1.0;
        result
    }

    #[test]
    fn best_and_tables() {
        let (a, b, c) = (result(0.002, 3), result(0.001, 5), result(0.004, 3));
        let comparison = compare_criteria([("a", &a), ("b|", &b), ("plain", &c)]);
        assert_eq!(comparison.best(Criterion::Divergence), [1]);
        assert_eq!(comparison.best(Criterion::Singularities), [0, 2]);
        assert!(comparison.best(Criterion::Parallelism).is_empty());
        let text = comparison.to_string();
        assert_eq!(text.lines().count(), 4);
        let widths: Vec<usize> = text.lines().map(|l| l.chars().count()).collect();
        assert_eq!(widths, [widths[0]; 4], "{text}");
        let markdown = comparison.to_markdown();
        assert_eq!(
            markdown.lines().nth(3),
            Some("| b\\| | **1.000** | - | - | - | - | - | 5 | 2.50 | 0 | 0 |")
        );
        assert_eq!(a.to_string().lines().count(), 2);
        assert_eq!(
            compare_criteria([]).to_markdown().lines().count(),
            2,
            "headings alone"
        );
    }
}
