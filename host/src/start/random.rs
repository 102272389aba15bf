//! Discs at random anywhere in the box.

use super::StartError;
use super::sequential::add_sequentially;
use meniscus_core::noise::{Purpose, StepKey};
use meniscus_core::torus::{Position, Torus};

/// `count` discs placed one after the other at random in the whole box, no two centres closer than 2 R0.
///
/// Both coordinates of the k-th place tried are the two halves of 64 random bits: uniform over all
/// 2³² × 2³² positions there are.
///
/// # Errors
/// [`StartError::BoxTooSmall`] for a side below 2 R0; [`StartError::TooDense`] at once above close packing,
/// and else after [`ATTEMPTS_PER_DISC`](super::ATTEMPTS_PER_DISC) attempts per disc, which happens near
/// a coverage of 0.54.
///
/// ```
/// use meniscus_core::torus::Torus;
///
/// let torus = Torus::new(20.0).unwrap();
/// assert_eq!(meniscus::start::random(&torus, 30, 7).unwrap().len(), 30);
/// let error = meniscus::start::random(&torus, 90, 7).unwrap_err();
/// assert!(error.to_string().contains("0.547"));
/// ```
pub fn random(torus: &Torus, count: usize, seed: u64) -> Result<Vec<Position>, StartError> {
    let key = StepKey::new(seed, Purpose::Start, 0);
    let candidates = (0..).map(|attempt| {
        let bits = key.bits(attempt);
        Position::from_bits((bits >> 32) as u32, bits as u32)
    });
    add_sequentially(torus, count, torus.side() * torus.side(), candidates)
}
