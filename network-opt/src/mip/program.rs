//! Integer programs: columns and rows.

/// A column, that is a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// What one of it costs.
    pub cost: f64,
    /// Its least value.
    pub low: f64,
    /// Its largest value.
    pub high: f64,
    /// Whether it is whole.
    pub integer: bool,
}

/// A row, that is a constraint: low <= sum of factor times column <= high.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Columns with their factors, columns ascending, each once.
    pub terms: Vec<(usize, f64)>,
    /// Least value; minus infinity for none.
    pub low: f64,
    /// Largest value; infinity for none.
    pub high: f64,
}

/// A mixed-integer linear program: the least cost such that every row holds.
///
/// # Examples
///
/// ```
/// use network_opt::mip::{Microlp, MipReply, MipSolver, Program};
///
/// // Two things of weight 3 and 2, worth 5 and 3, in a bag that holds 4.
/// let mut bag = Program::default();
/// let things = [bag.binary(-5.0), bag.binary(-3.0)];
/// bag.row(f64::NEG_INFINITY, 4.0, [(things[0], 3.0), (things[1], 2.0)]);
/// let found = Microlp.solve(&bag, None, &Default::default(), &mut |_| MipReply::GoOn)?;
/// assert_eq!(found.solution, Some(vec![1.0, 0.0]));
/// # Ok::<(), network_opt::DesignError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    columns: Vec<Column>,
    rows: Vec<Row>,
    step: f64,
    refuted: bool,
}

impl Program {
    /// Adds a column and gives its number.
    pub fn column(&mut self, column: Column) -> usize {
        self.columns.push(column);
        self.columns.len() - 1
    }

    /// Adds a column that is 0 or 1.
    pub fn binary(&mut self, cost: f64) -> usize {
        self.column(Column {
            cost,
            low: 0.0,
            high: 1.0,
            integer: true,
        })
    }

    /// Adds a real column from 0 to `high`.
    pub fn real(&mut self, cost: f64, high: f64) -> usize {
        self.column(Column {
            cost,
            low: 0.0,
            high,
            integer: false,
        })
    }

    /// Adds a row and gives its number. Terms of one column are added up.
    pub fn row(
        &mut self,
        low: f64,
        high: f64,
        terms: impl IntoIterator<Item = (usize, f64)>,
    ) -> usize {
        let mut terms: Vec<(usize, f64)> = terms.into_iter().collect();
        terms.sort_unstable_by_key(|&(column, _)| column);
        terms.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        terms.retain(|&(_, factor)| factor != 0.0);
        self.rows.push(Row { terms, low, high });
        self.rows.len() - 1
    }

    /// The columns.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The rows.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Allows a column other values.
    ///
    /// # Panics
    ///
    /// If there is no such column.
    pub fn bound(&mut self, column: usize, low: f64, high: f64) {
        self.columns[column].low = low;
        self.columns[column].high = high;
    }

    /// Promises that what least solutions cost is a multiple of `step`, so that
    /// a solver may end once its bound is less than one step away.
    pub fn promise_step(&mut self, step: f64) {
        self.step = step.max(0.0);
    }

    /// What the cost of a least solution is a multiple of; 0 if nothing is
    /// promised.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// A bound, rounded up to what a solution may cost.
    #[must_use]
    pub fn rounded(&self, bound: f64) -> f64 {
        if self.step > 0.0 && bound.is_finite() {
            // Solvers' bounds are good to some millionths.
            let steps = (bound / self.step - 1e-4).ceil();
            bound.max(steps * self.step)
        } else {
            bound
        }
    }

    /// The next after `cost` that a least solution may cost: one step more, or the
    /// same where nothing is promised.
    #[must_use]
    pub fn after(&self, cost: f64) -> f64 {
        if self.step > 0.0 {
            ((cost / self.step + 1e-4).floor() + 1.0) * self.step
        } else {
            cost
        }
    }

    /// Asks for a proof that no solution costs `level` or less: adds a row that all
    /// of it costs that at most, and tells solvers that they had better look for a
    /// contradiction than for a solution. If there is one after all, the least is
    /// as good an answer.
    ///
    /// The row lets pass a little more, a hundredth of the step, or a millionth.
    pub fn refute(&mut self, level: f64) {
        let slack = (0.01 * self.step).max(1e-6 * level.abs().max(1.0));
        let costs = self.columns.iter().enumerate();
        let terms: Vec<(usize, f64)> = costs.map(|(k, c)| (k, c.cost)).collect();
        self.row(f64::NEG_INFINITY, level + slack, terms);
        self.refuted = true;
    }

    /// Whether [`Program::refute`] was asked for.
    #[must_use]
    pub fn is_refuted(&self) -> bool {
        self.refuted
    }

