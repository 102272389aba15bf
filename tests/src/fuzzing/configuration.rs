//! Configurations.

use meniscus::configuration::Configuration;

/// The bytes of a file, then, each after a zero byte, overrides. A refusal is one line; what is accepted holds valid
/// parameters and a finite end, and reads back equal when written.
pub fn configuration(data: &[u8]) {
    let mut parts = data.split(|&byte| byte == 0);
    let file = parts.next().unwrap_or_default();
    let overrides: Vec<String> = parts.map(|part| String::from_utf8_lossy(part).into_owned()).collect();
    let configuration = match Configuration::from_bytes("any.toml", file, &overrides) {
        Ok(configuration) => configuration,
        Err(error) => {
            let message = error.to_string();
            assert!(!message.contains(char::is_control), "{message:?}");
            return;
        }
    };
    assert_eq!(configuration.parameters().validate(), Ok(()));
    assert!(configuration.end_time().is_finite() && configuration.end_time() >= 0.0);
    let text = configuration.to_toml();
    let again = Configuration::from_text("written.toml", &text, &[]);
    assert_eq!(again.as_ref(), Ok(&configuration), "{text}");
    assert_eq!(again.map(|again| again.to_toml()), Ok(text));
}
