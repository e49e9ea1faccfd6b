//! Room templates: polyominoes.

use std::collections::BTreeSet;
use std::fmt;

use crate::error::DesignError;

/// Most cells of a template.
const MOST: usize = 64;

/// A room's shape: squares joined side to side (the paper's figure 9a, top).
///
/// Written as rows of `#` for squares and `.` for none, from top to bottom, one
/// row after another with `/` or a line break between them.
///
/// # Examples
///
/// ```
/// use network_opt::floor::Shape;
///
/// let shape: Shape = "##/#.".parse()?;
/// assert_eq!(shape.cells(), [(0, 0), (0, 1), (1, 1)]);
/// assert_eq!(shape.to_string(), "##/#.");
/// // Squares that only meet at a corner are not one room.
/// assert!("#./.#".parse::<Shape>().is_err());
/// # Ok::<(), network_opt::DesignError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "String", into = "String"))]
pub struct Shape {
    /// Column and row of each square, rows from below; the least of both are 0.
    /// Ascending.
    cells: Vec<(i32, i32)>,
}

impl Shape {
    /// A shape of these squares, by column and row; moved so that the least of
    /// both are 0.
    ///
    /// # Errors
    ///
    /// [`DesignError::BadFloor`] for no square, over 64, one that comes twice,
    /// and squares that do not hang together.
    pub fn new(cells: &[(i32, i32)]) -> Result<Self, DesignError> {
        let bad = |what: String| Err(DesignError::BadFloor { what });
        if cells.is_empty() || cells.len() > MOST {
            return bad(format!(
                "a room of {} squares; give 1 to {MOST}",
                cells.len()
            ));
        }
        // Columns and rows far apart do not hang together, and might overflow.
        let far = |&(x, y): &(i32, i32)| x.unsigned_abs().max(y.unsigned_abs()) > 1 << 20;
        if let Some(cell) = cells.iter().find(|c| far(c)) {
            return bad(format!("a room has a square at {cell:?}"));
        }
        let low = cells
            .iter()
            .fold((i32::MAX, i32::MAX), |(x, y), c| (x.min(c.0), y.min(c.1)));
        let set: BTreeSet<(i32, i32)> = cells.iter().map(|c| (c.0 - low.0, c.1 - low.1)).collect();
        if set.len() < cells.len() {
            return bad("a square of a room comes twice".to_owned());
        }
        let mut seen = BTreeSet::new();
        let mut queue: Vec<(i32, i32)> = set.iter().take(1).copied().collect();
        while let Some(cell) = queue.pop() {
            if seen.insert(cell) {
                queue.extend(SIDES.map(|d| (cell.0 + d.0, cell.1 + d.1)));
                queue.retain(|c| set.contains(c));
            }
        }
        if seen.len() < set.len() {
            return bad(format!(
                "only {} of the {} squares of a room hang together, side to side",
                seen.len(),
                set.len()
            ));
        }
        Ok(Self {
            cells: set.into_iter().collect(),
        })
    }

    /// Column and row of each square, rows from below; the least of both are 0.
    #[must_use]
    pub fn cells(&self) -> &[(i32, i32)] {
        &self.cells
    }

    /// The shape seen in a mirror.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let wide = self.cells.iter().map(|c| c.0).max().unwrap_or(0);
        let mut cells: Vec<_> = self.cells.iter().map(|c| (wide - c.0, c.1)).collect();
        cells.sort_unstable();
        Self { cells }
    }

    /// The shape turned by a quarter.
    #[must_use]
    pub fn turned(&self) -> Self {
        let high = self.cells.iter().map(|c| c.1).max().unwrap_or(0);
        let mut cells: Vec<_> = self.cells.iter().map(|c| (high - c.1, c.0)).collect();
        cells.sort_unstable();
        Self { cells }
    }

    /// The corners of squares that four squares of the shape meet at.
    pub(super) fn crossings(&self) -> Vec<(i32, i32)> {
        let is = |x: i32, y: i32| self.cells.binary_search(&(x, y)).is_ok();
        let inner = self.cells.iter().filter(|c| {
            let (x, y) = **c;
            is(x + 1, y) && is(x, y + 1) && is(x + 1, y + 1)
        });
        inner.map(|c| (c.0 + 1, c.1 + 1)).collect()
    }
}

/// East, north, west, south.
pub(super) const SIDES: [(i32, i32); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

impl std::str::FromStr for Shape {
    type Err = DesignError;

    fn from_str(text: &str) -> Result<Self, DesignError> {
        let rows: Vec<&str> = text
            .split(['/', '\n'])
            .map(str::trim)
            .filter(|row| !row.is_empty())
            .collect();
        let mut cells = Vec::new();
        for (y, row) in (0_i32..).zip(rows.iter().rev()) {
            for (x, c) in (0_i32..).zip(row.chars()) {
                match c {
                    '#' => cells.push((x, y)),
                    '.' => {}
                    other => {
                        return Err(DesignError::BadFloor {
                            what: format!(
                                "the shape {text:?} has {other:?}; write # for a square, . for none and / between rows"
                            ),
                        });
                    }
                }
                if cells.len() > MOST {
                    break;
                }
            }
        }
        Self::new(&cells)
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let wide = self.cells.iter().map(|c| c.0).max().unwrap_or(0);
        let high = self.cells.iter().map(|c| c.1).max().unwrap_or(0);
        for y in (0..=high).rev() {
            for x in 0..=wide {
                let is = self.cells.binary_search(&(x, y)).is_ok();
                f.write_str(if is { "#" } else { "." })?;
            }
            if y > 0 {
                f.write_str("/")?;
            }
        }
        Ok(())
    }
}

impl TryFrom<String> for Shape {
    type Error = DesignError;

    fn try_from(text: String) -> Result<Self, DesignError> {
        text.parse()
    }
}

impl From<Shape> for String {
    fn from(shape: Shape) -> Self {
        shape.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_read_turned_and_mirrored() {
        let shape: Shape = " ###/\n#.. ".parse().expect("a shape");
        assert_eq!(shape.to_string(), "###/#..");
        assert_eq!(shape.mirrored().to_string(), "###/..#");
        assert_eq!(shape.turned().to_string(), "#./#./##");
        let mut turned = shape.clone();
        for _ in 0..4 {
            turned = turned.turned();
        }
        assert_eq!(turned, shape);
        assert_eq!(
            "##/##".parse::<Shape>().expect("a shape").crossings(),
            [(1, 1)]
        );
        assert_eq!(shape.crossings(), []);
    }

    #[test]
    fn what_is_no_shape_is_said() {
        let long = "#".repeat(65);
        for (text, word) in [
            ("", "0 squares"),
            ("..", "0 squares"),
            ("#.#", "hang together"),
            ("#x", "'x'"),
            (long.as_str(), "65 squares"),
        ] {
            let error = text.parse::<Shape>().expect_err("bad").to_string();
            assert!(error.contains(word), "{error}");
        }
        assert!(Shape::new(&[(0, 0), (0, 0)]).is_err());
        assert!(Shape::new(&[(i32::MIN, 0), (i32::MAX, 0)]).is_err());
        // Anywhere is as good as at 0.
        let far = Shape::new(&[(-7, 9), (-6, 9)]).expect("a shape");
        assert_eq!(far.to_string(), "##");
    }
}