    /// Changes what a column costs.
    ///
    /// # Panics
    ///
    /// If there is no such column.
    pub fn set_cost(&mut self, column: usize, cost: f64) {
        self.columns[column].cost = cost;
    }

    /// Number of factors that are not 0.
    #[must_use]
    pub fn nonzeros(&self) -> usize {
        self.rows.iter().map(|row| row.terms.len()).sum()
    }

    /// Drops the rows from `first` on that hold with more than their least value.
    pub(crate) fn drop_idle_rows(&mut self, first: usize, values: &[f64]) {
        let mut number = 0;
        self.rows.retain(|row| {
            number += 1;
            let sum: f64 = (row.terms.iter())
                .map(|&(c, factor)| factor * values[c])
                .sum();
            number <= first || sum <= row.low + 1e-6
        });
    }

    /// The linear relaxation: every column may be fractional.
    #[must_use]
    pub fn relaxed(&self) -> Self {
        let mut relaxed = self.clone();
        relaxed.columns.iter_mut().for_each(|c| c.integer = false);
        relaxed.step = 0.0;
        relaxed
    }

    /// What a solution costs, whether it meets the rows or not.
    ///
    /// # Panics
    ///
    /// If there is not one value a column.
    #[must_use]
    pub fn objective(&self, values: &[f64]) -> f64 {
        assert_eq!(values.len(), self.columns.len(), "one value a column");
        self.columns
            .iter()
            .zip(values)
            .map(|(c, v)| c.cost * v)
            .sum()
    }

    /// By how much a solution violates bounds, rows and wholeness at most.
    ///
    /// # Panics
    ///
    /// If there is not one value a column.
    #[must_use]
    pub fn violation(&self, values: &[f64]) -> f64 {
        assert_eq!(values.len(), self.columns.len(), "one value a column");
        let over = |low: f64, high: f64, value: f64| (low - value).max(value - high).max(0.0);
        let columns = self.columns.iter().zip(values).map(|(c, &v)| {
            let part = if c.integer {
                (v - v.round()).abs()
            } else {
                0.0
            };
            part.max(over(c.low, c.high, v))
        });
        let rows = self.rows.iter().map(|row| {
            let sum = row
                .terms
                .iter()
                .map(|&(c, factor)| factor * values[c])
                .sum();
            over(row.low, row.high, sum)
        });
        columns.chain(rows).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_of_a_column_are_added_up() {
        let mut program = Program::default();
        let (a, b) = (program.binary(1.0), program.real(2.0, 5.0));
        program.row(1.0, 2.0, [(b, 1.0), (a, 2.0), (b, -1.0), (a, 1.0)]);
        assert_eq!(program.rows()[0].terms, [(a, 3.0)]);
        assert_eq!(program.objective(&[1.0, 4.0]), 9.0);
        // 3 is over 2 by 1; half an edge is half off, 6 is over 5 by 1.
        assert_eq!(program.violation(&[1.0, 0.0]), 1.0);
        assert_eq!(program.violation(&[0.5, 0.0]), 0.5);
        assert_eq!(program.relaxed().violation(&[0.5, 0.0]), 0.0);
        assert_eq!(program.relaxed().violation(&[0.5, 6.0]), 1.0);
        assert_eq!(program.nonzeros(), 1);
        assert_eq!(program.rounded(0.3), 0.3);
        // One half of `a` is more than the last of three rows needs.
        let all = program.rows().to_vec();
        program.row(0.5, f64::INFINITY, [(a, 1.0)]);
        program.row(0.4, f64::INFINITY, [(a, 1.0)]);
        program.drop_idle_rows(1, &[0.5, 0.0]);
        assert_eq!(program.rows()[..1], all);
        assert_eq!(program.rows().len(), 2);
        program.promise_step(0.5);
        assert_eq!(program.rounded(0.3), 0.5);
        assert_eq!(program.rounded(0.500_001), 0.500_001);
    }

    #[test]
    fn what_is_refuted_is_a_row() {
        let mut program = Program::default();
        let (a, b) = (program.binary(1.0), program.binary(2.0));
        program.row(1.0, f64::INFINITY, [(a, 1.0), (b, 1.0)]);
        assert_eq!(program.after(2.0), 2.0);
        program.promise_step(1.0);
        assert_eq!((program.after(2.0), program.after(2.5)), (3.0, 3.0));
        let mut asked = program.clone();
        asked.refute(1.0);
        assert!(asked.is_refuted() && !program.is_refuted());
        // `a` alone costs 1, `b` one more than that.
        assert_eq!(asked.violation(&[1.0, 0.0]), 0.0);
        assert!((asked.violation(&[0.0, 1.0]) - 0.99).abs() < 1e-12);
    }
}
