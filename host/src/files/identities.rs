//! Which disc a row of a file is: ids are dense, 0 … n − 1, in any order; without ids the order of the
//! rows counts. What a row says of its disc is a position and perhaps a capillary strength.

use super::FormatError;
use super::error::quoted;
use super::state::State;
use crate::strengths;
use meniscus_core::parameters::{LARGEST_PARTICLE_COUNT, LARGEST_STRENGTH};
use meniscus_core::torus::{Fraction, Position, Torus};

/// A row of a file.
struct Row {
    id: u32,
    line: u64,
    position: Position,
    strength: Option<i32>,
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

    /// Adds the row of `line` with the text of its id, if the file has ids, and its strength, if it has strengths.
    pub(super) fn push(
        &mut self,
        line: u64,
        id: Option<&str>,
        position: Position,
        strength: Option<i32>,
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
                expected: format!("a whole number from 0 to {}", LARGEST_PARTICLE_COUNT - 1),
            })?,
            None => self.rows.len() as u32,
        };
        self.rows.push(Row { id, line, position, strength });
        Ok(())
    }

    /// The discs in id order, as a state at step 0 and time 0.
    pub(super) fn into_state(mut self) -> Result<State, FormatError> {
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
        // Either all rows have a strength or none has.
        let strengths: Option<Vec<i32>> = self.rows.iter().map(|row| row.strength).collect();
        let strengths = strengths.filter(|strengths| !strengths.is_empty());
        let positions = self.rows.into_iter().map(|row| row.position).collect();
        Ok(State { positions, strengths, ..State::default() })
    }
}

/// The capillary strength that `text` of the column `strength` stands for, unit 2⁻²⁰.
pub(super) fn strength(line: u64, text: &str) -> Result<i32, FormatError> {
    text.parse().ok().and_then(strengths::from_number).ok_or_else(|| FormatError::Value {
        line,
        column: "strength",
        found: quoted(text),
        expected: format!("a number from -{LARGEST_STRENGTH} to {LARGEST_STRENGTH}"),
    })
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
