//! Which disc a row of a file is: ids are dense, 0 … n − 1, in any order; without ids the order of the
//! rows counts.

use super::FormatError;
use super::error::quoted;
use meniscus_core::parameters::LARGEST_PARTICLE_COUNT;
use meniscus_core::torus::{Fraction, Position, Torus};

/// A row of a file.
struct Row {
    id: u32,
    line: u64,
    position: Position,
}

/// Rows collected in the order of a file.
#[derive(Default)]
pub(super) struct Rows {
    rows: Vec<Row>,
}

impl Rows {
    /// How many rows there are.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Adds the row of `line` with the text of its id, if the file has ids.
    pub(super) fn push(
        &mut self,
        line: u64,
        id: Option<&str>,
        position: Position,
    ) -> Result<(), FormatError> {
        if self.rows.len() == LARGEST_PARTICLE_COUNT {
            return Err(FormatError::Whole {
                found: format!("more than {LARGEST_PARTICLE_COUNT} rows"),
                expected: format!("at most {LARGEST_PARTICLE_COUNT} discs"),
            });
        }
        let id = match id {
            Some(text) => text.parse().map_err(|_| FormatError::Value {
                line,
                column: "id",
                found: quoted(text),
                expected: "a whole number from 0".to_owned(),
            })?,
            None => self.rows.len() as u32,
        };
        self.rows.push(Row { id, line, position });
        Ok(())
    }

    /// The positions in id order.
    pub(super) fn into_positions(mut self) -> Result<Vec<Position>, FormatError> {
        self.rows.sort_unstable_by_key(|row| (row.id, row.line));
        let count = self.rows.len();
        for (row, id) in self.rows.iter().zip(0_u32..) {
            if row.id < id {
                return Err(FormatError::Value {
                    line: row.line,
                    column: "id",
                    found: format!("{} a second time", row.id),
                    expected: "each id once".to_owned(),
                });
            }
            if row.id > id {
                return Err(FormatError::Whole {
                    found: format!("{count} rows without id {id}"),
                    expected: format!("each id from 0 to {} once, or no column id", count - 1),
                });
            }
        }
        Ok(self.rows.into_iter().map(|row| row.position).collect())
    }
}

/// The coordinate that `text` of `column` stands for, in R0 and in [0, L).
pub(super) fn coordinate(
    torus: &Torus,
    line: u64,
    column: &'static str,
    text: &str,
) -> Result<Fraction, FormatError> {
    text.parse().ok().and_then(|number| torus.fraction(number).ok()).ok_or_else(|| FormatError::Value {
        line,
        column,
        found: quoted(text),
        expected: format!("a number of R0 in [0, {})", torus.side()),
    })
}
