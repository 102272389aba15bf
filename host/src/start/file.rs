//! Discs where a file has them.

use super::StartError;
use crate::files::{read_positions, state::State};
use meniscus_core::torus::Torus;
use std::path::Path;

/// The `count` positions in the file at `path`, of any format that
/// [`read_positions`] knows, with the step and time of the state if the format has them.
///
/// # Errors
/// [`StartError::File`] when the file cannot be read, [`StartError::Count`] when it does not hold `count`
/// discs.
///
/// ```
/// use meniscus::start;
/// use meniscus_core::torus::Torus;
///
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("two.csv");
/// std::fs::write(&path, "x,y\n10,20\n30,40\n").unwrap();
/// let torus = Torus::new(100.0).unwrap();
/// assert_eq!(start::file(&torus, &path, 2).unwrap().positions.len(), 2);
/// assert!(start::file(&torus, &path, 3).is_err());
/// ```
pub fn file(torus: &Torus, path: &Path, count: usize) -> Result<State, StartError> {
    let state = read_positions(path, torus)?;
    if state.positions.len() != count {
        let found = state.positions.len();
        return Err(StartError::Count { path: path.to_owned(), found, wanted: count });
    }
    Ok(state)
}
