//! Golden files.

use meniscus::golden::Golden;

/// The text of a golden file; what is accepted reads back equal when written, and a record differs from none of
/// itself.
pub fn golden(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let golden = match Golden::from_toml("any.toml", text) {
        Ok(golden) => golden,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return;
        }
    };
    let written = golden.to_toml();
    assert_eq!(Golden::from_toml("written.toml", &written).ok().as_ref(), Some(&golden), "{written}");
    assert!(golden.records.iter().all(|record| record.difference(record).is_none()));
}
