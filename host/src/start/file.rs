//! Discs where a file has them.

use super::StartError;
use crate::files::{read_positions, state::State};
use crate::strengths::{Strengths, to_number};
use meniscus_core::torus::Torus;
use std::path::Path;

/// The `count` discs in the file at `path`, of any format that [`read_positions`] knows, with their capillary
/// strengths and the step and time of the state if the file has them.
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

/// The strengths of discs of which the file at `path` says `found` (unit 2⁻²⁰, in the order of ids), and the
/// configuration `configured`: those of the file, unless the configuration says something else than the default.
///
/// # Errors
/// [`StartError::Strength`] when the configuration says another strength than 1 and the file another than that.
///
/// ```
/// use meniscus::start::settle_strengths;
/// use meniscus::strengths::{ONE, Strengths};
/// use std::path::Path;
///
/// let settle = |configured, found| settle_strengths(configured, found, Path::new("start.csv"));
/// let found = vec![ONE, -ONE, ONE];
/// assert_eq!(settle(Strengths::default(), found.clone()).unwrap(), Strengths::OfFile(found.clone()));
/// let configured = Strengths::Pattern(vec![ONE, -ONE]);
/// assert_eq!(settle(configured.clone(), found).unwrap(), configured);
/// assert!(settle(configured, vec![ONE, ONE, ONE]).is_err());
/// ```
pub fn settle_strengths(
    configured: Strengths,
    found: Vec<i32>,
    path: &Path,
) -> Result<Strengths, StartError> {
    let different = found.iter().enumerate().find(|(id, strength)| configured.of(*id) != **strength);
    match different {
        None => Ok(configured),
        Some(_) if configured == Strengths::default() => Ok(Strengths::OfFile(found)),
        Some((id, &strength)) => Err(StartError::Strength {
            path: path.to_owned(),
            id,
            found: to_number(strength),
            configured: to_number(configured.of(id)),
        }),
    }
}
